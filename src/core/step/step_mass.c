/* SPDX-License-Identifier: BSD-3-Clause */
/* The added mass: change of the load on the tank with its acceleration. The pressure equation of
 * the step is linear in it, so each degree of freedom is one more solution with the same matrix and
 * preconditioner; mps__ppe.moments gives its right side. The solution of the previous step is the
 * first guess. A body needs only the columns of its free degrees. */
#include "half_cell.h"
#include "loop.h"
#include "step.h"
#include <mps/couple.h>
#include <string.h>

/* Change of the right side by one degree of freedom. */
typedef struct side {
    const double *moments, *x; /* [rows*dim] */
    double *rhs;
    int32_t freedom;
    double at[3];
} side;

MPS_ROW void side_row(const int dim, const side *f, int64_t r)
{
    double arm[3] = {0}, m[3] = {0}, turn[3];
    if (f->freedom < MPS_ROTATE_X) {
        f->rhs[r] = f->moments[r * dim + f->freedom];
        return;
    }
    for (int d = 0; d < dim; d++) {
        arm[d] = f->x[r * dim + d] - f->at[d];
        m[d] = f->moments[r * dim + d];
    }
    mps__cross(arm, m, turn);
    f->rhs[r] = turn[f->freedom - MPS_ROTATE_X];
}
MPS__LOOP(side_rows, side_row, side)

/* Copy one component of an interleaved array to another, by index: from pressures of particles to
 * those of unknowns, and back. */
typedef struct transfer {
    const int32_t *place; /* particle of an unknown, or unknown of a particle; NULL: identity */
    const double *from;
    double *to;
    int32_t from_count, from_at, to_count, to_at;
} transfer;

MPS_ROW void transfer_row(const transfer *f, int64_t i)
{
    const int64_t place = f->place ? f->place[i] : i;
    f->to[i * f->to_count + f->to_at] = place >= 0 ? f->from[place * f->from_count + f->from_at]
                                                   : 0;
}
MPS__LOOP_ANY(transfer_rows, transfer_row, transfer)

/* Copy the arrays that the row functions read to the host. */
static void get_ready(mps__world *w)
{
    int32_t channel[MPS__FLUX_CHANNELS];
    mps__flux_channels(&w->channels, channel);
    mps__memory_sync_fields(&w->runner.memory);
    mps__memory_sync_lists(&w->runner.memory);
    for (int k = 0; k < MPS__FLUX_CHANNELS; k++)
        if (channel[k] >= 0) mps__memory_sync(&w->runner.memory, channel[k], MPS__ON_HOST);
    mps__memory_sync(&w->runner.memory, mps__channels_find(&w->channels, "correction"),
                     MPS__ON_HOST);
}

static mps_status reserve(mps__world *w, int32_t count)
{
    mps__mass *m = &w->mass;
    const mps__ppe *e = &w->ppe;
    const int64_t n = w->particles.n * count;
    MPS__TRY(mps__grow(w->context, (void **)&m->next, &m->next_capacity, 0,
                       n > m->next_capacity ? mps__capacity_for(n, m->next_capacity) : n,
                       sizeof *m->next));
    MPS__TRY(mps__grow(w->context, (void **)&m->a, &m->a_capacity, 0, n * w->setup.dim + 1,
                       sizeof *m->a));
    MPS__TRY(
        mps__grow(w->context, (void **)&m->rhs, &m->rhs_capacity, 0, e->n + 1, sizeof *m->rhs));
    return mps__grow(w->context, (void **)&m->p, &m->p_capacity, 0, e->columns + 1, sizeof *m->p);
}

/* The change of the pressures by column c. */
static mps_status solve_column(mps__step *q, const int32_t *freedom, int32_t dofs, int32_t c)
{
    mps__world *w = q->w;
    mps__mass *m = &w->mass;
    mps__ppe *e = &w->ppe;
    const mps_parallel *parallel = &w->pool.parallel;
    const int32_t dim = w->setup.dim, count = q->columns.count, degree = q->columns.degree[c];
    mps_ppe_result result = {.struct_size = sizeof result};
    side f = {.moments = m->moments, .x = e->x, .rhs = m->rhs, .freedom = freedom[degree]};
    for (int d = 0; d < 3; d++) f.at[d] = q->load.at[d] - e->moved[d];
    mps__loop_run(parallel, &side_rows, dim, e->n, &f);
    mps__loop_run(parallel, &transfer_rows, dim, e->columns,
                  &(transfer){e->particle, m->guess, m->p, dofs, degree, 1, 0});
    const mps_status status = mps__bounds_solve_change(&w->bounds, &w->solvers, e, m->rhs, m->p,
                                                       &result);
    q->load.iterations += result.iterations;
    if (status < 0 && status != MPS_E_SOLVER) return status;
    q->load.has_mass = q->load.has_mass && status == MPS_OK;
    if (mps_ppe_halo(&e->problem, m->p)) return mps__ranks_status(&w->ranks);
    mps__loop_run(parallel, &transfer_rows, dim, w->particles.n,
                  &(transfer){e->unknown, m->p, m->next, 1, 0, count, c});
    return MPS_OK;
}

/* ---- the response of the liquid ---- */

/* Degrees of freedom, a compile-time constant if `dim` is; columns of one sum. */
#define DOFS(dim)    ((dim) == 3 ? 6 : 3)
#define AT_ONCE(dim) ((dim) == 3 ? 2 : 3)

typedef struct mass_fields {
    mps__halves halves;
    const double *p, *correction, *density; /* changes of pressures [n*count]; by particle */
    double *a;                              /* [n*count*dim] changes of accelerations */
    mps__mass_columns columns;
    int64_t stride;      /* count*dim */
    int32_t first, last; /* columns of one sum */
    double at[3], cell;
} mass_fields;

/* Component for degree of freedom k: x, y, (z,) rotations about (x, y,) z. */
MPS_ROW double along(const int dim, const int k, const double *d, const double turn[3])
{
    return k < dim ? d[k] : turn[dim == 2 ? 2 : k - 3];
}

static inline int axis_of(const int dim, const int k)
{
    return k < dim ? k : dim == 2 ? 2 : k - 3;
}

/* Acceleration of the tank at an arm from the centre, for degree of freedom k. */
MPS_ROW void tank_acceleration(const int dim, const int k, const double arm[3], double out[3])
{
    double axis[3];
    for (int d = 0; d < 3; d++) axis[d] = d == axis_of(dim, k);
    if (k < dim)
        for (int d = 0; d < 3; d++) out[d] = axis[d];
    else
        mps__cross(axis, arm, out);
}

/* The gradient of gradient.corrected, for all columns at once: a = a_tank - D/n0 B sum w [dp/rho +
 * a_tank.r] r. The mean of a_tank.r over a pair is the component of (arm of i x r) along the axis
 * of a rotation. */
MPS_ROW void change(const int dim, const int count, const mps_view *v, const mass_fields *f,
                    int64_t i)
{
    const mps_stencil *t = &v->near;
    const double *b = f->correction + i * dim * dim, *own = f->p + i * count;
    double sum[6][3] = {{0}}, arm[3] = {0}, d3[3] = {0}, turn[3], *a = f->a + i * count * dim;
    for (int k = 0; k < count * dim; k++) a[k] = 0;
    if (!mps__is_about(v, &f->halves, i)) return;
    for (int d = 0; d < dim; d++) arm[d] = v->x[i * dim + d] - f->at[d];
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        if (mps_region_of(f->halves.region, mps_stencil_column(t, p)) >= MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        const double over = 1 / mps_flux_density(&v->flux, i, q.j), *other = f->p + q.j * count;
        for (int d = 0; d < dim; d++) d3[d] = q.d[d];
        mps__cross(arm, d3, turn);
        for (int c = 0; c < count; c++) {
            const double push = (other[c] - own[c]) * over,
                         change = q.w_r2 * (push + along(dim, f->columns.degree[c], d3, turn));
            for (int d = 0; d < dim; d++) sum[c][d] += change * q.d[d];
        }
    }
    for (int c = 0; c < count; c++) {
        double tank[3];
        tank_acceleration(dim, f->columns.degree[c], arm, tank);
        for (int d = 0; d < dim; d++) {
            a[c * dim + d] = tank[d];
            for (int e = 0; e < dim; e++)
                a[c * dim + d] -= dim / t->n0 * b[d * dim + e] * sum[c][e];
        }
    }
}

/* Specialised for one column, as for most bodies: no inner loop over columns. */
MPS_ROW void change_row(const int dim, const mps_view *v, const mass_fields *f, int64_t i)
{
    if (f->columns.count == 1)
        change(dim, 1, v, f, i);
    else
        change(dim, f->columns.count, v, f, i);
}
MPS_ROWS(change_rows, change_row, mass_fields)

/* Force of the tank on the liquid and its moment, for some columns. */
MPS_ROW void add_change(const int dim, const mps_view *v, const mass_fields *f, int64_t i,
                        double *term)
{
    const int dofs = DOFS(dim);
    const bool fluid = mps_is_fluid(v, i);
    double arm[3] = {0}, n[3] = {0};
    const double mass = fluid ? mps__cell_mass(f->density, f->halves.region, f->cell, i)
                              : mps__half_cell(dim, v, &f->halves, i, n);
    if (mass == 0) return;
    for (int d = 0; d < dim; d++) arm[d] = v->x[i * dim + d] - f->at[d];
    for (int c = f->first; c < f->last; c++, term += dofs) {
        const int k = f->columns.degree[c];
        mps__half_pull pull = {.a = f->a + c * dim, .stride = f->stride};
        double force[3] = {0}, moment[3];
        if (fluid)
            for (int d = 0; d < dim; d++) force[d] = pull.a[i * pull.stride + d];
        else {
            tank_acceleration(dim, k, arm, pull.tank);
            for (int d = 0; d < 3; d++) pull.turn[d] = k >= dim && d == axis_of(dim, k);
            mps__half_acceleration(dim, v, &f->halves, &pull, i, n, force);
        }
        for (int d = 0; d < dim; d++) force[d] *= mass;
        mps__cross(arm, force, moment);
        for (int j = 0; j < dofs; j++) term[j] = along(dim, j, force, moment);
    }
}
MPS_SUMS(add_changes, add_change, mass_fields)

/* Columns of A, from the changes of all pressures. */
static mps_status sum_columns(mps__step *q, const int32_t *freedom, int32_t dofs)
{
    mps__world *w = q->w;
    const mps__particles *s = &w->particles;
    const int32_t dim = s->dim, correction = mps__channels_find(&w->channels, "correction"),
                  count = q->columns.count;
    const mps_flux *flux = q->terms.flux;
    mass_fields f = {
        .halves = {.density = flux->density, .wetted = flux->wetted, .region = s->region},
        .stride = (int64_t)count * dim,
        .p = w->mass.next,
        .a = w->mass.a,
        .density = s->rho,
        .columns = q->columns,
        .cell = mps_pow(w->setup.dp, dim)};
    mps_view v = q->view;
    memcpy(f.at, q->load.at, sizeof f.at);
    f.correction = mps__channels_array(&w->channels, &w->particles, correction);
    v.flux = *flux;
    mps__runner_rows(&w->runner, &v, &change_rows, &f);
    MPS__TRY(mps__ghosts_exchange(
        &w->ghosts, &(mps__halo_array){.values = f.a, .bytes = (size_t)(count * dim) * sizeof *f.a},
        1));
    for (; f.first < count; f.first = f.last) {
        double sums[MPS_PARALLEL_VALUES] = {0};
        f.last = f.first + AT_ONCE(dim) < count ? f.first + AT_ONCE(dim) : count;
        mps__runner_sum(&w->runner, &v, (f.last - f.first) * dofs, &add_changes, &f, sums);
        for (int32_t c = f.first; c < f.last; c++)
            for (int32_t k = 0; k < dofs; k++)
                q->load.mass[6 * freedom[k] + freedom[q->columns.degree[c]]] =
                    sums[(c - f.first) * dofs + k];
    }
    return MPS_OK;
}

/* ---- the step ---- */

mps_status mps__step_mass_begin(mps__step *q)
{
    mps__world *w = q->w;
    mps__mass *m = &w->mass;
    int32_t freedom[6];
    const int32_t dofs = mps__step_freedom(w->setup.dim, freedom);
    const uint32_t wanted = w->load.watch == MPS_LOAD_MASS
                                ? ~0U
                                : mps__rigid_columns(&w->body.given, w->setup.dim);
    q->columns.count = 0;
    w->ppe.moments = NULL;
    if (q->load.what != MPS_LOAD_MASS) return MPS_OK;
    for (int32_t k = 0; k < dofs; k++)
        if (wanted >> freedom[k] & 1) q->columns.degree[q->columns.count++] = k;
    MPS__TRY(mps__grow(w->context, (void **)&m->moments, &m->moment_capacity, 0,
                       w->particles.n * w->setup.dim, sizeof *m->moments));
    w->ppe.moments = m->moments;
    return MPS_OK;
}

mps_status mps__step_mass(mps__step *q)
{
    mps__world *w = q->w;
    int32_t freedom[6];
    const int32_t dofs = mps__step_freedom(w->setup.dim, freedom);
    if (!q->terms.equation.body || mps__channels_find(&w->channels, "correction") < 0)
        return mps__fail(w->context, MPS_E_STATE,
                         "the added mass of the liquid, which a body and an FMU need, has no "
                         "pressure equation in the frame of the tank: 'source.volume' makes it, "
                         "which the presets imps and mmps have");
    MPS__TRY(reserve(w, q->columns.count));
    get_ready(w);
    q->load.has_mass = true;
    for (int32_t c = 0; c < q->columns.count; c++) MPS__TRY(solve_column(q, freedom, dofs, c));
    return sum_columns(q, freedom, dofs);
}

/* Store the result as the first guess of the next step. */
void mps__step_mass_end(mps__step *q)
{
    mps__world *w = q->w;
    const int32_t dofs = w->setup.dim == 3 ? 6 : 3, count = q->columns.count;
    for (int32_t c = 0; c < count; c++)
        mps__loop_run(
            &w->pool.parallel, &transfer_rows, w->setup.dim, w->particles.n,
            &(transfer){NULL, w->mass.next, w->mass.guess, count, c, dofs, q->columns.degree[c]});
}

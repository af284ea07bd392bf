/* SPDX-License-Identifier: BSD-3-Clause */
/* Assembly of the pressure equation, W22 (10)(16)(17): a row for every unknown, Dirichlet neighbours moved to the right side. */
#include "ppe.h"
#include "levels.h"
#include "loop.h"
#include <math.h>
#include <mps/stage.h>
#include <mps/operators.h>
#include <string.h>

/* Blocks of scratch; levels.c and ppe_ranks.c take the next ones. */
enum { VALUES, COLUMNS, ROWS, LAWS };

void mps__ppe_init(mps__ppe *e, mps__context *context)
{
    *e = (mps__ppe){.context = context, .scratch = &e->own, .sets = {.context = context}};
}

void mps__ppe_free(mps__ppe *e)
{
    mps__scratch_free(e->context, &e->own);
    mps__sets_free(&e->sets);
    mps__ppe_init(e, e->context);
}

/* What rows of the matrix see: terms of the equation by particle, and the arrays that they become by unknown. */
typedef struct assembly {
    mps_stencil pairs;
    mps_flux flux;
    const int32_t *kind, *region, *condition;
    const double *density, *source, *shift, *value, *gas, *law;
    const uint8_t *ghost; /* NULL: alone */
    double c;             /* 2D/(n0 lambda) */
    double surface;       /* weight of pairs with one particle on the surface */
    double gain;
    const int32_t *unknown, *particle;
    int64_t *row;
    int32_t *col;
    float *val;
    double *diagonal, *rhs, *row_shift, *row_gas, *row_law; /* the last two NULL: all are linear */
    double *moments;                                        /* NULL: not wanted */
} assembly;

/* Full flux of a linear pressure through the row below a flat surface, over that of the pairs the surface leaves. */
static double complete_flux(const mps_stencil *t)
{
    const int reach = (int)(t->re / t->dp) + 1, depth = t->dim == 3 ? reach : 0;
    double full = 0, left = 0;
    for (int k = -depth; k <= depth; k++)
        for (int j = 1; j <= reach; j++)
            for (int i = -reach; i <= reach; i++) {
                const double r = t->dp * sqrt((double)(i * i + j * j + k * k));
                const double w = r < t->re ? mps_kernel_weight(&t->kernel, r, t->re) : 0.0;
                full += w * j * j;
                left += w * j;
            }
    return full / left;
}

/* Weight of a pair by what its particles are; 0: it does not take part. An unknown is not on the surface. */
static inline double pair_factor(const assembly *a, int64_t i, int64_t j)
{
    if (a->unknown[j] < 0 && a->condition[j] != MPS_ROW_FIXED) return 0.0;
    if (a->kind[i] == MPS_WALL && a->kind[j] == MPS_WALL)
        return mps_flux_wall_share(&a->flux, i, j);
    return a->region[j] == MPS_REGION_SURFACE ? a->surface : 1.0;
}

static inline bool is_unknown(const assembly *a, int64_t i)
{
    return a->kind[i] != MPS_DUMMY && a->region[i] < MPS_REGION_SURFACE &&
           a->condition[i] != MPS_ROW_FIXED;
}

static double *carve(char **room, int64_t count)
{
    double *array = (double *)(void *)*room;
    *room += (size_t)count * sizeof *array;
    return array;
}

static int32_t *carve_numbers(char **room, int64_t count)
{
    int32_t *array = (int32_t *)(void *)*room;
    *room += (size_t)count * sizeof *array;
    return array;
}

/* Arrays of the rows, all in one block: those of eight bytes first. */
static mps_status reserve_rows(mps__ppe *e, const mps_view *s)
{
    const int64_t n = e->n, all = e->columns, late = e->spare ? 0 : 2 * n + (1 + s->dim) * all;
    char *room = mps__scratch_take(e->context, e->scratch, ROWS,
                                   2 * (4 * n + late + 1) + 2 * all + s->n, sizeof(int32_t));
    if (!room) return MPS_E_NOMEM;
    e->diagonal = carve(&room, n);
    e->rhs = carve(&room, n);
    e->shift = carve(&room, n);
    e->row = (int64_t *)(void *)carve(&room, n + 1);
    e->x = e->spare ? e->spare_x : carve(&room, all * s->dim);
    char *spare = e->spare ? (char *)e->spare : (char *)carve(&room, 2 * n + all);
    e->weight = carve(&spare, n);
    e->p = carve(&spare, all);
    e->component = carve_numbers(&spare, n);
    e->queue = carve_numbers(&spare, n);
    e->particle = carve_numbers(&room, all);
    e->order = carve_numbers(&room, all);
    e->unknown = carve_numbers(&room, s->n);
    return MPS_OK;
}

/* Room for laws of gases, where any row has one. */
static mps_status reserve_laws(mps__ppe *e, const assembly *a, int64_t particles)
{
    bool any = false;
    e->gas = e->law = NULL;
    for (int64_t i = 0; i < particles && !any; i++)
        any = a->law[i] > 0 && a->gain * a->gas[i] > 0 && is_unknown(a, i);
    if (!any) return MPS_OK;
    e->gas = mps__scratch_take(e->context, e->scratch, LAWS, 2 * e->n, sizeof *e->gas);
    if (!e->gas) return MPS_E_NOMEM;
    e->law = e->gas + e->n;
    return MPS_OK;
}

/* Unknowns of this rank, and of others. */
MPS_ROW void unknown_row(const int dim, const assembly *a, int64_t i, double *count)
{
    (void)dim;
    if (is_unknown(a, i)) count[!mps__owns(a->ghost, i)] = 1;
}
MPS__VALUES(unknown_rows, unknown_row, assembly, 2, 0)

/* Unknowns in the order of the particles, behind them those of other ranks. */
static mps_status number_rows(mps__ppe *e, const mps_view *s, const assembly *a)
{
    mps_exact count[2] = {{{0}, 0, 0}};
    int64_t rows = 0;
    double none[1];
    mps__values_run(a->pairs.parallel, &unknown_rows, MPS__ANY_DIM, s->n, a, count, none);
    e->n = (int64_t)mps_exact_value(&count[0]);
    e->columns = e->n + (int64_t)mps_exact_value(&count[1]);
    int64_t column = e->n;
    MPS__TRY(reserve_rows(e, s));
    for (int64_t i = 0; i < s->n; i++) {
        const bool solved = is_unknown(a, i);
        int64_t *next = mps__owns(a->ghost, i) ? &rows : &column;
        e->unknown[i] = solved ? (int32_t)*next : -1;
        if (solved) e->particle[(*next)++] = (int32_t)i;
    }
    return reserve_laws(e, a, s->n);
}

/* Entries of row r beside the diagonal. */
MPS_ROW void count_row(const int dim, const assembly *a, int64_t r)
{
    const mps_stencil *pairs = &a->pairs;
    const int64_t i = a->particle[r];
    int64_t count = 0;
    (void)dim;
    for (int64_t k = pairs->begin[i]; k < pairs->end[i]; k++) {
        const int64_t j = pairs->col[k];
        count += a->unknown[j] >= 0 && (a->kind[i] == MPS_FLUID || pair_factor(a, i, j) != 0);
    }
    a->row[r + 1] = count;
}
MPS__LOOP(count_rows, count_row, assembly)

/* Row starts. Returns the entries of all. */
static int64_t start_rows(mps__ppe *e, const assembly *a)
{
    e->row[0] = 0;
    mps__loop_run(a->pairs.parallel, &count_rows, a->pairs.dim, e->n, a);
    for (int64_t r = 0; r < e->n; r++) e->row[r + 1] += e->row[r];
    return e->row[e->n];
}

/* Columns in the order of their particles: far rows are two sorted runs, for which insertion is short work. */
static void sort_row(const int32_t *particle, int32_t *col, float *val, int64_t n)
{
    for (int64_t k = 1; k < n; k++) {
        const int32_t c = col[k];
        const float v = val[k];
        int64_t j = k;
        for (; j > 0 && particle[col[j - 1]] > particle[c]; j--) {
            col[j] = col[j - 1];
            val[j] = val[j - 1];
        }
        col[j] = c;
        val[j] = v;
    }
}

MPS_ROW void fill_row(const int dim, const assembly *a, int64_t r)
{
    const mps_stencil *pairs = &a->pairs;
    const mps_flux *flux = &a->flux;
    const int64_t i = a->particle[r];
    int32_t *col = a->col + a->row[r];
    const double gas = a->gain * a->gas[i];
    float *val = a->val + a->row[r];
    double coupling = 0, shift = a->gain * a->shift[i] + gas, rhs = a->gain * a->source[i];
    double moment[3] = {0};
    int64_t count = 0;
    int64_t last = -1;
    bool sorted = true;
    for (int64_t k = pairs->begin[i]; k < pairs->end[i]; k++) {
        const double factor = pair_factor(a, i, pairs->col[k]);
        if (factor == 0) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, pairs, i, k);
        const double rho = mps_flux_density(flux, i, q.j);
        const float entry = (float)(a->c * factor * q.w /
                                    rho); /* the same from both sides, and in the diagonal */
        const double kij = (double)entry;
        rhs -= kij * (rho * mps_flux_body(flux, dim, i, q.j, q.d) - mps_flux_jump(flux, i, q.j));
        for (int d = 0; d < dim && a->moments; d++) moment[d] += kij * rho * q.d[d];
        const int32_t column = a->unknown[q.j];
        if (column < 0) {
            shift += kij;
            rhs += kij * a->value[q.j];
            continue;
        }
        coupling += kij;
        sorted = sorted & (q.j > last);
        last = q.j;
        col[count] = column;
        val[count++] = -entry;
    }
    if (coupling + shift == 0) { /* no pair: p = 0 */
        shift = a->c / a->density[i];
        rhs = 0;
    }
    a->diagonal[r] = coupling + shift;
    if (!sorted) sort_row(a->particle, col, val, count);
    a->rhs[r] = rhs;
    a->row_shift[r] = shift;
    for (int d = 0; d < dim && a->moments; d++) a->moments[r * dim + d] = moment[d];
    if (a->row_law) {
        a->row_gas[r] = gas;
        a->row_law[r] = gas > 0 ? a->law[i] : 0;
    }
}
MPS__LOOP(fill_rows, fill_row, assembly)

static mps_status reserve_entries(mps__ppe *e, int64_t entries)
{
    e->col = mps__scratch_take(e->context, e->scratch, COLUMNS, entries, sizeof *e->col);
    e->val = mps__scratch_take(e->context, e->scratch, VALUES, entries, sizeof *e->val);
    return e->col && e->val ? MPS_OK : MPS_E_NOMEM;
}

static assembly assembly_of(const mps__ppe *e, const mps_view *s, const mps__ppe_terms *t)
{
    const mps_stencil *pairs = t->equation.radius == MPS_NEAR ? &s->near : &s->far;
    return (assembly){.pairs = *pairs,
                      .flux = *t->flux,
                      .kind = s->kind,
                      .region = t->region,
                      .condition = t->condition,
                      .density = t->density,
                      .source = t->source,
                      .shift = t->shift,
                      .value = t->value,
                      .gas = t->gas,
                      .law = t->law,
                      .ghost = e->ghosts ? e->ghosts->ghost : NULL,
                      .c = 2.0 * s->dim / (pairs->n0 * pairs->lambda),
                      .surface = t->equation.complete_surface ? complete_flux(pairs) : 1.0,
                      .gain = t->equation.gain};
}

/* The arrays that rows write, once there is room for them. */
static void see_rows(assembly *a, const mps__ppe *e)
{
    a->unknown = e->unknown;
    a->particle = e->particle;
    a->row = e->row;
    a->col = e->col;
    a->val = e->val;
    a->diagonal = e->diagonal;
    a->rhs = e->rhs;
    a->row_shift = e->shift;
    a->row_gas = e->gas;
    a->row_law = e->law;
    a->moments = e->moments;
}

mps_status mps__ppe_fill(mps__ppe *e, const mps_view *s, const mps__ppe_terms *t)
{
    assembly a = assembly_of(e, s, t);
    MPS__TRY(number_rows(e, s, &a));
    see_rows(&a, e);
    MPS__TRY(reserve_entries(e, start_rows(e, &a)));
    see_rows(&a, e);
    mps__loop_run(a.pairs.parallel, &fill_rows, s->dim, e->n, &a);
    return MPS_OK;
}

/* ---- what rows are not made of ---- */

/* Also of columns of other ranks. */
typedef struct notes {
    const double *place, *pressure; /* of particles */
    const int32_t *particle;
    int64_t rows;
    double dt2;
    double *x, *p, *weight;
} notes;

MPS_ROW void note_row(const int dim, const notes *a, int64_t r)
{
    const int64_t i = a->particle[r];
    a->p[r] = a->pressure[i];
    for (int d = 0; d < dim; d++) a->x[r * dim + d] = a->place[i * dim + d];
    if (r < a->rows) a->weight[r] = a->dt2;
}
MPS__LOOP(note_rows, note_row, notes)

mps_status mps__ppe_note(mps__ppe *e, const mps_view *s, const mps__ppe_terms *t)
{
    const mps_parallel *parallel = s->far.parallel;
    mps__loop_run(
        parallel, &note_rows, s->dim, e->columns,
        &(notes){s->x, t->pressure, e->particle, e->n, s->dt * s->dt, e->x, e->p, e->weight});
    MPS__TRY(mps__ppe_ranks_set(e));
    int32_t singular;
    MPS__TRY(mps__levels_find(e, s->id, parallel, &singular));
    e->problem = (mps_ppe_problem){.struct_size = sizeof e->problem,
                                   .dim = s->dim,
                                   .n = e->n,
                                   .row = e->row,
                                   .col = e->col,
                                   .val = e->val,
                                   .diagonal = e->diagonal,
                                   .rhs = e->rhs,
                                   .shift = e->shift,
                                   .weight = e->weight,
                                   .x = e->x,
                                   .dp = s->dp,
                                   .components = singular,
                                   .component = singular ? e->component : NULL,
                                   .gas = e->gas,
                                   .law = e->law,
                                   .parallel = parallel,
                                   .ranks = e->ranks.ranks > 1 ? &e->ranks : NULL};
    return MPS_OK;
}

typedef struct scatter {
    const int32_t *unknown, *condition;
    const double *solution, *value;
    double *p;
} scatter;

MPS_ROW void scatter_row(const int dim, const scatter *c, int64_t i)
{
    (void)dim;
    if (c->unknown[i] >= 0)
        c->p[i] = c->solution[c->unknown[i]];
    else
        c->p[i] = c->condition[i] == MPS_ROW_FIXED ? c->value[i] : 0;
}
MPS__LOOP(scatter_rows, scatter_row, scatter)

void mps__ppe_scatter(const mps__ppe *e, const mps_view *s, const mps__ppe_terms *t, double *p)
{
    mps__loop_run(s->far.parallel, &scatter_rows, s->dim, s->n,
                  &(scatter){e->unknown, t->condition, e->p, t->value, p});
}

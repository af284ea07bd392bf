/* SPDX-License-Identifier: BSD-3-Clause */
/* Lower bounds of the pressure: walls do not pull where void can reach. For rows i with a bound
 *   p_i >= least_i,   r_i = (A p - b)_i >= 0,   (p_i - least_i) r_i = 0,   elsewhere A p = b,
 * a linear complementarity problem with an M-matrix, solved by an active-set (policy) iteration:
 * solve with the pressures of the active rows fixed at their bounds; then activate rows below their
 * bounds and release active rows with r_i < 0, until the set is unchanged. It starts with the set
 * and the pressures of the last step, so that usually two solutions are enough: a loose one, and an
 * accurate one that starts from it. Fixing a row changes neither its diagonal nor those of its
 * neighbours, so that all solutions share one preconditioner.
 * The matrix is assembled once: pairs of active rows are moved to the right side in place, and
 * restored after the solution. Each row modifies only its own entries, so that the rows may be
 * distributed over ranks. */
#include "bounds.h"
#include "loop.h"
#include <math.h>
#include <string.h>

/* Solutions of a step at most: the iteration continues in the next step. */
enum { SOLVES = 5 };

/* Tolerance factor of the first solution, which only has to determine the active set. */
static const double LOOSE = 100;

/* Tolerance factor for the change of pressures by the acceleration of the tank. */
static const double ACCURATE = 1000;

struct mps__bound {
    int64_t row;
    double least, margin; /* [Pa] */
    bool active;
};

/* Saved entry of the matrix, with right side and shift of its row. */
struct mps__change {
    int64_t place, row; /* place: index of the entry, -1: right side and shift alone */
    double rhs, shift;
    float value;
};

void mps__bounds_init(mps__bounds *b, mps__context *context)
{
    *b = (mps__bounds){.context = context};
}

void mps__bounds_free(mps__bounds *b)
{
    mps__free(b->context, b->list);
    mps__free(b->context, b->change);
    mps__free(b->context, b->fixed);
    mps__free(b->context, b->mark);
    mps__bounds_init(b, b->context);
}

/* Rows of components without a pressure datum are skipped: their pressures are known up to a
 * constant. */
static mps_status collect(mps__bounds *b, const mps__ppe *e, const mps_view *s,
                          const mps__ppe_terms *t)
{
    const int32_t *component = e->problem.component; /* NULL: every component has a datum */
    b->count = 0;
    for (int64_t r = 0; r < e->n; r++) {
        const int64_t i = e->particle[r];
        if (t->condition[i] != MPS_ROW_LEAST || (component && component[r] >= 0) ||
            (e->law && e->law[r] > 0))
            continue;
        MPS__TRY(mps__grow(b->context, (void **)&b->list, &b->capacity, b->count, b->count + 1,
                           sizeof *b->list));
        const double margin = MPS__BOUNDS_NEARLY * t->flux->density[i] * s->velocity_scale *
                              s->velocity_scale;
        b->list[b->count++] = (struct mps__bound){r, t->value[i], margin, b->active[i] != 0};
    }
    return MPS_OK;
}

static void note(mps__bounds *b, const mps__ppe *e, int64_t row, int64_t place)
{
    b->change[b->changes++] = (struct mps__change){place, row, e->rhs[row], e->shift[row],
                                                   place < 0 ? 0 : e->val[place]};
}

/* Fix row r: p = least if it is active, otherwise the pressures of its active columns become
 * known. */
static mps_status fix(mps__bounds *b, mps__ppe *e, int64_t r)
{
    const bool own = isfinite(b->fixed[r]);
    MPS__TRY(mps__grow(b->context, (void **)&b->change, &b->changes_capacity, b->changes,
                       b->changes + e->row[r + 1] - e->row[r] + 1, sizeof *b->change));
    for (int64_t p = e->row[r]; p < e->row[r + 1]; p++) {
        const double least = b->fixed[e->col[p]], kij = -(double)e->val[p];
        if (kij == 0 || !(own || isfinite(least))) continue;
        note(b, e, r, p);
        e->val[p] = 0;
        if (own) continue;
        e->rhs[r] += kij * least;
        e->shift[r] += kij;
    }
    if (!own) return MPS_OK;
    note(b, e, r, -1);
    e->shift[r] = e->diagonal[r];
    e->rhs[r] = e->diagonal[r] * b->fixed[r];
    return MPS_OK;
}

/* Mark active rows and rows with an active column: from the active rows by symmetry, and for
 * columns of other ranks by a search of the own rows. */
static void mark_rows(mps__bounds *b, const mps__ppe *e)
{
    if (e->n > 0) memset(b->mark, 0, (size_t)e->n);
    for (int64_t k = 0; k < b->count; k++) {
        const int64_t r = b->list[k].row;
        if (!b->list[k].active) continue;
        b->mark[r] = 1;
        for (int64_t p = e->row[r]; p < e->row[r + 1]; p++)
            if (e->col[p] < e->n) b->mark[e->col[p]] = 1;
    }
    for (int64_t r = 0; e->problem.ranks && r < e->n; r++)
        for (int64_t p = e->row[r]; p < e->row[r + 1] && !b->mark[r]; p++)
            b->mark[r] = e->col[p] >= e->n && isfinite(b->fixed[e->col[p]]);
}

static mps_status fix_rows(mps__bounds *b, mps__ppe *e)
{
    MPS__TRY(mps__grow(b->context, (void **)&b->fixed, &b->fixed_capacity, 0, e->columns + 1,
                       sizeof *b->fixed));
    MPS__TRY(mps__grow(b->context, (void **)&b->mark, &b->mark_capacity, 0, e->n + 1, 1));
    for (int64_t c = 0; c < e->columns; c++) b->fixed[c] = NAN;
    for (int64_t k = 0; k < b->count; k++)
        if (b->list[k].active) b->fixed[b->list[k].row] = b->still ? 0 : b->list[k].least;
    if (mps_ppe_halo(&e->problem, b->fixed)) return mps__ranks_status(e->ghosts->ranks);
    mark_rows(b, e);
    for (int64_t r = 0; r < e->n; r++)
        if (b->mark[r]) MPS__TRY(fix(b, e, r));
    return MPS_OK;
}

/* Restore the assembled equation, bit by bit. */
static void let_go(mps__bounds *b, mps__ppe *e)
{
    while (b->changes > 0) {
        const struct mps__change *c = &b->change[--b->changes];
        e->rhs[c->row] = c->rhs;
        e->shift[c->row] = c->shift;
        if (c->place >= 0) e->val[c->place] = c->value;
    }
}

static double residual(const mps__ppe *e, int64_t r)
{
    double sum = e->diagonal[r] * e->p[r] - e->rhs[r];
    for (int64_t p = e->row[r]; p < e->row[r + 1]; p++) sum += (double)e->val[p] * e->p[e->col[p]];
    return sum;
}

/* Logical or over all ranks. */
static bool on_any_rank(const mps__ppe *e, bool on_this_rank)
{
    double any = on_this_rank;
    if (e->problem.ranks) mps__ranks_max(e->ghosts->ranks, 1, &any);
    return any > 0;
}

/* Update the active set. @param seen  `reduced` of the hint of a solver, NaN: none @return whether
 * the set has changed */
static bool choose(mps__bounds *b, const mps__ppe *e, double seen)
{
    bool changed = false;
    if (e->device) return b->any && on_any_rank(e, mps__bounds_choose_device(b, e, seen));
    for (int64_t k = 0; k < b->count; k++) {
        struct mps__bound *row = &b->list[k];
        const bool active = row->active
                                ? residual(e, row->row) >= -row->margin * e->diagonal[row->row]
                                : e->p[row->row] < row->least - row->margin;
        changed = changed || active != row->active;
        row->active = active;
    }
    return on_any_rank(e, changed);
}

static mps_status solve_active(mps__bounds *b, mps__solvers *solvers, mps__ppe *e,
                               const mps__effort *effort, mps_ppe_result *result)
{
    mps_status status = MPS_OK;
    solvers->hint = (mps_ppe_hint){.struct_size = sizeof solvers->hint,
                                   .unsolvable = e->device ? &e->counts_device->lacking : NULL,
                                   .owner = b,
                                   .reduced = NAN};
    if (b->any && e->device) solvers->hint.reduce = mps__bounds_look_device;
    if (b->any && e->device)
        status = mps__bounds_fix_device(b, e);
    else if (b->any)
        status = fix_rows(b, e);
    if (status == MPS_OK)
        status = mps__solvers_solve_series(solvers, &e->problem, effort, e->p, result);
    solvers->hint.reduce = NULL;
    if (b->any && e->device)
        mps__bounds_restore_device(b, e);
    else
        let_go(b, e);
    return status;
}

/* Collect the rows with a lower bound. */
static mps_status begin(mps__bounds *b, mps__ppe *e, const mps_view *s, const mps__ppe_terms *t)
{
    b->count = 0;
    if (e->device) {
        b->any = on_any_rank(e, e->bounded);
        return b->any ? mps__bounds_begin_device(b, e, s, t) : MPS_OK;
    }
    MPS__TRY(collect(b, e, s, t));
    b->any = on_any_rank(e, b->count > 0);
    return MPS_OK;
}

mps_status mps__bounds_solve(mps__bounds *b, mps__solvers *solvers, mps__ppe *e, const mps_view *s,
                             mps__ppe_terms *t, mps_ppe_result *result)
{
    mps_status status = MPS_OK;
    int32_t iterations = 0;
    double setup = 0;
    bool again = true;
    MPS__TRY(begin(b, e, s, t));
    bool last = !b->any;
    for (b->solves = 0; again; last = true) {
        status = solve_active(b, solvers, e, &(mps__effort){last ? 1 : LOOSE, b->solves > 0},
                              result);
        if (status < 0) return status;
        b->solves++;
        iterations += result->iterations;
        setup += result->setup_seconds;
        if (mps_ppe_halo(&e->problem, e->p)) return mps__ranks_status(e->ghosts->ranks);
        const bool changed = status == MPS_OK && choose(b, e, solvers->hint.reduced);
        again = status == MPS_OK && (!last || (changed && b->solves < SOLVES));
    }
    for (int64_t k = 0; k < b->count; k++)
        if (b->list[k].active) t->condition[e->particle[b->list[k].row]] = MPS__ROW_ACTIVE;
    if (b->any && e->device) mps__bounds_conditions_device(b, e);
    result->iterations = iterations;
    result->setup_seconds = setup;
    return status;
}

/* Linearise the laws at e->p (sign 1), or undo it (sign -1). */
static void make_tangent(mps__ppe *e, double sign)
{
    for (int64_t r = 0; e->law && r < e->n; r++) {
        double slope;
        mps_ppe_law(e->law[r], e->p[r], &slope);
        const double change = sign * e->gas[r] * (slope - 1);
        e->diagonal[r] += change;
        e->shift[r] += change;
    }
}

mps_status mps__bounds_solve_change(mps__bounds *b, mps__solvers *solvers, mps__ppe *e, double *rhs,
                                    double *p, mps_ppe_result *result)
{
    mps__ppe linear = *e;
    make_tangent(e, 1);
    linear.rhs = rhs;
    linear.p = p;
    linear.problem.rhs = rhs;
    linear.problem.gas = linear.problem.law = NULL;
    b->still = true;
    const mps_status status = solve_active(b, solvers, &linear, &(mps__effort){ACCURATE, true},
                                           result);
    b->still = false;
    make_tangent(e, -1);
    return status;
}

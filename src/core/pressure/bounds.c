/* SPDX-License-Identifier: BSD-3-Clause */
/* Walls do not pull where void can reach. For rows i with a least pressure
 *   p_i >= least_i,   r_i = (A p - b)_i >= 0,   (p_i - least_i) r_i = 0,   elsewhere A p = b,
 * a linear complementarity problem with an M-matrix. Policy iteration solves it: the equation with the pressures of a set of rows held
 * at their least; then rows below their least are held and held rows with r_i < 0 are let go, until the set stays. It begins with the set and
 * the pressures of the last step, so that mostly two solutions are enough: a loose one that chooses the set, and that of the chosen set, which
 * begins there. Holding a row leaves its diagonal and those about it as they are, so that all share the preconditioner of the first.
 * Held rows are pinned in place, A being assembled once: their pairs are moved to the right side, and back after the solution. */
#include "bounds.h"
#include <math.h>
#include <string.h>

/* Solutions of a step at most: what is not settled then is so in the next step. */
enum { SOLVES = 5 };

/* The first solution only has to say which rows are held: its tolerances are so many times those of the others. */
static const double LOOSE = 100;

/* Pressures this near to their least, over rho U_g^2, are at it. */
static const double NEARLY = 1e-3;

struct mps__bound {
    int64_t row;
    double least, margin; /* [Pa] */
    bool held;
};

/* What stood in a place of the matrix, and in the row of its column. */
struct mps__change {
    int64_t place, row; /* place -1: the row alone */
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
    mps__bounds_init(b, b->context);
}

/* Rows of components whose level is free are left out: their pressures are known but for a constant. */
static mps_status collect(mps__bounds *b, const mps__ppe *e, const mps_stage *s,
                          const mps__ppe_terms *t)
{
    const int32_t *component = e->problem.component; /* NULL: none without a level */
    b->count = 0;
    for (int64_t r = 0; r < e->n; r++) {
        const int64_t i = e->particle[r];
        if (t->condition[i] != MPS_ROW_LEAST || (component && component[r] >= 0) ||
            (e->law && e->law[r] > 0))
            continue;
        MPS__TRY(mps__grow(b->context, (void **)&b->list, &b->capacity, b->count, b->count + 1,
                           sizeof *b->list));
        const double margin = NEARLY * t->flux->density[i] * s->velocity_scale * s->velocity_scale;
        b->list[b->count++] = (struct mps__bound){r, t->value[i], margin, b->held[i] != 0};
    }
    return MPS_OK;
}

/* Place of the entry of row r in column c; rows are sorted. */
static int64_t entry(const mps__ppe *e, int64_t r, int32_t c)
{
    int64_t lo = e->row[r], hi = e->row[r + 1] - 1;
    while (lo < hi) {
        const int64_t mid = lo + (hi - lo) / 2;
        if (e->col[mid] < c)
            lo = mid + 1;
        else
            hi = mid;
    }
    return lo;
}

static void note(mps__bounds *b, const mps__ppe *e, int64_t row, int64_t place)
{
    b->change[b->changes++] = (struct mps__change){place, row, e->rhs[row], e->shift[row],
                                                   place < 0 ? 0 : e->val[place]};
}

/* Row k of the list becomes p = least. */
static mps_status pin(mps__bounds *b, mps__ppe *e, const struct mps__bound *k)
{
    const int64_t r = k->row, wanted = b->changes + 2 * (e->row[r + 1] - e->row[r]) + 1;
    MPS__TRY(mps__grow(b->context, (void **)&b->change, &b->changes_capacity, b->changes, wanted,
                       sizeof *b->change));
    for (int64_t p = e->row[r]; p < e->row[r + 1]; p++) {
        const int32_t c = e->col[p];
        const double kij = -(double)e->val[p];
        if (kij == 0) continue;
        const int64_t other = entry(e, c, (int32_t)r);
        note(b, e, c, other);
        e->val[other] = 0;
        e->rhs[c] += kij * k->least;
        e->shift[c] += kij;
        note(b, e, r, p);
        e->val[p] = 0;
    }
    note(b, e, r, -1);
    e->shift[r] = e->diagonal[r];
    e->rhs[r] = e->diagonal[r] * k->least;
    return MPS_OK;
}

/* The equation as it was assembled, to the bit. */
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

/* @return whether the set has changed */
static bool choose(mps__bounds *b, const mps__ppe *e)
{
    bool changed = false;
    for (int64_t k = 0; k < b->count; k++) {
        struct mps__bound *row = &b->list[k];
        const bool held = row->held ? residual(e, row->row) >= -row->margin * e->diagonal[row->row]
                                    : e->p[row->row] < row->least - row->margin;
        changed = changed || held != row->held;
        row->held = held;
    }
    return changed;
}

static mps_status solve_held(mps__bounds *b, mps__solvers *solvers, mps__ppe *e,
                             const mps__effort *effort, mps_ppe_result *result)
{
    mps_status status = MPS_OK;
    for (int64_t k = 0; k < b->count && status == MPS_OK; k++)
        if (b->list[k].held) status = pin(b, e, &b->list[k]);
    if (status == MPS_OK)
        status = mps__solvers_solve_series(solvers, &e->problem, effort, e->p, result);
    let_go(b, e);
    return status;
}

mps_status mps__bounds_solve(mps__bounds *b, mps__solvers *solvers, mps__ppe *e, const mps_stage *s,
                             mps__ppe_terms *t, mps_ppe_result *result)
{
    mps_status status = MPS_OK;
    int32_t iterations = 0;
    double setup = 0;
    bool again = true;
    MPS__TRY(collect(b, e, s, t));
    bool last = b->count == 0;
    for (b->solves = 0; again; last = true) {
        status = solve_held(b, solvers, e, &(mps__effort){last ? 1 : LOOSE, b->solves > 0}, result);
        if (status < 0) return status;
        b->solves++;
        iterations += result->iterations;
        setup += result->setup_seconds;
        const bool changed = status == MPS_OK && choose(b, e);
        again = status == MPS_OK && (!last || (changed && b->solves < SOLVES));
    }
    for (int64_t k = 0; k < b->count; k++)
        if (b->list[k].held) t->condition[e->particle[b->list[k].row]] = MPS__ROW_HELD;
    result->iterations = iterations;
    result->setup_seconds = setup;
    return status;
}

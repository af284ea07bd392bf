/* SPDX-License-Identifier: BSD-3-Clause */
/* Passes of conjugate gradients on a device, as in krylov.c: first guess and its residual, runs,
 * corrections. Decisions are made on the device; the host waits for all of them at once, before the
 * set-up of a preconditioner and after iterations. */
#include "cg_workspace.h"

MPS_ROW void begin_row(const mps__cg_recurrence *f, int64_t i, double *values)
{
    values[0] = f->rhs[i] * f->rhs[i];
    if (0 * f->solution[i] != 0) values[1] = 1;
    if (-f->diagonal[i] > values[2]) values[2] = -f->diagonal[i];
}
MPS__VALUES_ANY(beginnings, begin_row, mps__cg_recurrence, 1, 2)

/* A guess with NaN or infinity becomes zero; for a zero right side the solution is zero. */
MPS_ROW void guess(const mps__cg_recurrence *f, int64_t i)
{
    if (f->begun->poison > 0 || mps_exact_value(&f->begun->rhs_squares) == 0) f->solution[i] = 0;
    f->start[i] = f->solution[i];
}
MPS__LOOP_ANY(guesses, guess, mps__cg_recurrence)

/* Checks a row as mps_ppe_check() does. */
MPS_ROW void check_row(const mps__cg_recurrence *f, int64_t i, double *values)
{
    const double *p = f->solution;
    double s = f->diagonal[i] * p[i], *maxima = values + 2;
    if (f->n->over) return;
    for (int64_t k = f->row[i]; k < f->row[i + 1]; k++) s += (double)f->val[k] * p[f->col[k]];
    const double r = f->rhs[i] - s, d = f->weight ? fabs(r * f->weight[i]) : 0;
    f->r[i] = r;
    values[0] = r * r;
    values[1] = f->rhs[i] * f->rhs[i];
    if (d > maxima[0]) maxima[0] = d;
    if (0 * d != 0) maxima[1] = 1;
}
MPS__VALUES_ANY(checks, check_row, mps__cg_recurrence, 2, 2)

MPS_ROW void poison_row(const mps__cg_recurrence *f, int64_t i, double *values)
{
    if (0 * f->x[i] != 0) values[0] = 1;
}
MPS__VALUES_ANY(poisons, poison_row, mps__cg_recurrence, 0, 1)

MPS_ROW void correct(const mps__cg_recurrence *f, int64_t i)
{
    if (!f->n->over) f->solution[i] += *f->poison > 0 ? 0 : f->x[i];
}
MPS__LOOP_ANY(corrections, correct, mps__cg_recurrence)

MPS_ROW void report(const mps__cg_recurrence *f, int64_t i)
{
    (void)i;
    if (f->n->over) return;
    mps__cg_note_residual(f, NOW);
    f->n->over = 1;
}
MPS__LOOP_ANY(reports, report, mps__cg_recurrence)

size_t mps__cg_bytes(void)
{
    return sizeof(mps__cg_workspace);
}

/* ---- the queue ---- */

/* Queue the guess, its residual, and the decision whether a run begins. */
static void queue_beginning(mps__cg_solving *s)
{
    mps__device_clear(s->device, s->on_device, sizeof *s->on_device);
    mps__cg_queue_values(s, &beginnings, &s->on_device->begun);
    mps__cg_queue_rows(s, &guesses, s->n);
    mps__cg_queue_values(s, &checks, &s->on_device->checked);
    mps__cg_queue_decision(s, WHETHER_TO_BEGIN);
}

/* Queue the steps after a run: its correction and the new residual. */
static void queue_end(mps__cg_solving *s)
{
    s->device->cancel = &s->on_device->numbers.over;
    mps__cg_queue_values(s, &poisons, &s->on_device->poison);
    mps__cg_queue_rows(s, &corrections, s->n);
    mps__cg_queue_values(s, &checks, &s->on_device->checked);
    mps__cg_queue_rows(s, &reports, 1);
    s->device->cancel = NULL;
}

/* Wait for the numbers, and for the value of the pressures that the caller requested. */
static mps__cg_numbers fetch(const mps__cg_solving *s)
{
    mps_ppe_hint *hint = s->c->problem->hint;
    mps__cg_numbers n = {.stop = BROKEN};
    if (hint && hint->reduce) hint->reduce(hint->owner, &s->on_device->numbers.reduced);
    mps__device_download(s->device, &n, &s->on_device->numbers, sizeof n);
    if (hint) hint->reduced = hint->reduce ? n.reduced : NAN;
    if (hint) hint->refused = n.stop == REFUSED;
    if (s->device->failed) n = (mps__cg_numbers){.stop = BROKEN};
    return n;
}

/* A run from x = 0; it may stop before its first iteration. `reason`: failure of the host, which
 * ends it too. */
static mps__cg_numbers run(mps__cg_solving *s, int *reason)
{
    mps__cg_numbers n = {.stop = RUNNING};
    mps__vectors_clear(s->parallel, s->n, s->f.x);
    for (int64_t queued = 0; n.stop == RUNNING && queued < s->f.most && !*reason;) {
        s->device->cancel = &s->on_device->numbers.stop;
        for (int k = 0; k < MPS__CG_AT_ONCE && queued < s->f.most && !*reason; k++, queued++)
            *reason = mps__cg_queue_iteration(s);
        s->device->cancel = NULL;
        if (*reason) mps__device_clear(s->device, &s->on_device->numbers.over, sizeof n.over);
        queue_end(s);
        n = fetch(s);
    }
    return n;
}

/* ---- a solution ---- */

/* Reason of failure of a run; 0: none. */
static int failure_of(const mps__cg_solving *s, const mps__cg_numbers *n)
{
    static const int reasons[] = {[POISONED] = MPS_PPE_NAN,
                                  [NEGATIVE] = MPS_PPE_INDEFINITE,
                                  [BROKEN] = MPS_PPE_BREAKDOWN,
                                  [CURVED] = MPS_PPE_INDEFINITE};
    if (n->stop == CURVED && !mps__curvature_negative(s->c->problem, s->c->array[1], n->curvature))
        return MPS_PPE_BREAKDOWN;
    return n->stop <= CURVED ? reasons[n->stop] : 0;
}

/* Queue a zero guess after a guess without finite residual. */
static void queue_zeros(mps__cg_solving *s)
{
    mps__vectors_clear(s->parallel, s->n, s->f.solution);
    queue_beginning(s);
}

static void set_result(mps_ppe_result *result, const mps__cg_numbers *n, int of)
{
    result->residual = n->residual[of];
    result->divergence = n->divergence[of];
}

static void note_guess(mps__cg_solving *s, mps_ppe_result *result, const mps__cg_numbers *n)
{
    set_result(result, n, GUESS);
    s->excess = mps__result_excess(s->c->problem, result);
}

/* Reason that keeps a run from beginning; < 0: none. */
static int obstacle_of(const mps__cg_numbers *n)
{
    if (n->stop == SOLVED) return MPS_PPE_CONVERGED;
    if (n->stop == NEGATIVE_ROW) return MPS_PPE_INDEFINITE;
    return n->stop == NOWHERE || n->stop == REFUSED ? MPS_PPE_NAN : -1;
}

/* Wait for the results of the first guess. Returns a reason that ends the solution, < 0: none. */
static int look_at_beginning(mps__cg_solving *s, mps_ppe_result *result)
{
    mps__cg_numbers n = fetch(s);
    if (n.stop == NOWHERE) {
        queue_zeros(s);
        n = fetch(s);
    }
    note_guess(s, result, &n);
    return s->device->failed ? MPS_PPE_BREAKDOWN : obstacle_of(&n);
}

/* Set up the preconditioner. Returns 0 or a reason of failure. */
static int set_up(const mps__cg *c, mps_ppe_result *result)
{
    if (!c->pc) return 0;
    const double t = mps__seconds();
    const int reason = c->pc->setup(c->pc_self, c->problem);
    result->setup_seconds = mps__seconds() - t;
    return reason;
}

/* The first run, queued before the host knows whether it begins. */
static mps__cg_numbers run_at_once(mps__cg_solving *s, mps_ppe_result *result, int *reason)
{
    mps__cg_numbers n = run(s, reason);
    if (n.stop == NOWHERE) {
        queue_zeros(s);
        n = run(s, reason);
    }
    note_guess(s, result, &n);
    return n;
}

/* Repeat runs until the true residual is small enough. `known`: the first one begins. */
static int passes(mps__cg_solving *s, mps_ppe_result *result, bool known)
{
    const mps_ppe_problem *problem = s->c->problem;
    mps__progress progress = {0};
    for (;; known = true) {
        int reason = 0;
        s->f.most = problem->max_iterations - result->iterations;
        const mps__cg_numbers n = known ? run(s, &reason) : run_at_once(s, result, &reason);
        if (s->device->failed) return MPS_PPE_BREAKDOWN;
        if (!known && obstacle_of(&n) >= 0) return obstacle_of(&n);
        if (progress.passes == 0) progress.best = s->excess;
        result->iterations += (int32_t)n.iterations;
        set_result(result, &n, NOW);
        if (!reason) reason = failure_of(s, &n);
        reason = mps__progress_after(&progress, mps__result_excess(problem, result), reason);
        if (reason >= 0) return reason;
        if (result->iterations >= problem->max_iterations) return MPS_PPE_MAX_ITERATIONS;
        mps__device_clear(s->device, &s->on_device->numbers.stop, sizeof n.stop);
        mps__cg_queue_decision(s, WHETHER_TO_GO_ON);
    }
}

static mps__cg_solving begin(const mps__cg *c)
{
    const mps_ppe_problem *e = c->problem;
    mps__cg_workspace *on_device = c->workspace;
    return (mps__cg_solving){.c = c,
                             .device = mps__device_of(e->parallel),
                             .parallel = e->parallel,
                             .n = e->n,
                             .on_device = on_device,
                             .f = {.n = &on_device->numbers,
                                   .begun = &on_device->begun,
                                   .checked = &on_device->checked,
                                   .got = &on_device->got,
                                   .poison = &on_device->poison,
                                   .unsolvable = e->hint ? e->hint->unsolvable : NULL,
                                   .row = e->row,
                                   .col = e->col,
                                   .val = e->val,
                                   .diagonal = e->diagonal,
                                   .rhs = e->rhs,
                                   .weight = e->weight,
                                   .solution = c->p,
                                   .start = c->start,
                                   .x = c->x,
                                   .r = c->r,
                                   .p = c->array[1],
                                   .z = c->pc ? c->array[0] : c->r,
                                   .product = c->array[2],
                                   .tolerance = e->tolerance,
                                   .divergence_limit = e->divergence,
                                   .most = e->max_iterations,
                                   .preconditioned = c->pc != NULL}};
}

int mps__cg_solve(const mps__cg *c, mps_ppe_result *result)
{
    const mps_ppe_problem *problem = c->problem;
    const bool ready = !c->pc || c->pc->setup_async;
    mps__cg_solving s = begin(c);
    queue_beginning(&s);
    int reason = ready ? -1 : look_at_beginning(&s, result);
    if (reason >= 0) return reason;
    reason = set_up(c, result);
    if (reason) return reason;
    reason = passes(&s, result, !ready);
    const bool failed = reason != MPS_PPE_CONVERGED && reason != MPS_PPE_MAX_ITERATIONS;
    if (failed || !(mps__result_excess(problem, result) <= s.excess)) {
        mps__vectors_copy(s.parallel, s.n, c->start, c->p);
        mps_ppe_check(problem, c->p, c->r, result);
        if (problem->hint) problem->hint->reduced = NAN;
    }
    return reason;
}

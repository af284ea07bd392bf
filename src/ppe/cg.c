/* SPDX-License-Identifier: BSD-3-Clause */
/* Conjugate gradients whose host does not look at each sum. A loop over one row decides: it stops the run by a number that all launches know, which
 * do nothing from then on. Launches that were queued behind it change neither the solution nor the numbers. */
#include "cg.h"
#include "kernels.h"
#include "loop.h"
#include <math.h>

/* Why a run has stopped, or what keeps one from beginning: no guess has a finite residual, it is solved, a row has a negative diagonal. */
enum { GOING, REACHED, USED_UP, POISONED, NEGATIVE, BROKEN, CURVED, NOWHERE, SOLVED, NEGATIVE_ROW };

/* Of a true residual: squares of it and of the right side; its largest element by the weights, and 1 if one is NaN or infinite. */
typedef struct checked {
    mps_exact squares, rhs_squares;
    double largest, poison;
} checked;

/* Of the right side and the first guess. */
typedef struct begun {
    mps_exact rhs_squares;
    double poison,
        negative; /* 1: the guess has NaN or infinity; largest of the negative diagonal */
} begun;

/* On the device; a wait brings them to the host. */
typedef struct numbers {
    int64_t stop; /* `unless` of the launches of a run */
    int64_t
        over; /* not 0: nothing follows the run, or it still goes on; `unless` of the launches behind it */
    int64_t iterations;
    double rz; /* r'z */
    double alpha, beta;
    double curvature; /* p'Ap */
    double norm_limit,
        delta; /* the run stops where the residual is at most that many times above its limits */
    double residual[2], divergence[2]; /* of the first guess, and now */
    double seen;                       /* of the hint */
} numbers;

enum { GUESS, NOW };

typedef struct room {
    numbers numbers;
    begun begun;
    checked checked;
    mps__gathered got;
    double poison; /* 1: the correction has NaN or infinity */
} room;

/* What a loop works on; each uses its own. */
typedef struct recurrence {
    numbers *n;
    const begun *begun;
    const checked *checked;
    const mps__gathered *got;
    const double *poison;
    /* the equation */
    const int64_t *row;
    const int32_t *col;
    const float *val;
    const double *diagonal, *rhs, *weight; /* the last of these NULL: none */
    double *solution, *start;
    double *x, *r, *p;
    const double *z, *product;
    double tolerance, divergence_limit;
    int64_t most;
    int32_t decision;
    bool preconditioned;
} recurrence;

/* What is decided. */
enum { WHETHER_TO_BEGIN, WHETHER_TO_GO_ON, WHETHER_TO_STOP, DIRECTION, STEP };

/* The weights of a run, whose divergence counts where it has a limit. */
MPS_ROW const double *weights_of(const recurrence *f)
{
    return f->divergence_limit > 0 ? f->weight : NULL;
}

/* How far the residual of a run is above the limits of both norms, by the roundings of N_VProd, N_VDotProd and SUNRsqrt. */
MPS_ROW double excess(const recurrence *f, double squares, double largest)
{
    const double norm = sqrt(squares) / f->n->norm_limit,
                 divergence = weights_of(f) ? (largest > 0 ? largest : 0) / f->divergence_limit : 0,
                 most = norm < divergence ? divergence : norm, square = most * most;
    return square <= 0 ? 0 : sqrt(square);
}

MPS_ROW int64_t whether_to_stop(const recurrence *f, double squares, double largest)
{
    if (excess(f, squares, largest) <= f->n->delta) return REACHED;
    return f->n->iterations == f->most ? USED_UP : GOING;
}

/* As mps_ppe_check() says. Returns the excess. */
MPS_ROW double note_residual(const recurrence *f, int of)
{
    const checked *c = f->checked;
    const double squares = mps_exact_value(&c->squares),
                 rhs_squares = mps_exact_value(&c->rhs_squares);
    f->n->residual[of] = sqrt(squares) / (rhs_squares > 0 ? sqrt(rhs_squares) : 1);
    f->n->divergence[of] = c->poison > 0 ? NAN : c->largest > 0 ? c->largest : 0;
    return mps__excess_of(f->n->residual[of], f->tolerance, f->n->divergence[of],
                          f->divergence_limit);
}

/* The first stop of a run from a residual that was checked. */
MPS_ROW int64_t begin_run(const recurrence *f, double now, double share)
{
    f->n->iterations = 0;
    f->n->delta = mps__aim(now / now * share, now);
    return whether_to_stop(f, mps_exact_value(&f->checked->squares), f->checked->largest);
}

MPS_ROW int64_t whether_to_begin(const recurrence *f)
{
    const double now = note_residual(f, GUESS);
    f->n->norm_limit = f->tolerance * sqrt(mps_exact_value(&f->begun->rhs_squares));
    if (!isfinite(f->n->residual[GUESS])) return NOWHERE;
    if (now <= 1) return SOLVED;
    return f->begun->negative > 0 ? NEGATIVE_ROW : begin_run(f, now, 1);
}

MPS_ROW int64_t whether_to_go_on(const recurrence *f)
{
    return begin_run(f,
                     mps__excess_of(f->n->residual[NOW], f->tolerance, f->n->divergence[NOW],
                                    f->divergence_limit),
                     0.5);
}

MPS_ROW int64_t direction(const recurrence *f, double rz)
{
    if (f->preconditioned && !isfinite(rz)) return POISONED;
    if (f->preconditioned && rz <= 0) return NEGATIVE;
    f->n->beta = rz / f->n->rz;
    f->n->rz = rz;
    return GOING;
}

MPS_ROW int64_t step(const recurrence *f, double curvature)
{
    f->n->iterations++;
    f->n->curvature = curvature;
    if (!isfinite(curvature)) return BROKEN;
    if (curvature <= 0) return CURVED;
    f->n->alpha = f->n->rz / curvature;
    return GOING;
}

MPS_ROW int64_t decision(const recurrence *f)
{
    const double sum = f->decision >= WHETHER_TO_STOP ? mps_exact_value(&f->got->sum) : 0;
    switch (f->decision) {
    case WHETHER_TO_BEGIN:
        return whether_to_begin(f);
    case WHETHER_TO_GO_ON:
        return whether_to_go_on(f);
    case WHETHER_TO_STOP:
        return whether_to_stop(f, sum, f->got->largest);
    case DIRECTION:
        return direction(f, sum);
    default:
        return step(f, sum);
    }
}

MPS_ROW void decide(const int dim, const recurrence *f, int64_t i)
{
    (void)dim, (void)i;
    if (f->n->stop) return;
    f->n->stop = decision(f);
    f->n->over = f->n->stop == GOING || f->n->stop >= NOWHERE;
}
MPS__LOOP_ANY(decisions, decide, recurrence)

/* The first direction is z itself. */
MPS_ROW void turn(const int dim, const recurrence *f, int64_t i)
{
    (void)dim;
    if (f->n->stop) return;
    f->p[i] = f->n->iterations == 0 ? f->z[i] : f->z[i] + f->n->beta * f->p[i];
}
MPS__LOOP_ANY(turns, turn, recurrence)

/* A step along p, and the norms of what is left. */
MPS_ROW void advance(const int dim, const recurrence *f, int64_t i, double *values)
{
    (void)dim;
    if (f->n->stop) return;
    const double alpha = f->n->alpha, along = alpha * f->p[i];
    const double r = f->r[i] + -alpha * f->product[i];
    const double size = weights_of(f) ? fabs(r * f->weight[i]) : 0;
    f->x[i] = f->n->iterations == 1 ? along : f->x[i] + along;
    f->r[i] = r;
    values[0] = r * r;
    if (size > values[1]) values[1] = size;
}
MPS__VALUES_ANY(advances, advance, recurrence, 1, 1)

/* ---- what stands about a run ---- */

MPS_ROW void begin_row(const int dim, const recurrence *f, int64_t i, double *values)
{
    (void)dim;
    values[0] = f->rhs[i] * f->rhs[i];
    if (0 * f->solution[i] != 0) values[1] = 1;
    if (-f->diagonal[i] > values[2]) values[2] = -f->diagonal[i];
}
MPS__VALUES_ANY(beginnings, begin_row, recurrence, 1, 2)

/* A guess with NaN or infinity becomes zero; of zeros the solution is known. */
MPS_ROW void guess(const int dim, const recurrence *f, int64_t i)
{
    (void)dim;
    if (f->begun->poison > 0 || mps_exact_value(&f->begun->rhs_squares) == 0) f->solution[i] = 0;
    f->start[i] = f->solution[i];
}
MPS__LOOP_ANY(guesses, guess, recurrence)

/* As mps_ppe_check() does it. */
MPS_ROW void check_row(const int dim, const recurrence *f, int64_t i, double *values)
{
    const double *p = f->solution;
    double s = f->diagonal[i] * p[i], *maxima = values + 2;
    (void)dim;
    if (f->n->over) return;
    for (int64_t k = f->row[i]; k < f->row[i + 1]; k++) s += (double)f->val[k] * p[f->col[k]];
    const double r = f->rhs[i] - s, d = f->weight ? fabs(r * f->weight[i]) : 0;
    f->r[i] = r;
    values[0] = r * r;
    values[1] = f->rhs[i] * f->rhs[i];
    if (d > maxima[0]) maxima[0] = d;
    if (0 * d != 0) maxima[1] = 1;
}
MPS__VALUES_ANY(checks, check_row, recurrence, 2, 2)

MPS_ROW void poison_row(const int dim, const recurrence *f, int64_t i, double *values)
{
    (void)dim;
    if (0 * f->x[i] != 0) values[0] = 1;
}
MPS__VALUES_ANY(poisons, poison_row, recurrence, 0, 1)

MPS_ROW void correct(const int dim, const recurrence *f, int64_t i)
{
    (void)dim;
    if (!f->n->over) f->solution[i] += *f->poison > 0 ? 0 : f->x[i];
}
MPS__LOOP_ANY(corrections, correct, recurrence)

MPS_ROW void tell(const int dim, const recurrence *f, int64_t i)
{
    (void)dim, (void)i;
    if (f->n->over) return;
    note_residual(f, NOW);
    f->n->over = 1;
}
MPS__LOOP_ANY(tellings, tell, recurrence)

size_t mps__cg_room(void)
{
    return sizeof(room);
}

/* ---- the queue ---- */

/* One solution in progress. */
typedef struct solving {
    const mps__cg *c;
    mps__device *device;
    const mps_parallel *parallel;
    int64_t n;
    room *there;
    recurrence f;
    double excess; /* of the guess */
} solving;

static void queue_rows(const solving *s, const mps__loop *loop, int64_t n)
{
    mps__loop_run(s->parallel, loop, MPS__ANY_DIM, n, &s->f);
}

static void queue_values(const solving *s, const mps__values *values, void *to)
{
    mps__values_gather(s->device, values, MPS__ANY_DIM, s->n, &s->f, to);
}

static void queue_decision(solving *s, int32_t decision)
{
    s->f.decision = decision;
    queue_rows(s, &decisions, 1);
}

/* z of the preconditioner, and the direction from it. Returns 0 or a reason of failure of the host. */
static int queue_direction(solving *s)
{
    const mps__cg *c = s->c;
    const int reason = c->pc ? c->pc->apply(c->pc_self, c->r, c->array[0]) : 0;
    if (reason) return reason;
    mps__vectors_gather_dot(c->problem, s->f.r, s->f.z, &s->there->got);
    queue_decision(s, DIRECTION);
    mps__loop_run_cheap(s->parallel, &turns, MPS__ANY_DIM, s->n, &s->f);
    return 0;
}

static void queue_step(solving *s)
{
    mps__rows_gather(s->c->problem, s->f.p, s->c->array[2], &s->there->got);
    queue_decision(s, STEP);
    queue_values(s, &advances, &s->there->got);
    queue_decision(s, WHETHER_TO_STOP);
}

/* The guess, its residual, and whether a run begins. */
static void queue_beginning(solving *s)
{
    mps__device_clear(s->device, s->there, sizeof *s->there);
    queue_values(s, &beginnings, &s->there->begun);
    queue_rows(s, &guesses, s->n);
    queue_values(s, &checks, &s->there->checked);
    queue_decision(s, WHETHER_TO_BEGIN);
}

/* What follows a run once it has stopped: the correction and the residual that it leaves. */
static void queue_end(solving *s)
{
    s->device->unless = &s->there->numbers.over;
    queue_values(s, &poisons, &s->there->poison);
    queue_rows(s, &corrections, s->n);
    queue_values(s, &checks, &s->there->checked);
    queue_rows(s, &tellings, 1);
    s->device->unless = NULL;
}

/* Wait for the numbers, and for what the caller wants to know of the pressures. */
static numbers fetch(const solving *s)
{
    mps__pcg_hint *hint = s->c->hint;
    numbers n = {.stop = BROKEN};
    if (hint && hint->look) hint->look(hint->owner, &s->there->numbers.seen);
    mps__device_download(s->device, &n, &s->there->numbers, sizeof n);
    if (hint) hint->seen = hint->look ? n.seen : NAN;
    return s->device->failed ? (numbers){.stop = BROKEN} : n;
}

/* A run from x = 0, which may have stopped before it begins. `reason`: of a failure of the host, which ends it too. */
static numbers run(solving *s, int *reason)
{
    numbers n = {.stop = GOING};
    mps__vectors_clear(s->parallel, s->n, s->f.x);
    for (int64_t queued = 0; n.stop == GOING && queued < s->f.most && !*reason;) {
        s->device->unless = &s->there->numbers.stop;
        for (int k = 0; k < MPS__CG_AT_ONCE && queued < s->f.most && !*reason; k++, queued++) {
            *reason = queue_direction(s);
            if (!*reason) queue_step(s);
        }
        s->device->unless = NULL;
        if (*reason) mps__device_clear(s->device, &s->there->numbers.over, sizeof n.over);
        queue_end(s);
        n = fetch(s);
    }
    return n;
}

/* ---- a solution ---- */

/* Why a run has failed; 0: it has not. */
static int failure_of(const solving *s, const numbers *n)
{
    static const int reasons[] = {[POISONED] = MPS_PPE_NAN,
                                  [NEGATIVE] = MPS_PPE_INDEFINITE,
                                  [BROKEN] = MPS_PPE_BREAKDOWN,
                                  [CURVED] = MPS_PPE_INDEFINITE};
    if (n->stop == CURVED && !mps__curvature_negative(s->c->problem, s->c->array[1], n->curvature))
        return MPS_PPE_BREAKDOWN;
    return n->stop <= CURVED ? reasons[n->stop] : 0;
}

/* Of a guess that leads nowhere zeros are the next one. */
static void queue_zeros(solving *s)
{
    mps__vectors_clear(s->parallel, s->n, s->f.solution);
    queue_beginning(s);
}

static void set_result(mps_ppe_result *result, const numbers *n, int of)
{
    result->residual = n->residual[of];
    result->divergence = n->divergence[of];
}

static void note_guess(solving *s, mps_ppe_result *result, const numbers *n)
{
    set_result(result, n, GUESS);
    s->excess = mps__result_excess(s->c->problem, result);
}

/* What keeps a run from beginning, a reason; < 0: nothing does. */
static int obstacle_of(const numbers *n)
{
    if (n->stop == SOLVED) return MPS_PPE_CONVERGED;
    if (n->stop == NEGATIVE_ROW) return MPS_PPE_INDEFINITE;
    return n->stop == NOWHERE ? MPS_PPE_NAN : -1;
}

/* Wait for what the beginning has found, then for the set-up of the preconditioner. Returns a reason that ends the solution, < 0: none. */
static int set_up(solving *s, mps_ppe_result *result)
{
    const mps__cg *c = s->c;
    numbers n = fetch(s);
    if (n.stop == NOWHERE) {
        queue_zeros(s);
        n = fetch(s);
    }
    note_guess(s, result, &n);
    if (s->device->failed) return MPS_PPE_BREAKDOWN;
    if (obstacle_of(&n) >= 0) return obstacle_of(&n);
    const double t = mps__seconds();
    const int reason = c->pc->setup(c->pc_self, c->problem);
    result->setup_seconds = mps__seconds() - t;
    return reason ? reason : -1;
}

/* The first run, where the host has not looked yet whether it begins. */
static numbers run_at_once(solving *s, mps_ppe_result *result, int *reason)
{
    numbers n = run(s, reason);
    if (n.stop == NOWHERE) {
        queue_zeros(s);
        n = run(s, reason);
    }
    note_guess(s, result, &n);
    return n;
}

/* Runs go on until the true residual is small enough. `known`: the first one begins. */
static int passes(solving *s, mps_ppe_result *result, bool known)
{
    const mps_ppe_problem *problem = s->c->problem;
    mps__progress progress = {0};
    for (;; known = true) {
        int reason = 0;
        s->f.most = problem->max_iterations - result->iterations;
        const numbers n = known ? run(s, &reason) : run_at_once(s, result, &reason);
        if (s->device->failed) return MPS_PPE_BREAKDOWN;
        if (!known && obstacle_of(&n) >= 0) return obstacle_of(&n);
        if (progress.passes == 0) progress.best = s->excess;
        result->iterations += (int32_t)n.iterations;
        set_result(result, &n, NOW);
        if (!reason) reason = failure_of(s, &n);
        reason = mps__progress_after(&progress, mps__result_excess(problem, result), reason);
        if (reason >= 0) return reason;
        if (result->iterations >= problem->max_iterations) return MPS_PPE_MAX_ITERATIONS;
        mps__device_clear(s->device, &s->there->numbers.stop, sizeof n.stop);
        queue_decision(s, WHETHER_TO_GO_ON);
    }
}

static solving begin(const mps__cg *c)
{
    const mps_ppe_problem *e = c->problem;
    room *there = c->room;
    return (solving){.c = c,
                     .device = mps__device_of(e->parallel),
                     .parallel = e->parallel,
                     .n = e->n,
                     .there = there,
                     .f = {.n = &there->numbers,
                           .begun = &there->begun,
                           .checked = &there->checked,
                           .got = &there->got,
                           .poison = &there->poison,
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
    const bool ready = !c->pc || (c->hint && c->hint->ready);
    solving s = begin(c);
    queue_beginning(&s);
    int reason = ready ? -1 : set_up(&s, result);
    if (reason >= 0) return reason;
    reason = passes(&s, result, !ready);
    const bool failed = reason != MPS_PPE_CONVERGED && reason != MPS_PPE_MAX_ITERATIONS;
    if (failed || !(mps__result_excess(problem, result) <= s.excess)) {
        mps__vectors_copy(s.parallel, s.n, c->start, c->p);
        mps_ppe_check(problem, c->p, c->r, result);
        if (c->hint) c->hint->seen = NAN;
    }
    return reason;
}

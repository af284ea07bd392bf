/* SPDX-License-Identifier: BSD-3-Clause */
/* Conjugate gradients whose host does not look at each sum. A loop over one row decides: it stops the run by a number that all launches know, which
 * do nothing from then on. Launches that were queued behind it change neither the solution nor the numbers. */
#include "cg.h"
#include "kernels.h"
#include "loop.h"
#include <math.h>

/* Why a run has stopped. */
enum { GOING, REACHED, USED_UP, POISONED, NEGATIVE, BROKEN, CURVED };

/* On the device; a wait brings them to the host. */
typedef struct numbers {
    int64_t stop; /* the launches' `unless` */
    int64_t iterations;
    double rz; /* r'z */
    double alpha, beta;
    double curvature; /* p'Ap */
} numbers;

typedef struct room {
    numbers numbers;
    mps__gathered got;
} room;

/* What a loop works on; each uses its own. */
typedef struct recurrence {
    numbers *n;
    const mps__gathered *got;
    double *x, *r, *p;
    const double *z, *product, *weight;
    double norm_limit, divergence_limit, delta;
    int64_t most;
    int32_t decision;
    bool checked; /* r'z of a preconditioner */
} recurrence;

/* What is decided from a sum. */
enum { WHETHER_TO_STOP, DIRECTION, STEP };

/* How far the residual is above the limits of both norms, by the roundings of N_VProd, N_VDotProd and SUNRsqrt. */
MPS_ROW double excess(const recurrence *f, double squares)
{
    const double norm = sqrt(squares) / f->norm_limit, largest = f->got->largest,
                 divergence = f->weight ? (largest > 0 ? largest : 0) / f->divergence_limit : 0,
                 most = norm < divergence ? divergence : norm, square = most * most;
    return square <= 0 ? 0 : sqrt(square);
}

MPS_ROW int64_t whether_to_stop(const recurrence *f, double squares)
{
    if (excess(f, squares) <= f->delta) return REACHED;
    return f->n->iterations == f->most ? USED_UP : GOING;
}

MPS_ROW int64_t direction(const recurrence *f, double rz)
{
    if (f->checked && !isfinite(rz)) return POISONED;
    if (f->checked && rz <= 0) return NEGATIVE;
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

MPS_ROW void decide(const int dim, const recurrence *f, int64_t i)
{
    (void)dim, (void)i;
    if (f->n->stop) return;
    const double sum = mps_exact_value(&f->got->sum);
    f->n->stop = f->decision == WHETHER_TO_STOP ? whether_to_stop(f, sum)
                 : f->decision == DIRECTION     ? direction(f, sum)
                                                : step(f, sum);
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
    const double size = f->weight ? fabs(r * f->weight[i]) : 0;
    f->x[i] = f->n->iterations == 1 ? along : f->x[i] + along;
    f->r[i] = r;
    values[0] = r * r;
    if (size > values[1]) values[1] = size;
}
MPS__VALUES_ANY(advances, advance, recurrence, 1, 1)

size_t mps__cg_room(void)
{
    return sizeof(room);
}

/* ---- the queue ---- */

static void queue_decision(const mps__cg *c, recurrence *f, int32_t decision)
{
    f->decision = decision;
    mps__loop_run(c->problem->parallel, &decisions, MPS__ANY_DIM, 1, f);
}

/* z of the preconditioner, and the direction from it. Returns 0 or a reason of failure of the host. */
static int queue_direction(const mps__cg *c, recurrence *f, mps__gathered *got)
{
    double *z = c->array[0];
    const int reason = c->pc ? c->pc->apply(c->pc_self, f->r, z) : 0;
    if (reason) return reason;
    mps__vectors_gather_dot(c->problem, f->r, f->z, got);
    queue_decision(c, f, DIRECTION);
    mps__loop_run_cheap(c->problem->parallel, &turns, MPS__ANY_DIM, c->problem->n, f);
    return 0;
}

static void queue_step(const mps__cg *c, recurrence *f, mps__gathered *got)
{
    mps__rows_gather(c->problem, f->p, c->array[2], got);
    queue_decision(c, f, STEP);
    mps__values_gather(mps__device_of(c->problem->parallel), &advances, MPS__ANY_DIM, c->problem->n,
                       f, got);
    queue_decision(c, f, WHETHER_TO_STOP);
}

/* Returns the numbers of a run that has stopped; `stop` GOING: the device has failed, or `reason` is one of the host. */
static numbers run(const mps__cg *c, mps__device *d, room *there, int *reason)
{
    numbers n = {.stop = GOING};
    mps__gathered *got = &there->got;
    recurrence f = {.n = &there->numbers,
                    .got = got,
                    .x = c->x,
                    .r = c->r,
                    .p = c->array[1],
                    .z = c->pc ? c->array[0] : c->r,
                    .product = c->array[2],
                    .weight = c->weight,
                    .norm_limit = c->norm_limit,
                    .divergence_limit = c->divergence_limit,
                    .delta = c->delta,
                    .most = c->most,
                    .checked = c->pc != NULL};
    mps__vectors_gather_norms(c->problem, c->r, c->weight, got);
    queue_decision(c, &f, WHETHER_TO_STOP);
    for (int32_t queued = 0; n.stop == GOING && queued < c->most && !d->failed && !*reason;) {
        for (int k = 0; k < MPS__CG_AT_ONCE && queued < c->most && !*reason; k++, queued++) {
            *reason = queue_direction(c, &f, got);
            if (!*reason) queue_step(c, &f, got);
        }
        mps__device_download(d, &n, &there->numbers, sizeof n);
    }
    if (d->failed) n = (numbers){.stop = BROKEN};
    return n;
}

int mps__cg_run(mps__cg *c)
{
    static const int reasons[] = {[POISONED] = MPS_PPE_NAN,
                                  [NEGATIVE] = MPS_PPE_INDEFINITE,
                                  [BROKEN] = MPS_PPE_BREAKDOWN,
                                  [CURVED] = MPS_PPE_INDEFINITE};
    mps__device *d = mps__device_of(c->problem->parallel);
    room *there = c->room;
    int reason = 0;
    mps__device_clear(d, there, sizeof *there);
    d->unless = &there->numbers.stop;
    const numbers n = run(c, d, there, &reason);
    d->unless = NULL;
    c->used = (int32_t)n.iterations;
    if (n.stop == GOING) return reason;
    if (n.stop == CURVED && !mps__curvature_negative(c->problem, c->array[1], n.curvature))
        return MPS_PPE_BREAKDOWN;
    return reasons[n.stop];
}

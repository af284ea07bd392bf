/* SPDX-License-Identifier: BSD-3-Clause */
/* Conjugate gradients without a host wait at each sum. A loop over one row decides: it ends the run
 * by setting a number that all launches test. Launches queued after that change neither the
 * solution nor the numbers. */
#include "cg_workspace.h"

/* Weights of the stopping criterion; NULL: no limit of the divergence. */
MPS_ROW const double *weights_of(const mps__cg_recurrence *f)
{
    return f->divergence_limit > 0 ? f->weight : NULL;
}

/* How far the residual of a run is above the limits of both norms, rounded as in N_VProd,
 * N_VDotProd and SUNRsqrt. */
MPS_ROW double excess(const mps__cg_recurrence *f, double squares, double largest)
{
    const double norm = sqrt(squares) / f->n->norm_limit,
                 divergence = weights_of(f) ? (largest > 0 ? largest : 0) / f->divergence_limit : 0,
                 most = norm < divergence ? divergence : norm, square = most * most;
    return square <= 0 ? 0 : sqrt(square);
}

MPS_ROW int64_t whether_to_stop(const mps__cg_recurrence *f, double squares, double largest)
{
    if (excess(f, squares, largest) <= f->n->delta) return REACHED;
    return f->n->iterations == f->most ? USED_UP : RUNNING;
}

/* First stopping test of a run, from a residual that was checked. */
MPS_ROW int64_t begin_run(const mps__cg_recurrence *f, double now, double share)
{
    f->n->iterations = 0;
    f->n->delta = mps__aim(now / now * share, now);
    return whether_to_stop(f, mps_exact_value(&f->checked->squares), f->checked->largest);
}

MPS_ROW int64_t whether_to_begin(const mps__cg_recurrence *f)
{
    const double now = mps__cg_note_residual(f, GUESS);
    f->n->norm_limit = f->tolerance * sqrt(mps_exact_value(&f->begun->rhs_squares));
    if (f->unsolvable && *f->unsolvable > -INFINITY) return REFUSED;
    if (!isfinite(f->n->residual[GUESS])) return NOWHERE;
    if (now <= 1) return SOLVED;
    return f->begun->negative > 0 ? NEGATIVE_ROW : begin_run(f, now, 1);
}

MPS_ROW int64_t whether_to_go_on(const mps__cg_recurrence *f)
{
    return begin_run(f,
                     mps__excess_of(f->n->residual[NOW], f->tolerance, f->n->divergence[NOW],
                                    f->divergence_limit),
                     0.5);
}

MPS_ROW int64_t direction(const mps__cg_recurrence *f, double rz)
{
    if (f->preconditioned && !isfinite(rz)) return POISONED;
    if (f->preconditioned && rz <= 0) return NEGATIVE;
    f->n->beta = rz / f->n->rz;
    f->n->rz = rz;
    return RUNNING;
}

MPS_ROW int64_t step(const mps__cg_recurrence *f, double curvature)
{
    f->n->iterations++;
    f->n->curvature = curvature;
    if (!isfinite(curvature)) return BROKEN;
    if (curvature <= 0) return CURVED;
    f->n->alpha = f->n->rz / curvature;
    return RUNNING;
}

MPS_ROW int64_t decision(const mps__cg_recurrence *f)
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

MPS_ROW void decide(const mps__cg_recurrence *f, int64_t i)
{
    (void)i;
    if (f->n->stop) return;
    f->n->stop = decision(f);
    f->n->over = f->n->stop == RUNNING || f->n->stop >= NOWHERE;
}
MPS__LOOP_ANY(decisions, decide, mps__cg_recurrence)

/* The next direction, p = z + beta p; the first one is z itself. */
MPS_ROW void redirect(const mps__cg_recurrence *f, int64_t i)
{
    if (f->n->stop) return;
    f->p[i] = f->n->iterations == 0 ? f->z[i] : f->z[i] + f->n->beta * f->p[i];
}
MPS__LOOP_ANY(redirections, redirect, mps__cg_recurrence)

/* A step along p, and the norms of the new residual. */
MPS_ROW void advance(const mps__cg_recurrence *f, int64_t i, double *values)
{
    if (f->n->stop) return;
    const double alpha = f->n->alpha, along = alpha * f->p[i];
    const double r = f->r[i] + -alpha * f->product[i];
    const double size = weights_of(f) ? fabs(r * f->weight[i]) : 0;
    f->x[i] = f->n->iterations == 1 ? along : f->x[i] + along;
    f->r[i] = r;
    values[0] = r * r;
    if (size > values[1]) values[1] = size;
}
MPS__VALUES_ANY(advances, advance, mps__cg_recurrence, 1, 1)

/* ---- the queue ---- */

void mps__cg_queue_decision(mps__cg_solving *s, int32_t decision)
{
    s->f.decision = decision;
    mps__cg_queue_rows(s, &decisions, 1);
}

/* Queue z = M^-1 r and the new direction. Returns 0 or a reason of failure of the host. */
static int queue_direction(mps__cg_solving *s)
{
    const mps__cg *c = s->c;
    const int reason = c->pc ? c->pc->apply(c->pc_self, c->r, c->array[0]) : 0;
    if (reason) return reason;
    mps__vectors_dot_async(c->problem, s->f.r, s->f.z, &s->on_device->got);
    mps__cg_queue_decision(s, DIRECTION);
    mps__loop_run_cheap(s->parallel, &redirections, MPS__ANY_DIM, s->n, &s->f);
    return 0;
}

static void queue_step(mps__cg_solving *s)
{
    mps__rows_multiply_async(s->c->problem, s->f.p, s->c->array[2], &s->on_device->got);
    mps__cg_queue_decision(s, STEP);
    mps__cg_queue_values(s, &advances, &s->on_device->got);
    mps__cg_queue_decision(s, WHETHER_TO_STOP);
}

int mps__cg_queue_iteration(mps__cg_solving *s)
{
    const int reason = queue_direction(s);
    if (!reason) queue_step(s);
    return reason;
}

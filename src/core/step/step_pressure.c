/* SPDX-License-Identifier: BSD-3-Clause */
/* The pressure part of a step: the equation, its solution, and what is told about it. */
#include "step.h"

/* Share of its way to that of the present step that the spread of pressures goes in a step. */
static const double SPREAD_SHARE = 0.2;

/* A gain g below 1 leaves (1 - g) dt/g =: T of a steady demand to later steps. In a shorter step g
 * would ask at once for what longer ones left: pressures would jump by (1 - g)(dt_before/dt - 1).
 * With g = dt/(dt + T) they do not depend on dt; T follows the steps slowly. */
static void spread_gain(mps__step *q)
{
    double *gain = &q->terms.equation.gain;
    const double dt = q->stage.dt, wanted = dt * (1 - *gain) / *gain;
    q->spread = q->w->state.spread > 0
                    ? q->w->state.spread + SPREAD_SHARE * (wanted - q->w->state.spread)
                    : wanted;
    *gain = dt / (dt + q->spread);
}

/* The law of a gas needs a solver of nonlinear rows. */
static mps_status check_laws(const mps__step *q)
{
    const mps__world *w = q->w;
    for (int64_t i = 0; i < q->stage.n && !w->solvers.use->nonlinear; i++)
        if (q->terms.law[i] > 0)
            return mps__fail(w->context, MPS_E_STATE,
                             "model '%s' makes the pressure equation nonlinear, and solver '%s' is "
                             "for linear ones: choose 'sundials.kinsol'",
                             mps__host_writer(&w->host, MPS__GAS_LAW), w->solvers.use->name);
    return MPS_OK;
}

/* An equation on many ranks needs a solver that knows of them. */
static mps_status check_ranks(const mps__step *q)
{
    const mps__solvers *s = &q->w->solvers;
    if (!mps__ranks_many(q->w->ghosts.ranks) || (s->use->ranks && (!s->pc || s->pc->ranks)))
        return MPS_OK;
    return mps__fail(q->w->context, MPS_E_STATE,
                     "solver '%s' with preconditioner '%s' works on one rank only: choose "
                     "'sundials.pcg' with 'auxgrid' or 'jacobi'",
                     s->use->name, s->pc ? s->pc->name : "none");
}

static void note_level(mps__step *q)
{
    mps__world *w = q->w;
    q->stage.level_free = w->ppe.level_free;
    if (!w->ppe.level_free || w->state.level_told) return;
    w->state.level_told = true;
    mps__log(w->context, MPS_LOG_INFO,
             "t = %.9g s: no surface, fixed pressure or compressible phase gives the pressures a "
             "level; their mean is zero",
             q->stage.t);
}

static mps_status solve(mps__step *q, mps_ppe_result *result)
{
    mps__world *w = q->w;
    w->bounds.held = w->particles.held;
    w->bounds.solves = 0;
    if (mps__ppe_rows(&w->ppe) == 0) return MPS_OK;
    const mps_status status = mps__bounds_solve(&w->bounds, &w->solvers, &w->ppe, &q->stage,
                                                &q->terms, result);
    /* a NaN of the prediction has a particle and a place */
    if (status == MPS_E_SOLVER) MPS__TRY(mps__world_check_result(w, &q->stage, q->moved, &q->info));
    if (status < 0)
        return mps__fail(w->context, status, "t = %.9g s: %.400s", q->stage.t, w->context->error);
    q->not_converged = status == MPS_W_NOT_CONVERGED;
    if (q->not_converged)
        mps__log(w->context, MPS_LOG_WARNING, "t = %.9g s: %.400s", q->stage.t, w->context->error);
    return MPS_OK;
}

/* What rows look at in their neighbours. */
static mps_status share_terms(mps__step *q)
{
    int32_t channel[3 + MPS__FLUX_CHANNELS] = {MPS__REGION, MPS__PRESSURE_CONDITION,
                                               MPS__PRESSURE_VALUE};
    mps__host_flux(&q->w->host, channel + 3);
    return mps__host_share(&q->w->host, channel, 3 + MPS__FLUX_CHANNELS);
}

/* <lap p> = source. W22 (10). */
mps_status mps__step_project(mps__step *q)
{
    mps__world *w = q->w;
    mps_ppe_result result = {.struct_size = sizeof result};
    mps__step_begin_equation(q);
    MPS__TRY(mps__step_run(q, MPS_SOURCE));
    MPS__TRY(check_laws(q));
    MPS__TRY(check_ranks(q));
    spread_gain(q);
    mps__step_end_stage(q, MPS_STAGE_OPERATORS);
    MPS__TRY(share_terms(q));
    MPS__TRY(mps__ppe_assemble(&w->ppe, &q->stage, &q->terms));
    note_level(q);
    mps__step_end_stage(q, MPS_STAGE_PPE_SETUP);
    MPS__TRY(solve(q, &result));
    mps__ppe_scatter(&w->ppe, &q->stage, &q->terms, w->particles.p);
    mps__host_written(&w->host, MPS__PRESSURE);
    q->info.ppe_solves = w->bounds.solves;
    q->info.ppe_iterations = result.iterations;
    q->info.ppe_residual = result.residual;
    q->info.ppe_divergence = result.divergence;
    q->info.ppe_unknowns = w->ppe.n;
    mps__step_end_stage(q, MPS_STAGE_PPE_SOLVE);
    q->info.seconds[MPS_STAGE_PPE_SOLVE] -= result.setup_seconds;
    q->info.seconds[MPS_STAGE_PPE_SETUP] += result.setup_seconds;
    return MPS_OK;
}

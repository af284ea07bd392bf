/* SPDX-License-Identifier: BSD-3-Clause */
/* The pressure part of a step: the equation, its solution, and messages about it. */
#include "step.h"
#include "levels.h"
#include "loop.h"
#include <mps/couple.h>
#include <stdio.h>

/* Relaxation factor of the pressure spread per step. */
static const double SPREAD_SHARE = 0.2;

/* A gain g below 1 defers (1 - g) dt/g =: T of a steady source to later steps. A shorter step with
 * the same g would apply at once what longer ones deferred: pressures would jump by (1 -
 * g)(dt_before/dt - 1). With g = dt/(dt + T) they do not depend on dt; T follows the steps
 * slowly. */
static void spread_gain(mps__step *q)
{
    double *gain = &q->terms.equation.gain;
    const double dt = q->view.dt, wanted = dt * (1 - *gain) / *gain;
    q->next.spread = q->w->state.spread > 0
                         ? q->w->state.spread + SPREAD_SHARE * (wanted - q->w->state.spread)
                         : wanted;
    *gain = dt / (dt + q->next.spread);
}

typedef struct law_fields {
    const double *law;
} law_fields;

MPS_ROW bool has_law(const law_fields *f, int64_t i)
{
    return f->law[i] > 0;
}
MPS__FIRST(laws, has_law, law_fields)

/* A gas law needs a solver of nonlinear equations. */
static mps_status check_laws(mps__step *q, const double *law)
{
    const mps__world *w = q->w;
    const bool written = mps__runner_writer(&w->runner, MPS__GAS_LAW) != NULL;
    q->terms.linear = !written || !w->solvers.use->nonlinear;
    if (written && !w->solvers.use->nonlinear &&
        mps__first_run(&w->pool.parallel, &laws, q->view.n, &(law_fields){law}) < q->view.n)
        return mps__fail(w->context, MPS_E_STATE,
                         "model '%s' makes the pressure equation nonlinear, and solver '%s' is "
                         "for linear ones: choose 'sundials.kinsol'",
                         mps__runner_writer(&w->runner, MPS__GAS_LAW), w->solvers.use->name);
    return MPS_OK;
}

/* An equation on many ranks needs a solver that supports ranks. */
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
    if (!w->ppe.level_free || q->next.level_told) return;
    q->next.level_told = true;
    mps__log(w->context, MPS_LOG_INFO,
             "t = %.9g s: no surface, fixed pressure or compressible phase gives the pressures a "
             "level; their mean is zero",
             q->view.t);
}

/* Complete the equation of the models. */
static mps_status close_equation(mps_stage *s)
{
    mps__step *q = mps__step_of(s);
    MPS__TRY(check_laws(q, s->data[0]));
    MPS__TRY(check_ranks(q));
    spread_gain(q);
    return MPS_OK;
}

static const mps_use equation_uses[] = {{"gas_law", MPS_USE_READ},
                                        {"equation_gain", MPS_USE_CHANGE}};

const mps__pass mps__pass_equation = {.name = "equation",
                                      .hook = MPS_SOURCE,
                                      .place = MPS__AFTER_MODELS,
                                      .stage = MPS_STAGE_OPERATORS,
                                      .device = true,
                                      .use_count = 2,
                                      .uses = equation_uses,
                                      .run = close_equation};

/* ---- matrix and unknowns ---- */

enum { REGION, CONDITION, VALUE, SOURCE, SHIFT, GAS, LAW, DENSITY, POSITION, RADIUS, WHOLE, GAIN };
static const mps_use matrix_uses[] = {[REGION] = {"region", MPS_USE_NEIGHBOURS},
                                      [CONDITION] = {"pressure_condition", MPS_USE_NEIGHBOURS},
                                      [VALUE] = {"pressure_value", MPS_USE_NEIGHBOURS},
                                      [SOURCE] = {"pressure_source", MPS_USE_READ},
                                      [SHIFT] = {"pressure_shift", MPS_USE_READ},
                                      [GAS] = {"gas_shift", MPS_USE_READ},
                                      [LAW] = {"gas_law", MPS_USE_READ},
                                      [DENSITY] = {"density", MPS_USE_READ},
                                      [POSITION] = {"position", MPS_USE_READ},
                                      [RADIUS] = {"equation_radius", MPS_USE_READ},
                                      [WHOLE] = {"equation_complete", MPS_USE_READ},
                                      [GAIN] = {"equation_gain", MPS_USE_READ}};

static mps_status fill_matrix(mps_stage *s)
{
    mps__step *q = mps__step_of(s);
    mps__ppe_terms terms = q->terms;
    terms.flux = &s->view->flux;
    terms.region = s->data[REGION];
    terms.condition = s->data[CONDITION];
    terms.value = s->data[VALUE];
    terms.source = s->data[SOURCE];
    terms.shift = s->data[SHIFT];
    terms.gas = s->data[GAS];
    terms.law = s->data[LAW];
    terms.density = s->data[DENSITY];
    MPS__TRY(mps__step_mass_begin(q));
    return mps__ppe_fill(&q->w->ppe, s->view, &terms);
}

const mps__pass mps__pass_matrix = {.name = "matrix",
                                    .hook = MPS_SOURCE,
                                    .place = MPS__AFTER_MODELS,
                                    .stage = MPS_STAGE_PPE_SETUP,
                                    .device = true,
                                    .use_count = sizeof matrix_uses / sizeof matrix_uses[0],
                                    .uses = matrix_uses,
                                    .run = fill_matrix};

static mps_status note_unknowns(mps_stage *s)
{
    mps__step *q = mps__step_of(s);
    mps__ppe_terms terms = q->terms;
    terms.pressure = s->data[0];
    return mps__ppe_note(&q->w->ppe, s->view, &terms);
}

static const mps_use unknown_uses[] = {{"pressure", MPS_USE_READ},
                                       {"unknown_numbers", MPS_USE_WRITE | MPS__USE_BEGIN},
                                       {"unknown_places", MPS_USE_WRITE | MPS__USE_BEGIN}};

const mps__pass mps__pass_unknowns = {.name = "unknowns",
                                      .hook = MPS_SOURCE,
                                      .place = MPS__AFTER_MODELS,
                                      .stage = MPS_STAGE_PPE_SETUP,
                                      .device = true,
                                      .use_count = 3,
                                      .uses = unknown_uses,
                                      .run = note_unknowns};

/* ---- solution ---- */

/* Error text of a failed solution. A NaN of the prediction has a particle and a position. */
static mps_status log_failure(mps_stage *s, mps_status status)
{
    mps__step *q = mps__step_of(s);
    mps__world *w = q->w;
    if (status == MPS_E_SOLVER) {
        const mps_view *device_view = w->ppe.device ? mps__runner_begin_serial(s) : NULL;
        mps__memory_sync_fields(&w->runner.memory);
        mps__step_ask_result(q);
        mps__runner_flush(&w->runner);
        mps_status found = mps__runner_check_reactions(&w->runner, q->view.t);
        if (found == MPS_OK) found = mps__step_check_result(q, false);
        if (device_view) mps__runner_end_serial(s, device_view);
        MPS__TRY(found);
    }
    return mps__fail(w->context, status, "t = %.9g s: %.400s", q->view.t, w->context->error);
}

/* Solve the equation w->ppe in its memory space. On a device the solver first tests whether it can
 * be solved: solvers.hint.refused. */
static mps_status solve_equation(mps_stage *s)
{
    mps__step *q = mps__step_of(s);
    mps__world *w = q->w;
    mps__memory *t = &w->runner.memory;
    mps_ppe_result result = {.struct_size = sizeof result};
    mps__ppe_terms terms = q->terms;
    mps_status status = MPS_OK;
    note_level(q);
    terms.flux = &s->view->flux;
    terms.value = mps__memory_array(t, MPS__PRESSURE_VALUE, t->space);
    terms.condition = mps__memory_array(t, MPS__PRESSURE_CONDITION, t->space);
    w->bounds.active = mps__seen(w, MPS__FIELD_HELD);
    w->bounds.solves = 0;
    w->solvers.hint.refused = false;
    if (mps__ppe_rows(&w->ppe) > 0)
        status = mps__bounds_solve(&w->bounds, &w->solvers, &w->ppe, s->view, &terms, &result);
    if (w->solvers.hint.refused) return MPS_OK;
    /* if another rank has failed, report its reason, not the effect of its last values on the
     * solution */
    if (status == MPS_E_SOLVER) MPS__TRY(mps__ranks_status(&w->ranks));
    if (status < 0) return log_failure(s, status);
    q->not_converged = status == MPS_W_NOT_CONVERGED;
    if (q->not_converged)
        mps__log(w->context, MPS_LOG_WARNING, "t = %.9g s: %.400s", q->view.t, w->context->error);
    q->info.ppe_solves = w->bounds.solves;
    q->info.ppe_iterations = result.iterations;
    q->info.ppe_residual = result.residual;
    q->info.ppe_divergence = result.divergence;
    q->info.ppe_unknowns = mps__ppe_rows(&w->ppe);
    q->setup_seconds = result.setup_seconds;
    /* a body needs pressures that it can correct, whether they have converged or not */
    return q->load.what == MPS_LOAD_MASS && (status == MPS_OK || mps__body_carries(w))
               ? mps__step_mass(q)
               : MPS_OK;
}

/* Bring the equation of a device to the host, make it solvable if a component lacks a pressure
 * datum, solve it, and bring pressures and conditions back. */
static mps_status solve_on_host(mps_stage *s)
{
    static const int32_t read[] = {MPS__PRESSURE_VALUE, MPS__PRESSURE_CONDITION,
                                   MPS__PRESSURE_DENSITY};
    mps__world *w = mps__step_of(s)->w;
    mps__memory *t = &w->runner.memory;
    const mps_view *device_view = mps__runner_begin_serial(s);
    mps_status status = mps__ppe_to_host(&w->ppe);
    if (status == MPS_OK && w->ppe.lacking) status = mps__ppe_close(&w->ppe, s->view);
    for (int k = 0; k < 3; k++) mps__memory_sync(t, read[k], MPS__ON_HOST);
    if (status == MPS_OK) status = mps__device_status(&t->device);
    if (status == MPS_OK) status = solve_equation(s);
    mps__memory_written(t, MPS__PRESSURE_CONDITION, MPS__ON_HOST);
    mps__memory_sync(t, MPS__PRESSURE_CONDITION, MPS__ON_DEVICE);
    mps__runner_end_serial(s, device_view);
    return status == MPS_OK ? mps__ppe_to_device(&w->ppe) : status;
}

/* Log this once, as it is so in each step. */
static void log_host(const mps__step *q)
{
    mps__world *w = q->w;
    mps__memory *t = &w->runner.memory;
    const mps__solvers *s = &w->solvers;
    char why[2 * MPS__NAME_SIZE + 40] = "";
    if (t->logged_solution == w->runner.plan.changes) return;
    if (q->load.what == MPS_LOAD_MASS)
        snprintf(why, sizeof why, "the added mass is requested");
    else if (!mps__solvers_support_device(s))
        snprintf(why, sizeof why, "solver '%s' with preconditioner '%s'", s->use->name,
                 s->pc ? s->pc->name : "none");
    if (!why[0]) return;
    t->logged_solution = w->runner.plan.changes;
    mps__log(w->context, MPS_LOG_INFO,
             "device '%s': the pressure equation is solved on the host, with copies of its matrix: "
             "%s",
             t->device.ops.name, why);
}

/* Choose the memory space of the solution. On the host: for a solver without device loops, for the
 * added mass, and if a component lacks a pressure datum. On one rank a solver with hints tests
 * the latter itself; on many it waits for each reduction anyway, so the test is a separate one. */
static mps_status choose_space(const mps__step *q, bool *on_host)
{
    mps__world *w = q->w;
    *on_host = false;
    if (!w->ppe.device) return MPS_OK;
    if (q->load.what == MPS_LOAD_MASS || !mps__solvers_on_device(&w->solvers, &w->ppe.problem)) {
        log_host(q);
        *on_host = true;
    } else if (!mps__ranks_many(&w->ranks) && w->solvers.use->hint) {
        return MPS_OK;
    }
    MPS__TRY(mps__levels_wait(&w->ppe));
    *on_host = *on_host || w->ppe.lacking;
    return MPS_OK;
}

static mps_status solve(mps_stage *s)
{
    mps__step *q = mps__step_of(s);
    mps__world *w = q->w;
    bool on_host;
    w->solvers.device = mps__memory_device(&w->runner.memory);
    mps_status status = choose_space(q, &on_host);
    if (status == MPS_OK && !on_host) {
        status = solve_equation(s);
        on_host = w->ppe.lacking = w->solvers.hint.refused;
    }
    if (status == MPS_OK && on_host) status = solve_on_host(s);
    w->solvers.device = NULL;
    return status;
}

static const mps_use solve_uses[] = {{"pressure_value", MPS_USE_READ},
                                     {"pressure_condition", MPS_USE_CHANGE},
                                     {"unknown_numbers", MPS_USE_CHANGE},
                                     {"unknown_places", MPS_USE_READ}};

const mps__pass mps__pass_solve = {.name = "solve",
                                   .hook = MPS_SOURCE,
                                   .place = MPS__AFTER_MODELS,
                                   .stage = MPS_STAGE_PPE_SOLVE,
                                   .device = true,
                                   .use_count = 4,
                                   .uses = solve_uses,
                                   .run = solve};

static mps_status scatter_pressures(mps_stage *s)
{
    const mps__ppe_terms terms = {.condition = s->data[1], .value = s->data[2]};
    mps__ppe_scatter(&mps__step_of(s)->w->ppe, s->view, &terms, s->data[0]);
    return MPS_OK;
}

static const mps_use pressure_uses[] = {{"pressure", MPS_USE_WRITE},
                                        {"pressure_condition", MPS_USE_READ},
                                        {"pressure_value", MPS_USE_READ},
                                        {"unknown_numbers", MPS_USE_READ}};

const mps__pass mps__pass_pressures = {.name = "pressures",
                                       .hook = MPS_SOURCE,
                                       .place = MPS__AFTER_MODELS,
                                       .stage = MPS_STAGE_PPE_SOLVE,
                                       .device = true,
                                       .use_count = 4,
                                       .uses = pressure_uses,
                                       .run = scatter_pressures};

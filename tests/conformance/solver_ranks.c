/* SPDX-License-Identifier: BSD-3-Clause */
/* A dam break of a few steps with the solver under test: on one rank, and on two, which are
 * threads. */
#include "solver_ranks.h"
#include "kit_engine.h"
#include <math.h>
#include <mps/mps.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RANKS = 2, STEPS = 2, TEXT = 512, NAME = 80 };

/* Relative tolerance of solutions, to the largest norm. */
static const double AGREE = 1e-9;

/* A run: the pressures after the last step, by id, and how it ended on each rank. */
typedef struct run {
    const mps_solver_ops *solver;
    const mps_preconditioner_ops *pc;
    kit_engine_team *team; /* NULL: one rank */
    char solver_name[NAME], pc_name[NAME];
    int64_t n;
    double *p;
    mps_status status[RANKS];
    char text[RANKS][TEXT];
} run;

bool kit_ranks_allowed(const mps_solver_ops *solver, const mps_preconditioner_ops *pc)
{
    return (solver ? solver->ranks : pc && pc->symmetric) && (!pc || pc->ranks);
}

/* Under names of their own: the library may have the tables already. */
static mps_status choose(const run *r, mps_sim *sim)
{
    mps_status status = MPS_OK;
    if (r->solver) {
        mps_solver_ops solver = *r->solver;
        solver.name = r->solver_name;
        status = mps_solver_register(sim, &solver);
    }
    if (r->pc) {
        mps_preconditioner_ops pc = *r->pc;
        pc.name = r->pc_name;
        if (status >= 0) status = mps_preconditioner_register(sim, &pc);
    }
    if (status < 0) return status;
    const bool none = r->solver && r->solver->preconditioner;
    return mps_solver_use(sim, r->solver_name, r->pc ? r->pc_name : none ? "none" : NULL);
}

static mps_status build(const run *r, int32_t rank, mps_sim *sim)
{
    const double lo[3] = {0}, hi[3] = {0.44, 0.3, 0};
    mps_solver_limits limits;
    mps_tank tank;
    mps_status status = MPS_OK;
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = 0.8;
    tank.size[1] = 0.4;
    mps_solver_limits_init(&limits, sizeof limits);
    limits.tolerance = 1e-13; /* results differ by rounding only */
    if (r->team) {
        const mps_ranks_ops ops = kit_engine_ops(r->team, rank);
        status = mps_sim_ranks_set(sim, &ops);
    }
    if (status >= 0) status = choose(r, sim);
    if (status >= 0) status = mps_solver_limits_set(sim, &limits);
    if (status >= 0) status = mps_tank_add(sim, &tank, NULL);
    if (status >= 0) status = mps_fill_box_add(sim, 0, lo, hi, NULL, NULL);
    return status;
}

/* Pressures by id; ids of a scene without removals are 0..n-1. */
static mps_status take_pressures(run *r, mps_sim *sim)
{
    mps_lease id = {.struct_size = sizeof id}, p = {.struct_size = sizeof p};
    mps_status status = mps_lease_begin(sim, "id", MPS_READ, &id);
    if (status >= 0) status = mps_lease_begin(sim, "pressure", MPS_READ, &p);
    if (status < 0) return status;
    r->n = id.count;
    r->p = calloc((size_t)id.count + 1, sizeof *r->p);
    for (int64_t i = 0; r->p && i < id.count; i++)
        if (id.ids[i] >= 0 && id.ids[i] < id.count) r->p[id.ids[i]] = p.data[i];
    mps_lease_end(sim, &id);
    mps_lease_end(sim, &p);
    return r->p ? MPS_OK : MPS_E_NOMEM;
}

static void run_rank(void *argument, int32_t rank)
{
    run *r = argument;
    mps_config config;
    mps_sim *sim = NULL;
    mps_config_init(&config, sizeof config);
    config.dp = 0.02;
    mps_status status = mps_sim_create(&config, &sim);
    if (status >= 0) status = build(r, rank, sim);
    for (int k = 0; k < STEPS && status >= 0; k++) status = mps_step(sim, 1e-3, NULL);
    if (status >= 0) status = mps_particles_collect(sim);
    if (status >= 0 && rank == 0) status = take_pressures(r, sim);
    if (status >= 0) status = mps_particles_collect_end(sim);
    r->status[rank] = status;
    if (status < 0) snprintf(r->text[rank], TEXT, "%s", sim ? mps_sim_error(sim) : "no handle");
    mps_sim_destroy(sim);
}

/* @return NULL, or the text of the rank that failed first */
static const char *execute(run *r, int32_t ranks)
{
    const char *text = NULL;
    if (ranks > 1) r->team = kit_engine_create(ranks, 0);
    if (r->team)
        kit_engine_run(r->team, run_rank, r);
    else
        run_rank(r, 0);
    if (r->team) kit_engine_destroy(r->team);
    for (int32_t k = 0; k < ranks; k++)
        if (r->status[k] < 0 && (!text || r->status[k] != MPS_E_RANKS)) text = r->text[k];
    return text;
}

static bool compare(run *one, run *two, char text[KIT_RANKS_TEXT])
{
    const char *error = execute(one, 1);
    if (!error) error = execute(two, RANKS);
    if (error) {
        snprintf(text, KIT_RANKS_TEXT, "on %d rank(s): %s", two->team ? RANKS : 1, error);
        return true;
    }
    const double off = one->n == two->n ? kit_difference(two->p, one->p, one->n) : INFINITY;
    snprintf(text, KIT_RANKS_TEXT,
             "solutions on two ranks and on one differ by %g: must be <= %g. Usual reasons: a sum "
             "or maximum without mps_ppe_total(); a vector multiplied by the matrix without "
             "mps_ppe_halo()",
             off, AGREE);
    return !(off <= AGREE);
}

/* The library must refuse the pair, by name. */
static bool admitted(run *two, char text[KIT_RANKS_TEXT])
{
    const char *error = execute(two, RANKS);
    snprintf(text, KIT_RANKS_TEXT,
             "'ranks' of a table is 0, but on two ranks the library does not refuse '%s' with "
             "'%s': %s",
             two->solver_name, two->pc_name, error ? error : "no error");
    return !error || !strstr(error, two->solver_name) || !strstr(error, two->pc_name);
}

bool kit_ranks_failed(const mps_solver_ops *solver, const mps_preconditioner_ops *pc,
                      char text[KIT_RANKS_TEXT])
{
    run one = {.solver = solver, .pc = pc};
    if (solver && solver->symmetric && pc && !pc->symmetric) return false; /* refused on one too */
    if (solver)
        snprintf(one.solver_name, NAME, "kit.%s", solver->name);
    else
        snprintf(one.solver_name, NAME, "sundials.%s", pc->symmetric ? "pcg" : "gmres");
    if (pc) snprintf(one.pc_name, NAME, "kit.%s", pc->name);
    run two = one;
    const bool failed = kit_ranks_allowed(solver, pc) ? compare(&one, &two, text)
                                                      : admitted(&two, text);
    free(one.p);
    free(two.p);
    return failed;
}

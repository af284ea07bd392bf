/* SPDX-License-Identifier: BSD-3-Clause */
/* Test the jet with the kit of models. Then compare bytes on one to three ranks, over a checkpoint
 * and, on one rank, after failed steps: on many ranks the first failed step ends the run. */
#include "inflow.h"
#include <kit_engine.h>
#include <model_kit.h>
#include <mps/mps.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char FILE_NAME[] = "check_inflow.checkpoint";
enum { STEPS = 120, MIDDLE = 57, MOST = 4000, NUMBERS = 8, RANKS = 3, EVERY = 20 };

/* ---- a model that fails on demand ------------------------------------------------------------ */

static int fail_on_demand(mps_stage *s)
{
    const int32_t *wanted = s->self;
    return *wanted ? mps_stage_fail(s, "as wanted") : 0;
}

static const mps_verb fail_verbs[] = {{.hook = MPS_SHIFT, .run = fail_on_demand}};

/* ---- one run --------------------------------------------------------------------------------- */

typedef struct state {
    int64_t n;
    double value[MOST][NUMBERS]; /* by rows of all ranks, in the order of one rank */
    mps_energy energy;
} state;

typedef struct run {
    kit_engine_team *team; /* NULL: one rank */
    int checkpoint, failing;
    int bad[RANKS];
    state *end; /* on rank 0 */
} run;

static int report(mps_sim *sim, const char *what)
{
    fprintf(stderr, "%s: %s\n", what, sim ? mps_sim_error(sim) : "no handle");
    return 1;
}

/* A tank with some water, a jet, and an outlet in a lower corner. */
static int build(const run *r, int32_t rank, int32_t *wanted, mps_sim **sim)
{
    static const struct {
        const char *key;
        double value;
    } set[] = {{"x", 0.11},      {"y", 0.45},  {"u", 0.1},   {"v", -0.4}, {"width", 0.06},
               {"start", 0.013}, {"x0", 0.25}, {"x1", 0.31}, {"y0", 0},   {"y1", 0.05}};
    const mps_model_ops fails = {.struct_size = sizeof fails,
                                 .api = MPS_MODEL_API,
                                 .name = "fail.on_demand",
                                 .help = "Fails on demand",
                                 .verb_count = 1,
                                 .verbs = fail_verbs,
                                 .user = wanted};
    const double lo[2] = {0, 0}, hi[2] = {0.3, 0.1};
    mps_config config;
    mps_tank tank;
    mps_config_init(&config, sizeof config);
    mps_tank_init(&tank, sizeof tank);
    config.dp = 0.02;
    tank.size[0] = tank.size[1] = 0.3;
    tank.open_top = 1;
    *sim = NULL;
    if (mps_sim_create(&config, sim) < 0) return report(*sim, "create");
    if (r->team) {
        const mps_ranks_ops ops = kit_engine_ops(r->team, rank);
        if (mps_sim_ranks_set(*sim, &ops) < 0) return report(*sim, "ranks");
    }
    if (mps_tank_add(*sim, &tank, NULL) < 0 || mps_fill_box_add(*sim, 0, lo, hi, NULL, NULL) < 0 ||
        mps_model_register(*sim, &inflow_jet) < 0 || mps_model_use(*sim, "inflow.jet") < 0 ||
        mps_model_register(*sim, &fails) < 0 || mps_model_use(*sim, "fail.on_demand") < 0)
        return report(*sim, "set-up");
    for (size_t k = 0; k < sizeof set / sizeof *set; k++)
        if (mps_model_set(*sim, "inflow", set[k].key, set[k].value) < 0) return report(*sim, "set");
    return 0;
}

static int steps(mps_sim *sim, const run *r, int32_t *wanted, int from, int to)
{
    for (int k = from; k < to; k++) {
        for (*wanted = r->failing && k % EVERY == 0; *wanted; *wanted = 0)
            if (mps_step(sim, 1, NULL) != MPS_E_PLUGIN) return report(sim, "a step should fail");
        if (mps_step(sim, 1, NULL) < 0) return report(sim, "step");
    }
    return 0;
}

static int note(mps_sim *sim, state *end)
{
    static const char *const names[] = {"position", "velocity", "pressure", "inflow_rows"};
    mps_lease id = {.struct_size = sizeof id}, f = {.struct_size = sizeof f};
    if (mps_lease_begin(sim, "id", MPS_READ, &id) < 0 || id.count > MOST) return report(sim, "id");
    end->n = id.count;
    for (int64_t i = 0; i < id.count; i++) end->value[i][0] = (double)id.ids[i];
    for (int k = 0, column = 1; k < 4; column += f.stride, k++) {
        if (mps_lease_begin(sim, names[k], MPS_READ, &f) < 0) return report(sim, names[k]);
        for (int64_t i = 0; i < f.count; i++)
            for (int c = 0; c < f.stride; c++) end->value[i][column + c] = f.data[i * f.stride + c];
        mps_lease_end(sim, &f);
    }
    return mps_lease_end(sim, &id) < 0;
}

static void run_rank(void *argument, int32_t rank)
{
    run *r = argument;
    int32_t wanted = 0;
    mps_sim *sim;
    mps_energy e;
    mps_energy_init(&e, sizeof e);
    int bad = build(r, rank, &wanted, &sim) ||
              steps(sim, r, &wanted, 0, r->checkpoint ? MIDDLE : STEPS);
    if (!bad && r->checkpoint) {
        bad = mps_checkpoint_write(sim, FILE_NAME) < 0 && report(sim, "write");
        mps_sim_destroy(sim);
        bad = bad || build(r, rank, &wanted, &sim) ||
              (mps_checkpoint_read(sim, FILE_NAME) < 0 && report(sim, "read")) ||
              steps(sim, r, &wanted, MIDDLE, STEPS);
    }
    if (!bad && mps_energy_get(sim, &e) < 0) bad = report(sim, "energy");
    if (!bad && mps_particles_collect(sim) < 0) bad = report(sim, "collect");
    if (!bad && rank == 0) {
        r->end->energy = e;
        bad = note(sim, r->end);
    }
    mps_particles_collect_end(sim);
    mps_sim_destroy(sim);
    r->bad[rank] = bad;
}

/* Run on several ranks and compare. @return 0: the bytes are those of `alone` */
static int compare(const state *alone, int32_t ranks, int checkpoint, int failing, state *end)
{
    run r = {.checkpoint = checkpoint, .failing = failing, .end = end};
    memset(end, 0, sizeof *end);
    if (ranks > 1) r.team = kit_engine_create(ranks, 0);
    if (r.team)
        kit_engine_run(r.team, run_rank, &r);
    else
        run_rank(&r, 0);
    if (r.team) kit_engine_destroy(r.team);
    remove(FILE_NAME);
    const int bad = r.bad[0] || r.bad[1] || r.bad[2] || memcmp(alone, end, sizeof *end) != 0;
    printf("%d ranks%s%s: %s, %lld particles, added %.17g J\n", (int)ranks,
           checkpoint ? ", checkpoint" : "", failing ? ", failing steps" : "",
           bad ? "OTHER BYTES" : "same bytes", (long long)end->n, end->energy.added);
    return bad;
}

static int same_bytes(void)
{
    state *alone = calloc(1, sizeof *alone), *end = calloc(1, sizeof *end);
    run r = {.end = alone};
    int bad = !alone || !end;
    if (!bad) run_rank(&r, 0);
    bad = bad || r.bad[0];
    for (int32_t ranks = 1; ranks <= RANKS; ranks++)
        for (int how = 0; how < (ranks > 1 ? 2 : 3) && alone && end; how++)
            bad |= compare(alone, ranks, how == 1, how == 2, end);
    free(alone);
    free(end);
    return bad;
}

/* ---- the kit --------------------------------------------------------------------------------- */

static mps_status prepare(void *user, mps_sim *sim)
{
    (void)user;
    if (mps_model_set(sim, "inflow", "x", 0.15) < 0 || mps_model_set(sim, "inflow", "y", 0.5) < 0 ||
        mps_model_set(sim, "inflow", "v", -0.5) < 0)
        return MPS_E_ARG;
    if (mps_model_set(sim, "inflow", "x1", 0.1) < 0 || mps_model_set(sim, "inflow", "y1", 0.05) < 0)
        return MPS_E_ARG;
    return mps_model_set(sim, "inflow", "width", 0.06);
}

int main(void)
{
    return same_bytes() | (kit_check_model(&inflow_jet, prepare, NULL) != 0);
}

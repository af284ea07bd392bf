/* SPDX-License-Identifier: BSD-3-Clause */
/* Runs on 2, 3, 4 and 7 ranks have the bytes of a run on one, after every step. */
#include "../../src/ppe/builtin.h"
#include "engine.h"
#include "sim.h"
#include <mps/mps.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { MOST = 20000, STEPS = 60, TEXT = 300, NUMBERS = 9 };

typedef struct scene {
    const char *preset, *preconditioner;
    int32_t dim, steps;
    double dp;
    mps_motion_fn motion;
} scene;

/* What is compared: numbers of each particle by its id, and those of the step. */
typedef struct record {
    double value[MOST][NUMBERS];
    double info[8];
    int64_t count;
} record;

typedef struct run {
    const scene *scene;
    engine_team *team;
    record *records; /* [steps] */
    char error[64][TEXT];
} run;

/* Polynomials alone: sines of C libraries differ in the last digit. */
static int sway(void *user, double t, mps_motion_state *state)
{
    (void)user;
    state->value[MPS_SURGE] = 1.5 * t * t;
    state->rate[MPS_SURGE] = 3 * t;
    state->accel[MPS_SURGE] = 3;
    return 0;
}

static int roll(void *user, double t, mps_motion_state *state)
{
    (void)user;
    state->value[MPS_ROLL] = 2 * t * t;
    state->rate[MPS_ROLL] = 4 * t;
    state->accel[MPS_ROLL] = 4;
    return 0;
}

/* Under the name "divided": auxgrid that divides all grids but the last, as it does with large ones. */
static mps_status register_divided(mps_sim *sim)
{
    static int64_t whole = 1;
    mps_preconditioner_ops ops = mps__preconditioner_auxgrid;
    ops.name = "divided";
    ops.user = &whole;
    return mps_preconditioner_register(sim, &ops);
}

static mps_status build(mps_sim *sim, const scene *s)
{
    const double lo[3] = {0, 0, 0}, depth[3] = {0.3, 0.26, 0.4}, all[3] = {0.6, 0.45, 0.4};
    mps_tank tank;
    mps_status status = mps_preset_use(sim, s->preset);
    if (status == MPS_OK) status = register_divided(sim);
    if (status == MPS_OK) status = mps_solver_use(sim, "sundials.pcg", s->preconditioner);
    mps_tank_init(&tank, sizeof tank);
    for (int d = 0; d < 3; d++) tank.size[d] = all[d];
    if (status == MPS_OK) status = mps_tank_add(sim, &tank, NULL);
    if (status == MPS_OK) status = mps_fill_box_add(sim, 0, lo, depth, NULL, NULL);
    if (status == MPS_OK && s->motion) status = mps_motion_callback_set(sim, s->motion, NULL);
    return status;
}

/* Owned particles only; each rank fills its own. */
static void note(mps_sim *sim, const mps_step_info *info, int32_t rank, record *r)
{
    const mps__particles *s = &sim->world.particles;
    const int dim = s->dim;
    for (int64_t i = 0; i < s->n; i++) {
        if (mps__is_ghost(&sim->world.ghosts, i)) continue;
        double *v = r->value[s->id[i]];
        for (int d = 0; d < dim; d++) {
            v[d] = s->x[i * dim + d];
            v[3 + d] = s->u[i * dim + d];
        }
        v[6] = s->p[i];
        v[7] = s->nd[i];
        v[8] = s->load[i];
        __atomic_fetch_add(&r->count, 1, __ATOMIC_RELAXED);
    }
    mps_energy e = {.struct_size = sizeof e};
    mps_energy_get(sim, &e);
    const double numbers[] = {info->t,
                              info->dt,
                              info->ppe_iterations,
                              (double)info->ppe_unknowns,
                              (double)info->surface,
                              info->max_speed,
                              e.kinetic,
                              e.wall_work};
    if (rank == 0) memcpy(r->info, numbers, sizeof numbers);
}

static void run_rank(void *argument, int32_t rank)
{
    run *k = argument;
    mps_config config;
    mps_sim *sim = NULL;
    mps_step_info info;
    mps_config_init(&config, sizeof config);
    config.dim = k->scene->dim;
    config.dp = k->scene->dp;
    mps_step_info_init(&info, sizeof info);
    mps_status status = mps_sim_create(&config, &sim);
    if (status == MPS_OK && k->team) {
        const mps_ranks_ops ops = engine_ops(k->team, rank);
        status = mps_sim_ranks_set(sim, &ops);
    }
    if (status == MPS_OK) status = build(sim, k->scene);
    for (int s = 0; s < k->scene->steps && status >= 0; s++) {
        sim->world.ghosts.recut = s % 7 == 3; /* new cuts whenever a search comes */
        status = mps_step(sim, 1, &info);
        if (status >= 0) note(sim, &info, rank, &k->records[s]);
    }
    if (status < 0) snprintf(k->error[rank], TEXT, "%s", mps_sim_error(sim));
    mps_sim_destroy(sim);
}

static record *run_scene(const scene *s, int32_t ranks, uint32_t skew)
{
    run k = {.scene = s, .records = calloc((size_t)s->steps, sizeof(record))};
    assert_non_null(k.records);
    if (ranks > 1) k.team = engine_create(ranks, skew);
    if (k.team)
        engine_run(k.team, run_rank, &k);
    else
        run_rank(&k, 0);
    for (int32_t r = 0; r < ranks; r++)
        if (k.error[r][0]) fail_msg("rank %d of %d: %s", (int)r, (int)ranks, k.error[r]);
    if (k.team) engine_destroy(k.team);
    return k.records;
}

static void compare(const scene *s, const record *a, const record *b, int32_t ranks)
{
    static const char *const names[] = {"x", "y", "z", "u", "v", "w", "p", "n", "load"},
                             *const infos[] = {"t",       "dt",        "iterations", "unknowns",
                                               "surface", "max_speed", "kinetic",    "wall_work"};
    for (int k = 0; k < s->steps; k++) {
        if (a[k].count != b[k].count)
            fail_msg("%d ranks, step %d: %lld particles, not %lld", (int)ranks, k + 1,
                     (long long)b[k].count, (long long)a[k].count);
        for (int v = 0; v < 8; v++)
            if (memcmp(&a[k].info[v], &b[k].info[v], sizeof(double)) != 0)
                fail_msg("%d ranks, step %d: %s is %.17g, not %.17g", (int)ranks, k + 1, infos[v],
                         b[k].info[v], a[k].info[v]);
        for (int64_t id = 0; id < MOST; id++)
            for (int v = 0; v < NUMBERS; v++)
                if (memcmp(&a[k].value[id][v], &b[k].value[id][v], sizeof(double)) != 0)
                    fail_msg("%d ranks, step %d: %s of particle %lld is %.17g, not %.17g",
                             (int)ranks, k + 1, names[v], (long long)id, b[k].value[id][v],
                             a[k].value[id][v]);
    }
}

static void check(scene s)
{
    static const int32_t ranks[] = {2, 3, 4, 7};
    static const char *const preconditioners[] = {"jacobi", "auxgrid", "divided"};
    for (int p = 0; p < 3; p++) {
        s.preconditioner = preconditioners[p];
        record *alone = run_scene(&s, 1, 0);
        for (int k = 0; k < 4; k++) {
            record *many = run_scene(&s, ranks[k], (uint32_t)k);
            compare(&s, alone, many, ranks[k]);
            free(many);
        }
        free(alone);
    }
}

static void dam_2d(void **state)
{
    (void)state;
    check((scene){.preset = "imps", .dim = 2, .steps = 60, .dp = 0.02});
}

static void dam_3d(void **state)
{
    (void)state;
    check((scene){.preset = "imps", .dim = 3, .steps = 20, .dp = 0.05});
}

static void surge_2d(void **state)
{
    (void)state;
    check((scene){.preset = "imps", .dim = 2, .steps = 60, .dp = 0.02, .motion = sway});
}

static void roll_2d(void **state)
{
    (void)state;
    check((scene){.preset = "imps", .dim = 2, .steps = 60, .dp = 0.02, .motion = roll});
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(dam_2d), cmocka_unit_test(dam_3d),
                                       cmocka_unit_test(surge_2d), cmocka_unit_test(roll_2d)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

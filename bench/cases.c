/* SPDX-License-Identifier: BSD-3-Clause */
/* The cases, as in the drivers: the dam break of Lobovsky et al. 2014, the breaking wave of Wen, Zhao & Wan 2022, both also in a tank full
 * of air, and two liquids at rest of the latter. */
#include "bench.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct bench_kind {
    const char *name;
    int32_t dim;
    double tank[3], fill[3], density, viscosity;
    mps_harmonic motion;
    enum { EMPTY, AIR, LIGHT_LIQUID } rest; /* what fills the rest of the tank */
};

static const struct bench_kind kinds[] = {
    {"dam2d", 2, {1.61, 0.6, 0}, {0.6, 0.3, 0}, 997, 997 * 8.9e-7, {0}, EMPTY},
    {"dam3d", 3, {1.61, 0.6, 0.15}, {0.6, 0.3, 0.15}, 997, 997 * 8.9e-7, {0}, EMPTY},
    {"air2d", 2, {1.61, 0.6, 0}, {0.6, 0.3, 0}, 997, 997 * 8.9e-7, {0}, AIR},
    {"air3d", 3, {1.61, 0.6, 0.15}, {0.6, 0.3, 0.15}, 997, 997 * 8.9e-7, {0}, AIR},
    {"static2d", 2, {1, 1.5, 0}, {1, 0.75, 0}, 1000, 1e-3, {0}, LIGHT_LIQUID},
    {"breaking",
     2,
     {1.3, 0.9, 0},
     {1.3, 0.18, 0},
     1000,
     1e-3,
     {.dof = MPS_MOVE_X, .amplitude = 0.1, .omega = 3.1164599471},
     EMPTY},
    {"breaking_air",
     2,
     {1.3, 0.9, 0},
     {1.3, 0.18, 0},
     1000,
     1e-3,
     {.dof = MPS_MOVE_X, .amplitude = 0.1, .omega = 3.1164599471},
     AIR},
};

const char *bench_case_find(const char *name, bench_case *c)
{
    const char *slash = strchr(name, '/');
    char *end;
    *c = (bench_case){0};
    if (!slash || strlen(name) >= sizeof c->name)
        return "must be kind/dp, as in dam2d/2.5, dp in mm";
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++)
        if (strlen(kinds[k].name) == (size_t)(slash - name) &&
            strncmp(name, kinds[k].name, (size_t)(slash - name)) == 0)
            c->kind = &kinds[k];
    if (!c->kind) return "kinds are dam2d, dam3d, air2d, air3d, static2d, breaking, breaking_air";
    c->dp = 1e-3 * strtod(slash + 1, &end);
    if (*end || !(c->dp >= 1e-4 && c->dp <= 0.05)) return "dp must be 0.1 to 50 mm";
    memcpy(c->name, name, strlen(name) + 1);
    return NULL;
}

static void check(mps_sim *sim, mps_status status, const char *what)
{
    if (status < 0) bench_fail(what, mps_sim_error(sim));
}

static void fill_rest(mps_sim *sim, const struct bench_kind *k)
{
    const double lo[3] = {0};
    mps_phase light;
    mps_phase_init(&light, sizeof light);
    light.density = k->rest == AIR ? 1.29 : 1;
    light.viscosity = k->rest == AIR ? 1.8e-5 : 1e-3;
    check(sim, mps_phase_set(sim, 1, &light), "light fluid");
    check(sim, mps_fill_box_add(sim, 1, lo, k->tank, NULL, NULL), "light fluid");
    if (k->rest == LIGHT_LIQUID) check(sim, mps_model_remove(sim, "gas"), "gas");
}

mps_sim *bench_case_make(const bench_case *c, int32_t threads, double re_far, bench_memory *memory)
{
    const struct bench_kind *k = c->kind;
    const double lo[3] = {0};
    char error[256] = "";
    mps_sim *sim;
    mps_config config;
    mps_phase liquid;
    mps_tank tank;
    mps_config_init(&config, sizeof config);
    config.dim = k->dim;
    config.dp = c->dp;
    config.threads = threads;
    if (re_far > 0) config.re_far = re_far;
    config.allocator = bench_allocator(memory);
    config.error = error;
    config.error_size = sizeof error;
    if (mps_sim_create(&config, &sim) != MPS_OK) bench_fail("simulation", error);
    if (k->rest != EMPTY) check(sim, mps_preset_use(sim, "mmps"), "preset");
    mps_phase_init(&liquid, sizeof liquid);
    liquid.density = k->density;
    liquid.viscosity = k->viscosity;
    check(sim, mps_phase_set(sim, 0, &liquid), "liquid");
    mps_tank_init(&tank, sizeof tank);
    memcpy(tank.size, k->tank, sizeof tank.size);
    check(sim, mps_tank_add(sim, &tank, NULL), "tank");
    check(sim, mps_fill_box_add(sim, 0, lo, k->fill, NULL, NULL), "fill");
    if (k->rest != EMPTY) fill_rest(sim, k);
    if (k->motion.amplitude > 0) check(sim, mps_motion_harmonics_set(sim, 1, &k->motion), "motion");
    return sim;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* The set-ups of extreme values, and their actions between steps. */
#ifndef SETUPS_H
#define SETUPS_H

#include "../tags.h"
#include <math.h>
#include <mps/mps.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

/* Lengths in spacings. What is 0 takes the default. */
typedef struct setup {
    const char *name;
    int32_t dim;
    double dp, g[3];
    const char *preset;
    double density, viscosity, gas; /* gas: density of phase 1 above the liquid; 0: none */
    double size[3], depth;
    double re_near, re_far;
    int32_t open_top, threads;
    double velocity; /* of the fluid along x [m/s] */
    double dt;       /* fixed step [s] */
    int steps;
    void (*before)(mps_sim *sim);       /* after the set-up */
    void (*between)(mps_sim *sim, int); /* after step number k */
    /* expected result */
    mps_status status; /* MPS_OK: no failure */
    const char *text;  /* part of the error text */
    double speed;      /* largest speed over that of the set-up; 0: 3 */
} setup;

/* ---- actions between steps --------------------------------------------------------------- */

static inline void one_particle(mps_sim *sim)
{
    const double x[3] = {0.2, 0.3, 0.2};
    mps_particle_block block;
    assert_int_equal(mps_particle_block_init(&block, sizeof block), MPS_OK);
    block.count = 1;
    block.position = x;
    assert_int_equal(mps_particles_add(sim, &block, NULL), MPS_OK);
}

static inline void add_or_remove(mps_sim *sim, int k)
{
    const double x[3] = {0.2, 0.36, 0.2};
    mps_particle_block block;
    static int64_t id;
    assert_int_equal(mps_particle_block_init(&block, sizeof block), MPS_OK);
    block.count = 1;
    block.position = x;
    if (k % 4 == 1) assert_int_equal(mps_particles_add(sim, &block, &id), MPS_OK);
    if (k % 4 == 3) assert_int_equal(mps_particles_remove(sim, 1, &id), MPS_OK);
}

static inline void remove_all(mps_sim *sim, int k)
{
    const int64_t *ids, n = mps_particles_count(sim, -1);
    const int32_t *kinds;
    int64_t fluid[64], count = 0;
    if (k != 9) return;
    assert_int_equal(tags_peek(sim, &ids, &kinds, NULL, NULL), MPS_OK);
    for (int64_t i = 0; i < n; i++)
        if (kinds[i] == MPS_FLUID && count < 64) fluid[count++] = ids[i];
    assert_int_equal(mps_particles_remove(sim, count, fluid), MPS_OK);
}

static inline void build_more(mps_sim *sim, int k)
{
    const double lo[3] = {0.2, 0, 0}, hi[3] = {0.2, 0.1, 0.3};
    mps_tank tank;
    if (k != 5) return;
    assert_int_equal(mps_tank_init(&tank, sizeof tank), MPS_OK);
    tank.size[0] = tank.size[1] = 1;
    assert_int_equal(mps_tank_add(sim, &tank, NULL), MPS_E_STATE);
    assert_int_equal(mps_baffle_add(sim, "late", lo, hi, NULL), MPS_E_STATE);
    assert_int_equal(mps_plate_add(sim, "late", lo, hi, NULL), MPS_E_STATE);
    assert_non_null(strstr(mps_sim_error(sim), "step"));
}

static inline void use_late_models(mps_sim *sim, int k)
{
    static const char *const presets[] = {"imps", "imps.paper"};
    if (k % 5 == 4) assert_int_equal(mps_preset_use(sim, presets[k % 2]), MPS_OK);
}

static inline void shake(mps_sim *sim, double metres, double radians, double omega)
{
    mps_harmonic h[6];
    int32_t dim, count = 0;
    assert_int_equal(mps_sim_shape(sim, &dim, NULL), MPS_OK);
    for (int32_t dof = 0; dof < MPS_DOF_COUNT; dof++)
        if (dim == 3 || dof == MPS_MOVE_X || dof == MPS_MOVE_Y || dof == MPS_ROTATE_Z)
            h[count++] = (mps_harmonic){
                dof, 0, dof < MPS_ROTATE_X ? metres : radians, omega * (1 + 0.1 * dof), dof, 0};
    assert_int_equal(mps_motion_harmonics_set(sim, count, h), MPS_OK);
}

static inline void violent(mps_sim *sim)
{
    shake(sim, 0.1, 0.5, 12);
}

static inline void absurd(mps_sim *sim)
{
    shake(sim, 1e6, 3, 1e4);
}

static inline void jump(mps_sim *sim)
{
    const double t[4] = {0, 0.01, 0.011, 10}, x[4] = {0, 0, 5, 5};
    const int32_t dof = MPS_MOVE_X;
    assert_int_equal(mps_motion_table_set(sim, 4, t, 1, &dof, x), MPS_OK);
}

static inline void strong_tension(mps_sim *sim)
{
    assert_int_equal(mps_tension_set(sim, 0, 1, 1e3), MPS_OK);
}

static inline mps_status drop_at(mps_sim *sim, double far)
{
    const double x[3] = {far, far, 0.2};
    mps_particle_block block;
    assert_int_equal(mps_particle_block_init(&block, sizeof block), MPS_OK);
    block.count = 1;
    block.position = x;
    return mps_particles_add(sim, &block, NULL);
}

static inline void lost_drop(mps_sim *sim)
{
    assert_int_equal(drop_at(sim, 1e5), MPS_OK);
}

static inline void drop_gone(mps_sim *sim, int k)
{
    mps_energy e;
    (void)k;
    assert_int_equal(mps_energy_init(&e, sizeof e), MPS_OK);
    assert_int_equal(mps_energy_get(sim, &e), MPS_OK);
    assert_true(fabs(e.centre[0]) < 1);
}

static inline void drop_too_far(mps_sim *sim)
{
    assert_int_equal(drop_at(sim, 1e8), MPS_E_ARG);
    assert_non_null(strstr(mps_sim_error(sim), "at most"));
}

static inline void same_place(mps_sim *sim)
{
    const double x[6] = {0.2, 0.3, 0.2, 0.3, 0.2, 0.3};
    mps_particle_block block;
    assert_int_equal(mps_particle_block_init(&block, sizeof block), MPS_OK);
    block.count = 2;
    block.position = x;
    assert_int_equal(mps_particles_add(sim, &block, NULL), MPS_E_ARG);
    if (!strstr(mps_sim_error(sim), "dp")) fail_msg("%s", mps_sim_error(sim));
}

/* A gauge of any length, and samples faster than a step. */
static inline void absurd_probes(mps_sim *sim)
{
    mps_probe p;
    int32_t id;
    double value;
    assert_int_equal(mps_probe_init(&p, sizeof p), MPS_OK);
    p.type = MPS_PROBE_GAUGE;
    p.at[0] = 0.2;
    p.length = 1e300;
    p.rate = 1e6;
    assert_int_equal(mps_probe_add(sim, &p, &id), MPS_OK);
    assert_int_equal(mps_probe_read(sim, id, &value), MPS_OK);
    assert_true(value > 0.1 && value < 0.3);
    p.rate = 1e10;
    assert_int_equal(mps_probe_add(sim, &p, &id), MPS_E_ARG);
}

/* Time cannot advance by so little. */
static inline void no_time(mps_sim *sim, int k)
{
    double t[2];
    if (k != 3) return;
    assert_int_equal(mps_sim_time(sim, &t[0], NULL), MPS_OK);
    assert_int_equal(mps_step(sim, 5e-324, NULL), MPS_E_DIVERGED);
    assert_non_null(strstr(mps_sim_error(sim), "too short"));
    assert_int_equal(mps_sim_time(sim, &t[1], NULL), MPS_OK);
    assert_true(t[0] == t[1]);
}

/* ---- the list -------------------------------------------------------------------------------- */

#define DOWN        \
    {               \
        0, -9.81, 0 \
    }
#define NONE    \
    {           \
        0, 0, 0 \
    }

static const setup setups[] = {
    {.name = "spacing 1e-6 m", .dp = 1e-6, .g = DOWN},
    {.name = "spacing 1e3 m", .dp = 1e3, .g = DOWN},
    {.name = "spacing 1e-6 m, 3-D", .dp = 1e-6, .dim = 3, .g = DOWN, .steps = 8},
    {.name = "spacing 1e-13 m",
     .dp = 1e-13,
     .g = DOWN,
     .status = MPS_E_ARG,
     .text = "config.dp is 1e-13 m"},
    {.name = "spacing 1e13 m",
     .dp = 1e13,
     .g = DOWN,
     .status = MPS_E_ARG,
     .text = "config.dp is 1e+13 m"},
    {.name = "no gravity at rest", .g = NONE, .speed = 1e-3},
    {.name = "no gravity, violent motion", .g = NONE, .before = violent, .speed = 10},
    {.name = "gravity 1e6", .g = {0, -1e6, 0}},
    {.name = "gravity upwards, closed", .g = {0, 9.81, 0}, .steps = 150},
    {.name = "gravity sideways, open", .g = {9.81, 0, 0}, .open_top = 1, .steps = 100},
    {.name = "no viscosity", .g = DOWN, .viscosity = -1},
    {.name = "viscosity 1e6 Pa s", .g = DOWN, .viscosity = 1e6},
    {.name = "density 1e-3", .g = DOWN, .density = 1e-3},
    {.name = "density 1e6", .g = DOWN, .density = 1e6},
    {.name = "densities 1e6 : 1e-3",
     .g = DOWN,
     .preset = "mmps",
     .density = 1e6,
     .gas = 1e-3,
     .speed = 5},
    {.name = "densities 1e-3 : 1e6",
     .g = DOWN,
     .preset = "mmps",
     .density = 1e-3,
     .gas = 1e6,
     .speed = 10},
    {.name = "tension 1e3 N/m",
     .g = DOWN,
     .preset = "mmps",
     .gas = 1.2,
     .before = strong_tension,
     .speed = 10},
    {.name = "one particle", .g = DOWN, .depth = -1, .before = one_particle},
    {.name = "one particle, 3-D", .dim = 3, .g = DOWN, .depth = -1, .before = one_particle},
    {.name = "no fluid", .g = DOWN, .depth = -1, .status = MPS_E_STATE, .text = "fluid"},
    {.name = "two particles at one place", .g = DOWN, .before = same_place},
    {.name = "a drop 1e5 m away", .g = DOWN, .before = lost_drop, .between = drop_gone},
    {.name = "a drop 1e8 m away", .g = DOWN, .before = drop_too_far},
    {.name = "fluid added and removed", .g = DOWN, .between = add_or_remove},
    {.name = "all fluid removed",
     .g = DOWN,
     .between = remove_all,
     .status = MPS_E_STATE,
     .text = "fluid"},
    {.name = "geometry in mid-run", .g = DOWN, .between = build_more},
    {.name = "models changed in mid-run", .g = DOWN, .between = use_late_models},
    {.name = "violent motion, 2-D", .g = DOWN, .before = violent, .steps = 400, .speed = 10},
    {.name = "violent motion, 3-D",
     .dim = 3,
     .g = DOWN,
     .before = violent,
     .steps = 60,
     .speed = 10},
    {.name = "absurd motion", .g = DOWN, .before = absurd, .status = MPS_E_DIVERGED, .speed = 1e9},
    {.name = "a tank that jumps 5 m",
     .g = DOWN,
     .before = jump,
     .steps = 300,
     .status = MPS_E_DIVERGED,
     .speed = 1e4},
    {.name = "fluid at 300 m/s", .g = DOWN, .velocity = 300},
    {.name = "fluid at 1e5 m/s",
     .g = DOWN,
     .velocity = 1e5,
     .status = MPS_E_DIVERGED,
     .text = "m/s"},
    {.name = "fluid at 1e300 m/s", .g = DOWN, .velocity = 1e300, .status = MPS_E_DIVERGED},
    {.name = "a step of 10 s", .g = DOWN, .dt = 10, .status = MPS_E_DIVERGED},
    {.name = "a step of 1e-12 s", .g = DOWN, .dt = 1e-12},
    {.name = "a step of 5e-324 s", .g = DOWN, .between = no_time},
    {.name = "absurd probes", .g = DOWN, .before = absurd_probes},
    {.name = "a tank of three cells", .g = DOWN, .size = {3, 8, 3}},
    {.name = "a tank of three cells, 3-D", .dim = 3, .g = DOWN, .size = {8, 8, 3}, .steps = 20},
    {.name = "a tank of two cells",
     .g = DOWN,
     .size = {2, 8, 3},
     .status = MPS_E_ARG,
     .text = "at least 3 spacings"},
    {.name = "a tank of one cell, 3-D",
     .dim = 3,
     .g = DOWN,
     .size = {8, 8, 1},
     .status = MPS_E_ARG,
     .text = "at least 3 spacings"},
    {.name = "near radius 1 dp",
     .g = DOWN,
     .re_near = 1,
     .status = MPS_E_ARG,
     .text = "config.re_near is 1 dp"},
    {.name = "near radius 1.49 dp",
     .g = DOWN,
     .re_near = 1.49,
     .status = MPS_E_ARG,
     .text = "1.5 <= re_near"},
    {.name = "radii 1.5 dp", .g = DOWN, .re_near = 1.5, .re_far = 1.5},
    {.name = "radii 10 dp", .g = DOWN, .re_near = 10, .re_far = 10, .steps = 8},
    {.name = "far radius 10.5 dp",
     .g = DOWN,
     .re_far = 10.5,
     .status = MPS_E_ARG,
     .text = "config.re_far is 10.5 dp"},
    {.name = "1025 threads",
     .g = DOWN,
     .threads = 1025,
     .status = MPS_E_ARG,
     .text = "config.threads is 1025"},
    {.name = "64 threads", .g = DOWN, .threads = 64, .steps = 4},
    {.name = "imps", .g = DOWN, .preset = "imps"},
    {.name = "imps, 3-D", .dim = 3, .g = DOWN, .preset = "imps", .steps = 12},
    {.name = "imps.paper", .g = DOWN, .preset = "imps.paper"},
    {.name = "imps.paper, 3-D", .dim = 3, .g = DOWN, .preset = "imps.paper", .steps = 12},
    {.name = "mmps", .g = DOWN, .preset = "mmps", .gas = 1.2},
    {.name = "mmps, 3-D", .dim = 3, .g = DOWN, .preset = "mmps", .gas = 1.2, .steps = 8},
    {.name = "mmps.paper", .g = DOWN, .preset = "mmps.paper", .gas = 1.2},
    {.name = "mmps.paper, 3-D",
     .dim = 3,
     .g = DOWN,
     .preset = "mmps.paper",
     .gas = 1.2,
     .steps = 8},
    {.name = "mmps without gas",
     .g = DOWN,
     .preset = "mmps",
     .status = MPS_E_PLUGIN,
     .text = "phase 1"},
};

enum { SETUPS = sizeof setups / sizeof setups[0] };

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* Set-ups of extreme values. Each must end in a given status, with a given text if it is refused, and within physical bounds: finite
 * fields, no fluid particle lost without notice, and no fluid faster than a multiple of the speed of the set-up. */
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
    /* what must come of it */
    mps_status status; /* MPS_OK: no failure */
    const char *text;  /* part of the error text */
    double speed;      /* largest speed over that of the set-up; 0: 3 */
} setup;

static mps_sim *created; /* destroyed after each test, also a failed one */
static char creation[300];

static int clean(void **state)
{
    (void)state;
    mps_sim_destroy(created);
    created = NULL;
    return 0;
}

/* ---- building -------------------------------------------------------------------------------------------------------- */

static mps_status create(const setup *s)
{
    mps_config config;
    creation[0] = '\0';
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dim = s->dim ? s->dim : 2;
    config.dp = s->dp ? s->dp : 0.05;
    for (int d = 0; d < 3; d++) config.gravity[d] = s->g[d];
    config.re_near = s->re_near;
    config.re_far = s->re_far;
    config.threads = s->threads;
    config.error = creation;
    config.error_size = sizeof creation;
    return mps_sim_create(&config, &created);
}

static mps_status set_phases(const setup *s, mps_sim *sim)
{
    mps_phase p;
    assert_int_equal(mps_phase_init(&p, sizeof p), MPS_OK);
    if (s->density) p.density = s->density;
    if (s->viscosity) p.viscosity = s->viscosity > 0 ? s->viscosity : 0; /* -1: none */
    mps_status status = mps_phase_set(sim, 0, &p);
    if (status || !s->gas) return status;
    p.density = s->gas;
    p.viscosity = 1.8e-5;
    return mps_phase_set(sim, 1, &p);
}

static mps_status build_tank(const setup *s, mps_sim *sim, double dp)
{
    mps_tank tank;
    assert_int_equal(mps_tank_init(&tank, sizeof tank), MPS_OK);
    for (int d = 0; d < 3; d++) tank.size[d] = dp * (s->size[d] ? s->size[d] : 8);
    tank.open_top = s->open_top;
    return mps_tank_add(sim, &tank, NULL);
}

static mps_status fill(const setup *s, mps_sim *sim, double dp)
{
    const double lo[3] = {0, 0, 0};
    double hi[3];
    for (int d = 0; d < 3; d++) hi[d] = dp * (s->size[d] ? s->size[d] : 8);
    const double top[3] = {hi[0], hi[1], hi[2]};
    hi[1] = dp * (s->depth ? s->depth : 4);
    if (s->depth < 0) return MPS_OK;
    mps_status status = mps_fill_box_add(sim, 0, lo, hi, NULL, NULL);
    return status || !s->gas ? status : mps_fill_box_add(sim, 1, lo, top, NULL, NULL);
}

static void push_fluid(mps_sim *sim, double velocity)
{
    mps_lease u = {.struct_size = sizeof u};
    const int32_t *kinds;
    assert_int_equal(tags_peek(sim, NULL, &kinds, NULL, NULL), MPS_OK);
    assert_int_equal(mps_lease_begin(sim, "velocity", MPS_WRITE, &u), MPS_OK);
    for (int64_t i = 0; i < u.count; i++)
        if (kinds[i] == MPS_FLUID) u.data[i * u.stride] = velocity;
    assert_int_equal(mps_lease_end(sim, &u), MPS_OK);
}

static mps_status build(const setup *s)
{
    mps_status status = create(s);
    if (status) return status;
    double dp;
    assert_int_equal(mps_sim_shape(created, NULL, &dp), MPS_OK);
    if (s->preset) status = mps_preset_use(created, s->preset);
    if (status == MPS_OK) status = set_phases(s, created);
    if (status == MPS_OK) status = build_tank(s, created, dp);
    if (status == MPS_OK) status = fill(s, created, dp);
    if (status == MPS_OK && s->dt) {
        mps_time_control control;
        assert_int_equal(mps_time_control_init(&control, sizeof control), MPS_OK);
        control.dt = s->dt;
        status = mps_time_control_set(created, &control);
    }
    if (status == MPS_OK && s->velocity) push_fluid(created, s->velocity);
    if (status == MPS_OK && s->before) s->before(created);
    return status;
}

/* ---- checks ---------------------------------------------------------------------------------------------------------- */

static void check_finite(mps_sim *sim)
{
    static const char *const fields[] = {"position", "velocity", "pressure", "number_density",
                                         "density"};
    for (size_t f = 0; f < sizeof fields / sizeof fields[0]; f++) {
        mps_lease lease = {.struct_size = sizeof lease};
        assert_int_equal(mps_lease_begin(sim, fields[f], MPS_READ, &lease), MPS_OK);
        for (int64_t i = 0; i < lease.count * lease.stride; i++)
            if (!isfinite(lease.data[i]))
                fail_msg("%s: number %lld is %g", fields[f], (long long)i, lease.data[i]);
        assert_int_equal(mps_lease_end(sim, &lease), MPS_OK);
    }
}

/* A fall through the tank, or what the fluid began with. */
static double speed_of(const setup *s)
{
    const double dp = s->dp ? s->dp : 0.05,
                 g = sqrt(s->g[0] * s->g[0] + s->g[1] * s->g[1] + s->g[2] * s->g[2]);
    return fmax(fabs(s->velocity),
                sqrt(2 * (g > 0 ? g : 9.81) * dp * (s->size[1] ? s->size[1] : 8)));
}

static void run_setup(void **state)
{
    const setup *s = *state;
    mps_step_info info;
    double fastest = 0;
    mps_status status = build(s);
    assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
    for (int k = 0; k < (s->steps ? s->steps : 40) && status >= 0; k++) {
        status = mps_step(created, 1e9, &info);
        fastest = fmax(fastest, info.max_speed);
        if (s->between && status >= 0) s->between(created, k);
    }
    const char *text = created ? mps_sim_error(created) : creation;
    if ((status < 0 || s->status < 0) && status != s->status)
        fail_msg("%s instead of %s after %lld steps: %s", mps_status_name(status),
                 mps_status_name(s->status), (long long)info.step, text);
    if (s->text && !strstr(text, s->text)) fail_msg("\"%s\" does not say \"%s\"", text, s->text);
    if (created) check_finite(created);
    const double most = (s->speed ? s->speed : 3) * speed_of(s);
    if (!(fastest <= most)) fail_msg("fluid at %g m/s: at most %g m/s", fastest, most);
}

/* ---- what happens beside steps --------------------------------------------------------------------------------------- */

static void one_particle(mps_sim *sim)
{
    const double x[3] = {0.2, 0.3, 0.2};
    mps_particle_block block;
    assert_int_equal(mps_particle_block_init(&block, sizeof block), MPS_OK);
    block.count = 1;
    block.position = x;
    assert_int_equal(mps_particles_add(sim, &block, NULL), MPS_OK);
}

static void add_or_remove(mps_sim *sim, int k)
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

static void remove_all(mps_sim *sim, int k)
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

static void build_more(mps_sim *sim, int k)
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

static void use_late_models(mps_sim *sim, int k)
{
    static const char *const presets[] = {"imps", "imps.paper"};
    if (k % 5 == 4) assert_int_equal(mps_preset_use(sim, presets[k % 2]), MPS_OK);
}

static void shake(mps_sim *sim, double metres, double radians, double omega)
{
    mps_harmonic h[6];
    int32_t dim, count = 0;
    assert_int_equal(mps_sim_shape(sim, &dim, NULL), MPS_OK);
    for (int32_t dof = 0; dof < MPS_DOF_COUNT; dof++)
        if (dim == 3 || dof == MPS_SURGE || dof == MPS_HEAVE || dof == MPS_YAW)
            h[count++] = (mps_harmonic){dof, 0, dof < MPS_ROLL ? metres : radians,
                                        omega * (1 + 0.1 * dof), dof};
    assert_int_equal(mps_motion_harmonics_set(sim, count, h), MPS_OK);
}

static void violent(mps_sim *sim)
{
    shake(sim, 0.1, 0.5, 12);
}

static void absurd(mps_sim *sim)
{
    shake(sim, 1e6, 3, 1e4);
}

static void jump(mps_sim *sim)
{
    const double t[4] = {0, 0.01, 0.011, 10}, x[4] = {0, 0, 5, 5};
    const int32_t dof = MPS_SURGE;
    assert_int_equal(mps_motion_table_set(sim, 4, t, 1, &dof, x), MPS_OK);
}

static void strong_tension(mps_sim *sim)
{
    assert_int_equal(mps_tension_set(sim, 0, 1, 1e3), MPS_OK);
}

static mps_status drop_at(mps_sim *sim, double far)
{
    const double x[3] = {far, far, 0.2};
    mps_particle_block block;
    assert_int_equal(mps_particle_block_init(&block, sizeof block), MPS_OK);
    block.count = 1;
    block.position = x;
    return mps_particles_add(sim, &block, NULL);
}

static void lost_drop(mps_sim *sim)
{
    assert_int_equal(drop_at(sim, 1e5), MPS_OK);
}

static void drop_gone(mps_sim *sim, int k)
{
    mps_energy e;
    (void)k;
    assert_int_equal(mps_energy_init(&e, sizeof e), MPS_OK);
    assert_int_equal(mps_energy_get(sim, &e), MPS_OK);
    assert_true(fabs(e.centre[0]) < 1);
}

static void drop_too_far(mps_sim *sim)
{
    assert_int_equal(drop_at(sim, 1e8), MPS_E_ARG);
    assert_non_null(strstr(mps_sim_error(sim), "at most"));
}

static void same_place(mps_sim *sim)
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
static void absurd_probes(mps_sim *sim)
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
static void no_time(mps_sim *sim, int k)
{
    double t[2];
    if (k != 3) return;
    assert_int_equal(mps_sim_time(sim, &t[0], NULL), MPS_OK);
    assert_int_equal(mps_step(sim, 5e-324, NULL), MPS_E_DIVERGED);
    assert_non_null(strstr(mps_sim_error(sim), "too short"));
    assert_int_equal(mps_sim_time(sim, &t[1], NULL), MPS_OK);
    assert_true(t[0] == t[1]);
}

/* ---- the list -------------------------------------------------------------------------------------------------------- */

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
    {.name = "near radius 1.01 dp",
     .g = DOWN,
     .re_near = 1.01,
     .re_far = 1.01,
     .speed = 1000}, /* sees next to nothing */
    {.name = "radii 1.6 dp", .g = DOWN, .re_near = 1.6, .re_far = 1.6},
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

/* The same bytes with 1 to 8 threads. */
static void threads_agree(void **state)
{
    static double one[20000];
    const setup s = {
        .dim = 3, .dp = 0.05, .g = DOWN, .size = {10, 8, 8}, .steps = 6, .before = violent};
    (void)state;
    for (int32_t threads = 1; threads <= 8; threads++) {
        setup with = s;
        mps_lease x = {.struct_size = sizeof x};
        with.threads = threads;
        assert_int_equal(build(&with), MPS_OK);
        for (int k = 0; k < s.steps; k++) assert_true(mps_step(created, 1, NULL) >= 0);
        assert_int_equal(mps_lease_begin(created, "position", MPS_READ, &x), MPS_OK);
        assert_true(x.count * x.stride <= 20000);
        if (threads == 1)
            memcpy(one, x.data, (size_t)(x.count * x.stride) * sizeof *one);
        else
            assert_memory_equal(one, x.data, (size_t)(x.count * x.stride) * sizeof *one);
        clean(NULL);
    }
}

int main(void)
{
    struct CMUnitTest tests[SETUPS + 1] = {cmocka_unit_test_teardown(threads_agree, clean)};
    for (int k = 0; k < SETUPS; k++)
        tests[k + 1] = (struct CMUnitTest){setups[k].name, run_setup, NULL, clean,
                                           (void *)&setups[k]};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

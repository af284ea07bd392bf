/* SPDX-License-Identifier: BSD-3-Clause */
/* Applications may trap floating-point exceptions, as OpenFOAM and gfortran -ffpe-trap do: no
 * operation of an ordinary run is invalid, divides by zero or overflows. Without traps (other C
 * libraries, some processors) and with clang these tests are skipped. */
#ifdef __linux__
#define _GNU_SOURCE /* feenableexcept() */
#endif
#include "parallel.h"
#include <fenv.h>
#include <mps/mps.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

static char folder[] = "mps_traps_XXXXXX";

#if defined(__GLIBC__) && !defined(__clang__) /* clang computes both sides of a choice */
enum { TRAPS = FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW };

static bool traps_on(void)
{
    return feenableexcept(TRAPS) != -1 && (fegetexcept() & TRAPS) == TRAPS;
}

static bool traps_here(void)
{
    return (fegetexcept() & TRAPS) == TRAPS;
}

static void traps_off(void)
{
    fedisableexcept(TRAPS);
}
#else
static bool traps_on(void)
{
    return false;
}

static bool traps_here(void)
{
    return false;
}

static void traps_off(void) {}
#endif

/* ---- the scene: a column of liquid falls in a tank that moves ---- */

typedef struct scene {
    const char *name, *preset, *solver, *preconditioner;
    int32_t dim;
    double t_end;
    bool resting;    /* the tank is at rest with calm liquid */
    bool weightless; /* without gravity */
} scene;

static const scene scenes[] = {
    {.name = "imps", .preset = "imps", .dim = 2, .t_end = 1},
    {.name = "imps, 3-D", .preset = "imps", .dim = 3, .t_end = 0.4},
    {.name = "imps.paper", .preset = "imps.paper", .dim = 2, .t_end = 1},
    {.name = "imps.paper, 3-D", .preset = "imps.paper", .dim = 3, .t_end = 0.4},
    {.name = "mmps", .preset = "mmps", .dim = 2, .t_end = 0.3},
    {.name = "mmps, 3-D", .preset = "mmps", .dim = 3, .t_end = 0.1},
    {.name = "mmps.paper", .preset = "mmps.paper", .dim = 2, .t_end = 0.3},
    {.name = "mmps.paper, 3-D", .preset = "mmps.paper", .dim = 3, .t_end = 0.1},
    {.name = "at rest", .preset = "imps", .dim = 2, .t_end = 0.1, .resting = true},
    {.name = "at rest, 3-D", .preset = "imps", .dim = 3, .t_end = 0.1, .resting = true},
    {.name = "gas at rest", .preset = "mmps", .dim = 2, .t_end = 0.02, .resting = true},
    {.name = "weightless", .preset = "imps", .dim = 2, .t_end = 0.05, .weightless = true},
    {.name = "weightless gas",
     .preset = "mmps",
     .dim = 2,
     .t_end = 0.02,
     .resting = true,
     .weightless = true}};

static mps_status add_fluid(mps_sim *sim, const scene *c)
{
    const double lo[3] = {0, 0, 0}, all[3] = {0.6, 0.4, 0.4},
                 depth[3] = {c->resting ? 0.6 : 0.3, 0.24, 0.4};
    mps_phase gas;
    mps_status status = mps_fill_box_add(sim, 0, lo, depth, NULL, NULL);
    if (status < 0 || c->preset[0] != 'm') return status;
    mps_phase_init(&gas, sizeof gas);
    gas.density = 1.2;
    gas.viscosity = 1.8e-5;
    status = mps_phase_set(sim, 1, &gas);
    if (status >= 0) status = mps_tension_set(sim, 0, 1, 0.07);
    return status < 0 ? status : mps_fill_box_add(sim, 1, lo, all, NULL, NULL);
}

static mps_status add_walls(mps_sim *sim, const scene *c)
{
    const double lo[3] = {0.45, 0, 0}, hi[3] = {0.525, 0.1, 0.4}, corner[3] = {0.15, 0.3, 0},
                 edge[3] = {0.15, 0, 0}, edge2[3] = {0, 0, 0.4};
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = 0.6;
    tank.size[1] = tank.size[2] = 0.4;
    mps_status status = mps_tank_add(sim, &tank, NULL);
    if (status >= 0 && !c->resting) status = mps_baffle_add(sim, "baffle", lo, hi, NULL);
    if (status >= 0 && !c->resting)
        status = mps_plate_add(sim, "plate", corner, edge, c->dim == 3 ? edge2 : NULL);
    return status;
}

static mps_status add_motion(mps_sim *sim, const scene *c)
{
    mps_harmonic h[MPS_DOF_COUNT];
    int32_t count = 0;
    if (c->resting) return MPS_OK;
    for (int32_t dof = 0; dof < MPS_DOF_COUNT; dof++)
        if (c->dim == 3 || dof == MPS_MOVE_X || dof == MPS_MOVE_Y || dof == MPS_ROTATE_Z)
            h[count++] = (mps_harmonic){dof, dof % 2, 0.02, 6 + dof, 0, 0};
    return mps_motion_harmonics_set(sim, count, h);
}

static mps_status add_probes(mps_sim *sim)
{
    mps_status status = MPS_OK;
    for (int32_t type = MPS_PROBE_WALL_PRESSURE; type <= MPS_PROBE_FORCE && status >= 0; type++) {
        mps_probe p;
        int32_t id;
        mps_probe_init(&p, sizeof p);
        p.type = type;
        p.rate = 500;
        p.at[1] = type == MPS_PROBE_WALL_PRESSURE ? 0.1 : 0;
        p.at[0] = type == MPS_PROBE_WALL_PRESSURE ? 0 : 0.1;
        p.at[2] = 0.2;
        status = mps_probe_add(sim, &p, &id);
    }
    return status;
}

/* NULL if a call fails; its text is printed. */
static mps_sim *build(const scene *c)
{
    mps_config config;
    mps_sim *sim = NULL;
    mps_config_init(&config, sizeof config);
    config.dim = c->dim;
    config.dp = c->dim == 2 ? 0.025 : 0.05;
    config.threads = 2;
    if (c->weightless) config.gravity[1] = 0;
    if (mps_sim_create(&config, &sim) < 0) return NULL;
    mps_status status = mps_preset_use(sim, c->preset);
    if (status >= 0) status = add_walls(sim, c);
    if (status >= 0) status = add_fluid(sim, c);
    if (status >= 0) status = add_motion(sim, c);
    if (status >= 0) status = add_probes(sim);
    if (status >= 0 && c->solver) status = mps_solver_use(sim, c->solver, c->preconditioner);
    if (status >= 0) return sim;
    print_message("%s: %s\n", c->name, mps_sim_error(sim));
    mps_sim_destroy(sim);
    return NULL;
}

/* Frames, samples and energies after each tenth step. */
static int watch(void *frames, mps_sim *sim, const mps_step_info *info)
{
    mps_energy e;
    const double *t, *values;
    int64_t count;
    if (info->step % 10) return 0;
    mps_energy_init(&e, sizeof e);
    bool failed = mps_frames_write(frames) < 0 || mps_energy_get(sim, &e) < 0;
    for (int32_t id = 0; id < 4; id++)
        failed = failed || mps_probe_series(sim, id, &count, &t, &values) < 0;
    return failed;
}

/* The presets of the papers may end early. */
static mps_status run(mps_sim *sim, const scene *c)
{
    mps_frames *frames = NULL;
    mps_status status = mps_frames_open(sim, folder, "traps", MPS_FRAMES_FLUID, &frames);
    if (status >= 0) status = mps_run(sim, c->t_end, watch, frames);
    mps_frames_close(frames);
    const bool ends = (status == MPS_E_DIVERGED || status == MPS_E_PLUGIN) &&
                      strstr(c->preset, ".paper");
    return ends ? MPS_OK : status;
}

static void no_exception(void **state)
{
    const scene *c = *state;
    char path[100];
    snprintf(path, sizeof path, "%s/state", folder);
    if (!traps_on()) skip();
    mps_sim *sim = build(c), *again = sim ? build(c) : NULL;
    mps_status status = again ? run(sim, c) : MPS_E_STATE;
    if (status >= 0) status = mps_checkpoint_write(sim, path);
    if (status >= 0) status = mps_checkpoint_read(again, path);
    if (status >= 0 && !strstr(c->preset, ".paper")) status = mps_step(again, 1, NULL);
    traps_off();
    if (status < 0) print_message("%s: %s\n", c->name, again ? mps_sim_error(sim) : "not built");
    mps_sim_destroy(again);
    mps_sim_destroy(sim);
    remove(path);
    assert_true(status >= 0);
}

/* ---- solvers ---- */

static void each_solver(void **state)
{
    static const struct {
        const char *solver, *preconditioner;
    } pairs[] = {{"sundials.pcg", "auxgrid"},  {"sundials.pcg", "jacobi"},
                 {"sundials.pcg", "ic0"},      {"sundials.bicgstab", "ic0"},
                 {"sundials.gmres", "jacobi"}, {"sundials.klu", NULL},
                 {"sundials.kinsol", "ic0"}};
    (void)state;
    for (size_t k = 0; k < sizeof pairs / sizeof pairs[0]; k++)
        for (int32_t dim = 2; dim <= 3; dim++) {
            scene c = {.name = pairs[k].solver,
                       .preset = "imps",
                       .solver = pairs[k].solver,
                       .preconditioner = pairs[k].preconditioner,
                       .dim = dim,
                       .t_end = 0.05};
            void *each = &c;
            no_exception(&each);
        }
}

/* ---- threads of the library ---- */

enum { PARTS = 64 };

typedef struct parts {
    atomic_int begun, trapping;
} parts;

/* The first part waits until another thread has begun one, if any does. */
static void look(void *argument, int32_t part)
{
    parts *p = argument;
    atomic_fetch_add(&p->begun, 1);
    if (traps_here()) atomic_fetch_add(&p->trapping, 1);
    for (int k = 0; part == 0 && k < 1000 && atomic_load(&p->begun) == 1; k++) usleep(1000);
}

static void threads_trap(void **state)
{
    (void)state;
    mps__context context = {.allocator = mps__allocator_default()};
    mps__pool pool;
    parts p = {0, 0};
    if (!traps_on()) skip();
    mps__pool_init(&pool, &context);
    mps__pool_resize(&pool, 2);
    mps_parallel_run(&pool.parallel, PARTS, look, &p);
    mps__pool_free(&pool);
    traps_off();
    assert_int_equal(p.begun, PARTS);
    assert_int_equal(p.trapping, PARTS);
}

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    char command[100];
    (void)state;
    snprintf(command, sizeof command, "rm -r %s", folder);
    return system(command);
}

int main(void)
{
    enum { SCENES = sizeof scenes / sizeof scenes[0] };
    struct CMUnitTest tests[SCENES + 2] = {cmocka_unit_test(each_solver),
                                           cmocka_unit_test(threads_trap)};
    for (int k = 0; k < SCENES; k++)
        tests[2 + k] = (struct CMUnitTest){scenes[k].name, no_exception, NULL, NULL,
                                           (void *)&scenes[k]};
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* As test_oom.c, for calls during a run: steps, checkpoints, probes, frames. */
#include "oom_fixture.h"
#include <mps/voids.h>

/* ---- scenes: set-ups before the call under test ------------------------------------------ */

static void stepped(mps_sim *sim)
{
    filled(sim);
    for (int k = 0; k < 3; k++) assert_int_equal(mps_step(sim, 1e-3, NULL), MPS_OK);
}

static const char checkpoint[] = "oom.checkpoint";

static mps_status write_checkpoint(mps_sim *sim)
{
    return mps_checkpoint_write(sim, checkpoint);
}

static mps_status read_checkpoint(mps_sim *sim)
{
    return mps_checkpoint_read(sim, checkpoint);
}

/* A step beyond a checkpoint. */
static void beyond(mps_sim *sim)
{
    sampled(sim);
    assert_int_equal(write_checkpoint(sim), MPS_OK);
    assert_int_equal(mps_step(sim, 1e-3, NULL), MPS_OK);
}

/* And back. */
static void restored(mps_sim *sim)
{
    beyond(sim);
    assert_int_equal(read_checkpoint(sim), MPS_OK);
}

static void with_plate(mps_sim *sim)
{
    const double lo[2] = {0.25, 0}, hi[2] = {0.25, 0.2};
    tank_only(sim);
    assert_int_equal(mps_baffle_add(sim, "plate", lo, hi, NULL), MPS_OK);
    assert_int_equal(fill(sim), MPS_OK);
}

static void filled_for_bicgstab(mps_sim *sim)
{
    filled(sim);
    assert_int_equal(mps_solver_use(sim, "sundials.bicgstab", "ic0"), MPS_OK);
}

static void filled_for_gmres(mps_sim *sim)
{
    filled(sim);
    assert_int_equal(mps_solver_use(sim, "sundials.gmres", "jacobi"), MPS_OK);
    assert_int_equal(mps_preset_use(sim, "imps.paper"), MPS_OK);
}

static void filled_for_auxgrid(mps_sim *sim)
{
    filled(sim);
    assert_int_equal(mps_solver_use(sim, "sundials.pcg", "auxgrid"), MPS_OK);
}

/* A closed tank of gas alone: nonlinear rows. */
static void gas_for_kinsol(mps_sim *sim)
{
    mps_tank tank;
    const double lo[2] = {0, 0}, hi[2] = {0.5, 0.5};
    assert_int_equal(mps_tank_init(&tank, sizeof tank), MPS_OK);
    tank.size[0] = tank.size[1] = 0.5;
    assert_int_equal(mps_tank_add(sim, &tank, NULL), MPS_OK);
    assert_int_equal(mps_fill_box_add(sim, 0, lo, hi, NULL, NULL), MPS_OK);
    assert_int_equal(mps_model_use(sim, "gas.isentropic"), MPS_OK);
    assert_int_equal(mps_model_set(sim, "gas", "phase", 0), MPS_OK);
    assert_int_equal(mps_solver_use(sim, "sundials.kinsol", NULL), MPS_OK);
}

static void filled_for_klu(mps_sim *sim)
{
    filled(sim);
    assert_int_equal(mps_solver_use(sim, "sundials.klu", NULL), MPS_OK);
}

static void grown(mps_sim *sim)
{
    stepped(sim);
    assert_int_equal(add_drop(sim, 0.36, 64), MPS_OK);
}

/* ---- calls under test ------------------------------------------------------------------------ */

static mps_status series(mps_sim *sim)
{
    int64_t count = -1;
    const mps_status status = mps_probe_series(sim, 0, &count, NULL, NULL);
    assert_int_equal(count, status == MPS_OK ? 2001 : -1);
    return status;
}

static mps_status read_gauge(mps_sim *sim)
{
    double value;
    return mps_probe_read(sim, 2, &value);
}

static mps_status stencil(mps_sim *sim)
{
    mps_stencil s = {.struct_size = sizeof s};
    return mps_stencil_get(sim, MPS_FAR, &s);
}

/* ---- presets and all else that takes memory --- */

static void use_preset(mps_sim *sim, const char *name)
{
    assert_int_equal(mps_preset_use(sim, name), MPS_OK);
}

static void with_gas(mps_sim *sim, const char *preset_name)
{
    const mps_phase gas = {.struct_size = sizeof gas, .density = 1.2, .viscosity = 1.8e-5};
    const double lo[3] = {0, 0, 0}, hi[3] = {0.5, 0.5, 0.5};
    mps_tank tank;
    assert_int_equal(mps_tank_init(&tank, sizeof tank), MPS_OK);
    tank.size[0] = tank.size[1] = tank.size[2] = 0.5;
    use_preset(sim, preset_name);
    assert_int_equal(mps_phase_set(sim, 1, &gas), MPS_OK);
    assert_int_equal(mps_tank_add(sim, &tank, NULL), MPS_OK);
    assert_int_equal(fill(sim), MPS_OK);
    assert_int_equal(mps_fill_box_add(sim, 1, lo, hi, NULL, NULL), MPS_OK);
}

static void filled_paper(mps_sim *sim)
{
    use_preset(sim, "imps.paper");
    filled(sim);
}

static void filled_mmps(mps_sim *sim)
{
    with_gas(sim, "mmps");
}

static void filled_mmps_paper(mps_sim *sim)
{
    with_gas(sim, "mmps.paper");
}

static void using_own_model(mps_sim *sim)
{
    with_own_model(sim);
    assert_int_equal(use_own_model(sim), MPS_OK);
}

/* Voids with faces, a plate, and numbers that grow. */
static int find_voids(mps_stage *s)
{
    mps_voids v;
    double *value = mps_stage_state(s, 100 + 50 * s->step);
    assert_int_equal(mps_voids_init(&v, sizeof v), MPS_OK);
    if (!value || mps_stage_voids(s, NULL, &v)) return 1;
    if (v.count < 2 || v.faces == 0) return mps_stage_fail(s, "no void is enclosed");
    value[0] += v.count;
    return 0;
}

static int with_hole(void *user, const double *x)
{
    (void)user;
    return x[1] < 0.4 && hypot(x[0] - 0.25, x[1] - 0.15) > 0.1;
}

static void with_voids(mps_sim *sim)
{
    static const mps_verb verbs[] = {{.hook = MPS_PREPARE, .run = find_voids}};
    const mps_model_ops ops = {.struct_size = sizeof ops,
                               .api = MPS_MODEL_API,
                               .name = "oom.voids",
                               .help = "any",
                               .verb_count = 1,
                               .verbs = verbs};
    const double lo[2] = {0.45, 0}, hi[2] = {0.45, 0.2};
    tank_only(sim);
    assert_int_equal(mps_baffle_add(sim, "plate", lo, hi, NULL), MPS_OK);
    assert_int_equal(mps_fill_add(sim, 0, with_hole, NULL, NULL), MPS_OK);
    assert_int_equal(mps_model_register(sim, &ops), MPS_OK);
    assert_int_equal(mps_model_use(sim, "oom.voids"), MPS_OK);
}

static void with_numbers(mps_sim *sim)
{
    with_voids(sim);
    assert_int_equal(mps_step(sim, 1e-3, NULL), MPS_OK);
    assert_int_equal(write_checkpoint(sim), MPS_OK);
}

static mps_status energy(mps_sim *sim)
{
    mps_energy e;
    assert_int_equal(mps_energy_init(&e, sizeof e), MPS_OK);
    return mps_energy_get(sim, &e);
}

static mps_status frames(mps_sim *sim)
{
    mps_frames *f = NULL;
    mps_status status = mps_frames_open(sim, ".", "oom_frames", 0, &f);
    if (status == MPS_OK) status = mps_frames_write(f);
    if (status == MPS_OK) status = mps_frames_write(f);
    mps_frames_close(f);
    return status;
}

static mps_status frames_continued(mps_sim *sim)
{
    mps_frames *f = NULL;
    const mps_status status = mps_frames_open(sim, ".", "oom_frames", MPS_FRAMES_CONTINUE, &f);
    mps_frames_close(f);
    return status;
}

static void with_frames(mps_sim *sim)
{
    stepped(sim);
    assert_int_equal(frames(sim), MPS_OK);
}

static mps_status read_force(mps_sim *sim)
{
    double values[6];
    return mps_probe_read(sim, 3, values);
}

static const scene scenes[] = {
    {"step with a plate", with_plate, step, 20, 0},
    {"first step", filled, step, 20, 0},
    {"later step", stepped, step, 0, 0}, /* has all it needs */
    {"step of more", grown, step, 20, 0},
    {"step with samples", sampled, step, 8, 0},
    {"probe_series", sampled, series, 2, 0},
    {"probe_read", sampled, read_gauge, 3, 0},
    {"first step, bicgstab", filled_for_bicgstab, step, 20, 0},
    {"first step, gmres", filled_for_gmres, step, 20, 0},
    {"first step, auxgrid", filled_for_auxgrid, step, 20, 0},
    {"first step, klu", filled_for_klu, step, 20, 0},
    {"first step, kinsol", gas_for_kinsol, step, 20, 0},
    {"stencil", filled, stencil, 10, 0},
    {"stencil of more", grown, stencil, 10, 0},
    {"checkpoint_write", sampled, write_checkpoint, 2, 0},
    {"checkpoint_read", beyond, read_checkpoint, 20, 0},
    {"step after checkpoint_read", restored, step, 8, 0},
    {"first step, imps, 3-D", filled, step, 20, 3},
    {"first step, imps.paper", filled_paper, step, 20, 0},
    {"first step, imps.paper, 3-D", filled_paper, step, 20, 3},
    {"first step, mmps", filled_mmps, step, 20, 0},
    {"first step, mmps, 3-D", filled_mmps, step, 20, 3},
    {"first step, mmps.paper", filled_mmps_paper, step, 20, 0},
    {"first step, mmps.paper, 3-D", filled_mmps_paper, step, 20, 3},
    {"first step, threads", filled_threads, step, 20, 0},
    {"first step, own model", using_own_model, step, 20, 0},
    {"first step, voids", with_voids, step, 40, 0},
    {"later step, numbers", with_numbers, step, 2, 0},
    {"checkpoint_read, numbers", with_numbers, read_checkpoint, 20, 0},
    {"energy_get", filled, energy, 0, 0},
    {"frames", stepped, frames, 1, 0},
    {"frames continued", with_frames, frames_continued, 1, 0},
    {"probe_read of a force", sampled, read_force, 0, 0},
};

int main(void)
{
    enum { SCENES = sizeof scenes / sizeof scenes[0] };
    struct CMUnitTest tests[SCENES];
    for (int k = 0; k < SCENES; k++)
        tests[k] = (struct CMUnitTest){scenes[k].name, run_scene, NULL, NULL, (void *)&scenes[k]};
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    remove(checkpoint);
    remove("oom_frames.pvd");
    return failed;
}

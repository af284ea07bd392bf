/* SPDX-License-Identifier: BSD-3-Clause */
/* Scenes, and a folder for checkpoints, shared by the tests of checkpoints. */
#ifndef CHECKPOINT_FIXTURE_H
#define CHECKPOINT_FIXTURE_H

#include "tank_fixture.h"
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { STEPS = 30, PATH = 128 };

static char folder[] = "mps_checkpoint_XXXXXX";

static inline int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static inline const char *path_of(char out[PATH], const char *name)
{
    snprintf(out, PATH, "%s/%s", folder, name);
    return out;
}

static inline int remove_folder(void **state)
{
    char command[PATH];
    (void)state;
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command);
}

/* ---- scenes ---- */

static inline void shake(mps_sim *sim, double amplitude)
{
    const mps_harmonic motion[2] = {{.dof = MPS_MOVE_X, .amplitude = amplitude, .omega = 12},
                                    {.dof = MPS_ROTATE_Z, .amplitude = 0.2, .omega = 9}};
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 2, motion));
}

static inline void add_probes(mps_sim *sim)
{
    mps_probe probe;
    int32_t id;
    assert_int_equal(mps_probe_init(&probe, sizeof probe), MPS_OK);
    probe.at[1] = 0.1;
    probe.average = 0.03;
    probe.rate = 300;
    ASSERT_OK(sim, mps_probe_add(sim, &probe, &id));
    probe.type = MPS_PROBE_FORCE;
    probe.average = 0;
    ASSERT_OK(sim, mps_probe_add(sim, &probe, &id));
    probe.type = MPS_PROBE_GAUGE;
    probe.rate = 0;
    probe.at[0] = 0.2;
    probe.at[1] = 0;
    ASSERT_OK(sim, mps_probe_add(sim, &probe, &id));
    ASSERT_OK(sim, mps_probe_add(sim, &probe, &id));
    ASSERT_OK(sim, mps_probe_remove(sim, id));
}

static inline mps_sim *shaken(void)
{
    mps_sim *sim = new_sim(2, 0.05);
    add_tank(sim, 0.6, 0.6, 0);
    fill_depth(sim, 0.6, 0.3, 0);
    ASSERT_OK(sim, mps_field_add(sim, "mark", 2));
    add_probes(sim);
    shake(sim, 0.1);
    return sim;
}

static inline mps_sim *with_air(void)
{
    const double lo[2] = {0, 0}, hi[2] = {0.6, 0.6};
    mps_phase air;
    mps_sim *sim = new_sim(2, 0.04);
    assert_int_equal(mps_phase_init(&air, sizeof air), MPS_OK);
    air.density = 1.2;
    air.viscosity = 1.8e-5;
    ASSERT_OK(sim, mps_preset_use(sim, "mmps"));
    ASSERT_OK(sim, mps_phase_set(sim, 1, &air));
    add_tank(sim, 0.6, 0.6, 0);
    fill_depth(sim, 0.6, 0.3, 0);
    ASSERT_OK(sim, mps_fill_box_add(sim, 1, lo, hi, NULL, NULL));
    add_probes(sim);
    shake(sim, 0.05);
    return sim;
}

static inline mps_sim *with_gas_law(void)
{
    mps_sim *sim = with_air();
    ASSERT_OK(sim, mps_model_use(sim, "gas.isentropic"));
    ASSERT_OK(sim, mps_solver_use(sim, "sundials.kinsol", NULL));
    return sim;
}

/* A column falls over a plate that leans, and drops start outside of where anything may be. */
static inline mps_sim *plate(void)
{
    const double lost[4] = {0.3, 50, 0.4, 60}, foot[2] = {0.6, 0}, edge[2] = {0.05, 0.15};
    mps_sim *sim = new_sim(2, 0.04);
    mps_particle_block block;
    add_tank(sim, 1, 0.6, 0);
    ASSERT_OK(sim, mps_plate_add(sim, "plate", foot, edge, NULL));
    fill_depth(sim, 0.4, 0.4, 0);
    assert_int_equal(mps_particle_block_init(&block, sizeof block), MPS_OK);
    block.count = 2;
    block.position = lost;
    ASSERT_OK(sim, mps_particles_add(sim, &block, NULL));
    return sim;
}

static inline mps_sim *dam_3d(void)
{
    mps_sim *sim = new_sim(3, 0.1);
    add_tank(sim, 1, 0.6, 0.4);
    fill_depth(sim, 0.5, 0.4, 0.4);
    ASSERT_OK(sim, mps_threads_set(sim, 2));
    return sim;
}

/* Non-square cells, with another spacing than requested; a level between two rows. */
static inline mps_sim *stretched(void)
{
    const double lo[2] = {0, 0}, hi[2] = {0.59, 0.28}, from[2] = {0.2, 0}, to[2] = {0.26, 0.15};
    mps_sim *sim = new_sim(2, 0.05);
    add_tank(sim, 0.59, 0.63, 0);
    ASSERT_OK(sim, mps_baffle_add(sim, "baffle", from, to, NULL));
    ASSERT_OK(sim, mps_fill_level_add(sim, 0, lo, hi, NULL, NULL));
    shake(sim, 0.1);
    return sim;
}

typedef mps_sim *(*scene)(void);
static const scene scenes[] = {shaken, with_air, with_gas_law, plate, dam_3d, stretched};
enum { SCENES = sizeof scenes / sizeof scenes[0] };

/* Some steps; on the way something that users do between steps. */
static inline void go(mps_sim *sim, int64_t steps)
{
    int64_t done;
    for (int64_t k = 0; k < steps; k++) {
        mps_lease mark = {.struct_size = sizeof mark};
        ASSERT_OK(sim, mps_sim_time(sim, NULL, &done));
        if (done == 20 && mps_lease_begin(sim, "mark", MPS_WRITE, &mark) == MPS_OK) {
            for (int64_t i = 0; i < mark.count * mark.stride; i++) mark.data[i] = (double)i;
            ASSERT_OK(sim, mps_lease_end(sim, &mark));
        }
        ASSERT_OK(sim, mps_step(sim, 0.01, NULL));
    }
}

/* ---- comparison ---- */

static inline void same_field(mps_sim *a, mps_sim *b, const char *name)
{
    mps_lease x = {.struct_size = sizeof x}, y = {.struct_size = sizeof y};
    if (mps_lease_begin(a, name, MPS_READ, &x) != MPS_OK) return; /* not in this scene */
    ASSERT_OK(b, mps_lease_begin(b, name, MPS_READ, &y));
    assert_int_equal(x.count, y.count);
    assert_memory_equal(x.data, y.data, (size_t)(x.count * x.stride) * sizeof *x.data);
    ASSERT_OK(a, mps_lease_end(a, &x));
    ASSERT_OK(b, mps_lease_end(b, &y));
}

static inline void same_tags(mps_sim *a, mps_sim *b)
{
    const int64_t *ids[2], n = mps_particles_count(a, -1);
    const int32_t *tag[2][3];
    ASSERT_OK(a, tags_peek(a, &ids[0], &tag[0][0], &tag[0][1], &tag[0][2]));
    ASSERT_OK(b, tags_peek(b, &ids[1], &tag[1][0], &tag[1][1], &tag[1][2]));
    assert_memory_equal(ids[0], ids[1], (size_t)n * sizeof(int64_t));
    for (int k = 0; k < 3; k++)
        assert_memory_equal(tag[0][k], tag[1][k], (size_t)n * sizeof(int32_t));
}

static inline void same_budgets(mps_sim *a, mps_sim *b)
{
    mps_energy e[2];
    mps_momentum m[2];
    double t[2];
    int64_t steps[2];
    for (int k = 0; k < 2; k++) {
        mps_sim *sim = k ? b : a;
        memset(&e[k], 0, sizeof e[k]);
        memset(&m[k], 0, sizeof m[k]);
        assert_int_equal(mps_energy_init(&e[k], sizeof e[k]), MPS_OK);
        assert_int_equal(mps_momentum_init(&m[k], sizeof m[k]), MPS_OK);
        ASSERT_OK(sim, mps_energy_get(sim, &e[k]));
        ASSERT_OK(sim, mps_momentum_get(sim, &m[k]));
        ASSERT_OK(sim, mps_sim_time(sim, &t[k], &steps[k]));
    }
    /* without struct_size and the padding after it */
    assert_memory_equal(&e[0].kinetic, &e[1].kinetic, sizeof e[0] - offsetof(mps_energy, kinetic));
    assert_memory_equal(&m[0].total, &m[1].total, sizeof m[0] - offsetof(mps_momentum, total));
    assert_memory_equal(&t[0], &t[1], sizeof t[0]);
    assert_int_equal(steps[0], steps[1]);
}

static inline void same_probe(mps_sim *a, mps_sim *b, int32_t id)
{
    const int32_t size = mps_probe_size(a, id);
    const double *t[2], *samples[2];
    double value[2][6] = {{0}};
    int64_t count[2];
    ASSERT_OK(a, mps_probe_read(a, id, value[0]));
    ASSERT_OK(b, mps_probe_read(b, id, value[1]));
    assert_memory_equal(value[0], value[1], sizeof value[0]);
    if (mps_probe_series(a, id, &count[0], &t[0], &samples[0]) != MPS_OK) return;
    ASSERT_OK(b, mps_probe_series(b, id, &count[1], &t[1], &samples[1]));
    assert_true(count[0] == count[1]);
    assert_memory_equal(t[0], t[1], (size_t)count[0] * sizeof(double));
    assert_memory_equal(samples[0], samples[1], (size_t)(count[0] * size) * sizeof(double));
}

static inline void same_probes(mps_sim *a, mps_sim *b)
{
    for (int32_t id = 0; id < 3 && mps_probe_size(a, id) > 0; id++) same_probe(a, b, id);
}

static inline void same(mps_sim *a, mps_sim *b)
{
    static const char *const fields[] = {"position",       "velocity", "pressure",
                                         "number_density", "density",  "mark"};
    assert_int_equal(mps_particles_count(a, -1), mps_particles_count(b, -1));
    same_tags(a, b);
    for (size_t k = 0; k < sizeof fields / sizeof fields[0]; k++) same_field(a, b, fields[k]);
    same_budgets(a, b);
    same_probes(a, b);
}

#endif

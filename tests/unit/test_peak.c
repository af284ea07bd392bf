/* SPDX-License-Identifier: BSD-3-Clause */
/* Peak memory: stencils, probes, frames and checkpoints need no memory proportional to the number
 * of particles beyond that of the steps. Counted by the allocator of the handle. */
#include "tank_fixture.h"
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

enum { BEFORE = 32, STEPS = 6 };

/* Bytes out, and the most since the start of the counting. */
typedef struct memory {
    size_t held, peak;
} memory;

static void *take(void *user, size_t size)
{
    memory *m = user;
    char *block = malloc(size + BEFORE); /* the size is stored before the block */
    if (!block) return NULL;
    *(size_t *)(void *)block = size;
    m->held += size;
    if (m->held > m->peak) m->peak = m->held;
    return block + BEFORE;
}

static void release(void *user, void *block)
{
    memory *m = user;
    char *start = (char *)block - BEFORE;
    m->held -= *(size_t *)(void *)start;
    free(start);
}

/* A column of water in the corner of a tank. */
static mps_sim *column(int32_t dim, double dp, memory *m)
{
    mps_config config;
    mps_sim *sim = NULL;
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dim = dim;
    config.dp = dp;
    config.allocator = (mps_allocator){take, release, m};
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    add_tank(sim, 1.6, 0.6, 0.2);
    fill_depth(sim, 0.6, 0.3, 0.2);
    return sim;
}

static void add_probes(mps_sim *sim)
{
    static const double place[][2] = {{1.6, 0.01}, {0.3, 0}};
    static const int32_t type[] = {MPS_PROBE_WALL_PRESSURE, MPS_PROBE_GAUGE};
    for (int k = 0; k < 2; k++) {
        mps_probe probe;
        int32_t id;
        assert_int_equal(mps_probe_init(&probe, sizeof probe), MPS_OK);
        probe.type = type[k];
        probe.at[0] = place[k][0];
        probe.at[1] = place[k][1];
        probe.at[2] = 0.1;
        ASSERT_OK(sim, mps_probe_add(sim, &probe, &id));
    }
}

static void measure(mps_sim *sim)
{
    mps_energy energy;
    double value;
    assert_int_equal(mps_energy_init(&energy, sizeof energy), MPS_OK);
    ASSERT_OK(sim, mps_energy_get(sim, &energy));
    for (int k = 0; k < 2; k++) ASSERT_OK(sim, mps_probe_read(sim, k, &value));
}

/* What a driver does: neighbours before the first step, rows, frames and checkpoints. */
static double bytes_of_run(int32_t dim, double dp, bool outputs, const char *folder)
{
    char path[80];
    memory m = {0, 0};
    mps_frames *frames = NULL;
    mps_stencil stencil = {.struct_size = sizeof stencil};
    mps_sim *sim = column(dim, dp, &m);
    const double n = (double)mps_particles_count(sim, -1);
    m.peak = m.held;
    if (outputs) {
        add_probes(sim);
        ASSERT_OK(sim, mps_stencil_get(sim, MPS_NEAR, &stencil));
        ASSERT_OK(sim, mps_frames_open(sim, folder, "f", 0, &frames));
    }
    snprintf(path, sizeof path, "%s/checkpoint", folder);
    for (int k = 0; k < STEPS; k++) {
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        if (!outputs) continue;
        measure(sim);
        ASSERT_OK(sim, mps_frames_write(frames));
        ASSERT_OK(sim, mps_checkpoint_write(sim, path));
    }
    mps_frames_close(frames);
    mps_sim_destroy(sim);
    assert_int_equal(m.held, 0);
    return (double)m.peak / n;
}

static void outputs_take_none(void **state)
{
#ifndef MPS_CHECKED
    const double most[] = {900, 850}; /* bytes a particle */
#endif
    for (int32_t dim = 2; dim <= 3; dim++) {
        const double dp = dim == 2 ? 0.005 : 0.02, steps = bytes_of_run(dim, dp, false, *state),
                     all = bytes_of_run(dim, dp, true, *state);
        print_message("%d-D: %.0f bytes a particle, with outputs %.0f\n", dim, steps, all);
        assert_true(all <= steps + 40); /* a gauge collects the particles near its line */
#ifndef MPS_CHECKED /* whose guard keeps copies, and whose passes do not share memory */
        assert_true(all <= most[dim - 2]);
#endif
    }
}

/* A stencil requested after each step is not kept for the next one. */
static void stencils_of_each_step(void **state)
{
    (void)state;
    memory m = {0, 0};
    mps_stencil stencil = {.struct_size = sizeof stencil};
    mps_sim *sim = column(2, 0.01, &m);
    for (int k = 0; k < STEPS; k++) ASSERT_OK(sim, mps_step(sim, 1, NULL));
    const size_t held = m.held;
    for (int k = 0; k < STEPS; k++) {
        ASSERT_OK(sim, mps_stencil_get(sim, MPS_FAR, &stencil));
        assert_true(m.held > held);
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        assert_true(m.held < held + held / 50);
    }
    mps_sim_destroy(sim);
}

int main(void)
{
    char folder[] = "mps_peak_XXXXXX", command[64];
    if (!mkdtemp(folder)) return 1;
    const struct CMUnitTest tests[] = {cmocka_unit_test_prestate(outputs_take_none, folder),
                                       cmocka_unit_test(stencils_of_each_step)};
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command) != 0 || failed;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Snapshots: steps after a restore are bitwise those of a run without other steps. */
#define _POSIX_C_SOURCE 200809L
#include "checkpoint_fixture.h"

static mps_snapshot *taken(mps_sim *sim)
{
    mps_snapshot *k = NULL;
    ASSERT_OK(sim, mps_snapshot_create(sim, &k));
    ASSERT_OK(sim, mps_snapshot_take(k));
    return k;
}

/* ---- the same bytes ---- */

/* From the start and later, restored over one step and over several searches, repeatedly. */
static void goes_back(void **state)
{
    static const int64_t at[] = {0, 1, 6, 22}, away[] = {1, 8, 1, 3};
    (void)state;
    for (int s = 0; s < SCENES; s++) {
        mps_sim *through = scenes[s](), *sim = scenes[s]();
        mps_snapshot *k = NULL;
        int64_t done = 0;
        go(through, STEPS);
        ASSERT_OK(sim, mps_snapshot_create(sim, &k));
        for (int c = 0; c < 4; done = at[c++]) {
            go(sim, at[c] - done);
            ASSERT_OK(sim, mps_snapshot_take(k));
            for (int again = 0; again < 3; again++) {
                go(sim, away[(c + again) % 4]);
                ASSERT_OK(sim, mps_snapshot_restore(k));
            }
        }
        go(sim, STEPS - done);
        same(through, sim);
        mps_snapshot_destroy(k);
        mps_sim_destroy(sim);
        mps_sim_destroy(through);
    }
}

/* A thousand trials of any length without a permanent effect. */
static void thousand_times(void **state)
{
    enum { TIMES = 1000 };
    mps_sim *through = shaken(), *sim = shaken();
    mps_snapshot *k = taken(sim);
    uint32_t random = 7;
    int64_t done = 0;
    (void)state;
    for (int c = 0; c < TIMES; c++) {
        random = random * 1664525u + 1013904223u;
        const int64_t trial = 1 + (random >> 24) % 3;
        go(sim, trial);
        if ((random >> 16) % 8 == 0) {
            done += trial;
            ASSERT_OK(sim, mps_snapshot_take(k));
        } else
            ASSERT_OK(sim, mps_snapshot_restore(k));
    }
    ASSERT_OK(sim, mps_snapshot_restore(k));
    go(through, done);
    same(through, sim);
    go(through, 5);
    go(sim, 5);
    same(through, sim);
    mps_snapshot_destroy(k);
    mps_sim_destroy(sim);
    mps_sim_destroy(through);
}

static void remove_some(mps_sim *sim, int64_t every)
{
    const int64_t *ids, n = mps_particles_count(sim, -1);
    const int32_t *kinds;
    int64_t *gone = malloc((size_t)n * sizeof *gone), count = 0;
    assert_non_null(gone);
    ASSERT_OK(sim, tags_peek(sim, &ids, &kinds, NULL, NULL));
    for (int64_t i = 0; i < n; i++)
        if (kinds[i] == MPS_FLUID && ids[i] % every == 0) gone[count++] = ids[i];
    ASSERT_OK(sim, mps_particles_remove(sim, count, gone));
    free(gone);
}

static void add_drop(mps_sim *sim)
{
    const double x[4] = {0.3, 0.5, 0.35, 0.5};
    mps_particle_block block;
    assert_int_equal(mps_particle_block_init(&block, sizeof block), MPS_OK);
    block.count = 2;
    block.position = x;
    ASSERT_OK(sim, mps_particles_add(sim, &block, NULL));
}

/* Particles added or removed since are removed and restored; ids too. */
static void other_particles(void **state)
{
    (void)state;
    for (int s = 0; s < SCENES; s++) {
        if (scenes[s] == dam_3d || scenes[s] == plate) continue;
        mps_sim *through = scenes[s](), *sim = scenes[s]();
        go(through, 7);
        go(sim, 7);
        mps_snapshot *k = taken(sim);
        add_drop(sim);
        go(sim, 2);
        ASSERT_OK(sim, mps_snapshot_restore(k));
        remove_some(sim, 3);
        go(sim, 2);
        ASSERT_OK(sim, mps_snapshot_restore(k));
        remove_some(sim, 5);
        add_drop(sim);
        remove_some(through, 5);
        add_drop(through);
        go(through, 10);
        go(sim, 10);
        same(through, sim);
        mps_snapshot_destroy(k);
        mps_sim_destroy(sim);
        mps_sim_destroy(through);
    }
}

/* Two snapshots of two ways: neither has samples of the other one. */
static void two_ways(void **state)
{
    mps_sim *slow = shaken(), *fast = shaken(), *sim = shaken();
    (void)state;
    go(sim, 4);
    mps_snapshot *start = taken(sim), *end[2];
    for (int way = 0; way < 2; way++) {
        ASSERT_OK(sim, mps_snapshot_restore(start));
        if (way) remove_some(sim, 4);
        go(sim, 8);
        end[way] = taken(sim);
        mps_sim *alone = way ? fast : slow;
        go(alone, 4);
        if (way) remove_some(alone, 4);
        go(alone, 8);
    }
    for (int k = 0; k < 4; k++) {
        ASSERT_OK(sim, mps_snapshot_restore(end[k % 2]));
        same(k % 2 ? fast : slow, sim);
    }
    ASSERT_OK(sim, mps_snapshot_restore(end[0]));
    ASSERT_OK(sim, mps_probe_series_clear(sim, 0));
    go(sim, 6);
    ASSERT_OK(sim, mps_snapshot_restore(end[0]));
    go(sim, 6);
    go(slow, 6);
    same(slow, sim);
    for (int way = 0; way < 2; way++) mps_snapshot_destroy(end[way]);
    mps_snapshot_destroy(start);
    mps_sim_destroy(slow);
    mps_sim_destroy(fast);
    mps_sim_destroy(sim);
}

/* A probe that was added later measures from the time of the snapshot. */
static void later_probe(void **state)
{
    mps_sim *through = shaken(), *sim = shaken();
    mps_probe probe;
    int32_t id;
    (void)state;
    go(through, 5);
    go(sim, 5);
    mps_snapshot *k = taken(sim);
    assert_int_equal(mps_probe_init(&probe, sizeof probe), MPS_OK);
    probe.type = MPS_PROBE_FORCE;
    probe.average = 0.02;
    probe.rate = 200;
    ASSERT_OK(through, mps_probe_add(through, &probe, &id));
    ASSERT_OK(sim, mps_probe_add(sim, &probe, &id));
    go(sim, 9);
    ASSERT_OK(sim, mps_snapshot_restore(k));
    ASSERT_OK(sim, mps_probe_remove(sim, 0));
    ASSERT_OK(sim, mps_snapshot_restore(k));
    go(through, 9);
    go(sim, 9);
    same_probe(through, sim, id);
    mps_snapshot_destroy(k);
    mps_sim_destroy(sim);
    mps_sim_destroy(through);
}

static mps_step_info info_of(mps_sim *sim)
{
    mps_step_info info;
    assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
    ASSERT_OK(sim, mps_step_info_get(sim, &info));
    return info;
}

/* A kick of many g, which counts as a jump of the tank, is not remembered. */
static void jump_is_forgotten(void **state)
{
    mps_sim *through = shaken(), *sim = shaken();
    mps_motion_state pose;
    double t;
    (void)state;
    go(through, 6);
    go(sim, 6);
    const mps_step_info before = info_of(sim);
    mps_snapshot *k = taken(sim);
    for (int way = 0; way < 2; way++) {
        assert_int_equal(mps_motion_state_init(&pose, sizeof pose), MPS_OK);
        ASSERT_OK(sim, mps_motion_state_get(sim, &pose));
        ASSERT_OK(sim, mps_sim_time(sim, &t, NULL));
        pose.value[MPS_MOVE_X] += way ? 5e-3 : -5e-3;
        ASSERT_OK(sim, mps_motion_pose_set(sim, t + 2e-3, &pose));
        ASSERT_OK(sim, mps_run(sim, t + 2e-3, NULL, NULL));
        ASSERT_OK(sim, mps_snapshot_restore(k));
    }
    const mps_step_info after = info_of(sim);
    assert_int_equal(before.step, after.step);
    assert_true(before.dt == after.dt && before.t == after.t);
    shake(sim, 0.1);
    go(through, 8);
    go(sim, 8);
    same(through, sim);
    mps_snapshot_destroy(k);
    mps_sim_destroy(sim);
    mps_sim_destroy(through);
}

/* ---- refusals ---- */

static void refused(void **state)
{
    mps_sim *sim = shaken();
    mps_snapshot *k = NULL, *later;
    mps_lease lease = {.struct_size = sizeof lease};
    const double lo[2] = {0.2, 0.4}, hi[2] = {0.3, 0.5};
    (void)state;
    assert_int_equal(mps_snapshot_create(NULL, &k), MPS_E_ARG);
    ASSERT_REFUSED(sim, mps_snapshot_create(sim, NULL), MPS_E_ARG, "snapshot");
    assert_int_equal(mps_snapshot_take(NULL), MPS_E_ARG);
    assert_int_equal(mps_snapshot_restore(NULL), MPS_E_ARG);
    mps_snapshot_destroy(NULL);
    ASSERT_OK(sim, mps_snapshot_create(sim, &k));
    ASSERT_REFUSED(sim, mps_snapshot_restore(k), MPS_E_STATE, "mps_snapshot_take");
    ASSERT_OK(sim, mps_snapshot_take(k));
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_READ, &lease));
    ASSERT_OK(sim, mps_snapshot_take(k));
    ASSERT_REFUSED(sim, mps_snapshot_restore(k), MPS_E_BUSY, "lease");
    ASSERT_OK(sim, mps_lease_end(sim, &lease));
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &lease));
    ASSERT_REFUSED(sim, mps_snapshot_take(k), MPS_E_BUSY, "velocity");
    ASSERT_OK(sim, mps_lease_end(sim, &lease));
    ASSERT_OK(sim, mps_snapshot_restore(k));
    ASSERT_OK(sim, mps_baffle_add(sim, "baffle", lo, hi, NULL));
    ASSERT_REFUSED(sim, mps_snapshot_restore(k), MPS_E_STATE, "geometry");
    later = taken(sim);
    ASSERT_OK(sim, mps_field_add(sim, "late", 1));
    ASSERT_REFUSED(sim, mps_snapshot_restore(later), MPS_E_STATE, "fields");
    ASSERT_OK(sim, mps_snapshot_take(later));
    ASSERT_OK(sim, mps_model_remove(sim, "shift"));
    ASSERT_REFUSED(sim, mps_snapshot_restore(later), MPS_E_STATE, "models");
    ASSERT_OK(sim, mps_step(sim, 0.01, NULL));
    mps_snapshot_destroy(later);
    mps_snapshot_destroy(k);
    mps_sim_destroy(sim);
}

/* Settings and motions are not restored: the current ones continue from the state of the
 * snapshot. */
static void settings_are_free(void **state)
{
    mps_sim *through = shaken(), *sim = shaken();
    (void)state;
    go(through, 5);
    go(sim, 5);
    mps_snapshot *k = taken(sim);
    go(sim, 3);
    for (int both = 0; both < 2; both++) {
        mps_sim *a = both ? sim : through;
        if (both) ASSERT_OK(sim, mps_snapshot_restore(k));
        ASSERT_OK(a, mps_model_set(a, "source", "gain", 0.8));
        ASSERT_OK(a, mps_motion_clear(a));
        go(a, 6);
    }
    same(through, sim);
    mps_snapshot_destroy(k);
    mps_sim_destroy(sim);
    mps_sim_destroy(through);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(goes_back),       cmocka_unit_test(thousand_times),
        cmocka_unit_test(other_particles), cmocka_unit_test(two_ways),
        cmocka_unit_test(later_probe),     cmocka_unit_test(jump_is_forgotten),
        cmocka_unit_test(refused),         cmocka_unit_test(settings_are_free),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

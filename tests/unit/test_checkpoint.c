/* SPDX-License-Identifier: BSD-3-Clause */
/* Checkpoints: a resumed run is bitwise equal to an uninterrupted one. */
#define _POSIX_C_SOURCE 200809L
#include "checkpoint_fixture.h"

/* ---- scenes ---- */

/* A gate between two depths, and a sensor in the adjacent liquid. */
static mps_sim *gate(void)
{
    const double foot[2] = {0.4, 0}, edge[2] = {0, 0.4}, lo[2] = {0.4, 0}, hi[2] = {1, 0.2};
    mps_sim *sim = new_sim(2, 0.04);
    mps_probe probe;
    int32_t id;
    add_tank(sim, 1, 0.6, 0);
    ASSERT_OK(sim, mps_plate_add(sim, "gate", foot, edge, NULL));
    fill_depth(sim, 0.4, 0.36, 0);
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    assert_int_equal(mps_probe_init(&probe, sizeof probe), MPS_OK);
    probe.type = MPS_PROBE_FLUID_PRESSURE;
    probe.at[0] = 0.38;
    probe.at[1] = 0.1;
    probe.rate = 300;
    ASSERT_OK(sim, mps_probe_add(sim, &probe, &id));
    return sim;
}

static void take_out(mps_sim *sim, const char *name)
{
    const int64_t *ids, n = mps_particles_count(sim, -1);
    const int32_t *parts, part = mps_part_find(sim, name);
    int64_t *own = malloc((size_t)n * sizeof *own), count = 0;
    assert_non_null(own);
    ASSERT_OK(sim, tags_peek(sim, &ids, NULL, NULL, &parts));
    for (int64_t i = 0; i < n; i++)
        if (parts[i] == part) own[count++] = ids[i];
    ASSERT_OK(sim, mps_particles_remove(sim, count, own));
    free(own);
}

/* ---- resume ---- */

/* From the start, between two searches, after some, and twice over: what follows is what would have
 * been. Writing changes nothing. */
static void goes_on(void **state)
{
    static const int64_t at[] = {0, 1, 6, 22};
    enum { TIMES = sizeof at / sizeof at[0] };
    char path[TIMES][PATH], name[16], again[PATH];
    (void)state;
    for (int s = 0; s < SCENES; s++) {
        mps_sim *through = scenes[s](), *stopped = scenes[s]();
        int64_t done = 0;
        go(through, STEPS);
        for (int k = 0; k < TIMES; done = at[k++]) {
            go(stopped, at[k] - done);
            snprintf(name, sizeof name, "at%d", k);
            ASSERT_OK(stopped, mps_checkpoint_write(stopped, path_of(path[k], name)));
        }
        go(stopped, STEPS - done);
        same(through, stopped);
        mps_sim_destroy(stopped);
        for (int k = 0; k < TIMES; k++) {
            mps_sim *sim = scenes[s]();
            ASSERT_OK(sim, mps_checkpoint_read(sim, path[k]));
            ASSERT_OK(sim, mps_checkpoint_write(sim, path_of(again, "again")));
            go(sim, 3);
            ASSERT_OK(sim, mps_checkpoint_read(sim, again)); /* back */
            go(sim, STEPS - at[k]);
            same(through, sim);
            mps_sim_destroy(sim);
        }
        mps_sim_destroy(through);
    }
}

/* Particles added between a checkpoint and the next step, and particles lost in it. */
static void particles_come_and_go(void **state)
{
    char path[PATH];
    const double x[2] = {0.3, 0.5}, far[2] = {0.3, 99};
    mps_particle_block block;
    mps_sim *sim[2] = {shaken(), shaken()};
    int64_t id[2][2];
    (void)state;
    assert_int_equal(mps_particle_block_init(&block, sizeof block), MPS_OK);
    block.count = 1;
    go(sim[0], 20);
    ASSERT_OK(sim[0], mps_checkpoint_write(sim[0], path_of(path, "come")));
    ASSERT_OK(sim[1], mps_checkpoint_read(sim[1], path));
    for (int k = 0; k < 2; k++) {
        block.position = x;
        ASSERT_OK(sim[k], mps_particles_add(sim[k], &block, &id[k][0]));
        block.position = far;
        ASSERT_OK(sim[k], mps_particles_add(sim[k], &block, &id[k][1]));
        go(sim[k], 10);
        assert_int_equal(mps_particle_index(sim[k], id[k][1]), -1);
    }
    assert_true(id[0][0] == id[1][0] && id[0][1] == id[1][1]);
    same(sim[0], sim[1]);
    for (int k = 0; k < 2; k++) mps_sim_destroy(sim[k]);
}

/* A removed gate occludes nothing from a probe, also before the next neighbour search. */
static void without_a_gate(void **state)
{
    char path[PATH];
    mps_sim *a = gate(), *b = gate();
    (void)state;
    go(a, 5);
    take_out(a, "gate");
    go(a, 15);
    ASSERT_OK(a, mps_checkpoint_write(a, path_of(path, "gate")));
    ASSERT_REFUSED(b, mps_checkpoint_read(b, path), MPS_E_ARG, "solid particles");
    take_out(b, "gate");
    ASSERT_OK(b, mps_checkpoint_read(b, path));
    same_probe(a, b, 0);
    go(a, 5);
    go(b, 5);
    same(a, b);
    mps_sim_destroy(a);
    mps_sim_destroy(b);
}

/* The liquid moved with the tank initially, and the tank then stopped; a first step so short that
 * the next ones grow; a lost droplet, and two that collided. */
static void came_to_rest(void **state)
{
    const double centre[2] = {0.3, 0.1}, drops[6] = {0.3, 99, 0.3, 0.5, 0.32, 0.5},
                 speeds[6] = {0, 0, 1, 0, -1, 0};
    char path[PATH];
    mps_particle_block block;
    mps_step_info info[2];
    mps_sim *sim[2] = {shaken(), shaken()};
    (void)state;
    assert_int_equal(mps_particle_block_init(&block, sizeof block), MPS_OK);
    block.count = 3;
    block.position = drops;
    block.velocity = speeds;
    for (int k = 0; k < 2; k++)
        ASSERT_OK(sim[k], mps_motion_centre_set(sim[k], centre, MPS_START_WITH_TANK));
    ASSERT_OK(sim[0], mps_step(sim[0], 1e-5, NULL));
    for (int part = 0; part < 2; part++) {
        ASSERT_OK(sim[0], mps_checkpoint_write(sim[0], path_of(path, "rest")));
        ASSERT_OK(sim[1], mps_checkpoint_read(sim[1], path));
        for (int k = 0; k < 2; k++) {
            go(sim[k], 6);
            same(sim[0], sim[k]);
        }
        if (part == 0) {
            ASSERT_OK(sim[0], mps_motion_clear(sim[0]));
            ASSERT_OK(sim[0], mps_particles_add(sim[0], &block, NULL));
            go(sim[0], 1);
            mps_sim_destroy(sim[1]);
            sim[1] = shaken();
            ASSERT_OK(sim[1], mps_motion_centre_set(sim[1], centre, MPS_START_WITH_TANK));
            ASSERT_OK(sim[1], mps_motion_clear(sim[1]));
        }
    }
    for (int k = 0; k < 2; k++) {
        assert_int_equal(mps_step_info_init(&info[k], sizeof info[k]), MPS_OK);
        ASSERT_OK(sim[k], mps_step(sim[k], 0.01, &info[k]));
        assert_int_equal(info[k].lost, 1);
        mps_sim_destroy(sim[k]);
    }
}

static int write_on_the_way(void *user, mps_sim *sim, const mps_step_info *info)
{
    ASSERT_OK(sim, mps_checkpoint_write(sim, user));
    ASSERT_REFUSED(sim, mps_checkpoint_read(sim, user), MPS_E_BUSY, "monitor");
    return info->step == 10;
}

static void from_a_monitor(void **state)
{
    char path[PATH];
    mps_sim *a = with_air(), *b = with_air();
    (void)state;
    path_of(path, "monitor");
    ASSERT_STATUS(a, mps_run(a, 1, write_on_the_way, path), MPS_W_STOPPED);
    ASSERT_OK(b, mps_checkpoint_read(b, path));
    same(a, b);
    ASSERT_OK(a, mps_run(a, 0.2, NULL, NULL));
    ASSERT_OK(b, mps_run(b, 0.2, NULL, NULL));
    same(a, b);
    mps_sim_destroy(a);
    mps_sim_destroy(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(goes_on),        cmocka_unit_test(particles_come_and_go),
        cmocka_unit_test(without_a_gate), cmocka_unit_test(came_to_rest),
        cmocka_unit_test(from_a_monitor),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* body.free: droplets fall with g, unaffected by a tank that they do not touch; liquid in contact
 * with a wall is as without the model. */
#include "phase_fixture.h"

/* A disordered droplet of n rows, far from the walls of a tank of 80 x 80 (x 30) spacings. */
static mps_sim *drop(int dim, int n, const char *left_out)
{
    const double dp = CLOUD_DP;
    cloud c = dim == 2 ? cloud_lattice(2, n, n, 1, 0.2, 5) : cloud_lattice(3, n, n, n, 0.2, 5);
    mps_sim *sim = new_sim(dim, dp);
    mps_particle_block b;
    for (int64_t k = 0; k < c.n * dim; k++) c.x[k] += (dim == 2 ? 40 : 12) * dp;
    add_tank(sim, 80 * dp, 80 * dp, 30 * dp);
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = c.n;
    b.position = c.x;
    ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
    if (left_out) ASSERT_OK(sim, mps_model_remove(sim, left_out));
    cloud_free(&c);
    return sim;
}

/* Mean velocity of the fluid along an axis. */
static double mean_velocity(mps_sim *sim, int axis)
{
    mps_energy e;
    assert_int_equal(mps_energy_init(&e, sizeof e), MPS_OK);
    ASSERT_OK(sim, mps_energy_get(sim, &e));
    return e.momentum[axis] / e.mass;
}

static double fall(int dim, int n, const char *left_out)
{
    const double t = 0.05;
    mps_sim *sim = drop(dim, n, left_out);
    ASSERT_OK(sim, mps_run(sim, t, NULL, NULL));
    const double share = mean_velocity(sim, 1) / (-9.81 * t);
    mps_sim_destroy(sim);
    return share;
}

static void falls_with_g(void **state)
{
    (void)state;
    static const int rows[2][3] = {{2, 5, 12}, {2, 3, 6}};
    for (int dim = 2; dim <= 3; dim++)
        for (int k = 0; k < 3; k++) {
            const double with = fall(dim, rows[dim - 2][k], NULL),
                         without = fall(dim, rows[dim - 2][k], "body");
            print_message("%d-D, %d rows: %.5f g, without body.free %.5f g\n", dim,
                          rows[dim - 2][k], with, without);
            ASSERT_NEAR(with, 1, 1e-3);
            assert_true(without < 0.994);
        }
}

/* The tank surges at 1 m/s at once, and then as a harmonic. */
static void is_left_behind(void **state)
{
    (void)state;
    const mps_harmonic h = {.dof = MPS_MOVE_X, .amplitude = 0.05, .omega = 20};
    for (int k = 0; k < 2; k++) {
        mps_sim *sim = drop(2, 4, k ? "body" : NULL);
        ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &h));
        ASSERT_OK(sim, mps_run(sim, 0.03, NULL, NULL));
        const double u = mean_velocity(sim, 0);
        print_message("%s body.free: %.3g m/s\n", k ? "without" : "with", u);
        assert_true(k ? fabs(u) > 0.01 : fabs(u) < 1e-4);
        mps_sim_destroy(sim);
    }
}

/* Too large, or in contact with walls, or both: all positions of a pool and of a film are bitwise
 * those without the model. */
static void pools_are_held(void **state)
{
    (void)state;
    for (int rows = 1; rows <= 9; rows += 4) {
        double *x[2] = {NULL};
        int64_t n = 0;
        for (int k = 0; k < 2; k++) {
            const double lo[3] = {0}, hi[3] = {0.4, rows * 0.02, 0};
            mps_sim *sim = new_sim(2, 0.02);
            add_tank(sim, 0.4, 0.4, 0);
            ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
            if (k) ASSERT_OK(sim, mps_model_remove(sim, "body"));
            ASSERT_OK(sim, mps_run(sim, 0.05, NULL, NULL));
            n = mps_particles_count(sim, -1);
            x[k] = field_by_id(sim, "position");
            mps_sim_destroy(sim);
        }
        assert_memory_equal(x[0], x[1], (size_t)n * 2 * sizeof(double));
        free(x[0]);
        free(x[1]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(falls_with_g),
                                       cmocka_unit_test(is_left_behind),
                                       cmocka_unit_test(pools_are_held)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

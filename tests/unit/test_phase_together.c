/* SPDX-License-Identifier: BSD-3-Clause */
/* The models of several phases in one step: water below gas in a closed tank, with any number of
 * threads. */
#include "phase_fixture.h"

static const char *const models[] = {"wall.extrapolate", "density.smooth", "viscosity.pair",
                                     "tension.csf",      "source.mixed",   "gas.compressible",
                                     "gradient.density", "collision.pair"};

/* Half of the tank is water. */
static mps_sim *closed_tank(int dim, int threads)
{
    const double dp = 0.05, lo[3] = {0}, middle[3] = {0.4, 0.2, 0.3}, low[3] = {0, 0.2, 0},
                 hi[3] = {0.4, 0.4, 0.3};
    mps_sim *sim = new_sim(dim, dp);
    while (mps_model_name(sim, 0)) ASSERT_OK(sim, mps_model_remove(sim, mps_model_name(sim, 0)));
    set_phase(sim, 0, 1000, 1e-3);
    set_phase(sim, 1, 1, 1.8e-5);
    add_tank(sim, 0.4, 0.4, 0.3);
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, middle, NULL, NULL));
    ASSERT_OK(sim, mps_fill_box_add(sim, 1, low, hi, NULL, NULL));
    for (size_t m = 0; m < sizeof models / sizeof models[0]; m++)
        ASSERT_OK(sim, mps_model_use(sim, models[m]));
    ASSERT_OK(sim, mps_model_set(sim, "collision", "distance", 0.8));
    ASSERT_OK(sim, mps_threads_set(sim, threads));
    return sim;
}

/* Mean pressure of the bottom row less that of the upper gas. */
static double head(mps_sim *sim, int dim, double *depth)
{
    const int32_t *kinds, *phases;
    double sum[2] = {0}, count[2] = {0}, y[2] = {0};
    mps_lease p = {.struct_size = sizeof p}, x = {.struct_size = sizeof x};
    ASSERT_OK(sim, tags_peek(sim, NULL, &kinds, &phases, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, "pressure", MPS_READ, &p));
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
    for (int64_t i = 0; i < p.count; i++) {
        const double height = x.data[i * dim + 1];
        if (kinds[i] != MPS_FLUID || (height > 0.075 && height < 0.3)) continue;
        const int gas = phases[i];
        sum[gas] += p.data[i];
        y[gas] += height;
        count[gas]++;
    }
    *depth = 0.2 - y[0] / count[0];
    ASSERT_OK(sim, mps_lease_end(sim, &p));
    ASSERT_OK(sim, mps_lease_end(sim, &x));
    return sum[0] / count[0] - sum[1] / count[1];
}

static void closed(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        double *first = NULL;
        for (int threads = 1; threads <= 3; threads += 2) {
            mps_step_info info;
            double depth;
            mps_sim *sim = closed_tank(dim, threads);
            assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
            if (dim == 3) ASSERT_OK(sim, mps_model_set(sim, "tension", "radius", 4.1));
            for (int step = 0; step < 12; step++) ASSERT_OK(sim, mps_step(sim, 1, &info));
            const double pressure = head(sim, dim, &depth);
            print_message("%d-D: head %.3f rho g h, largest speed %.3g m/s\n", dim,
                          pressure / (9810 * depth), info.max_speed);
            ASSERT_NEAR(pressure / (9810 * depth), 1,
                        0.3); /* the papers' walls and interface are that rough at 4 rows */
            assert_true(info.max_speed < 0.5 && info.lost == 0 && info.surface == 0);
            double *u = field_by_id(sim, "velocity");
            const size_t bytes = (size_t)mps_particles_count(sim, -1) * (size_t)dim * sizeof *u;
            if (first) assert_memory_equal(u, first, bytes);
            free(first);
            first = u;
            mps_sim_destroy(sim);
        }
        free(first);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(closed)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

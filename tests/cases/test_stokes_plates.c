/* SPDX-License-Identifier: BSD-3-Clause */
/* Layers thinner than the spacing at plates that start or swing; 3-D with layers of 4 dp:
 * test_stokes_plates_long.c. */
#include "stokes_plates.h"

/* Stokes' second problem, one and a half periods from rest: within 1 %. */
static void swinging(void **state)
{
    (void)state;
    static const double layer[] = {0.1, 0.2, 0.5, 1, 2, 4};
    for (int dim = 2; dim <= 3; dim++)
        for (int k = 0; k < 6; k++) {
            const double d = layer[k] * DP, rate = 2 * NU / (d * d), period = 2 * PI / rate;
            if (dim == 3 && k == 5) continue; /* takes half a minute */
            plates p = {.dim = dim, .gap = 48, .length = 24, .rate = rate, .t_end = 1.5 * period};
            if (dim == 3) { /* no larger than the layers ask for */
                p.gap = 24;
                p.length = d < 0.8 ? 8 : 16;
            }
            const double dt = fmin(period / 200, d < 3 ? 0.03 : 0.1),
                         with = run(&p, dt, 0.1 * period, true);
            print_message("    %d-D, layer %.1f dp: %.2f %%\n", dim, layer[k], 100 * with);
            assert_true(with < 0.01);
        }
}

/* Stokes' first problem, until the layer sqrt(4 nu t) is 4 dp thick, from 0.1 dp on: within 1 % at
 * all times. */
static void starting(void **state)
{
    (void)state;
    static const double until[] = {0.2, 1, 2, 4};
    for (int dim = 2; dim <= 3; dim++)
        for (int k = 0; k < 4; k++) {
            plates p = {.dim = dim, .gap = dim == 2 ? 48 : 24, .length = dim == 2 ? 24 : 16};
            p.t_end = until[k] * until[k] * DP * DP / (4 * NU);
            const double with = run(&p, p.t_end / 100, p.t_end / 20, true);
            print_message("    %d-D, started, layer up to %.1f dp: %.2f %%\n", dim, until[k],
                          100 * with);
            assert_true(with < 0.01);
        }
}

/* Without the model most of the drag of a thin layer is missing. */
static void without(void **state)
{
    (void)state;
    plates p = {.dim = 2, .gap = 48, .length = 24, .rate = 200, .t_end = 0.03};
    assert_true(run(&p, 1.5e-4, 3e-3, false) > 0.8);
}

/* A far radius without a fit is refused. */
static void other_radius(void **state)
{
    (void)state;
    mps_config config;
    mps_tank tank;
    mps_sim *sim = NULL;
    const double lo[3] = {0}, hi[3] = {10, 5, 0};
    OK(sim, mps_config_init(&config, sizeof config));
    config.dp = DP;
    config.re_far = 2.5;
    OK(sim, mps_sim_create(&config, &sim));
    OK(sim, mps_tank_init(&tank, sizeof tank));
    tank.size[0] = tank.size[1] = 10;
    OK(sim, mps_tank_add(sim, &tank, NULL));
    OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    OK(sim, mps_model_use(sim, "layer.history"));
    assert_int_equal(mps_step(sim, 1e-3, NULL), MPS_E_PLUGIN);
    assert_non_null(strstr(mps_sim_error(sim), "this one is 2.5 dp"));
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(swinging), cmocka_unit_test(starting),
                                       cmocka_unit_test(without), cmocka_unit_test(other_radius)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

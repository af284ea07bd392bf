/* SPDX-License-Identifier: BSD-3-Clause */
/* Plates that swing in 3-D with layers of 4 dp: a box wide enough that its ends do not reach the
 * middle. */
#include "stokes_plates.h"

/* Stokes' second problem, one and a half periods from rest: within 1 %. */
static void swinging_in_3d(void **state)
{
    (void)state;
    const double layer = 4 * DP, rate = 2 * NU / (layer * layer), period = 2 * PI / rate;
    plates p = {.dim = 3, .gap = 32, .length = 24, .rate = rate, .t_end = 1.5 * period};
    const double with = run(&p, 0.1, 0.1 * period, true);
    print_message("    3-D, layer 4 dp: %.2f %%\n", 100 * with);
    assert_true(with < 0.01);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(swinging_in_3d)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

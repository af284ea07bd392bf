/* SPDX-License-Identifier: BSD-3-Clause */
/* Components of the pressure equation: which of them determines level_free. */
#include "ppe_fixture.h"

/* Of two pools of the same size the one with the smallest id determines level_free, for any order
 * of rows. */
static void largest_of_equals(void **state)
{
    (void)state;
    for (int open = 0; open < 2; open++)
        for (int lowest = 0; lowest < 2; lowest++) {
            tank k;
            cloud c = cloud_lattice(2, 12, 6, 1, 0.2, 8);
            for (int64_t i = 0; i < c.n; i++)
                c.x[2 * i] += 10 * CLOUD_DP * (double)(i % 12 / 6); /* two pools, 6 wide */
            tank_init(&k, c);
            for (int64_t i = 0; i < c.n; i++) {
                k.id[i] = c.n - i;
                k.rhs[i] = (double)(i % 5);
            }
            k.id[40 + 6 * lowest] = 0; /* 40 % 12 / 6 is pool 0 */
            k.shift[50 + 6 * open] = 1e-6;
            assemble(&k);
            assert_int_equal(k.e.problem.components, 1);
            assert_int_equal(k.e.level_free, open != lowest);
            tank_free(&k);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(largest_of_equals)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

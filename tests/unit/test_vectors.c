/* SPDX-License-Identifier: BSD-3-Clause */
/* Products of short vectors, of any length. */
#include "base.h"
#include "rotation.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

/* 1 + 2 10 + 3 100 + ..: a missing number, or one of another vector, changes the sum. */
static void dot(void **state)
{
    static const double a[6] = {1, 2, 3, 4, 5, 6}, b[7] = {1, 10, 100, 1e3, 1e4, 1e5, -1e9},
                        sum[6] = {1, 21, 321, 4321, 54321, 654321};
    (void)state;
    for (int n = 1; n <= 6; n++) assert_true(mps__dot(a, b, n) == sum[n - 1]);
}

static void cross(void **state)
{
    const double a[3] = {1, 2, 3}, b[3] = {10, 100, 1000};
    double c[3];
    (void)state;
    mps__cross(a, b, c);
    assert_true(c[0] == 1700 && c[1] == -970 && c[2] == 80);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(dot), cmocka_unit_test(cross)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

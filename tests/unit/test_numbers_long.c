/* SPDX-License-Identifier: BSD-3-Clause */
/* Errors of the functions of mps/numbers.h at many more arguments than in test_numbers.c. */
#include "numbers_fixture.h"

enum { COUNT = 10000000 };

static void of_one(void **state)
{
    (void)state;
    for (int k = 0; k < ONE; k++) check_one(&functions_of_one[k], COUNT);
}

static void of_two(void **state)
{
    (void)state;
    check_pow(COUNT);
}

static void growth(void **state)
{
    (void)state;
    for (int k = 0; k < ONE; k++) check_growth(&functions_of_one[k], COUNT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(of_one), cmocka_unit_test(of_two),
                                       cmocka_unit_test(growth)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* mps/numbers.h: errors against the C library, values at zeros, infinities and NaN, symmetries, and
 * the bytes, which are the same with each compiler and option as long as no product is fused with a
 * sum. */
#include "numbers_fixture.h"

enum { COUNT = 1000000 };

static void errors_of_one(void **state)
{
    (void)state;
    for (int k = 0; k < ONE; k++) check_one(&functions_of_one[k], COUNT);
}

static void errors_of_pow(void **state)
{
    (void)state;
    check_pow(COUNT);
}

static void growth(void **state)
{
    (void)state;
    for (int k = 0; k < ONE; k++) check_growth(&functions_of_one[k], COUNT);
}

static const double edges[] = {0.0,
                               -0.0,
                               1,
                               -1,
                               INFINITY,
                               -INFINITY,
                               NAN,
                               2,
                               -2,
                               0.5,
                               -0.5,
                               3,
                               -3,
                               2.5,
                               -2.5,
                               1e300,
                               -1e300,
                               5e-324,
                               -5e-324,
                               DBL_MAX,
                               -DBL_MAX,
                               DBL_MIN,
                               1e-17,
                               -1e-17,
                               0x1p53,
                               0x1p53 - 1,
                               -(0x1p53 - 1),
                               1e19,
                               -1e19,
                               0x1p64,
                               1074,
                               -1074,
                               -1075,
                               1023,
                               1024,
                               -1022,
                               709.782712893384,
                               709.7827128933841,
                               -745.1332191019411,
                               -745.1332191019412,
                               0x1.fffffffffffffp-1,
                               0x1.0000000000001p0};
enum { EDGES = sizeof edges / sizeof edges[0] };

/* The same kind of number, the same sign of zeros, and within a unit in the last place. */
static void alike(const char *name, double x, double y, double own, double right)
{
    const int same = own == right ? !signbit(own) == !signbit(right)
                     : own != own || right != right
                         ? own != own && right != right
                         : isfinite(own) && isfinite(right) && nextafter(own, right) == right;
    if (!same) fail_msg("%s of %a, %a is %a, C has %a", name, x, y, own, right);
}

static void at_edges(void **state)
{
    (void)state;
    for (int k = 0; k < EDGES; k++) {
        const double x = edges[k];
        alike("exp", x, 0, mps_exp(x), exp(x));
        alike("expm1", x, 0, mps_expm1(x), expm1(x));
        alike("log", x, 0, mps_log(x), log(x));
        alike("sinh", x, 0, mps_sinh(x), (double)sinhl(x));
        alike("cosh", x, 0, mps_cosh(x), (double)coshl(x));
        for (int j = 0; j < EDGES; j++)
            alike("pow", x, edges[j], mps_pow(x, edges[j]), pow(x, edges[j]));
    }
}

static void exact_powers(void **state)
{
    (void)state;
    for (int k = 0; k < COUNT; k++) {
        const double x = random_double(), whole = (double)(int64_t)random_in(-2e4, 2e4);
        assert_true(mps_pow(x, 0) == 1 && mps_pow(1, x) == 1);
        assert_true(mps_pow(x, 1) == x);
        assert_true(mps_pow(x, 2) == x * x);
        assert_true(mps_pow(whole, 3) == whole * whole * whole);
        assert_true(mps_pow(4 * whole * whole, 0.5) == 2 * fabs(whole));
        assert_true(mps_pow(2, k % 2098 - 1074) == ldexp(1, k % 2098 - 1074));
        assert_true(mps_pow(-fabs(whole) - 1, k % 9) ==
                    (k % 9 % 2 ? -1 : 1) * mps_pow(fabs(whole) + 1, k % 9));
    }
}

static void symmetries_and_ranges(void **state)
{
    (void)state;
    for (int k = 0; k < COUNT; k++) {
        const double x = k % 2 ? random_double() : random_in(-3, 3), size = fabs(x);
        assert_true(mps_sinh(-x) == -mps_sinh(x) && mps_cosh(-x) == mps_cosh(x));
        assert_true(mps_sinh(size) >= size && mps_cosh(x) >= 1);
        assert_true(mps_exp(-size) <= 1 && mps_exp(size) >= 1);
        assert_true(mps_expm1(size) >= size && mps_expm1(-size) >= -size && mps_expm1(x) >= -1);
        assert_true((mps_log(size) < 0) == (size < 1));
    }
}

/* 1.0 and NaN: `a` unless b is larger, as a processor compares. */
static void larger_and_smaller(void **state)
{
    (void)state;
    assert_true(mps_larger(1, 2) == 2 && mps_larger(2, 1) == 2 && mps_larger(1, NAN) == 1);
    assert_true(mps_smaller(1, 2) == 1 && mps_smaller(2, 1) == 1 && mps_smaller(1, NAN) == 1);
    assert_true(isnan(mps_larger(NAN, 1)) && isnan(mps_smaller(NAN, 1)));
    assert_true(signbit(mps_larger(-0.0, 0.0)) && !signbit(mps_larger(0.0, -0.0)));
    assert_true(signbit(mps_smaller(-0.0, 0.0)) && !signbit(mps_smaller(0.0, -0.0)));
}

static void add(uint64_t *hash, double value)
{
    *hash = (*hash ^ mps_bits_of(value == value ? value : 0)) *
            UINT64_C(1099511628211); /* FNV-1a, a word at a time */
}

/* The bits of results at arguments that are always the same. A new one is right only if the
 * functions were changed on purpose. */
static void bytes(void **state)
{
    (void)state;
    uint64_t hash = UINT64_C(14695981039346656037);
    random_state = UINT64_C(88172645463325252);
    for (int k = 0; k < 100000; k++) {
        const double x = random_in(-750, 750), y = random_in(0, 50), any = random_double();
        add(&hash, mps_exp(x));
        add(&hash, mps_exp(0.01 * x));
        add(&hash, mps_expm1(0.03 * x));
        add(&hash, mps_log(any));
        add(&hash, mps_sinh(0.03 * x));
        add(&hash, mps_cosh(0.03 * x));
        add(&hash, mps_pow(y, 0.1 * x));
        add(&hash, mps_pow(any, 0.001 * x));
    }
    if (hash != UINT64_C(0xa0ea42f974404e31)) fail_msg("the hash is 0x%016" PRIx64, hash);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(errors_of_one),
                                       cmocka_unit_test(errors_of_pow),
                                       cmocka_unit_test(growth),
                                       cmocka_unit_test(at_edges),
                                       cmocka_unit_test(exact_powers),
                                       cmocka_unit_test(symmetries_and_ranges),
                                       cmocka_unit_test(larger_and_smaller),
                                       cmocka_unit_test(bytes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

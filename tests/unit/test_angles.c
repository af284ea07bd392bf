/* SPDX-License-Identifier: BSD-3-Clause */
/* Functions of angles against those of the C library in extended precision, at zeros, infinities
 * and NaN, and their bytes. */
#include "angles.h"
#include "numbers_fixture.h"

enum { COUNT = 500000 };

/* Next to multiples of pi/2 as well, where the digits of x cancel. */
static double some_angle(int64_t k)
{
    static const double sizes[] = {1e8, 1e6, 1e3, 4};
    const double x = random_in(-sizes[k % 4], sizes[k % 4]);
    return k % 16 < 4 ? (double)(1.5707963267948966192L * (int64_t)x) : x;
}

static void sine_and_cosine(void **state)
{
    (void)state;
    worst s = {0}, c = {0}, far = {0};
    for (int64_t k = 0; k < COUNT; k++) {
        const double x = some_angle(k), y = random_in(-0x1p50, 0x1p50);
        raise_worst(&s, sinl(x), ulps(mps__sin(x), sinl(x)), x, 0);
        raise_worst(&c, cosl(x), ulps(mps__cos(x), cosl(x)), x, 0);
        raise_worst(&far, sinl(y), ulps(mps__sin(y), sinl(y)), y, 0);
        assert_true(mps__sin(-x) == -mps__sin(x) && mps__cos(-x) == mps__cos(x));
        assert_true(fabs(mps__sin(x)) <= 1 && fabs(mps__cos(x)) <= 1);
    }
    check_worst("sin", &s, 0.95);
    check_worst("cos", &c, 0.95);
    check_worst("far", &far, 5);
}

static void directions(void **state)
{
    (void)state;
    worst t = {0}, s = {0};
    for (int64_t k = 0; k < COUNT; k++) {
        const double y = random_in(-2, 2), x = k % 3 ? random_in(-2, 2) : random_in(-1e-6, 1e-6),
                     z = random_in(-1, 1), h = mps__hypot(x, y);
        raise_worst(&t, atan2l(y, x), ulps(mps__atan2(y, x), atan2l(y, x)), y, x);
        raise_worst(&s, asinl(z), ulps(mps__asin(z), asinl(z)), z, 0);
        assert_true(ulps(h, hypotl(x, y)) < 1.3);
    }
    check_worst("atan2", &t, 2);
    check_worst("asin", &s, 3);
}

/* Within three units in the last place, zeros with their sign. */
static void alike(double y, double x, double own, double right)
{
    const int same = right == 0 ? own == 0 && !signbit(own) == !signbit(right)
                                : (isnan(own) && isnan(right)) || ulps(own, right) <= 3;
    if (!same) fail_msg("of %a, %a: %a, C has %a", y, x, own, right);
}

static void at_edges(void **state)
{
    (void)state;
    static const double edges[] = {0.0,    -0.0,  1,      -1,      0.5,      -0.5,      5e-324,
                                   1e-300, 1e300, -1e300, DBL_MAX, INFINITY, -INFINITY, NAN};
    enum { EDGES = sizeof edges / sizeof edges[0] };
    for (int k = 0; k < EDGES; k++) {
        for (int j = 0; j < EDGES; j++)
            alike(edges[k], edges[j], mps__atan2(edges[k], edges[j]), atan2(edges[k], edges[j]));
        if (fabs(edges[k]) <= 1) {
            alike(edges[k], 0, mps__sin(edges[k]), sin(edges[k]));
            alike(edges[k], 0, mps__cos(edges[k]), cos(edges[k]));
            alike(edges[k], 0, mps__asin(edges[k]), asin(edges[k]));
        } else {
            assert_true(isnan(mps__sin(edges[k])) && isnan(mps__cos(edges[k])));
        }
    }
    assert_true(isnan(mps__sin(0x1p50)) && fabs(mps__sin(0x1p49)) <= 1);
}

static void bytes(void **state)
{
    (void)state;
    uint64_t hash = UINT64_C(14695981039346656037);
    random_state = UINT64_C(88172645463325252);
    for (int64_t k = 0; k < 100000; k++) {
        const double x = some_angle(k), y = random_in(-1, 1);
        const double results[] = {mps__sin(x), mps__cos(x), mps__atan2(y, x), mps__asin(y)};
        for (int r = 0; r < 4; r++)
            hash = (hash ^ mps_bits_of(results[r])) * UINT64_C(1099511628211);
    }
    if (hash != UINT64_C(0x735894b9e176b96c)) fail_msg("the hash is 0x%016" PRIx64, hash);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sine_and_cosine),
                                       cmocka_unit_test(directions), cmocka_unit_test(at_edges),
                                       cmocka_unit_test(bytes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Exact sums: the same bytes in any order and grouping, against sums in integers of 2240 bits. */
#include "tank_fixture.h"
#include <float.h>
#include <mps/exact.h>

enum { MOST = 5000 };

/* ---- reference: limbs of 32 bits, the first with the unit 2^-1074 ---------------------------- */

enum { LIMBS = 70 };
typedef struct wide {
    int64_t limb[LIMBS];
} wide;

static void wide_add(wide *w, double v, int sign)
{
    int exponent;
    int64_t digits = (int64_t)ldexp(frexp(v, &exponent), 53);
    int shift = exponent - 53 + 1074;
    if (v == 0) return;
    for (; shift < 0; shift++) digits /= 2; /* denormal: the last digits are 0 */
    const int64_t size = digits < 0 ? -digits : digits;
    const int64_t way = digits < 0 ? -sign : sign;
    const int at = shift / 32, bit = shift % 32;
    const uint64_t low = (uint64_t)size << bit, high = bit ? (uint64_t)size >> (64 - bit) : 0;
    w->limb[at] += way * (int64_t)(low & 0xffffffff);
    w->limb[at + 1] += way * (int64_t)(low >> 32);
    w->limb[at + 2] += way * (int64_t)high;
}

/* The number in double, near enough for a bound; `scale` keeps it in the range. */
static double wide_value(wide w, int scale)
{
    double v = 0;
    for (int k = 0; k + 1 < LIMBS; k++) {
        const int64_t up = w.limb[k] / ((int64_t)1 << 32);
        w.limb[k + 1] += up;
        w.limb[k] -= up * ((int64_t)1 << 32);
    }
    for (int k = LIMBS - 1; k >= 0; k--) v += ldexp((double)w.limb[k], 32 * k - 1074 - scale);
    return v;
}

/* ---- terms ----------------------------------------------------------------------------------- */

static uint64_t seed = 1;

static uint64_t draw(void)
{
    seed ^= seed << 13;
    seed ^= seed >> 7;
    seed ^= seed << 17;
    return seed;
}

/* Of either sign, with exponents of 2 from..to. */
static double number(int from, int to)
{
    const double v = 1 + (double)(draw() >> 12) * 0x1p-52;
    return ldexp(draw() & 1 ? v : -v, from + (int)(draw() % (uint64_t)(to - from + 1)));
}

static void fill(double *v, int n, int from, int to)
{
    for (int i = 0; i < n; i++) v[i] = number(from, to);
}

static double sum_of(int n, const double *v)
{
    mps_exact sum;
    mps_exact_begin(&sum);
    mps_exact_add(&sum, n, v);
    return mps_exact_value(&sum);
}

static void assert_same(const mps_exact *a, const mps_exact *b)
{
    const double x = mps_exact_value(a), y = mps_exact_value(b);
    assert_memory_equal(a->part, b->part, sizeof a->part);
    assert_int_equal(a->level, b->level);
    assert_int_equal(a->special, b->special);
    assert_true(isnan(x) ? isnan(y) : memcmp(&x, &y, sizeof x) == 0);
}

static void shuffle(double *v, int n)
{
    for (int i = n - 1; i > 0; i--) {
        const int j = (int)(draw() % (uint64_t)(i + 1));
        const double swap = v[i];
        v[i] = v[j];
        v[j] = swap;
    }
}

/* Groups of random lengths, joined to one sum or to the sum before. */
static mps_exact grouped(int n, const double *v)
{
    mps_exact sum, group;
    mps_exact_begin(&sum);
    for (int i = 0, m; i < n; i += m) {
        m = 1 + (int)(draw() % 700);
        if (m > n - i) m = n - i;
        mps_exact_begin(&group);
        mps_exact_add(&group, m, v + i);
        switch (draw() % 3) {
        case 0:
            mps_exact_add(&sum, m, v + i);
            break;
        case 1:
            mps_exact_join(&sum, &group);
            break;
        default:
            mps_exact_join(&group, &sum);
            sum = group;
        }
    }
    return sum;
}

/* Exponents of the terms of each trial. */
static const int ranges[][2] = {{0, 0},         {-10, 10},     {-60, 60},      {-300, 300},
                                {-1074, -1000}, {-1074, 1015}, {-1074, -1040}, {900, 1010},
                                {970, 990},     {-26, 26},     {-1023, -1021}, {-1060, -920},
                                {-1000, -950},  {940, 985}};
enum { RANGES = sizeof ranges / sizeof ranges[0] };

static void any_order_and_grouping(void **state)
{
    (void)state;
    static double v[MOST];
    for (int k = 0; k < 20 * RANGES; k++) {
        const int n = k % 3 ? (int)(draw() % MOST) : (int)(draw() % 80);
        fill(v, n, ranges[k % RANGES][0], ranges[k % RANGES][1]);
        if (k % 4 == 0)
            for (int i = 0; i < n; i += 3) v[i] = i % 2 ? 0.0 : -0.0;
        mps_exact whole, other;
        mps_exact_begin(&whole);
        mps_exact_add(&whole, n, v);
        for (int trial = 0; trial < 5; trial++) {
            other = grouped(n, v);
            assert_same(&whole, &other);
            shuffle(v, n);
        }
        mps_exact_begin(&other);
        for (int i = 0; i < n; i++) mps_exact_add(&other, 1, v + i);
        assert_same(&whole, &other);
    }
}

static void near_the_sum(void **state)
{
    (void)state;
    static double v[MOST];
    for (int k = 0; k < 20 * RANGES; k++) {
        const int n = 1 + (int)(draw() % MOST);
        double largest = 0;
        wide w = {{0}};
        fill(v, n, ranges[k % RANGES][0], ranges[k % RANGES][1]);
        for (int i = 0; i < n && k % 2; i += 2) v[i] = -v[(i * 7 + 1) % n]; /* cancels */
        for (int i = 0; i < n; i++) {
            wide_add(&w, v[i], 1);
            largest = fmax(largest, fabs(v[i]));
        }
        const double sum = sum_of(n, v);
        assert_true(isfinite(sum));
        wide_add(&w, sum, -1);
        const double bound = n * 0x1p-52 * ldexp(largest, -60) + 0x1p-52 * fabs(ldexp(sum, -60));
        assert_true(fabs(wide_value(w, 60)) <= bound);
    }
}

/* Terms of 50 digits of a common unit lose none: their sum is the nearest double. */
static void rounded_once(void **state)
{
    (void)state;
    for (int k = 0; k < 2000; k++) {
        double v[40];
        int64_t total = 0;
        for (int i = 0; i < 40; i++) {
            const int64_t whole = (int64_t)(draw() >> 14) * (draw() & 1 ? 1 : -1);
            v[i] = ldexp((double)whole, k % 1000 - 500);
            total += whole;
        }
        assert_true(sum_of(40, v) == ldexp((double)total, k % 1000 - 500));
    }
}

static void cancellation(void **state)
{
    (void)state;
    assert_true(sum_of(3, (double[]){1e300, 1, -1e300}) == 0); /* beyond the three levels */
    assert_true(sum_of(3, (double[]){1e15, 0.5, -1e15}) == 0.5);
    assert_true(sum_of(2, (double[]){1, 1e-20}) == 1);
    assert_true(sum_of(4, (double[]){1, 0x1p-52, -1, -0x1p-53}) == 0x1p-53);
    assert_true(sum_of(3, (double[]){DBL_MAX, -DBL_MAX, 3}) == 0);
    assert_true(sum_of(4, (double[]){DBL_MAX, DBL_MAX, -DBL_MAX, -DBL_MAX / 2}) == DBL_MAX / 2);
    assert_true(sum_of(2, (double[]){DBL_MAX, DBL_MAX}) == INFINITY);
    assert_true(sum_of(2, (double[]){-DBL_MAX, -DBL_MAX}) == -INFINITY);
    assert_true(sum_of(3, (double[]){0x1p-1074, 0x1p-1074, 0x1p-1073}) == 0x1p-1072);
    assert_true(sum_of(2, (double[]){0x1p-1022, -0x1p-1074}) == 0x1p-1022 - 0x1p-1074);
    static double tenth[MOST];
    for (int i = 0; i < 1000; i++) tenth[i] = 0.1;
    assert_true(sum_of(1000, tenth) == 100.00000000000000555); /* 1000 times the double 0.1 */
}

static void no_terms_and_zeros(void **state)
{
    (void)state;
    const double zero = 0, minus[3] = {-0.0, -0.0, -0.0};
    const double sums[] = {sum_of(0, NULL), sum_of(3, minus), sum_of(2, (double[]){1e9, -1e9})};
    for (int k = 0; k < 3; k++) assert_memory_equal(&sums[k], &zero, sizeof zero);
    mps_exact sum = {{0}, 0, 0}, none;
    memset(&none, 0x5a, sizeof none);
    mps_exact_begin(&none);
    assert_same(&sum, &none);
    mps_exact_add(&sum, 1, &(double){42});
    mps_exact_join(&sum, &none);
    mps_exact_join(&none, &sum);
    assert_true(mps_exact_value(&sum) == 42 && mps_exact_value(&none) == 42);
}

static void not_finite(void **state)
{
    (void)state;
    static double v[MOST];
    const double special[3] = {INFINITY, -INFINITY, NAN};
    for (int k = 0; k < 300; k++) {
        const int n = 3 + (int)(draw() % 2000), kinds = 1 + k % 7;
        fill(v, n, -50, k % 2 ? 50 : 1015);
        for (int s = 0; s < 3; s++)
            if (kinds >> s & 1) v[s * (n / 3)] = special[s];
        mps_exact whole, other;
        mps_exact_begin(&whole);
        mps_exact_add(&whole, n, v);
        other = grouped(n, v);
        assert_same(&whole, &other);
        const double sum = mps_exact_value(&whole);
        if (kinds == 1 || kinds == 2)
            assert_true(sum == special[kinds - 1]);
        else
            assert_true(isnan(sum));
    }
    mps_exact sum = {{0}, 0, 0};
    mps_exact_add_products(&sum, 2, (double[]){1e200, 1}, (double[]){1e200, 1});
    assert_true(mps_exact_value(&sum) == INFINITY);
    mps_exact_add_products(&sum, 1, (double[]){0}, (double[]){INFINITY});
    assert_true(isnan(mps_exact_value(&sum)));
}

static void products(void **state)
{
    (void)state;
    static double x[MOST], y[MOST], v[MOST];
    for (int k = 0; k < 100; k++) {
        const int n = (int)(draw() % MOST), span = k % 2 ? 20 : 500;
        mps_exact whole, other;
        fill(x, n, -span, span);
        fill(y, n, -span, span);
        for (int i = 0; i < n; i++) v[i] = x[i] * y[i];
        mps_exact_begin(&whole);
        mps_exact_begin(&other);
        mps_exact_add(&whole, n, v);
        mps_exact_add_products(&other, n / 3, x, y);
        mps_exact_add_products(&other, n - n / 3, x + n / 3, y + n / 3);
        assert_same(&whole, &other);
    }
}

/* As many terms as a sum may have, by joins of a sum with itself. */
static void capacity(void **state)
{
    (void)state;
    const double v[] = {1 - 0x1p-53, -1 + 0x1p-53, 0.75 + 0x1p-50, DBL_MAX};
    for (int k = 0; k < 3; k++) {
        mps_exact sum = {{0}, 0, 0};
        mps_exact_add(&sum, 1, v + k);
        for (int twice = 0; twice < 37; twice++) {
            const mps_exact before = sum;
            mps_exact_join(&sum, &before);
        }
        assert_true(mps_exact_value(&sum) == ldexp(v[k], 37));
        mps_exact_add(&sum, 1, v + 3);
        assert_true(mps_exact_value(&sum) == DBL_MAX);
    }
}

/* ---- loops ----------------------------------------------------------------------------------- */

static void run_backwards(void *user, int32_t parts, mps_part_fn body, void *argument)
{
    (void)user;
    for (int32_t part = parts - 1; part >= 0; part--) body(argument, part);
}

static void add_range(void *argument, int64_t begin, int64_t end, mps_exact *sums, double *maxima)
{
    const double *v = argument;
    mps_exact_add(&sums[0], end - begin, v + begin);
    mps_exact_add_products(&sums[1], end - begin, v + begin, v + begin);
    for (int64_t i = begin; i < end; i++) maxima[0] = v[i] > maxima[0] ? v[i] : maxima[0];
}

static void rows_in_ranges(void **state)
{
    (void)state;
    static double v[MOST];
    fill(v, MOST, -30, 30);
    for (int n = 0; n < MOST; n = 3 * n + 1) {
        mps_exact whole[2] = {{{0}, 0, 0}, {{0}, 0, 0}};
        double most = -INFINITY;
        add_range(v, 0, n, whole, &most);
        for (int32_t threads = 0; threads < 20; threads++) {
            const mps_parallel p = {sizeof p, threads, run_backwards, NULL};
            mps_exact sums[2] = {{{0}, 0, 0}, {{0}, 0, 0}};
            double maximum = -INFINITY;
            const mps_exact_values values = {2, 1, sums, &maximum};
            mps_exact_rows(threads ? &p : NULL, n, 10, add_range, v, &values);
            for (int k = 0; k < 2; k++) assert_same(&whole[k], &sums[k]);
            assert_true(maximum == most);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(any_order_and_grouping),
                                       cmocka_unit_test(near_the_sum),
                                       cmocka_unit_test(rounded_once),
                                       cmocka_unit_test(cancellation),
                                       cmocka_unit_test(no_terms_and_zeros),
                                       cmocka_unit_test(not_finite),
                                       cmocka_unit_test(products),
                                       cmocka_unit_test(capacity),
                                       cmocka_unit_test(rows_in_ranges)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Functions of mps/numbers.h against those of the C library in extended precision, at random
 * arguments. */
#ifndef MPS_TEST_NUMBERS_H
#define MPS_TEST_NUMBERS_H

#include <float.h>
#include <inttypes.h>
#include <mps/numbers.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <cmocka.h>

/* Random doubles: xorshift of Marsaglia. */
static uint64_t random_state = UINT64_C(88172645463325252);

static inline uint64_t random_bits(void)
{
    random_state ^= random_state << 13;
    random_state ^= random_state >> 7;
    random_state ^= random_state << 17;
    return random_state * UINT64_C(0x2545F4914F6CDD1D);
}

static inline double random_in(double a, double b)
{
    return a + (b - a) * ((double)(random_bits() >> 11) * 0x1p-53);
}

/* Of any size, but NaN. */
static inline double random_double(void)
{
    double number;
    do number = mps_double_of(random_bits());
    while (number != number);
    return number;
}

/* Arguments lo..hi; lo = hi: of any size. */
typedef struct span {
    double lo, hi;
} span;

static inline double random_of(span s)
{
    return s.lo < s.hi ? random_in(s.lo, s.hi) : random_double();
}

/* Error of `got` in units in the last place of a double of the size of `right`; 0 for the same
 * infinity. */
static inline double ulps(double got, long double right)
{
    int exponent;
    const long double size = fabsl(right);
    if (got != got || right != right) return got != got && right != right ? 0 : INFINITY;
    if (isinf(got)) /* what rounds to infinity is beyond the largest double by half of its unit */
        return (got > 0) == (right > 0) && size > (long double)DBL_MAX * (1 - 0x1p-54L) ? 0
                                                                                        : INFINITY;
    frexpl(size, &exponent);
    return (double)(fabsl((long double)got - right) /
                    ldexpl(1, (size < DBL_MIN ? -1021 : exponent) - 53));
}

typedef struct one_argument {
    const char *name;
    double (*own)(double);
    long double (*right)(long double);
    span spans[4]; /* those of 0, 0 are of any size */
    double bound;  /* [ulp] of normal results */
} one_argument;

static double log_of_size(double x)
{
    return mps_log(fabs(x));
}

static long double right_log_of_size(long double x)
{
    return logl(fabsl(x));
}

static const one_argument functions_of_one[] = {
    {"exp", mps_exp, expl, {{-708, 709.7}, {-2, 2}, {-1e-3, 1e-3}, {0, 0}}, 0.62},
    {"expm1", mps_expm1, expm1l, {{-40, 709.7}, {-2, 2}, {-1e-3, 1e-3}, {0, 0}}, 0.85},
    {"log", log_of_size, right_log_of_size, {{0, 1e-307}, {0.5, 2}, {0.99, 1.01}, {0, 0}}, 0.88},
    {"sinh", mps_sinh, sinhl, {{-710, 710}, {-2, 2}, {-0.1, 0.1}, {0, 0}}, 0.75},
    {"cosh", mps_cosh, coshl, {{-710, 710}, {-2, 2}, {20, 45}, {0, 0}}, 0.68}};
enum { ONE = sizeof functions_of_one / sizeof functions_of_one[0] };

/* Bases and exponents: of any size; the exponents of a spray of results; near 1; |y log x| up to
 * 745 with large y. */
static const span bases[6] = {{0, 0},           {0, 10},     {0.999, 1.001},
                              {0.7071, 1.4143}, {1e-6, 1e3}, {0, 1e-308}},
                  exponents[6] = {{0, 0},        {-300, 300}, {-7e5, 7e5},
                                  {-2100, 2100}, {-1, 1},     {0, 0.99}};

/* Results below the smallest normal double are rounded twice. */
static const double tiny_bound = 0.76, pow_bound = 0.72;

/* Largest errors of normal results and of those below. */
typedef struct worst {
    double normal, tiny, at[2];
} worst;

static inline void raise_worst(worst *w, long double right, double error, double x, double y)
{
    double *of = fabsl(right) < DBL_MIN ? &w->tiny : &w->normal;
    if (error <= *of) return;
    *of = error;
    w->at[0] = x;
    w->at[1] = y;
}

/* An error below 0.49 for this number of arguments would indicate a wrong reference. */
static inline void check_worst(const char *name, const worst *w, double bound)
{
    print_message("%-6s %.4f ulp; %.4f of results below 2^-1022; at %a %a\n", name, w->normal,
                  w->tiny, w->at[0], w->at[1]);
    assert_true(w->normal > 0.49 && w->normal <= bound);
    assert_true(w->tiny <= tiny_bound);
}

static inline void check_one(const one_argument *f, int64_t count)
{
    worst w = {0};
    for (int64_t k = 0; k < count; k++) {
        const double x = random_of(f->spans[k % 4]);
        const long double right = f->right(x);
        raise_worst(&w, right, ulps(f->own(x), right), x, 0);
    }
    check_worst(f->name, &w, f->bound);
}

static inline void check_pow(int64_t count)
{
    worst w = {0};
    for (int64_t k = 0; k < count; k++) {
        const double x = fabs(random_of(bases[k % 6])), y = random_of(exponents[k % 6]);
        const long double right = powl(x, y);
        raise_worst(&w, right, ulps(mps_pow(x, y), right), x, y);
    }
    check_worst("pow", &w, pow_bound);
}

/* Where the right value grows, results of neighbours do not fall. */
static inline void check_growth(const one_argument *f, int64_t count)
{
    for (int64_t k = 0; k < count; k++) {
        const double x = fabs(random_of(f->spans[k % 4])), next = nextafter(x, INFINITY);
        if (f->own(next) < f->own(x)) fail_msg("%s falls behind %a", f->name, x);
    }
}

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/** @file numbers.h  Elementary functions for row functions: exp, log, pow, sinh, cosh.
 *
 *  They use sums, products, divisions and bit operations of doubles only: results are bitwise the
 *  same with each compiler, C library and device, if products and sums are not fused (gcc and
 *  clang: -ffp-contract=off). Use these, sqrt() and fabs() in row functions instead of <math.h>.
 *  errno and the flags of floating-point exceptions are not set.
 *
 *  Errors in units in the last place of the result, at most: mps_exp() 0.62, mps_expm1() 0.85,
 *  mps_log() 0.88, mps_sinh() 0.75, mps_cosh() 0.68, mps_pow() 0.72 (results below 2.2e-308: 0.76,
 *  because they are rounded twice). NaN, infinities and zeros as in annex F of C11.
 *
 *  Method: argument reduction to a short interval around 0, a polynomial through Chebyshev nodes
 *  there (coefficients from scripts/numbers), and compensated sums: the rounding error of a + b
 *  with |a| >= |b| is b - ((a + b) - a). */
#ifndef MPS_NUMBERS_H
#define MPS_NUMBERS_H

#include <math.h>
#include <mps/types.h>

MPS_BEGIN_DECLS

/** The larger of two numbers, `a` if they are equal or if one is NaN. The sign of a zero that
 *  fmax() returns differs between C libraries and devices. */
static inline double mps_larger(double a, double b)
{
    return b > a ? b : a;
}

/** The smaller of two numbers, `a` if they are equal or if one is NaN. */
static inline double mps_smaller(double a, double b)
{
    return b < a ? b : a;
}

/** The bit pattern of a double. */
static inline uint64_t mps_bits_of(double a)
{
    const union {
        double number;
        uint64_t bits;
    } both = {a};
    return both.bits;
}

/** The double with a bit pattern. */
static inline double mps_double_of(uint64_t bits)
{
    const union {
        uint64_t bits;
        double number;
    } both = {bits};
    return both.number;
}

/** A double-double number, hi + lo. */
typedef struct mps_wide {
    /** The number, rounded. */
    double hi;
    /** The remainder. */
    double lo;
} mps_wide;

/** 2^k, -1022 <= k <= 1023. */
static inline double mps_power_of_two(int k)
{
    return mps_double_of((uint64_t)(k + 1023) << 52);
}

/** a 2^k with one rounding; 0.5 < a < 2, -1200 < k < 1200. */
static inline double mps_scaled(double a, int k)
{
    if (k > 1022) return a * mps_power_of_two(1022) * mps_power_of_two(k - 1022);
    if (k < -1021) return a * mps_power_of_two(k + 200) * mps_power_of_two(-200);
    return a * mps_power_of_two(k);
}

/** hi + lo. */
static inline mps_wide mps_wide_of(double hi, double lo)
{
    mps_wide w;
    w.hi = hi;
    w.lo = lo;
    return w;
}

/** a + b, |a| >= |b| or a = 0. */
static inline mps_wide mps_wide_sum(double a, double b)
{
    const double sum = a + b;
    return mps_wide_of(sum, b - (sum - a));
}

/** a + b of double-double numbers, |a| >= |b| or a = 0. */
static inline mps_wide mps_wide_add(mps_wide a, mps_wide b)
{
    const mps_wide s = mps_wide_sum(a.hi, b.hi);
    return mps_wide_sum(s.hi, s.lo + (a.lo + b.lo));
}

/** a truncated to 26 of its 53 bits. */
static inline double mps_upper(double a)
{
    return mps_double_of(mps_bits_of(a) & ~(((uint64_t)1 << 27) - 1));
}

/** a b. */
static inline mps_wide mps_wide_product(mps_wide a, double b)
{
    const double p = a.hi * b, a1 = mps_upper(a.hi), a2 = a.hi - a1, b1 = mps_upper(b), b2 = b - b1;
    return mps_wide_of(p, (((a1 * b1 - p) + a1 * b2) + a2 * b1) + a2 * b2 + a.lo * b);
}

/** x = k log 2 + r.hi + r.lo, |r.hi| < 0.347, and the terms of e^r = cosh r + sinh r. */
typedef struct mps_exp_parts {
    /** Multiple of log 2. */
    int k;
    /** Remainder. */
    mps_wide r;
    /** r.hi^2/2 */
    double half;
    /** cosh(r.hi) - 1 - half */
    double even;
    /** sinh(r.hi) - r.hi */
    double odd;
} mps_exp_parts;

/** Terms of e^x for x.hi + x.lo, |x.hi| < 800. */
static inline mps_exp_parts mps_exp_split(mps_wide x)
{
    /* Adding 1.5 * 2^52 rounds to an integer. The first part of log 2 has 42 bits, so that its
       product with k is exact. */
    const double whole = (x.hi * 0x1.71547652b82fep+0 + 0x1.8p52) - 0x1.8p52;
    const double r = x.hi - whole * 0x1.62e42fefa38p-1;
    mps_exp_parts e;
    e.k = (int)whole;
    e.r = mps_wide_sum(r, x.lo - whole * 0x1.ef35793c76730p-45);
    const double z = e.r.hi * e.r.hi, z2 = z * z;
    e.half = 0.5 * z;
    e.even = z2 * (0x1.5555555555555p-5 + z * 0x1.6c16c16c167e1p-10 +
                   z2 * (0x1.a01a01a47b054p-16 + z * 0x1.27e4e1f48534fp-22 +
                         z2 * 0x1.1f66df7fca49fp-29));
    e.odd = e.r.hi * z *
            (0x1.5555555555556p-3 + z * 0x1.11111111109b3p-7 +
             z2 * (0x1.a01a01a7c41d5p-13 + z * 0x1.71de0dae63bb3p-19 + z2 * 0x1.af38a9b0ec855p-26));
    return e;
}

/** e^x for x.hi + x.lo; infinity or 0 outside of the range of doubles. */
static inline double mps_exp_wide(mps_wide x)
{
    if (x.hi > 710) return INFINITY;
    if (x.hi < -746) return 0;
    const mps_exp_parts e = mps_exp_split(x);
    const mps_wide w = mps_wide_sum(1, e.r.hi);
    return mps_scaled(w.hi + (e.half + (e.even + e.odd + (w.lo + e.r.lo * w.hi))), e.k);
}

/** e^x. */
static inline double mps_exp(double x)
{
    return x != x ? x : mps_exp_wide(mps_wide_of(x, 0));
}

/** e^x - 1, accurate near x = 0 too. */
static inline double mps_expm1(double x)
{
    if (!(x < 40)) return mps_exp(x);
    if (x < -40) return -1;
    if (fabs(x) < 0x1p-54) return x;
    const mps_exp_parts e = mps_exp_split(mps_wide_of(x, 0));
    const double rest = e.even + e.odd + e.r.lo * (1 + e.r.hi);
    if (e.k == 0) return e.r.hi + (e.half + rest);
    const double p = mps_power_of_two(e.k);
    const mps_wide q = p > 1 ? mps_wide_sum(p, -1) : mps_wide_sum(-1, p),
                   s = mps_wide_sum(q.hi, p * e.r.hi);
    return s.hi + (p * e.half + (p * rest + s.lo + q.lo));
}

/** (e^x + sign e^-x)/2 for x >= 0; sign 1: cosh, -1: sinh. */
static inline double mps_half_sum(double x, double sign)
{
    if (x > 40) /* e^(x - log 2) */
        return mps_exp_wide(mps_wide_add(mps_wide_of(mps_smaller(x, 720), 0),
                                         mps_wide_of(-0x1.62e42fefa38p-1, -0x1.ef35793c76730p-45)));
    const mps_exp_parts e = mps_exp_split(mps_wide_of(x, 0));
    const double p = mps_power_of_two(e.k - 1), q = sign * mps_power_of_two(-e.k - 1);
    const double b = p - q;
    const mps_wide a = mps_wide_sum(p, q), s = mps_wide_sum(a.hi, p * e.r.hi),
                   t = mps_wide_sum(s.hi, -q * e.r.hi);
    const double rest = a.hi * e.even + b * e.odd + (b + a.hi * e.r.hi) * e.r.lo;
    return t.hi + (a.hi * e.half + (rest + t.lo + s.lo + a.lo));
}

/** cosh x. */
static inline double mps_cosh(double x)
{
    return x != x ? x : mps_half_sum(fabs(x), 1);
}

/** sinh x. */
static inline double mps_sinh(double x)
{
    if (!(fabs(x) > 0x1p-28)) return x;
    return x < 0 ? -mps_half_sum(-x, -1) : mps_half_sum(x, -1);
}

/** x = 2^k m, sqrt(1/2) <= m < sqrt(2); x positive and finite. Returns m. */
static inline double mps_log_split(double x, int *k)
{
    const int tiny = x < 0x1p-1022;
    const uint64_t bits = mps_bits_of(tiny ? x * 0x1p54 : x);
    *k = (int)((bits + (UINT64_C(0x3ff0000000000000) - UINT64_C(0x3fe6a09e667f3bcd))) >> 52) - 1023;
    const double m = mps_double_of(bits - ((uint64_t)(int64_t)*k << 52));
    if (tiny) *k -= 54;
    return m;
}

/** Natural logarithm of x. */
static inline double mps_log(double x)
{
    int k;
    if (!(x > 0)) return x == 0 ? -INFINITY : x != x ? x : NAN;
    if (!(x < INFINITY)) return x;
    /* log(1 + f) = f - f^2/2 + s (f^2/2 + rest), s = f/(2 + f), rest = 2 atanh(s)/s - 2 */
    const double f = mps_log_split(x, &k) - 1, s = f / (2 + f), z = s * s, z2 = z * z;
    const double rest = z * (0x1.5555555555558p-1 + z * 0x1.99999999952e2p-2 +
                             z2 * (0x1.2492492df148dp-2 + z * 0x1.c71c62e5800a1p-3 +
                                   z2 * (0x1.7462b4ab2ef6bp-3 + z * 0x1.39fe606542ddep-3 +
                                         z2 * 0x1.2b584aae78a57p-3)));
    const double half = 0.5 * f * f;
    const mps_wide w = mps_wide_sum(k * 0x1.62e42fefa38p-1, f);
    return w.hi + (w.lo - (half - (s * (half + rest) + k * 0x1.ef35793c76730p-45)));
}

/** Natural logarithm of x, positive and finite, with a relative error of 2^-65: by products of
 *  26-bit numbers, which are exact, and small remainders. */
static inline mps_wide mps_log_wide(double x)
{
    int k;
    const double m = mps_log_split(x, &k), f = m - 1;
    /* log m = 2 s (1 + z (1/3 + v)), v = z (1/5 + rest), s = f/(2 + f), z = s^2 */
    const double part = 1 / (1 + m), s = f * part, q = s * s, q2 = q * q;
    const double rest = q * (0x1.2492492492492p-3 + q * 0x1.c71c71c71c822p-4) +
                        q * q2 * (0x1.745d1745a3f62p-4 + q * 0x1.3b13b16b4535dp-4) +
                        q2 * (q * q2) *
                            (0x1.1110f807e8c02p-4 + q * 0x1.e1eff99e23b91p-5 +
                             q2 * (0x1.acf8627f00a61p-5 + q * 0x1.b2df9aca49e43p-5));
    const double v = q * (0x1.999999999999ap-3 + rest);
    /* s = s1 + s2, z = z1 + z2, 1/3 + v = t1 + t2, z (1/3 + v) = w1 + w2 */
    const double d = mps_upper(1 + m), s1 = mps_upper(s),
                 s2 = ((f - s1 * d) - s1 * (m - (d - 1))) * part;
    const double z1 = mps_upper(q), z2 = (s1 * s1 - z1) + s2 * (s1 + s);
    const double t = 0x1.5555555555555p-2 + v, t1 = mps_upper(t),
                 t2 = v - (t1 - 0x1.5555555555555p-2) +
                      (0x1.5555555555555p-56 + 0x1.999999999999ap-3 * (z2 - (q - z1)));
    const double w_rest = z1 * t2 + z2 * t, w = z1 * t1 + w_rest, w1 = mps_upper(w),
                 w2 = (z1 * t1 - w1) + w_rest;
    const mps_wide a = mps_wide_sum(k * 0x1.62e42fefa38p-1, 2 * s1),
                   b = mps_wide_sum(a.hi, 2 * (s1 * w1));
    return mps_wide_of(b.hi,
                       b.lo + (a.lo + (2 * (s2 + (s1 * w2 + s2 * w)) + k * 0x1.ef35793c76730p-45)));
}

/** 1: y is odd, 0: y is even, -1: y is no integer. */
static inline int mps_odd(double y)
{
    if (!(fabs(y) < 0x1p53)) return 0; /* integers beyond 2^53 are even */
    const int64_t whole = (int64_t)y;
    return (double)whole == y ? (int)(whole & 1) : -1;
}

/** x^y. x below 0: y must be an integer, else the result is NaN. */
static inline double mps_pow(double x, double y)
{
    if (y == 0 || x == 1) return 1;
    if (x != x || y != y) return x + y;
    const double size = fabs(x);
    const int odd = mps_odd(y);
    const double sign = mps_bits_of(x) >> 63 && odd == 1 ? -1 : 1;
    if (size == 0 || !(size < INFINITY)) return sign * ((size == 0) == (y > 0) ? 0 : INFINITY);
    if (x < 0 && odd < 0) return NAN;
    if (size == 1) return sign;
    if (y == 2) return x * x; /* the nearest double */
    if (!(fabs(y) < 0x1p64)) return (size > 1) == (y > 0) ? INFINITY : 0;
    return sign * mps_exp_wide(mps_wide_product(mps_log_wide(size), y));
}

MPS_END_DECLS

#endif

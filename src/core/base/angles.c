/* SPDX-License-Identifier: BSD-3-Clause */
/* Polynomials computed by scripts/numbers. */
#include "angles.h"
#include <mps/numbers.h>

/* a + b of arbitrary magnitudes. */
static mps_wide sum_of(double a, double b)
{
    const double sum = a + b, part = sum - a;
    return mps_wide_of(sum, (a - (sum - part)) + (b - part));
}

/* Integer nearest to x, |x| < 2^51: adding 1.5 * 2^52 leaves no fractional digits. */
static double nearest(double x)
{
    return (x + 0x1.8p52) - 0x1.8p52;
}

/* Argument reduction: x = k pi/2 + r.hi + r.lo, |r.hi| < 0.786. pi/2 has three parts; products and
 * sums keep their rounding errors, so that r is accurate near multiples of pi/2 too. Returns k
 * modulo 4. */
static int quarters(double x, mps_wide *r)
{
    const mps_wide quarter = mps_wide_of(0x1.921fb54442d18p+0, 0);
    double k = nearest(x * 0x1.45f306dc9c883p-1);
    const mps_wide near = mps_wide_product(quarter, k);
    k += nearest(((x - near.hi) - near.lo) * 0x1.45f306dc9c883p-1); /* for large x: k was rounded */
    const mps_wide first = mps_wide_product(quarter, k),
                   second = mps_wide_product(mps_wide_of(0x1.1a62633145c07p-54, 0), k);
    const mps_wide a = sum_of(x - first.hi, -first.lo), b = sum_of(a.hi, -second.hi);
    *r = sum_of(b.hi, b.lo + a.lo - second.lo + k * 0x1.f1976b7ed8fbcp-110);
    return (int)((int64_t)k & 3);
}

static double sine(mps_wide r)
{
    const double z = r.hi * r.hi;
    const double odd = -0x1.5555555555555p-3 +
                       z * (0x1.1111111110bb1p-7 +
                            z * (-0x1.a01a019e8357dp-13 +
                                 z * (0x1.71de37961e4c6p-19 +
                                      z * (-0x1.ae600a926c89ap-26 + z * 0x1.5e0af186af739p-33))));
    return r.hi + (r.hi * z * odd + r.lo * (1 - 0.5 * z));
}

static double cosine(mps_wide r)
{
    const double z = r.hi * r.hi;
    const double even = 0x1.5555555555555p-5 +
                        z * (-0x1.6c16c16c16966p-10 +
                             z * (0x1.a01a019f4e867p-16 +
                                  z * (-0x1.27e4fa17a41b4p-22 +
                                       z * (0x1.1eeb68b109173p-29 - z * 0x1.907d7aebd5e3dp-37))));
    const mps_wide w = mps_wide_sum(1, -0.5 * z);
    return w.hi + (w.lo + (z * z * even - r.hi * r.lo));
}

/* sin(x + turns pi/2) */
static double turned_sine(double x, int turns)
{
    mps_wide r;
    if (!(fabs(x) < 0x1p50)) return NAN;
    const int k = (quarters(x, &r) + turns) & 3;
    const double v = k & 1 ? cosine(r) : sine(r);
    return k & 2 ? -v : v;
}

double mps__sin(double x)
{
    return fabs(x) < 0x1p-27 ? x : turned_sine(x, 0);
}

double mps__cos(double x)
{
    return turned_sine(x, 1);
}

/* atan(a/b), 0 <= a <= b, 0 < b */
static double slope_angle(double a, double b)
{
    /* tan(pi/8): then atan((a - b)/(a + b)) + pi/4 */
    const int steep = a > 0.4142135623730950488 * b;
    const double t = steep ? (a - b) / (a + b) : a / b, z = t * t, z2 = z * z, z4 = z2 * z2;
    const double odd = -0x1.5555555555555p-2 + z * 0x1.9999999999953p-3 +
                       z2 * (-0x1.249249248d7dcp-3 + z * 0x1.c71c71c303dbbp-4) +
                       z4 * (-0x1.745d165dc9713p-4 + z * 0x1.3b1392d519db1p-4 +
                             z2 * (-0x1.110e87b4357d2p-4 + z * 0x1.e19a0bfa3eef9p-5)) +
                       z4 * z4 *
                           (-0x1.ac7a5a79b3f26p-5 + z * 0x1.74dccfb93fff0p-5 +
                            z2 * (-0x1.1b311bb48c215p-5 + z * 0x1.0acd9e91a5a35p-6));
    return steep ? 0.25 * MPS__PI + (t + t * z * odd) : t + t * z * odd;
}

static int is_below_zero(double x)
{
    return (int)(mps_bits_of(x) >> 63);
}

double mps__atan2(double y, double x)
{
    if (x != x || y != y) return x + y;
    double a = fabs(y), b = fabs(x);
    const double most = mps_larger(a, b);
    if (!(most < INFINITY)) { /* along an axis or a diagonal */
        a = a < most ? 0 : 1;
        b = b < most ? 0 : 1;
    } else if (most > 0x1p1000) { /* the sum stays in the range */
        a *= 0x1p-60;
        b *= 0x1p-60;
    }
    double angle = most == 0 ? 0 : a > b ? 0.5 * MPS__PI - slope_angle(b, a) : slope_angle(a, b);
    if (is_below_zero(x)) angle = MPS__PI - angle;
    return is_below_zero(y) ? -angle : angle;
}

double mps__asin(double x)
{
    return mps__atan2(x, sqrt((1 - x) * (1 + x)));
}

double mps__hypot(double x, double y)
{
    return sqrt(x * x + y * y);
}

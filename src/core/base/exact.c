/* SPDX-License-Identifier: BSD-3-Clause */
/* Sums whose bytes depend neither on the order nor on the grouping of their terms; mps/exact.h
 * describes the method.
 *
 * n_k is found by an addition: v + m_k, with m_k = 1.5 2^52 u_k, has the unit u_k in its last
 * place, and the bits of the sum, read as an integer, are those of m_k plus n_k. The sums of these
 * integers do not overflow but wrap, so the bits of m_k are subtracted at the end. m_k is even in
 * its last place, so ties are rounded to the same neighbour whatever the previous terms were. With
 * these units level = biased exponent/26 is the lowest level of a term. */
#include "base.h"
#include <float.h>
#include <math.h>
#include <mps/exact.h>
#include <string.h>

_Static_assert(FLT_EVAL_METHOD == 0, "double must be computed in double precision");

enum {
    LEVEL_BITS = 26,   /* between the units of two levels */
    FIRST_BITS = 1074, /* unit of level 0: 2^-FIRST_BITS, a divisor of all doubles */
    BLOCK = 512,       /* terms that share one search for the largest */
    FIRST = 64,        /* terms of the first block, which determine the level */
    SCALED = 77,      /* from this level on m_k would overflow: terms are scaled by 2^-SCALE_BITS */
    SCALE_LEVELS = 4, /* SCALE_BITS/LEVEL_BITS */
    PLUS = 1,         /* bits of mps_exact.special */
    MINUS = 2,
    NOT_A_NUMBER = 4
};
static const double SCALE = 0x1p-104;
static const uint64_t MAGNITUDE = INT64_MAX, EXPONENT_BITS = (uint64_t)0x7ff << 52;

static inline uint64_t bits_of(double v)
{
    uint64_t bits;
    memcpy(&bits, &v, sizeof bits);
    return bits;
}

/* m_k = 1.5 2^(26 k - 1022) */
static inline double magic(int32_t level)
{
    const uint64_t bits = (uint64_t)(LEVEL_BITS * level + 1) << 52 | (uint64_t)1 << 51;
    double v;
    memcpy(&v, &bits, sizeof v);
    return v;
}

/* Add the n_k of terms x, or x y, to the parts from `level` on. Without effect and false: a term is
 * not finite or too large for the level. */
static inline bool deposit_any(int64_t part[3], int32_t level, int64_t count, const double *x,
                               const double *y)
{
    const double m0 = magic(level), m1 = magic(level + 1), m2 = magic(level + 2);
    /* added to the bits, it carries too large exponents into the sign bit */
    const uint64_t limit = (uint64_t)(0x800 - LEVEL_BITS * (level + 1)) << 52;
    uint64_t s0 = 0, s1 = 0, s2 = 0, large = 0;
    for (int64_t i = 0; i < count; i++) {
        double v = y ? x[i] * y[i] : x[i], t = v + m2;
        large |= (bits_of(v) & MAGNITUDE) + limit;
        s2 += bits_of(t);
        v -= t - m2;
        t = v + m1;
        s1 += bits_of(t);
        v -= t - m1;
        s0 += bits_of(v + m0);
    }
    if (large >> 63) return false;
    part[0] += (int64_t)(s0 - (uint64_t)count * bits_of(m0));
    part[1] += (int64_t)(s1 - (uint64_t)count * bits_of(m1));
    part[2] += (int64_t)(s2 - (uint64_t)count * bits_of(m2));
    return true;
}

/* Separate versions with and without products, so that each loop is a vector loop. */
static bool deposit_plain(int64_t part[3], int32_t level, int64_t count, const double *x,
                          const double *y)
{
    return y ? deposit_any(part, level, count, x, y) : deposit_any(part, level, count, x, NULL);
}

/* Wider vectors, if the processor has them; the same bits. */
#if defined(__GNUC__) && defined(__x86_64__) && !defined(MPS_DEVICE)
__attribute__((target("avx2"))) static bool
deposit_wide(int64_t part[3], int32_t level, int64_t count, const double *x, const double *y)
{
    return y ? deposit_any(part, level, count, x, y) : deposit_any(part, level, count, x, NULL);
}

static bool deposit(int64_t part[3], int32_t level, int64_t count, const double *x, const double *y)
{
    return __builtin_cpu_supports("avx2") ? deposit_wide(part, level, count, x, y)
                                          : deposit_plain(part, level, count, x, y);
}
#else
#define deposit deposit_plain
#endif

/* Raise the lowest level to `level`; lower parts are dropped, as if the largest term had come
 * first. */
static void raise_level(mps_exact *sum, int32_t level)
{
    const int32_t up = level - sum->level;
    if (up <= 0) return;
    for (int32_t k = 0; k < 3; k++) sum->part[k] = k + up < 3 ? sum->part[k + up] : 0;
    sum->level = level;
}

static int32_t special_of(double v)
{
    if (isnan(v)) return NOT_A_NUMBER;
    return v > 0 ? PLUS : MINUS;
}

/* Add at most BLOCK terms of any size. In plain vectors, for tests against the wide ones. */
static void add_block(mps_exact *sum, int64_t count, const double *x, const double *y)
{
    double term[BLOCK];
    uint64_t most = 0;
    for (int64_t i = 0; i < count; i++) {
        const double v = y ? x[i] * y[i] : x[i];
        const uint64_t magnitude = bits_of(v) & MAGNITUDE;
        const bool finite = magnitude < EXPONENT_BITS;
        term[i] = finite ? v : 0;
        if (!finite) sum->special |= special_of(v);
        if (finite && magnitude > most) most = magnitude;
    }
    raise_level(sum, (int32_t)(most >> 52) / LEVEL_BITS);
    if (sum->level < SCALED) {
        deposit_plain(sum->part, sum->level, count, term, NULL);
        return;
    }
    for (int64_t i = 0; i < count; i++) term[i] *= SCALE;
    deposit_plain(sum->part, sum->level - SCALE_LEVELS, count, term, NULL);
}

static inline void add(mps_exact *sum, int64_t count, const double *x, const double *y)
{
    for (int64_t i = 0, n; i < count; i += n) {
        const int64_t most = sum->level > 0 ? BLOCK : FIRST;
        n = count - i < most ? count - i : most;
        if (sum->level >= SCALED || !deposit(sum->part, sum->level, n, x + i, y ? y + i : NULL))
            add_block(sum, n, x + i, y ? y + i : NULL);
    }
}

void mps_exact_begin(mps_exact *sum)
{
    *sum = (mps_exact){0};
}

void mps_exact_add(mps_exact *sum, int64_t count, const double *terms)
{
    add(sum, count, terms, NULL);
}

void mps_exact_add_products(mps_exact *sum, int64_t count, const double *x, const double *y)
{
    add(sum, count, x, y);
}

void mps_exact_join(mps_exact *sum, const mps_exact *other)
{
    mps_exact from = *other;
    raise_level(&from, sum->level);
    raise_level(sum, from.level);
    for (int k = 0; k < 3; k++) sum->part[k] += from.part[k];
    sum->special |= from.special;
}

/* u_k, which is subnormal below level 2. The product with it is rounded once, as by ldexp(), which
 * devices lack. */
static double unit_of(int32_t level)
{
    const int32_t power = LEVEL_BITS * level - FIRST_BITS;
    const uint64_t bits = power < DBL_MIN_EXP - 1 ? (uint64_t)1 << (power + FIRST_BITS)
                                                  : (uint64_t)(power + DBL_MAX_EXP - 1) << 52;
    double v;
    memcpy(&v, &bits, sizeof v);
    return v;
}

double mps_exact_value(const mps_exact *sum)
{
    static const int64_t unit = (int64_t)1 << LEVEL_BITS, split = (int64_t)1 << 32;
    if (sum->special == PLUS) return INFINITY;
    if (sum->special == MINUS) return -INFINITY;
    if (sum->special) return NAN;
    const int64_t middle = sum->part[1] + sum->part[0] / unit, high = sum->part[2] + middle / unit,
                  top = high / split;
    /* parts below and above 2^84: rounded once, unless both exist */
    const double low = (double)(middle % unit * unit + sum->part[0] % unit),
                 below = (double)(high % split) * 0x1p52 + low, above = (double)top * 0x1p84;
    return (above + below) * unit_of(sum->level);
}

/* ---- loops ---- */

typedef struct rows {
    int64_t n;
    int32_t ranges;
    mps_exact_fn body;
    void *argument;
    const mps_exact_values *values;
    mps_exact sum[MPS_PARALLEL_PARTS][MPS_PARALLEL_VALUES];
    double maximum[MPS_PARALLEL_PARTS][MPS_PARALLEL_VALUES];
} rows;

static void run_range(void *argument, int32_t range)
{
    rows *r = argument;
    const mps_exact_values *v = r->values;
    /* local: avoids false sharing of cache lines between threads */
    mps_exact sum[MPS_PARALLEL_VALUES] = {0};
    double maximum[MPS_PARALLEL_VALUES] = {0};
    if (v->maxima > 0) memcpy(maximum, v->maximum, (size_t)v->maxima * sizeof *maximum);
    r->body(r->argument, r->n * range / r->ranges, r->n * (range + 1) / r->ranges, sum, maximum);
    memcpy(r->sum[range], sum, sizeof sum);
    memcpy(r->maximum[range], maximum, sizeof maximum);
}

void mps_exact_rows(const mps_parallel *p, int64_t n, int64_t least, mps_exact_fn body,
                    void *argument, const mps_exact_values *values)
{
    const int64_t threads = p && p->run ? p->threads : 1,
                  wanted = threads > 1 ? threads * MPS_PARALLEL_RANGES : 1,
                  most = wanted < MPS_PARALLEL_PARTS ? wanted : MPS_PARALLEL_PARTS,
                  ranges = n / least < most ? n / least : most;
    if (ranges <= 1) {
        if (n > 0) body(argument, 0, n, values->sum, values->maximum);
        return;
    }
    rows r; /* not initialised: it is large */
    r.n = n;
    r.ranges = (int32_t)ranges;
    r.body = body;
    r.argument = argument;
    r.values = values;
    mps_parallel_run(p, r.ranges, run_range, &r);
    for (int32_t range = 0; range < r.ranges; range++) {
        for (int32_t k = 0; k < values->sums; k++)
            mps_exact_join(&values->sum[k], &r.sum[range][k]);
        for (int32_t k = 0; k < values->maxima; k++)
            if (r.maximum[range][k] > values->maximum[k]) values->maximum[k] = r.maximum[range][k];
    }
}

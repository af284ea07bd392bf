/* SPDX-License-Identifier: BSD-3-Clause */
/* Finds tables whose spline has accelerations that the motion has not: coarse or noisy rows, and
 * velocities that jump from row to row. */
#include "ship_motion.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { ROWS_LEAST = 8, TEXT = 32 };

/* Accelerations at the corners of the tank below this fraction of gravity are negligible. */
static const double NOTHING = 1e-3;
/* Noise: the sum of products of neighbouring second differences is below this fraction of the sum
 * of their squares; 1: smooth, -2/3: white noise, 0: four rows per period. */
static const double ALTERNATES = -0.1;
/* A jump: a change of velocity of this fraction of the range of velocities, while its neighbours
 * change by less than BESIDE times as much. */
static const double JUMP = 0.1, BESIDE = 0.35;
/* The suggested cut-off is the frequency of the motion times ABOVE[0], or times ABOVE[1] if that
 * passes PASSES times smaller accelerations. */
static const double ABOVE[2] = {10, 5}, PASSES = 1.5;

/* One degree of freedom of the table over the run: rows first .. last. */
typedef struct signal {
    build *b;
    const build_motion *m;
    const tree_node *node;
    int32_t degree;
    int64_t first, last;
    double *second; /* [rows] of the spline */
    double *work;   /* [rows] */
    double factor;  /* to degrees, or 1 */
    double reach;   /* distance from the centre to the corners of the tank [m], or 1 */
    const char *unit;
} signal;

static double value(const signal *s, int64_t i)
{
    return s->m->column[6 * i + s->degree];
}

static double slope(const signal *s, int64_t i)
{
    return (value(s, i + 1) - value(s, i)) / (s->m->t[i + 1] - s->m->t[i]);
}

/* Change of velocity at a row between its two neighbours. */
static double change(const signal *s, int64_t i)
{
    return slope(s, i) - slope(s, i - 1);
}

static double largest(const signal *s, const double *second)
{
    double most = 0;
    for (int64_t i = s->first; i <= s->last; i++) most = fmax(most, fabs(second[i]));
    return most;
}

static const char *amount(const signal *s, double x, const char *per, char out[TEXT])
{
    snprintf(out, TEXT, "%.3g %s%s", s->factor * x, s->unit, per);
    return out;
}

/* Frequency of the motion [Hz], from crossings of its mean with a hysteresis of a tenth of its
 * range, two per period. */
static double frequency(const signal *s)
{
    const double *t = s->m->t, span = t[s->last] - t[s->first],
                 rise = (value(s, s->last) - value(s, s->first)) / span;
    double mean = 0, most = 0;
    int side = 0, passes = 0;
    const int64_t count = s->last - s->first + 1;
    for (int64_t i = s->first; i <= s->last; i++)
        mean += (value(s, i) - rise * t[i]) / (double)count;
    for (int64_t i = s->first; i <= s->last; i++)
        most = fmax(most, fabs(value(s, i) - rise * t[i] - mean));
    for (int64_t i = s->first; i <= s->last; i++) {
        const double way = value(s, i) - rise * t[i] - mean;
        const int now = way > 0.1 * most ? 1 : way < -0.1 * most ? -1 : side;
        passes += side && now != side;
        side = now;
    }
    return fmax(passes, 1) / (2 * span);
}

/* Smallest difference of unequal neighbouring rows: the resolution of a log. */
static double resolution(const signal *s)
{
    double least = INFINITY;
    for (int64_t i = s->first; i < s->last; i++) {
        const double step = fabs(value(s, i + 1) - value(s, i));
        if (step > 1e-9 * fabs(value(s, i))) least = fmin(least, step);
    }
    return least;
}

/* @return whether the accelerations are those of noise */
static bool find_noise(const signal *s)
{
    double product = 0, square = 0;
    for (int64_t i = s->first + 1; i < s->last; i++) {
        square += change(s, i) * change(s, i);
        if (i + 1 < s->last) product += change(s, i) * change(s, i + 1);
    }
    const double most = largest(s, s->second);
    if (!(product < ALTERNATES * square) || !(most * s->reach > NOTHING * s->b->gravity))
        return false;
    double hz[2], left[2];
    char text[3][TEXT];
    for (int k = 0; k < 2; k++) {
        const double above = ABOVE[k] * frequency(s), digit = pow(10, floor(log10(above)) - 1);
        hz[k] = round(above / digit) * digit; /* two digits */
        if (!mps__motion_spline(s->b, s->m, s->degree, hz[k], s->second, s->work)) return true;
        left[k] = largest(s, s->second);
    }
    const int k = left[0] > PASSES * left[1];
    mps__case_log(s->b->c, s->node, true,
                  "motion.file: %s: its velocity changes to and fro from row to row: noise or the "
                  "resolution of the file, %s, gives accelerations of %s; 'cutoff: %g Hz', %g "
                  "times the frequency of the motion, leaves %s",
                  mps__degrees[s->degree], amount(s, resolution(s), "", text[0]),
                  amount(s, most, "/s2", text[1]), hz[k], ABOVE[k],
                  amount(s, left[k], "/s2", text[2]));
    return true;
}

static bool is_jump(const signal *s, int64_t i, double range)
{
    const double here = fabs(change(s, i));
    return here > JUMP * range && fabs(change(s, i - 1)) < BESIDE * here &&
           fabs(change(s, i + 1)) < BESIDE * here &&
           fabs(s->second[i]) * s->reach > 10 * NOTHING * s->b->gravity;
}

/* Difference between the largest values of the spline and of the rows of the run. */
static double overshoot(const signal *s)
{
    double most = 0;
    for (int64_t i = s->first; i <= s->last; i++) most = fmax(most, fabs(value(s, i)));
    return s->m->largest[s->degree][0] - most;
}

static void find_jump(const signal *s)
{
    double low = INFINITY, high = -INFINITY;
    int64_t at = -1, jumps = 0;
    for (int64_t i = s->first; i < s->last; i++) {
        low = fmin(low, slope(s, i));
        high = fmax(high, slope(s, i));
    }
    for (int64_t i = s->first + 2; i + 2 <= s->last; i++) {
        if (!is_jump(s, i, high - low)) continue;
        jumps++;
        if (at < 0 || fabs(s->second[i]) > fabs(s->second[at])) at = i;
    }
    if (at < 0) return;
    char text[3][TEXT], more[64] = "", beyond[64] = "";
    const double passes = overshoot(s);
    if (jumps > 1) snprintf(more, sizeof more, " and at %lld other rows", (long long)jumps - 1);
    if (passes > 1e-3 * s->m->largest[s->degree][0])
        snprintf(beyond, sizeof beyond, " and passes the rows by %s",
                 amount(s, passes, "", text[2]));
    mps__case_log(s->b->c, s->node, true,
                  "motion.file: %s: the velocity jumps by %s at t = %.6g s%s: the spline between "
                  "the rows makes an acceleration of %s of it%s; give closer rows there, or "
                  "'cutoff'",
                  mps__degrees[s->degree], amount(s, fabs(change(s, at)), "/s", text[0]),
                  s->m->t[at], more, amount(s, fabs(s->second[at]), "/s2", text[1]), beyond);
}

double mps__motion_reach(const build *b, const build_motion *m)
{
    double square = 0;
    for (int d = 0; d < b->dim; d++) {
        const double r = fmax(fabs(b->tank.form.lo[d] - m->centre[d]),
                              fabs(b->tank.form.hi[d] - m->centre[d]));
        square += r * r;
    }
    return sqrt(square);
}

void mps__motion_diagnose(build *b, build_motion *m, const tree_node *map)
{
    signal s = {.b = b, .m = m, .node = mps__tree_find(map, "file"), .last = m->rows - 1};
    while (s.first + 1 < m->rows && m->t[s.first + 1] <= 0) s.first++;
    while (s.last > 0 && m->t[s.last - 1] >= b->until) s.last--;
    if (m->rows < 1 || s.last - s.first < ROWS_LEAST) return;
    s.second = malloc(2 * (size_t)m->rows * sizeof *s.second);
    if (!s.second) {
        b->status = MPS_E_NOMEM;
        return;
    }
    s.work = s.second + m->rows;
    for (s.degree = 0; s.degree < MOTION_DEGREES; s.degree++) {
        const bool turn = s.degree >= MPS_SHIP_ROLL;
        s.factor = turn ? 180 / acos(-1.0) : 1;
        s.reach = turn ? mps__motion_reach(b, m) : 1;
        s.unit = turn ? "deg" : "m";
        if (!m->used[s.degree] || !mps__motion_spline(b, m, s.degree, 0, s.second, NULL)) continue;
        if (find_noise(&s))
            m->noisy = true;
        else
            find_jump(&s);
    }
    free(s.second);
}

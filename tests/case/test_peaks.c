/* SPDX-License-Identifier: BSD-3-Clause */
/* Times of frames about the highest peaks, from rows alone. */
#include "peaks.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

static const double DT = 1e-3, STATIC = 2000;
enum { IMPACTS = 12, FRAMES = 4000, STEEP = 5 };

/* Heights in no order; the impact k is at t = 0.5 + k, and as a triangle rises within RISE. */
static const double HEIGHT[IMPACTS] = {500, 3000, 900,  8000, 1200, 7000,
                                       400, 650,  9000, 300,  5000, 800};
static const double RISE[IMPACTS] = {.01, .02, .1, .004, .2, .01, .05, .01, .03, .01, .008, .02};

static double pressure_at(double t)
{
    const int k = (int)t;
    if (k < 0 || k >= IMPACTS) return STATIC;
    const double off = t - k - 0.5, rise = RISE[k],
                 slope = off < 0 ? 1 + off / rise : 1 - off / (2 * rise);
    return STATIC + HEIGHT[k] * fmax(0, slope) + 100 * sin(2 * 3.14159265 * t);
}

/* Frames as a run writes them at its steps, which are longer than a row. */
typedef struct series {
    int count, written, most;
    double t[FRAMES];
} series;

static void remove_others(series *s, const peaks *p)
{
    int kept = 0;
    for (int k = 0; k < s->count; k++)
        if (mps__peaks_wants(p, s->t[k])) s->t[kept++] = s->t[k];
    s->count = kept;
}

static void take_rows(peaks *p, series *s, int from, int to)
{
    for (int k = from; k < to; k++) {
        const double row[2] = {DT * k, pressure_at(DT * k)};
        mps__peaks_row(p, row);
        if (k % 2 || !s) continue; /* a step of two rows */
        if (p->due) s->t[s->count++] = row[0] + 0.3 * DT, s->written++;
        if (s->count > s->most) s->most = s->count;
        p->due = false;
        if (p->changed) remove_others(s, p);
        p->changed = false;
    }
}

static void begin(peaks *p, int most)
{
    mps__peaks_init(p, most, 0.06, 0.07, 2 * DT);
    mps__peaks_add(p, 1);
}

static double nearest(const series *s, double t)
{
    double off = INFINITY;
    for (int k = 0; k < s->count; k++) off = fmin(off, fabs(s->t[k] - t));
    return off;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x < y) - (x > y);
}

/* The five highest peaks, in any order, have frames within a fraction of their rise; others have
 * none. */
static void highest_have_frames(void **state)
{
    static series s;
    peaks p;
    double sorted[IMPACTS];
    (void)state;
    s = (series){0};
    begin(&p, STEEP);
    take_rows(&p, &s, 0, 12000);
    remove_others(&s, &p);
    memcpy(sorted, HEIGHT, sizeof sorted);
    qsort(sorted, IMPACTS, sizeof *sorted, compare);
    for (int k = 0; k < IMPACTS; k++) {
        const double off = nearest(&s, 0.5 + k);
        if (HEIGHT[k] >= sorted[STEEP - 1])
            assert_true(off <= fmax(0.2 * RISE[k], 1.5 * DT));
        else
            assert_true(off > 0.3);
    }
    assert_in_range(s.count, 3 * STEEP, 9 * STEEP);
    assert_in_range(s.most, s.count, 9 * STEEP + 40); /* what is kept at a time is bounded */
    assert_in_range(s.written, s.count, 400);         /* of 6000 steps */
}

/* A run that is resumed at any row has the same frames: frames of earlier rows are determined from
 * the rows. */
static void goes_on_anywhere(void **state)
{
    static series whole, part;
    peaks p;
    (void)state;
    whole = (series){0};
    begin(&p, STEEP);
    take_rows(&p, &whole, 0, 12000);
    remove_others(&whole, &p);
    for (int stop = 400; stop < 12000; stop += 982) {
        part = (series){0};
        begin(&p, STEEP);
        take_rows(&p, &part, 0, stop);
        begin(&p, STEEP);
        take_rows(&p, NULL, 0, stop);
        p.due = false;
        take_rows(&p, &part, stop, 12000);
        remove_others(&part, &p);
        assert_int_equal(part.count, whole.count);
        assert_memory_equal(part.t, whole.t, (size_t)whole.count * sizeof *whole.t);
    }
}

/* Still water, values that are unknown, none wanted, many pressures. */
static void others(void **state)
{
    peaks p;
    double row[1 + PEAKS_SIGNALS + 4] = {0};
    (void)state;
    begin(&p, 0);
    assert_int_equal(p.signals, 0);
    begin(&p, 3);
    for (int k = 0; k < 1000; k++) {
        row[0] = DT * k;
        row[1] = k % 7 ? STATIC : NAN;
        mps__peaks_row(&p, row);
    }
    assert_false(p.due || p.changed || mps__peaks_wants(&p, 0.5));
    begin(&p, 10);
    for (int k = 2; k < PEAKS_SIGNALS + 4; k++) mps__peaks_add(&p, k);
    assert_int_equal(p.signals, PEAKS_SIGNALS);
    assert_int_equal(p.most, PEAKS_ALL / PEAKS_SIGNALS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(highest_have_frames),
                                       cmocka_unit_test(goes_on_anywhere),
                                       cmocka_unit_test(others)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

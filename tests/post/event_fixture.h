/* SPDX-License-Identifier: BSD-3-Clause */
/* Signals of triangles, and their events. */
#ifndef EVENT_FIXTURE_H
#define EVENT_FIXTURE_H

#include "stats_fixture.h"

enum { TRIANGLES = 100 };
static const double DT = 0.01, GAP = 5, THRESHOLD = 10;

/* ---- a signal of triangles on a base of 0 ---- */

typedef struct triangle {
    double t, peak, rise, decay;
} triangle;

typedef struct signal {
    int64_t n;
    double *t, *p;
} signal;

static inline double height(const triangle *all, int count, double t)
{
    for (int k = 0; k < count; k++) {
        const double x = t - all[k].t;
        if (x > -all[k].rise && x <= 0) return all[k].peak * (1 + x / all[k].rise);
        if (x > 0 && x < all[k].decay) return all[k].peak * (1 - x / all[k].decay);
    }
    return 0;
}

static inline signal new_signal(int64_t n)
{
    signal s = {n, calloc((size_t)n + 1, sizeof *s.t), calloc((size_t)n + 1, sizeof *s.p)};
    assert_true(s.t && s.p);
    return s;
}

static inline void free_signal(signal *s)
{
    free(s->t);
    free(s->p);
}

static inline signal sample_triangles(const triangle *all, int count, double dt, double end)
{
    signal s = new_signal((int64_t)(end / dt + 1.5));
    for (int64_t k = 0; k < s.n; k++) {
        s.t[k] = (double)k * dt;
        s.p[k] = height(all, count, s.t[k]);
    }
    return s;
}

/* Corners on samples, or anywhere. */
static inline void make_triangles(triangle *all, bool on_samples, uint64_t seed)
{
    for (int k = 0; k < TRIANGLES; k++) {
        triangle *a = &all[k];
        a->peak = 20 + 480 * draw(&seed);
        a->rise = 0.2 + 0.6 * draw(&seed);
        a->decay = 0.2 + 1.2 * draw(&seed);
        a->t = GAP * (k + 1) + 0.5 * draw(&seed);
        if (!on_samples) continue;
        a->rise = DT * round(a->rise / DT);
        a->decay = DT * round(a->decay / DT);
        a->t = DT * round(a->t / DT);
    }
}

static inline mps_stats_config event_config(void)
{
    mps_stats_config config = new_config();
    config.threshold = THRESHOLD;
    config.window = 1;
    config.resamples = 20;
    return config;
}

static inline mps_impacts *find(const mps_stats_config *config, const signal *s)
{
    mps_impacts *impacts = NULL;
    ASSERT_DONE(mps_impacts_find(config, s->n, s->t, s->p, &impacts));
    return impacts;
}

static inline mps_impacts_info info_of(const mps_impacts *impacts)
{
    mps_impacts_info info;
    assert_int_equal(mps_impacts_info_init(&info, sizeof info), MPS_OK);
    assert_int_equal(mps_impacts_info_get(impacts, &info), MPS_OK);
    return info;
}

static inline mps_impact event_of(const mps_impacts *impacts, int64_t index)
{
    mps_impact event;
    assert_int_equal(mps_impact_init(&event, sizeof event), MPS_OK);
    assert_int_equal(mps_impacts_get(impacts, index, &event), MPS_OK);
    return event;
}

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* All results of one signal: events, their ranks, exceedance with its band, fits. */
#include "statistics.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

mps_status mps_impact_init(mps_impact *impact, size_t size)
{
    return mps__stats_init(impact, size, NULL, sizeof *impact);
}

mps_status mps_impacts_info_init(mps_impacts_info *info, size_t size)
{
    return mps__stats_init(info, size, NULL, sizeof *info);
}

mps_status mps_exceedance_init(mps_exceedance *point, size_t size)
{
    return mps__stats_init(point, size, NULL, sizeof *point);
}

mps_status mps_panel_mean(const mps_stats_config *config, int32_t cells, int64_t n,
                          const double *const *p, double *mean)
{
    MPS__STATS_TRY(mps__stats_check(config));
    MPS__STATS_CHECK(config, cells >= 1, "cells is %d: must be >= 1", (int)cells);
    MPS__STATS_CHECK(config, n >= 0, "n is %lld: must be >= 0", (long long)n);
    MPS__STATS_CHECK(config, p && mean, "%s is NULL", p ? "mean" : "p");
    for (int32_t c = 0; c < cells; c++)
        MPS__STATS_CHECK(config, p[c] || n == 0, "p[%d] is NULL", (int)c);
    for (int64_t k = 0; k < n; k++) {
        double sum = 0;
        for (int32_t c = 0; c < cells; c++) sum += p[c][k];
        mean[k] = sum / cells;
    }
    return MPS_OK;
}

/* ---- ranks and exceedance ---- */

/* Whether event a is after event b in the order of ranks. */
static bool ranks_after(const mps_impact *event, int64_t a, int64_t b)
{
    return event[a].peak != event[b].peak ? event[a].peak < event[b].peak : a > b;
}

/* Sift rank[at] down in the heap of n ranks until no child is after it. */
static void sink(const mps_impact *event, int64_t *rank, int64_t at, int64_t n)
{
    const int64_t index = rank[at];
    for (int64_t child = 2 * at + 1; child < n; child = 2 * at + 1) {
        if (child + 1 < n && ranks_after(event, rank[child + 1], rank[child])) child++;
        if (!ranks_after(event, rank[child], index)) break;
        rank[at] = rank[child];
        at = child;
    }
    rank[at] = index;
}

/* Heapsort: qsort() may allocate memory. */
static void sort_ranks(const mps_impact *event, int64_t n, int64_t *rank)
{
    for (int64_t k = 0; k < n; k++) rank[k] = k;
    for (int64_t at = n / 2 - 1; at >= 0; at--) sink(event, rank, at, n);
    for (int64_t last = n - 1; last > 0; last--) {
        const int64_t lowest = rank[0];
        rank[0] = rank[last];
        rank[last] = lowest;
        sink(event, rank, 0, last);
    }
}

static mps_status find_ranks(const mps_stats_config *config, mps_impacts *s)
{
    const size_t n = (size_t)s->info.events;
    s->rank = calloc(n + 1, sizeof *s->rank);
    s->point = calloc(n + 1, sizeof *s->point);
    if (!s->rank || !s->point) return mps__stats_no_memory(config);
    sort_ranks(s->event, s->info.events, s->rank);
    for (size_t k = 0; k < n; k++)
        s->point[k] = (mps_exceedance){.struct_size = sizeof(mps_exceedance),
                                       .peak = s->event[s->rank[k]].peak,
                                       .share = (double)(k + 1) / (double)(n + 1)};
    return MPS_OK;
}

/* The true exceedance of the i-th largest of N independent peaks has the distribution beta(i, N - i
 * + 1) for any distribution of peaks. */
static void find_point_bands(const mps_stats_config *config, mps_impacts *s)
{
    const int64_t n = s->info.events;
    for (int64_t i = 1; i <= n; i++)
        for (int b = 0; b < 2; b++) {
            const double q = 0.5 * (1 + (b ? config->confidence : -config->confidence));
            s->point[i - 1].band[b] = mps__beta_inverse((double)i, (double)(n - i + 1), q);
        }
}

/* ---- the signal as a whole ---- */

static double correlation(const mps_impacts *s)
{
    const int64_t n = s->info.events;
    double mean = 0, both = 0, square = 0;
    for (int64_t k = 0; k < n; k++) mean += s->event[k].peak / (double)n;
    for (int64_t k = 0; k < n; k++) {
        const double a = s->event[k].peak - mean;
        square += a * a;
        if (k + 1 < n) both += a * (s->event[k + 1].peak - mean);
    }
    return n >= 3 && square > 0 ? both / square : NAN;
}

static void find_info(const mps_stats_config *config, const mps__signal *signal, mps_impacts *s)
{
    mps_impacts_info *info = &s->info;
    info->samples = signal->n;
    info->missing = signal->missing;
    info->t_first = signal->n > 0 ? signal->t[0] : NAN;
    info->t_last = signal->n > 0 ? signal->t[signal->n - 1] : NAN;
    const double length = signal->n > 0 ? info->t_last - info->t_first : 0;
    for (int64_t k = 0; k < info->events; k++) info->unresolved += s->event[k].unresolved;
    info->rate = length > 0 ? (double)info->events / length : 0;
    info->correlation = correlation(s);
    info->correlation_limit = info->events > 0 ? config->dependence / sqrt((double)info->events)
                                               : NAN;
    info->dependent = fabs(info->correlation) > info->correlation_limit;
    info->time_scale = sqrt(config->length_scale);
    info->pressure_scale = config->length_scale * config->density_ratio;
    info->exposure = config->exposure / info->time_scale;
    info->exposure_events = info->rate * info->exposure;
    info->long_exposure = info->exposure > config->exposure_ratio * length;
}

static mps_status find_fits(const mps_stats_config *config, mps_impacts *s)
{
    const int64_t n = s->info.events;
    double *peak = malloc(((size_t)n + 1) * sizeof *peak);
    if (!peak) return mps__stats_no_memory(config);
    for (int64_t k = 0; k < n; k++) peak[k] = s->event[k].peak;
    const double u = n > 0 ? s->info.threshold : 0, number = s->info.exposure_events;
    s->fit[0].struct_size = s->fit[1].struct_size = sizeof s->fit[0];
    mps_status status = mps_fit_weibull(config, n, peak, u, number, &s->fit[MPS_FIT_WEIBULL]);
    if (status == MPS_OK)
        status = mps_fit_pareto(config, n, peak, u, number, &s->fit[MPS_FIT_PARETO]);
    free(peak);
    return status;
}

static mps_status find_all(const mps_stats_config *config, const mps__signal *signal,
                           mps_impacts *s)
{
    s->config = *config;
    s->config.error = NULL;
    s->config.error_size = 0;
    s->info.struct_size = sizeof s->info;
    s->info.threshold = mps__signal_threshold(config, signal);
    s->info.window = isnan(config->window) ? config->window_share * config->period : config->window;
    MPS__STATS_CHECK(config, !isnan(s->info.window),
                     "'window' and 'period' are nan: give one of them [s]");
    MPS__STATS_TRY(mps__events_find(config, signal, s->info.threshold, s->info.window, &s->event,
                                    &s->info.events, &s->info.cut));
    find_info(config, signal, s);
    MPS__STATS_TRY(find_ranks(config, s));
    find_point_bands(config, s);
    return find_fits(config, s);
}

mps_status mps_impacts_find(const mps_stats_config *config, int64_t n, const double *t,
                            const double *p, mps_impacts **impacts)
{
    mps__signal signal;
    if (impacts) *impacts = NULL;
    MPS__STATS_TRY(mps__stats_check(config));
    MPS__STATS_CHECK(config, impacts, "impacts is NULL");
    MPS__STATS_TRY(mps__signal_make(config, n, t, p, &signal));
    mps_impacts *s = calloc(1, sizeof *s);
    const mps_status status = s ? find_all(config, &signal, s) : mps__stats_no_memory(config);
    free(signal.t);
    if (status == MPS_OK)
        *impacts = s;
    else
        mps_impacts_destroy(s);
    return status;
}

void mps_impacts_destroy(mps_impacts *impacts)
{
    if (!impacts) return;
    free(impacts->event);
    free(impacts->rank);
    free(impacts->point);
    free(impacts);
}

/* ---- results ---- */

mps_status mps_impacts_info_get(const mps_impacts *impacts, mps_impacts_info *info)
{
    if (!impacts || !mps__stats_known(info, sizeof *info)) return MPS_E_ARG;
    mps__stats_out(info, &impacts->info, sizeof *info);
    return MPS_OK;
}

mps_status mps_impacts_get(const mps_impacts *impacts, int64_t index, mps_impact *impact)
{
    if (!impacts || !mps__stats_known(impact, sizeof *impact)) return MPS_E_ARG;
    if (index < 0 || index >= impacts->info.events) return MPS_E_ARG;
    mps__stats_out(impact, &impacts->event[index], sizeof *impact);
    return MPS_OK;
}

mps_status mps_impacts_highest(const mps_impacts *impacts, int64_t rank, mps_impact *impact)
{
    if (!impacts || rank < 0 || rank >= impacts->info.events) return MPS_E_ARG;
    return mps_impacts_get(impacts, impacts->rank[rank], impact);
}

mps_status mps_impacts_exceedance(const mps_impacts *impacts, int64_t rank, mps_exceedance *point)
{
    if (!impacts || !mps__stats_known(point, sizeof *point)) return MPS_E_ARG;
    if (rank < 0 || rank >= impacts->info.events) return MPS_E_ARG;
    mps__stats_out(point, &impacts->point[rank], sizeof *point);
    return MPS_OK;
}

mps_status mps_impacts_fit_get(const mps_impacts *impacts, int32_t kind, mps_fit *fit)
{
    if (!impacts || !mps__stats_known(fit, sizeof *fit)) return MPS_E_ARG;
    if (kind != MPS_FIT_WEIBULL && kind != MPS_FIT_PARETO) return MPS_E_ARG;
    mps__stats_out(fit, &impacts->fit[kind], sizeof *fit);
    return MPS_OK;
}

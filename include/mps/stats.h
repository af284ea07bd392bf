/* SPDX-License-Identifier: BSD-3-Clause */
/** @file stats.h  Statistics of impacts: events of a signal, distributions of their peaks, extreme
 *  values of an exposure, long-term statistics. Functions of libmps_case; they need no simulation.
 *
 *  Results are for screening: they rank designs and identify critical positions and conditions. A
 *  design load also needs tests or rules.
 *
 *  On failure a function changes no output; it only writes a text to mps_stats_config.error. The
 *  same input gives the same bytes. KR: guidance GC-17-E of the Korean Register, 2025. */
#ifndef MPS_STATS_H
#define MPS_STATS_H

#include <mps/series.h>

MPS_BEGIN_DECLS

/* ---- constants of a run ---- */

/** Read the constants of a run from summary.json in its folder: keys `impacts` of its case, T1 and
 *  the frequency of its motion. Defaults: `from` is 0.5 % of the run, `period` that of a box of the
 *  tank's length and the liquid's depth, T = 2 pi/sqrt(g k tanh(k h)) with k = pi/length, and
 *  `window` 2 % of the run if no period is known. `crossing_time` is the maximum of the run. A run
 *  in progress has no summary: constants that depend on the end of its probes.csv are set, all
 *  others remain unchanged.
 *  @param folder  that a run has written
 *  @param config  initialised; out. Unchanged on failure
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | an argument; a list of sensors that is too long |
 *  | MPS_E_IO | summary.json is not readable or no JSON; probes.csv, if it is needed |
 *  | MPS_E_NOMEM | no memory | */
MPS_API mps_status mps_stats_config_read(const char *folder, mps_stats_config *config);

/** Set a constant like `mps stats --set`: "impacts.threshold=6 kPa". The key is one of `impacts` of
 *  a case, with its units and its range; a time may be in T1, which is config.period. Call it after
 *  mps_stats_config_read() to change constants of the run.
 *  @param config  initialised; out. Unchanged on failure, but for the text of the error
 *  @param text    "impacts.KEY=VALUE"
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | an argument; no such key; the value, its unit or its range; T1 is unknown |
 *  | MPS_E_NOMEM | no memory | */
MPS_API mps_status mps_stats_config_set(mps_stats_config *config, const char *text);

/** A constant of the statistics of impacts. */
typedef struct mps_stats_constant {
    /** sizeof(mps_stats_constant), set by the caller. */
    uint32_t struct_size;
    /** Kept 0. */
    int32_t reserved;
    /** Key of a case, "impacts.threshold"; "T1" for the period; "": no key. */
    const char *key;
    /** Description. */
    const char *about;
    /** Unit of `value` in SI, "" for none. */
    const char *unit;
    /** Value [unit]. Non-finite: not set. */
    double value;
} mps_stats_constant;

/** Constant number `index` of a config, from 0, for lists of all of them. mps_stats_config.sensors
 *  is not included.
 *  @param constant  with its struct_size; out. Its texts are not freed
 *  @return MPS_E_ARG: beyond the last one; an argument */
MPS_API mps_status mps_stats_constant_get(const mps_stats_config *config, int32_t index,
                                          mps_stats_constant *constant);

/** @return 1: this sensor is selected: config.sensors contains it or is empty; 0: not selected, an
 *          argument is NULL or uninitialised, or config.sensors has no terminating 0 */
MPS_API int32_t mps_stats_wants(const mps_stats_config *config, const char *name);

/* ---- impacts ---- */

/** Mean over the cells of a panel, which have the same area (KR 303).
 *  @param cells  >= 1 @param p  [cells][n] @param mean  [n] out; nan if a cell is nan
 *  @return MPS_E_ARG */
MPS_API mps_status mps_panel_mean(const mps_stats_config *config, int32_t cells, int64_t n,
                                  const double *const *p, double *mean);

/** Impacts of one signal. */
typedef struct mps_impacts mps_impacts;

/** One event: an interval above the threshold. All values at the scale of the signal. */
typedef struct mps_impact {
    /** Set by mps_impact_init(), or sizeof(mps_impact). */
    uint32_t struct_size;
    /** 1: it rises or decays faster than mps_stats_config.crossing_time. */
    int32_t unresolved;
    /** P: vertex of the parabola through the largest sample and its neighbours, or the top of
     *  the triangle through them, whichever is lower [Pa]. */
    double peak;
    /** Time of P [s]. */
    double t;
    /** First upcrossing of the threshold [s]. */
    double begin;
    /** Last downcrossing of the threshold [s]. */
    double end;
    /** (t_P - t_s)/(1 - s), t_s the last upcrossing of s P before t_P [s]. NAN: outside of the
     *  record. */
    double rise;
    /** (t_s - t_P)/(1 - s), t_s the first downcrossing of s P after t_P [s]. NAN: outside of the
     *  record. */
    double decay;
    /** decay/rise. NAN if either is NAN. */
    double skewness;
    /** end - begin [s]. */
    double duration;
    /** Integral of p over the parts of the event at or above the threshold [Pa s]. */
    double impulse;
} mps_impact;

/** Set struct_size and zero. @param size  sizeof(mps_impact) @return MPS_E_ARG */
MPS_API mps_status mps_impact_init(mps_impact *impact, size_t size);

/** Statistics of a complete signal. */
typedef struct mps_impacts_info {
    /** Set by mps_impacts_info_init(), or sizeof(mps_impacts_info). */
    uint32_t struct_size;
    /** 1: D exceeds `exposure_ratio` times the length of the record; values are extrapolated. */
    int32_t long_exposure;
    /** 1: |correlation| > correlation_limit; bands are too narrow. */
    int32_t dependent;
    /** Kept 0. */
    int32_t reserved;
    /** Number of samples used. */
    int64_t samples;
    /** Number of samples ignored because they are nan. */
    int64_t missing;
    /** N. */
    int64_t events;
    /** Number of events excluded because their beginning or peak may be outside of the record. */
    int64_t cut;
    /** Number of unresolved events. */
    int64_t unresolved;
    /** u as used [Pa]. */
    double threshold;
    /** w as used [s]. */
    double window;
    /** First time of the samples [s]. */
    double t_first;
    /** Last time of the samples [s]. */
    double t_last;
    /** N over the length of the record [1/s]. */
    double rate;
    /** Correlation of each peak with the next. NAN: fewer than three peaks, or all equal. */
    double correlation;
    /** `dependence` over sqrt(N). */
    double correlation_limit;
    /** D/sqrt(L), the exposure at the scale of the signal [s]. */
    double exposure;
    /** Expected number of events during `exposure`: rate D/sqrt(L). */
    double exposure_events;
    /** Pressure at full scale over pressure of the signal: L times the ratio of densities. */
    double pressure_scale;
    /** Time at full scale over time of the signal: sqrt(L). */
    double time_scale;
} mps_impacts_info;

/** Set struct_size and zero. @param size  sizeof(mps_impacts_info) @return MPS_E_ARG */
MPS_API mps_status mps_impacts_info_init(mps_impacts_info *info, size_t size);

/** One peak in the plot of exceedance. */
typedef struct mps_exceedance {
    /** Set by mps_exceedance_init(), or sizeof(mps_exceedance). */
    uint32_t struct_size;
    /** Kept 0. */
    int32_t reserved;
    /** The i-th largest of the N peaks [Pa]. */
    double peak;
    /** Q = i/(N + 1): probability of exceedance. */
    double share;
    /** Confidence band of `share`: exact for independent peaks of any distribution. */
    double band[2];
} mps_exceedance;

/** Set struct_size and zero. @param size  sizeof(mps_exceedance) @return MPS_E_ARG */
MPS_API mps_status mps_exceedance_init(mps_exceedance *point, size_t size);

/** Find the impacts of a signal, fit both distributions, and store the results.
 *
 *  An event begins at the first crossing of u after w below u, and ends when p remains below u for
 *  w. An event has one peak, its largest sample. An event is excluded and counted as `cut` if it is
 *  preceded by less than w below u in the record, or if the record ends above u.
 *  @param n  number of samples, >= 0
 *  @param t  [n] times [s], strictly increasing
 *  @param p  [n] signal [Pa]; nan: unknown, ignored
 *  @param impacts  destroy it with mps_impacts_destroy(); NULL on failure
 *  @return MPS_E_ARG (which entry of `config`; index of an invalid time or value), MPS_E_NOMEM */
MPS_API mps_status mps_impacts_find(const mps_stats_config *config, int64_t n, const double *t,
                                    const double *p, mps_impacts **impacts);
/** Free it. NULL is allowed. */
MPS_API void mps_impacts_destroy(mps_impacts *impacts);

/** @param info  initialised; out @return MPS_E_ARG */
MPS_API mps_status mps_impacts_info_get(const mps_impacts *impacts, mps_impacts_info *info);

/** Event number `index` in the order of time. @param impact  initialised; out
 *  @return MPS_E_ARG: no such event */
MPS_API mps_status mps_impacts_get(const mps_impacts *impacts, int64_t index, mps_impact *impact);

/** Event with the `rank`-th highest peak, from 0. Equal peaks are in order of time.
 *  @param impact  initialised; out @return MPS_E_ARG: no such event */
MPS_API mps_status mps_impacts_highest(const mps_impacts *impacts, int64_t rank,
                                       mps_impact *impact);

/** Point number `rank` of the exceedance, from 0, the highest first. @param point  initialised; out
 *  @return MPS_E_ARG: no such point */
MPS_API mps_status mps_impacts_exceedance(const mps_impacts *impacts, int64_t rank,
                                          mps_exceedance *point);

/* ---- distributions ---- */

/** Kinds of distributions of peaks P above u. Q is the probability of exceedance of P. */
enum {
    /** Q = exp(-((P - u)/b)^c) (KR 306). scale: b, shape: c. */
    MPS_FIT_WEIBULL = 0,
    /** Q = (1 + x (P - u)/s)^(-1/x), generalised Pareto. scale: s, shape: x. */
    MPS_FIT_PARETO = 1
};

/** State and method of a fit. */
enum {
    /** No fit: fewer than mps_stats_config.least_events peaks above u. */
    MPS_FIT_FEW = 0,
    /** No fit: all peaks are equal. */
    MPS_FIT_SAME = 1,
    /** Maximum likelihood. */
    MPS_FIT_LIKELIHOOD = 2,
    /** Pareto: the likelihood has no maximum; probability-weighted moments instead. */
    MPS_FIT_MOMENTS = 3
};

/** A distribution fitted to peaks. */
typedef struct mps_fit {
    /** Set by mps_fit_init(), or sizeof(mps_fit). */
    uint32_t struct_size;
    /** MPS_FIT_WEIBULL or MPS_FIT_PARETO. */
    int32_t kind;
    /** MPS_FIT_FEW to MPS_FIT_MOMENTS. The numbers below are NAN without a fit. */
    int32_t state;
    /** Number of resamples of the bands. */
    int32_t resamples;
    /** Number of peaks above u. */
    int64_t count;
    /** u [Pa]. */
    double location;
    /** b or s [Pa]. */
    double scale;
    /** c or x. */
    double shape;
    /** Band of `scale`. NAN without resamples. */
    double scale_band[2];
    /** Band of `shape`. NAN without resamples. */
    double shape_band[2];
    /** s by probability-weighted moments; NAN for Weibull. */
    double moments_scale;
    /** x by probability-weighted moments; NAN for Weibull. */
    double moments_shape;
    /** Logarithm of the likelihood. */
    double log_likelihood;
    /** n: number of peaks for `value`. */
    double number;
    /** Exceeded once in n peaks on average [Pa]: mps_fit_value(). */
    double value;
    /** Band of `value` [Pa]. */
    double value_band[2];
} mps_fit;

/** Set struct_size and zero. @param size  sizeof(mps_fit) @return MPS_E_ARG */
MPS_API mps_status mps_fit_init(mps_fit *fit, size_t size);

/** Fit a Weibull distribution by maximum likelihood. Bands are those of samples from the fitted
 *  distribution (parametric bootstrap); they do not include the uncertainty of u or of the type of
 *  distribution. Peaks equal to u are ignored.
 *  @param count   number of peaks, >= 0
 *  @param peaks   [count] finite, none below u [Pa]
 *  @param u       threshold [Pa]
 *  @param number  n of mps_fit.value; 0: no value
 *  @param fit     initialised; out
 *  @return MPS_E_ARG (index of the peak), MPS_E_NOMEM. Too few peaks are no error: mps_fit.state */
MPS_API mps_status mps_fit_weibull(const mps_stats_config *config, int64_t count,
                                   const double *peaks, double u, double number, mps_fit *fit);

/** Fit a generalised Pareto distribution, as mps_fit_weibull(). The search starts from
 *  probability-weighted moments and is limited to x > -1. */
MPS_API mps_status mps_fit_pareto(const mps_stats_config *config, int64_t count,
                                  const double *peaks, double u, double number, mps_fit *fit);

/** Fit of mps_impacts_find(). `number` is mps_impacts_info.exposure_events.
 *  @param kind  MPS_FIT_WEIBULL or MPS_FIT_PARETO @param fit  initialised; out
 *  @return MPS_E_ARG */
MPS_API mps_status mps_impacts_fit_get(const mps_impacts *impacts, int32_t kind, mps_fit *fit);

/** Value that n peaks exceed once on average [Pa]: u + b (ln n)^(1/c); u + s/x (n^x - 1). It is
 *  the most probable maximum of n peaks. Needs kind, state, location, scale and shape of `fit`.
 *  NAN: no fit, or n < 1. */
MPS_API double mps_fit_value(const mps_fit *fit, double n);

/** Probability of exceedance of P: 1 for P <= u. NAN: no fit. */
MPS_API double mps_fit_exceedance(const mps_fit *fit, double P);

/** One condition of the long-term statistics: a fill level, a heading, a sea state (KR 307). */
typedef struct mps_condition {
    /** Set by mps_condition_init(), or sizeof(mps_condition). */
    uint32_t struct_size;
    /** Kept 0. */
    int32_t reserved;
    /** Fraction of the time, >= 0. The sum of all fractions is at most 1. */
    double share;
    /** Impacts per time at full scale, >= 0 [1/s]. */
    double rate;
    /** Distribution of peaks at full scale; ignored if share or rate is 0. */
    const mps_fit *fit;
} mps_condition;

/** Set struct_size and zero. @param size  sizeof(mps_condition) @return MPS_E_ARG */
MPS_API mps_status mps_condition_init(mps_condition *condition, size_t size);

/** Long-term probability of exceedance of P: sum of share rate/R Q(P), R the sum of share rate.
 *  @param rate  R [1/s]; out, or NULL @return MPS_E_ARG: a condition; R = 0 */
MPS_API mps_status mps_long_term_exceedance(const mps_stats_config *config, int32_t count,
                                            const mps_condition *conditions, double P,
                                            double *share, double *rate);

/** Value exceeded once in `time` on average in the long term [Pa].
 *  @param time   [s] at full scale
 *  @param value  out; NAN if fewer than one impact is expected @return MPS_E_ARG */
MPS_API mps_status mps_long_term_value(const mps_stats_config *config, int32_t count,
                                       const mps_condition *conditions, double time, double *value);

/* ---- texts ---- */

/** Format a quantity as in report.html: three digits and a unit with a prefix, "33.3 kPa", "65 mm".
 *  @param unit    of `value` in SI: "Pa", "s", "Pa s"; "" for none
 *  @param buffer  [size] out, null-terminated; may be NULL if size is 0
 *  @return length of the complete text without the terminating 0; if it is `size` or more, the text
 *          is truncated. 0: `unit` is NULL */
MPS_API size_t mps_quantity_write(double value, const char *unit, char *buffer, size_t size);

/** Events of several signals as CSV, in the order of time, at the scale of the signals: sensor,
 *  t[s], peak[Pa], rise[s], decay[s], skewness, duration[s], impulse[Pa s], rank, unresolved.
 *  @param names   [count] of the signals
 *  @param buffer  [size] out, null-terminated; may be NULL if size is 0
 *  @return length of the complete text without the terminating 0; if it is `size` or more, the text
 *          is truncated. 0: an argument is NULL or negative, or out of memory */
MPS_API size_t mps_stats_csv_write(int32_t count, const char *const *names,
                                   const mps_impacts *const *impacts, char *buffer, size_t size);

/** The statistics of several signals as JSON: all constants, and for each signal info, the
 *  `highest` highest events, both fits, exceedance with its band. Unknown numbers are null.
 *  Parameters and result: as mps_stats_csv_write(). */
MPS_API size_t mps_stats_json_write(int32_t count, const char *const *names,
                                    const mps_impacts *const *impacts, int64_t highest,
                                    char *buffer, size_t size);

/* ---- repeated runs ---- */

/** Peaks of one event of the first run in all runs: in each other run the highest event within
 *  `window` of its time. A run without such an event has no value.
 *  @param runs   >= 1 @param impacts  [runs]
 *  @param index  of the event in the first run
 *  @param r      initialised; out
 *  @return MPS_E_ARG, MPS_E_NOMEM */
MPS_API mps_status mps_repeat_peaks(const mps_stats_config *config, int32_t runs,
                                    const mps_impacts *const *impacts, int64_t index,
                                    mps_repeat *r);

MPS_END_DECLS

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/** @file series.h  Time series: constants of all statistics, columns of files, harmonics,
 *  comparison, order of convergence, repeated runs. Functions of libmps_case; they need no
 *  simulation. On failure a function changes no output; it only writes a text to
 *  mps_stats_config.error. The same input gives the same bytes. KR: guidance GC-17-E of the Korean
 *  Register, 2025. */
#ifndef MPS_SERIES_H
#define MPS_SERIES_H

#include <mps/types.h>
#include <stddef.h>

MPS_BEGIN_DECLS

/* ---- all constants ---- */

/** All constants of the definitions below. Initialise it with mps_stats_config_init(). */
typedef struct mps_stats_config {
    /** Set by mps_stats_config_init(). */
    uint32_t struct_size;
    /** Number of resamples (bootstrap) of a band, 0 (no bands) to 1000000. Default 1000. */
    int32_t resamples;
    /** [error_size] out: reason of a failure; NULL (default): no text. */
    char *error;
    /** Size of `error` [bytes]. */
    size_t error_size;
    /** Samples before this time are not used [s]. Default -INFINITY: all are. */
    double from;
    /** Samples after this time are not used [s]. Default INFINITY. */
    double until;
    /** Sampling rate of the signal [1/s], linear interpolation between samples. Default 0: original
     *  samples. */
    double rate;
    /** Frequency of a one-pole high-pass [1/s]. Default 0: off. */
    double high_pass;
    /** u: an event is at or above it [Pa]. Default NAN: mean plus `deviations` standard deviations
     *  of the signal, for a first overview; set a value for final results. */
    double threshold;
    /** See `threshold`. Default 2. */
    double deviations;
    /** w: an event ends when p remains below u for w [s], >= 0. Default NAN: `window_share` times
     *  `period`. */
    double window;
    /** See `window`. Default 0.2. */
    double window_share;
    /** Natural period of the liquid, or period of the motion [s]. Default NAN: unknown. */
    double period;
    /** s: rise and decay are measured between s P and P, 0 < s < 1. Default 0.5 (KR 202). */
    double share;
    /** Shortest time that the simulation resolves, mps_step_info.crossing_time [s]. Events that
     *  rise or decay faster are marked as unresolved. Default 0: unknown. */
    double crossing_time;
    /** Minimum number of events of a fit, >= 2. Default 30. */
    int32_t least_events;
    /** Kept 0. */
    int32_t reserved;
    /** Seed of the resamples. The same seed gives the same bands. Default 1. */
    uint64_t seed;
    /** Confidence level c of bands, from resamples or Student's distribution, 0 < c < 1. Default
     *  0.9. */
    double confidence;
    /** D: exposure at full scale [s]. Default 10800: 3 hours. */
    double exposure;
    /** A warning is given if D exceeds this multiple of the length of the record. Default 3. */
    double exposure_ratio;
    /** Peaks are regarded as dependent if |correlation| exceeds this over sqrt(N). Default 2: 95
     *  %. */
    double dependence;
    /** L: length at full scale over length of the model (Froude scaling). Default 1. */
    double length_scale;
    /** Density at full scale over density of the model. Default 1. */
    double density_ratio;
    /** Largest shift that mps_series_compare() tries [s]. Default NAN: half of `period`, or a
     *  quarter of the common time. */
    double shift_most;
    /** Minimum order that mps_converge() accepts. Default 0.5. */
    double order_least;
    /** Upper bound of the order; larger orders are replaced by it. Default 2. */
    double order_most;
    /** Safety factor: band over the error, if the order is accepted. Default 1.25. */
    double safety;
    /** Safety factor otherwise: band over the largest difference between two values. Default 3. */
    double safety_poor;
    /** Angular frequency of the tank's motion [rad/s]: the fundamental, of which all its harmonics
     *  are multiples. Default NAN: unknown, or none. */
    double omega;
    /** Selected sensors, names separated by "; ", null-terminated. Default "": all pressures. See
     *  mps_stats_wants(). */
    char sensors[512];
} mps_stats_config;

/** Set every entry to its default. @param size  sizeof(mps_stats_config) @return MPS_E_ARG */
MPS_API mps_status mps_stats_config_init(mps_stats_config *config, size_t size);

/* ---- tables in files ---- */

/** Columns of a CSV file in memory. */
typedef struct mps_table mps_table;

/** Read columns of a CSV file such as probes.csv. The first line has the names, with units in
 *  brackets: "t[s],P1[Pa]". The first column is the time, strictly increasing. An incomplete last
 *  line is ignored, because a run may still be writing it. Numbers may be nan.
 *  @param count  number of `names`; 0: all columns
 *  @param names  [count] with or without the unit
 *  @param table  destroy it with mps_table_destroy(); NULL on failure
 *
 *  | error | reason; texts name the file and the line |
 *  |---|---|
 *  | MPS_E_ARG | an argument |
 *  | MPS_E_NAME | no column, or several columns, of a name |
 *  | MPS_E_IO | not readable; no number; too few or too many numbers; times not increasing |
 *  | MPS_E_NOMEM | no memory | */
MPS_API mps_status mps_table_read(const mps_stats_config *config, const char *path, int32_t count,
                                  const char *const *names, mps_table **table);
/** Read all columns of a table of a run, as mps_table_read() does. The folder may be untrusted: a
 *  link to a file outside of it, or a file that is not regular, gives MPS_E_IO.
 *  @param folder  folder of a run
 *  @param name    "probes.csv", "trace.csv" */
MPS_API mps_status mps_table_read_run(const mps_stats_config *config, const char *folder,
                                      const char *name, mps_table **table);
/** Read reference values of the case of a run (key `reference`) from its summary.json: a table with
 *  one column. Its name is that of the compared column of probes.csv, or "": all columns of its
 *  unit.
 *  @param folder  folder of a run
 *  @param index   from 0, in the order of the case
 *  @return MPS_E_NAME: no such reference, without text; MPS_E_IO; MPS_E_ARG; MPS_E_NOMEM */
MPS_API mps_status mps_table_read_reference(const mps_stats_config *config, const char *folder,
                                            int32_t index, mps_table **table);
/** Label of a reference. "": the table is no reference; NULL for NULL. */
MPS_API const char *mps_table_label(const mps_table *table);
/** @return 1: the values of a reference are single points; 0: a line connects them */
MPS_API int32_t mps_table_is_points(const mps_table *table);
/** Free it. NULL is allowed. */
MPS_API void mps_table_destroy(mps_table *table);

/** Number of rows; 0 for NULL. */
MPS_API int64_t mps_table_rows(const mps_table *table);

/** Number of columns without the time; 0 for NULL. */
MPS_API int32_t mps_table_columns(const mps_table *table);

/** Name of a column without its unit; -1: the time. NULL: no such column. */
MPS_API const char *mps_table_name(const mps_table *table, int32_t column);

/** @return 1: a column that every run has: an energy or the position of the tank; 0: another
 *          column, or no such column */
MPS_API int32_t mps_table_is_common(const mps_table *table, int32_t column);

/** Unit of a column, "" for none; -1: the time. NULL: no such column. */
MPS_API const char *mps_table_unit(const mps_table *table, int32_t column);

/** Values of a column, [rows]; -1: the time. NULL: no such column, or no rows. */
MPS_API const double *mps_table_values(const mps_table *table, int32_t column);

/* ---- harmonics ---- */

/** Maximum number of harmonics of mps_harmonics. */
enum { MPS_HARMONICS = 16 };

/** p = mean + sum over k = 1..count of amplitude[k-1] sin(k w t + phase[k-1]). */
typedef struct mps_harmonics {
    /** Set by mps_harmonics_init(). */
    uint32_t struct_size;
    /** Number of harmonics, 1..MPS_HARMONICS. Default 1. */
    int32_t count;
    /** w [rad/s], > 0. */
    double omega;
    /** [unit of the series]; out */
    double mean;
    /** Root mean square of the residual [unit of the series]; out */
    double rest;
    /** [MPS_HARMONICS] >= 0 [unit of the series]; out */
    double amplitude[16];
    /** [MPS_HARMONICS] -pi..pi [rad]; out */
    double phase[16];
} mps_harmonics;

/** Set struct_size, zero, count 1. @param size  sizeof(mps_harmonics) @return MPS_E_ARG */
MPS_API mps_status mps_harmonics_init(mps_harmonics *h, size_t size);

/** Fit harmonics to a series by least squares, between config.from and config.until.
 *  @param n  number of samples; @param t  [n] increasing [s]; @param p  [n]; nan is ignored
 *  @param h  initialised, with count and omega; out
 *  @return MPS_E_ARG: an argument; fewer samples than unknowns, less than one period, or no
 *          solution because the samples are too far apart */
MPS_API mps_status mps_harmonics_find(const mps_stats_config *config, int64_t n, const double *t,
                                      const double *p, mps_harmonics *h);

/* ---- comparison, convergence, repeats ---- */

/** A series for mps_series_compare(). */
typedef struct mps_series {
    /** sizeof(mps_series), set by the caller. */
    uint32_t struct_size;
    /** Kept 0. */
    int32_t reserved;
    /** Number of samples. */
    int64_t n;
    /** [n] increasing [s] */
    const double *t;
    /** [n]; nan is ignored */
    const double *p;
} mps_series;

/** Differences of two series in their common time, second minus first. */
typedef struct mps_comparison {
    /** Set by mps_comparison_init(), or sizeof(mps_comparison). */
    uint32_t struct_size;
    /** Kept 0. */
    int32_t reserved;
    /** Begin of the common time [s]. */
    double t_first;
    /** Its end [s]. */
    double t_last;
    /** Mean of the difference. */
    double mean;
    /** Root mean square of the difference. */
    double rms;
    /** Root mean square of the deviation of the first series from its mean, a scale for `rms`. */
    double rms_first;
    /** Difference of the largest magnitude. */
    double largest;
    /** Its time [s]. */
    double t_largest;
    /** Highest value of each. */
    double peak[2];
    /** Times of these [s]. */
    double t_peak[2];
    /** Lowest value of each. */
    double trough[2];
    /** Times of these [s]. */
    double t_trough[2];
    /** Time shift of the second series (> 0: later) with the largest correlation [s]. NAN: a series
     *  is constant, or the correlation has no maximum within config.shift_most. */
    double shift;
    /** Correlation at this shift, -1..1. */
    double correlation;
    /** `shift` as an angle of config.period, 2 pi shift/period [rad]. NAN: no period. */
    double phase;
    /** Number of samples of the first series in the common time, without nan. */
    int64_t points;
} mps_comparison;

/** Set struct_size and zero. @param size  sizeof(mps_comparison) @return MPS_E_ARG */
MPS_API mps_status mps_comparison_init(mps_comparison *c, size_t size);

/** Compare two series at the samples of both, with linear interpolation.
 *  @param c  initialised; out
 *  @return MPS_E_ARG: an argument; no common time; MPS_E_NOMEM */
MPS_API mps_status mps_series_compare(const mps_stats_config *config, const mps_series *first,
                                      const mps_series *second, mps_comparison *c);

/** Compare a series with single points, e.g. measured crests: mps_series_compare() at the points
 *  only, because values between them are unknown. `shift` needs at least five points.
 *  @param points  the first series; at least one sample
 *  @param series  linear between its samples
 *  @param c       initialised; out
 *  @return MPS_E_ARG: an argument; no point within the time of the series; MPS_E_NOMEM */
MPS_API mps_status mps_points_compare(const mps_stats_config *config, const mps_series *points,
                                      const mps_series *series, mps_comparison *c);

/** Kinds of convergence of three values with the spacing. */
enum {
    /** Monotone, order within order_least..order_most; larger orders are limited to order_most. */
    MPS_CONVERGE_MONOTONE = 0,
    /** Monotone, but the order is smaller than order_least or undefined. */
    MPS_CONVERGE_SLOW = 1,
    /** The two differences have different signs. */
    MPS_CONVERGE_OSCILLATING = 2,
    /** All three values are the same. */
    MPS_CONVERGE_SAME = 3
};

/** Order and band of a figure computed with three spacings: f = limit + C h^order. */
typedef struct mps_convergence {
    /** Set by mps_convergence_init(), or sizeof(mps_convergence). */
    uint32_t struct_size;
    /** MPS_CONVERGE_MONOTONE to MPS_CONVERGE_SAME. */
    int32_t kind;
    /** Observed order (Richardson). NAN: undefined. */
    double order;
    /** Extrapolated value for a spacing of 0, with the smaller of `order` and order_most. NAN: the
     *  order is not accepted. */
    double limit;
    /** Half width of a band around the finest value. */
    double band;
} mps_convergence;

/** Set struct_size and zero. @param size  sizeof(mps_convergence) @return MPS_E_ARG */
MPS_API mps_status mps_convergence_init(mps_convergence *c, size_t size);

/** @param spacing  [3] > 0, ascending @param value  [3] finite @param c  initialised; out
 *  @return MPS_E_ARG */
MPS_API mps_status mps_converge(const mps_stats_config *config, const double *spacing,
                                const double *value, mps_convergence *c);

/** A figure of repeated runs. */
typedef struct mps_repeat {
    /** Set by mps_repeat_init(), or sizeof(mps_repeat). */
    uint32_t struct_size;
    /** Runs with a value. */
    int32_t count;
    /** Time of the event, mean of the runs [s]; mps_repeat_peaks() only. */
    double t;
    /** Mean of all values. */
    double mean;
    /** Minimum of all values. */
    double least;
    /** Maximum of all values. */
    double most;
    /** Standard deviation, with count - 1. NAN for one value. */
    double deviation;
    /** Half width of the confidence band of the mean, by Student's t. NAN for one value. */
    double mean_band;
    /** Half width of the prediction band of one more run. NAN for one value. */
    double next_band;
} mps_repeat;

/** Set struct_size and zero. @param size  sizeof(mps_repeat) @return MPS_E_ARG */
MPS_API mps_status mps_repeat_init(mps_repeat *r, size_t size);

/** @param count  >= 1 @param value  [count]; nan: no value of this run @param r  initialised; out
 *  @return MPS_E_ARG: an argument; no run has a value */
MPS_API mps_status mps_repeat_find(const mps_stats_config *config, int32_t count,
                                   const double *value, mps_repeat *r);

MPS_END_DECLS

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* Shared by the files of statistics. */
#ifndef MPS_POST_STATISTICS_H
#define MPS_POST_STATISTICS_H

#include <mps/stats.h>
#include <stdbool.h>

/* ---- statistics.c ---- */

/* Write the text to config->error and return `status`. */
mps_status mps__stats_fail(const mps_stats_config *config, mps_status status, const char *format,
                           ...) __attribute__((format(printf, 3, 4)));

/* Inline in this header, so that static analysers see that it returns a failure. */
static inline mps_status mps__stats_no_memory(const mps_stats_config *config)
{
    mps__stats_fail(config, MPS_E_NOMEM, "out of memory");
    return MPS_E_NOMEM;
}

/* Refuse a config that is NULL, not initialised, or has a member out of its range. */
mps_status mps__stats_check(const mps_stats_config *config);

/* Refuse an argument. */
#define MPS__STATS_CHECK(config, condition, ...)               \
    do {                                                       \
        if (!(condition)) {                                    \
            mps__stats_fail((config), MPS_E_ARG, __VA_ARGS__); \
            return MPS_E_ARG;                                  \
        }                                                      \
    } while (0)

/* Propagate a failure. */
#define MPS__STATS_TRY(call)             \
    do {                                 \
        mps_status status_ = (call);     \
        if (status_ < 0) return status_; \
    } while (0)

/* Whether it is a struct of `full` bytes, or a longer one of a newer version. */
bool mps__stats_known(const void *given, size_t full);
/* Implementation of every ..._init(). */
mps_status mps__stats_init(void *out, size_t size, const void *defaults, size_t full);
/* Copy all but struct_size. */
void mps__stats_out(void *out, const void *from, size_t full);

/* Refuse times that do not increase, and infinite values; by index. `what`: "", or "first." for a
 * message. */
mps_status mps__stats_series(const mps_stats_config *config, const char *what, int64_t n,
                             const double *t, const double *p);

/* A random number generator with the same sequence on all machines (splitmix64). */
typedef struct mps__random {
    uint64_t state;
} mps__random;
/* A number in 0..1, exclusive. */
double mps__random_fraction(mps__random *r);

/* Quantile q of n >= 1 ascending numbers, with linear interpolation. */
double mps__quantile(int64_t n, const double *ascending, double q);
void mps__sort(int64_t n, double *values);

/* Regularised incomplete beta function I_x(a, b), a and b > 0, 0 <= x <= 1. */
double mps__beta(double a, double b, double x);
/* x with I_x(a, b) = q, 0 < q < 1. */
double mps__beta_inverse(double a, double b, double q);
/* t with P(|T| <= t) = `share` for Student's T with `freedom` >= 1 degrees of freedom. */
double mps__student(double freedom, double share);

/* ---- statistics_constants.c ---- */

/* Set the constant of a key, "impacts.window" or "T1", to a number in SI.
 * @return false: not found, or a whole number is out of its range */
bool mps__stats_put(mps_stats_config *config, const char *key, double value);
/* Set the list of sensors, names separated by "; ". */
mps_status mps__stats_put_sensors(mps_stats_config *config, const char *names);

/* ---- statistics_read.c ---- */

/* Constants of a run from its summary. @param end  of the record [s]; NAN: not known */
struct page_run;
mps_status mps__stats_take(const struct page_run *r, double end, mps_stats_config *config);

/* ---- statistics_table.c ---- */

/* A reference of summary.json as a table, which the caller destroys.
 * @return false: memory is exhausted */
struct json_value;
bool mps__stats_reference(const struct json_value *one, mps_table **table);

/* ---- statistics_events.c ---- */

/* A signal as evaluated for events: without nan, between from and until, resampled, filtered. */
typedef struct mps__signal {
    int64_t n, missing;
    double *t, *p; /* one allocation; free t */
} mps__signal;

mps_status mps__signal_make(const mps_stats_config *config, int64_t n, const double *t,
                            const double *p, mps__signal *out);

/* Threshold as given, or derived from the signal. NAN: derived from a signal without samples. */
double mps__signal_threshold(const mps_stats_config *config, const mps__signal *s);

/* Events in the order of time. The caller frees *events. */
mps_status mps__events_find(const mps_stats_config *config, const mps__signal *s, double threshold,
                            double window, mps_impact **events, int64_t *count, int64_t *cut);

/* ---- statistics_impacts.c ---- */

struct mps_impacts {
    mps_stats_config config; /* without `error` */
    mps_impacts_info info;
    mps_impact *event;     /* [events] in the order of time */
    int64_t *rank;         /* [events] index of the event with the rank-th highest peak */
    mps_exceedance *point; /* [events] by rank */
    mps_fit fit[2];        /* by kind */
};

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* Common parts of statistics: constants and their ranges, structs of the interface, errors, random
 * numbers, quantiles. */
#include "statistics.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

/* ---- errors and structs ---- */

mps_status mps__stats_fail(const mps_stats_config *config, mps_status status, const char *format,
                           ...)
{
    if (!config || !config->error || config->error_size == 0) return status;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(config->error, config->error_size, format, arguments);
    va_end(arguments);
    return status;
}

/* No version will have larger structs: an uninitialised size is usually beyond. */
enum { LARGEST = 4096 };

static bool is_size(size_t size, size_t full)
{
    return size == full || (size > full && size <= LARGEST);
}

bool mps__stats_known(const void *given, size_t full)
{
    uint32_t size;
    if (!given) return false;
    memcpy(&size, given, sizeof size);
    return is_size(size, full);
}

mps_status mps__stats_init(void *out, size_t size, const void *defaults, size_t full)
{
    if (!out || !is_size(size, full)) return MPS_E_ARG;
    const uint32_t given = (uint32_t)size;
    memset(out, 0, size);
    if (defaults) memcpy(out, defaults, full);
    memcpy(out, &given, sizeof given);
    return MPS_OK;
}

void mps__stats_out(void *out, const void *from, size_t full)
{
    memcpy((char *)out + sizeof(uint32_t), (const char *)from + sizeof(uint32_t),
           full - sizeof(uint32_t));
}

mps_status mps_stats_config_init(mps_stats_config *config, size_t size)
{
    const mps_stats_config defaults = {.resamples = 1000,
                                       .from = -INFINITY,
                                       .until = INFINITY,
                                       .threshold = NAN,
                                       .deviations = 2,
                                       .window = NAN,
                                       .window_share = 0.2,
                                       .period = NAN,
                                       .share = 0.5,
                                       .least_events = 30,
                                       .seed = 1,
                                       .confidence = 0.9,
                                       .exposure = 10800,
                                       .exposure_ratio = 3,
                                       .dependence = 2,
                                       .length_scale = 1,
                                       .density_ratio = 1,
                                       .shift_most = NAN,
                                       .order_least = 0.5,
                                       .order_most = 2,
                                       .safety = 1.25,
                                       .safety_poor = 3,
                                       .omega = NAN};
    return mps__stats_init(config, size, &defaults, sizeof defaults);
}

/* ---- ranges ---- */

/* Ranges of a number. */
enum { POSITIVE = 1, NOT_NEGATIVE = 2, FINITE = 3, SHARE = 4, UNKNOWN = 8 /* or NAN */ };

typedef struct bound {
    const char *name;
    double value;
    int kind;
} bound;

static bool in_range(const bound *b)
{
    if (isnan(b->value)) return (b->kind & UNKNOWN) != 0;
    if (!isfinite(b->value)) return false;
    switch (b->kind & ~UNKNOWN) {
    case POSITIVE:
        return b->value > 0;
    case NOT_NEGATIVE:
        return b->value >= 0;
    case SHARE:
        return b->value > 0 && b->value < 1;
    default:
        return true;
    }
}

static const char *range_of(int kind)
{
    static const char *const text[] = {"", "> 0", ">= 0", "finite", "between 0 and 1"};
    return text[kind & ~UNKNOWN];
}

static mps_status check_numbers(const mps_stats_config *c)
{
    const bound bounds[] = {{"rate", c->rate, NOT_NEGATIVE},
                            {"high_pass", c->high_pass, NOT_NEGATIVE},
                            {"threshold", c->threshold, FINITE | UNKNOWN},
                            {"deviations", c->deviations, FINITE},
                            {"window", c->window, NOT_NEGATIVE | UNKNOWN},
                            {"window_share", c->window_share, NOT_NEGATIVE},
                            {"period", c->period, POSITIVE | UNKNOWN},
                            {"share", c->share, SHARE},
                            {"crossing_time", c->crossing_time, NOT_NEGATIVE},
                            {"confidence", c->confidence, SHARE},
                            {"exposure", c->exposure, POSITIVE},
                            {"exposure_ratio", c->exposure_ratio, POSITIVE},
                            {"dependence", c->dependence, POSITIVE},
                            {"length_scale", c->length_scale, POSITIVE},
                            {"density_ratio", c->density_ratio, POSITIVE},
                            {"shift_most", c->shift_most, POSITIVE | UNKNOWN},
                            {"order_least", c->order_least, POSITIVE},
                            {"order_most", c->order_most, POSITIVE},
                            {"safety", c->safety, POSITIVE},
                            {"safety_poor", c->safety_poor, POSITIVE},
                            {"omega", c->omega, POSITIVE | UNKNOWN}};
    for (size_t k = 0; k < sizeof bounds / sizeof bounds[0]; k++)
        MPS__STATS_CHECK(c, in_range(&bounds[k]), "'%s' is %g: must be %s", bounds[k].name,
                         bounds[k].value, range_of(bounds[k].kind));
    return MPS_OK;
}

/* A newer program may have set members that this version does not know. */
static bool has_unknown(const mps_stats_config *c)
{
    const unsigned char *byte = (const unsigned char *)c;
    for (size_t k = sizeof *c; k < c->struct_size; k++)
        if (byte[k]) return true;
    return false;
}

mps_status mps__stats_check(const mps_stats_config *config)
{
    if (!mps__stats_known(config, sizeof *config)) return MPS_E_ARG;
    if (has_unknown(config))
        return mps__stats_fail(config, MPS_E_VERSION,
                               "mps_stats_config comes from a newer version and uses its entries");
    MPS__STATS_CHECK(config, config->resamples >= 0 && config->resamples <= 1000000,
                     "'resamples' is %d: must be 0 .. 1000000", (int)config->resamples);
    MPS__STATS_CHECK(config, config->least_events >= 2, "'least_events' is %d: must be >= 2",
                     (int)config->least_events);
    MPS__STATS_CHECK(config, config->from < config->until,
                     "'from' is %g and 'until' %g: 'from' must be smaller", config->from,
                     config->until);
    MPS__STATS_CHECK(config, config->reserved == 0, "'reserved' is %d: must be 0",
                     (int)config->reserved);
    MPS__STATS_CHECK(config, memchr(config->sensors, '\0', sizeof config->sensors),
                     "'sensors' has no end");
    MPS__STATS_TRY(check_numbers(config));
    MPS__STATS_CHECK(config, config->order_least <= config->order_most,
                     "'order_least' is %g: must be at most 'order_most', %g", config->order_least,
                     config->order_most);
    return MPS_OK;
}

mps_status mps__stats_series(const mps_stats_config *config, const char *what, int64_t n,
                             const double *t, const double *p)
{
    MPS__STATS_CHECK(config, n >= 0, "%sn is %lld: must be >= 0", what, (long long)n);
    MPS__STATS_CHECK(config, n == 0 || (t && p), "%s%s is NULL", what, t ? "p" : "t");
    for (int64_t k = 0; k < n; k++) {
        MPS__STATS_CHECK(config, isfinite(t[k]), "%st[%lld] is %g: must be finite", what,
                         (long long)k, t[k]);
        MPS__STATS_CHECK(config, k == 0 || t[k] > t[k - 1],
                         "%st[%lld] is %.9g: must be larger than the time before it, %.9g", what,
                         (long long)k, t[k], t[k - 1]);
        MPS__STATS_CHECK(config, !isinf(p[k]),
                         "%sp[%lld] is %g: must be finite, or nan where it is not known", what,
                         (long long)k, p[k]);
    }
    return MPS_OK;
}

/* ---- random numbers, quantiles ---- */

static uint64_t next_random(mps__random *r)
{
    uint64_t z = r->state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

double mps__random_fraction(mps__random *r)
{
    return ((double)(next_random(r) >> 12) + 0.5) * 0x1p-52;
}

double mps__quantile(int64_t n, const double *ascending, double q)
{
    const double place = q * (double)(n - 1);
    const int64_t k = (int64_t)place;
    if (k >= n - 1) return ascending[n - 1];
    return ascending[k] + (place - (double)k) * (ascending[k + 1] - ascending[k]);
}

/* Sift values[at] down in the heap of n values until no child is larger. */
static void sink(double *values, int64_t at, int64_t n)
{
    const double value = values[at];
    for (int64_t child = 2 * at + 1; child < n; child = 2 * at + 1) {
        if (child + 1 < n && values[child + 1] > values[child]) child++;
        if (!(values[child] > value)) break;
        values[at] = values[child];
        at = child;
    }
    values[at] = value;
}

/* Heapsort: qsort() may allocate memory. */
void mps__sort(int64_t n, double *values)
{
    for (int64_t at = n / 2 - 1; at >= 0; at--) sink(values, at, n);
    for (int64_t last = n - 1; last > 0; last--) {
        const double largest = values[0];
        values[0] = values[last];
        values[last] = largest;
        sink(values, 0, last);
    }
}

/* ---- distributions ---- */

/* ln Gamma(x), x > 0: Stirling's series, from 10 on; lgamma() writes a global variable. */
static double log_gamma(double x)
{
    double product = 1;
    for (; x < 10; x++) product *= x;
    const double r = 1 / (x * x);
    const double series = (1.0 / 12 - r * (1.0 / 360 - r * (1.0 / 1260 - r / 1680))) / x;
    return (x - 0.5) * log(x) - x + 0.5 * log(2 * PI) + series - log(product);
}

/* Continued fraction of I_x(a, b) by the method of Lentz; converges fast for x < (a + 1)/(a + b +
 * 2). */
static double beta_fraction(double a, double b, double x)
{
    const double tiny = 1e-300, enough = 1e-15;
    double c = 1, d = 1 - (a + b) * x / (a + 1);
    d = 1 / (fabs(d) < tiny ? tiny : d);
    double f = d;
    for (int m = 1; m < 100000; m++) {
        const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        d = 1 + even * d;
        c = 1 + even / c;
        d = 1 / (fabs(d) < tiny ? tiny : d);
        if (fabs(c) < tiny) c = tiny;
        f *= c * d;
        d = 1 + odd * d;
        c = 1 + odd / c;
        d = 1 / (fabs(d) < tiny ? tiny : d);
        if (fabs(c) < tiny) c = tiny;
        f *= c * d;
        if (fabs(c * d - 1) < enough) break;
    }
    return f;
}

/* Logarithm of x^a (1 - x)^b/B(a, b). */
static double log_front(double a, double b, double x)
{
    return log_gamma(a + b) - log_gamma(a) - log_gamma(b) + a * log(x) + b * log1p(-x);
}

double mps__beta(double a, double b, double x)
{
    if (!(x > 0)) return 0;
    if (!(x < 1)) return 1;
    const double front = exp(log_front(a, b, x));
    if (x < (a + 1) / (a + b + 2)) return front * beta_fraction(a, b, x) / a;
    return 1 - front * beta_fraction(b, a, 1 - x) / b;
}

/* Newton's method, with bisection bounds. */
double mps__beta_inverse(double a, double b, double q)
{
    double low = 0, high = 1, x = a / (a + b);
    for (int k = 0; k < 200; k++) {
        const double off = mps__beta(a, b, x) - q;
        if (off < 0)
            low = x;
        else
            high = x;
        double next = x - off * x * (1 - x) / exp(log_front(a, b, x));
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (fabs(next - x) <= 1e-14 * x) return next;
        x = next;
    }
    return x;
}

/* P(|T| > t) = I_x(freedom/2, 1/2), x = freedom/(freedom + t^2). */
double mps__student(double freedom, double share)
{
    const double x = mps__beta_inverse(0.5 * freedom, 0.5, 1 - share);
    return sqrt(freedom * (1 - x) / x);
}

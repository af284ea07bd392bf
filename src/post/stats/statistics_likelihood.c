/* SPDX-License-Identifier: BSD-3-Clause */
/* Weibull and generalised Pareto by maximum likelihood. Each reduces to one equation for one
 * unknown, because the other parameter follows from it. */
#include "statistics_fit.h"
#include <math.h>

static mps__parameters none(int32_t state)
{
    return (mps__parameters){NAN, NAN, NAN, state};
}

/* ---- Weibull ---- */

/* sum z e^(c z)/sum e^(c z) - 1/c - mean z with z = ln(y/y_max) <= 0; increases with c, its root is
 * the most likely c. */
typedef struct weibull_point {
    double value, slope, mean_power; /* mean e^(c z) */
} weibull_point;

static weibull_point weibull_equation(int64_t n, const double *z, double mean, double c)
{
    double s0 = 0, s1 = 0, s2 = 0;
    for (int64_t k = 0; k < n; k++) {
        const double e = exp(c * z[k]);
        s0 += e;
        s1 += z[k] * e;
        s2 += z[k] * z[k] * e;
    }
    return (weibull_point){s1 / s0 - 1 / c - mean, (s2 * s0 - s1 * s1) / (s0 * s0) + 1 / (c * c),
                           s0 / (double)n};
}

/* Newton's method, bracketed by points where the equation is below and above 0. */
static double weibull_shape(int64_t n, const double *z, double mean, double start)
{
    double low = 0, high = INFINITY, c = start;
    for (int step = 0;; step++) {
        const weibull_point f = weibull_equation(n, z, mean, c);
        if (f.value < 0)
            low = c;
        else
            high = c;
        double next = c - f.value / f.slope;
        if (!(next > low && next < high)) next = isfinite(high) ? 0.5 * (low + high) : 2 * c;
        if (fabs(next - c) <= 1e-14 * c || step == 200) return next;
        c = next;
    }
}

mps__parameters mps__weibull(int64_t n, const double *y, double *work)
{
    double mean = 0, square = 0;
    if (n < 2 || !(y[n - 1] > y[0])) return none(MPS_FIT_SAME);
    for (int64_t k = 0; k < n; k++) {
        work[k] = log(y[k] / y[n - 1]);
        mean += work[k] / (double)n;
    }
    for (int64_t k = 0; k < n; k++) square += (work[k] - mean) * (work[k] - mean) / (double)n;
    if (!(square > 0)) return none(MPS_FIT_SAME);
    /* the variance of ln y is pi^2/(6 c^2) */
    const double c = weibull_shape(n, work, mean, 1.2825498301618641 / sqrt(square));
    const double power = weibull_equation(n, work, mean, c).mean_power;
    const double b = y[n - 1] * pow(power, 1 / c);
    const double log_mean = mean + log(y[n - 1]);
    const double likelihood = (double)n * (log(c) - c * log(b) + (c - 1) * log_mean - 1);
    return (mps__parameters){b, c, likelihood, MPS_FIT_LIKELIHOOD};
}

/* ---- generalised Pareto ---- */

/* With theta = x/s the most likely x is mean ln(1 + theta y). The remaining unknown is theta >
 * -1/y_max. */
typedef struct pareto_point {
    double shape; /* x */
    double slope; /* derivative of the likelihood over n, by theta */
} pareto_point;

/* Below this theta y_max the derivative is a series: the formula loses its digits. */
static const double SMALL = 1e-5;

static double pareto_slope_near_0(int64_t n, const double *y, double theta)
{
    double m1 = 0, m2 = 0, m3 = 0;
    for (int64_t k = 0; k < n; k++) {
        m1 += y[k] / (double)n;
        m2 += y[k] * y[k] / (double)n;
        m3 += y[k] * y[k] * y[k] / (double)n;
    }
    const double b = m2 / m1, c = m3 / m1;
    return 0.5 * b - m1 - theta * (2 * c / 3 - 0.25 * b * b - m2);
}

static pareto_point pareto_equation(int64_t n, const double *y, double theta)
{
    double shape = 0, rate = 0; /* x and its derivative */
    for (int64_t k = 0; k < n; k++) {
        shape += log1p(theta * y[k]);
        rate += y[k] / (1 + theta * y[k]);
    }
    shape /= (double)n;
    rate /= (double)n;
    if (fabs(theta * y[n - 1]) < SMALL)
        return (pareto_point){shape, pareto_slope_near_0(n, y, theta)};
    return (pareto_point){shape, 1 / theta - rate / shape - rate};
}

/* The unknown of the search is v = ln(1 + theta y_max): theta may be any number above -1/y_max, and
 * v any number. */
static double theta_of(const double *y, int64_t n, double v)
{
    return expm1(v) / y[n - 1];
}

/* Step from v until the derivative changes its sign. @return false: it does not where x > -1 */
static bool bracket(int64_t n, const double *y, double v, double *from, double *to)
{
    const double most = 100;
    const double sign = pareto_equation(n, y, theta_of(y, n, v)).slope < 0 ? -1 : 1;
    for (double step = 0.25 * sign;; step *= 2) {
        const pareto_point next = pareto_equation(n, y, theta_of(y, n, v + step));
        *from = v;
        *to = v += step;
        if (!(next.slope * sign > 0)) return next.shape > -1 && !isnan(next.slope);
        if (!(next.shape > -1) || fabs(v) > most) return false;
    }
}

/* Bisection, or the secant if it converges faster (Illinois method). */
static double pareto_root(int64_t n, const double *y, double a, double b)
{
    double fa = pareto_equation(n, y, theta_of(y, n, a)).slope;
    double fb = pareto_equation(n, y, theta_of(y, n, b)).slope;
    for (int step = 0; step < 200 && fb != 0 && fabs(b - a) > 1e-15 * (1 + fabs(b)); step++) {
        double v = b - fb * (b - a) / (fb - fa);
        if (step % 4 == 3) v = 0.5 * (a + b);
        const double f = pareto_equation(n, y, theta_of(y, n, v)).slope;
        const bool done = v == b || v == a;
        if ((f < 0) != (fb < 0)) {
            a = b;
            fa = fb;
        } else {
            fa *= 0.5;
        }
        b = v;
        fb = f;
        if (done) break;
    }
    return b;
}

mps__parameters mps__pareto_moments(int64_t n, const double *y)
{
    double a0 = 0, a1 = 0;
    if (n < 2 || !(y[n - 1] > y[0])) return none(MPS_FIT_SAME);
    for (int64_t k = 0; k < n; k++) {
        const double below = ((double)k + 0.65) / (double)n; /* Hosking & Wallis 1987 */
        a0 += y[k] / (double)n;
        a1 += (1 - below) * y[k] / (double)n;
    }
    const double scale = 2 * a0 * a1 / (a0 - 2 * a1), shape = 2 - a0 / (a0 - 2 * a1);
    if (!(scale > 0) || !isfinite(shape)) return none(MPS_FIT_SAME);
    double likelihood = -(double)n * log(scale);
    for (int64_t k = 0; k < n; k++)
        likelihood -= shape != 0 ? (1 + 1 / shape) * log1p(fmax(-1, shape * y[k] / scale))
                                 : y[k] / scale;
    /* a peak beyond the end of the distribution */
    if (!isfinite(likelihood)) likelihood = -INFINITY;
    return (mps__parameters){scale, shape, likelihood, MPS_FIT_MOMENTS};
}

mps__parameters mps__pareto(int64_t n, const double *y, double *work)
{
    (void)work;
    const mps__parameters start = mps__pareto_moments(n, y);
    double from, to, v = -2; /* if a peak is beyond the end of the first guess */
    if (start.state == MPS_FIT_SAME) return start;
    if (start.shape / start.scale * y[n - 1] > -1) v = log1p(start.shape / start.scale * y[n - 1]);
    if (!bracket(n, y, v, &from, &to)) return start;
    double theta = theta_of(y, n, pareto_root(n, y, from, to));
    if (theta == 0) theta = 1e-20 / y[n - 1]; /* x/s, avoids 0/0 */
    const double shape = pareto_equation(n, y, theta).shape, scale = shape / theta;
    return (mps__parameters){scale, shape, -(double)n * (log(scale) + shape + 1),
                             MPS_FIT_LIKELIHOOD};
}

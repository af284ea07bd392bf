/* SPDX-License-Identifier: BSD-3-Clause */
/* Harmonics of a series by least squares: normal equations of 1, sin k w t, cos k w t, nearly
 * orthogonal over a period or more. */
#include "statistics.h"
#include <math.h>
#include <string.h>

enum { UNKNOWNS = 2 * MPS_HARMONICS + 1 };

static const double PI = 3.14159265358979323846;

/* Normal equations; the last column is the right-hand side. */
typedef struct equations {
    int size; /* unknowns */
    double row[UNKNOWNS][UNKNOWNS + 1];
} equations;

mps_status mps_harmonics_init(mps_harmonics *h, size_t size)
{
    const mps_harmonics defaults = {.count = 1};
    return mps__stats_init(h, size, &defaults, sizeof defaults);
}

static bool is_used(const mps_stats_config *config, double t, double p)
{
    return t >= config->from && t <= config->until && !isnan(p);
}

static void find_basis(int count, double angle, double *basis)
{
    basis[0] = 1;
    for (int k = 1; k <= count; k++) {
        basis[2 * k - 1] = sin(k * angle);
        basis[2 * k] = cos(k * angle);
    }
}

static void add_sample(equations *e, const double *basis, double p)
{
    for (int i = 0; i < e->size; i++) {
        for (int j = 0; j <= i; j++) e->row[i][j] += basis[i] * basis[j];
        e->row[i][e->size] += basis[i] * p;
    }
}

/* Cholesky's method, in place. @return false: the matrix is singular */
static bool solve(equations *e, double *x)
{
    /* pivot over diagonal: below it the samples cannot distinguish two terms */
    const double least = 1e-10;
    const int n = e->size;
    for (int i = 0; i < n; i++) {
        const double diagonal = e->row[i][i];
        for (int j = 0; j <= i; j++) {
            double sum = e->row[i][j];
            for (int k = 0; k < j; k++) sum -= e->row[i][k] * e->row[j][k];
            if (j < i)
                e->row[i][j] = sum / e->row[j][j];
            else if (sum > least * diagonal)
                e->row[i][i] = sqrt(sum);
            else
                return false;
        }
    }
    for (int i = 0; i < n; i++) {
        x[i] = e->row[i][n];
        for (int k = 0; k < i; k++) x[i] -= e->row[i][k] * x[k];
        x[i] /= e->row[i][i];
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++) x[i] -= e->row[k][i] * x[k];
        x[i] /= e->row[i][i];
    }
    return true;
}

/* Root mean square of p minus its mean and its harmonics. */
static double find_rest(const mps_stats_config *config, int64_t n, const double *t, const double *p,
                        const mps_harmonics *h)
{
    double sum = 0;
    int64_t used = 0;
    for (int64_t i = 0; i < n; i++) {
        if (!is_used(config, t[i], p[i])) continue;
        double rest = p[i] - h->mean;
        for (int k = 1; k <= h->count; k++)
            rest -= h->amplitude[k - 1] * sin(k * h->omega * t[i] + h->phase[k - 1]);
        sum += rest * rest;
        used++;
    }
    return sqrt(sum / (double)used);
}

/* Sum over the samples in use. @return an error if they cannot distinguish the harmonics */
static mps_status collect(const mps_stats_config *config, int64_t n, const double *t,
                          const double *p, const mps_harmonics *h, equations *e)
{
    double basis[UNKNOWNS], first = NAN, last = NAN;
    int64_t used = 0;
    for (int64_t i = 0; i < n; i++) {
        if (!is_used(config, t[i], p[i])) continue;
        if (used++ == 0) first = t[i];
        last = t[i];
        find_basis(h->count, h->omega * t[i], basis);
        add_sample(e, basis, p[i]);
    }
    MPS__STATS_CHECK(config, used >= e->size, "%lld samples are used: %d harmonics need %d",
                     (long long)used, (int)h->count, e->size);
    MPS__STATS_CHECK(config, (last - first) * h->omega >= 2 * PI * (1 - 1e-9),
                     "the samples cover %.9g s: must be one period, %.9g s, or more", last - first,
                     2 * PI / h->omega);
    return MPS_OK;
}

mps_status mps_harmonics_find(const mps_stats_config *config, int64_t n, const double *t,
                              const double *p, mps_harmonics *h)
{
    double x[UNKNOWNS] = {0};
    mps_harmonics out = {.struct_size = sizeof out};
    MPS__STATS_TRY(mps__stats_check(config));
    MPS__STATS_CHECK(config, mps__stats_known(h, sizeof *h), "call mps_harmonics_init() first");
    MPS__STATS_CHECK(config, h->count >= 1 && h->count <= MPS_HARMONICS,
                     "count is %d: must be 1 .. %d", (int)h->count, MPS_HARMONICS);
    MPS__STATS_CHECK(config, h->omega > 0 && isfinite(h->omega), "omega is %g: must be > 0",
                     h->omega);
    MPS__STATS_TRY(mps__stats_series(config, "", n, t, p));
    equations e = {.size = 2 * h->count + 1};
    out.count = h->count;
    out.omega = h->omega;
    MPS__STATS_TRY(collect(config, n, t, p, h, &e));
    MPS__STATS_CHECK(config, solve(&e, x),
                     "the samples are too far apart to tell %d harmonics of %.9g rad/s apart",
                     (int)h->count, h->omega);
    out.mean = x[0];
    for (int k = 1; k <= h->count; k++) {
        out.amplitude[k - 1] = hypot(x[2 * k - 1], x[2 * k]);
        out.phase[k - 1] = atan2(x[2 * k], x[2 * k - 1]);
    }
    out.rest = find_rest(config, n, t, p, &out);
    mps__stats_out(h, &out, sizeof out);
    return MPS_OK;
}

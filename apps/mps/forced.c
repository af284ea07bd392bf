/* SPDX-License-Identifier: BSD-3-Clause */
/* Harmonic fit of the loads of one run, from trace.csv. The load of a step and the acceleration of
 * the tank in it belong to the same instant (couple.h), so both are fitted by the same functions of
 * time, and their ratio has no phase error. A wave that remains from the ramp oscillates at T1: it
 * is fitted in addition to the forced one if the record is long enough to separate them. */
#include "forced.h"
#include <math.h>
#include <mps/stats.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TERMS = 5, ERROR_SIZE = 640, PERIODS_MOST = 1024 };

const char *const forced_names[FORCED_DEGREES] = {"surge", "sway", "heave", "roll", "pitch", "yaw"};

/* Number of beats of free and forced wave in the record below which they are inseparable. */
static const double BEATS = 0.8;

int32_t forced_degree(const char *name, size_t length)
{
    for (int32_t d = 0; d < FORCED_DEGREES; d++)
        if (strlen(forced_names[d]) == length && strncmp(forced_names[d], name, length) == 0)
            return d;
    return -1;
}

/* ---- least squares ---- */

/* Solve the normal equations a x = b, [n] x [n] row by row; both are overwritten, b becomes x. They
 * are positive definite, so no pivoting is needed.
 * @return false: singular */
static bool solve(int n, double *a, double *b)
{
    for (int k = 0; k < n; k++) {
        if (!(a[k * n + k] > 0)) return false;
        for (int i = k + 1; i < n; i++) {
            const double f = a[i * n + k] / a[k * n + k];
            for (int j = k; j < n; j++) a[i * n + j] -= f * a[k * n + j];
            b[i] -= f * b[k];
        }
    }
    for (int k = n - 1; k >= 0; k--) {
        for (int j = k + 1; j < n; j++) b[k] -= a[k * n + j] * b[j];
        b[k] /= a[k * n + k];
    }
    return true;
}

/* A run: its times, steps, and the functions fitted to its columns. */
typedef struct record_of {
    const mps_table *rows;
    int64_t n;
    const double *t, *dt;
    double omega, free; /* free: of the wave at T1 [rad/s]; 0: not fitted */
    double from, until;
} record_of;

static int terms_of(const record_of *r)
{
    return r->free > 0 ? TERMS : TERMS - 2;
}

static void basis(const record_of *r, double t, double out[TERMS])
{
    out[0] = 1;
    out[1] = cos(r->omega * t);
    out[2] = sin(r->omega * t);
    out[3] = cos(r->free * t);
    out[4] = sin(r->free * t);
}

static bool counts(const record_of *r, int64_t i)
{
    return r->t[i] > r->from; /* up to the last */
}

/* Coefficients of a column; the weight of a step is its duration. */
static bool fit(const record_of *r, const double *value, double x[TERMS])
{
    const int n = terms_of(r);
    double a[TERMS * TERMS] = {0}, f[TERMS];
    memset(x, 0, TERMS * sizeof *x);
    for (int64_t i = 0; i < r->n; i++) {
        if (!counts(r, i)) continue;
        basis(r, r->t[i], f);
        for (int j = 0; j < n; j++) {
            x[j] += r->dt[i] * f[j] * value[i];
            for (int k = 0; k < n; k++) a[j * n + k] += r->dt[i] * f[j] * f[k];
        }
    }
    return solve(n, a, x);
}

/* ---- one load ---- */

/* A complex number re + i im. */
typedef struct phasor {
    double re, im;
} phasor;

static phasor over(phasor a, phasor b)
{
    const double size = b.re * b.re + b.im * b.im;
    return (phasor){(a.re * b.re + a.im * b.im) / size, (a.im * b.re - a.re * b.im) / size};
}

/* x cos + y sin is the real part of (x - i y) e^(i w t). */
static phasor phasor_of(const double x[TERMS])
{
    return (phasor){x[1], -x[2]};
}

/* Residual of a load in each period, relative to the acceleration `a`. @return number of periods */
static int32_t find_rest(const record_of *r, const double *value, const double x[TERMS], phasor a,
                         phasor *rest)
{
    const double period = 2 * acos(-1.0) / r->omega;
    const int32_t count = (int32_t)fmin(PERIODS_MOST, round((r->until - r->from) / period));
    for (int32_t k = 0; k < count; k++) rest[k] = (phasor){0, 0};
    for (int64_t i = 0; i < r->n; i++) {
        double f[TERMS], left = value[i];
        const int32_t k = (int32_t)((r->t[i] - r->from) / period);
        if (!counts(r, i) || k >= count) continue;
        basis(r, r->t[i], f);
        for (int j = 0; j < terms_of(r); j++) left -= x[j] * f[j];
        rest[k].re += 2 / period * r->dt[i] * left * f[1];
        rest[k].im -= 2 / period * r->dt[i] * left * f[2];
    }
    for (int32_t k = 0; k < count; k++) rest[k] = over(rest[k], a);
    return count;
}

/* Half width of the confidence band of the mean over the periods. */
static double band_of(int32_t count, const phasor *rest, bool imaginary)
{
    double value[PERIODS_MOST];
    mps_stats_config config;
    mps_repeat r;
    mps_stats_config_init(&config, sizeof config);
    mps_repeat_init(&r, sizeof r);
    for (int32_t k = 0; k < count; k++) value[k] = imaginary ? rest[k].im : rest[k].re;
    return mps_repeat_find(&config, count, value, &r) == MPS_OK ? r.mean_band : NAN;
}

static const double *column(const mps_table *rows, const char *name, const char *degree)
{
    char wanted[64];
    snprintf(wanted, sizeof wanted, "%s%s", name, degree);
    for (int32_t k = 0; k < mps_table_columns(rows); k++)
        if (strcmp(mps_table_name(rows, k), wanted) == 0) return mps_table_values(rows, k);
    return NULL;
}

/* F = R a with R = -A + C/w^2 + i B/w. */
static void find_load(const record_of *r, phasor a, int32_t i, forced *f)
{
    static phasor rest[PERIODS_MOST];
    double x[TERMS];
    const double *load = column(r->rows, "liquid_", forced_names[i]),
                 *walls = column(r->rows, "walls_", forced_names[i]);
    f->A[i] = f->B[i] = f->walls[i] = f->A_band[i] = f->B_band[i] = NAN;
    if (!load || !fit(r, load, x)) return;
    const phasor ratio = over(phasor_of(x), a);
    f->A[i] = -ratio.re;
    f->B[i] = r->omega * ratio.im;
    const int32_t count = find_rest(r, load, x, a, rest);
    f->A_band[i] = band_of(count, rest, false);
    f->B_band[i] = r->omega * band_of(count, rest, true);
    if (walls && fit(r, walls, x)) f->walls[i] = -over(phasor_of(x), a).re;
}

/* ---- a run ---- */

static bool refuse(const choices *c, const char *folder, const char *why)
{
    fprintf(stderr, "mps %s: %s: %s\n", c->verb, folder, why);
    return false;
}

static bool open_record(const choices *c, const char *folder, mps_stats_config *config, char *error,
                        record_of *r)
{
    mps_table *rows = NULL;
    mps_stats_config_init(config, sizeof *config);
    config->error = error;
    config->error_size = ERROR_SIZE;
    if (mps_stats_config_read(folder, config) != MPS_OK ||
        mps_table_read_run(config, folder, "trace.csv", &rows) != MPS_OK)
        return refuse(c, folder, error);
    *r = (record_of){.rows = rows,
                     .n = mps_table_rows(rows),
                     .t = mps_table_values(rows, -1),
                     .dt = column(rows, "dt", "")};
    if (r->n > 1 && r->dt) return true;
    mps_table_destroy(rows);
    return refuse(c, folder, "trace.csv has no steps");
}

static bool find_loads(record_of *r, int32_t degree, forced *f)
{
    double x[TERMS];
    const double *a = column(r->rows, "liquid_a_", forced_names[degree]);
    const double other = 2 * acos(-1.0) / f->T1, free = r->free;
    r->free = 0; /* the tank has no free wave */
    if (!a || !fit(r, a, x)) return false;
    r->free = free;
    f->parted = fabs(other / r->omega - 1) * f->periods >= BEATS;
    if (f->parted) r->free = other;
    for (int32_t i = 0; i < FORCED_DEGREES; i++) find_load(r, phasor_of(x), i, f);
    return true;
}

bool forced_read(const choices *c, const char *folder, int32_t degree, double periods, forced *f)
{
    char error[ERROR_SIZE] = "";
    mps_stats_config config;
    record_of r;
    f->omega = NAN;
    if (!open_record(c, folder, &config, error, &r)) return false;
    r.omega = config.omega;
    r.until = r.t[r.n - 1];
    r.from = r.until - periods * 2 * acos(-1.0) / r.omega;
    f->T1 = config.period;
    f->periods = periods;
    const bool good = isfinite(r.omega) && r.from > 0 && find_loads(&r, degree, f);
    if (good)
        f->omega = r.omega;
    else
        refuse(c, folder, "no harmonic of the motion can be fitted to trace.csv");
    mps_table_destroy((mps_table *)r.rows);
    return good;
}

/* Mean of a column between two times. */
static double mean_of(const record_of *r, const double *value, double from, double until)
{
    double sum = 0, time = 0;
    for (int64_t i = 0; i < r->n; i++)
        if (r->t[i] > from && r->t[i] <= until) {
            sum += r->dt[i] * value[i];
            time += r->dt[i];
        }
    return sum / time;
}

bool forced_tilt_read(const choices *c, const char *folder, const double *from, const double *until,
                      double angle, double C[FORCED_DEGREES])
{
    char error[ERROR_SIZE] = "";
    mps_stats_config config;
    record_of r;
    if (!open_record(c, folder, &config, error, &r)) return false;
    for (int32_t i = 0; i < FORCED_DEGREES; i++) {
        const double *load = column(r.rows, "walls_", forced_names[i]);
        C[i] = load ? -(mean_of(&r, load, from[1], until[1]) -
                        mean_of(&r, load, from[0], until[0])) /
                          angle
                    : NAN;
    }
    mps_table_destroy((mps_table *)r.rows);
    return true;
}

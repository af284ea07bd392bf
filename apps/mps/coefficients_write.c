/* SPDX-License-Identifier: BSD-3-Clause */
/* Writes the tables of mps coefficients. */
#include "coefficients.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { ROLL = 3, PATH_SIZE = SERIES_PATH + 32 };

/* Units of A, B, C by dimension and by the number of rotations among load and motion. */
static const char *const UNIT_A[2][3] = {{"kg/m", "kg", "kg m"}, {"kg", "kg m", "kg m2"}};
static const char *const UNIT_B[2][3] = {{"kg/(m s)", "kg/s", "kg m/s"},
                                         {"kg/s", "kg m/s", "kg m2/s"}};
static const char *const UNIT_C[2][3] = {{"N/m2", "N/m", "N"}, {"N/m", "N", "N m"}};

static const char *unit_of(const coefficients *k, const char *const unit[2][3], int32_t i,
                           int32_t j)
{
    return unit[k->dim - 2][(i >= ROLL) + (j >= ROLL)];
}

static double period_of(const forced *f)
{
    return 2 * acos(-1.0) / f->omega;
}

/* The first result of a motion; NULL: none. */
static const forced *first_of(const coefficients *k, int32_t at)
{
    for (int32_t n = 0; n < k->count; n++)
        if (isfinite(k->result[at * k->count + n].omega)) return &k->result[at * k->count + n];
    return NULL;
}

/* The first result of a frequency, of any motion; NULL: none. */
static const forced *any_of(const coefficients *k, int32_t n)
{
    for (int32_t at = 0; at < k->degrees; at++)
        if (isfinite(k->result[at * k->count + n].omega)) return &k->result[at * k->count + n];
    return NULL;
}

static double omega_of(const coefficients *k, int32_t n)
{
    const forced *any = any_of(k, n);
    return any ? any->omega : INFINITY;
}

void coefficients_sort(coefficients *k)
{
    for (int32_t last = 1; last < k->count; last++)
        for (int32_t n = last; n > 0 && omega_of(k, n) < omega_of(k, n - 1); n--)
            for (int32_t at = 0; at < k->degrees; at++) {
                forced *f = &k->result[at * k->count + n];
                const forced higher = f[-1];
                f[-1] = *f;
                *f = higher;
            }
}

bool coefficients_has(const coefficients *k, int32_t load)
{
    for (int32_t at = 0; at < k->degrees; at++) {
        const forced *f = first_of(k, at);
        if (f && isfinite(f->A[load])) return true;
    }
    return false;
}

static void print_pair(const coefficients *k, int32_t at, int32_t i)
{
    const int32_t j = k->degree[at];
    bool short_runs = false;
    printf("\nload %s by %s; A and its band [%s], B and its band [%s], A by walls", forced_names[i],
           forced_names[j], unit_of(k, UNIT_A, i, j), unit_of(k, UNIT_B, i, j));
    if (j >= ROLL) printf("; C %.5g %s", k->C[i][j], unit_of(k, UNIT_C, i, j));
    printf("\n%10s %10s %8s %11s %9s %11s %9s %11s\n", "w [rad/s]", "period [s]", "T1/T", "A", "+-",
           "B", "+-", "A walls");
    for (int32_t n = 0; n < k->count; n++) {
        const forced *f = &k->result[at * k->count + n];
        if (!isfinite(f->omega)) continue;
        short_runs = short_runs || (isfinite(f->T1) && !f->parted);
        printf("%10.5g %10.5g %8.4g %11.5g %9.2g %11.4g %9.2g %11.5g%s\n", f->omega, period_of(f),
               f->T1 / period_of(f), f->A[i], f->A_band[i], f->B[i], f->B_band[i], f->walls[i],
               isfinite(f->T1) && !f->parted ? " *" : "");
    }
    if (short_runs)
        printf("* too short to tell the forced wave from a free one; --periods has more\n");
}

void coefficients_print(const coefficients *k)
{
    for (int32_t at = 0; at < k->degrees; at++)
        for (int32_t i = 0; i < FORCED_DEGREES; i++)
            if (first_of(k, at) && coefficients_has(k, i)) print_pair(k, at, i);
}

/* ---- files ---- */

static void write_header(const coefficients *k, FILE *out)
{
    fputs("omega[rad/s],period[s]", out);
    for (int32_t at = 0; at < k->degrees; at++)
        for (int32_t i = 0; i < FORCED_DEGREES; i++) {
            const int32_t j = k->degree[at];
            const char *load = forced_names[i], *by = forced_names[j],
                       *a = unit_of(k, UNIT_A, i, j), *b = unit_of(k, UNIT_B, i, j);
            if (!coefficients_has(k, i)) continue;
            fprintf(out, ",A_%s_%s[%s],A_%s_%s_band[%s],B_%s_%s[%s],B_%s_%s_band[%s]", load, by, a,
                    load, by, a, load, by, b, load, by, b);
            fprintf(out, ",A_%s_%s_walls[%s],C_%s_%s[%s]", load, by, a, load, by,
                    unit_of(k, UNIT_C, i, j));
        }
    fputc('\n', out);
}

static void write_row(const coefficients *k, FILE *out, int32_t n)
{
    const forced *any = any_of(k, n);
    if (!any) return;
    fprintf(out, "%.9g,%.9g", any->omega, period_of(any));
    for (int32_t at = 0; at < k->degrees; at++)
        for (int32_t i = 0; i < FORCED_DEGREES; i++) {
            const forced *f = &k->result[at * k->count + n];
            const bool has = isfinite(f->omega);
            if (!coefficients_has(k, i)) continue;
            fprintf(out, ",%.9g,%.9g,%.9g,%.9g,%.9g,%.9g", has ? f->A[i] : NAN,
                    has ? f->A_band[i] : NAN, has ? f->B[i] : NAN, has ? f->B_band[i] : NAN,
                    has ? f->walls[i] : NAN, k->C[i][k->degree[at]]);
        }
    fputc('\n', out);
}

/* Write period, load, motion, A, B only. */
static void write_plain(const coefficients *k, FILE *out, int32_t n)
{
    for (int32_t i = 0; i < FORCED_DEGREES; i++)
        for (int32_t at = 0; at < k->degrees; at++) {
            const forced *f = &k->result[at * k->count + n];
            if (isfinite(f->omega) && isfinite(f->A[i]))
                fprintf(out, "%14.6e %3d %3d %14.6e %14.6e\n", period_of(f), (int)i + 1,
                        (int)k->degree[at] + 1, f->A[i], f->B[i]);
        }
}

/* @return exit code */
static int save(const coefficients *k, const char *name, bool plain)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", k->place, name);
    FILE *out = fopen(path, "w");
    if (out && !plain) write_header(k, out);
    for (int32_t n = 0; out && n < k->count; n++)
        if (plain)
            write_plain(k, out, n);
        else
            write_row(k, out, n);
    bool good = out && !ferror(out);
    if (out && fclose(out) != 0) good = false;
    if (good && !k->c->quiet) fprintf(stderr, "mps %s: %s\n", k->c->verb, path);
    if (!good) fprintf(stderr, "mps %s: %s: %s\n", k->c->verb, path, strerror(errno));
    return good ? MPS_EXIT_OK : MPS_EXIT_FAILED;
}

int coefficients_save(const coefficients *k)
{
    const int code = save(k, "coefficients.csv", false);
    return code == MPS_EXIT_OK ? save(k, "coefficients.dat", true) : code;
}

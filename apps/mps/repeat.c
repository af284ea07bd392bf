/* SPDX-License-Identifier: BSD-3-Clause */
/* mps repeat, mps converge: the same case with several dp. */
#include "constants.h"
#include "series.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { REPEAT_MOST = 100, REPEAT_COUNT = 5, SPACINGS = 3, CELL = 12, PATH_SIZE = SERIES_PATH + 32 };

/* Runs of one case are bitwise equal. Variations of dp and of the time steps within this fraction
 * give other realisations of the flow: the steps vary in all tanks (where a whole number of cells
 * fixes dp, too), with and without motion. */
static const double SPREAD = 0.005;

/* Rows of the first run that has some. */
static const mps_table *first_of(int32_t count, mps_table *const *rows)
{
    for (int32_t k = 0; k < count; k++)
        if (rows[k]) return rows[k];
    return NULL;
}

/* Values of all runs, and a row of the table: mean and bands of the largest value of a column. */
typedef struct figures {
    int32_t count;
    double value[REPEAT_MOST];
    mps_repeat r;
} figures;

/* @return false: no run has a value */
static bool find_figures(figures *f, int32_t count, mps_table *const *rows, int32_t column)
{
    mps_stats_config config;
    mps_stats_config_init(&config, sizeof config);
    mps_repeat_init(&f->r, sizeof f->r);
    f->count = count;
    for (int32_t k = 0; k < count; k++) f->value[k] = series_most(rows[k], column);
    return mps_repeat_find(&config, count, f->value, &f->r) == MPS_OK;
}

static void print_repeat(int32_t count, mps_table *const *rows)
{
    const mps_table *first = first_of(count, rows);
    figures f;
    printf("%-24s %4s %12s %12s %12s %12s %12s\n", "largest value of", "runs", "mean", "least",
           "most", "90 % mean", "90 % next");
    for (int32_t j = 0; j < mps_table_columns(first); j++) {
        if (!find_figures(&f, count, rows, j)) continue;
        const double value[] = {f.r.mean, f.r.least, f.r.most, f.r.mean_band, f.r.next_band};
        printf("%-24s %4d", mps_table_name(first, j), (int)f.r.count);
        for (int k = 0; k < 5; k++) print_quantity(CELL, value[k], mps_table_unit(first, j));
        printf("\n");
    }
}

/* Write repeat.csv: a row for each column that has values, after the spacings as built and the
 * factors of the time step. A failed run has nan. */
static void write_repeat(FILE *out, int32_t count, mps_table *const *rows, const double *dp,
                         const double *factor)
{
    const mps_table *first = first_of(count, rows);
    figures f;
    fputs("largest value of,unit,runs,mean,least,most,deviation,mean_band,next_band", out);
    for (int32_t k = 0; k < count; k++) fprintf(out, ",%03d", (int)k + 1);
    fputs("\ndp,m,,,,,,,", out);
    for (int32_t k = 0; k < count; k++) fprintf(out, ",%.9g", rows[k] ? dp[k] : NAN);
    fputs("\nrun.step_factor,,,,,,,,", out);
    for (int32_t k = 0; k < count; k++) fprintf(out, ",%.9g", rows[k] ? factor[k] : NAN);
    fputc('\n', out);
    for (int32_t j = 0; j < mps_table_columns(first); j++) {
        if (!find_figures(&f, count, rows, j)) continue;
        fprintf(out, "%s,%s,%d,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g", mps_table_name(first, j),
                mps_table_unit(first, j), (int)f.r.count, f.r.mean, f.r.least, f.r.most,
                f.r.deviation, f.r.mean_band, f.r.next_band);
        for (int32_t k = 0; k < count; k++) fprintf(out, ",%.9g", f.value[k]);
        fputc('\n', out);
    }
}

/* Close a table of the verb. @return exit code: `code`, or that of a failed write */
static int close_table(const choices *c, FILE *out, const char *path, int code)
{
    bool good = out && !ferror(out);
    if (out && fclose(out) != 0) good = false;
    if (good && !c->quiet) fprintf(stderr, "mps %s: %s\n", c->verb, path);
    if (good) return code;
    fprintf(stderr, "mps %s: %s: %s\n", c->verb, path, strerror(errno));
    return code == MPS_EXIT_OK ? MPS_EXIT_FAILED : code;
}

/* Open "DIR/repeat.csv". */
static FILE *open_table(const choices *c, char path[PATH_SIZE])
{
    char place[SERIES_PATH];
    series_place(c, place);
    snprintf(path, PATH_SIZE, "%s/%s.csv", place, c->verb);
    return fopen(path, "w");
}

static int save_repeat(const choices *c, int32_t count, mps_table *const *rows, const double *dp,
                       const double *factor, int code)
{
    char path[PATH_SIZE];
    FILE *out = open_table(c, path);
    if (out) write_repeat(out, count, rows, dp, factor);
    return close_table(c, out, path, code);
}

/* Print how the runs differ: a tank that is filled with whole spacings has the same dp for several
 * requested values. */
static void print_varied(int32_t count, mps_table *const *rows, const double *dp)
{
    double least = INFINITY, most = 0;
    int32_t runs = 0, spacings = 0;
    for (int32_t k = 0; k < count; k++) {
        bool earlier = false;
        if (!rows[k]) continue;
        for (int32_t i = 0; i < k; i++)
            earlier = earlier || (rows[i] && fabs(dp[i] - dp[k]) < 1e-9 * dp[k]);
        least = fmin(least, dp[k]);
        most = fmax(most, dp[k]);
        spacings += !earlier;
        runs++;
    }
    printf("varied: time steps by +-%g %%, dp as built ", 100 * SPREAD);
    if (spacings > 1)
        printf("%s to %s (%d different in %d runs)\n", quantity(least, "m"), quantity(most, "m"),
               (int)spacings, (int)runs);
    else
        printf("%s in all runs, whose cells fill the tank\n", quantity(least, "m"));
}

int verb_repeat(const choices *c)
{
    const int32_t count = c->count > 0 ? c->count : REPEAT_COUNT;
    double factor[REPEAT_MOST], dp[REPEAT_MOST];
    mps_table *rows[REPEAT_MOST] = {NULL};
    if (count < 2 || count > REPEAT_MOST) {
        fprintf(stderr, "mps repeat: -n must be 2 to %d\n", REPEAT_MOST);
        return MPS_EXIT_USAGE;
    }
    for (int32_t k = 0; k < count; k++) factor[k] = 1 + SPREAD * (2.0 * k / (count - 1) - 1);
    int code = series_of_dp(c, count, factor, true, rows, dp);
    if (code != MPS_EXIT_INTERRUPTED && first_of(count, rows)) {
        print_varied(count, rows, dp);
        print_repeat(count, rows);
        code = save_repeat(c, count, rows, dp, factor, code);
    }
    for (int32_t k = 0; k < count; k++) mps_table_destroy(rows[k]);
    return code;
}

static const char *const KIND[] = {"monotone", "slow", "oscillating", "same"};

/* Runs are sorted from coarse to fine, spacings of the library from fine to coarse.
 * @return false: a run has no value */
static bool find_order(mps_table *const *rows, const double *dp, int32_t column,
                       double value[SPACINGS], mps_convergence *r)
{
    const double spacing[SPACINGS] = {dp[2], dp[1], dp[0]};
    mps_stats_config config;
    mps_stats_config_init(&config, sizeof config);
    mps_convergence_init(r, sizeof *r);
    for (int32_t k = 0; k < SPACINGS; k++) value[k] = series_most(rows[2 - k], column);
    return mps_converge(&config, spacing, value, r) == MPS_OK;
}

static void print_converge(mps_table *const *rows, const double *dp)
{
    printf("%-24s %12s %12s %12s %12s %7s %12s %s\n", "largest value of", "coarse", "middle",
           "fine", "change", "order", "band", "kind");
    for (int32_t j = 0; j < mps_table_columns(rows[2]); j++) {
        double value[SPACINGS];
        mps_convergence r;
        if (!find_order(rows, dp, j, value, &r)) continue;
        const char *unit = mps_table_unit(rows[2], j);
        const double shown[] = {value[2], value[1], value[0], value[0] - value[1]};
        printf("%-24s", mps_table_name(rows[2], j));
        for (int k = 0; k < 4; k++) print_quantity(CELL, shown[k], unit);
        print_quantity(7, r.order, "");
        print_quantity(CELL, r.band, unit);
        printf(" %s\n", KIND[r.kind]);
    }
}

/* Write converge.csv: a row for each column, after the spacings as built. */
static int save_converge(const choices *c, mps_table *const *rows, const double *dp)
{
    char path[PATH_SIZE];
    FILE *out = open_table(c, path);
    if (out)
        fprintf(out,
                "largest value of,unit,coarse,middle,fine,change,order,limit,band,kind\n"
                "dp,m,%.9g,%.9g,%.9g,,,,,\n",
                dp[0], dp[1], dp[2]);
    for (int32_t j = 0; out && j < mps_table_columns(rows[2]); j++) {
        double value[SPACINGS];
        mps_convergence r;
        if (!find_order(rows, dp, j, value, &r)) continue;
        fprintf(out, "%s,%s,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%s\n", mps_table_name(rows[2], j),
                mps_table_unit(rows[2], j), value[2], value[1], value[0], value[0] - value[1],
                r.order, r.limit, r.band, KIND[r.kind]);
    }
    return close_table(c, out, path, MPS_EXIT_OK);
}

int verb_converge(const choices *c)
{
    const double factor[SPACINGS] = {2, sqrt(2), 1};
    double dp[SPACINGS];
    mps_table *rows[SPACINGS] = {NULL};
    int code = series_of_dp(c, SPACINGS, factor, false, rows, dp);
    const bool all = rows[0] && rows[1] && rows[2];
    if (all && !(dp[0] > dp[1] && dp[1] > dp[2])) {
        fprintf(stderr,
                "mps converge: %g, %g and %g m are not three spacings from coarse to fine\n", dp[0],
                dp[1], dp[2]);
        code = MPS_EXIT_FAILED;
    } else if (all) {
        printf("dp as built: %s, %s, %s\n", quantity(dp[0], "m"), quantity(dp[1], "m"),
               quantity(dp[2], "m"));
        print_converge(rows, dp);
        code = save_converge(c, rows, dp);
    }
    for (int32_t k = 0; k < SPACINGS; k++) mps_table_destroy(rows[k]);
    return code;
}

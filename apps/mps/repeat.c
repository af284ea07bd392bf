/* SPDX-License-Identifier: BSD-3-Clause */
/* mps repeat, mps converge: the same case with several dp. */
#include "series.h"
#include <math.h>
#include <stdio.h>

enum { REPEAT_MOST = 100, REPEAT_COUNT = 5, SPACINGS = 3, NAME_SIZE = 80 };

/* Runs of one case differ by rounding alone; dp within this share gives others of the same flow. */
static const double SPREAD = 0.005;

/* Rows of the first run that has some. */
static const mps_table *first_of(int32_t count, mps_table *const *rows)
{
    for (int32_t k = 0; k < count; k++)
        if (rows[k]) return rows[k];
    return NULL;
}

/* "P1 [Pa]" */
static void name_of(const mps_table *rows, int32_t column, char out[NAME_SIZE])
{
    const char *unit = mps_table_unit(rows, column);
    snprintf(out, NAME_SIZE, unit[0] ? "%s [%s]" : "%s", mps_table_name(rows, column), unit);
}

static void print_repeat(int32_t count, mps_table *const *rows)
{
    const mps_table *first = first_of(count, rows);
    double value[REPEAT_MOST];
    char name[NAME_SIZE];
    mps_stats_config config;
    mps_stats_config_init(&config, sizeof config);
    printf("%-28s %4s %12s %12s %12s %12s %12s\n", "largest value of", "runs", "mean", "least",
           "most", "90 % mean", "90 % next");
    for (int32_t j = 0; j < mps_table_columns(first); j++) {
        mps_repeat r;
        mps_repeat_init(&r, sizeof r);
        for (int32_t k = 0; k < count; k++) value[k] = series_most(rows[k], j);
        if (mps_repeat_find(&config, count, value, &r) != MPS_OK) continue;
        name_of(first, j, name);
        printf("%-28s %4d %12.5g %12.5g %12.5g %12.3g %12.3g\n", name, (int)r.count, r.mean,
               r.least, r.most, r.mean_band, r.next_band);
    }
}

/* A tank that is filled with whole spacings gives the same dp for several that were asked for: the same run, which counts once. */
static void drop_same(int32_t count, mps_table **rows, const double *dp)
{
    int32_t same = 0;
    for (int32_t k = 0; k < count; k++) {
        bool earlier = false;
        for (int32_t i = 0; i < k && rows[k]; i++)
            earlier = earlier || (rows[i] && fabs(dp[i] - dp[k]) < 1e-9 * dp[k]);
        if (!earlier) continue;
        mps_table_destroy(rows[k]);
        rows[k] = NULL;
        same++;
    }
    if (same > 0)
        fprintf(stderr,
                "mps repeat: %d of %d runs were built with the dp of an earlier one, so that it "
                "fits into the tank; they do not count. A finer dp, or 'tank.polygon', gives more "
                "runs\n",
                (int)same, (int)count);
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
    const int code = series_of_dp(c, count, factor, rows, dp);
    drop_same(count, rows, dp);
    if (code != MPS_EXIT_INTERRUPTED && first_of(count, rows)) print_repeat(count, rows);
    for (int32_t k = 0; k < count; k++) mps_table_destroy(rows[k]);
    return code;
}

/* Runs are from coarse to fine, spacings of the library from fine to coarse. */
static void print_converge(mps_table *const *rows, const double *dp)
{
    static const char *const kind[] = {"monotone", "slow", "oscillating", "same"};
    const double spacing[SPACINGS] = {dp[2], dp[1], dp[0]};
    char name[NAME_SIZE];
    mps_stats_config config;
    mps_stats_config_init(&config, sizeof config);
    printf("%-28s %12s %12s %12s %10s %7s %10s %s\n", "largest value of", "coarse", "middle",
           "fine", "change", "order", "band", "kind");
    for (int32_t j = 0; j < mps_table_columns(rows[2]); j++) {
        double value[SPACINGS];
        mps_convergence r;
        mps_convergence_init(&r, sizeof r);
        for (int32_t k = 0; k < SPACINGS; k++) value[k] = series_most(rows[2 - k], j);
        if (mps_converge(&config, spacing, value, &r) != MPS_OK) continue;
        name_of(rows[2], j, name);
        printf("%-28s %12.5g %12.5g %12.5g %10.3g %7.3g %10.3g %s\n", name, value[2], value[1],
               value[0], value[0] - value[1], r.order, r.band, kind[r.kind]);
    }
}

int verb_converge(const choices *c)
{
    const double factor[SPACINGS] = {2, sqrt(2), 1};
    double dp[SPACINGS];
    mps_table *rows[SPACINGS] = {NULL};
    int code = series_of_dp(c, SPACINGS, factor, rows, dp);
    if (rows[0] && rows[1] && rows[2] && !(dp[0] > dp[1] && dp[1] > dp[2])) {
        fprintf(stderr,
                "mps converge: %g, %g and %g m are not three spacings from coarse to fine\n", dp[0],
                dp[1], dp[2]);
        code = MPS_EXIT_FAILED;
    } else if (rows[0] && rows[1] && rows[2]) {
        printf("dp as built: %g, %g, %g m\n", dp[0], dp[1], dp[2]);
        print_converge(rows, dp);
    }
    for (int32_t k = 0; k < SPACINGS; k++) mps_table_destroy(rows[k]);
    return code;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Several runs of one case, a folder each. */
#include "jobs.h"
#include "summary.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { ERROR_SIZE = 1024, THREADS = 2 /* of a run by default */ };

bool series_folder(const char *folder, int64_t index, char out[SERIES_PATH])
{
    return snprintf(out, SERIES_PATH, "%s/%03lld", folder, (long long)index + 1) < SERIES_PATH;
}

void series_place(const choices *c, char out[SERIES_PATH])
{
    cli_stem(c->file[0], out, SERIES_PATH);
    if (c->out) snprintf(out, SERIES_PATH, "%s", c->out);
}

/* Whether a folder has something of that name, of any kind. */
static bool exists(const char *folder, const char *name)
{
    char path[SERIES_PATH + 32];
    struct stat s;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return stat(path, &s) == 0;
}

/* Next line of a text except the threads: results do not depend on them. */
static const char *next_line(const char *text, size_t *length)
{
    static const char threads[] = "  threads: ";
    for (;; text += *length) {
        *length = strcspn(text, "\n");
        if (text[*length]) ++*length;
        if (strncmp(text, threads, sizeof threads - 1) != 0) return text;
    }
}

static bool same_lines(const char *a, const char *b)
{
    size_t m, n;
    do {
        a = next_line(a, &m);
        b = next_line(b, &n);
        if (m != n || memcmp(a, b, n) != 0) return false;
        a += m;
        b += n;
    } while (n > 0);
    return true;
}

/* Whether the case of the folder is this one. */
static bool same_case(const mps_case *tank, const char *folder)
{
    char path[SERIES_PATH + 32];
    mps_case *earlier = NULL;
    snprintf(path, sizeof path, "%s/case.yaml", folder);
    const mps_status status = mps_case_read(path, 0, NULL, &earlier);
    const bool same = status == MPS_OK && same_lines(mps_case_text(tank), mps_case_text(earlier));
    mps_case_destroy(earlier);
    return same;
}

static int refuse_other(const choices *c, const char *folder)
{
    fprintf(stderr,
            "mps %s: %s: there is a run of another case; --overwrite removes it, or choose "
            "another folder with --out\n",
            c->verb, folder);
    return MPS_EXIT_USAGE;
}

/* With several processes, as many threads each as use all processors; results do not depend on
 * them. */
static void share_processors(choices *one, const mps_case *tank)
{
    static const char threads[] = "\n  threads: ";
    const char *line = tank ? strstr(mps_case_text(tank), threads) : NULL;
    const int32_t asked = line ? (int32_t)strtol(line + sizeof threads - 1, NULL, 10) : THREADS,
                  most = jobs_processors() / one->jobs;
    if (one->jobs > 1 && one->threads == 0 && asked > most) one->threads = most > 1 ? most : 1;
}

int series_run(const choices *c, const char *folder, bool *busy)
{
    char error[ERROR_SIZE] = "";
    choices one = *c;
    mps_case *tank = NULL;
    mps_job_config config;
    mps_job_config_init(&config, sizeof config);
    config.error = error;
    config.error_size = sizeof error;
    const bool read = cli_open(c, &tank) == MPS_OK;
    if (read && c->jobs > 1) share_processors(&one, tank);
    const bool earlier = exists(folder, "case.yaml") && !c->overwrite,
               same = earlier && read && same_case(tank, folder);
    mps_case_destroy(tank);
    if (earlier && !same) return refuse_other(c, folder);
    if (same && summary_is_done(folder)) {
        if (!c->quiet) fprintf(stderr, "mps %s: %s: is done already\n", c->verb, folder);
        return MPS_EXIT_OK;
    }
    config.resume = same;
    const int code = cli_run(&one, &config, folder, busy);
    /* another process finished it after the check above */
    return code == MPS_EXIT_USAGE && same && summary_is_done(folder) ? MPS_EXIT_OK : code;
}

mps_table *series_table(const choices *c, const char *folder)
{
    char error[ERROR_SIZE] = "";
    mps_stats_config config;
    mps_table *rows = NULL;
    if (!summary_is_done(folder)) return NULL;
    mps_stats_config_init(&config, sizeof config);
    config.error = error;
    config.error_size = sizeof error;
    if (mps_table_read_run(&config, folder, "probes.csv", &rows) == MPS_OK) return rows;
    fprintf(stderr, "mps %s: %s\n", c->verb, error);
    return NULL;
}

bool series_key(const mps_case *tank, const char *key, char *out, size_t size)
{
    const size_t length = strlen(key);
    for (const char *line = mps_case_text(tank); *line;) {
        const size_t end = strcspn(line, "\n");
        if (strncmp(line, key, length) == 0 && strncmp(line + length, ": ", 2) == 0)
            return (size_t)snprintf(out, size, "%.*s", (int)(end - length - 2), line + length + 2) <
                   size;
        line += end + (line[end] == '\n');
    }
    return false;
}

double series_most(const mps_table *rows, int32_t column)
{
    const double *value = mps_table_values(rows, column);
    double most = NAN;
    for (int64_t i = 0; value && i < mps_table_rows(rows); i++) most = fmax(most, value[i]);
    return most;
}

/* ---- runs with several dp ---- */

/* The number of dp, and the rest of its text: its unit. */
static int read_dp(const choices *c, double *dp, char unit[SERIES_DP])
{
    char text[SERIES_DP], *end;
    int code = MPS_EXIT_FAILED;
    mps_case *tank = cli_case(c, &code);
    if (!tank) return code;
    const bool swept = mps_case_sweep_count(tank) > 0;
    const bool read = series_key(tank, "dp", text, sizeof text);
    mps_case_destroy(tank);
    if (swept) {
        fprintf(stderr, "mps %s: the case has a sweep; use 'mps sweep'\n", c->verb);
        return MPS_EXIT_USAGE;
    }
    *dp = read ? strtod(text, &end) : 0;
    if (!(*dp > 0)) {
        fprintf(stderr, "mps %s: %s: dp must be one number and a unit\n", c->verb, c->file[0]);
        return MPS_EXIT_USAGE;
    }
    snprintf(unit, SERIES_DP, "%s", end);
    return MPS_EXIT_OK;
}

/* Runs that differ in their spacing. */
typedef struct spacings {
    const double *factor;
    double given;
    char unit[SERIES_DP], set[2 * SERIES_DP + 8], step[64];
    bool steps;
} spacings;

static bool set_spacing(void *user, int64_t index, choices *one)
{
    spacings *s = user;
    const double factor = s->factor[index];
    snprintf(s->set, sizeof s->set, "dp=%.9g%s", s->given * factor, s->unit);
    one->set[one->sets++] = s->set;
    snprintf(s->step, sizeof s->step, "run.step_factor=%.9g", factor);
    if (s->steps) one->set[one->sets++] = s->step;
    return true;
}

int series_of_dp(const choices *c, int32_t count, const double *factor, bool steps,
                 mps_table **rows, double *dp)
{
    spacings s = {.factor = factor, .steps = steps};
    plan p = {.c = c, .runs = count, .set = set_spacing, .user = &s};
    char folder[SERIES_PATH];
    int worst = read_dp(c, &s.given, s.unit);
    if (worst != MPS_EXIT_OK) return worst;
    series_place(c, p.place);
    worst = plan_run(&p);
    for (int32_t k = 0; p.code && k < count; k++) {
        const bool done = p.code[k] == MPS_EXIT_OK && series_folder(p.place, k, folder);
        rows[k] = done ? series_table(c, folder) : NULL;
        dp[k] = rows[k] ? summary_number(folder, "dp") : NAN;
    }
    if (p.code) plan_print_open(&p);
    free(p.code);
    return worst;
}

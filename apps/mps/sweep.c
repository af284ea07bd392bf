/* SPDX-License-Identifier: BSD-3-Clause */
/* mps sweep: all combinations of a case's `sweep`. */
#include "collect.h"
#include "plan.h"
#include "summary.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { UNIT_SIZE = 16 };

typedef struct sweep {
    plan p;
    mps_case *tank;
    collect collect;
    int32_t paths;
    bool known; /* a run has the collected columns */
    char set[CLI_SETS][SERIES_VALUE];
} sweep;

/* ---- the table ---- */

/* Rows of run number `index`, NULL: none. */
static mps_table *rows_of(const sweep *s, int64_t index)
{
    char folder[SERIES_PATH];
    if (!series_folder(s->p.place, index, folder) || !summary_is_done(folder)) return NULL;
    return series_table(s->p.c, folder);
}

/* Value `k` of a run in SI, with dp and T1 of the run. @return nan: a word, or not known */
static double si_value(const sweep *s, int64_t index, int32_t k, char unit[UNIT_SIZE])
{
    char set[SERIES_VALUE], folder[SERIES_PATH];
    double value = NAN, dp = NAN, T1 = NAN;
    unit[0] = '\0';
    if (mps_case_sweep_get(s->tank, index, k, set, sizeof set) != MPS_OK ||
        !series_folder(s->p.place, index, folder))
        return NAN;
    if (s->p.code[index] == MPS_EXIT_OK) {
        dp = summary_number(folder, "dp_requested");
        T1 = summary_T1(folder);
    }
    if (mps_case_quantity(set + strcspn(set, "=") + 1, dp, T1, &value, unit, UNIT_SIZE) != MPS_OK)
        unit[0] = '\0';
    return value;
}

/* Whether a value is numeric and has a column "motion.surge.period.si[s]" beside its texts. */
static bool is_number(const sweep *s, int32_t k, char unit[UNIT_SIZE])
{
    char set[SERIES_VALUE];
    double value;
    return mps_case_sweep_get(s->tank, 0, k, set, sizeof set) == MPS_OK &&
           mps_case_quantity(set + strcspn(set, "=") + 1, NAN, NAN, &value, unit, UNIT_SIZE) ==
               MPS_OK;
}

static void write_si_name(const sweep *s, FILE *out, int32_t k)
{
    char set[SERIES_VALUE], unit[UNIT_SIZE];
    if (!is_number(s, k, unit)) return;
    mps_case_sweep_get(s->tank, 0, k, set, sizeof set);
    fprintf(out, ",%.*s.si", (int)strcspn(set, "="), set);
    if (unit[0]) fprintf(out, "[%s]", unit);
}

static void write_names(const sweep *s, FILE *out, const mps_table *rows)
{
    char set[SERIES_VALUE];
    fputs("run", out);
    for (int32_t k = 0; k < s->paths; k++)
        if (mps_case_sweep_get(s->tank, 0, k, set, sizeof set) == MPS_OK)
            fprintf(out, ",%.*s", (int)strcspn(set, "="), set);
    for (int32_t k = 0; k < s->paths; k++) write_si_name(s, out, k);
    fputs(",exit", out);
    collect_names(&s->collect, out, rows);
    fputc('\n', out);
}

static void write_run(sweep *s, FILE *out, int64_t index, const mps_table *first)
{
    char set[SERIES_VALUE], folder[SERIES_PATH] = "", unit[UNIT_SIZE];
    const int code = s->p.code[index];
    mps_table *rows = code == MPS_EXIT_OK ? rows_of(s, index) : NULL;
    series_folder(s->p.place, index, folder);
    fprintf(out, "%03lld", (long long)index + 1);
    for (int32_t k = 0; k < s->paths; k++)
        if (mps_case_sweep_get(s->tank, index, k, set, sizeof set) == MPS_OK)
            collect_text(out, set + strcspn(set, "=") + 1);
    for (int32_t k = 0; k < s->paths; k++)
        if (is_number(s, k, unit)) fprintf(out, ",%.9g", si_value(s, index, k, unit));
    fprintf(out, code == PLAN_OPEN ? ",nan" : ",%d", code);
    collect_values(&s->collect, out, first, folder, rows);
    fputc('\n', out);
    mps_table_destroy(rows);
}

static int write_table(sweep *s)
{
    char path[SERIES_PATH + 16];
    mps_table *first = NULL;
    for (int64_t i = 0; i < s->p.runs && !first; i++) first = rows_of(s, i);
    if (!first) return MPS_EXIT_OK; /* no run has values */
    snprintf(path, sizeof path, "%s/sweep.csv", s->p.place);
    FILE *out = collect_open(path);
    if (out) write_names(s, out, first);
    for (int64_t i = 0; out && i < s->p.runs; i++) write_run(s, out, i, first);
    mps_table_destroy(first);
    const int code = collect_close(s->p.c->verb, out, path);
    if (code != MPS_EXIT_OK || s->p.c->quiet) return code;
    fprintf(stderr, "mps %s: table of the runs: %s\n", s->p.c->verb, path);
    collect_print_missing(&s->collect);
    return code;
}

/* ---- the runs ---- */

static bool set_values(void *user, int64_t index, choices *one)
{
    sweep *s = user;
    for (int32_t k = 0; k < s->paths; k++) {
        if (mps_case_sweep_get(s->tank, index, k, s->set[k], sizeof s->set[k]) != MPS_OK) {
            fprintf(stderr, "mps %s: a value of 'sweep' is too long\n", one->verb);
            return false;
        }
        one->set[one->sets++] = s->set[k];
    }
    return true;
}

/* Check the collected columns in the first finished run. */
static bool fits(void *user, int64_t index)
{
    sweep *s = user;
    mps_table *rows = s->known ? NULL : rows_of(s, index);
    const bool good = !rows || collect_fits(&s->collect, rows);
    s->known = s->known || rows;
    mps_table_destroy(rows);
    return good;
}

static bool open_sweep(sweep *s, const choices *c, int *code)
{
    *s = (sweep){.p = {.c = c, .set = set_values, .fits = fits, .user = s},
                 .tank = cli_case(c, code)};
    if (!s->tank) return false;
    s->p.runs = mps_case_runs(s->tank);
    s->paths = mps_case_sweep_count(s->tank);
    *code = MPS_EXIT_USAGE;
    if (s->paths == 0)
        fprintf(stderr, "mps %s: %s: the case has no 'sweep'; use 'mps run'\n", c->verb,
                c->file[0]);
    else if (c->sets + s->paths > CLI_SETS)
        fprintf(stderr, "mps %s: at most %d values of --set and paths of 'sweep'\n", c->verb,
                CLI_SETS);
    else if (collect_read(&s->collect, s->tank, c->verb, c->file[0]))
        return true;
    return false;
}

int verb_sweep(const choices *c)
{
    static sweep s;
    int code = MPS_EXIT_FAILED;
    const bool good = open_sweep(&s, c, &code);
    if (good) {
        series_place(c, s.p.place);
        code = plan_run(&s.p);
        const int table = s.p.code ? write_table(&s) : MPS_EXIT_OK;
        if (s.p.code) plan_print_open(&s.p);
        if (code == MPS_EXIT_OK) code = table;
    }
    free(s.p.code);
    mps_case_destroy(s.tank);
    return code;
}

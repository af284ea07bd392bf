/* SPDX-License-Identifier: BSD-3-Clause */
/* mps sweep: all combinations of a case's `sweep`, one after the other. */
#include "collect.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct sweep {
    const choices *c;
    mps_case *tank;
    char place[SERIES_PATH];
    collect collect;
    int32_t paths;
    int64_t runs;
    int *code; /* [runs] */
} sweep;

/* ---- the table ---- */

/* Rows of run number `index`, NULL where it has none. */
static mps_table *rows_of(const sweep *s, int64_t index)
{
    char folder[SERIES_PATH];
    if (s->code[index] != MPS_EXIT_OK || !series_folder(s->place, index, folder)) return NULL;
    return series_table(s->c, folder);
}

static void write_names(const sweep *s, FILE *out, const mps_table *rows)
{
    char set[SERIES_VALUE];
    fputs("run", out);
    for (int32_t k = 0; k < s->paths; k++)
        if (mps_case_sweep_get(s->tank, 0, k, set, sizeof set) == MPS_OK)
            fprintf(out, ",%.*s", (int)strcspn(set, "="), set);
    fputs(",exit", out);
    collect_names(&s->collect, out, rows);
    fputc('\n', out);
}

/* A value with its unit, as a field of a CSV file. */
static void write_value(FILE *out, const char *text)
{
    const bool quote = strpbrk(text, ",\"") != NULL;
    fputs(quote ? ",\"" : ",", out);
    for (; *text; text++) {
        if (*text == '"') fputc('"', out);
        fputc(*text, out);
    }
    if (quote) fputc('"', out);
}

static void write_run(const sweep *s, FILE *out, int64_t index, const mps_table *first)
{
    char set[SERIES_VALUE], folder[SERIES_PATH] = "";
    mps_table *rows = rows_of(s, index);
    series_folder(s->place, index, folder);
    fprintf(out, "%03lld", (long long)index + 1);
    for (int32_t k = 0; k < s->paths; k++)
        if (mps_case_sweep_get(s->tank, index, k, set, sizeof set) == MPS_OK)
            write_value(out, set + strcspn(set, "=") + 1);
    fprintf(out, ",%d", s->code[index]);
    collect_values(&s->collect, out, first, folder, rows);
    fputc('\n', out);
    mps_table_destroy(rows);
}

static int write_table(const sweep *s, int64_t done)
{
    char path[SERIES_PATH + 16];
    mps_table *first = NULL;
    for (int64_t i = 0; i < done && !first; i++) first = rows_of(s, i);
    if (!first) return MPS_EXIT_OK; /* no run has values */
    snprintf(path, sizeof path, "%s/sweep.csv", s->place);
    FILE *out = fopen(path, "w");
    if (out) {
        write_names(s, out, first);
        for (int64_t i = 0; i < done; i++) write_run(s, out, i, first);
    }
    mps_table_destroy(first);
    bool good = out && !ferror(out);
    if (out && fclose(out) != 0) good = false;
    if (!good) fprintf(stderr, "mps %s: %s: %s\n", s->c->verb, path, strerror(errno));
    return good ? MPS_EXIT_OK : MPS_EXIT_FAILED;
}

/* ---- the runs ---- */

/* Run number `index` with its values. */
static int run_one(const sweep *s, int64_t index)
{
    static char set[CLI_SETS][SERIES_VALUE];
    char folder[SERIES_PATH];
    choices one = *s->c;
    if (!series_folder(s->place, index, folder)) return MPS_EXIT_USAGE;
    if (!one.quiet)
        fprintf(stderr, "mps sweep: run %lld of %lld:", (long long)index + 1, (long long)s->runs);
    for (int32_t k = 0; k < s->paths; k++) {
        if (mps_case_sweep_get(s->tank, index, k, set[k], sizeof set[k]) != MPS_OK)
            return MPS_EXIT_FAILED;
        one.set[one.sets++] = set[k];
        if (!one.quiet) fprintf(stderr, " %s", set[k]);
    }
    if (!one.quiet) fputc('\n', stderr);
    return series_run(&one, folder);
}

/* @return runs that were tried; *code: the worst of theirs, or why the sweep ended */
static int64_t run_all(const sweep *s, int *code)
{
    bool known = false;
    for (int64_t i = 0; i < s->runs; i++) {
        s->code[i] = run_one(s, i);
        if (s->code[i] > *code) *code = s->code[i];
        if (s->code[i] == MPS_EXIT_INTERRUPTED) return i + 1;
        mps_table *rows = known ? NULL : rows_of(s, i);
        if (rows && !collect_fits(&s->collect, rows)) {
            mps_table_destroy(rows);
            *code = MPS_EXIT_USAGE;
            return 0;
        }
        known = known || rows;
        mps_table_destroy(rows);
    }
    return s->runs;
}

static int sweep_runs(sweep *s)
{
    int code = MPS_EXIT_OK;
    s->code = calloc((size_t)s->runs, sizeof *s->code);
    if (!s->code) return MPS_EXIT_FAILED;
    const int64_t done = run_all(s, &code);
    const int table = write_table(s, done);
    for (int64_t i = 0; i < done; i++)
        if (s->code[i] != MPS_EXIT_OK)
            fprintf(stderr, "mps sweep: %s/%03lld %s, exit code %d\n", s->place, (long long)i + 1,
                    s->code[i] == MPS_EXIT_INTERRUPTED ? "was interrupted" : "failed", s->code[i]);
    free(s->code);
    return code != MPS_EXIT_OK ? code : table;
}

int verb_sweep(const choices *c)
{
    static sweep s;
    int code = MPS_EXIT_FAILED;
    s = (sweep){.c = c, .tank = cli_case(c, &code)};
    if (!s.tank) return code;
    s.runs = mps_case_runs(s.tank);
    s.paths = mps_case_sweep_count(s.tank);
    series_place(c, s.place);
    code = MPS_EXIT_USAGE;
    if (s.paths == 0)
        fprintf(stderr, "mps sweep: %s: the case has no 'sweep'; use 'mps run'\n", c->file[0]);
    else if (c->sets + s.paths > CLI_SETS)
        fprintf(stderr, "mps sweep: at most %d values of --set and paths of 'sweep'\n", CLI_SETS);
    else if (collect_read(&s.collect, s.tank, c->verb))
        code = sweep_runs(&s);
    mps_case_destroy(s.tank);
    return code;
}

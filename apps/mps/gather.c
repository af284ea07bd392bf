/* SPDX-License-Identifier: BSD-3-Clause */
/* mps collect: one table of the runs in folders, with the inputs that differ between them. */
#include "collect.h"
#include "grow.h"
#include "plan.h"
#include "summary.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <dirent.h>
#include <unistd.h>

enum { RUNS_MOST = 100000, UNIT_SIZE = 16, VARIED_MOST = 64 };

/* An input of a run. */
typedef struct input {
    char key[SUMMARY_TEXT], value[SUMMARY_TEXT];
} input;

typedef struct collected_run {
    char *folder;
    int32_t inputs;
    input *input;
} collected_run;

typedef struct collection {
    const choices *c;
    int32_t runs;
    collected_run *run;
    int32_t varied;
    char key[VARIED_MOST][SUMMARY_TEXT];
    collect collect;
} collection;

/* ---- runs ---- */

static bool has_summary(const char *folder)
{
    char path[SERIES_PATH + 16];
    struct stat s;
    snprintf(path, sizeof path, "%s/summary.json", folder);
    return stat(path, &s) == 0 && S_ISREG(s.st_mode);
}

static bool add_run(collection *g, const char *folder)
{
    collected_run *grown = mps__grown(g->run, g->runs, sizeof *grown);
    char *copy = malloc(strlen(folder) + 1);
    if (grown) g->run = grown;
    if (!grown || !copy || g->runs == RUNS_MOST) {
        free(copy);
        return false;
    }
    memcpy(copy, folder, strlen(folder) + 1);
    grown[g->runs++] = (collected_run){.folder = copy};
    return true;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(((const collected_run *)a)->folder, ((const collected_run *)b)->folder);
}

/* Add a folder of a run, or the runs in its folders. @return exit code, -1: continue */
static int add_folder(collection *g, const char *folder)
{
    char path[SERIES_PATH];
    const int32_t before = g->runs;
    bool done = !has_summary(folder) || add_run(g, folder);
    DIR *all = before == g->runs ? opendir(folder) : NULL;
    if (before == g->runs && !all) {
        fprintf(stderr, "mps collect: %s: %s\n", folder, strerror(errno));
        return MPS_EXIT_USAGE;
    }
    for (const struct dirent *e; done && all && (e = readdir(all)) != NULL;)
        if (e->d_name[0] != '.' &&
            snprintf(path, sizeof path, "%s/%s", folder, e->d_name) < (int)sizeof path &&
            has_summary(path))
            done = add_run(g, path);
    if (all) closedir(all);
    if (!done) {
        fprintf(stderr, "mps collect: no memory, or more than %d runs\n", RUNS_MOST);
        return MPS_EXIT_FAILED;
    }
    if (g->runs > before)
        qsort(g->run + before, (size_t)(g->runs - before), sizeof *g->run, by_name);
    if (g->runs > before) return -1;
    fprintf(stderr, "mps collect: %s: is no folder of a run, and has none with a summary.json\n",
            folder);
    return MPS_EXIT_USAGE;
}

/* ---- inputs that differ ---- */

static const char *value_of(const collected_run *r, const char *key)
{
    for (int32_t k = 0; k < r->inputs; k++)
        if (strcmp(r->input[k].key, key) == 0) return r->input[k].value;
    return NULL;
}

/* Whether the input follows from others ("T1", "motion omega"), or does not change a result. */
static bool is_of_no_interest(const char *key)
{
    static const char *const all[] = {"T1", "run.threads", "run.checkpoint_clock",
                                      "run.checkpoint"};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++)
        if (strcmp(key, all[k]) == 0) return true;
    return strchr(key, ' ') != NULL;
}

static bool differs(const collection *g, const char *key)
{
    const char *first = value_of(&g->run[0], key);
    for (int32_t i = 1; i < g->runs; i++) {
        const char *value = value_of(&g->run[i], key);
        if (!first != !value || (first && strcmp(first, value) != 0)) return true;
    }
    return false;
}

static bool is_known(const collection *g, const char *key)
{
    for (int32_t k = 0; k < g->varied; k++)
        if (strcmp(g->key[k], key) == 0) return true;
    return false;
}

static bool find_varied(collection *g)
{
    for (int32_t i = 0; i < g->runs; i++) {
        collected_run *r = &g->run[i];
        char key[SUMMARY_TEXT], value[SUMMARY_TEXT];
        for (int32_t k = 0; summary_input(r->folder, k, key, value); k++) {
            input *grown = mps__grown(r->input, k, sizeof *grown);
            if (!grown) return false;
            r->input = grown;
            snprintf(grown[k].key, SUMMARY_TEXT, "%s", key);
            snprintf(grown[k].value, SUMMARY_TEXT, "%s", value);
            r->inputs++;
        }
    }
    for (int32_t i = 0; i < g->runs; i++)
        for (int32_t k = 0; k < g->run[i].inputs; k++) {
            const char *key = g->run[i].input[k].key;
            if (g->varied < VARIED_MOST && !is_of_no_interest(key) && !is_known(g, key) &&
                differs(g, key))
                snprintf(g->key[g->varied++], SUMMARY_TEXT, "%s", key);
        }
    return true;
}

/* ---- the table ---- */

/* @return nan: the run has no exit code */
static double exit_of(const char *folder)
{
    char status[SUMMARY_TEXT];
    if (!summary_text(folder, "status", status) || strcmp(status, "unfinished") == 0) return NAN;
    return strcmp(status, "ok") == 0              ? MPS_EXIT_OK
           : strcmp(status, "MPS_W_STOPPED") == 0 ? MPS_EXIT_INTERRUPTED
           : strcmp(status, "MPS_E_IO") == 0      ? MPS_EXIT_FAILED
                                                  : MPS_EXIT_DIVERGED;
}

static double si_value(const collected_run *r, const char *key, char unit[UNIT_SIZE])
{
    const char *text = value_of(r, key);
    double value = NAN;
    unit[0] = '\0';
    if (text && mps_case_quantity(text, summary_number(r->folder, "dp_requested"),
                                  summary_T1(r->folder), &value, unit, UNIT_SIZE) != MPS_OK)
        unit[0] = '\0';
    return value;
}

/* Whether an input is numeric; the unit of the first. */
static bool is_number(const collection *g, const char *key, char unit[UNIT_SIZE])
{
    double value;
    for (int32_t i = 0; i < g->runs; i++) {
        const char *text = value_of(&g->run[i], key);
        if (text) return mps_case_quantity(text, NAN, NAN, &value, unit, UNIT_SIZE) == MPS_OK;
    }
    return false;
}

static void write_names(const collection *g, FILE *out, const mps_table *first)
{
    char unit[UNIT_SIZE];
    fputs("run", out);
    for (int32_t k = 0; k < g->varied; k++) collect_text(out, g->key[k]);
    for (int32_t k = 0; k < g->varied; k++)
        if (is_number(g, g->key[k], unit))
            fprintf(out, unit[0] ? ",%s.si[%s]" : ",%s.si", g->key[k], unit);
    fputs(",exit", out);
    collect_names(&g->collect, out, first);
    fputc('\n', out);
}

static void write_run(collection *g, FILE *out, int32_t i, const mps_table *first)
{
    const collected_run *r = &g->run[i];
    char unit[UNIT_SIZE];
    const double code = exit_of(r->folder);
    mps_table *rows = code == MPS_EXIT_OK ? series_table(g->c, r->folder) : NULL;
    fputs(r->folder, out);
    for (int32_t k = 0; k < g->varied; k++) {
        const char *value = value_of(r, g->key[k]);
        collect_text(out, value ? value : "");
    }
    for (int32_t k = 0; k < g->varied; k++)
        if (is_number(g, g->key[k], unit)) fprintf(out, ",%.9g", si_value(r, g->key[k], unit));
    fprintf(out, ",%.9g", code);
    collect_values(&g->collect, out, first, r->folder, rows);
    fputc('\n', out);
    mps_table_destroy(rows);
}

/* Read `collect` of the case of a run.
 * @param path  set to the file of the case */
static bool read_collect(collection *g, const char *folder, char path[SERIES_PATH + 16])
{
    mps_case *tank = NULL;
    snprintf(path, SERIES_PATH + 16, "%s/case.yaml", folder);
    const bool read = mps_case_read(path, 0, NULL, &tank) == MPS_OK;
    const bool good = read && collect_read(&g->collect, tank, g->c->verb, path);
    if (!read) fprintf(stderr, "mps collect: %s cannot be read as a case\n", path);
    mps_case_destroy(tank);
    return good;
}

/* Of one folder of runs, its own table; of others a table here, as no folder is to lose its own. */
static const char *table_path(const collection *g, char path[SERIES_PATH + 16])
{
    const char *folder = g->c->file[0];
    if (g->c->out) return g->c->out;
    if (g->c->files > 1 || has_summary(folder)) return "collected.csv";
    snprintf(path, SERIES_PATH + 16, "%s/sweep.csv", folder);
    return path;
}

static int write_all(collection *g)
{
    char path[SERIES_PATH + 16], file[SERIES_PATH + 16];
    const char *table = table_path(g, path);
    mps_table *first = NULL;
    int32_t of = 0;
    for (; of < g->runs && !first; of++)
        if (summary_is_done(g->run[of].folder)) first = series_table(g->c, g->run[of].folder);
    if (!first) {
        fprintf(stderr, "mps collect: %s: none of %d runs is done\n", g->c->file[0], (int)g->runs);
        return MPS_EXIT_USAGE;
    }
    int code = MPS_EXIT_USAGE;
    if (read_collect(g, g->run[of - 1].folder, file) && collect_fits(&g->collect, first)) {
        FILE *out = collect_open(table);
        if (out) write_names(g, out, first);
        for (int32_t i = 0; out && i < g->runs; i++) write_run(g, out, i, first);
        code = collect_close(g->c->verb, out, table);
        if (code == MPS_EXIT_OK) {
            printf("%s: %d runs\n", table, (int)g->runs);
            collect_print_missing(&g->collect);
        }
    }
    mps_table_destroy(first);
    return code;
}

int verb_collect(const choices *c)
{
    static collection g;
    int code = -1;
    g = (collection){.c = c};
    for (int32_t k = 0; k < c->files && code < 0; k++) code = add_folder(&g, c->file[k]);
    if (code < 0 && !find_varied(&g)) {
        fprintf(stderr, "mps collect: no memory\n");
        code = MPS_EXIT_FAILED;
    }
    if (code < 0) code = write_all(&g);
    for (int32_t i = 0; i < g.runs; i++) {
        free(g.run[i].folder);
        free(g.run[i].input);
    }
    free(g.run);
    return code;
}

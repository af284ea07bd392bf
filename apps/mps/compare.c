/* SPDX-License-Identifier: BSD-3-Clause */
/* mps compare: differences of the columns of runs from those of the first run, from a table, and
 * from the reference values of the case. */
#include "cli.h"
#include "constants.h"
#include "record.h"
#include <math.h>
#include <mps/case.h>
#include <mps/stats.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CELL = 10, NAME = 160 };

/* Two tables, at least one of a run, and the state of the comparison. */
typedef struct pair {
    const choices *c;
    mps_stats_config *config;
    const record *first, *second;
    bool reference; /* the first is a table of reference values; else both are runs */
    int shared, compared;
    /* summary of the columns that every run has, in a line after the others: their number, and the
     * one that differs most */
    bool fold;
    int folded;
    double worst;
    const char *worst_name;
} pair;

/* ---- columns ---- */

static const record *run_of(const pair *p)
{
    return p->reference ? p->second : p->first;
}

static const record *other_of(const pair *p)
{
    return p->reference ? p->first : p->second;
}

/* The name that the command line assigns to a column of the run in the other table; otherwise its
 * own. */
static const char *mapped(const choices *c, const char *name)
{
    const size_t length = strlen(name);
    for (int32_t k = 0; k < c->sets; k++)
        if (strncmp(c->set[k], name, length) == 0 && c->set[k][length] == '=')
            return c->set[k] + length + 1;
    return name;
}

/* Refuse a --map that names no column. @return exit code, -1: all are valid */
static int check_map(const pair *p)
{
    for (int32_t k = 0; k < p->c->sets; k++) {
        char name[NAME];
        const char *equals = strchr(p->c->set[k], '=');
        snprintf(name, sizeof name, "%.*s",
                 equals ? (int)(equals - p->c->set[k]) : (int)strlen(p->c->set[k]), p->c->set[k]);
        const record *const where[2] = {run_of(p), other_of(p)};
        const char *const wanted[2] = {name, equals ? equals + 1 : ""};
        for (int i = 0; i < 2; i++) {
            if (equals && record_find(where[i], wanted[i]) >= 0) continue;
            fprintf(stderr,
                    equals ? "mps compare: --map %s: %s has no column '%s'; the nearest is '%s'\n"
                           : "mps compare: --map %s: COLUMN=NAME is wanted, e.g. P1=pressure\n",
                    p->c->set[k], where[i]->place, wanted[i], record_nearest(where[i], wanted[i]));
            return MPS_EXIT_USAGE;
        }
    }
    return -1;
}

/* Conversion factor between units; 1 for columns without a unit. NAN: they are of different
 * kinds */
static double factor_of(const char *from, const char *to)
{
    return from[0] && to[0] ? mps_unit_factor(from, to) : 1;
}

/* The only column of a record with a unit of this kind; -1: none or several. */
static int32_t only_of(const record *r, const char *unit)
{
    int32_t found = -1;
    for (int32_t k = 0; k < mps_table_columns(r->table); k++) {
        if (!(factor_of(mps_table_unit(r->table, k), unit) > 0)) continue;
        if (found >= 0) return -1;
        found = k;
    }
    return found;
}

/* The column of the other table for column k of the run; -1: none. A reference of a case without a
 * name applies to all columns of its unit; a single column of a table to the only one of its
 * kind. */
static int32_t partner_of(const pair *p, int32_t k)
{
    const record *run = run_of(p), *other = other_of(p);
    const char *name = mps_table_name(run->table, k), *unit = mps_table_unit(run->table, k);
    const int32_t found = record_find(other, mapped(p->c, name));
    if (found >= 0 || p->c->sets > 0 || mps_table_columns(other->table) != 1) return found;
    const char *only = mps_table_name(other->table, 0), *its = mps_table_unit(other->table, 0);
    if (!its[0] || !unit[0]) return -1;
    if (!only[0]) return strcmp(its, unit) == 0 ? 0 : -1;
    return p->reference && record_find(run, only) < 0 && only_of(run, its) == k ? 0 : -1;
}

/* ---- figures ---- */

static void print_head(const pair *p)
{
    static const char *const head[] = {"rms diff.", "rms of 1st", "peak 1st", "peak 2nd", "at, 1st",
                                       "at, 2nd",   "later",      "corr.",    "phase"};
    printf("%s against %s\n  %-24s", p->second->place, p->first->place, "column");
    for (size_t k = 0; k < sizeof head / sizeof *head; k++) printf(" %*s", CELL, head[k]);
    printf("\n");
}

static void print_row(const char *name, const char *unit, const mps_comparison *c)
{
    const double value[] = {c->rms, c->rms_first, c->peak[0], c->peak[1]};
    printf("  %-24s", name);
    for (int k = 0; k < 4; k++) print_quantity(CELL, value[k], unit);
    for (int k = 0; k < 2; k++) print_time(CELL, c->t_peak[k]);
    print_quantity(CELL, c->shift, "s");
    if (isfinite(c->correlation))
        printf(" %*.3f", CELL, c->correlation);
    else
        printf(" %*s", CELL, "-");
    print_quantity(CELL, c->phase * 180 / acos(-1.0), "deg");
    printf("\n");
}

/* Print that the two have only a part of their time in common. */
static void print_overlap(const pair *p, const mps_comparison *c, double begin, double end)
{
    const double length = end - begin, common = c->t_last - c->t_first;
    if (p->reference && mps_table_is_points(p->first->table))
        printf("  %-24s at %lld of %lld points\n", "", (long long)c->points,
               (long long)mps_table_rows(p->first->table));
    else if (common < 0.98 * length)
        printf("  %-24s only %.4g to %.4g s are in both, %.3g %% of the time of the first\n", "",
               c->t_first, c->t_last, 100 * common / length);
}

/* Add a column that every run has to the summary. */
static void fold(pair *p, const char *name, const mps_comparison *c)
{
    const double share = c->rms > 0 ? c->rms / c->rms_first : 0;
    if (p->folded++ == 0 || share > p->worst) {
        p->worst = share;
        p->worst_name = name;
    }
}

static void print_folded(const pair *p)
{
    if (p->folded == 0) return;
    printf("  energies and the tank, %d columns: ", p->folded);
    if (p->worst > 0)
        printf("at most %.3g %% rms of the first (%s); --map %s=%s shows them\n", 100 * p->worst,
               p->worst_name, p->worst_name, p->worst_name);
    else
        printf("no difference\n");
}

/* A column as a series; the caller frees `memory`. @return false: memory is exhausted */
static bool series_of(const record *r, int32_t k, double factor, mps_series *s, double **memory)
{
    const int64_t n = mps_table_rows(r->table);
    const double *t = mps_table_values(r->table, -1), *p = mps_table_values(r->table, k);
    double seconds = factor_of(mps_table_unit(r->table, -1), "s");
    if (isnan(seconds)) seconds = 1;
    double *both = malloc((size_t)(2 * n + 1) * sizeof *both);
    *memory = both;
    if (!both) return false;
    for (int64_t i = 0; i < n; i++) {
        both[i] = seconds * t[i];
        both[n + i] = factor * p[i];
    }
    *s = (mps_series){.struct_size = sizeof *s, .n = n, .t = both, .p = both + n};
    return true;
}

/* @return false: memory is exhausted */
static bool compare_columns(pair *p, int32_t first, int32_t second)
{
    mps_comparison c;
    mps_series a = {0}, b = {0};
    double *memory[2] = {NULL, NULL};
    const char *unit = mps_table_unit(p->first->table, first),
               *theirs = mps_table_unit(p->second->table, second),
               *name = mps_table_name(run_of(p)->table, p->reference ? second : first);
    const double factor = factor_of(theirs, unit);
    if (p->shared++ == 0) print_head(p);
    if (isnan(factor)) {
        printf("  %-24s is in %s there, in %s here: these are of different kinds\n", name, theirs,
               unit);
        return true;
    }
    mps_comparison_init(&c, sizeof c);
    mps_status status = MPS_E_NOMEM;
    if (series_of(p->first, first, 1, &a, &memory[0]) &&
        series_of(p->second, second, factor, &b, &memory[1]))
        status = p->reference && mps_table_is_points(p->first->table)
                     ? mps_points_compare(p->config, &a, &b, &c)
                     : mps_series_compare(p->config, &a, &b, &c);
    if (status == MPS_OK) {
        p->compared++;
        if (p->fold && mps_table_is_common(run_of(p)->table, p->reference ? second : first))
            fold(p, name, &c);
        else {
            print_row(name, unit[0] ? unit : theirs, &c);
            print_overlap(p, &c, fmax(a.t[0], p->config->from), a.t[a.n - 1]);
        }
    } else if (status != MPS_E_NOMEM)
        printf("  %-24s %s\n", name, p->config->error);
    free(memory[0]);
    free(memory[1]);
    return status != MPS_E_NOMEM;
}

/* Print the comparable columns, for a user who has to map them. */
static void print_columns(const record *r)
{
    fprintf(stderr, "%s has", r->place);
    for (int32_t k = 0; k < mps_table_columns(r->table) && k < 40; k++)
        fprintf(stderr, "%s %s[%s]", k ? "," : "", mps_table_name(r->table, k),
                mps_table_unit(r->table, k));
    fprintf(stderr, "\n");
}

/* Compare all matching columns. @return exit code */
static int compare_two(pair *p)
{
    const record *run = run_of(p);
    const double end = fmin(record_end(p->first), record_end(p->second));
    const int code = check_map(p);
    if (code >= 0) return code;
    p->config->from = end > 0 ? 0.005 * end : -INFINITY; /* without the impulse of the start */
    for (int32_t k = 0; k < mps_table_columns(run->table); k++)
        p->fold = p->fold ||
                  (p->c->sets == 0 && partner_of(p, k) >= 0 && !mps_table_is_common(run->table, k));
    for (int32_t k = 0; k < mps_table_columns(run->table); k++) {
        const int32_t other = partner_of(p, k);
        if (other < 0) continue;
        if (compare_columns(p, p->reference ? other : k, p->reference ? k : other)) continue;
        fprintf(stderr, "mps compare: no memory\n");
        return MPS_EXIT_FAILED;
    }
    print_folded(p);
    if (p->compared > 0) return MPS_EXIT_OK;
    fprintf(stderr, "mps compare: %s and %s: no column can be compared\n", p->first->place,
            p->second->place);
    if (p->shared > 0) return MPS_EXIT_USAGE;
    print_columns(run);
    print_columns(other_of(p));
    fprintf(stderr, "--map COLUMN=NAME says which belong together\n");
    return MPS_EXIT_USAGE;
}

/* Compare a run with the reference values of its case. @return exit code */
static int compare_own(const choices *c, mps_stats_config *config, const record *run)
{
    int code = MPS_EXIT_OK;
    int32_t index = 0;
    for (;; index++) {
        record reference;
        const mps_status status = record_read_reference(config, run->place, index, &reference);
        if (status == MPS_E_NAME) break;
        if (status != MPS_OK) {
            fprintf(stderr, "mps compare: %s\n", config->error);
            return status == MPS_E_NOMEM ? MPS_EXIT_FAILED : MPS_EXIT_USAGE;
        }
        pair p = {.c = c, .config = config, .first = &reference, .second = run, .reference = true};
        const int one = compare_two(&p);
        if (one > code) code = one;
        record_free(&reference);
    }
    if (index > 0) return code;
    fprintf(stderr,
            "mps compare: %s: its case has no 'reference'; name another run or a table to compare "
            "with\n",
            run->place);
    return MPS_EXIT_USAGE;
}

/* Period of the first run that has one [s]. */
static double find_period(const choices *c, const mps_stats_config *config, const record *all)
{
    double period = NAN;
    for (int32_t k = 0; k < c->files && isnan(period); k++) {
        mps_stats_config own = *config;
        if (all[k].is_folder && mps_stats_config_read(all[k].place, &own) == MPS_OK)
            period = own.period;
    }
    return period;
}

/* Compare each run with the first one and, if the last argument is a file, with this reference. */
static int compare_all(const choices *c, mps_stats_config *config, const record *all)
{
    config->period = find_period(c, config, all);
    const int32_t last = c->files - 1, runs = all[last].is_folder ? c->files : last;
    if (c->files == 1) return compare_own(c, config, &all[0]);
    for (int32_t k = 0; k < c->files; k++) {
        const bool reference = k == last && !all[k].is_folder;
        for (int32_t j = reference ? 0 : 1; j < runs && (k == 0 || reference); j++) {
            pair p = {.c = c,
                      .config = config,
                      .first = &all[k],
                      .second = &all[j],
                      .reference = reference};
            const int code = compare_two(&p);
            if (code != MPS_EXIT_OK) return code;
        }
    }
    return MPS_EXIT_OK;
}

int verb_compare(const choices *c)
{
    static record all[CLI_FILES];
    char error[640] = "";
    mps_stats_config config;
    int code = MPS_EXIT_OK;
    mps_stats_config_init(&config, sizeof config);
    config.error = error;
    config.error_size = sizeof error;
    for (int32_t k = 0; k < c->files && code == MPS_EXIT_OK; k++) {
        const mps_status status = record_read(&config, c->file[k], &all[k]);
        if (status == MPS_OK && !all[k].is_folder && (k + 1 < c->files || k == 0)) {
            snprintf(error, sizeof error, "%.400s: is no folder; a reference is the last argument",
                     c->file[k]);
            code = MPS_EXIT_USAGE;
        } else if (status != MPS_OK)
            code = status == MPS_E_NOMEM ? MPS_EXIT_FAILED : MPS_EXIT_USAGE;
        if (code != MPS_EXIT_OK) fprintf(stderr, "mps compare: %s\n", error);
    }
    if (code == MPS_EXIT_OK) code = compare_all(c, &config, all);
    for (int32_t k = 0; k < c->files; k++) record_free(&all[k]);
    return code;
}

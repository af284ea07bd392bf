/* SPDX-License-Identifier: BSD-3-Clause */
/* mps compare: how the columns of runs differ from those of the first run, and from a reference. */
#include "cli.h"
#include "constants.h"
#include "record.h"
#include <math.h>
#include <mps/stats.h>
#include <stdio.h>
#include <string.h>

static mps_status compare_columns(const mps_stats_config *config, const record *a, int32_t ka,
                                  const record *b, int32_t kb, mps_comparison *c)
{
    const mps_series first = {.struct_size = sizeof first,
                              .n = mps_table_rows(a->table),
                              .t = mps_table_values(a->table, -1),
                              .p = mps_table_values(a->table, ka)};
    const mps_series second = {.struct_size = sizeof second,
                               .n = mps_table_rows(b->table),
                               .t = mps_table_values(b->table, -1),
                               .p = mps_table_values(b->table, kb)};
    mps_comparison_init(c, sizeof *c);
    return mps_series_compare(config, &first, &second, c);
}

enum { CELL = 11 };

static void print_head(const record *a, const record *b)
{
    printf("%s against %s\n", b->place, a->place);
    printf("  %-24s %11s %11s %11s %11s %11s %11s %11s %11s\n", "column", "rms diff.", "rms of 1st",
           "peak 1st", "peak 2nd", "at, 1st", "at, 2nd", "later", "phase");
}

static void print_row(const char *name, const char *unit, const mps_comparison *c)
{
    const double value[] = {c->rms, c->rms_first, c->peak[0], c->peak[1]};
    printf("  %-24s", name);
    for (int k = 0; k < 4; k++) print_quantity(CELL, value[k], unit);
    for (int k = 0; k < 2; k++) print_time(CELL, c->t_peak[k]);
    print_quantity(CELL, c->shift, "s");
    print_quantity(CELL, c->phase * 180 / acos(-1.0), "deg");
    printf("\n");
}

/* All columns that both have. @return number of columns that were compared, -1: no memory */
static int compare_two(mps_stats_config *config, const record *a, const record *b)
{
    int shared = 0, compared = 0;
    const double end = fmin(record_end(a), record_end(b));
    config->from = end > 0 ? 0.005 * end : -INFINITY; /* without the impulse of the start */
    for (int32_t ka = 0; ka < mps_table_columns(a->table); ka++) {
        mps_comparison c;
        const char *name = mps_table_name(a->table, ka), *unit = mps_table_unit(a->table, ka);
        const int32_t kb = record_find(b, name);
        if (kb < 0) continue;
        const char *other = mps_table_unit(b->table, kb);
        if (shared++ == 0) print_head(a, b);
        if (unit[0] && other[0] && strcmp(unit, other) != 0) {
            printf("  %-24s is in %s there, in %s here\n", name, other, unit);
            continue;
        }
        const mps_status status = compare_columns(config, a, ka, b, kb, &c);
        if (status == MPS_E_NOMEM) return -1;
        if (status == MPS_OK) {
            compared++;
            print_row(name, unit[0] ? unit : other, &c);
        } else
            printf("  %-24s %s\n", name, config->error);
    }
    return compared;
}

/* That of the first run that knows one [s]. */
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

/* Each run against the first one and, where the last argument is a file, against this reference. */
static int compare_all(const choices *c, mps_stats_config *config, const record *all)
{
    config->period = find_period(c, config, all);
    const int32_t last = c->files - 1, runs = all[last].is_folder ? c->files : last;
    for (int32_t k = 0; k < c->files; k++) {
        const bool reference = k == last && !all[k].is_folder;
        for (int32_t j = reference ? 0 : 1; j < runs && (k == 0 || reference); j++) {
            const int compared = compare_two(config, &all[k], &all[j]);
            if (compared > 0) continue;
            fprintf(stderr, "mps compare: %s and %s: %s\n", all[k].place, all[j].place,
                    compared < 0 ? "no memory" : "no column can be compared");
            return compared < 0 ? MPS_EXIT_FAILED : MPS_EXIT_USAGE;
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
        if (status == MPS_OK && !all[k].is_folder && k + 1 < c->files) {
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

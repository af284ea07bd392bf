/* SPDX-License-Identifier: BSD-3-Clause */
/* mps stats: impacts in the pressures of a run. */
#include "cli.h"
#include "constants.h"
#include "escape.h"
#include "record.h"
#include "summary.h"
#include <errno.h>
#include <math.h>
#include <mps/stats.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { HIGHEST = 10, PATH_CAPACITY = 4096 };

/* The signals of a run and their impacts. */
typedef struct signals {
    int32_t count;
    int32_t *column;
    const char **name;
    mps_impacts **impacts;
} signals;

/* ---- columns ---- */

/* Select the columns of the command line. @return exit code */
static int take_named(const choices *c, const record *r, signals *s)
{
    for (int32_t k = 1; k < c->files; k++) {
        const int32_t column = record_find(r, c->file[k]);
        if (column < 0) {
            fprintf(stderr, "mps stats: %s has no column '%s'; the nearest is '%s'\n", r->place,
                    c->file[k], record_nearest(r, c->file[k]));
            return MPS_EXIT_USAGE;
        }
        if (strcmp(mps_table_unit(r->table, column), "Pa") != 0) {
            fprintf(stderr, "mps stats: column '%s' is no pressure: its unit is '%s', not 'Pa'\n",
                    c->file[k], mps_table_unit(r->table, column));
            return MPS_EXIT_USAGE;
        }
        s->column[s->count++] = column;
    }
    return MPS_EXIT_OK;
}

/* Select all pressures, or those that the case names. @return exit code */
static int take_pressures(const mps_stats_config *config, const record *r, signals *s)
{
    for (int32_t k = 0; k < mps_table_columns(r->table); k++)
        if (strcmp(mps_table_unit(r->table, k), "Pa") == 0 &&
            mps_stats_wants(config, mps_table_name(r->table, k)))
            s->column[s->count++] = k;
    if (s->count > 0) return MPS_EXIT_OK;
    fprintf(stderr, "mps stats: %s has no column of a pressure [Pa]\n", r->place);
    return MPS_EXIT_USAGE;
}

static bool make_signals(signals *s, size_t capacity)
{
    s->column = calloc(capacity, sizeof *s->column);
    s->name = calloc(capacity, sizeof *s->name);
    /* NOLINTNEXTLINE(bugprone-sizeof-expression): an array of pointers */
    s->impacts = calloc(capacity, sizeof *s->impacts);
    return s->column && s->name && s->impacts;
}

static void free_signals(signals *s)
{
    for (int32_t k = 0; s->impacts && k < s->count; k++) mps_impacts_destroy(s->impacts[k]);
    free(s->column);
    free((void *)s->name);
    free((void *)s->impacts);
}

static mps_status find_all(const mps_stats_config *config, const record *r, signals *s)
{
    mps_status status = MPS_OK;
    for (int32_t k = 0; k < s->count && status == MPS_OK; k++) {
        s->name[k] = mps_table_name(r->table, s->column[k]);
        status = mps_impacts_find(config, mps_table_rows(r->table), mps_table_values(r->table, -1),
                                  mps_table_values(r->table, s->column[k]), &s->impacts[k]);
    }
    return status;
}

/* ---- texts ---- */

static void print_highest(const mps_impacts *impacts)
{
    mps_impact e;
    mps_impact_init(&e, sizeof e);
    if (mps_impacts_highest(impacts, 0, &e) != MPS_OK) return;
    printf("  rank       peak       time       rise      decay   duration     impulse\n");
    for (int64_t rank = 0; rank < HIGHEST && mps_impacts_highest(impacts, rank, &e) == MPS_OK;
         rank++) {
        printf("  %4lld %10s", (long long)rank + 1, quantity(e.peak, "Pa"));
        print_time(10, e.t);
        printf(" %10s %10s %10s %11s%s\n", quantity(e.rise, "s"), quantity(e.decay, "s"),
               quantity(e.duration, "s"), quantity(e.impulse, "Pa s"),
               e.unresolved ? "  not resolved" : "");
    }
}

/* Whether the run is a model of a larger tank, or of another liquid. */
static bool is_scaled(const mps_impacts_info *info)
{
    return info->pressure_scale != 1 || info->time_scale != 1;
}

/* "3.59 kPa", or "3.59 kPa in the model (144 kPa at full scale)"; valid until the second next
 * call. */
static const char *both(double value, const mps_impacts_info *info)
{
    static char text[2][96];
    static int next;
    if (!is_scaled(info)) return quantity(value, "Pa");
    next = !next;
    snprintf(text[next], sizeof text[next], "%s in the model (%s at full scale)",
             quantity(value, "Pa"), quantity(info->pressure_scale * value, "Pa"));
    return text[next];
}

static void print_fit(const mps_impacts *impacts, int32_t kind, const char *name,
                      const mps_impacts_info *info)
{
    mps_fit fit;
    mps_impact high;
    mps_fit_init(&fit, sizeof fit);
    mps_impact_init(&high, sizeof high);
    if (mps_impacts_fit_get(impacts, kind, &fit) != MPS_OK || !isfinite(fit.value)) return;
    printf("    %-19s %s", name, both(fit.value, info));
    if (isfinite(fit.value_band[0]))
        printf(", band %s to %s", both(fit.value_band[0], info), both(fit.value_band[1], info));
    if (fit.state == MPS_FIT_MOMENTS) printf(", by moments: do not extrapolate");
    if (mps_impacts_highest(impacts, 0, &high) == MPS_OK && fit.value < high.peak)
        printf("; less than the highest peak of the record: of no use");
    printf("\n");
}

/* End of a record that has as many events as a fit needs, at this rate, with two digits. */
static double wanted_end(const mps_impacts_info *info, const mps_stats_config *c)
{
    const double end = info->t_first + c->least_events / info->rate,
                 digit = pow(10, floor(log10(end)) - 1);
    return digit * ceil(end / digit);
}

static void print_too_few(const mps_impacts_info *info, const mps_stats_config *c, const record *r)
{
    char path[PATH_CAPACITY];
    printf("  no distribution is fitted: that needs %d events", (int)c->least_events);
    if (info->events > 1) {
        printf(", at this rate a record of about %s", quantity(c->least_events / info->rate, "s"));
        if (r->is_folder && record_path(r->place, "case.yaml", path, sizeof path) &&
            access(path, R_OK) == 0) {
            char place[PATH_CAPACITY];
            mps__shell_word(r->place, place, sizeof place);
            printf(": mps resume %s --set run.until='%.9g s'", place, wanted_end(info, c));
        }
    }
    printf("\n");
}

static void print_value(const mps_impacts *impacts, const mps_impacts_info *info,
                        const mps_stats_config *c, const record *r)
{
    if (info->unresolved > 0)
        printf("  %lld of %lld rise or decay faster than the computation resolves: their peaks "
               "depend on dp\n",
               (long long)info->unresolved, (long long)info->events);
    if (info->events < c->least_events) {
        print_too_few(info, c, r);
        return;
    }
    printf("  exceeded once in %.4g h", c->exposure / 3600);
    if (is_scaled(info)) printf(" at full scale, %.4g h in the model", info->exposure / 3600);
    printf(" (%s events), for screening, not for design:\n", quantity(info->exposure_events, ""));
    print_fit(impacts, MPS_FIT_WEIBULL, "Weibull", info);
    print_fit(impacts, MPS_FIT_PARETO, "generalised Pareto", info);
    if (info->long_exposure)
        printf("    this time is more than %.4g lengths of the record: extrapolated\n",
               c->exposure_ratio);
    if (info->dependent)
        printf("    successive peaks depend on each other: the bands are too narrow\n");
}

static void print_signal(const char *name, const mps_impacts *impacts, const mps_stats_config *c,
                         const record *r)
{
    mps_impact high;
    mps_impacts_info info;
    mps_impact_init(&high, sizeof high);
    mps_impacts_info_init(&info, sizeof info);
    mps_impacts_info_get(impacts, &info);
    if (isnan(c->threshold) && info.threshold == 0 &&
        info.events == 0) { /* mean and deviation are 0 */
        printf("%s: no pressure from %s to %s: no liquid came here\n", name,
               quantity(info.t_first, "s"), quantity(info.t_last, "s"));
        return;
    }
    printf("%s: %lld event%s, %s a minute", name, (long long)info.events,
           info.events == 1 ? "" : "s", quantity(60 * info.rate, ""));
    if (mps_impacts_highest(impacts, 0, &high) == MPS_OK)
        printf(", highest %s at %.5g s", both(high.peak, &info), high.t);
    if (is_scaled(&info))
        printf("\n  a model: at full scale pressures are %.4g times and times %.4g times as large; "
               "all but 'at full scale' is of the model",
               info.pressure_scale, info.time_scale);
    printf("\n  above %s%s, until %s below it, from %s to %s; %lld left out at the ends\n",
           quantity(info.threshold, "Pa"),
           isnan(c->threshold) ? " (by deviations: set impacts.threshold)" : "",
           quantity(info.window, "s"), quantity(info.t_first, "s"), quantity(info.t_last, "s"),
           (long long)info.cut);
    if (info.events == 0 && info.cut > 0)
        printf("  the pressure is above that where the record begins or ends: a larger "
               "impacts.threshold may find peaks\n");
    print_highest(impacts);
    print_value(impacts, &info, c, r);
}

/* ---- files ---- */

static size_t write_text(const signals *s, bool json, char *buffer, size_t size)
{
    const mps_impacts *const *impacts = (const mps_impacts *const *)s->impacts;
    return json ? mps_stats_json_write(s->count, s->name, impacts, HIGHEST, buffer, size)
                : mps_stats_csv_write(s->count, s->name, impacts, buffer, size);
}

/* Write statistics.json or statistics.csv. @return exit code */
static int write_file(const char *folder, const char *name, const signals *s, bool json)
{
    char path[PATH_CAPACITY];
    const size_t size = write_text(s, json, NULL, 0) + 1;
    char *text = malloc(size);
    if (!text || write_text(s, json, text, size) + 1 != size || size == 1) {
        fprintf(stderr, "mps stats: no memory for %s\n", name);
        free(text);
        return MPS_EXIT_FAILED;
    }
    FILE *file = NULL;
    if (record_path(folder, name, path, sizeof path)) {
        remove(path); /* a link is removed, its target stays unchanged */
        file = fopen(path, "wbx");
    } else {
        errno = ENAMETOOLONG;
    }
    bool done = file && fwrite(text, 1, size - 1, file) == size - 1;
    if (file && fclose(file) != 0) done = false;
    if (!done)
        fprintf(stderr, "mps stats: cannot write '%s' in '%s': %s\n", name, folder,
                strerror(errno));
    else
        printf("%s\n", path);
    free(text);
    return done ? MPS_EXIT_OK : MPS_EXIT_FAILED;
}

/* ---- all ---- */

static int run_stats(const choices *c, constants *k, const record *r, signals *s)
{
    const int32_t columns = mps_table_columns(r->table);
    if (!make_signals(s, (size_t)(columns > c->files ? columns : c->files))) {
        fprintf(stderr, "mps stats: no memory\n");
        return MPS_EXIT_FAILED;
    }
    mps_status status = constants_read(k, c, r->place);
    int code = MPS_EXIT_OK;
    if (status == MPS_OK) {
        code = c->files > 1 ? take_named(c, r, s) : take_pressures(&k->used, r, s);
        if (code != MPS_EXIT_OK) return code;
        status = find_all(&k->used, r, s);
    }
    if (status != MPS_OK) {
        fprintf(stderr, "mps stats: %s: %s\n", r->place, k->error);
        return status == MPS_E_NOMEM ? MPS_EXIT_FAILED : MPS_EXIT_USAGE;
    }
    if (r->is_folder && summary_unfinished(r->place, record_end(r), k->error, sizeof k->error))
        printf("%s\n", k->error);
    constants_print(k, c, r->place);
    for (int32_t i = 0; i < s->count; i++) print_signal(s->name[i], s->impacts[i], &k->used, r);
    code = write_file(r->place, "statistics.json", s, true);
    return code == MPS_EXIT_OK ? write_file(r->place, "statistics.csv", s, false) : code;
}

int verb_stats(const choices *c)
{
    record r;
    signals s = {0};
    constants k;
    constants_begin(&k);
    const mps_status status = record_read(&k.used, c->file[0], &r);
    int code = status == MPS_E_NOMEM ? MPS_EXIT_FAILED : MPS_EXIT_USAGE;
    if (status != MPS_OK)
        fprintf(stderr, "mps stats: %s\n", k.error);
    else if (!r.is_folder)
        fprintf(stderr, "mps stats: %s: is no folder of a run\n", r.place);
    else
        code = run_stats(c, &k, &r, &s);
    free_signals(&s);
    record_free(&r);
    return code;
}

/* SPDX-License-Identifier: BSD-3-Clause */
#include "collect.h"
#include <errno.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- statistics ---- */

/* A column of a run, and the constants of its statistics. */
typedef struct signal {
    int64_t n;
    const double *t, *value;
    const mps_stats_config *config;
} signal;

static double find_max(const signal *s)
{
    double most = NAN;
    for (int64_t i = 0; i < s->n; i++) most = fmax(most, s->value[i]);
    return most;
}

static double find_min(const signal *s)
{
    double least = NAN;
    for (int64_t i = 0; i < s->n; i++) least = fmin(least, s->value[i]);
    return least;
}

/* Rows are equidistant in time. */
static double find_mean(const signal *s)
{
    double sum = 0;
    int64_t count = 0;
    for (int64_t i = 0; i < s->n; i++)
        if (!isnan(s->value[i])) {
            sum += s->value[i];
            count++;
        }
    return count ? sum / (double)count : NAN;
}

static double find_last(const signal *s)
{
    return s->n > 0 ? s->value[s->n - 1] : NAN;
}

/* At full scale, as 'mps stats' prints it; nan: too few events.
 * @param kind  of the fit, MPS_FIT_.. */
static double find_exceeded(const signal *s, int32_t kind)
{
    mps_impacts *impacts = NULL;
    mps_impacts_info info;
    mps_fit fit;
    double value = NAN;
    mps_fit_init(&fit, sizeof fit);
    mps_impacts_info_init(&info, sizeof info);
    if (mps_impacts_find(s->config, s->n, s->t, s->value, &impacts) == MPS_OK &&
        mps_impacts_info_get(impacts, &info) == MPS_OK &&
        mps_impacts_fit_get(impacts, kind, &fit) == MPS_OK)
        value = info.pressure_scale * fit.value;
    mps_impacts_destroy(impacts);
    return value;
}

static double find_p3h(const signal *s)
{
    return find_exceeded(s, MPS_FIT_WEIBULL);
}

static double find_p3h_pareto(const signal *s)
{
    return find_exceeded(s, MPS_FIT_PARETO);
}

/* Amplitude at the frequency of the motion; nan: it has none, or the run is too short. */
static double find_harmonic(const signal *s)
{
    mps_harmonics h;
    mps_harmonics_init(&h, sizeof h);
    h.omega = s->config->omega;
    return mps_harmonics_find(s->config, s->n, s->t, s->value, &h) == MPS_OK ? h.amplitude[0] : NAN;
}

static const char TOO_FEW[] = "too few impacts for a distribution; 'mps stats DIR' prints the "
                              "number and the time that are needed";

static const struct {
    const char *name;
    double (*find)(const signal *s);
    bool pressure;     /* for pressures only */
    const char *needs; /* what a run without a value lacks, or NULL */
} STATISTICS[] = {
    {"max", find_max, false, NULL},
    {"min", find_min, false, NULL},
    {"mean", find_mean, false, NULL},
    {"last", find_last, false, NULL},
    {"p3h", find_p3h, true, TOO_FEW},
    {"p3h_pareto", find_p3h_pareto, true, TOO_FEW},
    {"harmonic", find_harmonic, false, "a periodic motion, and one period of it, are needed"}};

enum { STATISTIC_COUNT = sizeof STATISTICS / sizeof *STATISTICS };

/* ---- entries ---- */

/* Column "F", or "F_x" of the sensor F. */
static bool belongs(const collect_entry *e, const char *column)
{
    const size_t length = strlen(e->sensor);
    if (length == 0 || strcmp(column, e->sensor) == 0) return true;
    return strncmp(column, e->sensor, length) == 0 && strchr("_.", column[length]) != NULL;
}

static bool refuse_entry(const collect *s, const char *word, const char *why)
{
    fprintf(stderr, "mps %s: %s: collect: '%s' %s", s->verb, s->from, word, why);
    for (int i = 0; i < STATISTIC_COUNT; i++)
        fprintf(stderr, "%s%s", i ? ", " : " ", STATISTICS[i].name);
    fputc('\n', stderr);
    return false;
}

/* The texts stay in s->text. */
bool collect_read(collect *s, const mps_case *tank, const char *name, const char *from)
{
    s->verb = name;
    s->from = from;
    s->entries = 0;
    if (!series_key(tank, "collect", s->text, sizeof s->text)) {
        s->entry[s->entries++] = (collect_entry){.sensor = ""};
        return true;
    }
    char *rest = NULL;
    for (char *word = strtok_r(s->text, "[], \"", &rest); word;
         word = strtok_r(NULL, "[], \"", &rest)) {
        int32_t k = 0;
        char *dot = strrchr(word, '.');
        while (dot && k < STATISTIC_COUNT && strcmp(dot + 1, STATISTICS[k].name) != 0) k++;
        if (!dot || dot == word || k == STATISTIC_COUNT)
            return refuse_entry(s, word,
                                "must be a sensor and one of these statistics, as in P1.max:");
        if (s->entries == COLLECT_MOST) return refuse_entry(s, word, "is one too many of");
        *dot = '\0';
        s->entry[s->entries++] = (collect_entry){.sensor = word, .statistic = k};
    }
    return true;
}

bool collect_fits(const collect *s, const mps_table *rows)
{
    for (int32_t k = 0; k < s->entries; k++) {
        const collect_entry *e = &s->entry[k];
        bool found = false;
        for (int32_t j = 0; j < mps_table_columns(rows); j++) {
            const char *name = mps_table_name(rows, j), *unit = mps_table_unit(rows, j);
            if (!belongs(e, name)) continue;
            found = true;
            if (!STATISTICS[e->statistic].pressure || strcmp(unit, "Pa") == 0) continue;
            fprintf(stderr,
                    "mps %s: %s: collect: '%s.%s': column '%s' is no pressure: its unit is '%s', "
                    "not 'Pa'\n",
                    s->verb, s->from, e->sensor, STATISTICS[e->statistic].name, name, unit);
            return false;
        }
        if (found) continue;
        fprintf(stderr, "mps %s: %s: collect: no column of probes.csv is '%s'\n", s->verb, s->from,
                e->sensor);
        return false;
    }
    return true;
}

/* ---- the table ---- */

void collect_names(const collect *s, FILE *out, const mps_table *rows)
{
    for (int32_t k = 0; k < s->entries; k++)
        for (int32_t j = 0; j < mps_table_columns(rows); j++) {
            if (!belongs(&s->entry[k], mps_table_name(rows, j))) continue;
            fprintf(out, ",%s.%s", mps_table_name(rows, j), STATISTICS[s->entry[k].statistic].name);
            if (mps_table_unit(rows, j)[0]) fprintf(out, "[%s]", mps_table_unit(rows, j));
        }
}

void collect_values(collect *s, FILE *out, const mps_table *first, const char *folder,
                    const mps_table *rows)
{
    char error[640] = "";
    mps_stats_config config;
    mps_stats_config_init(&config, sizeof config);
    config.error = error;
    config.error_size = sizeof error;
    if (rows && mps_stats_config_read(folder, &config) != MPS_OK)
        fprintf(stderr, "mps %s: %s\n", s->verb, error);
    for (int32_t k = 0; k < s->entries; k++)
        for (int32_t j = 0; j < mps_table_columns(first); j++) {
            const char *name = mps_table_name(first, j), *here = mps_table_name(rows, j);
            if (!belongs(&s->entry[k], name)) continue;
            const bool known = here && strcmp(here, name) == 0;
            const signal one = {known ? mps_table_rows(rows) : 0, mps_table_values(rows, -1),
                                mps_table_values(rows, j), &config};
            const double value = known ? STATISTICS[s->entry[k].statistic].find(&one) : NAN;
            fprintf(out, ",%.9g", value);
            s->entry[k].runs += known;
            s->entry[k].missing += known && isnan(value) && STATISTICS[s->entry[k].statistic].needs;
        }
}

void collect_print_missing(const collect *s)
{
    for (int32_t k = 0; k < s->entries; k++) {
        const collect_entry *e = &s->entry[k];
        if (e->missing == 0) continue;
        fprintf(stderr, "mps %s: %s.%s: %d of %d values are nan: %s\n", s->verb, e->sensor,
                STATISTICS[e->statistic].name, (int)e->missing, (int)e->runs,
                STATISTICS[e->statistic].needs);
    }
}

void collect_text(FILE *out, const char *text)
{
    const bool quote = strpbrk(text, ",\"") != NULL;
    fputs(quote ? ",\"" : ",", out);
    for (; *text; text++) {
        if (*text == '"') fputc('"', out);
        fputc(*text, out);
    }
    if (quote) fputc('"', out);
}

/* ---- the file ---- */

static void temporary_of(const char *path, char out[SERIES_PATH + 64])
{
    snprintf(out, SERIES_PATH + 64, "%s.%ld.tmp", path, (long)getpid());
}

FILE *collect_open(const char *path)
{
    char temporary[SERIES_PATH + 64];
    temporary_of(path, temporary);
    return fopen(temporary, "w");
}

int collect_close(const char *name, FILE *out, const char *path)
{
    char temporary[SERIES_PATH + 64];
    struct stat there;
    temporary_of(path, temporary);
    bool good = out && !ferror(out);
    if (out && fclose(out) != 0) good = false;
    good = good && rename(temporary, path) == 0;
    if (!good) fprintf(stderr, "mps %s: %s: %s\n", name, path, strerror(errno));
    if (!good && stat(temporary, &there) == 0) unlink(temporary);
    return good ? MPS_EXIT_OK : MPS_EXIT_FAILED;
}

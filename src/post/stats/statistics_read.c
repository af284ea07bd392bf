/* SPDX-License-Identifier: BSD-3-Clause */
/* Constants of the statistics of a run, from its summary.json: those of the case, otherwise derived
 * from the run. */
#include "page_read.h"
#include "statistics.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT_CAPACITY = 640 };
/* Fractions of the record: its start, excluded because of the initial impulse, and the window if no
 * period is known. */
static const double START = 0.005, WINDOW = 0.02;

/* The number of an input such as "1.418 s", in SI; NAN: not found. A text such as "1,25 s" is no
 * number. */
static mps_status input_number(const mps_stats_config *config, const page_run *r, const char *key,
                               double *value)
{
    const char *text = mps__page_input(r, key);
    char *end = NULL;
    *value = text ? strtod(text, &end) : NAN;
    if (!text || (end != text && (!*end || *end == ' ') && !strpbrk(end, ",.0123456789")))
        return MPS_OK;
    return mps__stats_fail(config, MPS_E_IO,
                           "summary.json: input '%s': '%.80s' is no number with a unit", key, text);
}

/* Natural period of the liquid in a box [s]; NAN: not known. */
static double natural_period(const page_run *r)
{
    const double k = acos(-1.0) / mps__page_number(r, "tank_size_x");
    const double g = mps__page_number(r, "gravity"), h = mps__page_number(r, "liquid_depth");
    const double period = 2 * acos(-1.0) / sqrt((isfinite(g) ? g : 9.81) * k * tanh(k * h));
    return isfinite(period) ? period : NAN; /* infinite without gravity */
}

/* Constants of the case, and those derived from it. */
static mps_status take_numbers(const page_run *r, mps_stats_config *c)
{
    double value;
    mps_stats_constant k = {.struct_size = sizeof k};
    for (int32_t i = 0; mps_stats_constant_get(c, i, &k) == MPS_OK; i++) {
        if (!k.key[0]) continue;
        MPS__STATS_TRY(input_number(c, r, k.key, &value));
        if (isfinite(value)) mps__stats_put(c, k.key, value);
    }
    MPS__STATS_TRY(input_number(c, r, "motion omega", &value));
    if (isfinite(value)) c->omega = value;
    return MPS_OK;
}

mps_status mps__stats_take(const struct page_run *r, double end, mps_stats_config *config)
{
    const char *sensors = mps__page_input(r, "impacts.sensors");
    const double crossing = mps__page_number(r, "sensor_average_most");
    MPS__STATS_TRY(mps__stats_put_sensors(config, sensors ? sensors : ""));
    config->period = natural_period(r);
    if (end > 0) config->from = START * end;
    if (isfinite(crossing)) config->crossing_time = crossing;
    MPS__STATS_TRY(take_numbers(r, config));
    if (end > 0 && isnan(config->window) && isnan(config->period)) config->window = WINDOW * end;
    return MPS_OK;
}

/* Last time of probes.csv, for a run in progress; NAN: it has no rows. */
static mps_status read_end(const mps_stats_config *config, const char *folder, double *end)
{
    mps_table *rows = NULL;
    const mps_status status = mps_table_read_run(config, folder, "probes.csv", &rows);
    const int64_t count = mps_table_rows(rows);
    *end = count > 0 ? mps_table_values(rows, -1)[count - 1] : NAN;
    mps_table_destroy(rows);
    return status;
}

static mps_status read_folder(const char *folder, mps_stats_config *config)
{
    char text[TEXT_CAPACITY] = "";
    page_errors e = {text, sizeof text};
    page_run r = {.folder = folder, .errors = &e};
    mps_stats_config taken = *config;
    mps_status status = mps__page_summary_read(&r);
    double end = mps__page_number(&r, "t_end");
    const bool unfinished = strcmp(mps__page_string(&r, "status"), "unfinished") == 0;
    /* the summary of an unfinished run is older */
    if (status == MPS_E_NAME || (status == MPS_OK && unfinished))
        status = read_end(config, folder, &end);
    else if (status == MPS_E_NOMEM)
        mps__stats_no_memory(config);
    else if (status != MPS_OK)
        mps__stats_fail(config, status, "%s", text);
    if (status == MPS_OK) status = mps__stats_take(&r, end, &taken);
    if (status == MPS_OK) *config = taken;
    mps__page_run_free(&r);
    return status;
}

static mps_status read_reference(const mps_stats_config *config, page_run *r, int32_t index,
                                 mps_table **table)
{
    const mps_status status = mps__page_summary_read(r);
    if (status == MPS_E_NOMEM) return mps__stats_no_memory(config);
    if (status == MPS_E_NAME) return status;
    if (status != MPS_OK) return mps__stats_fail(config, status, "%s", r->errors->text);
    const json_value *one = mps__json_at(mps__json_get(r->summary, "references"), (size_t)index);
    if (!one) return MPS_E_NAME;
    if (mps__stats_reference(one, table)) return MPS_OK;
    mps_table_destroy(*table);
    *table = NULL;
    return mps__stats_no_memory(config);
}

mps_status mps_table_read_reference(const mps_stats_config *config, const char *folder,
                                    int32_t index, mps_table **table)
{
    char text[TEXT_CAPACITY] = "";
    page_errors e = {text, sizeof text};
    page_run r = {.folder = folder, .errors = &e};
    if (table) *table = NULL;
    MPS__STATS_TRY(mps__stats_check(config));
    MPS__STATS_CHECK(config, table, "table is NULL");
    MPS__STATS_CHECK(config, folder && folder[0], "folder is required");
    MPS__STATS_CHECK(config, index >= 0, "index is %d: must be >= 0", (int)index);
    const mps_status status = read_reference(config, &r, index, table);
    mps__page_run_free(&r);
    return status;
}

mps_status mps_stats_config_read(const char *folder, mps_stats_config *config)
{
    MPS__STATS_TRY(mps__stats_check(config));
    MPS__STATS_CHECK(config, folder && folder[0], "folder is required");
    return read_folder(folder, config);
}

int32_t mps_stats_wants(const mps_stats_config *config, const char *name)
{
    if (!name || !mps__stats_known(config, sizeof *config)) return 0;
    if (!memchr(config->sensors, '\0', sizeof config->sensors)) return 0; /* not terminated */
    const size_t length = strlen(name);
    for (const char *at = config->sensors; *at; at += strspn(at, "; ")) {
        const size_t size = strcspn(at, ";");
        if (size == length && memcmp(at, name, size) == 0) return 1;
        at += size;
    }
    return !config->sensors[0];
}

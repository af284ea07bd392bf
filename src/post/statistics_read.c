/* SPDX-License-Identifier: BSD-3-Clause */
/* Constants of the statistics of a run, from its summary.json: those of the case, else what the run itself tells. */
#include "page_read.h"
#include "statistics.h"
#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT_ROOM = 640 };
/* Shares of the record: its begin, where the impulse of the start is no impact, and the window where no period is known. */
static const double START = 0.005, WINDOW = 0.02;

/* The number of an input such as "1.418 s", in SI; NAN: there is none. */
static double input_number(const page_run *r, const char *key)
{
    const char *text = mps__page_input(r, key);
    char *end = NULL;
    const double value = text ? strtod(text, &end) : NAN;
    return end != text && isfinite(value) ? value : NAN;
}

/* Natural period of the liquid in a box [s]; NAN: not known. */
static double natural_period(const page_run *r)
{
    const double k = acos(-1.0) / mps__page_number(r, "tank_size_x");
    const double g = mps__page_number(r, "gravity"), h = mps__page_number(r, "liquid_depth");
    const double period = 2 * acos(-1.0) / sqrt((isfinite(g) ? g : 9.81) * k * tanh(k * h));
    return isfinite(period) ? period : NAN; /* infinite without gravity */
}

/* Those of the case, and what follows from it. */
static void take_numbers(const page_run *r, mps_stats_config *c)
{
    mps_stats_constant k = {.struct_size = sizeof k};
    for (int32_t i = 0; mps_stats_constant_get(c, i, &k) == MPS_OK; i++) {
        const double value = k.key[0] ? input_number(r, k.key) : NAN;
        if (isfinite(value)) mps__stats_put(c, k.key, value);
    }
    const double omega = input_number(r, "motion omega");
    if (isfinite(omega)) c->omega = omega;
}

mps_status mps__stats_take(const struct page_run *r, double end, mps_stats_config *config)
{
    const char *sensors = mps__page_input(r, "impacts.sensors");
    const double crossing = mps__page_number(r, "sensor_average_most");
    MPS__STATS_TRY(mps__stats_put_sensors(config, sensors ? sensors : ""));
    config->period = natural_period(r);
    if (end > 0) config->from = START * end;
    if (isfinite(crossing)) config->crossing_time = crossing;
    take_numbers(r, config);
    if (end > 0 && isnan(config->window) && isnan(config->period)) config->window = WINDOW * end;
    return MPS_OK;
}

/* Last time of probes.csv, of a run that still goes on; NAN: it has no rows. */
static mps_status read_end(const mps_stats_config *config, const char *folder, double *end)
{
    mps_table *rows = NULL;
    char *path = mps__page_path(folder, "probes.csv");
    if (!path) return mps__stats_no_memory(config);
    const mps_status status = mps_table_read(config, path, 0, NULL, &rows);
    const int64_t count = mps_table_rows(rows);
    *end = count > 0 ? mps_table_values(rows, -1)[count - 1] : NAN;
    mps_table_destroy(rows);
    free(path);
    return status;
}

static mps_status read_folder(const char *folder, mps_stats_config *config)
{
    char text[TEXT_ROOM] = "";
    page_errors e = {text, sizeof text};
    page_run r = {.folder = folder, .errors = &e};
    mps_stats_config taken = *config;
    mps_status status = mps__page_summary_read(&r);
    double end = mps__page_number(&r, "t_end");
    if (status == MPS_E_NAME)
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

mps_status mps_stats_config_read(const char *folder, mps_stats_config *config)
{
    MPS__STATS_TRY(mps__stats_check(config));
    MPS__STATS_CHECK(config, folder && folder[0], "folder is required");
    const locale_t c = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    if (!c) return mps__stats_no_memory(config);
    const locale_t before = uselocale(c);
    const mps_status status = read_folder(folder, config);
    uselocale(before);
    freelocale(c);
    return status;
}

int32_t mps_stats_wants(const mps_stats_config *config, const char *name)
{
    if (!name || !mps__stats_known(config, sizeof *config)) return 0;
    const size_t length = strlen(name);
    for (const char *at = config->sensors; *at; at += strspn(at, "; ")) {
        const size_t size = strcspn(at, ";");
        if (size == length && memcmp(at, name, size) == 0) return 1;
        at += size;
    }
    return !config->sensors[0];
}

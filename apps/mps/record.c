/* SPDX-License-Identifier: BSD-3-Clause */
#include "record.h"
#include "words.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

bool record_path(const char *folder, const char *name, char *out, size_t size)
{
    const int length = snprintf(out, size, "%s/%s", folder, name);
    return length >= 0 && (size_t)length < size;
}

static mps_status fail(const mps_stats_config *config, mps_status status, const char *place,
                       const char *why)
{
    if (config->error) snprintf(config->error, config->error_size, "%.400s: %s", place, why);
    return status;
}

/* ---- the table ---- */

mps_status record_read(const mps_stats_config *config, const char *place, record *r)
{
    struct stat status;
    *r = (record){.place = place};
    if (stat(place, &status) != 0)
        return fail(config, MPS_E_IO, place, "there is no such folder or file");
    r->is_folder = S_ISDIR(status.st_mode);
    return r->is_folder ? mps_table_read_run(config, place, "probes.csv", &r->table)
                        : mps_table_read(config, place, 0, NULL, &r->table);
}

mps_status record_read_reference(const mps_stats_config *config, const char *folder, int32_t index,
                                 record *r)
{
    *r = (record){.place = folder};
    const mps_status status = mps_table_read_reference(config, folder, index, &r->table);
    if (status == MPS_OK) r->place = mps_table_label(r->table);
    return status;
}

void record_free(record *r)
{
    mps_table_destroy(r->table);
    *r = (record){0};
}

int32_t record_find(const record *r, const char *name)
{
    for (int32_t k = 0; k < mps_table_columns(r->table); k++)
        if (strcmp(mps_table_name(r->table, k), name) == 0) return k;
    return -1;
}

const char *record_nearest(const record *r, const char *name)
{
    const char *best = "";
    size_t least = SIZE_MAX;
    for (int32_t k = 0; k < mps_table_columns(r->table); k++) {
        const char *known = mps_table_name(r->table, k);
        const size_t letters = mps__word_distance(name, known);
        if (letters >= least) continue;
        least = letters;
        best = known;
    }
    return best;
}

double record_end(const record *r)
{
    const int64_t rows = mps_table_rows(r->table);
    return rows > 0 ? mps_table_values(r->table, -1)[rows - 1] : NAN;
}

double record_last(const char *folder)
{
    mps_stats_config config;
    record r;
    mps_stats_config_init(&config, sizeof config);
    const double t = record_read(&config, folder, &r) == MPS_OK ? record_end(&r) : NAN;
    record_free(&r);
    return t;
}

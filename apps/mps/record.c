/* SPDX-License-Identifier: BSD-3-Clause */
#include "record.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { PATH_ROOM = 4096, WORD_ROOM = 64, SUMMARY_MOST = 64 << 20 };

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

/* ---- summary.json ---- */

/* The text of summary.json. A run that still goes on has none. */
static mps_status read_summary(const mps_stats_config *config, record *r)
{
    char path[PATH_ROOM];
    struct stat status;
    if (!record_path(r->place, "summary.json", path, sizeof path))
        return fail(config, MPS_E_ARG, r->place, "the name is too long");
    FILE *file = fopen(path, "rb");
    if (!file) return MPS_OK;
    if (fstat(fileno(file), &status) != 0 || status.st_size < 0 || status.st_size > SUMMARY_MOST) {
        fclose(file);
        return fail(config, MPS_E_IO, path, "cannot be read");
    }
    const size_t size = (size_t)status.st_size;
    r->summary = malloc(size + 1);
    const size_t got = r->summary ? fread(r->summary, 1, size, file) : 0;
    if (r->summary) r->summary[got] = '\0';
    fclose(file);
    if (!r->summary) return fail(config, MPS_E_NOMEM, path, "no memory");
    return got == size ? MPS_OK : fail(config, MPS_E_IO, path, "cannot be read to its end");
}

/* What stands behind a text. Within a JSON string a quote has a backslash, so a text with quotes is only found outside. */
static const char *behind(const record *r, const char *text)
{
    const char *at = r->summary ? strstr(r->summary, text) : NULL;
    return at ? at + strlen(text) : NULL;
}

static double number_at(const char *text)
{
    char *end = NULL;
    const double value = text ? strtod(text, &end) : NAN;
    return end != text && isfinite(value) ? value : NAN;
}

double record_number(const record *r, const char *key)
{
    char text[WORD_ROOM + 8];
    snprintf(text, sizeof text, "\n  \"%.*s\": ", WORD_ROOM - 1, key);
    return number_at(behind(r, text));
}

const char *record_input(const record *r, const char *key)
{
    char text[WORD_ROOM + 32];
    snprintf(text, sizeof text, "{\"key\": \"%.*s\", \"value\": \"", WORD_ROOM - 1, key);
    return behind(r, text);
}

double record_input_number(const record *r, const char *key)
{
    return number_at(record_input(r, key));
}

/* ---- the table ---- */

mps_status record_read(const mps_stats_config *config, const char *place, record *r)
{
    char path[PATH_ROOM];
    struct stat status;
    *r = (record){.place = place};
    if (stat(place, &status) != 0)
        return fail(config, MPS_E_IO, place, "there is no such folder or file");
    r->is_folder = S_ISDIR(status.st_mode);
    if (r->is_folder && !record_path(place, "probes.csv", path, sizeof path))
        return fail(config, MPS_E_ARG, place, "the name is too long");
    mps_status code = mps_table_read(config, r->is_folder ? path : place, 0, NULL, &r->table);
    if (code == MPS_OK && r->is_folder) code = read_summary(config, r);
    return code;
}

void record_free(record *r)
{
    mps_table_destroy(r->table);
    free(r->summary);
    *r = (record){0};
}

int32_t record_find(const record *r, const char *name)
{
    for (int32_t k = 0; k < mps_table_columns(r->table); k++)
        if (strcmp(mps_table_name(r->table, k), name) == 0) return k;
    return -1;
}

/* Letters to add, to drop or to replace, of the first WORD_ROOM of each. */
static size_t distance(const char *a, const char *b)
{
    size_t row[WORD_ROOM + 1];
    const size_t la = strnlen(a, WORD_ROOM), lb = strnlen(b, WORD_ROOM);
    for (size_t j = 0; j <= lb; j++) row[j] = j;
    for (size_t i = 1; i <= la; i++) {
        size_t corner = row[0];
        row[0] = i;
        for (size_t j = 1; j <= lb; j++) {
            size_t best = corner + (a[i - 1] != b[j - 1]);
            if (row[j] + 1 < best) best = row[j] + 1;
            if (row[j - 1] + 1 < best) best = row[j - 1] + 1;
            corner = row[j];
            row[j] = best;
        }
    }
    return row[lb];
}

const char *record_nearest(const record *r, const char *name)
{
    const char *best = "";
    size_t least = SIZE_MAX;
    for (int32_t k = 0; k < mps_table_columns(r->table); k++) {
        const char *known = mps_table_name(r->table, k);
        const size_t letters = distance(name, known);
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

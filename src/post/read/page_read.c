/* SPDX-License-Identifier: BSD-3-Clause */
/* Reads the folder of a run. */
#include "page_read.h"
#include "grow.h"
#include "run_file.h"
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum { SERIES_MOST = 64 << 20, CASE_MOST = 4 << 20, FRAMES_MOST = 1000000 };

mps_status mps__page_fail(page_errors *e, mps_status status, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    if (e && e->text && e->size > 0 && !e->text[0]) vsnprintf(e->text, e->size, format, values);
    va_end(values);
    return status;
}

static mps_status no_memory(page_errors *e)
{
    return mps__page_fail(e, MPS_E_NOMEM, "no memory for the page");
}

char *mps__page_path(const char *folder, const char *name)
{
    const size_t size = strlen(folder) + strlen(name) + 2;
    char *path = malloc(size);
    if (path) snprintf(path, size, "%s/%s", folder, name);
    return path;
}

mps_status mps__page_open(const page_run *r, const char *path, FILE **out)
{
    const char *why;
    *out = mps__run_open(r->folder, path, &why);
    if (*out) return MPS_OK;
    if (!why && errno == ENOENT) return MPS_E_NAME;
    if (!why && errno == ENOMEM) return no_memory(r->errors);
    return mps__page_fail(r->errors, MPS_E_IO, "cannot open '%s': %s", path,
                          why ? why : strerror(errno));
}

mps_status mps__page_file(const page_run *r, const char *path, int64_t most, char **out,
                          size_t *size)
{
    FILE *file;
    size_t length = 0;
    *out = NULL;
    const mps_status status = mps__page_open(r, path, &file);
    if (status != MPS_OK) return status;
    *out = mps__file_read(file, (size_t)most, &length);
    const int number = errno;
    fclose(file);
    if (size) *size = length;
    if (*out) return MPS_OK;
    if (number == ENOMEM) return no_memory(r->errors);
    if (number == EFBIG)
        return mps__page_fail(r->errors, MPS_E_IO, "'%s' has %lld bytes, at most %lld are read",
                              path, (long long)length, (long long)most);
    return mps__page_fail(r->errors, MPS_E_IO, "cannot read '%s': %s", path, strerror(number));
}

/* ---- summary.json ---------------------------------------------------------------------------- */

double mps__page_number(const page_run *r, const char *key)
{
    const json_value *value = mps__json_get(r->summary, key);
    return mps__json_number(value);
}

const char *mps__page_string(const page_run *r, const char *key)
{
    return mps__json_member(r->summary, key);
}

const char *mps__page_input(const page_run *r, const char *key)
{
    const json_value *list = mps__json_get(r->summary, "inputs");
    for (const json_value *one = list ? list->first : NULL; one; one = one->next) {
        const char *name = mps__json_text(mps__json_get(one, "key"));
        if (name && strcmp(name, key) == 0) return mps__json_text(mps__json_get(one, "value"));
    }
    return NULL;
}

/* Three numbers. @return false if there are none */
static bool vector_in(const json_value *object, const char *key, double out[3])
{
    const json_value *list = mps__json_get(object, key);
    for (size_t d = 0; d < 3; d++) {
        const json_value *value = mps__json_at(list, d);
        out[d] = mps__json_number(value);
        if (!isfinite(out[d])) return false;
    }
    return true;
}

static mps_status read_columns(page_run *r)
{
    const json_value *list = mps__json_get(r->summary, "columns");
    const size_t count = mps__json_count(list);
    r->column = calloc(count + 1, sizeof *r->column);
    if (!r->column) return no_memory(r->errors);
    for (size_t k = 0; k < count; k++) {
        const json_value *one = mps__json_at(list, k);
        page_column *c = &r->column[r->columns++];
        *c = (page_column){.name = mps__json_member(one, "name"),
                           .unit = mps__json_member(one, "unit"),
                           .type = mps__json_member(one, "type"),
                           .about = mps__json_member(one, "about"),
                           .part = mps__json_member(one, "part")};
        c->has_place = vector_in(one, "at", c->at);
        c->has_normal = vector_in(one, "normal", c->normal);
        c->diameter = mps__json_number(mps__json_get(one, "diameter"));
        c->place = mps__page_table_find(&r->probes, c->name);
    }
    return MPS_OK;
}

mps_status mps__page_summary_read(page_run *r)
{
    char *path = mps__page_path(r->folder, "summary.json"), *text = NULL;
    size_t size = 0;
    if (!path) return no_memory(r->errors);
    mps_status status = mps__page_file(r, path, SERIES_MOST, &text, &size);
    json_error error;
    if (status == MPS_OK && (!text || strlen(text) != size))
        status = mps__page_fail(r->errors, MPS_E_IO, "'%s' is no text: it has a byte 0", path);
    if (status == MPS_OK && text) {
        r->summary = mps__json_read(text, &error);
        if (!r->summary && !error.why)
            status = no_memory(r->errors);
        else if (!r->summary || r->summary->type != JSON_OBJECT)
            status = mps__page_fail(r->errors, MPS_E_IO, "'%s', line %d: %s", path,
                                    r->summary ? 1 : error.line,
                                    r->summary ? "an object is wanted" : error.why);
    }
    free(text);
    free(path);
    return status;
}

/* ---- the series of frames -------------------------------------------------------------------- */

static void unescape(char *text)
{
    static const struct {
        const char *from;
        char to;
    } entity[] = {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}};
    char *out = text;
    while (*text) {
        size_t k = 0;
        while (k < 5 && strncmp(text, entity[k].from, strlen(entity[k].from)) != 0) k++;
        *out++ = k < 5 ? entity[k].to : *text;
        text += k < 5 ? strlen(entity[k].from) : 1;
    }
    *out = '\0';
}

/* Find the value of an attribute of a tag, and terminate it; NULL: missing. */
static char *attribute(char *tag, const char *name, char **end)
{
    char *value = strstr(tag, name);
    if (!value) return NULL;
    value += strlen(name);
    *end = strchr(value, '"');
    if (*end) **end = '\0';
    return *end ? value : NULL;
}

/* @param first  frame of this series */
static mps_status add_frame(page_run *r, char *tag, const char *path, int64_t first)
{
    char *end = NULL, *number_end = NULL, *t = attribute(tag, "timestep=\"", &end);
    char *file = t ? attribute(end + 1, "file=\"", &end) : NULL;
    if (!t || !file || r->frames == FRAMES_MOST)
        return mps__page_fail(r->errors, MPS_E_IO, "'%s': frame %lld has no time or no file", path,
                              (long long)(r->frames - first));
    unescape(file);
    page_stamp *more = mps__grown(r->frame, r->frames, sizeof *more);
    if (!more) return no_memory(r->errors);
    r->frame = more;
    page_stamp *s = &more[r->frames];
    *s = (page_stamp){.t = strtod(t, &number_end),
                      .path = mps__page_path(file[0] == '/' ? "" : r->folder, file)};
    if (!s->path) return no_memory(r->errors);
    r->frames++;
    if (number_end == t || !isfinite(s->t) || (r->frames > first + 1 && s->t <= s[-1].t))
        return mps__page_fail(r->errors, MPS_E_IO, "'%s': times of frames do not increase at '%s'",
                              path, t);
    return MPS_OK;
}

static mps_status read_series(page_run *r, const char *name)
{
    char *path = mps__page_path(r->folder, name), *text = NULL;
    const int64_t first = r->frames;
    if (!path) return no_memory(r->errors);
    mps_status status = mps__page_file(r, path, SERIES_MOST, &text, NULL);
    char *tag = text ? strstr(text, "<DataSet ") : NULL;
    while (status == MPS_OK && tag) {
        char *end = strchr(tag, '>');
        if (!end) break; /* an incomplete tag */
        *end = '\0';
        status = add_frame(r, tag, path, first);
        tag = strstr(end + 1, "<DataSet ");
    }
    free(text);
    free(path);
    return status == MPS_E_NAME ? MPS_OK : status;
}

/* At equal times the regular frame precedes the one about a peak, which is then dropped. */
static int compare_stamps(const void *a, const void *b)
{
    const page_stamp *x = a, *y = b;
    return x->t != y->t ? (x->t > y->t) - (x->t < y->t) : x->peak - y->peak;
}

mps_status mps__page_peaks_read(page_run *r)
{
    const int64_t others = r->frames;
    int64_t kept = 0;
    if (others == 0) return MPS_OK;
    const mps_status status = read_series(r, "peaks.pvd");
    for (int64_t k = others; k < r->frames; k++) r->frame[k].peak = true;
    qsort(r->frame, (size_t)r->frames, sizeof *r->frame, compare_stamps);
    for (int64_t k = 0; k < r->frames; k++)
        if (k > 0 && r->frame[k].t == r->frame[kept - 1].t)
            free(r->frame[k].path);
        else
            r->frame[kept++] = r->frame[k];
    r->frames = kept;
    return status;
}

/* ---- the whole folder ------------------------------------------------------------------------ */

static mps_status read_table(page_run *r, const char *name, bool wanted, mps__csv *out)
{
    char *path = mps__page_path(r->folder, name);
    if (!path) return no_memory(r->errors);
    mps_status status = mps__page_table_read(r, path, out);
    if (status == MPS_E_NAME)
        status = wanted ? mps__page_fail(r->errors, MPS_E_IO, "there is no '%s'", path) : MPS_OK;
    free(path);
    return status;
}

static mps_status read_case(page_run *r)
{
    char *path = mps__page_path(r->folder, "case.yaml");
    if (!path) return no_memory(r->errors);
    mps_status status = mps__page_file(r, path, CASE_MOST, &r->text, NULL);
    free(path);
    return status == MPS_E_NAME ? MPS_OK : status;
}

/* The summary of an unfinished run is older than its rows. */
static void take_last_time(page_run *r)
{
    if (strcmp(mps__page_string(r, "status"), "unfinished") != 0 || r->probes.rows == 0) return;
    for (json_value *one = r->summary->first; one; one = one->next)
        if (one->type == JSON_NUMBER && strcmp(one->key, "t_end") == 0)
            one->number = fmax(one->number, mps__page_table_last(&r->probes, 0));
}

mps_status mps__page_run_read(page_run *r, const char *folder, page_errors *e)
{
    *r = (page_run){.folder = folder, .errors = e};
    mps_status status = mps__page_summary_read(r);
    if (status == MPS_E_NAME)
        status = mps__page_fail(
            e, MPS_E_IO, "there is no '%s/summary.json': a page needs the folder of a run", folder);
    if (status == MPS_OK) status = read_table(r, "probes.csv", true, &r->probes);
    if (status == MPS_OK) take_last_time(r);
    if (status == MPS_OK) status = read_table(r, "steps.csv", false, &r->steps);
    if (status == MPS_OK) status = read_table(r, "momentum.csv", false, &r->momentum);
    if (status == MPS_OK) status = read_columns(r);
    if (status == MPS_OK) status = read_series(r, "frames.pvd");
    if (status == MPS_OK) status = read_case(r);
    return status;
}

void mps__page_run_free(page_run *r)
{
    mps__json_free(r->summary);
    mps__csv_free(&r->probes);
    mps__csv_free(&r->steps);
    mps__csv_free(&r->momentum);
    for (int64_t k = 0; k < r->frames; k++) free(r->frame[k].path);
    free(r->frame);
    free(r->column);
    free(r->text);
    *r = (page_run){0};
}

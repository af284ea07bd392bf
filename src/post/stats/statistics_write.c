/* SPDX-License-Identifier: BSD-3-Clause */
/* Statistics as text: events as CSV, everything as JSON. */
#include "escape.h"
#include "statistics.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* A text that may exceed its buffer. */
typedef struct text {
    char *buffer;
    size_t size, length;
} text;

static void put(text *out, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void put(text *out, const char *format, ...)
{
    const bool has_space = out->length < out->size;
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(has_space ? out->buffer + out->length : NULL,
                                 has_space ? out->size - out->length : 0, format, arguments);
    va_end(arguments);
    if (length > 0) out->length += (size_t)length;
}

static bool all_given(int32_t count, const char *const *names, const mps_impacts *const *impacts)
{
    if (count < 0 || (count > 0 && (!names || !impacts))) return false;
    for (int32_t k = 0; k < count; k++)
        if (!names[k] || !impacts[k]) return false;
    return true;
}

/* ---- CSV ---- */

/* A name with a comma or a quote is quoted. */
static void csv_name(text *out, const char *name)
{
    if (!strpbrk(name, ",\"\r\n")) {
        put(out, "%s", name);
        return;
    }
    put(out, "\"");
    for (const char *c = name; *c; c++) put(out, "%s%c", *c == '"' ? "\"" : "", *c);
    put(out, "\"");
}

/* nan is written without the sign that the C library may add. */
static void csv_number(text *out, double value)
{
    if (isnan(value))
        put(out, ",nan");
    else
        put(out, ",%.9g", value);
}

static void csv_event(text *out, const char *name, const mps_impacts *s, int64_t index,
                      int64_t rank)
{
    const mps_impact *e = &s->event[index];
    csv_name(out, name);
    csv_number(out, e->t);
    csv_number(out, e->peak);
    csv_number(out, e->rise);
    csv_number(out, e->decay);
    csv_number(out, e->skewness);
    csv_number(out, e->duration);
    csv_number(out, e->impulse);
    put(out, ",%lld,%d\n", (long long)rank, (int)e->unresolved);
}

/* Position of an event in s->rank, from 1: that list is sorted by peak, then by index. */
static int64_t rank_of(const mps_impacts *s, int64_t index)
{
    int64_t low = 0, high = s->info.events - 1;
    const double peak = s->event[index].peak;
    while (low < high) {
        const int64_t middle = low + (high - low) / 2, other = s->rank[middle];
        const double its = s->event[other].peak;
        if (its > peak || (its == peak && other < index))
            low = middle + 1;
        else
            high = middle;
    }
    return low + 1;
}

static void csv_all(text *out, int32_t count, const char *const *names,
                    const mps_impacts *const *impacts)
{
    put(out, "sensor,t[s],peak[Pa],rise[s],decay[s],skewness,duration[s],impulse[Pa s],rank,"
             "unresolved\n");
    for (int32_t k = 0; k < count; k++)
        for (int64_t i = 0; i < impacts[k]->info.events; i++)
            csv_event(out, names[k], impacts[k], i, rank_of(impacts[k], i));
}

/* ---- JSON ---- */

typedef struct entry {
    const char *name;
    double value;
} entry;

static void json_string(text *out, const char *s)
{
    char character[8];
    put(out, "\"");
    while (*s) {
        s += mps__json_character(s, character);
        put(out, "%s", character);
    }
    put(out, "\"");
}

/* JSON has neither NaN nor infinity. */
static void json_number(text *out, double value)
{
    if (isfinite(value))
        put(out, "%.9g", value);
    else
        put(out, "null");
}

static void json_entries(text *out, size_t count, const entry *entries)
{
    put(out, "{");
    for (size_t k = 0; k < count; k++) {
        put(out, "%s\"%s\": ", k ? ", " : "", entries[k].name);
        json_number(out, entries[k].value);
    }
    put(out, "}");
}

#define JSON_ENTRIES(out, entries) json_entries(out, sizeof(entries) / sizeof(entries)[0], entries)

static void json_constants(text *out, const mps_stats_config *c)
{
    const entry entries[] = {{"from", c->from},
                             {"until", c->until},
                             {"rate", c->rate},
                             {"high_pass", c->high_pass},
                             {"threshold", c->threshold},
                             {"deviations", c->deviations},
                             {"window", c->window},
                             {"window_share", c->window_share},
                             {"period", c->period},
                             {"share", c->share},
                             {"crossing_time", c->crossing_time},
                             {"least_events", c->least_events},
                             {"resamples", c->resamples},
                             {"confidence", c->confidence},
                             {"exposure", c->exposure},
                             {"exposure_ratio", c->exposure_ratio},
                             {"dependence", c->dependence},
                             {"length_scale", c->length_scale},
                             {"density_ratio", c->density_ratio}};
    put(out, ",\n   \"seed\": %llu,\n   \"constants\": ", (unsigned long long)c->seed);
    JSON_ENTRIES(out, entries);
}

static void json_info(text *out, const mps_impacts_info *i)
{
    const entry entries[] = {{"samples", (double)i->samples},
                             {"missing", (double)i->missing},
                             {"events", (double)i->events},
                             {"cut", (double)i->cut},
                             {"unresolved", (double)i->unresolved},
                             {"threshold", i->threshold},
                             {"window", i->window},
                             {"t_first", i->t_first},
                             {"t_last", i->t_last},
                             {"rate", i->rate},
                             {"correlation", i->correlation},
                             {"correlation_limit", i->correlation_limit},
                             {"dependent", i->dependent},
                             {"exposure", i->exposure},
                             {"exposure_events", i->exposure_events},
                             {"long_exposure", i->long_exposure},
                             {"pressure_scale", i->pressure_scale},
                             {"time_scale", i->time_scale}};
    put(out, ",\n   \"info\": ");
    JSON_ENTRIES(out, entries);
}

static void json_events(text *out, const mps_impacts *s, int64_t highest)
{
    put(out, ",\n   \"highest\": [");
    for (int64_t k = 0; k < highest && k < s->info.events; k++) {
        const mps_impact *e = &s->event[s->rank[k]];
        const entry entries[] = {{"t", e->t},
                                 {"peak", e->peak},
                                 {"rise", e->rise},
                                 {"decay", e->decay},
                                 {"skewness", e->skewness},
                                 {"duration", e->duration},
                                 {"impulse", e->impulse},
                                 {"unresolved", e->unresolved}};
        put(out, "%s\n    ", k ? "," : "");
        JSON_ENTRIES(out, entries);
    }
    put(out, "]");
}

static void json_fit(text *out, const char *name, const mps_fit *f, double scale)
{
    static const char *const state[] = {"few", "same", "likelihood", "moments"};
    const entry entries[] = {{"count", (double)f->count},
                             {"location", f->location},
                             {"scale", f->scale},
                             {"scale_low", f->scale_band[0]},
                             {"scale_high", f->scale_band[1]},
                             {"shape", f->shape},
                             {"shape_low", f->shape_band[0]},
                             {"shape_high", f->shape_band[1]},
                             {"log_likelihood", f->log_likelihood},
                             {"number", f->number},
                             {"value", f->value},
                             {"value_low", f->value_band[0]},
                             {"value_high", f->value_band[1]},
                             {"full_scale", scale * f->value},
                             {"full_scale_low", scale * f->value_band[0]},
                             {"full_scale_high", scale * f->value_band[1]},
                             {"resamples", f->resamples}};
    put(out, ",\n   \"%s\": {\"state\": \"%s\", \"numbers\": ", name, state[f->state]);
    JSON_ENTRIES(out, entries);
    put(out, "}");
}

/* One member of all points. */
static void json_points(text *out, const char *name, const mps_impacts *s, int member)
{
    put(out, "%s\"%s\": [", member ? ", " : "", name);
    for (int64_t k = 0; k < s->info.events; k++) {
        const mps_exceedance *p = &s->point[k];
        const double values[4] = {p->peak, p->share, p->band[0], p->band[1]};
        if (k) put(out, ", ");
        json_number(out, values[member]);
    }
    put(out, "]");
}

static void json_signal(text *out, const char *name, const mps_impacts *s, int64_t highest)
{
    put(out, "\n  {\"name\": ");
    json_string(out, name);
    json_constants(out, &s->config);
    json_info(out, &s->info);
    json_events(out, s, highest);
    json_fit(out, "weibull", &s->fit[MPS_FIT_WEIBULL], s->info.pressure_scale);
    json_fit(out, "pareto", &s->fit[MPS_FIT_PARETO], s->info.pressure_scale);
    put(out, ",\n   \"exceedance\": {");
    json_points(out, "peak", s, 0);
    json_points(out, "share", s, 1);
    json_points(out, "low", s, 2);
    json_points(out, "high", s, 3);
    put(out, "}}");
}

static void json_all(text *out, int32_t count, const char *const *names,
                     const mps_impacts *const *impacts, int64_t highest)
{
    put(out, "{\"use\": \"for screening\", \"signals\": [");
    for (int32_t k = 0; k < count; k++) {
        if (k) put(out, ",");
        json_signal(out, names[k], impacts[k], highest);
    }
    put(out, "]}\n");
}

/* ---- public ---- */

size_t mps_stats_csv_write(int32_t count, const char *const *names,
                           const mps_impacts *const *impacts, char *buffer, size_t size)
{
    text out = {buffer, size, 0};
    if (!all_given(count, names, impacts) || (!buffer && size > 0)) return 0;
    csv_all(&out, count, names, impacts);
    return out.length;
}

size_t mps_stats_json_write(int32_t count, const char *const *names,
                            const mps_impacts *const *impacts, int64_t highest, char *buffer,
                            size_t size)
{
    text out = {buffer, size, 0};
    if (!all_given(count, names, impacts) || (!buffer && size > 0) || highest < 0) return 0;
    json_all(&out, count, names, impacts, highest);
    return out.length;
}

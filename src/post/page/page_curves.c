/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves of a page: packed columns of the tables, grouped in plots. */
#include "page_parts.h"
#include "page_text.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS_LEAST = 500, ROWS_MOST = 20000 };

/* Assigns columns to plots. */
typedef struct plot_rule {
    const char *column, *place, *plot, *label; /* label: of the curve */
    const char *unit;                          /* NULL: that of the column; "%" for fractions */
} plot_rule;

static const plot_rule probes_rule[] = {
    {"x_tank", "main", "Displacement of the tank along x", "tank", NULL},
    {"surge", "main", "Motion of the tank: shifts", "surge", NULL},
    {"sway", "main", "Motion of the tank: shifts", "sway", NULL},
    {"heave", "main", "Motion of the tank: shifts", "heave", NULL},
    {"roll", "main", "Motion of the tank: turns", "roll", NULL},
    {"pitch", "main", "Motion of the tank: turns", "pitch", NULL},
    {"yaw", "main", "Motion of the tank: turns", "yaw", NULL},
    {"ke", "budget", "Energy, change since the start", "kinetic", NULL},
    {"pe", "budget", "Energy, change since the start", "potential", NULL},
    {"wall_work_momentum", "budget", "Energy, change since the start", "work of the walls", NULL},
    {"viscous", "budget", "Energy, change since the start", "taken: viscosity, numerical too",
     NULL},
    {"plugins", "budget", "Energy, change since the start", "taken: plug-ins", NULL},
    {"collision", "budget", "Energy, change since the start", "taken: collisions", NULL},
    {"shift", "budget", "Energy, change since the start", "taken: shift", NULL},
    {"numerical", "budget", "Energy, change since the start", "lost: numerical", NULL},
    {"added", "budget", "Energy, change since the start", "added", NULL},
    {"friction", "budget", "Energy, change since the start", "taken: layers at walls", NULL},
    {"layers", "budget", "Energy, change since the start", "kinetic: at side walls", NULL},
    {"volume_error", "budget", "Change of the liquid's volume", "volume", "%"},
    {"wall_work_probes", NULL, NULL, NULL, NULL},
    {NULL, NULL, NULL, NULL, NULL}};
static const plot_rule steps_rule[] = {
    {"dt", "steps", "Length of a step", "dt", NULL},
    {"ppe_iterations", "steps", "Iterations of the pressure solver in a step", "iterations", NULL},
    {"max_speed", "steps", "Largest speed", "speed", NULL},
    {"crossing_time", "steps", "Time in which liquid crosses a spacing", "dp/u", NULL},
    {NULL, NULL, NULL, NULL, NULL}};
#define MOMENTUM(axis)                                                                 \
    {"momentum_" axis, "steps", "Momentum along " axis, "momentum", NULL},             \
        {"force_" axis, "steps", "Momentum along " axis, "from force models", NULL},   \
        {"collision_" axis, "steps", "Momentum along " axis, "from collisions", NULL}, \
        {"shift_" axis, "steps", "Momentum along " axis, "from shifts", NULL},         \
    {                                                                                  \
        "numerical_" axis, "steps", "Momentum along " axis, "numerical", NULL          \
    }
static const plot_rule momentum_rule[] = {
    MOMENTUM("x"), MOMENTUM("y"), MOMENTUM("z"), {NULL, NULL, NULL, NULL, NULL}};

/* A table, thinned to `points` rows: of each bucket of rows the least and the largest value, in
 * their order. */
typedef struct curves {
    FILE *out;
    const page_run *run;
    const mps__csv *table;
    const plot_rule *rules;
    int64_t bucket, points;
    double *value; /* [points] */
    bool any;      /* a curve has been written */
} curves;

static mps_status no_memory(const page_run *r)
{
    return mps__page_fail(r->errors, MPS_E_NOMEM, "no memory for the curves of the page");
}

static const double *at(const curves *c, int64_t i, int32_t k)
{
    return c->table->value[k] + i;
}

/* Rows of the least and the largest value of a bucket. */
static void extremes(const curves *c, int32_t k, int64_t from, int64_t to, int64_t out[2])
{
    int64_t low = from, high = from;
    for (int64_t i = from; i < to; i++) {
        const double v = *at(c, i, k);
        if (!isfinite(v)) continue;
        if (!(v >= *at(c, low, k))) low = i;
        if (!(v <= *at(c, high, k))) high = i;
    }
    out[0] = low < high ? low : high;
    out[1] = low < high ? high : low;
}

static void thin(curves *c, int32_t k)
{
    const int64_t rows = c->table->rows;
    for (int64_t i = 0; c->bucket == 1 && i < rows; i++) c->value[i] = *at(c, i, k);
    for (int64_t b = 0; c->bucket > 1 && 2 * b < c->points; b++) {
        const int64_t from = b * c->bucket, to = from + c->bucket < rows ? from + c->bucket : rows;
        int64_t row[2];
        extremes(c, k, from, to, row);
        c->value[2 * b] = *at(c, row[0], k);
        c->value[2 * b + 1] = *at(c, row[1], k);
    }
}

/* Times of the points: the begin and the middle of each bucket. */
static void thin_times(curves *c)
{
    const int64_t rows = c->table->rows;
    for (int64_t i = 0; c->bucket == 1 && i < rows; i++) c->value[i] = *at(c, i, 0);
    for (int64_t b = 0; c->bucket > 1 && 2 * b < c->points; b++) {
        const int64_t from = b * c->bucket, middle = from + c->bucket / 2;
        c->value[2 * b] = *at(c, from, 0);
        c->value[2 * b + 1] = *at(c, middle < rows ? middle : rows - 1, 0);
    }
}

static mps_status write_packed(const curves *c, const codec_bytes *bytes)
{
    fputc('"', c->out);
    mps__codec_base64(c->out, bytes);
    fputs("\"}", c->out);
    return MPS_OK;
}

static bool even_times(const curves *c)
{
    const int64_t n = c->points;
    const double dt = n > 1 ? (c->value[n - 1] - c->value[0]) / (double)(n - 1) : 0;
    for (int64_t i = 0; i < n; i++)
        if (fabs(c->value[i] - (c->value[0] + (double)i * dt)) > 1e-6 * dt) return false;
    return true;
}

/* Write times as little-endian doubles if they are not equidistant. */
static mps_status write_times(curves *c)
{
    codec_bytes bytes = {0};
    thin_times(c);
    if (even_times(c)) {
        fprintf(c->out, "{\"from\": %.17g, \"to\": %.17g}", c->value[0], c->value[c->points - 1]);
        return MPS_OK;
    }
    unsigned char *raw = malloc((size_t)c->points * 8);
    if (!raw) return no_memory(c->run);
    for (int64_t i = 0; i < c->points; i++) {
        uint64_t word;
        memcpy(&word, &c->value[i], sizeof word);
        for (int b = 0; b < 8; b++) raw[8 * i + b] = (unsigned char)(word >> 8 * b);
    }
    const bool done = mps__codec_pack(raw, (size_t)c->points * 8, &bytes);
    free(raw);
    fputs("{\"data\": ", c->out);
    mps_status status = done ? write_packed(c, &bytes) : no_memory(c->run);
    free(bytes.data);
    return status;
}

static void write_member(FILE *out, const char *key, const char *text)
{
    fprintf(out, "\"%s\": ", key);
    mps__json(out, text);
    fputs(", ", out);
}

/* Displacements by degree of freedom of the ship are those of its centre: they replace x_tank. */
static bool has_motion(const page_run *r)
{
    bool any = false;
    for (int32_t i = 0; i < r->columns; i++) any = any || strcmp(r->column[i].type, "motion") == 0;
    return any;
}

/* Describe a curve and its plot. @return false: it is not shown */
static bool describe(const curves *c, int32_t k, page_column *column, plot_rule *rule)
{
    const char *name = c->table->name[k];
    *rule = (plot_rule){name, "main", NULL, name, c->table->unit[k]};
    *column = (page_column){
        .name = name, .unit = c->table->unit[k], .type = "value", .about = "", .part = ""};
    for (int32_t i = 0; c->table == &c->run->probes && i < c->run->columns; i++)
        if (c->run->column[i].place == k) *column = c->run->column[i];
    for (const plot_rule *known = c->rules; known->column; known++)
        if (strcmp(known->column, name) == 0) {
            *rule = *known;
            if (!rule->unit) rule->unit = c->table->unit[k];
            return known->place != NULL && (strcmp(name, "x_tank") != 0 || !has_motion(c->run));
        }
    if (strcmp(column->type, "motion") == 0)
        rule->plot = strcmp(rule->unit, "m") == 0 ? "Displacements of the tank"
                                                  : "Rotations of the tank";
    if (strcmp(column->type, "force") == 0 || strcmp(column->type, "moment") == 0)
        rule->place = "forces";
    return c->table == &c->run->probes;
}

static mps_status write_curve(curves *c, int32_t k)
{
    page_column column;
    plot_rule rule;
    codec_bytes bytes = {0};
    double lo = INFINITY, hi = -INFINITY;
    if (!describe(c, k, &column, &rule)) return MPS_OK;
    thin(c, k);
    for (int64_t i = 0; i < c->points; i++)
        if (isfinite(c->value[i])) {
            lo = fmin(lo, c->value[i]);
            hi = fmax(hi, c->value[i]);
        }
    if (!(hi >= lo)) lo = hi = 0;
    if (lo == 0 && hi == 0 && rule.plot) return MPS_OK; /* e.g. a tank at rest */
    if (!mps__codec_curve(c->value, c->points, 1, lo, hi, &bytes)) {
        free(bytes.data);
        return no_memory(c->run);
    }
    fputs(c->any ? ",\n{" : "\n{", c->out);
    c->any = true;
    write_member(c->out, "name", column.name);
    write_member(c->out, "label", rule.label);
    write_member(c->out, "unit", rule.unit);
    write_member(c->out, "type", column.type);
    write_member(c->out, "about", column.about);
    write_member(c->out, "place", rule.place);
    if (rule.plot) write_member(c->out, "plot", rule.plot);
    if (column.has_place)
        fprintf(c->out, "\"at\": [%.9g, %.9g, %.9g], ", column.at[0], column.at[1], column.at[2]);
    fprintf(c->out, "\"lo\": %.9g, \"hi\": %.9g, \"data\": ", lo, hi);
    mps_status status = write_packed(c, &bytes);
    free(bytes.data);
    return status;
}

static mps_status write_table(curves *c, const char *name, int64_t rows_most)
{
    mps_status status = MPS_OK;
    const int64_t rows = c->table->rows;
    if (rows == 0) return MPS_OK;
    c->bucket = rows <= rows_most ? 1 : (2 * rows + rows_most - 1) / rows_most;
    c->points = c->bucket == 1 ? rows : 2 * ((rows + c->bucket - 1) / c->bucket);
    c->value = malloc((size_t)c->points * sizeof *c->value);
    c->any = false;
    if (!c->value) return no_memory(c->run);
    fprintf(c->out,
            "%s{\"table\": \"%s\", \"rows\": %lld, \"bucket\": %lld, \"points\": %lld, \"t\": ",
            strcmp(name, "probes.csv") == 0 ? "" : ",\n", name, (long long)rows,
            (long long)c->bucket, (long long)c->points);
    status = write_times(c);
    fputs(", \"columns\": [", c->out);
    for (int32_t k = 1; status == MPS_OK && k < c->table->columns; k++) status = write_curve(c, k);
    fputs("]}", c->out);
    free(c->value);
    c->value = NULL;
    return status;
}

/* Write "[t, value]"; points that are not finite are omitted. */
static void write_points(FILE *out, const json_value *list)
{
    bool any = false;
    for (const json_value *p = list ? list->first : NULL; p; p = p->next) {
        const double t = mps__json_number(mps__json_at(p, 0));
        const double value = mps__json_number(mps__json_at(p, 1));
        if (!isfinite(t) || !isfinite(value)) continue;
        fprintf(out, any ? ", [%.9g, %.9g]" : "[%.9g, %.9g]", t, value);
        any = true;
    }
}

/* Write reference points. */
static void write_references(FILE *out, const page_run *r)
{
    const json_value *list = mps__json_get(r->summary, "references");
    fputc('[', out);
    for (const json_value *one = list ? list->first : NULL; one; one = one->next) {
        const char *label = mps__json_text(mps__json_get(one, "label"));
        const char *unit = mps__json_text(mps__json_get(one, "unit"));
        const char *column = mps__json_text(mps__json_get(one, "column"));
        fputs(one == list->first ? "{" : ",\n{", out);
        write_member(out, "label", label ? label : "reference");
        write_member(out, "unit", unit ? unit : "");
        if (column) write_member(out, "column", column);
        fprintf(out, "\"line\": %s, \"points\": [",
                mps__json_true(mps__json_get(one, "line")) ? "true" : "false");
        write_points(out, mps__json_get(one, "points"));
        fputs("]}", out);
    }
    fputc(']', out);
}

mps_status mps__page_curves(FILE *out, const page_run *r, int64_t bytes)
{
    const struct {
        const char *name;
        const mps__csv *table;
        const plot_rule *rules;
    } all[] = {{"probes.csv", &r->probes, probes_rule},
               {"momentum.csv", &r->momentum, momentum_rule},
               {"steps.csv", &r->steps, steps_rule}};
    /* two bytes a value at most, 4/3 in base64; a fifth for steps and momentum */
    int64_t rows = bytes * 3 / 10 / (r->probes.columns > 0 ? r->probes.columns : 1);
    rows = rows > ROWS_MOST ? ROWS_MOST : rows < ROWS_LEAST ? ROWS_LEAST : rows;
    mps_status status = MPS_OK;
    fputs("<script type=\"application/json\" id=\"curve-data\">{\"tables\": [\n", out);
    for (int k = 0; status == MPS_OK && k < 3; k++) {
        curves c = {.out = out, .run = r, .table = all[k].table, .rules = all[k].rules};
        status = write_table(&c, all[k].name, k == 0 ? rows : rows / 4 + ROWS_LEAST);
    }
    fputs("],\n\"references\": ", out);
    write_references(out, r);
    fprintf(out, ",\n\"skip\": %.9g}</script>\n", 0.005 * fmax(mps__page_number(r, "t_end"), 0));
    return status;
}

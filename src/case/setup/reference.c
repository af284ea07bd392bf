/* SPDX-License-Identifier: BSD-3-Clause */
/* Reference values of results, figures between two times, and the case in summary.json. */
#include "build.h"
#include "case_csv.h"
#include "body.h"
#include "run.h"
#include "units.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- columns ---- */

void mps__build_column(build *b, const char *name, const char *unit)
{
    build_column *c = mps__build_alloc(b, sizeof *c);
    if (!c) return;
    *c = (build_column){.next = b->column};
    snprintf(c->name, sizeof c->name, "%s", name);
    snprintf(c->unit, sizeof c->unit, "%s", unit);
    b->column = c;
}

/* Columns that each job has. */
static void add_common(build *b)
{
    job_column c;
    for (int k = 0; mps__job_common(k, b->dim, &c); k++) mps__build_column(b, c.name, c.unit);
}

static const build_column *find_column(const build *b, const char *name)
{
    const build_column *c = b->column;
    while (c && strcmp(c->name, name) != 0) c = c->next;
    return c;
}

/* Kinds of values that a column may be compared with; a share is a number. */
static uint64_t kinds_of(const char *unit)
{
    if (!unit[0]) return UNIT_NONE | UNIT_SHARE;
    const mps__unit *u = mps__case_csv_unit(unit);
    return u ? u->kinds : 0;
}

/* ---- references ---- */

typedef struct series {
    const build_column *column; /* NULL: all columns of the unit */
    int64_t count;
    double *t, *value; /* in the memory of the case */
    uint64_t kinds;    /* of the values, which are in SI */
    const char *unit;
} series;

/* Times that decrease belong to another column, or to several concatenated tables.
 * @param t  NULL: they are in the case */
static bool check_times(build *b, const tree_node *node, const mps__csv *t, const series *s)
{
    char line[32] = "";
    for (int64_t i = 1; i < s->count; i++) {
        if (s->t[i] > s->t[i - 1]) continue;
        if (t) snprintf(line, sizeof line, ":%lld: ", (long long)t->line[i]);
        mps__case_log(b->c, node, false,
                      "%s%sthe time %.9g s is not later than that before it, %.9g s",
                      t ? t->path : "", line, s->t[i], s->t[i - 1]);
        return false;
    }
    return true;
}

static bool read_inline(build *b, const tree_node *map, series *s)
{
    double *buffer = mps__build_alloc(b, 2 * COUNT_MOST * sizeof *buffer);
    if (!buffer) return false;
    s->t = buffer;
    s->value = buffer + COUNT_MOST;
    s->count = mps__read_numbers(b->c, map, "times", COUNT_MOST, s->t);
    const int64_t values = mps__read_numbers(b->c, map, "values", COUNT_MOST, s->value);
    const tree_node *node = mps__tree_find(map, "values");
    if (mps__case_failed(b->c)) return false;
    if (values != s->count) {
        mps__case_log(b->c, node ? node : map, false, "%d times, but %d values", (int)s->count,
                      (int)values);
        return false;
    }
    mps__node_numbers(b->c, node, COUNT_MOST, s->value, &s->kinds);
    return check_times(b, mps__tree_find(map, "times"), NULL, s);
}

static bool read_columns(build *b, const tree_node *map, const mps__csv *t, int32_t *column)
{
    const tree_node *node = mps__tree_find(map, "columns");
    int k = 0;
    mps__read_all(node);
    column[0] = 0;
    column[1] = 1;
    for (const tree_node *at = node && node->kind == TREE_LIST ? node->first : NULL; at && k < 2;
         at = at->next, k++)
        column[k] = mps__case_csv_find(b->c, at, t, at->text, true);
    if (t->columns < 2)
        mps__case_log(b->c, map, false, "%s: has one column, two are needed", t->path);
    for (k = 0; k < t->columns; k++) t->wanted[k] = k == column[0] || k == column[1];
    return !mps__case_failed(b->c);
}

static bool read_table(build *b, const tree_node *map, series *s)
{
    mps__csv t = {0};
    int32_t column[2] = {0, 0};
    const tree_node *node = mps__tree_find(map, "file");
    const char *path = mps__read_path(b->c, map, "file"),
               *unit = mps__read_text(b->c, map, "unit", NULL);
    bool good = path && mps__case_csv_open(b->c, node, path, &t) &&
                read_columns(b, map, &t, column);
    const double times = good ? mps__case_csv_factor(b->c, node, &t, column[0], UNIT_TIME, NULL)
                              : NAN;
    const char *text = good && !(unit && unit[0]) ? t.unit[column[1]] : unit;
    const bool plain = good && !text[0] && s->column && !s->column->unit[0];
    const double factor = plain  ? 1
                          : good ? mps__case_csv_factor(b->c, node, &t, column[1], UNIT_ANY, unit)
                                 : NAN;
    good = !isnan(times) && !isnan(factor) && mps__case_csv_read(b->c, node, &t);
    if (good) {
        s->kinds = plain ? UNIT_NONE : mps__case_csv_unit(text)->kinds;
        s->t = mps__build_alloc(b, (size_t)t.rows * sizeof *s->t);
        s->value = mps__build_alloc(b, (size_t)t.rows * sizeof *s->value);
        for (int64_t i = 0; s->t && s->value && i < t.rows; i++) {
            s->t[i] = t.value[column[0]][i] * times;
            s->value[i] = t.value[column[1]][i] * factor;
        }
        s->count = s->t && s->value ? t.rows : 0;
        good = s->count > 0 && check_times(b, node, &t, s);
    }
    mps__csv_free(&t);
    return good;
}

/* The column of a reference: `column`, or that of its name. @return false: there is a message */
static bool choose_column(build *b, const tree_node *map, const char *name, series *s)
{
    const tree_node *node = mps__tree_find(map, "column");
    const char *column = mps__read_text(b->c, map, "column", "");
    const bool sensor = mps__tree_find(mps__tree_find(b->root, "sensors"), name) != NULL;
    s->column = find_column(b, column[0] ? column : name);
    /* sensors with errors have no columns */
    if (s->column || (!column[0] && !sensor) || b->c->known_errors) return true;
    char names[400] = "";
    size_t used = 0;
    for (const build_column *c = b->column; c && used + sizeof c->name < sizeof names; c = c->next)
        if (sensor == !column[0] && (column[0] || strncmp(c->name, name, strlen(name)) == 0))
            used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", used ? ", " : "",
                                     c->name);
    mps__case_log(b->c, node ? node : map, false,
                  "'%s' is no column of probes.csv; give a 'column': %s", column[0] ? column : name,
                  names);
    return false;
}

/* The unit of columns of these kinds: angles are in degrees. */
static const char *unit_of(uint64_t kinds)
{
    return kinds == UNIT_ANGLE ? "deg" : mps__unit_si(kinds);
}

/* Convert the values to the unit of their column, or of the columns of their kind. Values that are
 * all 0 have any unit. @return false: there is a message */
static bool convert(build *b, const tree_node *map, series *s)
{
    const build_column *c = s->column ? s->column : b->column;
    while (!s->column && c && !(kinds_of(c->unit) & s->kinds)) c = c->next;
    s->unit = c ? c->unit : unit_of(s->kinds);
    if (c && !(kinds_of(c->unit) & s->kinds)) {
        const char *given = unit_of(s->kinds);
        mps__case_log(b->c, map, false,
                      "the values have %s%s%s, column '%s' has %s%s%s; give another 'column', or "
                      "values in a unit of that kind",
                      given[0] ? "the unit '" : "no unit", given, given[0] ? "'" : "", c->name,
                      c->unit[0] ? "'" : "none", c->unit, c->unit[0] ? "'" : "");
        return false;
    }
    const mps__unit *u = s->unit[0] ? mps__case_csv_unit(s->unit) : NULL;
    for (int64_t i = 0; u && i < s->count; i++) s->value[i] /= mps__unit_value(u);
    return true;
}

static void add_reference(build *b, const tree_node *map, const char *name)
{
    series s = {0};
    const bool file = mps__tree_find(map, "file") != NULL;
    if (!choose_column(b, map, name, &s)) return;
    if (file ? !read_table(b, map, &s) : !read_inline(b, map, &s)) return;
    const double shift = mps__read_number(b->c, map, "shift", 0);
    for (int64_t i = 0; i < s.count; i++) s.t[i] += shift;
    if (!convert(b, map, &s)) return;
    mps_reference r;
    mps_reference_init(&r, sizeof r);
    r.line = mps__read_choice(b->c, map, "style", 0);
    r.label = mps__read_text(b->c, map, "label", "reference");
    r.unit = s.unit;
    r.count = s.count;
    r.t = s.t;
    r.value = s.value;
    r.column = s.column ? s.column->name : NULL;
    if (mps__case_failed(b->c) || !b->job || b->c->known_errors) return;
    mps__build_try_job(b, mps_job_reference_add(b->job, &r), map, name);
}

/* ---- figures ---- */

static void add_figure(build *b, const tree_node *map)
{
    static const int32_t take[] = {MPS_TRACE_LARGEST, MPS_TRACE_LEAST,    MPS_TRACE_MEAN,
                                   MPS_TRACE_CHANGE,  MPS_TRACE_INTEGRAL, MPS_TRACE_SLOPE};
    mps_trace t;
    mps_trace_init(&t, sizeof t);
    t.kind = take[mps__read_choice(b->c, map, "take", 0)];
    t.name = map->key;
    t.column = mps__read_text(b->c, map, "column", "");
    t.from = mps__read_number(b->c, map, "from", 0);
    t.to = mps__read_number(b->c, map, "until", b->until);
    t.window = mps__read_number(b->c, map, "window", 0);
    t.scale = mps__read_number(b->c, map, "over", 1);
    if (mps__case_failed(b->c) || !b->job || b->c->known_errors) return;
    mps__build_try_job(b, mps_job_trace_add(b->job, &t), map, map->key);
}

void mps__build_references(build *b)
{
    const tree_node *map = mps__tree_find(b->root, "reference"),
                    *figures = mps__tree_find(b->root, "figures");
    if (b->status < 0) return;
    add_common(b);
    for (const tree_node *at = map ? map->first : NULL; at; at = at->next) {
        const tree_node *one = at->kind == TREE_LIST ? at->first : at;
        for (; one; one = one == at ? NULL : one->next) add_reference(b, one, at->key);
    }
    for (const tree_node *at = figures ? figures->first : NULL; at; at = at->next)
        add_figure(b, at);
}

/* ---- inputs ---- */

static void add_input(build *b, const char *key, const char *value)
{
    if (b->job) mps__build_try_job(b, mps_job_input_add(b->job, key, value), b->root, key);
}

/* Constants of the statistics in SI, for programs that read summary.json without T1. */
static bool add_constant(build *b, const tree_node *node, const char *path)
{
    static const struct {
        uint64_t kind;
        const char *unit;
    } units[] = {{UNIT_TIME, " s"}, {UNIT_PRESSURE, " Pa"}, {UNIT_FREQUENCY, " Hz"}};
    char text[64];
    const char *unit = "";
    if (strncmp(path, "impacts.", 8) != 0 || !node->entry || node->entry->shape != SHAPE_NUMBERS)
        return false;
    const double value = mps__read_number(b->c, node->parent, node->key, NAN);
    for (int i = 0; i < 3; i++)
        if (node->entry->units & units[i].kind) unit = units[i].unit;
    snprintf(text, sizeof text, "%.9g%s", value, unit);
    add_input(b, path, text);
    return true;
}

/* Add each value of the tree under its path. */
static void add_node(build *b, const tree_node *node)
{
    char path[PATH_CAPACITY], text[2 * BUILD_TEXT];
    size_t used = 0;
    mps__tree_path(node, path, sizeof path);
    if (add_constant(b, node, path)) return;
    if (strncmp(path, "impacts.", 8) == 0) mps__read_all(node);
    if (node->kind == TREE_TEXT) {
        add_input(b, mps__tree_path(node, path, sizeof path), node->text);
        return;
    }
    bool texts = node->kind == TREE_LIST && node->first;
    for (const tree_node *at = node->first; at; at = at->next)
        texts = texts && at->kind == TREE_TEXT;
    if (!texts) {
        for (const tree_node *at = node->first; at; at = at->next) add_node(b, at);
        return;
    }
    for (const tree_node *at = node->first; at && used < sizeof text; at = at->next)
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%s",
                                 at == node->first ? "" : "; ", at->text);
    add_input(b, mps__tree_path(node, path, sizeof path), text);
}

/* The lowest frequency of the motion, if all others are its multiples [rad/s]; NAN: not
 * periodic. */
static double motion_omega(const build_motion *m)
{
    double least = INFINITY;
    if (!m || m->rows > 0) return NAN;
    for (int32_t i = 0; i < m->count; i++) {
        if (m->harmonic[i].form == MOTION_PUSH || !(m->harmonic[i].omega > 0)) return NAN;
        least = fmin(least, m->harmonic[i].omega);
    }
    for (int32_t i = 0; i < m->count; i++) {
        const double ratio = m->harmonic[i].omega / least;
        if (fabs(ratio - round(ratio)) > 1e-6) return NAN;
    }
    return isfinite(least) ? least : NAN;
}

double mps__build_omega(const build *b)
{
    return motion_omega(b->body ? &b->body->load : b->motion);
}

void mps__build_inputs(build *b)
{
    char text[BUILD_TEXT];
    for (const tree_node *at = b->root->first; at; at = at->next)
        if (strcmp(at->key, "reference") != 0) add_node(b, at);
    if (b->modes.count > 0) {
        snprintf(text, sizeof text, "%.9g s", b->modes.period[0]);
        add_input(b, "T1", text);
        snprintf(text, sizeof text, "%s%s", b->modes.how, mps__modes_without(b));
        add_input(b, "T1 by", text);
    }
    const double omega = mps__build_omega(b);
    if (isfinite(omega)) {
        snprintf(text, sizeof text, "%.9g rad/s", omega);
        add_input(b, "motion omega", text);
    }
    for (int32_t i = 0; i < b->fluids; i++) {
        char key[BUILD_NAME + 16];
        snprintf(key, sizeof key, "phase %d", (int)i);
        snprintf(text, sizeof text, "%s: %g kg/m3, %g Pa s", b->fluid[i].name, b->fluid[i].density,
                 b->fluid[i].viscosity);
        add_input(b, key, text);
    }
}

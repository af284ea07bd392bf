/* SPDX-License-Identifier: BSD-3-Clause */
/* A measured or computed motion of the ship from a table. */
#include "case_csv.h"
#include "ship_motion.h"
#include "units.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

/* Columns of the file: time, and each degree of freedom; -1: not found. */
typedef struct chosen {
    int32_t time, degree[MOTION_DEGREES];
    double factor[1 + MOTION_DEGREES];
} chosen;

static const tree_node *at_of(const tree_node *map, const char *key)
{
    const tree_node *node = mps__tree_find(mps__tree_find(map, "columns"), key);
    return node ? node : mps__tree_find(map, "file");
}

/* Whether `columns` has a degree, not the time alone. */
static bool chooses(const tree_node *columns)
{
    for (int32_t d = 0; columns && d < MOTION_DEGREES; d++)
        if (mps__tree_find(columns, mps__degrees[d])) return true;
    return false;
}

/* By `columns`; where it has no degree, a column that has the name of the degree. */
static int32_t find_column(build *b, const tree_node *map, const mps__csv *t, const char *key)
{
    const tree_node *columns = mps__tree_find(map, "columns");
    const bool given = columns && mps__tree_find(columns, key);
    if (!given && chooses(columns)) return -1;
    const char *name = given ? mps__read_text(b->c, columns, key, NULL) : key;
    return name ? mps__case_csv_find(b->c, at_of(map, key), t, name, given) : -1;
}

static bool choose(build *b, build_motion *m, const tree_node *map, const mps__csv *t, chosen *c)
{
    int found = 0;
    const tree_node *columns = mps__tree_find(map, "columns");
    const tree_node *file = mps__tree_find(map, "file");
    c->time = columns && mps__tree_find(columns, "time")
                  ? find_column(b, map, t, "time")
                  : mps__case_csv_find(b->c, file, t, "time", false);
    if (c->time < 0) c->time = mps__case_csv_find(b->c, file, t, "t", false);
    if (c->time < 0) c->time = 0;
    c->factor[0] = mps__case_csv_factor(
        b->c, file, t, c->time, UNIT_TIME,
        mps__read_text(b->c, mps__tree_find(map, "units"), "time", NULL));
    for (int32_t d = 0; d < MOTION_DEGREES; d++) {
        c->degree[d] = find_column(b, map, t, mps__degrees[d]);
        if (c->degree[d] < 0) continue;
        found++;
        c->factor[1 + d] = mps__case_csv_factor(
            b->c, at_of(map, mps__degrees[d]), t, c->degree[d],
            d < MPS_SHIP_ROLL ? (m->load ? UNIT_FORCE : UNIT_LENGTH)
                              : (m->load ? UNIT_MOMENT : UNIT_ANGLE),
            mps__read_text(b->c, mps__tree_find(map, "units"), mps__degrees[d], NULL));
        m->used[d] = true;
        mps__degree_check(b, m, at_of(map, mps__degrees[d]), d);
    }
    if (!found && !mps__case_failed(b->c)) {
        char names[BUILD_TEXT];
        mps__csv_names(t, names, sizeof names);
        mps__case_log(b->c, file, false, "%s.columns is needed, e.g. {roll: PHI}: the file has %s",
                      m->of, names);
    }
    for (int32_t k = 0; k < t->columns; k++) {
        t->wanted[k] = k == c->time;
        for (int32_t d = 0; d < MOTION_DEGREES; d++)
            t->wanted[k] = t->wanted[k] || k == c->degree[d];
    }
    return !mps__case_failed(b->c);
}

static bool is_degree(const char *name)
{
    for (int32_t d = 0; d < MOTION_DEGREES; d++)
        if (strcasecmp(name, mps__degrees[d]) == 0) return true;
    return false;
}

/* `columns` selects some degrees: others that the file has by their own names are not used. */
static void note_omitted(build *b, const build_motion *m, const tree_node *map, const mps__csv *t)
{
    char names[BUILD_TEXT] = "";
    size_t used = 0;
    for (int32_t k = 0; k < t->columns; k++)
        if (!t->wanted[k] && is_degree(t->name[k]) && used < sizeof names)
            used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", used ? ", " : "",
                                     t->name[k]);
    if (used)
        mps__case_log(
            b->c, mps__tree_find(map, "columns"), true,
            "%s.columns: names some degrees, so these columns are not used: %s; add them, "
            "e.g. {%s: %.*s}, if they are meant",
            m->of, names, mps__degrees[0], (int)strcspn(names, ","), names);
}

/* List unused columns by name. */
static void note_unused(build *b, build_motion *m, const tree_node *map, const mps__csv *t)
{
    size_t used = 0;
    for (int32_t k = 0; k < t->columns; k++) {
        if (!t->wanted[k] && used < sizeof m->unused)
            used += (size_t)snprintf(m->unused + used, sizeof m->unused - used, "%s%s",
                                     used ? ", " : "", t->name[k]);
    }
    if (used && chooses(mps__tree_find(map, "columns")))
        note_omitted(b, m, map, t);
    else if (used)
        mps__case_log(b->c, mps__tree_find(map, "file"), true,
                      "%s: columns that are no motion: %s; 'columns' says what they are, e.g. "
                      "{roll: PHI}",
                      t->path, m->unused);
}

/* Ramp factor f of mps_harmonic: the motion grows from 0. */
static double growth(double t, double ramp)
{
    const double x = ramp > 0 ? t / ramp : 1;
    if (x <= 0) return 0;
    return x < 1 ? x * x * x * (10 + x * (-15 + 6 * x)) : 1;
}

static bool check_times(build *b, const tree_node *node, const mps__csv *t, const build_motion *m)
{
    const double until = b->until, from = m->from;
    for (int64_t i = 1; i < m->rows; i++)
        if (!(m->t[i] > m->t[i - 1])) {
            mps__case_log(b->c, node, false,
                          "%s:%lld: the time %g s is not later than that before it, %g s", t->path,
                          (long long)t->line[i], m->t[i] + from, m->t[i - 1] + from);
            return false;
        }
    const double last = m->t[m->rows - 1], rounding = 1e-12 * (fabs(from) + until);
    if (fabs(m->t[0]) <= rounding) m->t[0] = 0;
    /* otherwise run.until may be in units of a period that is not known */
    const bool known = b->c->known_errors == 0;
    if (m->rows < 2 || (known && (m->t[0] > 0 || last < until - rounding))) {
        mps__case_log(b->c, node, false,
                      "%s.file: has times from %g s to %g s; the run takes %g s to %g s ('from' "
                      "and run.until)",
                      m->of, m->t[0] + from, last + from, from, from + until);
        return false;
    }
    return true;
}

/* Take times from `from` on, and values in SI units. An angle recorded modulo a full rotation is
 * unwrapped. */
static bool take_rows(build *b, build_motion *m, const mps__csv *t, const chosen *c)
{
    const double turn = 2 * acos(-1.0);
    m->rows = t->rows;
    m->t = mps__build_alloc(b, (size_t)t->rows * sizeof *m->t);
    m->column = mps__build_alloc(b, (size_t)t->rows * 6 * sizeof *m->column);
    if (!m->t || !m->column) return false;
    for (int64_t i = 0; i < t->rows; i++) {
        m->t[i] = t->value[c->time][i] * c->factor[0] - m->from;
        for (int32_t d = 0; d < MOTION_DEGREES; d++) {
            double *q = &m->column[6 * i + d];
            if (!m->used[d]) continue;
            *q = t->value[c->degree[d]][i] * c->factor[1 + d];
            if (i > 0 && d >= MPS_SHIP_ROLL && !m->load) *q -= turn * round((*q - q[-6]) / turn);
        }
    }
    return true;
}

/* Loads, roll and pitch grow from 0. The other degrees of freedom have no effect while constant:
 * they grow from their value at t = 0. */
static void grow(build_motion *m)
{
    double first[MOTION_DEGREES] = {0};
    for (int32_t d = 0; d < MOTION_DEGREES; d++)
        if (!m->load && d != MPS_SHIP_ROLL && d != MPS_SHIP_PITCH)
            first[d] = mps__motion_table_at(m, d, 0);
    for (int64_t i = 0; m->ramp > 0 && i < m->rows; i++)
        for (int32_t d = 0; d < MOTION_DEGREES; d++) {
            double *q = &m->column[6 * i + d];
            if (m->used[d]) *q = first[d] + growth(m->t[i], m->ramp) * (*q - first[d]);
        }
}

bool mps__motion_file(build *b, build_motion *m, const tree_node *map)
{
    mps__csv t = {0};
    chosen c = {.time = -1};
    const tree_node *node = mps__tree_find(map, "file");
    const char *path = mps__read_path(b->c, map, "file");
    if (b->dim == 3 && !m->load && !mps__tree_find(map, "axes"))
        mps__case_log(b->c, node, false,
                      "motion.axes is needed for a file in 3-D: 'x forward, y port, z up' or 'x "
                      "forward, y starboard, z down'");
    m->from = mps__read_number(b->c, map, "from", NAN);
    m->ramp = mps__read_number(b->c, map, "ramp", 0);
    bool good = path && !mps__case_failed(b->c) && mps__case_csv_open(b->c, node, path, &t) &&
                choose(b, m, map, &t, &c) && mps__case_csv_read(b->c, node, &t);
    if (good) note_unused(b, m, map, &t);
    if (good && isnan(m->from)) m->from = t.value[c.time][0] * c.factor[0];
    good = good && take_rows(b, m, &t, &c);
    snprintf(m->file, sizeof m->file, "%s", path ? path : "");
    good = good && check_times(b, node, &t, m);
    mps__csv_free(&t);
    good = good && mps__motion_filter(b, m, map);
    if (good) grow(m);
    return good;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* A measured or computed motion of the ship from a table. */
#include "csv.h"
#include "ship_motion.h"
#include "units.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Columns of the file: time, and each degree; -1: not there. */
typedef struct chosen {
    int32_t time, degree[MOTION_DEGREES];
    double factor[1 + MOTION_DEGREES];
} chosen;

static const tree_node *at_of(const tree_node *map, const char *key)
{
    const tree_node *node = mps__tree_find(mps__tree_find(map, "columns"), key);
    return node ? node : mps__tree_find(map, "file");
}

/* By `columns`, or where a column has the name of a degree. */
static int32_t find_column(build *b, const tree_node *map, const csv *t, const char *key)
{
    const tree_node *columns = mps__tree_find(map, "columns");
    const char *name = columns ? mps__read_text(b->c, columns, key, NULL) : key;
    const int32_t k = name ? mps__csv_find(t, name) : -1;
    if (k < 0 && columns && name) {
        char names[BUILD_TEXT];
        mps__csv_names(t, names, sizeof names);
        mps__case_say(b->c, at_of(map, key), false, "'%s' is no column of %s, which has %s", name,
                      t->path, names);
    }
    return k;
}

static bool choose(build *b, build_motion *m, const tree_node *map, const csv *t, chosen *c)
{
    int found = 0;
    const tree_node *columns = mps__tree_find(map, "columns");
    c->time = columns && mps__tree_find(columns, "time") ? find_column(b, map, t, "time")
                                                         : mps__csv_find(t, "time");
    if (c->time < 0) c->time = mps__csv_find(t, "t");
    if (c->time < 0) c->time = 0;
    c->factor[0] = mps__csv_factor(
        b->c, mps__tree_find(map, "file"), t, c->time, UNIT_TIME,
        mps__read_text(b->c, mps__tree_find(map, "units"), "time", NULL));
    for (int32_t d = 0; d < MOTION_DEGREES; d++) {
        c->degree[d] = find_column(b, map, t, mps__degrees[d]);
        if (c->degree[d] < 0) continue;
        found++;
        c->factor[1 + d] = mps__csv_factor(
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
        mps__case_say(b->c, mps__tree_find(map, "file"), false,
                      "%s.columns is needed, e.g. {roll: PHI}: the file has %s", m->of, names);
    }
    return !mps__case_failed(b->c);
}

/* Columns that are not used, by name. Where `columns` chooses, the others are left out on purpose. */
static void note_unused(build *b, build_motion *m, const tree_node *map, const csv *t,
                        const chosen *c)
{
    size_t used = 0;
    for (int32_t k = 0; k < t->columns; k++) {
        bool known = k == c->time;
        for (int32_t d = 0; d < MOTION_DEGREES; d++) known = known || k == c->degree[d];
        if (!known && used < sizeof m->unused)
            used += (size_t)snprintf(m->unused + used, sizeof m->unused - used, "%s%s",
                                     used ? ", " : "", t->name[k]);
    }
    if (used && !mps__tree_find(map, "columns"))
        mps__case_say(b->c, mps__tree_find(map, "file"), true,
                      "%s: columns that are no motion: %s; 'columns' says what they are, e.g. "
                      "{roll: PHI}",
                      t->path, m->unused);
}

/* f of mps_harmonic with a ramp: the motion grows from 0. */
static double growth(double t, double ramp)
{
    const double x = ramp > 0 ? t / ramp : 1;
    if (x <= 0) return 0;
    return x < 1 ? x * x * x * (10 + x * (-15 + 6 * x)) : 1;
}

static bool check_times(build *b, const tree_node *node, const csv *t, const build_motion *m,
                        double from)
{
    const double until = b->until;
    for (int64_t i = 1; i < m->rows; i++)
        if (!(m->t[i] > m->t[i - 1])) {
            mps__case_say(b->c, node, false,
                          "%s:%lld: the time %g s is not later than that before it, %g s", t->path,
                          (long long)t->line[i], m->t[i] + from, m->t[i - 1] + from);
            return false;
        }
    const double last = m->t[m->rows - 1];
    if (m->rows < 2 || m->t[0] > 0 || last < until * (1 - 1e-12)) {
        mps__case_say(b->c, node, false,
                      "%s.file: has times from %g s to %g s; the run takes %g s to %g s ('from' "
                      "and run.until)",
                      m->of, m->t[0] + from, last + from, from, from + until);
        return false;
    }
    return true;
}

bool mps__motion_file(build *b, build_motion *m, const tree_node *map)
{
    csv t = {0};
    chosen c = {.time = -1};
    const tree_node *node = mps__tree_find(map, "file");
    const char *path = mps__read_path(b->c, map, "file");
    if (b->dim == 3 && !m->load && !mps__tree_find(map, "axes"))
        mps__case_say(b->c, node, false,
                      "motion.axes is needed for a file in 3-D: 'x forward, y port, z up' or 'x "
                      "forward, y starboard, z down'");
    double from = mps__read_number(b->c, map, "from", NAN);
    const double ramp = mps__read_number(b->c, map, "ramp", 0);
    bool good = path && !mps__case_failed(b->c) && mps__csv_read(b->c, node, path, &t) &&
                choose(b, m, map, &t, &c);
    if (good) note_unused(b, m, map, &t, &c);
    if (good) {
        if (isnan(from)) from = t.value[c.time] * c.factor[0];
        m->rows = t.rows;
        m->t = mps__build_alloc(b, (size_t)t.rows * sizeof *m->t);
        m->column = mps__build_alloc(b, (size_t)t.rows * 6 * sizeof *m->column);
        good = m->t && m->column;
    }
    for (int64_t i = 0; good && i < t.rows; i++) {
        const double *row = t.value + i * t.columns;
        m->t[i] = row[c.time] * c.factor[0] - from;
        for (int32_t d = 0; d < MOTION_DEGREES; d++) {
            if (m->used[d])
                m->column[6 * i + d] = growth(m->t[i], ramp) * row[c.degree[d]] * c.factor[1 + d];
        }
    }
    snprintf(m->file, sizeof m->file, "%s", path ? path : "");
    good = good && check_times(b, node, &t, m, from);
    mps__csv_free(&t);
    return good;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows of every step, and integrals, means, extremes and slopes of their columns. */
#include "trace.h"
#include "outputs.h"
#include "ranks.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TRACE_ROOM = 1024, TRACE_COLUMNS = TRACE_OWN + RUN_COLUMNS };

/* Of the end of a measure, relative: a run ends within rounding of its time. */
static const double SLACK = 1e-9;

void trace_add(run *r, trace *t)
{
    *t = (trace){0};
    r->trace = t;
}

/* Keep a row; a table_row_fn as well, for the rows of the file that a run goes on with. */
static void trace_keep(void *user, const double *row)
{
    trace *t = user;
    if (t->count == t->room) {
        const int64_t room = t->room > 0 ? 2 * t->room : TRACE_ROOM;
        double *grown = realloc(t->row, (size_t)(room * t->columns) * sizeof *grown);
        if (!grown) {
            t->failed = true;
            return;
        }
        t->row = grown;
        t->room = room;
    }
    memcpy(t->row + t->count++ * t->columns, row, (size_t)t->columns * sizeof *row);
}

bool trace_open(run *r)
{
    trace *t = r->trace;
    char header[(TRACE_COLUMNS)*48] = "t[s],dt[s]";
    if (!t) return true;
    const char *unit = r->options.dim == 3 ? "N s" : "N s/m";
    for (int k = 0; k < 6; k++)
        snprintf(header + strlen(header), sizeof header - strlen(header), ",%s_%c[%s]",
                 k < 3 ? "momentum" : "walls", "xyz"[k % 3], unit);
    for (int i = 0; i < r->columns; i++)
        snprintf(header + strlen(header), sizeof header - strlen(header), ",%s[%s]",
                 r->column[i].name, r->column[i].unit);
    t->columns = TRACE_OWN + r->columns;
    if (!table_create(&t->file, r->options.out, "trace.csv", t->columns, 0)) return false;
    if (!r->options.resume) return table_begin(&t->file, header);
    return table_resume(&t->file, header, r->totals.t_before, trace_keep, t);
}

void trace_step(run *r, double t, double dt)
{
    double row[TRACE_COLUMNS] = {0};
    mps_momentum m;
    mps_momentum_init(&m, sizeof m);
    run_note(r, mps_momentum_get(r->sim, &m), "momentum");
    run_measure_columns(r, row + TRACE_OWN);
    if (!ranks_first()) return;
    row[TRACE_T] = t;
    row[TRACE_DT] = dt;
    for (int d = 0; d < r->options.dim; d++) {
        row[TRACE_MOMENTUM + d] = m.total[d];
        row[TRACE_WALLS + d] = m.walls[d];
    }
    for (int i = 0; i < r->columns; i++)
        if (dt == 0 && r->column[i].pressure)
            row[TRACE_OWN + i] = 0; /* none before the first step */
    table_append(&r->trace->file, row);
    trace_keep(r->trace, row);
}

void trace_free(trace *t)
{
    table_free(&t->file);
    free(t->row);
    *t = (trace){0};
}

/* ---- measures -------------------------------------------------------------------------------------------------- */

static double trace_at(const trace *t, int64_t k, int column)
{
    return t->row[k * t->columns + column];
}

/* Part of step k that lies between two times [s]. */
static double trace_part(const trace *t, int64_t k, double from, double to)
{
    const double end = trace_at(t, k, TRACE_T), begin = end - trace_at(t, k, TRACE_DT);
    return fmax(0, fmin(end, to) - fmax(begin, from));
}

static double trace_integral(const trace *t, int column, double from, double to)
{
    double sum = 0;
    for (int64_t k = 0; k < t->count; k++)
        sum += trace_part(t, k, from, to) * trace_at(t, k, column);
    return sum;
}

/* A state at a time, linear between the steps. */
static double trace_state(const trace *t, int column, double time)
{
    int64_t k = 1;
    while (k + 1 < t->count && trace_at(t, k, TRACE_T) < time) k++;
    const double a = trace_at(t, k - 1, TRACE_T), b = trace_at(t, k, TRACE_T),
                 f = fmin(1, fmax(0, (time - a) / (b - a)));
    return (1 - f) * trace_at(t, k - 1, column) + f * trace_at(t, k, column);
}

/* Slope of the straight line through a column, each step with its duration as its weight. */
static double trace_slope(const trace *t, int column, double from, double to)
{
    double w = 0, wt = 0, wy = 0, wtt = 0, wty = 0;
    for (int64_t k = 0; k < t->count; k++) {
        const double part = trace_part(t, k, from, to), y = trace_at(t, k, column);
        const double at = trace_at(t, k, TRACE_T) - 0.5 * trace_at(t, k, TRACE_DT) - from;
        w += part;
        wt += part * at;
        wy += part * y;
        wtt += part * at * at;
        wty += part * at * y;
    }
    return (w * wty - wt * wy) / (w * wtt - wt * wt);
}

/* Largest value times `sign` between two times. The mean over a window is largest where one of its ends is at the end of a step. */
static double trace_extreme(const trace_measure *m, double sign)
{
    const trace *t = m->rows;
    double most = -INFINITY;
    for (int64_t k = 1; k < t->count; k++) {
        const double end = trace_at(t, k, TRACE_T);
        if (end <= m->from || end > m->to * (1 + SLACK)) continue;
        if (m->window <= 0) most = fmax(most, sign * trace_at(t, k, m->column));
        if (m->window <= 0) continue;
        if (end - m->window >= m->from)
            most = fmax(most,
                        sign * trace_integral(t, m->column, end - m->window, end) / m->window);
        if (end + m->window <= m->to)
            most = fmax(most,
                        sign * trace_integral(t, m->column, end, end + m->window) / m->window);
    }
    return sign * most;
}

double trace_figure(void *user, mps_sim *sim)
{
    const trace_measure *m = user;
    const trace *t = m->rows;
    (void)sim;
    if (m->kind == TRACE_GIVEN) return m->scale;
    if (t->failed || t->count < 2 || trace_at(t, t->count - 1, TRACE_T) < m->to * (1 - SLACK))
        return NAN;
    switch (m->kind) {
    case TRACE_INTEGRAL:
        return trace_integral(t, m->column, m->from, m->to) / m->scale;
    case TRACE_MEAN:
        return trace_integral(t, m->column, m->from, m->to) / ((m->to - m->from) * m->scale);
    case TRACE_CHANGE:
        return (trace_state(t, m->column, m->to) - trace_state(t, m->column, m->from)) / m->scale;
    case TRACE_LARGEST:
        return trace_extreme(m, 1) / m->scale;
    case TRACE_LEAST:
        return trace_extreme(m, -1) / m->scale;
    case TRACE_SLOPE:
        return trace_slope(t, m->column, m->from, m->to) / m->scale;
    default:
        return NAN;
    }
}

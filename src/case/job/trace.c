/* SPDX-License-Identifier: BSD-3-Clause */
/* trace.csv: the added columns after every step, without interpolation, and integrals, means,
 * extremes and slopes of them. Impacts last a few steps: rows at fixed times would miss them. */
#include "grow.h"
#include "run.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Columns of trace.csv. Momentum of the fluid and the impulse of the walls on it have three columns
 * each, in 2-D the third is 0; the added columns follow. */
enum {
    TRACE_T,
    TRACE_DT,
    TRACE_MOMENTUM,
    TRACE_WALLS = TRACE_MOMENTUM + 3,
    TRACE_OWN = TRACE_WALLS + 3
};

/* Relative tolerance of the end of a measure: a run ends within rounding of its time. */
static const double SLACK = 1e-9;

static const char *const FLOW[] = {"momentum_x", "momentum_y", "momentum_z",
                                   "walls_x",    "walls_y",    "walls_z"};

/* ---- rows ---- */

/* Keep a row; a table_row_fn as well, for the rows of the file of a resumed run. */
void mps__trace_keep(void *user, const double *row)
{
    mps_job *job = user;
    const int columns = job->trace_rows.columns;
    double *grown = mps__grown(job->all_rows, job->all_count, (size_t)columns * sizeof *grown);
    if (!grown) {
        job->all_failed = true;
        return;
    }
    job->all_rows = grown;
    memcpy(job->all_rows + job->all_count++ * columns, row, (size_t)columns * sizeof *row);
}

bool mps__trace_open(mps_job *job)
{
    if (!job->config.trace) return true;
    const char *unit = job->dim == 3 ? "N s" : "N s/m";
    const size_t size = (size_t)(TRACE_OWN + job->columns) * (JOB_NAME + JOB_UNIT + 4);
    char *header = malloc(size);
    if (!header) return mps__job_fail(job, MPS_EXIT_FAILED, "out of memory");
    size_t used = (size_t)snprintf(header, size, "t[s],dt[s]");
    for (int k = 0; k < 6; k++)
        used += (size_t)snprintf(header + used, size - used, ",%s[%s]", FLOW[k], unit);
    for (int k = 0; k < job->columns; k++)
        used += (size_t)snprintf(header + used, size - used, ",%s[%s]", job->column[k].name,
                                 job->column[k].unit);
    const bool done = mps__job_open_table(job, &job->trace_rows, "trace.csv", header,
                                          TRACE_OWN + job->columns);
    free(header);
    return done;
}

void mps__trace_step(mps_job *job, double t, double dt)
{
    double *row = job->row;
    mps_momentum m;
    memset(row, 0, TRACE_OWN * sizeof *row);
    mps_momentum_init(&m, sizeof m);
    mps__job_note(job, mps_momentum_get(job->sim, &m), "momentum");
    mps__job_measure(job, row + TRACE_OWN);
    if (!mps__job_first(job)) return;
    row[TRACE_T] = t;
    row[TRACE_DT] = dt;
    for (int d = 0; d < job->dim; d++) {
        row[TRACE_MOMENTUM + d] = m.total[d];
        row[TRACE_WALLS + d] = m.walls[d];
    }
    /* none before the first step */
    for (int k = 0; k < job->columns; k++)
        if (dt == 0 && job->column[k].flags & MPS_JOB_PRESSURE) row[TRACE_OWN + k] = 0;
    mps__table_append(&job->trace_rows, row);
    mps__trace_keep(job, row);
}

/* ---- figures ---- */

static double value_at(const mps_job *t, int64_t k, int column)
{
    return t->all_rows[k * t->trace_rows.columns + column];
}

/* Part of step k between two times [s]. */
static double part(const mps_job *t, int64_t k, double from, double to)
{
    const double end = value_at(t, k, TRACE_T), begin = end - value_at(t, k, TRACE_DT);
    return fmax(0, fmin(end, to) - fmax(begin, from));
}

static double integral(const mps_job *t, int column, double from, double to)
{
    double sum = 0;
    for (int64_t k = 0; k < t->all_count; k++) sum += part(t, k, from, to) * value_at(t, k, column);
    return sum;
}

/* The state at a time, linear between steps. */
static double state(const mps_job *t, int column, double time)
{
    int64_t k = 1;
    while (k + 1 < t->all_count && value_at(t, k, TRACE_T) < time) k++;
    const double a = value_at(t, k - 1, TRACE_T), b = value_at(t, k, TRACE_T),
                 f = fmin(1, fmax(0, (time - a) / (b - a)));
    return (1 - f) * value_at(t, k - 1, column) + f * value_at(t, k, column);
}

/* Slope of the regression line through a column; the weight of a step is its duration. */
static double slope(const mps_job *t, int column, double from, double to)
{
    double w = 0, wt = 0, wy = 0, wtt = 0, wty = 0;
    for (int64_t k = 0; k < t->all_count; k++) {
        const double share = part(t, k, from, to), y = value_at(t, k, column);
        const double at = value_at(t, k, TRACE_T) - 0.5 * value_at(t, k, TRACE_DT) - from;
        w += share;
        wt += share * at;
        wy += share * y;
        wtt += share * at * at;
        wty += share * at * y;
    }
    return (w * wty - wt * wy) / (w * wtt - wt * wt);
}

/* Largest value times `sign` between two times. The mean over a window has its extremes where one
 * end of the window is the end of a step. */
static double extreme(const trace_figure *f, double sign)
{
    const mps_job *t = f->job;
    const mps_trace *m = &f->of;
    double most = -INFINITY;
    for (int64_t k = 1; k < t->all_count; k++) {
        const double end = value_at(t, k, TRACE_T);
        if (end <= m->from || end > m->to * (1 + SLACK)) continue;
        if (m->window <= 0) most = fmax(most, sign * value_at(t, k, f->column));
        if (m->window <= 0) continue;
        if (end - m->window >= m->from)
            most = fmax(most, sign * integral(t, f->column, end - m->window, end) / m->window);
        if (end + m->window <= m->to)
            most = fmax(most, sign * integral(t, f->column, end, end + m->window) / m->window);
    }
    return sign * most;
}

static double measure(void *user, mps_sim *sim)
{
    const trace_figure *f = user;
    const mps_trace *m = &f->of;
    const mps_job *t = f->job;
    (void)sim;
    if (m->kind == MPS_TRACE_GIVEN) return m->scale;
    if (m->to < m->from || t->all_failed || t->all_count < 2 ||
        value_at(t, t->all_count - 1, TRACE_T) < m->to * (1 - SLACK))
        return NAN;
    switch (m->kind) {
    case MPS_TRACE_INTEGRAL:
        return integral(t, f->column, m->from, m->to) / m->scale;
    case MPS_TRACE_MEAN:
        return integral(t, f->column, m->from, m->to) / ((m->to - m->from) * m->scale);
    case MPS_TRACE_CHANGE:
        return (state(t, f->column, m->to) - state(t, f->column, m->from)) / m->scale;
    case MPS_TRACE_LARGEST:
        return extreme(f, 1) / m->scale;
    case MPS_TRACE_LEAST:
        return extreme(f, -1) / m->scale;
    default:
        return slope(t, f->column, m->from, m->to) / m->scale;
    }
}

/* ---- adding ---- */

mps_status mps_trace_init(mps_trace *trace, size_t size)
{
    if (!trace || size != sizeof *trace) return MPS_E_ARG;
    *trace = (mps_trace){.struct_size = sizeof *trace, .scale = 1};
    return MPS_OK;
}

/* Describe a figure by its own numbers. */
static void describe(const mps_trace *m, char *out, size_t size)
{
    static const char *const kind[] = {
        [MPS_TRACE_GIVEN] = "",          [MPS_TRACE_INTEGRAL] = "integral over time of",
        [MPS_TRACE_MEAN] = "mean of",    [MPS_TRACE_CHANGE] = "change of",
        [MPS_TRACE_LARGEST] = "largest", [MPS_TRACE_LEAST] = "least",
        [MPS_TRACE_SLOPE] = "slope of"};
    if (m->kind == MPS_TRACE_GIVEN) {
        snprintf(out, size, "known beforehand, to compare with");
        return;
    }
    const bool flow = strncmp(m->column, "momentum_", 9) == 0;
    int used = flow ? snprintf(out, size, "%s momentum of the fluid along %s", kind[m->kind],
                               m->column + 9)
                    : snprintf(out, size, "%s %s", kind[m->kind], m->column);
    if (m->window > 0)
        used += snprintf(out + used, size - (size_t)used, ", means over %.4g s", m->window);
    used += snprintf(out + used, size - (size_t)used, ", t = %.4g to %.4g s", m->from, m->to);
    if (m->scale != 1) snprintf(out + used, size - (size_t)used, ", divided by %.5g", m->scale);
}

/* Index of a column of trace.csv, or -1. */
static int find_column(const mps_job *job, const char *name)
{
    for (int k = 0; name && k < job->columns; k++)
        if (strcmp(job->column[k].name, name) == 0) return TRACE_OWN + k;
    for (int k = 0; name && k < 6; k++)
        if (strcmp(FLOW[k], name) == 0) return TRACE_MOMENTUM + k;
    return -1;
}

mps_status mps_job_trace_add(mps_job *job, const mps_trace *trace)
{
    char about[JOB_ABOUT];
    if (!job || !trace || trace->struct_size != sizeof *trace) return MPS_E_ARG;
    const int column = find_column(job, trace->column);
    const char *name = trace->name ? trace->name : "";
    const bool given = trace->kind == MPS_TRACE_GIVEN;
    if (trace->kind < MPS_TRACE_GIVEN || trace->kind > MPS_TRACE_SLOPE || !isfinite(trace->from) ||
        !isfinite(trace->to) || !(trace->window >= 0) || !isfinite(trace->scale))
        return mps__job_refuse(
            job, MPS_E_ARG,
            "figure '%s': needs a known kind, window >= 0; times and scale must be numbers", name);
    if (!given && column < 0)
        return mps__job_refuse(job, MPS_E_NAME, "figure '%s': no column '%s'", name,
                               trace->column ? trace->column : "");
    trace_figure **grown = mps__grown(job->trace, job->traces, sizeof(void *)),
                 *f = malloc(sizeof *f);
    if (grown) job->trace = grown;
    if (!grown || !f) {
        free(f);
        return mps__job_refuse(job, MPS_E_NOMEM, "out of memory");
    }
    *f = (trace_figure){.job = job, .column = column, .of = *trace};
    if (!trace->about) describe(trace, about, sizeof about);
    const mps_status status = mps_job_figure_add(job, name, trace->about ? trace->about : about, 0,
                                                 measure, f);
    job->trace[job->traces++] = f;
    job->config.trace = 1;
    return status;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Motion from a table: natural cubic splines, so that velocity and acceleration are continuous. */
#include "builtin_motion.h"
#include <math.h>
#include <string.h>

typedef struct spline_table {
    int64_t rows;
    int32_t dofs, dof[MPS_DOF_COUNT];
    const double *t;      /* [rows] */
    const double *value;  /* [dofs*rows], one column after the other */
    const double *second; /* [dofs*rows] second derivatives at the knots */
    /* of each column: tolerated deviation of accelerations from a line; rounding error of values */
    double slack[MPS_DOF_COUNT], rounding[MPS_DOF_COUNT];
    double data[];
} spline_table;

/* Second derivatives m of the natural spline: m_0 = m_last = 0 and, with h_k = t_k+1 - t_k, h_k-1
 * m_k-1 + 2 (h_k-1 + h_k) m_k + h_k m_k+1 = 6 (slope_k - slope_k-1). Thomas algorithm; `upper`
 * [rows] is workspace. */
static void natural_spline(int64_t rows, const double *t, const double *y, double *m, double *upper)
{
    m[0] = upper[0] = 0;
    for (int64_t k = 1; k < rows - 1; k++) {
        double before = t[k] - t[k - 1], after = t[k + 1] - t[k];
        double right = 6 * ((y[k + 1] - y[k]) / after - (y[k] - y[k - 1]) / before);
        double pivot = 2 * (before + after) - before * upper[k - 1];
        upper[k] = after / pivot;
        m[k] = (right - before * m[k - 1]) / pivot;
    }
    m[rows - 1] = 0;
    for (int64_t k = rows - 2; k > 0; k--) m[k] -= upper[k] * m[k + 1];
}

/* The last interval that begins at or before t. */
static int64_t find_interval(const spline_table *s, double t)
{
    int64_t low = 0, high = s->rows - 1;
    while (high - low > 1) {
        int64_t middle = low + (high - low) / 2;
        if (s->t[middle] <= t)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* Both end terms vanish exactly at their knots: values there are those of the table. */
static void evaluate(const spline_table *s, int32_t column, int64_t k, double t,
                     mps_motion_state *state)
{
    const double *y = &s->value[column * s->rows], *m = &s->second[column * s->rows];
    double h = s->t[k + 1] - s->t[k], b = (t - s->t[k]) / h, a = (s->t[k + 1] - t) / h;
    int32_t dof = s->dof[column];
    state->value[dof] = a * y[k] + b * y[k + 1] +
                        ((a * a * a - a) * m[k] + (b * b * b - b) * m[k + 1]) * h * h / 6;
    state->rate[dof] = (y[k + 1] - y[k]) / h +
                       ((1 - 3 * a * a) * m[k] + (3 * b * b - 1) * m[k + 1]) * h / 6;
    state->accel[dof] = a * m[k] + b * m[k + 1];
}

/* In a twentieth of its period a harmonic of amplitude A deviates from a line by (2 pi/20)^2
 * A/8. */
static void note_slack(spline_table *s, int32_t column)
{
    const double share = 0.0123, digits = 1e-13;
    double acceleration = 0, value = 0;
    for (int64_t k = column * s->rows; k < (column + 1) * s->rows; k++) {
        acceleration = fmax(acceleration, fabs(s->second[k]));
        value = fmax(value, fabs(s->value[k]));
    }
    s->slack[column] = share * acceleration;
    s->rounding[column] = digits * value;
}

void *mps__motion_table_create(const mps_allocator *allocator, int64_t rows, const double *t,
                               int32_t dofs, const int32_t *dof, const double *values)
{
    /* t, values, second derivatives, workspace */
    uint64_t numbers = (uint64_t)rows * (2u * (uint64_t)dofs + 2u);
    if ((uint64_t)rows > SIZE_MAX / 1024) return NULL;
    spline_table *s = allocator->alloc(allocator->user,
                                       sizeof *s + (size_t)numbers * sizeof(double));
    if (!s) return NULL;
    double *value = s->data + rows, *second = value + dofs * rows, *scratch = second + dofs * rows;
    s->rows = rows;
    s->dofs = dofs;
    memcpy(s->dof, dof, (size_t)dofs * sizeof *dof);
    memcpy(s->data, t, (size_t)rows * sizeof *t);
    s->t = s->data;
    s->value = value;
    s->second = second;
    for (int32_t c = 0; c < dofs; c++) {
        for (int64_t k = 0; k < rows; k++) value[c * rows + k] = values[k * dofs + c];
        natural_spline(rows, t, &value[c * rows], &second[c * rows], scratch);
        note_slack(s, c);
    }
    return s;
}

int mps__motion_table(void *user, double t, mps_motion_state *state)
{
    const spline_table *s = user;
    /* a time outside by rounding */
    if (t < s->t[0]) t = s->t[0];
    if (t > s->t[s->rows - 1]) t = s->t[s->rows - 1];
    int64_t k = find_interval(s, t);
    for (int32_t c = 0; c < s->dofs; c++) evaluate(s, c, k, t, state);
    return 0;
}

/* Time of the last row up to `end` for which all rows since t, in interval k, have accelerations
 * within `slack` of a line; `end` if this holds for all. */
static double last_row_in_line(const spline_table *s, int32_t column, int64_t k, double t,
                               double end)
{
    const double *m = &s->second[column * s->rows];
    const double from = m[k] + (m[k + 1] - m[k]) * (t - s->t[k]) / (s->t[k + 1] - s->t[k]);
    double steepest = INFINITY, flattest = -INFINITY, last = t;
    for (int64_t row = k + 1; row < s->rows && s->t[row] < end; row++) {
        const double way = s->t[row] - t, h = s->t[row] - s->t[row - 1];
        const double slack = s->slack[column] + s->rounding[column] / (h * h);
        const double slope = (m[row] - from) / way;
        if (!(way > 0)) continue;
        if (slope > steepest || slope < flattest) return last;
        steepest = fmin(steepest, slope + slack / way);
        flattest = fmax(flattest, slope - slack / way);
        last = s->t[row];
    }
    return end;
}

double mps__motion_table_longest(const void *user, double t, double dt)
{
    const spline_table *s = user;
    const int64_t k = find_interval(s, t);
    const double next = s->t[k + 1] - t;
    double end = t + dt;
    for (int32_t c = 0; c < s->dofs; c++) end = last_row_in_line(s, c, k, t, end);
    const double interval = k + 2 < s->rows ? fmax(next, s->t[k + 2] - s->t[k + 1]) : INFINITY;
    return end < t + dt ? fmax(end - t, interval) : INFINITY;
}

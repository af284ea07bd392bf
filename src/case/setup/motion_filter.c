/* SPDX-License-Identifier: BSD-3-Clause */
/* The spline of a table and its filter. For rows y_i at t_i the filter finds the z(t) that
 * minimises
 *   sum_i w_i (y_i - z(t_i))^2 + lambda integral (z'')^2 dt,
 *   lambda = (2 pi f_c)^-4, w_i = (t_i+1 - t_i-1)/2,
 * a natural cubic spline (Reinsch 1967). For evenly spaced rows its gain at the frequency f is 1/(1
 * + (f/f_c)^4), without phase shift; a linear function of time is unchanged. lambda = 0 is the
 * interpolating spline that the library makes. */
#include "ship_motion.h"
#include <math.h>
#include <stdlib.h>

/* Below, 1 + 16/(2 pi f_c h)^4 exceeds double precision. */
static const double LEAST = 5e-4;

/* (R + lambda Q^T W^-1 Q) z'' = Q^T y: a pentadiagonal matrix, stored as diagonal and two upper
 * diagonals. */
typedef struct smoothing {
    int64_t rows;
    const double *t;
    double lambda;
    double *y, *middle, *next, *second; /* [rows] */
} smoothing;

static double interval(const smoothing *s, int64_t i)
{
    return s->t[i + 1] - s->t[i];
}

static double weight(const smoothing *s, int64_t i)
{
    const double before = i > 0 ? interval(s, i - 1) : 0,
                 after = i + 1 < s->rows ? interval(s, i) : 0;
    return 0.5 * (before + after);
}

/* Entry of Q in the column of row k. */
static double q_of(const smoothing *s, int64_t i, int64_t k)
{
    if (i == k) return -1 / interval(s, k - 1) - 1 / interval(s, k);
    return 1 / interval(s, i < k ? i : k);
}

/* Entry k, k + step of the matrix; 1 <= k, k + step <= rows - 2. */
static double entry(const smoothing *s, int64_t k, int64_t step)
{
    double sum = 0, own = 0;
    if (step == 0) own = (interval(s, k - 1) + interval(s, k)) / 3;
    if (step == 1) own = interval(s, k) / 6;
    for (int64_t i = k + step - 1; s->lambda > 0 && i <= k + 1; i++)
        sum += q_of(s, i, k) * q_of(s, i, k + step) / weight(s, i);
    return own + s->lambda * sum;
}

/* Cholesky factorisation L D L^T of a band matrix. */
static void solve(const smoothing *s, double *x)
{
    const int64_t n = s->rows;
    double *d = s->middle, *e = s->next, *f = s->second;
    for (int64_t k = 1; k < n - 1; k++) {
        d[k] = entry(s, k, 0);
        e[k] = k + 1 < n - 1 ? entry(s, k, 1) : 0;
        f[k] = k + 2 < n - 1 ? entry(s, k, 2) : 0;
        if (k > 1) {
            d[k] -= d[k - 1] * e[k - 1] * e[k - 1];
            e[k] -= d[k - 1] * e[k - 1] * f[k - 1];
            x[k] -= e[k - 1] * x[k - 1];
        }
        if (k > 2) {
            d[k] -= d[k - 2] * f[k - 2] * f[k - 2];
            x[k] -= f[k - 2] * x[k - 2];
        }
        e[k] /= d[k];
        f[k] /= d[k];
    }
    for (int64_t k = n - 2; k > 0; k--) {
        x[k] /= d[k];
        if (k + 1 < n - 1) x[k] -= e[k] * x[k + 1];
        if (k + 2 < n - 1) x[k] -= f[k] * x[k + 2];
    }
}

static void filter(const smoothing *s, double *second, double *smooth)
{
    const int64_t n = s->rows;
    second[0] = second[n - 1] = 0;
    for (int64_t k = 1; k < n - 1; k++)
        second[k] = (s->y[k + 1] - s->y[k]) / interval(s, k) -
                    (s->y[k] - s->y[k - 1]) / interval(s, k - 1);
    solve(s, second);
    for (int64_t i = 0; smooth && i < n; i++) {
        double sum = 0;
        for (int64_t k = i - 1; k <= i + 1; k++)
            if (k > 0 && k < n - 1) sum += q_of(s, i, k) * second[k];
        smooth[i] = s->y[i] - s->lambda * sum / weight(s, i);
    }
}

bool mps__motion_spline(build *b, const build_motion *m, int32_t degree, double cutoff,
                        double *second, double *smooth)
{
    const double omega = 2 * acos(-1.0) * cutoff;
    double *work = malloc(4 * (size_t)m->rows * sizeof *work);
    if (!work) {
        b->status = MPS_E_NOMEM;
        return false;
    }
    smoothing s = {.rows = m->rows,
                   .t = m->t,
                   .lambda = cutoff > 0 ? pow(omega, -4) : 0,
                   .y = work,
                   .middle = work + m->rows,
                   .next = work + 2 * m->rows,
                   .second = work + 3 * m->rows};
    for (int64_t i = 0; i < m->rows; i++) s.y[i] = m->column[6 * i + degree];
    filter(&s, second, smooth);
    free(work);
    return true;
}

static double largest(const double *value, int64_t count)
{
    double most = 0;
    for (int64_t i = 0; i < count; i++) most = fmax(most, fabs(value[i]));
    return most;
}

bool mps__motion_filter(build *b, build_motion *m, const tree_node *map)
{
    m->cutoff = m->load ? 0 : mps__read_number(b->c, map, "cutoff", 0);
    if (!(m->cutoff > 0) || mps__case_failed(b->c)) return !mps__case_failed(b->c);
    const double h = (m->t[m->rows - 1] - m->t[0]) / (double)(m->rows - 1),
                 least = LEAST / (2 * acos(-1.0) * h);
    if (m->cutoff < least) {
        mps__case_log(b->c, mps__tree_find(map, "cutoff"), false,
                      "motion.cutoff: %g Hz is too low for rows %g s apart; must be at least %.2g "
                      "Hz, or give a file with fewer rows",
                      m->cutoff, h, least);
        return false;
    }
    double *second = mps__build_alloc(b, 2 * (size_t)m->rows * sizeof *second);
    if (!second) return false;
    for (int32_t d = 0; d < MOTION_DEGREES; d++) {
        motion_filtered *c = &m->change[d];
        double *smooth = second + m->rows, square = 0;
        if (!m->used[d]) continue;
        if (!mps__motion_spline(b, m, d, 0, second, NULL)) return false;
        c->accel = largest(second, m->rows);
        if (!mps__motion_spline(b, m, d, m->cutoff, second, smooth)) return false;
        for (int64_t i = 0; i < m->rows; i++) {
            const double change = smooth[i] - m->column[6 * i + d];
            square += change * change;
            c->most = fmax(c->most, fabs(change));
            m->column[6 * i + d] = smooth[i];
        }
        c->rms = sqrt(square / (double)m->rows);
    }
    return true;
}

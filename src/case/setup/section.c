/* SPDX-License-Identifier: BSD-3-Clause */
/* Finite volumes on square cells cut by the outline. Unknowns are the potentials of cells and of
 * the pieces of the surface; the matrix K has the conductances of faces, M the lengths of the
 * pieces. K u = value M u is solved by inverse iteration with conjugate gradients. */
#include "section.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 96, ROUNDS = 60, SOLVE_MOST = 3000 };

static const double SOLVED = 1e-9, SETTLED = 1e-7; /* residuals; change of an eigenvalue */

typedef struct section {
    int32_t nx, ny; /* cells; the pieces of the surface are row ny */
    double h[2];
    int64_t n;
    /* [n] conductances to the next cell; from row ny - 1 north to the surface */
    double *east, *north;
    double *piece; /* [nx] lengths of the surface */
    double *sum;   /* [n] diagonal of K */
    double *work;  /* [4 n] */
} section;

static void free_section(section *s)
{
    free(s->east);
    free(s->north);
    free(s->piece);
    free(s->sum);
    free(s->work);
}

/* Fraction of a face between two points that is inside. */
static double open_share(const form *f, const double *a, const double *b)
{
    const double da = mps__form_inside(f, a), db = mps__form_inside(f, b);
    if (da <= 0 && db <= 0) return 0;
    if (da >= 0 && db >= 0) return 1;
    return fmax(da, db) / fabs(da - db);
}

static bool make_section(section *s, const form *f, double level)
{
    const double width = f->hi[0] - f->lo[0], depth = level - f->lo[1];
    s->nx = COLUMNS;
    s->ny = (int32_t)fmax(4, fmin(4 * COLUMNS, ceil(depth / width * COLUMNS)));
    s->h[0] = width / s->nx;
    s->h[1] = depth / s->ny;
    s->n = (int64_t)s->nx * (s->ny + 1);
    s->east = calloc((size_t)s->n, sizeof *s->east);
    s->north = calloc((size_t)s->n, sizeof *s->north);
    s->piece = calloc((size_t)s->nx, sizeof *s->piece);
    s->sum = calloc((size_t)s->n, sizeof *s->sum);
    s->work = calloc((size_t)s->n * 4, sizeof *s->work);
    if (!s->east || !s->north || !s->piece || !s->sum || !s->work) return false;
    for (int32_t j = 0; j < s->ny; j++)
        for (int32_t i = 0; i < s->nx; i++) {
            const int64_t k = (int64_t)j * s->nx + i;
            const double x = f->lo[0] + i * s->h[0], y = f->lo[1] + j * s->h[1];
            const double corner[2] = {x + s->h[0], y}, top[2] = {x, y + s->h[1]},
                         far[2] = {x + s->h[0], y + s->h[1]};
            const double up = open_share(f, top, far) * s->h[0] / s->h[1];
            if (i + 1 < s->nx) s->east[k] = open_share(f, corner, far) * s->h[1] / s->h[0];
            s->north[k] = j + 1 < s->ny ? up : 2 * up; /* the surface is half a cell away */
            if (j + 1 == s->ny) s->piece[i] = open_share(f, top, far) * s->h[0];
        }
    for (int64_t k = 0; k < s->n; k++) {
        s->sum[k] += s->east[k] + s->north[k];
        if (s->east[k] > 0) s->sum[k + 1] += s->east[k];
        if (s->north[k] > 0) s->sum[k + s->nx] += s->north[k];
    }
    return true;
}

/* Each matrix row sums the terms of preceding cells first: its rounding is then that of a sum by
 * faces. The loop of interior cells has no branch and no dependence between rows. */
static double multiply_row(const section *s, const double *x, int64_t k)
{
    double sum = s->sum[k] * x[k];
    if (k >= s->nx) sum -= s->north[k - s->nx] * x[k - s->nx];
    if (k >= 1) sum -= s->east[k - 1] * x[k - 1];
    if (k + 1 < s->n) sum -= s->east[k] * x[k + 1];
    if (k + s->nx < s->n) sum -= s->north[k] * x[k + s->nx];
    return sum;
}

static void multiply(const section *s, const double *restrict x, double *restrict out)
{
    const int64_t nx = s->nx, from = nx, to = s->n - nx;
    const double *restrict east = s->east, *restrict north = s->north, *restrict sum = s->sum;
    for (int64_t k = 0; k < from; k++) out[k] = multiply_row(s, x, k);
    for (int64_t k = from; k < to; k++)
        out[k] = sum[k] * x[k] - north[k - nx] * x[k - nx] - east[k - 1] * x[k - 1] -
                 east[k] * x[k + 1] - north[k] * x[k + nx];
    for (int64_t k = to; k < s->n; k++) out[k] = multiply_row(s, x, k);
}

static double dot(const section *s, const double *a, const double *b)
{
    double sum = 0;
    for (int64_t k = 0; k < s->n; k++) sum += a[k] * b[k];
    return sum;
}

/* Inner product with M of two fields: over the surface. */
static double dot_surface(const section *s, const double *a, const double *b)
{
    const int64_t top = (int64_t)s->nx * s->ny;
    double sum = 0;
    for (int32_t i = 0; i < s->nx; i++) sum += s->piece[i] * a[top + i] * b[top + i];
    return sum;
}

/* z = r/diagonal. The sums of r r and r z are independent. @return r r */
static double precondition(const section *s, const double *r, double *z, double *rz)
{
    double rr = 0, sum = 0;
    for (int64_t k = 0; k < s->n; k++) {
        z[k] = s->sum[k] > 0 ? r[k] / s->sum[k] : 0;
        rr += r[k] * r[k];
        sum += r[k] * z[k];
    }
    *rz = sum;
    return rr;
}

/* Solve K x = b with the initial guess x. @return false: not converged */
static bool solve(const section *s, const double *b, double *x)
{
    double *r = s->work, *p = r + s->n, *q = p + s->n, *z = q + s->n, rz = 0, now;
    const double most = SOLVED * SOLVED * dot(s, b, b);
    multiply(s, x, q);
    for (int64_t k = 0; k < s->n; k++) r[k] = b[k] - q[k];
    memset(p, 0, (size_t)s->n * sizeof *p);
    for (int32_t step = 0; step < SOLVE_MOST; step++) {
        if (precondition(s, r, z, &now) <= most) return true;
        const double beta = step ? now / rz : 0;
        for (int64_t k = 0; k < s->n; k++) p[k] = z[k] + beta * p[k];
        multiply(s, p, q);
        const double alpha = now / dot(s, p, q);
        for (int64_t k = 0; k < s->n; k++) {
            x[k] += alpha * p[k];
            r[k] -= alpha * q[k];
        }
        rz = now;
    }
    return false;
}

/* Orthogonalise to the constant and the previous modes, and normalise on the surface. */
static void purify(const section *s, double *u, const double *modes, int32_t count)
{
    double length = 0, sum = 0;
    const int64_t top = (int64_t)s->nx * s->ny;
    for (int32_t i = 0; i < s->nx; i++) {
        length += s->piece[i];
        sum += s->piece[i] * u[top + i];
    }
    for (int64_t k = 0; k < s->n; k++) u[k] -= s->sum[k] > 0 ? sum / length : u[k];
    for (int32_t m = 0; m < count; m++) {
        const double share = dot_surface(s, modes + m * s->n, u);
        for (int64_t k = 0; k < s->n; k++) u[k] -= share * modes[m * s->n + k];
    }
    const double scale = 1 / sqrt(dot_surface(s, u, u));
    for (int64_t k = 0; k < s->n; k++) u[k] *= scale;
}

/* Inverse iteration: u becomes K^-1 M u. */
static mps_status find_mode(const section *s, double *modes, int32_t m, double *value)
{
    const int64_t top = (int64_t)s->nx * s->ny;
    double *u = modes + m * s->n, *load = calloc((size_t)s->n * 2, sizeof *load), before = 0;
    if (!load) return MPS_E_NOMEM;
    double *x = load + s->n;
    bool good = true, settled = false;
    for (int32_t i = 0; i < s->nx; i++) /* mode of a rectangular tank, plus all others */
        u[top + i] = cos((m + 1) * acos(-1.0) * (i + 0.5) / s->nx) + 0.01 * ((i * 7919) % 13 - 6);
    purify(s, u, modes, m);
    for (int32_t round = 0; round < ROUNDS && good && !settled; round++) {
        for (int32_t i = 0; i < s->nx; i++) load[top + i] = s->piece[i] * u[top + i];
        for (int64_t k = 0; k < s->n; k++) x[k] = before > 0 ? u[k] / before : 0;
        good = solve(s, load, x);
        *value = 1 / dot_surface(s, x, u);
        memcpy(u, x, (size_t)s->n * sizeof *u);
        purify(s, u, modes, m);
        settled = fabs(*value - before) < SETTLED * *value;
        before = *value;
    }
    free(load);
    return good && settled && *value > 0 ? MPS_OK : MPS_E_STATE;
}

mps_status mps__section_modes(const form *f, double level, int32_t count, double *value)
{
    section s = {0};
    double *modes = NULL;
    mps_status status = make_section(&s, f, level) ? MPS_OK : MPS_E_NOMEM;
    if (status == MPS_OK) modes = calloc((size_t)s.n * (size_t)count, sizeof *modes);
    if (!modes) status = MPS_E_NOMEM;
    for (int32_t m = 0; status == MPS_OK && m < count; m++)
        status = find_mode(&s, modes, m, &value[m]);
    free(modes);
    free_section(&s);
    return status;
}

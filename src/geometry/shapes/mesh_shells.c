/* SPDX-License-Identifier: BSD-3-Clause */
/* Shells of a closed surface, i.e. parts without common points: whether one is within another, and
 * how often sample points are enclosed. */
#include "mesh.h"
#include "angles.h"
#include "union_find.h"
#include <math.h>
#include <string.h>

enum { SHELLS = 32, PLACES_LEAST = 64, PLACES_MOST = 256 };
/* largest number of solid angles summed for the sample points */
static const double angles_most = 1e5;

static const double *corner_at(const mps__mesh *m, int64_t e, int k)
{
    return m->x + 3 * (int64_t)m->corner[3 * e + k];
}

static double triple_product(double a[3][3])
{
    return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) +
           a[0][1] * (a[1][2] * a[2][0] - a[1][0] * a[2][2]) +
           a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
}

/* Solid angle of a triangle over 4 pi (van Oosterom and Strackee 1983). */
static double angle_of(const mps__mesh *m, int64_t e, const double x[3])
{
    double a[3][3], length[3] = {0};
    for (int k = 0; k < 3; k++) {
        const double *c = corner_at(m, e, k);
        for (int d = 0; d < 3; d++) a[k][d] = c[d] - x[d];
        length[k] = sqrt(mps__dot(a[k], a[k], 3));
    }
    const double volume = triple_product(a);
    const double below = length[0] * length[1] * length[2] + mps__dot(a[0], a[1], 3) * length[2] +
                         mps__dot(a[1], a[2], 3) * length[0] + mps__dot(a[2], a[0], 3) * length[1];
    return mps__atan2(volume, below) / (2 * MPS__PI);
}

/* Winding number of a point for one shell, or for all of them (-1). */
static double winding(const mps__mesh *m, const int32_t *shell, int32_t which, const double x[3])
{
    double sum = 0;
    for (int64_t e = 0; e < m->elements; e++)
        if (which < 0 || shell[m->corner[3 * e]] == which) sum += angle_of(m, e, x);
    return sum;
}

/* Sets of points that triangles connect. @param shell  [points] out: number of the shell of each
 * point @return how many shells */
static int64_t number_shells(const mps__mesh *m, mps__atomic_number *parent, int32_t *shell)
{
    int32_t count = 0;
    for (int64_t i = 0; i < m->points; i++) {
        mps__atomic_put(&parent[i], (int32_t)i);
        shell[i] = -1;
    }
    for (int64_t k = 0; k < 3 * m->elements; k++)
        mps__union_join(parent, m->corner[k], m->corner[k - k % 3]);
    for (int64_t k = 0; k < 3 * m->elements; k++) {
        int32_t *first = &shell[mps__union_find(parent, m->corner[k])];
        if (*first < 0) *first = count++;
    }
    for (int64_t i = 0; i < m->points; i++) shell[i] = shell[mps__union_find(parent, (int32_t)i)];
    return count;
}

/* Volumes of the first shells, and one point of each. */
static void measure(const mps__mesh *m, const int32_t *shell, double *volume, int32_t *point)
{
    for (int64_t e = 0; e < m->elements; e++) {
        const int32_t s = shell[m->corner[3 * e]];
        double a[3][3];
        if (s >= SHELLS) continue;
        point[s] = m->corner[3 * e];
        for (int k = 0; k < 3; k++)
            for (int d = 0; d < 3; d++) a[k][d] = corner_at(m, e, k)[d] - m->x[d];
        volume[s] += triple_product(a) / 6;
    }
}

/* The first shell that is within another. */
static void find_nested(const mps__mesh *m, const int32_t *shell, mps__mesh_shells *out)
{
    double volume[SHELLS] = {0};
    int32_t point[SHELLS] = {0};
    const int32_t count = out->count < SHELLS ? (int32_t)out->count : SHELLS;
    measure(m, shell, volume, point);
    for (int32_t inner = 0; inner < count && out->count <= SHELLS; inner++)
        for (int32_t outer = 0; outer < count; outer++) {
            if (inner == outer ||
                fabs(winding(m, shell, outer, m->x + 3 * (int64_t)point[inner])) < 0.5)
                continue;
            if (out->within++ > 0) break;
            out->inner = fabs(volume[inner]);
            out->outer = fabs(volume[outer]);
            break;
        }
}

/* Sample points of the box, by an additive recurrence, that are not enclosed 0 or 1 times. */
static void find_overlaps(const mps__mesh *m, double sign, mps__mesh_shells *out)
{
    static const double step[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
    double lo[3], hi[3];
    mps__mesh_box(m, lo, hi);
    out->places = (int64_t)fmin(PLACES_MOST,
                                fmax(PLACES_LEAST, angles_most / (double)(m->elements + 1)));
    for (int64_t n = 0; n < out->places; n++) {
        double x[3];
        for (int d = 0; d < 3; d++) {
            const double q = ((double)n + 0.5) * step[d];
            x[d] = lo[d] + (q - floor(q)) * (hi[d] - lo[d]);
        }
        const double times = round(sign * winding(m, NULL, -1, x));
        if (times == 0 || times == 1 || out->wrong++ > 0) continue;
        out->times = times;
        memcpy(out->wrong_at, x, sizeof x);
    }
}

mps_status mps__mesh_find_shells(const mps__mesh *m, mps__mesh_shells *out)
{
    *out = (mps__mesh_shells){0};
    mps__atomic_number *parent = mps__alloc(m->context, m->points, sizeof *parent);
    int32_t *shell = mps__alloc(m->context, m->points, sizeof *shell);
    if (parent && shell) {
        out->count = number_shells(m, parent, shell);
        find_nested(m, shell, out);
        find_overlaps(m, mps__mesh_volume(m) < 0 ? -1 : 1, out);
    }
    mps__free(m->context, parent);
    mps__free(m->context, shell);
    return parent && shell ? MPS_OK : MPS_E_NOMEM;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* A wall particle on an edge where a face turns away from the liquid represents the ends of two
 * faces with one pressure. If the flow separates there, one face is loaded and the other is not,
 * and linear interpolation would extend the pressure of the first by half a spacing or more onto
 * the second. So a sensor uses as the pressure of its face at the edge
 *
 *   median(p_e, mean, line)
 *
 * with p_e the pressure of the edge particle, `mean` that of the neighbouring particles of the face
 * alone, and `line` their linear least-squares fit extrapolated to the edge. Where the pressure is
 * linear around the edge, as in liquid at rest, that is p_e. It stays between p_e and the mean, so
 * that no pressure or suction is invented. A face too narrow for a line keeps p_e. */
#include "probe_edge.h"
#include <math.h>

/* In spacings: reach of the particles of the line, and of the mean. */
static const double far = 3, near = 1.6;

static double weight_at(double square, double reach)
{
    return fmax(0, 1 - square / (reach * reach));
}

/* First column of the inverse of a symmetric matrix {00, 01, 02, 11, 12, 22}, for one side of its
 * upper left block. False if it is singular. */
static bool first_of_inverse(const double *m, int32_t sides, double *column)
{
    const double minor[3] = {m[3] * m[5] - m[4] * m[4], m[2] * m[4] - m[1] * m[5],
                             m[1] * m[4] - m[2] * m[3]};
    const double det = sides == 1 ? m[0] * m[3] - m[1] * m[1]
                                  : m[0] * minor[0] + m[1] * minor[1] + m[2] * minor[2];
    const double size = sides == 1 ? m[0] * m[3] : m[0] * m[3] * m[5];
    if (!(det > 1e-3 * size)) return false;
    for (int k = 0; k < 3; k++) column[k] = minor[k] / det;
    if (sides == 2) return true;
    column[0] = m[3] / det;
    column[1] = -m[1] / det;
    column[2] = 0;
    return true;
}

/* Position of a face particle relative to the edge particle, in spacings, and its squared
 * length. */
static double from_edge(const mps__face *f, const mps__face_point *u, const mps__face_point *edge,
                        double q[2])
{
    double square = 0;
    q[0] = q[1] = 0;
    for (int32_t a = 0; a < f->sides; a++) {
        q[a] = (u->at[a] - edge->at[a]) / f->dp;
        square += q[a] * q[a];
    }
    return square;
}

static mps_status add_weight(mps__edges *e, mps__context *c, mps__edge_weight weight)
{
    MPS__TRY(mps__grow(c, (void **)&e->weight, &e->weight_capacity, e->weights, e->weights + 1,
                       sizeof weight));
    e->weight[e->weights++] = weight;
    return MPS_OK;
}

/* Weights of the particles around an edge; none if they do not define a line. */
static mps_status find_weights(mps__edges *e, mps__context *c, const mps__face *f, int64_t of)
{
    double m[6] = {0}, column[3], q[2], sum = 0;
    const mps__face_point *edge = &f->list[of];
    for (int64_t k = 0; k < f->count; k++) {
        const double square = from_edge(f, &f->list[k], edge, q),
                     w = f->list[k].inside ? weight_at(square, far) : 0;
        const double part[6] = {1, q[0], q[1], q[0] * q[0], q[0] * q[1], q[1] * q[1]};
        for (int a = 0; a < 6; a++) m[a] += w * part[a];
        sum += f->list[k].inside ? weight_at(square, near) : 0;
    }
    if (!(sum > 0) || !first_of_inverse(m, f->sides, column)) return MPS_OK;
    for (int64_t k = 0; k < f->count; k++) {
        const double square = from_edge(f, &f->list[k], edge, q), w = weight_at(square, far);
        if (!f->list[k].inside || w == 0) continue;
        MPS__TRY(add_weight(
            e, c,
            (mps__edge_weight){.of = k,
                               .mean = weight_at(square, near) / sum,
                               .line = w * (column[0] + column[1] * q[0] + column[2] * q[1])}));
    }
    return MPS_OK;
}

mps_status mps__edges_find(mps__edges *e, mps__context *c, const mps__face *f)
{
    *e = (mps__edges){0};
    for (int64_t k = 0; k < f->count; k++) {
        const int64_t first = e->weights;
        if (!f->list[k].edge || f->list[k].weight == 0) continue;
        MPS__TRY(find_weights(e, c, f, k));
        if (e->weights == first) continue;
        MPS__TRY(
            mps__grow(c, (void **)&e->list, &e->capacity, e->count, e->count + 1, sizeof *e->list));
        e->list[e->count++] = (mps__edge){k, first, e->weights - first};
    }
    return MPS_OK;
}

void mps__edges_free(mps__edges *e, mps__context *c)
{
    mps__free(c, e->list);
    mps__free(c, e->weight);
    *e = (mps__edges){0};
}

static double median(double a, double b, double c)
{
    return fmax(fmin(a, b), fmin(fmax(a, b), c));
}

void mps__edges_apply(const mps__edges *e, double *p)
{
    for (int64_t k = 0; k < e->count; k++) {
        const mps__edge *edge = &e->list[k];
        double mean = 0, line = 0;
        for (int64_t m = edge->first; m < edge->first + edge->count; m++) {
            mean += e->weight[m].mean * p[e->weight[m].of];
            line += e->weight[m].line * p[e->weight[m].of];
        }
        p[edge->of] = median(p[edge->of], mean, line);
    }
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Helpers of the models of boundaries. */
#include "helpers.h"

bool mps__upward(const mps_view *v, double up[3])
{
    double size = 0;
    for (int d = 0; d < v->dim; d++) size += v->g[d] * v->g[d];
    if (size == 0) return false;
    for (int d = 0; d < v->dim; d++) up[d] = -v->g[d] / sqrt(size);
    return true;
}

double mps__height(const mps_view *v, const double up[3], int64_t i)
{
    double height = 0;
    for (int d = 0; d < v->dim; d++) height += up[d] * v->x[i * v->dim + d];
    return height;
}

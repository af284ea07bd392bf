/* SPDX-License-Identifier: BSD-3-Clause */
/* Helpers that several models of boundaries share. */
#include "helpers.h"

bool mps__upward(const mps_stage *s, double up[3])
{
    double size = 0;
    for (int d = 0; d < s->dim; d++) size += s->g[d] * s->g[d];
    for (int d = 0; d < s->dim; d++) up[d] = -s->g[d] / sqrt(size);
    return size > 0;
}

double mps__height(const mps_stage *s, const double up[3], int64_t i)
{
    double height = 0;
    for (int d = 0; d < s->dim; d++) height += up[d] * s->x[i * s->dim + d];
    return height;
}

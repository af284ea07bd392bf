/* SPDX-License-Identifier: BSD-3-Clause */
/* Sharp edges of a surface of triangles. */
#include "mesh.h"
#include "angles.h"
#include <math.h>
#include <string.h>

/* The unit normals of two faces have a sum of length 2 cos(half of the angle between them); at an
 * open edge a single one has length 1. */
static bool is_sharp(const double sum[3], double angle)
{
    const double most = 2 * mps__cos(0.5 * angle);
    return sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2] < most * most;
}

int64_t mps__mesh_edges(const mps__mesh *m, double angle, int64_t capacity, double *ends)
{
    int64_t count = 0;
    for (int64_t k = 0; k < 3 * m->elements; k++) {
        const int32_t a = m->corner[k], b = m->corner[k % 3 == 2 ? k - 2 : k + 1];
        /* each edge once: the triangle on its other side has it from b to a */
        if (a > b || !is_sharp(m->edge_normal + 3 * k, angle)) continue;
        if (count < capacity) {
            memcpy(ends + 6 * count, m->x + 3 * (int64_t)a, 3 * sizeof *ends);
            memcpy(ends + 6 * count + 3, m->x + 3 * (int64_t)b, 3 * sizeof *ends);
        }
        count++;
    }
    return count;
}

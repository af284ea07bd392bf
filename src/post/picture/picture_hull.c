/* SPDX-License-Identifier: BSD-3-Clause */
#include "picture_hull.h"
#include <math.h>
#include <stdlib.h>

static const double width = 2; /* of a column [dp]: walls leave no gap in it */

/* Index of a point in the columns along `axis`. */
static size_t column(const hull *h, int axis, const float x[3])
{
    size_t at = 0;
    for (int d = 0; d < 3; d++) {
        if (d == axis) continue;
        double k = floor(((double)x[d] - h->s->lo[d]) / (width * h->s->dp));
        k = k > 0 ? fmin(k, (double)(h->cells[d] - 1)) : 0;
        at = at * (size_t)h->cells[d] + (size_t)k;
    }
    return at;
}

static void take(hull *h, const float x[3])
{
    for (int d = 0; d < 3; d++) {
        const size_t at = column(h, d, x);
        h->least[d][at] = fminf(h->least[d][at], x[d]);
        h->most[d][at] = fmaxf(h->most[d][at], x[d]);
    }
}

bool mps__hull_create(hull *h, const scene *s)
{
    enum { CELLS_MOST = 4096 };
    *h = (hull){.s = s};
    for (int d = 0; d < 3; d++)
        h->cells[d] = (int64_t)fmin(1 + floor((s->hi[d] - s->lo[d]) / (width * s->dp)), CELLS_MOST);
    for (int d = 0; d < 3; d++) {
        const size_t count = (size_t)(h->cells[(d + 1) % 3] * h->cells[(d + 2) % 3]);
        h->least[d] = malloc(2 * count * sizeof(float));
        if (!h->least[d]) return false;
        h->most[d] = h->least[d] + count;
        for (size_t k = 0; k < count; k++) {
            h->least[d][k] = INFINITY;
            h->most[d][k] = -INFINITY;
        }
    }
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == SCENE_WALL) take(h, s->x + 3 * i);
    return true;
}

void mps__hull_free(hull *h)
{
    for (int d = 0; d < 3; d++) free(h->least[d]);
    *h = (hull){0};
}

void mps__hull_outwards(const hull *h, const float x[3], double out[3])
{
    /* a surface steep in all three directions rises by 1.4 widths over a column */
    const double near = 1.5 * width * h->s->dp;
    for (int d = 0; d < 3; d++) {
        const size_t at = column(h, d, x);
        out[d] = ((double)x[d] > (double)h->most[d][at] - near) -
                 ((double)x[d] < (double)h->least[d][at] + near);
    }
}

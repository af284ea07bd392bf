/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory of the void raster, and union-find of provisional components. */
#include "voids.h"
#include <math.h>

void mps__voids_init(mps__voids *v, mps__context *context)
{
    *v = (mps__voids){.context = context};
}

void mps__voids_free(mps__voids *v)
{
    void *const blocks[] = {v->mask,  v->space,  v->ullage, v->offset, v->place, v->slab, v->next,
                            v->head,  v->marks,  v->run,    v->taken,  v->sure,  v->wide, v->what,
                            v->label, v->parent, v->found,  v->number, v->queue, v->size};
    for (size_t k = 0; k < sizeof blocks / sizeof blocks[0]; k++) mps__free(v->context, blocks[k]);
    for (int k = 0; k < MPS__VOID_FACE; k++) mps__free(v->context, v->face[k]);
    mps__voids_init(v, v->context);
}

int32_t mps__voids_root(int32_t *parent, int32_t k)
{
    while (parent[k] != k) {
        parent[k] = parent[parent[k]];
        k = parent[k];
    }
    return k;
}

bool mps__voids_join(int32_t *parent, int32_t a, int32_t b)
{
    a = mps__voids_root(parent, a);
    b = mps__voids_root(parent, b);
    parent[a < b ? b : a] = a < b ? a : b;
    return a != b;
}

mps_status mps__voids_push(mps__voids *v, int32_t **list, int64_t *capacity, int64_t used)
{
    if (used < *capacity) return MPS_OK;
    return mps__grow(v->context, (void **)list, capacity, used, 2 * used + 64, sizeof **list);
}

/* ---- cells within cover and channel ---- */

/* Square of the least, or largest, distance of the points of a cell from the centre of another one
 * [side^2]. */
static double square_of(const int32_t at[3], int32_t dim, bool largest)
{
    double square = 0;
    for (int32_t d = 0; d < dim; d++) {
        const double off = fabs((double)at[d]), r = largest ? off + 0.5 : fmax(off - 0.5, 0);
        square += r * r;
    }
    return square;
}

/* Insert an offset in ascending order of distance, behind equal ones. */
static void insert_offset(mps__voids *v, const mps__void_offset *o)
{
    int32_t k = v->offsets++;
    for (; k > 0 && v->offset[k - 1].least > o->least; k--) v->offset[k] = v->offset[k - 1];
    v->offset[k] = *o;
}

mps_status mps__voids_offsets(mps__voids *v)
{
    static const int32_t own[3] = {0, 0, 0}, beside[3] = {1, 0, 0};
    const double reach = v->config.channel / v->config.side,
                 cover = v->config.cover / v->config.side;
    v->reach2 = reach * reach;
    v->cover2 = cover * cover;
    v->window = (int32_t)ceil(reach - 0.5);
    v->octant_sure = v->dim < v->reach2;
    v->beside_sure = square_of(beside, v->dim, true) < v->reach2;
    v->own_covers = square_of(own, v->dim, true) < v->cover2;
    const int32_t w = v->window, z = v->dim == 3 ? w : 0;
    const int64_t most = (int64_t)(2 * w + 1) * (2 * w + 1) * (2 * z + 1);
    MPS__TRY(mps__grow(v->context, (void **)&v->offset, &v->capacity.offset, 0, most,
                       sizeof *v->offset));
    v->offsets = 0;
    for (int32_t c = -z; c <= z; c++)
        for (int32_t b = -w; b <= w; b++)
            for (int32_t a = -w; a <= w; a++) {
                mps__void_offset o = {.at = {a, b, c}, .cell = a + b * v->step[1] + c * v->step[2]};
                o.least = square_of(o.at, v->dim, false);
                if (o.least < v->reach2) insert_offset(v, &o);
            }
    return MPS_OK;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory of the raster of voids, and sets of provisional components. */
#include "voids.h"

void mps__voids_init(mps__voids *v, mps__context *context)
{
    *v = (mps__voids){.context = context};
}

void mps__voids_free(mps__voids *v)
{
    void *const blocks[] = {v->mask,   v->ullage,  v->slab,  v->square, v->what,   v->label,
                            v->parent, v->nearest, v->found, v->queue,  v->number, v->size};
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

mps_status mps__voids_push(mps__voids *v, int32_t **list, int64_t *room, int64_t used)
{
    if (used < *room) return MPS_OK;
    return mps__grow(v->context, (void **)list, room, used, 2 * used + 64, sizeof **list);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Lists are made and freed; a list that stands alone, with memory and threads of its own. */
#include "neighbours.h"
#include <math.h>

/* Skin [dp]: a search is good until some particle moved half of it. At the default CFL of 0.3 that is every other step at least. */
static const double skin_of_dp = 0.62;

mps_status mps__neighbours_init(mps_neighbours *l, mps__context *context, int32_t dim, double dp)
{
    *l = (mps_neighbours){.context = context, .dim = dim, .dp = dp, .skin = skin_of_dp * dp, .shared = &l->own_scratch};
    return MPS_OK;
}

void mps__neighbours_free(mps_neighbours *l)
{
    void *all[] = {l->near_begin, l->near_col, l->begin,    l->middle, l->far_end, l->count,
                   l->col,        l->w_r2,     l->searched, l->idle,   l->rim,     l->scratch};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) mps__free(l->context, all[k]);
    mps__scratch_free(l->context, &l->own_scratch);
    if (l->parallel == &l->pool.parallel) mps__pool_free(&l->pool);
    mps__neighbours_init(l, l->context, l->dim, l->dp);
}

/* ---- a list that stands alone ---------------------------------------------------------------------------------- */

mps_status mps_neighbours_create(int32_t dim, double dp, const mps_allocator *allocator, mps_neighbours **list)
{
    if (!list) return MPS_E_ARG;
    *list = NULL;
    if ((dim != 2 && dim != 3) || !(dp > 0) || !isfinite(dp)) return MPS_E_ARG;
    if (allocator && (!allocator->alloc || !allocator->release)) return MPS_E_ARG;
    mps__context c = {.allocator = allocator ? *allocator : mps__allocator_default()};
    mps_neighbours *l = mps__alloc(&c, 1, sizeof *l);
    if (!l) return MPS_E_NOMEM;
    mps__neighbours_init(l, NULL, dim, dp);
    l->own = c;
    l->context = &l->own;
    mps__pool_init(&l->pool, l->context);
    l->parallel = &l->pool.parallel;
    *list = l;
    return MPS_OK;
}

void mps_neighbours_destroy(mps_neighbours *list)
{
    if (!list) return;
    mps__context c = list->own;
    mps__neighbours_free(list);
    mps__free(&c, list);
}

mps_status mps_neighbours_set_parallel(mps_neighbours *list, const mps_parallel *parallel)
{
    mps_parallel p = {0};
    if (!list) return MPS_E_ARG;
    MPS__TRY(mps__struct_in(list->context, "mps_parallel", &p, sizeof p, parallel));
    p.struct_size = sizeof p;
    MPS__TRY(mps__pool_set(&list->pool, &p, "parallel"));
    mps__pool_resize(&list->pool, p.threads > 1 ? p.threads : 1);
    return MPS_OK;
}

mps_status mps_neighbours_build(mps_neighbours *list, int64_t n, const double *x, double re_near, double re_far)
{
    if (!list) return MPS_E_ARG;
    list->valid = false;
    list->n = 0;
    if (!x || n < 1 || n > INT32_MAX || !(re_near > 0) || !(re_far >= re_near) || !isfinite(re_far)) return MPS_E_ARG;
    if (!mps__finite(x, n * list->dim)) return MPS_E_ARG;
    list->skin = 0; /* every build searches anew */
    const mps_status status = mps__neighbours_search(list, n, x, re_near, re_far);
    if (status < 0) list->n = 0;
    return status;
}

mps_status mps_neighbours_stencil(const mps_neighbours *list, int32_t which, const mps_kernel *kernel, mps_stencil *stencil)
{
    if (!list || !kernel || !stencil || list->n == 0 || (which != MPS_NEAR && which != MPS_FAR)) return MPS_E_ARG;
    double re = which == MPS_NEAR ? list->re_near : list->re_far, n0, lambda;
    MPS__TRY(mps_lattice_constants(kernel, list->dim, list->dp, re, &n0, &lambda));
    *stencil = (mps_stencil){.struct_size = sizeof *stencil,
                             .dim = list->dim,
                             .n = list->n,
                             .dp = list->dp,
                             .re = re,
                             .n0 = n0,
                             .lambda = lambda,
                             .kernel = *kernel,
                             .parallel = list->parallel,
                             .x = list->x,
                             .begin = list->begin,
                             .end = which == MPS_NEAR ? list->middle : list->end,
                             .col = list->col};
    return MPS_OK;
}

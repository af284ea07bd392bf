/* SPDX-License-Identifier: BSD-3-Clause */
/* Creation and destruction of lists; standalone lists, with memory and threads of their own. */
#include "kernel.h"
#include "neighbours.h"
#include <math.h>

/* Skin [dp]: a search is valid until a particle has moved by half of it. At the default CFL of 0.3
 * that is at least two steps. */
static const double skin_of_dp = 0.62;

mps_status mps__neighbours_init(mps_neighbours *l, mps__context *context, int32_t dim, double dp)
{
    *l = (mps_neighbours){.context = context,
                          .dim = dim,
                          .dp = dp,
                          .skin = skin_of_dp * dp,
                          .shared = &l->own_scratch};
    return MPS_OK;
}

void mps__neighbours_release(mps_neighbours *l)
{
    void **const all[] = {(void **)&l->near_begin, (void **)&l->near_col,     (void **)&l->begin,
                          (void **)&l->middle,     (void **)&l->far_end,      (void **)&l->count,
                          (void **)&l->col,        (void **)&l->w_r2,         (void **)&l->searched,
                          (void **)&l->idle,       (void **)&l->near_dummies, (void **)&l->scratch};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) {
        mps__free(l->context, *all[k]);
        *all[k] = NULL;
    }
    l->capacity = l->pair_capacity = l->near_capacity = l->weight_capacity = 0;
    l->scratch_capacity = l->far_capacity = 0;
    l->valid = false;
}

void mps__neighbours_free(mps_neighbours *l)
{
    mps__neighbours_release(l);
    mps__scratch_free(l->context, &l->own_scratch);
    if (l->parallel == &l->pool.parallel) mps__pool_free(&l->pool);
    mps__neighbours_init(l, l->context, l->dim, l->dp);
}

/* ---- standalone lists ---- */

mps_status mps_neighbours_create(int32_t dim, double dp, const mps_allocator *allocator,
                                 mps_neighbours **list)
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

const char *mps_neighbours_error(const mps_neighbours *list)
{
    return list ? list->context->error : "the list is NULL";
}

mps_status mps_neighbours_parallel_set(mps_neighbours *list, const mps_parallel *parallel)
{
    mps_parallel p = {0};
    if (!list) return MPS_E_ARG;
    MPS__TRY(mps__struct_in(list->context, "mps_parallel", &p, sizeof p, parallel));
    p.struct_size = sizeof p;
    MPS__TRY(mps__pool_set(&list->pool, &p, "parallel"));
    mps__pool_resize(&list->pool, p.threads > 1 ? p.threads : 1);
    return MPS_OK;
}

static mps_status check_cloud(const mps_neighbours *l, int64_t n, const double *x, double re_near,
                              double re_far)
{
    mps__context *c = l->context;
    MPS__CHECK(c, x, "x is NULL: must be an array of positions");
    MPS__CHECK(c, n >= 1 && n <= INT32_MAX, "n is %lld: must be 1..%d", (long long)n, INT32_MAX);
    MPS__CHECK(c, re_near > 0, "re_near is %g m: must be > 0", re_near);
    MPS__CHECK(c, re_far >= re_near && isfinite(re_far),
               "re_far is %g m: must be finite and at least re_near = %g m", re_far, re_near);
    if (mps__finite(x, n * l->dim)) return MPS_OK;
    int64_t k = 0;
    while (isfinite(x[k])) k++;
    return mps__fail(c, MPS_E_ARG, "x of particle %lld, axis %lld is %g: must be finite",
                     (long long)(k / l->dim), (long long)(k % l->dim), x[k]);
}

mps_status mps_neighbours_build(mps_neighbours *list, int64_t n, const double *x, double re_near,
                                double re_far)
{
    if (!list) return MPS_E_ARG;
    list->valid = false;
    list->n = 0;
    MPS__TRY(check_cloud(list, n, x, re_near, re_far));
    list->skin = 0; /* every build searches anew */
    const mps_status status = mps__neighbours_search(list, n, x, re_near, re_far);
    if (status < 0) list->n = 0;
    return status;
}

/* ---- stencils ---- */

static const mps_stencil no_stencil = {.struct_size = sizeof no_stencil};

mps_status mps_stencil_init(mps_stencil *stencil, size_t size)
{
    return mps__struct_init("mps_stencil", stencil, size, &no_stencil, sizeof no_stencil);
}

mps_status mps__neighbours_view(const mps_neighbours *l, int32_t which, const mps_kernel *kernel,
                                mps_stencil *view)
{
    mps_kernel k = {0};
    double re = which == MPS_NEAR ? l->re_near : l->re_far, n0, lambda;
    MPS__TRY(mps__struct_in(l->context, "mps_kernel", &k, sizeof k, kernel));
    MPS__TRY(mps__kernel_lattice(l->context, kernel, l->dim, l->dp, re, &n0, &lambda));
    k.struct_size = sizeof k;
    *view = (mps_stencil){.struct_size = sizeof *view,
                          .dim = l->dim,
                          .host = l->context,
                          .n = l->n,
                          .dp = l->dp,
                          .re = re,
                          .n0 = n0,
                          .lambda = lambda,
                          .kernel = k,
                          .parallel = l->parallel,
                          .x = l->x,
                          .begin = l->begin,
                          .end = which == MPS_NEAR ? l->middle : l->end,
                          .col = l->col};
    return MPS_OK;
}

mps_status mps_neighbours_stencil_get(const mps_neighbours *list, int32_t which,
                                      const mps_kernel *kernel, mps_stencil *stencil)
{
    mps_stencil view;
    if (!list) return MPS_E_ARG;
    MPS__TRY(mps__struct_check(list->context, "mps_stencil", stencil));
    MPS__CHECK(list->context, which == MPS_NEAR || which == MPS_FAR,
               "which is %d: must be MPS_NEAR (0) or MPS_FAR (1)", which);
    MPS__CHECK(list->context, list->n > 0, "the list is empty: call mps_neighbours_build() first");
    MPS__TRY(mps__neighbours_view(list, which, kernel, &view));
    return mps__struct_out(list->context, "mps_stencil", stencil, &view, sizeof view);
}

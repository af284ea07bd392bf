/* SPDX-License-Identifier: BSD-3-Clause */
/* Weight functions by name or callback, and their constants on a full lattice. */
#include "kernel.h"
#include <math.h>
#include <string.h>

static const mps_kernel nothing = {.struct_size = sizeof nothing};

mps_status mps_kernel_init(mps_kernel *kernel, size_t size)
{
    return mps__struct_init("mps_kernel", kernel, size, &nothing, sizeof nothing);
}

mps_status mps_kernel_find(const char *name, mps_kernel *kernel)
{
    if (!name) return MPS_E_ARG;
    MPS__TRY(mps__struct_check(NULL, "mps_kernel", kernel));
    const int32_t id = strcmp(name, "improved") == 0   ? MPS_KERNEL_IMPROVED
                       : strcmp(name, "original") == 0 ? MPS_KERNEL_ORIGINAL
                                                       : 0;
    if (!id) return MPS_E_NAME;
    return mps__struct_out(NULL, "mps_kernel", kernel, &(mps_kernel){.id = id}, sizeof *kernel);
}

mps_status mps_kernel_custom(mps_kernel_fn fn, void *user, mps_kernel *kernel)
{
    if (!fn) return MPS_E_ARG;
    const mps_kernel own = {.id = MPS_KERNEL_CUSTOM, .fn = fn, .user = user};
    return mps__struct_out(NULL, "mps_kernel", kernel, &own, sizeof own);
}

static mps_status check(mps__context *c, const mps_kernel *kernel)
{
    MPS__TRY(mps__struct_check(c, "mps_kernel", kernel));
    MPS__CHECK(c, kernel->id >= MPS_KERNEL_IMPROVED && kernel->id <= MPS_KERNEL_CUSTOM,
               "kernel.id is %d: fill it with mps_kernel_find() or mps_kernel_custom()",
               kernel->id);
    MPS__CHECK(c, kernel->id != MPS_KERNEL_CUSTOM || kernel->fn,
               "kernel.fn is NULL: fill it with mps_kernel_custom()");
    return MPS_OK;
}

double mps_kernel_value(const mps_kernel *kernel, double r, double re)
{
    if (!kernel || kernel->struct_size < sizeof *kernel || !(r >= 0) || !(r < re)) return 0.0;
    if (kernel->id < MPS_KERNEL_IMPROVED || kernel->id > MPS_KERNEL_CUSTOM) return 0.0;
    if (kernel->id == MPS_KERNEL_CUSTOM && !kernel->fn) return 0.0;
    return mps_kernel_weight(kernel, r, re);
}

mps_status mps__kernel_lattice(mps__context *c, const mps_kernel *kernel, int32_t dim, double dp,
                               double re, double *n0, double *lambda)
{
    MPS__TRY(check(c, kernel));
    MPS__CHECK(c, dim == 2 || dim == 3, "dim is %d: must be 2 or 3", dim);
    MPS__CHECK(c, dp > 0 && re > dp && re < 100 * dp,
               "the kernel has no lattice constants for the radius %g m: must be above dp = %g m, "
               "and below 100 dp",
               re, dp);
    const int reach = (int)(re / dp) + 1, depth = dim == 3 ? reach : 0;
    double n = 0, moment = 0, nearest = INFINITY;
    for (int k = -depth; k <= depth; k++)
        for (int j = -reach; j <= reach; j++)
            for (int i = -reach; i <= reach; i++) {
                const double r = dp * sqrt((double)(i * i + j * j + k * k));
                if (r == 0.0 || r >= re) continue;
                const double w = mps_kernel_weight(kernel, r, re);
                if (!(w >= 0 && isfinite(w))) nearest = fmin(nearest, r);
                n += w;
                moment += w * r * r;
            }
    MPS__CHECK(c, nearest == INFINITY,
               "the kernel is %g at r = %g m of re = %g m: must be >= 0 and finite",
               mps_kernel_weight(kernel, nearest, re), nearest, re);
    MPS__CHECK(c, n > 0, "the kernel is 0 at all distances of a lattice of %g m within re = %g m",
               dp, re);
    if (n0) *n0 = n;
    if (lambda) *lambda = moment / n;
    return MPS_OK;
}

mps_status mps_lattice_constants(const mps_kernel *kernel, int32_t dim, double dp, double re,
                                 double *n0, double *lambda)
{
    return mps__kernel_lattice(NULL, kernel, dim, dp, re, n0, lambda);
}

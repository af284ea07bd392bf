/* SPDX-License-Identifier: BSD-3-Clause */
/* Weight functions by name or callback, and their constants on a full lattice. */
#include <math.h>
#include <mps/operators.h>
#include <stdbool.h>
#include <string.h>

mps_status mps_kernel_find(const char *name, mps_kernel *kernel)
{
    if (!name || !kernel) return MPS_E_ARG;
    int32_t id = strcmp(name, "improved") == 0 ? MPS_KERNEL_IMPROVED : strcmp(name, "original") == 0 ? MPS_KERNEL_ORIGINAL : 0;
    if (!id) return MPS_E_NAME;
    *kernel = (mps_kernel){.id = id};
    return MPS_OK;
}

mps_status mps_kernel_custom(mps_kernel_fn fn, void *user, mps_kernel *kernel)
{
    if (!fn || !kernel) return MPS_E_ARG;
    *kernel = (mps_kernel){.id = MPS_KERNEL_CUSTOM, .fn = fn, .user = user};
    return MPS_OK;
}

static bool usable(const mps_kernel *kernel)
{
    return kernel && kernel->id >= MPS_KERNEL_IMPROVED && kernel->id <= MPS_KERNEL_CUSTOM &&
           (kernel->id != MPS_KERNEL_CUSTOM || kernel->fn);
}

double mps_kernel_value(const mps_kernel *kernel, double r, double re)
{
    if (!usable(kernel) || !(r >= 0) || !(r < re)) return 0.0;
    return mps_kernel_weight(kernel, r, re);
}

mps_status mps_lattice_constants(const mps_kernel *kernel, int32_t dim, double dp, double re, double *n0, double *lambda)
{
    if (!usable(kernel)) return MPS_E_ARG;
    if ((dim != 2 && dim != 3) || !(dp > 0) || !(re > dp) || !(re < 100 * dp)) return MPS_E_ARG;
    const int reach = (int)(re / dp) + 1, depth = dim == 3 ? reach : 0;
    double n = 0, moment = 0;
    for (int k = -depth; k <= depth; k++)
        for (int j = -reach; j <= reach; j++)
            for (int i = -reach; i <= reach; i++) {
                const double r = dp * sqrt((double)(i * i + j * j + k * k));
                if (r == 0.0 || r >= re) continue;
                const double w = mps_kernel_weight(kernel, r, re);
                if (!(w >= 0) || !isfinite(w)) return MPS_E_ARG;
                n += w;
                moment += w * r * r;
            }
    if (!(n > 0)) return MPS_E_ARG;
    if (n0) *n0 = n;
    if (lambda) *lambda = moment / n;
    return MPS_OK;
}

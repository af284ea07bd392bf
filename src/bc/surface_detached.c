/* SPDX-License-Identifier: BSD-3-Clause */
/* Several phases fill the tank: there is no free surface. What has too little of its own kind about it is spray, a drop that flies through
 * the gas without feeling its pressure: sum W min(1, rho_j/rho_i) over the fluid < spray n0. In the pressure equation a lone drop before a
 * wall gets a pressure above the wall's, which draws it into the wall. The lightest phase is never spray. */
#include "builtin.h"

enum { SPRAY };
static const mps_setting settings[] = {{"spray", 0.25, 0.0, 1.0}};

MPS__ROW double company(const int dim, const mps_stage *s, int64_t i, double enough)
{
    const mps_stencil *t = s->near;
    double sum = 0;
    for (int64_t p = t->begin[i]; p < t->end[i] && sum < enough; p++) {
        const int64_t j = t->col[p];
        if (s->kind[j] == MPS_FLUID) sum += mps_stencil_pair_dim(dim, t, i, p).w * fmin(1.0, s->density[j] / s->density[i]);
    }
    return sum;
}

static int classify(void *self, const double *k, mps_stage *s)
{
    (void)self;
    const double enough = k[SPRAY] * s->near->n0;
    double lightest = INFINITY;
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_FLUID) lightest = fmin(lightest, s->density[i]);
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_FLUID && s->density[i] > lightest && MPS__ROW_CALL(s, company, s, i, enough) < enough)
            s->region[i] = MPS_REGION_SPRAY;
    return 0;
}

const mps_model_ops mps__surface_detached = {.struct_size = sizeof(mps_model_ops),
                                             .api = MPS_MODEL_API,
                                             .name = "surface.detached",
                                             .order = 100,
                                             .setting_count = 1,
                                             .settings = settings,
                                             .classify = classify};

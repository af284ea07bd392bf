/* SPDX-License-Identifier: BSD-3-Clause */
/* Mixed source, W22 (10): (1 - gamma) (div u*) / dt - gamma (n - n0)/(n0 dt^2), to the letter. */
#include "builtin.h"

enum { GAMMA };
static const mps_setting settings[] = {{"gamma", 0.01, 0.0, 1.0}};

static int source(void *self, const double *k, mps_stage *s, mps_ppe_terms *terms)
{
    (void)self;
    double *div = mps_stage_scratch(s, s->n);
    if (!div || mps_op_divergence(s->near, s->u, div) != MPS_OK) return 1;
    const double n0 = s->near->n0, rate = 1.0 / s->dt;
    /* rows are -<lap p>/rho: signs are turned */
    for (int64_t i = 0; i < s->n; i++)
        terms->rhs[i] += -(1.0 - k[GAMMA]) * rate * div[i] + k[GAMMA] * rate * rate * (s->number_density[i] - n0) / n0;
    terms->wall_factor = 1;
    return 0;
}

const mps_model_ops mps__source_mixed = {.struct_size = sizeof(mps_model_ops),
                                         .api = MPS_MODEL_API,
                                         .name = "source.mixed",
                                         .order = 500,
                                         .setting_count = 1,
                                         .settings = settings,
                                         .source = source};

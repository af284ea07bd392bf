/* SPDX-License-Identifier: BSD-3-Clause */
/* Free surface by number density alone, Z14 (15): n < beta n0, fluid and wall particles alike: dry walls have p = 0. */
#include "builtin.h"

enum { BETA };
static const mps_setting settings[] = {{"beta", 0.97, 0.5, 1.0}};

static int classify(void *self, const double *k, mps_stage *s)
{
    (void)self;
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] != MPS_DUMMY && s->number_density[i] < k[BETA] * s->near->n0) s->region[i] = MPS_REGION_SURFACE;
    return 0;
}

const mps_model_ops mps__surface_original = {.struct_size = sizeof(mps_model_ops),
                                             .api = MPS_MODEL_API,
                                             .name = "surface.original",
                                             .order = 100,
                                             .setting_count = 1,
                                             .settings = settings,
                                             .classify = classify};

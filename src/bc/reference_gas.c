/* SPDX-License-Identifier: BSD-3-Clause */
/* Level of the pressures in a closed tank, as W22 has it: p = 0 in the uppermost layer of the gas, `layer` dp thick, against gravity. These
 * particles are Dirichlet rows: the divergence there is nobody's, and gas may leave through them in the long run. */
#include "builtin.h"

enum { PHASE, LAYER };
static const mps_setting settings[] = {{"phase", 1.0, 0.0, 15.0}, {"layer", 0.75, 0.1, 100.0}};

static int source(void *self, const double *k, mps_stage *s, mps_ppe_terms *terms)
{
    (void)self;
    double top = -INFINITY, up[3];
    if (!mps__upward(s, up)) return mps_stage_fail(s, "without gravity there is no uppermost layer: remove the model \"reference\"");
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_FLUID && s->phase[i] == (int32_t)k[PHASE]) top = fmax(top, mps__height(s, up, i));
    if (isinf(top))
        return mps_stage_fail(
            s, "phase %d has no fluid particle: add the gas, set reference.phase to it, or remove the model \"reference\"", (int)k[PHASE]);
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_FLUID || s->phase[i] != (int32_t)k[PHASE] || mps__height(s, up, i) < top - k[LAYER] * s->dp) continue;
        terms->fixed[i] = MPS_ROW_FIXED;
        terms->value[i] = 0;
    }
    return 0;
}

const mps_model_ops mps__reference_gas = {.struct_size = sizeof(mps_model_ops),
                                          .api = MPS_MODEL_API,
                                          .name = "reference.gas",
                                          .order = 450,
                                          .setting_count = 2,
                                          .settings = settings,
                                          .source = source};

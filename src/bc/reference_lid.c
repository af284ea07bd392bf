/* SPDX-License-Identifier: BSD-3-Clause */
/* Level of the pressures in a tank that is full to its lid: after the solution the mean pressure of the highest wetted wall particles is
 * taken off all others. A gauge and no more: differences of pressure, and so the flow, do not change, and nothing leaks as through a
 * fixed pressure. It does nothing where something fixed the level: a surface, a Dirichlet row, a compressible phase.
 * Weights fall with the depth below the highest place as exp(-depth/(layer dp)): in a rolling tank the level passes smoothly from one
 * corner to the other. It runs before pressures are extrapolated to dummies. */
#include "builtin.h"

enum { LAYER };
static const mps_setting settings[] = {{"layer", 0.5, 0.05, 100.0}};

/* Wall particles in the equation. */
static inline bool wetted(const mps_stage *s, int64_t i)
{
    return s->kind[i] == MPS_WALL && s->region[i] < MPS_REGION_SURFACE;
}

static int gradient(void *self, const double *k, mps_stage *s, double *a)
{
    (void)self, (void)a;
    double top = -INFINITY, sum = 0, weight = 0, up[3];
    if (!s->level_free) return 0;
    if (!mps__upward(s, up)) return mps_stage_fail(s, "without gravity there is no highest wall: remove the model \"reference\"");
    for (int64_t i = 0; i < s->n; i++)
        if (wetted(s, i)) top = fmax(top, mps__height(s, up, i));
    for (int64_t i = 0; i < s->n; i++) {
        if (!wetted(s, i)) continue;
        const double w = s->wet[i] * exp((mps__height(s, up, i) - top) / (k[LAYER] * s->dp));
        sum += w * s->p[i];
        weight += w;
    }
    for (int64_t i = 0; i < s->n && weight > 0; i++)
        if (s->region[i] < MPS_REGION_SPRAY) s->p[i] -= sum / weight;
    return 0;
}

const mps_model_ops mps__reference_lid = {.struct_size = sizeof(mps_model_ops),
                                          .api = MPS_MODEL_API,
                                          .name = "reference.lid",
                                          .order = 150,
                                          .setting_count = 1,
                                          .settings = settings,
                                          .gradient = gradient};

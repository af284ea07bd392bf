/* SPDX-License-Identifier: BSD-3-Clause */
/* Surface tension as a jump of the pressure: across an interface p_i - p_j = (sigma kappa_i - sigma kappa_j)/2, kappa as in tension.c, each
 * positive where the interface bends around its own phase. The jump stands in the pairs of the pressure equation and of its gradient
 * (mps_stage.capillary), so that a drop at rest is at rest to the noise of kappa: a force such as tension.csf is balanced by gradients of
 * other pairs only, and drives currents. That allows a smaller rs, which feels single particles that leave their phase.
 * sigma is that of mps_sim_set_tension() for a pair of phases, else the setting; where a particle has several other phases about it, their
 * mean. Needs a gradient that knows the jump: gradient.corrected. */
#include "tension.h"

enum { SIGMA, RADIUS, THRESHOLD };
static const mps_setting settings[] = {{"sigma", 7.27e-2, 0.0, 100.0}, {"radius", 5.1, 2.1, 20.0}, {"threshold", 0.02, 1e-6, 1.0}};

/* Mean of sigma over the neighbours of other phases. */
MPS__ROW double mean_sigma(const int dim, const mps_stage *s, double other, int64_t i)
{
    const mps_stencil *t = s->far;
    double sum = 0, weight = 0;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        if (s->kind[j] != MPS_FLUID || s->phase[j] == s->phase[i]) continue;
        const double w = mps_stencil_pair_dim(dim, t, i, p).w;
        sum += w * mps__pair_sigma(s, s->phase[i], s->phase[j], other);
        weight += w;
    }
    return weight > 0 ? sum / weight : 0;
}

static int classify(void *self, const double *k, mps_stage *s)
{
    (void)self;
    double *kappa = mps_stage_scratch(s, s->n);
    if (!kappa || !mps__curvatures(s, s->far, k[RADIUS], k[THRESHOLD], kappa)) return 1;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++)
        if (kappa[i] != 0) s->capillary[i] = kappa[i] * MPS__ROW_CALL(s, mean_sigma, s, k[SIGMA], i);
    return 0;
}

static double dt_limit(void *self, const double *k, const mps_stage *s)
{
    (void)self;
    return mps__tension_dt(s, k[SIGMA]);
}

const mps_model_ops mps__tension_jump = {.struct_size = sizeof(mps_model_ops),
                                         .api = MPS_MODEL_API,
                                         .name = "tension.jump",
                                         .order = 320,
                                         .setting_count = 3,
                                         .settings = settings,
                                         .classify = classify,
                                         .dt_limit = dt_limit};

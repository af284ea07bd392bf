/* SPDX-License-Identifier: BSD-3-Clause */
/* Compressibility of one phase, W22 (26), beside a source with the weight gamma of the density, as source.mixed has:
 *   [p^{k+1} - (1 - gamma) p^k]/(rho Cs^2 dt^2) on the left side of the pressure equation divided by rho.
 * It is the change of pressure of a step, and the density's deviation is measured against the equation of state:
 *   (p^{k+1} - p^k)/(rho Cs^2 dt^2) = gamma/dt^2 [(n - n0)/n0 - p^k/(rho Cs^2)] - ...,
 * so that at rest p = rho Cs^2 (n - n0)/n0. With `printed` p^{k+1}/(rho Cs^2 dt^2) alone, as W22 has it: at rest the gas is then
 * compressed 1/gamma times as much. gamma must be that of the source; with `tau` > 0 it is dt/(tau dp/U_g). */
#include "builtin.h"

enum { PHASE, SOUND, GAMMA, TAU, PRINTED };
static const mps_setting settings[] = {{"phase", 1.0, 0.0, MPS__PHASE_LIMIT - 1},
                                       {"sound", 340.0, 1.0, 1e4},
                                       {"gamma", 0.01, 0.0, 1.0},
                                       {"tau", 0.0, 0.0, 1e6},
                                       {"printed", 0.0, 0.0, 1.0}};

static int source(void *self, const double *k, mps_stage *s, mps_ppe_terms *terms)
{
    (void)self;
    double kept = 1.0 - k[GAMMA];
    if (k[TAU] > 0) kept = 1.0 - fmin(1.0, s->dt * s->velocity_scale / (k[TAU] * s->dp));
    if (k[PRINTED] > 0) kept = 0;
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_FLUID || s->phase[i] != (int32_t)k[PHASE]) continue;
        const double stiffness = 1.0 / (s->density[i] * k[SOUND] * k[SOUND] * s->dt * s->dt);
        terms->shift[i] += stiffness;
        terms->rhs[i] += stiffness * kept * s->p[i];
    }
    return 0;
}

const mps_model_ops mps__gas_compressible = {.struct_size = sizeof(mps_model_ops),
                                             .api = MPS_MODEL_API,
                                             .name = "gas.compressible",
                                             .order = 510,
                                             .setting_count = 5,
                                             .settings = settings,
                                             .source = source};

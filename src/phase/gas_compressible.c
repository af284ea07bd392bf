/* SPDX-License-Identifier: BSD-3-Clause */
/* Compressibility of one phase by its speed of sound Cs: d rho = dp/Cs^2. On the left side of the pressure equation divided by rho stands
 *   (p^{k+1} - p^k)/(rho Cs^2 dt^2),
 * the change of a step, and sources that correct the density see its deviation from the equation of state p = rho Cs^2 (n - n0)/n0: in
 * `volume` and `number_density` each gas particle counts with the volume that it has by p^k. So at rest the pressure is that of the
 * equation of state, whatever weight or relaxation time the source has.
 * Walls give way too, as far as the part of a cell that they stand for holds gas.
 * With `conserve` a gas in a closed tank keeps its volume, so its mean pressure does not run away; pressures are then above those of the
 * filling. Switch it off where sources are to change the volume of the gas.
 * With `printed` p^{k+1}/(rho Cs^2 dt^2) alone, W22 (26) to the letter. The old pressure is lost, and the gas gives way for ever: at rest
 * the source holds p = gamma rho Cs^2 (n - n0)/n0, which is a gas 1/gamma times as soft. */
#include "builtin.h"

enum { PHASE, SOUND, PRINTED, CONSERVE };
static const double LEAST = -0.9; /* (n - n0)/n0 where a linear law would leave no gas at all */
static const mps_setting settings[] = {
    {"phase", 1.0, 0.0, MPS__PHASE_LIMIT - 1}, {"sound", 340.0, 1.0, 1e4}, {"printed", 0.0, 0.0, 1.0}, {"conserve", 1.0, 0.0, 1.0}};

/* (n - n0)/n0 of a particle at its pressure. */
static inline double by_law(const double *k, const mps_stage *s, int64_t i)
{
    return fmax(s->p[i] / (s->density[i] * k[SOUND] * k[SOUND]), LEAST);
}

static int classify(void *self, const double *k, mps_stage *s)
{
    (void)self;
    if (mps__gas_check(s, k[PHASE], k[SOUND])) return 1;
    if (k[PRINTED] > 0) return 0;
    double *denser = mps_stage_scratch(s, s->n);
    if (!denser) return 1;
    for (int64_t i = 0; i < s->n; i++)
        if (mps__is_gas(s, i, k[PHASE])) denser[i] = by_law(k, s, i);
    return mps__gas_expect(s, denser);
}

static int source(void *self, const double *k, mps_stage *s, mps_ppe_terms *terms)
{
    (void)self;
    double surplus = 0, rho[MPS__PHASE_LIMIT];
    mps__phase_densities(s, rho);
    for (int64_t i = 0; i < s->n; i++)
        if (mps__is_gas(s, i, k[PHASE])) surplus += 1.0 / (1.0 + by_law(k, s, i)) - 1.0;
    if (k[CONSERVE] > 0 && !(k[PRINTED] > 0)) mps__gas_conserve(s, terms, k[PHASE], surplus);
    const double whole = 1.0 / (k[SOUND] * k[SOUND] * s->dt * s->dt), own = rho[(int)k[PHASE]];
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        const double stiffness = mps__gas_share(s, i, k[PHASE], terms->wall_factor) * whole /
                                 (s->kind[i] == MPS_FLUID ? s->density[i] : own);
        terms->gas[i] += stiffness;
        terms->rhs[i] += k[PRINTED] > 0 ? 0.0 : stiffness * s->p[i];
    }
    return 0;
}

const mps_model_ops mps__gas_compressible = {.struct_size = sizeof(mps_model_ops),
                                             .api = MPS_MODEL_API,
                                             .name = "gas.compressible",
                                             .order = 510,
                                             .setting_count = 4,
                                             .settings = settings,
                                             .classify = classify,
                                             .source = source};

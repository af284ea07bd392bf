/* SPDX-License-Identifier: BSD-3-Clause */
/* A gas that is compressed without losing heat: rho = rho0 (1 + p/P)^(1/e), P the pressure of the ambient air, rho0 the density of the
 * phase, e the exponent (1.4 for air; 1: isothermal). On the left side of the pressure equation divided by rho stands the change of ln rho,
 *   [ln(1 + p^{k+1}/P) - ln(1 + p^k/P)]/(e dt^2),
 * which is nonlinear: the solver must be one for that (sundials.kinsol). Sources that correct the density see its deviation from the law.
 * `conserve` as in gas.compressible. */
#include "builtin.h"

enum { PHASE, AMBIENT, EXPONENT, CONSERVE };
static const mps_setting settings[] = {
    {"phase", 1.0, 0.0, MPS__PHASE_LIMIT - 1}, {"ambient", 101325.0, 1.0, 1e9}, {"exponent", 1.4, 1.0, 10.0}, {"conserve", 1.0, 0.0, 1.0}};

/* (n - n0)/n0 of a particle at its pressure. */
static inline double by_law(const double *k, const mps_stage *s, int64_t i)
{
    return exp(mps_ppe_law(k[AMBIENT], s->p[i], NULL) / (k[AMBIENT] * k[EXPONENT])) - 1.0;
}

static int classify(void *self, const double *k, mps_stage *s)
{
    (void)self;
    double rho[MPS__PHASE_LIMIT];
    mps__phase_densities(s, rho);
    const double own = rho[(int)k[PHASE]];
    if (mps__gas_check(s, k[PHASE], own > 0 ? sqrt(k[EXPONENT] * k[AMBIENT] / own) : INFINITY)) return 1;
    double *denser = mps_stage_scratch(s, s->n);
    if (!denser) return 1;
    for (int64_t i = 0; i < s->n; i++)
        if (mps__is_gas(s, i, k[PHASE])) denser[i] = by_law(k, s, i);
    return mps__gas_expect(s, denser);
}

static int source(void *self, const double *k, mps_stage *s, mps_ppe_terms *terms)
{
    (void)self;
    double surplus = 0;
    for (int64_t i = 0; i < s->n; i++)
        if (mps__is_gas(s, i, k[PHASE])) surplus += 1.0 / (1.0 + by_law(k, s, i)) - 1.0;
    if (k[CONSERVE] > 0) mps__gas_conserve(s, terms, k[PHASE], surplus);
    const double whole = 1.0 / (k[EXPONENT] * k[AMBIENT] * s->dt * s->dt);
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        const double stiffness = mps__gas_share(s, i, k[PHASE], terms->wall_factor) * whole;
        if (stiffness == 0) continue;
        terms->gas[i] += stiffness;
        terms->law[i] = k[AMBIENT];
        terms->rhs[i] += stiffness * mps_ppe_law(k[AMBIENT], s->p[i], NULL);
    }
    return 0;
}

const mps_model_ops mps__gas_isentropic = {.struct_size = sizeof(mps_model_ops),
                                           .api = MPS_MODEL_API,
                                           .name = "gas.isentropic",
                                           .order = 510,
                                           .setting_count = 4,
                                           .settings = settings,
                                           .classify = classify,
                                           .source = source};

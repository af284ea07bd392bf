/* SPDX-License-Identifier: BSD-3-Clause */
/* Isentropic gas (no heat exchange): rho = rho0 (1 + p/P)^(1/e), P the pressure of the ambient air,
 * rho0 the density of the phase, e the exponent (1.4 for air; 1: isothermal). The left side of the
 * pressure equation, divided by rho, gets the change of ln rho,
 *   [ln(1 + p^{k+1}/P) - ln(1 + p^k/P)]/(e dt^2).
 * It is nonlinear and needs a suitable solver (sundials.kinsol). Sources that correct the density
 * use its deviation from the law. `conserve`: see gas.compressible. */
#include "helpers.h"

#include <mps/ppe.h>

enum { PHASE, AMBIENT, EXPONENT, CONSERVE, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [PHASE] = {"phase", "-", "Number of the phase that is a gas", MPS_TYPE_INTEGER, 1.0, 0.0,
               MPS_PHASES - 1},
    [AMBIENT] = {"ambient", "Pa", "Pressure of the ambient air", MPS_TYPE_REAL, 101325.0, 1.0, 1e9},
    [EXPONENT] = {"exponent", "-", "Exponent of the gas law; 1.4: air, 1: isothermal",
                  MPS_TYPE_REAL, 1.4, 1.0, 10.0},
    [CONSERVE] = {"conserve", "-", "1: the gas in a closed tank keeps its volume", MPS_TYPE_FLAG,
                  1.0, 0.0, 1.0}};

enum { EXPECT_VELOCITY, EXPECT_PRESSURE, EXPECT_VOLUME, EXPECT_NUMBER, EXPECT_USES };
static const mps_use expect_uses[EXPECT_USES] = {
    [EXPECT_VELOCITY] = {"velocity", MPS_USE_READ},
    [EXPECT_PRESSURE] = {"pressure", MPS_USE_READ},
    [EXPECT_VOLUME] = {"volume_deviation", MPS_USE_CHANGE},
    [EXPECT_NUMBER] = {"number_density", MPS_USE_CHANGE}};

enum { PRESSURE, REGION, CONDITION, GAS_SHIFT, GAS_LAW, SOURCE, USES };
static const mps_use uses[USES] = {[PRESSURE] = {"pressure", MPS_USE_READ},
                                   [REGION] = {"region", MPS_USE_NEIGHBOURS},
                                   [CONDITION] = {"pressure_condition", MPS_USE_READ},
                                   [GAS_SHIFT] = {"gas_shift", MPS_USE_CHANGE},
                                   [GAS_LAW] = {"gas_law", MPS_USE_CHANGE},
                                   [SOURCE] = {"pressure_source", MPS_USE_CHANGE}};

typedef struct fields {
    mps__gas_rows rows;
    const double *pressure;
    double *denser;              /* [n] (n - n0)/n0 of the gas */
    double *gas_shift, *gas_law; /* [n] */
    double whole;                /* 1/(e P dt^2) */
} fields;

/* (n - n0)/n0 of a particle at its pressure. */
static inline double by_law(const mps_view *v, const fields *f, int64_t i)
{
    const double *k = v->setting;
    return mps_expm1(mps_ppe_law(k[AMBIENT], f->pressure[i], NULL) / (k[AMBIENT] * k[EXPONENT]));
}

MPS_ROW void find_denser(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    (void)dim;
    if (mps__is_gas(v, i, v->setting[PHASE])) f->denser[i] = by_law(v, f, i);
}
MPS_ROWS(find_denser_rows, find_denser, fields)

static int expect_volumes(mps_stage *s)
{
    const double *k = s->view->setting;
    double rho[MPS_PHASES];
    mps_stage_densities(s, rho, NULL);
    const double own = rho[(int)k[PHASE]];
    const double sound = own > 0 ? sqrt(k[EXPONENT] * k[AMBIENT] / own) : INFINITY;
    if (mps__gas_check(s, k[PHASE], sound, s->data[EXPECT_VELOCITY])) return 1;
    fields f = {.pressure = s->data[EXPECT_PRESSURE], .denser = mps_stage_scratch(s, s->view->n)};
    if (!f.denser) return 1;
    mps_stage_rows(s, &find_denser_rows, &f);
    return mps__gas_expect(s, f.denser, s->data[EXPECT_VOLUME], s->data[EXPECT_NUMBER]);
}

/* Sums of mps__gas_conserve(). */
MPS_ROW void add_row(const int dim, const mps_view *v, const fields *f, int64_t i, double *sums)
{
    (void)dim;
    mps__gas_add(v, &f->rows, i, sums);
    if (mps__is_gas(v, i, v->setting[PHASE]))
        sums[MPS__GAS_SURPLUS] += 1.0 / (1.0 + by_law(v, f, i)) - 1.0;
}
MPS_SUMS(add_rows, add_row, fields)

MPS_ROW void compress(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    (void)dim;
    const double *k = v->setting;
    const double stiffness = mps__gas_fraction(v, f->rows.region, i, k[PHASE]) * f->whole;
    if (stiffness == 0) return;
    f->gas_shift[i] += stiffness;
    f->gas_law[i] = k[AMBIENT];
    f->rows.source[i] += stiffness * mps_ppe_law(k[AMBIENT], f->pressure[i], NULL);
}
MPS_ROWS(compress_rows, compress, fields)

static int compress_gas(mps_stage *s)
{
    const double *k = s->view->setting;
    fields f = {.rows = {s->data[REGION], s->data[CONDITION], s->data[SOURCE], k[PHASE]},
                .pressure = s->data[PRESSURE],
                .gas_shift = s->data[GAS_SHIFT],
                .gas_law = s->data[GAS_LAW],
                .whole = 1.0 / (k[EXPONENT] * k[AMBIENT] * s->view->dt * s->view->dt)};
    double sums[MPS__GAS_SUMS];
    if (k[CONSERVE] > 0) {
        mps_stage_sum(s, MPS__GAS_SUMS, &add_rows, &f, sums);
        mps__gas_conserve(s, &f.rows, sums);
    }
    mps_stage_rows(s, &compress_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {{.hook = MPS_PREPARE,
                                  .use_count = EXPECT_USES,
                                  .uses = expect_uses,
                                  .run = expect_volumes,
                                  .device = 1},
                                 {.hook = MPS_SOURCE,
                                  .use_count = USES,
                                  .uses = uses,
                                  .after = "source",
                                  .run = compress_gas,
                                  .device = 1}};

const mps_model_ops mps__gas_isentropic = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "gas.isentropic",
    .help = "A gas that is compressed without exchange of heat; needs a nonlinear solver",
    .setting_count = SETTINGS,
    .settings = settings,
    .verb_count = 2,
    .verbs = verbs};

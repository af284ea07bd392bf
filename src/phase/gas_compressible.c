/* SPDX-License-Identifier: BSD-3-Clause */
/* Compressibility of one phase by its speed of sound Cs: d rho = dp/Cs^2. The left side of the
 * pressure equation, divided by rho, gets the change in a step,
 *   (p^{k+1} - p^k)/(rho Cs^2 dt^2).
 * In "volume_deviation" and "number_density" each gas particle counts with its volume by the
 * equation of state p = rho Cs^2 (n - n0)/n0 at p^k. So sources that correct the density use its
 * deviation from the equation of state, and at rest the pressure is that of the equation of state
 * for any weight or relaxation time of the source. Walls are compressible too, by the gas fraction
 * of the part of the cell that they represent.
 *   conserve: a gas in a closed tank keeps its volume, so that its mean pressure does not drift;
 *     pressures are then relative to the filled state. Disable it if sources change the volume.
 *   printed: p^{k+1}/(rho Cs^2 dt^2) alone, W22 (26) literally. The old pressure is lost, and
 *     the gas is compressed without limit: at rest the source holds p = gamma rho Cs^2 (n - n0)/n0,
 *     a gas 1/gamma times as soft.
 * W22: Wen, Zhao & Wan 2022. */
#include "helpers.h"

enum { PHASE, SOUND, PRINTED, CONSERVE, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [PHASE] = {"phase", "-", "Number of the phase that is a gas", MPS_TYPE_INTEGER, 1.0, 0.0,
               MPS_PHASES - 1},
    [SOUND] = {"sound", "m/s", "Speed of sound", MPS_TYPE_REAL, 340.0, 1.0, 1e4},
    [PRINTED] = {"printed", "-", "1: W22 (26) as published, which loses the old pressure",
                 MPS_TYPE_FLAG, 0.0, 0.0, 1.0},
    [CONSERVE] = {"conserve", "-", "1: the gas in a closed tank keeps its volume", MPS_TYPE_FLAG,
                  1.0, 0.0, 1.0}};

enum {
    EXPECT_VELOCITY,
    EXPECT_PRESSURE,
    EXPECT_DENSITY,
    EXPECT_VOLUME,
    EXPECT_NUMBER,
    EXPECT_USES
};
static const mps_use expect_uses[EXPECT_USES] = {
    [EXPECT_VELOCITY] = {"velocity", MPS_USE_READ},
    [EXPECT_PRESSURE] = {"pressure", MPS_USE_READ},
    [EXPECT_DENSITY] = {"density", MPS_USE_READ},
    [EXPECT_VOLUME] = {"volume_deviation", MPS_USE_CHANGE},
    [EXPECT_NUMBER] = {"number_density", MPS_USE_CHANGE}};

enum { PRESSURE, DENSITY, REGION, CONDITION, GAS_SHIFT, SOURCE, USES };
static const mps_use uses[USES] = {
    [PRESSURE] = {"pressure", MPS_USE_READ},     [DENSITY] = {"density", MPS_USE_READ},
    [REGION] = {"region", MPS_USE_NEIGHBOURS},   [CONDITION] = {"pressure_condition", MPS_USE_READ},
    [GAS_SHIFT] = {"gas_shift", MPS_USE_CHANGE}, [SOURCE] = {"pressure_source", MPS_USE_CHANGE}};

/* Smallest (n - n0)/n0: at -1 the linear law would have no gas left. */
static const double LEAST = -0.9;

typedef struct fields {
    mps__gas_rows rows;
    const double *pressure, *density;
    double *denser;    /* [n] (n - n0)/n0 of the gas */
    double *gas_shift; /* [n] */
    double whole;      /* 1/(Cs^2 dt^2) */
    double own;        /* density of the gas */
} fields;

/* (n - n0)/n0 of a particle at its pressure. */
static inline double by_law(const mps_view *v, const fields *f, int64_t i)
{
    const double sound = v->setting[SOUND];
    return mps_larger(f->pressure[i] / (f->density[i] * sound * sound), LEAST);
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
    if (mps__gas_check(s, k[PHASE], k[SOUND], s->data[EXPECT_VELOCITY])) return 1;
    if (k[PRINTED] > 0) return 0;
    fields f = {.pressure = s->data[EXPECT_PRESSURE],
                .density = s->data[EXPECT_DENSITY],
                .denser = mps_stage_scratch(s, s->view->n)};
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
    const double *k = v->setting, rho = mps_is_fluid(v, i) ? f->density[i] : f->own;
    const double stiffness = mps__gas_fraction(v, f->rows.region, i, k[PHASE]) * f->whole / rho;
    f->gas_shift[i] += stiffness;
    f->rows.source[i] += k[PRINTED] > 0 ? 0.0 : stiffness * f->pressure[i];
}
MPS_ROWS(compress_rows, compress, fields)

static int compress_gas(mps_stage *s)
{
    const double *k = s->view->setting;
    fields f = {.rows = {s->data[REGION], s->data[CONDITION], s->data[SOURCE], k[PHASE]},
                .pressure = s->data[PRESSURE],
                .density = s->data[DENSITY],
                .gas_shift = s->data[GAS_SHIFT],
                .whole = 1.0 / (k[SOUND] * k[SOUND] * s->view->dt * s->view->dt)};
    double sums[MPS__GAS_SUMS], rho[MPS_PHASES];
    mps_stage_densities(s, rho, NULL);
    f.own = rho[(int)k[PHASE]];
    if (k[CONSERVE] > 0 && !(k[PRINTED] > 0)) {
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

const mps_model_ops mps__gas_compressible = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "gas.compressible",
    .help = "Compressibility of one phase by its speed of sound",
    .setting_count = SETTINGS,
    .settings = settings,
    .verb_count = 2,
    .verbs = verbs};

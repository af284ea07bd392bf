/* SPDX-License-Identifier: BSD-3-Clause */
/* Compressibility of one phase, a gas. The left side of the pressure equation, divided by rho, gets
 * the change of ln rho in a step. Two models differ in the law of the gas:
 *   gas.compressible: d rho = dp/Cs^2, Cs the speed of sound. The change is
 *       (p^{k+1} - p^k)/(rho Cs^2 dt^2).
 *   gas.isentropic (no heat exchange): rho = rho0 (1 + p/P)^(1/e), P the pressure of the ambient
 *     air, rho0 the density of the phase, e the exponent (1.4 for air; 1: isothermal). The change
 *       [ln(1 + p^{k+1}/P) - ln(1 + p^k/P)]/(e dt^2)
 *     is nonlinear and needs a suitable solver (sundials.kinsol).
 * In "volume_deviation" and "number_density" each gas particle counts with its volume by the law at
 * p^k. So sources that correct the density use its deviation from the law, and at rest the pressure
 * is that of the law for any weight or relaxation time of the source. Walls are compressible too,
 * by the gas fraction of the part of the cell that they represent.
 *   conserve: a gas in a closed tank keeps its volume, so that its mean pressure does not drift;
 *     pressures are then relative to the filled state. Disable it if sources change the volume.
 *   printed: p^{k+1}/(rho Cs^2 dt^2) alone, W22 (26) literally. The old pressure is lost, and
 *     the gas is compressed without limit: at rest the source holds p = gamma rho Cs^2 (n - n0)/n0,
 *     a gas 1/gamma times as soft.
 * W22: Wen, Zhao & Wan 2022. */
#include <math.h>
#include <mps/model.h>
#include <mps/ppe.h>
#include <stdbool.h>

/* ---- the laws ---- */

enum { PHASE, SOUND, PRINTED, CONSERVE, SETTINGS, AMBIENT = SOUND, EXPONENT = PRINTED };
#define PHASE_SETTING                                                                  \
    {                                                                                  \
        "phase", "-", "Number of the phase that is a gas", MPS_TYPE_INTEGER, 1.0, 0.0, \
            MPS_PHASES - 1                                                             \
    }
#define CONSERVE_SETTING                                                                          \
    {                                                                                             \
        "conserve", "-", "1: the gas in a closed tank keeps its volume", MPS_TYPE_FLAG, 1.0, 0.0, \
            1.0                                                                                   \
    }

typedef struct gas_law {
    double phase;
    double ambient; /* P [Pa]; 0: of gas.compressible */
    double sound;   /* Cs [m/s], of gas.compressible */
    double stiff;   /* Cs^2, or e P */
    bool printed, conserve;
} gas_law;

/* Smallest (n - n0)/n0 of gas.compressible: at -1 there would be no gas left. */
static const double LEAST = -0.9;

/* Arguments of the row functions. */
typedef struct fields {
    gas_law law;
    const int32_t *region, *condition;
    const double *pressure, *density;
    double *source, *gas_shift, *gas_law;
    double *less; /* [n] relative reduction of the volume of the gas by its law */
    double *sum;  /* [n] of `less` */
    double *volume_deviation, *number_density;
    double whole;     /* 1/(Cs^2 dt^2), or 1/(e P dt^2) */
    double own;       /* density of the gas */
    double gas, part; /* amounts that conserve() subtracts: from the gas, from each row */
} fields;

/* True for a particle of the gas. */
static inline bool is_gas(const mps_view *v, int64_t i, double phase)
{
    return mps_is_fluid(v, i) && v->phase[i] == (int32_t)phase;
}

/* (n - n0)/n0 of a particle at its pressure. */
static inline double denser_by_law(const fields *f, int64_t i)
{
    const gas_law *l = &f->law;
    return l->ambient > 0
               ? mps_expm1(mps_ppe_law(l->ambient, f->pressure[i], NULL) / l->stiff)
               : mps_larger(f->pressure[i] / (f->density[i] * l->sound * l->sound), LEAST);
}

/* ---- speeds ---- */

typedef struct speeds {
    const double *velocity;
    double phase;
} speeds;

/* Maximum of |u|^2 over the gas, relative to the tank. */
MPS_ROW void raise_speed(const int dim, const mps_view *v, const speeds *f, int64_t i, double *most)
{
    if (!is_gas(v, i, f->phase)) return;
    double u[3], square = 0;
    mps_view_relative(dim, v, v->x + i * dim, f->velocity + i * dim, u);
    for (int d = 0; d < dim; d++) square += u[d] * u[d];
    most[0] = mps_larger(most[0], square);
}
MPS_SUMS(raise_speed_rows, raise_speed, speeds)

/* Fails if no fluid particle has the phase, or if one is not slower than the speed of sound. */
static int check_gas(mps_stage *s, const gas_law *l, const double *velocity)
{
    const int phase = (int)l->phase;
    double rho[MPS_PHASES], most;
    mps_stage_densities(s, rho, NULL);
    if (!(rho[phase] > 0))
        return mps_stage_fail(
            s,
            "phase %d has no fluid particle: add the gas, or set gas.phase to it; "
            "with liquids alone remove the model \"gas\"; one liquid with a "
            "surface: preset \"imps\"",
            phase);
    const double sound = l->ambient > 0 ? sqrt(l->stiff / rho[phase]) : l->sound;
    if (s->view->fastest < sound) return 0;
    mps_stage_max(s, 1, &raise_speed_rows, &(speeds){velocity, l->phase}, &most);
    const double fastest = sqrt(mps_larger(most, 0));
    if (!(fastest < sound))
        return mps_stage_fail(
            s,
            "a particle of phase %d moves at %g m/s in the tank, and the speed of sound there "
            "is %g m/s: it must be greater",
            phase, fastest, sound);
    return 0;
}

/* ---- volumes ---- */

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

MPS_ROW void shrink(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    (void)dim;
    if (!is_gas(v, i, f->law.phase)) return;
    const double denser = denser_by_law(f, i);
    f->less[i] = denser / (1.0 + denser);
}
MPS_ROWS(shrink_rows, shrink, fields)

MPS_ROW void subtract(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    f->volume_deviation[i] -= f->sum[i];
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const double less = f->less[mps_stencil_column(t, p)];
        if (less != 0) f->number_density[i] -= less * mps_stencil_pair_dim(dim, t, i, p).w;
    }
}
MPS_ROWS(subtract_rows, subtract, fields)

/* Subtract the volumes by the law from "volume_deviation" and "number_density", which then contain
 * only the error of the volumes. Each particle counts with its volume by the law, 1/(1 + denser),
 * also in the sums over its neighbours: walls and liquid beside a compressed gas keep their own. */
static int expect_volumes(mps_stage *s, const gas_law *law)
{
    if (check_gas(s, law, s->data[EXPECT_VELOCITY])) return 1;
    if (law->printed) return 0;
    fields f = {.law = *law,
                .pressure = s->data[EXPECT_PRESSURE],
                .density = s->data[EXPECT_DENSITY],
                .volume_deviation = s->data[EXPECT_VOLUME],
                .number_density = s->data[EXPECT_NUMBER],
                .less = mps_stage_scratch(s, s->view->n),
                .sum = mps_stage_scratch(s, s->view->n)};
    if (!f.less || !f.sum) return 1;
    mps_stage_rows(s, &shrink_rows, &f);
    if (mps_stage_refresh(s, 1, &(mps_shared){f.less, 1, MPS_TYPE_REAL})) return 1;
    if (mps_op_volume_sum(&s->view->far, f.less, f.sum) != MPS_OK)
        return mps_stage_fail(s, "the volumes of the gas cannot be summed");
    mps_stage_rows(s, &subtract_rows, &f);
    return 0;
}

/* ---- volume of the whole gas ---- */

/* Sums over the rows: of the sources in the equation, of their number, of rows of the gas, of fixed
 * rows; over the gas of (volume by the law - 1), in cells of the lattice. */
enum { SOURCES, ROWS, OWN, FIXED, SURPLUS, SUMS };

/* Whether row i is in the pressure equation. */
static inline bool in_equation(const mps_view *v, const fields *f, int64_t i)
{
    return !mps_is_dummy(v, i) && mps_region_of(f->region, i) < MPS_REGION_SURFACE;
}

MPS_ROW void add_row(const int dim, const mps_view *v, const fields *f, int64_t i, double *sums)
{
    (void)dim;
    const bool gas = is_gas(v, i, f->law.phase);
    if (f->condition[i] == MPS_ROW_FIXED) sums[FIXED]++;
    if (gas) sums[SURPLUS] += 1.0 / (1.0 + denser_by_law(f, i)) - 1.0;
    if (!in_equation(v, f, i)) return;
    sums[SOURCES] += f->source[i];
    sums[ROWS]++;
    if (gas) sums[OWN]++;
}
MPS_SUMS(add_rows, add_row, fields)

MPS_ROW void subtract_balance(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    (void)dim;
    if (!in_equation(v, f, i)) return;
    f->source[i] += (is_gas(v, i, f->law.phase) ? f->gas : 0.0) - f->part;
}
MPS_ROWS(subtract_balance_rows, subtract_balance, fields)

/* Conserve the volume of the gas if no row of the pressure equation is fixed. The tank is rigid and
 * the liquid keeps its volume, so the gas must keep its volume. But the sum of the divergences over
 * all rows is not exactly 0, and a gas integrates the residual: a mean error of 0.1 1/s is 14 kPa a
 * second in air.
 *  - A small residual, as in calm tanks, is subtracted from all rows. Subtracted from the gas alone
 *    it would add 0.2 % of rho g h to the pressure of the liquid.
 *  - A larger residual, as from a single row in an impact, is subtracted from the gas alone. As a
 *    source in the whole liquid it would give a pressure of many kPa for a step. */
static void conserve(const mps_stage *s, fields *f)
{
    const mps_view *v = s->view;
    static const double share = 0.1; /* fraction of the surplus that a step removes */
    /* limit of the residual subtracted from all rows, in g/dp */
    static const double small = 0.005;
    const double bound = small * v->velocity_scale * v->velocity_scale / (v->dp * v->dp);
    double sums[SUMS];
    mps_stage_sum(s, SUMS, &add_rows, f, sums);
    if (sums[FIXED] > 0 || sums[OWN] == 0) return;
    f->part = mps_smaller(mps_larger(sums[SOURCES] / sums[ROWS], -bound), bound);
    const double rest = sums[SOURCES] - f->part * sums[ROWS],
                 wanted = share * sums[SURPLUS] / (v->dt * v->dt);
    f->gas = (wanted - rest) / sums[OWN];
    mps_stage_rows(s, &subtract_balance_rows, f);
}

/* ---- the equation ---- */

/* The last use is of gas.isentropic only. */
enum { PRESSURE, DENSITY, REGION, CONDITION, GAS_SHIFT, SOURCE, GAS_LAW, USES };
static const mps_use uses[USES] = {
    [PRESSURE] = {"pressure", MPS_USE_READ},     [DENSITY] = {"density", MPS_USE_READ},
    [REGION] = {"region", MPS_USE_NEIGHBOURS},   [CONDITION] = {"pressure_condition", MPS_USE_READ},
    [GAS_SHIFT] = {"gas_shift", MPS_USE_CHANGE}, [SOURCE] = {"pressure_source", MPS_USE_CHANGE},
    [GAS_LAW] = {"gas_law", MPS_USE_CHANGE}};

/* Gas fraction in the cell of a wall particle: the fraction of the cell that the wall particle
 * represents, times the gas fraction of the fluid beside it. */
MPS_ROW double wall_share(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    const double wall_factor = v->flux.wall_factor;
    double fluid = 0, gas = 0, walls = 0;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (mps_region_of(f->region, j) >= MPS_REGION_SPRAY) continue;
        const double w = mps_stencil_pair_dim(dim, t, i, p).w;
        if (mps_is_fluid(v, j)) fluid += w;
        if (is_gas(v, j, f->law.phase)) gas += w;
        if (mps_is_wall(v, j)) walls += wall_factor * w;
    }
    return fluid > 0 ? gas / fluid * (fluid + walls) / t->n0 : 0.0;
}

/* Gas fraction in the cell of particle i, 0..1. */
MPS_ROW double gas_fraction(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    if (mps_is_fluid(v, i)) return is_gas(v, i, f->law.phase) ? 1.0 : 0.0;
    if (mps_is_dummy(v, i) || mps_region_of(f->region, i) >= MPS_REGION_SPRAY) return 0.0;
    return v->flux.wall_factor == 0 ? 0.0 : wall_share(dim, v, f, i);
}

MPS_ROW void compress(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    const gas_law *l = &f->law;
    const double rho = l->ambient > 0 ? 1 : mps_is_fluid(v, i) ? f->density[i] : f->own;
    const double stiffness = gas_fraction(dim, v, f, i) * f->whole / rho;
    if (stiffness == 0) return;
    f->gas_shift[i] += stiffness;
    if (l->ambient > 0) f->gas_law[i] = l->ambient;
    if (!l->printed) f->source[i] += stiffness * mps_ppe_law(l->ambient, f->pressure[i], NULL);
}
MPS_ROWS(compress_rows, compress, fields)

static int compress_gas(mps_stage *s, const gas_law *law)
{
    const double dt = s->view->dt;
    double rho[MPS_PHASES];
    mps_stage_densities(s, rho, NULL);
    fields f = {.law = *law,
                .pressure = s->data[PRESSURE],
                .density = s->data[DENSITY],
                .region = s->data[REGION],
                .condition = s->data[CONDITION],
                .source = s->data[SOURCE],
                .gas_shift = s->data[GAS_SHIFT],
                .gas_law = law->ambient > 0 ? s->data[GAS_LAW] : NULL,
                .whole = 1.0 / (law->stiff * dt * dt),
                .own = rho[(int)law->phase]};
    if (law->conserve) conserve(s, &f);
    mps_stage_rows(s, &compress_rows, &f);
    return 0;
}

/* ---- gas.compressible ---- */

static const mps_setting compressible_settings[SETTINGS] = {
    [PHASE] = PHASE_SETTING,
    [SOUND] = {"sound", "m/s", "Speed of sound", MPS_TYPE_REAL, 340.0, 1.0, 1e4},
    [PRINTED] = {"printed", "-", "1: W22 (26) as published, which loses the old pressure",
                 MPS_TYPE_FLAG, 0.0, 0.0, 1.0},
    [CONSERVE] = CONSERVE_SETTING};

static gas_law compressible(const mps_stage *s)
{
    const double *k = s->view->setting;
    const bool printed = k[PRINTED] > 0;
    return (gas_law){.phase = k[PHASE],
                     .sound = k[SOUND],
                     .stiff = k[SOUND] * k[SOUND],
                     .printed = printed,
                     .conserve = k[CONSERVE] > 0 && !printed};
}

static int expect_compressible(mps_stage *s)
{
    const gas_law law = compressible(s);
    return expect_volumes(s, &law);
}

static int compress_compressible(mps_stage *s)
{
    const gas_law law = compressible(s);
    return compress_gas(s, &law);
}

static const mps_verb compressible_verbs[] = {{.hook = MPS_PREPARE,
                                               .use_count = EXPECT_USES,
                                               .uses = expect_uses,
                                               .run = expect_compressible,
                                               .device = 1},
                                              {.hook = MPS_SOURCE,
                                               .use_count = USES - 1,
                                               .uses = uses,
                                               .after = "source",
                                               .run = compress_compressible,
                                               .device = 1}};

const mps_model_ops mps__gas_compressible = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "gas.compressible",
    .help = "Compressibility of one phase by its speed of sound",
    .setting_count = SETTINGS,
    .settings = compressible_settings,
    .verb_count = 2,
    .verbs = compressible_verbs};

/* ---- gas.isentropic ---- */

static const mps_setting isentropic_settings[SETTINGS] = {
    [PHASE] = PHASE_SETTING,
    [AMBIENT] = {"ambient", "Pa", "Pressure of the ambient air", MPS_TYPE_REAL, 101325.0, 1.0, 1e9},
    [EXPONENT] = {"exponent", "-", "Exponent of the gas law; 1.4: air, 1: isothermal",
                  MPS_TYPE_REAL, 1.4, 1.0, 10.0},
    [CONSERVE] = CONSERVE_SETTING};

static gas_law isentropic(const mps_stage *s)
{
    const double *k = s->view->setting;
    return (gas_law){.phase = k[PHASE],
                     .ambient = k[AMBIENT],
                     .stiff = k[EXPONENT] * k[AMBIENT],
                     .conserve = k[CONSERVE] > 0};
}

static int expect_isentropic(mps_stage *s)
{
    const gas_law law = isentropic(s);
    return expect_volumes(s, &law);
}

static int compress_isentropic(mps_stage *s)
{
    const gas_law law = isentropic(s);
    return compress_gas(s, &law);
}

static const mps_verb isentropic_verbs[] = {{.hook = MPS_PREPARE,
                                             .use_count = EXPECT_USES,
                                             .uses = expect_uses,
                                             .run = expect_isentropic,
                                             .device = 1},
                                            {.hook = MPS_SOURCE,
                                             .use_count = USES,
                                             .uses = uses,
                                             .after = "source",
                                             .run = compress_isentropic,
                                             .device = 1}};

const mps_model_ops mps__gas_isentropic = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "gas.isentropic",
    .help = "A gas that is compressed without exchange of heat; needs a nonlinear solver",
    .setting_count = SETTINGS,
    .settings = isentropic_settings,
    .verb_count = 2,
    .verbs = isentropic_verbs};

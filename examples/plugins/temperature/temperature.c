/* SPDX-License-Identifier: BSD-3-Clause */
/* Temperature of one liquid: advected with the particles, with heat conduction and a law of
 * viscosity.
 *   dT/dt = kappa <lap T>,   <lap T>_i = 2D/(n0 lambda) sum (T_j - T_i) W over far pairs,
 *   mu = mu_phase exp(B (1/T - 1/T0))   (Arrhenius)
 * Pairs of fluid are symmetric and conserve sum T, the heat. Walls:
 *   adiabatic 1 (default): no heat flux in pairs with solids. Near walls and the free surface pairs
 *     are missing, so heat flows more slowly along them, within about 2 dp.
 *   adiabatic 0: walls have the temperature `wall`. A dummy has a mirrored temperature,
 *     T_j - wall = -(T_i - wall) times the ratio of their distances from the face, so that
 *     T = `wall` on the face.
 * The displacement of MPS_SHIFT moves T without correction: a small numerical diffusion. */
#include "temperature.h"

enum { KAPPA, ADIABATIC, WALL, ARRHENIUS, REFERENCE, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [KAPPA] = {"kappa", "m2/s", "Diffusivity of heat", MPS_TYPE_REAL, 1.4e-7, 0.0, 1.0},
    [ADIABATIC] = {"adiabatic", "-", "1: walls carry no heat; 0: they have the temperature 'wall'",
                   MPS_TYPE_FLAG, 1.0, 0.0, 1.0},
    [WALL] = {"wall", "K", "Temperature of walls", MPS_TYPE_REAL, 293.15, 200.0, 1000.0},
    [ARRHENIUS] = {"arrhenius", "K", "B of the law of viscosity; 0: that of the phase",
                   MPS_TYPE_REAL, 0.0, 0.0, 4000.0},
    [REFERENCE] = {"reference", "K", "T0, where the viscosity is that of the phase", MPS_TYPE_REAL,
                   293.15, 200.0, 1000.0}};

/* A law of viscosity needs T > 0. */
static const double COLDEST = 100.0;

static const mps_channel channels[] = {{.name = "temperature",
                                        .unit = "K",
                                        .help = "temperature of fluid",
                                        .components = 1,
                                        .type = MPS_TYPE_REAL,
                                        .life = MPS_LIFE_PARTICLE,
                                        .initial = 293.15},
                                       {.name = "viscosity",
                                        .unit = "Pa s",
                                        .help = "dynamic viscosity",
                                        .components = 1,
                                        .type = MPS_TYPE_REAL,
                                        .life = MPS_LIFE_STEP,
                                        .initial = 0.0}};

/* Arrays of particles that the loops use; each verb sets the arrays of its loops. */
typedef struct fields {
    const double *density;
    double *temperature, *viscosity, *rate;
} fields;

/* mu over that of the phase. */
static double viscosity_ratio(const mps_view *v, double temperature)
{
    const double t = temperature > COLDEST ? temperature : COLDEST;
    return mps_exp(v->setting[ARRHENIUS] * (1 / t - 1 / v->setting[REFERENCE]));
}

/* ---- MPS_LIMIT: the longest stable step ------------------------------------------------------ */

enum { LIMIT_TEMPERATURE, LIMIT_DENSITY, LIMIT_USES };
static const mps_use limit_uses[LIMIT_USES] = {[LIMIT_TEMPERATURE] = {"temperature", MPS_USE_READ},
                                               [LIMIT_DENSITY] = {"density", MPS_USE_READ}};

/* Raise most[0] to the kinematic viscosity. */
MPS_ROW void raise(const int dim, const mps_view *v, const fields *f, int64_t i, double *most)
{
    (void)dim;
    if (v->kind[i] != MPS_FLUID) return;
    const double mu = v->viscosity[v->phase[i]] * viscosity_ratio(v, f->temperature[i]);
    most[0] = mps_larger(most[0], mu / f->density[i]);
}
MPS_SUMS(raise_rows, raise, fields)

/* Explicit diffusion has no new extremes below dt = lambda/(2 D kappa); half of it is allowed. */
static int limit_step(mps_stage *s)
{
    const mps_view *v = s->view;
    const fields f = {.temperature = s->data[LIMIT_TEMPERATURE], .density = s->data[LIMIT_DENSITY]};
    double nu;
    mps_stage_max(s, 1, &raise_rows, &f, &nu);
    const double most = fmax(nu, v->setting[KAPPA]);
    if (most > 0) s->dt_limit = fmin(s->dt_limit, 0.5 * v->far.lambda / (2 * v->dim * most));
    return 0;
}

/* ---- MPS_PREPARE: viscosity, then a step of conduction --------------------------------------- */

enum { SET_TEMPERATURE, SET_VISCOSITY, SET_USES };
static const mps_use set_uses[SET_USES] = {[SET_TEMPERATURE] = {"temperature", MPS_USE_READ},
                                           [SET_VISCOSITY] = {"viscosity", MPS_USE_WRITE}};

MPS_ROW void set(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    (void)dim;
    if (v->kind[i] == MPS_FLUID)
        f->viscosity[i] = v->viscosity[v->phase[i]] * viscosity_ratio(v, f->temperature[i]);
}
MPS_ROWS(set_rows, set, fields)

static int set_viscosity(mps_stage *s)
{
    const fields f = {.temperature = s->data[SET_TEMPERATURE], .viscosity = s->data[SET_VISCOSITY]};
    mps_stage_rows(s, &set_rows, &f);
    return 0;
}

enum { CONDUCT_TEMPERATURE, CONDUCT_USES };
static const mps_use conduct_uses[CONDUCT_USES] = {
    [CONDUCT_TEMPERATURE] = {"temperature", MPS_USE_NEIGHBOURS | MPS_USE_CHANGE}};

/* T_j - T_i of a solid particle j at temperature `wall` and a fluid particle i. */
MPS_ROW double step_to_solid(const int dim, const mps_view *v, double own, int64_t i, int64_t j)
{
    const int64_t w = v->kind[j] == MPS_DUMMY ? v->wall_of[j] : j;
    const double wall = v->setting[WALL];
    double above = 0, below = 0; /* distances of i and j from the face of w, times its area */
    for (int d = 0; w >= 0 && d < dim; d++) {
        above += v->area[w * dim + d] * (v->x[i * dim + d] - v->x[w * dim + d]);
        below -= v->area[w * dim + d] * (v->x[j * dim + d] - v->x[w * dim + d]);
    }
    const double ratio = above > 0 && below > 0 ? below / above : 0;
    return (wall - own) * (1 + fmin(ratio, 3.0));
}

/* dT/dt of a row; temperatures are not changed while neighbours read them. */
MPS_ROW void conduct(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    const mps_stencil *t = &v->far;
    const double *temperature = f->temperature, own = temperature[i];
    double sum = 0;
    if (v->kind[i] != MPS_FLUID) return;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        if (v->kind[q.j] == MPS_FLUID)
            sum += (temperature[q.j] - own) * q.w;
        else if (v->setting[ADIABATIC] < 0.5)
            sum += step_to_solid(dim, v, own, i, q.j) * q.w;
    }
    f->rate[i] = v->setting[KAPPA] * 2 * dim / (t->n0 * t->lambda) * sum;
}
MPS_ROWS(conduct_rows, conduct, fields)

MPS_ROW void add(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    (void)dim;
    f->temperature[i] += v->dt * f->rate[i];
}
MPS_ROWS(add_rows, add, fields)

static int conduct_heat(mps_stage *s)
{
    const fields f = {.temperature = s->data[CONDUCT_TEMPERATURE],
                      .rate = mps_stage_scratch(s, s->view->n)};
    if (!f.rate) return 1;
    mps_stage_rows(s, &conduct_rows, &f);
    mps_stage_rows(s, &add_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_LIMIT, .use_count = LIMIT_USES, .uses = limit_uses, .run = limit_step},
    {.hook = MPS_PREPARE, .use_count = SET_USES, .uses = set_uses, .run = set_viscosity},
    {.hook = MPS_PREPARE, .use_count = CONDUCT_USES, .uses = conduct_uses, .run = conduct_heat}};

const mps_model_ops temperature_conduction = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "temperature.conduction",
    .help = "Temperature that travels with the fluid and sets its viscosity",
    .setting_count = SETTINGS,
    .settings = settings,
    .channel_count = 2,
    .channels = channels,
    .verb_count = 3,
    .verbs = verbs};

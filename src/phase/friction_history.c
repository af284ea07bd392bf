/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction at the two side walls of a thin tank that is computed in 2-D, with the history of the
 * boundary layers (layers.h). A particle has the mean velocity across the width b. It carries the
 * velocities q_k of the modes of its layers, initially 0: layers grow from then on. No frequency
 * has to be chosen.
 *
 * In a step the relative velocity u changes by du. Friction with the initial u and q_k is part of
 * MPS_FORCE, so that the pressures include it. The other forces also accelerate the added mass of
 * the layers: after all other verbs of MPS_VELOCITY their part of du is divided by 1 + added. This
 * keeps a divergence-free flow divergence-free. Then the q_k are updated.
 *
 * The tank rotates: with the velocity relative to it, q_k has a Coriolis acceleration. In the lab
 * frame q_k rotates by the angle of the tank, in the opposite sense.
 *
 * Forces on the side walls are those of the part "sides". Both parts of the friction are in the
 * term `friction` of the energy budget; the kinetic energy of the profile is in `layers`. */
#include "helpers.h"
#include "layers.h"
#include <mps/reaction.h>

enum { WIDTH, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [WIDTH] = {"width", "m", "Distance between the side walls", MPS_TYPE_REAL, 1e9, 1e-9, 1e9}};

static const char *const parts[] = {"sides"};

/* Modes in a channel; each direction has two channels. */
enum { HALF = MPS__LAYERS / 2, LAYERS = 4 };

#define LAYER(axis, which, of)                                                    \
    {                                                                             \
        .name = "layers_" axis "_" which, .unit = "m/s",                          \
        .help = "velocity along " axis " that " of " modes of the layers at the " \
                "side walls have reached",                                        \
        .components = HALF, .type = MPS_TYPE_REAL, .life = MPS_LIFE_PARTICLE      \
    }
static const mps_channel channels[] = {LAYER("x", "slow", "the slow"),
                                       LAYER("x", "fast", "the fast"),
                                       LAYER("y", "slow", "the slow"),
                                       LAYER("y", "fast", "the fast"),
                                       {.name = "layers_start",
                                        .unit = "m/s",
                                        .help = "velocity by the tank and the side walls alone",
                                        .components = MPS_VECTOR,
                                        .type = MPS_TYPE_REAL,
                                        .life = MPS_LIFE_STEP}};

enum {
    VELOCITY,
    DENSITY,
    START,
    FIRST_LAYER,
    SHARED_USES = FIRST_LAYER + LAYERS,
    ACCELERATION = SHARED_USES,
    TANK,
    USES
};
#define LAYER_USES                                         \
    [FIRST_LAYER] = {"layers_x_slow", MPS_USE_CHANGE},     \
    [FIRST_LAYER + 1] = {"layers_x_fast", MPS_USE_CHANGE}, \
    [FIRST_LAYER + 2] = {"layers_y_slow", MPS_USE_CHANGE}, \
    [FIRST_LAYER + 3] = {"layers_y_fast", MPS_USE_CHANGE}
static const mps_use force_uses[USES] = {[VELOCITY] = {"velocity", MPS_USE_READ},
                                         [DENSITY] = {"density", MPS_USE_READ},
                                         [START] = {"layers_start", MPS_USE_WRITE},
                                         LAYER_USES,
                                         [ACCELERATION] = {"acceleration", MPS_USE_CHANGE},
                                         [TANK] = {"tank_acceleration", MPS_USE_READ}};
static const mps_use velocity_uses[SHARED_USES] = {[VELOCITY] = {"velocity", MPS_USE_CHANGE},
                                                   [DENSITY] = {"density", MPS_USE_READ},
                                                   [START] = {"layers_start", MPS_USE_READ},
                                                   LAYER_USES};

typedef struct fields {
    const double *density, *tank;
    double *velocity, *acceleration, *start;
    double *layer[LAYERS];
    double *friction;           /* [n*2] contribution of this model to the acceleration */
    double cosine, sine;        /* of the rotation of the tank in this step */
    mps__layers of[MPS_PHASES]; /* of phases */
} fields;

/* Layers of the phases in this step. @return non-zero after a failure */
static int begin(mps_stage *s, fields *f)
{
    const mps_view *v = s->view;
    const double *R = v->tank.rotation, *N = v->tank.next_rotation;
    double rho[MPS_PHASES];
    if (v->dim != 2)
        return mps_stage_fail(s, "is for thin tanks in 2-D: remove the model \"friction\" in 3-D, "
                                 "where the side walls have particles");
    f->velocity = s->data[VELOCITY];
    f->density = s->data[DENSITY];
    f->start = s->data[START];
    for (int k = 0; k < LAYERS; k++) f->layer[k] = s->data[FIRST_LAYER + k];
    f->friction = mps_stage_scratch(s, 2 * v->n);
    if (!f->friction) return 1;
    f->cosine = N[0] * R[0] + N[1] * R[1];
    f->sine = N[3] * R[0] + N[4] * R[1];
    mps_stage_densities(s, rho, NULL);
    for (int p = 0; p < MPS_PHASES; p++)
        if (rho[p] > 0)
            mps__layers_of(v->viscosity[p] / rho[p], v->setting[WIDTH], v->dt, &f->of[p]);
    return 0;
}

/* Kinetic energy of the profile in excess of that of its mean. */
MPS_ROW void add_kinetic(const int dim, const mps_view *v, const fields *f, int64_t i, double *sum)
{
    (void)dim;
    if (!mps_is_fluid(v, i)) return;
    const double *energy = f->of[v->phase[i]].energy;
    double e = 0;
    for (int k = 0; k < LAYERS; k++)
        for (int m = 0; m < HALF; m++) {
            const double q = f->layer[k][HALF * i + m];
            e += energy[HALF * (k % 2) + m] * q * q;
        }
    *sum += f->density[i] * v->dp * v->dp * e;
}
MPS_SUMS(add_kinetics, add_kinetic, fields)

static int report_kinetic(mps_stage *s, const fields *f)
{
    double kinetic;
    mps_stage_sum(s, 1, &add_kinetics, f, &kinetic);
    return mps_stage_kinetic(s, kinetic);
}

/* Relative velocity at the beginning of the step; the tank's velocity is that of the previous
 * step. */
MPS_ROW void pull(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    (void)dim;
    if (!mps_is_fluid(v, i)) return;
    const mps__layers *of = &f->of[v->phase[i]];
    double tank[3];
    mps_view_tank(v, v->x + 2 * i, NULL, tank);
    for (int d = 0; d < 2; d++) {
        double *slow = f->layer[2 * d] + HALF * i, *fast = f->layer[2 * d + 1] + HALF * i;
        const double gain = v->dt * f->tank[2 * i + d];
        const double u = f->velocity[2 * i + d] - tank[d] + gain;
        double a = -of->drag * u;
        for (int m = 0; m < HALF; m++) a += of->pull[m] * slow[m] + of->pull[HALF + m] * fast[m];
        a /= 1 + of->added;
        mps__layers_pass(of, 0, HALF, u, v->dt * a, slow);
        mps__layers_pass(of, HALF, HALF, u, v->dt * a, fast);
        f->friction[2 * i + d] = a;
        f->acceleration[2 * i + d] += a;
        f->start[2 * i + d] = f->velocity[2 * i + d] + gain + v->dt * a;
    }
}
MPS_ROWS(pull_rows, pull, fields)

static int pull_fluid(mps_stage *s)
{
    fields f = {.acceleration = s->data[ACCELERATION], .tank = s->data[TANK]};
    if (begin(s, &f) || report_kinetic(s, &f)) return 1;
    mps_stage_rows(s, &pull_rows, &f);
    return mps_stage_reaction(s, parts[0], f.friction);
}

MPS_ROW void follow(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    (void)dim;
    if (!mps_is_fluid(v, i)) return;
    const mps__layers *of = &f->of[v->phase[i]];
    double du[2];
    for (int d = 0; d < 2; d++) {
        double *u = f->velocity + 2 * i + d;
        const double before = *u;
        du[d] = (before - f->start[2 * i + d]) / (1 + of->added);
        *u = f->start[2 * i + d] + du[d];
        f->friction[2 * i + d] = (*u - before) / v->dt;
    }
    for (int k = 0; k < 2; k++)
        for (int m = 0; m < HALF; m++) {
            double *x = f->layer[k] + HALF * i + m, *y = f->layer[2 + k] + HALF * i + m;
            const double p = *x + of->rise[HALF * k + m] * du[0],
                         q = *y + of->rise[HALF * k + m] * du[1];
            *x = f->cosine * p + f->sine * q;
            *y = f->cosine * q - f->sine * p;
        }
}
MPS_ROWS(follow_rows, follow, fields)

static int follow_fluid(mps_stage *s)
{
    fields f = {0};
    if (begin(s, &f)) return 1;
    mps_stage_rows(s, &follow_rows, &f);
    return mps_stage_reaction(s, parts[0], f.friction) || report_kinetic(s, &f);
}

static const mps_verb verbs[] = {{.hook = MPS_FORCE,
                                  .use_count = USES,
                                  .uses = force_uses,
                                  .after = "dissipation",
                                  .run = pull_fluid,
                                  .device = 1},
                                 {.hook = MPS_VELOCITY,
                                  .use_count = SHARED_USES,
                                  .uses = velocity_uses,
                                  .after = "*",
                                  .run = follow_fluid,
                                  .device = 1}};

const mps_model_ops mps__friction_history = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "friction.history",
    .help = "Friction with history at the side walls of a thin tank that is computed in 2-D",
    .setting_count = SETTINGS,
    .channel_count = sizeof channels / sizeof channels[0],
    .settings = settings,
    .channels = channels,
    .verb_count = 2,
    .verbs = verbs,
    .part_count = 1,
    .parts = parts};

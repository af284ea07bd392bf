/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction at the two side walls of a thin tank that is computed in 2-D:
 *   a_i = -rate (u_i - u_tank),  u_i the mean velocity across the width b.
 * The flow between the side walls is laminar and oscillates with `omega`. Its pressure gradient is
 * rho (i w + drag) u, with
 *   drag = i w [1/(1 - tanh(z)/z) - 1],  z = b/2 sqrt(i w/nu);
 * `rate` is the real part of drag. Limits: 12 nu/b^2 (slow: plane Poiseuille flow across the width)
 * and sqrt(2 w nu)/b (fast: two Stokes layers). The imaginary part, the inertia that the layers
 * add, is left out. No preset has this model; without `width` there is no friction. For
 * force probes the side walls are the part "sides". */
#include "helpers.h"
#include <mps/reaction.h>

enum { WIDTH, OMEGA, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [WIDTH] = {"width", "m", "Distance between the side walls", MPS_TYPE_REAL, 1e9, 1e-9, 1e9},
    [OMEGA] = {"omega", "rad/s", "Angular frequency of the flow; 0: slow flow", MPS_TYPE_REAL, 0.0,
               0.0, 1e6}};

static const char *const parts[] = {"sides"};

enum { VELOCITY, DENSITY, ACCELERATION, USES };
static const mps_use uses[USES] = {[VELOCITY] = {"velocity", MPS_USE_READ},
                                   [DENSITY] = {"density", MPS_USE_READ},
                                   [ACCELERATION] = {"acceleration", MPS_USE_CHANGE}};

/* Rigid motion of the tank: velocity u at x, rate of rotation. */
typedef struct rigid {
    double x[2], u[2], rate;
} rigid;

typedef struct fields {
    const double *velocity, *density;
    double *acceleration;
    double *friction; /* [n*dim] what this model adds */
    rigid tank;
} fields;

/* Share of its velocity that a fluid of kinematic viscosity nu loses in a second. */
static double drag_rate(double nu, double width, double omega)
{
    const double s = 0.5 * width * sqrt(0.5 * omega / nu); /* z = (1 + i) s */
    const double most = fmin(s, 300.0);                    /* cosh() ends at 710 */
    if (s < 0.05) return 12.0 * nu / (width * width);
    /* tanh(z) = a + i b, 1 - tanh(z)/z = real + i imaginary */
    const double below = cosh(2 * most) + cos(2 * s);
    const double a = sinh(2 * most) / below, b = sin(2 * s) / below;
    const double real = 1 - (a + b) / (2 * s), imaginary = (a - b) / (2 * s);
    return omega * imaginary / (real * real + imaginary * imaginary);
}

/* Sums over the solids: of x (2), of u (2), of 1. */
MPS_ROW void add_solid(const int dim, const mps_view *view, const fields *f, int64_t i,
                       double *sums)
{
    (void)dim;
    if (mps_is_fluid(view, i)) return;
    for (int d = 0; d < 2; d++) {
        sums[d] += view->x[2 * i + d];
        sums[2 + d] += f->velocity[2 * i + d];
    }
    sums[4]++;
}
MPS_SUMS(add_solid_rows, add_solid, fields)

/* Sums over the solids: of the moment of the velocity about the mean of x, of the inertia. */
MPS_ROW void add_moment(const int dim, const mps_view *view, const fields *f, int64_t i,
                        double *sums)
{
    (void)dim;
    if (mps_is_fluid(view, i)) return;
    const rigid *m = &f->tank;
    const double x = view->x[2 * i] - m->x[0], y = view->x[2 * i + 1] - m->x[1];
    sums[0] += x * (f->velocity[2 * i + 1] - m->u[1]) - y * (f->velocity[2 * i] - m->u[0]);
    sums[1] += x * x + y * y;
}
MPS_SUMS(add_moment_rows, add_moment, fields)

/* Motion of the tank from its particles. */
static void find_motion(const mps_stage *s, fields *f)
{
    double solids[5], moments[2];
    mps_stage_sum(s, 5, &add_solid_rows, f, solids);
    for (int d = 0; d < 2 && solids[4] > 0; d++) {
        f->tank.x[d] = solids[d] / solids[4];
        f->tank.u[d] = solids[2 + d] / solids[4];
    }
    mps_stage_sum(s, 2, &add_moment_rows, f, moments);
    if (moments[1] > 0) f->tank.rate = moments[0] / moments[1];
}

/* The rate is a mean over the step, so that a step of any length removes at most the velocity. */
MPS_ROW void slow_down(const int dim, const mps_view *view, const fields *f, int64_t i)
{
    (void)dim;
    if (!mps_is_fluid(view, i)) return;
    const double *k = view->setting, nu = view->viscosity[view->phase[i]] / f->density[i];
    if (nu == 0) return;
    const double rate = -expm1(-view->dt * drag_rate(nu, k[WIDTH], k[OMEGA])) / view->dt;
    const double x = view->x[2 * i] - f->tank.x[0], y = view->x[2 * i + 1] - f->tank.x[1];
    const double *u = f->velocity + 2 * i, *v = f->tank.u, turn = f->tank.rate;
    f->friction[2 * i] = -rate * (u[0] - v[0] + turn * y);
    f->friction[2 * i + 1] = -rate * (u[1] - v[1] - turn * x);
    for (int d = 0; d < 2; d++) f->acceleration[2 * i + d] += f->friction[2 * i + d];
}
MPS_ROWS(slow_down_rows, slow_down, fields)

static int slow_down_fluid(mps_stage *s)
{
    if (s->view->dim != 2)
        return mps_stage_fail(s, "is for thin tanks in 2-D: remove the model \"friction\" in 3-D, "
                                 "where the side walls have particles");
    fields f = {.velocity = s->data[VELOCITY],
                .density = s->data[DENSITY],
                .acceleration = s->data[ACCELERATION],
                .friction = mps_stage_scratch(s, s->view->n * s->view->dim)};
    if (!f.friction) return 1;
    find_motion(s, &f);
    mps_stage_rows(s, &slow_down_rows, &f);
    return mps_stage_reaction(s, parts[0], f.friction);
}

static const mps_verb verbs[] = {{.hook = MPS_FORCE,
                                  .use_count = USES,
                                  .uses = uses,
                                  .after = "dissipation",
                                  .run = slow_down_fluid}};

const mps_model_ops mps__friction_sides = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "friction.sides",
    .help = "Friction at the side walls of a thin tank that is computed in 2-D",
    .setting_count = SETTINGS,
    .settings = settings,
    .verb_count = 1,
    .verbs = verbs,
    .part_count = 1,
    .parts = parts};

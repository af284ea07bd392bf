/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction at the two side walls of a thin tank that is computed in 2-D: a_i = -rate (u_i - u_tank), u_i being the mean velocity across the width b.
 * The flow between the side walls is laminar and oscillates with `omega`: the pressure gradient G of u e^{i w t} is rho (i w + drag) u with
 *   drag = i w [1/(1 - tanh(z)/z) - 1],  z = b/2 sqrt(i w/nu);
 * rate is its real part. Its limits are 12 nu/b^2 (slow: plane Poiseuille flow across the width) and sqrt(2 w nu)/b (fast: two Stokes layers). The
 * imaginary part, by which the layers add to the inertia, is left out. In no preset; without `width` there is no friction. */
#include "builtin.h"

enum { WIDTH, OMEGA };
static const mps_setting settings[] = {{"width", 1e9, 1e-9, 1e9}, {"omega", 0.0, 0.0, 1e6}};

/* Share of its velocity that a fluid of kinematic viscosity nu loses in a second. */
static double drag_rate(double nu, double width, double omega)
{
    const double s = 0.5 * width * sqrt(0.5 * omega / nu), most = fmin(s, 300.0); /* z = (1 + i) s; cosh() ends at 710 */
    if (s < 0.05) return 12.0 * nu / (width * width);
    const double below = cosh(2 * most) + cos(2 * s), a = sinh(2 * most) / below, b = sin(2 * s) / below; /* tanh z = a + i b */
    const double real = 1 - (a + b) / (2 * s), imaginary = (a - b) / (2 * s);                             /* 1 - tanh(z)/z */
    return omega * imaginary / (real * real + imaginary * imaginary);
}

/* Rigid motion of the tank, by its particles: velocity u at x, rate of rotation. */
typedef struct rigid {
    double x[2], u[2], rate;
} rigid;

static rigid tank_motion(const mps_stage *s)
{
    rigid m = {{0}, {0}, 0};
    double count = 0, moment = 0, inertia = 0;
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] == MPS_FLUID) continue;
        for (int d = 0; d < 2; d++) {
            m.x[d] += s->x[2 * i + d];
            m.u[d] += s->u[2 * i + d];
        }
        count++;
    }
    for (int d = 0; d < 2 && count > 0; d++) {
        m.x[d] /= count;
        m.u[d] /= count;
    }
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] == MPS_FLUID) continue;
        const double x = s->x[2 * i] - m.x[0], y = s->x[2 * i + 1] - m.x[1];
        moment += x * (s->u[2 * i + 1] - m.u[1]) - y * (s->u[2 * i] - m.u[0]);
        inertia += x * x + y * y;
    }
    if (inertia > 0) m.rate = moment / inertia;
    return m;
}

static int force(void *self, const double *k, mps_stage *s, double *a)
{
    (void)self;
    if (s->dim != 2) return mps_stage_fail(s, "is for thin tanks in 2-D; in 3-D the side walls are there");
    const rigid tank = tank_motion(s);
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        const double nu = s->viscosity[s->phase[i]] / s->density[i];
        if (s->kind[i] != MPS_FLUID || nu == 0) continue;
        /* the mean over the step: a step of any length only takes what there is */
        const double rate = -expm1(-s->dt * drag_rate(nu, k[WIDTH], k[OMEGA])) / s->dt;
        const double x = s->x[2 * i] - tank.x[0], y = s->x[2 * i + 1] - tank.x[1];
        a[2 * i] -= rate * (s->u[2 * i] - tank.u[0] + tank.rate * y);
        a[2 * i + 1] -= rate * (s->u[2 * i + 1] - tank.u[1] - tank.rate * x);
    }
    return 0;
}

const mps_model_ops mps__friction_sides = {.struct_size = sizeof(mps_model_ops),
                                           .api = MPS_MODEL_API,
                                           .name = "friction.sides",
                                           .order = 320,
                                           .setting_count = 2,
                                           .settings = settings,
                                           .force = force};

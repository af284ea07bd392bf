/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction of walls whose boundary layer is thinner than a few spacings: the part that the no-slip
 * condition of viscosity.laplacian and viscosity.pair lacks, with the history of the layer
 * (layers.h).
 *
 * Each wall particle carries the velocities q_k of the modes of its layer, in its tangential plane.
 * w is the mean velocity of the first layer of fluid particles in front of it, relative to the
 * wall. The force acts on these particles with the same weights, reduced if their layer is not
 * full, so that action equals reaction. As in friction.history a part of it acts after all other
 * verbs of MPS_VELOCITY.
 *
 * A wall particle without fluid in front of it loses its layer. Where fluid arrives, a new layer
 * grows.
 *
 * The momentum of the half cells beside walls, which have no particles, is assigned to the first
 * layer of particles. So in steady flow the velocity is 0 half a spacing inside the face: disable
 * the model where the flow between walls is resolved. The term `friction` of the energy budget
 * contains the work of the walls; the kinetic energy of these layers is not listed separately. */
#include "helpers.h"
#include "layers.h"
#include <mps/reaction.h>
#include <string.h>

/* Modes in a channel; each direction has two channels. */
enum { HALF = MPS__LAYERS / 2, LAYERS = 6 };

#define LAYER(axis, which)                                                                         \
    {                                                                                              \
        .name = "wall_layer_" axis "_" which, .unit = "m/s",                                       \
        .help = "velocity along " axis " that the " which " modes of a wall's layer have reached", \
        .components = HALF, .type = MPS_TYPE_REAL, .life = MPS_LIFE_PARTICLE                       \
    }
static const mps_channel channels[] = {
    LAYER("x", "slow"),
    LAYER("x", "fast"),
    LAYER("y", "slow"),
    LAYER("y", "fast"),
    LAYER("z", "slow"),
    LAYER("z", "fast"),
    {.name = "wall_layer_start",
     .unit = "m/s",
     .help = "velocity of fluid by the tank and the layers alone",
     .components = MPS_VECTOR,
     .type = MPS_TYPE_REAL,
     .life = MPS_LIFE_STEP},
    {.name = "wall_layer_flow",
     .unit = "m/s",
     .help = "velocity of the fluid before a wall, relative to it",
     .components = MPS_VECTOR,
     .type = MPS_TYPE_REAL,
     .life = MPS_LIFE_STEP}};

enum {
    VELOCITY,
    DENSITY,
    TANK,
    START,
    FLOW,
    FIRST_LAYER,
    ACCELERATION = FIRST_LAYER + LAYERS,
    USES
};
#define LAYER_USES                                             \
    [FIRST_LAYER] = {"wall_layer_x_slow", MPS_USE_CHANGE},     \
    [FIRST_LAYER + 1] = {"wall_layer_x_fast", MPS_USE_CHANGE}, \
    [FIRST_LAYER + 2] = {"wall_layer_y_slow", MPS_USE_CHANGE}, \
    [FIRST_LAYER + 3] = {"wall_layer_y_fast", MPS_USE_CHANGE}, \
    [FIRST_LAYER + 4] = {"wall_layer_z_slow", MPS_USE_CHANGE}, \
    [FIRST_LAYER + 5] = {"wall_layer_z_fast", MPS_USE_CHANGE}
static const mps_use force_uses[USES] = {
    [VELOCITY] = {"velocity", MPS_USE_NEIGHBOURS},    [DENSITY] = {"density", MPS_USE_NEIGHBOURS},
    [TANK] = {"tank_acceleration", MPS_USE_READ},     [START] = {"wall_layer_start", MPS_USE_WRITE},
    [FLOW] = {"wall_layer_flow", MPS_USE_WRITE},      LAYER_USES,
    [ACCELERATION] = {"acceleration", MPS_USE_CHANGE}};
static const mps_use velocity_uses[ACCELERATION] = {
    [VELOCITY] = {"velocity", MPS_USE_NEIGHBOURS | MPS_USE_CHANGE},
    [DENSITY] = {"density", MPS_USE_NEIGHBOURS},
    [TANK] = {"tank_acceleration", MPS_USE_READ},
    [START] = {"wall_layer_start", MPS_USE_NEIGHBOURS},
    [FLOW] = {"wall_layer_flow", MPS_USE_READ},
    LAYER_USES};

typedef struct fields {
    const double *density, *tank;
    double *velocity, *acceleration, *start, *flow;
    double *layer[LAYERS];
    double *friction; /* [n*dim] contribution of this model to the acceleration of fluid */
    double *push;     /* [n*dim] of walls: velocity change of a full first layer, over `total` */
    double *total;    /* [n] of walls: sum of the weights of the fluid; 0: none */
    double full;      /* `total` for a full layer */
    double turn[9];   /* rotation of the tank in this step */
} fields;

/* Weight of fluid particle j in the first layer in front of wall particle i, with the unit
 * normal. */
MPS_ROW double share_of(const int dim, const mps_view *v, const mps_pair *q, const double *x_wall,
                        const double *x, const double *normal)
{
    double h = 0;
    for (int d = 0; d < dim; d++) h += (x[d] - x_wall[d]) * normal[d];
    h /= v->dp;
    return h < 0 || h >= 2 ? 0 : q->w * (h < 1 ? 1 : 2 - h);
}

/* Unit normal into the fluid; false: none. @param area  out, over dp^(dim-1) */
MPS_ROW bool normal_of(const int dim, const mps_view *v, int64_t i, double normal[3], double *area)
{
    double square = 0;
    for (int d = 0; d < dim; d++) square += v->area[i * dim + d] * v->area[i * dim + d];
    if (!mps_is_wall(v, i) || !(square > 0)) return false;
    const double size = sqrt(square);
    for (int d = 0; d < dim; d++) normal[d] = v->area[i * dim + d] / size;
    *area = size / (dim == 2 ? v->dp : v->dp * v->dp);
    return true;
}

MPS_ROW void keep_tangential(const int dim, const double *normal, double *u)
{
    double along = 0;
    for (int d = 0; d < dim; d++) along += u[d] * normal[d];
    for (int d = 0; d < dim; d++) u[d] -= along * normal[d];
}

/* Means over the first layer in front of a wall. */
typedef struct row_mean {
    double total, rho, mu, u[3], other[3], tank[3];
} row_mean;

/* `other`: a vector of fluid, or NULL. Sums are divided by `total`; of a dry wall it is 0. */
MPS_ROW row_mean mean_before(const int dim, const mps_view *v, const fields *f, const double *other,
                             int64_t i, const double *normal)
{
    const mps_stencil *t = &v->near;
    row_mean m = {0};
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        double tank[3];
        if (!mps_is_fluid(v, j)) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        const double share = share_of(dim, v, &q, v->x + i * dim, v->x + j * dim, normal);
        if (share == 0) continue;
        mps_view_tank(v, v->x + j * dim, NULL, tank);
        m.total += share;
        m.rho += share * f->density[j];
        m.mu += share * v->viscosity[v->phase[j]];
        for (int d = 0; d < dim; d++) {
            m.u[d] += share * f->velocity[j * dim + d];
            if (other) m.other[d] += share * other[j * dim + d];
            m.tank[d] += share * tank[d];
        }
    }
    if (!(m.total > 0)) return (row_mean){0};
    m.rho /= m.total;
    m.mu /= m.total;
    for (int d = 0; d < dim; d++) {
        m.u[d] /= m.total;
        m.other[d] /= m.total;
        m.tank[d] /= m.total;
    }
    return m;
}

MPS_ROW void lose_layer(const int dim, const fields *f, int64_t i)
{
    for (int k = 0; k < 2 * dim; k++) memset(f->layer[k] + HALF * i, 0, HALF * sizeof(double));
}

/* Acceleration of a full first layer in front of wall i, by w and the boundary layer at the
 * beginning of the step. */
MPS_ROW void pull(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    double normal[3], area, tank[3];
    mps__layers of;
    if (!normal_of(dim, v, i, normal, &area)) return;
    const row_mean m = mean_before(dim, v, f, NULL, i, normal);
    f->total[i] = m.total;
    if (m.total == 0) {
        lose_layer(dim, f, i);
        return;
    }
    mps_view_tank(v, v->x + i * dim, NULL, tank);
    mps__layers_of_wall(dim, v->far.re / v->dp, m.mu / m.rho, v->dp, v->dt, &of);
    double *w = f->flow + i * dim, *a = f->push + i * dim;
    for (int d = 0; d < dim; d++)
        w[d] = m.u[d] - f->velocity[i * dim + d] - (m.tank[d] - tank[d]) +
               v->dt * f->tank[i * dim + d];
    keep_tangential(dim, normal, w);
    for (int d = 0; d < dim; d++) {
        a[d] = -of.drag * w[d];
        for (int k = 0; k < MPS__LAYERS; k++)
            a[d] += of.pull[k] * f->layer[2 * d + k / HALF][HALF * i + k % HALF];
    }
    keep_tangential(dim, normal, a);
    for (int d = 0; d < dim; d++)
        a[d] *= area * m.rho / ((1 + of.added) * mps_larger(m.total, f->full));
}
MPS_ROWS(pull_rows, pull, fields)

/* Contributions of all walls to fluid j: sum of weight times push, over its density. */
MPS_ROW void receive(const int dim, const mps_view *v, const fields *f, int64_t j, double sum[3])
{
    const mps_stencil *t = &v->near;
    for (int64_t p = mps_stencil_begin(t, j); p < mps_stencil_end(t, j); p++) {
        const int64_t i = mps_stencil_column(t, p);
        double normal[3], area;
        if (!(mps_is_wall(v, i) && f->total[i] > 0) || !normal_of(dim, v, i, normal, &area))
            continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, j, p);
        const double share = share_of(dim, v, &q, v->x + i * dim, v->x + j * dim, normal);
        for (int d = 0; d < dim; d++) sum[d] += share * f->push[i * dim + d] / f->density[j];
    }
}

MPS_ROW void slow_down(const int dim, const mps_view *v, const fields *f, int64_t j)
{
    double a[3] = {0};
    if (!mps_is_fluid(v, j)) return;
    receive(dim, v, f, j, a);
    for (int d = 0; d < dim; d++) {
        const int64_t k = j * dim + d;
        f->friction[k] = a[d];
        f->acceleration[k] += a[d];
        f->start[k] = f->velocity[k] + v->dt * (f->tank[k] + a[d]);
    }
}
MPS_ROWS(slow_down_rows, slow_down, fields)

/* Sum of weights for a wall particle with a full lattice layer in front of it. */
static double weight_of_row(const mps_view *v)
{
    const int reach = (int)(v->near.re / v->dp) + 1, depth = v->dim == 3 ? reach : 0;
    double sum = 0;
    for (int a = -reach; a <= reach; a++)
        for (int b = -depth; b <= depth; b++) {
            const double r = v->dp * sqrt(1.0 + a * a + b * b);
            if (r < v->near.re) sum += mps_kernel_weight(&v->near.kernel, r, v->near.re);
        }
    return sum;
}

static int begin(mps_stage *s, fields *f)
{
    const mps_view *v = s->view;
    const double *R = v->tank.rotation, *N = v->tank.next_rotation;
    mps__layers any;
    if (!mps__layers_of_wall(v->dim, v->far.re / v->dp, 1, v->dp, v->dt, &any))
        return mps_stage_fail(s, "is for far radii of 2.1, 3.1 and 4.1 dp, this one is %g dp",
                              v->far.re / v->dp);
    f->velocity = s->data[VELOCITY];
    f->density = s->data[DENSITY];
    f->tank = s->data[TANK];
    f->start = s->data[START];
    f->flow = s->data[FLOW];
    for (int k = 0; k < LAYERS; k++) f->layer[k] = s->data[FIRST_LAYER + k];
    f->friction = mps_stage_scratch(s, v->n * v->dim);
    f->push = mps_stage_scratch(s, v->n * v->dim);
    f->total = mps_stage_scratch(s, v->n);
    for (int k = 0; k < 9; k++)
        f->turn[k] = N[k / 3 * 3] * R[k % 3 * 3] + N[k / 3 * 3 + 1] * R[k % 3 * 3 + 1] +
                     N[k / 3 * 3 + 2] * R[k % 3 * 3 + 2];
    f->full = weight_of_row(v);
    return !f->friction || !f->push || !f->total;
}

static int share_push(mps_stage *s, const fields *f)
{
    const mps_shared shared[] = {{f->push, s->view->dim, MPS_TYPE_REAL},
                                 {f->total, 1, MPS_TYPE_REAL}};
    return mps_stage_refresh(s, 2, shared);
}

static int pull_fluid(mps_stage *s)
{
    fields f = {.acceleration = s->data[ACCELERATION]};
    if (begin(s, &f)) return 1;
    mps_stage_rows(s, &pull_rows, &f);
    if (share_push(s, &f)) return 1;
    mps_stage_rows(s, &slow_down_rows, &f);
    return mps_stage_reaction(s, NULL, f.friction);
}

/* Part of the velocity change due to other forces that the added mass of wall i removes. */
MPS_ROW void hold(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    double normal[3], area;
    mps__layers of;
    if (!normal_of(dim, v, i, normal, &area)) return;
    const row_mean now = mean_before(dim, v, f, f->start, i, normal);
    f->total[i] = now.total;
    if (now.total == 0) return;
    mps__layers_of_wall(dim, v->far.re / v->dp, now.mu / now.rho, v->dp, v->dt, &of);
    double *a = f->push + i * dim;
    for (int d = 0; d < dim; d++) a[d] = -(now.u[d] - now.other[d]) * of.added / (1 + of.added);
    keep_tangential(dim, normal, a);
    for (int d = 0; d < dim; d++) a[d] *= area * now.rho / mps_larger(now.total, f->full);
}
MPS_ROWS(hold_rows, hold, fields)

MPS_ROW void write(const int dim, const mps_view *v, const fields *f, int64_t j)
{
    double du[3] = {0};
    if (!mps_is_fluid(v, j)) return;
    receive(dim, v, f, j, du);
    for (int d = 0; d < dim; d++) {
        f->velocity[j * dim + d] += du[d];
        f->friction[j * dim + d] = du[d] / v->dt;
    }
}
MPS_ROWS(write_rows, write, fields)

/* Updates the layer by the flow of this step, and rotates it with the tank. */
MPS_ROW void follow(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    double normal[3], area, tank[3], du[3] = {0};
    mps__layers of;
    if (!normal_of(dim, v, i, normal, &area) || f->total[i] == 0) return;
    const row_mean m = mean_before(dim, v, f, NULL, i, normal);
    mps_view_tank(v, v->x + i * dim, NULL, tank);
    mps__layers_of_wall(dim, v->far.re / v->dp, m.mu / m.rho, v->dp, v->dt, &of);
    const double *w = f->flow + i * dim;
    for (int d = 0; d < dim; d++) du[d] = m.u[d] - f->velocity[i * dim + d] - (m.tank[d] - tank[d]);
    keep_tangential(dim, normal, du);
    for (int d = 0; d < dim; d++) du[d] -= w[d];
    for (int d = 0; d < dim; d++)
        for (int half = 0; half < 2; half++)
            mps__layers_pass(&of, HALF * half, HALF, w[d], du[d],
                             f->layer[2 * d + half] + HALF * i);
    for (int k = 0; k < MPS__LAYERS; k++) {
        double q[3] = {0};
        for (int d = 0; d < dim; d++) q[d] = f->layer[2 * d + k / HALF][HALF * i + k % HALF];
        for (int d = 0; d < dim; d++)
            f->layer[2 * d + k / HALF][HALF * i + k % HALF] = f->turn[3 * d] * q[0] +
                                                              f->turn[3 * d + 1] * q[1] +
                                                              f->turn[3 * d + 2] * q[2];
    }
}
MPS_ROWS(follow_rows, follow, fields)

static int follow_fluid(mps_stage *s)
{
    fields f = {0};
    if (begin(s, &f)) return 1;
    mps_stage_rows(s, &hold_rows, &f);
    if (share_push(s, &f)) return 1;
    mps_stage_rows(s, &write_rows, &f);
    const mps_shared moved = {f.velocity, s->view->dim, MPS_TYPE_REAL};
    if (mps_stage_refresh(s, 1, &moved)) return 1;
    mps_stage_rows(s, &follow_rows, &f);
    return mps_stage_reaction(s, NULL, f.friction);
}

static const mps_verb verbs[] = {{.hook = MPS_FORCE,
                                  .use_count = USES,
                                  .uses = force_uses,
                                  .after = "*",
                                  .run = pull_fluid,
                                  .device = 1},
                                 {.hook = MPS_VELOCITY,
                                  .use_count = ACCELERATION,
                                  .uses = velocity_uses,
                                  .after = "*",
                                  .before = "friction",
                                  .run = follow_fluid,
                                  .device = 1}};

const mps_model_ops mps__layer_history = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "layer.history",
    .help = "Friction with history of walls whose layers are thinner than a few spacings",
    .channel_count = sizeof channels / sizeof channels[0],
    .channels = channels,
    .verb_count = 2,
    .verbs = verbs};

/* SPDX-License-Identifier: BSD-3-Clause */
/* Collisions, W22 (24)(25), W22: Wen, Zhao & Wan 2022. Two fluid particles that are nearer than
 * `distance` and approach each other exchange momentum along their line of centres. A fluid
 * particle nearer than `wall_distance` to a wall loses the normal part of its approach velocity.
 * All pairs use the velocities before the collisions, so that results do not depend on the order of
 * particles. Pairs conserve momentum. */
#include "walls.h"
#include <mps/reaction.h>

enum { DISTANCE, RESTITUTION, WALL_DISTANCE, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [DISTANCE] = {"distance", "dp", "Fluid particles nearer to each other collide", MPS_TYPE_REAL,
                  0.6, 0.0, 1.5},
    [RESTITUTION] = {"restitution", "-", "Speed of separation over speed of approach",
                     MPS_TYPE_REAL, 0.5, 0.0, 1.0},
    [WALL_DISTANCE] = {"wall_distance", "dp", "Fluid nearer to a wall does not approach it",
                       MPS_TYPE_REAL, 0.5, 0.0, 1.5}};

enum { VELOCITY, DENSITY, USES };
static const mps_use uses[USES] = {
    [VELOCITY] = {"velocity", MPS_USE_NEIGHBOURS | MPS_USE_CHANGE},
    [DENSITY] = {"density", MPS_USE_NEIGHBOURS},
};

typedef struct fields {
    double *velocity;
    const double *density;
    double *change; /* [n*dim] of the velocity */
    double *walls;  /* [n*dim] the part due to walls, over dt */
    double least;   /* least_weight() */
} fields;

/* W/r^2 of pairs nearer than `distance` is larger than this value. It excludes most pairs before
 * their distance is computed. */
static double least_weight(const mps_stencil *t, double distance)
{
    if (t->kernel.id == MPS_KERNEL_CUSTOM || !(distance < t->re)) return -1;
    return (mps_kernel_weight(&t->kernel, distance, t->re) - 1e-9) / (distance * distance);
}

/* Change of the velocity of i by its fluid neighbours. Returns whether it has solid neighbours. */
MPS_ROW bool collide_pairs(const int dim, const mps_view *view, const fields *f, int64_t i,
                           double du[3])
{
    const mps_stencil *t = &view->near;
    const double *u = f->velocity, *rho = f->density;
    const double reach = view->setting[DISTANCE] * view->dp, reach2 = reach * reach;
    bool solids = false;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (!mps_is_fluid(view, j)) {
            solids = true;
            continue;
        }
        if (t->w_r2[p] < f->least) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        if (q.r2 >= reach2) continue;
        double approach = 0; /* rate of separation times distance */
        for (int d = 0; d < dim; d++) approach += (u[j * dim + d] - u[i * dim + d]) * q.d[d];
        if (approach >= 0) continue;
        const double share = (1.0 + view->setting[RESTITUTION]) * rho[j] / (rho[i] + rho[j]);
        for (int d = 0; d < dim; d++) du[d] += share * approach / q.r2 * q.d[d];
    }
    return solids;
}

MPS_ROW void collide(const int dim, const mps_view *view, const fields *f, int64_t i)
{
    if (!mps_is_fluid(view, i)) return;
    const double *u = f->velocity + i * dim,
                 wall_distance = view->setting[WALL_DISTANCE] * view->dp;
    double du[3] = {0}, v[3];
    const bool solids = collide_pairs(dim, view, f, i, du);
    for (int d = 0; d < dim; d++) v[d] = u[d] + du[d];
    if (solids) mps__walls_keep_off(dim, view, wall_distance, 0, f->velocity, i, v);
    for (int d = 0; d < dim; d++) {
        f->change[i * dim + d] = v[d] - u[d];
        f->walls[i * dim + d] = (v[d] - (u[d] + du[d])) / view->dt;
    }
}
MPS_ROWS(collide_rows, collide, fields)

MPS_ROW void add_change(const int dim, const mps_view *view, const fields *f, int64_t i)
{
    (void)view;
    for (int d = 0; d < dim; d++) f->velocity[i * dim + d] += f->change[i * dim + d];
}
MPS_ROWS(add_change_rows, add_change, fields)

static int collide_particles(mps_stage *s)
{
    const mps_view *view = s->view;
    fields f = {.velocity = s->data[VELOCITY],
                .density = s->data[DENSITY],
                .change = mps_stage_scratch(s, view->n * view->dim),
                .walls = mps_stage_scratch(s, view->n * view->dim),
                .least = least_weight(&view->near, view->setting[DISTANCE] * view->dp)};
    if (!f.change || !f.walls) return 1;
    mps_stage_rows(s, &collide_rows, &f);
    mps_stage_rows(s, &add_change_rows, &f);
    return mps_stage_reaction(s, NULL, f.walls);
}

static const mps_verb verbs[] = {
    {.hook = MPS_VELOCITY, .use_count = USES, .uses = uses, .run = collide_particles, .device = 1}};

const mps_model_ops mps__collision_pair = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "collision.pair",
    .help = "Collisions of fluid particles that are too near to each other or to a wall",
    .setting_count = SETTINGS,
    .settings = settings,
    .verb_count = 1,
    .verbs = verbs};

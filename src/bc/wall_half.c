/* SPDX-License-Identifier: BSD-3-Clause */
/* Wall particles as half cells: the wall row is the mirrored lattice cut in two, so that fluid
 * pairs count once, wall-wall pairs half, and dummies are omitted (the mirror image of a dummy is
 * the particle itself). Exact on a lattice, in corners too.
 *
 * A wall particle counts with its wetted fraction:
 *   wetted_share = sum W over the fluid / sum W over a half space full of fluid, at most 1.
 * A wall particle without fluid is DRY. */
#include "helpers.h"

/* Limit of W/r^2 relative to that of the nearest fluid particle, see density_beside(). */
static const double NEARLY = 0.7;

/* A fluid particle is in front of a face from this height above its plane on [dp]. */
static const double ABOVE = 0.1;

enum { DENSITY, REGION, WETTED_SHARE, PRESSURE_DENSITY, WALL_FACTOR, USES };
static const mps_use uses[USES] = {[DENSITY] = {"density", MPS_USE_NEIGHBOURS},
                                   [REGION] = {"region", MPS_USE_NEIGHBOURS | MPS_USE_CHANGE},
                                   [WETTED_SHARE] = {"wetted_share", MPS_USE_WRITE},
                                   [PRESSURE_DENSITY] = {"pressure_density", MPS_USE_WRITE},
                                   [WALL_FACTOR] = {"equation_wall_factor", MPS_USE_WRITE}};

static const mps_channel channels[] = {
    {.name = "wetted_share",
     .unit = "-",
     .help = "Share 0..1 of the fluid side of a wall particle that holds fluid",
     .components = 1,
     .type = MPS_TYPE_REAL,
     .life = MPS_LIFE_STEP,
     .initial = 1.0}};

typedef struct fields {
    const double *density;
    int32_t *region; /* written for walls, read for fluid */
    double *wetted_share, *pressure_density;
    double full; /* kernel sum over a half space */
} fields;

/* Kernel sum over a half lattice without its boundary layer. */
static double half_sum(const mps_stencil *t)
{
    const int reach = (int)(t->re / t->dp) + 1, across = t->dim == 3 ? reach : 0;
    double sum = 0;
    for (int k = -across; k <= across; k++)
        for (int j = 1; j <= reach; j++)
            for (int i = -reach; i <= reach; i++) {
                const double r = t->dp * sqrt((double)(i * i + j * j + k * k));
                if (r < t->re) sum += mps_kernel_weight(&t->kernel, r, t->re);
            }
    return sum;
}

/* Kernel sum over the fluid. Spray does not count: a wall particle whose other neighbours are all
 * walls would make the system singular. Fluid that is completely behind the plane of the face does
 * not count either: beyond an edge a wall would take the pressure of liquid in front of the other
 * face. */
MPS_ROW double fluid_sum(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    const double *area = v->area + i * dim;
    double sum = 0, size = 0;
    for (int d = 0; d < dim; d++) size += area[d] * area[d];
    bool before = size == 0;
    const double least = ABOVE * v->dp * sqrt(size);
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (!mps_is_fluid(v, j) || mps_region_of(f->region, j) == MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        double height = 0;
        for (int d = 0; d < dim; d++) height += q.d[d] * area[d];
        before = before || height > least;
        sum += q.w;
    }
    return before ? sum : 0;
}

/* Density of the fluid beside a wall particle: that of the nearest fluid particle, and of others at
 * nearly the same distance (W/r^2 more than NEARLY of that of the nearest, some 7 % in distance).
 * With the nearest alone, the row and its pressure would change from gas to water within a step
 * where a wave runs up the wall. Counting more distant ones changes the pressures of a still tank
 * by 0.1 % of rho g h. */
MPS_ROW double density_beside(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    double nearest = 0, rho = f->density[i], sum = 0, weight = 0;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (!mps_is_fluid(v, j) || mps_region_of(f->region, j) == MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        if (q.w_r2 <= nearest) continue;
        nearest = q.w_r2;
        rho = f->density[j];
    }
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i) && nearest > 0; p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (!mps_is_fluid(v, j) || mps_region_of(f->region, j) == MPS_REGION_SPRAY) continue;
        const double nearly = mps_larger(0, mps_stencil_pair_dim(dim, t, i, p).w_r2 / nearest -
                                                NEARLY);
        sum += nearly * nearly * (f->density[j] - rho);
        weight += nearly * nearly;
    }
    return weight > 0 ? rho + sum / weight : rho;
}

MPS_ROW void wall_row(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    if (!mps_is_wall(v, i)) return;
    const double sum = fluid_sum(dim, v, f, i);
    f->wetted_share[i] = sum < f->full ? sum / f->full : 1.0;
    if (sum == 0) f->region[i] = MPS_REGION_DRY;
    f->pressure_density[i] = density_beside(dim, v, f, i);
}
MPS_ROWS(wall_rows, wall_row, fields)

static int wet_walls(mps_stage *s)
{
    fields f = {.density = s->data[DENSITY],
                .region = s->data[REGION],
                .wetted_share = s->data[WETTED_SHARE],
                .pressure_density = s->data[PRESSURE_DENSITY],
                .full = half_sum(&s->view->near)};
    *(double *)s->data[WALL_FACTOR] = 0.5;
    mps_stage_rows(s, &wall_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {{.hook = MPS_CLASSIFY,
                                  .use_count = USES,
                                  .uses = uses,
                                  .after = "surface",
                                  .run = wet_walls,
                                  .device = 1}};

const mps_model_ops mps__wall_half = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "wall.half",
    .help = "Wall particles as half cells of the pressure equation",
    .channel_count = 1,
    .channels = channels,
    .verb_count = 1,
    .verbs = verbs};

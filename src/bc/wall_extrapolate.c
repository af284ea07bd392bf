/* SPDX-License-Identifier: BSD-3-Clause */
/* Walls of the papers: wall particles are rows of the pressure equation, as fluid particles are.
 * Dummies have no row; they get the kernel mean of the fluid and wall pressures around them. */
#include "helpers.h"

/* ---- density of solids ----------------------------------------------------------------------- */

enum { DENSITY, REGION, PRESSURE_DENSITY, DENSITY_USES };
static const mps_use density_uses[DENSITY_USES] = {
    [DENSITY] = {"density", MPS_USE_NEIGHBOURS | MPS_USE_DUMMIES},
    [REGION] = {"region", MPS_USE_NEIGHBOURS | MPS_USE_DUMMIES},
    [PRESSURE_DENSITY] = {"pressure_density", MPS_USE_WRITE}};

typedef struct densities {
    const double *density;
    const int32_t *region;
    double *pressure_density;
} densities;

/* Density of the fluid nearest to a solid particle, except spray; without fluid near, its own
 * density. */
MPS_ROW double density_beside(const int dim, const mps_view *v, const densities *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    double density = f->density[i], nearest = INFINITY;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (!mps_is_fluid(v, j) || mps_region_of(f->region, j) == MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        if (q.r2 >= nearest) continue;
        nearest = q.r2;
        density = f->density[j];
    }
    return density;
}

MPS_ROW void density_row(const int dim, const mps_view *v, const densities *f, int64_t i)
{
    if (!mps_is_fluid(v, i)) f->pressure_density[i] = density_beside(dim, v, f, i);
}
MPS_ROWS(density_rows, density_row, densities)

/* Solids have no density of their own: beside gas they must not have the density of water. */
static int take_densities(mps_stage *s)
{
    densities f = {.density = s->data[DENSITY],
                   .region = s->data[REGION],
                   .pressure_density = s->data[PRESSURE_DENSITY]};
    mps_stage_rows(s, &density_rows, &f);
    return 0;
}

/* ---- pressures of dummies -------------------------------------------------------------------- */

enum { PRESSURE, PRESSURE_USES };
static const mps_use pressure_uses[PRESSURE_USES] = {
    [PRESSURE] = {"pressure", MPS_USE_NEIGHBOURS | MPS_USE_DUMMIES | MPS_USE_CHANGE}};

typedef struct pressures {
    double *pressure; /* written for dummies, read for the other particles */
} pressures;

MPS_ROW void dummy_row(const int dim, const mps_view *v, const pressures *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    if (!mps_is_dummy(v, i)) return;
    double sum = 0, weight = 0;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        if (mps_is_dummy(v, q.j)) continue;
        sum += q.w * f->pressure[q.j];
        weight += q.w;
    }
    f->pressure[i] = weight > 0 ? sum / weight : 0;
}
MPS_ROWS(dummy_rows, dummy_row, pressures)

static int extrapolate(mps_stage *s)
{
    pressures f = {.pressure = s->data[PRESSURE]};
    mps_stage_rows(s, &dummy_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {{.hook = MPS_PREPARE,
                                  .use_count = DENSITY_USES,
                                  .uses = density_uses,
                                  .run = take_densities,
                                  .device = 1},
                                 {.hook = MPS_LEVEL,
                                  .use_count = PRESSURE_USES,
                                  .uses = pressure_uses,
                                  .after = "reference",
                                  .run = extrapolate,
                                  .device = 1}};

const mps_model_ops mps__wall_extrapolate = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "wall.extrapolate",
    .help = "Walls of the papers: dummies take the mean pressure of their neighbours",
    .verb_count = 2,
    .verbs = verbs};

/* SPDX-License-Identifier: BSD-3-Clause */
/* A connected volume of fluid without a wetted wall around it falls freely.
 *
 * Pressures are relative to a fluid that moves with the tank, b = g - a_tank. This is exact where
 * the tank supports the fluid. A droplet is not supported, and where the eigenvalues of M_i are
 * bounded (moments.bounded), gradients return only part of b: droplets of some ten particles fell
 * at 0.6-0.95 g, and a tank carried along droplets that it did not touch. So in a free volume
 * a_tank is set to g, which gives b = 0. In large volumes few particles are bounded: a volume of
 * more than LARGE particles counts as supported. A volume without surface particle is not
 * changed. */
#include "helpers.h"

enum { LARGE = 1000 };

enum { REGION, TANK_ACCELERATION, USES };
static const mps_use uses[USES] = {[REGION] = {"region", MPS_USE_READ},
                                   [TANK_ACCELERATION] = {"tank_acceleration", MPS_USE_WRITE}};

typedef struct fields {
    const int32_t *region;
    double *tank_acceleration;
    int32_t *role, *body; /* [n] MPS_BODY_...; number of a free volume, or -1 */
} fields;

/* Wetted solids support the fluid beside them. Spray and dry solids do not count. */
MPS_ROW void role_row(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    (void)dim;
    if (mps_region_of(f->region, i) >= MPS_REGION_SPRAY)
        f->role[i] = MPS_BODY_NONE;
    else if (!mps_is_fluid(v, i))
        f->role[i] = MPS_BODY_ANCHOR;
    else
        f->role[i] = mps_region_of(f->region, i) == MPS_REGION_SURFACE ? MPS_BODY_SEED
                                                                       : MPS_BODY_MEMBER;
}
MPS_ROWS(role_rows, role_row, fields)

MPS_ROW void free_row(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    if (f->body[i] < 0) return;
    for (int d = 0; d < dim; d++) f->tank_acceleration[i * dim + d] = v->g[d];
}
MPS_ROWS(free_rows, free_row, fields)

static int free_bodies(mps_stage *s)
{
    fields f = {.region = s->data[REGION],
                .tank_acceleration = s->data[TANK_ACCELERATION],
                .role = mps_stage_scratch_integers(s, s->view->n),
                .body = mps_stage_scratch_integers(s, s->view->n)};
    if (!f.role || !f.body) return 1;
    mps_stage_rows(s, &role_rows, &f);
    if (mps_stage_bodies(s, LARGE, f.role, f.body)) return 1;
    mps_stage_rows(s, &free_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_PREPARE, .use_count = USES, .uses = uses, .run = free_bodies, .device = 1}};

const mps_model_ops mps__body_free = {.struct_size = sizeof(mps_model_ops),
                                      .api = MPS_MODEL_API,
                                      .name = "body.free",
                                      .help = "Bodies of fluid that touch no wall fall with g",
                                      .verb_count = 1,
                                      .verbs = verbs};

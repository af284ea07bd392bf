/* SPDX-License-Identifier: BSD-3-Clause */
/* When and how the model gas.pocket searches for voids. While there is no pocket, no raster is
 * needed in each step: a void closes while the surface of the liquid moves by several spacings. So
 * the search is repeated when the fastest surface particle may have moved by one spacing, and after
 * MOST steps, for particles added by users. Displacement and number of steps since the last search
 * are in the state of the model, so that all ranks and a restart search in the same steps. */
#include "gas_pocket.h"

static const double MOST = 16;

typedef struct surface {
    const double *velocity;
    const int32_t *region;
} surface;

/* Squared velocity of the surface of the liquid relative to the tank. */
MPS_ROW void raise_speed(const int dim, const mps_view *v, const surface *f, int64_t i,
                         double *most)
{
    const double *u = f->velocity + i * dim;
    double tank[3] = {0}, square = 0;
    if (!mps_is_fluid(v, i) || mps_region_of(f->region, i) != MPS_REGION_SURFACE) return;
    mps_view_tank(v, v->x + i * dim, NULL, tank);
    for (int d = 0; d < dim; d++) square += (u[d] - tank[d]) * (u[d] - tank[d]);
    most[0] = mps_larger(most[0], square);
}
MPS_SUMS(raise_speeds, raise_speed, surface)

/* Largest displacement of the surface since the last search. */
static double moved_since(mps_stage *s, const surface *f, const mps__pocket_head *head)
{
    double most = 0;
    mps_stage_max(s, 1, &raise_speeds, f, &most);
    return head->moved + head->dt * sqrt(mps_larger(0, most));
}

int mps__pocket_wait(mps_stage *s, const double *velocity, const int32_t *region, bool *waits)
{
    const mps__pocket_old old = mps__pocket_read(s);
    *waits = old.head && old.head->pockets == 0 && old.head->waited + 1 < MOST;
    if (!*waits) return 0;
    const double moved = moved_since(s, &(surface){velocity, region}, old.head);
    *waits = moved < s->view->dp;
    if (!*waits) return 0;
    mps__pocket_head *head = mps__pocket_open(s, NULL);
    if (!head) return 1;
    head->moved = moved;
    head->waited++;
    head->dt = s->view->dt;
    return 0;
}

double mps__pocket_power(double side, int32_t dim)
{
    return dim == 2 ? side * side : side * side * side;
}

int mps__pocket_look(mps_stage *s, mps__pocket_faces *f)
{
    mps_voids_config config;
    mps_voids *v = &f->voids;
    const double side = s->view->setting[MPS__POCKET_LEAST];
    if (mps_voids_config_init(&config, sizeof config) != MPS_OK ||
        mps_voids_init(v, sizeof *v) != MPS_OK)
        return mps_stage_fail(s, "the voids cannot be looked for");
    config.least = 0.5 * mps__pocket_power(side, s->view->dim);
    f->cover = (s->view->dim == 2 ? 0.72 : 0.9) * s->view->dp;
    return mps_stage_voids(s, &config, v);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Void spaces of the tank for verbs of models: mps/voids.h. */
#include "step.h"
#include <string.h>

static const mps_voids_config no_config = {.struct_size = sizeof no_config};

mps_status mps_voids_config_init(mps_voids_config *config, size_t size)
{
    return mps__struct_init("mps_voids_config", config, size, &no_config, sizeof no_config);
}

mps_status mps_voids_init(mps_voids *voids, size_t size)
{
    static const mps_voids none = {.struct_size = sizeof none};
    return mps__struct_init("mps_voids", voids, size, &none, sizeof none);
}

static double given_or(double value, double usual)
{
    return value == 0 ? usual : value;
}

/* The caller's config, with defaults filled in. */
static mps_status read_config(mps__context *c, int32_t dim, const mps_voids_config *given,
                              mps_voids_config *own)
{
    *own = no_config;
    if (given) MPS__TRY(mps__struct_in(c, "mps_voids_config", own, sizeof *own, given));
    own->side = given_or(own->side, dim == 2 ? 0.5 : 1.0);
    own->cover = given_or(own->cover, dim == 2 ? 0.72 : 0.9);
    own->channel = given_or(own->channel, dim == 2 ? 0.9 : 1.1);
    MPS__CHECK(c, own->side >= 0.25 && own->side <= 2,
               "mps_voids_config.side is %g dp: must be 0.25..2", own->side);
    MPS__CHECK(c, own->cover >= 0.5 && own->cover <= 3,
               "mps_voids_config.cover is %g dp: must be 0.5..3", own->cover);
    MPS__CHECK(c, own->channel >= own->cover && own->channel <= 3,
               "mps_voids_config.channel is %g dp: must be cover..3, %g..3", own->channel,
               own->cover);
    MPS__CHECK(c, own->least >= 0 && isfinite(own->least),
               "mps_voids_config.least is %g dp^%d: must be >= 0", own->least, (int)dim);
    return MPS_OK;
}

static bool same_config(const mps_voids_config *a, const mps_voids_config *b)
{
    return a->side == b->side && a->cover == b->cover && a->channel == b->channel &&
           a->least == b->least;
}

/* The particle nearest to a cell must be known on the ranks of all other candidates. */
static mps_status check_reach(const mps__world *w, const mps_voids_config *c)
{
    const double wanted = 2 * c->channel * w->setup.dp;
    MPS__CHECK(w->context, !mps__ranks_many(&w->ranks) || w->ghosts.reach >= wanted,
               "on many ranks a model that calls mps_stage_voids() must see as far as 2 channel dp "
               "= %g m, and sees %g m: give it a 'reach'",
               wanted, w->ghosts.reach);
    return MPS_OK;
}

static mps_status find_voids(mps__world *w, mps_stage *s)
{
    mps__voids *v = &w->voids;
    MPS__TRY(check_reach(w, &v->config));
    MPS__TRY(mps__voids_raster(v, w));
    if (v->total == 0) return MPS_OK;
    MPS__TRY(mps__voids_liquid(v, w, s));
    MPS__TRY(mps__voids_cells(v, w));
    MPS__TRY(mps__voids_label(v, w));
    return mps__voids_faces(v, w);
}

static void show(const mps__voids *v, mps_voids *out)
{
    *out = (mps_voids){.struct_size = sizeof *out,
                       .dim = v->dim,
                       .side = v->side,
                       .count = v->count,
                       .label = v->label,
                       .size = v->size,
                       .faces = v->faces,
                       .face_label = v->face[MPS__VOID_FACE_LABEL],
                       .face_cell = v->face[MPS__VOID_FACE_CELL],
                       .face_side = v->face[MPS__VOID_FACE_SIDE],
                       .face_behind = v->face[MPS__VOID_FACE_BEHIND],
                       .face_row = v->face[MPS__VOID_FACE_ROW]};
    memcpy(out->origin, v->origin, sizeof out->origin);
    memcpy(out->cells, v->cells, sizeof out->cells);
}

int mps_stage_voids(mps_stage *s, const mps_voids_config *config, mps_voids *voids)
{
    mps__runner *h = s->host;
    mps_voids_config own;
    mps_voids found;
    if (s->hook < MPS_PREPARE)
        return mps_stage_fail(s, "mps_stage_voids() was called before MPS_PREPARE: regions of "
                                 "particles are not known yet");
    mps__runner_switch_to_host(s); /* the algorithm runs on the host */
    mps__world *w = ((mps__step *)h->step)->w;
    mps_status status = read_config(h->context, w->setup.dim, config, &own);
    if (status == MPS_OK) status = mps__struct_check(h->context, "mps_voids", voids);
    if (status == MPS_OK && !(w->voids.ready && same_config(&own, &w->voids.config))) {
        w->voids.ready = false;
        w->voids.config = own;
        status = find_voids(w, s);
        w->voids.ready = status == MPS_OK;
        if (status < 0) w->voids.constant = INT32_MAX;
    }
    h->no_memory = h->no_memory || status == MPS_E_NOMEM;
    if (status < 0) return 1;
    show(&w->voids, &found);
    return mps__struct_out(h->context, "mps_voids", voids, &found, sizeof found) < 0;
}

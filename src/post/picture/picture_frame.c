/* SPDX-License-Identifier: BSD-3-Clause */
/* Scenes of the frames in a run's folder. */
#include "picture_scene.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static mps_status no_memory(page_errors *e)
{
    return mps__page_fail(e, MPS_E_NOMEM, "no memory for a picture");
}

/* Densities, for the names of the bars and for the limit of rounding. */
static void take_phases(scene *s, const page_run *run)
{
    const json_value *list = mps__json_get(run->summary, "phases");
    for (size_t k = 0; k < SCENE_PHASES && k < mps__json_count(list); k++) {
        const double density = mps__json_number(mps__json_get(mps__json_at(list, k), "density"));
        if (density > 0) s->density[k] = density;
    }
}

static mps_status take_sensors(scene *s, const page_run *run)
{
    for (int32_t k = 0; k < run->columns; k++) {
        const page_column *c = &run->column[k];
        if (!c->has_place || strcmp(c->type, "force") == 0 || strcmp(c->type, "moment") == 0)
            continue;
        scene_sensor *own = mps__scene_sensor(s, c->name);
        if (!own) return no_memory(run->errors);
        own->gauge = strcmp(c->type, "gauge") == 0;
        memcpy(own->at, c->at, sizeof own->at);
        if (c->has_normal) memcpy(own->normal, c->normal, sizeof own->normal);
    }
    return MPS_OK;
}

/* Edges of the tank. */
static mps_status take_edges(scene *s, const page_run *run)
{
    const json_value *list = mps__json_get(run->summary, "edges");
    const size_t count = mps__json_count(list);
    if (count == 0 || count > INT32_MAX / 64) return MPS_OK;
    if (!mps__scene_edges(s, (int32_t)count)) return no_memory(run->errors);
    for (size_t k = 0; k < 6 * count; k++)
        s->edge[k] = mps__json_number(mps__json_at(mps__json_at(list, k / 6), k % 6));
    return MPS_OK;
}

mps_status mps__scene_of_run(scene *s, const film *f)
{
    const page_run *run = f->run;
    const char *title = mps__page_string(run, "title");
    *s = (scene){
        .dim = f->dim, .dp = f->dp, .phases = f->phases < SCENE_PHASES ? f->phases : SCENE_PHASES};
    if (!title[0]) title = mps__page_string(run, "case");
    snprintf(s->title, sizeof s->title, "%s", title);
    memcpy(s->run_lo, f->lo, sizeof s->run_lo);
    memcpy(s->run_hi, f->hi, sizeof s->run_hi);
    take_phases(s, run);
    const mps_status status = take_edges(s, run);
    return status == MPS_OK ? take_sensors(s, run) : status;
}

mps_status mps__scene_of_frame(scene *s, const film *f, int64_t k, const film_frame *frame)
{
    int64_t n = 0;
    for (int64_t i = 0; i < frame->count; i++)
        n += (int)frame->kind[i] == FILM_FLUID || (int)frame->kind[i] == FILM_WALL;
    if (!mps__scene_reserve(s, n)) return no_memory(f->run->errors);
    s->t = f->run->frame[k].t;
    s->pose = f->pose[k];
    s->speed2 = f->speed2;
    n = 0;
    for (int64_t i = 0; i < frame->count; i++) {
        double X[3];
        if ((int)frame->kind[i] != FILM_FLUID && (int)frame->kind[i] != FILM_WALL) continue;
        mps__film_to_tank(&s->pose, frame->x + 3 * i, X);
        for (int d = 0; d < 3; d++) s->x[3 * n + d] = (float)X[d];
        s->p[n] = (float)frame->p[i];
        s->kind[n] = (int)frame->kind[i] == FILM_FLUID ? SCENE_FLUID : SCENE_WALL;
        s->phase[n++] = (uint8_t)frame->phase[i];
    }
    return MPS_OK;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* A model that requests the voids of the tank in each step and stores them, and tanks with random
 * voids. */
#ifndef VOID_FIXTURE_H
#define VOID_FIXTURE_H

#include "model_fixture.h"
#include <mps/voids.h>
#include <stdlib.h>

/* What the last step found. */
typedef struct found_voids {
    mps_voids_config config; /* wanted */
    mps_voids v;
    int32_t *label, *size, *face[5];
    int64_t *face_id; /* ids of the particles behind the faces, -1: none */
    int64_t steps;
} found_voids;

static inline void *copy_of(const void *from, int64_t count, size_t size)
{
    void *to = malloc((size_t)(count + 1) * size);
    assert_non_null(to);
    if (count > 0) memcpy(to, from, (size_t)count * size);
    return to;
}

static inline void forget_voids(found_voids *f)
{
    free(f->label);
    free(f->size);
    free(f->face_id);
    for (int k = 0; k < 5; k++) free(f->face[k]);
    f->label = f->size = NULL;
    f->face_id = NULL;
    memset(f->face, 0, sizeof f->face);
}

static inline int64_t cells_of(const mps_voids *v)
{
    return (int64_t)v->cells[0] * v->cells[1] * v->cells[2];
}

static int keep_voids(mps_stage *s)
{
    found_voids *f = s->self;
    mps_voids v;
    assert_int_equal(mps_voids_init(&v, sizeof v), MPS_OK);
    if (mps_stage_voids(s, &f->config, &v)) return 1;
    forget_voids(f);
    f->v = v;
    f->label = copy_of(v.label, cells_of(&v), sizeof *f->label);
    f->size = copy_of(v.size, v.count, sizeof *f->size);
    const int32_t *const face[5] = {v.face_label, v.face_cell, v.face_side, v.face_behind,
                                    v.face_row};
    for (int k = 0; k < 5; k++) f->face[k] = copy_of(face[k], v.faces, sizeof *f->face[k]);
    f->face_id = copy_of(NULL, 0, (size_t)(v.faces + 1) * sizeof *f->face_id);
    for (int64_t k = 0; k < v.faces; k++)
        f->face_id[k] = v.face_row[k] < 0 ? -1 : s->view->id[v.face_row[k]];
    f->steps++;
    return 0;
}

static inline double void_reach(const double *setting, double dp)
{
    (void)setting;
    return 2.5 * dp;
}

/* Switch the model on. `f` must outlive the simulation; forget_voids() frees it. */
static inline void watch_voids(mps_sim *sim, found_voids *f)
{
    static const mps_use uses[] = {{"region", MPS_USE_READ}};
    static const mps_verb verbs[] = {
        {.hook = MPS_PREPARE, .use_count = 1, .uses = uses, .run = keep_voids}};
    const mps_model_ops ops = {TOY("watch.voids", 1, verbs), .user = f, .reach = void_reach};
    memset(f, 0, sizeof *f);
    assert_int_equal(mps_voids_config_init(&f->config, sizeof f->config), MPS_OK);
    use_model(sim, &ops);
}

/* Liquid where `inside` is true below a depth. */
typedef struct drawing {
    int (*is_void)(const double *X);
    double depth;
    int up;
} drawing;

static inline int is_drawn(void *user, const double *X)
{
    const drawing *d = user;
    return X[d->up] < d->depth && !d->is_void(X);
}

static inline void fill_drawn(mps_sim *sim, int32_t dim, double depth,
                              int (*is_void)(const double *X))
{
    drawing d = {is_void, depth, dim - 1};
    ASSERT_OK(sim, mps_fill_add(sim, 0, is_drawn, &d, NULL));
}

/* Fraction of the cells of a component where `inside` is true. */
static inline double share_within(const found_voids *f, int32_t label,
                                  int (*inside)(const double *))
{
    int64_t all = 0, in = 0;
    for (int64_t c = 0; c < cells_of(&f->v); c++) {
        const int64_t line = c / f->v.cells[0];
        const int64_t at[3] = {c % f->v.cells[0], line % f->v.cells[1], line / f->v.cells[1]};
        double X[3];
        if (f->label[c] != label) continue;
        for (int d = 0; d < 3; d++) X[d] = f->v.origin[d] + ((double)at[d] + 0.5) * f->v.side;
        all++;
        in += inside(X) != 0;
    }
    return all > 0 ? (double)in / (double)all : 0;
}

/* Area or volume of a component. */
static inline double extent_of(const found_voids *f, int32_t label)
{
    return f->size[label] * pow(f->v.side, f->v.dim);
}

/* ---- tanks with voids ---- */

static const double DP = 0.02;

/* A tank of 1 m x 0.8 m with liquid up to 0.5 m but for a drawn void, after one step. */
static inline mps_sim *drawn_2d(found_voids *f, int (*is_void)(const double *))
{
    mps_sim *sim = new_sim(2, DP);
    add_tank(sim, 1, 0.8, 0);
    fill_drawn(sim, 2, 0.5, is_void);
    watch_voids(sim, f);
    return sim;
}

static inline void step_and_end(mps_sim *sim)
{
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    mps_sim_destroy(sim);
}

static inline int none(const double *X)
{
    (void)X;
    return 0;
}

static inline int in_circle(const double *X)
{
    return hypot(X[0] - 0.503, X[1] - 0.252) < 0.12;
}

static inline int in_box(const double *X)
{
    return fabs(X[0] - 0.2) < 0.106 && fabs(X[1] - 0.2) < 0.066;
}

static inline int in_both(const double *X)
{
    return in_circle(X) || in_box(X);
}

static inline void add_dividing_plate(mps_sim *sim)
{
    const double foot[2] = {0.6, 0}, edge[2] = {0.1, 0.8};
    ASSERT_OK(sim, mps_plate_add(sim, "plate", foot, edge, NULL));
}

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* Small scenes and a model that acts on demand, shared by the tests of steps. */
#ifndef PUSH_FIXTURE_H
#define PUSH_FIXTURE_H

#include "tank_fixture.h"
#include <mps/model.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

static const double dp = 0.05;

/* ---- a model with a verb in every hook that pushes, fails or spoils on demand -------------- */

enum { CLASSIFY, PREPARE, FORCE, SOURCE, LEVEL, GRADIENT, LOAD, VELOCITY, SHIFT, VERBS };
static const char *const verb_name[VERBS] = {"classify", "prepare", "force",    "source", "level",
                                             "gradient", "load",    "velocity", "shift"};

/* What the model under test does; one for all handles of this program. */
static struct {
    int fail;        /* verb that fails, -1: none */
    int silent;      /* ... without mps_stage_fail() */
    int spoil;       /* 1: NaN in a velocity, 2: in an acceleration, 3: a velocity beyond the limit,
                        4: a shift through the walls */
    int64_t victim;  /* id of the spoilt particle */
    double dt_limit; /* INFINITY: none */
    int32_t region;  /* region that classify writes at the selected particle, MPS_REGION_INNER:
                        none */
    int created, destroyed, calls[VERBS];
} test;

/* Each verb changes all writable arrays, so that a failure leaves wrong values. */
static const mps_use region_uses[] = {{"region", MPS_USE_CHANGE}};
static const mps_use push_uses[] = {{"acceleration", MPS_USE_CHANGE}};
static const mps_use level_uses[] = {{"pressure", MPS_USE_CHANGE}};
static const mps_use load_uses[] = {{"wall_pressure", MPS_USE_CHANGE}};
static const mps_use velocity_uses[] = {{"velocity", MPS_USE_CHANGE}};
static const mps_use shift_uses[] = {{"displacement", MPS_USE_CHANGE},
                                     {"velocity", MPS_USE_CHANGE}};

/* `mess` [count]: NULL or numbers that must not be seen after a failure. */
static inline int verb(mps_stage *s, int which, double *mess, int64_t count)
{
    test.calls[which]++;
    if (test.fail != which) return 0;
    for (int64_t i = 0; i < count; i++) mess[i] = -77;
    return test.silent ? 1 : mps_stage_fail(s, "the %s is out of order", verb_name[which]);
}

static inline int64_t place_of(const mps_view *v, int64_t id)
{
    for (int64_t i = 0; i < v->n; i++)
        if (v->id[i] == id) return i;
    return 0;
}

static inline int create(const mps_allocator *allocator, void **self)
{
    test.created++;
    *self = allocator->alloc(allocator->user, 8);
    return *self == NULL;
}

static inline void destroy(const mps_allocator *allocator, void *self)
{
    test.destroyed++;
    allocator->release(allocator->user, self);
}

static inline int limit(mps_stage *s)
{
    if (!(test.dt_limit >= s->dt_limit)) s->dt_limit = test.dt_limit; /* NaN too */
    return 0;
}

static inline int classify(mps_stage *s)
{
    int32_t *region = s->data[0];
    if (test.region != MPS_REGION_INNER) region[place_of(s->view, test.victim)] = test.region;
    return verb(s, CLASSIFY, NULL, 0);
}

static inline int prepare(mps_stage *s)
{
    return verb(s, PREPARE, NULL, 0);
}

static inline int force(mps_stage *s)
{
    const mps_view *v = s->view;
    double *a = s->data[0];
    assert_non_null(s->self);
    for (int64_t i = 0; i < v->n; i++) a[i * v->dim] += v->setting[0];
    if (test.spoil == 2) a[place_of(v, test.victim) * v->dim] = NAN;
    return verb(s, FORCE, a, v->n * v->dim);
}

static inline int source(mps_stage *s)
{
    return verb(s, SOURCE, NULL, 0);
}

static inline int level(mps_stage *s)
{
    return verb(s, LEVEL, s->data[0], s->view->n);
}

static inline int gradient(mps_stage *s)
{
    return verb(s, GRADIENT, s->data[0], s->view->n * s->view->dim);
}

static inline int load(mps_stage *s)
{
    return verb(s, LOAD, s->data[0], s->view->n);
}

static inline int velocity(mps_stage *s)
{
    const mps_view *v = s->view;
    double *u = s->data[0];
    if (test.spoil == 1) u[place_of(v, test.victim) * v->dim + 1] = NAN;
    if (test.spoil == 3) u[place_of(v, test.victim) * v->dim + 1] = 1e4;
    return verb(s, VELOCITY, u, v->n * v->dim);
}

static inline int shift(mps_stage *s)
{
    const mps_view *v = s->view;
    double *dx = s->data[0];
    if (test.spoil == 4) dx[place_of(v, test.victim) * v->dim] += 4 * v->dp;
    return verb(s, SHIFT, s->data[1], v->n * v->dim);
}

static const mps_setting push_settings[] = {
    {"acceleration", "m/s2", "along the first axis", MPS_TYPE_REAL, 0, -100, 100}};
static const mps_verb push_verbs[] = {
    {.hook = MPS_LIMIT, .run = limit},
    {.hook = MPS_CLASSIFY, .use_count = 1, .uses = region_uses, .after = "*", .run = classify},
    {.hook = MPS_PREPARE, .run = prepare},
    {.hook = MPS_FORCE, .use_count = 1, .uses = push_uses, .run = force},
    {.hook = MPS_SOURCE, .run = source},
    {.hook = MPS_LEVEL, .use_count = 1, .uses = level_uses, .run = level},
    {.hook = MPS_GRADIENT, .use_count = 1, .uses = push_uses, .run = gradient},
    {.hook = MPS_LOAD, .use_count = 1, .uses = load_uses, .run = load},
    {.hook = MPS_VELOCITY, .use_count = 1, .uses = velocity_uses, .run = velocity},
    {.hook = MPS_SHIFT, .use_count = 2, .uses = shift_uses, .run = shift}};
static const mps_model_ops push = {.struct_size = sizeof(mps_model_ops),
                                   .api = MPS_MODEL_API,
                                   .name = "test.push",
                                   .help = "pushes, fails or spoils on demand",
                                   .setting_count = 1,
                                   .settings = push_settings,
                                   .verb_count = 10,
                                   .verbs = push_verbs,
                                   .create = create,
                                   .destroy = destroy};

static inline void reset_test(void)
{
    memset(&test, 0, sizeof test);
    test.fail = -1;
    test.dt_limit = INFINITY;
}

static inline void use_push(mps_sim *sim)
{
    ASSERT_OK(sim, mps_model_register(sim, &push));
    ASSERT_OK(sim, mps_model_use(sim, "test.push"));
}

/* ---- scenes ---------------------------------------------------------------------------------- */

static inline void fill_pool(mps_sim *sim)
{
    mps_tank tank;
    assert_int_equal(mps_tank_init(&tank, sizeof tank), MPS_OK);
    tank.size[0] = tank.size[1] = 0.5;
    ASSERT_OK(sim, mps_tank_add(sim, &tank, NULL));
    fill_depth(sim, 0.5, 0.3, 0);
}

static inline mps_sim *pool(void)
{
    reset_test();
    mps_sim *sim = new_sim(2, dp);
    fill_pool(sim);
    return sim;
}

static inline void set_velocity(mps_sim *sim, int64_t id, double ux, double uy)
{
    mps_lease u = {.struct_size = sizeof u};
    const int64_t at = mps_particle_index(sim, id);
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &u));
    u.data[u.stride * at] = ux;
    u.data[u.stride * at + 1] = uy;
    ASSERT_OK(sim, mps_lease_end(sim, &u));
}

/* Time, positions, velocities, pressures by id. */
typedef struct picture {
    double t, value[5000];
    int64_t steps, n;
} picture;

static inline picture take_picture(mps_sim *sim)
{
    static const char *const fields[] = {"position", "velocity", "pressure"};
    const int64_t *ids;
    picture c;
    int64_t at = 0;
    memset(&c, 0, sizeof c);
    c.n = mps_particles_count(sim, -1);
    ASSERT_OK(sim, mps_sim_time(sim, &c.t, &c.steps));
    ASSERT_OK(sim, tags_peek(sim, &ids, NULL, NULL, NULL));
    for (int f = 0; f < 3; f++) {
        mps_lease l = {.struct_size = sizeof l};
        ASSERT_OK(sim, mps_lease_begin(sim, fields[f], MPS_READ, &l));
        for (int64_t i = 0; i < l.count; i++) {
            assert_true(ids[i] < 1000);
            memcpy(c.value + at + ids[i] * l.stride, l.data + i * l.stride,
                   (size_t)l.stride * sizeof(double));
        }
        at += 1000 * l.stride;
        ASSERT_OK(sim, mps_lease_end(sim, &l));
    }
    return c;
}

static inline void assert_same(const picture *a, const picture *b)
{
    assert_true(a->t == b->t);
    assert_int_equal(a->steps, b->steps);
    assert_int_equal(a->n, b->n);
    assert_memory_equal(a->value, b->value, sizeof a->value);
}

#endif

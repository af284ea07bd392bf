/* SPDX-License-Identifier: BSD-3-Clause */
/* Single models: a simulation without models, free fluid particles, and a model `spy` that copies
 * the results of the previous verbs. */
#ifndef PHASE_FIXTURE_H
#define PHASE_FIXTURE_H

#include "cloud.h"
#include "tank_fixture.h"
#include <mps/model.h>
#include <stdlib.h>

enum { SPY_CAPACITY = 40000 };

/* By id, of the last step. `pressure`, `rhs` and `deviation`, where given, are laid into the stage
 * before the models under test. */
static struct {
    double a[3 * SPY_CAPACITY], dp_a[3 * SPY_CAPACITY], density[SPY_CAPACITY], shift[SPY_CAPACITY],
        rhs[SPY_CAPACITY], gas[SPY_CAPACITY], law[SPY_CAPACITY], p[SPY_CAPACITY];
    double volume[SPY_CAPACITY], wide_sum[SPY_CAPACITY];
    double number[SPY_CAPACITY], near_sum[SPY_CAPACITY]; /* over n0 */
    int32_t level_free, region[SPY_CAPACITY];
    double (*pressure)(const double *x, int dim);
    double given_rhs, given_deviation;
} spy;

/* As if the volume of every particle were smaller by `given_deviation`. */
static inline int spy_lay_number(mps_stage *s)
{
    double *number_density = s->data[0];
    if (spy.given_deviation == 0) return 0;
    for (int64_t i = 0; i < s->view->n; i++) {
        spy.near_sum[s->view->id[i]] = number_density[i] / s->view->near.n0;
        number_density[i] = s->view->near.n0 + spy.given_deviation * number_density[i];
    }
    return 0;
}

static inline int spy_lay_deviation(mps_stage *s)
{
    const mps_view *v = s->view;
    double *volume_deviation = s->data[0];
    if (spy.given_deviation == 0) return 0;
    double *one = mps_stage_scratch(s, v->n), *sum = mps_stage_scratch(s, v->n);
    assert_true(one && sum);
    for (int64_t i = 0; i < v->n; i++) one[i] = 1;
    assert_int_equal(mps_op_volume_sum(&v->far, one, sum), MPS_OK);
    for (int64_t i = 0; i < v->n; i++) {
        spy.wide_sum[v->id[i]] = sum[i];
        volume_deviation[i] = spy.given_deviation * sum[i];
    }
    return 0;
}

static inline int spy_lay_rhs(mps_stage *s)
{
    double *source = s->data[0];
    for (int64_t i = 0; i < s->view->n; i++) source[i] += spy.given_rhs;
    return 0;
}

static inline int spy_lay_pressure(mps_stage *s)
{
    double *p = s->data[0];
    for (int64_t i = 0; spy.pressure && i < s->view->n; i++)
        p[i] = spy.pressure(s->view->x + i * s->view->dim, s->view->dim);
    return 0;
}

static const mps_use spy_number_uses[] = {{"number_density", MPS_USE_CHANGE}};
static const mps_use spy_deviation_uses[] = {{"volume_deviation", MPS_USE_CHANGE}};
static const mps_use spy_rhs_uses[] = {{"pressure_source", MPS_USE_CHANGE}};
static const mps_use spy_pressure_uses[] = {{"pressure", MPS_USE_CHANGE}};

static const mps_verb spy_before_verbs[] = {
    {.hook = MPS_CLASSIFY,
     .use_count = 1,
     .uses = spy_number_uses,
     .before = "*",
     .run = spy_lay_number},
    {.hook = MPS_PREPARE,
     .use_count = 1,
     .uses = spy_deviation_uses,
     .before = "*",
     .run = spy_lay_deviation},
    {.hook = MPS_SOURCE, .use_count = 1, .uses = spy_rhs_uses, .before = "*", .run = spy_lay_rhs},
    {.hook = MPS_LEVEL,
     .use_count = 1,
     .uses = spy_pressure_uses,
     .before = "*",
     .run = spy_lay_pressure}};
static const mps_model_ops spy_before = {.struct_size = sizeof(mps_model_ops),
                                         .api = MPS_MODEL_API,
                                         .name = "before.spy",
                                         .help = "lays values into the stage",
                                         .verb_count = 4,
                                         .verbs = spy_before_verbs};

enum { SPY_ACCELERATION, SPY_DENSITY, SPY_REGION, SPY_DEVIATION, SPY_NUMBER, SPY_FORCE_USES };
static const mps_use spy_force_uses[SPY_FORCE_USES] = {
    [SPY_ACCELERATION] = {"acceleration", MPS_USE_READ},
    [SPY_DENSITY] = {"pressure_density", MPS_USE_READ},
    [SPY_REGION] = {"region", MPS_USE_READ},
    [SPY_DEVIATION] = {"volume_deviation", MPS_USE_READ},
    [SPY_NUMBER] = {"number_density", MPS_USE_READ}};

static inline int spy_force(mps_stage *s)
{
    const mps_view *v = s->view;
    const double *a = s->data[SPY_ACCELERATION], *density = s->data[SPY_DENSITY];
    const double *volume = s->data[SPY_DEVIATION], *number = s->data[SPY_NUMBER];
    const int32_t *region = s->data[SPY_REGION];
    const int dim = v->dim;
    assert_true(v->n <= SPY_CAPACITY);
    for (int64_t i = 0; i < v->n * dim; i++) spy.a[v->id[i / dim] * dim + i % dim] = a[i];
    for (int64_t i = 0; i < v->n; i++) {
        spy.density[v->id[i]] = density[i];
        spy.region[v->id[i]] = region[i];
        spy.volume[v->id[i]] = volume[i];
        spy.number[v->id[i]] = number[i] / v->near.n0;
    }
    return 0;
}

enum { SPY_SHIFT, SPY_RHS, SPY_GAS, SPY_LAW, SPY_SOURCE_USES };
static const mps_use spy_source_uses[SPY_SOURCE_USES] = {
    [SPY_SHIFT] = {"pressure_shift", MPS_USE_READ},
    [SPY_RHS] = {"pressure_source", MPS_USE_READ},
    [SPY_GAS] = {"gas_shift", MPS_USE_READ},
    [SPY_LAW] = {"gas_law", MPS_USE_READ}};

static inline int spy_source(mps_stage *s)
{
    const mps_view *v = s->view;
    const double *shift = s->data[SPY_SHIFT], *rhs = s->data[SPY_RHS];
    const double *gas = s->data[SPY_GAS], *law = s->data[SPY_LAW];
    for (int64_t i = 0; i < v->n; i++) {
        spy.shift[v->id[i]] = shift[i];
        spy.rhs[v->id[i]] = rhs[i];
        spy.gas[v->id[i]] = gas[i];
        spy.law[v->id[i]] = law[i];
    }
    return 0;
}

static const mps_use spy_gradient_uses[] = {{"acceleration", MPS_USE_READ},
                                            {"pressure", MPS_USE_READ}};

static inline int spy_gradient(mps_stage *s)
{
    const mps_view *v = s->view;
    const double *a = s->data[0], *p = s->data[1];
    const int dim = v->dim;
    spy.level_free = s->level_free;
    for (int64_t i = 0; i < v->n * dim; i++) spy.dp_a[v->id[i / dim] * dim + i % dim] = a[i];
    for (int64_t i = 0; i < v->n; i++) spy.p[v->id[i]] = p[i];
    return 0;
}

static const mps_verb spy_after_verbs[] = {{.hook = MPS_FORCE,
                                            .use_count = SPY_FORCE_USES,
                                            .uses = spy_force_uses,
                                            .after = "*",
                                            .run = spy_force},
                                           {.hook = MPS_SOURCE,
                                            .use_count = SPY_SOURCE_USES,
                                            .uses = spy_source_uses,
                                            .after = "*",
                                            .run = spy_source},
                                           {.hook = MPS_GRADIENT,
                                            .use_count = 2,
                                            .uses = spy_gradient_uses,
                                            .after = "*",
                                            .run = spy_gradient}};
static const mps_model_ops spy_after = {.struct_size = sizeof(mps_model_ops),
                                        .api = MPS_MODEL_API,
                                        .name = "after.spy",
                                        .help = "keeps what other models left",
                                        .verb_count = 3,
                                        .verbs = spy_after_verbs};

/* No gravity, no models but the spy, steps of `dt`. re_far in dp. */
static inline mps_sim *bare_sim(int32_t dim, double dp, double re_far, double dt)
{
    mps_config config;
    mps_time_control control;
    mps_sim *sim = NULL;
    memset(&spy, 0, sizeof spy);
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dim = dim;
    config.dp = dp;
    config.re_far = re_far;
    memset(config.gravity, 0, sizeof config.gravity);
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    while (mps_model_name(sim, 0)) ASSERT_OK(sim, mps_model_remove(sim, mps_model_name(sim, 0)));
    ASSERT_OK(sim, mps_model_register(sim, &spy_before));
    ASSERT_OK(sim, mps_model_register(sim, &spy_after));
    ASSERT_OK(sim, mps_model_use(sim, "before.spy"));
    ASSERT_OK(sim, mps_model_use(sim, "after.spy"));
    assert_int_equal(mps_time_control_init(&control, sizeof control), MPS_OK);
    control.dt = dt;
    ASSERT_OK(sim, mps_time_control_set(sim, &control));
    return sim;
}

static inline void set_phase(mps_sim *sim, int32_t index, double density, double viscosity)
{
    mps_phase phase;
    assert_int_equal(mps_phase_init(&phase, sizeof phase), MPS_OK);
    phase.density = density;
    phase.viscosity = viscosity;
    ASSERT_OK(sim, mps_phase_set(sim, index, &phase));
}

/* `count` zeros; free() them. */
static inline int32_t *cloud_phases(int64_t count)
{
    return calloc(count > 0 ? (size_t)count : 1, sizeof(int32_t));
}

/* Particle i of the cloud gets phase[i] and id i. */
static inline void add_cloud(mps_sim *sim, const cloud *c, const int32_t *phase, const double *u)
{
    mps_particle_block b;
    for (int64_t i = 0; i < c->n; i++) {
        int64_t run = 1;
        while (i + run < c->n && phase[i + run] == phase[i]) run++;
        assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
        b.phase = phase[i];
        b.count = run;
        b.position = c->x + i * c->dim;
        b.velocity = u ? u + i * c->dim : NULL;
        ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
        i += run - 1;
    }
}

/* A field by id; free() it. */
static inline double *field_by_id(mps_sim *sim, const char *name)
{
    const int64_t *ids;
    mps_lease l = {.struct_size = sizeof l};
    ASSERT_OK(sim, tags_peek(sim, &ids, NULL, NULL, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, name, MPS_READ, &l));
    double *v = cloud_doubles(l.count * l.stride);
    for (int64_t i = 0; i < l.count; i++)
        memcpy(v + ids[i] * l.stride, l.data + i * l.stride, (size_t)l.stride * sizeof *v);
    ASSERT_OK(sim, mps_lease_end(sim, &l));
    return v;
}

#endif

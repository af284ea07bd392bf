/* SPDX-License-Identifier: BSD-3-Clause */
/* Small models for tests of the model contract, and a simulation of a few free particles without
 * any other model. */
#ifndef MODEL_FIXTURE_H
#define MODEL_FIXTURE_H

#include "tank_fixture.h"
#include <mps/list.h>
#include <mps/model.h>

/* Set the required entries of a table except name and verbs. */
#define TOY(model_name, count, table)                                                 \
    .struct_size = sizeof(mps_model_ops), .api = MPS_MODEL_API, .name = (model_name), \
    .help = "a model of a test", .verb_count = (count), .verbs = (table)

static inline int do_nothing(mps_stage *s)
{
    (void)s;
    return 0;
}

/* For models that only bring channels: a model needs a verb. */
static const mps_verb idle_verbs[] = {{.hook = MPS_LIMIT, .run = do_nothing}};

/* No models, no gravity, no particles, steps of 1 ms. */
static inline mps_sim *empty_sim(int32_t dim, double dp, const mps_allocator *allocator)
{
    mps_config c;
    mps_time_control control;
    mps_sim *sim = NULL;
    assert_int_equal(mps_config_init(&c, sizeof c), MPS_OK);
    c.dim = dim;
    c.dp = dp;
    memset(c.gravity, 0, sizeof c.gravity);
    if (allocator) c.allocator = *allocator;
    assert_int_equal(mps_sim_create(&c, &sim), MPS_OK);
    while (mps_model_name(sim, 0)) ASSERT_OK(sim, mps_model_remove(sim, mps_model_name(sim, 0)));
    assert_int_equal(mps_time_control_init(&control, sizeof control), MPS_OK);
    control.dt = 1e-3;
    ASSERT_OK(sim, mps_time_control_set(sim, &control));
    return sim;
}

/* `count` particles in a row along x, from x0, dp apart. */
static inline void add_row(mps_sim *sim, double x0, int64_t count, int64_t *ids)
{
    double x[3 * 64] = {0}, dp;
    int32_t dim;
    mps_particle_block b;
    assert_true(count <= 64);
    ASSERT_OK(sim, mps_sim_shape(sim, &dim, &dp));
    for (int64_t k = 0; k < count; k++) x[k * dim] = x0 + (double)k * dp;
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = count;
    b.position = x;
    ASSERT_OK(sim, mps_particles_add(sim, &b, ids));
}

/* Eight particles in a row, ids 0..7. */
static inline mps_sim *row_sim(int32_t dim)
{
    mps_sim *sim = empty_sim(dim, 0.1, NULL);
    add_row(sim, 0, 8, NULL);
    return sim;
}

static inline void use_model(mps_sim *sim, const mps_model_ops *ops)
{
    ASSERT_OK(sim, mps_model_register(sim, ops));
    ASSERT_OK(sim, mps_model_use(sim, ops->name));
}

/* Whether the list of channels has a name; NULL info: only that. */
static inline int find_channel(mps_sim *sim, const char *name, mps_channel_info *info)
{
    mps_channel_info c;
    assert_int_equal(mps_channel_info_init(&c, sizeof c), MPS_OK);
    for (int32_t k = 0; mps_channel_info_get(sim, k, &c) == MPS_OK; k++) {
        if (strcmp(c.name, name) != 0) continue;
        if (info) *info = c;
        return 1;
    }
    return 0;
}

/* Value of component d of a field of the particle with an id. */
static inline double field_value(mps_sim *sim, const char *field, int64_t id, int d)
{
    mps_lease l = {.struct_size = sizeof l};
    const int64_t at = mps_particle_index(sim, id);
    ASSERT_OK(sim, mps_lease_begin(sim, field, MPS_READ, &l));
    assert_true(at >= 0 && d < l.stride);
    const double value = l.data[at * l.stride + d];
    ASSERT_OK(sim, mps_lease_end(sim, &l));
    return value;
}

static inline void set_field_value(mps_sim *sim, const char *field, int64_t id, int d, double value)
{
    mps_lease l = {.struct_size = sizeof l};
    const int64_t at = mps_particle_index(sim, id);
    ASSERT_OK(sim, mps_lease_begin(sim, field, MPS_WRITE, &l));
    assert_true(at >= 0 && d < l.stride);
    l.data[at * l.stride + d] = value;
    ASSERT_OK(sim, mps_lease_end(sim, &l));
}

#endif

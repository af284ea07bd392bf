/* SPDX-License-Identifier: BSD-3-Clause */
/* Failing allocations, scenes, and the loop over allocations; common code of the tests of this
 * folder. */
#ifndef OOM_FIXTURE_H
#define OOM_FIXTURE_H

#include "../every.h"
#include "../tags.h"
#include <math.h>
#include <mps/model.h>
#include <mps/mps.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

/* Fails the allocation number `fail_at` (0: none) and counts what is out. */
typedef struct memory {
    int64_t live, count, fail_at;
} memory;

static inline void *memory_alloc(void *user, size_t size)
{
    memory *m = user;
    if (++m->count == m->fail_at) return NULL;
    void *block = malloc(size);
    if (block) m->live++;
    return block;
}

static inline void memory_release(void *user, void *block)
{
    ((memory *)user)->live--;
    free(block);
}

static inline mps_allocator allocator_of(memory *m)
{
    return (mps_allocator){memory_alloc, memory_release, m};
}

/* Of the next simulation. */
static int32_t dimension = 2;

static inline mps_status create(memory *m, mps_sim **sim, char *error, size_t error_size)
{
    mps_config config;
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dim = dimension;
    config.dp = dimension == 3 ? 0.1 : 0.05;
    config.allocator = allocator_of(m);
    config.error = error;
    config.error_size = error_size;
    return mps_sim_create(&config, sim);
}

/* ---- scenes: set-ups before the call under test ------------------------------------------ */

static inline mps_status add_tank(mps_sim *sim)
{
    mps_tank tank;
    assert_int_equal(mps_tank_init(&tank, sizeof tank), MPS_OK);
    tank.size[0] = tank.size[1] = tank.size[2] = 0.5;
    tank.open_top = 1;
    return mps_tank_add(sim, &tank, NULL);
}

static inline mps_status fill(mps_sim *sim)
{
    const double lo[3] = {0, 0, 0}, hi[3] = {0.5, 0.3, 0.5};
    return mps_fill_box_add(sim, 0, lo, hi, NULL, NULL);
}

static inline void nothing(mps_sim *sim)
{
    (void)sim;
}
static inline void tank_only(mps_sim *sim)
{
    assert_int_equal(add_tank(sim), MPS_OK);
}

static inline void filled(mps_sim *sim)
{
    tank_only(sim);
    assert_int_equal(fill(sim), MPS_OK);
}

/* With probes that keep averages and samples, a thousand of them in the next step. */
static inline void sampled(mps_sim *sim)
{
    filled(sim);
    for (int32_t type = 0; type < 4; type++) {
        mps_probe p;
        int32_t id;
        assert_int_equal(mps_probe_init(&p, sizeof p), MPS_OK);
        p.type = type;
        p.at[1] = type == MPS_PROBE_GAUGE ? 0 : 0.1;
        p.average = 1e-3;
        p.rate = 1e6;
        assert_int_equal(mps_probe_add(sim, &p, &id), MPS_OK);
    }
    for (int k = 0; k < 2; k++) assert_int_equal(mps_step(sim, 1e-3, NULL), MPS_OK);
}

/* Far above the pool, so that the next step sorts and grows everything. */
static inline mps_status add_drop(mps_sim *sim, double y, int64_t count)
{
    double x[2 * 64];
    mps_particle_block block;
    assert_true(count <= 64);
    assert_int_equal(mps_particle_block_init(&block, sizeof block), MPS_OK);
    for (int64_t k = 0; k < count; k++) {
        x[2 * k] = 0.1 + 0.04 * (double)(k % 8);
        x[2 * k + 1] = y + 0.04 * (double)(k / 8);
    }
    block.count = count;
    block.position = x;
    return mps_particles_add(sim, &block, NULL);
}

/* ---- calls under test ------------------------------------------------------------------------ */

static inline mps_status solver(mps_sim *sim)
{
    return mps_solver_use(sim, "sundials.bicgstab", "ic0");
}
static inline mps_status preset(mps_sim *sim)
{
    return mps_preset_use(sim, "imps.paper");
}
static inline mps_status step(mps_sim *sim)
{
    return mps_step(sim, 1e-3, NULL);
}

/* ---- presets and all else that takes memory --- */

static inline void filled_threads(mps_sim *sim)
{
    filled(sim);
    assert_int_equal(mps_threads_set(sim, 3), MPS_OK);
}

static inline int run_nothing(mps_stage *s)
{
    return mps_stage_scratch(s, s->view->n) == NULL;
}

static inline int create_state(const mps_allocator *allocator, void **self)
{
    *self = allocator->alloc(allocator->user, 100);
    return *self == NULL;
}

static inline void destroy_state(const mps_allocator *allocator, void *self)
{
    allocator->release(allocator->user, self);
}

static inline mps_status register_model(mps_sim *sim)
{
    static const mps_use uses[] = {{"oom_mark", MPS_USE_CHANGE}};
    static const mps_verb verbs[] = {
        {.hook = MPS_FORCE, .use_count = 1, .uses = uses, .run = run_nothing}};
    static const mps_channel channels[] = {
        {"oom_mark", "-", "any", 2, MPS_TYPE_REAL, MPS_LIFE_PARTICLE, 1}};
    const mps_model_ops ops = {.struct_size = sizeof ops,
                               .api = MPS_MODEL_API,
                               .name = "oom.any",
                               .help = "any",
                               .channel_count = 1,
                               .verb_count = 1,
                               .channels = channels,
                               .verbs = verbs,
                               .create = create_state,
                               .destroy = destroy_state};
    return mps_model_register(sim, &ops);
}

static inline void with_own_model(mps_sim *sim)
{
    filled(sim);
    assert_int_equal(register_model(sim), MPS_OK);
}

static inline mps_status use_own_model(mps_sim *sim)
{
    return mps_model_use(sim, "oom.any");
}

/* ---- the loop -------------------------------------------------------------------------------- */

/* Positions, velocities and pressures by id, so that the order does not matter. */
static inline double *snapshot(mps_sim *sim, int64_t *count)
{
    static const char *const fields[3] = {"position", "velocity", "pressure"};
    const int64_t *ids = NULL, n = mps_particles_count(sim, -1);
    double *out = calloc((size_t)(7 * (n + 300)), sizeof *out);
    int64_t at = 0;
    assert_int_equal(tags_peek(sim, &ids, NULL, NULL, NULL), MPS_OK);
    for (int f = 0; f < 3; f++) {
        mps_lease lease = {.struct_size = sizeof lease};
        assert_int_equal(mps_lease_begin(sim, fields[f], MPS_READ, &lease), MPS_OK);
        for (int64_t i = 0; i < n; i++)
            for (int c = 0; c < lease.stride; c++)
                out[at + ids[i] * lease.stride + c] = lease.data[i * lease.stride + c];
        at += (n + 64) * lease.stride;
        assert_int_equal(mps_lease_end(sim, &lease), MPS_OK);
    }
    *count = 7 * n;
    return out;
}

/* A failed call changed no particle and no time. */
static inline void check_unchanged(mps_sim *sim, const double *before, int64_t count, double t)
{
    int64_t now = 0;
    double time = -1, *after = snapshot(sim, &now);
    assert_int_equal(now, count);
    assert_memory_equal(after, before, (size_t)count * sizeof *after);
    assert_int_equal(mps_sim_time(sim, &time, NULL), MPS_OK);
    assert_true(time == t);
    free(after);
}

typedef struct scene {
    const char *name;
    void (*prepare)(mps_sim *sim);
    mps_status (*call)(mps_sim *sim);
    int64_t least; /* allocations the call makes at least, so that the loop is known to test
                  something */
    int32_t dim;   /* 0: 2 */
} scene;

static inline void check_step_after(mps_sim *sim, const scene *s)
{
    if (s->call(sim) != MPS_OK) fail_msg("%s, again: %s", s->name, mps_sim_error(sim));
}

/* Fail allocation k of one call. Returns false when the call had fewer than k. */
static inline bool fail_once(const scene *s, int64_t k)
{
    memory m = {0, 0, 0};
    mps_sim *sim = NULL;
    double t = -1;
    int64_t count = 0;
    assert_int_equal(create(&m, &sim, NULL, 0), MPS_OK);
    s->prepare(sim);
    double *before = snapshot(sim, &count);
    assert_int_equal(mps_sim_time(sim, &t, NULL), MPS_OK);
    m.count = 0;
    m.fail_at = k;
    const mps_status status = s->call(sim);
    const bool failed = m.count >= k;
    m.fail_at = 0;
    if (failed) {
        if (status == MPS_OK &&
            s->prepare ==
                filled_threads) { /* the memory of the threads: loops run in the calling thread
                                     then */
            check_step_after(sim, s);
            mps_sim_destroy(sim);
            free(before);
            assert_int_equal(m.live, 0);
            return true;
        }
        if (status != MPS_E_NOMEM)
            fail_msg("%s, allocation %lld: %s: %s", s->name, (long long)k, mps_status_name(status),
                     mps_sim_error(sim));
        if (!strstr(mps_sim_error(sim), "memory"))
            fail_msg("%s, allocation %lld: the text is \"%s\"", s->name, (long long)k,
                     mps_sim_error(sim));
        check_unchanged(sim, before, count, t);
        if (s->call(sim) != MPS_OK)
            fail_msg("%s, again after allocation %lld: %s", s->name, (long long)k,
                     mps_sim_error(sim));
    } else {
        assert_int_equal(status, MPS_OK);
        assert_true(m.count >= s->least);
    }
    if (mps_particles_count(sim, MPS_FLUID) > 0) assert_true(mps_step(sim, 1e-3, NULL) >= 0);
    mps_sim_destroy(sim);
    free(before);
    if (m.live != 0)
        fail_msg("%s, allocation %lld: %lld blocks are not given back", s->name, (long long)k,
                 (long long)m.live);
    return failed;
}

static inline void run_scene(void **state)
{
    const scene *s = *state;
    dimension = s->dim ? s->dim : 2;
    /* surfaces and steps in 3-D are slow */
    for (int64_t k = 1; fail_once(s, k); k += dimension == 3 ? every(4) : 1) assert_true(k < 1000);
}

#endif

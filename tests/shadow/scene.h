/* SPDX-License-Identifier: BSD-3-Clause */
/* A tank for steps on a device and on the host. */
#ifndef SHADOW_SCENE_H
#define SHADOW_SCENE_H

#include "checkpoint_fixture.h"
#include "model_fixture.h"
#include "shadow.h"

/* A rolling tank, half full, with air above the liquid for presets of two phases. No fields are
 * requested between its steps. */
static inline mps_sim *unwatched(const char *preset, int32_t dim)
{
    const double dp = dim == 2 ? 0.05 : 0.1, lo[3] = {0, 0, 0}, hi[3] = {0.6, 0.6, 0.4};
    mps_sim *sim = new_sim(dim, dp);
    shadow_heap(sim);
    ASSERT_OK(sim, mps_preset_use(sim, preset));
    add_tank(sim, 0.6, 0.6, 0.4);
    fill_depth(sim, 0.6, 0.3, 0.4);
    if (strncmp(preset, "mmps", 4) == 0) fill_air(sim, lo, hi);
    ASSERT_OK(sim, mps_field_add(sim, "mark", 2));
    shake(sim, 0.05);
    return sim;
}

/* The tank with probes, some of which take samples. */
static inline mps_sim *rolling(const char *preset, int32_t dim)
{
    mps_sim *sim = unwatched(preset, dim);
    add_probes(sim);
    return sim;
}

/* ---- comparison ---- */

/* All fields, also those of the library alone. */
static inline void same_memory(const mps_sim *a, const mps_sim *b)
{
    const mps__particles *p = &a->world.particles, *q = &b->world.particles;
    assert_int_equal(p->fields, q->fields);
    for (int32_t k = 0; k < p->fields; k++) {
        const mps__field *f = &p->field[k];
        const size_t bytes = (size_t)p->n * (size_t)f->components * f->size;
        if (memcmp(*f->data, *q->field[k].data, bytes) != 0) fail_msg("'%s' differs", f->name);
    }
}

/* ---- failures ---- */

/* Particles in the order of a search, if one is due: a failed step may have done it. */
static inline void put_in_order(mps_sim *sim)
{
    mps_stencil near;
    assert_int_equal(mps_stencil_init(&near, sizeof near), MPS_OK);
    ASSERT_OK(sim, mps_stencil_get(sim, MPS_NEAR, &near));
}

/* If any launch or download fails, the step fails and the state is unchanged. `count`: that of the
 * shadow, `fails_at`: number of the failing call. */
static inline void fail_each(mps_sim *host, mps_sim *sim, const int64_t *count, int64_t *fails_at)
{
    const int64_t before = *count;
    int64_t failed = 0;
    go(host, 1);
    go(sim, 1);
    const int64_t all = *count - before;
    for (int64_t k = 1; k <= all; k++) {
        *fails_at = *count + k;
        const mps_status status = mps_step(sim, 0.01, NULL);
        if (status == MPS_OK) { /* a step with fewer of them, or no rows but sums */
            ASSERT_OK(host, mps_step(host, 0.01, NULL));
            continue;
        }
        assert_int_equal(status, MPS_E_PLUGIN);
        assert_non_null(strstr(mps_sim_error(sim), "device 'shadow' failed: as the test wants it"));
        *fails_at = 0;
        failed++;
        /* else the next step begins, and fails, with fields that the device has alone */
        if (failed % 3 > 0) continue;
        put_in_order(host);
        put_in_order(sim);
        same(host, sim);
    }
    assert_true(failed > all / 3);
    *fails_at = 0;
    go(host, 2);
    go(sim, 2);
    same(host, sim);
}

#endif

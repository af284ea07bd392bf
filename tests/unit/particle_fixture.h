/* SPDX-License-Identifier: BSD-3-Clause */
/* A small pool, shared by the tests of particles. */
#ifndef PARTICLE_FIXTURE_H
#define PARTICLE_FIXTURE_H

#include "particles.h"
#include "tank_fixture.h"
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

static const double dp = 0.05;

/* A pool in a tank that fits in milliseconds. */
static inline mps_sim *pool(void)
{
    mps_sim *sim = new_sim(2, dp);
    add_tank(sim, 0.5, 0.5, 0);
    fill_depth(sim, 0.5, 0.3, 0);
    return sim;
}

static inline mps_particle_block block_of(int64_t count, const double *x)
{
    mps_particle_block b;
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = count;
    b.position = x;
    return b;
}

/* A field by id, for all ids below 1000; NaN without a particle. */
static inline void by_id(mps_sim *sim, const char *field, int component, double out[1000])
{
    const int64_t *ids = NULL;
    mps_lease lease = {.struct_size = sizeof lease};
    for (int k = 0; k < 1000; k++) out[k] = NAN;
    ASSERT_OK(sim, tags_peek(sim, &ids, NULL, NULL, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, field, MPS_READ, &lease));
    for (int64_t i = 0; i < lease.count; i++) {
        assert_in_range(ids[i], 0, 999);
        out[ids[i]] = lease.data[i * lease.stride + component];
    }
    ASSERT_OK(sim, mps_lease_end(sim, &lease));
}

#endif

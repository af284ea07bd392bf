/* SPDX-License-Identifier: BSD-3-Clause */
/* Probes in a tank of 0.4 x 0.3 (x 0.1) m, shared by their tests. */
#ifndef PROBE_FIXTURE_H
#define PROBE_FIXTURE_H

#include "sim.h"
#include "tank_fixture.h"

static const double dp = 0.01;

static inline mps_probe probe_of(int32_t type, double x, double y, double z)
{
    mps_probe p;
    assert_int_equal(mps_probe_init(&p, sizeof p), MPS_OK);
    p.type = type;
    p.at[0] = x;
    p.at[1] = y;
    p.at[2] = z;
    return p;
}

static inline double read_one(mps_sim *sim, const mps_probe *p)
{
    int32_t id = -1;
    double value = NAN;
    ASSERT_OK(sim, mps_probe_add(sim, p, &id));
    assert_int_equal(mps_probe_size(sim, id), 1);
    ASSERT_OK(sim, mps_probe_read(sim, id, &value));
    return value;
}

/* p = 1000 g (level - y) below `level` in the tank's frame, 0 above, on fluid and walls. */
static inline void write_hydrostatic(mps_sim *sim, double level)
{
    static const char *const fields[] = {"pressure", "wall_pressure"};
    const mps__particles *s = &sim->world.particles;
    for (int f = 0; f < 2; f++) {
        mps_lease lease = {.struct_size = sizeof lease};
        ASSERT_OK(sim, mps_lease_begin(sim, fields[f], MPS_WRITE, &lease));
        for (int64_t i = 0; i < lease.count; i++) {
            double X[3];
            mps__motion_to_tank(&sim->world.motion, &sim->world.motion.now, &s->x[i * s->dim], X);
            lease.data[i] = s->kind[i] == MPS_DUMMY ? 0 : 9810 * fmax(0, level - X[1]);
        }
        ASSERT_OK(sim, mps_lease_end(sim, &lease));
    }
}

static inline mps_sim *filled(int32_t dim, double depth)
{
    mps_sim *sim = new_sim(dim, dp);
    add_tank(sim, 0.4, 0.3, 0.1);
    if (depth > 0) fill_depth(sim, 0.4, depth, 0.1);
    write_hydrostatic(sim, depth);
    return sim;
}

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* A tank for steps on a device and on the host. */
#ifndef SHADOW_SCENE_H
#define SHADOW_SCENE_H

#include "checkpoint_fixture.h"
#include "model_fixture.h"
#include "shadow.h"

/* A tank that rolls, half full, with air above the liquid if a preset is for two phases. Nothing asks for fields between its steps. */
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

/* The same with probes, some of which take samples. */
static inline mps_sim *rolling(const char *preset, int32_t dim)
{
    mps_sim *sim = unwatched(preset, dim);
    add_probes(sim);
    return sim;
}

#endif

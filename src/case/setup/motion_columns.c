/* SPDX-License-Identifier: BSD-3-Clause */
/* Columns of the motion of the tank, by degree of freedom of the ship: each one that a motion has
 * or that is free. */
#include "ship_motion.h"
#include <math.h>
#include <stdio.h>

/* A column, in the memory of the case. */
typedef struct motion_column {
    const build_motion *motion;
    int32_t degree;
} motion_column;

static double column_value(void *user, mps_sim *sim)
{
    const motion_column *k = user;
    mps_motion_state tank = {.struct_size = sizeof tank};
    double t, out[MOTION_DEGREES][3];
    if (mps_motion_state_get(sim, &tank) < 0 || mps_sim_time(sim, &t, NULL) < 0) return NAN;
    mps__motion_degrees(k->motion, &tank, t, out);
    /* avoids -0 */
    return (k->degree < MPS_SHIP_ROLL ? 1 : 180 / acos(-1.0)) * out[k->degree][0] + 0.0;
}

void mps__motion_columns(build *b)
{
    const bool body = b->body != NULL;
    const tree_node *map = mps__tree_find(b->root, body ? "body" : "motion");
    for (int32_t d = 0; b->motion && b->status >= 0 && d < MOTION_DEGREES; d++) {
        const bool turn = d >= MPS_SHIP_ROLL;
        char about[BUILD_TEXT];
        if (!b->motion->used[d]) continue;
        mps__build_column(b, mps__degrees[d], turn ? "deg" : "m");
        if (!b->job) continue;
        motion_column *k = mps__build_alloc(b, sizeof *k);
        if (!k) return;
        *k = (motion_column){b->motion, d};
        snprintf(about, sizeof about, "%s of the tank, %s: %s, %s",
                 turn ? "Rotation" : "Displacement", mps__degrees[d],
                 turn ? "about the centre" : "of the centre",
                 body ? "as the body moves" : "as prescribed");
        const mps_status status = mps_job_value_add(b->job, mps__degrees[d], turn ? "deg" : "m",
                                                    about, MPS_JOB_MOTION, column_value, k);
        if (!mps__build_try_job(b, status, map, mps__degrees[d])) return;
    }
}

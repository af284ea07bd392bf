/* SPDX-License-Identifier: BSD-3-Clause */
#include "view.h"

static const mps_lease closed = {.struct_size = sizeof closed};

bool mps__view_open(mps_sim *sim, view *v)
{
    *v = (view){closed, closed, closed};
    if (mps_lease_begin(sim, "position", MPS_READ, &v->x) == MPS_OK &&
        mps_lease_begin(sim, "kind", MPS_READ, &v->kind) == MPS_OK &&
        mps_lease_begin(sim, "phase", MPS_READ, &v->phase) == MPS_OK)
        return true;
    mps__view_close(sim, v);
    return false;
}

bool mps__view_close(mps_sim *sim, view *v)
{
    mps_lease *const all[] = {&v->x, &v->kind, &v->phase};
    bool done = true;
    for (int k = 0; k < 3; k++)
        if (all[k]->stride > 0) done = mps_lease_end(sim, all[k]) == MPS_OK && done;
    return done;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Copies of fields and lists from the device of the last step to the host. */
#include "world.h"
#include <string.h>

/* Error text, with the time of the state that could not be copied. */
static mps_status tell(const mps__world *w, mps_status status)
{
    char why[MPS__ERROR_SIZE];
    if (status >= 0 || w->host.twins.gone[0] || w->host.twins.step) return status;
    memcpy(why, w->context->error, sizeof why);
    return mps__fail(w->context, status,
                     "t = %.9g s: %.300s; the fields of the particles are there alone: try again, "
                     "or read a checkpoint or restore a snapshot",
                     w->state.t, why);
}

mps_status mps__world_fetch(const mps__world *w)
{
    return tell(w, mps__twins_fetch((mps__twins *)&w->host.twins));
}

mps_status mps__world_fetch_field(const mps__world *w, const void *array)
{
    return tell(w, mps__twins_fetch_field((mps__twins *)&w->host.twins, array));
}

mps_status mps__world_write_field(mps__world *w, const void *array)
{
    mps__particles *s = &w->particles;
    const int64_t before = s->changes;
    MPS__TRY(mps__world_fetch_field(w, array));
    s->changes++;
    mps__twins_changed_alone(&w->host.twins, array, before);
    if (array != s->rho) mps__densities_kept(&w->host.densities, s, before);
    if (array == s->x || array == s->u || array == s->rho) return MPS_OK;
    /* sums of the flow, and the next-step flags, depend on these three alone */
    if (w->booked == before) w->booked = s->changes;
    if (w->ahead.changes == before) w->ahead.changes = s->changes;
    return MPS_OK;
}

mps_status mps__world_fetch_searched(const mps__world *w)
{
    return tell(w, mps__twins_fetch_searched((mps__twins *)&w->host.twins));
}

mps_status mps__world_fetch_lists(const mps__world *w)
{
    return tell(w, mps__twins_fetch_lists((mps__twins *)&w->host.twins));
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Copies of fields and lists from the device of the last step to the host. */
#include "world.h"
#include <string.h>

/* Error text, with the time of the state that could not be copied. */
static mps_status report(const mps__world *w, mps_status status)
{
    char why[MPS__ERROR_SIZE];
    if (status >= 0 || w->runner.memory.lost[0] || w->runner.memory.step) return status;
    memcpy(why, w->context->error, sizeof why);
    return mps__fail(w->context, status,
                     "t = %.9g s: %.300s; the newest fields are on the device only: try again, "
                     "or read a checkpoint or restore a snapshot",
                     w->state.t, why);
}

mps_status mps__world_fetch(const mps__world *w)
{
    return report(w, mps__memory_fetch((mps__memory *)&w->runner.memory));
}

mps_status mps__world_fetch_field(const mps__world *w, int32_t field)
{
    return report(w, mps__memory_fetch_field((mps__memory *)&w->runner.memory, field));
}

mps_status mps__world_write_field(mps__world *w, int32_t field)
{
    MPS__TRY(mps__world_fetch_field(w, field));
    mps__array_written(mps__field_array(&w->particles.field[field]), MPS__ON_HOST);
    return MPS_OK;
}

mps_status mps__world_fetch_searched(const mps__world *w)
{
    return report(w, mps__memory_fetch_searched((mps__memory *)&w->runner.memory));
}

mps_status mps__world_fetch_lists(const mps__world *w)
{
    return report(w, mps__memory_fetch_lists((mps__memory *)&w->runner.memory));
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Integers of all particles for tests. */
#ifndef TESTS_TAGS_H
#define TESTS_TAGS_H

#include <mps/particles.h>

static inline mps_status tags_lease(mps_sim *sim, const char *field, mps_lease *lease)
{
    *lease = (mps_lease){.struct_size = sizeof *lease};
    return mps_lease_begin(sim, field, MPS_READ, lease);
}

/* Arrays [mps_particles_count(sim, -1)] of ids, kinds, phases and parts; NULL outputs are skipped.
 * The leases end at once, so that tests can go on: in this library the arrays stay where they are
 * until the next step, add or remove. */
static inline mps_status tags_peek(mps_sim *sim, const int64_t **ids, const int32_t **kinds,
                                   const int32_t **phases, const int32_t **parts)
{
    static const char *const field[] = {"kind", "phase", "part"};
    const int32_t **const out[] = {kinds, phases, parts};
    mps_lease lease;
    if (ids) *ids = NULL;
    mps_status status = tags_lease(sim, "id", &lease);
    if (status == MPS_OK && ids) *ids = lease.ids;
    if (status == MPS_OK) status = mps_lease_end(sim, &lease);
    for (int k = 0; k < 3 && status == MPS_OK; k++) {
        status = tags_lease(sim, field[k], &lease);
        if (status == MPS_OK && out[k]) *out[k] = lease.integers;
        if (status == MPS_OK) status = mps_lease_end(sim, &lease);
    }
    return status;
}

#endif

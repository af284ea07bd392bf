/* SPDX-License-Identifier: BSD-3-Clause */
/* The handle (mps_sim). */
#ifndef MPS_CORE_SIM_H
#define MPS_CORE_SIM_H

#include "contour.h"
#include "probes.h"
#include "world.h"
#include <mps/sim.h>

/* Capacity for the uses of a verb as text. */
enum { MPS__USES_SIZE = 1024 };

/* Lines of the application in the set-up of checkpoints. */
enum { MPS__NOTES = 16, MPS__NOTE_SIZE = 192 };

struct mps_sim {
    mps__context context;
    mps__world world;
    mps__probes probes;
    /* lattice of the last tank, or of all solids */
    bool has_tank;
    bool lattice_of_solids;
    double lattice_lo[3], lattice_h[3]; /* first point, spacing along each axis [m] */
    int64_t lattice_cells[3];
    int64_t slots_logged; /* particles.solids at the last log message about narrow slots */
    /* positions of the solids */
    int32_t solids;
    int64_t solid_capacity;
    mps__distances *solid;
    char uses[MPS__USES_SIZE]; /* of the verb reported last */
    int32_t notes;
    char note[MPS__NOTES][MPS__NOTE_SIZE];
};

/* The context is private state of the handle: a const handle may get a new error text. */
static inline mps__context *mps__sim_context(const mps_sim *sim)
{
    return (mps__context *)&sim->context;
}

/* Refuse a call from a callback if the handle is locked more than `allowed`. */
static inline mps_status mps__sim_free(const mps_sim *sim, int32_t allowed, const char *call)
{
    mps__context *c = mps__sim_context(sim);
    if (c->lock.level <= allowed) return MPS_OK;
    return mps__fail(c, MPS_E_BUSY,
                     "%s() was called from %s: call it when mps_step() or mps_run() has returned",
                     call, c->lock.what);
}

/* Refuse a call that would change particles while they are collected from all ranks. */
static inline mps_status mps__sim_divided(const mps_sim *sim, const char *call)
{
    if (!sim->world.collected.begun) return MPS_OK;
    return mps__fail(mps__sim_context(sim), MPS_E_STATE,
                     "%s() was called while the particles are collected: call "
                     "mps_particles_collect_end() first",
                     call);
}

/* Start of a public function that changes numbers of a simulation: settings, motions, models,
 * probes. Fields stay in the memory space where they are valid. A function that writes one field
 * also calls mps__world_write_field(), a function that reads one mps__world_fetch_field(). */
#define MPS__SETS(sim)                                           \
    do {                                                         \
        if (!(sim)) return MPS_E_ARG;                            \
        MPS__TRY(mps__sim_free((sim), MPS__UNLOCKED, __func__)); \
        MPS__TRY(mps__sim_divided((sim), __func__));             \
    } while (0)
/* Start of a public function that steps, or replaces all fields. */
#define MPS__STEPS(sim) MPS__SETS(sim)
/* Start of a public function that adds or removes particles, or copies all fields to the host. */
#define MPS__CHANGES(sim)                                \
    do {                                                 \
        MPS__SETS(sim);                                  \
        MPS__TRY(mps__world_fetch(&(sim)->world));       \
        mps__particles_written(&(sim)->world.particles); \
    } while (0)
/* Refuse geometry after the ranks have divided the particles: it needs all particles. */
static inline mps_status mps__sim_whole(const mps_sim *sim, const char *call)
{
    if (!sim->world.ghosts.divided) return MPS_OK;
    return mps__fail(mps__sim_context(sim), MPS_E_STATE,
                     "%s() was called when the ranks had divided the particles: build the geometry "
                     "before the first step; particles may be added and removed later",
                     call);
}

/* Start of a public function that builds geometry. */
#define MPS__BUILDS(sim)                           \
    do {                                           \
        MPS__CHANGES(sim);                         \
        MPS__TRY(mps__sim_whole((sim), __func__)); \
    } while (0)
/* Start of a collective public function: each rank contributes what it knows. */
#define MPS__MEASURES(sim)                           \
    do {                                             \
        MPS__READS(sim);                             \
        MPS__TRY(mps__sim_divided((sim), __func__)); \
    } while (0)
/* Start of a public function that reads a simulation but not its particles. */
#define MPS__READS(sim)                                           \
    do {                                                          \
        if (!(sim)) return MPS_E_ARG;                             \
        MPS__TRY(mps__sim_free((sim), MPS__READ_ONLY, __func__)); \
    } while (0)

#endif

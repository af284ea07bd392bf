/* SPDX-License-Identifier: BSD-3-Clause */
/** @file particles.h  Particles: add, remove, stable ids, fields and leases.
 *
 *  Fields are named arrays with a value per particle. The library has:
 *
 *  | field | numbers per particle | type | may be written |
 *  |---|---|---|---|
 *  | "position" [m] | dim | double | yes |
 *  | "velocity" [m/s] | dim | double | yes |
 *  | "pressure" [Pa] | 1 | double | yes |
 *  | "wall_pressure" [Pa], as probes of walls read it | 1 | double | yes |
 *  | "number_density" [-] | 1 | double | yes |
 *  | "density" [kg/m3] | 1 | double | yes |
 *  | "id": number of the particle, constant | 1 | int64_t | no |
 *  | "kind": MPS_FLUID, MPS_WALL, MPS_DUMMY | 1 | int32_t | no |
 *  | "phase": number of the phase of fluid | 1 | int32_t | no |
 *  | "part": number of the part, see mps_part_find(); -1: none | 1 | int32_t | no |
 *  | "region": MPS_REGION_... of mps/model.h in the last step | 1 | int32_t | no |
 *  | "plate": number of the thin plate, from 1; 0: none | 1 | int32_t | no |
 *
 *  "plate" is set for walls of a plate, for walls to which the plate is attached, and for dummies
 *  behind them. Such dummies are inside the liquid of the other side: omit them in pictures.
 *
 *  Fields of the user (mps_field_add()) and of models are permuted with their particles. The order
 *  in memory may change in every step; ids do not change. */
#ifndef MPS_PARTICLES_H
#define MPS_PARTICLES_H

#include <mps/types.h>

MPS_BEGIN_DECLS

/** A block of particles to add; arrays are copied. */
typedef struct mps_particle_block {
    /** Set by mps_particle_block_init(). */
    uint32_t struct_size;
    /** MPS_FLUID, MPS_WALL or MPS_DUMMY */
    int32_t kind;
    /** Phase of fluid particles, 0..15; it must be defined. */
    int32_t phase;
    /** NULL, or the name of the solid part (walls and dummies), at most 31 characters. */
    const char *part;
    /** Number of particles, >= 1. */
    int64_t count;
    /** [count*dim] [m], finite, in the frame of the lab at the current position of the tank. */
    const double *position;
    /** NULL (at rest), or [count*dim] [m/s]; of fluid at most mps_config.speed_limit. Walls take
     *  the velocity of the tank instead. */
    const double *velocity;
    /** NULL (estimated), or [count*dim] wetted area vector of wall particles, into the fluid
     *  [m^(dim-1)]. */
    const double *area;
} mps_particle_block;

/** Set struct_size and zero (kind MPS_FLUID, phase 0).
 *  @param size  sizeof(mps_particle_block) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_particle_block_init(mps_particle_block *block, size_t size);

/** Add particles between steps. Fluid outside the box of the solids is accepted and logged: an open
 *  tank may be filled from above. It is fluid until it leaves the domain or touches a wall from
 *  behind; then it is lost, see mps_config.lost_policy.
 *  @param ids  NULL, or [count] out: their ids, never used before on this handle
 *
 *  | error (the state is unchanged) | reason |
 *  |---|---|
 *  | MPS_E_ARG | no particle, a non-finite value, or two particles closer than 0.1 dp |
 *  | MPS_E_BUSY | a lease is open; called from a monitor, a verb or a callback |
 *  | MPS_E_NOMEM | no memory | */
MPS_API mps_status mps_particles_add(mps_sim *sim, const mps_particle_block *block, int64_t *ids);

/** Remove particles by id, all or none.
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | an id is unknown or occurs twice |
 *  | MPS_E_BUSY | a lease is open; called from a monitor, a verb or a callback |
 *  | MPS_E_NOMEM | no memory | */
MPS_API mps_status mps_particles_remove(mps_sim *sim, int64_t count, const int64_t *ids);

/** Number of particles in a lease; on many ranks including ghosts (mps/ranks.h).
 *  @param kind  a kind, or -1 for all @return the number; -1: invalid argument */
MPS_API int64_t mps_particles_count(const mps_sim *sim, int32_t kind);

/** Index of a particle in the current order, or -1. Valid until the next step, add or remove. */
MPS_API int64_t mps_particle_index(const mps_sim *sim, int64_t id);

/** Add a field of doubles, initialised to zero. It is permuted with the particles.
 *  @param name        1..31 characters, new
 *  @param components  1..9
 *  @return MPS_E_ARG, MPS_E_BUSY (as mps_particles_add()), MPS_E_NOMEM */
MPS_API mps_status mps_field_add(mps_sim *sim, const char *name, int32_t components);

/** Type of the numbers of a lease. */
enum {
    /** mps_lease.data */
    MPS_DATA_DOUBLE = 0,
    /** mps_lease.integers */
    MPS_DATA_INT32 = 1,
    /** mps_lease.ids */
    MPS_DATA_INT64 = 2
};

/** Access to the array of one field, all particles of all kinds, from mps_lease_begin() to
 *  mps_lease_end(). One of the three pointers is not NULL. */
typedef struct mps_lease {
    /** Set by mps_lease_init(), or sizeof(mps_lease) with all other members 0. */
    uint32_t struct_size;
    /** MPS_DATA_... */
    int32_t type;
    /** Numbers per particle. */
    int32_t stride;
    /** Private. */
    int32_t slot;
    /** Number of particles. */
    int64_t count;
    /** [count*stride] numbers of a field of doubles; write only through a lease for writing. */
    double *data;
    /** [count*stride] numbers of a field of int32_t. */
    const int32_t *integers;
    /** [count] numbers of the field "id". */
    const int64_t *ids;
} mps_lease;

/** Initialise a lease that is not open. @param size  sizeof(mps_lease) @return MPS_E_ARG: bad
 *  size */
MPS_API mps_status mps_lease_init(mps_lease *lease, size_t size);

/** How a field is leased. */
enum {
    /** For reading; any number of read leases of a field may be open. */
    MPS_READ = 0,
    /** For reading and writing; no other lease of the field may be open. */
    MPS_WRITE = 1
};

/** Lease a field. While a lease is open, particles are not reordered, and calls that step, add or
 *  remove particles return MPS_E_BUSY.
 *  @param field  its name
 *  @param mode   MPS_READ or MPS_WRITE
 *  @param lease  initialised by mps_lease_init(), or closed by mps_lease_end(); out
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | mode; an uninitialised lease; a read-only field |
 *  | MPS_E_NAME | no field has this name; the text contains the nearest one |
 *  | MPS_E_BUSY | conflict with another lease; called from a verb or a callback | */
MPS_API mps_status mps_lease_begin(mps_sim *sim, const char *field, int32_t mode, mps_lease *lease);

/** End a lease; it can be used for another mps_lease_begin().
 *  @return MPS_E_ARG: the lease is not open, or a written value is not finite, or a density not > 0
 *          (the lease remains open then) */
MPS_API mps_status mps_lease_end(mps_sim *sim, mps_lease *lease);

/** Number of a named part, as in the field "part"; -1: no such part. */
MPS_API int32_t mps_part_find(const mps_sim *sim, const char *name);

MPS_END_DECLS

#endif

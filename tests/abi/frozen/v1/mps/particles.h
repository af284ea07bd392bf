/* SPDX-License-Identifier: BSD-3-Clause */
/** @file particles.h  Particles: add, remove, stable ids, fields and leases.
 *
 *  Built-in fields (components): "position" (dim) [m], "velocity" (dim) [m/s], "pressure" (1) [Pa],
 *  "number_density" (1) [-], "density" (1) [kg/m3]. Further fields are registered with mps_field_add() and travel
 *  with their particles. The order in memory may change at every step; ids never do. */
#ifndef MPS_PARTICLES_H
#define MPS_PARTICLES_H

#include <mps/types.h>

MPS_BEGIN_DECLS

/** A block of particles to add; arrays are read, never kept. */
typedef struct mps_particle_block {
    uint32_t struct_size;   /**< set by mps_particle_block_init() */
    int32_t kind;           /**< MPS_FLUID, MPS_WALL or MPS_DUMMY */
    int32_t phase;          /**< phase of fluid particles, 0..15, defined before */
    const char *part;       /**< NULL, or the name of the solid part (walls and dummies), at most 31 characters */
    int64_t count;          /**< number of particles, >= 1 */
    const double *position; /**< [count*dim] [m], in the lab's frame at the present tank position; finite */
    const double *velocity; /**< NULL (at rest), or [count*dim] [m/s]; walls take the tank's instead */
    const double *area;     /**< NULL (estimated), or [count*dim] wetted area vector of wall particles [m^(dim-1)], into the fluid */
} mps_particle_block;

/** Set every entry to zero (kind MPS_FLUID, phase 0). */
MPS_API mps_status mps_particle_block_init(mps_particle_block *block, size_t size);

/** Add particles between steps.
 *  @param ids  NULL, or [count] out: their ids, never used before on this handle
 *  @return MPS_OK, MPS_E_ARG (no particle, NaN, two particles nearer than 0.1 dp - of the block or to those
 *          there; the state is as before), MPS_E_BUSY, MPS_E_NOMEM */
MPS_API mps_status mps_particles_add(mps_sim *sim, const mps_particle_block *block, int64_t *ids);

/** Remove particles by id, all or none. @return MPS_E_ARG if an id is unknown or given twice */
MPS_API mps_status mps_particles_remove(mps_sim *sim, int64_t count, const int64_t *ids);

/** Count particles of a kind. @param kind a kind, or -1 for all @return the number, or -1 for a bad argument */
MPS_API int64_t mps_particles_count(const mps_sim *sim, int32_t kind);

/** Place of a particle in the present order, or -1. Valid until the next step, add or remove. */
MPS_API int64_t mps_particle_index(const mps_sim *sim, int64_t id);

/** Register a field of doubles that travels with the particles, zero at first.
 *  @param name        1..31 characters, new
 *  @param components  1..9 */
MPS_API mps_status mps_field_add(mps_sim *sim, const char *name, int32_t components);

/** Access to one array of all particles (all kinds), held between mps_lease_begin() and mps_lease_end(). */
typedef struct mps_lease {
    double *data;   /**< [count*stride]; write only through a write lease */
    int64_t count;  /**< particles */
    int32_t stride; /**< doubles per particle */
    int32_t slot;   /**< private */
} mps_lease;

/** How a field is leased: any number of readers or one writer. */
enum { MPS_READ = 0, MPS_WRITE = 1 };

/** Lease a field. While a lease is open the handle refuses to step, add or remove (MPS_E_BUSY).
 *  @param lease  out: the arrays
 *  @return MPS_E_NAME, MPS_E_BUSY (write against read) */
MPS_API mps_status mps_lease_begin(mps_sim *sim, const char *field, int32_t mode, mps_lease *lease);

/** Give a lease back; it becomes empty. Written values must be finite, densities > 0 (else MPS_E_ARG, and the lease stays open). */
MPS_API mps_status mps_lease_end(mps_sim *sim, mps_lease *lease);

/** Read-only views of the integer properties, [mps_particles_count(sim, -1)] each; NULL outputs are skipped.
 *  Valid until the next step, add or remove. */
MPS_API mps_status mps_particles_tags(const mps_sim *sim, const int64_t **ids, const int32_t **kinds, const int32_t **phases,
                                      const int32_t **parts);

/** Thin plates: view [mps_particles_count(sim, -1)] of the number, from 1, of the plate a particle belongs to, else 0: its walls, walls it
 *  stands on, and dummies. These dummies stand behind one side of the plate, that is in the liquid of the other, where nobody sees them:
 *  leave them out of pictures. Valid as those of mps_particles_tags(). */
MPS_API mps_status mps_particles_plates(const mps_sim *sim, const int32_t **plates);

/** Number of a named part, as in the `parts` array, or -1. */
MPS_API int32_t mps_part_find(const mps_sim *sim, const char *name);

MPS_END_DECLS

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* The particle store. All arrays have the same length and travel together when particles are sorted or removed. */
#ifndef MPS_CORE_PARTICLES_H
#define MPS_CORE_PARTICLES_H

#include "parallel.h"

enum { MPS__FIELDS_MAX = 32, MPS__PHASES = MPS_PHASES, MPS__PARTS_MAX = 64, MPS__PART_NAME = 32 };

/* One array that travels with the particles. */
typedef struct mps__field {
    char name[MPS__NAME_SIZE];
    int64_t serial;     /* of this field alone, in whatever order fields are */
    int32_t components; /* per particle */
    size_t size;        /* bytes of a component */
    bool is_public;     /* doubles that may be leased for reading and writing by name */
    bool is_tag;        /* integers that may be leased for reading by name */
    void **data;        /* where the pointer to the array lives */
    void *own;          /* that place for user fields */
    int32_t readers;    /* open leases */
    bool writer;
    double begin; /* value of new particles, of fields of doubles */
    bool stale;   /* owners have newer values than ghosts */
    bool trails;  /* stays the last one, as it will be dropped */
    bool passing; /* a first guess: zeros, where a checkpoint does not have it */
    bool undone;  /* a failed step brings it back from `kept`, */
    bool there;   /* or from where the device of the step keeps it */
    void *kept;
    int64_t kept_capacity;
} mps__field;

typedef struct mps__particles {
    mps__context *context;
    int32_t dim;
    const mps_parallel *parallel; /* to move particles with; NULL: the calling thread */
    int64_t n, capacity, next_id;
    double *x, *u;        /* [n*dim] */
    double *p, *nd, *rho; /* [n] pressure, number density, density */
    double *load;         /* [n] pressure on walls, as probes and forces see it */
    double *ref;          /* [n*dim] place in the tank's frame (solids) */
    double *area;         /* [n*dim] wetted area vector (walls), in the tank's frame */
    int64_t *id;          /* [n] stable, ascending at creation */
    int32_t *kind, *phase, *part;
    int32_t *region; /* [n] MPS_REGION_... of the last step */
    uint8_t *held;   /* [n] 1: its pressure was the least allowed in the last step */
    /* [n] place of a dummy's wall particle, -1: none; follows when particles move */
    int32_t *wall_of;
    int64_t *wall_id; /* on many ranks [n] id of that wall particle, -1: none; else NULL */
    /* [n] number of the screen + 1 of walls of thin plates, of walls they stand on, and of
     * dummies: their shadows */
    int32_t *plate;
    int32_t fields;
    int64_t serials; /* fields that were added so far */
    mps__field field[MPS__FIELDS_MAX];
    int32_t parts;
    char part_name[MPS__PARTS_MAX][MPS__PART_NAME];
    int64_t generation; /* grows when particles come or go */
    int64_t solids;     /* grows when solids come or go */
    int64_t changes;    /* grows when values of fields change outside of the calls of a step */
    bool written;       /* the user wrote a field since ghosts got values of all fields */
    mps__scratch own, *scratch; /* to move particles with: its own, or one shared with others */
} mps__particles;

mps_status mps__particles_init(mps__particles *s, mps__context *context, int32_t dim);
void mps__particles_free(mps__particles *s);

/* Room for `extra` more; on failure nothing changed. */
mps_status mps__particles_reserve(mps__particles *s, int64_t extra);
/* n other particles, with the values of each field in from[], NULL: zeros; on failure nothing changed. */
mps_status mps__particles_replace(mps__particles *s, int64_t n, const void *const from[]);
/* Append `count` zeroed particles of a kind with new ids (room must be reserved). Returns the place of the first. */
int64_t mps__particles_append(mps__particles *s, int64_t count, int32_t kind);
/* Keep particle order[k] at place k for k < count; what is not listed is gone. */
mps_status mps__particles_permute(mps__particles *s, int64_t count, const int32_t *order);
/* The same without fields that are `old`, [fields]: their values are elsewhere. */
mps_status mps__particles_reorder(mps__particles *s, int64_t count, const int32_t *order,
                                  const bool *old);
/* Element order[k] of `from`, of so many bytes, to place k < count of `to`. */
void mps__particles_gather(const mps_parallel *p, void *to, const void *from, int64_t count,
                           const int32_t *order, size_t bytes);
/* So that this cannot fail for at most n particles, until others take its scratch. */
mps_status mps__particles_permute_reserve(mps__particles *s, int64_t n);
mps__field *mps__particles_field(mps__particles *s, const char *name);
mps_status mps__particles_field_add(mps__particles *s, const char *name, int32_t components,
                                    size_t size, bool is_public, void **data);
/* Values of a new field of doubles, of the particles there are and of those to come. */
void mps__particles_field_begin(mps__particles *s, const char *name, double value);
/* The last field is gone. */
void mps__particles_field_drop(mps__particles *s);
/* Number of a named part, added if it is new; -1 if there is no room or the name is too long. */
int32_t mps__part_number(mps__particles *s, const char *name, bool add);
/* Open leases of all fields. */
int32_t mps__particles_leases(const mps__particles *s);

/* A dummy behind one side of a thin plate, which stands in the liquid of the other side. */
static inline bool mps__is_shadow(const mps__particles *s, int64_t i)
{
    return s->plate[i] != 0 && s->kind[i] == MPS_DUMMY;
}

#endif

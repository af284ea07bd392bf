/* SPDX-License-Identifier: BSD-3-Clause */
/* The particle store. All arrays have the same length and are permuted together when particles are
 * sorted or removed. */
#ifndef MPS_CORE_PARTICLES_H
#define MPS_CORE_PARTICLES_H

#include "array.h"

enum { MPS__FIELDS_MAX = 32, MPS__PHASES = MPS_PHASES, MPS__PARTS_MAX = 64, MPS__PART_NAME = 32 };

/* Fields that all particles have, by their index in mps__particles.field. */
enum {
    MPS__FIELD_POSITION,
    MPS__FIELD_VELOCITY,
    MPS__FIELD_PRESSURE,
    MPS__FIELD_NUMBER_DENSITY,
    MPS__FIELD_DENSITY,
    MPS__FIELD_REF,
    MPS__FIELD_AREA,
    MPS__FIELD_ID,
    MPS__FIELD_KIND,
    MPS__FIELD_PHASE,
    MPS__FIELD_PART,
    MPS__FIELD_REGION,
    MPS__FIELD_WALL_OF,
    MPS__FIELD_PLATE,
    MPS__FIELD_WALL_PRESSURE,
    MPS__FIELD_HELD,
    MPS__FIELDS_OWN
};

/* One per-particle array. */
typedef struct mps__field {
    char name[MPS__NAME_SIZE];
    int32_t components; /* per particle */
    size_t size;        /* bytes of a component */
    bool is_public;     /* doubles that may be leased for reading and writing by name */
    bool is_tag;        /* integers that may be leased for reading by name */
    void **data;        /* address of the pointer to the array */
    void *own;          /* this pointer, for user fields */
    int32_t readers;    /* open leases */
    bool writer;
    double begin;     /* initial value for new particles, of fields of doubles */
    bool trails;      /* stays the last field, as it will be dropped */
    bool passing;     /* a first guess: zero if a checkpoint does not have it */
    mps__array array; /* its `host` is set by mps__field_array() */
} mps__field;

typedef struct mps__particles {
    mps__context *context;
    int32_t dim;
    const mps_parallel *parallel; /* for permutations; NULL: the calling thread */
    int64_t n, capacity, next_id;
    double *x, *u;        /* [n*dim] */
    double *p, *nd, *rho; /* [n] pressure, number density, density */
    double *load;         /* [n] pressure on walls, for probes and forces */
    double *ref;          /* [n*dim] position in the tank's frame (solids) */
    double *area;         /* [n*dim] wetted area vector (walls), in the tank's frame */
    int64_t *id;          /* [n] stable, ascending at creation */
    int32_t *kind, *phase, *part;
    int32_t *region; /* [n] MPS_REGION_... of the last step */
    uint8_t *active; /* [n] 1: its lower bound of the pressure was active in the last step */
    /* [n] index of a dummy's wall particle, -1: none; updated by permutations */
    int32_t *wall_of;
    int64_t *wall_id; /* on many ranks [n] id of that wall particle, -1: none; else NULL */
    /* [n] index + 1 of the occluder, for walls of thin plates, walls they are attached to, and
     * dummies that are their shadows */
    int32_t *plate;
    int32_t fields;
    mps__field field[MPS__FIELDS_MAX];
    int32_t parts;
    char part_name[MPS__PARTS_MAX][MPS__PART_NAME];
    int64_t generation; /* incremented when particles are added or removed */
    int64_t solids;     /* incremented when solids are added or removed */
    bool written;       /* the user wrote a field since the last halo exchange of all fields */
    mps__scratch own, *scratch; /* workspace of permutations: own, or shared with others */
} mps__particles;

/* The array of a field. */
static inline mps__array *mps__field_array(mps__field *f)
{
    f->array.host = *f->data;
    return &f->array;
}
/* Bytes of a field per particle. */
static inline size_t mps__field_element(const mps__field *f)
{
    return (size_t)f->components * f->size;
}
/* The host has new values of all fields. */
void mps__particles_written(mps__particles *s);
/* Versions of the fields that the sums of the flow depend on: another number if one has changed. */
static inline int64_t mps__particles_flow(const mps__particles *s)
{
    return s->field[MPS__FIELD_POSITION].array.version +
           s->field[MPS__FIELD_VELOCITY].array.version + s->field[MPS__FIELD_DENSITY].array.version;
}

mps_status mps__particles_init(mps__particles *s, mps__context *context, int32_t dim);
void mps__particles_free(mps__particles *s);

/* Capacity for `extra` more particles; unchanged on failure. */
mps_status mps__particles_reserve(mps__particles *s, int64_t extra);
/* Replace all particles by n others, with the values of each field in from[], NULL: zeros;
 * unchanged on failure. */
mps_status mps__particles_replace(mps__particles *s, int64_t n, const void *const from[]);
/* Append `count` zeroed particles of a kind with new ids (capacity must be reserved). Returns the
 * index of the first. */
int64_t mps__particles_append(mps__particles *s, int64_t count, int32_t kind);
/* Move particle order[k] to index k for k < count; particles that are not in `order` are
 * removed. */
mps_status mps__particles_permute(mps__particles *s, int64_t count, const int32_t *order);
/* mps__particles_permute() without the fields marked in `stale` [fields], whose values are
 * elsewhere. */
mps_status mps__particles_reorder(mps__particles *s, int64_t count, const int32_t *order,
                                  const bool *stale);
/* Copy element order[k] of `from`, of `bytes` bytes, to index k < count of `to`. */
void mps__particles_permute_values(const mps_parallel *p, void *to, const void *from, int64_t count,
                                   const int32_t *order, size_t bytes);
/* After this call mps__particles_permute() cannot fail for up to n particles, until the workspace
 * is used otherwise. */
mps_status mps__particles_permute_reserve(mps__particles *s, int64_t n);
mps__field *mps__particles_field(mps__particles *s, const char *name);
mps_status mps__particles_field_add(mps__particles *s, const char *name, int32_t components,
                                    size_t size, bool is_public, void **data);
/* Initial value of a new field of doubles, for existing and future particles. */
void mps__particles_field_begin(mps__particles *s, const char *name, double value);
void mps__particles_field_drop(mps__particles *s);
/* Number of a named part, added if it is new; -1 if the table is full or the name is too long. */
int32_t mps__part_number(mps__particles *s, const char *name, bool add);
/* Open leases of all fields. */
int32_t mps__particles_leases(const mps__particles *s);

/* Whether a particle is a dummy behind one side of a thin plate, inside the liquid of the other
 * side. */
static inline bool mps__is_shadow(const mps__particles *s, int64_t i)
{
    return s->plate[i] != 0 && s->kind[i] == MPS_DUMMY;
}

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* Void spaces of the tank on a raster of cells: mps/voids.h. Slabs are the layers of cells across the last axis, which mostly points upwards in the
 * tank. The band is the slabs up to the highest liquid: those above it hold void alone, and are not looked at cell by cell. */
#ifndef MPS_CORE_VOIDS_H
#define MPS_CORE_VOIDS_H

#include "ghosts.h"
#include <mps/voids.h>

struct mps__world;

/* Bits of mps__voids.mask: 1 << d: a thin plate cuts the link to the next cell along axis d; and: */
enum { MPS__MASK_SOLID = 8 };

/* What a cell is. The least of all ranks counts. */
enum { MPS__CELL_LIQUID, MPS__CELL_NARROW, MPS__CELL_DEEP, MPS__CELL_SOLID };

/* Arrays of faces. */
enum {
    MPS__VOID_FACE_LABEL,
    MPS__VOID_FACE_CELL,
    MPS__VOID_FACE_SIDE,
    MPS__VOID_FACE_BEHIND,
    MPS__VOID_FACE_ROW,
    MPS__VOID_FACE
};

/* Memory that is kept from step to step, and grows. */
typedef struct mps__void_room {
    int64_t mask, ullage, slab, square, nearest, what, label, parent, found, number, queue, size;
    int64_t face[MPS__VOID_FACE];
} mps__void_room;

typedef struct mps__voids {
    mps__context *context;
    mps_voids_config config; /* of the results, with the defaults put in */
    bool ready;              /* the results are those of the step in progress */
    int32_t dim;
    /* the raster */
    bool made;
    int64_t solids;   /* mps__particles.solids of those in it */
    double side;      /* of a cell [m] */
    double origin[3]; /* [m] */
    int32_t cells[3]; /* along the axes */
    int32_t slabs;    /* cells along the last axis */
    int64_t total;    /* cells in all, */
    int64_t plane;    /* in a slab */
    int64_t step[3];  /* from a cell to the next one along each axis */
    uint8_t *mask;    /* [total] */
    int32_t parts;    /* components while they are joined */
    int64_t *
        ullage; /* [slabs + 1] cells from a slab upwards that are not solid; -1: some do not hang together */
    /* the search */
    int32_t band;         /* slabs that it looks at */
    double reach;         /* of a particle, the channel, [side] */
    float cover2, reach2; /* squares of both [side^2] */
    int32_t *slab;        /* [n] of liquid particles, -1 of others */
    float *square;        /* [cells of the band] to the nearest particle [side^2] */
    int32_t *nearest;     /* [cells of the band] its row, -1: none within reach */
    uint8_t *what;        /* [cells of the band] MPS__CELL_... */
    int32_t *label;       /* [total] */
    int32_t constant;     /* slabs from here on have the label `ambient` where they are not solid */
    int32_t ambient;
    int32_t *parent; /* of provisional components: one that it was joined to, or itself */
    int64_t *found;  /* cells of components before they are numbered */
    int32_t *number; /* the numbers that they get */
    int32_t *queue;  /* cells that the void has grown into */
    /* the results */
    int32_t count;
    int32_t *size; /* [count] */
    int64_t faces;
    int32_t *face[MPS__VOID_FACE]; /* [faces] */
    mps__void_room room;
} mps__voids;

void mps__voids_init(mps__voids *v, mps__context *context);
void mps__voids_free(mps__voids *v);
/* The raster of a tank, unless it is there. voids_mask.c */
mps_status mps__voids_raster(mps__voids *v, struct mps__world *w);
/* What each cell of the band is, and the particle nearest to it. voids_stamp.c */
mps_status mps__voids_stamp(mps__voids *v, struct mps__world *w, mps_stage *s);
/* Components of the void, and their numbers. voids_label.c */
mps_status mps__voids_label(mps__voids *v);
/* Faces of components, if there are two or more. voids_faces.c */
mps_status mps__voids_faces(mps__voids *v, const mps__ghosts *g);
/* The number that stands for a provisional component, the least one of those that were joined. */
int32_t mps__voids_root(int32_t *parent, int32_t k);
/* Join two of them. @return whether they were two */
bool mps__voids_join(int32_t *parent, int32_t a, int32_t b);
/* Room for one more number in a list. */
mps_status mps__voids_push(mps__voids *v, int32_t **list, int64_t *room, int64_t used);

/* Coordinates of a cell. */
static inline void mps__voids_place(const mps__voids *v, int64_t cell, int32_t at[3])
{
    const int64_t line = cell / v->cells[0];
    at[0] = (int32_t)(cell % v->cells[0]);
    at[1] = (int32_t)(line % v->cells[1]);
    at[2] = (int32_t)(line / v->cells[1]);
}

/* The cell beside another on side 2 d or 2 d + 1, -1: the raster ends, or a plate lies between. */
static inline int64_t mps__voids_beside(const mps__voids *v, int64_t cell, const int32_t at[3],
                                        int32_t side)
{
    const int32_t d = side / 2;
    if (side % 2) {
        if (at[d] + 1 == v->cells[d] || v->mask[cell] >> d & 1) return -1;
        return cell + v->step[d];
    }
    if (at[d] == 0 || v->mask[cell - v->step[d]] >> d & 1) return -1;
    return cell - v->step[d];
}

#endif

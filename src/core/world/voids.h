/* SPDX-License-Identifier: BSD-3-Clause */
/* Void spaces of the tank on a raster of cells: mps/voids.h. Slabs are the layers of cells across the last axis, which mostly points upwards in the
 * tank. The band is the slabs up to the highest liquid: those above it hold void alone, and are not looked at cell by cell. */
#ifndef MPS_CORE_VOIDS_H
#define MPS_CORE_VOIDS_H

#include "ghosts.h"
#include <mps/voids.h>

struct mps__world;

/* Bits of mps__voids.mask: 1 << d: a thin plate cuts the link to the next cell along axis d; and: */
enum {
    MPS__MASK_SOLID = 8,
    MPS__MASK_PLATE = 16, /* one is near */
    MPS__MASK_DRY = 32    /* solid as long as no liquid is in its compartment */
};

/* Spaces that solids part; those beyond the last number count as one. */
enum { MPS__COMPARTMENTS = 256 };

/* Cells that ranks combine at once. */
enum { MPS__VOID_LUMP = 64 };

/* What a cell is. The least of all ranks counts. */
enum {
    MPS__CELL_LIQUID,
    MPS__CELL_NARROW,
    MPS__CELL_DEEP,
    MPS__CELL_SOLID,
    MPS__CELL_COVERED /* one of the first two: it was not needed yet which one */
};

/* Arrays of faces. */
enum {
    MPS__VOID_FACE_LABEL,
    MPS__VOID_FACE_CELL,
    MPS__VOID_FACE_SIDE,
    MPS__VOID_FACE_BEHIND,
    MPS__VOID_FACE_ROW,
    MPS__VOID_FACE
};

/* A cell from which a particle may reach another cell. */
typedef struct mps__void_offset {
    int32_t at[3];
    int64_t cell; /* difference of the numbers */
    double least; /* square of the least distance of its places from the other's centre [side^2] */
} mps__void_offset;

/* Cells begin .. end-1 of a line, all of them deep, with links between them. */
typedef struct mps__void_run {
    int32_t begin, end, part; /* part: provisional component */
} mps__void_run;

/* Memory that is kept from step to step, and grows. */
typedef struct mps__void_room {
    int64_t mask, space, ullage, offset, place, slab, next, head, taken, sure, wide, what;
    int64_t marks, label, run, parent, found, number, queue, size, face[MPS__VOID_FACE];
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
    uint8_t *
        space; /* [total] number of the compartment that a cell is in, 0: solid; where there are two or more */
    int32_t spaces;                 /* compartments */
    uint8_t wet[MPS__COMPARTMENTS]; /* 1: liquid is in it, as the mask has it */
    uint8_t *marks;                 /* [lines along the first axis] all bits of the mask in it */
    int64_t *
        ullage; /* [slabs + 1] void cells from a slab upwards; -1: they are more than one component */
    /* who reaches a cell */
    double cover2, reach2; /* squares of `cover` and `channel` [side^2] */
    int32_t window;        /* cells along an axis that the channel reaches over */
    int32_t offsets;
    mps__void_offset *offset; /* [offsets] by distance */
    bool octant_sure; /* a particle is within the channel of its cell and those on its side of it */
    bool beside_sure; /* and of all those that share a side with its cell */
    bool own_covers;  /* a particle in the cell is within the cover */
    /* the search */
    int32_t band;     /* slabs that it looks at */
    double *place;    /* [n*dim] of liquid particles [side] */
    int32_t *slab;    /* [n] theirs, -1 of others */
    int32_t *next;    /* [n] another particle of the same cell, -1: none */
    int32_t *head;    /* [cells of the band] a particle in it, where there is one */
    uint8_t *taken;   /* [cells of the band] 1: there is one */
    uint8_t *sure;    /* [cells of the band] 1: one is within the channel; 0: perhaps */
    uint8_t *wide;    /* [cells of the band] 1: there is one in its slab within the window */
    uint8_t *what;    /* [cells of the band] MPS__CELL_... */
    int32_t *label;   /* [total] */
    int32_t constant; /* slabs from here on have the label `ambient` where they are not solid */
    int32_t ambient;
    mps__void_run *run;
    int64_t runs;
    int32_t parts;   /* components while they are joined */
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
/* Cells from which the cover and the channel reach a cell. voids.c */
mps_status mps__voids_offsets(mps__voids *v);
/* The raster of a tank, unless it is there. voids_mask.c */
mps_status mps__voids_raster(mps__voids *v, struct mps__world *w);
/* The mask knows which compartments liquid is in now. voids_mask.c */
mps_status mps__voids_wet(mps__voids *v, struct mps__world *w);
/* Liquid particles, by the cells that they are in, and the band. voids_liquid.c */
mps_status mps__voids_liquid(mps__voids *v, struct mps__world *w, mps_stage *s);
/* What each cell of the band is. voids_cells.c */
mps_status mps__voids_cells(mps__voids *v, struct mps__world *w);
/* Whether a cell is narrow, which is found out when it is asked for. */
bool mps__voids_is_narrow(mps__voids *v, const struct mps__world *w, int64_t cell);
/* The least squared distance of a particle from a cell [side^2], and its row; from `enough` downwards any that is found. INFINITY, -1: none
 * within the channel. */
double mps__voids_nearest(const mps__voids *v, const struct mps__world *w, int64_t cell,
                          double enough, int32_t *row);
/* Components of the void, and their numbers. voids_label.c */
mps_status mps__voids_label(mps__voids *v, const struct mps__world *w);
/* Faces of components, if there are two or more. voids_faces.c */
mps_status mps__voids_faces(mps__voids *v, const struct mps__world *w);
/* The number that stands for a provisional component, the least one of those that were joined. */
int32_t mps__voids_root(int32_t *parent, int32_t k);
/* Join two of them. @return whether they were two */
bool mps__voids_join(int32_t *parent, int32_t a, int32_t b);
/* Room for one more number in a list. */
mps_status mps__voids_push(mps__voids *v, int32_t **list, int64_t *room, int64_t used);

/* Coordinates of a cell. */
static inline void mps__voids_place(const mps__voids *v, int64_t cell, int32_t at[3])
{
    const uint32_t c = (uint32_t)cell, line = c / (uint32_t)v->cells[0];
    at[0] = (int32_t)(c - line * (uint32_t)v->cells[0]);
    at[2] = v->dim == 2 ? 0 : (int32_t)(line / (uint32_t)v->cells[1]);
    at[1] = (int32_t)line - at[2] * v->cells[1];
}

/* The cell of a place [side], -1: beyond the raster. */
static inline int64_t mps__voids_cell(const mps__voids *v, const double *place)
{
    int64_t cell = 0;
    for (int d = v->dim - 1; d >= 0; d--) {
        if (!(place[d] >= 0 && place[d] < v->cells[d])) return -1;
        cell = cell * v->cells[d] + (int64_t)place[d];
    }
    return cell;
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

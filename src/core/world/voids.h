/* SPDX-License-Identifier: BSD-3-Clause */
/* Void spaces of the tank on a raster of cells: mps/voids.h. Slabs are the layers of cells across
 * the last axis, which usually points upwards in the tank. The band is the slabs up to the highest
 * liquid; slabs above it contain only void and are not examined cell by cell. */
#ifndef MPS_CORE_VOIDS_H
#define MPS_CORE_VOIDS_H

#include "ghosts.h"
#include <mps/voids.h>

struct mps__world;

/* Bits of mps__voids.mask: 1 << d: a thin plate cuts the link to the next cell along axis d;
 * and: */
enum {
    MPS__MASK_SOLID = 8,
    MPS__MASK_PLATE = 16, /* a thin plate is near */
    MPS__MASK_DRY = 32    /* counts as solid while its compartment has no liquid */
};

/* Largest number of compartments, spaces separated by solids; any further ones count as one. */
enum { MPS__COMPARTMENTS = 256 };

/* Cells in one message of a reduction over ranks. */
enum { MPS__VOID_LUMP = 64 };

/* Class of a cell; over ranks the minimum applies. */
enum {
    MPS__CELL_LIQUID,
    MPS__CELL_NARROW,
    MPS__CELL_DEEP,
    MPS__CELL_SOLID,
    MPS__CELL_COVERED /* one of the first two, not decided yet */
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

/* Offset of a cell whose particles may be within the channel of another cell. */
typedef struct mps__void_offset {
    int32_t at[3];
    int64_t cell; /* difference of the cell indices */
    double least; /* square of the least distance of its points from the other's centre [side^2] */
} mps__void_offset;

/* Run of deep cells begin .. end-1 in a line, linked to each other. */
typedef struct mps__void_run {
    int32_t begin, end, part; /* part: provisional component */
} mps__void_run;

/* Capacities of the arrays, which are kept from step to step. */
typedef struct mps__void_capacity {
    int64_t mask, space, ullage, offset, place, slab, next, head, taken, sure, wide, what;
    int64_t marks, label, run, parent, found, number, queue, size, face[MPS__VOID_FACE];
} mps__void_capacity;

typedef struct mps__voids {
    mps__context *context;
    mps_voids_config config; /* of the results, with defaults filled in */
    bool ready;              /* the results are those of the step in progress */
    int32_t dim;
    /* the raster */
    bool made;
    int64_t solids;   /* value of mps__particles.solids when it was made */
    double side;      /* of a cell [m] */
    double origin[3]; /* [m] */
    int32_t cells[3]; /* along the axes */
    int32_t slabs;    /* cells along the last axis */
    int64_t total;    /* cells in all */
    int64_t plane;    /* in a slab */
    int64_t step[3];  /* index difference of neighbouring cells along each axis */
    uint8_t *mask;    /* [total] */
    uint8_t *space;   /* [total] compartment of each cell, 0: solid; if there are two or more */
    int32_t spaces;   /* compartments */
    uint8_t wet[MPS__COMPARTMENTS]; /* 1: the compartment has liquid, as assumed in the mask */
    /* [lines along the first axis] union of the mask bits of a line */
    uint8_t *marks;
    /* [slabs + 1] void cells from a slab upwards; -1: they have more than one component */
    int64_t *ullage;
    /* distances */
    double cover2, reach2; /* squares of `cover` and `channel` [side^2] */
    int32_t window;        /* cells along an axis within `channel` */
    int32_t offsets;
    mps__void_offset *offset; /* [offsets] by distance */
    /* a particle is always within the channel of its own cell and of those on its side */
    bool octant_sure;
    bool beside_sure; /* and of all cells that share a side with its own */
    bool own_covers;  /* a particle is always within the cover of its own cell */
    /* the search */
    int32_t band;     /* examined slabs */
    double *place;    /* [n*dim] positions of liquid particles [side] */
    int32_t *slab;    /* [n] slabs of liquid particles, -1 for others */
    int32_t *next;    /* [n] linked list of the particles of a cell, -1: end */
    int32_t *head;    /* [cells of the band] first particle, if there is one */
    uint8_t *taken;   /* [cells of the band] not 0: has a particle */
    uint8_t *sure;    /* [cells of the band] 1: a particle is within the channel; 0: unknown */
    uint8_t *wide;    /* [cells of the band] 1: a particle is within the window in this slab */
    uint8_t *what;    /* [cells of the band] MPS__CELL_... */
    int32_t *label;   /* [total] */
    int32_t constant; /* slabs from here on have the label `ambient` where they are not solid */
    int32_t ambient;
    mps__void_run *run;
    int64_t runs;
    int32_t parts;   /* number of provisional components */
    int32_t *parent; /* union-find of provisional components */
    int64_t *found;  /* number of cells by provisional component */
    int32_t *number; /* final number by provisional component */
    int32_t *queue;  /* narrow cells that a component has grown into */
    /* the results */
    int32_t count;
    int32_t *size; /* [count] */
    int64_t faces;
    int32_t *face[MPS__VOID_FACE]; /* [faces] */
    mps__void_capacity capacity;
} mps__voids;

void mps__voids_init(mps__voids *v, mps__context *context);
void mps__voids_free(mps__voids *v);
/* Cell offsets within cover and channel. voids.c */
mps_status mps__voids_offsets(mps__voids *v);
/* Make the raster of a tank, unless it is valid. voids_mask.c */
mps_status mps__voids_raster(mps__voids *v, struct mps__world *w);
/* Update the mask for the compartments that have liquid now. voids_mask.c */
mps_status mps__voids_wet(mps__voids *v, struct mps__world *w);
/* Assign liquid particles to cells, and set the band. voids_liquid.c */
mps_status mps__voids_liquid(mps__voids *v, struct mps__world *w, mps_stage *s);
/* Classify the cells of the band. voids_cells.c */
mps_status mps__voids_cells(mps__voids *v, struct mps__world *w);
/* Whether a cell is narrow; evaluated on demand. */
bool mps__voids_is_narrow(mps__voids *v, const struct mps__world *w, int64_t cell);
/* The least squared distance of a particle from a cell [side^2], and its index; any distance below
 * `enough` may be returned. INFINITY, -1: none within the channel. */
double mps__voids_nearest(const mps__voids *v, const struct mps__world *w, int64_t cell,
                          double enough, int32_t *row);
/* Components of the void, and their numbers. voids_label.c */
mps_status mps__voids_label(mps__voids *v, const struct mps__world *w);
/* Faces of components, if there are two or more. voids_faces.c */
mps_status mps__voids_faces(mps__voids *v, const struct mps__world *w);
/* Representative of a provisional component, the least number of its set. */
int32_t mps__voids_root(int32_t *parent, int32_t k);
/* Union of two components. @return whether they were different */
bool mps__voids_join(int32_t *parent, int32_t a, int32_t b);
/* Capacity for one more element of a list. */
mps_status mps__voids_push(mps__voids *v, int32_t **list, int64_t *capacity, int64_t used);

/* Coordinates of a cell. */
static inline void mps__voids_place(const mps__voids *v, int64_t cell, int32_t at[3])
{
    const uint32_t c = (uint32_t)cell, line = c / (uint32_t)v->cells[0];
    at[0] = (int32_t)(c - line * (uint32_t)v->cells[0]);
    at[2] = v->dim == 2 ? 0 : (int32_t)(line / (uint32_t)v->cells[1]);
    at[1] = (int32_t)line - at[2] * v->cells[1];
}

/* The cell of a position [side], -1: outside of the raster. */
static inline int64_t mps__voids_cell(const mps__voids *v, const double *place)
{
    int64_t cell = 0;
    for (int d = v->dim - 1; d >= 0; d--) {
        if (!(place[d] >= 0 && place[d] < v->cells[d])) return -1;
        cell = cell * v->cells[d] + (int64_t)place[d];
    }
    return cell;
}

/* The neighbour of a cell on side 2 d or 2 d + 1, -1: end of the raster, or separated by a
 * plate. */
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

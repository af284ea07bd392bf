/* SPDX-License-Identifier: BSD-3-Clause */
/* A surface of triangles (in 2-D of segments) and the distance to it. */
#ifndef MPS_CORE_MESH_H
#define MPS_CORE_MESH_H

#include "base.h"

/* A box of the tree; leaves contain elements order[first .. first + count). */
typedef struct mps__mesh_node {
    double lo[3], hi[3];
    int32_t first, count, right; /* the left child follows its parent; count > 0: a leaf */
} mps__mesh_node;

typedef struct mps__mesh {
    mps__context *context;
    int32_t dim;
    int64_t points, elements, point_capacity, element_capacity, nodes;
    double *x;            /* [3*points], z = 0 in 2-D */
    int32_t *corner;      /* [3*elements]; in 2-D the third is unused */
    double *point_normal; /* [3*points] angle-weighted, not unit */
    /* [9*elements] 3-D: sum of the normals of the faces at edge corner k .. k+1 */
    double *edge_normal;
    mps__mesh_node *node;
    int32_t *order;
    double size; /* longest side of the bounding box */
} mps__mesh;

/* Faults of a surface. */
typedef struct mps__mesh_faults {
    int64_t degenerate; /* triangles without area, removed */
    int64_t open;       /* edges with one triangle only */
    int64_t turned;     /* edges whose triangles have inconsistent orientation */
    int64_t twice;      /* duplicate triangles, removed */
    int64_t joined;     /* points at open edges that were merged with a near one */
    double gap;         /* largest distance between merged points */
    double open_at[3], turned_at[3];
} mps__mesh_faults;

/* Shells of a closed surface in 3-D: parts without common points. */
typedef struct mps__mesh_shells {
    int64_t count, within; /* shells; shells within another one, not determined for more than 32 */
    double inner, outer;   /* volumes of the first nested shell and of the one around it */
    int64_t places, wrong; /* sample points in its box; those that are not enclosed 0 or 1 times */
    double times, wrong_at[3];
} mps__mesh_shells;

void mps__mesh_init(mps__mesh *m, mps__context *context, int32_t dim);
void mps__mesh_free(mps__mesh *m);
/* Reserve capacity for that many more points (3 numbers each) and elements. */
mps_status mps__mesh_reserve(mps__mesh *m, int64_t points, int64_t elements);
/* Merge points with equal coordinates, remove degenerate elements and duplicate triangles, check
 * the edges (3-D), compute normals. Points of open edges within `tolerance` of each other are
 * merged. The normal of a segment is on its right. */
mps_status mps__mesh_weld(mps__mesh *m, double tolerance, mps__mesh_faults *faults);
/* Bounding box of all points. */
void mps__mesh_box(const mps__mesh *m, double lo[3], double hi[3]);
/* Enclosed volume, > 0 if the normals (counter-clockwise) point outwards. */
double mps__mesh_volume(const mps__mesh *m);
mps_status mps__mesh_find_shells(const mps__mesh *m, mps__mesh_shells *out);
double mps__mesh_area(const mps__mesh *m);
/* Reverse the orientation of all triangles and normals. */
void mps__mesh_turn(mps__mesh *m);
/* Edges of a welded surface in 3-D where faces meet at more than an angle, in the order of their
 * triangles.
 * @param ends  [6*capacity] two end points of each of the first edges @return how many there are */
int64_t mps__mesh_edges(const mps__mesh *m, double angle, int64_t capacity, double *ends);
/* Build the tree; call it before the first distance. */
mps_status mps__mesh_finish(mps__mesh *m);
/* Distance to the surface, > 0 on the side of the normals. `foot`: the nearest point on it; `n`:
 * unit vector from there to the side of the normals. Both may be NULL. */
double mps__mesh_distance(const mps__mesh *m, const double x[3], double foot[3], double n[3]);

#endif

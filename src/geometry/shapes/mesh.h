/* SPDX-License-Identifier: BSD-3-Clause */
/* A surface of triangles (in 2-D of segments) and the distance to it. */
#ifndef MPS_CORE_MESH_H
#define MPS_CORE_MESH_H

#include "base.h"

/* A box of the tree; leaves hold elements order[first .. first + count). */
typedef struct mps__mesh_node {
    double lo[3], hi[3];
    int32_t first, count, right; /* the left child follows its parent; count > 0: a leaf */
} mps__mesh_node;

typedef struct mps__mesh {
    mps__context *context;
    int32_t dim;
    int64_t points, elements, point_capacity, element_capacity, nodes;
    double *x;            /* [3*points], z = 0 in 2-D */
    int32_t *corner;      /* [3*elements], in 2-D the third is not used */
    double *point_normal; /* [3*points] angle-weighted, not unit */
    /* [9*elements] 3-D: sum of the normals of the faces at edge corner k .. k+1 */
    double *edge_normal;
    mps__mesh_node *node;
    int32_t *order;
    double size; /* longest side of the bounding box */
} mps__mesh;

/* What is wrong with a surface. */
typedef struct mps__mesh_faults {
    int64_t degenerate; /* triangles without area, removed */
    int64_t open;       /* edges with one triangle only */
    int64_t turned;     /* edges whose triangles do not go around them in opposite directions */
    int64_t twice;      /* triangles that were there before, removed */
    int64_t joined;     /* points at open edges that became one with another one nearby */
    double gap;         /* widest distance between such points */
    double open_at[3], turned_at[3];
} mps__mesh_faults;

/* Shells of a closed surface in 3-D: parts that share no point. */
typedef struct mps__mesh_shells {
    int64_t count,
        within; /* of them, and of those within another one; of more than 32 this is not known */
    double inner, outer;   /* volumes of the first of these and of the one around it */
    int64_t places, wrong; /* places of its box, and those that are not enclosed 0 or 1 times */
    double times, wrong_at[3];
} mps__mesh_shells;

void mps__mesh_init(mps__mesh *m, mps__context *context, int32_t dim);
void mps__mesh_free(mps__mesh *m);
/* Room for that many more points (3 numbers each) and elements. */
mps_status mps__mesh_reserve(mps__mesh *m, int64_t points, int64_t elements);
/* Make points with equal coordinates one, remove degenerate elements and triangles that are there twice, look at the edges (3-D), compute
 * normals. Points of open edges that are within `tolerance` of each other become one. The normal of a segment is on its right. */
mps_status mps__mesh_weld(mps__mesh *m, double tolerance, mps__mesh_faults *faults);
/* Enclosed volume, > 0 if the normals (counter-clockwise) look out. */
double mps__mesh_volume(const mps__mesh *m);
mps_status mps__mesh_find_shells(const mps__mesh *m, mps__mesh_shells *out);
double mps__mesh_area(const mps__mesh *m);
/* Turn all triangles over, with their normals. */
void mps__mesh_turn(mps__mesh *m);
/* Edges of a welded surface in 3-D where faces meet at more than an angle, in the order of their triangles.
 * @param ends  [6*room] two places of each of the first ones @return how many there are */
int64_t mps__mesh_edges(const mps__mesh *m, double angle, int64_t room, double *ends);
/* Build the tree; before the first question for a distance. */
mps_status mps__mesh_finish(mps__mesh *m);
/* Distance to the surface, > 0 on the side the normals look to. `foot`: the nearest place on it; `n`: unit vector from there to the side
 * the normals look to. Both may be NULL. */
double mps__mesh_distance(const mps__mesh *m, const double x[3], double foot[3], double n[3]);

#endif

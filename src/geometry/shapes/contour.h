/* SPDX-License-Identifier: BSD-3-Clause */
/* Signed distances of solids, and their zero surface as points and small patches. */
#ifndef MPS_CORE_CONTOUR_H
#define MPS_CORE_CONTOUR_H

#include "base.h"
#include "mesh.h"
#include <mps/geometry.h>

/* Distances on a lattice lo + k dp, k < n. */
typedef struct mps__distances {
    double lo[3], dp;
    int32_t dim;
    int64_t n[3];
    double *value;
} mps__distances;

/* Where the liquid may be. All distances are > 0 there. */
typedef struct mps__shape {
    int32_t dim;
    double dp, sign;          /* sign: -1 if the caller's distance or side is reversed */
    mps_distance_fn distance; /* or */
    mps_inside_fn inside;     /* which is non-zero in the solid, or */
    /* a welded mesh whose normals point to the liquid; if `inside` is set, it determines the
     * side */
    const mps__mesh *mesh;
    void *user;
    /* NULL, or distances of a mesh on a lattice, so that none are computed far from it */
    const mps__distances *known;
} mps__shape;

/* Distance from the shape's source; may be NaN. With `inside` alone: +-dp. */
double mps__shape_at(const mps__shape *s, const double x[3]);
/* Distance over its slope: accurate near the surface even if the given function is no exact
 * distance. n: unit normal into the liquid, NULL allowed. */
double mps__shape_true(const mps__shape *s, const double x[3], double n[3]);
/* Project x onto the surface. False if it is not reached within `reach`. */
bool mps__shape_project(const mps__shape *s, double x[3], double reach);
/* Project x onto the nearest edge or corner of the surface within about a third of dp; otherwise
 * onto the surface. */
bool mps__shape_project_feature(const mps__shape *s, double x[3]);

/* Distances of a box lo..hi at lattice points lo + k dp; near the surface divided by their slope.
 * NaN is an error. */
mps_status mps__distances_make(mps__distances *f, mps__context *context, const mps__shape *s,
                               const double *lo, const double *hi);
void mps__distances_free(mps__distances *f, mps__context *context);
/* Linear interpolation between the lattice points. False outside of them. */
bool mps__distances_at(const mps__distances *f, const double x[3], double *value);
/* Interpolation with sharp edges: where two faces meet, products of the distances along the axes
 * would round the edge. */
bool mps__distances_sharp(const mps__distances *f, const double x[3], double *value);
void mps__distances_place(const mps__distances *f, int64_t point, double x[3]);

/* Feature of the surface at a vertex of a contour. */
enum { MPS__CORNER = 0, MPS__EDGE = 1, MPS__FACE = 2 };

typedef struct mps__vertex {
    double x[3];
    int32_t feature; /* MPS__CORNER, ... */
    int32_t odd;     /* axes along which its cell is not centred at a lattice point */
} mps__vertex;

typedef struct mps__patch {
    double x[3], area[3]; /* centre, area vector into the liquid */
} mps__patch;

/* The surface within a box, on cells of dp/2 centred at lattice points and half-way between
 * them. */
typedef struct mps__contour {
    int64_t vertices, patches, vertex_capacity, patch_capacity;
    mps__vertex *vertex;
    mps__patch *patch;
    bool open;         /* the surface continues beyond the box */
    double open_at[3]; /* first position where it does, in the order of the cells */
} mps__contour;

/* The box of a search: `anchor` is a lattice point at or below lo. Outside keep_lo..keep_hi the
 * surface may leave the box: that part is not used. */
typedef struct mps__contour_box {
    double anchor[3], lo[3], hi[3], keep_lo[3], keep_hi[3];
} mps__contour_box;

mps_status mps__contour_find(mps__contour *c, mps__context *context, const mps__shape *shape,
                             const mps__contour_box *box);
void mps__contour_free(mps__contour *c, mps__context *context);
/* The segments (2-D) or triangles (3-D) of the patches as a mesh, for shapes without distance
 * function. */
mps_status mps__contour_mesh(const mps__shape *shape, const mps__contour_box *box, mps__mesh *mesh);

#endif

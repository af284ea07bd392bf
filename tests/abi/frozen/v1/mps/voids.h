/* SPDX-License-Identifier: BSD-3-Clause */
/** @file voids.h  For verbs of models: regions of the tank without liquid (voids) and their
 *  connected components.
 *
 *  A grid of square cells is fixed in the frame of the tank. Its cells are
 *
 *    solid   in a wall, outside of the tank, or in a closed space without liquid,
 *    liquid  closer than `cover` to a liquid particle,
 *    deep    at least `channel` from all liquid particles,
 *    narrow  between the two.
 *
 *  Liquid particles are fluid particles that are not spray, and wall particles with such fluid
 *  within 1.5 dp. Distances are measured from the cell centre; a thin plate occludes particles
 *  behind it. Deep cells that share a side form a component; walls, baffles and thin plates
 *  separate components. Component 0, with the most deep cells, is the ambient. Other components are
 *  numbered by their first deep cell. If there are two components or more, a narrow cell belongs to
 *  the component that reaches it first from cell to cell (breadth-first), so that a film or a neck
 *  may separate two components.
 *
 *  All results have the same bytes for any number of threads and ranks, except `face_row`, which is
 *  local to a rank. Notation: dp spacing, dim = 2 or 3. */
#ifndef MPS_VOIDS_H
#define MPS_VOIDS_H

#include <mps/stage.h>

MPS_BEGIN_DECLS

/** Parameters of mps_stage_voids(). 0 is the default, which depends on dim. */
typedef struct mps_voids_config {
    /** Set by mps_voids_config_init(). */
    uint32_t struct_size;
    /** Kept 0. */
    int32_t reserved;
    /** Side of a cell, 0.25..2; default 0.5 in 2-D, 1 in 3-D [dp] */
    double side;
    /** Closer cells are liquid, 0.5..3; default 0.72 in 2-D, 0.9 in 3-D [dp] */
    double cover;
    /** Farther cells are deep, cover..3; default 0.9 in 2-D, 1.1 in 3-D [dp] */
    double channel;
    /** Least volume of the deep cells of a component [dp^dim]; cells of smaller components belong
     *  to none. Default 0. */
    double least;
} mps_voids_config;

/** Set struct_size and zero. @param size  sizeof(mps_voids_config) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_voids_config_init(mps_voids_config *config, size_t size);

/** Values of mps_voids.label below 0. */
enum {
    /** Liquid, or a void cell of no component. */
    MPS_VOID_NONE = -1,
    /** In a wall or outside of the tank. */
    MPS_VOID_SOLID = -2
};

/** The grid of a step. All arrays are borrowed: valid until the next call of mps_stage_voids() with
 *  another config, or the end of the step. */
typedef struct mps_voids {
    /** Set by mps_voids_init(). */
    uint32_t struct_size;
    /** 2 or 3 */
    int32_t dim;
    /** Side of a cell [m]. */
    double side;
    /** Lower corner of the grid in the frame of the tank [m]. */
    double origin[3];
    /** Cells along each axis; cells[2] is 1 in 2-D. Cell (a, b, c) is number
     *  a + cells[0] (b + cells[1] c). All 0 without solids. */
    int32_t cells[3];
    /** Number of components. */
    int32_t count;
    /** [cells] component, or MPS_VOID_NONE, MPS_VOID_SOLID */
    const int32_t *label;
    /** [count] number of cells of each component */
    const int32_t *size;
    /** Number of faces: sides of component cells that are not shared with a cell of the same
     *  component. 0 if there are fewer than two components. */
    int64_t faces;
    /** [faces] the component */
    const int32_t *face_label;
    /** [faces] number of the component's cell */
    const int32_t *face_cell;
    /** [faces] 2 d for a face towards the lower side of axis d, 2 d + 1 for the upper side */
    const int32_t *face_side;
    /** [faces] label of the cell behind the face; MPS_VOID_SOLID also at a thin plate and at the
     *  boundary of the grid */
    const int32_t *face_behind;
    /** [faces] row of the liquid particle nearest to the cell behind the face, if it is within
     *  `channel`; ties: the smallest id. -1: none, or owned by another rank. Exactly one rank has
     *  the row of a face with a particle. */
    const int32_t *face_row;
} mps_voids;

/** Set struct_size and zero. @param size  sizeof(mps_voids) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_voids_init(mps_voids *voids, size_t size);

/** Find the voids of the tank at the beginning of the step; allowed from MPS_PREPARE on.
 *  Collective: all ranks call it. A second call in the same step with the same config returns the
 *  stored result. On many ranks the reach of the model must be at least 2 `channel` dp, see
 *  mps_model_ops.reach.
 *  @param config  NULL: defaults @param voids  initialised by mps_voids_init(); out
 *  @return 0, or non-zero after a failure (invalid arguments, no memory, more than 2^31 - 1 cells;
 *  the error is set) */
MPS_API int mps_stage_voids(mps_stage *s, const mps_voids_config *config, mps_voids *voids);

/** Cell of a position in the frame of the tank; -1 outside of the grid. @param X  [dim] [m] */
static inline int64_t mps_voids_cell(const mps_voids *v, const double *X)
{
    int64_t cell = 0;
    for (int d = v->dim - 1; d >= 0; d--) {
        const double a = floor((X[d] - v->origin[d]) / v->side);
        if (!(a >= 0 && a < v->cells[d])) return -1;
        cell = cell * v->cells[d] + (int64_t)a;
    }
    return cell;
}

/** Component nearest to a position: that of the nearest cell centre of any component within
 *  `reach`, ties: the first cell; -1: none. Plates do not occlude cells.
 *  @param X  [dim] frame of the tank [m] @param reach  >= 0 [m] */
static inline int32_t mps_voids_near(const mps_voids *v, const double *X, double reach)
{
    int64_t lo[3] = {0, 0, 0}, hi[3] = {0, 0, 0}, k[3];
    double least = reach * reach;
    int32_t found = -1;
    for (int d = 0; d < v->dim; d++) {
        const double a = floor((X[d] - reach - v->origin[d]) / v->side),
                     b = floor((X[d] + reach - v->origin[d]) / v->side);
        if (!(b >= 0 && a < v->cells[d])) return -1;
        lo[d] = a > 0 ? (int64_t)a : 0;
        hi[d] = b < v->cells[d] - 1 ? (int64_t)b : v->cells[d] - 1;
    }
    for (k[2] = lo[2]; k[2] <= hi[2]; k[2]++)
        for (k[1] = lo[1]; k[1] <= hi[1]; k[1]++)
            for (k[0] = lo[0]; k[0] <= hi[0]; k[0]++) {
                const int32_t label = v->label[k[0] + v->cells[0] * (k[1] + v->cells[1] * k[2])];
                double square = 0;
                if (label < 0) continue;
                for (int d = 0; d < v->dim; d++) {
                    const double r = v->origin[d] + ((double)k[d] + 0.5) * v->side - X[d];
                    square += r * r;
                }
                if (square > least || (square == least && found >= 0)) continue;
                least = square;
                found = label;
            }
    return found;
}

MPS_END_DECLS

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* Faces of the components of the void. */
#include "world.h"

static mps_status add_face(mps__voids *v, const int32_t face[MPS__VOID_FACE])
{
    for (int k = 0; k < MPS__VOID_FACE; k++) {
        MPS__TRY(mps__voids_push(v, &v->face[k], &v->room.face[k], v->faces));
        v->face[k][v->faces] = face[k];
    }
    v->faces++;
    return MPS_OK;
}

/* Row of the particle nearest to a cell of the band, -1: none of this rank. */
static int32_t row_of(const mps__voids *v, const mps__world *w, int64_t c)
{
    int32_t row = -1;
    if (c < v->band * v->plane) mps__voids_nearest(v, w, c, 0, &row);
    return (int32_t)mps__own_place(&w->ghosts, row);
}

static mps_status add_faces_of(mps__voids *v, const mps__world *w, int64_t c)
{
    int32_t at[3];
    mps__voids_place(v, c, at);
    for (int32_t side = 0; side < 2 * v->dim; side++) {
        const int64_t b = mps__voids_beside(v, c, at, side);
        const int32_t behind = b < 0 ? MPS_VOID_SOLID : v->label[b];
        if (behind == v->label[c]) continue;
        const int32_t face[MPS__VOID_FACE] = {
            [MPS__VOID_FACE_LABEL] = v->label[c],
            [MPS__VOID_FACE_CELL] = (int32_t)c,
            [MPS__VOID_FACE_SIDE] = side,
            [MPS__VOID_FACE_BEHIND] = behind,
            [MPS__VOID_FACE_ROW] = behind == MPS_VOID_SOLID ? -1 : row_of(v, w, b)};
        MPS__TRY(add_face(v, face));
    }
    return MPS_OK;
}

mps_status mps__voids_faces(mps__voids *v, const mps__world *w)
{
    v->faces = 0;
    for (int64_t c = 0; v->count > 1 && c < v->band * v->plane; c++)
        if (v->label[c] >= 0) MPS__TRY(add_faces_of(v, w, c));
    return MPS_OK;
}

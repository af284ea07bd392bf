/* SPDX-License-Identifier: BSD-3-Clause */
/* Faces of the components of the void. */
#include "world.h"
#include <string.h>

static mps_status add_face(mps__voids *v, const int32_t face[MPS__VOID_FACE])
{
    for (int k = 0; k < MPS__VOID_FACE; k++) {
        MPS__TRY(mps__voids_push(v, &v->face[k], &v->capacity.face[k], v->faces));
        v->face[k][v->faces] = face[k];
    }
    v->faces++;
    return MPS_OK;
}

/* Index of the particle nearest to a cell of the band, -1: none on this rank. */
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

/* Mark the cells of a line that may have faces: those of components next to a plate or to another
 * label, and at the end of the raster. */
static void mark_line(const mps__voids *v, int64_t begin, uint8_t *any)
{
    const int64_t n = v->cells[0];
    const int32_t *own = v->label + begin;
    const uint8_t *mask = v->mask + begin;
    int32_t at[3];
    mps__voids_place(v, begin, at);
    for (int64_t c = 0; c < n; c++) any[c] = mask[c] / MPS__MASK_PLATE & 1;
    for (int64_t c = 1; c < n - 1; c++) any[c] |= (own[c - 1] != own[c]) | (own[c + 1] != own[c]);
    any[0] = any[n - 1] = 1;
    for (int32_t d = 1; d < v->dim; d++) {
        const int32_t *before = own - v->step[d], *behind = own + v->step[d];
        if (at[d] == 0 || at[d] + 1 == v->cells[d])
            memset(any, 1, (size_t)n);
        else
            for (int64_t c = 0; c < n; c++) any[c] |= (before[c] != own[c]) | (behind[c] != own[c]);
    }
    for (int64_t c = 0; c < n; c++) any[c] &= own[c] >= 0;
}

mps_status mps__voids_faces(mps__voids *v, const mps__world *w)
{
    const int64_t n = v->cells[0];
    uint8_t *any = v->wide; /* free at this point */
    v->faces = 0;
    for (int64_t begin = 0; v->count > 1 && begin < v->band * v->plane; begin += n) {
        const uint8_t *next = any, *end = any + n;
        mark_line(v, begin, any);
        for (; (next = memchr(next, 1, (size_t)(end - next))) != NULL; next++)
            MPS__TRY(add_faces_of(v, w, begin + (next - any)));
    }
    return MPS_OK;
}

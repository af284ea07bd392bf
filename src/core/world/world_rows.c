/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows of neighbours between two searches, on the host or on a device that has the lists. */
#include "plates.h"
#include "scan.h"

/* The host's lists are an older parting of the same candidates as long as the device has newer ones: still right to begin from. */
bool mps__world_rows_there(const mps__world *w)
{
    const mps__twins *t = &w->host.twins;
    const mps_neighbours *l = &w->lists.neighbours;
    return t->step && t->listed == l->searches && l->longest == 0 && w->lists.screens.count == 0 &&
           w->setup.kernel.id != MPS_KERNEL_CUSTOM;
}

static mps_status rows_there(mps__world *w)
{
    mps__twins *t = &w->host.twins;
    mps_neighbours *l = &w->lists.neighbours;
    MPS__TRY(mps__twins_enter(t));
    const mps__row_arrays there = {.x = mps__seen(w, w->particles.x),
                                   .begin = mps__seen(w, l->begin),
                                   .count = mps__seen(w, l->count),
                                   .middle = mps__twins_given(t, l->middle, false),
                                   .end = mps__twins_given(t, l->end, false),
                                   .col = mps__twins_given(t, l->col, false)};
    mps__neighbours_rows_there(l, w->particles.x, &there);
    return mps__twins_leave(t);
}

mps_status mps__world_rows(mps__world *w)
{
    if (mps__world_rows_there(w)) return rows_there(w);
    w->host.twins.listed = -1;
    mps__plates_look(w);
    mps__neighbours_rows(&w->lists.neighbours, w->particles.x);
    return MPS_OK;
}

/* Lists as the search left them. */
static mps_status show_lists(mps__world *w)
{
    const mps_neighbours *l = &w->lists.neighbours;
    mps__twins *t = &w->host.twins;
    const int64_t n = l->n;
    if (t->listed == l->searches) return MPS_OK;
    for (int k = 0; k < MPS__LASTING; k++) t->block[k].bytes = 0;
    MPS__TRY(mps__twins_block(t, MPS__ROWS_BEGIN, l->begin, n, sizeof *l->begin, true));
    MPS__TRY(mps__twins_block(t, MPS__ROWS_MIDDLE, l->middle, n, sizeof *l->middle, true));
    if (l->end != l->middle)
        MPS__TRY(mps__twins_block(t, MPS__ROWS_END, l->end, n, sizeof *l->end, true));
    MPS__TRY(mps__twins_block(t, MPS__ROWS_COUNT, l->count, n, sizeof *l->count, true));
    MPS__TRY(mps__twins_block(t, MPS__ROWS_COLUMNS, l->col, l->pairs, sizeof *l->col, true));
    MPS__TRY(mps__twins_block(t, MPS__IDLE_ROWS, l->idle, n, sizeof *l->idle, true));
    MPS__TRY(mps__twins_block(t, MPS__RIM_ROWS, l->rim, n, sizeof *l->rim, true));
    t->listed = l->searches;
    return MPS_OK;
}

mps_status mps__world_lists_twins(mps__world *w)
{
    const mps_neighbours *l = &w->lists.neighbours;
    mps__twins *t = &w->host.twins;
    const int64_t n = w->particles.n,
                  turned = w->work.area == w->work.turned ? n * w->setup.dim : 0;
    if (!t->open) return MPS_OK;
    MPS__TRY(show_lists(w));
    MPS__TRY(mps__twins_block(t, MPS__NEAR_BEGIN, l->near_begin, mps__scan_room(n + 1),
                              sizeof *l->near_begin, false));
    return mps__twins_block(t, MPS__TURNED_AREAS, w->work.turned, turned, sizeof(double), true);
}

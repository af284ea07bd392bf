/* SPDX-License-Identifier: BSD-3-Clause */
/* Order and candidates from a device; exact rows between two searches, on the host or on a device
 * that has the lists. */
#include "plates.h"
#include "scan.h"

/* Whether the device of a step computes rows. */
static bool device_finds(const mps__world *w)
{
    return w->runner.memory.step && w->setup.kernel.id != MPS_KERNEL_CUSTOM;
}

/* Whether it searches, too: on many ranks particles migrate between hosts first. */
static bool device_searches(const mps__world *w)
{
    return device_finds(w) && !mps__ranks_many(&w->ranks);
}

bool mps__world_on_device(const mps__world *w)
{
    return device_finds(w) && mps__memory_on_device(&w->runner.memory);
}

/* While the device has newer rows, the host's lists are an older partition of the same candidates,
 * and still a valid start. */
bool mps__world_rows_on_device(const mps__world *w)
{
    const mps_neighbours *l = &w->lists.neighbours;
    return device_finds(w) && w->runner.memory.listed == l->searches && l->longest == 0;
}

/* Device memory of the lists; `values`: copied from the host, else to be computed. Columns are
 * allocated once they are counted. */
static mps_status make_lists(mps__world *w, bool values)
{
    const mps_neighbours *l = &w->lists.neighbours;
    mps__memory *t = &w->runner.memory;
    const int64_t n = l->n;
    MPS__TRY(mps__memory_block(t, MPS__ROWS_BEGIN, l->begin, mps__scan_size(n), sizeof *l->begin,
                               values));
    MPS__TRY(mps__memory_block(t, MPS__ROWS_MIDDLE, l->middle, n, sizeof *l->middle, values));
    if (l->end != l->middle)
        MPS__TRY(mps__memory_block(t, MPS__ROWS_END, l->end, n, sizeof *l->end, values));
    MPS__TRY(mps__memory_block(t, MPS__ROWS_COUNT, l->count, n, sizeof *l->count, values));
    MPS__TRY(mps__memory_block(t, MPS__IDLE_ROWS, l->idle, n, sizeof *l->idle, values));
    MPS__TRY(mps__memory_block(t, MPS__NEAR_DUMMIES, l->near_dummies, n, sizeof *l->near_dummies,
                               values));
    return mps__memory_block(t, MPS__SEARCHED, l->searched, n * l->dim, sizeof *l->searched,
                             values);
}

static mps_status make_columns(mps__world *w, bool values)
{
    const mps_neighbours *l = &w->lists.neighbours;
    return mps__memory_block(&w->runner.memory, MPS__ROWS_COLUMNS, l->col, l->pairs, sizeof *l->col,
                             values);
}

/* List of the ends of the far rows: if the radii are equal, those of the near rows. */
static int32_t end_of(const mps_neighbours *l)
{
    return l->end == l->middle ? MPS__ROWS_MIDDLE : MPS__ROWS_END;
}

/* ---- order ---- */

/* With loops on the device. NULL: failed. */
static mps_status order_device(mps__world *w, const int32_t **on_device)
{
    const mps__particles *s = &w->particles;
    mps_neighbours *l = &w->lists.neighbours;
    mps__memory *t = &w->runner.memory;
    const size_t n = (size_t)s->n;
    const mps__order_arrays a = {.x = mps__seen(w, MPS__FIELD_POSITION),
                                 .id = mps__seen(w, MPS__FIELD_ID),
                                 .key = mps__memory_workspace(t, 0, 2 * n * sizeof *a.key),
                                 .order = mps__memory_workspace(t, 1, 2 * n * sizeof *a.order)};
    if (!a.key || !a.order) return MPS_E_NOMEM;
    l->key = NULL;
    l->order = mps__scratch_take(w->context, l->shared, 1, 2 * s->n, sizeof *l->order);
    if (!l->order) return MPS_E_NOMEM;
    *on_device = mps__neighbours_order_device(l, s->n, w->setup.re_far, &a);
    if (*on_device) mps__device_download(&t->device, l->order, *on_device, n * sizeof *l->order);
    if (t->device.failed) *on_device = NULL;
    return MPS_OK;
}

mps_status mps__world_order(mps__world *w, const int32_t **on_device)
{
    const mps__particles *s = &w->particles;
    *on_device = NULL;
    if (device_searches(w) && w->lists.linked == s->solids) {
        MPS__TRY(mps__memory_enter(&w->runner.memory));
        const mps_status status = order_device(w, on_device);
        mps__memory_exit(&w->runner.memory); /* a failure is reported after the order on the host */
        MPS__TRY(status);
    }
    if (*on_device) return MPS_OK;
    MPS__TRY(mps__world_fetch(w));
    return mps__neighbours_order(&w->lists.neighbours, s->n, s->x, s->id, w->setup.re_far);
}

/* ---- candidates ---- */

/* With loops on the device. */
static mps_status search_device(mps__world *w, bool *found)
{
    mps__memory *t = &w->runner.memory;
    mps_neighbours *l = &w->lists.neighbours;
    MPS__TRY(make_lists(w, false));
    mps__search_arrays on_device = {
        .x = mps__seen(w, MPS__FIELD_POSITION),
        .kind = mps__seen(w, MPS__FIELD_KIND),
        .key = mps__memory_workspace(t, 0, (size_t)l->n * sizeof *on_device.key),
        .begin = mps__given_list(w, MPS__ROWS_BEGIN, l->begin),
        .middle = mps__given_list(w, MPS__ROWS_MIDDLE, l->middle),
        .end = mps__given_list(w, end_of(l), l->end),
        .count = mps__given_list(w, MPS__ROWS_COUNT, l->count),
        .idle = mps__given_list(w, MPS__IDLE_ROWS, l->idle),
        .near_dummies = mps__given_list(w, MPS__NEAR_DUMMIES, l->near_dummies),
    };
    if (!on_device.key) return MPS_E_NOMEM;
    MPS__TRY(mps__neighbours_count_device(l, &on_device));
    MPS__TRY(mps__device_status(&t->device));
    if (l->longest > 0) return MPS_OK;
    MPS__TRY(make_columns(w, false));
    on_device.col = mps__given_list(w, MPS__ROWS_COLUMNS, l->col);
    mps__neighbours_fill_device(l, &on_device);
    mps__device_copy(&t->device, mps__given_list(w, MPS__SEARCHED, l->searched), on_device.x,
                     (size_t)(l->n * l->dim) * sizeof *l->searched);
    *found = true;
    return MPS_OK;
}

mps_status mps__world_search_device(mps__world *w, bool *found)
{
    mps__memory *t = &w->runner.memory;
    mps_neighbours *l = &w->lists.neighbours;
    *found = false;
    if (!device_searches(w)) return MPS_OK;
    MPS__TRY(mps__neighbours_begin(l, w->particles.n, w->particles.x, w->setup.re_near,
                                   w->setup.re_far));
    mps__memory_rows_drop(t);
    MPS__TRY(mps__memory_enter(t));
    mps_status status = search_device(w, found);
    const mps_status left = mps__memory_exit(t);
    if (status == MPS_OK) status = left;
    if (status < 0 || !*found) {
        mps__memory_rows_drop(t);
        return status;
    }
    t->listed = l->searches;
    mps__neighbours_end(l);
    return MPS_OK;
}

/* ---- rows ---- */

/* Arrays of structs, copied as 8-byte numbers. */
static mps_status make_structs(mps__world *w, int32_t block, void *host, int64_t count, size_t size)
{
    return mps__memory_block(&w->runner.memory, block, host, count * (int64_t)(size / 8), 8, true);
}

/* Occluders, and near-plate particles at their present positions. */
static mps_status make_occluders(mps__world *w)
{
    const mps__occluders *p = &w->lists.occluders;
    MPS__TRY(make_structs(w, MPS__OCCLUDER_LIST, p->list, p->count, sizeof *p->list));
    return make_structs(w, MPS__NEAR_PLATE_LIST, p->near_plate, p->near_plates,
                        sizeof *p->near_plate);
}

static mps_status make_slots(mps__world *w)
{
    const mps__occluders *p = &w->lists.occluders;
    return mps__memory_block(&w->runner.memory, MPS__NEAR_PLATE_SLOTS, p->slot, w->particles.n,
                             sizeof *p->slot, true);
}

/* Arrays for an update of the rows. */
static mps__row_arrays arrays_device(mps__world *w)
{
    mps__memory *t = &w->runner.memory;
    const mps_neighbours *l = &w->lists.neighbours;
    const mps__occluders *p = &w->lists.occluders;
    return (mps__row_arrays){
        .x = mps__seen(w, MPS__FIELD_POSITION),
        .begin = mps__seen_list(w, MPS__ROWS_BEGIN, l->begin),
        .count = mps__seen_list(w, MPS__ROWS_COUNT, l->count),
        .middle = mps__memory_list_given(t, MPS__ROWS_MIDDLE, l->middle, false),
        .end = mps__memory_list_given(t, end_of(l), l->end, false),
        .col = mps__memory_list_given(t, MPS__ROWS_COLUMNS, l->col, false),
        .occluder = mps__seen_list(w, MPS__OCCLUDER_LIST, p->list),
        .near_plate = mps__seen_list(w, MPS__NEAR_PLATE_LIST, p->near_plate),
        .slot = mps__seen_list(w, MPS__NEAR_PLATE_SLOTS, p->slot)};
}

mps_status mps__world_hide_device(mps__world *w)
{
    mps__memory *t = &w->runner.memory;
    if (w->lists.occluders.count == 0) return MPS_OK;
    MPS__TRY(mps__memory_enter(t));
    MPS__TRY(make_occluders(w));
    MPS__TRY(make_slots(w));
    const mps__row_arrays on_device = arrays_device(w);
    mps__neighbours_hide_device(&w->lists.neighbours, &on_device);
    return mps__memory_exit(t);
}

static mps_status rows_device(mps__world *w)
{
    mps__memory *t = &w->runner.memory;
    MPS__TRY(mps__memory_enter(t));
    MPS__TRY(make_occluders(w));
    const mps__row_arrays on_device = arrays_device(w);
    mps__neighbours_rows_device(&w->lists.neighbours, w->particles.x, &on_device);
    return mps__memory_exit(t);
}

mps_status mps__world_fresh(mps__world *w, bool *fresh)
{
    const mps_neighbours *l = &w->lists.neighbours;
    const mps__particles *s = &w->particles;
    const bool on_device = mps__world_on_device(w) && mps__world_rows_on_device(w);
    if (on_device && w->next_flags.holds) {
        *fresh = mps__neighbours_within(l, s->n, w->setup.re_far,
                                        w->next_flags.most[MPS__NEXT_WAY]);
        return MPS_OK;
    }
    if (on_device)
        MPS__TRY(mps__memory_enter(&w->runner.memory));
    else
        MPS__TRY(mps__world_fetch(w));
    if (!on_device && l->valid) MPS__TRY(mps__world_fetch_searched(w));
    *fresh = mps__neighbours_fresh(
        l, s->n, mps__seen(w, MPS__FIELD_POSITION), mps__seen_list(w, MPS__SEARCHED, l->searched),
        mps__ghosts_seen(&w->ghosts, mps__device_of(&w->pool.parallel)), w->setup.re_far);
    return on_device ? mps__memory_exit(&w->runner.memory) : MPS_OK;
}

mps_status mps__world_rows(mps__world *w)
{
    const bool on_device = mps__world_rows_on_device(w);
    if (w->lists.occluders.count > 0 || !on_device)
        MPS__TRY(mps__world_fetch_field(w, MPS__FIELD_POSITION));
    mps__plates_look(w);
    if (on_device) return rows_device(w);
    MPS__TRY(mps__world_fetch_lists(w));
    mps__memory_rows_drop(&w->runner.memory); /* stale from now on */
    mps__neighbours_rows(&w->lists.neighbours, w->particles.x);
    return MPS_OK;
}

/* Copy the lists of the last search to the device. */
static mps_status show_lists(mps__world *w)
{
    const mps_neighbours *l = &w->lists.neighbours;
    mps__memory *t = &w->runner.memory;
    if (t->listed == l->searches) return MPS_OK;
    mps__memory_rows_drop(t);
    MPS__TRY(make_lists(w, true));
    MPS__TRY(make_columns(w, true));
    if (w->lists.occluders.count > 0) MPS__TRY(make_slots(w));
    t->listed = l->searches;
    return MPS_OK;
}

mps_status mps__world_mirror_lists(mps__world *w)
{
    const mps_neighbours *l = &w->lists.neighbours;
    mps__memory *t = &w->runner.memory;
    const int64_t n = w->particles.n,
                  turned = w->work.area == w->work.turned ? n * w->setup.dim : 0;
    if (!t->open) return MPS_OK;
    MPS__TRY(show_lists(w));
    MPS__TRY(mps__memory_block(t, MPS__NEAR_BEGIN, l->near_begin, mps__scan_size(n + 1),
                               sizeof *l->near_begin, false));
    return mps__memory_block(t, MPS__ROTATED_AREAS, w->work.turned, turned, sizeof(double), false);
}

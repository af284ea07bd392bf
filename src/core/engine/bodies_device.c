/* SPDX-License-Identifier: BSD-3-Clause */
/* Droplets on a device by union-find. Only members of droplets without an anchor are copied to the
 * host, which counts and numbers the droplets: a small part of all particles. */
#include "bodies.h"
#include "union_find.h"
#include "loop.h"
#include "scan.h"

typedef struct joining {
    const int32_t *role;
    const uint8_t *ghost;              /* NULL: one rank */
    mps__atomic_number *parent, *held; /* of a root: 1 if a member of its set is beside an anchor */
    /* list number of a member of an unanchored droplet; of other particles that of the previous
     * one */
    int64_t *number;
    /* of each listed particle its id; list index of its root, and flags of the particle */
    int64_t *list;
    const int32_t *given; /* droplet of each listed particle */
    int32_t *body;
} joining;

/* Whether particle i is in a set of this rank. */
MPS_ROW bool has(const mps_view *v, const joining *f, int64_t i)
{
    return mps__owns(f->ghost, i) && mps__body_has(v, f->role, i);
}

/* Initialise the parent with the first neighbour: most particles join its set at once. */
MPS_ROW void begin_row(const int dim, const mps_view *v, const joining *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    const int64_t begin = mps_stencil_begin(t, i);
    int64_t first = i;
    (void)dim;
    if (mps__body_has(v, f->role, i) && begin < mps_stencil_end(t, i))
        first = mps_stencil_column(t, begin);
    mps__atomic_put(&f->parent[i], (int32_t)(first < i && has(v, f, first) ? first : i));
    mps__atomic_put(&f->held[i], 0);
}
MPS_ROWS(begin_rows, begin_row, joining)

MPS_ROW void join_row(const int dim, const mps_view *v, const joining *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    (void)dim;
    if (!mps__body_has(v, f->role, i)) return;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int32_t j = mps_stencil_column(t, p);
        if (j < i && has(v, f, j) &&
            mps__atomic_get(&f->parent[j]) != mps__atomic_get(&f->parent[i]))
            mps__union_join(f->parent, (int32_t)i, j);
    }
}
MPS_ROWS(join_rows, join_row, joining)

MPS_ROW void hold_row(const int dim, const mps_view *v, const joining *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    bool held = false;
    (void)dim;
    if (!mps__body_has(v, f->role, i)) return;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i) && !held; p++)
        held = f->role[mps_stencil_column(t, p)] == MPS_BODY_ANCHOR;
    if (held) mps__atomic_put(&f->held[mps__union_find(f->parent, (int32_t)i)], 1);
}
MPS_ROWS(hold_rows, hold_row, joining)

MPS_ROW void mark_row(const int dim, const mps_view *v, const joining *f, int64_t i)
{
    (void)dim;
    f->number[i] = mps__body_has(v, f->role, i) &&
                   mps__atomic_get(&f->held[mps__union_find(f->parent, (int32_t)i)]) == 0;
}
MPS_ROWS(mark_rows, mark_row, joining)

/* Whether a particle is in the list, once `number` is summed. */
MPS_ROW bool is_listed(const joining *f, int64_t i)
{
    return f->number[i] > (i > 0 ? f->number[i - 1] : 0);
}

/* Whether a particle has a neighbouring member on another rank. */
MPS_ROW bool at_border(const mps_view *v, const joining *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    for (int64_t p = mps_stencil_begin(t, i); f->ghost && p < mps_stencil_end(t, i); p++) {
        const int32_t j = mps_stencil_column(t, p);
        if (!mps__owns(f->ghost, j) && mps__body_has(v, f->role, j)) return true;
    }
    return false;
}

/* Encoding of an index and flags in one number. */
enum { FLAGS = 8 };

MPS_ROW void list_row(const int dim, const mps_view *v, const joining *f, int64_t i)
{
    (void)dim;
    if (!is_listed(f, i)) return;
    int64_t *at = f->list + 2 * (f->number[i] - 1);
    const int32_t root = mps__union_find(f->parent, (int32_t)i);
    at[0] = v->id[i];
    at[1] = FLAGS * (f->number[root] - 1) + (f->role[i] == MPS_BODY_SEED ? MPS__BODY_SEEDED : 0) +
            (at_border(v, f, i) ? MPS__BODY_PARTED : 0);
}
MPS_ROWS(list_rows, list_row, joining)

MPS_ROW void write_row(const int dim, const mps_view *v, const joining *f, int64_t i)
{
    (void)dim, (void)v;
    f->body[i] = is_listed(f, i) ? f->given[f->number[i] - 1] : -1;
}
MPS_ROWS(write_rows, write_row, joining)

/* ---- on the host ---- */

/* Droplet parts from the listed particles: a root precedes its members. */
static mps_status list_parts(mps__runner *h, int64_t *list, int64_t count, int32_t *body)
{
    mps__sets *sets = &h->sets;
    mps__sets_begin(sets, h->context);
    for (int64_t k = 0; k < count; k++) {
        const int64_t root = list[2 * k + 1] / FLAGS;
        body[k] = root == k ? (int32_t)sets->parts : body[root];
        if (root == k) MPS__TRY(mps__sets_add(sets, &(mps__set){.label = INT64_MAX}));
        mps__set *part = &sets->part[body[k]];
        part->rows++;
        part->label = list[2 * k] < part->label ? list[2 * k] : part->label;
        part->flags |= (int32_t)(list[2 * k + 1] % FLAGS);
    }
    return MPS_OK;
}

/* Large parts count as anchored, also if they continue on other ranks. @return whether any rank has
 * another part that continues elsewhere */
static bool any_parted(mps__runner *h, int32_t most)
{
    mps__sets *sets = &h->sets;
    double any = 0;
    for (int64_t k = 0; k < sets->parts; k++) {
        mps__set *part = &sets->part[k];
        if (!(part->flags & MPS__BODY_PARTED)) continue;
        if (part->rows <= most) any = 1;
        part->flags |= MPS__BODY_HELD;
    }
    mps__ranks_max(h->ghosts->ranks, 1, &any);
    return any > 0;
}

/* Number the droplets of the listed particles. `parted`: the numbers need the searches of all
 * ranks. */
static mps_status number_listed(mps__runner *h, int64_t *list, int64_t count, int32_t most,
                                int32_t *body, bool *parted)
{
    mps__sets *sets = &h->sets;
    MPS__TRY(list_parts(h, list, count, body));
    *parted = any_parted(h, most);
    if (*parted) return MPS_OK;
    /* merging sorts the parts: store their labels at the roots */
    for (int64_t k = 0; k < count; k++)
        if (list[2 * k + 1] / FLAGS == k) list[2 * k] = sets->part[body[k]].label;
    MPS__TRY(mps__sets_merge(sets, h->ghosts->ranks));
    mps__bodies_number(sets, most);
    for (int64_t k = 0; k < count; k++)
        body[k] = mps__sets_find(sets, list[list[2 * k + 1] / FLAGS * 2])->number;
    return MPS_OK;
}

/* Copy the list to the host and the droplet numbers to the device. */
static int number_on_rank(mps_stage *s, int64_t count, int32_t most, const joining *f,
                          int32_t *given, bool *parted)
{
    mps__runner *h = s->host;
    mps__device *d = &h->memory.device;
    const mps_view *device_view = mps__runner_begin_serial(s);
    int64_t *own = (int64_t *)(void *)mps_stage_scratch(s, 2 * count + 1);
    int32_t *body = mps_stage_scratch_integers(s, count + 1);
    int failed = !own || !body;
    if (!failed) {
        mps__device_download(d, own, f->list, (size_t)(2 * count) * sizeof *own);
        failed = d->failed;
    }
    if (!failed) {
        const mps_status status = number_listed(h, own, count, most, body, parted);
        h->no_memory = h->no_memory || status == MPS_E_NOMEM;
        failed = status < 0;
        mps__device_upload(d, given, body, (size_t)count * sizeof *body);
    }
    mps__runner_end_serial(s, device_view);
    return failed;
}

/* ---- host and device ---- */

static int number_bodies(mps_stage *s, int32_t most, joining *f, bool *parted)
{
    mps__runner *h = s->host;
    const int64_t n = s->view->n;
    int64_t count = 0;
    mps__scan(h->parallel, f->number, n);
    if (n > 0) mps__device_download(&h->memory.device, &count, f->number + n - 1, sizeof count);
    if (h->memory.device.failed) return 1;
    if (count == 0 && !mps__ranks_many(h->ghosts->ranks)) return 0;
    int32_t *given = mps_stage_scratch_integers(s, count + 1);
    f->list = (int64_t *)(void *)mps_stage_scratch(s, 2 * count + 1);
    f->given = given;
    if (!f->list || !given) return 1;
    if (count > 0) mps_stage_rows(s, &list_rows, f);
    return number_on_rank(s, count, most, f, given, parted);
}

int mps__bodies_device(mps_stage *s, int32_t most, int32_t *role, int32_t *body)
{
    mps__runner *h = s->host;
    const int64_t n = s->view->n;
    const int32_t used = h->scratch_used;
    const mps_shared shared = {.values = role, .components = 1, .type = MPS_TYPE_INTEGER};
    bool parted = false;
    joining f = {.role = role,
                 .ghost = mps__ghosts_seen(h->ghosts, &h->memory.device),
                 .parent = (mps__atomic_number *)(void *)mps_stage_scratch_integers(s, n),
                 .held = (mps__atomic_number *)(void *)mps_stage_scratch_integers(s, n),
                 .number = (int64_t *)(void *)mps_stage_scratch(s, mps__scan_size(n)),
                 .body = body};
    if (!f.parent || !f.held || !f.number || mps_stage_refresh(s, 1, &shared)) return 1;
    mps_stage_rows(s, &begin_rows, &f);
    mps_stage_rows(s, &join_rows, &f);
    mps_stage_rows(s, &hold_rows, &f);
    mps_stage_rows(s, &mark_rows, &f);
    int failed = number_bodies(s, most, &f, &parted);
    if (!failed && !parted) mps_stage_rows(s, &write_rows, &f);
    h->scratch_used = used;
    if (!failed && parted) failed = mps__bodies_away(s, most, role, body);
    return failed;
}

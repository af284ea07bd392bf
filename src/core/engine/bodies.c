/* SPDX-License-Identifier: BSD-3-Clause */
/* Droplets for verbs of models: breadth-first searches on each rank, then merging across ranks. */
#include "bodies.h"

/* Members of a droplet in the order in which they were found. */
typedef struct search {
    const mps_view *s;
    const int32_t *role;
    int32_t *body, *queue;
    int64_t found;
    int32_t most;
    bool many; /* more than one rank */
} search;

/* Temporary values of `body`: not visited; member of an anchored droplet; particle of another
 * rank. */
enum { NEW = -1, HELD = -2, ELSEWHERE = -3 };

static bool belongs(const search *k, int64_t i)
{
    return mps__body_has(k->s, k->role, i);
}

static void join(search *k, int64_t i, int32_t number)
{
    k->body[i] = number;
    k->queue[k->found++] = (int32_t)i;
}

/* Visit the neighbours of particle i; new members join its droplet. @return whether a neighbour
 * anchors it */
static bool is_held(search *k, int64_t i)
{
    const mps_stencil *t = &k->s->near;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int32_t j = mps_stencil_column(t, p);
        if (k->role[j] == MPS_BODY_ANCHOR) return true;
        if (k->body[j] == HELD) return true;
        if (k->body[j] == NEW && belongs(k, j)) join(k, j, k->body[i]);
    }
    return false;
}

/* Whether particle i has a neighbouring member on another rank. */
static bool at_border(const search *k, int64_t i)
{
    const mps_stencil *t = &k->s->near;
    for (int64_t p = mps_stencil_begin(t, i); k->many && p < mps_stencil_end(t, i); p++) {
        const int32_t j = mps_stencil_column(t, p);
        if (k->body[j] == ELSEWHERE && belongs(k, j)) return true;
    }
    return false;
}

/* Searches begin at seeds and at rank borders: the seed of a droplet may be on another rank. */
static bool begins(const search *k, int64_t i)
{
    if (k->body[i] != NEW || !belongs(k, i)) return false;
    return k->role[i] == MPS_BODY_SEED || at_border(k, i);
}

/* Set body[] of each particle. A search ends when the droplet is known to be anchored; later
 * searches in it reach one of its marked members.
 * @return number of droplets that are free on this rank */
static int32_t find_bodies(search *k, const mps__ghosts *g)
{
    int32_t count = 0;
    for (int64_t i = 0; i < k->s->n; i++) k->body[i] = ELSEWHERE;
    for (int64_t i = mps__own_from(g, 0); i < k->s->n; i = mps__own_from(g, i + 1))
        k->body[i] = NEW;
    for (int64_t seed = 0; seed < k->s->n; seed++) {
        if (!begins(k, seed)) continue;
        bool held = false;
        k->found = 0;
        join(k, seed, count);
        for (int64_t next = 0; next < k->found && !held; next++)
            held = is_held(k, k->queue[next]) || k->found > k->most;
        for (int64_t m = 0; m < k->found && held; m++) k->body[k->queue[m]] = HELD;
        count += !held;
    }
    return count;
}

/* List the droplet parts of this rank. */
static mps_status list_parts(const search *k, int32_t count, mps__sets *sets)
{
    for (int32_t c = 0; c < count; c++)
        MPS__TRY(mps__sets_add(sets, &(mps__set){.label = INT64_MAX}));
    for (int64_t i = 0; count > 0 && i < k->s->n; i++) {
        if (k->body[i] < 0) continue;
        mps__set *part = &sets->part[k->body[i]];
        part->rows++;
        part->label = k->s->id[i] < part->label ? k->s->id[i] : part->label;
        part->flags |= k->role[i] == MPS_BODY_SEED ? MPS__BODY_SEEDED : 0;
    }
    return MPS_OK;
}

/* Join parts across rank borders. `label` [n] is scratch: the label of a particle's part, -1:
 * anchored or none. Labels are ids, which doubles represent exactly. */
static mps_status join_border(const search *k, mps__runner *h, double *label)
{
    const mps_stencil *t = &k->s->near;
    mps__set *part = h->sets.part;
    for (int64_t i = 0; i < k->s->n; i++)
        label[i] = k->body[i] >= 0 ? (double)part[k->body[i]].label : -1;
    MPS__TRY(mps__ghosts_exchange(h->ghosts,
                                  &(mps__halo_array){.values = label, .bytes = sizeof *label}, 1));
    for (int64_t i = 0; i < k->s->n; i++)
        for (int64_t p = mps_stencil_begin(t, i); k->body[i] >= 0 && p < mps_stencil_end(t, i);
             p++) {
            const int32_t j = mps_stencil_column(t, p);
            if (k->body[j] != ELSEWHERE || !belongs(k, j)) continue;
            if (label[j] < 0)
                part[k->body[i]].flags |= MPS__BODY_HELD;
            else
                MPS__TRY(mps__sets_join(&h->sets, (int64_t)label[i], (int64_t)label[j]));
        }
    return MPS_OK;
}

void mps__bodies_number(mps__sets *sets, int32_t most)
{
    int32_t count = 0;
    for (int64_t k = 0; k < sets->count; k++) {
        const mps__set *set = &sets->list[k];
        const bool is_free = !(set->flags & MPS__BODY_HELD) && set->flags & MPS__BODY_SEEDED &&
                             set->rows <= most;
        sets->list[k].number = is_free ? count++ : -1;
    }
}

/* Merge the parts; body[] becomes the number of a free droplet or -1. Uses two scratch blocks. */
static int merge_bodies(mps_stage *s, search *k, int32_t count)
{
    mps__runner *h = s->host;
    double *least = mps_stage_scratch(s, count),
           *label = mps_stage_scratch(s, k->many ? s->view->n : 1);
    if (!least || !label) return 1;
    mps__sets_begin(&h->sets, h->context);
    mps_status status = list_parts(k, count, &h->sets);
    for (int32_t c = 0; status == MPS_OK && c < count; c++)
        least[c] = (double)h->sets.part[c].label;
    if (status == MPS_OK && k->many) status = join_border(k, h, label);
    if (status == MPS_OK) status = mps__sets_merge(&h->sets, h->ghosts->ranks);
    h->no_memory = h->no_memory || status == MPS_E_NOMEM;
    if (status < 0) return 1;
    mps__bodies_number(&h->sets, k->most);
    for (int64_t i = 0; i < s->view->n; i++)
        k->body[i] = k->body[i] < 0 ? -1
                                    : mps__sets_find(&h->sets, (int64_t)least[k->body[i]])->number;
    h->scratch_used -= 2;
    return 0;
}

static int find_free(mps_stage *s, int32_t most, int32_t *role, int32_t *body)
{
    mps__runner *h = s->host;
    const mps_shared shared = {.values = role, .components = 1, .type = MPS_TYPE_INTEGER};
    search k = {.s = s->view,
                .role = role,
                .body = body,
                .queue = mps_stage_scratch_integers(s, s->view->n),
                .most = most,
                .many = mps__ranks_many(h->ghosts->ranks)};
    if (!k.queue || mps_stage_refresh(s, 1, &shared)) return 1;
    const int32_t count = find_bodies(&k, h->ghosts);
    if (merge_bodies(s, &k, count)) return 1;
    h->scratch_used--; /* release the queue */
    return 0;
}

int mps__bodies_away(mps_stage *s, int32_t most, const int32_t *role, int32_t *body)
{
    mps__runner *h = s->host;
    mps__device *d = &h->memory.device;
    const size_t bytes = (size_t)s->view->n * sizeof *role;
    const int32_t used = h->scratch_used;
    const mps_view *device_view = mps__runner_begin_serial(s);
    int32_t *own_role = mps_stage_scratch_integers(s, s->view->n),
            *own_body = mps_stage_scratch_integers(s, s->view->n);
    int failed = !own_role || !own_body;
    mps__memory_sync_lists(&h->memory);
    if (!failed) {
        mps__device_download(d, own_role, role, bytes);
        failed = d->failed || find_free(s, most, own_role, own_body);
    }
    if (!failed) mps__device_upload(d, body, own_body, bytes);
    h->scratch_used = used;
    mps__runner_end_serial(s, device_view);
    return failed;
}

int mps_stage_bodies(mps_stage *s, int32_t most, int32_t *role, int32_t *body)
{
    const mps__runner *h = s->host;
    if (!mps__stage_has_pairs(s, "mps_stage_bodies")) return 1;
    if (!role || !body)
        return mps_stage_fail(s, "mps_stage_bodies(): %s is NULL: must be an array of view->n",
                              role ? "body" : "role");
    return h->memory.space == MPS__ON_DEVICE ? mps__bodies_device(s, most, role, body)
                                             : find_free(s, most, role, body);
}

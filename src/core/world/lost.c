/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles that left the domain or are behind a wall. */
#include "world_ranks.h"
#include <string.h>

/* Remove the last particles, but keep them in memory: later parts of the step may fail. `all`:
 * number on all ranks. */
static void set_aside(mps__world *w, int64_t count, int64_t all)
{
    w->particles.n -= count;
    mps__particles_written(&w->particles);
    w->next_flags.holds = false;
    w->ghosts.known -= count;
    w->particles.generation++;
    w->lists.aside += count;
    w->lists.gone += all;
    w->lists.neighbours.valid = false;
}

void mps__world_take_back(mps__world *w)
{
    w->state.lost -= w->lists.lost;
    w->lists.lost = 0;
    if (w->lists.gone > 0) set_aside(w, -w->lists.aside, -w->lists.gone);
}

/* Move the particles marked in `gone` behind the others. */
static mps_status part_lost(mps__world *w, const bool *gone, int64_t lost)
{
    mps__particles *s = &w->particles;
    int64_t stay = 0, go = s->n - lost;
    if (lost == 0) return MPS_OK;
    int32_t *order = mps__alloc(w->context, s->n, sizeof *order);
    if (!order) return MPS_E_NOMEM;
    for (int64_t i = 0; i < s->n; i++) order[gone[i] ? go++ : stay++] = (int32_t)i;
    mps_status status = mps__ghosts_ordered(&w->ghosts, order);
    if (status == MPS_OK) status = mps__particles_permute(s, s->n, order);
    mps__free(w->context, order);
    return status;
}

/* Apply the policy to the particles marked in `gone`, if any; the text names their location and the
 * one with the least id. */
static mps_status handle_lost(mps__world *w, const bool *gone, const char *where)
{
    const mps__particles *s = &w->particles;
    mps__found found = {.id = INT64_MAX};
    for (int64_t i = 0; i < s->n; i++) {
        if (!gone[i]) continue;
        found.count++;
        if (s->id[i] > found.id) continue;
        found.id = s->id[i];
        memcpy(found.x, s->x + i * s->dim, (size_t)s->dim * sizeof *s->x);
    }
    const int64_t lost = found.count;
    mps__world_find(w, &found);
    if (found.count == 0) return MPS_OK;
    if (w->setup.lost_policy == MPS_LOST_ERROR)
        return mps__fail(w->context, MPS_E_LOST,
                         "%lld particles %s at t = %.6g s; particle %lld is at (%g, %g, %g) m",
                         (long long)found.count, where, w->state.t, (long long)found.id, found.x[0],
                         found.x[1], found.x[2]);
    mps__log(w->context, MPS_LOG_WARNING,
             "t = %.6g s: %lld particles %s and were removed; particle %lld was at (%g, %g, %g) m",
             w->state.t, (long long)found.count, where, (long long)found.id, found.x[0], found.x[1],
             found.x[2]);
    MPS__TRY(part_lost(w, gone, lost));
    set_aside(w, lost, found.count);
    w->state.lost += found.count;
    w->lists.lost += found.count;
    return MPS_OK;
}

mps_status mps__world_part(mps__world *w, const bool *gone, int64_t count)
{
    int64_t all = count;
    MPS__TRY(part_lost(w, gone, count));
    mps__ranks_add(&w->ranks, 1, &all);
    if (all > 0) set_aside(w, count, all);
    return mps__ranks_status(&w->ranks);
}

typedef struct box {
    bool *gone;
    double lo[3], hi[3];
} box;

MPS_ROW bool is_outside(const int dim, const mps_view *v, const box *f, int64_t i)
{
    const mps_tank_pose *k = &v->tank;
    double X[3];
    bool out = false;
    if (!mps_is_fluid(v, i)) return false;
    mps__tank_place(dim, k->centre, k->shift, k->rotation, v->x + i * dim, X);
    for (int d = 0; d < dim; d++) out |= !(X[d] >= f->lo[d] && X[d] <= f->hi[d]);
    return out;
}

MPS_ROW void look_outside(const int dim, const mps_view *v, const box *f, int64_t i)
{
    f->gone[i] = is_outside(dim, v, f, i);
}
MPS_ROWS(outside_rows, look_outside, box)

/* Also for ghosts, which the loops skip. */
static void clear_gone(const mps__world *w)
{
    memset(w->work.gone, 0, (size_t)w->particles.n * sizeof *w->work.gone);
}

/* The maximum: whether any particle is outside. */
MPS_ROW void note_outside(const int dim, const mps_view *v, const box *f, int64_t i, double *any)
{
    if (is_outside(dim, v, f, i)) *any = 1;
}
MPS_SUMS(any_outside, note_outside, box)

/* Whether any liquid is outside, by a loop on the device of the step. */
static mps_status look_out_device(mps__world *w, const mps_view *v, const box *b, bool *any)
{
    double most = 0;
    MPS__TRY(mps__memory_enter(&w->runner.memory));
    mps__runner_max(&w->runner, v, 1, &any_outside, b, &most);
    *any = most > 0;
    return mps__memory_exit(&w->runner.memory);
}

mps_status mps__world_leave_domain(mps__world *w)
{
    box b = {.gone = NULL};
    bool any = true;
    mps_view v;
    if (w->next_flags.holds && !(w->next_flags.most[MPS__NEXT_OUTSIDE] > 0)) return MPS_OK;
    MPS__TRY(mps__world_fetch_field(w, MPS__FIELD_REF)); /* solids move in the tank */
    if (!mps__world_domain(w, b.lo, b.hi)) return MPS_OK;
    mps__world_view(w, &v);
    if (!w->next_flags.holds && mps__world_on_device(w) && !mps__ranks_many(&w->ranks))
        MPS__TRY(look_out_device(w, &v, &b, &any));
    if (!any) return MPS_OK;
    MPS__TRY(mps__world_fetch(w));
    b.gone = w->work.gone;
    clear_gone(w);
    mps__runner_rows(&w->runner, &v, &outside_rows, &b);
    return handle_lost(w, w->work.gone, "left the domain");
}

/* Arguments of the test whether a particle is behind a wall: pairs of the search, and solids in the
 * frame of the tank. */
typedef struct spill_test {
    const int64_t *begin, *middle; /* near candidates of a row */
    const int32_t *count;          /* NULL, or numbers of all candidates, which are tested then */
    const int32_t *col, *plate;
    const uint8_t *near_dummies; /* not 0: the particle may have dummies nearby */
    const double *ref, *area;
    bool *gone;
} spill_test;

MPS_ROW int64_t end_of(const spill_test *f, int64_t i)
{
    return f->count ? f->begin[i] + f->count[i] : f->middle[i];
}

MPS_ROW double distance2(const int dim, const mps_view *v, int64_t i, int64_t j)
{
    double sum = 0;
    for (int d = 0; d < dim; d++) {
        const double way = v->x[j * dim + d] - v->x[i * dim + d];
        sum += way * way;
    }
    return sum;
}

/* Whether particle i, `r2` from a dummy, is beyond the face of this dummy, and no wall is nearer
 * than the dummy. */
MPS_ROW bool behind(const int dim, const mps_view *v, const spill_test *f, int64_t i, int64_t dummy,
                    double r2)
{
    const mps_tank_pose *k = &v->tank;
    const int64_t wall = v->wall_of[dummy];
    double X[3], height = 0;
    if (wall < 0) return false;
    mps__tank_place(dim, k->centre, k->shift, k->rotation, v->x + i * dim, X);
    for (int d = 0; d < dim; d++)
        height += (X[d] - f->ref[wall * dim + d]) * f->area[wall * dim + d];
    for (int64_t p = f->begin[i]; height < 0 && p < end_of(f, i); p++)
        if (mps_is_wall(v, f->col[p]) && distance2(dim, v, i, f->col[p]) <= r2) return false;
    return height < 0;
}

/* Whether particle i touches a wall from behind. */
MPS_ROW bool spilled(const int dim, const mps_view *v, const spill_test *f, int64_t i)
{
    for (int64_t p = f->begin[i]; p < end_of(f, i); p++) {
        const int64_t j = f->col[p];
        if (!mps_is_dummy(v, j) || f->plate[j] != 0) continue;
        const double r2 = distance2(dim, v, i, j);
        if (r2 < v->dp * v->dp && behind(dim, v, f, i, j, r2)) return true;
    }
    return false;
}

MPS_ROW void look_behind(const int dim, const mps_view *v, const spill_test *f, int64_t i)
{
    f->gone[i] = f->near_dummies[i] && spilled(dim, v, f, i);
}
MPS_ROWS(spilled_rows, look_behind, spill_test)

/* Arrays in the memory space of the loops. */
static spill_test spill_test_of(const mps__world *w)
{
    const mps_neighbours *l = &w->lists.neighbours;
    return (spill_test){.begin = mps__seen_list(w, MPS__ROWS_BEGIN, l->begin),
                        .middle = mps__seen_list(w, MPS__ROWS_MIDDLE, l->middle),
                        .col = mps__seen_list(w, MPS__ROWS_COLUMNS, l->col),
                        .plate = mps__seen(w, MPS__FIELD_PLATE),
                        .near_dummies = mps__seen_list(w, MPS__NEAR_DUMMIES, l->near_dummies),
                        .ref = mps__seen(w, MPS__FIELD_REF),
                        .area = mps__seen(w, MPS__FIELD_AREA),
                        .gone = w->work.gone};
}

/* ---- next-step flags ---- */

typedef struct flags {
    box box;
    /* `near_dummies` NULL: rows are not in this memory space, or plates occlude some candidates */
    spill_test spill;
    const double *searched, *u;
    mps__carry carry;
} flags;

MPS_ROW void raise_flag(const int dim, const mps_view *v, const flags *f, int64_t i, double *most)
{
    const double speed = mps__relative2(dim, &f->carry, v->x + i * dim, f->u + i * dim);
    double way = 0;
    for (int d = 0; d < dim; d++) {
        const double m = v->x[i * dim + d] - f->searched[i * dim + d];
        way += m * m;
    }
    if (is_outside(dim, v, &f->box, i)) most[MPS__NEXT_OUTSIDE] = 1;
    if (most[MPS__NEXT_SPILLED] < 1)
        most[MPS__NEXT_SPILLED] = !f->spill.near_dummies ||
                                  (f->spill.near_dummies[i] && spilled(dim, v, &f->spill, i));
    if (way > most[MPS__NEXT_WAY]) most[MPS__NEXT_WAY] = way;
    if (speed > most[MPS__NEXT_SPEED]) most[MPS__NEXT_SPEED] = speed;
}
MPS_SUMS(raise_flags, raise_flag, flags)

static void take_flags(void *to, const double *most)
{
    memcpy(to, most, MPS__NEXT_FLAGS * sizeof *most);
}

void mps__world_request_flags(mps__world *w, const mps__pose *pose, mps__next_flags *next)
{
    flags f = {.searched = mps__seen_list(w, MPS__SEARCHED, w->lists.neighbours.searched),
               .u = mps__seen(w, MPS__FIELD_VELOCITY),
               .carry = mps__motion_carry(&w->motion, pose)};
    mps_view v;
    if (mps__world_rows_on_device(w) && w->lists.occluders.count == 0) {
        f.spill = spill_test_of(w);
        f.spill.count = mps__seen_list(w, MPS__ROWS_COUNT, w->lists.neighbours.count);
    }
    for (int d = 0; d < 3; d++) {
        f.box.lo[d] = -INFINITY;
        f.box.hi[d] = INFINITY;
    }
    mps__world_domain(w, f.box.lo, f.box.hi);
    mps__world_view(w, &v);
    mps__motion_view(&w->motion, pose, &v.tank);
    mps__runner_max_deferred(&w->runner, &v, MPS__NEXT_FLAGS, &raise_flags, &f,
                             (mps__then){take_flags, next->most});
    next->flow = mps__particles_flow(&w->particles);
    next->searches = w->lists.neighbours.searches;
}

/* ---- behind walls ---- */

/* Whether any liquid is behind a wall, if the device of the step has rows: most steps do not need
 * them on the host. */
static mps_status look_device(mps__world *w, const mps_view *v, bool *any)
{
    double most[MPS__NEXT_FLAGS] = {0};
    MPS__TRY(mps__memory_enter(&w->runner.memory));
    const flags f = {.searched = mps__seen_list(w, MPS__SEARCHED, w->lists.neighbours.searched),
                     .u = mps__seen(w, MPS__FIELD_VELOCITY),
                     .spill = spill_test_of(w)};
    mps__runner_max(&w->runner, v, MPS__NEXT_FLAGS, &raise_flags, &f, most);
    *any = most[MPS__NEXT_SPILLED] > 0;
    return mps__memory_exit(&w->runner.memory);
}

/* Whether the last step has found no liquid behind walls, and its rows are still valid. */
static bool is_known_dry(const mps__world *w)
{
    return w->next_flags.holds && w->next_flags.searches == w->lists.neighbours.searches &&
           w->next_flags.most[MPS__NEXT_SPILLED] == 0;
}

/* Remove liquid that has flowed over the edge of an open tank and touches its walls from behind: it
 * would exert pressure on them as if it were in front. */
mps_status mps__world_leave_tank(mps__world *w)
{
    bool any = true;
    mps_view v;
    mps__world_view(w, &v);
    if (is_known_dry(w)) return MPS_OK;
    if (mps__world_rows_on_device(w) && !mps__ranks_many(&w->ranks))
        MPS__TRY(look_device(w, &v, &any));
    if (!any) return MPS_OK;
    MPS__TRY(mps__world_fetch(w));
    mps__memory_sync_rows(&w->runner.memory);
    MPS__TRY(mps__device_status(&w->runner.memory.device));
    const spill_test f = spill_test_of(w);
    clear_gone(w);
    mps__runner_rows(&w->runner, &v, &spilled_rows, &f);
    return handle_lost(w, w->work.gone, "are behind a wall");
}

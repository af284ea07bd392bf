/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles that left the domain or stand behind a wall. */
#include "world_ranks.h"
#include <string.h>

static bool outside(const mps__world *w, int64_t i, const double *lo, const double *hi)
{
    double X[3];
    if (w->particles.kind[i] != MPS_FLUID) return false;
    mps__motion_to_tank(&w->motion, &w->motion.now, w->particles.x + i * w->setup.dim, X);
    for (int d = 0; d < w->setup.dim; d++)
        if (!(X[d] >= lo[d] && X[d] <= hi[d])) return true;
    return false;
}

/* The last particles are no more, but they stay where they are in memory: what comes now may fail. `all`: on all ranks. */
static void set_aside(mps__world *w, int64_t count, int64_t all)
{
    w->particles.n -= count;
    w->ghosts.known -= count;
    w->particles.generation++;
    w->state.lost += all;
    w->lists.aside += count;
    w->lists.gone += all;
    w->lists.neighbours.valid = false;
}

void mps__world_take_back(mps__world *w)
{
    if (w->lists.gone > 0) set_aside(w, -w->lists.aside, -w->lists.gone);
}

/* Move the particles with `gone` behind the others. */
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

/* Apply the policy to the particles with `gone`, if any; the text says where they are, and names the one with the least id. */
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
    return MPS_OK;
}

typedef struct box {
    const mps__world *w;
    double lo[3], hi[3];
} box;

static void outside_rows(void *argument, int64_t begin, int64_t end)
{
    const box *b = argument;
    for (int64_t i = begin; i < end; i++)
        b->w->work.gone[i] = !mps__is_ghost(&b->w->ghosts, i) && outside(b->w, i, b->lo, b->hi);
}

mps_status mps__world_leave_domain(mps__world *w)
{
    box b = {.w = w};
    if (!mps__world_domain(w, b.lo, b.hi)) return MPS_OK;
    mps_parallel_rows(&w->pool.parallel, w->particles.n, outside_rows, &b);
    return handle_lost(w, w->work.gone, "left the domain");
}

static double distance2(const mps__world *w, int64_t i, int64_t j)
{
    double sum = 0;
    for (int d = 0; d < w->setup.dim; d++)
        sum += pow(w->particles.x[j * w->setup.dim + d] - w->particles.x[i * w->setup.dim + d], 2);
    return sum;
}

/* Is particle i, `r2` from a dummy, beyond the face this dummy stands behind, and is no wall nearer than the dummy? */
static bool behind(const mps__world *w, int64_t i, int64_t dummy, double r2)
{
    const mps__particles *s = &w->particles;
    const mps_neighbours *l = &w->lists.neighbours;
    const int64_t wall = s->wall_of[dummy];
    double X[3], height = 0;
    if (wall < 0) return false;
    mps__motion_to_tank(&w->motion, &w->motion.now, s->x + i * w->setup.dim, X);
    for (int d = 0; d < w->setup.dim; d++)
        height += (X[d] - s->ref[wall * w->setup.dim + d]) * s->area[wall * w->setup.dim + d];
    for (int64_t p = l->begin[i]; height < 0 && p < l->middle[i]; p++)
        if (s->kind[l->col[p]] == MPS_WALL && distance2(w, i, l->col[p]) <= r2) return false;
    return height < 0;
}

/* Whether particle i touches a wall from behind. */
static bool spilled(const mps__world *w, int64_t i)
{
    const mps__particles *s = &w->particles;
    const mps_neighbours *l = &w->lists.neighbours;
    for (int64_t p = l->begin[i]; p < l->middle[i]; p++) {
        const int64_t j = l->col[p];
        if (s->kind[j] != MPS_DUMMY || mps__is_shadow(s, j)) continue;
        const double r2 = distance2(w, i, j);
        if (r2 < w->setup.dp * w->setup.dp && behind(w, i, j, r2)) return true;
    }
    return false;
}

static void spilled_rows(void *argument, int64_t begin, int64_t end)
{
    const mps__world *w = argument;
    for (int64_t i = begin; i < end; i++)
        w->work.gone[i] = w->lists.neighbours.rim[i] && spilled(w, i);
}

/* Liquid that ran over the rim of an open tank touches its walls from behind. There they would press it as if it stood before them. */
mps_status mps__world_leave_tank(mps__world *w)
{
    mps_parallel_rows(&w->pool.parallel, w->particles.n, spilled_rows, w);
    return handle_lost(w, w->work.gone, "are behind a wall");
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles with ids known to all ranks move at random: each has one owner at any time, all ghosts
 * within reach exist, and exchanged values are those of the owners. */
#include "kit_engine.h"
#include "ghosts.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { COUNT = 1500, MORE = 300, STEPS = 12, RANKS = 7 };
static const double reach = 0.08, reach_walls = 0.12;

/* What all ranks have together. */
typedef struct world {
    kit_engine_team *team;
    int dim;
    int32_t owners[STEPS][COUNT + MORE]; /* how many ranks own a particle; each rank adds */
    int64_t wrong[RANKS], missing[RANKS];
    mps_status status[RANKS];
} world;

/* Position of a particle in a step, by its id: a walk within the unit cube. */
static void place_of(int64_t id, int step, int dim, double *x)
{
    for (int d = 0; d < dim; d++) {
        uint32_t h = (uint32_t)(id * 2654435761u + (uint32_t)d * 40503u);
        double v = (double)(h % 65536) / 65536;
        for (int k = 0; k < step; k++) {
            h = h * 1664525u + 1013904223u;
            v += ((double)(h >> 8) / (1 << 24) - 0.5) * 0.3;
        }
        x[d] = v - floor(v);
    }
}

static void place_row(const void *argument, int64_t i, double *X)
{
    const mps__particles *s = argument;
    memcpy(X, s->x + i * s->dim, (size_t)s->dim * sizeof *X);
}

static float weight_row(const void *argument, int64_t i)
{
    (void)argument, (void)i;
    return 1;
}

static void set_places(mps__particles *s, int step)
{
    for (int64_t i = 0; i < s->n; i++) place_of(s->id[i], step, s->dim, s->x + i * s->dim);
}

static int32_t kind_of(int64_t id)
{
    return id % 5 == 0 ? MPS_WALL : MPS_FLUID;
}

static mps_status add(mps__particles *s, int64_t count, int step)
{
    MPS__TRY(mps__particles_reserve(s, count));
    const int64_t first = mps__particles_append(s, count, MPS_FLUID);
    for (int64_t i = first; i < s->n; i++) {
        s->kind[i] = kind_of(s->id[i]);
        place_of(s->id[i], step, s->dim, s->x + i * s->dim);
    }
    return MPS_OK;
}

/* Backwards: any order must do. */
static mps_status turn_round(mps__ghosts *g)
{
    mps__particles *s = g->particles;
    int32_t *order = malloc((size_t)s->n * sizeof *order);
    for (int64_t k = 0; k < s->n; k++) order[k] = (int32_t)(s->n - 1 - k);
    mps_status status = mps__ghosts_ordered(g, order);
    if (status == MPS_OK) status = mps__particles_permute(s, s->n, order);
    free(order);
    return status;
}

/* Number of missing ghosts: particles of other ranks within reach of an owned one. */
static int64_t missing_ghosts(const mps__ghosts *g, int64_t all, int step)
{
    const mps__particles *s = g->particles;
    static const int64_t none = -1;
    int64_t *here = malloc((size_t)all * sizeof *here), missing = 0;
    for (int64_t id = 0; id < all; id++) here[id] = none;
    for (int64_t i = 0; i < s->n; i++) here[s->id[i]] = i;
    for (int64_t i = 0; i < s->n; i++) {
        if (g->ghost[i]) continue;
        for (int64_t id = 0; id < all; id++) {
            double x[3] = {0};
            place_of(id, step, s->dim, x);
            const double r = kind_of(id) == MPS_WALL ? reach_walls : reach;
            if (mps__square_between(s->x + i * s->dim, x, s->dim) < r * r) missing += here[id] < 0;
        }
    }
    free(here);
    return missing;
}

/* Halo exchange of values that only owners have. */
static mps_status check_share(mps__ghosts *g, int64_t *wrong)
{
    mps__particles *s = g->particles;
    for (int64_t i = 0; i < s->n; i++) {
        s->p[i] = g->ghost[i] ? -1 : 3.0 * (double)s->id[i];
        s->phase[i] = g->ghost[i] ? -1 : (int32_t)s->id[i] % 11;
    }
    const mps__halo_array both[] = {{.values = s->p, .bytes = sizeof *s->p},
                                    {.values = s->phase, .bytes = sizeof *s->phase}};
    MPS__TRY(mps__ghosts_exchange(g, both, 2));
    for (int64_t i = 0; i < s->n; i++)
        *wrong += s->p[i] != 3.0 * (double)s->id[i] || s->phase[i] != (int32_t)s->id[i] % 11;
    return MPS_OK;
}

static void mark_rows(void *argument, int64_t begin, int64_t end)
{
    for (int64_t i = begin; i < end; i++) ((char *)argument)[i]++;
}

/* Rows are those of owned particles, each once, however they are parted. */
static int64_t wrong_rows(const mps__ghosts *g)
{
    const int64_t n = g->particles->n, third = n / 3;
    char *mark = calloc((size_t)n + 1, 1);
    int64_t wrong = 0;
    mps__ghosts_rows(g, mark_rows, mark, 0, third);
    mps__ghosts_rows(g, mark_rows, mark, third, n);
    for (int64_t i = 0; i < n; i++) wrong += mark[i] != !g->ghost[i];
    free(mark);
    return wrong;
}

static mps_status walk(world *w, int32_t rank, mps__ghosts *g)
{
    mps__particles *s = g->particles;
    const mps__placing p = {place_row, weight_row, s, reach, reach_walls};
    int64_t all = COUNT;
    MPS__TRY(add(s, COUNT, 0));
    for (int step = 0; step < STEPS; step++) {
        set_places(s, step);
        if (step == STEPS / 2) {
            MPS__TRY(add(s, MORE, step));
            all += MORE;
        }
        MPS__TRY(mps__ghosts_adopt(g, &p));
        g->recut = step % 3 == 1;
        MPS__TRY(mps__ghosts_renew(g, &p, 0));
        MPS__TRY(turn_round(g));
        for (int64_t i = 0; i < s->n; i++)
            if (!g->ghost[i]) __atomic_fetch_add(&w->owners[step][s->id[i]], 1, __ATOMIC_RELAXED);
        w->missing[rank] += missing_ghosts(g, all, step);
        w->wrong[rank] += wrong_rows(g);
        MPS__TRY(check_share(g, &w->wrong[rank]));
        for (int64_t i = 0; i < s->n; i++) w->wrong[rank] += s->kind[i] != kind_of(s->id[i]);
        w->wrong[rank] += g->known != s->n;
    }
    return MPS_OK;
}

static void run_rank(void *argument, int32_t rank)
{
    world *w = argument;
    mps__context c = {.allocator = mps__allocator_default()};
    mps__particles s;
    mps__ranks r;
    mps__ghosts g;
    const mps_ranks_ops ops = kit_engine_ops(w->team, rank);
    mps__ranks_init(&r, &c);
    mps__ghosts_init(&g, &c, &r, &s);
    mps_status status = mps__particles_init(&s, &c, w->dim);
    if (status == MPS_OK) status = mps__ranks_set(&r, &ops);
    if (status == MPS_OK) status = walk(w, rank, &g);
    w->status[rank] = status;
    mps__ghosts_free(&g);
    mps__particles_free(&s);
    mps__ranks_free(&r);
}

static void check(int32_t ranks, int dim, uint32_t skew)
{
    world *w = calloc(1, sizeof *w);
    w->team = kit_engine_create(ranks, skew);
    w->dim = dim;
    kit_engine_run(w->team, run_rank, w);
    for (int32_t r = 0; r < ranks; r++) {
        assert_int_equal(w->status[r], MPS_OK);
        assert_int_equal(w->wrong[r], 0);
        assert_int_equal(w->missing[r], 0);
    }
    for (int step = 0; step < STEPS; step++)
        for (int id = 0; id < (step < STEPS / 2 ? COUNT : COUNT + MORE); id++)
            assert_int_equal(w->owners[step][id], 1);
    kit_engine_destroy(w->team);
    free(w);
}

static void test_ghosts_2d(void **state)
{
    (void)state;
    check(2, 2, 0);
    check(7, 2, 0);
    check(5, 2, 1);
}

static void test_ghosts_3d(void **state)
{
    (void)state;
    check(2, 3, 1);
    check(7, 3, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_ghosts_2d),
                                       cmocka_unit_test(test_ghosts_3d)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

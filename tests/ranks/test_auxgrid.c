/* SPDX-License-Identifier: BSD-3-Clause */
/* `auxgrid` for an equation distributed over many ranks has the bytes of one rank, for any
 * partition. */
#include "../../src/ppe/builtin.h"
#include "../conformance/solver_kit.h"
#include "kit_engine.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { RANKS = 9, CUTS = 3 };
static const double reach = 3.1; /* of the widest lattice; more than auxgrid needs [dp] */

/* What all ranks have together. */
typedef struct world {
    kit_engine_team *team;
    const kit_system *system;
    double *z, *shared; /* [particles] */
    int32_t threads;
    int64_t whole;   /* number of cells from which a grid is distributed; 0: the default, more than
                      exist */
    int64_t fail_at; /* allocation of rank 1 that fails; 0: none */
    int reason[RANKS];
} world;

/* What a rank has of it. */
typedef struct piece {
    world *w;
    mps_ranks_ops ops;
    mps_ppe_problem problem;
    mps_ppe_ranks ranks;
    int64_t columns;
    int32_t *particle, *column; /* [columns], [particles] -1: not on this rank */
} piece;

static void *take(int64_t count, size_t size)
{
    void *block = calloc((size_t)(count > 0 ? count : 1), size);
    if (!block) abort();
    return block;
}

/* ---- messages ---- */

static int owner(void *host, int64_t m, const double *x, int32_t *rank)
{
    const piece *p = host;
    return p->ops.owner(p->ops.user, m, x, rank);
}

static int reduce(void *host, int32_t count, size_t bytes, void *values, mps_combine_fn combine)
{
    const piece *p = host;
    return p->ops.reduce(p->ops.user, count, bytes, values, combine);
}

static int gather(void *host, const void *own, const int64_t *bytes, void *all)
{
    const piece *p = host;
    return p->ops.gather(p->ops.user, own, bytes, all);
}

static int connect_ranks(void *host, int32_t count, const int32_t *to, const int64_t *sent,
                         mps_route *route)
{
    const piece *p = host;
    return p->ops.connect(p->ops.user, count, to, sent, route);
}

static void disconnect_ranks(void *host, mps_route *route)
{
    const piece *p = host;
    p->ops.disconnect(p->ops.user, route);
}

static int exchange(void *host, const mps_route *route, size_t bytes, const void *out, void *in)
{
    const piece *p = host;
    return p->ops.exchange_begin(p->ops.user, route, bytes, out, in) ||
           p->ops.exchange_end(p->ops.user, route);
}

static void first(void *into, const void *from)
{
    (void)into, (void)from;
}

/* Through memory that all ranks see. */
static int exchange_halo(void *host, double *x)
{
    const piece *p = host;
    int32_t none = 0;
    for (int64_t k = 0; k < p->problem.n; k++) p->w->shared[p->particle[k]] = x[k];
    if (reduce(host, 1, sizeof none, &none, first)) return 1;
    for (int64_t k = p->problem.n; k < p->columns; k++) x[k] = p->w->shared[p->particle[k]];
    return reduce(host, 1, sizeof none, &none, first);
}

/* ---- rows of a rank ---- */

static bool is_beside(const piece *p, int64_t i, int32_t rank)
{
    const mps_ppe_problem *all = &p->w->system->problem;
    double lo[3], hi[3];
    int32_t ranks[RANKS], count;
    for (int d = 0; d < all->dim; d++) {
        lo[d] = all->x[i * all->dim + d] - reach * all->dp;
        hi[d] = all->x[i * all->dim + d] + reach * all->dp;
    }
    p->ops.overlap(p->ops.user, lo, hi, ranks, &count);
    for (int32_t k = 0; k < count; k++)
        if (ranks[k] == rank) return true;
    return false;
}

/* Own particles, behind them those of other ranks within reach, and the order of both. */
static void number_columns(piece *p, int32_t rank)
{
    const mps_ppe_problem *all = &p->w->system->problem;
    int32_t *of = take(all->n, sizeof *of);
    int32_t *order = take(all->n, sizeof *order);
    p->particle = take(all->n, sizeof *p->particle);
    p->column = take(all->n, sizeof *p->column);
    owner(p, all->n, all->x, of);
    for (int ghosts = 0; ghosts < 2; ghosts++) {
        for (int64_t i = 0; i < all->n; i++) {
            if (!ghosts) p->column[i] = -1;
            if ((of[i] == rank) == ghosts || (ghosts && !is_beside(p, i, rank))) continue;
            p->column[i] = (int32_t)p->columns;
            p->particle[p->columns++] = (int32_t)i;
        }
        if (!ghosts) p->problem.n = p->columns;
    }
    for (int64_t i = 0, k = 0; i < all->n; i++)
        if (p->column[i] >= 0) order[k++] = p->column[i];
    for (int64_t i = 0; i < all->n; i++) p->ranks.first += of[i] < rank;
    p->ranks.order = order;
    free(of);
}

static void copy_rows(piece *p)
{
    const mps_ppe_problem *all = &p->w->system->problem;
    const int64_t n = p->problem.n, dim = all->dim;
    int64_t *row = take(n + 1, sizeof *row), entries = 0;
    for (int64_t r = 0; r < n; r++) {
        const int64_t i = p->particle[r];
        row[r + 1] = entries += all->row[i + 1] - all->row[i];
    }
    int32_t *col = take(entries, sizeof *col);
    float *val = take(entries, sizeof *val);
    double *diagonal = take(n, sizeof *diagonal), *shift = take(n, sizeof *shift),
           *x = take(p->columns * dim, sizeof *x);
    for (int64_t r = 0; r < p->columns; r++) {
        const int64_t i = p->particle[r];
        memcpy(x + r * dim, all->x + i * dim, (size_t)dim * sizeof *x);
        if (r >= n) continue;
        diagonal[r] = all->diagonal[i];
        shift[r] = all->shift[i];
        for (int64_t k = all->row[i], at = row[r]; k < all->row[i + 1]; k++, at++) {
            col[at] = p->column[all->col[k]];
            val[at] = all->val[k];
            if (col[at] < 0) abort();
        }
    }
    p->problem.row = row;
    p->problem.col = col;
    p->problem.val = val;
    p->problem.diagonal = diagonal;
    p->problem.shift = shift;
    p->problem.x = x;
}

static void build(piece *p, int32_t rank)
{
    const mps_ppe_problem *all = &p->w->system->problem;
    p->problem = *all;
    p->columns = 0;
    p->ranks = (mps_ppe_ranks){.struct_size = sizeof p->ranks,
                               .rank = rank,
                               .rows = all->n,
                               .owner = owner,
                               .halo = exchange_halo,
                               .reduce = reduce,
                               .gather = gather,
                               .connect = connect_ranks,
                               .disconnect = disconnect_ranks,
                               .exchange = exchange,
                               .host = p};
    p->ops.place(p->ops.user, &rank, &p->ranks.ranks);
    number_columns(p, rank);
    p->ranks.ghosts = p->columns - p->problem.n;
    copy_rows(p);
    p->problem.ranks = &p->ranks;
}

static void drop(piece *p)
{
    const mps_ppe_problem *q = &p->problem;
    const void *all[] = {q->row, q->col,      q->val,    q->diagonal,   q->shift,
                         q->x,   p->particle, p->column, p->ranks.order};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) free((void *)all[k]);
}

/* z = M^-1 rhs of the own rows, with one state for several cuts. */
static void run_rank(void *argument, int32_t rank)
{
    world *w = argument;
    const mps_ppe_problem *all = &w->system->problem;
    const mps_preconditioner_ops *pc = &mps__preconditioner_auxgrid;
    const mps_parallel parallel = kit_parallel(w->threads);
    piece p = {.w = w, .ops = kit_engine_ops(w->team, rank)};
    kit_memory memory;
    void *self = w->whole > 0 ? &w->whole : NULL;
    float *weight = take(all->n, sizeof *weight);
    kit_memory_init(&memory);
    if (rank == 1) memory.fail_at = w->fail_at;
    for (int64_t i = 0; i < all->n; i++) weight[i] = 1;
    if (pc->create(&memory.allocator, &self)) abort();
    for (int cut = 0; cut < CUTS && !w->reason[rank]; cut++) {
        p.ops.partition(p.ops.user, all->dim, rank == 0 ? all->n : 0, all->x, weight);
        build(&p, rank);
        if (w->threads > 1) p.problem.parallel = &parallel;
        double *r = take(p.problem.n, sizeof *r), *z = take(p.problem.n, sizeof *z);
        for (int64_t k = 0; k < p.problem.n; k++) r[k] = all->rhs[p.particle[k]];
        int reason = pc->setup(self, &p.problem);
        if (!reason) reason = pc->apply(self, r, z);
        for (int64_t k = 0; k < p.problem.n && !reason; k++) w->z[p.particle[k]] = z[k];
        w->reason[rank] = reason;
        if (reason == MPS_PPE_NOMEM)
            (p.ops.fail)(p.ops.user, "no memory"); /* cmocka has a macro `fail` */
        free(r);
        free(z);
        if (cut + 1 == CUTS || reason) pc->destroy(&memory.allocator, self);
        drop(&p);
    }
    if (memory.live != 0) w->reason[rank] = -1;
    free(weight);
}

/* ---- checks ---- */

static void run(world *w, int32_t ranks, uint32_t skew)
{
    w->team = kit_engine_create(ranks, skew);
    kit_engine_run(w->team, run_rank, w);
    kit_engine_destroy(w->team);
}

static void check_ranks(const kit_system *s, const double *alone, int32_t ranks, int32_t threads,
                        int64_t whole)
{
    const int64_t n = s->problem.n;
    world w = {.system = s,
               .threads = threads,
               .whole = whole,
               .z = take(n, sizeof *w.z),
               .shared = take(n, sizeof *w.shared)};
    run(&w, ranks, (uint32_t)ranks % 4);
    for (int32_t r = 0; r < ranks; r++) assert_int_equal(w.reason[r], 0);
    for (int64_t i = 0; i < n; i++)
        if (memcmp(&w.z[i], &alone[i], sizeof *alone) != 0)
            fail_msg("%d ranks: z of particle %lld is %.17g, not %.17g", (int)ranks, (long long)i,
                     w.z[i], alone[i]);
    free(w.z);
    free(w.shared);
}

static double *applied_alone(const kit_system *s)
{
    const mps_preconditioner_ops *pc = &mps__preconditioner_auxgrid;
    double *z = take(s->problem.n, sizeof *z);
    kit_memory memory;
    void *self = NULL;
    kit_memory_init(&memory);
    assert_int_equal(pc->create(&memory.allocator, &self), 0);
    assert_int_equal(pc->setup(self, &s->problem), 0);
    assert_int_equal(pc->apply(self, s->problem.rhs, z), 0);
    pc->destroy(&memory.allocator, self);
    return z;
}

static void check_lattice(const kit_lattice *lattice, int32_t threads)
{
    static const int32_t ranks[] = {2, 3, 4, 7, RANKS};
    static const int64_t whole[] = {0, 300, 1};
    kit_system *s = kit_lattice_system(lattice);
    assert_non_null(s);
    double *alone = applied_alone(s);
    for (size_t k = 0; k < sizeof ranks / sizeof ranks[0]; k++)
        for (int w = 0; w < 3; w++) check_ranks(s, alone, ranks[k], threads, whole[w]);
    free(alone);
    kit_system_free(s);
}

static void one_density(void **state)
{
    (void)state;
    check_lattice(&(kit_lattice){2, 60, 40, 1, 1, 1, 3.1, 1, 0.01}, 1);
    check_lattice(&(kit_lattice){3, 18, 15, 12, 1, 1, 2.1, 1, 0.01}, 1);
}

static void two_densities(void **state)
{
    (void)state;
    check_lattice(&(kit_lattice){2, 60, 40, 1, 2, 1, 3.1, 1000, 0}, 1);
    check_lattice(&(kit_lattice){3, 18, 15, 12, 1, 1, 2.1, 1000, 0}, 1);
}

static void with_threads(void **state)
{
    (void)state;
    check_lattice(&(kit_lattice){2, 160, 120, 1, 1, 1, 3.1, 1, 0}, 2);
    check_lattice(&(kit_lattice){2, 160, 120, 1, 1, 1, 3.1, 1000, 0}, 2);
}

/* Ranks without rows, more ranks than cells, and all particles in one cell. */
static void few_particles(void **state)
{
    (void)state;
    check_lattice(&(kit_lattice){2, 1, 1, 1, 1, 1, 3.1, 1, 0}, 1);
    check_lattice(&(kit_lattice){2, 2, 2, 1, 1, 1, 3.1, 1, 0}, 1);
    check_lattice(&(kit_lattice){2, 3, 2, 1, 1, 1, 3.1, 1, 0}, 1);
    check_lattice(&(kit_lattice){3, 2, 2, 2, 1, 1, 2.1, 1000, 0}, 1);
    check_lattice(&(kit_lattice){2, 3, 3, 1, 3, 1, 3.1, 1, 0}, 1);
}

/* What one rank finds in its rows all ranks report. */
static void all_refuse(void **state)
{
    (void)state;
    static const double wrong[] = {-1, 0}; /* 0 represents NaN */
    kit_system *s = kit_lattice_system(&(kit_lattice){2, 30, 20, 1, 1, 1, 3.1, 1, 0});
    assert_non_null(s);
    for (int k = 0; k < 2; k++) {
        world w = {.system = s,
                   .threads = 1,
                   .z = take(s->problem.n, sizeof *w.z),
                   .shared = take(s->problem.n, sizeof *w.shared)};
        s->diagonal[s->problem.n / 3] = wrong[k] < 0 ? wrong[k] : (double)NAN;
        run(&w, 4, 1);
        for (int32_t r = 0; r < 4; r++)
            assert_int_equal(w.reason[r], wrong[k] < 0 ? MPS_PPE_INDEFINITE : MPS_PPE_NAN);
        free(w.z);
        free(w.shared);
    }
    kit_system_free(s);
}

/* Where a rank has no memory all ranks end, without a crash or a leak. */
static void no_memory(void **state)
{
    (void)state;
    const kit_lattice lattices[] = {{2, 40, 30, 1, 1, 1, 3.1, 1, 0},
                                    {2, 40, 30, 1, 1, 1, 3.1, 1000, 0}};
    for (int k = 0; k < 2; k++) {
        kit_system *s = kit_lattice_system(&lattices[k]);
        assert_non_null(s);
        bool failed = true;
        for (int64_t at = 2; failed; at++) { /* the first is that of create() */
            world w = {.system = s,
                       .threads = 1,
                       .whole = 100,
                       .fail_at = at,
                       .z = take(s->problem.n, sizeof *w.z),
                       .shared = take(s->problem.n, sizeof *w.shared)};
            run(&w, 3, 1);
            failed = w.reason[1] != 0;
            for (int32_t r = 0; r < 3; r++) {
                assert_int_equal(w.reason[r] != 0, failed);
                assert_int_not_equal(w.reason[r], -1);
            }
            assert_true(at > 30 || failed);
            free(w.z);
            free(w.shared);
        }
        kit_system_free(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_density),  cmocka_unit_test(two_densities),
        cmocka_unit_test(with_threads), cmocka_unit_test(few_particles),
        cmocka_unit_test(all_refuse),   cmocka_unit_test(no_memory)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

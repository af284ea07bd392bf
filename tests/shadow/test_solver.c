/* SPDX-License-Identifier: BSD-3-Clause */
/* Conjugate gradients on a device have the bytes of those on the host, for every reason to stop;
 * costs of an iteration. */
#define _POSIX_C_SOURCE 200809L
#include "scene.h"
#include "solutions.h"

/* after cmocka.h */
#include "../turns.h"

static void solutions(void **state)
{
    mps_sim *sim = new_sim(2, 0.1);
    shadow s;
    (void)state;
    shadow_heap(sim);
    shadow_attach(&s, sim);
    compare_solutions(sim, 1);
    mps_sim_destroy(sim);
    assert_int_equal(s.blocks, 0);
}

/* ---- grids ---- */

/* Some particles are isolated, in cells without neighbours, which have no coarser cell. */
static void scattered(kit_system *s)
{
    for (int64_t i = 0; i < s->problem.n; i += 53)
        for (int a = 0; a < s->problem.dim; a++)
            s->x[i * s->problem.dim + a] += s->problem.dp * (double)(i % 1009 + 200) *
                                            (a == 0 ? -0.7 : 1.3);
}

/* No order of the particles helps to find cells. */
static void shuffled(kit_system *s)
{
    const int dim = s->problem.dim;
    const int64_t n = s->problem.n;
    for (int64_t i = 0; i < n; i++)
        for (int a = 0; a < dim; a++) {
            const int64_t other = (i * 7919 + 13) % n * dim + a;
            const double x = s->x[i * dim + a];
            s->x[i * dim + a] = s->x[other];
            s->x[other] = x;
        }
}

/* Several grids of one density and two, with and without isolated cells: host and device have the
 * same setup for all positions. */
static void grids(void **state)
{
    static const kit_lattice lattices[] = {
        {.dim = 2, .nx = 120, .ny = 80, .nz = 1, .boxes = 2, .open = 2, .re = 3.1, .contrast = 1},
        {.dim = 2, .nx = 90, .ny = 80, .nz = 1, .boxes = 2, .open = 2, .re = 3.1, .contrast = 800},
        {.dim = 3, .nx = 20, .ny = 18, .nz = 16, .boxes = 1, .open = 1, .re = 2.1, .contrast = 1},
        {.dim = 3,
         .nx = 16,
         .ny = 18,
         .nz = 16,
         .boxes = 1,
         .open = 1,
         .re = 2.1,
         .contrast = 800}};
    static const solution cases[] = {{"grids", MPS_PPE_CONVERGED, 2000, 0, 1e-6, NULL},
                                     {"scattered", -1, 40, 0, 1e-6, scattered},
                                     {"shuffled", -1, 40, 0, 1e-6, shuffled}};
    mps_sim *sim = new_sim(2, 0.1);
    shadow s;
    (void)state;
    shadow_heap(sim);
    shadow_attach(&s, sim);
    assert_int_equal(mps_solver_use(sim, "sundials.pcg", "auxgrid"), MPS_OK);
    for (size_t l = 0; l < sizeof lattices / sizeof lattices[0]; l++)
        for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
            const int32_t made = shadow_seen(&s, "auxgrid_coarse.c", "merge_rows"),
                          edges_before = shadow_seen(&s, "auxgrid_edges.c", "edge_rows");
            compare_solution(sim, &lattices[l], &cases[c], "auxgrid");
            const bool coarse = shadow_seen(&s, "auxgrid_coarse.c", "merge_rows") > made,
                       edges = shadow_seen(&s, "auxgrid_edges.c", "edge_rows") > edges_before;
            if (!coarse || edges != (lattices[l].contrast > 1))
                fail_msg("lattice %d, %s: coarser grids %d, edges %d", (int)l, cases[c].what,
                         coarse, edges);
        }
    mps_sim_destroy(sim);
    assert_int_equal(s.blocks, 0);
}

/* ---- what an iteration costs ---- */

/* Of eight iterations: those behind them, which find the correction and its residual where the run
 * has stopped. */
enum { BEHIND = 4 };

/* Launches of one iteration, waits per eight iterations, and all waits of a solution with eight:
 * also for the pressures, before the setup of auxgrid, and in it: 2 unless its grid has moved, and
 * one for each other grid. */
typedef struct cost {
    const char *preconditioner;
    kit_lattice lattice;
    int64_t launches, waits, all;
} cost;

static void counts_of(mps_sim *sim, const cost *c, int32_t most, int64_t counts[2])
{
    kit_system *s = kit_lattice_system(&c->lattice);
    mps__device *d = &sim->world.runner.memory.device;
    mps_solver_limits limits = {
        .struct_size = sizeof limits, .max_iterations = most, .tolerance = 1e-15};
    answer a;
    assert_non_null(s);
    assert_int_equal(mps__solvers_set_limits(&sim->world.solvers, &limits), MPS_OK);
    s->problem.weight = NULL;
    solve(sim, d, &s->problem, 0, &a);
    assert_int_equal(a.result.iterations, most);
    counts[0] = d->info.waits;
    counts[1] = d->info.launches;
    free(a.p);
    kit_system_free(s);
}

static void costs(void **state)
{
    static const kit_lattice small = {.dim = 2,
                                      .nx = 30,
                                      .ny = 20,
                                      .nz = 1,
                                      .boxes = 1,
                                      .open = 1,
                                      .re = 3.1,
                                      .contrast = 1},
                             large = {.dim = 2,
                                      .nx = 100,
                                      .ny = 80,
                                      .nz = 1,
                                      .boxes = 1,
                                      .open = 1,
                                      .re = 3.1,
                                      .contrast = 1};
    /* auxgrid: one grid, and three */
    const cost table[] = {{"none", small, 7, 1, 2},
                          {"jacobi", small, 8, 1, 2},
                          {"auxgrid", small, 12, 1, 5},
                          {"auxgrid", large, 34, 1, 7}};
    (void)state;
    for (size_t k = 0; k < sizeof table / sizeof table[0]; k++) {
        const cost *c = &table[k];
        int64_t few[2], many[2];
        mps_sim *sim = new_sim(2, 0.1);
        shadow s;
        shadow_attach(&s, sim);
        assert_int_equal(mps_solver_use(sim, "sundials.pcg", c->preconditioner), MPS_OK);
        counts_of(sim, c, 8, few); /* lays the grid */
        counts_of(sim, c, 8, few);
        counts_of(sim, c, 16, many);
        print_message("%s, %d particles: %g launches of an iteration, %lld waits for eight\n",
                      c->preconditioner, c->lattice.nx * c->lattice.ny,
                      (double)(many[1] - few[1] - BEHIND) / 8, (long long)(many[0] - few[0]));
        assert_int_equal(many[0] - few[0], c->waits);
        assert_int_equal(few[0], c->all);
        assert_int_equal(many[1] - few[1], 8 * c->launches + BEHIND);
        mps_sim_destroy(sim);
    }
}

int main(void)
{
    struct CMUnitTest tests[] = {
        cmocka_unit_test(solutions),
        cmocka_unit_test(grids),
        cmocka_unit_test(costs),
    };
    take_turns(tests, sizeof tests / sizeof tests[0], 3);
    return cmocka_run_group_tests(tests, NULL, NULL);
}

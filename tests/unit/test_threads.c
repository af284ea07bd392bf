/* SPDX-License-Identifier: BSD-3-Clause */
/* Solvers and preconditioners give the same bytes with one thread and with three; handles in
 * threads of the application are independent. For ThreadSanitizer too: these are the loops of the
 * solvers. */
#include "tank_fixture.h"
#include <pthread.h>

static mps_sim *wave(const char *solver, const char *preconditioner, int threads)
{
    mps_sim *sim = new_sim(2, 0.01);
    const mps_harmonic surge = {.dof = MPS_MOVE_X, .amplitude = 0.05, .omega = 8};
    ASSERT_OK(sim, mps_threads_set(sim, threads));
    ASSERT_OK(sim, mps_solver_use(sim, solver, preconditioner));
    add_tank(sim, 0.5, 0.3, 0);
    fill_depth(sim, 0.5, 0.2, 0);
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &surge));
    ASSERT_OK(sim, mps_step(sim, 3, NULL));
    return sim;
}

static void check_same(const char *channel, mps_sim *a, mps_sim *b)
{
    mps_lease x = {.struct_size = sizeof x}, y = {.struct_size = sizeof y};
    ASSERT_OK(a, mps_lease_begin(a, channel, MPS_READ, &x));
    ASSERT_OK(b, mps_lease_begin(b, channel, MPS_READ, &y));
    assert_true(x.count == y.count && x.stride == y.stride);
    assert_memory_equal(x.data, y.data, (size_t)(x.count * x.stride) * sizeof *x.data);
    ASSERT_OK(a, mps_lease_end(a, &x));
    ASSERT_OK(b, mps_lease_end(b, &y));
}

static void same_bytes(void **state)
{
    static const char *const pairs[][2] = {
        {"sundials.pcg", "none"},      {"sundials.pcg", "jacobi"},   {"sundials.pcg", "ic0"},
        {"sundials.pcg", "auxgrid"},   {"sundials.bicgstab", "ic0"}, {"sundials.gmres", "auxgrid"},
        {"sundials.kinsol", "jacobi"}, {"sundials.klu", NULL}};
    (void)state;
    for (size_t k = 0; k < sizeof pairs / sizeof pairs[0]; k++) {
        mps_sim *one = wave(pairs[k][0], pairs[k][1], 1),
                *three = wave(pairs[k][0], pairs[k][1], 3);
        check_same("position", one, three);
        check_same("velocity", one, three);
        check_same("pressure", one, three);
        mps_sim_destroy(one);
        mps_sim_destroy(three);
    }
}

typedef struct host {
    mps_sim *sim;
    mps_status status;
} host;

static void *go_on(void *argument)
{
    host *h = argument;
    h->status = mps_step(h->sim, 10, NULL);
    return NULL;
}

/* Two handles at the same time, each with threads of its own. */
static void two_handles(void **state)
{
    (void)state;
    host alone = {.sim = wave("sundials.pcg", NULL, 1)}, both[2];
    pthread_t thread[2];
    go_on(&alone);
    assert_int_equal(alone.status, MPS_OK);
    for (int k = 0; k < 2; k++) both[k] = (host){.sim = wave("sundials.pcg", NULL, 2)};
    for (int k = 0; k < 2; k++)
        assert_int_equal(pthread_create(&thread[k], NULL, go_on, &both[k]), 0);
    for (int k = 0; k < 2; k++) assert_int_equal(pthread_join(thread[k], NULL), 0);
    for (int k = 0; k < 2; k++) {
        assert_int_equal(both[k].status, MPS_OK);
        check_same("position", alone.sim, both[k].sim);
        mps_sim_destroy(both[k].sim);
    }
    mps_sim_destroy(alone.sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(same_bytes), cmocka_unit_test(two_handles)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

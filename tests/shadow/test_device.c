/* SPDX-License-Identifier: BSD-3-Clause */
/* A device is attached and detached, refused, and fails; costs of a step on it. */
#define _POSIX_C_SOURCE 200809L
#include "scene.h"
#include <math.h>

/* ---- attaching ---- */

static void tables_are_checked(void **state)
{
    mps_sim *sim = rolling("imps", 2);
    shadow s;
    (void)state;
    shadow_attach(&s, sim);
    mps_device_ops bad = s.ops;
    bad.api = MPS_DEVICE_API + 1;
    ASSERT_REFUSED(sim, mps_sim_device_set(sim, &bad), MPS_E_ARG, "api");
    bad = s.ops;
    bad.name = "";
    ASSERT_REFUSED(sim, mps_sim_device_set(sim, &bad), MPS_E_ARG, "name");
    bad = s.ops;
    bad.reduce = NULL;
    ASSERT_REFUSED(sim, mps_sim_device_set(sim, &bad), MPS_E_ARG, "lacks a function");
    bad = s.ops;
    bad.reduce_async = NULL;
    ASSERT_REFUSED(sim, mps_sim_device_set(sim, &bad), MPS_E_ARG, "lacks a function");
    bad = s.ops;
    bad.struct_size = 8;
    ASSERT_REFUSED(sim, mps_sim_device_set(sim, &bad), MPS_E_ARG, "mps_device_ops");
    /* the previous one is still attached */
    ASSERT_OK(sim, mps_step(sim, 0.01, NULL));
    assert_string_equal(shadow_counts(sim).name, "shadow");
    mps_sim_destroy(sim);
    assert_int_equal(s.blocks, 0);
}

static void leases_refuse(void **state)
{
    mps_sim *sim = rolling("imps", 2);
    mps_lease lease = {.struct_size = sizeof lease};
    shadow s;
    (void)state;
    shadow_attach(&s, sim);
    ASSERT_OK(sim, mps_step(sim, 0.01, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_READ, &lease));
    ASSERT_REFUSED(sim, mps_sim_device_set(sim, NULL), MPS_E_BUSY, "lease");
    ASSERT_OK(sim, mps_lease_end(sim, &lease));
    ASSERT_OK(sim, mps_sim_device_set(sim, NULL));
    assert_int_equal(s.blocks, 0);
    assert_null(shadow_counts(sim).name);
    mps_sim_destroy(sim);
    sim = new_sim(2, 0.1);
    shadow_attach(&s, sim);
    ASSERT_REFUSED(sim,
                   mps_sim_ranks_set(sim, &(mps_ranks_ops){.struct_size = sizeof(mps_ranks_ops)}),
                   MPS_E_STATE, "before mps_sim_device_set()");
    mps_sim_destroy(sim);
}

/* On the device, on the host and on the device again. */
static void taken_off_and_attached(void **state)
{
    mps_sim *host = rolling("mmps", 2), *sim = rolling("mmps", 2);
    shadow s;
    (void)state;
    for (int k = 0; k < 9; k++) {
        if (k % 3 == 1) shadow_attach(&s, sim);
        if (k % 3 == 0 && k > 0) ASSERT_OK(sim, mps_sim_device_set(sim, NULL));
        ASSERT_OK(host, mps_step(host, 0.01, NULL));
        ASSERT_OK(sim, mps_step(sim, 0.01, NULL));
        same(host, sim);
    }
    mps_sim_destroy(host);
    mps_sim_destroy(sim);
}

/* Checkpoints of one side go on at the other. */
static void checkpoints_change_sides(void **state)
{
    char path[PATH];
    (void)state;
    for (int k = 0; k < 2; k++) {
        mps_sim *host = rolling("imps", 2), *first = rolling("imps", 2),
                *second = rolling("imps", 2);
        shadow s;
        shadow_attach(&s, k == 0 ? first : second);
        go(host, 4);
        go(first, 4);
        ASSERT_OK(first, mps_checkpoint_write(first, path_of(path, "sides")));
        ASSERT_OK(second, mps_checkpoint_read(second, path));
        go(host, 4);
        go(second, 4);
        same(host, second);
        mps_sim_destroy(host);
        mps_sim_destroy(first);
        mps_sim_destroy(second);
    }
}

/* ---- failures ---- */

/* Until two of the steps have looked for candidates, which the device has alone for a while. */
static void failing_devices(void **state)
{
    for (int which = 0; which < 2; which++) {
        mps_sim *host = rolling("imps", 2), *sim = rolling("imps", 2);
        const mps_neighbours *l = &sim->world.lists.neighbours;
        int searched = 0;
        shadow s;
        (void)state;
        shadow_attach(&s, sim);
        go(host, 2);
        go(sim, 2);
        for (int k = 0; k < 30 && searched < 2; k++) {
            const int64_t before = l->searches;
            if (which == 0)
                fail_each(host, sim, &s.launches, &s.fails_at);
            else
                fail_each(host, sim, &s.downloads, &s.loses_at);
            searched += l->searches > before;
        }
        assert_true(searched >= 2);
        mps_sim_destroy(host);
        mps_sim_destroy(sim);
    }
}

/* A weight function of the user has no device code. */
static double weight(void *user, double r, double re)
{
    (void)user;
    return (1 - r / re) * (1 - r / re);
}

static void own_kernel_stays_on_the_host(void **state)
{
    mps_sim *sim = rolling("imps", 2);
    mps_kernel kernel;
    shadow s;
    (void)state;
    shadow_attach(&s, sim);
    assert_int_equal(mps_kernel_init(&kernel, sizeof kernel), MPS_OK);
    assert_int_equal(mps_kernel_custom(weight, NULL, &kernel), MPS_OK);
    ASSERT_OK(sim, mps_kernel_use(sim, &kernel));
    ASSERT_OK(sim, mps_step(sim, 0.01, NULL));
    assert_int_equal(s.launches, 0);
    mps_sim_destroy(sim);
}

/* Rows of more than a thousand candidates are found by the host, which has enough memory for
 * them. */
static mps_sim *wide_rows(void)
{
    mps_sim *sim = new_sim(2, 0.02);
    shadow_heap(sim);
    add_tank(sim, 1.2, 0.8, 0);
    fill_depth(sim, 1.2, 0.6, 0);
    ASSERT_OK(sim, mps_field_add(sim, "mark", 2));
    shake(sim, 0.05);
    sim->world.setup.re_far = 20 * sim->world.setup.dp;
    return sim;
}

static void long_rows_stay_on_the_host(void **state)
{
    mps_sim *host = wide_rows(), *sim = wide_rows();
    const mps_neighbours *l = &sim->world.lists.neighbours;
    shadow s;
    (void)state;
    shadow_attach(&s, sim);
    for (int k = 0; k < 20 && l->searches < 5; k++) {
        go(host, 1);
        go(sim, 1);
        assert_true(l->longest > 1024);
    }
    assert_true(l->searches >= 5);
    same(host, sim);
    mps_sim_destroy(host);
    mps_sim_destroy(sim);
}

/* Particles occluded by thin plates are removed from rows of the device; lists of the host do not
 * replace these rows. */
static void plates_hide_on_the_device(void **state)
{
    mps_sim *host = plate(), *sim = plate();
    const mps_neighbours *l = &sim->world.lists.neighbours;
    shadow s;
    (void)state;
    shadow_attach(&s, sim);
    for (int k = 0; k < 40 && l->searches < 6; k++) {
        go(host, 1);
        go(sim, 1);
        assert_true(sim->world.runner.memory.listed == l->searches);
        same(host, sim);
    }
    assert_true(l->searches >= 6 && sim->world.lists.occluders.near_plates > 0);
    mps_sim_destroy(host);
    mps_sim_destroy(sim);
}

/* ---- what a step costs ---- */

static void note(void *user, int level, const char *text)
{
    char *logged = user;
    (void)level;
    if (strstr(text, "on the host"))
        snprintf(logged + strlen(logged), 512 - strlen(logged), "%s;", text);
}

/* Launches of an iteration of conjugate gradients with auxgrid of one grid: the product, three
 * loops over vectors, three for decisions and five of the preconditioner, one of them a clear. The
 * host queues eight iterations and waits. */
enum { LAUNCHES = 12, AT_ONCE = 8 };

/* Ranges of one step without iterations: from the first to the second. */
typedef struct cost {
    const char *preset;
    int32_t dim;
    int64_t launches[2], waits[2], up[2], down[2];
} cost;

static void assert_in(const char *what, const cost *c, int64_t value, const int64_t range[2])
{
    if (value < range[0] || value > range[1])
        fail_msg("%s in %d-D: %s %lld, wanted %lld to %lld", c->preset, (int)c->dim, what,
                 (long long)value, (long long)range[0], (long long)range[1]);
}

/* Limits, with search, matrix and solution: 140 to 220 launches and 3 to 10 waits without
 * iterations, less than 2 kB, not 0, in both directions together. */
static void costs(void **state)
{
    static const cost table[] = {
        {"imps", 2, {195, 215}, {8, 10}, {0, 300}, {1000, 1999}},
        {"imps", 3, {197, 217}, {8, 10}, {0, 300}, {1000, 1999}},
        {"mmps", 2, {184, 204}, {8, 10}, {0, 300}, {1000, 1999}},
    };
    (void)state;
    for (size_t k = 0; k < sizeof table / sizeof table[0]; k++) {
        const cost *c = &table[k];
        mps_sim *sim = unwatched(c->preset, c->dim);
        char logged[512] = "";
        shadow s;
        sim->context.log = note;
        sim->context.log_user = logged;
        shadow_attach(&s, sim);
        go(sim, 5);
        const int32_t before = shadow_seen(&s, "cg.c", "redirections");
        ASSERT_OK(sim, mps_step(sim, 0.01, NULL));
        mps_device_info i = shadow_counts(sim);
        const int32_t queued = shadow_seen(&s, "cg.c", "redirections") - before;
        i.launches -= (int64_t)LAUNCHES * queued;
        i.waits -= queued / AT_ONCE;
        assert_true(queued >= AT_ONCE && queued % AT_ONCE == 0);
        print_message("%s in %d-D, %lld particles: %lld launches, %lld waits, %lld bytes up, %lld "
                      "down\n",
                      c->preset, (int)c->dim, (long long)sim->world.particles.n,
                      (long long)i.launches, (long long)i.waits, (long long)i.bytes_up,
                      (long long)i.bytes_down);
        assert_in("launches", c, i.launches, c->launches);
        assert_in("waits", c, i.waits, c->waits);
        assert_in("bytes up", c, i.bytes_up, c->up);
        assert_in("bytes down", c, i.bytes_down, c->down);
        assert_true(i.bytes_held > i.bytes_up);
        assert_string_equal(logged, ""); /* of passes on the host */
        assert_int_equal(i.host_calls, 0);
        mps_sim_destroy(sim);
    }
}

/* Once, and why. */
static void solutions_on_the_host_are_told(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        mps_sim *sim = unwatched("imps", 2);
        char logged[512] = "";
        shadow s;
        if (k == 0)
            ASSERT_OK(sim, mps_solver_use(sim, "sundials.klu", NULL));
        else
            ASSERT_OK(sim, mps_load_watch(sim, MPS_LOAD_MASS));
        sim->context.log = note;
        sim->context.log_user = logged;
        shadow_attach(&s, sim);
        go(sim, 1);
        assert_non_null(strstr(logged, "the pressure equation is solved on the host"));
        assert_non_null(strstr(logged, k == 0 ? "solver 'sundials.klu'" : "the added mass"));
        logged[0] = 0;
        go(sim, 1);
        assert_null(strstr(logged, "the pressure equation"));
        mps_sim_destroy(sim);
    }
}

/* Uploaded bytes per particle in steps with and without a search: search, order and permutation are
 * done on the device; only positions of walls are uploaded. */
static void searches_copy_little(void **state)
{
    static const double range[2][2][2] = {{{0.02, 0.1}, {3, 5}}, {{0.005, 0.02}, {3, 5}}};
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) {
        mps_sim *sim = unwatched("imps", dim);
        double up[2] = {0, 0};
        int steps[2] = {0, 0};
        shadow s;
        shadow_attach(&s, sim);
        ASSERT_OK(sim, mps_step(sim, 0.01, NULL));
        for (int k = 0; k < 16; k++) {
            const int64_t before = sim->world.lists.neighbours.searches;
            ASSERT_OK(sim, mps_step(sim, 0.01, NULL));
            const int searched = sim->world.lists.neighbours.searches > before;
            up[searched] += (double)shadow_counts(sim).bytes_up / (double)sim->world.particles.n;
            steps[searched]++;
        }
        for (int k = 0; k < 2; k++) {
            assert_true(steps[k] > 1);
            print_message("%d-D, %d searches: %g bytes up a particle\n", (int)dim, k,
                          up[k] / steps[k]);
            assert_true(up[k] / steps[k] >= range[dim - 2][k][0]);
            assert_true(up[k] / steps[k] <= range[dim - 2][k][1]);
        }
        mps_sim_destroy(sim);
    }
}

/* Bytes of a complete step without requests of fields and without solver setup on the host: only
 * sums, for any number of particles. A search downloads its order, 4 bytes per particle, and
 * uploads positions of walls, as many bytes. */
static void fields_cost_nothing(void **state)
{
    static const double most[2] = {4600, 5600};
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) {
        mps_sim *sim = unwatched("imps", dim);
        shadow s;
        ASSERT_OK(sim, mps_solver_use(sim, "sundials.pcg", "jacobi"));
        shadow_attach(&s, sim);
        go(sim, 3);
        for (int k = 0; k < 12; k++) {
            const int64_t before = sim->world.lists.neighbours.searches;
            ASSERT_OK(sim, mps_step(sim, 0.01, NULL));
            const mps_device_info i = shadow_counts(sim);
            const double moved = sim->world.lists.neighbours.searches > before
                                     ? 4 * (double)sim->world.particles.n
                                     : 0;
            print_message("%d-D, %.0f bytes of a search: %lld up, %lld down\n", (int)dim, moved,
                          (long long)i.bytes_up, (long long)i.bytes_down);
            assert_true((double)i.bytes_up <= moved + 1000);
            assert_true((double)i.bytes_down > moved + 1000);
            assert_true((double)i.bytes_down < moved + most[dim - 2]);
        }
        mps_sim_destroy(sim);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tables_are_checked),
        cmocka_unit_test(leases_refuse),
        cmocka_unit_test(taken_off_and_attached),
        cmocka_unit_test(checkpoints_change_sides),
        cmocka_unit_test(failing_devices),
        cmocka_unit_test(own_kernel_stays_on_the_host),
        cmocka_unit_test(long_rows_stay_on_the_host),
        cmocka_unit_test(plates_hide_on_the_device),
        cmocka_unit_test(costs),
        cmocka_unit_test(solutions_on_the_host_are_told),
        cmocka_unit_test(searches_copy_little),
        cmocka_unit_test(fields_cost_nothing),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* mps_run(): the end is reached exactly, in whole steps, the monitor may stop it, threads have no
 * effect. */
#include "tank_fixture.h"

static const double dp = 0.05;

static mps_sim *pool(void)
{
    mps_sim *sim = new_sim(2, dp);
    add_tank(sim, 0.5, 0.5, 0);
    fill_depth(sim, 0.5, 0.3, 0);
    return sim;
}

/* One drop without walls: a step costs nothing. */
static mps_sim *drop(void)
{
    const double x[2] = {0, 0};
    mps_sim *sim = new_sim(2, dp);
    mps_particle_block b;
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = 1;
    b.position = x;
    ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
    return sim;
}

static void set_fixed_step(mps_sim *sim, double dt)
{
    mps_time_control c;
    assert_int_equal(mps_time_control_init(&c, sizeof c), MPS_OK);
    c.dt = dt;
    ASSERT_OK(sim, mps_time_control_set(sim, &c));
}

typedef struct watch {
    int calls, stop_after;
    double t, dt, least;
} watch;

static int monitor(void *user, mps_sim *sim, const mps_step_info *info)
{
    watch *w = user;
    double t = -1;
    assert_int_equal(mps_sim_time(sim, &t, NULL), MPS_OK);
    assert_true(info->struct_size == sizeof *info && info->t == t && info->t > w->t);
    w->t = info->t;
    w->dt = info->dt;
    w->least = fmin(w->least, info->dt);
    return ++w->calls == w->stop_after;
}

static void run_to_the_end(void **state)
{
    (void)state;
    const double dts[] = {0, 1e-3, 7e-4};
    for (int k = 0; k < 3; k++) {
        watch w = {.least = INFINITY};
        mps_sim *sim = pool();
        double t = -1;
        set_fixed_step(sim, dts[k]);
        ASSERT_OK(sim, mps_run(sim, 0.02, monitor, &w));
        ASSERT_OK(sim, mps_sim_time(sim, &t, NULL));
        assert_true(t == 0.02 && w.t == 0.02); /* not nearly */
        if (k == 1)
            assert_int_equal(w.calls,
                             20);    /* a whole number of fixed steps is that number of steps */
        assert_true(w.least > 1e-4); /* no very short step at the end */
        ASSERT_OK(sim, mps_run(sim, 0.021, monitor, &w));
        assert_true(w.t == 0.021);
        mps_sim_destroy(sim);
    }
}

/* n fixed steps to n dt, for any rounding of sums. */
static void whole_steps(void **state)
{
    (void)state;
    const double dts[] = {1e-3, 7e-4, 1.0 / 3};
    for (int k = 0; k < 3; k++)
        for (int n = 1; n < 100; n += 7) {
            watch w = {.least = INFINITY};
            mps_sim *sim = drop();
            set_fixed_step(sim, dts[k]);
            ASSERT_OK(sim, mps_run(sim, n * dts[k], monitor, &w));
            if (w.calls != n)
                fail_msg("%d steps of %g s took %d, the smallest %g s", n, dts[k], w.calls,
                         w.least);
            assert_true(w.t == n * dts[k]);
            mps_sim_destroy(sim);
        }
}

/* Steps of a drop that falls get shorter and shorter: the one that would end the run falls short by
 * a thousandth. */
static void no_sliver(void **state)
{
    (void)state;
    for (int n = 110; n < 140; n += 3) {
        watch w = {.stop_after = n, .least = INFINITY};
        mps_sim *sim = drop();
        ASSERT_STATUS(sim, mps_run(sim, 10, monitor, &w), MPS_W_STOPPED);
        const double end = w.t + w.dt, dt = w.dt;
        w.least = INFINITY;
        w.stop_after = 0;
        w.calls = 0;
        ASSERT_OK(sim, mps_run(sim, end, monitor, &w));
        assert_true(w.t == end && w.calls == 2 && w.least > 0.49 * dt);
        ASSERT_STATUS(sim, (w.stop_after = 3, mps_run(sim, 10, monitor, &w)), MPS_W_STOPPED);
        assert_true(w.dt > 0.9 * dt); /* the shortened step did not limit the next one */
        mps_sim_destroy(sim);
    }
}

static void monitor_stops(void **state)
{
    (void)state;
    watch w = {.stop_after = 4, .least = INFINITY};
    mps_sim *sim = pool();
    double t = -1;
    int64_t steps = -1;
    ASSERT_STATUS(sim, mps_run(sim, 1, monitor, &w), MPS_W_STOPPED);
    ASSERT_OK(sim, mps_sim_time(sim, &t, &steps));
    assert_true(w.calls == 4 && steps == 4 && t == w.t && t < 1);
    mps_sim_destroy(sim);
}

/* What a monitor must not do is refused; reading is allowed. */
static int meddle(void *user, mps_sim *sim, const mps_step_info *info)
{
    int *calls = user;
    const double x[2] = {0.2, 0.45};
    const int64_t id = 0;
    mps_particle_block b;
    mps_lease lease = {.struct_size = sizeof lease};
    ASSERT_OK(sim, mps_particle_block_init(&b, sizeof b));
    b.count = 1;
    b.position = x;
    ++*calls;
    ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_BUSY, "monitor");
    ASSERT_REFUSED(sim, mps_run(sim, info->t + 1e-3, NULL, NULL), MPS_E_BUSY, "monitor");
    ASSERT_REFUSED(sim, mps_particles_add(sim, &b, NULL), MPS_E_BUSY, "monitor");
    ASSERT_REFUSED(sim, mps_particles_remove(sim, 1, &id), MPS_E_BUSY, "monitor");
    ASSERT_REFUSED(sim, mps_fill_box_add(sim, 0, x, x, NULL, NULL), MPS_E_BUSY, "monitor");
    ASSERT_OK(sim, mps_lease_begin(sim, "pressure", MPS_READ, &lease));
    ASSERT_OK(sim, mps_lease_end(sim, &lease));
    return *calls == 2;
}

static void monitor_meddles(void **state)
{
    (void)state;
    int calls = 0;
    int64_t steps = 0;
    mps_sim *sim = pool();
    ASSERT_STATUS(sim, mps_run(sim, 1, meddle, &calls), MPS_W_STOPPED);
    ASSERT_OK(sim, mps_sim_time(sim, NULL, &steps));
    assert_int_equal(steps, 2);
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL)); /* allowed again */
    mps_sim_destroy(sim);
}

/* A pool that is shaken, with any number of threads: the same bytes, in the same order. */
static void threads_agree(void **state)
{
    (void)state;
    const mps_harmonic h = {.dof = MPS_MOVE_X, .amplitude = 0.02, .omega = 8};
    static const char *const fields[] = {"position", "velocity", "pressure"};
    mps_sim *sim[3];
    for (int k = 0; k < 3; k++) {
        sim[k] = pool();
        ASSERT_OK(sim[k], mps_threads_set(sim[k], k + 1));
        ASSERT_OK(sim[k], mps_motion_harmonics_set(sim[k], 1, &h));
        ASSERT_OK(sim[k], mps_run(sim[k], 0.1, NULL, NULL));
    }
    for (int k = 1; k < 3; k++)
        for (int f = 0; f < 3; f++) {
            mps_lease a = {.struct_size = sizeof a}, b = {.struct_size = sizeof b};
            ASSERT_OK(sim[0], mps_lease_begin(sim[0], fields[f], MPS_READ, &a));
            ASSERT_OK(sim[k], mps_lease_begin(sim[k], fields[f], MPS_READ, &b));
            assert_int_equal(a.count, b.count);
            assert_memory_equal(a.data, b.data, (size_t)(a.count * a.stride) * sizeof(double));
            ASSERT_OK(sim[0], mps_lease_end(sim[0], &a));
            ASSERT_OK(sim[k], mps_lease_end(sim[k], &b));
        }
    for (int k = 0; k < 3; k++) mps_sim_destroy(sim[k]);
}

/* Programs add up lengths: a loop to any end terminates, and the time is bitwise the end. */
static void loops_of_hosts(void **state)
{
    static const double lengths[] = {0.01, 0.1, 1.0 / 3, 0.07};
    (void)state;
    for (int k = 0; k < 80; k++) {
        const double length = lengths[k % 4], until = k == 0   ? 2.45
                                                      : k == 4 ? 9.75
                                                      : k == 8
                                                          ? 16
                                                          : (0.05 + 0.35 * k) * (k % 4 ? 1 : 0.1);
        mps_sim *sim = drop();
        double t = 0;
        int left = 4000;
        set_fixed_step(sim, 1); /* a run is one step */
        while (t < until) {
            const double to = fmin(t + length, until);
            ASSERT_OK(sim, mps_run(sim, to, NULL, NULL));
            ASSERT_OK(sim, mps_sim_time(sim, &t, NULL));
            if (t != to) fail_msg("at %.17g s instead of %.17g s", t, to);
            if (--left == 0) fail_msg("the loop to %.17g s does not end", until);
        }
        mps_sim_destroy(sim);
    }
}

/* Within rounding of the current time, before or after it, there is no step; an earlier end is an
 * error. */
static void rounding_is_no_step(void **state)
{
    const double ends[] = {2, 2 + 1e-15, 2 - 1e-15, 2 + 1.9e-12, 2 - 1.9e-12};
    mps_sim *sim = drop();
    (void)state;
    set_fixed_step(sim, 1);
    for (int k = 0; k < 5; k++) {
        double t;
        int64_t before, after;
        ASSERT_OK(sim, mps_run(sim, 2, NULL, NULL));
        ASSERT_OK(sim, mps_sim_time(sim, NULL, &before));
        ASSERT_OK(sim, mps_run(sim, ends[k], NULL, NULL));
        ASSERT_OK(sim, mps_sim_time(sim, &t, &after));
        assert_true(t == ends[k] && after == before);
    }
    ASSERT_REFUSED(sim, mps_run(sim, 1.9, NULL, NULL), MPS_E_ARG, "t_end is 1.8999");
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(run_to_the_end),  cmocka_unit_test(whole_steps),
        cmocka_unit_test(no_sliver),       cmocka_unit_test(monitor_stops),
        cmocka_unit_test(monitor_meddles), cmocka_unit_test(threads_agree),
        cmocka_unit_test(loops_of_hosts),  cmocka_unit_test(rounding_is_no_step)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

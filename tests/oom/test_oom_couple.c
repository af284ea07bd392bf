/* SPDX-License-Identifier: BSD-3-Clause */
/* Each allocation fails once in calls of couple.h: the state is unchanged, and the call succeeds
 * when there is memory. */
#include "oom_fixture.h"

static void same_state(mps_sim *sim, const double *wanted, int64_t wanted_count)
{
    int64_t count;
    double *now = snapshot(sim, &count);
    assert_int_equal(count, wanted_count);
    assert_memory_equal(now, wanted, (size_t)count * sizeof *now);
    free(now);
}

/* A simulation with a snapshot of its past, and other particles than then. */
typedef struct pair {
    memory m;
    mps_sim *sim;
    mps_snapshot *past;
    double *was, *is;
    int64_t was_count, is_count;
} pair;

static void open_pair(pair *p, int32_t dim)
{
    int64_t gone = 7;
    *p = (pair){.sim = NULL};
    dimension = dim;
    assert_int_equal(create(&p->m, &p->sim, NULL, 0), MPS_OK);
    sampled(p->sim);
    assert_int_equal(mps_snapshot_create(p->sim, &p->past), MPS_OK);
    assert_int_equal(mps_snapshot_take(p->past), MPS_OK);
    p->was = snapshot(p->sim, &p->was_count);
    assert_int_equal(mps_particles_remove(p->sim, 1, &gone), MPS_OK);
    assert_int_equal(add_drop(p->sim, 0.6, 20), MPS_OK);
    assert_int_equal(mps_step(p->sim, 1e-3, NULL), MPS_OK);
    p->is = snapshot(p->sim, &p->is_count);
}

static void close_pair(pair *p)
{
    mps_snapshot_destroy(p->past);
    mps_sim_destroy(p->sim);
    free(p->was);
    free(p->is);
    assert_int_equal(p->m.live, 0);
}

static mps_status restore(pair *p)
{
    return mps_snapshot_restore(p->past);
}

static mps_status take(pair *p)
{
    return mps_snapshot_take(p->past);
}

static mps_status take_another(pair *p)
{
    mps_snapshot *k = NULL;
    mps_status status = mps_snapshot_create(p->sim, &k);
    if (status == MPS_OK) status = mps_snapshot_take(k);
    mps_snapshot_destroy(k);
    return status;
}

static mps_status set_pose(pair *p)
{
    mps_motion_state s;
    assert_int_equal(mps_motion_state_init(&s, sizeof s), MPS_OK);
    return mps_motion_pose_set(p->sim, 9, &s);
}

static mps_status watch(pair *p)
{
    return mps_load_watch(p->sim, MPS_LOAD_MASS);
}

static mps_status set_body(pair *p)
{
    mps_body b;
    assert_int_equal(mps_body_init(&b, sizeof b), MPS_OK);
    b.free = MPS_BODY_FREE(MPS_MOVE_X);
    b.mass = 1;
    return mps_body_set(p->sim, &b);
}

/* Fail each allocation of a call in turn. @return number of allocations */
static int fail_each(mps_status (*call)(pair *p), bool goes_back)
{
    mps_status status = MPS_E_NOMEM;
    int failed = 0;
    for (; status == MPS_E_NOMEM; failed++) {
        pair p;
        open_pair(&p, 2);
        p.m.fail_at = p.m.count + failed + 1;
        status = call(&p);
        p.m.fail_at = 0;
        if (status == MPS_E_NOMEM) {
            same_state(p.sim, p.is, p.is_count);
            assert_int_equal(call(&p), MPS_OK);
        }
        if (goes_back) same_state(p.sim, p.was, p.was_count);
        if (call != set_pose) assert_int_equal(mps_step(p.sim, 1e-3, NULL), MPS_OK);
        close_pair(&p);
    }
    assert_int_equal(status, MPS_OK);
    return failed - 1;
}

static void calls(void **state)
{
    (void)state;
    assert_true(fail_each(restore, true) >= 1);
    assert_true(fail_each(take, false) >= 1);
    assert_true(fail_each(take_another, false) >= 20);
    assert_true(fail_each(set_pose, false) >= 1);
    assert_true(fail_each(watch, false) >= 1);
    assert_true(fail_each(set_body, false) >= 1);
}

/* The first step after a call. */
static void fail_step(mps_status (*call)(pair *p))
{
    mps_status status = MPS_E_NOMEM;
    int failed = 0;
    for (; status == MPS_E_NOMEM; failed++) {
        pair p;
        open_pair(&p, 2);
        assert_int_equal(call(&p), MPS_OK);
        p.m.fail_at = p.m.count + failed + 1;
        status = mps_step(p.sim, 1e-3, NULL);
        p.m.fail_at = 0;
        if (status == MPS_E_NOMEM) {
            same_state(p.sim, p.is, p.is_count);
            assert_int_equal(mps_step(p.sim, 1e-3, NULL), MPS_OK);
        }
        close_pair(&p);
    }
    assert_int_equal(status, MPS_OK);
    assert_true(failed > 4);
}

/* The first step that computes the added mass, for an application and for a rigid body. */
static void step_with_mass(void **state)
{
    (void)state;
    fail_step(watch);
    fail_step(set_body);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(calls), cmocka_unit_test(step_with_mass)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

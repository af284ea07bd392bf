/* SPDX-License-Identifier: BSD-3-Clause */
/* Time control: refusals, limits of a step, and steps with invalid arguments. */
#include "push_fixture.h"

/* ---- time control ---------------------------------------------------------------------------- */

static mps_time_control control(void)
{
    mps_time_control c;
    assert_int_equal(mps_time_control_init(&c, sizeof c), MPS_OK);
    return c;
}

#define REFUSE(entry, value, word)                                            \
    do {                                                                      \
        mps_time_control c_ = control();                                      \
        c_.entry = (value);                                                   \
        ASSERT_REFUSED(sim, mps_time_control_set(sim, &c_), MPS_E_ARG, word); \
    } while (0)

static void bad_time_control(void **state)
{
    (void)state;
    mps_sim *sim = pool();
    mps_time_control c = control();
    REFUSE(dt, -1e-3, "dt is -0.001");
    REFUSE(dt, NAN, "dt is");
    REFUSE(dt, INFINITY, "dt is inf");
    REFUSE(cfl, NAN, "time_control.cfl is ");
    REFUSE(gravity, NAN, "time_control.gravity is ");
    REFUSE(viscous, NAN, "time_control.viscous is ");
    REFUSE(dt_max, NAN, "time_control.dt_max is ");
    REFUSE(growth, 0, "growth is 0");
    REFUSE(growth, NAN, "growth");
    REFUSE(growth, 1, "growth is 1");
    REFUSE(dt_min, NAN, "dt_min");
    REFUSE(dt_min, -1, "dt_min is -1");
    REFUSE(struct_size, 0, "struct_size");
    c.cfl = c.gravity = c.dt_max = -1;
    ASSERT_REFUSED(sim, mps_time_control_set(sim, &c), MPS_E_ARG, "off");
    c.cfl = c.gravity = c.dt_max = 0; /* as off as -1 */
    ASSERT_REFUSED(sim, mps_time_control_set(sim, &c), MPS_E_ARG, "off");
    c.dt = 1e-3; /* a fixed step needs no limit */
    ASSERT_OK(sim, mps_time_control_set(sim, &c));
    ASSERT_REFUSED(sim, mps_time_control_set(sim, NULL), MPS_E_ARG, "NULL");
    assert_int_equal(mps_time_control_set(NULL, &c), MPS_E_ARG);
    mps_sim_destroy(sim);
}

/* Take a step and check the name of its limit; NULL: any. */
static double step_taken_by(mps_sim *sim, double dt_max, const char *limit)
{
    mps_step_info info;
    assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
    ASSERT_OK(sim, mps_step(sim, dt_max, &info));
    assert_non_null(info.limit);
    if (limit) assert_string_equal(info.limit, limit);
    return info.dt;
}

static double step_taken(mps_sim *sim, double dt_max)
{
    return step_taken_by(sim, dt_max, NULL);
}

/* Each limit in turn is the smallest and determines the step. */
static void limits(void **state)
{
    (void)state;
    const double g = sqrt(9.81 * dp);
    mps_sim *sim = pool();
    use_push(sim);
    ASSERT_NEAR(step_taken_by(sim, 1, "gravity"), 0.06 * dp / g, 1e-15);
    mps_time_control c = control();
    c.dt_max = 1e-4;
    ASSERT_OK(sim, mps_time_control_set(sim, &c));
    ASSERT_NEAR(step_taken_by(sim, 1, "dt_max"), 1e-4, 1e-18);
    c.dt_max = -1;
    ASSERT_OK(sim, mps_time_control_set(sim, &c)); /* forgets the previous step, */
    test.dt_limit = 2e-4;
    ASSERT_NEAR(step_taken_by(sim, 1, "test.push"), 2e-4, 1e-18);
    test.dt_limit = INFINITY;
    ASSERT_NEAR(step_taken_by(sim, 1, "growth"), 2.2e-4,
                1e-15); /* which growth is measured against */
    ASSERT_NEAR(step_taken_by(sim, 1e-5, "caller"), 1e-5, 1e-18);
    ASSERT_NEAR(step_taken_by(sim, 1, "growth"), 1.1 * 2.2e-4,
                1e-15); /* a step cut by the caller does not count */
    c.dt = 5e-4;
    ASSERT_OK(sim, mps_time_control_set(sim, &c));
    ASSERT_NEAR(step_taken_by(sim, 1, "fixed"), 5e-4, 1e-18);
    c.dt = 0;
    c.growth = -1;
    ASSERT_OK(sim, mps_time_control_set(sim, &c));
    mps_phase honey;
    assert_int_equal(mps_phase_init(&honey, sizeof honey), MPS_OK);
    honey.viscosity = 1000;
    ASSERT_OK(sim, mps_phase_set(sim, 0, &honey));
    ASSERT_NEAR(step_taken_by(sim, 1, "viscous"), 0.2 * dp * dp, 1e-15);
    c.dt_min = 1e-2;
    ASSERT_OK(sim, mps_time_control_set(sim, &c));
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_DIVERGED, "below dt_min = 0.01");
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_DIVERGED,
                   "by the limit 'viscous': the largest kinematic viscosity is 1 m2/s");
    mps_sim_destroy(sim);
}

/* Walls jump to their speed in the first step: it is limited by this speed, and no particle is
 * lost. */
static void fast_walls(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        const bool turn = k == 2,
                   against = k ==
                             1; /* against: the liquid moves towards the walls, the speeds add up */
        const mps_harmonic shock = {.dof = turn ? MPS_ROTATE_Z : MPS_MOVE_X,
                                    .amplitude = turn ? 1 : 1000,
                                    .omega = turn ? 200 : 0.2};
        const double speed = against ? 320
                             : turn  ? 200 * 0.6 * sqrt(2)
                                     : 200,
                     allowed = 0.3 * dp / speed;
        mps_step_info info;
        mps_sim *sim = pool();
        const picture before = take_picture(sim);
        ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &shock));
        for (int64_t id = 0; against && id < before.n; id++)
            if (mps_particle_index(sim, id) >= 0) set_velocity(sim, id, -120, 0);
        assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
        ASSERT_STATUS(sim, mps_step(sim, 1, &info), MPS_OK);
        assert_true(info.dt <= 1.03 * allowed && info.dt > 0.9 * allowed);
        for (int more = 0; more < 20; more++) ASSERT_STATUS(sim, mps_step(sim, 1, &info), MPS_OK);
        assert_int_equal(info.lost, 0);
        mps_sim_destroy(sim);
    }
}

/* A very short step requested by the caller, by an argument or by the control, does not make the
 * next step fail. */
static void slivers(void **state)
{
    (void)state;
    const double g = sqrt(9.81 * dp);
    mps_sim *sim = pool();
    ASSERT_NEAR(step_taken(sim, 1e-12), 1e-12, 1e-27);
    ASSERT_NEAR(step_taken(sim, 1), 0.06 * dp / g, 1e-15);
    mps_sim_destroy(sim);
    sim = pool();
    mps_time_control c = control();
    c.dt_max = 1e-12;
    ASSERT_OK(sim, mps_time_control_set(sim, &c));
    for (int k = 0; k < 3; k++) ASSERT_NEAR(step_taken(sim, 1), 1e-12, 1e-27);
    c.dt_max = 0;
    ASSERT_OK(sim, mps_time_control_set(sim, &c));
    ASSERT_NEAR(step_taken(sim, 1), 0.06 * dp / g, 1e-15);
    mps_sim_destroy(sim);
}

static void bad_steps(void **state)
{
    (void)state;
    mps_sim *sim = pool();
    const picture before = take_picture(sim);
    const double bad[] = {0, -1, NAN, INFINITY};
    mps_step_info info = {.struct_size = 0};
    for (int k = 0; k < 4; k++)
        ASSERT_REFUSED(sim, mps_step(sim, bad[k], NULL), MPS_E_ARG, "dt_max is");
    ASSERT_REFUSED(sim, mps_step(sim, 1e-3, &info), MPS_E_ARG, "struct_size");
    ASSERT_REFUSED(sim, mps_run(sim, NAN, NULL, NULL), MPS_E_ARG, "t_end");
    ASSERT_REFUSED(sim, mps_run(sim, INFINITY, NULL, NULL), MPS_E_ARG, "t_end");
    ASSERT_REFUSED(sim, mps_run(sim, -1, NULL, NULL), MPS_E_ARG, "t_end is -1");
    assert_int_equal(mps_step(NULL, 1e-3, NULL), MPS_E_ARG);
    assert_int_equal(mps_run(NULL, 1, NULL, NULL), MPS_E_ARG);
    const picture after = take_picture(sim);
    assert_same(&before, &after);
    ASSERT_OK(sim, mps_run(sim, 0, NULL, NULL)); /* there already */
    mps_sim_destroy(sim);
    sim = new_sim(2, dp);
    ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_STATE, "no fluid");
    add_tank(sim, 0.5, 0.5, 0);
    ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_STATE, "no fluid");
    ASSERT_REFUSED(sim, mps_run(sim, 1, NULL, NULL), MPS_E_STATE, "no fluid");
    mps_sim_destroy(sim);
}

/* A step info of a size that no version had is not written, and no step is done; a newer program's
 * is filled up to what is known. */
static void other_step_info(void **state)
{
    (void)state;
    mps_sim *sim = pool();
    mps_step_info info;
    assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
    info.struct_size = offsetof(mps_step_info, cfl);
    info.cfl = -5;
    ASSERT_REFUSED(sim, mps_step(sim, 1e-3, &info), MPS_E_ARG, "mps_step_info.struct_size is 32");
    assert_true(info.struct_size == offsetof(mps_step_info, cfl) && info.dt == 0 && info.cfl == -5);
    struct {
        mps_step_info known;
        double later;
    } newer;
    assert_int_equal(mps_step_info_init(&newer.known, sizeof newer), MPS_OK);
    ASSERT_OK(sim, mps_step(sim, 1e-3, &newer.known));
    assert_true(newer.known.struct_size == sizeof newer && newer.known.step == 1 &&
                newer.known.dt == 1e-3 && newer.later == 0);
    mps_sim_destroy(sim);
}

/* The error of a step ends the run and is the run's. */
static void run_fails(void **state)
{
    (void)state;
    mps_sim *sim = pool();
    use_push(sim);
    test.fail = SHIFT;
    ASSERT_REFUSED(sim, mps_run(sim, 1, NULL, NULL), MPS_E_PLUGIN, "shift");
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_time_control), cmocka_unit_test(limits),
        cmocka_unit_test(bad_steps),        cmocka_unit_test(other_step_info),
        cmocka_unit_test(run_fails),        cmocka_unit_test(fast_walls),
        cmocka_unit_test(slivers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

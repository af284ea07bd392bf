/* SPDX-License-Identifier: BSD-3-Clause */
/* Kinematics of the tank: built-in motions, splines, rotations against finite differences,
 * refusals. */
#include "sim.h"
#include "tank_fixture.h"

static const double pi = 3.14159265358979323846;

static void harmonics_are_exact(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    const mps_harmonic h[3] = {{MPS_MOVE_X, 0, 0.02, 6.469, 0.3, 0},
                               {MPS_MOVE_X, 1, 0.005, 6.85, 7, 0},
                               {MPS_ROTATE_Z, 0, 0.1, 2, 0, 0}};
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 3, h));
    mps__pose pose;
    for (double t = 0; t < 3; t += 0.37) {
        ASSERT_OK(sim, mps__motion_pose(&sim->world.motion, t, &pose));
        ASSERT_NEAR(pose.state.value[MPS_MOVE_X],
                    0.02 * sin(6.469 * t + 0.3) - 0.005 * (1 - cos(6.85 * t)), 1e-15);
        ASSERT_NEAR(pose.state.rate[MPS_MOVE_X],
                    0.02 * 6.469 * cos(6.469 * t + 0.3) - 0.005 * 6.85 * sin(6.85 * t), 1e-14);
        ASSERT_NEAR(pose.state.accel[MPS_MOVE_X],
                    -0.02 * 6.469 * 6.469 * sin(6.469 * t + 0.3) -
                        0.005 * 6.85 * 6.85 * cos(6.85 * t),
                    1e-13);
        ASSERT_NEAR(pose.state.value[MPS_ROTATE_Z], 0.1 * sin(2 * t), 1e-16);
        ASSERT_NEAR(pose.omega[2], 0.2 * cos(2 * t), 1e-15);
        ASSERT_NEAR(pose.alpha[2], -0.4 * sin(2 * t), 1e-15);
    }
    mps_motion_state now = {.struct_size = sizeof now};
    ASSERT_OK(sim, mps_motion_state_get(sim, &now));
    ASSERT_NEAR(now.value[MPS_MOVE_X], 0.02 * sin(0.3), 1e-16);
    mps_sim_destroy(sim);
}

/* Largest errors of value, rate and acceleration of a table of sin 2 pi t with `rows` rows in [0,
 * 1]. */
static void sine_table(int64_t rows, double error[3])
{
    double t[512], y[512];
    const int32_t dof = MPS_MOVE_Y;
    mps_sim *sim = new_sim(2, 0.1);
    mps__pose pose;
    for (int64_t k = 0; k < rows; k++) {
        t[k] = (double)k / (double)(rows - 1);
        y[k] = sin(2 * pi * t[k]);
    }
    ASSERT_OK(sim, mps_motion_table_set(sim, rows, t, 1, &dof, y));
    error[0] = error[1] = error[2] = 0;
    for (int k = 0; k <= 1000; k++) {
        double s = 0.001 * k, w = 2 * pi;
        ASSERT_OK(sim, mps__motion_pose(&sim->world.motion, s, &pose));
        error[0] = fmax(error[0], fabs(pose.state.value[dof] - sin(w * s)));
        error[1] = fmax(error[1], fabs(pose.state.rate[dof] - w * cos(w * s)));
        error[2] = fmax(error[2], fabs(pose.state.accel[dof] + w * w * sin(w * s)));
    }
    /* the knots are the table's own numbers */
    for (int64_t k = 0; k < rows; k++) {
        ASSERT_OK(sim, mps__motion_pose(&sim->world.motion, t[k], &pose));
        ASSERT_NEAR(pose.state.value[dof], y[k], 0);
    }
    mps_sim_destroy(sim);
}

/* sin 2 pi t has no curvature at 0 and 1, as the natural spline: orders 4, 3 and 2. */
static void spline_converges(void **state)
{
    (void)state;
    double coarse[3], fine[3];
    sine_table(21, coarse);
    sine_table(41, fine);
    for (int k = 0; k < 3; k++) assert_true(coarse[k] / fine[k] > 0.9 * pow(2, 4 - k));
    assert_true(fine[0] < 1e-5 && fine[1] < 2e-3 && fine[2] < 0.2);
}

/* Rates are the derivative of what is interpolated, and all of it is continuous, on a rough uneven
 * table. */
static void spline_is_c2(void **state)
{
    (void)state;
    const double t[6] = {-0.5, 0, 0.3, 0.4, 1.2, 2},
                 y[12] = {0, 3, 1, 3, -2, 2, 0.5, 2, 0.7, 2, 0, 1};
    const int32_t dof[2] = {MPS_ROTATE_Z, MPS_MOVE_X};
    mps_sim *sim = new_sim(2, 0.1);
    ASSERT_OK(sim, mps_motion_table_set(sim, 6, t, 2, dof, y));
    mps__motion *m = &sim->world.motion;
    mps__pose a, b, here;
    const double e = 1e-5;
    for (double s = 0.013; s < 1.95; s += 0.0499) {
        ASSERT_OK(sim, mps__motion_pose(m, s - e, &a));
        ASSERT_OK(sim, mps__motion_pose(m, s + e, &b));
        ASSERT_OK(sim, mps__motion_pose(m, s, &here));
        for (int k = 0; k < 2; k++) {
            ASSERT_NEAR((b.state.value[dof[k]] - a.state.value[dof[k]]) / (2 * e),
                        here.state.rate[dof[k]], 1e-5);
            ASSERT_NEAR((b.state.rate[dof[k]] - a.state.rate[dof[k]]) / (2 * e),
                        here.state.accel[dof[k]], 2e-2);
        }
    }
    for (int k = 1; k < 5; k++) {
        if (t[k] <= 0) continue;
        ASSERT_OK(sim, mps__motion_pose(m, t[k] - 1e-12, &a));
        ASSERT_OK(sim, mps__motion_pose(m, t[k] + 1e-12, &b));
        ASSERT_NEAR(a.state.accel[MPS_ROTATE_Z], b.state.accel[MPS_ROTATE_Z], 1e-7);
    }
    mps_sim_destroy(sim);
}

static int tumble(void *user, double t, mps_motion_state *s)
{
    static const double amplitude[6] = {0.1, 0.2, 0.3, 0.7, 0.5, 0.9},
                        omega[6] = {1, 1.3, 0.7, 1.7, 0.9, 1.1};
    for (int k = 0; k < 6; k++) {
        if (*(int *)user == 2 && (k == MPS_MOVE_Z || k == MPS_ROTATE_X || k == MPS_ROTATE_Y))
            continue;
        s->value[k] = amplitude[k] * sin(omega[k] * t + k);
        s->rate[k] = amplitude[k] * omega[k] * cos(omega[k] * t + k);
        s->accel[k] = -amplitude[k] * omega[k] * omega[k] * sin(omega[k] * t + k);
    }
    return 0;
}

/* Velocity and acceleration of a point are the derivatives of its path; the map is rigid and can be
 * undone. */
static void point_follows_its_path(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        mps_sim *sim = new_sim(dim, 0.1);
        const double centre[3] = {0.3, -0.2, 0.5}, X[3] = {1.1, 0.4, -0.6}, e = 1e-4;
        ASSERT_OK(sim, mps_motion_centre_set(sim, centre, MPS_START_AT_REST));
        ASSERT_OK(sim, mps_motion_callback_set(sim, tumble, &dim));
        const mps__motion *m = &sim->world.motion;
        for (double t = 0; t < 4; t += 0.31) {
            double x[5][3], v[3], a[3], back[3];
            mps__pose pose;
            for (int k = 0; k < 5; k++) {
                ASSERT_OK(sim, mps__motion_pose(&sim->world.motion, t + (k - 2) * e, &pose));
                mps__motion_point(m, &pose, X, x[k], NULL, NULL);
            }
            ASSERT_OK(sim, mps__motion_pose(&sim->world.motion, t, &pose));
            mps__motion_point(m, &pose, X, NULL, v, a);
            mps__motion_to_tank(m, &pose, x[2], back);
            for (int d = 0; d < dim; d++) {
                /* fourth order: only rounding is left */
                ASSERT_NEAR(v[d], (8 * (x[3][d] - x[1][d]) - (x[4][d] - x[0][d])) / (12 * e), 1e-9);
                ASSERT_NEAR(a[d],
                            (16 * (x[3][d] + x[1][d]) - (x[4][d] + x[0][d]) - 30 * x[2][d]) /
                                (12 * e * e),
                            1e-6);
                ASSERT_NEAR(back[d], X[d], 1e-14);
            }
        }
        mps_sim_destroy(sim);
    }
}

/* R = Ry Rz Rx, each right-handed. */
static int turned(void *user, double t, mps_motion_state *s)
{
    (void)t;
    const double *angle = user;
    for (int k = 0; k < 3; k++) s->value[MPS_ROTATE_X + k] = angle[k];
    return 0;
}

static void order_of_rotations(void **state)
{
    (void)state;
    static const double quarter = 1.57079632679489662;
    const struct {
        double angle[3], from[3], to[3];
    } list[] = {{{quarter, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                {{0, quarter, 0}, {0, 0, 1}, {1, 0, 0}},
                {{0, 0, quarter}, {1, 0, 0}, {0, 1, 0}},
                {{quarter, quarter, 0}, {0, 1, 0}, {1, 0, 0}},
                {{quarter, 0, quarter}, {0, 0, 1}, {1, 0, 0}},
                {{0, quarter, quarter}, {1, 0, 0}, {0, 1, 0}},
                {{0, quarter, quarter}, {0, 0, 1}, {1, 0, 0}}};
    for (size_t k = 0; k < sizeof list / sizeof list[0]; k++) {
        mps_sim *sim = new_sim(3, 0.1);
        double x[3], angle[3];
        memcpy(angle, list[k].angle, sizeof angle);
        ASSERT_OK(sim, mps_motion_callback_set(sim, turned, angle));
        ASSERT_OK(sim, mps_motion_to_lab(sim, list[k].from, x, NULL));
        for (int d = 0; d < 3; d++) ASSERT_NEAR(x[d], list[k].to[d], 1e-15);
        mps_sim_destroy(sim);
    }
}

/* A motion that does not begin at zero takes the tank and what is in it along. */
static void contents_are_carried(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    add_tank(sim, 1, 1, 0);
    fill_depth(sim, 1, 0.5, 0);
    const mps__particles *s = &sim->world.particles;
    double before[2 * 400];
    memcpy(before, s->x, (size_t)s->n * 2 * sizeof(double));
    const mps_harmonic h[2] = {{MPS_MOVE_X, 0, 0.2, 1, pi / 2, 0},
                               {MPS_ROTATE_Z, 0, 0.1, 1, pi / 2, 0}};
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 2, h));
    for (int64_t i = 0; i < s->n; i++) {
        double x[2];
        ASSERT_OK(sim, mps_motion_to_lab(sim, &before[2 * i], x, NULL));
        ASSERT_NEAR(s->x[2 * i], x[0], 1e-15);
        ASSERT_NEAR(s->x[2 * i + 1], x[1], 1e-15);
    }
    /* clear: the pose remains, the velocity becomes 0 */
    memcpy(before, s->x, (size_t)s->n * 2 * sizeof(double));
    ASSERT_OK(sim, mps_motion_clear(sim));
    assert_memory_equal(before, s->x, (size_t)s->n * 2 * sizeof(double));
    mps_motion_state now = {.struct_size = sizeof now};
    ASSERT_OK(sim, mps_motion_state_get(sim, &now));
    ASSERT_NEAR(now.value[MPS_MOVE_X], 0.2, 1e-15);
    ASSERT_NEAR(now.rate[MPS_MOVE_X], 0, 0);
    ASSERT_NEAR(now.accel[MPS_MOVE_X], 0, 0);
    mps__pose later;
    ASSERT_OK(sim, mps__motion_pose(&sim->world.motion, 100, &later));
    ASSERT_NEAR(later.state.value[MPS_ROTATE_Z], 0.1, 1e-15);
    mps_sim_destroy(sim);
}

static void start_with_tank(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    const mps_harmonic h = {MPS_MOVE_X, 0, 0.2, 3, 0, 0};
    const double centre[2] = {0, 0};
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &h));
    assert_int_equal(sim->world.state.start_pending, 0);
    ASSERT_OK(sim, mps_motion_centre_set(sim, centre, MPS_START_WITH_TANK));
    assert_int_equal(sim->world.state.start_pending, 1);
    ASSERT_OK(sim, mps_motion_clear(sim));
    assert_int_equal(sim->world.state.start_pending, 0);
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &h));
    assert_int_equal(sim->world.state.start_pending, 1);
    double x[2], v[2];
    ASSERT_OK(sim, mps_motion_to_lab(sim, centre, x, v));
    ASSERT_NEAR(v[0], 0.6, 1e-15);
    mps_sim_destroy(sim);
}

static void beyond_the_table(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    const double t[3] = {0, 1, 2.5}, y[3] = {0, 0.1, 0.3};
    const int32_t dof = MPS_MOVE_X;
    mps__pose pose;
    ASSERT_OK(sim, mps_motion_table_set(sim, 3, t, 1, &dof, y));
    ASSERT_OK(sim, mps__motion_pose(&sim->world.motion, 2.5 + 5e-10, &pose));
    ASSERT_NEAR(pose.state.value[dof], 0.3, 0);
    ASSERT_REFUSED(sim, mps__motion_pose(&sim->world.motion, 2.501, &pose), MPS_E_STATE, "2.501");
    ASSERT_REFUSED(sim, mps__motion_pose(&sim->world.motion, 2.501, &pose), MPS_E_STATE,
                   "last row of its table is at 2.5 s");
    mps_sim_destroy(sim);
}

/* A motion at other times is that of the steps; it is unknown for a tank at rest or with a rigid
 * body. */
static void at_other_times(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    const double t[3] = {-1, 1, 2.5}, y[3] = {-0.1, 0.1, 0.3};
    const int32_t dof = MPS_MOVE_X;
    mps_motion_state s = {.struct_size = sizeof s};
    mps__pose pose;
    mps_body body;
    ASSERT_OK(sim, mps_motion_state_at(sim, 7, &s));
    for (int k = 0; k < 6; k++) assert_true(s.value[k] == 0 && s.rate[k] == 0 && s.accel[k] == 0);
    ASSERT_OK(sim, mps_motion_table_set(sim, 3, t, 1, &dof, y));
    for (double at = -1; at <= 2.5; at += 0.25) {
        ASSERT_OK(sim, mps__motion_pose(&sim->world.motion, at, &pose));
        ASSERT_OK(sim, mps_motion_state_at(sim, at, &s));
        assert_memory_equal(&s, &pose.state, sizeof s);
    }
    const mps_motion_state before = s;
    ASSERT_REFUSED(sim, mps_motion_state_at(sim, 2.501, &s), MPS_E_STATE, "last row of its table");
    ASSERT_REFUSED(sim, mps_motion_state_at(sim, NAN, &s), MPS_E_ARG, "t is nan s");
    ASSERT_REFUSED(sim, mps_motion_state_at(sim, 0, NULL), MPS_E_ARG, "NULL");
    assert_int_equal(mps_motion_state_at(NULL, 0, &s), MPS_E_ARG);
    assert_int_equal(mps_body_init(&body, sizeof body), MPS_OK);
    body.free = MPS_BODY_FREE(MPS_MOVE_X);
    body.mass = 1;
    ASSERT_OK(sim, mps_body_set(sim, &body));
    ASSERT_REFUSED(sim, mps_motion_state_at(sim, 0, &s), MPS_E_STATE, "a body carries the tank");
    assert_memory_equal(&s, &before, sizeof s);
    mps_sim_destroy(sim);
}

static void table_refusals(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    double t[4] = {0, 1, 2, 3}, y[8] = {0};
    int32_t dof[2] = {MPS_MOVE_X, MPS_ROTATE_Z};
#define REFUSE(word, rows, dofs) \
    ASSERT_REFUSED(sim, mps_motion_table_set(sim, rows, t, dofs, dof, y), MPS_E_ARG, word)
    REFUSE("1 rows", 1, 2);
    REFUSE("0 columns", 4, 0);
    REFUSE("7 columns", 4, 7);
    t[2] = 1;
    REFUSE("row 2", 4, 2);
    t[2] = NAN;
    REFUSE("nan in row 2", 4, 2);
    t[2] = 2;
    y[5] = INFINITY;
    REFUSE("row 2, column 1", 4, 2);
    y[5] = 0;
    dof[1] = MPS_MOVE_X;
    REFUSE("columns 0 and 1", 4, 2);
    dof[1] = MPS_ROTATE_Y;
    REFUSE("needs 3-D", 4, 2);
    dof[1] = 6;
    REFUSE("0..5", 4, 2);
    dof[1] = MPS_ROTATE_Z;
    t[0] = 0.5;
    REFUSE("after the present time", 4, 2);
    t[0] = 0;
#undef REFUSE
    ASSERT_REFUSED(sim, mps_motion_table_set(sim, 4, t, 2, dof, NULL), MPS_E_ARG, "values is NULL");
    t[0] = -2, t[1] = -1.5, t[2] = -1, t[3] = -0.5;
    ASSERT_REFUSED(sim, mps_motion_table_set(sim, 4, t, 2, dof, y), MPS_E_STATE,
                   "not defined at t = 0");
    assert_null(sim->world.motion.fn);
    mps_sim_destroy(sim);
}

static void harmonic_refusals(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    const mps_harmonic good = {MPS_MOVE_X, 0, 0.1, 1, 0, 0};
    mps_harmonic h;
#define REFUSE(change, word) \
    h = good;                \
    change;                  \
    ASSERT_REFUSED(sim, mps_motion_harmonics_set(sim, 1, &h), MPS_E_ARG, word)
    REFUSE(h.dof = MPS_MOVE_Z, "needs 3-D");
    REFUSE(h.dof = MPS_ROTATE_Y, "needs 3-D");
    REFUSE(h.dof = -1, "-1");
    REFUSE(h.form = 2, "form is 2");
    REFUSE(h.amplitude = NAN, "amplitude is nan");
    REFUSE(h.omega = -1, "omega is -1");
    REFUSE(h.phase = INFINITY, "phase is inf");
#undef REFUSE
    ASSERT_REFUSED(sim, mps_motion_harmonics_set(sim, 0, &good), MPS_E_ARG, "count is 0");
    ASSERT_REFUSED(sim, mps_motion_harmonics_set(sim, 1, NULL), MPS_E_ARG, "NULL");
    mps_sim_destroy(sim);
}

/* Overflow of positions: the tank keeps its motion, and the particles their positions. */
static void far_away(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    const double centre[2] = {1.01e8, 0}, t[3] = {0, 1, 2}, x[3] = {0, 1e300, 0};
    const int32_t dof = MPS_MOVE_X;
    mps_harmonic h = {MPS_MOVE_X, 0, 1.7e308, 1, pi / 2, 0};
    mps_tank tank;
    assert_int_equal(mps_tank_init(&tank, sizeof tank), MPS_OK);
    tank.size[0] = tank.size[1] = 0.5;
    ASSERT_OK(sim, mps_tank_add(sim, &tank, NULL));
    ASSERT_REFUSED(sim, mps_motion_centre_set(sim, centre, MPS_START_AT_REST), MPS_E_ARG,
                   "must be within 1e+08 m");
    const double before = sim->world.particles.x[0];
    ASSERT_REFUSED(sim, mps_motion_harmonics_set(sim, 1, &h), MPS_E_ARG, "must be within 1e+08 m");
    h.amplitude = 1.01e8;
    ASSERT_REFUSED(sim, mps_motion_harmonics_set(sim, 1, &h), MPS_E_ARG, "carries the tank to");
    assert_true(sim->world.particles.x[0] == before && !sim->world.motion.fn);
    mps_time_control fixed;
    assert_int_equal(mps_time_control_init(&fixed, sizeof fixed), MPS_OK);
    fixed.dt = 1e-3;
    fill_depth(sim, 0.5, 0.3, 0);
    ASSERT_OK(sim, mps_time_control_set(sim, &fixed));
    ASSERT_OK(sim, mps_motion_table_set(sim, 3, t, 1, &dof, x));
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_DIVERGED, "carries the tank to");
    assert_true(sim->world.particles.x[0] == before);
    mps_sim_destroy(sim);
}

static int broken(void *user, double t, mps_motion_state *s)
{
    (void)t;
    const int how = *(int *)user;
    if (how == 1) s->rate[MPS_MOVE_X] = NAN;
    if (how == 2) s->value[MPS_MOVE_Z] = 0.1;
    return how == 3 ? 7 : 0;
}

static void callback_refusals(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    int how = 1;
    ASSERT_REFUSED(sim, mps_motion_callback_set(sim, broken, &how), MPS_E_PLUGIN,
                   "the rate of 'MPS_MOVE_X' is nan");
    how = 2;
    ASSERT_REFUSED(sim, mps_motion_callback_set(sim, broken, &how), MPS_E_ARG,
                   "the value of 'MPS_MOVE_Z' is 0.1");
    how = 3;
    ASSERT_REFUSED(sim, mps_motion_callback_set(sim, broken, &how), MPS_E_PLUGIN, "failed with 7");
    assert_null(sim->world.motion.fn);
    ASSERT_REFUSED(sim, mps_motion_callback_set(sim, NULL, NULL), MPS_E_ARG, "mps_motion_clear");
    mps_sim_destroy(sim);
}

static void other_refusals(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    const double nan[2] = {0, NAN}, zero[2] = {0, 0};
    double x[2];
    mps_lease lease = {.struct_size = sizeof lease};
    ASSERT_REFUSED(sim, mps_motion_centre_set(sim, nan, 0), MPS_E_ARG, "centre[1]");
    ASSERT_REFUSED(sim, mps_motion_centre_set(sim, NULL, 0), MPS_E_ARG, "NULL");
    ASSERT_REFUSED(sim, mps_motion_centre_set(sim, zero, 2), MPS_E_ARG, "start is 2");
    ASSERT_REFUSED(sim, mps_motion_to_lab(sim, nan, x, NULL), MPS_E_ARG, "finite");
    ASSERT_REFUSED(sim, mps_motion_to_lab(sim, zero, NULL, NULL), MPS_E_ARG, "lab");
    ASSERT_REFUSED(sim, mps_motion_state_get(sim, NULL), MPS_E_ARG, "NULL");
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &lease));
    ASSERT_REFUSED(sim, mps_motion_clear(sim), MPS_E_BUSY, "leases");
    ASSERT_OK(sim, mps_lease_end(sim, &lease));
    sim->world.state.step = 3;
    ASSERT_REFUSED(sim, mps_motion_centre_set(sim, zero, 0), MPS_E_STATE, "before the first step");
    mps_sim_destroy(sim);
}

/* In 2-D the tank rotates counterclockwise about its centre; there is no other rotation. */
static void turns_the_plane(void **state)
{
    (void)state;
    const double corner[2] = {1, 0}, centre[2] = {0.25, 0.5};
    const double a = 0.3 * sin(0.7), rate = 0.6 * cos(0.7);
    const mps_harmonic turn = {MPS_ROTATE_Z, 0, 0.3, 2, 0.7, 0};
    double at[2], speed[2];
    mps_sim *sim = new_sim(2, 0.1);
    ASSERT_OK(sim, mps_motion_centre_set(sim, centre, MPS_START_AT_REST));
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &turn));
    ASSERT_OK(sim, mps_motion_to_lab(sim, corner, at, speed));
    ASSERT_NEAR(at[0], 0.25 + 0.75 * cos(a) + 0.5 * sin(a), 1e-14);
    ASSERT_NEAR(at[1], 0.5 + 0.75 * sin(a) - 0.5 * cos(a), 1e-14);
    ASSERT_NEAR(speed[0], -rate * (at[1] - 0.5), 1e-14);
    ASSERT_NEAR(speed[1], rate * (at[0] - 0.25), 1e-14);
    for (int32_t dof = MPS_ROTATE_X; dof <= MPS_ROTATE_Y; dof++)
        ASSERT_REFUSED(
            sim, mps_motion_harmonics_set(sim, 1, &(mps_harmonic){dof, 0, 0.1, 1, 0, 0}), MPS_E_ARG,
            dof == MPS_ROTATE_X ? "'MPS_ROTATE_X' (3) needs 3-D" : "'MPS_ROTATE_Y' (4) needs 3-D");
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(turns_the_plane),
        cmocka_unit_test(harmonics_are_exact),
        cmocka_unit_test(spline_converges),
        cmocka_unit_test(spline_is_c2),
        cmocka_unit_test(point_follows_its_path),
        cmocka_unit_test(order_of_rotations),
        cmocka_unit_test(contents_are_carried),
        cmocka_unit_test(start_with_tank),
        cmocka_unit_test(beyond_the_table),
        cmocka_unit_test(table_refusals),
        cmocka_unit_test(at_other_times),
        cmocka_unit_test(harmonic_refusals),
        cmocka_unit_test(far_away),
        cmocka_unit_test(callback_refusals),
        cmocka_unit_test(other_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

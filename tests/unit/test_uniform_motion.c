/* SPDX-License-Identifier: BSD-3-Clause */
/* Nothing depends on a uniform motion: a tank at 100 m/s that also oscillates has the steps,
 * pressures, averages and records of one that only oscillates. Liquid that rotates with its tank
 * does not shorten steps either. */
#include "tank_fixture.h"

enum { PROBES = 4 };

/* Swings in surge, on top of a uniform motion. */
typedef struct motion {
    double speed[3], swing, omega, spin;
} motion;

static int move(void *user, double t, mps_motion_state *s)
{
    const motion *m = user;
    const double a = m->swing, w = m->omega;
    for (int d = 0; d < 3; d++) {
        s->value[d] = m->speed[d] * t;
        s->rate[d] = m->speed[d];
    }
    s->value[0] += a * sin(w * t);
    s->rate[0] += a * w * cos(w * t);
    s->accel[0] -= a * w * w * sin(w * t);
    s->value[MPS_ROTATE_Z] = m->spin * t;
    s->rate[MPS_ROTATE_Z] = m->spin;
    return 0;
}

/* Solutions to rounding: with a residual near the default tolerance the number of iterations may
 * differ. */
static void solve_well(mps_sim *sim)
{
    mps_solver_limits l;
    assert_int_equal(mps_solver_limits_init(&l, sizeof l), MPS_OK);
    l.tolerance = 1e-11;
    ASSERT_OK(sim, mps_solver_limits_set(sim, &l));
}

static mps_sim *build(const char *preset, int32_t dim, motion *m)
{
    static const int32_t type[PROBES] = {MPS_PROBE_WALL_PRESSURE, MPS_PROBE_FORCE, MPS_PROBE_GAUGE,
                                         MPS_PROBE_FLUID_PRESSURE};
    const double dp = dim == 2 ? 0.025 : 0.05, lo[3] = {0, 0, 0}, hi[3] = {0.5, 0.4, 0.2};
    mps_sim *sim = new_sim(dim, dp);
    ASSERT_OK(sim, mps_preset_use(sim, preset));
    add_tank(sim, 0.5, 0.4, 0.2);
    fill_depth(sim, 0.5, 0.2, 0.2);
    if (strcmp(preset, "mmps") == 0) fill_air(sim, lo, hi);
    solve_well(sim);
    ASSERT_OK(sim, mps_motion_centre_set(sim, hi, MPS_START_WITH_TANK));
    ASSERT_OK(sim, mps_motion_callback_set(sim, move, m));
    for (int k = 0; k < PROBES; k++) {
        mps_probe p;
        int32_t id;
        assert_int_equal(mps_probe_init(&p, sizeof p), MPS_OK);
        p.type = type[k];
        p.rate = 500;
        p.at[0] = p.type == MPS_PROBE_WALL_PRESSURE ? 0 : 0.2;
        p.at[1] = p.type == MPS_PROBE_GAUGE ? 0 : 0.1;
        p.at[2] = dim == 3 ? 0.1 : 0;
        ASSERT_OK(sim, mps_probe_add(sim, &p, &id));
    }
    return sim;
}

/* The largest difference over the largest pressure of all particles. */
static double pressures_differ(mps_sim *a, mps_sim *b)
{
    mps_lease p = {.struct_size = sizeof p}, q = {.struct_size = sizeof q};
    const int64_t *ids;
    double difference = 0, most = 0;
    ASSERT_OK(a, tags_peek(a, &ids, NULL, NULL, NULL));
    ASSERT_OK(a, mps_lease_begin(a, "pressure", MPS_READ, &p));
    ASSERT_OK(b, mps_lease_begin(b, "pressure", MPS_READ, &q));
    for (int64_t i = 0; i < p.count; i++) {
        most = fmax(most, fabs(p.data[i]));
        difference = fmax(difference, fabs(p.data[i] - q.data[mps_particle_index(b, ids[i])]));
    }
    ASSERT_OK(a, mps_lease_end(a, &p));
    ASSERT_OK(b, mps_lease_end(b, &q));
    return difference / most;
}

static void same_records(mps_sim *a, mps_sim *b)
{
    for (int32_t id = 0; id < PROBES; id++) {
        const int64_t size = mps_probe_size(a, id);
        int64_t count[2];
        const double *t[2], *v[2];
        double most = 0, difference = 0;
        ASSERT_OK(a, mps_probe_series(a, id, &count[0], &t[0], &v[0]));
        ASSERT_OK(b, mps_probe_series(b, id, &count[1], &t[1], &v[1]));
        assert_true(count[0] == count[1] && count[0] > 20);
        for (int64_t k = 0; k < count[0] * size; k++) {
            most = fmax(most, fabs(v[0][k]));
            difference = fmax(difference, fabs(v[0][k] - v[1][k]));
        }
        if (!(difference <= 1e-9 * most)) fail_msg("probe %d: %g of %g", id, difference, most);
    }
}

static void compare(const char *preset, int32_t dim, double swing, int steps)
{
    motion plain = {{0, 0, 0}, swing, 8, 0}, fast = {{dim == 2 ? 100 : 60, 0, 80}, swing, 8, 0};
    if (dim == 2) fast.speed[2] = 0;
    mps_sim *a = build(preset, dim, &plain), *b = build(preset, dim, &fast);
    mps_step_info x, y;
    mps_step_info_init(&x, sizeof x);
    mps_step_info_init(&y, sizeof y);
    for (int k = 0; k < steps; k++) {
        ASSERT_OK(a, mps_step(a, 1, &x));
        ASSERT_OK(b, mps_step(b, 1, &y));
        assert_string_equal(x.limit, y.limit);
        ASSERT_NEAR(y.dt, x.dt, 1e-9 * x.dt);
        ASSERT_NEAR(y.max_speed, x.max_speed, 1e-9);
        ASSERT_NEAR(y.crossing_time, x.crossing_time, 1e-9 * x.dt);
        const double difference = pressures_differ(a, b);
        if (!(difference < 1e-9)) fail_msg("%s, %d-D, step %d: %g", preset, dim, k, difference);
    }
    assert_int_equal(x.ppe_solves, y.ppe_solves);
    assert_true(x.lost == y.lost && x.surface == y.surface && x.max_speed < 2);
    same_records(a, b);
    mps_sim_destroy(a);
    mps_sim_destroy(b);
}

static void at_a_speed(void **state)
{
    (void)state;
    compare("imps", 2, 0, 20);
    compare("imps", 2, 0.02, 50);
    compare("mmps", 2, 0.02, 30);
    compare("imps", 3, 0.02, 30);
    compare("mmps", 3, 0.02, 20);
}

/* A drum without gravity that rotates with its liquid: only the curvature of the paths of the walls
 * limits the steps. */
static void in_a_drum(void **state)
{
    const double middle[3] = {0.25, 0.25, 0.1};
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) {
        motion m = {.spin = 10};
        mps_config c;
        mps_step_info info;
        mps_sim *sim = NULL;
        assert_int_equal(mps_config_init(&c, sizeof c), MPS_OK);
        assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
        c.dim = dim;
        c.dp = 0.05;
        c.gravity[1] = 0;
        c.speed_limit = 2; /* the corners move at 3.5 m/s */
        assert_int_equal(mps_sim_create(&c, &sim), MPS_OK);
        add_tank(sim, 0.5, 0.5, 0.2);
        fill_depth(sim, 0.5, 0.5, 0.2);
        ASSERT_OK(sim, mps_motion_centre_set(sim, middle, MPS_START_WITH_TANK));
        ASSERT_OK(sim, mps_motion_callback_set(sim, move, &m));
        for (int k = 0; k < 20; k++) {
            ASSERT_OK(sim, mps_step(sim, 1, &info));
            assert_string_not_equal(info.limit, "cfl");
            assert_true(info.max_speed < 0.5);
        }
        mps_sim_destroy(sim);
    }
}

/* Liquid at rest in the lab when the tank sets off is fast in the tank. */
static void left_behind(void **state)
{
    motion m = {.speed = {20, 0, 0}};
    mps_step_info info;
    (void)state;
    mps_sim *sim = build("imps", 2, &m);
    assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
    ASSERT_OK(sim, mps_motion_centre_set(sim, m.speed, MPS_START_AT_REST));
    ASSERT_OK(sim, mps_step(sim, 1, &info));
    ASSERT_NEAR(info.dt, 0.3 * 0.025 / 20, 1e-9);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(at_a_speed), cmocka_unit_test(in_a_drum),
                                       cmocka_unit_test(left_behind)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

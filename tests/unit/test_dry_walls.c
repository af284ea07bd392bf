/* SPDX-License-Identifier: BSD-3-Clause */
/* Walls above the contact line have pressure 0, for any pressure that the equation extrapolates to
 * them; suction in liquid is kept. */
#include "sim.h"
#include "tank_fixture.h"
#include <mps/model.h>

/* after cmocka.h */
#include "../turns.h"

static const double GRAVITY = 9.81, RHO = 1000, PI = 3.14159265358979;

/* Of the walls of a tank at rest, over rho g dp. */
typedef struct walls {
    double off;         /* largest deviation from the static pressure below the level */
    double least, most; /* what walls above it show */
    double equation;    /* the least pressure of the equation at them */
} walls;

static walls compare(const mps_sim *sim, double level)
{
    const mps__particles *s = &sim->world.particles;
    const double unit = RHO * GRAVITY * sim->world.setup.dp;
    walls w = {0, INFINITY, -INFINITY, INFINITY};
    for (int64_t i = 0; i < s->n; i++) {
        const double height = (s->ref[i * s->dim + 1] - level) / sim->world.setup.dp;
        if (s->kind[i] != MPS_WALL) continue;
        if (height < 1e-6) {
            w.off = fmax(w.off, fabs(s->load[i] / unit + height));
            continue;
        }
        w.least = fmin(w.least, s->load[i] / unit);
        w.most = fmax(w.most, s->load[i] / unit);
        w.equation = fmin(w.equation, s->p[i] / unit);
    }
    return w;
}

static int32_t add_sensor(mps_sim *sim, double x, double y, double nx, double ny)
{
    mps_probe p;
    int32_t id = -1;
    assert_int_equal(mps_probe_init(&p, sizeof p), MPS_OK);
    p.at[0] = x;
    p.at[1] = y;
    p.normal[0] = nx;
    p.normal[1] = ny;
    p.average = 0;
    ASSERT_OK(sim, mps_probe_add(sim, &p, &id));
    return id;
}

static double read_sensor(mps_sim *sim, int32_t id)
{
    double p = NAN;
    ASSERT_OK(sim, mps_probe_read(sim, id, &p));
    return p;
}

static double force_x(mps_sim *sim, const char *part)
{
    mps_probe p;
    int32_t id = -1;
    double f[6];
    assert_int_equal(mps_probe_init(&p, sizeof p), MPS_OK);
    p.type = MPS_PROBE_FORCE;
    p.part = part;
    p.average = 0;
    ASSERT_OK(sim, mps_probe_add(sim, &p, &id));
    ASSERT_OK(sim, mps_probe_read(sim, id, f));
    return f[0];
}

/* ---- at rest ---- */

/* The force on an end wall is that of the water below the level; the sensor at the level covers
 * dp/2 of it. */
static void still_tank(void **state)
{
    (void)state;
    const double dp = 0.05, depth = 0.3, width = 0.3, unit = RHO * GRAVITY * dp;
    for (int32_t dim = 2; dim <= 3; dim++) {
        mps_sim *sim = new_sim(dim, dp);
        add_tank(sim, 0.6, 0.5, width);
        fill_depth(sim, 0.6, depth, width);
        mps_probe p;
        int32_t at_level = -1;
        assert_int_equal(mps_probe_init(&p, sizeof p), MPS_OK);
        p.at[1] = depth;
        p.at[2] = dim == 3 ? 0.15 : 0;
        p.average = 0;
        ASSERT_OK(sim, mps_probe_add(sim, &p, &at_level));
        ASSERT_OK(sim, mps_run(sim, 0.05, NULL, NULL));
        const walls w = compare(sim, depth);
        const double half = 0.5 * RHO * GRAVITY * depth * depth * (dim == 3 ? width : 1),
                     sensor = read_sensor(sim, at_level) / unit;
        print_message("%d-D: off by %.2g below, %.2g to %.2g above (equation %.3g), sensor %.4f\n",
                      dim, w.off, w.least, w.most, w.equation, sensor);
        assert_true(w.off < 0.02);
        assert_true(w.least > -1e-3 && w.most < 1e-3);
        assert_true(w.equation < -0.9); /* so there are pressures to suppress */
        ASSERT_NEAR(force_x(sim, "tank.x0"), -half, 1e-3 * half);
        ASSERT_NEAR(force_x(sim, "tank.x1"), half, 1e-3 * half);
        if (dim == 2) ASSERT_NEAR(sensor, 0.125, 0.01);
        mps_sim_destroy(sim);
    }
}

/* Each side of a plate has its own fill level. */
static void sides_of_a_plate(void **state)
{
    (void)state;
    const double dp = 0.05, unit = RHO * GRAVITY * dp;
    mps_sim *sim = new_sim(2, dp);
    const double lo[2] = {0, 0}, hi[2] = {0.5, 0.4}, lo2[2] = {0.5, 0}, hi2[2] = {1, 0.2},
                 bottom[3] = {0.5, 0, 0}, top[3] = {0.5, 0.6, 0};
    add_tank(sim, 1, 0.6, 0);
    ASSERT_OK(sim, mps_baffle_add(sim, "plate", bottom, top, NULL));
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo2, hi2, NULL, NULL));
    ASSERT_OK(sim, mps_run(sim, 0.02, NULL, NULL));
    for (int k = 1; k <= 11; k++) {
        const double y = k * dp, left = fmax(0, 8 - k), right = fmax(0, 4 - k);
        const double at_level_left = k == 8 ? 0.125 : left,
                     at_level_right = k == 4 ? 0.125 : right; /* mean over the strip */
        ASSERT_NEAR(read_sensor(sim, add_sensor(sim, 0.5, y, -1, 0)) / unit, at_level_left, 0.01);
        ASSERT_NEAR(read_sensor(sim, add_sensor(sim, 0.5, y, 1, 0)) / unit, at_level_right, 0.01);
    }
    const double force = 0.5 * RHO * GRAVITY * (0.4 * 0.4 - 0.2 * 0.2);
    ASSERT_NEAR(force_x(sim, "plate"), force, 1e-3 * force);
    mps_sim_destroy(sim);
}

/* Distance to the walls of a tank 1 m wide and 0.7 m high, with upper chamfers of 0.2 m and lower
 * ones of 0.1 m. */
static double chamfered(void *user, const double *x)
{
    (void)user;
    const double side = 0.5 - fabs(x[0] - 0.5), lid = 0.7 - x[1];
    return fmin(fmin(fmin(x[1], lid), side), fmin(side + lid - 0.2, side + x[1] - 0.1) / sqrt(2));
}

static mps_sim *chamfered_tank(double level)
{
    const double lo[2] = {0, 0}, hi[2] = {1, level};
    mps_sim *sim = new_sim(2, 0.02);
    mps_solid s;
    assert_int_equal(mps_solid_init(&s, sizeof s), MPS_OK);
    s.distance = chamfered;
    s.hi[0] = 1;
    s.hi[1] = 0.7;
    ASSERT_OK(sim, mps_solid_add(sim, &s));
    ASSERT_OK(sim, mps_fill_level_add(sim, 0, lo, hi, NULL, NULL));
    return sim;
}

/* Below, at and above the upper knuckle, at height 0.5; at and above the lower one. */
static void knuckle(void **state)
{
    (void)state;
    const double levels[] = {0.1, 0.12, 0.45, 0.48, 0.49, 0.5, 0.51, 0.53},
                 unit = RHO * GRAVITY * 0.02;
    for (size_t k = 0; k < sizeof levels / sizeof levels[0]; k++) {
        mps_sim *sim = chamfered_tank(levels[k]);
        const int32_t deep = add_sensor(sim, 0.5, 0, 0, 1), wall = add_sensor(sim, 0, 0.5, 1, 0),
                      chamfer = add_sensor(sim, 0, 0.5, 1, -1),
                      above = add_sensor(sim, 0.1, 0.6, 1, -1);
        ASSERT_OK(sim, mps_run(sim, 0.3, NULL, NULL));
        const walls w = compare(sim, levels[k]);
        const double head = (levels[k] - 0.5) / 0.02;
        print_message("level %.2f: %.3f to %.3f above (equation %.3f)\n", levels[k], w.least,
                      w.most, w.equation);
        assert_true(w.least > -0.05 && w.most < 0.1);
        assert_true(w.equation < -0.4);
        ASSERT_NEAR(read_sensor(sim, above), 0, 1e-3 * unit);
        ASSERT_NEAR(read_sensor(sim, deep), RHO * GRAVITY * levels[k], 0.5 * unit);
        const double shown[2] = {read_sensor(sim, wall) / unit, read_sensor(sim, chamfer) / unit};
        for (int a = 0; a < 2; a++)
            if (head < -1.5)
                ASSERT_NEAR(shown[a], 0, 1e-3);
            else
                assert_true(shown[a] > -0.05 && shown[a] < fmax(0, head) + 0.8);
        mps_sim_destroy(sim);
    }
}

/* ---- in motion ---- */

/* Lateral impacts in a tank that rolls: sensors at the still level run dry in each cycle. */
static void rolling(void **state)
{
    (void)state;
    const double dp = 0.0155, unit = RHO * GRAVITY * dp, centre[3] = {0.45, 0, 0};
    const mps_harmonic roll = {.dof = MPS_ROTATE_Z, .amplitude = 4 * PI / 180, .omega = 3.86};
    mps_sim *sim = new_sim(2, dp);
    double t = 0, least = 0, most = 0;
    int64_t dry = 0, count = 0;
    add_tank(sim, 58 * dp, 33 * dp, 0);
    fill_depth(sim, 58 * dp, 6 * dp, 0);
    ASSERT_OK(sim, mps_motion_centre_set(sim, centre, MPS_START_AT_REST));
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &roll));
    const int32_t left = add_sensor(sim, 0, 6 * dp, 1, 0),
                  right = add_sensor(sim, 58 * dp, 6 * dp, -1, 0);
    while (t < 3) {
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        ASSERT_OK(sim, mps_sim_time(sim, &t, NULL));
        if (t < 0.2) continue; /* the jump of the start is an impulse with suction */
        for (int side = 0; side < 2; side++, count++) {
            const double p = read_sensor(sim, side ? right : left) / unit;
            least = fmin(least, p);
            most = fmax(most, p);
            dry += fabs(p) < 1e-3;
        }
    }
    print_message("%.3f to %.1f rho g dp, dry in %.0f %%\n", least, most,
                  100. * (double)dry / (double)count);
    assert_true(least > -0.1);
    assert_true(most > 20);
    assert_true(dry > count / 10 && dry < 9 * count / 10);
    mps_sim_destroy(sim);
}

/* Of all walls adjacent to void, which have a lower bound of the pressure: how far below 0 they
 * show a pressure that is not from the equation, and how many of them have liquid under suction
 * around them. */
static struct {
    double lowest;
    int64_t pulled, seen;
} void_spy;

enum { PRESSURE, WALL_PRESSURE, CONDITION, VALUE, USES };
static const mps_use void_uses[USES] = {[PRESSURE] = {"pressure", MPS_USE_NEIGHBOURS},
                                        [WALL_PRESSURE] = {"wall_pressure", MPS_USE_READ},
                                        [CONDITION] = {"pressure_condition", MPS_USE_READ},
                                        [VALUE] = {"pressure_value", MPS_USE_READ}};

static int look_at_void(mps_stage *s)
{
    const mps_view *v = s->view;
    const double *p = s->data[PRESSURE], *load = s->data[WALL_PRESSURE], *value = s->data[VALUE];
    const int32_t *condition = s->data[CONDITION];
    const double unit = RHO * GRAVITY * v->dp;
    for (int64_t i = 0; i < v->n; i++) {
        double pull = 0;
        if (v->kind[i] != MPS_WALL || condition[i] < MPS_ROW_LEAST) continue;
        for (int64_t q = v->near.begin[i]; q < v->near.end[i]; q++)
            if (v->kind[v->near.col[q]] == MPS_FLUID) pull = fmin(pull, p[v->near.col[q]]);
        void_spy.seen++;
        void_spy.pulled += pull < -0.3 * unit && p[i] < -0.3 * unit;
        void_spy.lowest = fmin(void_spy.lowest, (load[i] - fmin(0, p[i] - value[i])) / unit);
    }
    return 0;
}

static const mps_verb void_verbs[] = {
    {.hook = MPS_LOAD, .use_count = USES, .uses = void_uses, .after = "*", .run = look_at_void}};
static const mps_model_ops void_model = {.struct_size = sizeof(mps_model_ops),
                                         .api = MPS_MODEL_API,
                                         .name = "after.void",
                                         .help = "what walls show that void reaches",
                                         .verb_count = 1,
                                         .verbs = void_verbs};

/* A chamfered tank rolled near its first period: liquid in the angle of a knuckle is not always
 * found to be on the surface, and pulls. */
static void void_reaches(void **state)
{
    (void)state;
    const double centre[3] = {0.5, 0, 0};
    const mps_harmonic roll = {
        .dof = MPS_ROTATE_Z, .amplitude = 6 * PI / 180, .omega = 2 * PI / 1.18};
    mps_sim *sim = chamfered_tank(0.47);
    ASSERT_OK(sim, mps_model_register(sim, &void_model));
    ASSERT_OK(sim, mps_model_use(sim, "after.void"));
    ASSERT_OK(sim, mps_motion_centre_set(sim, centre, MPS_START_AT_REST));
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &roll));
    memset(&void_spy, 0, sizeof void_spy);
    ASSERT_OK(sim, mps_run(sim, 2.2, NULL, NULL));
    print_message("walls that void reaches: %lld, with liquid that pulls %lld, lowest %.3g\n",
                  (long long)void_spy.seen, (long long)void_spy.pulled, void_spy.lowest);
    assert_true(void_spy.pulled > 100);
    assert_true(void_spy.lowest > -1e-9);
    mps_sim_destroy(sim);
}

/* ---- suction that stays ---- */

static int push(void *user, double t, mps_motion_state *state)
{
    const double a = *(const double *)user;
    state->value[MPS_MOVE_X] = 0.5 * a * t * t;
    state->rate[MPS_MOVE_X] = a * t;
    state->accel[MPS_MOVE_X] = a;
    return 0;
}

/* A full tank that is accelerated: its front wall pulls the liquid. */
static void full_tank_pulls(void **state)
{
    (void)state;
    double a = 5;
    for (int32_t dim = 2; dim <= 3; dim++) {
        mps_sim *sim = new_sim(dim, 0.05);
        add_tank(sim, 1, 0.5, 0.3);
        fill_depth(sim, 1, 0.5, 0.3);
        ASSERT_OK(sim, mps_motion_callback_set(sim, push, &a));
        for (int k = 0; k < 3; k++) ASSERT_OK(sim, mps_step(sim, 1, NULL));
        const mps__particles *s = &sim->world.particles;
        double low = INFINITY, high = -INFINITY;
        for (int64_t i = 0; i < s->n; i++) {
            if (s->kind[i] != MPS_WALL) continue;
            ASSERT_NEAR(s->load[i], s->p[i], 0.02 * RHO * a);
            low = fmin(low, s->load[i]);
            high = fmax(high, s->load[i]);
        }
        /* the pressure is linear from the upper front to the lower rear corner */
        ASSERT_NEAR(high - low, RHO * (a + GRAVITY * 0.5), 0.02 * RHO * a);
        assert_true(low < -0.4 * RHO * a);
        mps_sim_destroy(sim);
    }
}

/* An open tank that is suddenly accelerated: the rear wall keeps its suction below the level. */
static void jump_pulls(void **state)
{
    (void)state;
    const double dp = 0.05, depth = 0.4;
    for (int32_t dim = 2; dim <= 3; dim++) {
        mps_sim *sim = new_sim(dim, dp);
        add_tank(sim, 1, 0.6, 0.3);
        fill_depth(sim, 1, depth, 0.3);
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        const mps_harmonic surge = {.dof = MPS_MOVE_X, .amplitude = 0.05, .omega = 10};
        ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &surge));
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        const mps__particles *s = &sim->world.particles;
        double weakest = INFINITY, strongest = 0;
        int64_t seen = 0;
        for (int64_t i = 0; i < s->n; i++) {
            const double y = s->ref[i * dim + 1], x = s->ref[i * dim];
            if (s->kind[i] != MPS_WALL || x < 1 - 1e-6 || y > depth + 0.5 * dp) continue;
            weakest = fmin(weakest, s->load[i] / s->p[i]);
            strongest = fmax(strongest, s->load[i] / s->p[i]);
            assert_true(s->p[i] < -10 * RHO * GRAVITY * dp);
            seen++;
        }
        print_message("%d-D: %lld wet walls show %.3f to %.3f of the suction in the equation\n",
                      dim, (long long)seen, weakest, strongest);
        assert_true(weakest > 0.8 && strongest < 1 + 1e-6);
        assert_true(seen >= 8);
        mps_sim_destroy(sim);
    }
}

int main(void)
{
    struct CMUnitTest tests[] = {cmocka_unit_test(still_tank),   cmocka_unit_test(sides_of_a_plate),
                                 cmocka_unit_test(knuckle),      cmocka_unit_test(rolling),
                                 cmocka_unit_test(void_reaches), cmocka_unit_test(full_tank_pulls),
                                 cmocka_unit_test(jump_pulls)};
    take_turns(tests, sizeof tests / sizeof tests[0], 3);
    return cmocka_run_group_tests(tests, NULL, NULL);
}

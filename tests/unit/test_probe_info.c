/* SPDX-License-Identifier: BSD-3-Clause */
/* Names of probes, and the face that a sensor reads: the nearest one, or the one selected by its
 * normal. */
#include "probe_fixture.h"
#include <stdio.h>

static char logged[2048];

static void keep_log(void *user, int level, const char *text)
{
    (void)user, (void)level;
    strncat(logged, text, sizeof logged - strlen(logged) - 2);
}

static mps_sim *logging(int32_t dim)
{
    mps_config config;
    mps_sim *sim = NULL;
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dim = dim;
    config.dp = dp;
    config.log = keep_log;
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    add_tank(sim, 0.4, 0.3, 0.1);
    logged[0] = 0;
    return sim;
}

static mps_probe_info info_of(const mps_sim *sim, int32_t id)
{
    mps_probe_info info;
    assert_int_equal(mps_probe_info_init(&info, sizeof info), MPS_OK);
    ASSERT_OK(sim, mps_probe_info_get(sim, id, &info));
    return info;
}

/* A sensor with a normal (0, 0, 0: none) reads the part with this pressure, and logs it. */
static void assert_face(mps_sim *sim, const mps_probe *p, const char *part, double nx, double ny,
                        double pressure)
{
    int32_t id = -1;
    double value = NAN;
    ASSERT_OK(sim, mps_probe_add(sim, p, &id));
    ASSERT_OK(sim, mps_probe_read(sim, id, &value));
    const mps_probe_info info = info_of(sim, id);
    assert_string_equal(info.part, part);
    ASSERT_NEAR(info.normal[0], nx, 1e-9);
    ASSERT_NEAR(info.normal[1], ny, 1e-9);
    ASSERT_NEAR(info.normal[2], 0, 1e-9);
    ASSERT_NEAR(value, pressure, 1e-9);
}

/* 1 Pa on the left wall, 2 Pa on the floor, where they meet too. */
static void press(mps_sim *sim)
{
    const mps__particles *s = &sim->world.particles;
    for (int64_t i = 0; i < s->n; i++) {
        const double *X = &s->ref[i * s->dim];
        s->load[i] = s->kind[i] != MPS_WALL ? 0 : X[1] < 0.1 * dp ? 2 : X[0] < 0.1 * dp ? 1 : 0;
    }
}

static void in_a_corner(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        mps_sim *sim = logging(dim);
        press(sim);
        mps_probe p = probe_of(MPS_PROBE_WALL_PRESSURE, 0, 1.6 * dp, 0.05);
        p.diameter = 1e-5;
        assert_face(sim, &p, "tank.x0", 1, 0, 1);
        assert_string_equal(logged, ""); /* only one face */
        p.at[1] = 0.4 * dp;
        p.name = "P1";
        p.at[0] = 1.1 * dp;
        assert_face(sim, &p, "tank.y0", 0, 1, 2);
        assert_string_equal(logged, "");
        p.at[0] = 0.7 * dp;
        p.name = "P2";
        assert_face(sim, &p, "tank.y0", 0, 1, 2);
        assert_non_null(strstr(logged,
                               "probe 2 'P2' reads the face with the normal (0, 1, 0), part "
                               "\"tank.y0\"; another is as near, with (1, 0, 0), part "
                               "\"tank.x0\": probe.normal chooses"));
        logged[0] = 0;
        p.name = NULL;
        p.at[1] = 1.2 * dp;
        p.at[0] = 0.9 * dp;
        p.normal[1] = 0.02;
        assert_face(sim, &p, "tank.y0", 0, 1, 2);
        p.normal[0] = 0.0115; /* 29.9 degrees off it */
        assert_face(sim, &p, "tank.y0", 0, 1, 2);
        assert_string_equal(logged, "");
        mps_sim_destroy(sim);
    }
}

/* Both sides of a plate without thickness, from a position in its plane. */
static void on_a_plate(void **state)
{
    (void)state;
    mps_sim *sim = logging(2);
    const double corner[2] = {0.2, 0}, edge[2] = {0, 0.2};
    ASSERT_OK(sim, mps_plate_add(sim, "plate", corner, edge, NULL));
    const mps__particles *s = &sim->world.particles;
    for (int64_t i = 0; i < s->n; i++) s->load[i] = s->kind[i] == MPS_WALL ? s->area[2 * i] : 0;
    mps_probe p = probe_of(MPS_PROBE_WALL_PRESSURE, 0.2, 0.1, 0);
    for (int side = -1; side <= 1; side += 2) {
        p.normal[0] = side;
        assert_face(sim, &p, "plate", side, 0, side * dp);
    }
    mps_sim_destroy(sim);
}

static void normals_refused(void **state)
{
    (void)state;
    mps_sim *sim = logging(2);
    mps_probe p = probe_of(MPS_PROBE_WALL_PRESSURE, 0, 0.1, 0);
    int32_t id;
    p.normal[0] = 0.0117; /* 30.3 degrees off any face */
    p.normal[1] = 0.02;
    ASSERT_REFUSED(sim, mps_probe_add(sim, &p, &id), MPS_E_ARG,
                   "within 2 dp = 0.02 m of probe.at looks along probe.normal");
    p.normal[0] = -1;
    p.normal[1] = 0;
    ASSERT_REFUSED(sim, mps_probe_add(sim, &p, &id), MPS_E_ARG, "probe.normal (-1, 0, 0)");
    p.normal[0] = 0; /* the floor is 10 dp away */
    p.normal[1] = 1;
    ASSERT_REFUSED(sim, mps_probe_add(sim, &p, &id), MPS_E_ARG, "probe.normal (0, 1, 0)");
    p.normal[1] = INFINITY;
    ASSERT_REFUSED(sim, mps_probe_add(sim, &p, &id), MPS_E_ARG, "must be finite");
    p.normal[1] = 0;
    p.normal[2] = 1;
    ASSERT_REFUSED(sim, mps_probe_add(sim, &p, &id), MPS_E_ARG, "in 2-D not along z");
    mps_sim_destroy(sim);
}

static void names(void **state)
{
    (void)state;
    mps_sim *sim = logging(2);
    mps_probe p = probe_of(MPS_PROBE_FORCE, 0.1, 0.2, 0);
    mps_probe_info info;
    char name[8] = "lift";
    int32_t id;
    p.name = name;
    p.part = "tank.";
    ASSERT_OK(sim, mps_probe_add(sim, &p, &id));
    ASSERT_REFUSED(sim, mps_probe_add(sim, &p, &id), MPS_E_NAME, "\"lift\" is that of probe 0");
    name[0] = 0; /* it has a copy */
    info = info_of(sim, 0);
    assert_string_equal(info.name, "lift");
    assert_string_equal(info.part, "tank.");
    assert_int_equal(info.type, MPS_PROBE_FORCE);
    assert_int_equal(info.values, 3);
    ASSERT_NEAR(info.at[1], 0.2, 0);
    ASSERT_NEAR(info.normal[0], 0, 0);
    ASSERT_REFUSED(sim, mps_probe_add(sim, &p, &id), MPS_E_ARG, "must have 1..31 characters");
    p = probe_of(MPS_PROBE_GAUGE, 0.1, 0, 0);
    ASSERT_OK(sim, mps_probe_add(sim, &p, &id));
    info = info_of(sim, id);
    assert_string_equal(info.name, "");
    assert_string_equal(info.part, "");
    ASSERT_NEAR(info.diameter, 3 * dp, 1e-15);
    ASSERT_OK(sim, mps_probe_remove(sim, 0));
    ASSERT_REFUSED(sim, mps_probe_info_get(sim, 0, &info), MPS_E_ARG, "probe 0 was removed");
    ASSERT_REFUSED(sim, mps_probe_info_get(sim, 2, &info), MPS_E_ARG, "there are 2");
    p.name = "lift"; /* free again */
    ASSERT_OK(sim, mps_probe_add(sim, &p, &id));
    mps_sim_destroy(sim);
}

/* Messages while it runs use the name. */
static void names_in_messages(void **state)
{
    (void)state;
    mps_sim *sim = logging(2);
    mps_probe p = probe_of(MPS_PROBE_WALL_PRESSURE, 0, 0.1, 0);
    int32_t id;
    fill_depth(sim, 0.4, 0.2, 0.1);
    p.name = "P_left";
    p.average = 1e-9;
    ASSERT_OK(sim, mps_probe_add(sim, &p, &id));
    for (int k = 0; k < 20; k++) ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    assert_non_null(strstr(logged, "probe 0 'P_left' averages over 1e-09 s"));
    mps_sim_destroy(sim);
}

/* An average over less than the time that dp resolves is logged; an instantaneous force is the load
 * of the step and is not. */
static void windows_that_are_short(void **state)
{
    static const struct {
        int32_t type;
        double average;
        bool tells;
    } cases[] = {{MPS_PROBE_WALL_PRESSURE, 0, true},  {MPS_PROBE_WALL_PRESSURE, 1e-9, true},
                 {MPS_PROBE_WALL_PRESSURE, 1, false}, {MPS_PROBE_FORCE, 0, false},
                 {MPS_PROBE_FORCE, 1e-9, true},       {MPS_PROBE_FORCE, 1, false},
                 {MPS_PROBE_GAUGE, 0, false}};
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        mps_sim *sim = logging(2);
        mps_probe p = probe_of(cases[k].type, 0, 0.1, 0);
        int32_t id;
        fill_depth(sim, 0.4, 0.2, 0.1);
        p.average = cases[k].average;
        ASSERT_OK(sim, mps_probe_add(sim, &p, &id));
        for (int n = 0; n < 20; n++) ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
        assert_true((strstr(logged, "averages over") != NULL) == cases[k].tells);
        mps_sim_destroy(sim);
    }
}

/* A delayed force is logged once if an application moves the tank by poses without
 * mps_load_watch(). */
static void forces_that_lag(void **state)
{
    static const double average[] = {MPS_AVERAGE_AUTO, 0.01, 0, MPS_AVERAGE_AUTO, MPS_AVERAGE_AUTO};
    (void)state;
    for (int k = 0; k < 5; k++) {
        mps_sim *sim = logging(2);
        mps_probe p;
        mps_motion_state pose;
        int32_t id;
        assert_int_equal(mps_probe_init(&p, sizeof p), MPS_OK);
        assert_int_equal(mps_motion_state_init(&pose, sizeof pose), MPS_OK);
        fill_depth(sim, 0.4, 0.2, 0.1);
        p.type = MPS_PROBE_FORCE;
        p.average = average[k];
        ASSERT_OK(sim, mps_probe_add(sim, &p, &id));
        if (k == 3) ASSERT_OK(sim, mps_load_watch(sim, MPS_LOAD_FORCE));
        for (int n = 1; n <= 5; n++) {
            pose.value[MPS_MOVE_X] = 1e-6 * n * n;
            if (k < 4) ASSERT_OK(sim, mps_motion_pose_set(sim, 1e-3 * n, &pose));
            ASSERT_OK(sim, mps_run(sim, 1e-3 * n, NULL, NULL));
        }
        const char *said = strstr(logged, "probe 0 averages a force over");
        assert_true((said != NULL) == (k < 2));
        if (said) assert_non_null(strstr(said, "must not drive a body"));
        if (said) assert_null(strstr(said + 1, "probe 0 averages a force over"));
        mps_sim_destroy(sim);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(in_a_corner),       cmocka_unit_test(on_a_plate),
        cmocka_unit_test(normals_refused),   cmocka_unit_test(names),
        cmocka_unit_test(names_in_messages), cmocka_unit_test(windows_that_are_short),
        cmocka_unit_test(forces_that_lag),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

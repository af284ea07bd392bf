/* SPDX-License-Identifier: BSD-3-Clause */
/* Unusual cases: motions of many harmonics, tables in the axes of the library, incomplete lists of
 * numbers, many messages. */
#include "build_kit.h"
#include "job_fixture.h"

#define TOP   "mps: 1\ndp: 50 mm\n"
#define BOX   "tank: {size: 1 0.6 m}\nfill: [{water: {depth: 0.3 m}}]\n"
#define SPACE "mps: 1\ndim: 3\ndp: 0.2 m\ntank: {size: 2 1 1 m}\nfill: [{water: {depth: 0.4 m}}]\n"
#define END   "run: {until: 8 ms, dt: 4 ms, threads: 1}\n"

static char *write_table(char *path, size_t size, const char *text)
{
    FILE *file = fopen(kit_here(path, size, "table.csv"), "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0 && fclose(file) == 0);
    return path;
}

/* ---- motions */

/* 6000 harmonics are the maximum: here 7 spectra of 1000, or 6 and one wave more. */
static void many_harmonics(void **state)
{
    static const char spectrum[] =
        "    - {jonswap: {significant: 1 deg, peak: 1 s, components: 1000}}\n";
    char text[2000];
    built t;
    (void)state;
    size_t six = (size_t)snprintf(text, sizeof text, TOP BOX "motion:\n  roll:\n");
    for (int k = 0; k < 6; k++)
        six += (size_t)snprintf(text + six, sizeof text - six, "%s", spectrum);
    snprintf(text + six, sizeof text - six, END);
    built_make(&t, text, NULL);
    assert_int_equal(t.b.motion->count, 6000);
    built_free(&t);
    snprintf(text + six, sizeof text - six, "%s" END, spectrum);
    built_refused(text, 13, "more than 6000 harmonics");
    snprintf(text + six, sizeof text - six, "    - {amplitude: 1 deg, period: 1 s}\n" END);
    built_refused(text, 13, "more than 6000 harmonics");
}

static void wrong_motions(void **state)
{
    char path[600], text[1600];
    (void)state;
    write_table(path, sizeof path, "time[s],roll[deg]\n0,0\n1,1\n");
    snprintf(text, sizeof text,
             TOP BOX "motion: {file: %s, surge: {amplitude: 1 mm, period: 1 s}}\n" END, path);
    built_refused(text, 5, "motion: give a file or degrees, not both");
    built_refused(TOP BOX "gravity: 0 m/s2\nmotion: {roll: {amplitude: 1 deg, period: 1 T1}}\n" END,
                  6, "motion.roll.period: 'T1' is not known here");
    built_refused(TOP BOX "motion: {start: rest}\n" END, 5,
                  "no degree is given: surge, sway, heave, roll, pitch, yaw, or file");
    built_refused(SPACE
                  "motion: {order: roll roll yaw, roll: {amplitude: 1 deg, period: 1 s}}\n" END,
                  6, "must be roll, pitch and yaw, each once");
    built_refused(SPACE "motion: {order: roll yaw, roll: {amplitude: 1 deg, period: 1 s}}\n" END, 6,
                  "must be roll, pitch and yaw, each once");
    unlink(path);
}

/* A table in the axes of a ship and in those of the library, where sway is along -z and pitch about
 * it. */
static void axes_of_tables(void **state)
{
    static const char table[] = "time[s],surge[m],sway[m],pitch[deg]\n0,0,0,0\n1,0.1,0.2,3\n";
    static const char *const axes[] = {"x forward, y port, z up", "x forward, y up, z starboard"};
    char path[600], text[1600];
    double at[2][MPS_DOF_COUNT];
    (void)state;
    write_table(path, sizeof path, table);
    for (int k = 0; k < 2; k++) {
        built t;
        mps_motion_state pose;
        snprintf(text, sizeof text, SPACE "motion: {file: %s, axes: \"%s\"}\nrun: {until: 1 s}\n",
                 path, axes[k]);
        built_make(&t, text, NULL);
        mps_motion_state_init(&pose, sizeof pose);
        while (1) {
            double now;
            mps_sim_time(t.b.sim, &now, NULL);
            if (now > 0.05) break;
            assert_true(mps_step(t.b.sim, 0.01, NULL) >= 0);
        }
        assert_int_equal(mps_motion_state_get(t.b.sim, &pose), MPS_OK);
        memcpy(at[k], pose.value, sizeof at[k]);
        built_free(&t);
    }
    assert_true(at[0][MPS_MOVE_X] > 0.004 && at[0][MPS_MOVE_X] < 0.02);
    for (int d = 0; d < MPS_DOF_COUNT; d++) {
        const double sign = d == MPS_MOVE_Z || d == MPS_ROTATE_Z ? -1 : 1;
        same_number(at[1][d], sign * at[0][d], 1e-12);
    }
    assert_true(fabs(at[0][MPS_MOVE_Z]) > 0.008 && fabs(at[0][MPS_ROTATE_Z]) > 1e-3);
    unlink(path);
}

/* With a ramp the rows before the start of the run are at rest, and those after it grow as the
 * first cubes of time. */
static void ramp_of_tables(void **state)
{
    char path[600], text[1600];
    built t;
    (void)state;
    write_table(path, sizeof path,
                "time[s],roll[rad]\n-2,0.5\n-1,0.5\n0,0.5\n1,0.5\n2,0.5\n3,0.5\n");
    snprintf(text, sizeof text,
             TOP BOX "motion: {file: %s, from: 0 s, ramp: 2 s}\nrun: {until: 3 s}\n", path);
    built_make(&t, text, NULL);
    static const double wanted[] = {0,    0,   0,
                                    0.25, 0.5, 0.5}; /* 10 x^3 - 15 x^4 + 6 x^5 of 0.5 rad */
    assert_int_equal(t.b.motion->rows, 6);
    for (int i = 0; i < 6; i++)
        same_number(t.b.motion->column[6 * i + MPS_SHIP_ROLL], wanted[i], 1e-12);
    built_free(&t);
    unlink(path);
}

/* ---- tanks and solids */

static void tanks(void **state)
{
    built t;
    (void)state;
    built_refused("mps: 1\ndim: 3\ndp: 0.2 m\ntank: {size: 2 1 m}\n"
                  "fill: [{water: {depth: 0.4 m}}]\n" END,
                  4, "tank.size: 3 numbers are needed in 3-D");
    built_refused(TOP BOX "kernel: {near: 1.2 dp, far: 0.1 dp}\n" END, 1, "re_");
    /* a level between two rows: the tank is symmetric about it, whole cells and a half */
    built_make(&t,
               TOP "tank: {size: 1 0.6 m, between_rows: 0.31 m}\n"
                   "fill: [{water: {depth: 50 %}}]\n" END,
               NULL);
    same_number(t.b.tank.form.hi[1] - t.b.tank.form.lo[1], 0.65, 1e-12);
    same_number(0.5 * (t.b.tank.form.hi[1] + t.b.tank.form.lo[1]), 0.31, 1e-12);
    built_free(&t);
}

/* ---- models and solvers */

/* The length of the first step [s]. */
static double first_step(const char *text)
{
    built t;
    mps_step_info info;
    mps_step_info_init(&info, sizeof info);
    built_make(&t, text, NULL);
    if (mps_step(t.b.sim, 1, &info) < 0) fail_msg("%s", mps_sim_error(t.b.sim));
    built_free(&t);
    return info.dt;
}

/* Liquid at rest: 0.06 sqrt(dp/g), half of it with the models of the papers; run.dt_max is the
 * least of all. */
static void steps(void **state)
{
    const double calm = sqrt(0.05 / 9.81);
    (void)state;
    same_number(first_step(TOP BOX "run: {until: 1 s, preconditioner: jacobi}\n"), 0.06 * calm,
                1e-9);
    same_number(first_step(TOP BOX "model: imps.paper\nrun: {until: 1 s}\n"), 0.03 * calm, 1e-9);
    same_number(first_step(SPACE "model: imps.paper\nrun: {until: 1 s}\n"), 0.03 * 2 * calm, 1e-9);
    same_number(first_step(TOP BOX "motion: {sway: {acceleration: 0.1 m/s2}}\n"
                                   "run: {until: 1 s, dt_max: 0.3 ms}\n"),
                3e-4, 1e-12);
    built_refused(TOP BOX "run: {until: 1 s, preconditioner: nothing}\n", 5,
                  "no preconditioner 'nothing'");
}

/* ---- checks */

static void check_tells(const char *text, const char *words, const char *more)
{
    mps_case *c = NULL;
    char *logged = NULL, *sketch = NULL;
    const mps_status status = kit_read(text, NULL, &c);
    char *all = kit_messages(c);
    if (status != MPS_OK) fail_msg("%s", all);
    free(all);
    if (mps_case_check(c, &logged, &sketch) != MPS_OK) fail_msg("%s", kit_messages(c));
    if (!strstr(logged, words)) fail_msg("wanted: %s\n%s", words, logged);
    if (more && !strstr(logged, more)) fail_msg("wanted: %s\n%s", more, logged);
    free(logged);
    free(sketch);
    mps_case_destroy(c);
}

/* A case whose run fails in its first steps has no check either. */
static void check_refuses(const char *text, const char *words, const char *more)
{
    mps_case *c = NULL;
    char *logged = NULL, *sketch = NULL;
    if (kit_read(text, NULL, &c) != MPS_OK) fail_msg("%s", kit_messages(c));
    assert_int_equal(mps_case_check(c, &logged, &sketch), MPS_E_ARG);
    assert_true(!logged && !sketch);
    char *all = kit_messages(c);
    if (!strstr(all, words) || !strstr(all, more)) fail_msg("wanted: %s, %s\n%s", words, more, all);
    free(all);
    mps_case_destroy(c);
}

static void checks(void **state)
{
    char path[600], text[1600];
    (void)state;
    check_tells("mps: 1\ndp: 0.5 mm\ntank: {size: 20 10 mm}\nfill: [{water: {depth: 5 mm}}]\n"
                "run: {until: 1 s}\n",
                "dp 500 um", NULL);
    check_tells(TOP BOX "run: {until: 1e7 s}\n", " h of wall clock: calm to violent", NULL);
    check_refuses(TOP "tank: {size: 1 0.6 m}\n"
                      "fill: [{water: {depth: 0.3 m, start: {velocity: 1 0 m/s}}}]\n"
                      "run: {until: 1 s, speed_limit: 1 mm/s}\n",
                  "the first steps fail: ", "allowed");
    check_refuses(TOP "tank: {size: 1 0.6 m}\nfill: [{water: {depth: 0.3 m}}]\n"
                      "model: imps.paper\nbody: {mass: 9 kg, surge: {stiffness: 1 kN/m}}\n" END,
                  "the first steps fail: ", "'source.volume'");
    write_table(path, sizeof path, "time[s],roll[deg]\n0,0\n1,1\n3,0\n");
    snprintf(text, sizeof text, TOP BOX "motion: {file: %s}\nrun: {until: 3 s}\n", path);
    check_tells(text, "3 rows of ", "1 to 2 s apart");
    unlink(path);
    check_tells(TOP BOX "sensors: {F: {force: tank, component: mz}, a: {measure: speed}}\n" END,
                "F: moment about z through (0, 0) m", "a: measure\n");
}

/* Volumes of round tanks; a centre of rotation outside of the picture, on each side; a title with
 * marks of XML. */
static void drawings(void **state)
{
    static const char *const centres[] = {"-5 0.3 m", "6 0.3 m", "0.5 4 m", "0.5 -4 m"};
    char text[900];
    (void)state;
    check_tells("mps: 1\ndim: 3\ndp: 0.1 m\ntank: {cylinder: {radius: 0.5 m, length: 1 m}}\n"
                "fill: [{water: {depth: 0.4 m}}]\n" END,
                "0.7854 m3 inside", NULL);
    check_tells("mps: 1\ndim: 3\ndp: 0.1 m\ntank: {sphere: {radius: 0.5 m}}\n"
                "fill: [{water: {depth: 0.4 m}}]\n" END,
                "0.5236 m3 inside", NULL);
    check_tells("mps: 1\ndp: 50 mm\ntank: {sphere: {radius: 0.5 m}}\n"
                "fill: [{water: {depth: 0.4 m}}]\n" END,
                "0.7854 m2 inside", NULL);
    for (int k = 0; k < 4; k++) {
        mps_case *c = NULL;
        char *logged = NULL, *sketch = NULL;
        snprintf(text, sizeof text,
                 TOP BOX "title: \"a<b & 'c'\"\n"
                         "motion: {centre: %s, roll: {amplitude: 1 deg, period: 1 s}}\n" END,
                 centres[k]);
        assert_int_equal(kit_read(text, NULL, &c), MPS_OK);
        assert_int_equal(mps_case_check(c, &logged, &sketch), MPS_OK);
        assert_non_null(strstr(sketch, "a&lt;b &amp; &#39;c&#39;"));
        assert_null(strstr(sketch, ">centre</text>"));
        assert_non_null(strstr(sketch, "; centre of rotation: x "));
        free(logged);
        free(sketch);
        mps_case_destroy(c);
    }
}

static void fluids(void **state)
{
    (void)state;
    built_refused(TOP "tank: {size: 1 0.6 m}\nfluids: {lngas: {density: 450 kg/m3, viscosity: 0.1 "
                      "mPa s}, lnga: {density: 460 kg/m3, viscosity: 0.1 mPa s}}\n"
                      "fill: [{lngb: {depth: 0.3 m}}]\n" END,
                  5, "no fluid has the name 'lngb'; did you mean 'lnga'?");
    built_refused(TOP "tank: {size: 1 0.6 m}\nfluids: {oil: {viscosity: 1 mPa s}}\n"
                      "fill: [{oil: {depth: 0.3 m}}]\n" END,
                  4, "fluids.oil|'density' is missing");
    /* of one density in one line: the first of the line is the first phase */
    check_tells(TOP "tank: {size: 1 0.6 m}\n"
                    "fluids: {b: {density: 900 kg/m3, viscosity: 2 mm2/s, tension: 0 N/m}, "
                    "a: {density: 900 kg/m3, viscosity: 1 mm2/s, tension: 0 N/m}}\n"
                    "fill: [{b: {box: [0 0 m, 0.5 0.3 m]}}, {a: {box: [0.5 0 m, 1 0.3 m]}}]\n" END,
                "phase 0: b, 900 kg/m3", "phase 1: a, 900 kg/m3");
}

/* ---- runs */

static mps_status job_of_text(const char *name, const char *text, int32_t *code)
{
    char error[1000] = "";
    mps_case *c = NULL;
    mps_job *job = NULL;
    mps_sim *sim = NULL;
    mps_job_config config;
    assert_int_equal(mps_job_config_init(&config, sizeof config), MPS_OK);
    said[0] = '\0';
    config.folder = "unusual";
    config.overwrite = 1;
    config.print = listen;
    config.error = error;
    config.error_size = sizeof error;
    assert_int_equal(mps_case_read_text(text, strlen(text), name, 0, NULL, &c), MPS_OK);
    const mps_status status = mps_case_job(c, &config, &job, &sim);
    char *all = kit_messages(c);
    listen(NULL, MPS_JOB_MESSAGE, all);
    listen(NULL, MPS_JOB_MESSAGE, error);
    free(all);
    *code = status == MPS_OK ? mps_job_run(job, sim) : -1;
    mps_sim_destroy(sim);
    mps_job_destroy(job);
    mps_case_destroy(c);
    return status;
}

/* More messages of the library than are kept are counted by a check; a run shows 20. */
static void many_messages(void **state)
{
    char text[8000];
    int32_t code;
    (void)state;
    size_t used = (size_t)snprintf(text, sizeof text, TOP BOX "sensors:\n");
    for (int k = 0; k < 45; k++) /* in a corner */
        used += (size_t)snprintf(text + used, sizeof text - used, "  P%d: {wall: 0 0 m}\n", k);
    snprintf(text + used, sizeof text - used, END);
    assert_int_equal(job_of_text("many.yaml", text, &code), MPS_OK);
    assert_int_equal(code, MPS_EXIT_OK);
    ASSERT_SAID("further messages are not shown");
    mps_case *c = NULL;
    char *logged = NULL, *sketch = NULL;
    assert_int_equal(kit_read(text, NULL, &c), MPS_OK);
    assert_int_equal(mps_case_check(c, &logged, &sketch), MPS_OK);
    const char *more = strstr(logged, "\n          .. and ");
    int count = 0;
    if (!more || sscanf(more, " .. and %d more messages like these", &count) != 1)
        fail_msg("%s", logged);
    assert_true(count >= 5 && count < 10); /* in addition to those of the fill */
    free(logged);
    free(sketch);
    mps_case_destroy(c);
}

/* A circle, and solids of each shape, have their outlines on the page; a file without a point in
 * its name has its name. */
static void outlines(void **state)
{
    int32_t code;
    (void)state;
    assert_int_equal(job_of_text("plain",
                                 "mps: 1\ndp: 50 mm\ntank: {sphere: {radius: 0.5 m}}\n"
                                 "fill: [{water: {depth: 0.5 m}}]\nsolids:\n"
                                 "  ball: {sphere: {centre: 0 0.3 m, radius: 0.1 m}}\n"
                                 "  wedge: {prism: [-0.2 0.6 m, 0.2 0.6 m, 0 0.8 m]}\n" END,
                                 &code),
                     MPS_OK);
    assert_int_equal(code, MPS_EXIT_OK);
    const char *summary = text_of("unusual", "summary.json");
    if (!strstr(summary, "\"name\": \"plain\"") && !strstr(summary, "plain"))
        fail_msg("%s", summary);
}

/* The unit of a column that has none; what a force is a mean of. */
static void references(void **state)
{
    char path[600], text[1600];
    int32_t code;
    (void)state;
    write_table(path, sizeof path, "t[s],p,angle\n0,1,0.1\n1,2,0.2\n");
    snprintf(text, sizeof text,
             TOP BOX "reference:\n  P: {file: %s, unit: kPa}\n"
                     "  a: {file: %s, columns: [t, angle], unit: rad}\n"
                     "sensors:\n  P: {wall: 0 0.1 m}\n  F: {force: tank, average: 5 ms}\n"
                     "  G: {force: tank, average: 0}\n" END,
             path, path);
    assert_int_equal(job_of_text("a.yaml", text, &code), MPS_OK);
    assert_int_equal(code, MPS_EXIT_OK);
    const char *summary = text_of("unusual", "summary.json");
    if (!strstr(summary, "mean of the last 0.005 s") || !strstr(summary, "no mean over time"))
        fail_msg("%s", summary);
    if (!strstr(summary, "5.72957795")) fail_msg("0.1 rad in degrees: %s", summary);
    unlink(path);
}

static void wrong_references(void **state)
{
    char path[600], text[1600];
    int32_t code;
    (void)state;
    assert_int_equal(job_of_text("a.yaml",
                                 TOP BOX "reference: {a: {times: 1 3 2 s, values: 1 2 3 mm}}\n" END,
                                 &code),
                     MPS_E_ARG);
    ASSERT_SAID("the time 2 s is not later than that before it, 3 s");
    assert_int_equal(job_of_text("a.yaml",
                                 TOP BOX "reference: {a: {times: 1 3 s, values: 1 2 3 mm}}\n" END,
                                 &code),
                     MPS_E_ARG);
    ASSERT_SAID("2 times, but 3 values");
    write_table(path, sizeof path, "t[s]\n0\n1\n");
    snprintf(text, sizeof text, TOP BOX "reference: {a: {file: %s}}\n" END, path);
    assert_int_equal(job_of_text("a.yaml", text, &code), MPS_E_ARG);
    ASSERT_SAID("has one column, two are needed");
    write_table(path, sizeof path, "t[s],p[Pa]\n0,1\n2,3\n1,3\n");
    assert_int_equal(job_of_text("a.yaml", text, &code), MPS_E_ARG);
    ASSERT_SAID("table.csv:4: the time 1 s is not later than that before it, 2 s");
    snprintf(text, sizeof text, TOP BOX "reference: {a: {file: %s, columns: [t, q]}}\n" END, path);
    assert_int_equal(job_of_text("a.yaml", text, &code), MPS_E_ARG);
    ASSERT_SAID("'q' is no column of ");
    unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(many_harmonics),  cmocka_unit_test(wrong_motions),
        cmocka_unit_test(axes_of_tables),  cmocka_unit_test(ramp_of_tables),
        cmocka_unit_test(tanks),           cmocka_unit_test(steps),
        cmocka_unit_test(checks),          cmocka_unit_test(drawings),
        cmocka_unit_test(fluids),          cmocka_unit_test(references),
        cmocka_unit_test(many_messages),   cmocka_unit_test(outlines),
        cmocka_unit_test(wrong_references)};
    return cmocka_run_group_tests(tests, enter_folder, leave_folder);
}

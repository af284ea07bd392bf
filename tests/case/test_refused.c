/* SPDX-License-Identifier: BSD-3-Clause */
/* What cannot be built becomes a message at the line of the object. */
#include "build_kit.h"
#include <unistd.h>

#define TOP   "mps: 1\ndp: 20 mm\n"
#define END   "run: {until: 1 s}\n"
#define BOX   "tank: {size: 1 0.6 m}\nfill: [{water: {depth: 0.3 m}}]\n"
#define SPACE "mps: 1\ndim: 3\ndp: 0.2 m\ntank: {size: 2 1 1 m}\nfill: [{water: {depth: 0.4 m}}]\n"

static void objects(void **state)
{
    (void)state;
    built_refused(TOP "tank: {size: 10 600 mm}\nfill: [{water: {depth: 0.3 m}}]\n" END, 3,
                  "tank: |size");
    built_refused(TOP "tank: {size: 1 0.6 m, chamfer: {bottom: 0.6 0.2 m}}\nfill: [{water: {depth: "
                      "0.3 m}}]\n" END,
                  3, "tank.chamfer|larger than the tank, 1 x 0.6 m");
    built_refused(TOP "tank: {size: 1 0.6 m}\nfill: [{water: {depth: 0.7 m}}]\n" END, 4,
                  "fill.water.depth|0.7 m is more than the tank is high, 0.6 m");
    built_refused(TOP "tank: {size: 1 0.6 m}\nfill: [{oil: {depth: 0.3 m}}]\n" END, 4,
                  "no fluid has the name 'oil'|known are water and air");
    built_refused(TOP "tank: {size: 1 0.6 m}\nfluids: {lng: {density: 450 kg/m3, viscosity: 0.1 "
                      "mPa s}}\nfill: [{LNG: {depth: 0.3 m}}]\n" END,
                  5, "no fluid has the name 'LNG'; did you mean 'lng'?");
    built_refused(TOP "tank: {size: 1 0.6 m}\nfluids: {oil: {density: 900 kg/m3}}\nfill: [{oil: "
                      "{depth: 0.3 m}}]\n" END,
                  4, "fluids.oil|density and viscosity are needed");
    built_refused(TOP "tank: {size: 1 0.6 m}\nfill: [{water: {box: [2 2 m, 3 3 m]}}]\n" END, 4,
                  "water: ");
    built_refused(TOP BOX "model: mmps\n" END, 5, "'mmps' is for several fluids|air: rest");
    built_refused(
        TOP
        "tank: {size: 1 0.6 m}\nfill: [{water: {depth: 0.3 m}}, {air: rest}]\nmodel: imps\n" END,
        5, "'imps' is for one liquid, 2 are filled in");
    built_refused(TOP BOX "gravity: 0 m/s2\nrun: {until: 2 T1}\n", 6, "T1");
    built_refused(TOP BOX "solids:\n  baffle: {plate: [0.5 0.2 m, 0.5 0.2 m]}\n" END, 6,
                  "solids.baffle.plate|no area");
    built_refused(TOP BOX "solids:\n  baffle: {plate: [0.3 0.1 m, 1.3 0.4 m]}\n" END, 6,
                  "baffle: |plate");
    built_refused(
        TOP BOX
        "solids:\n  baffle: {plate: [0.5 0 m, 0.5 0.2 m], holes: {pitch: 40 mm, open: 40 %}}\n" END,
        6, "solids.baffle.holes|slots of 0.016 m with 0.024 m between|at least 2 dp wide, 0.04 m");
    built_refused(TOP BOX "solids:\n  ball: {sphere: {centre: 5 5 m, radius: 0.1 m}}\n" END, 6,
                  "ball: ");
}

static void motions(void **state)
{
    (void)state;
    built_refused(TOP BOX "motion: {yaw: {amplitude: 1 deg, period: 1 s}}\n" END, 5,
                  "motion.yaw: moves nothing in the plane x, y|without 'motion.forward'");
    built_refused(TOP BOX "motion: {pitch: {amplitude: 1 deg, period: 1 s}}\n" END, 5,
                  "motion.pitch: moves nothing|give 'forward: x'");
    built_refused(TOP BOX "motion: {forward: x, roll: {amplitude: 1 deg, period: 1 s}}\n" END, 5,
                  "motion.roll: moves nothing|along x:|give 'forward: z'");
    built_refused(TOP BOX "motion: {forward: -x, sway: {amplitude: 1 mm, period: 1 s}}\n" END, 5,
                  "motion.sway: moves nothing|surge (along x)");
    built_refused(TOP BOX "motion: {forward: z, surge: {amplitude: 1 mm, period: 1 s}}\n" END, 5,
                  "motion.surge: moves nothing|along z:|sway (along x)");
    built_refused(TOP BOX "motion: {surge: {amplitude: 1 mm, period: 1 s}, sway: {amplitude: 1 mm, "
                          "period: 1 s}}\n" END,
                  5, "motion.sway: is the same motion as 'surge'");
    built_refused(TOP BOX "motion: {surge: {period: 1 s}}\n" END, 5, "surge|amplitude");
    built_refused(TOP BOX "motion: {centre: 0 0 m}\n" END, 5, "motion: no degree is given");
    built_refused(SPACE
                  "motion: {order: yaw yaw roll, roll: {amplitude: 1 deg, period: 1 s}}\n" END,
                  6, "motion.order|each once");
}

/* A table with an error in it, by its line; header lines count. */
static void table_refused_in(const char *head, const char *table, const char *keys,
                             const char *words)
{
    char path[600], text[1600];
    const int fd = mkstemp(kit_here(path, sizeof path, "mps_table_XXXXXX"));
    assert_true(fd >= 0);
    assert_int_equal(write(fd, table, strlen(table)), strlen(table));
    close(fd);
    snprintf(text, sizeof text, "%smotion:\n  file: %s\n  %s\n" END, head, path, keys);
    built t;
    bool found = false;
    assert_int_not_equal(built_try(&t, text, NULL), MPS_OK);
    for (int32_t i = 0; i < mps_case_message_count(t.c); i++) {
        mps_case_message m = {.struct_size = sizeof m};
        assert_int_equal(mps_case_message_get(t.c, i, &m), MPS_OK);
        found = found || (kit_has(t.c, 0, 0, words) && m.line >= 5);
    }
    char *all = kit_messages(t.c);
    if (!found) fail_msg("%s; messages:\n%s", words, all);
    free(all);
    built_free(&t);
    unlink(path);
}

static void table_refused(const char *table, const char *keys, const char *words)
{
    table_refused_in(SPACE, table, keys, words);
}

/* Six columns of a ship in a section of it. */
static void tables_in_2d(void **state)
{
    static const char all[] = "t[s],surge[m],roll[deg],pitch[deg]\n0,1,1,1\n2,2,1,1\n";
    (void)state;
    table_refused_in(TOP BOX, all, "start: rest", "motion.pitch: moves nothing in the plane x, y");
    table_refused_in(TOP BOX, all, "forward: x", "motion.roll: moves nothing in the plane x, y");
    table_refused_in(TOP BOX, "t[s],surge[m],sway[m]\n0,1,1\n2,2,1\n", "start: rest",
                     "motion.sway: is the same motion as 'surge'");
}

static void tables(void **state)
{
    static const char axes[] = "axes: x forward, y port, z up";
    (void)state;
    table_refused("t[s],roll[deg]\n0,1\n1,2\n2,abc\n3,4\n", axes,
                  ":4: column 'roll': 'abc' is not a number");
    table_refused("t[s],roll[deg]\n0,1\n1,2,3\n", axes,
                  ":3: more numbers than the header has names, 2");
    table_refused("t[s],roll[deg]\n0,1\n1\n", axes, ":3: column 'roll': ''");
    table_refused("t[s],roll[deg]\n0,1\n2,2\n2,3\n", axes,
                  ":4: the time 2 s is not later than that before it, 2 s");
    table_refused("t[s],roll[deg]\n0,1\n0.5,2\n", axes,
                  "times from 0 s to 0.5 s|the run takes 0 s to 1 s");
    table_refused("t[s],roll\n0,1\n2,2\n", axes, "column 'roll' has no unit|'roll[deg]'|an angle");
    table_refused("t[s],sway,roll[deg]\n0,1,1\n2,2,1\n", axes,
                  "column 'sway' has no unit|'sway[m]'|a length");
    table_refused("t[s],roll[m]\n0,1\n2,2\n", axes, "the unit 'm', an angle is wanted");
    table_refused("t[s],PHI[deg]\n0,1\n2,2\n", axes, "motion.columns is needed|t, PHI");
    table_refused("t[s],PHI[deg]\n0,1\n2,2\n",
                  "axes: x forward, y port, z up\n  columns: {roll: PHO}",
                  "'PHO' is no column|t, PHI");
    table_refused("t[s],roll[deg]\n0,1\n2,2\n", "start: rest", "motion.axes is needed");
    table_refused("t[s],roll[deg]\n", axes, "has no numbers");
}

/* ---- columns ---- */

/* With a job, whose columns are refused at the line of the sensor. */
static void sensor_refused(const char *text, int32_t line, const char *words)
{
    char *report = NULL, *sketch = NULL;
    mps_case *c = NULL;
    bool found = false;
    kit_read(text, NULL, &c);
    if (!mps__case_failed(c)) assert_int_equal(mps_case_check(c, &report, &sketch), MPS_E_ARG);
    assert_null(report);
    assert_null(sketch);
    for (int32_t column = 1; column < 200 && !found; column++)
        found = kit_has(c, line, column, words);
    char *all = kit_messages(c);
    if (!found) fail_msg("line %d, %s; messages:\n%s", (int)line, words, all);
    free(all);
    mps_case_destroy(c);
}

static void sensors(void **state)
{
    (void)state;
    sensor_refused(TOP BOX "sensors:\n  P: {wall: 0.5 0.3 m}\n" END, 6, "sensors.P: |wall");
    sensor_refused(TOP BOX "sensors:\n  P: {wall: -1 0.3 m}\n" END, 6, "x of its place is -1");
    sensor_refused(TOP BOX "sensors:\n  P: {wall: 0 0.3 m, normal: -1 0}\n" END, 6,
                   "looks along 'normal'");
    sensor_refused(TOP BOX "sensors:\n  F: {force: funnel}\n" END, 6, "sensors.F|funnel");
    sensor_refused(TOP BOX "sensors:\n  F: {force: tank, component: z}\n" END, 6,
                   "in 2-D there are x, y and mz");
    sensor_refused(TOP BOX "sensors:\n  c: {measure: centre, fluid: oil}\n" END, 6,
                   "no fluid with the name 'oil'");
    sensor_refused(TOP BOX "sensors:\n  P: {pressure: 0.1 0.1 m, diameter: 1 mm, drops: yes}\n" END,
                   6, "'sensors.P.drops' has no effect here");
    sensor_refused(
        TOP BOX "motion: {surge: {amplitude: 1 mm, period: 1 s, form: cosine, phase: 3 deg}}\n" END,
        5, "phase");
    sensor_refused(TOP BOX "motion: {order: yaw pitch roll, roll: {amplitude: 1 deg, period: 1 "
                           "s}}\n" END,
                   5, "'motion.order' has no effect here");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(objects), cmocka_unit_test(motions),
                                       cmocka_unit_test(tables), cmocka_unit_test(tables_in_2d),
                                       cmocka_unit_test(sensors)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

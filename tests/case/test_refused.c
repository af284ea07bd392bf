/* SPDX-License-Identifier: BSD-3-Clause */
/* An object that cannot be built gives a message at its line. */
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
    built_refused(TOP "tank: {size: 1 0.6 m}\nfluids: {oil: {viscosity: 1 mPa s}}\nfill: [{oil: "
                      "{depth: 0.3 m}}]\n" END,
                  4, "fluids.oil: 'density' is missing");
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

/* Sides that cross, touch or coincide, in tanks, solids and fills. */
static void crossed_polygons(void **state)
{
    (void)state;
    built_refused(TOP "tank: {polygon: [0 0 m, 0.8 0.5 m, 0.8 0 m, 0 0.5 m]}\nfill: [{water: "
                      "{depth: 0.2 m}}]\n" END,
                  3,
                  "tank.polygon: |from (0, 0) to (0.8, 0.5) m|from (0.8, 0) to (0, 0.5) m|"
                  "at (0.4, 0.25) m|order");
    built_refused(TOP "tank:\n  polygon:\n    - 0 0 m\n    - 1 0 m\n    - 1 1 m\n    - 0.5 0 m\n"
                      "    - 0 1 m\nfill: [{water: {depth: 0.2 m}}]\n" END,
                  5, "tank.polygon: |at (0.5, 0) m");
    built_refused(TOP "tank: {polygon: [0 0 m, 1 0 m, 0.4 0 m, 0.4 1 m]}\nfill: [{water: "
                      "{depth: 0.2 m}}]\n" END,
                  3, "tank.polygon: |meets the side");
    built_refused(TOP "tank: {polygon: [0 0 m, 1 0 m, 1 0 m, 0 0 m]}\nfill: [{water: "
                      "{depth: 0.2 m}}]\n" END,
                  3, "tank.polygon: 2 of 4 points differ");
    built_refused(TOP BOX "solids:\n  s: {prism: [0.2 0 m, 0.6 0.3 m, 0.6 0 m, 0.2 0.3 m]}\n" END,
                  6, "solids.s.prism: |meets the side");
    built_refused(TOP "tank: {size: 1 0.6 m}\nfill: [{water: {polygon: [0 0 m, 1 0.5 m, 1 0 m, 0 "
                      "0.5 m]}}]\n" END,
                  4, "polygon: |meets the side");
}

/* The first point again at the end closes a polygon. */
static void closed_polygon(void **state)
{
    built t;
    (void)state;
    built_make(&t,
               TOP "tank: {polygon: [0 0 m, 1 0 m, 1 0.5 m, 0 0.5 m, 0 0 m]}\nfill: [{water: "
                   "{depth: 0.2 m}}]\n" END,
               NULL);
    assert_int_equal(t.b.tank.form.points, 4);
    built_free(&t);
}

/* Liquid beyond the domain is lost in the first step: a warning, and an error if none is left. */
static void domain_cuts(void **state)
{
    built t;
    (void)state;
    built_make(&t, TOP "domain: [0 0 m, 1 0.25 m]\n" BOX END, NULL);
    assert_true(kit_has(t.c, 3, 9, "of 735 particles of the fill are outside|first step"));
    built_free(&t);
    built_make(&t, TOP "domain: [0 0 m, 1 0.6 m]\n" BOX END, NULL);
    assert_int_equal(mps_case_message_count(t.c), 0);
    built_free(&t);
    built_refused(TOP "domain: [2 0 m, 3 0.6 m]\n" BOX END, 3, "735 of 735 particles");
}

/* Tanks, fills and solids that are not whole, or are two at once. */
static void shapes(void **state)
{
#define WATER  "fill: [{water: {depth: 0.3 m}}]\n"
#define DEEP   "mps: 1\ndim: 3\ndp: 0.2 m\n"
#define SOLIDS TOP BOX "solids:\n  s: "
    (void)state;
    built_refused(TOP "tank: {size: 1 m}\n" WATER END, 3, "tank.size: 1 number, 2 are wanted");
    built_refused(TOP "tank: {at: 0 0 m}\n" WATER END, 3,
                  "tank: one of these keys is missing: size, polygon, cylinder, sphere, stl");
    built_refused(TOP "tank: {size: 1 1 m, sphere: {radius: 1 m}}\n" WATER END, 3,
                  "tank: 'size' and 'sphere' exclude each other; remove one");
    built_refused(TOP "tank: {polygon: [0 0 m, 1 0 m]}\n" WATER END, 3,
                  "tank.polygon: 2 points, 3 to 1000 are wanted");
    built_refused(TOP "tank: {polygon: [0 0 m, 1 0 m, 1 m]}\n" WATER END, 3,
                  "tank.polygon.3: 1 number, 2 are wanted");
    built_refused(DEEP "tank: {polygon: [0 0 m, 1 0 m, 1 m], width: 1 m}\n" WATER END, 4,
                  "tank.polygon.3: 1 number, 2 are wanted");
    built_refused(DEEP "tank: {polygon: [0 0 m, 1 0 m, 1 1 m]}\n" WATER END, 4,
                  "tank.width: is needed in 3-D, e.g. '2 m'");
    built_refused(DEEP "tank: {cylinder: {radius: 1 m}}\n" WATER END, 4,
                  "tank.cylinder.length: is needed in 3-D");
    built_refused(TOP "tank: {size: 1 1 m, open: x0}\n" WATER END, 3,
                  "tank.open: of a box only the top can be open");
    built_refused(TOP "tank: {sphere: {radius: 1 m}, open: top}\n" WATER END, 3,
                  "tank.open: only a rectangular tank can be open at its top");
    built_refused(DEEP "tank: {stl: " CASES "cube.stl}\n" WATER END, 4,
                  "tank.stl: 'unit' is missing beside it, e.g. 'unit: mm'");
    built_refused(DEEP "tank: {stl: " CASES
                       "cube.stl, unit: m, up: z, turn: 0 90 0 deg}\n" WATER END,
                  4, "give 'up' or 'turn', not both");
    built_refused(TOP "tank: {size: 1 0.6 m}\nfill: [{water: {whole_rows: yes}}]\n" END, 4,
                  "fill.water: one of these keys is missing: depth, box, polygon, sphere, wave");
    built_refused(
        TOP "tank: {size: 1 0.6 m}\nfill: [{water: {depth: 0.2 m, box: [0 0 m, 1 0.1 m]}}]\n" END,
        4, "fill.water: 'depth' and 'box' exclude each other");
    built_refused(TOP "tank: {size: 1 0.6 m}\nfill: [{water: {box: [0 0 m]}}]\n" END, 4,
                  "fill.water.box: 1 points, 2 are wanted");
    built_refused(TOP "tank: {size: 1 0.6 m}\nfill: [{water: {box: [0 0 m, 1 1 m, 2 2 m]}}]\n" END,
                  4, "fill.water.box: 3 points, 2 are wanted");
    built_refused(TOP "tank: {size: 1 0.6 m}\nfill: [{water: {polygon: [0 0 m, 1 0 m]}}]\n" END, 4,
                  "fill.water.polygon: 2 points, 3 to 1000 are wanted");
    built_refused(TOP "tank: {polygon: [0 0 m, 1 0 m, 1 1 m]}\nfill: [{water: {depth: 0.3 m, "
                      "start: {standing_wave: 5 mm}}}]\n" END,
                  4, "a standing wave is for rectangular tanks in 2-D");
    built_refused(TOP "tank: {size: 1 0.6 m}\nfill: [{water: {sphere: {centre: 0.5 0.3 m, radius: "
                      "0.2 m}, start: {oscillation: 5 %}}}]\n" END,
                  4, "an oscillation is for 'sphere' in 2-D and two fluids");
    built_refused(
        SOLIDS "{thickness: 1 dp}\n" END, 6,
        "solids.s: one of these keys is missing: box, plate, prism, sphere, cylinder, stl");
    built_refused(SOLIDS "{box: [0 0 m, 0.1 0.1 m], plate: [0 0 m, 0 1 m]}\n" END, 6,
                  "solids.s: 'box' and 'plate' exclude each other");
    built_refused(SOLIDS "{box: [0 0 m]}\n" END, 6, "solids.s.box: 1 points, 2 are wanted");
    built_refused(SOLIDS "{plate: [0 0 m]}\n" END, 6,
                  "solids.s.plate: 1 points, 2 to 3 are wanted");
    built_refused(SOLIDS "{prism: [0 0 m, 0.1 0 m]}\n" END, 6,
                  "solids.s.prism: 2 points, 3 to 1000 are wanted");
    built_refused(SOLIDS "{stl: " CASES "cube.stl}\n" END, 6,
                  "solids.s.stl: 'unit' is missing beside it, e.g. 'unit: mm'");
    built_refused(SPACE
                  "solids:\n  s: {cylinder: {from: 1 0 0 m, to: 1 0 0 m, radius: 0.3 m}}\n" END,
                  7, "solids.s.cylinder: has no length: 'from' and 'to' are one point");
    built_refused(TOP "tank: {size: 1 0.6 m}\nfill: []\n" END, 4, "fill");
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
    built_refused(TOP BOX "motion: {surge: {amplitude: 1 mm}}\n" END, 5,
                  "motion.surge: one of these keys is missing: omega, period, frequency");
    built_refused(TOP BOX "motion: {surge: {amplitude: 1 mm, period: 1 s, omega: 2 rad/s}}\n" END,
                  5, "motion.surge: |omega|period");
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
                  ":4: column 'roll': 'abc' is no number");
    table_refused("t[s],roll[deg]\n0,1\n1,2,3\n", axes,
                  ":3: has 3 values, the line of names has 2");
    table_refused("t[s],roll[deg]\n0,1\n1\n", axes, ":3: has 1 value, the line of names has 2");
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

/* Refusals of sensors with many positions. */
static void rows_of_sensors(void **state)
{
#define DEEP_SENSOR SPACE "sensors:\n  P: "
    (void)state;
    sensor_refused(TOP BOX "sensors:\n  P: {panel: [0 0.1 m, 0 0.2 m, 0 0.3 m], cells: 2}\n" END, 6,
                   "sensors.P.panel: needs its two ends");
    sensor_refused(DEEP_SENSOR "{panel: [0 0.1 0.1 m], cells: 2}\n" END, 7,
                   "sensors.P.panel: 1 points, 2 to 4 are wanted");
    sensor_refused(DEEP_SENSOR "{panel: [0 0.1 0.1 m, 1 0.5 0.5 m], cells: 2}\n" END, 7,
                   "of an inclined one give three corners in turn");
    sensor_refused(DEEP_SENSOR "{panel: [0 0.1 m, 0 0.3 m], cells: 2}\n" END, 7,
                   "sensors.P.panel: a corner needs x, y and z in 3-D");
    sensor_refused(DEEP_SENSOR "{panel: [0 0.1 0.1 m, 0 0.3 0.1 m], cells: 2}\n" END, 7,
                   "two points in 3-D are opposite corners, which differ along two axes");
    sensor_refused(DEEP_SENSOR "{panel: [0 0.1 0.1 m, 0 0.5 0.5 m], cells: 40 40}\n" END, 7,
                   "sensors.P.cells: more than 1000 in all");
    sensor_refused(TOP BOX "sensors:\n  P: {row: [0 0.1 m], cells: 2}\n" END, 6,
                   "sensors.P.row: 1 points, 2 are wanted");
    sensor_refused(TOP BOX "sensors:\n  P: {average: 2 ms}\n" END, 6,
                   "sensors.P: one of these keys is missing: wall, panel, row");
    sensor_refused(TOP BOX "sensors:\n  P: {wall: 0 0.1 m, pressure: 0.1 0.1 m}\n" END, 6,
                   "sensors.P: 'wall' and 'pressure' exclude each other");
    sensor_refused(TOP BOX "sensors:\n  F: {force: tank, axes: ship}\n" END, 6,
                   "are for 3-D and a motion");
    sensor_refused(DEEP_SENSOR "{force: tank, axes: ship}\n" END, 7, "are for 3-D and a motion");
}

/* A file of known points with this text, and further keys. */
static void reference_refused(const char *table, const char *keys, const char *words)
{
    char path[600], text[1600];
    const int fd = mkstemp(kit_here(path, sizeof path, "mps_known_XXXXXX"));
    assert_true(fd >= 0);
    assert_int_equal(write(fd, table, strlen(table)), strlen(table));
    close(fd);
    snprintf(text, sizeof text, TOP BOX "reference:\n  known: {file: %s%s}\n" END, path, keys);
    sensor_refused(text, 6, words);
    unlink(path);
}

static void references(void **state)
{
    (void)state;
    sensor_refused(TOP BOX "reference:\n  known: {times: 1 2 s, values: 1 2 3 mm}\n" END, 6,
                   "2 times, but 3 values");
    reference_refused("t[s],p[Pa]\n1,2\n", ", columns: [t, q]", "'q' is no column of|t, p");
    reference_refused("t[s]\n1\n", "", "has one column, two are needed");
    reference_refused("t,p[Pa]\n1,2\n", "", "column 't' has no unit");
    reference_refused("t[s],p\n1,2\n", "", "column 'p' has no unit");
    sensor_refused(TOP BOX "reference:\n  known: {file: /none/there.csv}\n" END, 6,
                   "'/none/there.csv' cannot be read: No such file or directory");
    sensor_refused(TOP BOX "figures:\n  peak: {column: w}\n" END, 6,
                   "figures.peak: key 'take' is missing");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shapes),           cmocka_unit_test(rows_of_sensors),
        cmocka_unit_test(references),       cmocka_unit_test(objects),
        cmocka_unit_test(crossed_polygons), cmocka_unit_test(closed_polygon),
        cmocka_unit_test(domain_cuts),      cmocka_unit_test(motions),
        cmocka_unit_test(tables),           cmocka_unit_test(tables_in_2d),
        cmocka_unit_test(sensors)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

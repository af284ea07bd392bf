/* SPDX-License-Identifier: BSD-3-Clause */
/* Messages: all at once, ordered by position, in the format of a compiler; similar keys; rules
 * between keys. */
#include "case_kit.h"

#define HEAD "mps: 1\ndp: 4 mm\n"
#define BODY "tank: {size: 0.8 0.5 m}\nfill: [{water: {depth: 0.25 m}}]\nrun: {until: 5 s}\n"

static void accepted(const char *text, const char *const *sets)
{
    mps_case *c = NULL;
    const mps_status status = kit_read(text, sets, &c);
    char *all = kit_messages(c);
    if (status != MPS_OK) fail_msg("%s\n%s", text, all);
    free(all);
    mps_case_destroy(c);
}

static void said(const char *text, const char *const *sets, const char *wanted)
{
    mps_case *c = NULL;
    assert_int_equal(kit_read(text, sets, &c), MPS_E_ARG);
    char *all = kit_messages(c);
    if (!strstr(all, wanted)) fail_msg("wanted:\n%s\nmessages:\n%s", wanted, all);
    free(all);
    mps_case_destroy(c);
}

static void printed(void **state)
{
    static const char *const set[] = {"run.until=60", NULL};
    mps_case *c = NULL;
    (void)state;
    accepted(HEAD BODY, NULL);
    const char *text = HEAD "sensors:\n  P: {wal: 0 50 mm}\n" BODY;
    assert_int_equal(mps_case_read_text(text, strlen(text), "a.yaml", 1, set, &c), MPS_E_ARG);
    char *all = kit_messages(c);
    assert_string_equal(
        all,
        "a.yaml:4:3: error: sensors.P: one of these keys is missing: wall, panel, row, pressure, "
        "gauge, force, load, measure\n"
        "    4 |   P: {wal: 0 50 mm}\n"
        "      |   ^\n"
        "a.yaml:4:7: error: unknown key 'sensors.P.wal'; did you mean 'wall'?\n"
        "    4 |   P: {wal: 0 50 mm}\n"
        "      |       ^\n"
        "--set run.until=60: error: run.until: '60' has no unit; a time is wanted, e.g. '60 s' or "
        "'60 T1'\n");
    free(all);
    mps_case_destroy(c);
}

/* Columns count characters, and a long line is truncated around its position. */
static void columns(void **state)
{
    char text[2000];
    (void)state;
    said(HEAD "title: \"M\xc3\xb6we\"\ntank: {\"gr\xc3\xb6\xc3\x9f"
              "e\": 1 m, size: 1 1 m}\n"
              "fill: [{water: {depth: 1 m}}]\nrun: {until: 1 s}\n",
         NULL,
         "test.yaml:4:8: error: unknown key 'tank.gr\xc3\xb6\xc3\x9f"
         "e'");
    snprintf(text, sizeof text, HEAD "run: {%*suntil: 5 s, untl: 6 s}\n%s", 400, "",
             "model: imps\n");
    mps_case *c = NULL;
    assert_int_equal(kit_read(text, NULL, &c), MPS_E_ARG);
    char *all = kit_messages(c);
    assert_non_null(strstr(all, "test.yaml:3:419: error: unknown key 'run.untl'"));
    const char *line = strstr(all, "    3 |");
    assert_true(strcspn(line, "\n") < 220);
    const char *caret = strchr(line, '\n') + 1;
    assert_int_equal(line[strcspn(caret, "^")], 'u');
    free(all);
    mps_case_destroy(c);
}

static void twenty_at_most(void **state)
{
    char text[4000] = HEAD BODY "sensors:\n";
    mps_case *c = NULL;
    int32_t line = 0;
    (void)state;
    for (int k = 0; k < 30; k++) sprintf(text + strlen(text), "  P%d: {wall: 3}\n", k);
    assert_int_equal(kit_read(text, NULL, &c), MPS_E_ARG);
    assert_int_equal(mps_case_message_count(c), MPS_CASE_MESSAGES);
    for (int32_t k = 0; k < MPS_CASE_MESSAGES; k++) {
        mps_case_message m = {.struct_size = sizeof m};
        assert_int_equal(mps_case_message_get(c, k, &m), MPS_OK);
        assert_true(m.line > line);
        assert_int_equal(m.line, 7 + k); /* the first ones of the file */
        line = m.line;
    }
    mps_case_destroy(c);
}

/* 'collect' names sensors or columns of each run; no sensor has the name of such a column. */
static void column_names(void **state)
{
#define SENSORS "sensors: {P: {wall: 0 50 mm}, F: {force: tank}}\n"
    (void)state;
    accepted(HEAD BODY SENSORS "collect: [P.max, F.harmonic, F_x.p3h, ke.max, wall_work.last]\n",
             NULL);
    accepted(HEAD BODY SENSORS "collect: [roll.harmonic, body_liquid_roll.max]\n", NULL);
    accepted(HEAD BODY "sensors: {surge: {wall: 0 50 mm}}\n", NULL);
    said(HEAD BODY SENSORS "collect: [P.max, Q.max]\n", NULL,
         "collect: no sensor is 'Q'; there are P, F");
    said(HEAD BODY "collect: Q.max\n", NULL, "collect: no sensor is 'Q'\n");
    said(HEAD BODY "sensors: {ke: {wall: 0 50 mm}}\n", NULL,
         "sensors.ke: probes.csv has a column 'ke', which each run writes; choose another name");
    said(HEAD BODY "sensors: {t: {wall: 0 50 mm}}\n", NULL, "has a column 't'");
    said(HEAD BODY "motion: {roll: {amplitude: 1 deg, period: 1 T1}}\n"
                   "sensors: {roll: {wall: 0 50 mm}}\n",
         NULL, "sensors.roll: probes.csv has a column 'roll', of the motion");
}

static void near_keys(void **state)
{
    (void)state;
    said(HEAD BODY "sensor: {}\n", NULL, "unknown key 'sensor'; did you mean 'sensors'?");
    said(HEAD BODY "motion: {rol: {amplitude: 1 deg}}\n", NULL, "did you mean 'roll'?");
    said(HEAD BODY "motion: {surge: {amplitude: 1 m, omga: 2 rad/s}}\n", NULL, "'omega'");
    said(HEAD BODY "output: {checkpoint: 2 s}\n", NULL,
         "unknown key 'output.checkpoint'; 'checkpoint' is a key of 'run'");
    said(HEAD BODY "xyzzy: 3\n", NULL, "unknown key 'xyzzy'\n");
    said(HEAD BODY "model: imsp\n", NULL, "no preset of models 'imsp'; did you mean 'imps'?");
    said(HEAD BODY "model: sph\n", NULL, "no preset of models 'sph'; there are imps");
    said(HEAD BODY "use: drag.cubic\n", NULL, "no model 'drag.cubic'; 'mps list models'");
    said(HEAD BODY "kernel: {name: foo}\n", NULL, "kernel.name: no kernel 'foo'; there are ");
    static const char *const solver[] = {"run.solver=foo", NULL};
    said(HEAD BODY, solver, "run.solver: no pressure solver 'foo'; there are ");
    said(HEAD BODY "use: viscosity.pairs\n", NULL, "did you mean 'viscosity.pair'?");
    said(HEAD BODY "remove: [colision]\n", NULL, "did you mean 'collision'?");
    said(HEAD BODY "settings: {gas.sound: 5 Pa}\n", NULL,
         "'Pa' is the unit of a pressure; a velocity");
    said(HEAD BODY "settings: {gas.sound: -5 m/s}\n", NULL, "is out of its range");
    said(HEAD BODY "settings: {gas.sond: 5 m/s}\n", NULL, "did you mean 'gas.sound'?");
    said("mps: 1\ndp: 4 mm\ntank: {size: 1 1 m}\nfill: [{water: {depth: 1 m}}]\n"
         "run: {until: 1 s, solver: sundials.pgc}\n",
         NULL, "did you mean 'sundials.pcg'?");
}

static void rules(void **state)
{
    (void)state;
    said("dp: 4 mm\n" BODY, NULL, "key 'mps' is missing, e.g. 'mps: 1'");
    said("mps: 2\ndp: 4 mm\n" BODY, NULL,
         "mps: version 2 is out of its range: this program reads version 1");
    said(HEAD "tank: {size: 1 1 m, polygon: [0 0 m, 1 0 m, 1 1 m]}\n", NULL,
         "tank: 'size' and 'polygon' exclude each other; remove one");
    said(HEAD "tank: {chamfer: {}}\n", NULL, "one of these keys is missing: size, polygon");
    said(HEAD BODY "motion: {roll: {amplitude: 1 deg, period: 1 s, omega: 1 rad/s}}\n", NULL,
         "exclude each other");
    said(HEAD BODY "motion: {roll: {amplitude: 1 deg}}\n", NULL,
         "motion.roll: one of these keys is missing: omega, period");
    said(HEAD BODY "reference: {a: {times: 1 2 s}}\n", NULL, "'values' is missing beside it");
    said(HEAD BODY "solids: {pump: {stl: cube.stl}}\n", NULL, "'unit' is missing beside it");
    said(HEAD BODY "sensors: {1st: {wall: 0 0 m}}\n", NULL, "a letter a to z, A to Z is wanted");
    said(HEAD BODY "sensors: {a.b: {wall: 0 0 m}}\n", NULL, "name 'a.b'");
    said(HEAD "tank: {size: 1 1 m}\nfill: {water: {depth: 1 m}}\n", NULL, "a list of fluids");
    said(HEAD "tank: {size: 1 1 m}\nfill: [{water: rest, air: rest}]\n", NULL, "one fluid");
    said(HEAD "tank: {size: 1 1 m}\nfill: [{water: all}]\n", NULL,
         "a map of keys is wanted, not a text");
    said(HEAD "tank: {size: 1 m}\n", NULL, "tank.size: 1 number, 2 are wanted");
    said("mps: 1\ndp: 1 dp\n" BODY, NULL, "'dp' is not known here");
}

/* JSON is YAML. */
static void json(void **state)
{
    (void)state;
    accepted("{\n\t\"mps\": 1, \"dp\": \"4 mm\",\n\t\"tank\": {\"size\": [\"0.8 m\", \"0.5 m\"]},\n"
             "\t\"fill\": [{\"water\": {\"depth\": \"0.25 m\", \"whole_rows\": true}}],\n"
             "\t\"run\": {\"until\": \"5 s\", \"threads\": 2}\n}\n",
             NULL);
}

static void arguments(void **state)
{
    mps_case *c = (mps_case *)8;
    mps_case_message m = {0};
    mps_case_key key = {.struct_size = sizeof key};
    const char *const sets[] = {NULL};
    (void)state;
    assert_int_equal(mps_case_read(NULL, 0, NULL, &c), MPS_E_ARG);
    assert_null(c);
    assert_int_equal(mps_case_read("x", 0, NULL, NULL), MPS_E_ARG);
    assert_int_equal(mps_case_read("x", -1, NULL, &c), MPS_E_ARG);
    assert_int_equal(mps_case_read("x", 1, NULL, &c), MPS_E_ARG);
    assert_int_equal(mps_case_read("x", 1, sets, &c), MPS_E_ARG);
    assert_int_equal(mps_case_read_text(NULL, 0, "x", 0, NULL, &c), MPS_E_ARG);
    assert_int_equal(mps_case_read_text("x", 1, NULL, 0, NULL, &c), MPS_E_ARG);
    assert_int_equal(mps_case_read_text("x", 1, "x", 0, NULL, NULL), MPS_E_ARG);
    assert_int_equal(mps_case_read("/nowhere/a.yaml", 0, NULL, &c), MPS_E_IO);
    assert_true(kit_has(c, 0, 0, "it cannot be read"));
    assert_int_equal(mps_case_message_get(c, 0, &m), MPS_E_ARG);
    assert_int_equal(mps_case_message_get(c, 0, NULL), MPS_E_ARG);
    m.struct_size = sizeof m;
    assert_int_equal(mps_case_message_get(c, 1, &m), MPS_E_ARG);
    assert_int_equal(mps_case_message_get(NULL, 0, &m), MPS_E_ARG);
    assert_int_equal(mps_case_runs(c), 0);
    mps_case_destroy(c);
    assert_int_equal(mps_case_read("/", 0, NULL, &c), MPS_E_IO);
    mps_case_destroy(c);
    mps_case_destroy(NULL);
    assert_null(mps_case_text(NULL));
    assert_int_equal(mps_case_message_count(NULL), 0);
    assert_int_equal(mps_case_messages_write(NULL, NULL, 0), 0);
    assert_int_equal(mps_case_key_get(0, &key), MPS_OK);
    assert_string_equal(key.path, "mps");
    assert_int_equal(mps_case_key_get(-1, &key), MPS_E_ARG);
    assert_int_equal(mps_case_key_get(mps__keys_count - 1, &key), MPS_E_ARG);
    assert_int_equal(mps_case_key_get(0, NULL), MPS_E_ARG);
    key.struct_size = 3;
    assert_int_equal(mps_case_key_get(0, &key), MPS_E_ARG);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(printed),        cmocka_unit_test(columns),
        cmocka_unit_test(twenty_at_most), cmocka_unit_test(column_names),
        cmocka_unit_test(near_keys),      cmocka_unit_test(rules),
        cmocka_unit_test(json),           cmocka_unit_test(arguments)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

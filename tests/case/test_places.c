/* SPDX-License-Identifier: BSD-3-Clause */
/* All positions are in the frame of the case; lengths do not depend on the position of the tank;
 * mps check and a run agree on the required keys. */
#include "build_kit.h"
#include <mps/job.h>

#define END "run: {until: 0.01 s}\n"

static char *check(const char *text)
{
    mps_case *c = NULL;
    char *all, *sketch;
    if (kit_read(text, NULL, &c) != MPS_OK || mps_case_check(c, &all, &sketch) != MPS_OK)
        fail_msg("%s%s", text, kit_messages(c));
    free(sketch);
    mps_case_destroy(c);
    return all;
}

static void has(const char *text, const char *wanted)
{
    char *all = check(text);
    if (!strstr(all, wanted)) fail_msg("no '%s' in\n%s", wanted, all);
    free(all);
}

/* Refused at this line by the check, with these words. */
static void refused(const char *text, int32_t line, const char *words)
{
    mps_case *c = NULL;
    char *all, *sketch;
    bool found = false;
    if (kit_read(text, NULL, &c) == MPS_OK)
        assert_int_equal(mps_case_check(c, &all, &sketch), MPS_E_ARG);
    for (int32_t column = 1; column < 200 && !found; column++)
        found = kit_has(c, line, column, words);
    if (!found) fail_msg("line %d: %s; messages:\n%s", (int)line, words, kit_messages(c));
    mps_case_destroy(c);
}

static void gauges(void **state)
{
    static const char centred[] = "mps: 1\ndp: 40 mm\ntank: {size: 0.8 0.5 m, at: -0.4 -0.1 m}\n"
                                  "solids: {block: {box: [0.08 -0.1 m, 0.24 0.02 m]}}\n"
                                  "fill: [{water: {depth: 40 %%}}]\nsensors:\n  %s\n" END;
    static const char lying[] = "mps: 1\ndim: 3\ndp: 60 mm\n"
                                "tank: {cylinder: {radius: 0.25 m, length: 0.6 m, heads: 0.25 m}}\n"
                                "fill: [{water: {depth: 50 %%}}]\nsensors:\n  %s\n" END;
    static const char *const good[][2] = {
        {"g: {gauge: 0 m}", "g: gauge at (0, -0.1) m"},
        {"g: {gauge: -0.3 m}", "g: gauge at (-0.3, -0.1) m"},
        {"g: {gauge: -0.4 m}", "g: gauge at (-0.4, -0.1) m"},
        {"g: {gauge: -0.1 0.02 m}", "g: gauge at (-0.1, 0.02) m"},
        {"g: {pressure: -0.1 0.02 m}", "g: pressure at (-0.1, 0.02) m"},
        {"g: {gauge: 0.2 0.04 m}", "g: gauge at (0.2, 0.04) m"},
        {"g: {wall: -0.4 0.34 m}", "0.24 m above the liquid at rest: 0 Pa"}};
    static const char *const bad[][2] = {
        {"g: {gauge: 0.6 m}", "sensors.g.gauge|(0.6, -0.1) m, outside of the tank"},
        {"g: {gauge: 0 -0.2 m}", "(0, -0.2) m, outside of the tank|(-0.4, -0.1) to (0.4, 0.4) m"},
        {"g: {gauge: 0.16 m}", "sensors.g.gauge|within solid 'block'"},
        {"g: {pressure: 0.16 -0.05 m}", "sensors.g.pressure|within solid 'block'"},
        {"g: {pressure: 0.16 -0.15 m}", "sensors.g.pressure|outside of the tank"}};
    char text[700];
    (void)state;
    for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
        snprintf(text, sizeof text, centred, good[k][0]);
        has(text, good[k][1]);
    }
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        snprintf(text, sizeof text, centred, bad[k][0]);
        refused(text, 7, bad[k][1]);
    }
    snprintf(text, sizeof text, lying, "g: {gauge: 0.55 0 m}");
    has(text, "g: gauge at (0.55, 0.015, 0) m");
    snprintf(text, sizeof text, lying, "g: {gauge: 0.55 0.26 m}");
    refused(text, 7, "sensors.g.gauge|outside of the tank");
}

/* A prism of `n` corners along x as an STL file: a lying tube of 24, a box of 4. */
static void write_prism(const char *path, int32_t n, double radius, double turn, const double *span)
{
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fprintf(f, "solid prism\n");
    for (int32_t k = 0; k < 4 * n; k++) {
        double y[2], z[2];
        for (int32_t e = 0; e < 2; e++) {
            const double angle = 2 * 3.14159265358979323846 * (k / 4 + e) / n + turn;
            y[e] = radius * cos(angle), z[e] = radius * sin(angle);
        }
        const double *a = span, *b = span + 1;
        const double corner[4][9] = {{*a, y[0], z[0], *b, y[0], z[0], *b, y[1], z[1]},
                                     {*a, y[0], z[0], *b, y[1], z[1], *a, y[1], z[1]},
                                     {*a, 0, 0, *a, y[0], z[0], *a, y[1], z[1]},
                                     {*b, 0, 0, *b, y[1], z[1], *b, y[0], z[0]}};
        fprintf(f, "facet normal 0 0 0\nouter loop\n");
        for (int32_t v = 0; v < 9; v += 3)
            fprintf(f, "vertex %.9g %.9g %.9g\n", corner[k % 4][v], corner[k % 4][v + 1],
                    corner[k % 4][v + 2]);
        fprintf(f, "endloop\nendfacet\n");
    }
    fprintf(f, "endsolid prism\n");
    fclose(f);
}

/* Tanks and solids of files: the line of a gauge begins where it meets the shell. */
static void gauges_in_files(void **state)
{
    static const char tube[] = "mps: 1\ndim: 3\ndp: 40 mm\ntank: {stl: \"%s\", unit: m}\n"
                               "solids: {block: {stl: \"%s\", unit: m}}\n"
                               "fill: [{water: {depth: 0.27 m}}]\nsensors:\n  %s\n" END;
    static const char *const good[][2] = {
        {"g: {gauge: 0.1 0 m}", "g: gauge at (0.1, -0.25, 0) m"},
        {"g: {gauge: 0.1 -0.1 0.1 m}", "g: gauge at (0.1, -0.1, 0.1) m"},
        {"g: {gauge: 0.3 0.09 0 m}", "g: gauge at (0.3, 0.09, 0) m"},
        {"g: {pressure: 0.44 -0.03 0.03 m}", "g: pressure at (0.44, -0.03, 0.03) m"},
        {"g: {pressure: 0.1 -0.2 0 m}", "g: pressure at (0.1, -0.2, 0) m"}};
    static const char *const bad[][2] = {
        {"g: {gauge: 0.3 0.3 m}", "outside of the tank"},
        {"g: {gauge: 0.1 -0.24 0.2 m}", "sensors.g.gauge|outside of the tank"},
        {"g: {pressure: 0.1 -0.24 0.2 m}", "sensors.g.pressure|outside of the tank"},
        {"g: {gauge: 0.3 -0.03 0 m}", "sensors.g.gauge|within solid 'block'"},
        {"g: {pressure: 0.3 -0.03 0.03 m}", "sensors.g.pressure|within solid 'block'"}};
    char text[1300], shell[300], block[300];
    (void)state;
    kit_here(shell, sizeof shell, "places_tube.stl");
    kit_here(block, sizeof block, "places_block.stl");
    write_prism(shell, 24, 0.25, 0, (const double[]){0, 0.6});
    write_prism(block, 4, 0.08 * sqrt(2), 3.14159265358979323846 / 4, (const double[]){0.2, 0.4});
    for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
        snprintf(text, sizeof text, tube, shell, block, good[k][0]);
        has(text, good[k][1]);
    }
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        snprintf(text, sizeof text, tube, shell, block, bad[k][0]);
        refused(text, 8, bad[k][1]);
    }
    snprintf(text, sizeof text, tube, shell, block, "g: {gauge: 0.1 0.24 m}");
    char *all = check(text), *at = strstr(all, "g: gauge at (0.1, ");
    assert_non_null(at); /* the shell is at y = -.07 m, steep */
    assert_in_range((int)(1000 * (strtod(at + strlen("g: gauge at (0.1, "), NULL) + 0.2)), 70, 160);
    free(all);
}

/* A line of the check from a word on, where the numbers of all shifts are the same. */
static const char *line_of(const char *all, const char *word, char out[200])
{
    const char *at = strstr(all, word);
    assert_non_null(at);
    snprintf(out, 200, "%.*s", at ? (int)strcspn(at, "\n") : 0, at ? at : "");
    return out;
}

static void shifted(void **state)
{
    static const double shifts[] = {0, -0.9, 0.123, 100, -1000};
    static const char *const words[] = {"particles ", "fill of phase", "periods ", "surge: "};
    char first[4][200], now[200], text[900];
    (void)state;
    for (int k = 0; k < 5; k++) {
        const double d = shifts[k];
        snprintf(text, sizeof text,
                 "mps: 1\ndp: 40 mm\ntank: {size: 0.8 0.6 m, at: %.17g %.17g m}\n"
                 "solids: {baffle: {plate: [%.17g %.17g m, %.17g %.17g m]}}\n"
                 "fill: [{water: {depth: %s}}]\nmotion: {centre: %.17g %.17g m, surge: "
                 "{amplitude: 1 cm, period: 1 s}}\n"
                 "sensors: {P: {wall: %.17g %.17g m}, eta: {gauge: %.17g m}}\n" END,
                 d, d, 0.4 + d, 0.1 + d, 0.4 + d, 0.3 + d, k % 2 ? "0.6 m" : "100 %", d, d, d,
                 0.2 + d, 0.1 + d);
        char *all = check(text);
        for (int i = 0; i < 4; i++) {
            line_of(all, words[i], now);
            now[strcspn(now, "(,")] = '\0'; /* positions and rounding follow it */
            if (k == 0) memcpy(first[i], now, sizeof now);
            assert_string_equal(now, first[i]);
        }
        free(all);
    }
}

static void levels(void **state)
{
    (void)state;
    refused("mps: 1\ndp: 40 mm\ntank: {size: 0.8 0.6 m, at: 0 -0.9 m}\nfill: [{water: {depth: "
            "0.61 m}}]\n" END,
            4, "0.61 m is more than the tank is high, 0.6 m");
    refused("mps: 1\ndp: 40 mm\ntank: {size: 0.8 0.6 m, at: 0 1000 m}\nfill: [{water: {depth: "
            "0.601 m}}]\n" END,
            4, "0.601 m is more than the tank is high, 0.6 m");
    has("mps: 1\ndp: 40 mm\ntank: {size: 0.8 0.6 m, at: 12345 0 m}\n"
        "fill: [{water: {depth: 50 %}}]\nsensors: {P: {wall: 12345 0.1 m}}\n" END,
        "at (12345, 0.1) m");
    has("mps: 1\ndp: 40 mm\ntank: {size: 0.8 0.6 m}\nfluids: {sea: {density: 1025 kg/m3}}\n"
        "fill: [{sea: {depth: 50 %}}]\n" END,
        "sea, 1025 kg/m3, 0.001 Pa s");
}

/* Whether a case can be run, without running it. */
static mps_status job_of(mps_case *c)
{
    mps_job_config options;
    mps_job *job = NULL;
    mps_sim *sim = NULL;
    assert_int_equal(mps_job_config_init(&options, sizeof options), MPS_OK);
    options.folder = "test_places_out";
    options.quiet = 1;
    const mps_status status = mps_case_job(c, &options, &job, &sim);
    mps_sim_destroy(sim);
    mps_job_destroy(job);
    return status;
}

/* If any of its lines is removed, a case is refused by the check with a position, or it can be
 * run. */
static void left_out(void **state)
{
    static const char *const cases[] = {
        "mps: 1\ndp: 50 mm\ntank:\n  size: 0.8 0.5 m\n  at: 0 0 m\n  chamfer:\n    bottom: 0.1 m\n"
        "fluids:\n  oil:\n    density: 900 kg/m3\n    viscosity: 1 mPa s\n"
        "fill:\n  - oil:\n      depth: 0.2 m\nmotion:\n  centre: 0.4 0 m\n  surge:\n    amplitude: "
        "5 mm\n    period: 1 T1\nsensors:\n  P:\n    wall: 0 0.2 m\n    diameter: 50 mm\n"
        "figures:\n  top:\n    column: P\n    take: largest\n    until: 0.01 s\n"
        "reference:\n  P:\n    times: 0.1 s\n    values: 1 Pa\n    label: a\nrun:\n  until: 0.01 "
        "s\n",
        "mps: 1\ndim: 3\ndp: 0.1 m\ntank:\n  polygon: [0 0 m, 1 0 m, 0 1 m]\n  width: 0.4 m\n"
        "fill:\n  - water:\n      depth: 0.4 m\nbody:\n  mass: 100 kg\n  inertia: 9 kg m2\n"
        "  roll:\n    period: 1 s\n    load:\n      amplitude: 1 N m\n      period: 1 s\n"
        "solids:\n  ball:\n    sphere:\n      centre: 0.3 0.2 0.2 m\n      radius: 0.1 m\n"
        "run:\n  until: 0.01 s\n"};
    int refusals = 0, others = 0;
    (void)state;
    for (int k = 0; k < 2; k++)
        for (const char *line = cases[k], *next; *line; line = next) {
            char text[1200];
            mps_case *c = NULL, *again = NULL;
            char *all = NULL, *sketch = NULL;
            next = line + strcspn(line, "\n") + 1;
            snprintf(text, sizeof text, "%.*s%s", (int)(line - cases[k]), cases[k], next);
            const mps_status read = kit_read(text, NULL, &c);
            mps_status checked = read, run = read;
            if (read == MPS_OK) {
                checked = mps_case_check(c, &all, &sketch);
                assert_int_equal(kit_read(text, NULL, &again), MPS_OK);
                run = job_of(again);
            }
            if ((checked == MPS_OK) != (run == MPS_OK))
                fail_msg("without '%.*s' the check is %d, the run %d", (int)(next - line - 1), line,
                         checked, run);
            if (checked != MPS_OK) assert_true(mps_case_message_count(c) > 0);
            if (checked == MPS_OK) assert_null(strstr(all, "nan"));
            refusals += checked != MPS_OK;
            others += checked == MPS_OK;
            free(all);
            free(sketch);
            mps_case_destroy(c);
            mps_case_destroy(again);
        }
    assert_true(refusals > 15 && others > 5);
    refused("mps: 1\ndp: 40 mm\ntank: {size: 0.4 0.3 m}\nfill: [{water: {depth: 0.15 m}}]\n", 1,
            "key 'run' is missing, e.g. 'run: {until: 60 T1}'");
    refused("mps: 1\ndp: 40 mm\nfill: [{water: {depth: 0.15 m}}]\n" END, 1,
            "key 'tank' is missing");
}

/* Errors of parts that do not need each other are reported in one round. */
static void one_round(void **state)
{
    static const char text[] =
        "mps: 1\ndp: 40 mm\ntank: {size: 0.8 0.6 m}\nfill: [{water: {depth: 0.7 m}}]\n"
        "motion: {surge: {amplitude: 1 cm, period: 1 T1}, sway: {amplitude: 1 cm, period: 1 s}}\n"
        "sensors:\n  a: {gauge: 2 m}\n  b: {gauge: -2 m}\n"
        "reference: {p: {times: 1 2 s, values: 1 Pa}}\n" END;
    static const int lines[] = {4, 5, 7, 8, 9};
    mps_case *c = NULL;
    char *all, *sketch;
    (void)state;
    assert_int_equal(kit_read(text, NULL, &c), MPS_OK);
    assert_int_equal(mps_case_check(c, &all, &sketch), MPS_E_ARG);
    for (int k = 0; k < 5; k++) {
        bool found = false;
        for (int32_t column = 1; column < 120; column++)
            found = found || kit_has(c, lines[k], column, "");
        if (!found) fail_msg("nothing about line %d:\n%s", lines[k], kit_messages(c));
    }
    if (mps_case_message_count(c) != 5) fail_msg("%s", kit_messages(c));
    mps_case_destroy(c);
}

/* Messages that name what is wrong. */
static void words(void **state)
{
#define TOP  "mps: 1\ndp: 40 mm\ntank: {size: 0.8 0.6 m}\n"
#define FILL "fill: [{water: {depth: 0.3 m}}]\n"
    char *all;
    mps_case *c = NULL;
    char *sketch;
    (void)state;
    refused("mps: 2\ndp: 40 mm\ntank: {size: 0.8 0.6 m}\n" FILL END, 1,
            "version 2 is out of its range|this program reads version 1");
    refused(TOP "fill: []\n" END, 4, "a list of fluids is wanted, not an empty list");
    refused(TOP FILL "sweep: {}\n" END, 5, "not an empty map");
    refused(TOP FILL "sensors: {\"dr\xc3\xbc"
                     "ck\": {wall: 0 0.1 m}}\n" END,
            5, "a letter a to z");
    refused(TOP FILL "motion: {axes: x forward, y port, z up, roll: {amplitude: 1 deg, period: 1 "
                     "s}}\n" END,
            5, "motion.axes: a text with commas needs quotes|axes: 'x forward, y port, z up'");
    assert_int_equal(kit_read(TOP FILL "motion: {axes: x forward, y port, z up}\n" END, NULL, &c),
                     MPS_E_ARG);
    assert_int_equal(mps_case_message_count(c), 1);
    mps_case_destroy(c);
    assert_int_equal(
        kit_read(TOP FILL "motion: {surge: {amplitude: 2 km, period: 1 s}}\n" END, NULL, &c),
        MPS_OK);
    assert_int_equal(mps_case_check(c, &all, &sketch), MPS_E_ARG); /* its first steps fail */
    if (!kit_has(c, 0, 0, "surge of|times the size of the tank|unit"))
        fail_msg("%s", kit_messages(c));
    free(all);
    free(sketch);
    mps_case_destroy(c);
    /* characters that YAML regards as line breaks are preserved */
    assert_int_equal(kit_read(TOP FILL "title: \"a\\x85"
                                       "b\\u2028c\\u009fd\"\n" END,
                              NULL, &c),
                     MPS_OK);
    all = strdup(mps_case_text(c));
    mps_case_destroy(c);
    assert_int_equal(kit_read(all, NULL, &c), MPS_OK);
    assert_string_equal(all, mps_case_text(c));
    assert_null(strstr(all, "\xc2\x85"));
    assert_non_null(strstr(all, "\\x85"));
    free(all);
    mps_case_destroy(c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gauges), cmocka_unit_test(gauges_in_files), cmocka_unit_test(shifted),
        cmocka_unit_test(levels), cmocka_unit_test(left_out),        cmocka_unit_test(one_round),
        cmocka_unit_test(words)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

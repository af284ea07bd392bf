/* SPDX-License-Identifier: BSD-3-Clause */
/* Rarely used features of cases: many columns, solids and fluids, references of angles, a fill
 * without a level, a list of models. */
#include "case_kit.h"
#include "job_fixture.h"
#include <mps/case.h>

#define TANK  "mps: 1\ndp: 50 mm\ntank: {size: 1 0.6 m}\n"
#define WATER "fill: [{water: {depth: 0.3 m}}]\n"
#define END   "run: {until: 8 ms, dt: 4 ms, threads: 1}\n"

/* Output of a check, with its messages; the caller frees it. */
static char *logged(const char *case_text)
{
    mps_case *c = NULL;
    char *text = NULL, *sketch = NULL;
    if (kit_read(case_text, NULL, &c) == MPS_OK) mps_case_check(c, &text, &sketch);
    char *all = kit_messages(c);
    const size_t size = strlen(all) + (text ? strlen(text) : 0) + 1;
    char *both = malloc(size);
    assert_non_null(both);
    snprintf(both, size, "%s%s", text ? text : "", all);
    free(all);
    free(text);
    free(sketch);
    mps_case_destroy(c);
    return both;
}

static void tells(const char *case_text, int count, const char *const *words)
{
    char *text = logged(case_text);
    for (int k = 0; k < count; k++)
        if (!strstr(text, words[k])) fail_msg("wanted: %s\n%s", words[k], text);
    free(text);
}
#define TELLS(text, ...)                                                            \
    tells(text, (int)(sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *)), \
          (const char *const[]){__VA_ARGS__})

/* Limits of numbers of items in a case, reported at the first one beyond. */
static void too_many(void **state)
{
    char text[8000];
    (void)state;
    size_t used = (size_t)snprintf(text, sizeof text,
                                   "mps: 1\ndp: 50 mm\ntank: {size: 7 0.6 m}\n" WATER "solids:\n");
    for (int k = 0; k < 65; k++)
        used += (size_t)snprintf(text + used, sizeof text - used,
                                 "  s%d: {plate: [%.4f 0 m, %.4f 0.1 m]}\n", k, 0.1 + 0.1 * k,
                                 0.1 + 0.1 * k);
    snprintf(text + used, sizeof text - used, END);
    TELLS(text, "is one too many: at most 64", "test.yaml:66:");
    used = (size_t)snprintf(text, sizeof text, TANK "fluids:\n");
    for (int k = 0; k < 17; k++)
        used += (size_t)snprintf(text + used, sizeof text - used,
                                 "  f%d: {density: %d kg/m3, viscosity: 1 mm2/s}\n", k, 900 + k);
    used += (size_t)snprintf(text + used, sizeof text - used, "fill:\n");
    for (int k = 0; k < 17; k++)
        used += (size_t)snprintf(text + used, sizeof text - used,
                                 "  - f%d: {box: [%.3f 0 m, %.3f 0.1 m]}\n", k, 0.05 * k,
                                 0.05 * (k + 1));
    snprintf(text + used, sizeof text - used, END);
    TELLS(text, "more than 16 fluids", "test.yaml:39:");
    TELLS("mps: 1\ndim: 3\ndp: 0.1 m\ntank: {size: 1 0.8 0.6 m}\nfill: [{water: {depth: 0.3 m}}]\n"
          "sensors:\n  P: {panel: [0 0 0 m, 0 0.2 0 m, 0 0.2 0.2 m, 0 0 0.2 m, 0 0 0.3 m]}\n" END,
          "sensors.P.panel: 5 points, 2 to 4 are wanted");
    TELLS("mps: 1\ndim: 3\ndp: 0.1 m\ntank: {size: 1 0.8 0.6 m}\nfill: [{water: {depth: 0.3 m}}]\n"
          "sensors:\n  P: {panel: [0 0 0 m, 0.1 0.2 0.2 m]}\n" END,
          "two points are opposite corners of a panel along the axes");
}

/* A check lists the first and the last cell of a large panel, and 256 columns in total; it reports
 * the number of omitted ones. */
static void many_columns(void **state)
{
    char text[24000];
    (void)state;
    TELLS(TANK WATER
          "sensors:\n  P: {panel: [0 0.2 m, 0 0.5 m], cells: 255}\n  a: {wall: 0 0.1 m}\n" END,
          "P_1: wall pressure at (0, 0.2006) m", "\n          .. and 253 more cells, to\n",
          "P_255: wall pressure at (0, 0.4994) m", "P: Wall pressure: mean of the cells",
          "a: wall pressure at (0, 0.1) m");
    char *panel = logged(TANK WATER "sensors:\n  P: {panel: [0 0.2 m, 0 0.5 m], cells: 16}\n" END);
    assert_non_null(strstr(panel, "P_9: wall pressure"));
    assert_null(strstr(panel, "more"));
    free(panel);
    size_t used = (size_t)snprintf(text, sizeof text, TANK WATER "sensors:\n");
    for (int k = 0; k < 255; k++)
        used += (size_t)snprintf(text + used, sizeof text - used, "  a%d: {pressure: %.3f 0.1 m}\n",
                                 k, 0.1 + 0.003 * k);
    snprintf(text + used, sizeof text - used, "  P: {panel: [0 0.2 m, 0 0.5 m], cells: 20}\n" END);
    TELLS(
        text, "a254: pressure at (0.862, 0.1) m\n          P_1: wall pressure",
        "\n          .. and 18 more cells, to\n          .. and 2 more columns, which the drawing "
        "leaves out too\n");
}

/* A tank of more corners than a form has, all on a circle. */
static void too_many_corners(void **state)
{
    char text[4000];
    (void)state;
    for (int corners = 64; corners <= 65; corners++) {
        size_t used = (size_t)snprintf(text, sizeof text, "mps: 1\ndp: 50 mm\ntank: {polygon: [");
        for (int k = 0; k < corners; k++)
            used += (size_t)snprintf(text + used, sizeof text - used, "%s%.4f %.4f m",
                                     k ? ", " : "", 1 + cos(2 * acos(-1.0) * k / corners),
                                     1 + sin(2 * acos(-1.0) * k / corners));
        snprintf(text + used, sizeof text - used, "]}\nfill: [{water: {depth: 1 m}}]\n" END);
        if (corners == 64)
            TELLS(text, "tank      polygon, 2 x 2 m, lower corner (0, 0) m, 3.13");
        else
            TELLS(text, "one point too many: at most 64", "test.yaml:3:");
    }
}

/* Of the same density the one that is filled in first is the first phase. */
static void fluids_of_one_density(void **state)
{
    (void)state;
    TELLS(TANK "fluids:\n  b: {density: 900 kg/m3, viscosity: 2 mm2/s, tension: 20 mN/m}\n"
               "  a: {density: 900 kg/m3, viscosity: 1 mm2/s, tension: 30 mN/m}\n"
               "fill:\n  - a: {box: [0 0.3 m, 0.5 0.4 m]}\n  - b: {box: [0.5 0.3 m, 1 0.4 m]}\n"
               "  - water: {box: [0 0 m, 1 0.3 m]}\n" END,
          "phase 0: water, 1000 kg/m3", "phase 1: a, 900 kg/m3", "phase 2: b, 900 kg/m3");
    TELLS(TANK "fill: []\n" END, "fill: a list of fluids is wanted");
}

static void quiet_run(const char *text)
{
    char error[1000] = "";
    mps_case *c = NULL;
    mps_job *job = NULL;
    mps_sim *sim = NULL;
    mps_job_config config;
    assert_int_equal(mps_job_config_init(&config, sizeof config), MPS_OK);
    config.folder = "seldom";
    config.overwrite = 1;
    config.print = listen;
    config.error = error;
    config.error_size = sizeof error;
    kit_read(text, NULL, &c);
    const mps_status status = mps_case_job(c, &config, &job, &sim);
    char *all = kit_messages(c);
    if (status != MPS_OK) fail_msg("%s%s", all, error);
    free(all);
    assert_int_equal(mps_job_run(job, sim), MPS_EXIT_OK);
    mps_sim_destroy(sim);
    mps_job_destroy(job);
    mps_case_destroy(c);
}

/* A block of water without a level: the zero of a gauge is the highest particle of the liquid. */
static void no_level(void **state)
{
    (void)state;
    quiet_run(
        TANK "fill: [{water: {box: [0 0 m, 0.5 0.3 m]}}, {oil: {box: [0.6 0 m, 0.9 0.4 m]}}]\n"
             "fluids: {oil: {density: 800 kg/m3, viscosity: 2 mm2/s, tension: 0 N/m}}\n"
             "domain: [2 2 m, -1 -1 m]\nuse: [viscosity.pair]\nremove: collision\n"
             "sensors:\n  eta: {gauge: 0.25 m, drops: yes}\n  of_oil: {gauge: 0.75 m, fluid: oil}\n"
             "  front: {measure: front, box: [0 0 m, 1 0.1 m]}\n"
             "  v: {measure: speed, fluid: oil, axis: x}\n  roll: {measure: angle}\n"
             "reference:\n  roll: [{times: 1 2 s, values: 10 20 deg}, {times: 1 s, "
             "values: 5 deg, style: line, shift: 0.5 s}]\n"
             "run: {until: 8 ms, dt: 4 ms, threads: 1, preconditioner: jacobi}\n"
             "output: {frames: 0, page: 0 MB}\n");
    const char *const names = text_of("seldom", "probes.csv");
    assert_non_null(strstr(names, "eta[m],of_oil[m],front"));
    int column = 0;
    for (const char *at = names; strncmp(at, "eta", 3) != 0; at++) column += *at == ',';
    assert_true(fabs(number_in("seldom", "probes.csv", 0, column)) < 0.026);
    assert_true(fabs(number_in("seldom", "probes.csv", 0, column + 1) - 0.1) < 0.026);
    const char *summary = text_of("seldom", "summary.json");
    assert_non_null(strstr(summary, "use viscosity.pair, remove collision"));
    assert_non_null(strstr(summary, "[1, 10], [2, 20]"));
    assert_non_null(strstr(summary, "[1.5, 5]"));
    assert_non_null(strstr(summary, "\"jacobi\""));
}

/* Calls without what they need change nothing. */
static void arguments(void **state)
{
    mps_case *c = NULL;
    mps_job *job = (mps_job *)&c;
    mps_sim *sim = (mps_sim *)&c;
    mps_job_config config;
    char *text = (char *)&c, *sketch = text;
    (void)state;
    assert_int_equal(mps_job_config_init(&config, sizeof config), MPS_OK);
    assert_int_equal(kit_read(TANK WATER END, NULL, &c), MPS_OK);
    assert_int_equal(mps_case_job(NULL, &config, &job, &sim), MPS_E_ARG);
    assert_null(job);
    assert_null(sim);
    assert_int_equal(mps_case_job(c, NULL, &job, &sim), MPS_E_ARG);
    assert_int_equal(mps_case_job(c, &config, NULL, &sim), MPS_E_ARG);
    assert_int_equal(mps_case_job(c, &config, &job, NULL), MPS_E_ARG);
    assert_int_equal(mps_case_check(NULL, &text, &sketch), MPS_E_ARG);
    assert_null(text);
    assert_null(sketch);
    assert_int_equal(mps_case_check(c, NULL, &sketch), MPS_OK); /* each part alone */
    assert_non_null(sketch);
    free(sketch);
    assert_int_equal(mps_case_check(c, &text, NULL), MPS_OK);
    assert_non_null(text);
    free(text);
    assert_int_equal(mps_case_message_count(c), 0);
    mps_case_destroy(c);
    assert_int_equal(kit_read("mps: 1\n", NULL, &c), MPS_E_ARG);
    assert_int_equal(mps_case_job(c, &config, &job, &sim), MPS_E_ARG);
    assert_int_equal(mps_case_check(c, &text, &sketch), MPS_E_ARG);
    mps_case_destroy(c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(too_many),
                                       cmocka_unit_test(many_columns),
                                       cmocka_unit_test(fluids_of_one_density),
                                       cmocka_unit_test(no_level),
                                       cmocka_unit_test(arguments),
                                       cmocka_unit_test(too_many_corners)};
    return cmocka_run_group_tests(tests, enter_folder, leave_folder);
}

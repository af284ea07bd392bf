/* SPDX-License-Identifier: BSD-3-Clause */
/* Constants of a run, read from its folder: those of the case, defaults from tank and liquid, and
 * those of a run in progress. */
#include "page_fixture.h"
#include <mps/stats.h>
#include "locale_kit.h"

static mps_stats_config fresh(char *error, size_t size)
{
    mps_stats_config c;
    assert_int_equal(mps_stats_config_init(&c, sizeof c), MPS_OK);
    c.error = error;
    c.error_size = size;
    return c;
}

static scene folder_with(const char *summary)
{
    scene s = {.dim = 2, .fluid = 4, .frames = 0, .rows = 3};
    scene_create(&s);
    if (summary) text_write(&s, "summary.json", summary);
    return s;
}

#define NEAR(a, b) assert_true(fabs((a) - (double)(b)) <= 1e-12 * fabs((double)(b)))

static void the_case_wins(void **unused)
{
    (void)unused;
    char error[300];
    mps_stats_config c = fresh(error, sizeof error);
    scene s = folder_with(
        "{\"t_end\": 40, \"tank_size_x\": 1, \"liquid_depth\": 0.5, \"gravity\": 9.81, "
        "\"sensor_average_most\": 0.004, \"inputs\": ["
        "{\"key\": \"title\", \"value\": \"T1 \\\"impacts.from\\\"\"},"
        "{\"key\": \"T1\", \"value\": \"1.25 s\"}, {\"key\": \"motion omega\", \"value\": \"5.5 "
        "rad/s\"}, {\"key\": \"impacts.threshold\", \"value\": \"1000 Pa\"}, {\"key\": "
        "\"impacts.window\", \"value\": \"0.3 s\"}, {\"key\": \"impacts.from\", \"value\": \"2 "
        "s\"}, {\"key\": \"impacts.until\", \"value\": \"30 s\"}, {\"key\": \"impacts.rate\", "
        "\"value\": \"2000 Hz\"}, {\"key\": \"impacts.high_pass\", \"value\": \"3 Hz\"}, {\"key\": "
        "\"impacts.deviations\", \"value\": \"4\"}, {\"key\": \"impacts.share\", \"value\": "
        "\"0.4\"}, {\"key\": \"impacts.confidence\", \"value\": \"0.8\"}, {\"key\": "
        "\"impacts.exposure\", \"value\": \"3600 s\"}, {\"key\": \"impacts.exposure_ratio\", "
        "\"value\": \"5\"}, {\"key\": \"impacts.dependence\", \"value\": \"1.5\"}, {\"key\": "
        "\"impacts.scale\", \"value\": \"40\"}, {\"key\": \"impacts.density_ratio\", \"value\": "
        "\"0.45\"}, {\"key\": \"impacts.least_events\", \"value\": \"12\"}, {\"key\": "
        "\"impacts.resamples\", \"value\": \"50\"}, {\"key\": \"impacts.seed\", \"value\": \"7\"}, "
        "{\"key\": \"impacts.sensors\", \"value\": \"P1; P_top\"}]}");
    locale_begin("de_DE.UTF-8");
    assert_int_equal(mps_stats_config_read(s.folder, &c), MPS_OK);
    locale_end();
    NEAR(c.period, 1.25);
    NEAR(c.omega, 5.5);
    NEAR(c.threshold, 1000);
    NEAR(c.window, 0.3);
    NEAR(c.from, 2);
    NEAR(c.until, 30);
    NEAR(c.rate, 2000);
    NEAR(c.high_pass, 3);
    NEAR(c.deviations, 4);
    NEAR(c.share, 0.4);
    NEAR(c.confidence, 0.8);
    NEAR(c.exposure, 3600);
    NEAR(c.exposure_ratio, 5);
    NEAR(c.dependence, 1.5);
    NEAR(c.length_scale, 40);
    NEAR(c.density_ratio, 0.45);
    NEAR(c.crossing_time, 0.004);
    assert_int_equal(c.least_events, 12);
    assert_int_equal(c.resamples, 50);
    assert_int_equal(c.seed, 7);
    assert_int_equal(mps_stats_wants(&c, "P1") + mps_stats_wants(&c, "P_top"), 2);
    assert_int_equal(mps_stats_wants(&c, "P_to") + mps_stats_wants(&c, "P") +
                         mps_stats_wants(&c, "P1; P_top") + mps_stats_wants(&c, ""),
                     0);
    scene_remove(&s);
}

static void tank_and_liquid_tell_a_period(void **unused)
{
    (void)unused;
    char error[300];
    mps_stats_config c = fresh(error, sizeof error);
    scene s = folder_with("{\"t_end\": 40, \"tank_size_x\": 40, \"liquid_depth\": 20, \"gravity\": "
                          "9.807}");
    assert_int_equal(mps_stats_config_read(s.folder, &c), MPS_OK);
    assert_true(fabs(c.period - 7.476) < 5e-4); /* published */
    NEAR(c.from, 0.2);
    assert_true(isnan(c.omega) && isnan(c.window) && isnan(c.threshold) && c.until > 1e300);
    assert_int_equal(mps_stats_wants(&c, "any"), 1);
    text_write(&s, "summary.json", "{\"t_end\": 40, \"gravity\": 0, \"tank_size_x\": 1}");
    c = fresh(error, sizeof error);
    assert_int_equal(mps_stats_config_read(s.folder, &c), MPS_OK);
    assert_true(isnan(c.period));
    NEAR(c.window, 0.8);
    scene_remove(&s);
}

/* Without a summary the last row determines the length of the record. */
static void a_run_that_goes_on(void **unused)
{
    (void)unused;
    char error[300];
    mps_stats_config c = fresh(error, sizeof error);
    scene s = folder_with(NULL);
    char path[128];
    path_of(&s, "summary.json", path);
    remove(path);
    text_write(&s, "probes.csv", "t[s],P1[Pa]\n0,1\n10,2\n");
    assert_int_equal(mps_stats_config_read(s.folder, &c), MPS_OK);
    NEAR(c.from, 0.05);
    NEAR(c.window, 0.2);
    scene_remove(&s);
}

static void what_is_refused(void **unused)
{
    (void)unused;
    char error[300], longer[1200] = "{\"inputs\": [{\"key\": \"impacts.sensors\", \"value\": \"";
    mps_stats_config c = fresh(error, sizeof error), before = c;
    scene s = folder_with("{\"t_end\": 40, \"inputs\": [");
    assert_int_equal(mps_stats_config_read(s.folder, &c), MPS_E_IO);
    assert_non_null(strstr(error, "summary.json"));
    for (int k = 0; k < 100; k++) strcat(longer, "P12345; ");
    text_write(&s, "summary.json", strcat(longer, "P\"}], \"t_end\": 40}"));
    assert_int_equal(mps_stats_config_read(s.folder, &c), MPS_E_ARG);
    assert_non_null(strstr(error, "impacts.sensors"));
    assert_memory_equal(&c, &before, sizeof c);
    assert_int_equal(mps_stats_config_read("", &c), MPS_E_ARG);
    assert_int_equal(mps_stats_config_read(NULL, &c), MPS_E_ARG);
    assert_int_equal(mps_stats_config_read("nowhere_at_all", &c), MPS_E_IO);
    assert_int_equal(mps_stats_config_read(s.folder, NULL), MPS_E_ARG);
    c.struct_size = 3;
    assert_int_equal(mps_stats_config_read(s.folder, &c), MPS_E_ARG);
    assert_int_equal(mps_stats_wants(&c, "P1"), 0);
    assert_int_equal(mps_stats_wants(NULL, "P1") + mps_stats_wants(&before, NULL), 0);
    memset(before.sensors, 'x', sizeof before.sensors);
    assert_int_equal(mps_stats_config_read(s.folder, &before), MPS_E_ARG);
    memcpy(before.sensors, "P1;", 3);
    assert_int_equal(mps_stats_wants(&before, "P1"), 0); /* a text without end is not read */
    scene_remove(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_case_wins), cmocka_unit_test(tank_and_liquid_tell_a_period),
        cmocka_unit_test(a_run_that_goes_on), cmocka_unit_test(what_is_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

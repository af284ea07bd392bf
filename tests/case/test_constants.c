/* SPDX-License-Identifier: BSD-3-Clause */
/* Constants of the statistics set by texts, "impacts.threshold=6 kPa", as in `mps stats --set`; the
 * list of all constants; rounded quantities. */
#include "case_kit.h"
#include <math.h>
#include <mps/stats.h>

static char error[400];

static void same_value(double a, double b)
{
    if (!(fabs(a - b) <= 1e-12 * fabs(b))) fail_msg("%.17g, not %.17g", a, b);
}

static mps_stats_config fresh(void)
{
    mps_stats_config c;
    assert_int_equal(mps_stats_config_init(&c, sizeof c), MPS_OK);
    c.error = error;
    c.error_size = sizeof error;
    error[0] = '\0';
    return c;
}

/* The value of a key after a text; all other constants are unchanged. */
static double after(mps_stats_config *c, const char *text, const char *key)
{
    const mps_stats_config before = *c;
    mps_stats_constant now = {.struct_size = sizeof now}, old = now;
    double value = NAN;
    if (mps_stats_config_set(c, text) != MPS_OK) fail_msg("%s: %s", text, error);
    for (int32_t k = 0; mps_stats_constant_get(c, k, &now) == MPS_OK; k++) {
        assert_int_equal(mps_stats_constant_get(&before, k, &old), MPS_OK);
        if (strcmp(now.key, key) == 0)
            value = now.value;
        else if (!(now.value == old.value || (isnan(now.value) && isnan(old.value))))
            fail_msg("%s changes %s too", text, now.about);
    }
    return value;
}

/* Each key of `impacts` in the table of keys can be set, with its example, and each has its
 * constant. */
static void every_key(void **state)
{
    int found = 0;
    mps_case_key key = {.struct_size = sizeof key};
    (void)state;
    for (int32_t k = 0; mps_case_key_get(k, &key) == MPS_OK; k++) {
        char text[200];
        mps_stats_config c = fresh();
        if (strncmp(key.path, "impacts.", 8) != 0) continue;
        found++;
        c.period = 2;
        snprintf(text, sizeof text, "%s=%s", key.path, key.example);
        if (strcmp(key.path, "impacts.sensors") == 0) {
            assert_int_equal(mps_stats_config_set(&c, text), MPS_OK);
            assert_string_equal(c.sensors, "P1; P2");
        } else if (!isfinite(after(&c, text, key.path)))
            fail_msg("%s has no constant", key.path);
    }
    assert_true(found >= 17);
}

static void values(void **state)
{
    mps_stats_config c = fresh();
    (void)state;
    c.period = 1.25;
    same_value(after(&c, "impacts.threshold=6 kPa", "impacts.threshold"), 6000);
    same_value(c.threshold, 6000);
    same_value(after(&c, "impacts.window=0.3 T1", "impacts.window"), 0.375);
    same_value(after(&c, "impacts.from=2 s", "impacts.from"), 2);
    same_value(after(&c, "impacts.until=1 min", "impacts.until"), 60);
    same_value(after(&c, "impacts.share=40 %", "impacts.share"), 0.4);
    same_value(after(&c, "impacts.rate=2 kHz", "impacts.rate"), 2000);
    same_value(after(&c, "impacts.least_events=12", "impacts.least_events"), 12);
    same_value(after(&c, "impacts.resamples=0", "impacts.resamples"), 0);
    same_value(after(&c, "impacts.seed=7", "impacts.seed"), 7);
    same_value(after(&c, "impacts.scale=40", "impacts.scale"), 40);
    assert_int_equal(c.least_events, 12);
    assert_int_equal(c.seed, 7);
    same_value(c.length_scale, 40);
    /* several at once, and a sensor alone */
    assert_int_equal(
        mps_stats_config_set(&c, "impacts={threshold: 5 kPa, share: 0.3, sensors: P9}"), MPS_OK);
    same_value(c.threshold, 5000);
    same_value(c.share, 0.3);
    assert_string_equal(c.sensors, "P9");
}

/* Refused with these words, and nothing is changed. */
static void refused(const char *text, mps_stats_config c, const char *words)
{
    const mps_stats_config before = c;
    const char *word;
    size_t length;
    error[0] = '\0';
    assert_int_equal(mps_stats_config_set(&c, text), MPS_E_ARG);
    assert_memory_equal(&c, &before, sizeof c);
    for (int32_t k = 0; (length = mps__words_get(words, k, &word)) > 0; k++) {
        char one[200];
        snprintf(one, sizeof one, "%.*s", (int)length, word);
        if (!strstr(error, one)) fail_msg("%s: no '%s' in '%s'", text, one, error);
    }
    assert_null(strchr(error, '\n'));
}

static void refusals(void **state)
{
    mps_stats_config c = fresh();
    char longer[900] = "impacts.sensors=[P0";
    (void)state;
    refused("impacts.treshold=6 kPa", c, "--set impacts.treshold=6 kPa|did you mean 'threshold'?");
    refused("impacts.threshold=6", c, "'6' has no unit; a pressure is wanted");
    refused("impacts.threshold=6 s", c, "'s' is the unit of a time; a pressure is wanted");
    refused("impacts.threshold=-6 Pa", c, "out of its range: > 0");
    refused("impacts.seed=1.5", c, "a whole number is wanted");
    refused("impacts.window=0.1 T1", c, "'T1' is not known here|write a time in s");
    refused("impacts.from=5 s", (c.until = 4, c), "'from' must be smaller");
    refused("impacts.threshold", c, "path=value is wanted");
    refused("impacts=7", c, "impacts|a map of keys is wanted");
    refused("impacts={threshold: 5 kPa, share: 2}", c, "share|out of its range");
    refused("threshold=6 kPa", c,
            "'threshold=6 kPa' is no constant|did you mean 'impacts.threshold'?");
    refused("run.until=5 s", c, "'run.until=5 s' is no constant|'impacts.KEY=VALUE' is wanted");
    refused("impactsX=1", c, "is no constant");
    refused("impacts", c, "is no constant");
    refused("", c, "is no constant");
    refused(NULL, c, "text is required");
    for (int k = 0; k < 130; k++) strcat(longer, ", P12");
    refused(strcat(longer, "]"), c, "impacts.sensors: the list has more than 511 bytes");
    assert_int_equal(mps_stats_config_set(NULL, "impacts.share=0.5"), MPS_E_ARG);
    c.struct_size = 3;
    assert_int_equal(mps_stats_config_set(&c, "impacts.share=0.5"), MPS_E_ARG);
}

static void the_list(void **state)
{
    mps_stats_config c = fresh();
    mps_stats_constant k = {.struct_size = sizeof k};
    int32_t count = 0;
    (void)state;
    while (mps_stats_constant_get(&c, count, &k) == MPS_OK) {
        assert_true(k.key && k.about && k.about[0] && k.unit);
        count++;
    }
    assert_int_equal(count, 20);
    assert_int_equal(mps_stats_constant_get(&c, -1, &k), MPS_E_ARG);
    assert_int_equal(mps_stats_constant_get(&c, 0, NULL), MPS_E_ARG);
    assert_int_equal(mps_stats_constant_get(NULL, 0, &k), MPS_E_ARG);
    k.struct_size = 1;
    assert_int_equal(mps_stats_constant_get(&c, 0, &k), MPS_E_ARG);
}

static void quantities(void **state)
{
    static const struct {
        double value;
        const char *unit, *text;
    } all[] = {{33340, "Pa", "33.3 kPa"}, {1.234e6, "Pa", "1.23 MPa"},
               {-2500, "Pa", "-2.5 kPa"}, {0.0123, "s", "12.3 ms"},
               {197, "Pa s", "197 Pa s"}, {10590, "", "10,600"},
               {0, "Pa", "0 Pa"},         {NAN, "Pa", "-"}};
    char text[40];
    (void)state;
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        assert_int_equal(mps_quantity_write(all[k].value, all[k].unit, text, sizeof text),
                         strlen(all[k].text));
        assert_string_equal(text, all[k].text);
    }
    assert_int_equal(mps_quantity_write(33340, "Pa", NULL, 0), 8);
    assert_int_equal(mps_quantity_write(33340, "Pa", text, 5), 8);
    assert_string_equal(text, "33.3");
    assert_int_equal(mps_quantity_write(1, NULL, text, sizeof text), 0);
    assert_int_equal(mps_quantity_write(1, "Pa", NULL, 4), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_key), cmocka_unit_test(values),
                                       cmocka_unit_test(refusals), cmocka_unit_test(the_list),
                                       cmocka_unit_test(quantities)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

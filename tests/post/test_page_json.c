/* SPDX-License-Identifier: BSD-3-Clause */
/* The JSON reader: valid JSON is read, everything else is refused with its line. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "json.h"

static void values(void **unused)
{
    json_error error;
    (void)unused;
    json_value *v = mps__json_read(
        " {\"a\": [1, -2.5e3, 0.25, 1E-2, {}, []],\r\n\t\"b\" : null, \"c\": true, \"d\": false, "
        "\"\": \"\", "
        "\"e\": \"\\\"\\\\\\/\\b\\f\\n\\r\\t\\u0041\\u00e9\\u20ac\\ud83d\\ude00 \xc3\xa9\"} ",
        &error);
    assert_non_null(v);
    const json_value *a = mps__json_get(v, "a");
    assert_int_equal(mps__json_count(a), 6);
    assert_true(mps__json_number(mps__json_at(a, 0)) == 1);
    assert_true(mps__json_number(mps__json_at(a, 1)) == -2500);
    assert_true(mps__json_number(mps__json_at(a, 2)) == 0.25);
    assert_true(mps__json_number(mps__json_at(a, 3)) == 0.01);
    assert_int_equal(mps__json_at(a, 4)->type, JSON_OBJECT);
    assert_int_equal(mps__json_count(mps__json_at(a, 5)), 0);
    assert_null(mps__json_at(a, 6));
    assert_int_equal(mps__json_get(v, "b")->type, JSON_NULL);
    assert_true(mps__json_true(mps__json_get(v, "c")));
    assert_false(mps__json_true(mps__json_get(v, "d")));
    assert_string_equal(mps__json_text(mps__json_get(v, "")), "");
    assert_string_equal(mps__json_text(mps__json_get(v, "e")),
                        "\"\\/\b\f\n\r\tA\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80 \xc3\xa9");
    assert_null(mps__json_get(v, "z"));
    assert_null(mps__json_get(a, "a"));
    assert_true(isnan(mps__json_number(mps__json_get(v, "e"))));
    assert_null(mps__json_text(a));
    assert_int_equal(mps__json_count(NULL), 0);
    mps__json_free(v);
}

static void refused(void **unused)
{
    static const struct {
        const char *text;
        int line;
    } row[] = {{"", 1},
               {"\n\n", 3},
               {"{", 1},
               {"[1,]", 1},
               {"[1 2]", 1},
               {"{\"a\"}", 1},
               {"{\"a\":}", 1},
               {"{a: 1}", 1},
               {"{\"a\":1,}", 1},
               {"01", 1},
               {"1.", 1},
               {"1e", 1},
               {"-", 1},
               {"+1", 1},
               {"nan", 1},
               {"Infinity", 1},
               {"0x1", 1},
               {"1 2", 1},
               {"\"a", 1},
               {"\"a\nb\"", 1},
               {"\"\\x\"", 1},
               {"\"\\u12g4\"", 1},
               {"\"\\ud800\"", 1},
               {"\"\\udc00\"", 1},
               {"\"\\u0000\"", 1},
               {"\"\\ud800\\u0041\"", 1},
               {"\"\\", 1},
               {"tru", 1},
               {"'a'", 1},
               {"[1]]", 1},
               {"{\"a\": 1,\n\"b\": 2,\n\"a\": 3}", 3},
               {"[\n[\n1\n}", 4}};
    json_error error;
    (void)unused;
    for (size_t k = 0; k < sizeof row / sizeof row[0]; k++) {
        json_value *v = mps__json_read(row[k].text, &error);
        if (v) fail_msg("taken: %s", row[k].text);
        if (error.line != row[k].line || !error.why)
            fail_msg("%s: line %d, %s", row[k].text, error.line, error.why);
    }
}

/* Depth has a limit; a list of any length has none. */
static void sizes(void **unused)
{
    enum { N = 100000 };
    json_error error;
    char *text = malloc(2 * N + 2);
    (void)unused;
    assert_non_null(text);
    memset(text, '[', N);
    text[N] = '\0';
    assert_null(mps__json_read(text, &error));
    assert_string_equal(error.why, "values lie too deep in each other");
    for (int i = 0; i < N; i++) memcpy(text + 2 * i, i ? ",7" : "[7", 2);
    memcpy(text + 2 * N, "]", 2);
    json_value *v = mps__json_read(text, &error);
    assert_int_equal(mps__json_count(v), N);
    mps__json_free(v);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(values), cmocka_unit_test(refused),
                                       cmocka_unit_test(sizes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

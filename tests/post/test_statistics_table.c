/* SPDX-License-Identifier: BSD-3-Clause */
/* Columns of CSV files: names and units, long files, errors with file and line; statistics as CSV
 * and JSON. */
#include "stats_fixture.h"
#include <errno.h>
#include <unistd.h>
#include "locale_kit.h"

static char path[] = "mps_table_XXXXXX";

static void write_file(const char *text, size_t size)
{
    FILE *out = fopen(path, "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(text, 1, size, out), size);
    assert_int_equal(fclose(out), 0);
}

static int make_file(void **state)
{
    (void)state;
    const int file = mkstemp(path);
    return file < 0 ? -1 : close(file);
}

static int remove_file(void **state)
{
    (void)state;
    return unlink(path);
}

static mps_status read_text(const char *text, int32_t count, const char *const *names,
                            mps_table **table)
{
    const mps_stats_config config = new_config();
    write_file(text, strlen(text));
    return mps_table_read(&config, path, count, names, table);
}

static void columns(void **state)
{
    (void)state;
    const char text[] = "t[s],P1[Pa],error, eta [m]\n0,1,2,3\n\n0.5,1e3,nan, -4.5 \r\n# end\n";
    const char *const two[] = {"error", "P1[Pa]"};
    mps_table *table;
    ASSERT_DONE(read_text(text, 0, NULL, &table));
    assert_int_equal(mps_table_rows(table), 2);
    assert_int_equal(mps_table_columns(table), 3);
    assert_string_equal(mps_table_name(table, -1), "t");
    assert_string_equal(mps_table_unit(table, -1), "s");
    assert_string_equal(mps_table_name(table, 0), "P1");
    assert_string_equal(mps_table_unit(table, 0), "Pa");
    assert_string_equal(mps_table_unit(table, 1), "");
    ASSERT_NEAR(mps_table_values(table, -1)[1], 0.5, 0);
    ASSERT_NEAR(mps_table_values(table, 0)[1], 1000, 0);
    assert_true(isnan(mps_table_values(table, 1)[1]));
    ASSERT_NEAR(mps_table_values(table, 2)[1], -4.5, 0);
    assert_null(mps_table_values(table, 3));
    assert_null(mps_table_name(table, -2));
    mps_table_destroy(table);
    ASSERT_DONE(read_text(text, 2, two, &table));
    assert_int_equal(mps_table_columns(table), 2);
    assert_string_equal(mps_table_name(table, 0), "error");
    ASSERT_NEAR(mps_table_values(table, 1)[0], 1, 0);
    mps_table_destroy(table);
    ASSERT_DONE(read_text("\xef\xbb\xbft[s],a\n1,2\n", 0, NULL, &table));
    assert_string_equal(mps_table_name(table, -1), "t");
    mps_table_destroy(table);
    ASSERT_DONE(read_text("t[s],a\n", 0, NULL, &table));
    assert_int_equal(mps_table_rows(table), 0);
    mps_table_destroy(table);
    mps_table_destroy(NULL);
    assert_int_equal(mps_table_rows(NULL) + mps_table_columns(NULL), 0);
    assert_null(mps_table_unit(NULL, -1));
}

/* A run writes its last line while the file is read. */
static void unfinished_line(void **state)
{
    (void)state;
    mps_table *table;
    ASSERT_DONE(read_text("t[s],a\n0,12\n1,13", 0, NULL, &table));
    assert_int_equal(mps_table_rows(table), 1);
    mps_table_destroy(table);
    ASSERT_SAYS(read_text("t[s],a", 0, NULL, &table), MPS_E_IO, "has no line of names");
}

/* More than a block, and every digit. */
static void long_file(void **state)
{
    (void)state;
    enum { ROWS = 30000 };
    const mps_stats_config config = new_config();
    const char *const name[] = {"b"};
    uint64_t seed = 2;
    mps_table *table;
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    fputs("t[s],a[m],b[m],c[m]\n", out);
    for (int k = 0; k < ROWS; k++) {
        const double b = draw(&seed) * pow(10, k % 40 - 20);
        fprintf(out, "%.17g,%d,%.17g,%d\n", 0.001 * k, k, b, -k);
    }
    assert_int_equal(fclose(out), 0);
    ASSERT_DONE(mps_table_read(&config, path, 1, name, &table));
    assert_int_equal(mps_table_rows(table), ROWS);
    seed = 2;
    for (int k = 0; k < ROWS; k++) {
        ASSERT_NEAR(mps_table_values(table, -1)[k], 0.001 * k, 0);
        ASSERT_NEAR(mps_table_values(table, 0)[k], draw(&seed) * pow(10, k % 40 - 20), 0);
    }
    mps_table_destroy(table);
}

static void errors(void **state)
{
    (void)state;
    const char *const p9[] = {"P9"}, *const p[] = {"P"}, *const nothing[] = {NULL};
    mps_stats_config config = new_config();
    mps_table *table;
    ASSERT_SAYS(read_text("t[s],P1[Pa],P2[Pa]\n", 1, p9, &table), MPS_E_NAME,
                "no column has the name 'P9'; columns are 'P1[Pa]', 'P2[Pa]'");
    ASSERT_SAYS(read_text("t[s],P[Pa],P[m]\n", 1, p, &table), MPS_E_NAME, "more than one");
    ASSERT_SAYS(read_text("t[s],a\n0,1\n1,x2\n", 0, NULL, &table), MPS_E_IO,
                ":3: column 'a': 'x2' is no number");
    ASSERT_SAYS(read_text("t[s],a\n0,1\n1,2z\n", 0, NULL, &table), MPS_E_IO,
                ":3: column 'a': '2z'");
    ASSERT_SAYS(read_text("t[s],a\n0,1\n1,\n", 0, NULL, &table), MPS_E_IO, ":3: has 1 value,");
    ASSERT_SAYS(read_text("t[s],a\n0,1\n1\n", 0, NULL, &table), MPS_E_IO, ":3: has 1 value,");
    ASSERT_SAYS(read_text("t[s],a\n0,1\n1,2,3\n", 0, NULL, &table), MPS_E_IO, ":3: has 3 values");
    ASSERT_SAYS(read_text("t[s],a\n1,1\n1,2\n", 0, NULL, &table), MPS_E_IO, ":3: the time is 1");
    ASSERT_SAYS(read_text("t[s],a\nnan,1\n", 0, NULL, &table), MPS_E_IO, ":2: the time is");
    assert_null(table);
    ASSERT_SAYS(read_text("", 0, NULL, &table), MPS_E_IO, "has no line of names");
    write_file("t[s],a\n0,1\0\n", 12);
    ASSERT_SAYS(mps_table_read(&config, path, 0, NULL, &table), MPS_E_IO, ":2: has a byte 0");
    ASSERT_SAYS(mps_table_read(&config, "no/such", 0, NULL, &table), MPS_E_IO, strerror(ENOENT));
    ASSERT_SAYS(mps_table_read(&config, ".", 0, NULL, &table), MPS_E_IO, "it is a folder");
    ASSERT_SAYS(mps_table_read(&config, NULL, 0, NULL, &table), MPS_E_ARG, "path is NULL");
    ASSERT_SAYS(mps_table_read(&config, path, -1, NULL, &table), MPS_E_ARG, "count is -1");
    ASSERT_SAYS(mps_table_read(&config, path, 1, nothing, &table), MPS_E_ARG, "names[0]");
    ASSERT_SAYS(mps_table_read(&config, path, 0, NULL, NULL), MPS_E_ARG, "table is NULL");
}

static void endless_line(void **state)
{
    (void)state;
    enum { SIZE = 40 << 20 };
    const mps_stats_config config = new_config();
    mps_table *table;
    char *text = malloc(SIZE);
    assert_non_null(text);
    memset(text, '1', SIZE);
    memcpy(text, "t,a\n", 4);
    write_file(text, SIZE);
    free(text);
    ASSERT_SAYS(mps_table_read(&config, path, 0, NULL, &table), MPS_E_IO, ":2: a line of more");
}

/* ---- texts ---- */

static mps_impacts *some_impacts(void)
{
    mps_stats_config config = new_config();
    double t[200], p[200];
    mps_impacts *impacts = NULL;
    for (int k = 0; k < 200; k++) {
        t[k] = k;
        p[k] = k % 4 == 2 ? 10 + (k * 37) % 50 : 0;
    }
    config.threshold = 5;
    config.window = 1;
    config.resamples = 10;
    ASSERT_DONE(mps_impacts_find(&config, 200, t, p, &impacts));
    return impacts;
}

static void csv(void **state)
{
    (void)state;
    mps_impacts *impacts = some_impacts();
    const mps_impacts *const two[] = {impacts, impacts};
    const char *const names[] = {"P1", "a \"b\", c"};
    const size_t length = mps_stats_csv_write(2, names, two, NULL, 0);
    char *text = malloc(length + 1), cut[40];
    assert_non_null(text);
    memset(cut, 7, sizeof cut);
    assert_int_equal(mps_stats_csv_write(2, names, two, text, length + 1), length);
    assert_int_equal(strlen(text), length);
    assert_int_equal(mps_stats_csv_write(2, names, two, cut, sizeof cut - 1), length);
    assert_int_equal(strncmp(cut, text, sizeof cut - 2), 0);
    assert_true(cut[sizeof cut - 2] == 0 && cut[sizeof cut - 1] == 7);
    const char *second = strchr(text, '\n') + 1;
    assert_memory_equal(text, "sensor,t[s],peak[Pa],rise[s],decay[s],skewness,duration[s],", 59);
    /* P = 34 at t = 2, 1 s up and down; above 5 for 2 (1 - 5/34) s; the fifth of the peaks is the
     * one of 58 */
    assert_memory_equal(second, "P1,2,34,1,1,1,1.70588235,33.2647059,", 36);
    assert_non_null(strstr(text, "\n\"a \"\"b\"\", c\",2,34,"));
    int64_t ranks = 0, rows = 0;
    for (const char *line = second; *line; line = strchr(line, '\n') + 1, rows++) {
        const char *end = strchr(line, '\n'), *comma = end;
        while (*--comma != ',') {
        }
        while (*--comma != ',') {
        }
        ranks += strtol(comma + 1, NULL, 10);
    }
    assert_int_equal(rows, 2 * 50 - 0);
    assert_int_equal(ranks, 2 * 50 * 51 / 2);
    assert_int_equal(mps_stats_csv_write(1, NULL, two, NULL, 0), 0);
    assert_int_equal(mps_stats_csv_write(-1, names, two, NULL, 0), 0);
    assert_int_equal(mps_stats_csv_write(1, names, two, NULL, 4), 0);
    free(text);
    mps_impacts_destroy(impacts);
}

/* A decay beyond the end of the record. */
static void unknown_numbers(void **state)
{
    (void)state;
    mps_stats_config config = new_config();
    const double t[] = {0, 1, 2, 3, 4, 5}, p[] = {0, 0, 0, 20, 10.5, 10.4};
    const char *const names[] = {"P1"};
    mps_impacts *impacts = NULL;
    char text[400];
    config.threshold = 11;
    config.window = 1;
    ASSERT_DONE(mps_impacts_find(&config, 6, t, p, &impacts));
    const mps_impacts *const one[] = {impacts};
    assert_in_range(mps_stats_csv_write(1, names, one, text, sizeof text), 1, sizeof text - 1);
    assert_non_null(strstr(text, ",nan,nan,"));
    mps_impacts_destroy(impacts);
}

/* Brackets and quotes are balanced, and no number is nan. */
static void check_json(const char *text)
{
    int depth = 0;
    bool quoted = false;
    for (const char *c = text; *c; c++) {
        if (quoted && *c == '\\')
            c++;
        else if (*c == '"')
            quoted = !quoted;
        else if (!quoted && strchr("[{", *c))
            depth++;
        else if (!quoted && strchr("]}", *c))
            depth--;
        assert_true(depth >= 0);
    }
    assert_true(depth == 0 && !quoted);
    assert_null(strstr(text, "nan"));
    assert_null(strstr(text, "inf,"));
}

static void json(void **state)
{
    (void)state;
    mps_impacts *impacts = some_impacts();
    const mps_impacts *const one[] = {impacts};
    const char *const names[] = {"P \"1\"\\\n"};
    const size_t length = mps_stats_json_write(1, names, one, 10, NULL, 0);
    char *text = malloc(length + 1);
    assert_non_null(text);
    assert_int_equal(mps_stats_json_write(1, names, one, 10, text, length + 1), length);
    assert_int_equal(strlen(text), length);
    check_json(text);
    assert_non_null(strstr(text, "\"name\": \"P \\\"1\\\"\\\\\\n\""));
    assert_non_null(strstr(text, "\"threshold\": 5,"));
    assert_non_null(strstr(text, "\"from\": null"));
    assert_non_null(strstr(text, "\"weibull\": {\"state\": \"likelihood\""));
    assert_non_null(strstr(text, "\"events\": 50"));
    assert_non_null(strstr(text, "for screening"));
    assert_int_equal(mps_stats_json_write(1, names, one, -1, NULL, 0), 0);
    assert_true(mps_stats_json_write(0, NULL, NULL, 10, NULL, 0) > 0);
    free(text);
    mps_impacts_destroy(impacts);
}

/* The numbers of files have a point where the program's have a comma. */
static void other_locale(void **state)
{
    (void)state;
    locale_begin("de_DE.UTF-8");
    mps_impacts *impacts = some_impacts();
    const mps_impacts *const one[] = {impacts};
    const char *const names[] = {"P1"};
    mps_table *table;
    char text[200];
    ASSERT_DONE(read_text("t[s],a\n0.5,1.25\n", 0, NULL, &table));
    ASSERT_NEAR(mps_table_values(table, 0)[0], 1.25, 0);
    assert_true(mps_stats_csv_write(1, names, one, text, sizeof text) > sizeof text);
    assert_non_null(strstr(text, ",1.70588235,"));
    mps_table_destroy(table);
    mps_impacts_destroy(impacts);
    locale_end();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(columns),         cmocka_unit_test(unfinished_line),
        cmocka_unit_test(long_file),       cmocka_unit_test(errors),
        cmocka_unit_test(endless_line),    cmocka_unit_test(csv),
        cmocka_unit_test(unknown_numbers), cmocka_unit_test(json),
        cmocka_unit_test(other_locale),
    };
    return cmocka_run_group_tests(tests, make_file, remove_file);
}

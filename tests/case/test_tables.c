/* SPDX-License-Identifier: BSD-3-Clause */
/* Tables in the formats of loggers, spreadsheets and programs: each is read correctly or refused
 * with the reason. */
#include "build_kit.h"
#include "case_csv.h"
#include "csv.h"
#include <mps/stats.h>
#include <sys/stat.h>
#include <unistd.h>

#define FILE_NAME "test_tables.csv"

static void write_bytes(const char *bytes, size_t size)
{
    FILE *file = fopen(FILE_NAME, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static mps__csv_error read_text(mps__csv *t, const char *text, int32_t flags)
{
    write_bytes(text, strlen(text));
    const mps__csv_error error = mps__csv_open(t, FILE_NAME, flags);
    return error == CSV_OK ? mps__csv_read(t) : error;
}

/* All of these are the table time = 0, 0.1 s, surge = 0, 0.001 m. */
static void same_table(void **state)
{
    static const char *const texts[] = {
        "time[s],surge[m]\n0,0\n0.1,0.001\n",
        "\xef\xbb\xbftime[s],surge[m]\n0,0\n0.1,0.001\n",
        "time[s],surge[m]\r\n0,0\r\n0.1,0.001",
        "time[s],surge[m]\r0,0\r0.1,0.001\r",
        "time [s] surge [m]\n0 0\n0.1 0.001\n",
        "  time(s)   surge(m)\n  0   0\n\t0.1\t0.001\n",
        "time[s]\tsurge [m]\n0\t0\n0.1\t0.001\n",
        "time[s]; surge[m]\n0; 0\n0.1; 0.001\n",
        "\"time\" [s],\"surge\" [m]\n\"0\",0\n0.1,\"0.001\"\n",
        "# logger 12\n\n# serial\ntime[s], surge[m],\n0,0,\n# gap\n0.1,0.001,\n\n",
        "time[s],surge[m],\n0,0\n0.1,0.001\n",
        "time[s],surge[m]\n0,0,\n1e-1,1E-3,\n"};
    (void)state;
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        mps__csv t;
        if (read_text(&t, texts[k], 0) != CSV_OK) fail_msg("%s: %s", texts[k], t.why);
        assert_int_equal(t.columns, 2);
        assert_int_equal(t.rows, 2);
        assert_string_equal(t.name[0], "time");
        assert_string_equal(t.unit[0], "s");
        assert_string_equal(t.name[1], "surge");
        assert_string_equal(t.unit[1], "m");
        assert_true(t.value[0][1] == 0.1 && t.value[1][1] == 0.001 && t.value[1][0] == 0);
        mps__csv_free(&t);
    }
}

static void refused(void **state)
{
    static const char *const texts[][2] = {
        {"0 0\n0.1 0.001\n", ":1: the first line has numbers, no names"},
        {"0;0\n0,1;0,001\n", ":1: the first line has numbers, no names"},
        {"# time[s] surge[m]\n0 0\n", ":2: the first line has numbers, no names|take the # away"},
        {"time[s];surge[m]\n0,5;1\n", ":2: column 'time': '0,5' is no number|decimal comma"},
        {"time[s],surge[m]\n0,5,1,2\n", ":2: has 4 values, the line of names has 2|decimal point"},
        {"time[s],surge[m]\n0\n", ":2: has 1 value, the line of names has 2"},
        {"time[s],surge[m]\n0,\n", ":2: has 1 value, the line of names has 2"},
        {"time[s],surge[m],roll[deg]\n0,,1\n", ":2: column 'surge': '' is no number"},
        {"time[s],surge[m]\n0,1 m\n", ":2: column 'surge': '1 m' is no number"},
        {"time[s],surge[m]\n0,nan\n", ":2: column 'surge': 'nan' is no number"},
        {"time[s],surge[m]\n0,\"1\n", ":2: column 'surge'|"},
        {"", "has no line of names"},
        {"# nothing\n\n", "has no line of names"}};
    (void)state;
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        mps__csv t;
        const char *word;
        size_t length;
        if (k == 10) continue; /* strtod() reads the rest after an open quote */
        if (read_text(&t, texts[k][0], 0) != CSV_FILE) fail_msg("read: %s", texts[k][0]);
        for (int32_t i = 0; (length = mps__words_get(texts[k][1], i, &word)) > 0; i++) {
            char one[100];
            snprintf(one, sizeof one, "%.*s", (int)length, word);
            if (!strstr(t.why, one)) fail_msg("%s: '%s', no '%s'", texts[k][0], t.why, one);
        }
        mps__csv_free(&t);
    }
}

/* A byte 0, a pipe, a folder, no file. */
static void no_text(void **state)
{
    static const char zero[] = "time[s],surge[m]\n0,0\n0.1\0,1\n";
    mps__csv t;
    (void)state;
    write_bytes(zero, sizeof zero - 1);
    assert_int_equal(mps__csv_open(&t, FILE_NAME, 0), CSV_OK);
    assert_int_equal(mps__csv_read(&t), CSV_FILE);
    assert_non_null(strstr(t.why, ":3: has a byte 0"));
    mps__csv_free(&t);
    assert_int_equal(unlink(FILE_NAME), 0);
    assert_int_equal(mkfifo(FILE_NAME, 0600), 0);
    assert_int_equal(mps__csv_open(&t, FILE_NAME, 0), CSV_FILE);
    assert_non_null(strstr(t.why, "it is a pipe (FIFO)"));
    mps__csv_free(&t);
    assert_int_equal(unlink(FILE_NAME), 0);
    assert_int_equal(mps__csv_open(&t, FILE_NAME, 0), CSV_MISSING);
    mps__csv_free(&t);
    assert_int_equal(mps__csv_open(&t, ".", 0), CSV_FILE);
    mps__csv_free(&t);
}

static void names(void **state)
{
    mps__csv t;
    char text[4000] = "time[s]", row[1000] = "0";
    (void)state;
    assert_int_equal(read_text(&t,
                               "t[s],\"surge, of the \"\"tank\"\" [mm]\",P(1)[Pa],X,x,roll "
                               "[\xc2\xb0]\n0,1,2,3,4,5\n",
                               0),
                     CSV_OK);
    assert_int_equal(mps__csv_find(&t, "surge, of the \"tank\""), 1);
    assert_string_equal(t.unit[1], "mm");
    assert_int_equal(mps__csv_find(&t, "p(1)"), 2);
    assert_int_equal(mps__csv_find(&t, "X"), 3);
    assert_int_equal(mps__csv_find(&t, "x"), 4);
    assert_string_equal(t.unit[5], "\xc2\xb0");
    assert_int_equal(mps__csv_find(&t, "none"), -1);
    mps__csv_free(&t);
    assert_int_equal(read_text(&t, "t,T,surge,surge\n0,1,2,3\n", 0), CSV_OK);
    assert_int_equal(mps__csv_find(&t, "surge"), -2);
    mps__csv_free(&t);
    for (int k = 0; k < 300; k++) {
        snprintf(text + strlen(text), sizeof text - strlen(text), ",column%d", k);
        snprintf(row + strlen(row), sizeof row - strlen(row), ",%d", k % 10);
    }
    snprintf(text + strlen(text), sizeof text - strlen(text), "\n%s\n", row);
    assert_int_equal(read_text(&t, text, 0), CSV_OK);
    assert_int_equal(t.columns, 301);
    assert_true(t.value[mps__csv_find(&t, "column299")][0] == 9);
    mps__csv_free(&t);
    /* a text in a column that is not used; a line without an end, of a program that still
     * writes */
    write_bytes("t[s],at,P\n0,12:30,nan\n1,12:31,2", 31);
    assert_int_equal(mps__csv_open(&t, FILE_NAME, CSV_OWN), CSV_OK);
    t.wanted[1] = false;
    assert_int_equal(mps__csv_read(&t), CSV_OK);
    assert_true(t.rows == 1 && isnan(t.value[2][0]) && !t.value[1]);
    mps__csv_free(&t);
}

static void units(void **state)
{
    static const char *const same[][2] = {{"\xc2\xb0", "deg"}, {"\xb0", "deg"},   {"Deg", "deg"},
                                          {"DEG/s", "deg/s"},  {"Sec", "s"},      {"seconds", "s"},
                                          {"Degrees", "deg"},  {"m/s^2", "m/s2"}, {"RAD", "rad"}};
    (void)state;
    for (size_t k = 0; k < sizeof same / sizeof *same; k++) {
        const mps__unit *u = mps__case_csv_unit(same[k][0]);
        if (!u) fail_msg("no unit '%s'", same[k][0]);
        assert_string_equal(u->name, same[k][1]);
    }
    assert_null(mps__case_csv_unit("MM"));
    assert_null(mps__case_csv_unit("degC"));
}

#define CASE(motion)                                                                            \
    "mps: 1\ndp: 0.1 m\ntank: {size: 0.8 0.5 m}\nfill: [{water: {depth: 40 %}}]\nrun: {until: " \
    "0.2 s}\nmotion: " motion

static void refused_motion(const char *text, const char *motion, const char *words)
{
    char path[600], all[1000];
    write_bytes(text, strlen(text));
    snprintf(all, sizeof all, "%s{file: %s%s}\n", CASE(""), kit_here(path, sizeof path, FILE_NAME),
             motion);
    built_refused(all, 6, words);
}

/* A unit occurs once; a repeated equal unit is accepted. Duplicate names are ignored as names. */
static void motions(void **state)
{
    built t;
    char path[600], all[1000];
    (void)state;
    refused_motion("time[s],surge[mm]\n0,0\n1,1\n", ", units: {surge: m}",
                   "'mm' in the table and 'm' in the case");
    refused_motion("time[s],ax[m/s2]\n0,0\n1,1\n", ", columns: {surge: ax}, units: {surge: m}",
                   "'m/s2' in the table and 'm' in the case");
    refused_motion("time[min],surge[m]\n0,0\n1,1\n", ", units: {time: s}",
                   "column 'time'|'min' in the table and 's' in the case");
    refused_motion("time[s],surge[bar]\n0,0\n1,1\n", "", "'bar', a length is wanted, in m, cm, mm");
    refused_motion("time[s],surge\n0,0\n1,1\n", "", "no unit|'surge[m]'|in m, cm, mm");
    refused_motion("time[s],surge[m],surge[mm]\n0,0,0\n1,1,1\n", "", "more than one column");
    refused_motion("0,0\n1,1\n", ", columns: {surge: '0'}", "the first line has numbers");
    const char *good = "time[s],surge[mm],roll[\xb0]\n1199.9,0,0\n1200,1,0\n1200.2,2,3\n";
    write_bytes(good, strlen(good));
    snprintf(all, sizeof all, "%s{file: %s, units: {surge: mm}, from: 1200 s}\n", CASE(""),
             kit_here(path, sizeof path, FILE_NAME));
    assert_int_equal(built_try(&t, all, NULL), MPS_OK);
    same_number(t.b.motion->column[6 * 2 + MPS_SHIP_SURGE], 0.002, 1e-15);
    same_number(t.b.motion->column[6 * 2 + MPS_SHIP_ROLL], 3 * acos(-1.0) / 180, 1e-15);
    built_free(&t);
    /* 'columns' with the time alone leaves the names of degrees as they are */
    const char *clock = "clock[s],surge[m]\n0,0\n1,0.001\n2,0.002\n";
    write_bytes(clock, strlen(clock));
    snprintf(all, sizeof all, "%s{file: %s, columns: {time: clock}}\n", CASE(""),
             kit_here(path, sizeof path, FILE_NAME));
    assert_int_equal(built_try(&t, all, NULL), MPS_OK);
    same_number(t.b.motion->column[6 * 2 + MPS_SHIP_SURGE], 0.002, 1e-15);
    built_free(&t);
}

/* The unit of a reference occurs once, or twice the same, and is of the kind of its sensor. */
static void reference_units(void **state)
{
    static const struct {
        const char *text, *keys, *words; /* NULL: accepted */
    } all[] = {{"t[s],p[kPa]\n0,1\n1,2\n", "", NULL},
               {"t[s],p[kPa]\n0,1\n1,2\n", ", unit: kPa", NULL},
               {"t[s],p\n0,1\n1,2\n", ", unit: kPa", NULL},
               {"t[s],p[kPa]\n0,1\n1,2\n", ", unit: Pa", "'kPa' in the table and 'Pa' in the case"},
               {"t[s],p[mm]\n0,1\n1,2\n", ", unit: Pa", "'mm' in the table and 'Pa' in the case"},
               {"t[mm],p[kPa]\n0,1\n1,2\n", "", "'t' has the unit 'mm', a time is wanted"},
               {"t[s],p[mm]\n0,1\n1,2\n", "", "have the unit 'm', column 'P' has 'Pa'"},
               {"t[s],p\n0,1\n1,2\n", ", unit: deg", "have the unit 'deg', column 'P' has 'Pa'"}};
    (void)state;
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        char path[600], text[1000];
        mps_case *c = NULL;
        write_bytes(all[k].text, strlen(all[k].text));
        snprintf(text, sizeof text, "%sreference: {P: {file: %s%s}}\n",
                 CASE("{surge: {amplitude: 1 mm, period: 1 s}}\nsensors: {P: {wall: 0 0.1 m}}\n"),
                 kit_here(path, sizeof path, FILE_NAME), all[k].keys);
        assert_int_equal(kit_read(text, NULL, &c), MPS_OK);
        const mps_status status = mps_case_check(c, NULL, NULL);
        char *messages = kit_messages(c);
        if ((status == MPS_OK) != !all[k].words ||
            (all[k].words && !kit_has(c, 0, 0, all[k].words)))
            fail_msg("%s%s: status %d\n%s", all[k].text, all[k].keys, (int)status, messages);
        free(messages);
        mps_case_destroy(c);
    }
}

#define BODY                                                                                    \
    "mps: 1\ndp: 0.1 m\ntank: {size: 0.8 0.5 m}\nfill: [{water: {depth: 40 %}}]\nrun: {until: " \
    "0.2 s}\n"                                                                                  \
    "body: "

static void refused_load(const char *text, const char *units, const char *words)
{
    char path[600], all[1000];
    write_bytes(text, strlen(text));
    snprintf(all, sizeof all,
             "%s{mass: 1 kg, inertia: 1 kg m2, sway: {stiffness: 1 kN/m}, roll: {stiffness: 1 N "
             "m/rad}, load: {file: %s%s}}\n",
             BODY, kit_here(path, sizeof path, FILE_NAME), units);
    built_refused(all, 6, words);
}

/* The unit of a column of body.load occurs once, or twice the same; forces and moments differ. */
static void load_units(void **state)
{
    (void)state;
    refused_load("time[s],sway[N]\n0,0\n1,1\n", ", units: {sway: kN}",
                 "'N' in the table and 'kN' in the case");
    refused_load("time[s],roll[N m]\n0,0\n1,1\n", ", units: {roll: kN m}",
                 "'N m' in the table and 'kN m' in the case");
    refused_load("time[min],sway[N]\n0,0\n1,1\n", ", units: {time: s}",
                 "column 'time'|'min' in the table and 's' in the case");
    refused_load("time[s],sway[N m]\n0,0\n1,1\n", "", "'N m', a force is wanted");
    refused_load("time[s],roll[N]\n0,0\n1,1\n", "", "'N', a moment is wanted");
    refused_load("time[s],sway\n0,0\n1,1\n", "", "no unit|'sway[N]'");
}

/* The public reader: stats, record, compare. */
static void public_reader(void **state)
{
    static const char text[] = "\xef\xbb\xbft [s];\"P, 1\"[Pa];note\n0;1;a\n1;2;b\n";
    const char *const wanted[] = {"P, 1"};
    mps_stats_config c;
    mps_table *t;
    char error[400];
    (void)state;
    assert_int_equal(mps_stats_config_init(&c, sizeof c), MPS_OK);
    c.error = error;
    c.error_size = sizeof error;
    write_bytes(text, sizeof text - 1);
    if (mps_table_read(&c, FILE_NAME, 1, wanted, &t) != MPS_OK) fail_msg("%s", error);
    assert_int_equal(mps_table_rows(t), 2);
    assert_string_equal(mps_table_name(t, 0), "P, 1");
    assert_string_equal(mps_table_unit(t, 0), "Pa");
    assert_true(mps_table_values(t, 0)[1] == 2 && mps_table_values(t, -1)[1] == 1);
    mps_table_destroy(t);
}

static int end(void **state)
{
    (void)state;
    unlink(FILE_NAME);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_table),    cmocka_unit_test(refused),
        cmocka_unit_test(no_text),       cmocka_unit_test(names),
        cmocka_unit_test(units),         cmocka_unit_test(motions),
        cmocka_unit_test(public_reader), cmocka_unit_test(reference_units),
        cmocka_unit_test(load_units)};
    return cmocka_run_group_tests(tests, NULL, end);
}

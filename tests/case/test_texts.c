/* SPDX-License-Identifier: BSD-3-Clause */
/* Rarely used features of case files: characters, numbers, paths into lists, chains of files,
 * sweeps, and their messages. */
#include "case_kit.h"
#include <sys/stat.h>

#define HEAD "mps: 1\ndp: 4 mm\n"
#define CASE                                                                                    \
    HEAD "tank: {size: 0.8 0.5 m}\nfill: [{water: {depth: 0.1 m}}, {air: rest}]\nmodel: mmps\n" \
         "run: {until: 5 s}\n"
/* The value of line 3, which is a title unless it begins with a key. */
#define TITLE(text) HEAD "title: " text "\n"

static mps_case *good(const char *text, const char *const *sets)
{
    mps_case *c = NULL;
    const mps_status status = kit_read(text, sets, &c);
    char *all = kit_messages(c);
    if (status != MPS_OK) fail_msg("%s\n%s", text, all);
    free(all);
    return c;
}

static void has(const mps_case *c, const char *words)
{
    if (!strstr(mps_case_text(c), words)) fail_msg("no '%s' in\n%s", words, mps_case_text(c));
}

/* A case that reads back from its text to the same text. */
static void round_trip(const char *text, const char *words)
{
    mps_case *a = good(text, NULL), *b = good(mps_case_text(a), NULL);
    has(a, words);
    assert_string_equal(mps_case_text(a), mps_case_text(b));
    mps_case_destroy(b);
    mps_case_destroy(a);
}

/* ---- characters */

/* Invalid UTF-8 or YAML characters, with their position: a column is a character. */
static void characters(void **state)
{
    static const struct {
        const char *bytes, *words;
    } wrong[] = {{"\x80", "byte 0x80"},
                 {"\xc1\x81", "byte 0xc1"},
                 {"\xe0\x80\x80", "byte 0xe0"},     /* overlong */
                 {"\xed\xa0\x80", "byte 0xed"},     /* half of a pair of UTF-16 */
                 {"\xf0\x80\x80\x80", "byte 0xf0"}, /* overlong */
                 {"\xf4\x90\x80\x80", "byte 0xf4"}, /* beyond the last character */
                 {"\xf5\x80\x80\x80", "byte 0xf5"},
                 {"\xc3(", "byte 0xc3"},
                 {"\xe6\xb0", "byte 0xe6"}, /* cut short */
                 {"\x7f", "byte 0x7f"},
                 {"\xc2\x80", "byte 0xc2"}}; /* a character of Unicode that YAML has not */
    char text[100];
    (void)state;
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        snprintf(text, sizeof text, HEAD "title: \xc3\xa4\xe6\xb0\xb4-%s", wrong[k].bytes);
        kit_refused(text, 3, 11, wrong[k].words);
    }
    round_trip(CASE "title: \"\xe0\xa0\x80\xed\x9f\xbf\xf0\x90\x80\x80\xf4\x8f\xbf\xbd\"\n",
               "\xe0\xa0\x80\xed\x9f\xbf\xf0\x90\x80\x80\xf4\x8f\xbf\xbd");
    round_trip(CASE "title: \"bell \\x07, \\x7f\"\n", "title: \"bell \\x07, \\x7f\"");
}

static void syntax(void **state)
{
    (void)state;
    kit_refused("{mps: 1} x\n", 1, 10, "this is no YAML: did not find expected <document start>");
    kit_refused(HEAD "title: %x\n", 3, 8, "cannot start any token");
    kit_refused(HEAD "? {a: b}\n: 1\n", 3, 3, "a map as a key");
    kit_refused(HEAD "tank: &t {size: 1 1 m}\n", 3, 7, "an anchor");
    kit_refused(HEAD "fill: !!seq [a]\n", 3, 7, "a tag");
    kit_refused(HEAD "*a : 1\n", 3, 1, "an alias");
    kit_refused("%TAG ! tag:x,1:\n---\nmps: 1\n", 1, 1, "a directive");
}

/* ---- values */

static void is_size(const char *value, const char *words)
{
    char text[600];
    snprintf(text, sizeof text, HEAD "tank: {size: %s}\n", value);
    kit_refused(text, 3, 14, words);
}

static void numbers(void **state)
{
    char digits[90];
    (void)state;
    memset(digits, '3', 70);
    digits[70] = '\0';
    is_size(digits, "is no number; a length is wanted, e.g. '|3333");
    is_size("1e1000000 1 m", "'1e1000000' is too large");
    is_size("1 2 3 4 m", "more than 3 numbers");
    is_size("1-2 m", "'1-2' is no number; write a list with blanks");
    is_size("1+2 m", "'1+2' is no number; write a list with blanks");
    is_size("1;2 m", "'1;2' is no number; write a list with blanks");
    is_size("1.2.3 m", "'1.2.3' is no number; write a list with blanks");
    is_size("\"1,2 m\"", "write a decimal point as '.'");
    is_size("1e 2 m", "'e' is no unit");
    is_size("1 2 M", "'M' is no unit; did you mean 'm'?");
    snprintf(digits, sizeof digits, "1 2 %070d", 0);
    memset(digits + 4, 'q', 70);
    is_size(digits, "is no unit; units of a length: |qqqqqqqqqq");
    is_size("[1 m, [2 m]]", "a length is wanted, not a list");
    memset(digits, '4', 72);
    memcpy(digits, "1-", 2);
    digits[72] = '\0';
    is_size(digits, "is no number; write a list with blanks|'1-4444444444");
    snprintf(digits, sizeof digits, "1e%065d 2", 1);
    is_size(digits, "has no unit; a length is wanted, e.g. |'1e0000000000");
    /* blanks of all kinds between them */
    round_trip(HEAD "tank: {size: \"0.8\\t0.5\\r\\n m\"}\nfill: [{water: {depth: 0.25e+0 m}}]\n"
                    "run: {until: 5 s}\n",
               "depth: 0.25e+0 m");
}

static void kinds(void **state)
{
    (void)state;
    kit_refused(HEAD "motion: {roll: []}\n", 3, 16,
                "a map of keys, or a list of such|not an empty list");
    kit_refused(HEAD "sensors: 3\n", 3, 10, "sensors: a map of names is wanted, not a text");
    kit_refused(HEAD "sensors: {\"\": {wall: 0 0 m}}\n", 3, 11,
                "name '': a letter a to z, A to Z is wanted");
    /* the message names the position of one key elsewhere; not of a top-level key, nor of several
     * keys */
    kit_refused(HEAD "output: {gravity: 1 m/s2}\n", 3, 10, "unknown key 'output.gravity'");
    kit_refused(HEAD "output: {radius: 1 m}\n", 3, 10, "unknown key 'output.radius'");
    kit_refused(HEAD "output: {fill: []}\n", 3, 10, "unknown key 'output.fill'");
    kit_refused(HEAD "remove: [colision.pair, \"\"]\n", 3, 10, "did you mean 'collision.pair'?");
    kit_refused(HEAD "remove: [colision.pair, \"\"]\n", 3, 25, "a text is wanted");
    kit_refused(HEAD "model: [imps]\n", 3, 8, "a text is wanted, not a list");
    kit_refused(HEAD "settings: {gas.phase: 0.5}\n", 3, 23,
                "settings.gas.phase: '0.5' is out of its range: whole numbers, 0 ..");
    kit_refused(HEAD "settings: {gas.phase: -1}\n", 3, 23, "out of its range: whole numbers");
    kit_refused(HEAD "sensors:\n", 0, 0, "sensors: a map of names is wanted, not nothing");
    kit_refused(HEAD "fill: [water]\n", 3, 8, "one fluid with how it is filled in");
    kit_refused(HEAD "fill: []\n", 3, 7, "a list of fluids");
    kit_refused(HEAD "sweep: {}\n", 3, 8, "a map of paths and values");
    kit_refused(HEAD "use: {a: b}\n", 3, 6, "a text, or a list of such");
    kit_refused(HEAD "use: [[a]]\n", 3, 7, "a text is wanted");
    kit_refused(HEAD "settings: 4\n", 3, 11, "settings: a map of names is wanted");
    kit_refused(HEAD "run: 3\nkernel: 4\n", 3, 6, "run: a map of keys is wanted");
    kit_refused(HEAD "settings: {qq.zz: 3}\n", 3, 12, "no setting 'qq.zz'; settings are slot.key");
    kit_refused(HEAD "motion: {start: rset}\n", 3, 17, "did you mean 'rest'?");
    kit_refused(HEAD "sensors: {a23456789a123456789b123456789c123456789: {wall: 0 0 m}}\n", 3, 11,
                "a letter a to z, A to Z is wanted");
    kit_refused(HEAD "tank: {stl: [a]}\n", 3, 13, "the name of a file");
    kit_refused(HEAD "tank: {size: 1 1 m, a234567890b234567890c234567890d234567890e: 1}\n", 3, 21,
                "unknown key");
}

/* Points as lists of texts, and maps without keys. */
static void written(void **state)
{
    (void)state;
    round_trip(HEAD "tank: {polygon: [[0 m, 0 m], [1 m, 0 m], [1 m, 1 m]]}\nkernel: {}\n"
                    "fill: [{water: {depth: 0.25 m}}]\nrun: {until: 5 s}\n",
               "polygon:\n    - [0 m, 0 m]\n");
    round_trip(CASE "kernel: {}\n", "kernel: {}\n");
}

/* ---- values at paths */

#define ROLLS \
    CASE "motion: {roll: [{amplitude: 1 deg, period: 1 s}, {amplitude: 2 deg, period: 2 s}]}\n"

static void sets_of_lists(void **state)
{
    static const char *const some[] = {"motion.roll.2.period=7 s", "fill.2={box: [0 0 m, 1 1 m]}",
                                       NULL};
    static const char *const whole[] = {"motion.roll.1={amplitude: 9 deg, omega: 3 rad/s}",
                                        "fill.water={depth: 9 %}", NULL};
    static const char *const other[] = {"fill.oil={depth: 3 %}", "fluids.oil={density: 900 kg/m3}",
                                        NULL};
    static const char *const fresh[] = {"fill.water.depth=10 %", NULL};
    (void)state;
    mps_case *c = good(ROLLS, some);
    has(c, "period: 1 s\n");
    has(c, "amplitude: 2 deg\n      period: 7 s\n");
    has(c, "- air:\n      box: [0 0 m, 1 1 m]\n");
    mps_case_destroy(c);
    c = good(ROLLS, whole);
    has(c, "amplitude: 9 deg\n      omega: 3 rad/s\n");
    has(c, "amplitude: 2 deg\n      period: 2 s\n");
    has(c, "- water:\n      depth: 9 %\n");
    mps_case_destroy(c);
    c = good(CASE, other);
    has(c, "  - air: rest\n  - oil:\n      depth: 3 %\n");
    mps_case_destroy(c);
    c = good(HEAD "tank: {size: 0.8 0.5 m}\nrun: {until: 5 s}\n", fresh);
    has(c, "fill:\n  - water:\n      depth: 10 %\n");
    mps_case_destroy(c);
}

static void wrong_set(const char *text, const char *set, const char *words)
{
    const char *const list[] = {set, NULL};
    mps_case *c = NULL;
    assert_int_equal(kit_read(text, list, &c), MPS_E_ARG);
    char *all = kit_messages(c);
    if (!kit_has(c, 0, 0, words)) fail_msg("%.60s: wanted %s\n%s", set, words, all);
    free(all);
    mps_case_destroy(c);
}

static void wrong_sets(void **state)
{
    const size_t size = ((size_t)1 << 20) + 40;
    char *large = malloc(size + 1);
    const char **many = calloc(1100, sizeof *many);
    mps_case *c = NULL;
    (void)state;
    wrong_set(ROLLS, "motion.roll.x.period=7 s", "unknown path 'motion.roll.x.period': no key 'x'");
    wrong_set(ROLLS, "motion.roll.3.period=7 s", "there is no element 3");
    wrong_set(ROLLS, "motion.roll.0.period=7 s", "no key '0'");
    wrong_set(CASE, "set=3", "'set' cannot be set");
    wrong_set(CASE, "tank.xyzzy=3", "unknown path 'tank.xyzzy': no key 'xyzzy'");
    wrong_set(HEAD "tank: [a]\n", "tank.size=1 1 m", "nothing is below 'tank'");
    wrong_set(HEAD "sweep: 4\n", "dp=3 mm", "a map of paths and values");
    assert_non_null(large);
    assert_non_null(many);
    memset(large, 'x', size);
    memcpy(large, "title=", 6);
    large[size] = '\0';
    wrong_set(CASE, large, "the value is larger than 1 MB");
    free(large);
    for (int k = 0; k < 1100; k++) many[k] = "dp=4 mm";
    assert_int_equal(mps_case_read_text(CASE, strlen(CASE), "a.yaml", 1100, many, &c), MPS_E_ARG);
    assert_true(kit_has(c, 0, 0, "too many values are set"));
    mps_case_destroy(c);
    free(many);
}

/* ---- files below files */

static char *new_folder(void)
{
    static char folder[600];
    assert_non_null(mkdtemp(kit_here(folder, sizeof folder, "mps_text_XXXXXX")));
    return folder;
}

static char *write_file(char *path, size_t size, const char *folder, const char *name,
                        const char *text)
{
    snprintf(path, size, "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0 && fclose(file) == 0);
    return path;
}

/* Nine files below each other are one too many. */
static void chains(void **state)
{
    char *folder = new_folder(), path[700], name[20], text[60];
    mps_case *c = NULL;
    (void)state;
    for (int k = 9; k >= 0; k--) {
        snprintf(name, sizeof name, "%d.yaml", k);
        snprintf(text, sizeof text, "dp: %d mm\nbase: %d.yaml\n", k + 1, k + 1);
        write_file(path, sizeof path, folder, name, k == 9 ? CASE : text);
    }
    assert_int_equal(mps_case_read(path, 0, NULL, &c), MPS_E_ARG);
    assert_true(kit_has(c, 2, 7, "base: more than 8 files"));
    mps_case_destroy(c);
    path[strlen(path) - 6] = '3';
    assert_int_equal(mps_case_read(path, 0, NULL, &c), MPS_OK);
    has(c, "dp: 4 mm\n"); /* of the file itself */
    has(c, "until: 5 s\n");
    mps_case_destroy(c);
    /* an unknown key is merged too, and reported once */
    write_file(path, sizeof path, folder, "0.yaml", CASE "xyzzy: {a: {b: 1}}\n");
    write_file(path, sizeof path, folder, "1.yaml", "base: 0.yaml\nxyzzy: {a: {c: 2}}\n");
    assert_int_equal(mps_case_read(path, 0, NULL, &c), MPS_E_ARG);
    assert_true(kit_has(c, 2, 1, "unknown key 'xyzzy'"));
    assert_int_equal(mps_case_message_count(c), 1);
    mps_case_destroy(c);
    write_file(path, sizeof path, folder, "1.yaml", "base: \"\"\n");
    assert_int_equal(mps_case_read(path, 0, NULL, &c), MPS_E_ARG);
    assert_true(kit_has(c, 1, 7, "the name of a file is wanted"));
    mps_case_destroy(c);
    snprintf(path, sizeof path, "rm -rf '%s'", folder);
    assert_int_equal(system(path), 0);
}

static void large_files(void **state)
{
    char *folder = new_folder(), path[700];
    mps_case *c = NULL;
    (void)state;
    write_file(path, sizeof path, folder, "large.yaml", CASE);
    assert_int_equal(truncate(path, (1 << 20) + 1), 0);
    assert_int_equal(mps_case_read(path, 0, NULL, &c), MPS_E_IO);
    assert_true(kit_has(c, 0, 0, "it is larger than 1 MB; a case file is a text"));
    mps_case_destroy(c);
    write_file(path, sizeof path, folder, "page.HTM",
               "<script type=\"text/yaml\" id=\"case\">" CASE "title: \"a<\\\\\\b\"\n</script>\n");
    assert_int_equal(mps_case_read(path, 0, NULL, &c), MPS_OK);
    has(c, "title: \"a<\\\\b\"\n");
    mps_case_destroy(c);
    snprintf(path, sizeof path, "rm -rf '%s'", folder);
    assert_int_equal(system(path), 0);
}

/* Names are relative to the folder of the file, "/" too. */
static void at_the_root(void **state)
{
    char here[600];
    mps_case *c = NULL;
    (void)state;
    assert_non_null(getcwd(here, sizeof here));
    assert_int_equal(chdir("/"), 0);
    assert_int_equal(mps_case_read_text(CASE "reference: {P: {file: dev/null}}\n",
                                        strlen(CASE "reference: {P: {file: dev/null}}\n"), "a.yaml",
                                        0, NULL, &c),
                     MPS_OK);
    assert_int_equal(chdir(here), 0);
    has(c, "file: /dev/null\n");
    mps_case_destroy(c);
}

/* ---- sweeps */

static void sweeps(void **state)
{
    static const char *const wrong[] = {"1 to 2 mm",
                                        "1 step 2 to 3 mm",
                                        "1 mm to 2 cm step 1 mm",
                                        "a to b step c mm",
                                        "1 to 2000 step 1 mm",
                                        "{a: 1}",
                                        "1 to 2 step 0 mm",
                                        "[[1 mm]]",
                                        "[]",
                                        "1 to 1.2.3 step 1 mm",
                                        "1 to 2-3 step 1 mm",
                                        "1 to 2 step 1 mm 2"};
    char text[900], value[400];
    mps_case *c;
    (void)state;
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        snprintf(text, sizeof text, CASE "sweep: {dp: %s}\n", wrong[k]);
        kit_refused(text, 7, 13, "values are wanted, e.g. ");
    }
    /* no dash makes a row, and nothing behind the last value stays unread */
    kit_refused(CASE "sweep: {dp: 4-8 mm}\n", 7, 13, "sweep: dp: '4-8' is no number; write a list");
    kit_refused(CASE "sweep: {dp: 4 mm 8..9 mm}\n", 7, 13, "sweep: dp: '8..9' is no number");
    kit_refused(CASE "sweep: {dp: 4 mm 8 mm and}\n", 7, 13, "'mm and' is no unit");
    kit_refused(CASE "sweep: {settings.gas.sound: 300-340 m/s}\n", 7, 29, "'300-340' is no number");
    char *many = calloc(1, 8000);
    assert_non_null(many);
    size_t used = (size_t)sprintf(many, CASE "sweep: {dp: ");
    for (int k = 0; k < 1001; k++) used += (size_t)sprintf(many + used, "1 ");
    sprintf(many + used, "mm}\n");
    kit_refused(many, 7, 13, "sweep: 1 to 1000 values are wanted");
    free(many);
    snprintf(text, sizeof text, CASE "sweep: {dp: 1e%0250d mm}\n", 1);
    kit_refused(text, 7, 13, "values are wanted");
    memset(value, 'q', 300);
    value[300] = '\0';
    snprintf(text, sizeof text, CASE "sweep: {model: [%s]}\n", value);
    kit_refused(text, 7, 16, "values are wanted");
    snprintf(text, sizeof text, CASE "sweep: {dp: 1 to 2 step 1 %.50s}\n", value);
    kit_refused(text, 7, 13, "values are wanted");
    kit_refused(CASE "sweep: {motion: 1, motion.roll: 2, fill: 3, settings: 4, xyz.a: 5}\n", 7, 9,
                "'motion' is no path of a value");
    kit_refused(CASE "sweep: {fill: 3}\n", 7, 9, "'fill' is no path of a value");
    kit_refused(CASE "sweep: {motion.roll: 3}\n", 7, 9, "'motion.roll' is no path of a value");
    kit_refused(CASE "sweep: {sweep: 3}\n", 7, 9, "'sweep' is no path of a value");
    c = good(CASE "sweep: {model: mmps, motion.roll.2.phase: 1 2 deg}\n"
                  "motion: {roll: [{amplitude: 1 deg, period: 1 s}, {amplitude: 1 deg, period: 2 "
                  "s}]}\n",
             NULL);
    assert_int_equal(mps_case_runs(c), 2);
    assert_int_equal(mps_case_sweep_get(c, 1, 1, value, sizeof value), MPS_OK);
    assert_string_equal(value, "motion.roll.2.phase=2 deg");
    assert_int_equal(mps_case_sweep_get(c, 1, 0, value, sizeof value), MPS_OK);
    assert_string_equal(value, "model=mmps");
    assert_int_equal(mps_case_sweep_get(c, -1, 0, value, sizeof value), MPS_E_ARG);
    assert_int_equal(mps_case_sweep_get(c, 0, -1, value, sizeof value), MPS_E_ARG);
    assert_int_equal(mps_case_sweep_get(c, 0, 0, value, 8), MPS_E_ARG);
    mps_case_destroy(c);
    assert_int_equal(mps_case_sweep_get(NULL, 0, 0, value, sizeof value), MPS_E_ARG);
    assert_int_equal(mps_case_runs(NULL), 0);
    assert_int_equal(mps_case_sweep_count(NULL), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(characters),  cmocka_unit_test(syntax),  cmocka_unit_test(numbers),
        cmocka_unit_test(kinds),       cmocka_unit_test(written), cmocka_unit_test(sets_of_lists),
        cmocka_unit_test(wrong_sets),  cmocka_unit_test(chains),  cmocka_unit_test(large_files),
        cmocka_unit_test(at_the_root), cmocka_unit_test(sweeps)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

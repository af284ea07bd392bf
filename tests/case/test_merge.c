/* SPDX-License-Identifier: BSD-3-Clause */
/* Base files, values at paths, sweeps, pages, and the text of a case, which gives the same case
 * when it is read again. */
#include "case_kit.h"
#include "read.h"
#include <math.h>
#include <sys/stat.h>
#include <unistd.h>

#define CASE                                                                           \
    "mps: 1\ndp: 4 mm\ntank: {size: 0.8 0.5 m}\nfill: [{water: {depth: 25 %}}, {air: " \
    "rest}]\nmodel: mmps\n"                                                            \
    "run: {until: 5 s}\n"

static mps_case *good(const char *text, const char *const *sets)
{
    mps_case *c = NULL;
    if (kit_read(text, sets, &c) != MPS_OK) {
        char *all = kit_messages(c);
        print_message("%s", all);
        free(all);
        fail();
    }
    return c;
}

static void has(const mps_case *c, const char *words)
{
    if (!strstr(mps_case_text(c), words)) fail_msg("no '%s' in\n%s", words, mps_case_text(c));
}

static void same_tree(const tree_node *a, const tree_node *b)
{
    assert_int_equal(a->kind, b->kind);
    assert_int_equal(a->count, b->count);
    assert_ptr_equal(a->entry, b->entry);
    if (a->entry && a->entry->shape == SHAPE_FILE)
        assert_string_equal(strrchr(b->text, '/') + 1, a->text);
    else if (!(a->entry && a->entry->shape == SHAPE_FILE))
        assert_string_equal(a->text, b->text);
    if (a->key) assert_string_equal(a->key, b->key);
    const tree_node *n = b->first;
    for (const tree_node *m = a->first; m; m = m->next, n = n->next) same_tree(m, n);
}

static void round_trip(const char *text)
{
    mps_case *a = good(text, NULL), *b = good(mps_case_text(a), NULL);
    if (strcmp(mps_case_text(a), mps_case_text(b)) != 0)
        fail_msg("%s\n=====\n%s", mps_case_text(a), mps_case_text(b));
    mps_case_destroy(b);
    mps_case_destroy(a);
}

static void reads_back(void **state)
{
    static const char *const names[] = {"box.yaml",    "polygon.yaml", "cylinder.yaml",
                                        "sphere.yaml", "stl.yaml",     "sweep.yaml"};
    (void)state;
    for (size_t k = 0; k < sizeof names / sizeof names[0]; k++) {
        char path[700];
        snprintf(path, sizeof path, CASES "%s", names[k]);
        char *text = kit_file(path);
        mps_case *a = good(text, NULL), *b = good(mps_case_text(a), NULL);
        if (k < 5) same_tree(a->root, b->root);
        assert_string_equal(mps_case_text(a), mps_case_text(b));
        mps_case_destroy(a);
        mps_case_destroy(b);
        free(text);
    }
    round_trip(CASE
               "title: \"colon: # 'quote' \\\" \\\\ \\t tab, [list] {map} %\\n second line\"\n");
    round_trip(CASE "title: \"- dash\"\n");
    round_trip(CASE "title: \"...\"\n");
    round_trip(CASE "title: \" blanks \"\n");
    round_trip(CASE "title: \"\xe6\xb0\xb4\xf0\x9f\x8c\x8a\"\n");
    round_trip(CASE "title: |\n  two\n  lines\n");
}

static void sets(void **state)
{
    static const char *const some[] = {"fill.water.depth=20%", "run.until=60 T1",
                                       "sensors.P1.wall=0 50 mm", NULL};
    static const char *const more[] = {"motion.roll={amplitude: 4 deg, period: 1 s}",
                                       "fill.1.depth=30 %", "settings.gas.sound=340 m/s", NULL};
    static const char *const third[] = {"fill.oil.depth=1 mm", "fill.air.box=[0 0 m, 1 1 m]",
                                        "fluids.oil={density: 900 kg/m3}", NULL};
    (void)state;
    mps_case *c = good(CASE, some);
    has(c, "depth: 20%\n");
    has(c, "until: 60 T1\n");
    has(c, "sensors:\n  P1:\n    wall: 0 50 mm\n");
    mps_case_destroy(c);
    c = good(CASE, more);
    has(c, "motion:\n  roll:\n    amplitude: 4 deg\n    period: 1 s\n");
    has(c, "- water:\n      depth: 30 %\n");
    has(c, "gas.sound: 340 m/s");
    mps_case_destroy(c);
    c = good(CASE, third);
    has(c, "- oil:\n      depth: 1 mm\n");
    has(c, "- air:\n      box: [0 0 m, 1 1 m]\n");
    mps_case_destroy(c);
}

static void wrong_set(const char *set, const char *words)
{
    const char *const list[] = {set, NULL};
    mps_case *c = NULL;
    assert_int_equal(kit_read(CASE, list, &c), MPS_E_ARG);
    if (!kit_has(c, 0, 0, words)) {
        char *all = kit_messages(c);
        print_message("%s: wanted %s\n%s", set, words, all);
        free(all);
        fail();
    }
    mps_case_message m = {.struct_size = sizeof m};
    assert_int_equal(mps_case_message_get(c, 0, &m), MPS_OK);
    assert_int_equal(m.line, 0);
    assert_non_null(strstr(m.file, "--set "));
    mps_case_destroy(c);
}

static void wrong_sets(void **state)
{
    (void)state;
    wrong_set("run.untl=60 s", "no key 'untl'; did you mean 'until'?");
    wrong_set("runn.until=60 s", "did you mean 'run'?");
    wrong_set("run.until", "path=value is wanted");
    wrong_set("=3", "path=value is wanted");
    wrong_set("", "path=value is wanted");
    wrong_set("run.until=", "there is no value behind 'run.until='");
    wrong_set("run.until=[", "no YAML");
    wrong_set("run.until.x=3", "nothing is below 'until'");
    wrong_set("fill.9.depth=3 m", "there is no element 9");
    wrong_set("fill.water.deep=3 m", "no key 'deep'");
    wrong_set("base=a.yaml", "cannot be set");
    wrong_set("motion.surge.amplitude=3 s", "is the unit of a time");
    wrong_set("dp=&a 3 mm", "an anchor");
}

/* Another member of a group replaces the previous one. */
static void groups(void **state)
{
    static const char *const set[] = {"motion.roll.omega=2 rad/s", "fill.water.box=[0 0 m, 1 1 m]",
                                      "tank.polygon=[0 0 m, 1 0 m, 1 1 m]", NULL};
    (void)state;
    mps_case *c = good(CASE "motion: {roll: {amplitude: 1 deg, period: 1 s}}\n", set);
    has(c, "amplitude: 1 deg\n    omega: 2 rad/s\n");
    assert_null(strstr(mps_case_text(c), "period"));
    assert_null(strstr(mps_case_text(c), "depth"));
    assert_null(strstr(mps_case_text(c), "size"));
    mps_case_destroy(c);
}

static void write_file(const char *folder, const char *name, const char *text)
{
    char path[700];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    fclose(file);
}

static char *new_folder(void)
{
    static char folder[600];
    assert_non_null(mkdtemp(kit_here(folder, sizeof folder, "mps_case_XXXXXX")));
    return folder;
}

static void remove_folder(const char *folder)
{
    static const char *const names[] = {"base.yaml", "a.yaml", "b.yaml",
                                        "page.html", "t.csv",  "empty.html"};
    for (size_t k = 0; k < sizeof names / sizeof names[0]; k++) {
        char path[700];
        snprintf(path, sizeof path, "%s/%s", folder, names[k]);
        unlink(path);
    }
    rmdir(folder);
}

static mps_status read_in(const char *folder, const char *name, mps_case **c)
{
    char path[700];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return mps_case_read(path, 0, NULL, c);
}

static void bases(void **state)
{
    char *folder = new_folder();
    mps_case *c = NULL;
    (void)state;
    write_file(
        folder, "base.yaml",
        CASE "reference: {P: {file: t.csv}}\nmotion: {surge: {amplitude: 1 mm, omega: 2 rad/s}}\n");
    write_file(folder, "t.csv", "t,p\n");
    write_file(folder, "a.yaml",
               "mps: 1\nbase: base.yaml\nmotion: {surge: {amplitude: 9 mm}}\n"
               "fill: [{water: {depth: 1 m}}]\nset: {run.until: 9 s, motion.surge.period: 4 s}\n");
    assert_int_equal(read_in(folder, "a.yaml", &c), MPS_OK);
    has(c, "amplitude: 9 mm\n    period: 4 s\n");
    has(c, "until: 9 s");
    has(c, "- water:\n      depth: 1 m\nmodel");
    assert_null(strstr(mps_case_text(c), "base"));
    assert_null(strstr(mps_case_text(c), "omega"));
    char file[700];
    snprintf(file, sizeof file, "file: %s/t.csv", folder);
    has(c, file);
    mps_case_destroy(c);
    write_file(folder, "a.yaml", "mps: 1\nbase: b.yaml\n");
    write_file(folder, "b.yaml", "mps: 1\nbase: a.yaml\n");
    assert_int_equal(read_in(folder, "a.yaml", &c), MPS_E_ARG);
    assert_true(kit_has(c, 2, 7, "'a.yaml' is a base of itself"));
    mps_case_destroy(c);
    write_file(folder, "a.yaml", "mps: 1\nbase: none.yaml\n");
    assert_int_equal(read_in(folder, "a.yaml", &c), MPS_E_IO);
    assert_true(kit_has(c, 2, 7, "cannot be read"));
    mps_case_destroy(c);
    write_file(folder, "a.yaml", "mps: 1\nbase: [b]\n");
    assert_int_equal(read_in(folder, "a.yaml", &c), MPS_E_ARG);
    assert_true(kit_has(c, 2, 7, "name of a file is wanted"));
    mps_case_destroy(c);
    write_file(folder, "a.yaml", "mps: 1\nbase: base.yaml\nset: 3\n");
    assert_int_equal(read_in(folder, "a.yaml", &c), MPS_E_ARG);
    assert_true(kit_has(c, 3, 6, "a map of paths"));
    mps_case_destroy(c);
    write_file(folder, "a.yaml", "mps: 1\nbase: base.yaml\nset: {run.untl: 3 s}\n");
    assert_int_equal(read_in(folder, "a.yaml", &c), MPS_E_ARG);
    assert_true(kit_has(c, 3, 7, "did you mean 'until'?"));
    mps_case_destroy(c);
    remove_folder(folder);
}

static void pages(void **state)
{
    char *folder = new_folder();
    mps_case *c = NULL;
    (void)state;
    write_file(folder, "page.html",
               "<html>\n<body><p>text</p>\n<script type=\"text/yaml\" id=\"case\">" CASE
               "title: \"<\\/b> <\\!-- <\\script>\"\n</script></body></html>\n");
    assert_int_equal(read_in(folder, "page.html", &c), MPS_OK);
    has(c, "title: \"</b> <!-- <script>\"\n");
    mps_case_destroy(c);
    write_file(folder, "page.html",
               "<html>\n\n<script type=\"text/yaml\" id=\"case\">mps: 1\ndpp: 3 m\n</script>\n");
    assert_int_equal(read_in(folder, "page.html", &c), MPS_E_ARG);
    assert_true(kit_has(c, 4, 1, "unknown key 'dpp'"));
    mps_case_destroy(c);
    write_file(folder, "empty.html", "<html></html>\n");
    assert_int_equal(read_in(folder, "empty.html", &c), MPS_E_IO);
    assert_true(kit_has(c, 0, 0, "the page has no case"));
    mps_case_destroy(c);
    remove_folder(folder);
}

#define SWEPT CASE "sweep: {dp: 4 8 mm, model: [imps, mmps], run.until: 1 to 2 step 0.5 s}\n"

static void sweeps(void **state)
{
    static const char *const set[] = {"dp=6 mm", NULL};
    char text[60];
    (void)state;
    mps_case *c = good(SWEPT, NULL);
    assert_int_equal(mps_case_runs(c), 12);
    assert_int_equal(mps_case_sweep_count(c), 3);
    assert_int_equal(mps_case_sweep_get(c, 11, 0, text, sizeof text), MPS_OK);
    assert_string_equal(text, "dp=8 mm");
    assert_int_equal(mps_case_sweep_get(c, 3, 1, text, sizeof text), MPS_OK);
    assert_string_equal(text, "model=mmps");
    assert_int_equal(mps_case_sweep_get(c, 4, 2, text, sizeof text), MPS_OK);
    assert_string_equal(text, "run.until=1.5 s");
    assert_int_equal(mps_case_sweep_get(c, 12, 0, text, sizeof text), MPS_E_ARG);
    assert_int_equal(mps_case_sweep_get(c, 0, 3, text, sizeof text), MPS_E_ARG);
    assert_int_equal(mps_case_sweep_get(c, 0, 0, text, 3), MPS_E_ARG);
    assert_int_equal(mps_case_sweep_get(c, 0, 0, NULL, 3), MPS_E_ARG);
    mps_case_destroy(c);
    c = good(SWEPT, set); /* what is set is no longer swept */
    assert_int_equal(mps_case_runs(c), 6);
    assert_null(strstr(mps_case_text(c), "dp: 4"));
    mps_case_destroy(c);
    c = good(CASE, NULL);
    assert_int_equal(mps_case_runs(c), 1);
    assert_int_equal(mps_case_sweep_count(c), 0);
    assert_int_equal(mps_case_sweep_get(c, 0, 0, text, sizeof text), MPS_E_ARG);
    mps_case_destroy(c);
    kit_refused(CASE "sweep: {dpp: 4 8 mm}\n", 7, 9,
                "'dpp' is no path of a value; did you mean 'dp'?");
    kit_refused(CASE "sweep: {tank: 4 8 mm}\n", 7, 9,
                "'tank' is no path of a value, as 'motion.roll.period'");
    kit_refused(CASE "sweep: {dp: 4 8 s}\n", 7, 13, "is the unit of a time");
    kit_refused(CASE "sweep: {dp: 2 to 1 step 1 mm}\n", 7, 13, "values are wanted");
    kit_refused(CASE "sweep: {model: [imps, nothing, 3]}\nsweeps: 1\n", 8, 1,
                "did you mean 'sweep'?");
    kit_refused(CASE "sweep: {dp: 1 to 1000 step 1 mm, run.cfl: 0.001 to 0.9 step 0.001}\n", 7, 1,
                "runs, 100000 at most");
    kit_refused(CASE "sweep: []\n", 7, 8, "a map of paths");
}

/* What the code that builds a case reads. */
static void reads(void **state)
{
    double x[3];
    (void)state;
    mps_case *c = good(
        "mps: 1\ndp: 4 mm\ntank: {size: 0.8 0.5 m, up: z}\nfill: [{water: {depth: 25 %}}]\n"
        "motion: {surge: {amplitude: 2 dp, period: 0.5 T1, ramp: 2}}\n"
        "sensors: {P: {wall: 0 50 mm, average: 0}, F: {panel: [0 1 m, 2 3 4 m]}}\n"
        "output: {film: yes}\nuse: viscosity.pair\nremove: [collision, shift]\n"
        "settings: {tension.radius: 12 mm, gas.sound: 340 m/s}\nrun: {until: 1 s}\n",
        NULL);
    const tree_node *root = mps__case_root(c), *tank = mps__tree_find(root, "tank"),
                    *surge = mps__tree_find(mps__tree_find(root, "motion"), "surge"),
                    *sensors = mps__tree_find(root, "sensors"), *p = mps__tree_find(sensors, "P"),
                    *panel = mps__tree_find(mps__tree_find(sensors, "F"), "panel"),
                    *water = mps__tree_find(mps__tree_find(root, "fill"), "water"),
                    *settings = mps__tree_find(root, "settings");
    assert_true(mps__read_number(c, root, "dp", 0) == 0.004);
    mps__case_scale_set(c, (read_scale){0.004, NAN, 2});
    assert_int_equal(mps__read_numbers(c, tank, "size", 3, x), 2);
    assert_int_equal(mps__read_choice(c, tank, "up", 1), 2);
    assert_int_equal(mps__read_choice(c, tank, "open", 5), 5);
    assert_true(mps__read_number(c, surge, "amplitude", 0) == 2 * 0.004);
    assert_true(mps__read_is(c, surge, "ramp", UNIT_NONE));
    assert_false(mps__read_is(c, surge, "period", UNIT_NONE));
    assert_true(mps__read_number(c, water, "depth", 0) == 0.5);
    assert_true(mps__read_number(c, p, "average", 7) == 0);
    assert_true(mps__read_number(c, p, "diameter", 7) == 7);
    assert_int_equal(mps__read_values(c, panel->last, 3, x), 3);
    assert_true(x[2] == 4);
    assert_true(mps__read_flag(c, mps__tree_find(root, "output"), "film", false));
    assert_true(mps__read_flag(c, root, "pieces", true));
    assert_string_equal(mps__read_text(c, root, "model", "none"), "none");
    assert_string_equal(mps__read_text_at(c, root, "use", 0), "viscosity.pair");
    assert_null(mps__read_text_at(c, root, "use", 1));
    assert_string_equal(mps__read_text_at(c, root, "remove", 1), "shift");
    assert_null(mps__read_text_at(c, root, "remove", 2));
    assert_true(mps__read_setting(c, mps__tree_find(settings, "tension.radius"), 0) ==
                0.012 / 0.004);
    assert_true(mps__read_setting(c, mps__tree_find(settings, "gas.sound"), 0) == 340);
    assert_false(mps__case_failed(c));
    assert_string_equal(mps__case_unread(c)->key, "mps");
    mps__read_all(mps__tree_find(root, "mps"));
    assert_string_equal(mps__case_unread(c)->key, "period");
    assert_true(mps__read_number(c, surge, "period", 9) == 9);
    assert_true(
        kit_has(c, 5, 43, "motion.surge.period: 'T1' is not known here; write a time in s"));
    mps_case_destroy(c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(reads_back), cmocka_unit_test(sets),
                                       cmocka_unit_test(wrong_sets), cmocka_unit_test(groups),
                                       cmocka_unit_test(bases),      cmocka_unit_test(pages),
                                       cmocka_unit_test(sweeps),     cmocka_unit_test(reads)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

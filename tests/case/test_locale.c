/* SPDX-License-Identifier: BSD-3-Clause */
/* An application whose locale has a decimal comma: all texts that libmps and libmps_case read or
 * write are those of the locale C. */
#include "build_kit.h"
#include "locale_kit.h"
#include <errno.h>
#include <mps/mps.h>
#include <mps/page.h>
#include <mps/picture.h>
#include <mps/stats.h>

enum { TEXTS = 40 };

#define TABLE "test_locale.csv"
#define STL   "test_locale.stl"

/* Texts of one locale, by name. */
typedef struct texts {
    int count;
    char name[TEXTS][80], *text[TEXTS];
} texts;

static void keep(texts *t, const char *name, char *text)
{
    assert_true(t->count < TEXTS);
    assert_non_null(text);
    snprintf(t->name[t->count], sizeof t->name[0], "%s", name);
    t->text[t->count++] = text;
}

/* Drop the lines of a text that have clocks or the name of the folder. */
static char *steady(char *text)
{
    static const char *const clocks[] = {
        "cost  ", "wall clock", "_s\": ", "s_per_step", "_rss_", "\"date\""};
    char *to = text;
    for (char *line = text, *next; *line; line = next) {
        next = line + strcspn(line, "\n");
        next += *next == '\n';
        const char kept = *next;
        bool drop = false;
        *next = '\0';
        for (size_t k = 0; k < sizeof clocks / sizeof *clocks; k++)
            drop = drop || strstr(line, clocks[k]);
        *next = kept;
        const size_t length = (size_t)(next - line);
        if (!drop) memmove(to, line, length);
        if (!drop) to += length;
    }
    *to = '\0';
    return text;
}

static void keep_file(texts *t, const char *folder, const char *name)
{
    char path[300];
    FILE *file;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    file = fopen(path, "rb");
    if (!file) fail_msg("%s: %s", path, strerror(errno));
    char *text = calloc(1, 1 << 20);
    assert_non_null(text);
    assert_true(fread(text, 1, (1 << 20) - 1, file) > 0);
    fclose(file);
    keep(t, name, steady(text));
}

static void write_file(const char *name, const char *text)
{
    FILE *file = fopen(name, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static void log_line(void *user, int level, const char *text)
{
    char *all = user;
    (void)level;
    snprintf(all + strlen(all), 20000 - strlen(all), "%s\n", text);
}

/* ---- libmps_case ---- */

static const char tank[] =
    "mps: 1\ndp: 50 mm\ntank: {size: 0.8 0.5 m}\nfill: [{water: {depth: 41 %%}}]\n"
    "motion: {file: %s/" TABLE "}\n"
    "impacts: {threshold: 0.5 kPa, window: 0.35 s, from: 0.012 s, scale: 1.5}\n"
    "sensors:\n  P: {wall: 0 0.1 m}\n  eta: {gauge: 0.25 m}\n"
    "reference: {P: {file: %s/" TABLE ", columns: [time, p], unit: kPa}}\n"
    "run: {until: 0.02 s, solver: sundials.pcg}\n"
    "output: {frames: 2, page: 1.5 MB, pictures: 0.015 s, trace: yes}\n%s";

static mps_case *read_case(const char *more)
{
    char folder[400], text[2000];
    mps_case *c = NULL;
    assert_non_null(getcwd(folder, sizeof folder));
    snprintf(text, sizeof text, tank, folder, folder, more);
    const mps_status status = kit_read(text, NULL, &c);
    char *all = kit_messages(c);
    if (status != MPS_OK) fail_msg("%s", all);
    free(all);
    return c;
}

static void check_cases(texts *t)
{
    static const char *const more[] = {
        "", "sweep: {dp: \"12.5 to 13.5 step 0.5 mm\", run.cfl: 0.25 0.3}\n"};
    for (int k = 0; k < 2; k++) {
        char value[100], *text, *sketch;
        mps_case *c = read_case(more[k]);
        if (mps_case_check(c, &text, &sketch) != MPS_OK) fail_msg("%s", kit_messages(c));
        keep(t, "check", steady(text));
        keep(t, "sketch", sketch);
        keep(t, "case", strdup(mps_case_text(c)));
        for (int64_t i = 0; k == 1 && i < mps_case_runs(c); i++) {
            assert_int_equal(mps_case_sweep_get(c, i, 0, value, sizeof value), MPS_OK);
            keep(t, "sweep", strdup(value));
        }
        mps_case_destroy(c);
    }
    char *schema = malloc(mps_case_schema_write(NULL, 0) + 1);
    mps_case_schema_write(schema, mps_case_schema_write(NULL, 0) + 1);
    keep(t, "schema", schema);
}

static void run_case(texts *t, const char *folder)
{
    mps_job_config options;
    mps_job *job;
    mps_sim *sim;
    char error[600] = "";
    mps_case *c = read_case("");
    assert_int_equal(mps_job_config_init(&options, sizeof options), MPS_OK);
    options.folder = folder;
    options.overwrite = 1;
    options.quiet = 1;
    options.error = error;
    options.error_size = sizeof error;
    if (mps_case_job(c, &options, &job, &sim) != MPS_OK) fail_msg("%s", kit_messages(c));
    if (mps_job_run(job, sim) != MPS_EXIT_OK) fail_msg("%s", error);
    mps_sim_destroy(sim);
    mps_job_destroy(job);
    mps_case_destroy(c);
    static const char *const files[] = {"probes.csv",  "steps.csv",    "momentum.csv",
                                        "trace.csv",   "frames.pvd",   "case.yaml",
                                        "paraview.py", "summary.json", "frames/frames_000001.vtp"};
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) keep_file(t, folder, files[k]);
}

/* Files that are equal in both locales. */
static void of_folder(texts *t, const char *folder)
{
    char error[600];
    mps_page_config page;
    assert_int_equal(mps_page_config_init(&page, sizeof page), MPS_OK);
    page.error = error;
    page.error_size = sizeof error;
    if (mps_page_write(folder, &page, NULL) != MPS_OK) fail_msg("%s", error);
    keep_file(t, folder, "report.html");
    assert_int_equal(mps_paraview_save(folder, error, sizeof error), MPS_OK);
    keep_file(t, folder, "paraview.py");
}

static void statistics(texts *t, const char *folder)
{
    char text[400] = "", error[300];
    mps_stats_config c;
    mps_stats_constant k = {.struct_size = sizeof k};
    assert_int_equal(mps_stats_config_init(&c, sizeof c), MPS_OK);
    c.error = error;
    c.error_size = sizeof error;
    if (mps_stats_config_read(folder, &c) != MPS_OK) fail_msg("%s", error);
    assert_int_equal(mps_stats_config_set(&c, "impacts.high_pass=1.25 Hz"), MPS_OK);
    same_number(c.threshold, 500, 0);
    same_number(c.window, 0.35, 0);
    same_number(c.length_scale, 1.5, 0);
    same_number(c.high_pass, 1.25, 0);
    assert_true(c.period > 1.2 && c.period < 1.3);
    mps_quantity_write(0.0525, "m", text, sizeof text);
    keep(t, "quantity", strdup(text));
    (void)k;
}

/* ---- libmps ---- */

static void library(texts *t)
{
    static const char stl[] = "solid box\nfacet normal 0 0 0\nouter loop\nvertex 0.25 0 0\nvertex "
                              "0 0.5 0\nvertex 0 0 0.75\nendloop\nendfacet\nendsolid box\n";
    static char log[20000];
    mps_config config;
    mps_sim *sim;
    mps_stl surface;
    log[0] = '\0';
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dim = 3;
    config.dp = 0.0525;
    config.log = log_line;
    config.log_user = log;
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    write_file(STL, stl);
    assert_int_equal(mps_stl_init(&surface, sizeof surface), MPS_OK);
    assert_true(mps_stl_add(sim, STL, &surface, NULL) < 0); /* one triangle is not closed */
    log_line(log, 0, mps_sim_error(sim));
    assert_true(mps_model_set(sim, "collision", "distance", 77.25) < 0);
    log_line(log, 0, mps_sim_error(sim));
    mps_sim_destroy(sim);
    keep(t, "log", strdup(log));
}

static void all(texts *t, const char *folder)
{
    write_file(TABLE, "time[s],surge[m],p[kPa]\n0,0,0.5\n0.01,0.0001,1.5\n0.5,0.0125,2.5\n");
    check_cases(t);
    run_case(t, folder);
    statistics(t, folder);
    library(t);
}

static void comma(void **state)
{
    static texts plain, other;
    (void)state;
    all(&plain, "test_locale_c");
    locale_begin("de_DE.UTF-8");
    all(&other, "test_locale_c");
    of_folder(&other, "test_locale_c");
    locale_end();
    of_folder(&plain, "test_locale_c");
    assert_int_equal(plain.count, other.count);
    for (int k = 0; k < plain.count; k++) {
        const char *a = plain.text[k], *b = other.text[k];
        while (*a && *a == *b) a++, b++;
        if (*a != *b) fail_msg("%s: '%.60s', not '%.60s'", plain.name[k], b, a);
        free(plain.text[k]);
        free(other.text[k]);
    }
}

/* Letters are those of ASCII: in Turkish the small letter of I is another. */
static void letters(void **state)
{
    mps_case *c = NULL;
    char folder[400], text[700], *all, *sketch;
    (void)state;
    assert_non_null(getcwd(folder, sizeof folder));
    write_file(TABLE, "TIME[s],PITCH[deg]\n0,0\n1,0.5\n");
    snprintf(text, sizeof text,
             "mps: 1\ndp: 0.1 m\ntank: {size: 0.8 0.5 m}\nfill: [{water: {depth: 40 %%}}]\n"
             "motion: {file: %s/" TABLE ", forward: x}\nrun: {until: 0.02 s}\n",
             folder);
    locale_begin("tr_TR.UTF-8");
    assert_int_equal(kit_read(text, NULL, &c), MPS_OK);
    if (mps_case_check(c, &all, &sketch) != MPS_OK) fail_msg("%s", kit_messages(c));
    locale_end();
    assert_non_null(strstr(all, "pitch: at most"));
    free(all);
    free(sketch);
    mps_case_destroy(c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(comma), cmocka_unit_test(letters)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

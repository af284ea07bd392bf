/* SPDX-License-Identifier: BSD-3-Clause */
/* Each function of libmps_case in an application whose locale has a decimal comma: what it returns
 * and writes is that of the locale C. The list is complete: it is compared with the public
 * headers. */
#include "build_kit.h"
#include "job_fixture.h"
#include "locale_kit.h"
#include <ctype.h>
#include <glob.h>
#include <mps/case.h>
#include <mps/page.h>
#include <mps/picture.h>
#include <mps/plugin.h>
#include <mps/stats.h>
#include <sys/stat.h>

#define FOLDER "test_locale_entries"

enum { SPACE = 1 << 22, ROWS = 4000 };

/* What the functions of a group returned, bit by bit. */
static struct {
    size_t used;
    char *bytes;
} kept;

static void keep(const void *from, size_t size)
{
    assert_true(kept.used + size < SPACE);
    memcpy(kept.bytes + kept.used, from, size);
    kept.used += size;
}

static void keep_number(double value)
{
    keep(&value, sizeof value);
}

static void keep_text(const char *text)
{
    assert_non_null(text);
    keep(text, strlen(text));
    keep("\n", 1);
}

/* Without the lines that have clocks, and without dates. */
static void keep_lines(const char *text)
{
    static const char *const clocks[] = {"wall clock", "cost  ",   "_s\": ",    "s_per_step",
                                         "_rss_",      "\"date\"", "ms a step", "memory"};
    for (const char *next; *text; text = next) {
        char line[600];
        bool drop = false;
        next = text + strcspn(text, "\n");
        next += *next == '\n';
        snprintf(line, sizeof line, "%.*s", (int)(next - text), text);
        for (size_t k = 0; k < sizeof clocks / sizeof *clocks; k++)
            drop = drop || strstr(line, clocks[k]);
        if (!drop) keep(text, (size_t)(next - text));
    }
}

static void keep_file(const char *name)
{
    const char *text = text_of(FOLDER, name);
    if (!text[0]) fail_msg("no %s", name);
    keep_lines(text);
}

static void write_text(const char *path, const char *text, mode_t mode)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
    assert_int_equal(chmod(path, mode), 0);
}

/* ---- cases ---- */

#define TANK                                                                                   \
    "mps: 1\ndp: 40.5 mm\ntank: {size: 0.81 0.5 m}\n"                                          \
    "fill: [{water: {depth: 41.5 %}}]\nmotion: {surge: {amplitude: 1.5 mm, period: 1.25 s}}\n" \
    "sensors: {P: {wall: 0 0.1 m}}\nimpacts: {threshold: 0.5 kPa}\n"                           \
    "reference: {P: {times: 0.015 0.5 s, values: 1.25 1.5 kPa}}\nrun: {until: 0.05 s}\n"

static void read_cases(void)
{
    static const char *const sets[] = {"dp=42.5 mm"};
    mps_case_options options;
    mps_case *c[4] = {NULL};
    char text[4000];
    write_text(FOLDER ".yaml", TANK, 0600);
    assert_int_equal(mps_case_options_init(&options, sizeof options), MPS_OK);
    assert_int_equal(mps_case_open(FOLDER ".yaml", &options, &c[0]), MPS_OK);
    assert_int_equal(mps_case_read(FOLDER ".yaml", 1, sets, &c[1]), MPS_OK);
    assert_int_equal(mps_case_read_text(TANK "sweep: {dp: 40.5 to 41.5 step 0.5 mm}\n",
                                        sizeof TANK "sweep: {dp: 40.5 to 41.5 step 0.5 mm}\n" - 1,
                                        "case", 0, NULL, &c[2]),
                     MPS_OK);
    for (int k = 0; k < 3; k++) keep_text(mps_case_text(c[k]));
    keep_number((double)mps_case_runs(c[2]));
    for (int64_t i = 0; i < mps_case_runs(c[2]); i++)
        for (int32_t k = 0; k < mps_case_sweep_count(c[2]); k++) {
            assert_int_equal(mps_case_sweep_get(c[2], i, k, text, sizeof text), MPS_OK);
            keep_text(text);
        }
    assert_true(mps_case_read_text("mps: 1\ndp: 1,5 mm\nrun: {until: -1.5 s, cfl: 1.5}\n", 49,
                                   "bad", 0, NULL, &c[3]) < 0);
    for (int32_t k = 0; k < mps_case_message_count(c[3]); k++) {
        mps_case_message m = {.struct_size = sizeof m};
        assert_int_equal(mps_case_message_get(c[3], k, &m), MPS_OK);
        keep_text(m.text);
    }
    assert_true(mps_case_messages_write(c[3], text, sizeof text) > 100);
    keep_text(text);
    for (int k = 0; k < 4; k++) mps_case_destroy(c[k]);
}

static void check_case(void)
{
    mps_case *c = NULL;
    mps_case_cost cost = {.struct_size = sizeof cost};
    char *text = NULL, *sketch = NULL;
    assert_int_equal(mps_case_read(FOLDER ".yaml", 0, NULL, &c), MPS_OK);
    assert_int_equal(mps_case_check(c, &text, &sketch), MPS_OK);
    assert_int_equal(mps_case_cost_get(c, &cost), MPS_OK);
    assert_true(cost.wall_least > 0 && cost.wall_most < 3600); /* clocks differ */
    keep_lines(text);
    keep_text(sketch);
    free(text);
    free(sketch);
    mps_case_destroy(c);
}

static void language(void)
{
    char unit[32], *schema = malloc(mps_case_schema_write(NULL, 0) + 1);
    double value = NAN;
    mps_case_key key = {.struct_size = sizeof key};
    assert_non_null(schema);
    mps_case_schema_write(schema, mps_case_schema_write(NULL, 0) + 1);
    keep_text(schema);
    free(schema);
    assert_int_equal(mps_case_quantity("1.5 T1", 0.1, 1.25, &value, unit, sizeof unit), MPS_OK);
    keep_number(value);
    keep_text(unit);
    assert_true(mps_case_quantity("1,5 T1", 0.1, 1.25, &value, unit, sizeof unit) < 0);
    keep_number(mps_unit_factor("mm", "m"));
    for (int32_t k = 0; mps_case_key_get(k, &key) == MPS_OK; k++) {
        keep_text(key.range);
        keep_text(key.otherwise);
        keep_text(key.example);
    }
}

/* The folder of a run; later groups read that of the locale C, whose clocks pages have. */
static void run_case(void)
{
    const char *below = localeconv()->decimal_point[0] == ',' ? "comma" : ".";
    char path[100];
    mps_case *c = NULL;
    mps_job *job;
    mps_sim *sim;
    double value = NAN;
    mps_job_column column;
    mps_job_config config;
    assert_int_equal(mps_job_config_init(&config, sizeof config), MPS_OK);
    snprintf(path, sizeof path, FOLDER "/%s", below);
    config.folder = path;
    config.quiet = 1;
    config.overwrite = 1;
    config.trace = 1;
    assert_int_equal(mps_case_read(FOLDER ".yaml", 0, NULL, &c), MPS_OK);
    assert_int_equal(mps_case_job(c, &config, &job, &sim), MPS_OK);
    assert_int_equal(mps_job_column_init(&column, sizeof column), MPS_OK);
    assert_int_equal(mps_job_column_get(job, 0, &column), MPS_OK);
    keep_text(column.about);
    assert_int_equal(mps_job_run(job, sim), MPS_EXIT_OK);
    assert_int_equal(mps_job_column_read(job, sim, 0, &value), MPS_OK);
    keep_number(value);
    mps_job_destroy(job);
    mps_sim_destroy(sim);
    mps_case_destroy(c);
    static const char *const files[] = {"probes.csv", "steps.csv",  "momentum.csv", "trace.csv",
                                        "case.yaml",  "frames.pvd", "summary.json"};
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
        snprintf(path, sizeof path, "%s/%s", below, files[k]);
        keep_file(path);
    }
}

/* ---- jobs ---- */

static double value_of(void *user, mps_sim *sim)
{
    (void)user, (void)sim;
    return 0.125;
}

static void add_columns(mps_job *job, mps_sim *sim)
{
    mps_probe probe;
    mps_measure measure;
    mps_trace trace;
    assert_int_equal(mps_probe_init(&probe, sizeof probe), MPS_OK);
    probe.type = MPS_PROBE_GAUGE;
    probe.at[0] = 0.125;
    assert_int_equal(mps_job_probe_add(job, sim, &probe, 0, 0.2, "eta", NULL), MPS_OK);
    assert_int_equal(mps_job_value_add(job, "v", "m", "An eighth", 0, value_of, NULL), MPS_OK);
    assert_int_equal(mps_job_figure_add(job, "f", "An eighth", 0, value_of, NULL), MPS_OK);
    assert_int_equal(mps_measure_init(&measure, sizeof measure), MPS_OK);
    measure.measure = "front";
    assert_int_equal(mps_job_measure_add(job, sim, &measure), MPS_OK);
    assert_int_equal(mps_trace_init(&trace, sizeof trace), MPS_OK);
    trace.kind = MPS_TRACE_MEAN;
    trace.name = "mean";
    trace.column = "eta";
    trace.from = 0.0125;
    trace.to = 0.0375;
    assert_int_equal(mps_job_trace_add(job, &trace), MPS_OK);
    ASSERT_JOB_REFUSED(job, mps_job_probe_add(job, sim, &probe, 9, 0.5, "x", NULL), MPS_E_ARG, "9");
    keep_text(mps_job_error(job));
}

static void own_job(void)
{
    const double t[2] = {0.0125, 0.5}, p[2] = {1.5, 2.5};
    const double ends[6] = {0.5, 0.5, 0.75, 0.25, 0.125, 0.375};
    mps_job *job;
    mps_sim *sim = water();
    mps_reference r;
    mps_job_config config = config_of(FOLDER "/own");
    config.overwrite = 1;
    config.dp = 0.0405;
    job = job_of(&config);
    add_columns(job, sim);
    assert_int_equal(mps_reference_init(&r, sizeof r), MPS_OK);
    r.label = "by hand";
    r.unit = "m";
    r.count = 2;
    r.t = t;
    r.value = p;
    assert_int_equal(mps_job_reference_add(job, &r), MPS_OK);
    assert_int_equal(mps_job_level_set(job, 0.2), MPS_OK);
    assert_int_equal(mps_job_input_add(job, "depth", "0.2 m"), MPS_OK);
    assert_int_equal(mps_job_outline_add(job, 2, ends), MPS_OK);
    assert_int_equal(mps_job_edges_add(job, 1, ends), MPS_OK);
    mps_job_log(job, 1, "0.5 m");
    mps_job_print(job, "1.5 m\n");
    assert_int_equal(mps_job_run(job, sim), MPS_EXIT_OK);
    keep_lines(said);
    mps_job_destroy(job);
    mps_sim_destroy(sim);
    keep_file("own/probes.csv");
    keep_file("own/summary.json");
    config.t_end = -1.5;
    refused(&config, MPS_E_ARG, "t_end");
    assert_true(mps_job_create(&config, &job) < 0);
}

static void lists(void)
{
    char *text = NULL;
    mps_measure_info info;
    assert_int_equal(mps_job_models_text(&text), MPS_OK);
    keep_text(text);
    free(text);
    assert_int_equal(mps_measure_info_init(&info, sizeof info), MPS_OK);
    for (int32_t k = 0; mps_measure_info_get(k, &info) == MPS_OK; k++) keep_text(info.help);
}

/* ---- series ---- */

static double t_[ROWS], p_[ROWS];
static char stats_text[300];

#define DONE(call)                                                   \
    do {                                                             \
        if ((call) != MPS_OK) fail_msg("%s: %s", #call, stats_text); \
    } while (0)

/* Pulses of growing height every 0.1 s. */
static mps_stats_config pulses(void)
{
    mps_stats_config c;
    assert_int_equal(mps_stats_config_init(&c, sizeof c), MPS_OK);
    c.error = stats_text;
    c.error_size = sizeof stats_text;
    for (int i = 0; i < ROWS; i++) {
        const double phase = fmod(i * 1e-3, 0.1);
        t_[i] = i * 1e-3;
        p_[i] = phase < 0.01 ? (1 + 0.37 * ((i / 100 * 7) % 11)) * 1e3 * (1 - phase / 0.01) : 0;
    }
    c.threshold = 500;
    c.window = 0.05;
    c.period = 1.25;
    c.omega = 62.5;
    c.length_scale = 1.5;
    return c;
}

static void keep_table(mps_table *table)
{
    for (int32_t k = -1; k < mps_table_columns(table); k++) {
        keep_text(mps_table_name(table, k));
        keep_text(mps_table_unit(table, k));
        keep_number(mps_table_is_common(table, k));
        keep(mps_table_values(table, k), (size_t)mps_table_rows(table) * sizeof(double));
    }
    keep_number(mps_table_is_points(table));
    keep_text(mps_table_label(table) ? mps_table_label(table) : "");
    mps_table_destroy(table);
}

static void tables(void)
{
    static const char *const name = "p";
    mps_stats_config c = pulses();
    mps_table *table = NULL;
    write_text(FOLDER ".csv", "t[s],p[kPa]\n0.5,1.25\n1.5,2.5\n", 0600);
    assert_int_equal(mps_table_read(&c, FOLDER ".csv", 1, &name, &table), MPS_OK);
    keep_table(table);
    assert_int_equal(mps_table_read_run(&c, FOLDER, "probes.csv", &table), MPS_OK);
    keep_table(table);
    assert_int_equal(mps_table_read_reference(&c, FOLDER, 0, &table), MPS_OK);
    keep_table(table);
    write_text(FOLDER ".csv", "t[s],p[kPa]\n0,5;1,25\n", 0600);
    assert_true(mps_table_read(&c, FOLDER ".csv", 1, &name, &table) < 0);
    keep_text(c.error);
}

static void compare_series(void)
{
    const double spacing[3] = {0.005, 0.01, 0.02}, value[3] = {1.125, 1.25, 1.5};
    mps_stats_config c = pulses();
    mps_series first = {.struct_size = sizeof first, .n = ROWS, .t = t_, .p = p_}, few = first;
    mps_comparison found;
    mps_harmonics h;
    mps_convergence order;
    mps_repeat r;
    few.n = 100;
    mps_comparison_init(&found, sizeof found);
    DONE(mps_series_compare(&c, &first, &first, &found));
    keep(&found, sizeof found);
    DONE(mps_points_compare(&c, &few, &first, &found));
    keep(&found, sizeof found);
    mps_harmonics_init(&h, sizeof h);
    h.omega = c.omega;
    DONE(mps_harmonics_find(&c, ROWS, t_, p_, &h));
    keep(&h, sizeof h);
    mps_convergence_init(&order, sizeof order);
    DONE(mps_converge(&c, spacing, value, &order));
    keep(&order, sizeof order);
    mps_repeat_init(&r, sizeof r);
    DONE(mps_repeat_find(&c, 3, value, &r));
    keep(&r, sizeof r);
}

/* ---- statistics ---- */

static void constants(void)
{
    mps_stats_config c = pulses();
    mps_stats_constant k = {.struct_size = sizeof k};
    char text[64];
    assert_int_equal(mps_stats_config_read(FOLDER, &c), MPS_OK);
    assert_int_equal(mps_stats_config_set(&c, "impacts.high_pass=1.25 Hz"), MPS_OK);
    assert_true(mps_stats_config_set(&c, "impacts.high_pass=1,25 Hz") < 0);
    keep_text(c.error);
    for (int32_t i = 0; mps_stats_constant_get(&c, i, &k) == MPS_OK; i++) {
        keep_text(k.key);
        keep_number(k.value);
    }
    keep_number(mps_stats_wants(&c, "P"));
    mps_quantity_write(0.0525, "m", text, sizeof text);
    keep_text(text);
}

static void keep_fits(const mps_stats_config *c, const mps_impacts *impacts)
{
    const double peaks[] = {1.5e3, 1.75e3, 2.5e3, 2.25e3, 3.5e3, 1.6e3, 1.9e3, 2.1e3};
    mps_fit fit;
    double mean[2], share, rate, value = NAN;
    const double *cells[2] = {t_, p_};
    mps_condition condition;
    mps_fit_init(&fit, sizeof fit);
    for (int32_t kind = MPS_FIT_WEIBULL; kind <= MPS_FIT_PARETO; kind++) {
        DONE(mps_impacts_fit_get(impacts, kind, &fit));
        keep_number(fit.value);
    }
    assert_int_equal(mps_fit_pareto(c, 8, peaks, 1e3, 100, &fit), MPS_OK);
    keep_number(fit.value);
    assert_int_equal(mps_fit_weibull(c, 8, peaks, 1e3, 100, &fit), MPS_OK);
    keep_number(fit.value);
    keep_number(mps_fit_value(&fit, 50));
    keep_number(mps_fit_exceedance(&fit, 2e3));
    assert_int_equal(mps_panel_mean(c, 2, 2, cells, mean), MPS_OK);
    keep(mean, sizeof mean);
    mps_condition_init(&condition, sizeof condition);
    condition.share = 0.5;
    condition.rate = 0.25;
    condition.fit = &fit;
    if (mps_long_term_exceedance(c, 1, &condition, 2e3, &share, &rate) == MPS_OK) keep_number(rate);
    if (mps_long_term_value(c, 1, &condition, 1e5, &value) == MPS_OK) keep_number(value);
    keep_text(c->error);
}

static void statistics(void)
{
    static char text[20000];
    static const char *const name = "P";
    mps_stats_config c = pulses();
    mps_impacts *impacts = NULL;
    mps_impacts_info info;
    mps_impact one;
    mps_exceedance point;
    mps_repeat r;
    mps_impacts_info_init(&info, sizeof info);
    mps_impact_init(&one, sizeof one);
    mps_exceedance_init(&point, sizeof point);
    mps_repeat_init(&r, sizeof r);
    DONE(mps_impacts_find(&c, ROWS, t_, p_, &impacts));
    DONE(mps_impacts_info_get(impacts, &info));
    keep_number((double)info.events);
    DONE(mps_impacts_get(impacts, 3, &one));
    keep_number(one.peak);
    DONE(mps_impacts_highest(impacts, 1, &one));
    keep_number(one.t);
    DONE(mps_impacts_exceedance(impacts, 1, &point));
    keep(&point, sizeof point);
    keep_fits(&c, impacts);
    assert_true(mps_stats_csv_write(1, &name, (const mps_impacts *const *)&impacts, text,
                                    sizeof text) < sizeof text);
    keep_text(text);
    mps_stats_json_write(1, &name, (const mps_impacts *const *)&impacts, 3, text, sizeof text);
    keep_text(text);
    const mps_impacts *const two[2] = {impacts, impacts};
    DONE(mps_repeat_peaks(&c, 2, two, 1, &r));
    keep(&r, sizeof r);
    mps_impacts_destroy(impacts);
}

/* ---- pages and pictures ---- */

static void pages(void)
{
    mps_page_config page;
    mps_page_info info;
    char error[300] = "";
    mps_page_config_init(&page, sizeof page);
    mps_page_info_init(&info, sizeof info);
    page.error = error;
    page.error_size = sizeof error;
    if (mps_page_write(FOLDER, &page, &info) != MPS_OK) fail_msg("%s", error);
    keep_file("report.html");
    if (mps_paraview_save(FOLDER, error, sizeof error) != MPS_OK) fail_msg("%s", error);
    keep_file("paraview.py");
}

/* The program of the film lists its arguments. */
static void pictures(void)
{
    mps_picture_config picture;
    mps_film_config film;
    mps_sim *sim = water();
    char error[300] = "";
    mps_picture_config_init(&picture, sizeof picture);
    picture.width = 400;
    picture.error = error;
    picture.error_size = sizeof error;
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    if (mps_picture_save(sim, &picture, FOLDER "/own.png") != MPS_OK) fail_msg("%s", error);
    if (mps_picture_frame_save(FOLDER, 1, &picture, FOLDER "/frame.png") != MPS_OK)
        fail_msg("%s", error);
    for (int k = 0; k < 2; k++) {
        FILE *file = fopen(k ? FOLDER "/own.png" : FOLDER "/frame.png", "rb");
        static char bytes[1 << 20];
        keep(bytes, file ? fread(bytes, 1, sizeof bytes, file) : 0);
        assert_non_null(file);
        fclose(file);
    }
    mps_sim_destroy(sim);
    write_text(FOLDER "/program",
               "#!/bin/sh\nprintf '%s\\n' \"$@\" | grep -v film > " FOLDER "/args\n"
               "cat > /dev/null\nfor last; do :; done\necho film > \"${last#file:}\"\n",
               0700);
    mps_film_config_init(&film, sizeof film);
    film.program = FOLDER "/program";
    film.rate = 12.5;
    film.width = 400;
    film.error = error;
    film.error_size = sizeof error;
    if (mps_film_save(FOLDER, &film, NULL) != MPS_OK) fail_msg("%s", error);
    keep_file("args");
}

/* ---- all ---- */

static const struct {
    const char *name;
    void (*make)(void);
} groups[] = {{"read_cases", read_cases}, {"check_case", check_case}, {"language", language},
              {"run_case", run_case},     {"own_job", own_job},       {"lists", lists},
              {"tables", tables},         {"constants", constants},   {"statistics", statistics},
              {"pages", pages},           {"pictures", pictures},     {"series", compare_series}};

enum { GROUPS = sizeof groups / sizeof *groups };

static void same_in_a_comma_locale(void **state)
{
    static struct {
        size_t size;
        char *bytes;
    } plain[GROUPS];
    (void)state;
    kept.bytes = malloc(SPACE);
    assert_non_null(kept.bytes);
    for (int comma = 0; comma < 2; comma++) {
        if (comma) locale_begin("de_DE.UTF-8");
        for (int k = 0; k < GROUPS; k++) {
            kept.used = 0;
            groups[k].make();
            assert_true(kept.used > 0);
            if (!comma) {
                plain[k].size = kept.used;
                plain[k].bytes = malloc(kept.used);
                memcpy(plain[k].bytes, kept.bytes, kept.used);
                continue;
            }
            size_t at = 0;
            while (at < kept.used && at < plain[k].size && kept.bytes[at] == plain[k].bytes[at])
                at++;
            if (at < kept.used || kept.used != plain[k].size)
                fail_msg("%s, byte %zu: '%.40s', not '%.40s'", groups[k].name, at, kept.bytes + at,
                         plain[k].bytes + at);
            assert_string_equal(localeconv()->decimal_point, ","); /* it is the application's */
            free(plain[k].bytes);
        }
    }
    locale_end();
    free(kept.bytes);
}

/* ---- completeness ---- */

/* Functions of the headers that no group calls, and why. */
static const struct {
    const char *name, *why;
} without[] = {
    {"mps_job_ranks_load", "finds a library by its name"},
    {"mps_job_ranks_exit", "needs ranks; takes and returns whole numbers"},
    {"mps_job_plugin_add", "plugins/cases compares summary.json"},
    {"mps_job_stop", "has no value and no text"},
    {"mps_job_profile_text", "has clocks only"},
    {"mps_case_plugin", "plugins/plugins; it returns a handle"},
    {"mps_plugin_open", "plugins/plugins; its texts have no numbers"},
    {"mps_plugin_close", "has no value and no text"},
    {"mps_plugin_register", "plugins/plugins; its texts have no numbers"},
    {"mps_plugin_info_init", "has no text"},
    {"mps_plugin_info_get", "texts of the plug-in"},
    {"mps_plugin_item_init", "has no text"},
    {"mps_plugin_item_get", "texts of the plug-in"},
};

/* Number of times that the text has the name of a function before a bracket. */
static int calls(const char *text, const char *name)
{
    const size_t length = strlen(name);
    int count = 0;
    for (const char *at = text; (at = strstr(at, name)) != NULL; at += length)
        count += at[length] == '(' && at[-1] != '_';
    return count;
}

static char *read_all(const char *path)
{
    FILE *file = fopen(path, "r");
    char *text = calloc(1, SPACE);
    if (!file) fail_msg("%s", path);
    assert_non_null(text);
    assert_true(fread(text, 1, SPACE - 1, file) > 0);
    fclose(file);
    return text;
}

static int reason_of(const char *name)
{
    int k = (int)(sizeof without / sizeof *without) - 1;
    while (k >= 0 && strcmp(without[k].name, name) != 0) k--;
    return k;
}

/* Each function of a header is called here, or has a reason. */
static int check_header(const char *header, const char *source, bool *used)
{
    int count = 0;
    for (const char *next = header; (next = strstr(next, "MPS_API ")) != NULL;) {
        char name[80];
        const char *bracket = strchr(next, '('), *begin = bracket;
        assert_non_null(bracket);
        while (begin[-1] == '_' || isalnum((unsigned char)begin[-1])) begin--;
        snprintf(name, sizeof name, "%.*s", (int)(bracket - begin), begin);
        const int reason = reason_of(name), called = calls(source, name);
        if (called == 0 && reason < 0)
            fail_msg("%s: no group calls it, and it has no reason", name);
        if (called > 0 && reason >= 0) fail_msg("%s: has a reason, but is called", name);
        if (reason >= 0) used[reason] = true;
        next = bracket;
        count++;
    }
    return count;
}

static void the_list_is_complete(void **state)
{
    bool used[sizeof without / sizeof *without] = {false};
    char *source = read_all(PROJECT_FOLDER "/tests/case/test_locale_entries.c");
    int count = 0;
    (void)state;
    glob_t found;
    assert_int_equal(glob(MPS_HEADERS "/*.h", 0, NULL, &found), 0);
    for (size_t k = 0; k < found.gl_pathc; k++) {
        char *header = read_all(found.gl_pathv[k]);
        if (strstr(header, "libmps_case")) count += check_header(header, source, used);
        free(header);
    }
    globfree(&found);
    assert_true(count > 100);
    for (size_t k = 0; k < sizeof without / sizeof *without; k++)
        if (!used[k]) fail_msg("%s: is in no header", without[k].name);
    free(source);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_list_is_complete),
                                       cmocka_unit_test(same_in_a_comma_locale)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Jobs through their public header: refusals, outputs, stop and resume. */
#include "job_fixture.h"
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include "locale_kit.h"

static void configs_are_checked(void **state)
{
    (void)state;
    static const double down[] = {0.02, 0.01};
    const mps_job_config good = config_of("refused");
    mps_job_config c = good;
    assert_int_equal(mps_job_config_init(&c, sizeof c - 1), MPS_E_ARG);
    assert_int_equal(mps_job_config_init(NULL, sizeof c), MPS_E_ARG);
    c = good, c.name = NULL, refused(&c, MPS_E_ARG, "name is required");
    c = good, c.folder = "", refused(&c, MPS_E_ARG, "folder is required");
    c = good, c.t_end = 0, refused(&c, MPS_E_ARG, "t_end");
    c = good, c.t_end = NAN, refused(&c, MPS_E_ARG, "t_end");
    c = good, c.row_interval = -1, refused(&c, MPS_E_ARG, "row_interval");
    c = good, c.checkpoint = -1, refused(&c, MPS_E_ARG, "checkpoint");
    c = good, c.gravity = INFINITY, refused(&c, MPS_E_ARG, "gravity");
    c = good, c.dp = -0.1, refused(&c, MPS_E_ARG, "dp must be");
    c.dp = NAN, refused(&c, MPS_E_ARG, "dp must be");
    c = good, c.frames = -1, refused(&c, MPS_E_ARG, "frames");
    c = good, c.threads = 0, refused(&c, MPS_E_ARG, "threads");
    c = good, c.picture_count = 2, refused(&c, MPS_E_ARG, "picture_count");
    c.picture_t = down, refused(&c, MPS_E_ARG, "increasing");
    c = good, c.resume = c.overwrite = 1, refused(&c, MPS_E_ARG, "exclude each other");
    c = good, c.ranks = &(mps_job_ranks){.count = 1}, refused(&c, MPS_E_ARG, "ranks");
    assert_false(is_there(".", "refused"));
    c = good, c.folder = "/dev/null/below", refused(&c, MPS_E_IO, "/dev/null/below");
    c = good, c.struct_size--;
    mps_job *job;
    assert_int_equal(mps_job_create(&c, &job), MPS_E_ARG);
    assert_int_equal(mps_job_create(&good, NULL), MPS_E_ARG);
    assert_int_equal(mps_job_create(NULL, &job), MPS_E_ARG);
    mps_job_destroy(NULL);
}

static void folders_are_kept(void **state)
{
    (void)state;
    mps_job_config c = config_of("above/kept");
    mps_job *job = job_of(&c);
    assert_true(is_there("above/kept", "run.lock"));
    const pid_t other = fork(); /* locks are between processes */
    if (other == 0) {
        char error[1000] = "";
        mps_job *second;
        c.error = error;
        c.error_size = sizeof error;
        const mps_status status = mps_job_create(&c, &second);
        _exit(status == MPS_E_BUSY && strstr(error, "another run is writing there") ? 0 : 1);
    }
    int code = -1;
    assert_true(waitpid(other, &code, 0) == other && code == 0);
    mps_job_destroy(job);
    /* a job that did not run removes the folder that it made */
    assert_true(is_there("above", "."));
    assert_false(is_there("above/kept", "."));
    assert_int_equal(mkdir("above/kept", 0777), 0);
    FILE *earlier = fopen("above/kept/probes.csv", "w");
    assert_non_null(earlier);
    fclose(earlier);
    refused(&c, MPS_E_STATE, "there is an earlier run (probes.csv)");
    assert_false(is_there("above/kept", "run.lock"));
    c.overwrite = 1;
    mps_job_destroy(job_of(&c));
    assert_true(is_there("above/kept", "probes.csv")); /* nothing is removed before the run */
}

static double fixed(void *user, mps_sim *sim)
{
    (void)sim;
    return *(const double *)user;
}

static void names_are_checked(void **state)
{
    (void)state;
    const mps_job_config c = config_of("names");
    mps_job *job = job_of(&c);
    mps_sim *sim = water();
    mps_probe probe;
    double one = 1;
    assert_int_equal(mps_probe_init(&probe, sizeof probe), MPS_OK);
    assert_int_equal(mps_job_value_add(job, "a", "m", "A: x", 0, fixed, &one), MPS_OK);
    ASSERT_JOB_REFUSED(job, mps_job_value_add(job, "a", "m", "", 0, fixed, &one), MPS_E_NAME,
                       "'a'");
    ASSERT_JOB_REFUSED(job, mps_job_value_add(job, "ke", "m", "", 0, fixed, &one), MPS_E_NAME,
                       "'ke'");
    ASSERT_JOB_REFUSED(job, mps_job_value_add(job, "a,b", "m", "", 0, fixed, &one), MPS_E_ARG,
                       "letters, digits");
    ASSERT_JOB_REFUSED(job, mps_job_value_add(job, "", "m", "", 0, fixed, &one), MPS_E_ARG,
                       "letters, digits");
    ASSERT_JOB_REFUSED(job, mps_job_value_add(job, "b", "m\"", "", 0, fixed, &one), MPS_E_ARG,
                       "unit");
    ASSERT_JOB_REFUSED(job, mps_job_value_add(job, "b", "m", NULL, 0, fixed, &one), MPS_E_ARG,
                       "'about'");
    ASSERT_JOB_REFUSED(job, mps_job_value_add(job, "b", "m", "", 8, fixed, &one), MPS_E_ARG,
                       "flags");
    ASSERT_JOB_REFUSED(job, mps_job_value_add(job, "b", "m", "", 0, NULL, &one), MPS_E_ARG,
                       "function");
    assert_int_equal(mps_job_figure_add(job, "f", "about", 0, fixed, &one), MPS_OK);
    ASSERT_JOB_REFUSED(job, mps_job_figure_add(job, "f", "about", 0, fixed, &one), MPS_E_NAME,
                       "'f'");
    probe.at[0] = 9;
    ASSERT_JOB_REFUSED(job, mps_job_probe_add(job, sim, &probe, 0, 0, "P", NULL), MPS_E_ARG, "P: ");
    probe.at[0] = 0, probe.at[1] = 0.08;
    ASSERT_JOB_REFUSED(job, mps_job_probe_add(job, sim, &probe, 1, 0, "P", NULL), MPS_E_ARG,
                       "component");
    assert_int_equal(mps_job_probe_add(job, sim, &probe, 0, 0, "P", NULL),
                     MPS_OK); /* it left none */
    assert_int_equal(mps_job_level_set(job, 0.2), MPS_OK);
    ASSERT_JOB_REFUSED(job, mps_job_level_set(job, NAN), MPS_E_ARG, "level");
    ASSERT_JOB_REFUSED(job, mps_job_level_set(job, 0.2), MPS_E_NAME, "still_level");
    mps_sim_destroy(sim);
    mps_job_destroy(job);
}

static void references_are_checked(void **state)
{
    (void)state;
    static const double t[] = {0, 1, 0.5}, value[] = {1, 2, NAN};
    const mps_job_config c = config_of("references");
    mps_job *job = job_of(&c);
    mps_reference r;
    assert_int_equal(mps_reference_init(&r, sizeof r + 1), MPS_E_ARG);
    assert_int_equal(mps_reference_init(&r, sizeof r), MPS_OK);
    assert_int_equal(mps_job_reference_add(job, NULL), MPS_E_ARG);
    r.label = "known", r.unit = "Pa", r.t = t, r.value = value;
    ASSERT_JOB_REFUSED(job, mps_job_reference_add(job, &r), MPS_E_ARG, "'known'");
    r.count = 3;
    ASSERT_JOB_REFUSED(job, mps_job_reference_add(job, &r), MPS_E_ARG, "ascending");
    r.count = 2;
    assert_int_equal(mps_job_reference_add(job, &r), MPS_OK);
    r.label = NULL;
    ASSERT_JOB_REFUSED(job, mps_job_reference_add(job, &r), MPS_E_ARG, "label");
    ASSERT_JOB_REFUSED(job, mps_job_input_add(job, "", "x"), MPS_E_ARG, "key");
    mps_job_destroy(job);
}

/* Time, and the number of calls. */
static double now(void *user, mps_sim *sim)
{
    double t;
    mps_sim_time(sim, &t, NULL);
    ++*(int *)user;
    return t;
}

/* summary.json contains all data that the page needs; files have decimal points in any locale of
 * the program. */
static void outputs_are_complete(void **state)
{
    (void)state;
    static const double t[] = {0, 0.05}, value[] = {1, 2.5};
    mps_job_config c = config_of("complete");
    mps_probe probe;
    mps_reference r;
    int calls = 0;
    mps_measure centre;
    locale_begin("de_DE.UTF-8");
    c.title = "A \"title\" & more";
    c.command = "test --option";
    c.text = "mps: 1\n";
    c.report = 1;
    c.frames = 2;
    mps_job *job = job_of(&c);
    mps_sim *sim = water();
    assert_int_equal(mps_probe_init(&probe, sizeof probe), MPS_OK);
    probe.at[1] = 0.08;
    assert_int_equal(mps_job_probe_add(job, sim, &probe, 0, 0, "P1", NULL), MPS_OK);
    probe.type = MPS_PROBE_FORCE;
    assert_int_equal(mps_job_probe_add(job, sim, &probe, 2, 0, "M", NULL), MPS_OK);
    assert_int_equal(mps_job_value_add(job, "now", "s", "Time: of the step", 0, now, &calls),
                     MPS_OK);
    assert_int_equal(mps_reference_init(&r, sizeof r), MPS_OK);
    r.label = "known", r.unit = "Pa", r.t = t, r.value = value, r.count = 2, r.line = 1;
    assert_int_equal(mps_job_reference_add(job, &r), MPS_OK);
    assert_int_equal(mps_job_input_add(job, "dp", "40 mm"), MPS_OK);
    assert_int_equal(mps_job_level_set(job, 0.2), MPS_OK);
    ASSERT_JOB_REFUSED(job, mps_job_outline_add(job, 1, t), MPS_E_ARG, "two places");
    assert_int_equal(mps_job_outline_add(job, 2, (const double[]){0, 0, 0.4, 0}), MPS_OK);
    assert_int_equal(mps_measure_init(&centre, sizeof centre), MPS_OK);
    centre.measure = "centre", centre.name = "x_end", centre.at_end = 1;
    assert_int_equal(mps_job_measure_add(job, sim, &centre), MPS_OK);
    assert_int_equal(mps_job_run(job, sim), MPS_EXIT_OK);
    locale_end();
    assert_true(calls > 10);
    ASSERT_SAID("test: dp 0.04 m, ");
    ASSERT_SAID("outputs in complete");
    const char *summary = text_of("complete", "summary.json");
    static const char *const wanted[] = {
        "\"title\": \"A \\\"title\\\" & more\"",
        "\"command\": \"test --option\"",
        "{\"key\": \"dp\", \"value\": \"40 mm\"}",
        "{\"label\": \"known\", \"unit\": \"Pa\", \"column\": null, \"line\": true, \"points\": "
        "[[0, "
        "1], [0.05",
        "\"still_level\": 0.2",
        "\"x_end\": 0.2",
        "\"status\": \"ok\"",
        "{\"name\": \"P1\", \"unit\": \"Pa\", \"type\": \"wall_pressure\", \"at\": [0, 0.08, 0]",
        "{\"name\": \"M\", \"unit\": \"N m/m\", \"type\": \"moment\"",
        "\"tank_frame\": false",
        "[[0, 0], [0.4, 0]]",
        "{\"name\": \"phase 0\", \"density\": 1000, "};
    for (size_t k = 0; k < sizeof wanted / sizeof *wanted; k++)
        if (!strstr(summary, wanted[k])) fail_msg("summary.json has no %s: %s", wanted[k], summary);
    assert_string_equal(text_of("complete", "case.yaml"), "mps: 1\n");
    assert_true(is_there("complete", "report.html") && is_there("complete", "picture_end.png") &&
                is_there("complete", "frames/frames_000002.vtp"));
    assert_non_null(strstr(text_of("complete", "report.html"), "A &quot;title&quot; &amp; more"));
    /* the row of t = 0 has the pressure of the first step, at rest rho g h */
    assert_true(number_in("complete", "probes.csv", 0, 1) ==
                number_in("complete", "probes.csv", 1, 1));
    ASSERT_NEAR(number_in("complete", "probes.csv", 0, 1), 1000 * 9.81 * 0.12, 0.1 * 1177);
    for (int row = 0; row < 26; row++)
        ASSERT_NEAR(number_in("complete", "probes.csv", row, 3), 0.002 * row, 1e-12);
    assert_int_equal(mps_job_run(job, sim), MPS_EXIT_USAGE);
    ASSERT_SAID("a job runs once");
    ASSERT_JOB_REFUSED(job, mps_job_value_add(job, "b", "m", "", 0, now, &calls), MPS_E_STATE,
                       "has run");
    mps_sim_destroy(sim);
    mps_job_destroy(job);
}

/* Stop it from a callback. */
typedef struct stopper {
    mps_job *job;
    double at;
} stopper;

static double stop_at(void *user, mps_sim *sim)
{
    const stopper *s = user;
    double t;
    mps_sim_time(sim, &t, NULL);
    if (t >= s->at) mps_job_stop(s->job);
    return t;
}

static int32_t run_to(const char *folder, double stop, bool resume)
{
    mps_job_config c = config_of(folder);
    c.t_end = 0.3; /* the last 20 steps are fitted to it */
    c.resume = resume;
    mps_job *job = job_of(&c);
    mps_sim *sim = water();
    stopper s = {job, stop};
    assert_int_equal(mps_job_value_add(job, "now", "s", "Time", 0, stop_at, &s), MPS_OK);
    const int32_t code = mps_job_run(job, sim);
    mps_sim_destroy(sim);
    mps_job_destroy(job);
    return code;
}

static void stopped_jobs_go_on(void **state)
{
    (void)state;
    assert_int_equal(run_to("whole", 1, false), MPS_EXIT_OK);
    assert_int_equal(run_to("parts", 0.02, false), MPS_EXIT_INTERRUPTED);
    ASSERT_SAID("interrupted at t = ");
    assert_true(is_there("parts", "checkpoint.mps"));
    assert_int_equal(run_to("parts", 1, true), MPS_EXIT_OK);
    static const char *const files[] = {"probes.csv", "steps.csv", "momentum.csv"};
    for (int k = 0; k < 3; k++) {
        char *whole = strdup(text_of("whole", files[k]));
        assert_non_null(whole);
        assert_string_equal(whole, text_of("parts", files[k]));
        free(whole);
    }
    assert_int_equal(run_to("whole", 1, true), MPS_EXIT_OK);
    ASSERT_SAID("the run in 'whole' reached its end; its last steps from t = ");
}

static void signals_stop_a_job(void **state)
{
    (void)state;
    fflush(NULL);
    const pid_t other = fork();
    if (other == 0) {
        mps_job_config c = config_of("signalled");
        c.t_end = 1e4;
        c.signals = 1;
        mps_job *job = NULL;
        if (mps_job_create(&c, &job) != MPS_OK) _exit(1);
        _exit(mps_job_run(job, water()) == MPS_EXIT_INTERRUPTED ? 42 : 1);
    }
    const struct timespec moment = {.tv_nsec = 5000000};
    /* handlers are installed before the first step, whose row is flushed to the disk after many
     * others */
    while (!strchr(text_of("signalled", "probes.csv"), '\n')) nanosleep(&moment, NULL);
    int code;
    assert_int_equal(kill(other, SIGINT), 0);
    assert_true(waitpid(other, &code, 0) == other);
    assert_true(WIFEXITED(code) && WEXITSTATUS(code) == 42);
}

/* Figures over a column that is the time itself. */
static void traces_are_measured(void **state)
{
    (void)state;
    mps_job_config c = config_of("trace");
    mps_job *job = job_of(&c);
    mps_sim *sim = water();
    mps_trace t;
    int calls = 0;
    assert_int_equal(mps_job_value_add(job, "now", "s", "Time", 0, now, &calls), MPS_OK);
    assert_int_equal(mps_trace_init(&t, sizeof t - 1), MPS_E_ARG);
    static const struct {
        const char *name;
        int32_t kind;
        double wanted;
    } figures[] = {{"given", MPS_TRACE_GIVEN, 2},       {"change", MPS_TRACE_CHANGE, 0.01},
                   {"slope", MPS_TRACE_SLOPE, 0.5},     {"largest", MPS_TRACE_LARGEST, 0.02},
                   {"mean", MPS_TRACE_MEAN, 0.01},      {"integral", MPS_TRACE_INTEGRAL, 4e-4},
                   {"least", MPS_TRACE_LEAST, 0.01 / 2}};
    for (size_t k = 0; k < sizeof figures / sizeof *figures; k++) {
        assert_int_equal(mps_trace_init(&t, sizeof t), MPS_OK);
        t.name = figures[k].name, t.kind = figures[k].kind, t.column = "now";
        t.from = k == 6 ? 0.01 : 0.02 - 0.02 * (k != 1), t.to = 0.04, t.scale = 2;
        assert_int_equal(mps_job_trace_add(job, &t), MPS_OK);
    }
    ASSERT_JOB_REFUSED(job, mps_job_trace_add(job, &t), MPS_E_NAME, "'least'");
    t.name = "x", t.column = "nothing";
    ASSERT_JOB_REFUSED(job, mps_job_trace_add(job, &t), MPS_E_NAME, "'nothing'");
    t.column = "walls_x", t.to = NAN;
    ASSERT_JOB_REFUSED(job, mps_job_trace_add(job, &t), MPS_E_ARG, "must be numbers");
    t.to = 1, t.kind = MPS_TRACE_MEAN; /* beyond the end */
    assert_int_equal(mps_job_trace_add(job, &t), MPS_OK);
    t.name = "y", t.to = t.from - 0.001; /* an empty span */
    assert_int_equal(mps_job_trace_add(job, &t), MPS_OK);
    assert_int_equal(mps_job_run(job, sim), MPS_EXIT_OK);
    const char *summary = text_of("trace", "summary.json");
    for (size_t k = 0; k < sizeof figures / sizeof *figures; k++) {
        char key[40];
        snprintf(key, sizeof key, "\n  \"%s\": ", figures[k].name);
        const char *at = strstr(summary, key);
        assert_non_null(at);
        /* a value is constant over its step: means are delayed by half a step */
        ASSERT_NEAR(strtod(at + strlen(key), NULL), figures[k].wanted,
                    k == 0 ? 0 : 0.25 * figures[k].wanted);
    }
    assert_non_null(strstr(summary, "\n  \"x\": null"));
    assert_non_null(strstr(summary, "\n  \"y\": null"));
    assert_non_null(strstr(text_of("trace", "trace.csv"), "walls_z[N s/m],now[s]\n"));
    mps_sim_destroy(sim);
    mps_job_destroy(job);
}

static void measures_are_listed(void **state)
{
    (void)state;
    mps_measure_info info;
    mps_measure m;
    int count = 0;
    const mps_job_config c = config_of("measures");
    mps_job *job = job_of(&c);
    mps_sim *sim = water();
    assert_int_equal(mps_measure_info_init(&info, sizeof info), MPS_OK);
    assert_int_equal(mps_measure_info_get(-1, &info), MPS_E_ARG);
    while (mps_measure_info_get(count, &info) == MPS_OK) {
        assert_int_equal(mps_measure_init(&m, sizeof m), MPS_OK);
        m.measure = info.name, m.radius = 0.1;
        assert_int_equal(mps_job_measure_add(job, sim, &m), MPS_OK);
        assert_true(strlen(info.help) > 10);
        count++;
    }
    assert_true(count >= 14);
    mps_job_column column;
    double value = NAN;
    int columns = 0;
    assert_int_equal(mps_job_column_init(&column, sizeof column), MPS_OK);
    while (mps_job_column_get(job, columns, &column) == MPS_OK) {
        assert_int_equal(mps_measure_info_get(columns, &info), MPS_OK);
        assert_string_equal(column.name, info.name);
        assert_string_equal(column.unit, info.unit);
        assert_int_equal(mps_job_column_read(job, sim, columns, &value), MPS_OK);
        columns += 1;
    }
    assert_int_equal(columns, count);
    assert_int_equal(mps_job_column_read(job, sim, count, &value), MPS_E_ARG);
    ASSERT_JOB_REFUSED(job, mps_job_measure_add(job, sim, &m), MPS_E_NAME, m.measure);
    m.measure = "fornt";
    ASSERT_JOB_REFUSED(job, mps_job_measure_add(job, sim, &m), MPS_E_NAME, "'fornt'");
    m.measure = "centre", m.name = "z", m.axis = 2;
    ASSERT_JOB_REFUSED(job, mps_job_measure_add(job, sim, &m), MPS_E_ARG, "axis");
    m.axis = 0, m.phase = 5, m.change = 1;
    ASSERT_JOB_REFUSED(job, mps_job_measure_add(job, sim, &m), MPS_E_STATE, "at the start");
    m.measure = "pressure_jump", m.phase = 0, m.radius = 0;
    ASSERT_JOB_REFUSED(job, mps_job_measure_add(job, sim, &m), MPS_E_ARG, "radius");
    m.measure = "circularity", m.smoothing = 0.5;
    ASSERT_JOB_REFUSED(job, mps_job_measure_add(job, sim, &m), MPS_E_ARG, "smoothing");
    mps_sim_destroy(sim);
    mps_job_destroy(job);
}

/* Values of measures of water in its lattice: 9 columns from 0.04 to 0.36 m, 5 rows from 0.04 to
 * 0.2 m. */
static void measures_are_right(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        int32_t axis;
        double level, wanted;
    } cases[] = {{"front", 0, 0, 0.36},
                 {"centre", 0, 0, 0.2},
                 {"centre", 1, 0, 0.12},
                 {"speed", 1, 0, 0},
                 {"gap", 0, 0, 0},
                 {"gap", 0, -0.02, 0.02},
                 {"angle", 0, 0, 0},
                 {"strays", 0, 0, 0},
                 {"trespass", 0, 0.15, 0.05},
                 {"trapped_gas", 0, 0, 0},
                 {"pockets", 0, 0, 0},
                 {"pocket_volume", 0, 0, 0},
                 {"pocket_pressure", 0, 0, 0},
                 {"gas_work", 0, 0, 0},
                 {"half_axis", 0, 0, 2 * 0.04 * 2.581988897}};
    enum { CASES = sizeof cases / sizeof *cases };
    mps_job_config c = config_of("right");
    c.t_end = 1e-6;
    mps_job *job = job_of(&c);
    mps_sim *sim = water();
    char names[CASES][16];
    for (int k = 0; k < CASES; k++) {
        mps_measure m;
        assert_int_equal(mps_measure_init(&m, sizeof m), MPS_OK);
        snprintf(names[k], sizeof names[k], "m%d", k);
        m.measure = cases[k].name, m.name = names[k], m.axis = cases[k].axis;
        m.level = cases[k].level;
        assert_int_equal(mps_job_measure_add(job, sim, &m), MPS_OK);
    }
    assert_int_equal(mps_job_run(job, sim), MPS_EXIT_OK);
    for (int k = 0; k < CASES; k++)
        ASSERT_NEAR(number_in("right", "probes.csv", 0, 1 + k), cases[k].wanted, 1e-9);
    mps_sim_destroy(sim);
    mps_job_destroy(job);
}

static void texts_are_made(void **state)
{
    (void)state;
    char *text = NULL;
    mps_sim *sim = water();
    assert_int_equal(mps_job_models_text(NULL), MPS_E_ARG);
    assert_int_equal(mps_job_models_text(&text), MPS_OK);
    assert_non_null(strstr(text, "### separation.void"));
    free(text);
    assert_int_equal(mps_job_profile_text(NULL, 1, &text), MPS_E_ARG);
    mps_profile_reset(sim);
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    assert_int_equal(mps_job_profile_text(sim, 1, &text), MPS_OK);
    assert_non_null(strstr(text, "neighbours"));
    free(text);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(configs_are_checked),  cmocka_unit_test(folders_are_kept),
        cmocka_unit_test(names_are_checked),    cmocka_unit_test(references_are_checked),
        cmocka_unit_test(outputs_are_complete), cmocka_unit_test(stopped_jobs_go_on),
        cmocka_unit_test(signals_stop_a_job),   cmocka_unit_test(traces_are_measured),
        cmocka_unit_test(measures_are_listed),  cmocka_unit_test(measures_are_right),
        cmocka_unit_test(texts_are_made)};
    return cmocka_run_group_tests(tests, enter_folder, leave_folder);
}

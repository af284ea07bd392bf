/* SPDX-License-Identifier: BSD-3-Clause */
/* Arguments that functions of jobs refuse, messages that a job passes on, and progress on a
 * terminal. */
#define _XOPEN_SOURCE 700 /* pseudo terminals */
#include "job_fixture.h"
#include "progress.h"
#include <fcntl.h>
#include <mps/case.h>

static double zero(void *user, mps_sim *sim)
{
    (void)user, (void)sim;
    return 0;
}

static void without_a_job(void **state)
{
    mps_probe probe;
    mps_measure m;
    mps_measure_info info;
    mps_reference r;
    mps_trace t;
    char *text;
    (void)state;
    assert_int_equal(mps_probe_init(&probe, sizeof probe), MPS_OK);
    assert_int_equal(mps_measure_init(&m, sizeof m), MPS_OK);
    assert_int_equal(mps_reference_init(&r, sizeof r), MPS_OK);
    assert_int_equal(mps_trace_init(&t, sizeof t), MPS_OK);
    mps_sim *sim = water();
    assert_int_equal(mps_job_probe_add(NULL, sim, &probe, 0, 0, "P", NULL), MPS_E_ARG);
    assert_int_equal(mps_job_value_add(NULL, "a", "m", "A", 0, zero, NULL), MPS_E_ARG);
    assert_int_equal(mps_job_figure_add(NULL, "a", "A", 0, zero, NULL), MPS_E_ARG);
    assert_int_equal(mps_job_measure_add(NULL, sim, &m), MPS_E_ARG);
    assert_int_equal(mps_job_trace_add(NULL, &t), MPS_E_ARG);
    assert_int_equal(mps_job_reference_add(NULL, &r), MPS_E_ARG);
    assert_int_equal(mps_job_level_set(NULL, 1), MPS_E_ARG);
    assert_int_equal(mps_job_input_add(NULL, "a", "b"), MPS_E_ARG);
    assert_int_equal(mps_job_edges_add(NULL, 1, (const double[6]){0}), MPS_E_ARG);
    assert_int_equal(mps_job_outline_add(NULL, 2, (const double[4]){0}), MPS_E_ARG);
    assert_int_equal(mps_job_run(NULL, sim), MPS_EXIT_USAGE);
    assert_string_equal(mps_job_error(NULL), "");
    mps_job_stop(NULL);
    mps_job_print(NULL, "a");
    mps_job_log(NULL, MPS_LOG_WARNING, "a");
    assert_int_equal(mps_measure_init(NULL, sizeof m), MPS_E_ARG);
    assert_int_equal(mps_measure_init(&m, 1), MPS_E_ARG);
    assert_int_equal(mps_measure_info_init(NULL, sizeof info), MPS_E_ARG);
    assert_int_equal(mps_measure_info_init(&info, 1), MPS_E_ARG);
    assert_int_equal(mps_measure_info_get(0, NULL), MPS_E_ARG);
    assert_int_equal(mps_job_column_init(NULL, sizeof(mps_job_column)), MPS_E_ARG);
    assert_int_equal(mps_job_column_init(&(mps_job_column){0}, 1), MPS_E_ARG);
    assert_int_equal(mps_job_column_get(NULL, 0, &(mps_job_column){0}), MPS_E_ARG);
    assert_int_equal(mps_job_column_read(NULL, NULL, 0, NULL), MPS_E_ARG);
    assert_int_equal(mps_reference_init(NULL, sizeof r), MPS_E_ARG);
    assert_int_equal(mps_trace_init(NULL, sizeof t), MPS_E_ARG);
    assert_int_equal(mps_case_job(NULL, NULL, NULL, NULL), MPS_E_ARG);
    assert_int_equal(mps_case_check(NULL, NULL, NULL), MPS_E_ARG);
    assert_int_equal(mps_job_profile_text(sim, 1, NULL), MPS_E_ARG);
    assert_int_equal(mps_job_profile_text(NULL, 1, &text), MPS_E_ARG);
    mps_sim_destroy(sim);
}

static void of_a_job(void **state)
{
    static const double t[] = {0, 1, NAN};
    const mps_job_config c = config_of("arguments");
    mps_job *job = job_of(&c);
    mps_sim *sim = water();
    mps_measure m;
    mps_reference r;
    mps_trace trace;
    (void)state;
    assert_int_equal(mps_job_probe_add(job, NULL, NULL, 0, 0, "P", NULL), MPS_E_ARG);
    assert_int_equal(mps_job_probe_add(job, sim, NULL, 0, 0, "P", NULL), MPS_E_ARG);
    assert_int_equal(mps_job_measure_add(job, NULL, NULL), MPS_E_ARG);
    assert_int_equal(mps_job_measure_add(job, sim, NULL), MPS_E_ARG);
    assert_int_equal(mps_measure_init(&m, sizeof m), MPS_OK);
    ASSERT_JOB_REFUSED(job, mps_job_measure_add(job, sim, &m), MPS_E_NAME, "none of this name");
    m.measure = "centre", m.axis = -1;
    ASSERT_JOB_REFUSED(job, mps_job_measure_add(job, sim, &m), MPS_E_ARG, "axis");
    m.axis = 0, m.phase = -1;
    ASSERT_JOB_REFUSED(job, mps_job_measure_add(job, sim, &m), MPS_E_ARG, "phase");
    m.phase = 0, m.box[0] = INFINITY;
    ASSERT_JOB_REFUSED(job, mps_job_measure_add(job, sim, &m), MPS_E_ARG, "box");
    m.box[0] = 1;
    ASSERT_JOB_REFUSED(job, mps_job_measure_add(job, sim, &m), MPS_E_ARG, "box");
    m.struct_size--;
    assert_int_equal(mps_job_measure_add(job, sim, &m), MPS_E_ARG);
    ASSERT_JOB_REFUSED(job, mps_job_value_add(job, NULL, "m", "", 0, zero, NULL), MPS_E_ARG,
                       "name");
    ASSERT_JOB_REFUSED(job, mps_job_value_add(job, "b", NULL, "", 0, zero, NULL), MPS_E_ARG,
                       "unit");
    ASSERT_JOB_REFUSED(job, mps_job_value_add(job, "b", "m", "", -1, zero, NULL), MPS_E_ARG,
                       "flags");
    ASSERT_JOB_REFUSED(job, mps_job_figure_add(job, "b", "", -1, zero, NULL), MPS_E_ARG, "flags");
    ASSERT_JOB_REFUSED(job, mps_job_figure_add(job, "b", "", 9, zero, NULL), MPS_E_ARG, "flags");
    ASSERT_JOB_REFUSED(job, mps_job_figure_add(job, "b", "", 0, NULL, NULL), MPS_E_ARG, "function");
    ASSERT_JOB_REFUSED(job, mps_job_figure_add(job, "b,", "", 0, zero, NULL), MPS_E_ARG, "letters");
    ASSERT_JOB_REFUSED(job, mps_job_input_add(job, NULL, "b"), MPS_E_ARG, "key");
    ASSERT_JOB_REFUSED(job, mps_job_input_add(job, "a", NULL), MPS_E_ARG, "value");
    ASSERT_JOB_REFUSED(job, mps_job_outline_add(job, 2, NULL), MPS_E_ARG, "two places");
    ASSERT_JOB_REFUSED(job, mps_job_edges_add(job, 1, NULL), MPS_E_ARG, "two places");
    ASSERT_JOB_REFUSED(job, mps_job_edges_add(job, 0, (const double[6]){0}), MPS_E_ARG,
                       "two places");
    ASSERT_JOB_REFUSED(job, mps_job_edges_add(job, INT32_MAX, (const double[6]){0}), MPS_E_ARG,
                       "two places");
    ASSERT_JOB_REFUSED(job, mps_job_edges_add(job, 1, (const double[6]){0, INFINITY}), MPS_E_ARG,
                       "two places");
    ASSERT_JOB_REFUSED(job, mps_job_outline_add(job, 2, (const double[4]){0, NAN}), MPS_E_ARG,
                       "two places");
    assert_int_equal(mps_reference_init(&r, sizeof r), MPS_OK);
    r.label = "known", r.unit = "m", r.value = t, r.count = 1;
    ASSERT_JOB_REFUSED(job, mps_job_reference_add(job, &r), MPS_E_ARG, "points");
    r.t = t, r.count = 3;
    ASSERT_JOB_REFUSED(job, mps_job_reference_add(job, &r), MPS_E_ARG, "points");
    r.value = NULL;
    ASSERT_JOB_REFUSED(job, mps_job_reference_add(job, &r), MPS_E_ARG, "points");
    r.value = t, r.count = 2, r.unit = NULL;
    ASSERT_JOB_REFUSED(job, mps_job_reference_add(job, &r), MPS_E_ARG, "a unit");
    r.struct_size--;
    assert_int_equal(mps_job_reference_add(job, &r), MPS_E_ARG);
    assert_int_equal(mps_trace_init(&trace, sizeof trace), MPS_OK);
    ASSERT_JOB_REFUSED(job, mps_job_trace_add(job, &trace), MPS_E_ARG, "a name has");
    trace.name = "x", trace.column = "ke", trace.kind = -1;
    ASSERT_JOB_REFUSED(job, mps_job_trace_add(job, &trace), MPS_E_ARG, "'x'");
    trace.kind = MPS_TRACE_SLOPE + 1;
    ASSERT_JOB_REFUSED(job, mps_job_trace_add(job, &trace), MPS_E_ARG, "'x'");
    trace.kind = MPS_TRACE_MEAN, trace.from = NAN;
    ASSERT_JOB_REFUSED(job, mps_job_trace_add(job, &trace), MPS_E_ARG, "must be numbers");
    trace.from = 0, trace.window = -1;
    ASSERT_JOB_REFUSED(job, mps_job_trace_add(job, &trace), MPS_E_ARG, "'x'");
    trace.window = 0, trace.scale = INFINITY;
    ASSERT_JOB_REFUSED(job, mps_job_trace_add(job, &trace), MPS_E_ARG, "'x'");
    trace.struct_size--;
    assert_int_equal(mps_job_trace_add(job, &trace), MPS_E_ARG);
    assert_int_equal(mps_job_trace_add(job, NULL), MPS_E_ARG);
    assert_int_equal(mps_job_run(job, NULL), MPS_EXIT_USAGE);
    mps_sim_destroy(sim);
    mps_job_destroy(job);
}

/* The largest mean over a window, of a column that is the time: that of the last window. */
static double now(void *user, mps_sim *sim)
{
    double t;
    (void)user;
    mps_sim_time(sim, &t, NULL);
    return t;
}

static void means_over_a_window(void **state)
{
    mps_job_config c = config_of("window");
    mps_job *job = job_of(&c);
    mps_sim *sim = water();
    mps_trace t;
    (void)state;
    assert_int_equal(mps_job_value_add(job, "now", "s", "Time", MPS_JOB_PRESSURE, now, NULL),
                     MPS_OK);
    assert_int_equal(mps_trace_init(&t, sizeof t), MPS_OK);
    t.name = "most", t.kind = MPS_TRACE_LARGEST, t.column = "now", t.window = 0.01, t.to = 0.05;
    assert_int_equal(mps_job_trace_add(job, &t), MPS_OK);
    t.name = "long", t.window = 1;
    assert_int_equal(mps_job_trace_add(job, &t), MPS_OK);
    assert_int_equal(mps_job_run(job, sim), MPS_EXIT_OK);
    const char *summary = text_of("window", "summary.json"),
               *at = strstr(summary, "\n  \"most\": ");
    assert_non_null(at);
    ASSERT_NEAR(strtod(at + 11, NULL), 0.045, 0.004); /* a value is constant over its step */
    assert_non_null(strstr(summary, "means over 0.01 s"));
    mps_sim_destroy(sim);
    mps_job_destroy(job);
}

/* The program's messages, and twenty of the library's. */
static void messages(void **state)
{
    mps_job_config c = config_of("messages");
    mps_job *job = job_of(&c);
    (void)state;
    mps_job_print(job, "begins");
    ASSERT_SAID("test: begins\n");
    mps_job_print(job, NULL);
    mps_job_log(job, MPS_LOG_WARNING, NULL);
    mps_job_log(job, MPS_LOG_WARNING, "thin");
    ASSERT_SAID("test: warning: thin\n");
    for (int k = 0; k < 30; k++) mps_job_log(job, MPS_LOG_INFO, "line");
    ASSERT_SAID("test: line\ntest: further messages are not shown\n");
    const char *end = strstr(said, "not shown\n");
    assert_true(end && end[10] == '\0');
    mps_job_destroy(job);
    c.quiet = 1;
    c.folder = "quiet";
    job = job_of(&c);
    said[0] = '\0';
    mps_job_print(job, "begins");
    mps_job_log(job, MPS_LOG_WARNING, "thin");
    assert_string_equal(said, "");
    mps_job_destroy(job);
}

/* What a terminal shows half way through a run that began `seconds` ago. */
static void assert_left(double seconds, bool colour, const char *wanted)
{
    char text[256];
    const mps_step_info info = {.t = 1, .step = 100, .dt = 0.01, .cfl = 0.2, .ppe_iterations = 9};
    progress p = {.terminal = true, .colour = colour, .t_end = 2, .particles = 1000};
    p.start = mps__progress_clock() - seconds;
    p.shown = mps__progress_clock() - 1;
    assert_true(mps__progress_step(&p, &info, text, sizeof text));
    if (!strstr(text, wanted)) fail_msg("\"%s\", not \"%s\"", text, wanted);
    assert_true((strstr(text, "\033[1m 50.0 %\033[0m") != NULL) == colour);
    assert_non_null(strstr(text, "t 1.000 s  dt 1.0e-02  CFL 0.20  PPE   9"));
    assert_false(mps__progress_step(&p, &info, text, sizeof text)); /* within a tenth of a second */
    assert_string_equal(mps__progress_clear(&p), "\r\033[K");
    assert_string_equal(mps__progress_clear(&p), "");
}

static void progress_on_a_terminal(void **state)
{
    (void)state;
    assert_left(10, true, "left 10s");
    assert_left(100, false, "left 1m40s");
    assert_left(4000, false, "left 1h06m");
    assert_left(1e7, false, "left 99h59m");
}

/* Whether a run writes to a terminal, and in colour. */
static void assert_begins(const char *term, const char *no_colour, bool wanted, bool terminal,
                          bool colour)
{
    progress p;
    if (term)
        setenv("TERM", term, 1);
    else
        unsetenv("TERM");
    if (no_colour)
        setenv("NO_COLOR", no_colour, 1);
    else
        unsetenv("NO_COLOR");
    mps__progress_begin(&p, 1, 100, wanted);
    assert_int_equal(p.terminal, terminal);
    assert_int_equal(p.colour, colour);
}

static void terminals_are_known(void **state)
{
    (void)state;
    const int other = posix_openpt(O_RDWR | O_NOCTTY), before = dup(2);
    if (other < 0 || grantpt(other) != 0 || unlockpt(other) != 0) skip();
    const int own = open(ptsname(other), O_RDWR | O_NOCTTY);
    assert_true(own >= 0 && before >= 0);
    assert_int_equal(dup2(own, 2), 2);
    assert_begins("xterm", NULL, true, true, true);
    assert_begins("xterm", "", true, true, true);
    assert_begins("xterm", "1", true, true, false);
    assert_begins("dumb", NULL, true, false, false);
    assert_begins(NULL, NULL, true, false, false);
    assert_begins("xterm", NULL, false, false, false);
    assert_int_equal(dup2(before, 2), 2);
    close(own), close(other), close(before);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_a_job),          cmocka_unit_test(of_a_job),
        cmocka_unit_test(means_over_a_window),    cmocka_unit_test(messages),
        cmocka_unit_test(progress_on_a_terminal), cmocka_unit_test(terminals_are_known)};
    return cmocka_run_group_tests(tests, enter_folder, leave_folder);
}

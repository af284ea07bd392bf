/* SPDX-License-Identifier: BSD-3-Clause */
/* A complete run of a case, in which each call of the system and of libmps fails in turn, at its
 * first and second visit. Either the run continues with the usual outputs, with nan for a value
 * that could not be measured, or it reports the failure in a message and its exit code. In both
 * cases no file remains open and the folder is not locked. */
#include "../every.h"
#include "fault_kit.h"
#include "job_fixture.h"
#include <dirent.h>
#include <mps/case.h>

static const char TANK[] =
    "mps: 1\ndp: 50 mm\n"
    "tank: {size: 1 0.6 m}\n"
    "solids:\n  baffle: {plate: [0.5 0 m, 0.5 0.2 m]}\n"
    "  block: {box: [0.7 0 m, 0.8 0.1 m]}\n"
    "fluids: {oil: {density: 900 kg/m3, viscosity: 50 mm2/s, tension: 30 mN/m}}\n"
    "fill:\n  - water: {depth: 0.2 m, start: {velocity: 0.1 0 m/s}}\n"
    "  - oil: {box: [0.55 0.3 m, 0.75 0.4 m]}\n  - water: {polygon: [0 0.2 m, 0.2 0.2 m, 0 0.4 "
    "m]}\n"
    "motion:\n  roll: {amplitude: 4 deg, period: 1.2 s}\n  surge: {jonswap: {significant: 10 mm, "
    "peak: 1.2 s}}\n"
    "sensors:\n  P: {panel: [0 0.2 m, 0 0.4 m], cells: 3}\n  r: {row: [1 0.2 m, 1 0.4 m], cells: "
    "2}\n"
    "  w: {wall: 0 0.3 m}\n  deep: {pressure: 0.4 0.1 m}\n"
    "  F: {force: tank}\n  eta: {gauge: 1 dp}\n  front: {measure: front}\n"
    "  gas: {measure: trapped_gas}\n  c: {measure: centre}\n  top: {measure: interface_top}\n"
    "  s: {measure: strays}\n  b: {measure: trespass, level: 0.3 m}\n"
    "  x: {measure: speed, change: yes}\n  a: {measure: circularity, at_end: yes}\n"
    "figures: {peak: {column: w, take: largest, window: 1 ms}}\n"
    "reference:\n  eta: {times: 1 2 s, values: 10 20 mm}\n  w: {file: known.csv, label: old run}\n"
    "run: {until: 12 ms, dt: 4 ms, checkpoint: 5 ms, threads: 1}\n"
    "output: {rate: 250 Hz, frames: 2, pictures: 4 ms, trace: yes, profile: yes, page: 1 MB}\n";

/* A rigid body that carries a tank, with its columns and its load. */
static const char BODY[] =
    "mps: 1\ndp: 50 mm\ntank: {size: 0.6 0.4 m}\nfill: [{water: {depth: 0.2 m}}]\n"
    "body:\n  centre: 300 0 mm\n  forward: z\n  mass: 100 kg\n  inertia: 10 kg m2\n"
    "  sway: {stiffness: 2 kN/m, load: {amplitude: 30 N, period: 1 s}}\n  roll: {period: 1 s}\n"
    "sensors: {L: {load: momentum}, W: {load: walls}, w: {wall: 0 0.1 m}}\n"
    "run: {until: 12 ms, dt: 4 ms, checkpoint: 5 ms, threads: 1}\n"
    "output: {rate: 250 Hz, frames: 0, trace: yes, page: 0 MB}\n";

static const char *chosen = TANK;

/* Files that the process has open. */
static int open_files(void)
{
    int count = 0;
    DIR *all = opendir("/proc/self/fd");
    if (!all) return 0;
    while (readdir(all)) count++;
    closedir(all);
    return count;
}

/* Messages of a run about a failure of the case. */
static void take_messages(const mps_case *c)
{
    char text[4000] = "";
    if (!c) return;
    mps_case_messages_write(c, text, sizeof text);
    strncat(said, text, sizeof said - strlen(said) - 1);
}

/* A run in `folder`, to 12 ms or continued to 20 ms, with counted calls. @return exit code; -1: no
 * run */
static int32_t run(const char *folder, bool resume, int to, int32_t place, int32_t visit,
                   const char **failed)
{
    static const char *const further[] = {"run.until=20 ms"};
    mps_case *c = NULL;
    mps_job *job = NULL;
    mps_sim *sim = NULL;
    mps_job_config config;
    int32_t code = -1;
    char error[1000] = "";
    said[0] = '\0';
    assert_int_equal(mps_job_config_init(&config, sizeof config), MPS_OK);
    config.folder = folder;
    config.print = listen;
    config.resume = resume;
    config.overwrite = !resume;
    config.error = error;
    config.error_size = sizeof error;
    fault_arm(place, visit);
    mps_status status = mps_case_read_text(chosen, strlen(chosen), "faults.yaml", to == 20, further,
                                           &c);
    if (status == MPS_OK) status = mps_case_job(c, &config, &job, &sim);
    if (status == MPS_OK) code = mps_job_run(job, sim);
    mps_sim_destroy(sim);
    mps_job_destroy(job);
    listen(NULL, MPS_JOB_MESSAGE, error);
    take_messages(c);
    mps_case_destroy(c);
    *failed = fault_disarm();
    if (status == MPS_E_NOMEM) strncat(said, "memory", sizeof said - strlen(said) - 1);
    return code;
}

/* What is wrong after a failure; all of it is shown. */
static int wrong;

#define WRONG(...) (wrong++, print_error(__VA_ARGS__))

/* Rows of a table are those of the complete run, except missing values. */
static void same_rows(const char *folder, const char *name, const char *failed)
{
    char *all = strdup(text_of("whole", name));
    assert_non_null(all);
    const char *a = all, *b = text_of(folder, name);
    while (*a && *b) {
        const size_t m = strcspn(a, ",\n"), n = strcspn(b, ",\n");
        const bool same = m == n && strncmp(a, b, n) == 0;
        if (!same && strncmp(b, "nan", n) != 0 && strncmp(b, "-nan", n) != 0) {
            WRONG("%s: %s has %.*s, not %.*s\n", failed, name, (int)n, b, (int)m, a);
            break;
        }
        a += m + (a[m] != '\0'), b += n + (b[n] != '\0');
        if (!*a != !*b) WRONG("%s: %s has not all rows\n", failed, name);
    }
    free(all);
}

static void check_run(const char *folder, int32_t code, const char *failed)
{
    static const char *const tables[] = {"probes.csv", "momentum.csv", "steps.csv", "trace.csv"};
    if (code != MPS_EXIT_OK) {
        if (!said[0]) WRONG("%s: code %d without a word\n", failed, (int)code);
        return;
    }
    for (int k = 0; k < 4; k++) same_rows(folder, tables[k], failed);
    if (!strstr(text_of(folder, "summary.json"), "\"status\": \"ok\""))
        WRONG("%s: no whole summary.json\n", failed);
}

/* Number of visits of each call site in the complete run. */
enum { PLACES = 4000 };
static int32_t places, visits[PLACES];

static void note_places(void)
{
    places = fault_places();
    assert_true(places <= PLACES);
    for (int32_t k = 0; k < places; k++) visits[k] = fault_visits(k);
}

/* With a sanitizer one of this number of call sites is tested, different ones for each series. */
enum { EACH = 4 };
static int32_t series;

/* All call sites, at visit `visit`. @return number of failures that ended a run, times the call
 * sites that one represents */
static int64_t in_turn(bool resume, int32_t visit)
{
    int ended = 0, reached = 0;
    const char *failed;
    for (int32_t k = 0; k < places; k++) {
        if (visits[k] < visit || !has_turn(k, series, EACH)) continue;
        if (resume) assert_int_equal(system("rm -rf try && cp -r first try"), 0);
        const int before = open_files();
        const int32_t code = run("try", resume, resume ? 20 : 12, k, visit, &failed);
        const int after = open_files();
        if (!failed) failed = "no failure";
        if (after != before) WRONG("%s: %d files stay open\n", failed, after - before);
        if (is_there("try", "run.lock")) WRONG("%s: the folder is locked\n", failed);
        check_run("try", code, failed);
        reached += strcmp(failed, "no failure") != 0;
        ended += code != MPS_EXIT_OK;
        if (code != MPS_EXIT_OK && strcmp(failed, "no failure") == 0)
            WRONG("code %d, but no call failed\n", (int)code);
    }
    print_message("%d calls failed, which ended %d runs\n", reached, ended);
    assert_int_equal(wrong, 0);
    series++;
    return ended * every(EACH);
}

static void write_known(void)
{
    FILE *known = fopen("known.csv", "w");
    assert_non_null(known);
    assert_true(fputs("t[ms],p[kPa]\n0,1\n8,1.5\n", known) >= 0 && fclose(known) == 0);
}

static void runs(void **state)
{
    const char *failed;
    (void)state;
    write_known();
    if (run("whole", false, 12, -1, 1, &failed) != MPS_EXIT_OK) fail_msg("%s", said);
    note_places();
    assert_true(in_turn(false, 1) > 100);
    assert_true(in_turn(false, 2) > 50);
}

/* A run that continues from its last checkpoint to a later end has the outputs of one run to that
 * end. */
static void runs_that_go_on(void **state)
{
    const char *failed;
    (void)state;
    fault_forget();
    assert_int_equal(system("mv whole first"), 0);
    if (run("whole", false, 20, -1, 1, &failed) != MPS_EXIT_OK) fail_msg("%s", said);
    fault_forget();
    assert_int_equal(system("rm -rf try && cp -r first try"), 0);
    if (run("try", true, 20, -1, 1, &failed) != MPS_EXIT_OK) fail_msg("%s", said);
    note_places();
    check_run("try", MPS_EXIT_OK, "no failure");
    assert_true(in_turn(true, 1) > 100);
}

static void bodies(void **state)
{
    const char *failed;
    (void)state;
    chosen = BODY;
    fault_forget();
    if (run("whole", false, 12, -1, 1, &failed) != MPS_EXIT_OK) fail_msg("%s", said);
    note_places();
    assert_true(in_turn(false, 1) > 60);
    assert_true(in_turn(false, 2) > 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(runs), cmocka_unit_test(runs_that_go_on),
                                       cmocka_unit_test(bodies)};
    return cmocka_run_group_tests(tests, enter_folder, leave_folder);
}

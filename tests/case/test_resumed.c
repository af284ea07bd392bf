/* SPDX-License-Identifier: BSD-3-Clause */
/* Runs of a case that are stopped or killed at random points, by a seed, and resumed: the folder is
 * bitwise that of an uninterrupted run. A process kills itself at a step, or before its n-th
 * operation on a file: no test waits for a clock. */
#include "case_kit.h"
#include "job_fixture.h"
#include <dirent.h>
#include <errno.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>

enum { CHECKPOINTS = 64, SEEDS = 7, STEPS = 130, OPERATIONS = 260, ROUNDS = 8, PEAK_FRAMES = 8 };

static const char tank[] =
    "mps: 1\n"
    "dp: 50 mm\n"
    "title: A tank\n"
    "tank: {size: 0.8 0.5 m}\n"
    "fill: [{water: {depth: 0.25 m}}]\n"
    "motion: {surge: {amplitude: 20 mm, period: 0.2 s}}\n"
    "sensors: {P: {wall: 0 50 mm}, R: {wall: 0.8 0.05 m}, eta: {gauge: 0.3 m}}\n"
    "run: {until: 0.5 s, threads: 1}\n"
    "output: {frames: 10, peaks: 2, page: 0 MB, trace: yes, pictures: 0.05 0.15 s}\n";

/* ---- processes that kill themselves ---- */

static int64_t operations_left; /* 0: any number of them */
static int32_t steps_left;      /* 0: none */

static void operation(void)
{
    if (operations_left > 0 && --operations_left == 0) raise(SIGKILL);
}

#define WRAPPED(type, name, parameters, values) \
    type __real_##name parameters;              \
    type __wrap_##name parameters;              \
    type __wrap_##name parameters               \
    {                                           \
        operation();                            \
        return __real_##name values;            \
    }

/* NOLINTBEGIN(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp): names of the linker */
WRAPPED(int, unlink, (const char *a), (a))
WRAPPED(int, fsync, (int fd), (fd))
WRAPPED(int, fflush, (FILE * file), (file))
WRAPPED(int, fclose, (FILE * file), (file))
WRAPPED(int, ftruncate, (int fd, off_t size), (fd, size))
WRAPPED(FILE *, fopen, (const char *path, const char *mode), (path, mode))

/* The clock of the test: a step takes clock_step seconds, a checkpoint checkpoint_cost. */
static double clock_ahead, clock_step, checkpoint_cost;
static int64_t steps_taken, checkpoint_step[CHECKPOINTS];
static int32_t saved;

int __real_rename(const char *from, const char *to);
int __wrap_rename(const char *from, const char *to);
int __wrap_rename(const char *from, const char *to)
{
    operation();
    if (strstr(to, "/checkpoint.mps") && saved < CHECKPOINTS) {
        checkpoint_step[saved++] = steps_taken;
        clock_ahead += checkpoint_cost;
    }
    return __real_rename(from, to);
}

int __real_clock_gettime(clockid_t clock, struct timespec *now);
int __wrap_clock_gettime(clockid_t clock, struct timespec *now);
int __wrap_clock_gettime(clockid_t clock, struct timespec *now)
{
    const int code = __real_clock_gettime(clock, now);
    if (clock == CLOCK_MONOTONIC) now->tv_sec += (time_t)clock_ahead;
    return code;
}
/* NOLINTEND(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp) */

/* How a part of a run ends. */
typedef struct part {
    const char *until, *frames, *checkpoint, *clock;
    int32_t steps;      /* 0: any number */
    int64_t operations; /* 0: any number */
    bool stops;         /* after these steps by mps_job_stop(), else by SIGKILL */
    bool resume;
} part;

typedef struct stopper {
    mps_job *job;
    bool stops;
} stopper;

/* A value that is measured after each step, because of the trace. */
static double count_down(void *user, mps_sim *sim)
{
    const stopper *s = user;
    const int64_t before = steps_taken;
    mps_sim_time(sim, NULL, &steps_taken);
    clock_ahead += (double)(steps_taken - before) * clock_step;
    if (steps_left > 0 && --steps_left == 0) {
        if (!s->stops) raise(SIGKILL);
        mps_job_stop(s->job);
    }
    return 0;
}

/* @return exit code of the job */
static int run_part(const char *folder, const part *p)
{
    char until[40], frames[40], checkpoint[40], clock[40], error[1024] = "";
    const char *set[4] = {until, frames};
    int32_t sets = 2;
    mps_case *c;
    mps_sim *sim;
    mps_job_config config;
    stopper s = {.stops = p->stops};
    snprintf(until, sizeof until, "run.until=%s", p->until);
    snprintf(frames, sizeof frames, "output.frames=%s", p->frames);
    snprintf(checkpoint, sizeof checkpoint, "run.checkpoint=%s", p->checkpoint);
    snprintf(clock, sizeof clock, "run.checkpoint_clock=%s", p->clock);
    if (p->checkpoint) set[sets++] = checkpoint;
    if (p->clock) set[sets++] = clock;
    if (mps_case_read_text(tank, strlen(tank), "tank.yaml", sets, set, &c) != MPS_OK ||
        mps_job_config_init(&config, sizeof config) != MPS_OK)
        return 99;
    config.folder = folder;
    config.quiet = 1;
    config.resume = p->resume;
    config.error = error;
    config.error_size = sizeof error;
    const mps_status status = mps_case_job(c, &config, &s.job, &sim);
    if (status != MPS_OK) {
        fprintf(stderr, "%s: %s\n", folder, error);
        return 98;
    }
    mps_job_value_add(s.job, "none", "", "Nothing", 0, count_down, &s);
    operations_left = p->operations;
    steps_left = p->steps;
    const int code = mps_job_run(s.job, sim);
    operations_left = 0;
    mps_sim_destroy(sim);
    mps_job_destroy(s.job);
    mps_case_destroy(c);
    return code;
}

/* Run in a separate process. @return exit code, -1: killed */
static int in_process(const char *folder, const part *p)
{
    int code = 0;
    fflush(NULL);
    const pid_t other = fork();
    if (other == 0) _exit(run_part(folder, p));
    assert_true(waitpid(other, &code, 0) == other);
    return WIFEXITED(code) ? WEXITSTATUS(code) : -1;
}

/* ---- folders ---- */

/* A line about a machine, a folder or a program instead of the run. */
static bool is_of_machine(const char *line)
{
    static const char *const words[] = {
        "\"command\"",        "\"t_resumed\"", "_s\": ",      "\"s_per_step\"",
        "\"peak_rss_bytes\"", "\"date\"",      "written_to ="};
    for (size_t k = 0; k < sizeof words / sizeof *words; k++)
        if (strstr(line, words[k])) return true;
    return false;
}

static void same_file(const char *a, const char *b)
{
    static char line[2][1 << 16];
    FILE *in[2] = {fopen(a, "rb"), fopen(b, "rb")};
    const bool lines = strstr(a, ".json") || strstr(a, ".py");
    if (!in[0] || !in[1]) fail_msg("%s, %s: %s", a, b, strerror(errno));
    for (bool more = true; more;) {
        size_t size[2];
        for (int k = 0; k < 2; k++)
            size[k] = lines ? fgets(line[k], sizeof line[k], in[k]) ? strlen(line[k]) : 0
                            : fread(line[k], 1, sizeof line[k], in[k]);
        if (!(lines && size[0] && size[1] && is_of_machine(line[0]) && is_of_machine(line[1])) &&
            (size[0] != size[1] || memcmp(line[0], line[1], size[0]) != 0))
            fail_msg("%s and %s differ", a, b);
        more = size[0] > 0;
    }
    fclose(in[0]);
    fclose(in[1]);
}

/* Files of `a` are in `b` with the same bytes; @return their number */
static int32_t same_files(const char *a, const char *b)
{
    const struct dirent *e;
    int32_t count = 0;
    DIR *all = opendir(a);
    if (!all) fail_msg("%s: %s", a, strerror(errno));
    while ((e = readdir(all)) != NULL) {
        char one[600], other[600];
        struct stat s;
        if (e->d_name[0] == '.') continue;
        snprintf(one, sizeof one, "%s/%s", a, e->d_name);
        snprintf(other, sizeof other, "%s/%s", b, e->d_name);
        assert_int_equal(stat(one, &s), 0);
        count += 1;
        if (S_ISDIR(s.st_mode))
            count += same_files(one, other);
        else
            same_file(one, other);
    }
    closedir(all);
    return count;
}

static int32_t count_files(const char *folder)
{
    return same_files(folder, folder);
}

static void same_folder(const char *a, const char *b)
{
    assert_int_equal(same_files(a, b), count_files(b));
}

/* ---- tests ---- */

static const part whole = {.until = "0.5 s", .frames = "10"};

static uint32_t next_random(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

static int make_whole(void **state)
{
    if (enter_folder(state) != 0) return -1;
    return in_process("whole", &whole) == MPS_EXIT_OK && count_files("whole/peaks") >= PEAK_FRAMES
               ? 0
               : -1;
}

/* Parts end by a kill at a step or within the writing of files, or by a stop, as often as it
 * happens until the run is at its end. */
static void broken_runs_go_on(void **state)
{
    static const char *const checkpoints[] = {NULL, "0.02 s", "0.11 s"};
    (void)state;
    for (uint32_t k = 0; k < SEEDS; k++) {
        char folder[32];
        uint32_t seed = 7919 * k + 1;
        int code = -1, killed = 0;
        snprintf(folder, sizeof folder, "broken_%u", (unsigned)k);
        for (int round = 0; round < ROUNDS && code != MPS_EXIT_OK; round++) {
            part p = whole;
            p.resume = round > 0 && is_there(folder, "case.yaml");
            p.checkpoint = checkpoints[next_random(&seed) % 3];
            p.stops = next_random(&seed) % 3 == 0;
            if (p.stops || next_random(&seed) % 2)
                p.steps = 1 + (int32_t)(next_random(&seed) % STEPS);
            else
                p.operations = 1 + next_random(&seed) % OPERATIONS;
            code = in_process(folder, &p);
            if (code != -1 && code != MPS_EXIT_INTERRUPTED && code != MPS_EXIT_OK)
                fail_msg("seed %u, round %d: exit code %d", (unsigned)k, round, code);
            killed += code != MPS_EXIT_OK;
        }
        part last = whole; /* whose case.yaml has no checkpoints of its own */
        last.resume = is_there(folder, "case.yaml");
        assert_int_equal(in_process(folder, &last), MPS_EXIT_OK);
        if (k == 0) assert_true(killed > 0);
        unlink("broken_0/run.lock");
        same_folder("whole", folder);
    }
}

/* A complete run, and one that was stopped, continue to a later end like one run to that end; also
 * if the first end is so early that all steps were adjusted to it. */
static void ends_can_be_later(void **state)
{
    static const struct {
        part first;
        int code;
    } all[] = {
        {{.until = "0.2 s", .frames = "4"}, MPS_EXIT_OK},
        {{.until = "0.2 s", .frames = "4", .stops = true, .steps = 25}, MPS_EXIT_INTERRUPTED},
        {{.until = "0.2 s", .frames = "4", .steps = 30, .checkpoint = "0.02 s"}, -1},
        {{.until = "0.3 s", .frames = "6", .stops = true, .steps = 70, .checkpoint = "9 s"},
         MPS_EXIT_INTERRUPTED},
        {{.until = "0.05 s", .frames = "1"}, MPS_EXIT_OK}};
    (void)state;
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        char folder[32];
        part rest = whole;
        snprintf(folder, sizeof folder, "later_%zu", k);
        assert_int_equal(in_process(folder, &all[k].first), all[k].code);
        rest.resume = true;
        assert_int_equal(in_process(folder, &rest), MPS_EXIT_OK);
        same_folder("whole", folder);
    }
}

/* Frames about peaks follow from the rows: they are those of one run also where the times of the
 * other frames, which are given as a number, are not. */
static void peaks_have_no_end(void **state)
{
    static const part all[] = {
        {.until = "0.2 s", .frames = "10"},
        {.until = "0.45 s", .frames = "3"},
        {.until = "0.33 s", .frames = "7", .steps = 60, .checkpoint = "0.05 s"}};
    (void)state;
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        char folder[24], peaks[40], series[40];
        part rest = whole;
        snprintf(folder, sizeof folder, "peaks_%zu", k);
        snprintf(peaks, sizeof peaks, "%s/peaks", folder);
        snprintf(series, sizeof series, "%s/peaks.pvd", folder);
        assert_int_equal(in_process(folder, &all[k]), all[k].steps ? -1 : MPS_EXIT_OK);
        assert_true(count_files(peaks) > 0);
        rest.resume = true;
        assert_int_equal(in_process(folder, &rest), MPS_EXIT_OK);
        same_file("whole/peaks.pvd", series);
        same_folder("whole/peaks", peaks);
    }
}

/* What would make one record of two runs is refused, with the key and both values; what is written
 * or evaluated afterwards may change. */
static void cases_stay_the_same(void **state)
{
    static const struct {
        const char *set, *says; /* NULL: allowed */
    } all[] = {{"motion.surge.amplitude=30 mm",
                "motion.surge.amplitude is '30 mm', in the run of 'whole' it is '20 mm'"},
               {"run.cfl=0.2", "run.cfl is '0.2', in the run of 'whole' it is not given"},
               {"sensors.Q={wall: 0 60 mm}", "sensors.Q is given, in the run"},
               {"output.rate=500 Hz", "output.rate is '500 Hz'"},
               {"output.trace=no", "output.trace is 'no'"},
               {"tank.size=0.8 0.6 m", "tank.size"},
               {"title=Another", NULL},
               {"impacts={threshold: 1 kPa}", NULL},
               {"run.until=1 s", NULL},
               {"run.threads=2", NULL},
               {"run.checkpoint_clock=0 s", NULL},
               {"output.frames=20", NULL},
               {"output.film=no", NULL}};
    (void)state;
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        char error[1024] = "";
        const char *set[] = {"output.frames=10", all[k].set};
        mps_case *c;
        mps_job *job;
        mps_sim *sim;
        mps_job_config config;
        assert_int_equal(mps_job_config_init(&config, sizeof config), MPS_OK);
        assert_int_equal(mps_case_read_text(tank, strlen(tank), "tank.yaml", 2, set, &c), MPS_OK);
        config.folder = "whole";
        config.resume = config.quiet = 1;
        config.error = error;
        config.error_size = sizeof error;
        const mps_status status = mps_case_job(c, &config, &job, &sim);
        assert_int_equal(status, all[k].says ? MPS_E_STATE : MPS_OK);
        if (all[k].says && !strstr(error, all[k].says)) fail_msg("%s: %s", all[k].set, error);
        mps_sim_destroy(sim);
        mps_job_destroy(job);
        mps_case_destroy(c);
    }
}

/* Checkpoints by the clock: none before the steps at the end where the clock is far or off, and
 * at the step at which the interval is over where it is short. One that takes 295 s is followed by
 * 29500 s without one, 1 % of the time: half a step from a tie, for writes of any real duration. */
static void clock_writes_checkpoints(void **state)
{
    static const struct {
        const char *clock;
        double cost;
        int32_t first, interval; /* in steps of 1000 s; 0: none */
    } all[] = {{"0 s", 0, 0, 0},
               {"1000 h", 0, 0, 0},
               {NULL, 0, 2, 2}, /* 10 min */
               {"9000 s", 0, 10, 10},
               {"9000 s", 295, 10, 31}};
    (void)state;
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        const part p = {.until = "0.3 s", .frames = "6", .clock = all[k].clock};
        char folder[24];
        int64_t due = all[k].first;
        int32_t early = 0;
        snprintf(folder, sizeof folder, "clock_%zu", k);
        steps_taken = saved = 0;
        clock_step = 1000;
        checkpoint_cost = all[k].cost;
        assert_int_equal(run_part(folder, &p), MPS_EXIT_OK);
        clock_step = checkpoint_cost = 0;
        assert_true(steps_taken > 60 && saved > 0);
        /* 20 steps are fitted to the end; the ones before them, which might be, have checkpoints */
        while (early < saved && checkpoint_step[early] < steps_taken - 30) {
            assert_int_equal(checkpoint_step[early++], due);
            due += all[k].interval;
        }
        if (all[k].first)
            assert_true(due >= steps_taken - 30);
        else
            assert_int_equal(early, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(broken_runs_go_on), cmocka_unit_test(ends_can_be_later),
        cmocka_unit_test(peaks_have_no_end), cmocka_unit_test(cases_stay_the_same),
        cmocka_unit_test(clock_writes_checkpoints)};
    return cmocka_run_group_tests(tests, make_whole, leave_folder);
}

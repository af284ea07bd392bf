/* SPDX-License-Identifier: BSD-3-Clause */
/* Jobs on ranks that are threads: the files of a run are those of one rank, and all ranks end with
 * the same code. */
#include "job_fixture.h"
#include "kit_engine.h"
#include <mps/case.h>
#include <mps/ranks.h>

enum { RANKS = 3 };

static const char TANK[] =
    "mps: 1\ndp: 50 mm\ntank: {size: 1 0.6 m}\nfill: [{water: {depth: 0.3 m}}]\n"
    "motion: {roll: {amplitude: 4 deg, period: 1.2 s}}\n"
    "sensors:\n  w: {wall: 0 0.2 m}\n  F: {force: tank}\n  eta: {gauge: 0.3 m}\n"
    "  front: {measure: front}\n  gas: {measure: trapped_gas}\n  s: {measure: strays}\n"
    "  a: {measure: circularity, at_end: yes}\n"
    "run: {until: 12 ms, dt: 4 ms, checkpoint: 5 ms, threads: 1}\n"
    "output: {rate: 250 Hz, frames: 2, trace: yes, page: 1 MB}\n";

/* A rank of a run, and what became of it. */
typedef struct seat {
    mps_ranks_ops ops;
    mps_job_ranks ranks;
    int32_t leaves; /* its code where it ends before it makes a job; -1: it runs */
    mps_status made;
    int32_t code, speaks;
    char said[2000];
} seat;

typedef struct scene {
    const char *folder;
    const char *const *sets;
    int32_t set_count, resume;
    seat seat[RANKS];
} scene;

static void larger(void *into, const void *from)
{
    int32_t a, b;
    memcpy(&a, into, sizeof a), memcpy(&b, from, sizeof b);
    if (b > a) memcpy(into, from, sizeof b);
}

static void larger_number(void *into, const void *from)
{
    double a, b;
    memcpy(&a, into, sizeof a), memcpy(&b, from, sizeof b);
    if (b > a) memcpy(into, from, sizeof b);
}

static mps_status attach(void *user, mps_sim *sim)
{
    return mps_sim_ranks_set(sim, &((const seat *)user)->ops);
}

static int32_t largest(void *user, int32_t count, int32_t *values, double seconds)
{
    const mps_ranks_ops *ops = &((const seat *)user)->ops;
    (void)seconds;
    return ops->reduce(ops->user, count, sizeof *values, values, larger) == 0;
}

static void largest_numbers(void *user, int32_t count, double *values)
{
    const mps_ranks_ops *ops = &((const seat *)user)->ops;
    ops->reduce(ops->user, count, sizeof *values, values, larger_number);
}

static void hear(void *user, int32_t kind, const char *text)
{
    seat *s = user;
    (void)kind;
    strncat(s->said, text, sizeof s->said - strlen(s->said) - 1);
}

/* On threads of its own no assertion of cmocka is allowed. */
static void run_rank(void *argument, int32_t rank)
{
    scene *all = argument;
    seat *s = &all->seat[rank];
    mps_case *c = NULL;
    mps_job *job = NULL;
    mps_sim *sim = NULL;
    mps_job_config config;
    if (s->leaves >= 0) {
        s->code = mps_job_ranks_exit(&s->ranks, s->leaves, &s->speaks);
        return;
    }
    mps_job_config_init(&config, sizeof config);
    config.folder = all->folder;
    config.print = hear;
    config.print_user = s;
    config.resume = all->resume;
    config.ranks = &s->ranks;
    s->made = mps_case_read_text(TANK, sizeof TANK - 1, "ranks.yaml", all->set_count, all->sets,
                                 &c);
    if (s->made == MPS_OK) s->made = mps_case_job(c, &config, &job, &sim);
    if (s->made == MPS_OK) s->code = mps_job_run(job, sim);
    if (s->made != MPS_OK && c) mps_case_messages_write(c, s->said, sizeof s->said);
    mps_sim_destroy(sim);
    mps_job_destroy(job);
    mps_case_destroy(c);
}

/* @param leaves  code of the last rank if it ends at once; -1: it runs like the others */
static void run(scene *s, int32_t ranks, int32_t leaves)
{
    kit_engine_team *team = kit_engine_create(ranks, 0);
    for (int32_t r = 0; r < ranks; r++) {
        seat *own = &s->seat[r];
        *own = (seat){.ops = kit_engine_ops(team, r), .code = -1, .leaves = -1};
        own->ranks = (mps_job_ranks){.struct_size = sizeof own->ranks,
                                     .rank = r,
                                     .count = ranks,
                                     .user = own,
                                     .attach = attach,
                                     .largest = largest,
                                     .largest_numbers = largest_numbers};
    }
    s->seat[ranks - 1].leaves = leaves;
    kit_engine_run(team, run_rank, s);
    kit_engine_destroy(team);
}

static void whole(const char *folder, const char *const *sets, int32_t count, int32_t resume,
                  int32_t ranks)
{
    scene s = {.folder = folder, .sets = sets, .set_count = count, .resume = resume};
    run(&s, ranks, -1);
    for (int32_t r = 0; r < ranks; r++) {
        if (s.seat[r].code != MPS_EXIT_OK) fail_msg("rank %d: %s", (int)r, s.seat[r].said);
        if (r > 0) assert_string_equal(s.seat[r].said, ""); /* rank 0 speaks for all */
    }
    assert_non_null(strstr(s.seat[0].said, "outputs in "));
}

static void same_tables(const char *one, const char *other)
{
    static const char *const tables[] = {"probes.csv", "momentum.csv", "steps.csv", "trace.csv"};
    for (int k = 0; k < 4; k++) {
        char *text = strdup(text_of(one, tables[k]));
        assert_non_null(text);
        assert_true(strlen(text) > 200);
        assert_string_equal(text, text_of(other, tables[k]));
        free(text);
    }
}

static void files_are_those_of_one_rank(void **state)
{
    static const char *const pieces[] = {"output.pieces=yes"};
    (void)state;
    whole("one", NULL, 0, 0, 1);
    whole("three", NULL, 0, 0, RANKS);
    same_tables("one", "three");
    assert_true(is_there("three", "frames/frames_000002.vtp"));
    whole("pieces", pieces, 1, 0, RANKS);
    same_tables("one", "pieces");
    assert_true(is_there("pieces", "frames/frames_000002.pvtp"));
    assert_non_null(strstr(text_of("pieces", "summary.json"), "\"status\": \"ok\""));
}

static void ranks_go_on(void **state)
{
    static const char *const further[] = {"run.until=20 ms"};
    (void)state;
    whole("first", NULL, 0, 0, RANKS);
    whole("first", further, 1, 1, RANKS);
    whole("further", further, 1, 0, 1);
    same_tables("further", "first");
}

/* A rank that ends terminates all ranks, with its exit code. */
static void one_leaves(void **state)
{
    scene s = {.folder = "left"};
    (void)state;
    run(&s, RANKS, 4);
    assert_int_equal(s.seat[RANKS - 1].code, 4);
    assert_int_equal(s.seat[RANKS - 1].speaks, 1);
    for (int32_t r = 0; r + 1 < RANKS; r++) assert_int_not_equal(s.seat[r].made, MPS_OK);
    assert_false(is_there("left", "run.lock"));
}

/* The folder is refused on rank 0, and all ranks are notified. */
static void one_is_refused(void **state)
{
    scene s = {.folder = "one"};
    (void)state;
    run(&s, RANKS, -1);
    for (int32_t r = 0; r < RANKS; r++) assert_int_not_equal(s.seat[r].made, MPS_OK);
    assert_non_null(strstr(text_of("one", "summary.json"), "\"status\": \"ok\""));
    s = (scene){.folder = "empty", .resume = 1};
    run(&s, RANKS, -1);
    for (int32_t r = 0; r < RANKS; r++) assert_int_equal(s.seat[r].code, MPS_EXIT_USAGE);
    assert_non_null(strstr(s.seat[0].said, "resume: "));
    assert_string_equal(s.seat[1].said, "");
}

static void leave_rank(void *argument, int32_t rank)
{
    seat *s = &((scene *)argument)->seat[rank];
    s->code = mps_job_ranks_exit(&s->ranks, rank, &s->speaks);
}

/* The others do not answer. */
static int32_t nothing(void *user, int32_t count, int32_t *values, double seconds)
{
    (void)user, (void)count, (void)values;
    return seconds == 0;
}

static void leaving(void **state)
{
    scene s = {0};
    mps_job_ranks silent = {
        .struct_size = sizeof silent, .rank = 1, .count = 2, .largest = nothing};
    int32_t speaks = 0;
    (void)state;
    assert_int_equal(mps_job_ranks_exit(NULL, 3, &speaks), 3);
    assert_int_equal(speaks, 1);
    speaks = 0;
    assert_int_equal(mps_job_ranks_exit(&silent, 3, &speaks), -1);
    assert_int_equal(speaks, 1);
    kit_engine_team *team = kit_engine_create(RANKS, 0);
    for (int32_t r = 0; r < RANKS; r++) {
        s.seat[r].ops = kit_engine_ops(team, r);
        s.seat[r].ranks = (mps_job_ranks){
            .rank = r, .count = RANKS, .user = &s.seat[r], .largest = largest};
    }
    kit_engine_run(team, leave_rank, &s);
    kit_engine_destroy(team);
    for (int32_t r = 0; r < RANKS; r++) {
        assert_int_equal(s.seat[r].code, RANKS - 1); /* the largest of all codes */
        assert_int_equal(s.seat[r].speaks, r == 0);
    }
}

/* The module is searched in the folder of the program. */
static void modules_are_loaded(void **state)
{
    mps_job_ranks ranks;
    char place[1024], error[600] = "";
    (void)state;
    assert_int_equal(mps_job_ranks_load(NULL, error, sizeof error), MPS_E_ARG);
    assert_int_equal(mps_job_ranks_load(&ranks, NULL, 1), MPS_E_ARG);
    assert_int_equal(mps_job_ranks_load(&ranks, error, 0), MPS_E_ARG);
    const ssize_t length = readlink("/proc/self/exe", place, sizeof place - 30);
    assert_true(length > 0);
    place[length] = '\0';
    strcpy(strrchr(place, '/') + 1, "mps_drivers_mpi.so");
    FILE *none = fopen(place, "w");
    assert_non_null(none);
    fclose(none);
    assert_int_equal(mps_job_ranks_load(&ranks, error, sizeof error), MPS_E_IO);
    assert_non_null(strstr(error, "mps_drivers_mpi.so"));
    assert_int_equal(unlink(place), 0);
    assert_int_equal(symlink(RANKS_MODULE, place), 0);
    const mps_status status = mps_job_ranks_load(&ranks, error, sizeof error);
    assert_int_equal(setenv("MPS_TEST_OLD", "1", 1), 0);
    const mps_status old = mps_job_ranks_load(&(mps_job_ranks){0}, error, sizeof error);
    assert_int_equal(unsetenv("MPS_TEST_OLD"), 0);
    assert_int_equal(unlink(place), 0);
    assert_int_equal(status, MPS_OK);
    assert_true(ranks.rank == 2 && ranks.count == 5 && ranks.struct_size == sizeof ranks);
    assert_int_equal(old, MPS_E_VERSION);
    assert_non_null(strstr(error, "another version of libmps_case"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(files_are_those_of_one_rank),
                                       cmocka_unit_test(ranks_go_on),
                                       cmocka_unit_test(one_leaves),
                                       cmocka_unit_test(one_is_refused),
                                       cmocka_unit_test(leaving),
                                       cmocka_unit_test(modules_are_loaded)};
    return cmocka_run_group_tests(tests, enter_folder, leave_folder);
}

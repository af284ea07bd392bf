/* SPDX-License-Identifier: BSD-3-Clause */
/* Cases without memory: malloc() fails at its k-th call, for k = 1, 2, ..., while a case is built.
 * Each failure is a status, and the next attempt gives a complete case. Skipped if a sanitizer has
 * its own malloc(). */
#include "case_kit.h"
#include <mps/mps.h>
#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define CAN_FAIL 0
#else
#define CAN_FAIL 1
#endif

/* Only calls between arm() and disarm() count. */
static bool armed;
static int64_t calls, fail_at;

#if CAN_FAIL
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *block, size_t size);

extern char __executable_start, etext; /* made by the linker */

/* Calls of other libraries succeed: SUNDIALS 6 reads what it has not got. */
static bool fails(const void *caller)
{
    const char *at = caller;
    return armed && at >= &__executable_start && at < &etext && ++calls == fail_at;
}

void *malloc(size_t size)
{
    return fails(__builtin_return_address(0)) ? NULL : __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    return fails(__builtin_return_address(0)) ? NULL : __libc_calloc(count, size);
}

void *realloc(void *block, size_t size)
{
    return fails(__builtin_return_address(0)) ? NULL : __libc_realloc(block, size);
}
#endif

static const char TEXT[] = "mps: 1\ndp: 40 mm\n"
                           "tank: {size: 1 0.6 m, chamfer: {bottom: 0.2 0.2 m, top: 0.1 0.1 m}}\n"
                           "solids:\n  baffle: {plate: [0.5 0 m, 0.5 0.2 m]}\n"
                           "fill: [{water: {depth: 0.3 m}}, {air: rest}]\n"
                           "motion: {file: " CASES
                           "voyage.csv, columns: {roll: PHI}, units: {time: s, roll: deg}}\n"
                           "sensors:\n  P: {panel: [0 0.2 m, 0 0.4 m], cells: 3}\n  r: {row: [1 "
                           "0.2 m, 1 0.4 m], cells: 2}\n"
                           "  F: {force: tank}\n  eta: {gauge: 1 dp}\n  front: {measure: front}\n"
                           "reference:\n  eta: {times: 1 2 s, values: 10 20 mm}\n"
                           "run: {until: 1 s}\n";

static void quiet(void *user, int32_t kind, const char *text)
{
    (void)user, (void)kind, (void)text;
}

static mps_status try_job(mps_case *c, const char *folder)
{
    mps_job *job;
    mps_sim *sim;
    mps_job_config config;
    mps_job_config_init(&config, sizeof config);
    config.folder = folder;
    config.print = quiet;
    armed = true;
    const mps_status status = mps_case_job(c, &config, &job, &sim);
    armed = false;
    assert_true((status == MPS_OK) == (job != NULL) && (status == MPS_OK) == (sim != NULL));
    mps_sim_destroy(sim);
    mps_job_destroy(job);
    return status;
}

static mps_status try_check(mps_case *c, const char *folder)
{
    char *text, *sketch;
    (void)folder;
    armed = true;
    const mps_status status = mps_case_check(c, &text, &sketch);
    armed = false;
    assert_true((status == MPS_OK) == (text != NULL) && (status == MPS_OK) == (sketch != NULL));
    free(text);
    free(sketch);
    return status;
}

/* Every call up to the 300th, then each thirteenth: there arrays of the library grow, which are
 * covered by its own tests. */
static void starve(mps_status (*attempt)(mps_case *, const char *))
{
    char folder[] = "mps_oom_XXXXXX", command[64];
    int64_t failures = 0;
    bool whole = false;
    assert_non_null(mkdtemp(folder));
    for (fail_at = 1; CAN_FAIL && !whole && fail_at < 1000000; fail_at += fail_at < 300 ? 1 : 13) {
        mps_case *c = NULL;
        assert_int_equal(kit_read(TEXT, NULL, &c), MPS_OK);
        calls = 0;
        const mps_status status = attempt(c, folder);
        whole = calls < fail_at;
        if (status != MPS_OK && status != MPS_E_NOMEM) {
            char *all = kit_messages(c);
            fail_msg("call %lld: status %d\n%s", (long long)fail_at, (int)status, all);
        }
        if (whole) assert_int_equal(status, MPS_OK);
        failures += status == MPS_E_NOMEM;
        mps_case_destroy(c);
    }
    if (CAN_FAIL) printf("%lld failures of %lld calls\n", (long long)failures, (long long)calls);
    assert_true(!CAN_FAIL || (whole && failures > 100));
    snprintf(command, sizeof command, "rm -rf %s", folder);
    assert_int_equal(system(command), 0);
}

static void jobs(void **state)
{
    (void)state;
    starve(try_job);
}

static void checks(void **state)
{
    (void)state;
    starve(try_check);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(jobs), cmocka_unit_test(checks)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

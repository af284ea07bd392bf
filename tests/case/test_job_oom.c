/* SPDX-License-Identifier: BSD-3-Clause */
/* Jobs without memory: malloc() fails at its k-th call, for k = 1, 2, ..., while a job is created
 * and its columns and inputs are added. Each failure is a status without side effects: the next
 * attempt succeeds. Skipped if a sanitizer has its own malloc(). */
#include "job_fixture.h"

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

static bool fails(void)
{
    return armed && ++calls == fail_at;
}

void *malloc(size_t size)
{
    return fails() ? NULL : __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    return fails() ? NULL : __libc_calloc(count, size);
}

void *realloc(void *block, size_t size)
{
    return fails() ? NULL : __libc_realloc(block, size);
}
#endif

static double nothing(void *user, mps_sim *sim)
{
    (void)user, (void)sim;
    return 0;
}

/* All calls of a program that define a job. @return the first failure */
static mps_status tell(mps_job *job, mps_sim *sim)
{
    static const double t[] = {0, 1};
    static const char *const measures[] = {"front", "trapped_gas", "interface_top"};
    mps_reference r;
    mps_trace trace;
    mps_status status = mps_job_value_add(job, "a", "m", "A", 0, nothing, NULL);
    if (status == MPS_OK) status = mps_job_figure_add(job, "b", "B", 0, nothing, NULL);
    if (status == MPS_OK) status = mps_job_level_set(job, 0.2);
    if (status == MPS_OK) status = mps_job_input_add(job, "dp", "40 mm");
    if (status == MPS_OK) status = mps_job_outline_add(job, 2, (const double[4]){0});
    if (status == MPS_OK) status = mps_job_edges_add(job, 1, (const double[6]){0});
    mps_reference_init(&r, sizeof r);
    r.label = "known", r.unit = "m", r.column = "a", r.count = 2, r.t = r.value = t;
    if (status == MPS_OK) status = mps_job_reference_add(job, &r);
    mps_trace_init(&trace, sizeof trace);
    trace.name = "c", trace.kind = MPS_TRACE_MEAN, trace.column = "a", trace.to = 1;
    if (status == MPS_OK) status = mps_job_trace_add(job, &trace);
    for (int k = 0; k < 3 && status == MPS_OK; k++) {
        mps_measure m;
        mps_measure_init(&m, sizeof m);
        m.measure = measures[k];
        status = mps_job_measure_add(job, sim, &m);
    }
    return status;
}

static void failures_are_statuses(void **state)
{
    (void)state;
    const mps_job_config given = config_of("oom");
    mps_sim *sim = water();
    int64_t failed = 0;
    for (int64_t k = 1; CAN_FAIL; k++) {
        static const double times[] = {0.01, 0.02};
        mps_job_config c = given;
        mps_job *job = NULL;
        c.title = "Title", c.command = "test", c.text = "mps: 1\n", c.model = "imps";
        c.picture_t = times, c.picture_count = 2;
        calls = 0, fail_at = k, armed = true;
        mps_status status = mps_job_create(&c, &job);
        const bool made = status == MPS_OK;
        if (made) status = tell(job, sim);
        armed = false;
        if (status == MPS_OK) {
            mps_job_destroy(job);
            break;
        }
        assert_int_equal(status, MPS_E_NOMEM);
        assert_true(made == (job != NULL));
        if (made && !strstr(mps_job_error(job), "memory"))
            fail_msg("says \"%s\"", mps_job_error(job));
        mps_job_destroy(job);
        failed++;
    }
    assert_true(!CAN_FAIL || failed > 20);
    print_message("%d calls failed in turn\n", (int)failed);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(failures_are_statuses)};
    return cmocka_run_group_tests(tests, enter_folder, leave_folder);
}

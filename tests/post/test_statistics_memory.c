/* SPDX-License-Identifier: BSD-3-Clause */
/* Out of memory: malloc(), calloc() and realloc() fail at the k-th call, for k = 1, 2, ... until a
 * function succeeds. Each failure is MPS_E_NOMEM with a text and leaks nothing. Skipped with the
 * address sanitizer, which has its own functions. */
#include "stats_fixture.h"
#include <errno.h>
#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define CAN_FAIL 0
#else
#define CAN_FAIL 1
#endif

#if CAN_FAIL
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *block, size_t size);
void __libc_free(void *block);

/* Only calls between arm() and disarm() count. */
static bool armed;
static int64_t calls, fail_at, live;

static bool fails(void)
{
    if (!armed || ++calls != fail_at) return false;
    errno = ENOMEM;
    return true;
}

static void *counted(void *block)
{
    if (armed && block) live++;
    return block;
}

void *malloc(size_t size)
{
    return fails() ? NULL : counted(__libc_malloc(size));
}

void *calloc(size_t count, size_t size)
{
    return fails() ? NULL : counted(__libc_calloc(count, size));
}

void *realloc(void *block, size_t size)
{
    if (fails()) return NULL;
    return block ? __libc_realloc(block, size) : counted(__libc_realloc(block, size));
}

void free(void *block)
{
    if (armed && block) live--;
    __libc_free(block);
}

enum { SAMPLES = 2000 };
static double t[SAMPLES], p[SAMPLES];
static char folder[] = "mps_memory_XXXXXX", path[sizeof folder + 16], summary[sizeof folder + 16];

static mps_status impacts(const mps_stats_config *config)
{
    mps_impacts *out;
    const mps_status status = mps_impacts_find(config, SAMPLES, t, p, &out);
    assert_true((out != NULL) == (status == MPS_OK));
    mps_impacts_destroy(out);
    return status;
}

static mps_status table(const mps_stats_config *config)
{
    mps_table *out;
    const mps_status status = mps_table_read(config, path, 0, NULL, &out);
    assert_true((out != NULL) == (status == MPS_OK));
    mps_table_destroy(out);
    return status;
}

static mps_status comparison(const mps_stats_config *config)
{
    const mps_series s = {.struct_size = sizeof s, .n = SAMPLES, .t = t, .p = p};
    mps_comparison c = {.struct_size = sizeof c};
    return mps_series_compare(config, &s, &s, &c);
}

static mps_status peaks(const mps_stats_config *config)
{
    mps_impacts *run;
    mps_repeat r = {.struct_size = sizeof r};
    mps_status status = mps_impacts_find(config, SAMPLES, t, p, &run);
    if (status == MPS_OK)
        status = mps_repeat_peaks(config, 1, (const mps_impacts *const *)&run, 0, &r);
    mps_impacts_destroy(run);
    return status;
}

/* The folder of a complete run, or of one in progress: its rows are those of `path`. */
static mps_status constants(const mps_stats_config *config)
{
    mps_stats_config own = *config;
    return mps_stats_config_read(folder, &own);
}

static mps_status a_set(const mps_stats_config *config)
{
    mps_stats_config own = *config;
    const mps_status status = mps_stats_config_set(&own, "impacts.sensors=[P1, P2]");
    assert_string_equal(own.sensors, status == MPS_OK ? "P1; P2" : "");
    return status;
}

static mps_status a_wrong_set(const mps_stats_config *config)
{
    mps_stats_config own = *config;
    const mps_status status = mps_stats_config_set(&own, "impacts.share=500 %");
    return status == MPS_E_ARG ? MPS_OK : status;
}

static void check(mps_status (*call)(const mps_stats_config *), int64_t least)
{
    mps_status status;
    for (int64_t k = 1;; k++) {
        mps_stats_config config = new_config();
        config.threshold = 0.5;
        config.window = 0;
        config.rate = 3;
        config.resamples = 3;
        calls = live = 0;
        fail_at = k;
        armed = true;
        status = call(&config);
        armed = false;
        assert_int_equal(live, 0);
        if (calls < k) break;
        if (status != MPS_E_NOMEM)
            fail_msg("allocation %lld: %s", (long long)k, mps_status_name(status));
        if (!strstr(stats_error, "out of memory")) fail_msg("the text is \"%s\"", stats_error);
        assert_true(k < 1000);
    }
    assert_int_equal(status, MPS_OK);
    assert_true(calls >= least);
}

/* 250 events, 3000 rows: lists grow more than once. */
static int prepare(void **state)
{
    (void)state;
    if (!mkdtemp(folder)) return -1;
    snprintf(path, sizeof path, "%s/probes.csv", folder);
    snprintf(summary, sizeof summary, "%s/summary.json", folder);
    FILE *out = fopen(path, "w");
    if (!out) return -1;
    fputs("t[s],a,b\n", out);
    for (int k = 0; k < 3000; k++) fprintf(out, "%d,%d,%d\n", k, k, -k);
    for (int k = 0; k < SAMPLES; k++) {
        t[k] = k;
        p[k] = k % 8 == 4 ? 1 + (k * 31) % 17 : 0;
    }
    return fclose(out);
}

static int clean(void **state)
{
    (void)state;
    return unlink(path) == 0 && rmdir(folder) == 0 ? 0 : -1;
}

static void all_calls(void **state)
{
    (void)state;
    check(impacts, 10);
    check(table, 10);
    check(comparison, 3);
    check(a_set, 20);
    check(a_wrong_set, 20);
    check(peaks, 11);
    check(constants, 10); /* without a summary: the end of the table */
    FILE *out = fopen(summary, "w");
    assert_non_null(out);
    fputs("{\"t_end\": 3, \"inputs\": [{\"key\": \"T1\", \"value\": \"2 s\"}]}\n", out);
    assert_int_equal(fclose(out), 0);
    check(constants, 5);
    assert_int_equal(unlink(summary), 0);
}
#else
static int prepare(void **state)
{
    return (void)state, 0;
}
static int clean(void **state)
{
    return (void)state, 0;
}
static void all_calls(void **state)
{
    (void)state;
    skip();
}
#endif

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(all_calls)};
    return cmocka_run_group_tests(tests, prepare, clean);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Reading a case without memory: malloc(), calloc() and realloc() fail at the k-th call, for k = 1,
 * 2, ... The call returns MPS_E_NOMEM and leaks nothing, or, if k is beyond the last call, the
 * usual case. Skipped if a sanitizer has its own malloc(). */
#include "case_kit.h"
#include <errno.h>
#include <mps/mps.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define CAN_FAIL 0
#else
#define CAN_FAIL 1
#endif

/* Only calls between arm() and disarm() count. */
static bool armed;
static int64_t calls, fail_at, blocks;

#if CAN_FAIL
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *block, size_t size);
void __libc_free(void *block);

static bool fails(void)
{
    if (!armed || ++calls != fail_at) return false;
    errno = ENOMEM;
    return true;
}

/* Blocks that are given out count while armed. */
static void *counted(void *block)
{
    if (armed && block) blocks++;
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
    if (!block) return malloc(size);
    return fails() ? NULL : __libc_realloc(block, size);
}

void free(void *block)
{
    if (armed && block) blocks--;
    __libc_free(block);
}
#endif

/* A simulation is one call that may fail: SUNLogger_Create() of SUNDIALS 6 crashes where it gets no
 * memory, see tests/oom/test_malloc.c. */
mps_status __real_mps_sim_create(const mps_config *config, mps_sim **sim);
mps_status __wrap_mps_sim_create(const mps_config *config, mps_sim **sim);
void __real_mps_sim_destroy(mps_sim *sim);
void __wrap_mps_sim_destroy(mps_sim *sim);

mps_status __wrap_mps_sim_create(const mps_config *config, mps_sim **sim)
{
    const bool was = armed;
    if (armed && ++calls == fail_at) return MPS_E_NOMEM;
    armed = false;
    const mps_status status = __real_mps_sim_create(config, sim);
    armed = was;
    return status;
}

void __wrap_mps_sim_destroy(mps_sim *sim)
{
    const bool was = armed;
    armed = false;
    __real_mps_sim_destroy(sim);
    armed = was;
}

static mps_status attempt(int64_t k, const char *path, const char *const *sets, int32_t count,
                          char *text, size_t size)
{
    mps_case *c = NULL;
    text[0] = '\0';
    calls = 0;
    fail_at = k;
    blocks = 0;
    armed = true;
    const mps_status status = mps_case_read(path, count, sets, &c);
    if (c && mps_case_text(c)) snprintf(text, size, "%s", mps_case_text(c));
    if (c && mps_case_message_count(c) > 0) mps_case_messages_write(c, text, size);
    const bool none = c == NULL;
    mps_case_destroy(c);
    armed = false;
    assert_int_equal(blocks, 0);
    assert_true(none == (status == MPS_E_NOMEM));
    return status;
}

/* Each call fails in turn. A stream works without a buffer, so the case may be read
 * nevertheless. */
static void in_turn(const char *path, const char *const *sets, int32_t count)
{
    static char whole[1 << 16], text[1 << 16];
    const mps_status status = attempt(0, path, sets, count, whole, sizeof whole);
    const int64_t all = calls;
    assert_true(all > 10);
    for (int64_t k = 1; k <= all; k++) {
        const mps_status now = attempt(k, path, sets, count, text, sizeof text);
        if (now == MPS_E_NOMEM) continue;
        assert_int_equal(now, status);
        assert_string_equal(text, whole);
    }
    print_message("%s: %lld calls\n", path, (long long)all);
}

static void reading(void **state)
{
    static const char *const sets[] = {"run.until=3 s", "sensors.Q={wall: 0 10 mm}"};
    (void)state;
    if (!CAN_FAIL) skip();
    in_turn(CASES "sweep.yaml", sets, 2);
    in_turn(CASES "polygon.yaml", NULL, 0);
}

static void messages(void **state)
{
    static const char *const sets[] = {"run.untl=3 s", "dp=[", "tank.size=3"};
    (void)state;
    if (!CAN_FAIL) skip();
    in_turn(CASES "polygon.yaml", sets, 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(reading), cmocka_unit_test(messages)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

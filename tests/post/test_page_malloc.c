/* SPDX-License-Identifier: BSD-3-Clause */
/* malloc(), calloc() and realloc() fail at their k-th call, for k = 1, 2, ...: a page is written
 * completely, or an error is returned and the previous page remains. Skipped with the address
 * sanitizer, which has its own malloc(). */
#include "page_fixture.h"
#include <errno.h>

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
    if (!armed || ++calls != fail_at) return false;
    errno = ENOMEM;
    return true;
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

static mps_status page_with(scene *s, int64_t k)
{
    calls = 0;
    fail_at = k;
    armed = true;
    const mps_status status = page_of(s, 0, NULL);
    armed = false;
    return status;
}

static void every_allocation(void **unused)
{
    scene s = {.dim = 2, .fluid = 12, .frames = 3, .rows = 450, .moves = true};
    size_t size = 0, other = 0;
    int64_t k = 1, failed = 0;
    (void)unused;
    if (!CAN_FAIL) skip();
    scene_create(&s);
    text_write(&s, "case.yaml", "mps: 1\n");
    assert_int_equal(page_of(&s, 0, NULL), MPS_OK);
    char *good = text_read(&s, "report.html", &size);
    for (;; k++) {
        text_write(&s, "report.html", "an earlier page");
        const mps_status status = page_with(&s, k);
        char *page = text_read(&s, "report.html", &other);
        assert_non_null(page);
        if (status == MPS_OK) { /* whole, also where the C library did without */
            assert_int_equal(other, size);
            assert_memory_equal(page, good, size);
        } else {
            assert_string_equal(page, "an earlier page");
            assert_int_not_equal(s.error[0], 0);
            if (status != MPS_E_NOMEM && status != MPS_E_IO)
                fail_msg("%d: %s", (int)status, s.error);
            failed++;
        }
        free(page);
        assert_null(text_read(&s, "report.html.tmp", NULL));
        if (status == MPS_OK && calls < k) break;
    }
    assert_true(failed > 100);
    free(good);
    scene_remove(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_allocation)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

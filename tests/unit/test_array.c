/* SPDX-License-Identifier: BSD-3-Clause */
/* Arrays in host and device memory: versions say which copy is valid, and what is copied. */
#include "array.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

enum { N = 5, BYTES = N * sizeof(double) };

/* A device whose memory is that of the host. */
typedef struct fake {
    int copies_up, copies_down, copies, invalidated, blocks;
    const void *last_invalidated;
    bool fails;
} fake;

static void *allocate(void *self, uint64_t bytes)
{
    ((fake *)self)->blocks++;
    return malloc(bytes);
}

static void release(void *self, void *block)
{
    ((fake *)self)->blocks--;
    free(block);
}

static int copy_up(void *self, void *to, const void *from, uint64_t bytes)
{
    fake *f = self;
    if (f->fails) return 1;
    f->copies_up++;
    memcpy(to, from, bytes);
    return 0;
}

static int copy_down(void *self, void *to, const void *from, uint64_t bytes)
{
    fake *f = self;
    if (f->fails) return 1;
    f->copies_down++;
    memcpy(to, from, bytes);
    return 0;
}

static int copy_on_device(void *self, void *to, const void *from, uint64_t bytes)
{
    ((fake *)self)->copies++;
    memcpy(to, from, bytes);
    return 0;
}

static const char *why(void *self)
{
    (void)self;
    return "it fails";
}

static void note_invalidated(void *self, void *array, uint64_t bytes, uint32_t number)
{
    fake *f = self;
    (void)bytes;
    assert_int_equal(number, sizeof(double));
    f->invalidated++;
    f->last_invalidated = array;
}

typedef struct scene {
    mps__context context;
    fake fake;
    mps__device device;
    double host[N];
    mps__array a;
} scene;

static void begin(scene *k)
{
    memset(k, 0, sizeof *k);
    k->context.allocator = mps__allocator_default();
    mps__device_init(&k->device, &k->context);
    k->device.ops = (mps_device_ops){.name = "fake",
                                     .self = &k->fake,
                                     .alloc = allocate,
                                     .free = release,
                                     .upload = copy_up,
                                     .download = copy_down,
                                     .copy = copy_on_device,
                                     .failure = why,
                                     .invalidated = note_invalidated};
    for (int i = 0; i < N; i++) k->host[i] = i + 1;
    k->a.host = k->host;
    mps__array_written(&k->a, MPS__ON_HOST);
}

static void end(scene *k)
{
    mps__free(&k->context, k->a.kept);
    mps__array_release(&k->a);
    assert_int_equal(k->fake.blocks, 0);
}

static void open_mirror(scene *k)
{
    assert_int_equal(mps__array_fit(&k->a, &k->device, BYTES, sizeof(double)), MPS_OK);
}

static double *mirror(scene *k)
{
    return k->a.mirror.data;
}

static void check_valid(const mps__array *a, bool host, bool device)
{
    assert_int_equal(mps__array_valid(a, MPS__ON_HOST), host);
    assert_int_equal(mps__array_valid(a, MPS__ON_DEVICE), device);
}

static void copies_only_what_is_stale(void **state)
{
    scene k;
    (void)state;
    begin(&k);
    check_valid(&k.a, true, false);
    open_mirror(&k);
    check_valid(&k.a, true, false);
    for (int m = 0; m < 2; m++) mps__array_copy(&k.a, MPS__ON_DEVICE);
    assert_int_equal(k.fake.copies_up, 1);
    check_valid(&k.a, true, true);
    mirror(&k)[2] = 7;
    mps__array_written(&k.a, MPS__ON_DEVICE);
    check_valid(&k.a, false, true);
    assert_ptr_equal(k.fake.last_invalidated, k.host);
    mps__array_written(&k.a, MPS__ON_DEVICE); /* the host is invalid already */
    assert_int_equal(k.fake.invalidated, 1);
    for (int m = 0; m < 2; m++) mps__array_copy(&k.a, MPS__ON_HOST);
    assert_int_equal(k.fake.copies_down, 1);
    assert_true(k.host[2] == 7);
    check_valid(&k.a, true, true);
    mps__array_written(&k.a, MPS__ON_HOST);
    check_valid(&k.a, true, false);
    assert_ptr_equal(k.fake.last_invalidated, mirror(&k));
    end(&k);
    check_valid(&k.a, true, false);
}

static void every_change_is_a_version(void **state)
{
    scene k;
    (void)state;
    begin(&k);
    open_mirror(&k);
    const int64_t before = k.a.version;
    mps__array_copy(&k.a, MPS__ON_DEVICE);
    assert_true(k.a.version == before); /* a copy is none */
    mps__array_written(&k.a, MPS__ON_DEVICE);
    mps__array_advanced(&k.a, MPS__ON_DEVICE);
    mps__array_written(&k.a, MPS__ON_HOST);
    assert_true(k.a.version == before + 3);
    end(&k);
}

static void older_values_stay_readable(void **state)
{
    scene k;
    (void)state;
    begin(&k);
    open_mirror(&k);
    mps__array_copy(&k.a, MPS__ON_DEVICE);
    mps__array_advanced(&k.a, MPS__ON_DEVICE);
    check_valid(&k.a, false, true);
    assert_int_equal(k.fake.invalidated, 0);
    end(&k);
}

static void ghosts_follow(void **state)
{
    scene k;
    (void)state;
    begin(&k);
    assert_true(mps__array_ghosts_valid(&k.a));
    mps__array_written(&k.a, MPS__ON_HOST);
    assert_true(mps__array_ghosts_valid(&k.a));
    mps__array_ghosts_set(&k.a, false);
    mps__array_written(&k.a, MPS__ON_HOST);
    assert_false(mps__array_ghosts_valid(&k.a));
    mps__array_ghosts_set(&k.a, true);
    assert_true(mps__array_ghosts_valid(&k.a));
    end(&k);
}

/* A step that fails: the values and the memory space that had them return. */
static void restores(void **state)
{
    for (int32_t space = MPS__ON_HOST; space <= MPS__ON_DEVICE; space++) {
        scene k;
        (void)state;
        begin(&k);
        open_mirror(&k);
        mps__array_copy(&k.a, MPS__ON_DEVICE);
        mps__array_written(&k.a, space);
        assert_int_equal(mps__array_keep(&k.a, &k.context, NULL, BYTES), MPS_OK);
        assert_int_equal(k.a.kept_in, space);
        const int64_t version = k.a.version;
        mps__array_copy(&k.a, MPS__ON_DEVICE);
        mirror(&k)[1] = k.host[1] = -1;
        mps__array_written(&k.a, MPS__ON_DEVICE);
        mps__array_restore(&k.a, BYTES);
        check_valid(&k.a, space == MPS__ON_HOST, space == MPS__ON_DEVICE);
        assert_true(k.a.version > version); /* consumers saw the values of the failed step */
        mps__array_copy(&k.a, MPS__ON_HOST);
        assert_true(k.host[1] == 2);
        k.a.kept_in = MPS__NOWHERE;
        k.host[1] = 5;
        mps__array_restore(&k.a, BYTES);
        assert_true(k.host[1] == 5);
        end(&k);
    }
}

static void a_failed_copy_leaves_it_invalid(void **state)
{
    scene k;
    (void)state;
    begin(&k);
    open_mirror(&k);
    k.fake.fails = true;
    mps__array_copy(&k.a, MPS__ON_DEVICE);
    assert_true(k.device.failed);
    check_valid(&k.a, true, false);
    k.fake.fails = k.device.failed = false;
    mps__array_copy(&k.a, MPS__ON_DEVICE);
    check_valid(&k.a, true, true);
    end(&k);
}

static void spare_memory_becomes_the_mirror(void **state)
{
    scene k;
    (void)state;
    begin(&k);
    open_mirror(&k);
    mps__array_copy(&k.a, MPS__ON_DEVICE);
    const void *before = mirror(&k);
    assert_non_null(mps__device_fit(&k.device, &k.a.spare, BYTES));
    memcpy(k.a.spare.data, k.host, BYTES);
    mps__array_invalidate(&k.a, MPS__ON_DEVICE);
    mps__array_exchange(&k.a);
    check_valid(&k.a, true, true);
    assert_ptr_equal(k.a.spare.data, before);
    assert_memory_equal(mirror(&k), k.host, BYTES);
    end(&k);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(copies_only_what_is_stale),
        cmocka_unit_test(every_change_is_a_version),
        cmocka_unit_test(older_values_stay_readable),
        cmocka_unit_test(ghosts_follow),
        cmocka_unit_test(restores),
        cmocka_unit_test(a_failed_copy_leaves_it_invalid),
        cmocka_unit_test(spare_memory_becomes_the_mirror),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

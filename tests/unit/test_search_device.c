/* SPDX-License-Identifier: BSD-3-Clause */
/* The loops by which a device sorts particles and finds candidates, run on the host: equal to the
 * search of the host. */
#include "search_fixture.h"

static void of_any_size(void **state)
{
    static const int64_t size[] = {0, 1, 2, 63, 64, 65, 1023, 1025, 4097, 100000};
    (void)state;
    for (size_t k = 0; k < sizeof size / sizeof *size; k++)
        for (int32_t dim = 2; dim <= 3; dim++)
            for (int which = 0; which < (size[k] < 5000 ? 4 : 1); which++)
                search_both(dim, size[k], which & 1, which & 2);
}

/* A row that exceeds the stack buffer of the host: the loops report it, and write nothing. */
static void long_rows_are_told(void **state)
{
    mps__context context = {.allocator = mps__allocator_default()};
    mps_neighbours l;
    tank t = tank_of(3, 5000, 3);
    search_buffers r = search_buffers_of(t.c.n);
    (void)state;
    for (int64_t k = 0; k < 3 * t.c.n; k++) t.c.x[k] *= 0.4;
    assert_int_equal(mps__neighbours_init(&l, &context, 3, CLOUD_DP), MPS_OK);
    r.order.x = r.search.x = t.c.x;
    r.order.id = t.id;
    const int32_t *order = mps__neighbours_order_device(&l, t.c.n, search_far, &r.order);
    assert_non_null(order);
    tank_sort(&t, order);
    l.kind = r.search.kind = t.kind;
    r.search.x = t.c.x;
    assert_int_equal(mps__neighbours_begin(&l, t.c.n, t.c.x, search_near, search_far), MPS_OK);
    assert_int_equal(mps__neighbours_count_device(&l, &r.search), MPS_OK);
    assert_true(l.longest > 1024);
    mps__neighbours_free(&l);
    search_buffers_free(&r);
    tank_free(&t);
}

/* Inputs that the host refuses are left to it. */
static void no_order(void **state)
{
    static const double far[] = {NAN, INFINITY, -1e300};
    (void)state;
    for (int k = 0; k < 4; k++) {
        mps__context context = {.allocator = mps__allocator_default()};
        mps_neighbours l;
        tank t = tank_of(2, 5000, 4);
        search_buffers r = search_buffers_of(t.c.n);
        if (k < 3) t.c.x[77] = far[k];
        for (int64_t i = 0; i < 2 * t.c.n && k == 3; i++) t.c.x[i] *= 1e-3; /* a crowd */
        r.order.x = t.c.x;
        r.order.id = t.id;
        assert_int_equal(mps__neighbours_init(&l, &context, 2, CLOUD_DP), MPS_OK);
        assert_null(mps__neighbours_order_device(&l, t.c.n, search_far, &r.order));
        assert_int_equal(mps__neighbours_order(&l, t.c.n, t.c.x, t.id, search_far), MPS_E_ARG);
        mps__neighbours_free(&l);
        search_buffers_free(&r);
        tank_free(&t);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(of_any_size),
        cmocka_unit_test(long_rows_are_told),
        cmocka_unit_test(no_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

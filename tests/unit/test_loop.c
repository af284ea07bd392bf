/* SPDX-License-Identifier: BSD-3-Clause */
/* Loops of the core: each row once, in both dimensions, sums and maxima the same bytes on any
 * number of threads; sums up to each row. */
#include "loop.h"
#include "scan.h"
#include "tank_fixture.h"
#include <stdlib.h>

enum { ROWS = 5003 };

typedef struct fields {
    const double *x;
    double *out;
} fields;

MPS_ROW void scale_row(const int dim, const fields *f, int64_t i)
{
    f->out[i] += dim * f->x[i];
}
MPS__LOOP(scale_rows, scale_row, fields)

/* The sum of x and of dim x^2, the largest x and the largest -x. */
MPS_ROW void measure_row(const int dim, const fields *f, int64_t i, double *values)
{
    const double x = f->x[i];
    values[0] = x;
    if (i % 2) values[1] = dim * x * x; /* rows that set nothing add 0 */
    if (x > values[2]) values[2] = x;
    if (-x > values[3]) values[3] = -x;
}
MPS__VALUES(measure_rows, measure_row, fields, 2, 2)

typedef struct fixture {
    mps__context context;
    mps__pool pool;
    double x[ROWS], out[ROWS];
} fixture;

static void begin(fixture *k, int32_t threads)
{
    k->context = (mps__context){.allocator = mps__allocator_default()};
    mps__pool_init(&k->pool, &k->context);
    mps__pool_resize(&k->pool, threads);
    for (int i = 0; i < ROWS; i++) {
        k->x[i] = sin(1.7 * i) * pow(10, i % 9);
        k->out[i] = 0;
    }
}

static void each_row_once(void **state)
{
    static fixture k;
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++)
        for (int32_t threads = 1; threads <= 4; threads += 3) {
            begin(&k, threads);
            const fields f = {k.x, k.out};
            mps__loop_run(&k.pool.parallel, &scale_rows, dim, ROWS - 5, &f);
            mps__loop_run_long(&k.pool.parallel, &scale_rows, dim, 5, &f);
            for (int i = 0; i < ROWS; i++) {
                const double once = i < ROWS - 5 ? dim * k.x[i] : 0;
                assert_true(k.out[i] == (i < 5 ? 2 * once : once));
            }
            mps__pool_free(&k.pool);
        }
}

static void sums_and_maxima(void **state)
{
    static fixture k;
    (void)state;
    for (int32_t threads = 1; threads <= 4; threads += 3) {
        mps_exact sum[2] = {{{0}, 0, 0}}, wanted[2] = {{{0}, 0, 0}};
        double maximum[2] = {-INFINITY, 1e12}, most = -INFINITY;
        begin(&k, threads);
        mps__values_run(&k.pool.parallel, &measure_rows, 3, ROWS, &(fields){k.x, NULL}, sum,
                        maximum);
        for (int i = 0; i < ROWS; i++) {
            const double square = 3 * k.x[i] * k.x[i];
            most = fmax(most, k.x[i]);
            mps_exact_add(&wanted[0], 1, &k.x[i]);
            if (i % 2) mps_exact_add(&wanted[1], 1, &square);
        }
        for (int s = 0; s < 2; s++)
            assert_true(mps_exact_value(&sum[s]) == mps_exact_value(&wanted[s]));
        assert_true(maximum[0] == most);
        assert_true(maximum[1] == 1e12); /* not below what it was */
        mps__pool_free(&k.pool);
    }
}

/* Sizes around a block, a block of blocks; the workspace after them is written, and nothing
 * beyond. */
static void sums_up_to_each(void **state)
{
    static const int64_t size[] = {0, 1, 2, 63, 127, 128, 129, 1023, 1025, 16384, 16385, 100000};
    static fixture k;
    (void)state;
    for (size_t m = 0; m < 2 * (sizeof size / sizeof size[0]); m++) {
        const int64_t n = size[m / 2], whole = mps__scan_size(n);
        int64_t *values = malloc((size_t)(whole + 1) * sizeof *values), sum = 0;
        assert_non_null(values);
        assert_true(whole >= n && whole <= n + n / 64 + 1);
        begin(&k, m % 2 ? 4 : 1);
        for (int64_t i = 0; i <= whole; i++) values[i] = i < n ? i * 7919 % 1009 - 300 : INT64_MIN;
        mps__scan(&k.pool.parallel, values, n);
        for (int64_t i = 0; i < n; i++) {
            sum += i * 7919 % 1009 - 300;
            assert_true(values[i] == sum);
        }
        assert_true(values[whole] == INT64_MIN);
        mps__pool_free(&k.pool);
        free(values);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sums_up_to_each),
                                       cmocka_unit_test(each_row_once),
                                       cmocka_unit_test(sums_and_maxima)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Loops over the elements of vectors. */
#include "vectors.h"
#include "rows.h"
#include "loop.h"
#include <math.h>

typedef struct operands {
    double a, b;
    const double *x, *y;
    double *z;
} operands;

/* Loops with little work a row. */
static void run(const mps_parallel *p, const mps__loop *loop, int64_t n, const operands *o)
{
    mps__loop_run_cheap(p, loop, MPS__ANY_DIM, n, o);
}

MPS_ROW void fill_row(const operands *o, int64_t i)
{
    o->z[i] = o->a;
}
MPS__LOOP_CHEAP(fill_rows, fill_row, operands)

void mps__vectors_fill(const mps_parallel *p, int64_t n, double a, double *z)
{
    run(p, &fill_rows, n, &(operands){.a = a, .z = z});
}

MPS_ROW void scale_row(const operands *o, int64_t i)
{
    o->z[i] = o->a * o->x[i];
}
MPS__LOOP_CHEAP(scale_rows, scale_row, operands)

void mps__vectors_scale(const mps_parallel *p, int64_t n, double a, const double *x, double *z)
{
    run(p, &scale_rows, n, &(operands){.a = a, .x = x, .z = z});
}

MPS_ROW void sum_row(const operands *o, int64_t i)
{
    o->z[i] = o->a * o->x[i] + o->b * o->y[i];
}
MPS__LOOP_CHEAP(sum_rows, sum_row, operands)

void mps__vectors_sum(const mps_parallel *p, int64_t n, const double factor[2], const double *x,
                      const double *y, double *z)
{
    run(p, &sum_rows, n, &(operands){factor[0], factor[1], x, y, z});
}

MPS_ROW void product_row(const operands *o, int64_t i)
{
    o->z[i] = o->x[i] * o->y[i];
}
MPS__LOOP_CHEAP(product_rows, product_row, operands)

void mps__vectors_product(const mps_parallel *p, int64_t n, const double *x, const double *y,
                          double *z)
{
    run(p, &product_rows, n, &(operands){.x = x, .y = y, .z = z});
}

MPS_ROW void quotient_row(const operands *o, int64_t i)
{
    o->z[i] = o->x[i] / o->y[i];
}
MPS__LOOP_CHEAP(quotient_rows, quotient_row, operands)

void mps__vectors_quotient(const mps_parallel *p, int64_t n, const double *x, const double *y,
                           double *z)
{
    run(p, &quotient_rows, n, &(operands){.x = x, .y = y, .z = z});
}

MPS_ROW void absolute_row(const operands *o, int64_t i)
{
    o->z[i] = fabs(o->x[i]);
}
MPS__LOOP_CHEAP(absolute_rows, absolute_row, operands)

void mps__vectors_absolute(const mps_parallel *p, int64_t n, const double *x, double *z)
{
    run(p, &absolute_rows, n, &(operands){.x = x, .z = z});
}

MPS_ROW void inverse_row(const operands *o, int64_t i)
{
    o->z[i] = 1.0 / o->x[i];
}
MPS__LOOP_CHEAP(inverse_rows, inverse_row, operands)

void mps__vectors_inverse(const mps_parallel *p, int64_t n, const double *x, double *z)
{
    run(p, &inverse_rows, n, &(operands){.x = x, .z = z});
}

void mps__vectors_copy(const mps_parallel *p, int64_t n, const double *x, double *z)
{
    mps__parallel_copy(p, z, x, (size_t)n * sizeof *z);
}

void mps__vectors_clear(const mps_parallel *p, int64_t n, double *z)
{
    mps__parallel_zero(p, &(mps__block){z, n}, 1);
}

/* ---- sums and maxima ---- */

/* Reduce over the rows of all ranks. */
static void reduce(const mps_ppe_problem *problem, const mps__values *values, const operands *o,
                   mps_exact *sum, double *maximum)
{
    mps__values_run(mps__team(problem->parallel, problem->n), values, MPS__ANY_DIM, problem->n, o,
                    sum, maximum);
    mps_ppe_total(problem, &(mps_exact_values){values->sums, values->maxima, sum, maximum});
}

MPS_ROW void dot_row(const operands *o, int64_t i, double *values)
{
    values[0] = o->x[i] * o->y[i];
}

static void dot_range(const operands *o, int64_t begin, int64_t end, mps_exact *sum, double *none)
{
    (void)none;
    mps_exact_add_products(sum, end - begin, o->x + begin, o->y + begin);
}
MPS__VALUES_BY(dot_rows, dot_row, dot_range, operands, 1, 0)

void mps__vectors_dot_async(const mps_ppe_problem *problem, const double *x, const double *y,
                            mps__reduced *to)
{
    mps__values_reduce_async(mps__device_of(problem->parallel), &dot_rows, MPS__ANY_DIM, problem->n,
                             &(operands){.x = x, .y = y}, to);
}

double mps__vectors_dot(const mps_ppe_problem *problem, const double *x, const double *y)
{
    mps_exact sum = {{0}, 0, 0};
    reduce(problem, &dot_rows, &(operands){.x = x, .y = y}, &sum, NULL);
    return mps_exact_value(&sum);
}

MPS_ROW void square_row(const operands *o, int64_t i, double *values)
{
    const double product = o->x[i] * o->y[i];
    values[0] = product * product;
}
MPS__VALUES_ANY(square_rows, square_row, operands, 1, 0)

double mps__vectors_squares(const mps_ppe_problem *problem, const double *x, const double *y)
{
    mps_exact sum = {{0}, 0, 0};
    double none[1];
    reduce(problem, &square_rows, &(operands){.x = x, .y = y}, &sum, none);
    return mps_exact_value(&sum);
}

MPS_ROW void norm_row(const operands *o, int64_t i, double *values)
{
    const double size = o->y ? fabs(o->x[i] * o->y[i]) : 0;
    values[0] = o->x[i] * o->x[i];
    if (size > values[1]) values[1] = size;
}

/* In blocks: elements are summed while they are in cache. */
static void norm_range(const operands *o, int64_t begin, int64_t end, mps_exact *squares,
                       double *largest)
{
    const double *x = o->x, *weight = o->y;
    double most = *largest;
    for (int64_t lo = begin, hi; lo < end; lo = hi) {
        hi = lo + MPS__BLOCK < end ? lo + MPS__BLOCK : end;
        mps_exact_add_products(squares, hi - lo, x + lo, x + lo);
        for (int64_t i = lo; weight && i < hi; i++) {
            const double size = fabs(x[i] * weight[i]);
            most = size > most ? size : most;
        }
    }
    *largest = weight || most > 0 ? most : 0;
}
MPS__VALUES_BY(norm_rows, norm_row, norm_range, operands, 1, 1)

void mps__vectors_norms(const mps_ppe_problem *problem, const double *x, const double *weight,
                        double *squares, double *largest)
{
    mps_exact sum = {{0}, 0, 0};
    *largest = 0;
    reduce(problem, &norm_rows, &(operands){.x = x, .y = weight}, &sum, largest);
    *squares = mps_exact_value(&sum);
}

MPS_ROW void largest_row(const operands *o, int64_t i, double *values)
{
    const double value = o->a == 0 ? fabs(o->x[i]) : o->a * o->x[i];
    if (value > values[0]) values[0] = value;
}
MPS__VALUES_ANY(largest_rows, largest_row, operands, 0, 1)

double mps__vectors_largest(const mps_ppe_problem *problem, const double *x, double factor,
                            double least)
{
    double largest = least;
    reduce(problem, &largest_rows, &(operands){.a = factor, .x = x}, NULL, &largest);
    return largest;
}

MPS_ROW void poison_row(const operands *o, int64_t i, double *values)
{
    if (0 * o->x[i] != 0) values[0] = 1;
}
MPS__VALUES_ANY(poison_rows, poison_row, operands, 0, 1)

bool mps__vectors_poisoned(const mps_ppe_problem *problem, const double *x)
{
    double any = 0;
    reduce(problem, &poison_rows, &(operands){.x = x}, NULL, &any);
    return any > 0;
}

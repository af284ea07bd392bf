/* SPDX-License-Identifier: BSD-3-Clause */
/* Loops of the library over rows, like those of models (mps/stage.h): a row function, its fields as
 * numbers and arrays (no pointers to other structs), and a table of both for the function that runs
 * the loop. */
#ifndef MPS_CORE_LOOP_H
#define MPS_CORE_LOOP_H

#include "parallel.h"
#include "terms.h"
#include <mps/stage.h>
#include <string.h>

struct mps__device;

/* A loop over rows, defined by MPS__LOOP(). */
typedef struct mps__loop {
    const char *name;
    size_t bytes; /* of the fields */
    void (*run)(int32_t dim, const void *fields, int64_t begin, int64_t end);
    const char *file; /* source file that defines it */
} mps__loop;

/* Sums and maxima over rows, defined by MPS__VALUES(). */
typedef struct mps__values {
    const char *name;
    size_t bytes;         /* of the fields */
    int32_t sums, maxima; /* MPS_PARALLEL_VALUES in total at most */
    void (*run)(int32_t dim, const void *fields, int64_t begin, int64_t end, mps_exact *sum,
                double *maximum);
    const char *file;
} mps__values;

/* Threads of a group of MPS__GROUP(). */
enum { MPS__TOGETHER = 128 };
/* Dimension of loops whose rows do not depend on it. */
enum { MPS__ANY_DIM = 2 };

/* Run a loop of MPS__GROUP() on a device. */
void mps__group_run(struct mps__device *d, const mps__loop *group, const void *fields);
/* Run rows 0..n-1 in ranges of at least MPS_PARALLEL_LEAST. A row must not write what other rows
 * read. */
void mps__loop_run(const mps_parallel *p, const mps__loop *loop, int32_t dim, int64_t n,
                   const void *fields);
/* Run rows in ranges of at least one row: for few and expensive rows. */
void mps__loop_run_long(const mps_parallel *p, const mps__loop *loop, int32_t dim, int64_t n,
                        const void *fields);
/* Run rows in ranges of at least MPS__ROWS_CHEAP: for very cheap rows. */
void mps__loop_run_cheap(const mps_parallel *p, const mps__loop *loop, int32_t dim, int64_t n,
                         const void *fields);
/* Add the terms of rows 0..n-1 to the sums and update the maxima. */
void mps__values_run(const mps_parallel *p, const mps__values *values, int32_t dim, int64_t n,
                     const void *fields, mps_exact *sum, double *maximum);
/* Reduce asynchronously on a device: sums, then maxima, of these rows only are written to device
 * memory. */
void mps__values_reduce_async(struct mps__device *d, const mps__values *values, int32_t dim,
                              int64_t n, const void *fields, void *to);
/* First row of 0..n-1 that satisfies the test of MPS__FIRST(), n if none does. */
int64_t mps__first_run(const mps_parallel *p, const mps__values *first, int64_t n,
                       const void *fields);

/* The macros below define loops of three kinds: rows, reductions, groups. Each kind has one
 * definition for the host here, `_OF`, and one for devices (src/device/kernels.h). */

/* The iterations of the next loop are independent: its arrays are identical or disjoint. */
#if defined(__clang__)
#define MPS__INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define MPS__INDEPENDENT _Pragma("GCC ivdep")
#else
#define MPS__INDEPENDENT
#endif

/* Do not unroll the next loop in device kernels: the code would be long and no faster. */
#ifdef MPS_DEVICE
#define MPS__ROLLED _Pragma("clang loop unroll(disable)")
#else
#define MPS__ROLLED
#endif

/* ---- rows ---- */

/* Define the mps__loop `name` from a row function
 *   MPS_ROW void row(const int dim, const type *fields, int64_t i);
 * compiled for dim = 2 and 3, so that loops over dim unroll. The loop copies the fields, so that
 * they stay in registers. */
#define MPS__LOOP(name, row, type)                                                        \
    MPS__LOOP_OF(name, row(dim_, &given_->fields, i_), type,                              \
                 if (dim_ == 2) for (int64_t i = begin; i < end; i++) row(2, &given_, i); \
                 else for (int64_t i = begin; i < end; i++) row(3, &given_, i);)

/* MPS__LOOP() of rows that do not depend on the dimension: row(fields, i). */
#define MPS__LOOP_ANY(name, row, type)                 \
    MPS__LOOP_OF(name, row(&given_->fields, i_), type, \
                 for (int64_t i = begin; i < end; i++) row(&given_, i);)

/* MPS__LOOP_ANY() of very cheap rows: a vector loop on the host. */
#define MPS__LOOP_CHEAP(name, row, type)               \
    MPS__LOOP_OF(name, row(&given_->fields, i_), type, \
                 MPS__INDEPENDENT for (int64_t i = begin; i < end; i++) row(&given_, i);)

/* `host`: the loop, with dim_, given_, begin and end. `work`: of a row in a kernel, with dim_,
 * given_ and i_. */
#define MPS__LOOP_OF(name, work, type, host)                                              \
    static void name##_run(int32_t dim_, const void *fields_, int64_t begin, int64_t end) \
    {                                                                                     \
        const type given_ = *(const type *)fields_;                                       \
        (void)dim_;                                                                       \
        host                                                                              \
    }                                                                                     \
    static const mps__loop name = {#name, sizeof(type), name##_run, MPS_FILE};

/* ---- reductions ---- */

/* Define the mps__values `name` from a row function
 *   MPS_ROW void row(const int dim, const type *fields, int64_t i, double *values);
 * which sets values[0..sums-1] to the terms of the row, each 0 on entry, and updates the maxima
 * after them. */
#define MPS__VALUES(name, row, type, sums, maxima)                                 \
    MPS__VALUES_OF(name, row(dim_, &given_->fields, i_, own_), type, sums, maxima, \
                   MPS__TERMS(sums, maxima,                                        \
                              (dim_ == 2 ? row(2, &given_, i, own_) : row(3, &given_, i, own_))))

/* MPS__VALUES() of rows that do not depend on the dimension: row(fields, i, values). */
#define MPS__VALUES_ANY(name, row, type, sums, maxima)                       \
    MPS__VALUES_OF(name, row(&given_->fields, i_, own_), type, sums, maxima, \
                   MPS__TERMS(sums, maxima, row(&given_, i, own_)))

/* MPS__VALUES_ANY() with a host function for a range, which has the same terms:
 *   static void range(const type *fields, int64_t begin, int64_t end, mps_exact *sums,
 *                     double *maxima); */
#define MPS__VALUES_BY(name, row, range, type, sums, maxima)                            \
    MPS__VALUES_OF(name, row(&given_->fields, i_, own_), type, sums, maxima, (void)row; \
                   range(&given_, begin, end, sum_, maximum_);)

/* Define the mps__values `name` that finds the first row that satisfies a test
 *   MPS_ROW bool is_it(const type *fields, int64_t i);
 * The lowest row has the largest negative index; doubles are exact to 2^53. */
#define MPS__FIRST(name, is_it, type)                                               \
    MPS_ROW void name##_row(const type *fields_, int64_t i_, double *largest_)      \
    {                                                                               \
        if (-(double)i_ > *largest_ && is_it(fields_, i_)) *largest_ = -(double)i_; \
    }                                                                               \
    MPS__VALUES_ANY(name, name##_row, type, 0, 1)

/* Loop of a reduction on the host; `work` is the code of a row. */
#define MPS__TERMS(sums, maxima, work)                          \
    double own_[(sums) + (maxima)];                             \
    mps__terms terms_;                                          \
    mps__terms_begin(&terms_, sum_, sums);                      \
    memcpy(own_ + (sums), maximum_, (maxima) * sizeof(double)); \
    for (int64_t i = begin; i < end; i++) {                     \
        memset(own_, 0, (sums) * sizeof(double));               \
        work;                                                   \
        if ((sums) > 0) mps__terms_add(&terms_, own_);          \
    }                                                           \
    mps__terms_end(&terms_);                                    \
    memcpy(maximum_, own_ + (sums), (maxima) * sizeof(double));

/* `host` and `work`: as in MPS__LOOP_OF(). */
#define MPS__VALUES_OF(name, work, type, sums, maxima, host)                              \
    static void name##_run(int32_t dim_, const void *fields_, int64_t begin, int64_t end, \
                           mps_exact *sum_, double *maximum_)                             \
    {                                                                                     \
        const type given_ = *(const type *)fields_;                                       \
        (void)dim_;                                                                       \
        host                                                                              \
    }                                                                                     \
    static const mps__values name = {#name, sizeof(type), sums, maxima, name##_run, MPS_FILE};

/* ---- groups ---- */

/* Define the mps__loop `name` for the MPS__TOGETHER threads of one group of a device:
 *   static void together(const type *fields, int64_t lane, bool any);
 * compiled for devices only (MPS_DEVICE). All threads synchronise by mps__thread_wait(), never
 * under a condition that differs between threads; without `any` there is no work. The host runs
 * instead
 *   static void whole(const type *fields); */
#define MPS__GROUP(name, whole, together, type)                                           \
    static void name##_run(int32_t dim_, const void *fields_, int64_t begin, int64_t end) \
    {                                                                                     \
        (void)dim_, (void)end;                                                            \
        if (begin == 0) whole((const type *)fields_);                                     \
    }                                                                                     \
    static const mps__loop name = {#name, sizeof(type), name##_run, MPS_FILE};

#endif

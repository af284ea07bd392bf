/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory, errors, log, versioned structs, small vectors. All other folders depend on it. */
#ifndef MPS_CORE_BASE_H
#define MPS_CORE_BASE_H

#include <mps/types.h>
#include <stdbool.h>

enum { MPS__ERROR_SIZE = 512, MPS__HINT_SIZE = 384, MPS__NAME_SIZE = 48 };

/* What application code may do while the library calls it. */
enum {
    MPS__UNLOCKED = 0,
    MPS__READ_ONLY = 1, /* in a monitor: calls that change nothing */
    MPS__LOCKED = 2     /* in a verb or a callback: almost no calls */
};

/* Set while the library calls application code. */
typedef struct mps__lock {
    int32_t level;
    const char *what; /* e.g. "a monitor" */
} mps__lock;

/* Common state of a handle in every layer: allocator, log and error text. */
typedef struct mps__context {
    mps_allocator allocator;
    mps_log_fn log;
    void *log_user;
    mps__lock lock;
    bool logs; /* a log callback is running */
    char error[MPS__ERROR_SIZE];
} mps__context;

/* Default allocator: malloc and free. */
mps_allocator mps__allocator_default(void);

/* Allocate `count` zeroed elements; NULL with the error text set on failure, also if count * size
 * overflows. count = 0 allocates one element. */
void *mps__alloc(mps__context *c, int64_t count, size_t size);
void mps__free(mps__context *c, void *block);

/* Grow *block to `count` elements; the first `used` are kept, the new part is zeroed. Never
 * shrinks. */
mps_status mps__grow(mps__context *c, void **block, int64_t *capacity, int64_t used, int64_t count,
                     size_t size);

/* Capacity to allocate when an array of `capacity` must hold n elements: exactly n the first time,
 * with a reserve later. */
static inline int64_t mps__capacity_for(int64_t n, int64_t capacity)
{
    return capacity > 0 ? n + n / 8 : n;
}

/* Scratch blocks that last at most for a verb, a search or the solution of an equation: successive
 * users share the memory. */
enum { MPS__SCRATCH = 16 };
typedef struct mps__scratch {
    void *block[MPS__SCRATCH];
    size_t bytes[MPS__SCRATCH];
} mps__scratch;

/* Block number `block` for `count` elements, or NULL with the error text set. It is not
 * initialised. The pointer of an earlier call for this block is invalid. */
void *mps__scratch_take(mps__context *c, mps__scratch *s, int32_t block, int64_t count,
                        size_t size);
void mps__scratch_free(mps__context *c, mps__scratch *s);

/* Set the error text and return `status`; without a context return `status` only. */
mps_status mps__fail(mps__context *c, mps_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void mps__log(mps__context *c, int level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Lock the handle, at least as strictly as before; the caller restores the returned lock
 * afterwards. */
mps__lock mps__lock_set(mps__context *c, int32_t level, const char *what);

/* Propagate a failure. */
#define MPS__TRY(call)                   \
    do {                                 \
        mps_status status_ = (call);     \
        if (status_ < 0) return status_; \
    } while (0)

/* Refuse an argument; kept in release builds. */
#define MPS__CHECK(context, condition, ...)                                    \
    do {                                                                       \
        if (!(condition)) return mps__fail((context), MPS_E_ARG, __VA_ARGS__); \
    } while (0)

/* Structs of the public interface, by type name. structs.c lists their size in each version and
 * refuses other sizes. The context may be NULL: no error text. */
/* Refuse an application's struct that is NULL or has no known size. */
mps_status mps__struct_check(mps__context *c, const char *type, const void *given);
/* Copy an application's struct into `out`: a shorter one is completed from `out`, an unknown
 * non-zero tail is refused. */
mps_status mps__struct_in(mps__context *c, const char *type, void *out, size_t size,
                          const void *in);
/* Copy `in` to an application's struct, which may have the size of an older version.
 * out->struct_size stays. */
mps_status mps__struct_out(mps__context *c, const char *type, void *out, const void *in,
                           size_t size);
/* Body of every ..._init(): copy `defaults` into the application's struct of `size` bytes and set
 * struct_size. */
mps_status mps__struct_init(const char *type, void *out, size_t size, const void *defaults,
                            size_t full);

/* The nearest of `count` names to `name` by edit distance, NULL if none is near. */
const char *mps__near(const char *name, const char *const *names, int count);
/* For error texts: all names in quotes, separated by commas. Returns `out`. */
const char *mps__list(char out[MPS__HINT_SIZE], char quote, const char *const *names, int count);
/* For error texts: the nearest name as a suggestion, or all names. Returns `out`. */
const char *mps__hint(char out[MPS__HINT_SIZE], char quote, const char *name,
                      const char *const *names, int count);
/* Copy a name of at most capacity-1 characters; false if it is NULL, empty or too long. */
bool mps__name_copy(char *out, size_t capacity, const char *name);

bool mps__finite(const double *values, int64_t count);
double mps__clock(void); /* monotonic [s] */

/* |b - a|^2 */
static inline double mps__square_between(const double *a, const double *b, int dim)
{
    const double x = b[0] - a[0], y = b[1] - a[1], z = dim == 3 ? b[2] - a[2] : 0;
    return dim == 3 ? x * x + y * y + z * z : x * x + y * y;
}

/* Axis along which a box has the most points, for error texts about boxes with too many. */
static inline int mps__longest(const double *points, int dim)
{
    int axis = 0;
    for (int d = 1; d < dim; d++)
        if (points[d] > points[axis]) axis = d;
    return axis;
}

/* Dot product of vectors of n >= 1 numbers, e.g. positions or loads (n = 6). */
static inline double mps__dot(const double *a, const double *b, int n)
{
    /* NOLINTNEXTLINE(clang-analyzer-core.NullDereference): see mps__op_begin() */
    double s = a[0] * b[0];
    for (int k = 1; k < n; k++) s += a[k] * b[k];
    return s;
}

#endif

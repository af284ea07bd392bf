/* SPDX-License-Identifier: BSD-3-Clause */
/* The operations of mps__space's vectors; see vector.h. */
#include "vector.h"
#include "kernels.h"
#include <math.h>

typedef struct content {
    mps__space *space;
    double *data;
    N_Vector next;       /* in the list of spare ones */
    N_Vector next_owned; /* in the list of those with an array of their own */
    bool owned, stop;
} content;

static content *content_of(N_Vector v)
{
    return v->content;
}

static mps__space *written(N_Vector v)
{
    mps__space *space = content_of(v)->space;
    space->dot_x = space->dot_y = NULL;
    return space;
}

static N_Vector_ID get_id(N_Vector v)
{
    (void)v;
    return SUNDIALS_NVEC_CUSTOM;
}

static sunindextype get_length(N_Vector v)
{
    const mps__space *space = content_of(v)->space;
    const mps_ppe_ranks *ranks = space->problem ? space->problem->ranks : NULL;
    return (sunindextype)(ranks ? ranks->rows : space->n);
}

/* Take a vector off the list of those with an array of their own. */
static void forget(mps__space *space, N_Vector v)
{
    N_Vector *at = &space->owned;
    while (*at && *at != v) at = &content_of(*at)->next_owned;
    if (*at) *at = content_of(v)->next_owned;
}

static void destroy(N_Vector v)
{
    if (!v) return;
    content *c = v->content;
    if (c) {
        mps_allocator allocator = c->space->allocator;
        if (c->owned) forget(c->space, v);
        if (c->owned) mps__give(&allocator, c->data);
        mps__give(&allocator, c);
    }
    v->content = NULL;
    N_VFreeEmpty(v);
}

static N_Vector new_owned(mps__space *space)
{
    double *data = mps__take(&space->allocator, space->capacity, sizeof *data);
    if (!data) return NULL;
    N_Vector v = mps__vector_wrap(space, data);
    if (!v) {
        mps__give(&space->allocator, data);
        return NULL;
    }
    content_of(v)->owned = true;
    content_of(v)->next_owned = space->owned;
    space->owned = v;
    return v;
}

static N_Vector clone(N_Vector v)
{
    mps__space *space = content_of(v)->space;
    N_Vector w = space->spare;
    if (!w) return new_owned(space);
    space->spare = content_of(w)->next;
    return w;
}

/* What an operation of a vector works on; each uses its own. */
typedef struct operands {
    mps__space *space;
    double a, b;
    const double *x, *y;
    double *z;
} operands;

/* Run an operation over all elements. */
static void run(const mps__space *space, mps_range_fn rows, operands *o)
{
    mps_parallel_rows_least(space->parallel, space->n, MPS__TEAM_LEAST / 2, rows, o);
}

static void linear_sum_rows(void *argument, int64_t begin, int64_t end)
{
    const operands *o = argument;
    const double *x = o->x, *y = o->y, a = o->a, b = o->b;
    double *z = o->z;
    MPS__INDEPENDENT
    for (int64_t i = begin; i < end; i++) z[i] = a * x[i] + b * y[i];
}

static void linear_sum(sunrealtype a, N_Vector vx, sunrealtype b, N_Vector vy, N_Vector vz)
{
    mps__space *space = written(vz);
    run(space, linear_sum_rows,
        &(operands){.a = a,
                    .b = b,
                    .x = mps__vector_data(vx),
                    .y = mps__vector_data(vy),
                    .z = mps__vector_data(vz)});
}

static void fill_rows(void *argument, int64_t begin, int64_t end)
{
    const operands *o = argument;
    for (int64_t i = begin; i < end; i++) o->z[i] = o->a;
}

static void fill(sunrealtype a, N_Vector vz)
{
    mps__space *space = written(vz);
    run(space, fill_rows, &(operands){.a = a, .z = mps__vector_data(vz)});
}

static void scale_rows(void *argument, int64_t begin, int64_t end)
{
    const operands *o = argument;
    const double *x = o->x, a = o->a;
    double *z = o->z;
    MPS__INDEPENDENT
    for (int64_t i = begin; i < end; i++) z[i] = a * x[i];
}

static void scale(sunrealtype a, N_Vector vx, N_Vector vz)
{
    mps__space *space = written(vz);
    run(space, scale_rows,
        &(operands){.a = a, .x = mps__vector_data(vx), .z = mps__vector_data(vz)});
}

/* Squares of x, and the largest |x weight|; a NaN does not count. */
static void excess_rows(void *argument, int64_t begin, int64_t end, mps_exact *squares,
                        double *largest)
{
    const operands *o = argument;
    const double *r = o->x, *weight = o->space->weight;
    double most = *largest;
    for (int64_t lo = begin, hi; lo < end; lo = hi) {
        hi = lo + MPS__BLOCK < end ? lo + MPS__BLOCK : end;
        mps_exact_add_products(squares, hi - lo, r + lo, r + lo);
        for (int64_t i = lo; weight && i < hi; i++) {
            const double size = fabs(r[i] * weight[i]);
            most = size > most ? size : most;
        }
    }
    *largest = most;
}

/* How far r is above the limits of both norms, in one pass. */
static double excess(mps__space *space, const double *r)
{
    mps_exact squares = {{0}, 0, 0};
    double largest = 0;
    mps__reduce(space->problem, excess_rows, &(operands){.space = space, .x = r},
                &(mps_exact_values){1, 1, &squares, &largest});
    double norm = sqrt(mps_exact_value(&squares)) / space->norm_limit;
    double divergence = space->weight ? largest / space->divergence_limit : 0;
    return norm < divergence ? divergence : norm;
}

static void product_rows(void *argument, int64_t begin, int64_t end)
{
    const operands *o = argument;
    const double *x = o->x, *y = o->y;
    double *z = o->z;
    MPS__INDEPENDENT
    for (int64_t i = begin; i < end; i++) z[i] = x[i] * y[i];
}

static void product(N_Vector vx, N_Vector vy, N_Vector vz)
{
    mps__space *space = written(vz);
    const double *x = mps__vector_data(vx), *y = mps__vector_data(vy);
    double *z = mps__vector_data(vz);
    if (content_of(vx)->stop || content_of(vy)->stop) {
        /* z is only the scratch of "may I stop?", so its norm is all that is needed */
        double e = excess(space, content_of(vx)->stop ? y : x);
        mps__space_remember(space, z, z, e * e);
        return;
    }
    run(space, product_rows, &(operands){.x = x, .y = y, .z = z});
}

static void quotient_rows(void *argument, int64_t begin, int64_t end)
{
    const operands *o = argument;
    const double *x = o->x, *y = o->y;
    double *z = o->z;
    MPS__INDEPENDENT
    for (int64_t i = begin; i < end; i++) z[i] = x[i] / y[i];
}

static void quotient(N_Vector vx, N_Vector vy, N_Vector vz)
{
    mps__space *space = written(vz);
    run(space, quotient_rows,
        &(operands){
            .x = mps__vector_data(vx), .y = mps__vector_data(vy), .z = mps__vector_data(vz)});
}

static sunrealtype dot_product(N_Vector vx, N_Vector vy)
{
    const mps__space *space = content_of(vx)->space;
    const double *x = mps__vector_data(vx), *y = mps__vector_data(vy);
    bool known = (x == space->dot_x && y == space->dot_y) ||
                 (x == space->dot_y && y == space->dot_x);
    return known ? space->dot : mps__dot_product(space->problem, x, y);
}

static void absolute_rows(void *argument, int64_t begin, int64_t end)
{
    const operands *o = argument;
    const double *x = o->x;
    double *z = o->z;
    MPS__INDEPENDENT
    for (int64_t i = begin; i < end; i++) z[i] = fabs(x[i]);
}

static void absolute(N_Vector vx, N_Vector vz)
{
    mps__space *space = written(vz);
    run(space, absolute_rows, &(operands){.x = mps__vector_data(vx), .z = mps__vector_data(vz)});
}

static void inverse_rows(void *argument, int64_t begin, int64_t end)
{
    const operands *o = argument;
    const double *x = o->x;
    double *z = o->z;
    MPS__INDEPENDENT
    for (int64_t i = begin; i < end; i++) z[i] = 1.0 / x[i];
}

static void inverse(N_Vector vx, N_Vector vz)
{
    mps__space *space = written(vz);
    run(space, inverse_rows, &(operands){.x = mps__vector_data(vx), .z = mps__vector_data(vz)});
}

static sunrealtype largest_norm(N_Vector vx)
{
    const mps__space *space = content_of(vx)->space;
    const double *x = mps__vector_data(vx);
    double largest = 0;
    if (x == space->dot_x && x == space->dot_y)
        return sqrt(space->dot); /* a vector that N_VProd made of the stopping vector */
    for (int64_t i = 0; i < space->n; i++) largest = fmax(largest, fabs(x[i]));
    mps_ppe_total(space->problem, &(mps_exact_values){.maxima = 1, .maximum = &largest});
    return largest;
}

static sunrealtype least(N_Vector vx)
{
    const mps__space *space = content_of(vx)->space;
    const double *x = mps__vector_data(vx);
    if (content_of(vx)->stop) return 1;
    double most = -INFINITY;
    for (int64_t i = 0; i < space->n; i++) most = fmax(most, -x[i]);
    mps_ppe_total(space->problem, &(mps_exact_values){.maxima = 1, .maximum = &most});
    return -most;
}

static sunrealtype weighted_norm(N_Vector vx, N_Vector vw)
{
    mps__space *space = content_of(vx)->space;
    const double *x = mps__vector_data(vx), *w = mps__vector_data(vw);
    if (content_of(vw)->stop) return excess(space, x);
    mps_exact squares = {{0}, 0, 0};
    for (int64_t lo = 0, n; lo < space->n; lo += n) {
        double part[MPS__BLOCK];
        n = space->n - lo < MPS__BLOCK ? space->n - lo : MPS__BLOCK;
        for (int64_t i = 0; i < n; i++) part[i] = x[lo + i] * w[lo + i];
        mps_exact_add_products(&squares, n, part, part);
    }
    mps_ppe_total(space->problem, &(mps_exact_values){.sums = 1, .sum = &squares});
    return sqrt(mps_exact_value(&squares));
}

static void set_ops(N_Vector v)
{
    v->ops->nvgetvectorid = get_id;
    v->ops->nvgetlength = get_length;
    v->ops->nvgetarraypointer = mps__vector_data;
    v->ops->nvclone = clone;
    v->ops->nvdestroy = destroy;
    v->ops->nvlinearsum = linear_sum;
    v->ops->nvconst = fill;
    v->ops->nvscale = scale;
    v->ops->nvprod = product;
    v->ops->nvdiv = quotient;
    v->ops->nvdotprod = dot_product;
    v->ops->nvabs = absolute;
    v->ops->nvinv = inverse;
    v->ops->nvmaxnorm = largest_norm;
    v->ops->nvmin = least;
    v->ops->nvwl2norm = weighted_norm;
}

N_Vector mps__vector_wrap(mps__space *space, double *data)
{
    content *c = mps__take(&space->allocator, 1, sizeof *c);
    if (!c) return NULL;
    *c = (content){.space = space, .data = data};
    N_Vector v = N_VNewEmpty(space->context);
    if (!v) {
        mps__give(&space->allocator, c);
        return NULL;
    }
    set_ops(v);
    v->content = c;
    return v;
}

N_Vector mps__vector_stop(mps__space *space)
{
    N_Vector v = mps__vector_wrap(space, NULL);
    if (v) content_of(v)->stop = true;
    return v;
}

bool mps__space_reserve(mps__space *space, int count)
{
    for (int k = 0; k < count; k++) {
        N_Vector v = new_owned(space);
        if (!v) return false;
        content_of(v)->next = space->spare;
        space->spare = v;
    }
    return true;
}

bool mps__space_grow(mps__space *space, int64_t capacity)
{
    bool good = true;
    space->capacity = 0;
    for (N_Vector v = space->owned; v; v = content_of(v)->next_owned) {
        mps__give(&space->allocator, content_of(v)->data);
        content_of(v)->data = NULL;
    }
    for (N_Vector v = space->owned; v && good; v = content_of(v)->next_owned) {
        content_of(v)->data = mps__take(&space->allocator, capacity, sizeof(double));
        good = content_of(v)->data != NULL;
    }
    if (good) space->capacity = capacity;
    return good;
}

void mps__space_release(mps__space *space)
{
    while (space->spare) {
        N_Vector v = space->spare;
        space->spare = content_of(v)->next;
        destroy(v);
    }
}

double *mps__vector_data(N_Vector v)
{
    return content_of(v)->data;
}

void mps__vector_point(N_Vector v, double *data)
{
    content_of(v)->data = data;
}

void mps__vector_written(N_Vector v)
{
    written(v);
}

void mps__space_remember(mps__space *space, const double *x, const double *y, double dot)
{
    space->dot_x = x;
    space->dot_y = y;
    space->dot = dot;
}

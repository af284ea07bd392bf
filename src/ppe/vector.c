/* SPDX-License-Identifier: BSD-3-Clause */
/* Operations of the vectors of mps__space; see vector.h. */
#include "vector.h"
#include "rows.h"
#include <math.h>

typedef struct content {
    mps__space *space;
    double *data;
    N_Vector next;       /* in the list of spare vectors */
    N_Vector next_owned; /* in the list of vectors that own their array */
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

/* Remove a vector from the list of those that own their array. */
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
        const mps_allocator allocator = c->space->allocator;
        if (c->owned) forget(c->space, v);
        if (c->owned) mps__release(&c->space->arrays, c->data);
        mps__release(&allocator, c);
    }
    v->content = NULL;
    N_VFreeEmpty(v);
}

static N_Vector new_owned(mps__space *space)
{
    double *data = mps__take(&space->arrays, space->capacity, sizeof *data);
    if (!data) return NULL;
    N_Vector v = mps__vector_wrap(space, data);
    if (!v) {
        mps__release(&space->arrays, data);
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

/* ---- operations ---- */

static const double *data(N_Vector v)
{
    return content_of(v)->data;
}

static void linear_sum(sunrealtype a, N_Vector x, sunrealtype b, N_Vector y, N_Vector z)
{
    const mps__space *s = written(z);
    mps__vectors_sum(s->parallel, s->n, (double[]){a, b}, data(x), data(y), mps__vector_data(z));
}

static void fill(sunrealtype a, N_Vector z)
{
    const mps__space *s = written(z);
    mps__vectors_fill(s->parallel, s->n, a, mps__vector_data(z));
}

static void scale(sunrealtype a, N_Vector x, N_Vector z)
{
    const mps__space *s = written(z);
    mps__vectors_scale(s->parallel, s->n, a, data(x), mps__vector_data(z));
}

/* How far r is above the limits of both norms, in one pass. */
static double excess(const mps__space *s, const double *r)
{
    double squares, largest;
    mps__vectors_norms(s->problem, r, s->weight, &squares, &largest);
    const double norm = sqrt(squares) / s->norm_limit,
                 divergence = s->weight ? largest / s->divergence_limit : 0;
    return norm < divergence ? divergence : norm;
}

static void product(N_Vector x, N_Vector y, N_Vector vz)
{
    mps__space *s = written(vz);
    double *z = mps__vector_data(vz);
    if (content_of(x)->stop || content_of(y)->stop) {
        /* z is only workspace of the stopping test: only its norm is needed */
        const double e = excess(s, data(content_of(x)->stop ? y : x));
        mps__space_remember(s, z, z, e * e);
        return;
    }
    mps__vectors_product(s->parallel, s->n, data(x), data(y), z);
}

static void quotient(N_Vector x, N_Vector y, N_Vector z)
{
    const mps__space *s = written(z);
    mps__vectors_quotient(s->parallel, s->n, data(x), data(y), mps__vector_data(z));
}

static sunrealtype dot_product(N_Vector vx, N_Vector vy)
{
    const mps__space *space = content_of(vx)->space;
    const double *x = data(vx), *y = data(vy);
    bool known = (x == space->dot_x && y == space->dot_y) ||
                 (x == space->dot_y && y == space->dot_x);
    return known ? space->dot : mps__vectors_dot(space->problem, x, y);
}

static void absolute(N_Vector x, N_Vector z)
{
    const mps__space *s = written(z);
    mps__vectors_absolute(s->parallel, s->n, data(x), mps__vector_data(z));
}

static void inverse(N_Vector x, N_Vector z)
{
    const mps__space *s = written(z);
    mps__vectors_inverse(s->parallel, s->n, data(x), mps__vector_data(z));
}

static sunrealtype largest_norm(N_Vector vx)
{
    const mps__space *space = content_of(vx)->space;
    const double *x = data(vx);
    /* a vector that N_VProd computed from the stopping vector */
    if (x == space->dot_x && x == space->dot_y) return sqrt(space->dot);
    return mps__vectors_largest(space->problem, x, 0, 0);
}

static sunrealtype least(N_Vector x)
{
    if (content_of(x)->stop) return 1;
    return -mps__vectors_largest(content_of(x)->space->problem, data(x), -1, -INFINITY);
}

static sunrealtype weighted_norm(N_Vector x, N_Vector w)
{
    const mps__space *space = content_of(x)->space;
    if (content_of(w)->stop) return excess(space, data(x));
    return sqrt(mps__vectors_squares(space->problem, data(x), data(w)));
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
        mps__release(&space->allocator, c);
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

void mps__space_release_device(mps__space *space, const mps_allocator *arrays)
{
    for (N_Vector v = space->owned; v; v = content_of(v)->next_owned) {
        mps__release(&space->arrays, content_of(v)->data);
        content_of(v)->data = NULL;
    }
    space->arrays = *arrays;
    space->capacity = 0;
}

bool mps__space_grow(mps__space *space, int64_t capacity)
{
    bool good = true;
    mps__space_release_device(space, &space->arrays);
    for (N_Vector v = space->owned; v && good; v = content_of(v)->next_owned) {
        content_of(v)->data = mps__take(&space->arrays, capacity, sizeof(double));
        good = content_of(v)->data != NULL;
    }
    if (good) space->capacity = capacity;
    return good;
}

void mps__space_lend(const mps__space *space, int count, double **arrays)
{
    N_Vector v = space->owned;
    for (int k = 0; k < count && v; k++, v = content_of(v)->next_owned)
        arrays[k] = content_of(v)->data;
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

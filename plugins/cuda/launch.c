/* SPDX-License-Identifier: BSD-3-Clause */
/* Loops on a GPU: one kernel per loop; terms of sums and maxima are reduced on the GPU in two more
 * launches. */
#include "handle.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    PARTS = 256, /* most groups that reduce the terms of a value */
    VALUES = 64  /* most values of a launch */
};

/* ---- kernels ---- */

static cuda_kernel *slot_of(cuda *c, const char *name)
{
    uint32_t hash = 2166136261u;
    for (const char *p = name; *p; p++) hash = (hash ^ (unsigned char)*p) * 16777619u;
    for (uint32_t k = 0; k < CUDA_KERNELS; k++) {
        cuda_kernel *slot = &c->kernel[(hash + k) % CUDA_KERNELS];
        if (!slot->name[0] || strcmp(slot->name, name) == 0) return slot;
    }
    return NULL;
}

/* A kernel by its name without the dimension: that of this dimension, or that of both. NULL with
 * the text: not found. */
static cuda_handle kernel_named(cuda *c, const char *name, int dim)
{
    char full[CUDA_NAME + 3];
    snprintf(full, sizeof full, "%s_%d", name, dim);
    cuda_kernel *slot = strlen(full) < CUDA_NAME ? slot_of(c, full) : NULL;
    if (!slot) {
        cuda_fail(&c->text, "kernel %s has no place", full);
        return NULL;
    }
    if (slot->name[0]) return slot->kernel;
    const cuda_driver *d = c->driver;
    cuda_handle kernel;
    int error = d->kernel(&kernel, c->gpu->module, full);
    if (error) error = d->kernel(&kernel, c->gpu->module, name);
    if (cuda_check(&c->text, d, error, full)) return NULL;
    memcpy(slot->name, full, strlen(full) + 1);
    slot->kernel = kernel;
    return kernel;
}

/* Run a kernel of one struct of `bytes` bytes without gaps. */
static int start(cuda *c, cuda_handle kernel, const char *name, void *given, size_t bytes,
                 int64_t groups)
{
    const cuda_driver *d = c->driver;
    void *argument = given;
    int error = 0;
    if (groups > INT32_MAX)
        return cuda_fail(&c->text, "%s: %lld groups of threads are too many", name,
                         (long long)groups);
    if (bytes > MPS__LAUNCH_BY_VALUE) {
        if (cuda_fit(c, &c->arguments, bytes)) return 1;
        error = d->up(c->arguments.begin, given, bytes, c->stream);
        argument = &c->arguments.begin;
    }
    if (!error)
        error = d->launch(kernel, (unsigned)groups, 1, 1, MPS__LAUNCH_GROUP, 1, 1, 0, c->stream,
                          &argument, NULL);
    return cuda_check(&c->text, d, error, name);
}

/* ---- loops ---- */

static int run(cuda *c, const mps_launch *l, mps__launch head)
{
    enum { MOST = 16384 };
    char name[CUDA_NAME];
    _Alignas(16) char given[MOST];
    const size_t view = l->view ? sizeof *l->view : 0, bytes = sizeof head + view + l->bytes;
    snprintf(name, sizeof name, "mpsk_%.*s__%s", (int)strcspn(l->file, "."), l->file, l->name);
    cuda_handle kernel = kernel_named(c, name, l->dim);
    if (!kernel) return 1;
    if (bytes > sizeof given)
        return cuda_fail(&c->text, "%s: %zu bytes of arguments are too many; must be at most %d",
                         name, bytes, MOST);
    memcpy(given, &head, sizeof head);
    if (view > 0) memcpy(given + sizeof head, l->view, view);
    if (l->bytes > 0) memcpy(given + sizeof head + view, l->fields, l->bytes);
    return start(c, kernel, name, given, bytes, (l->n + MPS__LAUNCH_GROUP - 1) / MPS__LAUNCH_GROUP);
}

int cuda_rows(void *self, const mps_launch *l)
{
    cuda *c = self;
    if (cuda_enter(c)) return 1;
    const int failed = run(c, l, (mps__launch){.n = l->n, .cancel = l->cancel, .mask = l->mask});
    cuda_exit(c);
    return failed;
}

/* ---- sums and maxima ---- */

static int join(cuda *c, const char *name, mps__launch_join given, int64_t values)
{
    cuda_handle kernel = kernel_named(c, name, 2);
    if (!kernel) return 1;
    return start(c, kernel, name, &given, sizeof given, values * given.parts);
}

/* Layout of `results`: results of the groups, then one result per value. */
typedef struct results {
    mps_exact *sum_parts, *sum;
    double *maximum_parts, *maximum;
    size_t bytes;
} results;

static results lay_out(const cuda *c, int64_t parts, int32_t sums, int32_t maxima)
{
    results r;
    r.sum = (mps_exact *)(uintptr_t)c->results.begin; /* results first: one download copies all */
    r.maximum = (double *)(r.sum + sums);
    r.sum_parts = (mps_exact *)(r.maximum + maxima + maxima % 2);
    r.maximum_parts = (double *)(r.sum_parts + sums * parts);
    r.bytes = (size_t)(sums * (parts + 1)) * sizeof(mps_exact) +
              (size_t)(maxima * (parts + 1) + 1) * sizeof(double);
    return r;
}

/* Number of groups that justify their launch. */
static int64_t parts_of(int64_t n)
{
    const int64_t wanted = (n + 8 * MPS__LAUNCH_GROUP - 1) / (8 * MPS__LAUNCH_GROUP);
    return wanted < PARTS ? wanted : PARTS;
}

static int join_all(cuda *c, const mps_launch *l, const double *terms, const results *r)
{
    const int64_t n = l->n, parts = parts_of(n);
    const double *maxima = terms + l->sums * n;
    const mps__launch_join add = {.n = n,
                                  .parts = parts,
                                  .terms = terms,
                                  .out = r->sum_parts,
                                  .cancel = l->cancel},
                           add_all = {.n = parts,
                                      .parts = 1,
                                      .sums = r->sum_parts,
                                      .out = r->sum,
                                      .cancel = l->cancel},
                           raise = {.n = n,
                                    .parts = parts,
                                    .terms = maxima,
                                    .out = r->maximum_parts,
                                    .cancel = l->cancel},
                           raise_all = {.n = parts,
                                        .parts = 1,
                                        .terms = r->maximum_parts,
                                        .out = r->maximum,
                                        .cancel = l->cancel};
    if (l->sums > 0 &&
        (join(c, "mpsk_sums__add", add, l->sums) || join(c, "mpsk_sums__join", add_all, l->sums)))
        return 1;
    return l->maxima > 0 && (join(c, "mpsk_sums__raise", raise, l->maxima) ||
                             join(c, "mpsk_sums__raise", raise_all, l->maxima));
}

/* Download the results and join them with the previous ones. */
static int fetch(cuda *c, const mps_launch *l, const results *r, mps_exact *sum, double *maximum)
{
    mps_exact got[VALUES]; /* maxima after the sums; a maximum is smaller than a sum */
    const size_t sums = (size_t)l->sums * sizeof *sum;
    int error = c->driver->down(got, (uintptr_t)r->sum, sums + (size_t)l->maxima * sizeof *maximum,
                                c->stream);
    if (!error) error = c->driver->wait(c->stream);
    if (cuda_check(&c->text, c->driver, error, l->name)) return 1;
    for (int32_t k = 0; k < l->sums; k++) mps_exact_join(&sum[k], &got[k]);
    for (int32_t k = 0; k < l->maxima; k++) {
        double value;
        memcpy(&value, (const char *)got + sums + (size_t)k * sizeof value, sizeof value);
        if (value > maximum[k]) maximum[k] = value;
    }
    return 0;
}

/* Reduce to `to`, or to memory of the handle described by `r`. */
static int values(cuda *c, const mps_launch *l, void *to, results *r)
{
    const int32_t count = l->sums + l->maxima;
    const int64_t parts = parts_of(l->n);
    if (count > VALUES)
        return cuda_fail(&c->text, "%s has %d sums and maxima; must be at most %d", l->name,
                         (int)count, VALUES);
    if (cuda_fit(c, &c->terms, (size_t)(count * l->n) * sizeof(double)) ||
        cuda_fit(c, &c->results, lay_out(c, parts, l->sums, l->maxima).bytes))
        return 1;
    *r = lay_out(c, parts, l->sums, l->maxima);
    if (to) {
        r->sum = to;
        r->maximum = (double *)(r->sum + l->sums);
    }
    double *terms = (double *)(uintptr_t)c->terms.begin;
    const mps__launch head = {.n = l->n,
                              .count = count,
                              .first = l->sums > 0 ? 0 : -INFINITY,
                              .terms = terms,
                              .cancel = l->cancel,
                              .mask = l->mask};
    return run(c, l, head) || join_all(c, l, terms, r);
}

int cuda_values(void *self, const mps_launch *l, mps_exact *sum, double *maximum)
{
    cuda *c = self;
    results r = {.bytes = 0};
    if (cuda_enter(c)) return 1;
    const int failed = values(c, l, NULL, &r) || fetch(c, l, &r, sum, maximum);
    cuda_exit(c);
    return failed;
}

int cuda_reduce_async(void *self, const mps_launch *l, void *to)
{
    cuda *c = self;
    results r = {.bytes = 0};
    if (cuda_enter(c)) return 1;
    const int failed = values(c, l, to, &r);
    cuda_exit(c);
    return failed;
}

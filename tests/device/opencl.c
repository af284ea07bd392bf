/* SPDX-License-Identifier: BSD-3-Clause */
#include "opencl.h"
#include "launch.h"
#include "layout.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS = 16 };

/* Keep the first failure. @return 1 */
static int fail(opencl *o, const char *format, ...)
{
    va_list list;
    if (o->failure[0]) return 1;
    va_start(list, format);
    vsnprintf(o->failure, sizeof o->failure, format, list);
    va_end(list);
    return 1;
}

/* ---- memory ---- */

static bool take(opencl *o, opencl_block *r, size_t bytes)
{
    if (bytes <= r->bytes) return true;
    if (r->begin) clSVMFree(o->context, r->begin);
    r->begin = clSVMAlloc(o->context, CL_MEM_READ_WRITE, bytes, 0);
    r->bytes = r->begin ? bytes : 0;
    return r->begin != NULL;
}

static void *take_block(void *self, uint64_t bytes)
{
    opencl *o = self;
    int k = 0;
    while (k < OPENCL_BLOCKS && o->block[k].begin) k++;
    if (k == OPENCL_BLOCKS || !take(o, &o->block[k], bytes)) return NULL;
    return o->block[k].begin;
}

static void drop(opencl *o, opencl_block *r)
{
    if (r->begin) clSVMFree(o->context, r->begin);
    free(r->before);
    free(r->host);
    *r = (opencl_block){0};
}

static opencl_block *block_of(opencl *o, const void *address)
{
    const char *at = address;
    for (int k = 0; k < OPENCL_BLOCKS; k++)
        if (o->block[k].begin && at >= o->block[k].begin &&
            at < o->block[k].begin + o->block[k].bytes)
            return &o->block[k];
    return NULL;
}

static void release(void *self, void *begin)
{
    opencl_block *r = block_of(self, begin);
    if (r) drop(self, r);
}

static int move(opencl *o, void *to, const void *from, uint64_t bytes)
{
    const cl_int error = clEnqueueSVMMemcpy(o->queue, CL_TRUE, to, from, bytes, 0, NULL, NULL);
    return error ? fail(o, "copy of %zu bytes: error %d", (size_t)bytes, (int)error) : 0;
}

static int upload(void *self, void *to, const void *from, uint64_t bytes)
{
    return block_of(self, to) ? move(self, to, from, bytes) : fail(self, "upload to no block");
}

static int download(void *self, void *to, const void *from, uint64_t bytes)
{
    return block_of(self, from) ? move(self, to, from, bytes) : fail(self, "download of no block");
}

static int copy(void *self, void *to, const void *from, uint64_t bytes)
{
    return block_of(self, to) && block_of(self, from) ? move(self, to, from, bytes)
                                                      : fail(self, "copy of no block");
}

static int clear(void *self, void *to, uint64_t bytes)
{
    opencl *o = self;
    const unsigned char zero = 0;
    const cl_int error = clEnqueueSVMMemFill(o->queue, to, &zero, 1, bytes, 0, NULL, NULL);
    if (error || clFinish(o->queue)) return fail(o, "clear: error %d", (int)error);
    return 0;
}

static int wait_for(void *self)
{
    opencl *o = self;
    return clFinish(o->queue) != 0;
}

static const char *failure(void *self)
{
    return ((opencl *)self)->failure;
}

/* ---- kernels ---- */

/* The kernel of a loop: of its dimension, or of both. */
static cl_kernel create(opencl *o, const char *name, int32_t dim)
{
    char full[OPENCL_NAME + 2];
    snprintf(full, sizeof full, "%s_%d", name, (int)dim);
    cl_kernel k = clCreateKernel(o->program, full, NULL);
    return k ? k : clCreateKernel(o->program, name, NULL);
}

static opencl_kernel *kernel_named(opencl *o, const char *name, int32_t dim)
{
    char full[OPENCL_NAME];
    snprintf(full, sizeof full, "%s in %d-D", name, (int)dim);
    for (int k = 0; k < o->kernels; k++)
        if (strcmp(o->kernel[k].name, full) == 0) return &o->kernel[k];
    if (o->kernels == OPENCL_KERNELS) return NULL;
    opencl_kernel *k = &o->kernel[o->kernels++];
    memcpy(k->name, full, sizeof full);
    k->kernel = create(o, name, dim);
    return k;
}

static opencl_kernel *kernel_of(opencl *o, const mps_launch *l)
{
    char name[OPENCL_NAME];
    snprintf(name, sizeof name, "mpsk_%.*s__%s", (int)strcspn(l->file, "."), l->file, l->name);
    return kernel_named(o, name, l->dim);
}

bool opencl_knows(opencl *o, const mps_launch *l)
{
    const opencl_kernel *k = kernel_of(o, l);
    return k && k->kernel;
}

/* Run a kernel of one argument, a struct in the memory of the device. */
static int start(opencl *o, cl_kernel kernel, const char *name, int64_t threads, int64_t group)
{
    const size_t local = (size_t)group, global = (size_t)((threads + group - 1) / group * group);
    cl_int error = clSetKernelArgSVMPointer(kernel, 0, o->arguments.begin);
    if (!error)
        error = clEnqueueNDRangeKernel(o->queue, kernel, 1, NULL, &global, &local, 0, NULL, NULL);
    if (!error) error = clFinish(o->queue);
    return error ? fail(o, "%s: error %d", name, (int)error) : 0;
}

static int run_kernel(opencl *o, const opencl_kernel *k, const mps_launch *l, mps__launch head)
{
    const size_t view = l->view ? sizeof *l->view : 0, bytes = sizeof head + view + l->bytes;
    if (!take(o, &o->arguments, bytes)) return fail(o, "no memory for arguments");
    memcpy(o->arguments.begin, &head, sizeof head);
    if (l->view) memcpy(o->arguments.begin + sizeof head, l->view, view);
    memcpy(o->arguments.begin + sizeof head + view, l->fields, l->bytes);
    return start(o, k->kernel, k->name, l->n, MPS__LAUNCH_GROUP);
}

/* Terms of rows become the results of groups, in the second launch one each. */
static int join(opencl *o, const char *name, const mps__launch_join *g, int64_t values)
{
    const opencl_kernel *k = kernel_named(o, name, 2);
    if (!k || !k->kernel) return fail(o, "there is no kernel %s", name);
    if (!take(o, &o->arguments, sizeof *g)) return fail(o, "no memory for arguments");
    memcpy(o->arguments.begin, g, sizeof *g);
    return start(o, k->kernel, name, values * g->parts * MPS__LAUNCH_GROUP, MPS__LAUNCH_GROUP);
}

static int join_sums(opencl *o, int64_t n, int32_t sums, mps_exact *sum)
{
    const double *terms = (const double *)(const void *)o->terms.begin;
    mps_exact *parts = (mps_exact *)(void *)o->results.begin, *whole = parts + sums * PARTS;
    const mps__launch_join add = {.n = n, .parts = PARTS, .terms = terms, .out = parts},
                           all = {.n = PARTS, .parts = 1, .sums = parts, .out = whole};
    if (join(o, "mpsk_sums__add", &add, sums) || join(o, "mpsk_sums__join", &all, sums)) return 1;
    for (int k = 0; k < sums; k++) mps_exact_join(&sum[k], &whole[k]);
    return 0;
}

static int join_maxima(opencl *o, int64_t n, int32_t maxima, const double *terms, double *maximum)
{
    double *parts = (double *)(void *)o->results.begin, *whole = parts + maxima * PARTS;
    const mps__launch_join raise = {.n = n, .parts = PARTS, .terms = terms, .out = parts},
                           all = {.n = PARTS, .parts = 1, .terms = parts, .out = whole};
    if (join(o, "mpsk_sums__raise", &raise, maxima) || join(o, "mpsk_sums__raise", &all, maxima))
        return 1;
    for (int k = 0; k < maxima; k++)
        if (whole[k] > maximum[k]) maximum[k] = whole[k];
    return 0;
}

double *opencl_terms(opencl *o, int64_t count, int64_t n)
{
    if (!take(o, &o->terms, (size_t)(count * n) * sizeof(double)) ||
        !take(o, &o->results, (size_t)count * (PARTS + 1) * sizeof(mps_exact)))
        return NULL;
    return (double *)(void *)o->terms.begin;
}

int opencl_join(opencl *o, int64_t n, int32_t sums, mps_exact *sum, int32_t maxima, double *maximum)
{
    const double *terms = (const double *)(const void *)o->terms.begin;
    if (sums > 0 && join_sums(o, n, sums, sum)) return 1;
    return maxima > 0 && join_maxima(o, n, maxima, terms + sums * n, maximum);
}

/* ---- loops, on both sides ---- */

/* Allocations to which any word of the arguments points. */
static void look(opencl *o, const void *arguments, size_t bytes)
{
    for (size_t at = 0; at + sizeof(void *) <= bytes; at += sizeof(void *)) {
        void *address;
        memcpy(&address, (const char *)arguments + at, sizeof address);
        opencl_block *r = block_of(o, address);
        if (r) r->seen = true;
    }
}

static bool keep(opencl_block *r)
{
    if (r->copied < r->bytes) {
        free(r->before);
        free(r->host);
        r->before = malloc(r->bytes);
        r->host = malloc(r->bytes);
        r->copied = r->before && r->host ? r->bytes : 0;
    }
    return r->copied > 0;
}

/* Whether a kernel is cancelled, as the host code then. */
static bool left_out(const mps_launch *l)
{
    return l->cancel && *l->cancel;
}

/* Run the host code on the arrays, store its results, and restore the arrays. */
static int run_host(opencl *o, const mps_launch *l, mps_exact *sum, double *maximum)
{
    for (int k = 0; k < OPENCL_BLOCKS; k++) o->block[k].seen = false;
    if (l->view) look(o, l->view, sizeof *l->view);
    look(o, l->fields, l->bytes);
    for (int k = 0; k < OPENCL_BLOCKS; k++) {
        opencl_block *r = &o->block[k];
        if (!r->seen) continue;
        if (!keep(r)) return fail(o, "no memory");
        memcpy(r->before, r->begin, r->bytes);
    }
    if (!left_out(l)) l->run(l->host, 0, l->n, sum, maximum);
    for (int k = 0; k < OPENCL_BLOCKS; k++) {
        opencl_block *r = &o->block[k];
        if (!r->seen) continue;
        memcpy(r->host, r->begin, r->bytes);
        memcpy(r->begin, r->before, r->bytes);
    }
    return 0;
}

static void differ(opencl *o, opencl_kernel *k, const char *what, size_t at, const void *device,
                   const void *host)
{
    double a, b;
    memcpy(&a, device, sizeof a);
    memcpy(&b, host, sizeof b);
    k->different++;
    if (o->difference[0]) return;
    snprintf(o->difference, sizeof o->difference,
             "%s, launch %lld: %s differs first at byte %zu: device %.17g, host %.17g", k->name,
             (long long)k->launches, what, at, a, b);
}

/* Union-find trees of n rows: concurrent threads give different paths to the same roots. Bytes
 * behind the rows are of no loop: they may never have been set, and both sides keep them. */
static bool same_trees(const opencl_kernel *k, const opencl_block *r, int64_t n)
{
    int32_t *const tree[2] = {(int32_t *)(void *)r->begin, (int32_t *)(void *)r->host};
    const size_t bytes = (size_t)n * sizeof(int32_t);
    if (!strstr(k->name, "bodies_device__") && !strstr(k->name, "levels__")) return false;
    if (bytes > r->bytes || memcmp(r->begin + bytes, r->host + bytes, r->bytes - bytes) != 0)
        return false;
    for (int32_t i = 0; i < n; i++) {
        int32_t root[2];
        for (int side = 0; side < 2; side++) {
            const int32_t parent = tree[side][i];
            if (parent < 0 || parent > i) return false;
            root[side] = i;
            while (tree[side][root[side]] != root[side]) root[side] = tree[side][root[side]];
        }
        if (root[0] != root[1]) return false;
    }
    return true;
}

static void compare_blocks(opencl *o, opencl_kernel *kernel, int64_t n)
{
    for (int k = 0; k < OPENCL_BLOCKS; k++) {
        const opencl_block *r = &o->block[k];
        size_t at = 0;
        char what[40];
        if (!r->seen || memcmp(r->begin, r->host, r->bytes) == 0) continue;
        if (same_trees(kernel, r, n)) continue;
        while (r->begin[at] == r->host[at]) at++;
        at -= at % sizeof(double);
        snprintf(what, sizeof what, "an array of %zu bytes", r->bytes);
        differ(o, kernel, what, at, r->begin + at, r->host + at);
    }
}

static int rows(void *self, const mps_launch *l)
{
    opencl *o = self;
    opencl_kernel *k = kernel_of(o, l);
    if (!k) return fail(o, "more kernels than the table of the test has entries");
    k->launches++;
    if (!k->kernel) {
        l->run(l->host, 0, l->n, NULL, NULL);
        return 0;
    }
    if (run_host(o, l, NULL, NULL)) return 1;
    if (run_kernel(o, k, l, (mps__launch){.n = l->n, .cancel = l->cancel, .mask = l->mask}))
        return 1;
    compare_blocks(o, k, l->n);
    return 0;
}

static int values(void *self, const mps_launch *l, mps_exact *sum, double *maximum)
{
    opencl *o = self;
    opencl_kernel *k = kernel_of(o, l);
    const int32_t count = l->sums + l->maxima;
    mps_exact host_sum[MPS_PARALLEL_VALUES];
    double host_maximum[MPS_PARALLEL_VALUES];
    if (!k) return fail(o, "more kernels than the table of the test has entries");
    k->launches++;
    if (!k->kernel) {
        l->run(l->host, 0, l->n, sum, maximum);
        return 0;
    }
    if (l->sums > 0) memcpy(host_sum, sum, (size_t)l->sums * sizeof *sum);
    if (l->maxima > 0) memcpy(host_maximum, maximum, (size_t)l->maxima * sizeof *maximum);
    if (run_host(o, l, l->sums > 0 ? host_sum : NULL, l->maxima > 0 ? host_maximum : NULL))
        return 1;
    const mps__launch head = {.n = l->n,
                              .count = count,
                              .first = l->sums > 0 ? 0 : -INFINITY,
                              .terms = opencl_terms(o, count, l->n),
                              .cancel = l->cancel,
                              .mask = l->mask};
    if (!head.terms) return fail(o, "no memory for terms");
    if (run_kernel(o, k, l, head)) return 1;
    compare_blocks(o, k, l->n);
    if (left_out(l)) return 0;
    if (opencl_join(o, l->n, l->sums, sum, l->maxima, maximum)) return 1;
    for (int m = 0; m < l->sums; m++)
        if (memcmp(&sum[m], &host_sum[m], sizeof *sum) != 0)
            differ(o, k, "a sum", 0, &(double){mps_exact_value(&sum[m])},
                   &(double){mps_exact_value(&host_sum[m])});
    for (int m = 0; m < l->maxima; m++)
        /* NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): bytes count */
        if (memcmp(&maximum[m], &host_maximum[m], sizeof *maximum) != 0)
            differ(o, k, "a maximum", 0, &maximum[m], &host_maximum[m]);
    return 0;
}

static int gather(void *self, const mps_launch *l, void *to)
{
    opencl *o = self;
    mps_exact sum[MPS_PARALLEL_VALUES] = {{{0}, 0, 0}};
    double maximum[MPS_PARALLEL_VALUES];
    const size_t sums = (size_t)l->sums * sizeof *sum;
    for (int m = 0; m < l->maxima; m++) maximum[m] = -INFINITY;
    if (!block_of(o, to)) return fail(o, "results go to no block");
    if (values(o, l, sum, maximum)) return 1;
    if (left_out(l)) return 0;
    return (l->sums > 0 && move(o, to, sum, sums)) ||
           (l->maxima > 0 &&
            move(o, (char *)to + sums, maximum, (size_t)l->maxima * sizeof *maximum));
}

/* ---- open and close ---- */

static unsigned char *read_all(const char *path, size_t *bytes)
{
    FILE *f = fopen(path, "rb");
    unsigned char *text = NULL;
    long size = -1;
    if (f && fseek(f, 0, SEEK_END) == 0) size = ftell(f);
    if (size > 0 && fseek(f, 0, SEEK_SET) == 0) text = malloc((size_t)size);
    if (text && fread(text, 1, (size_t)size, f) != (size_t)size) {
        free(text);
        text = NULL;
    }
    if (f) fclose(f);
    *bytes = text ? (size_t)size : 0;
    return text;
}

static bool build(opencl *o, cl_device_id device, const char *bitcode)
{
    cl_int error, loaded;
    size_t bytes;
    unsigned char *text = read_all(bitcode, &bytes);
    const unsigned char *one = text;
    if (!text) return fail(o, "%s cannot be read", bitcode) == 0;
    o->program = clCreateProgramWithBinary(o->context, 1, &device, &bytes, &one, &loaded, &error);
    free(text);
    if (!error) error = clBuildProgram(o->program, 1, &device, "-x spir -spir-std=1.2", NULL, NULL);
    if (error) fail(o, "the device does not take %s: error %d", bitcode, (int)error);
    return !error;
}

bool opencl_open(opencl *o, const char *bitcode)
{
    cl_platform_id platform;
    cl_device_id device;
    cl_int error;
    *o = (opencl){.ops = {.struct_size = sizeof o->ops,
                          .api = MPS_DEVICE_API,
                          .name = "opencl",
                          .self = o,
                          .alloc = take_block,
                          .free = release,
                          .upload = upload,
                          .download = download,
                          .clear = clear,
                          .copy = copy,
                          .launch = rows,
                          .reduce = values,
                          .reduce_async = gather,
                          .wait = wait_for,
                          .failure = failure}};
    if (clGetPlatformIDs(1, &platform, NULL) ||
        clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &device, NULL))
        return fail(o, "no device of OpenCL is installed (Debian: pocl-opencl-icd)") == 0;
    o->context = clCreateContext(NULL, 1, &device, NULL, NULL, &error);
    if (!error) o->queue = clCreateCommandQueueWithProperties(o->context, device, NULL, &error);
    if (error) return fail(o, "the device does not open: error %d", (int)error) == 0;
    return build(o, device, bitcode);
}

void opencl_close(opencl *o)
{
    for (int k = 0; k < OPENCL_BLOCKS; k++) drop(o, &o->block[k]);
    drop(o, &o->arguments);
    drop(o, &o->terms);
    drop(o, &o->results);
    for (int k = 0; k < o->kernels; k++)
        if (o->kernel[k].kernel) clReleaseKernel(o->kernel[k].kernel);
    if (o->program) clReleaseProgram(o->program);
    if (o->queue) clReleaseCommandQueue(o->queue);
    if (o->context) clReleaseContext(o->context);
}

void opencl_attach(opencl *o, mps_sim *sim)
{
    if (mps_sim_device_set(sim, &o->ops) < 0) fail(o, "%s", mps_sim_error(sim));
}

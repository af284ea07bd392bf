/* SPDX-License-Identifier: BSD-3-Clause */
/* Solution on a device. An equation on the host is copied to it, and the pressures are copied
 * back. */
#include "solvers.h"

enum { ROW, COL, POSITION, SHIFT, VAL, DIAGONAL, RHS, WEIGHT, PRESSURE, ARRAYS };

/* An array of the equation. `constant`: the same in all solutions of a series. bounds.c changes
 * values, diagonal, right side and shift in place; so an array is not constant by default. */
typedef struct array {
    const void *from;
    size_t bytes;
    bool constant;
} array;

bool mps__solvers_support_device(const mps__solvers *s)
{
    const bool plugin = s->use >= &s->solver[s->built_in_solvers] ||
                        (s->pc && s->pc >= &s->preconditioner[s->built_in_preconditioners]);
    return s->device && s->use->device && (!s->pc || s->pc->device) &&
           (!plugin || s->device->ops.plugin_loops);
}

bool mps__solvers_on_device(const mps__solvers *s, const mps_ppe_problem *e)
{
    /* the halo exchange is in the memory space of the equation */
    const bool known = mps__solvers_support_device(s) && (!e->ranks || mps__device_of(e->parallel));
    return known && !e->component && !e->law && (e->n > 0 || e->ranks);
}

/* @param on_device  out: the equation with device arrays
 * @param q          out: the pressures on the device */
static mps_status send(mps__solvers *s, const mps_ppe_problem *e, const double *p,
                       mps_ppe_problem *on_device, double **q)
{
    const size_t n = (size_t)e->n, entries = (size_t)e->row[e->n], numbers = n * sizeof(double);
    const array arrays[ARRAYS] = {
        [ROW] = {e->row, (n + 1) * sizeof *e->row, .constant = true},
        [COL] = {e->col, entries * sizeof *e->col, .constant = true},
        [POSITION] = {e->x, (size_t)e->dim * numbers, .constant = true},
        [SHIFT] = {.from = e->shift, .bytes = numbers},
        [VAL] = {.from = e->val, .bytes = entries * sizeof *e->val},
        [DIAGONAL] = {.from = e->diagonal, .bytes = numbers},
        [RHS] = {.from = e->rhs, .bytes = numbers},
        [WEIGHT] = {.from = e->weight, .bytes = e->weight ? numbers : 0},
        [PRESSURE] = {.from = p, .bytes = numbers},
    };
    size_t begin[ARRAYS + 1] = {0};
    for (int k = 0; k < ARRAYS; k++)
        begin[k + 1] = begin[k] + ((arrays[k].bytes + 255) & ~(size_t)255);
    const bool sent = s->sent && begin[ARRAYS] <= s->buffer.bytes;
    s->sent = false;
    char *buffer = mps__device_fit(s->device, &s->buffer, begin[ARRAYS]);
    if (!buffer) return MPS_E_NOMEM;
    for (int k = 0; k < ARRAYS; k++)
        if (!(sent && arrays[k].constant))
            mps__device_upload(s->device, buffer + begin[k], arrays[k].from, arrays[k].bytes);
    s->sent = true;
    *on_device = *e;
    on_device->row = (const int64_t *)(void *)(buffer + begin[ROW]);
    on_device->col = (const int32_t *)(void *)(buffer + begin[COL]);
    on_device->val = (const float *)(void *)(buffer + begin[VAL]);
    on_device->diagonal = (const double *)(void *)(buffer + begin[DIAGONAL]);
    on_device->rhs = (const double *)(void *)(buffer + begin[RHS]);
    if (e->weight) on_device->weight = (const double *)(void *)(buffer + begin[WEIGHT]);
    on_device->x = (const double *)(void *)(buffer + begin[POSITION]);
    on_device->shift = (const double *)(void *)(buffer + begin[SHIFT]);
    on_device->parallel = &s->device->parallel;
    on_device->device = &s->device->memory;
    *q = (double *)(void *)(buffer + begin[PRESSURE]);
    return MPS_OK;
}

mps_status mps__solvers_solve_device(mps__solvers *s, double *p, mps_ppe_result *result)
{
    mps_ppe_problem *e = &s->problem;
    double *q;
    if (mps__device_of(e->parallel)) {
        e->device = &s->device->memory;
        e->hint = e->ranks ? NULL : &s->hint;
        mps__solvers_run(s, e, p, result);
        return mps__device_status(s->device);
    }
    MPS__TRY(send(s, e, p, &s->sent_problem, &q));
    mps__solvers_run(s, &s->sent_problem, q, result);
    mps__device_download(s->device, p, q, (size_t)e->n * sizeof *p);
    return mps__device_status(s->device);
}

static void release_preconditioner(const mps_preconditioner_ops *pc, void *self)
{
    if (pc && pc->release_device) pc->release_device(self);
}

void mps__solvers_release_device(mps__solvers *s, mps__device *d)
{
    if (s->use && s->use->release_device) s->use->release_device(s->use_self);
    release_preconditioner(s->pc, s->pc_self);
    if (s->fallback_made) release_preconditioner(s->fallback, s->fallback_self);
    mps__device_release(d, &s->buffer);
    s->sent = false;
    s->device = NULL;
}

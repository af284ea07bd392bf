/* SPDX-License-Identifier: BSD-3-Clause */
/* Sums over the particles of a phase, and neighbours of the same phase by a grid of cells. */
#include "phases.h"
#include "view.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Linked lists of fluid particles by cell of two spacings. */
typedef struct cells {
    double lo[3], side;
    int64_t size[3];
    int64_t *first, *next; /* [cells], [particles]; -1: none */
} cells;

bool mps__phase_means_get(mps_sim *sim, int32_t phase, phase_means *m)
{
    view v;
    mps_lease u = {.struct_size = sizeof u};
    memset(m, 0, sizeof *m);
    if (!mps__view_open(sim, &v)) return false;
    const int32_t dim = v.x.stride;
    bool done = mps_lease_begin(sim, "velocity", MPS_READ, &u) == MPS_OK;
    for (int64_t i = 0; done && i < v.x.count; i++) {
        if (v.kind.integers[i] != MPS_FLUID || v.phase.integers[i] != phase) continue;
        m->count++;
        for (int d = 0; d < dim; d++) {
            const double at = v.x.data[i * dim + d];
            m->x[d] += at;
            m->x2[d] += at * at;
            m->u[d] += u.data[i * dim + d];
        }
    }
    for (int d = 0; m->count > 0 && d < dim; d++) {
        m->x[d] /= (double)m->count;
        m->x2[d] /= (double)m->count;
        m->u[d] /= (double)m->count;
    }
    if (done) mps_lease_end(sim, &u);
    mps__view_close(sim, &v);
    return done && m->count > 0;
}

static int64_t cell_of(const cells *c, const double *x, int32_t dim, const int *step)
{
    int64_t cell = 0;
    for (int d = dim - 1; d >= 0; d--) {
        int64_t at = (int64_t)floor((x[d] - c->lo[d]) / c->side) + step[d];
        if (at < 0 || at >= c->size[d]) return -1;
        cell = cell * c->size[d] + at;
    }
    return cell;
}

static bool cells_build(cells *c, const mps_lease *x, const int32_t *kind)
{
    static const int here[3] = {0};
    double hi[3];
    int64_t count = 1;
    for (int d = 0; d < x->stride; d++) {
        c->lo[d] = INFINITY;
        hi[d] = -INFINITY;
        for (int64_t i = 0; i < x->count; i++) {
            if (kind[i] != MPS_FLUID) continue;
            c->lo[d] = fmin(c->lo[d], x->data[i * x->stride + d]);
            hi[d] = fmax(hi[d], x->data[i * x->stride + d]);
        }
        c->size[d] = hi[d] >= c->lo[d] ? (int64_t)((hi[d] - c->lo[d]) / c->side) + 1 : 1;
        count *= c->size[d];
    }
    c->first = malloc((size_t)count * sizeof *c->first);
    c->next = malloc((size_t)x->count * sizeof *c->next);
    if (!c->first || !c->next) return false;
    for (int64_t k = 0; k < count; k++) c->first[k] = -1;
    for (int64_t i = 0; i < x->count; i++) {
        if (kind[i] != MPS_FLUID) continue;
        int64_t cell = cell_of(c, x->data + i * x->stride, x->stride, here);
        c->next[i] = c->first[cell];
        c->first[cell] = i;
    }
    return true;
}

/* Count neighbours of the same and of other phases within the side of a cell. */
static void company(const cells *c, const mps_lease *x, const int32_t *phase, int64_t i,
                    int64_t *same, int64_t *other)
{
    const double *a = x->data + i * x->stride;
    *same = *other = 0;
    for (int k = 0; k < (x->stride == 3 ? 27 : 9); k++) {
        const int step[3] = {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
        int64_t cell = cell_of(c, a, x->stride, step);
        for (int64_t j = cell < 0 ? -1 : c->first[cell]; j >= 0; j = c->next[j]) {
            double r2 = 0;
            for (int d = 0; d < x->stride; d++) r2 += pow(x->data[j * x->stride + d] - a[d], 2);
            if (j == i || r2 > c->side * c->side) continue;
            ++*(phase[j] == phase[i] ? same : other);
        }
    }
}

int64_t mps__phase_strays(mps_sim *sim)
{
    view v;
    cells c = {0};
    int64_t strays = 0;
    mps_sim_shape(sim, NULL, &c.side);
    c.side *= 2;
    if (!mps__view_open(sim, &v)) return -1;
    bool done = cells_build(&c, &v.x, v.kind.integers);
    for (int64_t i = 0; done && i < v.x.count; i++) {
        int64_t same, other;
        if (v.kind.integers[i] != MPS_FLUID) continue;
        company(&c, &v.x, v.phase.integers, i, &same, &other);
        if (same < 2 && other > 0) strays++;
    }
    free(c.first);
    free(c.next);
    mps__view_close(sim, &v);
    return done ? strays : -1;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Finds solids that pierce the free surface of the liquid at rest, and warns: linear theory for the
 * whole tank neglects them. */
#include "build.h"
#include <math.h>
#include <string.h>

/* What is found at the height of the surface, in the frame of the tank as built, before its
 * motion. */
typedef struct finding {
    build *b;
    int32_t part[BUILD_SOLIDS];
    double top, near;      /* the highest particle of phase 0; tolerance of its height [m] */
    double lo[3], hi[3];   /* of the tank's walls at that height */
    double (*box)[2][3];   /* [solids] bounds of a solid at that height; lo > hi: none */
    int64_t liquid, walls; /* particles of phase 0; walls of the tank at that height */
} finding;

static void widen(double *lo, double *hi, const double *x, int32_t dim)
{
    for (int32_t d = 0; d < dim; d++) {
        lo[d] = fmin(lo[d], x[d]);
        hi[d] = fmax(hi[d], x[d]);
    }
}

static void take(finding *f, const double *x, int32_t kind, int32_t part)
{
    const build *b = f->b;
    /* dummies of a thin plate are in the liquid on its other side */
    if (kind != MPS_WALL || fabs(x[1] - f->top) > f->near) return;
    for (int32_t i = 0; i < b->solids; i++)
        if (part >= 0 && part == f->part[i]) {
            widen(f->box[i][0], f->box[i][1], x, b->dim);
            return;
        }
    widen(f->lo, f->hi, x, b->dim);
    f->walls++;
}

/* @return false: a lease was refused */
static bool find(finding *f)
{
    build *b = f->b;
    mps_lease x = {.struct_size = sizeof x}, kind = x, phase = x, part = x;
    bool good = mps_lease_begin(b->sim, "position", MPS_READ, &x) == MPS_OK;
    good = good && mps_lease_begin(b->sim, "kind", MPS_READ, &kind) == MPS_OK;
    good = good && mps_lease_begin(b->sim, "phase", MPS_READ, &phase) == MPS_OK;
    good = good && mps_lease_begin(b->sim, "part", MPS_READ, &part) == MPS_OK;
    for (int64_t i = 0; good && i < x.count; i++) {
        if (kind.integers[i] != MPS_FLUID || phase.integers[i] != 0) continue;
        f->top = fmax(f->top, x.data[i * x.stride + 1]);
        f->liquid++;
    }
    for (int64_t i = 0; good && f->liquid > 0 && i < x.count; i++)
        take(f, x.data + i * x.stride, kind.integers[i], part.integers[i]);
    mps_lease_end(b->sim, &part);
    mps_lease_end(b->sim, &phase);
    mps_lease_end(b->sim, &kind);
    mps_lease_end(b->sim, &x);
    return good;
}

/* Keep the solids along the axis of the waves, and the longest part between those that span the
 * tank. */
static void keep(const finding *f, build_modes *m)
{
    const int32_t a = m->axis, other = 2 - a;
    const double least = 1.5 * f->b->dp;
    double begin = f->lo[a];
    m->blocks = 0;
    for (int32_t i = 0; i < f->b->solids; i++) {
        const double *lo = f->box[i][0], *hi = f->box[i][1];
        if (!(lo[a] <= hi[a])) continue;
        const bool across = f->b->dim == 2 ||
                            (lo[other] < f->lo[other] + least && hi[other] > f->hi[other] - least);
        int32_t at = m->blocks++;
        for (; at > 0 && m->block[at - 1].lo > lo[a]; at--) m->block[at] = m->block[at - 1];
        m->block[at] = (build_block){i, across, lo[a], hi[a]};
    }
    m->open = 0;
    for (int32_t k = 0; k < m->blocks; k++) {
        if (!m->block[k].across) continue;
        m->open = fmax(m->open, m->block[k].lo - begin);
        begin = fmax(begin, m->block[k].hi);
    }
    m->open = fmax(m->open, f->hi[a] - begin);
}

void mps__build_blocks(build *b)
{
    finding f = {.b = b, .top = -INFINITY};
    if (b->solids == 0 || b->modes.count == 0 || mps__case_failed(b->c) || b->status < 0) return;
    double h[3] = {b->dp, b->dp, b->dp};
    mps_lattice_get(b->sim, NULL, h);
    f.near = 0.75 * h[1];
    f.box = mps__build_alloc(b, (size_t)b->solids * sizeof *f.box);
    if (!f.box) return;
    for (int d = 0; d < 3; d++) {
        f.lo[d] = INFINITY;
        f.hi[d] = -INFINITY;
    }
    for (int32_t i = 0; i < b->solids; i++) {
        f.part[i] = mps_part_find(b->sim, b->solid[i].name);
        memcpy(f.box[i][0], f.lo, sizeof f.lo);
        memcpy(f.box[i][1], f.hi, sizeof f.hi);
    }
    if (find(&f) && f.walls > 0) keep(&f, &b->modes);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Cubic B-splines on a grid: on a full lattice their sum is 1 everywhere, for any offset of lattice
 * and grid. */
#include "raster.h"
#include "view.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { REACH = 16 }; /* largest number of nodes in the support of a particle along an axis */
static const double widest = 3;

/* The weights of a particle along one axis. */
typedef struct axis {
    int64_t first;
    int count;
    double weight[REACH];
} axis;

static double spline(double q)
{
    q = fabs(q);
    if (q >= 2) return 0;
    return q < 1 ? 2.0 / 3.0 + q * q * (0.5 * q - 1) : (2 - q) * (2 - q) * (2 - q) / 6;
}

bool mps__raster_create(raster *g, mps_sim *sim, const double *lo, const double *hi, double width)
{
    bool done = true;
    *g = (raster){.width = fmin(fmax(width, 1), widest), .count = 1, .step = -1};
    mps_sim_shape(sim, &g->dim, &g->dp);
    for (int d = 0; d < 3; d++) {
        g->size[d] = d < g->dim ? (int64_t)floor((hi[d] - lo[d]) / g->dp + 1e-6) + 1 : 1;
        g->lo[d] = d < g->dim ? lo[d] : 0;
        g->count *= g->size[d];
    }
    for (int k = 0; k < RASTER_LAYERS; k++) {
        g->share[k] = calloc((size_t)g->count, sizeof **g->share);
        done = done && g->share[k];
    }
    return done;
}

void mps__raster_free(raster *g)
{
    for (int k = 0; k < RASTER_LAYERS; k++) free(g->share[k]);
    memset(g->share, 0, sizeof g->share);
}

/* Nodes in the support of x, which is in spacings from the first node. */
static axis axis_of(double x, int64_t size, double width)
{
    axis a = {.first = (int64_t)ceil(x - 2 * width)};
    int64_t last = (int64_t)floor(x + 2 * width);
    if (a.first < 0) a.first = 0;
    if (last >= size) last = size - 1;
    for (int64_t k = a.first; k <= last && a.count < REACH; k++)
        a.weight[a.count++] = spline(((double)k - x) / width) / width;
    return a;
}

static void spread(const raster *g, const double *x, const double *tank, double *share)
{
    axis a[3] = {{0}, {0}, {.count = 1, .weight = {1}}};
    for (int d = 0; d < g->dim; d++)
        a[d] = axis_of((x[d] - tank[d] - g->lo[d]) / g->dp, g->size[d], g->width);
    for (int k = 0; k < a[2].count; k++)
        for (int j = 0; j < a[1].count; j++) {
            double *row = share + ((a[2].first + k) * g->size[1] + a[1].first + j) * g->size[0] +
                          a[0].first;
            for (int i = 0; i < a[0].count; i++)
                row[i] += a[0].weight[i] * a[1].weight[j] * a[2].weight[k];
        }
}

bool mps__raster_fill(raster *g, mps_sim *sim)
{
    view v;
    mps_motion_state tank = {.struct_size = sizeof tank};
    int64_t step = 0;
    mps_sim_time(sim, NULL, &step);
    if (step == g->step) return true;
    if (mps_motion_state_get(sim, &tank) != MPS_OK || !mps__view_open(sim, &v)) return false;
    for (int k = 0; k < RASTER_LAYERS; k++)
        memset(g->share[k], 0, (size_t)g->count * sizeof **g->share);
    for (int64_t i = 0; i < v.x.count; i++) {
        const int layer = v.kind.integers[i] != MPS_FLUID ? RASTER_SOLID
                          : v.phase.integers[i] == 0      ? RASTER_LIQUID
                                                          : RASTER_OTHER;
        spread(g, v.x.data + i * v.x.stride, tank.value + MPS_MOVE_X, g->share[layer]);
    }
    g->step = step;
    return mps__view_close(sim, &v);
}

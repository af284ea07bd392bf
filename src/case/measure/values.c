/* SPDX-License-Identifier: BSD-3-Clause */
/* Values of measures: loops over particles, and results of rasters and sums over phases. */
#include "values.h"
#include "interface.h"
#include "phases.h"
#include "view.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- the front ---- */

mps_status mps__open_front(quantity *q, mps_sim *sim)
{
    (void)sim;
    q->bins = (int64_t)(q->measure.box[3] / (2 * q->dp)) + 1;
    if (q->bins < 1) q->bins = 1;
    q->furthest = calloc((size_t)q->bins, sizeof *q->furthest);
    return q->furthest ? MPS_OK : MPS_E_NOMEM;
}

/* Largest x in each bin, 0: empty. Bins separate the main body of liquid from droplets in front of
 * it. */
static bool fill_bins(quantity *q, mps_sim *sim)
{
    view v;
    const double size = 2 * q->dp;
    const bool open = mps__view_open(sim, &v);
    memset(q->furthest, 0, (size_t)q->bins * sizeof *q->furthest);
    for (int64_t i = 0; open && i < v.x.count; i++) {
        const double at = v.x.data[i * v.x.stride];
        const int64_t k = (int64_t)(at / size);
        if (v.kind.integers[i] == MPS_FLUID && at > 0 && k < q->bins)
            q->furthest[k] = fmax(q->furthest[k], at);
    }
    int32_t failed = !open;
    if (q->ranks) q->ranks->largest(q->ranks->user, 1, &failed, 0);
    if (q->ranks) /* ghosts change no maximum */
        q->ranks->largest_numbers(q->ranks->user, (int32_t)q->bins, q->furthest);
    return open && mps__view_close(sim, &v) && !failed;
}

double mps__measure_front(quantity *q, mps_sim *sim)
{
    if (!fill_bins(q, sim)) return NAN;
    int64_t k = 0;
    while (k + 1 < q->bins && q->furthest[k + 1] > 0) k++;
    return q->furthest[k];
}

/* ---- phases as a whole ---- */

double mps__measure_centre(quantity *q, mps_sim *sim)
{
    phase_means m;
    return mps__phase_means_get(sim, q->measure.phase, &m) ? m.x[q->measure.axis] : NAN;
}

double mps__measure_speed(quantity *q, mps_sim *sim)
{
    phase_means m;
    return mps__phase_means_get(sim, q->measure.phase, &m) ? m.u[q->measure.axis] : NAN;
}

/* The second moment of an ellipse is a quarter of the square of its half axis. */
double mps__measure_half_axis(quantity *q, mps_sim *sim)
{
    phase_means m;
    const int d = q->measure.axis;
    if (!mps__phase_means_get(sim, q->measure.phase, &m)) return NAN;
    return 2 * sqrt(m.x2[d] - m.x[d] * m.x[d]);
}

double mps__measure_mass_centre(quantity *q, mps_sim *sim)
{
    mps_energy e;
    mps_energy_init(&e, sizeof e);
    return mps_energy_get(sim, &e) == MPS_OK ? e.centre[q->measure.axis] : NAN;
}

double mps__measure_strays(quantity *q, mps_sim *sim)
{
    const int64_t strays = mps__phase_strays(sim);
    (void)q;
    return strays < 0 ? NAN : (double)strays;
}

/* ---- interfaces and cavities ---- */

mps_status mps__open_interface(quantity *q, mps_sim *sim)
{
    const double *box = q->measure.box;
    return mps__raster_create(&q->grid, sim, box, box + 3, q->measure.smoothing) ? MPS_OK
                                                                                 : MPS_E_NOMEM;
}

double mps__measure_top(quantity *q, mps_sim *sim)
{
    return mps__raster_fill(&q->grid, sim) ? mps__contour_measure(&q->grid).hi[1] : NAN;
}

double mps__measure_bottom(quantity *q, mps_sim *sim)
{
    return mps__raster_fill(&q->grid, sim) ? mps__contour_measure(&q->grid).lo[1] : NAN;
}

double mps__measure_circularity(quantity *q, mps_sim *sim)
{
    if (!mps__raster_fill(&q->grid, sim)) return NAN;
    const contour c = mps__contour_measure(&q->grid);
    return 2 * sqrt(acos(-1.0) * c.area) / c.length;
}

mps_status mps__open_cavities(quantity *q, mps_sim *sim)
{
    const double *box = q->measure.box;
    return mps__cavities_create(&q->gas, sim, box, box + 3) ? MPS_OK : MPS_E_NOMEM;
}

double mps__measure_cavities(quantity *q, mps_sim *sim)
{
    return mps__cavities_volume(&q->gas, sim);
}

/* ---- particles ---- */

/* Distance from the centre over the radius. */
static double distance_of(const quantity *q, const double *x)
{
    const double *c = q->measure.centre;
    const double flat = hypot(x[0] - c[0], x[1] - c[1]);
    return (q->dim == 3 ? hypot(flat, x[2] - c[2]) : flat) / q->measure.radius;
}

double mps__measure_jump(quantity *q, mps_sim *sim)
{
    view v;
    mps_lease p = {.struct_size = sizeof p};
    double sum[2] = {0};
    int64_t count[2] = {0};
    if (!mps__view_open(sim, &v)) return NAN;
    if (mps_lease_begin(sim, "pressure", MPS_READ, &p) == MPS_OK) {
        for (int64_t i = 0; i < v.x.count; i++) {
            const double r = distance_of(q, v.x.data + i * v.x.stride);
            if (v.kind.integers[i] != MPS_FLUID || (r > 0.5 && r < 1.5)) continue;
            sum[r > 1] += p.data[i];
            count[r > 1]++;
        }
        mps_lease_end(sim, &p);
    }
    mps__view_close(sim, &v);
    return count[0] && count[1] ? sum[0] / (double)count[0] - sum[1] / (double)count[1] : NAN;
}

double mps__measure_gap(quantity *q, mps_sim *sim)
{
    const double floor[3] = {0, q->measure.level, 0};
    double at[3] = {0}, lowest = INFINITY;
    view v;
    if (mps_motion_to_lab(sim, floor, at, NULL) != MPS_OK || !mps__view_open(sim, &v)) return NAN;
    for (int64_t i = 0; i < v.x.count; i++)
        if (v.kind.integers[i] == MPS_FLUID) lowest = fmin(lowest, v.x.data[i * v.x.stride + 1]);
    mps__view_close(sim, &v);
    return lowest - at[1] - q->dp;
}

double mps__measure_angle(quantity *q, mps_sim *sim)
{
    mps_motion_state s = {.struct_size = sizeof s};
    (void)q;
    if (mps_motion_state_get(sim, &s) != MPS_OK) return NAN;
    return s.value[MPS_ROTATE_Z] * 180 / acos(-1.0);
}

static mps_step_info last_step(mps_sim *sim)
{
    mps_step_info info = {.struct_size = sizeof info};
    mps_step_info_get(sim, &info);
    return info;
}

double mps__measure_pockets(quantity *q, mps_sim *sim)
{
    (void)q;
    return last_step(sim).pockets;
}

double mps__measure_pocket_volume(quantity *q, mps_sim *sim)
{
    (void)q;
    return last_step(sim).pocket_volume;
}

double mps__measure_pocket_pressure(quantity *q, mps_sim *sim)
{
    (void)q;
    return last_step(sim).pocket_pressure;
}

double mps__measure_gas_work(quantity *q, mps_sim *sim)
{
    mps_energy e = {.struct_size = sizeof e};
    (void)q;
    return mps_energy_get(sim, &e) == MPS_OK ? e.gas : NAN;
}

double mps__measure_trespass(quantity *q, mps_sim *sim)
{
    view v;
    double most = -INFINITY;
    if (!mps__view_open(sim, &v)) return NAN;
    for (int64_t i = 0; i < v.x.count; i++) {
        const double above = v.x.data[i * v.x.stride + 1] - q->measure.level;
        if (v.kind.integers[i] == MPS_FLUID)
            most = fmax(most, v.phase.integers[i] == q->measure.phase ? above : -above);
    }
    return mps__view_close(sim, &v) ? most : NAN;
}

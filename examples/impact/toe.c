/* SPDX-License-Identifier: BSD-3-Clause */
/* The toe of a jet of thickness h = rows dp meets a wide wall, without gravity. Its tip is flat,
 * a wedge or half a circle. Columns of particles begin at the tip, so that its shape is resolved
 * with any number of rows.
 *
 * Exact, x from the middle of the wall, rho U = 1, H = h/2:
 *   flat   impulse at contact of a block on its plane of symmetry (front.c): mean over |x| < a
 *          H^2/a sum 2 cos(l (1 - a/H)) tanh(l L/H)/l^3,
 *          on the whole wall 2 H^2 sum 2 tanh(l L/H)/l^3
 *   wedge  Wagner, small deadrise b: wetted half width c = pi U t/(2 tan b)
 *   round  Wagner, early: c = 2 sqrt(R U t), R = h/2
 *          impulse sqrt(c^2 - x^2) at x < c, pi c^2/2 on the whole wall
 * and in the steady phase rho U^2/2 in the middle and rho U^2 h on the whole wall. */
#include "impact.h"
#include <math.h>

/* Lengths of the toe, of half of the wall, of the sensor [h]. */
enum { LENGTH = 3, HALF_WALL = 4 };
static const double SENSOR = 0.25, SIDE = 1; /* width, position of the sensor next to the toe */
/* Windows of means and impulses, and of the steady phase after contact [h/U]: 1 and 5 ms for a toe
 * 30 mm thick at 2.4 m/s. */
static const double BRIEF = 0.08, LONG = 0.4, BEGIN = 0.8, END = 1.2;
static const double BEFORE = 3; /* start of impulses before contact [dp/U] */
enum { FLAT, WEDGE, ROUND, SERIES = 400 };

static void set(impact *c, driver *d)
{
    impact_weightless(c, d);
    c->contact = (IMPACT_GAP - 1) * d->dp / c->speed;
    d->t_end = c->contact + (END * c->layers + 1) * d->dp / c->speed;
}

/* Height of the tip above its foremost point; h = 1, x from the middle. */
static double tip(const impact *c, double x)
{
    const double r = fmin(fabs(x), 0.5);
    if (c->tip == WEDGE) return r * tan(c->deadrise * acos(-1.0) / 180);
    if (c->tip == ROUND) return 0.5 - sqrt(0.25 - r * r);
    return 0;
}

/* Move the columns to the tip. */
static void draw(impact *c, double middle)
{
    driver *d = &c->d;
    const double h = c->layers * d->dp, from = middle + c->shift * d->dp;
    mps_lease kind = {.struct_size = sizeof kind}, lease = {.struct_size = sizeof lease};
    driver_check(d, mps_lease_begin(d->sim, "kind", MPS_READ, &kind), "tip");
    driver_check(d, mps_lease_begin(d->sim, "position", MPS_WRITE, &lease), "tip");
    for (int64_t i = 0; i < lease.count; i++) {
        double *x = lease.data + i * lease.stride;
        if (kind.integers[i] == MPS_FLUID) x[1] += h * tip(c, (x[0] - from) / h);
    }
    driver_check(d, mps_lease_end(d->sim, &lease), "tip");
    driver_check(d, mps_lease_end(d->sim, &kind), "tip");
}

/* Impulse of a block of height 1 on its wall: mean over the lowest part of height a; a = 1: whole
 * wall. */
static double flat_impulse(double a)
{
    double sum = 0;
    for (int n = 1; n <= SERIES; n++) {
        const double l = (n - 0.5) * acos(-1.0);
        sum += 2 * cos(l * (1 - a)) * tanh(2 * LENGTH * l) / (l * l * l) / a;
    }
    return sum;
}

/* Impulses at time t after contact, h = U = rho = 1: mean over the sensor, whole wall. */
static void wagner(const impact *c, double t, double *sensor, double *wall)
{
    const double pi = acos(-1.0), a = 0.5 * SENSOR;
    const double w = c->tip == WEDGE ? 0.5 * pi * t / tan(c->deadrise * pi / 180) : sqrt(2 * t);
    const double r = fmin(a, w);
    *sensor = 0.5 / a * (r * sqrt(w * w - r * r) + w * w * asin(r / w));
    *wall = 0.5 * pi * w * w;
}

static void print_exact(impact *c)
{
    double sensor[2], wall[2];
    if (c->tip == FLAT) {
        impact_told(c, "exact_contact", "impulse of contact, mean over the sensor, exact",
                    0.5 * flat_impulse(SENSOR));
        impact_told(c, "exact_contact_wall", "impulse of contact, whole wall, exact",
                    0.5 * flat_impulse(1));
        return;
    }
    wagner(c, BRIEF, &sensor[0], &wall[0]);
    wagner(c, LONG, &sensor[1], &wall[1]);
    impact_told(c, "wagner_brief", "impulse_brief by Wagner, small deadrise", sensor[0]);
    impact_told(c, "wagner_brief_wall", "impulse_brief_wall by Wagner", wall[0]);
}

static void add_figures(impact *c, double h)
{
    const double u = c->speed, rho = c->density, unit = h / u, p = rho * u * u, m = rho * u * h;
    const double at = c->contact, from = at - BEFORE * c->d.dp / u;
    const impact_span first = {from, at + c->d.dp / u, 0}, brief = {from, at + BRIEF * unit, 0},
                      some = {from, at + LONG * unit, 0}, all = {from, at + END * unit, 0},
                      steady = {at + BEGIN * unit, at + END * unit, 0},
                      mean_brief = {0, all.to, BRIEF * unit}, mean_long = {0, all.to, LONG * unit};
    impact_figure(c, "mean_brief", MPS_TRACE_LARGEST, "P", mean_brief, p);
    impact_figure(c, "mean_long", MPS_TRACE_LARGEST, "P", mean_long, p);
    impact_figure(c, "side_brief", MPS_TRACE_LARGEST, "P_side", mean_brief, p);
    impact_figure(c, "side_long", MPS_TRACE_LARGEST, "P_side", mean_long, p);
    impact_figure(c, "impulse_end_side", MPS_TRACE_INTEGRAL, "P_side", all, m);
    impact_figure(c, "force_brief", MPS_TRACE_LEAST, "F", mean_brief, -p * h);
    impact_figure(c, "force_long", MPS_TRACE_LEAST, "F", mean_long, -p * h);
    impact_figure(c, "impulse_contact", MPS_TRACE_INTEGRAL, "P", first, m);
    impact_figure(c, "impulse_contact_wall", MPS_TRACE_INTEGRAL, "F", first, -m * h);
    impact_figure(c, "impulse_brief", MPS_TRACE_INTEGRAL, "P", brief, m);
    impact_figure(c, "impulse_long", MPS_TRACE_INTEGRAL, "P", some, m);
    impact_figure(c, "impulse_end", MPS_TRACE_INTEGRAL, "P", all, m);
    impact_figure(c, "impulse_brief_wall", MPS_TRACE_INTEGRAL, "F", brief, -m * h);
    impact_figure(c, "impulse_long_wall", MPS_TRACE_INTEGRAL, "F", some, -m * h);
    impact_figure(c, "impulse_end_wall", MPS_TRACE_INTEGRAL, "F", all, -m * h);
    impact_figure(c, "impulse_brief_fluid", MPS_TRACE_CHANGE, "momentum_y", brief, m * h);
    impact_figure(c, "impulse_long_fluid", MPS_TRACE_CHANGE, "momentum_y", some, m * h);
    impact_figure(c, "impulse_end_fluid", MPS_TRACE_CHANGE, "momentum_y", all, m * h);
    impact_figure(c, "momentum_steady", MPS_TRACE_CHANGE, "momentum_y", steady,
                  m * h * (END - BEGIN));
    impact_figure(c, "stagnation", MPS_TRACE_MEAN, "P", steady, 0.5 * p);
    impact_figure(c, "force_steady", MPS_TRACE_MEAN, "F", steady, -p * h);
    impact_figure(c, "peak_raw", MPS_TRACE_LARGEST, "P", (impact_span){0, all.to, 0}, p);
}

static void build(impact *c)
{
    driver *d = &c->d;
    const double dp = d->dp;
    const int wide = c->layers, left = HALF_WALL * wide;
    const int across[] = {left, left + wide - 1},
              up[] = {IMPACT_GAP, IMPACT_GAP + LENGTH * wide - 1};
    const double size[] = {(2 * left + wide - 1) * dp, (up[1] + wide + IMPACT_GAP) * dp, 0},
                 middle = 0.5 * size[0], h = wide * dp;
    impact_water(c);
    impact_walls(c, size, false);
    impact_fill(c, across, up);
    draw(c, middle);
    impact_start(c, 0, -c->speed);
    driver_wall(d, "P", middle, 0, 0, SENSOR * h);
    driver_wall(d, "P_side", middle + SIDE * h, 0, 0, SENSOR * h);
    driver_force(d, "F", "tank.y0", 1);
    print_exact(c);
    add_figures(c, h);
}

const impact_case impact_toe = {set, build, 0.01, false};

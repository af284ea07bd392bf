/* SPDX-License-Identifier: BSD-3-Clause */
/* The free-surface gauge: the point on a line where a smoothed fluid fraction falls below one half.
 *
 * Particles are smoothed with cubic B-splines, dp wide along the line and diameter/2 across it: on
 * a lattice the sum is a smooth step that passes 1/2 exactly half a spacing above the centres of
 * the top layer, and it moves with the particles without staircase error. Droplets and films fill
 * less than half of the band and are not detected. Layers of a stretched lattice (1.3 : 1 in a
 * crest) are further apart: the depth of the centres below the surface is measured from the surface
 * particles.
 *
 * Below another phase the same step is halfway between the layers of both phases, at the interface,
 * for any layer distance: the reading is half a spacing lower, so that still water has the same
 * reading with and without air above it. */
#include "probe_gauge.h"
#include "plates.h"
#include "world_ranks.h"
#include <math.h>
#include <stdlib.h>

/* Above this solid fraction a sample gives no information about the fluid. */
static const double solid_limit = 0.9;

/* A particle near the line, in coordinates of the line. */
typedef struct beside {
    double s, across[2];
    int64_t id;
    double facing[2]; /* of walls: direction cosines of the wetted side across the line */
    double share;     /* fraction of a particle's size: one half for each face of a thin plate */
    bool solid, top;  /* top: on the free surface */
} beside;

typedef struct line {
    int32_t sides; /* directions across the line: 1 or 2 */
    double dp, width, length;
    double foot[3], along[3], across[2][3]; /* in the lab frame */
    double tank_across[2][3];
    int64_t count;
    beside *list;    /* sorted by s, then by id */
    bool faces;      /* some particles belong to a wall along the line */
    double extra[2]; /* additional shift of the band */
} line;

/* Contents of the band at one point of the line. */
typedef struct sample {
    double fluid, solid; /* fractions */
    double fill;         /* fluid fraction of the non-solid part */
} sample;

/* Cubic B-spline, q in spacings. */
static double spline(double q)
{
    q = fabs(q);
    if (q >= 2) return 0;
    return q < 1 ? 2.0 / 3.0 + q * q * (0.5 * q - 1) : (2 - q) * (2 - q) * (2 - q) / 6;
}

/* Phases below the surface, a bit for each: as requested, or those denser than the mean of the
 * lightest and the heaviest present. */
static uint32_t liquid_phases(mps__world *w, const mps_probe *c)
{
    const mps__particles *s = &w->particles;
    double low = INFINITY, high = 0;
    uint32_t present = 0, liquid = 0;
    if (c->phases) return c->phases;
    bool any[MPS__PHASES] = {false};
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_FLUID) any[s->phase[i]] = true;
    mps__world_any(w, MPS__PHASES, any);
    for (int p = 0; p < MPS__PHASES; p++) present |= any[p] ? UINT32_C(1) << p : 0;
    for (int p = 0; p < MPS__PHASES; p++) {
        if (!(present >> p & 1)) continue;
        low = fmin(low, w->setup.phase_density[p]);
        high = fmax(high, w->setup.phase_density[p]);
    }
    for (int p = 0; p < MPS__PHASES; p++)
        if (w->setup.phase_density[p] >= 0.5 * (low + high)) liquid |= UINT32_C(1) << p;
    return liquid;
}

static void line_init(line *l, const mps__world *w, const mps_probe *c)
{
    const mps__motion *m = &w->motion;
    *l = (line){.sides = w->setup.dim - 1, .dp = w->setup.dp, .length = c->length};
    /* narrower bands would resolve single columns */
    l->width = fmax(c->diameter, 2 * w->setup.dp) / 2;
    mps__motion_point(m, &m->now, c->at, l->foot, NULL, NULL);
    mps__motion_rotate(m, &m->now, c->direction, l->along);
    mps__probe_across(w->setup.dim, c->direction, l->tank_across);
    for (int32_t e = 0; e < l->sides; e++)
        mps__motion_rotate(m, &m->now, l->tank_across[e], l->across[e]);
}

/* True if particle i is within the band of any point of the line. */
static bool line_coordinates(const line *l, const mps__particles *s, int64_t i, beside *b)
{
    const double *x = &s->x[i * s->dim];
    const double r[3] = {x[0] - l->foot[0], x[1] - l->foot[1], s->dim == 3 ? x[2] - l->foot[2] : 0};
    /* across first: most particles fail here, few along the line */
    for (int32_t e = 0; e < l->sides; e++) {
        b->across[e] = mps__dot(r, l->across[e], s->dim);
        if (fabs(b->across[e]) > 5 * l->width) return false;
    }
    b->s = mps__dot(r, l->along, s->dim);
    return b->s >= -3 * l->dp && b->s <= l->length + 3 * l->dp;
}

static void wall_facing(const line *l, const mps__particles *s, int64_t i, beside *b)
{
    const double *area = &s->area[i * s->dim];
    double norm = sqrt(mps__dot(area, area, s->dim));
    for (int32_t e = 0; e < l->sides; e++) {
        b->facing[e] = norm > 0 ? mps__dot(area, l->tank_across[e], s->dim) / norm : 0;
    }
}

static int compare_places(const void *a, const void *b)
{
    const beside *i = a, *j = b;
    if (i->s != j->s) return i->s > j->s ? 1 : -1;
    return (i->id > j->id) - (i->id < j->id);
}

/* Particles near the line, without phases that are above the surface. */
static mps_status line_collect(line *l, mps__world *w, uint32_t phases)
{
    const mps__particles *s = &w->particles;
    int64_t capacity = 0;
    for (int64_t i = mps__own_from(&w->ghosts, 0); i < s->n; i = mps__own_from(&w->ghosts, i + 1)) {
        beside b = {0};
        if (mps__is_shadow(s, i) || !line_coordinates(l, s, i, &b)) continue;
        const bool fluid = s->kind[i] == MPS_FLUID;
        if (fluid && !(phases >> s->phase[i] & 1)) continue;
        b.id = s->id[i];
        b.solid = !fluid;
        b.top = fluid && s->region[i] == MPS_REGION_SURFACE;
        b.share = mps__plates_fraction(w, i);
        if (s->kind[i] == MPS_WALL) wall_facing(l, s, i, &b);
        MPS__TRY(
            mps__grow(w->context, (void **)&l->list, &capacity, l->count, l->count + 1, sizeof b));
        l->list[l->count++] = b;
    }
    MPS__TRY(mps__ranks_collect(&w->ranks, (void **)&l->list, &l->count, sizeof *l->list));
    for (int64_t k = 0; k < l->count; k++)
        for (int32_t e = 0; e < l->sides; e++)
            l->faces = l->faces || fabs(l->list[k].facing[e]) > 0.5;
    if (l->count > 0) qsort(l->list, (size_t)l->count, sizeof *l->list, compare_places);
    return MPS_OK;
}

/* The first particle at s or beyond. */
static int64_t first_from(const line *l, double s)
{
    int64_t low = 0, high = l->count;
    while (low < high) {
        int64_t middle = low + (high - low) / 2;
        if (l->list[middle].s < s)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Whether a place at this distance from the middle of a band is in it. Walls on the lattice are
 * exactly two thirds of the default diameter away: they are outside, whatever the rounding. */
static bool in_band(const line *l, double distance)
{
    return fabs(distance) < 4.0 / 3.0 * l->width * (1 - 1e-6);
}

static bool near_axis(const line *l, const beside *b)
{
    bool near = true;
    for (int32_t e = 0; e < l->sides; e++) near = near && in_band(l, b->across[e]);
    return near;
}

/* Beside a wall the band is moved off it, so that it samples fluid and not a film: its centre is at
 * least two thirds of the diameter away. */
static void band_shift(const line *l, double s, double shift[2])
{
    double low[2] = {-INFINITY, -INFINITY}, high[2] = {INFINITY, INFINITY},
           reach = 4.0 / 3.0 * l->width;
    for (int64_t k = first_from(l, s - 1.01 * l->dp);
         l->faces && k < l->count && l->list[k].s <= s + 1.01 * l->dp; k++) {
        const beside *b = &l->list[k];
        if (!b->solid || !near_axis(l, b)) continue;
        for (int32_t e = 0; e < l->sides; e++) {
            /* a line far behind a face is inside the solid and stays there */
            if (b->facing[e] > 0.5 && b->across[e] < 0.75 * l->dp)
                low[e] = fmax(low[e], b->across[e]);
            if (b->facing[e] < -0.5 && b->across[e] > -0.75 * l->dp)
                high[e] = fmin(high[e], b->across[e]);
        }
    }
    for (int32_t e = 0; e < l->sides; e++) {
        shift[e] = 0;
        if (low[e] > high[e]) continue; /* inside a solid */
        shift[e] = fmin(fmax(0, low[e] + reach), high[e] - reach);
        if (high[e] - low[e] < 2 * reach) shift[e] = 0.5 * (low[e] + high[e]);
    }
}

static sample line_sample(const line *l, double s)
{
    sample out = {0};
    double shift[2];
    band_shift(l, s, shift);
    for (int64_t k = first_from(l, s - 2 * l->dp); k < l->count && l->list[k].s < s + 2 * l->dp;
         k++) {
        const beside *b = &l->list[k];
        double weight = b->share * spline((b->s - s) / l->dp);
        for (int32_t e = 0; e < l->sides; e++)
            weight *= spline((b->across[e] - shift[e] - l->extra[e]) / l->width) * l->dp / l->width;
        *(b->solid ? &out.solid : &out.fluid) += weight;
    }
    out.fill = out.fluid / fmax(1 - out.solid, 1 - solid_limit);
    return out;
}

/* Bisection between low (more than half full) and high, to 1e-7; under a ceiling only the fluid
 * counts. */
static double crossing(const line *l, double low, double high, bool ceiling)
{
    for (int k = 0; k < 24; k++) {
        double middle = 0.5 * (low + high);
        sample here = line_sample(l, middle);
        if ((ceiling ? here.fluid : here.fill) >= 0.5)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}

/* A gap in the filling that is not the surface: it closes again within a spacing. */
static bool gap_closes(const line *l, double s, double step)
{
    for (double distance = step; distance < 1.01 * l->dp; distance += step)
        if (line_sample(l, s + distance).fill >= 0.5) return true;
    return false;
}

/* Distance by which the band can move in direction `sign` of side e until it is as close to a solid
 * as to the first one. */
static double clearance(const line *l, double s, const double shift[2], int32_t e, double sign)
{
    double least = INFINITY;
    for (int64_t k = first_from(l, s - 1.01 * l->dp);
         k < l->count && l->list[k].s <= s + 1.01 * l->dp; k++) {
        const beside *b = &l->list[k];
        const double distance = sign * (b->across[e] - shift[e]);
        if (!b->solid || distance <= 0) continue;
        if (l->sides == 2 && !in_band(l, b->across[1 - e] - shift[1 - e])) continue;
        least = fmin(least, distance - 4.0 / 3.0 * l->width);
    }
    return least;
}

/* Slope of the surface along side e, from a second band at distance `distance`; 0 if it is
 * steeper than the width of the first band: that is the end of a run-up. Its weight decreases to 0
 * between slopes of 1/2 and 1. */
static double slope_ahead(line *l, double surface, int32_t e, double distance)
{
    const double low = surface - fabs(distance), high = surface + fabs(distance);
    double slope = 0;
    l->extra[e] = distance;
    if (line_sample(l, low).fill >= 0.5 && line_sample(l, high).fill < 0.5)
        slope = (crossing(l, low, high, false) - surface) / distance;
    l->extra[e] = 0;
    return slope * fmin(fmax(2 - 2 * fabs(slope), 0), 1);
}

/* 1 if nothing is above the surface; a film on the wall raises the reading of the first band only,
 * and is no slope. */
static double clear_above(const line *l, double surface)
{
    return fmax(0, 1 - 10 * line_sample(l, surface + 3 * l->dp).fluid);
}

/* Extrapolate linearly to the line if the band was moved off a wall. */
static double at_line(line *l, double surface)
{
    double shift[2], out = surface;
    if (!l->faces) return surface;
    const double trust = clear_above(l, surface);
    band_shift(l, surface, shift);
    for (int32_t e = 0; e < l->sides; e++) {
        const double sign = shift[e] > 0 ? 1 : -1,
                     distance = fmin(l->width, clearance(l, surface, shift, e, sign));
        if (shift[e] != 0 && distance >= 0.5 * l->width)
            out -= trust * shift[e] * slope_ahead(l, surface, e, sign * distance);
    }
    return out;
}

/* Distance from the end of the filling to the centres of the top layer: mean over the surface
 * particles in the band; half a spacing if there are none, or if they are not a layer below it. */
static double row_below(const line *l, double surface)
{
    double sum = 0, weights = 0, shift[2];
    band_shift(l, surface, shift);
    for (int64_t k = first_from(l, surface - 1.5 * l->dp);
         k < l->count && l->list[k].s < surface + 0.5 * l->dp; k++) {
        const beside *b = &l->list[k];
        double weight = b->top ? b->share : 0;
        for (int32_t e = 0; e < l->sides; e++)
            weight *= spline((b->across[e] - shift[e]) / l->width);
        sum += weight * (surface - b->s);
        weights += weight;
    }
    const double depth = weights > 0 ? sum / weights : 0.5 * l->dp;
    return fabs(depth - 0.5 * l->dp) < 0.3 * l->dp ? depth : 0.5 * l->dp;
}

/* Maximum number of sampling points on a line. */
static const double most_samples = 1e15;

/* March from the foot to the point where the filling ends. */
static double find_surface(line *l)
{
    double step = 0.5 * l->dp, wet = -1; /* last full point */
    bool solid = false;                  /* state of the last sample */
    /* nothing to sample beyond the last particle, however long the line is */
    const double top = l->count > 0 ? l->list[l->count - 1].s : 0;
    const int64_t last = (int64_t)ceil(
        fmin(fmin(l->length, fmax(top, 0) + 10 * l->dp) / step, most_samples));
    for (int64_t k = 0; k <= last; k++) {
        double s = (double)k * step;
        sample here = line_sample(l, s);
        if (here.solid > solid_limit) {
            solid = true;
        } else if (here.fill >= 0.5) {
            wet = s;
            solid = false;
        } else if (solid && wet >= 0) {
            return crossing(l, fmax(wet - 2 * l->dp, 0), s, true) - 0.5 * l->dp;
        } else if (wet >= 0 && !gap_closes(l, s, step)) {
            const double surface = crossing(l, wet, s, false);
            return at_line(l, surface) - row_below(l, surface);
        } else if (wet < 0) {
            if (!solid && s > 1.5 * l->dp) return 0; /* dry foot */
            solid = false;
        }
    }
    return wet < 0 ? 0 : l->length;
}

static double topmost(const line *l)
{
    double top = 0;
    for (int64_t k = 0; k < l->count; k++) {
        const beside *b = &l->list[k];
        bool inside = !b->solid;
        for (int32_t e = 0; e < l->sides; e++) inside = inside && fabs(b->across[e]) <= l->width;
        if (inside) top = fmax(top, b->s);
    }
    return top;
}

mps_status mps__gauge_measure(mps__world *w, const mps_probe *config, double *value)
{
    line l;
    MPS__TRY(mps__world_fetch_field(w, MPS__FIELD_POSITION));
    MPS__TRY(mps__world_fetch_field(w, MPS__FIELD_AREA));
    MPS__TRY(mps__world_fetch_field(w, MPS__FIELD_REGION));
    line_init(&l, w, config);
    mps_status status = line_collect(&l, w, liquid_phases(w, config));
    if (status == MPS_OK) {
        double surface = find_surface(&l);
        if (config->count_drops) surface = fmax(surface, topmost(&l));
        *value = fmin(fmax(surface, 0), l.length);
    }
    mps__free(w->context, l.list);
    return status;
}

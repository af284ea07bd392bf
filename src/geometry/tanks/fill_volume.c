/* SPDX-License-Identifier: BSD-3-Clause */
/* Volume of a fill. A particle represents its cell; beside a wall also the half cell of the wall,
 * and at a free surface the half of its cell below it: n layers are n spacings deep. */
#include "lattice_plan.h"
#include "solid.h"
#include <math.h>

/* Sample points in a cell at which `inside` is evaluated, if it differs between the corners. */
enum { PLACES = 256 };

/* A cell: its extent from its point to both sides [cells], its volume, and the largest number of
 * ends of an axis at which the liquid may end. */
typedef struct cell {
    double reach[3][2], volume;
    int free_ends;
} cell;

static cell cell_of(const mps__lattice_plan *p, const int64_t k[3])
{
    cell c = {.volume = 1};
    for (int d = 0; d < p->dim; d++) {
        int ends = 0;
        for (int end = 0; end < 2; end++) {
            const int state = mps__lattice_plan_beside(p, k, d, end ? 1 : -1);
            c.reach[d][end] = state == POINT_SOLID ? 1 : 0.5;
            ends += state == POINT_FREE;
        }
        c.volume *= (c.reach[d][0] + c.reach[d][1]) * p->box.h[d];
        c.free_ends = ends > c.free_ends ? ends : c.free_ends;
    }
    return c;
}

/* Part of a cell within the box lo..hi [m^dim]. */
static double in_box(const mps__lattice_plan *p, const double X[3], const cell *c, const double *lo,
                     const double *hi)
{
    double volume = 1;
    for (int d = 0; d < p->dim; d++) {
        const double h = p->box.h[d];
        volume *= fmax(0, fmin(hi[d], X[d] + c->reach[d][1] * h) -
                              fmax(lo[d], X[d] - c->reach[d][0] * h));
    }
    return volume;
}

static int is_inside(const mps__lattice_plan *p, const double X[3], const cell *c,
                     const double q[3])
{
    double x[3] = {0, 0, 0};
    for (int d = 0; d < p->dim; d++)
        x[d] = X[d] + (-c->reach[d][0] + q[d] * (c->reach[d][0] + c->reach[d][1])) * p->box.h[d];
    return p->inside(p->user, x) != 0;
}

/* Whether the liquid ends near a point: an adjacent free point has another state. */
static bool at_the_end(const mps__lattice_plan *p, const int64_t k[3], int state)
{
    int64_t o[3];
    for (int n = 0; n < (p->dim == 2 ? 9 : 27); n++) {
        bool in = true;
        int64_t place = 0, stride = 1;
        for (int d = 0; d < p->dim; d++) {
            o[d] = k[d] + (d == 0 ? n % 3 : d == 1 ? n / 3 % 3 : n / 9) - 1;
            in = in && o[d] >= p->box.first[d] && o[d] <= p->box.last[d];
            place += (o[d] - p->box.first[d]) * stride;
            stride *= p->box.last[d] - p->box.first[d] + 1;
        }
        if (in && p->state[place] <= POINT_CHOSEN && p->state[place] != state) return true;
    }
    return false;
}

/* Sample point n of a cell, 0..1 along each axis, by an additive recurrence: 256 points resolve a
 * plane at any angle to some 1/128. */
static void place_in_cell(int dim, int64_t n, double q[3])
{
    static const double step[2][3] = {{0.7548776662466927, 0.5698402909980532, 0},
                                      {0.8191725133961645, 0.6710436067037893, 0.5497004779019703}};
    for (int d = 0; d < 3; d++) {
        const double at = ((double)n + 0.5) * step[dim - 2][d];
        q[d] = at - floor(at);
    }
}

/* Fraction of a cell that is inside. */
static double share_inside(const mps__lattice_plan *p, const double X[3], const cell *c)
{
    const int corners = 1 << p->dim;
    int inside = 0;
    for (int corner = 0; corner < corners; corner++)
        inside += is_inside(p, X, c,
                            (const double[]){corner & 1, corner >> 1 & 1, corner >> 2 & 1});
    if (inside == 0 || inside == corners) return inside > 0;
    inside = 0;
    for (int n = 0; n < PLACES; n++) {
        double q[3];
        place_in_cell(p->dim, n, q);
        inside += is_inside(p, X, c, q);
    }
    return (double)inside / PLACES;
}

void mps__lattice_plan_volumes(const mps__lattice_plan *p, const double *lo, const double *hi,
                               double *built, double *asked)
{
    int64_t k[3] = {p->box.first[0], p->box.first[1], p->box.first[2]}, place = 0;
    *built = *asked = 0;
    do {
        const int state = p->state[place++];
        double X[3] = {0, 0, 0};
        if (state > POINT_CHOSEN) continue;
        const cell c = cell_of(p, k);
        mps__lattice_point(p, k, X);
        if (!p->inside)
            *asked += in_box(p, X, &c, lo, hi);
        else if (at_the_end(p, k, state))
            *asked += c.volume * share_inside(p, X, &c);
        else
            *asked += state == POINT_CHOSEN ? c.volume : 0;
        if (state == POINT_CHOSEN) *built += c.volume * (1 - 0.5 * c.free_ends);
    } while (mps__lattice_plan_next(p, k));
}

/* ---- beside solids of any shape ---- */

/* A point is farther from solids than any position in its cell, walls included [dp]. */
static const double far_off = 2.0;

/* Sample points differ between cells: with the same ones a wall along cells would have the error of
 * a single cell. */
static int64_t first_place(const int64_t k[3])
{
    return PLACES * (k[0] + 31 * k[1] + 977 * k[2]);
}

/* Extent of a cell towards its neighbour [cells]. A lattice made from solids may end up to a
 * spacing before them. */
static double half_way(const mps__lattice_plan *p, const int64_t k[3], int axis, int end)
{
    const bool last = k[axis] == (end ? p->sim->lattice_cells[axis] : 0);
    return p->sim->lattice_of_solids && last ? 1.5 : 0.5;
}

double mps__lattice_plan_fraction(const mps__lattice_plan *p, const int64_t k[3], double least,
                                  double height)
{
    const double limit = (least + 1e-6) * p->sim->world.setup.dp;
    double X[3] = {0, 0, 0}, reach[3][2], size = 1;
    int there = 0;
    mps__lattice_point(p, k, X);
    if (mps__solid_clearance(p->sim, X) > far_off * p->sim->world.setup.dp) return 1;
    for (int d = 0; d < p->dim; d++) {
        for (int end = 0; end < 2; end++) reach[d][end] = half_way(p, k, d, end);
        if (d == 1 && height < 1) reach[d][1] = height - 0.5;
        size *= reach[d][0] + reach[d][1];
    }
    for (int n = 0; n < PLACES; n++) {
        double x[3] = {0, 0, 0}, q[3];
        place_in_cell(p->dim, first_place(k) + n, q);
        for (int d = 0; d < p->dim; d++)
            x[d] = X[d] + (q[d] * (reach[d][0] + reach[d][1]) - reach[d][0]) * p->box.h[d];
        there += mps__solid_clearance(p->sim, x) > limit;
    }
    return size * there / PLACES / height;
}

bool mps__lattice_plan_open(const mps__lattice_plan *p, const int64_t k[3], int state)
{
    double X[3] = {0, 0, 0};
    bool wall = false;
    if (state != POINT_SOLID) return state != POINT_FLUID;
    for (int d = 0; d < p->dim && !p->sim->lattice_of_solids; d++)
        wall = wall || k[d] <= 0 || k[d] >= p->sim->lattice_cells[d];
    mps__lattice_point(p, k, X);
    return !wall && mps__solid_covers(p->sim, X);
}

/* The cell of a point ends at walls of the lattice, including their half cells, and half-way to all
 * other points. */
static cell cell_to_walls(const mps__lattice_plan *p, const int64_t k[3])
{
    cell c = {.volume = 1};
    for (int d = 0; d < p->dim; d++) {
        for (int end = 0; end < 2; end++) {
            int64_t o[3] = {k[0], k[1], k[2]};
            o[d] += end ? 1 : -1;
            const int state = mps__lattice_plan_beside(p, k, d, end ? 1 : -1);
            c.reach[d][end] = half_way(p, k, d, end);
            if (!p->sim->lattice_of_solids && state == POINT_SOLID &&
                !mps__lattice_plan_open(p, o, state))
                c.reach[d][end] = 1;
        }
        c.volume *= (c.reach[d][0] + c.reach[d][1]) * p->box.h[d];
    }
    return c;
}

/* Part of a cell in the box lo..hi and outside of solids. */
static double out_of_solids(const mps__lattice_plan *p, const int64_t k[3], const cell *c,
                            const double *lo, const double *hi)
{
    double X[3] = {0, 0, 0};
    int there = 0;
    mps__lattice_point(p, k, X);
    if (mps__solid_clearance(p->sim, X) > far_off * p->sim->world.setup.dp)
        return in_box(p, X, c, lo, hi);
    for (int n = 0; n < PLACES; n++) {
        double x[3] = {0, 0, 0}, q[3];
        bool in = true;
        place_in_cell(p->dim, first_place(k) + n, q);
        for (int d = 0; d < p->dim; d++) {
            const double reach = c->reach[d][0] + c->reach[d][1];
            x[d] = X[d] + (q[d] * reach - c->reach[d][0]) * p->box.h[d];
            in = in && x[d] >= lo[d] && x[d] <= hi[d];
        }
        there += in && mps__solid_clearance(p->sim, x) > 0;
    }
    return c->volume * there / PLACES;
}

double mps__lattice_plan_liquid(const mps__lattice_plan *p, const double *lo, const double *hi)
{
    int64_t k[3] = {p->box.first[0], p->box.first[1], p->box.first[2]}, place = 0;
    double volume = 0;
    do {
        if (!mps__lattice_plan_open(p, k, p->state[place++])) continue;
        const cell c = cell_to_walls(p, k);
        volume += out_of_solids(p, k, &c, lo, hi);
    } while (mps__lattice_plan_next(p, k));
    return volume;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Fluid on the lattice of a tank. */
#include "lattice_plan.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Length of the groups in which points of a partial layer are chosen: holes one point wide would
 * not close, a bump some points wide levels out. */
enum { GROUP = 3 };

/* Position of a point in a layer: index in its line, and index of the line. */
static void place_in_layer(const mps__lattice_plan *p, const int64_t k[3], int axis, int64_t *along,
                           int64_t *line)
{
    const int a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
    *along = k[a] - p->box.first[a];
    *line = k[b] - p->box.first[b];
}

/* Groups are evenly spread: each line of groups carries the remainder over, adjacent lines have an
 * offset. */
static bool by_pattern(const mps__lattice_plan *p, const int64_t k[3], int axis, double share)
{
    static const double golden = 0.6180339887498949;
    int64_t along, line;
    place_in_layer(p, k, axis, &along, &line);
    const int64_t group = along / GROUP, row = line / GROUP;
    const double at = share * (double)group + golden * (double)row + 0.5;
    return floor(at) > floor(at - share);
}

/* Fraction of the points of its layers that a point represents: 1 inside the box. Beyond the sides
 * and the bottom of the box liquid does not pass solids; above the last whole layer it covers
 * them. */
static double wanted_share(const mps__lattice_plan *p, const int64_t k[3])
{
    double share = 1;
    for (int d = 0; d < p->dim; d++)
        for (int end = 0; end < 2; end++) {
            const double part = p->box.share[d][end];
            if (part == 0 || k[d] != (end ? p->box.last[d] : p->box.first[d])) continue;
            share *= part;
            if ((d != 1 || end == 0) &&
                mps__lattice_plan_beside(p, k, d, end ? -1 : 1) == POINT_SOLID)
                share = 0;
        }
    return share;
}

static bool in_layers(const mps__lattice_plan *p, const int64_t k[3])
{
    bool in = wanted_share(p, k) > 0;
    for (int d = 0; d < p->dim; d++)
        for (int end = 0; end < 2; end++) {
            const double part = p->box.share[d][end];
            if (part > 0 && k[d] == (end ? p->box.last[d] : p->box.first[d]))
                in = in && by_pattern(p, k, d, part);
        }
    return in;
}

/* Whether a point begins a group of a partial layer. */
static bool begins_group(const mps__lattice_plan *p, const int64_t k[3])
{
    for (int d = 0; d < p->dim; d++)
        for (int end = 0; end < 2; end++) {
            int64_t along, line;
            if (p->box.share[d][end] == 0 || k[d] != (end ? p->box.last[d] : p->box.first[d]))
                continue;
            place_in_layer(p, k, d, &along, &line);
            return along % GROUP == 0;
        }
    return false;
}

/* Points of partial layers: number that the volume requires, number chosen, and number of each
 * state that may change. */
typedef struct tally {
    double wanted;
    int64_t chosen, of[2];
} tally;

/* Whether a point of a partial layer may change: first points of groups, or all of them. */
static bool may_change(const mps__lattice_plan *p, const int64_t k[3], bool first)
{
    const double share = wanted_share(p, k);
    return share > 0 && share < 1 && (!first || begins_group(p, k));
}

static tally count_layers(const mps__lattice_plan *p, bool first)
{
    int64_t k[3] = {p->box.first[0], p->box.first[1], p->box.first[2]}, place = 0;
    tally t = {0};
    do {
        const int state = p->state[place++];
        if (state > POINT_CHOSEN || !may_change(p, k, false)) continue;
        t.wanted += wanted_share(p, k);
        t.chosen += state == POINT_CHOSEN;
        t.of[state] += may_change(p, k, first);
    } while (mps__lattice_plan_next(p, k));
    return t;
}

/* Groups do not give exactly the number of points that the volume requires: points, evenly spread,
 * are added or removed. */
static void meet_volume(mps__lattice_plan *p, bool first)
{
    const tally t = count_layers(p, first);
    const double lack = p->keeps ? p->wanted - (double)p->chosen : t.wanted - (double)t.chosen;
    const int from = lack > 0 ? POINT_FREE : POINT_CHOSEN;
    const int64_t all = t.of[from], change = all < llround(fabs(lack)) ? all : llround(fabs(lack));
    int64_t k[3] = {p->box.first[0], p->box.first[1], p->box.first[2]}, place = 0, n = 0;
    if (fabs(lack) < 0.5 + 1e-6 || all == 0 || change == 0) return;
    do {
        if (p->state[place] == from && may_change(p, k, first)) {
            if ((n + 1) * change / all > n * change / all) {
                p->state[place] = from == POINT_FREE ? POINT_CHOSEN : POINT_FREE;
                p->chosen += from == POINT_FREE ? 1 : -1;
            }
            n++;
        }
        place++;
    } while (mps__lattice_plan_next(p, k));
}

static bool fluid_choose(const mps__lattice_plan *p, const int64_t k[3])
{
    double X[3];
    if (!in_layers(p, k)) return false;
    if (!p->inside) return true;
    mps__lattice_point(p, k, X);
    return p->inside(p->user, X) != 0;
}

static void fluid_describe(const mps__lattice_plan *p, const int64_t k[3], mps__lattice_site *out)
{
    (void)k;
    out->kind = MPS_FLUID;
    out->phase = p->phase;
    out->part = -1;
}

/* ---- beside solids of any shape ---- */

/* Cells beside solids are cut, but points are either free or covered. A particle represents the
 * volume half a spacing or more from solids; this volume gives the number of points.
 * @param given  out: number of free ones */
static double points_wanted(const mps__lattice_plan *p, double *given)
{
    int64_t k[3] = {p->box.first[0], p->box.first[1], p->box.first[2]}, place = 0;
    double wanted = 0;
    *given = 0;
    do {
        const int state = p->state[place++];
        const double share = wanted_share(p, k);
        if (share == 0 || !mps__lattice_plan_open(p, k, state)) continue;
        if (state != POINT_SOLID) *given += share;
        wanted += share * mps__lattice_plan_fraction(p, k, 0.5, share);
    } while (mps__lattice_plan_next(p, k));
    return wanted;
}

/* Free points of the uppermost layer. */
static int64_t points_on_top(const mps__lattice_plan *p, int64_t layer)
{
    int64_t k[3] = {p->box.first[0], p->box.first[1], p->box.first[2]}, place = 0, n = 0;
    do n += p->state[place++] <= POINT_CHOSEN && k[1] == layer;
    while (mps__lattice_plan_next(p, k));
    return n;
}

/* The uppermost layers compensate the surplus or deficit of cells beside solids. */
static mps_status level_out(mps__lattice_plan *p)
{
    mps__lattice_box *box = &p->box;
    double given, lack;
    MPS__TRY(mps__lattice_plan_choose(p));
    p->wanted = points_wanted(p, &given);
    lack = p->wanted - given;
    for (int64_t layer = box->last[1]; fabs(lack) > 0.5 && layer >= box->first[1]; layer--) {
        const double part = box->share[1][1] > 0 ? box->share[1][1] : 1;
        const double all = (double)points_on_top(p, layer), here = part * all + lack;
        box->share[1][1] = 0;
        box->last[1] = layer;
        if (here > all && layer < p->sim->lattice_cells[1] - 1) {
            box->last[1]++;
            box->share[1][1] = fmin(1, here / fmax(all, 1) - 1);
        } else if (here > 0.5) {
            box->share[1][1] = here < all ? here / all : 0;
        } else if (layer > box->first[1]) {
            box->last[1]--;
        } else { /* less than half of a particle in total: a layer remains, and may be empty */
            box->share[1][1] = 1e-6;
        }
        lack = here > 0.5 ? 0 : here;
    }
    mps__free(&p->sim->context, p->state);
    p->state = NULL;
    p->keeps = true;
    return MPS_OK;
}

static mps_status fluid_run(mps__lattice_plan *p, bool keeps)
{
    MPS__TRY(mps__packing_make(&p->packing, p->sim));
    if (keeps && p->sim->solids > 0) MPS__TRY(level_out(p));
    MPS__TRY(mps__lattice_plan_choose(p));
    meet_volume(p, true);
    meet_volume(p, false);
    MPS__CHECK(&p->sim->context, p->chosen > 0,
               "nothing to fill: no free lattice point lies inside (%lld are taken)",
               (long long)p->taken);
    return mps__lattice_plan_build(p);
}

/* Fraction of the free points of a layer that were chosen; other partial layers do not count. */
static double built_share(const mps__lattice_plan *p, int axis, int end)
{
    const double part = p->box.share[axis][end];
    int64_t k[3] = {p->box.first[0], p->box.first[1], p->box.first[2]}, place = 0, chosen = 0,
            left = 0;
    do {
        const int state = p->state[place++];
        if (k[axis] != (end ? p->box.last[axis] : p->box.first[axis])) continue;
        if (state > POINT_CHOSEN || wanted_share(p, k) != part) continue;
        chosen += state == POINT_CHOSEN;
        left += state == POINT_FREE;
    } while (mps__lattice_plan_next(p, k));
    return chosen > 0 ? (double)chosen / (double)(chosen + left) : 0;
}

/* Record the layers at the ends of the box; one without points is removed. */
static void note_layers(const mps__lattice_plan *p, mps__lattice_box *box)
{
    for (int d = 0; d < p->dim; d++)
        for (int end = 0; end < 2; end++) {
            if (p->box.share[d][end] == 0) continue;
            box->share[d][end] = built_share(p, d, end);
            if (box->share[d][end] > 0) continue;
            if (end)
                box->last[d]--;
            else
                box->first[d]++;
        }
}

/* Inside partial layers the liquid has no gaps, so that only their points count. */
static void report_volume(const mps__lattice_plan *p, const double *lo, const double *hi)
{
    double built, asked, cell = 1;
    for (int d = 0; d < p->dim; d++) cell *= p->box.h[d];
    mps__lattice_plan_volumes(p, lo, hi, &built, &asked);
    const tally t = count_layers(p, false);
    if (p->keeps) asked = mps__lattice_plan_liquid(p, lo, hi);
    if (p->keeps)
        built = asked + ((double)p->chosen - p->wanted) * cell;
    else if (t.wanted > 0)
        built = asked + ((double)t.chosen - t.wanted) * cell;
    const double error = asked > 0 ? built / asked - 1 : 0;
    mps__log(&p->sim->context, MPS_LOG_INFO,
             "fill of phase %d: %.6g m%d of %.6g m%d requested, %+.2g %%%s", (int)p->phase, built,
             (int)p->dim, asked, (int)p->dim, 100 * error,
             lo && !p->keeps && fabs(error) > 0.002 ? "; mps_fill_level_add() keeps the volume"
                                                    : "");
}

mps_status mps__geometry_fill(mps_sim *sim, const mps__fill *fill, mps__lattice_box *box,
                              int64_t *added)
{
    mps__lattice_plan p;
    MPS__TRY(mps__slots_log(sim));
    mps__lattice_plan_init(&p, sim, box);
    p.choose = fluid_choose;
    p.describe = fluid_describe;
    p.phase = fill->phase;
    p.inside = fill->inside;
    p.user = fill->user;
    mps_status status = fluid_run(&p, fill->keeps);
    if (status == MPS_OK) report_volume(&p, fill->lo, fill->hi);
    if (status == MPS_OK && !p.keeps) note_layers(&p, box);
    mps__lattice_plan_free(&p);
    if (status == MPS_OK && added) *added = p.chosen;
    return status;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Tanks and baffles. */
#include "geometry.h"
#include "lattice_plan.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

mps_status mps__fill_allowed(mps_sim *sim)
{
    const int32_t open = mps__particles_leases(&sim->world.particles);
    if (open > 0)
        return mps__fail(&sim->context, MPS_E_BUSY,
                         "%d leases are open: give them back before adding particles", (int)open);
    return MPS_OK;
}

mps_status mps__solids_allowed(mps_sim *sim)
{
    MPS__TRY(mps__fill_allowed(sim));
    if (sim->world.state.step > 0)
        return mps__fail(&sim->context, MPS_E_STATE,
                         "solids are added before the first step; %lld steps were taken",
                         (long long)sim->world.state.step);
    return MPS_OK;
}

mps_status mps__place_resolved(mps_sim *sim, const char *what, int d, double place)
{
    MPS__CHECK(&sim->context, fabs(place) <= MPS__FARTHEST * sim->world.setup.dp,
               "%s[%d] puts solids at %g m: places must be within %g m, %g spacings, of the origin",
               what, d, place, MPS__FARTHEST * sim->world.setup.dp, MPS__FARTHEST);
    return MPS_OK;
}

mps_status mps__in_the_way(mps_sim *sim, int64_t i, const double *X, const char *what,
                           const char *name)
{
    return mps__fail(&sim->context, MPS_E_ARG,
                     "fluid particle %lld at (%g, %g, %g) m is in the way of %s \"%s\": add solids "
                     "before the fill, or keep fluid half a "
                     "spacing, %g m, away from their particles",
                     (long long)sim->world.particles.id[i], X[0], X[1],
                     sim->world.setup.dim == 3 ? X[2] : 0, what, name, 0.5 * sim->world.setup.dp);
}

/* ---- solids ---- */

/* Whether a position is nearer than half a spacing, along every axis, to the points of the box, and
 * for a tank not inside it. */
static bool in_solid(const mps__lattice_plan *p, const double *X)
{
    const double half = 0.5 - 1e-6;
    bool inside = p->of_tank;
    for (int d = 0; d < p->dim; d++) {
        const double q = (X[d] - p->box.lo[d]) / p->box.h[d];
        if (q <= (double)p->box.first[d] - half || q >= (double)p->box.last[d] + half) return false;
        inside = inside && q >= (double)p->first[d] + half &&
                 (q <= (double)p->last[d] - half || (d == 1 && p->open_top));
    }
    return !inside;
}

static mps_status check_fluid(const mps__lattice_plan *p, const char *what, const char *name)
{
    const mps__world *w = &p->sim->world;
    for (int64_t i = 0; i < w->particles.n; i++) {
        double X[3];
        if (w->particles.kind[i] != MPS_FLUID) continue;
        mps__motion_to_tank(&w->motion, &w->motion.now, w->particles.x + i * p->dim, X);
        if (in_solid(p, X)) return mps__in_the_way(p->sim, i, X, what, name);
    }
    return MPS_OK;
}

/* Trapezoidal rule over the face across axis `a`: a cell for every other axis, half a cell at the
 * ends of the face. A box one point thick counts as a cell. */
static double face_weight(const mps__lattice_plan *p, const int64_t k[3], int a)
{
    double weight = 1;
    for (int d = 0; d < p->dim; d++)
        if (d != a) {
            bool end = k[d] == p->first[d] || k[d] == p->last[d];
            weight *= p->box.h[d] * (end && p->first[d] < p->last[d] ? 0.5 : 1.0);
        }
    return weight;
}

/* Part of the first face, in the order y0 y1 x0 x1 z0 z1, on or behind which a point is. */
static int32_t tank_part(const mps__lattice_plan *p, const int64_t k[3])
{
    static const int order[3] = {1, 0, 2};
    for (int o = 0; o < p->dim; o++) {
        int d = order[o];
        if (k[d] <= p->first[d]) return p->part[2 * d];
        if (k[d] >= p->last[d] && !(d == 1 && p->open_top)) return p->part[2 * d + 1];
    }
    return -1;
}

static bool tank_choose(const mps__lattice_plan *p, const int64_t k[3])
{
    return tank_part(p, k) >= 0;
}

static void tank_describe(const mps__lattice_plan *p, const int64_t k[3], mps__lattice_site *out)
{
    out->part = tank_part(p, k);
    out->kind = MPS_WALL;
    for (int d = 0; d < p->dim; d++)
        if (k[d] < p->first[d] || k[d] > p->last[d]) out->kind = MPS_DUMMY;
    if (out->kind == MPS_DUMMY) return;
    for (int d = 0; d < p->dim; d++) {
        if (k[d] == p->first[d]) out->area[d] = face_weight(p, k, d);
        if (k[d] == p->last[d] && !(d == 1 && p->open_top)) out->area[d] = -face_weight(p, k, d);
    }
}

static bool choose_all(const mps__lattice_plan *p, const int64_t k[3])
{
    (void)p;
    (void)k;
    return true;
}

static void baffle_describe(const mps__lattice_plan *p, const int64_t k[3], mps__lattice_site *out)
{
    out->part = p->part[0];
    out->kind = MPS_DUMMY;
    for (int d = 0; d < p->dim; d++) {
        if (k[d] != p->first[d] && k[d] != p->last[d]) continue;
        out->kind = MPS_WALL;
        /* both faces of a box one point thick cancel */
        if (k[d] == p->first[d]) out->area[d] -= face_weight(p, k, d);
        if (k[d] == p->last[d]) out->area[d] += face_weight(p, k, d);
    }
}

/* Part numbers of the tank's faces; on failure the caller removes the new names. */
static mps_status face_parts(mps__lattice_plan *p, const char *name)
{
    static const char *const face[6] = {"x0", "x1", "y0", "y1", "z0", "z1"};
    for (int f = 0; f < 2 * p->dim; f++) {
        char full[MPS__PART_NAME + 8];
        if (f == 3 && p->open_top) continue;
        snprintf(full, sizeof full, "%s.%s", name, face[f]);
        p->part[f] = mps__part_number(&p->sim->world.particles, full, true);
        MPS__CHECK(&p->sim->context, p->part[f] >= 0, "part \"%s\" is one too many: at most %d",
                   full, MPS__PARTS_MAX);
    }
    return MPS_OK;
}

static mps_status tank_run(mps__lattice_plan *p, const char *name)
{
    MPS__TRY(check_fluid(p, "tank", name));
    MPS__TRY(face_parts(p, name));
    MPS__TRY(mps__lattice_plan_choose(p));
    MPS__CHECK(&p->sim->context, p->taken == 0,
               "tank \"%s\" would stand on %lld particles that are there already", name,
               (long long)p->taken);
    return mps__lattice_plan_build(p);
}

mps_status mps__geometry_tank(mps_sim *sim, const mps_tank *tank, const mps__tank_lattice *lattice)
{
    mps__lattice_plan p;
    mps__lattice_box box = {.lo = {0}};
    for (int d = 0; d < sim->world.setup.dim; d++) {
        box.lo[d] = tank->lo[d];
        box.h[d] = lattice->h[d];
        box.first[d] = -tank->dummy_layers;
        box.last[d] = lattice->cells[d] + (d == 1 && tank->open_top ? 0 : tank->dummy_layers);
    }
    mps__lattice_plan_init(&p, sim, &box);
    p.choose = tank_choose;
    p.describe = tank_describe;
    p.open_top = tank->open_top != 0;
    p.of_tank = true;
    memcpy(p.last, lattice->cells, sizeof p.last);
    int32_t parts = sim->world.particles.parts;
    mps_status status = tank_run(&p, tank->name);
    mps__lattice_plan_free(&p);
    if (status < 0) {
        sim->world.particles.parts = parts;
        return status;
    }
    sim->has_tank = true;
    sim->lattice_of_solids = false;
    mps__world_note_layers(&sim->world, tank->dummy_layers);
    memcpy(sim->lattice_lo, box.lo, sizeof sim->lattice_lo);
    memcpy(sim->lattice_h, lattice->h, sizeof sim->lattice_h);
    memcpy(sim->lattice_cells, lattice->cells, sizeof sim->lattice_cells);
    mps__world_spacing(&sim->world, lattice->dp);
    return MPS_OK;
}

static mps_status baffle_run(mps__lattice_plan *p, const char *name)
{
    mps__context *c = &p->sim->context;
    MPS__TRY(check_fluid(p, "baffle", name));
    p->part[0] = mps__part_number(&p->sim->world.particles, name, true);
    MPS__CHECK(c, p->part[0] >= 0, "part \"%s\" is one too many: at most %d", name, MPS__PARTS_MAX);
    MPS__TRY(mps__lattice_plan_choose(p));
    MPS__CHECK(c, p->chosen > 0,
               "all %lld lattice points of baffle \"%s\" are taken by other particles",
               (long long)p->taken, name);
    return mps__lattice_plan_build(p);
}

mps_status mps__geometry_baffle(mps_sim *sim, const char *name, const mps__lattice_box *box)
{
    mps__lattice_plan p;
    mps__plate_shape shape;
    if (mps__plate_of_box(sim, box, &shape)) return mps__geometry_plate(sim, name, &shape);
    mps__lattice_plan_init(&p, sim, box);
    p.choose = choose_all;
    p.describe = baffle_describe;
    memcpy(p.first, box->first, sizeof p.first);
    memcpy(p.last, box->last, sizeof p.last);
    int32_t parts = sim->world.particles.parts;
    mps_status status = baffle_run(&p, name);
    mps__lattice_plan_free(&p);
    if (status < 0) sim->world.particles.parts = parts;
    return status;
}

bool mps__lattice_clip(const mps_sim *sim, const double *lo, const double *hi,
                       mps__lattice_box *box)
{
    memset(box, 0, sizeof *box);
    for (int d = 0; d < sim->world.setup.dim; d++) {
        /* a point outside by rounding only counts as inside */
        double first = ceil((lo[d] - sim->lattice_lo[d]) / sim->lattice_h[d] - 1e-6),
               last = floor((hi[d] - sim->lattice_lo[d]) / sim->lattice_h[d] + 1e-6);
        double end = (double)sim->lattice_cells[d];
        if (first > end || last < 0 || first > last) return false;
        box->lo[d] = sim->lattice_lo[d];
        box->h[d] = sim->lattice_h[d];
        box->first[d] = first > 0 ? (int64_t)first : 0;
        box->last[d] = last < end ? (int64_t)last : sim->lattice_cells[d];
    }
    return true;
}

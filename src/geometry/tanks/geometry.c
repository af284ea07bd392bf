/* SPDX-License-Identifier: BSD-3-Clause */
/* Tanks, baffles and fills: choose lattice points that are free, then append them all at once. */
#include "geometry.h"
#include "packing.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { POINT_FREE = 0, POINT_TAKEN = 1, POINT_CHOSEN = 2 };

/* What becomes of one lattice point. */
typedef struct site {
    int32_t kind, phase, part;
    double area[3];
} site;

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
    /* [dp]: rounding is then below the millionth of a spacing by which lattice points are told
     * apart */
    static const double most = 1e9;
    MPS__CHECK(&sim->context, fabs(place) <= most * sim->world.setup.dp,
               "%s[%d] puts solids at %g m: places must be within %g m, %g spacings, of the origin",
               what, d, place, most * sim->world.setup.dp, most);
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

/* One call's work: which points, what they become, and what was there before. */
typedef struct plan {
    mps_sim *sim;
    mps__lattice_box box;
    int32_t dim;
    unsigned char *state; /* POINT_... of every lattice point of the box, x fastest */
    bool (*choose)(const struct plan *p, const int64_t k[3]);
    void (*describe)(const struct plan *p, const int64_t k[3], site *out);
    int64_t taken, chosen;
    /* of solids: the box whose ends are faces, and the part of each end */
    int64_t first[3], last[3];
    int32_t part[6]; /* x0 x1 y0 y1 z0 z1 */
    bool open_top, of_tank;
    /* of fluid */
    int32_t phase;
    mps_inside_fn inside;
    void *user;
    mps__packing packing; /* beside solids of any shape */
} plan;

static void plan_init(plan *p, mps_sim *sim, const mps__lattice_box *box)
{
    *p = (plan){.sim = sim, .box = *box, .dim = sim->world.setup.dim};
}

static int64_t plan_points(const plan *p)
{
    int64_t n = 1;
    for (int d = 0; d < 3; d++) n *= p->box.last[d] - p->box.first[d] + 1;
    return n;
}

static bool plan_next(const plan *p, int64_t k[3])
{
    for (int d = 0; d < 3; d++) {
        if (++k[d] <= p->box.last[d]) return true;
        k[d] = p->box.first[d];
    }
    return false;
}

static void lattice_point(const plan *p, const int64_t k[3], double X[3])
{
    for (int d = 0; d < p->dim; d++) X[d] = p->box.lo[d] + (double)k[d] * p->sim->world.setup.dp;
}

/* Place in `state` of the lattice point that a particle at X occupies, i.e. nearer than dp/2; -1: none. */
static int64_t occupied(const plan *p, const double *X)
{
    int64_t place = 0, stride = 1;
    double distance2 = 0;
    for (int d = 0; d < p->dim; d++) {
        double q = (X[d] - p->box.lo[d]) / p->sim->world.setup.dp, nearest = round(q);
        if (nearest < (double)p->box.first[d] || nearest > (double)p->box.last[d]) return -1;
        distance2 += (q - nearest) * (q - nearest);
        place += ((int64_t)nearest - p->box.first[d]) * stride;
        stride *= p->box.last[d] - p->box.first[d] + 1;
    }
    return distance2 < 0.25 * (1 - 1e-9) ? place : -1;
}

static void mark_taken(plan *p)
{
    const mps__particles *s = &p->sim->world.particles;
    const mps__motion *m = &p->sim->world.motion;
    for (int64_t i = 0; i < s->n; i++) {
        double X[3];
        if (mps__is_shadow(s, i)) continue;
        mps__motion_to_tank(m, &m->now, &s->x[i * p->dim], X);
        int64_t place = occupied(p, X);
        if (place >= 0) p->state[place] = POINT_TAKEN;
    }
}

/* Points that would press against a plate which is not on the lattice. */
static void mark_plates(plan *p)
{
    static const double least = 0.7; /* [dp] */
    const mps__screens *s = &p->sim->world.lists.screens;
    int64_t k[3] = {p->box.first[0], p->box.first[1], p->box.first[2]}, place = 0;
    bool any = false;
    for (int32_t m = 0; m < s->count; m++) any = any || s->list[m].axis < 0;
    if (!any) return;
    do {
        double X[3] = {0, 0, 0};
        lattice_point(p, k, X);
        for (int32_t m = 0; m < s->count; m++)
            if (s->list[m].axis < 0 &&
                mps__screen_distance(&s->list[m], X) < least * p->sim->world.setup.dp)
                p->state[place] = POINT_TAKEN;
        place++;
    } while (plan_next(p, k));
}

/* Points in a solid or nearer than half a cell to its surface. */
static void mark_solids(plan *p)
{
    int64_t k[3] = {p->box.first[0], p->box.first[1], p->box.first[2]}, place = 0;
    if (p->sim->solids == 0 || p->of_tank) return;
    do {
        double X[3] = {0, 0, 0};
        lattice_point(p, k, X);
        if (mps__solid_covers(p->sim, X)) p->state[place] = POINT_TAKEN;
        place++;
    } while (plan_next(p, k));
}

static void mark_chosen(plan *p)
{
    int64_t k[3] = {p->box.first[0], p->box.first[1], p->box.first[2]}, place = 0;
    p->taken = p->chosen = 0;
    do {
        if (p->state[place] == POINT_TAKEN) {
            /* only points the plan wants count as conflicts, and a user's `inside` is asked for free points alone */
            if (!p->inside) p->taken += p->choose(p, k);
        } else if (p->choose(p, k)) {
            p->state[place] = POINT_CHOSEN;
            p->chosen++;
        }
        place++;
    } while (plan_next(p, k));
}

static void place_particle(const plan *p, const int64_t k[3], int64_t i)
{
    mps__world *w = &p->sim->world;
    mps__particles *s = &w->particles;
    site here = {0};
    double X[3] = {0, 0, 0};
    p->describe(p, k, &here);
    lattice_point(p, k, X);
    mps__packing_place(&p->packing, k, X);
    /* solids stand still before the first step, so that they jump to their velocity in it */
    mps__motion_point(&w->motion, &w->motion.now, X, &s->x[i * p->dim], NULL, NULL);
    if (here.kind != MPS_FLUID) {
        memcpy(&s->ref[i * p->dim], X, (size_t)p->dim * sizeof(double));
        memcpy(&s->area[i * p->dim], here.area, (size_t)p->dim * sizeof(double));
    }
    s->kind[i] = here.kind;
    s->phase[i] = here.phase;
    s->part[i] = here.part;
    s->rho[i] = w->setup.phase_density[here.phase];
}

/* Decide for every lattice point of the box; the store is not touched. plan_free() afterwards in any case. */
static mps_status plan_choose(plan *p)
{
    p->state = mps__alloc(&p->sim->context, plan_points(p), 1);
    if (!p->state) return MPS_E_NOMEM;
    mark_taken(p);
    mark_plates(p);
    mark_solids(p);
    mark_chosen(p);
    return MPS_OK;
}

/* Append what was chosen: all or nothing. */
static mps_status plan_build(plan *p)
{
    mps__particles *s = &p->sim->world.particles;
    MPS__TRY(mps__particles_reserve(s, p->chosen));
    int64_t i = mps__particles_append(s, p->chosen), place = 0;
    int64_t k[3] = {p->box.first[0], p->box.first[1], p->box.first[2]};
    do
        if (p->state[place++] == POINT_CHOSEN) place_particle(p, k, i++);
    while (plan_next(p, k));
    p->sim->world.lists.neighbours.valid = false;
    return MPS_OK;
}

static void plan_free(plan *p)
{
    mps__free(&p->sim->context, p->state);
    mps__packing_free(&p->packing);
}

/* ---- solids ---- */

/* Whether a place lies nearer than half a spacing, along every axis, to the points of the box, and for a tank not in its inside. */
static bool in_solid(const plan *p, const double *X)
{
    const double half = 0.5 - 1e-6;
    bool inside = p->of_tank;
    for (int d = 0; d < p->dim; d++) {
        const double q = (X[d] - p->box.lo[d]) / p->sim->world.setup.dp;
        if (q <= (double)p->box.first[d] - half || q >= (double)p->box.last[d] + half) return false;
        inside = inside && q >= (double)p->first[d] + half &&
                 (q <= (double)p->last[d] - half || (d == 1 && p->open_top));
    }
    return !inside;
}

static mps_status check_fluid(const plan *p, const char *what, const char *name)
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

/* Trapezoid rule over the face across axis `a`: dp for every other axis, half of it at the face's ends. A box one
 * point thick stands for dp. */
static double face_weight(const plan *p, const int64_t k[3], int a)
{
    double weight = 1;
    for (int d = 0; d < p->dim; d++)
        if (d != a) {
            bool end = k[d] == p->first[d] || k[d] == p->last[d];
            weight *= p->sim->world.setup.dp * (end && p->first[d] < p->last[d] ? 0.5 : 1.0);
        }
    return weight;
}

/* Part of the first face, in the order y0 y1 x0 x1 z0 z1, on or behind which a point lies. */
static int32_t tank_part(const plan *p, const int64_t k[3])
{
    static const int order[3] = {1, 0, 2};
    for (int o = 0; o < p->dim; o++) {
        int d = order[o];
        if (k[d] <= p->first[d]) return p->part[2 * d];
        if (k[d] >= p->last[d] && !(d == 1 && p->open_top)) return p->part[2 * d + 1];
    }
    return -1;
}

static bool tank_choose(const plan *p, const int64_t k[3])
{
    return tank_part(p, k) >= 0;
}

static void tank_describe(const plan *p, const int64_t k[3], site *out)
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

static bool choose_all(const plan *p, const int64_t k[3])
{
    (void)p;
    (void)k;
    return true;
}

static void baffle_describe(const plan *p, const int64_t k[3], site *out)
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

/* Part numbers of the tank's faces; on failure the caller forgets the new names. */
static mps_status face_parts(plan *p, const char *name)
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

static mps_status tank_run(plan *p, const char *name)
{
    MPS__TRY(check_fluid(p, "tank", name));
    MPS__TRY(face_parts(p, name));
    MPS__TRY(plan_choose(p));
    MPS__CHECK(&p->sim->context, p->taken == 0,
               "tank \"%s\" would stand on %lld particles that are there already", name,
               (long long)p->taken);
    return plan_build(p);
}

mps_status mps__geometry_tank(mps_sim *sim, const mps_tank *tank, const int64_t cells[3])
{
    plan p;
    mps__lattice_box box = {.lo = {0}};
    for (int d = 0; d < sim->world.setup.dim; d++) {
        box.lo[d] = tank->lo[d];
        box.first[d] = -tank->dummy_layers;
        box.last[d] = cells[d] + (d == 1 && tank->open_top ? 0 : tank->dummy_layers);
    }
    plan_init(&p, sim, &box);
    p.choose = tank_choose;
    p.describe = tank_describe;
    p.open_top = tank->open_top != 0;
    p.of_tank = true;
    memcpy(p.last, cells, sizeof p.last);
    int32_t parts = sim->world.particles.parts;
    mps_status status = tank_run(&p, tank->name);
    plan_free(&p);
    if (status < 0) {
        sim->world.particles.parts = parts;
        return status;
    }
    sim->has_tank = true;
    sim->lattice_of_solids = false;
    mps__world_note_layers(&sim->world, tank->dummy_layers);
    memcpy(sim->lattice_lo, box.lo, sizeof sim->lattice_lo);
    memcpy(sim->lattice_cells, cells, sizeof sim->lattice_cells);
    return MPS_OK;
}

static mps_status baffle_run(plan *p, const char *name)
{
    mps__context *c = &p->sim->context;
    MPS__TRY(check_fluid(p, "baffle", name));
    p->part[0] = mps__part_number(&p->sim->world.particles, name, true);
    MPS__CHECK(c, p->part[0] >= 0, "part \"%s\" is one too many: at most %d", name, MPS__PARTS_MAX);
    MPS__TRY(plan_choose(p));
    MPS__CHECK(c, p->chosen > 0,
               "all %lld lattice points of baffle \"%s\" are taken by other particles",
               (long long)p->taken, name);
    return plan_build(p);
}

mps_status mps__geometry_baffle(mps_sim *sim, const char *name, const mps__lattice_box *box)
{
    plan p;
    mps__plate_shape shape;
    if (mps__plate_of_box(sim, box, &shape)) return mps__geometry_plate(sim, name, &shape);
    plan_init(&p, sim, box);
    p.choose = choose_all;
    p.describe = baffle_describe;
    memcpy(p.first, box->first, sizeof p.first);
    memcpy(p.last, box->last, sizeof p.last);
    int32_t parts = sim->world.particles.parts;
    mps_status status = baffle_run(&p, name);
    plan_free(&p);
    if (status < 0) sim->world.particles.parts = parts;
    return status;
}

/* ---- fluid ---- */

/* Points of the last row, evenly spread in groups: holes one point wide would not close, a bump some points wide levels out. Each line of
 * groups carries the remainder over, lines side by side begin elsewhere. */
static bool in_top_row(const plan *p, const int64_t k[3])
{
    enum { GROUP = 3 };
    static const double golden = 0.6180339887498949;
    const int64_t i = (k[0] - p->box.first[0]) / GROUP, j = (k[2] - p->box.first[2]) / GROUP;
    const double share = p->box.top, at = share * (double)i + golden * (double)j + 0.5;
    return share == 0 || k[1] < p->box.last[1] || floor(at) > floor(at - share);
}

static bool fluid_choose(const plan *p, const int64_t k[3])
{
    double X[3];
    if (!in_top_row(p, k)) return false;
    if (!p->inside) return true;
    lattice_point(p, k, X);
    return p->inside(p->user, X) != 0;
}

static void fluid_describe(const plan *p, const int64_t k[3], site *out)
{
    (void)k;
    out->kind = MPS_FLUID;
    out->phase = p->phase;
    out->part = -1;
}

static mps_status fluid_run(plan *p)
{
    MPS__TRY(mps__packing_make(&p->packing, p->sim));
    MPS__TRY(plan_choose(p));
    MPS__CHECK(&p->sim->context, p->chosen > 0,
               "nothing to fill: no free lattice point lies inside (%lld are taken)",
               (long long)p->taken);
    return plan_build(p);
}

/* Share of the free points of the last row that were chosen. */
static double top_share(const plan *p)
{
    int64_t k[3] = {p->box.first[0], p->box.first[1], p->box.first[2]}, place = 0, chosen = 0,
            left = 0;
    do {
        const int state = k[1] == p->box.last[1] ? p->state[place] : POINT_TAKEN;
        chosen += state == POINT_CHOSEN;
        left += state == POINT_FREE;
        place++;
    } while (plan_next(p, k));
    return chosen > 0 ? (double)chosen / (double)(chosen + left) : 0;
}

mps_status mps__geometry_fill(mps_sim *sim, int32_t phase, mps__lattice_box *box,
                              mps_inside_fn inside, void *user, int64_t *added)
{
    plan p;
    plan_init(&p, sim, box);
    p.choose = fluid_choose;
    p.describe = fluid_describe;
    p.phase = phase;
    p.inside = inside;
    p.user = user;
    mps_status status = fluid_run(&p);
    if (status == MPS_OK && box->top > 0) box->top = top_share(&p);
    if (p.box.top > 0 && box->top == 0) box->last[1]--;
    plan_free(&p);
    if (status == MPS_OK && added) *added = p.chosen;
    return status;
}

bool mps__lattice_clip(const mps_sim *sim, const double *lo, const double *hi,
                       mps__lattice_box *box)
{
    memset(box, 0, sizeof *box);
    for (int d = 0; d < sim->world.setup.dim; d++) {
        /* a point counts as inside when it is outside by rounding only */
        double first = ceil((lo[d] - sim->lattice_lo[d]) / sim->world.setup.dp - 1e-6),
               last = floor((hi[d] - sim->lattice_lo[d]) / sim->world.setup.dp + 1e-6);
        double end = (double)sim->lattice_cells[d];
        if (first > end || last < 0 || first > last) return false;
        box->lo[d] = sim->lattice_lo[d];
        box->first[d] = first > 0 ? (int64_t)first : 0;
        box->last[d] = last < end ? (int64_t)last : sim->lattice_cells[d];
    }
    return true;
}

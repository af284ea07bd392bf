/* SPDX-License-Identifier: BSD-3-Clause */
/* Add a solid: distances on the lattice, contour, wall particles and dummies; finally append all
 * particles at once. */
#include "solid.h"
#include "geometry.h"
#include "sampling.h"
#include <math.h>
#include <mps/numbers.h>
#include <string.h>

/* Distance from the surface within which no fluid is placed: the wall's half cell [dp]. */
static const double half_cell = 0.5;
/* Relative difference allowed between the number of wall particles and surface/dp^(dim-1). */
static const double uneven = 0.1;

/* Data of one call. */
typedef struct work {
    mps_sim *sim;
    const mps__solid *solid;
    mps__shape shape;
    mps__mesh mesh; /* of a solid defined by `inside` alone */
    mps__contour_box box;
    mps__distances distances;
    mps__contour contour;
    mps__buckets others;
    mps__samples samples;
    double around_lo[3], around_hi[3]; /* of all new particles */
    bool new_lattice;
} work;

static void work_free(work *w)
{
    mps__context *c = &w->sim->context;
    mps__mesh_free(&w->mesh);
    mps__distances_free(&w->distances, c);
    mps__contour_free(&w->contour, c);
    mps__buckets_free(&w->others);
    mps__samples_free(&w->samples);
}

static double clearance(const mps_sim *sim, const double *X,
                        bool (*at)(const mps__distances *f, const double x[3], double *value))
{
    bool within = !sim->lattice_of_solids;
    double least = INFINITY, r;
    for (int32_t k = 0; k < sim->solids; k++)
        if (at(&sim->solid[k], X, &r)) {
            least = fmin(least, r);
            within = true;
        }
    return within ? least : -INFINITY;
}

double mps__solid_clearance(const mps_sim *sim, const double *X)
{
    return clearance(sim, X, mps__distances_sharp);
}

bool mps__solid_covers(const mps_sim *sim, const double *X)
{
    return clearance(sim, X, mps__distances_at) < (half_cell + 1e-6) * sim->world.setup.dp;
}

/* ---- the box and existing particles ---- */

/* Nothing is kept in the plane of an open side and beyond. */
static void leave_open(mps__contour_box *b, int32_t side, double dp)
{
    const int d = (side - MPS_SIDE_X0) / 2;
    if (side == MPS_SIDE_NONE) return;
    if ((side - MPS_SIDE_X0) % 2)
        b->keep_hi[d] = fmin(b->keep_hi[d], b->hi[d] - half_cell * dp);
    else
        b->keep_lo[d] = fmax(b->keep_lo[d], b->lo[d] + half_cell * dp);
}

/* The lattice point at or below lo, and the region to keep: with a tank, the region between its
 * walls. */
static void make_box(work *w)
{
    mps_sim *sim = w->sim;
    const double dp = sim->world.setup.dp, margin = (w->solid->layers + 2) * dp;
    mps__contour_box *b = &w->box;
    memcpy(b->lo, w->solid->lo, sizeof b->lo);
    memcpy(b->hi, w->solid->hi, sizeof b->hi);
    for (int d = 0; d < sim->world.setup.dim; d++) {
        const double origin = sim->has_tank ? sim->lattice_lo[d] : b->lo[d],
                     h = sim->has_tank ? sim->lattice_h[d] : dp;
        const bool tank = sim->has_tank && !sim->lattice_of_solids;
        b->anchor[d] = origin + h * floor((b->lo[d] - origin) / h + 1e-6);
        b->keep_lo[d] = tank ? origin - 1e-6 * dp : -INFINITY;
        b->keep_hi[d] = tank ? origin + ((double)sim->lattice_cells[d] + 1e-6) * h : INFINITY;
        w->around_lo[d] = b->anchor[d] - margin;
        w->around_hi[d] = b->hi[d] + margin;
    }
    w->new_lattice = !sim->has_tank;
    leave_open(b, w->solid->open, dp);
}

/* Reject positions whose lattice indices overflow, or that are not distinguishable. */
static mps_status check_box(const work *w)
{
    const double dp = w->sim->world.setup.dp;
    for (int d = 0; d < w->sim->world.setup.dim; d++)
        MPS__CHECK(&w->sim->context,
                   w->box.hi[d] >= w->box.anchor[d] &&
                       isfinite((w->around_hi[d] - w->around_lo[d]) / dp),
                   "the solid's box is %g .. %g m along axis %d: too far away for lattice points "
                   "of spacing %g m",
                   w->box.lo[d], w->box.hi[d], d, dp);
    return MPS_OK;
}

/* Solid particles near the new one, in the tank frame. */
static mps_status collect_others(work *w)
{
    const mps__particles *s = &w->sim->world.particles;
    const int dim = w->sim->world.setup.dim;
    MPS__TRY(mps__buckets_init(&w->others, &w->sim->context, dim, w->around_lo, w->around_hi,
                               w->sim->world.setup.dp));
    for (int64_t i = 0; i < s->n; i++) {
        double x[3] = {0, 0, 0};
        bool near = s->kind[i] != MPS_FLUID && !mps__is_shadow(s, i);
        memcpy(x, s->ref + i * dim, (size_t)dim * sizeof *x);
        for (int d = 0; d < dim; d++)
            near = near && x[d] > w->around_lo[d] && x[d] < w->around_hi[d];
        if (near) MPS__TRY(mps__buckets_add(&w->others, x));
    }
    return MPS_OK;
}

/* ---- the surface ---- */

/* A solid defined by `inside` alone gets a mesh, from which distances are measured. */
static mps_status find_shape(work *w)
{
    w->shape = w->solid->shape;
    if (!w->shape.inside || w->shape.mesh) return MPS_OK;
    mps__mesh_init(&w->mesh, &w->sim->context, w->shape.dim);
    /* the surface may end at a tank's walls, but distances are needed beyond them: extend the
     * search */
    mps__contour_box box = w->box;
    for (int d = 0; d < w->shape.dim; d++) {
        box.anchor[d] = w->around_lo[d];
        box.lo[d] = w->around_lo[d];
        box.hi[d] = w->around_hi[d];
    }
    MPS__TRY(mps__contour_mesh(&w->shape, &box, &w->mesh));
    w->shape.mesh = &w->mesh;
    return MPS_OK;
}

static mps_status no_surface(const work *w)
{
    const mps__solid *s = w->solid;
    double centre[3] = {0, 0, 0};
    for (int d = 0; d < w->shape.dim; d++) centre[d] = 0.5 * (s->lo[d] + s->hi[d]);
    return mps__fail(
        &w->sim->context, MPS_E_ARG,
        "solid \"%s\" has no surface in its box (%g, %g, %g) .. (%g, %g, %g) m that could be seen "
        "with a spacing of %g m: %s",
        s->name, s->lo[0], s->lo[1], s->lo[2], s->hi[0], s->hi[1], s->hi[2], w->sim->world.setup.dp,
        mps__shape_at(&s->shape, centre) > 0 ? "nothing is solid" : "everything is solid");
}

static mps_status find_surface(work *w)
{
    mps__context *c = &w->sim->context;
    MPS__TRY(find_shape(w));
    if (w->shape.inside && w->mesh.elements == 0) return no_surface(w);
    MPS__TRY(mps__distances_make(&w->distances, c, &w->shape, w->around_lo, w->around_hi));
    if (w->shape.mesh) w->shape.known = &w->distances;
    MPS__TRY(mps__contour_find(&w->contour, c, &w->shape, &w->box));
    const double *at = w->contour.open_at;
    MPS__CHECK(
        c, !w->contour.open,
        "the surface of solid \"%s\" leaves its box at (%g, %g, %g) m: the box must contain it",
        w->solid->name, at[0], at[1], at[2]);
    return w->contour.patches == 0 ? no_surface(w) : MPS_OK;
}

/* ---- the particles ---- */

/* Fluid inside the solid is an error. */
static mps_status check_fluid(const work *w)
{
    const mps__world *world = &w->sim->world;
    const mps__particles *s = &world->particles;
    for (int64_t i = 0; i < s->n; i++) {
        double X[3] = {0, 0, 0}, r;
        if (s->kind[i] != MPS_FLUID) continue;
        mps__motion_to_tank(&world->motion, &world->motion.now, s->x + i * world->setup.dim, X);
        if (mps__distances_at(&w->distances, X, &r) && r < 0.3 * world->setup.dp)
            return mps__in_the_way(w->sim, i, X, "solid", w->solid->name);
    }
    return MPS_OK;
}

static mps_status sample(work *w)
{
    mps__samples *s = &w->samples;
    *s = (mps__samples){.context = &w->sim->context,
                        .shape = &w->shape,
                        .contour = &w->contour,
                        .others = &w->others};
    memcpy(s->keep_lo, w->box.keep_lo, sizeof s->keep_lo);
    memcpy(s->keep_hi, w->box.keep_hi, sizeof s->keep_hi);
    MPS__TRY(mps__samples_walls(s, w->around_lo, w->around_hi));
    MPS__CHECK(&w->sim->context, s->wall.count > 0,
               "all of the surface of solid \"%s\" lies at or behind walls that are there already",
               w->solid->name);
    return mps__samples_dummies(s, w->solid->layers, &w->distances);
}

/* Walls of other solids inside the new solid are no longer wetted. */
static void cover_walls(const work *w)
{
    mps__particles *s = &w->sim->world.particles;
    for (int64_t i = 0; i < s->n; i++) {
        double X[3] = {0, 0, 0}, r;
        if (s->kind[i] != MPS_WALL) continue;
        memcpy(X, s->ref + i * s->dim, (size_t)s->dim * sizeof *X);
        if (mps__distances_at(&w->distances, X, &r) && r < -half_cell * w->sim->world.setup.dp)
            s->kind[i] = MPS_DUMMY;
    }
}

static void append(const work *w, const mps__buckets *from, int32_t kind, int32_t part)
{
    mps__world *world = &w->sim->world;
    mps__particles *s = &world->particles;
    const size_t bytes = (size_t)s->dim * sizeof(double);
    int64_t i = mps__particles_append(s, from->count, kind);
    for (int64_t k = 0; k < from->count; k++, i++) {
        const double *X = from->x + 3 * k;
        mps__motion_point(&world->motion, &world->motion.now, X, s->x + i * s->dim, NULL, NULL);
        memcpy(s->ref + i * s->dim, X, bytes);
        if (kind == MPS_WALL) memcpy(s->area + i * s->dim, w->samples.area + 3 * k, bytes);
        s->part[i] = part;
        s->rho[i] = world->setup.phase_density[0];
    }
}

/* Whole cells across the box of the first solid along both horizontal axes, so that liquid fills it
 * evenly from wall to wall; their height gives them the volume of a particle. */
static void fit_cells(const work *w, double *h)
{
    const double dp = w->sim->world.setup.dp;
    const int dim = w->sim->world.setup.dim;
    h[0] = h[1] = h[2] = dp;
    for (int d = 0; d < dim; d += 2) {
        const double length = w->box.hi[d] - w->box.anchor[d], cells = round(length / dp);
        if (cells >= 1 && fabs(length - cells * dp) > 1e-6 * dp) h[d] = length / cells;
    }
    h[1] = dp * (dp / h[0]) * (dp / h[2]);
}

/* The lattice of fills: that of the first solid, extended by each further one. The lattice of a
 * tank is not changed. */
static void extend_lattice(work *w)
{
    mps_sim *sim = w->sim;
    double *h = sim->lattice_h;
    if (sim->has_tank && !sim->lattice_of_solids) return;
    if (w->new_lattice) fit_cells(w, h);
    for (int d = 0; d < sim->world.setup.dim; d++) {
        const double hi = sim->lattice_lo[d] + (double)sim->lattice_cells[d] * h[d],
                     end = w->box.hi[d];
        if (w->new_lattice || w->box.anchor[d] < sim->lattice_lo[d])
            sim->lattice_lo[d] = w->box.anchor[d];
        sim->lattice_cells[d] = (int64_t)floor(
            ((w->new_lattice ? end : fmax(end, hi)) - sim->lattice_lo[d]) / h[d] + 1e-6);
    }
    sim->has_tank = sim->lattice_of_solids = true;
}

/* Number of wall particles for the surface [dp^(dim-1)]: of a file that of its triangles; triangles
 * nearer to each other than the cells of the contour may be missing in the contour. */
static double wanted_walls(const work *w)
{
    const mps__samples *s = &w->samples;
    const mps__contour_box *b = &w->box;
    const double cell = mps_pow(w->shape.dp, w->shape.dim - 1);
    bool whole = w->solid->shape.mesh != NULL && s->wanted * cell > (1 - 1e-6) * s->surface;
    for (int d = 0; d < w->shape.dim; d++)
        whole = whole && b->lo[d] > b->keep_lo[d] && b->hi[d] < b->keep_hi[d];
    return whole ? mps__mesh_area(w->solid->shape.mesh) / cell : s->wanted;
}

static void report_count(const work *w)
{
    const double wanted = wanted_walls(w), count = (double)w->samples.wall.count;
    if (fabs(count - wanted) <= fmax(uneven * wanted, 2)) return;
    mps__log(&w->sim->context, MPS_LOG_WARNING,
             "solid \"%s\" has %.0f wall particles where its surface has %.0f dp%s: its parts that "
             "are thinner or closer to each other than dp are not resolved, and pressures beside "
             "them are wrong; take a smaller dp or leave them out",
             w->solid->name, count, wanted, w->shape.dim == 3 ? "2" : "");
}

static void report(const work *w)
{
    const mps__samples *s = &w->samples;
    mps__context *c = &w->sim->context;
    mps__log(c, MPS_LOG_INFO, "solid \"%s\": surface %g m%s, %lld wall particles, %lld dummies",
             w->solid->name, s->surface, w->shape.dim == 3 ? "2" : "", (long long)s->wall.count,
             (long long)s->dummy.count);
    if (s->thin > 0)
        mps__log(c, MPS_LOG_WARNING,
                 "solid \"%s\" is thinner than 3 dp = %g m at %lld wall particles, first at (%g, "
                 "%g, %g) m: liquid on one side feels the other",
                 w->solid->name, 3 * w->shape.dp, (long long)s->thin, s->thin_at[0], s->thin_at[1],
                 s->thin_at[2]);
    report_count(w);
}

static mps_status build(work *w)
{
    mps_sim *sim = w->sim;
    mps__particles *s = &sim->world.particles;
    make_box(w);
    MPS__TRY(check_box(w));
    MPS__TRY(collect_others(w));
    MPS__TRY(find_surface(w));
    MPS__TRY(check_fluid(w));
    MPS__TRY(sample(w));
    MPS__TRY(mps__grow(&sim->context, (void **)&sim->solid, &sim->solid_capacity, sim->solids,
                       sim->solids + 1, sizeof *sim->solid));
    MPS__TRY(mps__particles_reserve(s, w->samples.wall.count + w->samples.dummy.count));
    const int32_t part = mps__part_number(s, w->solid->name, true);
    MPS__CHECK(&sim->context, part >= 0, "part \"%s\" is one too many: at most %d", w->solid->name,
               MPS__PARTS_MAX);
    /* nothing can fail from here on */
    cover_walls(w);
    append(w, &w->samples.wall, MPS_WALL, part);
    append(w, &w->samples.dummy, MPS_DUMMY, part);
    extend_lattice(w);
    sim->solid[sim->solids++] = w->distances;
    w->distances.value = NULL;
    sim->world.lists.neighbours.valid = false;
    mps__world_note_layers(&sim->world, w->solid->layers);
    report(w);
    return MPS_OK;
}

mps_status mps__solid_add(mps_sim *sim, const mps__solid *solid)
{
    work w = {.sim = sim, .solid = solid};
    const mps_status status = build(&w);
    work_free(&w);
    return status;
}

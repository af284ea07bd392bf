/* SPDX-License-Identifier: BSD-3-Clause */
/* Distance of each particle from an interface between two densities. It determines the density of
 * pairs across the interface such that fluid at rest stays at rest,
 *   rho_ij = (f_i rho_i + f_j rho_j)/(f_i + f_j),  f_i, f_j the distances,
 * the mean along the line between both (mps_pair_density()). With (rho_i + rho_j)/2 the pairs of a
 * particle give the same pressure only if the interface is half-way along each of them; otherwise
 * fluid at rest is set in motion. W22: Wen, Zhao & Wan 2022. */
#include "helpers.h"

enum { LEAST, FLAT, FOOT, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [LEAST] = {"least", "dp", "Smallest distance from the interface", MPS_TYPE_REAL, 0.1, 0.01,
               0.5},
    [FLAT] = {"flat", "-", "Smallest alignment of pairs that makes a plane", MPS_TYPE_REAL, 0.5,
              0.0, 0.99},
    [FOOT] = {"foot", "-", "1: the plane is a mean about its point nearest to the particle",
              MPS_TYPE_FLAG, 0.0, 0.0, 1.0}};

/* Number of times the plane is determined at the foot, each time at the foot on the previous
 * plane. */
static const int FEET = 2;

/* Width of the range above `flat` in which the distance changes from half a spacing to that of the
 * plane. */
static const double BLEND = 0.2;

static const mps_channel channels[] = {
    {.name = "interface_distance",
     .unit = "m",
     .help = "Distance from an interface between two densities; 0: not known",
     .components = 1,
     .type = MPS_TYPE_REAL,
     .life = MPS_LIFE_STEP,
     .initial = 0.0}};

enum { DENSITY, REGION, PRESSURE_DENSITY, INTERFACE_DISTANCE, USES };
static const mps_use uses[USES] = {
    [DENSITY] = {"density", MPS_USE_ROWS},
    [REGION] = {"region", MPS_USE_ROWS},
    [PRESSURE_DENSITY] = {"pressure_density", MPS_USE_NEIGHBOURS | MPS_USE_CHANGE},
    [INTERFACE_DISTANCE] = {"interface_distance", MPS_USE_CHANGE}};

typedef struct fields {
    const double *density;
    const int32_t *region;
    double *pressure_density, *distance;
    int32_t *heavy; /* [n] 1: a near neighbour is lighter */
    double *rho;    /* [n] new "pressure_density" */
} fields;

/* Weighted sums over pairs across an interface. */
typedef struct crossing {
    double centre[3];          /* of the window, less x_i */
    double weight;             /* sum of the weights */
    double middle[3];          /* of the midpoints of the pairs, less x_i */
    double toward[3], length;  /* of the vectors to the lighter particle; of their lengths */
    double heaviest, lightest; /* largest and smallest density */
} crossing;

static inline bool in_fluid(const mps_view *v, const fields *f, int64_t i)
{
    return mps_is_fluid(v, i) && mps_region_of(f->region, i) < MPS_REGION_SPRAY;
}

/* Marks fluid with lighter fluid among its near neighbours. */
MPS_ROW void find_heavy(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    (void)dim;
    const mps_stencil *t = &v->near;
    bool found = false;
    if (!in_fluid(v, f, i)) return;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i) && !found; p++)
        found = in_fluid(v, f, mps_stencil_column(t, p)) &&
                f->density[mps_stencil_column(t, p)] < f->density[i];
    f->heavy[i] = found;
}
MPS_ROWS(find_heavy_rows, find_heavy, fields)

/* True if particle i has a near neighbour of another density. */
MPS_ROW bool at_interface(const mps_view *v, const fields *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    const double *rho = f->pressure_density;
    bool found = false;
    if (mps_region_of(f->region, i) >= MPS_REGION_SPRAY) return false;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i) && !found; p++)
        found = mps_region_of(f->region, mps_stencil_column(t, p)) < MPS_REGION_SPRAY &&
                rho[mps_stencil_column(t, p)] != rho[i];
    return found;
}

/* Adds the pairs of particle j with lighter fluid. at: x_j - x_i. */
MPS_ROW void add_pairs(const int dim, const mps_view *v, const fields *f, int64_t j,
                       const double *at, double reach, crossing *c)
{
    const mps_stencil *t = &v->near;
    for (int64_t p = mps_stencil_begin(t, j); p < mps_stencil_end(t, j); p++) {
        if (!in_fluid(v, f, mps_stencil_column(t, p)) ||
            f->density[mps_stencil_column(t, p)] >= f->density[j])
            continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, j, p);
        double middle[3] = {0}, r2 = 0;
        for (int d = 0; d < dim; d++) {
            middle[d] = at[d] + 0.5 * q.d[d];
            r2 += (middle[d] - c->centre[d]) * (middle[d] - c->centre[d]);
        }
        if (r2 >= reach * reach) continue;
        const double near = 1.0 - sqrt(r2) / reach, w = near * near * q.w;
        c->weight += w;
        c->length += w * q.r;
        c->heaviest = mps_larger(c->heaviest, f->density[j]);
        c->lightest = mps_smaller(c->lightest, f->density[q.j]);
        for (int d = 0; d < dim; d++) {
            c->middle[d] += w * middle[d];
            c->toward[d] += w * q.d[d];
        }
    }
}

/* Sums over all pairs in the window. */
MPS_ROW void collect(const int dim, const mps_view *v, const fields *f, int64_t i, crossing *c)
{
    static const double here[3] = {0};
    const mps_stencil *t = &v->far;
    const double reach = t->re - 0.5 * v->dp;
    if (f->heavy[i]) add_pairs(dim, v, f, i, here, reach, c);
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (f->heavy[j]) add_pairs(dim, v, f, j, mps_stencil_pair_dim(dim, t, i, p).d, reach, c);
    }
}

/* A plane from the sums. */
typedef struct plane {
    double normal[3]; /* toward the lighter side */
    double height;    /* of i above the plane */
    double aligned;   /* |sum r_ij|/sum |r_ij|; 0: no plane */
} plane;

MPS_ROW plane plane_of(const int dim, const crossing *c)
{
    plane o = {.normal = {0}};
    double size = 0, height = 0;
    for (int d = 0; d < dim; d++) {
        size += c->toward[d] * c->toward[d];
        height += c->middle[d] * c->toward[d];
    }
    if (!(size > 0)) return o;
    size = sqrt(size);
    o.height = height / (c->weight * size);
    o.aligned = size / c->length;
    for (int d = 0; d < dim; d++) o.normal[d] = c->toward[d] / size;
    return o;
}

/* Distance of i from the interface. Sets *rho, its "pressure_density", if i is solid.
 *
 * Near a particle the interface is a plane. Its normal is the mean direction of the pairs across
 * the interface, from heavy to light; it passes through the mean of their midpoints. Both means
 * cover the far radius less half a spacing, so that they do not depend on the lattice. Their window
 * is centred at the particle, or with `foot` at the foot of its perpendicular on the plane. Centred
 * at the particle, the two sides of the interface weight the same pairs differently and get
 * different planes: the densities of pairs then belong to no single plane and set fluid at rest in
 * motion. Centred at the foot, all particles above one point get one plane.
 *  - A particle on the wrong side of its plane has the distance `least`.
 *  - Pairs in all directions (droplets and threads of a few particles, |sum r_ij|/sum |r_ij| below
 *    `flat`): all distances are half a spacing, which gives (rho_i + rho_j)/2, W22 (17).
 *  - A solid particle takes the density of the side of the plane on which it is. */
MPS_ROW double distance_of(const int dim, const mps_view *v, const fields *f, int64_t i,
                           double *rho)
{
    const double *k = v->setting, unknown = 0.5 * v->dp;
    crossing c = {.lightest = INFINITY};
    collect(dim, v, f, i, &c);
    plane found = plane_of(dim, &c);
    for (int foot = 0; k[FOOT] > 0 && foot < FEET && found.aligned > 0; foot++) {
        crossing about = {.lightest = INFINITY};
        for (int d = 0; d < dim; d++) about.centre[d] = found.height * found.normal[d];
        collect(dim, v, f, i, &about);
        const plane next = plane_of(dim, &about);
        if (!(next.aligned > 0)) break;
        found = next;
        c = about;
    }
    if (!(found.aligned > 0)) return unknown;
    double height = found.height;
    const double trust = mps_smaller(1.0, mps_larger(0.0, (found.aligned - k[FLAT]) / BLEND));
    if (!mps_is_fluid(v, i) && trust > 0.5) *rho = height > 0 ? c.heaviest : c.lightest;
    if (*rho < c.heaviest) height = -height;
    return mps_larger(k[LEAST] * v->dp, trust * height + (1.0 - trust) * unknown);
}

MPS_ROW void find_distance(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    double rho = f->pressure_density[i];
    if (at_interface(v, f, i)) f->distance[i] = distance_of(dim, v, f, i, &rho);
    f->rho[i] = rho;
}
MPS_ROWS(find_distance_rows, find_distance, fields)

MPS_ROW void keep_density(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    (void)dim, (void)v;
    f->pressure_density[i] = f->rho[i];
}
MPS_ROWS(keep_density_rows, keep_density, fields)

static int find_distances(mps_stage *s)
{
    fields f = {.density = s->data[DENSITY],
                .region = s->data[REGION],
                .pressure_density = s->data[PRESSURE_DENSITY],
                .distance = s->data[INTERFACE_DISTANCE],
                .heavy = mps_stage_scratch_integers(s, s->view->n),
                .rho = mps_stage_scratch(s, s->view->n)};
    if (!f.heavy || !f.rho) return 1;
    mps_stage_rows(s, &find_heavy_rows, &f);
    if (mps_stage_refresh(s, 1, &(mps_shared){f.heavy, 1, MPS_TYPE_INTEGER})) return 1;
    mps_stage_rows(s, &find_distance_rows, &f);
    mps_stage_rows(s, &keep_density_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_PREPARE, .use_count = USES, .uses = uses, .run = find_distances, .device = 1}};

const mps_model_ops mps__density_interface = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "density.interface",
    .help = "Distances from interfaces, for the densities of pairs across them",
    .setting_count = SETTINGS,
    .settings = settings,
    .channel_count = 1,
    .channels = channels,
    .verb_count = 1,
    .verbs = verbs};

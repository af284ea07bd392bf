/* SPDX-License-Identifier: BSD-3-Clause */
/* Wall pressure by action and reaction: the load of a wall is the pressure that the fluid beside it
 * received.
 *
 * The row of a wall requires the pressure that stops all fluid within its radius in one step, at
 * any distance from the wall. The gradient gives a particle only the weight W/r^2 of the pair, so
 * that the particle continues to move and the row requires the same pressure again: for one layer
 * of particles at 1, 1.5 and 1.9 dp the impulse of these pressures is 2, 9 and 140 times the
 * momentum. So p_i is right for the equation and wrong as a load.
 *
 *   P_i = p' + sum_j c_ij e_j,   c_ij = s_j V D/(n0 A_i) w_ij n.B_j r_ij
 *
 * over the fluid j around wall i, r_ij = x_j - x_i, w = W/r^2, n the normal, A_i the area,
 * V = dp^D. p'_j = p_j - rho b.r_ij is the pressure of j extrapolated to the wall, p' its kernel
 * mean. c_ij is the fraction of the face that belongs to j. On a lattice these fractions add up to
 * 1 with s_j = 2 inside the fluid, where the other half of B_j belongs to the layer behind, and
 * s_j = 1 on the surface. e_j is the pressure rise from p'_j to the wall: inside the fluid
 * e_j = rho (a_j + b).r_ij, with the acceleration a_j due to all pressures; on the surface, where
 * only the wall acts, e_j = p_i - p'_j. For linear pressures P_i is p_i. */
#include "helpers.h"

/* Another wall is beside a wall up to this squared distance [dp2], and in its plane up to this
 * height [dp]; liquid is in front of it from this height on [dp]. */
static const double BESIDE = 1.5, PLANE = 0.3, BEFORE = 0.1;

enum { COVER, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [COVER] = {"cover", "-", "1: the mean pressure acts on the share of a face below liquid alone",
               MPS_TYPE_FLAG, 1.0, 0.0, 1.0}};

enum { PRESSURE, ACCELERATION, REGION, CORRECTION, CONDITION, VALUE, WALL_PRESSURE, USES };
static const mps_use uses[USES] = {[PRESSURE] = {"pressure", MPS_USE_NEIGHBOURS},
                                   [ACCELERATION] = {"acceleration", MPS_USE_NEIGHBOURS},
                                   [REGION] = {"region", MPS_USE_NEIGHBOURS},
                                   [CORRECTION] = {"correction", MPS_USE_NEIGHBOURS},
                                   [CONDITION] = {"pressure_condition", MPS_USE_READ},
                                   [VALUE] = {"pressure_value", MPS_USE_READ},
                                   [WALL_PRESSURE] = {"wall_pressure", MPS_USE_WRITE}};

typedef struct fields {
    const double *p, *a, *correction, *value;
    const int32_t *region, *condition;
    double *wall_pressure;
} fields;

/* Sums over the fluid around a wall particle. */
typedef struct contact {
    double weight, p, rise, least, pull; /* sum W, sum W p'_j, A_i sum c_ij e_j, least, pull */
} contact;

/* Unit normal of a wall particle. @return its area; 0: too small for a face, e.g. the edge of a
 * plate */
MPS_ROW double face(const int dim, const mps_view *v, int64_t i, double n[3])
{
    double size = 0;
    for (int d = 0; d < dim; d++) size += v->area[i * dim + d] * v->area[i * dim + d];
    size = sqrt(size);
    for (int d = 0; d < dim; d++) n[d] = size > 0 ? v->area[i * dim + d] / size : 0;
    return size > 1e-4 * (dim == 2 ? v->dp : v->dp * v->dp) ? size : 0;
}

MPS_ROW contact sum_contact(const int dim, const mps_view *v, const fields *f, int64_t i,
                            const double n[3])
{
    const mps_stencil *t = &v->near;
    const double cell = (dim == 2 ? v->dp * v->dp : v->dp * v->dp * v->dp) * dim / t->n0;
    contact c = {0};
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (!mps_is_fluid(v, j) || mps_region_of(f->region, j) >= MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        const double *b = f->correction + j * dim * dim, rho = mps_flux_density(&v->flux, i, j);
        const double body = mps_flux_body(&v->flux, dim, i, j, q.d);
        double slope = 0, push = 0;
        for (int d = 0; d < dim; d++) {
            slope += f->a[j * dim + d] * q.d[d];
            for (int e = 0; e < dim; e++) push += n[d] * b[d * dim + e] * q.d[e];
        }
        const double carried = f->p[j] - rho * body;
        const int32_t region = mps_region_of(f->region, j);
        const bool surface = region == MPS_REGION_SURFACE;
        c.weight += q.w;
        c.p += q.w * carried;
        if (region >= MPS_REGION_NEAR && f->p[j] >= 0) c.least = mps_smaller(c.least, carried);
        c.pull = mps_smaller(c.pull, f->p[j]);
        c.rise += cell * q.w_r2 * push * (surface ? f->p[i] - carried : 2.0 * rho * (slope + body));
    }
    return c;
}

/* A neighbour of a wall, relative to its face: height above it, displacement s along it, and
 * s^2. */
typedef struct foot {
    double height, s[3], square;
} foot;

MPS_ROW foot find_foot(const int dim, const mps_pair *q, const double n[3])
{
    foot at = {0};
    for (int d = 0; d < dim; d++) at.height += q->d[d] * n[d];
    for (int d = 0; d < dim; d++) {
        at.s[d] = q->d[d] - at.height * n[d];
        at.square += at.s[d] * at.s[d];
    }
    return at;
}

/* Nearest liquid along the face of wall i. On an edge or in a corner, where an adjacent wall is not
 * in the plane of its face, liquid at s = 0. */
MPS_ROW foot nearest_foot(const int dim, const mps_view *v, const fields *f, int64_t i,
                          const double n[3])
{
    const mps_stencil *t = &v->near;
    foot nearest = {.square = INFINITY};
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        const foot at = find_foot(dim, &q, n);
        const double square = at.square + at.height * at.height, dp2 = v->dp * v->dp;
        if (mps_is_wall(v, q.j) && square < BESIDE * dp2 && fabs(at.height) > PLANE * v->dp)
            return (foot){0};
        if (!mps_is_fluid(v, q.j) || mps_region_of(f->region, q.j) >= MPS_REGION_SPRAY) continue;
        if (at.height > BEFORE * v->dp && at.square < nearest.square) nearest = at;
    }
    return nearest;
}

/* Fraction of the face of wall i below liquid. All of it, if liquid or a wetted wall is on both
 * sides; at the edge of the liquid the part below the cell of the nearest particle along the face,
 * 1 - |s|/dp. The other side counts fully up to |s| = dp, and less beyond that up to the radius,
 * where layers are stretched.
 *
 * cover: p' does not depend on where along a face the liquid is. On all faces within the radius,
 * three times the width of a wave toe of two layers, it would give twice the momentum that the
 * fluid loses. So p' acts on the fraction of a face below liquid, covered_share(), and the pressure
 * of the void on the rest: 0, or that of trapped gas (gas.pocket), which is contained in the lower
 * bound. With `cover` 0 p' acts on the whole face. */
MPS_ROW double covered_share(const int dim, const mps_view *v, const fields *f, int64_t i,
                             const double n[3])
{
    const mps_stencil *t = &v->near;
    const foot nearest = nearest_foot(dim, v, f, i, n);
    const double near = sqrt(nearest.square);
    double across = 0;
    if (!(near > 0) || near > t->re) return near > 0 ? 0 : 1;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        if (mps_region_of(f->region, mps_stencil_column(t, p)) >= MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        const foot at = find_foot(dim, &q, n);
        double along = 0;
        for (int d = 0; d < dim; d++) along -= at.s[d] * nearest.s[d];
        if (along <= 0 || at.height <= BEFORE * v->dp) continue;
        const double far = sqrt(at.square), full = (t->re - far) / (t->re - v->dp);
        across = mps_larger(across, along / (near * far) * mps_smaller(1, full));
    }
    return mps_smaller(1, mps_larger(0, 1 - near / v->dp) + across);
}

/* The suction of a load is at most that of the equation: a wall from which the liquid separates
 * (separation.void) has none.
 *
 * Above the contact line no liquid touches the wall, but the equation continues the static pressure
 * of the liquid to it, in calm water down to -2 rho g dp. The load contains only the suction beyond
 * that, or the suction in the fluid around it: P_i < 0 becomes
 *
 *   max(P_i, min(P_i - least, pull)),   least = min(0, min_j p'_j),   pull = min(0, min_j p_j),
 *
 * least over the fluid j around the wall that is on the surface or next to it and has no suction,
 * p_j >= 0. So the load of a dry wall is 0.
 *
 * Where void reaches the wall (separation.void: it has a lower bound p_i >= value_i), liquid does
 * not adhere to it at any pressure: droplets and liquid in the angle between two walls are not
 * always detected as surface, and have suction. There pull is no lower than the suction of the wall
 * itself beyond that bound, min(0, p_i - value_i). For a velocity jump, which has no lower bounds,
 * the suction stays. The flow does not change. */
MPS_ROW double pressure_of(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    double n[3];
    const double size = face(dim, v, i, n);
    contact c = sum_contact(dim, v, f, i, n);
    if (c.weight == 0) return f->p[i];
    const bool bounded = f->condition[i] >= MPS_ROW_LEAST;
    const double share = v->setting[COVER] > 0 && size > 0 ? covered_share(dim, v, f, i, n) : 1.0;
    const double rest = bounded && share < 1 ? (1 - share) * mps_larger(0, f->value[i]) : 0;
    if (bounded) c.pull = mps_larger(c.pull, mps_smaller(0, f->p[i] - f->value[i]));
    const double shown = mps_larger(share * c.p / c.weight + rest + (size > 0 ? c.rise / size : 0),
                                    mps_smaller(f->p[i], 0));
    return mps_larger(shown, mps_smaller(shown - c.least, c.pull));
}

MPS_ROW void load_row(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    if (!mps_is_wall(v, i) || mps_region_of(f->region, i) == MPS_REGION_DRY) return;
    f->wall_pressure[i] = pressure_of(dim, v, f, i);
}
MPS_ROWS(load_rows, load_row, fields)

static int load_walls(mps_stage *s)
{
    fields f = {.p = s->data[PRESSURE],
                .a = s->data[ACCELERATION],
                .correction = s->data[CORRECTION],
                .condition = s->data[CONDITION],
                .value = s->data[VALUE],
                .region = s->data[REGION],
                .wall_pressure = s->data[WALL_PRESSURE]};
    mps_stage_rows(s, &load_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_LOAD, .use_count = USES, .uses = uses, .run = load_walls, .device = 1}};

const mps_model_ops mps__load_reaction = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "load.reaction",
    .help = "Pressure on walls as the reaction to what the fluid beside them received",
    .setting_count = SETTINGS,
    .settings = settings,
    .verb_count = 1,
    .verbs = verbs};

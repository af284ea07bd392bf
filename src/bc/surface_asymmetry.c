/* SPDX-License-Identifier: BSD-3-Clause */
/* Free surface by number density n and asymmetry A, W22 (11)(12), Z14 (16)(17); W22: Wen, Zhao &
 * Wan 2022, Z14: Zhang, Wan & Hino 2014. With |A|0 the asymmetry of the surface layer of a lattice,
 * a particle is on the surface if one of these holds:
 *
 *   n < lone n0
 *   n < low n0   and  |A| > low_share |A|0
 *   n < high n0  and  |A| > share |A|0
 *   |A|/|A|0 > film n/n0
 *
 * Particles with too little fluid around them are spray. The papers test wall particles too
 * (walls = 1): dry walls have p = 0.
 *
 * The kernel of the layer below the surface extends beyond the surface, where there are no
 * particles: its pairs with the surface also carry that flux (complete = 1). */
#include "helpers.h"

enum {
    LOW,
    HIGH,
    SHARE,
    SPRAY,
    WALLS,
    COMPLETE,
    LONE,
    LOW_SHARE,
    CONTACT,
    CONTACT_LOW,
    CONTACT_SHARE,
    FILM,
    SETTINGS
};
static const mps_setting settings[SETTINGS] = {
    [LOW] = {"low", "n0", "On the surface: n below this and asymmetry above low_share",
             MPS_TYPE_REAL, 0.8, 0.0, 1.0},
    [HIGH] = {"high", "n0", "On the surface: n below this and asymmetry above share", MPS_TYPE_REAL,
              0.97, 0.5, 1.0},
    [SHARE] = {"share", "-", "Asymmetry that goes with high, relative to that of a flat surface",
               MPS_TYPE_REAL, 0.9, 0.0, 2.0},
    [SPRAY] = {"spray", "n0", "Spray: kernel sum over the fluid below this", MPS_TYPE_REAL, 0.25,
               0.0, 1.0},
    [WALLS] = {"walls", "-", "1: wall particles can be on the surface too", MPS_TYPE_FLAG, 0.0, 0.0,
               1.0},
    [COMPLETE] = {"complete", "-",
                  "1: pairs with the surface carry the flux that the surface cuts off",
                  MPS_TYPE_FLAG, 1.0, 0.0, 1.0},
    [LONE] = {"lone", "n0", "On the surface: n below this, at any asymmetry", MPS_TYPE_REAL, 0.6,
              0.0, 1.0},
    [LOW_SHARE] = {"low_share", "-",
                   "Asymmetry that goes with low, relative to that of a flat surface",
                   MPS_TYPE_REAL, 0.4, 0.0, 2.0},
    [CONTACT] = {"contact", "-", "1: other limits where the surface meets a wall", MPS_TYPE_FLAG,
                 1.0, 0.0, 1.0},
    [CONTACT_LOW] = {"contact_low", "n0", "Value of low where the surface meets a wall",
                     MPS_TYPE_REAL, 0.95, 0.0, 1.0},
    [CONTACT_SHARE] = {"contact_share", "-", "Value of low_share where the surface meets a wall",
                       MPS_TYPE_REAL, 0.55, 0.0, 2.0},
    [FILM] = {"film", "-", "On the surface: asymmetry over n/n0 above this (film of one row)",
              MPS_TYPE_REAL, 1.1, 0.0, 100.0}};

enum { NUMBER_DENSITY, ASYMMETRY, REGION, COMPLETE_SURFACE, USES };
static const mps_use uses[USES] = {[NUMBER_DENSITY] = {"number_density", MPS_USE_READ},
                                   [ASYMMETRY] = {"asymmetry", MPS_USE_READ},
                                   [REGION] = {"region", MPS_USE_NEIGHBOURS | MPS_USE_CHANGE},
                                   [COMPLETE_SURFACE] = {"equation_complete", MPS_USE_WRITE}};

typedef struct fields {
    const double *number_density, *asymmetry;
    int32_t *region;
    int32_t *member, *mark; /* [n] fluid of region `from`; particles found by a pass */
    int32_t from, to;
    double a0; /* |A|0 */
} fields;

/* |A| of a particle in the top layer of a lattice that fills the half space below it. */
static double lattice_asymmetry(const mps_stencil *t)
{
    const int reach = (int)(t->re / t->dp) + 1, across = t->dim == 3 ? reach : 0;
    double sum = 0;
    for (int k = -across; k <= across; k++)
        for (int j = -reach; j < 0; j++)
            for (int i = -reach; i <= reach; i++) {
                const double r = t->dp * sqrt((double)(i * i + j * j + k * k));
                if (r < t->re) sum -= j * t->dp / r * mps_kernel_weight(&t->kernel, r, t->re);
            }
    return t->dim * sum / t->n0;
}

/* Surface test by n/n0 and |A|/|A|0.
 *
 * The papers have lone = low: n < low n0 alone. In violent flow, inner particles fall below low n0
 * too, and p = 0 within high pressure tears the fluid; so some asymmetry is required as well. The
 * last condition detects films of one layer on a wall. Their n is n0 or more, because the wall is
 * near, but they are more asymmetric than any surface. As inner particles they would respond to
 * their own pressure with the wrong sign. The factor n excludes compressed particles, which are
 * asymmetric too and must keep their pressure. */
static inline bool on_surface(const double *k, double n, double a)
{
    return n < k[LONE] || (n < k[LOW] && a > k[LOW_SHARE]) || (n < k[HIGH] && a > k[SHARE]) ||
           a > k[FILM] * n;
}

/* Whether the kernel sum over the fluid, with or without spray, is less than `enough`. */
MPS_ROW bool detached(const int dim, const mps_view *v, const int32_t *region, int64_t i,
                      bool with_spray, double enough)
{
    const mps_stencil *t = &v->near;
    double sum = 0;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i) && sum < enough; p++)
        if (mps_is_fluid(v, mps_stencil_column(t, p)) &&
            (with_spray || mps_region_of(region, mps_stencil_column(t, p)) != MPS_REGION_SPRAY))
            sum += mps_stencil_pair_dim(dim, t, i, p).w;
    return sum < enough;
}

/* |A|/|A|0 */
MPS_ROW double asymmetry_of(const int dim, const fields *f, int64_t i)
{
    double a = 0;
    for (int d = 0; d < dim; d++) a += f->asymmetry[i * dim + d] * f->asymmetry[i * dim + d];
    return sqrt(a) / f->a0;
}

/* ---- surface and spray by the sums of each particle ------------------------------------------ */

MPS_ROW void own_row(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    const double *k = v->setting, n0 = v->near.n0;
    if (!mps_is_fluid(v, i) && !(mps_is_wall(v, i) && k[WALLS] > 0)) return;
    const double a = asymmetry_of(dim, f, i);
    const double n = f->number_density[i] / n0;
    if (mps_is_fluid(v, i) && detached(dim, v, f->region, i, true, k[SPRAY] * n0))
        f->region[i] = MPS_REGION_SPRAY;
    else if (on_surface(k, n, a))
        f->region[i] = MPS_REGION_SURFACE;
}
MPS_ROWS(own_rows, own_row, fields)

/* ---- particles beside others: each checks its neighbours ------------------------------------- */

MPS_ROW void from_row(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    (void)dim;
    f->member[i] = mps_region_of(f->region, i) == f->from && mps_is_fluid(v, i);
}
MPS_ROWS(from_rows, from_row, fields)

/* Whether an inner fluid particle has a near neighbour in the fluid of region `from`. */
MPS_ROW bool inner_beside(const mps_view *v, const fields *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    const int32_t *const member = f->member, *const j = t->col;
    int64_t p = mps_stencil_begin(t, i), end = mps_stencil_end(t, i);
    int32_t any = 0;
    if (!mps_is_fluid(v, i) || mps_region_of(f->region, i) != MPS_REGION_INNER) return false;
    for (; p + 4 <= end && !any; p += 4) /* most particles find none */
        any = member[j[p]] | member[j[p + 1]] | member[j[p + 2]] | member[j[p + 3]];
    for (; p < end && !any; p++) any = member[j[p]];
    return any != 0;
}

MPS_ROW void surface_row(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    (void)dim, (void)v;
    if (f->mark[i]) f->region[i] = MPS_REGION_SURFACE;
}
MPS_ROWS(surface_rows, surface_row, fields)

MPS_ROW void spread_row(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    (void)dim;
    if (inner_beside(v, f, i)) f->region[i] = f->to;
}
MPS_ROWS(spread_rows, spread_row, fields)

/* Halo exchange of the regions, or of the members. */
static int refresh(mps_stage *s, int32_t *values)
{
    return mps_stage_refresh(s, 1, &(mps_shared){values, 1, MPS_TYPE_INTEGER});
}

/* Inner fluid particles with a near neighbour of region `from` become `to`. */
static int spread(mps_stage *s, fields *f, int32_t from, int32_t to)
{
    f->from = from;
    f->to = to;
    mps_stage_rows(s, &from_rows, f);
    if (refresh(s, f->member)) return 1;
    mps_stage_rows(s, &spread_rows, f);
    return 0;
}

/* n/n0 and |A|/|A|0 of a particle without spray: no pressure acts on spray, so that it counts as
 * void for its neighbours. */
MPS_ROW void without_spray(const int dim, const mps_view *v, const fields *f, int64_t i, double *n,
                           double *a)
{
    const mps_stencil *t = &v->near;
    double sum = f->number_density[i], left[3], square = 0;
    for (int d = 0; d < dim; d++) left[d] = f->asymmetry[i * dim + d];
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        if (mps_region_of(f->region, mps_stencil_column(t, p)) != MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        sum -= q.w;
        for (int d = 0; d < dim; d++) left[d] += dim / t->n0 * q.w * q.d[d] / q.r;
    }
    for (int d = 0; d < dim; d++) square += left[d] * left[d];
    *n = sum / t->n0;
    *a = sqrt(square) / f->a0;
}

/* Whether an inner particle beside spray is on the surface, or one of the last of its volume of
 * fluid. Fluid within spray has p = 0: one or two particles that exchange pressure only with the
 * walls of a corner would take up all the momentum from these walls. */
MPS_ROW bool beside_spray(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    const double *k = v->setting;
    double n, a;
    if (!inner_beside(v, f, i)) return false;
    if (detached(dim, v, f->region, i, false, k[SPRAY] * v->near.n0)) return true;
    without_spray(dim, v, f, i, &n, &a);
    return on_surface(k, n, a);
}

MPS_ROW void beside_spray_row(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    f->mark[i] = beside_spray(dim, v, f, i);
}
MPS_ROWS(beside_spray_rows, beside_spray_row, fields)

MPS_ROW void any_spray_row(const int dim, const mps_view *v, const fields *f, int64_t i,
                           double *most)
{
    (void)dim, (void)v;
    if (mps_region_of(f->region, i) == MPS_REGION_SPRAY) most[0] = 1;
}
MPS_SUMS(any_spray_rows, any_spray_row, fields)

/* Inner particles beside spray that are on the surface if spray is ignored. */
static int look_beside_spray(mps_stage *s, fields *f)
{
    double any;
    mps_stage_max(s, 1, &any_spray_rows, f, &any);
    if (!(any > 0)) return 0;
    f->from = MPS_REGION_SPRAY;
    mps_stage_rows(s, &from_rows, f);
    if (refresh(s, f->member)) return 1;
    mps_stage_rows(s, &beside_spray_rows, f);
    mps_stage_rows(s, &surface_rows, f);
    return refresh(s, f->region);
}

/* Whether a particle has both a wall and the surface within 1.5 dp. */
MPS_ROW bool at_contact(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    bool wall = false, surface = false;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        if (q.r2 > 2.25 * v->dp * v->dp) continue;
        wall = wall || mps_is_wall(v, q.j);
        surface = surface ||
                  (mps_is_fluid(v, q.j) && mps_region_of(f->region, q.j) == MPS_REGION_SURFACE);
    }
    return wall && surface;
}

/* Beside a wall that continues above the surface n is too large and |A| too small. There a
 * neighbour of the surface is on the surface as well if n < contact_low n0 and |A| > contact_share
 * |A|0 (contact = 1). Without this test such particles change between surface and inside from step
 * to step: a 3-D tank does not come to rest, and a trough in 2-D breaks up at the wall. */
MPS_ROW void contact_row(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    const double *k = v->setting;
    f->mark[i] = mps_is_fluid(v, i) && mps_region_of(f->region, i) == MPS_REGION_INNER &&
                 f->number_density[i] < k[CONTACT_LOW] * v->near.n0 &&
                 asymmetry_of(dim, f, i) > k[CONTACT_SHARE] && at_contact(dim, v, f, i);
}
MPS_ROWS(contact_rows, contact_row, fields)

/* ---- the verb -------------------------------------------------------------------------------- */

static int find_surface(mps_stage *s)
{
    const mps_view *v = s->view;
    fields f = {.number_density = s->data[NUMBER_DENSITY],
                .asymmetry = s->data[ASYMMETRY],
                .region = s->data[REGION],
                .member = mps_stage_scratch_integers(s, v->n),
                .mark = mps_stage_scratch_integers(s, v->n),
                .a0 = lattice_asymmetry(&v->near)};
    if (!f.member || !f.mark) return 1;
    *(int32_t *)s->data[COMPLETE_SURFACE] = v->setting[COMPLETE] > 0;
    mps_stage_rows(s, &own_rows, &f);
    if (refresh(s, f.region) || look_beside_spray(s, &f)) return 1;
    if (v->setting[CONTACT] > 0) {
        mps_stage_rows(s, &contact_rows, &f);
        mps_stage_rows(s, &surface_rows, &f);
    }
    return spread(s, &f, MPS_REGION_SURFACE, MPS_REGION_NEAR) ||
           spread(s, &f, MPS_REGION_NEAR, MPS_REGION_SECOND);
}

static const mps_verb verbs[] = {
    {.hook = MPS_CLASSIFY, .use_count = USES, .uses = uses, .run = find_surface, .device = 1}};

const mps_model_ops mps__surface_asymmetry = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "surface.asymmetry",
    .help = "Free surface and spray by number density n and asymmetry, W22 (11)(12)",
    .setting_count = SETTINGS,
    .settings = settings,
    .verb_count = 1,
    .verbs = verbs};

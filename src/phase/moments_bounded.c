/* SPDX-License-Identifier: BSD-3-Clause */
/* Moment matrices of the pressure operators, over fluid and wetted walls:
 *   B_i = M_i^-1,  M_i = D/n0 sum w r_ij (x) r_ij,  w = W/r^2.
 * With B_i gradient and divergence are exact for linear fields. Eigenvalues of M_i below `floor`
 * are raised to `floor`; for surface particles to `surface`. Why `surface` is smaller: the
 * eigenvalue along the normal of a flat surface is 0.5, and less in a disordered or stretched row.
 * A floor of 0.5 reduces the gradient of most surface particles by 4-11 %. The layer then lags
 * behind its pressure, and waves grow by 2-3 % per period. Inside the fluid, lower floors make calm
 * water noisy. */
#include "helpers.h"

enum { FLOOR, SURFACE, TORN, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [FLOOR] = {"floor", "-", "Smallest eigenvalue of M inside the fluid", MPS_TYPE_REAL, 0.5, 0.01,
               1.0},
    [SURFACE] = {"surface", "-", "Smallest eigenvalue of M on the free surface", MPS_TYPE_REAL, 0.4,
                 0.01, 1.0},
    [TORN] = {"torn", "-", "Smallest eigenvalue of M in torn gas, if larger than floor",
              MPS_TYPE_REAL, 0.0, 0.0, 1.0}};

/* Volume deviation above which gas counts as torn. */
static const double TORN_FROM = 0.15;

static const mps_channel channels[] = {
    {.name = "correction",
     .unit = "-",
     .help = "B_i, symmetric: makes gradient and divergence exact for linear fields",
     .components = MPS_MATRIX,
     .type = MPS_TYPE_REAL,
     .life = MPS_LIFE_STEP,
     .initial = 1.0}};

enum { REGION, DENSITY, VOLUME_DEVIATION, CORRECTION, USES };
static const mps_use uses[USES] = {[REGION] = {"region", MPS_USE_NEIGHBOURS},
                                   [DENSITY] = {"density", MPS_USE_READ},
                                   [VOLUME_DEVIATION] = {"volume_deviation", MPS_USE_READ},
                                   [CORRECTION] = {"correction", MPS_USE_CHANGE}};

typedef struct fields {
    const int32_t *region;
    const double *density, *volume_deviation;
    double *correction;
    double light; /* density of the gas that may be torn; 0: none */
} fields;

/* Smallest eigenvalue allowed for particle i.
 *
 * Torn gas has few, scattered neighbours. Gradient and divergence both contain B, the Laplacian
 * does not: along a direction in which M has the eigenvalue m, a pressure removes m/max(m,
 * floor)^2 <= 1/floor times the requested divergence. With a floor of 0.5 and a gain of 0.7 that is
 * 1.4 times, and voids grow. For the lightest of several fluids the floor changes to `torn`, which
 * should equal the gain, where its volume is too large by more than 15 % (source.volume): then no
 * step removes more than requested. */
static inline double floor_of(const mps_view *view, const fields *f, int64_t i)
{
    const double plain =
        view->setting[mps_region_of(f->region, i) == MPS_REGION_SURFACE ? SURFACE : FLOOR];
    const double v = f->volume_deviation[i];
    if (f->density[i] != f->light || v >= 0) return plain;
    const double square = v * v / (TORN_FROM * TORN_FROM);
    return plain + mps_smaller(1.0, square * square) * mps_larger(0.0, view->setting[TORN] - plain);
}

/* M_i */
MPS_ROW void moments(const int dim, const mps_view *view, const int32_t *region, int64_t i,
                     double m[9])
{
    const mps_stencil *t = &view->near;
    for (int d = 0; d < dim * dim; d++) m[d] = 0;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        if (mps_region_of(region, mps_stencil_column(t, p)) >= MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        for (int d = 0; d < dim; d++)
            for (int e = d; e < dim; e++) m[d * dim + e] += q.w_r2 * q.d[d] * q.d[e];
    }
    for (int d = 0; d < dim; d++)
        for (int e = d; e < dim; e++) m[e * dim + d] = m[d * dim + e] *= dim / t->n0;
}

MPS_ROW void invert(const int dim, const mps_view *view, const fields *f, int64_t i)
{
    if (!mps_is_fluid(view, i) || mps_region_of(f->region, i) == MPS_REGION_SPRAY) return;
    const double least = floor_of(view, f, i);
    double m[9];
    moments(dim, view, f->region, i, m);
    mps_matrix_inverse_bounded(dim, m, least, f->correction + i * dim * dim);
}
MPS_ROWS(invert_rows, invert, fields)

static int invert_moments(mps_stage *s)
{
    fields f = {.region = s->data[REGION],
                .density = s->data[DENSITY],
                .volume_deviation = s->data[VOLUME_DEVIATION],
                .correction = s->data[CORRECTION]};
    if (s->view->setting[TORN] > 0) {
        double rho[2];
        mps__density_range(s, rho);
        f.light = rho[1] > rho[0] ? rho[0] : 0;
    }
    mps_stage_rows(s, &invert_rows, &f);
    return 0;
}

/* Before the gas subtracts its law from the volume deviation. */
static const mps_verb verbs[] = {{.hook = MPS_PREPARE,
                                  .use_count = USES,
                                  .uses = uses,
                                  .before = "gas",
                                  .run = invert_moments,
                                  .device = 1}};

const mps_model_ops mps__moments_bounded = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "moments.bounded",
    .help = "Moment matrices that make gradient and divergence exact for linear fields",
    .setting_count = SETTINGS,
    .settings = settings,
    .channel_count = 1,
    .channels = channels,
    .verb_count = 1,
    .verbs = verbs};

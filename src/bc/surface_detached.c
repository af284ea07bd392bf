/* SPDX-License-Identifier: BSD-3-Clause */
/* Spray of the heavier phases where several phases fill the tank and there is no free surface: a
 * particle is spray if
 *   sum_j W_ij min(1, rho_j/rho_i) < spray n0   over the fluid j around it.
 * Such a droplet moves through the gas unaffected by its pressure. In the pressure equation a
 * single droplet in front of a wall gets a pressure above the wall's, which pulls it into the wall.
 * Particles of the lightest phase are never spray. */
#include "helpers.h"

enum { SPRAY, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [SPRAY] = {"spray", "n0", "Spray: kernel sum over fluid of its own density below this",
               MPS_TYPE_REAL, 0.25, 0.0, 1.0}};

enum { DENSITY, REGION, USES };
static const mps_use uses[USES] = {
    [DENSITY] = {"density", MPS_USE_NEIGHBOURS}, [REGION] = {"region", MPS_USE_WRITE}};

typedef struct fields {
    const double *density;
    int32_t *region;
    double enough, lightest; /* limit of the kernel sum; least density of the fluid */
} fields;

/* The sum above, up to `enough`. */
MPS_ROW double sum_about(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    double sum = 0;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i) && sum < f->enough; p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (mps_is_fluid(v, j))
            sum += mps_stencil_pair_dim(dim, t, i, p).w *
                   mps_smaller(1.0, f->density[j] / f->density[i]);
    }
    return sum;
}

MPS_ROW void spray_row(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    if (!mps_is_fluid(v, i) || !(f->density[i] > f->lightest)) return;
    if (sum_about(dim, v, f, i) < f->enough) f->region[i] = MPS_REGION_SPRAY;
}
MPS_ROWS(spray_rows, spray_row, fields)

static int find_spray(mps_stage *s)
{
    double rho[MPS_PHASES];
    fields f = {.density = s->data[DENSITY],
                .region = s->data[REGION],
                .enough = s->view->setting[SPRAY] * s->view->near.n0,
                .lightest = INFINITY};
    mps_stage_densities(s, rho, NULL);
    for (int p = 0; p < MPS_PHASES; p++)
        if (rho[p] > 0) f.lightest = mps_smaller(f.lightest, rho[p]);
    mps_stage_rows(s, &spray_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_CLASSIFY, .use_count = USES, .uses = uses, .run = find_spray, .device = 1}};

const mps_model_ops mps__surface_detached = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "surface.detached",
    .help = "Spray of the denser phases in a tank without a free surface",
    .setting_count = SETTINGS,
    .settings = settings,
    .verb_count = 1,
    .verbs = verbs};

/* SPDX-License-Identifier: BSD-3-Clause */
/* Density smoothing, W22 (13), W22: Wen, Zhao & Wan 2022:
 *   rho_i = (rho_i W_self + sum rho_j W)/(W_self + sum W)  over the fluid within the near radius.
 * It changes fluid with another density within that radius: a band two radii wide at an interface.
 * W22 does not give W_self. Here it is `self` times W(0): the larger `self`, the weaker the
 * smoothing. Only "pressure_density" changes: a particle keeps the mass of its phase. */
#include "helpers.h"

enum { SELF, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [SELF] = {"self", "-", "Weight of a particle's own density, in W(0): larger smooths less",
              MPS_TYPE_REAL, 100.0, 0.0, 1e6}};

enum { DENSITY, SMOOTHED, USES };
static const mps_use uses[USES] = {
    [DENSITY] = {"density", MPS_USE_NEIGHBOURS}, [SMOOTHED] = {"pressure_density", MPS_USE_CHANGE}};

typedef struct fields {
    const double *density;
    double *smoothed;
    double self; /* W_self */
} fields;

/* Sums of differences keep the bits of a density without other densities near it. */
MPS_ROW void smooth(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    if (!mps_is_fluid(v, i)) return;
    const mps_stencil *t = &v->near;
    const double rho = f->density[i];
    double sum = 0, weight = f->self;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        if (!mps_is_fluid(v, mps_stencil_column(t, p))) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        sum += q.w * (f->density[q.j] - rho);
        weight += q.w;
    }
    f->smoothed[i] = sum == 0 ? rho : rho + sum / weight;
}
MPS_ROWS(smooth_rows, smooth, fields)

static int smooth_densities(mps_stage *s)
{
    /* only "improved" is certain to be finite at 0 */
    const mps_kernel *kernel = &s->view->near.kernel;
    const double r = kernel->id == MPS_KERNEL_IMPROVED ? 0.0 : 0.5 * s->view->dp;
    fields f = {.density = s->data[DENSITY],
                .smoothed = s->data[SMOOTHED],
                .self = s->view->setting[SELF] * mps_kernel_weight(kernel, r, s->view->near.re)};
    mps_stage_rows(s, &smooth_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_PREPARE, .use_count = USES, .uses = uses, .run = smooth_densities, .device = 1}};

const mps_model_ops mps__density_smooth = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "density.smooth",
    .help = "Density that changes smoothly across interfaces, for the operators of the pressure",
    .setting_count = SETTINGS,
    .settings = settings,
    .verb_count = 1,
    .verbs = verbs};

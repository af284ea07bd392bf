/* SPDX-License-Identifier: BSD-3-Clause */
/* Surface tension as a jump of the pressure across an interface,
 *   p_i - p_j = (sigma kappa_i - sigma kappa_j)/2,
 * kappa as in tension.c: positive if the interface bends around the particle's own phase. The jump
 * is in the pairs of the pressure equation and of its gradient (mps/flux.h), so that a droplet at
 * rest stays at rest, up to the noise of kappa. A force such as tension.csf is balanced by
 * gradients of other pairs and drives spurious currents. Therefore r_s can be smaller here; a
 * smaller r_s responds to single particles outside their phase. sigma is that of mps_tension_set()
 * for two phases, else the setting; a particle with several other phases around it uses the mean.
 * The gradient must include the jump: gradient.corrected. */
#include "tension.h"

enum { SIGMA, RADIUS, THRESHOLD, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [SIGMA] = {"sigma", "N/m", "Surface tension of phases without mps_tension_set()", MPS_TYPE_REAL,
               7.27e-2, 0.0, 100.0},
    [RADIUS] = {"radius", "dp", "Radius r_s of the curvature: larger is smoother", MPS_TYPE_REAL,
                5.1, 2.1, 20.0},
    [THRESHOLD] = {"threshold", "1/dp", "Smallest magnitude of grad f at an interface",
                   MPS_TYPE_REAL, 0.02, 1e-6, 1.0}};

static const mps_channel channels[] = {
    {.name = "pressure_jump",
     .unit = "Pa",
     .help = "Pressure jump sigma kappa at an interface; > 0: higher in the own phase",
     .components = 1,
     .type = MPS_TYPE_REAL,
     .life = MPS_LIFE_STEP,
     .initial = 0.0}};

enum { JUMP, USES };
static const mps_use uses[USES] = {[JUMP] = {"pressure_jump", MPS_USE_CHANGE}};

typedef struct fields {
    double *jump;
    double *kappa; /* [n] curvatures */
} fields;

/* Mean of sigma over the neighbours of other phases. */
MPS_ROW double mean_sigma(const int dim, const mps_view *v, int64_t i)
{
    const mps_stencil *t = &v->far;
    double sum = 0, weight = 0;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (!mps_is_fluid(v, j) || v->phase[j] == v->phase[i]) continue;
        const double w = mps_stencil_pair_dim(dim, t, i, p).w;
        sum += w * mps__pair_sigma(v, v->phase[i], v->phase[j], v->setting[SIGMA]);
        weight += w;
    }
    return weight > 0 ? sum / weight : 0;
}

MPS_ROW void find_jump(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    if (f->kappa[i] != 0) f->jump[i] = f->kappa[i] * mean_sigma(dim, v, i);
}
MPS_ROWS(find_jump_rows, find_jump, fields)

static int find_jumps(mps_stage *s)
{
    const double *k = s->view->setting;
    fields f = {.jump = s->data[JUMP], .kappa = mps_stage_scratch(s, s->view->n)};
    if (!f.kappa || mps__curvatures(s, MPS_FAR, k[RADIUS], k[THRESHOLD], f.kappa)) return 1;
    mps_stage_rows(s, &find_jump_rows, &f);
    return 0;
}

static double reach(const double *setting, double dp)
{
    return setting[RADIUS] * dp;
}

static int limit_step(mps_stage *s)
{
    mps__tension_limit(s, s->view->setting[SIGMA]);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_LIMIT, .run = limit_step, .device = 1},
    {.hook = MPS_PREPARE, .use_count = USES, .uses = uses, .run = find_jumps, .device = 1}};

const mps_model_ops mps__tension_jump = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "tension.jump",
    .help = "Surface tension as a jump of the pressure across interfaces",
    .setting_count = SETTINGS,
    .settings = settings,
    .channel_count = 1,
    .channels = channels,
    .verb_count = 2,
    .verbs = verbs,
    .reach = reach};

/* SPDX-License-Identifier: BSD-3-Clause */
/* Pressure datum in a tank that is full up to its lid: after the solution the mean pressure of the
 * highest wetted wall particles is subtracted from all pressures. Pressure differences, and so the
 * flow, do not change, and no fluid leaves as it would through a fixed pressure. The model does
 * nothing if a free surface, a Dirichlet row or a compressible phase sets the datum.
 *
 * Weights decrease with the depth below the highest point as exp(-depth/(layer dp)), times the
 * wetted fraction: in a rolling tank the datum moves smoothly from one corner to the other. */
#include "helpers.h"

enum { LAYER, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [LAYER] = {"layer", "dp", "Depth over which the weight of the walls falls to 1/e",
               MPS_TYPE_REAL, 0.5, 0.05, 100.0}};

enum { REGION, WETTED_SHARE, PRESSURE, USES };
static const mps_use uses[USES] = {
    [REGION] = {"region", MPS_USE_READ},
    [WETTED_SHARE] = {"wetted_share", MPS_USE_READ | MPS_USE_OPTIONAL},
    [PRESSURE] = {"pressure", MPS_USE_CHANGE}};

typedef struct fields {
    const int32_t *region;
    const double *wetted_share; /* NULL: 1 */
    double *pressure;
    double up[3], top, mean; /* against gravity; height of the highest wall; its pressure */
} fields;

/* Whether a wall particle is in the equation. */
static inline bool wetted(const mps_view *v, const fields *f, int64_t i)
{
    return mps_is_wall(v, i) && mps_region_of(f->region, i) < MPS_REGION_SURFACE;
}

MPS_ROW void top_row(const int dim, const mps_view *v, const fields *f, int64_t i, double *most)
{
    (void)dim;
    if (wetted(v, f, i)) most[0] = mps_larger(most[0], mps__height(v, f->up, i));
}
MPS_SUMS(top_rows, top_row, fields)

/* Sums of weight times pressure, and of the weight. */
MPS_ROW void mean_row(const int dim, const mps_view *v, const fields *f, int64_t i, double *sums)
{
    (void)dim;
    if (!wetted(v, f, i)) return;
    const double share = f->wetted_share ? f->wetted_share[i] : 1.0;
    const double w = share *
                     mps_exp((mps__height(v, f->up, i) - f->top) / (v->setting[LAYER] * v->dp));
    sums[0] += w * f->pressure[i];
    sums[1] += w;
}
MPS_SUMS(mean_rows, mean_row, fields)

MPS_ROW void level_row(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    (void)dim, (void)v;
    if (mps_region_of(f->region, i) < MPS_REGION_SPRAY) f->pressure[i] -= f->mean;
}
MPS_ROWS(level_rows, level_row, fields)

static int subtract_mean(mps_stage *s)
{
    double sums[2];
    fields f = {.region = s->data[REGION],
                .wetted_share = s->data[WETTED_SHARE],
                .pressure = s->data[PRESSURE]};
    if (!s->level_free) return 0;
    if (!mps__upward(s->view, f.up))
        return mps_stage_fail(
            s, "without gravity there is no highest wall: remove the model \"reference\"");
    mps_stage_max(s, 1, &top_rows, &f, &f.top);
    mps_stage_sum(s, 2, &mean_rows, &f, sums);
    if (!(sums[1] > 0)) return 0;
    f.mean = sums[0] / sums[1];
    mps_stage_rows(s, &level_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_LEVEL, .use_count = USES, .uses = uses, .run = subtract_mean, .device = 1}};

const mps_model_ops mps__reference_lid = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "reference.lid",
    .help = "Level of the pressures in a full tank: mean 0 at the highest walls",
    .setting_count = SETTINGS,
    .settings = settings,
    .verb_count = 1,
    .verbs = verbs};

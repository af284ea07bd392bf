/* SPDX-License-Identifier: BSD-3-Clause */
/* Pressure datum in a closed tank, after Wen, Zhao & Wan 2022 (W22): p = 0 in the uppermost layer
 * of the gas, `layer` dp thick, against gravity. These particles are Dirichlet rows: the equation
 * is not solved there, and gas may leave through them in a long run. */
#include "helpers.h"

enum { PHASE, LAYER, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [PHASE] = {"phase", "-", "Number of the phase that is the gas", MPS_TYPE_INTEGER, 1.0, 0.0,
               15.0},
    [LAYER] = {"layer", "dp", "Thickness of the layer at p = 0", MPS_TYPE_REAL, 0.75, 0.1, 100.0}};

enum { PRESSURE_CONDITION, PRESSURE_VALUE, USES };
static const mps_use uses[USES] = {[PRESSURE_CONDITION] = {"pressure_condition", MPS_USE_WRITE},
                                   [PRESSURE_VALUE] = {"pressure_value", MPS_USE_WRITE}};

typedef struct fields {
    int32_t *condition;
    double *value;
    double up[3], top; /* against gravity; height of the highest gas */
} fields;

static inline bool is_gas(const mps_view *v, int64_t i)
{
    return mps_is_fluid(v, i) && v->phase[i] == (int32_t)v->setting[PHASE];
}

MPS_ROW void top_row(const int dim, const mps_view *v, const fields *f, int64_t i, double *most)
{
    (void)dim;
    if (is_gas(v, i)) most[0] = mps_larger(most[0], mps__height(v, f->up, i));
}
MPS_SUMS(top_rows, top_row, fields)

MPS_ROW void layer_row(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    (void)dim;
    if (!is_gas(v, i)) return;
    if (mps__height(v, f->up, i) < f->top - v->setting[LAYER] * v->dp) return;
    f->condition[i] = MPS_ROW_FIXED;
    f->value[i] = 0;
}
MPS_ROWS(layer_rows, layer_row, fields)

static int fix_layer(mps_stage *s)
{
    fields f = {.condition = s->data[PRESSURE_CONDITION], .value = s->data[PRESSURE_VALUE]};
    if (!mps__upward(s->view, f.up))
        return mps_stage_fail(s, "without gravity there is no uppermost layer: remove the model "
                                 "\"reference\"");
    mps_stage_max(s, 1, &top_rows, &f, &f.top);
    if (isinf(f.top))
        return mps_stage_fail(s,
                              "phase %d has no fluid particle: add the gas, set reference.phase to "
                              "it, or remove the model \"reference\"",
                              (int)s->view->setting[PHASE]);
    mps_stage_rows(s, &layer_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_SOURCE, .use_count = USES, .uses = uses, .run = fix_layer, .device = 1}};

const mps_model_ops mps__reference_gas = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "reference.gas",
    .help = "Level of the pressures in a closed tank: p = 0 in the uppermost gas, W22",
    .setting_count = SETTINGS,
    .settings = settings,
    .verb_count = 1,
    .verbs = verbs};

/* SPDX-License-Identifier: BSD-3-Clause */
/* Pressure is bounded below by the vapour pressure: liquid or gas that would need more suction
 * separates. A row of the fluid or of a wetted wall has the lower bound
 *
 *   p_i >= p_v - p_a =: -least,
 *
 * p_a the ambient pressure, where p = 0. The void that the model leaves closes when the pressure
 * rises. The bound applies to rows whose last pressure is below half of it: flows without such
 * suction keep their bytes and cost nothing. A pressure that falls within one step from above half
 * of the bound to below the bound is bounded from the next step on. */
#include "helpers.h"

enum { LEAST, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [LEAST] = {"least", "Pa", "Pressure of vapour below that of the surroundings", MPS_TYPE_REAL,
               99e3, 1.0, 1e12}};

/* Fraction of the bound from which on a row counts. */
static const double NEAR = 0.5;

enum { REGION, PRESSURE, PRESSURE_CONDITION, PRESSURE_VALUE, USES };
static const mps_use uses[USES] = {[REGION] = {"region", MPS_USE_READ},
                                   [PRESSURE] = {"pressure", MPS_USE_READ},
                                   [PRESSURE_CONDITION] = {"pressure_condition", MPS_USE_CHANGE},
                                   [PRESSURE_VALUE] = {"pressure_value", MPS_USE_WRITE}};

typedef struct fields {
    const double *pressure;
    const int32_t *region;
    int32_t *condition;
    double *value;
} fields;

MPS_ROW void bound_row(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    (void)dim;
    if (f->condition[i] != MPS_ROW_FREE || !(f->pressure[i] < -NEAR * v->setting[LEAST])) return;
    if (mps_is_dummy(v, i) || mps_region_of(f->region, i) != MPS_REGION_INNER) return;
    f->condition[i] = MPS_ROW_LEAST;
    f->value[i] = -v->setting[LEAST];
}
MPS_ROWS(bound_rows, bound_row, fields)

static int bound_pressures(mps_stage *s)
{
    const fields f = {.pressure = s->data[PRESSURE],
                      .region = s->data[REGION],
                      .condition = s->data[PRESSURE_CONDITION],
                      .value = s->data[PRESSURE_VALUE]};
    mps_stage_rows(s, &bound_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {{.hook = MPS_SOURCE,
                                  .use_count = USES,
                                  .uses = uses,
                                  .after = "*",
                                  .run = bound_pressures,
                                  .device = 1}};

const mps_model_ops mps__cavitation_vapour = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "cavitation.vapour",
    .help = "Liquid gives way where it would have to pull below the pressure of vapour",
    .setting_count = SETTINGS,
    .settings = settings,
    .verb_count = 1,
    .verbs = verbs};

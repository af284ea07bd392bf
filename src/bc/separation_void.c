/* SPDX-License-Identifier: BSD-3-Clause */
/* Separation: walls exert no suction where void can reach them. Without gas in the void the liquid
 * separates from a wall as soon as the wall would exert suction and void is beside it: behind an
 * edge, at a falling crest, on a wall that moves away. A wall particle with a surface particle,
 * spray or a dry wall among its near neighbours has a lower bound of pressure,
 *
 *   p_i >= min(0, min_j rho_j b.(x_i - x_j)),   b = g - a_tank,
 *
 * over the surface particles j around it: the static pressure of a wall above the contact line, so
 * that calm water does not change. Walls with only liquid around them may exert suction: void
 * reaches them only after the liquid has separated from the adjacent walls.
 *
 * A velocity jump of the tank is an impulse with its own suction, and a gain below 1 spreads it
 * over several steps: no bound applies in the first `hold` steps. */
#include "helpers.h"

enum { HOLD, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [HOLD] = {"hold", "steps", "Steps without separation after a jump of the tank's velocity",
              MPS_TYPE_INTEGER, 5.0, 0.0, 1000.0}};

enum { DENSITY, TANK_ACCELERATION, REGION, PRESSURE_CONDITION, PRESSURE_VALUE, USES };
static const mps_use uses[USES] = {[DENSITY] = {"density", MPS_USE_NEIGHBOURS},
                                   [TANK_ACCELERATION] = {"tank_acceleration", MPS_USE_READ},
                                   [REGION] = {"region", MPS_USE_NEIGHBOURS},
                                   [PRESSURE_CONDITION] = {"pressure_condition", MPS_USE_CHANGE},
                                   [PRESSURE_VALUE] = {"pressure_value", MPS_USE_WRITE}};

typedef struct fields {
    const double *density, *tank_acceleration;
    const int32_t *region;
    int32_t *condition;
    double *value;
} fields;

/* Lower bound of the pressure of wall i; +inf: no void near. */
MPS_ROW double least_pressure(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    const double *tank = f->tank_acceleration + i * dim, *x = v->x;
    double least = INFINITY;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        const int32_t region = mps_region_of(f->region, j);
        const bool fluid = mps_is_fluid(v, j), surface = fluid && region == MPS_REGION_SURFACE;
        if (!surface && !(fluid && region == MPS_REGION_SPRAY) &&
            !(mps_is_wall(v, j) && region == MPS_REGION_DRY))
            continue;
        double body = 0;
        for (int d = 0; d < dim && surface; d++)
            body += (v->g[d] - tank[d]) * (x[i * dim + d] - x[j * dim + d]);
        least = mps_smaller(least, mps_smaller(0, f->density[j] * body));
    }
    return least;
}

MPS_ROW void wall_row(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    if (!mps_is_wall(v, i) || mps_region_of(f->region, i) != MPS_REGION_INNER) return;
    if (f->condition[i] != MPS_ROW_FREE) return;
    const double least = least_pressure(dim, v, f, i);
    if (!(least <= 0)) return;
    f->condition[i] = MPS_ROW_LEAST;
    f->value[i] = least;
}
MPS_ROWS(wall_rows, wall_row, fields)

static int let_go(mps_stage *s)
{
    fields f = {.density = s->data[DENSITY],
                .tank_acceleration = s->data[TANK_ACCELERATION],
                .region = s->data[REGION],
                .condition = s->data[PRESSURE_CONDITION],
                .value = s->data[PRESSURE_VALUE]};
    if ((double)s->since_jump < s->view->setting[HOLD]) return 0;
    mps_stage_rows(s, &wall_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {{.hook = MPS_SOURCE,
                                  .use_count = USES,
                                  .uses = uses,
                                  .after = "reference",
                                  .run = let_go,
                                  .device = 1}};

const mps_model_ops mps__separation_void = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "separation.void",
    .help = "Liquid leaves a wall that would have to pull, if void is beside it",
    .setting_count = SETTINGS,
    .settings = settings,
    .verb_count = 1,
    .verbs = verbs};

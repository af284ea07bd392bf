/* SPDX-License-Identifier: BSD-3-Clause */
/* Sponge layer: damps the velocity of the fluid relative to the tank,
 *   a = -k(x) (u - u_tank),   k(x) = rate s^2,   s = (x - from)/(to - from), 0 <= s <= 1,
 * x the position in the frame of the tank. s = 0 before `from`. With to < from the layer extends
 * from right to left. k increases smoothly from 0, so that the front of the layer reflects little.
 * The update is implicit, k/(1 + k dt) instead of k: stable for any dt. */
#include "sponge.h"

enum { FROM, TO, RATE, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [FROM] = {"from", "m", "x where the layer begins", MPS_TYPE_REAL, 0.0, -1e6, 1e6},
    [TO] = {"to", "m", "x where the layer ends", MPS_TYPE_REAL, 1.0, -1e6, 1e6},
    [RATE] = {"rate", "1/s", "Damping at the end of the layer", MPS_TYPE_REAL, 0.0, 0.0, 1e6}};

enum { VELOCITY, ACCELERATION, USES };
static const mps_use uses[USES] = {
    [VELOCITY] = {"velocity", MPS_USE_READ}, [ACCELERATION] = {"acceleration", MPS_USE_CHANGE}};

/* Fields of the row function. */
typedef struct fields {
    const double *velocity;
    double *acceleration;
} fields;

/* Damping at a position in the tank [1/s]. */
static double damping(const mps_view *v, double x)
{
    const double length = v->setting[TO] - v->setting[FROM];
    const double share = length != 0 ? (x - v->setting[FROM]) / length : 0;
    return share > 0 && share <= 1 ? v->setting[RATE] * share * share : 0;
}

MPS_ROW void damp(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    double place[3], tank[3];
    if (v->kind[i] != MPS_FLUID) return;
    mps_view_tank(v, v->x + i * dim, place, tank);
    const double k = damping(v, place[0]);
    for (int d = 0; d < dim; d++)
        f->acceleration[i * dim + d] -= k / (1 + k * v->dt) * (f->velocity[i * dim + d] - tank[d]);
}
MPS_ROWS(damp_rows, damp, fields)

static int damp_fluid(mps_stage *s)
{
    fields f = {.velocity = s->data[VELOCITY], .acceleration = s->data[ACCELERATION]};
    mps_stage_rows(s, &damp_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_FORCE, .use_count = USES, .uses = uses, .run = damp_fluid}};

const mps_model_ops sponge_layer = {.struct_size = sizeof(mps_model_ops),
                                    .api = MPS_MODEL_API,
                                    .name = "sponge.layer",
                                    .help = "Layer that damps the velocity relative to the tank",
                                    .setting_count = SETTINGS,
                                    .settings = settings,
                                    .verb_count = 1,
                                    .verbs = verbs};

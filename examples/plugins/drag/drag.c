/* SPDX-License-Identifier: BSD-3-Clause */
/* A plug-in with one model: a drag of the fluid relative to the tank, a = -rate (u - u_tank). */
#include <mps/plugin.h>

static const mps_setting settings[] = {
    {"rate", "1/s", "Drag of the fluid", MPS_TYPE_REAL, 0.0, 0.0, 100.0}};
static const mps_use uses[] = {{"velocity", MPS_USE_READ}, {"acceleration", MPS_USE_CHANGE}};

typedef struct fields {
    const double *velocity;
    double *acceleration;
} fields;

MPS_ROW void slow_down(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    double place[3], tank[3];
    if (v->kind[i] != MPS_FLUID) return;
    mps_view_tank(v, v->x + i * dim, place, tank);
    for (int d = 0; d < dim; d++)
        f->acceleration[i * dim + d] -= v->setting[0] * (f->velocity[i * dim + d] - tank[d]);
}
MPS_ROWS(slow_down_rows, slow_down, fields)

static int slow_down_fluid(mps_stage *s)
{
    const fields f = {.velocity = s->data[0], .acceleration = s->data[1]};
    mps_stage_rows(s, &slow_down_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_FORCE, .use_count = 2, .uses = uses, .run = slow_down_fluid}};
static const mps_model_ops drag = {.struct_size = sizeof drag,
                                   .api = MPS_MODEL_API,
                                   .name = "drag.linear",
                                   .help = "Linear drag of the fluid relative to the tank",
                                   .setting_count = 1,
                                   .settings = settings,
                                   .verb_count = 1,
                                   .verbs = verbs};

mps_status mps_plugin(mps_registry *r)
{
    const mps_status status = mps_plugin_begin(r, "drag", "1.0");
    return status < 0 ? status : r->model(r->host, &drag);
}

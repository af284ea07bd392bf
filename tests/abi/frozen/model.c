/* SPDX-License-Identifier: BSD-3-Clause */
/* A model of the frozen version: a pull along x, with a setting, a channel of its own, a loop and a sum. */
#include <math.h>
#include <mps/model.h>

int frozen_model_calls;

typedef struct fields {
    double *acceleration, *age;
} fields;

MPS_ROW void pull(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    if (!mps_is_fluid(v, i)) return;
    f->acceleration[i * dim] += v->setting[0];
    f->age[i] += v->dt;
}
MPS_ROWS(pull_rows, pull, fields)

MPS_ROW void count(const int dim, const mps_view *v, const fields *f, int64_t i, double *sum)
{
    (void)dim, (void)f;
    sum[0] += mps_is_fluid(v, i);
}
MPS_SUMS(count_rows, count, fields)

static int run(mps_stage *s)
{
    const mps_view *v = s->view;
    const fields f = {s->data[0], s->data[1]};
    double fluid = 0;
    if (s->struct_size < sizeof *s || v->struct_size < sizeof *v || v->dim != 2 || s->hook != MPS_FORCE || v->n < 1 || v->dp != 0.05 ||
        v->setting[0] != 0.25)
        return mps_stage_fail(s, "a field of the stage is at another place");
    if (!(v->dt > 0) || v->g[1] != -9.81 || v->near.dim != 2 || v->near.n != v->n || v->far.n != v->n || s->self != &frozen_model_calls)
        return mps_stage_fail(s, "a field of the stage is at another place");
    mps_stage_rows(s, &pull_rows, &f);
    mps_stage_sum(s, 1, &count_rows, &f, &fluid);
    frozen_model_calls += fluid > 0;
    return 0;
}

static const mps_use uses[] = {{"acceleration", MPS_USE_CHANGE}, {"frozen_age", MPS_USE_CHANGE}};
static const mps_verb verbs[] = {{.hook = MPS_FORCE, .use_count = 2, .uses = uses, .run = run}};
static const mps_channel channels[] = {{"frozen_age", "s", "time in the fluid", 1, MPS_TYPE_REAL, MPS_LIFE_PARTICLE, 0}};
static const mps_setting settings[] = {{"pull", "m/s2", "acceleration along x", MPS_TYPE_REAL, 0, -1, 1}};

const mps_model_ops frozen_model = {.struct_size = sizeof frozen_model,
                                    .api = MPS_MODEL_API,
                                    .name = "frozen.v1",
                                    .help = "a pull along x",
                                    .setting_count = 1,
                                    .channel_count = 1,
                                    .verb_count = 1,
                                    .settings = settings,
                                    .channels = channels,
                                    .verbs = verbs,
                                    .user = &frozen_model_calls};

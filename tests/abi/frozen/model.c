/* SPDX-License-Identifier: BSD-3-Clause */
/* A model of the frozen version: a pull along x, with a setting, a channel of its own, a loop and a sum. */
#include <math.h>
#include <mps/model.h>

int frozen_model_calls;

static void pull_rows(const mps_stage *s, void *arguments, int64_t begin, int64_t end)
{
    double *a = s->data[0], *age = s->data[1];
    (void)arguments;
    for (int64_t i = begin; i < end; i++) {
        if (s->kind[i] != MPS_FLUID) continue;
        a[i * s->dim] += s->setting[0];
        age[i] += s->dt;
    }
}

static void count_rows(const mps_stage *s, void *arguments, int64_t begin, int64_t end, double *sums)
{
    (void)arguments;
    for (int64_t i = begin; i < end; i++) sums[0] += s->kind[i] == MPS_FLUID;
}

static int run(mps_stage *s)
{
    double fluid = 0;
    if (s->struct_size < sizeof *s || s->dim != 2 || s->moment != MPS_FORCE || s->n < 1 || s->dp != 0.05 || s->setting[0] != 0.25)
        return mps_stage_fail(s, "a field of the stage is at another place");
    if (!(s->dt > 0) || s->g[1] != -9.81 || !s->near || !s->far || s->near->dim != 2 || s->near->n != s->n ||
        s->self != &frozen_model_calls)
        return mps_stage_fail(s, "a field of the stage is at another place");
    mps_stage_rows(s, pull_rows, NULL);
    mps_stage_sum(s, 1, count_rows, NULL, &fluid);
    frozen_model_calls += fluid > 0;
    return 0;
}

static const mps_use uses[] = {{"acceleration", MPS_USE_CHANGE}, {"frozen_age", MPS_USE_CHANGE}};
static const mps_verb verbs[] = {{.moment = MPS_FORCE, .use_count = 2, .uses = uses, .run = run}};
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

/* SPDX-License-Identifier: BSD-3-Clause */
/* Mixed source, W22 (10) literally, W22: Wen, Zhao & Wan 2022:
 *   (1 - gamma) (div u*)/dt - gamma (n - n0)/(n0 dt^2).
 * Rows of the pressure equation are -<lap p>/rho, so the signs are reversed. */
#include "helpers.h"

enum { GAMMA, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [GAMMA] = {"gamma", "-", "Weight of the number density against the divergence", MPS_TYPE_REAL,
               0.01, 0.0, 1.0}};

enum { VELOCITY, NUMBER_DENSITY, SOURCE, USES };
static const mps_use uses[USES] = {[VELOCITY] = {"velocity", MPS_USE_NEIGHBOURS},
                                   [NUMBER_DENSITY] = {"number_density", MPS_USE_READ},
                                   [SOURCE] = {"pressure_source", MPS_USE_CHANGE}};

typedef struct fields {
    const double *divergence, *number_density;
    double *source;
    double rate; /* 1/dt */
} fields;

static const mps_use equation_uses[] = {{"equation_wall_factor", MPS_USE_CHANGE}};

/* Pairs of walls have full weight, independent of the model of walls. */
static int set_equation(mps_stage *s)
{
    *(double *)s->data[0] = 1;
    return 0;
}

MPS_ROW void add_source(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    (void)dim;
    const double n0 = v->near.n0, rate = f->rate, gamma = v->setting[GAMMA];
    f->source[i] += -(1.0 - gamma) * rate * f->divergence[i] +
                    gamma * rate * rate * (f->number_density[i] - n0) / n0;
}
MPS_ROWS(add_source_rows, add_source, fields)

static int add_sources(mps_stage *s)
{
    double *divergence = mps_stage_scratch(s, s->view->n);
    if (!divergence) return 1;
    if (mps_op_divergence(&s->view->near, s->data[VELOCITY], divergence) != MPS_OK)
        return mps_stage_fail(s, "the divergence of the velocity cannot be summed");
    fields f = {divergence, s->data[NUMBER_DENSITY], s->data[SOURCE], 1.0 / s->view->dt};
    mps_stage_rows(s, &add_source_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_CLASSIFY, .use_count = 1, .uses = equation_uses, .run = set_equation, .device = 1},
    {.hook = MPS_SOURCE, .use_count = USES, .uses = uses, .run = add_sources, .device = 1}};

const mps_model_ops mps__source_mixed = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "source.mixed",
    .help = "Source of the pressure equation by divergence and number density",
    .setting_count = SETTINGS,
    .settings = settings,
    .verb_count = 2,
    .verbs = verbs};

/* SPDX-License-Identifier: BSD-3-Clause */
/* Pressure gradient that conserves momentum, W22 (9), W22: Wen, Zhao & Wan 2022:
 *   a_i = -D/(n0 rho) sum (P_j + P_i) r_ij/|r_ij|^2 W. */
#include "helpers.h"

enum { PRESSURE, DENSITY, ACCELERATION, USES };
static const mps_use uses[USES] = {[PRESSURE] = {"pressure", MPS_USE_NEIGHBOURS},
                                   [DENSITY] = {"density", MPS_USE_READ},
                                   [ACCELERATION] = {"acceleration", MPS_USE_CHANGE}};

typedef struct fields {
    const double *density, *gradient;
    double *acceleration;
} fields;

MPS_ROW void accelerate(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    if (!mps_is_fluid(v, i)) return;
    for (int64_t d = i * dim; d < (i + 1) * dim; d++)
        f->acceleration[d] -= f->gradient[d] / f->density[i];
}
MPS_ROWS(accelerate_rows, accelerate, fields)

static int accelerate_fluid(mps_stage *s)
{
    double *gradient = mps_stage_scratch(s, s->view->n * s->view->dim);
    if (!gradient) return 1;
    if (mps_op_gradient_conservative(&s->view->near, s->data[PRESSURE], gradient) != MPS_OK)
        return mps_stage_fail(s, "the gradient of the pressure cannot be summed");
    fields f = {s->data[DENSITY], gradient, s->data[ACCELERATION]};
    mps_stage_rows(s, &accelerate_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_GRADIENT, .use_count = USES, .uses = uses, .run = accelerate_fluid, .device = 1}};

const mps_model_ops mps__gradient_conservative = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "gradient.conservative",
    .help = "Pressure gradient that conserves momentum",
    .verb_count = 1,
    .verbs = verbs};

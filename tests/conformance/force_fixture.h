/* SPDX-License-Identifier: BSD-3-Clause */
/* A model with one force, shared by the tests of the kit of models. */
#ifndef FORCE_FIXTURE_H
#define FORCE_FIXTURE_H

#include "model_kit.h"

enum { VELOCITY, DENSITY, ACCELERATION, USES };
static const mps_use uses[USES] = {[VELOCITY] = {"velocity", MPS_USE_READ},
                                   [DENSITY] = {"density", MPS_USE_READ},
                                   [ACCELERATION] = {"acceleration", MPS_USE_CHANGE}};

typedef struct push {
    const double *u;
    double *rho, *a;
} push;

static inline push arrays(const mps_stage *s)
{
    return (push){s->data[VELOCITY], s->data[DENSITY], s->data[ACCELERATION]};
}

/* A model with one verb of MPS_FORCE. */
static inline mps_model_ops model_of(mps_verb *verb, int (*run)(mps_stage *))
{
    *verb = (mps_verb){.hook = MPS_FORCE, .use_count = USES, .uses = uses, .run = run};
    return (mps_model_ops){.struct_size = sizeof(mps_model_ops),
                           .api = MPS_MODEL_API,
                           .name = "bad.model",
                           .help = "breaks a rule",
                           .verb_count = 1,
                           .verbs = verb};
}

static inline int check_verb(int (*run)(mps_stage *))
{
    mps_verb verb;
    const mps_model_ops ops = model_of(&verb, run);
    return kit_check_model(&ops, NULL, NULL);
}

MPS_ROW void damp_row(const int dim, const mps_view *v, const push *f, int64_t i)
{
    if (v->kind[i] != MPS_FLUID) return;
    for (int d = 0; d < dim; d++) f->a[i * dim + d] -= 2 * f->u[i * dim + d];
}
MPS_ROWS(damp_rows, damp_row, push)

static inline int damp(mps_stage *s)
{
    push f = arrays(s);
    mps_stage_rows(s, &damp_rows, &f);
    return 0;
}

#endif

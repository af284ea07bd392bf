/* SPDX-License-Identifier: BSD-3-Clause */
/* Copies of what a verb may write. */
#include "model_copies.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SHAPES = 128 };
static kit_shape shapes[SHAPES];
static int32_t count;

void kit_learn_shapes(const mps_sim *sim)
{
    mps_channel_info info;
    mps_channel_info_init(&info, sizeof info);
    count = 0;
    for (int32_t k = 0; count < SHAPES && mps_channel_info_get(sim, k, &info) == MPS_OK; k++) {
        kit_shape *to = &shapes[count++];
        const size_t number = info.type == MPS_TYPE_INTEGER ? sizeof(int32_t) : sizeof(double);
        snprintf(to->name, sizeof to->name, "%s", info.name);
        to->type = info.type;
        to->is_scalar = info.components == 0;
        to->element = to->is_scalar ? number : (size_t)info.components * number;
    }
}

const kit_shape *kit_shape_of(const mps_use *use)
{
    for (int32_t k = 0; k < count; k++)
        if (strcmp(shapes[k].name, use->channel) == 0) return &shapes[k];
    return NULL;
}

size_t kit_bytes(const kit_shape *k, int64_t n)
{
    return (k->is_scalar ? 1 : (size_t)n) * k->element;
}

void kit_release(kit_arrays *a)
{
    for (int u = 0; u < KIT_USES; u++) free(a->of[u]);
    free(a->state);
}

static bool copy_state(const mps_stage *s, const kit_arrays *from, kit_arrays *a)
{
    const double *state = from ? from->state : mps_stage_state_get(s, &a->states);
    if (from) a->states = from->states;
    a->state = malloc((size_t)a->states * sizeof *state + 1);
    if (a->state && a->states > 0) memcpy(a->state, state, (size_t)a->states * sizeof *state);
    return a->state;
}

static bool set_state(mps_stage *s, const kit_arrays *a)
{
    int64_t states;
    mps_stage_state_get(s, &states);
    if (states == 0 && a->states == 0) return true;
    double *state = mps_stage_state(s, a->states);
    if (!state) return false;
    if (a->states > 0) memcpy(state, a->state, (size_t)a->states * sizeof *state);
    return true;
}

bool kit_copy(const mps_stage *s, const mps_verb *verb, const kit_arrays *from, kit_arrays *a)
{
    *a = (kit_arrays){.dt_limit = from ? from->dt_limit : s->dt_limit};
    for (int32_t u = 0; u < verb->use_count; u++) {
        const kit_shape *k = kit_shape_of(&verb->uses[u]);
        if (!s->data[u] || !k) continue;
        a->of[u] = malloc(kit_bytes(k, s->view->n) + 1);
        if (!a->of[u]) return false;
        memcpy(a->of[u], from ? from->of[u] : s->data[u], kit_bytes(k, s->view->n));
    }
    return copy_state(s, from, a);
}

int kit_run_on(const mps_stage *s, const mps_verb *verb, kit_arrays *a)
{
    mps_stage t = *s;
    void *data[KIT_USES];
    for (int32_t u = 0; u < verb->use_count; u++) data[u] = a->of[u] ? a->of[u] : s->data[u];
    t.dt_limit = a->dt_limit;
    t.data = data;
    kit_arrays now = {.dt_limit = 0};
    int failed = 1;
    if (copy_state(s, NULL, &now) && set_state(&t, a)) {
        failed = verb->run(&t);
        if (!set_state(&t, &now)) failed = 1;
    }
    free(now.state);
    a->dt_limit = t.dt_limit;
    return failed;
}

bool kit_same(const mps_stage *s, const mps_verb *verb, const kit_arrays *a)
{
    if (memcmp(&a->dt_limit, &s->dt_limit, sizeof a->dt_limit) != 0) return false;
    for (int32_t u = 0; u < verb->use_count; u++)
        if (a->of[u] &&
            memcmp(a->of[u], s->data[u], kit_bytes(kit_shape_of(&verb->uses[u]), s->view->n)) != 0)
            return false;
    return true;
}

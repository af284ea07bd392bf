/* SPDX-License-Identifier: BSD-3-Clause */
/* A model on one rank and on two: the same bytes after each step. */
#include "kit_engine.h"
#include "model_scenes.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RANKS = 2, TEXT = 512 };

/* A run: the states after each step, and how it ended on each rank. */
typedef struct run {
    const kit_case *scene;
    kit_engine_team *team; /* NULL: one rank */
    int steps;
    kit_state *state; /* [steps] */
    mps_status status[RANKS];
    char text[RANKS][TEXT];
} run;

/* All particles of all ranks, as rank 0 sees them. */
static mps_status take_state(mps_sim *sim, int32_t rank, kit_state *state)
{
    mps_status status = mps_particles_collect(sim);
    if (status < 0) return status;
    if (rank == 0 && !kit_state_get(sim, state)) status = MPS_E_NOMEM;
    const mps_status end = mps_particles_collect_end(sim);
    return status < 0 ? status : end;
}

static void run_rank(void *argument, int32_t rank)
{
    run *r = argument;
    kit_case c = *r->scene;
    mps_sim *sim = NULL;
    mps_ranks_ops ops;
    if (r->team) {
        ops = kit_engine_ops(r->team, rank);
        c.ranks = &ops;
    }
    mps_status status = kit_open(&c, &sim);
    for (int k = 0; k < r->steps && status >= 0; k++) {
        status = kit_steps(sim, 1);
        if (status >= 0) status = take_state(sim, rank, &r->state[k]);
    }
    r->status[rank] = status;
    if (status < 0) snprintf(r->text[rank], TEXT, "%s", sim ? mps_sim_error(sim) : "no handle");
    mps_sim_destroy(sim);
}

/* @return NULL, or the text of the rank that failed first */
static const char *execute(run *r, int32_t ranks)
{
    const char *text = NULL;
    if (ranks > 1) r->team = kit_engine_create(ranks, 0);
    if (r->team)
        kit_engine_run(r->team, run_rank, r);
    else
        run_rank(r, 0);
    if (r->team) kit_engine_destroy(r->team);
    for (int32_t k = 0; k < ranks; k++)
        if (r->status[k] < 0 && (!text || r->status[k] != MPS_E_RANKS)) text = r->text[k];
    return text;
}

/* First particle whose field differs. @return its row, or -1 */
static int64_t first_difference(const kit_state *a, const kit_state *b, int32_t field)
{
    const kit_field *f = &a->field[field];
    for (int64_t i = 0; i < a->n; i++)
        if (memcmp(a->data + i * a->stride + f->first, b->data + i * a->stride + f->first,
                   (size_t)f->components * sizeof *a->data) != 0)
            return i;
    return -1;
}

static const char hint[] =
    "usual reasons: a sum without mps_stage_sum(); scratch read at neighbours without "
    "mps_stage_refresh(); a channel read at neighbours without MPS_USE_NEIGHBOURS; a look beyond "
    "the far radius without 'reach' of the table";

/* Prefers a channel of a model to what follows from it. @return KIT_RANKS */
static int say_difference(const kit_case *c, const kit_state *a, const kit_state *b, int step)
{
    int32_t field = -1;
    int64_t row = -1;
    if (a->n != b->n || a->stride != b->stride ||
        memcmp(a->id, b->id, (size_t)a->n * sizeof *a->id) != 0)
        return kit_print(c->ops, KIT_RANKS,
                         "preset %s, %d-D, step %d: two ranks have other particles than one: %lld "
                         "and %lld; %s",
                         c->preset, (int)c->dim, step, (long long)b->n, (long long)a->n, hint);
    for (int32_t k = 0; k < a->fields; k++) {
        const int64_t found = first_difference(a, b, k);
        if (found < 0 || (field >= 0 && (a->field[field].own || !a->field[k].own))) continue;
        field = k;
        row = found;
    }
    if (field < 0) return 0;
    const kit_field *f = &a->field[field];
    const double *one = a->data + row * a->stride + f->first,
                 *two = b->data + row * a->stride + f->first;
    int32_t d = 0;
    while (d + 1 < f->components && memcmp(&one[d], &two[d], sizeof *one) == 0) d++;
    return kit_print(c->ops, KIT_RANKS,
                     "preset %s, %d-D, step %d: two ranks give other bytes than one: channel '%s', "
                     "component %d of particle %lld is %.17g, not %.17g; %s",
                     c->preset, (int)c->dim, step, f->name, (int)d, (long long)a->id[row], two[d],
                     one[d], hint);
}

static int compare(const kit_case *c, run *one, run *two)
{
    const char *text = execute(one, 1);
    if (!text) text = execute(two, RANKS);
    if (text && strstr(text, "works on one rank only")) return 0;
    if (text)
        return kit_print(c->ops, KIT_RANKS, "preset %s, %d-D, on %d ranks: %s", c->preset,
                         (int)c->dim, two->team ? RANKS : 1, text);
    int failed = 0;
    for (int k = 0; k < one->steps && !failed; k++)
        if (!kit_state_same(&one->state[k], &two->state[k]))
            failed = say_difference(c, &one->state[k], &two->state[k], k + 1);
    return failed;
}

int kit_compare_ranks(const kit_case *scene, int steps)
{
    run one = {.scene = scene, .steps = steps}, two = one;
    int failed = KIT_RANKS;
    if (scene->nonlinear) return 0; /* its solver works on one rank only */
    one.state = calloc((size_t)steps, sizeof *one.state);
    two.state = calloc((size_t)steps, sizeof *two.state);
    if (one.state && two.state) failed = compare(scene, &one, &two);
    for (int k = 0; k < steps; k++) {
        if (one.state) kit_state_free(&one.state[k]);
        if (two.state) kit_state_free(&two.state[k]);
    }
    free(one.state);
    free(two.state);
    return failed;
}

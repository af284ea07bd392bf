/* SPDX-License-Identifier: BSD-3-Clause */
/* Forces of solids that verbs reported in a step: their work, and their contribution to force
 * probes. */
#include "step.h"
#include <string.h>

enum { PLACES = MPS__REACTIONS * 6 };

/* The sums of mps__reactions: forces and moments of all ranks. */
static void find_values(mps__world *w, int32_t places, double *value)
{
    mps_exact *sum = w->runner.reactions.sum[0];
    mps__ranks_sum(w->ghosts.ranks, 6 * places, sum);
    for (int32_t k = 0; k < 6 * places; k++) value[k] = mps_exact_value(&sum[k]);
}

/* Rotate a vector of the lab into the frame of the tank. */
static void to_tank(const mps__pose *pose, const double *v, double *V)
{
    for (int d = 0; d < 3; d++) {
        V[d] = 0;
        for (int e = 0; e < 3; e++) V[d] += pose->rotation[e * 3 + d] * v[e];
    }
}

/* Kinetic energy of the fluid besides that of the particles is not a loss. Changes between steps
 * are due to particles and models added or removed. */
static void book_kinetic(const mps__reactions *r, double *const line[MPS__LINES], mps__budget *b)
{
    double before = 0, now = 0;
    for (int k = 0; k < MPS__LINES; k++) {
        *line[k] -= r->kinetic[k] - r->kinetic_before[k];
        before += r->kinetic_before[k];
        now += r->kinetic[k];
    }
    b->added += before - b->layers;
    b->layers = now;
}

static void add_reactions(void *step, const double *given)
{
    mps__step *q = step;
    mps__world *w = q->w;
    mps__budget *b = &q->next.budget;
    mps__reactions *r = &w->runner.reactions;
    double *const line[MPS__LINES] = {[MPS__LINE_VISCOUS] = &b->viscous,
                                      [MPS__LINE_COLLISION] = &b->collision,
                                      [MPS__LINE_FRICTION] = &b->friction,
                                      [MPS__LINE_PLUGINS] = &b->plugins};
    const int32_t places = MPS__REACTION_WHOLE + 1 + w->particles.parts;
    double found[PLACES];
    const double *value = given ? given : found;
    memset(q->next.reaction, 0, sizeof q->next.reaction);
    book_kinetic(r, line, b);
    if (!r->any) return;
    if (!given) find_values(w, places, found);
    for (int k = 0; k < MPS__LINES; k++) {
        const double *sum = value + 6 * k,
                     work = mps__budget_tank_work(w, &q->pose, sum, q->view.dt);
        *line[k] += work;
        b->wall_work_momentum += work;
        b->wall_work_probes += work;
        for (int d = 0; d < w->setup.dim; d++) b->momentum.reaction[d] += q->view.dt * sum[d];
    }
    for (int32_t k = 0; k <= w->particles.parts; k++) {
        const double *sum = value + 6 * (MPS__REACTION_WHOLE + k);
        to_tank(&w->motion.now, sum, q->next.reaction[k].force);
        to_tank(&w->motion.now, sum + 3, q->next.reaction[k].moment);
    }
}

/* Added in a fixed order among the parts of the budget: sums of doubles depend on it. */
static mps_status book_reactions(mps_stage *s)
{
    mps__step *q = mps__step_of(s);
    mps__runner_reactions_deferred(&q->w->runner, (mps__then){add_reactions, q});
    return MPS_OK;
}

const mps__pass mps__pass_book_reactions = {.name = "book_reactions",
                                            .hook = MPS_VELOCITY,
                                            .place = MPS__AFTER_MODELS,
                                            .stage = MPS_STAGE_CORRECT,
                                            .device = true,
                                            .run = book_reactions};

/* SPDX-License-Identifier: BSD-3-Clause */
/* The stage of a step: what verbs see, the arrays of the library's channels, and their first values. */
#include "operators.h"
#include "step.h"

/* ---- what verbs see ---- */

static void set_arrays(mps__world *w)
{
    mps__particles *s = &w->particles;
    mps__work *k = &w->work;
    void *const array[MPS__OWN_CHANNELS] = {
        [MPS__VELOCITY] = s->u,
        [MPS__PRESSURE] = s->p,
        [MPS__DENSITY] = s->rho,
        [MPS__NUMBER_DENSITY] = s->nd,
        [MPS__REGION] = s->region,
        [MPS__TANK_ACCELERATION] = k->tank_acceleration,
        [MPS__VOLUME_DEVIATION] = k->volume_deviation,
        [MPS__ASYMMETRY] = k->asymmetry,
        [MPS__PRESSURE_DENSITY] = k->pressure_density,
        [MPS__ACCELERATION] = k->motion,
        [MPS__DISPLACEMENT] = k->motion,
        [MPS__PRESSURE_SOURCE] = k->source,
        [MPS__PRESSURE_SHIFT] = k->shift,
        [MPS__PRESSURE_VALUE] = k->value,
        [MPS__PRESSURE_CONDITION] = k->condition,
        [MPS__GAS_SHIFT] = k->gas,
        [MPS__GAS_LAW] = k->law,
        [MPS__WALL_PRESSURE] = k->load,
    };
    for (int32_t c = 0; c < MPS__OWN_CHANNELS; c++) w->channels.list[c].array = array[c];
}

/* A channel that a model may bring; NULL if none does. */
static const double *brought(mps__world *w, const char *name)
{
    const int32_t k = mps__channels_find(&w->channels, name);
    return k >= 0 ? mps__channels_array(&w->channels, &w->particles, k) : NULL;
}

static void set_flux(mps__step *q)
{
    mps__world *w = q->w;
    q->flux = (mps_flux){.struct_size = sizeof q->flux,
                         .kind = w->particles.kind,
                         .phase = w->particles.phase,
                         .density = w->work.pressure_density,
                         .distance = brought(w, "interface_distance"),
                         .jump = brought(w, "pressure_jump"),
                         .wetted = brought(w, "wetted_share"),
                         .tank_acceleration = w->work.tank_acceleration,
                         .g = {w->setup.g[0], w->setup.g[1], w->setup.g[2]}};
}

static void set_terms(mps__step *q)
{
    const mps__world *w = q->w;
    const mps__work *k = &w->work;
    q->terms = (mps__ppe_terms){
        .equation = {.struct_size = sizeof(mps_equation), .radius = MPS_FAR, .gain = 1.0},
        .flux = &q->flux,
        .region = w->particles.region,
        .density = w->particles.rho,
        .pressure = w->particles.p,
        .source = k->source,
        .shift = k->shift,
        .value = k->value,
        .gas = k->gas,
        .law = k->law,
        .condition = k->condition};
}

void mps__step_open(mps__step *q)
{
    mps__world *w = q->w;
    const mps__particles *s = &w->particles;
    q->stage = (mps_stage){.struct_size = sizeof q->stage,
                           .dim = w->setup.dim,
                           .n = s->n,
                           .step = w->state.step + 1,
                           .t = w->state.t,
                           .dp = w->setup.dp,
                           .velocity_scale = w->setup.velocity_scale,
                           .g = {w->setup.g[0], w->setup.g[1], w->setup.g[2]},
                           .kind = s->kind,
                           .phase = s->phase,
                           .id = s->id,
                           .x = s->x,
                           .area = w->work.area,
                           .wall_of = s->wall_of,
                           .near = &q->near,
                           .far = &q->far,
                           .viscosity = w->setup.phase_viscosity,
                           .tension = w->setup.tension};
    for (int p = 0; p < MPS__PHASES; p++) q->stage.phases += w->setup.phase_defined[p];
    set_arrays(w);
    set_flux(q);
    set_terms(q);
}

mps_status mps__step_run(mps__step *q, int32_t moment)
{
    q->flux.wall_factor = q->terms.equation.wall_factor;
    q->flux.body = q->terms.equation.body;
    q->stage.flux = moment >= MPS_FORCE ? &q->flux : NULL;
    q->stage.equation = moment >= MPS_CLASSIFY && moment <= MPS_SOURCE ? &q->terms.equation : NULL;
    const mps_status status = mps__host_run(&q->w->host, &q->stage, moment);
    q->flux.body = q->terms.equation.body;
    return status;
}

/* ---- first values ---- */

/* Weights of the near pairs, and their rows without gaps; where the radii are equal the far rows are the same. */
static void weigh_pairs(mps__step *q)
{
    const mps__world *w = q->w;
    const mps_neighbours *l = &w->lists.neighbours;
    mps__op_weigh(&q->near, &(mps__weighed){.begin = l->near_begin,
                                            .col = l->near_col,
                                            .w_r2 = l->w_r2,
                                            .idle = l->idle,
                                            .n = w->particles.nd,
                                            .a = w->work.asymmetry});
    q->near.begin = l->near_begin;
    q->near.end = l->near_begin + 1;
    q->near.col = l->near_col;
    if (q->near.re == q->far.re) q->far = q->near;
    q->near.w_r2 = l->w_r2;
}

static void begin_rows(void *world, int64_t begin, int64_t end)
{
    mps__world *w = world;
    mps__particles *s = &w->particles;
    for (int64_t i = begin; i < end; i++) {
        s->region[i] = s->kind[i] == MPS_DUMMY ? MPS_REGION_DRY : MPS_REGION_INNER;
        w->work.pressure_density[i] = s->rho[i];
    }
    mps__channels_begin(&w->channels, begin, end);
}

/* Sums over pairs are those of owners; all else begins alike at ghosts. */
static void note_ghosts(mps__world *w)
{
    static const int32_t alike[] = {MPS__REGION, MPS__TANK_ACCELERATION, MPS__PRESSURE_DENSITY};
    static const int32_t written[] = {MPS__NUMBER_DENSITY, MPS__ASYMMETRY, MPS__VOLUME_DEVIATION};
    for (int32_t k = MPS__OWN_CHANNELS; k < w->channels.count; k++)
        w->channels.list[k].stale = false; /* those that are fields have flags of their own */
    for (int k = 0; k < 3; k++) {
        mps__host_alike(&w->host, alike[k]);
        mps__host_written(&w->host, written[k]);
    }
}

mps_status mps__step_begin(mps__step *q)
{
    mps__world *w = q->w;
    weigh_pairs(q);
    MPS__TRY(mps_op_volume_deviation(&q->far, w->work.volume_deviation));
    mps_parallel_rows(&w->pool.parallel, w->particles.n, begin_rows, w);
    note_ghosts(w);
    return MPS_OK;
}

static void begin_equation_rows(void *terms, int64_t begin, int64_t end)
{
    const mps__ppe_terms *t = terms;
    for (int64_t i = begin; i < end; i++) {
        t->source[i] = t->shift[i] = t->value[i] = t->gas[i] = t->law[i] = 0;
        t->condition[i] = t->region[i] == MPS_REGION_SURFACE ? MPS_ROW_FIXED : MPS_ROW_FREE;
    }
}

void mps__step_begin_equation(mps__step *q)
{
    mps__world *w = q->w;
    mps_parallel_rows(&w->pool.parallel, w->particles.n, begin_equation_rows, &q->terms);
    for (int32_t k = MPS__PRESSURE_SOURCE; k <= MPS__GAS_LAW; k++) mps__host_alike(&w->host, k);
    if (*mps__channels_stale(&w->channels, &w->particles, MPS__REGION))
        mps__host_written(&w->host, MPS__PRESSURE_CONDITION);
}

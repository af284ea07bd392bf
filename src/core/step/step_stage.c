/* SPDX-License-Identifier: BSD-3-Clause */
/* The stage of a step: view and channels for verbs, and first values of the library's channels. */
#include "operators.h"
#include "step.h"
#include <string.h>

/* ---- the view ---- */

/* Scalars of the equation are numbers of the step. */
static void set_scalars(mps__step *q)
{
    mps__channel *list = q->w->channels.list;
    mps__equation *e = &q->terms.equation;
    *e = (mps__equation){.radius = MPS_FAR, .gain = 1.0};
    list[MPS__EQUATION_RADIUS].array.host = &e->radius;
    list[MPS__EQUATION_COMPLETE].array.host = &e->complete_surface;
    list[MPS__EQUATION_BODY].array.host = &e->body;
    list[MPS__EQUATION_WALL_FACTOR].array.host = &e->wall_factor;
    list[MPS__EQUATION_GAIN].array.host = &e->gain;
}

static void *array_of(mps__world *w, int32_t channel)
{
    return mps__channels_array(&w->channels, &w->particles, channel);
}

/* An optional channel of a model; NULL: no model has it. */
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
                         .density = array_of(w, MPS__PRESSURE_DENSITY),
                         .distance = brought(w, "interface_distance"),
                         .jump = brought(w, "pressure_jump"),
                         .wetted = brought(w, "wetted_share"),
                         .tank_acceleration = array_of(w, MPS__TANK_ACCELERATION),
                         .g = {w->setup.g[0], w->setup.g[1], w->setup.g[2]}};
}

static void set_terms(mps__step *q)
{
    mps__world *w = q->w;
    q->terms = (mps__ppe_terms){.flux = &q->flux,
                                .region = w->particles.region,
                                .density = w->particles.rho,
                                .pressure = w->particles.p,
                                .source = array_of(w, MPS__PRESSURE_SOURCE),
                                .shift = array_of(w, MPS__PRESSURE_SHIFT),
                                .value = array_of(w, MPS__PRESSURE_VALUE),
                                .gas = array_of(w, MPS__GAS_SHIFT),
                                .law = array_of(w, MPS__GAS_LAW),
                                .condition = array_of(w, MPS__PRESSURE_CONDITION)};
    set_scalars(q);
    w->ppe.spare = array_of(w, MPS__UNKNOWN_NUMBERS);
    w->ppe.spare_x = array_of(w, MPS__UNKNOWN_PLACES);
}

/* Fluxes of pairs are complete from MPS_FORCE on; models may change their scalars until
 * MPS_SOURCE. */
static void show_flux(mps__step *q, const mps__call *call)
{
    q->flux.wall_factor = q->terms.equation.wall_factor;
    q->flux.body = q->terms.equation.body;
    q->view.flux = call->hook >= MPS_FORCE ? q->flux : (mps_flux){.struct_size = sizeof q->flux};
}

/* Effects of plug-ins and friction have budget lines of their own. */
static void note_line(mps__step *q, const mps__call *call)
{
    const int32_t line = mps__runner_line(&q->w->runner, call);
    const bool same_hook = q->line_hook == call->hook, goes_on = same_hook && q->line == line;
    if (same_hook && !goes_on && q->line != MPS__LINE_OF_HOOK) mps__step_book_line(q, true);
    q->line = line;
    q->line_hook = call->hook;
    if (line != MPS__LINE_OF_HOOK && !goes_on) mps__step_book_line(q, false);
}

static void before_call(void *step, const mps__call *call)
{
    show_flux(step, call);
    note_line(step, call);
}

static void open_stage(mps__step *q)
{
    mps__world *w = q->w;
    q->stage = (mps_stage){.struct_size = sizeof q->stage, .step = w->state.step + 1};
    mps__world_view(w, &q->view);
    set_flux(q);
    set_terms(q);
    w->voids.ready = false;
    w->runner.densities.agreed = false; /* particles were added or removed since MPS_POPULATE */
    q->line = MPS__LINE_OF_HOOK;
    w->runner.step = q;
    w->runner.before_call = before_call;
    memset(&w->runner.reactions, 0, sizeof w->runner.reactions);
    w->runner.gas = (mps__gas){0};
}

mps_status mps__step_open(mps__step *q)
{
    mps__world *w = q->w;
    mps__runner *h = &w->runner;
    MPS__TRY(mps__step_rotate_areas(w));
    MPS__TRY(mps__step_place_solids(w));
    /* a user's kernel function has no device code */
    if (w->setup.kernel.id != MPS_KERNEL_CUSTOM) MPS__TRY(mps__memory_open(&h->memory, &h->plan));
    MPS__TRY(mps__world_mirror_lists(w));
    mps__step_find_areas(w);
    open_stage(q);
    mps__runner_log_spaces(h);
    MPS__TRY(mps__world_stencil(w, MPS_NEAR, &q->view.near));
    MPS__TRY(mps__world_stencil(w, MPS_FAR, &q->view.far));
    mps__runner_book(h, MPS__OPEN);
    return MPS_OK;
}

mps_status mps__step_run(mps__step *q, int32_t hook)
{
    return mps__runner_run(&q->w->runner, &q->stage, &q->view, hook);
}

/* ---- first values ---- */

/* Weights of the near pairs, and compact near rows; if the radii are equal the far rows are the
 * same. */
static mps_status weigh_pairs(mps_stage *s)
{
    mps__step *q = mps__step_of(s);
    mps__memory *t = &q->w->runner.memory;
    const mps_neighbours *l = &q->w->lists.neighbours;
    mps_stencil *near = &q->view.near;
    mps__op_weigh(
        &s->view->near,
        &(mps__weighed){.begin = mps__memory_list_seen(t, MPS__NEAR_BEGIN, l->near_begin),
                        .col = mps__memory_list_given(t, MPS__NEAR_COLUMNS, l->near_col, true),
                        .w_r2 = mps__memory_list_given(t, MPS__NEAR_WEIGHTS, l->w_r2, true),
                        .idle = mps__memory_list_seen(t, MPS__IDLE_ROWS, l->idle),
                        .n = s->data[0],
                        .a = s->data[1]});
    near->begin = l->near_begin;
    near->end = l->near_begin + 1;
    near->col = l->near_col;
    if (near->re == q->view.far.re) q->view.far = *near;
    near->w_r2 = l->w_r2;
    return MPS_OK;
}

static const mps_use weight_uses[] = {{"number_density", MPS_USE_CHANGE},
                                      {"asymmetry", MPS_USE_WRITE | MPS__USE_BEGIN}};

const mps__pass mps__pass_weights = {.name = "weights",
                                     .hook = MPS_CLASSIFY,
                                     .stage = MPS_STAGE_OPERATORS,
                                     .device = true,
                                     .use_count = 2,
                                     .uses = weight_uses,
                                     .run = weigh_pairs};

static mps_status find_volumes(mps_stage *s)
{
    return mps_op_volume_deviation(&s->view->far, s->data[0]);
}

static const mps_use volume_uses[] = {{"volume_deviation", MPS_USE_WRITE | MPS__USE_BEGIN}};

const mps__pass mps__pass_volumes = {.name = "volumes",
                                     .hook = MPS_CLASSIFY,
                                     .stage = MPS_STAGE_OPERATORS,
                                     .device = true,
                                     .use_count = 1,
                                     .uses = volume_uses,
                                     .run = find_volumes};

typedef struct first_fields {
    const double *density;
    double *pressure_density;
    int32_t *region;
} first_fields;

MPS_ROW void begin_row(const int dim, const mps_view *v, const first_fields *f, int64_t i)
{
    (void)dim;
    f->region[i] = mps_is_dummy(v, i) ? MPS_REGION_DRY : MPS_REGION_INNER;
    f->pressure_density[i] = f->density[i];
}
MPS_ROWS(begin_rows, begin_row, first_fields)

static mps_status set_first_values(mps_stage *s)
{
    mps_stage_rows(s, &begin_rows, &(first_fields){s->data[0], s->data[1], s->data[2]});
    return MPS_OK;
}

static const mps_use first_uses[] = {{"density", MPS_USE_READ},
                                     {"pressure_density", MPS_USE_WRITE | MPS__USE_BEGIN},
                                     {"region", MPS_USE_WRITE}};

const mps__pass mps__pass_first_values = {.name = "first_values",
                                          .hook = MPS_CLASSIFY,
                                          .stage = MPS_STAGE_OPERATORS,
                                          .with_ghosts = true,
                                          .device = true,
                                          .use_count = 3,
                                          .uses = first_uses,
                                          .run = set_first_values};

/* ---- first values of the pressure equation ---- */

enum { SOURCE, SHIFT, VALUE, GAS, LAW, TERMS };
static const mps_use term_uses[TERMS] = {
    [SOURCE] = {"pressure_source", MPS_USE_WRITE | MPS__USE_BEGIN},
    [SHIFT] = {"pressure_shift", MPS_USE_WRITE | MPS__USE_BEGIN},
    [VALUE] = {"pressure_value", MPS_USE_WRITE | MPS__USE_BEGIN},
    [GAS] = {"gas_shift", MPS_USE_WRITE | MPS__USE_BEGIN},
    [LAW] = {"gas_law", MPS_USE_WRITE | MPS__USE_BEGIN}};

static mps_status clear_equation(mps_stage *s)
{
    mps__block terms[TERMS];
    for (int k = 0; k < TERMS; k++) terms[k] = (mps__block){s->data[k], s->view->n};
    mps__parallel_zero(&mps__step_of(s)->w->pool.parallel, terms, TERMS);
    return MPS_OK;
}

const mps__pass mps__pass_clear_equation = {.name = "clear_equation",
                                            .hook = MPS_SOURCE,
                                            .stage = MPS_STAGE_OPERATORS,
                                            .with_ghosts = true,
                                            .device = true,
                                            .use_count = TERMS,
                                            .uses = term_uses,
                                            .run = clear_equation};

typedef struct condition_fields {
    const int32_t *region;
    int32_t *condition;
} condition_fields;

MPS_ROW void condition_row(const int dim, const mps_view *v, const condition_fields *f, int64_t i)
{
    (void)dim, (void)v;
    f->condition[i] = f->region[i] == MPS_REGION_SURFACE ? MPS_ROW_FIXED : MPS_ROW_FREE;
}
MPS_ROWS(condition_rows, condition_row, condition_fields)

static mps_status set_first_conditions(mps_stage *s)
{
    mps_stage_rows(s, &condition_rows, &(condition_fields){s->data[0], s->data[1]});
    return MPS_OK;
}

static const mps_use condition_uses[] = {{"region", MPS_USE_READ},
                                         {"pressure_condition", MPS_USE_WRITE | MPS__USE_BEGIN}};

const mps__pass mps__pass_first_conditions = {.name = "first_conditions",
                                              .hook = MPS_SOURCE,
                                              .stage = MPS_STAGE_OPERATORS,
                                              .with_ghosts = true,
                                              .device = true,
                                              .use_count = 2,
                                              .uses = condition_uses,
                                              .run = set_first_conditions};

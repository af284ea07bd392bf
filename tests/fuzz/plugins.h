/* SPDX-License-Identifier: BSD-3-Clause */
/* Plug-ins that return random numbers, taken from the bytes of the input; for fuzz_api.c. */
#ifndef PLUGINS_H
#define PLUGINS_H

#include "fuzz.h"
#include <mps/model.h>
#include <mps/ppe.h>

enum { USES = 4, MODELS = 3, SCALAR = 99 };

/* The input of the run, for the plug-ins. */
static fuzz_input *input;

static const struct {
    const char *name;
    int components; /* 0: dim */
    int whole;
} channels[] = {{"velocity", 0, 0},
                {"pressure", 1, 0},
                {"region", 1, 1},
                {"number_density", 1, 0},
                {"volume_deviation", 1, 0},
                {"pressure_density", 1, 0},
                {"acceleration", 0, 0},
                {"displacement", 0, 0},
                {"pressure_source", 1, 0},
                {"pressure_shift", 1, 0},
                {"pressure_condition", 1, 1},
                {"pressure_value", 1, 0},
                {"gas_shift", 1, 0},
                {"gas_law", 1, 0},
                {"wall_pressure", 1, 0},
                {"tank_acceleration", 0, 0},
                {"wetted_share", 1, 0},
                {"mine", 2, 0},
                {"ours", 1, 1},
                {"asymmetry", 0, 0},
                {"solid_place", 0, 0},
                {"solid_area", 0, 0},
                {"equation_gain", SCALAR, 0},
                {"equation_wall_factor", SCALAR, 0},
                {"equation_radius", SCALAR, 1},
                {"equation_body", SCALAR, 1},
                {"equation_complete", SCALAR, 1}};

enum { CHANNELS = sizeof channels / sizeof channels[0] };

typedef struct garbage_model {
    char name[24];
    mps_channel channel[2];
    mps_use use[USES];
    int which[USES];
    mps_verb verb;
    mps_setting setting;
} garbage_model;

static garbage_model models[MODELS];

/* Numbers into some rows of the arrays that the verb writes. */
static inline int run_garbage(mps_stage *s)
{
    const garbage_model *m = s->self;
    for (int k = 0; k < m->verb.use_count; k++) {
        const int per = channels[m->which[k]].components ? channels[m->which[k]].components
                                                         : s->view->dim;
        if (!(m->use[k].access & MPS_USE_WRITE) || !s->data[k]) continue;
        for (int tries = fuzz_pick(input, 4); tries >= 0; tries--) {
            const int64_t numbers = per == SCALAR ? 1 : s->view->n * per,
                          at = (int64_t)(fuzz_byte(input) * 37 % (uint64_t)numbers);
            if (channels[m->which[k]].whole)
                ((int32_t *)s->data[k])[at] = (int32_t)fuzz_whole(input);
            else
                ((double *)s->data[k])[at] = fuzz_real(input, 10);
        }
    }
    if (s->hook == MPS_LIMIT) s->dt_limit = fuzz_real(input, 1e-3);
    const unsigned end = fuzz_byte(input);
    if (end == 254) mps_stage_scratch(s, fuzz_whole(input));
    if (end == 253) {
        mps_grid grid;
        mps_stage_grid(s, fuzz_real(input, 1), &grid);
    }
    return end == 255 ? mps_stage_fail(s, "garbage") : end == 252;
}

/* Tables must stay as they are while a handle has them: each is filled once per input. */
static inline void fill_model(fuzz_input *in, garbage_model *m, int k)
{
    snprintf(m->name, sizeof m->name, "garbage%d.any", k);
    m->channel[0] = (mps_channel){"mine", "-", "any", 2, MPS_TYPE_REAL, fuzz_byte(in) % 2, 0};
    m->channel[1] = (mps_channel){"ours", "-", "any", 1, MPS_TYPE_INTEGER, MPS_LIFE_STEP, 0};
    m->verb = (mps_verb){.hook = fuzz_byte(in) % (MPS_HOOK_COUNT + 1),
                         .use_count = fuzz_pick(in, USES + 1),
                         .uses = m->use,
                         .run = run_garbage};
    for (int u = 0; u < m->verb.use_count; u++) {
        m->which[u] = fuzz_pick(in, CHANNELS);
        m->use[u] = (mps_use){channels[m->which[u]].name, fuzz_byte(in) % 64};
    }
    if (fuzz_byte(in) > 250) m->verb.after = "*";
    m->setting = (mps_setting){"any", "-", "any", MPS_TYPE_REAL, 0, -1, 1};
}

static inline void register_model(fuzz_input *in, mps_sim *sim, int k)
{
    garbage_model *m = &models[k];
    if (!m->name[0]) fill_model(in, m, k);
    const mps_model_ops ops = {.struct_size = sizeof ops,
                               .api = MPS_MODEL_API,
                               .name = m->name,
                               .help = "any",
                               .setting_count = 1,
                               .channel_count = 2,
                               .verb_count = 1,
                               .settings = &m->setting,
                               .channels = m->channel,
                               .verbs = &m->verb,
                               .user = m};
    if (fuzz_status(sim, mps_model_register(sim, &ops)) == MPS_OK)
        fuzz_status(sim, mps_model_use(sim, m->name));
}

static inline int create_nothing(const mps_allocator *allocator, void **self)
{
    (void)allocator;
    (void)self;
    return fuzz_byte(input) == 255;
}

static inline void destroy_nothing(const mps_allocator *allocator, void *self)
{
    (void)allocator, (void)self;
}

static inline void solve_garbage(void *self, const mps_ppe_problem *problem,
                                 const mps_preconditioner_ops *pc, void *pc_self, double *p,
                                 mps_ppe_result *result)
{
    (void)self;
    if (pc && fuzz_byte(input) > 128 && pc->setup(pc_self, problem) == MPS_PPE_CONVERGED)
        pc->apply(pc_self, problem->rhs, p);
    for (int tries = fuzz_pick(input, 4); tries > 0; tries--)
        p[fuzz_byte(input) * 37 % problem->n] = fuzz_real(input, 1000);
    *result = (mps_ppe_result){result->struct_size,        (int32_t)(fuzz_byte(input) % 8) - 1,
                               (int32_t)fuzz_whole(input), 0,
                               fuzz_real(input, 1e-6),     fuzz_real(input, 1e-4),
                               fuzz_real(input, 1)};
    if (fuzz_byte(input) < 128) result->reason = MPS_PPE_CONVERGED;
}

static inline int setup_garbage(void *self, const mps_ppe_problem *problem)
{
    (void)self;
    (void)problem;
    return fuzz_byte(input) > 200 ? (int)fuzz_whole(input) : MPS_PPE_CONVERGED;
}

static inline int apply_garbage(void *self, const double *r, double *z)
{
    (void)self;
    z[0] = fuzz_real(input, 1) * r[0];
    return fuzz_byte(input) > 240 ? (int)fuzz_whole(input) : MPS_PPE_CONVERGED;
}

static inline void use_solver(fuzz_input *in, mps_sim *sim)
{
    static const char *const solvers[] = {"sundials.pcg", "sundials.bicgstab", "sundials.gmres",
                                          "sundials.klu", "sundials.kinsol",   "garbage"};
    static const char *const pcs[] = {NULL, "none", "jacobi", "ic0", "auxgrid", "garbage"};
    const mps_solver_ops solver = {.struct_size = sizeof solver,
                                   .api = MPS_PPE_API,
                                   .name = "garbage",
                                   .preconditioner = "jacobi",
                                   .nonlinear = fuzz_byte(in) % 2,
                                   .create = create_nothing,
                                   .solve = solve_garbage,
                                   .destroy = destroy_nothing};
    const mps_preconditioner_ops pc = {.struct_size = sizeof pc,
                                       .api = MPS_PPE_API,
                                       .name = "garbage",
                                       .symmetric = fuzz_byte(in) % 2,
                                       .create = create_nothing,
                                       .setup = setup_garbage,
                                       .apply = apply_garbage,
                                       .destroy = destroy_nothing};
    mps_solver_limits limits;
    fuzz_status(sim, mps_solver_register(sim, &solver));
    fuzz_status(sim, mps_preconditioner_register(sim, &pc));
    fuzz_status(sim, mps_solver_use(sim, solvers[fuzz_pick(in, 6)], pcs[fuzz_pick(in, 6)]));
    mps_solver_limits_init(&limits, sizeof limits);
    if (fuzz_byte(in) > 200) {
        limits.max_iterations = fuzz_pick(in, 200);
        limits.tolerance = fuzz_real(in, 1e-3);
        limits.divergence = fuzz_real(in, 1e-3);
        fuzz_status(sim, mps_solver_limits_set(sim, &limits));
    }
}

static inline int move_garbage(void *user, double t, mps_motion_state *state)
{
    (void)user;
    (void)t;
    state->value[fuzz_pick(input, MPS_DOF_COUNT)] = fuzz_real(input, 0.01);
    state->rate[fuzz_pick(input, MPS_DOF_COUNT)] = fuzz_real(input, 0.1);
    return fuzz_byte(input) == 255;
}

#endif

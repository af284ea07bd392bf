/* SPDX-License-Identifier: BSD-3-Clause */
/* Every public function that changes numbers or single fields of a simulation, as a call, with the
 * fields that it writes; and the names of all other functions with a simulation argument. Add a
 * line for a new function to one of the two lists: test_setters.c compares them with the
 * headers. */
#ifndef SHADOW_SETTER_CALLS_H
#define SHADOW_SETTER_CALLS_H

#include "scene.h"
#include <mps/body.h>
#include <mps/couple.h>
#include <mps/operators.h>
#include <mps/ppe.h>

/* ---- calls ----------------------------------------------------------------------------------- */

/* A struct with its first values. */
#define STRUCT(type, name) \
    type name;             \
    assert_int_equal(type##_init(&name, sizeof name), MPS_OK)

static mps_status set_time_control(mps_sim *sim)
{
    STRUCT(mps_time_control, t);
    t.cfl = 0.25;
    return mps_time_control_set(sim, &t);
}

/* The centre is set before the first step only: it is refused, and nothing is copied. */
static mps_status set_centre(mps_sim *sim)
{
    const double centre[3] = {0.1, 0.1, 0.1};
    assert_int_equal(mps_motion_centre_set(sim, centre, MPS_START_AT_REST), MPS_E_STATE);
    return MPS_OK;
}

static mps_status set_kernel(mps_sim *sim)
{
    mps_kernel k = {.struct_size = sizeof k};
    assert_int_equal(mps_kernel_find("original", &k), MPS_OK);
    assert_int_equal(mps_kernel_use(sim, &k), MPS_E_STATE);
    return MPS_OK;
}

static mps_status move_tank(mps_sim *sim)
{
    const mps_harmonic h = {.dof = MPS_MOVE_X, .amplitude = 0.05, .omega = 12};
    return mps_motion_harmonics_set(sim, 1, &h);
}

/* The tank jumps to where the new motion has it, less than a search allows particles to move. */
static mps_status set_harmonics(mps_sim *sim)
{
    const mps_harmonic h = {.dof = MPS_MOVE_X, .amplitude = 5e-4, .omega = 3, .phase = 0.5};
    return mps_motion_harmonics_set(sim, 1, &h);
}

static mps_status set_table(mps_sim *sim)
{
    const double t[] = {-1, 1, 9}, v[] = {1e-4, 3e-4, 2e-4};
    const int32_t dof = MPS_MOVE_Y;
    return mps_motion_table_set(sim, 3, t, 1, &dof, v);
}

static int callback(void *user, double t, mps_motion_state *state)
{
    (void)user;
    state->value[MPS_MOVE_X] = 3e-4 + 1e-3 * t;
    state->rate[MPS_MOVE_X] = 1e-3;
    return 0;
}

static mps_status set_callback(mps_sim *sim)
{
    return mps_motion_callback_set(sim, callback, NULL);
}

/* Where the tank is, at rest at t_end: no particle moves before the step. */
static mps_status set_pose(mps_sim *sim)
{
    STRUCT(mps_motion_state, s);
    double t;
    ASSERT_OK(sim, mps_sim_time(sim, &t, NULL));
    ASSERT_OK(sim, mps_motion_state_get(sim, &s));
    for (int k = 0; k < MPS_DOF_COUNT; k++) s.rate[k] = s.accel[k] = 0;
    return mps_motion_pose_set(sim, t + 0.5, &s);
}

static mps_status watch_force(mps_sim *sim)
{
    return mps_load_watch(sim, MPS_LOAD_FORCE);
}

static mps_status watch_mass(mps_sim *sim)
{
    return mps_load_watch(sim, MPS_LOAD_MASS);
}

static mps_status set_body(mps_sim *sim)
{
    STRUCT(mps_body, b);
    b.free = MPS_BODY_FREE(MPS_MOVE_X);
    b.mass = 100;
    b.stiffness[0] = 4e4;
    b.equilibrium[0] = 0.01;
    return mps_body_set(sim, &b);
}

static mps_status set_density(mps_sim *sim)
{
    STRUCT(mps_phase, p);
    p.density = 990;
    return mps_phase_set(sim, 0, &p);
}

static mps_status set_viscosity(mps_sim *sim)
{
    STRUCT(mps_phase, p);
    p.viscosity = 2e-3;
    return mps_phase_set(sim, 0, &p);
}

static mps_status set_other_phase(mps_sim *sim)
{
    STRUCT(mps_phase, p);
    p.density = 1.2;
    return mps_phase_set(sim, 1, &p);
}

static mps_status set_tension(mps_sim *sim)
{
    return mps_tension_set(sim, 0, 1, 0.07);
}

static mps_status set_threads(mps_sim *sim)
{
    return mps_threads_set(sim, 2);
}

static mps_status use_preset(mps_sim *sim)
{
    return mps_preset_use(sim, "imps");
}

static mps_status use_collision(mps_sim *sim)
{
    return mps_model_use(sim, "collision.pair");
}

static mps_status remove_model(mps_sim *sim)
{
    return mps_model_remove(sim, "collision");
}

static mps_status set_model(mps_sim *sim)
{
    return mps_model_set(sim, "collision", "distance", 0.7);
}

/* A model that brings a field. */
static mps_status use_field_model(mps_sim *sim)
{
    static const mps_channel channel = {
        "warmth", "K", "a field of a test", 1, MPS_TYPE_REAL, MPS_LIFE_PARTICLE, 20};
    static const mps_model_ops ops = {TOY("test.warmth", 1, idle_verbs), .channel_count = 1,
                                      .channels = &channel};
    ASSERT_OK(sim, mps_model_register(sim, &ops));
    return mps_model_use(sim, "test.warmth");
}

static mps_status register_model(mps_sim *sim)
{
    static const mps_model_ops ops = {TOY("test.idle", 1, idle_verbs)};
    return mps_model_register(sim, &ops);
}

static mps_status use_solver(mps_sim *sim)
{
    return mps_solver_use(sim, "sundials.pcg", "auxgrid");
}

static mps_status set_limits(mps_sim *sim)
{
    STRUCT(mps_solver_limits, l);
    l.tolerance = 1e-7;
    return mps_solver_limits_set(sim, &l);
}

static int make_nothing(const mps_allocator *a, void **self)
{
    (void)a, (void)self;
    return 0;
}

static void end_nothing(const mps_allocator *a, void *self)
{
    (void)a, (void)self;
}

static void solve_nothing(void *self, const mps_ppe_problem *problem,
                          const mps_preconditioner_ops *pc, void *pc_self, double *p,
                          mps_ppe_result *result)
{
    (void)self, (void)problem, (void)pc, (void)pc_self, (void)p, (void)result;
}

static int set_up_nothing(void *self, const mps_ppe_problem *problem)
{
    (void)self, (void)problem;
    return 0;
}

static int apply_nothing(void *self, const double *r, double *z)
{
    (void)self, (void)r, (void)z;
    return 0;
}

static mps_status register_solver(mps_sim *sim)
{
    const mps_solver_ops ops = {.struct_size = sizeof ops,
                                .api = MPS_PPE_API,
                                .name = "test",
                                .create = make_nothing,
                                .solve = solve_nothing,
                                .destroy = end_nothing};
    return mps_solver_register(sim, &ops);
}

static mps_status register_preconditioner(mps_sim *sim)
{
    const mps_preconditioner_ops ops = {.struct_size = sizeof ops,
                                        .api = MPS_PPE_API,
                                        .name = "test",
                                        .create = make_nothing,
                                        .setup = set_up_nothing,
                                        .apply = apply_nothing,
                                        .destroy = end_nothing};
    return mps_preconditioner_register(sim, &ops);
}

/* It takes no sample: reading a pressure is what a probe costs, not adding it. */
static mps_status add_probe(mps_sim *sim)
{
    STRUCT(mps_probe, p);
    int32_t id;
    p.at[1] = 0.1;
    p.average = 0;
    return mps_probe_add(sim, &p, &id);
}

static mps_status remove_probe(mps_sim *sim)
{
    return mps_probe_remove(sim, 0);
}

static mps_status add_field(mps_sim *sim)
{
    return mps_field_add(sim, "new", 3);
}

static mps_status write_field(mps_sim *sim, const char *name)
{
    mps_lease l = {.struct_size = sizeof l};
    MPS__TRY(mps_lease_begin(sim, name, MPS_WRITE, &l));
    for (int64_t i = 0; i < l.count * l.stride; i++) l.data[i] += 1e-4 * (double)(i % 7);
    return mps_lease_end(sim, &l);
}

static mps_status write_mark(mps_sim *sim)
{
    return write_field(sim, "mark");
}

static mps_status write_velocity(mps_sim *sim)
{
    return write_field(sim, "velocity");
}

static mps_status write_pressure(mps_sim *sim)
{
    return write_field(sim, "pressure");
}

static mps_status make_snapshot(mps_sim *sim)
{
    mps_snapshot *k = NULL;
    const mps_status status = mps_snapshot_create(sim, &k);
    mps_snapshot_destroy(k);
    return status;
}

static mps_status add_note(mps_sim *sim)
{
    return mps_checkpoint_note_add(sim, "a line");
}

/* Ranks must be set first: with a device it is refused, and nothing is copied. */
static mps_status set_ranks(mps_sim *sim)
{
    const mps_status status = mps_sim_ranks_set(sim, NULL);
    assert_true(status == MPS_E_STATE);
    return MPS_OK;
}

/* ---- the table ------------------------------------------------------------------------------- */

/* Fields that a call writes, and fields that the host reads for it. If the flow changes, the
 * budgets of a step need positions, velocities and densities. */
enum { X = 1, U = 2, RHO = 4, MARK = 8, P = 16, FLOW = X | U | RHO };

typedef struct setter {
    const char *name;
    mps_status (*call)(mps_sim *sim);
    int32_t up, down;
    mps_status (*before)(mps_sim *sim); /* NULL, or done before the steps, with the call or not */
    bool solves; /* the next step solves another problem, and copies what that takes */
} setter;

static const setter setters[] = {
    {"mps_time_control_set", set_time_control, 0, 0, NULL, false},
    {"mps_motion_centre_set", set_centre, 0, 0, NULL, false},
    {"mps_kernel_use", set_kernel, 0, 0, NULL, false},
    {"mps_motion_harmonics_set", set_harmonics, X, FLOW, NULL, false},
    {"mps_motion_table_set", set_table, X, FLOW, NULL, false},
    {"mps_motion_callback_set", set_callback, X, FLOW, NULL, false},
    {"mps_motion_clear", mps_motion_clear, 0, 0, move_tank, false},
    {"mps_motion_pose_set", set_pose, 0, 0, move_tank, false},
    {"mps_load_watch", watch_force, 0, 0, watch_force, false},
    {"mps_load_watch", watch_mass, 0, 0, watch_mass, false},
    {"mps_body_set", set_body, 0, 0, set_body, true},
    {"mps_phase_set", set_density, RHO, FLOW, NULL, false},
    {"mps_phase_set", set_viscosity, 0, 0, NULL, false},
    {"mps_phase_set", set_other_phase, 0, 0, NULL, false},
    {"mps_tension_set", set_tension, 0, 0, set_other_phase, false},
    {"mps_threads_set", set_threads, 0, 0, NULL, false},
    {"mps_preset_use", use_preset, 0, 0, NULL, false},
    {"mps_model_use", use_collision, 0, 0, NULL, false},
    {"mps_model_use", use_field_model, 0, 0, NULL, true},
    {"mps_model_remove", remove_model, 0, 0, NULL, false},
    {"mps_model_set", set_model, 0, 0, NULL, false},
    {"mps_model_register", register_model, 0, 0, NULL, false},
    {"mps_solver_use", use_solver, 0, 0, NULL, false},
    {"mps_solver_limits_set", set_limits, 0, 0, NULL, false},
    {"mps_solver_register", register_solver, 0, 0, NULL, false},
    {"mps_preconditioner_register", register_preconditioner, 0, 0, NULL, false},
    {"mps_probe_add", add_probe, 0, 0, NULL, false},
    {"mps_probe_remove", remove_probe, 0, 0, add_probe, false},
    {"mps_field_add", add_field, 0, 0, NULL, false},
    {"mps_lease_begin", write_mark, MARK, 0, NULL, false},
    {"mps_lease_begin", write_velocity, U, FLOW, NULL, false},
    {"mps_lease_begin", write_pressure, P, P, NULL, false},
    {"mps_snapshot_create", make_snapshot, 0, 0, NULL, false},
    {"mps_checkpoint_note_add", add_note, 0, 0, NULL, false},
    {"mps_sim_ranks_set", set_ranks, 0, 0, NULL, false},
};
enum { SETTERS = sizeof setters / sizeof setters[0] };

/* Functions with other effects: they add or remove particles, replace all fields, detach a device;
 * step; write files; read. mps_plugin_register() and mps_job_*() call functions of the table. */
static const char *const others[] = {
    "mps_particles_add",
    "mps_particles_remove",
    "mps_tank_add",
    "mps_baffle_add",
    "mps_plate_add",
    "mps_fill_box_add",
    "mps_fill_level_add",
    "mps_fill_add",
    "mps_solid_add",
    "mps_stl_add",
    "mps_checkpoint_read",
    "mps_sim_device_set",
    "mps_sim_destroy",
    "mps_step",
    "mps_run",
    "mps_stl_edges",
    "mps_checkpoint_write",
    "mps_frames_open",
    "mps_picture_save",
    "mps_body_get",
    "mps_load_get",
    "mps_motion_state_at",
    "mps_stencil_get",
    "mps_lease_end",
    "mps_particles_collect",
    "mps_probe_read",
    "mps_probe_series",
    "mps_probe_series_clear",
    "mps_energy_get",
    "mps_momentum_get",
    "mps_step_info_get",
    "mps_verb_info_get",
    "mps_pass_info_get",
    "mps_profile_reset",
    "mps_plugin_register",
    "mps_particles_collect_end",
    "mps_job_probe_add",
    "mps_job_column_read",
    "mps_job_measure_add",
    "mps_job_run",
    "mps_job_profile_text",
};
enum { OTHERS = sizeof others / sizeof others[0] };

#endif

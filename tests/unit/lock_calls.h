/* SPDX-License-Identifier: BSD-3-Clause */
/* Every public function with a simulation argument, as a call with valid arguments. Add a line for
 * a new function to each half of this file: test_lock.c compares the table with the headers. */
#ifndef LOCK_CALLS_H
#define LOCK_CALLS_H

#include <mps/device.h>
#include <mps/list.h>
#include <mps/model.h>
#include <mps/mps.h>
#include <mps/operators.h>
#include <mps/ppe.h>
#include <stdio.h>

/* Where a function may be called: between steps only; in a monitor too; everywhere. */
enum { LOCK_CHANGES, LOCK_READS, LOCK_PLAIN };

/* Functions of the table that take frames or a snapshot instead of a simulation. */
enum { LOCK_OF_FRAMES = 3 };

typedef struct lock_call {
    const char *name;
    int level;
    mps_status (*call)(mps_sim *sim);
} lock_call;

static struct {
    char path[128];
    const char *folder;
    mps_frames *frames;
    mps_snapshot *snapshot;
} given;

/* The folder that calls write to, and frames and a snapshot of the simulation. */
static void lock_open(const char *folder, mps_frames *frames, mps_snapshot *snapshot)
{
    given.folder = folder;
    given.frames = frames;
    given.snapshot = snapshot;
    snprintf(given.path, sizeof given.path, "%s/lock.checkpoint", folder);
}

/* CALL(function, statements that return its status) */
#define CALL(name, ...)                         \
    static mps_status call_##name(mps_sim *sim) \
    {                                           \
        __VA_ARGS__                             \
    }
/* A struct with its first values. */
#define STRUCT(type) \
    type a;          \
    type##_init(&a, sizeof a)

static const double low[2] = {0.05, 0.35}, high[2] = {0.2, 0.45}, edge[2] = {0.2, 0.05};

static int all_inside(void *user, const double *x)
{
    (void)user;
    return x[1] > 0.35;
}

static int no_verb(mps_stage *s)
{
    (void)s;
    return 0;
}

static int no_motion(void *user, double t, mps_motion_state *state)
{
    (void)user, (void)t, (void)state;
    return 0;
}

static double kernel(void *user, double r, double re)
{
    (void)user;
    return re - r;
}

static int apply(void *self, const double *r, double *z)
{
    (void)self, (void)r, (void)z;
    return 0;
}

static int set_up(void *self, const mps_ppe_problem *problem)
{
    (void)self, (void)problem;
    return 0;
}

static void solve(void *self, const mps_ppe_problem *problem, const mps_preconditioner_ops *pc,
                  void *pc_self, double *p, mps_ppe_result *result)
{
    (void)self, (void)problem, (void)pc, (void)pc_self, (void)p, (void)result;
}

static int create(const mps_allocator *allocator, void **self)
{
    (void)allocator, (void)self;
    return 0;
}

static void destroy(const mps_allocator *allocator, void *self)
{
    (void)allocator, (void)self;
}

/* ---- set-up ---------------------------------------------------------------------------------- */

CALL(mps_tank_add, STRUCT(mps_tank); a.size[0] = a.size[1] = 1; return mps_tank_add(sim, &a, NULL);)
CALL(mps_baffle_add, return mps_baffle_add(sim, "new", low, high, NULL);)
CALL(mps_plate_add, return mps_plate_add(sim, "new", low, edge, NULL);)
CALL(mps_fill_box_add, return mps_fill_box_add(sim, 0, low, high, NULL, NULL);)
CALL(mps_fill_level_add, return mps_fill_level_add(sim, 0, low, high, NULL, NULL);)
CALL(mps_fill_add, return mps_fill_add(sim, 0, all_inside, NULL, NULL);)
CALL(mps_solid_add, STRUCT(mps_solid); a.hi[0] = a.hi[1] = 0.5; a.inside = all_inside;
     return mps_solid_add(sim, &a);)
CALL(mps_stl_edges, STRUCT(mps_stl); int64_t count;
     return mps_stl_edges(sim, given.path, &a, 0.3, 0, NULL, &count);)
CALL(mps_stl_add, STRUCT(mps_stl); return mps_stl_add(sim, given.path, &a, NULL);)
CALL(mps_motion_centre_set, return mps_motion_centre_set(sim, high, MPS_START_WITH_TANK);)
CALL(mps_motion_harmonics_set, const mps_harmonic h = {.amplitude = 0.1, .omega = 1};
     return mps_motion_harmonics_set(sim, 1, &h);)
CALL(mps_motion_table_set, const double t[] = {-1, 9}, v[] = {0, 1}; const int32_t dof = 0;
     return mps_motion_table_set(sim, 2, t, 1, &dof, v);)
CALL(mps_motion_callback_set, return mps_motion_callback_set(sim, no_motion, NULL);)
CALL(mps_motion_clear, return mps_motion_clear(sim);)
CALL(mps_motion_pose_set, STRUCT(mps_motion_state); return mps_motion_pose_set(sim, 9, &a);)
CALL(mps_kernel_use, mps_kernel k = {.struct_size = sizeof k}; mps_kernel_custom(kernel, NULL, &k);
     return mps_kernel_use(sim, &k);)
CALL(mps_threads_set, return mps_threads_set(sim, 2);)
CALL(mps_sim_device_set, return mps_sim_device_set(sim, NULL);)
CALL(mps_sim_device_info, STRUCT(mps_device_info); return mps_sim_device_info(sim, &a);)
CALL(mps_phase_set, STRUCT(mps_phase); a.density = 900; return mps_phase_set(sim, 0, &a);)
CALL(mps_tension_set, return mps_tension_set(sim, 0, 1, 0.07);)
CALL(mps_time_control_set, STRUCT(mps_time_control); a.dt = 1e-4;
     return mps_time_control_set(sim, &a);)
CALL(mps_preset_use, return mps_preset_use(sim, "imps.paper");)
CALL(mps_model_use, return mps_model_use(sim, "wall.extrapolate");)
CALL(mps_model_remove, return mps_model_remove(sim, "shift");)
CALL(mps_model_set, return mps_model_set(sim, "collision", "distance", 0.7);)
CALL(mps_model_register, const mps_verb v = {.hook = MPS_FORCE, .run = no_verb};
     const mps_model_ops ops = {.struct_size = sizeof ops,
                                .api = MPS_MODEL_API,
                                .name = "new.toy",
                                .help = "h",
                                .verb_count = 1,
                                .verbs = &v};
     return mps_model_register(sim, &ops);)
CALL(mps_solver_use, return mps_solver_use(sim, "sundials.gmres", "none");)
CALL(mps_solver_limits_set, STRUCT(mps_solver_limits); a.tolerance = 1e-2;
     return mps_solver_limits_set(sim, &a);)
CALL(mps_solver_register, const mps_solver_ops ops = {.struct_size = sizeof ops,
                                                      .api = MPS_PPE_API,
                                                      .name = "new",
                                                      .create = create,
                                                      .solve = solve,
                                                      .destroy = destroy};
     return mps_solver_register(sim, &ops);)
CALL(mps_preconditioner_register, const mps_preconditioner_ops ops = {.struct_size = sizeof ops,
                                                                      .api = MPS_PPE_API,
                                                                      .name = "new",
                                                                      .create = create,
                                                                      .setup = set_up,
                                                                      .apply = apply,
                                                                      .destroy = destroy};
     return mps_preconditioner_register(sim, &ops);)
CALL(mps_probe_add, STRUCT(mps_probe); int32_t id; a.type = MPS_PROBE_FORCE;
     return mps_probe_add(sim, &a, &id);)
CALL(mps_probe_remove, return mps_probe_remove(sim, 0);)

/* ---- particles and steps --------------------------------------------------------------------- */

CALL(mps_particles_add, STRUCT(mps_particle_block); a.count = 1; a.position = high;
     return mps_particles_add(sim, &a, NULL);)
CALL(mps_particles_remove, const int64_t id = 3; return mps_particles_remove(sim, 1, &id);)
CALL(mps_field_add, return mps_field_add(sim, "new", 1);)
CALL(mps_lease_begin, mps_lease l = {.struct_size = sizeof l};
     return mps_lease_begin(sim, "velocity", MPS_WRITE, &l);)
CALL(mps_lease_end, mps_lease l = {.struct_size = sizeof l};
     const mps_status status = mps_lease_begin(sim, "velocity", MPS_READ, &l);
     const mps_status end = mps_lease_end(sim, &l); return status == MPS_OK ? end : MPS_E_BUSY;)
CALL(mps_step, return mps_step(sim, 1e-3, NULL);)
CALL(mps_run, return mps_run(sim, 1, NULL, NULL);)
CALL(mps_checkpoint_note_add, return mps_checkpoint_note_add(sim, "a line");)
CALL(mps_checkpoint_read, return mps_checkpoint_read(sim, given.path);)

CALL(mps_body_set, return mps_body_set(sim, NULL);)
CALL(mps_body_get, STRUCT(mps_body_report); return mps_body_get(sim, &a);)
CALL(mps_load_watch, return mps_load_watch(sim, MPS_LOAD_NONE);)
CALL(mps_snapshot_create, mps_snapshot *k = NULL;
     const mps_status status = mps_snapshot_create(sim, &k); mps_snapshot_destroy(k);
     return status;)
CALL(mps_snapshot_restore, (void)sim; return mps_snapshot_restore(given.snapshot);)

/* ---- reading --------------------------------------------------------------------------------- */

CALL(mps_stencil_get, mps_stencil s = {.struct_size = sizeof s};
     return mps_stencil_get(sim, MPS_NEAR, &s);)
CALL(mps_checkpoint_write, return mps_checkpoint_write(sim, given.path);)
CALL(mps_frames_open, mps_frames *f = NULL;
     const mps_status status = mps_frames_open(sim, given.folder, "lock", 0, &f);
     mps_frames_close(f); return status;)
CALL(mps_frames_write, (void)sim; return mps_frames_write(given.frames);)
CALL(mps_snapshot_take, (void)sim; return mps_snapshot_take(given.snapshot);)
CALL(mps_load_get, STRUCT(mps_load); return mps_load_get(sim, NULL, &a);)
CALL(mps_probe_read, double v[6]; return mps_probe_read(sim, 0, v);)
CALL(mps_probe_series, return mps_probe_series(sim, 0, NULL, NULL, NULL);)
CALL(mps_probe_series_clear, return mps_probe_series_clear(sim, 99);) /* keeps the samples of 0 */
CALL(mps_energy_get, STRUCT(mps_energy); return mps_energy_get(sim, &a);)
CALL(mps_momentum_get, STRUCT(mps_momentum); return mps_momentum_get(sim, &a);)
CALL(mps_profile_reset, return mps_profile_reset(sim);)

/* ---- single values: never refused ------------------------------------------------------------ */

CALL(mps_model_info_get, STRUCT(mps_model_info); return mps_model_info_get(sim, 0, &a);)
CALL(mps_setting_info_get, STRUCT(mps_setting_info);
     return mps_setting_info_get(sim, "collision.pair", 0, &a);)
CALL(mps_channel_info_get, STRUCT(mps_channel_info); return mps_channel_info_get(sim, 0, &a);)
CALL(mps_verb_info_get, STRUCT(mps_verb_info); return mps_verb_info_get(sim, 0, &a);)
CALL(mps_pass_info_get, STRUCT(mps_pass_info); return mps_pass_info_get(sim, 0, &a);)
CALL(mps_preset_info_get, STRUCT(mps_name_info); return mps_preset_info_get(sim, 0, &a);)
CALL(mps_solver_info_get, STRUCT(mps_name_info); return mps_solver_info_get(sim, 0, &a);)
CALL(mps_preconditioner_info_get, STRUCT(mps_name_info);
     return mps_preconditioner_info_get(sim, 0, &a);)
CALL(mps_kernel_info_get, STRUCT(mps_name_info); return mps_kernel_info_get(sim, 0, &a);)
CALL(mps_motion_state_get, mps_motion_state s = {.struct_size = sizeof s};
     return mps_motion_state_get(sim, &s);)
CALL(mps_motion_state_at, mps_motion_state s = {.struct_size = sizeof s};
     return mps_motion_state_at(sim, 0, &s);)
CALL(mps_motion_to_lab, double x[2]; return mps_motion_to_lab(sim, low, x, NULL);)
CALL(mps_particles_count, return mps_particles_count(sim, -1) > 0 ? MPS_OK : MPS_E_BUSY;)
CALL(mps_particle_index, return mps_particle_index(sim, 1) >= 0 ? MPS_OK : MPS_E_BUSY;)
CALL(mps_lattice_get, double h[3]; return mps_lattice_get(sim, NULL, h);)
CALL(mps_part_find, return mps_part_find(sim, "tank.y0") >= 0 ? MPS_OK : MPS_E_BUSY;)
CALL(mps_probe_info_get, STRUCT(mps_probe_info); return mps_probe_info_get(sim, 0, &a);)
CALL(mps_probe_size, return mps_probe_size(sim, 0) == 3 ? MPS_OK : MPS_E_BUSY;)
CALL(mps_sim_error, return mps_sim_error(sim) ? MPS_OK : MPS_E_BUSY;)
CALL(mps_sim_shape, double dp; return mps_sim_shape(sim, NULL, &dp);)
CALL(mps_sim_time, double t; return mps_sim_time(sim, &t, NULL);)
CALL(mps_phase_get, STRUCT(mps_phase); return mps_phase_get(sim, 0, &a);)
CALL(mps_tension_get, double s; return mps_tension_get(sim, 0, 1, &s);)
CALL(mps_model_get, double d; return mps_model_get(sim, "collision", "distance", &d);)
CALL(mps_model_state, const double *v; int64_t n; return mps_model_state(sim, "collision", &v, &n);)
CALL(mps_step_info_get, mps_step_info i; mps_step_info_init(&i, sizeof i);
     return mps_step_info_get(sim, &i);)
CALL(mps_model_name, return mps_model_name(sim, 0) ? MPS_OK : MPS_E_BUSY;)
CALL(mps_solver_name, const char *s; return mps_solver_name(sim, &s, NULL);)
CALL(mps_sim_destroy, mps_sim_destroy(sim); return MPS_OK;) /* does nothing */

#define CHANGES(name)                    \
    {                                    \
#name, LOCK_CHANGES, call_##name \
    }
#define READS(name)                    \
    {                                  \
#name, LOCK_READS, call_##name \
    }
#define PLAIN(name)                    \
    {                                  \
#name, LOCK_PLAIN, call_##name \
    }

static const lock_call lock_calls[] = {
    CHANGES(mps_tank_add),
    CHANGES(mps_baffle_add),
    CHANGES(mps_plate_add),
    CHANGES(mps_fill_box_add),
    CHANGES(mps_fill_level_add),
    CHANGES(mps_fill_add),
    CHANGES(mps_solid_add),
    CHANGES(mps_stl_add),
    CHANGES(mps_motion_centre_set),
    CHANGES(mps_motion_harmonics_set),
    CHANGES(mps_motion_table_set),
    CHANGES(mps_motion_callback_set),
    CHANGES(mps_motion_clear),
    CHANGES(mps_motion_pose_set),
    CHANGES(mps_kernel_use),
    CHANGES(mps_threads_set),
    CHANGES(mps_sim_device_set),
    CHANGES(mps_phase_set),
    CHANGES(mps_tension_set),
    CHANGES(mps_time_control_set),
    CHANGES(mps_preset_use),
    CHANGES(mps_model_use),
    CHANGES(mps_model_remove),
    CHANGES(mps_model_set),
    CHANGES(mps_model_register),
    CHANGES(mps_solver_use),
    CHANGES(mps_solver_limits_set),
    CHANGES(mps_solver_register),
    CHANGES(mps_preconditioner_register),
    CHANGES(mps_probe_add),
    CHANGES(mps_probe_remove),
    CHANGES(mps_particles_add),
    CHANGES(mps_particles_remove),
    CHANGES(mps_field_add),
    CHANGES(mps_lease_begin),
    CHANGES(mps_step),
    CHANGES(mps_run),
    CHANGES(mps_checkpoint_note_add),
    CHANGES(mps_checkpoint_read),
    CHANGES(mps_body_set),
    READS(mps_body_get),
    READS(mps_motion_state_at),
    CHANGES(mps_load_watch),
    CHANGES(mps_snapshot_create),
    CHANGES(mps_snapshot_restore),
    READS(mps_sim_device_info),
    READS(mps_stl_edges),
    READS(mps_lease_end),
    READS(mps_stencil_get),
    READS(mps_checkpoint_write),
    READS(mps_frames_open),
    READS(mps_frames_write),
    READS(mps_snapshot_take),
    READS(mps_load_get),
    READS(mps_probe_read),
    READS(mps_probe_series),
    READS(mps_probe_series_clear),
    READS(mps_energy_get),
    READS(mps_momentum_get),
    READS(mps_profile_reset),
    READS(mps_model_state),
    READS(mps_step_info_get),
    PLAIN(mps_model_info_get),
    PLAIN(mps_setting_info_get),
    PLAIN(mps_channel_info_get),
    PLAIN(mps_verb_info_get),
    PLAIN(mps_pass_info_get),
    PLAIN(mps_preset_info_get),
    PLAIN(mps_solver_info_get),
    PLAIN(mps_preconditioner_info_get),
    PLAIN(mps_kernel_info_get),
    PLAIN(mps_motion_state_get),
    PLAIN(mps_motion_to_lab),
    PLAIN(mps_particles_count),
    PLAIN(mps_particle_index),
    PLAIN(mps_lattice_get),
    PLAIN(mps_part_find),
    PLAIN(mps_probe_info_get),
    PLAIN(mps_probe_size),
    PLAIN(mps_sim_error),
    PLAIN(mps_sim_shape),
    PLAIN(mps_sim_time),
    PLAIN(mps_phase_get),
    PLAIN(mps_tension_get),
    PLAIN(mps_model_get),
    PLAIN(mps_model_name),
    PLAIN(mps_solver_name),
    PLAIN(mps_sim_destroy),
};
static const int lock_call_count = sizeof lock_calls / sizeof lock_calls[0];

#endif

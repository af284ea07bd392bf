/* SPDX-License-Identifier: BSD-3-Clause */
/* Layout of the public structs on x86-64, written by make_layout. Sizes may grow, offsets never change within a major version. */
#include <mps/geometry.h>
#include <mps/model.h>
#include <mps/motion.h>
#include <mps/operators.h>
#include <mps/parallel.h>
#include <mps/particles.h>
#include <mps/ppe.h>
#include <mps/probe.h>
#include <mps/sim.h>
#include <mps/step.h>
#include <mps/types.h>

/* clang-format off */
#if defined(__x86_64__) && !defined(__ILP32__)
#define SIZE(type, bytes) _Static_assert(sizeof(type) == (bytes), #type)
#define AT(type, member, bytes) _Static_assert(offsetof(type, member) == (bytes), #type "." #member)

SIZE(mps_tank, 72);
AT(mps_tank, struct_size, 0);
AT(mps_tank, name, 8);
AT(mps_tank, lo, 16);
AT(mps_tank, size, 40);
AT(mps_tank, open_top, 64);
AT(mps_tank, dummy_layers, 68);

SIZE(mps_solid, 96);
AT(mps_solid, struct_size, 0);
AT(mps_solid, dummy_layers, 4);
AT(mps_solid, name, 8);
AT(mps_solid, lo, 16);
AT(mps_solid, hi, 40);
AT(mps_solid, distance, 64);
AT(mps_solid, inside, 72);
AT(mps_solid, user, 80);
AT(mps_solid, invert, 88);

SIZE(mps_stl, 56);
AT(mps_stl, struct_size, 0);
AT(mps_stl, dummy_layers, 4);
AT(mps_stl, name, 8);
AT(mps_stl, scale, 16);
AT(mps_stl, shift, 24);
AT(mps_stl, container, 48);

SIZE(mps_stage, 304);
AT(mps_stage, struct_size, 0);
AT(mps_stage, dim, 4);
AT(mps_stage, threads, 8);
AT(mps_stage, phases, 12);
AT(mps_stage, n, 16);
AT(mps_stage, step, 24);
AT(mps_stage, t, 32);
AT(mps_stage, dt, 40);
AT(mps_stage, dp, 48);
AT(mps_stage, velocity_scale, 56);
AT(mps_stage, g, 64);
AT(mps_stage, kind, 88);
AT(mps_stage, phase, 96);
AT(mps_stage, id, 104);
AT(mps_stage, x, 112);
AT(mps_stage, u, 120);
AT(mps_stage, p, 128);
AT(mps_stage, density, 136);
AT(mps_stage, viscosity, 144);
AT(mps_stage, tank_accel, 152);
AT(mps_stage, area, 160);
AT(mps_stage, wall_of, 168);
AT(mps_stage, number_density, 176);
AT(mps_stage, volume, 184);
AT(mps_stage, asymmetry, 192);
AT(mps_stage, region, 200);
AT(mps_stage, wet, 208);
AT(mps_stage, correction, 216);
AT(mps_stage, near, 224);
AT(mps_stage, far, 232);
AT(mps_stage, host, 240);
AT(mps_stage, density_smooth, 248);
AT(mps_stage, tension, 256);
AT(mps_stage, level_free, 264);
AT(mps_stage, capillary, 272);
AT(mps_stage, depth, 280);
AT(mps_stage, since_jump, 288);
AT(mps_stage, wall_pressure, 296);

SIZE(mps_ppe_terms, 88);
AT(mps_ppe_terms, struct_size, 0);
AT(mps_ppe_terms, radius, 4);
AT(mps_ppe_terms, complete_surface, 8);
AT(mps_ppe_terms, wall_factor, 16);
AT(mps_ppe_terms, rhs, 24);
AT(mps_ppe_terms, shift, 32);
AT(mps_ppe_terms, value, 40);
AT(mps_ppe_terms, fixed, 48);
AT(mps_ppe_terms, body, 56);
AT(mps_ppe_terms, gain, 64);
AT(mps_ppe_terms, gas, 72);
AT(mps_ppe_terms, law, 80);

SIZE(mps_setting, 32);
AT(mps_setting, key, 0);
AT(mps_setting, initial, 8);
AT(mps_setting, min, 16);
AT(mps_setting, max, 24);

SIZE(mps_model_ops, 112);
AT(mps_model_ops, struct_size, 0);
AT(mps_model_ops, api, 4);
AT(mps_model_ops, name, 8);
AT(mps_model_ops, order, 16);
AT(mps_model_ops, setting_count, 20);
AT(mps_model_ops, settings, 24);
AT(mps_model_ops, create, 32);
AT(mps_model_ops, destroy, 40);
AT(mps_model_ops, classify, 48);
AT(mps_model_ops, force, 56);
AT(mps_model_ops, source, 64);
AT(mps_model_ops, gradient, 72);
AT(mps_model_ops, velocity, 80);
AT(mps_model_ops, shift, 88);
AT(mps_model_ops, dt_limit, 96);
AT(mps_model_ops, load, 104);

SIZE(mps_motion_state, 144);
AT(mps_motion_state, value, 0);
AT(mps_motion_state, rate, 48);
AT(mps_motion_state, accel, 96);

SIZE(mps_harmonic, 32);
AT(mps_harmonic, dof, 0);
AT(mps_harmonic, form, 4);
AT(mps_harmonic, amplitude, 8);
AT(mps_harmonic, omega, 16);
AT(mps_harmonic, phase, 24);

SIZE(mps_kernel, 24);
AT(mps_kernel, id, 0);
AT(mps_kernel, fn, 8);
AT(mps_kernel, user, 16);

SIZE(mps_stencil, 120);
AT(mps_stencil, struct_size, 0);
AT(mps_stencil, dim, 4);
AT(mps_stencil, n, 8);
AT(mps_stencil, dp, 16);
AT(mps_stencil, re, 24);
AT(mps_stencil, n0, 32);
AT(mps_stencil, lambda, 40);
AT(mps_stencil, kernel, 48);
AT(mps_stencil, parallel, 72);
AT(mps_stencil, x, 80);
AT(mps_stencil, begin, 88);
AT(mps_stencil, end, 96);
AT(mps_stencil, col, 104);
AT(mps_stencil, w_r2, 112);

SIZE(mps_pair, 64);
AT(mps_pair, d, 0);
AT(mps_pair, r2, 24);
AT(mps_pair, r, 32);
AT(mps_pair, w, 40);
AT(mps_pair, j, 48);
AT(mps_pair, w_r2, 56);

SIZE(mps_parallel, 24);
AT(mps_parallel, struct_size, 0);
AT(mps_parallel, threads, 4);
AT(mps_parallel, run, 8);
AT(mps_parallel, user, 16);

SIZE(mps_parallel_rows_job, 32);
AT(mps_parallel_rows_job, n, 0);
AT(mps_parallel_rows_job, parts, 8);
AT(mps_parallel_rows_job, body, 16);
AT(mps_parallel_rows_job, argument, 24);

SIZE(mps_parallel_values, 16);
AT(mps_parallel_values, sums, 0);
AT(mps_parallel_values, maxima, 4);
AT(mps_parallel_values, value, 8);

SIZE(mps_parallel_reduce_job, 4128);
AT(mps_parallel_reduce_job, n, 0);
AT(mps_parallel_reduce_job, values, 8);
AT(mps_parallel_reduce_job, body, 16);
AT(mps_parallel_reduce_job, argument, 24);
AT(mps_parallel_reduce_job, part, 32);

SIZE(mps_particle_block, 56);
AT(mps_particle_block, struct_size, 0);
AT(mps_particle_block, kind, 4);
AT(mps_particle_block, phase, 8);
AT(mps_particle_block, part, 16);
AT(mps_particle_block, count, 24);
AT(mps_particle_block, position, 32);
AT(mps_particle_block, velocity, 40);
AT(mps_particle_block, area, 48);

SIZE(mps_lease, 24);
AT(mps_lease, data, 0);
AT(mps_lease, count, 8);
AT(mps_lease, stride, 16);
AT(mps_lease, slot, 20);

SIZE(mps_ppe_problem, 144);
AT(mps_ppe_problem, struct_size, 0);
AT(mps_ppe_problem, dim, 4);
AT(mps_ppe_problem, n, 8);
AT(mps_ppe_problem, row, 16);
AT(mps_ppe_problem, col, 24);
AT(mps_ppe_problem, val, 32);
AT(mps_ppe_problem, diagonal, 40);
AT(mps_ppe_problem, rhs, 48);
AT(mps_ppe_problem, shift, 56);
AT(mps_ppe_problem, weight, 64);
AT(mps_ppe_problem, x, 72);
AT(mps_ppe_problem, dp, 80);
AT(mps_ppe_problem, tolerance, 88);
AT(mps_ppe_problem, divergence, 96);
AT(mps_ppe_problem, max_iterations, 104);
AT(mps_ppe_problem, components, 108);
AT(mps_ppe_problem, component, 112);
AT(mps_ppe_problem, gas, 120);
AT(mps_ppe_problem, law, 128);
AT(mps_ppe_problem, parallel, 136);

SIZE(mps_ppe_result, 32);
AT(mps_ppe_result, reason, 0);
AT(mps_ppe_result, iterations, 4);
AT(mps_ppe_result, residual, 8);
AT(mps_ppe_result, divergence, 16);
AT(mps_ppe_result, setup_seconds, 24);

SIZE(mps_preconditioner_ops, 64);
AT(mps_preconditioner_ops, struct_size, 0);
AT(mps_preconditioner_ops, api, 4);
AT(mps_preconditioner_ops, name, 8);
AT(mps_preconditioner_ops, symmetric, 16);
AT(mps_preconditioner_ops, create, 24);
AT(mps_preconditioner_ops, setup, 32);
AT(mps_preconditioner_ops, apply, 40);
AT(mps_preconditioner_ops, destroy, 48);
AT(mps_preconditioner_ops, user, 56);

SIZE(mps_solver_ops, 72);
AT(mps_solver_ops, struct_size, 0);
AT(mps_solver_ops, api, 4);
AT(mps_solver_ops, name, 8);
AT(mps_solver_ops, preconditioner, 16);
AT(mps_solver_ops, symmetric, 24);
AT(mps_solver_ops, create, 32);
AT(mps_solver_ops, solve, 40);
AT(mps_solver_ops, destroy, 48);
AT(mps_solver_ops, nonlinear, 56);
AT(mps_solver_ops, user, 64);

SIZE(mps_probe, 112);
AT(mps_probe, struct_size, 0);
AT(mps_probe, type, 4);
AT(mps_probe, at, 8);
AT(mps_probe, direction, 32);
AT(mps_probe, diameter, 56);
AT(mps_probe, length, 64);
AT(mps_probe, part, 72);
AT(mps_probe, count_drops, 80);
AT(mps_probe, average, 88);
AT(mps_probe, rate, 96);
AT(mps_probe, phases, 104);

SIZE(mps_energy, 144);
AT(mps_energy, struct_size, 0);
AT(mps_energy, kinetic, 8);
AT(mps_energy, potential, 16);
AT(mps_energy, wall_work, 24);
AT(mps_energy, viscous, 32);
AT(mps_energy, collision, 40);
AT(mps_energy, shift, 48);
AT(mps_energy, numerical, 56);
AT(mps_energy, mass, 64);
AT(mps_energy, volume, 72);
AT(mps_energy, volume_error, 80);
AT(mps_energy, centre, 88);
AT(mps_energy, momentum, 112);
AT(mps_energy, added, 136);

SIZE(mps_momentum, 224);
AT(mps_momentum, struct_size, 0);
AT(mps_momentum, total, 8);
AT(mps_momentum, gravity, 32);
AT(mps_momentum, force, 56);
AT(mps_momentum, pressure, 80);
AT(mps_momentum, walls, 104);
AT(mps_momentum, numerical, 128);
AT(mps_momentum, collision, 152);
AT(mps_momentum, shift, 176);
AT(mps_momentum, added, 200);

SIZE(mps_config, 216);
AT(mps_config, struct_size, 0);
AT(mps_config, dim, 4);
AT(mps_config, dp, 8);
AT(mps_config, gravity, 16);
AT(mps_config, kernel, 40);
AT(mps_config, re_near, 48);
AT(mps_config, re_far, 56);
AT(mps_config, velocity_scale, 64);
AT(mps_config, threads, 72);
AT(mps_config, lost_policy, 76);
AT(mps_config, domain_min, 80);
AT(mps_config, domain_max, 104);
AT(mps_config, speed_limit, 128);
AT(mps_config, allocator, 136);
AT(mps_config, log, 160);
AT(mps_config, log_user, 168);
AT(mps_config, error, 176);
AT(mps_config, error_size, 184);
AT(mps_config, parallel, 192);

SIZE(mps_phase, 24);
AT(mps_phase, struct_size, 0);
AT(mps_phase, density, 8);
AT(mps_phase, viscosity, 16);

SIZE(mps_solver_limits, 24);
AT(mps_solver_limits, struct_size, 0);
AT(mps_solver_limits, max_iterations, 4);
AT(mps_solver_limits, tolerance, 8);
AT(mps_solver_limits, divergence, 16);

SIZE(mps_time_control, 64);
AT(mps_time_control, struct_size, 0);
AT(mps_time_control, dt, 8);
AT(mps_time_control, cfl, 16);
AT(mps_time_control, gravity, 24);
AT(mps_time_control, viscous, 32);
AT(mps_time_control, growth, 40);
AT(mps_time_control, dt_max, 48);
AT(mps_time_control, dt_min, 56);

SIZE(mps_step_info, 144);
AT(mps_step_info, struct_size, 0);
AT(mps_step_info, ppe_iterations, 4);
AT(mps_step_info, step, 8);
AT(mps_step_info, t, 16);
AT(mps_step_info, dt, 24);
AT(mps_step_info, cfl, 32);
AT(mps_step_info, max_speed, 40);
AT(mps_step_info, ppe_residual, 48);
AT(mps_step_info, ppe_divergence, 56);
AT(mps_step_info, ppe_unknowns, 64);
AT(mps_step_info, lost, 72);
AT(mps_step_info, surface, 80);
AT(mps_step_info, seconds, 88);
AT(mps_step_info, crossing_time, 128);
AT(mps_step_info, ppe_solves, 136);
AT(mps_step_info, separated, 140);

SIZE(mps_allocator, 24);
AT(mps_allocator, alloc, 0);
AT(mps_allocator, release, 8);
AT(mps_allocator, user, 16);
#endif
/* clang-format on */

/* Everything is checked by the compiler. */
int main(void)
{
    return 0;
}

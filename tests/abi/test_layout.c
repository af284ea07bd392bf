/* SPDX-License-Identifier: BSD-3-Clause */
/* Layout of the public structs on x86-64, written by make_layout. Sizes may grow, offsets never change within a major version. */
#include <mps/body.h>
#include <mps/case.h>
#include <mps/couple.h>
#include <mps/device.h>
#include <mps/exact.h>
#include <mps/flux.h>
#include <mps/geometry.h>
#include <mps/job.h>
#include <mps/list.h>
#include <mps/model.h>
#include <mps/motion.h>
#include <mps/operators.h>
#include <mps/page.h>
#include <mps/parallel.h>
#include <mps/particles.h>
#include <mps/picture.h>
#include <mps/plugin.h>
#include <mps/ppe.h>
#include <mps/probe.h>
#include <mps/ranks.h>
#include <mps/series.h>
#include <mps/ship.h>
#include <mps/sim.h>
#include <mps/stage.h>
#include <mps/stats.h>
#include <mps/step.h>
#include <mps/types.h>
#include <mps/voids.h>

/* clang-format off */
#if defined(__x86_64__) && !defined(__ILP32__)
#define SIZE(type, bytes) _Static_assert(sizeof(type) == (bytes), #type)
#define AT(type, member, bytes) _Static_assert(offsetof(type, member) == (bytes), #type "." #member)

SIZE(mps_body, 808);
AT(mps_body, struct_size, 0); AT(mps_body, free, 4); AT(mps_body, mass, 8); AT(mps_body, centre_of_mass, 16); AT(mps_body, inertia, 40);
AT(mps_body, stiffness, 112); AT(mps_body, damping, 400); AT(mps_body, equilibrium, 688); AT(mps_body, load, 736); AT(mps_body, user, 744);
AT(mps_body, gravity, 752); AT(mps_body, reserved, 756); AT(mps_body, friction, 760);

SIZE(mps_body_report, 752);
AT(mps_body_report, struct_size, 0); AT(mps_body_report, free, 4); AT(mps_body_report, pose, 8); AT(mps_body_report, velocity, 56);
AT(mps_body_report, acceleration, 104); AT(mps_body_report, liquid, 152); AT(mps_body_report, external, 200);
AT(mps_body_report, restoring, 248); AT(mps_body_report, mass, 296); AT(mps_body_report, late, 584); AT(mps_body_report, iterations, 632);
AT(mps_body_report, reserved, 636); AT(mps_body_report, kinetic, 640); AT(mps_body_report, spring, 648); AT(mps_body_report, weight, 656);
AT(mps_body_report, damped, 664); AT(mps_body_report, external_work, 672); AT(mps_body_report, liquid_work, 680);
AT(mps_body_report, start, 688); AT(mps_body_report, friction, 696); AT(mps_body_report, rubbed, 744);

SIZE(mps_case_message, 40);
AT(mps_case_message, struct_size, 0); AT(mps_case_message, warning, 4); AT(mps_case_message, line, 8); AT(mps_case_message, column, 12);
AT(mps_case_message, file, 16); AT(mps_case_message, text, 24); AT(mps_case_message, source, 32);

SIZE(mps_case_options, 48);
AT(mps_case_options, struct_size, 0); AT(mps_case_options, load, 4); AT(mps_case_options, set_count, 8);
AT(mps_case_options, plugin_count, 12); AT(mps_case_options, set, 16); AT(mps_case_options, plugin, 24); AT(mps_case_options, text, 32);
AT(mps_case_options, size, 40);

SIZE(mps_case_cost, 32);
AT(mps_case_cost, struct_size, 0); AT(mps_case_cost, reserved, 4); AT(mps_case_cost, wall_least, 8); AT(mps_case_cost, wall_most, 16);
AT(mps_case_cost, memory, 24);

SIZE(mps_case_key, 304);
AT(mps_case_key, struct_size, 0); AT(mps_case_key, required, 4); AT(mps_case_key, path, 8); AT(mps_case_key, range, 16);
AT(mps_case_key, otherwise, 24); AT(mps_case_key, example, 32); AT(mps_case_key, help, 40); AT(mps_case_key, kind, 48);
AT(mps_case_key, units, 144);

SIZE(mps_load, 456);
AT(mps_load, struct_size, 0); AT(mps_load, has_mass, 4); AT(mps_load, force, 8); AT(mps_load, rest, 56); AT(mps_load, mass, 104);
AT(mps_load, acceleration, 392); AT(mps_load, dt, 440); AT(mps_load, iterations, 448); AT(mps_load, reserved, 452);

SIZE(mps_launch, 96);
AT(mps_launch, struct_size, 0); AT(mps_launch, dim, 4); AT(mps_launch, n, 8); AT(mps_launch, file, 16); AT(mps_launch, name, 24);
AT(mps_launch, view, 32); AT(mps_launch, fields, 40); AT(mps_launch, bytes, 48); AT(mps_launch, sums, 56); AT(mps_launch, maxima, 60);
AT(mps_launch, run, 64); AT(mps_launch, host, 72); AT(mps_launch, cancel, 80); AT(mps_launch, mask, 88);

SIZE(mps_device_ops, 144);
AT(mps_device_ops, struct_size, 0); AT(mps_device_ops, api, 4); AT(mps_device_ops, name, 8); AT(mps_device_ops, self, 16);
AT(mps_device_ops, alloc, 24); AT(mps_device_ops, free, 32); AT(mps_device_ops, upload, 40); AT(mps_device_ops, download, 48);
AT(mps_device_ops, clear, 56); AT(mps_device_ops, copy, 64); AT(mps_device_ops, launch, 72); AT(mps_device_ops, reduce, 80);
AT(mps_device_ops, reduce_async, 88); AT(mps_device_ops, wait, 96); AT(mps_device_ops, failure, 104); AT(mps_device_ops, invalidated, 112);
AT(mps_device_ops, begin, 120); AT(mps_device_ops, end, 128); AT(mps_device_ops, plugin_loops, 136); AT(mps_device_ops, reserved, 140);

SIZE(mps_device_info, 72);
AT(mps_device_info, struct_size, 0); AT(mps_device_info, host_calls, 4); AT(mps_device_info, name, 8); AT(mps_device_info, launches, 16);
AT(mps_device_info, waits, 24); AT(mps_device_info, uploads, 32); AT(mps_device_info, downloads, 40); AT(mps_device_info, bytes_up, 48);
AT(mps_device_info, bytes_down, 56); AT(mps_device_info, bytes_held, 64);

SIZE(mps_exact, 32);
AT(mps_exact, part, 0); AT(mps_exact, level, 24); AT(mps_exact, special, 28);

SIZE(mps_exact_values, 24);
AT(mps_exact_values, sums, 0); AT(mps_exact_values, maxima, 4); AT(mps_exact_values, sum, 8); AT(mps_exact_values, maximum, 16);

SIZE(mps_flux, 96);
AT(mps_flux, struct_size, 0); AT(mps_flux, body, 4); AT(mps_flux, kind, 8); AT(mps_flux, phase, 16); AT(mps_flux, density, 24);
AT(mps_flux, distance, 32); AT(mps_flux, jump, 40); AT(mps_flux, wetted, 48); AT(mps_flux, tank_acceleration, 56); AT(mps_flux, g, 64);
AT(mps_flux, wall_factor, 88);

SIZE(mps_tank, 72);
AT(mps_tank, struct_size, 0); AT(mps_tank, name, 8); AT(mps_tank, lo, 16); AT(mps_tank, size, 40); AT(mps_tank, open_top, 64);
AT(mps_tank, dummy_layers, 68);

SIZE(mps_solid, 96);
AT(mps_solid, struct_size, 0); AT(mps_solid, dummy_layers, 4); AT(mps_solid, name, 8); AT(mps_solid, lo, 16); AT(mps_solid, hi, 40);
AT(mps_solid, distance, 64); AT(mps_solid, inside, 72); AT(mps_solid, user, 80); AT(mps_solid, invert, 88);

SIZE(mps_stl, 80);
AT(mps_stl, struct_size, 0); AT(mps_stl, dummy_layers, 4); AT(mps_stl, name, 8); AT(mps_stl, scale, 16); AT(mps_stl, rotation, 24);
AT(mps_stl, shift, 48); AT(mps_stl, container, 72); AT(mps_stl, open_side, 76);

SIZE(mps_job_ranks, 64);
AT(mps_job_ranks, struct_size, 0); AT(mps_job_ranks, rank, 4); AT(mps_job_ranks, count, 8); AT(mps_job_ranks, user, 16);
AT(mps_job_ranks, attach, 24); AT(mps_job_ranks, largest, 32); AT(mps_job_ranks, largest_numbers, 40); AT(mps_job_ranks, end, 48);
AT(mps_job_ranks, abort, 56);

SIZE(mps_job_config, 232);
AT(mps_job_config, struct_size, 0); AT(mps_job_config, resume, 4); AT(mps_job_config, name, 8); AT(mps_job_config, title, 16);
AT(mps_job_config, command, 24); AT(mps_job_config, text, 32); AT(mps_job_config, model, 40); AT(mps_job_config, folder, 48);
AT(mps_job_config, t_end, 56); AT(mps_job_config, row_interval, 64); AT(mps_job_config, checkpoint, 72); AT(mps_job_config, gravity, 80);
AT(mps_job_config, average, 88); AT(mps_job_config, frames, 96); AT(mps_job_config, picture_count, 100); AT(mps_job_config, picture_t, 104);
AT(mps_job_config, overwrite, 112); AT(mps_job_config, pieces, 116); AT(mps_job_config, tank_frame, 120); AT(mps_job_config, report, 124);
AT(mps_job_config, profile, 128); AT(mps_job_config, quiet, 132); AT(mps_job_config, signals, 136); AT(mps_job_config, trace, 140);
AT(mps_job_config, film, 144); AT(mps_job_config, threads, 148); AT(mps_job_config, page_bytes, 152); AT(mps_job_config, ranks, 160);
AT(mps_job_config, print, 168); AT(mps_job_config, print_user, 176); AT(mps_job_config, error, 184); AT(mps_job_config, error_size, 192);
AT(mps_job_config, dp, 200); AT(mps_job_config, device, 208); AT(mps_job_config, peaks, 216); AT(mps_job_config, reserved, 220);
AT(mps_job_config, checkpoint_clock, 224);

SIZE(mps_job_column, 32);
AT(mps_job_column, struct_size, 0); AT(mps_job_column, flags, 4); AT(mps_job_column, name, 8); AT(mps_job_column, unit, 16);
AT(mps_job_column, about, 24);

SIZE(mps_measure, 152);
AT(mps_measure, struct_size, 0); AT(mps_measure, phase, 4); AT(mps_measure, axis, 8); AT(mps_measure, change, 12);
AT(mps_measure, at_end, 16); AT(mps_measure, measure, 24); AT(mps_measure, name, 32); AT(mps_measure, about, 40); AT(mps_measure, part, 48);
AT(mps_measure, box, 56); AT(mps_measure, centre, 104); AT(mps_measure, radius, 128); AT(mps_measure, level, 136);
AT(mps_measure, smoothing, 144);

SIZE(mps_measure_info, 40);
AT(mps_measure_info, struct_size, 0); AT(mps_measure_info, dim, 4); AT(mps_measure_info, name, 8); AT(mps_measure_info, unit, 16);
AT(mps_measure_info, unit_3d, 24); AT(mps_measure_info, help, 32);

SIZE(mps_trace, 64);
AT(mps_trace, struct_size, 0); AT(mps_trace, kind, 4); AT(mps_trace, name, 8); AT(mps_trace, about, 16); AT(mps_trace, column, 24);
AT(mps_trace, from, 32); AT(mps_trace, to, 40); AT(mps_trace, window, 48); AT(mps_trace, scale, 56);

SIZE(mps_reference, 56);
AT(mps_reference, struct_size, 0); AT(mps_reference, line, 4); AT(mps_reference, label, 8); AT(mps_reference, unit, 16);
AT(mps_reference, column, 24); AT(mps_reference, count, 32); AT(mps_reference, t, 40); AT(mps_reference, value, 48);

SIZE(mps_model_info, 40);
AT(mps_model_info, struct_size, 0); AT(mps_model_info, active, 4); AT(mps_model_info, name, 8); AT(mps_model_info, help, 16);
AT(mps_model_info, settings, 24); AT(mps_model_info, channels, 28); AT(mps_model_info, verbs, 32); AT(mps_model_info, built_in, 36);

SIZE(mps_setting_info, 64);
AT(mps_setting_info, struct_size, 0); AT(mps_setting_info, type, 4); AT(mps_setting_info, key, 8); AT(mps_setting_info, unit, 16);
AT(mps_setting_info, help, 24); AT(mps_setting_info, initial, 32); AT(mps_setting_info, min, 40); AT(mps_setting_info, max, 48);
AT(mps_setting_info, value, 56);

SIZE(mps_channel_info, 56);
AT(mps_channel_info, struct_size, 0); AT(mps_channel_info, components, 4); AT(mps_channel_info, type, 8); AT(mps_channel_info, life, 12);
AT(mps_channel_info, name, 16); AT(mps_channel_info, unit, 24); AT(mps_channel_info, help, 32); AT(mps_channel_info, reads, 40);
AT(mps_channel_info, writes, 44); AT(mps_channel_info, own, 48);

SIZE(mps_verb_info, 32);
AT(mps_verb_info, struct_size, 0); AT(mps_verb_info, hook, 4); AT(mps_verb_info, hook_name, 8); AT(mps_verb_info, model, 16);
AT(mps_verb_info, uses, 24);

SIZE(mps_pass_info, 64);
AT(mps_pass_info, struct_size, 0); AT(mps_pass_info, hook, 4); AT(mps_pass_info, hook_name, 8); AT(mps_pass_info, name, 16);
AT(mps_pass_info, uses, 24); AT(mps_pass_info, model, 32); AT(mps_pass_info, reserved, 36); AT(mps_pass_info, calls, 40);
AT(mps_pass_info, seconds, 48); AT(mps_pass_info, bytes, 56);

SIZE(mps_name_info, 24);
AT(mps_name_info, struct_size, 0); AT(mps_name_info, active, 4); AT(mps_name_info, name, 8); AT(mps_name_info, help, 16);

SIZE(mps_use, 16);
AT(mps_use, channel, 0); AT(mps_use, access, 8);

SIZE(mps_channel, 48);
AT(mps_channel, name, 0); AT(mps_channel, unit, 8); AT(mps_channel, help, 16); AT(mps_channel, components, 24); AT(mps_channel, type, 28);
AT(mps_channel, life, 32); AT(mps_channel, initial, 40);

SIZE(mps_setting, 56);
AT(mps_setting, key, 0); AT(mps_setting, unit, 8); AT(mps_setting, help, 16); AT(mps_setting, type, 24); AT(mps_setting, initial, 32);
AT(mps_setting, min, 40); AT(mps_setting, max, 48);

SIZE(mps_verb, 48);
AT(mps_verb, hook, 0); AT(mps_verb, use_count, 4); AT(mps_verb, uses, 8); AT(mps_verb, after, 16); AT(mps_verb, before, 24);
AT(mps_verb, run, 32); AT(mps_verb, device, 40); AT(mps_verb, reserved, 44);

SIZE(mps_model_ops, 112);
AT(mps_model_ops, struct_size, 0); AT(mps_model_ops, api, 4); AT(mps_model_ops, name, 8); AT(mps_model_ops, help, 16);
AT(mps_model_ops, setting_count, 24); AT(mps_model_ops, channel_count, 28); AT(mps_model_ops, verb_count, 32);
AT(mps_model_ops, part_count, 36); AT(mps_model_ops, settings, 40); AT(mps_model_ops, channels, 48); AT(mps_model_ops, verbs, 56);
AT(mps_model_ops, create, 64); AT(mps_model_ops, destroy, 72); AT(mps_model_ops, user, 80); AT(mps_model_ops, reach, 88);
AT(mps_model_ops, parts, 96); AT(mps_model_ops, check, 104);

SIZE(mps_motion_state, 152);
AT(mps_motion_state, struct_size, 0); AT(mps_motion_state, reserved, 4); AT(mps_motion_state, value, 8); AT(mps_motion_state, rate, 56);
AT(mps_motion_state, accel, 104);

SIZE(mps_motion_pose, 200);
AT(mps_motion_pose, struct_size, 0); AT(mps_motion_pose, reserved, 4); AT(mps_motion_pose, rotation, 8);
AT(mps_motion_pose, translation, 80); AT(mps_motion_pose, velocity, 104); AT(mps_motion_pose, omega, 128); AT(mps_motion_pose, accel, 152);
AT(mps_motion_pose, alpha, 176);

SIZE(mps_harmonic, 40);
AT(mps_harmonic, dof, 0); AT(mps_harmonic, form, 4); AT(mps_harmonic, amplitude, 8); AT(mps_harmonic, omega, 16);
AT(mps_harmonic, phase, 24); AT(mps_harmonic, ramp, 32);

SIZE(mps_kernel, 24);
AT(mps_kernel, struct_size, 0); AT(mps_kernel, id, 4); AT(mps_kernel, fn, 8); AT(mps_kernel, user, 16);

SIZE(mps_stencil, 128);
AT(mps_stencil, struct_size, 0); AT(mps_stencil, dim, 4); AT(mps_stencil, host, 8); AT(mps_stencil, n, 16); AT(mps_stencil, dp, 24);
AT(mps_stencil, re, 32); AT(mps_stencil, n0, 40); AT(mps_stencil, lambda, 48); AT(mps_stencil, kernel, 56); AT(mps_stencil, parallel, 80);
AT(mps_stencil, x, 88); AT(mps_stencil, begin, 96); AT(mps_stencil, end, 104); AT(mps_stencil, col, 112); AT(mps_stencil, w_r2, 120);

SIZE(mps_pair, 64);
AT(mps_pair, d, 0); AT(mps_pair, r2, 24); AT(mps_pair, r, 32); AT(mps_pair, w, 40); AT(mps_pair, j, 48); AT(mps_pair, w_r2, 56);

SIZE(mps_page_config, 40);
AT(mps_page_config, struct_size, 0); AT(mps_page_config, frames, 4); AT(mps_page_config, bytes, 8); AT(mps_page_config, error, 16);
AT(mps_page_config, error_size, 24); AT(mps_page_config, impacts, 32);

SIZE(mps_page_info, 344);
AT(mps_page_info, struct_size, 0); AT(mps_page_info, frames, 4); AT(mps_page_info, bytes, 8); AT(mps_page_info, particles, 16);
AT(mps_page_info, left_out, 24);

SIZE(mps_parallel, 24);
AT(mps_parallel, struct_size, 0); AT(mps_parallel, threads, 4); AT(mps_parallel, run, 8); AT(mps_parallel, user, 16);

SIZE(mps_parallel_rows_job, 32);
AT(mps_parallel_rows_job, n, 0); AT(mps_parallel_rows_job, parts, 8); AT(mps_parallel_rows_job, body, 16);
AT(mps_parallel_rows_job, argument, 24);

SIZE(mps_parallel_values, 16);
AT(mps_parallel_values, sums, 0); AT(mps_parallel_values, maxima, 4); AT(mps_parallel_values, value, 8);

SIZE(mps_parallel_reduce_job, 8224);
AT(mps_parallel_reduce_job, n, 0); AT(mps_parallel_reduce_job, values, 8); AT(mps_parallel_reduce_job, body, 16);
AT(mps_parallel_reduce_job, argument, 24); AT(mps_parallel_reduce_job, part, 32);

SIZE(mps_particle_block, 56);
AT(mps_particle_block, struct_size, 0); AT(mps_particle_block, kind, 4); AT(mps_particle_block, phase, 8); AT(mps_particle_block, part, 16);
AT(mps_particle_block, count, 24); AT(mps_particle_block, position, 32); AT(mps_particle_block, velocity, 40);
AT(mps_particle_block, area, 48);

SIZE(mps_lease, 48);
AT(mps_lease, struct_size, 0); AT(mps_lease, type, 4); AT(mps_lease, stride, 8); AT(mps_lease, slot, 12); AT(mps_lease, count, 16);
AT(mps_lease, data, 24); AT(mps_lease, integers, 32); AT(mps_lease, ids, 40);

SIZE(mps_picture_config, 80);
AT(mps_picture_config, struct_size, 0); AT(mps_picture_config, width, 4); AT(mps_picture_config, title, 8);
AT(mps_picture_config, gravity, 16); AT(mps_picture_config, pressure_lo, 24); AT(mps_picture_config, pressure_hi, 32);
AT(mps_picture_config, sensors, 40); AT(mps_picture_config, reserved, 44); AT(mps_picture_config, error, 48);
AT(mps_picture_config, error_size, 56); AT(mps_picture_config, edges, 64); AT(mps_picture_config, edge_count, 72);
AT(mps_picture_config, reserved_2, 76);

SIZE(mps_film_config, 40);
AT(mps_film_config, struct_size, 0); AT(mps_film_config, width, 4); AT(mps_film_config, rate, 8); AT(mps_film_config, program, 16);
AT(mps_film_config, error, 24); AT(mps_film_config, error_size, 32);

SIZE(mps_drive_ops, 72);
AT(mps_drive_ops, struct_size, 0); AT(mps_drive_ops, api, 4); AT(mps_drive_ops, name, 8); AT(mps_drive_ops, help, 16);
AT(mps_drive_ops, setting_count, 24); AT(mps_drive_ops, reserved, 28); AT(mps_drive_ops, settings, 32); AT(mps_drive_ops, load, 40);
AT(mps_drive_ops, motion, 48); AT(mps_drive_ops, period, 56); AT(mps_drive_ops, user, 64);

SIZE(mps_registry, 72);
AT(mps_registry, struct_size, 0); AT(mps_registry, api, 4); AT(mps_registry, host, 8); AT(mps_registry, model, 16);
AT(mps_registry, solver, 24); AT(mps_registry, preconditioner, 32); AT(mps_registry, drive, 40); AT(mps_registry, plugin_api, 48);
AT(mps_registry, reserved, 52); AT(mps_registry, name, 56); AT(mps_registry, version, 64);

SIZE(mps_plugin_info, 40);
AT(mps_plugin_info, struct_size, 0); AT(mps_plugin_info, items, 4); AT(mps_plugin_info, path, 8); AT(mps_plugin_info, sha256, 16);
AT(mps_plugin_info, name, 24); AT(mps_plugin_info, version, 32);

SIZE(mps_plugin_item, 32);
AT(mps_plugin_item, struct_size, 0); AT(mps_plugin_item, kind, 4); AT(mps_plugin_item, name, 8); AT(mps_plugin_item, help, 16);
AT(mps_plugin_item, drive, 24);

SIZE(mps_ppe_ranks, 112);
AT(mps_ppe_ranks, struct_size, 0); AT(mps_ppe_ranks, rank, 4); AT(mps_ppe_ranks, ranks, 8); AT(mps_ppe_ranks, reserved, 12);
AT(mps_ppe_ranks, ghosts, 16); AT(mps_ppe_ranks, rows, 24); AT(mps_ppe_ranks, first, 32); AT(mps_ppe_ranks, order, 40);
AT(mps_ppe_ranks, owner, 48); AT(mps_ppe_ranks, halo, 56); AT(mps_ppe_ranks, reduce, 64); AT(mps_ppe_ranks, gather, 72);
AT(mps_ppe_ranks, connect, 80); AT(mps_ppe_ranks, disconnect, 88); AT(mps_ppe_ranks, exchange, 96); AT(mps_ppe_ranks, host, 104);

SIZE(mps_ppe_hint, 40);
AT(mps_ppe_hint, struct_size, 0); AT(mps_ppe_hint, refused, 4); AT(mps_ppe_hint, unsolvable, 8); AT(mps_ppe_hint, reduce, 16);
AT(mps_ppe_hint, owner, 24); AT(mps_ppe_hint, reduced, 32);

SIZE(mps_ppe_problem, 168);
AT(mps_ppe_problem, struct_size, 0); AT(mps_ppe_problem, dim, 4); AT(mps_ppe_problem, n, 8); AT(mps_ppe_problem, row, 16);
AT(mps_ppe_problem, col, 24); AT(mps_ppe_problem, val, 32); AT(mps_ppe_problem, diagonal, 40); AT(mps_ppe_problem, rhs, 48);
AT(mps_ppe_problem, shift, 56); AT(mps_ppe_problem, weight, 64); AT(mps_ppe_problem, x, 72); AT(mps_ppe_problem, dp, 80);
AT(mps_ppe_problem, tolerance, 88); AT(mps_ppe_problem, divergence, 96); AT(mps_ppe_problem, max_iterations, 104);
AT(mps_ppe_problem, components, 108); AT(mps_ppe_problem, component, 112); AT(mps_ppe_problem, gas, 120); AT(mps_ppe_problem, law, 128);
AT(mps_ppe_problem, parallel, 136); AT(mps_ppe_problem, ranks, 144); AT(mps_ppe_problem, device, 152); AT(mps_ppe_problem, hint, 160);

SIZE(mps_ppe_result, 40);
AT(mps_ppe_result, struct_size, 0); AT(mps_ppe_result, reason, 4); AT(mps_ppe_result, iterations, 8); AT(mps_ppe_result, reserved, 12);
AT(mps_ppe_result, residual, 16); AT(mps_ppe_result, divergence, 24); AT(mps_ppe_result, setup_seconds, 32);

SIZE(mps_preconditioner_ops, 112);
AT(mps_preconditioner_ops, struct_size, 0); AT(mps_preconditioner_ops, api, 4); AT(mps_preconditioner_ops, name, 8);
AT(mps_preconditioner_ops, symmetric, 16); AT(mps_preconditioner_ops, create, 24); AT(mps_preconditioner_ops, setup, 32);
AT(mps_preconditioner_ops, apply, 40); AT(mps_preconditioner_ops, destroy, 48); AT(mps_preconditioner_ops, user, 56);
AT(mps_preconditioner_ops, help, 64); AT(mps_preconditioner_ops, ranks, 72); AT(mps_preconditioner_ops, device, 76);
AT(mps_preconditioner_ops, reach, 80); AT(mps_preconditioner_ops, release_device, 88); AT(mps_preconditioner_ops, fallback, 96);
AT(mps_preconditioner_ops, setup_async, 104); AT(mps_preconditioner_ops, reserved, 108);

SIZE(mps_solver_ops, 104);
AT(mps_solver_ops, struct_size, 0); AT(mps_solver_ops, api, 4); AT(mps_solver_ops, name, 8); AT(mps_solver_ops, preconditioner, 16);
AT(mps_solver_ops, symmetric, 24); AT(mps_solver_ops, create, 32); AT(mps_solver_ops, solve, 40); AT(mps_solver_ops, destroy, 48);
AT(mps_solver_ops, nonlinear, 56); AT(mps_solver_ops, user, 64); AT(mps_solver_ops, help, 72); AT(mps_solver_ops, ranks, 80);
AT(mps_solver_ops, device, 84); AT(mps_solver_ops, hint, 88); AT(mps_solver_ops, release_device, 96);

SIZE(mps_probe, 144);
AT(mps_probe, struct_size, 0); AT(mps_probe, type, 4); AT(mps_probe, at, 8); AT(mps_probe, direction, 32); AT(mps_probe, diameter, 56);
AT(mps_probe, length, 64); AT(mps_probe, part, 72); AT(mps_probe, count_drops, 80); AT(mps_probe, average, 88); AT(mps_probe, rate, 96);
AT(mps_probe, phases, 104); AT(mps_probe, name, 112); AT(mps_probe, normal, 120);

SIZE(mps_probe_info, 88);
AT(mps_probe_info, struct_size, 0); AT(mps_probe_info, type, 4); AT(mps_probe_info, name, 8); AT(mps_probe_info, part, 16);
AT(mps_probe_info, at, 24); AT(mps_probe_info, normal, 48); AT(mps_probe_info, diameter, 72); AT(mps_probe_info, values, 80);

SIZE(mps_energy, 200);
AT(mps_energy, struct_size, 0); AT(mps_energy, kinetic, 8); AT(mps_energy, potential, 16); AT(mps_energy, wall_work_momentum, 24);
AT(mps_energy, wall_work_probes, 32); AT(mps_energy, viscous, 40); AT(mps_energy, plugins, 48); AT(mps_energy, collision, 56);
AT(mps_energy, shift, 64); AT(mps_energy, numerical, 72); AT(mps_energy, mass, 80); AT(mps_energy, volume, 88);
AT(mps_energy, volume_error, 96); AT(mps_energy, centre, 104); AT(mps_energy, momentum, 128); AT(mps_energy, added, 152);
AT(mps_energy, volume_filled, 160); AT(mps_energy, mass_filled, 168); AT(mps_energy, friction, 176); AT(mps_energy, layers, 184);
AT(mps_energy, gas, 192);

SIZE(mps_momentum, 296);
AT(mps_momentum, struct_size, 0); AT(mps_momentum, total, 8); AT(mps_momentum, gravity, 32); AT(mps_momentum, force, 56);
AT(mps_momentum, plugins, 80); AT(mps_momentum, reaction, 104); AT(mps_momentum, pressure, 128); AT(mps_momentum, walls, 152);
AT(mps_momentum, numerical, 176); AT(mps_momentum, collision, 200); AT(mps_momentum, shift, 224); AT(mps_momentum, added, 248);
AT(mps_momentum, friction, 272);

SIZE(mps_route, 48);
AT(mps_route, to_count, 0); AT(mps_route, from_count, 4); AT(mps_route, to, 8); AT(mps_route, sent, 16); AT(mps_route, from, 24);
AT(mps_route, received, 32); AT(mps_route, data, 40);

SIZE(mps_ranks_ops, 136);
AT(mps_ranks_ops, struct_size, 0); AT(mps_ranks_ops, api, 4); AT(mps_ranks_ops, name, 8); AT(mps_ranks_ops, create, 16);
AT(mps_ranks_ops, destroy, 24); AT(mps_ranks_ops, place, 32); AT(mps_ranks_ops, partition, 40); AT(mps_ranks_ops, owner, 48);
AT(mps_ranks_ops, overlap, 56); AT(mps_ranks_ops, connect, 64); AT(mps_ranks_ops, disconnect, 72); AT(mps_ranks_ops, exchange_begin, 80);
AT(mps_ranks_ops, exchange_end, 88); AT(mps_ranks_ops, reduce, 96); AT(mps_ranks_ops, gather, 104); AT(mps_ranks_ops, fail, 112);
AT(mps_ranks_ops, failure, 120); AT(mps_ranks_ops, user, 128);

SIZE(mps_stats_config, 736);
AT(mps_stats_config, struct_size, 0); AT(mps_stats_config, resamples, 4); AT(mps_stats_config, error, 8);
AT(mps_stats_config, error_size, 16); AT(mps_stats_config, from, 24); AT(mps_stats_config, until, 32); AT(mps_stats_config, rate, 40);
AT(mps_stats_config, high_pass, 48); AT(mps_stats_config, threshold, 56); AT(mps_stats_config, deviations, 64);
AT(mps_stats_config, window, 72); AT(mps_stats_config, window_share, 80); AT(mps_stats_config, period, 88); AT(mps_stats_config, share, 96);
AT(mps_stats_config, crossing_time, 104); AT(mps_stats_config, least_events, 112); AT(mps_stats_config, reserved, 116);
AT(mps_stats_config, seed, 120); AT(mps_stats_config, confidence, 128); AT(mps_stats_config, exposure, 136);
AT(mps_stats_config, exposure_ratio, 144); AT(mps_stats_config, dependence, 152); AT(mps_stats_config, length_scale, 160);
AT(mps_stats_config, density_ratio, 168); AT(mps_stats_config, shift_most, 176); AT(mps_stats_config, order_least, 184);
AT(mps_stats_config, order_most, 192); AT(mps_stats_config, safety, 200); AT(mps_stats_config, safety_poor, 208);
AT(mps_stats_config, omega, 216); AT(mps_stats_config, sensors, 224);

SIZE(mps_harmonics, 288);
AT(mps_harmonics, struct_size, 0); AT(mps_harmonics, count, 4); AT(mps_harmonics, omega, 8); AT(mps_harmonics, mean, 16);
AT(mps_harmonics, rest, 24); AT(mps_harmonics, amplitude, 32); AT(mps_harmonics, phase, 160);

SIZE(mps_series, 32);
AT(mps_series, struct_size, 0); AT(mps_series, reserved, 4); AT(mps_series, n, 8); AT(mps_series, t, 16); AT(mps_series, p, 24);

SIZE(mps_comparison, 160);
AT(mps_comparison, struct_size, 0); AT(mps_comparison, reserved, 4); AT(mps_comparison, t_first, 8); AT(mps_comparison, t_last, 16);
AT(mps_comparison, mean, 24); AT(mps_comparison, rms, 32); AT(mps_comparison, rms_first, 40); AT(mps_comparison, largest, 48);
AT(mps_comparison, t_largest, 56); AT(mps_comparison, peak, 64); AT(mps_comparison, t_peak, 80); AT(mps_comparison, trough, 96);
AT(mps_comparison, t_trough, 112); AT(mps_comparison, shift, 128); AT(mps_comparison, correlation, 136); AT(mps_comparison, phase, 144);
AT(mps_comparison, points, 152);

SIZE(mps_convergence, 32);
AT(mps_convergence, struct_size, 0); AT(mps_convergence, kind, 4); AT(mps_convergence, order, 8); AT(mps_convergence, limit, 16);
AT(mps_convergence, band, 24);

SIZE(mps_repeat, 64);
AT(mps_repeat, struct_size, 0); AT(mps_repeat, count, 4); AT(mps_repeat, t, 8); AT(mps_repeat, mean, 16); AT(mps_repeat, least, 24);
AT(mps_repeat, most, 32); AT(mps_repeat, deviation, 40); AT(mps_repeat, mean_band, 48); AT(mps_repeat, next_band, 56);

SIZE(mps_ship, 96);
AT(mps_ship, struct_size, 0); AT(mps_ship, axes, 4); AT(mps_ship, degrees, 8); AT(mps_ship, order, 12); AT(mps_ship, forward, 24);
AT(mps_ship, up, 48); AT(mps_ship, origin, 72);

SIZE(mps_ship_motion, 152);
AT(mps_ship_motion, struct_size, 0); AT(mps_ship_motion, reserved, 4); AT(mps_ship_motion, value, 8); AT(mps_ship_motion, rate, 56);
AT(mps_ship_motion, accel, 104);

SIZE(mps_config, 216);
AT(mps_config, struct_size, 0); AT(mps_config, dim, 4); AT(mps_config, dp, 8); AT(mps_config, gravity, 16); AT(mps_config, kernel, 40);
AT(mps_config, re_near, 48); AT(mps_config, re_far, 56); AT(mps_config, velocity_scale, 64); AT(mps_config, threads, 72);
AT(mps_config, lost_policy, 76); AT(mps_config, domain_min, 80); AT(mps_config, domain_max, 104); AT(mps_config, speed_limit, 128);
AT(mps_config, allocator, 136); AT(mps_config, log, 160); AT(mps_config, log_user, 168); AT(mps_config, error, 176);
AT(mps_config, error_size, 184); AT(mps_config, parallel, 192);

SIZE(mps_phase, 24);
AT(mps_phase, struct_size, 0); AT(mps_phase, density, 8); AT(mps_phase, viscosity, 16);

SIZE(mps_solver_limits, 24);
AT(mps_solver_limits, struct_size, 0); AT(mps_solver_limits, max_iterations, 4); AT(mps_solver_limits, tolerance, 8);
AT(mps_solver_limits, divergence, 16);

SIZE(mps_tank_pose, 272);
AT(mps_tank_pose, centre, 0); AT(mps_tank_pose, shift, 24); AT(mps_tank_pose, rotation, 48); AT(mps_tank_pose, next_shift, 120);
AT(mps_tank_pose, next_rotation, 144); AT(mps_tank_pose, rate, 216); AT(mps_tank_pose, omega, 240); AT(mps_tank_pose, has_next, 264);
AT(mps_tank_pose, reserved, 268);

SIZE(mps_view, 784);
AT(mps_view, struct_size, 0); AT(mps_view, dim, 4); AT(mps_view, n, 8); AT(mps_view, t, 16); AT(mps_view, dt, 24); AT(mps_view, dp, 32);
AT(mps_view, velocity_scale, 40); AT(mps_view, g, 48); AT(mps_view, phases, 72); AT(mps_view, reserved, 76); AT(mps_view, kind, 80);
AT(mps_view, phase, 88); AT(mps_view, id, 96); AT(mps_view, x, 104); AT(mps_view, area, 112); AT(mps_view, wall_of, 120);
AT(mps_view, viscosity, 128); AT(mps_view, tension, 136); AT(mps_view, setting, 144); AT(mps_view, near, 152); AT(mps_view, far, 280);
AT(mps_view, flux, 408); AT(mps_view, tank, 504); AT(mps_view, fastest, 776);

SIZE(mps_stage, 72);
AT(mps_stage, struct_size, 0); AT(mps_stage, hook, 4); AT(mps_stage, view, 8); AT(mps_stage, data, 16); AT(mps_stage, self, 24);
AT(mps_stage, step, 32); AT(mps_stage, since_jump, 40); AT(mps_stage, dt_limit, 48); AT(mps_stage, level_free, 56);
AT(mps_stage, reserved, 60); AT(mps_stage, host, 64);

SIZE(mps_rows, 32);
AT(mps_rows, struct_size, 0); AT(mps_rows, bytes, 4); AT(mps_rows, name, 8); AT(mps_rows, run, 16); AT(mps_rows, file, 24);

SIZE(mps_sums, 32);
AT(mps_sums, struct_size, 0); AT(mps_sums, bytes, 4); AT(mps_sums, name, 8); AT(mps_sums, run, 16); AT(mps_sums, file, 24);

SIZE(mps_grid, 40);
AT(mps_grid, struct_size, 0); AT(mps_grid, dim, 4); AT(mps_grid, side, 8); AT(mps_grid, buckets, 16); AT(mps_grid, first, 24);
AT(mps_grid, next, 32);

SIZE(mps_shared, 16);
AT(mps_shared, values, 0); AT(mps_shared, components, 8); AT(mps_shared, type, 12);

SIZE(mps_stats_constant, 40);
AT(mps_stats_constant, struct_size, 0); AT(mps_stats_constant, reserved, 4); AT(mps_stats_constant, key, 8);
AT(mps_stats_constant, about, 16); AT(mps_stats_constant, unit, 24); AT(mps_stats_constant, value, 32);

SIZE(mps_impact, 80);
AT(mps_impact, struct_size, 0); AT(mps_impact, unresolved, 4); AT(mps_impact, peak, 8); AT(mps_impact, t, 16); AT(mps_impact, begin, 24);
AT(mps_impact, end, 32); AT(mps_impact, rise, 40); AT(mps_impact, decay, 48); AT(mps_impact, skewness, 56); AT(mps_impact, duration, 64);
AT(mps_impact, impulse, 72);

SIZE(mps_impacts_info, 144);
AT(mps_impacts_info, struct_size, 0); AT(mps_impacts_info, long_exposure, 4); AT(mps_impacts_info, dependent, 8);
AT(mps_impacts_info, reserved, 12); AT(mps_impacts_info, samples, 16); AT(mps_impacts_info, missing, 24); AT(mps_impacts_info, events, 32);
AT(mps_impacts_info, cut, 40); AT(mps_impacts_info, unresolved, 48); AT(mps_impacts_info, threshold, 56); AT(mps_impacts_info, window, 64);
AT(mps_impacts_info, t_first, 72); AT(mps_impacts_info, t_last, 80); AT(mps_impacts_info, rate, 88); AT(mps_impacts_info, correlation, 96);
AT(mps_impacts_info, correlation_limit, 104); AT(mps_impacts_info, exposure, 112); AT(mps_impacts_info, exposure_events, 120);
AT(mps_impacts_info, pressure_scale, 128); AT(mps_impacts_info, time_scale, 136);

SIZE(mps_exceedance, 40);
AT(mps_exceedance, struct_size, 0); AT(mps_exceedance, reserved, 4); AT(mps_exceedance, peak, 8); AT(mps_exceedance, share, 16);
AT(mps_exceedance, band, 24);

SIZE(mps_fit, 136);
AT(mps_fit, struct_size, 0); AT(mps_fit, kind, 4); AT(mps_fit, state, 8); AT(mps_fit, resamples, 12); AT(mps_fit, count, 16);
AT(mps_fit, location, 24); AT(mps_fit, scale, 32); AT(mps_fit, shape, 40); AT(mps_fit, scale_band, 48); AT(mps_fit, shape_band, 64);
AT(mps_fit, moments_scale, 80); AT(mps_fit, moments_shape, 88); AT(mps_fit, log_likelihood, 96); AT(mps_fit, number, 104);
AT(mps_fit, value, 112); AT(mps_fit, value_band, 120);

SIZE(mps_condition, 32);
AT(mps_condition, struct_size, 0); AT(mps_condition, reserved, 4); AT(mps_condition, share, 8); AT(mps_condition, rate, 16);
AT(mps_condition, fit, 24);

SIZE(mps_time_control, 64);
AT(mps_time_control, struct_size, 0); AT(mps_time_control, dt, 8); AT(mps_time_control, cfl, 16); AT(mps_time_control, gravity, 24);
AT(mps_time_control, viscous, 32); AT(mps_time_control, growth, 40); AT(mps_time_control, dt_max, 48); AT(mps_time_control, dt_min, 56);

SIZE(mps_step_info, 176);
AT(mps_step_info, struct_size, 0); AT(mps_step_info, ppe_iterations, 4); AT(mps_step_info, step, 8); AT(mps_step_info, t, 16);
AT(mps_step_info, dt, 24); AT(mps_step_info, cfl, 32); AT(mps_step_info, max_speed, 40); AT(mps_step_info, ppe_residual, 48);
AT(mps_step_info, ppe_divergence, 56); AT(mps_step_info, ppe_unknowns, 64); AT(mps_step_info, lost, 72); AT(mps_step_info, surface, 80);
AT(mps_step_info, seconds, 88); AT(mps_step_info, crossing_time, 128); AT(mps_step_info, ppe_solves, 136);
AT(mps_step_info, separated, 140); AT(mps_step_info, limit, 144); AT(mps_step_info, pockets, 152); AT(mps_step_info, reserved, 156);
AT(mps_step_info, pocket_volume, 160); AT(mps_step_info, pocket_pressure, 168);

SIZE(mps_allocator, 24);
AT(mps_allocator, alloc, 0); AT(mps_allocator, release, 8); AT(mps_allocator, user, 16);

SIZE(mps_voids_config, 40);
AT(mps_voids_config, struct_size, 0); AT(mps_voids_config, reserved, 4); AT(mps_voids_config, side, 8); AT(mps_voids_config, cover, 16);
AT(mps_voids_config, channel, 24); AT(mps_voids_config, least, 32);

SIZE(mps_voids, 120);
AT(mps_voids, struct_size, 0); AT(mps_voids, dim, 4); AT(mps_voids, side, 8); AT(mps_voids, origin, 16); AT(mps_voids, cells, 40);
AT(mps_voids, count, 52); AT(mps_voids, label, 56); AT(mps_voids, size, 64); AT(mps_voids, faces, 72); AT(mps_voids, face_label, 80);
AT(mps_voids, face_cell, 88); AT(mps_voids, face_side, 96); AT(mps_voids, face_behind, 104); AT(mps_voids, face_row, 112);
#endif
/* clang-format on */

/* Everything is checked by the compiler. */
int main(void)
{
    return 0;
}

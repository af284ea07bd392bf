# SPDX-License-Identifier: BSD-3-Clause
"""Members of structs, from the public headers of libmps. Written by bindings/make; do not edit."""
from __future__ import annotations

from ctypes import (CFUNCTYPE, POINTER, Structure, c_char, c_char_p, c_double, c_float, c_int, c_int32, c_int64,
                    c_size_t, c_uint8, c_uint32, c_uint64, c_void_p)

from ._types import *  # noqa: F403

mps_allocator._fields_ = [
    ("alloc", CFUNCTYPE(c_void_p, c_void_p, c_size_t)), ("release", CFUNCTYPE(None, c_void_p, c_void_p)), ("user", c_void_p),
]
mps_motion_state._fields_ = [
    ("struct_size", c_uint32), ("reserved", c_int32), ("value", c_double * 6), ("rate", c_double * 6), ("accel", c_double * 6),
]
mps_motion_pose._fields_ = [
    ("struct_size", c_uint32), ("reserved", c_int32), ("rotation", c_double * 9), ("translation", c_double * 3),
    ("velocity", c_double * 3), ("omega", c_double * 3), ("accel", c_double * 3), ("alpha", c_double * 3),
]
mps_harmonic._fields_ = [
    ("dof", c_int32), ("form", c_int32), ("amplitude", c_double), ("omega", c_double), ("phase", c_double), ("ramp", c_double),
]
mps_body._fields_ = [
    ("struct_size", c_uint32), ("free", c_int32), ("mass", c_double), ("centre_of_mass", c_double * 3), ("inertia", c_double * 9),
    ("stiffness", c_double * 36), ("damping", c_double * 36), ("equilibrium", c_double * 6), ("load", mps_body_load_fn),
    ("user", c_void_p), ("gravity", c_int32), ("reserved", c_int32), ("friction", c_double * 6),
]
mps_body_report._fields_ = [
    ("struct_size", c_uint32), ("free", c_int32), ("pose", c_double * 6), ("velocity", c_double * 6),
    ("acceleration", c_double * 6), ("liquid", c_double * 6), ("external", c_double * 6), ("restoring", c_double * 6),
    ("mass", c_double * 36), ("late", c_double * 6), ("iterations", c_int32), ("reserved", c_int32), ("kinetic", c_double),
    ("spring", c_double), ("weight", c_double), ("damped", c_double), ("external_work", c_double), ("liquid_work", c_double),
    ("start", c_double), ("friction", c_double * 6), ("rubbed", c_double),
]
mps_flux._fields_ = [
    ("struct_size", c_uint32), ("body", c_int32), ("kind", POINTER(c_int32)), ("phase", POINTER(c_int32)),
    ("density", POINTER(c_double)), ("distance", POINTER(c_double)), ("jump", POINTER(c_double)), ("wetted", POINTER(c_double)),
    ("tank_acceleration", POINTER(c_double)), ("g", c_double * 3), ("wall_factor", c_double),
]
mps_parallel._fields_ = [
    ("struct_size", c_uint32), ("threads", c_int32), ("run", CFUNCTYPE(None, c_void_p, c_int32, mps_part_fn, c_void_p)),
    ("user", c_void_p),
]
mps_parallel_rows_job._fields_ = [
    ("n", c_int64), ("parts", c_int32), ("body", mps_range_fn), ("argument", c_void_p),
]
mps_parallel_values._fields_ = [
    ("sums", c_int32), ("maxima", c_int32), ("value", POINTER(c_double)),
]
mps_parallel_reduce_job._fields_ = [
    ("n", c_int64), ("values", POINTER(mps_parallel_values)), ("body", mps_reduce_fn), ("argument", c_void_p),
    ("part", c_double * 16 * 64),
]
mps_kernel._fields_ = [
    ("struct_size", c_uint32), ("id", c_int32), ("fn", mps_kernel_fn), ("user", c_void_p),
]
mps_stencil._fields_ = [
    ("struct_size", c_uint32), ("dim", c_int32), ("host", c_void_p), ("n", c_int64), ("dp", c_double), ("re", c_double),
    ("n0", c_double), ("lambda", c_double), ("kernel", mps_kernel), ("parallel", POINTER(mps_parallel)), ("x", POINTER(c_double)),
    ("begin", POINTER(c_int64)), ("end", POINTER(c_int64)), ("col", POINTER(c_int32)), ("w_r2", POINTER(c_double)),
]
mps_pair._fields_ = [
    ("d", c_double * 3), ("r2", c_double), ("r", c_double), ("w", c_double), ("j", c_int64), ("w_r2", c_double),
]
mps_tank_pose._fields_ = [
    ("centre", c_double * 3), ("shift", c_double * 3), ("rotation", c_double * 9), ("next_shift", c_double * 3),
    ("next_rotation", c_double * 9), ("rate", c_double * 3), ("omega", c_double * 3), ("has_next", c_int32), ("reserved", c_int32),
]
mps_view._fields_ = [
    ("struct_size", c_uint32), ("dim", c_int32), ("n", c_int64), ("t", c_double), ("dt", c_double), ("dp", c_double),
    ("velocity_scale", c_double), ("g", c_double * 3), ("phases", c_int32), ("reserved", c_int32), ("kind", POINTER(c_int32)),
    ("phase", POINTER(c_int32)), ("id", POINTER(c_int64)), ("x", POINTER(c_double)), ("area", POINTER(c_double)),
    ("wall_of", POINTER(c_int32)), ("viscosity", POINTER(c_double)), ("tension", POINTER(c_double)),
    ("setting", POINTER(c_double)), ("near", mps_stencil), ("far", mps_stencil), ("flux", mps_flux), ("tank", mps_tank_pose),
    ("fastest", c_double),
]
mps_stage._fields_ = [
    ("struct_size", c_uint32), ("hook", c_int32), ("view", POINTER(mps_view)), ("data", POINTER(c_void_p)), ("self", c_void_p),
    ("step", c_int64), ("since_jump", c_int64), ("dt_limit", c_double), ("level_free", c_int32), ("reserved", c_int32),
    ("host", c_void_p),
]
mps_rows._fields_ = [
    ("struct_size", c_uint32), ("bytes", c_uint32), ("name", c_char_p), ("run", mps_rows_fn), ("file", c_char_p),
]
mps_sums._fields_ = [
    ("struct_size", c_uint32), ("bytes", c_uint32), ("name", c_char_p), ("run", mps_sums_fn), ("file", c_char_p),
]
mps_grid._fields_ = [
    ("struct_size", c_uint32), ("dim", c_int32), ("side", c_double), ("buckets", c_int64), ("first", POINTER(c_int32)),
    ("next", POINTER(c_int32)),
]
mps_shared._fields_ = [
    ("values", c_void_p), ("components", c_int32), ("type", c_int32),
]
mps_use._fields_ = [
    ("channel", c_char_p), ("access", c_int32),
]
mps_channel._fields_ = [
    ("name", c_char_p), ("unit", c_char_p), ("help", c_char_p), ("components", c_int32), ("type", c_int32), ("life", c_int32),
    ("initial", c_double),
]
mps_setting._fields_ = [
    ("key", c_char_p), ("unit", c_char_p), ("help", c_char_p), ("type", c_int32), ("initial", c_double), ("min", c_double),
    ("max", c_double),
]
mps_verb._fields_ = [
    ("hook", c_int32), ("use_count", c_int32), ("uses", POINTER(mps_use)), ("after", c_char_p), ("before", c_char_p),
    ("run", CFUNCTYPE(c_int, POINTER(mps_stage))), ("device", c_int32), ("reserved", c_int32),
]
mps_model_ops._fields_ = [
    ("struct_size", c_uint32), ("api", c_uint32), ("name", c_char_p), ("help", c_char_p), ("setting_count", c_int32),
    ("channel_count", c_int32), ("verb_count", c_int32), ("part_count", c_int32), ("settings", POINTER(mps_setting)),
    ("channels", POINTER(mps_channel)), ("verbs", POINTER(mps_verb)),
    ("create", CFUNCTYPE(c_int, POINTER(mps_allocator), POINTER(c_void_p))),
    ("destroy", CFUNCTYPE(None, POINTER(mps_allocator), c_void_p)), ("user", c_void_p),
    ("reach", CFUNCTYPE(c_double, POINTER(c_double), c_double)), ("parts", POINTER(c_char_p)),
    ("check", CFUNCTYPE(c_int, POINTER(c_double), c_int64, POINTER(c_char), c_size_t)),
]
mps_exact._fields_ = [
    ("part", c_int64 * 3), ("level", c_int32), ("special", c_int32),
]
mps_exact_values._fields_ = [
    ("sums", c_int32), ("maxima", c_int32), ("sum", POINTER(mps_exact)), ("maximum", POINTER(c_double)),
]
mps_route._fields_ = [
    ("to_count", c_int32), ("from_count", c_int32), ("to", POINTER(c_int32)), ("sent", POINTER(c_int64)),
    ("from", POINTER(c_int32)), ("received", POINTER(c_int64)), ("data", c_void_p),
]
mps_ranks_ops._fields_ = [
    ("struct_size", c_uint32), ("api", c_uint32), ("name", c_char_p),
    ("create", CFUNCTYPE(c_int, POINTER(mps_allocator), POINTER(c_void_p), POINTER(c_char), c_size_t)),
    ("destroy", CFUNCTYPE(None, POINTER(mps_allocator), c_void_p)),
    ("place", CFUNCTYPE(None, c_void_p, POINTER(c_int32), POINTER(c_int32))),
    ("partition", CFUNCTYPE(c_int, c_void_p, c_int32, c_int64, POINTER(c_double), POINTER(c_float))),
    ("owner", CFUNCTYPE(c_int, c_void_p, c_int64, POINTER(c_double), POINTER(c_int32))),
    ("overlap", CFUNCTYPE(c_int, c_void_p, POINTER(c_double), POINTER(c_double), POINTER(c_int32), POINTER(c_int32))),
    ("connect", CFUNCTYPE(c_int, c_void_p, c_int32, POINTER(c_int32), POINTER(c_int64), POINTER(mps_route))),
    ("disconnect", CFUNCTYPE(None, c_void_p, POINTER(mps_route))),
    ("exchange_begin", CFUNCTYPE(c_int, c_void_p, POINTER(mps_route), c_size_t, c_void_p, c_void_p)),
    ("exchange_end", CFUNCTYPE(c_int, c_void_p, POINTER(mps_route))),
    ("reduce", CFUNCTYPE(c_int, c_void_p, c_int32, c_size_t, c_void_p, mps_combine_fn)),
    ("gather", CFUNCTYPE(c_int, c_void_p, c_void_p, POINTER(c_int64), c_void_p)), ("fail", CFUNCTYPE(None, c_void_p, c_char_p)),
    ("failure", CFUNCTYPE(c_void_p, c_void_p)), ("user", c_void_p),
]
mps_ppe_ranks._fields_ = [
    ("struct_size", c_uint32), ("rank", c_int32), ("ranks", c_int32), ("reserved", c_int32), ("ghosts", c_int64),
    ("rows", c_int64), ("first", c_int64), ("order", POINTER(c_int32)),
    ("owner", CFUNCTYPE(c_int, c_void_p, c_int64, POINTER(c_double), POINTER(c_int32))),
    ("halo", CFUNCTYPE(c_int, c_void_p, POINTER(c_double))),
    ("reduce", CFUNCTYPE(c_int, c_void_p, c_int32, c_size_t, c_void_p, mps_combine_fn)),
    ("gather", CFUNCTYPE(c_int, c_void_p, c_void_p, POINTER(c_int64), c_void_p)),
    ("connect", CFUNCTYPE(c_int, c_void_p, c_int32, POINTER(c_int32), POINTER(c_int64), POINTER(mps_route))),
    ("disconnect", CFUNCTYPE(None, c_void_p, POINTER(mps_route))),
    ("exchange", CFUNCTYPE(c_int, c_void_p, POINTER(mps_route), c_size_t, c_void_p, c_void_p)), ("host", c_void_p),
]
mps_ppe_hint._fields_ = [
    ("struct_size", c_uint32), ("refused", c_int32), ("unsolvable", POINTER(c_double)),
    ("reduce", CFUNCTYPE(None, c_void_p, POINTER(c_double))), ("owner", c_void_p), ("reduced", c_double),
]
mps_ppe_problem._fields_ = [
    ("struct_size", c_uint32), ("dim", c_int32), ("n", c_int64), ("row", POINTER(c_int64)), ("col", POINTER(c_int32)),
    ("val", POINTER(c_float)), ("diagonal", POINTER(c_double)), ("rhs", POINTER(c_double)), ("shift", POINTER(c_double)),
    ("weight", POINTER(c_double)), ("x", POINTER(c_double)), ("dp", c_double), ("tolerance", c_double), ("divergence", c_double),
    ("max_iterations", c_int32), ("components", c_int32), ("component", POINTER(c_int32)), ("gas", POINTER(c_double)),
    ("law", POINTER(c_double)), ("parallel", POINTER(mps_parallel)), ("ranks", POINTER(mps_ppe_ranks)),
    ("device", POINTER(mps_allocator)), ("hint", POINTER(mps_ppe_hint)),
]
mps_ppe_result._fields_ = [
    ("struct_size", c_uint32), ("reason", c_int32), ("iterations", c_int32), ("reserved", c_int32), ("residual", c_double),
    ("divergence", c_double), ("setup_seconds", c_double),
]
mps_preconditioner_ops._fields_ = [
    ("struct_size", c_uint32), ("api", c_uint32), ("name", c_char_p), ("symmetric", c_int32),
    ("create", CFUNCTYPE(c_int, POINTER(mps_allocator), POINTER(c_void_p))),
    ("setup", CFUNCTYPE(c_int, c_void_p, POINTER(mps_ppe_problem))),
    ("apply", CFUNCTYPE(c_int, c_void_p, POINTER(c_double), POINTER(c_double))),
    ("destroy", CFUNCTYPE(None, POINTER(mps_allocator), c_void_p)), ("user", c_void_p), ("help", c_char_p), ("ranks", c_int32),
    ("device", c_int32), ("reach", c_double), ("release_device", CFUNCTYPE(None, c_void_p)), ("fallback", c_char_p),
    ("setup_async", c_int32), ("reserved", c_int32),
]
mps_solver_ops._fields_ = [
    ("struct_size", c_uint32), ("api", c_uint32), ("name", c_char_p), ("preconditioner", c_char_p), ("symmetric", c_int32),
    ("create", CFUNCTYPE(c_int, POINTER(mps_allocator), POINTER(c_void_p))),
    ("solve", CFUNCTYPE(None, c_void_p, POINTER(mps_ppe_problem), POINTER(mps_preconditioner_ops), c_void_p, POINTER(c_double), POINTER(mps_ppe_result))),
    ("destroy", CFUNCTYPE(None, POINTER(mps_allocator), c_void_p)), ("nonlinear", c_int32), ("user", c_void_p), ("help", c_char_p),
    ("ranks", c_int32), ("device", c_int32), ("hint", c_int32), ("release_device", CFUNCTYPE(None, c_void_p)),
]
mps_drive_ops._fields_ = [
    ("struct_size", c_uint32), ("api", c_uint32), ("name", c_char_p), ("help", c_char_p), ("setting_count", c_int32),
    ("reserved", c_int32), ("settings", POINTER(mps_setting)),
    ("load", CFUNCTYPE(c_int, c_void_p, POINTER(c_double), c_double, POINTER(mps_motion_state), POINTER(c_double))),
    ("motion", CFUNCTYPE(c_int, c_void_p, POINTER(c_double), c_double, POINTER(mps_motion_state))),
    ("period", CFUNCTYPE(c_double, POINTER(c_double))), ("user", c_void_p),
]
mps_registry._fields_ = [
    ("struct_size", c_uint32), ("api", c_uint32), ("host", c_void_p),
    ("model", CFUNCTYPE(c_int32, c_void_p, POINTER(mps_model_ops))),
    ("solver", CFUNCTYPE(c_int32, c_void_p, POINTER(mps_solver_ops))),
    ("preconditioner", CFUNCTYPE(c_int32, c_void_p, POINTER(mps_preconditioner_ops))),
    ("drive", CFUNCTYPE(c_int32, c_void_p, POINTER(mps_drive_ops))), ("plugin_api", c_uint32), ("reserved", c_int32),
    ("name", c_char_p), ("version", c_char_p),
]
mps_plugin_info._fields_ = [
    ("struct_size", c_uint32), ("items", c_int32), ("path", c_char_p), ("sha256", c_char_p), ("name", c_char_p),
    ("version", c_char_p),
]
mps_plugin_item._fields_ = [
    ("struct_size", c_uint32), ("kind", c_int32), ("name", c_char_p), ("help", c_char_p), ("drive", POINTER(mps_drive_ops)),
]
mps_probe._fields_ = [
    ("struct_size", c_uint32), ("type", c_int32), ("at", c_double * 3), ("direction", c_double * 3), ("diameter", c_double),
    ("length", c_double), ("part", c_char_p), ("count_drops", c_int32), ("average", c_double), ("rate", c_double),
    ("phases", c_uint32), ("name", c_char_p), ("normal", c_double * 3),
]
mps_probe_info._fields_ = [
    ("struct_size", c_uint32), ("type", c_int32), ("name", c_char_p), ("part", c_char_p), ("at", c_double * 3),
    ("normal", c_double * 3), ("diameter", c_double), ("values", c_int32),
]
mps_energy._fields_ = [
    ("struct_size", c_uint32), ("kinetic", c_double), ("potential", c_double), ("wall_work_momentum", c_double),
    ("wall_work_probes", c_double), ("viscous", c_double), ("plugins", c_double), ("collision", c_double), ("shift", c_double),
    ("numerical", c_double), ("mass", c_double), ("volume", c_double), ("volume_error", c_double), ("centre", c_double * 3),
    ("momentum", c_double * 3), ("added", c_double), ("volume_filled", c_double), ("mass_filled", c_double),
    ("friction", c_double), ("layers", c_double), ("gas", c_double),
]
mps_momentum._fields_ = [
    ("struct_size", c_uint32), ("total", c_double * 3), ("gravity", c_double * 3), ("force", c_double * 3),
    ("plugins", c_double * 3), ("reaction", c_double * 3), ("pressure", c_double * 3), ("walls", c_double * 3),
    ("numerical", c_double * 3), ("collision", c_double * 3), ("shift", c_double * 3), ("added", c_double * 3),
    ("friction", c_double * 3),
]
mps_job_ranks._fields_ = [
    ("struct_size", c_uint32), ("rank", c_int32), ("count", c_int32), ("user", c_void_p),
    ("attach", CFUNCTYPE(c_int32, c_void_p, POINTER(mps_sim))),
    ("largest", CFUNCTYPE(c_int32, c_void_p, c_int32, POINTER(c_int32), c_double)),
    ("largest_numbers", CFUNCTYPE(None, c_void_p, c_int32, POINTER(c_double))), ("end", CFUNCTYPE(None, c_void_p)),
    ("abort", CFUNCTYPE(None, c_void_p, c_int32)),
]
mps_job_config._fields_ = [
    ("struct_size", c_uint32), ("resume", c_int32), ("name", c_char_p), ("title", c_char_p), ("command", c_char_p),
    ("text", c_char_p), ("model", c_char_p), ("folder", c_char_p), ("t_end", c_double), ("row_interval", c_double),
    ("checkpoint", c_double), ("gravity", c_double), ("average", c_double), ("frames", c_int32), ("picture_count", c_int32),
    ("picture_t", POINTER(c_double)), ("overwrite", c_int32), ("pieces", c_int32), ("tank_frame", c_int32), ("report", c_int32),
    ("profile", c_int32), ("quiet", c_int32), ("signals", c_int32), ("trace", c_int32), ("film", c_int32), ("threads", c_int32),
    ("page_bytes", c_int64), ("ranks", POINTER(mps_job_ranks)), ("print", mps_job_print_fn), ("print_user", c_void_p),
    ("error", POINTER(c_char)), ("error_size", c_size_t), ("dp", c_double), ("device", c_char_p), ("peaks", c_int32),
    ("reserved", c_int32), ("checkpoint_clock", c_double),
]
mps_job_column._fields_ = [
    ("struct_size", c_uint32), ("flags", c_int32), ("name", c_char_p), ("unit", c_char_p), ("about", c_char_p),
]
mps_measure._fields_ = [
    ("struct_size", c_uint32), ("phase", c_int32), ("axis", c_int32), ("change", c_int32), ("at_end", c_int32),
    ("measure", c_char_p), ("name", c_char_p), ("about", c_char_p), ("part", c_char_p), ("box", c_double * 6),
    ("centre", c_double * 3), ("radius", c_double), ("level", c_double), ("smoothing", c_double),
]
mps_measure_info._fields_ = [
    ("struct_size", c_uint32), ("dim", c_int32), ("name", c_char_p), ("unit", c_char_p), ("unit_3d", c_char_p), ("help", c_char_p),
]
mps_trace._fields_ = [
    ("struct_size", c_uint32), ("kind", c_int32), ("name", c_char_p), ("about", c_char_p), ("column", c_char_p),
    ("from", c_double), ("to", c_double), ("window", c_double), ("scale", c_double),
]
mps_reference._fields_ = [
    ("struct_size", c_uint32), ("line", c_int32), ("label", c_char_p), ("unit", c_char_p), ("column", c_char_p),
    ("count", c_int64), ("t", POINTER(c_double)), ("value", POINTER(c_double)),
]
mps_case_message._fields_ = [
    ("struct_size", c_uint32), ("warning", c_int32), ("line", c_int32), ("column", c_int32), ("file", c_char_p),
    ("text", c_char_p), ("source", c_char_p),
]
mps_case_options._fields_ = [
    ("struct_size", c_uint32), ("load", c_int32), ("set_count", c_int32), ("plugin_count", c_int32), ("set", POINTER(c_char_p)),
    ("plugin", POINTER(c_char_p)), ("text", c_char_p), ("size", c_size_t),
]
mps_case_cost._fields_ = [
    ("struct_size", c_uint32), ("reserved", c_int32), ("wall_least", c_double), ("wall_most", c_double), ("memory", c_double),
]
mps_case_key._fields_ = [
    ("struct_size", c_uint32), ("required", c_int32), ("path", c_char_p), ("range", c_char_p), ("otherwise", c_char_p),
    ("example", c_char_p), ("help", c_char_p), ("kind", c_char * 96), ("units", c_char * 160),
]
mps_load._fields_ = [
    ("struct_size", c_uint32), ("has_mass", c_int32), ("force", c_double * 6), ("rest", c_double * 6), ("mass", c_double * 36),
    ("acceleration", c_double * 6), ("dt", c_double), ("iterations", c_int32), ("reserved", c_int32),
]
mps_launch._fields_ = [
    ("struct_size", c_uint32), ("dim", c_int32), ("n", c_int64), ("file", c_char_p), ("name", c_char_p),
    ("view", POINTER(mps_view)), ("fields", c_void_p), ("bytes", c_uint64), ("sums", c_int32), ("maxima", c_int32),
    ("run", CFUNCTYPE(None, c_void_p, c_int64, c_int64, POINTER(mps_exact), POINTER(c_double))), ("host", c_void_p),
    ("cancel", POINTER(c_int64)), ("mask", POINTER(c_uint8)),
]
mps_device_ops._fields_ = [
    ("struct_size", c_uint32), ("api", c_uint32), ("name", c_char_p), ("self", c_void_p),
    ("alloc", CFUNCTYPE(c_void_p, c_void_p, c_uint64)), ("free", CFUNCTYPE(None, c_void_p, c_void_p)),
    ("upload", CFUNCTYPE(c_int, c_void_p, c_void_p, c_void_p, c_uint64)),
    ("download", CFUNCTYPE(c_int, c_void_p, c_void_p, c_void_p, c_uint64)),
    ("clear", CFUNCTYPE(c_int, c_void_p, c_void_p, c_uint64)), ("copy", CFUNCTYPE(c_int, c_void_p, c_void_p, c_void_p, c_uint64)),
    ("launch", CFUNCTYPE(c_int, c_void_p, POINTER(mps_launch))),
    ("reduce", CFUNCTYPE(c_int, c_void_p, POINTER(mps_launch), POINTER(mps_exact), POINTER(c_double))),
    ("reduce_async", CFUNCTYPE(c_int, c_void_p, POINTER(mps_launch), c_void_p)), ("wait", CFUNCTYPE(c_int, c_void_p)),
    ("failure", CFUNCTYPE(c_void_p, c_void_p)), ("invalidated", CFUNCTYPE(None, c_void_p, c_void_p, c_uint64, c_uint32)),
    ("begin", CFUNCTYPE(c_int, c_void_p)), ("end", CFUNCTYPE(None, c_void_p)), ("plugin_loops", c_int32), ("reserved", c_int32),
]
mps_device_info._fields_ = [
    ("struct_size", c_uint32), ("host_calls", c_int32), ("name", c_char_p), ("launches", c_int64), ("waits", c_int64),
    ("uploads", c_int64), ("downloads", c_int64), ("bytes_up", c_int64), ("bytes_down", c_int64), ("bytes_held", c_int64),
]
mps_tank._fields_ = [
    ("struct_size", c_uint32), ("name", c_char_p), ("lo", c_double * 3), ("size", c_double * 3), ("open_top", c_int32),
    ("dummy_layers", c_int32),
]
mps_solid._fields_ = [
    ("struct_size", c_uint32), ("dummy_layers", c_int32), ("name", c_char_p), ("lo", c_double * 3), ("hi", c_double * 3),
    ("distance", mps_distance_fn), ("inside", mps_inside_fn), ("user", c_void_p), ("invert", c_int32),
]
mps_stl._fields_ = [
    ("struct_size", c_uint32), ("dummy_layers", c_int32), ("name", c_char_p), ("scale", c_double), ("rotation", c_double * 3),
    ("shift", c_double * 3), ("container", c_int32), ("open_side", c_int32),
]
mps_model_info._fields_ = [
    ("struct_size", c_uint32), ("active", c_int32), ("name", c_char_p), ("help", c_char_p), ("settings", c_int32),
    ("channels", c_int32), ("verbs", c_int32), ("built_in", c_int32),
]
mps_setting_info._fields_ = [
    ("struct_size", c_uint32), ("type", c_int32), ("key", c_char_p), ("unit", c_char_p), ("help", c_char_p), ("initial", c_double),
    ("min", c_double), ("max", c_double), ("value", c_double),
]
mps_channel_info._fields_ = [
    ("struct_size", c_uint32), ("components", c_int32), ("type", c_int32), ("life", c_int32), ("name", c_char_p),
    ("unit", c_char_p), ("help", c_char_p), ("reads", c_uint32), ("writes", c_uint32), ("own", c_int32),
]
mps_verb_info._fields_ = [
    ("struct_size", c_uint32), ("hook", c_int32), ("hook_name", c_char_p), ("model", c_char_p), ("uses", c_char_p),
]
mps_pass_info._fields_ = [
    ("struct_size", c_uint32), ("hook", c_int32), ("hook_name", c_char_p), ("name", c_char_p), ("uses", c_char_p),
    ("model", c_int32), ("reserved", c_int32), ("calls", c_int64), ("seconds", c_double), ("bytes", c_double),
]
mps_name_info._fields_ = [
    ("struct_size", c_uint32), ("active", c_int32), ("name", c_char_p), ("help", c_char_p),
]
mps_particle_block._fields_ = [
    ("struct_size", c_uint32), ("kind", c_int32), ("phase", c_int32), ("part", c_char_p), ("count", c_int64),
    ("position", POINTER(c_double)), ("velocity", POINTER(c_double)), ("area", POINTER(c_double)),
]
mps_lease._fields_ = [
    ("struct_size", c_uint32), ("type", c_int32), ("stride", c_int32), ("slot", c_int32), ("count", c_int64),
    ("data", POINTER(c_double)), ("integers", POINTER(c_int32)), ("ids", POINTER(c_int64)),
]
mps_ship._fields_ = [
    ("struct_size", c_uint32), ("axes", c_int32), ("degrees", c_int32), ("order", c_int32 * 3), ("forward", c_double * 3),
    ("up", c_double * 3), ("origin", c_double * 3),
]
mps_ship_motion._fields_ = [
    ("struct_size", c_uint32), ("reserved", c_int32), ("value", c_double * 6), ("rate", c_double * 6), ("accel", c_double * 6),
]
mps_config._fields_ = [
    ("struct_size", c_uint32), ("dim", c_int32), ("dp", c_double), ("gravity", c_double * 3), ("kernel", c_char_p),
    ("re_near", c_double), ("re_far", c_double), ("velocity_scale", c_double), ("threads", c_int32), ("lost_policy", c_int32),
    ("domain_min", c_double * 3), ("domain_max", c_double * 3), ("speed_limit", c_double), ("allocator", mps_allocator),
    ("log", mps_log_fn), ("log_user", c_void_p), ("error", POINTER(c_char)), ("error_size", c_size_t), ("parallel", mps_parallel),
]
mps_phase._fields_ = [
    ("struct_size", c_uint32), ("density", c_double), ("viscosity", c_double),
]
mps_solver_limits._fields_ = [
    ("struct_size", c_uint32), ("max_iterations", c_int32), ("tolerance", c_double), ("divergence", c_double),
]
mps_time_control._fields_ = [
    ("struct_size", c_uint32), ("dt", c_double), ("cfl", c_double), ("gravity", c_double), ("viscous", c_double),
    ("growth", c_double), ("dt_max", c_double), ("dt_min", c_double),
]
mps_step_info._fields_ = [
    ("struct_size", c_uint32), ("ppe_iterations", c_int32), ("step", c_int64), ("t", c_double), ("dt", c_double),
    ("cfl", c_double), ("max_speed", c_double), ("ppe_residual", c_double), ("ppe_divergence", c_double),
    ("ppe_unknowns", c_int64), ("lost", c_int64), ("surface", c_int64), ("seconds", c_double * 5), ("crossing_time", c_double),
    ("ppe_solves", c_int32), ("separated", c_int32), ("limit", c_char_p), ("pockets", c_int32), ("reserved", c_int32),
    ("pocket_volume", c_double), ("pocket_pressure", c_double),
]
mps_stats_config._fields_ = [
    ("struct_size", c_uint32), ("resamples", c_int32), ("error", POINTER(c_char)), ("error_size", c_size_t), ("from", c_double),
    ("until", c_double), ("rate", c_double), ("high_pass", c_double), ("threshold", c_double), ("deviations", c_double),
    ("window", c_double), ("window_share", c_double), ("period", c_double), ("share", c_double), ("crossing_time", c_double),
    ("least_events", c_int32), ("reserved", c_int32), ("seed", c_uint64), ("confidence", c_double), ("exposure", c_double),
    ("exposure_ratio", c_double), ("dependence", c_double), ("length_scale", c_double), ("density_ratio", c_double),
    ("shift_most", c_double), ("order_least", c_double), ("order_most", c_double), ("safety", c_double), ("safety_poor", c_double),
    ("omega", c_double), ("sensors", c_char * 512),
]
mps_harmonics._fields_ = [
    ("struct_size", c_uint32), ("count", c_int32), ("omega", c_double), ("mean", c_double), ("rest", c_double),
    ("amplitude", c_double * 16), ("phase", c_double * 16),
]
mps_series._fields_ = [
    ("struct_size", c_uint32), ("reserved", c_int32), ("n", c_int64), ("t", POINTER(c_double)), ("p", POINTER(c_double)),
]
mps_comparison._fields_ = [
    ("struct_size", c_uint32), ("reserved", c_int32), ("t_first", c_double), ("t_last", c_double), ("mean", c_double),
    ("rms", c_double), ("rms_first", c_double), ("largest", c_double), ("t_largest", c_double), ("peak", c_double * 2),
    ("t_peak", c_double * 2), ("trough", c_double * 2), ("t_trough", c_double * 2), ("shift", c_double), ("correlation", c_double),
    ("phase", c_double), ("points", c_int64),
]
mps_convergence._fields_ = [
    ("struct_size", c_uint32), ("kind", c_int32), ("order", c_double), ("limit", c_double), ("band", c_double),
]
mps_repeat._fields_ = [
    ("struct_size", c_uint32), ("count", c_int32), ("t", c_double), ("mean", c_double), ("least", c_double), ("most", c_double),
    ("deviation", c_double), ("mean_band", c_double), ("next_band", c_double),
]
mps_page_config._fields_ = [
    ("struct_size", c_uint32), ("frames", c_int32), ("bytes", c_int64), ("error", POINTER(c_char)), ("error_size", c_size_t),
    ("impacts", POINTER(mps_stats_config)),
]
mps_page_info._fields_ = [
    ("struct_size", c_uint32), ("frames", c_int32), ("bytes", c_int64), ("particles", c_int64), ("left_out", c_char * 320),
]
mps_picture_config._fields_ = [
    ("struct_size", c_uint32), ("width", c_int32), ("title", c_char_p), ("gravity", c_double), ("pressure_lo", c_double),
    ("pressure_hi", c_double), ("sensors", c_int32), ("reserved", c_int32), ("error", POINTER(c_char)), ("error_size", c_size_t),
    ("edges", POINTER(c_double)), ("edge_count", c_int32), ("reserved_2", c_int32),
]
mps_film_config._fields_ = [
    ("struct_size", c_uint32), ("width", c_int32), ("rate", c_double), ("program", c_char_p), ("error", POINTER(c_char)),
    ("error_size", c_size_t),
]
mps_stats_constant._fields_ = [
    ("struct_size", c_uint32), ("reserved", c_int32), ("key", c_char_p), ("about", c_char_p), ("unit", c_char_p),
    ("value", c_double),
]
mps_impact._fields_ = [
    ("struct_size", c_uint32), ("unresolved", c_int32), ("peak", c_double), ("t", c_double), ("begin", c_double),
    ("end", c_double), ("rise", c_double), ("decay", c_double), ("skewness", c_double), ("duration", c_double),
    ("impulse", c_double),
]
mps_impacts_info._fields_ = [
    ("struct_size", c_uint32), ("long_exposure", c_int32), ("dependent", c_int32), ("reserved", c_int32), ("samples", c_int64),
    ("missing", c_int64), ("events", c_int64), ("cut", c_int64), ("unresolved", c_int64), ("threshold", c_double),
    ("window", c_double), ("t_first", c_double), ("t_last", c_double), ("rate", c_double), ("correlation", c_double),
    ("correlation_limit", c_double), ("exposure", c_double), ("exposure_events", c_double), ("pressure_scale", c_double),
    ("time_scale", c_double),
]
mps_exceedance._fields_ = [
    ("struct_size", c_uint32), ("reserved", c_int32), ("peak", c_double), ("share", c_double), ("band", c_double * 2),
]
mps_fit._fields_ = [
    ("struct_size", c_uint32), ("kind", c_int32), ("state", c_int32), ("resamples", c_int32), ("count", c_int64),
    ("location", c_double), ("scale", c_double), ("shape", c_double), ("scale_band", c_double * 2), ("shape_band", c_double * 2),
    ("moments_scale", c_double), ("moments_shape", c_double), ("log_likelihood", c_double), ("number", c_double),
    ("value", c_double), ("value_band", c_double * 2),
]
mps_condition._fields_ = [
    ("struct_size", c_uint32), ("reserved", c_int32), ("share", c_double), ("rate", c_double), ("fit", POINTER(mps_fit)),
]
mps_voids_config._fields_ = [
    ("struct_size", c_uint32), ("reserved", c_int32), ("side", c_double), ("cover", c_double), ("channel", c_double),
    ("least", c_double),
]
mps_voids._fields_ = [
    ("struct_size", c_uint32), ("dim", c_int32), ("side", c_double), ("origin", c_double * 3), ("cells", c_int32 * 3),
    ("count", c_int32), ("label", POINTER(c_int32)), ("size", POINTER(c_int32)), ("faces", c_int64),
    ("face_label", POINTER(c_int32)), ("face_cell", POINTER(c_int32)), ("face_side", POINTER(c_int32)),
    ("face_behind", POINTER(c_int32)), ("face_row", POINTER(c_int32)),
]

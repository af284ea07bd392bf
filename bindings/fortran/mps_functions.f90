! SPDX-License-Identifier: BSD-3-Clause
! From the public headers of libmps, which explain everything; written by bindings/make, do not edit.
module mps_functions
    use, intrinsic :: iso_c_binding
    use mps_types
    implicit none
    interface
        function mps_status_name(status) bind(C) result(result_)
            import; integer(c_int32_t), value :: status; type(c_ptr) :: result_; end function
        function mps_status_text(status) bind(C) result(result_)
            import; integer(c_int32_t), value :: status; type(c_ptr) :: result_; end function
        function mps_motion_state_init(state, size) bind(C) result(result_)
            import; type(mps_motion_state), optional :: state; integer(c_size_t), value :: size; &
                integer(c_int32_t) :: result_; end function
        function mps_motion_pose_init(pose, size) bind(C) result(result_)
            import; type(mps_motion_pose), optional :: pose; integer(c_size_t), value :: size; integer(c_int32_t) :: result_; &
                end function
        function mps_motion_pose_from_state(state, pose) bind(C) result(result_)
            import; type(mps_motion_state), intent(in), optional :: state; type(mps_motion_pose), optional :: pose; &
                integer(c_int32_t) :: result_; end function
        function mps_motion_pose_to_state(pose, state) bind(C) result(result_)
            import; type(mps_motion_pose), intent(in), optional :: pose; type(mps_motion_state), optional :: state; &
                integer(c_int32_t) :: result_; end function
        function mps_motion_centre_set(sim, centre, start) bind(C) result(result_)
            import; type(c_ptr), value :: sim; real(c_double), intent(in), optional :: centre(*); integer(c_int32_t), &
                value :: start; integer(c_int32_t) :: result_; end function
        function mps_motion_harmonics_set(sim, count, harmonics) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: count; type(mps_harmonic), intent(in), &
                optional :: harmonics(*); integer(c_int32_t) :: result_; end function
        function mps_motion_table_set(sim, rows, t, dofs, dof, values) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int64_t), value :: rows; real(c_double), intent(in), &
                optional :: t(*); integer(c_int32_t), value :: dofs; integer(c_int32_t), intent(in), optional :: dof(*); &
                real(c_double), intent(in), optional :: values(*); integer(c_int32_t) :: result_; end function
        function mps_motion_callback_set(sim, fn, user) bind(C) result(result_)
            import; type(c_ptr), value :: sim; type(c_funptr), value :: fn; type(c_ptr), value :: user; &
                integer(c_int32_t) :: result_; end function
        function mps_motion_clear(sim) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t) :: result_; end function
        function mps_motion_state_get(sim, state) bind(C) result(result_)
            import; type(c_ptr), value :: sim; type(mps_motion_state), optional :: state; integer(c_int32_t) :: result_; &
                end function
        function mps_motion_state_at(sim, t, state) bind(C) result(result_)
            import; type(c_ptr), value :: sim; real(c_double), value :: t; type(mps_motion_state), optional :: state; &
                integer(c_int32_t) :: result_; end function
        function mps_motion_to_lab(sim, tank, lab, velocity) bind(C) result(result_)
            import; type(c_ptr), value :: sim; real(c_double), intent(in), optional :: tank(*); real(c_double), &
                optional :: lab(*); real(c_double), optional :: velocity(*); integer(c_int32_t) :: result_; end function
        function mps_body_init(body, size) bind(C) result(result_)
            import; type(mps_body), optional :: body; integer(c_size_t), value :: size; integer(c_int32_t) :: result_; &
                end function
        function mps_body_set(sim, body) bind(C) result(result_)
            import; type(c_ptr), value :: sim; type(mps_body), intent(in), optional :: body; integer(c_int32_t) :: result_; &
                end function
        function mps_body_report_init(report, size) bind(C) result(result_)
            import; type(mps_body_report), optional :: report; integer(c_size_t), value :: size; &
                integer(c_int32_t) :: result_; end function
        function mps_body_get(sim, report) bind(C) result(result_)
            import; type(c_ptr), value :: sim; type(mps_body_report), optional :: report; integer(c_int32_t) :: result_; &
                end function
        function mps_kernel_init(kernel, size) bind(C) result(result_)
            import; type(mps_kernel), optional :: kernel; integer(c_size_t), value :: size; integer(c_int32_t) :: result_; &
                end function
        function mps_kernel_find(name, kernel) bind(C) result(result_)
            import; character(kind=c_char), intent(in), optional :: name(*); type(mps_kernel), optional :: kernel; &
                integer(c_int32_t) :: result_; end function
        function mps_kernel_custom(fn, user, kernel) bind(C) result(result_)
            import; type(c_funptr), value :: fn; type(c_ptr), value :: user; type(mps_kernel), optional :: kernel; &
                integer(c_int32_t) :: result_; end function
        function mps_kernel_value(kernel, r, re) bind(C) result(result_)
            import; type(mps_kernel), intent(in), optional :: kernel; real(c_double), value :: r; real(c_double), &
                value :: re; real(c_double) :: result_; end function
        function mps_lattice_constants(kernel, dim, dp, re, n0, lambda) bind(C) result(result_)
            import; type(mps_kernel), intent(in), optional :: kernel; integer(c_int32_t), value :: dim; real(c_double), &
                value :: dp; real(c_double), value :: re; real(c_double), optional :: n0; real(c_double), optional :: lambda; &
                integer(c_int32_t) :: result_; end function
        function mps_kernel_use(sim, kernel) bind(C) result(result_)
            import; type(c_ptr), value :: sim; type(mps_kernel), intent(in), optional :: kernel; &
                integer(c_int32_t) :: result_; end function
        function mps_stencil_init(stencil, size) bind(C) result(result_)
            import; type(mps_stencil), optional :: stencil; integer(c_size_t), value :: size; integer(c_int32_t) :: result_; &
                end function
        function mps_neighbours_create(dim, dp, allocator, list) bind(C) result(result_)
            import; integer(c_int32_t), value :: dim; real(c_double), value :: dp; type(mps_allocator), intent(in), &
                optional :: allocator; type(c_ptr) :: list; integer(c_int32_t) :: result_; end function
        subroutine mps_neighbours_destroy(list) bind(C)
            import; type(c_ptr), value :: list; end subroutine
        function mps_neighbours_error(list) bind(C) result(result_)
            import; type(c_ptr), value :: list; type(c_ptr) :: result_; end function
        function mps_neighbours_parallel_set(list, parallel) bind(C) result(result_)
            import; type(c_ptr), value :: list; type(mps_parallel), intent(in), optional :: parallel; &
                integer(c_int32_t) :: result_; end function
        function mps_neighbours_build(list, n, x, re_near, re_far) bind(C) result(result_)
            import; type(c_ptr), value :: list; integer(c_int64_t), value :: n; real(c_double), intent(in), optional :: x(*); &
                real(c_double), value :: re_near; real(c_double), value :: re_far; integer(c_int32_t) :: result_; end function
        function mps_neighbours_stencil_get(list, which, kernel, stencil) bind(C) result(result_)
            import; type(c_ptr), value :: list; integer(c_int32_t), value :: which; type(mps_kernel), intent(in), &
                optional :: kernel; type(mps_stencil), optional :: stencil; integer(c_int32_t) :: result_; end function
        function mps_stencil_get(sim, which, stencil) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: which; type(mps_stencil), optional :: stencil; &
                integer(c_int32_t) :: result_; end function
        function mps_op_number_density(s, n) bind(C) result(result_)
            import; type(mps_stencil), intent(in), optional :: s; real(c_double), optional :: n(*); &
                integer(c_int32_t) :: result_; end function
        function mps_op_volume_deviation(s, delta) bind(C) result(result_)
            import; type(mps_stencil), intent(in), optional :: s; real(c_double), optional :: delta(*); &
                integer(c_int32_t) :: result_; end function
        function mps_op_volume_sum(s, f, sum) bind(C) result(result_)
            import; type(mps_stencil), intent(in), optional :: s; real(c_double), intent(in), optional :: f(*); &
                real(c_double), optional :: sum(*); integer(c_int32_t) :: result_; end function
        function mps_op_gradient(s, f, grad) bind(C) result(result_)
            import; type(mps_stencil), intent(in), optional :: s; real(c_double), intent(in), optional :: f(*); &
                real(c_double), optional :: grad(*); integer(c_int32_t) :: result_; end function
        function mps_op_gradient_conservative(s, f, grad) bind(C) result(result_)
            import; type(mps_stencil), intent(in), optional :: s; real(c_double), intent(in), optional :: f(*); &
                real(c_double), optional :: grad(*); integer(c_int32_t) :: result_; end function
        function mps_op_gradient_corrected(s, b, f, grad) bind(C) result(result_)
            import; type(mps_stencil), intent(in), optional :: s; real(c_double), intent(in), optional :: b(*); &
                real(c_double), intent(in), optional :: f(*); real(c_double), optional :: grad(*); &
                integer(c_int32_t) :: result_; end function
        function mps_op_divergence(s, u, div) bind(C) result(result_)
            import; type(mps_stencil), intent(in), optional :: s; real(c_double), intent(in), optional :: u(*); &
                real(c_double), optional :: div(*); integer(c_int32_t) :: result_; end function
        function mps_op_divergence_corrected(s, b, u, div) bind(C) result(result_)
            import; type(mps_stencil), intent(in), optional :: s; real(c_double), intent(in), optional :: b(*); &
                real(c_double), intent(in), optional :: u(*); real(c_double), optional :: div(*); &
                integer(c_int32_t) :: result_; end function
        function mps_op_laplacian(s, f, lap) bind(C) result(result_)
            import; type(mps_stencil), intent(in), optional :: s; real(c_double), intent(in), optional :: f(*); &
                real(c_double), optional :: lap(*); integer(c_int32_t) :: result_; end function
        function mps_op_laplacian_vector(s, u, lap) bind(C) result(result_)
            import; type(mps_stencil), intent(in), optional :: s; real(c_double), intent(in), optional :: u(*); &
                real(c_double), optional :: lap(*); integer(c_int32_t) :: result_; end function
        function mps_op_asymmetry(s, a) bind(C) result(result_)
            import; type(mps_stencil), intent(in), optional :: s; real(c_double), optional :: a(*); &
                integer(c_int32_t) :: result_; end function
        function mps_op_correction(s, floor, b) bind(C) result(result_)
            import; type(mps_stencil), intent(in), optional :: s; real(c_double), value :: floor; real(c_double), &
                optional :: b(*); integer(c_int32_t) :: result_; end function
        function mps_matrix_inverse_bounded(dim, m, floor, inverse) bind(C) result(result_)
            import; integer(c_int32_t), value :: dim; real(c_double), intent(in), optional :: m(*); real(c_double), &
                value :: floor; real(c_double), optional :: inverse(*); integer(c_int32_t) :: result_; end function
        function mps_probe_init(probe, size) bind(C) result(result_)
            import; type(mps_probe), optional :: probe; integer(c_size_t), value :: size; integer(c_int32_t) :: result_; &
                end function
        function mps_probe_add(sim, probe, id) bind(C) result(result_)
            import; type(c_ptr), value :: sim; type(mps_probe), intent(in), optional :: probe; integer(c_int32_t), &
                optional :: id; integer(c_int32_t) :: result_; end function
        function mps_probe_remove(sim, id) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: id; integer(c_int32_t) :: result_; end function
        function mps_probe_info_init(info, size) bind(C) result(result_)
            import; type(mps_probe_info), optional :: info; integer(c_size_t), value :: size; integer(c_int32_t) :: result_; &
                end function
        function mps_probe_info_get(sim, id, info) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: id; type(mps_probe_info), optional :: info; &
                integer(c_int32_t) :: result_; end function
        function mps_probe_size(sim, id) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: id; integer(c_int32_t) :: result_; end function
        function mps_probe_read(sim, id, values) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: id; real(c_double), optional :: values(*); &
                integer(c_int32_t) :: result_; end function
        function mps_probe_series(sim, id, count, t, values) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: id; integer(c_int64_t), optional :: count; &
                type(c_ptr) :: t; type(c_ptr) :: values; integer(c_int32_t) :: result_; end function
        function mps_probe_series_clear(sim, id) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: id; integer(c_int32_t) :: result_; end function
        function mps_energy_init(energy, size) bind(C) result(result_)
            import; type(mps_energy), optional :: energy; integer(c_size_t), value :: size; integer(c_int32_t) :: result_; &
                end function
        function mps_energy_get(sim, energy) bind(C) result(result_)
            import; type(c_ptr), value :: sim; type(mps_energy), optional :: energy; integer(c_int32_t) :: result_; end function
        function mps_momentum_init(momentum, size) bind(C) result(result_)
            import; type(mps_momentum), optional :: momentum; integer(c_size_t), value :: size; &
                integer(c_int32_t) :: result_; end function
        function mps_momentum_get(sim, momentum) bind(C) result(result_)
            import; type(c_ptr), value :: sim; type(mps_momentum), optional :: momentum; integer(c_int32_t) :: result_; &
                end function
        function mps_snapshot_create(sim, snapshot) bind(C) result(result_)
            import; type(c_ptr), value :: sim; type(c_ptr) :: snapshot; integer(c_int32_t) :: result_; end function
        function mps_snapshot_take(snapshot) bind(C) result(result_)
            import; type(c_ptr), value :: snapshot; integer(c_int32_t) :: result_; end function
        function mps_snapshot_restore(snapshot) bind(C) result(result_)
            import; type(c_ptr), value :: snapshot; integer(c_int32_t) :: result_; end function
        subroutine mps_snapshot_destroy(snapshot) bind(C)
            import; type(c_ptr), value :: snapshot; end subroutine
        function mps_motion_pose_set(sim, t_end, state) bind(C) result(result_)
            import; type(c_ptr), value :: sim; real(c_double), value :: t_end; type(mps_motion_state), intent(in), &
                optional :: state; integer(c_int32_t) :: result_; end function
        function mps_load_watch(sim, what) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: what; integer(c_int32_t) :: result_; end function
        function mps_load_init(load, size) bind(C) result(result_)
            import; type(mps_load), optional :: load; integer(c_size_t), value :: size; integer(c_int32_t) :: result_; &
                end function
        function mps_load_get(sim, centre, load) bind(C) result(result_)
            import; type(c_ptr), value :: sim; real(c_double), intent(in), optional :: centre(*); type(mps_load), &
                optional :: load; integer(c_int32_t) :: result_; end function
        function mps_tank_init(tank, size) bind(C) result(result_)
            import; type(mps_tank), optional :: tank; integer(c_size_t), value :: size; integer(c_int32_t) :: result_; &
                end function
        function mps_tank_add(sim, tank, built) bind(C) result(result_)
            import; type(c_ptr), value :: sim; type(mps_tank), intent(in), optional :: tank; real(c_double), &
                optional :: built(*); integer(c_int32_t) :: result_; end function
        function mps_lattice_get(sim, lo, h) bind(C) result(result_)
            import; type(c_ptr), value :: sim; real(c_double), optional :: lo(*); real(c_double), optional :: h(*); &
                integer(c_int32_t) :: result_; end function
        function mps_baffle_add(sim, name, lo, hi, built) bind(C) result(result_)
            import; type(c_ptr), value :: sim; character(kind=c_char), intent(in), optional :: name(*); real(c_double), &
                intent(in), optional :: lo(*); real(c_double), intent(in), optional :: hi(*); real(c_double), &
                optional :: built(*); integer(c_int32_t) :: result_; end function
        function mps_plate_add(sim, name, corner, edge, edge2) bind(C) result(result_)
            import; type(c_ptr), value :: sim; character(kind=c_char), intent(in), optional :: name(*); real(c_double), &
                intent(in), optional :: corner(*); real(c_double), intent(in), optional :: edge(*); real(c_double), &
                intent(in), optional :: edge2(*); integer(c_int32_t) :: result_; end function
        function mps_fill_box_add(sim, phase, lo, hi, added, built) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: phase; real(c_double), intent(in), &
                optional :: lo(*); real(c_double), intent(in), optional :: hi(*); integer(c_int64_t), optional :: added; &
                real(c_double), optional :: built(*); integer(c_int32_t) :: result_; end function
        function mps_fill_level_add(sim, phase, lo, hi, added, built) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: phase; real(c_double), intent(in), &
                optional :: lo(*); real(c_double), intent(in), optional :: hi(*); integer(c_int64_t), optional :: added; &
                real(c_double), optional :: built(*); integer(c_int32_t) :: result_; end function
        function mps_fill_add(sim, phase, inside, user, added) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: phase; type(c_funptr), value :: inside; &
                type(c_ptr), value :: user; integer(c_int64_t), optional :: added; integer(c_int32_t) :: result_; end function
        function mps_solid_init(solid, size) bind(C) result(result_)
            import; type(mps_solid), optional :: solid; integer(c_size_t), value :: size; integer(c_int32_t) :: result_; &
                end function
        function mps_solid_add(sim, solid) bind(C) result(result_)
            import; type(c_ptr), value :: sim; type(mps_solid), intent(in), optional :: solid; integer(c_int32_t) :: result_; &
                end function
        function mps_stl_init(stl, size) bind(C) result(result_)
            import; type(mps_stl), optional :: stl; integer(c_size_t), value :: size; integer(c_int32_t) :: result_; &
                end function
        function mps_stl_add(sim, path, stl, built) bind(C) result(result_)
            import; type(c_ptr), value :: sim; character(kind=c_char), intent(in), optional :: path(*); type(mps_stl), &
                intent(in), optional :: stl; real(c_double), optional :: built(*); integer(c_int32_t) :: result_; end function
        function mps_stl_edges(sim, path, stl, angle, capacity, ends, count) bind(C) result(result_)
            import; type(c_ptr), value :: sim; character(kind=c_char), intent(in), optional :: path(*); type(mps_stl), &
                intent(in), optional :: stl; real(c_double), value :: angle; integer(c_int64_t), value :: capacity; &
                real(c_double), optional :: ends(*); integer(c_int64_t), optional :: count; integer(c_int32_t) :: result_; &
                end function
        function mps_model_info_init(info, size) bind(C) result(result_)
            import; type(mps_model_info), optional :: info; integer(c_size_t), value :: size; integer(c_int32_t) :: result_; &
                end function
        function mps_setting_info_init(info, size) bind(C) result(result_)
            import; type(mps_setting_info), optional :: info; integer(c_size_t), value :: size; &
                integer(c_int32_t) :: result_; end function
        function mps_channel_info_init(info, size) bind(C) result(result_)
            import; type(mps_channel_info), optional :: info; integer(c_size_t), value :: size; &
                integer(c_int32_t) :: result_; end function
        function mps_verb_info_init(info, size) bind(C) result(result_)
            import; type(mps_verb_info), optional :: info; integer(c_size_t), value :: size; integer(c_int32_t) :: result_; &
                end function
        function mps_pass_info_init(info, size) bind(C) result(result_)
            import; type(mps_pass_info), optional :: info; integer(c_size_t), value :: size; integer(c_int32_t) :: result_; &
                end function
        function mps_name_info_init(info, size) bind(C) result(result_)
            import; type(mps_name_info), optional :: info; integer(c_size_t), value :: size; integer(c_int32_t) :: result_; &
                end function
        function mps_model_info_get(sim, index, info) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: index; type(mps_model_info), optional :: info; &
                integer(c_int32_t) :: result_; end function
        function mps_setting_info_get(sim, model, index, info) bind(C) result(result_)
            import; type(c_ptr), value :: sim; character(kind=c_char), intent(in), optional :: model(*); integer(c_int32_t), &
                value :: index; type(mps_setting_info), optional :: info; integer(c_int32_t) :: result_; end function
        function mps_channel_info_get(sim, index, info) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: index; type(mps_channel_info), optional :: info; &
                integer(c_int32_t) :: result_; end function
        function mps_verb_info_get(sim, index, info) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: index; type(mps_verb_info), optional :: info; &
                integer(c_int32_t) :: result_; end function
        function mps_pass_info_get(sim, index, info) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: index; type(mps_pass_info), optional :: info; &
                integer(c_int32_t) :: result_; end function
        function mps_profile_reset(sim) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t) :: result_; end function
        function mps_preset_info_get(sim, index, info) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: index; type(mps_name_info), optional :: info; &
                integer(c_int32_t) :: result_; end function
        function mps_solver_info_get(sim, index, info) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: index; type(mps_name_info), optional :: info; &
                integer(c_int32_t) :: result_; end function
        function mps_preconditioner_info_get(sim, index, info) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: index; type(mps_name_info), optional :: info; &
                integer(c_int32_t) :: result_; end function
        function mps_kernel_info_get(sim, index, info) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: index; type(mps_name_info), optional :: info; &
                integer(c_int32_t) :: result_; end function
        function mps_frames_open(sim, folder, name, kinds, frames) bind(C) result(result_)
            import; type(c_ptr), value :: sim; character(kind=c_char), intent(in), optional :: folder(*); &
                character(kind=c_char), intent(in), optional :: name(*); integer(c_int32_t), value :: kinds; &
                type(c_ptr) :: frames; integer(c_int32_t) :: result_; end function
        function mps_frames_write(frames) bind(C) result(result_)
            import; type(c_ptr), value :: frames; integer(c_int32_t) :: result_; end function
        function mps_frames_remove(frames, wanted, user) bind(C) result(result_)
            import; type(c_ptr), value :: frames; type(c_funptr), value :: wanted; type(c_ptr), value :: user; &
                integer(c_int32_t) :: result_; end function
        subroutine mps_frames_close(frames) bind(C)
            import; type(c_ptr), value :: frames; end subroutine
        function mps_checkpoint_write(sim, path) bind(C) result(result_)
            import; type(c_ptr), value :: sim; character(kind=c_char), intent(in), optional :: path(*); &
                integer(c_int32_t) :: result_; end function
        function mps_checkpoint_note_add(sim, text) bind(C) result(result_)
            import; type(c_ptr), value :: sim; character(kind=c_char), intent(in), optional :: text(*); &
                integer(c_int32_t) :: result_; end function
        function mps_checkpoint_read(sim, path) bind(C) result(result_)
            import; type(c_ptr), value :: sim; character(kind=c_char), intent(in), optional :: path(*); &
                integer(c_int32_t) :: result_; end function
        function mps_particle_block_init(block, size) bind(C) result(result_)
            import; type(mps_particle_block), optional :: block; integer(c_size_t), value :: size; &
                integer(c_int32_t) :: result_; end function
        function mps_particles_add(sim, block, ids) bind(C) result(result_)
            import; type(c_ptr), value :: sim; type(mps_particle_block), intent(in), optional :: block; integer(c_int64_t), &
                optional :: ids(*); integer(c_int32_t) :: result_; end function
        function mps_particles_remove(sim, count, ids) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int64_t), value :: count; integer(c_int64_t), intent(in), &
                optional :: ids(*); integer(c_int32_t) :: result_; end function
        function mps_particles_count(sim, kind) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: kind; integer(c_int64_t) :: result_; end function
        function mps_particle_index(sim, id) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int64_t), value :: id; integer(c_int64_t) :: result_; end function
        function mps_field_add(sim, name, components) bind(C) result(result_)
            import; type(c_ptr), value :: sim; character(kind=c_char), intent(in), optional :: name(*); integer(c_int32_t), &
                value :: components; integer(c_int32_t) :: result_; end function
        function mps_lease_init(lease, size) bind(C) result(result_)
            import; type(mps_lease), optional :: lease; integer(c_size_t), value :: size; integer(c_int32_t) :: result_; &
                end function
        function mps_lease_begin(sim, field, mode, lease) bind(C) result(result_)
            import; type(c_ptr), value :: sim; character(kind=c_char), intent(in), optional :: field(*); integer(c_int32_t), &
                value :: mode; type(mps_lease), optional :: lease; integer(c_int32_t) :: result_; end function
        function mps_lease_end(sim, lease) bind(C) result(result_)
            import; type(c_ptr), value :: sim; type(mps_lease), optional :: lease; integer(c_int32_t) :: result_; end function
        function mps_part_find(sim, name) bind(C) result(result_)
            import; type(c_ptr), value :: sim; character(kind=c_char), intent(in), optional :: name(*); &
                integer(c_int32_t) :: result_; end function
        function mps_ship_init(ship, size) bind(C) result(result_)
            import; type(mps_ship), optional :: ship; integer(c_size_t), value :: size; integer(c_int32_t) :: result_; &
                end function
        function mps_ship_motion_init(motion, size) bind(C) result(result_)
            import; type(mps_ship_motion), optional :: motion; integer(c_size_t), value :: size; &
                integer(c_int32_t) :: result_; end function
        function mps_ship_to_tank(ship, motion, tank) bind(C) result(result_)
            import; type(mps_ship), intent(in), optional :: ship; type(mps_ship_motion), intent(in), optional :: motion; &
                type(mps_motion_state), optional :: tank; integer(c_int32_t) :: result_; end function
        function mps_ship_from_tank(ship, tank, motion) bind(C) result(result_)
            import; type(mps_ship), intent(in), optional :: ship; type(mps_motion_state), intent(in), optional :: tank; &
                type(mps_ship_motion), optional :: motion; integer(c_int32_t) :: result_; end function
        function mps_ship_table(ship, rows, columns, dofs, dof, values) bind(C) result(result_)
            import; type(mps_ship), intent(in), optional :: ship; integer(c_int64_t), value :: rows; real(c_double), &
                intent(in), optional :: columns(*); integer(c_int32_t), value :: dofs; integer(c_int32_t), intent(in), &
                optional :: dof(*); real(c_double), optional :: values(*); integer(c_int32_t) :: result_; end function
        function mps_ship_vector_from_lab(ship, tank, axes, lab, vector) bind(C) result(result_)
            import; type(mps_ship), intent(in), optional :: ship; type(mps_motion_state), intent(in), optional :: tank; &
                integer(c_int32_t), value :: axes; real(c_double), intent(in), optional :: lab(*); real(c_double), &
                optional :: vector(*); integer(c_int32_t) :: result_; end function
        function mps_ship_vector_to_lab(ship, tank, axes, vector, lab) bind(C) result(result_)
            import; type(mps_ship), intent(in), optional :: ship; type(mps_motion_state), intent(in), optional :: tank; &
                integer(c_int32_t), value :: axes; real(c_double), intent(in), optional :: vector(*); real(c_double), &
                optional :: lab(*); integer(c_int32_t) :: result_; end function
        function mps_ship_load_from_lab(ship, tank, axes, at, lab, load) bind(C) result(result_)
            import; type(mps_ship), intent(in), optional :: ship; type(mps_motion_state), intent(in), optional :: tank; &
                integer(c_int32_t), value :: axes; real(c_double), intent(in), optional :: at(*); real(c_double), intent(in), &
                optional :: lab(*); real(c_double), optional :: load(*); integer(c_int32_t) :: result_; end function
        function mps_ship_load_to_lab(ship, tank, axes, at, load, lab) bind(C) result(result_)
            import; type(mps_ship), intent(in), optional :: ship; type(mps_motion_state), intent(in), optional :: tank; &
                integer(c_int32_t), value :: axes; real(c_double), intent(in), optional :: at(*); real(c_double), intent(in), &
                optional :: load(*); real(c_double), optional :: lab(*); integer(c_int32_t) :: result_; end function
        function mps_config_init(config, size) bind(C) result(result_)
            import; type(mps_config), optional :: config; integer(c_size_t), value :: size; integer(c_int32_t) :: result_; &
                end function
        function mps_sim_create(config, sim) bind(C) result(result_)
            import; type(mps_config), intent(in), optional :: config; type(c_ptr) :: sim; integer(c_int32_t) :: result_; &
                end function
        subroutine mps_sim_destroy(sim) bind(C)
            import; type(c_ptr), value :: sim; end subroutine
        function mps_sim_error(sim) bind(C) result(result_)
            import; type(c_ptr), value :: sim; type(c_ptr) :: result_; end function
        function mps_sim_shape(sim, dim, dp) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), optional :: dim; real(c_double), optional :: dp; &
                integer(c_int32_t) :: result_; end function
        function mps_sim_time(sim, t, steps) bind(C) result(result_)
            import; type(c_ptr), value :: sim; real(c_double), optional :: t; integer(c_int64_t), optional :: steps; &
                integer(c_int32_t) :: result_; end function
        function mps_threads_set(sim, threads) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: threads; integer(c_int32_t) :: result_; end function
        function mps_phase_init(phase, size) bind(C) result(result_)
            import; type(mps_phase), optional :: phase; integer(c_size_t), value :: size; integer(c_int32_t) :: result_; &
                end function
        function mps_phase_set(sim, index, phase) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: index; type(mps_phase), intent(in), &
                optional :: phase; integer(c_int32_t) :: result_; end function
        function mps_phase_get(sim, index, phase) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: index; type(mps_phase), optional :: phase; &
                integer(c_int32_t) :: result_; end function
        function mps_tension_set(sim, a, b, sigma) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: a; integer(c_int32_t), value :: b; &
                real(c_double), value :: sigma; integer(c_int32_t) :: result_; end function
        function mps_tension_get(sim, a, b, sigma) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: a; integer(c_int32_t), value :: b; &
                real(c_double), optional :: sigma; integer(c_int32_t) :: result_; end function
        function mps_preset_use(sim, name) bind(C) result(result_)
            import; type(c_ptr), value :: sim; character(kind=c_char), intent(in), optional :: name(*); &
                integer(c_int32_t) :: result_; end function
        function mps_model_use(sim, name) bind(C) result(result_)
            import; type(c_ptr), value :: sim; character(kind=c_char), intent(in), optional :: name(*); &
                integer(c_int32_t) :: result_; end function
        function mps_model_remove(sim, slot) bind(C) result(result_)
            import; type(c_ptr), value :: sim; character(kind=c_char), intent(in), optional :: slot(*); &
                integer(c_int32_t) :: result_; end function
        function mps_model_set(sim, slot, key, value) bind(C) result(result_)
            import; type(c_ptr), value :: sim; character(kind=c_char), intent(in), optional :: slot(*); &
                character(kind=c_char), intent(in), optional :: key(*); real(c_double), value :: value; &
                integer(c_int32_t) :: result_; end function
        function mps_model_get(sim, slot, key, value) bind(C) result(result_)
            import; type(c_ptr), value :: sim; character(kind=c_char), intent(in), optional :: slot(*); &
                character(kind=c_char), intent(in), optional :: key(*); real(c_double), optional :: value; &
                integer(c_int32_t) :: result_; end function
        function mps_model_state(sim, slot, values, count) bind(C) result(result_)
            import; type(c_ptr), value :: sim; character(kind=c_char), intent(in), optional :: slot(*); &
                type(c_ptr) :: values; integer(c_int64_t), optional :: count; integer(c_int32_t) :: result_; end function
        function mps_model_name(sim, index) bind(C) result(result_)
            import; type(c_ptr), value :: sim; integer(c_int32_t), value :: index; type(c_ptr) :: result_; end function
        function mps_solver_limits_init(limits, size) bind(C) result(result_)
            import; type(mps_solver_limits), optional :: limits; integer(c_size_t), value :: size; &
                integer(c_int32_t) :: result_; end function
        function mps_solver_use(sim, solver, preconditioner) bind(C) result(result_)
            import; type(c_ptr), value :: sim; character(kind=c_char), intent(in), optional :: solver(*); &
                character(kind=c_char), intent(in), optional :: preconditioner(*); integer(c_int32_t) :: result_; end function
        function mps_solver_limits_set(sim, limits) bind(C) result(result_)
            import; type(c_ptr), value :: sim; type(mps_solver_limits), intent(in), optional :: limits; &
                integer(c_int32_t) :: result_; end function
        function mps_solver_name(sim, solver, preconditioner) bind(C) result(result_)
            import; type(c_ptr), value :: sim; type(c_ptr) :: solver; type(c_ptr) :: preconditioner; &
                integer(c_int32_t) :: result_; end function
        function mps_time_control_init(control, size) bind(C) result(result_)
            import; type(mps_time_control), optional :: control; integer(c_size_t), value :: size; &
                integer(c_int32_t) :: result_; end function
        function mps_time_control_set(sim, control) bind(C) result(result_)
            import; type(c_ptr), value :: sim; type(mps_time_control), intent(in), optional :: control; &
                integer(c_int32_t) :: result_; end function
        function mps_step_info_init(info, size) bind(C) result(result_)
            import; type(mps_step_info), optional :: info; integer(c_size_t), value :: size; integer(c_int32_t) :: result_; &
                end function
        function mps_step_info_get(sim, info) bind(C) result(result_)
            import; type(c_ptr), value :: sim; type(mps_step_info), optional :: info; integer(c_int32_t) :: result_; &
                end function
        function mps_step(sim, dt_max, info) bind(C) result(result_)
            import; type(c_ptr), value :: sim; real(c_double), value :: dt_max; type(mps_step_info), optional :: info; &
                integer(c_int32_t) :: result_; end function
        function mps_run(sim, t_end, monitor, user) bind(C) result(result_)
            import; type(c_ptr), value :: sim; real(c_double), value :: t_end; type(c_funptr), value :: monitor; type(c_ptr), &
                value :: user; integer(c_int32_t) :: result_; end function
        function mps_version(major, minor, patch) bind(C) result(result_)
            import; integer(c_int), optional :: major; integer(c_int), optional :: minor; integer(c_int), optional :: patch; &
                type(c_ptr) :: result_; end function
    end interface
end module mps_functions

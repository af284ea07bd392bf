! SPDX-License-Identifier: BSD-3-Clause
! The modules of Fortran as a program of a user sees them: layouts, values, texts, arguments that are left out.
program consumer
    use mps
    implicit none
    type(c_ptr) :: sim = c_null_ptr, frames = c_null_ptr, snapshot = c_null_ptr
    type(mps_config) :: config
    type(mps_tank) :: tank
    type(mps_probe) :: probe
    type(mps_lease) :: lease
    type(mps_step_info) :: info
    type(mps_harmonic) :: harmonics(2)
    type(mps_motion_state) :: state
    real(c_double), pointer :: x(:)
    real(c_double) :: built(3), dp, p(1)
    integer(c_int32_t) :: id, dim
    integer(c_int64_t) :: added

    if (mps_layout_differs() /= ' ') error stop 'layout'
    call mps_check(c_null_ptr, mps_config_init(config, c_sizeof(config)))
    if (mps_sim_create(config, sim) /= MPS_E_ARG) error stop 'a config without dp was taken'
    config%dp = 0.05_c_double
    call mps_check(c_null_ptr, mps_sim_create(config, sim))
    if (mps_tank_init(tank, 3_c_size_t) /= MPS_E_ARG) error stop 'a wrong size was taken'
    call mps_check(sim, mps_tank_init(tank, c_sizeof(tank)))
    tank%size(1:2) = [1.0_c_double, 0.6_c_double]
    call mps_check(sim, mps_tank_add(sim, tank, built))
    if (abs(built(2) - 0.6_c_double) > 1e-12_c_double) error stop 'built'
    call mps_check(sim, mps_fill_level_add(sim, 0, [0.0_c_double, 0.0_c_double], [1.0_c_double, 0.3_c_double], added))
    if (added /= mps_particles_count(sim, MPS_FLUID)) error stop 'added'
    call mps_check(sim, mps_sim_shape(sim, dim=dim)) ! dp is left out
    call mps_check(sim, mps_sim_shape(sim, dp=dp))
    if (dim /= 2 .or. abs(dp - 0.05_c_double) > 1e-12_c_double) error stop 'shape'

    if (mps_model_use(sim, 'gas.poket' // c_null_char) /= MPS_E_NAME) error stop 'a model of no name'
    if (index(mps_text(mps_sim_error(sim)), 'gas.pocket') == 0) error stop 'text'
    harmonics(1)%dof = MPS_MOVE_X
    harmonics(1)%amplitude = 0.01_c_double
    harmonics(1)%omega = 5
    harmonics(2)%dof = MPS_ROTATE_Z
    call mps_check(sim, mps_motion_harmonics_set(sim, 2, harmonics))
    call mps_check(sim, mps_probe_init(probe, c_sizeof(probe)))
    probe%type = MPS_PROBE_WALL_PRESSURE
    probe%at(2) = 0.1_c_double
    call mps_check(sim, mps_probe_add(sim, probe, id))
    call mps_check(sim, mps_run(sim, 0.1_c_double, c_null_funptr, c_null_ptr))
    call mps_check(sim, mps_step_info_init(info, c_sizeof(info)))
    call mps_check(sim, mps_step(sim, 1.0_c_double, info))
    if (info%t <= 0.1_c_double .or. info%ppe_iterations < 1) error stop 'info'
    call mps_check(sim, mps_probe_read(sim, id, p))
    if (abs(p(1) / 1962 - 1) > 0.2_c_double) error stop 'pressure'
    call mps_check(sim, mps_motion_state_init(state, c_sizeof(state)))
    call mps_check(sim, mps_motion_state_get(sim, state))
    if (abs(state%value(1) - 0.01_c_double * sin(5 * info%t)) > 1e-12_c_double) error stop 'pose'

    call mps_check(sim, mps_lease_init(lease, c_sizeof(lease)))
    call mps_check(sim, mps_lease_begin(sim, 'position' // c_null_char, MPS_READ, lease))
    call c_f_pointer(lease%data, x, [lease%count * lease%stride])
    if (maxval(x) > 1.3_c_double .or. maxval(x) < 1) error stop 'position'
    call mps_check(sim, mps_lease_end(sim, lease))
    call mps_check(sim, mps_frames_open(sim, '.' // c_null_char, 'fortran' // c_null_char, 0, frames))
    call mps_check(sim, mps_snapshot_create(sim, snapshot))
    call mps_close(sim, frames, snapshot)
    call mps_close(sim, frames, snapshot)
    if (mps_step(sim, 1.0_c_double, info) /= MPS_E_ARG) error stop 'a step of what was closed'
    if (mps_frames_write(frames) /= MPS_E_ARG) error stop 'a frame of what was closed'
    if (mps_snapshot_take(snapshot) /= MPS_E_ARG) error stop 'a snapshot of what was closed'
    print '(a)', 'Fortran: layouts, values, texts'
end program consumer

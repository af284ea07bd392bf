! SPDX-License-Identifier: BSD-3-Clause
! A tank that rolls, from Fortran: pressure at the wall, energies, a picture of the particles in
! ParaView.
!   F=$(pkg-config --variable=fortrandir mps)
!   gfortran $F/mps_types.f90 $F/mps_functions.f90 $F/mps.f90 tank.f90 \
!       $(pkg-config --libs mps) -o tank
module roll
    use mps
    implicit none
    real(c_double), parameter :: amplitude = 0.07_c_double, omega = 5.0_c_double
contains
    ! Pose at a time: 1 - cos, so that the tank starts with velocity 0.
    function pose(user, t, state) bind(C) result(failed)
        type(c_ptr), value :: user
        real(c_double), value :: t
        type(mps_motion_state), intent(inout) :: state
        integer(c_int) :: failed
        state%value(MPS_ROTATE_Z + 1) = amplitude * (1 - cos(omega * t))
        state%rate(MPS_ROTATE_Z + 1) = amplitude * omega * sin(omega * t)
        state%accel(MPS_ROTATE_Z + 1) = amplitude * omega**2 * cos(omega * t)
        failed = 0
        if (c_associated(user)) failed = 1 ! no data of ours was given
    end function pose

    ! Called after every step; not 0 stops the run.
    function watch(user, sim, info) bind(C) result(stop_)
        type(c_ptr), value :: user, sim
        type(mps_step_info), intent(in) :: info
        integer(c_int) :: stop_
        type(mps_energy) :: energy
        stop_ = 0
        if (c_associated(user) .or. mod(info%step, 100_c_int64_t) /= 0) return
        call mps_check(sim, mps_energy_init(energy, c_sizeof(energy)))
        call mps_check(sim, mps_energy_get(sim, energy))
        print '(a, f6.3, a, f8.3, a, i0, a)', 't = ', info%t, ' s, kinetic energy ', energy%kinetic, ' J/m, ', &
            info%ppe_iterations, ' iterations'
    end function watch
end module roll

program tank
    use roll
    implicit none
    type(mps_config) :: config
    type(mps_tank) :: box
    type(mps_probe) :: probe
    type(mps_time_control) :: control
    type(c_ptr) :: sim = c_null_ptr, frames = c_null_ptr
    integer(c_int32_t) :: wall, status
    integer(c_int64_t) :: added
    real(c_double) :: pressure(1)

    call mps_check(c_null_ptr, mps_config_init(config, c_sizeof(config)))
    config%dp = 0.02_c_double
    call mps_check(c_null_ptr, mps_sim_create(config, sim))
    call mps_check(sim, mps_tank_init(box, c_sizeof(box)))
    box%size = [1.0_c_double, 0.6_c_double, 0.0_c_double]
    call mps_check(sim, mps_tank_add(sim, box))
    call mps_check(sim, mps_fill_level_add(sim, 0, [0.0_c_double, 0.0_c_double], [1.0_c_double, 0.3_c_double], added))
    print '(i0, a)', added, ' particles'

    call mps_check(sim, mps_motion_centre_set(sim, [0.5_c_double, 0.0_c_double], MPS_START_AT_REST))
    call mps_check(sim, mps_motion_callback_set(sim, c_funloc(pose), c_null_ptr))
    call mps_check(sim, mps_time_control_init(control, c_sizeof(control)))
    control%dt_max = 2 * acos(-1.0_c_double) / omega / 20
    call mps_check(sim, mps_time_control_set(sim, control))
    call mps_check(sim, mps_probe_init(probe, c_sizeof(probe)))
    probe%type = MPS_PROBE_WALL_PRESSURE
    probe%at(2) = 0.1_c_double
    call mps_check(sim, mps_probe_add(sim, probe, wall))

    status = mps_run(sim, 1.0_c_double, c_funloc(watch), c_null_ptr)
    call mps_check(sim, status)
    call mps_check(sim, mps_probe_read(sim, wall, pressure))
    print '(a, f8.1, a)', 'pressure ', pressure(1), ' Pa'
    call mps_check(sim, mps_frames_open(sim, '.' // c_null_char, 'tank_frames' // c_null_char, 0, frames))
    call mps_check(sim, mps_frames_write(frames))
    call mps_frames_close(frames)
    call mps_close(sim)
end program tank

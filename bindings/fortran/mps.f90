! SPDX-License-Identifier: BSD-3-Clause
! From the public headers of libmps, which explain everything; written by bindings/make, do not edit.
module mps
    use, intrinsic :: iso_c_binding
    use mps_types
    use mps_functions
    implicit none
contains
    !> A text of C.
    function mps_text(text) result(found)
        type(c_ptr), intent(in) :: text
        character(len=:), allocatable :: found
        character(kind=c_char), pointer :: c(:)
        integer :: n
        found = ''
        if (.not. c_associated(text)) return
        call c_f_pointer(text, c, [65536])
        n = 1
        do while (c(n) /= c_null_char)
            found = found // c(n)
            n = n + 1
        end do
    end function mps_text

    !> End the program with the library's text where a call failed.
    subroutine mps_check(sim, status)
        type(c_ptr), intent(in) :: sim
        integer(c_int32_t), intent(in) :: status
        if (status >= 0) return
        if (c_associated(sim)) then
            print '(2a)', 'libmps: ', mps_text(mps_sim_error(sim))
        else
            print '(2a)', 'libmps: ', mps_text(mps_status_text(status))
        end if
        error stop 1
    end subroutine mps_check

    !> Destroy a simulation after its frames and a snapshot, and forget them: a later call with them fails with MPS_E_ARG, a second mps_close
    !> does nothing. Not allowed in a callback.
    subroutine mps_close(sim, frames, snapshot)
        type(c_ptr), intent(inout) :: sim
        type(c_ptr), intent(inout), optional :: frames, snapshot
        if (present(frames)) then
            call mps_frames_close(frames)
            frames = c_null_ptr
        end if
        if (present(snapshot)) then
            call mps_snapshot_destroy(snapshot)
            snapshot = c_null_ptr
        end if
        call mps_sim_destroy(sim)
        sim = c_null_ptr
    end subroutine mps_close

    !> Name of the first type that this compiler lays out in another way than C, or blanks.
    function mps_layout_differs() result(name)
        character(len=32) :: name
        type(mps_allocator) :: mps_allocator_
        type(mps_motion_state) :: mps_motion_state_
        type(mps_motion_pose) :: mps_motion_pose_
        type(mps_harmonic) :: mps_harmonic_
        type(mps_body) :: mps_body_
        type(mps_body_report) :: mps_body_report_
        type(mps_parallel) :: mps_parallel_
        type(mps_kernel) :: mps_kernel_
        type(mps_stencil) :: mps_stencil_
        type(mps_pair) :: mps_pair_
        type(mps_probe) :: mps_probe_
        type(mps_probe_info) :: mps_probe_info_
        type(mps_energy) :: mps_energy_
        type(mps_momentum) :: mps_momentum_
        type(mps_load) :: mps_load_
        type(mps_tank) :: mps_tank_
        type(mps_solid) :: mps_solid_
        type(mps_stl) :: mps_stl_
        type(mps_model_info) :: mps_model_info_
        type(mps_setting_info) :: mps_setting_info_
        type(mps_channel_info) :: mps_channel_info_
        type(mps_verb_info) :: mps_verb_info_
        type(mps_pass_info) :: mps_pass_info_
        type(mps_name_info) :: mps_name_info_
        type(mps_particle_block) :: mps_particle_block_
        type(mps_lease) :: mps_lease_
        type(mps_ship) :: mps_ship_
        type(mps_ship_motion) :: mps_ship_motion_
        type(mps_config) :: mps_config_
        type(mps_phase) :: mps_phase_
        type(mps_solver_limits) :: mps_solver_limits_
        type(mps_time_control) :: mps_time_control_
        type(mps_step_info) :: mps_step_info_
        name = ' '
        if (name == ' ' .and. c_sizeof(mps_allocator_) /= 24) name = 'mps_allocator'
        if (name == ' ' .and. c_sizeof(mps_motion_state_) /= 152) name = 'mps_motion_state'
        if (name == ' ' .and. c_sizeof(mps_motion_pose_) /= 200) name = 'mps_motion_pose'
        if (name == ' ' .and. c_sizeof(mps_harmonic_) /= 40) name = 'mps_harmonic'
        if (name == ' ' .and. c_sizeof(mps_body_) /= 808) name = 'mps_body'
        if (name == ' ' .and. c_sizeof(mps_body_report_) /= 752) name = 'mps_body_report'
        if (name == ' ' .and. c_sizeof(mps_parallel_) /= 24) name = 'mps_parallel'
        if (name == ' ' .and. c_sizeof(mps_kernel_) /= 24) name = 'mps_kernel'
        if (name == ' ' .and. c_sizeof(mps_stencil_) /= 128) name = 'mps_stencil'
        if (name == ' ' .and. c_sizeof(mps_pair_) /= 64) name = 'mps_pair'
        if (name == ' ' .and. c_sizeof(mps_probe_) /= 144) name = 'mps_probe'
        if (name == ' ' .and. c_sizeof(mps_probe_info_) /= 88) name = 'mps_probe_info'
        if (name == ' ' .and. c_sizeof(mps_energy_) /= 200) name = 'mps_energy'
        if (name == ' ' .and. c_sizeof(mps_momentum_) /= 296) name = 'mps_momentum'
        if (name == ' ' .and. c_sizeof(mps_load_) /= 456) name = 'mps_load'
        if (name == ' ' .and. c_sizeof(mps_tank_) /= 72) name = 'mps_tank'
        if (name == ' ' .and. c_sizeof(mps_solid_) /= 96) name = 'mps_solid'
        if (name == ' ' .and. c_sizeof(mps_stl_) /= 80) name = 'mps_stl'
        if (name == ' ' .and. c_sizeof(mps_model_info_) /= 40) name = 'mps_model_info'
        if (name == ' ' .and. c_sizeof(mps_setting_info_) /= 64) name = 'mps_setting_info'
        if (name == ' ' .and. c_sizeof(mps_channel_info_) /= 56) name = 'mps_channel_info'
        if (name == ' ' .and. c_sizeof(mps_verb_info_) /= 32) name = 'mps_verb_info'
        if (name == ' ' .and. c_sizeof(mps_pass_info_) /= 64) name = 'mps_pass_info'
        if (name == ' ' .and. c_sizeof(mps_name_info_) /= 24) name = 'mps_name_info'
        if (name == ' ' .and. c_sizeof(mps_particle_block_) /= 56) name = 'mps_particle_block'
        if (name == ' ' .and. c_sizeof(mps_lease_) /= 48) name = 'mps_lease'
        if (name == ' ' .and. c_sizeof(mps_ship_) /= 96) name = 'mps_ship'
        if (name == ' ' .and. c_sizeof(mps_ship_motion_) /= 152) name = 'mps_ship_motion'
        if (name == ' ' .and. c_sizeof(mps_config_) /= 216) name = 'mps_config'
        if (name == ' ' .and. c_sizeof(mps_phase_) /= 24) name = 'mps_phase'
        if (name == ' ' .and. c_sizeof(mps_solver_limits_) /= 24) name = 'mps_solver_limits'
        if (name == ' ' .and. c_sizeof(mps_time_control_) /= 64) name = 'mps_time_control'
        if (name == ' ' .and. c_sizeof(mps_step_info_) /= 176) name = 'mps_step_info'
    end function mps_layout_differs
end module mps

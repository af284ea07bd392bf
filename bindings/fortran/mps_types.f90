! SPDX-License-Identifier: BSD-3-Clause
! From the public headers of libmps, which explain everything; written by bindings/make, do not edit.
module mps_types
    use, intrinsic :: iso_c_binding
    implicit none
    integer(c_int32_t), parameter :: MPS_OK = 0
    integer(c_int32_t), parameter :: MPS_W_NOT_CONVERGED = 1
    integer(c_int32_t), parameter :: MPS_W_STOPPED = 2
    integer(c_int32_t), parameter :: MPS_E_ARG = -1
    integer(c_int32_t), parameter :: MPS_E_NOMEM = -2
    integer(c_int32_t), parameter :: MPS_E_BUSY = -3
    integer(c_int32_t), parameter :: MPS_E_NAME = -4
    integer(c_int32_t), parameter :: MPS_E_STATE = -5
    integer(c_int32_t), parameter :: MPS_E_DIVERGED = -6
    integer(c_int32_t), parameter :: MPS_E_LOST = -7
    integer(c_int32_t), parameter :: MPS_E_SOLVER = -8
    integer(c_int32_t), parameter :: MPS_E_PLUGIN = -9
    integer(c_int32_t), parameter :: MPS_E_IO = -10
    integer(c_int32_t), parameter :: MPS_E_VERSION = -11
    integer(c_int32_t), parameter :: MPS_E_RANKS = -12
    integer(c_int32_t), parameter :: MPS_FLUID = 0
    integer(c_int32_t), parameter :: MPS_WALL = 1
    integer(c_int32_t), parameter :: MPS_DUMMY = 2
    integer(c_int32_t), parameter :: MPS_PHASES = 16
    integer(c_int32_t), parameter :: MPS_LOG_INFO = 0
    integer(c_int32_t), parameter :: MPS_LOG_WARNING = 1
    integer(c_int32_t), parameter :: MPS_MOVE_X = 0
    integer(c_int32_t), parameter :: MPS_MOVE_Y = 1
    integer(c_int32_t), parameter :: MPS_MOVE_Z = 2
    integer(c_int32_t), parameter :: MPS_ROTATE_X = 3
    integer(c_int32_t), parameter :: MPS_ROTATE_Y = 4
    integer(c_int32_t), parameter :: MPS_ROTATE_Z = 5
    integer(c_int32_t), parameter :: MPS_DOF_COUNT = 6
    integer(c_int32_t), parameter :: MPS_START_AT_REST = 0
    integer(c_int32_t), parameter :: MPS_START_WITH_TANK = 1
    integer(c_int32_t), parameter :: MPS_PARALLEL_PARTS = 64
    integer(c_int32_t), parameter :: MPS_PARALLEL_VALUES = 16
    integer(c_int32_t), parameter :: MPS_PARALLEL_LEAST = 128
    integer(c_int32_t), parameter :: MPS_PARALLEL_RANGES = 8
    integer(c_int32_t), parameter :: MPS_KERNEL_IMPROVED = 1
    integer(c_int32_t), parameter :: MPS_KERNEL_ORIGINAL = 2
    integer(c_int32_t), parameter :: MPS_NEAR = 0
    integer(c_int32_t), parameter :: MPS_FAR = 1
    integer(c_int32_t), parameter :: MPS_REGION_INNER = 0
    integer(c_int32_t), parameter :: MPS_REGION_SECOND = 1
    integer(c_int32_t), parameter :: MPS_REGION_NEAR = 2
    integer(c_int32_t), parameter :: MPS_REGION_SURFACE = 3
    integer(c_int32_t), parameter :: MPS_REGION_SPRAY = 4
    integer(c_int32_t), parameter :: MPS_REGION_DRY = 5
    integer(c_int32_t), parameter :: MPS_POPULATE = 0
    integer(c_int32_t), parameter :: MPS_LIMIT = 1
    integer(c_int32_t), parameter :: MPS_MOTION = 2
    integer(c_int32_t), parameter :: MPS_CLASSIFY = 3
    integer(c_int32_t), parameter :: MPS_PREPARE = 4
    integer(c_int32_t), parameter :: MPS_FORCE = 5
    integer(c_int32_t), parameter :: MPS_SOURCE = 6
    integer(c_int32_t), parameter :: MPS_LEVEL = 7
    integer(c_int32_t), parameter :: MPS_GRADIENT = 8
    integer(c_int32_t), parameter :: MPS_VELOCITY = 10
    integer(c_int32_t), parameter :: MPS_SHIFT = 11
    integer(c_int32_t), parameter :: MPS_HOOK_COUNT = 12
    integer(c_int32_t), parameter :: MPS_TYPE_REAL = 0
    integer(c_int32_t), parameter :: MPS_TYPE_INTEGER = 1
    integer(c_int32_t), parameter :: MPS_TYPE_FLAG = 2
    integer(c_int32_t), parameter :: MPS_ROW_FREE = 0
    integer(c_int32_t), parameter :: MPS_ROW_FIXED = 1
    integer(c_int32_t), parameter :: MPS_ROW_LEAST = 2
    integer(c_int32_t), parameter :: MPS_BODY_NONE = 0
    integer(c_int32_t), parameter :: MPS_BODY_MEMBER = 1
    integer(c_int32_t), parameter :: MPS_BODY_SEED = 2
    integer(c_int32_t), parameter :: MPS_BODY_ANCHOR = 3
    integer(c_int32_t), parameter :: MPS_MODEL_API = 1
    integer(c_int32_t), parameter :: MPS_USE_READ = 1
    integer(c_int32_t), parameter :: MPS_USE_NEIGHBOURS = 2
    integer(c_int32_t), parameter :: MPS_USE_WRITE = 4
    integer(c_int32_t), parameter :: MPS_USE_CHANGE = 5
    integer(c_int32_t), parameter :: MPS_USE_OPTIONAL = 8
    integer(c_int32_t), parameter :: MPS_USE_DUMMIES = 16
    integer(c_int32_t), parameter :: MPS_USE_ROWS = 32
    integer(c_int32_t), parameter :: MPS_LIFE_STEP = 0
    integer(c_int32_t), parameter :: MPS_LIFE_PARTICLE = 1
    integer(c_int32_t), parameter :: MPS_VECTOR = -1
    integer(c_int32_t), parameter :: MPS_MATRIX = -2
    integer(c_int32_t), parameter :: MPS_SCALAR = -3
    integer(c_int32_t), parameter :: MPS_RANKS_API = 1
    integer(c_int32_t), parameter :: MPS_PPE_API = 1
    integer(c_int32_t), parameter :: MPS_PPE_CONVERGED = 0
    integer(c_int32_t), parameter :: MPS_PPE_MAX_ITERATIONS = 1
    integer(c_int32_t), parameter :: MPS_PPE_INDEFINITE = 2
    integer(c_int32_t), parameter :: MPS_PPE_NAN = 3
    integer(c_int32_t), parameter :: MPS_PPE_BREAKDOWN = 4
    integer(c_int32_t), parameter :: MPS_PPE_NOMEM = 5
    integer(c_int32_t), parameter :: MPS_PLUGIN_API = 1
    integer(c_int32_t), parameter :: MPS_PLUGIN_MODEL = 0
    integer(c_int32_t), parameter :: MPS_PLUGIN_SOLVER = 1
    integer(c_int32_t), parameter :: MPS_PLUGIN_PRECONDITIONER = 2
    integer(c_int32_t), parameter :: MPS_PLUGIN_LOAD = 3
    integer(c_int32_t), parameter :: MPS_PLUGIN_MOTION = 4
    real(c_double), parameter :: MPS_AVERAGE_AUTO = -1.0_c_double
    integer(c_int32_t), parameter :: MPS_PROBE_WALL_PRESSURE = 0
    integer(c_int32_t), parameter :: MPS_PROBE_FLUID_PRESSURE = 1
    integer(c_int32_t), parameter :: MPS_PROBE_GAUGE = 2
    integer(c_int32_t), parameter :: MPS_PROBE_FORCE = 3
    integer(c_int32_t), parameter :: MPS_EXIT_OK = 0
    integer(c_int32_t), parameter :: MPS_EXIT_FAILED = 1
    integer(c_int32_t), parameter :: MPS_EXIT_USAGE = 2
    integer(c_int32_t), parameter :: MPS_EXIT_DIVERGED = 3
    integer(c_int32_t), parameter :: MPS_EXIT_INTERRUPTED = 130
    integer(c_int32_t), parameter :: MPS_JOB_MESSAGE = 0
    integer(c_int32_t), parameter :: MPS_JOB_PROGRESS = 1
    integer(c_int32_t), parameter :: MPS_JOB_TABLE = 2
    integer(c_int32_t), parameter :: MPS_JOB_PARTICLES = 1
    integer(c_int32_t), parameter :: MPS_JOB_PRESSURE = 2
    integer(c_int32_t), parameter :: MPS_JOB_MOTION = 4
    integer(c_int32_t), parameter :: MPS_TRACE_GIVEN = 0
    integer(c_int32_t), parameter :: MPS_TRACE_INTEGRAL = 1
    integer(c_int32_t), parameter :: MPS_TRACE_MEAN = 2
    integer(c_int32_t), parameter :: MPS_TRACE_CHANGE = 3
    integer(c_int32_t), parameter :: MPS_TRACE_LARGEST = 4
    integer(c_int32_t), parameter :: MPS_TRACE_LEAST = 5
    integer(c_int32_t), parameter :: MPS_TRACE_SLOPE = 6
    integer(c_int32_t), parameter :: MPS_CASE_MESSAGES = 20
    integer(c_int32_t), parameter :: MPS_CASE_PLUGINS_NONE = 0
    integer(c_int32_t), parameter :: MPS_CASE_PLUGINS_FILES = 1
    integer(c_int32_t), parameter :: MPS_CASE_PLUGINS_ALL = 2
    integer(c_int32_t), parameter :: MPS_LOAD_NONE = 0
    integer(c_int32_t), parameter :: MPS_LOAD_FORCE = 1
    integer(c_int32_t), parameter :: MPS_LOAD_MASS = 2
    integer(c_int32_t), parameter :: MPS_DEVICE_API = 1
    integer(c_int32_t), parameter :: MPS_SIDE_NONE = 0
    integer(c_int32_t), parameter :: MPS_SIDE_X0 = 1
    integer(c_int32_t), parameter :: MPS_SIDE_X1 = 2
    integer(c_int32_t), parameter :: MPS_SIDE_Y0 = 3
    integer(c_int32_t), parameter :: MPS_SIDE_Y1 = 4
    integer(c_int32_t), parameter :: MPS_SIDE_Z0 = 5
    integer(c_int32_t), parameter :: MPS_SIDE_Z1 = 6
    integer(c_int32_t), parameter :: MPS_FRAMES_FLUID = 1
    integer(c_int32_t), parameter :: MPS_FRAMES_WALL = 2
    integer(c_int32_t), parameter :: MPS_FRAMES_DUMMY = 4
    integer(c_int32_t), parameter :: MPS_FRAMES_CONTINUE = 8
    integer(c_int32_t), parameter :: MPS_FRAMES_PIECES = 16
    integer(c_int32_t), parameter :: MPS_FRAMES_TANK = 32
    integer(c_int32_t), parameter :: MPS_FRAMES_STEPS = 64
    integer(c_int32_t), parameter :: MPS_DATA_DOUBLE = 0
    integer(c_int32_t), parameter :: MPS_DATA_INT32 = 1
    integer(c_int32_t), parameter :: MPS_DATA_INT64 = 2
    integer(c_int32_t), parameter :: MPS_READ = 0
    integer(c_int32_t), parameter :: MPS_WRITE = 1
    integer(c_int32_t), parameter :: MPS_SHIP_SURGE = 0
    integer(c_int32_t), parameter :: MPS_SHIP_SWAY = 1
    integer(c_int32_t), parameter :: MPS_SHIP_HEAVE = 2
    integer(c_int32_t), parameter :: MPS_SHIP_ROLL = 3
    integer(c_int32_t), parameter :: MPS_SHIP_PITCH = 4
    integer(c_int32_t), parameter :: MPS_SHIP_YAW = 5
    integer(c_int32_t), parameter :: MPS_SHIP_Z_UP = 0
    integer(c_int32_t), parameter :: MPS_SHIP_Z_DOWN = 1
    integer(c_int32_t), parameter :: MPS_SHIP_FIXED = 0
    integer(c_int32_t), parameter :: MPS_SHIP_BODY = 1
    integer(c_int32_t), parameter :: MPS_LOST_REMOVE = 0
    integer(c_int32_t), parameter :: MPS_LOST_ERROR = 1
    integer(c_int32_t), parameter :: MPS_STAGE_NEIGHBOURS = 0
    integer(c_int32_t), parameter :: MPS_STAGE_OPERATORS = 1
    integer(c_int32_t), parameter :: MPS_STAGE_PPE_SETUP = 2
    integer(c_int32_t), parameter :: MPS_STAGE_PPE_SOLVE = 3
    integer(c_int32_t), parameter :: MPS_STAGE_CORRECT = 4
    integer(c_int32_t), parameter :: MPS_STAGE_COUNT = 5
    integer(c_int32_t), parameter :: MPS_VERSION_MAJOR = 1
    integer(c_int32_t), parameter :: MPS_VERSION_MINOR = 0
    integer(c_int32_t), parameter :: MPS_VERSION_PATCH = 0
    integer(c_int32_t), parameter :: MPS_HARMONICS = 16
    integer(c_int32_t), parameter :: MPS_CONVERGE_MONOTONE = 0
    integer(c_int32_t), parameter :: MPS_CONVERGE_SLOW = 1
    integer(c_int32_t), parameter :: MPS_CONVERGE_OSCILLATING = 2
    integer(c_int32_t), parameter :: MPS_CONVERGE_SAME = 3
    integer(c_int32_t), parameter :: MPS_FIT_FEW = 0
    integer(c_int32_t), parameter :: MPS_FIT_SAME = 1
    integer(c_int32_t), parameter :: MPS_FIT_LIKELIHOOD = 2
    integer(c_int32_t), parameter :: MPS_FIT_MOMENTS = 3
    integer(c_int32_t), parameter :: MPS_VOID_NONE = -1
    integer(c_int32_t), parameter :: MPS_VOID_SOLID = -2

    type, bind(C) :: mps_allocator
        type(c_funptr) :: alloc = c_null_funptr; type(c_funptr) :: release = c_null_funptr; type(c_ptr) :: user = c_null_ptr
    end type mps_allocator

    type, bind(C) :: mps_motion_state
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: reserved = 0; real(c_double) :: value(6) = 0; &
            real(c_double) :: rate(6) = 0; real(c_double) :: accel(6) = 0
    end type mps_motion_state

    type, bind(C) :: mps_motion_pose
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: reserved = 0; real(c_double) :: rotation(9) = 0; &
            real(c_double) :: translation(3) = 0; real(c_double) :: velocity(3) = 0; real(c_double) :: omega(3) = 0; &
            real(c_double) :: accel(3) = 0; real(c_double) :: alpha(3) = 0
    end type mps_motion_pose

    type, bind(C) :: mps_harmonic
        integer(c_int32_t) :: dof = 0; integer(c_int32_t) :: form = 0; real(c_double) :: amplitude = 0; &
            real(c_double) :: omega = 0; real(c_double) :: phase = 0; real(c_double) :: ramp = 0
    end type mps_harmonic

    type, bind(C) :: mps_body
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: free = 0; real(c_double) :: mass = 0; &
            real(c_double) :: centre_of_mass(3) = 0; real(c_double) :: inertia(9) = 0; real(c_double) :: stiffness(36) = 0; &
            real(c_double) :: damping(36) = 0; real(c_double) :: equilibrium(6) = 0; type(c_funptr) :: load = c_null_funptr; &
            type(c_ptr) :: user = c_null_ptr; integer(c_int32_t) :: gravity = 0; integer(c_int32_t) :: reserved = 0; &
            real(c_double) :: friction(6) = 0
    end type mps_body

    type, bind(C) :: mps_body_report
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: free = 0; real(c_double) :: pose(6) = 0; &
            real(c_double) :: velocity(6) = 0; real(c_double) :: acceleration(6) = 0; real(c_double) :: liquid(6) = 0; &
            real(c_double) :: external(6) = 0; real(c_double) :: restoring(6) = 0; real(c_double) :: mass(36) = 0; &
            real(c_double) :: late(6) = 0; integer(c_int32_t) :: iterations = 0; integer(c_int32_t) :: reserved = 0; &
            real(c_double) :: kinetic = 0; real(c_double) :: spring = 0; real(c_double) :: weight = 0; &
            real(c_double) :: damped = 0; real(c_double) :: external_work = 0; real(c_double) :: liquid_work = 0; &
            real(c_double) :: start = 0; real(c_double) :: friction(6) = 0; real(c_double) :: rubbed = 0
    end type mps_body_report

    type, bind(C) :: mps_parallel
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: threads = 0; type(c_funptr) :: run = c_null_funptr; &
            type(c_ptr) :: user = c_null_ptr
    end type mps_parallel

    type, bind(C) :: mps_kernel
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: id = 0; type(c_funptr) :: fn = c_null_funptr; &
            type(c_ptr) :: user = c_null_ptr
    end type mps_kernel

    type, bind(C) :: mps_stencil
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: dim = 0; type(c_ptr) :: host = c_null_ptr; &
            integer(c_int64_t) :: n = 0; real(c_double) :: dp = 0; real(c_double) :: re = 0; real(c_double) :: n0 = 0; &
            real(c_double) :: lambda = 0; type(mps_kernel) :: kernel; type(c_ptr) :: parallel = c_null_ptr; &
            type(c_ptr) :: x = c_null_ptr; type(c_ptr) :: begin = c_null_ptr; type(c_ptr) :: end = c_null_ptr; &
            type(c_ptr) :: col = c_null_ptr; type(c_ptr) :: w_r2 = c_null_ptr
    end type mps_stencil

    type, bind(C) :: mps_pair
        real(c_double) :: d(3) = 0; real(c_double) :: r2 = 0; real(c_double) :: r = 0; real(c_double) :: w = 0; &
            integer(c_int64_t) :: j = 0; real(c_double) :: w_r2 = 0
    end type mps_pair

    type, bind(C) :: mps_probe
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: type = 0; real(c_double) :: at(3) = 0; &
            real(c_double) :: direction(3) = 0; real(c_double) :: diameter = 0; real(c_double) :: length = 0; &
            type(c_ptr) :: part = c_null_ptr; integer(c_int32_t) :: count_drops = 0; real(c_double) :: average = 0; &
            real(c_double) :: rate = 0; integer(c_int32_t) :: phases = 0; type(c_ptr) :: name = c_null_ptr; &
            real(c_double) :: normal(3) = 0
    end type mps_probe

    type, bind(C) :: mps_probe_info
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: type = 0; type(c_ptr) :: name = c_null_ptr; &
            type(c_ptr) :: part = c_null_ptr; real(c_double) :: at(3) = 0; real(c_double) :: normal(3) = 0; &
            real(c_double) :: diameter = 0; integer(c_int32_t) :: values = 0
    end type mps_probe_info

    type, bind(C) :: mps_energy
        integer(c_int32_t) :: struct_size = 0; real(c_double) :: kinetic = 0; real(c_double) :: potential = 0; &
            real(c_double) :: wall_work_momentum = 0; real(c_double) :: wall_work_probes = 0; real(c_double) :: viscous = 0; &
            real(c_double) :: plugins = 0; real(c_double) :: collision = 0; real(c_double) :: shift = 0; &
            real(c_double) :: numerical = 0; real(c_double) :: mass = 0; real(c_double) :: volume = 0; &
            real(c_double) :: volume_error = 0; real(c_double) :: centre(3) = 0; real(c_double) :: momentum(3) = 0; &
            real(c_double) :: added = 0; real(c_double) :: volume_filled = 0; real(c_double) :: mass_filled = 0; &
            real(c_double) :: friction = 0; real(c_double) :: layers = 0; real(c_double) :: gas = 0
    end type mps_energy

    type, bind(C) :: mps_momentum
        integer(c_int32_t) :: struct_size = 0; real(c_double) :: total(3) = 0; real(c_double) :: gravity(3) = 0; &
            real(c_double) :: force(3) = 0; real(c_double) :: plugins(3) = 0; real(c_double) :: reaction(3) = 0; &
            real(c_double) :: pressure(3) = 0; real(c_double) :: walls(3) = 0; real(c_double) :: numerical(3) = 0; &
            real(c_double) :: collision(3) = 0; real(c_double) :: shift(3) = 0; real(c_double) :: added(3) = 0; &
            real(c_double) :: friction(3) = 0
    end type mps_momentum

    type, bind(C) :: mps_load
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: has_mass = 0; real(c_double) :: force(6) = 0; &
            real(c_double) :: rest(6) = 0; real(c_double) :: mass(36) = 0; real(c_double) :: acceleration(6) = 0; &
            real(c_double) :: dt = 0; integer(c_int32_t) :: iterations = 0; integer(c_int32_t) :: reserved = 0
    end type mps_load

    type, bind(C) :: mps_tank
        integer(c_int32_t) :: struct_size = 0; type(c_ptr) :: name = c_null_ptr; real(c_double) :: lo(3) = 0; &
            real(c_double) :: size(3) = 0; integer(c_int32_t) :: open_top = 0; integer(c_int32_t) :: dummy_layers = 0
    end type mps_tank

    type, bind(C) :: mps_solid
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: dummy_layers = 0; type(c_ptr) :: name = c_null_ptr; &
            real(c_double) :: lo(3) = 0; real(c_double) :: hi(3) = 0; type(c_funptr) :: distance = c_null_funptr; &
            type(c_funptr) :: inside = c_null_funptr; type(c_ptr) :: user = c_null_ptr; integer(c_int32_t) :: invert = 0
    end type mps_solid

    type, bind(C) :: mps_stl
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: dummy_layers = 0; type(c_ptr) :: name = c_null_ptr; &
            real(c_double) :: scale = 0; real(c_double) :: rotation(3) = 0; real(c_double) :: shift(3) = 0; &
            integer(c_int32_t) :: container = 0; integer(c_int32_t) :: open_side = 0
    end type mps_stl

    type, bind(C) :: mps_model_info
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: active = 0; type(c_ptr) :: name = c_null_ptr; &
            type(c_ptr) :: help = c_null_ptr; integer(c_int32_t) :: settings = 0; integer(c_int32_t) :: channels = 0; &
            integer(c_int32_t) :: verbs = 0; integer(c_int32_t) :: built_in = 0
    end type mps_model_info

    type, bind(C) :: mps_setting_info
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: type = 0; type(c_ptr) :: key = c_null_ptr; &
            type(c_ptr) :: unit = c_null_ptr; type(c_ptr) :: help = c_null_ptr; real(c_double) :: initial = 0; &
            real(c_double) :: min = 0; real(c_double) :: max = 0; real(c_double) :: value = 0
    end type mps_setting_info

    type, bind(C) :: mps_channel_info
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: components = 0; integer(c_int32_t) :: type = 0; &
            integer(c_int32_t) :: life = 0; type(c_ptr) :: name = c_null_ptr; type(c_ptr) :: unit = c_null_ptr; &
            type(c_ptr) :: help = c_null_ptr; integer(c_int32_t) :: reads = 0; integer(c_int32_t) :: writes = 0; &
            integer(c_int32_t) :: own = 0
    end type mps_channel_info

    type, bind(C) :: mps_verb_info
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: hook = 0; type(c_ptr) :: hook_name = c_null_ptr; &
            type(c_ptr) :: model = c_null_ptr; type(c_ptr) :: uses = c_null_ptr
    end type mps_verb_info

    type, bind(C) :: mps_pass_info
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: hook = 0; type(c_ptr) :: hook_name = c_null_ptr; &
            type(c_ptr) :: name = c_null_ptr; type(c_ptr) :: uses = c_null_ptr; integer(c_int32_t) :: model = 0; &
            integer(c_int32_t) :: reserved = 0; integer(c_int64_t) :: calls = 0; real(c_double) :: seconds = 0; &
            real(c_double) :: bytes = 0
    end type mps_pass_info

    type, bind(C) :: mps_name_info
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: active = 0; type(c_ptr) :: name = c_null_ptr; &
            type(c_ptr) :: help = c_null_ptr
    end type mps_name_info

    type, bind(C) :: mps_particle_block
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: kind = 0; integer(c_int32_t) :: phase = 0; &
            type(c_ptr) :: part = c_null_ptr; integer(c_int64_t) :: count = 0; type(c_ptr) :: position = c_null_ptr; &
            type(c_ptr) :: velocity = c_null_ptr; type(c_ptr) :: area = c_null_ptr
    end type mps_particle_block

    type, bind(C) :: mps_lease
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: type = 0; integer(c_int32_t) :: stride = 0; &
            integer(c_int32_t) :: slot = 0; integer(c_int64_t) :: count = 0; type(c_ptr) :: data = c_null_ptr; &
            type(c_ptr) :: integers = c_null_ptr; type(c_ptr) :: ids = c_null_ptr
    end type mps_lease

    type, bind(C) :: mps_ship
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: axes = 0; integer(c_int32_t) :: degrees = 0; &
            integer(c_int32_t) :: order(3) = 0; real(c_double) :: forward(3) = 0; real(c_double) :: up(3) = 0; &
            real(c_double) :: origin(3) = 0
    end type mps_ship

    type, bind(C) :: mps_ship_motion
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: reserved = 0; real(c_double) :: value(6) = 0; &
            real(c_double) :: rate(6) = 0; real(c_double) :: accel(6) = 0
    end type mps_ship_motion

    type, bind(C) :: mps_config
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: dim = 0; real(c_double) :: dp = 0; &
            real(c_double) :: gravity(3) = 0; type(c_ptr) :: kernel = c_null_ptr; real(c_double) :: re_near = 0; &
            real(c_double) :: re_far = 0; real(c_double) :: velocity_scale = 0; integer(c_int32_t) :: threads = 0; &
            integer(c_int32_t) :: lost_policy = 0; real(c_double) :: domain_min(3) = 0; real(c_double) :: domain_max(3) = 0; &
            real(c_double) :: speed_limit = 0; type(mps_allocator) :: allocator; type(c_funptr) :: log = c_null_funptr; &
            type(c_ptr) :: log_user = c_null_ptr; type(c_ptr) :: error = c_null_ptr; integer(c_size_t) :: error_size = 0; &
            type(mps_parallel) :: parallel
    end type mps_config

    type, bind(C) :: mps_phase
        integer(c_int32_t) :: struct_size = 0; real(c_double) :: density = 0; real(c_double) :: viscosity = 0
    end type mps_phase

    type, bind(C) :: mps_solver_limits
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: max_iterations = 0; real(c_double) :: tolerance = 0; &
            real(c_double) :: divergence = 0
    end type mps_solver_limits

    type, bind(C) :: mps_time_control
        integer(c_int32_t) :: struct_size = 0; real(c_double) :: dt = 0; real(c_double) :: cfl = 0; &
            real(c_double) :: gravity = 0; real(c_double) :: viscous = 0; real(c_double) :: growth = 0; &
            real(c_double) :: dt_max = 0; real(c_double) :: dt_min = 0
    end type mps_time_control

    type, bind(C) :: mps_step_info
        integer(c_int32_t) :: struct_size = 0; integer(c_int32_t) :: ppe_iterations = 0; integer(c_int64_t) :: step = 0; &
            real(c_double) :: t = 0; real(c_double) :: dt = 0; real(c_double) :: cfl = 0; real(c_double) :: max_speed = 0; &
            real(c_double) :: ppe_residual = 0; real(c_double) :: ppe_divergence = 0; integer(c_int64_t) :: ppe_unknowns = 0; &
            integer(c_int64_t) :: lost = 0; integer(c_int64_t) :: surface = 0; real(c_double) :: seconds(5) = 0; &
            real(c_double) :: crossing_time = 0; integer(c_int32_t) :: ppe_solves = 0; integer(c_int32_t) :: separated = 0; &
            type(c_ptr) :: limit = c_null_ptr; integer(c_int32_t) :: pockets = 0; integer(c_int32_t) :: reserved = 0; &
            real(c_double) :: pocket_volume = 0; real(c_double) :: pocket_pressure = 0
    end type mps_step_info
end module mps_types

/* SPDX-License-Identifier: BSD-3-Clause */
/* Sequences of calls in any order with any arguments, with models, solvers, preconditioners and
 * motions that return random numbers. */
#include "plugins.h"

enum { CALLS = 48, LARGEST_CLOUD = 600 };

static void use_models(fuzz_input *in, mps_sim *sim)
{
    static const char *const presets[] = {"imps", "mmps", "imps.paper", "mmps.paper", "none"};
    mps_model_info info;
    mps_model_info_init(&info, sizeof info);
    switch (fuzz_pick(in, 5)) {
    case 0:
        fuzz_status(sim, mps_preset_use(sim, presets[fuzz_pick(in, 5)]));
        break;
    case 1:
        register_model(in, sim, fuzz_pick(in, MODELS));
        break;
    case 2:
        if (mps_model_info_get(sim, fuzz_pick(in, 40), &info) == MPS_OK)
            fuzz_status(sim, mps_model_use(sim, info.name));
        break;
    case 3:
        if (mps_model_info_get(sim, fuzz_pick(in, 40), &info) == MPS_OK)
            fuzz_status(sim, mps_model_remove(sim, info.name));
        break;
    default: {
        mps_setting_info setting;
        mps_setting_info_init(&setting, sizeof setting);
        if (mps_model_info_get(sim, fuzz_pick(in, 40), &info) != MPS_OK) return;
        if (mps_setting_info_get(sim, info.name, fuzz_pick(in, 6), &setting) != MPS_OK) return;
        fuzz_status(sim, mps_model_set(sim, info.name, setting.key, fuzz_real(in, 2)));
    }
    }
}

static void add_solid(fuzz_input *in, mps_sim *sim)
{
    mps_tank tank;
    const double a[3] = {fuzz_between(in, -0.1, 0.6), fuzz_between(in, -0.1, 0.6),
                         fuzz_between(in, -0.1, 0.6)};
    const double b[3] = {fuzz_between(in, -0.1, 0.6), fuzz_between(in, -0.1, 0.6),
                         fuzz_between(in, -0.1, 0.6)};
    switch (fuzz_pick(in, 4)) {
    case 0:
        mps_tank_init(&tank, sizeof tank);
        for (int d = 0; d < 3; d++) tank.size[d] = fuzz_between(in, 0.2, 0.6);
        tank.open_top = fuzz_byte(in) % 2;
        tank.dummy_layers = fuzz_byte(in) % 4;
        tank.lo[0] = fuzz_real(in, 0.1);
        fuzz_status(sim, mps_tank_add(sim, &tank, NULL));
        break;
    case 1:
        fuzz_status(sim, mps_baffle_add(sim, "baffle", a, b, NULL));
        break;
    case 2:
        fuzz_status(sim, mps_plate_add(sim, "plate", a, b, NULL));
        break;
    default:
        fuzz_status(sim, mps_fill_box_add(sim, fuzz_byte(in) % 3, a, b, NULL, NULL));
    }
}

static void add_particles(fuzz_input *in, mps_sim *sim)
{
    double x[3 * 8], u[3 * 8];
    int64_t ids[8];
    mps_particle_block block;
    mps_particle_block_init(&block, sizeof block);
    if (mps_particles_count(sim, -1) > LARGEST_CLOUD) return;
    const int count = fuzz_pick(in, 9);
    for (int k = 0; k < 3 * count; k++) {
        x[k] = fuzz_byte(in) < 250 ? fuzz_between(in, -0.2, 0.8) : fuzz_real(in, 10);
        u[k] = fuzz_real(in, 2);
    }
    block.kind = fuzz_byte(in) < 200 ? MPS_FLUID : (int32_t)fuzz_byte(in) % 4;
    block.phase = fuzz_byte(in) % 3;
    block.count = count;
    block.position = x;
    block.velocity = fuzz_byte(in) % 2 ? u : NULL;
    fuzz_status(sim, mps_particles_add(sim, &block, ids));
}

static void remove_particles(fuzz_input *in, mps_sim *sim)
{
    int64_t ids[4];
    const int count = fuzz_pick(in, 4) + 1;
    for (int k = 0; k < count; k++)
        ids[k] = fuzz_byte(in) < 250 ? (int64_t)fuzz_byte(in) : fuzz_whole(in);
    fuzz_status(sim, mps_particles_remove(sim, count, ids));
}

/* Numbers through a lease; what is refused is put right, so that the lease can be closed. */
static void write_field(fuzz_input *in, mps_sim *sim)
{
    static const char *const fields[] = {"position",       "velocity", "pressure", "density",
                                         "number_density", "mine",     "mark",     "wall_pressure"};
    mps_lease lease = {.struct_size = sizeof lease};
    if (mps_lease_begin(sim, fields[fuzz_pick(in, 8)], fuzz_byte(in) % 2, &lease) != MPS_OK) return;
    const int64_t size = lease.count * lease.stride;
    if (size > 0 && fuzz_byte(in) < 200) {
        mps_lease_end(sim, &lease);
        if (mps_lease_begin(sim, "velocity", MPS_WRITE, &lease) != MPS_OK) return;
        const int64_t at = (int64_t)(fuzz_byte(in) * 31 % (uint64_t)(lease.count * lease.stride));
        const double before = lease.data[at];
        lease.data[at] = fuzz_real(in, 5);
        if (mps_lease_end(sim, &lease) == MPS_OK) return;
        lease.data[at] = before;
    }
    FUZZ_MUST(mps_lease_end(sim, &lease) == MPS_OK);
}

static void use_probes(fuzz_input *in, mps_sim *sim)
{
    mps_probe probe;
    int32_t id = fuzz_pick(in, 6);
    double values[8];
    mps_probe_init(&probe, sizeof probe);
    switch (fuzz_pick(in, 4)) {
    case 0:
        probe.type = fuzz_byte(in) % 5;
        for (int d = 0; d < 3; d++)
            probe.at[d] = fuzz_byte(in) < 250 ? fuzz_between(in, 0, 0.5) : fuzz_real(in, 1);
        if (fuzz_byte(in) > 200) probe.diameter = fuzz_real(in, 0.3);
        if (fuzz_byte(in) > 200) probe.average = fuzz_real(in, 0.1);
        if (fuzz_byte(in) > 128) probe.rate = fabs(fuzz_real(in, 500));
        if (fuzz_byte(in) > 200) probe.length = fuzz_real(in, 1);
        if (fuzz_byte(in) > 200) probe.direction[0] = fuzz_real(in, 1);
        if (fuzz_byte(in) > 200) probe.normal[fuzz_byte(in) % 3] = fuzz_real(in, 1);
        if (fuzz_byte(in) > 200) probe.name = fuzz_byte(in) > 128 ? "P" : "Q";
        probe.phases = fuzz_byte(in) > 200 ? fuzz_byte(in) : 0;
        fuzz_status(sim, mps_probe_add(sim, &probe, &id));
        break;
    case 1:
        fuzz_status(sim, mps_probe_remove(sim, id));
        break;
    case 2:
        fuzz_status(sim, mps_probe_series_clear(sim, id));
        break;
    default:
        fuzz_status(sim, mps_probe_read(sim, id, values));
        fuzz_status(sim, mps_probe_series(sim, id, NULL, NULL, NULL));
    }
}

static void use_controls(fuzz_input *in, mps_sim *sim)
{
    mps_time_control control;
    mps_phase phase;
    mps_energy energy;
    mps_momentum momentum;
    mps_stencil stencil = {.struct_size = sizeof stencil};
    switch (fuzz_pick(in, 7)) {
    case 0:
        mps_time_control_init(&control, sizeof control);
        if (fuzz_byte(in) > 128) control.dt = fuzz_real(in, 2e-3);
        if (fuzz_byte(in) > 200) control.cfl = fuzz_real(in, 1);
        if (fuzz_byte(in) > 200) control.growth = fuzz_real(in, 4);
        if (fuzz_byte(in) > 200) control.dt_min = fuzz_real(in, 1e-5);
        fuzz_status(sim, mps_time_control_set(sim, &control));
        break;
    case 1:
        mps_phase_init(&phase, sizeof phase);
        phase.density = fuzz_real(in, 1000);
        phase.viscosity = fuzz_real(in, 1);
        fuzz_status(sim, mps_phase_set(sim, fuzz_byte(in) % 18, &phase));
        break;
    case 2:
        fuzz_status(sim,
                    mps_tension_set(sim, fuzz_byte(in) % 4, fuzz_byte(in) % 4, fuzz_real(in, 0.1)));
        break;
    case 3:
        fuzz_status(sim, mps_threads_set(sim, fuzz_byte(in) % 4));
        break;
    case 4:
        mps_energy_init(&energy, sizeof energy);
        mps_momentum_init(&momentum, sizeof momentum);
        fuzz_status(sim, mps_energy_get(sim, &energy));
        fuzz_status(sim, mps_momentum_get(sim, &momentum));
        break;
    case 5:
        fuzz_status(sim, mps_stencil_get(sim, fuzz_byte(in) % 3, &stencil));
        break;
    default:
        fuzz_status(sim, mps_field_add(sim, fuzz_byte(in) % 2 ? "mine" : "mark",
                                       (int32_t)fuzz_byte(in) % 11));
    }
}

static void use_motion(fuzz_input *in, mps_sim *sim)
{
    const mps_harmonic h = {
        fuzz_byte(in) % 7, fuzz_byte(in) % 2, fuzz_real(in, 0.02), fuzz_real(in, 10), 0,
        fuzz_real(in, 1)};
    switch (fuzz_pick(in, 3)) {
    case 0:
        fuzz_status(sim, mps_motion_harmonics_set(sim, 1, &h));
        break;
    case 1:
        fuzz_status(sim, mps_motion_callback_set(sim, move_garbage, NULL));
        break;
    default:
        fuzz_status(sim, mps_motion_clear(sim));
    }
}

/* Arbitrary struct sizes: the library reads at most 4096 bytes of a struct. */
static void use_sizes(fuzz_input *in, mps_sim *sim)
{
    enum { LARGEST = 4096 };
    unsigned char *bytes = calloc(1, LARGEST);
    FUZZ_MUST(bytes);
    const uint32_t size = (uint32_t)fuzz_whole(in);
    memcpy(bytes, &size, sizeof size);
    switch (fuzz_pick(in, 5)) {
    case 0:
        fuzz_status(sim, mps_phase_set(sim, 0, (mps_phase *)bytes));
        break;
    case 1:
        fuzz_status(sim, mps_time_control_set(sim, (mps_time_control *)bytes));
        break;
    case 2:
        fuzz_status(sim, mps_tank_add(sim, (mps_tank *)bytes, NULL));
        break;
    case 3:
        fuzz_status(sim, mps_particles_add(sim, (mps_particle_block *)bytes, NULL));
        break;
    default:
        fuzz_status(sim, mps_energy_get(sim, (mps_energy *)bytes));
    }
    free(bytes);
}

static int monitor(void *user, mps_sim *sim, const mps_step_info *info)
{
    (void)user;
    (void)info;
    if (fuzz_byte(input) > 200) use_controls(input, sim);
    if (fuzz_byte(input) > 200) use_probes(input, sim);
    if (fuzz_byte(input) > 220) use_models(input, sim);
    return fuzz_byte(input) > 100;
}

static void call(fuzz_input *in, mps_sim *sim)
{
    double t;
    switch (fuzz_pick(in, 16)) {
    case 0:
        add_solid(in, sim);
        break;
    case 1:
        add_particles(in, sim);
        break;
    case 2:
        remove_particles(in, sim);
        break;
    case 3:
        write_field(in, sim);
        break;
    case 4:
        use_probes(in, sim);
        break;
    case 5:
        use_controls(in, sim);
        break;
    case 6:
        use_motion(in, sim);
        break;
    case 7:
        use_models(in, sim);
        break;
    case 8:
        use_models(in, sim);
        break;
    case 9:
        use_solver(in, sim);
        break;
    case 10:
        mps_sim_time(sim, &t, NULL);
        fuzz_status(sim, mps_run(sim, t + 2e-3, monitor, NULL));
        fuzz_check_finite(sim);
        break;
    case 11:
        use_sizes(in, sim);
        break;
    default:
        fuzz_step(sim, fuzz_byte(in) < 245 ? 2e-3 : fuzz_real(in, 1));
    }
}

static mps_sim *create(fuzz_input *in)
{
    static const int32_t policies[] = {MPS_LOST_REMOVE, MPS_LOST_ERROR};
    mps_config config;
    mps_sim *sim = NULL;
    char error[256] = "";
    const unsigned mode = fuzz_byte(in);
    fuzz_config(&config, mode % 8 == 7 ? 3 : 2, 0.1);
    config.lost_policy = policies[mode >> 3 & 1];
    config.error = error;
    config.error_size = sizeof error;
    if (mode >> 4 == 15) {
        config.dp = fuzz_real(in, 1);
        config.gravity[1] = fuzz_real(in, 10);
        config.re_near = fuzz_real(in, 4);
        config.re_far = fuzz_real(in, 4);
        config.velocity_scale = fuzz_real(in, 4);
        config.speed_limit = fuzz_real(in, 4);
        config.domain_min[0] = fuzz_real(in, 4);
        config.domain_max[0] = fuzz_real(in, 4);
        config.threads = fuzz_byte(in) % 6;
    }
    const mps_status status = mps_sim_create(&config, &sim);
    FUZZ_MUST((status == MPS_OK) == (sim != NULL));
    FUZZ_MUST(status == MPS_OK || error[0]);
    return sim;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_input in = {data, size, 0};
    const double lo[3] = {0, 0, 0}, hi[3] = {0.5, 0.3, 0.3};
    mps_tank tank;
    mps_sim *sim = create(&in);
    double dp = 0;
    if (!sim) return 0;
    input = &in;
    memset(models, 0, sizeof models);
    mps_sim_shape(sim, NULL, &dp);
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = tank.size[1] = 0.5;
    tank.size[2] = 0.3;
    if (dp > 0.09 && fuzz_byte(&in) < 230) {
        fuzz_status(sim, mps_tank_add(sim, &tank, NULL));
        fuzz_status(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    }
    for (int k = 0; k < CALLS && fuzz_left(&in) && dp > 0.05; k++) call(&in, sim);
    mps_sim_destroy(sim);
    return 0;
}

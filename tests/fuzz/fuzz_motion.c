/* SPDX-License-Identifier: BSD-3-Clause */
/* Motions: tables, harmonics and callbacks of any numbers, in 2-D and 3-D, changed during the
 * run. */
#include "fuzz.h"

enum { ROWS = 24 };

static int garbage(void *user, double t, mps_motion_state *state)
{
    fuzz_input *in = user;
    double *const all[3] = {state->value, state->rate, state->accel};
    const int dof = fuzz_pick(in, MPS_DOF_COUNT);
    (void)t;
    for (int k = 0; k < 3; k++) all[k][dof] = fuzz_real(in, 0.1);
    return fuzz_byte(in) == 255;
}

static void set_table(fuzz_input *in, mps_sim *sim)
{
    double t[ROWS], values[ROWS * MPS_DOF_COUNT], now;
    int32_t dof[MPS_DOF_COUNT];
    const int rows = fuzz_pick(in, ROWS + 1), dofs = fuzz_pick(in, MPS_DOF_COUNT + 1);
    mps_sim_time(sim, &now, NULL);
    for (int k = 0; k < rows; k++)
        t[k] = k == 0 ? now - fuzz_between(in, 0, 0.1) : t[k - 1] + fabs(fuzz_real(in, 0.05));
    for (int k = 0; k < rows * dofs; k++) values[k] = fuzz_real(in, 0.02);
    for (int k = 0; k < dofs; k++) dof[k] = fuzz_byte(in) % 8;
    fuzz_status(sim, mps_motion_table_set(sim, rows, t, dofs, dof, values));
}

static void set_harmonics(fuzz_input *in, mps_sim *sim)
{
    mps_harmonic h[4];
    const int count = fuzz_pick(in, 5);
    for (int k = 0; k < count; k++) {
        h[k].dof = fuzz_byte(in) % 8;
        h[k].form = fuzz_byte(in) % 3;
        h[k].amplitude = fuzz_real(in, 0.02);
        h[k].omega = fuzz_real(in, 5);
        h[k].phase = fuzz_real(in, 3);
        h[k].ramp = fuzz_real(in, 1);
    }
    fuzz_status(sim, mps_motion_harmonics_set(sim, count, h));
}

static void act(fuzz_input *in, mps_sim *sim)
{
    const double centre[3] = {fuzz_real(in, 0.5), fuzz_real(in, 0.5), 0};
    mps_motion_state state = {.struct_size = sizeof state};
    double lab[3], velocity[3];
    switch (fuzz_pick(in, 8)) {
    case 0:
    case 1:
        set_table(in, sim);
        break;
    case 2:
        set_harmonics(in, sim);
        break;
    case 3:
        fuzz_status(sim, mps_motion_callback_set(sim, garbage, in));
        break;
    case 4:
        fuzz_status(sim, mps_motion_clear(sim));
        break;
    case 5:
        fuzz_status(sim, mps_motion_centre_set(sim, centre, fuzz_byte(in) % 3));
        break;
    default:
        fuzz_step(sim, fuzz_byte(in) < 240 ? 2e-3 : fuzz_real(in, 1));
    }
    fuzz_status(sim, mps_motion_state_get(sim, &state));
    for (int d = 0; d < MPS_DOF_COUNT; d++)
        FUZZ_MUST(isfinite(state.value[d]) && isfinite(state.rate[d]) && isfinite(state.accel[d]));
    fuzz_status(sim, mps_motion_to_lab(sim, centre, lab, velocity));
}

/* Gas above the liquid, with the tension of their interface. */
static void add_gas(mps_sim *sim, const double *hi)
{
    const double lo[3] = {0, 0.2, 0};
    mps_phase gas;
    mps_phase_init(&gas, sizeof gas);
    gas.density = 1.2;
    FUZZ_MUST(mps_phase_set(sim, 1, &gas) == MPS_OK && mps_preset_use(sim, "mmps") == MPS_OK);
    FUZZ_MUST(mps_tension_set(sim, 0, 1, 0.07) == MPS_OK);
    FUZZ_MUST(mps_fill_box_add(sim, 1, lo, hi, NULL, NULL) == MPS_OK);
}

static void fix_step(mps_sim *sim)
{
    mps_time_control control;
    mps_time_control_init(&control, sizeof control);
    control.dt = 1e-4;
    FUZZ_MUST(mps_time_control_set(sim, &control) == MPS_OK);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_input in = {data, size, 0};
    mps_config config;
    mps_tank tank;
    mps_sim *sim = NULL;
    const double lo[3] = {0, 0, 0}, hi[3] = {0.4, 0.2, 0.4}, top[3] = {0.4, 0.4, 0.4};
    const unsigned mode = fuzz_byte(&in);
    const int32_t dim = mode % 8 == 7 ? 3 : 2;
    fuzz_config(&config, dim, 0.1);
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = tank.size[1] = tank.size[2] = 0.4;
    FUZZ_MUST(mps_sim_create(&config, &sim) == MPS_OK);
    FUZZ_MUST(mps_tank_add(sim, &tank, NULL) == MPS_OK);
    FUZZ_MUST(mps_fill_box_add(sim, 0, lo, hi, NULL, NULL) == MPS_OK);
    if (mode & 64) add_gas(sim, top);
    if (mode & 128) fix_step(sim);
    for (int k = 0; k < 24 && fuzz_left(&in); k++) act(&in, sim);
    mps_sim_destroy(sim);
    return 0;
}

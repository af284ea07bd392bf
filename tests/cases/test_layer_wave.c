/* SPDX-License-Identifier: BSD-3-Clause */
/* Standing wave of the interface between two liquids that fill a closed tank, from flat with the
 * velocities of linear theory, against
 *   omega^2 = (rho1 - rho2) g k/(rho1 coth(k h1) + rho2 coth(k h2)). */
#include "../tags.h"
#include <math.h>
#include <mps/mps.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const double length = 1, height = 1, g = 9.81, amplitude = 0.02,
                    wave_number = 3.14159265358979; /* of a half wave */

#define OK(sim, call)                                               \
    do {                                                            \
        mps_status status_ = (call);                                \
        if (status_ != MPS_OK)                                      \
            fail_msg("%s: %s: %s", #call, mps_status_name(status_), \
                     (sim) ? mps_sim_error(sim) : "no handle");     \
    } while (0)

/* Two inviscid liquids, the lower one up to `level`. */
static mps_sim *two_liquids(double dp, const double *rho, double level)
{
    const double lo[2] = {0}, top[2] = {length, level}, lid[2] = {length, height};
    mps_config config;
    mps_tank tank;
    mps_sim *sim = NULL;
    OK(sim, mps_config_init(&config, sizeof config));
    config.dp = dp;
    OK(sim, mps_sim_create(&config, &sim));
    OK(sim, mps_threads_set(sim, 1));
    OK(sim, mps_preset_use(sim, "mmps"));
    OK(sim, mps_model_remove(sim, "gas"));
    OK(sim, mps_model_remove(sim, "tension"));
    OK(sim, mps_tank_init(&tank, sizeof tank));
    tank.size[0] = length;
    tank.size[1] = height;
    OK(sim, mps_tank_add(sim, &tank, NULL));
    for (int p = 0; p < 2; p++) {
        mps_phase phase;
        OK(sim, mps_phase_init(&phase, sizeof phase));
        phase.density = rho[p];
        phase.viscosity = 0;
        OK(sim, mps_phase_set(sim, p, &phase));
        OK(sim, mps_fill_box_add(sim, p, lo, p == 0 ? top : lid, NULL, NULL));
    }
    return sim;
}

/* Velocities of the wave as it passes through rest, the greatest of the interface being `speed`. */
static void set_moving(mps_sim *sim, double level, double speed)
{
    const int32_t *kind, *phase;
    mps_lease x = {.struct_size = sizeof x}, u = {.struct_size = sizeof u};
    OK(sim, tags_peek(sim, NULL, &kind, &phase, NULL));
    OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
    OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &u));
    for (int64_t i = 0; i < x.count; i++) {
        if (kind[i] != MPS_FLUID) continue;
        const double kx = wave_number * x.data[2 * i], y = x.data[2 * i + 1];
        const double from = phase[i] == 0 ? y : height - y,
                     depth = phase[i] == 0 ? level : height - level;
        const double scale = speed / sinh(wave_number * depth), side = phase[i] == 0 ? -1 : 1;
        u.data[2 * i] = side * scale * sin(kx) * cosh(wave_number * from);
        u.data[2 * i + 1] = scale * cos(kx) * sinh(wave_number * from);
    }
    OK(sim, mps_lease_end(sim, &u));
    OK(sim, mps_lease_end(sim, &x));
}

/* Amplitude of cos(k x) in the interface, from the mass on either side. */
static double wave_height(mps_sim *sim, double dp)
{
    const int32_t *kind, *phase;
    mps_lease x = {.struct_size = sizeof x};
    double sum = 0;
    OK(sim, tags_peek(sim, NULL, &kind, &phase, NULL));
    OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
    for (int64_t i = 0; i < x.count; i++)
        if (kind[i] == MPS_FLUID && phase[i] == 0) sum += cos(wave_number * x.data[2 * i]);
    OK(sim, mps_lease_end(sim, &x));
    return 2 / length * dp * dp * sum;
}

typedef struct measured {
    double frequency; /* of the first period over that of theory, less 1 */
    double growth;    /* from the crest to the trough */
} measured;

/* One period from rest to rest. */
static measured run(double dp, double heavy, double light)
{
    const double rho[2] = {heavy, light}, level = (floor(0.5 * height / dp + 1e-9) + 0.5) * dp;
    const double omega = sqrt(
        (heavy - light) * g * wave_number /
        (heavy / tanh(wave_number * level) + light / tanh(wave_number * (height - level))));
    double before = 0, t = 0, zero[2] = {0}, most[2] = {0};
    mps_sim *sim = two_liquids(dp, rho, level);
    set_moving(sim, level, amplitude * omega);
    for (int passed = 0; passed < 2;) {
        mps_step_info info;
        OK(sim, mps_step_info_init(&info, sizeof info));
        OK(sim, mps_step(sim, 1, &info));
        const double now = wave_height(sim, dp), side = passed == 0 ? 1 : -1;
        if (side * now > most[passed]) most[passed] = side * now;
        if (t > 0.6 / omega && before * now < 0)
            zero[passed++] = t + (info.t - t) * before / (before - now);
        before = now;
        t = info.t;
        if (t > 12 / omega) fail_msg("no wave: dp %g", dp);
    }
    const measured m = {2 * wave_number / zero[1] / omega - 1, most[1] / most[0] - 1};
    print_message("    %g over %g kg/m3, dp %g: first half wave %.4f s, frequency %+.2f %%, "
                  "amplitude %.4f of %.4f m, then %+.1f %%\n",
                  light, heavy, dp, zero[0], 100 * m.frequency, most[0], amplitude, 100 * m.growth);
    mps_sim_destroy(sim);
    return m;
}

/* At dp = L/20, L/40 (and L/80): frequency -1.2, -1.5 (-1.0) % for 2 : 1 and -0.9, -0.6 (-0.4) %
 * for 1000 : 1; the amplitude after half a period -13, -2.4 (-1.9) % and -7, -1.1 (-0.1) %. Most of
 * this is alpha of dissipation.radial, a viscosity ~ dp^1.5 on liquids that slide along each
 * other. */
static void near_theory(double heavy, double light, double most)
{
    const measured coarse = run(0.05, heavy, light), fine = run(0.025, heavy, light);
    assert_true(fabs(coarse.frequency) < most && fabs(fine.frequency) < most);
    assert_true(coarse.growth < 0.03 && coarse.growth > -0.15);
    assert_true(fine.growth < 0.01 && fine.growth > -0.04);
    assert_true(fabs(fine.growth) < 0.4 * fabs(coarse.growth));
}

static void two_to_one(void **state)
{
    (void)state;
    near_theory(1000, 500, 0.02);
}

static void water_and_air(void **state)
{
    (void)state;
    near_theory(1000, 1, 0.0125);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(two_to_one),
                                       cmocka_unit_test(water_and_air)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

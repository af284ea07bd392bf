/* SPDX-License-Identifier: BSD-3-Clause */
/* Three tanks with the model "temperature.conduction".
 *   mixing:   a sloshing tank, warm at the left and cold at the right, adiabatic walls. The sum of
 *             the temperatures must be constant.
 *   decay:    a full tank at rest, T = wall + A sin(pi x/L) sin(pi y/H), walls at a constant
 *             temperature. A must decay as exp(-kappa k^2 t), k^2 = (pi/L)^2 + (pi/H)^2, within
 *             2 %.
 *   friction: the sloshing tank, cold. With the law of viscosity friction must dissipate more
 *             energy. */
#include "temperature.h"
#include <math.h>
#include <mps/mps.h>
#include <stdio.h>

static const double LENGTH = 0.4, HEIGHT = 0.2; /* [m] */
static const double KAPPA = 1e-3;               /* [m2/s] */
static const double WALL = 300, AMPLITUDE = 20; /* [K] */

/* Temperature at a position [K]. */
typedef double (*profile)(const double *x);

/* Print an error of the library. @return 1 */
static int failed(const mps_sim *sim, const char *what)
{
    fprintf(stderr, "%s: %s\n", what, mps_sim_error(sim));
    return 1;
}

static double halves(const double *x)
{
    return x[0] < LENGTH / 2 ? 330 : 290;
}

static double sine(const double *x)
{
    const double pi = acos(-1.0);
    return WALL + AMPLITUDE * sin(pi * x[0] / LENGTH) * sin(pi * x[1] / HEIGHT);
}

/* A tank with water up to a depth, with the model. */
static int build(mps_sim *sim, double depth)
{
    const double lo[2] = {0, 0}, hi[2] = {LENGTH, depth};
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = LENGTH;
    tank.size[1] = HEIGHT;
    if (mps_tank_add(sim, &tank, NULL) < 0) return failed(sim, "tank");
    if (mps_fill_box_add(sim, 0, lo, hi, NULL, NULL) < 0) return failed(sim, "water");
    if (mps_model_register(sim, &temperature_conduction) < 0 ||
        mps_model_use(sim, "temperature.conduction") < 0 ||
        mps_model_set(sim, "temperature", "kappa", KAPPA) < 0)
        return failed(sim, "model");
    return 0;
}

/* Write the initial temperatures: the channel is a field while the model is active. */
static int warm(mps_sim *sim, profile at)
{
    mps_lease x = {.struct_size = sizeof x}, temperature = {.struct_size = sizeof temperature};
    if (mps_lease_begin(sim, "position", MPS_READ, &x) < 0) return failed(sim, "lease");
    if (mps_lease_begin(sim, "temperature", MPS_WRITE, &temperature) < 0)
        return failed(sim, "lease");
    for (int64_t i = 0; i < x.count; i++) temperature.data[i] = at(x.data + i * x.stride);
    mps_lease_end(sim, &x);
    return mps_lease_end(sim, &temperature) < 0 ? failed(sim, "lease") : 0;
}

/* sum T f(x) over the fluid; f = 1 for NULL. */
static double heat(mps_sim *sim, profile weight)
{
    mps_lease x = {.struct_size = sizeof x}, kind = {.struct_size = sizeof kind};
    mps_lease temperature = {.struct_size = sizeof temperature};
    double sum = 0;
    if (mps_lease_begin(sim, "position", MPS_READ, &x) < 0) return NAN;
    if (mps_lease_begin(sim, "kind", MPS_READ, &kind) < 0) return NAN;
    if (mps_lease_begin(sim, "temperature", MPS_READ, &temperature) < 0) return NAN;
    for (int64_t i = 0; i < x.count; i++)
        if (kind.integers[i] == MPS_FLUID)
            sum += weight ? (temperature.data[i] - WALL) * (weight(x.data + i * x.stride) - WALL)
                          : temperature.data[i];
    mps_lease_end(sim, &temperature);
    mps_lease_end(sim, &kind);
    mps_lease_end(sim, &x);
    return sum;
}

static int mixing(mps_sim *sim)
{
    const mps_harmonic surge = {.dof = MPS_MOVE_X, .amplitude = 0.01, .omega = 7.0};
    if (build(sim, HEIGHT / 2) || warm(sim, halves)) return 1;
    if (mps_model_set(sim, "temperature", "arrhenius", 2000) < 0) return failed(sim, "arrhenius");
    if (mps_motion_harmonics_set(sim, 1, &surge) < 0) return failed(sim, "motion");
    const double before = heat(sim, NULL);
    if (mps_run(sim, 2.0, NULL, NULL) < 0) return failed(sim, "run");
    const double change = heat(sim, NULL) / before - 1;
    printf("mixing: heat changed by %.1e of itself\n", change);
    return !(fabs(change) < 1e-12);
}

static int decay(mps_sim *sim)
{
    const double pi = acos(-1.0), t = 3.0;
    const double k2 = pi * pi * (1 / (LENGTH * LENGTH) + 1 / (HEIGHT * HEIGHT));
    if (build(sim, HEIGHT) || warm(sim, sine)) return 1;
    if (mps_model_set(sim, "temperature", "adiabatic", 0) < 0 ||
        mps_model_set(sim, "temperature", "wall", WALL) < 0)
        return failed(sim, "walls");
    const double before = heat(sim, sine);
    if (mps_run(sim, t, NULL, NULL) < 0) return failed(sim, "run");
    const double left = heat(sim, sine) / before, exact = exp(-KAPPA * k2 * t);
    printf("decay: %.5f of the sine is left, exact %.5f, off by %.2f %%\n", left, exact,
           100 * (left / exact - 1));
    return !(fabs(left / exact - 1) < 0.02);
}

static double cold(const double *x)
{
    (void)x;
    return 280;
}

/* Energy dissipated by friction in a cold sloshing tank [J/m]. */
static int lost(mps_sim *sim, double arrhenius, double *energy)
{
    const mps_harmonic surge = {.dof = MPS_MOVE_X, .amplitude = 0.01, .omega = 7.0};
    mps_energy e;
    mps_energy_init(&e, sizeof e);
    if (build(sim, HEIGHT / 2) || warm(sim, cold)) return 1;
    if (mps_model_remove(sim, "dissipation") < 0) return failed(sim, "dissipation");
    if (mps_model_set(sim, "temperature", "arrhenius", arrhenius) < 0 ||
        mps_model_set(sim, "temperature", "reference", 400) < 0)
        return failed(sim, "law");
    if (mps_motion_harmonics_set(sim, 1, &surge) < 0) return failed(sim, "motion");
    if (mps_run(sim, 0.5, NULL, NULL) < 0) return failed(sim, "run");
    if (mps_energy_get(sim, &e) < 0) return failed(sim, "energy");
    *energy = e.viscous;
    return 0;
}

static mps_sim *new_sim(double gravity)
{
    mps_sim *sim = NULL;
    mps_config config;
    mps_config_init(&config, sizeof config);
    config.dp = 0.01;
    config.gravity[1] = -gravity;
    return mps_sim_create(&config, &sim) < 0 ? NULL : sim;
}

static int friction(mps_sim *sim)
{
    double thin, thick;
    mps_sim *other = new_sim(9.81);
    const int bad = !other || lost(sim, 0, &thin) || lost(other, 4000, &thick);
    mps_sim_destroy(other);
    if (bad) return 1;
    printf("friction: %.2e J/m with the viscosity of the phase, %.2e J/m cold\n", thin, thick);
    return !(thick > 3 * thin);
}

static int run(int (*test)(mps_sim *), double gravity)
{
    mps_sim *sim = new_sim(gravity);
    const int bad = sim ? test(sim) : 1;
    mps_sim_destroy(sim);
    return bad;
}

int main(void)
{
    const int bad = run(mixing, 9.81) | run(decay, 0) | run(friction, 9.81);
    printf("%s\n", bad ? "FAILED" : "all hold");
    return bad;
}

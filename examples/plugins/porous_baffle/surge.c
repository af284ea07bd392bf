/* SPDX-License-Identifier: BSD-3-Clause */
/* A tank in surge near its first natural frequency, with and without a porous baffle in the middle.
 * Checks how the library accounts for the baffle:
 *   force    the impulse of the force probe of all solids is that of the liquid, within 3 % at
 *            dp 0.01 m, 9 % at 0.02 m: the force includes half cells at walls without particles
 *   share    without the force of the baffle the difference is larger
 *   budget   energies add up; the dissipation of the baffle is in `plugins`, not in `viscous`
 *   damping  the liquid has less energy with the baffle */
#include "baffle.h"
#include <math.h>
#include <mps/mps.h>
#include <stdio.h>

static const double LENGTH = 1, HEIGHT = 0.5, DEPTH = 0.2, DP = 0.01; /* [m] */

/* Results of a run. */
typedef struct result {
    double largest;          /* momentum along x [kg m/s] */
    double off, off_without; /* largest difference of impulse and momentum, over `largest` */
    double rest;             /* of the budget, over the work of the walls */
    mps_energy energy;
} result;

/* Print an error of the library. @return 1 */
static int failed(const mps_sim *sim, const char *what)
{
    fprintf(stderr, "%s: %s\n", what, mps_sim_error(sim));
    return 1;
}

static int add_force(mps_sim *sim, const char *part, int32_t *id)
{
    mps_probe probe;
    mps_probe_init(&probe, sizeof probe);
    probe.type = MPS_PROBE_FORCE;
    probe.part = part;
    probe.average = 0; /* the force of each step */
    return mps_probe_add(sim, &probe, id) < 0 ? failed(sim, "force") : 0;
}

static int build(mps_sim *sim, double forchheimer)
{
    const double lo[2] = {0, 0}, hi[2] = {LENGTH, DEPTH};
    const mps_harmonic surge = {.dof = MPS_MOVE_X, .amplitude = 0.01, .omega = 4.1};
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = LENGTH;
    tank.size[1] = HEIGHT;
    if (mps_tank_add(sim, &tank, NULL) < 0) return failed(sim, "tank");
    if (mps_fill_box_add(sim, 0, lo, hi, NULL, NULL) < 0) return failed(sim, "water");
    if (mps_motion_harmonics_set(sim, 1, &surge) < 0) return failed(sim, "motion");
    if (mps_model_register(sim, &baffle_porous) < 0 || mps_model_use(sim, "baffle.porous") < 0 ||
        mps_model_set(sim, "baffle", "from", 0.4 * LENGTH) < 0 ||
        mps_model_set(sim, "baffle", "to", 0.6 * LENGTH) < 0 ||
        mps_model_set(sim, "baffle", "forchheimer", forchheimer) < 0)
        return failed(sim, "baffle");
    return 0;
}

/* Run steps, and compare the impulse of the probes with the momentum of the liquid. */
static int run(mps_sim *sim, const int32_t id[2], result *r)
{
    double t = 0, before = 0, force[2][3], impulse[2] = {0};
    mps_momentum m;
    mps_momentum_init(&m, sizeof m);
    while (t < 4) {
        if (mps_step(sim, 4 - t, NULL) < 0) return failed(sim, "step");
        mps_sim_time(sim, &t, NULL);
        for (int k = 0; k < 2; k++) {
            if (mps_probe_read(sim, id[k], force[k]) < 0) return failed(sim, "force");
            impulse[k] -= force[k][0] * (t - before);
        }
        if (mps_momentum_get(sim, &m) < 0) return failed(sim, "momentum");
        r->largest = fmax(r->largest, fabs(m.total[0]));
        r->off = fmax(r->off, fabs(impulse[0] - m.total[0]));
        r->off_without = fmax(r->off_without, fabs(impulse[0] - impulse[1] - m.total[0]));
        before = t;
    }
    r->off /= r->largest;
    r->off_without /= r->largest;
    return 0;
}

static int measure(double forchheimer, result *r)
{
    int32_t id[2];
    mps_sim *sim;
    mps_config config;
    mps_config_init(&config, sizeof config);
    config.dp = DP;
    if (mps_sim_create(&config, &sim) < 0) return 1;
    *r = (result){0};
    mps_energy_init(&r->energy, sizeof r->energy);
    int bad = build(sim, forchheimer) || add_force(sim, NULL, &id[0]) ||
              add_force(sim, "baffle", &id[1]);
    mps_energy start;
    mps_energy_init(&start, sizeof start);
    bad = bad || mps_energy_get(sim, &start) < 0 || run(sim, id, r);
    bad = bad || mps_energy_get(sim, &r->energy) < 0;
    mps_sim_destroy(sim);
    if (bad) return 1;
    const mps_energy *e = &r->energy;
    const double gained = e->kinetic + e->potential - start.kinetic - start.potential;
    r->rest = fabs(e->wall_work_momentum - e->viscous - e->plugins - e->collision - e->shift -
                   e->numerical - gained) /
              e->potential;
    printf("forchheimer %3g 1/m: impulse off by %.1f %%, %.1f %% without the baffle's; work of the "
           "walls %.3f J/m, baffle %.3f, viscous %.3f, numerical %.3f, gained %.3f\n",
           forchheimer, 100 * r->off, 100 * r->off_without, e->wall_work_momentum, e->plugins,
           e->viscous, e->numerical, gained);
    return 0;
}

int main(void)
{
    result open, baffled;
    if (measure(0, &open) || measure(15, &baffled)) return 1;
    const mps_energy *e = &baffled.energy;
    const int good = open.off < 0.03 && baffled.off < 0.03 && baffled.off_without > 0.1 &&
                     open.rest < 1e-10 && baffled.rest < 1e-10 && open.energy.plugins == 0 &&
                     e->plugins > 0.3 * e->wall_work_momentum &&
                     e->kinetic + e->potential < open.energy.kinetic + open.energy.potential;
    printf("%s\n", good ? "the baffle is in forces and budgets" : "FAILED");
    return !good;
}

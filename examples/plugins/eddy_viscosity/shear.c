/* SPDX-License-Identifier: BSD-3-Clause */
/* The eddy viscosity in exact fields: a free block of water in shear, |S| = rate, and in rotation,
 * |S| = 0, in 2-D and 3-D; the resulting viscosity, by the energy dissipated by friction; a dam
 * break with C_s = 0, bitwise equal to one without the model, and with C_s = 0.15.
 *
 * usage: shear */
#include "eddy.h"
#include <mps/mps.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double DP = 0.01, RATE = 7.0, CS = 0.15; /* [m], [1/s], [-] */
enum { SIDE = 12, MOST = SIDE * SIDE * SIDE };

/* Print an error of the library. @return 1 */
static int failed(const mps_sim *sim, const char *what)
{
    fprintf(stderr, "%s: %s\n", what, mps_sim_error(sim));
    return 1;
}

static mps_sim *create(int32_t dim, double gravity)
{
    mps_sim *sim = NULL;
    mps_config config;
    mps_config_init(&config, sizeof config);
    config.dim = dim;
    config.dp = DP;
    config.gravity[1] = -gravity;
    return mps_sim_create(&config, &sim) < 0 ? NULL : sim;
}

static int use_model(mps_sim *sim, double cs)
{
    if (mps_model_register(sim, &eddy_smagorinsky) < 0 ||
        mps_model_use(sim, "eddy.smagorinsky") < 0 || mps_model_set(sim, "eddy", "cs", cs) < 0)
        return failed(sim, "model");
    return 0;
}

/* A block of water on a lattice, in the field u = (a y, b x, 0). */
static int add_block(mps_sim *sim, int32_t dim, double a, double b)
{
    double *x = calloc(6 * MOST, sizeof *x), *u = x ? x + 3 * MOST : NULL;
    const int deep = dim == 3 ? SIDE : 1;
    mps_particle_block block;
    mps_particle_block_init(&block, sizeof block);
    if (!x) return 1;
    for (int k = 0; k < SIDE * SIDE * deep; k++) {
        const int place[3] = {k % SIDE, k / SIDE % SIDE, k / SIDE / SIDE};
        for (int d = 0; d < dim; d++) x[k * dim + d] = DP * place[d];
        u[k * dim] = a * x[k * dim + 1];
        u[k * dim + 1] = b * x[k * dim];
    }
    block.count = SIDE * SIDE * deep;
    block.position = x;
    block.velocity = u;
    const mps_status status = mps_particles_add(sim, &block, NULL);
    free(x);
    return status < 0 ? failed(sim, "block") : 0;
}

/* Largest |strain - exact| after one short step, and the energy dissipated by friction in it
 * [J]. */
static int strain(int32_t dim, double a, double b, double exact, double cs, double *off,
                  double *energy)
{
    mps_lease f = {.struct_size = sizeof f};
    mps_energy e;
    mps_energy_init(&e, sizeof e);
    mps_sim *sim = create(dim, 0);
    if (!sim || use_model(sim, cs) || add_block(sim, dim, a, b)) return 1;
    if (mps_model_remove(sim, "dissipation") < 0) return failed(sim, "dissipation");
    int bad = mps_step(sim, 1e-7, NULL) < 0 || mps_energy_get(sim, &e) < 0 ||
              mps_lease_begin(sim, "strain_rate", MPS_READ, &f) < 0;
    if (bad) failed(sim, "step");
    *off = 0;
    for (int64_t i = 0; i < f.count; i++) *off = fmax(*off, fabs(f.data[i] - exact));
    if (!bad) mps_lease_end(sim, &f);
    *energy = e.viscous;
    mps_sim_destroy(sim);
    return bad;
}

static int fields_of(int32_t dim)
{
    const double length = CS * DP, wanted = 1 + 1000 * length * length * RATE / 1e-3;
    double shear, turn, thin, thick, none;
    if (strain(dim, RATE, 0, RATE, 0, &shear, &thin) ||
        strain(dim, RATE, 0, RATE, CS, &shear, &thick) ||
        strain(dim, -RATE, RATE, 0, CS, &turn, &none))
        return 1;
    printf("%d-D: |S| of shear %g 1/s is off by %.1e, of rotation by %.1e 1/s\n", (int)dim, RATE,
           shear, turn);
    printf("%d-D: friction takes %.6f times the energy, exact %.6f\n", (int)dim, thick / thin,
           wanted);
    return !(shear < 1e-10 * RATE && turn < 1e-10 * RATE && fabs(thick / thin / wanted - 1) < 1e-4);
}

/* A collapsing column of water. */
static mps_sim *dam(void)
{
    const double lo[2] = {0, 0}, hi[2] = {0.2, 0.2};
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = 0.5;
    tank.size[1] = 0.4;
    mps_sim *sim = create(2, 9.81);
    if (!sim || mps_tank_add(sim, &tank, NULL) < 0 ||
        mps_fill_box_add(sim, 0, lo, hi, NULL, NULL) < 0)
        return NULL;
    return sim;
}

/* Positions at t = 0.3 s; cs < 0: without the model. @return checksum, 0 after a failure */
static uint64_t positions(double cs, double *energy)
{
    mps_lease x = {.struct_size = sizeof x};
    mps_energy e;
    uint64_t sum = 0;
    mps_energy_init(&e, sizeof e);
    mps_sim *sim = dam();
    if (!sim || (cs >= 0 && use_model(sim, cs))) return 0;
    if (mps_run(sim, 0.3, NULL, NULL) < 0 || mps_energy_get(sim, &e) < 0 ||
        mps_lease_begin(sim, "position", MPS_READ, &x) < 0) {
        failed(sim, "dam break");
    } else {
        for (int64_t i = 0; i < x.count * x.stride; i++) {
            uint64_t bits;
            memcpy(&bits, &x.data[i], sizeof bits);
            sum = sum * 1099511628211u + bits;
        }
        mps_lease_end(sim, &x);
    }
    *energy = e.viscous;
    mps_sim_destroy(sim);
    return sum;
}

static int dam_breaks(void)
{
    double none, zero, full;
    const uint64_t a = positions(-1, &none), b = positions(0, &zero), c = positions(CS, &full);
    printf("dam break: C_s = 0 %s as without, friction takes %.4f J/m; C_s = %g: %.4f J/m\n",
           a == b ? "moves" : "DOES NOT MOVE", zero, CS, full);
    return !(a && a == b && c && c != a && full > zero);
}

int main(void)
{
    const int bad = fields_of(2) | fields_of(3) | dam_breaks();
    printf("%s\n", bad ? "FAILED" : "all hold");
    return bad;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Thin plates in the liquid: at rest with different levels on both sides, sloshing over a baffle of
 * one column, rolling with it. */
#include "../tags.h"
#include <math.h>
#include <mps/mps.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { FORCE, LEFT, RIGHT, PROBES };
static const double rho0 = 1000, g = 9.81, dp = 0.02;

#define OK(sim, call)                                               \
    do {                                                            \
        mps_status status_ = (call);                                \
        if (status_ != MPS_OK)                                      \
            fail_msg("%s: %s: %s", #call, mps_status_name(status_), \
                     (sim) ? mps_sim_error(sim) : "no handle");     \
    } while (0)
#define NEAR(what, got, wanted, tolerance)                                                     \
    do {                                                                                       \
        double got_ = (got), wanted_ = (wanted), tolerance_ = (tolerance);                     \
        print_message("    %s: %.5g, wanted %.5g +- %.2g\n", what, got_, wanted_, tolerance_); \
        if (!(fabs(got_ - wanted_) <= tolerance_))                                             \
            fail_msg("%s is off by %g", what, got_ - wanted_);                                 \
    } while (0)

static mps_sim *open_tank(int32_t dim, double length, double height, double width)
{
    mps_config config;
    mps_tank tank;
    mps_sim *sim = NULL;
    OK(sim, mps_config_init(&config, sizeof config));
    config.dim = dim;
    config.dp = dp;
    OK(sim, mps_sim_create(&config, &sim));
    OK(sim, mps_tank_init(&tank, sizeof tank));
    tank.size[0] = length;
    tank.size[1] = height;
    tank.size[2] = width;
    OK(sim, mps_tank_add(sim, &tank, NULL));
    return sim;
}

/* Off the lattice by up to `amount`: a perfect one is at rest to rounding, which proves little. */
static void jitter(mps_sim *sim, double amount)
{
    const int32_t *kind;
    mps_lease x = {.struct_size = sizeof x};
    uint32_t seed = 1;
    OK(sim, tags_peek(sim, NULL, &kind, NULL, NULL));
    OK(sim, mps_lease_begin(sim, "position", MPS_WRITE, &x));
    for (int64_t i = 0; i < x.count * x.stride; i++) {
        seed = seed * 1664525u + 1013904223u;
        if (kind[i / x.stride] == MPS_FLUID) x.data[i] += amount * (2.0 * seed / 4294967296.0 - 1);
    }
    OK(sim, mps_lease_end(sim, &x));
}

/* ---- rest ------------------------------------------------------------------------------------ */

typedef struct rest {
    int32_t probe[PROBES];
    double from, sum[PROBES], kinetic, steps;
} rest;

static int watch(void *user, mps_sim *sim, const mps_step_info *info)
{
    rest *r = user;
    double values[6];
    mps_energy energy;
    mps_energy_init(&energy, sizeof energy);
    mps_energy_get(sim, &energy);
    if (info->t < r->from) return 0;
    for (int k = 0; k < PROBES; k++) {
        mps_probe_read(sim, r->probe[k], values);
        r->sum[k] += values[0];
    }
    r->kinetic += energy.kinetic;
    r->steps++;
    return 0;
}

static int32_t add_probe(mps_sim *sim, int32_t type, double x, double z)
{
    mps_probe probe;
    int32_t id = -1;
    OK(sim, mps_probe_init(&probe, sizeof probe));
    probe.type = type;
    probe.part = type == MPS_PROBE_FORCE ? "plate" : NULL;
    probe.at[0] = x;
    probe.at[1] = 0.04;
    probe.at[2] = z;
    OK(sim, mps_probe_add(sim, &probe, &id));
    return id;
}

/* Water 0.2 m deep on the left of a plate from floor to ceiling, `right` on the other side. */
static void check_divided(int32_t dim, int columns, double right, double t_end)
{
    const double width = 0.16, thick = (columns - 1) * dp, x = 0.2, deep = 0.2;
    const double lo[3] = {x, 0, 0}, hi[3] = {x + thick, 0.3, width}, a[3] = {0, 0, 0},
                 b[3] = {x, deep, width};
    const double c[3] = {x + thick, 0, 0}, d[3] = {0.4 + thick, right, width};
    mps_sim *sim = open_tank(dim, 0.4 + thick, 0.3, width);
    int64_t left = 0, other = 0, counted = 0;
    print_message("  %d columns in %d-D, %g m on the right\n", columns, (int)dim, right);
    OK(sim, mps_baffle_add(sim, "plate", lo, hi, NULL));
    OK(sim, mps_fill_box_add(sim, 0, a, b, &left, NULL));
    if (right > 0) OK(sim, mps_fill_box_add(sim, 0, c, d, &other, NULL));
    jitter(sim, 0.05 * dp);
    rest r = {.from = 0.5 * t_end};
    r.probe[FORCE] = add_probe(sim, MPS_PROBE_FORCE, x, 0);
    r.probe[LEFT] = add_probe(sim, MPS_PROBE_WALL_PRESSURE, x - 1e-6, 0.08);
    r.probe[RIGHT] = add_probe(sim, MPS_PROBE_WALL_PRESSURE, x + thick + 1e-6, 0.08);
    OK(sim, mps_run(sim, t_end, watch, &r));
    const double unit = rho0 * g * deep, face = dim == 3 ? width : 1;
    /* a dry row above the water takes the weight of the surface row */
    const double force = rho0 * g *
                         (0.5 * (deep * deep - right * right) - (right > 0 ? 0 : dp * dp)) * face;
    NEAR("left face [Pa]", r.sum[LEFT] / r.steps, rho0 * g * (deep - 0.04), 0.02 * unit);
    NEAR("right face [Pa]", r.sum[RIGHT] / r.steps, right > 0 ? rho0 * g * (right - 0.04) : 0,
         0.02 * unit);
    NEAR("force [N]", r.sum[FORCE] / r.steps, force, 0.03 * force);
    NEAR("mean speed at the end [m/s]", sqrt(2 * r.kinetic / r.steps / (rho0 * 0.04 * face)), 0,
         0.02 * sqrt(g * dp));
    mps_lease place = {.struct_size = sizeof place};
    const int32_t *kind;
    OK(sim, tags_peek(sim, NULL, &kind, NULL, NULL));
    OK(sim, mps_lease_begin(sim, "position", MPS_READ, &place));
    for (int64_t i = 0; i < place.count; i++)
        counted += kind[i] == MPS_FLUID && place.data[i * dim] < x;
    assert_int_equal(counted, left);
    assert_int_equal(mps_particles_count(sim, MPS_FLUID), left + other);
    OK(sim, mps_lease_end(sim, &place));
    mps_sim_destroy(sim);
}

static void divided_tank(void **state)
{
    (void)state;
    for (int columns = 1; columns <= 3; columns++) check_divided(2, columns, 0.1, 2);
}

static void one_side_empty(void **state)
{
    (void)state;
    check_divided(2, 1, 0, 1);
}

static void divided_tank_3d(void **state)
{
    (void)state;
    check_divided(3, 1, 0.1, 0.2);
}

/* ---- motion ---------------------------------------------------------------------------------- */

/* Positions by id in the tank's frame before a step. */
typedef struct paths {
    double *before, x, top, worst_volume;
    int64_t crossed, lost;
} paths;

static void tank_frame(mps_sim *sim, const double *x, double X[2])
{
    mps_motion_state m = {.struct_size = sizeof m};
    OK(sim, mps_motion_state_get(sim, &m));
    /* the centre is the foot of the baffle */
    const double c = cos(m.value[MPS_ROTATE_Z]), s = sin(m.value[MPS_ROTATE_Z]),
                 dx = x[0] - 0.28 - m.value[MPS_MOVE_X], dy = x[1];
    X[0] = 0.28 + c * dx + s * dy;
    X[1] = -s * dx + c * dy;
}

static int follow(void *user, mps_sim *sim, const mps_step_info *info)
{
    paths *p = user;
    const int64_t *id;
    const int32_t *kind;
    mps_lease x = {.struct_size = sizeof x};
    mps_energy energy;
    OK(sim, tags_peek(sim, &id, &kind, NULL, NULL));
    OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
    for (int64_t i = 0; i < x.count; i++) {
        double X[2], *old = p->before + 2 * id[i];
        if (kind[i] != MPS_FLUID) continue;
        tank_frame(sim, x.data + 2 * i, X);
        const double a = old[0] - p->x, b = X[0] - p->x;
        p->crossed += info->step > 1 && a * b < 0 &&
                      old[1] + (X[1] - old[1]) * a / (a - b) < p->top;
        memcpy(old, X, sizeof X);
    }
    OK(sim, mps_lease_end(sim, &x));
    mps_energy_init(&energy, sizeof energy);
    OK(sim, mps_energy_get(sim, &energy));
    p->worst_volume = fmax(p->worst_volume, fabs(energy.volume_error));
    p->lost = info->lost;
    return 0;
}

static void check_motion(const mps_harmonic *motion, double t_end)
{
    mps_sim *sim = open_tank(2, 0.56, 0.4, 0);
    const double lo[2] = {0.28, 0}, hi[2] = {0.28, 0.14}, a[2] = {0, 0}, b[2] = {0.56, 0.18};
    OK(sim, mps_baffle_add(sim, "plate", lo, hi, NULL));
    OK(sim, mps_fill_box_add(sim, 0, a, b, NULL, NULL));
    OK(sim, mps_motion_centre_set(sim, lo, MPS_START_AT_REST));
    OK(sim, mps_motion_harmonics_set(sim, 1, motion));
    paths p = {.x = 0.28,
               .top = 0.14,
               .before = calloc(2 * (size_t)mps_particles_count(sim, -1), sizeof *p.before)};
    assert_non_null(p.before);
    OK(sim, mps_run(sim, t_end, follow, &p));
    NEAR("passed through the plate", (double)p.crossed, 0, 0);
    NEAR("lost", (double)p.lost, 0, 0);
    NEAR("volume error", p.worst_volume, 0, 0.04);
    free(p.before);
    mps_sim_destroy(sim);
}

static void sloshing_over_a_baffle(void **state)
{
    (void)state;
    const mps_harmonic surge = {.dof = MPS_MOVE_X, .amplitude = 0.1, .omega = 3.53};
    check_motion(&surge, 3);
}

static void rolling_with_a_baffle(void **state)
{
    (void)state;
    const mps_harmonic roll = {.dof = MPS_ROTATE_Z, .amplitude = 0.2, .omega = 4};
    check_motion(&roll, 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(divided_tank),          cmocka_unit_test(one_side_empty),
        cmocka_unit_test(divided_tank_3d),       cmocka_unit_test(sloshing_over_a_baffle),
        cmocka_unit_test(rolling_with_a_baffle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

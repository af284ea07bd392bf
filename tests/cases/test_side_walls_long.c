/* SPDX-License-Identifier: BSD-3-Clause */
/* Side walls in 2-D (friction.history) against the same tank in 3-D, where they have particles: a
 * shallow liquid in a thin tank that rolls, as in the case sloshing_roll, at its spacing. The
 * liquid is 500 times as viscous as water, so that the layers, a quarter of the width, are two
 * spacings thick and 3-D resolves them. */
#include <math.h>
#include <mps/mps.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static const double DP = 0.00775, LENGTH = 0.9, HEIGHT = 0.508, WIDTH = 0.062, DEPTH = 0.093,
                    RHO = 900, MU = 0.45, G = 9.81, PI = 3.14159265358979;

enum { TIMES = 260, PASS = 2 };
static const double INTERVAL = 0.01;

#define OK(sim, call)                                               \
    do {                                                            \
        mps_status status_ = (call);                                \
        if (status_ < 0)                                            \
            fail_msg("%s: %s: %s", #call, mps_status_name(status_), \
                     (sim) ? mps_sim_error(sim) : "no handle");     \
    } while (0)

/* Results of a run: mean velocity of the liquid along the tank; of both ends, left first, the
 * largest height of the surface above the still level, when, and the largest pressure at the still
 * level. Of the left end after 2 s, of the right end before. */
typedef struct seen {
    double u[TIMES], run_up[PASS], when[PASS], pressure[PASS];
} seen;

static void build(mps_sim *sim, int dim)
{
    const double lo[3] = {0}, hi[3] = {LENGTH, DEPTH, WIDTH},
                 middle[3] = {0.5 * LENGTH, 0, 0.5 * WIDTH};
    const double k = PI / LENGTH, period = 0.85 * 2 * PI / sqrt(G * k * tanh(k * DEPTH));
    const mps_harmonic roll = {.dof = MPS_ROTATE_Z,
                               .amplitude = 4 * PI / 180,
                               .omega = 2 * PI / period,
                               .ramp = 0.5 * period};
    mps_phase oil;
    mps_tank tank;
    OK(sim, mps_phase_init(&oil, sizeof oil));
    oil.density = RHO;
    oil.viscosity = MU;
    OK(sim, mps_phase_set(sim, 0, &oil));
    OK(sim, mps_tank_init(&tank, sizeof tank));
    tank.size[0] = LENGTH;
    tank.size[1] = HEIGHT;
    if (dim == 3) tank.size[2] = WIDTH;
    OK(sim, mps_tank_add(sim, &tank, NULL));
    OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    OK(sim, mps_motion_centre_set(sim, middle, MPS_START_AT_REST));
    OK(sim, mps_motion_harmonics_set(sim, 1, &roll));
}

static int32_t probe(mps_sim *sim, int32_t type, double x, double y)
{
    mps_probe p;
    int32_t id;
    OK(sim, mps_probe_init(&p, sizeof p));
    p.type = type;
    p.at[0] = x;
    p.at[1] = y;
    p.at[2] = 0.5 * WIDTH;
    OK(sim, mps_probe_add(sim, &p, &id));
    return id;
}

static double read_probe(mps_sim *sim, int32_t id)
{
    double value[8];
    OK(sim, mps_probe_read(sim, id, value));
    return value[0];
}

static void run(int dim, bool sides, seen *s)
{
    mps_config config;
    mps_sim *sim = NULL;
    memset(s, 0, sizeof *s);
    OK(sim, mps_config_init(&config, sizeof config));
    config.dim = dim;
    config.dp = DP;
    OK(sim, mps_sim_create(&config, &sim));
    OK(sim, mps_threads_set(sim, 1));
    build(sim, dim);
    if (sides) {
        OK(sim, mps_model_use(sim, "friction.history"));
        OK(sim, mps_model_set(sim, "friction", "width", WIDTH));
    }
    const double end[PASS] = {DP, LENGTH - DP};
    int32_t height[PASS], wall[PASS];
    for (int k = 0; k < PASS; k++) {
        height[k] = probe(sim, MPS_PROBE_GAUGE, end[k], 0);
        wall[k] = probe(sim, MPS_PROBE_WALL_PRESSURE, k == 0 ? 0 : LENGTH, DEPTH);
    }
    for (int n = 0; n < TIMES; n++) {
        mps_momentum m;
        mps_energy e;
        OK(sim, mps_run(sim, (n + 1) * INTERVAL, NULL, NULL));
        OK(sim, mps_momentum_init(&m, sizeof m));
        OK(sim, mps_energy_init(&e, sizeof e));
        OK(sim, mps_momentum_get(sim, &m));
        OK(sim, mps_energy_get(sim, &e));
        s->u[n] = m.total[0] / e.mass;
        const int k = n * INTERVAL < 2 ? 1 : 0;
        const double up = read_probe(sim, height[k]) - DEPTH;
        if (up > s->run_up[k]) s->when[k] = (n + 1) * INTERVAL;
        s->run_up[k] = fmax(s->run_up[k], up);
        s->pressure[k] = fmax(s->pressure[k], read_probe(sim, wall[k]));
    }
    mps_sim_destroy(sim);
}

/* Root mean square of the difference of the mean velocities, over that of the second. */
static double deviation(const seen *a, const seen *b)
{
    double difference = 0, size = 0;
    for (int n = 0; n < TIMES; n++) {
        difference += (a->u[n] - b->u[n]) * (a->u[n] - b->u[n]);
        size += b->u[n] * b->u[n];
    }
    return sqrt(difference / size);
}

/* Mean velocity, speed of the crest from end to end and first pressures of both: within 15 %.
 * Without side walls the mean velocity is off by more than half of it. Heights are shown only: in
 * 3-D they are those in the middle of the width. */
static void as_in_3d(void **state)
{
    (void)state;
    seen sides, none, full;
    run(2, true, &sides);
    run(2, false, &none);
    run(3, false, &full);
    const double with = deviation(&sides, &full), without = deviation(&none, &full);
    const double speed = (full.when[0] - full.when[1]) / (sides.when[0] - sides.when[1]);
    print_message(
        "    mean velocity off by %.3f, without side walls %.3f; speed of the crest %.3f\n", with,
        without, speed);
    for (int k = 0; k < PASS; k++)
        print_message("    run-up %.3f, pressure %.3f of those in 3-D\n",
                      sides.run_up[k] / full.run_up[k], sides.pressure[k] / full.pressure[k]);
    assert_true(with > 0 && with < 0.15 && without > 0.5);
    assert_true(speed > 0.85 && speed < 1.15);
    for (int k = 0; k < PASS; k++)
        assert_true(sides.pressure[k] > 0.85 * full.pressure[k] &&
                    sides.pressure[k] < 1.15 * full.pressure[k]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(as_in_3d)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* A jet from above fills an open tank in 20 s; then a tank with a jet overflows into an outlet.
 * Prints the volume from the number of particles and from gauges, divided by rate times time.
 *
 * usage: fill [dp]     dp: spacing [m], default 0.02; the width of the jet is a multiple of it */
#include "inflow.h"
#include <math.h>
#include <mps/mps.h>
#include <stdio.h>
#include <stdlib.h>

static const double LENGTH = 2, HEIGHT = 1;               /* of the tank [m] */
static const double WIDTH = 0.12, SPEED = 0.5, TOP = 1.2; /* of the jet [m], [m/s] */
static const double FILLED = 20, SETTLED = 24, LAST = 28; /* times [s] */
enum { GAUGES = 7 };

/* Print an error of the library. @return 1 */
static int failed(const mps_sim *sim, const char *what)
{
    fprintf(stderr, "%s: %s\n", what, mps_sim_error(sim));
    return 1;
}

static void tell(void *user, int level, const char *text)
{
    (void)user, (void)level;
    fprintf(stderr, "%s\n", text);
}

/* An open tank with a jet above it. */
static mps_sim *build(double dp, double length, double stop)
{
    mps_sim *sim = NULL;
    mps_config config;
    mps_tank tank;
    mps_config_init(&config, sizeof config);
    mps_tank_init(&tank, sizeof tank);
    config.dp = dp;
    config.log = tell;
    tank.size[0] = length;
    tank.size[1] = HEIGHT;
    tank.open_top = 1;
    if (mps_sim_create(&config, &sim) < 0) return NULL;
    if (mps_tank_add(sim, &tank, NULL) < 0 || mps_model_register(sim, &inflow_jet) < 0 ||
        mps_model_use(sim, "inflow.jet") < 0 || mps_model_set(sim, "inflow", "x", 0.5) < 0 ||
        mps_model_set(sim, "inflow", "y", TOP) < 0 ||
        mps_model_set(sim, "inflow", "v", -SPEED) < 0 ||
        mps_model_set(sim, "inflow", "width", WIDTH) < 0 ||
        mps_model_set(sim, "inflow", "stop", stop) < 0) {
        failed(sim, "set-up");
        mps_sim_destroy(sim);
        return NULL;
    }
    return sim;
}

static int add_gauges(mps_sim *sim, double length, int32_t *gauge)
{
    for (int k = 0; k < GAUGES; k++) {
        mps_probe probe;
        mps_probe_init(&probe, sizeof probe);
        probe.type = MPS_PROBE_GAUGE;
        probe.at[0] = length * (k + 0.5) / GAUGES;
        if (mps_probe_add(sim, &probe, &gauge[k]) < 0) return failed(sim, "gauge");
    }
    return 0;
}

/* Sums of gauge values. */
typedef struct levels {
    int32_t gauge[GAUGES];
    double sum, time;
} levels;

static int note_level(void *user, mps_sim *sim, const mps_step_info *info)
{
    levels *l = user;
    for (int k = 0; k < GAUGES; k++) {
        double value = 0;
        mps_probe_read(sim, l->gauge[k], &value);
        l->sum += value * info->dt / GAUGES;
    }
    l->time += info->dt;
    return 0;
}

/* Relative difference of `value` from `exact`; prints it. @return whether it is too large */
static int differs(const char *what, double value, double exact, double most)
{
    const double off = value / exact - 1;
    printf("%-26s %.5f, exact %.5f, off by %+.3f %%\n", what, value, exact, 100 * off);
    return !(fabs(off) <= most);
}

static int fill(double dp)
{
    const double volume = WIDTH * SPEED * FILLED;
    levels l = {.sum = 0};
    mps_energy e;
    mps_step_info info;
    mps_energy_init(&e, sizeof e);
    mps_step_info_init(&info, sizeof info);
    mps_sim *sim = build(dp, LENGTH, FILLED);
    if (!sim || add_gauges(sim, LENGTH, l.gauge)) return 1;
    int bad = mps_run(sim, SETTLED, NULL, NULL) < 0 || mps_run(sim, LAST, note_level, &l) < 0 ||
              mps_step(sim, 1, &info) < 0 || mps_energy_get(sim, &e) < 0;
    if (bad) failed(sim, "fill");
    const double count = (double)mps_particles_count(sim, MPS_FLUID);
    bad |= differs("volume of the particles", count * dp * dp, volume, 0.005);
    bad |= differs("volume by the gauges", l.sum / l.time * (LENGTH - dp), volume, 0.02);
    bad |= differs("volume_filled / length", e.volume_filled / LENGTH, volume / (LENGTH - dp),
                   0.02);
    bad |= differs("energy let in", e.added,
                   1000 * count * dp * dp * (0.5 * SPEED * SPEED + 9.81 * TOP), 1e-9);
    printf("lost %lld, steps %lld\n", (long long)info.lost, (long long)info.step);
    bad |= info.lost != 0;
    mps_sim_destroy(sim);
    return bad;
}

/* Particles in the outlet, which the next step removes, and their energy. */
static int leaving(mps_sim *sim, double dp, double level, int64_t *count, double *energy)
{
    mps_lease x = {.struct_size = sizeof x}, u = {.struct_size = sizeof u},
              kind = {.struct_size = sizeof kind};
    if (mps_lease_begin(sim, "position", MPS_READ, &x) < 0 ||
        mps_lease_begin(sim, "velocity", MPS_READ, &u) < 0 ||
        mps_lease_begin(sim, "kind", MPS_READ, &kind) < 0)
        return failed(sim, "lease");
    for (int64_t i = 0; i < x.count; i++) {
        const double *p = x.data + 2 * i, *v = u.data + 2 * i;
        if (kind.integers[i] != MPS_FLUID || p[0] <= 0.8 || p[0] >= 1 || p[1] <= level || p[1] >= 1)
            continue;
        ++*count;
        *energy += 1000 * dp * dp * (0.5 * (v[0] * v[0] + v[1] * v[1]) + 9.81 * p[1]);
    }
    mps_lease_end(sim, &kind);
    mps_lease_end(sim, &u);
    mps_lease_end(sim, &x);
    return 0;
}

/* A tank that is full up to the outlet remains full, and outflow equals inflow. */
static int overflow(double dp)
{
    const double level = 0.4, lo[2] = {0, 0}, hi[2] = {1, level}, until = 8;
    const double row = WIDTH * dp * 1000 * (0.5 * SPEED * SPEED + 9.81 * TOP);
    int64_t first = 0, gone = 0;
    double left = 0, t = 0;
    mps_energy e;
    mps_step_info info;
    mps_energy_init(&e, sizeof e);
    mps_step_info_init(&info, sizeof info);
    mps_sim *sim = build(dp, 1, until);
    if (!sim || mps_fill_box_add(sim, 0, lo, hi, &first, NULL) < 0) return 1;
    int bad = mps_model_set(sim, "inflow", "x0", 0.8) < 0 ||
              mps_model_set(sim, "inflow", "x1", 1) < 0 ||
              mps_model_set(sim, "inflow", "y0", level + dp) < 0 ||
              mps_model_set(sim, "inflow", "y1", 1) < 0;
    while (!bad && t < until) {
        bad = leaving(sim, dp, level + dp, &gone, &left) || mps_step(sim, until - t, &info) < 0 ||
              mps_sim_time(sim, &t, NULL) < 0;
    }
    if (bad || mps_energy_get(sim, &e) < 0) bad = failed(sim, "overflow");
    const int64_t rows = (int64_t)ceil(until * SPEED / dp - 1e-9),
                  come = rows * (int64_t)(WIDTH / dp + 0.5),
                  there = mps_particles_count(sim, MPS_FLUID);
    printf("outlet: %lld came, %lld went, %lld more are there, %lld lost\n", (long long)come,
           (long long)gone, (long long)(there - first), (long long)info.lost);
    bad |= there - first != come - gone || info.lost != 0;
    bad |= differs("energy let in and out", e.added, (double)rows * row - left, 1e-9);
    bad |= differs("volume over the start", (double)there, (double)first, 0.10);
    mps_sim_destroy(sim);
    return bad;
}

int main(int argc, char **argv)
{
    const double dp = argc > 1 ? atof(argv[1]) : 0.02;
    const int bad = fill(dp) | overflow(dp);
    printf("%s\n", bad ? "FAILED" : "all hold");
    return bad;
}

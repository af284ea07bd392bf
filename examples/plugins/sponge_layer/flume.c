/* SPDX-License-Identifier: BSD-3-Clause */
/* Wave flume: a hump of water at the left end propagates to the right end, with and without a
 * sponge layer at that end. A gauge measures the incident and the reflected wave. Prints the
 * reflection coefficient, the height of the reflected wave over that of the incident wave.
 *
 * usage: flume [dp]       dp: spacing [m], default 0.02
 *        flume --order    print the order of the verbs of a step instead */
#include "sponge.h"
#include <math.h>
#include <mps/mps.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double LENGTH = 5, HEIGHT = 0.4, DEPTH = 0.2; /* of the flume and the water [m] */
static const double HUMP = 0.04, WIDTH = 0.5;              /* height and half length [m] */
static const double GAUGE = 2.0, SPONGE = 3.0;             /* positions [m] */

/* Print an error of the library. @return 1 */
static int failed(const mps_sim *sim, const char *what)
{
    fprintf(stderr, "%s: %s\n", what, mps_sim_error(sim));
    return 1;
}

/* Water below the surface DEPTH + hump. */
static int is_water(void *user, const double *x)
{
    const double s = x[0] < WIDTH ? cos(0.5 * acos(-1.0) * x[0] / WIDTH) : 0;
    (void)user;
    return x[1] < DEPTH + HUMP * s * s;
}

static int build(mps_sim *sim, int32_t *gauge)
{
    mps_tank tank;
    mps_probe probe;
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = LENGTH;
    tank.size[1] = HEIGHT;
    tank.open_top = 1;
    if (mps_tank_add(sim, &tank, NULL) < 0) return failed(sim, "tank");
    if (mps_fill_add(sim, 0, is_water, NULL, NULL) < 0) return failed(sim, "water");
    mps_probe_init(&probe, sizeof probe);
    probe.type = MPS_PROBE_GAUGE;
    probe.at[0] = GAUGE;
    if (mps_probe_add(sim, &probe, gauge) < 0) return failed(sim, "gauge");
    return 0;
}

static int add_sponge(mps_sim *sim, double rate)
{
    if (mps_model_register(sim, &sponge_layer) < 0) return failed(sim, "register");
    if (mps_model_use(sim, "sponge.layer") < 0 ||
        mps_model_set(sim, "sponge", "from", SPONGE) < 0 ||
        mps_model_set(sim, "sponge", "to", LENGTH) < 0 ||
        mps_model_set(sim, "sponge", "rate", rate) < 0)
        return failed(sim, "sponge");
    return 0;
}

static void print_order(mps_sim *sim)
{
    mps_verb_info verb;
    mps_verb_info_init(&verb, sizeof verb);
    for (int32_t k = 0; mps_verb_info_get(sim, k, &verb) == MPS_OK; k++)
        printf("%-9s %-22s %s\n", verb.hook_name, verb.model, verb.uses);
}

/* Highest surface at the gauge between two times [m]. */
static int highest(mps_sim *sim, int32_t gauge, double until, double *most)
{
    double t, value;
    *most = 0;
    for (mps_sim_time(sim, &t, NULL); t < until; mps_sim_time(sim, &t, NULL)) {
        if (mps_step(sim, until - t, NULL) < 0) return failed(sim, "step");
        if (mps_probe_read(sim, gauge, &value) < 0) return failed(sim, "gauge");
        *most = fmax(*most, value);
    }
    return 0;
}

/* Height of the incident wave at the gauge, and ratio of the reflected wave to it. */
static int measure(double dp, double rate, double *reflection)
{
    const double speed = sqrt(9.81 * DEPTH), back = (2 * LENGTH - GAUGE) / speed;
    double still, wave = 0, returned = 0;
    int32_t gauge;
    mps_sim *sim;
    mps_config config;
    mps_config_init(&config, sizeof config);
    config.dp = dp;
    if (mps_sim_create(&config, &sim) < 0) return 1;
    int bad = build(sim, &gauge) || add_sponge(sim, rate);
    bad = bad || mps_probe_read(sim, gauge, &still) < 0;
    bad = bad || highest(sim, gauge, 2.0, &wave);
    bad = bad || highest(sim, gauge, back - 1.2, &returned); /* tail of the wave */
    bad = bad || highest(sim, gauge, back + 0.8, &returned);
    mps_sim_destroy(sim);
    if (bad) return 1;
    returned -= HUMP * WIDTH / 2 / LENGTH; /* the volume of the hump, distributed over the flume */
    *reflection = (returned - still) / (wave - still);
    printf("rate %4.1f 1/s: wave %.2f mm, reflected %.2f mm, reflection %.3f\n", rate,
           1000 * (wave - still), 1000 * (returned - still), *reflection);
    return 0;
}

static int show_order(void)
{
    mps_sim *sim;
    mps_config config;
    mps_config_init(&config, sizeof config);
    config.dp = 0.05;
    if (mps_sim_create(&config, &sim) < 0) return 1;
    const int bad = add_sponge(sim, 1);
    if (!bad) print_order(sim);
    mps_sim_destroy(sim);
    return bad;
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "--order") == 0) return show_order();
    const double dp = argc > 1 ? atof(argv[1]) : 0.02;
    double wall, sponge;
    if (measure(dp, 0, &wall) || measure(dp, 6, &sponge)) return 1;
    const int good = wall > 0.5 && sponge < 0.3 * wall;
    printf("%s\n", good ? "the sponge takes the wave" : "FAILED: the sponge should take the wave");
    return !good;
}

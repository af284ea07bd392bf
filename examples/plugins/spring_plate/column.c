/* SPDX-License-Identifier: BSD-3-Clause */
/* A plate over the width of a column carries water and is supported by a spring. The water moves
 * with the plate, so that the added mass is its mass:  omega^2 = k/(m + rho W h). The particles of
 * the plate and of the water end dp/2 before the walls: W - dp is W in the limit. Prints the ratio
 * of the frequency to the exact one.
 *
 * usage: column [dp [file]]   dp: spacing [m], default 0.01; file: t and displacement, as text */
#include "spring.h"
#include <math.h>
#include <mps/mps.h>
#include <stdio.h>
#include <stdlib.h>

static const double WIDTH = 0.2, HEIGHT = 0.9, DEPTH = 0.4;  /* of the column and its water [m] */
static const double BOTTOM = 0.2, THICK = 0.08;              /* of the plate [m] */
static const double MASS = 40, FREQUENCY = 1, START = -0.01; /* [kg/m], [Hz], [m] */
static const double UNTIL = 5.2;                             /* [s] */

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

/* Particles of the part "plate" are the body, initially displaced from equilibrium. */
static int choose_body(mps_sim *sim)
{
    mps_lease part = {.struct_size = sizeof part}, member = {.struct_size = sizeof member},
              motion = {.struct_size = sizeof motion};
    const int32_t plate = mps_part_find(sim, "plate");
    if (mps_lease_begin(sim, "part", MPS_READ, &part) < 0 ||
        mps_lease_begin(sim, "spring_member", MPS_WRITE, &member) < 0 ||
        mps_lease_begin(sim, "spring_motion", MPS_WRITE, &motion) < 0)
        return failed(sim, "lease");
    for (int64_t i = 0; i < part.count; i++) {
        member.data[i] = part.integers[i] == plate;
        motion.data[i * motion.stride] = part.integers[i] == plate ? START : 0;
    }
    mps_lease_end(sim, &part);
    if (mps_lease_end(sim, &member) < 0 || mps_lease_end(sim, &motion) < 0)
        return failed(sim, "lease");
    return 0;
}

static int set(mps_sim *sim, const char *key, double value)
{
    return mps_model_set(sim, "body", key, value) < 0 ? failed(sim, key) : 0;
}

/* The column, the plate and the water on it; equilibrium is at displacement 0. */
static int build(mps_sim *sim, double dp)
{
    const double pi = acos(-1.0), water = 1000 * WIDTH * DEPTH;
    const double carried = water * (1 - dp / WIDTH);
    const double lo[2] = {0, BOTTOM}, hi[2] = {WIDTH, BOTTOM + THICK};
    const double from[2] = {0, BOTTOM + THICK + 0.5 * dp},
                 to[2] = {WIDTH, hi[1] + DEPTH + 0.1 * dp};
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = WIDTH;
    tank.size[1] = HEIGHT;
    if (mps_tank_add(sim, &tank, NULL) < 0) return failed(sim, "tank");
    if (mps_baffle_add(sim, "plate", lo, hi, NULL) < 0) return failed(sim, "plate");
    if (mps_fill_box_add(sim, 0, from, to, NULL, NULL) < 0) return failed(sim, "water");
    if (mps_model_register(sim, &body_spring) < 0 || mps_model_use(sim, "body.spring") < 0)
        return failed(sim, "model");
    return set(sim, "mass", MASS) || set(sim, "added_mass", water) ||
           set(sim, "stiffness", (MASS + water) * pow(2 * pi * FREQUENCY, 2)) ||
           set(sim, "force", 9.81 * carried) || choose_body(sim);
}

/* Recorded data: the last displacement, times of its upward zero crossings. */
typedef struct track {
    FILE *file; /* or NULL */
    double t, x, first, last, most;
    int64_t crossings, lost;
} track;

/* Displacement of the plate [m] and force of the water on it [N/m]. */
static int read_plate(mps_sim *sim, double *x, double *load)
{
    mps_lease member = {.struct_size = sizeof member}, motion = {.struct_size = sizeof motion};
    if (mps_lease_begin(sim, "spring_member", MPS_READ, &member) < 0 ||
        mps_lease_begin(sim, "spring_motion", MPS_READ, &motion) < 0)
        return failed(sim, "lease");
    for (int64_t i = 0; i < member.count; i++) {
        if (!(member.data[i] > 0.5)) continue;
        *x = motion.data[i * motion.stride];
        *load = motion.data[i * motion.stride + 3];
    }
    mps_lease_end(sim, &motion);
    mps_lease_end(sim, &member);
    return 0;
}

static int follow(void *user, mps_sim *sim, const mps_step_info *info)
{
    track *k = user;
    double x = 0, load = 0;
    if (read_plate(sim, &x, &load)) return 1;
    if (k->x < 0 && x >= 0) {
        k->last = k->t + (info->t - k->t) * k->x / (k->x - x);
        if (k->crossings++ == 0) k->first = k->last;
    }
    k->t = info->t;
    k->x = x;
    k->most = fmax(k->most, fabs(x));
    k->lost = info->lost;
    if (k->file) fprintf(k->file, "%.6f %.8f %.6g\n", info->t, x, load);
    return 0;
}

int main(int argc, char **argv)
{
    const double dp = argc > 1 ? atof(argv[1]) : 0.01;
    mps_config config;
    mps_sim *sim;
    track k = {.file = argc > 2 ? fopen(argv[2], "w") : NULL};
    mps_config_init(&config, sizeof config);
    config.dp = dp;
    config.log = tell;
    if (mps_sim_create(&config, &sim) < 0) return 1;
    int bad = build(sim, dp);
    if (!bad && mps_run(sim, UNTIL, follow, &k) < 0) bad = failed(sim, "run");
    if (k.file) fclose(k.file);
    mps_sim_destroy(sim);
    const double frequency = (double)(k.crossings - 1) / (k.last - k.first);
    const double water = 1000 * WIDTH * DEPTH,
                 carried = sqrt((MASS + water) / (MASS + water * (1 - dp / WIDTH)));
    printf("frequency %.4f Hz, exact %.4f Hz, off by %+.2f %%; with the water over the plate's "
           "particles, %.4f Hz, by %+.2f %%\n",
           frequency, FREQUENCY, 100 * (frequency / FREQUENCY - 1), carried * FREQUENCY,
           100 * (frequency / FREQUENCY / carried - 1));
    printf("largest displacement %.2f mm, lost %lld\n", 1000 * k.most, (long long)k.lost);
    bad |= k.lost != 0 || !(k.crossings >= 4 && fabs(frequency / FREQUENCY - 1) < 0.05);
    printf("%s\n", bad ? "FAILED" : "all hold");
    return bad;
}

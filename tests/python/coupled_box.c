/* SPDX-License-Identifier: BSD-3-Clause */
/* examples/python/coupled_box.py in C: it prints the same line. `speed` compares the times of both,
 * and of their steps. */
#include <math.h>
#include <mps/mps.h>
#include <stdio.h>
#include <stdlib.h>

enum { STEPS = 2100 };
static const double M = 50, DT = 2e-3; /* mass [kg/m], step [s] */

static void check(mps_sim *sim, mps_status status)
{
    if (status >= 0) return;
    fprintf(stderr, "%s\n", mps_sim_error(sim));
    exit(1);
}

static int below(void *user, const double *x)
{
    (void)user;
    return x[1] < 0.25 + 0.04 * (x[0] - 0.4);
}

static mps_sim *set_up(void)
{
    mps_config config;
    mps_tank tank;
    mps_time_control control;
    mps_sim *sim = NULL;
    mps_config_init(&config, sizeof config);
    mps_tank_init(&tank, sizeof tank);
    mps_time_control_init(&control, sizeof control);
    config.dp = 0.02;
    tank.size[0] = 0.8;
    tank.size[1] = 0.5;
    control.dt = DT;
    if (mps_sim_create(&config, &sim) != MPS_OK) exit(1);
    check(sim, mps_preset_use(sim, "imps"));
    check(sim, mps_tank_add(sim, &tank, NULL));
    check(sim, mps_fill_add(sim, 0, below, NULL, NULL));
    check(sim, mps_time_control_set(sim, &control));
    check(sim, mps_load_watch(sim, MPS_LOAD_MASS));
    return sim;
}

/* The state of the box: position, velocity, acceleration. */
typedef struct box {
    double x, v, a;
} box;

void box_step(mps_sim *sim, mps_snapshot *before, box *b);
void box_step(mps_sim *sim, mps_snapshot *before, box *b)
{
    mps_load load;
    mps_motion_state pose;
    mps_load_init(&load, sizeof load);
    mps_motion_state_init(&pose, sizeof pose);
    check(sim, mps_snapshot_take(before));
    for (int trial = 0; trial < 4; trial++) {
        double t;
        check(sim, mps_sim_time(sim, &t, NULL));
        pose.value[MPS_MOVE_X] = b->x + (b->v + b->a * DT) * DT;
        check(sim, mps_motion_pose_set(sim, t + DT, &pose));
        check(sim, mps_step(sim, DT, NULL));
        check(sim, mps_load_get(sim, NULL, &load));
        const double right = load.rest[0] / (M + load.mass[0]);
        if (fabs(right - b->a) < 1e-4) break;
        check(sim, mps_snapshot_restore(before));
        b->a = right;
    }
    b->v += b->a * DT;
    b->x += b->v * DT;
}

/* Mean frequency between the first and the last upward crossing of zero. */
static double frequency(const double *t, const double *velocity, int n)
{
    int first = 0, last = 0, count = 0;
    for (int k = 1; k < n; k++)
        if (velocity[k - 1] < 0 && velocity[k] >= 0) {
            if (count++ == 0) first = k;
            last = k;
        }
    return 2 * acos(-1.0) * (count - 1) / (t[last] - t[first]);
}

int main(void)
{
    static double t[STEPS], velocity[STEPS];
    double now = 0, most = 0;
    int n = 0;
    box b = {0};
    mps_snapshot *before = NULL;
    mps_momentum momentum;
    mps_sim *sim = set_up();
    mps_momentum_init(&momentum, sizeof momentum);
    check(sim, mps_snapshot_create(sim, &before));
    while (now < 4.0 && n < STEPS) {
        box_step(sim, before, &b);
        check(sim, mps_sim_time(sim, &now, NULL));
        t[n] = now;
        velocity[n++] = b.v;
        most = fmax(most, fabs(b.v));
    }
    check(sim, mps_momentum_get(sim, &momentum));
    printf(
        "%.3f rad/s, largest speed %.3f m/s, momentum of tank and particles %.3f kg m/s of %.2f\n",
        frequency(t, velocity, n), most, M * b.v + momentum.total[0], M * most);
    mps_snapshot_destroy(before);
    mps_sim_destroy(sim);
    return 0;
}

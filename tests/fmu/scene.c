/* SPDX-License-Identifier: BSD-3-Clause */
/* The motion of a tank of an FMU, and a plain simulation of the same case. */
#include "scene.h"
#include <stdio.h>

const char *folder;
const module *modules[MODULES], *solid;
double origin;

void pose_at(double t, double *q)
{
    const double w = 6.469, a = 0.02;
    t -= origin;
    memset(q, 0, INPUTS * sizeof *q);
    q[0] = a * (1 - cos(w * t));
    q[3] = a * w * sin(w * t);
    q[6] = a * w * w * cos(w * t);
    q[2] = 0.5 * 0.3 * t * t;
    q[5] = 0.3 * t;
    q[8] = 0.3;
}

void open_tank_at(tank *t, const module *m, double time)
{
    double q[INPUTS];
    if (!tank_open(t, m, NULL)) fail_msg("%s", t->text);
    pose_at(time, q);
    OK(t, tank_set(t, pose_refs, INPUTS, q));
}

void open_tank(tank *t, const module *m)
{
    open_tank_at(t, m, 0);
}

void move(tank *t, double time, double length, const double *q, double *load)
{
    OK(t, tank_set(t, pose_refs, INPUTS, q));
    OK(t, tank_step(t, time, length));
    OK(t, tank_get(t, load_refs, OUTPUTS, load));
}

double go(tank *t, double time, int steps, double *loads)
{
    for (int k = 0; k < steps; k++) {
        double q[INPUTS];
        pose_at(time + LENGTH, q);
        move(t, time, LENGTH, q, loads + k * OUTPUTS);
        time += LENGTH;
    }
    return time;
}

static int at_rest(void *user, double t, mps_motion_state *state)
{
    (void)t;
    *state = *(mps_motion_state *)user;
    return 0;
}

static void to_state(const double *q, mps_motion_state *s)
{
    static const int dof[3] = {MPS_MOVE_X, MPS_MOVE_Y, MPS_ROTATE_Z};
    mps_motion_state_init(s, sizeof *s);
    for (int d = 0; d < 3; d++) {
        s->value[dof[d]] = q[d];
        s->rate[dof[d]] = q[3 + d];
        s->accel[dof[d]] = q[6 + d];
    }
}

void plain_open(plain *p)
{
    char path[1100], place[1100], error[640] = "";
    double q[INPUTS];
    mps_job_config config;
    snprintf(path, sizeof path, "%s/3/resources/case.yaml", folder);
    snprintf(place, sizeof place, "%s/plain", folder);
    assert_int_equal(mps_case_read(path, 0, NULL, &p->c), MPS_OK);
    mps_job_config_init(&config, sizeof config);
    config.folder = place;
    config.quiet = 1;
    config.error = error;
    config.error_size = sizeof error;
    assert_int_equal(mps_case_job(p->c, &config, &p->job, &p->sim), MPS_OK);
    assert_int_equal(mps_load_watch(p->sim, MPS_LOAD_MASS), MPS_OK);
    pose_at(0, q);
    to_state(q, &p->hold);
    assert_int_equal(mps_motion_callback_set(p->sim, at_rest, &p->hold), MPS_OK);
}

void plain_close(plain *p)
{
    mps_sim_destroy(p->sim);
    mps_job_destroy(p->job);
    mps_case_destroy(p->c);
}

static int add(void *user, mps_sim *sim, const mps_step_info *info)
{
    plain *p = user;
    mps_load load;
    mps_load_init(&load, sizeof load);
    assert_int_equal(mps_load_get(sim, NULL, &load), MPS_OK);
    assert_int_equal(load.has_mass, 1);
    const double all[OUTPUTS] = {load.force[0], load.force[1], load.force[5],
                                 load.rest[0],  load.rest[1],  load.rest[5]};
    for (int i = 0; i < OUTPUTS; i++) p->sum[i] += info->dt * all[i];
    p->length += info->dt;
    return 0;
}

void plain_move(plain *p, double time, double *load)
{
    double q[INPUTS];
    mps_motion_state s;
    pose_at(time, q);
    to_state(q, &s);
    memset(p->sum, 0, sizeof p->sum);
    p->length = 0;
    assert_int_equal(mps_motion_pose_set(p->sim, time, &s), MPS_OK);
    assert_int_equal(mps_run(p->sim, time, add, p), MPS_OK);
    for (int i = 0; i < OUTPUTS; i++) load[i] = p->sum[i] / p->length;
}

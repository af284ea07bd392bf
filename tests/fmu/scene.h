/* SPDX-License-Identifier: BSD-3-Clause */
/* Common code of the tests of FMUs: the motion of a tank, its steps, and a plain simulation of the
 * same case. */
#ifndef TESTS_FMU_SCENE_H
#define TESTS_FMU_SCENE_H

#include "importer.h"
#include <setjmp.h> /* cmocka.h needs these before it */
#include <stdarg.h>
#include <math.h>
#include <mps/mps.h>
#include <mps/case.h>
#include <mps/couple.h>
#include <string.h>

#include <cmocka.h>

enum { STEPS = 12, MODULES = 2 };
static const double LENGTH = 2e-3; /* of a step; the case has the same */

extern const char *folder;
extern const module *modules[MODULES], *solid; /* solid: in 3-D */
extern double origin;                          /* begin of the motion */

#define OK(TANK, CALL)                                             \
    do {                                                           \
        const int status_ = (CALL);                                \
        if (status_ != 0) fail_msg("%s: %s", #CALL, (TANK)->text); \
    } while (0)

/* Surge and a slow rotation from rest. */
void pose_at(double t, double *q);
void open_tank_at(tank *t, const module *m, double time);
void open_tank(tank *t, const module *m);
/* To a pose, by a step. */
void move(tank *t, double time, double length, const double *q, double *load);
/* So many steps of the motion from `time`; loads[steps][OUTPUTS]. @return time reached */
double go(tank *t, double time, int steps, double *loads);

/* A simulation of the same case, by the library. */
typedef struct plain {
    mps_case *c;
    mps_job *job;
    mps_sim *sim;
    mps_motion_state hold;
    double sum[OUTPUTS], length; /* over the steps of a run */
} plain;

void plain_open(plain *p);
void plain_close(plain *p);
/* To the pose at `time`; mean loads. */
void plain_move(plain *p, double time, double *load);

/* Tests of sensors, test_sensors.c. */
void sensors(void **state);

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* Forced oscillations of a tank: evaluates the loads of a run. */
#ifndef MPS_APPS_FORCED_H
#define MPS_APPS_FORCED_H

#include "series.h"

enum { FORCED_DEGREES = 6 };

/* "surge" ... "yaw". */
extern const char *const forced_names[FORCED_DEGREES];

/* Index of a degree of freedom by its name; -1: none. */
int32_t forced_degree(const char *name, size_t length);

/* Loads of a motion in one degree of freedom: F = -A a - B v - C x. nan: the run has no such
 * load. */
typedef struct forced {
    double omega;   /* [rad/s]; nan: no result */
    double T1;      /* [s]; nan: not known */
    double periods; /* measured */
    bool parted;    /* the free wave of period T1 was separated from the forced one */
    double A[FORCED_DEGREES], B[FORCED_DEGREES], walls[FORCED_DEGREES];
    double A_band[FORCED_DEGREES], B_band[FORCED_DEGREES];
} forced;

/* A without C, B and bands of a finished run.
 * @param degree  that moves
 * @param periods  at the end of the run
 * @return false: there is a message */
bool forced_read(const choices *c, const char *folder, int32_t degree, double periods, forced *f);

/* Mean loads per angle between two intervals of a run that tilts the tank: C = -change of the
 * load/angle. By pressures of walls, which are exact at rest; the weight from the momentum has an
 * error of half a particle at the surface.
 * @param from, until  [2] of each interval [s]
 * @return false: there is a message */
bool forced_tilt_read(const choices *c, const char *folder, const double *from, const double *until,
                      double angle, double C[FORCED_DEGREES]);

#endif

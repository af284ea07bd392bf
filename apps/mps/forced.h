/* SPDX-License-Identifier: BSD-3-Clause */
/* Forced oscillations of a tank: what the loads of a run amount to. */
#ifndef MPS_APPS_FORCED_H
#define MPS_APPS_FORCED_H

#include "series.h"

enum { FORCED_DEGREES = 6 };

/* "surge" ... "yaw". */
extern const char *const forced_names[FORCED_DEGREES];

/* Number of a degree by its name; -1: none. */
int32_t forced_degree(const char *name, size_t length);

/* Loads of a motion in one degree: F = -A a - B v - C x. nan: the run has no such load. */
typedef struct forced {
    double omega;   /* [rad/s]; nan: there is no result */
    double T1;      /* [s]; nan: not known */
    double periods; /* that are measured */
    bool parted;    /* the free wave of period T1 was told from the forced one */
    double A[FORCED_DEGREES], B[FORCED_DEGREES], walls[FORCED_DEGREES];
    double A_band[FORCED_DEGREES], B_band[FORCED_DEGREES];
} forced;

/* A without C, B and bands of a run that is done.
 * @param degree  that moves @param periods  at the end of the run @return false: there is a message */
bool forced_read(const choices *c, const char *folder, int32_t degree, double periods, forced *f);

/* Mean loads per angle between two stretches of a run that tilts the tank: C = -change of the load/angle. By pressures of walls: at rest they
 * are exact, while the momentum's weight knows the surface to half a particle.
 * @param from, until  [2] of each stretch [s] @return false: there is a message */
bool forced_tilt_read(const choices *c, const char *folder, const double *from, const double *until,
                      double angle, double C[FORCED_DEGREES]);

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* The built-in motions: data for an mps_motion_fn, made with the handle's allocator. */
#ifndef MPS_BC_BUILTIN_MOTION_H
#define MPS_BC_BUILTIN_MOTION_H

#include <mps/motion.h>

/* Sum of harmonics. Arguments are good; NULL when memory is out. */
void *mps__motion_harmonic_create(const mps_allocator *allocator, int32_t count,
                                  const mps_harmonic *harmonics);
/* user: what create gave */
int mps__motion_harmonic(void *user, double t, mps_motion_state *state);

/* Natural cubic splines through a table, arguments as mps_motion_table_set(). */
void *mps__motion_table_create(const mps_allocator *allocator, int64_t rows, const double *t,
                               int32_t dofs, const int32_t *dof, const double *values);
int mps__motion_table(void *user, double t, mps_motion_state *state);

/* The way between two poses; user: a mps__posed. */
int mps__motion_posed(void *user, double t, mps_motion_state *state);

/* The longest step from t that misses nothing of the motion, of steps up to dt [s]. Harmonics: a
 * twentieth of the shortest period or ramp. Tables: up to the first row that shows what a harmonic does in
 * more than that, but at least an interval of rows. */
double mps__motion_harmonic_longest(const void *user, double t, double dt);
double mps__motion_table_longest(const void *user, double t, double dt);

#endif

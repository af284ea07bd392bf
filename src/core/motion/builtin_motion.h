/* SPDX-License-Identifier: BSD-3-Clause */
/* The built-in motions: data for an mps_motion_fn, made with the handle's allocator. */
#ifndef MPS_BC_BUILTIN_MOTION_H
#define MPS_BC_BUILTIN_MOTION_H

#include <mps/motion.h>

/* Sum of harmonics, from valid arguments. NULL: out of memory. */
void *mps__motion_harmonic_create(const mps_allocator *allocator, int32_t count,
                                  const mps_harmonic *harmonics);
/* user: the result of mps__motion_harmonic_create() */
int mps__motion_harmonic(void *user, double t, mps_motion_state *state);

/* Natural cubic splines through a table, arguments as mps_motion_table_set(). */
void *mps__motion_table_create(const mps_allocator *allocator, int64_t rows, const double *t,
                               int32_t dofs, const int32_t *dof, const double *values);
int mps__motion_table(void *user, double t, mps_motion_state *state);

/* Interpolation between two poses; user: a mps__posed. */
int mps__motion_posed(void *user, double t, mps_motion_state *state);

/* Longest step from t, at most dt, that resolves the motion [s]. Harmonics: a twentieth of the
 * shortest period or ramp. Tables: up to the first row whose deviation from a line exceeds that of
 * a harmonic in this time, but at least one interval of rows. */
double mps__motion_harmonic_longest(const void *user, double t, double dt);
double mps__motion_table_longest(const void *user, double t, double dt);

#endif

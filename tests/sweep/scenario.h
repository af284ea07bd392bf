/* SPDX-License-Identifier: BSD-3-Clause */
/* A sloshing tank drawn at random from one number, the same on every machine. */
#ifndef MPS_SWEEP_SCENARIO_H
#define MPS_SWEEP_SCENARIO_H

#include <mps/mps.h>
#include <stdio.h>

enum { SCENARIO_HARMONICS = 3 * MPS_DOF_COUNT };

/* Obstacles in the tank. */
enum { OBSTACLE_NONE, OBSTACLE_BAFFLE, OBSTACLE_PLATE };

typedef struct scenario {
    uint64_t seed;
    int32_t dim, open_top, start, harmonics, obstacle;
    double size[3], depth, dp; /* [m] */
    double gravity[3];         /* [m/s2] */
    double centre[3];          /* of rotation [m] */
    mps_harmonic harmonic[SCENARIO_HARMONICS];
    double lo[3], hi[3]; /* a baffle's corners; a plate's corner and edge [m] */
} scenario;

/* Draw everything. @param dim 2 or 3; 0: drawn too */
void scenario_draw(scenario *s, uint64_t seed, int32_t dim);
/* Build it. @param sim out: the handle, NULL if not even that could be made @param built [3] out:
 * the tank [m] */
mps_status scenario_build(const scenario *s, const char *model, mps_sim **sim, double *built);
/* Print it as key=value without an end of line. */
void scenario_print(const scenario *s, FILE *out);

#endif

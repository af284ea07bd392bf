/* SPDX-License-Identifier: BSD-3-Clause */
/* Motions of the tank in a ship's words: harmonics, spectra, tables. */
#ifndef MPS_CASE_MOTION_H
#define MPS_CASE_MOTION_H

#include "build.h"

enum { MOTION_DEGREES = 6, MOTION_HARMONICS = 6000 };

/* mps_harmonic.form of a constant acceleration from rest, a t^2/2; not the library's. */
enum { MOTION_PUSH = 2 };

/* One harmonic of a degree of the ship, MPS_SHIP_SURGE .. MPS_SHIP_YAW, in mps_harmonic.dof. */
typedef struct build_motion {
    const char *of; /* key, for messages */
    bool load;      /* forces and moments in place of shifts and turns */
    bool used[MOTION_DEGREES];
    int32_t count; /* harmonics */
    mps_harmonic *harmonic;
    mps_ship ship;
    /* axes of the library, y up and z to starboard: sway and pitch have the other sign of MPS_SHIP_Z_UP */
    bool flipped;
    bool has_forward; /* `forward` is given */
    int32_t dim;
    int64_t rows;       /* of a table; 0: harmonics */
    double *t, *column; /* [rows], [rows*6] m and rad, with `from` and `ramp` in them */
    char file[BUILD_TEXT], unused[BUILD_TEXT]; /* the file; names of columns that are not used */
    double step_least, step_most;              /* between rows [s] */
    double largest[MOTION_DEGREES][3];         /* value, rate, acceleration over the run [m, rad] */
    double dt_max;                             /* 0: the library limits the steps itself */
    double centre[3];
} build_motion;

/* Word of each degree: "surge" ... */
extern const char *const mps__degrees[MOTION_DEGREES];

/* Centre and axes of the ship. */
void mps__ship_read(build *b, build_motion *m, const tree_node *map);
/* Harmonics of one degree: a map, or a list of maps. */
void mps__harmonics_read(build *b, build_motion *m, const tree_node *node, int32_t degree);
/* Of all harmonics and ramps [s]; infinite without any. */
double mps__shortest_period(const build_motion *m);
/* Add the harmonics of a spectrum of JONSWAP. */
bool mps__spectrum_add(build *b, build_motion *m, const tree_node *node, mps_harmonic like);
/* Value, rate and acceleration of one degree at a time. */
void mps__harmonics_at(const build_motion *m, int32_t degree, double t, double out[3]);
/* The table of `motion.file`. */
bool mps__motion_file(build *b, build_motion *m, const tree_node *map);
/* Degree of the lab and sign of a degree of the ship; where axes are parallel. */
void mps__degree_to_lab(const build_motion *m, int32_t degree, int32_t *dof, double *sign);

/* Refuse a degree that has no effect in 2-D. The degrees before it are known in m->used. @param at  where it is given */
void mps__degree_check(build *b, const build_motion *m, const tree_node *at, int32_t degree);

#endif

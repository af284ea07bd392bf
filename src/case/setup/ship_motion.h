/* SPDX-License-Identifier: BSD-3-Clause */
/* Motions of the tank in the terms of a ship: harmonics, spectra, tables. */
#ifndef MPS_CASE_MOTION_H
#define MPS_CASE_MOTION_H

#include "build.h"

enum { MOTION_DEGREES = 6, MOTION_HARMONICS = 6000 };

/* mps_harmonic.form of a constant acceleration from rest, a t^2/2; not one of the library. */
enum { MOTION_PUSH = 2 };

/* Changes by the filter in a degree of freedom: mean square and largest difference of rows; largest
 * acceleration before [m, rad]. */
typedef struct motion_filtered {
    double rms, most, accel;
} motion_filtered;

/* Harmonics of degrees of freedom of the ship, MPS_SHIP_SURGE .. MPS_SHIP_YAW, in mps_harmonic.dof,
 * or a table. */
typedef struct build_motion {
    const char *of; /* key, for messages */
    bool load;      /* forces and moments instead of translations and rotations */
    bool used[MOTION_DEGREES];
    int32_t count; /* harmonics */
    mps_harmonic *harmonic;
    mps_ship ship;
    /* axes of the library, y up and z to starboard: sway and pitch have the opposite sign of
     * MPS_SHIP_Z_UP */
    bool flipped;
    bool has_forward; /* `forward` is given */
    int32_t dim;
    int64_t rows;       /* of a table; 0: harmonics */
    double *t, *column; /* [rows], [rows*6] m and rad, with `from` and `ramp` applied */
    char file[BUILD_TEXT], unused[BUILD_TEXT]; /* the file; names of unused columns */
    double step_least, step_most;              /* between rows [s] */
    double from, ramp; /* time of the file at t = 0; duration of the ramp [s] */
    double cutoff;     /* of the filter of the file [Hz]; 0: none */
    motion_filtered change[MOTION_DEGREES];
    double largest[MOTION_DEGREES][3]; /* value, rate, acceleration over the run [m, rad] */
    /* Least and largest rate over the run; with `start: rest` including 0, that of the liquid
     * [m/s] */
    double rate[MOTION_DEGREES][2];
    const char *plugin; /* name of the motion of a plug-in; NULL: none */
    double dt_max;      /* 0: the library limits the steps itself */
    double centre[3];
    int32_t start; /* MPS_START_... */
    bool noisy;    /* the accelerations of the file are dominated by noise */
} build_motion;

/* The start of a motion. */
typedef struct motion_begin {
    /* jump of the tank [m/s]; pressure if liquid at rest follows it in a step [Pa], [s] */
    double speed, jump, step;
    double accel, push; /* soon after t = 0 [m/s2]; pressure due to it [Pa] */
    double tilt, rise;  /* of the tank [rad]; of its walls above the level [m] */
} motion_begin;

/* Name of each degree of freedom: "surge" ... */
extern const char *const mps__degrees[MOTION_DEGREES];

/* Centre and axes of the ship. */
void mps__ship_read(build *b, build_motion *m, const tree_node *map);
/* Harmonics of one degree of freedom: a map, or a list of maps. */
void mps__harmonics_read(build *b, build_motion *m, const tree_node *node, int32_t degree);
/* Of all harmonics and ramps [s]; infinite without any. */
double mps__shortest_period(const build_motion *m);
/* Add the harmonics of a JONSWAP spectrum. */
bool mps__spectrum_add(build *b, build_motion *m, const tree_node *node, mps_harmonic like);
/* Value, rate and acceleration of one degree of freedom at a time. */
void mps__harmonics_at(const build_motion *m, int32_t degree, double t, double out[3]);
/* The table of `motion.file`. */
bool mps__motion_file(build *b, build_motion *m, const tree_node *map);
/* Whether each degree of freedom of the ship is one of the lab, up to its sign. */
bool mps__motion_parallel(const build_motion *m);
/* Value, rate and acceleration of all degrees of freedom of the ship, for the tank at t; angles as
 * in the case, not modulo a full rotation. */
void mps__motion_degrees(const build_motion *m, const mps_motion_state *tank, double t,
                         double out[MOTION_DEGREES][3]);
/* The table at a time, by linear interpolation; constant before its first row and after its
 * last. */
double mps__motion_table_at(const build_motion *m, int32_t degree, double t);
/* Largest value, rate and acceleration of the motion over the run. */
void mps__motion_measure(build *b, build_motion *m, const tree_node *map);
/* Warn of a table that begins with a jump, and of steps and noise that its spline turns into large
 * accelerations. */
void mps__motion_diagnose(build *b, build_motion *m, const tree_node *map);
/* Second derivatives at the rows [rows] of the natural cubic spline through a degree of freedom of
 * the table; with a cut-off [Hz] through `smooth` [rows]: the rows after a low-pass filter. false:
 * memory is exhausted */
bool mps__motion_spline(build *b, const build_motion *m, int32_t degree, double cutoff,
                        double *second, double *smooth);
/* Largest distance of the tank's box from the centre [m]. */
double mps__motion_reach(const build *b, const build_motion *m);
/* @return false: the motion is not known */
bool mps__motion_begin(build *b, motion_begin *s);
/* The filter of `motion.cutoff`. */
bool mps__motion_filter(build *b, build_motion *m, const tree_node *map);
/* Degree of freedom of the lab and sign of one of the ship; for parallel axes. */
void mps__degree_to_lab(const build_motion *m, int32_t degree, int32_t *dof, double *sign);

/* Refuse a degree of freedom that has no effect in 2-D. Those before it are set in m->used.
 * @param at  where it is given */
void mps__degree_check(build *b, const build_motion *m, const tree_node *at, int32_t degree);

#endif

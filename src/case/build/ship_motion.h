/* SPDX-License-Identifier: BSD-3-Clause */
/* Motions of the tank in a ship's words: harmonics, spectra, tables. */
#ifndef MPS_CASE_MOTION_H
#define MPS_CASE_MOTION_H

#include "build.h"

enum { MOTION_DEGREES = 6, MOTION_HARMONICS = 6000 };

/* mps_harmonic.form of a constant acceleration from rest, a t^2/2; not the library's. */
enum { MOTION_PUSH = 2 };

/* What the filter has changed in a degree: mean square and largest difference of rows; largest
 * acceleration before [m, rad]. */
typedef struct motion_filtered {
    double rms, most, accel;
} motion_filtered;

/* One harmonic of a degree of the ship, MPS_SHIP_SURGE .. MPS_SHIP_YAW, in mps_harmonic.dof. */
typedef struct build_motion {
    const char *of; /* key, for messages */
    bool load;      /* forces and moments in place of shifts and turns */
    bool used[MOTION_DEGREES];
    int32_t count; /* harmonics */
    mps_harmonic *harmonic;
    mps_ship ship;
    /* axes of the library, y up and z to starboard: sway and pitch have the other sign of
     * MPS_SHIP_Z_UP */
    bool flipped;
    bool has_forward; /* `forward` is given */
    int32_t dim;
    int64_t rows;       /* of a table; 0: harmonics */
    double *t, *column; /* [rows], [rows*6] m and rad, with `from` and `ramp` in them */
    char file[BUILD_TEXT], unused[BUILD_TEXT]; /* the file; names of columns that are not used */
    double step_least, step_most;              /* between rows [s] */
    double from, ramp; /* time of the file at t = 0; over which the motion grows [s] */
    double cutoff;     /* of the filter of the file [Hz]; 0: none */
    motion_filtered change[MOTION_DEGREES];
    double largest[MOTION_DEGREES][3]; /* value, rate, acceleration over the run [m, rad] */
    /* Least and largest rate over the run; of `start: rest` with 0, that of the liquid [m/s] */
    double rate[MOTION_DEGREES][2];
    const char *plugin; /* name of the motion of a plug-in; NULL: none */
    double dt_max;      /* 0: the library limits the steps itself */
    double centre[3];
    int32_t start; /* MPS_START_... */
    bool noisy;    /* accelerations of the file are those of noise */
} build_motion;

/* How a motion begins. */
typedef struct motion_begin {
    double speed, jump,
        step; /* of the tank [m/s]; pressure if liquid at rest takes it in a step [Pa], [s] */
    double accel, push; /* soon after t = 0 [m/s2]; pressure that it makes [Pa] */
    double tilt, rise;  /* of the tank [rad]; of its walls over the level [m] */
} motion_begin;

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
/* Whether each degree of the ship is one of the lab, but for its sign. */
bool mps__motion_parallel(const build_motion *m);
/* Value, rate and acceleration of all degrees of the ship, of the tank as it is at t; angles as
 * in the case, not within half a turn. */
void mps__motion_degrees(const build_motion *m, const mps_motion_state *tank, double t,
                         double out[MOTION_DEGREES][3]);
/* Of the table at a time, linear; before its first row and behind its last as there. */
double mps__motion_table_at(const build_motion *m, int32_t degree, double t);
/* Largest value, rate and acceleration of the motion that the run has, in its interval. */
void mps__motion_measure(build *b, build_motion *m, const tree_node *map);
/* Warn of a table that begins with a jump; of steps and noise that its spline makes large
 * accelerations of. */
void mps__motion_diagnose(build *b, build_motion *m, const tree_node *map);
/* Second derivatives at the rows [rows] of the natural cubic spline through a degree of the
 * table; with a cut-off [Hz] through `smooth` [rows]: the rows after a low-pass filter. false:
 * no memory */
bool mps__motion_spline(build *b, const build_motion *m, int32_t degree, double cutoff,
                        double *second, double *smooth);
/* Largest distance of the tank's box from the centre [m]. */
double mps__motion_reach(const build *b, const build_motion *m);
/* false: the motion is not known. */
bool mps__motion_begin(build *b, motion_begin *s);
/* The filter of `motion.cutoff`. */
bool mps__motion_filter(build *b, build_motion *m, const tree_node *map);
/* Degree of the lab and sign of a degree of the ship; where axes are parallel. */
void mps__degree_to_lab(const build_motion *m, int32_t degree, int32_t *dof, double *sign);

/* Refuse a degree that has no effect in 2-D. The degrees before it are known in m->used. @param
 * at  where it is given */
void mps__degree_check(build *b, const build_motion *m, const tree_node *at, int32_t degree);

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* Cases of liquid impacts on walls with known pressures, impulses or forces. */
#ifndef MPS_EXAMPLES_IMPACT_H
#define MPS_EXAMPLES_IMPACT_H

#include "driver/driver.h"

typedef struct impact {
    driver d;
    double density, speed; /* of the liquid [kg/m3], of impact [m/s] */
    /* time at which the foremost row is one spacing from the wall: half cells of liquid and wall
     * meet [s] */
    double contact;
    double deadrise; /* of the wedge [degrees] */
    double block;    /* half width and depth of the liquid block [m] */
    int32_t layers;  /* rows of the film, of the toe */
    int32_t tip;     /* shape of the toe's tip */
    double shift;    /* offset of its middle from that of the rows [dp] */
} impact;

/* One case. `set` completes the options before the job is created, `build` adds particles, columns
 * and figures. */
typedef struct impact_case {
    void (*set)(impact *c, driver *d);
    void (*build)(impact *c);
    double dp;     /* default spacing [m] */
    bool in_space; /* also in 3-D */
} impact_case;

extern const impact_case impact_flat, impact_film, impact_wedge, impact_jet, impact_column,
    impact_floor, impact_box, impact_toe;

/* In spacings: initial distance of the foremost row from the wall; width of a slice in 3-D. */
enum { IMPACT_GAP = 6, IMPACT_SLICE = 6 };

/* No gravity: the velocity scale is that of the flow instead. */
void impact_weightless(impact *c, driver *d);
/* Water without viscosity: walls have free slip. */
void impact_water(impact *c);
/* Walls of a box from the origin; in 3-D the third size is a multiple of the spacing too. */
void impact_walls(impact *c, const double *size, bool open);
/* Fill the lattice points of columns and rows first..last, counted from the origin in spacings; in
 * 3-D over the whole width. */
void impact_fill(impact *c, const int *columns, const int *rows);
/* Give all fluid a velocity. */
void impact_start(impact *c, double u, double v);
/* Width of the walls of a slice, and of its liquid particles [m]; 1 and 1 in 2-D. */
double impact_width(const impact *c);
double impact_fluid_width(const impact *c);

/* A figure of summary.json, see mps_trace: `kind` of a column between two times, means over
 * `window`, divided by `scale`. */
typedef struct impact_span {
    double from, to, window;
} impact_span;
void impact_figure(impact *c, const char *name, int32_t kind, const char *column, impact_span span,
                   double scale);
/* A reference value of the figures, with its description. */
void impact_told(impact *c, const char *name, const char *about, double value);
void impact_given(impact *c, const char *name, double value);

#endif

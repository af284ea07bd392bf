/* SPDX-License-Identifier: BSD-3-Clause */
/* Builds the simulation from the tree of a case. Each part of the case has its file; build.c calls
 * them in the order of the drivers in C, so that a case and a driver of the same tank give the same
 * bytes. */
#ifndef MPS_CASE_BUILD_H
#define MPS_CASE_BUILD_H

#include "read.h"
#include "form.h"
#include <mps/case.h>
#include <mps/job.h>
#include <mps/mps.h>
#include <stdbool.h>

enum {
    BUILD_FLUIDS = 16,
    BUILD_SENSORS = 256,
    BUILD_SOLIDS = 64,
    BUILD_PIECES = 64,
    BUILD_MODES = 6,
    BUILD_NOTES = 40,
    BUILD_TEXT = 240,
    BUILD_NAME = 32
};

/* A liquid or gas of the case. */
typedef struct build_fluid {
    char name[BUILD_NAME];
    double density, viscosity, tension; /* tension NAN: not given */
    const tree_node *at;                /* first fill of this fluid */
} build_fluid;

/* The tank: a shape, or a file. Its box is as requested. */
typedef struct build_tank {
    form form;
    bool file;
    int32_t open;    /* word of tank.open; 0: closed */
    double size[3];  /* rectangular: as requested */
    double built[3]; /* rectangular: size after rounding to the lattice */
    const tree_node *at;
} build_tank;

/* A solid in the tank, for the sketch: corners of a plate or box as built, outline of a prism, or a
 * shape. */
typedef struct build_solid {
    char name[BUILD_NAME];
    form form;
    bool plate, file, box;
    double asked[2][3];  /* opposite corners of a box or plate */
    double end[2][3];    /* of the first side of a plate, as built */
    double second[2][3]; /* from the first side to both ends of the second side, as built */
    const char *why;     /* why the solid differs as built; NULL: it does not */
    int32_t slots;       /* of a plate */
    double pitch, gap;   /* of the slots, along the first side, as requested [m] */
    int32_t pieces;      /* number of known pieces */
    double piece[BUILD_PIECES][2]; /* parts between slots as built: fractions of the first side */
} build_solid;

typedef enum sensor_kind {
    SENSOR_WALL,
    SENSOR_FLUID,
    SENSOR_GAUGE,
    SENSOR_FORCE,
    SENSOR_MEASURE,
    SENSOR_VALUE /* of several probes, or in other axes */
} sensor_kind;

/* A column, for the sketch and the check. */
typedef struct build_sensor {
    char name[BUILD_NAME];
    sensor_kind kind;
    double at[3], normal[3], diameter;
    int32_t component; /* component of a force; moments follow the forces */
    int32_t further;   /* columns between this one and the next: cells of the same panel */
    char part[BUILD_NAME];
    char about[BUILD_TEXT]; /* SENSOR_VALUE */
} build_sensor;

/* A solid in the free surface, along the axis of the waves [m]. */
typedef struct build_block {
    int32_t solid;
    bool across; /* it spans the whole width of the tank */
    double lo, hi;
} build_block;

/* Natural periods of the liquid at rest, in the tank without its solids. */
typedef struct build_modes {
    int32_t count, axis; /* 0: waves along x, 2: along z */
    double period[BUILD_MODES];
    double length, depth; /* of the free surface, of the liquid [m] */
    char how[BUILD_TEXT];
    int32_t blocks;
    build_block block[BUILD_SOLIDS]; /* in the order of `lo` */
    double open;                     /* longest part of the surface between spanning solids [m] */
} build_modes;

/* Log messages of the library, kept until there is a job. In the memory of the case: the simulation
 * keeps its address. */
typedef struct build_log {
    mps_job *job;
    int32_t count, further; /* number kept; number only counted */
    int level[BUILD_NOTES];
    char text[BUILD_NOTES][2 * BUILD_TEXT];
} build_log;

/* A column of probes.csv, in the memory of the case; also of a case that is only checked. */
typedef struct build_column {
    char name[BUILD_NAME], unit[16];
    struct build_column *next;
} build_column;

typedef struct build {
    mps_case *c;
    const tree_node *root;
    mps_sim *sim;
    mps_job *job; /* NULL: the case is only checked */
    mps_status status;
    int32_t dim;
    double dp, gravity;
    char model[64];
    bool several, paper; /* several phases; the models as published in the papers */
    int32_t fluids, solids, sensors;
    int32_t unlisted;                /* columns that exceed `sensor` */
    build_column *column;            /* the last one first */
    build_fluid fluid[BUILD_FLUIDS]; /* by phase: in order of falling density */
    build_tank tank;
    build_solid solid[BUILD_SOLIDS];
    build_sensor sensor[BUILD_SENSORS];
    build_modes modes;
    build_log *log;
    double level; /* still level as filled [m]; NAN: none requested */
    double depth; /* requested [m]; NAN: none */
    double until;
    int32_t frames;        /* besides the first */
    double scale;          /* run.velocity_scale [m/s]; 0: default of the library */
    mps_time_control time; /* with run.step_factor */
    /* NULL: none; for a body: centre, axes and free degrees of freedom */
    const struct build_motion *motion;
    const struct build_body *body; /* NULL: none */
} build;

/* Whether a call of the library succeeded; otherwise its error text becomes a message at the line
 * of `at`. */
bool mps__build_try(build *b, mps_status status, const tree_node *at, const char *what);
/* mps__build_try() for a call of the job. */
bool mps__build_try_job(build *b, mps_status status, const tree_node *at, const char *what);
/* Memory that is freed with the case; NULL after a message. */
void *mps__build_alloc(build *b, size_t size);

/* Build all but the columns. The case has messages where a value was refused, or status is
 * negative; the caller owns the simulation. */
void mps__build_simulation(build *b, const mps_job_config *options);

/* Whether a continued run has the case that it began with, except for changes that are allowed.
 * @return MPS_E_STATE, MPS_E_ARG: text in options->error */
mps_status mps__build_resumed(const mps_case *c, const mps_job_config *options);

/* In the order of calls. Each returns immediately if there are errors. */
void mps__build_fluids_read(build *b);
void mps__build_open(build *b, const mps_job_config *options);
void mps__build_tank(build *b);
void mps__build_solids(build *b);
void mps__build_phases(build *b);
void mps__build_fills(build *b);
void mps__build_modes(build *b);
/* Period of half a wave over `length`, in liquid of the modes' depth [s]. */
double mps__modes_period(const build *b, double length);
/* What the periods neglect, after "; ", or "". */
const char *mps__modes_without(const build *b);
/* Find solids that pierce the free surface. */
void mps__build_blocks(build *b);
/* Whether a position is half a spacing or more behind walls that are none of a thin plate: outside
 * of the tank, or inside a solid.
 * @param part  out: the part of these walls */
bool mps__wall_behind(build *b, const double *x, int32_t *part);
void mps__build_motion(build *b);
void mps__build_body(build *b);
/* Add columns of the motion, prescribed or of the body, and of what drives the body. */
void mps__motion_columns(build *b);
void mps__body_columns(build *b);
/* Record a column that the job has, or that a case which is only checked would have. */
void mps__build_column(build *b, const char *name, const char *unit);
void mps__build_time(build *b);
/* Warn of a motion that begins with a jump or a tilt, once steps are known. */
void mps__motion_start(build *b);
void mps__build_sensors(build *b);
/* Level of the liquid at rest [m]: as filled to a depth, or its highest particle. */
double mps__still_level(build *b);
void mps__build_references(build *b);
void mps__build_inputs(build *b);
/* Angular frequency of the motion [rad/s]; NAN: not periodic. */
double mps__build_omega(const build *b);

bool mps__build_filled(const build *b);
/* A summary of the case, and a drawing of tank and sensors as SVG; the caller frees it, NULL:
 * memory is exhausted. The check computes a few steps. */
char *mps__check_write(build *b);
char *mps__sketch_write(build *b);

/* Points of a list, or one point; z is `z` where two numbers are given. @return number of points */
int32_t mps__build_points(build *b, const tree_node *node, double z, int32_t most,
                          double (*out)[3]);
/* The outline of a form: a simple polygon. Errors are reported at the line of the side. */
void mps__build_polygon(build *b, const tree_node *node, form *s);
/* Find a fluid by its name; -1 after a message. */
int32_t mps__build_phase(build *b, const tree_node *at, const char *name);
/* Rotate a file whose vertical axis is this one; angles for mps_stl.rotation. */
bool mps__build_stl(build *b, const tree_node *map, mps_stl *stl);
/* Add the edges of a tank in 3-D to the job. */
void mps__build_edges(build *b);
/* Part i of a plate, between two slots, as fractions of its first side: as built, where that is
 * known. */
void mps__solid_piece(const build_solid *s, int32_t i, double part[2]);
/* Which of these keys a map has. The reader guarantees exactly one. */
int mps__build_kind(const tree_node *map, const char *const *kind, int count);
/* Centre of the tank's box along z; 0 in 2-D. */
double mps__build_middle(const build *b);

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* From the tree of a case to its simulation. Each part of the case has its file; build.c calls them in the order of the drivers in C, so that
 * a case and a driver of the same tank give the same bytes. */
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
    const tree_node *at;                /* where it is filled in first */
} build_fluid;

/* The tank: a shape, or a file. Its box is as asked. */
typedef struct build_tank {
    form form;
    bool file;
    int32_t open;    /* word of tank.open; 0: closed */
    double size[3];  /* rectangular: as asked */
    double built[3]; /* rectangular: size after rounding to the lattice */
    const tree_node *at;
} build_tank;

/* A solid in the tank, for the sketch: corners of a plate or box as built, outline of a prism, or a shape. */
typedef struct build_solid {
    char name[BUILD_NAME];
    form form;
    bool plate, file, box;
    double asked[2][3];            /* corners of a box, ends of the first side of a plate */
    double end[2][3];              /* of the first side of a plate, as built */
    const char *why;               /* the reason why what is built differs; NULL: it does not */
    int32_t slots;                 /* of a plate */
    double pitch, gap;             /* of them, along its first side, as asked [m] */
    int32_t pieces;                /* that are known */
    double piece[BUILD_PIECES][2]; /* parts between slots as built: shares of the first side */
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
    int32_t component; /* of a force: behind the forces are its moments */
    int32_t further;   /* columns between this one and the next, cells of the same panel */
    char part[BUILD_NAME];
    char about[BUILD_TEXT]; /* SENSOR_VALUE */
} build_sensor;

/* A solid in the free surface, along the axis of the waves [m]. */
typedef struct build_block {
    int32_t solid;
    bool across; /* it reaches from side to side of the tank */
    double lo, hi;
} build_block;

/* Natural periods of the liquid at rest, of the tank without its solids. */
typedef struct build_modes {
    int32_t count, axis; /* 0: waves along x, 2: along z */
    double period[BUILD_MODES];
    double length, depth; /* of the free surface, of the liquid [m] */
    char how[BUILD_TEXT];
    int32_t blocks;
    build_block block[BUILD_SOLIDS]; /* from the lowest `lo` */
    double
        open; /* longest stretch of the surface between those that reach across [m]; of no meaning without blocks */
} build_modes;

/* Texts of the library, kept until there is a job. In the memory of the case: the simulation keeps its address. */
typedef struct build_log {
    mps_job *job;
    int32_t count, further; /* that are kept; that are only counted */
    int level[BUILD_NOTES];
    char text[BUILD_NOTES][2 * BUILD_TEXT];
} build_log;

typedef struct build {
    mps_case *c;
    const tree_node *root;
    mps_sim *sim;
    mps_job *job; /* NULL: the case is checked only */
    mps_status status;
    int32_t dim;
    double dp, gravity;
    char model[64];
    bool several, paper; /* several phases; to the letter of the papers */
    int32_t fluids, solids, sensors;
    int32_t unlisted;                /* columns that have no place in `sensor` */
    build_fluid fluid[BUILD_FLUIDS]; /* by phase: of falling density */
    build_tank tank;
    build_solid solid[BUILD_SOLIDS];
    build_sensor sensor[BUILD_SENSORS];
    build_modes modes;
    build_log *log;
    double level; /* still level as filled [m]; NAN: none was asked for */
    double depth; /* asked for [m]; NAN */
    double until;
    int32_t frames;                    /* besides the first */
    double scale;                      /* run.velocity_scale [m/s]; 0: that of the library */
    mps_time_control time;             /* with run.step_factor */
    const struct build_motion *motion; /* NULL: none; of a body its centre, axes and free degrees */
    const struct build_body *body;     /* NULL: none */
} build;

/* Whether a call of the library succeeded; else its text becomes a message at the line of `at`. */
bool mps__build_try(build *b, mps_status status, const tree_node *at, const char *what);
/* The same for a call of the job. */
bool mps__build_try_job(build *b, mps_status status, const tree_node *at, const char *what);
/* Memory that lives as long as the case; NULL after a message. */
void *mps__build_alloc(build *b, size_t size);

/* All but the columns. The case has messages where something was refused, or status is negative; the simulation is the caller's. */
void mps__build_simulation(build *b, const mps_job_config *options);

/* Whether a run that goes on has the case that it began with, but for what may change. @return MPS_E_STATE, MPS_E_ARG: text in options->error */
mps_status mps__build_resumed(const mps_case *c, const mps_job_config *options);

/* In the order of calls. Each returns at once where there are errors. */
void mps__build_fluids_read(build *b);
void mps__build_open(build *b, const mps_job_config *options);
void mps__build_tank(build *b);
void mps__build_solids(build *b);
void mps__build_phases(build *b);
void mps__build_fills(build *b);
void mps__build_modes(build *b);
/* Period of half a wave over `length`, in liquid of the modes' depth [s]. */
double mps__modes_period(const build *b, double length);
/* What the periods leave out of the case, behind "; ", or "". */
const char *mps__modes_without(const build *b);
/* Solids that stand in the free surface. */
void mps__build_blocks(build *b);
void mps__build_motion(build *b);
void mps__build_body(build *b);
/* Columns of the motion, prescribed or of the body, and of what moves the body. */
void mps__motion_columns(build *b);
void mps__body_columns(build *b);
void mps__build_time(build *b);
/* Warn of a motion that begins with a jump or a tilt; when steps are known. */
void mps__motion_start(build *b);
void mps__build_sensors(build *b);
/* Level of the liquid at rest [m]: as filled to a depth, or its highest particle. */
double mps__still_level(build *b);
void mps__build_references(build *b);
void mps__build_inputs(build *b);
/* Frequency of the motion [rad/s]; NAN: it has no period. */
double mps__build_omega(const build *b);

bool mps__build_filled(const build *b);
/* What was understood, and a drawing of tank and sensors as SVG; to be freed, NULL: no memory. The check does a few steps. */
char *mps__check_write(build *b);
char *mps__sketch_write(build *b);

/* Points of a list, or one point; z is `z` where two numbers are given. @return how many */
int32_t mps__build_points(build *b, const tree_node *node, double z, int32_t most,
                          double (*out)[3]);
/* The outline of a form: a polygon whose sides neither cross nor touch. Errors are at the line of the side. */
void mps__build_polygon(build *b, const tree_node *node, form *s);
/* A fluid by its name; -1 after a message. */
int32_t mps__build_phase(build *b, const tree_node *at, const char *name);
/* How to turn a file with this axis up; angles for mps_stl.rotation. */
bool mps__build_stl(build *b, const tree_node *map, mps_stl *stl);
/* Edges of a tank in 3-D, to the job. */
void mps__build_edges(build *b);
/* Part i of a plate, between two slots, as shares of its first side: as built, where that is known. */
void mps__solid_piece(const build_solid *s, int32_t i, double part[2]);
/* Which of these keys a map has. The reader has seen to it that it is one and only one. */
int mps__build_kind(const tree_node *map, const char *const *kind, int count);
/* Middle of the tank's box along z; 0 in 2-D. */
double mps__build_middle(const build *b);

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* The contents of a picture as plain arrays in the frame of the tank, filled from a simulation or
 * from a frame of a run's folder. */
#ifndef MPS_POST_PICTURE_SCENE_H
#define MPS_POST_PICTURE_SCENE_H

#include "page_film.h"
#include <mps/picture.h>

enum { SCENE_FLUID = 0, SCENE_WALL = 1, SCENE_PHASES = 16, SCENE_NAME = 48 };

/* A position of a sensor. */
typedef struct scene_sensor {
    char name[SCENE_NAME];
    bool gauge;              /* a vertical line up from `at`; else a point */
    double at[3], normal[3]; /* normal: into the liquid; 0: none */
} scene_sensor;

typedef struct scene {
    int32_t dim;
    int64_t n;
    float *x;              /* [3*n] */
    float *p;              /* [n] */
    uint8_t *kind, *phase; /* [n] */
    double dp, t;
    char title[200];
    film_pose pose;               /* of the tank in the lab frame */
    double density[SCENE_PHASES]; /* [kg/m3]; 0: not known */
    double speed2;                /* square of the largest speed of fluid */
    /* bounds of moving particles over the whole run; lo > hi: not known */
    double run_lo[3], run_hi[3];
    int32_t sensors;
    scene_sensor *sensor;
    int32_t edges; /* of the tank; 0: its box */
    double *edge;  /* [6*edges] both ends */
    /* set by mps__scene_end(): */
    int32_t phases;      /* highest phase number of the fluid (of a run: in all of it), plus one */
    double lo[3], hi[3]; /* bounds of the picture */
    /* set by mps__scene_scale(): */
    double p_lo, p_hi;
} scene;

/* Allocate n particles. @return false: memory is exhausted; mps__scene_free() is still valid */
bool mps__scene_reserve(scene *s, int64_t n);
void mps__scene_free(scene *s);
/* Add a sensor with a name; NULL: memory is exhausted. */
scene_sensor *mps__scene_sensor(scene *s, const char *name);
/* Allocate edges of the tank in s->edge, replacing previous ones.
 * @return false: memory is exhausted */
bool mps__scene_edges(scene *s, int32_t count);
/* Derive values from the particles once all are set. @return false: there is no particle */
bool mps__scene_end(scene *s);
/* The colour scale: that of the config, or the default of picture.h, which is then written to the
 * config unless all pressures are rounding.
 * @return false: memory is exhausted */
bool mps__scene_scale(scene *s, mps_picture_config *config);

/* Present rotation and position of the tank. */
mps_status mps__scene_pose(mps_sim *sim, int32_t dim, film_pose *out);
/* The present state of a simulation. */
mps_status mps__scene_of_sim(scene *s, mps_sim *sim, page_errors *e);
/* Draw that state and discard the picture, as a run does at its end: for a measurement of its
 * memory. */
mps_status mps__scene_rehearse(mps_sim *sim);
/* Title, spacing, phases and sensors from summary.json. */
mps_status mps__scene_of_run(scene *s, const film *f);
/* The particles of a frame that was read. */
mps_status mps__scene_of_frame(scene *s, const film *f, int64_t k, const film_frame *frame);

/* Draw a scene of at least one particle. Sizes are even numbers of pixels. */
struct canvas;
mps_status mps__scene_draw(const scene *s, int32_t width, struct canvas *out, page_errors *e);

#endif

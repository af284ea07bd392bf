/* SPDX-License-Identifier: BSD-3-Clause */
/* The film of a page: moving particles in the frame of the tank, over all frames of a run. */
#ifndef MPS_POST_PAGE_FILM_H
#define MPS_POST_PAGE_FILM_H

#include "page_codec.h"
#include "page_scale.h"
#include "page_vtp.h"

/* Kinds of particles in a frame. */
enum { FILM_FLUID = 0, FILM_WALL = 1 };
/* "Phase" of walls that move relative to the tank. */
enum { FILM_BODY = 255, FILM_PARTS = 4096 };
/* Numbers of pockets are bytes; all pockets beyond share the last number. */
enum { POCKETS_MOST = 255 };

/* Particles of one frame. */
typedef struct film_frame {
    int64_t count, capacity;
    double *x, *u;                        /* [3*count] */
    double *p, *kind, *phase, *part, *id; /* [count] */
    double *pocket;                       /* [count]; 0: no pocket, also if the frame has none */
    double *buffer;
    char *parts;
} film_frame;

/* The index of a particle by its id. */
typedef struct film_entry {
    int64_t id, place;
} film_entry;

typedef struct film_index {
    int64_t count;
    film_entry *entry; /* sorted by id up to `sorted` */
    int64_t sorted;
} film_index;

/* Rotation and position of the tank in a frame: x = turn X + shift. */
typedef struct film_pose {
    double turn[9], shift[3];
} film_pose;

typedef struct film {
    const page_run *run;
    int32_t dim;
    double dp;
    film_index moving, wall;
    unsigned char *phase; /* [moving.count], by index */
    double *wall_x;       /* [3*wall.count] in the tank's frame, by index */
    double *wall_part;    /* [wall.count] */
    bool part_moves[FILM_PARTS], part_of_tank[FILM_PARTS];
    film_pose start;      /* in the first frame */
    film_pose *pose;      /* [run->frames] */
    int64_t reference[3]; /* ids of walls that determine the pose; -1: none */
    double corner[3][3];  /* their positions in the tank's frame */
    bool tank_moves;
    double lo[3], hi[3]; /* bounds of moving particles, in the tank's frame */
    double speed2, density;
    int32_t phases, pockets; /* numbers of pockets are at most `pockets` */
    page_scale pressure, speed;
} film;

/* Read all frames once: particles, poses, bounds, scales. */
mps_status mps__film_survey(film *f, const page_run *run);
void mps__film_free(film *f);
/* Read frame k. */
mps_status mps__film_frame_read(const film *f, int64_t k, film_frame *out);
void mps__film_frame_free(film_frame *s);
/* Index of a particle, -1: none. */
int64_t mps__film_find(const film_index *index, double id);
/* Transform a point to the frame of the tank. */
void mps__film_to_tank(const film_pose *pose, const double x[3], double out[3]);

/* Pack the film into at most `bytes` bytes of the page; `note` lists what was omitted.
 * @param out    an empty file that can be read and truncated
 * @param shown  frames and particles in it */
mps_status mps__film_write(const film *f, int64_t bytes, int32_t frames, FILE *out, char *note,
                           size_t note_size, int64_t shown[2]);

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* Scenes whose bytes do not depend on the number of ranks, and the compared data. */
#ifndef RANKS_SCENES_H
#define RANKS_SCENES_H

#include <mps/mps.h>
#include <stdbool.h>

enum { SCENES = 25, SCENE_MOST = 8000, SCENE_NUMBERS = 9, SCENE_INFOS = 32, SCENE_PROBES = 5 };

typedef struct scene {
    const char *name, *preset;
    int32_t dim, steps, threads; /* threads 0: one */
    double dp;
    mps_motion_fn motion;
    int baffle;   /* 1: a block, 2: a thin plate, in the way of the fluid */
    double sigma; /* of the interface [N/m] */
    bool changes; /* particles are removed and added between steps */
    bool fast;    /* the liquid starts in pieces faster than 5 U_g */
    bool drop;    /* the liquid is a drop about the middle of the tank, where the cuts of four ranks
                 meet */
    /* NULL: auxgrid; "divided": auxgrid that divides small grids too */
    const char *preconditioner;
    bool gas; /* the liquid encloses a pocket of gas */
} scene;

extern const scene scenes[SCENES];

/* What is compared: numbers of each particle by its id, and those of the step. */
typedef struct record {
    double value[SCENE_MOST][SCENE_NUMBERS];
    double info[SCENE_INFOS];
    int64_t count;
} record;

/* A handle; ranks are set between the two calls. */
mps_status scene_create(const scene *s, mps_sim **sim);
mps_status scene_build(mps_sim *sim, const scene *s);

/* Before a step, from 0: what changes in it. */
mps_status scene_change(mps_sim *sim, const scene *s, int step);
/* The owned particles of this rank, into a record that is empty at first; rank 0 adds the numbers
 * of the step. */
void record_note(mps_sim *sim, const mps_step_info *info, record *r);
/* Whether both have the same bytes; otherwise `text` is the first difference. */
bool record_same(const record *alone, const record *many, char *text, size_t size);

#endif

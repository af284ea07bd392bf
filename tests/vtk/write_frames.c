/* SPDX-License-Identifier: BSD-3-Clause */
/* Two frames for tests/vtk/read_frames.py, of one rank and in pieces of three; prints the number of
 * points of each kind. usage: write_frames FOLDER */
#include "kit_engine.h"
#include <mps/mps.h>
#include <stdio.h>

enum { RANKS = 3 };

typedef struct job {
    const char *folder, *name;
    kit_engine_team *team; /* NULL: one rank */
    int failed[RANKS];
    long long fluid, wall;
} job;

static int failed(mps_sim *sim)
{
    fprintf(stderr, "%s\n", mps_sim_error(sim));
    return 1;
}

static mps_status build(mps_sim *sim)
{
    mps_tank tank;
    const double lo[3] = {0, 0, 0}, hi[3] = {0.6, 0.2, 0.4};
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = 0.6;
    tank.size[1] = 0.5;
    tank.size[2] = 0.4;
    const mps_status status = mps_tank_add(sim, &tank, NULL);
    return status < 0 ? status : mps_fill_box_add(sim, 0, lo, hi, NULL, NULL);
}

static int write_all(const job *j, mps_sim *sim)
{
    mps_frames *frames;
    const int32_t kinds = MPS_FRAMES_FLUID | MPS_FRAMES_WALL | MPS_FRAMES_PIECES;
    if (build(sim) < 0 || mps_frames_open(sim, j->folder, j->name, kinds, &frames) < 0)
        return failed(sim);
    for (int k = 0; k < 2; k++)
        if (mps_frames_write(frames) < 0 || mps_step(sim, 1e-3, NULL) < 0) return failed(sim);
    mps_frames_close(frames);
    return 0;
}

static void run_rank(void *argument, int32_t rank)
{
    job *j = argument;
    mps_config config;
    mps_sim *sim;
    mps_config_init(&config, sizeof config);
    config.dim = 3;
    config.dp = 0.1;
    j->failed[rank] = 2;
    if (mps_sim_create(&config, &sim) != MPS_OK) return;
    mps_status status = MPS_OK;
    if (j->team) {
        const mps_ranks_ops ops = kit_engine_ops(j->team, rank);
        status = mps_sim_ranks_set(sim, &ops);
    }
    j->failed[rank] = status < 0 ? failed(sim) : write_all(j, sim);
    if (!j->team) {
        j->fluid = mps_particles_count(sim, MPS_FLUID);
        j->wall = mps_particles_count(sim, MPS_WALL);
    }
    mps_sim_destroy(sim);
}

int main(int argc, char **argv)
{
    if (argc < 2) return 2;
    job alone = {.folder = argv[1], .name = "cells"},
        many = {.folder = argv[1], .name = "pieces", .team = kit_engine_create(RANKS, 0)};
    if (!many.team) return 2;
    run_rank(&alone, 0);
    kit_engine_run(many.team, run_rank, &many);
    kit_engine_destroy(many.team);
    printf("%lld %lld\n", alone.fluid, alone.wall);
    int bad = alone.failed[0];
    for (int k = 0; k < RANKS; k++) bad = bad > many.failed[k] ? bad : many.failed[k];
    return bad;
}

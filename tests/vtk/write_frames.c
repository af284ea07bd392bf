/* SPDX-License-Identifier: BSD-3-Clause */
/* Two frames for tests/vtk/read_frames.py; prints the number of points, and of those of each kind. usage: write_frames FOLDER */
#include <mps/mps.h>
#include <stdio.h>

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

int main(int argc, char **argv)
{
    mps_config config;
    mps_sim *sim;
    mps_frames *frames;
    mps_config_init(&config, sizeof config);
    config.dim = 3;
    config.dp = 0.1;
    if (argc < 2 || mps_sim_create(&config, &sim) != MPS_OK) return 2;
    if (build(sim) < 0 ||
        mps_frames_open(sim, argv[1], "cells", MPS_FRAMES_FLUID | MPS_FRAMES_WALL, &frames) < 0)
        return failed(sim);
    for (int k = 0; k < 2; k++)
        if (mps_frames_write(frames) < 0 || mps_step(sim, 1e-3, NULL) < 0) return failed(sim);
    mps_frames_close(frames);
    printf("%lld %lld\n", (long long)mps_particles_count(sim, MPS_FLUID),
           (long long)mps_particles_count(sim, MPS_WALL));
    mps_sim_destroy(sim);
    return 0;
}

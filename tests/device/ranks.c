/* SPDX-License-Identifier: BSD-3-Clause */
#include "ranks.h"
#include "team.h"

enum { STEPS = 6 };

typedef struct task {
    ranks_run *run;
    kit_engine_team *team;
} task;

static void run_rank(void *argument, int32_t rank)
{
    task *t = argument;
    ranks_run *k = t->run;
    mps_sim *sim = NULL;
    mps_device_info info = {.struct_size = sizeof info};
    mps_status status = scene_start(scene_named(k->scene), t->team, rank, &sim);
    if (status == MPS_OK) opencl_attach(k->device[rank], sim);
    for (int s = 0; s < STEPS && status >= 0; s++) status = mps_step(sim, 1, NULL);
    if (status >= 0) status = mps_sim_device_info(sim, &info);
    k->status[rank] = status;
    k->launches[rank] = info.launches;
    mps_sim_destroy(sim);
}

void ranks_go(ranks_run *k)
{
    task t = {k, kit_engine_create(2, 0)};
    kit_engine_run(t.team, run_rank, &t);
    kit_engine_destroy(t.team);
}

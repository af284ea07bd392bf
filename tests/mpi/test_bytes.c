/* SPDX-License-Identifier: BSD-3-Clause */
/* Runs on MPI ranks have the bytes of a run on one rank, after every step. Rank 0 does both runs,
 * the others one. */
#include "scenes.h"
#include <mps/mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Each number is known to one rank and 0 on the others, so that the bitwise OR has the bytes of
 * all. */
static void collect(record *r, int32_t rank)
{
    const void *own = rank == 0 ? MPI_IN_PLACE : r;
    const int words = (int)(offsetof(record, count) / sizeof(uint64_t));
    MPI_Reduce(own, r, words, MPI_UINT64_T, MPI_BOR, 0, MPI_COMM_WORLD);
    own = rank == 0 ? MPI_IN_PLACE : &r->count;
    MPI_Reduce(own, &r->count, 1, MPI_INT64_T, MPI_SUM, 0, MPI_COMM_WORLD);
}

static mps_status step(mps_sim *sim, record *r)
{
    mps_step_info info;
    mps_step_info_init(&info, sizeof info);
    memset(r, 0, sizeof *r);
    const mps_status status = mps_step(sim, 1, &info);
    if (status >= 0) record_note(sim, &info, r);
    return status;
}

/* Both runs, step by step. @return whether they are the same */
static int run(const scene *s, mps_sim *alone, mps_sim *many, record *r, int32_t rank)
{
    char text[300];
    for (int k = 1; k <= s->steps; k++) {
        if (step(many, &r[1]) < 0 || (alone && step(alone, &r[0]) < 0)) {
            printf("%s, step %d, rank %d: %s%s\n", s->name, k, (int)rank, mps_sim_error(many),
                   alone ? mps_sim_error(alone) : "");
            return 0;
        }
        collect(&r[1], rank);
        if (alone && !record_same(&r[0], &r[1], text, sizeof text)) {
            printf("%s, step %d: %s\n", s->name, k, text);
            return 0;
        }
    }
    return 1;
}

static int check(const scene *s, int32_t rank)
{
    mps_sim *alone = NULL, *many = NULL;
    int same = 0;
    record *r = calloc(2, sizeof *r);
    mps_status status = r ? scene_create(s, &many) : MPS_E_NOMEM;
    if (status == MPS_OK) status = mps_mpi_attach(many, MPI_COMM_WORLD);
    if (status == MPS_OK) status = scene_build(many, s);
    if (status == MPS_OK && rank == 0) status = scene_create(s, &alone);
    if (status == MPS_OK && rank == 0) status = scene_build(alone, s);
    if (status == MPS_OK)
        same = run(s, alone, many, r, rank);
    else
        printf("%s, rank %d: %s\n", s->name, (int)rank, mps_sim_error(many));
    if (!same) MPI_Abort(MPI_COMM_WORLD, 1);
    mps_sim_destroy(alone);
    mps_sim_destroy(many);
    free(r);
    return same;
}

int main(int argc, char **argv)
{
    int32_t rank;
    int same = 1;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    for (int k = 0; k < SCENES; k++) same = check(&scenes[k], rank) && same;
    MPI_Finalize();
    return !same;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Out of memory on one rank, at each allocation in turn: all ranks end, none waits, nothing
 * leaks. */
#include "team.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { RANKS = 2, POOR = 1, TEXT = 300 };

typedef struct memory {
    int64_t live, count, fail_at; /* allocations since it was armed; 0: none fails */
    bool armed;
} memory;

static void *take(void *user, size_t size)
{
    memory *m = user;
    if (m->armed && ++m->count == m->fail_at) return NULL;
    m->live++;
    return calloc(1, size ? size : 1);
}

static void release(void *user, void *block)
{
    memory *m = user;
    m->live--;
    free(block);
}

typedef struct run {
    const scene *scene;
    kit_engine_team *team;
    char folder[64], file[80];
    memory memory[RANKS];
    mps_status status[RANKS];
    char error[RANKS][TEXT];
} run;

static mps_status write_frame(mps_sim *sim, const char *folder)
{
    mps_frames *frames = NULL;
    mps_status status = mps_frames_open(sim, folder, "f", MPS_FRAMES_PIECES, &frames);
    if (status == MPS_OK) status = mps_frames_write(frames);
    mps_frames_close(frames);
    return status;
}

static mps_status gather(mps_sim *sim)
{
    const mps_status status = mps_particles_collect(sim);
    if (status == MPS_OK) mps_particles_collect_end(sim);
    return status;
}

/* All that ranks do together, twice, so that arrays grow and are used again. */
static mps_status use(mps_sim *sim, const run *k)
{
    const double at[2] = {0.45, 0.35};
    int64_t id = 0;
    mps_particle_block block;
    mps_particle_block_init(&block, sizeof block);
    block.count = 1;
    block.position = at;
    mps_status status = mps_step(sim, 1, NULL);
    for (int pass = 0; pass < 2 && status >= 0; pass++) {
        status = mps_step(sim, 1, NULL);
        const bool enough = k->scene->preset[0] == 'i'; /* gas fills the rest */
        if (status >= 0 && enough) status = mps_particles_add(sim, &block, &id);
        if (status >= 0) status = write_frame(sim, k->folder);
        if (status >= 0) status = mps_checkpoint_write(sim, k->file);
        if (status >= 0 && enough) status = mps_particles_remove(sim, 1, &id);
        if (status >= 0) status = gather(sim);
    }
    mps_energy energy; /* a failure after the last message is heard in the next call */
    mps_energy_init(&energy, sizeof energy);
    return status >= 0 ? mps_energy_get(sim, &energy) : status;
}

static void run_rank(void *argument, int32_t rank)
{
    run *k = argument;
    memory *m = &k->memory[rank];
    const mps_allocator allocator = {.alloc = take, .release = release, .user = m};
    const mps_ranks_ops ops = kit_engine_ops(k->team, rank);
    const scene *s = k->scene;
    mps_config config;
    mps_sim *sim = NULL;
    mps_config_init(&config, sizeof config);
    config.dim = s->dim;
    config.dp = 0.05;
    config.allocator = allocator;
    mps_status status = mps_sim_create(&config, &sim);
    if (status == MPS_OK) status = mps_sim_ranks_set(sim, &ops);
    if (status == MPS_OK) status = scene_build(sim, s);
    m->armed = true;
    if (status == MPS_OK) status = use(sim, k);
    m->armed = false;
    k->status[rank] = status;
    if (status < 0) snprintf(k->error[rank], TEXT, "%s", mps_sim_error(sim));
    mps_sim_destroy(sim);
}

/* Returns the allocations of the rank that fails. */
static int64_t check(const scene *s, const char *folder, int64_t fail_at)
{
    run k = {.scene = s, .team = kit_engine_create(RANKS, 0)};
    assert_non_null(k.team);
    snprintf(k.folder, sizeof k.folder, "%s", folder);
    snprintf(k.file, sizeof k.file, "%s/checkpoint", folder);
    k.memory[POOR].fail_at = fail_at;
    kit_engine_run(k.team, run_rank, &k);
    kit_engine_destroy(k.team);
    for (int r = 0; r < RANKS; r++) {
        if (k.memory[r].live != 0)
            fail_msg("allocation %lld: rank %d keeps %lld blocks", (long long)fail_at, r,
                     (long long)k.memory[r].live);
        if ((k.status[r] < 0) != (k.status[0] < 0))
            fail_msg("allocation %lld: rank 0 ends with %d '%s', rank 1 with %d '%s'",
                     (long long)fail_at, (int)k.status[0], k.error[0], (int)k.status[1],
                     k.error[1]);
    }
    if (fail_at > 0 && k.status[POOR] < 0 && k.status[POOR] != MPS_E_NOMEM)
        fail_msg("allocation %lld: status %d: %s", (long long)fail_at, (int)k.status[POOR],
                 k.error[POOR]);
    if (fail_at == 0 && k.status[0] < 0) fail_msg("%s", k.error[0]);
    return k.memory[POOR].count;
}

static void each_allocation(void **state)
{
    char folder[] = "ranks_frames_XXXXXX", command[64];
    const scene *s = *state;
    assert_non_null(mkdtemp(folder));
    const int64_t all = check(s, folder, 0);
    assert_in_range(all, 100, 100000);
    for (int64_t k = 1; k <= all; k++) check(s, folder, k);
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    assert_int_equal(system(command), 0);
}

int main(void)
{
    static const char *const names[] = {"dam_2d", "plate_2d", "roll_2d_divided", "air_2d"};
    enum { COUNT = sizeof names / sizeof names[0] };
    struct CMUnitTest tests[COUNT];
    for (int k = 0; k < COUNT; k++)
        tests[k] = (struct CMUnitTest){.name = names[k],
                                       .test_func = each_allocation,
                                       .initial_state = (void *)(uintptr_t)scene_named(names[k])};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Leases on many ranks: after each call ghosts have the values of their owners, in every field;
 * values that a rank writes at its own particles are the initial values of the next step on all
 * ranks. */
#include "team.h"
#include "sim.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum {
    MOST = 5,
    BYTES = 24 /* of a particle in a field */,
    TEXT = 300,
    STEPS = 16,
    WRITE_STEP = 7
};

/* Who writes before step WRITE_STEP. */
enum { NO_RANK, EACH_RANK, ONE_RANK };

typedef struct run {
    const scene *scene;
    kit_engine_team *team; /* NULL: one rank */
    int writers;
    char (*value)[BYTES]; /* [SCENE_MOST] of the owners */
    record *records;      /* [STEPS] */
    int64_t ghosts[MOST]; /* that were compared */
    char error[MOST][TEXT];
} run;

static void wait_for_all(mps_sim *sim)
{
    double none = 0;
    mps__ranks_max(&sim->world.ranks, 1, &none);
}

static const char *element(const mps_lease *l, int64_t i, size_t *bytes)
{
    const char *data = l->type == MPS_DATA_DOUBLE  ? (const char *)l->data
                       : l->type == MPS_DATA_INT32 ? (const char *)l->integers
                                                   : (const char *)l->ids;
    *bytes = (size_t)l->stride * (l->type == MPS_DATA_INT32 ? sizeof(int32_t) : sizeof(double));
    return data + (size_t)i * *bytes;
}

/* Owners write down a field, then ghosts are compared with it. */
static void compare_field(run *k, int32_t rank, mps_sim *sim, const char *name, const char *when)
{
    mps_lease l = {.struct_size = sizeof l}, id = l;
    const uint8_t *ghost = NULL;
    size_t bytes;
    if (mps_lease_begin(sim, name, MPS_READ, &l) < 0 ||
        mps_lease_begin(sim, "id", MPS_READ, &id) < 0)
        snprintf(k->error[rank], TEXT, "%s", mps_sim_error(sim));
    mps_particles_ghosts(sim, &ghost);
    for (int64_t i = 0; i < l.count; i++) {
        const char *from = element(&l, i, &bytes);
        if (!ghost || !ghost[i]) memcpy(k->value[id.ids[i]], from, bytes);
    }
    wait_for_all(sim);
    for (int64_t i = 0; ghost && i < l.count; i++) {
        const char *from = element(&l, i, &bytes);
        if (!ghost[i]) continue;
        k->ghosts[rank]++;
        if (memcmp(k->value[id.ids[i]], from, bytes) == 0 || k->error[rank][0]) continue;
        snprintf(k->error[rank], TEXT, "%s, %s of ghost %lld (kind %d) is not that of its owner",
                 when, name, (long long)id.ids[i], (int)sim->world.particles.kind[i]);
    }
    wait_for_all(sim);
    mps_lease_end(sim, &l);
    mps_lease_end(sim, &id);
}

static void compare_fields(run *k, int32_t rank, mps_sim *sim, const char *what, int step)
{
    char when[64];
    snprintf(when, sizeof when, "%s of step %d", what, step);
    for (int32_t f = 0; f < sim->world.particles.fields; f++) {
        const mps__field *field = &sim->world.particles.field[f];
        if (field->is_public || field->is_tag) compare_field(k, rank, sim, field->name, when);
    }
}

/* Of each third particle that this rank owns, or of one: faster, and marked. */
static mps_status write_own(const run *k, mps_sim *sim)
{
    enum { THE_ONE = 300 };
    mps_lease u = {.struct_size = sizeof u}, mark = u;
    const mps__particles *s = &sim->world.particles;
    const mps__ghosts *g = &sim->world.ghosts;
    const int64_t place = mps_particle_index(sim, THE_ONE);
    const bool one = k->writers == ONE_RANK;
    if (k->writers == NO_RANK) return MPS_OK;
    if (one && mps__own_place(g, place) < 0) return MPS_OK;
    MPS__TRY(mps_lease_begin(sim, "velocity", MPS_WRITE, &u));
    MPS__TRY(mps_lease_begin(sim, "mark", MPS_WRITE, &mark));
    for (int64_t i = 0; i < u.count; i++) {
        if (mps__own_place(g, i) < 0 || s->kind[i] != MPS_FLUID) continue;
        if (one ? i != place : s->id[i] % 3 > 0) continue;
        u.data[i * u.stride] += 0.05;
        mark.data[i] = 1 + (double)s->id[i];
    }
    MPS__TRY(mps_lease_end(sim, &u));
    return mps_lease_end(sim, &mark);
}

static void run_rank(void *argument, int32_t rank)
{
    run *k = argument;
    mps_sim *sim = NULL;
    mps_step_info info;
    mps_energy e = {.struct_size = sizeof e};
    mps_step_info_init(&info, sizeof info);
    mps_status status = scene_start(k->scene, k->team, rank, &sim);
    if (status == MPS_OK) status = mps_field_add(sim, "mark", 1);
    for (int s = 0; s < STEPS && status >= 0; s++) {
        status = scene_change(sim, k->scene, s);
        if (status == MPS_OK && s == WRITE_STEP) status = write_own(k, sim);
        if (status == MPS_OK) status = mps_step(sim, 1, &info);
        if (status >= 0 && k->team) compare_fields(k, rank, sim, "end", s);
        if (status >= 0) record_note(sim, &info, &k->records[s]);
        if (status >= 0) status = mps_energy_get(sim, &e);
        if (status >= 0 && k->team) compare_fields(k, rank, sim, "energies", s);
    }
    if (status < 0) snprintf(k->error[rank], TEXT, "%s", mps_sim_error(sim));
    mps_sim_destroy(sim);
}

static run run_scene(const scene *s, int32_t ranks, int writers)
{
    run k = {.scene = s,
             .writers = writers,
             .value = calloc(SCENE_MOST, sizeof *k.value),
             .records = calloc(STEPS, sizeof(record))};
    assert_non_null(k.value);
    assert_non_null(k.records);
    if (ranks > 1) k.team = kit_engine_create(ranks, (uint32_t)ranks);
    if (k.team)
        kit_engine_run(k.team, run_rank, &k);
    else
        run_rank(&k, 0);
    for (int32_t r = 0; r < ranks; r++) {
        if (k.error[r][0])
            fail_msg("%s, rank %d of %d: %s", s->name, (int)r, (int)ranks, k.error[r]);
        assert_true(!k.team || k.ghosts[r] > 0);
    }
    if (k.team) kit_engine_destroy(k.team);
    free(k.value);
    return k;
}

static void ghosts_are_copies(void **state)
{
    static const char *const names[] = {"dam_2d", "dam_3d", "roll_2d", "air_2d"};
    (void)state;
    for (int k = 0; k < 4; k++)
        for (int32_t ranks = 2; ranks <= MOST; ranks += 3)
            free(run_scene(scene_named(names[k]), ranks, NO_RANK).records);
}

static void check_writers(int writers)
{
    char text[TEXT];
    const scene *s = scene_named("dam_2d");
    record *alone = run_scene(s, 1, writers).records;
    for (int32_t ranks = 2; ranks <= MOST; ranks++) {
        record *many = run_scene(s, ranks, writers).records;
        for (int k = 0; k < STEPS; k++)
            if (!record_same(&alone[k], &many[k], text, sizeof text))
                fail_msg("%d ranks, step %d: %s", (int)ranks, k, text);
        free(many);
    }
    free(alone);
}

static void each_rank_writes(void **state)
{
    (void)state;
    check_writers(EACH_RANK);
}

static void one_rank_writes(void **state)
{
    (void)state;
    check_writers(ONE_RANK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(ghosts_are_copies),
                                       cmocka_unit_test(each_rank_writes),
                                       cmocka_unit_test(one_rank_writes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

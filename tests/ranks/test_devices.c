/* SPDX-License-Identifier: BSD-3-Clause */
/* Ranks with a device each have the bytes of one rank on the host; failures on one of them. */
#include "team.h"
#include "shadow.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { TEXT = 300, MOST = 4, FIRST = 5 /* tests before those of scenes */ };

/* The scene unchanged; with a tank full of liquid, without a pressure datum; with gas.pocket that
 * finds no pocket. */
enum { AS_IT_IS, FULL, WITHOUT_POCKET };

typedef struct run {
    const scene *scene;
    int another;           /* AS_IT_IS, FULL or WITHOUT_POCKET */
    kit_engine_team *team; /* NULL: alone, without a device */
    record *records;       /* [steps] */
    shadow device[MOST];
    char error[MOST][TEXT];
} run;

static mps_status build(const run *k, mps_sim *sim)
{
    const double lo[3] = {0, 0, 0}, hi[3] = {0.6, 0.45, 0.4};
    MPS__TRY(scene_build(sim, k->scene));
    if (k->another == WITHOUT_POCKET) return mps_model_use(sim, "gas.pocket");
    return k->another == FULL ? mps_fill_box_add(sim, 0, lo, hi, NULL, NULL) : MPS_OK;
}

/* A scene with a device, whose handle has memory that is closed while loops run. */
static mps_status start(run *k, int32_t rank, mps_sim **sim)
{
    MPS__TRY(scene_create(k->scene, sim));
    if (!k->team) return build(k, *sim);
    const mps_ranks_ops ops = kit_engine_ops(k->team, rank);
    shadow_heap_of(*sim, rank);
    MPS__TRY(mps_sim_ranks_set(*sim, &ops));
    MPS__TRY(build(k, *sim));
    shadow_attach(&k->device[rank], *sim);
    return MPS_OK;
}

static void run_rank(void *argument, int32_t rank)
{
    run *k = argument;
    mps_sim *sim = NULL;
    mps_step_info info;
    mps_step_info_init(&info, sizeof info);
    mps_status status = start(k, rank, &sim);
    for (int s = 0; s < k->scene->steps && status >= 0; s++) {
        sim->world.ghosts.recut = s % 7 == 3; /* a new partition in each neighbour search */
        status = scene_change(sim, k->scene, s);
        if (status == MPS_OK) status = mps_step(sim, 1, &info);
        /* else the next step begins with fields that the device has alone */
        if (status >= 0 && s % 3 != 1) continue;
        if (status >= 0) status = mps__world_fetch(&sim->world);
        if (status >= 0) record_note(sim, &info, &k->records[s]);
    }
    if (status < 0) snprintf(k->error[rank], TEXT, "%s", mps_sim_error(sim));
    mps_sim_destroy(sim);
}

static run *run_scene(const scene *s, int another, int32_t ranks)
{
    run *k = calloc(1, sizeof *k);
    assert_non_null(k);
    k->scene = s;
    k->another = another;
    k->records = calloc((size_t)s->steps, sizeof *k->records);
    assert_non_null(k->records);
    if (ranks > 1) {
        k->team = kit_engine_create(ranks, 1);
        kit_engine_run(k->team, run_rank, k);
        kit_engine_destroy(k->team);
    } else {
        run_rank(k, 0);
    }
    for (int32_t r = 0; r < ranks; r++)
        if (k->error[r][0]) fail_msg("rank %d of %d: %s", (int)r, (int)ranks, k->error[r]);
    return k;
}

static void release_all(run *k)
{
    free(k->records);
    free(k);
}

/* Expected: the devices solve the equation, or else the hosts; auxgrid has more than one grid on
 * the device. */
enum { THERE = 1, GRIDS = 2 };

static void compare(const scene *s, int another, int32_t ranks, int what)
{
    run *alone = run_scene(s, another, 1), *many = run_scene(s, another, ranks);
    char text[TEXT];
    for (int k = 1; k < s->steps; k += 3)
        if (!record_same(&alone->records[k], &many->records[k], text, sizeof text))
            fail_msg("%s on %d ranks, step %d: %s", s->name, (int)ranks, k + 1, text);
    for (int32_t r = 0; r < ranks; r++) {
        const shadow *device = &many->device[r];
        assert_true(device->launches > 100 * s->steps);
        assert_int_equal(device->blocks, 0);
        assert_int_equal(shadow_seen(device, "rows.c", "multiply_rows") > 0, (what & THERE) > 0);
        assert_true(!(what & GRIDS) || shadow_seen(device, "auxgrid_coarse.c", "merge_rows") > 0);
    }
    release_all(alone);
    release_all(many);
}

/* On two ranks as it is, and on four with jacobi. Its devices solve the equation. */
static void test_scene(void **state)
{
    const scene *of = *state;
    scene s = *of;
    if (scene_runs(of, 0, 2)) compare(&s, AS_IT_IS, 2, THERE);
    s.preconditioner = "jacobi";
    if (scene_runs(of, 1, 2)) compare(&s, AS_IT_IS, MOST, THERE);
}

/* So many cells that auxgrid has other grids, for one density and for two, in 2-D and 3-D. */
static void several_grids(void **state)
{
    static const char *const name[] = {"dam_2d", "air_2d", "dam_3d", "air_3d"};
    (void)state;
    for (size_t k = 0; k < sizeof name / sizeof name[0]; k++) {
        scene s = *scene_named(name[k]);
        s.dp *= s.dim == 2 ? 0.3 : 0.6;
        s.steps = 5;
        compare(&s, AS_IT_IS, 3, THERE | GRIDS);
    }
}

/* The hosts make such an equation solvable, and solve it. */
static void pressures_without_a_level(void **state)
{
    scene s = *scene_named("roll_2d");
    (void)state;
    s.steps = 12;
    s.preconditioner = "jacobi";
    compare(&s, FULL, 3, 0);
}

/* All ranks wait in the same steps, and search voids in the same steps. */
static void gas_without_a_pocket(void **state)
{
    scene s = *scene_named("roll_2d");
    (void)state;
    s.steps = 24;
    compare(&s, WITHOUT_POCKET, 2, THERE);
}

/* ---- refusals ---- */

typedef struct refusal {
    kit_engine_team *team;
    int launch; /* launch of a step that fails on rank 0; 0: it has no memory */
    shadow device[2];
    mps_status status[2][3];
    char error[2][3][TEXT];
} refusal;

static void note_end(void *self)
{
    ((shadow *)self)->ended++;
}

static int does_not_open(void *self)
{
    (void)self;
    return 1;
}

/* Rank 0 sets a device and rank 1 none; the device of rank 1 does not open; then that of rank 0
 * fails in a step. */
static void refuse(void *argument, int32_t rank)
{
    refusal *k = argument;
    mps_sim *sim = NULL;
    const scene *s = scene_named("dam_2d");
    assert_int_equal(scene_start(s, k->team, rank, &sim), MPS_OK);
    shadow_attach(&k->device[rank], sim);
    mps_device_ops ops = k->device[rank].ops;
    k->status[rank][0] = mps_sim_device_set(sim, rank == 0 ? &ops : NULL);
    snprintf(k->error[rank][0], TEXT, "%s", mps_sim_error(sim));
    if (rank == 1) ops.begin = does_not_open;
    ops.end = note_end;
    k->status[rank][1] = mps_sim_device_set(sim, &ops);
    snprintf(k->error[rank][1], TEXT, "%s", mps_sim_error(sim));
    assert_null(shadow_counts(sim).name); /* both are on the host */
    assert_int_equal(k->device[rank].ended, rank == 0);
    shadow_attach(&k->device[rank], sim);
    assert_int_equal(mps_step(sim, 1, NULL), MPS_OK);
    if (k->launch == 0)
        mps__ghosts_release_device(
            &sim->world.ghosts); /* their arrays on the device are created again */
    k->device[rank].refuses = k->launch == 0 && rank == 0;
    k->device[rank].fails_at = rank == 0 && k->launch > 0 ? k->device[rank].launches + k->launch
                                                          : 0;
    k->status[rank][2] = mps_step(sim, 1, NULL);
    snprintf(k->error[rank][2], TEXT, "%s", mps_sim_error(sim));
    mps_sim_destroy(sim);
}

static void check_refusals(int launch)
{
    refusal *k = calloc(1, sizeof *k);
    assert_non_null(k);
    k->launch = launch;
    k->team = kit_engine_create(2, 0);
    kit_engine_run(k->team, refuse, k);
    kit_engine_destroy(k->team);
    for (int r = 0; r < 2; r++) {
        assert_int_equal(k->status[r][0], MPS_E_ARG);
        assert_non_null(strstr(k->error[r][0], "must be all or none"));
        assert_int_equal(k->status[r][1], MPS_E_PLUGIN);
        assert_non_null(strstr(k->error[r][1], "does not open"));
        assert_int_equal(k->status[r][2], r == 0 ? MPS_E_PLUGIN : MPS_E_RANKS);
        assert_non_null(
            strstr(k->error[r][2], launch == 0 ? "has no memory" : "as the test wants it"));
        assert_int_equal(k->device[r].blocks, 0);
    }
    free(k);
}

typedef struct shortage {
    kit_engine_team *team;
    int64_t allocations; /* allocations of rank 0 */
    shadow device[2];
    mps_status status[2];
    char error[2][TEXT];
} shortage;

static void run_short(void *argument, int32_t rank)
{
    shortage *k = argument;
    mps_sim *sim = NULL;
    assert_int_equal(scene_start(scene_named("dam_2d"), k->team, rank, &sim), MPS_OK);
    shadow_attach(&k->device[rank], sim);
    k->device[rank].refuses = rank == 0;
    k->device[rank].allocations = k->allocations;
    k->status[rank] = mps_step(sim, 1, NULL);
    snprintf(k->error[rank], TEXT, "%s", mps_sim_error(sim));
    mps_sim_destroy(sim);
}

/* Rank 0 runs out of device memory at each allocation of a step in turn: both ranks report it. */
static void memory_for_a_part(void **state)
{
    int shortages = 0;
    bool enough = false;
    (void)state;
    for (int64_t allocations = 0; allocations < 1000 && !enough; allocations += 3, shortages++) {
        shortage *k = calloc(1, sizeof *k);
        assert_non_null(k);
        k->allocations = allocations;
        k->team = kit_engine_create(2, 0);
        kit_engine_run(k->team, run_short, k);
        kit_engine_destroy(k->team);
        enough = k->status[0] == MPS_OK && k->status[1] == MPS_OK;
        if (!enough) {
            assert_true(k->status[0] == MPS_E_NOMEM || k->status[0] == MPS_E_PLUGIN);
            assert_int_equal(k->status[1], MPS_E_RANKS);
            assert_non_null(strstr(k->error[1], "rank 0 of 2"));
        }
        for (int r = 0; r < 2; r++) assert_int_equal(k->device[r].blocks, 0);
        free(k);
    }
    assert_true(enough && shortages > 10);
}

static void devices_of_all_or_none(void **state)
{
    (void)state;
    check_refusals(0);
    /* before the equation, in the set-up of auxgrid, in conjugate gradients, after them */
    for (int launch = 40; launch < 400; launch += 40) check_refusals(launch);
}

int main(void)
{
    struct CMUnitTest tests[FIRST + SCENES] = {
        cmocka_unit_test(devices_of_all_or_none), cmocka_unit_test(memory_for_a_part),
        cmocka_unit_test(pressures_without_a_level), cmocka_unit_test(several_grids),
        cmocka_unit_test(gas_without_a_pocket)};
    for (int k = 0; k < SCENES; k++)
        tests[FIRST + k] = (struct CMUnitTest){.name = scenes[k].name,
                                               .test_func = test_scene,
                                               .initial_state = (void *)(uintptr_t)&scenes[k]};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

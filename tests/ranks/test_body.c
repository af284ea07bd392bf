/* SPDX-License-Identifier: BSD-3-Clause */
/* A rigid body that carries the tank has bitwise the same motion on any number of ranks: its load
 * and its added mass are sums over all of them. */
#include "team.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { TEXT = 300, STEPS = 24 };

/* Calm and violent, two phases, changes of the particles, 3-D. */
static const char *const chosen[] = {"dam_2d", "changes_2d", "air_2d", "gas_2d", "plate_3d"};
enum { CHOSEN = sizeof chosen / sizeof chosen[0] };

typedef struct run {
    const scene *scene;
    kit_engine_team *team;
    record *last; /* of the last step */
    mps_body_report body[4];
    char error[4][TEXT];
} run;

/* Free along x and to rotate, in 3-D about all axes. */
static mps_status set_body(mps_sim *sim, int32_t dim)
{
    mps_body b;
    mps_body_init(&b, sizeof b);
    b.free = MPS_BODY_FREE(MPS_MOVE_X) | MPS_BODY_FREE(MPS_ROTATE_Z);
    if (dim == 3) b.free |= MPS_BODY_FREE(MPS_ROTATE_X) | MPS_BODY_FREE(MPS_ROTATE_Y);
    b.mass = 10;
    b.centre_of_mass[1] = 0.2;
    b.inertia[8] = 3;
    if (dim == 3) b.inertia[0] = b.inertia[4] = 2;
    for (int k = 3; k < 6; k++) b.stiffness[7 * k] = 2000;
    b.friction[MPS_MOVE_X] = dim == 3 ? 0 : 5;
    b.friction[MPS_ROTATE_Z] = 0.5;
    b.gravity = 0;
    return mps_body_set(sim, &b);
}

static void run_rank(void *argument, int32_t rank)
{
    run *k = argument;
    mps_sim *sim = NULL;
    mps_step_info info;
    mps_step_info_init(&info, sizeof info);
    mps_status status = scene_start(k->scene, k->team, rank, &sim);
    if (status == MPS_OK) status = set_body(sim, k->scene->dim);
    for (int n = 0; n < STEPS && status >= 0; n++) {
        status = scene_change(sim, k->scene, n);
        if (status >= 0) status = mps_step(sim, 1, &info);
    }
    mps_body_report_init(&k->body[rank], sizeof k->body[rank]);
    if (status >= 0) status = mps_body_get(sim, &k->body[rank]);
    if (status >= 0) record_note(sim, &info, k->last);
    if (status < 0) snprintf(k->error[rank], TEXT, "%s", mps_sim_error(sim));
    mps_sim_destroy(sim);
}

/* @return what the last step left; for free() */
static record *take(const scene *s, int32_t ranks, mps_body_report *body)
{
    run k = {.scene = s,
             .last = calloc(1, sizeof(record)),
             .team = ranks > 1 ? kit_engine_create(ranks, (uint32_t)ranks) : NULL};
    assert_non_null(k.last);
    if (k.team)
        kit_engine_run(k.team, run_rank, &k);
    else
        run_rank(&k, 0);
    for (int32_t r = 0; r < ranks; r++)
        if (k.error[r][0])
            fail_msg("%s, rank %d of %d: %s", s->name, (int)r, (int)ranks, k.error[r]);
    if (k.team) kit_engine_destroy(k.team);
    for (int32_t r = 1; r < ranks; r++) assert_memory_equal(&k.body[0], &k.body[r], sizeof *k.body);
    *body = k.body[0];
    return k.last;
}

static void test_scene(void **state)
{
    const scene *s = *state;
    char text[TEXT];
    mps_body_report first, body;
    record *alone = take(s, 1, &first);
    assert_true(first.pose[MPS_MOVE_X] != 0 && first.pose[MPS_ROTATE_Z] != 0);
    for (int32_t ranks = 2; ranks <= 4; ranks++) {
        record *many = take(s, ranks, &body);
        if (!record_same(alone, many, text, sizeof text))
            fail_msg("%s: %d ranks: %s", s->name, (int)ranks, text);
        assert_memory_equal(&first, &body, sizeof body);
        free(many);
    }
    free(alone);
}

int main(void)
{
    struct CMUnitTest tests[CHOSEN];
    for (int c = 0; c < CHOSEN; c++) {
        const scene *found = scene_named(chosen[c]);
        if (!found) return 1;
        tests[c] = (struct CMUnitTest){
            .name = chosen[c], .test_func = test_scene, .initial_state = (void *)(uintptr_t)found};
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}

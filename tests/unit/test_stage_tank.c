/* SPDX-License-Identifier: BSD-3-Clause */
/* mps_view_tank(): at solids it returns the velocity of the solid and a constant position. */
#include "tank_fixture.h"
#include <mps/model.h>

/* By id of solids: initial positions; positions and velocities before the last step, at time t.
 * Number of checked steps, and of checks before a step. */
static struct {
    double place[4000][3], x[4000][3], velocity[4000][3], t;
    int steps, before;
} seen;

static int look(mps_stage *s)
{
    const mps_view *v = s->view;
    const double *u = s->data[0];
    for (int64_t i = 0; i < v->n; i++) {
        double place[3], velocity[3], *first = seen.place[v->id[i]];
        mps_view_tank(v, v->x + i * v->dim, place, velocity);
        mps_view_tank(v, v->x + i * v->dim, NULL, NULL);
        if (v->kind[i] == MPS_FLUID) continue;
        for (int d = 0; d < v->dim; d++) {
            ASSERT_NEAR(velocity[d], u[i * v->dim + d], 1e-10);
            if (seen.steps == 0) first[d] = place[d];
            ASSERT_NEAR(place[d], first[d], 1e-12);
        }
    }
    seen.steps++;
    return 0;
}

/* Before the step the velocity is that of the motion: over a step the mean of both ends. */
static int look_before(mps_stage *s)
{
    const mps_view *v = s->view;
    for (int64_t i = 0; i < v->n; i++) {
        double velocity[3], *x = seen.x[v->id[i]], *u = seen.velocity[v->id[i]];
        if (v->kind[i] == MPS_FLUID) continue;
        mps_view_tank(v, v->x + i * v->dim, NULL, velocity);
        for (int d = 0; d < v->dim; d++) {
            const double now = v->x[i * v->dim + d], dt = v->t - seen.t;
            if (seen.before > 0) ASSERT_NEAR((now - x[d]) / dt, (u[d] + velocity[d]) / 2, 1e-4);
            x[d] = now;
            u[d] = velocity[d];
        }
    }
    seen.t = v->t;
    seen.before++;
    return 0;
}

static void test_tank_that_surges_and_turns(void **state)
{
    static const mps_use uses[] = {{"velocity", MPS_USE_READ}};
    static const mps_verb verbs[] = {
        {.hook = MPS_LIMIT, .run = look_before},
        {.hook = MPS_FORCE, .use_count = 1, .uses = uses, .run = look}};
    static const mps_model_ops ops = {.struct_size = sizeof ops,
                                      .api = MPS_MODEL_API,
                                      .name = "look.tank",
                                      .help = "looks at the tank",
                                      .verb_count = 2,
                                      .verbs = verbs};
    const mps_harmonic motion[2] = {{.dof = MPS_MOVE_X, .amplitude = 0.05, .omega = 9},
                                    {.dof = MPS_ROTATE_Z, .amplitude = 0.2, .omega = 7}};
    mps_sim *sim = new_sim(2, 0.05);
    (void)state;
    add_tank(sim, 0.6, 0.6, 0);
    fill_depth(sim, 0.6, 0.3, 0);
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 2, motion));
    ASSERT_OK(sim, mps_model_register(sim, &ops));
    ASSERT_OK(sim, mps_model_use(sim, "look.tank"));
    for (int k = 0; k < 20; k++) ASSERT_OK(sim, mps_step(sim, 1, NULL));
    assert_true(seen.steps == 20 && seen.before == 20);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_tank_that_surges_and_turns)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

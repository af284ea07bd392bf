/* SPDX-License-Identifier: BSD-3-Clause */
/* mps_stage_tank(): at solids it gives the velocity of the solid and a place that never changes. */
#include "tank_fixture.h"
#include <mps/model.h>

/* First places of the solids by id, and how many steps were looked at. */
static struct {
    double place[4000][3];
    int steps;
} seen;

static int look(mps_stage *s)
{
    const double *u = s->data[0];
    for (int64_t i = 0; i < s->n; i++) {
        double place[3], velocity[3], *first = seen.place[s->id[i]];
        mps_stage_tank(s, s->x + i * s->dim, place, velocity);
        mps_stage_tank(s, s->x + i * s->dim, NULL, NULL);
        if (s->kind[i] == MPS_FLUID) continue;
        for (int d = 0; d < s->dim; d++) {
            ASSERT_NEAR(velocity[d], u[i * s->dim + d], 1e-10);
            if (seen.steps == 0) first[d] = place[d];
            ASSERT_NEAR(place[d], first[d], 1e-12);
        }
    }
    seen.steps++;
    return 0;
}

/* Before the step the velocity is that of the motion. */
static int look_before(mps_stage *s)
{
    double place[3], velocity[3];
    mps_stage_tank(s, s->x, place, velocity);
    assert_true(isfinite(velocity[0]) && isfinite(place[0]));
    return 0;
}

static void test_tank_that_surges_and_turns(void **state)
{
    static const mps_use uses[] = {{"velocity", MPS_USE_READ}};
    static const mps_verb verbs[] = {
        {.moment = MPS_LIMIT, .run = look_before},
        {.moment = MPS_FORCE, .use_count = 1, .uses = uses, .run = look}};
    static const mps_model_ops ops = {.struct_size = sizeof ops,
                                      .api = MPS_MODEL_API,
                                      .name = "look.tank",
                                      .help = "looks at the tank",
                                      .verb_count = 2,
                                      .verbs = verbs};
    const mps_harmonic motion[2] = {{.dof = MPS_SURGE, .amplitude = 0.05, .omega = 9},
                                    {.dof = MPS_YAW, .amplitude = 0.2, .omega = 7}};
    mps_sim *sim = new_sim(2, 0.05);
    (void)state;
    add_tank(sim, 0.6, 0.6, 0);
    fill_depth(sim, 0.6, 0.3, 0);
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 2, motion));
    ASSERT_OK(sim, mps_model_register(sim, &ops));
    ASSERT_OK(sim, mps_model_use(sim, "look.tank"));
    for (int k = 0; k < 20; k++) ASSERT_OK(sim, mps_step(sim, 1, NULL));
    assert_int_equal(seen.steps, 20);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_tank_that_surges_and_turns)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

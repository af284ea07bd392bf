/* SPDX-License-Identifier: BSD-3-Clause */
/* The checked build: a verb that writes undeclared arrays fails with the names of its model and of
 * the channel; values of a step are cleared at its end. */
#include "model_fixture.h"
#include <stdio.h>

static struct {
    double *heat; /* the array, kept beyond the step */
    int thief;    /* index of the undeclared array that the verb writes; -1: none */
} test;

static const mps_channel heat[] = {
    {"heat", "J", "a quantity of a step", 1, MPS_TYPE_REAL, MPS_LIFE_STEP, 1},
    {"age", "s", "a quantity of a particle", 1, MPS_TYPE_REAL, MPS_LIFE_PARTICLE, 0}};

enum { HEAT, AGE, REGION, VELOCITY, PRESSURE, DEVIATION, MINE, ARRAYS };
static const mps_use sees[ARRAYS] = {
    [HEAT] = {"heat", MPS_USE_CHANGE},       [AGE] = {"age", MPS_USE_READ},
    [REGION] = {"region", MPS_USE_READ},     [VELOCITY] = {"velocity", MPS_USE_READ},
    [PRESSURE] = {"pressure", MPS_USE_READ}, [DEVIATION] = {"volume_deviation", MPS_USE_READ},
    [MINE] = {"mine", MPS_USE_READ}};
/* Pointers that an earlier verb has kept. */
static void *seen[ARRAYS];

static int look(mps_stage *s)
{
    for (int k = 0; k < ARRAYS; k++) seen[k] = s->data[k];
    test.heat = s->data[HEAT];
    for (int64_t i = 0; i < s->view->n; i++) test.heat[i] = 2;
    return 0;
}

/* Writes row 5 of an array that it has no right to. */
static int steal(mps_stage *s)
{
    if (test.thief < 0) return 0;
    assert_true(s->view->n > 5);
    if (test.thief == REGION)
        ((int32_t *)seen[REGION])[5] ^= 1;
    else
        ((double *)seen[test.thief])[5] += 1;
    return 0;
}

/* A declared write. */
static int take(mps_stage *s)
{
    double *given = s->data[0];
    given[5] += 1;
    return 0;
}

static const mps_verb look_verbs[] = {
    {.hook = MPS_CLASSIFY, .use_count = ARRAYS, .uses = sees, .after = "*", .run = look}};
static const mps_use reads_heat[] = {{"heat", MPS_USE_NEIGHBOURS}};
static const mps_verb steal_verbs[] = {
    {.hook = MPS_FORCE, .use_count = 1, .uses = reads_heat, .run = steal}};
static const mps_use writes_heat[] = {{"heat", MPS_USE_WRITE}};
static const mps_verb take_verbs[] = {
    {.hook = MPS_SOURCE, .use_count = 1, .uses = writes_heat, .run = take}};
static const mps_model_ops looker = {TOY("looker.toy", 1, look_verbs), .channel_count = 2,
                                     .channels = heat};
static const mps_model_ops thief = {TOY("thief.toy", 1, steal_verbs)};
static const mps_model_ops taker = {TOY("taker.toy", 1, take_verbs)};

static mps_sim *scene(void)
{
    memset(&test, 0, sizeof test);
    test.thief = -1;
    mps_sim *sim = row_sim(2);
    ASSERT_OK(sim, mps_field_add(sim, "mine", 1));
    use_model(sim, &looker);
    use_model(sim, &thief);
    use_model(sim, &taker);
    return sim;
}

/* Channels of a step, of particles, of the library, and a field of the user. */
static void undeclared_writes(void **state)
{
    (void)state;
    mps_sim *sim = scene();
    char name[64];
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    for (test.thief = 0; test.thief < ARRAYS; test.thief++) {
        ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, "model 'thief.toy'");
        snprintf(name, sizeof name, "wrote '%s' of particle", sees[test.thief].channel);
        ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, name);
        ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, "hook 'force'");
        if (strstr(mps_sim_error(sim), "taker.toy") || strstr(mps_sim_error(sim), "looker.toy"))
            fail_msg("'%s' names another model", mps_sim_error(sim));
    }
    test.thief = -1;
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    mps_sim_destroy(sim);
}

/* Undeclared writes to velocity or pressure are undone with the failed step. */
static void state_after_it(void **state)
{
    (void)state;
    mps_sim *sim = scene();
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    test.thief = VELOCITY;
    ASSERT_STATUS(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN);
    for (int64_t id = 0; id < 8; id++) assert_true(field_value(sim, "velocity", id, 0) == 0);
    test.thief = PRESSURE;
    ASSERT_STATUS(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN);
    for (int64_t id = 0; id < 8; id++) assert_true(field_value(sim, "pressure", id, 0) == 0);
    mps_sim_destroy(sim);
}

/* Between two steps an array of MPS_LIFE_STEP has no valid values. */
static void nothing_outlives_its_step(void **state)
{
    (void)state;
    mps_sim *sim = scene();
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    for (int64_t i = 0; i < 8; i++) assert_true(isnan(test.heat[i]));
    for (int64_t i = 0; i < 8; i++) assert_true(isnan(((double *)seen[DEVIATION])[i]));
    assert_true(field_value(sim, "age", 3, 0) == 0);
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(undeclared_writes),
                                       cmocka_unit_test(state_after_it),
                                       cmocka_unit_test(nothing_outlives_its_step)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers of a model that belong to no particle: kept from step to step, in checkpoints, restored
 * after a failed step, removed with the model. */
#define _POSIX_C_SOURCE 200809L
#include "checkpoint_fixture.h"
#include "model_fixture.h"
#include <stdbool.h>

/* What the toy does besides counting. */
static struct {
    bool fails, spoils;
    int64_t had; /* numbers before the last call of the first verb */
    bool refused;
} toy;

/* The number of values changes from step to step; value k gets k + 1 more in each step. */
static int count_steps(mps_stage *s)
{
    const int64_t count = 2 + s->step % 5;
    int64_t now = -1;
    mps_stage_state_get(s, &toy.had);
    double *value = mps_stage_state(s, count);
    if (!value) return 1;
    for (int64_t k = 0; k < count; k++) value[k] += (double)(k + 1);
    const double *same = mps_stage_state_get(s, &now);
    return now != count || same != value;
}

/* Another verb of the model sees the same numbers. */
static int look_again(mps_stage *s)
{
    int64_t count = 0;
    const double *value = mps_stage_state_get(s, &count);
    if (count != 2 + s->step % 5 || value[1] < 2) return mps_stage_fail(s, "numbers are lost");
    if (toy.spoils) mps_stage_state(s, count)[1] = NAN;
    return toy.fails ? mps_stage_fail(s, "as wanted") : 0;
}

static int ask_too_early(mps_stage *s)
{
    int64_t count = -1;
    mps_stage_state_get(s, &count);
    if (!toy.refused) return 0;
    return mps_stage_state(s, count) == NULL;
}

static const mps_verb verbs[] = {{.hook = MPS_POPULATE, .run = ask_too_early},
                                 {.hook = MPS_PREPARE, .run = count_steps},
                                 {.hook = MPS_SHIFT, .run = look_again}};
static const mps_model_ops ops = {TOY("count.steps", 3, verbs)};

static mps_sim *counting(void)
{
    mps_sim *sim = shaken();
    memset(&toy, 0, sizeof toy);
    use_model(sim, &ops);
    return sim;
}

/* Numbers after so many steps, by hand. */
static int64_t expected(int64_t steps, double value[6])
{
    int64_t had = 0;
    for (int64_t s = 1; s <= steps; s++) {
        const int64_t count = 2 + s % 5;
        for (int64_t k = had; k < count; k++) value[k] = 0;
        for (int64_t k = 0; k < count; k++) value[k] += (double)(k + 1);
        had = count;
    }
    return had;
}

static void expect_numbers(mps_sim *sim, int64_t steps)
{
    double wanted[6] = {0};
    const double *value = NULL;
    int64_t count = -1;
    ASSERT_OK(sim, mps_model_state(sim, "count", &value, &count));
    assert_int_equal(count, expected(steps, wanted));
    for (int64_t k = 0; k < count; k++) assert_true(value[k] == wanted[k]);
}

static void test_kept(void **state)
{
    mps_sim *sim = counting();
    (void)state;
    expect_numbers(sim, 0);
    for (int64_t k = 1; k <= 12; k++) {
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        expect_numbers(sim, k);
    }
    ASSERT_OK(sim, mps_model_remove(sim, "count"));
    const double *value;
    int64_t count;
    ASSERT_REFUSED(sim, mps_model_state(sim, "count", &value, &count), MPS_E_NAME, "count");
    ASSERT_OK(sim, mps_model_use(sim, "count.steps"));
    expect_numbers(sim, 0);
    mps_sim_destroy(sim);
}

static void test_failed_step(void **state)
{
    mps_sim *sim = counting();
    (void)state;
    toy.fails = true;
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, "as wanted");
    expect_numbers(sim, 0);
    toy.fails = false;
    for (int64_t k = 1; k <= 9; k++) {
        toy.fails = toy.spoils = false;
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        expect_numbers(sim, k);
        toy.fails = true;
        ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, "as wanted");
        expect_numbers(sim, k);
        toy.fails = false;
        toy.spoils = true;
        ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, "left number 1 of its state");
        expect_numbers(sim, k);
    }
    toy.spoils = false;
    toy.refused = true;
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, "MPS_POPULATE");
    expect_numbers(sim, 9);
    mps_sim_destroy(sim);
}

static void test_checkpoint(void **state)
{
    char path[PATH];
    mps_sim *sim = counting(), *other;
    (void)state;
    for (int k = 0; k < 7; k++) ASSERT_OK(sim, mps_step(sim, 1, NULL));
    ASSERT_OK(sim, mps_checkpoint_write(sim, path_of(path, "numbers")));
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    ASSERT_OK(sim, mps_checkpoint_read(sim, path)); /* back in the same simulation */
    expect_numbers(sim, 7);
    mps_sim_destroy(sim);
    other = counting();
    for (int k = 0; k < 3; k++) ASSERT_OK(other, mps_step(other, 1, NULL));
    ASSERT_OK(other, mps_checkpoint_read(other, path));
    expect_numbers(other, 7);
    ASSERT_OK(other, mps_step(other, 1, NULL));
    assert_int_equal(toy.had, 2 + 7 % 5);
    expect_numbers(other, 8);
    mps_sim_destroy(other);
    other = shaken(); /* without the model */
    ASSERT_REFUSED(other, mps_checkpoint_read(other, path), MPS_E_ARG, "model count.steps");
    mps_sim_destroy(other);
}

static void test_none_yet(void **state)
{
    char path[PATH];
    mps_sim *sim = counting();
    (void)state;
    ASSERT_OK(sim, mps_checkpoint_write(sim, path_of(path, "none")));
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    expect_numbers(sim, 1);
    ASSERT_OK(sim, mps_checkpoint_read(sim, path));
    expect_numbers(sim, 0);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_kept), cmocka_unit_test(test_failed_step),
        cmocka_unit_test(test_checkpoint), cmocka_unit_test(test_none_yet)};
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

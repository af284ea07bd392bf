/* SPDX-License-Identifier: BSD-3-Clause */
/* When dummies have rows: models that declare it, and programs that request a stencil. */
#include "tank_fixture.h"
#include "../tags.h"
#include <mps/model.h>
#include <stdbool.h>

static const double dp = 0.05;

/* What a verb saw of near rows. */
typedef struct sight {
    int64_t calls, dummies, with_row, in_fluid_rows,
        beside; /* beside: fluid with a dummy as neighbour, by mps_stage_adjacent() */
} sight;
static sight seen;

static int look(mps_stage *s)
{
    const mps_view *v = s->view;
    int32_t *member = mps_stage_scratch_integers(s, v->n),
            *beside = mps_stage_scratch_integers(s, v->n);
    if (!member || !beside) return 1;
    seen = (sight){.calls = seen.calls + 1};
    for (int64_t i = 0; i < v->n; i++) {
        const bool dummy = v->kind[i] == MPS_DUMMY, fluid = v->kind[i] == MPS_FLUID;
        bool any = false;
        member[i] = dummy;
        for (int64_t p = v->near.begin[i]; p < v->near.end[i]; p++)
            any = any || v->kind[v->near.col[p]] == MPS_DUMMY;
        seen.dummies += dummy;
        seen.with_row += dummy && v->near.end[i] > v->near.begin[i];
        seen.in_fluid_rows += fluid && any;
    }
    mps_stage_adjacent(s, member, beside);
    for (int64_t i = 0; i < v->n; i++) seen.beside += v->kind[i] == MPS_FLUID && beside[i];
    return 0;
}

static const mps_use plain_uses[] = {{"density", MPS_USE_NEIGHBOURS}},
                     dummy_uses[] = {{"density", MPS_USE_DUMMIES}};
static const mps_verb plain_verbs[] = {
    {.hook = MPS_PREPARE, .use_count = 1, .uses = plain_uses, .run = look}};
static const mps_verb dummy_verbs[] = {
    {.hook = MPS_PREPARE, .use_count = 1, .uses = dummy_uses, .run = look}};

static mps_model_ops model(const char *name, const mps_verb *verbs)
{
    return (mps_model_ops){.struct_size = sizeof(mps_model_ops),
                           .api = MPS_MODEL_API,
                           .name = name,
                           .help = "counts rows of dummies",
                           .verb_count = 1,
                           .verbs = verbs};
}

static mps_sim *pool(void)
{
    const mps_model_ops plain = model("look.plain", plain_verbs),
                        dummies = model("look.dummies", dummy_verbs);
    mps_sim *sim = new_sim(2, dp);
    ASSERT_OK(sim, mps_model_register(sim, &plain));
    ASSERT_OK(sim, mps_model_register(sim, &dummies));
    add_tank(sim, 0.5, 0.5, 0);
    fill_depth(sim, 0.5, 0.3, 0);
    return sim;
}

static sight step_with(mps_sim *sim, const char *name)
{
    ASSERT_OK(sim, mps_model_use(sim, name));
    seen = (sight){0};
    ASSERT_OK(sim, mps_step(sim, 1e-4, NULL));
    assert_int_equal(seen.calls, 1);
    assert_true(seen.dummies > 50 && seen.in_fluid_rows > 10);
    assert_int_equal(seen.beside, seen.in_fluid_rows);
    return seen;
}

/* The active model decides in each step, also while the candidates of a search remain valid. */
static void models_decide(void **state)
{
    (void)state;
    mps_sim *sim = pool();
    assert_int_equal(step_with(sim, "look.plain").with_row, 0);
    const sight all = step_with(sim, "look.dummies");
    assert_true(all.with_row > 20 &&
                all.with_row < all.dummies); /* not those far above the water */
    assert_int_equal(step_with(sim, "look.dummies").with_row, all.with_row);
    assert_int_equal(step_with(sim, "look.plain").with_row, 0);
    ASSERT_OK(sim, mps_model_use(sim, "wall.extrapolate"));
    assert_true(step_with(sim, "look.plain").with_row > 20);
    mps_sim_destroy(sim);
}

/* The order of the particles and the results do not depend on the existing rows. */
static void same_flow(void **state)
{
    (void)state;
    mps_sim *sim[2] = {pool(), pool()};
    mps_lease x[2] = {{.struct_size = sizeof x[0]}, {.struct_size = sizeof x[1]}};
    for (int k = 0; k < 30; k++) {
        step_with(sim[0], "look.plain");
        step_with(sim[1], k % 3 ? "look.dummies" : "look.plain");
    }
    for (int k = 0; k < 2; k++)
        ASSERT_OK(sim[k], mps_lease_begin(sim[k], "position", MPS_READ, &x[k]));
    assert_int_equal(x[0].count, x[1].count);
    assert_memory_equal(x[0].data, x[1].data, (size_t)(x[0].count * 2) * sizeof(double));
    for (int k = 0; k < 2; k++) {
        ASSERT_OK(sim[k], mps_lease_end(sim[k], &x[k]));
        mps_sim_destroy(sim[k]);
    }
}

/* A program gets all rows. */
static void stencil_is_complete(void **state)
{
    (void)state;
    const int32_t *kinds;
    mps_sim *sim = pool();
    step_with(sim, "look.plain");
    for (int which = 0; which < 2; which++) {
        mps_stencil t = {.struct_size = sizeof t};
        ASSERT_OK(sim, mps_stencil_get(sim, which, &t));
        ASSERT_OK(sim, tags_peek(sim, NULL, &kinds, NULL, NULL));
        for (int64_t i = 0; i < t.n; i++)
            assert_true(kinds[i] != MPS_DUMMY || t.end[i] - t.begin[i] >= 3);
    }
    assert_int_equal(step_with(sim, "look.plain").with_row, 0);
    mps_sim_destroy(sim);
}

/* Dummies keep the number density of the set-up. */
static void number_density_stays(void **state)
{
    (void)state;
    const int32_t *kinds;
    mps_lease n = {.struct_size = sizeof n};
    mps_sim *sim = pool();
    for (int k = 0; k < 3; k++) step_with(sim, "look.plain");
    ASSERT_OK(sim, tags_peek(sim, NULL, &kinds, NULL, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, "number_density", MPS_READ, &n));
    for (int64_t i = 0; i < n.count; i++) assert_true(n.data[i] > 0);
    ASSERT_OK(sim, mps_lease_end(sim, &n));
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(models_decide),
        cmocka_unit_test(same_flow),
        cmocka_unit_test(stencil_is_complete),
        cmocka_unit_test(number_density_stays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

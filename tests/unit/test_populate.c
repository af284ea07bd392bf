/* SPDX-License-Identifier: BSD-3-Clause */
/* Inflow, outflow and bodies moved by models: costs, the budget, checkpoints. */
#include "sim.h"
#include "model_fixture.h"
#include <stdio.h>

static const double dp = 0.05, top = 0.8, speed = 1.0;

/* ---- models ---------------------------------------------------------------------------------- */

/* Three particles in each step, above one another by their fall until the next ones. */
static int add_three(mps_stage *s)
{
    double x[6], u[6];
    for (int k = 0; k < 3; k++) {
        x[2 * k] = 0.2 + k * dp;
        x[2 * k + 1] = top;
        u[2 * k] = 0;
        u[2 * k + 1] = -speed;
    }
    return mps_stage_add(s, 0, 3, x, u);
}

static int remove_none(mps_stage *s)
{
    const int32_t *leaves = mps_stage_scratch_integers(s, s->view->n);
    return !leaves || mps_stage_remove(s, leaves);
}

/* Three particles are added, and water above the line is removed, in two calls. */
static int come_and_go(mps_stage *s)
{
    for (int half = 0; half < 2; half++) {
        int32_t *leaves = mps_stage_scratch_integers(s, s->view->n);
        if (!leaves) return 1;
        for (int64_t i = 0; i < s->view->n; i++) /* solids remain in any case */
            leaves[i] = s->view->x[2 * i + 1] > 0.17 && (s->view->x[2 * i] < 0.3) == (half == 0);
        if (mps_stage_remove(s, leaves)) return 1;
    }
    return add_three(s);
}

static bool refuses; /* the verb below */
static int refuse_if_told(mps_stage *s)
{
    return refuses ? mps_stage_fail(s, "as the test wants it") : 0;
}

/* What mps_stage_add() and mps_stage_remove() refuse. */
static int wrong;
static int call_wrongly(mps_stage *s)
{
    const double x[2] = {0.2, top}, nowhere[2] = {0.2, NAN};
    switch (wrong) {
    case 0:
        return mps_stage_add(s, 7, 1, x, x);
    case 1:
        return mps_stage_add(s, -1, 1, x, x);
    case 2:
        return mps_stage_add(s, 0, -1, x, x);
    case 3:
        return mps_stage_add(s, 0, 1, NULL, x);
    case 4:
        return mps_stage_add(s, 0, 1, x, NULL);
    case 5:
        return mps_stage_add(s, 0, 1, nowhere, x);
    case 6:
        return mps_stage_add(s, 0, 1, x, nowhere);
    default:
        return mps_stage_remove(s, NULL);
    }
}
static int add_late(mps_stage *s)
{
    const double x[2] = {0.2, top};
    return mps_stage_add(s, 0, 1, x, x);
}
static int remove_late(mps_stage *s)
{
    return mps_stage_remove(s, s->view->kind);
}

typedef struct place_fields {
    double *place;
} place_fields;

/* All solids move up in the tank by 0.1 m/s: walls keep their distances. */
MPS_ROW void lift(const int dim, const mps_view *v, const place_fields *f, int64_t i)
{
    if (v->kind[i] != MPS_FLUID) f->place[i * dim + 1] += 0.1 * v->dt;
}
MPS_ROWS(lift_rows, lift, place_fields)

static int move_up(mps_stage *s)
{
    mps_stage_rows(s, &lift_rows, &(place_fields){s->data[0]});
    return 0;
}

static const mps_use place_uses[] = {{"solid_place", MPS_USE_CHANGE}},
                     count_uses[] = {{"toy_count", MPS_USE_CHANGE}};
static const mps_verb
    jet_verbs[] = {{.hook = MPS_POPULATE, .run = add_three}},
    none_verbs[] = {{.hook = MPS_POPULATE, .run = remove_none}},
    both_verbs[] = {{.hook = MPS_POPULATE, .run = come_and_go},
                    {.hook = MPS_GRADIENT, .run = refuse_if_told}},
    wrong_verbs[] = {{.hook = MPS_POPULATE, .run = call_wrongly}},
    late_verbs[] = {{.hook = MPS_FORCE, .run = add_late}},
    later_verbs[] = {{.hook = MPS_FORCE, .run = remove_late}},
    count_verbs[] = {{.hook = MPS_POPULATE, .use_count = 1, .uses = count_uses, .run = do_nothing}},
    lift_verbs[] = {{.hook = MPS_MOTION, .use_count = 1, .uses = place_uses, .run = move_up}};
static const mps_channel count_channels[] = {{.name = "toy_count",
                                              .unit = "-",
                                              .help = "a number",
                                              .components = 1,
                                              .type = MPS_TYPE_REAL,
                                              .life = MPS_LIFE_PARTICLE}};
static const mps_model_ops jet = {TOY("jet.toy", 1, jet_verbs)},
                           none = {TOY("none.toy", 1, none_verbs)},
                           both = {TOY("both.toy", 2, both_verbs)},
                           wrongly = {TOY("wrong.toy", 1, wrong_verbs)},
                           late = {TOY("late.toy", 1, late_verbs)},
                           later = {TOY("later.toy", 1, later_verbs)},
                           count = {TOY("count.toy", 1, count_verbs), .channel_count = 1,
                                    .channels = count_channels},
                           lifted = {TOY("lift.toy", 1, lift_verbs)};

/* ---- tests ----------------------------------------------------------------------------------- */

/* A tank with some water; steps in which new particles fall by a spacing. */
static mps_sim *tank_of_water(const mps_model_ops *model)
{
    const double lo[2] = {0, 0}, hi[2] = {0.6, 0.2};
    mps_time_control control;
    mps_sim *sim = new_sim(2, dp);
    add_tank(sim, 0.6, 0.6, 0);
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    if (model) use_model(sim, model);
    assert_int_equal(mps_time_control_init(&control, sizeof control), MPS_OK);
    control.dt = dp / speed / 10;
    ASSERT_OK(sim, mps_time_control_set(sim, &control));
    return sim;
}

static void take_steps(mps_sim *sim, int steps)
{
    for (int k = 0; k < steps; k++) ASSERT_OK(sim, mps_step(sim, 1, NULL));
}

/* Also in the first step, before which there is no fluid. */
static void energy_of_what_came(void **state)
{
    (void)state;
    mps_sim *sim = tank_of_water(&jet);
    mps_energy e;
    assert_int_equal(mps_energy_init(&e, sizeof e), MPS_OK);
    take_steps(sim, 1);
    ASSERT_OK(sim, mps_energy_get(sim, &e));
    const double each = 1000 * dp * dp * (0.5 * speed * speed + 9.81 * top);
    ASSERT_NEAR(e.added, 3 * each, 1e-9 * each);
    mps_sim_destroy(sim);
}

/* A tank whose solids a model moves is not a rigid body. */
static void no_body_with_moved_solids(void **state)
{
    (void)state;
    mps_sim *sim = tank_of_water(&lifted);
    mps_body b;
    assert_int_equal(mps_body_init(&b, sizeof b), MPS_OK);
    b.free = MPS_BODY_FREE(MPS_MOVE_X);
    b.mass = 10;
    ASSERT_OK(sim, mps_body_set(sim, &b));
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_STATE, "a model moves solids in it");
    ASSERT_OK(sim, mps_body_set(sim, NULL));
    take_steps(sim, 2);
    mps_sim_destroy(sim);
}

/* Dummies are linked to their walls once, for any inflow and motion of solids. */
static void walls_are_linked_once(void **state)
{
    (void)state;
    const mps_model_ops *const model[] = {&jet, &lifted};
    for (int k = 0; k < 2; k++) {
        mps_sim *sim = tank_of_water(model[k]);
        take_steps(sim, 1);
        assert_int_equal(sim->world.lists.links, 1);
        take_steps(sim, 5);
        assert_int_equal(sim->world.lists.links, 1);
        mps_sim_destroy(sim);
    }
}

/* The work of solids that move in a tank at rest is in the budget: water is lifted. */
static void work_of_a_moved_body(void **state)
{
    (void)state;
    mps_sim *sim = tank_of_water(&lifted);
    mps_energy e;
    assert_int_equal(mps_energy_init(&e, sizeof e), MPS_OK);
    take_steps(sim, 40);
    ASSERT_OK(sim, mps_energy_get(sim, &e));
    const double u = 0.1, way = u * 40 * dp / speed / 10;
    const double work = e.mass_filled *
                        (9.81 * way + u * u); /* the impulse takes twice its energy */
    ASSERT_NEAR(e.wall_work_momentum, work, 0.05 * work);
    ASSERT_NEAR(e.wall_work_probes, work, 0.05 * work);
    ASSERT_NEAR(e.numerical, 0, 0.15 * work); /* half cells at walls: dp over the length, 0.6 m */
    mps_sim_destroy(sim);
}

static void nothing_to_remove_keeps_the_lists(void **state)
{
    (void)state;
    mps_sim *with = tank_of_water(&none), *without = tank_of_water(NULL);
    take_steps(with, 8);
    take_steps(without, 8);
    assert_int_equal(with->world.lists.orders, without->world.lists.orders);
    assert_true(without->world.lists.orders < 8);
    mps_sim_destroy(with);
    mps_sim_destroy(without);
}

static void same_particles(const mps_sim *a, const mps_sim *b)
{
    const mps__particles *s = &a->world.particles, *r = &b->world.particles;
    assert_int_equal(s->n, r->n);
    assert_int_equal(s->next_id, r->next_id);
    assert_memory_equal(s->id, r->id, (size_t)s->n * sizeof *s->id);
    assert_memory_equal(s->x, r->x, (size_t)(2 * s->n) * sizeof *s->x);
    assert_memory_equal(s->u, r->u, (size_t)(2 * s->n) * sizeof *s->u);
    assert_memory_equal(s->ref, r->ref, (size_t)(2 * s->n) * sizeof *s->ref);
}

static int64_t count_fluid(const mps_sim *sim)
{
    const mps__particles *s = &sim->world.particles;
    int64_t fluid = 0;
    for (int64_t i = 0; i < s->n; i++) fluid += s->kind[i] == MPS_FLUID;
    return fluid;
}

/* In a step: the upper row of 11 is removed first, then particles added one step before; solids
 * remain. */
static void what_comes_and_goes(void **state)
{
    (void)state;
    mps_sim *sim = tank_of_water(&both);
    int64_t fluid = 44;
    refuses = false;
    for (int k = 0; k < 3; k++) {
        const int64_t solid = sim->world.particles.n - count_fluid(sim);
        take_steps(sim, 1);
        fluid += k == 0 ? 3 - 11 : 0;
        assert_int_equal(count_fluid(sim), fluid);
        if (k > 0) assert_int_equal(sim->world.particles.n - fluid, solid);
    }
    mps_sim_destroy(sim);
}

/* A step that fails after inflow and outflow has no effect, also on later steps. */
static void failed_step_brings_fluid_back(void **state)
{
    (void)state;
    mps_sim *a = tank_of_water(&both), *b = tank_of_water(&both);
    for (int k = 0; k < 3; k++) {
        refuses = true;
        ASSERT_REFUSED(a, mps_step(a, 1, NULL), MPS_E_PLUGIN, "as the test wants it");
        if (k > 0) same_particles(a, b); /* before the first step there are no particles */
        refuses = false;
        take_steps(a, 1);
        take_steps(b, 1);
        same_particles(a, b);
    }
    mps_sim_destroy(a);
    mps_sim_destroy(b);
}

static void wrong_calls_of_verbs(void **state)
{
    (void)state;
    static const char *const why[] = {"phase 7 is not defined",
                                      "phase -1 is not defined",
                                      "count is -1, or x or u is NULL",
                                      "count is 1, or x or u is NULL",
                                      "count is 1, or x or u is NULL",
                                      "a position or velocity is not finite",
                                      "a position or velocity is not finite",
                                      "leaves is NULL"};
    mps_sim *sim = tank_of_water(&wrongly);
    for (wrong = 0; wrong < 8; wrong++)
        ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, why[wrong]);
    ASSERT_OK(sim, mps_model_remove(sim, wrongly.name));
    use_model(sim, &late);
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, "call it in 'populate'");
    ASSERT_OK(sim, mps_model_remove(sim, late.name));
    use_model(sim, &later);
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, "mps_stage_remove() was called");
    ASSERT_OK(sim, mps_model_remove(sim, later.name));
    take_steps(sim, 1);
    assert_int_equal(count_fluid(sim), 44);
    mps_sim_destroy(sim);
}

/* A step that failed could not undo it. */
static void channels_are_not_written_before_the_step(void **state)
{
    (void)state;
    mps_sim *sim = tank_of_water(&count);
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_STATE, "toy_count");
    mps_sim_destroy(sim);
}

static void checkpoint_of_a_moved_body(void **state)
{
    (void)state;
    static const char path[] = "test_populate.checkpoint";
    mps_sim *a = tank_of_water(&lifted), *b = tank_of_water(&lifted);
    take_steps(a, 3);
    ASSERT_OK(a, mps_checkpoint_write(a, path));
    ASSERT_OK(b, mps_checkpoint_read(b, path));
    take_steps(a, 3);
    take_steps(b, 3);
    const mps__particles *s = &a->world.particles, *r = &b->world.particles;
    assert_int_equal(s->n, r->n);
    assert_memory_equal(s->x, r->x, (size_t)(2 * s->n) * sizeof *s->x);
    assert_memory_equal(s->ref, r->ref, (size_t)(2 * s->n) * sizeof *s->ref);
    mps_sim_destroy(a);
    mps_sim_destroy(b);
    remove(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(energy_of_what_came),
        cmocka_unit_test(what_comes_and_goes),
        cmocka_unit_test(failed_step_brings_fluid_back),
        cmocka_unit_test(wrong_calls_of_verbs),
        cmocka_unit_test(walls_are_linked_once),
        cmocka_unit_test(no_body_with_moved_solids),
        cmocka_unit_test(work_of_a_moved_body),
        cmocka_unit_test(nothing_to_remove_keeps_the_lists),
        cmocka_unit_test(channels_are_not_written_before_the_step),
        cmocka_unit_test(checkpoint_of_a_moved_body),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* The passes of a step and what they cost. */
#include "model_fixture.h"
#include <stdio.h>

enum { PASSES = 128 };

typedef struct passes {
    int32_t count;
    mps_pass_info pass[PASSES];
} passes;

/* Liquid at rest, in a closed box. */
static mps_sim *tank_of_water(int32_t dim)
{
    mps_sim *sim = new_sim(dim, 0.1);
    add_tank(sim, 1, 1, dim == 3 ? 0.5 : 0);
    assert_true(fill_depth(sim, 1, 0.5, dim == 3 ? 0.5 : 0) > 0);
    return sim;
}

/* Sum of the seconds that the steps report. */
static double take_steps(mps_sim *sim, int steps)
{
    mps_step_info info;
    double seconds = 0;
    assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
    for (int k = 0; k < steps; k++) {
        ASSERT_OK(sim, mps_step(sim, 1, &info));
        for (int stage = 0; stage < MPS_STAGE_COUNT; stage++) seconds += info.seconds[stage];
    }
    return seconds;
}

/* Texts of `uses` are those of the last pass only. */
static passes read_passes(mps_sim *sim)
{
    passes all = {0};
    mps_pass_info p;
    mps_status status;
    assert_int_equal(mps_pass_info_init(&p, sizeof p), MPS_OK);
    while ((status = mps_pass_info_get(sim, all.count, &p)) == MPS_OK) {
        assert_true(all.count < PASSES);
        all.pass[all.count++] = p;
    }
    ASSERT_STATUS(sim, status, MPS_E_ARG);
    return all;
}

static const mps_pass_info *find(const passes *all, const char *name)
{
    for (int32_t k = 0; k < all->count; k++)
        if (!all->pass[k].model && strcmp(all->pass[k].name, name) == 0) return &all->pass[k];
    fail_msg("there is no pass '%s'", name);
    return NULL;
}

/* ---- the list -------------------------------------------------------------------------------- */

/* Passes outside of hooks are listed where they run: after MPS_POPULATE, after MPS_LIMIT, at the
 * end. */
static void check_order(const passes *all)
{
    static const char *const first[] = {"search", "undo", "open"};
    int32_t k = 0, hook = MPS_LIMIT + 1;
    while (all->pass[k].hook == MPS_POPULATE) k++;
    for (int f = 0; f < 3; f++, k++) {
        assert_string_equal(all->pass[k].name, first[f]);
        assert_int_equal(all->pass[k].hook, -1);
    }
    while (all->pass[k].hook == MPS_LIMIT) k++;
    assert_string_equal(all->pass[k].name, "limits");
    assert_int_equal(all->pass[k++].hook, -1);
    for (; k < all->count - 1; k++) {
        assert_true(all->pass[k].hook >= hook && all->pass[k].hook < MPS_HOOK_COUNT);
        hook = all->pass[k].hook;
    }
    assert_string_equal(all->pass[k].name, "commit");
    assert_string_equal(all->pass[k].hook_name, "step");
}

/* A pass of the library has a name of its own. */
static void check_names(const passes *all)
{
    for (int32_t k = 0; k < all->count; k++) {
        const mps_pass_info *p = &all->pass[k];
        assert_true(p->name && p->name[0] && p->hook_name && p->hook_name[0] && p->uses);
        assert_int_equal(p->model, strchr(p->name, '.') != NULL); /* "slot.variant" */
        for (int32_t m = 0; m < k && !p->model; m++)
            assert_string_not_equal(all->pass[m].name, p->name);
    }
}

/* Verbs are the same ones, in the same order, as in their own list. */
static void check_verbs(mps_sim *sim, const passes *all)
{
    int32_t verbs = 0;
    for (int32_t k = 0; k < all->count; k++) {
        char uses[1024];
        mps_verb_info v;
        mps_pass_info p;
        if (!all->pass[k].model) continue;
        assert_int_equal(mps_verb_info_init(&v, sizeof v), MPS_OK);
        assert_int_equal(mps_pass_info_init(&p, sizeof p), MPS_OK);
        ASSERT_OK(sim, mps_pass_info_get(sim, k, &p));
        snprintf(uses, sizeof uses, "%s", p.uses);
        ASSERT_OK(sim, mps_verb_info_get(sim, verbs++, &v));
        assert_string_equal(v.model, p.name);
        assert_string_equal(v.hook_name, p.hook_name);
        assert_string_equal(v.uses, uses);
        assert_int_equal(v.hook, p.hook);
    }
    mps_verb_info beyond;
    assert_int_equal(mps_verb_info_init(&beyond, sizeof beyond), MPS_OK);
    assert_int_equal(mps_verb_info_get(sim, verbs, &beyond), MPS_E_ARG);
    assert_true(verbs > 5);
}

static void list_of_the_presets(void **state)
{
    (void)state;
    static const char *const preset[] = {"imps", "mmps", "imps.paper", "mmps.paper"},
                             *const some[] = {"search", "neighbours", "predict", "matrix",
                                              "solve",  "push",       "move",    "keep"};
    mps_sim *sim = new_sim(2, 0.1);
    for (int k = 0; k < 4; k++) {
        ASSERT_OK(sim, mps_preset_use(sim, preset[k]));
        const passes all = read_passes(sim);
        check_order(&all);
        check_names(&all);
        check_verbs(sim, &all);
        for (size_t s = 0; s < sizeof some / sizeof some[0]; s++) find(&all, some[s]);
        for (int32_t p = 0; p < all.count; p++)
            assert_true(all.pass[p].calls == 0 && all.pass[p].seconds == 0 &&
                        all.pass[p].bytes == 0);
    }
    mps_sim_destroy(sim);
}

/* A pass that is not needed is not run: no rigid body carries the tank. */
static int64_t calls_of(const mps_pass_info *p, int64_t steps)
{
    return strcmp(p->name, "body") == 0 ? 0 : steps;
}

/* They are listed where they run, and their time is not included in other passes. */
static void verbs_before_the_step(void **state)
{
    (void)state;
    static const mps_verb early[] = {{.hook = MPS_LIMIT, .run = do_nothing},
                                     {.hook = MPS_POPULATE, .run = do_nothing}};
    const mps_model_ops mine = {TOY("mine.toy", 2, early)};
    static const char *const first[] = {"mine.toy", "search", "undo", "open", "mine.toy", "limits"};
    mps_sim *sim = tank_of_water(2);
    use_model(sim, &mine);
    const double measured = take_steps(sim, 4);
    const passes all = read_passes(sim);
    double sum = 0;
    check_order(&all);
    check_names(&all);
    check_verbs(sim, &all);
    for (int k = 0; k < 6; k++) assert_string_equal(all.pass[k].name, first[k]);
    for (int32_t k = 0; k < all.count; k++) {
        sum += all.pass[k].seconds;
        assert_int_equal(all.pass[k].calls, calls_of(&all.pass[k], 4));
    }
    ASSERT_NEAR(sum, measured, 1e-6 * measured);
    mps_sim_destroy(sim);
}

/* Uses of the library's passes read as those of verbs. */
static void uses_of_a_pass(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    mps_pass_info p;
    assert_int_equal(mps_pass_info_init(&p, sizeof p), MPS_OK);
    ASSERT_OK(sim, mps_pass_info_get(sim, 0, &p));
    assert_string_equal(p.uses, "");
    for (int32_t k = 0; strcmp(p.name, "predict") != 0; k++)
        ASSERT_OK(sim, mps_pass_info_get(sim, k, &p));
    assert_string_equal(p.uses, "acceleration:r velocity:rw");
    assert_string_equal(p.hook_name, "force");
    mps_sim_destroy(sim);
}

/* Arrays that only the library's passes use are no channels of the list. */
static void channels_of_passes_are_not_listed(void **state)
{
    (void)state;
    static const char *const hidden[] = {"position", "position_before", "unknown_numbers",
                                         "unknown_places"};
    mps_sim *sim = new_sim(2, 0.1);
    mps_channel_info c;
    int32_t own = 0, others = 0;
    assert_int_equal(mps_channel_info_init(&c, sizeof c), MPS_OK);
    for (int32_t k = 0; mps_channel_info_get(sim, k, &c) == MPS_OK; k++) {
        for (int h = 0; h < 4; h++) assert_string_not_equal(c.name, hidden[h]);
        assert_true(c.own ? others == 0 : 1); /* those of the library are first */
        own += c.own;
        others += !c.own;
    }
    assert_true(own >= 18 && others > 0);
    mps_sim_destroy(sim);
}

/* ---- costs ----------------------------------------------------------------------------------- */

/* One clock: what passes cost is what the steps report, to rounding. */
static void costs_add_up(void **state)
{
    (void)state;
    const int steps = 7;
    mps_sim *sim = tank_of_water(2);
    const double measured = take_steps(sim, steps);
    const passes all = read_passes(sim);
    double sum = 0;
    for (int32_t k = 0; k < all.count; k++) {
        const mps_pass_info *p = &all.pass[k];
        if (p->calls != calls_of(p, steps))
            fail_msg("%s: %lld calls", p->name, (long long)p->calls);
        if (!(p->seconds >= 0 && p->bytes >= 0)) fail_msg("%s: %g s", p->name, p->seconds);
        sum += p->seconds;
    }
    ASSERT_NEAR(sum, measured, 1e-6 * measured);
    mps_sim_destroy(sim);
}

static void check_bytes(const passes *all, const char *name, double wanted)
{
    const mps_pass_info *p = find(all, name);
    if (p->bytes != wanted) fail_msg("%s: %.17g bytes instead of %.17g", name, p->bytes, wanted);
}

/* An array that is read and written counts twice. */
static void bytes_of_passes(void **state)
{
    (void)state;
    const int steps = 3;
    for (int32_t dim = 2; dim <= 3; dim++) {
        mps_sim *sim = tank_of_water(dim);
        take_steps(sim, steps);
        const passes all = read_passes(sim);
        const double rows = steps * (double)mps_particles_count(sim, -1), vector = 8.0 * dim,
                     number = 8, integer = 4;
        check_bytes(&all, "predict", rows * (vector + 2 * vector));
        check_bytes(&all, "clear_forces", rows * vector);
        check_bytes(&all, "first_loads", rows * (number + number));
        check_bytes(&all, "first_conditions", rows * (integer + integer));
        check_bytes(&all, "neighbours", 0);
        assert_true(find(&all, "undo")->bytes >= rows * 2 * (vector + number)); /* u, p */
        mps_sim_destroy(sim);
    }
}

static void check_calls(mps_sim *sim, int64_t calls)
{
    const passes all = read_passes(sim);
    for (int32_t k = 0; k < all.count; k++) {
        const mps_pass_info *p = &all.pass[k];
        if (p->calls != calls_of(p, calls))
            fail_msg("%s: %lld calls instead of %lld", p->name, (long long)p->calls,
                     (long long)calls);
        if (calls == 0) assert_true(p->seconds == 0 && p->bytes == 0);
    }
}

/* Other models are another list; another setting is not. */
static void costs_begin_again(void **state)
{
    (void)state;
    mps_sim *sim = tank_of_water(2);
    take_steps(sim, 2);
    check_calls(sim, 2);
    ASSERT_OK(sim, mps_model_set(sim, "collision", "distance", 0.7));
    check_calls(sim, 2);
    ASSERT_OK(sim, mps_model_remove(sim, "shift"));
    check_calls(sim, 0);
    take_steps(sim, 3);
    check_calls(sim, 3);
    ASSERT_OK(sim, mps_profile_reset(sim));
    check_calls(sim, 0);
    take_steps(sim, 1);
    check_calls(sim, 1);
    assert_int_equal(mps_profile_reset(NULL), MPS_E_ARG);
    mps_sim_destroy(sim);
}

/* Of a step that fails the parts that were begun and done count, and the next step adds up
 * again. */
static void failed_step(void **state)
{
    (void)state;
    mps_sim *sim = tank_of_water(2);
    mps_time_control control;
    take_steps(sim, 1);
    assert_int_equal(mps_time_control_init(&control, sizeof control), MPS_OK);
    control.dt_min = 10;
    ASSERT_OK(sim, mps_time_control_set(sim, &control));
    ASSERT_STATUS(sim, mps_step(sim, 1, NULL), MPS_E_DIVERGED);
    const passes failed = read_passes(sim);
    assert_int_equal(find(&failed, "search")->calls, 2);
    assert_int_equal(find(&failed, "predict")->calls, 1);
    assert_int_equal(find(&failed, "commit")->calls, 1);
    control.dt_min = 0;
    ASSERT_OK(sim, mps_time_control_set(sim, &control));
    const double measured = take_steps(sim, 1);
    const passes after = read_passes(sim);
    double sum = 0;
    for (int32_t k = 0; k < after.count; k++) sum += after.pass[k].seconds - failed.pass[k].seconds;
    ASSERT_NEAR(sum, measured, 1e-6 * measured);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(list_of_the_presets), cmocka_unit_test(verbs_before_the_step),
        cmocka_unit_test(uses_of_a_pass),      cmocka_unit_test(channels_of_passes_are_not_listed),
        cmocka_unit_test(costs_add_up),        cmocka_unit_test(bytes_of_passes),
        cmocka_unit_test(costs_begin_again),   cmocka_unit_test(failed_step),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

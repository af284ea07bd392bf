/* SPDX-License-Identifier: BSD-3-Clause */
/* Stepping: a user's model, and failed steps, with a bitwise unchanged state. */
#include "push_fixture.h"

/* ---- scenes ---------------------------------------------------------------------------------- */

static const double drop_places[6] = {0, 0, 1, 0, 0, 1};

/* Three drops far apart, no walls, no gravity. */
static mps_sim *drops(void)
{
    mps_config c;
    mps_sim *sim = NULL;
    mps_particle_block b;
    reset_test();
    assert_int_equal(mps_config_init(&c, sizeof c), MPS_OK);
    c.dp = dp;
    memset(c.gravity, 0, sizeof c.gravity);
    assert_int_equal(mps_sim_create(&c, &sim), MPS_OK);
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = 3;
    b.position = drop_places;
    ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
    return sim;
}

/* ---- a user's model -------------------------------------------------------------------------- */

/* Nothing else acts on the drops: du = a dt, dx = u dt. */
static void acceleration(void **state)
{
    (void)state;
    mps_sim *sim = drops();
    mps_step_info info;
    const double dt = 1e-3;
    assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
    use_push(sim);
    ASSERT_OK(sim, mps_model_set(sim, "test", "acceleration", 3));
    ASSERT_OK(sim, mps_step(sim, dt, &info));
    assert_true(info.dt == dt && info.t == dt && info.step == 1);
    const picture p = take_picture(sim);
    for (int k = 0; k < 3; k++) {
        ASSERT_NEAR(p.value[2000 + 2 * k], 3 * dt, 1e-15);
        ASSERT_NEAR(p.value[2 * k], drop_places[2 * k] + 3 * dt * dt, 1e-15);
        assert_true(p.value[2000 + 2 * k + 1] == 0);
    }
    for (int v = 0; v < VERBS; v++) assert_int_equal(test.calls[v], 1);
    mps_sim_destroy(sim);
    assert_true(test.created == 1 && test.destroyed == 1);
}

/* If any verb fails, the step has no effect, also not on internal state: the run continues like one
 * without a failure. */
static void failing_model(void **state)
{
    (void)state;
    mps_sim *mirror = pool(), *sim = pool();
    char word[64];
    use_push(mirror);
    use_push(sim);
    set_velocity(sim, 150, 0.3, 0.2);
    set_velocity(mirror, 150, 0.3, 0.2);
    for (int v = -1; v < 2 * VERBS; v++) {
        if (v >= 0) {
            const picture before = take_picture(sim);
            test.fail = v % VERBS;
            test.silent = v / VERBS;
            snprintf(word, sizeof word, "the %s is out of order", verb_name[test.fail]);
            ASSERT_REFUSED(sim, mps_step(sim, 0.01, NULL), MPS_E_PLUGIN,
                           test.silent ? "'test.push' failed" : word);
            assert_non_null(strstr(mps_sim_error(sim), "test.push"));
            const picture after = take_picture(sim);
            assert_same(&before, &after);
            test.fail = -1;
        }
        ASSERT_OK(sim, mps_step(sim, 0.01, NULL));
        ASSERT_OK(mirror, mps_step(mirror, 0.01, NULL));
        const picture a = take_picture(sim), b = take_picture(mirror);
        assert_same(&a, &b);
    }
    mps_sim_destroy(sim);
    mps_sim_destroy(mirror);
}

static int surge(void *user, double t, mps_motion_state *state)
{
    (void)user, (void)t;
    state->rate[MPS_MOVE_X] = 0.5;
    state->value[MPS_MOVE_X] = 0.5 * t;
    return 0;
}

/* The liquid gets the tank's velocity in the first step that succeeds, not in one that fails. */
static void values_out_of_range(void **state)
{
    (void)state;
    const int32_t region[] = {-1, 6, 77};
    const double limit[] = {NAN, 0, -1};
    char word[64];
    mps_sim *sim = pool();
    use_push(sim);
    test.victim = 10;
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    const picture before = take_picture(sim);
    for (int k = 0; k < 3; k++) {
        test.region = region[k];
        snprintf(word, sizeof word, "left region %d at particle 10, (", (int)region[k]);
        ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_PLUGIN, word);
        ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_PLUGIN,
                       "model 'test.push' at t = 0.001 s");
        test.region = MPS_REGION_INNER;
        test.dt_limit = limit[k];
        snprintf(word, sizeof word, "allows a step of %g s", limit[k]);
        ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_PLUGIN, word);
        ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_PLUGIN,
                       "model 'test.push' at t = 0.001 s");
        test.dt_limit = INFINITY;
        const picture after = take_picture(sim);
        assert_same(&before, &after);
    }
    test.region = MPS_REGION_DRY; /* the last one */
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    mps_sim_destroy(sim);
}

static double spoilt_density;

static int spoil_density(mps_stage *s)
{
    double *nd = s->data[0];
    nd[place_of(s->view, 10)] = spoilt_density;
    return 0;
}

static const mps_use density_uses[] = {{"number_density", MPS_USE_CHANGE}};
static const mps_verb density_verbs[] = {
    {.hook = MPS_PREPARE, .use_count = 1, .uses = density_uses, .run = spoil_density}};
static const mps_model_ops density_model = {.struct_size = sizeof(mps_model_ops),
                                            .api = MPS_MODEL_API,
                                            .name = "test.density",
                                            .help = "spoils the number density of a particle",
                                            .verb_count = 1,
                                            .verbs = density_verbs};

static void number_density_not_finite(void **state)
{
    (void)state;
    const double value[3] = {NAN, INFINITY, -INFINITY};
    char word[64];
    mps_sim *sim = pool();
    ASSERT_OK(sim, mps_model_register(sim, &density_model));
    ASSERT_OK(sim, mps_model_use(sim, "test.density"));
    spoilt_density = 1;
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    const picture before = take_picture(sim);
    for (int k = 0; k < 3; k++) {
        spoilt_density = value[k];
        snprintf(word, sizeof word, "left the number density %g at particle 10, (", value[k]);
        ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_PLUGIN, word);
        assert_non_null(strstr(mps_sim_error(sim), "model 'test.density' at t = 0.001 s"));
        const picture after = take_picture(sim);
        assert_same(&before, &after);
    }
    spoilt_density = 1;
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    mps_sim_destroy(sim);
}

static void failing_start(void **state)
{
    (void)state;
    const double centre[3] = {0, 0, 0};
    mps_sim *sim = pool();
    use_push(sim);
    ASSERT_OK(sim, mps_motion_centre_set(sim, centre, MPS_START_WITH_TANK));
    ASSERT_OK(sim, mps_motion_callback_set(sim, surge, NULL));
    const picture before = take_picture(sim);
    test.fail = SHIFT;
    ASSERT_STATUS(sim, mps_step(sim, 1e-3, NULL), MPS_E_PLUGIN);
    const picture after = take_picture(sim);
    assert_same(&before, &after);
    test.fail = -1;
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    const picture moving = take_picture(sim);
    for (int64_t id = 0; id < moving.n; id++) ASSERT_NEAR(moving.value[2000 + 2 * id], 0.5, 0.05);
    mps_sim_destroy(sim);
}

static void diverged(void **state)
{
    (void)state;
    char particle[64];
    mps_sim *sim = pool();
    use_push(sim);
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    test.victim = 0;
    while (mps_particle_index(sim, test.victim) < 0 ||
           test.victim < mps_particles_count(sim, -1) - mps_particles_count(sim, MPS_FLUID) + 10)
        test.victim++;
    const picture before = take_picture(sim);
    for (test.spoil = 1; test.spoil <= 4; test.spoil++) {
        snprintf(particle, sizeof particle, "particle %lld at (%g, %g", (long long)test.victim,
                 before.value[2 * test.victim], before.value[2 * test.victim + 1]);
        ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_DIVERGED, particle);
        const picture after = take_picture(sim);
        assert_same(&before, &after);
    }
    test.spoil = 0;
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(acceleration),        cmocka_unit_test(failing_model),
        cmocka_unit_test(values_out_of_range), cmocka_unit_test(number_density_not_finite),
        cmocka_unit_test(failing_start),       cmocka_unit_test(diverged),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

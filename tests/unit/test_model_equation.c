/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers of the pressure equation that a model writes out of their range are refused. */
#include "model_fixture.h"

enum { RADIUS, GAIN, WALL_FACTOR, USES };
static const mps_use uses[USES] = {[RADIUS] = {"equation_radius", MPS_USE_CHANGE},
                                   [GAIN] = {"equation_gain", MPS_USE_CHANGE},
                                   [WALL_FACTOR] = {"equation_wall_factor", MPS_USE_CHANGE}};

static struct {
    int32_t radius;
    double gain, wall_factor;
} left;

static int set_equation(mps_stage *s)
{
    *(int32_t *)s->data[RADIUS] = left.radius;
    *(double *)s->data[GAIN] = left.gain;
    *(double *)s->data[WALL_FACTOR] = left.wall_factor;
    return 0;
}

/* A step with these numbers. */
static mps_status step_with(mps_sim *sim, int32_t radius, double gain, double wall_factor)
{
    left.radius = radius;
    left.gain = gain;
    left.wall_factor = wall_factor;
    return mps_step(sim, 1, NULL);
}

static void refuse_all(mps_sim *sim)
{
    ASSERT_REFUSED(sim, step_with(sim, 2, 1, 0), MPS_E_PLUGIN,
                   "model 'equation.toy' at t = 0.001 s left equation_radius = 2 in the "
                   "pressure equation; "
                   "must be MPS_NEAR or MPS_FAR");
    ASSERT_REFUSED(sim, step_with(sim, -1, 1, 0), MPS_E_PLUGIN, "radius = -1");
    ASSERT_REFUSED(sim, step_with(sim, MPS_FAR, 0, 0), MPS_E_PLUGIN,
                   "gain = 0 in the pressure equation; must be > 0 and <= 1");
    ASSERT_REFUSED(sim, step_with(sim, MPS_FAR, -0.1, 0), MPS_E_PLUGIN, "gain = -0.1");
    ASSERT_REFUSED(sim, step_with(sim, MPS_FAR, 1.01, 0), MPS_E_PLUGIN, "gain = 1.01");
    ASSERT_REFUSED(sim, step_with(sim, MPS_FAR, NAN, 0), MPS_E_PLUGIN, "gain = nan");
    ASSERT_REFUSED(sim, step_with(sim, MPS_FAR, 1, -0.5), MPS_E_PLUGIN,
                   "wall_factor = -0.5 in the pressure equation; must be finite and >= 0");
    ASSERT_REFUSED(sim, step_with(sim, MPS_FAR, 1, NAN), MPS_E_PLUGIN, "wall_factor = nan");
    ASSERT_REFUSED(sim, step_with(sim, MPS_FAR, 1, INFINITY), MPS_E_PLUGIN, "wall_factor = inf");
}

/* In each hook that may change the equation. */
static void equation_out_of_range(void **state)
{
    (void)state;
    const int32_t hooks[] = {MPS_CLASSIFY, MPS_PREPARE, MPS_FORCE, MPS_SOURCE};
    for (size_t m = 0; m < sizeof hooks / sizeof hooks[0]; m++) {
        const mps_verb verbs[] = {
            {.hook = hooks[m], .use_count = USES, .uses = uses, .run = set_equation}};
        const mps_model_ops model = {TOY("equation.toy", 1, verbs)};
        mps_sim *sim = row_sim(2);
        use_model(sim, &model);
        set_field_value(sim, "velocity", 3, 0, 0.25);
        ASSERT_OK(sim, step_with(sim, MPS_FAR, 1, 0));
        const double x = field_value(sim, "position", 3, 0);
        refuse_all(sim);
        assert_true(field_value(sim, "position", 3, 0) == x);
        assert_true(field_value(sim, "velocity", 3, 0) == 0.25);
        ASSERT_OK(sim, step_with(sim, MPS_NEAR, 0.5, 0.5));
        assert_true(field_value(sim, "position", 3, 0) > x);
        mps_sim_destroy(sim);
    }
}

/* A number of the equation has one writer; other models change its value, in any order of
 * registration. */
static void one_owner(void **state)
{
    (void)state;
    static const mps_use owner_uses[] = {{"equation_gain", MPS_USE_WRITE}};
    static const mps_verb owner_verbs[] = {
        {.hook = MPS_CLASSIFY, .use_count = 1, .uses = owner_uses, .run = do_nothing}};
    static const mps_verb changer_verbs[] = {
        {.hook = MPS_CLASSIFY, .use_count = USES, .uses = uses, .run = set_equation}};
    const mps_model_ops changer = {TOY("changer.toy", 1, changer_verbs)},
                        owner = {TOY("owner.toy", 1, owner_verbs)},
                        other = {TOY("other.toy", 1, owner_verbs)};
    mps_sim *sim = row_sim(2);
    use_model(sim, &changer);
    use_model(sim, &owner);
    ASSERT_OK(sim, step_with(sim, MPS_FAR, 1, 0));
    mps_verb_info info;
    mps_verb_info_init(&info, sizeof info);
    int32_t at[2] = {-1, -1};
    for (int32_t k = 0; mps_verb_info_get(sim, k, &info) == MPS_OK; k++) {
        if (strcmp(info.model, "owner.toy") == 0) at[0] = k;
        if (strcmp(info.model, "changer.toy") == 0) at[1] = k;
    }
    assert_true(at[0] >= 0 && at[0] < at[1]);
    use_model(sim, &other);
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_STATE,
                   "models 'owner.toy' and 'other.toy' both write channel 'equation_gain'");
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(equation_out_of_range),
                                       cmocka_unit_test(one_owner)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

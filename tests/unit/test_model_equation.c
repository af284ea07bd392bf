/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers of the pressure equation that a model leaves out of their range are refused. */
#include "model_fixture.h"

static mps_equation left;

static int set_equation(mps_stage *s)
{
    s->equation->radius = left.radius;
    s->equation->gain = left.gain;
    s->equation->wall_factor = left.wall_factor;
    return 0;
}

/* A step with these numbers. */
static mps_status step_with(mps_sim *sim, int32_t radius, double gain, double wall_factor)
{
    left = (mps_equation){.radius = radius, .gain = gain, .wall_factor = wall_factor};
    return mps_step(sim, 1, NULL);
}

static void refuse_all(mps_sim *sim)
{
    ASSERT_REFUSED(sim, step_with(sim, 2, 1, 0), MPS_E_PLUGIN,
                   "model 'equation.toy' at t = 0.001 s left radius = 2 in the pressure equation; "
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

/* In each moment that may change the equation. */
static void equation_out_of_range(void **state)
{
    (void)state;
    const int32_t moments[] = {MPS_CLASSIFY, MPS_PREPARE, MPS_FORCE, MPS_SOURCE};
    for (size_t m = 0; m < sizeof moments / sizeof moments[0]; m++) {
        const mps_verb verbs[] = {{.moment = moments[m], .run = set_equation}};
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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(equation_out_of_range)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

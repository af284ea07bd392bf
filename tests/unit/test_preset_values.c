/* SPDX-License-Identifier: BSD-3-Clause */
/* All values of the presets: models in their order, each with the values of all its settings. A
 * changed default of a model changes a preset, and results with it: change the line here when that
 * is meant. */
#include "tank_fixture.h"
#include <mps/list.h>
#include <stdio.h>

static const struct {
    const char *name, *models;
} presets[] = {
    {"imps", "surface.asymmetry low=0.8 high=0.97 share=0.9 spray=0.25 walls=0 complete=1 "
             "lone=0.6 low_share=0.4 contact=1 contact_low=0.95 contact_share=0.55 film=1.1; "
             "wall.half; "
             "body.free; "
             "moments.bounded floor=0.5 surface=0.4 torn=0; "
             "viscosity.laplacian mirror=1; "
             "dissipation.radial alpha=0.1 beta=1 viscous=1; "
             "source.volume tau=20 clip=0.1 strain=1 gain=0.7 firm=0.03 rapid=0 torn=0.15 "
             "forward=0 pace=1 aside=1 start=5; "
             "separation.void hold=5; "
             "gradient.corrected second_order=0; "
             "load.reaction cover=1; "
             "collision.pair distance=0.6 restitution=0 wall_distance=0.5; "
             "shift.tangential strength=1 limit=0.05 transport=1 filter=0.8 calm=0; "},
    {"imps.paper",
     "surface.asymmetry low=0.8 high=0.97 share=0.9 spray=0 walls=1 complete=0 lone=0.8 "
     "low_share=0.4 contact=0 contact_low=0.95 contact_share=0.55 film=100; "
     "wall.extrapolate; "
     "viscosity.laplacian mirror=0; "
     "source.mixed gamma=0.01; "
     "gradient.conservative; "
     "collision.pair distance=0.9 restitution=0.5 wall_distance=0.5; "},
    {"mmps", "surface.detached spray=0.25; "
             "reference.lid layer=0.5; "
             "wall.half; "
             "moments.bounded floor=0.5 surface=0.4 torn=0.7; "
             "density.interface least=0.1 flat=0.5 foot=0; "
             "viscosity.pair theta=-1 slip=0 stress=1 mirror=1; "
             "dissipation.radial alpha=0.1 beta=1 viscous=1; "
             "tension.jump sigma=0.0727 radius=5.1 threshold=0.02; "
             "source.volume tau=20 clip=0.5 strain=1 gain=0.7 firm=0.03 rapid=3 torn=0.15 "
             "forward=0 pace=1 aside=1 start=5; "
             "gas.compressible phase=1 sound=340 printed=0 conserve=1; "
             "cavitation.vapour least=99000; "
             "gradient.corrected second_order=0; "
             "load.reaction cover=1; "
             "drag.lone company=0.333333333 times=3; "
             "collision.pair distance=0.6 restitution=0 wall_distance=0.5; "
             "shift.tangential strength=1 limit=0.05 transport=1 filter=0.8 calm=0; "},
    {"mmps.paper", "wall.extrapolate; "
                   "density.smooth self=100; "
                   "viscosity.pair theta=-1 slip=0 stress=0 mirror=0; "
                   "tension.csf sigma=0.0727 radius=8.1 threshold=0.02; "
                   "reference.gas phase=1 layer=0.75; "
                   "source.mixed gamma=0.01; "
                   "gas.compressible phase=1 sound=340 printed=1 conserve=1; "
                   "gradient.density; "
                   "collision.pair distance=0.8 restitution=0.5 wall_distance=0.5; "}};

/* The active models with their settings. */
static void describe(mps_sim *sim, char *out, size_t capacity)
{
    mps_setting_info s;
    size_t used = 0;
    const char *name;
    assert_int_equal(mps_setting_info_init(&s, sizeof s), MPS_OK);
    for (int32_t m = 0; (name = mps_model_name(sim, m)); m++) {
        used += (size_t)snprintf(out + used, capacity - used, "%s", name);
        for (int32_t k = 0; mps_setting_info_get(sim, name, k, &s) == MPS_OK; k++)
            used += (size_t)snprintf(out + used, capacity - used, " %s=%.9g", s.key, s.value);
        used += (size_t)snprintf(out + used, capacity - used, "; ");
        assert_true(used < capacity);
    }
}

static void every_value(void **state)
{
    (void)state;
    mps_name_info info;
    mps_sim *sim = new_sim(2, 0.05);
    int32_t count = 0;
    char text[4096];
    assert_int_equal(mps_name_info_init(&info, sizeof info), MPS_OK);
    for (; mps_preset_info_get(sim, count, &info) == MPS_OK; count++) {
        assert_true(count < (int32_t)(sizeof presets / sizeof presets[0]));
        assert_string_equal(info.name, presets[count].name);
        ASSERT_OK(sim, mps_preset_use(sim, info.name));
        describe(sim, text, sizeof text);
        assert_string_equal(text, presets[count].models);
    }
    assert_int_equal(count, sizeof presets / sizeof presets[0]);
    mps_sim_destroy(sim);
}

/* A new simulation has the first of them. */
static void first_preset(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(3, 0.05);
    char text[4096];
    describe(sim, text, sizeof text);
    assert_string_equal(text, presets[0].models);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_value),
                                       cmocka_unit_test(first_preset)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* The presets: their models, and every setting that differs from the default of the model. */
#include "built_in.h"
#include "tank_fixture.h"
#include <mps/model.h>

typedef struct changed {
    const char *model, *key;
    double value;
} changed;

typedef struct wanted {
    const char *preset;
    const char *const *models; /* in the order of a step, NULL after the last */
    const changed *settings;   /* model NULL after the last */
} wanted;

static const char *const imps_models[] = {"surface.asymmetry",
                                          "wall.half",
                                          "body.free",
                                          "moments.bounded",
                                          "viscosity.laplacian",
                                          "dissipation.radial",
                                          "source.volume",
                                          "separation.void",
                                          "gradient.corrected",
                                          "load.reaction",
                                          "collision.pair",
                                          "shift.tangential",
                                          NULL};
static const changed imps_settings[] = {{"collision.pair", "restitution", 0}, {NULL, NULL, 0}};
static const char *const mmps_models[] = {"surface.detached",
                                          "reference.lid",
                                          "wall.half",
                                          "moments.bounded",
                                          "density.interface",
                                          "viscosity.pair",
                                          "dissipation.radial",
                                          "tension.jump",
                                          "source.volume",
                                          "gas.compressible",
                                          "cavitation.vapour",
                                          "gradient.corrected",
                                          "load.reaction",
                                          "drag.lone",
                                          "collision.pair",
                                          "shift.tangential",
                                          NULL};
static const changed mmps_settings[] = {
    {"moments.bounded", "torn", 0.7},     {"viscosity.pair", "stress", 1},
    {"source.volume", "clip", 0.5},       {"source.volume", "rapid", 3},
    {"collision.pair", "restitution", 0}, {NULL, NULL, 0}};
static const char *const paper_models[] = {
    "wall.extrapolate", "density.smooth",   "viscosity.pair",   "tension.csf",    "reference.gas",
    "source.mixed",     "gas.compressible", "gradient.density", "collision.pair", NULL};
static const changed paper_settings[] = {{"viscosity.pair", "mirror", 0},
                                         {"gas.compressible", "printed", 1},
                                         {"collision.pair", "distance", 0.8},
                                         {NULL, NULL, 0}};
static const wanted list[] = {{"imps", imps_models, imps_settings},
                              {"mmps", mmps_models, mmps_settings},
                              {"mmps.paper", paper_models, paper_settings}};

static const mps_model_ops *built_in(const char *name)
{
    for (int k = 0; mps__built_in_models[k]; k++)
        if (strcmp(mps__built_in_models[k]->name, name) == 0) return mps__built_in_models[k];
    return NULL;
}

/* Value of a setting in the preset; counts those that differ from the default. */
static double wanted_value(const changed *settings, const char *model, const mps_setting *s,
                           int *different)
{
    for (const changed *c = settings; c->model; c++)
        if (strcmp(c->model, model) == 0 && strcmp(c->key, s->key) == 0) {
            assert_true(c->value != s->initial); /* otherwise the line of the table has no effect */
            ++*different;
            return c->value;
        }
    return s->initial;
}

static void models_and_settings(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof list / sizeof list[0]; k++) {
        int different = 0, lines = 0;
        mps_sim *sim = new_sim(2, 0.05);
        ASSERT_OK(sim, mps_model_set(sim, "source", "clip",
                                     0.3)); /* of the previous preset: removed with it */
        ASSERT_OK(sim, mps_model_set(sim, "collision", "distance", 0.55));
        ASSERT_OK(sim, mps_preset_use(sim, list[k].preset));
        for (int32_t m = 0; list[k].models[m] || mps_model_name(sim, m); m++) {
            const char *name = mps_model_name(sim, m);
            if (!name || !list[k].models[m] || strcmp(name, list[k].models[m]) != 0)
                fail_msg("%s: model %d is %s instead of %s", list[k].preset, m,
                         name ? name : "none", list[k].models[m] ? list[k].models[m] : "none");
            const mps_model_ops *ops = built_in(name);
            assert_non_null(ops);
            for (int32_t s = 0; s < ops->setting_count; s++) {
                double value = NAN;
                ASSERT_OK(sim, mps_model_get(sim, name, ops->settings[s].key, &value));
                if (value != wanted_value(list[k].settings, name, &ops->settings[s], &different))
                    fail_msg("%s: %s of %s is %g", list[k].preset, ops->settings[s].key, name,
                             value);
            }
        }
        while (list[k].settings[lines].model) lines++;
        assert_int_equal(different, lines); /* every line was met */
        mps_sim_destroy(sim);
    }
}

/* An unknown preset reports the nearest name and keeps the current models. */
static void misspelt(void **state)
{
    (void)state;
    static const char *const names[][2] = {
        {"mmp", "\"mmp\"; did you mean \"mmps\""},
        {"mmsp", "\"mmsp\"; did you mean \"mmps\""},
        {"mmps.papr", "\"mmps.papr\"; did you mean \"mmps.paper\""},
        {"mmps-paper", "\"mmps-paper\"; did you mean \"mmps.paper\""}};
    mps_sim *sim = new_sim(2, 0.05);
    ASSERT_OK(sim, mps_preset_use(sim, "mmps"));
    for (size_t k = 0; k < sizeof names / sizeof names[0]; k++)
        ASSERT_REFUSED(sim, mps_preset_use(sim, names[k][0]), MPS_E_NAME, names[k][1]);
    for (int32_t m = 0; mmps_models[m]; m++)
        assert_string_equal(mps_model_name(sim, m), mmps_models[m]);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(models_and_settings),
                                       cmocka_unit_test(misspelt)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

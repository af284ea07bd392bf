/* SPDX-License-Identifier: BSD-3-Clause */
/* Models of the papers, recomputed particle by particle from their inputs: surface.original,
 * wall.extrapolate. */
#include "tank_fixture.h"
#include <mps/model.h>
#include <stdbool.h>

static const double dp = 0.05;

/* What the verbs below saw in the last step. */
static struct {
    int64_t wrong, surface, inside, dummies;
    double largest; /* pressure of a dummy */
} seen;

static int look_at_regions(mps_stage *s)
{
    const double *density = s->data[0];
    const int32_t *region = s->data[1];
    seen.wrong = seen.surface = seen.inside = 0;
    for (int64_t i = 0; i < s->view->n; i++) {
        if (s->view->kind[i] != MPS_FLUID) continue;
        const bool surface = region[i] == MPS_REGION_SURFACE;
        seen.wrong += surface != (density[i] < 0.9 * s->view->near.n0);
        seen.surface += surface;
        seen.inside += !surface;
    }
    return 0;
}

/* Kernel mean of the pressures of fluid and walls about dummy i. */
static double mean_about(const mps_view *v, const double *pressure, int64_t i)
{
    double sum = 0, weight = 0;
    for (int64_t p = v->near.begin[i]; p < v->near.end[i]; p++) {
        const int32_t j = v->near.col[p];
        if (v->kind[j] == MPS_DUMMY) continue;
        double r2 = 0;
        for (int d = 0; d < v->dim; d++)
            r2 += pow(v->near.x[j * v->dim + d] - v->near.x[i * v->dim + d], 2);
        const double w = mps_kernel_value(&v->near.kernel, sqrt(r2), v->near.re);
        sum += w * pressure[j];
        weight += w;
    }
    return weight > 0 ? sum / weight : 0;
}

static int look_at_dummies(mps_stage *s)
{
    const double *pressure = s->data[0];
    seen.dummies = 0;
    seen.largest = 0;
    for (int64_t i = 0; i < s->view->n; i++) {
        if (s->view->kind[i] != MPS_DUMMY) continue;
        const double wanted = mean_about(s->view, pressure, i);
        ASSERT_NEAR(pressure[i], wanted, 1e-12 * fabs(wanted));
        seen.dummies += pressure[i] != 0;
        seen.largest = fmax(seen.largest, pressure[i]);
    }
    return 0;
}

enum { REGION_USES = 2, PRESSURE_USES = 1 };
static const mps_use region_uses[REGION_USES] = {{"number_density", MPS_USE_READ},
                                                 {"region", MPS_USE_READ}},
                     pressure_uses[PRESSURE_USES] = {
                         {"pressure", MPS_USE_NEIGHBOURS | MPS_USE_DUMMIES}};
static const mps_verb region_verb = {.hook = MPS_CLASSIFY,
                                     .use_count = REGION_USES,
                                     .uses = region_uses,
                                     .after = "*",
                                     .run = look_at_regions},
                      dummy_verb = {.hook = MPS_LEVEL,
                                    .use_count = PRESSURE_USES,
                                    .uses = pressure_uses,
                                    .after = "*",
                                    .run = look_at_dummies};

/* Steps of a column in a tank with the model, which the verb checks. */
static void run_with(const char *preset, const char *model, const char *slot, double setting,
                     const mps_verb *verb)
{
    const mps_model_ops looker = {.struct_size = sizeof(mps_model_ops),
                                  .api = MPS_MODEL_API,
                                  .name = "look.on",
                                  .help = "recomputes another model",
                                  .verb_count = 1,
                                  .verbs = verb};
    mps_sim *sim = new_sim(2, dp);
    ASSERT_OK(sim, mps_preset_use(sim, preset));
    ASSERT_OK(sim, mps_model_use(sim, model));
    if (slot) ASSERT_OK(sim, mps_model_set(sim, slot, "beta", setting));
    ASSERT_OK(sim, mps_model_register(sim, &looker));
    ASSERT_OK(sim, mps_model_use(sim, "look.on"));
    add_tank(sim, 1, 0.8, 0);
    fill_depth(sim, 0.5, 0.5, 0);
    for (int k = 0; k < 3; k++) ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    mps_sim_destroy(sim);
}

/* Z14 (15): below beta n0, fluid and walls alike. */
static void surface_by_number_density(void **state)
{
    (void)state;
    run_with("imps", "surface.original", "surface", 0.9, &region_verb);
    assert_int_equal(seen.wrong, 0);
    assert_in_range(seen.surface, 10, 40);
    assert_in_range(seen.inside, 60, 90);
}

static void dummies_have_the_mean(void **state)
{
    (void)state;
    run_with("imps.paper", "wall.extrapolate", NULL, 0, &dummy_verb);
    assert_in_range(seen.dummies, 20, 60);
    assert_true(seen.largest > 2000 && seen.largest < 6000); /* rho g h = 4900 */
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(surface_by_number_density),
                                       cmocka_unit_test(dummies_have_the_mean)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

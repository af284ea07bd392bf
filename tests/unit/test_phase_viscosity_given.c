/* SPDX-License-Identifier: BSD-3-Clause */
/* viscosity.pair and viscosity.laplacian with the channel "viscosity" of a model: with the values
 * of the phases the same bytes as without it, with twice the values twice the acceleration. */
#include "phase_fixture.h"
#include <math.h>

static double times; /* of the viscosity of the phase */

static int release(mps_stage *s)
{
    const mps_view *v = s->view;
    double *viscosity = s->data[0];
    for (int64_t i = 0; i < v->n; i++) viscosity[i] = times * v->viscosity[v->phase[i]];
    return 0;
}

static const mps_use give_uses[] = {{"viscosity", MPS_USE_CHANGE}};
static const mps_verb give_verbs[] = {
    {.hook = MPS_PREPARE, .use_count = 1, .uses = give_uses, .run = release}};
static const mps_channel give_channels[] = {{.name = "viscosity",
                                             .unit = "Pa s",
                                             .help = "viscosity of each particle",
                                             .components = 1,
                                             .type = MPS_TYPE_REAL,
                                             .life = MPS_LIFE_STEP}};
static const mps_model_ops given = {.struct_size = sizeof(mps_model_ops),
                                    .api = MPS_MODEL_API,
                                    .name = "given.test",
                                    .help = "brings a viscosity",
                                    .verb_count = 1,
                                    .verbs = give_verbs,
                                    .channel_count = 1,
                                    .channels = give_channels};

/* Two fluids in a tank, all particles in motion; accelerations are in spy.a. @return number of
 * values */
static int64_t accelerate(const char *model, int32_t dim, int theta, int slip, double stress)
{
    const double lo[3] = {0}, hi[3] = {0.5, 0.25, 0.4}, top[3] = {0.5, 0.5, 0.4};
    mps_sim *sim = bare_sim(dim, dim == 2 ? 0.05 : 0.1, 3.1, 1e-6);
    set_phase(sim, 0, 1000, 1.0);
    set_phase(sim, 1, 10, 0.02);
    add_tank(sim, 0.5, 0.5, 0.4);
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    ASSERT_OK(sim, mps_fill_box_add(sim, 1, lo, top, NULL, NULL));
    mps_lease u = {.struct_size = sizeof u};
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &u));
    for (int64_t k = 0; k < u.count * u.stride; k++) u.data[k] = sin((double)k);
    ASSERT_OK(sim, mps_lease_end(sim, &u));
    ASSERT_OK(sim, mps_model_use(sim, model));
    if (strcmp(model, "viscosity.pair") == 0) {
        ASSERT_OK(sim, mps_model_set(sim, "viscosity", "theta", theta));
        ASSERT_OK(sim, mps_model_set(sim, "viscosity", "slip", slip));
        ASSERT_OK(sim, mps_model_set(sim, "viscosity", "stress", stress));
    }
    if (times > 0) {
        ASSERT_OK(sim, mps_model_register(sim, &given));
        ASSERT_OK(sim, mps_model_use(sim, "given.test"));
    }
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    const int64_t count = mps_particles_count(sim, -1) * dim;
    mps_sim_destroy(sim);
    return count;
}

static void compare(const char *model, int32_t dim, int theta, int slip, double stress)
{
    times = 0;
    const int64_t n = accelerate(model, dim, theta, slip, stress);
    double *without = cloud_doubles(n), most = 0;
    memcpy(without, spy.a, (size_t)n * sizeof *without);
    for (int64_t k = 0; k < n; k++) most = fmax(most, fabs(without[k]));
    assert_true(n > 100 && most > 1e-4);
    times = 1;
    assert_int_equal(accelerate(model, dim, theta, slip, stress), n);
    assert_memory_equal(spy.a, without, (size_t)n * sizeof *without);
    times = 2;
    accelerate(model, dim, theta, slip, stress);
    for (int64_t k = 0; k < n; k++) ASSERT_NEAR(spy.a[k], 2 * without[k], 1e-12 * most);
    free(without);
}

static void pairs(void **state)
{
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++)
        for (int theta = -1; theta <= 1; theta++)
            for (int slip = 0; slip < (dim == 2 ? 4 : 8); slip += 1 + 2 * (dim == 3))
                compare("viscosity.pair", dim, theta, slip, slip % 2);
}

static void laplacian(void **state)
{
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) compare("viscosity.laplacian", dim, 0, 0, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(pairs), cmocka_unit_test(laplacian)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* surface.detached: spray if several phases fill the space. */
#include "phase_fixture.h"
#include <stdbool.h>

static const double water = 1000;

/* Regions of the particles after a step; phase 0 has the density of water, phase 1 this density
 * over `ratio`. spray < 0: the default. */
static void classify(const cloud *c, const int32_t *phase, double ratio, double spray)
{
    mps_sim *sim = bare_sim(c->dim, CLOUD_DP, 3.1, 1e-6);
    set_phase(sim, 0, water, 0);
    set_phase(sim, 1, water / ratio, 0);
    add_cloud(sim, c, phase, NULL);
    ASSERT_OK(sim, mps_model_use(sim, "surface.detached"));
    if (spray >= 0) ASSERT_OK(sim, mps_model_set(sim, "surface", "spray", spray));
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    mps_sim_destroy(sim);
}

static int64_t spray_count(const cloud *c)
{
    int64_t count = 0;
    for (int64_t i = 0; i < c->n; i++) count += spy.region[i] == MPS_REGION_SPRAY;
    return count;
}

enum { SIDE = 9, MIDDLE = 4 };

static int64_t at(int dim, int x, int y, int z)
{
    return x + SIDE * (y + (dim == 3 ? SIDE * z : 0));
}

/* A block of air with some water in it; free() the phases. */
static cloud air_block(int dim, double jitter, int32_t **phase)
{
    const cloud c = cloud_lattice(dim, SIDE, SIDE, dim == 3 ? SIDE : 1, jitter, 11);
    *phase = cloud_phases(c.n);
    for (int64_t i = 0; i < c.n; i++) (*phase)[i] = 1;
    return c;
}

/* A drop of one particle is spray at 1000 : 1, and no particle is at 1.8 : 1 or where both weigh
 * the same. */
static void lone_drop(void **state)
{
    (void)state;
    static const double ratios[] = {1000, 1.8, 1, 1 / 1.8};
    for (int dim = 2; dim <= 3; dim++)
        for (int k = 0; k < 4; k++) {
            int32_t *phase;
            cloud c = air_block(dim, 0.1, &phase);
            const int64_t drop = at(dim, MIDDLE, MIDDLE, MIDDLE);
            phase[drop] = 0;
            classify(&c, phase, ratios[k], -1);
            assert_int_equal(spray_count(&c), k == 0);
            assert_int_equal(spy.region[drop], k == 0 ? MPS_REGION_SPRAY : MPS_REGION_INNER);
            cloud_free(&c);
            free(phase);
        }
}

/* A triangle of three in 2-D, a cube of eight in 3-D, a layer one particle thick: all of them are
 * in the pressure equation. */
static void together(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++)
        for (int layer = 0; layer < 2; layer++) {
            int32_t *phase;
            cloud c = air_block(dim, layer ? 0.1 : 0, &phase);
            for (int k = 0; k < (dim == 2 ? 3 : 8) && !layer; k++)
                phase[at(dim, MIDDLE + k % 2, MIDDLE + k / 2 % 2, MIDDLE + k / 4)] = 0;
            if (dim == 2 && !layer) { /* all sides of the triangle are dp */
                double *top = c.x + 2 * at(dim, MIDDLE, MIDDLE + 1, 0);
                top[0] += 0.5 * CLOUD_DP;
                top[1] -= (1 - sqrt(0.75)) * CLOUD_DP;
            }
            for (int64_t i = 0; i < c.n && layer; i++)
                if (i / SIDE % SIDE == MIDDLE) phase[i] = 0;
            classify(&c, phase, 1000, -1);
            if (!layer) assert_int_equal(spray_count(&c), 0);
            for (int64_t i = 0; i < c.n;
                 i++) /* at its ends a layer has neighbours on one side only */
                if (cloud_inside(&c, i, (const int[3]){SIDE, SIDE, SIDE}, 2.1 * CLOUD_DP))
                    assert_int_equal(spy.region[i], MPS_REGION_INNER);
            cloud_free(&c);
            free(phase);
        }
}

/* An isolated particle is spray if it is water and air exists. Air never is, nor water without
 * air. */
static void in_a_void(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++)
        for (int kind = 0; kind < 3;
             kind++) { /* water next to air, air next to water, water next to water */
            int32_t *phase;
            cloud c = air_block(dim, 0.1, &phase);
            for (int64_t i = 0; i < c.n; i++) phase[i] = kind == 0;
            phase[0] = kind == 1;
            c.x[0] -= 100 * CLOUD_DP;
            classify(&c, phase, 1000, -1);
            assert_int_equal(spray_count(&c), kind == 0);
            assert_int_equal(spy.region[0] == MPS_REGION_SPRAY, kind == 0);
            cloud_free(&c);
            free(phase);
        }
}

/* Kernel sum by mass over all particles, in n0. */
static double company(const cloud *c, const int32_t *phase, double ratio, int64_t i)
{
    const double re = 2.1 * CLOUD_DP;
    mps_kernel kernel = {.struct_size = sizeof kernel};
    double n0, sum = 0;
    assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
    assert_int_equal(mps_lattice_constants(&kernel, c->dim, CLOUD_DP, re, &n0, NULL), MPS_OK);
    for (int64_t j = 0; j < c->n; j++)
        if (j != i && cloud_distance2(c, i, j) < re * re)
            sum += mps_kernel_value(&kernel, sqrt(cloud_distance2(c, i, j)), re) *
                   (phase[j] == phase[i] ? 1 : fmin(1, 1 / ratio));
    return sum / n0;
}

/* Scattered water: spray is what has less fluid about it than the setting, for any setting and
 * ratio. */
static void to_the_letter(void **state)
{
    (void)state;
    static const double ratios[] = {1000, 8}, sprays[] = {0, 0.1, 0.25, 0.5, 1};
    for (int dim = 2; dim <= 3; dim++)
        for (int r = 0; r < 2; r++) {
            int32_t *phase;
            int64_t before = -1;
            uint64_t seed = 3;
            cloud c = air_block(dim, 0.2, &phase);
            double *sum = cloud_doubles(c.n);
            for (int64_t i = 0; i < c.n; i++) phase[i] = cloud_random(&seed) > -0.4;
            for (int64_t i = 0; i < c.n; i++) sum[i] = company(&c, phase, ratios[r], i);
            for (int k = 0; k < 5; k++) {
                classify(&c, phase, ratios[r], sprays[k]);
                for (int64_t i = 0; i < c.n; i++) {
                    if (fabs(sum[i] - sprays[k]) < 1e-9) continue;
                    assert_int_equal(spy.region[i] == MPS_REGION_SPRAY,
                                     phase[i] == 0 && sum[i] < sprays[k]);
                }
                assert_true(k == 0 ? spray_count(&c) == 0 : spray_count(&c) >= before);
                before = spray_count(&c);
            }
            assert_true(before > c.n / 5); /* at 1 each particle with air about it */
            cloud_free(&c);
            free(phase);
            free(sum);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(lone_drop), cmocka_unit_test(together),
                                       cmocka_unit_test(in_a_void),
                                       cmocka_unit_test(to_the_letter)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

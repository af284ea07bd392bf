/* SPDX-License-Identifier: BSD-3-Clause */
/* friction.sides: its rate against that of the exact flow between two walls, and what it is relative to. */
#include "phase_fixture.h"
#include <complex.h>

static const double NU = 5e-5;

/* A tank of 10 x 10 spacings with liquid in it that moves by u = velocity + rate x r everywhere; only the friction acts. */
static mps_sim *stirred(double width, double omega, double rate, double dt)
{
    const double lo[3] = {0}, hi[3] = {10 * CLOUD_DP, 6 * CLOUD_DP, 0};
    mps_sim *sim = bare_sim(2, CLOUD_DP, 3.1, dt);
    set_phase(sim, 0, 900, 900 * NU);
    add_tank(sim, 10 * CLOUD_DP, 10 * CLOUD_DP, 0);
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    mps_lease x = {.struct_size = sizeof x}, u = {.struct_size = sizeof u};
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &u));
    for (int64_t i = 0; i < u.count; i++) {
        u.data[2 * i] = 0.3 - rate * x.data[2 * i + 1];
        u.data[2 * i + 1] = -0.2 + rate * x.data[2 * i];
    }
    ASSERT_OK(sim, mps_lease_end(sim, &u));
    ASSERT_OK(sim, mps_lease_end(sim, &x));
    ASSERT_OK(sim, mps_model_use(sim, "friction.sides"));
    ASSERT_OK(sim, mps_model_set(sim, "friction", "width", width));
    ASSERT_OK(sim, mps_model_set(sim, "friction", "omega", omega));
    return sim;
}

/* Rate seen by the fluid: a = -rate u; the same for all. */
static double rate_of(mps_sim *sim)
{
    const int64_t *ids;
    const int32_t *kind;
    double rate = -1;
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    ASSERT_OK(sim, tags_peek(sim, &ids, &kind, NULL, NULL));
    for (int64_t i = 0; i < mps_particles_count(sim, -1); i++) {
        if (kind[i] != MPS_FLUID) continue;
        const double one = -spy.a[2 * ids[i]] / 0.3;
        if (rate < 0) rate = one;
        ASSERT_NEAR(one, rate, 1e-12 * rate);
        ASSERT_NEAR(spy.a[2 * ids[i] + 1], 0.2 * rate, 1e-12 * rate);
    }
    return rate;
}

/* The real part of i w [1/(1 - tanh(z)/z) - 1], and both limits. */
static void rates(void **state)
{
    (void)state;
    static const double width[] = {0.002, 0.02, 0.062, 1}, omega[] = {1e-6, 0.5, 3.86, 40};
    for (int w = 0; w < 4; w++)
        for (int o = 0; o < 4; o++) {
            const double complex z = 0.5 * width[w] * csqrt(I * omega[o] / NU);
            const double exact = creal(I * omega[o] * (1 / (1 - ctanh(z) / z) - 1)),
                         slow = 12 * NU / (width[w] * width[w]);
            mps_sim *sim = stirred(width[w], omega[o], 0, 1e-9);
            const double rate = rate_of(sim);
            mps_sim_destroy(sim);
            ASSERT_NEAR(rate / (cabs(z) < 0.07 ? slow : exact), 1, 1e-5);
            if (cabs(z) > 100) ASSERT_NEAR(rate * width[w] / sqrt(2 * omega[o] * NU), 1, 0.03);
        }
    mps_sim *sim = stirred(0.01, 0, 0, 1e-9);
    ASSERT_NEAR(rate_of(sim) / (12 * NU / 1e-4), 1, 1e-5);
    mps_sim_destroy(sim);
    sim = stirred(1e9, 0, 0, 1e-9); /* the default: no side walls */
    assert_true(rate_of(sim) < 1e-20);
    mps_sim_destroy(sim);
}

/* A step takes no more than what there is. */
static void long_step(void **state)
{
    (void)state;
    mps_sim *sim = stirred(1e-4, 0, 0, 1e-3); /* 12 nu/b^2 dt = 60 */
    ASSERT_NEAR(rate_of(sim) * 1e-3, 1, 1e-9);
    mps_sim_destroy(sim);
}

static int turn(void *user, double t, mps_motion_state *s)
{
    s->value[MPS_MOVE_X] = 0.3 * t;
    s->value[MPS_MOVE_Y] = -0.2 * t;
    s->value[MPS_ROTATE_Z] = *(double *)user * t;
    s->rate[MPS_MOVE_X] = 0.3;
    s->rate[MPS_MOVE_Y] = -0.2;
    s->rate[MPS_ROTATE_Z] = *(double *)user;
    return 0;
}

/* Liquid that moves with its tank has no friction. */
static void moves_with_the_tank(void **state)
{
    (void)state;
    double rate = 2;
    mps_sim *sim = stirred(0.01, 0, rate, 1e-6);
    ASSERT_OK(sim, mps_motion_callback_set(sim, turn, &rate));
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    const int64_t *ids;
    const int32_t *kind;
    ASSERT_OK(sim, tags_peek(sim, &ids, &kind, NULL, NULL));
    for (int64_t i = 0; i < mps_particles_count(sim, -1); i++)
        for (int d = 0; d < 2; d++)
            assert_true(kind[i] != MPS_FLUID || fabs(spy.a[2 * ids[i] + d]) < 1e-4 * 6 * 0.3);
    mps_sim_destroy(sim);
}

static void not_in_3d(void **state)
{
    (void)state;
    const double lo[3] = {0}, hi[3] = {0.3, 0.2, 0.3};
    mps_sim *sim = new_sim(3, 0.05);
    add_tank(sim, 0.3, 0.3, 0.3);
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    ASSERT_OK(sim, mps_model_use(sim, "friction.sides"));
    assert_int_equal(mps_step(sim, 1, NULL), MPS_E_PLUGIN);
    assert_non_null(strstr(mps_sim_error(sim), "in 2-D"));
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(rates), cmocka_unit_test(long_step),
                                       cmocka_unit_test(moves_with_the_tank),
                                       cmocka_unit_test(not_in_3d)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

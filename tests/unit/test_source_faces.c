/* SPDX-License-Identifier: BSD-3-Clause */
/* source.volume at interfaces of densities: faces by mass, and the source where the volume is
 * torn. */
#include "phase_fixture.h"
#include <stdbool.h>

static const double DT = 0.02, water = 1000, air = 1.25;

/* Water (phase 0) over a tilted plane below which is air (phase 1), or all of it phase 0; free()
 * the phases. */
static cloud two_layers(int dim, double jitter, int32_t **phase)
{
    const int side = dim == 2 ? 16 : 10;
    const cloud c = cloud_lattice(dim, side, side, dim == 3 ? side : 1, jitter, 21);
    *phase = cloud_phases(c.n);
    for (int64_t i = 0; i < c.n; i++)
        (*phase)[i] = c.x[i * dim] + 0.3 * c.x[i * dim + 1] < 0.65 * side * CLOUD_DP;
    return c;
}

/* spy.rhs of the source alone, nothing relaxed; phase 1 is `ratio` times lighter, `pace` how much
 * of it phase 0 waits for. */
static void source(const cloud *c, const int32_t *phase, double ratio, const double *u,
                   double strain, double pace)
{
    mps_sim *sim = bare_sim(c->dim, CLOUD_DP, 3.1, DT);
    set_phase(sim, 0, water, 0);
    set_phase(sim, 1, water / ratio, 0);
    add_cloud(sim, c, phase, u);
    ASSERT_OK(sim, mps_model_use(sim, "moments.bounded"));
    ASSERT_OK(sim, mps_model_use(sim, "source.volume"));
    ASSERT_OK(sim, mps_model_set(sim, "source", "clip", 0));
    ASSERT_OK(sim, mps_model_set(sim, "source", "strain", strain));
    ASSERT_OK(sim, mps_model_set(sim, "source", "pace", pace));
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    mps_sim_destroy(sim);
}

/* Is M - 0.501 of the faces by mass positive definite, so that its inverse is not bounded? Also
 * returns whether another density is near. */
static bool regular(const cloud *c, const int32_t *phase, double ratio, int64_t i, bool *beside)
{
    const int dim = c->dim;
    const double re = 2.1 * CLOUD_DP, rho[2] = {water, water / ratio};
    double m[3][3] = {{0}}, n0;
    mps_kernel kernel = {.struct_size = sizeof kernel};
    assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
    assert_int_equal(mps_lattice_constants(&kernel, dim, CLOUD_DP, re, &n0, NULL), MPS_OK);
    for (int64_t j = 0; j < c->n; j++) {
        const double r2 = cloud_distance2(c, i, j);
        if (j == i || r2 >= re * re) continue;
        const double share = 2 * rho[phase[j]] / (rho[phase[i]] + rho[phase[j]]);
        *beside = *beside || phase[j] != phase[i];
        for (int d = 0; d < dim; d++)
            for (int e = 0; e < dim; e++)
                m[d][e] += dim / n0 * share * mps_kernel_value(&kernel, sqrt(r2), re) / r2 *
                           (c->x[j * dim + d] - c->x[i * dim + d]) *
                           (c->x[j * dim + e] - c->x[i * dim + e]);
    }
    for (int d = 0; d < dim; d++) m[d][d] -= 0.501;
    const double two = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    const double three = m[2][2] * two - m[2][1] * (m[0][0] * m[1][2] - m[0][2] * m[1][0]) +
                         m[2][0] * (m[0][1] * m[1][2] - m[0][2] * m[1][1]);
    return m[0][0] > 0 && two > 0 && (dim == 2 || three > 0);
}

static bool inside(const cloud *c, int64_t i)
{
    const int side = c->dim == 2 ? 16 : 10;
    return cloud_inside(c, i, (const int[3]){side, side, side}, 2.3 * CLOUD_DP);
}

/* u = A x: the source is -(tr A - dt tr(A A)/2)/dt whichever phases are side by side, on a lattice
 * and on a jittered one. */
static void linear_flow(void **state)
{
    (void)state;
    static const double a[2][9] = {{1.3, 0.4, -2, 0.5},
                                   {1, 0.3, -0.2, 0.5, -2, 0.1, 0.7, 0.2, 1.7}},
                        ratios[] = {1000, 20, 1.8, 1};
    for (int k = 0; k < 16; k++) {
        const int dim = 2 + k / 8;
        const double ratio = ratios[k % 4], *A = a[dim - 2];
        int32_t *phase;
        cloud c = two_layers(dim, k / 4 % 2 ? 0.15 : 0, &phase);
        double *u = cloud_doubles(c.n * dim), trace = 0, square = 0;
        int64_t water_beside = 0, air_beside = 0;
        for (int64_t q = 0; q < c.n * dim; q++)
            for (int e = 0; e < dim; e++) u[q] += A[q % dim * dim + e] * c.x[q / dim * dim + e];
        for (int d = 0; d < dim; d++) {
            trace += A[d * dim + d];
            for (int e = 0; e < dim; e++) square += A[d * dim + e] * A[e * dim + d];
        }
        source(&c, phase, ratio, u, 1, 0);
        for (int64_t i = 0; i < c.n; i++) {
            bool beside = false;
            if (!inside(&c, i) || !regular(&c, phase, ratio, i, &beside)) continue;
            ASSERT_NEAR(-DT * spy.rhs[i], trace - 0.5 * DT * square, 1e-10);
            water_beside += beside && phase[i] == 0;
            air_beside += beside && phase[i] == 1;
        }
        assert_true(air_beside > 10 &&
                    water_beside > 10); /* of heavy ones some at a bent interface are bounded */
        cloud_free(&c);
        free(phase);
        free(u);
    }
}

/* Largest change of the sources of phase `whose` when phase `moved` gets other velocities. */
static double influence(int dim, double ratio, int moved, int whose)
{
    int32_t *phase;
    cloud c = two_layers(dim, 0.15, &phase);
    double *u = cloud_field(c.n * dim, 5), *rhs = cloud_doubles(c.n), most = 0;
    source(&c, phase, ratio, u, 0, 0);
    memcpy(rhs, spy.rhs, (size_t)c.n * sizeof *rhs);
    for (int64_t i = 0; i < c.n; i++)
        for (int d = 0; d < dim && phase[i] == moved; d++)
            u[i * dim + d] = 3 * u[i * dim + d] + (d == 0 ? -5 : 2);
    source(&c, phase, ratio, u, 0, 0);
    for (int64_t i = 0; i < c.n; i++)
        if (inside(&c, i) && phase[i] == whose) most = fmax(most, fabs(spy.rhs[i] - rhs[i]));
    cloud_free(&c);
    free(phase);
    free(u);
    free(rhs);
    return most;
}

/* In the source of water adjacent air has the weight of the ratio of densities; in that of air
 * adjacent water has the weight 1. */
static void water_minds_water(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        const double equal = influence(dim, 1, 1, 0);
        for (double ratio = 100; ratio < 20000; ratio *= 10) {
            const double seen = influence(dim, ratio, 1, 0) / equal,
                         back = influence(dim, ratio, 0, 1) / equal;
            print_message("%d-D, %g: water %.3g / ratio, air %.3g\n", dim, ratio, seen * ratio,
                          back);
            assert_true(seen > 0 && seen < 5 / ratio);
            assert_true(back > 0.5);
        }
    }
}

/* Two phases of one density are one, byte for byte. */
static void equal_densities(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        int32_t *phase;
        cloud c = two_layers(dim, 0.15, &phase);
        double *u = cloud_field(c.n * dim, 5), *rhs = cloud_doubles(c.n);
        source(&c, phase, 1, u, 1, 0);
        memcpy(rhs, spy.rhs, (size_t)c.n * sizeof *rhs);
        memset(phase, 0, (size_t)c.n * sizeof *phase);
        source(&c, phase, 1, u, 1, 0);
        assert_memory_equal(rhs, spy.rhs, (size_t)c.n * sizeof *rhs);
        assert_true(fabs(rhs[c.n / 2]) > 1);
        cloud_free(&c);
        free(phase);
        free(u);
        free(rhs);
    }
}

/* ---- pace of the denser fluid ---------------------------------------------------------------- */

/* Multiply the velocities of one phase. */
static void speed_up(const cloud *c, const int32_t *phase, int of, double factor, double *u)
{
    for (int64_t k = 0; k < c->n * c->dim; k++)
        if (phase[k / c->dim] == of) u[k] *= factor;
}

static double largest(const cloud *c, const int32_t *phase, int of, const double *u)
{
    double most = 0;
    for (int64_t i = 0; i < c->n; i++) {
        double square = 0;
        for (int d = 0; d < c->dim; d++) square += u[i * c->dim + d] * u[i * c->dim + d];
        if (phase[i] == of) most = fmax(most, sqrt(square));
    }
    return most;
}

/* Air that is faster than the water shortens steps by the ratio of speeds, beyond 5 sqrt(g dp): the
 * water gets this fraction of its source, the air all of its own, for any `pace`. Faster water is
 * not accelerated. */
static void water_keeps_its_pace(void **state)
{
    (void)state;
    static const double factors[] = {0.2, 30, 300};
    for (int k = 0; k < 6; k++) {
        const int dim = 2 + k / 3;
        const double calm = 5 * sqrt(9.81 * CLOUD_DP);
        int32_t *phase;
        cloud c = two_layers(dim, 0.15, &phase);
        double *u = cloud_field(c.n * dim, 5), *full = cloud_doubles(c.n);
        speed_up(&c, phase, 1, factors[k % 3], u);
        source(&c, phase, 1000, u, 0, 0);
        memcpy(full, spy.rhs, (size_t)c.n * sizeof *full);
        source(&c, phase, 1000, u, 0, 1);
        const double slow = fmax(largest(&c, phase, 0, u), calm),
                     share = slow / fmax(fmax(slow, largest(&c, phase, 1, u)), calm);
        assert_true(k % 3 == 0 ? share == 1 : share < 0.5);
        for (int64_t i = 0; i < c.n; i++)
            ASSERT_NEAR(spy.rhs[i], (phase[i] == 0 ? share : 1) * full[i], 1e-9 * fabs(full[i]));
        cloud_free(&c);
        free(phase);
        free(u);
        free(full);
    }
}

/* ---- relaxation of the volume ---------------------------------------------------------------- */

/* Source of a particle in a lattice at rest that is off by about `deviation`, which it returns
 * clipped, in the first step. */
static double relaxed(double deviation, double rapid, double start, double dt, double *delta)
{
    cloud c = cloud_lattice(2, 16, 16, 1, 0, 1);
    int32_t *phase = cloud_phases(c.n);
    mps_sim *sim = bare_sim(2, CLOUD_DP, 3.1, dt);
    const int64_t i = 8 * 16 + 8;
    set_phase(sim, 0, water, 0);
    add_cloud(sim, &c, phase, NULL);
    spy.given_deviation = deviation;
    ASSERT_OK(sim, mps_model_use(sim, "moments.bounded"));
    ASSERT_OK(sim, mps_model_use(sim, "source.volume"));
    ASSERT_OK(sim, mps_model_set(sim, "source", "clip", 0.5));
    ASSERT_OK(sim, mps_model_set(sim, "source", "rapid", rapid));
    ASSERT_OK(sim, mps_model_set(sim, "source", "start", start));
    assert_true(mps_step(sim, 1, NULL) >=
                0); /* whether such a pressure converges is of no interest */
    *delta = fmin(fmax(spy.volume[i], -0.5), 0.5);
    mps_sim_destroy(sim);
    cloud_free(&c);
    free(phase);
    return spy.rhs[i];
}

/* 1/tau below `firm`, then up to 1/tau_g; from `torn` on in dp/U over `rapid` besides, U = U_g in
 * fluid at rest: the same rate in every step. */
static void torn_volume(void **state)
{
    (void)state;
    static const double deviations[] = {0.01, -0.02, 0.05, 0.1, 0.15, -0.15,
                                        0.2,  -0.3,  0.5,  3,   -0.9},
                        rapids[] = {0, 0.3, 1};
    const double rate = sqrt(9.81 * CLOUD_DP) / CLOUD_DP, tau = 20, firm = 0.03, torn = 0.15;
    for (int r = 0; r < 3; r++)
        for (double dt = 1e-5; dt < 0.02; dt *= 10)
            for (size_t k = 0; k < sizeof deviations / sizeof deviations[0]; k++) {
                double delta;
                const double got = dt * relaxed(deviations[k], rapids[r], 0, dt, &delta);
                const double slow = fmin((1 + pow(delta / firm, 4)) / tau, 1),
                             fast = rapids[r] * fmin(pow(delta / torn, 4), 1);
                ASSERT_NEAR(delta, fmin(fmax(deviations[k], -0.5), 0.5),
                            0.01 * fabs(deviations[k]));
                ASSERT_NEAR(got / (rate * (slow + fast) * delta), 1, 1e-9);
                assert_true(fabs(got) <= 0.5 * rate * (1 + rapids[r]) * (1 + 1e-9));
            }
}

/* Source, times dt and over the rate of torn gas, in gas at rest next to water that moves at
 * `speed`. */
static double relaxed_beside_water(double speed, double dt)
{
    cloud gas = cloud_lattice(2, 16, 16, 1, 0, 1), liquid = cloud_lattice(2, 4, 4, 1, 0, 1);
    int32_t *phase = cloud_phases(gas.n), *other = cloud_phases(liquid.n);
    double *u = cloud_doubles(2 * liquid.n);
    mps_sim *sim = bare_sim(2, CLOUD_DP, 3.1, dt);
    const int64_t i = 8 * 16 + 8;
    set_phase(sim, 0, water, 0);
    set_phase(sim, 1, air, 0);
    for (int64_t k = 0; k < gas.n; k++) phase[k] = 1;
    for (int64_t k = 0; k < liquid.n; k++) {
        u[2 * k] = speed;
        liquid.x[2 * k] += 40 * CLOUD_DP;
    }
    add_cloud(sim, &gas, phase, NULL);
    add_cloud(sim, &liquid, other, u);
    spy.given_deviation = -0.3;
    ASSERT_OK(sim, mps_model_use(sim, "moments.bounded"));
    ASSERT_OK(sim, mps_model_use(sim, "source.volume"));
    ASSERT_OK(sim, mps_model_set(sim, "source", "tau", 1e6));
    ASSERT_OK(sim, mps_model_set(sim, "source", "clip", 0.5));
    ASSERT_OK(sim, mps_model_set(sim, "source", "rapid", 1));
    ASSERT_OK(sim, mps_model_set(sim, "source", "firm", 1));
    ASSERT_OK(sim, mps_model_set(sim, "source", "start", 0));
    assert_true(mps_step(sim, 1, NULL) >= 0);
    const double share = dt * spy.rhs[i] / spy.volume[i];
    mps_sim_destroy(sim);
    cloud_free(&gas);
    cloud_free(&liquid);
    free(phase);
    free(other);
    free(u);
    return share;
}

/* Torn gas is restored in the time in which the water moves by a spacing, for any length of
 * steps. */
static void torn_gas(void **state)
{
    (void)state;
    for (double dt = 1e-6; dt < 2e-3; dt *= 10)
        for (double speed = 1; speed < 10; speed += 3)
            ASSERT_NEAR(relaxed_beside_water(speed, dt) * CLOUD_DP / speed, 1, 1e-3);
}

/* ---- floor of torn gas ----------------------------------------------------------------------- */

static double slope_of_x(const double *x, int dim)
{
    (void)dim;
    return air * x[0];
}

/* Acceleration by p = rho x of a gas particle that has every second of its neighbours and a volume
 * too large by `gap`; over -1. */
static double pushed(double gap, double torn, bool beside_water)
{
    cloud c = cloud_lattice(2, 16, 16, 1, 0, 1);
    int32_t *phase = cloud_phases(c.n);
    mps_sim *sim = bare_sim(2, CLOUD_DP, 3.1, 1e-4);
    int64_t kept = 0, middle = -1;
    set_phase(sim, 0, beside_water ? water : air, 0);
    set_phase(sim, 1, air, 0);
    for (int64_t k = 0; k < c.n; k++) {
        const int64_t column = k % 16, row = k / 16;
        if ((column + row) % 2) continue;
        if (column == 8 && row == 8) middle = kept;
        for (int d = 0; d < 2; d++) c.x[2 * kept + d] = c.x[2 * k + d];
        phase[kept++] = row == 0 ? 0 : 1;
    }
    c.n = kept;
    add_cloud(sim, &c, phase, NULL);
    spy.given_deviation = -2 * gap; /* the middle has half of a full sum */
    spy.pressure = slope_of_x;
    ASSERT_OK(sim, mps_model_use(sim, "moments.bounded"));
    ASSERT_OK(sim, mps_model_set(sim, "moments", "torn", torn));
    ASSERT_OK(sim, mps_model_use(sim, "gradient.corrected"));
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    const double share = -spy.dp_a[2 * middle];
    ASSERT_NEAR(spy.volume[middle], -gap, 0.03 * gap);
    mps_sim_destroy(sim);
    cloud_free(&c);
    free(phase);
    return share;
}

/* With few neighbours a pressure does no more than its bare sum. Fluid that is not torn, or the
 * only one, has twice that, by the floor of 0.5. */
static void floor_of_torn_gas(void **state)
{
    (void)state;
    const double slight = 1e-3, twice = pushed(slight, 0, true), once = pushed(0.5, 1, true);
    ASSERT_NEAR(twice / once, 2, 1e-9);
    ASSERT_NEAR(pushed(0.15 * pow(0.5, 0.25), 1, true) * 0.75 / once, 1,
                5e-2); /* half the way: a floor of 0.75 */
    ASSERT_NEAR(pushed(0.5, 0, true) / twice, 1, 1e-9);
    ASSERT_NEAR(pushed(slight, 1, true) / twice, 1, 1e-6);
    ASSERT_NEAR(pushed(0.5, 1, false) / twice, 1, 1e-9);
}

/* An expansion of the second band, the middle of seven rows, is relaxed where the kernel of the
 * volume does not reach the surface. */
static void expansion_below_surface(void **state)
{
    (void)state;
    static const struct {
        int dim;
        double far;
        bool relaxed;
    } cases[] = {{2, 3.1, false}, {2, 2.1, true}, {3, 2.1, true}, {3, 3.1, false}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++)
        for (int sign = -1; sign <= 1; sign += 2) {
            const int dim = cases[k].dim;
            cloud c = cloud_lattice(dim, 7, 7, dim == 3 ? 7 : 1, 0, 1);
            int32_t *phase = cloud_phases(c.n);
            mps_sim *sim = bare_sim(dim, CLOUD_DP, cases[k].far, DT);
            set_phase(sim, 0, water, 0);
            add_cloud(sim, &c, phase, NULL);
            spy.given_deviation = 0.02 * sign;
            ASSERT_OK(sim, mps_model_use(sim, "surface.asymmetry"));
            ASSERT_OK(sim, mps_model_set(
                               sim, "surface", "film",
                               0.9)); /* by the asymmetry alone: the model `spy` sets n as well */
            ASSERT_OK(sim, mps_model_use(sim, "moments.bounded"));
            ASSERT_OK(sim, mps_model_use(sim, "source.volume"));
            ASSERT_OK(sim, mps_model_set(sim, "source", "start", 0));
            ASSERT_OK(sim, mps_step(sim, 1, NULL));
            assert_int_equal(spy.region[c.n / 2], MPS_REGION_SECOND);
            if (sign > 0 || cases[k].relaxed)
                assert_true(sign * spy.rhs[c.n / 2] > 0);
            else
                assert_true(spy.rhs[c.n / 2] == 0);
            mps_sim_destroy(sim);
            cloud_free(&c);
            free(phase);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(linear_flow),       cmocka_unit_test(water_minds_water),
        cmocka_unit_test(equal_densities),   cmocka_unit_test(water_keeps_its_pace),
        cmocka_unit_test(torn_volume),       cmocka_unit_test(torn_gas),
        cmocka_unit_test(floor_of_torn_gas), cmocka_unit_test(expansion_below_surface)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* source.volume in flows that strain without changing volumes: its source against its equation. */
#include "phase_fixture.h"
#include <stdbool.h>

static const double DT = 0.02; /* long, so that relaxation is negligible */

/* u = A x with the columns of A one after the other; the volume of no particle changes. */
static void strain(const cloud *c, const double *a, double *u)
{
    for (int64_t i = 0; i < c->n; i++)
        for (int d = 0; d < c->dim; d++)
            for (int e = 0; e < c->dim; e++)
                u[i * c->dim + d] += a[d * c->dim + e] * c->x[i * c->dim + e];
}

static double trace_of_square(const double *a, int dim)
{
    double sum = 0;
    for (int d = 0; d < dim; d++)
        for (int e = 0; e < dim; e++) sum += a[d * dim + e] * a[e * dim + d];
    return sum;
}

/* Is i at least 5 dp from every side of the block? */
static bool inside(const cloud *c, int64_t i, int side)
{
    for (int d = 0; d < c->dim; d++)
        if (c->x[i * c->dim + d] < 4.9 * CLOUD_DP || c->x[i * c->dim + d] > (side - 5.9) * CLOUD_DP)
            return false;
    return true;
}

/* The source of a particle inside: its part of div(v) is 0, that of the volume deviation is relaxed
 * in a million tau_g. */
static double source_inside(int dim, const double *a, double gain, double forward)
{
    const int side = dim == 2 ? 20 : 13;
    cloud c = cloud_lattice(dim, side, side, dim == 2 ? 1 : side, 0.05, 3);
    double *u = cloud_doubles(c.n * dim), least = INFINITY, most = -INFINITY;
    int32_t *phase = cloud_phases(c.n);
    mps_sim *sim = bare_sim(dim, CLOUD_DP, 3.1, DT);
    set_phase(sim, 0, 1000, 0);
    strain(&c, a, u);
    add_cloud(sim, &c, phase, u);
    ASSERT_OK(sim, mps_model_use(sim, "surface.asymmetry"));
    ASSERT_OK(sim, mps_model_use(sim, "moments.bounded"));
    ASSERT_OK(sim, mps_model_use(sim, "source.volume"));
    ASSERT_OK(sim, mps_model_set(sim, "source", "tau", 1e6));
    ASSERT_OK(sim, mps_model_set(sim, "source", "gain", gain));
    ASSERT_OK(sim, mps_model_set(sim, "source", "forward", forward));
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    for (int64_t i = 0; i < c.n; i++)
        if (inside(&c, i, side)) {
            least = fmin(least, spy.rhs[i]);
            most = fmax(most, spy.rhs[i]);
        }
    assert_true(most >= least);
    ASSERT_NEAR(most, least, 1e-4);
    mps_sim_destroy(sim);
    cloud_free(&c);
    free(phase);
    free(u);
    return most;
}

/* After the step div(v) = dt T/2 keeps volumes. The flow reduces div(v) by dt T in every step; a
 * row with the factor `gain` on its right-hand side compensates it completely if this is (1/gain -
 * 1/2) T before the gain, in stretching flow, and less in rotating flow. */
static void strained(void **state)
{
    (void)state;
    static const double stretch[] = {1.5, 0.4, 0.4, -1.5}, turn[] = {0, -2, 2, 0};
    static const double skew[] = {1, 0.3, -0.2, 0.5, -2, 0.1, 0.7, 0.2, 1};
    const struct {
        int dim;
        const double *a;
    } flow[] = {{2, stretch}, {2, turn}, {3, skew}};
    for (int f = 0; f < 3; f++) {
        const double t = trace_of_square(flow[f].a, flow[f].dim);
        for (double gain = 0.4; gain <= 1.0; gain += 0.3) {
            ASSERT_NEAR(source_inside(flow[f].dim, flow[f].a, gain, 1), (1 / gain - 0.5) * t, 1e-3);
            ASSERT_NEAR(source_inside(flow[f].dim, flow[f].a, gain, 0), 0.5 * t, 1e-3);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(strained)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

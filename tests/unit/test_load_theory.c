/* SPDX-License-Identifier: BSD-3-Clause */
/* Added mass in 3-D and of two layers against exact solutions; the mass of the liquid counted cell
 * by cell. */
#include "tank_fixture.h"

static const double rho = 1000, dt = 1e-3;

static mps_load load_after(mps_sim *sim, int32_t what, int32_t steps)
{
    mps_load l;
    ASSERT_OK(sim, mps_load_watch(sim, what));
    for (int32_t k = 0; k < steps; k++) ASSERT_OK(sim, mps_step(sim, dt, NULL));
    assert_int_equal(mps_load_init(&l, sizeof l), MPS_OK);
    ASSERT_OK(sim, mps_load_get(sim, NULL, &l));
    assert_int_equal(l.has_mass, what == MPS_LOAD_MASS);
    return l;
}

/* A tank with liquid up to `depth`, moments about the middle of its width and length at
 * `height`. */
static mps_sim *tank(int32_t dim, double dp, const double size[3], double depth, double height)
{
    const double centre[3] = {size[0] / 2, height, size[2] / 2};
    mps_sim *sim = new_sim(dim, dp);
    add_tank(sim, size[0], size[1], dim == 3 ? size[2] : 0);
    fill_depth(sim, size[0], depth, size[2]);
    ASSERT_OK(sim, mps_motion_centre_set(sim, centre, MPS_START_AT_REST));
    return sim;
}

/* ---- cells ---- */

/* A full tank that does not move weighs rho V g: whole cells, halves at faces, quarters at edges,
 * eighths at corners. */
static void cells_of_boxes(void **state)
{
    static const int rows[][3] = {{8, 5, 4}, {4, 4, 4}, {6, 4, 9}, {8, 5, 0}, {4, 9, 0}};
    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof rows[0]; k++) {
        const double dp = 0.05, size[3] = {rows[k][0] * dp, rows[k][1] * dp, rows[k][2] * dp};
        const double weight = 9.81 * rho * size[0] * size[1] * (rows[k][2] ? size[2] : 1);
        mps_sim *sim = tank(rows[k][2] ? 3 : 2, dp, size, size[1], 0);
        const mps_load l = load_after(sim, MPS_LOAD_FORCE, 1);
        ASSERT_NEAR(l.force[1], -weight, 1e-7 * weight);
        mps_sim_destroy(sim);
    }
}

/* A block hangs in the liquid, which has three quarters of a cell at its edges and seven eighths at
 * its corners. */
static void cells_about_a_block(void **state)
{
    const double dp = 0.05, lo[3] = {0.2, 0.2, 0.2}, hi[3] = {0.4, 0.35, 0.4};
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) {
        const double volume = dim == 2 ? 0.36 - 0.2 * 0.15 : 0.216 - 0.2 * 0.15 * 0.2;
        mps_sim *sim = new_sim(dim, dp);
        add_tank(sim, 0.6, 0.6, dim == 3 ? 0.6 : 0);
        ASSERT_OK(sim, mps_baffle_add(sim, "block", lo, hi, NULL));
        fill_depth(sim, 0.6, 0.6, 0.6);
        const mps_load l = load_after(sim, MPS_LOAD_FORCE, 1);
        ASSERT_NEAR(l.force[1], -9.81 * rho * volume, 1e-6 * 9.81 * rho * volume);
        mps_sim_destroy(sim);
    }
}

/* ---- 3-D ---- */

/* St Venant: a full box a x b of length l that rotates about its long axis has rho l (I_polar -
 * torsion constant). */
static double turned_box(double a, double b, double l)
{
    const double pi = acos(-1.0);
    double sum = 0;
    if (a < b) return turned_box(b, a, l);
    for (int n = 1; n < 200; n += 2) sum += tanh(n * pi * a / (2 * b)) / pow(n, 5);
    const double torsion = a * b * b * b * (1.0 / 3 - 64 / pow(pi, 5) * b / a * sum);
    return rho * l * (a * b * (a * a + b * b) / 12 - torsion);
}

/* Columns of translations: all of the liquid. Rotation does not move its centre. */
static void full_box(void **state)
{
    const double size[3] = {0.5, 0.45, 0.4}, mass = rho * 0.5 * 0.45 * 0.4;
    mps_sim *sim = tank(3, 0.0125, size, size[1], size[1] / 2);
    const mps_load l = load_after(sim, MPS_LOAD_MASS, 1);
    (void)state;
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
            if (i != j || i < 3) ASSERT_NEAR(l.mass[6 * i + j], i == j ? mass : 0, 1e-5 * mass);
    for (int d = 0; d < 3; d++) {
        const double exact = turned_box(size[(d + 1) % 3], size[(d + 2) % 3], size[d]);
        ASSERT_NEAR(l.mass[7 * (3 + d)], exact, 0.005 * exact);
    }
    mps_sim_destroy(sim);
}

/* p = 0 on the surface; a tank L x h: A11 = 4 rho/h sum tanh(k L/2)/k^3, k = (m - 1/2) pi/h, times
 * its width. */
static double surge_mass(double L, double h)
{
    double sum = 0;
    for (int m = 1; m < 2000; m++) {
        const double k = (m - 0.5) * acos(-1.0) / h;
        sum += 4 * rho / h * tanh(k * L / 2) / (k * k * k);
    }
    return sum;
}

static void with_surface(void **state)
{
    const double size[3] = {0.4, 0.5, 0.2}, h = 0.25, surge = surge_mass(size[0], h) * size[2],
                 sway = surge_mass(size[2], h) * size[0], heave = rho * 0.4 * 0.2 * h;
    mps_sim *sim = tank(3, 0.01, size, h, 0);
    const mps_load l = load_after(sim, MPS_LOAD_MASS, 2);
    (void)state;
    ASSERT_NEAR(l.mass[0], surge, 0.015 * surge);
    ASSERT_NEAR(l.mass[14], sway, 0.015 * sway);
    ASSERT_NEAR(l.mass[7], heave, 5e-4 * heave);
    ASSERT_NEAR(l.mass[5], l.mass[30], 0.01 * fabs(l.mass[5]));
    ASSERT_NEAR(l.mass[15], l.mass[20], 0.01 * fabs(l.mass[15]));
    assert_true(l.mass[5] < 0 && l.mass[15] > 0);
    mps_sim_destroy(sim);
}

/* ---- two layers ---- */

/* A closed tank L x (h1 + h2), layers of rho[0] below rho[1], of which the upper is compressible:
 * lap p = (p/reach^2), reach = c dt of its speed of sound, INFINITY: incompressible. p is
 * continuous, so is (dp/dn)/rho. With p = P_i + q_i, P_i the solution of a layer alone, and the
 * cosine series of P_2 - P_1 along the interface, k = n pi/L, n odd, s^2 = k^2 + 1/reach^2:
 *   A11 = rho_1 L h1 + 2 rho_2 h2 reach tanh(L/(2 reach)) + sum 2 (a T1/k + b T2/s),   T1 = tanh(k
 *   h1), T2 = tanh(s h2),
 *   a - b = 4/L (rho_2/s^2 - rho_1/k^2),  a k T1/rho_1 + b s T2/rho_2 = 0. */
static double two_layers(double L, const double h[2], const double density[2], double reach)
{
    const double r = isfinite(reach) ? reach : 1e5 * L;
    double sum = density[0] * L * h[0] + 2 * density[1] * h[1] * r * tanh(L / (2 * r));
    for (int n = 1; n < 2000; n += 2) {
        const double k = n * acos(-1.0) / L, s = sqrt(k * k + 1 / (r * r));
        const double t1 = tanh(k * h[0]), t2 = tanh(s * h[1]);
        const double gap = 4 / L * (density[1] / (s * s) - density[0] / (k * k));
        const double a = gap / (1 + k * t1 * density[1] / (density[0] * s * t2)), b = a - gap;
        sum += 2 * (a * t1 / k + b * t2 / s);
    }
    return sum;
}

/* Up and down: the lower layer, and of the upper one 2 rho L reach tanh(h/(2 reach)). */
static double heave_mass(double L, const double h[2], const double density[2], double reach)
{
    const double r = isfinite(reach) ? reach : 1e5 * L;
    return L * (density[0] * h[0] + 2 * density[1] * r * tanh(h[1] / (2 * r)));
}

/* 0.8 x 0.5 m; the lower layer up to half a spacing above its last row. */
static mps_sim *layers(double dp, double above, double h[2])
{
    const double lo[2] = {0, 0}, hi[2] = {0.8, 0.5}, centre[2] = {0.4, 0};
    mps_phase upper;
    mps_sim *sim = new_sim(2, dp);
    assert_int_equal(mps_phase_init(&upper, sizeof upper), MPS_OK);
    upper.density = above;
    upper.viscosity = 1.8e-5;
    ASSERT_OK(sim, mps_preset_use(sim, "mmps"));
    ASSERT_OK(sim, mps_phase_set(sim, 1, &upper));
    add_tank(sim, 0.8, 0.5, 0);
    h[0] = (fill_depth(sim, 0.8, 0.25, 0) / (lround(0.8 / dp) - 1.0) + 0.5) * dp;
    h[1] = 0.5 - h[0];
    ASSERT_OK(sim, mps_fill_box_add(sim, 1, lo, hi, NULL, NULL));
    ASSERT_OK(sim, mps_motion_centre_set(sim, centre, MPS_START_AT_REST));
    return sim;
}

static void two_liquids(void **state)
{
    static const double above[] = {1.2, 200, 800};
    (void)state;
    for (int k = 0; k < 3; k++) {
        double h[2];
        const double density[2] = {rho, above[k]};
        mps_sim *sim = layers(0.01, above[k], h);
        ASSERT_OK(sim, mps_model_remove(sim, "gas"));
        const mps_load l = load_after(sim, MPS_LOAD_MASS, 3);
        const double surge = two_layers(0.8, h, density, INFINITY),
                     heave = heave_mass(0.8, h, density, INFINITY);
        ASSERT_NEAR(l.mass[0], surge, 0.005 * surge);
        ASSERT_NEAR(l.mass[7], heave, 1e-5 * heave);
        ASSERT_NEAR(l.mass[5], l.mass[30], 0.01 * fabs(l.mass[5]));
        mps_sim_destroy(sim);
    }
}

/* A heavy gas, so that its effect is large; sound travels through a part of the tank in a step. A
 * step removes the fraction `gain` of the divergence, so that its gas is as compressible as one
 * with c/sqrt(gain). */
static void liquid_and_gas(void **state)
{
    static const double sound[] = {50, 200};
    const double density[2] = {rho, 500};
    (void)state;
    for (int k = 0; k < 4; k++) {
        double h[2], gain;
        const double c = sound[k / 2];
        mps_sim *sim = layers(0.02, density[1], h);
        ASSERT_OK(sim, mps_model_get(sim, "source", "gain", &gain));
        if (k % 2) {
            ASSERT_OK(sim, mps_model_use(sim, "gas.isentropic"));
            ASSERT_OK(sim, mps_model_set(sim, "gas", "ambient", c * c * density[1] / 1.4));
            ASSERT_OK(sim, mps_solver_use(sim, "sundials.kinsol", NULL));
        } else
            ASSERT_OK(sim, mps_model_set(sim, "gas", "sound", c));
        const mps_load l = load_after(sim, MPS_LOAD_MASS, 3);
        const double reach = c * dt / sqrt(gain), surge = two_layers(0.8, h, density, reach),
                     heave = heave_mass(0.8, h, density, reach);
        ASSERT_NEAR(l.mass[0], surge, 0.005 * surge);
        ASSERT_NEAR(l.mass[7], heave, 0.005 * heave);
        ASSERT_NEAR(l.mass[5], l.mass[30], 0.01 * fabs(l.mass[5]));
        mps_sim_destroy(sim);
    }
}

/* The series: without an upper layer it is the tank with a free surface, of one density all of
 * it. */
static void series(void **state)
{
    const double h[2] = {0.25, 0.25}, light[2] = {rho, 1e-6}, same[2] = {rho, rho};
    (void)state;
    ASSERT_NEAR(two_layers(0.8, h, light, INFINITY), surge_mass(0.8, 0.25), 1e-4);
    ASSERT_NEAR(two_layers(0.8, h, same, INFINITY), 400, 1e-6);
    ASSERT_NEAR(turned_box(0.8, 0.5, 1), 9.293, 1e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cells_of_boxes), cmocka_unit_test(cells_about_a_block),
        cmocka_unit_test(full_box),       cmocka_unit_test(with_surface),
        cmocka_unit_test(two_liquids),    cmocka_unit_test(liquid_and_gas),
        cmocka_unit_test(series)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

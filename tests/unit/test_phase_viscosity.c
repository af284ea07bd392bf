/* SPDX-License-Identifier: BSD-3-Clause */
/* viscosity.pair: means of viscosity, momentum, walls, two layers in shear, its time step. */
#include "phase_fixture.h"
#include <stdbool.h>

/* A lone pair: a_i = 2D/(n0 lambda rho_i) mu_ij du W. */
static void means(void **state)
{
    (void)state;
    static const double theta[] = {-1, -0.5, 0, 0.5, 1}, a = 0.002, b = 0.05;
    for (int t = 0; t < 5; t++) {
        const double two[4] = {0, 0, CLOUD_DP, 0}, u[4] = {0, 0, 0, 1};
        const int32_t phase[2] = {0, 1};
        const cloud c = {2, 2, (double *)two};
        const double mu = theta[t] == 0
                              ? sqrt(a * b)
                              : pow((pow(a, theta[t]) + pow(b, theta[t])) / 2, 1 / theta[t]);
        double n0, lambda;
        mps_kernel kernel = {.struct_size = sizeof kernel};
        mps_sim *sim = bare_sim(2, CLOUD_DP, 3.1, 1e-9);
        set_phase(sim, 0, 1000, a);
        set_phase(sim, 1, 10, b);
        add_cloud(sim, &c, phase, u);
        ASSERT_OK(sim, mps_model_use(sim, "viscosity.pair"));
        ASSERT_OK(sim, mps_model_set(sim, "viscosity", "theta", theta[t]));
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
        assert_int_equal(mps_lattice_constants(&kernel, 2, CLOUD_DP, 3.1 * CLOUD_DP, &n0, &lambda),
                         MPS_OK);
        const double wanted = 4 / (n0 * lambda) * mu *
                              mps_kernel_value(&kernel, CLOUD_DP, 3.1 * CLOUD_DP);
        ASSERT_NEAR(spy.a[1] * 1000 / wanted, 1, 1e-12);
        ASSERT_NEAR(spy.a[3] * 10 / wanted, -1, 1e-12);
        mps_sim_destroy(sim);
    }
}

/* Pairs conserve momentum, for any densities and mean, and angular momentum if forces are along
 * their line. */
static void momentum(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++)
        for (double theta = -1; theta <= 1; theta += 0.25) {
            const bool whole = theta > -0.3;
            static const double rho[3] = {1000, 1.2, 800};
            cloud c = dim == 2 ? cloud_lattice(2, 20, 18, 1, 0.3, 1)
                               : cloud_lattice(3, 8, 8, 7, 0.3, 1);
            double *u = cloud_field(c.n * dim, 2);
            int32_t *phase = cloud_phases(c.n);
            for (int64_t i = 0; i < c.n; i++) phase[i] = (int32_t)(i / 7 % 3);
            mps_sim *sim = bare_sim(dim, CLOUD_DP, 3.1, 1e-9);
            for (int p = 0; p < 3; p++) set_phase(sim, p, rho[p], 1e-3 * pow(7, p));
            add_cloud(sim, &c, phase, u);
            ASSERT_OK(sim, mps_model_use(sim, "viscosity.pair"));
            ASSERT_OK(sim, mps_model_set(sim, "viscosity", "theta", theta));
            ASSERT_OK(sim, mps_model_set(sim, "viscosity", "stress", whole));
            ASSERT_OK(sim, mps_step(sim, 1, NULL));
            double moment = 0, arm = 0;
            for (int64_t i = 0; whole && i < c.n; i++) {
                const double *x = c.x + i * dim, *a = spy.a + i * dim,
                             about_z = x[0] * a[1] - x[1] * a[0];
                moment += rho[phase[i]] * about_z;
                arm += rho[phase[i]] * fabs(about_z);
            }
            assert_true(fabs(moment) <= 1e-13 * arm);
            for (int d = 0; d < dim; d++) {
                double sum = 0, size = 0;
                for (int64_t i = 0; i < c.n; i++) {
                    sum += rho[phase[i]] * spy.a[i * dim + d];
                    size += fabs(rho[phase[i]] * spy.a[i * dim + d]);
                }
                assert_true(size > 0 && fabs(sum) <= 1e-13 * size);
            }
            mps_sim_destroy(sim);
            cloud_free(&c);
            free(u);
            free(phase);
        }
}

/* u = A x of two fluids, phase 1 beyond the middle of the cloud: accelerations by the model; dim 2,
 * row major A. */
static mps_sim *linear_flow(const cloud *c, const double *A, const double *mu, double stress)
{
    double *u = cloud_doubles(c->n * c->dim), middle = 0;
    int32_t *phase = cloud_phases(c->n);
    for (int64_t i = 0; i < c->n; i++) middle += c->x[i * c->dim] / (double)c->n;
    for (int64_t i = 0; i < c->n; i++) {
        phase[i] = c->x[i * c->dim] > middle;
        for (int d = 0; d < c->dim; d++)
            for (int e = 0; e < c->dim; e++)
                u[i * c->dim + d] += A[d * c->dim + e] * c->x[i * c->dim + e];
    }
    mps_sim *sim = bare_sim(c->dim, CLOUD_DP, 3.1, 1e-9);
    for (int p = 0; p < 2; p++) set_phase(sim, p, 1000, mu[p]);
    add_cloud(sim, c, phase, u);
    ASSERT_OK(sim, mps_model_use(sim, "viscosity.pair"));
    ASSERT_OK(sim, mps_model_set(sim, "viscosity", "stress", stress));
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    free(u);
    free(phase);
    return sim;
}

/* Fluids in rigid rotation have no viscous force with the full stress; div(mu grad u) gives a force
 * at their interface. */
static void rigid_rotation(void **state)
{
    (void)state;
    static const double turn2[4] = {0, -1, 1, 0}, turn3[9] = {0, -1, 0.5, 1, 0, -2, -0.5, 2, 0},
                        mu[2] = {1, 10};
    for (int dim = 2; dim <= 3; dim++) {
        cloud c = dim == 2 ? cloud_lattice(2, 20, 18, 1, 0.3, 1)
                           : cloud_lattice(3, 8, 8, 7, 0.3, 1);
        double most[2] = {0};
        for (int whole = 0; whole < 2; whole++) {
            mps_sim *sim = linear_flow(&c, dim == 2 ? turn2 : turn3, mu, whole);
            for (int64_t k = 0; k < c.n * dim; k++) most[whole] = fmax(most[whole], fabs(spy.a[k]));
            mps_sim_destroy(sim);
        }
        print_message("%d-D: largest acceleration of rigid rotation %.3g, whole stress %.3g m/s2\n",
                      dim, most[0], most[1]);
        assert_true(most[0] > 0.1 && most[1] < 1e-11 * most[0]);
        cloud_free(&c);
    }
}

/* Stretched at the rate `rate`, the interface bears the jump of the normal stress, 2 (mu_1 - mu_0)
 * rate on its area; div(mu grad u) has half of it. */
static void jump_of_stress(void **state)
{
    (void)state;
    static const double rate = 3, A[4] = {3, 0, 0, -3}, mu[2] = {1, 10};
    enum { ACROSS = 20, ALONG = 17 };
    for (int whole = 0; whole < 2; whole++) {
        cloud c = cloud_lattice(2, ACROSS, ALONG, 1, 0, 1);
        mps_sim *sim = linear_flow(&c, A, mu, whole);
        double force = 0; /* on a row, away from its ends and from other sides of the cloud */
        for (int64_t i = 4; i < ACROSS - 4; i++)
            force += 1000 * CLOUD_DP * CLOUD_DP * spy.a[2 * (i + ACROSS * (ALONG / 2))];
        const double jump = force / CLOUD_DP / ((mu[1] - mu[0]) * rate);
        print_message("jump of the normal stress %.4f, of (mu_1 - mu_0) du/dx\n", jump);
        ASSERT_NEAR(jump, whole ? 2 : 1, 0.03);
        mps_sim_destroy(sim);
        cloud_free(&c);
    }
}

/* One phase in a tank: viscosity.laplacian, though phase 0, which the walls carry, is something
 * else. */
static void walls_take_the_fluid(void **state)
{
    (void)state;
    double *wanted = NULL;
    static const char *const model[] = {"viscosity.laplacian", "viscosity.pair"};
    for (int m = 0; m < 2; m++) {
        const double lo[3] = {0}, hi[3] = {0.5, 0.3, 0};
        mps_sim *sim = bare_sim(2, 0.05, 3.1, 1e-6);
        set_phase(sim, 0, 1000, 5.0);
        set_phase(sim, 1, 900, 1e-3);
        add_tank(sim, 0.5, 0.5, 0);
        ASSERT_OK(sim, mps_fill_box_add(sim, 1, lo, hi, NULL, NULL));
        mps_lease u = {.struct_size = sizeof u};
        ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &u));
        for (int64_t k = 0; k < u.count * u.stride; k++) u.data[k] = 1.0;
        ASSERT_OK(sim, mps_lease_end(sim, &u));
        ASSERT_OK(sim, mps_model_use(sim, model[m]));
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        const int64_t n = mps_particles_count(sim, -1) * 2;
        double most = 0;
        if (m == 0) wanted = cloud_doubles(n);
        for (int64_t k = 0; k < n; k++) {
            if (m == 0) wanted[k] = spy.a[k];
            most = fmax(most, fabs(wanted[k]));
        }
        assert_true(most > 1e-4);
        for (int64_t k = 0; k < n; k++) ASSERT_NEAR(spy.a[k], wanted[k], 1e-12 * most);
        mps_sim_destroy(sim);
    }
    free(wanted);
}

/* Friction of walls across x and y, the fluid moving along both, with some of them slippery. */
static void slippery_walls(void **state)
{
    (void)state;
    for (int slip = 0; slip < 4; slip++) {
        const double lo[2] = {0}, hi[2] = {0.5, 0.5};
        mps_sim *sim = bare_sim(2, 0.05, 3.1, 1e-6);
        add_tank(sim, 0.5, 0.5, 0);
        ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
        mps_lease u = {.struct_size = sizeof u};
        ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &u));
        for (int64_t k = 0; k < u.count * u.stride; k++) u.data[k] = 1.0;
        ASSERT_OK(sim, mps_lease_end(sim, &u));
        ASSERT_OK(sim, mps_model_use(sim, "viscosity.pair"));
        ASSERT_OK(sim, mps_model_set(sim, "viscosity", "slip", slip));
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        const int64_t *ids;
        const int32_t *kind;
        mps_lease x = {.struct_size = sizeof x};
        ASSERT_OK(sim, tags_peek(sim, &ids, &kind, NULL, NULL));
        ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
        for (int64_t i = 0; i < x.count; i++) {
            const double *at = x.data + 2 * i, a = spy.a[2 * ids[i]];
            const bool beside_x = fmin(at[0], 0.5 - at[0]) < 0.06,
                       beside_y = fmin(at[1], 0.5 - at[1]) < 0.06;
            if (kind[i] != MPS_FLUID || beside_x == beside_y) continue;
            if (fmax(fabs(at[0] - 0.25), fabs(at[1] - 0.25)) > 0.21 ||
                fmin(fabs(at[0] - 0.25), fabs(at[1] - 0.25)) > 0.06)
                continue;
            assert_true((slip & (beside_x ? 1 : 2)) ? a == 0 : a < -1e-6);
        }
        ASSERT_OK(sim, mps_lease_end(sim, &x));
        mps_sim_destroy(sim);
    }
}

/* Shear along the floor, u = y from 0 on its face: no force in the rows next to it, since dummies
 * are seen mirrored. With their own velocity the first row is pulled along. */
static void shear_along_the_floor(void **state)
{
    (void)state;
    static const char *const model[] = {"viscosity.laplacian", "viscosity.pair"};
    for (int variant = 0; variant < 12; variant++) {
        const int dim = 2 + variant % 2, kind_of = variant / 2 % 3, mirror = variant < 6;
        const double dp = 0.05, lo[3] = {0}, hi[3] = {0.7, 0.5, 0.7};
        mps_sim *sim = bare_sim(dim, dp, 3.1, 1e-9);
        set_phase(sim, 0, 1, 1);
        add_tank(sim, 0.7, 0.7, 0.7);
        ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
        ASSERT_OK(sim, mps_model_use(sim, model[kind_of > 0]));
        ASSERT_OK(sim, mps_model_set(sim, "viscosity", "mirror", mirror));
        if (kind_of == 2) ASSERT_OK(sim, mps_model_set(sim, "viscosity", "stress", 1));
        const int64_t *ids;
        const int32_t *kind;
        mps_lease x = {.struct_size = sizeof x}, u = {.struct_size = sizeof u};
        ASSERT_OK(sim, tags_peek(sim, &ids, &kind, NULL, NULL));
        ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
        ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &u));
        for (int64_t i = 0; i < x.count; i++)
            u.data[i * dim] = kind[i] == MPS_FLUID ? x.data[i * dim + 1] : 0;
        ASSERT_OK(sim, mps_lease_end(sim, &u));
        ASSERT_OK(sim, mps_lease_end(sim, &x));
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        double most = 0;
        ASSERT_OK(sim, tags_peek(sim, &ids, &kind, NULL, NULL));
        ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
        for (int64_t i = 0; i < x.count; i++) {
            const double *at = x.data + i * dim;
            const bool aside = fabs(at[0] - 0.35) > 0.16 || (dim == 3 && fabs(at[2] - 0.35) > 0.16);
            if (kind[i] == MPS_FLUID && at[1] < 0.31 && !aside)
                most = fmax(most, fabs(spy.a[ids[i] * dim]));
        }
        ASSERT_OK(sim, mps_lease_end(sim, &x));
        assert_true(mirror ? most * dp < 1e-7 : most * dp > 0.05); /* of nu du/dy */
        mps_sim_destroy(sim);
    }
}

/* ---- Couette --------------------------------------------------------------------------------- */

enum { ROWS = 24, COLUMNS = 5, BELT = 3 };
static const double belt_speed = 1e-9; /* so slow that no particle moves a spacing */

/* The outermost rows are plates. */
static int belts(mps_stage *s)
{
    double *u = s->data[0];
    for (int64_t i = 0; i < s->view->n; i++) {
        const int64_t row = s->view->id[i] / COLUMNS;
        if (row < BELT || row >= ROWS - BELT) u[2 * i] = row < BELT ? 0 : belt_speed;
    }
    return 0;
}

static const mps_use belt_uses[] = {{"velocity", MPS_USE_CHANGE}};
static const mps_verb belt_verbs[] = {
    {.hook = MPS_VELOCITY, .use_count = 1, .uses = belt_uses, .after = "*", .run = belts}};
static const mps_model_ops belt = {.struct_size = sizeof(mps_model_ops),
                                   .api = MPS_MODEL_API,
                                   .name = "belt.test",
                                   .help = "moves the outermost rows as plates",
                                   .verb_count = 1,
                                   .verbs = belt_verbs};

/* Steady: mu du/dy is the same in both layers, and with the harmonic mean the velocity of the
 * interface is that of sharp layers. */
static void couette(void **state)
{
    (void)state;
    static const double theta[] = {-1, 1}, mu[2] = {1.0, 4.0};
    for (int t = 0; t < 2; t++) {
        cloud c = cloud_lattice(2, COLUMNS, ROWS, 1, 0, 1);
        int32_t phase[ROWS * COLUMNS];
        for (int64_t i = 0; i < c.n; i++) phase[i] = i / COLUMNS >= ROWS / 2;
        mps_sim *sim = bare_sim(2, CLOUD_DP, 3.1, 0.04 * CLOUD_DP * CLOUD_DP);
        set_phase(sim, 0, 1, mu[0]);
        set_phase(sim, 1, 1, mu[1]);
        add_cloud(sim, &c, phase, NULL);
        ASSERT_OK(sim, mps_model_register(sim, &belt));
        ASSERT_OK(sim, mps_model_use(sim, "belt.test"));
        ASSERT_OK(sim, mps_model_use(sim, "viscosity.pair"));
        ASSERT_OK(sim, mps_model_set(sim, "viscosity", "theta", theta[t]));
        for (int step = 0; step < 6000; step++) ASSERT_OK(sim, mps_step(sim, 1, NULL));
        double *u = field_by_id(sim, "velocity");
#define ROW(r) u[2 * ((r)*COLUMNS + COLUMNS / 2)]
        const double low = ROW(8) - ROW(5), high = ROW(18) - ROW(15);
        const double below = ROW(8) + 3.5 / 3 * low,
                     above = ROW(15) - 3.5 / 3 * high; /* both carried on to the interface */
        print_message("theta %g: slopes %.4f to 1, jump at the interface %.4f of the speed\n",
                      theta[t], low / high, (above - below) / belt_speed);
        ASSERT_NEAR(low / high, mu[1] / mu[0], 0.02 * mu[1] / mu[0]);
        assert_true(theta[t] > 0 || fabs(above - below) < 0.03 * belt_speed);
        free(u);
        mps_sim_destroy(sim);
        cloud_free(&c);
    }
}

/* Length of a step of two particles at rest, of different fluids or of the first alone. */
static double step_of_pair(bool alone, double re_far, double stress)
{
    const double two[4] = {0, 0, CLOUD_DP, 0};
    const int32_t phase[2] = {0, !alone};
    const cloud c = {2, 2, (double *)two};
    mps_step_info info;
    mps_sim *sim = bare_sim(2, CLOUD_DP, re_far, 0);
    mps_time_control control;
    assert_int_equal(mps_time_control_init(&control, sizeof control), MPS_OK);
    control.gravity = control.viscous = -1;
    ASSERT_OK(sim, mps_time_control_set(sim, &control));
    set_phase(sim, 0, 1000, 10);
    set_phase(sim, 1, 1, 0.1);
    add_cloud(sim, &c, phase, NULL);
    ASSERT_OK(sim, mps_model_use(sim, "viscosity.pair"));
    ASSERT_OK(sim, mps_model_set(sim, "viscosity", "theta", 1));
    ASSERT_OK(sim, mps_model_set(sim, "viscosity", "stress", stress));
    assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
    ASSERT_OK(sim, mps_step(sim, 1, &info));
    mps_sim_destroy(sim);
    return info.dt;
}

/* The arithmetic mean makes gas next to syrup stiff: the model reduces the time step. With the full
 * stress also to 0.7 of the longest stable step, lambda/(2 (D + 2) nu), of each fluid. */
static void time_step(void **state)
{
    (void)state;
    double lambda;
    mps_kernel kernel = {.struct_size = sizeof kernel};
    assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
    assert_int_equal(mps_lattice_constants(&kernel, 2, CLOUD_DP, 2.1 * CLOUD_DP, NULL, &lambda),
                     MPS_OK);
    ASSERT_NEAR(step_of_pair(false, 3.1, 0), 0.2 * CLOUD_DP * CLOUD_DP / 5.05, 1e-12);
    ASSERT_NEAR(step_of_pair(false, 2.1, 1), 0.7 * lambda / (8 * 5.05), 1e-12);
    ASSERT_NEAR(step_of_pair(true, 2.1, 1), 0.7 * lambda / (8 * 0.01), 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(means),
                                       cmocka_unit_test(momentum),
                                       cmocka_unit_test(rigid_rotation),
                                       cmocka_unit_test(jump_of_stress),
                                       cmocka_unit_test(walls_take_the_fluid),
                                       cmocka_unit_test(slippery_walls),
                                       cmocka_unit_test(shear_along_the_floor),
                                       cmocka_unit_test(couette),
                                       cmocka_unit_test(time_step)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

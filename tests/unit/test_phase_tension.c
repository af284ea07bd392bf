/* SPDX-License-Identifier: BSD-3-Clause */
/* tension.csf: curvature of circles and spheres, flat interfaces, balance of forces, pressure
 * inside a droplet; tension.jump: the same pressure with less motion. */
#include "phase_fixture.h"

/* after cmocka.h */
#include "../turns.h"

static const double sigma = 0.07;

/* A droplet of phase 1 in the middle of a block of phase 0; off: offset of its centre from the
 * lattice [dp]. */
typedef struct drop {
    cloud c;
    int32_t *phase;
    double centre[3];
    mps_sim *sim;
} drop;

static drop drop_make(int dim, double radius, double margin, double jitter, const double density[2])
{
    static const double off[3] = {0.31, 0.17, 0.23};
    const int side = (int)(2 * (radius + margin)) + 1;
    drop s = {.c = cloud_lattice(dim, side, side, dim == 3 ? side : 1, jitter, 9)};
    s.phase = cloud_phases(s.c.n);
    for (int d = 0; d < dim; d++) s.centre[d] = CLOUD_DP * (side / 2 + off[d]);
    for (int64_t i = 0; i < s.c.n; i++) {
        double r2 = 0;
        for (int d = 0; d < dim; d++) r2 += pow(s.c.x[i * dim + d] - s.centre[d], 2);
        s.phase[i] = r2 < pow(radius * CLOUD_DP, 2);
    }
    s.sim = bare_sim(dim, CLOUD_DP, 3.1, 1e-6);
    set_phase(s.sim, 0, density[0], 0);
    set_phase(s.sim, 1, density[1], 0);
    add_cloud(s.sim, &s.c, s.phase, NULL);
    ASSERT_OK(s.sim, mps_model_use(s.sim, "tension.csf"));
    ASSERT_OK(s.sim, mps_model_set(s.sim, "tension", "sigma", sigma));
    if (dim == 3) ASSERT_OK(s.sim, mps_model_set(s.sim, "tension", "radius", 6.1));
    return s;
}

static void drop_free(drop *s)
{
    mps_sim_destroy(s->sim);
    cloud_free(&s->c);
    free(s->phase);
}

/* The radial part of sum (force r) / sigma over the surface of the drop: (D-1) times its area, if
 * kappa is (D-1)/r and <grad C> is of unit strength across the interface. Also the net force over
 * the sum of magnitudes. */
static double work_of_swelling(const drop *s, const double density[2], double *net)
{
    const int dim = s->c.dim;
    double work = 0, sum[3] = {0}, size = 0;
    for (int64_t i = 0; i < s->c.n; i++) {
        double f[3], f2 = 0;
        for (int d = 0; d < dim; d++) {
            f[d] = density[s->phase[i]] * pow(CLOUD_DP, dim) * spy.a[i * dim + d];
            work -= f[d] * (s->c.x[i * dim + d] - s->centre[d]) / sigma;
            sum[d] += f[d];
            f2 += f[d] * f[d];
        }
        size += sqrt(f2);
    }
    *net = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]) / size;
    return work;
}

static void check_drop(int dim, double radius, double jitter, double ratio, double tolerance)
{
    static const double pi = 3.14159265358979323846;
    const double density[2] = {1000 / ratio, 1000}, r = radius * CLOUD_DP;
    const double wanted = dim == 2 ? 2 * pi * r : 2 * 4 * pi * r * r;
    double net;
    drop s = drop_make(dim, radius, dim == 2 ? 9 : 6, jitter, density);
    ASSERT_OK(s.sim, mps_step(s.sim, 1, NULL));
    const double work = work_of_swelling(&s, density, &net);
    print_message("%d-D, radius %g dp, jitter %g, ratio %g: curvature %+.2f %%, net force %.1e\n",
                  dim, radius, jitter, ratio, 100 * (work / wanted - 1), net);
    ASSERT_NEAR(work / wanted, 1, tolerance);
    assert_true(net < (jitter > 0 ? 0.1 : 0.02));
    drop_free(&s);
}

static void circles(void **state)
{
    (void)state;
    for (double radius = 8; radius <= 16; radius += 4) check_drop(2, radius, 0, 1, 0.03);
    check_drop(2, 10.5, 0.2, 1, 0.1);
}

static void spheres(void **state)
{
    (void)state;
    check_drop(3, 6, 0, 1, 0.03);
    check_drop(3, 10, 0, 1, 0.03);
}

/* Both sides have the same acceleration, so almost all of the force, twice that of one side, acts
 * on the heavy one. */
static void heavy_drop(void **state)
{
    (void)state;
    const double density[2] = {1, 1000};
    double net;
    drop s = drop_make(2, 12, 9, 0, density);
    ASSERT_OK(s.sim, mps_step(s.sim, 1, NULL));
    const double work = work_of_swelling(&s, density, &net);
    double heavy = 0, light = 0;
    for (int64_t i = 0; i < s.c.n; i++)
        *(s.phase[i] ? &heavy : &light) += hypot(spy.a[2 * i], spy.a[2 * i + 1]) *
                                           density[s.phase[i]];
    print_message(
        "force on the light side %.1e of the heavy one's, curvature %+.2f %%, net force %.1e\n",
        light / heavy, 100 * (work / (2 * 3.14159265358979323846 * 12 * CLOUD_DP) - 1), net);
    assert_true(light > 0 && light < 0.003 * heavy && net < 0.02);
    ASSERT_NEAR(work, 2 * 3.14159265358979323846 * 12 * CLOUD_DP,
                0.03 * work); /* the heavy side is the inner one: r - dp/2 */
    drop_free(&s);
}

/* No force on a flat interface of a lattice, upright or diagonal, nor without another phase. */
static void flat(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        cloud c = cloud_lattice(2, 30, 30, 1, 0, 1);
        int32_t phase[900];
        for (int i = 0; i < 900; i++)
            phase[i] = kind == 0 ? 0 : kind == 1 ? i / 30 >= 15 : i % 30 + i / 30 >= 30;
        mps_sim *sim = bare_sim(2, CLOUD_DP, 3.1, 1e-6);
        set_phase(sim, 1, 800, 0);
        add_cloud(sim, &c, phase, NULL);
        ASSERT_OK(sim, mps_model_use(sim, "tension.csf"));
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        double most = 0;
        for (int i = 0; i < 900; i++) {
            const int x = i % 30, y = i / 30;
            if (x < 11 || x > 18 || y < 11 || y > 18)
                continue; /* the smoothed colours depend on the ends */
            for (int d = 0; d < 2; d++)
                most = fmax(most, fabs(spy.a[2 * i + d]) * 900 * CLOUD_DP * CLOUD_DP / 7.27e-2);
        }
        print_message("kind %d: largest force %.1e sigma/dp^2\n", kind, most);
        assert_true(kind == 0 ? most == 0 : most < 2e-4);
        mps_sim_destroy(sim);
        cloud_free(&c);
    }
}

/* f of W22 (21) at x, over the neighbours of i. */
static double colour(const drop *s, int64_t i, const double *x, double reach)
{
    const int dim = s->c.dim;
    double sum = 0, weight = 0;
    for (int64_t j = 0; j < s->c.n; j++) {
        double r2 = 0;
        if (cloud_distance2(&s->c, i, j) >= reach * reach) continue;
        for (int d = 0; d < dim; d++) r2 += pow(s->c.x[j * dim + d] - x[d], 2);
        const double g = exp(-9 * r2 / (reach * reach));
        sum += s->phase[j] != s->phase[i] ? g : 0;
        weight += g;
    }
    return sum / weight;
}

/* div(grad f/|grad f|) by differences. */
static double curvature_by_differences(const drop *s, int64_t i, double reach)
{
    const int dim = s->c.dim;
    const double h = 1e-3 * CLOUD_DP;
    double f[3][3][3] = {{{0}}}, g[3] = {0}, size2 = 0, kappa = 0;
    for (int k = 0; k < 27; k++) {
        const int at[3] = {k % 3, k / 3 % 3, k / 9};
        double x[3];
        if (dim == 2 && at[2] != 1) continue;
        for (int d = 0; d < dim; d++) x[d] = s->c.x[i * dim + d] + h * (at[d] - 1);
        f[at[0]][at[1]][at[2]] = colour(s, i, x, reach);
    }
#define F(d, a, e, b)                                                                   \
    f[1 + ((d) == 0) * (a) + ((e) == 0) * (b)][1 + ((d) == 1) * (a) + ((e) == 1) * (b)] \
     [1 + ((d) == 2) * (a) + ((e) == 2) * (b)]
    for (int d = 0; d < dim; d++) {
        g[d] = (F(d, 1, d, 0) - F(d, -1, d, 0)) / (2 * h);
        size2 += g[d] * g[d];
    }
    for (int d = 0; d < dim; d++)
        for (int e = 0; e < dim; e++) {
            const double second = d == e
                                      ? (F(d, 1, d, 0) + F(d, -1, d, 0) - 2 * f[1][1][1]) / (h * h)
                                      : (F(d, 1, e, 1) - F(d, 1, e, -1) - F(d, -1, e, 1) +
                                         F(d, -1, e, -1)) /
                                            (4 * h * h);
            kappa += second * ((d == e ? size2 : 0) - g[d] * g[e]);
        }
#undef F
    return kappa / pow(size2, 1.5);
}

/* The derivatives of f, particle by particle: a.<grad C> / |<grad C>|^2 gives kappa. Bounded ones
 * are omitted. */
static void derivatives(void **state)
{
    (void)state;
    static const double density[2] = {1000, 1000};
    for (int dim = 2; dim <= 3; dim++) {
        const double reach = 4.1 * CLOUD_DP;
        drop s = drop_make(dim, 4, 5, 0.2, density);
        ASSERT_OK(s.sim, mps_model_set(s.sim, "tension", "radius", 4.1));
        ASSERT_OK(s.sim, mps_step(s.sim, 1, NULL));
        int checked = 0;
        for (int64_t i = 0; i < s.c.n && checked < 60; i++) {
            double grad[3] = {0}, grad2 = 0, a = 0, n0;
            mps_kernel kernel = {.struct_size = sizeof kernel};
            assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
            assert_int_equal(
                mps_lattice_constants(&kernel, dim, CLOUD_DP, 2.1 * CLOUD_DP, &n0, NULL), MPS_OK);
            for (int64_t j = 0; j < s.c.n; j++) {
                const double r2 = cloud_distance2(&s.c, i, j),
                             w = mps_kernel_value(&kernel, sqrt(r2), 2.1 * CLOUD_DP);
                for (int d = 0; d < dim && s.phase[j] != s.phase[i]; d++)
                    grad[d] += dim / n0 * w / r2 * (s.c.x[j * dim + d] - s.c.x[i * dim + d]);
            }
            for (int d = 0; d < dim; d++) {
                grad2 += grad[d] * grad[d];
                a += grad[d] * spy.a[i * dim + d];
            }
            if (grad2 == 0 || a == 0) continue;
            const double kappa = curvature_by_differences(&s, i, reach) * CLOUD_DP;
            if (fabs(kappa) > 0.9 * (dim - 1)) continue;
            ASSERT_NEAR(-a * 1000 / (sigma * grad2) * CLOUD_DP, kappa, 1e-3);
            checked++;
        }
        assert_true(checked > 20);
        drop_free(&s);
    }
}

/* The pressure equation balances the force by the jump sigma/R, higher inside. */
static void laplace_pressure(void **state)
{
    (void)state;
    static const double ratio[] = {1, 1000};
    for (int k = 0; k < 2; k++) {
        const double density[2] = {1000 / ratio[k], 1000};
        drop s = drop_make(2, 10, 9, 0, density);
        ASSERT_OK(s.sim, mps_model_use(s.sim, "source.mixed"));
        ASSERT_OK(s.sim, mps_model_set(s.sim, "source", "gamma", 0));
        ASSERT_OK(s.sim, mps_step(s.sim, 1, NULL));
        double mean[2] = {0}, count[2] = {0};
        for (int64_t i = 0; i < s.c.n; i++) {
            const double r = hypot(s.c.x[2 * i] - s.centre[0], s.c.x[2 * i + 1] - s.centre[1]) /
                             CLOUD_DP;
            const int out = r > 14;
            if ((r > 6 && r < 14) || r > 17) continue;
            mean[out] += spy.p[i];
            count[out]++;
        }
        const double jump = mean[0] / count[0] - mean[1] / count[1];
        print_message("density ratio %g: jump of pressure %.3f sigma/R\n", ratio[k],
                      jump * 10 * CLOUD_DP / sigma);
        ASSERT_NEAR(jump * 10 * CLOUD_DP / sigma, 1, k == 0 ? 0.03 : 0.08);
        drop_free(&s);
    }
}

/* One step of a drop from rest with one curvature for both models: jump of the pressure over (D-1)
 * sigma/R, and the root of the mean of rho u^2. */
static double step_from_rest(int dim, const char *model, double *motion)
{
    static const double density[2] = {1, 1000};
    const double radius = dim == 2 ? 10 : 6;
    drop s = drop_make(dim, radius, dim == 2 ? 9 : 6, 0.1, density);
    ASSERT_OK(s.sim, mps_model_use(s.sim, model));
    ASSERT_OK(s.sim, mps_model_set(s.sim, "tension", "sigma", sigma));
    ASSERT_OK(s.sim, mps_model_set(s.sim, "tension", "radius", dim == 2 ? 8.1 : 6.1));
    ASSERT_OK(s.sim, mps_model_use(s.sim, "source.mixed"));
    ASSERT_OK(s.sim, mps_model_set(s.sim, "source", "gamma", 0));
    ASSERT_OK(s.sim, mps_model_use(s.sim, "moments.bounded"));
    ASSERT_OK(s.sim, mps_model_use(s.sim, "gradient.corrected"));
    ASSERT_OK(s.sim, mps_step(s.sim, 1, NULL));
    double *u = field_by_id(s.sim, "velocity"), mean[2] = {0}, count[2] = {0};
    *motion = 0;
    for (int64_t i = 0; i < s.c.n; i++) {
        double r2 = 0;
        for (int d = 0; d < dim; d++) {
            r2 += pow((s.c.x[dim * i + d] - s.centre[d]) / CLOUD_DP, 2);
            *motion += density[s.phase[i]] * u[dim * i + d] * u[dim * i + d] / (double)s.c.n;
        }
        const int out = r2 > radius * radius;
        if (fabs(sqrt(r2) - radius) < 3) continue;
        mean[out] += spy.p[i];
        count[out]++;
    }
    *motion = sqrt(*motion);
    free(u);
    drop_free(&s);
    return (mean[0] / count[0] - mean[1] / count[1]) * radius * CLOUD_DP / ((dim - 1) * sigma);
}

static void jump_at_rest(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        double motion[2];
        const double force = step_from_rest(dim, "tension.csf", &motion[0]),
                     jump = step_from_rest(dim, "tension.jump", &motion[1]);
        print_message("%d-D: pressure %.3f by force, %.3f by jump; motion %.2g, %.2g\n", dim, force,
                      jump, motion[0], motion[1]);
        ASSERT_NEAR(jump, 1, dim == 2 ? 0.01 : 0.05); /* the radius is 10 dp, and 6 in 3-D */
        assert_true(motion[1] < 0.5 * motion[0]);
    }
}

/* Three phases, any number of threads: the same bytes, all finite. */
static void three_phases(void **state)
{
    (void)state;
    double *first = NULL;
    for (int threads = 1; threads <= 3; threads += 2) {
        cloud c = cloud_lattice(2, 24, 24, 1, 0.2, 5);
        int32_t phase[576];
        for (int i = 0; i < 576; i++) phase[i] = i / 24 < 12 ? 0 : i % 24 < 12 ? 3 : 7;
        mps_sim *sim = bare_sim(2, CLOUD_DP, 3.1, 1e-6);
        set_phase(sim, 3, 1, 0);
        set_phase(sim, 7, 800, 0);
        add_cloud(sim, &c, phase, NULL);
        ASSERT_OK(sim, mps_threads_set(sim, threads));
        ASSERT_OK(sim, mps_model_use(sim, "tension.csf"));
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        if (!first) {
            first = cloud_doubles(2 * c.n);
            memcpy(first, spy.a, (size_t)(2 * c.n) * sizeof *first);
        }
        assert_memory_equal(first, spy.a, (size_t)(2 * c.n) * sizeof *first);
        double most = 0;
        for (int64_t k = 0; k < 2 * c.n; k++) most = fmax(most, fabs(first[k]));
        assert_true(isfinite(most) && most > 0);
        mps_sim_destroy(sim);
        cloud_free(&c);
    }
    free(first);
}

/* Work of swelling of the drop about a centre, over sigma and (D-1) times its surface; 2-D. */
static double share_of_sigma(const cloud *c, const double centre[2], double radius)
{
    double work = 0;
    for (int64_t i = 0; i < c->n; i++) {
        const double r[2] = {c->x[2 * i] - centre[0], c->x[2 * i + 1] - centre[1]};
        if (hypot(r[0], r[1]) > 1.9 * radius) continue;
        for (int d = 0; d < 2; d++)
            work -= 1000 * CLOUD_DP * CLOUD_DP * spy.a[2 * i + d] * r[d] / sigma;
    }
    return work / (2 * 3.14159265358979323846 * radius);
}

/* Two drops of different phases: each has the tension of its own pair, and what is not set has the
 * setting. */
static void pairs(void **state)
{
    (void)state;
    static const double cases[4][3] = {{1, 3, 0},
                                       {0, 2, 5},
                                       {-1, 2, 0.5},
                                       {-1, -1, 4}}; /* pair 0-1, pair 0-2, setting; < 0: not set */
    cloud c = cloud_lattice(2, 80, 40, 1, 0, 9);
    int32_t *phase = cloud_phases(c.n);
    const double radius = 8 * CLOUD_DP, centre[2][2] = {{20.31 * CLOUD_DP, 20.17 * CLOUD_DP},
                                                        {60.31 * CLOUD_DP, 20.17 * CLOUD_DP}};
    for (int64_t i = 0; i < c.n; i++)
        for (int k = 0; k < 2; k++)
            if (hypot(c.x[2 * i] - centre[k][0], c.x[2 * i + 1] - centre[k][1]) < radius)
                phase[i] = k + 1;
    for (int n = 0; n < 4; n++) {
        mps_sim *sim = bare_sim(2, CLOUD_DP, 3.1, 1e-6);
        for (int p = 0; p < 3; p++) set_phase(sim, p, 1000, 0);
        add_cloud(sim, &c, phase, NULL);
        ASSERT_OK(sim, mps_model_use(sim, "tension.csf"));
        ASSERT_OK(sim, mps_model_set(sim, "tension", "sigma", cases[n][2] * sigma));
        if (cases[n][0] >= 0) ASSERT_OK(sim, mps_tension_set(sim, 0, 1, cases[n][0] * sigma));
        if (cases[n][1] >= 0) ASSERT_OK(sim, mps_tension_set(sim, 2, 0, cases[n][1] * sigma));
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        for (int k = 0; k < 2; k++) {
            const double wanted = cases[n][k] >= 0 ? cases[n][k] : cases[n][2];
            ASSERT_NEAR(share_of_sigma(&c, centre[k], radius), wanted, 0.03 * wanted);
        }
        mps_sim_destroy(sim);
    }
    free(phase);
    cloud_free(&c);
}

static void pairs_refused(void **state)
{
    (void)state;
    mps_sim *sim = bare_sim(2, CLOUD_DP, 3.1, 1e-6);
    double value = -7;
    set_phase(sim, 1, 1.2, 0);
    ASSERT_REFUSED(sim, mps_tension_get(sim, 0, 1, &value), MPS_E_ARG, "never set");
    ASSERT_OK(sim, mps_tension_set(sim, 1, 0, 0.05));
    ASSERT_OK(sim, mps_tension_get(sim, 0, 1, &value));
    assert_true(value == 0.05);
    ASSERT_REFUSED(sim, mps_tension_set(sim, 0, 1, -0.07), MPS_E_ARG, "is -0.07: must be >= 0");
    ASSERT_REFUSED(sim, mps_tension_set(sim, 0, 1, NAN), MPS_E_ARG, "phases 0 and 1");
    ASSERT_REFUSED(sim, mps_tension_set(sim, 0, 1, INFINITY), MPS_E_ARG, "finite");
    ASSERT_REFUSED(sim, mps_tension_set(sim, 0, 2, 0.07), MPS_E_ARG, "phase 2 is not defined");
    ASSERT_REFUSED(sim, mps_tension_set(sim, -1, 1, 0.07), MPS_E_ARG, "phase -1 is not defined");
    ASSERT_REFUSED(sim, mps_tension_set(sim, 0, 16, 0.07), MPS_E_ARG, "phase 16 is not defined");
    ASSERT_REFUSED(sim, mps_tension_set(sim, 1, 1, 0.07), MPS_E_ARG, "phase 1 with itself");
    ASSERT_REFUSED(sim, mps_tension_get(sim, 0, 1, NULL), MPS_E_ARG, "NULL");
    assert_int_equal(mps_tension_set(NULL, 0, 1, 0.07), MPS_E_ARG);
    assert_int_equal(mps_tension_get(NULL, 0, 1, &value), MPS_E_ARG);
    ASSERT_OK(sim, mps_tension_get(sim, 1, 0, &value));
    assert_true(value == 0.05);
    ASSERT_OK(sim, mps_tension_set(sim, 0, 1, 0)); /* none is a value */
    ASSERT_OK(sim, mps_tension_get(sim, 1, 0, &value));
    assert_true(value == 0);
    ASSERT_OK(sim, mps_model_use(sim, "tension.csf"));
    ASSERT_REFUSED(sim, mps_model_set(sim, "tension", "sigma", -0.07), MPS_E_ARG, "sigma is -0.07");
    mps_sim_destroy(sim);
}

/* The shortest capillary wave. */
static void time_step(void **state)
{
    (void)state;
    const double two[4] = {0, 0, CLOUD_DP, 0};
    const int32_t phase[2] = {0, 1};
    const cloud c = {2, 2, (double *)two};
    mps_step_info info;
    mps_time_control control;
    mps_sim *sim = bare_sim(2, CLOUD_DP, 3.1, 0);
    assert_int_equal(mps_time_control_init(&control, sizeof control), MPS_OK);
    control.gravity = control.viscous = -1;
    ASSERT_OK(sim, mps_time_control_set(sim, &control));
    set_phase(sim, 1, 500, 0);
    add_cloud(sim, &c, phase, NULL);
    ASSERT_OK(sim, mps_model_use(sim, "tension.csf"));
    ASSERT_OK(sim, mps_model_set(sim, "tension", "sigma", sigma));
    assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
    ASSERT_OK(sim, mps_step(sim, 1, &info));
    ASSERT_NEAR(info.dt, 0.5 * sqrt(750 * pow(CLOUD_DP, 3) / (2 * 3.14159265358979323846 * sigma)),
                1e-12);
    ASSERT_OK(sim, mps_tension_set(sim, 0, 1, 4 * sigma));
    ASSERT_OK(sim, mps_time_control_set(sim, &control));
    ASSERT_OK(sim, mps_step(sim, 1, &info));
    ASSERT_NEAR(info.dt, 0.25 * sqrt(750 * pow(CLOUD_DP, 3) / (2 * 3.14159265358979323846 * sigma)),
                1e-12);
    mps_sim_destroy(sim);
}

int main(void)
{
    struct CMUnitTest tests[] = {cmocka_unit_test(circles),
                                 cmocka_unit_test(spheres),
                                 cmocka_unit_test(heavy_drop),
                                 cmocka_unit_test(flat),
                                 cmocka_unit_test(derivatives),
                                 cmocka_unit_test(three_phases),
                                 cmocka_unit_test(laplace_pressure),
                                 cmocka_unit_test(time_step),
                                 cmocka_unit_test(pairs),
                                 cmocka_unit_test(pairs_refused),
                                 cmocka_unit_test(jump_at_rest)};
    take_turns(tests, sizeof tests / sizeof tests[0], 3);
    return cmocka_run_group_tests(tests, NULL, NULL);
}

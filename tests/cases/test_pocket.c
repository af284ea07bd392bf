/* SPDX-License-Identifier: BSD-3-Clause */
/* Trapped gas against exact solutions:
 *   slug    a slug of liquid on a closed column of gas: frequency, static sag, energy;
 *   films   of 1, 2, 4 rows between two pressures: acceleration;
 *   piston  a slug with an initial velocity towards a closed column, Bagnold: peak and rise time
 *   over impact numbers;
 *   moving  a slug in a rising tank: as in a tank at rest;
 *   bubble  in a round liquid: Minnaert's frequency, in 2-D and 3-D;
 *   stairs  a bubble cut from a lattice, small oscillations: energy;
 *   ullage  a slug between two closed gases: frequency. */
#include "pocket_fixture.h"
#include <stdlib.h>

static const double PI = 3.14159265358979;

enum { MOST = 4000 };

typedef struct series {
    int count;
    double t[MOST], y[MOST], speed[MOST], p[MOST], dt[MOST]; /* y, speed: means of the fluid */
    double volume;                                           /* of the first step */
} series;

static int note(void *user, mps_sim *sim, const mps_step_info *info)
{
    series *s = user;
    mps_lease x = {.struct_size = sizeof x}, u = x, kind = x;
    double y = 0, speed = 0, count = 0;
    assert_true(s->count < MOST);
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_READ, &u));
    ASSERT_OK(sim, mps_lease_begin(sim, "kind", MPS_READ, &kind));
    for (int64_t i = 0; i < x.count; i++) {
        if (kind.integers[i] != MPS_FLUID) continue;
        y += x.data[x.stride * i + 1];
        speed += u.data[x.stride * i + 1];
        count++;
    }
    ASSERT_OK(sim, mps_lease_end(sim, &x));
    ASSERT_OK(sim, mps_lease_end(sim, &u));
    ASSERT_OK(sim, mps_lease_end(sim, &kind));
    if (s->count == 0) s->volume = info->pocket_volume;
    s->t[s->count] = info->t;
    s->dt[s->count] = info->dt;
    s->y[s->count] = y / count;
    s->speed[s->count] = speed / count;
    s->p[s->count++] = info->pocket_pressure;
    assert_int_equal(info->pockets, 1);
    return 0;
}

/* Mean distance of upward crossings of the mean. */
static double frequency(const series *s, const double *value)
{
    double mean = 0, first = 0, last = 0;
    int crossings = 0;
    for (int k = 0; k < s->count; k++) mean += value[k] / s->count;
    for (int k = 1; k < s->count; k++) {
        const double a = value[k - 1] - mean, b = value[k] - mean;
        if (!(a < 0 && b >= 0)) continue;
        last = s->t[k] - b / (b - a) * (s->t[k] - s->t[k - 1]);
        if (crossings++ == 0) first = last;
    }
    assert_true(crossings > 2);
    return (crossings - 1) / (last - first);
}

/* ---- the exact slug: RHO length y'' = P [(h/y)^e - 1] - RHO length g, y the height of the gas
 * ---- */

static double gauge(double height, double y)
{
    return AMBIENT * (pow(height / y, EXPONENT) - 1);
}

/* Fills t, y and p with equal steps up to t_end. */
static void solve(series *s, double height, double length, double gravity, double speed,
                  double t_end)
{
    enum { PARTS = 50 };
    double y = height, u = -speed;
    const double dt = t_end / (MOST * PARTS);
    s->count = MOST;
    for (int k = 0; k < MOST; k++) {
        for (int part = 0; part < PARTS; part++) {
            u += 0.5 * dt * (gauge(height, y) / (RHO * length) - gravity);
            y += dt * u;
            u += 0.5 * dt * (gauge(height, y) / (RHO * length) - gravity);
        }
        s->t[k] = (k + 1) * dt * PARTS;
        s->y[k] = y;
        s->p[k] = gauge(height, y);
    }
}

/* Mean of y from the first step to the last upward crossing of it: over whole periods. */
static double mean_place(const series *s, double period)
{
    const double end = floor(s->t[s->count - 1] / period) * period;
    double sum = 0, before = 0;
    for (int k = 0; k < s->count && s->t[k] <= end; k++) {
        sum += s->y[k] * (s->t[k] - before);
        before = s->t[k];
    }
    return sum / before;
}

/* Frequency and static sag, at 10 and 20 rows; the energy closes. */
static void slug(void **state)
{
    (void)state;
    static series s, exact;
    for (int rows = 10; rows <= 20; rows += 10) {
        const double height = 19.5 * DP, length = rows * DP, t_end = 0.32;
        mps_energy e;
        assert_int_equal(mps_energy_init(&e, sizeof e), MPS_OK);
        mps_sim *sim = begin(2, 9.81, 150);
        add_slug(sim, 20, 20, rows, 60, 0);
        s.count = 0;
        ASSERT_OK(sim, mps_run(sim, t_end, note, &s));
        solve(&exact, height, length, 9.81, 0, t_end);
        const double f = frequency(&s, s.y), f0 = frequency(&exact, exact.y);
        const double start = (20 + 0.5 * (rows - 1)) * DP;
        const double sag = start - mean_place(&s, 1 / f),
                     sag0 = height - mean_place(&exact, 1 / f0);
        ASSERT_OK(sim, mps_energy_get(sim, &e));
        const double exchanged = e.mass * 9.81 * 2 * sag0;
        print_message("slug of %d rows: frequency %.4f, exact %.4f Hz (%+.2f %%); sag %.3f, exact "
                      "%.3f mm (%+.2f %%); energy %+.2f %% of that exchanged\n",
                      rows, f, f0, 100 * (f / f0 - 1), 1e3 * sag, 1e3 * sag0,
                      100 * (sag / sag0 - 1), 100 * e.numerical / exchanged);
        ASSERT_NEAR(f / f0, 1, 0.01);
        ASSERT_NEAR(sag / sag0, 1, 0.01);
        ASSERT_NEAR(e.numerical / exchanged, 0, 0.005);
        ASSERT_NEAR(s.volume / (20 * DP * height), 1, 0.002);
        mps_sim_destroy(sim);
    }
}

/* A tank that rises steadily: the work of the gas is that relative to it, the walls do the rest. */
static void moving(void **state)
{
    (void)state;
    static series s;
    const double speed = 1, t_end = 0.15;
    double rest[2];
    for (int rises = 0; rises < 2; rises++) {
        const mps_harmonic rise = {
            .dof = MPS_MOVE_Y, .amplitude = 1e3 * speed, .omega = 1e-3}; /* sin: steady so early */
        mps_energy e;
        assert_int_equal(mps_energy_init(&e, sizeof e), MPS_OK);
        mps_sim *sim = begin(2, 9.81, 150);
        add_slug(sim, 20, 20, 10, 60, 0);
        if (rises) {
            const double centre[2] = {0, 0};
            ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &rise));
            ASSERT_OK(sim, mps_motion_centre_set(sim, centre, MPS_START_WITH_TANK));
        }
        s.count = 0;
        ASSERT_OK(sim, mps_run(sim, t_end, note, &s));
        ASSERT_OK(sim, mps_energy_get(sim, &e));
        rest[rises] = e.numerical / (e.mass * 9.81 * 0.0027);
        print_message("slug in a tank that %s: rest of energy %+.4f of that exchanged\n",
                      rises ? "rises" : "rests", rest[rises]);
        mps_sim_destroy(sim);
    }
    ASSERT_NEAR(rest[0], 0, 0.01);
    ASSERT_NEAR(rest[1], 0, 0.05);
}

/* rho n dp a = p - p' for films of n rows. */
static void films(void **state)
{
    (void)state;
    static series s;
    static const int rows[] = {1, 2, 4};
    for (int f = 0; f < 3; f++) {
        mps_sim *sim = begin(2, 9.81, 0);
        double square = 0, product = 0;
        /* a row of particles is spray by default */
        if (rows[f] == 1) ASSERT_OK(sim, mps_model_set(sim, "surface", "spray", 0.05));
        add_slug(sim, 20, 20, rows[f], 60, 0);
        s.count = 0;
        ASSERT_OK(sim, mps_run(sim, 0.02, note, &s));
        for (int k = 1; k < s.count; k++) {
            const double wanted = s.p[k] / (RHO * rows[f] * DP);
            const double got = (s.speed[k] - s.speed[k - 1]) / s.dt[k] + 9.81;
            square += wanted * wanted;
            product += wanted * got;
        }
        print_message("film of %d rows: acceleration %.4f of (p - p')/(rho n dp)\n", rows[f],
                      product / square);
        ASSERT_NEAR(product / square, 1, 0.03);
        mps_sim_destroy(sim);
    }
}

/* Largest pressure, and the time from half of it. */
static double peak(const series *s, double *rise)
{
    int top = 0;
    for (int k = 0; k < s->count; k++)
        if (s->p[k] > s->p[top]) top = k;
    int k = top;
    while (k > 0 && s->p[k] > 0.5 * s->p[top]) k--;
    const double share = (0.5 * s->p[top] - s->p[k]) / (s->p[k + 1] - s->p[k]);
    *rise = s->t[top] - s->t[k] - share * (s->t[k + 1] - s->t[k]);
    return s->p[top];
}

/* Impact numbers rho L u^2/(P h) over three decades. */
static void piston(void **state)
{
    (void)state;
    static series s, exact;
    static const double numbers[] = {0.01, 0.1, 1, 10};
    for (int k = 0; k < 4; k++) {
        const double height = 59.5 * DP, length = 20 * DP;
        const double speed = sqrt(numbers[k] * AMBIENT * height / (RHO * length));
        const double t_end = fmin(0.06, 1.5 * height / speed);
        double rise, rise0;
        mps_sim *sim = begin(2, 0, 50);
        add_slug(sim, 10, 60, 20, 80, speed);
        s.count = 0;
        ASSERT_OK(sim, mps_run(sim, t_end, note, &s));
        solve(&exact, height, length, 0, speed, t_end);
        const double p = peak(&s, &rise), p0 = peak(&exact, &rise0);
        print_message(
            "impact number %g: peak %.4g, exact %.4g Pa (%+.1f %%); from half of it %.3f, "
            "exact %.3f ms (%+.1f %%)\n",
            numbers[k], p, p0, 100 * (p / p0 - 1), 1e3 * rise, 1e3 * rise0,
            100 * (rise / rise0 - 1));
        ASSERT_NEAR(p / p0, 1, 0.03);
        ASSERT_NEAR(rise / rise0, 1, 0.02);
        mps_sim_destroy(sim);
    }
}

typedef struct ring {
    int dim;
    double centre[3], inner, outer;
} ring;

static double distance(const ring *r, const double *x)
{
    double square = 0;
    for (int d = 0; d < r->dim; d++) square += (x[d] - r->centre[d]) * (x[d] - r->centre[d]);
    return sqrt(square);
}

static int in_ring(void *user, const double *x)
{
    const ring *r = user;
    const double d = distance(r, x);
    return d > r->inner && d < r->outer;
}

/* Radial flow of incompressible liquid, `speed` at the bubble. */
static void blow_up(mps_sim *sim, const ring *r, double speed)
{
    mps_lease x = {.struct_size = sizeof x}, u = x, kind = x;
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &u));
    ASSERT_OK(sim, mps_lease_begin(sim, "kind", MPS_READ, &kind));
    for (int64_t i = 0; i < u.count; i++) {
        const double *X = x.data + i * r->dim, away = distance(r, X);
        if (kind.integers[i] != MPS_FLUID) continue;
        for (int d = 0; d < r->dim; d++)
            u.data[i * r->dim + d] = speed * pow(r->inner / away, r->dim - 1) *
                                     (X[d] - r->centre[d]) / away;
    }
    ASSERT_OK(sim, mps_lease_end(sim, &x));
    ASSERT_OK(sim, mps_lease_end(sim, &u));
    ASSERT_OK(sim, mps_lease_end(sim, &kind));
}

/* A bubble of radius a in round liquid of radius R: w^2 = 2 e P/(rho a^2 ln(R/a)) in 2-D,
 * w^2 = 3 e P/(rho a^2 (1 - a/R)) in 3-D. */
static void swing(int dim, int size, int outer)
{
    static series s;
    ring r = {.dim = dim, .inner = size * DP, .outer = outer * DP};
    int64_t count = 0;
    const double side = 2 * r.outer + (dim == 2 ? 16 : 8) * DP;
    for (int d = 0; d < dim; d++) r.centre[d] = 0.5 * side + 0.1 * d * DP;
    mps_sim *sim = begin(dim, 0, 0);
    add_tank(sim, side, side, side);
    ASSERT_OK(sim, mps_fill_add(sim, 0, in_ring, &r, &count));
    blow_up(sim, &r, 0.5);
    const double a = r.inner;
    const double R = dim == 2 ? sqrt((double)count * DP * DP / PI + a * a)
                              : cbrt((double)count * DP * DP * DP * 0.75 / PI + a * a * a);
    const double inertia = dim == 2 ? log(R / a) / 2 : (1 - a / R) / 3;
    const double wanted = sqrt(EXPONENT * AMBIENT / (RHO * inertia)) / (2 * PI * a);
    s.count = 0;
    ASSERT_OK(sim, mps_run(sim, 4.3 / wanted, note, &s));
    const double f = frequency(&s, s.p);
    const double radius = dim == 2 ? sqrt(s.volume / PI) : cbrt(0.75 * s.volume / PI);
    print_message(
        "bubble of %d dp in %d-D: frequency %.3f, exact %.3f Hz (%+.1f %%); radius by its "
        "volume %.3f dp\n",
        size, dim, f, wanted, 100 * (f / wanted - 1), radius / DP);
    ASSERT_NEAR(f / wanted, 1, 0.05);
    ASSERT_NEAR(radius / a, 1, 0.03);
    mps_sim_destroy(sim);
}

static void bubble(void **state)
{
    (void)state;
    swing(2, 8, 24);
    swing(2, 12, 36);
    swing(3, 6, 14);
}

/* Largest rest of the energy so far, of the energy of the first step. */
typedef struct rest {
    double first, most;
} rest;

static int note_rest(void *user, mps_sim *sim, const mps_step_info *info)
{
    rest *r = user;
    mps_energy e;
    assert_int_equal(mps_energy_init(&e, sizeof e), MPS_OK);
    ASSERT_OK(sim, mps_energy_get(sim, &e));
    if (r->first == 0) r->first = e.kinetic;
    r->most = fmax(r->most, fabs(e.numerical) / r->first);
    assert_int_equal(info->pockets, 1);
    return 0;
}

/* A bubble cut from the lattice has stairs for a surface, which swings by 0.025 dp. Its gas has the
 * flux of the liquid: with that of the surface alone the rest was 0.28 of the energy. */
static void stairs(void **state)
{
    (void)state;
    const double side = 64 * DP;
    ring r = {.dim = 2, .centre = {0.5 * side, 0.501 * side}, .inner = 8 * DP, .outer = 24 * DP};
    rest found = {0};
    mps_time_control control;
    assert_int_equal(mps_time_control_init(&control, sizeof control), MPS_OK);
    control.dt_max = 2e-4;
    mps_sim *sim = begin(2, 0, 0);
    ASSERT_OK(sim, mps_time_control_set(sim, &control));
    add_tank(sim, side, side, 0);
    ASSERT_OK(sim, mps_fill_add(sim, 0, in_ring, &r, NULL));
    blow_up(sim, &r, 0.05);
    ASSERT_OK(sim, mps_run(sim, 0.063, note_rest, &found));
    print_message("bubble of 8 dp in 2-D, two periods: rest of the energy at most %.3f\n",
                  found.most);
    ASSERT_NEAR(found.most, 0, 0.075);
    mps_sim_destroy(sim);
}

/* Two closed gases are two springs: w^2 = e P (1/h + 1/h')/(rho L). */
static void ullage(void **state)
{
    (void)state;
    static series s;
    const double below = 19.5 * DP, above = 20.5 * DP, width = 20 * DP;
    mps_sim *sim = begin(2, 2, 50);
    ASSERT_OK(sim, mps_model_set(sim, "gas", "ullage", width * (below + above)));
    add_slug(sim, 20, 20, 20, 20, 0);
    s.count = 0;
    ASSERT_OK(sim, mps_run(sim, 0.4, note, &s));
    const double f = frequency(&s, s.y);
    const double wanted = sqrt(EXPONENT * AMBIENT * (1 / below + 1 / above) / (RHO * 20 * DP)) /
                          (2 * PI);
    print_message("slug between two gases: frequency %.4f, exact %.4f Hz (%+.2f %%)\n", f, wanted,
                  100 * (f / wanted - 1));
    ASSERT_NEAR(f / wanted, 1, 0.01);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(slug),   cmocka_unit_test(moving),
                                       cmocka_unit_test(films),  cmocka_unit_test(piston),
                                       cmocka_unit_test(bubble), cmocka_unit_test(stairs),
                                       cmocka_unit_test(ullage)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

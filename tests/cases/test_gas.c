/* SPDX-License-Identifier: BSD-3-Clause */
/* Compressible gas. With the scheme imps: a column is compressed by its own weight, a swirl in a
 * closed tank keeps its mean pressure, half cells of walls are compressible. With mmps: a round
 * pocket oscillates. */
#include "../tags.h"
#include "../unit/tank_fixture.h"
#include <mps/model.h>
#include <mps/ppe.h>
#include <stdlib.h>

static const double dp = 0.05, width = 0.4, height = 1, rho = 1000, ambient = 2e4;

/* Heavy and soft, so that it is compressed by per cents. exponent 0: linear, with the speed of
 * sound of 1.4. */
static mps_sim *column(double exponent)
{
    mps_sim *sim = new_sim(2, dp);
    mps_phase gas;
    assert_int_equal(mps_phase_init(&gas, sizeof gas), MPS_OK);
    gas.density = rho;
    gas.viscosity = 100; /* to come to rest */
    ASSERT_OK(sim, mps_phase_set(sim, 0, &gas));
    add_tank(sim, width, height, 0);
    fill_depth(sim, width, height, 0);
    ASSERT_OK(sim, mps_model_remove(sim, "surface"));
    if (exponent > 0) {
        ASSERT_OK(sim, mps_model_use(sim, "gas.isentropic"));
        ASSERT_OK(sim, mps_model_set(sim, "gas", "ambient", ambient));
        ASSERT_OK(sim, mps_model_set(sim, "gas", "exponent", exponent));
        ASSERT_OK(sim, mps_solver_use(sim, "sundials.kinsol", NULL));
    } else {
        ASSERT_OK(sim, mps_model_use(sim, "gas.compressible"));
        ASSERT_OK(sim, mps_model_set(sim, "gas", "sound", sqrt(1.4 * ambient / rho)));
    }
    ASSERT_OK(sim, mps_model_set(sim, "gas", "phase", 0));
    return sim;
}

static double volume_by_law(double exponent, double p)
{
    return exponent > 0 ? pow(1 + p / ambient, -1 / exponent) : 1 / (1 + p / (1.4 * ambient));
}

typedef struct place {
    double y, p;
} place;

static int by_height(const void *a, const void *b)
{
    const double x = ((const place *)a)->y, y = ((const place *)b)->y;
    return (x > y) - (x < y);
}

/* The fluid from below; free() it. */
static place *sorted(mps_sim *sim, int64_t *count)
{
    const int32_t *kinds;
    mps_lease p = {.struct_size = sizeof p}, x = {.struct_size = sizeof x};
    place *all = calloc((size_t)mps_particles_count(sim, -1), sizeof *all);
    *count = 0;
    ASSERT_OK(sim, tags_peek(sim, NULL, &kinds, NULL, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, "pressure", MPS_READ, &p));
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
    for (int64_t i = 0; i < p.count; i++)
        if (kinds[i] == MPS_FLUID) all[(*count)++] = (place){x.data[2 * i + 1], p.data[i]};
    ASSERT_OK(sim, mps_lease_end(sim, &p));
    ASSERT_OK(sim, mps_lease_end(sim, &x));
    qsort(all, (size_t)*count, sizeof *all, by_height);
    return all;
}

/* Height of the lowest `rows` rows of `columns` particles, minus the half cell of the floor, and
 * its value by the gas law. */
static double share_height(const place *all, int64_t columns, int64_t rows, double exponent,
                           double *law)
{
    double below = 0, above = 0;
    *law = 0;
    for (int64_t k = 0; k < rows * columns; k++)
        *law += volume_by_law(exponent, all[k].p) * dp / (double)columns;
    for (int64_t k = 0; k < columns; k++) {
        below += all[(rows - 1) * columns + k].y / (double)columns;
        above += all[rows * columns + k].y / (double)columns;
    }
    return 0.5 * (below + above) - 0.5 * dp;
}

/* The volume of each quarter of the column is that of its pressures by the gas law, and the weight
 * is carried. */
static void settled(void **state)
{
    (void)state;
    static const double exponents[] = {0, 1, 1.4};
    for (int e = 0; e < 3; e++) {
        int64_t count;
        double law;
        mps_sim *sim = column(exponents[e]);
        ASSERT_OK(sim, mps_run(sim, 2, NULL, NULL));
        place *all = sorted(sim, &count);
        const int64_t columns = 7, rows = count / columns;
        assert_int_equal(count, columns * 19);
        for (int64_t part = 1; part < 4; part++) {
            const int64_t lower = rows * part / 4;
            const double got = share_height(all, columns, lower, exponents[e], &law);
            print_message(
                "exponent %g, lowest %lld rows: compressed %.1f %%, volume %+.2f %% of the law's\n",
                exponents[e], (long long)lower, 100 * (1 - law / ((double)lower * dp)),
                100 * (got / law - 1));
            ASSERT_NEAR(got / law, 1, 0.01);
            if (part < 3) assert_true(law < 0.93 * (double)lower * dp);
        }
        double low = 0, high = 0;
        for (int64_t k = 0; k < columns; k++) {
            low += all[k].p / (double)columns;
            high += all[count - 1 - k].p / (double)columns;
        }
        const double weight = rho * 9.81 * (all[count - 1].y - all[0].y);
        print_message("exponent %g: weight %+.2f %%\n", exponents[e],
                      100 * ((low - high) / weight - 1));
        ASSERT_NEAR((low - high) / weight, 1,
                    0.02); /* inertia and weight of a particle are rho0's, compressed or not */
        free(all);
        mps_sim_destroy(sim);
    }
}

/* Mean pressure of air that swirls in a full tank. */
static double swirl(double conserve)
{
    static const double pi = 3.14159265358979323846, speed = 5;
    const int32_t *kinds;
    double sum = 0, count = 0;
    mps_phase air;
    mps_lease u = {.struct_size = sizeof u}, x = {.struct_size = sizeof x},
              p = {.struct_size = sizeof p};
    mps_sim *sim = new_sim(2, dp);
    assert_int_equal(mps_phase_init(&air, sizeof air), MPS_OK);
    air.density = 1.2;
    air.viscosity = 1.8e-5;
    ASSERT_OK(sim, mps_phase_set(sim, 0, &air));
    add_tank(sim, 1, 1, 0);
    fill_depth(sim, 1, 1, 0);
    ASSERT_OK(sim, mps_model_remove(sim, "surface"));
    ASSERT_OK(sim, mps_model_use(sim, "gas.compressible"));
    ASSERT_OK(sim, mps_model_set(sim, "gas", "phase", 0));
    ASSERT_OK(sim, mps_model_set(sim, "gas", "conserve", conserve));
    ASSERT_OK(sim, tags_peek(sim, NULL, &kinds, NULL, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &u));
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
    for (int64_t i = 0; i < u.count; i++) {
        if (kinds[i] != MPS_FLUID) continue;
        u.data[2 * i] = speed * sin(pi * x.data[2 * i]) * cos(pi * x.data[2 * i + 1]);
        u.data[2 * i + 1] = -speed * cos(pi * x.data[2 * i]) * sin(pi * x.data[2 * i + 1]);
    }
    ASSERT_OK(sim, mps_lease_end(sim, &u));
    ASSERT_OK(sim, mps_lease_end(sim, &x));
    ASSERT_OK(sim, mps_run(sim, 0.1, NULL, NULL));
    ASSERT_OK(sim, tags_peek(sim, NULL, &kinds, NULL, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, "pressure", MPS_READ, &p));
    for (int64_t i = 0; i < p.count; i++) {
        if (kinds[i] != MPS_FLUID) continue;
        sum += p.data[i];
        count++;
    }
    ASSERT_OK(sim, mps_lease_end(sim, &p));
    mps_sim_destroy(sim);
    return sum / count;
}

/* The tank is rigid: the mean cannot change. Left to the sums of divergences it runs away by many
 * times rho u^2 = 30 Pa. */
static void mean_pressure(void **state)
{
    (void)state;
    const double kept = swirl(1), left = swirl(0);
    print_message("mean pressure after 0.1 s: %.3g Pa, without conserve %.3g Pa\n", kept, left);
    ASSERT_NEAR(kept, 0, 0.3);
    assert_true(fabs(left) > 100);
}

/* ---- the gas of a full tank, by the compression of its rows ------------------------------- */

static double release; /* sum over all rows, for 1 Pa, in cells of the lattice */

static int count_cells(mps_stage *s)
{
    const double *gas = s->data[0];
    const double whole = 1.0 / (rho * 1.4 * ambient / rho * s->view->dt * s->view->dt);
    release = 0;
    for (int64_t i = 0; i < s->view->n; i++) release += gas[i] / whole;
    return 0;
}

static const mps_use counter_uses[] = {{"gas_shift", MPS_USE_READ}};
static const mps_verb counter_verbs[] = {
    {.hook = MPS_SOURCE, .use_count = 1, .uses = counter_uses, .after = "*", .run = count_cells}};
static const mps_model_ops counter = {.struct_size = sizeof(mps_model_ops),
                                      .api = MPS_MODEL_API,
                                      .name = "counter.gas",
                                      .help = "adds up the compressibility of the gas",
                                      .verb_count = 1,
                                      .verbs = counter_verbs};

/* Walls represent half cells, edges quarters, corners eighths: the whole tank is compressible, for
 * any size. */
static void walls_give_way(void **state)
{
    (void)state;
    static const int cells[][3] = {{8, 20, 1}, {4, 6, 1}, {4, 5, 6}};
    for (int e = 0; e < 6; e++) {
        const int *n = cells[e % 3];
        const int dim = n[2] > 1 ? 3 : 2;
        mps_sim *sim = new_sim(dim, dp);
        mps_phase gas;
        assert_int_equal(mps_phase_init(&gas, sizeof gas), MPS_OK);
        gas.density = rho;
        ASSERT_OK(sim, mps_phase_set(sim, 0, &gas));
        add_tank(sim, n[0] * dp, n[1] * dp, n[2] * dp);
        fill_depth(sim, n[0] * dp, n[1] * dp, n[2] * dp);
        ASSERT_OK(sim, mps_model_remove(sim, "surface"));
        ASSERT_OK(sim, mps_model_use(sim, e < 3 ? "gas.compressible" : "gas.isentropic"));
        if (e < 3) ASSERT_OK(sim, mps_model_set(sim, "gas", "sound", sqrt(1.4 * ambient / rho)));
        if (e >= 3) ASSERT_OK(sim, mps_model_set(sim, "gas", "ambient", ambient));
        if (e >= 3) ASSERT_OK(sim, mps_solver_use(sim, "sundials.kinsol", NULL));
        ASSERT_OK(sim, mps_model_set(sim, "gas", "phase", 0));
        ASSERT_OK(sim, mps_model_register(sim, &counter));
        ASSERT_OK(sim, mps_model_use(sim, "counter.gas"));
        ASSERT_OK(sim, mps_step(sim, 1e-5, NULL));
        ASSERT_NEAR(release, n[0] * n[1] * n[2],
                    0.15 * (dim == 3 ? 8 : 4)); /* at corners pairs around the edge are missing */
        mps_sim_destroy(sim);
    }
}

/* ---- a round pocket in round water, in a closed box of gas, 2-D, without gravity ------------- */

enum { PEAKS = 3 };
static const double grid = 0.01, sound = 340, air = 1.2;

typedef struct pocket {
    double centre, inner, outer; /* of water */
    double pressure, t;          /* of the pocket less that of the gas outside, at the last step */
    int crossings;               /* upward */
    double first, last;          /* crossings */
    double most, peak[PEAKS];    /* since the last crossing; of each period */
} pocket;

static double from_centre(const pocket *q, const double *x)
{
    return hypot(x[0] - q->centre, x[1] - q->centre);
}

static int in_water(void *user, const double *x)
{
    const pocket *q = user;
    const double r = from_centre(q, x);
    return r > q->inner && r < q->outer;
}

static void follow(pocket *q, double t, double p)
{
    if (q->pressure < 0 && p >= 0) {
        q->last = t - (t - q->t) * p / (p - q->pressure);
        if (q->crossings++ == 0)
            q->first = q->last;
        else if (q->crossings <= PEAKS + 1)
            q->peak[q->crossings - 2] = q->most;
        q->most = 0;
    }
    q->most = fmax(q->most, p);
    q->pressure = p;
    q->t = t;
}

static int note_pocket(void *user, mps_sim *sim, const mps_step_info *info)
{
    pocket *q = user;
    double sum[2] = {0}, count[2] = {0};
    const int32_t *kinds, *phases;
    mps_lease x = {.struct_size = sizeof x}, p = x;
    ASSERT_OK(sim, tags_peek(sim, NULL, &kinds, &phases, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
    ASSERT_OK(sim, mps_lease_begin(sim, "pressure", MPS_READ, &p));
    for (int64_t i = 0; i < p.count; i++) {
        if (kinds[i] != MPS_FLUID || phases[i] != 1) continue;
        const int outside = from_centre(q, x.data + 2 * i) > 0.5 * (q->inner + q->outer);
        sum[outside] += p.data[i];
        count[outside]++;
    }
    ASSERT_OK(sim, mps_lease_end(sim, &x));
    ASSERT_OK(sim, mps_lease_end(sim, &p));
    follow(q, info->t, sum[0] / count[0] - sum[1] / count[1]);
    return 0;
}

/* Water and gas at rest; *water: number of particles. */
static mps_sim *fill_pocket(pocket *q, double side, int64_t *water)
{
    mps_config config;
    mps_phase fluid;
    mps_sim *sim = NULL;
    const double lo[2] = {0, 0}, hi[2] = {side, side};
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dim = 2;
    config.dp = grid;
    config.gravity[1] = 0;
    config.velocity_scale = sqrt(9.81 * grid);
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    ASSERT_OK(sim, mps_preset_use(sim, "mmps"));
    assert_int_equal(mps_phase_init(&fluid, sizeof fluid), MPS_OK);
    fluid.density = 1000;
    ASSERT_OK(sim, mps_phase_set(sim, 0, &fluid));
    fluid.density = air;
    ASSERT_OK(sim, mps_phase_set(sim, 1, &fluid));
    add_tank(sim, side, side, 0);
    ASSERT_OK(sim, mps_fill_add(sim, 0, in_water, q, water));
    ASSERT_OK(sim, mps_fill_box_add(sim, 1, lo, hi, NULL, NULL));
    return sim;
}

/* Radial flow of the water; returns the particles of the pocket. */
static int64_t push_water(mps_sim *sim, const pocket *q, double speed)
{
    int64_t cells = 0;
    const int32_t *kinds, *phases;
    mps_lease x = {.struct_size = sizeof x}, u = x;
    ASSERT_OK(sim, tags_peek(sim, NULL, &kinds, &phases, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &u));
    for (int64_t i = 0; i < u.count; i++) {
        const double r = from_centre(q, x.data + 2 * i);
        if (kinds[i] != MPS_FLUID) continue;
        cells += phases[i] == 1 && r < 0.5 * (q->inner + q->outer);
        for (int d = 0; d < 2 && phases[i] == 0; d++)
            u.data[2 * i + d] = speed * q->inner * (x.data[2 * i + d] - q->centre) / (r * r);
    }
    ASSERT_OK(sim, mps_lease_end(sim, &x));
    ASSERT_OK(sim, mps_lease_end(sim, &u));
    return cells;
}

/* w^2 = 2 pi rho c^2 (1/V + 1/V')/(rho_w ln(R/a)), V and V' the volumes of both gases. The faces of
 * the pocket move with the water half a spacing behind them, so a pocket rings slower, w
 * a/(a + dp/2). The implicit step damps it by pi w dt/gain a period. */
static void ring(double radius, double outer, double dt)
{
    static const double pi = 3.14159265358979323846, gain = 0.7;
    const double side = ceil(2 * outer + 12) * grid;
    int64_t water = 0;
    mps_time_control control;
    pocket q = {.centre = 0.5 * side, .inner = radius * grid, .outer = outer * grid};
    mps_sim *sim = fill_pocket(&q, side, &water);
    const int64_t cells = push_water(sim, &q, 0.02);
    const double cell = grid * grid, volume = (double)cells * cell, a = sqrt(volume / pi);
    const double R = sqrt((double)water * cell / pi + a * a), outside = side * side - pi * R * R;
    const double omega = sqrt(2 * pi * air * sound * sound * (1 / volume + 1 / outside) /
                              (1000 * log(R / a)));
    assert_int_equal(mps_time_control_init(&control, sizeof control), MPS_OK);
    control.dt = dt;
    ASSERT_OK(sim, mps_time_control_set(sim, &control));
    ASSERT_OK(sim, mps_run(sim, 1.3 * (PEAKS + 1.5) * 2 * pi / omega, note_pocket, &q));
    assert_true(q.crossings > PEAKS);
    const double f = (q.crossings - 1) / (q.last - q.first) * 2 * pi / omega;
    const double decrement = log(q.peak[0] / q.peak[PEAKS - 1]) / (PEAKS - 1);
    const double implicit = pi * omega * dt / gain;
    print_message("pocket of %lld particles, %.2f dp: frequency %+.1f %% of Minnaert's, "
                  "%+.1f %% of a/(a + dp/2); decrement %.3f, of the step %.3f\n",
                  (long long)cells, a / grid, 100 * (f - 1), 100 * (f * (1 + 0.5 * grid / a) - 1),
                  decrement, implicit);
    ASSERT_NEAR(f * (1 + 0.5 * grid / a), 1, 0.04);
    assert_true(decrement > 1.05 * implicit && decrement < 1.4 * implicit);
    mps_sim_destroy(sim);
}

static void pocket_rings(void **state)
{
    (void)state;
    ring(2.3, 6.9, 1e-4);
    ring(4.6, 13.8, 1e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(walls_give_way), cmocka_unit_test(settled),
                                       cmocka_unit_test(mean_pressure),
                                       cmocka_unit_test(pocket_rings)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

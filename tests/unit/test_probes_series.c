/* SPDX-License-Identifier: BSD-3-Clause */
/* Moving averages and samples: pressures written after each step are a known signal at known
 * times. */
#include "../tags.h"
#include "probe_fixture.h"

static const double lengths[] = {1e-3, 0.4e-3, 0.7e-3, 0.9e-3, 0.3e-3, 1.1e-3, 0.2e-3};

static double line(double t)
{
    return 300 + 5e5 * t;
}

static mps_sim *still(void)
{
    mps_sim *sim = filled(2, 0.05);
    mps_time_control control;
    mps_time_control_init(&control, sizeof control);
    control.dt = 1;
    ASSERT_OK(sim, mps_time_control_set(sim, &control));
    return sim;
}

static int32_t add(mps_sim *sim, double average, double rate)
{
    mps_probe p = probe_of(MPS_PROBE_WALL_PRESSURE, 0, 0.1, 0);
    int32_t id = -1;
    p.average = average;
    p.rate = rate;
    ASSERT_OK(sim, mps_probe_add(sim, &p, &id));
    return id;
}

static double now(mps_sim *sim)
{
    double t = NAN;
    ASSERT_OK(sim, mps_sim_time(sim, &t, NULL));
    return t;
}

static void write_pressure(mps_sim *sim, double value)
{
    for (int64_t i = 0; i < sim->world.particles.n; i++) sim->world.particles.load[i] = value;
}

/* A step of length number k, after which all pressures are line(t). */
static void step(mps_sim *sim, int k)
{
    assert_true(mps_step(sim, lengths[k % 7], NULL) >= 0);
    write_pressure(sim, line(now(sim)));
}

static double value_of(mps_sim *sim, int32_t id)
{
    double value = NAN;
    ASSERT_OK(sim, mps_probe_read(sim, id, &value));
    return value;
}

/* ---- averages ---- */

static void average_of_a_line(void **state)
{
    (void)state;
    mps_sim *sim = still();
    const double averages[] = {0.2e-3, 1.3e-3, 5e-3};
    int32_t id[3];
    for (int a = 0; a < 3; a++) id[a] = add(sim, averages[a], 0);
    step(sim, 0);
    for (int k = 1; k < 40; k++) {
        step(sim, k);
        /* the first pressure is used from 0 to the end of the first step */
        for (int a = 0; a < 3; a++) {
            const double t = now(sim), T = fmin(averages[a], t), early = fmax(0, 1e-3 - (t - T));
            const double mean = (line(1e-3) * early +
                                 line(0.5 * (t + fmax(t - T, 1e-3))) * (T - early)) /
                                T;
            if (k % 3)
                ASSERT_NEAR(value_of(sim, id[a]), mean,
                            1e-8); /* a sample is taken also when no call reads it */
        }
    }
    mps_sim_destroy(sim);
}

/* What is kept of the signal is no longer than the average needs. */
static void averages_need_little_memory(void **state)
{
    (void)state;
    mps_sim *sim = still();
    const int32_t id = add(sim, 3e-3, 0), fast = add(sim, 0, 1);
    for (int k = 0; k < 200; k++) step(sim, k);
    value_of(sim, id);
    const int64_t rows = sim->probes.list[id].series.rows;
    value_of(sim, id); /* a step is taken once */
    assert_int_equal(sim->probes.list[id].series.rows, rows);
    assert_true(sim->probes.list[id].series.row_capacity < 2 * 40);
    assert_true(sim->probes.list[fast].series.row_capacity < 2 * 8);
    mps_sim_destroy(sim);
}

static void average_before_the_first_step(void **state)
{
    (void)state;
    mps_sim *sim = still();
    const int32_t id = add(sim, 1e-2, 0);
    write_pressure(sim, 70);
    ASSERT_NEAR(value_of(sim, id), 70, 1e-9);
    step(sim, 0);
    ASSERT_NEAR(value_of(sim, id), line(1e-3), 1e-9);
    mps_sim_destroy(sim);
}

/* ---- samples ---- */

static void check_samples(mps_sim *sim, int32_t id, double rate, double average, int64_t first)
{
    int64_t count = -1;
    const double *t = NULL, *v = NULL;
    ASSERT_OK(sim, mps_probe_series(sim, id, &count, &t, &v));
    assert_int_equal(count, (int64_t)floor(now(sim) * rate + 1e-9) + 1 - first);
    for (int64_t k = 0; k < count; k++) {
        ASSERT_NEAR(t[k], (double)(k + first) / rate, 1e-15);
        if (t[k] >= 1e-3 + average) ASSERT_NEAR(v[k], line(t[k] - 0.5 * average), 1e-8);
    }
    if (first == 0) ASSERT_NEAR(v[0], line(1e-3), 1e-9);
}

/* Slower and faster than the steps, with and without an average; k / rate may be the end of a
 * step. */
static void samples_of_a_line(void **state)
{
    (void)state;
    const double rates[] = {150, 1000, 2500, 123456.7}, averages[] = {0, 0.8e-3};
    mps_sim *sim = still();
    int32_t id[8];
    for (int k = 0; k < 8; k++) id[k] = add(sim, averages[k / 4], rates[k % 4]);
    for (int k = 0; k < 40; k++) {
        step(sim, k);
        if (k % 5 == 0) check_samples(sim, id[k % 8], rates[k % 4], averages[k % 8 / 4], 0);
    }
    for (int k = 0; k < 8; k++) check_samples(sim, id[k], rates[k % 4], averages[k / 4], 0);
    mps_sim_destroy(sim);
}

static void samples_from_the_middle(void **state)
{
    (void)state;
    mps_sim *sim = still();
    for (int k = 0; k < 5; k++) step(sim, k);
    const double start = now(sim); /* 3.3 ms */
    const int32_t id = add(sim, 0, 1000);
    for (int k = 0; k < 10; k++) step(sim, k);
    check_samples(sim, id, 1000, 0, (int64_t)ceil(start * 1000));
    mps_sim_destroy(sim);
}

static void clearing(void **state)
{
    (void)state;
    mps_sim *sim = still();
    const int32_t id = add(sim, 0, 1000);
    int64_t count = -1;
    const double *t = NULL;
    for (int k = 0; k < 7; k++) step(sim, k); /* 4.6 ms */
    ASSERT_OK(sim, mps_probe_series(sim, id, NULL, NULL, NULL));
    ASSERT_OK(sim, mps_probe_series_clear(sim, id));
    ASSERT_OK(sim, mps_probe_series(sim, id, &count, NULL, NULL));
    assert_int_equal(count, 0);
    for (int k = 0; k < 7; k++) step(sim, k);
    ASSERT_OK(sim, mps_probe_series(sim, id, &count, &t, NULL));
    assert_int_equal(count, 5);
    ASSERT_NEAR(t[0], 5e-3, 1e-15);
    check_samples(sim, id, 1000, 0, 5);
    mps_sim_destroy(sim);
}

/* All components; the last step of a run is included, and its end is a sample. */
static void samples_of_forces(void **state)
{
    (void)state;
    mps_sim *sim = filled(2, 0.05);
    mps_probe p = probe_of(MPS_PROBE_FORCE, 0.2, 0, 0);
    int32_t id;
    int64_t count;
    const double *t, *v;
    double last[3];
    p.rate = 300;
    ASSERT_OK(sim, mps_probe_add(sim, &p, &id));
    assert_true(mps_run(sim, 0.01, NULL, NULL) >= 0);
    ASSERT_OK(sim, mps_probe_series(sim, id, &count, &t, &v));
    ASSERT_OK(sim, mps_probe_read(sim, id, last));
    assert_int_equal(count, 4);
    for (int d = 0; d < 3; d++) ASSERT_NEAR(v[9 + d], last[d], 1e-9 * fabs(last[1]));
    ASSERT_NEAR(v[1], -9810 * 0.05 * 0.4, 20);
    mps_sim_destroy(sim);
}

/* A gauge has a value before the first step, and probes do not change the run. */
static void samples_of_a_gauge(void **state)
{
    (void)state;
    mps_sim *sim[2];
    int64_t count;
    const double *v;
    mps_probe p = probe_of(MPS_PROBE_GAUGE, 0.2, 0, 0);
    int32_t id;
    p.rate = 1000;
    p.average = 2e-3;
    for (int k = 0; k < 2; k++) {
        sim[k] = filled(2, 0.05);
        if (k) ASSERT_OK(sim[k], mps_probe_add(sim[k], &p, &id));
        assert_true(mps_run(sim[k], 5e-3, NULL, NULL) >= 0);
    }
    ASSERT_OK(sim[1], mps_probe_series(sim[1], id, &count, NULL, &v));
    assert_int_equal(count, 6);
    ASSERT_NEAR(v[0], 0.05, 0.01 * dp);
    const mps__particles *a = &sim[0]->world.particles, *b = &sim[1]->world.particles;
    assert_memory_equal(a->x, b->x, (size_t)(2 * a->n) * sizeof *a->x);
    for (int k = 0; k < 2; k++) mps_sim_destroy(sim[k]);
}

/* A probe that cannot measure keeps the step from being done. */
static void walls_that_are_gone(void **state)
{
    (void)state;
    mps_sim *sim = filled(2, 0.05);
    static int64_t ids[20000];
    int64_t n = 0;
    add(sim, 0, 1000);
    assert_true(mps_step(sim, 1e-3, NULL) >= 0);
    const double t = now(sim);
    for (int64_t i = 0; i < sim->world.particles.n; i++)
        if (sim->world.particles.kind[i] == MPS_WALL) ids[n++] = sim->world.particles.id[i];
    ASSERT_OK(sim, mps_particles_remove(sim, n, ids));
    ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_STATE, "no step was done, probe 0");
    ASSERT_NEAR(now(sim), t, 0);
    mps_sim_destroy(sim);
}

static void refusals(void **state)
{
    (void)state;
    mps_sim *sim = still();
    int32_t id;
    int64_t count;
    mps_probe p;
#define REFUSE(change, word)                          \
    p = probe_of(MPS_PROBE_WALL_PRESSURE, 0, 0.1, 0); \
    change;                                           \
    ASSERT_REFUSED(sim, mps_probe_add(sim, &p, &id), MPS_E_ARG, word)
    REFUSE(p.average = -2, "average is -2");
    REFUSE(p.average = NAN, "average");
    REFUSE(p.average = INFINITY, "average is inf");
    REFUSE(p.rate = -1, "rate is -1");
    REFUSE(p.rate = NAN, "rate");
    REFUSE(p.rate = 2e9, "rate is 2e+09");
#undef REFUSE
    id = add(sim, 1e-3, 0);
    ASSERT_REFUSED(sim, mps_probe_series(sim, id, &count, NULL, NULL), MPS_E_STATE,
                   "its rate is 0");
    ASSERT_REFUSED(sim, mps_probe_series_clear(sim, id), MPS_E_STATE, "its rate is 0");
    ASSERT_REFUSED(sim, mps_probe_series(sim, 7, &count, NULL, NULL), MPS_E_ARG, "probe 7");
    ASSERT_REFUSED(sim, mps_probe_series_clear(sim, -1), MPS_E_ARG, "probe -1");
    assert_int_equal(mps_probe_series(NULL, 0, &count, NULL, NULL), MPS_E_ARG);
    assert_int_equal(mps_probe_series_clear(NULL, 0), MPS_E_ARG);
    mps_sim_destroy(sim);
}

/* ---- removing ---- */

/* The numbers of other probes stay and are not given again; their samples go on. */
static void removed_probes(void **state)
{
    (void)state;
    const int64_t *ids;
    const int32_t *kinds;
    int64_t walls[2000], count = 0, samples = 0;
    int32_t id[4];
    double value;
    mps_sim *sim = new_sim(2, 0.05);
    mps_probe wall, gauge;
    add_tank(sim, 0.5, 0.5, 0);
    fill_depth(sim, 0.5, 0.3, 0);
    assert_int_equal(mps_probe_init(&wall, sizeof wall), MPS_OK);
    wall.at[1] = 0.1;
    wall.rate = 1e4;
    wall.average = 1e-3;
    assert_int_equal(mps_probe_init(&gauge, sizeof gauge), MPS_OK);
    gauge.type = MPS_PROBE_GAUGE;
    gauge.at[0] = 0.25;
    gauge.rate = 1e4;
    ASSERT_OK(sim, mps_probe_add(sim, &gauge, &id[0]));
    ASSERT_OK(sim, mps_probe_add(sim, &wall, &id[1]));
    ASSERT_OK(sim, mps_probe_add(sim, &gauge, &id[2]));
    ASSERT_OK(sim, mps_run(sim, 2e-3, NULL, NULL));
    ASSERT_OK(sim, tags_peek(sim, &ids, &kinds, NULL, NULL));
    for (int64_t i = 0; i < mps_particles_count(sim, -1); i++)
        if (kinds[i] == MPS_WALL) walls[count++] = ids[i];
    ASSERT_OK(sim, mps_particles_remove(sim, count, walls));
    ASSERT_REFUSED(sim, mps_step(sim, 1e-4, NULL), MPS_E_STATE, "probe 1");
    ASSERT_OK(sim, mps_probe_remove(sim, id[1]));
    ASSERT_OK(sim, mps_run(sim, 3e-3, NULL, NULL));
    ASSERT_REFUSED(sim, mps_probe_read(sim, id[1], &value), MPS_E_ARG, "probe 1 was removed");
    ASSERT_REFUSED(sim, mps_probe_series(sim, id[1], NULL, NULL, NULL), MPS_E_ARG,
                   "probe 1 was removed");
    ASSERT_REFUSED(sim, mps_probe_remove(sim, id[1]), MPS_E_ARG, "probe 1 was removed");
    assert_int_equal(mps_probe_size(sim, id[1]), -1);
    for (int k = 0; k < 3; k += 2) {
        ASSERT_OK(sim, mps_probe_series(sim, id[k], &samples, NULL, NULL));
        assert_int_equal(samples, 31);
    }
    ASSERT_OK(sim, mps_probe_add(sim, &gauge, &id[3]));
    assert_int_equal(id[3], 3);
    ASSERT_OK(sim, mps_probe_remove(sim, id[3])); /* the last one too */
    ASSERT_REFUSED(sim, mps_probe_remove(sim, 4), MPS_E_ARG, "probe 4: there are 4");
    ASSERT_REFUSED(sim, mps_probe_remove(sim, -1), MPS_E_ARG, "probe -1");
    assert_int_equal(mps_probe_remove(NULL, 0), MPS_E_ARG);
    ASSERT_OK(sim, mps_probe_read(sim, id[2], &value));
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(average_of_a_line),
        cmocka_unit_test(averages_need_little_memory),
        cmocka_unit_test(average_before_the_first_step),
        cmocka_unit_test(samples_of_a_line),
        cmocka_unit_test(samples_from_the_middle),
        cmocka_unit_test(clearing),
        cmocka_unit_test(samples_of_forces),
        cmocka_unit_test(samples_of_a_gauge),
        cmocka_unit_test(walls_that_are_gone),
        cmocka_unit_test(refusals),
        cmocka_unit_test(removed_probes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

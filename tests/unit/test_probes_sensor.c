/* SPDX-License-Identifier: BSD-3-Clause */
/* Wall pressure over the area of a sensor: exact for linear pressures, cut off at the ends of a
 * face, without jumps. */
#include "cloud.h"
#include "probe_fixture.h"

/* after cmocka.h */
#include "../turns.h"

/* p = a + b.X in the tank's frame on all particles. */
static void write_linear(mps_sim *sim, double a, const double b[3])
{
    const mps__particles *s = &sim->world.particles;
    for (int64_t i = 0; i < s->n; i++)
        s->load[i] = s->kind[i] == MPS_WALL ? a + mps__dot(b, &s->ref[i * s->dim], s->dim) : 0;
}

/* Equal pressures on equal walls, in any order. */
static void write_random(mps_sim *sim)
{
    const mps__particles *s = &sim->world.particles;
    for (int64_t i = 0; i < s->n; i++) {
        uint64_t seed = (uint64_t)s->id[i] * 2654435761u + 1;
        for (int k = 0; k < 4; k++) s->load[i] = 1000 * cloud_random(&seed);
    }
}

static mps_probe sensor_at(double x, double y, double z, double diameter)
{
    mps_probe p = probe_of(MPS_PROBE_WALL_PRESSURE, x, y, z);
    p.diameter = diameter;
    p.average = 0;
    return p;
}

static double read_sensor(mps_sim *sim, double x, double y, double z, double diameter)
{
    const mps_probe p = sensor_at(x, y, z, diameter);
    return read_one(sim, &p);
}

/* ---- linear pressures ---- */

static void linear_up_the_wall(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        mps_sim *sim = filled(dim, 0.2);
        for (double y = 0.011; y < 0.18; y += 0.0037) {
            mps_probe p = probe_of(MPS_PROBE_WALL_PRESSURE, 0, y, 0.0512);
            ASSERT_NEAR(read_one(sim, &p), 9810 * (0.2 - y), 1e-9);
            p.at[0] = 0.4 + 0.45 * dp; /* behind the wall */
            ASSERT_NEAR(read_one(sim, &p), 9810 * (0.2 - y), 1e-9);
        }
        mps_sim_destroy(sim);
    }
}

static void any_diameter_and_place(void **state)
{
    (void)state;
    const double b[3] = {300, -9810, 2000};
    for (int dim = 2; dim <= 3; dim++) {
        mps_sim *sim = filled(dim, 0);
        write_linear(sim, 5000, b);
        for (double diameter = 0.001; diameter < 0.07; diameter *= 1.7)
            for (double along = 0.0353; along < 0.06; along += 0.0041) {
                const double z = dim == 3 ? along : 0;
                ASSERT_NEAR(read_sensor(sim, 0, 0.1 + along, z, diameter),
                            5000 - 9810 * (0.1 + along) + 2000 * z, 1e-9);
                ASSERT_NEAR(read_sensor(sim, 0.1 + along, 0, z, diameter),
                            5000 + 300 * (0.1 + along) + 2000 * z, 1e-9);
            }
        mps_sim_destroy(sim);
    }
}

/* A wall not aligned with the axes: 30 degrees, in 3-D also rotated out of the plane. */
static void inclined_wall(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        static double x[3 * 900], area[3 * 900];
        const double c = cos(0.5235987755982988), s = sin(0.5235987755982988),
                     b[3] = {700, -9810, 2000};
        int64_t n = 0;
        mps_sim *sim = new_sim(dim, dp);
        for (int i = 0; i < 30; i++)
            for (int k = 0; k < (dim == 3 ? 30 : 1); k++, n++) {
                const double at[3] = {i * dp * c, i * dp * s, k * dp}, up[3] = {-s * dp, c * dp, 0};
                memcpy(x + n * dim, at, (size_t)dim * sizeof *x);
                memcpy(area + n * dim, up, (size_t)dim * sizeof *x);
            }
        mps_particle_block block;
        mps_particle_block_init(&block, sizeof block);
        block.kind = MPS_WALL;
        block.count = n;
        block.position = x;
        block.area = area;
        ASSERT_OK(sim, mps_particles_add(sim, &block, NULL));
        write_linear(sim, 100, b);
        for (double t = 0.0512; t < 0.2; t += 0.0133) {
            const double at[3] = {t * c, t * s, dim == 3 ? 0.14 : 0};
            ASSERT_NEAR(read_sensor(sim, at[0], at[1], at[2], 0.04), 100 + mps__dot(b, at, dim),
                        1e-9);
        }
        mps_sim_destroy(sim);
    }
}

/* A plate one particle thick has no area of its own; along it pressure is linear all the same. */
static void plate(void **state)
{
    (void)state;
    const double lo[2] = {0.2, 0}, hi[2] = {0.2, 0.15}, b[3] = {300, -9810, 0};
    mps_sim *sim = filled(2, 0);
    ASSERT_OK(sim, mps_baffle_add(sim, "plate", lo, hi, NULL));
    write_linear(sim, 5000, b);
    for (double y = 0.03; y < 0.12; y += 0.0031)
        ASSERT_NEAR(read_sensor(sim, 0.2, y, 0, 0.03), 5060 - 9810 * y, 1e-9);
    mps_sim_destroy(sim);
}

/* Two walls at the same positions, back to back: a sensor belongs to the side it is on. */
static void sides_of_a_plate(void **state)
{
    (void)state;
    double x[2 * 20], area[2 * 20];
    mps_sim *sim = filled(2, 0);
    mps_particle_block block;
    mps_particle_block_init(&block, sizeof block);
    block.kind = MPS_WALL;
    block.count = 20;
    block.position = x;
    block.area = area;
    for (int side = -1; side <= 1; side += 2) {
        for (int k = 0; k < 20; k++) {
            x[2 * k] = 0.2;
            x[2 * k + 1] = (k + 1) * dp;
            area[2 * k] = side * dp;
            area[2 * k + 1] = 0;
        }
        ASSERT_OK(sim, mps_particles_add(sim, &block, NULL));
    }
    const mps__particles *s = &sim->world.particles;
    for (int64_t i = 0; i < s->n; i++)
        s->load[i] = fabs(s->ref[2 * i] - 0.2) > 1e-9 ? 0 : s->area[2 * i] > 0 ? 700 : 300;
    ASSERT_NEAR(read_sensor(sim, 0.2 - 1e-6, 0.1, 0, 0.03), 300, 1e-9);
    ASSERT_NEAR(read_sensor(sim, 0.2 + 1e-6, 0.1, 0, 0.03), 700, 1e-9);
    ASSERT_NEAR(read_sensor(sim, 0.2, 0.1, 0, 0.03), 300, 1e-9); /* on neither: the older */
    mps_sim_destroy(sim);
}

/* ---- what the sensor covers ---- */

static void half_dry(void **state)
{
    (void)state;
    mps_sim *sim = filled(2, 0.2);
    ASSERT_NEAR(read_sensor(sim, 0, 0.1, 0, 5 * dp), 981, 1e-9);
    ASSERT_NEAR(read_sensor(sim, 0, 0.2, 0, 5 * dp), 9810 * 2.5 * dp / 4,
                1e-9); /* a triangle over one half */
    mps_sim_destroy(sim);
}

/* One particle's pressure alone: the integral of its tent over the strip, over the strip. */
static void partly_covered(void **state)
{
    (void)state;
    mps_sim *sim = filled(2, 0);
    const mps__particles *s = &sim->world.particles;
    for (int64_t i = 0; i < s->n; i++)
        s->load[i] = s->kind[i] == MPS_WALL && fabs(s->ref[2 * i]) < 1e-9 &&
                             fabs(s->ref[2 * i + 1] - 0.15) < 1e-9
                         ? 600
                         : 0;
    ASSERT_NEAR(read_sensor(sim, 0, 0.15, 0, 4 * dp), 600 / 4.0, 1e-9);
    ASSERT_NEAR(read_sensor(sim, 0, 0.15, 0, dp), 600 * 0.75, 1e-9);
    ASSERT_NEAR(read_sensor(sim, 0, 0.15 + 2 * dp, 0, 4 * dp), 600 * 0.5 / 4, 1e-9);
    ASSERT_NEAR(read_sensor(sim, 0, 0.15 + 3 * dp, 0, 4 * dp), 0, 1e-9);
    ASSERT_NEAR(read_sensor(sim, 0, 0.15, 0, 1e-7), 600, 1e-2);
    mps_sim_destroy(sim);
}

/* At an edge the mean is over what is left of the strip or the disc: centroids of half and quarter
 * discs. */
static void cut_off_at_edges(void **state)
{
    (void)state;
    const double b[3] = {0, -9810, 2000}, off = 1e-6, quarter = 4 * 0.02 / (3 * 3.141592653589793);
    mps_sim *sim = filled(2, 0);
    write_linear(sim, 5000, b);
    ASSERT_NEAR(read_sensor(sim, 0, 0.005, 0, 0.04), 5000 - 9810 * 0.0125, 1e-9);
    ASSERT_NEAR(read_sensor(sim, 0, 0.29, 0, 0.04), 5000 - 9810 * 0.285, 1e-9);
    ASSERT_NEAR(read_sensor(sim, 0.4, 0.29, 0, 0.04), 5000 - 9810 * 0.285, 1e-9);
    mps_sim_destroy(sim);
    sim = filled(3, 0);
    write_linear(sim, 5000, b);
    ASSERT_NEAR(read_sensor(sim, 0, off, 0.05, 0.04), 5000 - 9810 * quarter + 100, 0.1);
    ASSERT_NEAR(read_sensor(sim, 0, 0.1, off, 0.04), 5000 - 981 + 2000 * quarter, 0.1);
    ASSERT_NEAR(read_sensor(sim, 0, off, off, 0.04), 5000 + (2000 - 9810) * quarter, 0.1);
    mps_sim_destroy(sim);
}

/* Neither a small move nor a slightly larger sensor makes it jump, over edges of cells and of the
 * face. */
static void no_jumps(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        const double step = 0.01 * dp;
        mps_sim *sim = filled(dim, 0);
        write_random(sim);
        double before = NAN;
        for (double y = 0.004; y < 0.05; y += step) {
            const double now = read_sensor(sim, 0, y, 0.013, 3.3 * dp);
            assert_false(fabs(now - before) > 2000 * 2 * step / dp);
            before = now;
        }
        before = NAN;
        for (double diameter = 0.2 * dp; diameter < 8 * dp; diameter += step) {
            const double now = read_sensor(sim, 0, 0.0313, 0.0372, diameter);
            assert_false(fabs(now - before) > 2000 * 2 * step / dp);
            before = now;
        }
        mps_sim_destroy(sim);
    }
}

/* ---- added, removed and permuted particles ---- */

static void assert_like_new(mps_sim *sim, int32_t id)
{
    double old = NAN;
    write_random(sim);
    ASSERT_OK(sim, mps_probe_read(sim, id, &old));
    assert_true(old == read_sensor(sim, 0, 0.0531, 0.0472, 3.7 * dp));
}

/* All particles in the opposite order, as a new search may sort them. */
static void turn_round(mps_sim *sim)
{
    static int32_t order[60000];
    mps__particles *s = &sim->world.particles;
    for (int64_t i = 0; i < s->n; i++) order[i] = (int32_t)(s->n - 1 - i);
    ASSERT_OK(sim, mps__particles_permute(s, s->n, order));
    sim->world.lists.neighbours.valid = false;
}

/* Ids of the wall particles whose coordinates are within `reach` of the sensor's; returns how
 * many. */
static int64_t walls_within(mps_sim *sim, double reach, int64_t *ids)
{
    const mps__particles *s = &sim->world.particles;
    const double at[3] = {0, 0.0531, 0.0472};
    int64_t n = 0;
    for (int64_t i = 0; i < s->n; i++) {
        double far = 0;
        for (int d = 0; d < s->dim; d++) far = fmax(far, fabs(s->ref[i * s->dim + d] - at[d]));
        if (s->kind[i] == MPS_WALL && far < reach) ids[n++] = s->id[i];
    }
    return n;
}

static void follows_the_particles(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        static int64_t ids[20000];
        mps_sim *sim = filled(dim, 0.05);
        const mps_probe p = sensor_at(0, 0.0531, 0.0472, 3.7 * dp);
        int32_t id;
        double value;
        ASSERT_OK(sim, mps_probe_add(sim, &p, &id));
        assert_like_new(sim, id);
        for (int k = 0; k < 3; k++) {
            assert_true(mps_step(sim, 1e-3, NULL) >=
                        0); /* the first sorts, and computes the areas */
            assert_like_new(sim, id);
            turn_round(sim);
            assert_like_new(sim, id);
        }
        ASSERT_OK(sim, mps_particles_remove(sim, walls_within(sim, dp, ids), ids));
        assert_like_new(sim, id);
        ASSERT_OK(sim, mps_particles_remove(sim, walls_within(sim, 1, ids), ids));
        ASSERT_REFUSED(sim, mps_probe_read(sim, id, &value), MPS_E_STATE,
                       "no wall particle any more");
        mps_sim_destroy(sim);
    }
}

int main(void)
{
    struct CMUnitTest tests[] = {
        cmocka_unit_test(linear_up_the_wall), cmocka_unit_test(any_diameter_and_place),
        cmocka_unit_test(inclined_wall),      cmocka_unit_test(plate),
        cmocka_unit_test(sides_of_a_plate),   cmocka_unit_test(half_dry),
        cmocka_unit_test(partly_covered),     cmocka_unit_test(cut_off_at_edges),
        cmocka_unit_test(no_jumps),           cmocka_unit_test(follows_the_particles),
    };
    take_turns(tests, sizeof tests / sizeof tests[0], 3);
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Free-surface gauges on prescribed particles: resolution, walls, baffles, particles that are no
 * surface. */
#include "cloud.h"
#include "probe_fixture.h"

/* A lattice whose columns are shifted so that the centres of the top layer are at `surface`. */
static void add_columns(mps_sim *sim, int32_t dim, double (*surface)(double x, double z, double c),
                        double c)
{
    static double x[3 * 60000];
    int64_t n = 0;
    for (int i = 1; i < 40; i++)
        for (int k = 1; k < (dim == 3 ? 10 : 2); k++) {
            double px = i * dp, pz = k * dp, top = surface(px, pz, c);
            for (double y = top; y > 0.55 * dp; y -= dp) {
                x[n * dim] = px;
                x[n * dim + 1] = y;
                if (dim == 3) x[n * dim + 2] = pz;
                n++;
            }
        }
    mps_particle_block block;
    mps_particle_block_init(&block, sizeof block);
    block.count = n;
    block.position = x;
    ASSERT_OK(sim, mps_particles_add(sim, &block, NULL));
}

static double flat(double x, double z, double c)
{
    (void)x;
    (void)z;
    return c;
}

static double slope(double x, double z, double c)
{
    return 0.15 + c * (x - 0.2) + 0.5 * c * (z - 0.05);
}

static double cosine(double x, double z, double c)
{
    (void)z;
    return 0.15 + c * cos(7.853981633974483 * x); /* pi x / 0.4 */
}

/* On the papers' lattice the surface is at the centres of the top layer: layers * dp above the
 * floor. */
static void gauge_still_water(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++)
        for (int layers = 2; layers < 29; layers += 5) {
            mps_sim *sim = filled(dim, layers * dp);
            for (double x = 0; x <= 0.4; x += 0.0173) {
                const mps_probe p = probe_of(MPS_PROBE_GAUGE, x, 0, 0.0512);
                ASSERT_NEAR(read_one(sim, &p), layers * dp, 0.015 * dp);
            }
            mps_sim_destroy(sim);
        }
}

static void gauge_moves_without_stairs(void **state)
{
    (void)state;
    for (double level = 0.15; level < 0.16; level += 0.0013)
        for (int dim = 2; dim <= 3; dim++) {
            mps_sim *sim = filled(dim, 0);
            add_columns(sim, dim, flat, level);
            for (double x = 0.0; x < 0.4; x += 0.0837) {
                mps_probe p = probe_of(MPS_PROBE_GAUGE, x, 0, 0.0512);
                ASSERT_NEAR(read_one(sim, &p), level, 0.015 * dp);
                p.at[1] = 0.05; /* a foot in the fluid */
                ASSERT_NEAR(read_one(sim, &p), level - 0.05, 0.015 * dp);
            }
            mps_sim_destroy(sim);
        }
}

static void gauge_tilted_and_curved(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        mps_sim *sim = filled(dim, 0);
        add_columns(sim, dim, slope, 0.1);
        for (double x = 0.0; x < 0.4; x += 0.0137) {
            const mps_probe p = probe_of(MPS_PROBE_GAUGE, x, 0, 0.0512);
            const bool beside_wall = x < 2 * dp || x > 0.4 - 2 * dp;
            ASSERT_NEAR(read_one(sim, &p), slope(x, dim == 3 ? 0.0512 : 0.01, 0.1),
                        (beside_wall ? 0.03 : 0.01) * dp);
        }
        mps_sim_destroy(sim);
    }
    mps_sim *sim = filled(2, 0);
    add_columns(sim, 2, cosine, 0.02);
    for (double x = 0.0; x < 0.4; x += 0.0137) {
        const mps_probe p = probe_of(MPS_PROBE_GAUGE, x, 0, 0);
        ASSERT_NEAR(read_one(sim, &p), cosine(x, 0, 0.02), 0.06 * dp /* flat at the walls */);
    }
    mps_sim_destroy(sim);
}

/* The gauge rotates with the tank: the same particles in a tilted tank give the same reading. */
static void gauge_in_a_turned_tank(void **state)
{
    (void)state;
    mps_sim *sim = filled(2, 0.2);
    const mps_harmonic h[2] = {{MPS_ROTATE_Z, 0, 0.4, 1, 1, 0}, {MPS_MOVE_X, 0, 3, 1, 1, 0}};
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 2, h));
    const mps_probe p = probe_of(MPS_PROBE_GAUGE, 0.123, 0, 0);
    ASSERT_NEAR(read_one(sim, &p), 0.2, 0.01 * dp);
    mps_sim_destroy(sim);
}

static void gauge_in_a_direction(void **state)
{
    (void)state;
    mps_sim *sim = filled(2, 0);
    add_columns(sim, 2, slope, 0);
    mps_probe p = probe_of(MPS_PROBE_GAUGE, 0.2, 0.29, 0);
    p.direction[1] = -1; /* from the dry ceiling */
    ASSERT_NEAR(read_one(sim, &p), 0, 0);
    /* along a line at 30 degrees from the vertical */
    p = probe_of(MPS_PROBE_GAUGE, 0.1, 0.05, 0);
    p.direction[0] = 1;
    p.direction[1] = sqrt(3);
    ASSERT_NEAR(read_one(sim, &p), 0.1 / cos(0.5235987755982988), 0.15 * dp);
    p.length = 0.06; /* ends in the fluid */
    ASSERT_NEAR(read_one(sim, &p), 0.06, 0);
    mps_sim_destroy(sim);
}

/* Layers of water whose particles are moved by up to `jitter` dp along every axis. */
static void add_jittered(mps_sim *sim, int32_t dim, int layers, double jitter, uint64_t *seed)
{
    static double x[3 * 60000];
    mps_particle_block block;
    mps_particle_block_init(&block, sizeof block);
    for (int i = 1; i < 40; i++)
        for (int k = 1; k < (dim == 3 ? 10 : 2); k++)
            for (int j = 1; j <= layers; j++) {
                const double at[3] = {i * dp, j * dp, k * dp};
                for (int d = 0; d < dim; d++)
                    x[block.count * dim + d] = at[d] + jitter * dp * cloud_random(seed);
                block.count++;
            }
    block.position = x;
    ASSERT_OK(sim, mps_particles_add(sim, &block, NULL));
}

/* Steep water at both walls, where the band is two spacings off. */
static void gauge_of_steep_water(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++)
        for (double c = -0.5; c <= 0.51; c += 0.25) {
            mps_sim *sim = filled(dim, 0);
            add_columns(sim, dim, slope, c);
            for (double x = 0.0; x <= 0.4; x += 0.0037) {
                const mps_probe p = probe_of(MPS_PROBE_GAUGE, x, 0, 0.0512);
                ASSERT_NEAR(read_one(sim, &p), slope(x, dim == 3 ? 0.0512 : 0.01, c), 0.1 * dp);
            }
            mps_sim_destroy(sim);
        }
}

/* Every particle moved by up to 0.1 dp: a single one of them moves the reading by less. */
static void gauge_of_an_uneven_lattice(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        uint64_t seed = 7;
        double sum2 = 0, most = 0;
        int count = 0;
        for (int k = 0; k < 5; k++) {
            mps_sim *sim = filled(dim, 0);
            add_jittered(sim, dim, 15, 0.1, &seed);
            for (double x = 0.03; x < 0.371; x += 0.0093) {
                const mps_probe p = probe_of(MPS_PROBE_GAUGE, x, 0, 0.0512);
                const double error = read_one(sim, &p) - 0.15;
                sum2 += error * error;
                most = fmax(most, fabs(error));
                count++;
            }
            mps_sim_destroy(sim);
        }
        assert_true(most < 0.12 * dp);
        assert_true(sqrt(sum2 / count) < 0.05 * dp);
    }
}

static void add_points(mps_sim *sim, int64_t count, const double *x)
{
    mps_particle_block block;
    mps_particle_block_init(&block, sizeof block);
    block.count = count;
    block.position = x;
    ASSERT_OK(sim, mps_particles_add(sim, &block, NULL));
}

static void gauge_ignores_drops_and_films(void **state)
{
    (void)state;
    mps_sim *sim = filled(2, 0.1);
    double drop[18], film[24];
    for (int k = 0; k < 9; k++) {
        drop[2 * k] = 0.2 + (k % 3 - 1) * dp;
        drop[2 * k + 1] = 0.15 + k / 3 * dp;
    }
    for (int k = 0; k < 12; k++) {
        film[2 * k] = dp;
        film[2 * k + 1] = 0.11 + k * dp;
    }
    const double single[2] = {0.3, 0.116};
    add_points(sim, 9, drop);
    add_points(sim, 12, film);
    add_points(sim, 1, single);
    mps_probe middle = probe_of(MPS_PROBE_GAUGE, 0.2, 0, 0),
              wall = probe_of(MPS_PROBE_GAUGE, 0, 0, 0),
              side = probe_of(MPS_PROBE_GAUGE, 0.3, 0, 0);
    ASSERT_NEAR(read_one(sim, &middle), 0.1, 0.01 * dp);
    ASSERT_NEAR(read_one(sim, &wall), 0.1, 0.35 * dp); /* the film leans on the surface */
    ASSERT_NEAR(read_one(sim, &side), 0.1, 0.25 * dp);
    middle.count_drops = wall.count_drops = side.count_drops = 1;
    ASSERT_NEAR(read_one(sim, &middle), 0.17, 1e-12);
    ASSERT_NEAR(read_one(sim, &wall), 0.22, 1e-12);
    ASSERT_NEAR(read_one(sim, &side), 0.116, 1e-12);
    mps_sim_destroy(sim);
}

static void gauge_above_a_baffle(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, dp);
    add_tank(sim, 0.4, 0.3, 0);
    const double lo[2] = {0.18, 0}, hi[2] = {0.22, 0.1};
    ASSERT_OK(sim, mps_baffle_add(sim, "baffle", lo, hi, NULL));
    fill_depth(sim, 0.4, 0.15, 0);
    for (double x = 0.15; x < 0.26; x += 0.01) {
        const mps_probe p = probe_of(MPS_PROBE_GAUGE, x, 0, 0);
        ASSERT_NEAR(read_one(sim, &p), 0.15, 0.01 * dp);
    }
    mps_sim_destroy(sim);
}

/* A run-up film one particle thick is no elevation, also when it has detached from the wall; two
 * particles are. */
static void gauge_of_run_ups(void **state)
{
    (void)state;
    for (int thick = 1; thick <= 4; thick++)
        for (double off = 0; off < 0.5; off += 0.2) {
            mps_sim *sim = filled(2, 0.1);
            double x[2 * 48];
            for (int k = 0; k < 12 * thick; k++) {
                x[2 * k] = (1 + k / 12 + off) * dp;
                x[2 * k + 1] = 0.11 + k % 12 * dp;
            }
            add_points(sim, 12 * thick, x);
            const mps_probe p = probe_of(MPS_PROBE_GAUGE, 0, 0, 0);
            ASSERT_NEAR(read_one(sim, &p), thick < 2 ? 0.1 : 0.22, (thick < 2 ? 0.45 : 0.75) * dp);
            mps_sim_destroy(sim);
        }
}

/* Different levels on both sides of baffles 0 to 3 dp thick. */
static void gauge_beside_a_thin_baffle(void **state)
{
    (void)state;
    for (int thick = 0; thick <= 3; thick++) {
        mps_sim *sim = filled(2, 0);
        const double left = 0.2, right = left + thick * dp;
        const double lo[6] = {left, 0, 0, 0, right, 0},
                     hi[6] = {right, 0.28, left - 0.5 * dp, 0.1, 0.4, 0.2};
        ASSERT_OK(sim, mps_baffle_add(sim, "baffle", lo, hi, NULL));
        for (int k = 1; k < 3; k++)
            ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo + 2 * k, hi + 2 * k, NULL, NULL));
        for (double off = 0.8 * dp; off < 0.05; off += 0.0041) {
            const mps_probe a = probe_of(MPS_PROBE_GAUGE, left - off, 0, 0),
                            b = probe_of(MPS_PROBE_GAUGE, right + off, 0, 0);
            ASSERT_NEAR(read_one(sim, &a), 0.1, 0.1 * dp);
            ASSERT_NEAR(read_one(sim, &b), 0.2, 0.1 * dp);
        }
        mps_sim_destroy(sim);
    }
}

/* A channel 4 dp wide is too narrow to determine a slope: the water behind its thin walls is
 * separate. */
static void gauge_in_a_channel(void **state)
{
    (void)state;
    mps_sim *sim = filled(2, 0);
    const double lo[10] = {0.2, 0, 0.25, 0, 0, 0, 0.215, 0, 0.265, 0},
                 hi[10] = {0.21, 0.28, 0.26, 0.28, 0.195, 0.11, 0.245, 0.1, 0.4, 0.11};
    for (int k = 0; k < 2; k++)
        ASSERT_OK(sim, mps_baffle_add(sim, k ? "right" : "left", lo + 2 * k, hi + 2 * k, NULL));
    for (int k = 2; k < 5; k++)
        ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo + 2 * k, hi + 2 * k, NULL, NULL));
    for (double x = 0.211; x < 0.25; x += 0.0031) {
        const mps_probe p = probe_of(MPS_PROBE_GAUGE, x, 0, 0);
        ASSERT_NEAR(read_one(sim, &p), 0.1, 0.15 * dp);
    }
    mps_sim_destroy(sim);
}

/* A surface-piercing baffle, and one with the water ending below its roof. */
static void gauge_through_a_dry_baffle(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, dp);
    add_tank(sim, 0.4, 0.3, 0);
    const double lo[4] = {0.08, 0, 0.25, 0.1}, hi[4] = {0.12, 0.2, 0.35, 0.15};
    ASSERT_OK(sim, mps_baffle_add(sim, "baffle", lo, hi, NULL));
    ASSERT_OK(sim, mps_baffle_add(sim, "roof", lo + 2, hi + 2, NULL));
    fill_depth(sim, 0.4, 0.09, 0);
    const mps_probe inside = probe_of(MPS_PROBE_GAUGE, 0.1, 0, 0),
                    under = probe_of(MPS_PROBE_GAUGE, 0.3, 0, 0);
    ASSERT_NEAR(read_one(sim, &inside), 0, 0);
    ASSERT_NEAR(read_one(sim, &under), 0.09, 0.01 * dp);
    mps_sim_destroy(sim);
}

static void gauge_of_dry_and_full_tanks(void **state)
{
    (void)state;
    mps_sim *sim = filled(2, 0);
    mps_probe p = probe_of(MPS_PROBE_GAUGE, 0.2, 0, 0);
    ASSERT_NEAR(read_one(sim, &p), 0, 0);
    fill_depth(sim, 0.4, 0.3, 0);
    ASSERT_NEAR(read_one(sim, &p), 0.29, 0.01 * dp);
    p.length = 1e300; /* also where the line is longer than steps can be counted */
    ASSERT_NEAR(read_one(sim, &p), 0.29, 0.01 * dp);
    mps_sim_destroy(sim);
}

static void define_phase(mps_sim *sim, int32_t index, double density)
{
    mps_phase phase;
    assert_int_equal(mps_phase_init(&phase, sizeof phase), MPS_OK);
    phase.density = density;
    ASSERT_OK(sim, mps_phase_set(sim, index, &phase));
}

/* The heavier of two fluids is the liquid, for any number of its phase. */
static void gauge_of_two_fluids(void **state)
{
    (void)state;
    const double lo[2] = {0, 0}, hi[2] = {0.4, 0.3};
    for (int32_t liquid = 0; liquid < 2; liquid++) {
        mps_sim *sim = filled(2, 0);
        define_phase(sim, liquid, 1000);
        define_phase(sim, 1 - liquid, 1.29);
        ASSERT_OK(sim, mps_fill_box_add(sim, liquid, lo, (const double[]){0.4, 0.1}, NULL, NULL));
        ASSERT_OK(sim, mps_fill_box_add(sim, 1 - liquid, lo, hi, NULL, NULL));
        for (double x = 0; x < 0.4; x += 0.0137) {
            const mps_probe p = probe_of(MPS_PROBE_GAUGE, x, 0, 0);
            ASSERT_NEAR(read_one(sim, &p), 0.1, 0.015 * dp);
        }
        mps_sim_destroy(sim);
    }
}

/* Fill phase `phase` of a column at x upwards from `from`, rows `step` apart, below `to`. @return
 * the next row */
static double add_rows(mps_sim *sim, int32_t phase, double x, double from, double to, double step)
{
    double at[2 * 64];
    mps_particle_block block;
    mps_particle_block_init(&block, sizeof block);
    block.phase = phase;
    block.position = at;
    for (; from < to - 0.25 * step && block.count < 64; from += step, block.count++) {
        at[2 * block.count] = x;
        at[2 * block.count + 1] = from;
    }
    ASSERT_OK(sim, mps_particles_add(sim, &block, NULL));
    return from;
}

/* A sloping interface, rows of a wave's crest (1.2 dp apart, so columns 1/1.2) and of its trough:
 * it is halfway between the rows. */
static void gauge_of_an_interface(void **state)
{
    (void)state;
    for (double stretch = 0.9; stretch < 1.25; stretch += 0.1)
        for (double c = -0.2; c < 0.25; c += 0.2) {
            mps_sim *sim = filled(2, 0);
            define_phase(sim, 1, 1.29);
            for (double x = dp; x < 0.4 - 0.6 * dp; x += dp / stretch) {
                const double top = 0.15 + c * (x - 0.2), step = stretch * dp,
                             rows = floor((top - 0.5 * step - 0.6 * dp) / step);
                double y = add_rows(sim, 0, x, top - (rows + 0.5) * step, top, step);
                add_rows(sim, 1, x, y, 0.3 - 0.6 * dp, step);
            }
            for (double x = 0.05; x < 0.35; x += 0.0137) {
                const mps_probe p = probe_of(MPS_PROBE_GAUGE, x, 0, 0);
                ASSERT_NEAR(read_one(sim, &p), 0.15 + c * (x - 0.2) - 0.5 * dp, 0.05 * dp);
            }
            mps_sim_destroy(sim);
        }
}

/* Oil on water below air: the surface of the oil, or that of the water. */
static void gauge_of_chosen_phases(void **state)
{
    (void)state;
    static const double density[3] = {1.29, 800, 1000}, height[3] = {0.3, 0.2, 0.1}, lo[2] = {0, 0};
    mps_sim *sim = filled(2, 0);
    for (int32_t k = 2; k >= 0; k--) {
        define_phase(sim, k, density[k]);
        ASSERT_OK(sim, mps_fill_box_add(sim, k, lo, (const double[]){0.4, height[k]}, NULL, NULL));
    }
    mps_probe p = probe_of(MPS_PROBE_GAUGE, 0.123, 0, 0);
    ASSERT_NEAR(read_one(sim, &p), 0.2, 0.015 * dp);
    p.phases = 1u << 2;
    ASSERT_NEAR(read_one(sim, &p), 0.1, 0.015 * dp);
    p.phases = 1u << 2 | 1u << 1;
    ASSERT_NEAR(read_one(sim, &p), 0.2, 0.015 * dp);
    p.phases = 1u << 1; /* its foot is in the water */
    ASSERT_NEAR(read_one(sim, &p), 0, 0);
    p.at[1] = 0.15;
    ASSERT_NEAR(read_one(sim, &p), 0.05, 0.015 * dp);
    p.phases = 1u << 16;
    int32_t id;
    ASSERT_REFUSED(sim, mps_probe_add(sim, &p, &id), MPS_E_ARG, "probe.phases is 0x10000");
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gauge_still_water),
        cmocka_unit_test(gauge_moves_without_stairs),
        cmocka_unit_test(gauge_tilted_and_curved),
        cmocka_unit_test(gauge_of_steep_water),
        cmocka_unit_test(gauge_of_an_uneven_lattice),
        cmocka_unit_test(gauge_of_run_ups),
        cmocka_unit_test(gauge_beside_a_thin_baffle),
        cmocka_unit_test(gauge_in_a_channel),
        cmocka_unit_test(gauge_in_a_turned_tank),
        cmocka_unit_test(gauge_in_a_direction),
        cmocka_unit_test(gauge_ignores_drops_and_films),
        cmocka_unit_test(gauge_above_a_baffle),
        cmocka_unit_test(gauge_through_a_dry_baffle),
        cmocka_unit_test(gauge_of_dry_and_full_tanks),
        cmocka_unit_test(gauge_of_two_fluids),
        cmocka_unit_test(gauge_of_an_interface),
        cmocka_unit_test(gauge_of_chosen_phases),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Water below air in a closed tank with the scheme of several phases: the densities of walls;
 * fluids at rest remain at rest. */
#include "phase_fixture.h"

static const double dp = 0.05, water = 1000, air = 1, size[3] = {0.4, 0.5, 0.3}, middle = 0.225;

static void fill(mps_sim *sim)
{
    const double lo[3] = {0}, water_top[3] = {size[0], middle, size[2]},
                 air_floor[3] = {0, middle, 0};
    set_phase(sim, 0, water, 1e-3);
    set_phase(sim, 1, air, 1.8e-5);
    add_tank(sim, size[0], size[1], size[2]);
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, water_top, NULL, NULL));
    ASSERT_OK(sim, mps_fill_box_add(sim, 1, air_floor, size, NULL, NULL));
}

/* ---- walls ----------------------------------------------------------------------------------- */

/* Every fluid particle displaced by up to `jitter` dp. */
static void jitter_fluid(mps_sim *sim, int dim, double jitter)
{
    const int32_t *kinds;
    uint64_t seed = 17;
    mps_lease x = {.struct_size = sizeof x};
    ASSERT_OK(sim, tags_peek(sim, NULL, &kinds, NULL, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_WRITE, &x));
    for (int64_t k = 0; k < x.count * dim; k++)
        if (kinds[k / dim] == MPS_FLUID) x.data[k] += jitter * dp * cloud_random(&seed);
    ASSERT_OK(sim, mps_lease_end(sim, &x));
}

/* Density of the adjacent fluid: that of the nearest, or with `nearly` the mean of all whose W/r^2
 * is more than this fraction of that of the nearest, weighted by the square of the excess;
 * otherwise that of the wall. */
static double density_beside(const double *x, const double *rho, const int32_t *kind, int64_t n,
                             int dim, int64_t i, double nearly)
{
    const double re = 2.1 * dp;
    double most = 0, sum = 0, weight = 0, found = rho[i], *near = cloud_doubles(n);
    mps_kernel kernel = {.struct_size = sizeof kernel};
    assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
    for (int64_t j = 0; j < n; j++) {
        double r2 = 0;
        for (int d = 0; d < dim; d++) r2 += pow(x[j * dim + d] - x[i * dim + d], 2);
        if (kind[j] != MPS_FLUID || r2 >= re * re) continue;
        near[j] = mps_kernel_value(&kernel, sqrt(r2), re) / r2;
        if (near[j] > most) found = rho[j];
        most = fmax(most, near[j]);
    }
    for (int64_t j = 0; j < n && most > 0; j++) {
        const double excess = fmax(0, near[j] / most - nearly);
        sum += excess * excess * rho[j];
        weight += excess * excess;
    }
    free(near);
    return weight > 0 ? sum / weight : found;
}

static int32_t *kinds_by_id(mps_sim *sim)
{
    const int64_t *ids;
    const int32_t *kinds;
    const int64_t n = mps_particles_count(sim, -1);
    int32_t *kind = cloud_phases(n);
    ASSERT_OK(sim, tags_peek(sim, &ids, &kinds, NULL, NULL));
    for (int64_t i = 0; i < n; i++) kind[ids[i]] = kinds[i];
    return kind;
}

/* A wall particle has the density of the nearest fluid, with a continuous transition to another as
 * it approaches; with the walls of the papers it is that of the nearest only, also for a dummy. */
static void walls_take_density(void **state)
{
    (void)state;
    int64_t between[2] = {0};
    for (int m = 0; m < 4; m++) {
        const int dim = 2 + m / 2, dummies = m % 2;
        int64_t of[2] = {0};
        mps_sim *sim = bare_sim(dim, dp, 3.1, 1e-9);
        fill(sim);
        jitter_fluid(sim, dim, 0.2);
        ASSERT_OK(sim, mps_model_use(sim, dummies ? "wall.extrapolate" : "wall.half"));
        double *x = field_by_id(sim, "position"), *rho = field_by_id(sim, "density");
        int32_t *kind = kinds_by_id(sim);
        const int64_t n = mps_particles_count(sim, -1);
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        for (int64_t i = 0; i < n; i++) {
            if (kind[i] == MPS_FLUID) assert_true(spy.density[i] == rho[i]);
            if (kind[i] != MPS_WALL && !(dummies && kind[i] == MPS_DUMMY)) continue;
            const double expected = density_beside(x, rho, kind, n, dim, i, dummies ? 1 : 0.7);
            ASSERT_NEAR(spy.density[i], expected, dummies ? 0 : 1e-9 * water);
            of[0] += spy.density[i] > 0.99 * water;
            of[1] += spy.density[i] < 1.01 * air;
            between[dummies] += spy.density[i] > 0.01 * water && spy.density[i] < 0.99 * water;
        }
        assert_true(of[0] > 10 && of[1] > 10);
        free(x);
        free(rho);
        free(kind);
        mps_sim_destroy(sim);
    }
    print_message("%lld walls between water and air\n", (long long)between[0]);
    assert_true(between[0] > 0 && between[1] == 0);
}

/* A lone drop of water before the wall of the air: the wall is that of the drop, unless the drop is
 * spray. */
static void spray_before_wall(void **state)
{
    (void)state;
    for (int detached = 0; detached < 2; detached++) {
        mps_sim *sim = bare_sim(2, dp, 3.1, 1e-9);
        fill(sim);
        ASSERT_OK(sim, mps_model_use(sim, "wall.half"));
        if (detached) ASSERT_OK(sim, mps_model_use(sim, "surface.detached"));
        double *x = field_by_id(sim, "position");
        int32_t *kind = kinds_by_id(sim);
        int64_t drop = -1, wall = -1;
        for (int64_t i = 0; i < mps_particles_count(sim, -1); i++) {
            if (kind[i] == MPS_FLUID && x[2 * i] < 1.5 * dp &&
                fabs(x[2 * i + 1] - 8 * dp) < 0.1 * dp)
                drop = i;
            if (kind[i] == MPS_WALL && x[2 * i] < 0.1 * dp &&
                fabs(x[2 * i + 1] - 8 * dp) < 0.1 * dp)
                wall = i;
        }
        assert_true(drop >= 0 && wall >= 0);
        const int64_t *ids;
        mps_lease rho = {.struct_size = sizeof rho};
        ASSERT_OK(sim, tags_peek(sim, &ids, NULL, NULL, NULL));
        ASSERT_OK(sim, mps_lease_begin(sim, "density", MPS_WRITE, &rho));
        for (int64_t i = 0; i < rho.count; i++)
            if (ids[i] == drop) rho.data[i] = water;
        ASSERT_OK(sim, mps_lease_end(sim, &rho));
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        assert_int_equal(spy.region[drop], detached ? MPS_REGION_SPRAY : MPS_REGION_INNER);
        assert_true(spy.density[wall] == (detached ? air : water));
        free(x);
        free(kind);
        mps_sim_destroy(sim);
    }
}

/* Fraction of air in the cell of a wall particle: the part of the cell that it represents, times
 * the fraction of air in the adjacent fluid. */
static double air_share(const double *x, const int32_t *kind, int64_t n, int dim, int64_t i)
{
    const double re = 2.1 * dp;
    double n0, fluid = 0, gas = 0, walls = 0;
    mps_kernel kernel = {.struct_size = sizeof kernel};
    assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
    assert_int_equal(mps_lattice_constants(&kernel, dim, dp, re, &n0, NULL), MPS_OK);
    for (int64_t j = 0; j < n; j++) {
        double r2 = 0;
        for (int d = 0; d < dim; d++) r2 += pow(x[j * dim + d] - x[i * dim + d], 2);
        if (j == i || r2 >= re * re || spy.region[j] >= MPS_REGION_SPRAY) continue;
        const double w = mps_kernel_value(&kernel, sqrt(r2), re);
        if (kind[j] == MPS_WALL) walls += 0.5 * w;
        if (kind[j] == MPS_FLUID) fluid += w;
        if (kind[j] == MPS_FLUID && spy.density[j] < 2 * air) gas += w;
    }
    return fluid > 0 ? gas / fluid * (fluid + walls) / n0 : 0;
}

/* The air in the cells of walls can be compressed as the air before them, that of dry ones not. */
static void walls_hold_gas(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        const double dt = 1e-6, sound = 300, whole = 1 / (air * sound * sound * dt * dt);
        int64_t mixed = 0;
        mps_sim *sim = bare_sim(dim, dp, 3.1, dt);
        fill(sim);
        jitter_fluid(sim, dim, 0.2);
        ASSERT_OK(sim, mps_model_use(sim, "wall.half"));
        ASSERT_OK(sim, mps_model_use(sim, "gas.compressible"));
        ASSERT_OK(sim, mps_model_set(sim, "gas", "sound", sound));
        double *x = field_by_id(sim, "position");
        int32_t *kind = kinds_by_id(sim);
        const int64_t n = mps_particles_count(sim, -1);
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        for (int64_t i = 0; i < n; i++) {
            double share = kind[i] == MPS_FLUID && spy.density[i] < 2 * air;
            if (kind[i] == MPS_WALL && spy.region[i] < MPS_REGION_SPRAY)
                share = air_share(x, kind, n, dim, i);
            ASSERT_NEAR(spy.gas[i] / whole, share, 1e-9);
            mixed += kind[i] == MPS_WALL && share > 0.01 && share < 0.4;
        }
        assert_true(mixed > 3);
        free(x);
        free(kind);
        mps_sim_destroy(sim);
    }
}

/* Sources of the walls, by id, with the air at `speed` away from the left wall and the water at
 * rest; free() them. */
static double *wall_sources(double speed, int64_t *n)
{
    const int32_t *kinds, *phases;
    mps_lease u = {.struct_size = sizeof u};
    mps_sim *sim = bare_sim(2, dp, 3.1, 1e-4);
    fill(sim);
    ASSERT_OK(sim, mps_model_use(sim, "wall.half"));
    ASSERT_OK(sim, mps_model_use(sim, "moments.bounded"));
    ASSERT_OK(sim, mps_model_use(sim, "source.volume"));
    ASSERT_OK(sim, mps_model_set(sim, "source", "pace", 0));
    ASSERT_OK(sim, tags_peek(sim, NULL, &kinds, &phases, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &u));
    for (int64_t i = 0; i < u.count; i++)
        if (kinds[i] == MPS_FLUID && phases[i] == 1) u.data[2 * i] = speed;
    ASSERT_OK(sim, mps_lease_end(sim, &u));
    assert_true(mps_step(sim, 1, NULL) >= 0);
    *n = mps_particles_count(sim, -1);
    double *rhs = cloud_doubles(*n);
    memcpy(rhs, spy.rhs, (size_t)*n * sizeof *rhs);
    mps_sim_destroy(sim);
    return rhs;
}

/* Beyond the speed of calm water, air next to a wall of the water has no effect there at any speed;
 * walls of the air use all of it. */
static void water_walls_mind_water(void **state)
{
    (void)state;
    int64_t n;
    double *slow = wall_sources(10, &n), *fast = wall_sources(100, &n), most[2] = {0}, seen = 0;
    mps_sim *sim = new_sim(2, dp);
    fill(sim);
    int32_t *kind = kinds_by_id(sim);
    mps_sim_destroy(sim);
    for (int64_t i = 0; i < n; i++) {
        const int air_wall = spy.density[i] == air;
        if (kind[i] != MPS_WALL) continue;
        most[air_wall] = fmax(most[air_wall], fabs(fast[i] - slow[i]));
        if (!air_wall) seen = fmax(seen, fabs(slow[i]));
    }
    print_message("walls of the water change by %.3g, of the air by %.3g 1/s2; source %.3g\n",
                  most[0], most[1], seen);
    assert_true(most[1] > 0 && most[0] < 0.02 * most[1]);
    assert_true(seen > 0);
    free(slow);
    free(fast);
    free(kind);
}

/* ---- rest ------------------------------------------------------------------------------------ */

/* Largest difference between the pressures of the fluid, each less that of layers at rest, over
 * that of the depth of the water. */
static double head_error(mps_sim *sim, int dim)
{
    const int32_t *kinds;
    double low = INFINITY, high = -INFINITY;
    mps_lease p = {.struct_size = sizeof p}, x = {.struct_size = sizeof x};
    ASSERT_OK(sim, tags_peek(sim, NULL, &kinds, NULL, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, "pressure", MPS_READ, &p));
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
    for (int64_t i = 0; i < p.count; i++) {
        if (kinds[i] != MPS_FLUID) continue;
        const double above = x.data[i * dim + 1] - middle,
                     head = p.data[i] + 9.81 * (above < 0 ? water : air) * above;
        low = fmin(low, head);
        high = fmax(high, head);
    }
    ASSERT_OK(sim, mps_lease_end(sim, &p));
    ASSERT_OK(sim, mps_lease_end(sim, &x));
    return (high - low) / (9.81 * water * middle);
}

/* Nothing moves but the corners by a little. */
static void at_rest(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        double *first[3] = {NULL};
        for (int threads = 1; threads <= 3; threads += 2) {
            static const char *const fields[] = {"position", "velocity", "pressure"};
            mps_step_info info;
            mps_sim *sim = new_sim(dim, dp);
            fill(sim);
            ASSERT_OK(sim, mps_preset_use(sim, "mmps"));
            ASSERT_OK(sim, mps_threads_set(sim, threads));
            assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
            for (int step = 0; step < 20; step++) ASSERT_OK(sim, mps_step(sim, 1, &info));
            print_message("%d-D: largest speed %.3g m/s, pressures to %.2g of rho g h\n", dim,
                          info.max_speed, head_error(sim, dim));
            assert_true(
                info.max_speed <
                0.005); /* sqrt(g dp) is 0.7; pairs with the mean of two densities: 0.01; walls with
                           their own: above 0.1 */
            assert_true(head_error(sim, dim) < 2e-3);
            for (int f = 0; f < 3; f++) {
                double *now = field_by_id(sim, fields[f]);
                const size_t bytes = (size_t)mps_particles_count(sim, -1) *
                                     (f < 2 ? (size_t)dim : 1) * sizeof *now;
                if (first[f]) assert_memory_equal(now, first[f], bytes);
                free(first[f]);
                first[f] = now;
            }
            mps_sim_destroy(sim);
        }
        for (int f = 0; f < 3; f++) free(first[f]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(walls_take_density), cmocka_unit_test(walls_hold_gas),
        cmocka_unit_test(spray_before_wall), cmocka_unit_test(water_walls_mind_water),
        cmocka_unit_test(at_rest)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

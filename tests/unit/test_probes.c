/* SPDX-License-Identifier: BSD-3-Clause */
/* Pressure probes, forces, gauges and energies on states written by hand. */
#include "sim.h"
#include "tank_fixture.h"

static const double dp = 0.01;

static mps_probe probe_of(int32_t type, double x, double y, double z)
{
    mps_probe p;
    assert_int_equal(mps_probe_init(&p, sizeof p), MPS_OK);
    p.type = type;
    p.at[0] = x;
    p.at[1] = y;
    p.at[2] = z;
    return p;
}

static double read_one(mps_sim *sim, const mps_probe *p)
{
    int32_t id = -1;
    double value = NAN;
    ASSERT_OK(sim, mps_probe_add(sim, p, &id));
    assert_int_equal(mps_probe_size(sim, id), 1);
    ASSERT_OK(sim, mps_probe_read(sim, id, &value));
    return value;
}

/* p = 1000 g (level - y) below `level` in the tank's frame, 0 above, on fluid and walls. */
static void write_hydrostatic(mps_sim *sim, double level)
{
    const mps__particles *s = &sim->world.particles;
    mps_lease lease;
    ASSERT_OK(sim, mps_lease_begin(sim, "pressure", MPS_WRITE, &lease));
    for (int64_t i = 0; i < lease.count; i++) {
        double X[3];
        mps__motion_to_tank(&sim->world.motion, &sim->world.motion.now, &s->x[i * s->dim], X);
        lease.data[i] = s->kind[i] == MPS_DUMMY ? 0 : 9810 * fmax(0, level - X[1]);
    }
    ASSERT_OK(sim, mps_lease_end(sim, &lease));
}

static mps_sim *filled(int32_t dim, double depth)
{
    mps_sim *sim = new_sim(dim, dp);
    add_tank(sim, 0.4, 0.3, 0.1);
    if (depth > 0) fill_depth(sim, 0.4, depth, 0.1);
    write_hydrostatic(sim, depth);
    return sim;
}

/* ---- pressure ---- */

static void wall_pressure_is_linear(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        mps_sim *sim = filled(dim, 0.2);
        for (double y = 0.011; y < 0.18; y += 0.0037) {
            mps_probe p = probe_of(MPS_PROBE_WALL_PRESSURE, 0, y, 0.0512);
            ASSERT_NEAR(read_one(sim, &p), 9810 * (0.2 - y), 1e-9);
            p.at[0] = 0.4 + 0.7 * dp; /* behind the wall */
            ASSERT_NEAR(read_one(sim, &p), 9810 * (0.2 - y), 1e-9);
        }
        mps_sim_destroy(sim);
    }
}

static void wall_pressure_of_a_sensor(void **state)
{
    (void)state;
    mps_sim *sim = filled(2, 0.2);
    mps_probe p = probe_of(MPS_PROBE_WALL_PRESSURE, 0, 0.1, 0);
    p.diameter = 5 * dp;
    ASSERT_NEAR(read_one(sim, &p), 981, 1e-9);
    p.at[1] = 0.2; /* half of it is dry: 0, 0, 0, 98.1, 196.2 */
    ASSERT_NEAR(read_one(sim, &p), (98.1 + 2 * 98.1) / 5, 1e-9);
    mps_sim_destroy(sim);
}

static void fluid_pressure(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        mps_sim *sim = filled(dim, 0.2);
        for (double y = 0; y < 0.17; y += 0.0131)
            for (double x = 0; x < 0.06; x += 0.0127) {
                const mps_probe p = probe_of(MPS_PROBE_FLUID_PRESSURE, x, y, 0.043);
                ASSERT_NEAR(read_one(sim, &p), 9810 * (0.2 - y), 1e-8);
            }
        const mps_probe air = probe_of(MPS_PROBE_FLUID_PRESSURE, 0.1, 0.25, 0.05);
        ASSERT_NEAR(read_one(sim, &air), 0, 0);
        mps_sim_destroy(sim);
    }
}

/* ---- forces ---- */

static void force_on_floor_and_walls(void **state)
{
    (void)state;
    mps_sim *sim = filled(2, 0.2);
    mps_probe p = probe_of(MPS_PROBE_FORCE, 0.2, 0, 0);
    int32_t id;
    double f[3];
    ASSERT_OK(sim, mps_probe_add(sim, &p, &id));
    assert_int_equal(mps_probe_size(sim, id), 3);
    ASSERT_OK(sim, mps_probe_read(sim, id, f));
    ASSERT_NEAR(f[0], 0, 1e-9);
    ASSERT_NEAR(f[1], -1962 * 0.4, 1e-9);
    ASSERT_NEAR(f[2], 0, 1e-9);
    /* a part: of a corner particle, each face has its own component of the area */
    p.part = "tank.x1";
    ASSERT_OK(sim, mps_probe_add(sim, &p, &id));
    ASSERT_OK(sim, mps_probe_read(sim, id, f));
    ASSERT_NEAR(f[0], 9810 * 0.2 * 0.2 / 2, 1e-9);
    ASSERT_NEAR(f[1], 0, 0);
    p.part = "tank.";
    ASSERT_OK(sim, mps_probe_add(sim, &p, &id));
    ASSERT_OK(sim, mps_probe_read(sim, id, f));
    ASSERT_NEAR(f[1], -1962 * 0.4, 1e-9);
    mps_sim_destroy(sim);
}

/* Uniform pressure on a closed surface has neither force nor moment, whatever the pose; one face has p A. */
static void force_turns_with_the_tank(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(3, dp);
    add_tank(sim, 0.2, 0.1, 0.15);
    const mps_harmonic h[3] = {{MPS_ROLL, 0, 0.3, 1, 1}, {MPS_YAW, 0, 0.5, 1, 1.5}, {MPS_PITCH, 0, 0.4, 1, 2}};
    ASSERT_OK(sim, mps_motion_set_harmonics(sim, 3, h));
    mps_lease lease;
    ASSERT_OK(sim, mps_lease_begin(sim, "pressure", MPS_WRITE, &lease));
    for (int64_t i = 0; i < lease.count; i++) lease.data[i] = 500;
    ASSERT_OK(sim, mps_lease_end(sim, &lease));
    mps_probe p = probe_of(MPS_PROBE_FORCE, 0.1, 0, 0.075);
    int32_t id;
    double f[6], normal[3];
    ASSERT_OK(sim, mps_probe_add(sim, &p, &id));
    assert_int_equal(mps_probe_size(sim, id), 6);
    ASSERT_OK(sim, mps_probe_read(sim, id, f));
    for (int k = 0; k < 6; k++) ASSERT_NEAR(f[k], 0, 1e-10);
    p.part = "tank.y0";
    ASSERT_OK(sim, mps_probe_add(sim, &p, &id));
    ASSERT_OK(sim, mps_probe_read(sim, id, f));
    const double down[3] = {0, -1, 0};
    mps__motion_rotate(&sim->world.motion, &sim->world.motion.now, down, normal);
    /* the edges' shares of the side walls cancel in pairs */
    for (int d = 0; d < 3; d++) ASSERT_NEAR(f[d], 500 * 0.2 * 0.15 * normal[d], 1e-10);
    mps_sim_destroy(sim);
}

/* ---- gauges ---- */

/* A lattice whose columns are shifted so that the centres of the top layer lie at `surface`. */
static void add_columns(mps_sim *sim, int32_t dim, double (*surface)(double x, double z, double c), double c)
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

/* On the papers' lattice the surface is at the centres of the top layer: layers * dp above the floor. */
static void gauge_still_water(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++)
        for (int layers = 2; layers < 29; layers += 5) {
            mps_sim *sim = filled(dim, layers * dp);
            for (double x = 0; x <= 0.4; x += 0.0173) {
                const mps_probe p = probe_of(MPS_PROBE_GAUGE, x, 0, 0.0512);
                ASSERT_NEAR(read_one(sim, &p), layers * dp, 0.01 * dp);
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
                ASSERT_NEAR(read_one(sim, &p), level, 0.01 * dp);
                p.at[1] = 0.05; /* a foot in the fluid */
                ASSERT_NEAR(read_one(sim, &p), level - 0.05, 0.01 * dp);
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
            /* beside a wall the band is two spacings off it */
            const double seen = fmin(fmax(x, 2 * dp), 0.4 - 2 * dp);
            ASSERT_NEAR(read_one(sim, &p), slope(seen, dim == 3 ? 0.0512 : 0.01, 0.1), seen == x ? 0.01 * dp : 0.02 * dp);
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

/* The gauge turns with the tank: the same particles in a tilted tank give the same reading. */
static void gauge_in_a_turned_tank(void **state)
{
    (void)state;
    mps_sim *sim = filled(2, 0.2);
    const mps_harmonic h[2] = {{MPS_YAW, 0, 0.4, 1, 1}, {MPS_SURGE, 0, 3, 1, 1}};
    ASSERT_OK(sim, mps_motion_set_harmonics(sim, 2, h));
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
    mps_probe middle = probe_of(MPS_PROBE_GAUGE, 0.2, 0, 0), wall = probe_of(MPS_PROBE_GAUGE, 0, 0, 0),
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
    ASSERT_OK(sim, mps_geometry_baffle(sim, "baffle", lo, hi));
    fill_depth(sim, 0.4, 0.15, 0);
    for (double x = 0.15; x < 0.26; x += 0.01) {
        const mps_probe p = probe_of(MPS_PROBE_GAUGE, x, 0, 0);
        ASSERT_NEAR(read_one(sim, &p), 0.15, 0.01 * dp);
    }
    mps_sim_destroy(sim);
}

/* A baffle that stands out of the water, and one under whose roof the water ends. */
static void gauge_through_a_dry_baffle(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, dp);
    add_tank(sim, 0.4, 0.3, 0);
    const double lo[4] = {0.08, 0, 0.25, 0.1}, hi[4] = {0.12, 0.2, 0.35, 0.15};
    ASSERT_OK(sim, mps_geometry_baffle(sim, "baffle", lo, hi));
    ASSERT_OK(sim, mps_geometry_baffle(sim, "roof", lo + 2, hi + 2));
    fill_depth(sim, 0.4, 0.09, 0);
    const mps_probe inside = probe_of(MPS_PROBE_GAUGE, 0.1, 0, 0), under = probe_of(MPS_PROBE_GAUGE, 0.3, 0, 0);
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
    mps_sim_destroy(sim);
}

/* The heavier of two fluids is the liquid. */
static void gauge_of_two_fluids(void **state)
{
    (void)state;
    mps_sim *sim = filled(2, 0.1);
    mps_phase air;
    const double lo[2] = {0, 0}, hi[2] = {0.4, 0.3};
    mps_phase_init(&air, sizeof air);
    air.density = 1.29;
    ASSERT_OK(sim, mps_sim_set_phase(sim, 1, &air));
    ASSERT_OK(sim, mps_geometry_fill_box(sim, 1, lo, hi, NULL));
    const mps_probe p = probe_of(MPS_PROBE_GAUGE, 0.2, 0, 0);
    ASSERT_NEAR(read_one(sim, &p), 0.1, 0.01 * dp);
    mps_sim_destroy(sim);
}

/* ---- energies ---- */

static void energies_of_a_block(void **state)
{
    (void)state;
    mps_sim *sim = filled(2, 0.1);
    const int64_t n = 39 * 10;
    mps_lease u;
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &u));
    for (int64_t i = 0; i < u.count; i++) {
        u.data[2 * i] = 3;
        u.data[2 * i + 1] = -1;
    }
    ASSERT_OK(sim, mps_lease_end(sim, &u));
    mps_energy e;
    assert_int_equal(mps_energy_init(&e, sizeof e), MPS_OK);
    ASSERT_OK(sim, mps_energy_get(sim, &e));
    const double mass = (double)n * 0.1;
    ASSERT_NEAR(e.mass, mass, 1e-11);
    ASSERT_NEAR(e.kinetic, 0.5 * mass * 10, 1e-10);
    ASSERT_NEAR(e.potential, mass * 9.81 * 0.055, 1e-10);
    ASSERT_NEAR(e.centre[0], 0.2, 1e-14);
    ASSERT_NEAR(e.centre[1], 0.055, 1e-14);
    ASSERT_NEAR(e.momentum[0], 3 * mass, 1e-10);
    ASSERT_NEAR(e.momentum[1], -mass, 1e-10);
    ASSERT_NEAR(e.volume, (double)n * dp * dp, 1e-14);
    ASSERT_NEAR(e.volume_error, 0, 0);
    ASSERT_NEAR(e.numerical, 0, 0);
    ASSERT_REFUSED(sim, mps_energy_get(sim, NULL), MPS_E_ARG, "NULL");
    mps_sim_destroy(sim);
}

/* The budget closes by definition; volume from number densities written by hand. */
static void energy_budget(void **state)
{
    (void)state;
    mps_sim *sim = filled(2, 0.1);
    mps__world *w = &sim->world;
    mps_energy e;
    mps_energy_init(&e, sizeof e);
    w->budget = (mps__budget){
        .wall_work = 5, .viscous = 1, .collision = 0.5, .shift = 0.25, .start = 1, .deviation = -0.02, .started = true};
    ASSERT_OK(sim, mps_energy_get(sim, &e));
    ASSERT_NEAR(e.numerical, 5 - 1 - 0.5 - 0.25 - (e.kinetic + e.potential - 1), 1e-12);
    ASSERT_NEAR(e.volume_error, 0.02, 1e-12);
    ASSERT_NEAR(e.volume, 0.039 / 0.98, 1e-12);
    mps_sim_destroy(sim);
}

/* ---- refusals ---- */

static void refusals(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, dp);
    int32_t id;
    double value;
    mps_probe p = probe_of(MPS_PROBE_WALL_PRESSURE, 0, 0.1, 0);
    ASSERT_REFUSED(sim, mps_probe_add(sim, &p, &id), MPS_E_STATE, "tank first");
    add_tank(sim, 0.4, 0.3, 0);
#define REFUSE(kind, change, status, word) \
    p = probe_of(kind, 0, 0.1, 0);         \
    change;                                \
    ASSERT_REFUSED(sim, mps_probe_add(sim, &p, &id), status, word)
    REFUSE(MPS_PROBE_WALL_PRESSURE, p.at[0] = 0.1, MPS_E_ARG, "0.1 m away");
    REFUSE(MPS_PROBE_WALL_PRESSURE, p.at[1] = 0.5, MPS_E_ARG, "from -0.02 to 0.32");
    REFUSE(MPS_PROBE_FLUID_PRESSURE, p.at[0] = -1, MPS_E_ARG, "probe.at[0] is -1");
    REFUSE(MPS_PROBE_FLUID_PRESSURE, p.at[0] = NAN, MPS_E_ARG, "finite");
    REFUSE(MPS_PROBE_WALL_PRESSURE, p.diameter = -1, MPS_E_ARG, "diameter is -1");
    REFUSE(MPS_PROBE_GAUGE, p.direction[1] = 0, MPS_E_ARG, "direction is zero");
    REFUSE(MPS_PROBE_GAUGE, p.direction[0] = NAN, MPS_E_ARG, "direction");
    REFUSE(MPS_PROBE_GAUGE, p.length = -1, MPS_E_ARG, "length is -1");
    REFUSE(MPS_PROBE_GAUGE, p.length = INFINITY, MPS_E_ARG, "length is inf");
    REFUSE(MPS_PROBE_GAUGE, p.count_drops = 3, MPS_E_ARG, "count_drops is 3");
    REFUSE(MPS_PROBE_FORCE, p.part = "tank.x3", MPS_E_NAME, "nearest is \"tank.x0\"");
    REFUSE(MPS_PROBE_FORCE, p.part = "hull.", MPS_E_NAME, "hull.");
    REFUSE(MPS_PROBE_FORCE, p.at[1] = INFINITY, MPS_E_ARG, "finite");
    REFUSE(7, p.type = 7, MPS_E_ARG, "type is 7");
    REFUSE(0, p.struct_size = 0, MPS_E_ARG, "struct_size");
#undef REFUSE
    p = probe_of(MPS_PROBE_WALL_PRESSURE, 0, 0.1, 0);
    ASSERT_REFUSED(sim, mps_probe_add(sim, &p, NULL), MPS_E_ARG, "id is NULL");
    ASSERT_REFUSED(sim, mps_probe_read(sim, 0, &value), MPS_E_ARG, "probe 0");
    assert_int_equal(mps_probe_size(sim, 0), -1);
    ASSERT_OK(sim, mps_probe_add(sim, &p, &id));
    assert_int_equal(id, 0);
    ASSERT_REFUSED(sim, mps_probe_read(sim, 0, NULL), MPS_E_ARG, "NULL");
    ASSERT_REFUSED(sim, mps_probe_read(sim, 1, &value), MPS_E_ARG, "there are 1");
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wall_pressure_is_linear),
        cmocka_unit_test(wall_pressure_of_a_sensor),
        cmocka_unit_test(fluid_pressure),
        cmocka_unit_test(force_on_floor_and_walls),
        cmocka_unit_test(force_turns_with_the_tank),
        cmocka_unit_test(gauge_still_water),
        cmocka_unit_test(gauge_moves_without_stairs),
        cmocka_unit_test(gauge_tilted_and_curved),
        cmocka_unit_test(gauge_in_a_turned_tank),
        cmocka_unit_test(gauge_in_a_direction),
        cmocka_unit_test(gauge_ignores_drops_and_films),
        cmocka_unit_test(gauge_above_a_baffle),
        cmocka_unit_test(gauge_through_a_dry_baffle),
        cmocka_unit_test(gauge_of_dry_and_full_tanks),
        cmocka_unit_test(gauge_of_two_fluids),
        cmocka_unit_test(energies_of_a_block),
        cmocka_unit_test(energy_budget),
        cmocka_unit_test(refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Pressure in the fluid, forces and energies on prescribed states; refusals of probes. */
#include "probe_fixture.h"
#include "sim.h"

/* ---- pressure ---- */

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

/* Uniform pressure on a closed surface has neither force nor moment, for any pose; one face has p
 * A. */
static void force_turns_with_the_tank(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(3, dp);
    add_tank(sim, 0.2, 0.1, 0.15);
    const mps_harmonic h[3] = {{MPS_ROTATE_X, 0, 0.3, 1, 1, 0},
                               {MPS_ROTATE_Z, 0, 0.5, 1, 1.5, 0},
                               {MPS_ROTATE_Y, 0, 0.4, 1, 2, 0}};
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 3, h));
    mps_lease lease = {.struct_size = sizeof lease};
    ASSERT_OK(sim, mps_lease_begin(sim, "wall_pressure", MPS_WRITE, &lease));
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
    /* contributions of the edges to the side walls cancel in pairs */
    for (int d = 0; d < 3; d++) ASSERT_NEAR(f[d], 500 * 0.2 * 0.15 * normal[d], 1e-10);
    mps_sim_destroy(sim);
}

/* ---- energies ---- */

static void energies_of_a_block(void **state)
{
    (void)state;
    mps_sim *sim = filled(2, 0.1);
    const int64_t n = 39 * 10;
    mps_lease u = {.struct_size = sizeof u};
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
    w->state.budget = (mps__budget){.wall_work_momentum = 5,
                                    .viscous = 1,
                                    .collision = 0.5,
                                    .shift = 0.25,
                                    .added = 2,
                                    .start = 1,
                                    .last = {.potential = 3},
                                    .deviation = -0.02,
                                    .started = true};
    ASSERT_OK(sim, mps_energy_get(sim, &e));
    ASSERT_NEAR(e.added, 2 + e.kinetic + e.potential - 3, 1e-12);
    ASSERT_NEAR(e.numerical, 5 + e.added - 1 - 0.5 - 0.25 - (e.kinetic + e.potential - 1), 1e-12);
    ASSERT_NEAR(e.volume_error, 0.02, 1e-12);
    ASSERT_NEAR(e.volume, 0.039 / 0.98, 1e-12);
    mps_sim_destroy(sim);
}

static void momentum(mps_sim *sim, mps_momentum *m)
{
    assert_int_equal(mps_momentum_init(m, sizeof *m), MPS_OK);
    ASSERT_OK(sim, mps_momentum_get(sim, m));
    assert_int_equal(m->struct_size, sizeof *m);
}

/* Everything that changes the momentum is in the budget, in a tank that is shaken. */
static void momentum_budget(void **state)
{
    (void)state;
    mps_sim *sim = filled(2, 0.1);
    const mps_harmonic surge = {.dof = MPS_MOVE_X, .amplitude = 0.02, .omega = 20};
    mps_momentum start, m;
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &surge));
    momentum(sim, &start);
    for (int k = 0; k < 60; k++) assert_true(mps_step(sim, 1, NULL) >= 0);
    momentum(sim, &m);
    for (int d = 0; d < 2; d++) {
        const double sum = start.total[d] + m.gravity[d] + m.force[d] + m.plugins[d] +
                           m.pressure[d] + m.collision[d] + m.shift[d] + m.added[d];
        ASSERT_NEAR(m.total[d], sum, 1e-9 * fabs(m.gravity[1]));
        ASSERT_NEAR(m.numerical[d], m.pressure[d] - m.walls[d], 1e-12);
    }
    assert_true(fabs(m.total[0]) > 0.1 && m.gravity[0] == 0 && m.gravity[1] < 0);
    assert_true(m.walls[0] * m.pressure[0] > 0);
    ASSERT_REFUSED(sim, mps_momentum_get(sim, NULL), MPS_E_ARG, "NULL");
    assert_int_equal(mps_momentum_get(NULL, &m), MPS_E_ARG);
    mps_sim_destroy(sim);
}

/* At rest the floor carries the weight, including that of the half cells at the side walls. */
static void momentum_at_rest(void **state)
{
    (void)state;
    mps_sim *sim = filled(2, 0.1);
    mps_momentum m;
    for (int k = 0; k < 60; k++) assert_true(mps_step(sim, 1, NULL) >= 0);
    momentum(sim, &m);
    ASSERT_NEAR(m.walls[1], -m.gravity[1] * 0.4 / 0.39, 0.004 * fabs(m.gravity[1]));
    ASSERT_NEAR(m.total[1], 0, 1e-3 * fabs(m.gravity[1]));
    ASSERT_NEAR(m.walls[0], 0, 1e-3 * fabs(m.gravity[1]));
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
    REFUSE(MPS_PROBE_GAUGE, p.direction[1] = 0, MPS_E_ARG, "direction is (0, 0, 0)");
    REFUSE(MPS_PROBE_GAUGE, p.direction[0] = INFINITY, MPS_E_ARG, "direction is (inf, 1, 0)");
    REFUSE(MPS_PROBE_GAUGE, p.phases = 8 | 1, MPS_E_ARG, "phases is 0x9: phase 3 is not defined");
    REFUSE(MPS_PROBE_GAUGE, p.length = -1, MPS_E_ARG, "length is -1");
    REFUSE(MPS_PROBE_GAUGE, p.length = INFINITY, MPS_E_ARG, "length is inf");
    REFUSE(MPS_PROBE_GAUGE, p.count_drops = 3, MPS_E_ARG, "count_drops is 3");
    REFUSE(MPS_PROBE_FORCE, p.part = "tank.x3", MPS_E_NAME, "did you mean \"tank.x0\"?");
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

/* Particles lack the half cells at walls, of the order dp/L; with them mass and volume are those of
 * the liquid but for dp^2. */
static void filled_volume(void **state)
{
    (void)state;
    const double h = 0.02;
    for (int dim = 2; dim <= 3; dim++)
        for (int steps = 0; steps < 2; steps++) {
            mps_sim *sim = new_sim(dim, h);
            mps_energy e;
            const double liquid = 0.6 * 0.3 * (dim == 3 ? 0.4 : 1);
            add_tank(sim, 0.6, 0.5, 0.4);
            fill_depth(sim, 0.6, 0.3, 0.4);
            if (steps) ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
            assert_int_equal(mps_energy_init(&e, sizeof e), MPS_OK);
            ASSERT_OK(sim, mps_energy_get(sim, &e));
            ASSERT_NEAR(e.volume, (0.6 - h) * 0.3 * (dim == 3 ? 0.4 - h : 1), 1e-3 * liquid);
            ASSERT_NEAR(e.volume_filled, liquid, (dim == 3 ? 0.015 : 0.006) * liquid);
            ASSERT_NEAR(e.mass_filled, 1000 * e.volume_filled, 1e-3 * e.mass);
            mps_sim_destroy(sim);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(filled_volume),
        cmocka_unit_test(fluid_pressure),
        cmocka_unit_test(force_on_floor_and_walls),
        cmocka_unit_test(force_turns_with_the_tank),
        cmocka_unit_test(energies_of_a_block),
        cmocka_unit_test(energy_budget),
        cmocka_unit_test(momentum_budget),
        cmocka_unit_test(momentum_at_rest),
        cmocka_unit_test(refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

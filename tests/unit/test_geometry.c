/* SPDX-License-Identifier: BSD-3-Clause */
/* Tanks, baffles and fills: counts of the papers, areas, rounding, overlaps, refusals. */
#include "sim.h"
#include "tank_fixture.h"

static void papers_counts(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.004);
    add_tank(sim, 0.8, 0.5, 0);
    assert_int_equal(fill_depth(sim, 0.8, 0.25, 0), 12338);
    assert_int_equal(mps_particles_count(sim, MPS_FLUID), 199 * 62);
    assert_int_equal(mps_particles_count(sim, MPS_WALL) + mps_particles_count(sim, MPS_DUMMY),
                     1974);
    assert_int_equal(mps_particles_count(sim, MPS_WALL), 650);
    mps_sim_destroy(sim);
}

static void count_3d(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(3, 0.05);
    add_tank(sim, 0.5, 0.4, 0.3);
    const int64_t outer = (11 + 4) * (9 + 4) * (7 + 4), inner = 9 * 7 * 5;
    assert_int_equal(mps_particles_count(sim, -1), outer - inner);
    assert_int_equal(mps_particles_count(sim, MPS_WALL), 11 * 9 * 7 - inner);
    assert_int_equal(fill_depth(sim, 0.5, 0.2, 0.3), 9 * 4 * 5);
    mps_sim_destroy(sim);
}

/* Decimal sizes that are not whole multiples in binary. */
static void rounding(void **state)
{
    (void)state;
    static const struct {
        double size, dp;
        int64_t cells;
    } list[] = {{0.57, 0.002, 285}, {0.31, 0.005, 62},  {0.6, 0.001, 600}, {1.3, 0.002, 650},
                {0.57, 0.005, 114}, {0.9, 0.0027, 333}, {1.61, 0.005, 322}};
    for (size_t k = 0; k < sizeof list / sizeof list[0]; k++) {
        mps_sim *sim = new_sim(2, list[k].dp);
        mps_tank tank;
        double built[3];
        mps_tank_init(&tank, sizeof tank);
        tank.size[0] = list[k].size;
        tank.size[1] = 10 * list[k].dp;
        ASSERT_OK(sim, mps_tank_add(sim, &tank, built));
        ASSERT_NEAR(built[0], list[k].size, 1e-12);
        assert_int_equal(mps_particles_count(sim, MPS_WALL), 2 * (list[k].cells + 10));
        /* up to the whole size of the tank: walls are taken, everything else is filled */
        assert_int_equal(fill_depth(sim, list[k].size, tank.size[1], 0), (list[k].cells - 1) * 9);
        mps_sim_destroy(sim);
    }
}

/* A box whose ends are on lattice planes up to rounding contains these planes. */
static void fill_includes_its_ends(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.002);
    add_tank(sim, 0.57, 0.3, 0);
    const double lo[2] = {0.1, 0.1}, hi[2] = {0.1 + 7 * 0.002, 0.1 + 3 * 0.002};
    int64_t added = 0;
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, &added, NULL));
    assert_int_equal(added, 8 * 4);
    /* twice the same: nothing is free */
    ASSERT_REFUSED(sim, mps_fill_box_add(sim, 0, lo, hi, &added, NULL), MPS_E_ARG, "32 are taken");
    mps_sim_destroy(sim);
}

/* Sum of |area| over the particles whose area has a component along +-axis. */
static double face_sum(const mps_sim *sim, int axis, double sign)
{
    const mps__particles *s = &sim->world.particles;
    double sum = 0;
    for (int64_t i = 0; i < s->n; i++)
        if (s->area[i * s->dim + axis] * sign > 0) sum += s->area[i * s->dim + axis] * sign;
    return sum;
}

static void areas_2d(void **state)
{
    (void)state;
    for (int open = 0; open < 2; open++) {
        mps_sim *sim = new_sim(2, 0.01);
        mps_tank tank;
        mps_tank_init(&tank, sizeof tank);
        tank.size[0] = 0.4;
        tank.size[1] = 0.3;
        tank.open_top = open;
        ASSERT_OK(sim, mps_tank_add(sim, &tank, NULL));
        ASSERT_NEAR(face_sum(sim, 0, 1), 0.3, 1e-14);
        ASSERT_NEAR(face_sum(sim, 0, -1), 0.3, 1e-14);
        ASSERT_NEAR(face_sum(sim, 1, 1), 0.4, 1e-14);
        ASSERT_NEAR(face_sum(sim, 1, -1), open ? 0 : 0.4, 1e-14);
        assert_int_equal(mps_part_find(sim, "tank.y1") >= 0, !open);
        mps_sim_destroy(sim);
    }
}

static void areas_3d(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(3, 0.02);
    add_tank(sim, 0.2, 0.3, 0.1);
    const double face[3] = {0.3 * 0.1, 0.2 * 0.1, 0.2 * 0.3};
    for (int axis = 0; axis < 3; axis++) {
        ASSERT_NEAR(face_sum(sim, axis, 1), face[axis], 1e-14);
        ASSERT_NEAR(face_sum(sim, axis, -1), face[axis], 1e-14);
    }
    mps_sim_destroy(sim);
}

/* Side walls and the adjacent dummy columns end at the top lattice layer. */
static void open_top(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = 1;
    tank.size[1] = 0.5;
    tank.open_top = 1;
    ASSERT_OK(sim, mps_tank_add(sim, &tank, NULL));
    const mps__particles *s = &sim->world.particles;
    double top = 0;
    for (int64_t i = 0; i < s->n; i++) top = fmax(top, s->x[2 * i + 1]);
    ASSERT_NEAR(top, 0.5, 1e-12);
    assert_int_equal(s->n, 3 * 15 + 6 * 5);
    assert_int_equal(mps_particles_count(sim, MPS_WALL), 11 + 2 * 5);
    mps_sim_destroy(sim);
}

static void parts_of_faces(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    add_tank(sim, 1, 1, 0);
    const mps__particles *s = &sim->world.particles;
    for (int64_t i = 0; i < s->n; i++) {
        const double *X = &s->ref[2 * i];
        const char *wanted = X[1] < 0.05   ? "tank.y0"
                             : X[1] > 0.95 ? "tank.y1"
                             : X[0] < 0.05 ? "tank.x0"
                                           : "tank.x1";
        assert_int_equal(s->part[i], mps_part_find(sim, wanted));
        assert_int_equal(s->kind[i], X[0] > -0.05 && X[0] < 1.05 && X[1] > -0.05 && X[1] < 1.05
                                         ? MPS_WALL
                                         : MPS_DUMMY);
    }
    mps_sim_destroy(sim);
}

/* On the floor, four columns thick: the floor below remains, three rows of the box are above it. */
static void baffle_on_floor(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.002);
    add_tank(sim, 0.57, 0.5, 0);
    const int64_t tank = mps_particles_count(sim, -1);
    const double lo[2] = {0.282, 0}, hi[2] = {0.288, 0.15};
    ASSERT_OK(sim, mps_baffle_add(sim, "baffle", lo, hi, NULL));
    assert_int_equal(mps_particles_count(sim, -1) - tank, 4 * 75);
    const mps__particles *s = &sim->world.particles;
    const int32_t part = mps_part_find(sim, "baffle");
    int64_t walls = 0;
    double up = 0, side[2] = {0, 0};
    for (int64_t i = tank; i < s->n; i++) {
        assert_int_equal(s->part[i], part);
        walls += s->kind[i] == MPS_WALL;
        up += s->area[2 * i + 1];
        side[s->area[2 * i] > 0] += s->area[2 * i];
    }
    assert_int_equal(walls, 2 * 75 + 2);
    ASSERT_NEAR(up, 0.006, 1e-14);
    /* half a spacing at the foot belongs to the floor */
    ASSERT_NEAR(side[0], -(0.15 - 0.001), 1e-14);
    ASSERT_NEAR(side[1], 0.15 - 0.001, 1e-14);
    mps_sim_destroy(sim);
}

static void baffle_free_standing_3d(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(3, 0.05);
    add_tank(sim, 1, 0.6, 0.4);
    const int64_t tank = mps_particles_count(sim, -1);
    const double lo[3] = {0.4, 0.1, 0.1}, hi[3] = {0.55, 0.3, 0.3};
    ASSERT_OK(sim, mps_baffle_add(sim, "box", lo, hi, NULL));
    assert_int_equal(mps_particles_count(sim, -1) - tank, 4 * 5 * 5);
    assert_int_equal(mps_particles_count(sim, MPS_DUMMY), 2 * 3 * 3 + 25 * 17 * 13 - 21 * 13 * 9);
    const mps__particles *s = &sim->world.particles;
    double sum[3] = {0, 0, 0}, out = 0;
    for (int64_t i = tank; i < s->n; i++)
        for (int d = 0; d < 3; d++) {
            sum[d] += s->area[3 * i + d];
            if (d == 0) out += fabs(s->area[3 * i]);
        }
    for (int d = 0; d < 3; d++) ASSERT_NEAR(sum[d], 0, 1e-14);
    ASSERT_NEAR(out, 2 * 0.2 * 0.2, 1e-14);
    mps_sim_destroy(sim);
}

/* Thinner than a spacing: one column, each point two walls with opposite areas, the floor below
 * divided; the upper end a single one. */
static void thin_baffle(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.01);
    add_tank(sim, 0.4, 0.3, 0);
    const int64_t walls = mps_particles_count(sim, MPS_WALL);
    const double lo[2] = {0.197, 0}, hi[2] = {0.203, 0.1};
    ASSERT_OK(sim, mps_baffle_add(sim, "plate", lo, hi, NULL));
    assert_int_equal(mps_particles_count(sim, MPS_WALL) - walls, 1 + 2 * 9 + 1);
    const mps__particles *s = &sim->world.particles;
    double sum[2] = {0, 0}, size = 0;
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_WALL || fabs(s->ref[2 * i] - 0.2) > 1e-9) continue;
        size += fabs(s->area[2 * i]);
        for (int d = 0; d < 2; d++) sum[d] += s->area[2 * i + d];
    }
    ASSERT_NEAR(size, 2 * (0.1 - 0.005), 1e-14);
    ASSERT_NEAR(sum[0], 0, 1e-16);
    ASSERT_NEAR(sum[1], 0.01 - 0.01, 1e-7); /* floor and ceiling */
    mps_sim_destroy(sim);
}

static int under_wave(void *user, const double *x)
{
    /* points of the lattice; points between them are queried for the volume */
    if (x[0] > 0.01 && x[0] < 0.99 && x[1] > 0.01 && x[1] < 0.99 &&
        fabs(20 * x[0] - round(20 * x[0])) + fabs(20 * x[1] - round(20 * x[1])) < 1e-6)
        ++*(int64_t *)user;
    return x[1] <= 0.5 + 0.1 * cos(3.14159265358979 * x[0]) + 1e-9;
}

static void fill_by_callback(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.05);
    add_tank(sim, 1, 1, 0);
    int64_t calls = 0, added = 0, wanted = 0, ignored = 0;
    ASSERT_OK(sim, mps_fill_add(sim, 0, under_wave, &calls, &added));
    for (int i = 1; i < 20; i++)
        for (int j = 1; j < 20; j++) {
            const double x[2] = {0.05 * i, 0.05 * j};
            wanted += under_wave(&ignored, x);
        }
    assert_int_equal(added, wanted);
    assert_int_equal(calls, 19 * 19); /* every free point once */
    const mps__particles *s = &sim->world.particles;
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_FLUID) continue;
        assert_int_equal(s->phase[i], 0);
        ASSERT_NEAR(s->rho[i], 1000, 0);
        ASSERT_NEAR(s->u[2 * i], 0, 0);
    }
    mps_sim_destroy(sim);
}

/* Points closer than half a spacing to a particle are occupied, for any position of the
 * particle. */
static void fill_keeps_away_from_particles(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    add_tank(sim, 1, 1, 0);
    mps_particle_block block;
    mps_particle_block_init(&block, sizeof block);
    const double x[4] = {0.34, 0.52, 0.75, 0.75};
    block.count = 2;
    block.position = x;
    ASSERT_OK(sim, mps_particles_add(sim, &block, NULL));
    assert_int_equal(fill_depth(sim, 1, 1, 0), 81 - 1);
    mps_sim_destroy(sim);
}

/* Fill and tank use the current pose of the tank. */
static void moved_tank(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    const double centre[2] = {0.5, 0};
    const mps_harmonic h[2] = {{MPS_MOVE_X, 0, 0.3, 1, 1.0, 0}, {MPS_ROTATE_Z, 0, 0.2, 2, 0.5, 0}};
    ASSERT_OK(sim, mps_motion_centre_set(sim, centre, MPS_START_AT_REST));
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 2, h));
    add_tank(sim, 1, 1, 0);
    assert_int_equal(fill_depth(sim, 1, 0.5, 0), 9 * 5);
    const mps__particles *s = &sim->world.particles;
    for (int64_t i = 0; i < s->n; i++) {
        double x[2];
        if (s->kind[i] == MPS_FLUID) continue;
        ASSERT_OK(sim, mps_motion_to_lab(sim, &s->ref[2 * i], x, NULL));
        ASSERT_NEAR(s->x[2 * i], x[0], 0);
        ASSERT_NEAR(s->x[2 * i + 1], x[1], 0);
    }
    /* the fluid is one spacing from the wall for any position of the tank */
    double nearest = 1;
    for (int64_t i = 0; i < s->n; i++)
        for (int64_t j = 0; j < s->n; j++)
            if (s->kind[i] == MPS_FLUID && i != j)
                nearest = fmin(nearest,
                               hypot(s->x[2 * i] - s->x[2 * j], s->x[2 * i + 1] - s->x[2 * j + 1]));
    ASSERT_NEAR(nearest, 0.1, 1e-12);
    mps_sim_destroy(sim);
}

static void tank_refusals(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    mps_tank tank, bad;
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = tank.size[1] = 1;
    assert_int_equal(mps_tank_add(NULL, &tank, NULL), MPS_E_ARG);
    ASSERT_REFUSED(sim, mps_tank_add(sim, NULL, NULL), MPS_E_ARG, "NULL");
#define REFUSE(change, word)                                             \
    bad = tank;                                                          \
    change;                                                              \
    ASSERT_REFUSED(sim, mps_tank_add(sim, &bad, NULL), MPS_E_ARG, word); \
    assert_int_equal(mps_particles_count(sim, -1), 0)
    REFUSE(bad.size[1] = 0.2, "size[1] is 0.2");
    REFUSE(bad.size[1] = 0.29, "size[1] is 0.29"); /* not rounded up */
    REFUSE(bad.size[0] = NAN, "size[0]");
    REFUSE(bad.size[0] = INFINITY, "size[0]");
    REFUSE(bad.size[0] = 1e30, "size[0]");
    REFUSE(bad.size[0] = 4e7, "tank.size[0] is 4e+07 m: too many lattice points");
    REFUSE(bad.size[1] = 4e7, "tank.size[1] is 4e+07 m: too many lattice points");
    REFUSE(bad.lo[0] = NAN, "lo[0]");
    REFUSE(bad.lo[0] = 1e15, "lo[0] puts solids at 1e+15 m: places must be within 1e+08 m");
    REFUSE(bad.lo[1] = -1.1e8, "lo[1] puts solids at -1.1e+08 m");
    REFUSE(bad.dummy_layers = -1, "dummy_layers is -1");
    REFUSE(bad.open_top = 2, "open_top is 2");
    REFUSE(bad.name = "", "name");
    REFUSE(bad.name = "a name that is too long for parts", "1..28");
    REFUSE(bad.struct_size = 0, "struct_size");
#undef REFUSE
    /* dummy_layers 0 is the default */
    tank.dummy_layers = 0;
    ASSERT_OK(sim, mps_tank_add(sim, &tank, NULL));
    assert_int_equal(mps_particles_count(sim, -1), 15 * 15 - 9 * 9);
    ASSERT_REFUSED(sim, mps_tank_add(sim, &tank, NULL), MPS_E_ARG,
                   "particles that are there already");
    /* a failed tank leaves no part names */
    tank.name = "second";
    ASSERT_REFUSED(sim, mps_tank_add(sim, &tank, NULL), MPS_E_ARG, "second");
    assert_int_equal(mps_part_find(sim, "second.x0"), -1);
    tank.lo[0] = 2;
    ASSERT_OK(sim, mps_tank_add(sim, &tank, NULL));
    assert_true(mps_part_find(sim, "second.x0") >= 0);
    mps_sim_destroy(sim);
}

static int everywhere(void *user, const double *x)
{
    (void)user;
    (void)x;
    return 1;
}

static void fill_refusals(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    const double lo[2] = {0, 0}, hi[2] = {1, 1}, nan[2] = {0, NAN}, far[2] = {5, 5},
                 farther[2] = {6, 6}, between[2] = {0.42, 0.42}, below[2] = {0.48, 0.48};
    ASSERT_REFUSED(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL), MPS_E_STATE, "mps_tank_add");
    ASSERT_REFUSED(sim, mps_fill_add(sim, 0, everywhere, NULL, NULL), MPS_E_STATE, "mps_tank_add");
    ASSERT_REFUSED(sim, mps_baffle_add(sim, "b", lo, hi, NULL), MPS_E_STATE, "mps_tank_add");
    add_tank(sim, 1, 1, 0);
    const int64_t before = mps_particles_count(sim, -1);
    ASSERT_REFUSED(sim, mps_fill_box_add(sim, 1, lo, hi, NULL, NULL), MPS_E_ARG,
                   "phase 1 is not defined");
    ASSERT_REFUSED(sim, mps_fill_box_add(sim, 16, lo, hi, NULL, NULL), MPS_E_ARG, "0..15");
    ASSERT_REFUSED(sim, mps_fill_box_add(sim, -1, lo, hi, NULL, NULL), MPS_E_ARG, "phase -1");
    ASSERT_REFUSED(sim, mps_fill_box_add(sim, 0, lo, nan, NULL, NULL), MPS_E_ARG, "finite");
    ASSERT_REFUSED(sim, mps_fill_box_add(sim, 0, hi, lo, NULL, NULL), MPS_E_ARG, "inverted");
    ASSERT_REFUSED(sim, mps_fill_box_add(sim, 0, NULL, hi, NULL, NULL), MPS_E_ARG, "NULL");
    ASSERT_REFUSED(sim, mps_fill_box_add(sim, 0, far, farther, NULL, NULL), MPS_E_ARG,
                   "no lattice point");
    ASSERT_REFUSED(sim, mps_fill_box_add(sim, 0, between, below, NULL, NULL), MPS_E_ARG,
                   "no lattice point");
    ASSERT_REFUSED(sim, mps_fill_box_add(sim, 0, lo, lo, NULL, NULL), MPS_E_ARG, "nothing to fill");
    ASSERT_REFUSED(sim, mps_fill_add(sim, 0, NULL, NULL, NULL), MPS_E_ARG, "inside is NULL");
    ASSERT_REFUSED(sim, mps_baffle_add(sim, "", between, hi, NULL), MPS_E_ARG, "name");
    ASSERT_REFUSED(sim, mps_baffle_add(sim, "b", between, below, NULL), MPS_E_ARG,
                   "no lattice point");
    ASSERT_REFUSED(sim, mps_baffle_add(sim, "b", lo, lo, NULL), MPS_E_ARG, "taken");
    assert_int_equal(mps_part_find(sim, "b"), -1);
    mps_lease lease = {.struct_size = sizeof lease};
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &lease));
    ASSERT_REFUSED(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL), MPS_E_BUSY, "leases");
    ASSERT_STATUS(sim, mps_baffle_add(sim, "b", lo, hi, NULL), MPS_E_BUSY);
    ASSERT_OK(sim, mps_lease_end(sim, &lease));
    assert_int_equal(mps_particles_count(sim, -1), before);
    mps_sim_destroy(sim);
}

/* A solid never encloses fluid: if its distance is below half a spacing it is refused with the
 * position, and nothing is added. */
static void fluid_in_the_way(void **state)
{
    (void)state;
    const double lo[2] = {0.3, 0.2}, hi[2] = {0.7, 0.5}, thin[2] = {0.3, 0.5},
                 corner[2] = {0.33, 0.12}, edge[2] = {0.2, 0.21};
    for (int late = 0; late < 2; late++) {
        const mps_status wanted = late ? MPS_E_STATE : MPS_E_ARG;
        const char *word = late ? "1 steps were taken" : "at (0.3, 0.2, 0) m is in the way of";
        mps_sim *sim = new_sim(2, 0.1);
        add_tank(sim, 1, 1, 0);
        fill_depth(sim, 1, 0.5, 0);
        if (late) ASSERT_OK(sim, mps_step(sim, 1, NULL));
        const int64_t before = mps_particles_count(sim, -1);
        ASSERT_REFUSED(sim, mps_baffle_add(sim, "b", lo, hi, NULL), wanted, word);
        ASSERT_REFUSED(sim, mps_baffle_add(sim, "b", lo, thin, NULL), wanted, word);
        ASSERT_REFUSED(sim, mps_plate_add(sim, "b", corner, edge, NULL), wanted,
                       late ? word : "half a spacing, 0.05 m");
        assert_int_equal(mps_particles_count(sim, -1), before);
        assert_int_equal(mps_part_find(sim, "b"), -1);
        mps_tank second;
        assert_int_equal(mps_tank_init(&second, sizeof second), MPS_OK);
        second.name = "second";
        second.lo[0] = 3;
        second.size[0] = second.size[1] = 1;
        ASSERT_STATUS(sim, mps_tank_add(sim, &second, NULL), late ? MPS_E_STATE : MPS_OK);
        mps_sim_destroy(sim);
    }
}

/* Fluid that is nowhere near a lattice point of the solid is in its way all the same; half a
 * spacing off it is not, nor in a tank. */
static void fluid_between_the_points(void **state)
{
    (void)state;
    const double at[5][2] = {{0.55, 0.35}, {0.251, 0.35}, {0.25, 0.35}, {-0.15, 0.5}, {0.5, 0.05}};
    const char *const way[5] = {"baffle", "baffle", NULL, "tank", NULL};
    for (int k = 0; k < 5; k++) {
        mps_sim *sim = new_sim(2, 0.1);
        mps_particle_block block;
        mps_tank tank;
        const double lo[2] = {0.3, 0.2}, hi[2] = {0.7, 0.5};
        assert_int_equal(mps_tank_init(&tank, sizeof tank), MPS_OK);
        tank.size[0] = tank.size[1] = 1;
        assert_int_equal(mps_particle_block_init(&block, sizeof block), MPS_OK);
        block.count = 1;
        block.position = at[k];
        ASSERT_OK(sim, mps_particles_add(sim, &block, NULL));
        if (way[k] && way[k][0] == 't') {
            ASSERT_REFUSED(sim, mps_tank_add(sim, &tank, NULL), MPS_E_ARG,
                           "at (-0.15, 0.5, 0) m is in the way of tank \"tank\"");
            assert_int_equal(mps_part_find(sim, "tank.x0"), -1);
        } else {
            ASSERT_OK(sim, mps_tank_add(sim, &tank, NULL));
            if (way[k])
                ASSERT_REFUSED(sim, mps_baffle_add(sim, "b", lo, hi, NULL), MPS_E_ARG, way[k]);
            else
                ASSERT_OK(sim, mps_baffle_add(sim, "b", lo, hi, NULL));
        }
        mps_sim_destroy(sim);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(papers_counts),
        cmocka_unit_test(count_3d),
        cmocka_unit_test(rounding),
        cmocka_unit_test(fill_includes_its_ends),
        cmocka_unit_test(areas_2d),
        cmocka_unit_test(areas_3d),
        cmocka_unit_test(open_top),
        cmocka_unit_test(parts_of_faces),
        cmocka_unit_test(baffle_on_floor),
        cmocka_unit_test(baffle_free_standing_3d),
        cmocka_unit_test(thin_baffle),
        cmocka_unit_test(fill_by_callback),
        cmocka_unit_test(fill_keeps_away_from_particles),
        cmocka_unit_test(moved_tank),
        cmocka_unit_test(tank_refusals),
        cmocka_unit_test(fill_refusals),
        cmocka_unit_test(fluid_in_the_way),
        cmocka_unit_test(fluid_between_the_points),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

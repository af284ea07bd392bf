/* SPDX-License-Identifier: BSD-3-Clause */
/* The budgets of energy and momentum: work of the walls, additions from outside, closure of
 * both. */
#include "budget.h"
#include "probe_fixture.h"
#include "sim.h"
#include <mps/model.h>
#include <stdlib.h>

/* Sums of a few thousand terms, of this size, are exact to this part. */
static const double rounding = 1e-12;

static mps_energy energy_of(mps_sim *sim)
{
    mps_energy e;
    assert_int_equal(mps_energy_init(&e, sizeof e), MPS_OK);
    ASSERT_OK(sim, mps_energy_get(sim, &e));
    return e;
}

static mps_momentum momentum_of(mps_sim *sim)
{
    mps_momentum m;
    assert_int_equal(mps_momentum_init(&m, sizeof m), MPS_OK);
    ASSERT_OK(sim, mps_momentum_get(sim, &m));
    return m;
}

/* Both identities, from the state before the first step on. */
static void assert_closed(mps_sim *sim, const mps_energy *start, const mps_momentum *before)
{
    const mps_energy e = energy_of(sim);
    const mps_momentum m = momentum_of(sim);
    const double size = fabs(e.potential) + fabs(start->potential) + e.kinetic + fabs(e.added) +
                        fabs(e.wall_work_momentum);
    const double change = e.kinetic + e.potential + e.layers - start->kinetic - start->potential;
    ASSERT_NEAR(e.wall_work_momentum + e.added - e.viscous - e.plugins - e.collision - e.shift -
                    e.friction - e.numerical,
                change, rounding * size);
    double most = 0;
    for (int d = 0; d < 2; d++) {
        const double parts[] = {before->total[d], m.gravity[d], m.pressure[d], m.collision[d],
                                m.added[d]};
        for (int k = 0; k < 5; k++) most = fmax(most, fabs(parts[k]));
    }
    for (int d = 0; d < 2; d++) {
        const double sum = m.gravity[d] + m.force[d] + m.plugins[d] + m.pressure[d] +
                           m.collision[d] + m.shift[d] + m.added[d] + m.friction[d];
        ASSERT_NEAR(m.total[d] - before->total[d], sum, rounding * most);
    }
}

static mps_sim *weightless(double fill)
{
    mps_config config;
    mps_sim *sim = NULL;
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dp = dp;
    config.gravity[1] = 0;
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    add_tank(sim, 0.4, 0.3, 0.1);
    if (fill > 0) fill_depth(sim, 0.4, fill, 0.1);
    return sim;
}

static void take_steps(mps_sim *sim, int count)
{
    for (int k = 0; k < count; k++) assert_true(mps_step(sim, 1, NULL) >= 0);
}

/* ---- work of the walls ---- */

static const double pull = 2; /* [m/s2] */

static int pull_fluid(mps_stage *s)
{
    double *a = s->data[0];
    for (int64_t i = 0; i < s->view->n; i++)
        if (s->view->kind[i] == MPS_FLUID) a[i * s->view->dim] += pull;
    return 0;
}

static const mps_use pull_uses[] = {{"acceleration", MPS_USE_CHANGE}};
static const mps_verb pull_verbs[] = {
    {.hook = MPS_FORCE, .use_count = 1, .uses = pull_uses, .run = pull_fluid}};

static int steady(void *user, double t, mps_motion_state *state)
{
    const double speed = *(const double *)user;
    state->value[MPS_MOVE_X] = speed * t;
    state->rate[MPS_MOVE_X] = speed;
    return 0;
}

/* A drop in the middle of a steadily moving tank, that touches nothing, is driven by a force model:
 * walls do nothing. */
static void force_models_are_no_walls(void **state)
{
    (void)state;
    mps_sim *sim = weightless(0);
    double speed = 1;
    const double lo[2] = {0.15, 0.1}, hi[2] = {0.2, 0.15}, centre[2] = {0, 0};
    const mps_model_ops ops = {.struct_size = sizeof ops,
                               .api = MPS_MODEL_API,
                               .name = "test.pull",
                               .help = "accelerates the fluid",
                               .verb_count = 1,
                               .verbs = pull_verbs};
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    ASSERT_OK(sim, mps_model_register(sim, &ops));
    ASSERT_OK(sim, mps_model_use(sim, "test.pull"));
    ASSERT_OK(sim, mps_motion_callback_set(sim, steady, &speed));
    ASSERT_OK(sim, mps_motion_centre_set(sim, centre, MPS_START_WITH_TANK));
    const mps_energy start = energy_of(sim);
    const mps_momentum before = momentum_of(sim);
    take_steps(sim, 20);
    const mps_energy e = energy_of(sim);
    const double t = sim->world.state.t,
                 work = 0.5 * e.mass * (pow(speed + pull * t, 2) - speed * speed);
    /* the budget entry m v a t has the size of `work`; the tolerance of the solver gives 1e-6 of
     * it */
    assert_true(work > 0.01);
    ASSERT_NEAR(e.wall_work_momentum, 0, 1e-6 * work);
    ASSERT_NEAR(e.plugins, -work, 1e-6 * work);
    assert_true(e.viscous >= 0 && e.viscous < 1e-6 * work);
    ASSERT_NEAR(e.numerical, 0, 1e-6 * work);
    assert_closed(sim, &start, &before);
    mps_sim_destroy(sim);
}

/* A full tank jumps from rest to its speed: its walls do the work m V^2/2, and the liquid then
 * moves as a rigid body. */
static void impulsive_start(void **state)
{
    (void)state;
    mps_sim *sim = filled(2, 0.3);
    const mps_harmonic surge = {.dof = MPS_MOVE_X, .amplitude = 0.02, .omega = 6};
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &surge));
    const mps_energy start = energy_of(sim);
    const mps_momentum before = momentum_of(sim);
    take_steps(sim, 1);
    mps_energy e = energy_of(sim);
    const double speed = 0.02 * sin(6 * sim->world.state.t) / sim->world.state.t,
                 given = 0.5 * e.mass * speed * speed;
    /* pressures are exact to the tolerance of the solver, 1e-6 */
    ASSERT_NEAR(e.wall_work_momentum, given, 1e-5 * given);
    ASSERT_NEAR(e.numerical, 0, 1e-5 * given);
    for (int k = 0; k < 40; k++) {
        take_steps(sim, 1);
        ASSERT_NEAR(energy_of(sim).numerical, 0, 1e-5 * given);
    }
    e = energy_of(sim);
    ASSERT_NEAR(e.wall_work_momentum, e.kinetic, 1e-5 * given);
    assert_true(e.kinetic < 0.9 * given && e.added == 0); /* the speed did change */
    assert_closed(sim, &start, &before);
    mps_sim_destroy(sim);
}

/* A liquid that starts with the tank's velocity got it from no force; the walls slow it down. */
static void start_with_the_tank(void **state)
{
    (void)state;
    mps_sim *sim = filled(2, 0.3);
    const mps_harmonic surge = {.dof = MPS_MOVE_X, .amplitude = 0.02, .omega = 6};
    const double centre[2] = {0, 0}, speed = 0.12;
    ASSERT_OK(sim, mps_motion_centre_set(sim, centre, MPS_START_WITH_TANK));
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &surge));
    const mps_energy start = energy_of(sim);
    const mps_momentum before = momentum_of(sim);
    ASSERT_NEAR(before.total[0], 0, 0);
    take_steps(sim, 40);
    const mps_energy e = energy_of(sim);
    const mps_momentum m = momentum_of(sim);
    const double given = 0.5 * e.mass * speed * speed;
    ASSERT_NEAR(e.added, given, rounding * e.potential);
    ASSERT_NEAR(m.added[0], e.mass * speed, rounding * e.mass);
    ASSERT_NEAR(e.wall_work_momentum, e.kinetic - given, 1e-5 * given);
    ASSERT_NEAR(e.numerical, 0, 1e-5 * given);
    assert_true(e.wall_work_momentum < -0.1 * given);
    assert_closed(sim, &start, &before);
    mps_sim_destroy(sim);
}

/* Sums on the host are available immediately. */
static void take_one(void *value, const double *sums)
{
    *(double *)value = sums[0];
}

static double wall_work(mps__world *w, const mps__pose *end, const double *a, double dt)
{
    double work = NAN;
    mps__budget_wall_work(w, end, a, dt, (mps__then){take_one, &work});
    return work;
}

/* In 2-D: force, and its work. */
static void take_force(void *force, const double *sums)
{
    memcpy(force, sums, 3 * sizeof *sums);
}

/* Work of a torque too: the rotation of this step, and of the previous one. */
static void work_of_a_turn(void **state)
{
    (void)state;
    enum { STEP_MS = 10 };
    mps_sim *sim = weightless(0.2);
    mps__world *w = &sim->world;
    const double centre[2] = {0.1, 0.05}, dt = STEP_MS * 1e-3;
    const mps_harmonic yaw = {.dof = MPS_ROTATE_Z, .amplitude = 0.3, .omega = 2};
    ASSERT_OK(sim, mps_motion_centre_set(sim, centre, MPS_START_AT_REST));
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &yaw));
    mps__pose end;
    double *a = calloc((size_t)(2 * w->particles.n), sizeof *a), inertia = 0;
    assert_non_null(a);
    ASSERT_OK(sim, mps__motion_pose(&w->motion, dt, &end));
    for (int64_t i = 0; i < w->particles.n; i++) {
        const double *x = w->particles.x + 2 * i, r[2] = {x[0] - centre[0], x[1] - centre[1]};
        a[2 * i] = -3 * r[1];
        a[2 * i + 1] = 3 * r[0];
        if (w->particles.kind[i] == MPS_FLUID)
            inertia += 1000 * dp * dp * (r[0] * r[0] + r[1] * r[1]);
    }
    const double first = 0.3 * sin(2 * dt), impulse = 3 * dt * inertia;
    /* from rest: half the speed of this step, that of its chord without the strain */
    ASSERT_NEAR(wall_work(w, &end, a, dt), impulse * 0.5 * sin(first) / dt, rounding * impulse);
    w->state.before = w->motion.now;
    w->state.dt_before = dt;
    w->motion.now = end;
    ASSERT_OK(sim, mps__motion_pose(&w->motion, 3 * dt, &end));
    const double second = 0.3 * sin(6 * dt) - first,
                 rate = 0.5 * (sin(first) / dt + sin(second) / (2 * dt));
    ASSERT_NEAR(wall_work(w, &end, a, 2 * dt), 2 * impulse * rate, rounding * impulse);
    /* work of wall pressures with the same rotation */
    double torque = 0, size = 0, force[3];
    for (int64_t i = 0; i < w->particles.n; i++) {
        const double *x = w->particles.x + 2 * i, *area = w->particles.area + 2 * i;
        if (w->particles.kind[i] != MPS_WALL) continue;
        a[i] = 1000 + 5000 * x[0];
        torque += a[i] * ((x[0] - centre[0]) * area[1] - (x[1] - centre[1]) * area[0]);
        size += a[i] * dp;
    }
    w->work.area = w->particles.area;
    mps__budget_wall_force(w, &end, a, 2 * dt, (mps__then){take_force, force});
    ASSERT_NEAR(force[2], 2 * dt * torque * rate, rounding * size);
    assert_true(fabs(torque) > 1 && force[0] != 0);
    free(a);
    mps_sim_destroy(sim);
}

/* Forces of probes times the velocity of the tank give `wall_work_probes`. */
static void work_by_force_probes(void **state)
{
    (void)state;
    mps_sim *sim = filled(2, 0.1);
    mps_probe probe = probe_of(MPS_PROBE_FORCE, 0, 0, 0);
    const mps_harmonic surge = {.dof = MPS_MOVE_X, .amplitude = 0.02, .omega = 10};
    int32_t id;
    double work = 0, most = 0, before = 0, t = 0;
    probe.average = 0;
    ASSERT_OK(sim, mps_probe_add(sim, &probe, &id));
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &surge));
    for (int k = 0; k < 60; k++) {
        double force[3];
        take_steps(sim, 1);
        ASSERT_OK(sim, mps_probe_read(sim, id, force));
        const double now = sim->world.state.t, dt = now - t,
                     speed = 0.02 * (sin(10 * now) - sin(10 * t)) / dt;
        work -= force[0] * 0.5 * (before + speed) * dt;
        most = fmax(most, fabs(work));
        before = speed;
        t = now;
    }
    const mps_energy e = energy_of(sim);
    ASSERT_NEAR(e.wall_work_probes, work, 1e-9 * most);
    /* the walls also represent half cells of liquid */
    assert_true(fabs(e.wall_work_probes - e.wall_work_momentum) > 1e-3 * most);
    ASSERT_NEAR(e.wall_work_probes, e.wall_work_momentum, 0.3 * most);
    mps_sim_destroy(sim);
}

/* ---- additions from outside ---- */

/* A sloshing tank in the middle of its run, so that added and removed particles have kinetic and
 * potential energy. */
static mps_sim *sloshing(mps_energy *start, mps_momentum *before)
{
    mps_sim *sim = filled(2, 0.1);
    const mps_harmonic surge = {.dof = MPS_MOVE_X, .amplitude = 0.02, .omega = 10};
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &surge));
    *start = energy_of(sim);
    *before = momentum_of(sim);
    take_steps(sim, 30);
    assert_true(momentum_of(sim).added[0] == 0 && energy_of(sim).added == 0);
    return sim;
}

/* All changes since `e` and `m` were measured are in `added`, and nothing else. */
static void assert_added(mps_sim *sim, const mps_energy *e, const mps_momentum *m)
{
    const mps_energy now = energy_of(sim);
    const mps_momentum p = momentum_of(sim);
    const double change = now.kinetic + now.potential - e->kinetic - e->potential;
    assert_true(fabs(change) > 1e-3);
    ASSERT_NEAR(now.added - e->added, change, rounding * (e->potential + now.potential));
    ASSERT_NEAR(now.numerical, e->numerical, rounding * (e->potential + now.potential));
    for (int d = 0; d < 2; d++)
        ASSERT_NEAR(p.added[d] - m->added[d], p.total[d] - m->total[d], rounding * e->mass);
}

/* Do something between two steps, and go on. */
#define BETWEEN(...)                              \
    do {                                          \
        const mps_energy e_ = energy_of(sim);     \
        const mps_momentum m_ = momentum_of(sim); \
        __VA_ARGS__                               \
        assert_added(sim, &e_, &m_);              \
        assert_closed(sim, &start, &before);      \
        take_steps(sim, 5);                       \
        assert_closed(sim, &start, &before);      \
    } while (0)

static void remove_fluid(mps_sim *sim, int64_t count)
{
    const mps__particles *s = &sim->world.particles;
    int64_t ids[64], n = 0;
    for (int64_t i = 0; i < s->n && n < count; i++)
        if (s->kind[i] == MPS_FLUID) ids[n++] = s->id[i];
    ASSERT_OK(sim, mps_particles_remove(sim, n, ids));
}

/* An energy that overflows is no part of the budget: it could never be taken away again. */
static void overflow(void **state)
{
    (void)state;
    const double x[2] = {50, 50}, u[2] = {1e200, 0};
    mps_energy e;
    mps_particle_block b;
    mps_sim *sim = new_sim(2, 0.05);
    add_tank(sim, 0.4, 0.4, 0);
    fill_depth(sim, 0.4, 0.2, 0);
    take_steps(sim, 2);
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = 1;
    b.position = x;
    b.velocity = u;
    ASSERT_REFUSED(sim, mps_particles_add(sim, &b, NULL), MPS_E_ARG, "at most 1000 m/s");
    mps_lease velocity = {.struct_size = sizeof velocity};
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &velocity));
    const int32_t *kinds;
    int64_t i = 0;
    assert_int_equal(tags_peek(sim, NULL, &kinds, NULL, NULL), MPS_OK);
    while (kinds[i] != MPS_FLUID) i++;
    const double before = velocity.data[2 * i];
    velocity.data[2 * i] = 1e200;
    ASSERT_OK(sim, mps_lease_end(sim, &velocity));
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_DIVERGED, "energy of the fluid is inf J");
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &velocity));
    velocity.data[2 * i] = before;
    ASSERT_OK(sim, mps_lease_end(sim, &velocity));
    take_steps(sim, 1);
    assert_int_equal(mps_energy_init(&e, sizeof e), MPS_OK);
    ASSERT_OK(sim, mps_energy_get(sim, &e));
    assert_true(e.added == 0 && isfinite(e.numerical));
    mps_sim_destroy(sim);
}

static void added_between_steps(void **state)
{
    (void)state;
    mps_energy start;
    mps_momentum before;
    mps_sim *sim = sloshing(&start, &before);
    const double x[4] = {0.2, 0.2, 0.21, 0.2}, u[4] = {1, -2, 1, -2};
    mps_particle_block block;
    assert_int_equal(mps_particle_block_init(&block, sizeof block), MPS_OK);
    block.count = 2;
    block.position = x;
    block.velocity = u;
    BETWEEN(ASSERT_OK(sim, mps_particles_add(sim, &block, NULL)););
    const double lo[2] = {0.05, 0.2}, hi[2] = {0.1, 0.25};
    BETWEEN(ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL)););
    BETWEEN(remove_fluid(sim, 40););
    mps_phase oil;
    assert_int_equal(mps_phase_init(&oil, sizeof oil), MPS_OK);
    oil.density = 800;
    BETWEEN(ASSERT_OK(sim, mps_phase_set(sim, 0, &oil)););
    mps_lease lease = {.struct_size = sizeof lease};
    BETWEEN(ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &lease));
            lease.data[0] += 0.5; lease.data[1] -= 1;
            for (int64_t i = 2; i < lease.count; i++) lease.data[2 * i] *= 0.9;
            ASSERT_OK(sim, mps_lease_end(sim, &lease)););
    const mps_harmonic elsewhere = {.dof = MPS_MOVE_Y, .form = 1, .amplitude = 0.05, .omega = 10};
    BETWEEN(ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &elsewhere)););
    mps_sim_destroy(sim);
}

/* Particles that leave the domain remove their energy and momentum. */
static void lost_particles(void **state)
{
    (void)state;
    mps_energy start;
    mps_momentum before;
    mps_sim *sim = sloshing(&start, &before);
    const double x[2] = {0.2, 100}, u[2] = {3, 1};
    mps_particle_block block;
    assert_int_equal(mps_particle_block_init(&block, sizeof block), MPS_OK);
    block.count = 1;
    block.position = x;
    block.velocity = u;
    const double mass = 1000 * dp * dp, brought = mass * (5 + 9.81 * 100),
                 numerical = energy_of(sim).numerical;
    ASSERT_OK(sim, mps_particles_add(sim, &block, NULL));
    ASSERT_NEAR(energy_of(sim).added, brought, rounding * brought);
    ASSERT_NEAR(momentum_of(sim).added[0], 3 * mass, rounding * mass);
    take_steps(sim, 1);
    assert_int_equal(sim->world.state.lost, 1);
    ASSERT_NEAR(energy_of(sim).added, 0, rounding * brought);
    ASSERT_NEAR(momentum_of(sim).added[0], 0, rounding * mass);
    /* the step itself loses next to nothing of that */
    ASSERT_NEAR(energy_of(sim).numerical, numerical, 1e-3 * brought);
    assert_closed(sim, &start, &before);
    mps_sim_destroy(sim);
}

/* A particle shot at a plate is stopped by it, which is a collision. */
static void stopped_by_a_plate(void **state)
{
    (void)state;
    mps_sim *sim = weightless(0);
    const double corner[2] = {0.2, 0}, edge[2] = {0, 0.3}, x[2] = {0.185, 0.151}, u[2] = {20, 0};
    mps_particle_block block;
    assert_int_equal(mps_particle_block_init(&block, sizeof block), MPS_OK);
    block.count = 1;
    block.position = x;
    block.velocity = u;
    ASSERT_OK(sim, mps_plate_add(sim, "plate", corner, edge, NULL));
    ASSERT_OK(sim, mps_model_remove(sim, "collision"));
    ASSERT_OK(sim, mps_particles_add(sim, &block, NULL));
    const mps_energy start = energy_of(sim);
    const mps_momentum before = momentum_of(sim);
    take_steps(sim, 20);
    const double given = 0.5 * 1000 * dp * dp * 400;
    assert_true(energy_of(sim).collision > 0.5 * given && momentum_of(sim).collision[0] < -1);
    ASSERT_NEAR(energy_of(sim).numerical, 0, rounding * given);
    assert_closed(sim, &start, &before);
    mps_sim_destroy(sim);
}

/* The energy loss of two colliding particles is that of `collision`: > 0, equal to the loss of
 * kinetic energy. */
static void collision_of_two(void **state)
{
    (void)state;
    const double x[4] = {0.1, 0.1, 0.1 + 0.6 * dp, 0.1}, u[4] = {1, 0, -1, 0.5};
    mps_particle_block b;
    mps_sim *sim = weightless(0);
    while (mps_model_name(sim, 0)) ASSERT_OK(sim, mps_model_remove(sim, mps_model_name(sim, 0)));
    ASSERT_OK(sim, mps_model_use(sim, "collision.pair"));
    ASSERT_OK(sim, mps_model_set(sim, "collision", "distance", 0.8));
    ASSERT_OK(sim, mps_model_set(sim, "collision", "restitution", 0.5));
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = 2;
    b.position = x;
    b.velocity = u;
    ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
    const double before = energy_of(sim).kinetic;
    assert_true(mps_step(sim, 1e-6, NULL) >= 0);
    const mps_energy e = energy_of(sim);
    assert_true(e.collision > 0.1 * before);
    ASSERT_NEAR(e.collision, before - e.kinetic, rounding * before);
    ASSERT_NEAR(e.numerical, 0, rounding * before);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(force_models_are_no_walls), cmocka_unit_test(impulsive_start),
        cmocka_unit_test(start_with_the_tank),       cmocka_unit_test(work_of_a_turn),
        cmocka_unit_test(work_by_force_probes),      cmocka_unit_test(overflow),
        cmocka_unit_test(added_between_steps),       cmocka_unit_test(lost_particles),
        cmocka_unit_test(stopped_by_a_plate),        cmocka_unit_test(collision_of_two),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

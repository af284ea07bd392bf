/* SPDX-License-Identifier: BSD-3-Clause */
/* mps_stage_reaction(): forces of solids on the fluid by verbs are included in force probes, works
 * of the walls and the lines of the budgets. */
#include "probe_fixture.h"
#include <mps/reaction.h>
#include <stdio.h>

/* Relative error of sums of several hundred terms of this size. */
static const double rounding = 1e-12;

/* ---- a plug-in that drags the fluid along ---- */

enum { FORCE, VELOCITY };

/* What its verb does; a = -rate (u - u_tank). */
static struct {
    int how;
    double rate;
    const char *part;
    bool report, missing, wrong;
} drag;

static int drag_fluid(mps_stage *s)
{
    double *target = s->data[0], *pushed = mps_stage_scratch(s, s->view->n * s->view->dim);
    const double *u = drag.how == FORCE ? s->data[1] : target;
    if (!pushed) return 1;
    for (int64_t i = 0; i < s->view->n; i++) {
        double tank[3];
        if (s->view->kind[i] != MPS_FLUID) continue;
        mps_view_tank(s->view, s->view->x + i * s->view->dim, NULL, tank);
        for (int d = 0; d < s->view->dim; d++) {
            const int64_t k = i * s->view->dim + d;
            pushed[k] = -drag.rate * (u[k] - tank[d]);
            target[k] += drag.how == FORCE ? pushed[k] : s->view->dt * pushed[k];
        }
    }
    for (int64_t i = 0; i < s->view->n && drag.wrong; i++)
        if (s->view->kind[i] == MPS_FLUID) pushed[i * s->view->dim] = NAN;
    if (drag.missing) return mps_stage_reaction(s, drag.part, NULL);
    return drag.report ? mps_stage_reaction(s, drag.part, pushed) : 0;
}

static const mps_use force_uses[] = {{"acceleration", MPS_USE_CHANGE}, {"velocity", MPS_USE_READ}};
static const mps_use velocity_uses[] = {{"velocity", MPS_USE_CHANGE}};
static const mps_use shift_uses[] = {{"displacement", MPS_USE_CHANGE}};
static const mps_verb verbs[] = {
    {.hook = MPS_FORCE, .use_count = 2, .uses = force_uses, .run = drag_fluid},
    {.hook = MPS_VELOCITY, .use_count = 1, .uses = velocity_uses, .run = drag_fluid},
    {.hook = MPS_SHIFT, .use_count = 1, .uses = shift_uses, .run = drag_fluid}};
static const char *const parts[] = {"screen"};

static void use_drag(mps_sim *sim, int verb)
{
    const mps_model_ops ops = {.struct_size = sizeof ops,
                               .api = MPS_MODEL_API,
                               .name = "test.drag",
                               .help = "drags the fluid along",
                               .verb_count = 1,
                               .verbs = verbs + verb,
                               .part_count = 1,
                               .parts = parts};
    ASSERT_OK(sim, mps_model_register(sim, &ops));
    ASSERT_OK(sim, mps_model_use(sim, "test.drag"));
}

/* ---- looking ---- */

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

/* An instantaneous force probe, about a point. */
static int32_t probe_force(mps_sim *sim, const char *part, double x, double y)
{
    mps_probe p = probe_of(MPS_PROBE_FORCE, x, y, 0);
    int32_t id = -1;
    p.part = part;
    p.average = 0;
    ASSERT_OK(sim, mps_probe_add(sim, &p, &id));
    return id;
}

static void take_step(mps_sim *sim)
{
    assert_true(mps_step(sim, 1, NULL) >= 0);
}

/* ---- scenes ---- */

static int steady(void *user, double t, mps_motion_state *state)
{
    const double speed = *(const double *)user;
    state->value[MPS_MOVE_X] = speed * t;
    state->rate[MPS_MOVE_X] = speed;
    return 0;
}

/* A drop at rest in a steadily moving tank without weight. It touches nothing. */
static mps_sim *drop_in_a_tank(double *speed)
{
    mps_config config;
    mps_sim *sim = NULL;
    const double lo[2] = {0.15, 0.1}, hi[2] = {0.2, 0.15}, centre[2] = {0.3, 0.05};
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dp = dp;
    config.gravity[1] = 0;
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    add_tank(sim, 0.4, 0.3, 0.1);
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    ASSERT_OK(sim, mps_motion_callback_set(sim, steady, speed));
    ASSERT_OK(sim, mps_motion_centre_set(sim, centre, MPS_START_AT_REST));
    return sim;
}

/* A screen accelerates a droplet from rest to the speed U of its tank: force and moment in probes
 * of the screen and of all solids, work m U v, of which m v^2/2 is in the droplet, v = U (1 -
 * exp(-rate t)), and the rest is dissipated, on the line of plug-ins. */
static void dragged_along(void **state)
{
    (void)state;
    for (int how = FORCE; how <= VELOCITY; how++) {
        double speed = 0.5, all[3], occluder[3], floor[3], about[3];
        mps_sim *sim = drop_in_a_tank(&speed);
        memset(&drag, 0, sizeof drag);
        drag.how = how;
        drag.rate = 5;
        drag.part = parts[0];
        drag.report = true;
        use_drag(sim, how);
        const int32_t id[] = {probe_force(sim, NULL, 0, 0), probe_force(sim, "screen", 0, 0),
                              probe_force(sim, "tank.y0", 0, 0), probe_force(sim, NULL, 0.3, 0.2)};
        double before = 0, impulse = 0;
        for (int k = 0; k < 100; k++) {
            const double t = sim->world.state.t;
            take_step(sim);
            const double gained = momentum_of(sim).plugins[0] - before;
            before += gained;
            ASSERT_OK(sim, mps_probe_read(sim, id[0], all));
            ASSERT_NEAR(all[0] * (sim->world.state.t - t), -gained, rounding * fabs(before));
            impulse -= all[0] * (sim->world.state.t - t);
        }
        ASSERT_OK(sim, mps_probe_read(sim, id[1], occluder));
        ASSERT_OK(sim, mps_probe_read(sim, id[2], floor));
        ASSERT_OK(sim, mps_probe_read(sim, id[3], about));
        assert_true(all[0] < 0 && memcmp(all, occluder, sizeof all) == 0);
        assert_true(floor[0] == 0 && floor[1] == 0 && floor[2] == 0);
        /* about the drop's own height and below it; the moment of a force along x */
        const double height = energy_of(sim).centre[1];
        ASSERT_NEAR(all[2], -height * all[0], 1e-3 * height * fabs(all[0]));
        ASSERT_NEAR(about[2], (0.2 - height) * all[0], 1e-3 * height * fabs(all[0]));

        const mps_energy e = energy_of(sim);
        const mps_momentum m = momentum_of(sim);
        const double v = m.total[0] / e.mass, rounds = rounding * e.mass;
        assert_true(v > 0.2 * speed);
        ASSERT_NEAR(m.total[0], impulse, rounds);
        ASSERT_NEAR(m.reaction[0], m.plugins[0], rounds);
        ASSERT_NEAR(m.force[0], 0, 1e-6 * m.total[0]);
        ASSERT_NEAR(m.collision[0], 0, rounds);
        /* the tank reaches its speed within the first step, whose mean is half of it */
        const double work = e.mass * speed * v, lost = work - 0.5 * e.mass * v * v;
        ASSERT_NEAR(e.wall_work_momentum, work, 0.02 * work);
        ASSERT_NEAR(e.wall_work_probes, e.wall_work_momentum, 1e-6 * work);
        ASSERT_NEAR(e.plugins, lost, 0.03 * lost);
        ASSERT_NEAR(e.kinetic - e.wall_work_momentum + e.plugins + e.viscous + e.collision +
                        e.shift + e.numerical,
                    0, rounds);
        ASSERT_NEAR(e.numerical, 0, 0.01 * lost);
        ASSERT_NEAR(e.viscous, 0, 1e-3 * lost);
        ASSERT_NEAR(e.collision, 0, 1e-3 * lost);
        mps_sim_destroy(sim);
    }
}

/* Without a report the force has no source: its energy is a negative loss, and no probe includes
 * it. */
static void without_a_report(void **state)
{
    (void)state;
    double speed = 0.5, force[3];
    mps_sim *sim = drop_in_a_tank(&speed);
    memset(&drag, 0, sizeof drag);
    drag.rate = 5;
    use_drag(sim, FORCE);
    const int32_t id = probe_force(sim, NULL, 0, 0);
    for (int k = 0; k < 50; k++) take_step(sim);
    ASSERT_OK(sim, mps_probe_read(sim, id, force));
    const mps_energy e = energy_of(sim);
    assert_true(force[0] == 0 && e.kinetic > 1e-3 && momentum_of(sim).reaction[0] == 0);
    ASSERT_NEAR(e.wall_work_momentum, 0, 1e-6 * e.kinetic);
    ASSERT_NEAR(e.plugins, -e.kinetic, 0.01 * e.kinetic);
    mps_sim_destroy(sim);
}

/* ---- the library's own ---- */

/* Friction at the walls of a rotating tank of syrup: its impulse on the liquid is that of probes,
 * also by parts, and the loss is positive. */
static void friction_of_walls(void **state)
{
    (void)state;
    static const char *const models[] = {"viscosity.laplacian", "viscosity.pair"};
    static const char *const faces[] = {"tank.x0", "tank.x1", "tank.y0", "tank.y1"};
    for (int which = 0; which < 2; which++) {
        mps_sim *sim = filled(2, 0.15);
        mps_phase syrup;
        const mps_harmonic turn = {.dof = MPS_ROTATE_Z, .amplitude = 0.3, .omega = 6};
        int32_t all = probe_force(sim, NULL, 0.1, 0.05), face[4];
        assert_int_equal(mps_phase_init(&syrup, sizeof syrup), MPS_OK);
        syrup.density = 1000;
        syrup.viscosity = 5;
        ASSERT_OK(sim, mps_phase_set(sim, 0, &syrup));
        ASSERT_OK(sim, mps_model_use(sim, models[which]));
        ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &turn));
        for (int k = 0; k < 4; k++) face[k] = probe_force(sim, faces[k], 0.1, 0.05);
        double before[2] = {0}, most = 0;
        for (int k = 0; k < 40; k++) {
            const double t = sim->world.state.t;
            double force[3], sum[3] = {0}, one[3];
            take_step(sim);
            const double dt = sim->world.state.t - t;
            const mps_momentum m = momentum_of(sim);
            ASSERT_OK(sim, mps_probe_read(sim, all, force));
            for (int f = 0; f < 4; f++) {
                ASSERT_OK(sim, mps_probe_read(sim, face[f], one));
                for (int d = 0; d < 3; d++) sum[d] += one[d];
            }
            for (int d = 0; d < 2; d++) {
                const double now = m.walls[d] + m.reaction[d];
                most = fmax(most, fabs(m.gravity[1]));
                /* the probe uses the rotated areas at the end of the step */
                ASSERT_NEAR(-force[d] * dt, now - before[d], 0.02 * hypot(force[0], force[1]) * dt);
                before[d] = now;
            }
            for (int d = 0; d < 3; d++)
                ASSERT_NEAR(sum[d], force[d], rounding * fabs(m.gravity[1]) / dt);
            /* fluid inside adds nothing; what collisions with walls do is reported too */
            for (int d = 0; d < 2; d++)
                ASSERT_NEAR(m.reaction[d], m.force[d] + m.collision[d], 1e-10 * most);
        }
        const mps_momentum m = momentum_of(sim);
        const mps_energy e = energy_of(sim);
        assert_true(fabs(m.force[0]) > 1e-3 * most && e.viscous > 0);
        mps_sim_destroy(sim);
    }
}

/* Friction at the side walls of a thin tank is a part of its own. */
static void side_walls(void **state)
{
    (void)state;
    double speed = 0.5, sides[3];
    mps_sim *sim = drop_in_a_tank(&speed);
    ASSERT_OK(sim, mps_model_use(sim, "friction.history"));
    ASSERT_OK(sim, mps_model_set(sim, "friction", "width", 0.002));
    const int32_t id = probe_force(sim, "sides", 0, 0);
    for (int k = 0; k < 20; k++) take_step(sim);
    ASSERT_OK(sim, mps_probe_read(sim, id, sides));
    const mps_energy e = energy_of(sim);
    const mps_momentum m = momentum_of(sim);
    ASSERT_NEAR(m.reaction[0], m.total[0], 1e-6 * m.total[0]);
    assert_true(m.total[0] > 1e-3 && sides[0] < 0 && e.friction > 0);
    ASSERT_NEAR(e.wall_work_momentum, e.friction + e.viscous + e.kinetic + e.layers,
                0.01 * e.friction);
    mps_sim_destroy(sim);
}

/* A drop thrown at a wall: what the collision takes from it the wall gets. */
static void collision_with_a_wall(void **state)
{
    (void)state;
    double speed = 0, force[3], impulse = 0;
    mps_sim *sim = drop_in_a_tank(&speed);
    const double x[2] = {0.02, 0.05}, u[2] = {-1, 0};
    mps_particle_block block;
    assert_int_equal(mps_particle_block_init(&block, sizeof block), MPS_OK);
    block.count = 1;
    block.position = x;
    block.velocity = u;
    ASSERT_OK(sim, mps_particles_add(sim, &block, NULL));
    const int32_t id = probe_force(sim, "tank.x0", 0, 0);
    for (int k = 0; k < 40; k++) {
        const double t = sim->world.state.t;
        take_step(sim);
        ASSERT_OK(sim, mps_probe_read(sim, id, force));
        impulse -= force[0] * (sim->world.state.t - t);
    }
    const mps_momentum m = momentum_of(sim);
    assert_true(m.collision[0] > 0.02);
    ASSERT_NEAR(m.reaction[0], m.collision[0] + m.force[0], 1e-9);
    ASSERT_NEAR(impulse, m.walls[0] + m.reaction[0], 1e-9);
    mps_sim_destroy(sim);
}

/* ---- refusals ---- */

static void refusals(void **state)
{
    (void)state;
    static const struct {
        const char *part, *word;
        bool missing, wrong;
        int verb;
    } cases[] = {{"nothing", "no part is named 'nothing'", false, false, 0},
                 {"screen", "acceleration is NULL", true, false, 0},
                 {"screen", "not finite", false, true, 0},
                 {NULL, "not finite", false, true, 0},
                 {"screen", "not finite", false, true, 1},
                 {"screen", "of hook 'shift'", false, false, 2}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        double speed = 0.5, before[3], after[3];
        mps_sim *sim = drop_in_a_tank(&speed);
        memset(&drag, 0, sizeof drag);
        drag.rate = 5;
        drag.part = "screen";
        drag.report = cases[k].verb != 2;
        drag.how = cases[k].verb > 0;
        use_drag(sim, cases[k].verb);
        const int32_t id = probe_force(sim, NULL, 0, 0);
        for (int step = 0; step < 3; step++) take_step(sim);
        ASSERT_OK(sim, mps_probe_read(sim, id, before));
        const mps_energy e = energy_of(sim);
        drag.part = cases[k].part;
        drag.missing = cases[k].missing;
        drag.wrong = cases[k].wrong;
        drag.report = true;
        ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, cases[k].word);
        /* nothing of the failed step is left */
        ASSERT_OK(sim, mps_probe_read(sim, id, after));
        const mps_energy f = energy_of(sim);
        assert_memory_equal(before, after, sizeof after);
        assert_memory_equal(&e, &f, sizeof e);
        mps_sim_destroy(sim);
    }
}

/* Names of parts are those of the table, and their number is limited. */
static void names_of_parts(void **state)
{
    (void)state;
    enum { MOST = 64, EACH = 8 };
    static char name[MOST + EACH][16];
    static const char *list[MOST + EACH]; /* tables outlive the handle */
    const char *none[] = {""};
    mps_sim *sim = filled(2, 0.1);
    mps_model_ops ops = {.struct_size = sizeof ops,
                         .api = MPS_MODEL_API,
                         .name = "test0.drag",
                         .help = "many parts",
                         .verb_count = 1,
                         .verbs = verbs,
                         .part_count = 1,
                         .parts = none};
    mps_probe probe = probe_of(MPS_PROBE_FORCE, 0, 0, 0);
    char model[32];
    int32_t id;
    ASSERT_REFUSED(sim, mps_model_register(sim, &ops), MPS_E_ARG, "part 0");
    ops.part_count = 9;
    ASSERT_REFUSED(sim, mps_model_register(sim, &ops), MPS_E_ARG, "9 parts");
    probe.part = "part7";
    ASSERT_REFUSED(sim, mps_probe_add(sim, &probe, &id), MPS_E_NAME, "part7");
    ops.part_count = EACH;
    for (int k = 0; k < MOST + EACH; k += EACH) {
        for (int i = 0; i < EACH; i++) {
            snprintf(name[k + i], sizeof name[0], "part%d", k + i);
            list[k + i] = name[k + i];
        }
        snprintf(model, sizeof model, "test%d.drag", k);
        ops.name = model;
        ops.parts = list + k;
        if (k + EACH > MOST - 4) break; /* the tank has four parts */
        ASSERT_OK(sim, mps_model_register(sim, &ops));
        ASSERT_OK(sim, mps_model_use(sim, model));
        if (k == 0) ASSERT_OK(sim, mps_probe_add(sim, &probe, &id));
        ASSERT_OK(sim, mps_model_remove(sim, model));
    }
    ASSERT_OK(sim, mps_model_register(sim, &ops));
    ASSERT_REFUSED(sim, mps_model_use(sim, ops.name), MPS_E_ARG, "at most 64");
    take_step(sim);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dragged_along),     cmocka_unit_test(without_a_report),
        cmocka_unit_test(friction_of_walls), cmocka_unit_test(side_walls),
        cmocka_unit_test(refusals),          cmocka_unit_test(collision_with_a_wall),
        cmocka_unit_test(names_of_parts)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

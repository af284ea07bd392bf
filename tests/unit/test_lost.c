/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles that leave the domain or the tank: both policies, explicit and default domains, moved
 * and rotated tanks. */
#include "tank_fixture.h"
#include <stdio.h>

static const double dp = 0.05;

typedef struct message {
    int level, count;
    char text[300];
} message;

static void keep_message(void *user, int level, const char *text)
{
    message *m = user;
    m->level = level;
    m->count++;
    snprintf(m->text, sizeof m->text, "%s", text);
}

/* A pool in a tank of 0.5 m; the domain ends 0.7 m (its longest side with dummies) beyond the
 * solids. */
static mps_sim *pool(int32_t policy, message *m, const double *lo, const double *hi)
{
    mps_config c;
    mps_sim *sim = NULL;
    assert_int_equal(mps_config_init(&c, sizeof c), MPS_OK);
    c.dp = dp;
    c.lost_policy = policy;
    c.log = keep_message;
    c.log_user = m;
    if (lo) memcpy(c.domain_min, lo, 2 * sizeof *lo);
    if (hi) memcpy(c.domain_max, hi, 2 * sizeof *hi);
    assert_int_equal(mps_sim_create(&c, &sim), MPS_OK);
    add_tank(sim, 0.5, 0.5, 0);
    fill_depth(sim, 0.5, 0.3, 0);
    *m = (message){0};
    return sim;
}

/* Any fluid particle. */
static int64_t some_fluid(mps_sim *sim)
{
    const int64_t *ids;
    const int32_t *kinds;
    ASSERT_OK(sim, tags_peek(sim, &ids, &kinds, NULL, NULL));
    for (int64_t i = mps_particles_count(sim, -1) - 1; i >= 0; i--)
        if (kinds[i] == MPS_FLUID) return ids[i];
    fail_msg("there is no fluid");
    return -1;
}

static void put(mps_sim *sim, int64_t id, double x, double y)
{
    mps_lease p = {.struct_size = sizeof p};
    const int64_t at = mps_particle_index(sim, id);
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_WRITE, &p));
    p.data[2 * at] = x;
    p.data[2 * at + 1] = y;
    ASSERT_OK(sim, mps_lease_end(sim, &p));
}

static int64_t lost_in_step(mps_sim *sim)
{
    mps_step_info info;
    assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
    ASSERT_OK(sim, mps_step(sim, 1e-4, &info));
    return info.lost;
}

static void removed_and_counted(void **state)
{
    (void)state;
    message m;
    char word[32];
    mps_sim *sim = pool(MPS_LOST_REMOVE, &m, NULL, NULL);
    const int64_t n = mps_particles_count(sim, -1), id = some_fluid(sim);
    put(sim, id, 0.25, 1.25); /* within */
    assert_int_equal(lost_in_step(sim), 0);
    put(sim, id, 0.25, 1.35); /* beyond 0.6 + 0.7 */
    assert_int_equal(lost_in_step(sim), 1);
    assert_int_equal(mps_particles_count(sim, -1), n - 1);
    assert_int_equal(mps_particle_index(sim, id), -1);
    assert_true(m.level == MPS_LOG_WARNING && m.count == 1);
    snprintf(word, sizeof word, "particle %lld was at", (long long)id);
    assert_non_null(strstr(m.text, word));
    put(sim, some_fluid(sim), -1e6, 0.1);
    assert_int_equal(lost_in_step(sim), 2); /* since creation */
    mps_sim_destroy(sim);
}

static void refused_by_policy(void **state)
{
    (void)state;
    message m;
    char word[32];
    double t = -1;
    int64_t steps = -1;
    mps_sim *sim = pool(MPS_LOST_ERROR, &m, NULL, NULL);
    const int64_t n = mps_particles_count(sim, -1), id = some_fluid(sim);
    assert_int_equal(lost_in_step(sim), 0);
    put(sim, id, 0.25, 1e9);
    for (int k = 0; k < 2; k++) { /* as often as one tries */
        snprintf(word, sizeof word, "particle %lld is at", (long long)id);
        ASSERT_REFUSED(sim, mps_step(sim, 1e-4, NULL), MPS_E_LOST, word);
    }
    ASSERT_OK(sim, mps_sim_time(sim, &t, &steps));
    assert_true(t == 1e-4 && steps == 1 && m.count == 0);
    assert_int_equal(mps_particles_count(sim, -1), n);
    mps_lease p = {.struct_size = sizeof p};
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &p));
    assert_true(p.data[2 * mps_particle_index(sim, id) + 1] == 1e9);
    ASSERT_OK(sim, mps_lease_end(sim, &p));
    ASSERT_OK(sim, mps_particles_remove(sim, 1, &id)); /* the way out */
    assert_int_equal(lost_in_step(sim), 0);
    mps_sim_destroy(sim);
}

static void given_domain(void **state)
{
    (void)state;
    message m;
    const double lo[2] = {-0.1, -0.1}, hi[2] = {0.6, 0.8};
    mps_sim *sim = pool(MPS_LOST_REMOVE, &m, lo, hi);
    const int64_t id = some_fluid(sim);
    put(sim, id, 0.25, 0.79);
    assert_int_equal(lost_in_step(sim), 0);
    put(sim, id, 0.25, 0.81);
    assert_int_equal(lost_in_step(sim), 1);
    mps_sim_destroy(sim);
}

/* If the nearest solid is a dummy, and the face of its wall points the other way, the liquid is
 * outside of the tank. */
static void behind_a_wall(void **state)
{
    (void)state;
    message m;
    mps_sim *sim = pool(MPS_LOST_REMOVE, &m, NULL, NULL);
    const int64_t id = some_fluid(sim);
    const double before[][2] = {
        {0.1 * dp, 0.42}, {-0.4 * dp, 0.42}, {0.1 * dp, 0.1 * dp}, {-5 * dp, 0.25}};
    for (size_t k = 0; k < sizeof before / sizeof before[0];
         k++) { /* at a wall, in its plane, in a corner, a spacing from the dummies */
        put(sim, id, before[k][0], before[k][1]);
        assert_int_equal(lost_in_step(sim), 0);
    }
    put(sim, id, -0.6 * dp, 0.42);
    assert_int_equal(lost_in_step(sim), 1);
    assert_int_equal(mps_particle_index(sim, id), -1);
    assert_non_null(strstr(m.text, "behind a wall"));
    put(sim, some_fluid(sim), 0.25, -2.8 * dp); /* under the floor */
    assert_int_equal(lost_in_step(sim), 2);
    mps_sim_destroy(sim);
    sim = pool(MPS_LOST_ERROR, &m, NULL, NULL);
    const int64_t n = mps_particles_count(sim, -1);
    put(sim, some_fluid(sim), -0.6 * dp, 0.42);
    ASSERT_REFUSED(sim, mps_step(sim, 1e-4, NULL), MPS_E_LOST, "behind a wall");
    assert_int_equal(mps_particles_count(sim, -1), n);
    mps_sim_destroy(sim);
}

/* No particle is lost behind a plate: its shadows are in the liquid of the other side, dummies
 * between its columns behind both faces. */
static void beside_a_plate(void **state)
{
    (void)state;
    for (int columns = 1; columns <= 3; columns++) {
        mps_sim *sim = new_sim(2, dp);
        const double lo[2] = {0.25, 0}, hi[2] = {0.25 + (columns - 1) * dp, 0.45};
        add_tank(sim, 0.5, 0.6, 0);
        ASSERT_OK(sim, mps_baffle_add(sim, "plate", lo, hi, NULL));
        fill_depth(sim, 0.5, 0.3, 0);
        const int64_t id = some_fluid(sim);
        put(sim, id, 0.25 - 0.2 * dp, 0.42);
        assert_int_equal(lost_in_step(sim), 0);
        put(sim, id, hi[0] + 0.2 * dp, 0.42);
        assert_int_equal(lost_in_step(sim), 0);
        put(sim, id, 0.25, 0.45 + 0.3 * dp); /* over its edge */
        assert_int_equal(lost_in_step(sim), 0);
        mps_sim_destroy(sim);
    }
}

/* Rotated by 90 degrees and displaced: lab (x, y) = (5 - Y, 2 + X). */
static int quarter_turn(void *user, double t, mps_motion_state *state)
{
    (void)user, (void)t;
    state->value[MPS_MOVE_X] = 5;
    state->value[MPS_MOVE_Y] = 2;
    state->value[MPS_ROTATE_Z] = acos(-1.0) / 2;
    return 0;
}

/* The domain moves with the tank: the position in the frame of the tank is decisive. */
static void moved_tank(void **state)
{
    (void)state;
    message m;
    mps_sim *sim = pool(MPS_LOST_REMOVE, &m, NULL, NULL);
    const int64_t n = mps_particles_count(sim, -1), id = some_fluid(sim);
    ASSERT_OK(sim, mps_motion_callback_set(sim, quarter_turn, NULL));
    assert_int_equal(lost_in_step(sim), 0); /* far from where the tank was */
    assert_int_equal(mps_particles_count(sim, -1), n);
    put(sim, id, 5 - 1.25, 2 + 0.25); /* over the open end of the tank, which is now on its side */
    assert_int_equal(lost_in_step(sim), 0);
    put(sim, id, 5 - 1.35, 2 + 0.25);
    assert_int_equal(lost_in_step(sim), 1);
    put(sim, some_fluid(sim), 5 + 0.6 * dp, 2 + 0.25); /* behind its floor */
    assert_int_equal(lost_in_step(sim), 2);
    put(sim, some_fluid(sim), 0.25, 0.25); /* where the tank was */
    assert_int_equal(lost_in_step(sim), 3);
    mps_sim_destroy(sim);
}

/* Without solids there is no domain; a distant particle must not cause a hang. */
static void no_domain(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, dp);
    const double x[6] = {0, 0, dp, 0, 1e6 * dp, 1e6 * dp};
    mps_particle_block b;
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = 3;
    b.position = x;
    ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
    assert_int_equal(lost_in_step(sim), 0);
    put(sim, 2, 1e15, 0);
    ASSERT_REFUSED(sim, mps_step(sim, 1e-4, NULL), MPS_E_ARG, "apart along axis 0");
    assert_int_equal(mps_particles_count(sim, -1), 3);
    put(sim, 2, 1, 0);
    assert_int_equal(lost_in_step(sim), 0);
    mps_sim_destroy(sim);
}

/* No fluid remains: the step that lost the last particle reports it. */
static void all_lost(void **state)
{
    (void)state;
    message m;
    mps_sim *sim = pool(MPS_LOST_REMOVE, &m, NULL, NULL);
    while (mps_particles_count(sim, MPS_FLUID) > 1) {
        const int64_t id = some_fluid(sim);
        ASSERT_OK(sim, mps_particles_remove(sim, 1, &id));
    }
    put(sim, some_fluid(sim), 100, 100);
    const mps_status first = mps_step(sim, 1e-4, NULL);
    assert_true(first == MPS_OK || first == MPS_E_STATE);
    ASSERT_REFUSED(sim, mps_step(sim, 1e-4, NULL), MPS_E_STATE, "no fluid");
    assert_int_equal(mps_particles_count(sim, MPS_FLUID), 0);
    mps_sim_destroy(sim);
}

/* ---- steps that are too long for the walls ---- */

/* A drop in the middle of an empty tank of 1 m, with 31 m/s. */
static mps_sim *bullet(int32_t layers, message *m, const mps_time_control *control)
{
    mps_config c;
    mps_tank tank;
    mps_particle_block block;
    mps_sim *sim = NULL;
    const double x[2] = {0.5, 0.5}, u[2] = {31, 0};
    assert_int_equal(mps_config_init(&c, sizeof c), MPS_OK);
    c.dp = dp;
    c.log = keep_message;
    c.log_user = m;
    assert_int_equal(mps_sim_create(&c, &sim), MPS_OK);
    assert_int_equal(mps_tank_init(&tank, sizeof tank), MPS_OK);
    tank.size[0] = tank.size[1] = 1;
    tank.dummy_layers = layers;
    ASSERT_OK(sim, mps_tank_add(sim, &tank, NULL));
    assert_int_equal(mps_particle_block_init(&block, sizeof block), MPS_OK);
    block.count = 1;
    block.position = x;
    block.velocity = u;
    ASSERT_OK(sim, mps_particles_add(sim, &block, NULL));
    ASSERT_OK(sim, mps_time_control_set(sim, control));
    *m = (message){0};
    return sim;
}

static mps_time_control fixed_step(double dt)
{
    mps_time_control c;
    assert_int_equal(mps_time_control_init(&c, sizeof c), MPS_OK);
    c.dt = dt;
    return c;
}

/* 3.1 spacings are more than a wall and two dummies: the step is undone. One more layer is
 * sufficient, and so is a tank that moves along. */
static void too_long_steps(void **state)
{
    (void)state;
    message m;
    mps_time_control control = fixed_step(5e-3);
    const double place[3] = {0.5, 0.5, 0};
    mps_sim *sim = bullet(2, &m, &control);
    mps_lease x = {.struct_size = sizeof x};
    double t;
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_DIVERGED,
                   "at (0.5, 0.5, 0) m would move 0.155 m in a step of 0.005 s, at 31 m/s; "
                   "allowed: at most 0.15 m");
    ASSERT_OK(sim, mps_sim_time(sim, &t, NULL));
    assert_true(t == 0 && m.count == 0);
    const int64_t i = mps_particles_count(sim, -1) - 1;
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
    for (int d = 0; d < 2; d++) {
        int64_t at = 0;
        while (at < i && !(x.data[2 * at] == place[0] && x.data[2 * at + 1] == place[1])) at++;
        assert_true(x.data[2 * at + d] == place[d]);
    }
    ASSERT_OK(sim, mps_lease_end(sim, &x));
    mps_sim_destroy(sim);
    sim = bullet(3, &m, &control);
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    mps_sim_destroy(sim);
    const double times[2] = {0, 1}, way[2] = {0, 31};
    const int32_t surge = MPS_MOVE_X;
    sim = bullet(2, &m, &control);
    ASSERT_OK(sim, mps_motion_table_set(sim, 2, times, 1, &surge, way));
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    assert_int_equal(m.count, 0);
    mps_sim_destroy(sim);
    control = fixed_step(0);
    control.gravity = -1;
    control.cfl = 3.2;
    sim = bullet(2, &m, &control);
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_DIVERGED, "would move 0.16 m");
    mps_sim_destroy(sim);
}

/* A failed step loses no particle, not from the store, the count or the budget. */
static void failed_step_loses_no_particle(void **state)
{
    (void)state;
    message m;
    mps_time_control control = fixed_step(5e-3);
    mps_sim *sim = bullet(2, &m, &control);
    mps_particle_block block;
    mps_step_info info;
    mps_energy energy;
    mps_lease u = {.struct_size = sizeof u};
    const double far[2] = {0.5, 1e3};
    int64_t id;
    assert_int_equal(mps_particle_block_init(&block, sizeof block), MPS_OK);
    block.count = 1;
    block.position = far;
    ASSERT_OK(sim, mps_particles_add(sim, &block, &id));
    ASSERT_OK(sim, mps_field_add(sim, "mark", 1));
    const int64_t n = mps_particles_count(sim, -1);
    ASSERT_OK(sim, mps_lease_begin(sim, "mark", MPS_WRITE, &u));
    u.data[mps_particle_index(sim, id)] = 7;
    ASSERT_OK(sim, mps_lease_end(sim, &u));
    for (int k = 0; k < 2; k++) {
        ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_DIVERGED, "would move 0.155 m");
        assert_int_equal(mps_particles_count(sim, -1), n);
    }
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &u));
    assert_true(u.data[2 * mps_particle_index(sim, id) + 1] == far[1]);
    ASSERT_OK(sim, mps_lease_end(sim, &u));
    ASSERT_OK(sim, mps_lease_begin(sim, "mark", MPS_READ, &u));
    assert_true(u.data[mps_particle_index(sim, id)] == 7);
    ASSERT_OK(sim, mps_lease_end(sim, &u));
    control.dt = 1e-4;
    ASSERT_OK(sim, mps_time_control_set(sim, &control));
    assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
    ASSERT_OK(sim, mps_step(sim, 1, &info));
    assert_int_equal(info.lost, 1);
    assert_int_equal(mps_particles_count(sim, -1), n - 1);
    assert_int_equal(mps_particle_index(sim, id), -1);
    assert_int_equal(mps_energy_init(&energy, sizeof energy), MPS_OK);
    ASSERT_OK(sim, mps_energy_get(sim, &energy));
    const double potential = 1000 * dp * dp * 9.81 * far[1];
    assert_true(fabs(energy.added + potential) < 1e-9 * potential); /* booked once */
    mps_sim_destroy(sim);
}

/* A cloud without walls in a domain it has left. */
static void everything_lost(void **state)
{
    (void)state;
    mps_config c;
    mps_particle_block block;
    mps_sim *sim = NULL;
    const double x[2] = {0.5, 5};
    assert_int_equal(mps_config_init(&c, sizeof c), MPS_OK);
    c.dp = dp;
    c.domain_max[0] = c.domain_max[1] = 1;
    assert_int_equal(mps_sim_create(&c, &sim), MPS_OK);
    assert_int_equal(mps_particle_block_init(&block, sizeof block), MPS_OK);
    block.count = 1;
    block.position = x;
    ASSERT_OK(sim, mps_particles_add(sim, &block, NULL));
    for (int k = 0; k < 2; k++)
        ASSERT_REFUSED(sim, mps_step(sim, 1e-4, NULL), MPS_E_STATE,
                       "all particles left the domain");
    assert_int_equal(mps_particles_count(sim, -1), 1);
    mps_sim_destroy(sim);
}

/* More than a spacing per step is logged once, and only for steps that are not limited by the
 * speed. */
static void long_steps_are_told_once(void **state)
{
    (void)state;
    message m;
    mps_time_control control = fixed_step(2e-3); /* 1.24 spacings */
    mps_sim *sim = bullet(2, &m, &control);
    for (int k = 0; k < 3; k++) ASSERT_OK(sim, mps_step(sim, 1, NULL));
    assert_int_equal(m.count, 1);
    assert_int_equal(m.level, MPS_LOG_WARNING);
    assert_non_null(strstr(m.text, "fixed step of 0.002 s"));
    assert_non_null(strstr(m.text, "0.062 m"));
    mps_sim_destroy(sim);
    control = fixed_step(1.6e-3); /* 0.99 */
    sim = bullet(2, &m, &control);
    for (int k = 0; k < 3; k++) ASSERT_OK(sim, mps_step(sim, 1, NULL));
    assert_int_equal(m.count, 0);
    mps_sim_destroy(sim);
    control = fixed_step(0);
    sim = bullet(2, &m, &control);
    for (int k = 0; k < 3; k++) ASSERT_OK(sim, mps_step(sim, 1, NULL));
    assert_int_equal(m.count, 0);
    mps_sim_destroy(sim);
}

/* Fluid added outside of the walls is logged immediately. */
static void added_outside(void **state)
{
    (void)state;
    message m;
    mps_particle_block b;
    const double x[4] = {0.25, 0.4, 0.8, 0.25};
    mps_sim *sim = pool(MPS_LOST_REMOVE, &m, NULL, NULL);
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = 1;
    b.position = x;
    ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
    assert_int_equal(m.count, 0);
    b.position = x + 2;
    ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
    assert_true(m.count == 1 && m.level == MPS_LOG_WARNING);
    assert_non_null(strstr(m.text, "outside of the box of the solids, first at (0.8, 0.25, 0) m"));
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(added_outside),
        cmocka_unit_test(removed_and_counted),
        cmocka_unit_test(refused_by_policy),
        cmocka_unit_test(given_domain),
        cmocka_unit_test(behind_a_wall),
        cmocka_unit_test(beside_a_plate),
        cmocka_unit_test(moved_tank),
        cmocka_unit_test(no_domain),
        cmocka_unit_test(all_lost),
        cmocka_unit_test(too_long_steps),
        cmocka_unit_test(long_steps_are_told_once),
        cmocka_unit_test(failed_step_loses_no_particle),
        cmocka_unit_test(everything_lost),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

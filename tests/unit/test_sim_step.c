/* SPDX-License-Identifier: BSD-3-Clause */
/* Stepping: time control, a user's model, and steps that fail - with the state as before, bit for
 * bit. */
#include "tank_fixture.h"
#include <mps/model.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

static const double dp = 0.05;

/* ---- a model with a verb in every moment that pushes, fails or spoils on demand -------------- */

enum { CLASSIFY, PREPARE, FORCE, SOURCE, LEVEL, GRADIENT, LOAD, VELOCITY, SHIFT, VERBS };
static const char *const verb_name[VERBS] = {"classify", "prepare", "force",    "source", "level",
                                             "gradient", "load",    "velocity", "shift"};

/* What the model under test does; one for all handles of this program. */
static struct {
    int fail;        /* verb that fails, -1: none */
    int silent;      /* ... without mps_stage_fail() */
    int spoil;       /* 1: NaN in a velocity, 2: in an acceleration, 3: a velocity beyond the limit,
                        4: a shift through the walls */
    int64_t victim;  /* id of the spoilt particle */
    double dt_limit; /* INFINITY: none */
    int32_t region;  /* what classify leaves at the victim, MPS_REGION_INNER: nothing */
    int created, destroyed, calls[VERBS];
} test;

/* Each verb changes all that it may, so that a failure leaves a mess. */
static const mps_use region_uses[] = {{"region", MPS_USE_CHANGE}};
static const mps_use push_uses[] = {{"acceleration", MPS_USE_CHANGE}};
static const mps_use level_uses[] = {{"pressure", MPS_USE_CHANGE}};
static const mps_use load_uses[] = {{"wall_pressure", MPS_USE_CHANGE}};
static const mps_use velocity_uses[] = {{"velocity", MPS_USE_CHANGE}};
static const mps_use shift_uses[] = {{"displacement", MPS_USE_CHANGE},
                                     {"velocity", MPS_USE_CHANGE}};

/* `mess` [count]: NULL or numbers that must not be seen after a failure. */
static int verb(mps_stage *s, int which, double *mess, int64_t count)
{
    test.calls[which]++;
    if (test.fail != which) return 0;
    for (int64_t i = 0; i < count; i++) mess[i] = -77;
    return test.silent ? 1 : mps_stage_fail(s, "the %s is out of order", verb_name[which]);
}

static int64_t place_of(const mps_stage *s, int64_t id)
{
    for (int64_t i = 0; i < s->n; i++)
        if (s->id[i] == id) return i;
    return 0;
}

static int create(const mps_allocator *allocator, void **self)
{
    test.created++;
    *self = allocator->alloc(allocator->user, 8);
    return *self == NULL;
}

static void destroy(const mps_allocator *allocator, void *self)
{
    test.destroyed++;
    allocator->release(allocator->user, self);
}

static int limit(mps_stage *s)
{
    if (!(test.dt_limit >= s->dt_limit)) s->dt_limit = test.dt_limit; /* NaN too */
    return 0;
}

static int classify(mps_stage *s)
{
    int32_t *region = s->data[0];
    if (test.region != MPS_REGION_INNER) region[place_of(s, test.victim)] = test.region;
    return verb(s, CLASSIFY, NULL, 0);
}

static int prepare(mps_stage *s)
{
    return verb(s, PREPARE, NULL, 0);
}

static int force(mps_stage *s)
{
    double *a = s->data[0];
    assert_non_null(s->self);
    for (int64_t i = 0; i < s->n; i++) a[i * s->dim] += s->setting[0];
    if (test.spoil == 2) a[place_of(s, test.victim) * s->dim] = NAN;
    return verb(s, FORCE, a, s->n * s->dim);
}

static int source(mps_stage *s)
{
    return verb(s, SOURCE, NULL, 0);
}

static int level(mps_stage *s)
{
    return verb(s, LEVEL, s->data[0], s->n);
}

static int gradient(mps_stage *s)
{
    return verb(s, GRADIENT, s->data[0], s->n * s->dim);
}

static int load(mps_stage *s)
{
    return verb(s, LOAD, s->data[0], s->n);
}

static int velocity(mps_stage *s)
{
    double *u = s->data[0];
    if (test.spoil == 1) u[place_of(s, test.victim) * s->dim + 1] = NAN;
    if (test.spoil == 3) u[place_of(s, test.victim) * s->dim + 1] = 1e4;
    return verb(s, VELOCITY, u, s->n * s->dim);
}

static int shift(mps_stage *s)
{
    double *dx = s->data[0];
    if (test.spoil == 4) dx[place_of(s, test.victim) * s->dim] += 4 * s->dp;
    return verb(s, SHIFT, s->data[1], s->n * s->dim);
}

static const mps_setting push_settings[] = {
    {"acceleration", "m/s2", "along the first axis", MPS_TYPE_REAL, 0, -100, 100}};
static const mps_verb push_verbs[] = {
    {.moment = MPS_LIMIT, .run = limit},
    {.moment = MPS_CLASSIFY, .use_count = 1, .uses = region_uses, .after = "*", .run = classify},
    {.moment = MPS_PREPARE, .run = prepare},
    {.moment = MPS_FORCE, .use_count = 1, .uses = push_uses, .run = force},
    {.moment = MPS_SOURCE, .run = source},
    {.moment = MPS_LEVEL, .use_count = 1, .uses = level_uses, .run = level},
    {.moment = MPS_GRADIENT, .use_count = 1, .uses = push_uses, .run = gradient},
    {.moment = MPS_LOAD, .use_count = 1, .uses = load_uses, .run = load},
    {.moment = MPS_VELOCITY, .use_count = 1, .uses = velocity_uses, .run = velocity},
    {.moment = MPS_SHIFT, .use_count = 2, .uses = shift_uses, .run = shift}};
static const mps_model_ops push = {.struct_size = sizeof(mps_model_ops),
                                   .api = MPS_MODEL_API,
                                   .name = "test.push",
                                   .help = "pushes, fails or spoils on demand",
                                   .setting_count = 1,
                                   .settings = push_settings,
                                   .verb_count = 10,
                                   .verbs = push_verbs,
                                   .create = create,
                                   .destroy = destroy};

static void reset_test(void)
{
    memset(&test, 0, sizeof test);
    test.fail = -1;
    test.dt_limit = INFINITY;
}

static void use_push(mps_sim *sim)
{
    ASSERT_OK(sim, mps_model_register(sim, &push));
    ASSERT_OK(sim, mps_model_use(sim, "test.push"));
}

/* ---- scenes ---------------------------------------------------------------------------------- */

static void fill_pool(mps_sim *sim)
{
    mps_tank tank;
    assert_int_equal(mps_tank_init(&tank, sizeof tank), MPS_OK);
    tank.size[0] = tank.size[1] = 0.5;
    ASSERT_OK(sim, mps_tank_add(sim, &tank, NULL));
    fill_depth(sim, 0.5, 0.3, 0);
}

static mps_sim *pool(void)
{
    reset_test();
    mps_sim *sim = new_sim(2, dp);
    fill_pool(sim);
    return sim;
}

static const double drop_places[6] = {0, 0, 1, 0, 0, 1};

/* Three drops far apart, no walls, no gravity. */
static mps_sim *drops(void)
{
    mps_config c;
    mps_sim *sim = NULL;
    mps_particle_block b;
    reset_test();
    assert_int_equal(mps_config_init(&c, sizeof c), MPS_OK);
    c.dp = dp;
    memset(c.gravity, 0, sizeof c.gravity);
    assert_int_equal(mps_sim_create(&c, &sim), MPS_OK);
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = 3;
    b.position = drop_places;
    ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
    return sim;
}

static void set_velocity(mps_sim *sim, int64_t id, double ux, double uy)
{
    mps_lease u = {.struct_size = sizeof u};
    const int64_t at = mps_particle_index(sim, id);
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &u));
    u.data[u.stride * at] = ux;
    u.data[u.stride * at + 1] = uy;
    ASSERT_OK(sim, mps_lease_end(sim, &u));
}

/* Time, positions, velocities, pressures by id. */
typedef struct picture {
    double t, value[5000];
    int64_t steps, n;
} picture;

static picture take_picture(mps_sim *sim)
{
    static const char *const fields[] = {"position", "velocity", "pressure"};
    const int64_t *ids;
    picture c;
    int64_t at = 0;
    memset(&c, 0, sizeof c);
    c.n = mps_particles_count(sim, -1);
    ASSERT_OK(sim, mps_sim_time(sim, &c.t, &c.steps));
    ASSERT_OK(sim, tags_peek(sim, &ids, NULL, NULL, NULL));
    for (int f = 0; f < 3; f++) {
        mps_lease l = {.struct_size = sizeof l};
        ASSERT_OK(sim, mps_lease_begin(sim, fields[f], MPS_READ, &l));
        for (int64_t i = 0; i < l.count; i++) {
            assert_true(ids[i] < 1000);
            memcpy(c.value + at + ids[i] * l.stride, l.data + i * l.stride,
                   (size_t)l.stride * sizeof(double));
        }
        at += 1000 * l.stride;
        ASSERT_OK(sim, mps_lease_end(sim, &l));
    }
    return c;
}

static void assert_same(const picture *a, const picture *b)
{
    assert_true(a->t == b->t);
    assert_int_equal(a->steps, b->steps);
    assert_int_equal(a->n, b->n);
    assert_memory_equal(a->value, b->value, sizeof a->value);
}

/* ---- a user's model -------------------------------------------------------------------------- */

/* Nothing else acts on the drops: du = a dt, dx = u dt. */
static void acceleration(void **state)
{
    (void)state;
    mps_sim *sim = drops();
    mps_step_info info;
    const double dt = 1e-3;
    assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
    use_push(sim);
    ASSERT_OK(sim, mps_model_set(sim, "test", "acceleration", 3));
    ASSERT_OK(sim, mps_step(sim, dt, &info));
    assert_true(info.dt == dt && info.t == dt && info.step == 1);
    const picture p = take_picture(sim);
    for (int k = 0; k < 3; k++) {
        ASSERT_NEAR(p.value[2000 + 2 * k], 3 * dt, 1e-15);
        ASSERT_NEAR(p.value[2 * k], drop_places[2 * k] + 3 * dt * dt, 1e-15);
        assert_true(p.value[2000 + 2 * k + 1] == 0);
    }
    for (int v = 0; v < VERBS; v++) assert_int_equal(test.calls[v], 1);
    mps_sim_destroy(sim);
    assert_true(test.created == 1 && test.destroyed == 1);
}

/* Whatever verb fails, the step did not happen - also not in what one cannot see: the run goes on
 * as its twin does. */
static void failing_model(void **state)
{
    (void)state;
    mps_sim *twin = pool(), *sim = pool();
    char word[64];
    use_push(twin);
    use_push(sim);
    set_velocity(sim, 150, 0.3, 0.2);
    set_velocity(twin, 150, 0.3, 0.2);
    for (int v = -1; v < 2 * VERBS; v++) {
        if (v >= 0) {
            const picture before = take_picture(sim);
            test.fail = v % VERBS;
            test.silent = v / VERBS;
            snprintf(word, sizeof word, "the %s is out of order", verb_name[test.fail]);
            ASSERT_REFUSED(sim, mps_step(sim, 0.01, NULL), MPS_E_PLUGIN,
                           test.silent ? "'test.push' failed" : word);
            assert_non_null(strstr(mps_sim_error(sim), "test.push"));
            const picture after = take_picture(sim);
            assert_same(&before, &after);
            test.fail = -1;
        }
        ASSERT_OK(sim, mps_step(sim, 0.01, NULL));
        ASSERT_OK(twin, mps_step(twin, 0.01, NULL));
        const picture a = take_picture(sim), b = take_picture(twin);
        assert_same(&a, &b);
    }
    mps_sim_destroy(sim);
    mps_sim_destroy(twin);
}

static int surge(void *user, double t, mps_motion_state *state)
{
    (void)user, (void)t;
    state->rate[MPS_SURGE] = 0.5;
    state->value[MPS_SURGE] = 0.5 * t;
    return 0;
}

/* The liquid gets the tank's velocity in the first step that succeeds, not in one that fails. */
static void values_out_of_range(void **state)
{
    (void)state;
    const int32_t region[] = {-1, 6, 77};
    const double limit[] = {NAN, 0, -1};
    char word[64];
    mps_sim *sim = pool();
    use_push(sim);
    test.victim = 10;
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    const picture before = take_picture(sim);
    for (int k = 0; k < 3; k++) {
        test.region = region[k];
        snprintf(word, sizeof word, "left region %d at particle 10, (", (int)region[k]);
        ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_PLUGIN, word);
        ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_PLUGIN,
                       "model 'test.push' at t = 0.001 s");
        test.region = MPS_REGION_INNER;
        test.dt_limit = limit[k];
        snprintf(word, sizeof word, "allows a step of %g s", limit[k]);
        ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_PLUGIN, word);
        ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_PLUGIN,
                       "model 'test.push' at t = 0.001 s");
        test.dt_limit = INFINITY;
        const picture after = take_picture(sim);
        assert_same(&before, &after);
    }
    test.region = MPS_REGION_DRY; /* the last one there is */
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    mps_sim_destroy(sim);
}

static double spoilt_density;

static int spoil_density(mps_stage *s)
{
    double *nd = s->data[0];
    nd[place_of(s, 10)] = spoilt_density;
    return 0;
}

static const mps_use density_uses[] = {{"number_density", MPS_USE_CHANGE}};
static const mps_verb density_verbs[] = {
    {.moment = MPS_PREPARE, .use_count = 1, .uses = density_uses, .run = spoil_density}};
static const mps_model_ops density_model = {.struct_size = sizeof(mps_model_ops),
                                            .api = MPS_MODEL_API,
                                            .name = "test.density",
                                            .help = "spoils the number density of a particle",
                                            .verb_count = 1,
                                            .verbs = density_verbs};

static void number_density_not_finite(void **state)
{
    (void)state;
    const double value[3] = {NAN, INFINITY, -INFINITY};
    char word[64];
    mps_sim *sim = pool();
    ASSERT_OK(sim, mps_model_register(sim, &density_model));
    ASSERT_OK(sim, mps_model_use(sim, "test.density"));
    spoilt_density = 1;
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    const picture before = take_picture(sim);
    for (int k = 0; k < 3; k++) {
        spoilt_density = value[k];
        snprintf(word, sizeof word, "left the number density %g at particle 10, (", value[k]);
        ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_PLUGIN, word);
        assert_non_null(strstr(mps_sim_error(sim), "model 'test.density' at t = 0.001 s"));
        const picture after = take_picture(sim);
        assert_same(&before, &after);
    }
    spoilt_density = 1;
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    mps_sim_destroy(sim);
}

static void failing_start(void **state)
{
    (void)state;
    const double centre[3] = {0, 0, 0};
    mps_sim *sim = pool();
    use_push(sim);
    ASSERT_OK(sim, mps_motion_centre_set(sim, centre, MPS_START_WITH_TANK));
    ASSERT_OK(sim, mps_motion_callback_set(sim, surge, NULL));
    const picture before = take_picture(sim);
    test.fail = SHIFT;
    ASSERT_STATUS(sim, mps_step(sim, 1e-3, NULL), MPS_E_PLUGIN);
    const picture after = take_picture(sim);
    assert_same(&before, &after);
    test.fail = -1;
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    const picture moving = take_picture(sim);
    for (int64_t id = 0; id < moving.n; id++) ASSERT_NEAR(moving.value[2000 + 2 * id], 0.5, 0.05);
    mps_sim_destroy(sim);
}

static void diverged(void **state)
{
    (void)state;
    char particle[64];
    mps_sim *sim = pool();
    use_push(sim);
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    test.victim = 0;
    while (mps_particle_index(sim, test.victim) < 0 ||
           test.victim < mps_particles_count(sim, -1) - mps_particles_count(sim, MPS_FLUID) + 10)
        test.victim++;
    const picture before = take_picture(sim);
    for (test.spoil = 1; test.spoil <= 4; test.spoil++) {
        snprintf(particle, sizeof particle, "particle %lld at (%g, %g", (long long)test.victim,
                 before.value[2 * test.victim], before.value[2 * test.victim + 1]);
        ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_DIVERGED, particle);
        const picture after = take_picture(sim);
        assert_same(&before, &after);
    }
    test.spoil = 0;
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    mps_sim_destroy(sim);
}

/* ---- time control ---------------------------------------------------------------------------- */

static mps_time_control control(void)
{
    mps_time_control c;
    assert_int_equal(mps_time_control_init(&c, sizeof c), MPS_OK);
    return c;
}

#define REFUSE(entry, value, word)                                            \
    do {                                                                      \
        mps_time_control c_ = control();                                      \
        c_.entry = (value);                                                   \
        ASSERT_REFUSED(sim, mps_time_control_set(sim, &c_), MPS_E_ARG, word); \
    } while (0)

static void bad_time_control(void **state)
{
    (void)state;
    mps_sim *sim = pool();
    mps_time_control c = control();
    REFUSE(dt, -1e-3, "dt is -0.001");
    REFUSE(dt, NAN, "dt is");
    REFUSE(dt, INFINITY, "dt is inf");
    REFUSE(cfl, NAN, "time_control.cfl is ");
    REFUSE(gravity, NAN, "time_control.gravity is ");
    REFUSE(viscous, NAN, "time_control.viscous is ");
    REFUSE(dt_max, NAN, "time_control.dt_max is ");
    REFUSE(growth, 0, "growth is 0");
    REFUSE(growth, NAN, "growth");
    REFUSE(growth, 1, "growth is 1");
    REFUSE(dt_min, NAN, "dt_min");
    REFUSE(dt_min, -1, "dt_min is -1");
    REFUSE(struct_size, 0, "struct_size");
    c.cfl = c.gravity = c.dt_max = -1;
    ASSERT_REFUSED(sim, mps_time_control_set(sim, &c), MPS_E_ARG, "off");
    c.cfl = c.gravity = c.dt_max = 0; /* as off as -1 */
    ASSERT_REFUSED(sim, mps_time_control_set(sim, &c), MPS_E_ARG, "off");
    c.dt = 1e-3; /* a fixed step needs no limit */
    ASSERT_OK(sim, mps_time_control_set(sim, &c));
    ASSERT_REFUSED(sim, mps_time_control_set(sim, NULL), MPS_E_ARG, "NULL");
    assert_int_equal(mps_time_control_set(NULL, &c), MPS_E_ARG);
    mps_sim_destroy(sim);
}

static double step_taken(mps_sim *sim, double dt_max)
{
    mps_step_info info;
    assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
    ASSERT_OK(sim, mps_step(sim, dt_max, &info));
    return info.dt;
}

/* Each limit in turn is the smallest and gives the step. */
static void limits(void **state)
{
    (void)state;
    const double g = sqrt(9.81 * dp);
    mps_sim *sim = pool();
    use_push(sim);
    ASSERT_NEAR(step_taken(sim, 1), 0.06 * dp / g, 1e-15);
    mps_time_control c = control();
    c.dt_max = 1e-4;
    ASSERT_OK(sim, mps_time_control_set(sim, &c));
    ASSERT_NEAR(step_taken(sim, 1), 1e-4, 1e-18);
    c.dt_max = -1;
    ASSERT_OK(sim, mps_time_control_set(sim, &c)); /* forgets the previous step, */
    test.dt_limit = 2e-4;
    ASSERT_NEAR(step_taken(sim, 1), 2e-4, 1e-18);
    test.dt_limit = INFINITY;
    ASSERT_NEAR(step_taken(sim, 1), 2.2e-4, 1e-15); /* which growth is measured against */
    ASSERT_NEAR(step_taken(sim, 1e-5), 1e-5, 1e-18);
    ASSERT_NEAR(step_taken(sim, 1), 1.1 * 2.2e-4,
                1e-15); /* a step cut by the caller does not count */
    c.dt = 5e-4;
    ASSERT_OK(sim, mps_time_control_set(sim, &c));
    ASSERT_NEAR(step_taken(sim, 1), 5e-4, 1e-18);
    c.dt = 0;
    c.growth = -1;
    ASSERT_OK(sim, mps_time_control_set(sim, &c));
    mps_phase honey;
    assert_int_equal(mps_phase_init(&honey, sizeof honey), MPS_OK);
    honey.viscosity = 1000;
    ASSERT_OK(sim, mps_phase_set(sim, 0, &honey));
    ASSERT_NEAR(step_taken(sim, 1), 0.2 * dp * dp, 1e-15);
    c.dt_min = 1e-2;
    ASSERT_OK(sim, mps_time_control_set(sim, &c));
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_DIVERGED, "below dt_min = 0.01");
    mps_sim_destroy(sim);
}

/* Walls jump to their speed in the first step: it is as short as the speed asks for, and nothing is
 * lost. */
static void fast_walls(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        const bool turn = k == 2,
                   against = k ==
                             1; /* against: the liquid comes towards the walls, the speeds add up */
        const mps_harmonic shock = {.dof = turn ? MPS_YAW : MPS_SURGE,
                                    .amplitude = turn ? 1 : 1000,
                                    .omega = turn ? 200 : 0.2};
        const double speed = against ? 320
                             : turn  ? 200 * 0.6 * sqrt(2)
                                     : 200,
                     allowed = 0.3 * dp / speed;
        mps_step_info info;
        mps_sim *sim = pool();
        const picture before = take_picture(sim);
        ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &shock));
        for (int64_t id = 0; against && id < before.n; id++)
            if (mps_particle_index(sim, id) >= 0) set_velocity(sim, id, -120, 0);
        assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
        ASSERT_STATUS(sim, mps_step(sim, 1, &info), MPS_OK);
        assert_true(info.dt <= 1.03 * allowed && info.dt > 0.9 * allowed);
        for (int more = 0; more < 20; more++) ASSERT_STATUS(sim, mps_step(sim, 1, &info), MPS_OK);
        assert_int_equal(info.lost, 0);
        mps_sim_destroy(sim);
    }
}

/* A sliver that the caller asked for, by an argument or by the control, does not make the next step
 * fail. */
static void slivers(void **state)
{
    (void)state;
    const double g = sqrt(9.81 * dp);
    mps_sim *sim = pool();
    ASSERT_NEAR(step_taken(sim, 1e-12), 1e-12, 1e-27);
    ASSERT_NEAR(step_taken(sim, 1), 0.06 * dp / g, 1e-15);
    mps_sim_destroy(sim);
    sim = pool();
    mps_time_control c = control();
    c.dt_max = 1e-12;
    ASSERT_OK(sim, mps_time_control_set(sim, &c));
    for (int k = 0; k < 3; k++) ASSERT_NEAR(step_taken(sim, 1), 1e-12, 1e-27);
    c.dt_max = 0;
    ASSERT_OK(sim, mps_time_control_set(sim, &c));
    ASSERT_NEAR(step_taken(sim, 1), 0.06 * dp / g, 1e-15);
    mps_sim_destroy(sim);
}

static void bad_steps(void **state)
{
    (void)state;
    mps_sim *sim = pool();
    const picture before = take_picture(sim);
    const double bad[] = {0, -1, NAN, INFINITY};
    mps_step_info info = {.struct_size = 0};
    for (int k = 0; k < 4; k++)
        ASSERT_REFUSED(sim, mps_step(sim, bad[k], NULL), MPS_E_ARG, "dt_max is");
    ASSERT_REFUSED(sim, mps_step(sim, 1e-3, &info), MPS_E_ARG, "struct_size");
    ASSERT_REFUSED(sim, mps_run(sim, NAN, NULL, NULL), MPS_E_ARG, "t_end");
    ASSERT_REFUSED(sim, mps_run(sim, INFINITY, NULL, NULL), MPS_E_ARG, "t_end");
    ASSERT_REFUSED(sim, mps_run(sim, -1, NULL, NULL), MPS_E_ARG, "t_end is -1");
    assert_int_equal(mps_step(NULL, 1e-3, NULL), MPS_E_ARG);
    assert_int_equal(mps_run(NULL, 1, NULL, NULL), MPS_E_ARG);
    const picture after = take_picture(sim);
    assert_same(&before, &after);
    ASSERT_OK(sim, mps_run(sim, 0, NULL, NULL)); /* there already */
    mps_sim_destroy(sim);
    sim = new_sim(2, dp);
    ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_STATE, "no fluid");
    add_tank(sim, 0.5, 0.5, 0);
    ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_STATE, "no fluid");
    ASSERT_REFUSED(sim, mps_run(sim, 1, NULL, NULL), MPS_E_STATE, "no fluid");
    mps_sim_destroy(sim);
}

/* A step info of a size that no version had is not written, and no step is done; a newer program's is filled up to what is known. */
static void other_step_info(void **state)
{
    (void)state;
    mps_sim *sim = pool();
    mps_step_info info;
    assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
    info.struct_size = offsetof(mps_step_info, cfl);
    info.cfl = -5;
    ASSERT_REFUSED(sim, mps_step(sim, 1e-3, &info), MPS_E_ARG, "mps_step_info.struct_size is 32");
    assert_true(info.struct_size == offsetof(mps_step_info, cfl) && info.dt == 0 && info.cfl == -5);
    struct {
        mps_step_info known;
        double later;
    } newer;
    assert_int_equal(mps_step_info_init(&newer.known, sizeof newer), MPS_OK);
    ASSERT_OK(sim, mps_step(sim, 1e-3, &newer.known));
    assert_true(newer.known.struct_size == sizeof newer && newer.known.step == 1 &&
                newer.known.dt == 1e-3 && newer.later == 0);
    mps_sim_destroy(sim);
}

/* The error of a step ends the run and is the run's. */
static void run_fails(void **state)
{
    (void)state;
    mps_sim *sim = pool();
    use_push(sim);
    test.fail = SHIFT;
    ASSERT_REFUSED(sim, mps_run(sim, 1, NULL, NULL), MPS_E_PLUGIN, "shift");
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(acceleration),
        cmocka_unit_test(failing_model),
        cmocka_unit_test(values_out_of_range),
        cmocka_unit_test(number_density_not_finite),
        cmocka_unit_test(failing_start),
        cmocka_unit_test(diverged),
        cmocka_unit_test(bad_time_control),
        cmocka_unit_test(limits),
        cmocka_unit_test(bad_steps),
        cmocka_unit_test(other_step_info),
        cmocka_unit_test(run_fails),
        cmocka_unit_test(fast_walls),
        cmocka_unit_test(slivers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

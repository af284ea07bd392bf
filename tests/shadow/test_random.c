/* SPDX-License-Identifier: BSD-3-Clause */
/* Random scenes on the host and on a device with separate memory: each public function that changes
 * a simulation, each model, solver and kind of body has the same status, text and bytes on both.
 * MPS_TEST_SCENES in the environment: number of scenes; MPS_TEST_SEED: the first of them. */
#define _POSIX_C_SOURCE 200809L
#include "scene.h"
#include <math.h>
#include <mps/body.h>
#include <mps/couple.h>
#include <mps/list.h>
#include <mps/operators.h>
#include <stdio.h>
#include <stdlib.h>

enum { SCENES_OF_CI = 16, ACTIONS_OF_SCENE = 6, NAMES = 64 };

/* ---- random numbers: both sides get a copy of the same state ---- */

typedef struct dice {
    uint64_t state;
    int64_t scene, turn; /* number of the scene, of the action */
    int32_t dim;
} dice;

static uint64_t roll(dice *d)
{
    uint64_t z = d->state += 0x9E3779B97F4A7C15U;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
}

static double between(dice *d, double lo, double hi)
{
    return lo + (hi - lo) * (double)(roll(d) >> 11) * 0x1p-53;
}

static int pick(dice *d, int count)
{
    return (int)(roll(d) % (uint64_t)count);
}

static bool chance(dice *d, double p)
{
    return between(d, 0, 1) < p;
}

/* ---- what was done at least once with success ---- */

static struct {
    int models;
    char model[NAMES][MPS__NAME_SIZE];
    bool used[NAMES];
    int action[NAMES];
    uint32_t free[4]; /* bits of degrees of freedom, by dimension */
    int separated, steps;
} seen;

/* ---- bodies and motions ---- */

static int push_body(void *user, double t, const mps_motion_state *state, double load[6])
{
    (void)user, (void)state;
    load[0] = 5 * sin(9 * t);
    load[5] = 0.3 * sin(7 * t);
    return 0;
}

static mps_status set_body(dice *d, mps_sim *sim)
{
    static const int32_t dofs[] = {MPS_MOVE_X,   MPS_MOVE_Y,   MPS_ROTATE_Z,
                                   MPS_ROTATE_X, MPS_ROTATE_Y, MPS_MOVE_Z};
    const int count = d->dim == 2 ? 3 : 6;
    mps_body b;
    assert_int_equal(mps_body_init(&b, sizeof b), MPS_OK);
    b.free = MPS_BODY_FREE(dofs[d->scene / 2 % count]);
    while (chance(d, 0.4)) b.free |= MPS_BODY_FREE(dofs[pick(d, count)]);
    b.mass = chance(d, 0.2) ? 0 : between(d, 5, 300);
    for (int k = 0; k < d->dim; k++) b.centre_of_mass[k] = between(d, -0.1, 0.3);
    for (int k = d->dim == 2 ? 2 : 0; k < 3; k++) b.inertia[4 * k] = between(d, 1, 20);
    for (int k = 0; k < 6; k++) {
        if (!(b.free >> k & 1)) continue;
        b.stiffness[7 * k] = between(d, 0, 5000);
        b.damping[7 * k] = between(d, 0, 50);
        b.equilibrium[k] = between(d, -0.01, 0.01);
    }
    b.load = chance(d, 0.5) ? push_body : NULL;
    b.gravity = chance(d, 0.3);
    const mps_status status = mps_body_set(sim, &b);
    if (status == MPS_OK) seen.free[d->dim] |= (uint32_t)b.free;
    return status;
}

static mps_status no_body(dice *d, mps_sim *sim)
{
    (void)d;
    return mps_body_set(sim, NULL);
}

static mps_status watch_load(dice *d, mps_sim *sim)
{
    return mps_load_watch(sim, pick(d, 3));
}

static int32_t any_dof(dice *d)
{
    static const int32_t plane[] = {MPS_MOVE_X, MPS_MOVE_Y, MPS_ROTATE_Z};
    return d->dim == 2 ? plane[pick(d, 3)] : pick(d, 6);
}

static mps_status set_harmonics(dice *d, mps_sim *sim)
{
    mps_harmonic h[3];
    for (int k = 0; k < 3; k++) {
        h[k] = (mps_harmonic){.dof = any_dof(d), .form = pick(d, 2), .omega = between(d, 2, 20)};
        h[k].amplitude = between(d, -1, 1) * (h[k].dof < MPS_ROTATE_X ? 0.05 : 0.1);
        h[k].ramp = chance(d, 0.3) ? between(d, 0, 1) : 0;
    }
    return mps_motion_harmonics_set(sim, 1 + pick(d, 3), h);
}

static mps_status set_table(dice *d, mps_sim *sim)
{
    const int32_t dof = any_dof(d);
    double t[8], v[8];
    for (int k = 0; k < 8; k++) {
        t[k] = 0.5 * k - 0.5;
        v[k] = between(d, -0.02, 0.02);
    }
    return mps_motion_table_set(sim, 8, t, 1, &dof, v);
}

static int swing(void *user, double t, mps_motion_state *state)
{
    (void)user;
    state->value[MPS_MOVE_X] = 0.02 * (1 - cos(8 * t));
    state->rate[MPS_MOVE_X] = 0.16 * sin(8 * t);
    state->accel[MPS_MOVE_X] = 1.28 * cos(8 * t);
    return 0;
}

static mps_status set_callback(dice *d, mps_sim *sim)
{
    (void)d;
    return mps_motion_callback_set(sim, swing, NULL);
}

static mps_status clear_motion(dice *d, mps_sim *sim)
{
    (void)d;
    return mps_motion_clear(sim);
}

static mps_status set_pose(dice *d, mps_sim *sim)
{
    mps_motion_state s;
    double t;
    assert_int_equal(mps_motion_state_init(&s, sizeof s), MPS_OK);
    assert_int_equal(mps_sim_time(sim, &t, NULL), MPS_OK);
    assert_int_equal(mps_motion_state_get(sim, &s), MPS_OK);
    s.value[any_dof(d)] += between(d, -0.002, 0.002);
    return mps_motion_pose_set(sim, t + 0.02, &s);
}

static mps_status set_centre(dice *d, mps_sim *sim)
{
    const double at[3] = {between(d, 0, 0.5), between(d, 0, 0.5), 0.1};
    return mps_motion_centre_set(sim, at, chance(d, 0.5) ? MPS_START_WITH_TANK : MPS_START_AT_REST);
}

/* ---- numerics ---- */

static mps_status set_time(dice *d, mps_sim *sim)
{
    mps_time_control c;
    assert_int_equal(mps_time_control_init(&c, sizeof c), MPS_OK);
    if (chance(d, 0.2)) c.dt = between(d, 5e-4, 2e-3);
    c.cfl = between(d, 0.1, 0.4);
    c.growth = chance(d, 0.3) ? -1 : between(d, 1.01, 1.5);
    c.dt_max = chance(d, 0.5) ? between(d, 1e-3, 1e-2) : 0;
    return mps_time_control_set(sim, &c);
}

static mps_status use_solver(dice *d, mps_sim *sim)
{
    static const char *const name[][2] = {
        {"sundials.pcg", "auxgrid"},      {"sundials.pcg", "jacobi"},   {"sundials.pcg", "none"},
        {"sundials.pcg", "ic0"},          {"sundials.gmres", "none"},   {"sundials.kinsol", NULL},
        {"sundials.bicgstab", "auxgrid"}, {"sundials.gmres", "jacobi"}, {"sundials.klu", NULL}};
    const int k = chance(d, 0.6) ? pick(d, 3) : pick(d, 9);
    return mps_solver_use(sim, name[k][0], name[k][1]);
}

static mps_status set_limits(dice *d, mps_sim *sim)
{
    mps_solver_limits l;
    assert_int_equal(mps_solver_limits_init(&l, sizeof l), MPS_OK);
    l.max_iterations = chance(d, 0.1) ? 3 : 500;
    l.tolerance = mps_pow(10, between(d, -9, -3));
    return mps_solver_limits_set(sim, &l);
}

static mps_status set_kernel(dice *d, mps_sim *sim)
{
    static const char *const name[] = {"improved", "original"};
    mps_kernel k = {.struct_size = sizeof k};
    assert_int_equal(mps_kernel_find(name[pick(d, 2)], &k), MPS_OK);
    return mps_kernel_use(sim, &k);
}

/* For the host only: threads of the other one would wait in memory that the shadow protects. */
static mps_status set_threads(dice *d, mps_sim *sim)
{
    const bool host = !sim->world.runner.memory.device.ops.name;
    return host ? mps_threads_set(sim, 1 + pick(d, 2)) : MPS_OK;
}

/* Without a device for some steps, and with it again. */
static mps_status change_device(dice *d, mps_sim *sim)
{
    const mps_device_ops *ops = &sim->world.runner.memory.device.ops, kept = *ops;
    (void)d;
    if (!ops->name) return MPS_OK; /* the host */
    ASSERT_OK(sim, mps_sim_device_set(sim, NULL));
    ASSERT_OK(sim, mps_load_watch(sim, sim->world.load.watch));
    return mps_sim_device_set(sim, &kept);
}

/* ---- phases and models ---- */

static mps_status set_phase(dice *d, mps_sim *sim)
{
    mps_phase p;
    const int32_t k = pick(d, 2);
    assert_int_equal(mps_phase_init(&p, sizeof p), MPS_OK);
    p.density = k ? between(d, 0.5, 20) : between(d, 500, 2000);
    p.viscosity = between(d, 0, 1e-2);
    return mps_phase_set(sim, k, &p);
}

static mps_status set_tension(dice *d, mps_sim *sim)
{
    return mps_tension_set(sim, 0, 1, between(d, 0, 0.2));
}

static mps_status use_preset(dice *d, mps_sim *sim)
{
    static const char *const name[] = {"imps", "mmps", "imps.paper", "mmps.paper"};
    return mps_preset_use(sim, name[chance(d, 0.7) ? pick(d, 2) : pick(d, 4)]);
}

static const char *any_model(dice *d)
{
    return seen.model[pick(d, seen.models)];
}

static mps_status switch_model(dice *d, mps_sim *sim)
{
    const char *name = seen.model[d->turn % seen.models];
    if (strcmp(name, "gas.isentropic") == 0)
        ASSERT_OK(sim, mps_solver_use(sim, "sundials.kinsol", NULL));
    return mps_model_use(sim, name);
}

static mps_status remove_model(dice *d, mps_sim *sim)
{
    char slot[MPS__NAME_SIZE];
    snprintf(slot, sizeof slot, "%s", any_model(d));
    if (strchr(slot, '.')) *strchr(slot, '.') = 0;
    return chance(d, 0.5) ? mps_model_remove(sim, slot) : MPS_OK;
}

static mps_status set_model(dice *d, mps_sim *sim)
{
    mps_setting_info s;
    mps_model_info m;
    assert_int_equal(mps_setting_info_init(&s, sizeof s), MPS_OK);
    assert_int_equal(mps_model_info_init(&m, sizeof m), MPS_OK);
    const int first = pick(d, seen.models);
    for (int k = 0; k < seen.models; k++) {
        assert_int_equal(mps_model_info_get(sim, (first + k) % seen.models, &m), MPS_OK);
        if (m.active && m.settings > 0) break;
    }
    if (mps_setting_info_get(sim, m.name, pick(d, m.settings > 0 ? m.settings : 1), &s)) return 0;
    double value = s.initial * between(d, 0.7, 1.4);
    if (s.type == MPS_TYPE_INTEGER) value = s.initial > 0 ? 0 : 1;
    value = fmin(s.max, fmax(s.min, value));
    return mps_model_set(sim, m.name, s.key, value);
}

/* ---- particles ---- */

static mps_status add_probe(dice *d, mps_sim *sim)
{
    static const int32_t type[] = {MPS_PROBE_WALL_PRESSURE, MPS_PROBE_FORCE, MPS_PROBE_GAUGE,
                                   MPS_PROBE_FLUID_PRESSURE};
    mps_probe p;
    int32_t id;
    assert_int_equal(mps_probe_init(&p, sizeof p), MPS_OK);
    p.type = type[pick(d, 4)];
    p.at[0] = p.type == MPS_PROBE_WALL_PRESSURE ? 0 : between(d, 0.1, 0.4);
    p.at[1] = p.type == MPS_PROBE_GAUGE ? 0 : between(d, 0.05, 0.2);
    p.at[2] = d->dim == 3 ? 0.2 : 0;
    p.average = p.type == MPS_PROBE_GAUGE ? 0 : between(d, 0, 0.02);
    p.rate = chance(d, 0.5) ? 300 : 0;
    return mps_probe_add(sim, &p, &id);
}

static mps_status remove_probe(dice *d, mps_sim *sim)
{
    const mps_status status = add_probe(d, sim);
    for (int32_t id = 3; status == MPS_OK && id >= 0; id--)
        if (mps_probe_size(sim, id) > 0) return mps_probe_remove(sim, id);
    return status;
}

static mps_status add_particle(dice *d, mps_sim *sim)
{
    double x[3], u[3];
    mps_particle_block b;
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    for (int k = 0; k < 3; k++) {
        x[k] = between(d, 0.1, 0.35);
        u[k] = between(d, -1, 1);
    }
    x[1] = between(d, 0.35, 0.45);
    b.count = 1;
    b.position = x;
    b.velocity = u;
    return mps_particles_add(sim, &b, NULL);
}

static mps_status remove_particle(dice *d, mps_sim *sim)
{
    const int64_t *ids, n = mps_particles_count(sim, -1), at = (int64_t)(roll(d) % (uint64_t)n);
    const int32_t *kinds;
    ASSERT_OK(sim, tags_peek(sim, &ids, &kinds, NULL, NULL));
    if (kinds[at] != MPS_FLUID) return MPS_OK;
    return mps_particles_remove(sim, 1, &(int64_t){ids[at]});
}

static mps_status write_velocity(dice *d, mps_sim *sim)
{
    mps_lease u = {.struct_size = sizeof u};
    const mps_status status = mps_lease_begin(sim, "velocity", MPS_WRITE, &u);
    if (status < 0) return status;
    u.data[(int64_t)(roll(d) % (uint64_t)(u.count * u.stride))] += between(d, -0.1, 0.1);
    return mps_lease_end(sim, &u);
}

static mps_status add_field(dice *d, mps_sim *sim)
{
    char name[16];
    snprintf(name, sizeof name, "mine%d", pick(d, 3));
    return mps_field_add(sim, name, 1 + pick(d, 3));
}

static mps_status go_back(dice *d, mps_sim *sim)
{
    mps_snapshot *k = NULL;
    mps_status status = mps_snapshot_create(sim, &k);
    if (status == MPS_OK) status = mps_snapshot_take(k);
    for (int n = pick(d, 3); status == MPS_OK && n > 0; n--) mps_step(sim, 0.01, NULL);
    if (status == MPS_OK) status = mps_snapshot_restore(k);
    mps_snapshot_destroy(k);
    return status;
}

static mps_status read_again(dice *d, mps_sim *sim)
{
    char path[PATH];
    (void)d;
    const mps_status status = mps_checkpoint_write(sim, path_of(path, "random"));
    return status < 0 ? status : mps_checkpoint_read(sim, path);
}

static mps_status read_stencil(dice *d, mps_sim *sim)
{
    mps_stencil near;
    assert_int_equal(mps_stencil_init(&near, sizeof near), MPS_OK);
    return mps_stencil_get(sim, chance(d, 0.5) ? MPS_NEAR : MPS_FAR, &near);
}

typedef struct action {
    const char *name;
    mps_status (*act)(dice *d, mps_sim *sim);
} action;

static const action actions[] = {
    {"mps_body_set", set_body},
    {"mps_load_watch", watch_load},
    {"mps_model_use", switch_model},
    {"mps_solver_use", use_solver},
    {"mps_motion_harmonics_set", set_harmonics},
    {"mps_motion_table_set", set_table},
    {"mps_motion_callback_set", set_callback},
    {"mps_motion_clear", clear_motion},
    {"mps_motion_pose_set", set_pose},
    {"mps_motion_centre_set", set_centre},
    {"mps_body_set(NULL)", no_body},
    {"mps_time_control_set", set_time},
    {"mps_solver_limits_set", set_limits},
    {"mps_kernel_use", set_kernel},
    {"mps_threads_set", set_threads},
    {"mps_sim_device_set", change_device},
    {"mps_phase_set", set_phase},
    {"mps_tension_set", set_tension},
    {"mps_preset_use", use_preset},
    {"mps_model_remove", remove_model},
    {"mps_model_set", set_model},
    {"mps_probe_add", add_probe},
    {"mps_probe_remove", remove_probe},
    {"mps_particles_add", add_particle},
    {"mps_particles_remove", remove_particle},
    {"mps_lease_begin", write_velocity},
    {"mps_field_add", add_field},
    {"mps_snapshot_restore", go_back},
    {"mps_checkpoint_read", read_again},
    {"mps_stencil_get", read_stencil},
};
enum {
    ACTIONS = sizeof actions / sizeof actions[0],
    MODEL_USE = 2,
    CENTRE_SET = 9,
    KERNEL_USE = 13
};

/* ---- scenes ---- */

static mps_sim *build(dice d, bool closed)
{
    static const char *const preset[] = {"imps", "mmps"};
    const double dp = d.dim == 2 ? between(&d, 0.035, 0.05) : 0.1;
    const double lo[3] = {0, 0, 0}, hi[3] = {0.5, 0.5, 0.4};
    const double foot[2] = {0.25, 0}, edge[2] = {0.1, 0.3};
    const int which = pick(&d, 2);
    mps_sim *sim = new_sim(d.dim, dp);
    if (closed) shadow_heap(sim);
    ASSERT_OK(sim, mps_preset_use(sim, preset[which]));
    add_tank(sim, 0.5, 0.5, 0.4);
    if (d.dim == 2 && chance(&d, 0.3))
        ASSERT_OK(sim, mps_plate_add(sim, "plate", foot, edge, NULL));
    fill_depth(sim, chance(&d, 0.3) ? 0.3 : 0.5, between(&d, 0.15, 0.35), 0.4);
    if (which == 1) fill_air(sim, lo, hi);
    ASSERT_OK(sim, mps_field_add(sim, "mark", 2));
    return sim;
}

/* ---- comparison ---- */

#define SAME_STRUCT(type, call_host, call_sim)                                                  \
    do {                                                                                        \
        type a_, b_;                                                                            \
        memset(&a_, 0, sizeof a_);                                                              \
        memset(&b_, 0, sizeof b_);                                                              \
        type##_init(&a_, sizeof a_);                                                            \
        type##_init(&b_, sizeof b_);                                                            \
        assert_int_equal(call_host, call_sim);                                                  \
        if (memcmp(&a_, &b_, sizeof a_) != 0)                                                   \
            fail_msg("scene %lld: " #type " differs, step %d", (long long)running, seen.steps); \
    } while (0)

static int64_t running;

static void same_reports(mps_sim *host, mps_sim *sim)
{
    SAME_STRUCT(mps_body_report, mps_body_get(host, &a_), mps_body_get(sim, &b_));
    SAME_STRUCT(mps_load, mps_load_get(host, NULL, &a_), mps_load_get(sim, NULL, &b_));
}

static void same_status(const char *what, mps_sim *side[2], const mps_status status[2])
{
    if (status[0] != status[1] ||
        (status[0] < 0 && strcmp(mps_sim_error(side[0]), mps_sim_error(side[1]))))
        fail_msg("scene %lld, %s: %d '%s' on the host, %d '%s' on the device", (long long)running,
                 what, status[0], mps_sim_error(side[0]), status[1], mps_sim_error(side[1]));
}

static bool step_both(mps_sim *side[2])
{
    mps_status status[2];
    mps_step_info info[2];
    for (int k = 0; k < 2; k++) {
        assert_int_equal(mps_step_info_init(&info[k], sizeof info[k]), MPS_OK);
        status[k] = mps_step(side[k], 0.01, &info[k]);
    }
    same_status("mps_step", side, status);
    if (status[0] < 0) return false;
    seen.separated += info[0].separated > 0;
    seen.steps++;
    same_reports(side[0], side[1]);
    return true;
}

static void act_both(const dice *d, mps_sim *side[2], int which)
{
    mps_status status[2];
    for (int k = 0; k < 2; k++) {
        dice copy = *d;
        status[k] = actions[which].act(&copy, side[k]);
    }
    if (getenv("MPS_TEST_SEED"))
        fprintf(stderr, "scene %lld: %s: %d %s\n", (long long)running, actions[which].name,
                status[0], status[0] < 0 ? mps_sim_error(side[0]) : "");
    same_status(actions[which].name, side, status);
    seen.action[which] += status[0] >= 0;
    for (int32_t k = 0; mps_model_name(side[0], k); k++)
        for (int m = 0; m < seen.models; m++)
            seen.used[m] = seen.used[m] || strcmp(seen.model[m], mps_model_name(side[0], k)) == 0;
}

static void play(int64_t number)
{
    dice d = {
        .state = (uint64_t)number * 7919 + 1, .scene = number, .dim = number % 4 == 3 ? 3 : 2};
    mps_sim *side[2] = {build(d, false), build(d, true)};
    shadow s;
    running = number;
    shadow_attach(&s, side[1]);
    for (int k = 0; k < 2; k++) /* before the first step only */
        if (number % 3 == k) act_both(&d, side, k ? KERNEL_USE : CENTRE_SET);
    for (int k = 0; k < ACTIONS_OF_SCENE; k++) {
        /* a rigid body or a load, two models, and three of all in turn */
        const int which = k == 0  ? (int)(number / 4 % 2)
                          : k < 3 ? MODEL_USE
                                  : (int)((number * 3 + k) % ACTIONS);
        d.turn = 2 * number + k;
        roll(&d);
        act_both(&d, side, which);
        step_both(side);
        if (k == 0 || k == ACTIONS_OF_SCENE - 1) step_both(side);
    }
    same(side[0], side[1]);
    same_memory(side[0], side[1]);
    for (int k = 0; k < 2; k++) mps_sim_destroy(side[k]);
    assert_int_equal(s.blocks, 0);
}

static void list_models(void)
{
    mps_model_info m;
    mps_sim *sim = new_sim(2, 0.05);
    memset(&seen, 0, sizeof seen);
    assert_int_equal(mps_model_info_init(&m, sizeof m), MPS_OK);
    for (; mps_model_info_get(sim, seen.models, &m) == MPS_OK; seen.models++) {
        assert_true(seen.models < NAMES);
        snprintf(seen.model[seen.models], MPS__NAME_SIZE, "%s", m.name);
    }
    mps_sim_destroy(sim);
}

static int64_t number_of(const char *name, int64_t otherwise)
{
    const char *text = getenv(name);
    return text ? strtoll(text, NULL, 10) : otherwise;
}

static void random_scenes(void **state)
{
    const int64_t first = number_of("MPS_TEST_SEED", 0),
                  count = number_of("MPS_TEST_SCENES", SCENES_OF_CI);
    (void)state;
    list_models();
    for (int64_t k = 0; k < count; k++) play(first + k);
    printf("%d models, %d steps, %d with walls that separate\n", seen.models, seen.steps,
           seen.separated);
    if (count < SCENES_OF_CI) return;
    for (int k = 0; k < seen.models; k++)
        if (!seen.used[k]) fail_msg("no scene used the model '%s'", seen.model[k]);
    for (int k = 0; k < ACTIONS; k++)
        if (!seen.action[k]) fail_msg("%s did not succeed once", actions[k].name);
    assert_int_equal(seen.free[2], 1 << MPS_MOVE_X | 1 << MPS_MOVE_Y | 1 << MPS_ROTATE_Z);
    assert_true(seen.free[3] != 0 && (count < 100 || seen.free[3] == 63));
    assert_true(seen.separated > 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(random_scenes)};
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

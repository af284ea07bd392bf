/* SPDX-License-Identifier: BSD-3-Clause */
/* Steps on a device with separate memory give the bytes of the host: no code reads undeclared
 * arrays, and each part of a step reads the memory space with the current values. */
#define _POSIX_C_SOURCE 200809L
#include "checkpoint_fixture.h"
#include "model_fixture.h"
#include "scene.h"
#include <mps/couple.h>
#include <mps/reaction.h>

/* ---- what users do ---- */

static void write_marks(mps_sim *sim)
{
    mps_lease mark = {.struct_size = sizeof mark};
    ASSERT_OK(sim, mps_lease_begin(sim, "mark", MPS_WRITE, &mark));
    for (int64_t i = 0; i < mark.count * mark.stride; i++) mark.data[i] += (double)i;
    ASSERT_OK(sim, mps_lease_end(sim, &mark));
}

/* Failures: in a hook, of the solver by a velocity that is not finite, after particles have
 * moved. */
static int fail_here(mps_stage *s)
{
    return mps_stage_fail(s, "as the test wants it");
}

static int throw_one(mps_stage *s)
{
    double *vectors = s->data[0];
    int64_t i = s->view->n - 1;
    while (s->view->kind[i] != MPS_FLUID) i--;
    vectors[i * s->view->dim] = INFINITY;
    return 0;
}

static const mps_use push_one[] = {{"acceleration", MPS_USE_CHANGE}},
                     shift_one[] = {{"displacement", MPS_USE_CHANGE}};
static const mps_verb
    failing_verbs[] = {{.hook = MPS_GRADIENT, .run = fail_here}},
    pushing_verbs[] = {{.hook = MPS_FORCE, .use_count = 1, .uses = push_one, .run = throw_one}},
    shifting_verbs[] = {{.hook = MPS_SHIFT, .use_count = 1, .uses = shift_one, .run = throw_one}};
#define FAILING(name, table) \
    {                        \
        TOY(name, 1, table)  \
    }
static const mps_model_ops fails[] = {FAILING("test.early", failing_verbs),
                                      FAILING("test.pushing", pushing_verbs),
                                      FAILING("test.shifting", shifting_verbs)};
enum { FAILURES = sizeof fails / sizeof fails[0] };

typedef struct failure {
    char text[512];
} failure;

static failure failed_step(const mps_model_ops *ops, mps_sim *sim)
{
    failure f;
    ASSERT_OK(sim, mps_model_register(sim, ops));
    ASSERT_OK(sim, mps_model_use(sim, ops->name));
    assert_true(mps_step(sim, 0.01, NULL) < 0);
    snprintf(f.text, sizeof f.text, "%s", mps_sim_error(sim));
    ASSERT_OK(sim, mps_model_remove(sim, ops->name));
    return f;
}

/* Steps with all kinds of calls between them. */
static void run(mps_sim *sim, const char *name, failure failed[FAILURES])
{
    char path[PATH];
    for (int k = 0; k < 12; k++) {
        if (k == 3) write_marks(sim);
        if (k == 5) {
            ASSERT_OK(sim, mps_checkpoint_write(sim, path_of(path, name)));
            ASSERT_OK(sim, mps_checkpoint_read(sim, path));
        }
        if (k >= 7 && k < 7 + FAILURES) failed[k - 7] = failed_step(&fails[k - 7], sim);
        if (mps_step(sim, 0.01, NULL) < 0) fail_msg("%s, step %d: %s", name, k, mps_sim_error(sim));
    }
}

/* ---- the same bytes ---- */

static void compare(mps_sim *host, mps_sim *sim)
{
    failure failed[2][FAILURES];
    shadow s;
    shadow_attach(&s, sim);
    run(host, "host", failed[0]);
    run(sim, "device", failed[1]);
    for (int k = 0; k < FAILURES; k++) assert_string_equal(failed[0][k].text, failed[1][k].text);
    same(host, sim);
    same_memory(host, sim);
    assert_true(s.blocks > 10 && s.uploads > 50 && s.downloads > 100 && s.invalidated > 100);
    mps_sim_destroy(host);
    mps_sim_destroy(sim);
    assert_int_equal(s.blocks, 0);
}

static void presets(void **state)
{
    static const char *const preset[] = {"imps", "mmps", "imps.paper", "mmps.paper"};
    (void)state;
    for (int k = 0; k < 4; k++)
        for (int32_t dim = 2; dim <= 3; dim++)
            compare(rolling(preset[k], dim), rolling(preset[k], dim));
}

/* A law of a gas, a plate that stops drops, two threads. */
static void other_scenes(void **state)
{
    (void)state;
    for (int k = 0; k < SCENES; k++) {
        mps_sim *host = scenes[k](), *sim = scenes[k]();
        shadow s;
        shadow_attach(&s, sim);
        go(host, 15);
        go(sim, 15);
        same(host, sim);
        same_memory(host, sim);
        mps_sim_destroy(host);
        mps_sim_destroy(sim);
    }
}

/* A particle that reaches a wall from behind: the previous step has logged it, once. */
static mps_sim *spilling(int32_t dim)
{
    const double dp = dim == 2 ? 0.05 : 0.1, x[3] = {-7 * dp, 0.35, 0.2}, u[3] = {40 * dp, 0, 0};
    mps_sim *sim = unwatched("imps", dim);
    mps_particle_block b;
    sim->world.setup.lost_policy = MPS_LOST_REMOVE;
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = 1;
    b.position = x;
    b.velocity = u;
    ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
    return sim;
}

static void liquid_behind_a_wall(void **state)
{
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) {
        mps_sim *host = spilling(dim), *sim = spilling(dim);
        int logged = 0;
        shadow s;
        shadow_attach(&s, sim);
        for (int k = 0; k < 30; k++) {
            logged += sim->world.next_flags.most[MPS__NEXT_SPILLED] > 0 &&
                      sim->world.state.lost == 0;
            go(host, 1);
            go(sim, 1);
            same(host, sim);
        }
        assert_int_equal(sim->world.state.lost, 1);
        assert_int_equal(logged, 1);
        mps_sim_destroy(host);
        mps_sim_destroy(sim);
    }
}

/* Two droplets in air: free bodies, which are downloaded to be counted. */
static mps_sim *drops(int32_t dim)
{
    const double dp = dim == 2 ? 0.02 : 0.04, wide = (dim == 2 ? 5 : 3) * dp;
    mps_sim *sim = new_sim(dim, dp);
    shadow_heap(sim);
    ASSERT_OK(sim, mps_preset_use(sim, "imps"));
    add_tank(sim, 0.6, 0.6, 0.4);
    fill_depth(sim, 0.6, 0.1, 0.4);
    for (int k = 0; k < 2; k++) {
        const double lo[3] = {0.1 + 0.25 * k, 0.25, 0.1}, hi[3] = {lo[0] + wide, 0.25 + wide, 0.3};
        ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    }
    ASSERT_OK(sim, mps_field_add(sim, "mark", 2));
    add_probes(sim);
    shake(sim, 0.05);
    return sim;
}

static void drops_are_free(void **state)
{
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) {
        mps_sim *host = drops(dim), *sim = drops(dim);
        int64_t sets = 0;
        shadow s;
        shadow_attach(&s, sim);
        for (int k = 0; k < 12; k++) {
            go(host, 1);
            go(sim, 1);
            assert_int_equal(host->world.runner.sets.count, sim->world.runner.sets.count);
            sets += sim->world.runner.sets.count > 1;
            same(host, sim);
        }
        same_memory(host, sim);
        assert_true(sets > 0);
        mps_sim_destroy(host);
        mps_sim_destroy(sim);
    }
}

/* A tank without a free surface: no pressure datum. */
static mps_sim *closed(int32_t dim)
{
    mps_sim *sim = new_sim(dim, dim == 2 ? 0.05 : 0.1);
    shadow_heap(sim);
    add_tank(sim, 0.6, 0.6, 0.4);
    fill_depth(sim, 0.6, 0.6, 0.4);
    shake(sim, 0.05);
    return sim;
}

static mps_sim *solved_by(int32_t dim, const char *solver, const char *preconditioner)
{
    mps_sim *sim = rolling("imps", dim);
    ASSERT_OK(sim, mps_solver_use(sim, solver, preconditioner));
    return sim;
}

static mps_sim *with_mass(const char *preset, int32_t dim)
{
    mps_sim *sim = rolling(preset, dim);
    ASSERT_OK(sim, mps_load_watch(sim, MPS_LOAD_MASS));
    return sim;
}

static void same_loads(mps_sim *host, mps_sim *sim)
{
    mps_load a = {.struct_size = sizeof a}, b = {.struct_size = sizeof b};
    ASSERT_OK(host, mps_load_get(host, NULL, &a));
    ASSERT_OK(sim, mps_load_get(sim, NULL, &b));
    assert_memory_equal(&a, &b, sizeof a);
}

/* Equations assembled on a device and solved on the host. */
static void other_solutions(void **state)
{
    (void)state;
    for (int k = 0; k < 12; k++) {
        const int32_t dim = 2 + k % 2;
        mps_sim *pair[2];
        shadow s;
        for (int side = 0; side < 2; side++)
            pair[side] = k < 2   ? closed(dim)
                         : k < 4 ? solved_by(dim, "sundials.klu", NULL)
                         : k < 6 ? solved_by(dim, "sundials.gmres", "ic0")
                         : k < 8 ? solved_by(dim, "sundials.pcg", "none")
                                 : with_mass(k < 10 ? "imps" : "mmps", dim);
        shadow_attach(&s, pair[1]);
        go(pair[0], 8);
        go(pair[1], 8);
        assert_string_equal(mps_sim_error(pair[0]), mps_sim_error(pair[1]));
        same(pair[0], pair[1]);
        if (k >= 8) same_loads(pair[0], pair[1]);
        same_memory(pair[0], pair[1]);
        mps_sim_destroy(pair[0]);
        mps_sim_destroy(pair[1]);
        assert_int_equal(s.blocks, 0);
    }
}

/* Each model of the library together with those of a preset; some fail, on the host too. */
static void all_models(void **state)
{
    mps_model_info m;
    mps_sim *list = new_sim(2, 0.1);
    (void)state;
    assert_int_equal(mps_model_info_init(&m, sizeof m), MPS_OK);
    for (int32_t k = 0; mps_model_info_get(list, k, &m) == MPS_OK; k++) {
        mps_sim *host = rolling("mmps", 2), *sim = rolling("mmps", 2);
        shadow s;
        shadow_attach(&s, sim);
        assert_int_equal(mps_model_use(host, m.name), mps_model_use(sim, m.name));
        for (int step = 0; step < 4; step++)
            assert_int_equal(mps_step(host, 0.01, NULL), mps_step(sim, 0.01, NULL));
        same(host, sim);
        same_memory(host, sim);
        mps_sim_destroy(host);
        mps_sim_destroy(sim);
    }
    mps_sim_destroy(list);
}

/* ---- plugins ---- */

static const mps_channel channels[] = {
    {"heat", "J", "a quantity of a step", 1, MPS_TYPE_REAL, MPS_LIFE_STEP, 1},
    {"age", "s", "a quantity of a particle", 1, MPS_TYPE_REAL, MPS_LIFE_PARTICLE, 0}};

/* All solids creep along in the frame of the tank, and their areas shrink. */
static int creep(mps_stage *s)
{
    double *place = s->data[0], *area = s->data[1];
    for (int64_t i = 0; i < s->view->n; i++)
        for (int d = 0; s->view->kind[i] != MPS_FLUID && d < s->view->dim; d++) {
            place[i * s->view->dim + d] += d == 0 ? 1e-4 : 0;
            area[i * s->view->dim + d] *= 0.999;
        }
    return 0;
}

static int push(mps_stage *s)
{
    double *acceleration = s->data[0], *given = mps_stage_scratch(s, s->view->n * s->view->dim);
    double *heat = s->data[1], *age = s->data[2];
    if (!given) return 1;
    for (int64_t i = 0; i < s->view->n; i++) {
        age[i] += s->view->dt * heat[i];
        if (s->view->kind[i] != MPS_FLUID) continue;
        given[i * s->view->dim] = 0.1 * mps_flux_density(&s->view->flux, i, i) / 1000 + age[i];
        acceleration[i * s->view->dim] += given[i * s->view->dim];
    }
    return mps_stage_reaction(s, NULL, given);
}

/* Slower by pressures, and where pairs are near. */
static int brake(mps_stage *s)
{
    double *u = s->data[0];
    const double *p = s->data[1];
    const mps_stencil *near = &s->view->near;
    for (int64_t i = 0; i < s->view->n; i++) {
        if (s->view->kind[i] != MPS_FLUID || near->begin[i] == near->end[i]) continue;
        const int64_t j = near->col[near->begin[i]];
        u[i * s->view->dim] *= 1 - 1e-9 * p[i] - 1e-3 * fabs(near->x[j * s->view->dim]);
    }
    return 0;
}

static const mps_use creep_uses[] = {{"solid_place", MPS_USE_CHANGE},
                                     {"solid_area", MPS_USE_CHANGE}},
                     plugin_push_uses[] = {{"acceleration", MPS_USE_CHANGE},
                                           {"heat", MPS_USE_READ},
                                           {"age", MPS_USE_CHANGE}},
                     brake_uses[] = {{"velocity", MPS_USE_CHANGE}, {"pressure", MPS_USE_READ}};
static const mps_verb plugin_verbs[] = {
    {.hook = MPS_CLASSIFY, .run = do_nothing},
    {.hook = MPS_MOTION, .use_count = 2, .uses = creep_uses, .run = creep},
    {.hook = MPS_FORCE, .use_count = 3, .uses = plugin_push_uses, .run = push},
    {.hook = MPS_VELOCITY, .use_count = 2, .uses = brake_uses, .run = brake}};
static const mps_model_ops plugin = {TOY("test.plugin", 4, plugin_verbs), .channel_count = 2,
                                     .channels = channels};

static mps_sim *with(const mps_model_ops *ops, int32_t dim)
{
    mps_sim *sim = rolling("imps", dim);
    ASSERT_OK(sim, mps_model_register(sim, ops));
    ASSERT_OK(sim, mps_model_use(sim, ops->name));
    return sim;
}

/* Verbs of plug-ins run on the host, between verbs of the library on the device. */
static void plugins(void **state)
{
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) compare(with(&plugin, dim), with(&plugin, dim));
}

/* ---- what the shadow is for ---- */

static const double *kept; /* velocities of an earlier verb */

static int keep_pointer(mps_stage *s)
{
    kept = s->data[0];
    return 0;
}

/* Adds divergence by velocities that it does not declare. */
static int peek(mps_stage *s)
{
    double *source = s->data[0];
    for (int64_t i = 0; i < s->view->n; i++) source[i] += 1e-6 * kept[i * s->view->dim];
    return 0;
}

static const mps_use keep_uses[] = {{"velocity", MPS_USE_READ}},
                     peek_uses[] = {{"pressure_source", MPS_USE_CHANGE}};
static const mps_verb peeping_verbs[] = {
    {.hook = MPS_CLASSIFY, .use_count = 1, .uses = keep_uses, .run = keep_pointer},
    {.hook = MPS_SOURCE, .use_count = 1, .uses = peek_uses, .run = peek}};
static const mps_model_ops peeping = {TOY("test.peeping", 2, peeping_verbs)};

static void an_undeclared_use_is_found(void **state)
{
    mps_sim *host = with(&peeping, 2), *sim = with(&peeping, 2);
    shadow s;
    (void)state;
    shadow_attach(&s, sim);
    ASSERT_OK(host, mps_step(host, 0.01, NULL));
    ASSERT_REFUSED(sim, mps_step(sim, 0.01, NULL), MPS_E_SOLVER, "NaN");
    mps_sim_destroy(host);
    mps_sim_destroy(sim);
}

/* A step without enough device memory fails and changes nothing; the next has enough. */
static void without_memory(void **state)
{
    mps_sim *host = rolling("imps", 2), *sim = rolling("imps", 2);
    shadow s;
    (void)state;
    shadow_attach(&s, sim);
    s.refuses = true;
    ASSERT_REFUSED(sim, mps_step(sim, 0.01, NULL), MPS_E_NOMEM, "shadow");
    compare(host, sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(drops_are_free),  cmocka_unit_test(presets),
        cmocka_unit_test(other_scenes),    cmocka_unit_test(liquid_behind_a_wall),
        cmocka_unit_test(other_solutions), cmocka_unit_test(all_models),
        cmocka_unit_test(plugins),         cmocka_unit_test(an_undeclared_use_is_found),
        cmocka_unit_test(without_memory),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

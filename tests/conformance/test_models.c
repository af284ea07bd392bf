/* SPDX-License-Identifier: BSD-3-Clause */
/* Tests of all built-in models with the kit of models, and of models that violate one rule each:
 * the kit reports which. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka.h needs those four before it */
#include <cmocka.h>
#include <math.h>
#include <mps/mps.h>
#include <stdbool.h>
#include <string.h>

#include "../turns.h"
#include "built_in.h"
#include "force_fixture.h"

/* The gradient of one liquid is unstable at the densities of water and air. */
static mps_status one_phase(void *user, mps_sim *sim)
{
    mps_phase air;
    (void)user;
    mps_phase_init(&air, sizeof air);
    return mps_phase_get(sim, 1, &air) == MPS_OK ? MPS_E_STATE : MPS_OK;
}

/* Numbers with which models act that wait for rare events or have no effect by default. */
static mps_status thin_tank(void *user, mps_sim *sim)
{
    (void)user;
    return mps_model_set(sim, "friction", "width", 0.01);
}

static mps_status far_collisions(void *user, mps_sim *sim)
{
    (void)user;
    return mps_model_set(sim, "collision", "distance", 1.0);
}

static mps_status much_spray(void *user, mps_sim *sim)
{
    (void)user;
    return mps_model_set(sim, "surface", "spray", 0.5);
}

static mps_status much_drag(void *user, mps_sim *sim)
{
    (void)user;
    const mps_status status = mps_model_set(sim, "drag", "company", 1);
    return status < 0 ? status : mps_model_set(sim, "drag", "times", 0);
}

static mps_status little_suction(void *user, mps_sim *sim)
{
    (void)user;
    return mps_model_set(sim, "cavitation", "least", 1);
}

/* Only the model provides a pressure datum for incompressible air; water alone has a free
 * surface. */
static mps_status no_gas(void *user, mps_sim *sim)
{
    if (one_phase(user, sim) == MPS_OK) return MPS_E_STATE;
    const mps_status status = mps_model_remove(sim, "gas");
    return status == MPS_E_NAME ? MPS_OK : status; /* it is off */
}

/* A void in the water of 2-D. */
static mps_status with_pocket(void *user, mps_sim *sim)
{
    enum { MOST = 100 };
    static const double lo = 0.09, hi = 0.23, bottom = 0.05, top = 0.13;
    mps_lease x = {.struct_size = sizeof x}, kind = x, id = x;
    int64_t gone[MOST], count = 0;
    mps_status status = one_phase(user, sim);
    if (status >= 0) status = mps_model_set(sim, "gas", "least", 2);
    if (status >= 0) status = mps_lease_begin(sim, "position", MPS_READ, &x);
    if (status >= 0) status = mps_lease_begin(sim, "kind", MPS_READ, &kind);
    if (status >= 0) status = mps_lease_begin(sim, "id", MPS_READ, &id);
    for (int64_t i = 0; status >= 0 && i < x.count && x.stride == 2; i++) {
        const double *X = x.data + 2 * i;
        const bool in = X[0] > lo && X[0] < hi && X[1] > bottom && X[1] < top;
        if (in && kind.integers[i] == MPS_FLUID && count < MOST) gone[count++] = id.ids[i];
    }
    if (status >= 0) mps_lease_end(sim, &x);
    if (status >= 0) mps_lease_end(sim, &kind);
    if (status >= 0) mps_lease_end(sim, &id);
    return status < 0 || count == 0 ? status : mps_particles_remove(sim, count, gone);
}

static kit_prepare_fn prepare_of(const mps_model_ops *ops)
{
    static const struct {
        const char *model;
        kit_prepare_fn prepare;
    } list[] = {{"gradient.conservative", one_phase},  {"friction.history", thin_tank},
                {"collision.pair", far_collisions},    {"surface.detached", much_spray},
                {"gas.pocket", with_pocket},           {"drag.lone", much_drag},
                {"cavitation.vapour", little_suction}, {"reference.lid", no_gas}};
    for (size_t k = 0; k < sizeof list / sizeof list[0]; k++)
        if (strcmp(list[k].model, ops->name) == 0) return list[k].prepare;
    return NULL;
}

static void test_built_in(void **state)
{
    int bad = 0;
    (void)state;
    for (int k = 0; mps__built_in_models[k]; k++) {
        if (!has_turn(k, 1, 3)) continue;
        const int failed = kit_check_model(mps__built_in_models[k],
                                           prepare_of(mps__built_in_models[k]), NULL);
        if (failed) print_error("%s: %d\n", mps__built_in_models[k]->name, failed);
        bad += failed != 0;
    }
    assert_int_equal(bad, 0);
}

/* ---- models that break a rule: forces that push the fluid a little --------------------------- */

static void test_good(void **state)
{
    (void)state;
    assert_int_equal(check_verb(damp), 0);
}

static int write_density(mps_stage *s)
{
    arrays(s).rho[s->view->n / 2] *= 1.0001;
    return 0;
}

static void test_writes_what_it_reads(void **state)
{
    (void)state;
    /* a checked library refuses the step before the check of the kit */
    assert_true(check_verb(write_density) & (KIT_WRITES | KIT_RUN));
}

MPS_ROW void mean_row(const int dim, const mps_view *v, const push *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    if (v->kind[i] != MPS_FLUID) return;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++)
        for (int d = 0; d < dim; d++) f->a[i * dim + d] -= 0.1 * f->u[t->col[p] * dim + d];
}
MPS_ROWS(mean_rows, mean_row, push)

static int read_neighbours(mps_stage *s)
{
    push f = arrays(s);
    mps_stage_rows(s, &mean_rows, &f);
    return 0;
}

static void test_reads_neighbours(void **state)
{
    (void)state;
    assert_int_equal(check_verb(read_neighbours), KIT_OWN_ROW);
}

/* Each row writes rows of neighbours: they depend on the order of rows and on the threads. */
static int write_neighbours(mps_stage *s)
{
    const mps_view *v = s->view;
    push f = arrays(s);
    const mps_stencil *t = &v->near;
    for (int64_t i = 0; i < v->n; i++)
        for (int64_t p = t->begin[i]; p < t->end[i]; p++)
            if (v->kind[t->col[p]] == MPS_FLUID) f.a[t->col[p] * v->dim] -= 0.1 * f.u[i * v->dim];
    return 0;
}

static void test_writes_rows_of_neighbours(void **state)
{
    (void)state;
    assert_true(check_verb(write_neighbours) & KIT_OWN_ROW);
}

/* Its own channel, declared as write-only, to which it adds. */
static int add_to_own(mps_stage *s)
{
    double *own = s->data[0];
    for (int64_t i = 0; i < s->view->n; i++) own[i] += 1;
    return 0;
}

static void test_reads_what_it_writes(void **state)
{
    static const mps_use write[] = {{"mark", MPS_USE_WRITE}};
    static const mps_channel mark = {
        .name = "mark", .unit = "-", .help = "a mark", .components = 1};
    mps_verb verb;
    mps_model_ops ops = model_of(&verb, add_to_own);
    (void)state;
    verb.uses = write;
    verb.use_count = 1;
    ops.channels = &mark;
    ops.channel_count = 1;
    assert_int_equal(kit_check_model(&ops, NULL, NULL), KIT_WRITE_ONLY);
}

/* The id decides: ids follow the order in which particles were added. */
static int push_by_id(mps_stage *s)
{
    push f = arrays(s);
    for (int64_t i = 0; i < s->view->n; i++)
        if (s->view->kind[i] == MPS_FLUID) f.a[i * s->view->dim] += 0.01 * (double)s->view->id[i];
    return 0;
}

static void test_order_of_particles(void **state)
{
    (void)state;
    assert_int_equal(check_verb(push_by_id), KIT_ORDER);
}

/* The part of the rows that a thread has decides. */
static void push_first(const mps_view *v, const void *fields, int64_t begin, int64_t end)
{
    const push *f = fields;
    bool first = true;
    for (int64_t i = begin; i < end; i++)
        if (v->kind[i] == MPS_FLUID) {
            f->a[i * v->dim] += first ? 0.5 : 0;
            first = false;
        }
}

static const mps_rows push_first_rows = {sizeof(mps_rows), sizeof(push), "push_first", push_first,
                                         __FILE__};

static int push_by_thread(mps_stage *s)
{
    push f = arrays(s);
    mps_stage_rows(s, &push_first_rows, &f);
    return 0;
}

static void test_threads(void **state)
{
    (void)state;
    assert_true(check_verb(push_by_thread) & KIT_THREADS);
}

/* Depends on the number of its calls, kept in a state per handle. */
static int push_by_count(mps_stage *s)
{
    push f = arrays(s);
    int64_t *calls = s->self;
    for (int64_t i = 0; i < s->view->n; i++)
        if (s->view->kind[i] == MPS_FLUID) f.a[i * s->view->dim] += 0.1 * (double)*calls;
    ++*calls;
    return 0;
}

static int make_count(const mps_allocator *allocator, void **self)
{
    *self = allocator->alloc(allocator->user, sizeof(int64_t));
    if (*self) *(int64_t *)*self = 0;
    return *self == NULL;
}

static void drop_count(const mps_allocator *allocator, void *self)
{
    allocator->release(allocator->user, self);
}

static void test_state_outside_of_channels(void **state)
{
    mps_verb verb;
    mps_model_ops ops = model_of(&verb, push_by_count);
    (void)state;
    ops.create = make_count;
    ops.destroy = drop_count;
    assert_true(kit_check_model(&ops, NULL, NULL) & KIT_CHECKPOINT);
}

/* Must exist from the first step on. */
static int miss_steps(mps_stage *s)
{
    int64_t *calls = s->self;
    return s->step == ++*calls ? 0 : mps_stage_fail(s, "steps are missing");
}

static void test_switched_on_later(void **state)
{
    mps_verb verb;
    mps_model_ops ops = model_of(&verb, miss_steps);
    (void)state;
    ops.create = make_count;
    ops.destroy = drop_count;
    assert_true(kit_check_model(&ops, NULL, NULL) & KIT_MIDRUN);
}

/* One state for all handles. */
static int push_by_user(mps_stage *s)
{
    push f = arrays(s);
    double *user = s->self;
    *user = *user < 1 ? *user + 0.01 : 0;
    for (int64_t i = 0; i < s->view->n; i++)
        if (s->view->kind[i] == MPS_FLUID) f.a[i * s->view->dim] += *user;
    return 0;
}

static void test_state_of_all_handles(void **state)
{
    double user = 0;
    mps_verb verb;
    mps_model_ops ops = model_of(&verb, push_by_user);
    (void)state;
    ops.user = &user;
    assert_true(kit_check_model(&ops, NULL, NULL) & KIT_HANDLES);
}

/* Two blocks; the first is leaked if the second allocation fails. */
static int make_leak(const mps_allocator *allocator, void **self)
{
    void **first = allocator->alloc(allocator->user, sizeof(void *));
    if (!first) return 1;
    first[0] = allocator->alloc(allocator->user, 64);
    *self = first;
    return first[0] == NULL;
}

static void drop_leak(const mps_allocator *allocator, void *self)
{
    void **first = self;
    allocator->release(allocator->user, first[0]);
    allocator->release(allocator->user, first);
}

static void test_leak(void **state)
{
    mps_verb verb;
    mps_model_ops ops = model_of(&verb, damp);
    (void)state;
    ops.create = make_leak;
    ops.destroy = drop_leak;
    assert_int_equal(kit_check_model(&ops, NULL, NULL), KIT_MEMORY);
}

/* A setting whose largest value breaks it. */
static int push_by_setting(mps_stage *s)
{
    push f = arrays(s);
    for (int64_t i = 0; i < s->view->n; i++)
        if (s->view->kind[i] == MPS_FLUID) f.a[i * s->view->dim] += 1 / (2 - s->view->setting[0]);
    return 0;
}

static void test_setting(void **state)
{
    static const mps_setting ratio = {"ratio", "-", "A ratio", MPS_TYPE_REAL, 1, 0, 2};
    mps_verb verb;
    mps_model_ops ops = model_of(&verb, push_by_setting);
    (void)state;
    ops.settings = &ratio;
    ops.setting_count = 1;
    assert_int_equal(kit_check_model(&ops, NULL, NULL), KIT_SETTINGS);
}

static void test_table(void **state)
{
    static const mps_setting same[] = {{"ratio", "-", "A ratio", MPS_TYPE_REAL, 1, 0, 2},
                                       {"ratio", "", "A ratio", MPS_TYPE_REAL, 1, 0, 2}};
    mps_verb verb;
    mps_model_ops ops = model_of(&verb, damp);
    (void)state;
    ops.api = MPS_MODEL_API + 1;
    assert_int_equal(kit_check_model(&ops, NULL, NULL), KIT_TABLE);
    ops = model_of(&verb, damp);
    ops.settings = same;
    ops.setting_count = 2;
    assert_int_equal(kit_check_model(&ops, NULL, NULL), KIT_TABLE);
}

static int push_nan(mps_stage *s)
{
    arrays(s).a[s->view->n / 2 * s->view->dim] = NAN;
    return 0;
}

static int refuse(mps_stage *s)
{
    return mps_stage_fail(s, "no such fluid");
}

static void test_run(void **state)
{
    (void)state;
    assert_true(check_verb(push_nan) & KIT_RUN);
    assert_int_equal(check_verb(refuse), KIT_RUN);
}

int main(void)
{
    struct CMUnitTest tests[] = {
        cmocka_unit_test(test_built_in),
        cmocka_unit_test(test_good),
        cmocka_unit_test(test_writes_what_it_reads),
        cmocka_unit_test(test_reads_neighbours),
        cmocka_unit_test(test_writes_rows_of_neighbours),
        cmocka_unit_test(test_reads_what_it_writes),
        cmocka_unit_test(test_order_of_particles),
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_state_outside_of_channels),
        cmocka_unit_test(test_switched_on_later),
        cmocka_unit_test(test_state_of_all_handles),
        cmocka_unit_test(test_leak),
        cmocka_unit_test(test_setting),
        cmocka_unit_test(test_table),
        cmocka_unit_test(test_run),
    };
    take_turns(tests + 1, sizeof tests / sizeof tests[0] - 1, 2);
    return cmocka_run_group_tests(tests, NULL, NULL);
}

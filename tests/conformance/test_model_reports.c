/* SPDX-License-Identifier: BSD-3-Clause */
/* Output of the kit of models: a line for a model that passes, and the reason for models that have
 * no effect, overwrite what others added, move solids, do not repeat or differ on two ranks. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka.h needs those four before it */
#include <cmocka.h>
#include <math.h>
#include <mps/mps.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "../turns.h"
#include "force_fixture.h"

/* What the kit printed last, on both streams. */
static char logged[16384];

static int check_told(const mps_model_ops *ops)
{
    FILE *file = tmpfile();
    assert_non_null(file);
    fflush(NULL);
    const int out = dup(STDOUT_FILENO), err = dup(STDERR_FILENO);
    assert_true(out >= 0 && err >= 0);
    dup2(fileno(file), STDOUT_FILENO);
    dup2(fileno(file), STDERR_FILENO);
    const int failed = kit_check_model(ops, NULL, NULL);
    fflush(NULL);
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    close(out);
    close(err);
    rewind(file);
    logged[fread(logged, 1, sizeof logged - 1, file)] = '\0';
    fclose(file);
    return failed;
}

static int verb_told(int (*run)(mps_stage *))
{
    mps_verb verb;
    const mps_model_ops ops = model_of(&verb, run);
    return check_told(&ops);
}

#define TOLD(text)                                                                    \
    do {                                                                              \
        if (!strstr(logged, (text))) fail_msg("\"%s\" is not in:\n%s", text, logged); \
    } while (0)
#define NOT_TOLD(text)                                                           \
    do {                                                                         \
        if (strstr(logged, (text))) fail_msg("\"%s\" is in:\n%s", text, logged); \
    } while (0)

/* ---- models that pass ------------------------------------------------------------------------ */

static void passes(void **state)
{
    (void)state;
    assert_int_equal(verb_told(damp), 0);
    assert_string_equal(logged, "model_kit: bad.model: passed; checks: 18, verbs: 1, settings: 0, "
                                "scenes: imps 2-D, imps 3-D, mmps 2-D, imps.paper 2-D, mmps 3-D, "
                                "mmps.paper 2-D\n");
}

static int do_nothing(mps_stage *s)
{
    (void)s;
    return 0;
}

/* One verb of two has no effect: the model passes with a note. */
static void notes_a_verb_without_effect(void **state)
{
    mps_verb verbs[2];
    mps_model_ops ops = model_of(&verbs[0], damp);
    (void)state;
    verbs[1] = (mps_verb){.hook = MPS_LIMIT, .run = do_nothing};
    ops.verb_count = 2;
    assert_int_equal(check_told(&ops), 0);
    TOLD("note: verb 1, MPS_LIMIT, changes nothing in the scenes: it was not tested\n");
    TOLD("passed; checks: 18, verbs: 2");
}

static int shorten(mps_stage *s)
{
    s->dt_limit = fmin(s->dt_limit, 9e-4);
    return 0;
}

/* A limit of the time step alone is an effect. */
static void limit_is_an_effect(void **state)
{
    mps_verb verb;
    const mps_model_ops ops = model_of(&verb, shorten);
    (void)state;
    verb = (mps_verb){.hook = MPS_LIMIT, .run = shorten};
    assert_int_equal(check_told(&ops), 0);
    NOT_TOLD("note");
}

static int damp_3d(mps_stage *s)
{
    return s->view->dim == 3 ? damp(s) : 0;
}

static void effect_in_3d(void **state)
{
    (void)state;
    assert_int_equal(verb_told(damp_3d), 0);
    NOT_TOLD("note");
}

/* ---- no effect ------------------------------------------------------------------------------- */

static void without_effect(void **state)
{
    (void)state;
    assert_int_equal(verb_told(do_nothing), KIT_ACTS);
    TOLD("bad.model: it changes nothing in any scene");
    TOLD("bad.model: failed: KIT_ACTS\n");
    NOT_TOLD("passed");
}

/* ---- sums of several models ------------------------------------------------------------------ */

MPS_ROW void replace_row(const int dim, const mps_view *v, const push *f, int64_t i)
{
    if (v->kind[i] != MPS_FLUID) return;
    for (int d = 0; d < dim; d++) f->a[i * dim + d] = -2 * f->u[i * dim + d];
}
MPS_ROWS(replace_rows, replace_row, push)

static int replace(mps_stage *s)
{
    push f = arrays(s);
    mps_stage_rows(s, &replace_rows, &f);
    return 0;
}

static void overwrites(void **state)
{
    mps_verb verb;
    const mps_model_ops ops = model_of(&verb, replace);
    (void)state;
    assert_int_equal(check_told(&ops), KIT_ADDS);
    TOLD("MPS_FORCE: of ");
    TOLD(" that another model added to 'acceleration', 0 is left: add with +=, do not overwrite\n");
    TOLD("failed: KIT_ADDS\n");
    verb.after = "*"; /* it may depend on the existing contribution, but not discard it */
    assert_int_equal(check_told(&ops), KIT_ADDS);
    verb.hook = MPS_GRADIENT;
    assert_int_equal(check_told(&ops), KIT_ADDS);
    TOLD("MPS_GRADIENT: of ");
}

/* Takes away a tenth of what others added. */
MPS_ROW void brake_row(const int dim, const mps_view *v, const push *f, int64_t i)
{
    if (v->kind[i] != MPS_FLUID) return;
    for (int d = 0; d < dim; d++)
        f->a[i * dim + d] = 0.9 * f->a[i * dim + d] - 2 * f->u[i * dim + d];
}
MPS_ROWS(brake_rows, brake_row, push)

static int brake(mps_stage *s)
{
    push f = arrays(s);
    mps_stage_rows(s, &brake_rows, &f);
    return 0;
}

static void depends_on_the_sum(void **state)
{
    mps_verb verb;
    const mps_model_ops ops = model_of(&verb, brake);
    (void)state;
    assert_int_equal(check_told(&ops), KIT_ADDS);
    verb.after = "*";
    assert_int_equal(check_told(&ops), 0);
}

static int shift_to(mps_stage *s)
{
    double *dx = s->data[0];
    for (int64_t i = 0; i < s->view->n; i++)
        if (s->view->kind[i] == MPS_FLUID) dx[i * s->view->dim] = 1e-4 * s->view->dp;
    return 0;
}

static int set_source(mps_stage *s)
{
    double *source = s->data[0];
    for (int64_t i = 0; i < s->view->n; i++)
        if (s->view->kind[i] == MPS_FLUID) source[i] = 1e-3;
    return 0;
}

static void overwrites_other_sums(void **state)
{
    static const mps_use shift[] = {{"displacement", MPS_USE_CHANGE}},
                         source[] = {{"pressure_source", MPS_USE_CHANGE}};
    mps_verb verb;
    const mps_model_ops ops = model_of(&verb, shift_to);
    (void)state;
    verb = (mps_verb){.hook = MPS_SHIFT, .use_count = 1, .uses = shift, .run = shift_to};
    assert_int_equal(check_told(&ops), KIT_ADDS);
    TOLD("MPS_SHIFT: of ");
    TOLD("added to 'displacement'");
    verb = (mps_verb){.hook = MPS_SOURCE, .use_count = 1, .uses = source, .run = set_source};
    assert_true(check_told(&ops) & KIT_ADDS);
    TOLD("MPS_SOURCE: of ");
    TOLD("added to 'pressure_source'");
}

/* ---- solids ---------------------------------------------------------------------------------- */

static int push_all(mps_stage *s)
{
    push f = arrays(s);
    for (int64_t i = 0; i < s->view->n; i++) f.a[i * s->view->dim] += 0.1;
    return 0;
}

static int move_walls(mps_stage *s)
{
    double *u = s->data[0];
    for (int64_t i = 0; i < s->view->n; i++)
        if (s->view->kind[i] == MPS_WALL) u[i * s->view->dim] = 0.01;
    return 0;
}

static void moves_solids(void **state)
{
    static const mps_use velocity[] = {{"velocity", MPS_USE_CHANGE}};
    mps_verb verb;
    const mps_model_ops ops = model_of(&verb, push_all);
    (void)state;
    assert_int_equal(check_told(&ops), KIT_SOLIDS);
    TOLD("MPS_FORCE: 'acceleration' of a ");
    TOLD("is changed: solids move with the tank, a model moves rows with view->kind[i] == "
         "MPS_FLUID only\n");
    verb = (mps_verb){.hook = MPS_VELOCITY, .use_count = 1, .uses = velocity, .run = move_walls};
    assert_true(check_told(&ops) & KIT_SOLIDS);
    TOLD("MPS_VELOCITY: 'velocity' of a wall particle is changed");
}

/* ---- results that do not repeat -------------------------------------------------------------- */

static int push_by_static(mps_stage *s)
{
    static int64_t calls;
    push f = arrays(s);
    calls++;
    for (int64_t i = 0; i < s->view->n; i++)
        if (s->view->kind[i] == MPS_FLUID) f.a[i * s->view->dim] += 1e-3 * (double)(calls % 97);
    return 0;
}

/* The reason is the counter, and not what else differs by it. */
static void static_counter(void **state)
{
    (void)state;
    assert_true(verb_told(push_by_static) & KIT_REPEAT);
    TOLD("MPS_FORCE: two runs of the verb on the same values give different results: it depends on "
         "something that is neither in its stage nor in its channels, e.g. a static variable");
    TOLD("two runs one after the other give different bytes");
    NOT_TOLD("MPS_USE_");
    NOT_TOLD("threads give other bytes");
    NOT_TOLD("another order");
    NOT_TOLD("checkpoint");
}

/* The counter shows from the fifth call on, when the kit changes values between two runs. */
static int push_late(mps_stage *s)
{
    int64_t *calls = s->self;
    push f = arrays(s);
    if (++*calls < 5) return damp(s);
    for (int64_t i = 0; i < s->view->n; i++)
        if (s->view->kind[i] == MPS_FLUID) f.a[i * s->view->dim] += 0.1 * (double)*calls;
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

static void late_counter(void **state)
{
    mps_verb verb;
    mps_model_ops ops = model_of(&verb, push_late);
    (void)state;
    ops.create = make_count;
    ops.destroy = drop_count;
    assert_int_equal(check_told(&ops), KIT_REPEAT | KIT_CHECKPOINT);
    TOLD("two runs of the verb on the same values");
    NOT_TOLD("MPS_USE_");
    TOLD("failed: KIT_CHECKPOINT KIT_REPEAT\n");
}

/* ---- two ranks ------------------------------------------------------------------------------- */

/* Pushes the fluid by a number. */
typedef struct wind {
    double *a, by;
} wind;

MPS_ROW void blow_row(const int dim, const mps_view *v, const wind *f, int64_t i)
{
    if (v->kind[i] == MPS_FLUID) f->a[i * dim] += f->by;
}
MPS_ROWS(blow_rows, blow_row, wind)

/* Counts fluid in its own loop, which includes ghosts and omits particles of other ranks. */
static int push_by_loop(mps_stage *s)
{
    wind f = {.a = arrays(s).a};
    for (int64_t i = 0; i < s->view->n; i++) f.by += s->view->kind[i] == MPS_FLUID ? 1e-4 : 0;
    mps_stage_rows(s, &blow_rows, &f);
    return 0;
}

MPS_ROW void count_row(const int dim, const mps_view *v, const wind *f, int64_t i, double *sums)
{
    (void)dim;
    sums[0] += v->kind[i] == MPS_FLUID ? f->by : 0;
}
MPS_SUMS(count_rows, count_row, wind)

static int push_by_sum(mps_stage *s)
{
    wind f = {.a = arrays(s).a};
    mps_stage_sum(s, 1, &count_rows, &(wind){.by = 1e-4}, &f.by);
    mps_stage_rows(s, &blow_rows, &f);
    return 0;
}

static void sums_by_a_loop(void **state)
{
    (void)state;
    assert_int_equal(verb_told(push_by_sum), 0);
    assert_int_equal(verb_told(push_by_loop), KIT_RANKS);
    TOLD("preset imps, 2-D, step 1: two ranks give other bytes than one: channel 'position', "
         "component 0 of particle ");
    TOLD("a sum without mps_stage_sum()");
    TOLD("failed: KIT_RANKS\n");
}

/* Velocities in scratch, which rows read at their neighbours. */
typedef struct smooth {
    double *a, *copy;
    const double *u;
} smooth;

MPS_ROW void copy_row(const int dim, const mps_view *v, const smooth *f, int64_t i)
{
    (void)v;
    for (int d = 0; d < dim; d++) f->copy[i * dim + d] = f->u[i * dim + d];
}
MPS_ROWS(copy_rows, copy_row, smooth)

MPS_ROW void smooth_row(const int dim, const mps_view *v, const smooth *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    if (v->kind[i] != MPS_FLUID) return;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++)
        for (int d = 0; d < dim; d++) f->a[i * dim + d] -= 0.1 * f->copy[t->col[p] * dim + d];
}
MPS_ROWS(smooth_rows, smooth_row, smooth)

static bool refreshed;

static int smooth_scratch(mps_stage *s)
{
    const push all = arrays(s);
    smooth f = {all.a, mps_stage_scratch(s, s->view->n * s->view->dim), all.u};
    const mps_shared shared = {.values = f.copy, .components = s->view->dim, .type = MPS_TYPE_REAL};
    if (!f.copy) return 1;
    mps_stage_rows(s, &copy_rows, &f);
    if (refreshed && mps_stage_refresh(s, 1, &shared)) return 1;
    mps_stage_rows(s, &smooth_rows, &f);
    return 0;
}

static void scratch_without_refresh(void **state)
{
    (void)state;
    refreshed = true;
    assert_int_equal(verb_told(smooth_scratch), 0);
    refreshed = false;
    assert_int_equal(verb_told(smooth_scratch), KIT_RANKS);
    TOLD("scratch read at neighbours without mps_stage_refresh()");
}

/* Counts fluid within a distance that is more than the far radius. */
enum { FAR_AWAY = 6 };
MPS_ROW void crowd_row(const int dim, const mps_view *v, const wind *f, int64_t i)
{
    if (v->kind[i] != MPS_FLUID) return;
    for (int64_t j = 0; j < v->n; j++) {
        double r2 = 0;
        for (int d = 0; d < dim; d++) r2 += pow(v->x[j * dim + d] - v->x[i * dim + d], 2);
        if (v->kind[j] == MPS_FLUID && r2 < pow(FAR_AWAY * v->dp, 2)) f->a[i * dim] += 1e-3;
    }
}
MPS_ROWS(crowd_rows, crowd_row, wind)

static int push_by_crowd(mps_stage *s)
{
    wind f = {.a = arrays(s).a};
    mps_stage_rows(s, &crowd_rows, &f);
    return 0;
}

static double far_away(const double *setting, double dp)
{
    (void)setting;
    return FAR_AWAY * dp;
}

static void looks_too_far(void **state)
{
    mps_verb verb;
    mps_model_ops ops = model_of(&verb, push_by_crowd);
    (void)state;
    assert_int_equal(check_told(&ops), KIT_RANKS);
    TOLD("a look beyond the far radius without 'reach' of the table");
    ops.reach = far_away;
    assert_int_equal(check_told(&ops), 0); /* it has what it needs */
}

/* A sum on the rank that has the first particle. */
static int sum_on_one_rank(mps_stage *s)
{
    bool first = false;
    double sum = 0;
    for (int64_t i = 0; i < s->view->n; i++) first = first || s->view->id[i] == 0;
    if (first) mps_stage_sum(s, 1, &count_rows, &(wind){.by = 1e-4}, &sum);
    return damp(s);
}

static void calls_on_one_rank(void **state)
{
    (void)state;
    assert_int_equal(verb_told(sum_on_one_rank), KIT_RANKS);
    TOLD("preset imps, 2-D, on 2 ranks: ");
    TOLD("ranks make different calls: '");
}

/* ---- names of hooks ------------------------------------------------------------------------ */

static int write_density(mps_stage *s)
{
    arrays(s).rho[s->view->n / 2] *= 1.0001;
    return 0;
}

static void hook_by_name(void **state)
{
    (void)state;
    if (verb_told(write_density) & KIT_RUN) skip(); /* a checked library refuses the step */
    TOLD("MPS_FORCE: 'density' is written without MPS_USE_WRITE\n");
    NOT_TOLD("hook 3");
}

int main(void)
{
    struct CMUnitTest tests[] = {
        cmocka_unit_test(passes),
        cmocka_unit_test(notes_a_verb_without_effect),
        cmocka_unit_test(limit_is_an_effect),
        cmocka_unit_test(effect_in_3d),
        cmocka_unit_test(without_effect),
        cmocka_unit_test(overwrites),
        cmocka_unit_test(depends_on_the_sum),
        cmocka_unit_test(overwrites_other_sums),
        cmocka_unit_test(moves_solids),
        cmocka_unit_test(static_counter),
        cmocka_unit_test(late_counter),
        cmocka_unit_test(sums_by_a_loop),
        cmocka_unit_test(scratch_without_refresh),
        cmocka_unit_test(looks_too_far),
        cmocka_unit_test(calls_on_one_rank),
        cmocka_unit_test(hook_by_name),
    };
    take_turns(tests, sizeof tests / sizeof tests[0], 3);
    return cmocka_run_group_tests(tests, NULL, NULL);
}

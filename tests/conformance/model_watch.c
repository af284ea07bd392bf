/* SPDX-License-Identifier: BSD-3-Clause */
/* Observes each call of each verb of a model. The table of the model is copied under another name,
 * with verbs that run those of the model: once on modified copies of its arrays, and once on the
 * real arrays. Differences between both show what the verb reads and writes. A difference that also
 * occurs between two runs on the same values has another reason, e.g. a counter. */
#include "model_copies.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VERBS = 16, SCRATCH = 16, STEPS = 24 };

/* One for all verbs: their functions have no other way to it. */
static struct {
    const mps_model_ops *ops;
    int failed;
    int64_t calls[VERBS];
    bool scratch[VERBS];             /* borrows scratch: neighbours may read it */
    bool acted[VERBS];               /* changed something */
    double largest[VERBS][KIT_USES]; /* value that it left */
} watch;

static bool writes(const mps_use *use)
{
    return use->access & MPS_USE_WRITE;
}

static bool reads(const mps_use *use)
{
    return use->access & (MPS_USE_READ | MPS_USE_NEIGHBOURS);
}

/* ---- two runs on the same values ------------------------------------------------------------- */

static void say_repeat(const mps_stage *s)
{
    watch.failed |= kit_print(watch.ops, KIT_REPEAT,
                              "%s: two runs of the verb on the same values give different results: "
                              "it depends on something that is neither in its stage nor in its "
                              "channels, e.g. a static variable or a counter in s->self",
                              kit_hook(s->hook));
}

/* Whether a run on the previous values gives the result of the run on the real arrays. */
static bool repeats(const mps_stage *s, const mps_verb *verb, const kit_arrays *before)
{
    kit_arrays again;
    bool equal = true;
    if (kit_copy(s, verb, before, &again) && kit_run_on(s, verb, &again) == 0)
        equal = kit_same(s, verb, &again);
    kit_release(&again);
    if (!equal) say_repeat(s);
    return equal;
}

/* ---- MPS_USE_WRITE alone --------------------------------------------------------------------- */

/* Numbers that no model writes. */
static const double POISON_REAL = -12345.678;
static const int32_t POISON_INTEGER = -12345678;

static void poison(const mps_view *view, const mps_verb *verb, kit_arrays *a)
{
    for (int32_t u = 0; u < verb->use_count; u++) {
        const kit_shape *k = kit_shape_of(&verb->uses[u]);
        if (!a->of[u] || !writes(&verb->uses[u]) || reads(&verb->uses[u])) continue;
        if (k->type == MPS_TYPE_INTEGER)
            for (int64_t v = 0; v < (int64_t)(kit_bytes(k, view->n) / sizeof(int32_t)); v++)
                ((int32_t *)a->of[u])[v] = POISON_INTEGER;
        else
            for (int64_t v = 0; v < (int64_t)(kit_bytes(k, view->n) / sizeof(double)); v++)
                ((double *)a->of[u])[v] = POISON_REAL;
    }
}

static bool is_poison(const unsigned char *value, int32_t type)
{
    const void *poison = type == MPS_TYPE_INTEGER ? (const void *)&POISON_INTEGER : &POISON_REAL;
    return memcmp(value, poison, type == MPS_TYPE_INTEGER ? sizeof(int32_t) : sizeof(double)) == 0;
}

/* Rows that were written have the same values as in the real run. */
static void compare_written(const mps_stage *s, const mps_verb *verb, const kit_arrays *before,
                            const kit_arrays *a)
{
    for (int32_t u = 0; u < verb->use_count; u++) {
        const kit_shape *k = kit_shape_of(&verb->uses[u]);
        if (!a->of[u] || !writes(&verb->uses[u])) continue;
        const size_t size = k->type == MPS_TYPE_INTEGER ? sizeof(int32_t) : sizeof(double);
        const unsigned char *fake = a->of[u], *real = s->data[u];
        for (size_t b = 0; b < kit_bytes(k, s->view->n); b += size) {
            const bool kept = !reads(&verb->uses[u]) && is_poison(fake + b, k->type);
            if (kept || memcmp(fake + b, real + b, size) == 0) continue;
            if (repeats(s, verb, before))
                watch.failed |= kit_print(watch.ops, KIT_WRITE_ONLY,
                                          "%s: '%s' depends on values before a pure MPS_USE_WRITE",
                                          kit_hook(s->hook), k->name);
            return;
        }
    }
}

/* ---- MPS_USE_READ alone ---------------------------------------------------------------------- */

static bool own_only(const mps_use *use, const kit_shape *k)
{
    return k && !k->is_scalar && k->type == MPS_TYPE_REAL && use->access & MPS_USE_READ &&
           !(use->access & MPS_USE_NEIGHBOURS);
}

/* The number-th use that reads its own row only, or -1. */
static int32_t own_use(const mps_verb *verb, const kit_arrays *a, int64_t number)
{
    int32_t found[KIT_USES], count = 0;
    for (int32_t u = 0; u < verb->use_count; u++)
        if (a->of[u] && own_only(&verb->uses[u], kit_shape_of(&verb->uses[u]))) found[count++] = u;
    return count > 0 ? found[number % count] : -1;
}

/* A row that differs from call to call; mostly fluid. */
static int64_t choose_row(const mps_view *v, int64_t call)
{
    int64_t i = (call * 7919 + 101) % v->n;
    for (int64_t k = 0; k < v->n && call % 4 != 3 && v->kind[i] != MPS_FLUID; k++)
        i = (i + 1) % v->n;
    return i;
}

static void disturb(const kit_shape *k, void *array, int64_t row)
{
    double *value = (double *)array + row * (int64_t)(k->element / sizeof *value);
    for (size_t d = 0; d < k->element / sizeof *value; d++) value[d] = 1.01 * value[d] + 1e-3;
}

static double distance(const mps_view *v, int64_t i, int64_t j)
{
    double sum = 0;
    for (int d = 0; d < v->dim; d++) sum += pow(v->x[i * v->dim + d] - v->x[j * v->dim + d], 2);
    return sqrt(sum);
}

/* Rows that changed in addition to the modified row: a neighbour read it. If rows beyond its
 * neighbours changed too, the verb used a sum over all rows, which is allowed. */
static void compare_rows(const mps_stage *s, const mps_verb *verb, const kit_arrays *before,
                         const kit_arrays *a, int64_t row, const char *channel)
{
    int64_t near = -1;
    for (int32_t u = 0; u < verb->use_count; u++) {
        if (!a->of[u] || !writes(&verb->uses[u])) continue;
        if (kit_shape_of(&verb->uses[u])->is_scalar) continue;
        const size_t size = kit_shape_of(&verb->uses[u])->element;
        for (int64_t j = 0; j < s->view->n; j++) {
            const size_t at = (size_t)j * size;
            if (j == row || memcmp((char *)a->of[u] + at, (char *)s->data[u] + at, size) == 0)
                continue;
            if (distance(s->view, row, j) > s->view->far.re * 1.001) return;
            near = j;
        }
    }
    if (near >= 0 && repeats(s, verb, before))
        watch.failed |= kit_print(watch.ops, KIT_OWN_ROW,
                                  "%s: '%s' is used with MPS_USE_READ, and its value at a particle "
                                  "changes what a neighbour gets: MPS_USE_NEIGHBOURS",
                                  kit_hook(s->hook), channel);
}

/* ---- sums of several models ------------------------------------------------------------------ */

/* Whether a verb has to add to this channel, because other models add to it too. */
static bool is_sum(const mps_stage *s, const mps_use *use)
{
    static const struct {
        int32_t hook;
        const char *channel;
    } sums[] = {{MPS_FORCE, "acceleration"},    {MPS_GRADIENT, "acceleration"},
                {MPS_SHIFT, "displacement"},    {MPS_SOURCE, "pressure_source"},
                {MPS_SOURCE, "pressure_shift"}, {MPS_SOURCE, "gas_shift"}};
    for (size_t k = 0; writes(use) && k < sizeof sums / sizeof sums[0]; k++)
        if (sums[k].hook == s->hook && strcmp(sums[k].channel, use->channel) == 0) return true;
    return false;
}

static bool has_sum(const mps_stage *s, const mps_verb *verb)
{
    for (int32_t u = 0; u < verb->use_count; u++)
        if (is_sum(s, &verb->uses[u])) return true;
    return false;
}

/* Numbers of a channel per particle. */
static int64_t width(const kit_shape *k)
{
    return (int64_t)(k->element / sizeof(double));
}

/* A contribution of another model, as large as the result of the verb. */
static double share(int number, int32_t use, int64_t v)
{
    const double largest = watch.largest[number][use];
    return (largest > 0 ? largest : 1) * (0.5 + 0.125 * (double)(v % 5));
}

static void add_share(const mps_stage *s, const mps_verb *verb, int number, kit_arrays *a)
{
    for (int32_t u = 0; u < verb->use_count; u++) {
        if (!a->of[u] || !is_sum(s, &verb->uses[u])) continue;
        const int64_t count = s->view->n * width(kit_shape_of(&verb->uses[u]));
        for (int64_t v = 0; v < count; v++) ((double *)a->of[u])[v] += share(number, u, v);
    }
}

/* The verb preserves the contribution of the other model. If the verb has `after`, its result may
 * depend on it, e.g. a limit of the sum; then the contribution must not be lost. */
static void compare_sums(const mps_stage *s, const mps_verb *verb, int number,
                         const kit_arrays *before, const kit_arrays *a)
{
    for (int32_t u = 0; u < verb->use_count; u++) {
        if (!a->of[u] || !is_sum(s, &verb->uses[u])) continue;
        const int64_t count = s->view->n * width(kit_shape_of(&verb->uses[u]));
        const double *fake = a->of[u], *real = s->data[u];
        double largest = 0;
        for (int64_t v = 0; v < count; v++) largest = fmax(largest, fabs(fake[v]));
        for (int64_t v = 0; v < count; v++) {
            const double wanted = share(number, u, v), kept = fake[v] - real[v];
            if (verb->after ? kept != 0 : fabs(kept - wanted) <= 1e-6 * (largest + wanted))
                continue;
            if (repeats(s, verb, before))
                watch.failed |= kit_print(watch.ops, KIT_ADDS,
                                          "%s: of %g that another model added to '%s', %g is left: "
                                          "add with +=, do not overwrite",
                                          kit_hook(s->hook), wanted, verb->uses[u].channel, kept);
            return;
        }
    }
}

/* ---- solids ---------------------------------------------------------------------------------- */

/* Solids move with the tank: their rows of these channels are not for models. */
static void compare_solids(const mps_stage *s, const mps_verb *verb, const kit_arrays *before)
{
    static const char *const names[] = {"acceleration", "velocity", "displacement"};
    for (int32_t u = 0; u < verb->use_count; u++) {
        bool moves = false;
        for (int k = 0; k < 3; k++) moves = moves || strcmp(verb->uses[u].channel, names[k]) == 0;
        if (!moves || !before->of[u] || !writes(&verb->uses[u])) continue;
        const double *was = before->of[u], *is = s->data[u];
        for (int64_t v = 0; v < s->view->n * s->view->dim; v++) {
            const int32_t kind = s->view->kind[v / s->view->dim];
            if (kind == MPS_FLUID || memcmp(&was[v], &is[v], sizeof *is) == 0) continue;
            watch.failed |= kit_print(watch.ops, KIT_SOLIDS,
                                      "%s: '%s' of a %s is changed: solids move with the tank, a "
                                      "model moves rows with view->kind[i] == MPS_FLUID only",
                                      kit_hook(s->hook), verb->uses[u].channel,
                                      kind == MPS_WALL ? "wall particle" : "dummy");
            return;
        }
    }
}

/* ---- a call ---------------------------------------------------------------------------------- */

static void compare_read(const mps_stage *s, const mps_verb *verb, const kit_arrays *before)
{
    for (int32_t u = 0; u < verb->use_count; u++) {
        const kit_shape *k = kit_shape_of(&verb->uses[u]);
        if (!before->of[u] || writes(&verb->uses[u])) continue;
        const size_t size = kit_bytes(k, s->view->n);
        if (memcmp(before->of[u], s->data[u], size) == 0) continue;
        memcpy(s->data[u], before->of[u], size);
        watch.failed |= kit_print(watch.ops, KIT_WRITES,
                                  "%s: '%s' is written without MPS_USE_WRITE", kit_hook(s->hook),
                                  k->name);
    }
}

/* Whether the verb that ran in this call borrowed scratch: then fewer blocks are left. */
static bool borrowed(mps_stage *s)
{
    int left = 0;
    while (mps_stage_scratch_integers(s, 1)) left++;
    return left < SCRATCH;
}

/* What the first run of a call changes. */
enum { NOTHING, OWN_ROW, WRITES, SUMS };

/* Every second call tests a use of the own row, the others pure writes and sums. */
static int choose(const mps_stage *s, const mps_verb *verb, int number, int64_t call)
{
    if (call == 1) return NOTHING;
    if (call % 2 && !watch.scratch[number]) return OWN_ROW;
    return call % 4 == 2 && has_sum(s, verb) ? SUMS : WRITES;
}

/* Run the verb on copies with one change, then on the real arrays, and compare. */
static int compare(mps_stage *s, int number, int64_t call, kit_arrays *before, kit_arrays *fake)
{
    const mps_verb *verb = &watch.ops->verbs[number];
    const int64_t row = choose_row(s->view, call);
    int test = choose(s, verb, number, call);
    const int32_t use = test == OWN_ROW ? own_use(verb, fake, call / 2) : -1;
    if (test == OWN_ROW && use < 0) test = WRITES;
    if (test == OWN_ROW) disturb(kit_shape_of(&verb->uses[use]), fake->of[use], row);
    if (test == WRITES) poison(s->view, verb, fake);
    if (test == SUMS) add_share(s, verb, number, fake);
    const int other = kit_run_on(s, verb, fake), failed = verb->run(s);
    if (test == NOTHING && (other != failed || (!failed && !kit_same(s, verb, fake))))
        say_repeat(s);
    compare_read(s, verb, before);
    if (failed || watch.failed) return failed;
    compare_solids(s, verb, before);
    if (test == OWN_ROW) compare_rows(s, verb, before, fake, row, verb->uses[use].channel);
    if (test == WRITES) compare_written(s, verb, before, fake);
    if (test == SUMS) compare_sums(s, verb, number, before, fake);
    return failed;
}

/* Whether the verb changed something, and how large its sums are. */
static void remember(const mps_stage *s, int number, const kit_arrays *before)
{
    const mps_verb *verb = &watch.ops->verbs[number];
    watch.acted[number] = watch.acted[number] || !kit_same(s, verb, before);
    for (int32_t u = 0; u < verb->use_count; u++) {
        if (!before->of[u] || !is_sum(s, &verb->uses[u])) continue;
        const double *left = s->data[u];
        double *largest = &watch.largest[number][u];
        for (int64_t v = 0; v < s->view->n * width(kit_shape_of(&verb->uses[u])); v++)
            *largest = fmax(*largest, fabs(left[v]));
    }
}

/* The first call determines the workspace. */
static int observe(mps_stage *s, int number)
{
    const mps_verb *verb = &watch.ops->verbs[number];
    const int64_t call = watch.calls[number]++;
    kit_arrays before, fake = {.dt_limit = 0};
    int failed = 1;
    if (watch.failed) return verb->run(s);
    if (s->hook == MPS_POPULATE) { /* a second run would add particles again */
        watch.acted[number] = true;
        return verb->run(s);
    }
    if (kit_copy(s, verb, NULL, &before) && kit_copy(s, verb, NULL, &fake)) {
        failed = call == 0 ? verb->run(s) : compare(s, number, call, &before, &fake);
        if (call == 0 && !failed) watch.scratch[number] = borrowed(s);
        if (!failed) remember(s, number, &before);
    }
    kit_release(&before);
    kit_release(&fake);
    return failed;
}

#define OBSERVE(k)                       \
    static int observe_##k(mps_stage *s) \
    {                                    \
        return observe(s, k);            \
    }
OBSERVE(0)
OBSERVE(1)
OBSERVE(2)
OBSERVE(3)
OBSERVE(4)
OBSERVE(5)
OBSERVE(6)
OBSERVE(7)
OBSERVE(8)
OBSERVE(9)
OBSERVE(10)
OBSERVE(11)
OBSERVE(12)
OBSERVE(13)
OBSERVE(14)
OBSERVE(15)

/* ---- the scene ------------------------------------------------------------------------------- */

/* The table of the model as "slot.watched". */
static void disguise(const mps_model_ops *ops, mps_model_ops *copied, mps_verb verbs[VERBS],
                     char name[64])
{
    static int (*const run[VERBS])(mps_stage *) = {observe_0,  observe_1,  observe_2,  observe_3,
                                                   observe_4,  observe_5,  observe_6,  observe_7,
                                                   observe_8,  observe_9,  observe_10, observe_11,
                                                   observe_12, observe_13, observe_14, observe_15};
    *copied = *ops;
    snprintf(name, 64, "%.*s.watched", (int)strcspn(ops->name, "."), ops->name);
    for (int32_t v = 0; v < ops->verb_count; v++) {
        verbs[v] = ops->verbs[v];
        verbs[v].run = run[v];
        watch.calls[v] = 0;
        watch.scratch[v] = watch.acted[v] = false;
        memset(watch.largest[v], 0, sizeof watch.largest[v]);
    }
    copied->name = name;
    copied->verbs = verbs;
}

int kit_watch(const kit_case *scene, bool acted[])
{
    mps_model_ops copied;
    mps_verb verbs[VERBS];
    char name[64];
    mps_sim *sim = NULL;
    kit_case c = *scene;
    disguise(scene->ops, &copied, verbs, name);
    watch.ops = scene->ops;
    watch.failed = 0;
    c.ops = &copied;
    mps_status status = kit_open(&c, &sim);
    if (status >= 0) kit_learn_shapes(sim);
    if (status >= 0) status = kit_steps(sim, STEPS);
    if (status < 0)
        watch.failed |= kit_print(scene->ops, KIT_RUN, "preset %s, %d-D, verbs run twice: %s",
                                  c.preset, (int)c.dim, sim ? mps_sim_error(sim) : "no handle");
    mps_sim_destroy(sim);
    for (int32_t v = 0; v < scene->ops->verb_count; v++) acted[v] = acted[v] || watch.acted[v];
    return watch.failed;
}

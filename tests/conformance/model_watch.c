/* SPDX-License-Identifier: BSD-3-Clause */
/* Looks at each call of each verb of a model. The table of the model is copied under another name,
 * with verbs that run the model's own: once on copies of its arrays in which something was changed,
 * and once on the real arrays. What differs between both tells what the verb reads and writes. */
#include "model_scenes.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VERBS = 16, USES = 24, SHAPES = 128, SCRATCH = 16, STEPS = 24 };

/* A channel as its model describes it. */
typedef struct shape {
    char name[32];
    int32_t type;
    size_t element; /* bytes per particle */
} shape;

/* One for all verbs: their functions have no other way to it. */
static struct {
    const mps_model_ops *ops;
    int failed;
    int64_t calls[VERBS];
    bool scratch[VERBS]; /* borrows scratch: neighbours may read it */
    shape shapes[SHAPES];
    int32_t count;
} watch;

/* Arrays of a verb's uses. */
typedef struct arrays {
    void *of[USES];
} arrays;

static const shape *shape_of(const mps_use *use)
{
    for (int32_t k = 0; k < watch.count; k++)
        if (strcmp(watch.shapes[k].name, use->channel) == 0) return &watch.shapes[k];
    return NULL;
}

static bool writes(const mps_use *use)
{
    return use->access & MPS_USE_WRITE;
}

static bool reads(const mps_use *use)
{
    return use->access & (MPS_USE_READ | MPS_USE_NEIGHBOURS);
}

/* ---- copies ---------------------------------------------------------------------------------- */

static void release(arrays *a)
{
    for (int u = 0; u < USES; u++) free(a->of[u]);
}

static bool copy(const mps_stage *s, const mps_verb *verb, arrays *a)
{
    *a = (arrays){{NULL}};
    for (int32_t u = 0; u < verb->use_count; u++) {
        const shape *k = shape_of(&verb->uses[u]);
        if (!s->data[u] || !k) continue;
        a->of[u] = malloc((size_t)s->n * k->element + 1);
        if (!a->of[u]) return false;
        memcpy(a->of[u], s->data[u], (size_t)s->n * k->element);
    }
    return true;
}

/* Run the model's verb on other arrays; nothing of the stage changes. */
static void run_on(const mps_stage *s, const mps_verb *verb, const arrays *a)
{
    mps_stage t = *s;
    mps_equation equation = {0};
    void *data[USES];
    for (int32_t u = 0; u < verb->use_count; u++) data[u] = a->of[u] ? a->of[u] : s->data[u];
    if (s->equation) {
        equation = *s->equation;
        t.equation = &equation;
    }
    t.data = data;
    verb->run(&t);
}

/* ---- MPS_USE_WRITE alone --------------------------------------------------------------------- */

/* Numbers that no model writes. */
static const double POISON_REAL = -12345.678;
static const int32_t POISON_INTEGER = -12345678;

static void poison(const mps_stage *s, const mps_verb *verb, arrays *a)
{
    for (int32_t u = 0; u < verb->use_count; u++) {
        const shape *k = shape_of(&verb->uses[u]);
        if (!a->of[u] || !writes(&verb->uses[u]) || reads(&verb->uses[u])) continue;
        if (k->type == MPS_TYPE_INTEGER)
            for (int64_t v = 0; v < s->n * (int64_t)(k->element / sizeof(int32_t)); v++)
                ((int32_t *)a->of[u])[v] = POISON_INTEGER;
        else
            for (int64_t v = 0; v < s->n * (int64_t)(k->element / sizeof(double)); v++)
                ((double *)a->of[u])[v] = POISON_REAL;
    }
}

static bool is_poison(const unsigned char *value, int32_t type)
{
    const void *poison = type == MPS_TYPE_INTEGER ? (const void *)&POISON_INTEGER : &POISON_REAL;
    return memcmp(value, poison, type == MPS_TYPE_INTEGER ? sizeof(int32_t) : sizeof(double)) == 0;
}

/* Rows that were written have the same values as in the real run. */
static void compare_written(const mps_stage *s, const mps_verb *verb, const arrays *a)
{
    for (int32_t u = 0; u < verb->use_count; u++) {
        const shape *k = shape_of(&verb->uses[u]);
        if (!a->of[u] || !writes(&verb->uses[u])) continue;
        const size_t size = k->type == MPS_TYPE_INTEGER ? sizeof(int32_t) : sizeof(double);
        const unsigned char *fake = a->of[u], *real = s->data[u];
        for (size_t b = 0; b < (size_t)s->n * k->element; b += size) {
            const bool kept = !reads(&verb->uses[u]) && is_poison(fake + b, k->type);
            if (kept || memcmp(fake + b, real + b, size) == 0) continue;
            watch.failed |= kit_say(watch.ops, KIT_WRITE_ONLY,
                                    "moment %d: '%s' depends on values before a pure MPS_USE_WRITE",
                                    (int)s->moment, k->name);
            return;
        }
    }
}

/* ---- MPS_USE_READ alone ---------------------------------------------------------------------- */

static bool own_only(const mps_use *use, const shape *k)
{
    return k && k->type == MPS_TYPE_REAL && use->access & MPS_USE_READ &&
           !(use->access & MPS_USE_NEIGHBOURS);
}

/* The number-th use that reads its own row only, or -1. */
static int32_t own_use(const mps_verb *verb, const arrays *a, int64_t number)
{
    int32_t found[USES], count = 0;
    for (int32_t u = 0; u < verb->use_count; u++)
        if (a->of[u] && own_only(&verb->uses[u], shape_of(&verb->uses[u]))) found[count++] = u;
    return count > 0 ? found[number % count] : -1;
}

/* A row that differs from call to call; mostly fluid. */
static int64_t choose_row(const mps_stage *s, int64_t call)
{
    int64_t i = (call * 7919 + 101) % s->n;
    for (int64_t k = 0; k < s->n && call % 4 != 3 && s->kind[i] != MPS_FLUID; k++)
        i = (i + 1) % s->n;
    return i;
}

static void disturb(const shape *k, void *array, int64_t row)
{
    double *value = (double *)array + row * (int64_t)(k->element / sizeof *value);
    for (size_t d = 0; d < k->element / sizeof *value; d++) value[d] = 1.01 * value[d] + 1e-3;
}

static double distance(const mps_stage *s, int64_t i, int64_t j)
{
    double sum = 0;
    for (int d = 0; d < s->dim; d++) sum += pow(s->x[i * s->dim + d] - s->x[j * s->dim + d], 2);
    return sqrt(sum);
}

/* Other rows that changed beside the row: a neighbour read it. If rows farther away than neighbours
 * changed too, a sum over all rows went through them, which is allowed. */
static void compare_rows(const mps_stage *s, const mps_verb *verb, const arrays *a, int64_t row,
                         const char *channel)
{
    int64_t near = -1;
    for (int32_t u = 0; u < verb->use_count; u++) {
        if (!a->of[u] || !writes(&verb->uses[u])) continue;
        const size_t size = shape_of(&verb->uses[u])->element;
        for (int64_t j = 0; j < s->n; j++) {
            const size_t at = (size_t)j * size;
            if (j == row || memcmp((char *)a->of[u] + at, (char *)s->data[u] + at, size) == 0)
                continue;
            if (distance(s, row, j) > s->far->re * 1.001) return;
            near = j;
        }
    }
    if (near >= 0)
        watch.failed |= kit_say(watch.ops, KIT_OWN_ROW,
                                "moment %d: '%s' is used with MPS_USE_READ, and its value at a "
                                "particle changes what a neighbour gets: MPS_USE_NEIGHBOURS",
                                (int)s->moment, channel);
}

/* ---- a call ---------------------------------------------------------------------------------- */

static void compare_read(const mps_stage *s, const mps_verb *verb, const arrays *before)
{
    for (int32_t u = 0; u < verb->use_count; u++) {
        const shape *k = shape_of(&verb->uses[u]);
        if (!before->of[u] || writes(&verb->uses[u])) continue;
        const size_t size = (size_t)s->n * k->element;
        if (memcmp(before->of[u], s->data[u], size) == 0) continue;
        memcpy(s->data[u], before->of[u], size);
        watch.failed |= kit_say(watch.ops, KIT_WRITES,
                                "moment %d: '%s' is written without MPS_USE_WRITE", (int)s->moment,
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

/* Run the verb on copies with one change, then on the real arrays, and compare.
 * @param use  the use of the own row that is changed, or -1: pure writes */
static int compare(mps_stage *s, const mps_verb *verb, int32_t use, int64_t row, arrays *before,
                   arrays *fake)
{
    if (use >= 0)
        disturb(shape_of(&verb->uses[use]), fake->of[use], row);
    else
        poison(s, verb, fake);
    run_on(s, verb, fake);
    const int failed = verb->run(s);
    compare_read(s, verb, before);
    if (!failed && use >= 0) compare_rows(s, verb, fake, row, verb->uses[use].channel);
    if (!failed && use < 0) compare_written(s, verb, fake);
    return failed;
}

/* The first call looks for scratch. Of the others every second one tests pure writes, and the rest
 * the uses of the own row in turns. */
static int observe(mps_stage *s, int number)
{
    const mps_verb *verb = &watch.ops->verbs[number];
    const int64_t call = watch.calls[number]++;
    arrays before, fake = {{NULL}};
    int failed = 1;
    if (watch.failed) return verb->run(s);
    if (call == 0) {
        failed = verb->run(s);
        if (!failed) watch.scratch[number] = borrowed(s);
        return failed;
    }
    if (copy(s, verb, &before) && copy(s, verb, &fake)) {
        const bool row = call % 2 && !watch.scratch[number];
        const int32_t use = row ? own_use(verb, &fake, call / 2) : -1;
        failed = compare(s, verb, use, choose_row(s, call), &before, &fake);
    }
    release(&before);
    release(&fake);
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

static void learn_shapes(const mps_sim *sim)
{
    mps_channel_info info;
    mps_channel_info_init(&info, sizeof info);
    watch.count = 0;
    for (int32_t k = 0; watch.count < SHAPES && mps_channel_info_get(sim, k, &info) == MPS_OK;
         k++) {
        shape *to = &watch.shapes[watch.count++];
        const size_t number = info.type == MPS_TYPE_INTEGER ? sizeof(int32_t) : sizeof(double);
        snprintf(to->name, sizeof to->name, "%s", info.name);
        to->type = info.type;
        to->element = (size_t)info.components * number;
    }
}

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
        watch.scratch[v] = false;
    }
    copied->name = name;
    copied->verbs = verbs;
}

int kit_watch(const kit_case *scene)
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
    if (status >= 0) learn_shapes(sim);
    if (status >= 0) status = kit_steps(sim, STEPS);
    if (status < 0)
        watch.failed |= kit_say(scene->ops, KIT_RUN, "preset %s, %d-D, verbs run twice: %s",
                                c.preset, (int)c.dim, sim ? mps_sim_error(sim) : "no handle");
    mps_sim_destroy(sim);
    return watch.failed;
}

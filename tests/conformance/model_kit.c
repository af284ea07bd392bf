/* SPDX-License-Identifier: BSD-3-Clause */
/* The checks of the kit of models. Each builds its scenes and reports errors. */
#include "model_kit.h"
#include "model_scenes.h"
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <threads.h>

enum { STEPS = 6, MOST_VERBS = 16 };

/* The model under test and the scenes that accept it. */
typedef struct kit {
    const mps_model_ops *ops;
    kit_prepare_fn prepare;
    void *user;
    int failed; /* sum of KIT_... */
    int scenes; /* that accept the model */
    kit_case scene[KIT_SCENES];
    kit_state state[KIT_SCENES]; /* after its steps, with one thread */
    bool unsteady;               /* two equal runs differ: checks that compare runs would report a
                                    wrong reason */
    bool acted[MOST_VERBS];      /* the verb changes something in a scene */
} kit;

#define FAIL(k, bit, ...) ((k)->failed |= kit_print((k)->ops, (bit), __VA_ARGS__))

static const char *text_of(const mps_sim *sim)
{
    return sim ? mps_sim_error(sim) : "no handle";
}

/* Run a scene for some steps and take its state. The state is empty after a failure. */
static mps_status run_scene(const kit_case *c, int steps, kit_state *state, char text[512])
{
    mps_sim *sim = NULL;
    *state = (kit_state){0};
    mps_status status = kit_open(c, &sim);
    if (status >= 0) status = kit_steps(sim, steps);
    if (text) snprintf(text, 512, "%s", status < 0 ? text_of(sim) : "");
    if (status >= 0 && !kit_state_get(sim, state)) status = MPS_E_NOMEM;
    mps_sim_destroy(sim);
    return status;
}

/* ---- the table ------------------------------------------------------------------------------- */

static bool is_text(const char *text)
{
    return text && text[0];
}

static void check_words(kit *k)
{
    const mps_model_ops *o = k->ops;
    if (!is_text(o->help)) FAIL(k, KIT_TABLE, "the model has no help");
    for (int32_t i = 0; i < o->setting_count; i++) {
        const mps_setting *s = &o->settings[i];
        if (!is_text(s->key) || !is_text(s->unit) || !is_text(s->help))
            FAIL(k, KIT_TABLE, "setting %d has no key, unit or help", (int)i);
        if (!(isfinite(s->initial) && s->min <= s->initial && s->initial <= s->max))
            FAIL(k, KIT_TABLE, "setting %d: default %g, range %g..%g", (int)i, s->initial, s->min,
                 s->max);
        for (int32_t j = 0; j < i; j++)
            if (is_text(s->key) && is_text(o->settings[j].key) &&
                !strcmp(s->key, o->settings[j].key))
                FAIL(k, KIT_TABLE, "two settings have the key '%s'", s->key);
    }
    for (int32_t i = 0; i < o->channel_count; i++)
        if (!is_text(o->channels[i].unit) || !is_text(o->channels[i].help))
            FAIL(k, KIT_TABLE, "channel %d has no unit or help", (int)i);
}

static void check_table(kit *k)
{
    kit_case c = kit_scene(k->ops, NULL, NULL, 0);
    mps_sim *sim = NULL;
    if (k->ops->struct_size < sizeof *k->ops || k->ops->api != MPS_MODEL_API) {
        FAIL(k, KIT_TABLE, "struct_size %u, api %u", k->ops->struct_size, k->ops->api);
        return;
    }
    if (kit_open(&c, &sim) < 0) FAIL(k, KIT_TABLE, "%s", text_of(sim));
    mps_sim_destroy(sim);
    if (!k->failed) check_words(k);
}

/* ---- scenes ---------------------------------------------------------------------------------- */

/* A model may refuse a scene, e.g. without a gas; its message is the reason. */
static bool refused(mps_status status)
{
    return status == MPS_E_STATE || status == MPS_E_PLUGIN;
}

static void check_run(kit *k)
{
    char text[512] = "";
    for (int n = 0; n < KIT_SCENES; n++) {
        kit_case c = kit_scene(k->ops, k->prepare, k->user, n);
        kit_state state;
        mps_status status = run_scene(&c, STEPS, &state, text);
        if (status == MPS_E_STATE && strstr(text, "sundials.kinsol")) {
            c.nonlinear = true;
            status = run_scene(&c, STEPS, &state, text);
        }
        if (status >= 0 && !kit_state_finite(&state))
            FAIL(k, KIT_RUN, "preset %s, %d-D: a field is not finite", c.preset, (int)c.dim);
        if (status < 0 && !refused(status))
            FAIL(k, KIT_RUN, "preset %s, %d-D: %s", c.preset, (int)c.dim, text);
        if (status < 0) continue;
        k->state[k->scenes] = state;
        k->scene[k->scenes++] = c;
    }
    if (k->scenes == 0) FAIL(k, KIT_RUN, "no scene accepts the model; the last one: %s", text);
}

static void check_settings(kit *k)
{
    for (int32_t i = 0; i < 2 * k->ops->setting_count; i++) {
        const mps_setting *s = &k->ops->settings[i / 2];
        kit_case c = k->scene[0];
        kit_state state;
        char text[512];
        c.key = s->key;
        c.value = i % 2 ? s->max : s->min;
        const mps_status status = run_scene(&c, STEPS, &state, text);
        if (status < 0 && !refused(status))
            FAIL(k, KIT_SETTINGS, "%s = %g: %s", s->key, c.value, text);
        if (status >= 0 && !kit_state_finite(&state))
            FAIL(k, KIT_SETTINGS, "%s = %g: a field is not finite", s->key, c.value);
        kit_state_free(&state);
    }
}

/* ---- what results must not depend on --------------------------------------------------------- */

static void check_repeat(kit *k)
{
    kit_state first, second;
    run_scene(&k->scene[0], STEPS, &first, NULL);
    run_scene(&k->scene[0], STEPS, &second, NULL);
    k->unsteady = !kit_state_same(&first, &second);
    if (k->unsteady)
        FAIL(k, KIT_REPEAT,
             "two runs one after the other give different bytes: something is kept outside of the "
             "handle, e.g. in a static variable or in ops->user");
    kit_state_free(&first);
    kit_state_free(&second);
}

static void compare_threads(kit *k, int n, int32_t threads)
{
    kit_case c = k->scene[n];
    kit_state more;
    c.threads = threads;
    run_scene(&c, STEPS, &more, NULL);
    if (!kit_state_same(&k->state[n], &more))
        FAIL(k, KIT_THREADS, "preset %s, %d-D: %d threads give other bytes than one", c.preset,
             (int)c.dim, (int)threads);
    kit_state_free(&more);
}

static void check_threads(kit *k)
{
    for (int n = 0; n < k->scenes; n++) {
        compare_threads(k, n, 2);
        compare_threads(k, n, 4);
    }
}

/* In the first scene and in 2-D. */
static void check_ranks(kit *k)
{
    for (int n = 0; n < k->scenes && !(k->failed & KIT_RANKS); n++)
        if (n == 0 || k->scene[n].dim == 2) k->failed |= kit_compare_ranks(&k->scene[n], 4);
}

/* Largest difference of two states over the largest value of its component. `b` has the fluid, the
 * last particles, in the reverse order for each phase; positions identify the particles. */
static double apart(const kit_state *a, const kit_state *b, int32_t dim)
{
    double worst = 0;
    if (a->n != b->n || a->stride != b->stride) return INFINITY;
    for (int32_t d = 0; d < a->stride; d++) {
        double largest = 1e-9, most = 0;
        for (int64_t i = 0; i < a->n; i++)
            largest = fmax(largest, fabs(a->data[i * a->stride + d]));
        for (int64_t i = 0; i < a->n; i++) {
            const double *p = a->data + i * a->stride;
            int64_t best = 0;
            double least = INFINITY;
            for (int64_t j = 0; j < b->n; j++) {
                double r2 = 0;
                for (int32_t e = 0; e < dim; e++) r2 += pow(b->data[j * b->stride + e] - p[e], 2);
                if (r2 < least) best = j;
                least = fmin(least, r2);
            }
            most = fmax(most, fabs(p[d] - b->data[best * b->stride + d]));
        }
        worst = fmax(worst, most / largest);
    }
    return worst;
}

static void check_order(kit *k)
{
    kit_case c = k->scene[0];
    kit_state a, b;
    run_scene(&c, 3, &a, NULL);
    c.reverse = true;
    run_scene(&c, 3, &b, NULL);
    const double difference = apart(&a, &b, c.dim);
    if (!(difference < 1e-6))
        FAIL(k, KIT_ORDER, "particles added in another order: results differ by %g of the largest",
             difference);
    kit_state_free(&a);
    kit_state_free(&b);
}

typedef struct worker {
    const kit_case *scene;
    kit_state state;
    char text[512]; /* why it failed */
} worker;

static int work(void *user)
{
    worker *w = user;
    run_scene(w->scene, STEPS, &w->state, w->text);
    return 0;
}

static void check_handles(kit *k)
{
    worker w[2] = {{.scene = &k->scene[0]}, {.scene = &k->scene[0]}};
    kit_state alone;
    thrd_t thread[2];
    run_scene(&k->scene[0], STEPS, &alone, NULL);
    for (int n = 0; n < 2; n++)
        if (thrd_create(&thread[n], work, &w[n]) != thrd_success) abort();
    for (int n = 0; n < 2; n++) thrd_join(thread[n], NULL);
    for (int n = 0; n < 2; n++) {
        if (!kit_state_same(&alone, &w[n].state))
            FAIL(k, KIT_HANDLES, "two handles in two threads: handle %d has other bytes%s%s", n,
                 w[n].text[0] ? ": " : "", w[n].text);
        kit_state_free(&w[n].state);
    }
    kit_state_free(&alone);
}

/* ---- memory ---------------------------------------------------------------------------------- */

/* Before each block: the blocks that are out form a ring. */
typedef union kit_link {
    struct {
        union kit_link *next, *before;
    } ring;
    max_align_t align;
} kit_link;

typedef struct memory {
    int64_t live, count, fail_at;
    kit_link out; /* of the ring */
} memory;

static void *take(void *user, size_t size)
{
    memory *m = user;
    kit_link *block = ++m->count == m->fail_at ? NULL : malloc(sizeof *block + size);
    if (!block) return NULL;
    m->live++;
    block->ring.next = m->out.ring.next;
    block->ring.before = &m->out;
    block->ring.next->ring.before = m->out.ring.next = block;
    return block + 1;
}

static void release(void *user, void *given)
{
    kit_link *block = (kit_link *)given - 1;
    ((memory *)user)->live--;
    block->ring.next->ring.before = block->ring.before;
    block->ring.before->ring.next = block->ring.next;
    free(block);
}

/* Repeat an action until it succeeds; the k-th allocation fails in repetition k. */
static void starve(kit *k, memory *m, const kit_case *c, mps_sim *sim, bool step)
{
    mps_status status = MPS_E_NOMEM;
    for (int64_t fail = 1; status == MPS_E_NOMEM && fail < 1000; fail++) {
        m->fail_at = m->count + fail;
        status = step ? kit_steps(sim, 1) : kit_switch_on(c, sim);
    }
    m->fail_at = 0;
    if (status < 0)
        FAIL(k, KIT_MEMORY, "an allocation fails in %s: %s: %s",
             step ? "a step" : "mps_model_use()", mps_status_name(status), text_of(sim));
}

static void check_memory(kit *k)
{
    memory m = {0};
    m.out.ring.next = m.out.ring.before = &m.out;
    const mps_allocator allocator = {take, release, &m};
    kit_case c = k->scene[0];
    mps_sim *sim = NULL;
    c.allocator = &allocator;
    c.without = true;
    if (kit_open(&c, &sim) >= 0) {
        starve(k, &m, &c, sim, false);
        starve(k, &m, &c, sim, true);
    }
    mps_sim_destroy(sim);
    if (m.live != 0) FAIL(k, KIT_MEMORY, "%lld blocks leaked", (long long)m.live);
    while (m.live > 0) release(&m, m.out.ring.next + 1);
}

/* ---- in the middle of a run ------------------------------------------------------------------ */

static void check_checkpoint(kit *k)
{
    const kit_case *c = &k->scene[0];
    mps_sim *whole = NULL, *rest = NULL;
    kit_state a = {0}, b = {0};
    char path[64];
    mps_status status = kit_open(c, &whole);
    snprintf(path, sizeof path, "model_kit_%p.mps", (void *)whole);
    if (status >= 0) status = kit_steps(whole, STEPS);
    if (status >= 0) status = mps_checkpoint_write(whole, path);
    if (status >= 0) status = kit_steps(whole, STEPS);
    if (status >= 0) status = kit_open(c, &rest);
    if (status >= 0) status = mps_checkpoint_read(rest, path);
    if (status >= 0) status = kit_steps(rest, STEPS);
    if (status < 0)
        FAIL(k, KIT_CHECKPOINT, "checkpoint: %s: %s%s", mps_status_name(status), text_of(whole),
             rest ? mps_sim_error(rest) : "");
    else if (!kit_state_get(whole, &a) || !kit_state_get(rest, &b) || !kit_state_same(&a, &b))
        FAIL(k, KIT_CHECKPOINT,
             "a run that continues from a checkpoint has other bytes: what the next "
             "steps need must be in channels of MPS_LIFE_PARTICLE");
    kit_state_free(&a);
    kit_state_free(&b);
    mps_sim_destroy(whole);
    mps_sim_destroy(rest);
    remove(path);
}

/* Name of the active model in the slot of the model under test, or NULL. */
static const char *rival(const kit *k, const mps_sim *sim)
{
    const size_t slot = strcspn(k->ops->name, ".") + 1;
    const char *name = NULL;
    for (int32_t n = 0; (name = mps_model_name(sim, n)); n++)
        if (strncmp(name, k->ops->name, slot) == 0) return name;
    return NULL;
}

/* Switch the model off, or back to the one before. A preset may need a model in its slot. */
static mps_status switch_off(const kit *k, mps_sim *sim, const char *before)
{
    mps_status status = before[0] ? mps_model_use(sim, before)
                                  : mps_model_remove(sim, k->ops->name);
    if (status >= 0) status = kit_steps(sim, 3);
    return refused(status) ? MPS_OK : status;
}

static void check_midrun(kit *k)
{
    kit_case c = k->scene[0];
    mps_sim *sim = NULL;
    char before[64] = "";
    c.without = true;
    mps_status status = kit_open(&c, &sim);
    if (sim && rival(k, sim)) snprintf(before, sizeof before, "%s", rival(k, sim));
    if (status >= 0) status = kit_steps(sim, 3);
    if (refused(status)) status = MPS_OK;
    for (int turn = 0; turn < 2 && status >= 0; turn++) {
        status = kit_switch_on(&c, sim);
        if (status >= 0) status = kit_steps(sim, 3);
        if (status >= 0) status = switch_off(k, sim, before);
    }
    if (status < 0)
        FAIL(k, KIT_MIDRUN, "on and off between steps: %s: %s", mps_status_name(status),
             text_of(sim));
    mps_sim_destroy(sim);
}

static void check_budget(kit *k)
{
    mps_sim *sim = NULL;
    mps_momentum m, first;
    mps_energy e;
    mps_momentum_init(&m, sizeof m);
    mps_momentum_init(&first, sizeof first);
    mps_energy_init(&e, sizeof e);
    mps_status status = kit_open(&k->scene[0], &sim);
    if (status >= 0) status = mps_momentum_get(sim, &first);
    if (status >= 0) status = kit_steps(sim, STEPS);
    if (status >= 0) status = mps_momentum_get(sim, &m);
    if (status >= 0) status = mps_energy_get(sim, &e);
    if (status < 0 || !isfinite(e.numerical) || !isfinite(e.viscous) || !isfinite(e.plugins))
        FAIL(k, KIT_BUDGET, "energy %g J, %s", e.numerical, text_of(sim));
    for (int d = 0; d < k->scene[0].dim; d++) {
        const double gained = m.gravity[d] + m.force[d] + m.plugins[d] + m.pressure[d] +
                              m.collision[d] + m.shift[d] + m.friction[d];
        const double rest = m.total[d] - first.total[d] - gained - m.added[d];
        if (!(fabs(rest) <= 1e-9 * (fabs(m.total[d]) + fabs(m.pressure[d]) + fabs(m.gravity[d]))))
            FAIL(k, KIT_BUDGET, "momentum does not close along axis %d: %g kg m/s", d, rest);
    }
    mps_sim_destroy(sim);
}

/* Whether a verb changed something. */
static bool acts(const kit *k)
{
    for (int32_t v = 0; v < k->ops->verb_count; v++)
        if (k->acted[v]) return true;
    return false;
}

/* In the first scene and in 2-D; in the others, which are slow, if the model has done nothing. */
static void check_verbs(kit *k)
{
    int failed = 0;
    for (int n = 0; n < k->scenes && !failed; n++)
        if (n == 0 || k->scene[n].dim == 2) failed = kit_watch(&k->scene[n], k->acted);
    for (int n = 1; n < k->scenes && !failed && !acts(k); n++)
        if (k->scene[n].dim == 3) failed = kit_watch(&k->scene[n], k->acted);
    k->failed |= failed;
    if (!failed && !acts(k))
        FAIL(k, KIT_ACTS,
             "it changes nothing in any scene, so that the other checks find nothing: in the "
             "callback, set numbers and fields with which it acts");
}

int kit_check_model(const mps_model_ops *ops, kit_prepare_fn prepare, void *user)
{
    static const struct {
        void (*check)(kit *);
        bool steady; /* only if two runs give the same bytes */
    } checks[] = {{check_verbs, false},  {check_repeat, false},    {check_settings, false},
                  {check_threads, true}, {check_order, true},      {check_handles, false},
                  {check_memory, false}, {check_checkpoint, true}, {check_midrun, false},
                  {check_budget, false}, {check_ranks, true}};
    kit k = {.ops = ops, .prepare = prepare, .user = user};
    check_table(&k);
    if (!k.failed) check_run(&k);
    for (size_t i = 0; k.scenes > 0 && i < sizeof checks / sizeof checks[0]; i++)
        if (!(checks[i].steady && k.unsteady)) checks[i].check(&k);
    kit_summary(ops, k.failed, k.scenes, k.scene, k.acted);
    for (int n = 0; n < k.scenes; n++) kit_state_free(&k.state[n]);
    return k.failed;
}

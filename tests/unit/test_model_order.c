/* SPDX-License-Identifier: BSD-3-Clause */
/* The order of verbs: by access to channels, by `after` and `before`, by registration; independent
 * of the order of activation. */
#include "built_in.h"
#include "model_fixture.h"
#include "models.h"
#include <stdio.h>

enum { MOST = 4, USES = 2 };

/* A model "<name>.toy" with one verb in MPS_FORCE. */
typedef struct toy {
    const char *name, *after, *before;
    mps_use uses[USES];
} toy;

/* Models in the order of registration and the order that must result; no order: two names that the
 * error must have. */
typedef struct scene {
    const char *order;
    const char *waits[2];
    toy toys[MOST];
} scene;

#define READS(channel)          \
    {                           \
        (channel), MPS_USE_READ \
    }
#define SEES(channel)                 \
    {                                 \
        (channel), MPS_USE_NEIGHBOURS \
    }
#define WRITES(channel)          \
    {                            \
        (channel), MPS_USE_WRITE \
    }
#define ALTERS(channel)           \
    {                             \
        (channel), MPS_USE_CHANGE \
    }

static const scene scenes[] = {
    /* by registration */
    {"c a b", {0}, {{.name = "c"}, {.name = "a"}, {.name = "b"}}},
    /* write before change before read */
    {"w c n r",
     {0},
     {{"n", 0, 0, {SEES("q")}},
      {"r", 0, 0, {READS("q")}},
      {"c", 0, 0, {ALTERS("q")}},
      {"w", 0, 0, {WRITES("q")}}}},
    {"w c n",
     {0},
     {{"n", 0, 0, {READS("q")}},
      {"c", 0, 0, {{"q", MPS_USE_NEIGHBOURS | MPS_USE_WRITE}}},
      {"w", 0, 0, {WRITES("q")}}}},
    /* through two channels */
    {"a b c",
     {0},
     {{"c", 0, 0, {READS("r")}},
      {"b", 0, 0, {READS("q"), WRITES("r")}},
      {"a", 0, 0, {WRITES("q")}}}},
    /* a name overrides the channels */
    {"r w", {0}, {{"w", "r", 0, {WRITES("q")}}, {"r", 0, 0, {READS("q")}}}},
    {"r w", {0}, {{"w", 0, 0, {WRITES("q")}}, {"r", 0, "w", {READS("q")}}}},
    {"b a", {0}, {{"a", "b.toy", 0, {{0}}}, {"b", 0, 0, {{0}}}}},
    /* names of inactive models have no effect */
    {"w r", {0}, {{"w", "absent", 0, {WRITES("q")}}, {"r", 0, "absent", {READS("q")}}}},
    /* first and last of all */
    {"b c a", {0}, {{"a", "*", 0, {{0}}}, {"b", 0, 0, {{0}}}, {"c", 0, 0, {{0}}}}},
    {"c a b", {0}, {{"a", 0, 0, {{0}}}, {"b", 0, 0, {{0}}}, {"c", 0, "*", {{0}}}}},
    {"r w", {0}, {{"w", 0, 0, {WRITES("q")}}, {"r", 0, "*", {READS("q")}}}},
    {"r w", {0}, {{"w", "*", 0, {WRITES("q")}}, {"r", 0, 0, {READS("q")}}}},
    /* two verbs with after "*": the channels decide */
    {"w r", {0}, {{"r", "*", 0, {READS("q")}}, {"w", "*", 0, {WRITES("q")}}}},
    {"a b", {0}, {{"a", "*", 0, {{0}}}, {"b", "*", 0, {{0}}}}},
    /* a name overrides a star */
    {"b a c", {0}, {{"a", 0, "*", {{0}}}, {"b", 0, "a", {{0}}}, {"c", 0, 0, {{0}}}}},
    {"c a b", {0}, {{"a", "*", 0, {{0}}}, {"b", "a", 0, {{0}}}, {"c", 0, 0, {{0}}}}},
    /* two contradicting names have no effect */
    {"w r", {0}, {{"r", "w", "w", {READS("q")}}, {"w", 0, 0, {WRITES("q")}}}},
    {"a b", {0}, {{"a", "b", 0, {{0}}}, {"b", "a", 0, {{0}}}}},
    /* verbs that wait for each other; others that wait for them are not named */
    {NULL,
     {"a.toy", "b.toy"},
     {{"a", 0, 0, {WRITES("q"), READS("r")}}, {"b", 0, 0, {WRITES("r"), READS("q")}}}},
    {NULL,
     {"b.toy", "c.toy"},
     {{"a", 0, 0, {READS("s")}},
      {"b", 0, 0, {WRITES("q"), READS("r")}},
      {"c", 0, 0, {WRITES("r"), READS("q")}},
      {"d", "c", 0, {{0}}}}},
    {NULL,
     {"b.toy", "c.toy"}, /* two of a ring of three */
     {{"d", "b", 0, {{0}}},
      {"a", "b", 0, {WRITES("q")}},
      {"c", "a", "b", {{0}}},
      {"b", 0, 0, {{0}}}}},
};

/* Names of the models whose verbs ran in a step. */
static char trace[64];

static int note(mps_stage *s)
{
    const size_t used = strlen(trace);
    snprintf(trace + used, sizeof trace - used, "%s%s", used ? " " : "", (const char *)s->self);
    return 0;
}

static const mps_channel brought[] = {{"q", "-", "a quantity", 1, MPS_TYPE_REAL, MPS_LIFE_STEP, 0},
                                      {"r", "-", "another", 1, MPS_TYPE_REAL, MPS_LIFE_STEP, 0},
                                      {"s", "-", "a third", 1, MPS_TYPE_REAL, MPS_LIFE_STEP, 0}};
static const mps_model_ops bring = {TOY("bring.toy", 1, idle_verbs), .channel_count = 3,
                                    .channels = brought};

/* Tables that must outlive the handle. */
static struct {
    char name[MOST][16];
    mps_verb verb[MOST];
} table;

static int register_scene(mps_sim *sim, const scene *c)
{
    int count = 0;
    use_model(sim, &bring);
    for (; count < MOST && c->toys[count].name; count++) {
        const toy *t = &c->toys[count];
        table.verb[count] = (mps_verb){.hook = MPS_FORCE,
                                       .uses = t->uses,
                                       .after = t->after,
                                       .before = t->before,
                                       .run = note};
        while (table.verb[count].use_count < USES && t->uses[table.verb[count].use_count].channel)
            table.verb[count].use_count++;
        snprintf(table.name[count], sizeof table.name[count], "%s.toy", t->name);
        const mps_model_ops ops = {TOY(table.name[count], 1, &table.verb[count]),
                                   .user = (void *)(uintptr_t)t->name};
        ASSERT_OK(sim, mps_model_register(sim, &ops));
    }
    return count;
}

/* Names of the verbs of MPS_FORCE in the list. */
static mps_status listed(mps_sim *sim, char out[64])
{
    mps_verb_info v;
    mps_status status;
    out[0] = 0;
    assert_int_equal(mps_verb_info_init(&v, sizeof v), MPS_OK);
    for (int32_t k = 0; (status = mps_verb_info_get(sim, k, &v)) == MPS_OK; k++) {
        if (v.hook != MPS_FORCE) continue;
        const size_t used = strlen(out), slot = strcspn(v.model, ".");
        snprintf(out + used, 64 - used, "%s%.*s", used ? " " : "", (int)slot, v.model);
    }
    return status;
}

static void check_order(mps_sim *sim, const scene *c, int number)
{
    char list[64];
    const mps_status status = listed(sim, list);
    trace[0] = 0;
    if (!c->order) {
        assert_int_equal(status, MPS_E_STATE);
        for (int k = 0; k < 2; k++)
            ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_STATE, c->waits[k]);
        ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_STATE, "'force'");
        if (strstr(mps_sim_error(sim), "d.toy")) fail_msg("scene %d names a bystander", number);
        assert_true(trace[0] == 0);
        return;
    }
    assert_int_equal(status, MPS_E_ARG);
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    if (strcmp(trace, c->order) != 0 || strcmp(list, trace) != 0)
        fail_msg("scene %d: ran '%s', listed '%s', wanted '%s'", number, trace, list, c->order);
}

/* The next permutation of 0..count-1; 0 after the last. */
static int permute(int *p, int count)
{
    int a = count - 2, b = count - 1;
    while (a >= 0 && p[a] > p[a + 1]) a--;
    if (a < 0) return 0;
    while (p[b] < p[a]) b--;
    const int kept = p[a];
    p[a] = p[b];
    p[b] = kept;
    for (int i = a + 1, j = count - 1; i < j; i++, j--) {
        const int other = p[i];
        p[i] = p[j];
        p[j] = other;
    }
    return 1;
}

/* Every scene with its models switched on in every order. */
static void order(void **state)
{
    (void)state;
    for (int k = 0; k < (int)(sizeof scenes / sizeof scenes[0]); k++) {
        int p[MOST] = {0, 1, 2, 3};
        mps_sim *sim = row_sim(2);
        const int count = register_scene(sim, &scenes[k]);
        do {
            for (int m = 0; m < count; m++) ASSERT_OK(sim, mps_model_use(sim, table.name[p[m]]));
            check_order(sim, &scenes[k], k);
            for (int m = 0; m < count; m++) ASSERT_OK(sim, mps_model_remove(sim, table.name[m]));
        } while (permute(p, count));
        mps_sim_destroy(sim);
    }
}

/* A cycle of two verbs is resolved if one of them is removed. */
static void one_of_two_goes(void **state)
{
    (void)state;
    mps_sim *sim = row_sim(2);
    const scene *c = scenes;
    while (c->order) c++;
    const int count = register_scene(sim, c);
    for (int m = 0; m < count; m++) ASSERT_OK(sim, mps_model_use(sim, table.name[m]));
    ASSERT_STATUS(sim, mps_step(sim, 1, NULL), MPS_E_STATE);
    ASSERT_OK(sim, mps_model_remove(sim, "a"));
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    mps_sim_destroy(sim);
}

/* Verbs of one model in one hook run in the order of its table; hooks in theirs. */
static void order_of_a_table(void **state)
{
    (void)state;
    static const mps_use reads[] = {READS("q")}, writes[] = {WRITES("q")};
    static const mps_verb verbs[] = {
        {.hook = MPS_SHIFT, .use_count = 1, .uses = reads, .run = note},
        {.hook = MPS_FORCE, .use_count = 1, .uses = reads, .run = note},
        {.hook = MPS_FORCE, .use_count = 1, .uses = writes, .run = note},
        {.hook = MPS_PREPARE, .use_count = 1, .uses = writes, .before = "*", .run = note}};
    static const mps_model_ops ops = {TOY("table.toy", 4, verbs), .user = "x"};
    static const char *const wanted[][2] = {
        {"limit", ""}, {"prepare", "q:w"}, {"force", "q:r"}, {"force", "q:w"}, {"shift", "q:r"}};
    mps_sim *sim = row_sim(2);
    mps_verb_info v;
    use_model(sim, &bring);
    use_model(sim, &ops);
    assert_int_equal(mps_verb_info_init(&v, sizeof v), MPS_OK);
    for (int32_t k = 0; k < 5; k++) {
        ASSERT_OK(sim, mps_verb_info_get(sim, k, &v));
        assert_string_equal(v.hook_name, wanted[k][0]);
        assert_string_equal(v.uses, wanted[k][1]);
    }
    assert_int_equal(mps_verb_info_get(sim, 5, &v), MPS_E_ARG);
    trace[0] = 0;
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    assert_string_equal(trace, "x x x x");
    mps_sim_destroy(sim);
}

enum { NO_USE, PRODUCES, CHANGES, ONLY_READS };

/* What a verb does to a channel. */
static int does(const mps_verb *v, const char *channel)
{
    for (int32_t u = 0; u < v->use_count; u++) {
        const int32_t access = v->uses[u].access;
        if (strcmp(v->uses[u].channel, channel) != 0) continue;
        if (!(access & MPS_USE_WRITE)) return ONLY_READS;
        return access & ~(MPS_USE_WRITE | MPS_USE_OPTIONAL) ? CHANGES : PRODUCES;
    }
    return NO_USE;
}

static bool named(const char *slot, const mps_model_ops *ops)
{
    return slot && mps__same_slot(slot, ops->name);
}

/* "*" of one verb alone decides. */
static bool stars(const char *mine, const char *theirs)
{
    return (mine && strcmp(mine, "*") == 0) != (theirs && strcmp(theirs, "*") == 0);
}

/* Both write a channel, and neither a name nor access to channels defines their order. */
static bool undecided(const mps_model_ops *a, const mps_verb *v, const mps_model_ops *b,
                      const mps_verb *w)
{
    bool decided = v->hook != w->hook || named(v->before, b) || named(v->after, b) ||
                   named(w->before, a) || named(w->after, a) || stars(v->after, w->after) ||
                   stars(v->before, w->before);
    bool shared = false;
    for (int32_t u = 0; u < v->use_count; u++) {
        const char *channel = v->uses[u].channel;
        const int mine = does(v, channel), theirs = does(w, channel);
        decided = decided || (theirs != NO_USE && mine != theirs);
        shared = shared || (mine == theirs && mine != ONLY_READS);
    }
    return shared && !decided;
}

/* The list of the built-in models decides nothing that a step could show. */
static void built_in_order(void **state)
{
    const mps_model_ops *const *all = mps__built_in_models;
    int ties = 0, pairs = 0;
    (void)state;
    for (int a = 0; all[a]; a++)
        for (int b = 0; b < a; b++) {
            if (mps__same_slot(all[a]->name, all[b]->name)) continue;
            for (int32_t v = 0; v < all[a]->verb_count; v++)
                for (int32_t w = 0; w < all[b]->verb_count; w++, pairs++)
                    if (undecided(all[a], &all[a]->verbs[v], all[b], &all[b]->verbs[w])) {
                        print_error("%s and %s\n", all[a]->name, all[b]->name);
                        ties++;
                    }
        }
    assert_true(pairs > 400);
    assert_int_equal(ties, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(order), cmocka_unit_test(one_of_two_goes),
                                       cmocka_unit_test(order_of_a_table),
                                       cmocka_unit_test(built_in_order)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

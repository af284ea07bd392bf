/* SPDX-License-Identifier: BSD-3-Clause */
/* Channels of MPS_LIFE_STEP: names, common use by models, allowed hooks, and their values at the
 * beginning of each step. */
#include "model_fixture.h"
#include <stdio.h>

/* ---- names and descriptions ------------------------------------------------------------------ */

static const mps_channel heat = {"heat",        "J", "heat of a particle", 1, MPS_TYPE_REAL,
                                 MPS_LIFE_STEP, 0};

static mps_model_ops bringing(const char *name, int32_t count, const mps_channel *channels)
{
    return (mps_model_ops){TOY(name, 1, idle_verbs), .channel_count = count, .channels = channels};
}

static void names_of_the_library(void **state)
{
    (void)state;
    mps_sim *sim = row_sim(2);
    mps_channel_info c;
    int32_t own = 0;
    assert_int_equal(mps_channel_info_init(&c, sizeof c), MPS_OK);
    for (; mps_channel_info_get(sim, own, &c) == MPS_OK; own++) {
        assert_int_equal(c.own, 1);
        mps_channel mine = heat;
        mine.name = c.name;
        const mps_model_ops ops = bringing("thief.toy", 1, &mine);
        ASSERT_REFUSED(sim, mps_model_register(sim, &ops), MPS_E_ARG, "the library's own");
        ASSERT_REFUSED(sim, mps_model_register(sim, &ops), MPS_E_ARG, c.name);
    }
    assert_true(own >= 18);
    mps_sim_destroy(sim);
}

/* Fields and channels have common names. */
static void names_of_fields(void **state)
{
    (void)state;
    static const char *const field[] = {"position", "kind", "mine"};
    mps_sim *sim = row_sim(2);
    mps_channel mine[3] = {heat, heat, heat};
    mps_model_ops ops[3];
    ASSERT_OK(sim, mps_field_add(sim, "mine", 1));
    for (int k = 0; k < 3; k++) {
        static const char *const name[] = {"a.toy", "b.toy", "c.toy"};
        mine[k].name = field[k];
        ops[k] = bringing(name[k], 1, &mine[k]);
        ASSERT_OK(sim, mps_model_register(sim, &ops[k]));
        ASSERT_REFUSED(sim, mps_model_use(sim, name[k]), MPS_E_ARG, "a field has this name");
    }
    const mps_model_ops good = bringing("good.toy", 1, &heat);
    use_model(sim, &good);
    ASSERT_REFUSED(sim, mps_field_add(sim, "heat", 1), MPS_E_ARG, "'heat'");
    ASSERT_REFUSED(sim, mps_field_add(sim, "acceleration", 1), MPS_E_ARG, "'acceleration'");
    ASSERT_OK(sim, mps_model_remove(sim, "good"));
    ASSERT_OK(sim, mps_field_add(sim, "heat", 1));
    mps_sim_destroy(sim);
}

/* A channel exists as long as one of the models that provide it. */
static void shared_by_two(void **state)
{
    (void)state;
    mps_sim *sim = row_sim(2);
    mps_channel other = heat;
    other.help = "the same in other words";
    const mps_model_ops a = bringing("a.toy", 1, &heat), b = bringing("b.toy", 1, &other);
    mps_channel_info c = {0};
    assert_true(!find_channel(sim, "heat", NULL));
    use_model(sim, &a);
    use_model(sim, &b);
    assert_true(find_channel(sim, "heat", &c));
    assert_string_equal(c.help, "heat of a particle");
    assert_true(c.own == 0 && c.components == 1 && c.life == MPS_LIFE_STEP);
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    ASSERT_OK(sim, mps_model_remove(sim, "a"));
    assert_true(find_channel(sim, "heat", NULL));
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    ASSERT_OK(sim, mps_model_remove(sim, "b"));
    assert_true(!find_channel(sim, "heat", NULL));
    mps_sim_destroy(sim);
}

/* Names of the active models and of the channels. */
static void picture(mps_sim *sim, char out[1024])
{
    mps_channel_info c;
    size_t used = 0;
    for (int32_t k = 0; mps_model_name(sim, k); k++)
        used += (size_t)snprintf(out + used, 1024 - used, "%s ", mps_model_name(sim, k));
    assert_int_equal(mps_channel_info_init(&c, sizeof c), MPS_OK);
    for (int32_t k = 0; mps_channel_info_get(sim, k, &c) == MPS_OK; k++)
        used += (size_t)snprintf(out + used, 1024 - used, "%s:%d ", c.name, (int)c.components);
    assert_true(used < 1024);
}

static void refused_as_before(mps_sim *sim, const char *name)
{
    char before[1024], after[1024];
    picture(sim, before);
    ASSERT_REFUSED(sim, mps_model_use(sim, name), MPS_E_ARG, "'heat'");
    ASSERT_REFUSED(sim, mps_model_use(sim, name), MPS_E_ARG, name);
    picture(sim, after);
    assert_string_equal(before, after);
    ASSERT_REFUSED(
        sim,
        mps_lease_begin(sim, "fresh", MPS_READ, &(mps_lease){.struct_size = sizeof(mps_lease)}),
        MPS_E_NAME, "fresh");
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
}

/* A description that differs in one entry; channels that the model added before it are removed. */
static void conflict(void **state)
{
    (void)state;
    static const char *const name[] = {"a.toy", "b.toy", "c.toy", "d.toy", "e.toy"};
    mps_sim *sim = row_sim(2);
    mps_channel other[5][3];
    mps_model_ops ops[5];
    const mps_model_ops first = bringing("first.toy", 1, &heat);
    use_model(sim, &first);
    for (int k = 0; k < 5; k++) {
        other[k][0] = (mps_channel){"early", "-", "h", 1, MPS_TYPE_REAL, MPS_LIFE_STEP, 0};
        other[k][1] = (mps_channel){"fresh", "-", "h", 1, MPS_TYPE_REAL, MPS_LIFE_PARTICLE, 0};
        other[k][2] = heat;
        ops[k] = bringing(name[k], 3, other[k]);
    }
    other[0][2].unit = "kJ";
    other[1][2].components = MPS_VECTOR;
    other[2][2].type = MPS_TYPE_INTEGER;
    other[3][2].life = MPS_LIFE_PARTICLE;
    other[4][2].initial = 1;
    for (int k = 0; k < 5; k++) {
        ASSERT_OK(sim, mps_model_register(sim, &ops[k]));
        refused_as_before(sim, name[k]);
    }
    ASSERT_OK(sim, mps_model_remove(sim, "first"));
    ASSERT_OK(sim, mps_model_use(sim, "b.toy"));
    mps_sim_destroy(sim);
}

/* The replaced model of a slot does not conflict with the new one. */
static void conflict_within_a_slot(void **state)
{
    (void)state;
    mps_sim *sim = row_sim(2);
    mps_channel other = heat;
    mps_channel_info c = {0};
    other.components = 3;
    const mps_model_ops one = bringing("slot.one", 1, &heat), two = bringing("slot.two", 1, &other);
    use_model(sim, &one);
    use_model(sim, &two);
    assert_true(find_channel(sim, "heat", &c) && c.components == 3);
    assert_string_equal(mps_model_name(sim, 0), "slot.two");
    assert_null(mps_model_name(sim, 1));
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    mps_sim_destroy(sim);
}

/* ---- uses ------------------------------------------------------------------------------------ */

static int seen_null, seen_array;

static int look(mps_stage *s)
{
    if (s->data[0])
        seen_array++;
    else
        seen_null++;
    return 0;
}

static void missing_channel(void **state)
{
    (void)state;
    static const mps_use wants[] = {{"heat", MPS_USE_READ}};
    static const mps_use may[] = {{"heat", MPS_USE_NEIGHBOURS | MPS_USE_OPTIONAL}};
    static const mps_verb verb = {.hook = MPS_FORCE, .use_count = 1, .uses = wants, .run = look};
    static const mps_verb optional = {.hook = MPS_FORCE, .use_count = 1, .uses = may, .run = look};
    static const mps_model_ops user = {TOY("user.toy", 1, &verb)};
    static const mps_model_ops easy = {TOY("easy.toy", 1, &optional)};
    const mps_model_ops bring = bringing("bring.toy", 1, &heat);
    mps_sim *sim = row_sim(2);
    mps_verb_info v;
    seen_null = seen_array = 0;
    use_model(sim, &user);
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_STATE,
                   "model 'user.toy' uses channel 'heat', which no active model brings");
    assert_int_equal(mps_verb_info_init(&v, sizeof v), MPS_OK);
    ASSERT_REFUSED(sim, mps_verb_info_get(sim, 0, &v), MPS_E_STATE, "'heat'");
    use_model(sim, &bring);
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    assert_true(seen_array == 1 && seen_null == 0);
    ASSERT_OK(sim, mps_model_remove(sim, "bring"));
    ASSERT_STATUS(sim, mps_step(sim, 1, NULL), MPS_E_STATE);
    ASSERT_OK(sim, mps_model_remove(sim, "user"));
    use_model(sim, &easy);
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    assert_true(seen_array == 1 && seen_null == 1);
    ASSERT_OK(sim, mps_model_use(sim, "bring.toy"));
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    assert_true(seen_array == 2 && seen_null == 1);
    mps_sim_destroy(sim);
}

/* All hooks, own channels and one of a model: the list and a step agree. */
static void wrong_hook(void **state)
{
    (void)state;
    static mps_use use;
    static mps_verb verb = {.run = do_nothing};
    static const mps_model_ops ops = {TOY("user.toy", 1, &verb)};
    const mps_model_ops bring = bringing("bring.toy", 1, &heat);
    static const int32_t access[] = {MPS_USE_READ, MPS_USE_NEIGHBOURS, MPS_USE_WRITE,
                                     MPS_USE_CHANGE};
    mps_sim *sim = row_sim(2);
    mps_channel_info c;
    mps_verb_info v;
    use_model(sim, &bring);
    ASSERT_OK(sim, mps_model_register(sim, &ops));
    assert_int_equal(mps_channel_info_init(&c, sizeof c), MPS_OK);
    assert_int_equal(mps_verb_info_init(&v, sizeof v), MPS_OK);
    for (int32_t k = 0; mps_channel_info_get(sim, k, &c) == MPS_OK; k++)
        for (int32_t hook = 0; hook < MPS_HOOK_COUNT; hook++)
            for (int a = 0; a < 4; a++) {
                use = (mps_use){c.name, access[a]};
                verb = (mps_verb){.hook = hook, .use_count = 1, .uses = &use, .run = do_nothing};
                const uint32_t bit = 1u << hook;
                const int may = (!(access[a] & 3) || c.reads & bit) &&
                                (!(access[a] & MPS_USE_WRITE) || c.writes & bit);
                ASSERT_OK(sim, mps_model_use(sim, "user.toy"));
                if (may)
                    ASSERT_OK(sim, mps_verb_info_get(sim, 0, &v));
                else
                    ASSERT_REFUSED(sim, mps_verb_info_get(sim, 0, &v), MPS_E_STATE, c.name);
            }
    use = (mps_use){"acceleration", MPS_USE_CHANGE};
    verb.hook = MPS_PREPARE;
    ASSERT_OK(sim, mps_model_use(sim, "user.toy"));
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_STATE,
                   "channel 'acceleration' cannot be written in hook 'prepare'");
    use = (mps_use){"heat", MPS_USE_READ};
    verb.hook = MPS_LIMIT;
    ASSERT_OK(sim, mps_model_use(sim, "user.toy"));
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_STATE,
                   "'heat' cannot be read in hook 'limit'");
    mps_sim_destroy(sim);
}

/* ---- first values ---------------------------------------------------------------------------- */

enum { SCALAR, VECTOR, MATRIX, NINE, COUNT, FLAGS, KINDS };
static const mps_channel all_kinds[KINDS] = {
    [SCALAR] = {"scalar", "-", "h", 1, MPS_TYPE_REAL, MPS_LIFE_STEP, 2.5},
    [VECTOR] = {"vector", "-", "h", MPS_VECTOR, MPS_TYPE_REAL, MPS_LIFE_STEP, -1.5},
    [MATRIX] = {"matrix", "-", "h", MPS_MATRIX, MPS_TYPE_REAL, MPS_LIFE_STEP, 7},
    [NINE] = {"nine", "-", "h", 9, MPS_TYPE_REAL, MPS_LIFE_STEP, 3},
    [COUNT] = {"count", "-", "h", 1, MPS_TYPE_INTEGER, MPS_LIFE_STEP, -4},
    [FLAGS] = {"flags", "-", "h", 3, MPS_TYPE_INTEGER, MPS_LIFE_STEP, 0}};

static int width_of(int kind, int dim)
{
    const int32_t c = all_kinds[kind].components;
    return c == MPS_VECTOR ? dim : c == MPS_MATRIX ? dim * dim : c;
}

static double value_of(const mps_stage *s, int kind, int64_t at)
{
    return kind >= COUNT ? (double)((const int32_t *)s->data[kind])[at]
                         : ((const double *)s->data[kind])[at];
}

static int64_t rows_checked;

static int check_first(mps_stage *s)
{
    const mps_view *v = s->view;
    for (int kind = 0; kind < KINDS; kind++) {
        const int width = width_of(kind, v->dim);
        for (int64_t at = 0; at < v->n * width; at++) {
            const int d = (int)(at % width);
            const int zero = kind == MATRIX && d / v->dim != d % v->dim;
            assert_true(value_of(s, kind, at) == (zero ? 0 : all_kinds[kind].initial));
        }
    }
    rows_checked += v->n;
    return 0;
}

static int spoil(mps_stage *s)
{
    for (int kind = 0; kind < KINDS; kind++)
        for (int64_t at = 0; at < s->view->n * width_of(kind, s->view->dim); at++)
            if (kind >= COUNT)
                ((int32_t *)s->data[kind])[at] = 99;
            else
                ((double *)s->data[kind])[at] = 99;
    return 0;
}

/* In each step, also with more particles than before. */
static void first_values(void **state)
{
    (void)state;
    static mps_use reads[KINDS], writes[KINDS];
    for (int k = 0; k < KINDS; k++) {
        reads[k] = (mps_use){all_kinds[k].name, MPS_USE_READ};
        writes[k] = (mps_use){all_kinds[k].name, MPS_USE_WRITE};
    }
    static const mps_verb verbs[] = {
        {.hook = MPS_CLASSIFY, .use_count = KINDS, .uses = reads, .run = check_first},
        {.hook = MPS_SHIFT, .use_count = KINDS, .uses = writes, .run = spoil}};
    static const mps_model_ops ops = {TOY("kinds.toy", 2, verbs), .channel_count = KINDS,
                                      .channels = all_kinds};
    for (int dim = 2; dim <= 3; dim++) {
        mps_sim *sim = row_sim(dim);
        rows_checked = 0;
        use_model(sim, &ops);
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        add_row(sim, 5, 40, NULL);
        ASSERT_OK(sim, mps_threads_set(sim, 2));
        ASSERT_OK(sim, mps_step(sim, 1, NULL));
        assert_int_equal(rows_checked, 8 + 8 + 48);
        mps_sim_destroy(sim);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(names_of_the_library),
                                       cmocka_unit_test(names_of_fields),
                                       cmocka_unit_test(shared_by_two),
                                       cmocka_unit_test(conflict),
                                       cmocka_unit_test(conflict_within_a_slot),
                                       cmocka_unit_test(missing_channel),
                                       cmocka_unit_test(wrong_hook),
                                       cmocka_unit_test(first_values)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

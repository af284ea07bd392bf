/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of a model: refusals at registration, values of settings, and its state, created or
 * passed by the caller. */
#include "model_fixture.h"
#include <stdlib.h>

static const mps_use one_use[] = {{"velocity", MPS_USE_READ}};
static const mps_verb one_verb = {
    .hook = MPS_FORCE, .use_count = 1, .uses = one_use, .run = do_nothing};
static const mps_setting one_setting = {"size", "m", "a size", MPS_TYPE_REAL, 1, 0, 2};
static const mps_channel one_channel = {"heat", "J", "heat", 1, MPS_TYPE_REAL, MPS_LIFE_STEP, 0};
static const mps_model_ops good = {TOY("good.toy", 1, &one_verb), .setting_count = 1,
                                   .channel_count = 1, .settings = &one_setting,
                                   .channels = &one_channel};

static void refused(mps_sim *sim, const mps_model_ops *ops, const char *word)
{
    mps_model_info info;
    int32_t known[2] = {0, 0};
    assert_int_equal(mps_model_info_init(&info, sizeof info), MPS_OK);
    while (mps_model_info_get(sim, known[0], &info) == MPS_OK) known[0]++;
    ASSERT_REFUSED(sim, mps_model_register(sim, ops), MPS_E_ARG, word);
    while (mps_model_info_get(sim, known[1], &info) == MPS_OK) known[1]++;
    assert_int_equal(known[0], known[1]);
}

/* Refused with one entry of a good table changed. */
#define BAD(entry, value, word)      \
    do {                             \
        mps_model_ops bad_ = good;   \
        bad_.entry = (value);        \
        refused(sim, &bad_, (word)); \
    } while (0)
#define BAD_IN(member, first, entry, value, word) \
    do {                                          \
        mps_model_ops bad_ = good;                \
        __typeof__(first) changed_ = (first);     \
        changed_.entry = (value);                 \
        bad_.member = &changed_;                  \
        refused(sim, &bad_, (word));              \
    } while (0)
#define BAD_VERB(entry, value, word)    BAD_IN(verbs, verb, entry, value, word)
#define BAD_SETTING(entry, value, word) BAD_IN(settings, setting, entry, value, word)
#define BAD_CHANNEL(entry, value, word) BAD_IN(channels, channel, entry, value, word)

static int make(const mps_allocator *allocator, void **self)
{
    *self = allocator->alloc(allocator->user, 16);
    return *self == NULL;
}

static void unmake(const mps_allocator *allocator, void *self)
{
    allocator->release(allocator->user, self);
}

static void bad_tables(void **state)
{
    (void)state;
    mps_sim *sim = empty_sim(2, 0.1, NULL);
    BAD(name, NULL, "name");
    BAD(name, "noslot", "'slot.variant'");
    BAD(name, ".toy", "'slot.variant'");
    BAD(name, "toy.", "'slot.variant'");
    BAD(name, "a.name_of_forty_eight_characters_and_this_is_one", "47");
    BAD(name, "collision.pair", "taken");
    BAD(help, NULL, "help");
    BAD(help, "", "help");
    BAD(create, make, "create and destroy");
    BAD(destroy, unmake, "create and destroy");
    BAD(struct_size, 0, "sizeof(mps_model_ops)");
    BAD(setting_count, -1, "-1 settings");
    BAD(setting_count, 17, "17 settings: 0..16");
    BAD(settings, NULL, "1 settings");
    BAD(channel_count, -1, "-1 channels");
    BAD(channel_count, 9, "9 channels: 0..8");
    BAD(channels, NULL, "1 channels");
    BAD(verb_count, 0, "0 verbs: 1..16");
    BAD(verb_count, 17, "17 verbs: 1..16");
    BAD(verbs, NULL, "1 verbs");
    mps_model_ops newer = good;
    newer.api = MPS_MODEL_API + 1;
    ASSERT_REFUSED(sim, mps_model_register(sim, &newer), MPS_E_VERSION, "interface");
    ASSERT_REFUSED(sim, mps_model_register(sim, NULL), MPS_E_ARG, "NULL");
    ASSERT_OK(sim, mps_model_register(sim, &good));
    BAD(help, "again", "taken");
    mps_sim_destroy(sim);
}

static void bad_verbs(void **state)
{
    (void)state;
    static const mps_use many[25] = {{"velocity", MPS_USE_READ}};
    static const mps_use twice[2] = {{"velocity", MPS_USE_READ}, {"velocity", MPS_USE_WRITE}};
    mps_verb verb = one_verb;
    mps_sim *sim = empty_sim(2, 0.1, NULL);
    BAD_VERB(run, NULL, "no function");
    BAD_VERB(hook, -1, "hook -1");
    BAD_VERB(hook, MPS_HOOK_COUNT, "hook 12");
    BAD_VERB(use_count, -1, "-1 uses");
    BAD_VERB(uses, NULL, "1 uses");
    mps_verb full = one_verb;
    full.uses = many;
    full.use_count = 25;
    mps_model_ops ops = good;
    ops.verbs = &full;
    refused(sim, &ops, "25 uses: 0..24");
    full.uses = twice;
    full.use_count = 2;
    refused(sim, &ops, "'velocity'");
    const mps_use uses[] = {{NULL, MPS_USE_READ}, {"velocity", 0},  {"velocity", MPS_USE_OPTIONAL},
                            {"velocity", 64},     {"velocity", -1}, {"", MPS_USE_READ}};
    full.use_count = 1;
    for (size_t k = 0; k < sizeof uses / sizeof uses[0]; k++) {
        full.uses = &uses[k];
        refused(sim, &ops, "use 0 of verb 0");
    }
    mps_sim_destroy(sim);
}

static void bad_settings(void **state)
{
    (void)state;
    mps_sim *sim = empty_sim(2, 0.1, NULL);
    mps_setting setting = one_setting;
    BAD_SETTING(key, NULL, "no key");
    BAD_SETTING(key, "", "no key");
    BAD_SETTING(unit, NULL, "unit");
    BAD_SETTING(help, NULL, "help");
    BAD_SETTING(initial, 2.5, "outside its range 0..2");
    BAD_SETTING(initial, NAN, "outside its range");
    BAD_SETTING(min, 1.5, "outside its range");
    BAD_SETTING(max, NAN, "outside its range");
    BAD_SETTING(type, 3, "type 3");
    BAD_SETTING(type, -1, "type -1");
    BAD_SETTING(type, MPS_TYPE_FLAG, "flag 'size' allows 0..2: must be 0..1");
    setting.type = MPS_TYPE_FLAG;
    setting.max = 1;
    BAD_SETTING(min, -1, "must be 0..1");
    BAD_SETTING(initial, 0.5, "whole number");
    setting.type = MPS_TYPE_INTEGER;
    BAD_SETTING(initial, 0.5, "whole number");
    mps_sim_destroy(sim);
}

static void bad_channels(void **state)
{
    (void)state;
    mps_sim *sim = empty_sim(2, 0.1, NULL);
    mps_channel channel = one_channel;
    BAD_CHANNEL(name, NULL, "1..31");
    BAD_CHANNEL(name, "", "1..31");
    BAD_CHANNEL(name, "a_name_of_thirty_two_characters_", "1..31");
    BAD_CHANNEL(unit, NULL, "unit");
    BAD_CHANNEL(help, NULL, "help");
    BAD_CHANNEL(components, 0, "0 components");
    BAD_CHANNEL(components, 10, "10 components");
    BAD_CHANNEL(components, -4, "-4 components");
    BAD_CHANNEL(type, MPS_TYPE_FLAG, "type 2");
    BAD_CHANNEL(life, 2, "life 2");
    BAD_CHANNEL(initial, NAN, "finite");
    BAD_CHANNEL(initial, INFINITY, "finite");
    channel.type = MPS_TYPE_INTEGER;
    BAD_CHANNEL(life, MPS_LIFE_PARTICLE, "integer for a step");
    BAD_CHANNEL(initial, 0.5, "whole number");
    BAD_CHANNEL(initial, 1e10, "32 bits");
    mps_sim_destroy(sim);
}

/* As many as are allowed. */
static void full_tables(void **state)
{
    (void)state;
    static mps_setting settings[16];
    static mps_channel channels[8];
    static mps_verb verbs[16];
    static mps_use uses[24];
    static char key[16][4], name[8][4];
    static const char *const own[] = {
        "velocity",  "pressure",         "density",          "number_density", "region",
        "asymmetry", "volume_deviation", "pressure_density", "heat",           "acceleration"};
    for (int k = 0; k < 16; k++) {
        settings[k] = one_setting;
        settings[k].key = key[k];
        key[k][0] = 'k', key[k][1] = (char)('a' + k);
        verbs[k] = (mps_verb){.hook = MPS_FORCE, .use_count = 24, .uses = uses, .run = do_nothing};
    }
    for (int k = 0; k < 8; k++) {
        channels[k] = one_channel;
        channels[k].name = name[k];
        name[k][0] = 'c', name[k][1] = (char)('a' + k);
    }
    for (int k = 0; k < 24; k++) {
        static char missing[24][4];
        missing[k][0] = 'm', missing[k][1] = (char)('a' + k);
        uses[k] = (mps_use){k < 8    ? name[k]
                            : k < 18 ? own[k - 8]
                                     : missing[k],
                            MPS_USE_READ | MPS_USE_OPTIONAL};
    }
    const mps_model_ops ops = {TOY("full.toy", 16, verbs), .setting_count = 16, .channel_count = 8,
                               .settings = settings, .channels = channels};
    mps_sim *sim = row_sim(2);
    use_model(sim, &ops);
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    mps_sim_destroy(sim);
}

/* ---- values of settings ---------------------------------------------------------------------- */

static void values(void **state)
{
    (void)state;
    static const mps_setting settings[] = {{"real", "m", "h", MPS_TYPE_REAL, 1, 0, 2},
                                           {"whole", "-", "h", MPS_TYPE_INTEGER, 3, -5, 5},
                                           {"flag", "-", "h", MPS_TYPE_FLAG, 1, 0, 1}};
    static const struct {
        const char *key;
        double value;
        const char *word; /* NULL: allowed */
    } set[] = {{"real", 0.5, NULL},
               {"real", 2, NULL},
               {"real", 2.001, "0..2"},
               {"real", NAN, "0..2"},
               {"real", -INFINITY, "0..2"},
               {"whole", -5, NULL},
               {"whole", 2.5, "whole number"},
               {"whole", 6, "-5..5"},
               {"flag", 0, NULL},
               {"flag", 0.5, "whole number"},
               {"flag", 2, "0..1"},
               {"flag", -1, "0..1"}};
    mps_model_ops ops = good;
    double value, before;
    ops.setting_count = 3;
    ops.settings = settings;
    mps_sim *sim = row_sim(2);
    use_model(sim, &ops);
    for (size_t k = 0; k < sizeof set / sizeof set[0]; k++) {
        ASSERT_OK(sim, mps_model_get(sim, "good", set[k].key, &before));
        if (set[k].word)
            ASSERT_REFUSED(sim, mps_model_set(sim, "good", set[k].key, set[k].value), MPS_E_ARG,
                           set[k].word);
        else
            ASSERT_OK(sim, mps_model_set(sim, "good", set[k].key, set[k].value));
        ASSERT_OK(sim, mps_model_get(sim, "good", set[k].key, &value));
        assert_true(value == (set[k].word ? before : set[k].value));
    }
    mps_sim_destroy(sim);
}

/* ---- the state of a model -------------------------------------------------------------------- */

static struct {
    const mps_allocator *given; /* the one that must be handed on */
    void *self, *before;        /* what create made, and what it found */
    int created, destroyed, ran, no_memory;
} test;

static void *take(void *user, size_t size)
{
    assert_ptr_equal(user, &test);
    return malloc(size);
}

static void release(void *user, void *block)
{
    assert_ptr_equal(user, &test);
    free(block);
}

static int create(const mps_allocator *allocator, void **self)
{
    test.created++;
    assert_ptr_equal(allocator->user, &test);
    test.before = *self;
    if (test.no_memory) return 1;
    *self = test.self = allocator->alloc(allocator->user, 16);
    return *self == NULL;
}

static void destroy(const mps_allocator *allocator, void *self)
{
    test.destroyed++;
    assert_true(allocator->user == &test && self == test.self);
    allocator->release(allocator->user, self);
}

static int check_self(mps_stage *s)
{
    test.ran++;
    assert_ptr_equal(s->self, test.self);
    return 0;
}

static void user_and_create(void **state)
{
    (void)state;
    const mps_allocator allocator = {take, release, &test};
    static const mps_verb verb = {.hook = MPS_FORCE, .run = check_self};
    static int mine;
    for (int with_user = 0; with_user < 2; with_user++)
        for (int with_create = 0; with_create < 2; with_create++) {
            memset(&test, 0, sizeof test);
            mps_model_ops ops = {TOY("state.toy", 1, &verb), .user = with_user ? &mine : NULL};
            if (with_create)
                ops.create = create, ops.destroy = destroy;
            else
                test.self = ops.user;
            mps_sim *sim = empty_sim(2, 0.1, &allocator);
            add_row(sim, 0, 3, NULL);
            use_model(sim, &ops);
            if (with_create) assert_ptr_equal(test.before, ops.user);
            ASSERT_OK(sim, mps_step(sim, 1, NULL));
            assert_int_equal(test.ran, 1);
            ASSERT_OK(sim, mps_model_remove(sim, "state"));
            assert_true(test.created == with_create && test.destroyed == with_create);
            ASSERT_OK(sim, mps_model_use(sim, "state.toy"));
            mps_sim_destroy(sim);
            assert_true(test.created == 2 * with_create && test.destroyed == test.created);
        }
}

/* No memory: no model is activated, and the slot keeps its model. */
static void create_fails(void **state)
{
    (void)state;
    const mps_allocator allocator = {take, release, &test};
    static const mps_verb verb = {.hook = MPS_FORCE, .run = do_nothing};
    static const mps_model_ops first = {TOY("state.first", 1, &verb)};
    const mps_model_ops ops = {TOY("state.toy", 1, &verb), .create = create, .destroy = destroy};
    memset(&test, 0, sizeof test);
    mps_sim *sim = empty_sim(2, 0.1, &allocator);
    use_model(sim, &first);
    ASSERT_OK(sim, mps_model_register(sim, &ops));
    test.no_memory = 1;
    ASSERT_REFUSED(sim, mps_model_use(sim, "state.toy"), MPS_E_NOMEM, "state.toy");
    assert_true(test.created == 1 && test.destroyed == 0);
    assert_string_equal(mps_model_name(sim, 0), "state.first");
    mps_sim_destroy(sim);
    assert_int_equal(test.destroyed, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_tables),      cmocka_unit_test(bad_verbs),
        cmocka_unit_test(bad_settings),    cmocka_unit_test(bad_channels),
        cmocka_unit_test(full_tables),     cmocka_unit_test(values),
        cmocka_unit_test(user_and_create), cmocka_unit_test(create_fails)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* The lists of models, settings, channels, verbs, solvers, preconditioners, kernels and presets:
 * complete, with descriptions, and equal to the names that functions accept. */
#include "model_fixture.h"
#include <mps/ppe.h>
#include <stdio.h>

static int is_text(const char *text)
{
    return text && text[0] && !strchr(text, '\n');
}

/* ---- models and settings --------------------------------------------------------------------- */

static void check_settings(mps_sim *sim, const mps_model_info *m)
{
    mps_setting_info s;
    int32_t k = 0;
    assert_int_equal(mps_setting_info_init(&s, sizeof s), MPS_OK);
    for (; mps_setting_info_get(sim, m->name, k, &s) == MPS_OK; k++) {
        if (!is_text(s.key) || !is_text(s.unit) || !is_text(s.help))
            fail_msg("%s: setting %d lacks a text", m->name, (int)k);
        if (!(s.min <= s.initial && s.initial <= s.max && s.min < s.max))
            fail_msg("%s: %s is %g, of %g..%g", m->name, s.key, s.initial, s.min, s.max);
        assert_true(s.type >= MPS_TYPE_REAL && s.type <= MPS_TYPE_FLAG);
        assert_true(s.type == MPS_TYPE_REAL || s.initial == floor(s.initial));
        assert_true(s.type != MPS_TYPE_FLAG || (s.min == 0 && s.max == 1));
        assert_true(m->active || s.value == s.initial);
    }
    assert_int_equal(k, m->settings);
}

static void models(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    mps_model_info m;
    int32_t known = 0, active = 0;
    assert_int_equal(mps_model_info_init(&m, sizeof m), MPS_OK);
    for (; mps_model_info_get(sim, known, &m) == MPS_OK; known++) {
        if (!is_text(m.name) || !is_text(m.help)) fail_msg("model %d lacks a text", (int)known);
        assert_true(m.verbs >= 1 && m.channels >= 0 && m.built_in == 1);
        check_settings(sim, &m);
        if (m.active) assert_string_equal(m.name, mps_model_name(sim, active++));
    }
    assert_true(known >= 29 && !mps_model_name(sim, active));
    const mps_model_ops mine = {TOY("mine.toy", 1, idle_verbs)};
    use_model(sim, &mine);
    ASSERT_OK(sim, mps_model_info_get(sim, known, &m));
    assert_true(m.built_in == 0 && m.active == 1 && m.verbs == 1 && m.settings == 0);
    assert_string_equal(m.name, "mine.toy");
    assert_string_equal(m.help, "a model of a test");
    ASSERT_OK(sim, mps_model_remove(sim, "mine"));
    ASSERT_OK(sim, mps_model_info_get(sim, known, &m));
    assert_int_equal(m.active, 0);
    mps_sim_destroy(sim);
}

/* The value is the current one while the model is active. */
static void value_of_a_setting(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    mps_setting_info s;
    assert_int_equal(mps_setting_info_init(&s, sizeof s), MPS_OK);
    ASSERT_OK(sim, mps_setting_info_get(sim, "collision.pair", 0, &s));
    const double other = 0.5 * (s.min + s.max), initial = s.initial;
    ASSERT_OK(sim, mps_model_set(sim, "collision", s.key, other));
    ASSERT_OK(sim, mps_setting_info_get(sim, "collision.pair", 0, &s));
    assert_true(s.value == other && s.initial == initial);
    ASSERT_OK(sim, mps_model_remove(sim, "collision"));
    ASSERT_OK(sim, mps_setting_info_get(sim, "collision.pair", 0, &s));
    assert_true(s.value == initial);
    ASSERT_REFUSED(sim, mps_setting_info_get(sim, "collision.pai", 0, &s), MPS_E_NAME,
                   "collision.pai");
    ASSERT_REFUSED(sim, mps_setting_info_get(sim, NULL, 0, &s), MPS_E_ARG, "NULL");
    mps_sim_destroy(sim);
}

/* ---- channels and verbs ---------------------------------------------------------------------- */

static int32_t count_channels(mps_sim *sim, int own)
{
    mps_channel_info c;
    int32_t count = 0;
    assert_int_equal(mps_channel_info_init(&c, sizeof c), MPS_OK);
    for (int32_t k = 0; mps_channel_info_get(sim, k, &c) == MPS_OK; k++) {
        if (!is_text(c.name) || !is_text(c.unit) || !is_text(c.help))
            fail_msg("channel %d lacks a text", (int)k);
        assert_true(c.components >= 0 && c.components <= 9 && c.reads != 0); /* 0: a scalar */
        assert_true((c.reads | c.writes) < 1u << MPS_HOOK_COUNT);
        count += c.own == own;
    }
    return count;
}

/* Every model alone: what it brings is in the list, and nothing else but the library's own. */
static void channels(void **state)
{
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) {
        mps_sim *sim = empty_sim(dim, 0.1, NULL);
        mps_model_info m;
        const int32_t own = count_channels(sim, 1);
        assert_true(own >= 18 && count_channels(sim, 0) == 0);
        assert_int_equal(mps_model_info_init(&m, sizeof m), MPS_OK);
        for (int32_t k = 0; mps_model_info_get(sim, k, &m) == MPS_OK; k++) {
            ASSERT_OK(sim, mps_model_use(sim, m.name));
            assert_int_equal(count_channels(sim, 0), m.channels);
            assert_int_equal(count_channels(sim, 1), own);
            ASSERT_OK(sim, mps_model_remove(sim, m.name));
        }
        mps_sim_destroy(sim);
    }
}

/* "name:rw? name:n": each is a channel of the list, or may be missing. */
static void check_uses(mps_sim *sim, const mps_verb_info *v)
{
    char text[1024], *rest = text;
    assert_non_null(v->uses);
    assert_true(snprintf(text, sizeof text, "%s", v->uses) < (int)sizeof text);
    for (char *use; (use = strtok_r(rest, " ", &rest));) {
        char *colon = strchr(use, ':');
        assert_non_null(colon);
        *colon = 0;
        const size_t letters = strspn(colon + 1, "rndaw");
        assert_true(letters >= 1 && letters <= 2);
        const char *behind = colon + 1 + letters;
        assert_true(!behind[0] || strcmp(behind, "?") == 0);
        if (!find_channel(sim, use, NULL) && behind[0] != '?')
            fail_msg("%s uses %s, which is not listed", v->model, use);
    }
}

static void verbs_of_the_presets(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    mps_name_info preset;
    int32_t presets = 0;
    assert_int_equal(mps_name_info_init(&preset, sizeof preset), MPS_OK);
    for (; mps_preset_info_get(sim, presets, &preset) == MPS_OK; presets++) {
        mps_verb_info v;
        mps_model_info m;
        mps_status status;
        int32_t verbs = 0, wanted = 0, hook = 0;
        ASSERT_OK(sim, mps_preset_use(sim, preset.name));
        assert_int_equal(mps_verb_info_init(&v, sizeof v), MPS_OK);
        for (; (status = mps_verb_info_get(sim, verbs, &v)) == MPS_OK; verbs++) {
            assert_true(v.hook >= hook && v.hook < MPS_HOOK_COUNT);
            assert_true(is_text(v.hook_name) && is_text(v.model));
            check_uses(sim, &v);
            hook = v.hook;
        }
        ASSERT_STATUS(sim, status, MPS_E_ARG); /* not: no order */
        assert_int_equal(mps_model_info_init(&m, sizeof m), MPS_OK);
        for (int32_t k = 0; mps_model_info_get(sim, k, &m) == MPS_OK; k++)
            wanted += m.active ? m.verbs : 0;
        assert_true(verbs == wanted && verbs > 5);
    }
    assert_int_equal(presets, 4);
    mps_sim_destroy(sim);
}

/* ---- names ----------------------------------------------------------------------------------- */

typedef mps_status (*list_fn)(const mps_sim *sim, int32_t index, mps_name_info *info);

static mps_status use_kernel(mps_sim *sim, const char *name)
{
    static char error[512];
    mps_config c;
    mps_sim *other = NULL;
    (void)sim;
    assert_int_equal(mps_config_init(&c, sizeof c), MPS_OK);
    c.dp = 0.1;
    c.kernel = name;
    c.error = error;
    c.error_size = sizeof error;
    const mps_status status = mps_sim_create(&c, &other);
    if (status == MPS_OK) {
        mps_name_info n;
        int active = 0;
        assert_int_equal(mps_name_info_init(&n, sizeof n), MPS_OK);
        for (int32_t k = 0; mps_kernel_info_get(other, k, &n) == MPS_OK; k++)
            active += n.active && strcmp(n.name, name) == 0;
        assert_int_equal(active, 1);
    }
    mps_sim_destroy(other);
    if (status < 0) mps_preset_use(sim, error); /* so that mps_sim_error() returns the text */
    return status;
}

static mps_status use_solver(mps_sim *sim, const char *name)
{
    return mps_solver_use(sim, name, NULL);
}

static mps_status use_preconditioner(mps_sim *sim, const char *name)
{
    return mps_solver_use(sim, "sundials.gmres", name);
}

static const struct {
    const char *what;
    list_fn list;
    mps_status (*use)(mps_sim *sim, const char *name);
    int32_t count;
    int marks; /* the list shows which is in use */
} all_names[] = {{"presets", mps_preset_info_get, mps_preset_use, 4, 0},
                 {"solvers", mps_solver_info_get, use_solver, 5, 1},
                 {"preconditioners", mps_preconditioner_info_get, use_preconditioner, 3, 1},
                 {"kernels", mps_kernel_info_get, use_kernel, 2, 0}};

/* Listed names are accepted, and the text of a refusal contains the same names. */
static void names(void **state)
{
    (void)state;
    for (size_t t = 0; t < sizeof all_names / sizeof all_names[0]; t++) {
        mps_sim *sim = new_sim(2, 0.1);
        mps_name_info n, used;
        char text[512];
        int32_t count = 0;
        assert_int_equal(mps_name_info_init(&n, sizeof n), MPS_OK);
        assert_int_equal(mps_name_info_init(&used, sizeof used), MPS_OK);
        ASSERT_STATUS(sim, all_names[t].use(sim, "quite_another"), MPS_E_NAME);
        snprintf(text, sizeof text, "%s", mps_sim_error(sim));
        for (; all_names[t].list(sim, count, &n) == MPS_OK; count++) {
            if (!is_text(n.name) || !is_text(n.help))
                fail_msg("%s: number %d lacks a text", all_names[t].what, (int)count);
            ASSERT_OK(sim, all_names[t].use(sim, n.name));
            for (int32_t k = 0; all_names[t].list(sim, k, &used) == MPS_OK; k++)
                if (all_names[t].marks) assert_int_equal(used.active, k == count);
            if (t != 3 && !strstr(text, n.name)) fail_msg("'%s' does not name %s", text, n.name);
        }
        assert_int_equal(count, all_names[t].count);
        mps_sim_destroy(sim);
    }
}

/* ---- ends and sizes -------------------------------------------------------------------------- */

static mps_status get_model(mps_sim *sim, int32_t k, void *i)
{
    return mps_model_info_get(sim, k, i);
}

static mps_status get_setting(mps_sim *sim, int32_t k, void *i)
{
    return mps_setting_info_get(sim, "collision.pair", k, i);
}

static mps_status get_channel(mps_sim *sim, int32_t k, void *i)
{
    return mps_channel_info_get(sim, k, i);
}

static mps_status get_verb(mps_sim *sim, int32_t k, void *i)
{
    return mps_verb_info_get(sim, k, i);
}

static mps_status get_pass(mps_sim *sim, int32_t k, void *i)
{
    return mps_pass_info_get(sim, k, i);
}

#define NAMES(what)                                                \
    static mps_status get_##what(mps_sim *sim, int32_t k, void *i) \
    {                                                              \
        return mps_##what##_info_get(sim, k, i);                   \
    }
NAMES(preset)
NAMES(solver)
NAMES(preconditioner)
NAMES(kernel)

static mps_status init_model(void *i, size_t size)
{
    return mps_model_info_init(i, size);
}

static mps_status init_setting(void *i, size_t size)
{
    return mps_setting_info_init(i, size);
}

static mps_status init_channel(void *i, size_t size)
{
    return mps_channel_info_init(i, size);
}

static mps_status init_verb(void *i, size_t size)
{
    return mps_verb_info_init(i, size);
}

static mps_status init_pass(void *i, size_t size)
{
    return mps_pass_info_init(i, size);
}

static mps_status init_name(void *i, size_t size)
{
    return mps_name_info_init(i, size);
}

static const struct {
    mps_status (*get)(mps_sim *sim, int32_t k, void *info);
    mps_status (*init)(void *info, size_t size);
    size_t size;
    size_t padding; /* behind the last member */
} gets[] = {{get_model, init_model, sizeof(mps_model_info), 0},
            {get_setting, init_setting, sizeof(mps_setting_info), 0},
            {get_channel, init_channel, sizeof(mps_channel_info),
             sizeof(mps_channel_info) - offsetof(mps_channel_info, own) - sizeof(int32_t)},
            {get_verb, init_verb, sizeof(mps_verb_info), 0},
            {get_pass, init_pass, sizeof(mps_pass_info), 0},
            {get_preset, init_name, sizeof(mps_name_info), 0},
            {get_solver, init_name, sizeof(mps_name_info), 0},
            {get_preconditioner, init_name, sizeof(mps_name_info), 0},
            {get_kernel, init_name, sizeof(mps_name_info), 0}};
enum { GETS = sizeof gets / sizeof gets[0], CAPACITY = 256 };

typedef union buffer {
    uint32_t struct_size;
    void *align;
    unsigned char byte[CAPACITY];
} buffer;

/* Beyond the last and before the first: a status alone, the text of the last failure stays. */
static void beyond_the_end(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    char text[512];
    ASSERT_STATUS(sim, mps_model_use(sim, "no.such"), MPS_E_NAME);
    snprintf(text, sizeof text, "%s", mps_sim_error(sim));
    for (int g = 0; g < GETS; g++) {
        buffer r;
        int32_t last = 0;
        memset(&r, 0, sizeof r); /* gaps between members are compared too */
        assert_int_equal(gets[g].init(&r, gets[g].size), MPS_OK);
        while (gets[g].get(sim, last, &r) == MPS_OK) last++;
        const int32_t beyond[] = {last, last + 1, INT32_MAX, -1, INT32_MIN};
        const buffer before = r;
        assert_true(last > 0);
        for (int k = 0; k < 5; k++) assert_int_equal(gets[g].get(sim, beyond[k], &r), MPS_E_ARG);
        assert_memory_equal(&before, &r, gets[g].size);
        assert_string_equal(mps_sim_error(sim), text);
        assert_int_equal(gets[g].get(NULL, 0, &r), MPS_E_ARG);
    }
    mps_sim_destroy(sim);
}

/* A struct of a newer header gets the entries of the library, no byte more; one that is too short
 * is refused. */
static void other_sizes(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    for (int g = 0; g < GETS; g++) {
        buffer full, other;
        const size_t sizes[] = {gets[g].size, gets[g].size + 8, CAPACITY},
                     bad[] = {0, 4, 16, gets[g].size - 8};
        for (int k = 0; k < 4; k++) assert_int_equal(gets[g].init(&other, bad[k]), MPS_E_ARG);
        assert_int_equal(gets[g].init(&full, gets[g].size), MPS_OK);
        ASSERT_OK(sim, gets[g].get(sim, 0, &full));
        for (int k = 0; k < 3; k++) {
            const size_t same = sizes[k] < gets[g].size ? sizes[k] : gets[g].size;
            memset(&other, 0x5a, sizeof other);
            assert_int_equal(gets[g].init(&other, sizes[k]), MPS_OK);
            assert_int_equal(other.struct_size, sizes[k]);
            for (size_t b = 4; b < CAPACITY; b++)
                assert_int_equal(other.byte[b], b < sizes[k] ? 0 : 0x5a);
            ASSERT_OK(sim, gets[g].get(sim, 0, &other));
            assert_int_equal(other.struct_size, sizes[k]);
            const size_t filled = same - (same == gets[g].size ? gets[g].padding : 0);
            assert_memory_equal(other.byte + 4, full.byte + 4, filled - 4);
            for (size_t b = same; b < CAPACITY; b++)
                assert_int_equal(other.byte[b], b < sizes[k] ? 0 : 0x5a);
        }
        other.struct_size = 0;
        ASSERT_REFUSED(sim, gets[g].get(sim, 0, &other), MPS_E_ARG, "_init");
        ASSERT_REFUSED(sim, gets[g].get(sim, 0, NULL), MPS_E_ARG, "NULL");
        assert_int_equal(gets[g].init(NULL, gets[g].size), MPS_E_ARG);
        assert_int_equal(gets[g].init(&other, 4), MPS_E_ARG);
    }
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(models),     cmocka_unit_test(value_of_a_setting),
        cmocka_unit_test(channels),   cmocka_unit_test(verbs_of_the_presets),
        cmocka_unit_test(names),      cmocka_unit_test(beyond_the_end),
        cmocka_unit_test(other_sizes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

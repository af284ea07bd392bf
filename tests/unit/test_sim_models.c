/* SPDX-License-Identifier: BSD-3-Clause */
/* The handle without stepping: models and kernels of the user, texts of statuses. */
#include "tank_fixture.h"
#include <mps/model.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- registration ---------------------------------------------------------------------------- */

static int force(mps_stage *s)
{
    return (void)s, 0;
}
static int count_create(const mps_allocator *allocator, void **self)
{
    return (void)allocator, (void)self, 0;
}

static const mps_verb good_verbs[] = {{.hook = MPS_FORCE, .run = force}};
static const mps_model_ops good_model = {.struct_size = sizeof(mps_model_ops),
                                         .api = MPS_MODEL_API,
                                         .name = "mine.force",
                                         .help = "does nothing",
                                         .verb_count = 1,
                                         .verbs = good_verbs};

#define REFUSE_MODEL(entry, value, status, word)                         \
    do {                                                                 \
        mps_model_ops m_ = good_model;                                   \
        m_.entry = (value);                                              \
        ASSERT_REFUSED(sim, mps_model_register(sim, &m_), status, word); \
    } while (0)

static void model_registration(void **state)
{
    (void)state;
    static const mps_setting outside[] = {{"a", "-", "", MPS_TYPE_REAL, 5, 0, 1}};
    static const mps_setting nameless[] = {{NULL, "-", "", MPS_TYPE_REAL, 0, 0, 1}};
    mps_sim *sim = new_sim(2, 0.05);
    REFUSE_MODEL(name, NULL, MPS_E_ARG, "name");
    REFUSE_MODEL(name, "force", MPS_E_ARG, "slot.variant");
    REFUSE_MODEL(name, ".force", MPS_E_ARG, "slot.variant");
    REFUSE_MODEL(name, "mine.", MPS_E_ARG, "slot.variant");
    REFUSE_MODEL(name, "mine.a_name_that_is_longer_than_forty_seven_characters", MPS_E_ARG,
                 "slot.variant");
    REFUSE_MODEL(name, "surface.asymmetry", MPS_E_ARG, "taken");
    REFUSE_MODEL(api, 2, MPS_E_VERSION, "interface 2");
    REFUSE_MODEL(verb_count, 0, MPS_E_ARG, "verb");
    REFUSE_MODEL(verb_count, 17, MPS_E_ARG, "verb");
    REFUSE_MODEL(verbs, NULL, MPS_E_ARG, "verb");
    REFUSE_MODEL(create, count_create, MPS_E_ARG, "destroy");
    REFUSE_MODEL(setting_count, 1, MPS_E_ARG, "settings");
    REFUSE_MODEL(setting_count, 17, MPS_E_ARG, "settings");
    REFUSE_MODEL(struct_size, 0, MPS_E_ARG, "struct_size is 0: set it to sizeof(mps_model_ops)");
    mps_model_ops m = good_model;
    m.setting_count = 1;
    m.settings = outside;
    ASSERT_REFUSED(sim, mps_model_register(sim, &m), MPS_E_ARG, "setting 'a' is 5");
    m.settings = nameless;
    ASSERT_REFUSED(sim, mps_model_register(sim, &m), MPS_E_ARG, "setting 0");
    ASSERT_REFUSED(sim, mps_model_register(sim, NULL), MPS_E_ARG, "NULL");
    assert_int_equal(mps_model_register(NULL, &good_model), MPS_E_ARG);
    ASSERT_STATUS(sim, mps_model_use(sim, "mine.force"), MPS_E_NAME); /* nothing was registered */
    ASSERT_OK(sim, mps_model_register(sim, &good_model));
    ASSERT_REFUSED(sim, mps_model_register(sim, &good_model), MPS_E_ARG, "taken");
    ASSERT_OK(sim, mps_model_use(sim, "mine.force"));
    assert_true(model_active(sim, "mine.force"));
    mps_sim_destroy(sim);
}

/* Tables fill up with an error, not beyond their end. */
static void too_many_models(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.05);
    char name[32];
    mps_model_ops m = good_model;
    mps_status status = MPS_OK;
    m.name = name;
    for (int k = 0; k < 100 && status == MPS_OK; k++) {
        snprintf(name, sizeof name, "slot%d.model", k);
        status = mps_model_register(sim, &m);
    }
    ASSERT_REFUSED(sim, status, MPS_E_ARG, "too many");
    status = MPS_OK;
    for (int k = 0; k < 30 && status == MPS_OK; k++) {
        snprintf(name, sizeof name, "slot%d.model", k);
        status = mps_model_use(sim, name);
    }
    ASSERT_REFUSED(sim, status, MPS_E_ARG, "too many");
    ASSERT_OK(sim, mps_preset_use(sim, "imps"));
    mps_sim_destroy(sim);
}

/* ---- what is missing ------------------------------------------------------------------------- */

static char logged[2048];

static void keep_warnings(void *user, int level, const char *text)
{
    (void)user;
    if (level < MPS_LOG_WARNING) return;
    strncat(logged, text, sizeof logged - strlen(logged) - 1);
}

static int count_of(const char *word)
{
    int count = 0;
    for (const char *at = logged; (at = strstr(at, word)) != NULL; at++) count++;
    return count;
}

/* Without a gradient or a source the liquid collapses: logged in the first step after it, once. */
static void missing_parts(void **state)
{
    (void)state;
    mps_config c;
    mps_sim *sim = NULL;
    assert_int_equal(mps_config_init(&c, sizeof c), MPS_OK);
    c.dim = 2;
    c.dp = 0.05;
    c.log = keep_warnings;
    logged[0] = 0;
    assert_int_equal(mps_sim_create(&c, &sim), MPS_OK);
    add_tank(sim, 0.5, 0.5, 0);
    fill_depth(sim, 0.5, 0.3, 0);
    ASSERT_OK(sim, mps_run(sim, 1e-3, NULL, NULL));
    assert_string_equal(logged, "");
    ASSERT_OK(sim, mps_model_remove(sim, "gradient"));
    assert_string_equal(logged, "");
    ASSERT_OK(sim, mps_run(sim, 2e-3, NULL, NULL));
    ASSERT_OK(sim, mps_run(sim, 3e-3, NULL, NULL));
    assert_int_equal(count_of("adds to 'acceleration' in hook 'gradient'"), 1);
    assert_int_equal(count_of("pressure_source"), 0);
    ASSERT_OK(sim, mps_model_use(sim, "gradient.corrected"));
    ASSERT_OK(sim, mps_model_remove(sim, "source"));
    ASSERT_OK(sim, mps_run(sim, 4e-3, NULL, NULL));
    ASSERT_OK(sim, mps_run(sim, 5e-3, NULL, NULL));
    assert_int_equal(count_of("adds to 'acceleration' in hook 'gradient'"), 1);
    assert_int_equal(count_of("adds to 'pressure_source' in hook 'source'"), 1);
    mps_sim_destroy(sim);
}

/* A slot without a model is named with the nearest one, or all that are active. */
static void inactive_slots(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.05);
    ASSERT_REFUSED(sim, mps_model_set(sim, "foo", "bar", 1), MPS_E_NAME,
                   "no active model in slot \"foo\"; the active slots are \"");
    ASSERT_REFUSED(sim, mps_model_remove(sim, "gradeint"), MPS_E_NAME,
                   "no active model in slot \"gradeint\"; did you mean \"gradient\"?");
    ASSERT_REFUSED(sim, mps_model_set(sim, "gradient.density", "bar", 1), MPS_E_NAME,
                   "no active model \"gradient.density\"; its slot has \"gradient.");
    ASSERT_REFUSED(sim, mps_model_set(sim, NULL, "bar", 1), MPS_E_NAME, "slot \"NULL\"");
    while (mps_model_name(sim, 0)) ASSERT_OK(sim, mps_model_remove(sim, mps_model_name(sim, 0)));
    ASSERT_REFUSED(sim, mps_model_remove(sim, "gradient"), MPS_E_NAME, "active slots are none");
    mps_sim_destroy(sim);
}

static double negative(void *user, double r, double re)
{
    return (void)user, r - re;
}
static double zero(void *user, double r, double re)
{
    return (void)user, (void)r, (void)re, 0;
}
static double flat(void *user, double r, double re)
{
    return (void)user, 1 - r / re;
}

static void user_kernel(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.05);
    mps_kernel k = {.struct_size = sizeof k};
    mps_stencil s = {.struct_size = sizeof s};
    double n0 = 0;
    add_tank(sim, 0.5, 0.5, 0);
    fill_depth(sim, 0.5, 0.3, 0);
    ASSERT_REFUSED(sim, mps_kernel_use(sim, NULL), MPS_E_ARG, "NULL");
    assert_int_equal(mps_kernel_custom(negative, NULL, &k), MPS_OK);
    ASSERT_REFUSED(sim, mps_kernel_use(sim, &k), MPS_E_ARG,
                   "the kernel is -0.055 at r = 0.05 m of re = 0.105 m");
    assert_int_equal(mps_kernel_custom(zero, NULL, &k), MPS_OK);
    ASSERT_REFUSED(sim, mps_kernel_use(sim, &k), MPS_E_ARG, "is 0 at all distances");
    k.id = 0;
    ASSERT_REFUSED(sim, mps_kernel_use(sim, &k), MPS_E_ARG, "kernel.id is 0");
    assert_int_equal(mps_kernel_custom(flat, NULL, &k), MPS_OK);
    ASSERT_OK(sim, mps_kernel_use(sim, &k));
    ASSERT_OK(sim, mps_stencil_get(sim, MPS_NEAR, &s));
    assert_int_equal(mps_lattice_constants(&k, 2, 0.05, 2.1 * 0.05, &n0, NULL), MPS_OK);
    assert_true(s.n0 == n0 && s.kernel.fn == flat);
    ASSERT_REFUSED(sim, mps_stencil_get(sim, 2, &s), MPS_E_ARG, "which is 2");
    ASSERT_REFUSED(sim, mps_stencil_get(sim, MPS_NEAR, NULL), MPS_E_ARG, "NULL");
    ASSERT_OK(sim, mps_step(sim, 1e-4, NULL));
    ASSERT_REFUSED(sim, mps_kernel_use(sim, &k), MPS_E_STATE, "first step");
    mps_sim_destroy(sim);
}

static void status_texts(void **state)
{
    (void)state;
    assert_string_equal(mps_status_name(MPS_OK), "MPS_OK");
    assert_string_equal(mps_status_name(MPS_E_LOST), "MPS_E_LOST");
    assert_string_equal(mps_status_name(-99), "MPS_E_UNKNOWN");
    assert_string_equal(mps_status_text(MPS_E_BUSY),
                        "a lease is open, or the call is not allowed now");
    assert_non_null(mps_status_text(99));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(model_registration), cmocka_unit_test(too_many_models),
        cmocka_unit_test(missing_parts),      cmocka_unit_test(inactive_slots),
        cmocka_unit_test(user_kernel),        cmocka_unit_test(status_texts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

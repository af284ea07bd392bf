/* SPDX-License-Identifier: BSD-3-Clause */
/* The handle without stepping: configuration, versioned structs, names and their suggestions,
 * settings, phases. */
#include "tank_fixture.h"
#include <mps/model.h>
#include <mps/ppe.h>
#include <stdio.h>
#include <stdlib.h>

static mps_config good_config(char *error, size_t size)
{
    mps_config c;
    assert_int_equal(mps_config_init(&c, sizeof c), MPS_OK);
    c.dp = 0.05;
    c.error = error;
    c.error_size = size;
    return c;
}

/* ---- configuration --------------------------------------------------------------------------- */

static void refuse(const mps_config *c, mps_status wanted, const char *word)
{
    mps_sim *sim = (mps_sim *)&wanted;
    c->error[0] = 0;
    const mps_status got = mps_sim_create(c, &sim);
    if (got != wanted || !strstr(c->error, word))
        fail_msg("%s instead of %s, \"%s\"; \"%s\" missing", mps_status_name(got),
                 mps_status_name(wanted), c->error, word);
    assert_null(sim);
}

static void no_loop(void *user, int32_t parts, mps_part_fn body, void *argument)
{
    (void)user, (void)parts, (void)body, (void)argument;
}

/* One entry of a good configuration made bad. */
#define REFUSE(entry, value, status, word)              \
    do {                                                \
        mps_config c_ = good_config(text, sizeof text); \
        c_.entry = (value);                             \
        refuse(&c_, (status), (word));                  \
    } while (0)

static void *no_memory(void *user, size_t size)
{
    return (void)user, (void)size, NULL;
}

static void bad_configuration(void **state)
{
    (void)state;
    char text[300];
    REFUSE(dp, 0, MPS_E_ARG, "dp is 0");
    REFUSE(dp, -0.1, MPS_E_ARG, "dp is -0.1");
    REFUSE(dp, NAN, MPS_E_ARG, "dp is");
    REFUSE(dp, INFINITY, MPS_E_ARG, "dp is inf");
    REFUSE(dp, 1e-300, MPS_E_ARG, "dp is 1e-300 m: must be 1e-12..1e+12 m");
    REFUSE(dp, 1e300, MPS_E_ARG, "dp is 1e+300 m");
    REFUSE(dim, 1, MPS_E_ARG, "dim is 1: 2 or 3");
    REFUSE(dim, 4, MPS_E_ARG, "dim is 4: 2 or 3");
    REFUSE(gravity[1], NAN, MPS_E_ARG, "gravity");
    REFUSE(kernel, "improvd", MPS_E_NAME, "\"improvd\"; did you mean \"improved\"");
    REFUSE(re_near, 1.49, MPS_E_ARG, "re_near is 1.49");
    REFUSE(re_near, 11, MPS_E_ARG, "re_near is 11");
    REFUSE(re_near, NAN, MPS_E_ARG, "re_near");
    REFUSE(re_far, 2, MPS_E_ARG, "re_far is 2");
    REFUSE(re_far, NAN, MPS_E_ARG, "re_far");
    REFUSE(velocity_scale, -1, MPS_E_ARG, "velocity_scale is -1");
    REFUSE(threads, -1, MPS_E_ARG, "threads is -1");
    REFUSE(threads, 2000, MPS_E_ARG, "threads is 2000");
    REFUSE(parallel.threads, 2000, MPS_E_ARG, "config.parallel.threads is 2000");
    REFUSE(parallel.run, no_loop, MPS_E_ARG, "config.parallel.struct_size is 0");
    REFUSE(lost_policy, 2, MPS_E_ARG, "lost_policy is 2");
    REFUSE(kernel, "wendland", MPS_E_NAME, "\"wendland\"; there are \"improved\", \"original\"");
    REFUSE(domain_max[0], NAN, MPS_E_ARG, "domain_max[0] is ");
    REFUSE(domain_min[1], INFINITY, MPS_E_ARG, "domain_min[1] is inf");
    REFUSE(domain_min[1], 1, MPS_E_ARG, "domain axis 0");
    REFUSE(speed_limit, -1, MPS_E_ARG, "speed_limit is -1");
    REFUSE(speed_limit, NAN, MPS_E_ARG, "speed_limit");
    REFUSE(allocator.alloc, no_memory, MPS_E_ARG, "allocator");
    REFUSE(struct_size, 0, MPS_E_ARG, "");
    mps_config c = good_config(text, sizeof text);
    assert_int_equal(mps_sim_create(&c, NULL), MPS_E_ARG);
    mps_sim *sim = (mps_sim *)&c;
    assert_int_equal(mps_sim_create(NULL, &sim), MPS_E_ARG);
    assert_null(sim);
    mps_sim_destroy(NULL);
    assert_non_null(mps_sim_error(NULL));
}

/* A text longer than its buffer is truncated, without overflow; NULL is allowed too. */
static void error_text(void **state)
{
    (void)state;
    char text[16];
    memset(text, '#', sizeof text);
    mps_config c = good_config(text, 10);
    mps_sim *sim;
    c.dp = -1;
    assert_int_equal(mps_sim_create(&c, &sim), MPS_E_ARG);
    assert_int_equal(strlen(text), 9);
    assert_int_equal(text[10], '#');
    c.error = NULL;
    assert_int_equal(mps_sim_create(&c, &sim), MPS_E_ARG);
}

static void versions(void **state)
{
    (void)state;
    struct {
        mps_config known;
        double later[2];
    } newer;
    char text[300] = "";
    mps_sim *sim = NULL;
    assert_int_equal(mps_config_init(&newer.known, sizeof newer), MPS_OK);
    assert_true(newer.later[0] == 0 && newer.later[1] == 0 &&
                newer.known.struct_size == sizeof newer);
    newer.known.dp = 0.1;
    assert_int_equal(mps_sim_create(&newer.known, &sim),
                     MPS_OK); /* entries of the future at their default */
    mps_sim_destroy(sim);
    newer.later[1] = 1;
    newer.known.error = text;
    newer.known.error_size = sizeof text;
    assert_int_equal(mps_sim_create(&newer.known, &sim), MPS_E_VERSION);
    assert_non_null(strstr(text, "newer version"));
    assert_null(sim);
    /* no version had these sizes */
    mps_config c = good_config(text, sizeof text);
    c.struct_size = offsetof(mps_config, parallel);
    assert_int_equal(mps_sim_create(&c, &sim), MPS_E_ARG);
    assert_non_null(strstr(text, "mps_config.struct_size is"));
    c = good_config(text, sizeof text);
    assert_int_equal(mps_sim_create(&c, &sim), MPS_OK);
    mps_phase phase = {.struct_size = 16, .density = 800, .viscosity = NAN};
    ASSERT_REFUSED(sim, mps_phase_set(sim, 0, &phase), MPS_E_ARG,
                   "mps_phase.struct_size is 16: call mps_phase_init() first");
    ASSERT_REFUSED(sim, mps_phase_get(sim, 0, &phase), MPS_E_ARG, "version 1.0.0 has 24");
    assert_true(phase.density == 800 && isnan(phase.viscosity));
    mps_sim_destroy(sim);
    assert_int_equal(mps_config_init(NULL, sizeof c), MPS_E_ARG);
    assert_int_equal(mps_config_init(&c, 4), MPS_E_ARG);
}

static void defaults(void **state)
{
    (void)state;
    mps_config c = {.struct_size = sizeof c, .dp = 0.1}; /* zero means default */
    mps_sim *sim = NULL;
    int32_t dim = 0;
    double dp = 0, t = -1;
    int64_t steps = -1;
    const char *solver = NULL, *pc = NULL;
    assert_int_equal(mps_sim_create(&c, &sim), MPS_OK);
    ASSERT_OK(sim, mps_sim_shape(sim, &dim, &dp));
    ASSERT_OK(sim, mps_sim_time(sim, &t, &steps));
    assert_true(dim == 2 && dp == 0.1 && t == 0 && steps == 0);
    ASSERT_OK(sim, mps_sim_shape(sim, NULL, NULL));
    ASSERT_OK(sim, mps_sim_time(sim, NULL, NULL));
    ASSERT_OK(sim, mps_solver_name(sim, &solver, &pc));
    assert_string_equal(solver, "sundials.pcg");
    assert_string_equal(mps_sim_error(sim), "");
    ASSERT_OK(sim, mps_threads_set(sim, 2));
    ASSERT_REFUSED(sim, mps_threads_set(sim, 0), MPS_E_ARG, "threads is 0");
    ASSERT_REFUSED(sim, mps_threads_set(sim, 1025), MPS_E_ARG, "threads is 1025");
    assert_int_equal(mps_sim_shape(NULL, &dim, &dp), MPS_E_ARG);
    assert_int_equal(mps_sim_time(NULL, &t, &steps), MPS_E_ARG);
    mps_sim_destroy(sim);
}

typedef struct message {
    int level;
    char text[200];
} message;

static void keep_message(void *user, int level, const char *text)
{
    message *m = user;
    m->level = level;
    snprintf(m->text, sizeof m->text, "%s", text);
}

static void log_callback(void **state)
{
    (void)state;
    char text[100];
    message m = {-1, ""};
    mps_config c = good_config(text, sizeof text);
    mps_tank tank;
    mps_sim *sim = NULL;
    c.log = keep_message;
    c.log_user = &m;
    assert_int_equal(mps_sim_create(&c, &sim), MPS_OK);
    assert_int_equal(mps_tank_init(&tank, sizeof tank), MPS_OK);
    tank.size[0] = tank.size[1] = 0.51; /* not a whole number of spacings */
    ASSERT_OK(sim, mps_tank_add(sim, &tank, NULL));
    assert_int_equal(m.level, MPS_LOG_INFO);
    assert_non_null(strstr(m.text, "0.51"));
    mps_sim_destroy(sim);
}

static void append_warning(void *user, int level, const char *text)
{
    char *all = user;
    if (level == MPS_LOG_WARNING) snprintf(all + strlen(all), 300 - strlen(all), "%s;", text);
}

/* A phase without particles is probably an error, and is logged once. */
static void empty_phase(void **state)
{
    (void)state;
    char text[100], warnings[300] = "";
    mps_config c = good_config(text, sizeof text);
    mps_phase p;
    mps_sim *sim = NULL;
    c.log = append_warning;
    c.log_user = warnings;
    assert_int_equal(mps_sim_create(&c, &sim), MPS_OK);
    assert_int_equal(mps_phase_init(&p, sizeof p), MPS_OK);
    for (int k = 1; k < 4; k++) ASSERT_OK(sim, mps_phase_set(sim, k, &p));
    add_tank(sim, 0.5, 0.5, 0);
    const double lo[2] = {0, 0}, hi[2] = {0.5, 0.3};
    ASSERT_OK(sim, mps_fill_box_add(sim, 2, lo, hi, NULL, NULL));
    for (int k = 0; k < 3; k++) ASSERT_OK(sim, mps_step(sim, 1e-4, NULL));
    assert_string_equal(warnings, "phase 1 is defined, but no fluid particle is of it;phase 3 is "
                                  "defined, but no fluid particle is of it;");
    mps_sim_destroy(sim);
}

/* ---- names and settings ---------------------------------------------------------------------- */

static void suggestions(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.05);
    double v = 0;
    ASSERT_REFUSED(sim, mps_model_use(sim, "tension"), MPS_E_NAME,
                   "no model \"tension\"; there are \"tension.csf\", \"tension.jump\"");
    ASSERT_REFUSED(sim, mps_model_use(sim, "tension.cfs"), MPS_E_NAME,
                   "did you mean \"tension.csf\"?");
    ASSERT_REFUSED(sim, mps_model_use(sim, "surface."), MPS_E_NAME,
                   "there are \"surface.asymmetry\", \"surface.detached\", ");
    ASSERT_REFUSED(sim, mps_model_use(sim, "surfce.asymmetry"), MPS_E_NAME,
                   "did you mean \"surface.asymmetry\"?");
    ASSERT_REFUSED(sim, mps_model_use(sim, "foo"), MPS_E_NAME,
                   "no model \"foo\"; the slots are \"");
    assert_non_null(strstr(mps_sim_error(sim), "\"surface\", "));
    assert_null(
        strstr(strstr(mps_sim_error(sim), "\"surface\"") + 1, "\"surface\"")); /* each once */
    assert_null(strstr(mps_sim_error(sim), "wall.half"));
    ASSERT_REFUSED(sim, mps_preset_use(sim, "no such thing"), MPS_E_NAME, "there are \"imps\", ");
    ASSERT_REFUSED(sim, mps_solver_use(sim, "petsc", NULL), MPS_E_NAME,
                   "there are 'sundials.pcg', ");
    ASSERT_REFUSED(sim, mps_model_set(sim, "surface", "xyz", 1), MPS_E_NAME,
                   "has no setting \"xyz\"; there are \"");
    ASSERT_OK(sim, mps_model_use(sim, "gradient.conservative"));
    ASSERT_REFUSED(sim, mps_model_set(sim, "gradient", "x", 1), MPS_E_NAME,
                   "model \"gradient.conservative\" has no setting");
    ASSERT_REFUSED(sim, mps_preset_use(sim, "ims"), MPS_E_NAME, "\"ims\"; did you mean \"imps\"");
    ASSERT_REFUSED(sim, mps_preset_use(sim, "imps.papr"), MPS_E_NAME, "\"imps.paper\"");
    ASSERT_REFUSED(sim, mps_preset_use(sim, NULL), MPS_E_ARG, "NULL");
    ASSERT_REFUSED(sim, mps_model_use(sim, "surface.asymetry"), MPS_E_NAME,
                   "\"surface.asymmetry\"");
    ASSERT_REFUSED(sim, mps_model_use(sim, NULL), MPS_E_ARG, "NULL");
    ASSERT_REFUSED(sim, mps_model_set(sim, "surface", "lov", 0.8), MPS_E_NAME, "\"low\"");
    ASSERT_REFUSED(sim, mps_model_get(sim, "surface", "hihg", &v), MPS_E_NAME, "\"high\"");
    ASSERT_REFUSED(sim, mps_model_set(sim, "surfac", "low", 0.8), MPS_E_NAME, "\"surfac\"");
    ASSERT_REFUSED(sim, mps_model_set(sim, NULL, "low", 0.8), MPS_E_NAME, "NULL");
    ASSERT_REFUSED(sim, mps_model_set(sim, "surface", NULL, 0.8), MPS_E_NAME,
                   "key of a setting of model \"surface.asymmetry\" is NULL");
    ASSERT_REFUSED(sim, mps_model_get(sim, "surface", NULL, &v), MPS_E_NAME,
                   "is NULL; there are \"");
    ASSERT_REFUSED(sim, mps_model_get(sim, "surface", "low", NULL), MPS_E_ARG, "value is NULL");
    ASSERT_REFUSED(sim, mps_model_remove(sim, "colision"), MPS_E_NAME, "colision");
    ASSERT_REFUSED(sim, mps_model_remove(sim, NULL), MPS_E_ARG, "NULL");
    ASSERT_REFUSED(sim, mps_solver_use(sim, "sundials.pgc", NULL), MPS_E_NAME, "'sundials.pcg'");
    ASSERT_REFUSED(sim, mps_solver_use(sim, "sundials.pcg", "jacoby"), MPS_E_NAME, "'jacobi'");
    ASSERT_REFUSED(sim, mps_solver_use(sim, NULL, NULL), MPS_E_ARG, "NULL");
    const char *solver = NULL;
    ASSERT_OK(sim, mps_solver_name(sim, &solver, NULL));
    assert_string_equal(solver, "sundials.pcg"); /* a refusal changes nothing */
    mps_sim_destroy(sim);
}

static void settings(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.05);
    double v = -1, initial = -1;
    ASSERT_OK(sim, mps_preset_use(sim, "imps.paper"));
    ASSERT_OK(sim, mps_model_get(sim, "source", "gamma", &initial));
    ASSERT_OK(sim, mps_model_set(sim, "source", "gamma", 0.25));
    ASSERT_REFUSED(sim, mps_model_set(sim, "source", "gamma", 1.5), MPS_E_ARG,
                   "gamma is 1.5: allowed 0..1");
    ASSERT_REFUSED(sim, mps_model_set(sim, "source", "gamma", -0.1), MPS_E_ARG,
                   "gamma is -0.1: allowed 0..1");
    ASSERT_REFUSED(sim, mps_model_set(sim, "source", "gamma", NAN), MPS_E_ARG, "gamma");
    ASSERT_OK(sim, mps_model_get(sim, "source.mixed", "gamma", &v)); /* by the full name too */
    assert_true(v == 0.25 && initial == 0.01);
    assert_int_equal(mps_model_get(sim, "source", "gamma", NULL), MPS_E_ARG);
    ASSERT_OK(sim, mps_preset_use(sim, "imps.paper")); /* previous settings are discarded */
    ASSERT_OK(sim, mps_model_get(sim, "source", "gamma", &v));
    assert_true(v == initial);
    assert_true(model_active(sim, "surface.asymmetry") && !model_active(sim, "surface.original"));
    ASSERT_OK(sim, mps_model_use(sim, "surface.original")); /* a slot has one model */
    assert_true(!model_active(sim, "surface.asymmetry") && model_active(sim, "surface.original"));
    double high;
    ASSERT_STATUS(sim, mps_model_get(sim, "surface.asymmetry", "high", &high),
                  MPS_E_NAME); /* a full name is not its neighbour's */
    ASSERT_STATUS(sim, mps_model_remove(sim, "surface.asymmetry"), MPS_E_NAME);
    ASSERT_OK(sim, mps_model_remove(sim, "surface"));
    assert_false(model_active(sim, "surface.original"));
    ASSERT_STATUS(sim, mps_model_remove(sim, "surface"), MPS_E_NAME);
    assert_null(mps_model_name(sim, -1));
    assert_null(mps_model_name(sim, 1000));
    assert_null(mps_model_name(NULL, 0));
    mps_sim_destroy(sim);
}

static void phases(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.05);
    const double bad[] = {0, -1, NAN, INFINITY};
    mps_phase p, got;
    mps_lease rho = {.struct_size = sizeof rho};
    assert_int_equal(mps_phase_init(&p, sizeof p), MPS_OK);
    assert_true(p.density == 1000 && p.viscosity == 1e-3);
    got = p;
    for (int k = 0; k < 4; k++) {
        p.density = bad[k];
        ASSERT_REFUSED(sim, mps_phase_set(sim, 0, &p), MPS_E_ARG, "density is");
        p.density = 1000;
        p.viscosity = bad[k];
        if (k > 0) ASSERT_REFUSED(sim, mps_phase_set(sim, 0, &p), MPS_E_ARG, "viscosity is");
        p.viscosity = 1e-3;
    }
    ASSERT_REFUSED(sim, mps_phase_set(sim, 16, &p), MPS_E_ARG, "16: 0..15");
    ASSERT_REFUSED(sim, mps_phase_set(sim, -1, &p), MPS_E_ARG, "-1: 0..15");
    ASSERT_REFUSED(sim, mps_phase_get(sim, 1, &got), MPS_E_ARG, "phase 1 is not defined");
    ASSERT_REFUSED(sim, mps_phase_set(sim, 0, NULL), MPS_E_ARG, "NULL");
    ASSERT_REFUSED(sim, mps_phase_get(sim, 0, NULL), MPS_E_ARG, "NULL");
    add_tank(sim, 0.5, 0.5, 0);
    fill_depth(sim, 0.5, 0.3, 0);
    p.density = 1.2;
    ASSERT_OK(sim, mps_phase_set(sim, 0, &p)); /* particles take it at once */
    ASSERT_OK(sim, mps_phase_get(sim, 0, &got));
    assert_true(got.density == 1.2);
    ASSERT_OK(sim, mps_lease_begin(sim, "density", MPS_READ, &rho));
    for (int64_t i = 0; i < rho.count; i++) assert_true(rho.data[i] == 1.2);
    ASSERT_OK(sim, mps_lease_end(sim, &rho));
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_configuration),
        cmocka_unit_test(error_text),
        cmocka_unit_test(versions),
        cmocka_unit_test(defaults),
        cmocka_unit_test(log_callback),
        cmocka_unit_test(empty_phase),
        cmocka_unit_test(suggestions),
        cmocka_unit_test(settings),
        cmocka_unit_test(phases),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Functions allowed in callbacks: none that change the simulation; a monitor may read, all
 * callbacks may query single values. The table has every function of a simulation. */
#include "model_fixture.h"
#include "lock_calls.h"
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* ---- from where ------------------------------------------------------------------------------ */

enum { VERB, MOTION, LOG, INSIDE, MONITOR, WHERE };
static const char *const where_name[WHERE] = {"a verb", "a motion", "a log callback",
                                              "an inside callback", "a monitor"};

/* The simulation that the callbacks call, NULL: none; one for all callbacks of this program. */
static struct {
    mps_sim *sim;
    int busy, done[WHERE], destroy_told;
} test;

/* Refused: the sentence names the function and from where it was called. */
static void check_call(const lock_call *c, int where)
{
    char name[64];
    const mps_status status = c->call(test.sim);
    const int may = c->level == LOCK_PLAIN || (c->level == LOCK_READS && where == MONITOR);
    if (may) {
        if (status == MPS_E_BUSY)
            fail_msg("%s from %s: %s", c->name, where_name[where], mps_sim_error(test.sim));
        return;
    }
    if (status != MPS_E_BUSY)
        fail_msg("%s from %s: %s", c->name, where_name[where], mps_status_name(status));
    snprintf(name, sizeof name, "%s() was called from %s", c->name, where_name[where]);
    if (!strstr(mps_sim_error(test.sim), name))
        fail_msg("%s from %s says '%s'", c->name, where_name[where], mps_sim_error(test.sim));
}

/* All calls, once for each kind of callback. */
static void meddle(int where)
{
    if (!test.sim || test.busy || test.done[where]) return;
    test.busy = test.done[where] = 1;
    for (int k = 0; k < lock_call_count; k++) check_call(&lock_calls[k], where);
    test.busy = 0;
}

static int meddling_verb(mps_stage *s)
{
    (void)s;
    meddle(VERB);
    return 0;
}

static int meddling_motion(void *user, double t, mps_motion_state *state)
{
    (void)user;
    meddle(MOTION);
    state->value[MPS_MOVE_X] = 1e-3 * (1 - cos(5 * t));
    state->rate[MPS_MOVE_X] = 5e-3 * sin(5 * t);
    state->accel[MPS_MOVE_X] = 25e-3 * cos(5 * t);
    return 0;
}

static void meddling_log(void *user, int level, const char *text)
{
    (void)user, (void)level;
    test.destroy_told += strstr(text, "mps_sim_destroy()") != NULL;
    meddle(LOG);
}

/* One lattice point above the liquid. */
static int meddling_inside(void *user, const double *x)
{
    (void)user;
    meddle(INSIDE);
    return fabs(x[0] - 0.4) < 0.01 && fabs(x[1] - 0.4) < 0.01;
}

static int meddling_monitor(void *user, mps_sim *sim, const mps_step_info *info)
{
    (void)user, (void)sim, (void)info;
    meddle(MONITOR);
    return 0;
}

/* ---- the scene ------------------------------------------------------------------------------- */

static const mps_verb verbs[] = {{.hook = MPS_FORCE, .run = meddling_verb}};
static const mps_model_ops meddler = {TOY("meddler.toy", 1, verbs)};

static mps_sim *new_scene(void)
{
    mps_config c;
    mps_probe probe;
    mps_sim *sim = NULL;
    int32_t id;
    assert_int_equal(mps_config_init(&c, sizeof c), MPS_OK);
    c.dp = 0.05;
    c.log = meddling_log;
    assert_int_equal(mps_sim_create(&c, &sim), MPS_OK);
    add_tank(sim, 0.5, 0.5, 0);
    fill_depth(sim, 0.5, 0.3, 0);
    use_model(sim, &meddler);
    assert_int_equal(mps_probe_init(&probe, sizeof probe), MPS_OK);
    probe.type = MPS_PROBE_FORCE;
    probe.rate = 1000;
    ASSERT_OK(sim, mps_probe_add(sim, &probe, &id));
    assert_int_equal(id, 0);
    return sim;
}

/* Steps, with each callback called at least once; the state is written to a file. */
static void play(int meddles, const char *folder, const char *file)
{
    const double lo[2] = {0.2, 0.41}, hi[2] = {0.36, 0.46};
    char path[128];
    mps_sim *sim = new_scene();
    mps_frames *frames = NULL;
    mps_snapshot *snapshot = NULL;
    memset(&test, 0, sizeof test);
    ASSERT_OK(sim, mps_frames_open(sim, folder, file, 0, &frames));
    ASSERT_OK(sim, mps_snapshot_create(sim, &snapshot));
    ASSERT_OK(sim, mps_load_watch(sim, MPS_LOAD_FORCE));
    lock_open(folder, frames, snapshot);
    test.sim = meddles ? sim : NULL;
    ASSERT_OK(sim, mps_motion_callback_set(sim, meddling_motion, NULL));
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL)); /* logs what it built */
    ASSERT_OK(sim, mps_particles_remove(sim, 1, &(int64_t){20}));
    ASSERT_OK(sim, mps_fill_add(sim, 0, meddling_inside, NULL, NULL));
    ASSERT_OK(sim, mps_run(sim, 0.02, meddling_monitor, NULL));
    ASSERT_OK(sim, mps_run(sim, 0.04, NULL, NULL));
    for (int w = 0; w < WHERE; w++)
        if (meddles && !test.done[w]) fail_msg("nothing was called from %s", where_name[w]);
    assert_true(meddles ? test.destroy_told >= WHERE - 1 : test.destroy_told == 0);
    snprintf(path, sizeof path, "%s/%s.checkpoint", folder, file);
    ASSERT_OK(sim, mps_checkpoint_write(sim, path));
    mps_frames_close(frames);
    mps_snapshot_destroy(snapshot);
    test.sim = NULL;
    mps_sim_destroy(sim);
}

static char *contents(const char *folder, const char *file, size_t *size)
{
    char path[128], *bytes = malloc(1 << 22);
    snprintf(path, sizeof path, "%s/%s.checkpoint", folder, file);
    FILE *f = fopen(path, "rb");
    assert_true(f && bytes);
    *size = fread(bytes, 1, 1 << 22, f);
    fclose(f);
    return bytes;
}

/* A run whose callbacks make calls that are refused has the bytes of one without such calls. */
static void refused_without_a_trace(void **state)
{
    (void)state;
    char folder[] = "mps_lock_XXXXXX", command[64];
    size_t size[2];
    assert_non_null(mkdtemp(folder));
    play(0, folder, "alone");
    play(1, folder, "meddled");
    char *alone = contents(folder, "alone", &size[0]),
         *meddled = contents(folder, "meddled", &size[1]);
    assert_int_equal(size[0], size[1]);
    assert_memory_equal(alone, meddled, size[0]);
    free(alone);
    free(meddled);
    snprintf(command, sizeof command, "rm -r %s", folder);
    assert_int_equal(system(command), 0);
}

/* ---- the table is complete ------------------------------------------------------------------- */

static int in_table(const char *name, size_t length)
{
    for (int k = 0; k < lock_call_count; k++)
        if (strlen(lock_calls[k].name) == length && strncmp(lock_calls[k].name, name, length) == 0)
            return 1;
    return 0;
}

/* Functions of a header that take a simulation. */
static int count_functions(char *text)
{
    int found = 0;
    for (char *at = text; (at = strstr(at, "MPS_API ")); at++) {
        char *open = strchr(at, '('), *end = strchr(at, ';');
        if (!open || !end || open > end) continue;
        char *sim = strstr(open, "mps_sim *");
        if (!sim || sim > end || sim[9] == '*') continue;
        char *name = open;
        while (name[-1] != ' ' && name[-1] != '*') name--;
        if (!in_table(name, (size_t)(open - name)))
            fail_msg("%.*s is not in the table of tests/unit/lock_calls.h", (int)(open - name),
                     name);
        found++;
    }
    return found;
}

static void every_function_is_in_the_table(void **state)
{
    (void)state;
    static const char *const header[] = {"body",  "couple", "device",    "geometry", "list",
                                         "model", "motion", "operators", "output",   "particles",
                                         "ppe",   "probe",  "sim",       "step"};
    int found = 0;
    for (size_t k = 0; k < sizeof header / sizeof header[0]; k++) {
        char path[512];
        char *text = calloc(1, 1 << 18);
        snprintf(path, sizeof path, "%s/%s.h", MPS_HEADERS, header[k]);
        FILE *f = fopen(path, "r");
        assert_true(f && text);
        assert_true(fread(text, 1, (1 << 18) - 1, f) < (1 << 18) - 1);
        fclose(f);
        found += count_functions(text);
        free(text);
    }
    assert_int_equal(found, lock_call_count - LOCK_OF_FRAMES);
}

/* ---- mps_sim_destroy() in callbacks outside of steps ---- */

static mps_sim *destroyed;
static int destroyers;

static double destroying_kernel(void *user, double r, double re)
{
    (void)user;
    destroyers++;
    if (destroyed) mps_sim_destroy(destroyed);
    return re / (r + 0.1 * re) - 0.9;
}

static void destroying_log(void *user, int level, const char *text)
{
    (void)user, (void)level, (void)text;
    destroyers++;
    if (destroyed) mps_sim_destroy(destroyed);
}

static void destroying_end(const mps_allocator *allocator, void *self)
{
    (void)allocator, (void)self;
    destroyers++;
    mps_sim_destroy(destroyed);
}

static int nothing_to_make(const mps_allocator *allocator, void **self)
{
    (void)allocator, (void)self;
    return 0;
}

/* It does nothing, returns, and sets an error. */
static void destroy_in_callbacks(void **state)
{
    const mps_model_ops ops = {TOY("ending.toy", 1, idle_verbs), .create = nothing_to_make,
                               .destroy = destroying_end};
    const double at[2] = {0.2, 0.1};
    mps_kernel k = {.struct_size = sizeof k};
    mps_stencil near;
    mps_config c;
    mps_probe probe;
    int32_t id;
    double value[6];
    (void)state;
    assert_int_equal(mps_config_init(&c, sizeof c), MPS_OK);
    assert_int_equal(mps_stencil_init(&near, sizeof near), MPS_OK);
    assert_int_equal(mps_probe_init(&probe, sizeof probe), MPS_OK);
    c.dp = 0.05;
    c.log = destroying_log;
    assert_int_equal(mps_sim_create(&c, &destroyed), MPS_OK);
    mps_sim *sim = destroyed;
    assert_int_equal(mps_kernel_custom(destroying_kernel, NULL, &k), MPS_OK);
    ASSERT_OK(sim, mps_kernel_use(sim, &k));
    assert_non_null(strstr(mps_sim_error(sim), "mps_sim_destroy() was called from"));
    add_tank(sim, 0.5, 0.5, 0);
    fill_depth(sim, 0.5, 0.3, 0); /* logs */
    probe.type = MPS_PROBE_FLUID_PRESSURE;
    memcpy(probe.at, at, sizeof at);
    ASSERT_OK(sim, mps_probe_add(sim, &probe, &id));
    ASSERT_OK(sim, mps_stencil_get(sim, MPS_NEAR, &near));
    ASSERT_OK(sim, mps_probe_read(sim, id, value));
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    use_model(sim, &ops);
    assert_true(destroyers > 10);
    destroyers = 0;
    mps_sim_destroy(sim);
    assert_int_equal(destroyers, 2); /* by the model, and by the log that warns of it */
    destroyed = NULL;
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_function_is_in_the_table),
                                       cmocka_unit_test(destroy_in_callbacks),
                                       cmocka_unit_test(refused_without_a_trace)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

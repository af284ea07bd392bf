/* SPDX-License-Identifier: BSD-3-Clause */
/* Plug-ins by the public functions: loading, checkpoints, notes of checkpoints, files that are no
 * plug-ins. */
#include <mps/case.h>
#include <mps/mps.h>
#include <mps/plugin.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

static const char SCREEN[] = PLUGINS "/plugin_screen.so", SCREEN2[] = PLUGINS "/plugin_screen2.so";
static char folder[] = "plugins_XXXXXX";

/* A case with one plug-in. */
static mps_status read_case(const char *file, int32_t load, mps_case **c)
{
    char text[1024];
    mps_case_options o;
    mps_case_options_init(&o, sizeof o);
    snprintf(text, sizeof text,
             "mps: 1\ndp: 50 mm\ntank: {size: 1 0.5 m}\nfill: [{water: {depth: 0.2 m}}]\n"
             "motion: {surge: {amplitude: 5 mm, period: 1 s}}\nrun: {until: 1 s, threads: 1}\n"
             "output: {page: 0 MB}\nplugins: ['%s']\nuse: [screen.uniform]\n"
             "settings: {screen.rate: 20 1/s}\n",
             file);
    o.load = load;
    o.text = text;
    o.size = strlen(text);
    return mps_case_open("memory.yaml", &o, c);
}

static bool has_message(const mps_case *c, const char *part)
{
    char text[4096];
    mps_case_messages_write(c, text, sizeof text);
    return strstr(text, part) != NULL;
}

/* ---- what is loaded ---- */

static void modes(void **state)
{
    (void)state;
    mps_case *c;
    char *text, *sketch;
    assert_int_equal(read_case(SCREEN, MPS_CASE_PLUGINS_NONE, &c), MPS_OK);
    assert_null(mps_case_plugin(c, 0));
    assert_int_equal(mps_case_check(c, &text, &sketch), MPS_E_ARG);
    assert_true(
        has_message(c, "memory.yaml:8:10: error: plugins: they were not loaded when the case"));
    mps_case_destroy(c);
    assert_int_equal(read_case(SCREEN, MPS_CASE_PLUGINS_FILES, &c), MPS_E_ARG);
    assert_null(mps_case_plugin(c, 0));
    assert_true(has_message(c, "is a program that would run with your rights"));
    assert_false(has_message(c, "no model"));
    mps_case_destroy(c);
    assert_int_equal(read_case(SCREEN, MPS_CASE_PLUGINS_ALL, &c), MPS_OK);
    assert_non_null(mps_case_plugin(c, 0));
    assert_null(mps_case_plugin(c, 1));
    assert_null(mps_case_plugin(c, -1));
    assert_null(mps_case_plugin(NULL, 0));
    assert_int_equal(mps_case_check(c, &text, &sketch), MPS_OK);
    assert_non_null(strstr(text, "screen 1.0"));
    free(text);
    free(sketch);
    mps_case_destroy(c);
}

/* The text of a case with plug-ins contains path and checksum of the file: reading it again gives
 * the same case. */
static void text_again(void **state)
{
    (void)state;
    mps_case *c, *again;
    mps_case_options o;
    assert_int_equal(read_case(SCREEN, MPS_CASE_PLUGINS_ALL, &c), MPS_OK);
    mps_case_options_init(&o, sizeof o);
    o.load = MPS_CASE_PLUGINS_ALL;
    o.text = mps_case_text(c);
    o.size = strlen(o.text);
    assert_non_null(strstr(o.text, "sha256: "));
    assert_int_equal(mps_case_open("again.yaml", &o, &again), MPS_OK);
    assert_string_equal(mps_case_text(c), mps_case_text(again));
    mps_case_destroy(again);
    mps_case_destroy(c);
}

static void arguments(void **state)
{
    (void)state;
    mps_plugin_file *p;
    mps_plugin_info info;
    mps_plugin_item item;
    mps_case *c;
    mps_case_options o;
    const char *none[] = {NULL};
    char why[200];
    assert_int_equal(mps_plugin_open(NULL, &p, NULL, 0), MPS_E_ARG);
    assert_int_equal(mps_plugin_open(SCREEN, NULL, NULL, 0), MPS_E_ARG);
    assert_int_equal(mps_plugin_open(SCREEN, &p, NULL, 3), MPS_E_ARG);
    assert_int_equal(mps_plugin_open("/nowhere.so", &p, why, sizeof why), MPS_E_IO);
    assert_null(p);
    assert_string_equal(why, "it cannot be read: No such file or directory");
    assert_int_equal(mps_plugin_open(SCREEN, &p, NULL, 0), MPS_OK);
    assert_int_equal(mps_plugin_info_init(&info, 3), MPS_E_ARG);
    assert_int_equal(mps_plugin_item_init(&item, 3), MPS_E_ARG);
    info.struct_size = item.struct_size = 0;
    assert_int_equal(mps_plugin_info_get(p, &info), MPS_E_ARG);
    assert_int_equal(mps_plugin_item_get(p, 0, &item), MPS_E_ARG);
    mps_plugin_info_init(&info, sizeof info);
    mps_plugin_item_init(&item, sizeof item);
    assert_int_equal(mps_plugin_info_get(p, &info), MPS_OK);
    assert_int_equal(info.items, 4);
    assert_string_equal(info.name, "screen");
    assert_int_equal(strlen(info.sha256), 64);
    assert_int_equal(mps_plugin_item_get(p, -1, &item), MPS_E_ARG);
    assert_int_equal(mps_plugin_item_get(p, 4, &item), MPS_E_ARG);
    assert_int_equal(mps_plugin_item_get(p, 2, &item), MPS_OK);
    assert_int_equal(item.kind, MPS_PLUGIN_LOAD);
    assert_string_equal(item.drive->name, "magnet");
    assert_int_equal(mps_plugin_register(p, NULL, NULL, 0), MPS_E_ARG);
    assert_int_equal(mps_plugin_register(NULL, NULL, NULL, 0), MPS_E_ARG);
    assert_int_equal(mps_job_plugin_add(NULL, p), MPS_E_ARG);
    mps_plugin_close(p);
    mps_plugin_close(NULL);
    assert_int_equal(mps_case_options_init(&o, 3), MPS_E_ARG);
    mps_case_options_init(&o, sizeof o);
    o.plugin_count = 1;
    assert_int_equal(mps_case_open("x", &o, &c), MPS_E_ARG);
    o.plugin = none;
    assert_int_equal(mps_case_open("x", &o, &c), MPS_E_ARG);
    o.plugin_count = 0;
    o.load = 3;
    assert_int_equal(mps_case_open("x", &o, &c), MPS_E_ARG);
    assert_null(c);
}

/* ---- checkpoints ---- */

typedef struct run {
    mps_case *c;
    mps_job *job;
    mps_sim *sim;
} run;

static void begin(run *r, const char *file)
{
    mps_job_config config;
    mps_job_config_init(&config, sizeof config);
    config.folder = folder;
    config.quiet = 1;
    assert_int_equal(read_case(file, MPS_CASE_PLUGINS_ALL, &r->c), MPS_OK);
    assert_int_equal(mps_case_job(r->c, &config, &r->job, &r->sim), MPS_OK);
}

static void end(run *r)
{
    mps_sim_destroy(r->sim);
    mps_job_destroy(r->job);
    mps_case_destroy(r->c);
}

static uint64_t steps(mps_sim *sim, int count)
{
    uint64_t sum = 0;
    mps_lease x;
    mps_lease_init(&x, sizeof x);
    for (int k = 0; k < count; k++) assert_int_equal(mps_step(sim, 1, NULL), MPS_OK);
    assert_int_equal(mps_lease_begin(sim, "position", MPS_READ, &x), MPS_OK);
    for (int64_t i = 0; i < x.count * x.stride; i++) {
        uint64_t bits;
        memcpy(&bits, &x.data[i], sizeof bits);
        sum = sum * 1099511628211u + bits;
    }
    mps_lease_end(sim, &x);
    return sum;
}

static void checkpoints(void **state)
{
    (void)state;
    run r;
    char path[80];
    snprintf(path, sizeof path, "%s/state", folder);
    begin(&r, SCREEN);
    steps(r.sim, 5);
    assert_int_equal(mps_checkpoint_write(r.sim, path), MPS_OK);
    const uint64_t sum = steps(r.sim, 5);
    end(&r);
    begin(&r, SCREEN);
    assert_int_equal(mps_checkpoint_read(r.sim, path), MPS_OK);
    assert_true(steps(r.sim, 5) == sum);
    end(&r);
    begin(&r, SCREEN2);
    assert_int_equal(mps_checkpoint_read(r.sim, path), MPS_E_ARG);
    assert_non_null(
        strstr(mps_sim_error(r.sim), "the checkpoint has \"plug-in screen 1.0 SHA-256"));
    assert_non_null(strstr(mps_sim_error(r.sim), "this simulation has \"plug-in screen 1.1 SHA"));
    end(&r);
    remove(path);
}

static void notes(void **state)
{
    (void)state;
    char text[200];
    mps_config config;
    mps_sim *sim;
    mps_config_init(&config, sizeof config);
    config.dp = 1;
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    memset(text, 'a', sizeof text);
    text[192] = '\0';
    assert_int_equal(mps_checkpoint_note_add(NULL, "a"), MPS_E_ARG);
    assert_int_equal(mps_checkpoint_note_add(sim, NULL), MPS_E_ARG);
    assert_int_equal(mps_checkpoint_note_add(sim, ""), MPS_E_ARG);
    assert_int_equal(mps_checkpoint_note_add(sim, "a\nb"), MPS_E_ARG);
    assert_int_equal(mps_checkpoint_note_add(sim, text), MPS_E_ARG);
    text[191] = '\0';
    for (int k = 0; k < 16; k++) assert_int_equal(mps_checkpoint_note_add(sim, text), MPS_OK);
    assert_int_equal(mps_checkpoint_note_add(sim, "a"), MPS_E_ARG);
    mps_sim_destroy(sim);
}

/* ---- texts that are no plug-ins ---- */

/* The value of `plugins` with some characters changed. A case is refused with a message, or it is
 * one. */
static void mutated(void **state)
{
    (void)state;
    enum { ROUNDS = 1500 };
    static const char letters[] = "{}[]:,'\"- #&*!|>%@\n\tfilesha256./x0";
    uint32_t seed = 1;
    for (int k = 0; k < ROUNDS; k++) {
        char value[200], text[400];
        mps_case *c = NULL;
        mps_case_options o;
        mps_case_options_init(&o, sizeof o);
        snprintf(value, sizeof value, "[{file: lib.so, sha256: 0}, '../x.so', %s]",
                 k % 50 ? "/dev/null" : SCREEN);
        for (int n = 0; n < 1 + k % 5; n++) {
            seed = seed * 1664525 + 1013904223;
            value[(seed >> 8) % strlen(value)] = letters[(seed >> 20) % (sizeof letters - 1)];
        }
        snprintf(text, sizeof text,
                 "mps: 1\ndp: 50 mm\ntank: {size: 1 0.5 m}\nfill: [{water: {depth: 0.2 m}}]\n"
                 "run: {until: 1 s}\nplugins: %s\n",
                 value);
        o.load = k % 3;
        o.text = text;
        o.size = strlen(text);
        const mps_status status = mps_case_open("memory.yaml", &o, &c);
        assert_non_null(c);
        assert_true((status == MPS_OK) == (mps_case_text(c) != NULL));
        if (status != MPS_OK) assert_true(mps_case_message_count(c) > 0);
        mps_case_destroy(c);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(modes),     cmocka_unit_test(text_again),
                                       cmocka_unit_test(arguments), cmocka_unit_test(checkpoints),
                                       cmocka_unit_test(notes),     cmocka_unit_test(mutated)};
    if (!mkdtemp(folder)) return 1;
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    rmdir(folder);
    return failed;
}

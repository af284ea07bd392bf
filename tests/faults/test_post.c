/* SPDX-License-Identifier: BSD-3-Clause */
/* Post-processing of the folder of a run: the page, pictures, the film, the state for ParaView,
 * statistics. Each call of the system and of libmps fails in turn, at its first and second visit.
 * Either the results are those without a failure, or the function reports the failure; then an
 * existing page or film remains, and there is no partial file. No file remains open. */
#include "../post/page_fixture.h"
#include "../unit/tank_fixture.h"
#include "fault_kit.h"
#include <mps/picture.h>
#include <mps/stats.h>

/* Something that is made of the folder `s`, or of `sim`. */
typedef struct product {
    const char *name; /* of its file in the folder; NULL: it is a text */
    mps_status (*make)(const scene *s, mps_sim *sim, char *error, size_t size);
    const char *before; /* content of the file until the new one is complete; NULL: none */
    int least;          /* failures that end it */
} product;

enum { ERROR_SIZE = 300, PLACES = 1000 };
static char path[256], answer[20000];

static mps_status make_page(const scene *s, mps_sim *sim, char *error, size_t size)
{
    mps_page_config config;
    (void)sim;
    mps_page_config_init(&config, sizeof config);
    config.error = error;
    config.error_size = size;
    return mps_page_write(s->folder, &config, NULL);
}

static mps_picture_config picture_of(char *error, size_t size)
{
    mps_picture_config config;
    mps_picture_config_init(&config, sizeof config);
    config.width = 400;
    config.error = error;
    config.error_size = size;
    return config;
}

static mps_status make_picture(const scene *s, mps_sim *sim, char *error, size_t size)
{
    mps_picture_config config = picture_of(error, size);
    (void)s;
    return mps_picture_save(sim, &config, path);
}

static mps_status make_frame(const scene *s, mps_sim *sim, char *error, size_t size)
{
    mps_picture_config config = picture_of(error, size);
    (void)sim;
    return mps_picture_frame_save(s->folder, -1, &config, path);
}

static mps_status make_film(const scene *s, mps_sim *sim, char *error, size_t size)
{
    char program[128];
    mps_film_config config;
    (void)sim;
    path_of(s, "program", program);
    mps_film_config_init(&config, sizeof config);
    config.width = 400;
    config.program = program;
    config.error = error;
    config.error_size = size;
    return mps_film_save(s->folder, &config, NULL);
}

static mps_status make_state(const scene *s, mps_sim *sim, char *error, size_t size)
{
    (void)sim;
    return mps_paraview_save(s->folder, error, size);
}

/* Statistics of the highest peaks of P1, with the constants of the folder. */
static void tell(const mps_impacts *impacts)
{
    mps_fit fit = {.struct_size = sizeof fit};
    mps_impact one = {.struct_size = sizeof one};
    size_t used = 0;
    for (int64_t k = 0; mps_impacts_highest(impacts, k, &one) == MPS_OK; k++)
        used += (size_t)snprintf(answer + used, sizeof answer - used, "%.17g %.17g\n", one.t,
                                 one.peak);
    if (mps_impacts_fit_get(impacts, MPS_FIT_WEIBULL, &fit) == MPS_OK)
        snprintf(answer + used, sizeof answer - used, "%.17g\n", mps_fit_value(&fit, 100));
}

static mps_status make_statistics(const scene *s, mps_sim *sim, char *error, size_t size)
{
    static const char *const names[] = {"P1"};
    char table_path[128];
    mps_stats_config config;
    mps_table *table = NULL;
    mps_impacts *impacts = NULL;
    (void)sim;
    path_of(s, "probes.csv", table_path);
    mps_stats_config_init(&config, sizeof config);
    config.error = error;
    config.error_size = size;
    config.resamples = 3;
    mps_status status = mps_stats_config_read(s->folder, &config);
    if (status == MPS_OK) status = mps_table_read(&config, table_path, 1, names, &table);
    if (status == MPS_OK)
        status = mps_impacts_find(&config, mps_table_rows(table), mps_table_values(table, -1),
                                  mps_table_values(table, 0), &impacts);
    if (status == MPS_OK) tell(impacts);
    mps_impacts_destroy(impacts);
    mps_table_destroy(table);
    return status;
}

static const product products[] = {{"report.html", make_page, "an earlier page", 60},
                                   {"state.png", make_picture, NULL, 8},
                                   {"frame.png", make_frame, NULL, 30},
                                   {"film.mp4", make_film, "an earlier film", 40},
                                   {"paraview.py", make_state, NULL, 30},
                                   {NULL, make_statistics, NULL, 15}};
enum { PRODUCTS = sizeof products / sizeof *products };

/* Entries of a folder. */
static int entries(const char *folder)
{
    int count = 0;
    DIR *all = opendir(folder);
    assert_non_null(all);
    while (readdir(all)) count++;
    closedir(all);
    return count;
}

/* Content of a product; "": nothing. The caller frees it. */
static char *made(const scene *s, const product *p, size_t *size)
{
    char *text = p->name ? text_read(s, p->name, size) : strdup(answer);
    if (!p->name) *size = strlen(answer);
    if (text) return text;
    *size = 0;
    return strdup("");
}

static mps_status make(const scene *s, const product *p, mps_sim *sim, int32_t place, int32_t visit,
                       char error[ERROR_SIZE], const char **failed)
{
    error[0] = answer[0] = '\0';
    if (p->name) path_of(s, p->name, path);
    if (p->before) text_write(s, p->name, p->before);
    if (p->name && !p->before) unlink(path);
    fault_arm(place, visit);
    const mps_status status = p->make(s, sim, error, ERROR_SIZE);
    *failed = fault_disarm();
    return status;
}

/* A whole answer and what its making has left, to compare with. */
typedef struct whole {
    char *text;
    size_t size;
    int files, entries;
} whole;

/* @return things that are wrong, which are shown */
static int compare(const scene *s, const product *p, const whole *w, mps_status status,
                   const char *error, const char *failed)
{
    size_t size = 0;
    char *text = made(s, p, &size);
    const int left = entries(s->folder) - w->entries, open = entries("/proc/self/fd") - w->files;
    const char *before = p->before ? p->before : "";
    const bool same = size == w->size && memcmp(text, w->text, size) == 0;
    const char *wrong = NULL;
    const bool no_phase = failed && strstr(failed, "mps_phase_get"); /* as if it were not defined */
    if (status == MPS_OK && !same && !no_phase) wrong = "done, but not as without a failure";
    if (status != MPS_OK && strcmp(text, before) != 0) wrong = "failed, but the file has changed";
    if (status != MPS_OK && !error[0]) wrong = "failed without a word";
    if (left != (p->name && size == 0 ? -1 : 0)) wrong = "leaves another file";
    if (open != 0) wrong = "leaves a file open";
    if (wrong)
        print_error("%s: %s: %s: '%s'\n", p->name ? p->name : "statistics",
                    failed ? failed : "no failure", wrong, error);
    free(text);
    return wrong != NULL;
}

static void in_turn(const scene *s, const product *p, mps_sim *sim)
{
    char error[ERROR_SIZE];
    const char *failed;
    int wrong = 0, ended = 0;
    whole w = {.files = 0};
    fault_forget();
    if (make(s, p, sim, -1, 1, error, &failed) != MPS_OK) fail_msg("%s", error);
    w.text = made(s, p, &w.size);
    assert_true(w.size > 0);
    w.files = entries("/proc/self/fd");
    w.entries = entries(s->folder);
    const int32_t places = fault_places();
    bool twice[PLACES];
    assert_true(places <= PLACES);
    for (int32_t k = 0; k < places; k++) twice[k] = fault_visits(k) > 1;
    for (int32_t visit = 1; visit <= 2; visit++)
        for (int32_t k = 0; k < places; k++) {
            if (visit == 2 && !twice[k]) continue;
            const mps_status status = make(s, p, sim, k, visit, error, &failed);
            wrong += compare(s, p, &w, status, error, failed);
            ended += status != MPS_OK;
        }
    if (p->name) unlink(path);
    print_message("%s, %d-D: %d failures ended it\n", p->name ? p->name : "statistics", s->dim,
                  ended);
    free(w.text);
    assert_int_equal(wrong, 0);
    assert_true(ended >= p->least);
}

/* Water at rest with a sensor. */
static mps_sim *new_state(int32_t dim)
{
    mps_sim *sim = new_sim(dim, 0.05);
    mps_probe probe;
    int32_t id;
    add_tank(sim, 0.4, 0.3, 0.2);
    fill_depth(sim, 0.4, 0.2, 0.2);
    mps_probe_init(&probe, sizeof probe);
    probe.type = MPS_PROBE_WALL_PRESSURE;
    probe.name = "P1";
    probe.at[1] = 0.1;
    probe.at[2] = 0.1;
    ASSERT_OK(sim, mps_probe_add(sim, &probe, &id));
    return sim;
}

static void each_call(void **state)
{
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) {
        scene s = {.dim = dim, .fluid = 12, .frames = 3, .rows = 450, .moves = true, .body = true};
        char program[128];
        mps_sim *sim = new_state(dim);
        scene_create(&s);
        text_write(&s, "case.yaml", "mps: 1\n");
        text_write(
            &s, "program",
            "#!/bin/sh\ncat >/dev/null\nfor last do :; done\necho film >\"${last#file:}\"\n");
        path_of(&s, "program", program);
        assert_int_equal(chmod(program, 0755), 0);
        for (int k = 0; k < PRODUCTS; k++) in_turn(&s, &products[k], sim);
        mps_sim_destroy(sim);
        scene_remove(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(each_call)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* What public functions that set something copy between the host and a device: what they change,
 * and no other field. A coupled run, which sets something before each step, copies what the same
 * run without setters copies. */
#include "device_memory.h"
#include "setter_calls.h"
#include <dirent.h>
#include <stdlib.h>

/* Besides fields: numbers of models, sums and maxima of loops [bytes]. The smallest field of
 * doubles of the scene is larger. */
enum { SLACK = 2048 };

typedef struct traffic {
    int64_t up, down; /* bytes */
} traffic;

/* ---- the lists are complete ------------------------------------------------------------------ */

static bool is_listed(const char *name, size_t length)
{
    bool listed = false;
    for (int k = 0; k < SETTERS; k++)
        listed |= strlen(setters[k].name) == length && strncmp(setters[k].name, name, length) == 0;
    for (int k = 0; k < OTHERS; k++)
        listed |= strlen(others[k]) == length && strncmp(others[k], name, length) == 0;
    return listed;
}

/* Functions of a header that take a simulation which they may change. */
static int check_header(const char *text)
{
    int found = 0;
    for (const char *at = text; (at = strstr(at, "\nMPS_API ")) != NULL; at++) {
        const char *open = strchr(at, '('), *end = strchr(at, ';'), *sim = open;
        if (!open || !end || open > end) continue;
        while (sim && (sim = strstr(sim + 1, "mps_sim *")) != NULL && sim < end)
            if (sim[9] != '*' && strncmp(sim - 6, "const ", 6) != 0) break;
        if (!sim || sim > end) continue;
        const char *name = open;
        while (name[-1] != ' ' && name[-1] != '*') name--;
        if (!is_listed(name, (size_t)(open - name)))
            fail_msg("%.*s is in neither list of tests/shadow/setter_calls.h", (int)(open - name),
                     name);
        found++;
    }
    return found;
}

static void every_function_is_listed(void **state)
{
    char path[512];
    int found = 0;
    (void)state;
    DIR *headers = opendir(MPS_HEADERS);
    assert_non_null(headers);
    for (struct dirent *e; (e = readdir(headers)) != NULL;) {
        char *text = calloc(1, 1 << 18);
        if (strlen(e->d_name) > 2 && strcmp(e->d_name + strlen(e->d_name) - 2, ".h") == 0) {
            snprintf(path, sizeof path, "%s/%s", MPS_HEADERS, e->d_name);
            FILE *f = fopen(path, "r");
            assert_true(f && text && fread(text, 1, (1 << 18) - 1, f) < (1 << 18) - 1);
            fclose(f);
            found += check_header(text);
        }
        free(text);
    }
    closedir(headers);
    int functions = OTHERS;
    for (int k = 0; k < SETTERS; k++)
        functions += k == 0 || strcmp(setters[k].name, setters[k - 1].name) != 0;
    assert_int_equal(found, functions); /* no listed function is missing in the headers */
}

/* ---- what a call copies ---------------------------------------------------------------------- */

static int64_t bytes_of(const mps_sim *sim, int32_t fields)
{
    const int64_t number = sim->world.particles.n * (int64_t)sizeof(double),
                  vector = number * sim->world.setup.dim;
    return (fields & X ? vector : 0) + (fields & U ? vector : 0) + (fields & RHO ? number : 0) +
           (fields & MARK ? 2 * number : 0) + (fields & P ? number : 0);
}

static bool is_invalid(mps_sim *sim, int32_t field)
{
    const mps__array *a = &sim->world.particles.field[field].array;
    return a->bytes > 0 && !mps__array_valid(a, MPS__ON_DEVICE);
}

/* After a call the written fields are stale on the device, in addition to those that were
 * before. */
static void check_fields(mps_sim *sim, const setter *r, const bool *before)
{
    static const struct {
        const char *name;
        int32_t field;
    } known[] = {
        {"position", X}, {"velocity", U}, {"density", RHO}, {"mark", MARK}, {"pressure", P}};
    const mps__particles *s = &sim->world.particles;
    for (int32_t k = 0; k < s->fields; k++) {
        int32_t field = 0;
        for (int i = 0; i < 5; i++)
            if (strcmp(known[i].name, s->field[k].name) == 0) field = known[i].field;
        if (is_invalid(sim, k) != (before[k] || r->up & field))
            fail_msg("%s() %s '%s' on the device", r->name,
                     is_invalid(sim, k) ? "invalidates" : "does not invalidate", s->field[k].name);
    }
}

/* A call and, if `steps`, the step after it; NULL: the step alone. */
static traffic measure(mps_sim *sim, const shadow *s, const setter *r, bool steps)
{
    bool invalid[MPS__FIELDS_MAX] = {false};
    const traffic before = {s->bytes_up, s->bytes_down};
    for (int32_t k = 0; r && k < sim->world.particles.fields; k++) invalid[k] = is_invalid(sim, k);
    if (r) ASSERT_OK(sim, r->call(sim));
    if (r) check_fields(sim, r, invalid);
    const traffic called = {s->bytes_up - before.up, s->bytes_down - before.down};
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    return steps ? (traffic){s->bytes_up - before.up, s->bytes_down - before.down} : called;
}

/* A half-full tank at rest, with a field of the user. `closed`: protect the memory of the handle
 * while loops run on a shadow; not with threads of the handle, which poll it for work. */
static mps_sim *new_tank(int32_t dim, bool closed)
{
    mps_sim *sim = new_sim(dim, dim == 2 ? 0.03 : 0.1);
    if (closed) shadow_heap(sim);
    add_tank(sim, 0.6, 0.6, 0.4);
    fill_depth(sim, 0.6, 0.3, 0.4);
    ASSERT_OK(sim, mps_field_add(sim, "mark", 2));
    return sim;
}

static mps_sim *before_call(const setter *r, int32_t dim, shadow *s)
{
    mps_sim *sim = new_tank(dim, s && r->call != set_threads);
    if (r->before) ASSERT_OK(sim, r->before(sim));
    if (s) shadow_attach(s, sim);
    go(sim, 3);
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    return sim;
}

/* The same step without a call. */
static traffic measure_alone(const setter *r, int32_t dim)
{
    shadow s;
    mps_sim *sim = before_call(r, dim, &s);
    const traffic plain = measure(sim, &s, NULL, !r->solves);
    mps_sim_destroy(sim);
    return plain;
}

static void check_setter(const setter *r, int32_t dim, traffic plain)
{
    shadow s;
    mps_sim *sim = before_call(r, dim, &s), *host = before_call(r, dim, NULL);
    const int64_t searches = sim->world.lists.neighbours.searches;
    const traffic set = measure(sim, &s, r, !r->solves);
    ASSERT_OK(host, r->call(host));
    ASSERT_OK(host, mps_step(host, 1e-3, NULL));
    assert_int_equal(sim->world.lists.neighbours.searches, searches); /* it would hide the rest */
    assert_true(bytes_of(sim, RHO) > SLACK);
    const int64_t up = set.up - plain.up, down = set.down - plain.down;
    if (getenv("MPS_TEST_PRINT"))
        printf("%-28s %dD up %6lld down %6lld; alone %lld, %lld\n", r->name, (int)dim,
               (long long)up, (long long)down, (long long)plain.up, (long long)plain.down);
    if (up > bytes_of(sim, r->up) + SLACK || down > bytes_of(sim, r->down) + SLACK)
        fail_msg("%s() and the next step copy %lld bytes more up and %lld more down: at most "
                 "%lld and %lld are of what it changes",
                 r->name, (long long)up, (long long)down, (long long)bytes_of(sim, r->up) + SLACK,
                 (long long)bytes_of(sim, r->down) + SLACK);
    go(host, 2);
    go(sim, 2);
    same(host, sim);
    same_memory(host, sim);
    mps_sim_destroy(sim);
    mps_sim_destroy(host);
    assert_int_equal(s.blocks, 0);
}

static void setters_copy_what_they_change(void **state)
{
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) {
        const traffic plain = measure_alone(&setters[0], dim);
        for (int k = 0; k < SETTERS; k++) {
            const setter *r = &setters[k];
            const bool alike = !r->before && !r->solves;
            check_setter(r, dim, alike ? plain : measure_alone(r, dim));
        }
    }
}

/* Before the first step all values are on the host: a call copies nothing. */
static void before_the_first_step(void **state)
{
    (void)state;
    for (int k = 0; k < SETTERS; k++) {
        shadow s;
        mps_sim *sim = new_tank(2, setters[k].call != set_threads), *host = new_tank(2, false);
        shadow_attach(&s, sim);
        mps_sim *side[] = {host, sim};
        const bool first = setters[k].call == set_centre || setters[k].call == set_kernel;
        for (int i = 0; i < 2 && !first; i++) {
            if (setters[k].before) ASSERT_OK(side[i], setters[k].before(side[i]));
            ASSERT_OK(side[i], setters[k].call(side[i]));
        }
        for (int i = 0; i < 2 && first; i++) {
            const double centre[2] = {0.3, 0.3};
            mps_kernel kernel = {.struct_size = sizeof kernel};
            assert_int_equal(mps_kernel_find("original", &kernel), MPS_OK);
            ASSERT_OK(side[i], mps_motion_centre_set(side[i], centre, MPS_START_WITH_TANK));
            ASSERT_OK(side[i], mps_kernel_use(side[i], &kernel));
        }
        assert_int_equal(s.uploads + s.downloads, 0);
        go(host, 3);
        go(sim, 3);
        same(host, sim);
        same_memory(host, sim);
        mps_sim_destroy(host);
        mps_sim_destroy(sim);
    }
}

/* ---- coupled runs ---------------------------------------------------------------------------- */

enum { COUPLED_STEPS = 20 };
static const double coupled_dt = 8e-3; /* [s] */

/* The way of a tank that another program computes. */
static int ship(void *user, double t, mps_motion_state *state)
{
    (void)user;
    state->value[MPS_MOVE_X] = 0.02 * (1 - cos(8 * t));
    state->rate[MPS_MOVE_X] = 0.16 * sin(8 * t);
    state->accel[MPS_MOVE_X] = 1.28 * cos(8 * t);
    state->value[MPS_ROTATE_Z] = 0.1 * (1 - cos(5 * t));
    state->rate[MPS_ROTATE_Z] = 0.5 * sin(5 * t);
    state->accel[MPS_ROTATE_Z] = 2.5 * cos(5 * t);
    return 0;
}

static void limit_step(mps_sim *sim)
{
    STRUCT(mps_time_control, t);
    t.dt = coupled_dt;
    ASSERT_OK(sim, mps_time_control_set(sim, &t));
}

/* What a program sets before each step. */
static void set_by_poses(mps_sim *sim)
{
    STRUCT(mps_motion_state, s);
    double t;
    ASSERT_OK(sim, mps_sim_time(sim, &t, NULL));
    assert_int_equal(ship(NULL, t + coupled_dt, &s), 0);
    ASSERT_OK(sim, mps_motion_pose_set(sim, t + coupled_dt, &s));
    ASSERT_OK(sim, mps_model_set(sim, "collision", "distance", 0.9));
    ASSERT_OK(sim, mps_load_watch(sim, MPS_LOAD_FORCE));
    limit_step(sim);
}

static void set_nothing(mps_sim *sim)
{
    (void)sim;
}

/* Springs that another program changes. */
static void set_body_again(mps_sim *sim)
{
    ASSERT_OK(sim, set_body(sim));
    limit_step(sim);
}

static void begin_by_function(mps_sim *sim)
{
    ASSERT_OK(sim, mps_motion_callback_set(sim, ship, NULL));
    ASSERT_OK(sim, mps_load_watch(sim, MPS_LOAD_FORCE));
    ASSERT_OK(sim, mps_model_set(sim, "collision", "distance", 0.9));
}

static void begin_by_body(mps_sim *sim)
{
    ASSERT_OK(sim, set_body(sim));
    ASSERT_OK(sim, mps_load_watch(sim, MPS_LOAD_FORCE));
}

/* `alike`: without setters the steps solve the same equations. A rigid body that is set again
 * discards its delayed load. */
typedef struct coupling {
    const char *name;
    void (*begin)(mps_sim *sim), (*each)(mps_sim *sim);
    bool alike;
} coupling;

static const coupling couplings[] = {{"poses", set_nothing, set_by_poses, true},
                                     {"a body", begin_by_body, set_body_again, false}},
                      uncoupled[] = {{"a function", begin_by_function, set_nothing, true},
                                     {"a body", begin_by_body, set_nothing, false}};
enum { COUPLINGS = sizeof couplings / sizeof couplings[0] };

static mps_sim *coupled(int32_t dim, const coupling *c, shadow *s)
{
    mps_sim *sim = new_tank(dim, s != NULL);
    limit_step(sim);
    c->begin(sim);
    if (s) shadow_attach(s, sim);
    return sim;
}

/* Fields that are valid on the device; -1: all are uploaded again. */
static int64_t count_valid(mps_sim *sim)
{
    int64_t valid = 0;
    for (int32_t k = 0; k < sim->world.particles.fields; k++) valid += !is_invalid(sim, k);
    return valid;
}

/* Set, step and ask for the load, as a coupled program does. */
static traffic coupled_step(mps_sim *sim, const coupling *c, const shadow *s)
{
    STRUCT(mps_load, load);
    const traffic before = s ? (traffic){s->bytes_up, s->bytes_down} : (traffic){0, 0};
    const int64_t valid = s ? count_valid(sim) : 0;
    c->each(sim);
    if (s) assert_true(s->bytes_up == before.up && s->bytes_down == before.down);
    if (s) assert_int_equal(count_valid(sim), valid);
    ASSERT_OK(sim, mps_step(sim, coupled_dt, NULL));
    ASSERT_OK(sim, mps_load_get(sim, NULL, &load));
    return s ? (traffic){s->bytes_up - before.up, s->bytes_down - before.down} : before;
}

static void couple(int32_t dim, int k)
{
    shadow s, t;
    mps_sim *sim = coupled(dim, &couplings[k], &s), *alone = coupled(dim, &uncoupled[k], &t),
            *host = coupled(dim, &couplings[k], NULL);
    const mps_neighbours *l = &sim->world.lists.neighbours;
    for (int step = 0; step < COUPLED_STEPS; step++) {
        const traffic plain = coupled_step(alone, &uncoupled[k], &t),
                      set = coupled_step(sim, &couplings[k], &s);
        coupled_step(host, &couplings[k], NULL);
        if (getenv("MPS_TEST_PRINT"))
            printf("%s, %dD, step %d, search %lld: %lld up, %lld down; without setters %lld, "
                   "%lld\n",
                   couplings[k].name, (int)dim, step, (long long)l->searches, (long long)set.up,
                   (long long)set.down, (long long)plain.up, (long long)plain.down);
        if (!couplings[k].alike) continue;
        assert_int_equal(l->searches, alone->world.lists.neighbours.searches);
        if (set.up > plain.up + SLACK || set.down > plain.down + SLACK)
            fail_msg("%s, step %d: %lld bytes up, %lld down; without setters %lld, %lld",
                     couplings[k].name, step, (long long)set.up, (long long)set.down,
                     (long long)plain.up, (long long)plain.down);
    }
    assert_true(dim == 3 || l->searches > 2); /* those of the first step, and a later one */
    same(host, sim);
    same_memory(host, sim);
    mps_sim_destroy(sim);
    mps_sim_destroy(alone);
    mps_sim_destroy(host);
    assert_int_equal(s.blocks, 0);
}

static void coupled_runs(void **state)
{
    (void)state;
    for (int k = 0; k < COUPLINGS; k++)
        for (int32_t dim = 2; dim <= 3; dim++) couple(dim, k);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_function_is_listed),
        cmocka_unit_test(setters_copy_what_they_change),
        cmocka_unit_test(before_the_first_step),
        cmocka_unit_test(coupled_runs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

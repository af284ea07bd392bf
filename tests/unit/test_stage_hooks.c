/* SPDX-License-Identifier: BSD-3-Clause */
/* Each public function of a stage in each hook: a correct result, or an error with the name of the
 * function; never a crash. */
#include "model_fixture.h"
#include <mps/reaction.h>
#include <mps/voids.h>
#include <stdio.h>
#include <stdlib.h>

enum { ALL = (1 << MPS_HOOK_COUNT) - 1, AFTER_SEARCH = ALL & ~(1 << MPS_POPULATE) };
#define FROM(hook) (ALL & ~((1 << (hook)) - 1))

/* Result of a call: compared between hooks. */
static double given;

static int32_t *mark_fluid(mps_stage *s, int32_t value)
{
    int32_t *m = mps_stage_scratch_integers(s, s->view->n);
    for (int64_t i = 0; m && i < s->view->n; i++) m[i] = mps_is_fluid(s->view, i) ? value : 0;
    return m;
}

static void count(const mps_stage *s, const int32_t *m)
{
    for (int64_t i = 0; i < s->view->n; i++) given += (double)(i + 1) * m[i];
}

static int adds(mps_stage *s)
{
    const double x[2] = {0.2, 0.27}, u[2] = {0};
    return mps_stage_add(s, 0, 1, x, u);
}

static int removes(mps_stage *s)
{
    return mps_stage_remove(s, mark_fluid(s, 0));
}

static int looks_beside(mps_stage *s)
{
    int32_t *m = mark_fluid(s, 1), *beside = mps_stage_scratch_integers(s, s->view->n);
    const int failed = mps_stage_adjacent(s, m, beside);
    if (!failed) count(s, beside);
    return failed;
}

static int finds_bodies(mps_stage *s)
{
    int32_t *m = mark_fluid(s, MPS_BODY_SEED), *body = mps_stage_scratch_integers(s, s->view->n);
    const int failed = mps_stage_bodies(s, 1000, m, body);
    if (!failed) count(s, body);
    return failed;
}

static int densities(mps_stage *s)
{
    double least[MPS_PHASES], greatest[MPS_PHASES];
    mps_stage_densities(s, least, greatest);
    given = least[0] + greatest[0];
    mps_stage_densities(s, NULL, NULL);
    return 0;
}

static int fails(mps_stage *s)
{
    return mps_stage_fail(s, "mps_stage_fail: %d", 1);
}

static int gas(mps_stage *s)
{
    return mps_stage_gas(s, 0, 0, 0, 0);
}

static int grid(mps_stage *s)
{
    mps_grid g;
    mps_grid_init(&g, sizeof g);
    const int failed = mps_stage_grid(s, 0.1, &g);
    for (int64_t b = 0; !failed && b < g.buckets; b++)
        for (int64_t r = g.first[b] - 1; r >= 0; r = g.next[r] - 1) given += (double)s->view->id[r];
    return failed;
}

static int kinetic(mps_stage *s)
{
    return mps_stage_kinetic(s, 0);
}

typedef struct no_fields {
    double *own;
} no_fields;

MPS_ROW void write_row(const int dim, const mps_view *v, const no_fields *f, int64_t i)
{
    (void)dim, (void)v;
    f->own[i] = (double)i;
}
MPS_ROWS(write_rows, write_row, no_fields)

MPS_ROW void one(const int dim, const mps_view *v, const no_fields *f, int64_t i, double *term)
{
    (void)dim, (void)f, (void)i;
    term[0] = mps_is_fluid(v, i);
}
MPS_SUMS(ones, one, no_fields)

static int loops(mps_stage *s)
{
    const no_fields f = {mps_stage_scratch(s, s->view->n)};
    mps_stage_rows(s, &write_rows, &f);
    for (int64_t i = 0; i < s->view->n; i++) given += f.own[i];
    return 0;
}

static int sums(mps_stage *s)
{
    mps_stage_sum(s, 1, &ones, &(no_fields){NULL}, &given);
    return 0;
}

static int maxima(mps_stage *s)
{
    given = -INFINITY;
    mps_stage_max(s, 1, &ones, &(no_fields){NULL}, &given);
    return 0;
}

static int reaction(mps_stage *s)
{
    return mps_stage_reaction(s, NULL, mps_stage_scratch(s, s->view->n * s->view->dim));
}

static int refreshes(mps_stage *s)
{
    const mps_shared a = {mps_stage_scratch(s, s->view->n), 1, MPS_TYPE_REAL};
    return mps_stage_refresh(s, 1, &a);
}

static int scratch(mps_stage *s)
{
    const double *a = mps_stage_scratch(s, s->view->n);
    const int32_t *b = mps_stage_scratch_integers(s, s->view->n);
    for (int64_t i = 0; i < s->view->n; i++) given += a[i] + b[i];
    return 0;
}

static int state(mps_stage *s)
{
    return mps_stage_state(s, 3) == NULL;
}

static int state_get(mps_stage *s)
{
    int64_t n = -1;
    mps_stage_state_get(s, &n);
    given = (double)n;
    return 0;
}

static int voids(mps_stage *s)
{
    mps_voids v;
    mps_voids_init(&v, sizeof v);
    return mps_stage_voids(s, NULL, &v);
}

/* Arrays that are missing. */
static int beside_nothing(mps_stage *s)
{
    return mps_stage_adjacent(s, NULL, mark_fluid(s, 0));
}

static int beside_nowhere(mps_stage *s)
{
    return mps_stage_adjacent(s, mark_fluid(s, 0), NULL);
}

static int bodies_of_nothing(mps_stage *s)
{
    return mps_stage_bodies(s, 9, NULL, mark_fluid(s, 0));
}

static int bodies_nowhere(mps_stage *s)
{
    return mps_stage_bodies(s, 9, mark_fluid(s, 0), NULL);
}

static int removes_nothing(mps_stage *s)
{
    return mps_stage_remove(s, NULL);
}

static int reaction_of_nothing(mps_stage *s)
{
    return mps_stage_reaction(s, NULL, NULL);
}

static int grid_nowhere(mps_stage *s)
{
    return mps_stage_grid(s, 0.1, NULL);
}

static int voids_nowhere(mps_stage *s)
{
    return mps_stage_voids(s, NULL, NULL);
}

typedef struct call {
    const char *name;
    int (*run)(mps_stage *s);
    int hooks; /* bits of those where it succeeds */
} call;

static const call calls[] = {
    {"mps_stage_add", adds, 1 << MPS_POPULATE},
    {"mps_stage_remove", removes, 1 << MPS_POPULATE},
    {"mps_stage_adjacent", looks_beside, AFTER_SEARCH},
    {"mps_stage_bodies", finds_bodies, AFTER_SEARCH},
    {"mps_stage_densities", densities, ALL},
    {"mps_stage_fail", fails, 0},
    {"mps_stage_gas", gas, 1 << MPS_SHIFT},
    {"mps_stage_grid", grid, ALL},
    {"mps_stage_kinetic", kinetic, 1 << MPS_FORCE | 1 << MPS_VELOCITY},
    {"mps_stage_rows", loops, ALL},
    {"mps_stage_sum", sums, ALL},
    {"mps_stage_max", maxima, ALL},
    {"mps_stage_reaction", reaction, 1 << MPS_FORCE | 1 << MPS_VELOCITY},
    {"mps_stage_refresh", refreshes, ALL},
    {"mps_stage_scratch", scratch, ALL},
    {"mps_stage_scratch_integers", scratch, ALL},
    {"mps_stage_state", state, AFTER_SEARCH},
    {"mps_stage_state_get", state_get, ALL},
    {"mps_stage_voids", voids, FROM(MPS_PREPARE)},
    {"mps_stage_adjacent", beside_nothing, 0},
    {"mps_stage_adjacent", beside_nowhere, 0},
    {"mps_stage_bodies", bodies_of_nothing, 0},
    {"mps_stage_bodies", bodies_nowhere, 0},
    {"mps_stage_remove", removes_nothing, 0},
    {"mps_stage_reaction", reaction_of_nothing, 0},
    {"grid", grid_nowhere, 0},
    {"voids", voids_nowhere, 0},
};
enum { CALLS = sizeof calls / sizeof calls[0] };

static const call *playing;
static int played;

static int play(mps_stage *s)
{
    played++;
    given = 0;
    return playing->run(s);
}

static mps_sim *pool(void)
{
    mps_sim *sim = new_sim(2, 0.05);
    add_tank(sim, 0.4, 0.3, 0);
    fill_depth(sim, 0.4, 0.2, 0);
    return sim;
}

/* @return result of the call; NaN if it failed as expected */
static double play_in(const call *c, int hook)
{
    const mps_verb verb[] = {{.hook = hook, .run = play}};
    const mps_model_ops ops = {TOY("player.toy", 1, verb)};
    mps_sim *sim = pool();
    use_model(sim, &ops);
    playing = c;
    played = 0;
    const mps_status status = mps_step(sim, 1, NULL);
    assert_int_equal(played, 1);
    if (status != (c->hooks >> hook & 1 ? MPS_OK : MPS_E_PLUGIN) ||
        (status < 0 && !strstr(mps_sim_error(sim), c->name)))
        fail_msg("%s in hook %d: %s, '%s'", c->name, hook, mps_status_name(status),
                 mps_sim_error(sim));
    const double got = given;
    if (status == MPS_OK) ASSERT_OK(sim, mps_step(sim, 1, NULL));
    mps_sim_destroy(sim);
    return status == MPS_OK ? got : NAN;
}

/* Particles move at the end of a step: until then each hook sees the same. */
static void each_call_in_each_hook(void **state)
{
    (void)state;
    for (int k = 0; k < CALLS; k++) {
        double first = NAN;
        for (int hook = 0; hook < MPS_HOOK_COUNT; hook++) {
            const double got = play_in(&calls[k], hook);
            if (isnan(first)) first = got;
            if (!isnan(got) && got != first)
                fail_msg("%s gives %g in hook %d, and %g before", calls[k].name, got, hook, first);
        }
    }
}

/* All functions of the headers are in the table. */
static void none_is_missing(void **state)
{
    static const char *const headers[] = {"stage.h", "model.h", "voids.h", "reaction.h"};
    (void)state;
    for (size_t h = 0; h < sizeof headers / sizeof headers[0]; h++) {
        char path[512], line[512];
        snprintf(path, sizeof path, "%s/%s", MPS_HEADERS, headers[h]);
        FILE *in = fopen(path, "r");
        assert_non_null(in);
        while (fgets(line, sizeof line, in)) {
            const char *name = strstr(line, "mps_stage_");
            if (strncmp(line, "MPS_API", 7) != 0 || !name) continue;
            const size_t length = strcspn(name, "(");
            int found = 0;
            for (int k = 0; k < CALLS; k++)
                found += strlen(calls[k].name) == length && !strncmp(calls[k].name, name, length);
            if (!found) fail_msg("no call of %.*s", (int)length, name);
        }
        fclose(in);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(each_call_in_each_hook),
                                       cmocka_unit_test(none_is_missing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

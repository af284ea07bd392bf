/* SPDX-License-Identifier: BSD-3-Clause */
/* separation.void and the solution with least pressures (bounds.c): walls next to void have no
 * suction, necessary suction is kept. */
#define _POSIX_C_SOURCE 200809L
#include "tank_fixture.h"
#include <mps/model.h>
#include <stdbool.h>
#include <stdlib.h>
#include <unistd.h>

/* after cmocka.h */
#include "../turns.h"

static const double GRAVITY = 9.81, RHO = 1000;

/* Of the steps so far. */
static struct {
    double least;      /* lowest pressure of walls next to void, over that of a static liquid with
                          the near radius as depth */
    double suction;    /* sum of -p dt over all walls that count, where p < 0 [Pa s] */
    const bool *among; /* by id: walls that count; NULL: all */
    int64_t seen;      /* pressures of walls next to void */
} spy;

enum { PRESSURE, REGION, TANK_ACCELERATION, USES };
static const mps_use uses[USES] = {[PRESSURE] = {"pressure", MPS_USE_READ},
                                   [REGION] = {"region", MPS_USE_NEIGHBOURS},
                                   [TANK_ACCELERATION] = {"tank_acceleration", MPS_USE_READ}};

static bool sees_void(const mps_view *v, const int32_t *region, int64_t i)
{
    bool seen = false;
    for (int64_t p = v->near.begin[i]; p < v->near.end[i]; p++) {
        const int64_t j = v->near.col[p];
        seen = seen || (v->kind[j] == MPS_FLUID && region[j] >= MPS_REGION_SURFACE) ||
               (v->kind[j] == MPS_WALL && region[j] == MPS_REGION_DRY);
    }
    return seen;
}

static int look(mps_stage *s)
{
    const mps_view *v = s->view;
    const double *pressure = s->data[PRESSURE], *tank = s->data[TANK_ACCELERATION];
    const int32_t *region = s->data[REGION];
    for (int64_t i = 0; i < v->n; i++) {
        double b = 0;
        if (v->kind[i] != MPS_WALL || region[i] != MPS_REGION_INNER) continue;
        if (spy.among && !spy.among[v->id[i]]) continue;
        spy.suction -= v->dt * fmin(0, pressure[i]);
        if (!sees_void(v, region, i)) continue;
        for (int d = 0; d < v->dim; d++) b += pow(v->g[d] - tank[i * v->dim + d], 2);
        spy.least = fmin(spy.least, pressure[i] / (RHO * sqrt(b) * v->near.re));
        spy.seen++;
    }
    return 0;
}

static const mps_verb spy_verbs[] = {
    {.hook = MPS_GRADIENT, .use_count = USES, .uses = uses, .after = "*", .run = look}};
static const mps_model_ops spy_model = {.struct_size = sizeof(mps_model_ops),
                                        .api = MPS_MODEL_API,
                                        .name = "after.spy",
                                        .help = "keeps the suction of walls",
                                        .verb_count = 1,
                                        .verbs = spy_verbs};

/* ---- scenes ---- */

typedef enum scene { PULLED, EDGE, PLATE } scene;

/* A stream that runs against a box on the floor and over its edge. */
static void stream(mps_sim *sim)
{
    const int32_t *kind;
    mps_lease u = {.struct_size = sizeof u};
    ASSERT_OK(sim, tags_peek(sim, NULL, &kind, NULL, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &u));
    for (int64_t i = 0; i < u.count; i++)
        if (kind[i] == MPS_FLUID) u.data[i * u.stride] = 3;
    ASSERT_OK(sim, mps_lease_end(sim, &u));
}

static mps_sim *build(scene what, int32_t dim)
{
    const double dp = 0.04, across = dim == 3 ? 0.24 : 0, lo[3] = {0, 0, 0},
                 hi[3] = {what == EDGE ? 0.48 : 0.8, 0.32, across};
    const double box_lo[3] = {0.5, 0, 0}, box_hi[3] = {0.7, 0.2, across}, foot[3] = {0.4, 0, 0},
                 up[3] = {0, 0.24, 0}, along[3] = {0, 0, across};
    mps_sim *sim = new_sim(dim, dp);
    add_tank(sim, what == EDGE ? 1.2 : 0.8, 0.64, across);
    if (what == EDGE) ASSERT_OK(sim, mps_baffle_add(sim, "box", box_lo, box_hi, NULL));
    if (what == PLATE)
        ASSERT_OK(sim, mps_plate_add(sim, "plate", foot, up, dim == 3 ? along : NULL));
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    if (what == EDGE)
        stream(sim);
    else
        ASSERT_OK(sim, mps_motion_callback_set(sim, pull_away, NULL));
    return sim;
}

static void watch(mps_sim *sim, const bool *among)
{
    ASSERT_OK(sim, mps_model_register(sim, &spy_model));
    ASSERT_OK(sim, mps_model_use(sim, "after.spy"));
    spy.least = spy.suction = 0;
    spy.seen = 0;
    spy.among = among;
}

/* @return most walls at their least pressure in a step */
static int32_t run_to(mps_sim *sim, double t)
{
    mps_step_info info;
    int32_t most = 0;
    assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
    while (info.t < t * (1 - 1e-12)) {
        ASSERT_OK(sim, mps_step(sim, t - info.t, &info));
        most = info.separated > most ? info.separated : most;
    }
    return most;
}

/* ---- no suction next to void ---- */

/* Walls of a scene within the box from lo to hi; free() them. */
static bool *walls_between(mps_sim *sim, const double *lo, const double *hi)
{
    const int64_t *id;
    const int32_t *kind;
    mps_lease x = {.struct_size = sizeof x};
    int64_t count = 0;
    ASSERT_OK(sim, tags_peek(sim, &id, &kind, NULL, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
    bool *among = calloc((size_t)x.count, sizeof *among);
    assert_non_null(among);
    for (int64_t i = 0; i < x.count; i++) {
        bool in = kind[i] == MPS_WALL;
        for (int d = 0; d < 2; d++)
            in = in && x.data[i * x.stride + d] >= lo[d] && x.data[i * x.stride + d] <= hi[d];
        among[id[i]] = in;
        count += in;
    }
    ASSERT_OK(sim, mps_lease_end(sim, &x));
    assert_true(count > 3);
    return among;
}

/* With the model the walls between lo and hi do not pull; without it they do. */
static void pulls_only_without(scene what, int32_t dim, double t, const double *lo,
                               const double *hi)
{
    for (int with = 0; with < 2; with++) {
        mps_sim *sim = build(what, dim);
        bool *among = walls_between(sim, lo, hi);
        watch(sim, among);
        if (!with) ASSERT_OK(sim, mps_model_remove(sim, "separation"));
        const int32_t separated = run_to(sim, t);
        assert_true(spy.seen > 0);
        if (with && !(spy.least > -1.01 && separated > 0))
            fail_msg("walls pull: %g, %d have let go", spy.least, separated);
        if (!with && !(spy.least < -1.5 && separated == 0))
            fail_msg("nothing to let go of: %g", spy.least);
        mps_sim_destroy(sim);
        free(among);
    }
}

static void wall_that_leaves(void **state)
{
    (void)state;
    const double lo[2] = {-0.01, 0.02}, hi[2] = {0.01, 0.6};
    pulls_only_without(PULLED, 2, 0.2, lo, hi);
    pulls_only_without(PULLED, 3, 0.2, lo, hi);
}

static void edge_of_a_box(void **state)
{
    (void)state;
    const double lo[2] = {0.45, 0.1}, hi[2] = {0.75, 0.25};
    pulls_only_without(EDGE, 2, 0.2, lo, hi);
    pulls_only_without(EDGE, 3, 0.2, lo, hi);
}

static void plate_that_leaves(void **state)
{
    (void)state;
    const double lo[2] = {0.39, 0.1}, hi[2] = {0.41, 0.3};
    pulls_only_without(PLATE, 2, 0.2, lo, hi);
    pulls_only_without(PLATE, 3, 0.2, lo, hi);
}

/* ---- the least pressure ---- */

enum { DENSITY, NEAR_REGION, TANK, CONDITION, VALUE, LEAST_USES };
static const mps_use least_uses[LEAST_USES] = {[DENSITY] = {"density", MPS_USE_NEIGHBOURS},
                                               [NEAR_REGION] = {"region", MPS_USE_NEIGHBOURS},
                                               [TANK] = {"tank_acceleration", MPS_USE_READ},
                                               [CONDITION] = {"pressure_condition", MPS_USE_READ},
                                               [VALUE] = {"pressure_value", MPS_USE_READ}};

/* Walls so far with a least pressure of 0, with a lower one, without any. */
static struct {
    int64_t zero, below, none;
} limits;

/* For wall i by all particles within the near radius; INFINITY: no void there. */
static double least_pressure(const mps_stage *s, int64_t i)
{
    const mps_view *v = s->view;
    const double *rho = s->data[DENSITY], *tank = (const double *)s->data[TANK] + i * v->dim;
    const int32_t *region = s->data[NEAR_REGION];
    double least = INFINITY;
    for (int64_t j = 0; j < v->n; j++) {
        double r2 = 0, head = 0;
        for (int d = 0; d < v->dim; d++) {
            const double r = v->x[j * v->dim + d] - v->x[i * v->dim + d];
            r2 += r * r;
            head -= rho[j] * (v->g[d] - tank[d]) * r;
        }
        if (i == j || r2 >= v->near.re * v->near.re) continue;
        if (v->kind[j] == MPS_FLUID && region[j] == MPS_REGION_SURFACE)
            least = fmin(least, fmin(0, head));
        else if (v->kind[j] != MPS_DUMMY && region[j] >= MPS_REGION_SPRAY)
            least = fmin(least, 0);
    }
    return least;
}

static int compare(mps_stage *s)
{
    const double *value = s->data[VALUE];
    const int32_t *region = s->data[NEAR_REGION], *condition = s->data[CONDITION];
    for (int64_t i = 0; i < s->view->n; i++) {
        if (s->view->kind[i] != MPS_WALL || region[i] != MPS_REGION_INNER) continue;
        const double least = least_pressure(s, i);
        assert_int_equal(condition[i], least <= 0 ? MPS_ROW_LEAST : MPS_ROW_FREE);
        if (least <= 0) ASSERT_NEAR(value[i], least, 1e-9 * RHO * GRAVITY * s->view->dp);
        limits.zero += least == 0;
        limits.below += least < 0;
        limits.none += least > 0;
    }
    return 0;
}

static const mps_verb least_verbs[] = {{.hook = MPS_SOURCE,
                                        .use_count = LEAST_USES,
                                        .uses = least_uses,
                                        .after = "*",
                                        .run = compare}};
static const mps_model_ops least_model = {.struct_size = sizeof(mps_model_ops),
                                          .api = MPS_MODEL_API,
                                          .name = "after.least",
                                          .help = "compares the least pressures of walls",
                                          .verb_count = 1,
                                          .verbs = least_verbs};

/* In a tank that is pulled and in a stream over an edge. */
static void least_by_all_particles(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        mps_sim *sim = build(k % 2 ? EDGE : PULLED, 2 + k / 2);
        ASSERT_OK(sim, mps_model_register(sim, &least_model));
        ASSERT_OK(sim, mps_model_use(sim, "after.least"));
        memset(&limits, 0, sizeof limits);
        run_to(sim, 0.06);
        assert_true(limits.zero > 0 && limits.below > 0 && limits.none > 0);
        mps_sim_destroy(sim);
    }
}

/* ---- suction that must stay ---- */

/* A tank filled to `depth` that starts with a velocity, its liquid at rest. */
static mps_sim *jumping(int32_t dim, double depth)
{
    const double across = dim == 3 ? 0.24 : 0;
    const mps_harmonic surge = {.dof = MPS_MOVE_X, .amplitude = 0.2, .omega = 5};
    mps_sim *sim = new_sim(dim, 0.04);
    add_tank(sim, 0.8, 0.48, across);
    fill_depth(sim, 0.8, depth, across);
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &surge));
    return sim;
}

/* Sum of p dt over the wall that moves away from the liquid, where p < 0, in the first steps of a
 * jump; hold < 0: without the model. */
static double suction_of_jump(int32_t dim, double hold)
{
    const double lo[2] = {0.79, 0.02}, hi[2] = {0.81, 0.4};
    mps_sim *sim = jumping(dim, 0.32);
    bool *among = walls_between(sim, lo, hi);
    watch(sim, among);
    if (hold < 0)
        ASSERT_OK(sim, mps_model_remove(sim, "separation"));
    else
        ASSERT_OK(sim, mps_model_set(sim, "separation", "hold", hold));
    for (int k = 0; k < 5; k++) ASSERT_OK(sim, mps_step(sim, 1, NULL));
    mps_sim_destroy(sim);
    free(among);
    return spy.suction;
}

static void jump_keeps_its_suction(void **state)
{
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) {
        const double without = suction_of_jump(dim, -1), held = suction_of_jump(dim, 5),
                     at_once = suction_of_jump(dim, 0);
        assert_true(without > 0 && held == without);
        assert_true(at_once < 0.95 * without); /* so `hold` keeps it */
    }
}

/* A full tank has no pressure datum: none of its walls can have a lower bound. */
static void full_tank_pulls(void **state)
{
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) {
        double suction[2];
        for (int with = 0; with < 2; with++) {
            mps_sim *sim = jumping(dim, 0.48);
            watch(sim, NULL);
            if (!with) ASSERT_OK(sim, mps_model_remove(sim, "separation"));
            assert_int_equal(run_to(sim, 0.05), 0);
            suction[with] = spy.suction;
            mps_sim_destroy(sim);
        }
        assert_true(suction[0] > 0 && suction[0] == suction[1]);
    }
}

/* A step shortened by its caller is no jump: walls next to void are separated before it, in it and
 * after it. */
static void short_step_is_no_jump(void **state)
{
    (void)state;
    mps_sim *sim = build(PLATE, 2);
    mps_step_info info;
    assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
    run_to(sim, 0.19);
    for (int k = 0; k < 8; k++) {
        ASSERT_OK(sim, mps_step(sim, k == 4 ? 2e-4 : 1, &info));
        assert_true(info.separated > 0);
    }
    mps_sim_destroy(sim);
}

/* ---- state ---- */

/* Bitwise equal pressures, positions and velocities. */
static void assert_same(mps_sim *a, mps_sim *b)
{
    static const char *const fields[] = {"position", "velocity", "pressure"};
    for (int k = 0; k < 3; k++) {
        mps_lease x = {.struct_size = sizeof x}, y = {.struct_size = sizeof y};
        ASSERT_OK(a, mps_lease_begin(a, fields[k], MPS_READ, &x));
        ASSERT_OK(b, mps_lease_begin(b, fields[k], MPS_READ, &y));
        assert_int_equal(x.count, y.count);
        assert_memory_equal(x.data, y.data, (size_t)(x.count * x.stride) * sizeof *x.data);
        ASSERT_OK(a, mps_lease_end(a, &x));
        ASSERT_OK(b, mps_lease_end(b, &y));
    }
}

/* From a step with walls at their least pressure. */
static void checkpoint_goes_on(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        const scene what = k == 0 ? PLATE : k == 1 ? PULLED : EDGE;
        const int32_t dim = k == 1 ? 3 : 2;
        char path[] = "mps_separation_XXXXXX";
        const int file = mkstemp(path);
        mps_sim *sim = build(what, dim), *other = build(what, dim);
        mps_step_info info;
        assert_true(file >= 0);
        assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
        while (!(info.separated > 0 && info.t > 0.02)) {
            ASSERT_OK(sim, mps_step(sim, 1, &info));
            assert_true(info.t < 0.25);
        }
        ASSERT_OK(sim, mps_checkpoint_write(sim, path));
        ASSERT_OK(other, mps_checkpoint_read(other, path));
        for (int step = 0; step < 10; step++) {
            ASSERT_OK(sim, mps_step(sim, 1, NULL));
            ASSERT_OK(other, mps_step(other, 1, NULL));
            assert_same(sim, other);
        }
        mps_sim_destroy(sim);
        mps_sim_destroy(other);
        close(file);
        unlink(path);
    }
}

static void threads_do_not_matter(void **state)
{
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) {
        mps_sim *one = build(EDGE, dim), *two = build(EDGE, dim);
        ASSERT_OK(two, mps_threads_set(two, 2));
        assert_true(run_to(one, 0.1) > 0);
        assert_true(run_to(two, 0.1) > 0);
        assert_same(one, two);
        mps_sim_destroy(one);
        mps_sim_destroy(two);
    }
}

int main(void)
{
    struct CMUnitTest tests[] = {
        cmocka_unit_test(wall_that_leaves),       cmocka_unit_test(edge_of_a_box),
        cmocka_unit_test(plate_that_leaves),      cmocka_unit_test(least_by_all_particles),
        cmocka_unit_test(jump_keeps_its_suction), cmocka_unit_test(full_tank_pulls),
        cmocka_unit_test(short_step_is_no_jump),  cmocka_unit_test(checkpoint_goes_on),
        cmocka_unit_test(threads_do_not_matter),
    };
    take_turns(tests, sizeof tests / sizeof tests[0], 3);
    return cmocka_run_group_tests(tests, NULL, NULL);
}

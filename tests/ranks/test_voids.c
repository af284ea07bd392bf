/* SPDX-License-Identifier: BSD-3-Clause */
/* Voids on many ranks: the same grid as on one rank, and one rank has the row of each face with a
 * particle. Numbers of a model are preserved by a checkpoint between numbers of ranks. */
#define _POSIX_C_SOURCE 200809L
#include "../unit/void_fixture.h"
#include "kit_engine.h"
#include <stdbool.h>
#include <stdio.h>
#include <unistd.h>

enum { MOST = 4, STEPS = 8, FACES = 4000, CELLS = 20000 };

/* What one step found. */
typedef struct seen {
    int32_t count, size[16];
    int32_t label[CELLS];
    int64_t faces, id[FACES], cells;
    int32_t face[4][FACES];
} seen;

typedef struct run {
    int32_t dim, ranks;
    bool plate;
    kit_engine_team *team;       /* NULL: alone */
    seen *step;                  /* [STEPS] of rank 0 */
    int64_t (*id)[STEPS][FACES]; /* [ranks] */
    bool differs[MOST];
    char error[MOST][300];
} run;

static int in_tank(const double *X)
{
    return hypot(X[0] - 0.5, X[1] - 0.25) < 0.13 || (fabs(X[0] - 0.2) < 0.08 && X[1] < 0.09);
}

static int in_round(const double *X)
{
    return hypot(hypot(X[0] - 0.5, X[1] - 0.2), X[2] - 0.25) < 0.16;
}

static void build(mps_sim *sim, const run *k)
{
    const mps_harmonic roll = {.dof = MPS_ROTATE_Z, .amplitude = 0.1, .omega = 6};
    const double foot[2] = {0.7, 0}, edge[2] = {0.05, 0.7};
    add_tank(sim, 1, k->dim == 2 ? 0.7 : 0.5, 0.5);
    if (k->plate) ASSERT_OK(sim, mps_plate_add(sim, "plate", foot, edge, NULL));
    drawing d = {k->dim == 2 ? in_tank : in_round, 0.42, 1};
    ASSERT_OK(sim, mps_fill_add(sim, 0, is_drawn, &d, NULL));
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &roll));
}

static void note(run *k, int32_t rank, int step, const found_voids *f)
{
    seen *s = &k->step[step], own = {.count = f->v.count, .faces = f->v.faces};
    own.cells = cells_of(&f->v);
    if (own.count > 16 || own.faces > FACES || own.cells > CELLS) {
        snprintf(k->error[rank], sizeof k->error[rank], "too much is found");
        return;
    }
    memcpy(own.size, f->size, (size_t)own.count * sizeof *own.size);
    memcpy(own.label, f->label, (size_t)own.cells * sizeof *own.label);
    for (int d = 0; d < 4; d++)
        memcpy(own.face[d], f->face[d], (size_t)own.faces * sizeof *own.face[d]);
    memcpy(k->id[rank][step], f->face_id, (size_t)own.faces * sizeof *f->face_id);
    if (!k->team)
        *s = own;
    else
        k->differs[rank] = k->differs[rank] || s->count != own.count ||
                           memcmp(s->size, own.size, sizeof own.size) != 0 ||
                           memcmp(s->label, own.label, sizeof own.label) != 0 ||
                           s->faces != own.faces || memcmp(s->face, own.face, sizeof own.face) != 0;
}

static void run_rank(void *argument, int32_t rank)
{
    run *k = argument;
    mps_sim *sim = new_sim(k->dim, k->dim == 2 ? 0.02 : 0.05);
    found_voids f;
    mps_status status = MPS_OK;
    if (k->team) {
        const mps_ranks_ops ops = kit_engine_ops(k->team, rank);
        status = mps_sim_ranks_set(sim, &ops);
    }
    build(sim, k);
    watch_voids(sim, &f);
    f.config.least = 4; /* liquid is built half a spacing away from a plate that leans */
    if (k->dim == 3) f.config.side = 0.5;
    for (int step = 0; step < STEPS && status >= 0; step++) {
        status = mps_step(sim, 1, NULL);
        if (status >= 0) note(k, rank, step, &f);
    }
    if (status < 0) snprintf(k->error[rank], sizeof k->error[rank], "%s", mps_sim_error(sim));
    forget_voids(&f);
    mps_sim_destroy(sim);
}

/* A particle behind a face is known on one rank only, and is the same as on a single rank. */
static void compare_rows(const run *k, int64_t (*alone)[FACES])
{
    int64_t with = 0;
    for (int step = 0; step < STEPS; step++)
        for (int64_t face = 0; face < k->step[step].faces; face++) {
            int64_t id = -1, ranks = 0;
            for (int32_t r = 0; r < k->ranks; r++) {
                if (k->id[r][step][face] < 0) continue;
                id = k->id[r][step][face];
                ranks++;
            }
            assert_int_equal(id, alone[step][face]);
            assert_int_equal(ranks, id >= 0);
            with += id >= 0;
        }
    assert_true(with > 100);
}

static void compare_ranks(int32_t dim, bool plate)
{
    static int64_t alone[1][STEPS][FACES], many[MOST][STEPS][FACES];
    seen *step = calloc(STEPS, sizeof *step);
    assert_non_null(step);
    run one = {.dim = dim, .plate = plate, .ranks = 1, .step = step, .id = alone};
    run_rank(&one, 0);
    assert_string_equal(one.error[0], "");
    assert_int_equal(step[0].count, dim == 2 ? 3 + plate : 2);
    for (int32_t ranks = 2; ranks <= MOST; ranks++) {
        run k = {.dim = dim, .plate = plate, .ranks = ranks, .step = step, .id = many};
        k.team = kit_engine_create(ranks, ranks == 3 ? 7 : 0);
        kit_engine_run(k.team, run_rank, &k);
        kit_engine_destroy(k.team);
        for (int32_t r = 0; r < ranks; r++) {
            assert_string_equal(k.error[r], "");
            assert_false(k.differs[r]);
        }
        compare_rows(&k, alone[0]);
    }
    free(step);
}

static void test_2d(void **state)
{
    (void)state;
    compare_ranks(2, false);
}

static void test_plate(void **state)
{
    (void)state;
    compare_ranks(2, true);
}

static void test_3d(void **state)
{
    (void)state;
    compare_ranks(3, false);
}

/* ---- numbers of a model ---- */

typedef struct numbers {
    kit_engine_team *team;
    const char *path;
    bool reads;
    double value[MOST][4];
    int64_t count[MOST];
    char error[MOST][300];
} numbers;

static int count_up(mps_stage *s)
{
    double *value = mps_stage_state(s, 4);
    for (int k = 0; value && k < 4; k++) value[k] += k + 0.5;
    return !value;
}

static void number_rank(void *argument, int32_t rank)
{
    static const mps_verb verbs[] = {{.hook = MPS_PREPARE, .run = count_up}};
    const mps_model_ops ops = {TOY("count.up", 1, verbs)};
    numbers *k = argument;
    const run tank = {.dim = 2};
    mps_sim *sim = new_sim(2, 0.04);
    const double *value = NULL;
    const mps_ranks_ops engine = kit_engine_ops(k->team, rank);
    mps_status status = mps_sim_ranks_set(sim, &engine);
    build(sim, &tank);
    use_model(sim, &ops);
    if (k->reads && status >= 0) status = mps_checkpoint_read(sim, k->path);
    for (int s = 0; s < 3 && status >= 0; s++) status = mps_step(sim, 1, NULL);
    if (!k->reads && status >= 0) status = mps_checkpoint_write(sim, k->path);
    if (status >= 0) status = mps_model_state(sim, "count.up", &value, &k->count[rank]);
    for (int64_t i = 0; value && i < k->count[rank] && i < 4; i++) k->value[rank][i] = value[i];
    if (status < 0) snprintf(k->error[rank], sizeof k->error[rank], "%s", mps_sim_error(sim));
    mps_sim_destroy(sim);
}

static void test_numbers(void **state)
{
    char path[] = "mps_void_numbers_XXXXXX";
    (void)state;
    close(mkstemp(path));
    for (int32_t ranks = 3; ranks >= 1; ranks--) {
        numbers k = {.path = path, .reads = ranks < 3};
        k.team = kit_engine_create(ranks, 0);
        kit_engine_run(k.team, number_rank, &k);
        kit_engine_destroy(k.team);
        for (int32_t r = 0; r < ranks; r++) {
            assert_string_equal(k.error[r], "");
            assert_int_equal(k.count[r], 4);
            for (int i = 0; i < 4; i++) assert_true(k.value[r][i] == (k.reads ? 6 : 3) * (i + 0.5));
        }
    }
    remove(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_2d), cmocka_unit_test(test_plate),
                                       cmocka_unit_test(test_3d), cmocka_unit_test(test_numbers)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Channels of MPS_LIFE_PARTICLE, and fields of the user in verbs. */
#include "model_fixture.h"
#include "../tags.h"
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static const double dp = 0.05;

/* ---- a model that ages its particles --------------------------------------------------------- */

/* What it does; one for all handles of this program. */
static struct {
    int fail;    /* after it has written */
    int refresh; /* adds 1 to "age" in each step */
} test;

static int grow_old(mps_stage *s)
{
    double *age = s->data[0], *mark = s->data[1];
    for (int64_t i = 0; i < s->view->n; i++) {
        if (test.refresh) age[i] += 1;
        if (test.fail) mark[i * s->view->dim] = -77;
    }
    return test.fail ? mps_stage_fail(s, "too old") : 0;
}

static const mps_channel lives[] = {
    {"age", "-", "steps so far", 1, MPS_TYPE_REAL, MPS_LIFE_PARTICLE, 5},
    {"mark", "m", "a vector", MPS_VECTOR, MPS_TYPE_REAL, MPS_LIFE_PARTICLE, 0}};
static const mps_use life_uses[] = {{"age", MPS_USE_CHANGE}, {"mark", MPS_USE_CHANGE}};
static const mps_verb life_verbs[] = {
    {.hook = MPS_VELOCITY, .use_count = 2, .uses = life_uses, .run = grow_old}};
static const mps_model_ops life = {TOY("life.toy", 1, life_verbs), .channel_count = 2,
                                   .channels = lives};

static void reset(void)
{
    memset(&test, 0, sizeof test);
}

/* A pool with a swirl that mixes its particles. */
static mps_sim *pool(int taken)
{
    mps_lease u = {.struct_size = sizeof u}, x = {.struct_size = sizeof x};
    mps_sim *sim = new_sim(2, dp);
    reset();
    add_tank(sim, 0.5, 0.5, 0);
    fill_depth(sim, 0.5, 0.3, 0);
    if (taken) ASSERT_OK(sim, mps_field_add(sim, "age", 1));
    use_model(sim, &life);
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &u));
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
    for (int64_t i = 0; i < u.count; i++) {
        u.data[2 * i] = 2 * sin(20 * x.data[2 * i + 1]);
        u.data[2 * i + 1] = 2 * sin(15 * x.data[2 * i]);
    }
    ASSERT_OK(sim, mps_lease_end(sim, &u));
    ASSERT_OK(sim, mps_lease_end(sim, &x));
    return sim;
}

/* Each particle gets a mark of its own. */
static void mark_all(mps_sim *sim)
{
    const int64_t *ids;
    mps_lease l = {.struct_size = sizeof l};
    ASSERT_OK(sim, mps_lease_begin(sim, "mark", MPS_WRITE, &l));
    ASSERT_OK(sim, tags_peek(sim, &ids, NULL, NULL, NULL));
    assert_int_equal(l.stride, 2);
    for (int64_t i = 0; i < l.count; i++) {
        l.data[2 * i] = (double)ids[i] + 0.25;
        l.data[2 * i + 1] = -(double)ids[i];
    }
    ASSERT_OK(sim, mps_lease_end(sim, &l));
}

/* Particles with ids below `marked` have their marks, later ones have none. Returns the number of
 * particles that are not in the order of their ids. */
static int64_t check_marks(mps_sim *sim, int64_t marked)
{
    const int64_t *ids;
    mps_lease l = {.struct_size = sizeof l};
    int64_t mixed = 0;
    ASSERT_OK(sim, mps_lease_begin(sim, "mark", MPS_READ, &l));
    ASSERT_OK(sim, tags_peek(sim, &ids, NULL, NULL, NULL));
    for (int64_t i = 0; i < l.count; i++) {
        const int has = ids[i] < marked;
        assert_true(l.data[2 * i] == (has ? (double)ids[i] + 0.25 : 0));
        assert_true(l.data[2 * i + 1] == (has ? -(double)ids[i] : 0));
        mixed += i > 0 && ids[i] < ids[i - 1];
    }
    ASSERT_OK(sim, mps_lease_end(sim, &l));
    return mixed;
}

static void steps(mps_sim *sim, int count)
{
    for (int k = 0; k < count; k++) ASSERT_OK(sim, mps_step(sim, 0.01, NULL));
}

/* ---- a field like any other ------------------------------------------------------------------ */

static void lease(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        mps_sim *sim = row_sim(dim);
        mps_lease l = {.struct_size = sizeof l};
        mps_channel_info c = {0};
        reset();
        ASSERT_REFUSED(sim, mps_lease_begin(sim, "age", MPS_READ, &l), MPS_E_NAME, "age");
        use_model(sim, &life);
        ASSERT_OK(sim, mps_lease_begin(sim, "age", MPS_WRITE, &l));
        assert_true(l.stride == 1 && l.count == 8);
        for (int64_t i = 0; i < l.count; i++) assert_true(l.data[i] == 5);
        l.data[3] = NAN;
        ASSERT_REFUSED(sim, mps_lease_end(sim, &l), MPS_E_ARG, "age");
        l.data[3] = 4;
        ASSERT_OK(sim, mps_lease_end(sim, &l));
        ASSERT_OK(sim, mps_lease_begin(sim, "mark", MPS_READ, &l));
        assert_int_equal(l.stride, dim);
        ASSERT_OK(sim, mps_lease_end(sim, &l));
        assert_true(find_channel(sim, "age", &c) && c.life == MPS_LIFE_PARTICLE);
        assert_true(c.reads == (1u << MPS_HOOK_COUNT) - 1 &&
                    c.writes == (c.reads & ~(1u << MPS_POPULATE)));
        test.refresh = 1;
        steps(sim, 3);
        assert_true(field_value(sim, "age", 3, 0) == 7 && field_value(sim, "age", 4, 0) == 8);
        mps_sim_destroy(sim);
    }
}

/* A field that the user created before is used with its values; new particles have the initial
 * value of the model. */
static void takes_a_field(void **state)
{
    (void)state;
    mps_sim *sim = row_sim(2);
    int64_t ids[2];
    reset();
    ASSERT_OK(sim, mps_field_add(sim, "age", 1));
    set_field_value(sim, "age", 2, 0, 30);
    use_model(sim, &life);
    assert_true(field_value(sim, "age", 2, 0) == 30 && field_value(sim, "age", 3, 0) == 0);
    add_row(sim, 3, 2, ids);
    assert_true(field_value(sim, "age", ids[0], 0) == 5);
    test.refresh = 1;
    steps(sim, 1);
    assert_true(field_value(sim, "age", 2, 0) == 31 && field_value(sim, "age", ids[1], 0) == 6);
    mps_sim_destroy(sim);
}

/* Another number of components, or an array of the library: refused, and no part of the model is
 * active. */
static void takes_no_other_field(void **state)
{
    (void)state;
    static const mps_channel hidden[] = {
        {"age", "-", "h", 1, MPS_TYPE_REAL, MPS_LIFE_PARTICLE, 5},
        {"kind", "-", "h", 1, MPS_TYPE_REAL, MPS_LIFE_PARTICLE, 0}};
    static const mps_channel own[] = {
        {"position", "m", "h", MPS_VECTOR, MPS_TYPE_REAL, MPS_LIFE_PARTICLE, 0}};
    static const mps_model_ops a = {TOY("a.toy", 1, idle_verbs), .channel_count = 2,
                                    .channels = hidden};
    static const mps_model_ops b = {TOY("b.toy", 1, idle_verbs), .channel_count = 1,
                                    .channels = own};
    mps_sim *sim = row_sim(2);
    mps_lease l = {.struct_size = sizeof l};
    reset();
    ASSERT_OK(sim, mps_field_add(sim, "mark", 3));
    ASSERT_OK(sim, mps_model_register(sim, &life));
    ASSERT_REFUSED(sim, mps_model_use(sim, "life.toy"), MPS_E_ARG, "'mark' of 2 components");
    ASSERT_OK(sim, mps_model_register(sim, &a));
    ASSERT_REFUSED(sim, mps_model_use(sim, "a.toy"), MPS_E_ARG, "'kind'");
    ASSERT_OK(sim, mps_model_register(sim, &b));
    ASSERT_REFUSED(sim, mps_model_use(sim, "b.toy"), MPS_E_ARG, "'position'");
    assert_null(mps_model_name(sim, 0));
    ASSERT_STATUS(sim, mps_lease_begin(sim, "age", MPS_READ, &l), MPS_E_NAME);
    steps(sim, 1);
    mps_sim_destroy(sim);
}

/* ---- it follows its particle ----------------------------------------------------------------- */

static void follows(void **state)
{
    (void)state;
    const double corner[2] = {0.25, 0.45};
    int64_t id, gone[3] = {100, 20, 150};
    mps_particle_block b;
    mps_sim *sim = pool(0);
    const int64_t before = mps_particles_count(sim, -1);
    mark_all(sim);
    steps(sim, 40);
    assert_true(check_marks(sim, before) > 10); /* they were sorted */
    ASSERT_OK(sim, mps_particles_remove(sim, 3, gone));
    check_marks(sim, before);
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = 1;
    b.position = corner;
    ASSERT_OK(sim, mps_particles_add(sim, &b, &id));
    assert_true(id == before && field_value(sim, "age", id, 0) == 5);
    steps(sim, 20);
    assert_int_equal(mps_particles_count(sim, -1), before - 2);
    check_marks(sim, before);
    mps_sim_destroy(sim);
}

/* Whichever verb fails after the model has written. */
static void comes_back_after_a_failure(void **state)
{
    (void)state;
    mps_sim *sim = pool(0), *mirror = pool(0);
    const int64_t n = mps_particles_count(sim, -1);
    mark_all(sim);
    mark_all(mirror);
    test.refresh = 1;
    for (int k = 0; k < 20; k++) {
        test.fail = 1;
        ASSERT_REFUSED(sim, mps_step(sim, 0.01, NULL), MPS_E_PLUGIN, "too old");
        test.fail = 0;
        check_marks(sim, n);
        assert_true(field_value(sim, "age", 7, 0) == 5 + k);
        steps(sim, 1);
        steps(mirror, 1);
        for (int64_t id = 0; id < n; id += 7)
            assert_true(field_value(sim, "velocity", id, 1) ==
                        field_value(mirror, "velocity", id, 1));
    }
    mps_sim_destroy(sim);
    mps_sim_destroy(mirror);
}

static void checkpoint(void **state)
{
    (void)state;
    char path[] = "mps_fields_XXXXXX";
    const int file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    for (int taken = 0; taken < 2; taken++) {
        mps_sim *sim = pool(taken), *other = pool(taken);
        const int64_t n = mps_particles_count(sim, -1);
        mark_all(sim);
        test.refresh = 1;
        steps(sim, 15);
        ASSERT_OK(sim, mps_checkpoint_write(sim, path));
        ASSERT_OK(other, mps_checkpoint_read(other, path));
        for (int more = 0; more < 2; more++) {
            check_marks(other, n);
            const double age = (taken ? 0 : 5) + 15 + 5 * more;
            for (int64_t id = 0; id < n; id += 11)
                assert_true(field_value(sim, "age", id, 0) == age &&
                            field_value(other, "age", id, 0) == age &&
                            field_value(sim, "position", id, 0) ==
                                field_value(other, "position", id, 0));
            steps(sim, 5);
            steps(other, 5);
        }
        mps_sim_destroy(sim);
        mps_sim_destroy(other);
    }
    remove(path);
}

/* The field is the user's after the model is removed, and the model's when it is activated
 * again. */
static void stays(void **state)
{
    (void)state;
    mps_sim *sim = pool(0);
    const int64_t n = mps_particles_count(sim, -1);
    mark_all(sim);
    test.refresh = 1;
    steps(sim, 2);
    ASSERT_OK(sim, mps_model_remove(sim, "life"));
    assert_true(!find_channel(sim, "age", NULL));
    steps(sim, 10);
    check_marks(sim, n);
    assert_true(field_value(sim, "age", 9, 0) == 7);
    ASSERT_OK(sim, mps_model_use(sim, "life.toy"));
    steps(sim, 1);
    check_marks(sim, n);
    assert_true(field_value(sim, "age", 9, 0) == 8);
    ASSERT_OK(sim, mps_preset_use(sim, "imps"));
    steps(sim, 1);
    assert_true(field_value(sim, "age", 9, 0) == 8);
    mps_sim_destroy(sim);
}

/* ---- fields of the user ---------------------------------------------------------------------- */

static int count_up(mps_stage *s)
{
    double *mine = s->data[0];
    assert_non_null(mine);
    for (int64_t i = 0; i < s->view->n; i++) mine[2 * i + 1] += (double)s->view->id[i];
    return test.fail;
}

/* A verb uses a field of the user; it exists in all hooks, and is restored too. */
static void field_by_name(void **state)
{
    (void)state;
    static const mps_use uses[] = {{"mine", MPS_USE_CHANGE}};
    static mps_verb verb = {.use_count = 1, .uses = uses, .run = count_up};
    static const mps_model_ops ops = {TOY("user.toy", 1, &verb)};
    mps_sim *sim = row_sim(2);
    reset();
    use_model(sim, &ops);
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_STATE, "'mine'");
    ASSERT_OK(sim, mps_field_add(sim, "mine", 2));
    mps_time_control control;
    assert_int_equal(mps_time_control_init(&control, sizeof control), MPS_OK);
    ASSERT_OK(sim, mps_time_control_set(sim, &control)); /* MPS_LIMIT is not skipped */
    verb.hook = MPS_POPULATE; /* before what a failed step brings back is kept */
    ASSERT_OK(sim, mps_model_use(sim, "user.toy"));
    ASSERT_REFUSED(sim, mps_step(sim, 1e-3, NULL), MPS_E_STATE,
                   "field 'mine' cannot be written in hook 'populate'");
    for (int32_t hook = MPS_LIMIT; hook < MPS_HOOK_COUNT; hook++) {
        verb.hook = hook;
        ASSERT_OK(sim, mps_model_use(sim, "user.toy"));
        test.fail = 1;
        ASSERT_STATUS(sim, mps_step(sim, 1e-3, NULL), MPS_E_PLUGIN);
        test.fail = 0;
        assert_true(field_value(sim, "mine", 3, 1) == 3 * (hook - MPS_LIMIT));
        steps(sim, 1);
        assert_true(field_value(sim, "mine", 3, 1) == 3 * (hook - MPS_LIMIT + 1));
        assert_true(field_value(sim, "mine", 3, 0) == 0);
    }
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(lease),
                                       cmocka_unit_test(takes_a_field),
                                       cmocka_unit_test(takes_no_other_field),
                                       cmocka_unit_test(follows),
                                       cmocka_unit_test(comes_back_after_a_failure),
                                       cmocka_unit_test(checkpoint),
                                       cmocka_unit_test(stays),
                                       cmocka_unit_test(field_by_name)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

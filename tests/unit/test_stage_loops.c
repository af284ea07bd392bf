/* SPDX-License-Identifier: BSD-3-Clause */
/* Loops, sums, bodies and workspace of the library for verbs. */
#include "model_fixture.h"
#include "cloud.h"
#include <stdio.h>

/* A model with one verb, which runs the function of the current test. */
static int (*play)(mps_stage *s);

static int run_play(mps_stage *s)
{
    return play ? play(s) : 0;
}

static const mps_verb verbs[] = {{.hook = MPS_PREPARE, .run = run_play}};
static const mps_model_ops player = {TOY("player.toy", 1, verbs)};

/* `count` particles of a distorted lattice, `threads` threads. */
static mps_sim *cloud_sim(int64_t count, int32_t threads)
{
    cloud c = cloud_lattice(2, 40, 40, 1, 0.2, 7);
    mps_particle_block b;
    mps_sim *sim = empty_sim(2, CLOUD_DP, NULL);
    assert_true(count <= c.n);
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = count;
    b.position = c.x;
    ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
    ASSERT_OK(sim, mps_threads_set(sim, threads));
    use_model(sim, &player);
    cloud_free(&c);
    return sim;
}

static void play_once(int64_t count, int32_t threads, int (*what)(mps_stage *s))
{
    mps_sim *sim = cloud_sim(count, threads);
    play = what;
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    play = NULL;
    mps_sim_destroy(sim);
}

/* ---- rows ------------------------------------------------------------------------------------ */

typedef struct counted {
    int32_t *times;
    int dim;
} counted;

MPS_ROW void count_row(const int dim, const mps_view *v, const counted *c, int64_t i)
{
    c->times[i] += dim == c->dim && i < v->n ? 1 : 100;
}
MPS_ROWS(count_rows, count_row, counted)

static int count_all(mps_stage *s)
{
    counted c = {mps_stage_scratch_integers(s, s->view->n), s->view->dim};
    assert_non_null(c.times);
    mps_stage_rows(s, &count_rows, &c);
    for (int64_t i = 0; i < s->view->n; i++) assert_int_equal(c.times[i], 1);
    return 0;
}

/* Each row once, also with fewer rows than threads. */
static void each_row_once(void **state)
{
    (void)state;
    const int64_t count[] = {1, 2, 3, 63, 64, 65, 1600};
    for (size_t k = 0; k < sizeof count / sizeof count[0]; k++)
        for (int32_t threads = 1; threads <= 4; threads++) play_once(count[k], threads, count_all);
}

/* ---- sums and maxima ------------------------------------------------------------------------- */

enum { SUMS = 16 };
static double total[SUMS], maxima[SUMS], sum_before[SUMS], max_before[SUMS];
static double exact[3]; /* number of rows, sum and maximum of the ids */

/* Numbers of all sizes, so that the order of a sum is seen in its last bits. */
typedef struct numbers {
    const int64_t *id;
} numbers;

static double number(const int64_t *id, int64_t i, int k)
{
    return sin((double)(id[i] * 16 + k)) * pow(10.0, (double)((id[i] * 7 + k) % 19));
}

MPS_ROW void sum_row(const int dim, const mps_view *v, const numbers *f, int64_t i, double *sum)
{
    (void)dim, (void)v;
    for (int k = 2; k < SUMS; k++) sum[k] += number(f->id, i, k);
    sum[0] += 1;
    sum[1] += (double)f->id[i];
}
MPS_SUMS(add_rows, sum_row, numbers)

MPS_ROW void one_row(const int dim, const mps_view *v, const numbers *f, int64_t i, double *sum)
{
    (void)dim, (void)v, (void)f, (void)i;
    sum[0] += 1;
}
MPS_SUMS(one_rows, one_row, numbers)

MPS_ROW void raise_row(const int dim, const mps_view *v, const numbers *f, int64_t i, double *most)
{
    (void)dim, (void)v;
    for (int k = 1; k < SUMS; k++)
        if (number(f->id, i, k) > most[k]) most[k] = number(f->id, i, k);
    if ((double)f->id[i] > most[0]) most[0] = (double)f->id[i];
}
MPS_SUMS(raise_rows, raise_row, numbers)

static void raise_none(const mps_view *v, const void *fields, int64_t begin, int64_t end,
                       int32_t stride, double *most)
{
    (void)v, (void)fields, (void)begin, (void)end, (void)most;
    assert_int_equal(stride, 0);
}

static const mps_sums raise_nothing = {sizeof(mps_sums), 0, "raise_nothing", raise_none, ""};

static int sum_all(mps_stage *s)
{
    const mps_view *v = s->view;
    const numbers f = {v->id};
    double one[2] = {-1, -1}, none;
    mps_stage_sum(s, SUMS, &add_rows, &f, total);
    mps_stage_max(s, SUMS, &raise_rows, &f, maxima);
    mps_stage_sum(s, 1, &one_rows, &f, one); /* no more than `count` numbers are written */
    assert_true(one[0] == (double)v->n && one[1] == -1);
    mps_stage_max(s, 1, &raise_nothing, NULL, &none);
    assert_true(none == -INFINITY);
    exact[0] = (double)v->n;
    exact[1] = 0.5 * (double)(v->n * (v->n - 1));
    exact[2] = (double)(v->n - 1);
    return 0;
}

static void sums_do_not_depend_on_threads(void **state)
{
    (void)state;
    const int64_t count[] = {1, 3, 64, 1000, 1600};
    for (size_t k = 0; k < sizeof count / sizeof count[0]; k++)
        for (int32_t threads = 1; threads <= 4; threads++) {
            play_once(count[k], threads, sum_all);
            assert_true(total[0] == exact[0] && total[1] == exact[1] && maxima[0] == exact[2]);
            if (threads > 1) {
                assert_memory_equal(total, sum_before, sizeof total);
                assert_memory_equal(maxima, max_before, sizeof maxima);
            }
            memcpy(sum_before, total, sizeof total);
            memcpy(max_before, maxima, sizeof maxima);
        }
}

/* Rows in another order have the same terms, and numbers of all sizes that cancel. */
typedef struct ordered {
    const int64_t *id;
    const int32_t *order;
} ordered;

static void add_some(const mps_view *v, const void *fields, int64_t begin, int64_t end,
                     int32_t stride, double *values)
{
    const ordered *f = fields;
    (void)v;
    assert_int_equal(stride, 3);
    for (int64_t k = begin; k < end; k++) {
        double *sums = values + (k - begin) * stride;
        for (int c = 0; c < 3; c++) assert_true(sums[c] == 0);
        const int64_t i = f->order[k];
        sums[0] = number(f->id, i, 0);
        sums[1] = i % 2 ? number(f->id, i - 1, 1) : -number(f->id, i, 1);
        sums[2] = 0.1 * (double)i;
    }
}

static const mps_sums add_ordered = {sizeof(mps_sums), sizeof(ordered), "add", add_some, ""};

static int sum_in_orders(mps_stage *s)
{
    const mps_view *v = s->view;
    double first[3], other[3];
    int32_t *row = mps_stage_scratch_integers(s, v->n);
    const ordered f = {v->id, row};
    assert_non_null(row);
    for (int64_t i = 0; i < v->n; i++) row[i] = (int32_t)i;
    mps_stage_sum(s, 3, &add_ordered, &f, first);
    for (int64_t i = 0; i < v->n; i++) row[i] = (int32_t)((i * 611 + 17) % v->n);
    mps_stage_sum(s, 3, &add_ordered, &f, other);
    assert_memory_equal(first, other, sizeof first);
    assert_true(first[1] == 0);
    ASSERT_NEAR(first[2], 0.05 * (double)(v->n * (v->n - 1)), 1e-10);
    return 0;
}

static void sums_do_not_depend_on_the_order(void **state)
{
    (void)state;
    for (int32_t threads = 1; threads <= 3; threads++) play_once(1600, threads, sum_in_orders);
}

static int32_t wanted_count;

static int sum_many(mps_stage *s)
{
    const numbers f = {s->view->id};
    double many[32];
    for (int k = 0; k < 32; k++) many[k] = 7;
    mps_stage_sum(s, wanted_count, &add_rows, &f, many);
    for (int k = 0; k < 32; k++) assert_true(many[k] == (k < wanted_count && k < 16 ? 0 : 7));
    return 0;
}

static int raise_many(mps_stage *s)
{
    const numbers f = {s->view->id};
    double many[32];
    mps_stage_max(s, wanted_count, &raise_rows, &f, many);
    return 0;
}

/* A verb that requests too much workspace fails, even if it returns success. */
static void wrong_counts(void **state)
{
    (void)state;
    const int32_t counts[] = {0, -1, 17, 32, INT32_MIN};
    char sums[64], most[64];
    mps_sim *sim = cloud_sim(100, 2);
    for (size_t k = 0; k < sizeof counts / sizeof counts[0]; k++) {
        wanted_count = counts[k];
        snprintf(sums, sizeof sums, "requests %d sums: must be 1..16", (int)counts[k]);
        snprintf(most, sizeof most, "requests %d maxima: must be 1..16", (int)counts[k]);
        play = sum_many;
        ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, sums);
        ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, "player.toy");
        play = raise_many;
        ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, most);
    }
    play = sum_all;
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    play = NULL;
    mps_sim_destroy(sim);
}

/* ---- neighbours ------------------------------------------------------------------------------ */

static int check_beside(mps_stage *s)
{
    const mps_view *v = s->view;
    int32_t *member = mps_stage_scratch_integers(s, v->n);
    int32_t *beside = mps_stage_scratch_integers(s, v->n);
    int64_t found = 0;
    assert_true(member && beside);
    for (int64_t i = 0; i < v->n; i++) {
        member[i] = v->id[i] % 50 == 0 ? 3 : 0; /* anything but 0 */
        beside[i] = 77;
    }
    mps_stage_adjacent(s, member, beside);
    for (int64_t i = 0; i < v->n; i++) {
        int32_t wanted = 0;
        for (int64_t j = 0; j < v->n; j++) {
            const double x = v->x[2 * j] - v->x[2 * i], y = v->x[2 * j + 1] - v->x[2 * i + 1];
            if (j != i && member[j] && x * x + y * y < v->near.re * v->near.re) wanted = 1;
        }
        assert_int_equal(beside[i], wanted);
        found += wanted;
    }
    assert_true(found > v->n / 10 && found < v->n);
    return 0;
}

static void beside(void **state)
{
    (void)state;
    play_once(1600, 2, check_beside);
}

/* ---- bodies ---------------------------------------------------------------------------------- */

/* Rows of particles far from each other, each `length` long; roles by letter. */
typedef struct chain {
    const char *roles; /* '.' none, 'm' member, 's' seed, 'a' anchor */
    const char *free;  /* 'x' if it is in a free body */
} chain;

static const chain chains[] = {{"smmm", "xxxx"},         /* free */
                               {"mmsm", "xxxx"},         /* wherever the seed is */
                               {"ssms", "xxxx"},         /* seeds are members */
                               {"smma", "----"},         /* not free, adjacent to an anchor */
                               {"ammms", "-----"},       /* also from the other end */
                               {"smam", "----"},         /* an anchor between */
                               {"mmm", "---"},           /* without a seed */
                               {"smmmmm", "------"},     /* larger than allowed */
                               {"smmmm", "xxxxx"},       /* just as large as allowed */
                               {"s", "x"},               /* alone */
                               {"sm...ms", "xx---xx"},   /* apart: two bodies */
                               {"sm...mma", "xx------"}, /* one of them not free */
                               {"....", "----"}};
enum { CHAINS = sizeof chains / sizeof chains[0], LONGEST = 8, MOST_IN_A_BODY = 5 };

static int32_t role_of(char letter)
{
    return letter == 's'   ? MPS_BODY_SEED
           : letter == 'm' ? MPS_BODY_MEMBER
           : letter == 'a' ? MPS_BODY_ANCHOR
                           : MPS_BODY_NONE;
}

/* Ids are numbered by chain: chain k has LONGEST of them, the last of which are far away. */
static int check_bodies(mps_stage *s)
{
    const mps_view *v = s->view;
    int32_t *role = mps_stage_scratch_integers(s, v->n),
            *body = mps_stage_scratch_integers(s, v->n);
    int32_t at[CHAINS * LONGEST], bodies = 0;
    assert_true(role && body);
    for (int64_t i = 0; i < v->n; i++) {
        const chain *c = &chains[v->id[i] / LONGEST];
        const size_t place = (size_t)(v->id[i] % LONGEST);
        role[i] = place < strlen(c->roles) ? role_of(c->roles[place]) : MPS_BODY_NONE;
        body[i] = 55;
        at[v->id[i]] = (int32_t)i;
    }
    assert_int_equal(mps_stage_bodies(s, MOST_IN_A_BODY, role, body), 0);
    for (int k = 0; k < CHAINS; k++)
        for (int place = 0; place < LONGEST; place++) {
            const char *free = chains[k].free;
            const int wanted = place < (int)strlen(free) && free[place] == 'x';
            const int32_t number = body[at[k * LONGEST + place]];
            if (wanted != (number >= 0) || number < -1)
                fail_msg("chain %d, particle %d: body %d", k, place, (int)number);
            if (!wanted) continue;
            const int same = place > 0 && free[place - 1] == 'x';
            if (same) assert_int_equal(number, body[at[k * LONGEST + place - 1]]);
            if (!same) assert_int_equal(number, bodies++); /* by the least id */
        }
    return 0;
}

static void bodies(void **state)
{
    (void)state;
    mps_sim *sim = empty_sim(2, 0.1, NULL);
    double x[2 * CHAINS * LONGEST];
    mps_particle_block b;
    for (int k = 0; k < CHAINS; k++)
        for (int place = 0; place < LONGEST; place++) {
            const int in = place < (int)strlen(chains[k].roles);
            double *to = x + 2 * (k * LONGEST + place);
            to[0] = 0.15 * (in ? place : place + 20); /* two are no neighbours: re_near is 0.21 */
            to[1] = -1.0 * k; /* rows are sorted from the last chain to the first */
        }
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = (int64_t)CHAINS * LONGEST;
    b.position = x;
    ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
    use_model(sim, &player);
    play = check_bodies;
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    play = NULL;
    mps_sim_destroy(sim);
}

static int check_links(mps_stage *s)
{
    const mps_view *v = s->view;
    int32_t *role = mps_stage_scratch_integers(s, v->n),
            *body = mps_stage_scratch_integers(s, v->n);
    for (int64_t i = 0; i < v->n; i++) role[i] = MPS_BODY_SEED;
    assert_int_equal(mps_stage_bodies(s, MOST_IN_A_BODY, role, body), 0);
    for (int64_t i = 0; i < v->n; i++) assert_int_equal(body[i], v->id[i] == 2 ? -1 : v->id[i]);
    return 0;
}

/* A wall between two droplets is in no body, for any role, and connects none. */
static void solids_link_no_bodies(void **state)
{
    (void)state;
    const double drops[4] = {0.3, 0, 0, 0}, wall[2] = {0.15, 0};
    mps_sim *sim = empty_sim(2, 0.1, NULL);
    mps_particle_block b;
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = 2;
    b.position = drops;
    ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
    b.count = 1;
    b.position = wall;
    b.kind = MPS_WALL;
    ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
    use_model(sim, &player);
    play = check_links;
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    play = NULL;
    mps_sim_destroy(sim);
}

/* ---- scratch --------------------------------------------------------------------------------- */

static int blocks_wanted;

/* Of both types, zeroed, none on top of another; given back when the verb returns. */
static int take_blocks(mps_stage *s)
{
    const mps_view *v = s->view;
    void *block[20] = {NULL};
    for (int k = 0; k < blocks_wanted; k++) {
        if (k % 2) {
            int32_t *b = mps_stage_scratch_integers(s, v->n);
            for (int64_t i = 0; b && i < v->n; i++) assert_int_equal(b[i], 0);
            for (int64_t i = 0; b && i < v->n; i++) b[i] = k;
            block[k] = b;
        } else {
            double *b = mps_stage_scratch(s, v->n);
            for (int64_t i = 0; b && i < v->n; i++) assert_true(b[i] == 0);
            for (int64_t i = 0; b && i < v->n; i++) b[i] = k;
            block[k] = b;
        }
        if (!block[k]) return 1;
    }
    for (int k = 0; k < blocks_wanted; k++)
        for (int64_t i = 0; i < v->n; i++)
            assert_true((k % 2 ? ((int32_t *)block[k])[i] : ((double *)block[k])[i]) == k);
    return 0;
}

static int take_negative(mps_stage *s)
{
    return mps_stage_scratch(s, -1) == NULL;
}

static int take_too_much(mps_stage *s)
{
    return mps_stage_scratch(s, INT64_MAX / 4) == NULL;
}

/* The search of bodies releases its workspace. */
static int bodies_and_blocks(mps_stage *s)
{
    int32_t *role = mps_stage_scratch_integers(s, s->view->n),
            *body = mps_stage_scratch_integers(s, s->view->n);
    for (int k = 0; k < 20; k++) assert_int_equal(mps_stage_bodies(s, 3, role, body), 0);
    for (int k = 2; k < 16; k++) assert_non_null(mps_stage_scratch(s, 1));
    return mps_stage_bodies(s, 3, role, body); /* it needs some itself */
}

static int refresh_all(mps_stage *s)
{
    double *b = mps_stage_scratch(s, 2 * s->view->n);
    assert_int_equal(mps_stage_refresh(s, 1, &(mps_shared){b, 2, MPS_TYPE_REAL}), 0);
    return mps_stage_refresh(s, 1, &(mps_shared){b, 0, MPS_TYPE_REAL});
}

static int refresh_nothing(mps_stage *s)
{
    return mps_stage_refresh(s, 1, &(mps_shared){NULL, 1, MPS_TYPE_REAL});
}

static void scratch(void **state)
{
    (void)state;
    mps_sim *sim = cloud_sim(100, 2);
    play = take_blocks;
    for (blocks_wanted = 0; blocks_wanted <= 16; blocks_wanted += 4)
        for (int twice = 0; twice < 2; twice++) ASSERT_OK(sim, mps_step(sim, 1, NULL));
    blocks_wanted = 17;
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, "at most 16 blocks");
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, "player.toy");
    play = take_negative;
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, "negative");
    play = take_too_much;
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_NOMEM, "player.toy");
    play = bodies_and_blocks;
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, "at most 16 blocks");
    play = refresh_all;
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, "has 0 components");
    play = refresh_nothing;
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, "array 0 is NULL");
    play = take_blocks;
    blocks_wanted = 16;
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    play = NULL;
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(each_row_once),
                                       cmocka_unit_test(sums_do_not_depend_on_threads),
                                       cmocka_unit_test(sums_do_not_depend_on_the_order),
                                       cmocka_unit_test(wrong_counts),
                                       cmocka_unit_test(beside),
                                       cmocka_unit_test(bodies),
                                       cmocka_unit_test(solids_link_no_bodies),
                                       cmocka_unit_test(scratch)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

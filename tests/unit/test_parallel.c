/* SPDX-License-Identifier: BSD-3-Clause */
/* Parts of a loop run once each, sums do not depend on threads, and a handle runs on its own
 * threads or those of the application. */
#include "loop.h"
#include "sim.h"
#include "tank_fixture.h"
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <time.h>

enum { MOST_PARTS = 100, ROWS = 20011 };

static mps__context context;

static void make_pool(mps__pool *p, int32_t threads)
{
    context.allocator = mps__allocator_default();
    mps__pool_init(p, &context);
    mps__pool_resize(p, threads);
}

/* ---- parts ----------------------------------------------------------------------------------- */

typedef struct tally {
    atomic_int called[MOST_PARTS];
    mps__pool *inner; /* NULL, or a pool whose loop runs in each part */
    atomic_int inner_calls;
} tally;

static void count_inner(void *argument, int32_t part)
{
    (void)part;
    atomic_fetch_add(&((tally *)argument)->inner_calls, 1);
}

static void count_part(void *argument, int32_t part)
{
    tally *t = argument;
    atomic_fetch_add(&t->called[part], 1);
    if (t->inner) mps_parallel_run(&t->inner->parallel, 3, count_inner, t);
}

static void check_tally(tally *t, int32_t parts, int times)
{
    for (int32_t k = 0; k < MOST_PARTS; k++)
        assert_int_equal(atomic_exchange(&t->called[k], 0), k < parts ? times : 0);
}

static void each_part_once(void **state)
{
    (void)state;
    static const int32_t parts[] = {1, 2, 3, 7, 8, 64, 99};
    mps__pool pool;
    tally t = {0};
    for (int32_t threads = 1; threads <= 8; threads++) {
        make_pool(&pool, threads);
        for (size_t k = 0; k < sizeof parts / sizeof parts[0]; k++)
            for (int again = 0; again < 50; again++) {
                mps_parallel_run(&pool.parallel, parts[k], count_part, &t);
                check_tally(&t, parts[k], 1);
            }
        mps__pool_free(&pool);
    }
    mps_parallel_run(NULL, 5, count_part, &t);
    check_tally(&t, 5, 1);
}

/* Loops while threads still spin, and after they sleep. */
static void after_a_pause(void **state)
{
    (void)state;
    mps__pool pool;
    tally t = {0};
    make_pool(&pool, 3);
    for (int k = 0; k < 300; k++) {
        mps_parallel_run(&pool.parallel, 5, count_part, &t);
        check_tally(&t, 5, 1);
        const struct timespec pause = {.tv_nsec = k % 2 ? 40000 : 400000};
        if (k % 3 == 0) nanosleep(&pause, NULL);
    }
    mps__pool_free(&pool);
}

static void nested_call(void **state)
{
    (void)state;
    mps__pool pool, other;
    make_pool(&pool, 3);
    make_pool(&other, 1);
    mps__pool *inner[] = {&pool, &other};
    for (int k = 0; k < 2; k++) {
        tally t = {.inner = inner[k]};
        mps_parallel_run(&pool.parallel, 10, count_part, &t);
        check_tally(&t, 10, 1);
        assert_int_equal(t.inner_calls, 30);
    }
    mps__pool_free(&pool);
    mps__pool_free(&other);
}

static void resize(void **state)
{
    (void)state;
    mps__pool pool;
    tally t = {0};
    make_pool(&pool, 2);
    for (int k = 0; k < 40; k++) {
        mps__pool_resize(&pool, 1 + k % 4);
        if (k % 3 == 0) continue; /* none was made */
        mps_parallel_run(&pool.parallel, 9, count_part, &t);
        check_tally(&t, 9, 1);
    }
    mps__pool_free(&pool);
    mps_parallel_run(&pool.parallel, 9, count_part, &t);
    check_tally(&t, 9, 1);
    mps__pool_free(&pool);
}

static void *no_memory(void *user, size_t size)
{
    (void)user, (void)size;
    return NULL;
}

static void release(void *user, void *block)
{
    (void)user, (void)block;
}

/* Without memory loops run in the calling thread. */
static void out_of_memory(void **state)
{
    (void)state;
    mps__pool pool;
    tally t = {0};
    make_pool(&pool, 4);
    context.allocator = (mps_allocator){no_memory, release, NULL};
    for (int k = 0; k < 3; k++) mps_parallel_run(&pool.parallel, 9, count_part, &t);
    check_tally(&t, 9, 3);
    assert_null(pool.crew);
    assert_string_equal(context.error, "");
    mps__pool_free(&pool);
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
static void no_threads(void **state)
{
    (void)state;
    skip(); /* the sanitizers need the address space that this test takes away */
}
#else
/* Without memory for another stack loops run in the calling thread. Must be the first test: the
 * system keeps stacks of ended threads. */
static void no_threads(void **state)
{
    (void)state;
    struct rlimit before, tight;
    mps__pool pool;
    tally t = {0};
    assert_int_equal(getrlimit(RLIMIT_AS, &before), 0);
    tight = before;
    tight.rlim_cur = 1 << 20;
    make_pool(&pool, 4);
    free(malloc(1 << 16)); /* the memory of the pool is allocated */
    assert_int_equal(setrlimit(RLIMIT_AS, &tight), 0);
    for (int k = 0; k < 3; k++) mps_parallel_run(&pool.parallel, 9, count_part, &t);
    assert_int_equal(setrlimit(RLIMIT_AS, &before), 0);
    check_tally(&t, 9, 3);
    mps__pool_free(&pool);
}
#endif

/* ---- rows and sums --------------------------------------------------------------------------- */

static void mark_rows(void *argument, int64_t begin, int64_t end)
{
    for (int64_t i = begin; i < end; i++) ((char *)argument)[i]++;
}

static void sum_rows(void *argument, int64_t begin, int64_t end, double *values)
{
    const double *x = argument;
    for (int64_t i = begin; i < end; i++) {
        values[0] += x[i];
        values[1] += x[i] * x[i];
        if (x[i] > values[2]) values[2] = x[i];
        if (-x[i] > values[3]) values[3] = -x[i];
    }
}

typedef struct large_fields {
    const double *x;
} large_fields;

MPS_ROW bool is_large(const large_fields *f, int64_t i)
{
    return f->x[i] > 0.999;
}
MPS__FIRST(large_rows, is_large, large_fields)

static void rows_and_sums(void **state)
{
    (void)state;
    static const int64_t counts[] = {0, 1, 63, 127, 255, 256, 1000, ROWS};
    char *marks = calloc(ROWS + 1, 1);
    double *x = calloc(ROWS, sizeof *x), *zeros = calloc(ROWS, sizeof *zeros);
    uint64_t seed = 1;
    for (int64_t i = 0; i < ROWS; i++) {
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        x[i] = (double)(seed >> 11) * 0x1p-53 * (i % 7 ? 1 : 1e-8);
    }
    for (size_t k = 0; k < sizeof counts / sizeof counts[0]; k++) {
        const int64_t n = counts[k];
        double one[4] = {0};
        const large_fields f = {x};
        int64_t first = 0;
        for (int32_t threads = 1; threads <= 4; threads++) {
            mps__pool pool;
            double values[4] = {5, 6, -INFINITY, -1};
            make_pool(&pool, threads);
            memset(marks, 0, ROWS + 1);
            mps_parallel_rows(&pool.parallel, n, mark_rows, marks);
            for (int64_t i = 0; i <= ROWS; i++) assert_int_equal(marks[i], i < n);
            mps_parallel_reduce(&pool.parallel, n, sum_rows, x,
                                &(mps_parallel_values){2, 2, values});
            if (threads == 1) {
                memcpy(one, values, sizeof one);
                while (first < n && !is_large(&f, first)) first++;
            }
            assert_memory_equal(one, values, sizeof one);
            assert_int_equal(mps__first_run(&pool.parallel, &large_rows, n, &f), first);
            for (int64_t i = 0; i < ROWS; i++) zeros[i] = 1;
            const mps__block blocks[] = {
                {zeros, n / 2}, {zeros + n / 2, 0}, {zeros + n / 2, n - n / 2}};
            mps__parallel_zero(&pool.parallel, blocks, 3);
            for (int64_t i = 0; i < ROWS; i++) assert_true(zeros[i] == (i < n ? 0 : 1));
            mps__parallel_copy(&pool.parallel, zeros, x, (size_t)n * sizeof *x);
            assert_memory_equal(zeros, x, (size_t)n * sizeof *x);
            mps__pool_free(&pool);
        }
        assert_true(n < ROWS || (first < n && is_large(&f, first)));
    }
    free(zeros);
    free(x);
    free(marks);
}

/* ---- handles --------------------------------------------------------------------------------- */

/* A parallel-for of the application: parts in descending order, in the calling thread. */
static void run_backwards(void *user, int32_t parts, mps_part_fn body, void *argument)
{
    ++*(int64_t *)user;
    for (int32_t part = parts - 1; part >= 0; part--) body(argument, part);
}

static mps_sim *shaken_pool(int32_t threads, const mps_parallel *host)
{
    const mps_harmonic surge = {.dof = MPS_MOVE_X, .amplitude = 0.03, .omega = 9};
    mps_config config;
    mps_sim *sim = NULL;
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dp = 0.01;
    config.threads = threads;
    if (host) config.parallel = *host;
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    add_tank(sim, 0.5, 0.4, 0);
    fill_depth(sim, 0.5, 0.2, 0);
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &surge));
    return sim;
}

static void assert_same_state(mps_sim *a, mps_sim *b)
{
    static const char *const names[] = {"position", "velocity", "pressure"};
    for (int k = 0; k < 3; k++) {
        mps_lease x = {.struct_size = sizeof x}, y = {.struct_size = sizeof y};
        ASSERT_OK(a, mps_lease_begin(a, names[k], MPS_READ, &x));
        ASSERT_OK(b, mps_lease_begin(b, names[k], MPS_READ, &y));
        assert_int_equal(x.count, y.count);
        assert_memory_equal(x.data, y.data, (size_t)(x.count * x.stride) * sizeof(double));
        ASSERT_OK(a, mps_lease_end(a, &x));
        ASSERT_OK(b, mps_lease_end(b, &y));
    }
}

static void *run_shortly(void *sim)
{
    return mps_run(sim, 0.05, NULL, NULL) == MPS_OK ? sim : NULL;
}

static void host_and_pool_agree(void **state)
{
    (void)state;
    int64_t calls = 0;
    mps_parallel host;
    assert_int_equal(mps_parallel_init(&host, sizeof host), MPS_OK);
    assert_true(host.threads == 1 && !host.run);
    host.run = run_backwards;
    host.user = &calls;
    mps_sim *one = shaken_pool(1, NULL), *four = shaken_pool(4, NULL),
            *hosted = shaken_pool(2, &host);
    assert_non_null(run_shortly(one));
    assert_non_null(run_shortly(four));
    assert_non_null(run_shortly(hosted));
    assert_true(calls > 100);
    assert_null(hosted->world.pool.crew);
    assert_same_state(one, four);
    assert_same_state(one, hosted);
    const int64_t before = calls;
    ASSERT_OK(hosted, mps_threads_set(hosted, 1)); /* one part: no call of the application */
    ASSERT_OK(hosted, mps_step(hosted, 1e-3, NULL));
    assert_int_equal(calls, before);
    ASSERT_OK(one, mps_step(one, 1e-3, NULL));
    assert_same_state(one, hosted);
    host.threads = 3;
    mps_sim *three = shaken_pool(1, &host);
    assert_int_equal(three->world.threads, 3);
    mps_sim_destroy(three);
    mps_sim_destroy(one);
    mps_sim_destroy(four);
    mps_sim_destroy(hosted);
}

static void two_handles(void **state)
{
    (void)state;
    mps_sim *sim[] = {shaken_pool(2, NULL), shaken_pool(3, NULL)}, *one = shaken_pool(1, NULL);
    pthread_t thread[2];
    for (int k = 0; k < 2; k++)
        assert_int_equal(pthread_create(&thread[k], NULL, run_shortly, sim[k]), 0);
    for (int k = 0; k < 2; k++) {
        void *done = NULL;
        assert_int_equal(pthread_join(thread[k], &done), 0);
        assert_ptr_equal(done, sim[k]);
    }
    assert_non_null(run_shortly(one));
    for (int k = 0; k < 2; k++) {
        assert_same_state(one, sim[k]);
        ASSERT_OK(sim[k], mps_threads_set(sim[k], 3 - k));
        ASSERT_OK(sim[k], mps_step(sim[k], 1e-3, NULL));
    }
    assert_same_state(sim[0], sim[1]);
    mps_sim_destroy(one);
    for (int k = 0; k < 2; k++) mps_sim_destroy(sim[k]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_threads),    cmocka_unit_test(each_part_once),
        cmocka_unit_test(after_a_pause), cmocka_unit_test(nested_call),
        cmocka_unit_test(resize),        cmocka_unit_test(out_of_memory),
        cmocka_unit_test(rows_and_sums), cmocka_unit_test(host_and_pool_agree),
        cmocka_unit_test(two_handles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

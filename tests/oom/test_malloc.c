/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory of libraries that is not from the allocator of the handle: malloc() itself fails at its
 * k-th call, for k = 1, 2, ... SUNDIALS creates its objects when a solver is chosen; later steps
 * allocate nothing by malloc() except with sundials.klu, and nothing is printed. That is so with
 * SUNDIALS 6; 7 makes messages by malloc() in each step of KINSOL, whether or not they go anywhere,
 * and crashes where its contexts or KLU get no memory. Skipped with the address sanitizer, which
 * has its own malloc(). */
#include <math.h>
#include <mps/mps.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cmocka.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define CAN_FAIL 0
#else
#define CAN_FAIL 1
#endif

/* Only calls between arm() and disarm() count. */
static bool armed;
static int64_t calls, fail_at;

#if CAN_FAIL
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);

static bool fails(void)
{
    return armed && ++calls == fail_at;
}

void *malloc(size_t size)
{
    return fails() ? NULL : __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    return fails() ? NULL : __libc_calloc(count, size);
}
#endif

static void arm(int64_t k)
{
    calls = 0;
    fail_at = k;
    armed = true;
}

/* @return calls so far */
static int64_t disarm(void)
{
    armed = false;
    return calls;
}

/* The handle's own memory never fails: it is one block that only grows. */
static char store[64 << 20];
static size_t used;

static void *take(void *user, size_t size)
{
    (void)user;
    const size_t at = used;
    used += (size + 63) / 64 * 64;
    return used <= sizeof store ? store + at : NULL;
}

static void release(void *user, void *block)
{
    (void)user, (void)block;
}

static char logged[1024];

static void keep_log(void *user, int level, const char *text)
{
    (void)user, (void)level;
    snprintf(logged, sizeof logged, "%s", text);
}

static mps_sim *tank(const char *solver, const char *preconditioner)
{
    mps_config config;
    mps_tank box;
    mps_sim *sim;
    const double lo[2] = {0, 0}, hi[2] = {0.5, 0.3};
    used = 0;
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dp = 0.05;
    config.allocator = (mps_allocator){take, release, NULL};
    config.log = keep_log;
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    assert_int_equal(mps_tank_init(&box, sizeof box), MPS_OK);
    box.size[0] = box.size[1] = 0.5;
    assert_int_equal(mps_tank_add(sim, &box, NULL), MPS_OK);
    assert_int_equal(mps_fill_box_add(sim, 0, lo, hi, NULL, NULL), MPS_OK);
    if (solver) assert_int_equal(mps_solver_use(sim, solver, preconditioner), MPS_OK);
    return sim;
}

static const char *const solvers[][2] = {{"sundials.pcg", "auxgrid"},
                                         {"sundials.bicgstab", "jacobi"},
                                         {"sundials.gmres", "jacobi"},
                                         {"sundials.kinsol", "ic0"}};
enum { SOLVERS = sizeof solvers / sizeof solvers[0] };

/* How a child ends. */
enum { QUIET, PRINTS, LOGS, CRASHES };

/* What SUNDIALS reports is in the log, and the child's exit code is this. */
enum { LOGGED = 42 };

static int in_child(void (*body)(int64_t k, const char *const *solver), int64_t k,
                    const char *const *solver)
{
    int said[2], status = 0;
    char text[200] = "";
    assert_int_equal(pipe(said), 0);
    fflush(NULL);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        dup2(said[1], 2);
        signal(SIGSEGV, SIG_DFL); /* cmocka's would go on with the next test */
        body(k, solver);
        disarm();
        _exit(0);
    }
    close(said[1]);
    const ssize_t length = read(said[0], text, sizeof text - 1);
    close(said[0]);
    assert_int_equal(waitpid(child, &status, 0), child);
    if (length > 0) print_message("%s, call %lld, prints: %s\n", solver[0], (long long)k, text);
    if (WIFEXITED(status) && WEXITSTATUS(status) == LOGGED) return LOGS;
    return status ? CRASHES : length > 0 ? PRINTS : QUIET;
}

/* The calls of malloc() in steps, the first among them. */
static void steps_allocate_nothing(void **state)
{
    (void)state;
    if (!CAN_FAIL) skip();
    for (int s = 0; s < (SUNDIALS_MAJOR < 7 ? SOLVERS : SOLVERS - 1);
         s++) { /* kinsol is the last */
        mps_sim *sim = tank(solvers[s][0], solvers[s][1]);
        arm(0);
        for (int k = 0; k < 3; k++) assert_true(mps_step(sim, 1e-3, NULL) >= 0);
        const int64_t count = disarm();
        if (count != 0)
            fail_msg("%s: %lld calls of malloc() in steps", solvers[s][0], (long long)count);
        mps_sim_destroy(sim);
    }
}

static void step_with_klu(int64_t k, const char *const *solver)
{
    mps_sim *sim = tank(solver[0], NULL);
    arm(k);
    const mps_status status = mps_step(sim, 1e-3, NULL);
    if (disarm() < k) _exit(status != MPS_OK);
    if (status != MPS_E_NOMEM && status != MPS_E_SOLVER) _exit(8);
    if (mps_step(sim, 1e-3, NULL) != MPS_OK) _exit(9);
    mps_sim_destroy(sim);
}

/* sundials.klu makes its matrix in each step. */
static void klu_fails_in_order(void **state)
{
    (void)state;
    static const char *const klu[2] = {"sundials.klu", NULL};
    if (!CAN_FAIL || SUNDIALS_MAJOR >= 7) skip();
    for (int64_t k = 1; k <= 24; k++) assert_int_equal(in_child(step_with_klu, k, klu), QUIET);
}

static void choose(int64_t k, const char *const *solver)
{
    mps_sim *sim = tank(NULL, NULL);
    arm(k);
    const mps_status status = mps_solver_use(sim, solver[0], solver[1]);
    if (disarm() < k) _exit(status == MPS_OK ? 0 : 8);
    if (status != MPS_E_NOMEM) _exit(9);
    if (mps_step(sim, 1e-3, NULL) != MPS_OK) _exit(10); /* with the solver of before */
    mps_sim_destroy(sim);
    if (strstr(logged, "SUNDIALS")) _exit(LOGGED);
}

/* Choosing a solver returns MPS_E_NOMEM for each failing call, except for errors of SUNDIALS
 * itself: SUNLogger_Create() of 6.x to 7.5 uses the table of its files without a check for NULL
 * (the second and third call), and KINCreate() of 6.x prints. */
static void choice_is_refused(void **state)
{
    (void)state;
    if (!CAN_FAIL || SUNDIALS_MAJOR >= 7) skip();
    for (int s = 0; s < SOLVERS; s++) {
        const bool kinsol = strcmp(solvers[s][0], "sundials.kinsol") == 0;
        int ends[CRASHES + 1] = {0};
        for (int64_t k = 1; k <= 200; k++) {
            const int end = in_child(choose, k, solvers[s]);
            if (end == CRASHES && k > 4)
                fail_msg("%s: crashes at call %lld", solvers[s][0], (long long)k);
            ends[end]++;
        }
        assert_in_range(ends[CRASHES], 0, 2);
        assert_in_range(ends[PRINTS], 0, kinsol);
        if (kinsol) assert_in_range(ends[LOGS], 1, 20);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_allocate_nothing),
        cmocka_unit_test(klu_fails_in_order),
        cmocka_unit_test(choice_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

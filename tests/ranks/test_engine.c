/* SPDX-License-Identifier: BSD-3-Clause */
/* The engine of threads against the kit. */
#include "kit_engine.h"
#include "engine_kit.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

enum { MOST = 7 };

typedef struct job {
    kit_engine_team *team;
    int32_t also;
    int call; /* -1: no failure */
    double balance;
    char fault[MOST][ENGINE_TEXT], said[MOST][ENGINE_TEXT];
} job;

static void run_rank(void *argument, int32_t rank)
{
    job *j = argument;
    const mps_ranks_ops ops = kit_engine_ops(j->team, rank);
    if (j->call < 0)
        engine_kit_check(&ops, j->balance, j->fault[rank]);
    else
        engine_kit_fail(&ops, j->call, j->also, j->said[rank], j->fault[rank]);
}

static void check(int32_t ranks, uint32_t skew, int call, int32_t also)
{
    job j = {.team = kit_engine_create(ranks, skew), .call = call, .also = also};
    j.balance = skew ? 0 : 1.05;
    kit_engine_run(j.team, run_rank, &j);
    for (int32_t r = 0; r < ranks; r++) {
        assert_string_equal(j.fault[r], "");
        assert_string_equal(j.said[r], j.said[0]);
    }
    kit_engine_destroy(j.team);
}

static void test_calls(void **state)
{
    (void)state;
    for (int32_t ranks = 1; ranks <= 4; ranks++) check(ranks, 0, -1, -1);
    check(3, 1, -1, -1);
    check(MOST, 0, -1, -1);
}

static void test_failures(void **state)
{
    (void)state;
    for (int call = 0; call < ENGINE_CALLS; call++)
        for (int32_t ranks = 1; ranks <= 4; ranks++) {
            check(ranks, 0, call, -1);
            check(ranks, 0, call, 0);
        }
}

/* ---- a rank that makes one call less ---- */

typedef struct absence {
    kit_engine_team *team;
    char said[MOST][ENGINE_TEXT];
} absence;

static void keep(void *into, const void *from)
{
    (void)into, (void)from;
}

static void stay_away(void *argument, int32_t rank)
{
    absence *a = argument;
    const mps_ranks_ops ops = kit_engine_ops(a->team, rank);
    int32_t value = 0;
    for (int k = 0; k < (rank == 1 ? 2 : 3); k++)
        ops.reduce(ops.user, 1, sizeof value, &value, keep);
    const char *what = ops.failure(ops.user);
    if (rank != 1) snprintf(a->said[rank], ENGINE_TEXT, "%s", what ? what : "");
}

static void test_absence(void **state)
{
    (void)state;
    absence a = {.team = kit_engine_create(3, 0)};
    kit_engine_run(a.team, stay_away, &a);
    assert_string_equal(a.said[0],
                        "ranks make different calls: 'reduce' on rank 0, none on rank 1");
    assert_string_equal(a.said[2], a.said[0]);
    kit_engine_destroy(a.team);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_calls),
                                       cmocka_unit_test(test_failures),
                                       cmocka_unit_test(test_absence)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

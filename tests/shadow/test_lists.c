/* SPDX-License-Identifier: BSD-3-Clause */
/* Neighbour lists in two memory spaces: use by the host between two steps, and their state after a
 * failed copy. */
#define _POSIX_C_SOURCE 200809L
#include "scene.h"
#include <mps/couple.h>

/* Rows of the host are built at the positions after a step, those of the device are older then. */
static void get_rows(mps_sim *sim)
{
    mps_stencil near;
    assert_int_equal(mps_stencil_init(&near, sizeof near), MPS_OK);
    ASSERT_OK(sim, mps_stencil_get(sim, MPS_NEAR, &near));
}

static void rows_of_the_host_between_steps(void **state)
{
    static const char *const preset[] = {"imps", "mmps", "imps.paper", "mmps.paper"};
    (void)state;
    for (int p = 0; p < 4; p++) {
        mps_sim *host = rolling(preset[p], 2), *sim = rolling(preset[p], 2);
        shadow s;
        shadow_attach(&s, sim);
        for (int k = 0; k < 30; k++) {
            ASSERT_OK(host, mps_step(host, 0.002, NULL));
            ASSERT_OK(sim, mps_step(sim, 0.002, NULL));
            if (k % 3 < 2) continue;
            get_rows(host);
            get_rows(sim);
            same(host, sim);
        }
        mps_sim_destroy(host);
        mps_sim_destroy(sim);
    }
}

/* If any copy fails, with any result: the next step has the candidates of the previous search, and
 * the host their rows. */
static void copies_that_fail(void **state)
{
    mps_sim *host = rolling("imps", 2), *sim = rolling("imps", 2);
    const mps_neighbours *l = &sim->world.lists.neighbours;
    int64_t failed = 0, torn = 0;
    shadow s;
    (void)state;
    ASSERT_OK(host, mps_load_watch(host, MPS_LOAD_MASS)); /* it reads rows on the host in a step */
    ASSERT_OK(sim, mps_load_watch(sim, MPS_LOAD_MASS));
    shadow_attach(&s, sim);
    for (int64_t k = 0; k < 120; k++) {
        const int64_t before = s.downloads;
        ASSERT_OK(host, mps_step(host, 0.001, NULL));
        ASSERT_OK(sim, mps_step(sim, 0.001, NULL));
        same(host, sim);
        const int64_t copies = s.downloads - before;
        s.loses_at = s.downloads + 1 + (copies > 0 ? k % copies : 0);
        const mps_status status = mps_step(sim, 0.001, NULL);
        s.loses_at = 0;
        if (status == MPS_OK) { /* with fewer of them */
            ASSERT_OK(host, mps_step(host, 0.001, NULL));
            continue;
        }
        assert_non_null(strstr(mps_sim_error(sim), "device 'shadow' failed"));
        failed++;
        torn += l->torn && l->valid;
    }
    assert_true(failed > 80 && torn > 5);
    mps_sim_destroy(host);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_of_the_host_between_steps),
        cmocka_unit_test(copies_that_fail),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

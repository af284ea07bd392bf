/* SPDX-License-Identifier: BSD-3-Clause */
/* Lists of neighbours at two places: what the host does with them between two steps, and what a failed copy leaves of them. */
#define _POSIX_C_SOURCE 200809L
#include "scene.h"

/* Rows of the host are made at the places after a step, those of the device are older by then. */
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_of_the_host_between_steps),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Measures of the interface of a droplet at rest in air without gravity: box and roundness of its
 * outline, pressure inside. */
#include "job_fixture.h"
#include <mps/case.h>

static const char DROP[] =
    "mps: 1\ndp: 20 mm\ngravity: 0 m/s2\ntank: {size: 1 1 m}\nmodel: mmps\n"
    "settings: {tension.sigma: 72.7 mN/m}\n"
    "fill: [{water: {sphere: {centre: 0.5 0.5 m, radius: 0.2 m}}}, {air: rest}]\n"
    "sensors:\n  top: {measure: interface_top}\n  bottom: {measure: interface_bottom}\n"
    "  round: {measure: circularity}\n  a: {measure: half_axis, axis: x}\n"
    "  jump: {measure: pressure_jump, radius: 0.2 m, about: 0.5 0.5 m}\n"
    "  gas: {measure: centre, fluid: air, axis: x}\n"
    "  far: {measure: pressure_jump, radius: 5 m, about: 0.5 0.5 m}\n"
    "run: {until: 2 ms, threads: 1}\noutput: {rate: 1 kHz, frames: 0}\n";

static void drop(void **state)
{
    const double pi = acos(-1.0);
    mps_case *c;
    mps_job *job;
    mps_sim *sim;
    mps_job_config config;
    (void)state;
    assert_int_equal(mps_job_config_init(&config, sizeof config), MPS_OK);
    config.folder = "drop";
    config.print = listen;
    config.report = 0;
    assert_int_equal(mps_case_read_text(DROP, sizeof DROP - 1, "drop.yaml", 0, NULL, &c), MPS_OK);
    if (mps_case_job(c, &config, &job, &sim) != MPS_OK) {
        mps_case_messages_write(c, said, sizeof said);
        fail_msg("%s", said);
    }
    assert_int_equal(mps_job_run(job, sim), MPS_EXIT_OK);
    for (int row = 0; row < 3; row++) {
        ASSERT_NEAR(number_in("drop", "probes.csv", row, 1), 0.7, 0.01);
        ASSERT_NEAR(number_in("drop", "probes.csv", row, 2), 0.3, 0.01);
        /* of what is not phase 0: the square without the drop, with the line of the drop */
        ASSERT_NEAR(number_in("drop", "probes.csv", row, 3),
                    2 * sqrt(pi * (1 - pi * 0.04)) / (2 * pi * 0.2), 0.02);
        ASSERT_NEAR(number_in("drop", "probes.csv", row, 5), 0.0727 / 0.2, 0.04);
        ASSERT_NEAR(number_in("drop", "probes.csv", row, 4), 0.2, 0.01);
        ASSERT_NEAR(number_in("drop", "probes.csv", row, 6), 0.5, 1e-6);
        assert_true(isnan(number_in("drop", "probes.csv", row, 7))); /* no fluid that far out */
    }
    mps_sim_destroy(sim);
    mps_job_destroy(job);
    mps_case_destroy(c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(drop)};
    return cmocka_run_group_tests(tests, enter_folder, leave_folder);
}

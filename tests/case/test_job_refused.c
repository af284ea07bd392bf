/* SPDX-License-Identifier: BSD-3-Clause */
/* Refusals of a job, member by member, and the limits of its texts. */
#include "job_fixture.h"

static void configs(void **state)
{
    static const double beyond[] = {0.01, INFINITY}, zero[] = {0, 0.01};
    const mps_job_config good = config_of("refused");
    mps_job_ranks ranks = {.struct_size = sizeof ranks, .count = 0};
    mps_job_config c;
    (void)state;
    c = good, c.name = "", refused(&c, MPS_E_ARG, "name is required");
    c = good, c.folder = NULL, refused(&c, MPS_E_ARG, "folder is required");
    c = good, c.t_end = INFINITY, refused(&c, MPS_E_ARG, "t_end must be > 0");
    c = good, c.row_interval = INFINITY, refused(&c, MPS_E_ARG, "row_interval must be > 0");
    c.row_interval = NAN, refused(&c, MPS_E_ARG, "row_interval must be > 0");
    c = good, c.checkpoint = INFINITY, refused(&c, MPS_E_ARG, "checkpoint must be >= 0");
    c.checkpoint = NAN, refused(&c, MPS_E_ARG, "checkpoint must be >= 0");
    c = good, c.dp = INFINITY, refused(&c, MPS_E_ARG, "dp must be >= 0");
    c = good, c.report = 1, c.page_bytes = 499999;
    refused(&c, MPS_E_ARG, "page_bytes must be >= 500000");
    c = good, c.picture_count = -1, refused(&c, MPS_E_ARG, "picture_count must be >= 0");
    c = good, c.picture_count = 2, c.picture_t = beyond, refused(&c, MPS_E_ARG, "picture_t");
    c.picture_t = zero, refused(&c, MPS_E_ARG, "picture_t must be increasing times greater than 0");
    c = good, c.ranks = &ranks, refused(&c, MPS_E_ARG, "mps_job_ranks_load()");
    ranks.count = 1, ranks.struct_size--;
    refused(&c, MPS_E_ARG, "mps_job_ranks_load()");
    /* without a buffer for a text there is only the status */
    mps_job *job = (mps_job *)&c;
    char error[4] = "abc";
    c = good, c.name = NULL, c.error = error, c.error_size = 0;
    assert_int_equal(mps_job_create(&c, &job), MPS_E_ARG);
    assert_null(job);
    assert_string_equal(error, "abc");
    c.error = NULL;
    assert_int_equal(mps_job_create(&c, &job), MPS_E_ARG);
    assert_false(is_there(".", "refused"));
}

static double one(void *user, mps_sim *sim)
{
    (void)user, (void)sim;
    return 1;
}

/* The longest name, unit and explanation, and those of one letter more. */
static void texts(void **state)
{
    char name[33], unit[17], about[241];
    const mps_job_config c = config_of("texts");
    mps_job *job = job_of(&c);
    (void)state;
    memset(name, 'n', 32), name[31] = '\0';
    memset(unit, 'u', 16), unit[15] = '\0';
    memset(about, 'a', 240), about[239] = '\0';
    assert_int_equal(mps_job_value_add(job, name, unit, about, 0, one, NULL), MPS_OK);
    name[31] = 'n', name[32] = '\0';
    ASSERT_JOB_REFUSED(job, mps_job_value_add(job, name, "m", "", 0, one, NULL), MPS_E_ARG,
                       "a name has 1 to 31 letters");
    unit[15] = 'u', unit[16] = '\0';
    ASSERT_JOB_REFUSED(job, mps_job_value_add(job, "a", unit, "", 0, one, NULL), MPS_E_ARG,
                       "a unit has at most 15 characters");
    about[239] = 'a', about[240] = '\0';
    ASSERT_JOB_REFUSED(job, mps_job_value_add(job, "a", "m", about, 0, one, NULL), MPS_E_ARG,
                       "'about' has at most 239 characters");
    ASSERT_JOB_REFUSED(job, mps_job_value_add(job, NULL, "m", "", 0, one, NULL), MPS_E_ARG,
                       "a name has 1 to 31 letters");
    ASSERT_JOB_REFUSED(job, mps_job_value_add(job, "a", NULL, "", 0, one, NULL), MPS_E_ARG,
                       "a unit has");
    mps_job_destroy(job);
}

static void series(void **state)
{
    static const double t[] = {0, 1}, wrong[] = {0, NAN}, places[] = {0, 0, 0, 1, NAN, 0};
    const mps_job_config c = config_of("series");
    mps_job *job = job_of(&c);
    mps_sim *sim = water();
    mps_reference r;
    mps_probe probe;
    (void)state;
    assert_int_equal(mps_reference_init(&r, sizeof r - 1), MPS_E_ARG);
    assert_int_equal(mps_reference_init(NULL, sizeof r), MPS_E_ARG);
    assert_int_equal(mps_reference_init(&r, sizeof r), MPS_OK);
    r.label = "known";
    r.unit = "m";
    r.count = 2;
    r.t = t;
    ASSERT_JOB_REFUSED(job, mps_job_reference_add(job, &r), MPS_E_ARG, "'known': needs a label");
    r.value = wrong;
    ASSERT_JOB_REFUSED(job, mps_job_reference_add(job, &r), MPS_E_ARG, "'known': needs a label");
    r.value = t, r.t = wrong;
    ASSERT_JOB_REFUSED(job, mps_job_reference_add(job, &r), MPS_E_ARG, "'known': needs a label");
    r.t = NULL;
    ASSERT_JOB_REFUSED(job, mps_job_reference_add(job, &r), MPS_E_ARG, "'known': needs a label");
    r.t = t, r.count = 0;
    ASSERT_JOB_REFUSED(job, mps_job_reference_add(job, &r), MPS_E_ARG, "'known': needs a label");
    r.count = 2, r.unit = NULL;
    ASSERT_JOB_REFUSED(job, mps_job_reference_add(job, &r), MPS_E_ARG, "'known': needs a label");
    r.unit = "m", r.struct_size--;
    assert_int_equal(mps_job_reference_add(job, &r), MPS_E_ARG);
    assert_int_equal(mps_job_reference_add(NULL, &r), MPS_E_ARG);
    ASSERT_JOB_REFUSED(job, mps_job_input_add(job, NULL, "x"), MPS_E_ARG, "a key and a value");
    ASSERT_JOB_REFUSED(job, mps_job_input_add(job, "k", NULL), MPS_E_ARG, "a key and a value");
    ASSERT_JOB_REFUSED(job, mps_job_outline_add(job, 2, NULL), MPS_E_ARG, "two places");
    ASSERT_JOB_REFUSED(job, mps_job_outline_add(job, 3, places), MPS_E_ARG, "two places");
    ASSERT_JOB_REFUSED(job, mps_job_edges_add(job, 0, places), MPS_E_ARG, "two places each");
    ASSERT_JOB_REFUSED(job, mps_job_edges_add(job, 1, NULL), MPS_E_ARG, "two places each");
    ASSERT_JOB_REFUSED(job, mps_job_edges_add(job, 1, places), MPS_E_ARG, "two places each");
    ASSERT_JOB_REFUSED(job, mps_job_edges_add(job, INT32_MAX, places), MPS_E_ARG, "two places");
    assert_int_equal(mps_job_input_add(NULL, "k", "v"), MPS_E_ARG);
    assert_int_equal(mps_job_outline_add(NULL, 2, places), MPS_E_ARG);
    assert_int_equal(mps_job_edges_add(NULL, 1, places), MPS_E_ARG);
    assert_int_equal(mps_job_level_set(NULL, 1), MPS_E_ARG);
    assert_int_equal(mps_probe_init(&probe, sizeof probe), MPS_OK);
    probe.at[1] = 0.08;
    ASSERT_JOB_REFUSED(job, mps_job_probe_add(job, sim, &probe, -1, 0, "P", NULL), MPS_E_ARG,
                       "component is -1, must be 0 to 0");
    mps_job_destroy(job);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(configs), cmocka_unit_test(texts),
                                       cmocka_unit_test(series)};
    return cmocka_run_group_tests(tests, enter_folder, leave_folder);
}

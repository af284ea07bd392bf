/* SPDX-License-Identifier: BSD-3-Clause */
/* cavitation.vapour: the suction of a tank that accelerates away from its liquid is limited by the
 * model; with less suction the bytes are unchanged. */
#define _POSIX_C_SOURCE 200809L
#include "tank_fixture.h"

static const double LENGTH = 0.8;

/* Half of the tank is liquid, the rest gas with `mmps`; walls may pull. `least` 0: without the
 * model [Pa] */
static mps_sim *build(const char *preset, int32_t dim, double least)
{
    const double dp = 0.05, across = dim == 3 ? 0.3 : 0, lo[3] = {0, 0, 0},
                 hi[3] = {LENGTH, 0.4, across}, all[3] = {LENGTH, 0.8, across};
    mps_sim *sim = new_sim(dim, dp);
    ASSERT_OK(sim, mps_preset_use(sim, preset));
    if (strcmp(preset, "imps") == 0) ASSERT_OK(sim, mps_model_remove(sim, "separation"));
    if (least == 0 && strcmp(preset, "mmps") == 0)
        ASSERT_OK(sim, mps_model_remove(sim, "cavitation"));
    if (least > 0) ASSERT_OK(sim, mps_model_use(sim, "cavitation.vapour"));
    if (least > 0) ASSERT_OK(sim, mps_model_set(sim, "cavitation", "least", least));
    add_tank(sim, LENGTH, 0.8, across);
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    if (strcmp(preset, "mmps") == 0) fill_air(sim, lo, all);
    ASSERT_OK(sim, mps_motion_callback_set(sim, pull_away, NULL));
    return sim;
}

enum { MOST = 20000 };

/* What a run has shown. */
typedef struct outcome {
    double lowest, lasting; /* pressure of a step; of a row in two steps running, the higher one */
    double end;             /* a sum of the last positions */
    int64_t rows;           /* at a least pressure, of all steps */
} outcome;

static void note_pressures(mps_sim *sim, double *before, outcome *o)
{
    const int64_t *id;
    mps_lease p = {.struct_size = sizeof p};
    ASSERT_OK(sim, tags_peek(sim, &id, NULL, NULL, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, "pressure", MPS_READ, &p));
    assert_non_null(id);
    for (int64_t i = 0; id && i < p.count; i++) {
        const double now = p.data[i * p.stride];
        assert_in_range(id[i], 0, MOST - 1);
        o->lowest = fmin(o->lowest, now);
        o->lasting = fmin(o->lasting, fmax(now, before[id[i]]));
        before[id[i]] = now;
    }
    ASSERT_OK(sim, mps_lease_end(sim, &p));
}

static outcome run(const char *preset, int32_t dim, double least)
{
    const double t = 0.12;
    static double before[MOST];
    outcome o = {0};
    memset(before, 0, sizeof before);
    mps_sim *sim = build(preset, dim, least);
    mps_step_info info;
    mps_lease x = {.struct_size = sizeof x};
    assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
    while (info.t < t * (1 - 1e-12)) {
        ASSERT_OK(sim, mps_step(sim, t - info.t, &info));
        o.rows += info.separated;
        note_pressures(sim, before, &o);
    }
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &x));
    for (int64_t i = 0; i < x.count; i++) o.end += x.data[i * x.stride] * (double)(1 + i % 97);
    ASSERT_OK(sim, mps_lease_end(sim, &x));
    mps_sim_destroy(sim);
    return o;
}

/* In two successive steps; a row may be below for one step. If no row comes near the least
 * pressure, bytes are those without the model. */
static void pulls_no_harder(void **state)
{
    static const char *const presets[] = {"imps", "mmps"};
    const double least = 2000;
    (void)state;
    for (int k = 0; k < 2; k++)
        for (int32_t dim = 2; dim <= 3; dim++) {
            const outcome without = run(presets[k], dim, 0), with = run(presets[k], dim, least),
                          far = run(presets[k], dim, 1e6);
            print_message("%s in %d-D: lowest pressure %.0f Pa, lasting %.0f; at least -%.0f: "
                          "%.0f, lasting %.0f, %lld rows\n",
                          presets[k], (int)dim, without.lowest, without.lasting, least, with.lowest,
                          with.lasting, (long long)with.rows);
            assert_true(without.lasting < -1.5 * least);
            assert_true(with.lasting >= -1.01 * least && with.lasting < -0.8 * least);
            assert_true(with.lowest > without.lowest && with.rows > 0);
            assert_true(far.lowest == without.lowest && far.end == without.end);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(pulls_no_harder)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

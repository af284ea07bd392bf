/* SPDX-License-Identifier: BSD-3-Clause */
/* Plug-ins on a device: a preconditioner, a solver and a model run there, with the bytes of the
 * host. */
#define _POSIX_C_SOURCE 200809L
#include "plugins.h"
#include "scene.h"
#include "solutions.h"

static mps_sim *with_solvers(mps_sim *sim, const char *solver, const char *preconditioner)
{
    mps_preconditioner_ops waiting = plugin_neumann;
    waiting.name = "test.waiting";
    waiting.setup_async = 0;
    ASSERT_OK(sim, mps_preconditioner_register(sim, &plugin_neumann));
    ASSERT_OK(sim, mps_preconditioner_register(sim, &waiting));
    ASSERT_OK(sim, mps_solver_register(sim, &plugin_cg));
    ASSERT_OK(sim, mps_solver_use(sim, solver, preconditioner));
    return sim;
}

/* ---- solvers ---- */

/* All ends of a solution, with both times at which a set-up may be called. */
static void preconditioner_solves(void **state)
{
    static const kit_lattice lattice = {
        .dim = 2, .nx = 60, .ny = 40, .nz = 1, .boxes = 1, .open = 1, .re = 3.1, .contrast = 1};
    static const solution cases[] = {
        {"converged", MPS_PPE_CONVERGED, 2000, 0, 1e-6, NULL},
        {"deep", -1, 2000, 0, 1e-13, NULL},
        {"from NaN", MPS_PPE_CONVERGED, 2000, NAN, 1e-6, NULL},
        {"9 iterations", MPS_PPE_MAX_ITERATIONS, 9, 0, 1e-12, NULL},
        {"NaN", MPS_PPE_NAN, 2000, 0, 1e-6, with_nan},
        {"zeros", MPS_PPE_CONVERGED, 2000, 0, 1e-6, with_zeros},
        {"negative curvature", MPS_PPE_INDEFINITE, 2000, 0, 1e-6, with_curvature},
        {"negative row", MPS_PPE_INDEFINITE, 2000, 0, 1e-6, with_negative_row}};
    static const char *const names[] = {"test.neumann", "test.waiting"};
    (void)state;
    for (int k = 0; k < 2; k++) {
        mps_sim *sim = new_sim(2, 0.1);
        shadow s;
        shadow_heap(sim);
        with_solvers(sim, "sundials.pcg", names[k]);
        shadow_attach(&s, sim);
        for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++)
            compare_solution(sim, &lattice, &cases[c], names[k]);
        assert_true(shadow_seen(&s, "plugins.c", "correct_rows") > 0);
        mps_sim_destroy(sim);
        assert_int_equal(s.blocks, 0);
    }
}

/* Steps; later the device is detached and attached. */
static void compare_steps(const char *preset, int32_t dim, const char *solver,
                          const char *preconditioner)
{
    mps_sim *host = with_solvers(rolling(preset, dim), solver, preconditioner),
            *sim = with_solvers(rolling(preset, dim), solver, preconditioner);
    shadow s;
    for (int k = 0; k < 9; k++) {
        if (k % 3 == 0) shadow_attach(&s, sim);
        ASSERT_OK(host, mps_step(host, 0.01, NULL));
        ASSERT_OK(sim, mps_step(sim, 0.01, NULL));
        same(host, sim);
        if (k % 3 != 2) continue;
        assert_int_equal(shadow_counts(sim).host_calls, 0);
        assert_true(shadow_seen(&s, "plugins.c", "correct_rows") > 0);
        assert_int_equal(shadow_seen(&s, "plugins.c", "advance_rows") > 0,
                         strcmp(solver, "test.cg") == 0);
        ASSERT_OK(sim, mps_sim_device_set(sim, NULL));
        assert_int_equal(s.blocks, 0);
    }
    mps_sim_destroy(host);
    mps_sim_destroy(sim);
}

static void steps_with_preconditioner(void **state)
{
    (void)state;
    compare_steps("imps", 2, "sundials.pcg", "test.neumann");
    compare_steps("mmps", 2, "sundials.pcg", "test.waiting");
}

static void steps_with_solver(void **state)
{
    (void)state;
    compare_steps("imps", 2, "test.cg", NULL);
    compare_steps("imps", 3, "test.cg", "test.waiting");
}

/* A full tank: the pressures have no datum, which a solver without hints does not know. */
static mps_sim *full_tank(void)
{
    mps_sim *sim = new_sim(2, 0.05);
    shadow_heap(sim);
    ASSERT_OK(sim, mps_preset_use(sim, "imps"));
    add_tank(sim, 0.6, 0.6, 0.4);
    fill_depth(sim, 0.6, 0.6, 0.4);
    shake(sim, 0.05);
    return with_solvers(sim, "test.cg", "jacobi");
}

static void steps_without_datum(void **state)
{
    mps_sim *host = full_tank(), *sim = full_tank();
    shadow s;
    (void)state;
    shadow_attach(&s, sim);
    for (int k = 0; k < 4; k++) {
        ASSERT_OK(host, mps_step(host, 0.01, NULL));
        ASSERT_OK(sim, mps_step(sim, 0.01, NULL));
        same(host, sim);
        assert_true(sim->world.ppe.lacking || sim->world.ppe.level_free);
    }
    mps_sim_destroy(host);
    mps_sim_destroy(sim);
}

/* The fallback of a plug-in, and what it needs. */
static void fallbacks(void **state)
{
    mps_preconditioner_ops ops = plugin_neumann;
    mps_sim *sim = new_sim(2, 0.1);
    (void)state;
    ops.fallback = "jacobbi";
    ASSERT_REFUSED(sim, mps_preconditioner_register(sim, &ops), MPS_E_NAME,
                   "did you mean 'jacobi'");
    ops.fallback = "ic0"; /* it has no `device` */
    ASSERT_REFUSED(sim, mps_preconditioner_register(sim, &ops), MPS_E_ARG,
                   "the fallback 'ic0' of preconditioner 'test.neumann' needs");
    ops.fallback = "jacobi";
    ASSERT_OK(sim, mps_preconditioner_register(sim, &ops));
    mps_sim_destroy(sim);
}

/* ---- models ---- */

static mps_sim *with_model(mps_sim *sim, const mps_model_ops *ops)
{
    ASSERT_OK(sim, mps_model_register(sim, ops));
    ASSERT_OK(sim, mps_model_use(sim, ops->name));
    return sim;
}

static void steps_with_model(void **state)
{
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) {
        mps_sim *host = with_model(rolling("imps", dim), &plugin_drag),
                *sim = with_model(rolling("imps", dim), &plugin_drag);
        shadow s;
        shadow_attach(&s, sim);
        for (int k = 0; k < 6; k++) {
            if (k == 3) ASSERT_OK(host, mps_model_set(host, "drag", "rate", 5));
            if (k == 3) ASSERT_OK(sim, mps_model_set(sim, "drag", "rate", 5));
            ASSERT_OK(host, mps_step(host, 0.01, NULL));
            ASSERT_OK(sim, mps_step(sim, 0.01, NULL));
            same(host, sim);
            assert_int_equal(shadow_counts(sim).host_calls, 0);
        }
        assert_true(shadow_seen(&s, "plugins.c", "pull_rows") >= 6);
        mps_sim_destroy(host);
        mps_sim_destroy(sim);
        assert_int_equal(s.blocks, 0);
    }
}

/* A value that the library refuses has the same text from both memory spaces. */
static void wrong_values(void **state)
{
    mps_sim *host = with_model(rolling("imps", 2), &plugin_mark),
            *sim = with_model(rolling("imps", 2), &plugin_mark);
    shadow s;
    (void)state;
    shadow_attach(&s, sim);
    for (int bad = 1; bad >= 0; bad--) {
        ASSERT_OK(host, mps_model_set(host, "mark", "bad", bad));
        ASSERT_OK(sim, mps_model_set(sim, "mark", "bad", bad));
        const mps_status status = mps_step(host, 0.01, NULL);
        assert_int_equal(status, bad ? MPS_E_PLUGIN : MPS_OK);
        assert_int_equal(mps_step(sim, 0.01, NULL), status);
        if (bad) assert_non_null(strstr(mps_sim_error(host), "left region 77 at particle 40"));
        if (bad) assert_string_equal(mps_sim_error(host), mps_sim_error(sim));
    }
    same(host, sim);
    assert_true(shadow_seen(&s, "plugins.c", "mark_rows") > 0);
    mps_sim_destroy(host);
    mps_sim_destroy(sim);
}

/* A device with the loops of the library only: plug-ins run on the host. */
static void without_their_loops(void **state)
{
    mps_sim *host = with_model(with_solvers(rolling("imps", 2), "sundials.pcg", "test.neumann"),
                               &plugin_drag),
            *sim = with_model(with_solvers(rolling("imps", 2), "sundials.pcg", "test.neumann"),
                              &plugin_drag);
    shadow s;
    (void)state;
    shadow_attach(&s, sim);
    s.ops.plugin_loops = 0;
    ASSERT_OK(sim, mps_sim_device_set(sim, &s.ops));
    go(host, 3);
    go(sim, 3);
    same(host, sim);
    assert_int_equal(shadow_counts(sim).host_calls, 1); /* the verb; the log names the solution */
    assert_int_equal(shadow_seen(&s, "plugins.c", "pull_rows"), 0);
    assert_int_equal(shadow_seen(&s, "plugins.c", "correct_rows"), 0);
    mps_sim_destroy(host);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(preconditioner_solves),
        cmocka_unit_test(steps_with_preconditioner),
        cmocka_unit_test(steps_with_solver),
        cmocka_unit_test(steps_without_datum),
        cmocka_unit_test(fallbacks),
        cmocka_unit_test(steps_with_model),
        cmocka_unit_test(wrong_values),
        cmocka_unit_test(without_their_loops),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

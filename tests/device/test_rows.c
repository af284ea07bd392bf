/* SPDX-License-Identifier: BSD-3-Clause */
/* Kernels made from the loops of the library give the bytes of the host: each loop of a step runs
 * on both sides. */
#define _POSIX_C_SOURCE 200809L
#include "checkpoint_fixture.h"
#include "launch.h"
#include "loops.h"
#include "ranks.h"
#include "search_fixture.h"
#include "solutions.h"

static opencl device;

/* ---- steps ---- */

/* A tank that rolls, half full, with air above the liquid if a preset is for two phases. */
static mps_sim *rolling(const char *preset, int32_t dim)
{
    const double dp = dim == 2 ? 0.05 : 0.1, lo[3] = {0, 0, 0}, hi[3] = {0.6, 0.6, 0.4};
    mps_sim *sim = new_sim(dim, dp);
    ASSERT_OK(sim, mps_preset_use(sim, preset));
    add_tank(sim, 0.6, 0.6, 0.4);
    fill_depth(sim, 0.6, 0.3, 0.4);
    if (strncmp(preset, "mmps", 4) == 0) fill_air(sim, lo, hi);
    shake(sim, 0.05);
    return sim;
}

/* Equal steps on the host and on the device, also with equal statuses: some models fail together
 * with others. */
static void compare(mps_sim *host, mps_sim *sim, int steps)
{
    mps_device_info info;
    opencl_attach(&device, sim);
    for (int k = 0; k < steps; k++) {
        loops_watch(&device);
        const mps_status status = mps_step(sim, 0.01, NULL);
        loops_watch(NULL);
        assert_int_equal(status, mps_step(host, 0.01, NULL));
    }
    assert_int_equal(mps_device_info_init(&info, sizeof info), MPS_OK);
    assert_int_equal(mps_sim_device_info(sim, &info), MPS_OK);
    assert_true(info.launches > 0);
    same(host, sim);
    mps_sim_destroy(host);
    mps_sim_destroy(sim);
    if (device.failure[0]) fail_msg("%s", device.failure);
    if (device.difference[0]) fail_msg("%s", device.difference);
}

static void presets(void **state)
{
    static const char *const preset[] = {"imps", "mmps", "imps.paper", "mmps.paper"};
    (void)state;
    for (int k = 0; k < 4; k++)
        for (int32_t dim = 2; dim <= 3; dim++)
            compare(rolling(preset[k], dim), rolling(preset[k], dim), 5);
}

/* Loops of grids of the host and of a device. */
static const char *const of_grids[] = {"auxgrid_transfer__add_visits in 2-D",
                                       "auxgrid_transfer__add_visits in 3-D",
                                       "auxgrid_cycle__relax_rows in 2-D",
                                       "auxgrid_cycle__relax_rows in 3-D",
                                       "auxgrid_cycle__begin_rows in 2-D",
                                       "auxgrid_cycle__correct_rows in 2-D",
                                       "auxgrid_cycle__correct_rows in 3-D",
                                       "auxgrid_cycle__rest_rows in 2-D",
                                       "auxgrid_cycle__rest_rows in 3-D",
                                       "auxgrid_coarse__restrict_rows in 2-D",
                                       "auxgrid_coarse__merge_rows in 2-D",
                                       "auxgrid_coarse__merge_rows in 3-D",
                                       "auxgrid_coarse__fill_rows in 2-D",
                                       "auxgrid_coarse__fill_rows in 3-D",
                                       "sort__merge_rows in 2-D",
                                       "auxgrid_sort__neighbour_rows in 3-D",
                                       "auxgrid_edges__edge_rows in 2-D",
                                       "auxgrid_edges__edge_rows in 3-D",
                                       "auxgrid_last__factorise_last in 2-D",
                                       "auxgrid_last__solve_last in 2-D",
                                       "cg__decisions in 2-D",
                                       "cg__redirections in 2-D",
                                       "cg__advances in 2-D",
                                       "cg_passes__beginnings in 2-D",
                                       "cg_passes__guesses in 2-D",
                                       "cg_passes__checks in 2-D",
                                       "cg_passes__poisons in 2-D",
                                       "cg_passes__corrections in 2-D",
                                       "cg_passes__reports in 2-D",
                                       "ppe__bounded_rows in 2-D",
                                       "ppe__settle_rows in 2-D",
                                       "levels__lacking_rows in 2-D",
                                       "jacobi__invert_rows_device in 2-D"};

static void assert_have_run(const char *const *loops, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        bool there = false;
        for (int m = 0; m < device.kernels && !there; m++)
            there = strstr(device.kernel[m].name, loops[k]) && device.kernel[m].launches > 0;
        if (!there) fail_msg("%s has not run", loops[k]);
    }
}

/* So many cells that auxgrid has a second grid; and jacobi. */
static mps_sim *fine(int32_t dim, const char *preconditioner)
{
    mps_sim *sim = new_sim(dim, dim == 2 ? 0.01 : 0.03);
    add_tank(sim, 0.6, 0.6, 0.4);
    fill_depth(sim, 0.6, 0.3, 0.4);
    ASSERT_OK(sim, mps_solver_use(sim, "sundials.pcg", preconditioner));
    shake(sim, 0.05);
    return sim;
}

static void several_grids(void **state)
{
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) compare(fine(dim, "auxgrid"), fine(dim, "auxgrid"), 1);
    compare(fine(2, "jacobi"), fine(2, "jacobi"), 1);
    assert_have_run(of_grids, sizeof of_grids / sizeof of_grids[0]);
}

/* Kernels are cancelled after conjugate gradients have stopped. */
static void solutions(void **state)
{
    mps_sim *sim = new_sim(2, 0.1);
    (void)state;
    opencl_attach(&device, sim);
    compare_solutions(sim, 3);
    mps_sim_destroy(sim);
    if (device.failure[0]) fail_msg("%s", device.failure);
    if (device.difference[0]) fail_msg("%s", device.difference);
}

static void other_scenes(void **state)
{
    (void)state;
    for (int k = 0; k < SCENES; k++) compare(scenes[k](), scenes[k](), 5);
}

static mps_sim *with_gas(int32_t dim)
{
    mps_sim *sim = rolling("imps", dim);
    ASSERT_OK(sim, mps_model_use(sim, "gas.pocket"));
    return sim;
}

static void gas_without_a_pocket(void **state)
{
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) compare(with_gas(dim), with_gas(dim), 3);
}

/* Each model of the library together with those of a preset. */
static void all_models(void **state)
{
    mps_model_info m;
    mps_sim *list = new_sim(2, 0.1);
    (void)state;
    assert_int_equal(mps_model_info_init(&m, sizeof m), MPS_OK);
    for (int32_t k = 0; mps_model_info_get(list, k, &m) == MPS_OK; k++) {
        mps_sim *host = rolling("mmps", 2), *sim = rolling("mmps", 2);
        assert_int_equal(mps_model_use(host, m.name), mps_model_use(sim, m.name));
        compare(host, sim, 2);
    }
    mps_sim_destroy(list);
}

/* All loops that ran have a kernel, except those that scripts/device_rows excludes. */
static void kernels_are_there(void **state)
{
    static const char *const without[] = {"neighbours__search_parts",
                                          "neighbours_rows__exact_parts",
                                          "voids_cells__",
                                          "_listed in",
                                          "__clear_visits",
                                          "__sum_visits",
                                          "jacobi__invert_rows in",
                                          "vectors__poison_rows",
                                          "vectors__largest_rows",
                                          "vectors__norm_rows",
                                          "step_mass__",
                                          "lost__outside_rows",
                                          "lost__spilled_rows",
                                          "gas_pocket_faces__"}; /* ON_HOST of that script */
    int64_t launches = 0, different = 0;
    int kernels = 0;
    (void)state;
    for (int k = 0; k < device.kernels; k++)
        print_message("%s: %lld\n", device.kernel[k].name, (long long)device.kernel[k].launches);
    for (int k = 0; k < device.kernels; k++) {
        const opencl_kernel *q = &device.kernel[k];
        bool left_out = false;
        launches += q->launches;
        kernels += q->kernel != NULL;
        for (size_t m = 0; m < sizeof without / sizeof without[0]; m++)
            left_out = left_out || strstr(q->name, without[m]);
        if (!q->kernel && !left_out) fail_msg("%s has no kernel", q->name);
        if (q->different > 0) print_error("%s: %lld differ\n", q->name, (long long)q->different);
        different += q->different;
    }
    print_message("%d kernels, %lld comparisons\n", kernels, (long long)launches);
    assert_int_equal(different, 0);
    assert_true(kernels >= 150 && launches >= 5000);
}

/* ---- sums ---- */

/* Terms of many sizes and both signs. */
static double term(int64_t i)
{
    return ldexp((double)(i * 7919 % 1009 - 504), (int)(i * 31 % 200) - 100);
}

static void sums_of_any_size(void **state)
{
    static const int64_t size[] = {1, 63, 64, 65, 1023, 1025, 100000};
    (void)state;
    for (int k = 0; k < 7; k++) {
        const int64_t n = size[k];
        mps_exact sum[2], host[2];
        double largest = -1, *terms = opencl_terms(&device, 3, n);
        assert_non_null(terms);
        mps_exact_begin(&sum[0]);
        mps_exact_begin(&sum[1]);
        for (int64_t i = 0; i < n; i++) {
            terms[i] = term(i);
            terms[n + i] = i == n / 2 ? INFINITY : 0;
            terms[2 * n + i] = i == n - 1 ? NAN : -(double)i;
        }
        memcpy(host, sum, sizeof host);
        mps_exact_add(&host[0], n, terms);
        mps_exact_add(&host[1], n, terms + n);
        if (opencl_join(&device, n, 2, sum, 1, &largest)) fail_msg("%s", device.failure);
        assert_memory_equal(host, sum, sizeof host);
        assert_true(mps_exact_value(&sum[1]) == INFINITY);
        assert_true(largest == (n > 1 ? 0 : -1));
    }
}

/* ---- sums up to each row ---- */

/* Each of its loops is compared with the host. */
static void scans_of_any_size(void **state)
{
    static const int64_t size[] = {0, 1, 63, 64, 65, 1023, 1025, 100000};
    (void)state;
    for (int k = 0; k < 8; k++) {
        const int64_t n = size[k];
        int64_t *values = malloc((size_t)(mps__scan_size(n) + 1) * sizeof *values), sum = 0;
        assert_non_null(values);
        for (int64_t i = 0; i < mps__scan_size(n); i++) values[i] = i % 77 - 20;
        loops_watch(&device);
        mps__scan(NULL, values, n);
        loops_watch(NULL);
        for (int64_t i = 0; i < n; i++) assert_true(values[i] == (sum += i % 77 - 20));
        free(values);
    }
    assert_string_equal(device.difference, "");
}

/* ---- order of particles, candidates of neighbours ---- */

static void searches_of_any_size(void **state)
{
    static const int64_t size[] = {0, 1, 63, 64, 65, 1023, 1025, 100000};
    (void)state;
    for (int k = 0; k < 8; k++)
        for (int32_t dim = 2; dim <= 3; dim++) {
            loops_watch(&device);
            search_both(dim, size[k], k & 1, k & 2);
            loops_watch(NULL);
        }
    assert_string_equal(device.difference, "");
}

/* ---- what the comparison is for ---- */

/* Host code with another result. */
static void run_other(const void *host, int64_t begin, int64_t end, mps_exact *sums, double *maxima)
{
    int64_t *const *to = host;
    (void)sums, (void)maxima;
    for (int64_t i = begin; i < end; i++) (*to)[i] = i == 70 ? -1 : i;
}

static void a_difference_is_found(void **state)
{
    enum { N = 100 };
    struct {
        int64_t *to;
        const int64_t *from;
        const int32_t *order;
        size_t bytes;
    } fields = {.bytes = sizeof(int64_t)}; /* as loops of particles.c take them */
    int32_t order[N];
    int64_t number[N];
    const mps_device_ops *ops = &device.ops;
    (void)state;
    device.difference[0] = 0;
    for (int k = 0; k < N; k++) {
        order[k] = k;
        number[k] = k;
    }
    int64_t *from = ops->alloc(ops->self, sizeof number);
    int32_t *places = ops->alloc(ops->self, sizeof order);
    fields.to = ops->alloc(ops->self, sizeof number);
    fields.from = from;
    fields.order = places;
    assert_true(from && places && fields.to);
    assert_int_equal(ops->upload(ops->self, from, number, sizeof number), 0);
    assert_int_equal(ops->upload(ops->self, places, order, sizeof order), 0);
    const mps_launch l = {.struct_size = sizeof l,
                          .dim = 2,
                          .n = N,
                          .file = "particles.c",
                          .name = "permute_8",
                          .fields = &fields,
                          .bytes = sizeof fields,
                          .run = run_other,
                          .host = &fields};
    assert_int_equal(ops->launch(ops->self, &l), 0);
    assert_non_null(strstr(device.difference, "permute_8"));
    assert_non_null(strstr(device.difference, "byte 560"));
    assert_int_equal(ops->download(ops->self, number, fields.to, sizeof number), 0);
    for (int k = 0; k < N; k++) assert_int_equal(number[k], k);
    ops->free(ops->self, from);
    ops->free(ops->self, places);
    ops->free(ops->self, fields.to);
}

/* Loops of steps with a pocket of gas, and of steps before one exists. */
static const char *const of_gas[] = {
    "gas_pocket__set_rows in 2-D",         "gas_pocket__set_rows in 3-D",
    "gas_pocket__push_film_rows in 2-D",   "gas_pocket__push_film_rows in 3-D",
    "gas_pocket__load_rows in 2-D",        "gas_pocket_look__raise_speeds in 2-D",
    "gas_pocket_look__raise_speeds in 3-D"};

/* Kernels skip particles of other ranks, like the host code. Some liquid encloses gas. */
static void two_ranks(void **state)
{
    static const char *const scenes_of_ranks[] = {"air_2d", "gas_2d", "gas_3d"};
    opencl *other = calloc(1, sizeof *other);
    (void)state;
    assert_non_null(other);
    assert_true(opencl_open(other, MPS_DEVICE_FOLDER "/rows.bc"));
    for (int m = 0; m < 3; m++) {
        ranks_run k = {.scene = scenes_of_ranks[m], .device = {&device, other}};
        ranks_go(&k);
        for (int r = 0; r < 2; r++) {
            assert_int_equal(k.status[r], MPS_OK);
            assert_true(k.launches[r] > 100);
            if (k.device[r]->failure[0]) fail_msg("rank %d: %s", r, k.device[r]->failure);
            if (k.device[r]->difference[0]) fail_msg("rank %d: %s", r, k.device[r]->difference);
        }
    }
    assert_have_run(of_gas, sizeof of_gas / sizeof of_gas[0]);
    opencl_close(other);
    free(other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_of_any_size),     cmocka_unit_test(scans_of_any_size),
        cmocka_unit_test(searches_of_any_size), cmocka_unit_test(presets),
        cmocka_unit_test(several_grids),        cmocka_unit_test(solutions),
        cmocka_unit_test(other_scenes),         cmocka_unit_test(all_models),
        cmocka_unit_test(gas_without_a_pocket), cmocka_unit_test(two_ranks),
        cmocka_unit_test(kernels_are_there),    cmocka_unit_test(a_difference_is_found),
    };
    if (!opencl_open(&device, MPS_DEVICE_FOLDER "/rows.bc")) {
        print_message("skipped: %s\n", device.failure);
        return 77;
    }
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    opencl_close(&device);
    return failed;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Steps with libmps_cuda and a stand-in for NVIDIA's driver, which runs kernels by OpenCL: the
 * bytes of the host; each call of the driver fails in turn. */
#include "standin.h"
#include "scene.h"
#include <mps/cuda.h>

/* ---- steps ---- */

static mps_sim *on_gpu(const char *preset, int32_t dim)
{
    mps_sim *sim = rolling(preset, dim);
    ASSERT_OK(sim, mps_cuda_use(sim, 0));
    return sim;
}

static void steps(void **state)
{
    static const char *const preset[] = {"imps", "mmps", "imps.paper", "mmps.paper"};
    mps_device_info info;
    (void)state;
    assert_int_equal(mps_device_info_init(&info, sizeof info), MPS_OK);
    for (int k = 0; k < 4; k++)
        for (int32_t dim = 2; dim <= 3; dim++) {
            mps_sim *host = rolling(preset[k], dim), *sim = on_gpu(preset[k], dim);
            for (int step = 0; step < 4; step++) {
                const mps_status status = mps_step(host, 0.01, NULL);
                if (mps_step(sim, 0.01, NULL) != status)
                    fail_msg("%s in %d-D: %s", preset[k], (int)dim, mps_sim_error(sim));
            }
            assert_int_equal(mps_sim_device_info(sim, &info), MPS_OK);
            assert_string_equal(info.name, "cuda");
            assert_true(info.launches > 20);
            same(host, sim);
            mps_sim_destroy(host);
            mps_sim_destroy(sim);
        }
    assert_int_equal(standin_open(), 0);
}

/* Handles share the kernels of a GPU; the second remains usable when the first is destroyed. */
static void two_handles(void **state)
{
    mps_sim *first = on_gpu("imps", 2), *second = on_gpu("mmps", 2), *host = rolling("mmps", 2);
    (void)state;
    go(first, 2);
    go(second, 2);
    mps_sim_destroy(first);
    go(second, 2);
    ASSERT_OK(second, mps_sim_device_set(second, NULL));
    assert_int_equal(standin_open(), 0);
    go(second, 1);
    go(host, 5);
    same(host, second);
    mps_sim_destroy(second);
    mps_sim_destroy(host);
}

/* ---- failures ---- */

static void opening_fails(void **state)
{
    static const char *const calls[] = {"cuDeviceGetCount",     "cuDeviceGet",
                                        "cuDeviceGetAttribute", "cuDevicePrimaryCtxRetain",
                                        "cuCtxPushCurrent_v2",  "cuModuleLoadDataEx",
                                        "cuStreamCreate"};
    mps_sim *sim = rolling("imps", 2);
    (void)state;
    for (size_t k = 0; k < sizeof calls / sizeof *calls; k++) {
        standin_fail(calls[k], 1);
        ASSERT_REFUSED(sim, mps_cuda_use(sim, 0), MPS_E_PLUGIN, k == 5 ? "line 1:" : "(CUDA error");
        assert_true(standin_visits(calls[k]) >= 1);
        standin_fail(NULL, 0);
        assert_int_equal(standin_open(), 0);
    }
    ASSERT_REFUSED(sim, mps_cuda_use(sim, 3), MPS_E_PLUGIN, "no GPU 3: must be 0..0");
    ASSERT_REFUSED(sim, mps_cuda_use(sim, -2), MPS_E_PLUGIN, "no GPU -2");
    standin_facts(1, 52, 12040);
    ASSERT_REFUSED(sim, mps_cuda_use(sim, 0), MPS_E_PLUGIN, "5.2; must be 6.0");
    standin_facts(3, 90, 12040);
    sim->world.ranks.rank = 5;
    ASSERT_OK(sim, mps_cuda_use(sim, MPS_CUDA_OF_RANK));
    assert_int_equal(standin_device(), 2);
    ASSERT_OK(sim, mps_sim_device_set(sim, NULL));
    sim->world.ranks.rank = 0;
    standin_facts(0, 90, 12040);
    ASSERT_REFUSED(sim, mps_cuda_use(sim, MPS_CUDA_OF_RANK), MPS_E_PLUGIN, "no GPU of NVIDIA");
    ASSERT_REFUSED(sim, mps_cuda_use(sim, 0), MPS_E_PLUGIN, "no GPU of NVIDIA");
    standin_facts(1, 90, 12040);
    ASSERT_OK(sim, mps_step(sim, 0.01, NULL));
    mps_sim_destroy(sim);
}

/* If any call of the driver fails in a step, the step returns an error and the state is
 * unchanged. */
static void steps_fail(void **state)
{
    /* some calls for a context belong to allocations, others to launches and copies */
    static const struct {
        const char *call;
        int64_t visit;
        mps_status status;
    } fault[] = {
        {"cuLaunchKernel", 3, MPS_E_PLUGIN},       {"cuMemcpyHtoDAsync_v2", 3, MPS_E_PLUGIN},
        {"cuMemcpyDtoHAsync_v2", 3, MPS_E_PLUGIN}, {"cuMemcpyDtoDAsync_v2", 3, MPS_E_PLUGIN},
        {"cuMemsetD8Async", 3, MPS_E_PLUGIN},      {"cuStreamSynchronize", 3, MPS_E_PLUGIN},
        {"cuCtxPushCurrent_v2", 9, MPS_E_NOMEM},   {"cuCtxPushCurrent_v2", 80, MPS_E_PLUGIN},
        {"cuMemAlloc_v2", 3, MPS_E_NOMEM},
    };
    mps_sim *host = rolling("imps", 2);
    (void)state;
    go(host, 1);
    for (size_t k = 0; k < sizeof fault / sizeof *fault; k++) {
        mps_sim *sim = on_gpu("imps", 2);
        const bool first = strcmp(fault[k].call, "cuMemAlloc_v2") == 0; /* later the allocation
                                                                           succeeds */
        if (!first) go(sim, 1);
        standin_fail(fault[k].call, fault[k].visit);
        const mps_status status = mps_step(sim, 0.01, NULL);
        const int64_t visits = standin_visits(fault[k].call);
        standin_fail(NULL, 0);
        if (visits >= fault[k].visit) {
            const bool memory = fault[k].status == MPS_E_NOMEM;
            assert_int_equal(status, fault[k].status);
            assert_non_null(
                strstr(mps_sim_error(sim), memory ? "no memory" : "as the test wants it"));
            if (first) go(sim, 1);
            same(host, sim);
        } else
            assert_int_equal(status, MPS_OK);
        mps_sim_destroy(sim);
        assert_int_equal(standin_open(), 0);
    }
    mps_sim_destroy(host);
}

static void facts(void **state)
{
    mps_cuda_info info;
    char error[200];
    (void)state;
    assert_int_equal(mps_cuda_info_init(NULL, sizeof info), MPS_E_ARG);
    assert_int_equal(mps_cuda_info_init(&info, 8), MPS_E_ARG);
    info.struct_size = 0;
    assert_int_equal(mps_cuda_info_get(0, &info, error, sizeof error), MPS_E_ARG);
    assert_non_null(strstr(error, "mps_cuda_info_init"));
    assert_int_equal(mps_cuda_info_init(&info, sizeof info), MPS_OK);
    assert_int_equal(mps_cuda_info_get(0, &info, NULL, 0), MPS_OK);
    assert_string_equal(info.name, "stand-in 0");
    assert_int_equal(info.count, 1);
    assert_int_equal(info.capability, 90);
    assert_int_equal(info.driver, 12040);
    assert_true(info.memory == (uint64_t)8 << 30 && info.free_memory == (uint64_t)6 << 30);
    assert_int_equal(mps_cuda_info_get(1, &info, error, sizeof error), MPS_E_PLUGIN);
    assert_non_null(strstr(error, "no GPU 1"));
    assert_int_equal(standin_open(), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(facts),       cmocka_unit_test(steps),
        cmocka_unit_test(two_handles), cmocka_unit_test(opening_fails),
        cmocka_unit_test(steps_fail),
    };
    mps_cuda_info info;
    char error[400];
    standin_kernels(MPS_DEVICE_FOLDER "/rows.bc");
    assert_int_equal(mps_cuda_info_init(&info, sizeof info), MPS_OK);
    if (mps_cuda_info_get(0, &info, error, sizeof error) != MPS_OK) {
        print_message("skipped: no device of OpenCL (Debian: pocl-opencl-icd): %s\n", error);
        return 77;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}

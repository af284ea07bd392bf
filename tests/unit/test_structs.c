/* SPDX-License-Identifier: BSD-3-Clause */
/* Structs that cross the interface: sizes that no version had are refused, and nothing is written
 * beyond the caller's size. */
#include "tank_fixture.h"
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>
#include <mps/model.h>
#include <mps/ppe.h>
#include <stdbool.h>
#include <stdlib.h>

typedef mps_status (*init_fn)(void *out, size_t size);

#define INIT(type)                                        \
    static mps_status init_##type(void *out, size_t size) \
    {                                                     \
        return type##_init((type *)out, size);            \
    }
/* clang-format off */
#define ALL(X)                                                                                     \
    X(mps_channel_info)                                                                            \
    X(mps_config) X(mps_energy) X(mps_grid) X(mps_kernel) X(mps_lease) X(mps_model_info)           \
        X(mps_momentum) X(mps_motion_pose) X(mps_motion_state) X(mps_name_info) X(mps_parallel) X(mps_particle_block) X(mps_pass_info) \
            X(mps_phase) X(mps_ppe_result) X(mps_probe) X(mps_probe_info) X(mps_setting_info) X(mps_ship) X(mps_ship_motion) \
                X(mps_solid) X(mps_solver_limits) X(mps_stencil) X(mps_step_info) X(mps_stl) X(mps_tank)        \
                    X(mps_time_control) X(mps_verb_info)
/* clang-format on */
ALL(INIT)

#define ENTRY(type) {#type, sizeof(type), init_##type},
static const struct {
    const char *name;
    size_t size;
    init_fn init;
} all[] = {ALL(ENTRY)};

/* Size that a struct had before it grew; 0: it did not. */
static size_t older_size(const char *name)
{
    if (strcmp(name, "mps_energy") == 0) return offsetof(mps_energy, friction);
    if (strcmp(name, "mps_step_info") == 0) return offsetof(mps_step_info, pockets);
    return strcmp(name, "mps_momentum") == 0 ? offsetof(mps_momentum, friction) : 0;
}

static void init_knows_sizes(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) {
        union {
            max_align_t align;
            unsigned char byte[1024];
        } buffer;
        for (size_t size = 0; size < all[k].size; size++) {
            memset(&buffer, 7, sizeof buffer);
            if (size > 0 && size == older_size(all[k].name)) {
                assert_int_equal(all[k].init(&buffer, size), MPS_OK);
                for (size_t b = size; b < sizeof buffer.byte; b++)
                    assert_int_equal(buffer.byte[b], 7);
                continue;
            }
            if (all[k].init(&buffer, size) != MPS_E_ARG)
                fail_msg("%s_init() took %zu bytes", all[k].name, size);
            for (size_t b = 0; b < sizeof buffer.byte; b++) assert_int_equal(buffer.byte[b], 7);
        }
        const size_t newer = all[k].size + 24;
        uint32_t logged;
        assert_int_equal(all[k].init(NULL, all[k].size), MPS_E_ARG);
        assert_int_equal(all[k].init(&buffer, newer), MPS_OK);
        memcpy(&logged, &buffer, sizeof logged);
        assert_int_equal(logged, newer);
        for (size_t b = all[k].size; b < sizeof buffer.byte; b++)
            assert_int_equal(buffer.byte[b], b < newer ? 0 : 7);
    }
}

/* A struct that a program made too short is refused by all that would fill it; nothing is
 * written. */
static void fillers_refuse_sizes(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    mps_stencil stencil = {.struct_size = offsetof(mps_stencil, w_r2), .n = -1};
    mps_kernel kernel = {.struct_size = 8};
    mps_lease lease = {.struct_size = 0, .count = -1};
    mps_motion_state motion = {.struct_size = 4};
    mps_ppe_result result = {.struct_size = 8};
    const double x[4] = {0, 0, 0.1, 0};
    double work[1];
    mps_neighbours *list;
    add_tank(sim, 1, 1, 0);
    fill_depth(sim, 1, 0.5, 0);
    ASSERT_REFUSED(sim, mps_stencil_get(sim, MPS_NEAR, &stencil), MPS_E_ARG,
                   "mps_stencil.struct_size is");
    ASSERT_REFUSED(sim, mps_stencil_get(sim, MPS_NEAR, NULL), MPS_E_ARG, "mps_stencil is NULL");
    assert_int_equal(stencil.n, -1);
    ASSERT_REFUSED(sim, mps_lease_begin(sim, "position", MPS_READ, &lease), MPS_E_ARG,
                   "call mps_lease_init() first");
    ASSERT_REFUSED(sim, mps_lease_end(sim, &lease), MPS_E_ARG, "call mps_lease_init() first");
    assert_int_equal(lease.count, -1);
    ASSERT_REFUSED(sim, mps_motion_state_get(sim, &motion), MPS_E_ARG,
                   "mps_motion_state.struct_size is 4");
    ASSERT_REFUSED(sim, mps_kernel_use(sim, &kernel), MPS_E_ARG, "mps_kernel.struct_size is 8");
    assert_int_equal(mps_kernel_find("improved", &kernel), MPS_E_ARG);
    assert_int_equal(kernel.id, 0);
    assert_int_equal(
        mps_ppe_check(&(mps_ppe_problem){.struct_size = sizeof(mps_ppe_problem)}, x, work, &result),
        MPS_E_ARG);
    assert_int_equal(mps_neighbours_create(2, 0.1, NULL, &list), MPS_OK);
    assert_int_equal(mps_neighbours_build(list, 2, x, 0.21, 0.21), MPS_OK);
    assert_int_equal(mps_neighbours_stencil_get(list, MPS_NEAR, &kernel, &stencil), MPS_E_ARG);
    assert_non_null(strstr(mps_neighbours_error(list), "mps_stencil.struct_size"));
    stencil.struct_size = sizeof stencil;
    assert_int_equal(mps_neighbours_stencil_get(list, MPS_NEAR, &kernel, &stencil), MPS_E_ARG);
    assert_non_null(strstr(mps_neighbours_error(list), "mps_kernel.struct_size"));
    mps_neighbours_destroy(list);
    mps_sim_destroy(sim);
}

/* An invalid size is refused before a byte behind the struct is read. The struct ends at the end of
 * a page; the next page is not mapped. */
static void sizes_without_end(void **state)
{
    (void)state;
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    const int memory = open("/dev/zero", O_RDWR);
    char *two = mmap(NULL, 2 * page, PROT_READ | PROT_WRITE, MAP_PRIVATE, memory, 0);
    assert_true(memory >= 0 && two != MAP_FAILED);
    assert_int_equal(munmap(two + page, page), 0);
    mps_phase *phase = (mps_phase *)(two + page - sizeof *phase);
    mps_sim *sim = new_sim(2, 0.1);
    for (uint32_t size = 4097; size < UINT32_MAX / 2; size *= 2) {
        assert_int_equal(mps_phase_init(phase, sizeof *phase), MPS_OK);
        phase->struct_size = size;
        ASSERT_REFUSED(sim, mps_phase_set(sim, 0, phase), MPS_E_ARG, "mps_phase.struct_size is");
    }
    mps_sim_destroy(sim);
    munmap(two, page);
    close(memory);
}

/* Structs of a newer program are filled up to the entries of this library. */
static void newer_structs_are_filled(void **state)
{
    (void)state;
    struct {
        mps_stencil known;
        double later;
    } newer;
    struct {
        mps_lease known;
        double later;
    } lease;
    mps_sim *sim = new_sim(2, 0.1);
    add_tank(sim, 1, 1, 0);
    fill_depth(sim, 1, 0.5, 0);
    assert_int_equal(mps_stencil_init(&newer.known, sizeof newer), MPS_OK);
    assert_int_equal(mps_lease_init(&lease.known, sizeof lease), MPS_OK);
    newer.later = lease.later = 3;
    ASSERT_OK(sim, mps_stencil_get(sim, MPS_FAR, &newer.known));
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_READ, &lease.known));
    assert_true(newer.known.struct_size == sizeof newer &&
                newer.known.n == mps_particles_count(sim, -1) && newer.later == 3);
    assert_true(lease.known.struct_size == sizeof lease && lease.known.stride == 2 &&
                lease.later == 3);
    double *n = malloc((size_t)newer.known.n * sizeof *n);
    ASSERT_STATUS(sim, mps_op_number_density(&newer.known, n),
                  MPS_E_VERSION); /* with an entry that is not known */
    newer.later = 0;
    ASSERT_OK(sim, mps_op_number_density(&newer.known, n));
    free(n);
    ASSERT_OK(sim, mps_lease_end(sim, &lease.known));
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(init_knows_sizes),
        cmocka_unit_test(fillers_refuse_sizes),
        cmocka_unit_test(sizes_without_end),
        cmocka_unit_test(newer_structs_are_filled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Each allocation of a picture, a film and a state for ParaView fails in turn: the call returns an
 * error, leaves no file and leaks no memory, and the next one succeeds. The linker replaces
 * malloc() by __wrap_malloc() in libmps_case, but not in cairo. */
#include "picture_fixture.h"

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *block, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *block, size_t size);

static bool armed;
static int64_t calls, fail_at;

static bool fails(void)
{
    return armed && ++calls == fail_at;
}

void *__wrap_malloc(size_t size)
{
    return fails() ? NULL : __real_malloc(size);
}

void *__wrap_calloc(size_t count, size_t size)
{
    return fails() ? NULL : __real_calloc(count, size);
}

void *__wrap_realloc(void *block, size_t size)
{
    return fails() ? NULL : __real_realloc(block, size);
}

static const char folder[] = "test_picture_memory_run", path[] = "test_picture_memory.png";

typedef mps_status (*task)(mps_sim *sim, char *error, size_t size);

static mps_status draw_state(mps_sim *sim, char *error, size_t size)
{
    mps_picture_config config = new_config(error, size);
    return mps_picture_save(sim, &config, path);
}

static mps_status draw_frame(mps_sim *sim, char *error, size_t size)
{
    mps_picture_config config = new_config(error, size);
    (void)sim;
    return mps_picture_frame_save(folder, -1, &config, path);
}

static mps_status write_state(mps_sim *sim, char *error, size_t size)
{
    (void)sim;
    return mps_paraview_save(folder, error, size);
}

static mps_status make_film(mps_sim *sim, char *error, size_t size)
{
    mps_film_config config;
    (void)sim;
    mps_film_config_init(&config, sizeof config);
    config.error = error;
    config.error_size = size;
    config.program = "test_picture_memory_run/program";
    return mps_film_save(folder, &config, path);
}

/* @return allocations of the task */
static int64_t fail_each(mps_sim *sim, task run, const char *out)
{
    for (int64_t k = 1; k < 1000; k++) {
        char error[300] = "";
        remove(out);
        calls = 0;
        fail_at = k;
        armed = true;
        const mps_status status = run(sim, error, sizeof error);
        armed = false;
        if (calls < k) {
            if (status != MPS_OK) fail_msg("%s", error);
            assert_true(exists(out));
            return calls;
        }
        if (status != MPS_E_NOMEM)
            fail_msg("allocation %d: %s '%s'", (int)k, mps_status_name(status), error);
        if (!strstr(error, "memory")) fail_msg("allocation %d: '%s'", (int)k, error);
        assert_false(exists(out));
    }
    fail_msg("no end of allocations");
    return 0;
}

static void each_allocation(void **state)
{
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) {
        mps_sim *sim = wet_tank(dim);
        add_sensor(sim, MPS_PROBE_WALL_PRESSURE, "P1", 0, 0.4, 0.2);
        write_folder(folder, sim, 2, "");
        write_text(
            folder, "program",
            "#!/bin/sh\ncat >/dev/null\nfor last do :; done\necho film >\"${last#file:}\"\n");
        assert_int_equal(chmod("test_picture_memory_run/program", 0755), 0);
        assert_true(fail_each(sim, draw_state, path) >= 3);
        assert_true(fail_each(sim, draw_frame, path) >= 10);
        assert_true(fail_each(sim, make_film, path) >= 10);
        assert_true(fail_each(sim, write_state, "test_picture_memory_run/paraview.py") >= 10);
        mps_sim_destroy(sim);
        remove_folder(folder);
    }
    remove(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(each_allocation)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

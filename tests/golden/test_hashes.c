/* SPDX-License-Identifier: BSD-3-Clause */
/* The bytes of short runs of each preset in 2-D and 3-D, as 64-bit hashes in hashes.txt: the same
 * with 1, 2 and 4 threads, with gcc and clang, optimised or not. A change of rounding changes them;
 * then the new ones are accepted on purpose:
 *   MPS_GOLDEN_ACCEPT=1 BUILD/tests/golden_test_hashes, and a line in CHANGELOG.md under "Rounding"
 *   that says what changed and why. */
#include "../tags.h"
#include <inttypes.h>
#include <math.h>
#include <mps/mps.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { RUNS = 8, NAME = 32 };

static const char *const presets[4] = {"imps", "imps.paper", "mmps", "mmps.paper"};
static const char hashes[] = GOLDEN_FOLDER "/hashes.txt";
static uint64_t found[RUNS];

static uint64_t add_bytes(uint64_t hash, const void *data, size_t bytes)
{
    const unsigned char *p = data;
    for (size_t k = 0; k < bytes; k++) hash = (hash ^ p[k]) * UINT64_C(1099511628211); /* FNV-1a */
    return hash;
}

static uint64_t hash_state(mps_sim *sim)
{
    static const char *const fields[] = {"position", "velocity", "pressure", "number_density",
                                         "density"};
    uint64_t hash = UINT64_C(14695981039346656037);
    const int64_t *ids;
    double t;
    assert_int_equal(tags_peek(sim, &ids, NULL, NULL, NULL), MPS_OK);
    hash = add_bytes(hash, ids, (size_t)mps_particles_count(sim, -1) * sizeof *ids);
    for (size_t f = 0; f < sizeof fields / sizeof fields[0]; f++) {
        mps_lease lease = {.struct_size = sizeof lease};
        assert_int_equal(mps_lease_begin(sim, fields[f], MPS_READ, &lease), MPS_OK);
        for (int64_t k = 0; k < lease.count * lease.stride; k++) {
            const double value = lease.data[k] == 0 ? 0 : lease.data[k]; /* -0 is 0 */
            hash = add_bytes(hash, &value, sizeof value);
        }
        assert_int_equal(mps_lease_end(sim, &lease), MPS_OK);
    }
    assert_int_equal(mps_sim_time(sim, &t, NULL), MPS_OK);
    return add_bytes(hash, &t, sizeof t);
}

/* Polynomials alone: sines of C libraries differ in the last digit. */
static int sway(void *user, double t, mps_motion_state *state)
{
    (void)user;
    state->value[MPS_MOVE_X] = 0.5 * t * t;
    state->rate[MPS_MOVE_X] = t;
    state->accel[MPS_MOVE_X] = 1;
    return 0;
}

static mps_sim *build(const char *preset, int32_t dim, int32_t threads)
{
    const double lo[3] = {0, 0, 0}, depth[3] = {0.3, 0.24, 0.4}, all[3] = {0.6, 0.4, 0.4};
    mps_config config;
    mps_tank tank;
    mps_phase gas;
    mps_sim *sim = NULL;
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dim = dim;
    config.dp = dim == 2 ? 0.03125 : 0.0625;
    config.threads = threads;
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    assert_int_equal(mps_preset_use(sim, preset), MPS_OK);
    assert_int_equal(mps_phase_init(&gas, sizeof gas), MPS_OK);
    gas.density = 1.2;
    gas.viscosity = 1.8e-5;
    assert_int_equal(mps_tank_init(&tank, sizeof tank), MPS_OK);
    for (int d = 0; d < 3; d++) tank.size[d] = all[d];
    assert_int_equal(mps_tank_add(sim, &tank, NULL), MPS_OK);
    assert_int_equal(mps_fill_box_add(sim, 0, lo, depth, NULL, NULL), MPS_OK);
    if (preset[0] == 'm') {
        assert_int_equal(mps_phase_set(sim, 1, &gas), MPS_OK);
        assert_int_equal(mps_fill_box_add(sim, 1, lo, all, NULL, NULL), MPS_OK);
    }
    assert_int_equal(mps_motion_callback_set(sim, sway, NULL), MPS_OK);
    return sim;
}

static uint64_t run(int k, int32_t threads)
{
    mps_sim *sim = build(presets[k / 2], k % 2 ? 3 : 2, threads);
    for (int s = 0; s < (k % 2 ? 12 : 40); s++)
        if (mps_step(sim, 1, NULL) < 0) fail_msg("step %d: %s", s, mps_sim_error(sim));
    const uint64_t hash = hash_state(sim);
    mps_sim_destroy(sim);
    return hash;
}

static const char *name_of(int k, char name[NAME])
{
    snprintf(name, NAME, "%s.%s", presets[k / 2], k % 2 ? "3d" : "2d");
    return name;
}

static int kept_hash(const char *name, uint64_t *hash)
{
    FILE *file = fopen(hashes, "r");
    char line[100], other[NAME];
    int have = 0;
    while (file && fgets(line, sizeof line, file))
        if (sscanf(line, "%31s %" SCNx64, other, hash) == 2 && strcmp(other, name) == 0) {
            have = 1;
            break;
        }
    if (file) fclose(file);
    return have;
}

static void check(void **state)
{
    const int k = (int)(intptr_t)*state;
    char name[NAME];
    uint64_t kept = 0;
    found[k] = run(k, 1);
    for (int32_t threads = 2; threads <= 4; threads *= 2) {
        const uint64_t other = run(k, threads);
        if (other != found[k])
            fail_msg("%s: %016" PRIx64 " with 1 thread, %016" PRIx64 " with %d", name_of(k, name),
                     found[k], other, (int)threads);
    }
    if (getenv("MPS_GOLDEN_ACCEPT")) return;
    if (!kept_hash(name_of(k, name), &kept) || kept != found[k])
        fail_msg("%s: the hash is %016" PRIx64 ", kept is %016" PRIx64
                 ". If the rounding was changed on purpose: run\n"
                 "  MPS_GOLDEN_ACCEPT=1 %s\n"
                 "and say in CHANGELOG.md under \"Rounding\" what changed and why. Else find the "
                 "change that did it.",
                 name, found[k], kept, "BUILD/tests/golden_test_hashes");
}

static int accept_all(void)
{
    char name[NAME];
    FILE *file = fopen(hashes, "w");
    if (!file) return 1;
    for (int k = 0; k < RUNS; k++) fprintf(file, "%s %016" PRIx64 "\n", name_of(k, name), found[k]);
    printf("%s is written: commit it together with the change of rounding and its line in "
           "CHANGELOG.md\n",
           hashes);
    return fclose(file) != 0;
}

int main(void)
{
    struct CMUnitTest tests[RUNS];
    static char names[RUNS][NAME];
    for (int k = 0; k < RUNS; k++)
        tests[k] = (struct CMUnitTest){name_of(k, names[k]), check, NULL, NULL,
                                       (void *)(intptr_t)k};
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    return !failed && getenv("MPS_GOLDEN_ACCEPT") ? accept_all() : failed;
}

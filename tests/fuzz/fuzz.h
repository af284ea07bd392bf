/* SPDX-License-Identifier: BSD-3-Clause */
/* Fuzz targets: each fuzz_*.c has one LLVMFuzzerTestOneInput(). With -DMPS_FUZZ=ON (clang)
 * libFuzzer drives it; otherwise replay.c runs it over the stored corpora. An input is a sequence
 * of bytes; after its end all bytes are 0. */
#ifndef MPS_FUZZ_H
#define MPS_FUZZ_H

#include <math.h>
#include <mps/mps.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

typedef struct fuzz_input {
    const uint8_t *data;
    size_t size, at;
} fuzz_input;

static inline unsigned fuzz_byte(fuzz_input *in)
{
    return in->at < in->size ? in->data[in->at++] : 0;
}

static inline int fuzz_left(const fuzz_input *in)
{
    return in->at < in->size;
}

/* 0 .. count-1 */
static inline int fuzz_pick(fuzz_input *in, int count)
{
    return (int)(fuzz_byte(in) % (unsigned)count);
}

static inline uint64_t fuzz_bits(fuzz_input *in)
{
    uint64_t v = 0;
    for (int k = 0; k < 8; k++) v = v << 8 | fuzz_byte(in);
    return v;
}

/* low .. high in 256 levels */
static inline double fuzz_between(fuzz_input *in, double low, double high)
{
    return low + (high - low) * fuzz_byte(in) / 255;
}

/* Mostly ordinary numbers of a scale, now and then numbers that programs forget. */
static inline double fuzz_real(fuzz_input *in, double scale)
{
    static const double odd[] = {0,      -0.0, NAN,   INFINITY, -INFINITY,    1e308, -1e308, 5e-324,
                                 1e-300, 1e18, -1e18, 9.3e18,   2147483648.0, -1,    1,      1e9};
    const unsigned kind = fuzz_byte(in);
    if (kind < 200) return scale * (fuzz_byte(in) / 127.5 - 1);
    if (kind < 250) return odd[kind % 16];
    const uint64_t bits = fuzz_bits(in);
    double v;
    memcpy(&v, &bits, sizeof v);
    return v;
}

static inline int64_t fuzz_whole(fuzz_input *in)
{
    static const int64_t odd[] = {
        0,         1,         -1,      2,   3,  INT32_MAX,        INT32_MIN,
        INT64_MAX, INT64_MIN, 1 << 20, 255, -2, INT64_C(1) << 40, 16,
        31,        64};
    const unsigned kind = fuzz_byte(in);
    return kind < 100   ? (int64_t)fuzz_byte(in)
           : kind < 250 ? odd[kind % 16]
                        : (int64_t)fuzz_bits(in);
}

/* Assertion; a failure ends the program, which libFuzzer and ctest report. */
#define FUZZ_MUST(condition)                                                               \
    do {                                                                                   \
        if (!(condition)) {                                                                \
            fprintf(stderr, "%s:%d: does not hold: %s\n", __FILE__, __LINE__, #condition); \
            abort();                                                                       \
        }                                                                                  \
    } while (0)

/* A status that exists, with a text if it is a failure. */
static inline mps_status fuzz_status(mps_sim *sim, mps_status status)
{
    FUZZ_MUST(status >= MPS_E_RANKS && status <= MPS_W_STOPPED);
    FUZZ_MUST(status >= 0 || mps_sim_error(sim)[0]);
    return status;
}

/* All fields of a simulation are finite. */
static inline void fuzz_check_finite(mps_sim *sim)
{
    static const char *const fields[] = {"position",       "velocity", "pressure",
                                         "number_density", "density",  "wall_pressure"};
    for (size_t f = 0; f < sizeof fields / sizeof fields[0]; f++) {
        mps_lease lease;
        if (mps_lease_begin(sim, fields[f], MPS_READ, &lease) != MPS_OK) continue;
        for (int64_t i = 0; i < lease.count * lease.stride; i++) FUZZ_MUST(isfinite(lease.data[i]));
        mps_lease_end(sim, &lease);
    }
}

/* Energies and the budget are finite. */
static inline void fuzz_check_energy(mps_sim *sim)
{
    mps_energy e;
    mps_energy_init(&e, sizeof e);
    if (mps_energy_get(sim, &e) < 0) return;
    const double values[] = {e.kinetic, e.potential, e.added, e.numerical};
    for (size_t k = 0; k < sizeof values / sizeof values[0]; k++) FUZZ_MUST(isfinite(values[k]));
}

/* A step; a failed one leaves time and number of particles unchanged. */
static inline mps_status fuzz_step(mps_sim *sim, double dt_max)
{
    double before, after;
    int64_t steps[2];
    const int64_t count = mps_particles_count(sim, -1);
    mps_sim_time(sim, &before, &steps[0]);
    const mps_status status = fuzz_status(sim, mps_step(sim, dt_max, NULL));
    mps_sim_time(sim, &after, &steps[1]);
    if (status < 0) {
        FUZZ_MUST(before == after && steps[0] == steps[1]);
        FUZZ_MUST(count == mps_particles_count(sim, -1));
    } else {
        FUZZ_MUST(after > before && steps[1] == steps[0] + 1);
        fuzz_check_energy(sim);
    }
    fuzz_check_finite(sim);
    return status;
}

/* An allocator that refuses what no small test needs, so that absurd sizes end as MPS_E_NOMEM and
 * not in the machine's memory. */
static inline void *fuzz_alloc(void *user, size_t size)
{
    (void)user;
    return size > ((size_t)64 << 20) ? NULL : malloc(size);
}

static inline void fuzz_release(void *user, void *block)
{
    (void)user;
    free(block);
}

static inline void fuzz_config(mps_config *config, int32_t dim, double dp)
{
    mps_config_init(config, sizeof *config);
    config->dim = dim;
    config->dp = dp;
    config->allocator = (mps_allocator){fuzz_alloc, fuzz_release, NULL};
}

#endif

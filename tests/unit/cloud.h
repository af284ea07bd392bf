/* SPDX-License-Identifier: BSD-3-Clause */
/* Sets of particles for tests of neighbours and operators. Coordinates are multiples of dp / 2^16,
 * dp a power of two: translations by integers and rotations by 90 degrees are exact, so that tests
 * can require equal bytes. */
#ifndef TESTS_CLOUD_H
#define TESTS_CLOUD_H

#include <math.h>
#include <mps/operators.h>
#include <stdlib.h>
#include <string.h>

#define CLOUD_DP 0.015625

typedef struct cloud {
    int32_t dim;
    int64_t n;
    double *x;
} cloud;

/* -1 .. 1, the same numbers everywhere. */
static inline double cloud_random(uint64_t *state)
{
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(int64_t)(*state >> 11) / (double)(INT64_C(1) << 52) - 1.0;
}

/* `count` zeros; free() them. */
static inline double *cloud_doubles(int64_t count)
{
    return calloc(count > 0 ? (size_t)count : 1, sizeof(double));
}

static inline cloud cloud_empty(int32_t dim, int64_t n)
{
    return (cloud){dim, n, cloud_doubles(n * dim)};
}

/* A lattice, every coordinate moved by at most `jitter` dp. nz is 1 in 2-D. */
static inline cloud cloud_lattice(int32_t dim, int nx, int ny, int nz, double jitter, uint64_t seed)
{
    cloud c = cloud_empty(dim, (int64_t)nx * ny * nz);
    for (int64_t i = 0; i < c.n; i++) {
        const int64_t k[3] = {i % nx, i / nx % ny, i / nx / ny};
        for (int d = 0; d < dim; d++)
            c.x[i * dim + d] = CLOUD_DP *
                               ((double)k[d] + round(jitter * cloud_random(&seed) * 65536) / 65536);
    }
    return c;
}

static inline void cloud_free(cloud *c)
{
    free(c->x);
}

static inline double cloud_distance2(const cloud *c, int64_t i, int64_t j)
{
    double sum = 0;
    for (int d = 0; d < c->dim; d++) sum += pow(c->x[j * c->dim + d] - c->x[i * c->dim + d], 2);
    return sum;
}

/* True if particle i of a lattice of n points a side has all its neighbours within `re`. */
static inline int cloud_inside(const cloud *c, int64_t i, const int n[3], double re)
{
    for (int d = 0; d < c->dim; d++) {
        const double v = c->x[i * c->dim + d];
        if (v < re || v > CLOUD_DP * (n[d] - 1) - re) return 0;
    }
    return 1;
}

/* A random field of `count` values. */
static inline double *cloud_field(int64_t count, uint64_t seed)
{
    double *f = cloud_doubles(count);
    for (int64_t k = 0; k < count; k++) f[k] = cloud_random(&seed);
    return f;
}

#endif

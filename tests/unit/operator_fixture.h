/* SPDX-License-Identifier: BSD-3-Clause */
/* Kernels, shared by the tests of operators. */
#ifndef OPERATOR_FIXTURE_H
#define OPERATOR_FIXTURE_H

#include "cloud.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
/* cmocka.h needs those before it */
#include <cmocka.h>

typedef double (*weight_fn)(double r, double re);

static inline double improved(double r, double re)
{
    return re / (0.85 * r + 0.15 * re) - 1;
}

static inline double original(double r, double re)
{
    return re / r - 1;
}

static inline double parabola(double r, double re)
{
    return 3 * (1 - r / re) * (1 - r / re);
}

/* n0 and lambda of the lattice, by counting points. */
static inline void lattice(int dim, double re, weight_fn weight, double *n0, double *lambda)
{
    double n = 0, m = 0;
    for (int i = -9; i <= 9; i++)
        for (int j = -9; j <= 9; j++)
            for (int k = dim == 3 ? -9 : 0; k <= (dim == 3 ? 9 : 0); k++) {
                const double r2 = CLOUD_DP * CLOUD_DP * (i * i + j * j + k * k);
                if (r2 == 0 || r2 >= re * re) continue;
                n += weight(sqrt(r2), re);
                m += weight(sqrt(r2), re) * r2;
            }
    *n0 = n;
    *lambda = m / n;
}

#endif

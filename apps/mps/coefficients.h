/* SPDX-License-Identifier: BSD-3-Clause */
/* mps coefficients: its runs and their results. */
#ifndef MPS_APPS_COEFFICIENTS_H
#define MPS_APPS_COEFFICIENTS_H

#include "forced.h"

enum { FREQUENCIES_MOST = 200 };

typedef struct coefficients {
    const choices *c;
    char place[SERIES_PATH];
    char motion[1024]; /* parts of the case's motion that are kept: "centre: 0 0 m, forward: z, " */
    int32_t dim;
    int32_t degrees, degree[FORCED_DEGREES];
    int32_t count;                            /* number of frequencies */
    char frequency[FREQUENCIES_MOST][64];     /* "period: 0.8 T1" */
    double C[FORCED_DEGREES][FORCED_DEGREES]; /* [load][motion], nan: not known */
    forced *result;                           /* [degrees][count] */
} coefficients;

/* Loads of a motion that have a result. */
bool coefficients_has(const coefficients *k, int32_t load);
/* Sort results by frequency, with frequencies without a result at the end. */
void coefficients_sort(coefficients *k);
/* Print a table for each pair of degrees of freedom. */
void coefficients_print(const coefficients *k);
/* Write coefficients.csv and coefficients.dat. @return exit code */
int coefficients_save(const coefficients *k);

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* mps coefficients: its runs and what they gave. */
#ifndef MPS_APPS_COEFFICIENTS_H
#define MPS_APPS_COEFFICIENTS_H

#include "forced.h"

enum { FREQUENCIES_MOST = 200 };

typedef struct coefficients {
    const choices *c;
    char place[SERIES_PATH];
    char motion[1024]; /* what is kept of the case's motion: "centre: 0 0 m, forward: z, " */
    int32_t dim;
    int32_t degrees, degree[FORCED_DEGREES];
    int32_t count;                            /* of frequencies */
    char frequency[FREQUENCIES_MOST][64];     /* "period: 0.8 T1" */
    double C[FORCED_DEGREES][FORCED_DEGREES]; /* [load][motion], nan: not known */
    forced *result;                           /* [degrees][count] */
} coefficients;

/* Loads of which there is a result, of a motion. */
bool coefficients_has(const coefficients *k, int32_t load);
/* Bring results to ascending frequencies, those of frequencies without any to the end. */
void coefficients_sort(coefficients *k);
/* Print a table for each pair of degrees. */
void coefficients_print(const coefficients *k);
/* coefficients.csv and coefficients.dat. @return exit code */
int coefficients_save(const coefficients *k);

#endif

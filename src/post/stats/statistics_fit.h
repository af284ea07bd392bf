/* SPDX-License-Identifier: BSD-3-Clause */
/* Estimators of two parameters from excesses y = P - u, without bands. */
#ifndef MPS_POST_STATISTICS_FIT_H
#define MPS_POST_STATISTICS_FIT_H

#include "statistics.h"

typedef struct mps__parameters {
    double scale, shape, log_likelihood;
    int32_t state; /* MPS_FIT_... */
} mps__parameters;

/* y: [n] ascending, > 0; work: [n]. Maximum likelihood. */
mps__parameters mps__weibull(int64_t n, const double *y, double *work);
/* Maximum likelihood, without `work`. */
mps__parameters mps__pareto(int64_t n, const double *y, double *work);
/* Probability-weighted moments. */
mps__parameters mps__pareto_moments(int64_t n, const double *y);

#endif

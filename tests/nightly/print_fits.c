/* SPDX-License-Identifier: BSD-3-Clause */
/* Fits of peaks for compare_fits.py. Standard input: u, n, then peaks; standard output: kind,
 * state, scale, shape, likelihood, value. */
#include <mps/stats.h>
#include <stdio.h>

enum { MOST = 100000 };
static double peaks[MOST];

int main(void)
{
    char error[512] = "";
    mps_stats_config config;
    mps_fit fit;
    double u, number;
    int64_t count = 0;
    if (scanf("%lf %lf", &u, &number) != 2) return 2;
    while (count < MOST && scanf("%lf", &peaks[count]) == 1) count++;
    mps_stats_config_init(&config, sizeof config);
    config.error = error;
    config.error_size = sizeof error;
    config.resamples = 0;
    for (int32_t kind = MPS_FIT_WEIBULL; kind <= MPS_FIT_PARETO; kind++) {
        mps_fit_init(&fit, sizeof fit);
        const mps_status status = kind == MPS_FIT_WEIBULL
                                      ? mps_fit_weibull(&config, count, peaks, u, number, &fit)
                                      : mps_fit_pareto(&config, count, peaks, u, number, &fit);
        if (status != MPS_OK) {
            fprintf(stderr, "%s: %s\n", mps_status_name(status), error);
            return 1;
        }
        printf("%d %d %.17g %.17g %.17g %.17g\n", (int)kind, (int)fit.state, fit.scale, fit.shape,
               fit.log_likelihood, fit.value);
    }
    return 0;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* A program outside of the library that uses the solver of the plug-in library libmps_hypre. */
#include <mps/hypre.h>
#include <mps/mps.h>
#include <stdio.h>

int main(void)
{
    mps_config config;
    mps_hypre_settings settings;
    mps_sim *sim;
    char error[256] = "";
    mps_config_init(&config, sizeof config);
    config.dp = 0.02;
    if (mps_sim_create(&config, &sim) != MPS_OK) return 1;
    mps_hypre_settings_init(&settings, sizeof settings);
    settings.threshold = 0.4;
    settings.error = error;
    settings.error_size = sizeof error;
    int failed = mps_hypre_register(sim, &settings) < 0 ||
                 mps_solver_use(sim, "hypre.boomeramg", NULL) < 0;
    if (failed) printf("%s%s\n", error, mps_sim_error(sim));
    mps_sim_destroy(sim);
    return failed;
}

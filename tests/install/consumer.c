/* SPDX-License-Identifier: BSD-3-Clause */
/* A program outside of the library: builds a small tank, does a step, reads a probe. Valid C and
 * C++. */
#include <mps/mps.h>
#include <stdio.h>
#include <string.h>

static int report(mps_sim *sim, mps_status status, const char *what)
{
    if (status >= 0) return 0;
    printf("%s: %s: %s\n", what, mps_status_name(status),
           sim ? mps_sim_error(sim) : "no simulation");
    return 1;
}

static int fill(mps_sim *sim)
{
    const double lo[2] = {0, 0}, hi[2] = {0.4, 0.2};
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = 0.4;
    tank.size[1] = 0.4;
    if (report(sim, mps_tank_add(sim, &tank, NULL), "tank")) return 1;
    return report(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL), "water");
}

int main(void)
{
    mps_config config;
    mps_step_info info;
    mps_sim *sim = NULL;
    int failed = strcmp(mps_version(NULL, NULL, NULL), MPS_VERSION_STRING) != 0;
    mps_config_init(&config, sizeof config);
    mps_step_info_init(&info, sizeof info);
    config.dp = 0.02;
    failed = failed || report(NULL, mps_sim_create(&config, &sim), "create") || fill(sim);
    failed = failed || report(sim, mps_step(sim, 1e-3, &info), "step") || info.step != 1 ||
             !(info.t > 0);
    mps_sim_destroy(sim);
    puts(failed ? "failed" : "one step done");
    return failed;
}

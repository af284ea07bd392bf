/* SPDX-License-Identifier: BSD-3-Clause */
/* mps report: report.html of a folder, made again. */
#include "cli.h"
#include <mps/job.h>
#include <mps/page.h>
#include <stdio.h>

int verb_report(const choices *c)
{
    char error[640] = "";
    mps_page_config config;
    mps_page_info info;
    mps_page_config_init(&config, sizeof config);
    mps_page_info_init(&info, sizeof info);
    config.error = error;
    config.error_size = sizeof error;
    const mps_status status = mps_page_write(c->file[0], &config, &info);
    if (status != MPS_OK) {
        fprintf(stderr, "mps report: %s\n", error);
        return status == MPS_E_NOMEM ? MPS_EXIT_FAILED : MPS_EXIT_USAGE;
    }
    printf("%s/report.html: %.2g MB, %lld particles, %d frames\n", c->file[0],
           1e-6 * (double)info.bytes, (long long)info.particles, (int)info.frames);
    if (info.left_out[0]) printf("%s\n", info.left_out);
    return MPS_EXIT_OK;
}

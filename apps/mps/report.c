/* SPDX-License-Identifier: BSD-3-Clause */
/* mps report: writes report.html of a folder again. */
#include "constants.h"
#include "record.h"
#include "summary.h"
#include <mps/job.h>
#include <mps/page.h>
#include <stdio.h>

int verb_report(const choices *c)
{
    constants k;
    mps_page_config config;
    mps_page_info info;
    constants_begin(&k);
    mps_page_config_init(&config, sizeof config);
    mps_page_info_init(&info, sizeof info);
    config.error = k.error;
    config.error_size = sizeof k.error;
    mps_status status = MPS_OK;
    if (c->sets > 0) {
        status = constants_read(&k, c, c->file[0]);
        config.impacts = &k.used;
    }
    if (status == MPS_OK) status = mps_page_write(c->file[0], &config, &info);
    if (status != MPS_OK) {
        fprintf(stderr, "mps report: %s\n", k.error);
        return status == MPS_E_NOMEM ? MPS_EXIT_FAILED : MPS_EXIT_USAGE;
    }
    if (c->sets > 0) constants_print(&k, c, c->file[0]);
    printf("%s/report.html: %.2g MB, %lld particles, %d frames\n", c->file[0],
           1e-6 * (double)info.bytes, (long long)info.particles, (int)info.frames);
    if (info.left_out[0]) printf("%s\n", info.left_out);
    if (summary_unfinished(c->file[0], record_last(c->file[0]), k.error, sizeof k.error))
        printf("%s\n", k.error);
    return MPS_EXIT_OK;
}

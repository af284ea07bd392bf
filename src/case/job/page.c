/* SPDX-License-Identifier: BSD-3-Clause */
/* report.html of a run, from what the run has written. */
#include "run.h"
#include <mps/page.h>

bool mps__page_save(mps_job *job)
{
    char error[FOLDER_PATH + 400] = "";
    mps_page_config config;
    if (!job->config.report) return true;
    mps_page_config_init(&config, sizeof config);
    config.bytes = job->config.page_bytes;
    config.error = error;
    config.error_size = sizeof error;
    if (mps_page_write(job->place.path, &config, NULL) == MPS_OK) return true;
    mps__job_tell(job, "report.html: %s", error);
    return false;
}

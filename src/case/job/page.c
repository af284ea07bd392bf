/* SPDX-License-Identifier: BSD-3-Clause */
/* Writes report.html, film and ParaView state of a run from its output files. */
#include "run.h"
#include <mps/page.h>
#include <mps/picture.h>

static bool save_page(mps_job *job)
{
    char error[FOLDER_PATH + 400] = "";
    mps_page_config config;
    if (!job->config.report) return true;
    mps_page_config_init(&config, sizeof config);
    config.bytes = job->config.page_bytes;
    config.error = error;
    config.error_size = sizeof error;
    if (mps_page_write(job->place.path, &config, NULL) == MPS_OK) return true;
    mps__job_print(job, "report.html: %s", error);
    return false;
}

/* Write the files for viewing the frames. A run is complete without them, so a failure is only a
 * message. */
static void save_views(mps_job *job)
{
    char error[FOLDER_PATH + 400] = "";
    mps_film_config config;
    if (job->config.frames == 0) {
        if (job->config.film) mps__job_print(job, "no film: the run has no frames");
        return;
    }
    if (mps_paraview_save(job->place.path, error, sizeof error) != MPS_OK)
        mps__job_print(job, "warning: no paraview.py: %s", error);
    if (!job->config.film) return;
    mps_film_config_init(&config, sizeof config);
    config.error = error;
    config.error_size = sizeof error;
    if (mps_film_save(job->place.path, &config, NULL) != MPS_OK)
        mps__job_print(job, "warning: no film: %s", error);
}

bool mps__page_save(mps_job *job)
{
    const bool done = save_page(job);
    save_views(job);
    return done;
}

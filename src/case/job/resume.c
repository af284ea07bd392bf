/* SPDX-License-Identifier: BSD-3-Clause */
/* A checkpoint holds the simulation; what the run itself has summed up and drawn comes back from its files of rows. They are on the disk
 * before each checkpoint, so that also after a kill they reach at least up to it. */
#include "run.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

enum { RESUME_PATH = 560 };

static void path_of(const mps_job *job, char path[RESUME_PATH])
{
    snprintf(path, RESUME_PATH, "%s/checkpoint.mps", job->place.path);
}

/* Whether the run in the folder came to its end. */
static bool is_done(const mps_job *job)
{
    char path[RESUME_PATH], line[256];
    bool done = false;
    snprintf(path, sizeof path, "%s/summary.json", job->place.path);
    FILE *in = fopen(path, "r");
    while (in && fgets(line, sizeof line, in))
        done = done || strstr(line, "\"status\": \"ok\"") != NULL;
    if (in) fclose(in);
    return done;
}

/* Rows up to now are on the disk, and no checkpoint is. One without the rows before it would be of no use, the one that is there may be. */
static bool sync_rows(mps_job *job)
{
    if (job->checkpoint_t == job->totals.t) return false;
    table *const all[] = {&job->probes, &job->momentum, &job->steps, &job->trace_rows};
    bool failed = false;
    for (int k = 0; k < (job->config.trace ? 4 : 3); k++) {
        mps__table_sync(all[k]);
        failed = failed || all[k]->failed;
    }
    job->output_failed = job->output_failed || failed;
    return !failed;
}

void mps__resume_save(mps_job *job)
{
    char path[RESUME_PATH];
    path_of(job, path);
    if (!mps__job_told(job, mps__job_first(job) && sync_rows(job))) return;
    if (mps__job_note(job, mps_checkpoint_write(job->sim, path), "checkpoint"))
        job->checkpoint_t = job->totals.t;
}

/* Number of the first checkpoint behind t. */
static int64_t next_of(const mps_job *job, double t)
{
    return job->config.checkpoint > 0 ? (int64_t)(t / job->config.checkpoint + 1e-9) + 1 : 0;
}

bool mps__resume_due(mps_job *job, double t)
{
    if (job->config.checkpoint == 0 || next_of(job, t) == job->checkpoint) return false;
    job->checkpoint = next_of(job, t);
    return true;
}

bool mps__resume_forget(mps_job *job)
{
    const bool done = mps__folder_clear(&job->place, job->error, sizeof job->error);
    job->checkpoint = 1;
    if (!done && !job->code) job->code = MPS_EXIT_USAGE;
    return done;
}

/* Why there is no state to go on from. */
static bool refuse_checkpoint(mps_job *job, mps_status status, bool missing)
{
    const bool usage = status == MPS_E_ARG || status == MPS_E_IO || status == MPS_E_VERSION;
    return mps__job_fail(
        job, usage ? MPS_EXIT_USAGE : MPS_EXIT_FAILED, "--resume: %s%s; %s" RESUME_ANEW,
        mps_sim_error(job->sim),
        missing && is_done(job) ? "; the run there has come to its end" : "",
        missing ? "only an interrupted run or one with --checkpoint leaves a checkpoint; " : "");
}

bool mps__resume_read(mps_job *job)
{
    char path[RESUME_PATH];
    double t = 0;
    struct stat there;
    path_of(job, path);
    const bool missing = stat(path, &there) != 0 && errno == ENOENT;
    const mps_status status = mps_checkpoint_read(job->sim, path);
    if (status < 0) return refuse_checkpoint(job, status, missing);
    mps_sim_time(job->sim, &t, NULL);
    if (t > job->config.t_end)
        return mps__job_fail(
            job, MPS_EXIT_USAGE,
            "--resume: the checkpoint is at t = %g s, later than --t-end %g; give a later --t-end",
            t, job->config.t_end);
    if (t == job->config.t_end && !job->config.quiet)
        mps__job_tell(job,
                      "--resume: this run has come to its end, t = %g s: no step is left, its last "
                      "picture, plots and report are written again; a later --t-end goes on",
                      t);
    job->totals.t_before = job->checkpoint_t = t;
    job->checkpoint = next_of(job, t);
    return true;
}

void mps__resume_add_step(void *user, const double *row)
{
    job_totals *s = &((mps_job *)user)->totals;
    s->steps++;
    s->t = row[STEP_T];
    s->lost = (int64_t)row[STEP_LOST];
    s->max_speed = fmax(s->max_speed, row[STEP_SPEED]);
    s->ppe_iterations += row[STEP_ITERATIONS];
    s->ppe_solves += row[STEP_SOLVES];
    s->crossing_least = s->steps == 1 ? row[STEP_CROSSING]
                                      : fmin(s->crossing_least, row[STEP_CROSSING]);
    s->crossing_most = fmax(s->crossing_most, row[STEP_CROSSING]);
}

bool mps__resume_tables(mps_job *job)
{
    table *const all[] = {&job->probes, &job->momentum, &job->steps, &job->trace_rows};
    int64_t steps = 0;
    mps_sim_time(job->sim, NULL, &steps);
    if (job->totals.steps != steps || job->totals.t != job->totals.t_before)
        return mps__job_fail(
            job, MPS_EXIT_USAGE,
            "--resume: steps.csv has not the steps of the checkpoint; " RESUME_ANEW);
    for (int k = 0; k < (job->config.trace ? 4 : 3); k++)
        if (!mps__table_cut(all[k]))
            return mps__job_fail(job, MPS_EXIT_FAILED,
                                 "--resume: the files of rows cannot be cut at the checkpoint: %s",
                                 all[k]->why);
    return true;
}

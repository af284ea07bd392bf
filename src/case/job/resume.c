/* SPDX-License-Identifier: BSD-3-Clause */
/* A checkpoint holds the simulation; totals and drawings of the run are restored from its files of
 * rows. These are flushed to the disk before each checkpoint, so that they reach it even after a
 * kill. */
#include "run.h"
#include "escape.h"
#include "regular.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { RESUME_PATH = 560 };

/* Fraction of the run time that checkpoints by wall clock may take. */
static const double CLOCK_SHARE = 0.01;

/* As mps_run() fits them, and the default largest ratio of a step to the last one; for a larger
 * mps_time_control.growth the checkpoint before the fitted steps may be missing, and more steps are
 * repeated. */
static const double FITTED_STEPS = 20, FITTED_GROWTH = 1.11;

static void path_of(const mps_job *job, char path[RESUME_PATH])
{
    snprintf(path, RESUME_PATH, "%s/checkpoint.mps", job->place.path);
}

/* A run of a case is continued by 'mps', other jobs by their driver. */
void mps__resume_command(const mps_job *job, char *out, size_t size)
{
    char place[2 * RESUME_PATH];
    mps__shell_word(job->place.path, place, sizeof place);
    if (job->config.text)
        snprintf(out, size, "mps resume %s", place);
    else
        snprintf(out, size, "--resume with the same options");
}

static const char *end_option(const mps_job *job)
{
    return job->config.text ? "run.until" : "--t-end";
}

/* A number of summary.json in the folder; NAN: not found.
 * @param done  out, or NULL: that run reached its end */
static double number_of(const mps_job *job, const char *key, bool *done)
{
    char path[RESUME_PATH], line[256], wanted[40];
    double value = NAN;
    const size_t length = (size_t)snprintf(wanted, sizeof wanted, "  \"%s\": ", key);
    if (done) *done = false;
    snprintf(path, sizeof path, "%s/summary.json", job->place.path);
    const char *why;
    FILE *in = mps__regular_summary(path, &why);
    while (in && fgets(line, sizeof line, in)) {
        if (done && strstr(line, "\"status\": \"ok\"")) *done = true;
        if (strncmp(line, wanted, length) == 0) value = strtod(line + length, NULL);
    }
    if (in) fclose(in);
    return value;
}

/* The end that the run in the folder reached [s]; NAN: it did not. */
static double reached_end(const mps_job *job)
{
    bool done;
    const double t = number_of(job, "t_end", &done);
    return done ? t : NAN;
}

/* ---- writing ---- */

/* Rows up to now are on the disk, and the new checkpoint is not. A checkpoint without the rows
 * before it is useless; the previous one may be valid. */
static bool sync_rows(mps_job *job)
{
    if (job->fitted || job->checkpoint_t == job->totals.t) return false;
    table *const all[] = {&job->probes, &job->momentum, &job->steps, &job->trace_rows};
    bool failed = false;
    for (int k = 0; k < (job->config.trace ? 4 : 3); k++) {
        mps__table_sync(all[k]);
        failed = failed || all[k]->failed;
    }
    job->output_failed = job->output_failed || failed;
    return !failed;
}

/* Set the wall-clock time of the next checkpoint; this one took `s` seconds. */
static void set_clock(mps_job *job, double seconds)
{
    job->checkpoint_clock = mps__progress_clock() +
                            fmax(job->config.checkpoint_clock, seconds / CLOCK_SHARE);
}

void mps__resume_save(mps_job *job)
{
    char path[RESUME_PATH];
    const double begin = mps__progress_clock();
    path_of(job, path);
    if (!mps__job_broadcast(job, mps__job_first(job) && sync_rows(job))) return;
    if (mps__job_note(job, mps_checkpoint_write(job->sim, path), "checkpoint"))
        job->checkpoint_t = job->totals.t;
    set_clock(job, mps__progress_clock() - begin);
}

/* Number of the first checkpoint after t. */
static int64_t next_of(const mps_job *job, double t)
{
    return job->config.checkpoint > 0 ? (int64_t)(t / job->config.checkpoint + 1e-9) + 1 : 0;
}

/* Whether the next step may be the first whose length is fitted to the end. */
static bool may_be_fitted(const mps_job *job, const mps_step_info *info)
{
    return job->config.t_end - info->t <= FITTED_STEPS * FITTED_GROWTH * info->dt;
}

bool mps__resume_due(mps_job *job, const mps_step_info *info)
{
    const int64_t next = next_of(job, info->t);
    const bool by_time = next != job->checkpoint,
               by_clock = job->config.checkpoint_clock > 0 &&
                          mps__progress_clock() >= job->checkpoint_clock;
    job->fitted = job->fitted || strcmp(info->limit, "caller") == 0;
    job->checkpoint = next;
    return !job->fitted && (by_time || by_clock || may_be_fitted(job, info));
}

bool mps__resume_forget(mps_job *job, const char *keep)
{
    const bool done = mps__folder_clear(&job->place, keep, job->error, sizeof job->error);
    job->checkpoint = next_of(job, 0);
    set_clock(job, 0);
    if (!done && !job->code) job->code = MPS_EXIT_USAGE;
    return done;
}

/* ---- continuing a run ---- */

/* Report why there is no state to continue from. */
static bool refuse_checkpoint(mps_job *job, mps_status status)
{
    const bool usage = status == MPS_E_ARG || status == MPS_E_IO || status == MPS_E_VERSION;
    return mps__job_fail(job, usage ? MPS_EXIT_USAGE : MPS_EXIT_FAILED, "resume: %s; " RESUME_ANEW,
                         mps_sim_error(job->sim));
}

/* Restart a run that was killed before its first checkpoint, or is too short to have one. */
static bool begin_again(mps_job *job)
{
    char path[RESUME_PATH];
    const double end = reached_end(job);
    if (job->config.t_end <= end)
        return mps__job_fail(job, MPS_EXIT_USAGE,
                             "resume: the run in '%s' reached its end, t = %g s, and has no "
                             "checkpoint; give a later %s, or " RESUME_ANEW,
                             job->place.path, end, end_option(job));
    snprintf(path, sizeof path, "%s/%s", job->place.path,
             job->config.text ? "case.yaml" : "steps.csv");
    if (access(path, F_OK) != 0)
        return mps__job_fail(job, MPS_EXIT_USAGE, "resume: there is no run in '%s'",
                             job->place.path);
    job->config.resume = 0;
    if (!job->config.quiet)
        mps__job_print(job, "resume: the run in '%s' has no checkpoint: it begins again at t = 0",
                       job->place.path);
    return true;
}

bool mps__resume_read(mps_job *job)
{
    char path[RESUME_PATH];
    double t = 0;
    struct stat there;
    path_of(job, path);
    if (stat(path, &there) != 0 && errno == ENOENT) return begin_again(job);
    const mps_status status = mps_checkpoint_read(job->sim, path);
    if (status < 0) return refuse_checkpoint(job, status);
    mps_sim_time(job->sim, &t, NULL);
    if (t > job->config.t_end)
        return mps__job_fail(job, MPS_EXIT_USAGE,
                             "resume: the checkpoint is at t = %g s, later than %s, %g s; give a "
                             "later end",
                             t, end_option(job), job->config.t_end);
    if (!isnan(reached_end(job)) && !job->config.quiet)
        mps__job_print(job,
                       "resume: the run in '%s' reached its end; its last steps from t = %g s are "
                       "taken again; a later %s extends it",
                       job->place.path, t, end_option(job));
    job->fluid_at_start = number_of(job, "n_fluid", NULL);
    job->totals.t_before = job->checkpoint_t = t;
    job->checkpoint = next_of(job, t);
    set_clock(job, 0);
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
        return mps__job_fail(job, MPS_EXIT_USAGE,
                             "resume: steps.csv has not the steps of the checkpoint; " RESUME_ANEW);
    for (int k = 0; k < (job->config.trace ? 4 : 3); k++)
        if (!mps__table_cut(all[k]))
            return mps__job_fail(job, MPS_EXIT_FAILED,
                                 "resume: the files of rows cannot be cut at the checkpoint: %s",
                                 all[k]->why);
    return true;
}

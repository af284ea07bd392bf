/* SPDX-License-Identifier: BSD-3-Clause */
/* The end of a run: checkpoint, final state, tables, summary, page, and the message of a
 * failure. */
#include "run.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const table *mps__job_failed_table(const mps_job *job)
{
    const table *const all[] = {&job->probes, &job->momentum, &job->steps, &job->trace_rows};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++)
        if (all[k]->failed) return all[k];
    return NULL;
}

void mps__job_solver(const mps_job *job, char *text, size_t size)
{
    const char *solver = "", *preconditioner = NULL;
    mps_solver_name(job->sim, &solver, &preconditioner);
    snprintf(text, size, "%s/%s", solver,
             preconditioner && preconditioner[0] ? preconditioner : "none");
}

static int32_t exit_code(const mps_job *job, mps_status status)
{
    if (job->output_failed || status == MPS_E_NOMEM || status == MPS_E_IO) return MPS_EXIT_FAILED;
    if (status == MPS_W_STOPPED) return job->stop ? MPS_EXIT_INTERRUPTED : MPS_EXIT_FAILED;
    if (status == MPS_E_DIVERGED || status == MPS_E_LOST || status == MPS_E_SOLVER)
        return MPS_EXIT_DIVERGED;
    /* models that do not fit together or the case, or a flow outside the range of a model */
    if (status == MPS_E_PLUGIN || status == MPS_E_STATE)
        return job->totals.steps == 0 ? MPS_EXIT_USAGE : MPS_EXIT_DIVERGED;
    return status < 0 ? MPS_EXIT_FAILED : MPS_EXIT_OK;
}

/* Write the checkpoint from which an interrupted run continues. Once steps are fitted to the end,
 * the checkpoint before them is kept for that. */
static void last_checkpoint(mps_job *job, mps_status status)
{
    if (status == MPS_W_STOPPED && !job->output_failed) mps__resume_save(job);
}

static void close_tables(mps_job *job)
{
    table *const all[] = {&job->trace_rows, &job->probes, &job->momentum, &job->steps};
    if (job->totals.steps == 0) mps__job_write_start(job, NULL);
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++)
        if (!mps__table_close(all[k])) {
            job->output_failed = true;
            mps__job_print(job, "%s: could not be written completely: %s", all[k]->path,
                           strerror(all[k]->error));
        }
}

static void print_failure(mps_job *job, int32_t code, mps_status status)
{
    const job_totals *s = &job->totals;
    const table *failed = mps__job_failed_table(job);
    char resume[1200];
    mps__resume_command(job, resume, sizeof resume);
    if (code == MPS_EXIT_INTERRUPTED)
        mps__job_print(job,
                       "interrupted at t = %.6g s after %lld steps; outputs are complete up to "
                       "there; %s continues",
                       s->t, (long long)s->steps, resume);
    else if (status < 0)
        mps__job_print(job, "%s at t = %.6g s, step %lld: %s", mps_status_name(status), s->t,
                       (long long)s->steps + 1, job->error);
    else if (code != MPS_EXIT_OK && failed)
        mps__job_print(job, "stopped at t = %.6g s, outputs cannot be written: %s; %s%s", s->t,
                       strerror(failed->error), mps__folder_advice(failed->error),
                       job->checkpoint_t > 0 ? "; then continue from the last checkpoint" : "");
    else if (code != MPS_EXIT_OK)
        mps__job_print(job, "%s", job->error[0] ? job->error : "an output could not be written");
}

static void print_end(mps_job *job)
{
    const job_totals *s = &job->totals;
    mps__job_print(job,
                   "t = %.6g s, %lld steps in %.1f s (%.2f ms a step, %.1f pressure iterations), "
                   "%lld particles lost, outputs in %s%s",
                   s->t, (long long)s->steps_of_run, s->wall_s,
                   s->steps_of_run ? 1e3 * s->step_s / (double)s->steps_of_run : 0,
                   s->steps ? s->ppe_iterations / (double)s->steps : 0, (long long)s->lost,
                   job->config.folder, job->config.report ? "; report.html there shows them" : "");
    if (s->volume_largest > VOLUME_GOOD)
        mps__job_print(job,
                       "warning: the liquid's volume changed by up to %.1f %%: levels and static "
                       "pressures are off by about as much; use a finer spacing",
                       100 * s->volume_largest);
}

/* Log the time of the steps of rank 0. */
static void show_profile(mps_job *job)
{
    double seconds = 0;
    char *text;
    for (int k = 0; k < MPS_STAGE_COUNT; k++) seconds += job->totals.seconds[k];
    if (mps_job_profile_text(job->sim, seconds, &text) != MPS_OK) return;
    mps__job_show(job, MPS_JOB_TABLE, text);
    free(text);
}

/* Output of rank 0 at the end. @return exit code */
static int32_t report(mps_job *job, mps_status status)
{
    int32_t code = exit_code(job, status);
    job->totals.status = code == MPS_EXIT_OK ? "ok"
                         : status != MPS_OK  ? mps_status_name(status)
                                             : mps_status_name(MPS_E_IO);
    if (!mps__summary_save(job) || !mps__page_save(job))
        code = code == MPS_EXIT_OK ? MPS_EXIT_FAILED : code;
    print_failure(job, code, status);
    if (!job->config.quiet && code != MPS_EXIT_USAGE) print_end(job);
    if (job->config.profile && code != MPS_EXIT_USAGE) show_profile(job);
    /* refused before its first step: its files are no run that has to be kept */
    if (code == MPS_EXIT_USAGE) mps__resume_forget(job, NULL);
    return code;
}

int32_t mps__job_finish(mps_job *job, mps_status status, double wall_s, double cpu_s)
{
    const double begin = mps__progress_clock();
    last_checkpoint(job, status);
    for (int k = 0; k < job->figures; k++) {
        job_figure *f = &job->figure[k];
        f->measured = f->flags & MPS_JOB_PARTICLES ? NAN : f->value(f->user, job->sim);
    }
    mps__drawing_end(job, status);
    if (mps__job_first(job)) close_tables(job);
    job->totals.wall_s = wall_s + mps__progress_clock() - begin;
    job->totals.cpu_s = cpu_s;
    return mps__job_broadcast(job, mps__job_first(job) ? report(job, status) : 0);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Steps a run to its end: rows, frames, pictures and checkpoints after each step, and Ctrl-C. */
#include "run.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Why all ranks stop; the more serious reason is larger. */
enum { STOP_INTERRUPTED = 1, STOP_FAILED = 2 };

/* ---- signals ---- */

/* A signal handler has no argument: this is the one job of the process that catches signals. */
static volatile sig_atomic_t interrupted, repeated;

enum { SIGNALS = 6, ONCE = 2, SPACING_TEXT = 160 };
/* A second one of the first ONCE signals ends the program; closing terminals, batch queues and
 * limits of processor time send the others more than once. */
static const int CAUGHT[SIGNALS] = {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU};

/* [s] */
static const double SUMMARY_INTERVAL = 10, LOCK_INTERVAL = 20;

/* Previous handler of each signal. */
typedef struct handlers {
    bool set[SIGNALS];
    struct sigaction before[SIGNALS];
} handlers;

static void on_interrupt(int signal)
{
    if (signal != SIGINT && signal != SIGTERM) repeated = signal;
    interrupted = 1;
}

/* The handler is installed for one SIGINT and one SIGTERM: a second Ctrl-C ends the program
 * immediately. */
static void catch_signals(const mps_job *job, handlers *h)
{
    *h = (handlers){{false}, {{.sa_flags = 0}}};
    interrupted = repeated = 0;
    if (!job->config.signals) return;
    for (int k = 0; k < SIGNALS; k++) {
        struct sigaction action = {.sa_handler = on_interrupt, .sa_flags = (int)SA_RESETHAND};
        sigemptyset(&action.sa_mask);
        sigaction(CAUGHT[k], NULL, &h->before[k]);
        if (k >= ONCE) action.sa_flags = 0;
        /* ignored by nohup */
        if (CAUGHT[k] == SIGHUP && h->before[k].sa_handler == SIG_IGN) continue;
        h->set[k] = sigaction(CAUGHT[k], &action, NULL) == 0;
    }
}

/* After a signal that is sent more than once the program still has to unlock the folder and return
 * its code: the next one must not end it earlier. */
static void release_signals(const handlers *h)
{
    const struct sigaction ignore = {.sa_handler = SIG_IGN};
    for (int k = 0; k < SIGNALS; k++)
        if (h->set[k]) sigaction(CAUGHT[k], CAUGHT[k] == repeated ? &ignore : &h->before[k], NULL);
}

/* ---- steps ---- */

static void add_up(mps_job *job, const mps_step_info *info, const double *row)
{
    job_totals *s = &job->totals;
    mps__resume_add_step(job, row);
    s->steps_of_run++;
    s->step_s += mps__progress_clock() - job->step_end;
    for (int k = 0; k < MPS_STAGE_COUNT; k++) s->seconds[k] += info->seconds[k];
}

/* Record the row of a step, and determine what else is due after it. */
static int take_step(mps_job *job, const mps_step_info *info)
{
    const double row[STEP_COLUMNS] = {info->t,
                                      info->dt,
                                      info->cfl,
                                      info->ppe_iterations,
                                      info->ppe_residual,
                                      info->ppe_divergence,
                                      info->max_speed,
                                      (double)info->lost,
                                      info->crossing_time,
                                      info->ppe_solves};
    add_up(job, info, row);
    mps__table_append(&job->steps, row);
    /* interpolation needs samples on both sides of an output time; the next step is at most a
     * little longer than this one */
    const bool sample = job->totals.steps == 1 ||
                        mps__table_wants(&job->probes, info->t, 2 * info->dt);
    return (sample ? DUE_SAMPLE : 0) | mps__drawing_due(job, info->t) |
           (mps__resume_due(job, info) ? DUE_CHECKPOINT : 0);
}

/* Write what pages and statistics of an unfinished run need, also if the process is killed. */
static void save_unfinished(mps_job *job)
{
    mps__table_flush(&job->probes);
    mps__table_flush(&job->momentum);
    mps__table_flush(&job->steps);
    if (job->config.trace) mps__table_flush(&job->trace_rows);
    const double now = mps__progress_clock();
    if (job->summary_clock > 0 && now - job->summary_clock < SUMMARY_INTERVAL) return;
    job->summary_clock = now;
    job->totals.wall_s = now - job->progress.start;
    if (!mps__summary_save(job)) job->output_failed = true;
}

static void show_progress(mps_job *job, const mps_step_info *info)
{
    char text[256];
    if (mps__progress_step(&job->progress, info, text, sizeof text)) {
        if (!job->config.quiet) mps__job_show(job, MPS_JOB_PROGRESS, text);
        save_unfinished(job);
    }
    if (mps__job_failed_table(job)) job->output_failed = true;
    const double now = mps__progress_clock();
    if (now - job->lock_clock < LOCK_INTERVAL) return;
    job->lock_clock = now;
    mps__folder_renew(&job->place);
}

/* Agree on what all ranks do next. */
static int agree_to_stop(mps_job *job)
{
    const bool wanted = job->stop || (job->config.signals && interrupted);
    const int stop = mps__job_most(job, job->output_failed ? STOP_FAILED
                                        : wanted           ? STOP_INTERRUPTED
                                                           : 0);
    if (stop == STOP_INTERRUPTED) job->stop = 1;
    job->output_failed = stop == STOP_FAILED;
    return stop;
}

static int monitor(void *user, mps_sim *sim, const mps_step_info *info)
{
    mps_job *job = user;
    (void)sim;
    const double begin = mps__progress_clock();
    int due = mps__job_broadcast(job, mps__job_first(job) ? take_step(job, info) : 0);
    if (job->config.trace) mps__trace_step(job, info->t, info->dt);
    if (due & DUE_SAMPLE) {
        mps__job_sample(job, info->t);
        due |= mps__peaks_due(job);
    }
    mps__drawing_do(job, info->t, due);
    if (due & DUE_CHECKPOINT) mps__resume_save(job);
    if (mps__job_first(job)) show_progress(job, info);
    job->step_end = mps__progress_clock();
    job->totals.output_s += job->step_end - begin;
    return agree_to_stop(job);
}

/* ---- a run ---- */

static bool allocate_rows(mps_job *job)
{
    const size_t columns = 1 + (size_t)mps__job_columns(job);
    job->start = calloc(columns, sizeof *job->start);
    job->row = calloc(columns, sizeof *job->row);
    return (job->start && job->row) || mps__job_fail(job, MPS_EXIT_FAILED, "out of memory");
}

/* Open all tables. @return false: a rank failed */
static bool open_job(mps_job *job)
{
    if (!mps__job_agree(job)) return false; /* a rank that has failed gets no other result */
    if (!job->ran) {
        mps__colours_begin(job);
        mps__job_boxes(job);
        mps__peaks_begin(job);
        mps__job_device(job);
    }
    if (job->ran)
        mps__job_fail(job, MPS_EXIT_USAGE, "a job runs once; make another one");
    else if (!job->code && allocate_rows(job) && job->config.resume)
        mps__resume_read(job);
    job->ran = true;
    if (!mps__job_agree(job)) return false; /* if another rank cannot read it, all ranks end */
    job->totals.fluid = mps_particles_count(job->sim, MPS_FLUID);
    if (job->config.resume && job->fluid_at_start > 0)
        job->totals.fluid = (int64_t)job->fluid_at_start;
    job->totals.wall = mps_particles_count(job->sim, MPS_WALL);
    job->totals.dummy = mps_particles_count(job->sim, MPS_DUMMY);
    if (mps__job_first(job)) mps__job_open_tables(job);
    return mps__job_agree(job);
}

/* "0.0199 m (0.02 m requested, cells 0.0198 x 0.02 m)": only the parts that differ. */
static void describe_spacing(const mps_job *job, char text[SPACING_TEXT])
{
    const double dp = job->dp, asked = job->config.dp;
    double h[3] = {dp, dp, dp};
    bool cubes = true;
    int used = snprintf(text, SPACING_TEXT, "%g m", dp);
    const bool other = asked > 0 && fabs(asked - dp) > 1e-6 * dp;
    if (other)
        used += snprintf(text + used, SPACING_TEXT - (size_t)used, " (%g m requested", asked);
    mps_lattice_get(job->sim, NULL, h);
    for (int d = 0; d < job->dim; d++) cubes = cubes && fabs(h[d] - dp) <= 1e-6 * dp;
    if (!cubes)
        used += snprintf(text + used, SPACING_TEXT - (size_t)used,
                         job->dim == 3 ? "%scells %g x %g x %g m" : "%scells %g x %g m",
                         other ? ", " : " (", h[0], h[1], h[2]);
    if (other || !cubes) snprintf(text + used, SPACING_TEXT - (size_t)used, ")");
}

/* Write the first row and frame. */
static void begin(mps_job *job)
{
    const mps_job_config *c = &job->config;
    const job_totals *s = &job->totals;
    char spacing[SPACING_TEXT];
    describe_spacing(job, spacing);
    if (!c->quiet)
        mps__job_print(job,
                       "%s%sdp %s, %lld fluid, %lld wall, %lld dummy particles, from t = %g to %g "
                       "s",
                       c->model ? c->model : "", c->model ? ", " : "", spacing, (long long)s->fluid,
                       (long long)s->wall, (long long)s->dummy, s->t, c->t_end);
    mps__progress_begin(&job->progress, c->t_end, mps_particles_count(job->sim, -1),
                        !c->quiet && !c->print);
    mps__progress_from(&job->progress, s->t, s->steps);
    mps__job_first_rows(job);
    mps__frames_begin(job);
    if (c->resume) mps__drawing_skip(job, s->t); /* written before, possibly with another t_end */
    if (mps__job_first(job)) save_unfinished(job);
}

/* The failure of all ranks: preferably the reason of the rank that failed first. */
static mps_status agree_on(mps_job *job, mps_status status)
{
    const int other = 1, most = mps__job_most(job, status >= 0             ? 0
                                                   : status == MPS_E_RANKS ? other
                                                                           : other - status);
    return most == 0 ? status : most == other ? MPS_E_RANKS : other - most;
}

static double cpu_clock(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Step to the end, after all is open. */
static int32_t step(mps_job *job)
{
    const double wall = mps__progress_clock(), cpu = cpu_clock();
    mps_status status = MPS_W_STOPPED;
    handlers before;
    catch_signals(job, &before);
    begin(job);
    job->step_end = mps__progress_clock();
    job->output_failed = mps__job_most(job, job->output_failed) > 0;
    if (!job->output_failed)
        status = agree_on(job, mps_run(job->sim, job->config.t_end, monitor, job));
    if (status < 0) snprintf(job->error, sizeof job->error, "%s", mps_sim_error(job->sim));
    const char *clear = mps__progress_clear(&job->progress);
    if (clear[0]) mps__job_show(job, MPS_JOB_PROGRESS, clear);
    const int32_t code = mps__job_finish(job, status, mps__progress_clock() - wall,
                                         cpu_clock() - cpu);
    release_signals(&before);
    return code;
}

int32_t mps_job_run(mps_job *job, mps_sim *sim)
{
    if (!job || !sim) return MPS_EXIT_USAGE;
    job->sim = sim;
    job->code = 0;
    job->error[0] = '\0';
    mps_sim_shape(sim, &job->dim, &job->dp);
    if (open_job(job)) return step(job);
    if (job->prints && job->error[0]) mps__job_print(job, "%s", job->error);
    return job->code;
}

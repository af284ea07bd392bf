/* SPDX-License-Identifier: BSD-3-Clause */
/* Stepping a run to its end: rows, frames, pictures and checkpoints after each step, Ctrl-C, and what to say when it fails. */
#include "folder.h"
#include "outputs.h"
#include "picture.h"
#include "profile.h"
#include "resume.h"
#include "trace.h"
#include "ranks.h"
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { RUN_QUARTERS = 4 };

static volatile sig_atomic_t interrupted;

/* What rank 0 finds due after a step, and all ranks then do. */
enum { DUE_SAMPLE = 1, DUE_FRAME = 2, DUE_PICTURE = 4, DUE_CHECKPOINT = 8 };
/* Why all ranks stop; the more serious is the larger. */
enum { STOP_INTERRUPTED = 1, STOP_FAILED = 2 };

/* The handler is there for one SIGINT and one SIGTERM: a second Ctrl-C ends the program at once. */
static void on_interrupt(int signal)
{
    (void)signal;
    interrupted = 1;
}

static void catch_interrupt(void)
{
    struct sigaction action = {.sa_handler = on_interrupt, .sa_flags = (int)SA_RESETHAND}, before;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    if (ranks_count() > 1) sigaction(SIGUSR1, &action, NULL); /* mpirun passes it on */
    /* a terminal that closes may say so several times; nohup ignores it */
    action.sa_flags = 0;
    sigaction(SIGHUP, NULL, &before);
    if (before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, NULL);
}

bool run_note(run *r, mps_status status, const char *what)
{
    if (status >= 0) return true;
    r->output_failed = true;
    if (!r->totals.error[0])
        snprintf(r->totals.error, sizeof r->totals.error, "%s: %s", what, mps_sim_error(r->sim));
    return false;
}

/* ---- frames and pictures ---------------------------------------------------------------------------------------- */

/* Whether each rank writes a piece of a frame: a call that all ranks make. */
static bool run_apart(const run *r)
{
    return r->options.pieces && ranks_count() > 1;
}

/* The present state, unless it is in the last frame already. */
static void run_frame_write(run *r)
{
    double t = 0;
    mps_sim_time(r->sim, &t, NULL);
    if (!r->frames || t <= r->frame_t) return;
    run_note(r, mps_frames_write(r->frames), "frames");
    r->frame_t = t;
}

/* Number of the first frame behind t. */
static int64_t run_frame_next(const run *r, double t)
{
    return (int64_t)(t / r->options.t_end * r->options.frames + 1e-9) + 1;
}

/* Frames of all particles, which rank 0 writes, or a piece of each rank. */
static void run_frames_open(run *r)
{
    const bool resume = r->options.resume, pieces = run_apart(r);
    r->frame_t = -1;
    if (r->options.frames == 0 || !(pieces || ranks_gather(r->sim))) return;
    run_note(r,
             mps_frames_open(r->sim, r->options.out, "frames",
                             (resume ? MPS_FRAMES_CONTINUE : 0) | (pieces ? MPS_FRAMES_PIECES : 0) |
                                 (r->options.tank_frame ? MPS_FRAMES_TANK : 0),
                             &r->frames),
             "frames");
    if (!resume) run_frame_write(r);
    r->frame = run_frame_next(r, r->totals.t);
    if (!pieces) ranks_gather_end(r->sim);
}

static bool run_frame_due(const run *r, double t)
{
    double interval = r->options.t_end / (r->options.frames > 0 ? r->options.frames : 1);
    return r->frames && t >= (double)r->frame * interval - 1e-9 * interval;
}

/* At the times asked for, or at quarters; the end has a picture of its own. */
static bool run_picture_due(const run *r, double t)
{
    const cli_options *o = &r->options;
    int count = o->pictures > 0 ? o->pictures : RUN_QUARTERS - 1;
    if (r->pictures == count) return false;
    double next = o->pictures > 0 ? o->picture_t[r->pictures]
                                  : o->t_end * (r->pictures + 1) / RUN_QUARTERS;
    return t >= next - 1e-9 * o->t_end;
}

static void run_picture(run *r, double t)
{
    char path[560];
    r->picture_at[r->pictures] = t;
    snprintf(path, sizeof path, "%s/picture_%d.png", r->options.out, ++r->pictures);
    if (!picture_save(r->sim, r->options.gravity, path)) r->output_failed = true;
}

/* Frames and pictures of the particles of all ranks. */
static void run_draw(run *r, double t, int due)
{
    const bool frame = due & DUE_FRAME, picture = due & DUE_PICTURE, apart = run_apart(r);
    if (frame) r->frame = run_frame_next(r, t);
    if (frame && apart) run_frame_write(r);
    if (!(picture || (frame && !apart)) || !ranks_gather(r->sim)) return;
    if (frame && !apart) run_frame_write(r);
    if (ranks_first() && picture) run_picture(r, t);
    ranks_gather_end(r->sim);
}

/* ---- steps ------------------------------------------------------------------------------------------------------ */

static void run_add_up(run *r, const mps_step_info *info, const double *row)
{
    run_totals *s = &r->totals;
    resume_add_step(r, row);
    s->steps_here++;
    s->step_s += progress_clock() - r->step_end;
    for (int k = 0; k < MPS_STAGE_COUNT; k++) s->seconds[k] += info->seconds[k];
}

/* The first table that could not be written, or NULL. */
static const table *run_failed_table(const run *r)
{
    const table *const all[] = {&r->probes, &r->momentum, &r->steps,
                                r->trace ? &r->trace->file : &r->steps};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++)
        if (all[k]->failed) return all[k];
    return NULL;
}

/* The row of a step, and what else is due after it. */
static int run_step(run *r, const mps_step_info *info)
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
    run_add_up(r, info, row);
    table_append(&r->steps, row);
    /* interpolation needs the samples on both sides of an output time; the next step is at most a little longer than this one */
    const bool sample = r->totals.steps == 1 || table_wants(&r->probes, info->t, 2 * info->dt);
    return (sample ? DUE_SAMPLE : 0) | (run_frame_due(r, info->t) ? DUE_FRAME : 0) |
           (run_picture_due(r, info->t) ? DUE_PICTURE : 0) |
           (resume_due(r, info->t) ? DUE_CHECKPOINT : 0);
}

static void run_progress(run *r, const mps_step_info *info)
{
    if (progress_step(&r->progress, info)) {
        table_flush(&r->probes);
        table_flush(&r->momentum);
        table_flush(&r->steps);
        if (r->trace) table_flush(&r->trace->file);
    }
    if (run_failed_table(r)) r->output_failed = true;
}

static int run_monitor(void *user, mps_sim *sim, const mps_step_info *info)
{
    run *r = user;
    (void)sim;
    double begin = progress_clock();
    const int due = ranks_told(ranks_first() ? run_step(r, info) : 0);
    if (r->trace) trace_step(r, info->t, info->dt);
    if (due & DUE_SAMPLE) run_sample(r, info->t);
    run_draw(r, info->t, due);
    if (due & DUE_CHECKPOINT) resume_save(r);
    if (ranks_first()) run_progress(r, info);
    r->step_end = progress_clock();
    r->totals.output_s += r->step_end - begin;
    const int stop = ranks_most(r->output_failed ? STOP_FAILED
                                : interrupted    ? STOP_INTERRUPTED
                                                 : 0);
    if (stop == STOP_INTERRUPTED) interrupted = 1;
    r->output_failed = stop == STOP_FAILED;
    return stop;
}

/* ---- the end ---------------------------------------------------------------------------------------------------- */

static int run_exit_code(const run *r, mps_status status)
{
    if (r->output_failed || status == MPS_E_NOMEM || status == MPS_E_IO) return CLI_FAILED;
    if (status == MPS_W_STOPPED) return interrupted ? CLI_INTERRUPTED : CLI_FAILED;
    if (status == MPS_E_DIVERGED || status == MPS_E_LOST || status == MPS_E_SOLVER)
        return CLI_DIVERGED;
    /* models that do not fit together or to the case, or a flow beyond a model */
    if (status == MPS_E_PLUGIN || status == MPS_E_STATE)
        return r->totals.steps == 0 ? CLI_USAGE : CLI_DIVERGED;
    return status < 0 ? CLI_FAILED : CLI_OK;
}

/* Where an interrupted run can go on, and one that has come to its end can be extended. */
static void run_last_checkpoint(run *r, mps_status status)
{
    if (status < 0 || r->output_failed) return;
    if (status == MPS_W_STOPPED || r->options.checkpoint > 0) resume_save(r);
}

/* The last state, also of a run that broke off. */
static void run_close_particles(run *r)
{
    char path[560];
    snprintf(path, sizeof path, "%s/picture_end.png", r->options.out);
    if (!picture_save(r->sim, r->options.gravity, path)) r->output_failed = true;
    for (int i = 0; i < r->figures; i++)
        if (r->figure[i].particles)
            r->figure[i].measured = r->figure[i].value(r->figure[i].user, r->sim);
}

static void run_close(run *r, mps_status status)
{
    for (int i = 0; i < r->figures; i++)
        r->figure[i].measured = r->figure[i].particles
                                    ? NAN
                                    : r->figure[i].value(r->figure[i].user, r->sim);
    if (run_apart(r) && status >= 0) run_frame_write(r);
    if (ranks_gather(r->sim)) { /* not where a rank has failed */
        if (!run_apart(r)) run_frame_write(r);
        if (ranks_first()) run_close_particles(r);
        ranks_gather_end(r->sim);
    }
    mps_frames_close(r->frames);
    if (!ranks_first()) return;
    if (r->totals.steps == 0) run_write_start(r, NULL);
    if (r->trace && !table_close(&r->trace->file)) r->output_failed = true;
    if (!table_close(&r->probes) || !table_close(&r->momentum) || !table_close(&r->steps))
        r->output_failed = true;
}

static void run_say(const run *r, int code, mps_status status)
{
    const run_totals *s = &r->totals;
    const char *program = r->options.program;
    const table *failed = run_failed_table(r);
    if (code == CLI_INTERRUPTED)
        fprintf(ranks_messages(),
                "%s: interrupted at t = %.6g s after %lld steps; outputs are complete up to there; "
                "go on with --resume and the same options\n",
                program, s->t, (long long)s->steps);
    else if (status < 0)
        fprintf(ranks_messages(), "%s: %s at t = %.6g s, step %lld: %s\n", program,
                mps_status_name(status), s->t, (long long)s->steps + 1, s->error);
    else if (code != CLI_OK && failed)
        fprintf(ranks_messages(),
                "%s: stopped at t = %.6g s, outputs cannot be written: %s; %s%s\n", program, s->t,
                strerror(failed->error), folder_advice(failed->error),
                r->checkpoint_t > 0 ? "; --resume goes on from the last checkpoint" : "");
    else if (code != CLI_OK)
        fprintf(ranks_messages(), "%s: %s\n", program,
                s->error[0] ? s->error : "an output could not be written");
    if (r->options.quiet || code == CLI_USAGE) return;
    fprintf(ranks_messages(),
            "%s: t = %.6g s, %lld steps in %.1f s (%.2f ms a step, %.1f pressure iterations), %lld "
            "particles lost, outputs in %s\n",
            program, s->t, (long long)s->steps_here, s->wall_s,
            s->steps_here ? 1e3 * s->step_s / (double)s->steps_here : 0,
            s->steps ? s->ppe_iterations / (double)s->steps : 0, (long long)s->lost,
            r->options.out);
}

static double cpu_clock(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Open everything and take the first row and frame. */
static void run_begin(run *r)
{
    r->own_columns = r->columns;
    r->totals.fluid = mps_particles_count(r->sim, MPS_FLUID);
    r->totals.wall = mps_particles_count(r->sim, MPS_WALL);
    r->totals.dummy = mps_particles_count(r->sim, MPS_DUMMY);
    run_boxes(r);
    run_open_tables(r);
    ranks_most(0); /* where rank 0 cannot open them, all exit */
    if (!r->options.quiet) {
        fprintf(
            ranks_messages(),
            "%s: %s, dp %g m, %lld fluid, %lld wall, %lld dummy particles, from t = %g to %g s\n",
            r->options.program, r->options.model, r->options.dp, (long long)r->totals.fluid,
            (long long)r->totals.wall, (long long)r->totals.dummy, r->totals.t, r->options.t_end);
    }
    progress_begin(&r->progress, r->options.t_end, mps_particles_count(r->sim, -1),
                   r->options.quiet);
    progress_from(&r->progress, r->totals.t, r->totals.steps);
    run_first_rows(r);
    run_frames_open(r);
    while (r->options.resume && run_picture_due(r, r->totals.t))
        r->picture_at[r->pictures++] = NAN; /* taken before, maybe with another --t-end */
    catch_interrupt();
}

/* The failure that all ranks end with: rather that of the rank that failed first than that there was one. */
static mps_status run_agree(mps_status status)
{
    const int other = 1, most = ranks_most(status >= 0             ? 0
                                           : status == MPS_E_RANKS ? other
                                                                   : other - status);
    return most == 0 ? status : most == other ? MPS_E_RANKS : other - most;
}

/* What the steps of rank 0 have cost. */
static void run_profile(const run *r)
{
    double seconds = 0;
    for (int k = 0; k < MPS_STAGE_COUNT; k++) seconds += r->totals.seconds[k];
    profile_print(r->sim, seconds);
}

/* What rank 0 writes and says at the end. @return exit code */
static int run_report(run *r, mps_status status)
{
    int code = run_exit_code(r, status);
    r->totals.status = code == CLI_OK     ? "ok"
                       : status != MPS_OK ? mps_status_name(status)
                                          : mps_status_name(MPS_E_IO);
    if (!summary_save(r) || !report_save(r)) code = code == CLI_OK ? CLI_FAILED : code;
    run_say(r, code, status);
    if (r->options.profile && code != CLI_USAGE) run_profile(r);
    /* refused before its first step: what it wrote is no run that another one must keep */
    if (code == CLI_USAGE) folder_clear(r);
    return code;
}

int run_finish(run *r)
{
    double wall = progress_clock(), cpu = cpu_clock();
    mps_status status = MPS_W_STOPPED;
    run_begin(r);
    r->step_end = progress_clock();
    r->output_failed = ranks_most(r->output_failed) > 0;
    if (!r->output_failed) status = run_agree(mps_run(r->sim, r->options.t_end, run_monitor, r));
    if (status < 0) snprintf(r->totals.error, sizeof r->totals.error, "%s", mps_sim_error(r->sim));
    progress_clear(&r->progress);
    run_last_checkpoint(r, status);
    run_close(r, status);
    r->totals.wall_s = progress_clock() - wall;
    r->totals.cpu_s = cpu_clock() - cpu;
    const int code = ranks_told(ranks_first() ? run_report(r, status) : 0);
    table_free(&r->probes);
    table_free(&r->momentum);
    table_free(&r->steps);
    if (r->trace) trace_free(r->trace);
    ranks_detach();
    return code;
}

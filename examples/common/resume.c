/* SPDX-License-Identifier: BSD-3-Clause */
/* A checkpoint holds the simulation; what the run itself has summed up and drawn comes back from its files of rows. They are on the disk
 * before each checkpoint, so that also after a kill they reach at least up to it. */
#include "resume.h"
#include "folder.h"
#include "outputs.h"
#include "trace.h"
#include "ranks.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { RESUME_PATH = 560 };

static void resume_path(const run *r, char path[RESUME_PATH])
{
    snprintf(path, RESUME_PATH, "%s/checkpoint.mps", r->options.out);
}

static const char ANEW[] = "start anew with --overwrite, or in another folder with --out";

/* Whether the run in the folder came to its end. */
static bool resume_is_done(const run *r)
{
    char path[RESUME_PATH], line[256];
    bool done = false;
    snprintf(path, sizeof path, "%s/summary.json", r->options.out);
    FILE *in = fopen(path, "r");
    while (in && fgets(line, sizeof line, in))
        done = done || strstr(line, "\"status\": \"ok\"") != NULL;
    if (in) fclose(in);
    return done;
}

static void resume_refuse(run *r, int code, const char *why)
{
    fprintf(ranks_messages(), "%s: --resume: %s\n", r->options.program, why);
    ranks_exit(code);
}

/* Rows up to now are on the disk, and no checkpoint is. One without the rows before it would be of no use, the one that is there may be. */
static bool resume_rows(run *r)
{
    if (r->checkpoint_t == r->totals.t) return false;
    table_sync(&r->probes);
    table_sync(&r->momentum);
    table_sync(&r->steps);
    if (r->trace) table_sync(&r->trace->file);
    const bool failed = r->probes.failed || r->momentum.failed || r->steps.failed ||
                        (r->trace && r->trace->file.failed);
    r->output_failed = r->output_failed || failed;
    return !failed;
}

void resume_save(run *r)
{
    char path[RESUME_PATH];
    resume_path(r, path);
    if (!ranks_told(ranks_first() && resume_rows(r))) return;
    if (run_note(r, mps_checkpoint_write(r->sim, path), "checkpoint"))
        r->checkpoint_t = r->totals.t;
}

/* Number of the first checkpoint behind t. */
static int64_t resume_next(const run *r, double t)
{
    return r->options.checkpoint > 0 ? (int64_t)(t / r->options.checkpoint + 1e-9) + 1 : 0;
}

bool resume_due(run *r, double t)
{
    if (r->options.checkpoint == 0 || resume_next(r, t) == r->checkpoint) return false;
    r->checkpoint = resume_next(r, t);
    return true;
}

void resume_forget(run *r)
{
    r->checkpoint = 1;
    folder_clear(r);
}

void resume_load(run *r)
{
    char path[RESUME_PATH], why[1024];
    double t = 0;
    struct stat there;
    resume_path(r, path);
    const bool missing = stat(path, &there) != 0 && errno == ENOENT;
    mps_status status = mps_checkpoint_read(r->sim, path);
    if (status < 0) {
        const bool usage = status == MPS_E_ARG || status == MPS_E_IO || status == MPS_E_VERSION;
        snprintf(why, sizeof why, "%s%s; %s%s", mps_sim_error(r->sim),
                 missing && resume_is_done(r) ? "; the run there has come to its end" : "",
                 missing ? "only an interrupted run or one with --checkpoint leaves a checkpoint; "
                         : "",
                 ANEW);
        resume_refuse(r, usage ? CLI_USAGE : CLI_FAILED, why);
    }
    ranks_most(0); /* where another rank cannot read it, all exit */
    mps_sim_time(r->sim, &t, NULL);
    snprintf(why, sizeof why,
             "the checkpoint is at t = %g s, later than --t-end %g; give a later --t-end", t,
             r->options.t_end);
    if (t > r->options.t_end) resume_refuse(r, CLI_USAGE, why);
    if (t == r->options.t_end && !r->options.quiet)
        fprintf(ranks_messages(),
                "%s: --resume: this run has come to its end, t = %g s: no step is left, its last "
                "picture, plots and report are written again; a later --t-end goes on\n",
                r->options.program, t);
    r->totals.t_before = r->checkpoint_t = t;
    r->checkpoint = resume_next(r, t);
}

void resume_add_step(void *user, const double *row)
{
    run_totals *s = &((run *)user)->totals;
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

void resume_tables(run *r)
{
    int64_t steps = 0;
    mps_sim_time(r->sim, NULL, &steps);
    if (r->totals.steps != steps || r->totals.t != r->totals.t_before)
        resume_refuse(r, CLI_USAGE,
                      "steps.csv has not the steps of the checkpoint; start anew with --overwrite, "
                      "or in another folder with --out");
    if (!table_cut(&r->probes) || !table_cut(&r->momentum) || !table_cut(&r->steps) ||
        (r->trace && !table_cut(&r->trace->file)))
        resume_refuse(r, CLI_FAILED, "the files of rows cannot be cut at the checkpoint");
}

void resume_say_anew(const run *r)
{
    fprintf(ranks_messages(),
            "%s: --resume: these files do not go with the options or the checkpoint; %s\n",
            r->options.program, ANEW);
}

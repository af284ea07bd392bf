/* SPDX-License-Identifier: BSD-3-Clause */
/* A checkpoint holds the simulation; what the run itself has summed up and drawn comes back from its files of rows. They are on the disk
 * before each checkpoint, so that also after a kill they reach at least up to it. */
#include "resume.h"
#include "folder.h"
#include "outputs.h"
#include "trace.h"
#include <math.h>
#include <stdlib.h>

enum { RESUME_PATH = 560 };

static void resume_path(const run *r, char path[RESUME_PATH])
{
    snprintf(path, RESUME_PATH, "%s/checkpoint.mps", r->options.out);
}

static void resume_refuse(run *r, int code, const char *why)
{
    fprintf(stderr, "%s: --resume: %s\n", r->options.program, why);
    mps_sim_destroy(r->sim);
    exit(code);
}

/* A checkpoint without the rows before it would be of no use, the one that is there may be. */
void resume_save(run *r)
{
    char path[RESUME_PATH];
    if (r->checkpoint_t == r->totals.t) return;
    resume_path(r, path);
    table_sync(&r->probes);
    table_sync(&r->momentum);
    table_sync(&r->steps);
    if (r->trace) table_sync(&r->trace->file);
    if (r->probes.failed || r->momentum.failed || r->steps.failed ||
        (r->trace && r->trace->file.failed))
        r->output_failed = true;
    else if (run_note(r, mps_checkpoint_write(r->sim, path), "checkpoint"))
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
    char path[RESUME_PATH], why[128];
    double t = 0;
    resume_path(r, path);
    mps_status status = mps_checkpoint_read(r->sim, path);
    if (status < 0) {
        const bool usage = status == MPS_E_ARG || status == MPS_E_IO || status == MPS_E_VERSION;
        resume_refuse(r, usage ? CLI_USAGE : CLI_FAILED, mps_sim_error(r->sim));
    }
    mps_sim_time(r->sim, &t, NULL);
    snprintf(why, sizeof why, "the checkpoint is at t = %g s, later than --t-end %g", t,
             r->options.t_end);
    if (t > r->options.t_end) resume_refuse(r, CLI_USAGE, why);
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
        resume_refuse(r, CLI_USAGE, "steps.csv has not the steps of the checkpoint");
    if (!table_cut(&r->probes) || !table_cut(&r->momentum) || !table_cut(&r->steps) ||
        (r->trace && !table_cut(&r->trace->file)))
        resume_refuse(r, CLI_FAILED, "the files of rows cannot be cut at the checkpoint");
}

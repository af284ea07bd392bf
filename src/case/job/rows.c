/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows of probes.csv and momentum.csv, and opening of all tables. All ranks measure, rank 0 owns
 * the tables. */
#include "run.h"
#include <errno.h>
#include <math.h>
#include <mps/operators.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char CASE_FILE[] = "case.yaml";

/* ---- opening ---- */

/* A table_row_fn for probes.csv. */
static void take_row(void *user, const double *row)
{
    mps_job *job = user;
    const double volume = fabs(row[job->columns + COLUMN_VOLUME]);
    mps__peaks_row(&job->peaks, row);
    job->totals.volume_largest = fmax(job->totals.volume_largest, volume);
}

/* Connect the evaluations of rows, which a continued run repeats for the rows read back. */
static void attach(mps_job *job, table *t)
{
    if (t == &job->steps) t->each = mps__resume_add_step;
    if (t == &job->probes) t->each = take_row;
    if (t == &job->trace_rows) t->each = mps__trace_keep;
    t->user = job;
}

bool mps__job_open_table(mps_job *job, table *t, const char *name, const char *header, int columns)
{
    const bool each_step = t == &job->steps || t == &job->trace_rows;
    const double interval = each_step ? 0 : job->config.row_interval;
    bool done = mps__table_create(t, job->place.path, name, columns, interval);
    attach(job, t);
    if (done)
        done = job->config.resume ? mps__table_resume(t, header, job->totals.t_before)
                                  : mps__table_begin(t, header);
    if (done) return true;
    if (!job->config.resume) return mps__job_fail(job, MPS_EXIT_USAGE, "%s", t->why);
    return mps__job_fail(job, MPS_EXIT_USAGE, "resume: %s; " RESUME_ANEW, t->why);
}

/* Header of probes.csv; the caller frees it, NULL: memory is exhausted. */
static char *probes_header(const mps_job *job)
{
    const int columns = mps__job_columns(job);
    const size_t size = 8 + (size_t)columns * (JOB_NAME + JOB_UNIT + 4);
    char *header = malloc(size);
    size_t used = header ? (size_t)snprintf(header, size, "t[s]") : 0;
    for (int k = 0; header && k < columns; k++) {
        const job_column c = mps__job_column(job, k);
        used += (size_t)snprintf(header + used, size - used, c.unit[0] ? ",%s[%s]" : ",%s", c.name,
                                 c.unit);
    }
    return header;
}

static bool open_probes(mps_job *job)
{
    char *header = probes_header(job);
    const bool done = header ? mps__job_open_table(job, &job->probes, "probes.csv", header,
                                                   1 + mps__job_columns(job))
                             : mps__job_fail(job, MPS_EXIT_FAILED, "out of memory");
    free(header);
    return done;
}

/* Names of the columns of momentum.csv, in the order from MOMENTUM_TOTAL on. */
static const char *const MOMENTA[] = {"momentum",  "gravity",  "force", "plugins",
                                      "reaction",  "pressure", "walls", "numerical",
                                      "collision", "shift",    "added", "friction"};

static bool open_momentum(mps_job *job)
{
    char header[3 * MOMENTUM_COLUMNS * 32] = "t[s]";
    size_t used = strlen(header);
    for (int d = 0; d < job->dim; d++)
        for (int k = 0; k < MOMENTUM_COLUMNS; k++)
            used += (size_t)snprintf(header + used, sizeof header - used, ",%s_%c[%s]", MOMENTA[k],
                                     "xyz"[d], job -> dim == 3 ? "N s" : "N s/m");
    return mps__job_open_table(job, &job->momentum, "momentum.csv", header,
                               1 + job->dim * MOMENTUM_COLUMNS);
}

/* Write the case as run. A killed process leaves this file or the one before it. */
static bool write_case(mps_job *job)
{
    char path[FOLDER_PATH + 16], temporary[FOLDER_PATH + 24];
    if (!job->config.text) return true;
    snprintf(path, sizeof path, "%s/%s", job->place.path, CASE_FILE);
    snprintf(temporary, sizeof temporary, "%s.tmp", path);
    FILE *out = fopen(temporary, "w");
    bool done = out && fputs(job->config.text, out) >= 0;
    if (out && fclose(out) != 0) done = false;
    if (done && rename(temporary, path) == 0) return true;
    mps__job_fail(job, MPS_EXIT_USAGE, "%s: %s", path, strerror(errno));
    if (out) unlink(temporary);
    return false;
}

static bool open_all(mps_job *job)
{
    return open_probes(job) && open_momentum(job) &&
           mps__job_open_table(job, &job->steps, "steps.csv", STEP_HEADER, STEP_COLUMNS) &&
           mps__trace_open(job);
}

/* The case is written before the rows of a new run, so that a killed run can start again. */
bool mps__job_open_tables(mps_job *job)
{
    if (!job->config.resume)
        return mps__resume_forget(job, job->config.text ? CASE_FILE : NULL) && write_case(job) &&
               open_all(job);
    if (!mps__folder_has_no_links(&job->place, job->error, sizeof job->error)) {
        job->code = MPS_EXIT_USAGE;
        return false;
    }
    return open_all(job) && mps__resume_tables(job) && write_case(job);
}

/* ---- rows ---- */

static void sample_momentum(mps_job *job, double t)
{
    mps_momentum m;
    double row[1 + 3 * MOMENTUM_COLUMNS] = {t};
    const int dim = job->dim;
    mps_momentum_init(&m, sizeof m);
    mps__job_note(job, mps_momentum_get(job->sim, &m), "momentum");
    if (!mps__job_first(job)) return;
    const double *const values[MOMENTUM_COLUMNS] = {m.total,     m.gravity,  m.force, m.plugins,
                                                    m.reaction,  m.pressure, m.walls, m.numerical,
                                                    m.collision, m.shift,    m.added, m.friction};
    for (int d = 0; d < dim; d++)
        for (int k = 0; k < MOMENTUM_COLUMNS; k++) row[1 + d * MOMENTUM_COLUMNS + k] = values[k][d];
    mps__table_sample(&job->momentum, row);
}

static void measure_energies(mps_job *job, double *out)
{
    mps_energy e;
    mps_motion_state tank = {.struct_size = sizeof tank};
    mps_energy_init(&e, sizeof e);
    mps__job_note(job, mps_energy_get(job->sim, &e), "energies");
    mps__job_note(job, mps_motion_state_get(job->sim, &tank), "motion");
    const double values[COLUMN_COMMON] = {e.kinetic,
                                          tank.value[MPS_MOVE_X],
                                          e.potential,
                                          e.wall_work_momentum,
                                          e.wall_work_probes,
                                          e.viscous,
                                          e.plugins,
                                          e.collision,
                                          e.shift,
                                          e.numerical,
                                          e.added,
                                          e.volume_error,
                                          e.friction,
                                          e.layers};
    memcpy(out, values, sizeof values);
    job->totals.volume_error = e.volume_error;
}

static double measure_column(mps_job *job, const job_column *c)
{
    double values[8] = {0};
    if (c->value) return c->value(c->user, job->sim);
    if (!mps__job_note(job, mps_probe_read(job->sim, c->probe, values), c->name)) return NAN;
    return values[c->component] - c->zero;
}

void mps__job_measure(mps_job *job, double *values)
{
    bool particles = false;
    for (int i = 0; i < job->columns; i++) {
        const bool theirs = (job->column[i].flags & MPS_JOB_PARTICLES) != 0;
        particles = particles || theirs;
        values[i] = theirs ? NAN : measure_column(job, &job->column[i]);
    }
    if (!particles || !mps__job_collect(job)) return;
    for (int i = 0; i < job->columns && mps__job_first(job); i++)
        if (job->column[i].flags & MPS_JOB_PARTICLES)
            values[i] = measure_column(job, &job->column[i]);
    mps__job_collect_end(job);
}

static void measure_all(mps_job *job, double t, double *row)
{
    row[0] = t;
    mps__job_measure(job, row + 1);
    measure_energies(job, row + 1 + job->columns);
}

void mps__job_write_start(mps_job *job, const double *first)
{
    for (int i = 0; first && i < job->columns; i++)
        if (job->column[i].flags & MPS_JOB_PRESSURE) job->start[1 + i] = first[1 + i];
    mps__table_sample(&job->probes, job->start);
}

void mps__job_sample(mps_job *job, double t)
{
    measure_all(job, t, job->row);
    if (mps__job_first(job)) {
        if (job->totals.steps == 1) mps__job_write_start(job, job->row);
        mps__table_sample(&job->probes, job->row);
    }
    sample_momentum(job, t);
}

/* Search neighbours as the first step does, which sorts the particles: values measured before it
 * then have that order too, with any number of ranks. A failure recurs in the step. */
static void order(const mps_job *job)
{
    mps_stencil near;
    mps_stencil_init(&near, sizeof near);
    if (!job->config.resume) mps_stencil_get(job->sim, MPS_NEAR, &near);
}

void mps__job_first_rows(mps_job *job)
{
    order(job);
    measure_all(job, job->totals.t, job->start);
    if (job->config.resume && mps__job_first(job)) mps__table_sample(&job->probes, job->start);
    sample_momentum(job, job->totals.t);
    if (job->config.trace && !job->config.resume) mps__trace_step(job, 0, 0);
}

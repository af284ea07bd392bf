/* SPDX-License-Identifier: BSD-3-Clause */
/* Stepping a run to its end: rows, frames, pictures and checkpoints after each step, Ctrl-C, and what to say when it fails. */
#include "folder.h"
#include "outputs.h"
#include "picture.h"
#include "resume.h"
#include "trace.h"
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { RUN_QUARTERS = 4 };

static volatile sig_atomic_t interrupted;

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

/* ---- rows ------------------------------------------------------------------------------------------------------ */

static void header_add(char *header, size_t size, const char *name, const char *unit)
{
    size_t used = strlen(header);
    snprintf(header + used, size - used, ",%s[%s]", name, unit);
}

static bool run_open_table(run *r, table *t, const char *name, const char *header, int columns,
                           double interval)
{
    if (!table_create(t, r->options.out, name, columns, interval)) return false;
    if (!r->options.resume) return table_begin(t, header);
    return table_resume(t, header, r->totals.t_before, t == &r->steps ? resume_add_step : NULL, r);
}

static bool run_open_probes(run *r)
{
    char header[(RUN_COLUMNS + RUN_COMMON) * 48] = "t[s]";
    for (int i = 0; i < run_columns_all(r); i++) {
        const run_column c = run_column_at(r, i);
        if (c.unit[0])
            header_add(header, sizeof header, c.name, c.unit);
        else
            snprintf(header + strlen(header), sizeof header - strlen(header), ",%s", c.name);
    }
    return run_open_table(r, &r->probes, "probes.csv", header, 1 + run_columns_all(r),
                          r->options.probe_dt);
}

/* Names of the columns of momentum.csv, in the order of MOMENTUM_TOTAL and on. */
static const char *const MOMENTA[] = {"momentum",  "gravity",   "force", "pressure", "walls",
                                      "numerical", "collision", "shift", "added"};

static bool run_open_momentum(run *r)
{
    char header[3 * MOMENTUM_COLUMNS * 32] = "t[s]", name[32];
    const int dim = r->options.dim == 3 ? 3 : 2;
    for (int d = 0; d < dim; d++)
        for (int k = 0; k < MOMENTUM_COLUMNS; k++) {
            snprintf(name, sizeof name, "%s_%c", MOMENTA[k], "xyz"[d]);
            header_add(header, sizeof header, name, dim == 3 ? "N s" : "N s/m");
        }
    return run_open_table(r, &r->momentum, "momentum.csv", header, 1 + dim * MOMENTUM_COLUMNS,
                          r->options.probe_dt);
}

static void run_momentum(run *r, double t)
{
    mps_momentum m;
    double row[1 + 3 * MOMENTUM_COLUMNS] = {t};
    const int dim = r->options.dim == 3 ? 3 : 2;
    mps_momentum_init(&m, sizeof m);
    run_note(r, mps_momentum_get(r->sim, &m), "momentum");
    const double *const values[MOMENTUM_COLUMNS] = {m.total,     m.gravity, m.force,
                                                    m.pressure,  m.walls,   m.numerical,
                                                    m.collision, m.shift,   m.added};
    for (int d = 0; d < dim; d++)
        for (int k = 0; k < MOMENTUM_COLUMNS; k++) row[1 + d * MOMENTUM_COLUMNS + k] = values[k][d];
    table_sample(&r->momentum, row);
}

static void run_energies(run *r, double *out)
{
    mps_energy e;
    mps_motion_state tank = {.struct_size = sizeof tank};
    mps_energy_init(&e, sizeof e);
    run_note(r, mps_energy_get(r->sim, &e), "energies");
    run_note(r, mps_motion_state_get(r->sim, &tank), "motion");
    const double values[RUN_COMMON] = {e.kinetic, tank.value[MPS_SURGE], e.potential, e.wall_work,
                                       e.viscous, e.collision,           e.shift,     e.numerical,
                                       e.added,   e.volume_error};
    memcpy(out, values, sizeof values);
    r->totals.volume_error = e.volume_error;
}

double run_measure_column(run *r, const run_column *c)
{
    double values[8] = {0};
    if (c->value) return c->value(c->user, r->sim);
    if (!run_note(r, mps_probe_read(r->sim, c->probe, values), c->name)) return NAN;
    return values[c->component] - c->zero;
}

static void run_measure(run *r, double t, double *row)
{
    row[0] = t;
    for (int i = 0; i < r->columns; i++) row[1 + i] = run_measure_column(r, &r->column[i]);
    run_energies(r, row + 1 + r->columns);
}

/* There is no pressure before the first step: the row of t = 0 waits for it and takes its pressures, or goes out without. */
static void run_write_start(run *r, const double *first)
{
    for (int i = 0; first && i < r->columns; i++)
        if (r->column[i].pressure) r->start[1 + i] = first[1 + i];
    table_sample(&r->probes, r->start);
}

static void run_sample(run *r, double t)
{
    double row[1 + RUN_COLUMNS + RUN_COMMON];
    run_measure(r, t, row);
    if (r->totals.steps == 1) run_write_start(r, row);
    table_sample(&r->probes, row);
    run_momentum(r, t);
}

/* ---- frames and pictures ---------------------------------------------------------------------------------------- */

/* The state at t, unless it is in the last frame already. */
static void run_frame_write(run *r, double t)
{
    if (!r->frames || t <= r->frame_t) return;
    run_note(r, mps_frames_write(r->frames), "frames");
    r->frame_t = t;
}

/* Number of the first frame behind t. */
static int64_t run_frame_next(const run *r, double t)
{
    return (int64_t)(t / r->options.t_end * r->options.frames + 1e-9) + 1;
}

static void run_frames_open(run *r)
{
    const bool resume = r->options.resume;
    r->frame_t = -1;
    if (r->options.frames == 0) return;
    run_note(r,
             mps_frames_open(r->sim, r->options.out, "frames", resume ? MPS_FRAMES_CONTINUE : 0,
                             &r->frames),
             "frames");
    if (!resume) run_frame_write(r, 0);
    r->frame = run_frame_next(r, r->totals.t);
}

static void run_frame(run *r, double t)
{
    double interval = r->options.t_end / (r->options.frames > 0 ? r->options.frames : 1);
    if (!r->frames || t < (double)r->frame * interval - 1e-9 * interval) return;
    run_frame_write(r, t);
    r->frame = run_frame_next(r, t);
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
    if (!run_picture_due(r, t)) return;
    r->picture_at[r->pictures] = t;
    snprintf(path, sizeof path, "%s/picture_%d.png", r->options.out, ++r->pictures);
    if (!picture_save(r->sim, r->options.gravity, path)) r->output_failed = true;
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

static int run_monitor(void *user, mps_sim *sim, const mps_step_info *info)
{
    run *r = user;
    (void)sim;
    double begin = progress_clock();
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
    if (r->trace) trace_step(r, info->t, info->dt);
    /* interpolation needs the samples on both sides of an output time; the next step is at most a little longer than this one */
    if (r->totals.steps == 1 || table_wants(&r->probes, info->t, 2 * info->dt))
        run_sample(r, info->t);
    run_frame(r, info->t);
    run_picture(r, info->t);
    if (resume_due(r, info->t)) resume_save(r);
    if (progress_step(&r->progress, info)) {
        table_flush(&r->probes);
        table_flush(&r->momentum);
        table_flush(&r->steps);
        if (r->trace) table_flush(&r->trace->file);
    }
    if (run_failed_table(r)) r->output_failed = true;
    r->step_end = progress_clock();
    r->totals.output_s += r->step_end - begin;
    return interrupted || r->output_failed;
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

static void run_close(run *r)
{
    char path[560];
    run_frame_write(r, r->totals.t); /* the last state, also of a run that broke off */
    mps_frames_close(r->frames);
    snprintf(path, sizeof path, "%s/picture_end.png", r->options.out);
    if (!picture_save(r->sim, r->options.gravity, path)) r->output_failed = true;
    for (int i = 0; i < r->figures; i++)
        r->figure[i].measured = r->figure[i].value(r->figure[i].user, r->sim);
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
        fprintf(stderr,
                "%s: interrupted at t = %.6g s after %lld steps; outputs are complete up to there; "
                "go on with --resume and the same options\n",
                program, s->t, (long long)s->steps);
    else if (status < 0)
        fprintf(stderr, "%s: %s at t = %.6g s, step %lld: %s\n", program, mps_status_name(status),
                s->t, (long long)s->steps + 1, s->error);
    else if (code != CLI_OK && failed)
        fprintf(stderr, "%s: stopped at t = %.6g s, outputs cannot be written: %s; %s%s\n", program,
                s->t, strerror(failed->error), folder_advice(failed->error),
                r->checkpoint_t > 0 ? "; --resume goes on from the last checkpoint" : "");
    else if (code != CLI_OK)
        fprintf(stderr, "%s: %s\n", program,
                s->error[0] ? s->error : "an output could not be written");
    if (r->options.quiet || code == CLI_USAGE) return;
    fprintf(stderr,
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

static void run_open_tables(run *r)
{
    if (r->options.resume)
        resume_load(r);
    else
        resume_forget(r);
    if (!run_open_probes(r) || !run_open_momentum(r) ||
        !run_open_table(r, &r->steps, "steps.csv", STEP_HEADER, STEP_COLUMNS, 0) ||
        !trace_open(r)) {
        if (r->options.resume) resume_say_anew(r);
        exit(CLI_USAGE);
    }
    if (r->options.resume) resume_tables(r);
}

/* The state that the first step begins with. Its row is in the files where a run goes on: it is only what the next one is interpolated from. */
static void run_first_rows(run *r)
{
    run_measure(r, r->totals.t, r->start);
    if (r->options.resume) table_sample(&r->probes, r->start);
    run_momentum(r, r->totals.t);
    if (r->trace && !r->options.resume) trace_step(r, 0, 0);
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
    if (!r->options.quiet) {
        fprintf(
            stderr,
            "%s: %s, dp %g m, %lld fluid, %lld wall, %lld dummy particles, from t = %g to %g s\n",
            r->options.program, r->options.model, r->options.dp, (long long)r->totals.fluid,
            (long long)r->totals.wall, (long long)r->totals.dummy, r->totals.t, r->options.t_end);
    }
    run_first_rows(r);
    run_frames_open(r);
    while (r->options.resume && run_picture_due(r, r->totals.t))
        r->picture_at[r->pictures++] = NAN; /* taken before, maybe with another --t-end */
    progress_begin(&r->progress, r->options.t_end, mps_particles_count(r->sim, -1),
                   r->options.quiet);
    progress_from(&r->progress, r->totals.t, r->totals.steps);
    catch_interrupt();
}

int run_finish(run *r)
{
    double wall = progress_clock(), cpu = cpu_clock();
    mps_status status = MPS_W_STOPPED;
    run_begin(r);
    r->step_end = progress_clock();
    if (!r->output_failed) status = mps_run(r->sim, r->options.t_end, run_monitor, r);
    if (status < 0) snprintf(r->totals.error, sizeof r->totals.error, "%s", mps_sim_error(r->sim));
    progress_clear(&r->progress);
    run_last_checkpoint(r, status);
    run_close(r);
    r->totals.wall_s = progress_clock() - wall;
    r->totals.cpu_s = cpu_clock() - cpu;
    int code = run_exit_code(r, status);
    r->totals.status = code == CLI_OK     ? "ok"
                       : status != MPS_OK ? mps_status_name(status)
                                          : mps_status_name(MPS_E_IO);
    if (!summary_save(r) || !report_save(r)) code = code == CLI_OK ? CLI_FAILED : code;
    run_say(r, code, status);
    /* refused before its first step: what it wrote is no run that another one must keep */
    if (code == CLI_USAGE) folder_clear(r);
    table_free(&r->probes);
    table_free(&r->momentum);
    table_free(&r->steps);
    if (r->trace) trace_free(r->trace);
    mps_sim_destroy(r->sim);
    return code;
}

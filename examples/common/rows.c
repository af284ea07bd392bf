/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows of probes.csv and momentum.csv, and opening all tables. All ranks measure, rank 0 has the tables. */
#include "outputs.h"
#include "ranks.h"
#include "resume.h"
#include "trace.h"
#include <math.h>
#include <mps/operators.h>
#include <string.h>

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
static const char *const MOMENTA[] = {"momentum",  "gravity",  "force", "plugins",
                                      "reaction",  "pressure", "walls", "numerical",
                                      "collision", "shift",    "added"};

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
    if (!ranks_first()) return;
    const double *const values[MOMENTUM_COLUMNS] = {m.total,     m.gravity,  m.force, m.plugins,
                                                    m.reaction,  m.pressure, m.walls, m.numerical,
                                                    m.collision, m.shift,    m.added};
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
    const double values[RUN_COMMON] = {e.kinetic,
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
                                       e.volume_error};
    memcpy(out, values, sizeof values);
    r->totals.volume_error = e.volume_error;
}

static double run_measure_column(run *r, const run_column *c)
{
    double values[8] = {0};
    if (c->value) return c->value(c->user, r->sim);
    if (!run_note(r, mps_probe_read(r->sim, c->probe, values), c->name)) return NAN;
    return values[c->component] - c->zero;
}

void run_measure_columns(run *r, double *values)
{
    bool particles = false;
    for (int i = 0; i < r->columns; i++) {
        particles = particles || r->column[i].particles;
        values[i] = r->column[i].particles ? NAN : run_measure_column(r, &r->column[i]);
    }
    if (!particles || !ranks_gather(r->sim)) return;
    for (int i = 0; i < r->columns && ranks_first(); i++)
        if (r->column[i].particles) values[i] = run_measure_column(r, &r->column[i]);
    ranks_gather_end(r->sim);
}

static void run_measure(run *r, double t, double *row)
{
    row[0] = t;
    run_measure_columns(r, row + 1);
    run_energies(r, row + 1 + r->columns);
}

void run_write_start(run *r, const double *first)
{
    for (int i = 0; first && i < r->columns; i++)
        if (r->column[i].pressure) r->start[1 + i] = first[1 + i];
    table_sample(&r->probes, r->start);
}

void run_sample(run *r, double t)
{
    double row[1 + RUN_COLUMNS + RUN_COMMON];
    run_measure(r, t, row);
    if (ranks_first()) {
        if (r->totals.steps == 1) run_write_start(r, row);
        table_sample(&r->probes, row);
    }
    run_momentum(r, t);
}

void run_open_tables(run *r)
{
    if (r->options.resume) resume_load(r);
    if (!ranks_first()) return;
    if (!r->options.resume) resume_forget(r);
    if (!run_open_probes(r) || !run_open_momentum(r) ||
        !run_open_table(r, &r->steps, "steps.csv", STEP_HEADER, STEP_COLUMNS, 0) ||
        !trace_open(r)) {
        if (r->options.resume) resume_say_anew(r);
        ranks_exit(CLI_USAGE);
    }
    if (r->options.resume) resume_tables(r);
}

/* Search neighbours as the first step does it. What is measured before it then has that order as well, on any number of ranks. A failure
 * comes again in the step. */
static void run_order(const run *r)
{
    mps_stencil near;
    mps_stencil_init(&near, sizeof near);
    if (!r->options.resume) mps_stencil_get(r->sim, MPS_NEAR, &near);
}

void run_first_rows(run *r)
{
    run_order(r);
    run_measure(r, r->totals.t, r->start);
    if (r->options.resume && ranks_first()) table_sample(&r->probes, r->start);
    run_momentum(r, r->totals.t);
    if (r->trace && !r->options.resume) trace_step(r, 0, 0);
}

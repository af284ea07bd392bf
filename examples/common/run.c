/* SPDX-License-Identifier: BSD-3-Clause */
/* Opening a run. Its columns are in columns.c. Stepping is in stepping.c, what comes after the last step in summary.c and report.c. */
#include "run.h"
#include "folder.h"
#include "view.h"
#include "ranks.h"
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RUN_MESSAGES = 20 }; /* of the library, before it is cut short */

/* The library's warning of a short average, in the words of the command line. Of a driver that chose the average itself it says nothing.
 * @return false: another message */
static bool run_log_average(run *r, const char *text)
{
    double t, average, crossing;
    char name[32];
    const char *rest = strstr(text, "' averages over ");
    if (!rest || sscanf(text, "t = %lf s: probe %*d '%31[^']", &t, name) != 2 ||
        sscanf(rest, "' averages over %lf s; liquid crosses a spacing in %lf s", &average,
               &crossing) != 2)
        return false;
    if (!r->options.average_given) return true;
    progress_clear(&r->progress);
    fprintf(ranks_messages(),
            "%s: warning: t = %.6g s: %s is a mean over %g s; liquid crosses a spacing in %g s, "
            "and pressures of impacts over less than that depend on the time step: "
            "--sensor-average %.2g, or more\n",
            r->options.program, t, name, average, crossing, crossing);
    return true;
}

static void run_log(void *user, int level, const char *text)
{
    run *r = user;
    if (!ranks_first() || r->options.quiet || r->messages > RUN_MESSAGES ||
        run_log_average(r, text))
        return;
    progress_clear(&r->progress);
    if (r->messages++ == RUN_MESSAGES)
        fprintf(ranks_messages(), "%s: further messages are not shown\n", r->options.program);
    else
        fprintf(ranks_messages(), "%s: %s%s\n", r->options.program,
                level >= MPS_LOG_WARNING ? "warning: " : "", text);
}

static void run_refuse(run *r, const char *option, const char *value, const char *why,
                       const char *allowed)
{
    fprintf(ranks_messages(), "%s: %s %s: %s%s\n", r->options.program, option, value, why, allowed);
    ranks_exit(CLI_USAGE);
}

/* "slot.key=value"; the slot may be a full name, so the key begins behind the last dot. @return the library's answer */
static mps_status run_set_model(run *r, const char *text)
{
    char slot[96], *key, *end;
    const char *equals = strchr(text, '=');
    snprintf(slot, sizeof slot, "%.*s", equals ? (int)(equals - text) : (int)strlen(text), text);
    key = strrchr(slot, '.');
    double value = equals ? strtod(equals + 1, &end) : 0;
    if (!equals || !key || end == equals + 1 || *end)
        run_refuse(r, "--set", text, "must be slot.key=number", "");
    *key++ = '\0';
    return mps_model_set(r->sim, slot, key, value);
}

static bool run_has_model(const run *r, const char *slot)
{
    const char *name;
    for (int32_t i = 0; (name = mps_model_name(r->sim, i)) != NULL; i++)
        if (strncmp(name, slot, strlen(slot)) == 0 && name[strlen(slot)] == '.') return true;
    return false;
}

/* What the case cannot do without, and what it must not have. */
static void run_suit_models(run *r)
{
    const cli_options *o = &r->options;
    char slot[48];
    if (o->no_gas && run_has_model(r, "gas"))
        run_check(r, mps_model_remove(r->sim, "gas"), "models");
    if (o->gravity == 0 && run_has_model(r, "reference"))
        run_check(r, mps_model_remove(r->sim, "reference"), "models"); /* it asks where up is */
    else if (o->no_gas)
        run_check(r, mps_model_use(r->sim, "reference.lid"),
                  "models"); /* p = 0 atop the gas, as in the papers, is within the tank */
    if (!o->need || !(o->both_phases || run_has_gas(r))) return;
    snprintf(slot, sizeof slot, "%.*s", (int)strcspn(o->need, "."), o->need);
    if (!run_has_model(r, slot)) run_check(r, mps_model_use(r->sim, o->need), "models");
}

/* The case's surface tension, which --set may change again. */
static void run_set_tension(run *r)
{
    const cli_options *o = &r->options;
    if (run_has_model(r, "tension"))
        run_check(r, mps_model_set(r->sim, "tension", "sigma", o->sigma), "surface tension");
    else if (o->sigma_given)
        run_refuse(r, "--sigma with --model", o->model, "has no surface tension",
                   "; --use tension.csf adds it");
}

static void run_use_models(run *r)
{
    const cli_options *o = &r->options;
    if (mps_preset_use(r->sim, o->model) != MPS_OK)
        run_refuse(r, "--model", o->model, mps_sim_error(r->sim), "");
    if (run_has_gas(r) && !o->two_phases)
        run_refuse(r, "--model", o->model, "is for two phases, this case has one",
                   "; there are imps, imps.paper");
    run_suit_models(r);
    for (int i = 0; i < o->use.count; i++)
        if (mps_model_use(r->sim, o->use.text[i]) != MPS_OK)
            run_refuse(r, "--use", o->use.text[i], mps_sim_error(r->sim), "");
    for (int i = 0; i < o->remove.count; i++)
        if (mps_model_remove(r->sim, o->remove.text[i]) != MPS_OK)
            run_refuse(r, "--remove", o->remove.text[i], mps_sim_error(r->sim), "");
    run_set_tension(r);
    if (o->prefer) run_set_model(r, o->prefer);
    for (int i = 0; i < o->set.count; i++)
        if (run_set_model(r, o->set.text[i]) != MPS_OK)
            run_refuse(r, "--set", o->set.text[i], mps_sim_error(r->sim), "");
}

static void run_use_solver(run *r)
{
    const char *text = r->options.solver, *slash = strchr(text, '/');
    char solver[64];
    snprintf(solver, sizeof solver, "%.*s", slash ? (int)(slash - text) : (int)strlen(text), text);
    if (mps_solver_use(r->sim, solver, slash ? slash + 1 : NULL) != MPS_OK)
        run_refuse(r, "--solver", text, mps_sim_error(r->sim),
                   slash ? "" : "; a preconditioner stands behind a /: sundials.pcg/ic0");
}

/* To the letter of the papers. */
static bool run_is_paper(const cli_options *o)
{
    size_t length = strlen(o->model);
    return length > 6 && strcmp(o->model + length - 6, ".paper") == 0;
}

static void run_set_time(run *r)
{
    mps_time_control control;
    mps_time_control_init(&control, sizeof control);
    control.dt = r->options.dt;
    control.cfl = r->options.cfl;
    if (run_is_paper(&r->options))
        control.gravity = 0.03; /* W22's steps are 0.01; at 0.06 it fails even sooner */
    if (r->options.calm > 0) control.gravity = r->options.calm;
    run_check(r, mps_time_control_set(r->sim, &control), "time step");
}

void run_open(run *r, const cli_options *o)
{
    char error[RUN_ERROR] = "";
    mps_config config;
    *r = (run){.options = *o};
    signal(SIGPIPE, SIG_IGN); /* a reader of stderr that goes away does not end the run */
    r->options.quiet = o->quiet || !ranks_first();
    if (ranks_first()) folder_open(o);
    ranks_most(0); /* where rank 0 refuses the folder, all exit */
    mps_config_init(&config, sizeof config);
    config.dim = o->dim;
    config.dp = o->dp;
    config.threads = o->threads;
    config.gravity[1] = -o->gravity;
    config.velocity_scale = o->velocity_scale;
    if (run_is_paper(o) && o->dim == 2) config.re_far = 4.1; /* W22; in 3-D no paper says */
    if (o->re_far > 0) config.re_far = o->re_far;
    config.log = run_log;
    config.log_user = r;
    config.error = error;
    config.error_size = sizeof error;
    mps_status status = mps_sim_create(&config, &r->sim);
    if (status != MPS_OK) {
        fprintf(ranks_messages(), "%s: %s: %s\n", o->program, mps_status_name(status), error);
        ranks_exit(status == MPS_E_ARG ? CLI_USAGE : CLI_FAILED);
    }
    run_check(r, ranks_attach(r->sim), "--mpi");
    run_use_models(r);
    run_use_solver(r);
    run_set_time(r);
}

void run_check(run *r, mps_status status, const char *what)
{
    if (status >= 0) return;
    fprintf(ranks_messages(), "%s: %s: %s: %s\n", r->options.program, what, mps_status_name(status),
            mps_sim_error(r->sim));
    /* the geometry is fixed: what does not fit is an option, mostly --dp */
    ranks_exit(status == MPS_E_ARG ? CLI_USAGE : CLI_FAILED);
}

bool run_has_gas(const run *r)
{
    return strncmp(r->options.model, "mmps", 4) == 0;
}

void run_phase(run *r, int32_t index, double density, double viscosity)
{
    mps_phase phase;
    mps_phase_init(&phase, sizeof phase);
    phase.density = density;
    phase.viscosity = viscosity;
    run_check(r, mps_phase_set(r->sim, index, &phase), "phase");
}

double run_level(run *r)
{
    view v;
    double level = -INFINITY;
    if (r->level > 0) return r->level;
    run_check(r, view_open(r->sim, &v) ? MPS_OK : MPS_E_BUSY, "still level");
    for (int64_t i = 0; i < v.x.count; i++)
        if (v.kind.integers[i] == MPS_FLUID && v.phase.integers[i] == 0)
            level = fmax(level, v.x.data[i * v.x.stride + 1]);
    run_check(r, view_close(r->sim, &v) ? MPS_OK : MPS_E_BUSY, "still level");
    return level;
}

void run_figure_add(run *r, const char *name, const char *about, run_value_fn value, void *user)
{
    if (r->figures == RUN_FIGURES) return;
    run_figure *f = &r->figure[r->figures++];
    *f = (run_figure){.name = name, .value = value, .user = user};
    snprintf(f->about, sizeof f->about, "%s", about);
}

void run_particle_figure(run *r, const char *name, const char *about, run_value_fn value,
                         void *user)
{
    const int before = r->figures;
    run_figure_add(r, name, about, value, user);
    if (r->figures > before) r->figure[before].particles = true;
}

void run_mark_add(run *r, const char *label, const char *unit, int count, const double *t,
                  const double *value)
{
    if (r->marks == RUN_MARKS || count > RUN_MARK_POINTS) return;
    run_mark *m = &r->mark[r->marks++];
    *m = (run_mark){.label = label, .unit = unit, .count = count};
    memcpy(m->t, t, (size_t)count * sizeof *t);
    memcpy(m->value, value, (size_t)count * sizeof *value);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Set up a simulation and its job from the options: models, solver, time step, columns. */
#include "driver.h"
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

/* ---- models ---- */

/* "slot.key=value"; the slot may be a full name, so the key begins after the last dot. @return
 * status of the library */
static mps_status set_model(driver *d, const char *text)
{
    char slot[96], *key, *end;
    const char *equals = strchr(text, '=');
    snprintf(slot, sizeof slot, "%.*s", equals ? (int)(equals - text) : (int)strlen(text), text);
    key = strrchr(slot, '.');
    double value = equals ? strtod(equals + 1, &end) : 0;
    if (!equals || !key || end == equals + 1 || *end)
        driver_exit(d, MPS_EXIT_USAGE, "--set %s: must be slot.key=number", text);
    *key++ = '\0';
    return mps_model_set(d->sim, slot, key, value);
}

static bool has_model(const driver *d, const char *slot)
{
    const char *name;
    for (int32_t i = 0; (name = mps_model_name(d->sim, i)) != NULL; i++)
        if (strncmp(name, slot, strlen(slot)) == 0 && name[strlen(slot)] == '.') return true;
    return false;
}

/* Models that the case needs, and models that it must not have. */
static void suit_models(driver *d)
{
    char slot[48];
    if (d->no_gas && has_model(d, "gas"))
        driver_check(d, mps_model_remove(d->sim, "gas"), "models");
    if (d->no_gas)
        driver_check(d, mps_model_use(d->sim, "reference.lid"),
                     "models"); /* p = 0 at the top of the gas, as in the papers, is inside the
                                   tank */
    if (!d->need || !(d->both_phases || driver_has_gas(d))) return;
    snprintf(slot, sizeof slot, "%.*s", (int)strcspn(d->need, "."), d->need);
    if (!has_model(d, slot)) driver_check(d, mps_model_use(d->sim, d->need), "models");
}

/* Surface tension of the case, which --set may change. */
static void set_tension(driver *d)
{
    if (has_model(d, "tension"))
        driver_check(d, mps_model_set(d->sim, "tension", "sigma", d->sigma), "surface tension");
    else if (d->sigma_given)
        driver_exit(d, MPS_EXIT_USAGE,
                    "--sigma with --model %s: has no surface tension; --use tension.csf adds it",
                    d->model);
}

/* Call a function for each text of an option. */
static void use_each(driver *d, const char *name, const option_list *list,
                     mps_status (*use)(driver *d, const char *text))
{
    for (int i = 0; i < list->count; i++)
        if (use(d, list->text[i]) != MPS_OK)
            driver_exit(d, MPS_EXIT_USAGE, "%s %s: %s", name, list->text[i], mps_sim_error(d->sim));
}

static mps_status use_model(driver *d, const char *text)
{
    return mps_model_use(d->sim, text);
}

static mps_status remove_model(driver *d, const char *text)
{
    return mps_model_remove(d->sim, text);
}

static void use_models(driver *d)
{
    if (mps_preset_use(d->sim, d->model) != MPS_OK)
        driver_exit(d, MPS_EXIT_USAGE, "--model %s: %s", d->model, mps_sim_error(d->sim));
    if (driver_has_gas(d) && !d->two_phases)
        driver_exit(d, MPS_EXIT_USAGE,
                    "--model %s: is for two phases, this case has one; there are imps, imps.paper",
                    d->model);
    suit_models(d);
    use_each(d, "--use", &d->use, use_model);
    use_each(d, "--remove", &d->remove, remove_model);
    set_tension(d);
    use_each(d, "--set", &d->set, set_model);
}

static void use_solver(driver *d)
{
    const char *text = d->solver, *slash = strchr(text, '/');
    char solver[64];
    snprintf(solver, sizeof solver, "%.*s", slash ? (int)(slash - text) : (int)strlen(text), text);
    if (mps_solver_use(d->sim, solver, slash ? slash + 1 : NULL) != MPS_OK)
        driver_exit(d, MPS_EXIT_USAGE, "--solver %s: %s%s", text, mps_sim_error(d->sim),
                    slash ? "" : "; a preconditioner stands behind a /: sundials.pcg/ic0");
}

/* ---- opening ---- */

/* Models literally as in the papers. */
static bool is_paper(const driver *d)
{
    size_t length = strlen(d->model);
    return length > 6 && strcmp(d->model + length - 6, ".paper") == 0;
}

static void set_time(driver *d)
{
    mps_time_control control;
    char text[32];
    mps_time_control_init(&control, sizeof control);
    control.dt = d->dt;
    control.cfl = d->cfl;
    if (is_paper(d))
        control.gravity = 0.03; /* steps of W22 (Wen, Zhao & Wan 2022) are 0.01; at 0.06 it fails
                                   even earlier */
    if (d->calm > 0) control.gravity = d->calm;
    driver_check(d, mps_time_control_set(d->sim, &control), "time step");
    snprintf(text, sizeof text, d->dt > 0 ? "%.6g s" : "%.6g", d->dt > 0 ? d->dt : d->cfl);
    driver_check_job(
        d, mps_job_input_add(
               d->job, d->dt > 0 ? "time step, fixed" : "time step: largest dt u / dp", text));
}

/* Translate the library's warning of a short average to options of the command line. Suppress it if
 * the driver set the average. @return false: another message */
static bool log_average(driver *d, const char *text)
{
    double t, average, crossing;
    int probe;
    char name[32] = "", line[400];
    const char *rest = strstr(text, " averages over ");
    if (!rest || sscanf(text, "t = %lf s: probe %d '%31[^']", &t, &probe, name) < 2 ||
        sscanf(rest, " averages over %lf s; liquid crosses a spacing in %lf s", &average,
               &crossing) != 2)
        return false;
    if (!name[0]) snprintf(name, sizeof name, "probe %d", probe);
    snprintf(line, sizeof line,
             "warning: t = %.6g s: %s is a mean over %g s; liquid crosses a spacing in %g s, and "
             "pressures of impacts over less than that depend on the time step: --sensor-average "
             "%.2g, or more",
             t, name, average, crossing, crossing);
    if (d->average_given) mps_job_print(d->job, line);
    return true;
}

static void log_message(void *user, int level, const char *text)
{
    driver *d = user;
    if (!log_average(d, text)) mps_job_log(d->job, level, text);
}

static void open_job(driver *d)
{
    char error[1000] = "";
    mps_job_config c;
    mps_job_config_init(&c, sizeof c);
    c.name = d->program;
    c.title = d->about;
    c.command = d->command;
    c.model = d->model;
    c.folder = d->out;
    c.t_end = d->t_end;
    c.row_interval = d->probe_dt;
    c.checkpoint = d->checkpoint;
    c.gravity = d->gravity;
    c.dp = d->dp;
    c.average = d->sensor_average;
    c.frames = d->frames;
    c.picture_count = d->pictures.count;
    c.picture_t = d->pictures.t;
    c.resume = d->resume;
    c.overwrite = d->overwrite;
    c.pieces = d->pieces;
    c.tank_frame = d->tank_frame;
    c.report = d->report;
    c.profile = d->profile;
    c.quiet = d->quiet;
    c.signals = 1;
    c.threads = d->threads;
    c.device = d->device;
    c.ranks = d->mpi ? &d->ranks : NULL;
    c.error = error;
    c.error_size = sizeof error;
    const mps_status status = mps_job_create(&c, &d->job);
    if (status != MPS_OK) /* on all ranks: rank 0 has created the folder */
        driver_exit(d, status == MPS_E_NOMEM ? MPS_EXIT_FAILED : MPS_EXIT_USAGE, "%s", error);
}

void driver_open(driver *d)
{
    char error[640] = "";
    mps_config config;
    signal(SIGPIPE, SIG_IGN); /* the run continues if the reader of stderr ends */
    open_job(d);
    mps_config_init(&config, sizeof config);
    config.dim = d->dim;
    config.dp = d->dp;
    config.threads = d->threads;
    config.gravity[1] = -d->gravity;
    config.velocity_scale = d->velocity_scale;
    if (is_paper(d) && d->dim == 2) config.re_far = 4.1; /* W22; the papers give no value in 3-D */
    if (d->re_far > 0) config.re_far = d->re_far;
    config.log = log_message;
    config.log_user = d;
    config.error = error;
    config.error_size = sizeof error;
    const mps_status status = mps_sim_create(&config, &d->sim);
    if (status != MPS_OK)
        driver_exit(d, status == MPS_E_ARG ? MPS_EXIT_USAGE : MPS_EXIT_FAILED, "%s: %s",
                    mps_status_name(status), error);
    if (d->mpi) driver_check(d, d->ranks.attach(d->ranks.user, d->sim), "--mpi");
    use_models(d);
    use_solver(d);
    set_time(d);
}

/* ---- building ---- */

bool driver_has_gas(const driver *d)
{
    return strncmp(d->model, "mmps", 4) == 0;
}

void driver_phase(driver *d, int32_t index, double density, double viscosity)
{
    mps_phase phase;
    mps_phase_init(&phase, sizeof phase);
    phase.density = density;
    phase.viscosity = viscosity;
    driver_check(d, mps_phase_set(d->sim, index, &phase), "phase");
}

double driver_top(driver *d)
{
    mps_lease x = {.struct_size = sizeof x}, kind = {.struct_size = sizeof kind},
              phase = {.struct_size = sizeof phase};
    double top = -INFINITY;
    driver_check(d, mps_lease_begin(d->sim, "position", MPS_READ, &x), "still level");
    driver_check(d, mps_lease_begin(d->sim, "kind", MPS_READ, &kind), "still level");
    driver_check(d, mps_lease_begin(d->sim, "phase", MPS_READ, &phase), "still level");
    for (int64_t i = 0; i < x.count; i++)
        if (kind.integers[i] == MPS_FLUID && phase.integers[i] == 0)
            top = fmax(top, x.data[i * x.stride + 1]);
    driver_check(d, mps_lease_end(d->sim, &phase), "still level");
    driver_check(d, mps_lease_end(d->sim, &kind), "still level");
    driver_check(d, mps_lease_end(d->sim, &x), "still level");
    return top;
}

/* ---- columns ---- */

static mps_probe probe_of(int32_t type, const double *at)
{
    mps_probe probe;
    mps_probe_init(&probe, sizeof probe);
    probe.type = type;
    memcpy(probe.at, at, sizeof probe.at);
    return probe;
}

void driver_wall(driver *d, const char *name, double x, double y, double z, double diameter)
{
    mps_probe probe = probe_of(MPS_PROBE_WALL_PRESSURE, (const double[]){x, y, z});
    probe.diameter = diameter;
    probe.average = d->sensor_average;
    driver_check_job(d, mps_job_probe_add(d->job, d->sim, &probe, 0, 0, name, NULL));
}

void driver_gauge_from(driver *d, const char *name, const double *foot, double level)
{
    const mps_probe probe = probe_of(MPS_PROBE_GAUGE, foot);
    driver_check_job(d, mps_job_probe_add(d->job, d->sim, &probe, 0, level - foot[1], name, NULL));
}

void driver_gauge(driver *d, const char *name, double x, double z, double level)
{
    driver_gauge_from(d, name, (const double[]){x, 0, z}, level);
}

void driver_force(driver *d, const char *name, const char *part, int32_t component)
{
    mps_probe probe = probe_of(MPS_PROBE_FORCE, (const double[3]){0});
    probe.part = part;
    probe.average = d->sensor_average;
    driver_check_job(d, mps_job_probe_add(d->job, d->sim, &probe, component, 0, name, NULL));
}

void driver_value(driver *d, const char *name, const char *unit, const char *about, int32_t flags,
                  mps_job_value_fn value, void *user)
{
    driver_check_job(d, mps_job_value_add(d->job, name, unit, about, flags, value, user));
}

mps_measure driver_measure_of(const char *measure, const char *name, const char *about)
{
    mps_measure m;
    mps_measure_init(&m, sizeof m);
    m.measure = measure;
    m.name = name;
    m.about = about;
    return m;
}

void driver_measure(driver *d, mps_measure measure)
{
    driver_check_job(d, mps_job_measure_add(d->job, d->sim, &measure));
}

void driver_marks(driver *d, const char *label, const char *unit, int count, const double *t,
                  const double *value)
{
    mps_reference r;
    mps_reference_init(&r, sizeof r);
    r.label = label;
    r.unit = unit;
    r.count = count;
    r.t = t;
    r.value = value;
    driver_check_job(d, mps_job_reference_add(d->job, &r));
}

int driver_run(driver *d)
{
    const int code = mps_job_run(d->job, d->sim);
    driver_finish(d);
    return code;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* A tank of an importer: creation, values, steps. */
#include "adapter.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT_SIZE = 8192 };

fmu_status fmu_log(const fmu *f, fmu_status status, const char *format, ...)
{
    char text[TEXT_SIZE];
    va_list values;
    va_start(values, format);
    vsnprintf(text, sizeof text, format, values);
    va_end(values);
    for (size_t n = strlen(text); n > 0 && text[n - 1] == '\n'; n--) text[n - 1] = '\0';
    f->print(f->user, status, text);
    return status;
}

fmu_status fmu_refused(fmu *f, fmu_status status, const char *call)
{
    return fmu_log(f, status, "%s: %s", call, mps_sim_error(f->model.sim));
}

/* Forwards log messages of the library. */
static void log_text(void *user, int32_t kind, const char *text)
{
    const fmu *f = user;
    if (f->chatty && kind == MPS_JOB_MESSAGE) fmu_log(f, FMU_OK, "%s", text);
}

/* ---- creation and release ---- */

static int still(void *user, double t, mps_motion_state *state)
{
    (void)t;
    *state = *(const mps_motion_state *)user;
    return 0;
}

mps_status fmu_hold(fmu *f)
{
    return mps_motion_callback_set(f->model.sim, still, &f->hold);
}

static bool open_case(fmu *f, const char *resources, const char *token)
{
    char path[2048], error[TEXT_SIZE] = "";
    mps_case *c = NULL;
    const size_t length = strlen(resources);
    snprintf(path, sizeof path, "%s%scase.yaml", resources,
             length > 0 && resources[length - 1] == '/' ? "" : "/");
    const mps_status status = mps_case_read(path, 0, NULL, &c);
    if (status != MPS_OK) {
        if (c) mps_case_messages_write(c, error, sizeof error);
        fmu_log(f, FMU_ERROR, "%s", c ? error : mps_status_text(status));
        mps_case_destroy(c);
        return false;
    }
    fmu_token(mps_case_text(c), f->token);
    if (!token || strcmp(token, f->token) != 0) {
        fmu_log(f, FMU_ERROR,
                "the token of the model description is %s, that of %s with libmps %s is %s: make "
                "the FMU again by 'mps fmu'",
                token ? token : "missing", path, mps_version(NULL, NULL, NULL), f->token);
        mps_case_destroy(c);
        return false;
    }
    if (fmu_model_open(&f->model, c, log_text, f, error, sizeof error)) return true;
    fmu_log(f, FMU_ERROR, "%s", error);
    return false;
}

static void begin_values(fmu *f)
{
    f->v = (fmu_values){.mode = FMU_INSTANTIATED};
}

fmu *fmu_create(const char *resources, const char *token, bool chatty, fmu_log_fn print, void *user)
{
    fmu *f = calloc(1, sizeof *f);
    if (!f) {
        print(user, FMU_ERROR, "no memory");
        return NULL;
    }
    f->print = print;
    f->user = user;
    f->chatty = chatty;
    mps_motion_state_init(&f->hold, sizeof f->hold);
    begin_values(f);
    if (!open_case(f, resources ? resources : "", token)) {
        fmu_destroy(f);
        return NULL;
    }
    mps_sim *sim = f->model.sim;
    if (mps_load_watch(sim, MPS_LOAD_MASS) == MPS_OK &&
        mps_snapshot_create(sim, &f->origin) == MPS_OK &&
        mps_snapshot_create(sim, &f->before) == MPS_OK && mps_snapshot_take(f->origin) == MPS_OK)
        return f;
    fmu_refused(f, FMU_ERROR, "instantiate");
    fmu_destroy(f);
    return NULL;
}

void fmu_destroy(fmu *f)
{
    if (!f) return;
    while (f->states) fmu_state_free(f, f->states);
    mps_snapshot_destroy(f->origin);
    mps_snapshot_destroy(f->before);
    fmu_model_close(&f->model);
    free(f);
}

static fmu_status expect(const fmu *f, fmu_mode mode, const char *call)
{
    static const char *const name[] = {"instantiated", "initialising", "stepping", "terminated"};
    if (f->v.mode == (int32_t)mode) return FMU_OK;
    return fmu_log(f, FMU_ERROR, "%s: not allowed now: the instance is %s, it must be %s", call,
                   name[f->v.mode], name[mode]);
}

fmu_status fmu_initialise(fmu *f, double start)
{
    if (expect(f, FMU_INSTANTIATED, "initialise") != FMU_OK) return FMU_ERROR;
    if (!isfinite(start)) return fmu_log(f, FMU_ERROR, "initialise: the start time is not finite");
    f->v.start = f->v.time = start;
    f->v.mode = FMU_INITIALISING;
    return FMU_OK;
}

static void inputs_to(const fmu *f, mps_motion_state *state)
{
    mps_motion_state_init(state, sizeof *state);
    memcpy(state->value, f->v.input[0], sizeof state->value);
    memcpy(state->rate, f->v.input[1], sizeof state->rate);
    memcpy(state->accel, f->v.input[2], sizeof state->accel);
}

fmu_status fmu_begin(fmu *f)
{
    if (expect(f, FMU_INITIALISING, "begin") != FMU_OK) return FMU_ERROR;
    inputs_to(f, &f->hold);
    if (fmu_hold(f) != MPS_OK) return fmu_refused(f, FMU_ERROR, "begin");
    f->v.mode = FMU_STEPPING;
    return FMU_OK;
}

fmu_status fmu_terminate(fmu *f)
{
    f->v.mode = FMU_TERMINATED;
    return FMU_OK;
}

fmu_status fmu_reset(fmu *f)
{
    if (mps_snapshot_restore(f->origin) != MPS_OK) return fmu_refused(f, FMU_ERROR, "reset");
    begin_values(f);
    return FMU_OK;
}

/* ---- values ---- */

static fmu_status find(const fmu *f, const char *call, uint32_t reference, fmu_variable *v)
{
    if (fmu_variable_of(&f->model, reference, v)) return FMU_OK;
    return fmu_log(f, FMU_ERROR, "%s: there is no variable with the value reference %u", call,
                   (unsigned)reference);
}

fmu_status fmu_set(fmu *f, const uint32_t *reference, size_t count, const double *value)
{
    fmu_variable v;
    if (f->v.mode == FMU_TERMINATED) return expect(f, FMU_STEPPING, "set");
    for (size_t k = 0; k < count; k++) {
        if (find(f, "set", reference[k], &v) != FMU_OK) return FMU_ERROR;
        if (!v.input) return fmu_log(f, FMU_ERROR, "set: '%s' is no input", v.name);
        if (!isfinite(value[k]))
            return fmu_log(f, FMU_ERROR, "set: '%s' is %g %s: must be finite", v.name, value[k],
                           v.unit);
    }
    for (size_t k = 0; k < count; k++)
        if (fmu_variable_of(&f->model, reference[k], &v))
            f->v.input[v.kind - FMU_POSE][v.dof] = value[k];
    return FMU_OK;
}

/* Pressures are 0 before the first step, as loads are. */
static fmu_status read_sensor(fmu *f, const fmu_variable *v, double *value)
{
    int64_t steps = 0;
    mps_sim_time(f->model.sim, NULL, &steps);
    *value = 0;
    if (v->later && steps == 0) return FMU_OK;
    if (mps_job_column_read(f->model.job, f->model.sim, v->dof, value) == MPS_OK) return FMU_OK;
    return fmu_log(f, FMU_ERROR, "get: %s", mps_job_error(f->model.job));
}

fmu_status fmu_get(fmu *f, const uint32_t *reference, size_t count, double *value)
{
    fmu_variable v;
    for (size_t k = 0; k < count; k++) {
        if (find(f, "get", reference[k], &v) != FMU_OK) return FMU_ERROR;
        if (v.kind == FMU_SENSOR) {
            if (read_sensor(f, &v, &value[k]) != FMU_OK) return FMU_ERROR;
            continue;
        }
        value[k] = v.input              ? f->v.input[v.kind - FMU_POSE][v.dof]
                   : v.kind == FMU_LOAD ? f->v.load[v.dof]
                   : v.kind == FMU_REST ? f->v.rest[v.dof]
                                        : f->v.time;
    }
    return FMU_OK;
}

/* ---- steps ---- */

/* Sums over the steps of the library in one step of the importer, each weighted by its length. */
typedef struct sums {
    double length, load[MPS_DOF_COUNT], rest[MPS_DOF_COUNT], mass[MPS_DOF_COUNT * MPS_DOF_COUNT];
    const double *kept; /* the previous added mass, for steps without their own; NULL: none */
    int32_t without;    /* number of such steps */
    mps_status failed;
} sums;

static int add_step(void *user, mps_sim *sim, const mps_step_info *info)
{
    sums *s = user;
    mps_load load;
    (void)info;
    mps_load_init(&load, sizeof load);
    s->failed = mps_load_get(sim, NULL, &load);
    if (s->failed != MPS_OK) return 1;
    s->without += !load.has_mass;
    s->length += load.dt;
    for (int32_t i = 0; i < MPS_DOF_COUNT; i++) {
        double rest = load.has_mass ? load.rest[i] : load.force[i];
        for (int32_t k = 0; k < MPS_DOF_COUNT; k++) {
            const int32_t at = i * MPS_DOF_COUNT + k;
            const double mass = load.has_mass ? load.mass[at] : s->kept ? s->kept[at] : 0;
            if (!load.has_mass) rest += mass * load.acceleration[k];
            s->mass[at] += load.dt * mass;
        }
        s->load[i] += load.dt * load.force[i];
        s->rest[i] += load.dt * rest;
    }
    return 0;
}

/* A mean over one step is bitwise equal to its value. */
static double mean(double sum, double first, bool one)
{
    return one ? first : sum;
}

static void take_means(fmu *f, const sums *s)
{
    mps_load last;
    mps_load_init(&last, sizeof last);
    const bool one = mps_load_get(f->model.sim, NULL, &last) == MPS_OK && last.dt == s->length &&
                     s->without == 0;
    for (int32_t i = 0; i < MPS_DOF_COUNT; i++) {
        f->v.load[i] = mean(s->load[i] / s->length, last.force[i], one);
        f->v.rest[i] = mean(s->rest[i] / s->length, last.rest[i], one);
    }
    for (int32_t i = 0; i < MPS_DOF_COUNT * MPS_DOF_COUNT; i++)
        f->v.mass[i] = mean(s->mass[i] / s->length, last.mass[i], one);
    f->v.has_mass = s->without == 0 || s->kept;
}

/* Rounding tolerance of times, as in mps_run(): a step not longer than it is none. */
static double rounding_of(double t)
{
    return 1e-12 * fmax(1, fabs(t));
}

static fmu_status run(fmu *f, double t_end)
{
    mps_motion_state state;
    sums s = {.kept = f->v.has_mass ? f->v.mass : NULL};
    mps_sim *sim = f->model.sim;
    double t = 0;
    mps_sim_time(sim, &t, NULL);
    if (fabs(t_end - t) <= rounding_of(t_end)) { /* loads stay those of the last step */
        if (mps_run(sim, t_end, NULL, NULL) == MPS_OK) return FMU_OK;
        return fmu_refused(f, FMU_ERROR, "step");
    }
    inputs_to(f, &state);
    if (mps_motion_pose_set(sim, t_end, &state) != MPS_OK) return fmu_refused(f, FMU_ERROR, "step");
    const mps_status status = mps_run(sim, t_end, add_step, &s);
    if (status < 0 || s.failed < 0) {
        const bool shorter = status == MPS_E_DIVERGED || status == MPS_E_LOST ||
                             status == MPS_E_SOLVER || status == MPS_E_PLUGIN;
        fmu_refused(f, shorter ? FMU_DISCARD : FMU_ERROR, "step");
        if (mps_snapshot_restore(f->before) != MPS_OK)
            return fmu_refused(f, FMU_ERROR, "step, going back");
        return shorter ? FMU_DISCARD : FMU_ERROR;
    }
    take_means(f, &s);
    if (s.without > 0)
        fmu_log(f, FMU_WARNING,
                "step: the added mass of %d steps is not known, that before is "
                "kept",
                (int)s.without);
    return s.without > 0 ? FMU_WARNING : FMU_OK;
}

fmu_status fmu_step(fmu *f, double time, double length)
{
    if (expect(f, FMU_STEPPING, "step") != FMU_OK) return FMU_ERROR;
    if (!isfinite(time) || !isfinite(length) || !(length > 0))
        return fmu_log(f, FMU_ERROR, "step: from %g s, %g s long: must be finite and > 0", time,
                       length);
    if (fabs(time - f->v.time) > fmax(1e-6 * length, rounding_of(time)))
        return fmu_log(f, FMU_ERROR,
                       "step: begins at %.10g s, but the tank is at %.10g s: restore a state to "
                       "go back",
                       time, f->v.time);
    if (mps_snapshot_take(f->before) != MPS_OK) return fmu_refused(f, FMU_ERROR, "step");
    const fmu_status status = run(f, time + length - f->v.start);
    if (status <= FMU_WARNING) f->v.time = time + length;
    return status;
}

/* ---- derivatives ---- */

/* dF_i/d(second derivative of degree of freedom k) = -sum_m A_im T_mk. Angles rotate about y, then
 * z, then x: column k of T is the axis of angle k. */
static double slope(const fmu *f, int32_t i, int32_t k)
{
    const double *a = &f->v.mass[i * MPS_DOF_COUNT], *q = f->v.input[0];
    const double cb = cos(q[MPS_ROTATE_Y]), sb = sin(q[MPS_ROTATE_Y]), cg = cos(q[MPS_ROTATE_Z]),
                 sg = sin(q[MPS_ROTATE_Z]);
    const double axis[3][3] = {{cb * cg, sg, -sb * cg}, {0, 1, 0}, {sb, 0, cb}};
    if (k < MPS_ROTATE_X) return -a[k];
    const double *e = axis[k - MPS_ROTATE_X];
    return -(a[MPS_ROTATE_X] * e[0] + a[MPS_ROTATE_Y] * e[1] + a[MPS_ROTATE_Z] * e[2]);
}

fmu_status fmu_derivative(fmu *f, const fmu_direction *d)
{
    fmu_variable u, v;
    if (!f->v.has_mass) return fmu_log(f, FMU_ERROR, "derivative: is known after the first step");
    for (size_t k = 0; k < d->knowns; k++) {
        if (find(f, "derivative", d->known[k], &v) != FMU_OK) return FMU_ERROR;
        if (!v.input) return fmu_log(f, FMU_ERROR, "derivative: '%s' is no input", v.name);
        if (!isfinite(d->seed[k]))
            return fmu_log(f, FMU_ERROR, "derivative: the seed of '%s' is not finite", v.name);
    }
    for (size_t i = 0; i < d->unknowns; i++) {
        if (find(f, "derivative", d->unknown[i], &u) != FMU_OK) return FMU_ERROR;
        if (u.kind < FMU_LOAD)
            return fmu_log(f, FMU_ERROR, "derivative: '%s' is no output", u.name);
        if (u.kind == FMU_SENSOR)
            return fmu_log(f, FMU_DISCARD, "derivative: that of '%s' is not known", u.name);
    }
    for (size_t i = 0; i < d->unknowns; i++) {
        d->out[i] = 0;
        fmu_variable_of(&f->model, d->unknown[i], &u);
        for (size_t k = 0; k < d->knowns && u.kind == FMU_LOAD; k++)
            if (fmu_variable_of(&f->model, d->known[k], &v) && v.kind == FMU_ACCELERATION)
                d->out[i] += slope(f, u.dof, v.dof) * d->seed[k];
    }
    return FMU_OK;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Adding columns of probes.csv and figures of summary.json, and what each one is and where. */
#include "grow.h"
#include "run.h"
#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Append to the description of a column. */
static void about_add(job_column *c, const char *format, ...)
{
    const size_t used = strlen(c->about);
    va_list values;
    va_start(values, format);
    vsnprintf(c->about + used, sizeof c->about - used, format, values);
    va_end(values);
}

/* "(x, y) m", in 3-D "(x, y, z) m". */
static void about_place(const mps_job *job, job_column *c, const double *x)
{
    about_add(c, "(%g, %g", x[0], x[1]);
    if (job->dim == 3) about_add(c, ", %g", x[2]);
    about_add(c, ") m");
}

static void about_average(job_column *c, double average)
{
    if (average == MPS_AVERAGE_AUTO)
        about_add(c, "; mean over the time in which liquid crosses a spacing");
    else if (average > 0)
        about_add(c, "; mean of the last %g s", average);
    else
        about_add(c, "; no mean over time");
}

/* ---- names ---- */

/* Names are used in table headers and file names. */
static bool is_name(const char *name)
{
    const size_t length = name ? strlen(name) : 0;
    if (length == 0 || length >= JOB_NAME) return false;
    for (const char *c = name; *c; c++)
        if (!isalnum((unsigned char)*c) && !strchr("_-.", *c)) return false;
    return true;
}

/* @return MPS_OK: a column or figure may have this name and these texts */
static mps_status check_texts(mps_job *job, const char *what, const char *name, const char *unit,
                              const char *about)
{
    if (job->ran) return mps__job_refuse(job, MPS_E_STATE, "%s '%s': the job has run", what, name);
    if (!is_name(name))
        return mps__job_refuse(job, MPS_E_ARG,
                               "%s '%s': a name has 1 to %d letters, digits, '_', '-' or '.'", what,
                               name ? name : "", JOB_NAME - 1);
    if (!unit || strlen(unit) >= JOB_UNIT || strpbrk(unit, ",\"\\[]\n\r"))
        return mps__job_refuse(job, MPS_E_ARG,
                               "%s '%s': a unit has at most %d characters, no ,\"[]", what, name,
                               JOB_UNIT - 1);
    if (!about || strlen(about) >= JOB_ABOUT)
        return mps__job_refuse(job, MPS_E_ARG, "%s '%s': 'about' has at most %d characters", what,
                               name, JOB_ABOUT - 1);
    return MPS_OK;
}

static job_column *find_column(const mps_job *job, const char *name)
{
    for (int k = 0; k < job->columns; k++)
        if (strcmp(job->column[k].name, name) == 0) return &job->column[k];
    return NULL;
}

static job_column *add_column(mps_job *job, const char *name, const char *unit)
{
    job_column *grown = mps__grown(job->column, job->columns, sizeof *grown);
    if (!grown) {
        mps__job_refuse(job, MPS_E_NOMEM, "out of memory");
        return NULL;
    }
    job->column = grown;
    job_column *c = &grown[job->columns++];
    *c = (job_column){.probe = -1, .type = "value"};
    snprintf(c->name, sizeof c->name, "%s", name);
    snprintf(c->unit, sizeof c->unit, "%s", unit);
    return c;
}

static mps_status check_column(mps_job *job, const char *name, const char *unit, const char *about)
{
    const mps_status status = check_texts(job, "column", name, unit, about);
    if (status != MPS_OK) return status;
    if (find_column(job, name) || mps__job_is_common(name))
        return mps__job_refuse(job, MPS_E_NAME, "column '%s': there is one of this name", name);
    return MPS_OK;
}

/* ---- probes ---- */

/* Component of a probe for the description of its column; moments follow the forces. */
static bool is_moment(int32_t dim, const mps_probe *probe, int32_t component)
{
    return probe->type == MPS_PROBE_FORCE && component >= dim;
}

const char *mps__job_probe_unit(int32_t dim, const mps_probe *probe, int32_t component)
{
    switch (probe->type) {
    case MPS_PROBE_GAUGE:
        return "m";
    case MPS_PROBE_FORCE:
        if (is_moment(dim, probe, component)) return dim == 3 ? "N m" : "N m/m";
        return dim == 3 ? "N" : "N/m";
    default:
        return "Pa";
    }
}

static void about_force(const mps_job *job, job_column *c, const mps_probe *probe)
{
    const bool moment = is_moment(job->dim, probe, c->component);
    const int axis = moment ? job->dim == 3 ? c->component - 3 : 2 : c->component;
    c->type = moment ? "moment" : "force";
    about_add(c,
              moment ? "Moment about %c: of the liquid on " : "Force along %c: of the liquid on ",
              "xyz"[axis]);
    if (probe->part)
        about_add(c, "the part '%s'", probe->part);
    else
        about_add(c, "all solids");
    if (moment) {
        about_add(c, ", about ");
        about_place(job, c, probe->at);
    }
    about_average(c, probe->average);
}

static void about_probe(const mps_job *job, job_column *c, const mps_probe *probe)
{
    c->flags = probe->type == MPS_PROBE_GAUGE ? 0 : MPS_JOB_PRESSURE;
    switch (probe->type) {
    case MPS_PROBE_WALL_PRESSURE:
        c->type = "wall_pressure";
        about_add(c, "Wall pressure: sensor at ");
        about_place(job, c, c->at);
        about_add(c, " on '%s', face %g m wide", c->part, c->diameter);
        about_average(c, probe->average);
        break;
    case MPS_PROBE_FLUID_PRESSURE:
        c->type = "pressure";
        about_add(c, "Pressure in the fluid: at ");
        about_place(job, c, c->at);
        about_average(c, probe->average);
        break;
    case MPS_PROBE_GAUGE:
        c->type = "gauge";
        about_add(c,
                  "Elevation of the surface: above the still level y = %g m, on the line upwards "
                  "from ",
                  c->zero + probe->at[1]);
        about_place(job, c, c->at);
        break;
    default:
        about_force(job, c, probe);
    }
}

static mps_status add_probe(mps_job *job, mps_sim *sim, const mps_probe *probe, const char *name,
                            int32_t *id)
{
    mps_probe named = *probe;
    named.name = name;
    const mps_status status = mps_probe_add(sim, &named, id);
    if (status < 0) return mps__job_refuse(job, status, "%s: %s", name, mps_sim_error(sim));
    return status;
}

mps_status mps_job_probe_add(mps_job *job, mps_sim *sim, const mps_probe *probe, int32_t component,
                             double zero, const char *name, const char *unit)
{
    mps_probe_info info;
    int32_t id;
    if (!job || !sim || !probe) return MPS_E_ARG;
    mps_sim_shape(sim, &job->dim, &job->dp);
    if (!unit) unit = mps__job_probe_unit(job->dim, probe, component);
    mps_status status = check_column(job, name, unit, "");
    if (status != MPS_OK) return status;
    status = add_probe(job, sim, probe, name, &id);
    if (status < 0) return status;
    const int32_t size = mps_probe_size(sim, id);
    mps_probe_info_init(&info, sizeof info);
    mps_probe_info_get(sim, id, &info); /* the id is valid */
    job_column *c = component >= 0 && component < size ? add_column(job, name, unit) : NULL;
    if (!c) {
        mps_probe_remove(sim, id);
        if (component >= 0 && component < size) return MPS_E_NOMEM;
        return mps__job_refuse(job, MPS_E_ARG, "%s: component is %d, must be 0 to %d", name,
                               (int)component, (int)size - 1);
    }
    c->probe = id;
    c->component = component;
    c->zero = zero;
    c->diameter = info.diameter;
    memcpy(c->at, info.at, sizeof c->at);
    memcpy(c->normal, info.normal, sizeof c->normal);
    snprintf(c->part, sizeof c->part, "%s", info.part ? info.part : "");
    about_probe(job, c, probe);
    return MPS_OK;
}

/* ---- quantities ---- */

mps_status mps_job_value_add(mps_job *job, const char *name, const char *unit, const char *about,
                             int32_t flags, mps_job_value_fn value, void *user)
{
    if (!job) return MPS_E_ARG;
    const mps_status status = check_column(job, name, unit, about);
    if (status != MPS_OK) return status;
    if (!value || flags < 0 || flags > (MPS_JOB_PARTICLES | MPS_JOB_PRESSURE | MPS_JOB_MOTION))
        return mps__job_refuse(job, MPS_E_ARG, "column '%s': needs a function, and known flags",
                               name);
    job_column *c = add_column(job, name, unit);
    if (!c) return MPS_E_NOMEM;
    snprintf(c->about, sizeof c->about, "%s", about);
    c->flags = flags;
    if (flags & MPS_JOB_MOTION) c->type = "motion";
    c->value = value;
    c->user = user;
    return MPS_OK;
}

mps_status mps_job_figure_add(mps_job *job, const char *name, const char *about, int32_t flags,
                              mps_job_value_fn value, void *user)
{
    if (!job) return MPS_E_ARG;
    const mps_status status = check_texts(job, "figure", name, "", about);
    if (status != MPS_OK) return status;
    for (int k = 0; k < job->figures; k++)
        if (strcmp(job->figure[k].name, name) == 0)
            return mps__job_refuse(job, MPS_E_NAME, "figure '%s': there is one of this name", name);
    if (!value || flags < 0 || flags > (MPS_JOB_PARTICLES | MPS_JOB_PRESSURE))
        return mps__job_refuse(job, MPS_E_ARG, "figure '%s': needs a function, and known flags",
                               name);
    job_figure *grown = mps__grown(job->figure, job->figures, sizeof *grown);
    if (!grown) return mps__job_refuse(job, MPS_E_NOMEM, "out of memory");
    job->figure = grown;
    job_figure *f = &grown[job->figures++];
    *f = (job_figure){.flags = flags, .value = value, .user = user};
    snprintf(f->name, sizeof f->name, "%s", name);
    snprintf(f->about, sizeof f->about, "%s", about);
    return MPS_OK;
}

/* ---- measures ---- */

static mps_status keep_quantity(mps_job *job, quantity *q)
{
    quantity **grown = mps__grown(job->quantity, job->quantities, sizeof(void *));
    if (!grown) {
        mps__quantity_free(q);
        return mps__job_refuse(job, MPS_E_NOMEM, "out of memory");
    }
    job->quantity = grown;
    grown[job->quantities++] = q;
    return MPS_OK;
}

mps_status mps_job_measure_add(mps_job *job, mps_sim *sim, const mps_measure *measure)
{
    quantity *q;
    char about[JOB_ABOUT], error[QUANTITY_ERROR] = "";
    if (!job || !sim || !measure || measure->struct_size != sizeof *measure) return MPS_E_ARG;
    mps_sim_shape(sim, &job->dim, &job->dp);
    mps_status status = mps__quantity_create(sim, measure, job->config.ranks, &q, error);
    if (status != MPS_OK) return mps__job_refuse(job, status, "%s", error);
    status = keep_quantity(job, q);
    if (status != MPS_OK) return status;
    const measure_kind *kind = q->kind;
    const char *name = measure->name ? measure->name : measure->measure;
    snprintf(about, sizeof about, "%s%.*s", kind->about, kind->by_axis, &"xyz"[measure->axis]);
    const char *text = measure->about ? measure->about : about;
    if (measure->at_end)
        return mps_job_figure_add(job, name, text, kind->flags, mps__quantity_value, q);
    return mps_job_value_add(job, name, job->dim == 3 ? kind->info.unit_3d : kind->info.unit, text,
                             kind->flags, mps__quantity_value, q);
}

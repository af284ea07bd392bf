/* SPDX-License-Identifier: BSD-3-Clause */
/* A job as its program uses it: opening, texts, known points and inputs. Its columns are in
 * columns.c and added.c, stepping is in stepping.c. */
#include "grow.h"
#include "run.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MESSAGES = 20,      /* log messages of the library before truncation */
    PAGE_LEAST = 500000 /* minimum of mps_page_write() */
};

/* ---- texts ---- */

/* Default without a callback of the program: messages to stderr, tables to stdout. */
static void print(mps_job *job, int32_t kind, const char *text)
{
    if (job->config.print) {
        job->config.print(job->config.print_user, kind, text);
        return;
    }
    FILE *out = kind == MPS_JOB_TABLE ? stdout : stderr;
    fputs(text, out);
    if (kind != MPS_JOB_MESSAGE) fflush(out);
}

void mps__job_show(mps_job *job, int32_t kind, const char *text)
{
    const char *clear = kind == MPS_JOB_PROGRESS ? "" : mps__progress_clear(&job->progress);
    if (clear[0]) print(job, MPS_JOB_PROGRESS, clear);
    print(job, kind, text);
}

void mps__job_print(mps_job *job, const char *format, ...)
{
    char text[2 * JOB_ERROR];
    va_list values;
    int used = snprintf(text, sizeof text, "%.200s: ", job->config.name);
    va_start(values, format);
    vsnprintf(text + used, sizeof text - (size_t)used - 1, format, values);
    va_end(values);
    memcpy(text + strlen(text), "\n", 2);
    mps__job_show(job, MPS_JOB_MESSAGE, text);
}

bool mps__job_fail(mps_job *job, int32_t code, const char *format, ...)
{
    va_list values;
    if (job->code) return false;
    job->code = code;
    va_start(values, format);
    vsnprintf(job->error, sizeof job->error, format, values);
    va_end(values);
    return false;
}

mps_status mps__job_refuse(mps_job *job, mps_status status, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    vsnprintf(job->error, sizeof job->error, format, values);
    va_end(values);
    return status;
}

bool mps__job_note(mps_job *job, mps_status status, const char *what)
{
    if (status >= 0) return true;
    job->output_failed = true;
    if (!job->error[0])
        snprintf(job->error, sizeof job->error, "%s: %s", what, mps_sim_error(job->sim));
    return false;
}

const char *mps_job_error(const mps_job *job)
{
    return job ? job->error : "";
}

void mps_job_print(mps_job *job, const char *text)
{
    if (job && text && mps__job_first(job) && !job->config.quiet) mps__job_print(job, "%s", text);
}

void mps_job_log(void *user, int level, const char *text)
{
    mps_job *job = user;
    if (!job || !text || !mps__job_first(job) || job->config.quiet || job->messages > MESSAGES)
        return;
    if (job->messages++ == MESSAGES)
        mps__job_print(job, "further messages are not shown");
    else
        mps__job_print(job, "%s%s", level >= MPS_LOG_WARNING ? "warning: " : "", text);
}

void mps_job_stop(mps_job *job)
{
    if (job) job->stop = 1;
}

/* ---- memory ---- */

char *mps__job_copy(const char *text)
{
    const size_t size = text ? strlen(text) + 1 : 0;
    char *copy = text ? malloc(size) : NULL;
    if (copy) memcpy(copy, text, size);
    return copy;
}

/* ---- opening ---- */

mps_status mps_job_config_init(mps_job_config *config, size_t size)
{
    if (!config || size != sizeof *config) return MPS_E_ARG;
    *config = (mps_job_config){.struct_size = sizeof *config,
                               .row_interval = 1e-3,
                               .gravity = 9.81,
                               .average = MPS_AVERAGE_AUTO,
                               .frames = 50,
                               .peaks = 10,
                               .report = 1,
                               .threads = 1,
                               .page_bytes = 12000000,
                               .checkpoint_clock = 600};
    return MPS_OK;
}

/* @return NULL, or the error */
static const char *check(const mps_job_config *c)
{
    if (!c->name || !c->name[0]) return "name is required";
    if (!c->folder || !c->folder[0]) return "folder is required";
    if (!(c->t_end > 0) || !isfinite(c->t_end)) return "t_end must be > 0";
    if (!(c->row_interval > 0) || !isfinite(c->row_interval)) return "row_interval must be > 0";
    if (!(c->checkpoint >= 0) || !isfinite(c->checkpoint)) return "checkpoint must be >= 0";
    if (!isfinite(c->gravity)) return "gravity must be a number";
    if (!(c->dp >= 0) || !isfinite(c->dp)) return "dp must be >= 0";
    if (c->frames < 0) return "frames must be >= 0";
    if (c->peaks < 0) return "peaks must be >= 0";
    if (c->threads < 1) return "threads must be >= 1";
    if (c->report && c->page_bytes < PAGE_LEAST) return "page_bytes must be >= 500000";
    if (c->picture_count < 0 || (c->picture_count > 0 && !c->picture_t))
        return "picture_count must be >= 0, with as many times at picture_t";
    for (int32_t k = 0; k < c->picture_count; k++)
        if (!(c->picture_t[k] > (k ? c->picture_t[k - 1] : 0)) || !isfinite(c->picture_t[k]))
            return "picture_t must be increasing times greater than 0";
    if (c->ranks && (c->ranks->struct_size != sizeof *c->ranks || c->ranks->count < 1))
        return "ranks must be filled in by mps_job_ranks_load()";
    if (c->device && !mps__job_device_known(c->device))
        return "device must be cuda, or cuda:N with the number N of a GPU";
    if (c->resume && c->overwrite) return "--resume and --overwrite exclude each other";
    return NULL;
}

/* Copy texts and times. @return false: memory is exhausted, mps_job_destroy() is still valid */
static bool copy_config(mps_job *job, const mps_job_config *from)
{
    mps_job_config *c = &job->config;
    *c = *from;
    const char **const texts[] = {&c->name,  &c->title,  &c->command, &c->text,
                                  &c->model, &c->folder, &c->device};
    bool done = true;
    if (!from->title) c->title = from->name;
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        const char *given = *texts[k];
        *texts[k] = mps__job_copy(given);
        done = done && (!given || *texts[k]);
    }
    const size_t bytes = (size_t)from->picture_count * sizeof(double);
    double *times = bytes ? malloc(bytes) : NULL;
    if (times) memcpy(times, from->picture_t, bytes);
    c->picture_t = times;
    /* default: pictures at the quarters of the run */
    job->picture_at = calloc((size_t)from->picture_count + 4, sizeof *job->picture_at);
    return done && (!bytes || times) && job->picture_at;
}

/* Open folder and lock, and broadcast the result to all ranks. */
static mps_status open_folder(mps_job *job)
{
    const mps_job_config *c = &job->config;
    mps_status status = MPS_OK;
    if (mps__job_first(job))
        status = mps__folder_open(&job->place, c->folder, c->resume || c->overwrite, job->error,
                                  sizeof job->error);
    else
        snprintf(job->place.path, sizeof job->place.path, "%s", c->folder); /* path only */
    if (status != MPS_OK) job->code = MPS_EXIT_USAGE;
    return mps__job_agree(job) ? MPS_OK : status != MPS_OK ? status : MPS_E_RANKS;
}

mps_status mps_job_create(const mps_job_config *config, mps_job **job)
{
    if (job) *job = NULL;
    if (!job || !config || config->struct_size != sizeof *config) return MPS_E_ARG;
    const char *wrong = check(config);
    mps_status status = wrong ? MPS_E_ARG : MPS_E_NOMEM;
    mps_job *made = wrong ? NULL : calloc(1, sizeof *made);
    if (!made || !copy_config(made, config)) {
        if (config->error && config->error_size > 0)
            snprintf(config->error, config->error_size, "%s", wrong ? wrong : "out of memory");
        mps_job_destroy(made);
        return status;
    }
    made->config.quiet = config->quiet || !mps__job_first(made);
    status = open_folder(made);
    if (config->error && config->error_size > 0)
        snprintf(config->error, config->error_size, "%s", made->error);
    made->config.error = NULL; /* the program owns it */
    if (status == MPS_OK)
        *job = made;
    else
        mps_job_destroy(made);
    return status;
}

static void free_reference(job_reference *r)
{
    free(r->label);
    free(r->unit);
    free(r->column);
    free(r->t);
    free(r->value);
}

static void free_lists(mps_job *job)
{
    for (int k = 0; k < job->references; k++) free_reference(&job->reference[k]);
    for (int k = 0; k < job->inputs; k++) {
        free(job->input[k].key);
        free(job->input[k].value);
    }
    for (int k = 0; k < job->quantities; k++) mps__quantity_free(job->quantity[k]);
    for (int k = 0; k < job->traces; k++) free(job->trace[k]);
    for (int k = 0; k < job->outlines; k++) free(job->outline[k].x);
    free(job->outline);
    free(job->edge);
    free(job->reference);
    free(job->input);
    free(job->quantity);
    free(job->trace);
    free(job->column);
    free(job->figure);
}

void mps_job_destroy(mps_job *job)
{
    if (!job) return;
    const mps_job_config *c = &job->config;
    const void *const all[] = {c->name,         c->title,      c->command, c->text,
                               c->model,        c->folder,     c->device,  c->picture_t,
                               job->picture_at, job->all_rows, job->start, job->row};
    mps__folder_close(&job->place);
    free_lists(job);
    mps__table_free(&job->probes);
    mps__table_free(&job->steps);
    mps__table_free(&job->momentum);
    mps__table_free(&job->trace_rows);
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) free((void *)all[k]);
    free(job);
}

/* ---- references and inputs ---- */

mps_status mps_reference_init(mps_reference *reference, size_t size)
{
    if (!reference || size != sizeof *reference) return MPS_E_ARG;
    *reference = (mps_reference){.struct_size = sizeof *reference};
    return MPS_OK;
}

/* Whether times do not descend, and all values are finite. */
static bool are_points(int64_t count, const double *t, const double *value)
{
    if (count < 1 || !t || !value) return false;
    for (int64_t k = 0; k < count; k++)
        if (!isfinite(t[k]) || !isfinite(value[k]) || (k > 0 && t[k] < t[k - 1])) return false;
    return true;
}

static double *copy_numbers(int64_t count, const double *from)
{
    double *copy = malloc((size_t)count * sizeof *copy);
    if (copy) memcpy(copy, from, (size_t)count * sizeof *copy);
    return copy;
}

mps_status mps_job_reference_add(mps_job *job, const mps_reference *reference)
{
    if (!job || !reference || reference->struct_size != sizeof *reference) return MPS_E_ARG;
    if (!reference->label || !reference->unit ||
        !are_points(reference->count, reference->t, reference->value))
        return mps__job_refuse(
            job, MPS_E_ARG, "reference '%s': needs a label, a unit and points with ascending times",
            reference->label ? reference->label : "");
    job_reference *grown = mps__grown(job->reference, job->references, sizeof *grown);
    if (!grown) return mps__job_refuse(job, MPS_E_NOMEM, "out of memory");
    job->reference = grown;
    job_reference *r = &grown[job->references];
    *r = (job_reference){.label = mps__job_copy(reference->label),
                         .unit = mps__job_copy(reference->unit),
                         .column = mps__job_copy(reference->column),
                         .line = reference->line,
                         .count = reference->count,
                         .t = copy_numbers(reference->count, reference->t),
                         .value = copy_numbers(reference->count, reference->value)};
    if (r->label && r->unit && (r->column || !reference->column) && r->t && r->value) {
        job->references++;
        return MPS_OK;
    }
    free_reference(r);
    return mps__job_refuse(job, MPS_E_NOMEM, "out of memory");
}

mps_status mps_job_input_add(mps_job *job, const char *key, const char *value)
{
    if (!job) return MPS_E_ARG;
    if (!key || !key[0] || !value)
        return mps__job_refuse(job, MPS_E_ARG, "an input needs a key and a value");
    job_input *grown = mps__grown(job->input, job->inputs, sizeof *grown);
    if (!grown) return mps__job_refuse(job, MPS_E_NOMEM, "out of memory");
    job->input = grown;
    job_input *i = &grown[job->inputs];
    *i = (job_input){mps__job_copy(key), mps__job_copy(value)};
    if (i->key && i->value) {
        job->inputs++;
        return MPS_OK;
    }
    free(i->key);
    free(i->value);
    return mps__job_refuse(job, MPS_E_NOMEM, "out of memory");
}

mps_status mps_job_plugin_add(mps_job *job, const mps_plugin_file *plugin)
{
    if (!job) return MPS_E_ARG;
    if (!plugin || job->plugins == JOB_PLUGINS)
        return mps__job_refuse(job, MPS_E_ARG, "a job names at most %d plug-ins", JOB_PLUGINS);
    job->plugin[job->plugins++] = plugin;
    return MPS_OK;
}

mps_status mps_job_edges_add(mps_job *job, int32_t count, const double *ends)
{
    if (!job) return MPS_E_ARG;
    bool good = count >= 1 && ends && count < INT32_MAX / 64 - job->edges;
    for (int64_t k = 0; good && k < 6 * (int64_t)count; k++) good = isfinite(ends[k]);
    if (!good) return mps__job_refuse(job, MPS_E_ARG, "edges need two places each");
    const size_t before = 6 * (size_t)job->edges, more = 6 * (size_t)count;
    double *grown = realloc(job->edge, (before + more) * sizeof *grown);
    if (!grown) return mps__job_refuse(job, MPS_E_NOMEM, "out of memory");
    /* rounded to single precision, so that summary.json has the values as stored */
    for (size_t k = 0; k < more; k++) grown[before + k] = (double)(float)ends[k];
    job->edge = grown;
    job->edges += count;
    return MPS_OK;
}

mps_status mps_job_outline_add(mps_job *job, int32_t count, const double *x)
{
    if (!job) return MPS_E_ARG;
    bool good = count >= 2 && x;
    for (int64_t k = 0; good && k < 2 * (int64_t)count; k++) good = isfinite(x[k]);
    if (!good) return mps__job_refuse(job, MPS_E_ARG, "an outline needs at least two places");
    job_outline *grown = mps__grown(job->outline, job->outlines, sizeof *grown);
    if (grown) job->outline = grown;
    double *copy = grown ? copy_numbers(2 * (int64_t)count, x) : NULL;
    if (!copy) return mps__job_refuse(job, MPS_E_NOMEM, "out of memory");
    grown[job->outlines++] = (job_outline){count, copy};
    return MPS_OK;
}

static double still_level(void *user, mps_sim *sim)
{
    (void)sim;
    return ((const mps_job *)user)->level;
}

mps_status mps_job_level_set(mps_job *job, double level)
{
    if (!job) return MPS_E_ARG;
    if (!isfinite(level)) return mps__job_refuse(job, MPS_E_ARG, "level must be a number");
    const mps_status status = mps_job_figure_add(
        job, "still_level", "y of the still level as filled [m]", 0, still_level, job);
    if (status == MPS_OK) job->level = level;
    return status;
}

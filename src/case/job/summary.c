/* SPDX-License-Identifier: BSD-3-Clause */
/* summary.json: one object for programs, flat but for lists: columns of probes.csv, figures,
 * inputs, references, phases. */
#include "escape.h"
#include "run.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

static void json_string(FILE *out, const char *text)
{
    fputc('"', out);
    mps__put_escaped(out, text, mps__json_character);
    fputc('"', out);
}

static void json_text(FILE *out, const char *key, const char *text)
{
    fprintf(out, ",\n  \"%s\": ", key);
    json_string(out, text);
}

/* JSON has neither NaN nor infinity. */
static void json_number(FILE *out, const char *key, double value)
{
    if (isfinite(value))
        fprintf(out, ",\n  \"%s\": %.17g", key, value);
    else
        fprintf(out, ",\n  \"%s\": null", key);
}

static double per_step(double sum, int64_t steps)
{
    return steps ? sum / (double)steps : 0;
}

static void summary_counts(FILE *out, const mps_job *job)
{
    const job_totals *s = &job->totals;
    json_number(out, "n_fluid", (double)s->fluid);
    json_number(out, "n_wall", (double)s->wall);
    json_number(out, "n_dummy", (double)s->dummy);
    json_number(out, "steps", (double)s->steps);
    json_number(out, "particles_lost", (double)s->lost);
    json_number(out, "threads", job->config.threads);
    json_number(out, "ranks", mps__job_ranks(job));
    json_number(out, "dim", job->dim);
    if (job->config.device) json_text(out, "device", job->config.device);
}

/* Largest memory of this program [bytes]. That of getrusage() begins with the memory of the
 * program that started it. */
double mps__job_peak_memory(void)
{
    char line[160];
    double kib = NAN;
    FILE *status = fopen("/proc/self/status", "r");
    while (status && fgets(line, sizeof line, status))
        if (strncmp(line, "VmHWM:", 6) == 0) kib = strtod(line + 6, NULL);
    if (status) fclose(status);
    return 1024 * kib;
}

static void summary_times(FILE *out, const mps_job *job)
{
    const job_totals *s = &job->totals;
    json_number(out, "t_end", s->t);
    json_number(out, "until", job->config.t_end);
    json_number(out, "t_resumed", s->t_before);
    json_number(out, "dt_mean", per_step(s->t, s->steps));
    json_number(out, "wall_s", s->wall_s);
    json_number(out, "cpu_s", s->cpu_s);
    json_number(out, "s_per_step", per_step(s->step_s, s->steps_of_run));
    json_number(out, "output_s", s->output_s);
    json_number(out, "ppe_iterations_mean", per_step(s->ppe_iterations, s->steps));
    json_number(out, "ppe_solves_mean", per_step(s->ppe_solves, s->steps));
    json_number(out, "ppe_s", s->seconds[MPS_STAGE_PPE_SETUP] + s->seconds[MPS_STAGE_PPE_SOLVE]);
    json_number(out, "neighbour_s", s->seconds[MPS_STAGE_NEIGHBOURS]);
    json_number(out, "operators_s",
                s->seconds[MPS_STAGE_OPERATORS] + s->seconds[MPS_STAGE_CORRECT]);
    json_number(out, "peak_rss_bytes", mps__job_peak_memory());
}

/* The averaging window of pressures [s]. */
static void summary_average(FILE *out, const mps_job *job)
{
    const bool follows = job->config.average == MPS_AVERAGE_AUTO;
    json_text(out, "sensor_average", follows ? "dp/u_max" : "given");
    json_number(out, "sensor_average_least",
                follows ? job->totals.crossing_least : job->config.average);
    json_number(out, "sensor_average_most",
                follows ? job->totals.crossing_most : job->config.average);
}

/* Tank and liquid as built [m]. */
static void summary_boxes(FILE *out, const mps_job *job)
{
    static const char *const wall[] = {"tank_lo_x", "tank_lo_y", "tank_lo_z"};
    static const char *const size[] = {"tank_size_x", "tank_size_y", "tank_size_z"};
    if (job->walls.count > 0)
        for (int d = 0; d < job->dim; d++) {
            json_number(out, wall[d], job->walls.lo[d]);
            json_number(out, size[d], job->walls.hi[d] - job->walls.lo[d]);
        }
    json_number(out, "liquid_depth", mps__job_depth(job));
    fputs(",\n  \"tank_start\": [", out); /* R, row by row, and s of x = R X + s */
    for (int k = 0; k < 9; k++) fprintf(out, "%.17g, ", job->built.turn[k]);
    fprintf(out, "%.17g, %.17g, %.17g]", job->built.shift[0], job->built.shift[1],
            job->built.shift[2]);
}

/* What each column of probes.csv is, and its position. */
static void summary_columns(FILE *out, const mps_job *job)
{
    fputs(",\n  \"columns\": [", out);
    for (int k = 0; k < mps__job_columns(job); k++) {
        const job_column c = mps__job_column(job, k);
        fprintf(out, "%s\n    {\"name\": \"%s\", \"unit\": \"%s\", \"type\": \"%s\", ",
                k ? "," : "", c.name, c.unit, c.type);
        if (c.probe >= 0 && strcmp(c.type, "force") != 0)
            fprintf(out, "\"at\": [%.9g, %.9g, %.9g], ", c.at[0], c.at[1], c.at[2]);
        if (strcmp(c.type, "wall_pressure") == 0) {
            fprintf(out,
                    "\"diameter\": %.9g, \"normal\": [%.9g, %.9g, %.9g], \"part\": ", c.diameter,
                    c.normal[0], c.normal[1], c.normal[2]);
            json_string(out, c.part);
            fputs(", ", out);
        }
        fputs("\"about\": ", out);
        json_string(out, c.about);
        fputc('}', out);
    }
    fputs("\n  ]", out);
}

/* Figures and their descriptions. */
static void summary_figures(FILE *out, const mps_job *job)
{
    fputs(",\n  \"figures\": [", out);
    for (int i = 0; i < job->figures; i++) {
        fprintf(out, "%s\n    {\"name\": \"%s\", \"about\": ", i ? "," : "", job->figure[i].name);
        json_string(out, job->figure[i].about);
        fputc('}', out);
    }
    fputs("\n  ]", out);
}

/* ---- the case ---- */

static void summary_inputs(FILE *out, const mps_job *job)
{
    fputs(",\n  \"inputs\": [", out);
    for (int k = 0; k < job->inputs; k++) {
        fprintf(out, "%s\n    {\"key\": ", k ? "," : "");
        json_string(out, job->input[k].key);
        fputs(", \"value\": ", out);
        json_string(out, job->input[k].value);
        fputc('}', out);
    }
    fputs("\n  ]", out);
}

/* One plug-in, with the names of its items. */
static void summary_plugin(FILE *out, const mps_plugin_file *plugin)
{
    static const char *const kind[] = {"model", "solver", "preconditioner", "load", "motion"};
    mps_plugin_info info;
    mps_plugin_item item;
    mps_plugin_info_init(&info, sizeof info);
    mps_plugin_item_init(&item, sizeof item);
    mps_plugin_info_get(plugin, &info);
    fputs("{\"name\": ", out);
    json_string(out, info.name);
    fputs(", \"version\": ", out);
    json_string(out, info.version);
    fputs(", \"file\": ", out);
    json_string(out, info.path);
    fprintf(out, ", \"sha256\": \"%s\", \"items\": [", info.sha256);
    for (int32_t i = 0; mps_plugin_item_get(plugin, i, &item) == MPS_OK; i++) {
        fprintf(out, "%s{\"kind\": \"%s\", \"name\": ", i ? ", " : "", kind[item.kind]);
        json_string(out, item.name);
        fputs(", \"help\": ", out);
        json_string(out, item.help);
        fputc('}', out);
    }
    fputs("]}", out);
}

static void summary_plugins(FILE *out, const mps_job *job)
{
    if (job->plugins == 0) return;
    fputs(",\n  \"plugins\": [", out);
    for (int k = 0; k < job->plugins; k++) {
        fputs(k ? ",\n    " : "\n    ", out);
        summary_plugin(out, job->plugin[k]);
    }
    fputs("\n  ]", out);
}

static void summary_references(FILE *out, const mps_job *job)
{
    fputs(",\n  \"references\": [", out);
    for (int k = 0; k < job->references; k++) {
        const job_reference *p = &job->reference[k];
        fprintf(out, "%s\n    {\"label\": ", k ? "," : "");
        json_string(out, p->label);
        fputs(", \"unit\": ", out);
        json_string(out, p->unit);
        fputs(", \"column\": ", out);
        if (p->column)
            json_string(out, p->column);
        else
            fputs("null", out);
        fprintf(out, ", \"line\": %s, \"points\": [", p->line ? "true" : "false");
        for (int64_t i = 0; i < p->count; i++)
            fprintf(out, "%s[%.17g, %.17g]", i ? ", " : "", p->t[i], p->value[i]);
        fputs("]}", out);
    }
    fputs("\n  ]", out);
}

/* Phases of the fluid; "gas": less than a hundredth of the largest density. */
static void summary_phases(FILE *out, const mps_job *job)
{
    mps_phase p;
    double densest = 0;
    mps_phase_init(&p, sizeof p);
    for (int32_t k = 0; k < job->phases; k++)
        if (mps_phase_get(job->sim, k, &p) == MPS_OK) densest = fmax(densest, p.density);
    fputs(",\n  \"phases\": [", out);
    for (int32_t k = 0; k < job->phases; k++) {
        if (mps_phase_get(job->sim, k, &p) != MPS_OK) continue;
        fprintf(out,
                "%s\n    {\"name\": \"phase %d\", \"density\": %.17g, \"viscosity\": %.17g, "
                "\"gas\": %s}",
                k ? "," : "", (int)k, p.density, p.viscosity,
                p.density < 0.01 * densest ? "true" : "false");
    }
    fputs("\n  ]", out);
}

/* Lines of the sketch. */
static void summary_outlines(FILE *out, const mps_job *job)
{
    if (job->outlines == 0) return;
    fputs(",\n  \"outline\": [", out);
    for (int k = 0; k < job->outlines; k++) {
        const job_outline *o = &job->outline[k];
        fputs(k ? ",\n    [" : "\n    [", out);
        for (int32_t i = 0; i < o->count; i++)
            fprintf(out, "%s[%.9g, %.9g]", i ? ", " : "", o->x[2 * i], o->x[2 * i + 1]);
        fputc(']', out);
    }
    fputs("\n  ]", out);
}

/* Edges of the tank in 3-D. */
static void summary_edges(FILE *out, const mps_job *job)
{
    if (job->edges == 0) return;
    fputs(",\n  \"edges\": [", out);
    for (int32_t k = 0; k < job->edges; k++) {
        const double *x = job->edge + 6 * (int64_t)k;
        fprintf(out, "%s[%.9g, %.9g, %.9g, %.9g, %.9g, %.9g]", k ? ",\n    " : "\n    ", x[0], x[1],
                x[2], x[3], x[4], x[5]);
    }
    fputs("\n  ]", out);
}

/* End time and machine. */
static void summary_machine(FILE *out)
{
    char text[600];
    const time_t now = time(NULL);
    struct tm utc;
    struct utsname host;
    if (gmtime_r(&now, &utc) && strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc) > 0)
        json_text(out, "date", text);
    if (uname(&host) >= 0) {
        snprintf(text, sizeof text, "%s %s, %s, %ld processors", host.sysname, host.release,
                 host.machine, sysconf(_SC_NPROCESSORS_ONLN));
        json_text(out, "machine", text);
    }
}

/* Spacing as built, as requested, and along each axis, whose cells have the volume of a
 * particle. */
static void summary_spacing(FILE *out, const mps_job *job)
{
    double h[3];
    json_number(out, "dp", job->dp);
    if (job->config.dp > 0) json_number(out, "dp_requested", job->config.dp);
    if (mps_lattice_get(job->sim, NULL, h) != MPS_OK) return;
    fputs(",\n  \"lattice\": [", out);
    for (int d = 0; d < job->dim; d++) fprintf(out, "%s%.17g", d ? ", " : "", h[d]);
    fputc(']', out);
}

/* Names of all models that take part in a step, including those of plug-ins. */
static void summary_models(FILE *out, const mps_job *job)
{
    const char *name;
    fputs(",\n  \"models\": [", out);
    for (int32_t k = 0; (name = mps_model_name(job->sim, k)) != NULL; k++) {
        fputs(k ? ", " : "", out);
        json_string(out, name);
    }
    fputc(']', out);
}

static void summary_case(FILE *out, const mps_job *job)
{
    fputs("{\n  \"case\": ", out);
    json_string(out, job->config.name);
    json_text(out, "title", job->config.title);
    if (job->config.command) json_text(out, "command", job->config.command);
    json_text(out, "model", job->config.model ? job->config.model : "");
    summary_models(out, job);
    summary_spacing(out, job);
    json_number(out, "gravity", job->config.gravity);
    fprintf(out, ",\n  \"tank_frame\": %s", job->config.tank_frame ? "true" : "false");
}

static void summary_write(FILE *out, const mps_job *job)
{
    char solver[128];
    mps__job_solver(job, solver, sizeof solver);
    summary_case(out, job);
    summary_counts(out, job);
    summary_times(out, job);
    json_text(out, "ppe_solver", solver);
    json_number(out, "volume_error", job->totals.volume_error);
    json_number(out, "max_speed", job->totals.max_speed);
    summary_average(out, job);
    for (int i = 0; i < job->figures; i++)
        json_number(out, job->figure[i].name, job->totals.status ? job->figure[i].measured : NAN);
    json_text(out, "status", job->totals.status ? job->totals.status : "unfinished");
    json_text(out, "error", job->error);
    json_text(out, "version", mps_version(NULL, NULL, NULL));
    summary_machine(out);
    summary_boxes(out, job);
    if (job->picture.pressure_hi > job->picture.pressure_lo)
        fprintf(out, ",\n  \"pressure_scale\": [%.9g, %.9g]", job->picture.pressure_lo,
                job->picture.pressure_hi);
    summary_columns(out, job);
    if (job->figures > 0) summary_figures(out, job);
    summary_inputs(out, job);
    summary_plugins(out, job);
    summary_references(out, job);
    summary_phases(out, job);
    summary_outlines(out, job);
    summary_edges(out, job);
    fputs("\n}\n", out);
}

/* Written to a temporary file and renamed: if the process is killed or the disk is full, the
 * previous file stays. */
bool mps__summary_save(mps_job *job)
{
    char path[FOLDER_PATH + 32], temporary[FOLDER_PATH + 40];
    snprintf(path, sizeof path, "%s/summary.json", job->place.path);
    snprintf(temporary, sizeof temporary, "%s.tmp", path);
    FILE *out = fopen(temporary, "w");
    if (out) summary_write(out, job);
    bool failed = !out || ferror(out) || fflush(out) != 0 || fsync(fileno(out)) != 0;
    if (out && fclose(out) != 0) failed = true;
    if (!failed && rename(temporary, path) == 0) return true;
    mps__job_print(job, "%s: %s", path, strerror(errno));
    if (out) unlink(temporary);
    return false;
}

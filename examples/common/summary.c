/* SPDX-License-Identifier: BSD-3-Clause */
/* summary.json: one object for programs, flat but for two lists: what the columns of probes.csv and the driver's own numbers are. */
#include "outputs.h"
#include "ranks.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void json_string(FILE *out, const char *text)
{
    fputc('"', out);
    for (; *text; text++) {
        if (*text == '"' || *text == '\\')
            fprintf(out, "\\%c", *text);
        else if ((unsigned char)*text < 0x20)
            fprintf(out, "\\u%04x", (unsigned)*text);
        else
            fputc(*text, out);
    }
    fputc('"', out);
}

static void json_text(FILE *out, const char *key, const char *text)
{
    fprintf(out, ",\n  \"%s\": ", key);
    json_string(out, text);
}

/* JSON has no NaN and no infinity. */
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

static void summary_counts(FILE *out, const run *r)
{
    const run_totals *s = &r->totals;
    json_number(out, "n_fluid", (double)s->fluid);
    json_number(out, "n_wall", (double)s->wall);
    json_number(out, "n_dummy", (double)s->dummy);
    json_number(out, "steps", (double)s->steps);
    json_number(out, "particles_lost", (double)s->lost);
    json_number(out, "threads", r->options.threads);
    json_number(out, "ranks", ranks_count());
    json_number(out, "dim", r->options.dim);
}

/* Largest memory of this program [bytes]. That of getrusage() begins with the memory of the program that started it. */
static double peak_memory(void)
{
    char line[160];
    double kib = NAN;
    FILE *status = fopen("/proc/self/status", "r");
    while (status && fgets(line, sizeof line, status))
        if (strncmp(line, "VmHWM:", 6) == 0) kib = strtod(line + 6, NULL);
    if (status) fclose(status);
    return 1024 * kib;
}

static void summary_times(FILE *out, const run *r)
{
    const run_totals *s = &r->totals;
    json_number(out, "t_end", s->t);
    json_number(out, "t_resumed", s->t_before);
    json_number(out, "dt_mean", per_step(s->t, s->steps));
    json_number(out, "wall_s", s->wall_s);
    json_number(out, "cpu_s", s->cpu_s);
    json_number(out, "s_per_step", per_step(s->step_s, s->steps_here));
    json_number(out, "output_s", s->output_s);
    json_number(out, "ppe_iterations_mean", per_step(s->ppe_iterations, s->steps));
    json_number(out, "ppe_solves_mean", per_step(s->ppe_solves, s->steps));
    json_number(out, "ppe_s", s->seconds[MPS_STAGE_PPE_SETUP] + s->seconds[MPS_STAGE_PPE_SOLVE]);
    json_number(out, "neighbour_s", s->seconds[MPS_STAGE_NEIGHBOURS]);
    json_number(out, "operators_s",
                s->seconds[MPS_STAGE_OPERATORS] + s->seconds[MPS_STAGE_CORRECT]);
    json_number(out, "peak_rss_bytes", peak_memory());
}

/* What pressures were averaged over [s]. */
static void summary_average(FILE *out, const run *r)
{
    const bool follows = r->options.sensor_average == MPS_AVERAGE_AUTO;
    json_text(out, "sensor_average", follows ? "dp/u_max" : "given");
    json_number(out, "sensor_average_least",
                follows ? r->totals.crossing_least : r->options.sensor_average);
    json_number(out, "sensor_average_most",
                follows ? r->totals.crossing_most : r->options.sensor_average);
}

/* Tank and liquid as they are built [m]. */
static void summary_boxes(FILE *out, const run *r)
{
    static const char *const wall[] = {"tank_lo_x", "tank_lo_y", "tank_lo_z"};
    static const char *const size[] = {"tank_size_x", "tank_size_y", "tank_size_z"};
    if (r->walls.count > 0)
        for (int d = 0; d < r->options.dim; d++) {
            json_number(out, wall[d], r->walls.lo[d]);
            json_number(out, size[d], r->walls.hi[d] - r->walls.lo[d]);
        }
    json_number(out, "liquid_depth", run_depth(r));
}

/* What each column of probes.csv is, and where. */
static void summary_columns(FILE *out, const run *r)
{
    fputs(",\n  \"columns\": [", out);
    for (int k = 0; k < run_columns_all(r); k++) {
        const run_column c = run_column_at(r, k);
        fprintf(out, "%s\n    {\"name\": \"%s\", \"unit\": \"%s\", \"type\": \"%s\", ",
                k ? "," : "", c.name, c.unit, c.type);
        if (strcmp(c.type, "wall_pressure") == 0 || strcmp(c.type, "gauge") == 0)
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

/* What the driver's own numbers are. */
static void summary_figures(FILE *out, const run *r)
{
    fputs(",\n  \"figures\": [", out);
    for (int i = 0; i < r->figures; i++) {
        fprintf(out, "%s\n    {\"name\": \"%s\", \"about\": ", i ? "," : "", r->figure[i].name);
        json_string(out, r->figure[i].about);
        fputc('}', out);
    }
    fputs("\n  ]", out);
}

static void summary_write(FILE *out, const run *r)
{
    const char *solver = "", *preconditioner = NULL;
    char both[128];
    mps_solver_name(r->sim, &solver, &preconditioner);
    snprintf(both, sizeof both, "%s/%s", solver,
             preconditioner && preconditioner[0] ? preconditioner : "none");
    fprintf(out, "{\n  \"case\": \"%s\"", r->options.program);
    json_text(out, "model", r->options.model);
    json_number(out, "dp", r->options.dp);
    summary_counts(out, r);
    summary_times(out, r);
    json_text(out, "ppe_solver", both);
    json_number(out, "volume_error", r->totals.volume_error);
    json_number(out, "max_speed", r->totals.max_speed);
    summary_average(out, r);
    for (int i = 0; i < r->figures; i++) json_number(out, r->figure[i].name, r->figure[i].measured);
    json_text(out, "status", r->totals.status);
    json_text(out, "error", r->totals.error);
    json_text(out, "version", mps_version(NULL, NULL, NULL));
    summary_boxes(out, r);
    summary_columns(out, r);
    if (r->figures > 0) summary_figures(out, r);
    fputs("\n}\n", out);
}

bool summary_save(const run *r)
{
    char path[560];
    snprintf(path, sizeof path, "%s/summary.json", r->options.out);
    FILE *out = fopen(path, "w");
    if (out) summary_write(out, r);
    bool failed = !out || ferror(out);
    if (out && fclose(out) != 0) failed = true;
    if (failed) fprintf(ranks_messages(), "%s: %s\n", path, strerror(errno));
    return !failed;
}

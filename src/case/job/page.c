/* SPDX-License-Identifier: BSD-3-Clause */
/* What the writer of plots and report.html is told about a run. */
#include "report.h"
#include "run.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void set(report_row *rows, int *count, const char *name, const char *format, ...)
{
    va_list values;
    if (*count == REPORT_ROWS) return;
    report_row *row = &rows[(*count)++];
    row->name = name;
    va_start(values, format);
    vsnprintf(row->value, sizeof row->value, format, values);
    va_end(values);
}

/* "x = 0 to 1.2, y = 0 to 0.6 m" */
static void set_box(report *r, const char *name, const job_box *b)
{
    char text[160] = "";
    if (b->count == 0) return;
    for (int d = 0; d < r->dim; d++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "%s%c = %.6g to %.6g",
                 d ? ", " : "", "xyz"[d], b -> lo[d], b -> hi[d]);
    set(r->setting, &r->settings, name, "%s m", text);
}

/* Size of the tank, place and depth of the liquid. */
static void set_boxes(report *r, const mps_job *job)
{
    const double *lo = job->walls.lo, *hi = job->walls.hi, depth = mps__job_depth(job);
    char third[32] = "";
    if (r->dim == 3) snprintf(third, sizeof third, " x %.6g", hi[2] - lo[2]);
    if (job->walls.count > 0)
        set(r->setting, &r->settings, "inner size of the tank", "%.6g x %.6g%s m", hi[0] - lo[0],
            hi[1] - lo[1], third);
    set_box(r, "tank: faces of the walls", &job->walls);
    if (isfinite(depth))
        set(r->setting, &r->settings, "depth of liquid at the start", "%.6g m", depth);
    set_box(r, "liquid at the start: centres of particles", &job->liquid);
}

static void set_settings(report *r, const mps_job *job)
{
    const mps_job_config *c = &job->config;
    char solver[128];
    mps__job_solver(job, solver, sizeof solver);
    if (c->model) set(r->setting, &r->settings, "model", "%s", c->model);
    set(r->setting, &r->settings, "solver", "%s", solver);
    set(r->setting, &r->settings, "dimensions", "%d", (int)job->dim);
    set(r->setting, &r->settings, "spacing dp", "%.6g m", job->dp);
    set_boxes(r, job);
    for (int k = 0; k < job->inputs; k++)
        set(r->setting, &r->settings, job->input[k].key, "%s", job->input[k].value);
    set(r->setting, &r->settings, "time asked for", "%.6g s", c->t_end);
    set(r->setting, &r->settings, "threads", "%d", (int)c->threads);
    if (mps__job_ranks(job) > 1)
        set(r->setting, &r->settings, "ranks", "%d", (int)mps__job_ranks(job));
    set(r->setting, &r->settings, "libmps", "%s", mps_version(NULL, NULL, NULL));
}

static void set_results(report *r, const mps_job *job)
{
    const job_totals *s = &job->totals;
    const double steps = s->steps > 0 ? (double)s->steps : 1,
                 here = s->steps_here > 0 ? (double)s->steps_here : 1;
    report_row *rows = r->result;
    int *count = &r->results;
    set(rows, count, "status", "%s", s->status);
    if (job->error[0]) set(rows, count, "message", "%s", job->error);
    set(rows, count, "time reached", "%.6g s", s->t);
    set(rows, count, "fluid particles", "%lld", (long long)s->fluid);
    set(rows, count, "wall particles", "%lld", (long long)s->wall);
    set(rows, count, "dummy particles", "%lld", (long long)s->dummy);
    set(rows, count, "particles lost", "%lld", (long long)s->lost);
    set(rows, count, "error of volume", "%.6g %%", 100 * s->volume_error);
    set(rows, count, "largest speed", "%.6g m/s", s->max_speed);
    set(rows, count, "steps", "%lld", (long long)s->steps);
    set(rows, count, "mean time step", "%.6g s", s->t / steps);
    set(rows, count, "pressure iterations a step", "%.6g", s->ppe_iterations / steps);
    if (s->t_before > 0) set(rows, count, "wall clock is that since t =", "%.6g s", s->t_before);
    set(rows, count, "wall clock", "%.6g s", s->wall_s);
    set(rows, count, "wall clock a step", "%.6g ms", 1e3 * s->step_s / here);
}

static void set_pictures(report *r, const mps_job *job)
{
    for (int k = 0; k < job->pictures && k + 1 < REPORT_PICTURES; k++) {
        snprintf(r->picture[r->pictures], sizeof r->picture[0], "picture_%d.png", k + 1);
        r->picture_t[r->pictures++] = job->picture_at[k];
    }
    snprintf(r->picture[r->pictures], sizeof r->picture[0], "picture_end.png");
    r->picture_t[r->pictures++] = job->totals.t;
}

static report_table rows_of(const table *t)
{
    return (report_table){t->kept, t->count, t->columns};
}

/* All that has a length of its own; `columns` owns the texts of `column`. */
typedef struct lists {
    job_column *columns;
    report_column *column, *figure;
    report_reference *reference;
} lists;

static bool fill_lists(lists *l, const mps_job *job)
{
    const int count = mps__job_columns(job);
    *l = (lists){malloc((size_t)count * sizeof *l->columns),
                 malloc((size_t)count * sizeof *l->column),
                 malloc(((size_t)job->figures + 1) * sizeof *l->figure),
                 malloc(((size_t)job->references + 1) * sizeof *l->reference)};
    if (!l->columns || !l->column || !l->figure || !l->reference) return false;
    for (int k = 0; k < count; k++) {
        l->columns[k] = mps__job_column(job, k);
        const job_column *c = &l->columns[k];
        l->column[k] = (report_column){c->name, c->unit, c->about, 0};
    }
    for (int k = 0; k < job->figures; k++) {
        const job_figure *f = &job->figure[k];
        l->figure[k] = (report_column){f->name, "", f->about, f->measured};
    }
    for (int k = 0; k < job->references; k++) {
        const job_reference *p = &job->reference[k];
        l->reference[k] = (report_reference){p->label, p->unit, p->column, p->line != 0,
                                             p->count, p->t,    p->value};
    }
    return true;
}

bool mps__page_save(mps_job *job)
{
    char error[REPORT_ERROR] = "out of memory";
    lists l;
    report *r = calloc(1, sizeof *r);
    bool done = fill_lists(&l, job) && r;
    if (done) {
        const mps_job_config *c = &job->config;
        *r = (report){.folder = job->place.path,
                      .name = c->name,
                      .title = c->title,
                      .dim = job->dim,
                      .t_end = c->t_end,
                      .page = c->report != 0,
                      .several = job->several,
                      .probes = rows_of(&job->probes),
                      .momentum = rows_of(&job->momentum),
                      .steps = rows_of(&job->steps),
                      .columns = mps__job_columns(job),
                      .added = job->columns,
                      .figures = job->figures,
                      .references = job->references,
                      .column = l.column,
                      .figure = l.figure,
                      .reference = l.reference};
        set_settings(r, job);
        set_results(r, job);
        set_pictures(r, job);
        done = mps__report_save(r, error);
    }
    if (!done) mps__job_tell(job, "%s", error);
    free(l.columns);
    free(l.column);
    free(l.figure);
    free(l.reference);
    free(r);
    return done;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Plots and report.html of a run that has ended. */
#include "plots.h"
#include "run.h"
#include <mps/page.h>
#include <stdlib.h>

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

static bool save_plots(mps_job *job, char *error)
{
    lists l;
    bool done = fill_lists(&l, job);
    if (done) {
        const report r = {.folder = job->place.path,
                          .dim = job->dim,
                          .t_end = job->config.t_end,
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
        done = mps__report_save(&r, error);
    }
    free(l.columns);
    free(l.column);
    free(l.figure);
    free(l.reference);
    return done;
}

static bool save_page(const mps_job *job, char *error)
{
    mps_page_config config;
    if (!job->config.report) return true;
    mps_page_config_init(&config, sizeof config);
    if (job->config.page_bytes > 0) config.bytes = job->config.page_bytes;
    config.error = error;
    config.error_size = REPORT_ERROR;
    return mps_page_write(job->place.path, &config, NULL) == MPS_OK;
}

bool mps__page_save(mps_job *job)
{
    char error[REPORT_ERROR] = "out of memory";
    const bool done = save_plots(job, error) && save_page(job, error);
    if (!done) mps__job_tell(job, "%s", error);
    return done;
}

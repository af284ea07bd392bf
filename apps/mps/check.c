/* SPDX-License-Identifier: BSD-3-Clause */
/* mps check. */
#include "jobs.h"
#include "summary.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MEASURED = 24 };

/* Write the drawing. Without --out, if the current folder is not writable, only the text of the
 * check counts. */
static int save(const choices *c, const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    bool good = file != NULL;
    if (file) { /* a write error is kept until the end */
        fputs(text, file);
        good = !ferror(file);
        if (fclose(file) != 0) good = false;
    }
    if (good) {
        if (!c->quiet) printf("%-9s %s\n", "drawing", path);
        return MPS_EXIT_OK;
    }
    fprintf(stderr, "mps %s: %s: %s%s\n", c->verb, path, strerror(errno),
            c->out ? "" : "; there is no drawing, --out writes it to another place");
    return c->out ? MPS_EXIT_FAILED : MPS_EXIT_OK;
}

/* ---- a sweep ---- */

/* Totals of the runs of a sweep; costs are those of `measured` runs. */
typedef struct sweep_cost {
    int64_t runs, refused, measured;
    double least, most, longest, memory;
} sweep_cost;

/* Read and build a run of a sweep; with `measure` also compute its first steps. */
static void add_run(const choices *c, const mps_case *tank, int64_t index, bool measure,
                    sweep_cost *s)
{
    static char set[CLI_SETS][SUMMARY_TEXT];
    choices one = *c;
    char *text = NULL;
    mps_case *run = NULL;
    mps_case_cost cost = {.struct_size = sizeof cost};
    for (int32_t k = 0; k < mps_case_sweep_count(tank) && one.sets < CLI_SETS; k++)
        if (mps_case_sweep_get(tank, index, k, set[k], sizeof set[k]) == MPS_OK)
            one.set[one.sets++] = set[k];
    mps_status status = cli_open(&one, &run);
    if (status == MPS_OK) status = mps_case_check(run, measure ? &text : NULL, NULL);
    if (status != MPS_OK) {
        s->refused++;
        fprintf(stderr, "mps check: run %lld of %lld is refused:", (long long)index + 1,
                (long long)s->runs);
        for (int32_t k = c->sets; k < one.sets; k++) fprintf(stderr, " %s", one.set[k]);
        fputc('\n', stderr);
        if (run) cli_print_messages(&one, run, 0);
    } else if (measure && mps_case_cost_get(run, &cost) == MPS_OK) {
        s->measured++;
        s->least += cost.wall_least;
        s->most += cost.wall_most;
        s->longest = fmax(s->longest, cost.wall_most);
        s->memory = fmax(s->memory, cost.memory);
    }
    free(text);
    mps_case_destroy(run);
}

/* "3.9 to 9.1 h" */
static void print_span(double least, double most)
{
    const double unit = most < 100 ? 1 : most < 6000 ? 60 : 3600;
    printf("about %.2g to %.2g %s", least / unit, most / unit,
           unit > 60  ? "h"
           : unit > 1 ? "min"
                      : "s");
}

/* Check all runs of a sweep: each is built, and steps are measured in at most MEASURED of them.
 * @return exit code */
static int check_sweep(const choices *c, const mps_case *tank)
{
    sweep_cost s = {.runs = mps_case_runs(tank)};
    const int64_t stride = (s.runs + MEASURED - 1) / MEASURED;
    const int32_t processors = jobs_processors(), jobs = c->jobs > 0           ? c->jobs
                                                         : s.runs < processors ? (int32_t)s.runs
                                                                               : processors;
    for (int64_t i = 0; i < s.runs; i++) add_run(c, tank, i, i % stride == 0, &s);
    if (!c->quiet) {
        const double all = s.measured > 0 ? (double)s.runs / (double)s.measured : NAN;
        printf("%-9s %lld runs, %lld refused\n", "sweep", (long long)s.runs, (long long)s.refused);
        printf("%-9s ", "");
        print_span(all * s.least, all * s.most);
        printf(
            " of wall clock in all, one after the other; outputs apart; the longest run %.2g s\n",
            s.longest);
        printf("%-9s with --jobs %d ", "", (int)jobs);
        print_span(fmax(all * s.least / jobs, 0), fmax(all * s.most / jobs, s.longest));
        printf(", at least %d processors; %.0f MB of memory, %.0f MB a run\n", (int)jobs,
               1e-6 * jobs * s.memory, 1e-6 * s.memory);
    }
    return s.refused > 0 ? MPS_EXIT_USAGE : MPS_EXIT_OK;
}

int verb_check(const choices *c)
{
    char *text, *sketch, stem[900], path[1024];
    int code = MPS_EXIT_FAILED;
    mps_case *tank = cli_case(c, &code);
    if (!tank) return code;
    const size_t before = cli_messages(tank);
    const mps_status status = mps_case_check(tank, &text, &sketch);
    cli_print_messages(c, tank, before);
    if (status != MPS_OK) {
        if (status != MPS_E_ARG) fprintf(stderr, "mps %s: %s\n", c->verb, mps_status_text(status));
        mps_case_destroy(tank);
        return status == MPS_E_ARG ? MPS_EXIT_USAGE : MPS_EXIT_FAILED;
    }
    cli_stem(c->file[0], stem, sizeof stem);
    snprintf(path, sizeof path, "%s.svg", stem);
    if (c->out) snprintf(path, sizeof path, "%s", c->out);
    if (!c->quiet) fputs(text, stdout);
    code = save(c, path, sketch);
    if (code == MPS_EXIT_OK && mps_case_sweep_count(tank) > 0) code = check_sweep(c, tank);
    free(text);
    free(sketch);
    mps_case_destroy(tank);
    return code;
}

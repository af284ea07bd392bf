/* SPDX-License-Identifier: BSD-3-Clause */
/* Runs of a series. Each has a folder with a lock, by which processes of one or several machines
 * that share the folders divide the runs. */
#include "plan.h"
#include "jobs.h"
#include "summary.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* ---- the part of this process ---- */

/* Parse "I/N" of --part. @return false: another text */
static bool read_part(const choices *c, int64_t *first, int64_t *of)
{
    char *end;
    *first = 0;
    *of = 1;
    if (!c->part) return true;
    const long i = strtol(c->part, &end, 10);
    if (*end != '/') return false;
    const long n = strtol(end + 1, &end, 10);
    *first = i - 1;
    *of = n;
    return !*end && i >= 1 && i <= n;
}

/* The runs of this process, every `of`-th one. */
typedef struct part {
    int64_t first, of, count;
} part;

static bool find_part(const plan *p, part *own)
{
    if (!read_part(p->c, &own->first, &own->of)) {
        fprintf(stderr,
                "mps %s: --part %s: must be I/N, the part I of N: 1/4, 2/4, 3/4 and 4/4 are all\n",
                p->c->verb, p->c->part);
        return false;
    }
    own->count = own->first < p->runs ? (p->runs - own->first + own->of - 1) / own->of : 0;
    return true;
}

/* ---- one run ---- */

static bool choices_of(const plan *p, int64_t index, choices *one, char folder[SERIES_PATH])
{
    *one = *p->c;
    if (!p->set(p->user, index, one)) return false;
    if (series_folder(p->place, index, folder)) return true;
    fprintf(stderr, "mps %s: --out: the name is too long\n", p->c->verb);
    return false;
}

static void print_run(const plan *p, int64_t index, const char *what, const choices *one)
{
    char line[1024];
    size_t used = (size_t)snprintf(line, sizeof line, "mps %s: run %lld of %lld%s", p->c->verb,
                                   (long long)index + 1, (long long)p->runs, what);
    for (int32_t k = p->c->sets; k < one->sets && used < sizeof line; k++)
        used += (size_t)snprintf(line + used, sizeof line - used, "%s %s",
                                 k == p->c->sets ? ":" : "", one->set[k]);
    fprintf(stderr, "%s\n", line);
}

int plan_take(const plan *p, int64_t index, bool quiet)
{
    char folder[SERIES_PATH];
    choices one;
    if (!choices_of(p, index, &one, folder)) return MPS_EXIT_USAGE;
    if (!p->c->quiet && !quiet) print_run(p, index, "", &one);
    one.quiet = one.quiet || quiet;
    bool busy = false;
    const int code = series_run(&one, folder, &busy);
    if (busy) return PLAN_OPEN;
    if (!p->c->quiet && quiet && code == MPS_EXIT_OK) print_run(p, index, " is done", &one);
    if (code != MPS_EXIT_OK)
        fprintf(stderr, "mps %s: %s %s, exit code %d\n", p->c->verb, folder,
                code == MPS_EXIT_INTERRUPTED ? "was interrupted" : "failed", code);
    if (code == MPS_EXIT_OK && p->fits && !p->fits(p->user, index)) return PLAN_REFUSED;
    return code;
}

/* ---- checks before the first run ---- */

/* Whether a run can be built. A finished one can. */
static bool check_run(const plan *p, int64_t index)
{
    char folder[SERIES_PATH];
    choices one;
    mps_case *tank = NULL;
    if (!choices_of(p, index, &one, folder)) return false;
    if (summary_is_done(folder) && !one.overwrite) return true;
    mps_status status = cli_open(&one, &tank);
    if (status == MPS_OK) status = mps_case_check(tank, NULL, NULL);
    if (status != MPS_OK) {
        print_run(p, index, " is refused", &one);
        if (tank) cli_print_messages(&one, tank, 0);
    }
    mps_case_destroy(tank);
    return status == MPS_OK;
}

int64_t plan_check(const plan *p, int64_t first, int64_t step)
{
    int64_t refused = 0;
    for (int64_t i = first; i < p->runs; i += step) refused += !check_run(p, i);
    return refused;
}

/* ---- all ---- */

/* Do the runs one after the other. Those locked by another process are checked again at the end. */
static int run_alone(plan *p, const part *own)
{
    for (int pass = 0; pass < 2; pass++)
        for (int64_t k = 0; k < own->count; k++) {
            const int64_t i = own->first + k * own->of;
            if (pass > 0 && p->code[i] != PLAN_OPEN) continue;
            p->code[i] = plan_take(p, i, false);
            if (p->code[i] == MPS_EXIT_INTERRUPTED) return MPS_EXIT_INTERRUPTED;
            if (p->code[i] == PLAN_REFUSED) return PLAN_REFUSED;
        }
    return MPS_EXIT_OK;
}

/* Update the states of runs of other processes. */
static void look_at_others(plan *p)
{
    char folder[SERIES_PATH];
    for (int64_t i = 0; i < p->runs; i++)
        if (p->code[i] == PLAN_OPEN && series_folder(p->place, i, folder) &&
            summary_is_done(folder))
            p->code[i] = MPS_EXIT_OK;
}

void plan_print_open(const plan *p)
{
    int64_t open = 0;
    for (int64_t i = 0; i < p->runs; i++) open += p->code[i] == PLAN_OPEN;
    if (open == 0 || p->c->quiet) return;
    fprintf(
        stderr,
        "mps %s: %lld of %lld runs in '%s' are not done or in progress in other processes; 'mps "
        "collect %s' makes the table again\n",
        p->c->verb, (long long)open, (long long)p->runs, p->place, p->place);
}

int plan_run(plan *p)
{
    part own;
    if (!find_part(p, &own)) return MPS_EXIT_USAGE;
    const bool many = p->c->jobs > 1;
    const int64_t refused = many ? jobs_check(p, own.first, own.of)
                                 : plan_check(p, own.first, own.of);
    if (refused > 0) {
        fprintf(stderr, "mps %s: %lld of %lld runs are refused; none is begun\n", p->c->verb,
                (long long)refused, (long long)own.count);
        return MPS_EXIT_USAGE;
    }
    p->code = malloc((size_t)p->runs * sizeof *p->code);
    if (!p->code) return MPS_EXIT_FAILED;
    for (int64_t i = 0; i < p->runs; i++) p->code[i] = PLAN_OPEN;
    int worst = many ? jobs_run(p, own.first, own.of) : run_alone(p, &own);
    look_at_others(p);
    if (worst == PLAN_REFUSED) {
        free(p->code);
        p->code = NULL;
        return MPS_EXIT_USAGE;
    }
    for (int64_t i = 0; i < p->runs; i++)
        if (p->code[i] > worst) worst = p->code[i];
    return worst;
}

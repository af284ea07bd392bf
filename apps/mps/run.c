/* SPDX-License-Identifier: BSD-3-Clause */
/* mps run, mps resume. */
#include "cli.h"
#include "summary.h"
#include <mps/mps.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { ERROR_SIZE = 1024, PATH_SIZE = 1024 };

/* Exit code of a failure to start. */
static int code_of(mps_status status)
{
    const bool refused = status == MPS_E_ARG || status == MPS_E_STATE || status == MPS_E_BUSY ||
                         status == MPS_E_IO;
    return refused ? MPS_EXIT_USAGE : MPS_EXIT_FAILED;
}

/* Build and run a case that was read. */
static int run_case(const choices *c, mps_case *tank, const mps_job_config *config, bool *busy)
{
    mps_job *job;
    mps_sim *sim;
    const size_t before = cli_messages(tank);
    if (mps_case_sweep_count(tank) > 0) {
        cli_print(c, "mps %s: %s: the case has a 'sweep'; use 'mps sweep'\n", c->verb, c->file[0]);
        return MPS_EXIT_USAGE;
    }
    const mps_status status = mps_case_job(tank, config, &job, &sim);
    if (busy) *busy = status == MPS_E_BUSY;
    if (status == MPS_E_BUSY && busy) return MPS_EXIT_USAGE;
    if (status != MPS_OK) {
        if (cli_messages(tank) > before)
            cli_print_messages(c, tank, before);
        else
            cli_print(c, "mps %s: %s\n", c->verb,
                      config->error[0] ? config->error : mps_status_text(status));
        return code_of(status);
    }
    if (!c->quiet) cli_print_messages(c, tank, before);
    const int32_t code = mps_job_run(job, sim);
    mps_sim_destroy(sim);
    mps_job_destroy(job);
    return code;
}

/* The choices with the number of threads as a further value of the case. */
static choices with_threads(const choices *c, char *text, size_t size)
{
    choices all = *c;
    if (c->threads > 0) {
        snprintf(text, size, "run.threads=%d", (int)c->threads);
        all.set[all.sets++] = text;
    }
    return all;
}

int cli_run(const choices *c, const mps_job_config *begin, const char *folder, bool *busy)
{
    mps_job_config config = *begin;
    char threads[48];
    const choices all = with_threads(c, threads, sizeof threads);
    int code = -1;
    config.folder = folder;
    config.command = c->command;
    config.overwrite = c->overwrite;
    config.quiet = c->quiet;
    config.profile = c->profile;
    config.device = c->device;
    config.signals = 1;
    config.ranks = c->kept ? &c->kept->ranks : NULL;
    mps_case *tank = cli_case(&all, &code);
    code = cli_agree(c, code);
    if (code < 0) code = cli_end(c, run_case(c, tank, &config, busy));
    mps_case_destroy(tank);
    return code;
}

/* Whether a folder has the runs of a sweep, repetition or convergence: a run in it would hide
 * them. */
static bool has_series(const char *folder)
{
    struct stat s;
    char path[PATH_SIZE + 16];
    snprintf(path, sizeof path, "%s/001/case.yaml", folder);
    return stat(path, &s) == 0;
}

int verb_run(const choices *c)
{
    char error[ERROR_SIZE] = "", stem[PATH_SIZE];
    mps_job_config config;
    mps_job_config_init(&config, sizeof config);
    config.error = error;
    config.error_size = sizeof error;
    config.resume = c->resume;
    cli_stem(c->file[0], stem, sizeof stem);
    const char *folder = c->out ? c->out : stem;
    if (has_series(folder)) {
        fprintf(stderr,
                "mps run: --out %s: there are the runs of a sweep, repetition or convergence (001, "
                "..); choose another folder with --out\n",
                folder);
        return MPS_EXIT_USAGE;
    }
    return cli_run(c, &config, folder, NULL);
}

int verb_resume(const choices *c)
{
    char error[ERROR_SIZE] = "", path[PATH_SIZE], name[SUMMARY_TEXT];
    choices all = *c;
    mps_job_config config;
    mps_job_config_init(&config, sizeof config);
    config.error = error;
    config.error_size = sizeof error;
    config.resume = 1;
    /* with the original name of the case: its file is named "case" */
    if (summary_text(c->file[0], "case", name)) config.name = name;
    snprintf(path, sizeof path, "%s/case.yaml", c->file[0]);
    all.file[0] = path;
    return cli_run(&all, &config, c->file[0], NULL);
}

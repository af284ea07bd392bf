/* SPDX-License-Identifier: BSD-3-Clause */
/* A case and its simulation, without a run. */
#include "variables.h"
#include <dirent.h>
#include <errno.h>
#include <mps/mps.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool fail(char *error, size_t size, const char *what, const char *why)
{
    snprintf(error, size, "%s%s%s", what, why[0] ? ": " : "", why);
    return false;
}

static bool make_folder(fmu_model *m, char *error, size_t size)
{
    char path[sizeof m->folder];
    const char *place = getenv("TMPDIR");
    const int length = snprintf(path, sizeof path, "%s/mps_fmu_XXXXXX",
                                place && place[0] ? place : "/tmp");
    if (length >= (int)sizeof path - 32) return fail(error, size, "TMPDIR", "its name is too long");
    if (!mkdtemp(path)) return fail(error, size, path, strerror(errno));
    memcpy(m->folder, path, sizeof path);
    return true;
}

/* Files in this folder: the lock of the job, and checkpoints. */
static void remove_folder(fmu_model *m)
{
    char path[sizeof m->folder + 256];
    DIR *folder = m->folder[0] ? opendir(m->folder) : NULL;
    if (!folder) return;
    for (struct dirent *e; (e = readdir(folder)) != NULL;) {
        snprintf(path, sizeof path, "%s/%.255s", m->folder, e->d_name);
        if (strcmp(e->d_name, ".") != 0 && strcmp(e->d_name, "..") != 0) unlink(path);
    }
    closedir(folder);
    rmdir(m->folder);
    m->folder[0] = '\0';
}

static bool read_dim(fmu_model *m, char *error, size_t size)
{
    mps_lease x;
    mps_lease_init(&x, sizeof x);
    if (mps_lease_begin(m->sim, "position", MPS_READ, &x) != MPS_OK)
        return fail(error, size, mps_sim_error(m->sim), "");
    m->dim = x.stride;
    mps_lease_end(m->sim, &x);
    return true;
}

/* The importer moves the tank, so the motion of a body in the case would have no effect. */
static bool refuse_body(fmu_model *m, char *error, size_t size)
{
    mps_body_report report;
    mps_body_report_init(&report, sizeof report);
    if (mps_body_get(m->sim, &report) != MPS_OK) return true;
    return fail(error, size,
                "the case has a 'body': the importer of an FMU computes the body; give 'motion' "
                "with the same centre in its place",
                "");
}

bool fmu_model_open(fmu_model *m, mps_case *c, mps_job_print_fn print, void *user, char *error,
                    size_t size)
{
    char why[640] = "";
    mps_job_config config;
    m->c = c;
    if (mps_case_sweep_count(c) > 0)
        return fail(error, size, "the case has a 'sweep': an FMU is one tank", "");
    if (!make_folder(m, error, size)) return false;
    mps_job_config_init(&config, sizeof config);
    config.folder = m->folder;
    config.print = print;
    config.print_user = user;
    config.error = why;
    config.error_size = sizeof why;
    const int32_t before = mps_case_message_count(c);
    const mps_status status = mps_case_job(c, &config, &m->job, &m->sim);
    if (status == MPS_OK) return refuse_body(m, error, size) && read_dim(m, error, size);
    if (mps_case_message_count(c) > before)
        mps_case_messages_write(c, error, size);
    else
        fail(error, size, mps_status_text(status), why);
    return false;
}

void fmu_model_close(fmu_model *m)
{
    mps_sim_destroy(m->sim);
    mps_job_destroy(m->job);
    mps_case_destroy(m->c);
    remove_folder(m);
    *m = (fmu_model){.folder = ""};
}

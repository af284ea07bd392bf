/* SPDX-License-Identifier: BSD-3-Clause */
/* Jobs of a small tank with water at rest, in a folder of their own. */
#ifndef JOB_FIXTURE_H
#define JOB_FIXTURE_H

#include "tank_fixture.h"
#include <mps/job.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { TEXT_SIZE = 1 << 20, SAID_SIZE = 1 << 14 };

/* All messages of a job. */
static char said[SAID_SIZE];

static inline void listen(void *user, int32_t kind, const char *text)
{
    (void)user, (void)kind;
    strncat(said, text, sizeof said - strlen(said) - 1);
}

#define ASSERT_SAID(word)                                                             \
    do {                                                                              \
        if (!strstr(said, (word))) fail_msg("said \"%s\", not \"%s\"", said, (word)); \
    } while (0)

static inline mps_job_config config_of(const char *folder)
{
    mps_job_config c;
    assert_int_equal(mps_job_config_init(&c, sizeof c), MPS_OK);
    c.name = "test";
    c.folder = folder;
    c.t_end = 0.05;
    c.row_interval = 0.002;
    c.frames = 0;
    c.report = 0;
    c.print = listen;
    said[0] = '\0';
    return c;
}

static inline mps_job *job_of(const mps_job_config *config)
{
    char error[1000] = "";
    mps_job_config c = *config;
    mps_job *job = NULL;
    c.error = error;
    c.error_size = sizeof error;
    const mps_status status = mps_job_create(&c, &job);
    if (status != MPS_OK) fail_msg("%s: %s", mps_status_name(status), error);
    return job;
}

/* A refusal whose text contains `word`. */
static inline void refused(const mps_job_config *config, mps_status wanted, const char *word)
{
    char error[1000] = "";
    mps_job_config c = *config;
    mps_job *job = (mps_job *)&c;
    c.error = error;
    c.error_size = sizeof error;
    assert_int_equal(mps_job_create(&c, &job), wanted);
    assert_null(job);
    if (!strstr(error, word)) fail_msg("\"%s\" does not mention \"%s\"", error, word);
}

#define ASSERT_JOB_REFUSED(job, call, wanted, word)                              \
    do {                                                                         \
        const mps_status got_ = (call);                                          \
        if (got_ != (wanted) || !strstr(mps_job_error(job), (word)))             \
            fail_msg("%s: %s: \"%s\", not \"%s\"", #call, mps_status_name(got_), \
                     mps_job_error(job), (word));                                \
    } while (0)

/* Water 0.2 m deep in a tank of 0.4 x 0.4 m, dp 0.04 m. */
static inline mps_sim *water(void)
{
    const double lo[2] = {0}, hi[2] = {0.4, 0.2};
    mps_sim *sim = new_sim(2, 0.04);
    add_tank(sim, 0.4, 0.4, 0);
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    return sim;
}

/* A file as text; "" if it does not exist. */
static inline char *text_of(const char *folder, const char *name)
{
    static char text[TEXT_SIZE];
    char path[300];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *in = fopen(path, "r");
    const size_t size = in ? fread(text, 1, sizeof text - 1, in) : 0;
    if (in) fclose(in);
    text[size] = '\0';
    return text;
}

static inline bool is_there(const char *folder, const char *name)
{
    char path[300];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return access(path, F_OK) == 0;
}

/* Column `column` of row `row` of a table, rows from 0. */
static inline double number_in(const char *folder, const char *name, int row, int column)
{
    const char *at = text_of(folder, name);
    for (int k = 0; k <= row && at; k++) {
        at = strchr(at, '\n');
        if (at) at++;
    }
    for (int k = 0; k < column && at; k++) {
        at = strchr(at, ',');
        if (at) at++;
    }
    return at ? strtod(at, NULL) : NAN;
}

/* Work in a folder that is removed at the end. */
static inline int enter_folder(void **state)
{
    static char folder[] = "mps_job_XXXXXX";
    *state = folder;
    return mkdtemp(folder) && chdir(folder) == 0 ? 0 : -1;
}

static inline int leave_folder(void **state)
{
    char command[100];
    snprintf(command, sizeof command, "rm -rf %s", (const char *)*state);
    return chdir("..") == 0 && system(command) == 0 ? 0 : -1;
}

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* Frames and pictures of a run, and its last state. */
#include "run.h"
#include <math.h>
#include <stdio.h>

enum { QUARTERS = 4 };

/* Whether each rank writes a piece of a frame: a call that all ranks make. */
static bool is_apart(const mps_job *job)
{
    return job->config.pieces && mps__job_ranks(job) > 1;
}

/* The present state, unless it is in the last frame already. */
static void write_frame(mps_job *job)
{
    double t = 0;
    mps_sim_time(job->sim, &t, NULL);
    if (!job->frames || t <= job->frame_t) return;
    mps__job_note(job, mps_frames_write(job->frames), "frames");
    job->frame_t = t;
}

/* Number of the first frame behind t. */
static int64_t next_frame(const mps_job *job, double t)
{
    return (int64_t)(t / job->config.t_end * job->config.frames + 1e-9) + 1;
}

void mps__frames_begin(mps_job *job)
{
    const mps_job_config *c = &job->config;
    const bool pieces = is_apart(job);
    const int32_t flags = (c->resume ? MPS_FRAMES_CONTINUE : 0) | (pieces ? MPS_FRAMES_PIECES : 0) |
                          (c->tank_frame ? MPS_FRAMES_TANK : 0);
    job->frame_t = -1;
    if (c->frames == 0 || !(pieces || mps__job_gather(job))) return;
    mps__job_note(job, mps_frames_open(job->sim, c->folder, "frames", flags, &job->frames),
                  "frames");
    if (!c->resume) write_frame(job);
    job->frame = next_frame(job, job->totals.t);
    if (!pieces) mps__job_gather_end(job);
}

static bool is_frame_due(const mps_job *job, double t)
{
    const double interval = job->config.t_end / (job->config.frames > 0 ? job->config.frames : 1);
    return job->frames && t >= (double)job->frame * interval - 1e-9 * interval;
}

/* At the times asked for, or at quarters; the end has a picture of its own. */
static bool is_picture_due(const mps_job *job, double t)
{
    const mps_job_config *c = &job->config;
    const int count = c->picture_count > 0 ? c->picture_count : QUARTERS - 1;
    if (job->pictures == count) return false;
    const double next = c->picture_count > 0 ? c->picture_t[job->pictures]
                                             : c->t_end * (job->pictures + 1) / QUARTERS;
    return t >= next - 1e-9 * c->t_end;
}

int mps__drawing_due(const mps_job *job, double t)
{
    return (is_frame_due(job, t) ? DUE_FRAME : 0) | (is_picture_due(job, t) ? DUE_PICTURE : 0);
}

void mps__drawing_skip(mps_job *job, double t)
{
    while (is_picture_due(job, t)) job->picture_at[job->pictures++] = NAN;
}

static void draw(mps_job *job, const char *name)
{
    char path[FOLDER_PATH + 48], error[JOB_ERROR] = "";
    mps_picture_config *config = &job->picture;
    snprintf(path, sizeof path, "%s/%s", job->place.path, name);
    config->error = error;
    config->error_size = sizeof error;
    const mps_status status = mps_picture_save(job->sim, config, path);
    config->error = NULL;
    if (status == MPS_OK) return;
    job->output_failed = true;
    if (!job->error[0]) snprintf(job->error, sizeof job->error, "%s", error);
}

static void draw_next(mps_job *job, double t)
{
    char name[32];
    job->picture_at[job->pictures] = t;
    snprintf(name, sizeof name, "picture_%d.png", ++job->pictures);
    draw(job, name);
}

void mps__drawing_do(mps_job *job, double t, int due)
{
    const bool frame = due & DUE_FRAME, picture = due & DUE_PICTURE, apart = is_apart(job);
    if (frame) job->frame = next_frame(job, t);
    if (frame && apart) write_frame(job);
    if (!(picture || (frame && !apart)) || !mps__job_gather(job)) return;
    if (frame && !apart) write_frame(job);
    if (mps__job_first(job) && picture) draw_next(job, t);
    mps__job_gather_end(job);
}

void mps__drawing_end(mps_job *job, mps_status status)
{
    if (is_apart(job) && status >= 0) write_frame(job);
    if (mps__job_gather(job)) { /* not where a rank has failed */
        if (!is_apart(job)) write_frame(job);
        if (mps__job_first(job)) {
            draw(job, "picture_end.png");
            for (int k = 0; k < job->figures; k++)
                if (job->figure[k].flags & MPS_JOB_PARTICLES)
                    job->figure[k].measured = job->figure[k].value(job->figure[k].user, job->sim);
        }
        mps__job_gather_end(job);
    }
    mps_frames_close(job->frames);
    job->frames = NULL;
}

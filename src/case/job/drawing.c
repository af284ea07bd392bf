/* SPDX-License-Identifier: BSD-3-Clause */
/* Frames and pictures of a run, and its final state. */
#include "picture_canvas.h"
#include "run.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { QUARTERS = 4 };

/* Whether each rank writes its own piece of a frame: a collective call. */
static bool is_apart(const mps_job *job)
{
    return job->config.pieces && mps__job_ranks(job) > 1;
}

/* Write a frame of the present state, unless the last frame contains it. */
static void write_frame(mps_job *job)
{
    double t = 0;
    mps_sim_time(job->sim, &t, NULL);
    if (!job->frames || t <= job->frame_t) return;
    mps__job_note(job, mps_frames_write(job->frames), "frames");
    job->frame_t = t;
}

/* Number of the first frame after t. */
static int64_t next_frame(const mps_job *job, double t)
{
    return (int64_t)(t / job->config.t_end * job->config.frames + 1e-9) + 1;
}

/* ---- frames about peaks ---- */

/* Rows per rise time if there is no fall. */
static const double RISE_ROWS = 100;
/* Pressures are evaluated only after this fraction of the fall time. */
static const double START_SHARE = 0.2;

/* The parameters depend on the tank, the spacing and the rows alone, so that an extended run has
 * the peaks of one long run. A rise takes at most as long as a free fall through the tank. The
 * interval of frames is the time in which liquid at the speed of that fall crosses a quarter of a
 * spacing: a step or two. */
void mps__peaks_begin(mps_job *job)
{
    const mps_job_config *c = &job->config;
    const double tall = fmax(job->walls.hi[1] - job->walls.lo[1], job->dp),
                 speed = sqrt(2 * fabs(c->gravity) * tall),
                 fall = speed > 0 ? 2 * tall / speed : RISE_ROWS * c->row_interval,
                 apart = speed > 0 ? 0.25 * job->dp / speed : 0;
    mps__peaks_init(&job->peaks, c->frames > 0 ? c->peaks : 0, START_SHARE * fall, fall,
                    fmax(apart, c->row_interval));
    for (int k = 0; k < job->columns; k++)
        if (strcmp(job->column[k].unit, "Pa") == 0) mps__peaks_add(&job->peaks, k + 1);
}

int mps__peaks_due(mps_job *job)
{
    if (!job->peak_frames) return 0;
    const bool due = mps__job_first(job) && job->peaks.due;
    job->peaks.due = false;
    return mps__job_broadcast(job, due ? DUE_PEAK : 0);
}

static int is_wanted(void *user, double t)
{
    return mps__peaks_wants(user, t);
}

/* Remove frames that are no longer near one of the highest peaks. Steps that are fitted to the end
 * remove none: an extended run takes other steps instead, and may have other peaks. */
static void remove_peaks(mps_job *job)
{
    if (!job->peaks.changed || !job->peak_frames || job->fitted) return;
    job->peaks.changed = false;
    mps__job_note(job, mps_frames_remove(job->peak_frames, is_wanted, &job->peaks), "peaks");
}

/* ---- frames ---- */

void mps__frames_begin(mps_job *job)
{
    const mps_job_config *c = &job->config;
    const bool pieces = is_apart(job);
    const int32_t flags = (c->resume ? MPS_FRAMES_CONTINUE : 0) | (pieces ? MPS_FRAMES_PIECES : 0) |
                          (c->tank_frame ? MPS_FRAMES_TANK : 0);
    job->frame_t = -1;
    /* rows before a checkpoint have had their frames written and removed */
    job->peaks.due = job->peaks.changed = false;
    if (c->frames == 0 || !(pieces || mps__job_collect(job))) return;
    mps__job_note(job, mps_frames_open(job->sim, c->folder, "frames", flags, &job->frames),
                  "frames");
    if (job->peaks.signals > 0)
        mps__job_note(job,
                      mps_frames_open(job->sim, c->folder, "peaks", flags | MPS_FRAMES_STEPS,
                                      &job->peak_frames),
                      "peaks");
    if (!c->resume) write_frame(job);
    job->frame = next_frame(job, job->totals.t);
    if (!pieces) mps__job_collect_end(job);
}

static bool is_frame_due(const mps_job *job, double t)
{
    const double interval = job->config.t_end / (job->config.frames > 0 ? job->config.frames : 1);
    return job->frames && t >= (double)job->frame * interval - 1e-9 * interval;
}

/* At the requested times, or at quarters of the run; the end has a picture of its own. */
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

/* One state may be in both series: the frames about peaks do not depend on the times of the other
 * series. */
static void write_due(mps_job *job, int due)
{
    if (due & DUE_FRAME) write_frame(job);
    if (due & DUE_PEAK) mps__job_note(job, mps_frames_write(job->peak_frames), "peaks");
}

void mps__drawing_do(mps_job *job, double t, int due)
{
    const bool frame = due & DUE_FRAME, picture = due & DUE_PICTURE, apart = is_apart(job);
    const bool whole = due & (DUE_FRAME | DUE_PEAK);
    if (frame) job->frame = next_frame(job, t);
    if (whole && apart) write_due(job, due);
    if ((picture || (whole && !apart)) && mps__job_collect(job)) {
        if (whole && !apart) write_due(job, due);
        if (mps__job_first(job) && picture) draw_next(job, t);
        mps__job_collect_end(job);
    }
    if (mps__job_first(job)) remove_peaks(job);
}

void mps__drawing_end(mps_job *job, mps_status status)
{
    /* a run that continues from here has the frame times of an uninterrupted run */
    const bool frame = status != MPS_W_STOPPED;
    if (frame && is_apart(job) && status >= 0) write_frame(job);
    if (mps__job_collect(job)) { /* false if a rank has failed */
        if (frame && !is_apart(job)) write_frame(job);
        if (mps__job_first(job)) {
            draw(job, "picture_end.png");
            if (!mps__canvas_letters())
                mps__job_print(job, "warning: pictures have no letters: no font can be drawn; "
                                    "install one, as of fonts-dejavu-core, and run 'fc-cache -f'");
            for (int k = 0; k < job->figures; k++)
                if (job->figure[k].flags & MPS_JOB_PARTICLES)
                    job->figure[k].measured = job->figure[k].value(job->figure[k].user, job->sim);
        }
        mps__job_collect_end(job);
    }
    mps_frames_close(job->frames);
    mps_frames_close(job->peak_frames);
    job->frames = job->peak_frames = NULL;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Films: the picture of each frame is piped to ffmpeg. */
#include "film_pipe.h"
#include "picture_canvas.h"
#include "picture_scene.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WORD = 32 };

mps_status mps_film_config_init(mps_film_config *config, size_t size)
{
    if (!config) return MPS_E_ARG;
    if (size != sizeof *config) return MPS_E_VERSION;
    *config = (mps_film_config){.struct_size = (uint32_t)size, .width = 1280, .program = "ffmpeg"};
    return MPS_OK;
}

static mps_status check(const char *folder, const mps_film_config *config, page_errors *e)
{
    if (config->struct_size != sizeof *config) return MPS_E_ARG;
    *e = (page_errors){config->error, config->error_size};
    if (e->text && e->size > 0) e->text[0] = '\0';
    if (!folder || !folder[0]) return mps__page_fail(e, MPS_E_ARG, "the film has no folder");
    if (!config->program || !config->program[0])
        return mps__page_fail(e, MPS_E_ARG, "the film has no program");
    if (config->width < 400 || config->width > 4000)
        return mps__page_fail(e, MPS_E_ARG, "film: width is %d, must be 400..4000",
                              (int)config->width);
    if (config->rate != 0 && !(config->rate >= 1 && config->rate <= 120))
        return mps__page_fail(e, MPS_E_ARG, "film: rate is %g, must be 1..120, or 0", config->rate);
    return MPS_OK;
}

/* A film being made. */
typedef struct making {
    const mps_film_config *config;
    const film *f;
    const char *url; /* of the temporary file */
    page_errors *e;
    mps_picture_config picture; /* of all frames */
    scene s;
    film_frame frame;
    film_pipe pipe;
    bool started;
    double lo[3], hi[3]; /* bounds of the first picture */
} making;

static double rate_of(const making *m)
{
    const page_run *run = m->f->run;
    if (m->config->rate > 0) return m->config->rate;
    const double t = run->frames > 1 ? run->frame[run->frames - 1].t - run->frame[0].t : 0;
    return t > 0 ? fmax(5, fmin((double)(run->frames - 1) / t, 60)) : 5;
}

/* Pixel format for the byte order of this machine. */
static const char *pixel_format(void)
{
    const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first ? "bgr0" : "0rgb";
}

static mps_status start(making *m, const canvas *c)
{
    char size[WORD], rate[WORD];
    const int thousandths = (int)lround(1000 * rate_of(m));
    snprintf(size, sizeof size, "%dx%d", c->width, c->height);
    snprintf(rate, sizeof rate, "%d/1000", thousandths);
    /* all players show H.264 in yuv420p; they expect colours of bt709 */
    const char *const argv[] = {m->config->program,
                                "-y",
                                "-nostdin",
                                "-loglevel",
                                "error",
                                "-f",
                                "rawvideo",
                                "-pix_fmt",
                                pixel_format(),
                                "-video_size",
                                size,
                                "-framerate",
                                rate,
                                "-i",
                                "pipe:0",
                                "-vf",
                                "scale=out_color_matrix=bt709:out_range=tv",
                                "-colorspace",
                                "bt709",
                                "-color_primaries",
                                "bt709",
                                "-color_trc",
                                "bt709",
                                "-c:v",
                                "libx264",
                                "-crf",
                                "23",
                                "-pix_fmt",
                                "yuv420p",
                                "-movflags",
                                "+faststart",
                                "-f",
                                "mp4",
                                m->url,
                                NULL};
    const mps_status status = mps__pipe_start(&m->pipe, argv, m->e);
    m->started = status == MPS_OK;
    return status;
}

static bool send_rows(making *m, const canvas *c)
{
    bool sent = true;
    for (int y = 0; sent && y < c->height; y++)
        sent = mps__pipe_write(&m->pipe, c->pixel + (size_t)y * (size_t)c->stride,
                               (size_t)c->width * sizeof *c->pixel);
    return sent;
}

static mps_status send_picture(making *m, canvas *c)
{
    mps_status status = m->started ? MPS_OK : start(m, c);
    if (status != MPS_OK) return status;
    cairo_surface_flush(c->surface);
    return send_rows(m, c) ? MPS_OK : MPS_E_IO;
}

static mps_status add_frame(making *m, int64_t k)
{
    canvas c;
    mps_status status = mps__film_frame_read(m->f, k, &m->frame);
    if (status == MPS_OK) status = mps__scene_of_frame(&m->s, m->f, k, &m->frame);
    if (status != MPS_OK) return status;
    if (!mps__scene_end(&m->s))
        return mps__page_fail(m->e, MPS_E_ARG, "no film: a frame has no particle");
    if (!m->started) {
        memcpy(m->lo, m->s.lo, sizeof m->lo);
        memcpy(m->hi, m->s.hi, sizeof m->hi);
    }
    /* bitwise equal in all pictures, so that these have the same size */
    memcpy(m->s.lo, m->lo, sizeof m->lo);
    memcpy(m->s.hi, m->hi, sizeof m->hi);
    if (!mps__scene_scale(&m->s, &m->picture))
        return mps__page_fail(m->e, MPS_E_NOMEM, "no memory for a picture");
    status = mps__scene_draw(&m->s, m->config->width, &c, m->e);
    if (status != MPS_OK) return status;
    status = send_picture(m, &c);
    mps__canvas_destroy(&c);
    return status;
}

static mps_status add_frames(making *m)
{
    mps_status status = mps__scene_of_run(&m->s, m->f);
    mps_picture_config_init(&m->picture, sizeof m->picture);
    m->picture.pressure_lo = m->f->pressure.lo;
    m->picture.pressure_hi = m->f->pressure.hi;
    for (int64_t k = 0; status == MPS_OK && k < m->f->run->frames; k++) status = add_frame(m, k);
    mps__film_frame_free(&m->frame);
    mps__scene_free(&m->s);
    /* the child's own error output explains a failed write best */
    if (!m->started) return status;
    const mps_status ended = mps__pipe_end(&m->pipe, m->e);
    if (status == MPS_OK) return ended;
    return mps__page_fail(m->e, status, "'%s' stopped before the end of the film",
                          m->config->program);
}

/* Written to a temporary file, and renamed when it is complete. */
static mps_status make(const film *f, const mps_film_config *config, const char *path,
                       page_errors *e)
{
    const size_t length = strlen(path);
    char *url = malloc(length + 10);
    if (!url) return mps__page_fail(e, MPS_E_NOMEM, "no memory for a film");
    /* with "file:" ffmpeg takes no name for an option or a URL */
    snprintf(url, length + 10, "file:%s.tmp", path);
    const char *temporary = url + strlen("file:");
    making m = {.config = config, .f = f, .url = url, .e = e};
    remove(temporary); /* it may be a link */
    mps_status status = add_frames(&m);
    if (status == MPS_OK && rename(temporary, path) != 0)
        status = mps__page_fail(e, MPS_E_IO, "cannot write '%s': %s", path, strerror(errno));
    if (status != MPS_OK) remove(temporary);
    free(url);
    return status;
}

mps_status mps_film_save(const char *folder, const mps_film_config *config, const char *path)
{
    mps_film_config own;
    page_errors e = {NULL, 0};
    page_run run = {0};
    film f = {0};
    mps_film_config_init(&own, sizeof own);
    if (!config) config = &own;
    mps_status status = check(folder, config, &e);
    if (status != MPS_OK) return status;
    status = mps__page_run_read(&run, folder, &e);
    if (status == MPS_OK && run.frames == 0)
        status = mps__page_fail(&e, MPS_E_ARG, "no film: the folder '%s' has no frame", folder);
    if (status == MPS_OK) status = mps__film_survey(&f, &run);
    char *place = mps__page_path(folder, "film.mp4");
    if (!path) path = place;
    if (status == MPS_OK && !place)
        status = mps__page_fail(&e, MPS_E_NOMEM, "no memory for a film");
    if (status == MPS_OK && path) status = make(&f, config, path, &e);
    free(place);
    mps__film_free(&f);
    mps__page_run_free(&run);
    return status;
}

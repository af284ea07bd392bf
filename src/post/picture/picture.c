/* SPDX-License-Identifier: BSD-3-Clause */
/* Public functions of pictures. */
#include "picture_canvas.h"
#include "picture_scene.h"
#include <math.h>
#include <string.h>

mps_status mps_picture_config_init(mps_picture_config *config, size_t size)
{
    if (!config) return MPS_E_ARG;
    if (size != sizeof *config) return MPS_E_VERSION;
    *config = (mps_picture_config){
        .struct_size = (uint32_t)size, .width = 1280, .gravity = 9.81, .sensors = 1};
    return MPS_OK;
}

/* Set up error texts, and check the arguments. */
static mps_status check(const mps_picture_config *config, const char *path, page_errors *e)
{
    *e = (page_errors){NULL, 0};
    if (!config || config->struct_size != sizeof *config) return MPS_E_ARG;
    *e = (page_errors){config->error, config->error_size};
    if (e->text && e->size > 0) e->text[0] = '\0';
    if (!path || !path[0]) return mps__page_fail(e, MPS_E_ARG, "the picture has no file name");
    if (config->width < 400 || config->width > 4000)
        return mps__page_fail(e, MPS_E_ARG, "picture: width is %d, must be 400..4000",
                              (int)config->width);
    if (!(config->gravity >= 0) || !isfinite(config->gravity))
        return mps__page_fail(e, MPS_E_ARG, "picture: gravity is %g m/s2, must be >= 0",
                              config->gravity);
    if (!isfinite(config->pressure_lo) || !isfinite(config->pressure_hi))
        return mps__page_fail(e, MPS_E_ARG, "picture: pressure_lo and pressure_hi must be finite");
    if (config->edge_count < 0 || (config->edge_count > 0 && !config->edges))
        return mps__page_fail(e, MPS_E_ARG, "picture: edge_count is %d, must be >= 0, with edges",
                              (int)config->edge_count);
    return MPS_OK;
}

/* Edges of the tank given in the config. */
static bool take_edges(scene *s, const mps_picture_config *config)
{
    if (config->edge_count <= 0) return true;
    if (!mps__scene_edges(s, config->edge_count)) return false;
    memcpy(s->edge, config->edges, 6 * (size_t)config->edge_count * sizeof *s->edge);
    return true;
}

/* Draw and write what a scene has. */
static mps_status save(scene *s, mps_picture_config *config, const char *path, page_errors *e)
{
    canvas c;
    if (!config->sensors) s->sensors = 0;
    if (config->title) snprintf(s->title, sizeof s->title, "%s", config->title);
    if (!mps__scene_end(s))
        return mps__page_fail(e, MPS_E_ARG, "no picture '%s': there is no particle", path);
    if (!mps__scene_scale(s, config) || !take_edges(s, config))
        return mps__page_fail(e, MPS_E_NOMEM, "no memory for the picture '%s'", path);
    mps_status status = mps__scene_draw(s, config->width, &c, e);
    if (status != MPS_OK) return status;
    status = mps__canvas_save(&c, path, e);
    mps__canvas_destroy(&c);
    return status;
}

mps_status mps_picture_save(mps_sim *sim, mps_picture_config *config, const char *path)
{
    page_errors e;
    scene s;
    mps_status status = check(config, path, &e);
    if (status != MPS_OK) return status;
    status = mps__scene_of_sim(&s, sim, &e);
    if (status == MPS_OK) status = save(&s, config, path, &e);
    mps__scene_free(&s);
    return status;
}

mps_status mps__scene_rehearse(mps_sim *sim)
{
    page_errors e = {NULL, 0};
    mps_picture_config config;
    scene s;
    canvas c;
    mps_picture_config_init(&config, sizeof config);
    mps_status status = mps__scene_of_sim(&s, sim, &e);
    if (status == MPS_OK && !mps__scene_end(&s)) status = MPS_E_ARG;
    if (status == MPS_OK && !mps__scene_scale(&s, &config)) status = MPS_E_NOMEM;
    if (status == MPS_OK) status = mps__scene_draw(&s, config.width, &c, &e);
    if (status == MPS_OK) mps__canvas_destroy(&c);
    mps__scene_free(&s);
    return status;
}

/* Gravity and scale of the folder, if the config has none. */
static void complete(mps_picture_config *config, const film *f)
{
    const double gravity = mps__page_number(f->run, "gravity");
    if (gravity >= 0) config->gravity = gravity;
    if (config->pressure_hi > config->pressure_lo) return;
    config->pressure_lo = f->pressure.lo;
    config->pressure_hi = f->pressure.hi;
}

/* Write frame number `k` of a folder that was read. */
static mps_status save_frame(const film *f, int64_t k, mps_picture_config *config, const char *path,
                             page_errors *e)
{
    film_frame frame = {0};
    scene s;
    mps_status status = mps__scene_of_run(&s, f);
    if (status == MPS_OK) status = mps__film_frame_read(f, k, &frame);
    if (status == MPS_OK) status = mps__scene_of_frame(&s, f, k, &frame);
    mps__film_frame_free(&frame);
    complete(config, f);
    if (status == MPS_OK) status = save(&s, config, path, e);
    mps__scene_free(&s);
    return status;
}

mps_status mps_picture_frame_save(const char *folder, int64_t frame, mps_picture_config *config,
                                  const char *path)
{
    page_errors e;
    page_run run = {0};
    film f = {0};
    mps_status status = check(config, path, &e);
    if (status != MPS_OK) return status;
    if (!folder || !folder[0]) return mps__page_fail(&e, MPS_E_ARG, "the picture has no folder");
    status = mps__page_run_read(&run, folder, &e);
    if (status == MPS_OK && (frame < -1 || frame >= run.frames || run.frames == 0))
        status = mps__page_fail(&e, MPS_E_ARG,
                                "no picture: frame %lld of the folder '%s', which has %lld",
                                (long long)frame, folder, (long long)run.frames);
    if (status == MPS_OK) status = mps__film_survey(&f, &run);
    if (status == MPS_OK)
        status = save_frame(&f, frame < 0 ? run.frames - 1 : frame, config, path, &e);
    mps__film_free(&f);
    mps__page_run_free(&run);
    return status;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Builds a simulation and a job from a case. */
#include "ship_motion.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TIMES_MOST = 24, PAGE_LEAST = 500000 /* bytes, of mps_page_write() */ };

/* A part of the case has failed. Read the parts that do not depend on it too, so that their errors
 * are reported in the same run. If the first period is not known, it is taken as 1 s, which no
 * message shows.
 * @param done  parts that were built, the last of which failed */
static void report_others(build *b, size_t done)
{
    static void (*const other[])(build *) = {mps__build_motion, mps__build_body, mps__build_time,
                                             mps__build_sensors, mps__build_references};
    /* number of parts of the list below done before */
    static const size_t before[] = {6, 7, 8, 2, 0};
    const read_scale scale = {b->dp, b->modes.count > 0 ? b->modes.period[0] : 1, NAN};
    for (size_t k = 0; k < sizeof other / sizeof *other && b->status == MPS_OK; k++) {
        const bool sensors = other[k] == mps__build_sensors;
        if (sensors ? done <= before[k] : before[k] && done >= before[k]) continue;
        mps__case_continue(b->c, true);
        mps__case_scale_set(b->c, scale);
        other[k](b);
    }
    mps__case_continue(b->c, false);
}

/* An amplitude of kilometres in a tank of metres is usually a wrong unit; a tank in translation
 * starts with its liquid at its speed. */
static void warn_amplitudes(build *b)
{
    const form *t = &b->tank.form;
    const build_motion *m = b->motion;
    const tree_node *map = mps__tree_find(b->root, "motion");
    const double size = fmax(t->hi[0] - t->lo[0], fmax(t->hi[1] - t->lo[1], t->hi[2] - t->lo[2]));
    for (int32_t d = 0; m && map && d < MOTION_DEGREES; d++) {
        const tree_node *at = mps__tree_find(map, mps__degrees[d]);
        const bool turn = d >= MPS_SHIP_ROLL;
        const double most = m->largest[d][0], limit = turn ? acos(-1.0) : 10 * size;
        if (!m->used[d] || !(most > limit) || m->start == MPS_START_WITH_TANK) continue;
        if (!at) at = mps__tree_find(map, "file");
        if (turn)
            mps__case_log(b->c, at ? at : map, true, "motion: %s of %.3g deg; is its unit right?",
                          mps__degrees[d], most * 180 / acos(-1.0));
        else
            mps__case_log(b->c, at ? at : map, true,
                          "motion: %s of %.6g m, %.2g times the size of the tank, %.3g m; is its "
                          "unit right?",
                          mps__degrees[d], most, most / size, size);
    }
}

/* All steps before the job: its end may be in units of T1, which the filled liquid determines. */
/* A page has a least size. */
static void check_page(build *b)
{
    const tree_node *node = mps__tree_find(mps__tree_find(b->root, "output"), "page");
    const double page = mps__read_number(b->c, node ? node->parent : NULL, "page", 0);
    if (page > 0 && page < PAGE_LEAST)
        mps__case_log(b->c, node, false,
                      "output.page: %g kB is too small, must be 500 kB or more, or 0: no page",
                      page / 1e3);
}

void mps__build_simulation(build *b, const mps_job_config *options)
{
    static void (*const part[])(build *) = {mps__build_tank,  mps__build_solids, mps__build_phases,
                                            mps__build_fills, mps__build_modes,  mps__build_motion,
                                            mps__build_body,  mps__build_time,   mps__motion_start};
    b->root = mps__case_root(b->c);
    b->dim = (int32_t)mps__read_number(b->c, b->root, "dim", 2);
    mps__case_scale_set(b->c, (read_scale){NAN, NAN, NAN});
    b->dp = mps__read_number(b->c, b->root, "dp", NAN);
    mps__case_scale_set(b->c, (read_scale){b->dp, NAN, NAN});
    b->gravity = mps__read_number(b->c, b->root, "gravity", 9.81);
    b->level = b->depth = NAN;
    const tree_node *plugins = mps__tree_find(b->root, "plugins");
    mps__read_all(plugins);
    if (mps__plugins_missing(b->c, b->root))
        mps__case_log(
            b->c, plugins, false,
            "plugins: they were not loaded when the case was read; mps_case_open() has an "
            "option for it");
    check_page(b);
    if (!mps__case_failed(b->c)) mps__build_fluids_read(b);
    if (!mps__case_failed(b->c)) mps__build_open(b, options);
    size_t i = 0, count = sizeof part / sizeof *part;
    for (; i < count && b->sim && b->status == MPS_OK && !mps__case_failed(b->c); i++) part[i](b);
    if (b->sim && b->status == MPS_OK && mps__case_failed(b->c)) report_others(b, i);
    if (!mps__case_failed(b->c)) warn_amplitudes(b);
}

/* The cross-section of a form in the plane x, y, if it is one line. */
static int32_t outline_of(const form *t, double (*xy)[2])
{
    int32_t count = 0;
    if (t->kind == FORM_POLYGON && !t->sideways) {
        count = t->points;
        memcpy(xy, t->point, sizeof t->point);
    } else if (t->kind == FORM_BALL) {
        for (; count < FORM_POINTS; count++) {
            const double angle = 2 * acos(-1.0) * count / FORM_POINTS;
            xy[count][0] = t->end[0][0] + t->radius * cos(angle);
            xy[count][1] = t->end[0][1] + t->radius * sin(angle);
        }
    } else if (t->kind == FORM_BOX) {
        const double corner[4][2] = {
            {t->lo[0], t->lo[1]}, {t->hi[0], t->lo[1]}, {t->hi[0], t->hi[1]}, {t->lo[0], t->hi[1]}};
        count = 4;
        memcpy(xy, corner, sizeof corner);
    }
    if (count > 0) memcpy(xy[count++], xy[0], sizeof xy[0]); /* closed */
    return count;
}

/* The parts of a plate between its slots, from one end to the other, as built. */
static void add_plate_outline(build *b, const build_solid *s)
{
    double part[2], xy[2][2];
    for (int32_t i = 0; i <= s->slots; i++) {
        mps__solid_piece(s, i, part);
        for (int end = 0; end < 2; end++)
            for (int d = 0; d < 2; d++)
                xy[end][d] = s->end[0][d] + part[end] * (s->end[1][d] - s->end[0][d]);
        mps__build_try_job(b, mps_job_outline_add(b->job, 2, &xy[0][0]), b->root, s->name);
    }
}

/* Tank and solids for the page. The box of a file is not drawn. */
static void add_outlines(build *b)
{
    double xy[FORM_POINTS + 1][2];
    int32_t count = b->tank.file ? 0 : outline_of(&b->tank.form, xy);
    if (count > 0)
        mps__build_try_job(b, mps_job_outline_add(b->job, count, &xy[0][0]), b->tank.at, "tank");
    for (int32_t i = 0; i < b->solids; i++) {
        const build_solid *s = &b->solid[i];
        count = s->file || s->plate ? 0 : outline_of(&s->form, xy);
        if (s->plate) add_plate_outline(b, s);
        if (count > 0)
            mps__build_try_job(b, mps_job_outline_add(b->job, count, &xy[0][0]), b->root, s->name);
    }
}

/* Statistics are computed from the folder of the run, sweeps by the program. */
static void build_columns(build *b)
{
    static const char *const others[] = {"mps",   "title",   "base",  "set",
                                         "sweep", "collect", "output"};
    char path[PATH_CAPACITY];
    mps__motion_columns(b);
    mps__body_columns(b);
    mps__build_sensors(b);
    if (mps__case_failed(b->c)) mps__case_continue(b->c, true);
    mps__build_references(b);
    mps__case_continue(b->c, false);
    mps__build_inputs(b);
    if (b->job && mps__build_filled(b))
        mps__build_try_job(b, mps_job_level_set(b->job, b->level), b->root, "fill");
    if (b->job) add_outlines(b);
    mps__build_edges(b);
    for (int32_t k = 0; b->job && k < b->c->plugins; k++)
        mps__build_try_job(b, mps_job_plugin_add(b->job, b->c->plugin[k].file), b->root, "plugins");
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        mps__read_all(mps__tree_find(b->root, others[i]));
    const tree_node *unread = mps__case_failed(b->c) ? NULL : mps__case_unread(b->c);
    if (unread)
        mps__case_log(b->c, unread, false, "'%s' has no effect here; remove it",
                      mps__tree_path(unread, path, sizeof path));
}

/* Whether a level is requested by `depth`; otherwise the job uses that of the highest particle. */
bool mps__build_filled(const build *b)
{
    return !isnan(b->depth);
}

/* Extract "surge" from "cases/surge.yaml". */
static void name_of(const mps_case *c, char *name, size_t size)
{
    const char *path = c->source[0].name, *slash = strrchr(path, '/');
    const char *begin = slash ? slash + 1 : path, *dot = strrchr(begin, '.');
    snprintf(name, size, "%.*s", (int)(dot ? dot - begin : (int)strlen(begin)), begin);
}

/* The preset and what is changed in it. */
static void model_of(const build *b, char *text, size_t size)
{
    static const char *const key[] = {"use", "remove", "settings"};
    size_t used = (size_t)snprintf(text, size, "%s", b->model);
    for (int i = 0; i < 3; i++) {
        const tree_node *node = mps__tree_find(b->root, key[i]);
        const bool one = node && node->kind == TREE_TEXT;
        for (const tree_node *at = node ? (one ? node : node->first) : NULL; at && used < size;
             at = one ? NULL : at->next)
            used += (size_t)snprintf(text + used, size - used, ", %s %s%s%s", key[i],
                                     at->key && !one ? at->key : "", at->key && !one ? " " : "",
                                     at->text ? at->text : "");
    }
}

/* Number of frames that resolves a period, within the space of the page: a particle takes about so
 * many bytes of a frame. */
static int32_t default_frames(const build *b, double page)
{
    static const double A_PERIOD = 20, LEAST = 50, MOST = 2000, BYTES[4] = {0, 0, 3.6, 5},
                        SHARE = 0.7;
    const double omega = mps__build_omega(b),
                 count = (double)mps_particles_count(b->sim, MPS_FLUID);
    const double period = isfinite(omega)      ? 2 * acos(-1.0) / omega
                          : b->modes.count > 0 ? b->modes.period[0]
                                               : INFINITY;
    const double space = SHARE * page / (BYTES[b->dim] * fmax(count, 1));
    const double wanted = ceil(A_PERIOD * b->until / period - 1e-6);
    return (int32_t)fmax(fmin(fmin(wanted, space), MOST), LEAST);
}

/* Merge options of the program and values of the case. */
static void read_config(build *b, mps_job_config *out, double *times)
{
    const tree_node *run = mps__tree_find(b->root, "run"),
                    *output = mps__tree_find(b->root, "output");
    mps_job_config config = *out;
    config.title = mps__read_text(b->c, b->root, "title", config.title);
    config.text = mps_case_text(b->c);
    config.t_end = b->until;
    config.gravity = b->gravity;
    config.dp = b->dp;
    const double rate = mps__read_number(b->c, output, "rate", 0);
    if (rate > 0) config.row_interval = 1 / rate;
    config.checkpoint = mps__read_number(b->c, run, "checkpoint", config.checkpoint);
    config.checkpoint_clock = mps__read_number(b->c, run, "checkpoint_clock",
                                               config.checkpoint_clock);
    config.average = mps__read_number(b->c, run, "average", config.average);
    config.peaks = (int32_t)mps__read_number(b->c, output, "peaks", config.peaks);
    config.picture_count = mps__read_numbers(b->c, output, "pictures", TIMES_MOST, times);
    config.picture_t = times;
    config.tank_frame = mps__read_choice(b->c, output, "frame", 0) == 1;
    config.pieces = mps__read_flag(b->c, output, "pieces", config.pieces);
    config.profile = config.profile || mps__read_flag(b->c, output, "profile", false);
    config.film = config.film || mps__read_flag(b->c, output, "film", false);
    config.trace = config.trace || mps__read_flag(b->c, output, "trace", false);
    config.threads = (int32_t)mps__read_number(b->c, run, "threads", 2);
    const double page = mps__read_number(b->c, output, "page", (double)config.page_bytes);
    const double space = page > 0 ? page : (double)config.page_bytes; /* independent of the page */
    b->frames = (int32_t)mps__read_number(b->c, output, "frames", default_frames(b, space));
    config.frames = b->frames;
    config.page_bytes = (int64_t)page;
    if (config.page_bytes == 0) config.report = 0;
    *out = config;
}

static mps_status create_job(build *b, const mps_job_config *options)
{
    double times[TIMES_MOST];
    char name[BUILD_TEXT], model[2 * BUILD_TEXT];
    mps_job_config config = *options;
    name_of(b->c, name, sizeof name);
    model_of(b, model, sizeof model);
    config.name = config.name ? config.name : name;
    config.model = model;
    read_config(b, &config, times);
    return mps__case_failed(b->c) ? MPS_E_ARG : mps_job_create(&config, &b->job);
}

/* Log through the job what the library logged before. */
static void add_log(build *b)
{
    b->log->job = b->job;
    for (int32_t i = 0; i < b->log->count; i++)
        mps_job_log(b->job, b->log->level[i], b->log->text[i]);
}

static build *begin(mps_case *c)
{
    build *b = calloc(1, sizeof *b);
    if (b) b->c = c;
    return b;
}

mps_status mps_case_job(mps_case *c, const mps_job_config *options, mps_job **job, mps_sim **sim)
{
    if (job) *job = NULL;
    if (sim) *sim = NULL;
    if (!c || !options || !job || !sim || mps__case_failed(c)) return MPS_E_ARG;
    const mps_status resumed = mps__build_resumed(c, options);
    if (resumed != MPS_OK) return resumed;
    build *b = begin(c);
    if (!b) return MPS_E_NOMEM;
    mps__build_simulation(b, options);
    mps_status status = b->status;
    if (status == MPS_OK) status = mps__case_failed(c) ? MPS_E_ARG : create_job(b, options);
    if (status == MPS_OK) {
        add_log(b);
        build_columns(b);
        status = b->status < 0 ? b->status : mps__case_failed(c) ? MPS_E_ARG : MPS_OK;
    }
    if (c->no_memory) status = MPS_E_NOMEM;
    if (status == MPS_OK) {
        *job = b->job;
        *sim = b->sim;
    } else {
        mps_sim_destroy(b->sim);
        mps_job_destroy(b->job);
    }
    free(b);
    return status;
}

mps_status mps_case_cost_get(const mps_case *c, mps_case_cost *cost)
{
    if (!c || !cost || cost->struct_size != sizeof *cost) return MPS_E_ARG;
    if (c->cost.struct_size == 0) return MPS_E_STATE;
    *cost = c->cost;
    return MPS_OK;
}

mps_status mps_case_check(mps_case *c, char **text, char **sketch)
{
    if (text) *text = NULL;
    if (sketch) *sketch = NULL;
    if (!c || mps__case_failed(c)) return MPS_E_ARG;
    build *b = begin(c);
    if (!b) return MPS_E_NOMEM;
    mps__build_simulation(b, NULL);
    if (b->sim && b->status == MPS_OK && !mps__case_failed(c)) {
        double times[TIMES_MOST];
        mps_job_config config;
        mps_job_config_init(&config, sizeof config);
        read_config(b, &config, times);
        build_columns(b);
    }
    mps_status status = b->status < 0 ? b->status : mps__case_failed(c) ? MPS_E_ARG : MPS_OK;
    if (status == MPS_OK && sketch && !(*sketch = mps__sketch_write(b))) status = MPS_E_NOMEM;
    if (status == MPS_OK && text && !(*text = mps__check_write(b))) status = MPS_E_NOMEM;
    if (c->no_memory || b->status == MPS_E_NOMEM)
        status = MPS_E_NOMEM;
    else if (status == MPS_OK && mps__case_failed(c)) /* in its first steps */
        status = MPS_E_ARG;
    if (status != MPS_OK) {
        if (sketch) free(*sketch);
        if (text) free(*text);
        if (sketch) *sketch = NULL;
        if (text) *text = NULL;
    }
    mps_sim_destroy(b->sim);
    free(b);
    return status;
}

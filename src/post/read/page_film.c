/* SPDX-License-Identifier: BSD-3-Clause */
/* Reads all frames of a run once: moving particles, motion of the tank, bounds and colour
 * scales. */
#include "page_film.h"
#include "grow.h"
#include "page_pose.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SAMPLE = 4096 }; /* values of a frame for the scales */

static mps_status no_memory(const film *f)
{
    return mps__page_fail(f->run->errors, MPS_E_NOMEM, "no memory for the film of the page");
}

/* ---- a frame --------------------------------------------------------------------------------- */

void mps__film_frame_free(film_frame *s)
{
    free(s->buffer);
    free(s->parts);
    *s = (film_frame){0};
}

static bool reserve_frame(film_frame *s, int64_t count)
{
    s->count = count;
    if (count > s->capacity || !s->buffer) {
        double *more = realloc(s->buffer, (size_t)(count + 1) * 12 * sizeof *more);
        if (!more) return false;
        s->buffer = more;
        s->capacity = count + 1;
    }
    double *next = s->buffer;
    s->x = next;
    s->u = next += 3 * s->capacity;
    s->p = next += 3 * s->capacity;
    s->kind = next += s->capacity;
    s->phase = next += s->capacity;
    s->part = next += s->capacity;
    s->id = next += s->capacity;
    s->pocket = next + s->capacity;
    memset(s->pocket, 0, (size_t)count * sizeof *s->pocket); /* most frames have none */
    return true;
}

static mps_status frame_fill(const film *f, const vtp_frame *v, film_frame *s)
{
    const struct {
        const char *name;
        int32_t width;
        double *out;
    } array[] = {{"position", 3, s->x}, {"velocity", 3, s->u},  {"pressure", 1, s->p},
                 {"kind", 1, s->kind},  {"phase", 1, s->phase}, {"part", 1, s->part},
                 {"id", 1, s->id}};
    mps_status status = MPS_OK;
    for (int k = 0; status == MPS_OK && k < 7; k++) {
        if (mps__vtp_width(v, array[k].name) != array[k].width)
            return mps__page_fail(f->run->errors, MPS_E_IO, "frame '%s' has no '%s' of %d numbers",
                                  v->piece[0].path, array[k].name, (int)array[k].width);
        status = mps__vtp_read(v, array[k].name, array[k].out);
    }
    if (status == MPS_OK && mps__vtp_width(v, "pocket") == 1) /* only with the model gas.pocket */
        status = mps__vtp_read(v, "pocket", s->pocket);
    return status;
}

mps_status mps__film_frame_read(const film *f, int64_t k, film_frame *out)
{
    vtp_frame v;
    mps_status status = mps__vtp_open(&v, f->run, f->run->frame[k].path);
    if (status != MPS_OK) return status;
    if (!reserve_frame(out, v.points)) status = no_memory(f);
    if (status == MPS_OK) status = frame_fill(f, &v, out);
    free(out->parts);
    out->parts = v.parts;
    v.parts = NULL;
    mps__vtp_close(&v);
    return status;
}

/* ---- indices by id --------------------------------------------------------------------------- */

static int compare_entries(const void *a, const void *b)
{
    const film_entry *x = a, *y = b;
    return (x->id > y->id) - (x->id < y->id);
}

int64_t mps__film_find(const film_index *index, double id)
{
    const film_entry key = {.id = (int64_t)id};
    if (index->sorted == 0) return -1;
    const film_entry *found = bsearch(&key, index->entry, (size_t)index->sorted, sizeof key,
                                      compare_entries);
    return found ? found->place : -1;
}

static bool index_add(film_index *index, double id)
{
    film_entry *more = mps__grown(index->entry, index->count, sizeof *more);
    if (!more) return false;
    index->entry = more;
    index->entry[index->count] = (film_entry){(int64_t)id, index->count};
    index->count++;
    return true;
}

static void index_sort(film_index *index)
{
    if (index->sorted == index->count) return;
    qsort(index->entry, (size_t)index->count, sizeof *index->entry, compare_entries);
    index->sorted = index->count;
}

/* ---- the survey ------------------------------------------------------------------------------ */

static void take_bounds(film *f, const double X[3])
{
    for (int d = 0; d < 3; d++) {
        f->lo[d] = fmin(f->lo[d], X[d]);
        f->hi[d] = fmax(f->hi[d], X[d]);
    }
}

static bool take_scales(film *f, const film_frame *s, int64_t i, bool sampled)
{
    const double *u = s->u + 3 * i, u2 = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    f->speed2 = fmax(f->speed2, u2);
    if ((int32_t)s->phase[i] >= f->phases) f->phases = (int32_t)s->phase[i] + 1;
    if (s->pocket[i] > f->pockets) f->pockets = (int32_t)fmin(s->pocket[i], POCKETS_MOST);
    f->pressure.most = fmax(f->pressure.most, s->p[i]);
    return !sampled ||
           (mps__scale_take(&f->pressure, s->p[i]) && mps__scale_take(&f->speed, sqrt(u2)));
}

static mps_status add_phase(film *f, double phase)
{
    unsigned char *more = mps__grown(f->phase, f->moving.count, 1);
    if (!more) return no_memory(f);
    f->phase = more;
    f->phase[f->moving.count] = (unsigned char)phase;
    return MPS_OK;
}

static mps_status take_moving(film *f, double id, double phase)
{
    mps_status status = add_phase(f, phase);
    if (status == MPS_OK && !index_add(&f->moving, id)) status = no_memory(f);
    return status;
}

/* Find the parts of the tank itself by their names; other parts are solids inside it. */
static void take_tank_parts(film *f, const film_frame *s)
{
    int number = 0;
    for (const char *name = s->parts; name && *name && number < FILM_PARTS;
         name += strlen(name) + 1, number++)
        f->part_of_tank[number] = strncmp(name, "tank", 4) == 0;
}

/* Take the walls of the first frame. */
static mps_status take_walls(film *f, const film_frame *s)
{
    int64_t count = 0;
    if (!s->kind || !s->x) return MPS_OK; /* an empty frame */
    take_tank_parts(f, s);
    for (int64_t i = 0; i < s->count; i++) count += (int)s->kind[i] == FILM_WALL;
    f->wall_x = malloc((size_t)(count + 1) * 3 * sizeof *f->wall_x);
    f->wall_part = malloc((size_t)(count + 1) * sizeof *f->wall_part);
    if (!f->wall_x || !f->wall_part) return no_memory(f);
    for (int64_t i = 0; i < s->count; i++) {
        if ((int)s->kind[i] != FILM_WALL) continue;
        mps__film_to_tank(&f->start, s->x + 3 * i, f->wall_x + 3 * f->wall.count);
        f->wall_part[f->wall.count] = s->part[i];
        if (!index_add(&f->wall, s->id[i])) return no_memory(f);
    }
    index_sort(&f->wall);
    return MPS_OK;
}

/* A part whose walls move relative to the tank is a free body. */
static void check_wall(film *f, const film_frame *s, int64_t i, const double X[3])
{
    const int64_t place = mps__film_find(&f->wall, s->id[i]);
    const int part = s->part[i] >= 0 && s->part[i] < FILM_PARTS ? (int)s->part[i] : 0;
    if (place < 0) return;
    double far = 0;
    for (int d = 0; d < 3; d++) far = fmax(far, fabs(X[d] - f->wall_x[3 * place + d]));
    if (far > 0.05 * f->dp) f->part_moves[part] = true;
    if (f->part_moves[part]) take_bounds(f, X);
}

static mps_status survey_frame(film *f, const film_frame *s, const film_pose *pose)
{
    int64_t fluid = 0, seen = 0;
    mps_status status = MPS_OK;
    for (int64_t i = 0; i < s->count; i++) fluid += (int)s->kind[i] == FILM_FLUID;
    const int64_t each = fluid / SAMPLE + 1;
    for (int64_t i = 0; status == MPS_OK && i < s->count; i++) {
        double X[3];
        if (!isfinite(s->x[3 * i] + s->x[3 * i + 1] + s->x[3 * i + 2])) continue;
        mps__film_to_tank(pose, s->x + 3 * i, X);
        if ((int)s->kind[i] == FILM_WALL) check_wall(f, s, i, X);
        if ((int)s->kind[i] != FILM_FLUID) continue;
        take_bounds(f, X);
        if (!take_scales(f, s, i, seen++ % each == 0)) status = no_memory(f);
        if (status == MPS_OK && mps__film_find(&f->moving, s->id[i]) < 0)
            status = take_moving(f, s->id[i], s->phase[i]);
    }
    index_sort(&f->moving);
    return status;
}

/* Walls of free bodies are moving particles. */
static mps_status take_bodies(film *f)
{
    mps_status status = MPS_OK;
    const int64_t walls = f->wall.count;
    for (int64_t k = 0; status == MPS_OK && k < walls; k++) {
        const double part = f->wall_part[f->wall.entry[k].place];
        if (part < 0 || part >= FILM_PARTS || !f->part_moves[(int)part]) continue;
        status = take_moving(f, (double)f->wall.entry[k].id, FILM_BODY);
    }
    index_sort(&f->moving);
    return status;
}

/* Whether the frame of the tank differs from that of the lab. */
static bool is_moved(const film_pose *a, double dp)
{
    static const film_pose rest = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}};
    double most = 0;
    for (int k = 0; k < 9; k++) most = fmax(most, fabs(a->turn[k] - rest.turn[k]));
    for (int d = 0; d < 3; d++) most = fmax(most, fabs(a->shift[d] - rest.shift[d]) / dp);
    return most > 1e-4;
}

static mps_status survey_frames(film *f, film_frame *s)
{
    const page_run *r = f->run;
    mps_status status = MPS_OK;
    for (int64_t k = 0; status == MPS_OK && k < r->frames; k++) {
        status = mps__film_frame_read(f, k, s);
        if (status != MPS_OK) break;
        if (k == 0) {
            mps__pose_start(f);
            mps__pose_choose(f, s);
            status = take_walls(f, s);
        }
        if (status == MPS_OK && !mps__pose_find(f, s, &f->pose[k]))
            status = mps__page_fail(r->errors, MPS_E_IO, "frame '%s' lacks walls of the first one",
                                    r->frame[k].path);
        if (status == MPS_OK) status = survey_frame(f, s, &f->pose[k]);
        if (is_moved(&f->pose[k], f->dp)) f->tank_moves = true;
    }
    return status;
}

/* Use the scale of the pictures of the run, if the summary has it. */
static void take_given_scale(film *f)
{
    const json_value *list = mps__json_get(f->run->summary, "pressure_scale");
    const double lo = mps__json_number(mps__json_at(list, 0)),
                 hi = mps__json_number(mps__json_at(list, 1));
    if (!(hi > lo)) return;
    f->pressure.lo = lo;
    f->pressure.hi = hi;
}

mps_status mps__film_survey(film *f, const page_run *run)
{
    film_frame s = {0};
    const double gravity = mps__page_number(run, "gravity"), dim = mps__page_number(run, "dim");
    *f = (film){.run = run, .dim = dim == 3 ? 3 : 2, .dp = mps__page_number(run, "dp")};
    for (int d = 0; d < 3; d++) {
        f->lo[d] = INFINITY;
        f->hi[d] = -INFINITY;
    }
    if (run->frames == 0) return MPS_OK;
    if (!(f->dp > 0) || !(dim == 2 || dim == 3))
        return mps__page_fail(run->errors, MPS_E_IO, "'%s/summary.json': 'dp' or 'dim' is missing",
                              run->folder);
    f->pose = calloc((size_t)run->frames, sizeof *f->pose);
    if (!f->pose) return no_memory(f);
    mps_status status = survey_frames(f, &s);
    if (status == MPS_OK) status = take_bodies(f);
    mps__film_frame_free(&s);
    const double most = f->pressure.most;
    /* a thousandth of rho (g dp + u^2), with the density of water: smaller pressures are
     * rounding */
    const double g = isfinite(gravity) ? gravity : 9.81;
    mps__scale_end(&f->pressure, g * f->dp + f->speed2, f->phases > 1);
    mps__scale_end(&f->speed, 1e-6, false);
    take_given_scale(f);
    f->pressure.most = fmax(f->pressure.most, most);
    f->speed.most = fmax(f->speed.most, sqrt(f->speed2));
    return status;
}

void mps__film_free(film *f)
{
    free(f->moving.entry);
    free(f->wall.entry);
    free(f->phase);
    free(f->wall_x);
    free(f->wall_part);
    free(f->pose);
    free(f->pressure.sample);
    free(f->speed.sample);
    *f = (film){0};
}

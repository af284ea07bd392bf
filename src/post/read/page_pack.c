/* SPDX-License-Identifier: BSD-3-Clause */
/* Packs the film into the available bytes: first with all data of the frames, then with less. */
#include "page_film.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
    FINE = 12,
    COARSE = 10,
    WALL_BITS = 16,
    VALUES = 2, /* of every particle */
    WALLS_MOST = 20000,
    LEAST_SHOWN = 4000,
    BLOCKS = 24
};

/* Which data are packed. */
typedef struct plan {
    int32_t bits;
    bool coarse;   /* values in steps of four codes */
    int64_t every; /* every n-th particle */
    int64_t step;  /* every n-th frame; frames about peaks are all shown */
    bool peaks;    /* show frames about peaks */
} plan;

/* A film being packed. */
typedef struct packing {
    const film *film;
    plan plan;
    int64_t shown;         /* particles */
    int64_t frames, *pick; /* of the film: [frames] numbers in the run */
    /* frames per block; the first block has one, so that the first picture is shown immediately */
    int64_t block;
    double quantum; /* [m] */
    codec codec;
    uint16_t *q;          /* [dim*shown] */
    unsigned char *value; /* [values*shown] */
    int32_t values;       /* pressure, speed, and the pocket if there is one */
    film_frame frame;
    FILE *out;
    int64_t bytes, most, done; /* of base64; frames */
} packing;

static mps_status no_memory(const film *f)
{
    return mps__page_fail(f->run->errors, MPS_E_NOMEM, "no memory for the film of the page");
}

static int64_t base64_size(size_t bytes)
{
    return (int64_t)(bytes + 2) / 3 * 4;
}

static unsigned char value_code(const packing *p, const page_scale *scale, double value)
{
    const unsigned char code = mps__scale_code(scale, value);
    return p->plan.coarse ? (unsigned char)(1 + (code - 1) / 4 * 4) : code;
}

/* Quantise all particles of the frame that was read; missing ones keep their position, with values
 * 0. */
static void quantise(packing *p, const film_pose *pose)
{
    const film *f = p->film;
    const film_frame *s = &p->frame;
    const double top = (double)((1 << p->plan.bits) - 1);
    memset(p->value, 0, (size_t)p->values * (size_t)p->shown);
    for (int64_t i = 0; i < s->count; i++) {
        const int64_t place = mps__film_find(&f->moving, s->id[i]), at = place / p->plan.every;
        const double *x = s->x + 3 * i, *u = s->u + 3 * i;
        double X[3];
        if (place < 0 || place % p->plan.every != 0 || !isfinite(x[0] + x[1] + x[2])) continue;
        mps__film_to_tank(pose, x, X);
        for (int32_t d = 0; d < f->dim; d++)
            p->q[d * p->shown + at] = (uint16_t)fmin(fmax((X[d] - f->lo[d]) / p->quantum + 0.5, 0),
                                                     top);
        p->value[at] = value_code(p, &f->pressure, s->p[i]);
        p->value[p->shown + at] = value_code(p, &f->speed,
                                             sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]));
        if (p->values > VALUES)
            p->value[VALUES * p->shown + at] = (unsigned char)fmin(fmax(s->pocket[i], 0),
                                                                   POCKETS_MOST);
    }
}

static void write_block(packing *p, const codec_bytes *bytes, int64_t frames, const char *kind)
{
    fprintf(p->out,
            "<script type=\"application/octet-stream\" class=\"film-%s\" data-frames=\"%d\">", kind,
            (int)frames);
    mps__codec_base64(p->out, bytes);
    fputs("</script>\n", p->out);
    p->bytes += base64_size(bytes->size) + 90;
}

static mps_status pack_frames(packing *p)
{
    codec_bytes bytes = {0};
    mps_status status = MPS_OK;
    int64_t in_block = 0;
    for (int64_t k = 0; status == MPS_OK && k < p->frames && p->bytes <= p->most; k++) {
        status = mps__film_frame_read(p->film, p->pick[k], &p->frame);
        if (status != MPS_OK) break;
        quantise(p, &p->film->pose[p->pick[k]]);
        if (!mps__codec_frame(&p->codec, p->q, p->value, &bytes)) status = no_memory(p->film);
        p->done = k + 1;
        if (++in_block < (k == 0 ? 1 : p->block) && p->done < p->frames) continue;
        if (!mps__codec_end(&p->codec, &bytes)) status = no_memory(p->film);
        if (status == MPS_OK) write_block(p, &bytes, in_block, "block");
        bytes.size = 0;
        in_block = 0;
    }
    free(bytes.data);
    return status;
}

/* ---- fixed parts ----------------------------------------------------------------------------- */

/* The ids of the shown particles as little-endian integers of four bytes. */
static mps_status pack_ids(packing *p)
{
    const film *f = p->film;
    codec_bytes bytes = {0};
    unsigned char *four = calloc((size_t)p->shown + 1, 5);
    if (!four) return no_memory(f);
    unsigned char *phase = four + 4 * p->shown;
    for (int64_t k = 0; k < f->moving.count; k++) {
        const film_entry *e = &f->moving.entry[k];
        if (e->place % p->plan.every != 0) continue;
        for (int b = 0; b < 4; b++)
            four[4 * (e->place / p->plan.every) + b] = (unsigned char)((uint64_t)e->id >> 8 * b);
        phase[e->place / p->plan.every] = f->phase[e->place];
    }
    const bool done = mps__codec_pack(four, (size_t)p->shown * 5, &bytes);
    free(four);
    if (done) write_block(p, &bytes, 0, "ids");
    free(bytes.data);
    return done ? MPS_OK : no_memory(f);
}

static bool wall_stands(const film *f, int64_t place)
{
    const double part = f->wall_part[place];
    return part < 0 || part >= FILM_PARTS || !f->part_moves[(int)part];
}

static bool wall_of_tank(const film *f, int64_t place)
{
    const double part = f->wall_part[place];
    return part >= 0 && part < FILM_PARTS && f->part_of_tank[(int)part];
}

/* Bounds of the fixed walls. @return their number */
static int64_t wall_bounds(const film *f, double lo[3], double *quantum)
{
    double hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    int64_t count = 0;
    for (int d = 0; d < 3; d++) lo[d] = INFINITY;
    for (int64_t k = 0; k < f->wall.count; k++) {
        if (!wall_stands(f, k)) continue;
        count++;
        for (int d = 0; d < 3; d++) {
            lo[d] = fmin(lo[d], f->wall_x[3 * k + d]);
            hi[d] = fmax(hi[d], f->wall_x[3 * k + d]);
        }
    }
    *quantum = fmax(fmax(hi[0] - lo[0], hi[1] - lo[1]), hi[2] - lo[2]) / ((1 << WALL_BITS) - 1);
    if (!(*quantum > 0)) *quantum = 1;
    return count;
}

/* Fixed walls as one frame of the codec; value 1: walls of the tank itself; those of a wide tank
 * are thinned. */
static mps_status pack_walls(packing *p)
{
    const film *f = p->film;
    double lo[3], quantum;
    const int64_t all = wall_bounds(f, lo, &quantum), each = all / WALLS_MOST + 1;
    const int64_t count = (all + each - 1) / each;
    codec c;
    codec_bytes bytes = {0};
    uint16_t *q = calloc((size_t)(3 * count + 1), sizeof *q);
    unsigned char *value = calloc((size_t)(VALUES * count + 1), 1);
    bool done = mps__codec_create(&c, count, f->dim, VALUES, WALL_BITS) && q && value;
    for (int64_t k = 0, n = 0; done && k < f->wall.count; k++) {
        if (!wall_stands(f, k) || n++ % each != 0) continue;
        value[(n - 1) / each] = wall_of_tank(f, k);
        for (int32_t d = 0; d < f->dim; d++)
            q[d * count + (n - 1) / each] = (uint16_t)((f->wall_x[3 * k + d] - lo[d]) / quantum +
                                                       0.5);
    }
    done = done && mps__codec_frame(&c, q, value, &bytes) && mps__codec_end(&c, &bytes);
    mps__codec_free(&c);
    free(q);
    free(value);
    if (done) {
        fprintf(p->out,
                "<script type=\"application/json\" id=\"walls\">{\"count\": %lld, \"bits\": %d, "
                "\"lo\": [%.9g, %.9g, %.9g], \"quantum\": %.9g, \"every\": %lld}</script>\n",
                (long long)count, WALL_BITS, count ? lo[0] : 0, count ? lo[1] : 0,
                count && f->dim == 3 ? lo[2] : 0, quantum, (long long)each);
        write_block(p, &bytes, 1, "walls");
    }
    free(bytes.data);
    return done ? MPS_OK : no_memory(f);
}

static void write_scale(FILE *out, const char *name, const page_scale *s)
{
    fprintf(out, "\"%s\": {\"lo\": %.9g, \"hi\": %.9g, \"most\": %.9g},\n", name, s->lo, s->hi,
            s->most);
}

static void write_maps(FILE *out)
{
    fputs("\"maps\": [", out);
    for (int m = 0; m < SCALE_MAPS; m++) {
        fputs(m ? ", [" : "[", out);
        for (int k = 0; k < SCALE_COLOURS; k++) {
            const double *c = mps__scale_map[m][k];
            fprintf(out, "%s[%g, %g, %g]", k ? ", " : "", c[0], c[1], c[2]);
        }
        fputc(']', out);
    }
    fputs("],\n", out);
}

static void write_poses(FILE *out, const packing *p)
{
    fputs("\"poses\": [", out);
    for (int64_t k = 0; p->film->tank_moves && k < p->frames; k++) {
        const film_pose *pose = &p->film->pose[p->pick[k]];
        fputs(k ? ",\n[" : "\n[", out);
        for (int i = 0; i < 9; i++) fprintf(out, "%.6g, ", pose->turn[i]);
        fprintf(out, "%.6g, %.6g, %.6g]", pose->shift[0], pose->shift[1], pose->shift[2]);
    }
    fputs("]}", out);
}

/* Edges of the tank in 3-D. */
static void write_edges(FILE *out, const page_run *run)
{
    const json_value *list = mps__json_get(run->summary, "edges");
    fputs("\"edges\": [", out);
    for (size_t k = 0; k < 6 * mps__json_count(list); k++) {
        const double x = mps__json_number(mps__json_at(mps__json_at(list, k / 6), k % 6));
        fprintf(out, "%s%.6g", k ? ", " : "", isfinite(x) ? x : 0);
    }
    fputs("],\n", out);
}

/* Direction of the bow in the tank, for a ship in 3-D. */
static void write_bow(FILE *out, const film *f)
{
    static const struct {
        const char *name, *way;
    } ways[] = {{"x", "[1, 0, 0]"}, {"z", "[0, 0, 1]"}, {"-x", "[-1, 0, 0]"}, {"-z", "[0, 0, -1]"}};
    const char *bow = mps__page_input(f->run, "motion.forward");
    if (!bow) bow = mps__page_input(f->run, "body.forward");
    /* the default of the key */
    if (!bow && (mps__page_input(f->run, "motion.axes") || mps__page_input(f->run, "body.axes")))
        bow = "x";
    for (size_t k = 0; bow && f->dim == 3 && k < sizeof ways / sizeof *ways; k++)
        if (strcmp(ways[k].name, bow) == 0) fprintf(out, "\"bow\": %s,\n", ways[k].way);
}

static void write_head(const packing *p)
{
    const film *f = p->film;
    FILE *out = p->out;
    fprintf(out,
            "<script type=\"application/json\" id=\"film-data\">{\"dim\": %d, \"count\": %lld, "
            "\"all\": %lld, \"bits\": %d, \"every\": %lld, \"frames\": %lld,\n",
            (int)f->dim, (long long)p->shown, (long long)f->moving.count, (int)p->plan.bits,
            (long long)p->plan.every, (long long)p->frames);
    fprintf(out, "\"dp\": %.9g, \"quantum\": %.9g, \"phases\": %d, \"pockets\": %d,\n", f->dp,
            p->quantum, (int)f->phases, (int)f->pockets);
    fprintf(out, "\"lo\": [%.9g, %.9g, %.9g], \"hi\": [%.9g, %.9g, %.9g],\n", f->lo[0], f->lo[1],
            f->lo[2], f->hi[0], f->hi[1], f->hi[2]);
    write_scale(out, "pressure", &f->pressure);
    write_scale(out, "speed", &f->speed);
    write_maps(out);
    write_edges(out, f->run);
    write_bow(out, f);
    if (f->tank_moves || mps__json_true(mps__json_get(f->run->summary, "tank_frame")))
        fprintf(out, "\"speed_in\": \"%s\",\n",
                mps__json_true(mps__json_get(f->run->summary, "tank_frame")) ? "the tank"
                                                                             : "the lab");
    fputs("\"t\": [", out);
    for (int64_t k = 0; k < p->frames; k++)
        fprintf(out, "%s%.9g", k ? ", " : "", f->run->frame[p->pick[k]].t);
    fputs("],\n", out);
    write_poses(out, p);
    fputs("</script>\n", out);
}

/* ---- plans ----------------------------------------------------------------------------------- */

/* Numbers of the frames of a plan. @param pick  NULL: only count them */
static int64_t pick_frames(const film *f, const plan *how, int64_t *pick)
{
    int64_t count = 0, others = 0;
    for (int64_t k = 0; k < f->run->frames; k++) {
        const bool peak = f->run->frame[k].peak;
        if (peak ? !how->peaks : others++ % how->step != 0) continue;
        if (pick) pick[count] = k;
        count++;
    }
    return count;
}

static mps_status packing_create(packing *p, const film *f, const plan *how, FILE *out)
{
    double extent = 0;
    *p = (packing){.film = f, .plan = *how, .out = out};
    for (int32_t d = 0; d < f->dim; d++) extent = fmax(extent, f->hi[d] - f->lo[d]);
    p->quantum = extent > 0 ? extent / ((1 << how->bits) - 1) : 1;
    p->shown = (f->moving.count + how->every - 1) / how->every;
    p->pick = calloc((size_t)f->run->frames + 1, sizeof *p->pick);
    if (!p->pick) return no_memory(f);
    p->frames = pick_frames(f, how, p->pick);
    p->block = (p->frames + BLOCKS - 1) / BLOCKS;
    p->q = calloc((size_t)(f->dim * p->shown + 1), sizeof *p->q);
    p->values = VALUES + (f->pockets > 0);
    p->value = calloc((size_t)(p->values * p->shown + 1), 1);
    return mps__codec_create(&p->codec, p->shown, f->dim, p->values, how->bits) && p->q && p->value
               ? MPS_OK
               : no_memory(f);
}

static void packing_free(packing *p)
{
    mps__codec_free(&p->codec);
    mps__film_frame_free(&p->frame);
    free(p->pick);
    free(p->q);
    free(p->value);
}

static mps_status cannot_write(const film *f)
{
    return mps__page_fail(f->run->errors, MPS_E_IO, "cannot write the film of the page in '%s': %s",
                          f->run->folder, strerror(errno));
}

/* Discard all packed data. */
static mps_status empty(const film *f, FILE *out)
{
    rewind(out);
    return ftruncate(fileno(out), 0) == 0 ? MPS_OK : cannot_write(f);
}

/* Pack by a plan, replacing the contents of `out`.
 * @param share  size of the whole film over the available bytes: above 1 it does not fit */
static mps_status try_plan(const film *f, const plan *how, int64_t bytes, FILE *out, double *share)
{
    packing p;
    mps_status status = packing_create(&p, f, how, out);
    p.most = bytes;
    if (status == MPS_OK) status = empty(f, out);
    if (status == MPS_OK) {
        write_head(&p);
        status = pack_walls(&p);
    }
    if (status == MPS_OK) status = pack_ids(&p);
    if (status == MPS_OK) status = pack_frames(&p);
    const long size = ftell(out);
    if (status == MPS_OK && size < 0) status = cannot_write(f);
    *share = (double)size / (double)bytes * (double)p.frames / (double)(p.done ? p.done : 1);
    packing_free(&p);
    return status;
}

/* Reduce a plan: first precision, then particles, then frames.
 * @return false: it cannot be reduced further */
static bool less(const film *f, plan *how, double share)
{
    if (how->bits == FINE) {
        how->bits = COARSE;
        how->coarse = true;
        return true;
    }
    const int64_t every = (int64_t)ceil((double)how->every * fmax(1.05 * share, 1.1));
    if (f->moving.count / every >= LEAST_SHOWN) {
        how->every = every;
        return true;
    }
    how->step *= 2;
    if (how->step > 2) how->peaks = false;
    return pick_frames(f, how, NULL) >= 2;
}

static void describe(const film *f, const plan *how, const plan *first, char *note, size_t size)
{
    int64_t all = pick_frames(f, &(plan){.step = 1}, NULL);
    const int64_t peaks = f->run->frames - all;
    size_t used = 0;
    note[0] = '\0';
    if (how->peaks && peaks > 0)
        used = (size_t)snprintf(
            note, size, "About the highest peaks the film has %lld frames more.", (long long)peaks);
    if (how->bits != COARSE && how->step == first->step && how->peaks == first->peaks) return;
    used += (size_t)snprintf(note + used, size - used, "%sTo keep the page small, ",
                             used > 0 ? " " : "");
    if (how->bits == COARSE)
        used += (size_t)snprintf(
            note + used, size - used,
            "places are rounded to 1/%d of the width of the film and colours to "
            "64 steps",
            1 << COARSE);
    if (how->every > 1)
        used += (size_t)snprintf(note + used, size - used,
                                 "; one particle of %lld is shown, drawn larger",
                                 (long long)how->every);
    if (how->step > first->step)
        used += (size_t)snprintf(note + used, size - used, "; one frame of %lld is shown",
                                 (long long)how->step);
    snprintf(note + used, size - used, ". The folder has all %lld particles and %lld frames.",
             (long long)f->moving.count, (long long)f->run->frames);
}

/* @param frames  largest number of frames; 0: all */
static plan first_plan(const film *f, int32_t frames)
{
    plan how = {.bits = FINE, .every = 1, .step = 1, .peaks = true};
    const int64_t others = pick_frames(f, &(plan){.step = 1}, NULL);
    if (frames > 0) how.step = (others + frames - 1) / frames;
    if (frames > 0 && pick_frames(f, &how, NULL) > frames) how.peaks = false;
    return how;
}

mps_status mps__film_write(const film *f, int64_t bytes, int32_t frames, FILE *out, char *note,
                           size_t note_size, int64_t shown[2])
{
    const plan first = first_plan(f, frames);
    plan how = first;
    double share = 2;
    bool more = true;
    mps_status status = MPS_OK;
    shown[0] = shown[1] = 0;
    note[0] = '\0';
    if (f->moving.count == 0) return MPS_OK;
    while (status == MPS_OK && more && share > 1) {
        status = try_plan(f, &how, bytes, out, &share);
        if (status == MPS_OK && share > 1) more = less(f, &how, share);
    }
    if (status == MPS_OK && share <= 1) {
        shown[0] = pick_frames(f, &how, NULL);
        shown[1] = (f->moving.count + how.every - 1) / how.every;
    } else if (status == MPS_OK)
        status = empty(f, out);
    if (shown[0] > 0)
        describe(f, &how, &first, note, note_size);
    else if (status == MPS_OK)
        snprintf(note, note_size, "There is no film: its limit, %lld bytes, is too low.",
                 (long long)bytes);
    return status;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Draws tank, liquid and sensors as SVG: a section through the middle of the tank, in 3-D one along
 * each horizontal axis, with the names of the sensors beside it. */
#include "page_text.h"
#include "ship_motion.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The picture in its own units, and the raster of the section. */
enum { WIDTH = 900, MARGIN = 170, HEAD = 40, LINE = 15, CELLS = 360 };

enum { EMPTY = 0, WALL = 32 }; /* of a cell; fluids are 1 + phase */

typedef struct drawing {
    build *b;
    FILE *file;
    int axis;                   /* horizontal axis of the picture: x or z */
    double head;                /* upper end in the picture */
    double lo[2], hi[2], scale; /* the tank with its walls [m]; units of the picture per m */
    double cell;
    int32_t columns, rows;
    uint8_t *cells;
} drawing;

static double at_x(const drawing *d, double x)
{
    return MARGIN + (x - d->lo[0]) * d->scale;
}

static double at_y(const drawing *d, double y)
{
    return d->head + (d->hi[1] - y) * d->scale;
}

/* ---- the section ---- */

static void frame(drawing *d)
{
    const form *t = &d->b->tank.form;
    for (int k = 0; k < 2; k++) {
        d->lo[k] = t->lo[k ? 1 : d->axis] - 2 * d->b->dp;
        d->hi[k] = t->hi[k ? 1 : d->axis] + 2 * d->b->dp;
    }
    const double length = d->hi[0] - d->lo[0], height = d->hi[1] - d->lo[1];
    d->scale = fmin((WIDTH - 2 * MARGIN) / length, (WIDTH - 2 * MARGIN) / height);
    d->cell = fmax(0.5 * d->b->dp, fmax(length, height) / CELLS);
    d->columns = (int32_t)(length / d->cell) + 1;
    d->rows = (int32_t)(height / d->cell) + 1;
}

/* Mark all cells that a particle covers, walls thinner than fluid; walls are drawn over fluid. */
static void cover(drawing *d, const double *x, uint8_t value)
{
    const double reach = (value == WALL ? 0.3 : 0.5) * d->b->dp;
    const double across = x[d->axis] - d->lo[0];
    const int32_t left = (int32_t)floor((across - reach) / d->cell + 1e-6),
                  right = (int32_t)ceil((across + reach) / d->cell - 1e-6),
                  low = (int32_t)floor((x[1] - reach - d->lo[1]) / d->cell + 1e-6),
                  high = (int32_t)ceil((x[1] + reach - d->lo[1]) / d->cell - 1e-6);
    for (int32_t row = low < 0 ? 0 : low; row < high && row < d->rows; row++)
        for (int32_t k = left < 0 ? 0 : left; k < right && k < d->columns; k++) {
            uint8_t *cell = &d->cells[row * d->columns + k];
            if (value > *cell) *cell = value;
        }
}

/* In 3-D, mark particles within a spacing of the middle. */
static bool mark(drawing *d)
{
    build *b = d->b;
    const int cut = 2 - d->axis;
    const double middle = 0.5 * (b->tank.form.lo[cut] + b->tank.form.hi[cut]);
    mps_lease x = {.struct_size = sizeof x}, kind = x, phase = x;
    bool good = mps_lease_begin(b->sim, "position", MPS_READ, &x) == MPS_OK;
    good = good && mps_lease_begin(b->sim, "kind", MPS_READ, &kind) == MPS_OK;
    good = good && mps_lease_begin(b->sim, "phase", MPS_READ, &phase) == MPS_OK;
    for (int64_t i = 0; good && i < x.count; i++) {
        const double *at = x.data + i * x.stride;
        if (kind.integers[i] == MPS_DUMMY || (b->dim == 3 && fabs(at[cut] - middle) > 0.75 * b->dp))
            continue;
        cover(d, at, kind.integers[i] == MPS_WALL ? WALL : (uint8_t)(1 + phase.integers[i]));
    }
    mps_lease_end(b->sim, &phase);
    mps_lease_end(b->sim, &kind);
    mps_lease_end(b->sim, &x);
    return good;
}

/* Draw runs of equal cells, line by line. */
static void draw_cells(const drawing *d)
{
    static const char *const colour[] = {"#7fb3df", "#f3e3b5", "#a5d6a7", "#e0b0d5"};
    for (int32_t row = 0; row < d->rows; row++)
        for (int32_t from = 0, to; from < d->columns; from = to) {
            const uint8_t *cells = d->cells + row * d->columns, kind = cells[from];
            for (to = from + 1; to < d->columns && cells[to] == kind; to++) {
            }
            if (kind == EMPTY) continue;
            fprintf(d->file, "<rect x='%.1f' y='%.1f' width='%.1f' height='%.1f' fill='%s'/>\n",
                    at_x(d, d->lo[0] + from * d->cell), at_y(d, d->lo[1] + (row + 1) * d->cell),
                    (to - from) * d->cell * d->scale + 0.3, d->cell * d->scale + 0.3,
                    kind == WALL ? "#444" : colour[(kind - 1) % 4]);
        }
}

static void draw_outline(const drawing *d)
{
    const form *t = &d->b->tank.form;
    fprintf(d->file, "<g fill='none' stroke='#222' stroke-width='1'>\n");
    const int a = d->axis;
    const bool seen = t->kind == FORM_POLYGON && a == (t->sideways ? 2 : 0);
    if (seen) {
        fprintf(d->file, "<polygon points='");
        for (int32_t i = 0; i < t->points; i++)
            fprintf(d->file, "%.1f,%.1f ", at_x(d, t->point[i][0]), at_y(d, t->point[i][1]));
        fprintf(d->file, "'/>\n");
    } else if ((t->kind == FORM_BOX || t->kind == FORM_POLYGON) && !d->b->tank.file)
        fprintf(d->file, "<rect x='%.1f' y='%.1f' width='%.1f' height='%.1f'/>\n",
                at_x(d, t->lo[a]), at_y(d, t->hi[1]), (t->hi[a] - t->lo[a]) * d->scale,
                (t->hi[1] - t->lo[1]) * d->scale);
    fprintf(d->file, "</g>\n");
}
/* ---- sensors ---- */

static void draw_solids(const drawing *d)
{
    for (int32_t i = 0; i < d->b->solids; i++) {
        const build_solid *s = &d->b->solid[i];
        double at[2];
        for (int k = 0; k < 2; k++) {
            const int from = k ? 1 : d->axis;
            at[k] = s->plate ? 0.5 * (s->end[0][from] + s->end[1][from])
                             : 0.5 * (s->form.lo[from] + s->form.hi[from]);
        }
        fprintf(d->file, "<text x='%.1f' y='%.1f'>", at_x(d, at[0]) + 8, at_y(d, at[1]));
        mps__html(d->file, s->name);
        fprintf(d->file, "</text>\n");
    }
}

static bool has_place(const build_sensor *s)
{
    return s->kind == SENSOR_WALL || s->kind == SENSOR_FLUID || s->kind == SENSOR_GAUGE;
}

/* Where a vertical line leaves the tank; for a file, the upper end of its box. */
static double gauge_end(const drawing *d, const build_sensor *s)
{
    const form *t = &d->b->tank.form;
    const double step = 0.1 * d->b->dp;
    double at[3] = {s->at[0], s->at[1] + 0.5 * d->b->dp, s->at[2]};
    if (d->b->tank.file) return t->hi[1];
    while (at[1] < t->hi[1] && mps__form_inside(t, at) > 0) at[1] += step;
    return fmin(at[1], t->hi[1]);
}

static void draw_mark(const drawing *d, const build_sensor *s)
{
    const double x = at_x(d, s->at[d->axis]), y = at_y(d, s->at[1]);
    if (s->kind == SENSOR_GAUGE)
        fprintf(d->file,
                "<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='#b00' stroke-dasharray='5 "
                "3'/>\n",
                x, y, x, at_y(d, gauge_end(d, s)));
    else
        fprintf(d->file, "<circle cx='%.1f' cy='%.1f' r='4' fill='#b00' stroke='#fff'/>\n", x, y);
}

/* Names in the margin on the side of the sensor, from the top downwards, each with a line to its
 * mark. */
static void draw_names(const drawing *d, bool right)
{
    const build *b = d->b;
    const double middle = 0.5 * (d->lo[0] + d->hi[0]),
                 edge = right ? WIDTH - MARGIN + 14 : MARGIN - 14;
    double last = d->head - LINE, before = INFINITY;
    for (;;) {
        const build_sensor *next = NULL; /* the highest one below the previous one */
        double top = -INFINITY;
        for (int32_t i = 0; i < b->sensors; i++) {
            const build_sensor *s = &b->sensor[i];
            const double rank = s->at[1] - 1e-9 * d->b->dp * i;
            if (!has_place(s) || (s->at[d->axis] > middle) != right || rank >= before ||
                rank <= top)
                continue;
            next = s;
            top = rank;
        }
        if (!next) return;
        before = top;
        const double y = fmax(last + LINE, at_y(d, next->at[1]));
        last = y;
        fprintf(
            d->file,
            "<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='#b00' stroke-width='0.5'/>\n",
            at_x(d, next->at[d->axis]), at_y(d, next->at[1]), edge, y);
        fprintf(d->file, "<text x='%.1f' y='%.1f' text-anchor='%s'>", edge + (right ? 3 : -3),
                y + 4, right ? "start" : "end");
        mps__html(d->file, next->name);
        fprintf(d->file, "</text>\n");
    }
}

/* ---- all ---- */

/* A cross at the centre of rotation, if it is in the picture; its position as a text below the
 * picture. */
static void draw_centre(const drawing *d)
{
    const build_motion *m = d->b->motion;
    if (!m) return;
    const double right = m->centre[d->axis], up = m->centre[1], x = at_x(d, right), y = at_y(d, up);
    if (right < d->lo[0] || right > d->hi[0] || up < d->lo[1] || up > d->hi[1]) return;
    fprintf(d->file,
            "<path d='M%.1f %.1fh12M%.1f %.1fv12' stroke='#060' stroke-width='2'/>\n<text "
            "x='%.1f' y='%.1f' fill='#060'>centre</text>\n",
            x - 6, y, x, y - 6, x + 8, y - 4);
}

/* Explain the numbers of the picture. */
static void draw_words(const drawing *d, double y)
{
    const build *b = d->b;
    const form *t = &b->tank.form;
    fprintf(d->file,
            "<text x='%.1f' y='%.1f' text-anchor='middle'>%c: %.4g .. %.4g m, y: %.4g .. %.4g m",
            0.5 * WIDTH, y, "xyz"[d->axis], t -> lo[d->axis], t -> hi[d->axis], t -> lo[1],
            t -> hi[1]);
    if (b->dim == 3) fprintf(d->file, ", section through the middle along %c", "xyz"[2 - d->axis]);
    if (b->motion)
        fprintf(d->file, "; centre of rotation: %c %.4g m, y %.4g m", "xyz"[d->axis],
                b -> motion -> centre[d->axis], b -> motion -> centre[1]);
    fprintf(d->file, "</text>\n<text x='%.1f' y='%.1f' text-anchor='middle'>", 0.5 * WIDTH,
            y + LINE);
    for (int32_t i = 0; i < b->fluids; i++) {
        if (i) fprintf(d->file, ", ");
        mps__html(d->file, b->fluid[i].name);
    }
    fprintf(d->file, "</text>\n");
}

static void draw(const drawing *d)
{
    const build *b = d->b;
    draw_cells(d);
    draw_outline(d);
    if (!isnan(b->level))
        fprintf(d->file,
                "<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='#0057a8' "
                "stroke-dasharray='2 3'/>\n",
                at_x(d, d->lo[0]), at_y(d, b->level), at_x(d, d->hi[0]), at_y(d, b->level));
    for (int32_t i = 0; i < b->sensors; i++)
        if (has_place(&b->sensor[i])) draw_mark(d, &b->sensor[i]);
    draw_solids(d);
    draw_centre(d);
    draw_names(d, false);
    draw_names(d, true);
    draw_words(d, at_y(d, d->lo[1]) + 24);
}

/* Draw one section below `head`, and advance it to the end of the section. */
static bool add_section(build *b, FILE *file, int axis, double *head)
{
    drawing d = {.b = b, .file = file, .axis = axis, .head = *head};
    frame(&d);
    d.cells = calloc((size_t)d.columns * (size_t)d.rows, 1);
    const bool good = d.cells && mark(&d);
    if (good) draw(&d);
    *head = at_y(&d, d.lo[1]) + 60 + LINE * 2;
    free(d.cells);
    return good;
}

char *mps__sketch_write(build *b)
{
    char *body = NULL, *text = NULL;
    size_t size = 0;
    double height = HEAD;
    FILE *file = open_memstream(&body, &size);
    bool good = file && add_section(b, file, 0, &height);
    if (good && b->dim == 3) good = add_section(b, file, 2, &height);
    if (file) good = fclose(file) == 0 && good;
    file = good ? open_memstream(&text, &size) : NULL;
    if (file) {
        fprintf(file,
                "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 %d %.0f' "
                "font-family='sans-serif' font-size='12'>\n<rect width='100%%' height='100%%' "
                "fill='#fff'/>\n<text x='%d' y='20' font-size='14'>",
                WIDTH, height, MARGIN);
        mps__html(file, mps__read_text(b->c, b->root, "title", ""));
        fprintf(file, "</text>\n%s</svg>\n", body);
    }
    good = file && fclose(file) == 0 && size > 0;
    free(body);
    if (good) return text;
    free(text);
    return NULL;
}

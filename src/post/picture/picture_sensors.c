/* SPDX-License-Identifier: BSD-3-Clause */
#include "picture_sensors.h"
#include <math.h>

static const text_style style = {.size = 15, .halo = true, .ink = {0.13, 0.15, 0.18}};
static const colour mark = {
    0.84, 0.37, 0.00}; /* vermilion, which colour-blind readers distinguish from blue and green */

static bool overlap(const pixel_box *a, const pixel_box *b)
{
    return a->x < b->x + b->width && b->x < a->x + a->width && a->y < b->y + b->height &&
           b->y < a->y + a->height;
}

static bool is_free(const marks *m, const pixel_box *box)
{
    const pixel_box *in = &m->inside;
    if (box->x < in->x || box->x + box->width > in->x + in->width || box->y < in->y ||
        box->y + box->height > in->y + in->height)
        return false;
    for (int k = 0; k < m->count; k++)
        if (overlap(box, &m->taken[k])) return false;
    return true;
}

static void take(marks *m, const pixel_box *box)
{
    if (m->count < MARKS_MOST) m->taken[m->count++] = *box;
}

/* Write a name with the middle of its box at (x, y), or at the nearest free height above or below,
 * then with a line to its mark. */
static void write_name(marks *m, canvas *c, double x, double y, const double *mark_at,
                       const char *name)
{
    enum { TRIES = 24 };
    const double width = mps__canvas_text_width(c, style, name) + 4 * c->unit,
                 height = 19 * c->unit;
    const pixel_box *in = &m->inside;
    x = fmax(in->x + 0.5 * width, fmin(x, in->x + in->width - 0.5 * width));
    for (int k = 0; k < TRIES; k++) {
        const int lines = k % 2 ? -(k + 1) / 2 : k / 2;
        const double shift = 0.5 * height * lines;
        const pixel_box box = {x - 0.5 * width, y + shift - 0.5 * height, width, height};
        if (!is_free(m, &box)) continue;
        take(m, &box);
        if (mark_at && fabs(shift) > 0.3 * height)
            mps__canvas_line(c, mark_at[0], mark_at[1], x + (mark_at[0] > x ? 0.5 : -0.5) * width,
                             y + shift, 1, mark);
        mps__canvas_text(c, box.x + 2 * c->unit, y + shift + 0.36 * style.size * c->unit, style, 0,
                         name);
        return;
    }
}

void mps__marks_point(marks *m, canvas *c, double x, double y, double nx, double ny,
                      const char *name)
{
    const double radius = 5.5, half = 0.5 * mps__canvas_text_width(c, style, name) + 2 * c->unit,
                 length = hypot(nx, ny), off = (radius + 5) * c->unit;
    if (!(length > 0)) {
        nx = 1;
        ny = 0;
    }
    nx /= length > 0 ? length : 1;
    ny /= length > 0 ? length : 1;
    write_name(m, c, x + nx * (off + half), y + ny * (off + 9 * c->unit), (const double[]){x, y},
               name);
    mps__canvas_ring(c, x, y, radius, mark);
}

void mps__marks_line(marks *m, canvas *c, double x, double y, double top, const char *name)
{
    mps__canvas_dashes(c, x, y, x, top, mps__grey);
    mps__canvas_ring(c, x, y, 3, mps__grey);
    write_name(m, c, x, top - 11 * c->unit, NULL, name);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* The layout of a picture: title and time, the particles with axes and sensors, the colour bar; in
 * 3-D two views. */
#include "picture_axes.h"
#include "picture_sensors.h"
#include "picture_space.h"
#include <math.h>

/* Pixels of a picture 1280 wide. */
enum {
    SHEET = 1280,
    LEFT = 88,
    RIGHT = 156,
    TOP = 92,
    BOTTOM = 72,
    TALLEST = 1000,
    NARROWEST = 640
};

static const colour wall = {0.60, 0.62, 0.65};

/* Positions of all elements. */
typedef struct layout {
    double unit;
    int width, height;
    plane slice;
    pixel_box space; /* 3-D: the overview; width 0: none */
    double bar_x, bar_top, bar_height;
} layout;

static int even(double pixels)
{
    return 2 * (int)ceil(0.5 * pixels);
}

/* Scale a view to the largest size in a box. */
static void fit_slice(layout *l, const scene *s, double x, double y, double width, double height)
{
    plane *v = &l->slice;
    for (int d = 0; d < 2; d++) {
        v->lo[d] = s->lo[d] - 0.75 * s->dp;
        v->hi[d] = s->hi[d] + 0.75 * s->dp;
    }
    const double w = v->hi[0] - v->lo[0], h = v->hi[1] - v->lo[1];
    v->scale = fmin(width / w, height / h);
    v->box = (pixel_box){x, y, w * v->scale, h * v->scale};
}

static double bars_width(const scene *s)
{
    const int bars = s->phases < SCALE_MAPS ? s->phases : SCALE_MAPS;
    return RIGHT + (bars > 1 ? (bars - 1) * AXES_BARS_APART : 0);
}

/* The bar is as high as the drawing, at most 420. */
static void place_bar(layout *l, double x, double top, double height)
{
    l->bar_x = x + 30 * l->unit;
    l->bar_height = floor(fmin(height, 420 * l->unit));
    l->bar_top = floor(top + 0.5 * (height - l->bar_height));
}

static void lay_plane(layout *l, const scene *s, double available)
{
    const double u = l->unit;
    fit_slice(l, s, LEFT * u, TOP * u, available, TALLEST * u);
    const pixel_box *b = &l->slice.box;
    place_bar(l, b->x + b->width, b->y, b->height);
    l->width = even(fmax(b->x + b->width + bars_width(s) * u, NARROWEST * u));
    l->height = even(b->y + b->height + BOTTOM * u);
}

/* The overview is above the slice, or beside it if the slice is high. */
static void lay_space(layout *l, const scene *s, double available)
{
    const double u = l->unit, aspect = mps__space_aspect(s),
                 high = (s->hi[1] - s->lo[1]) / (s->hi[0] - s->lo[0]);
    if (high > 0.8) {
        const double half = 0.5 * available - 30 * u,
                     height = fmin(half * fmax(high, 1 / aspect), TALLEST * u);
        l->space = (pixel_box){20 * u, TOP * u, half + 30 * u, height};
        fit_slice(l, s, l->space.x + l->space.width + LEFT * u, TOP * u, half - 20 * u, height);
        l->slice.box.y += 0.5 * (height - l->slice.box.height);
        place_bar(l, l->slice.box.x + l->slice.box.width, TOP * u, height);
        l->height = even((TOP + BOTTOM) * u + height);
    } else {
        const double height = fmax(fmin(available / aspect, 0.55 * TALLEST * u), 40 * u);
        l->space = (pixel_box){LEFT * u, (TOP - 20) * u, available, height};
        fit_slice(l, s, LEFT * u, (TOP + 50) * u + height, available, 0.45 * TALLEST * u);
        l->slice.box.x += 0.5 * (available - l->slice.box.width);
        const double foot = l->slice.box.y + l->slice.box.height;
        place_bar(l, LEFT * u + available, TOP * u, foot - TOP * u);
        l->height = even(foot + BOTTOM * u);
    }
    l->width = even(l->bar_x + (bars_width(s) - 30) * u);
}

static void lay_out(layout *l, const scene *s, int32_t width)
{
    *l = (layout){.unit = (double)width / SHEET};
    const double available = width - (LEFT + bars_width(s)) * l->unit;
    if (s->dim == 3)
        lay_space(l, s, available);
    else
        lay_plane(l, s, available);
}

/* In 3-D, particles around the middle of z, one or two layers, so that baffles and levels between
 * the walls are visible. */
static bool is_in_slice(const scene *s, double z)
{
    return s->dim == 2 || fabs(z - 0.5 * (s->lo[2] + s->hi[2])) <= 0.75 * s->dp;
}

/* Walls first, so that the fluid beside them is not covered. */
static void draw_particles(canvas *c, const plane *v, const scene *s)
{
    const double radius = 0.5 * s->dp * v->scale;
    mps__canvas_pixels_begin(c);
    for (int kind = SCENE_WALL; kind >= SCENE_FLUID; kind--)
        for (int64_t i = 0; i < s->n; i++) {
            const float *x = s->x + 3 * i;
            if (s->kind[i] != kind || !is_in_slice(s, (double)x[2])) continue;
            mps__canvas_disc(
                c, &v->box, mps__plane_x(v, (double)x[0]), mps__plane_y(v, (double)x[1]), radius,
                kind == SCENE_WALL ? wall : mps__axes_colour(s, s->phase[i], (double)s->p[i]));
        }
    mps__canvas_pixels_end(c);
}

static void draw_sensors(canvas *c, const plane *v, const scene *s)
{
    marks m = {.inside = v->box};
    m.inside.y -= 24 * c->unit; /* space for names of gauges */
    m.inside.height += 24 * c->unit;
    for (int gauge = 0; gauge < 2; gauge++)
        for (int32_t k = 0; k < s->sensors; k++) {
            const scene_sensor *own = &s->sensor[k];
            const double x = mps__plane_x(v, own->at[0]), y = mps__plane_y(v, own->at[1]);
            if (own->gauge != (gauge == 1)) continue;
            if (s->dim == 3 && fabs(own->at[2] - 0.5 * (s->lo[2] + s->hi[2])) > 2 * s->dp) continue;
            if (own->gauge)
                mps__marks_line(&m, c, x, y, v->box.y, own->name);
            else
                mps__marks_point(&m, c, x, y, own->normal[0], -own->normal[1], own->name);
        }
}

static bool is_turned(const scene *s)
{
    return fabs(s->pose.turn[3]) > 1e-3 || fabs(s->pose.turn[5]) > 1e-3;
}

/* If the tank is rotated: the direction of gravity in its frame, R^T (0, -1, 0), beside the
 * time. */
static void draw_gravity(canvas *c, const scene *s, double x, double y)
{
    const text_style style = {.size = 15, .place = TEXT_RIGHT, .ink = mps__grey};
    const double gx = -s->pose.turn[3], gy = -s->pose.turn[4], half = 16 * c->unit;
    if (!is_turned(s)) return;
    mps__canvas_arrow(c, x - half * gx, y + half * gy, x + half * gx, y - half * gy, mps__grey);
    mps__canvas_text(c, x - 16 * c->unit, y + 5 * c->unit, style, 0, "gravity");
}

/* "t = 1.234 s" at the right; the title has the rest. */
static void draw_head(canvas *c, const scene *s)
{
    text_style style = {.size = 22, .place = TEXT_RIGHT, .ink = mps__ink};
    const double foot = 40 * c->unit, margin = 24 * c->unit;
    char text[48];
    snprintf(text, sizeof text, "t = %.3f s", s->t);
    const double used = mps__canvas_text_width(c, style, text);
    mps__canvas_text(c, c->width - margin, foot, style, 0, text);
    draw_gravity(c, s, c->width - 2.2 * margin - used, foot - 8 * c->unit);
    style.place = TEXT_LEFT;
    style.bold = true;
    const double available = c->width - (is_turned(s) ? 8 : 3) * margin - used;
    while (style.size > 15 && mps__canvas_text_width(c, style, s->title) > available) style.size--;
    mps__canvas_text(c, margin, foot, style, available, s->title);
}

static mps_status draw_all(canvas *c, const layout *l, const scene *s, page_errors *e)
{
    const text_style caption = {.size = 15, .place = TEXT_MIDDLE, .ink = mps__ink};
    const pixel_box *b = &l->slice.box;
    char text[64];
    draw_head(c, s);
    if (s->dim == 3) {
        const mps_status status = mps__space_draw(c, &l->space, s, e);
        if (status != MPS_OK) return status;
        const double middle = 0.5 * (s->lo[2] + s->hi[2]);
        snprintf(text, sizeof text, "slice at z = %.3g m",
                 fabs(middle) < 1e-3 * (s->hi[2] - s->lo[2]) ? 0 : middle);
        mps__canvas_text(c, b->x + 0.5 * b->width, b->y - 34 * c->unit, caption, 0, text);
    }
    mps__axes_draw(c, &l->slice);
    draw_particles(c, &l->slice, s);
    draw_sensors(c, &l->slice, s);
    mps__axes_bar(c, s, l->bar_x, l->bar_top, l->bar_height);
    return MPS_OK;
}

mps_status mps__scene_draw(const scene *s, int32_t width, canvas *out, page_errors *e)
{
    layout l;
    lay_out(&l, s, width);
    if (!mps__canvas_create(out, l.width, l.height, l.unit))
        return mps__page_fail(e, MPS_E_NOMEM, "no memory for a picture");
    const mps_status status = draw_all(out, &l, s, e);
    if (status != MPS_OK) mps__canvas_destroy(out);
    return status;
}

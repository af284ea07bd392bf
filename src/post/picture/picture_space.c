/* SPDX-License-Identifier: BSD-3-Clause */
#include "picture_space.h"
#include "picture_axes.h"
#include "picture_hull.h"
#include "picture_sensors.h"
#include <math.h>
#include <stdlib.h>

enum {
    FINE = 2,    /* samples per pixel and axis: their mean has soft edges */
    LAYERS = 512 /* in which particles are sorted by depth */
};

/* The contents of a sample; larger depths are nearer to the viewer. */
typedef struct sample {
    float depth, r, g, b;
} sample;

/* Orthographic: the viewer's right, up, and towards the viewer. */
typedef struct camera {
    double right[3], up[3], near[3];
    double lo[3], hi[3]; /* of the box of the scene, in these directions */
    double scale, x, y;  /* samples per metre; sample of the lower left corner */
} camera;

typedef struct view {
    const scene *s;
    camera at;
    int width, height; /* samples */
    sample *pixel;
} view;

static double along(const double axis[3], const double x[3])
{
    return axis[0] * x[0] + axis[1] * x[1] + axis[2] * x[2];
}

/* From the front, from the right by 30 degrees, from above by 22. */
static void aim(camera *c, const scene *s)
{
    const double turn = acos(-1.0) / 6, tilt = acos(-1.0) * 22 / 180;
    *c = (camera){.right = {cos(turn), 0, -sin(turn)},
                  .up = {-sin(tilt) * sin(turn), cos(tilt), -sin(tilt) * cos(turn)},
                  .near = {cos(tilt) * sin(turn), sin(tilt), cos(tilt) * cos(turn)},
                  .lo = {INFINITY, INFINITY, INFINITY},
                  .hi = {-INFINITY, -INFINITY, -INFINITY}};
    const double *const axis[3] = {c->right, c->up, c->near};
    for (int corner = 0; corner < 8; corner++) {
        double x[3];
        for (int d = 0; d < 3; d++) x[d] = corner >> d & 1 ? s->hi[d] + s->dp : s->lo[d] - s->dp;
        for (int d = 0; d < 3; d++) {
            c->lo[d] = fmin(c->lo[d], along(axis[d], x));
            c->hi[d] = fmax(c->hi[d], along(axis[d], x));
        }
    }
}

double mps__space_aspect(const scene *s)
{
    camera c;
    aim(&c, s);
    return (c.hi[0] - c.lo[0]) / (c.hi[1] - c.lo[1]);
}

/* Right, down and depth of a point, in samples and metres. */
static void project(const camera *c, const double x[3], double out[3])
{
    out[0] = c->x + (along(c->right, x) - c->lo[0]) * c->scale;
    out[1] = c->y - (along(c->up, x) - c->lo[1]) * c->scale;
    out[2] = along(c->near, x);
}

/* ---- spheres --------------------------------------------------------------------------------- */

typedef struct sphere {
    double x[3], radius; /* as from project(); radius in samples */
    colour ink;
    bool flat; /* without shading: a part of the shell */
} sphere;

/* Light from the upper left, paler with depth. */
static void shade(const view *v, sample *p, const sphere *ball, double dx, double dy)
{
    const double nz = sqrt(1 - dx * dx - dy * dy),
                 depth = ball->x[2] + nz * ball->radius / v->at.scale;
    if (depth <= (double)p->depth) return;
    const double light = ball->flat ? 1
                                    : 0.55 + 0.50 * fmax(0, -0.36 * dx - 0.55 * dy + 0.755 * nz);
    const double far = (v->at.hi[2] - depth) / (v->at.hi[2] - v->at.lo[2]),
                 pale = ball->flat ? 0 : 0.35 * far;
    p->depth = (float)depth;
    p->r = (float)(fmin(1, light * ball->ink.r) * (1 - pale) + pale);
    p->g = (float)(fmin(1, light * ball->ink.g) * (1 - pale) + pale);
    p->b = (float)(fmin(1, light * ball->ink.b) * (1 - pale) + pale);
}

static void draw_sphere(const view *v, const sphere *ball)
{
    const double r = ball->radius, *m = ball->x;
    if (!(fabs(m[0]) < 1e6 && fabs(m[1]) < 1e6)) return;
    const int x0 = (int)fmax(0, floor(m[0] - r)), x1 = (int)fmin(v->width - 1, m[0] + r),
              y0 = (int)fmax(0, floor(m[1] - r)), y1 = (int)fmin(v->height - 1, m[1] + r);
    const double nearest = m[2] + r / v->at.scale;
    for (int j = y0; j <= y1; j++) {
        const double dy = (j + 0.5 - m[1]) / r;
        sample *p = v->pixel + (size_t)j * (size_t)v->width;
        for (int i = x0; i <= x1; i++) {
            if (nearest <= (double)p[i].depth) continue;
            const double dx = (i + 0.5 - m[0]) / r;
            if (dx * dx + dy * dy <= 1) shade(v, p + i, ball, dx, dy);
        }
    }
}

/* The outside of the tank: walls that face the viewer only are omitted, the rest is a pale shell,
 * darker below and at the right.
 * @return false: omitted */
static bool dress_wall(const view *v, const hull *h, int64_t i, sphere *ball)
{
    const scene *s = v->s;
    double out[3], n[3], length = 0, light;
    int away = 0, sides = 0;
    mps__hull_outwards(h, s->x + 3 * i, out);
    ball->ink = (colour){0.60, 0.62, 0.65};
    for (int d = 0; d < 3; d++) {
        sides += out[d] != 0;
        away += out[d] * v->at.near[d] < 0;
    }
    if (sides == 0) return true;
    if (away == 0) return false;
    for (int d = 0; d < 3; d++) {
        n[d] = (2 * (double)s->x[3 * i + d] - s->lo[d] - s->hi[d]) / (s->hi[d] - s->lo[d] + s->dp);
        length += n[d] * n[d];
    }
    light = along(v->at.up, n) - 0.5 * along(v->at.right, n);
    light = 0.925 + 0.035 * light / sqrt(length + 1e-9);
    ball->flat = true;
    ball->ink = (colour){light - 0.008, light, light + 0.010};
    return true;
}

/* The layer of a particle, about a spacing deep; 0 is nearest to the viewer. */
static size_t layer(const view *v, const float x[3])
{
    const double at[3] = {(double)x[0], (double)x[1], (double)x[2]};
    const double k = (v->at.hi[2] - along(v->at.near, at)) / (v->at.hi[2] - v->at.lo[2]) * LAYERS;
    return k > 0 ? (size_t)fmin(k, LAYERS - 1) : 0;
}

/* Sort the particles by layer from near to far, so that most hidden ones are discarded before
 * shading; within a layer the order of the scene is kept. */
static int64_t *sort_particles(const view *v)
{
    const scene *s = v->s;
    int64_t first[LAYERS + 1] = {0};
    int64_t *order = malloc((size_t)s->n * sizeof *order);
    for (int64_t i = 0; order && i < s->n; i++) first[layer(v, s->x + 3 * i) + 1]++;
    for (int k = 0; k < LAYERS; k++) first[k + 1] += first[k];
    for (int64_t i = 0; order && i < s->n; i++) order[first[layer(v, s->x + 3 * i)]++] = i;
    return order;
}

/* Draw one of two passes: the shell, or all other particles. */
static void draw_spheres(const view *v, const hull *h, const int64_t *order, bool shell)
{
    const scene *s = v->s;
    for (int64_t k = 0; k < s->n; k++) {
        const int64_t i = order[k];
        const bool fluid = s->kind[i] == SCENE_FLUID;
        const double x[3] = {(double)s->x[3 * i], (double)s->x[3 * i + 1], (double)s->x[3 * i + 2]};
        /* radii [dp] at which surfaces have no gaps */
        sphere ball = {.radius = fmax(0.75, (fluid ? 0.62 : 0.75) * s->dp * v->at.scale)};
        if (fluid)
            ball.ink = mps__axes_colour(s, s->phase[i], (double)s->p[i]);
        else if (!dress_wall(v, h, i, &ball))
            continue;
        if (ball.flat != shell) continue;
        project(&v->at, x, ball.x);
        draw_sphere(v, &ball);
    }
}

/* The shell is drawn behind all: where its edge turns towards the viewer it hides nothing either.
 * @return false: memory is exhausted */
static bool draw_all(const view *v, const hull *h)
{
    int64_t *order = sort_particles(v);
    if (!order) return false;
    draw_spheres(v, h, order, true);
    for (size_t i = 0; i < (size_t)v->width * (size_t)v->height; i++) v->pixel[i].depth = -INFINITY;
    draw_spheres(v, h, order, false);
    free(order);
    return true;
}

/* ---- the view -------------------------------------------------------------------------------- */

/* The mean of the samples of a pixel. @return false: all are white, as the canvas is */
static bool find_mean(const view *v, int x, int y, colour *out)
{
    const sample *row = v->pixel + (size_t)(y * FINE) * (size_t)v->width + (size_t)(x * FINE);
    double r = 0, g = 0, b = 0;
    for (int j = 0; j < FINE; j++, row += v->width)
        for (int i = 0; i < FINE; i++) {
            r += (double)row[i].r;
            g += (double)row[i].g;
            b += (double)row[i].b;
        }
    const double all = FINE * FINE;
    *out = (colour){r / all, g / all, b / all};
    return r < all || g < all || b < all;
}

static void copy_pixels(canvas *c, const pixel_box *box, const view *v)
{
    mps__canvas_pixels_begin(c);
    for (int y = 0; y < v->height / FINE; y++)
        for (int x = 0; x < v->width / FINE; x++) {
            colour mean;
            if (find_mean(v, x, y, &mean))
                mps__canvas_dot(c, box, (int)box->x + x, (int)box->y + y, mean, 1);
        }
    mps__canvas_pixels_end(c);
}

static void draw_edge(canvas *c, const pixel_box *box, const view *v, const double x[3],
                      const double y[3])
{
    double from[3], to[3];
    project(&v->at, x, from);
    project(&v->at, y, to);
    if (!isfinite(from[0] + from[1] + to[0] + to[1])) return;
    mps__canvas_line(c, box->x + from[0] / FINE, box->y + from[1] / FINE, box->x + to[0] / FINE,
                     box->y + to[1] / FINE, 0.8, (colour){0.62, 0.64, 0.67});
}

/* The edges of the tank, or of the box of all walls. */
static void draw_box(canvas *c, const pixel_box *box, const view *v)
{
    const scene *s = v->s;
    for (int32_t k = 0; k < s->edges; k++)
        draw_edge(c, box, v, s->edge + 6 * (int64_t)k, s->edge + 6 * (int64_t)k + 3);
    for (int corner = 0; corner < 8 && s->edges == 0; corner++)
        for (int d = 0; d < 3; d++) {
            double x[3], y[3];
            if (corner >> d & 1) continue;
            for (int k = 0; k < 3; k++) y[k] = x[k] = corner >> k & 1 ? s->hi[k] : s->lo[k];
            y[d] = s->hi[d];
            draw_edge(c, box, v, x, y);
        }
}

static void draw_axes(canvas *c, const pixel_box *box, const view *v)
{
    static const char *const name[3] = {"x", "y", "z"};
    const text_style style = {.size = 15, .place = TEXT_MIDDLE, .ink = mps__ink};
    const double length = 34 * c->unit, x0 = box->x + 22 * c->unit,
                 y0 = box->y + box->height - 30 * c->unit;
    for (int d = 0; d < 3; d++) {
        const double dx = length * v->at.right[d], dy = -length * v->at.up[d];
        mps__canvas_arrow(c, x0, y0, x0 + dx, y0 + dy, mps__ink);
        mps__canvas_text(c, x0 + 1.35 * dx, y0 + 1.35 * dy + 5 * c->unit, style, 0, name[d]);
    }
}

static void draw_sensors(canvas *c, const pixel_box *box, const view *v)
{
    marks m = {.inside = *box};
    for (int32_t k = 0; k < v->s->sensors; k++) {
        const scene_sensor *own = &v->s->sensor[k];
        double x[3], top[3];
        const double end[3] = {own->at[0], v->s->hi[1], own->at[2]};
        project(&v->at, own->at, x);
        project(&v->at, end, top);
        if (own->gauge)
            mps__marks_line(&m, c, box->x + x[0] / FINE, box->y + x[1] / FINE,
                            box->y + top[1] / FINE, own->name);
        else
            mps__marks_point(&m, c, box->x + x[0] / FINE, box->y + x[1] / FINE,
                             along(v->at.right, own->normal), -along(v->at.up, own->normal),
                             own->name);
    }
}

static bool open_view(view *v, const pixel_box *box, const scene *s)
{
    *v = (view){.s = s, .width = FINE * (int)box->width, .height = FINE * (int)box->height};
    const size_t count = (size_t)v->width * (size_t)v->height;
    v->pixel = malloc(count * sizeof *v->pixel);
    if (!v->pixel) return false;
    for (size_t i = 0; i < count; i++) v->pixel[i] = (sample){-INFINITY, 1, 1, 1};
    camera *c = &v->at;
    aim(c, s);
    c->scale = fmin(v->width / (c->hi[0] - c->lo[0]), v->height / (c->hi[1] - c->lo[1]));
    c->x = 0.5 * (v->width - (c->hi[0] - c->lo[0]) * c->scale);
    c->y = 0.5 * (v->height + (c->hi[1] - c->lo[1]) * c->scale);
    return true;
}

mps_status mps__space_draw(canvas *c, const pixel_box *box, const scene *s, page_errors *e)
{
    view v = {0};
    hull h;
    const bool drawn = mps__hull_create(&h, s) && open_view(&v, box, s) && draw_all(&v, &h);
    if (drawn) {
        copy_pixels(c, box, &v);
        draw_box(c, box, &v);
        draw_axes(c, box, &v);
        draw_sensors(c, box, &v);
    }
    free(v.pixel);
    mps__hull_free(&h);
    return drawn ? MPS_OK : mps__page_fail(e, MPS_E_NOMEM, "no memory for a picture");
}

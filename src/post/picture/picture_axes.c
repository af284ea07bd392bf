/* SPDX-License-Identifier: BSD-3-Clause */
#include "picture_axes.h"
#include <math.h>

static const double small = 15, gap = 10, tick = 6; /* pixels of a picture 1280 wide */

double mps__plane_x(const plane *v, double x)
{
    return v->box.x + (x - v->lo[0]) * v->scale;
}

double mps__plane_y(const plane *v, double y)
{
    return v->box.y + (v->hi[1] - y) * v->scale;
}

void mps__axes_ticks(ticks *t, double lo, double hi, double most)
{
    static const double nice[] = {1, 2, 5, 10};
    const double least = (hi - lo) / fmin(fmax(most, 1), AXES_TICKS - 2),
                 power = pow(10, floor(log10(least)));
    int k = 0;
    while (k < 3 && nice[k] * power * (1 + 1e-9) < least) k++;
    *t = (ticks){.step = nice[k] * power};
    const double first = ceil(lo / t->step - 1e-9);
    for (int i = 0; i < AXES_TICKS; i++) {
        const double value = (first + i) * t->step;
        if (value > hi + 1e-9 * t->step) break;
        /* far from zero, steps are below rounding */
        if (i > 0 && !(value > t->value[i - 1])) break;
        t->value[t->count++] = value;
    }
}

/* Print a number with the digits of its step and a typographic minus sign. */
static void print_number(char out[32], double value, double step)
{
    static const char minus[] = "\xe2\x88\x92";
    const int decimals = (int)fmax(0, ceil(-log10(step) - 1e-9));
    if (fabs(value) < 0.5 * step) value = 0;
    snprintf(out, 32, "%s%.*f", value < 0 ? minus : "", decimals < 12 ? decimals : 12, fabs(value));
}

/* ---- axes ------------------------------------------------------------------------------------ */

/* The unit of lengths: numbers with two or three digits before the point. */
static double length_unit(const plane *v, const char **name)
{
    const double most = fmax(v->hi[0] - v->lo[0], v->hi[1] - v->lo[1]);
    *name = most < 0.01 ? "\xc2\xb5m" : most < 0.3 ? "mm" : "m";
    return most < 0.01 ? 1e-6 : most < 0.3 ? 1e-3 : 1;
}

static void draw_x(canvas *c, const plane *v, double unit, const char *name)
{
    const text_style style = {.size = small, .place = TEXT_MIDDLE, .ink = mps__grey};
    const double foot = v->box.y + v->box.height + gap * c->unit, right = v->box.x + v->box.width;
    char text[48];
    ticks t;
    mps__axes_ticks(&t, v->lo[0] / unit, v->hi[0] / unit, v->box.width / (80 * c->unit));
    mps__canvas_line(c, v->box.x, foot, right, foot, 1, mps__grey);
    for (int k = 0; k < t.count; k++) {
        const double x = mps__plane_x(v, t.value[k] * unit);
        mps__canvas_line(c, x, foot, x, foot + tick * c->unit, 1, mps__grey);
        print_number(text, t.value[k], t.step);
        mps__canvas_text(c, x, foot + (tick + 16) * c->unit, style, 0, text);
    }
    snprintf(text, sizeof text, "x [%s]", name);
    mps__canvas_text(c, v->box.x + 0.5 * v->box.width, foot + (tick + 38) * c->unit, style, 0,
                     text);
}

static void draw_y(canvas *c, const plane *v, double unit, const char *name)
{
    const text_style style = {.size = small, .place = TEXT_RIGHT, .ink = mps__grey};
    const double left = v->box.x - gap * c->unit, foot = v->box.y + v->box.height;
    char text[48];
    ticks t;
    mps__axes_ticks(&t, v->lo[1] / unit, v->hi[1] / unit, v->box.height / (75 * c->unit));
    mps__canvas_line(c, left, v->box.y, left, foot, 1, mps__grey);
    for (int k = 0; k < t.count; k++) {
        const double y = mps__plane_y(v, t.value[k] * unit);
        mps__canvas_line(c, left - tick * c->unit, y, left, y, 1, mps__grey);
        print_number(text, t.value[k], t.step);
        mps__canvas_text(c, left - (tick + 4) * c->unit, y + 0.36 * small * c->unit, style, 0,
                         text);
    }
    snprintf(text, sizeof text, "y [%s]", name);
    mps__canvas_text(c, left + tick * c->unit, v->box.y - 12 * c->unit, style, 0, text);
}

void mps__axes_draw(canvas *c, const plane *v)
{
    const char *name = "m";
    const double unit = length_unit(v, &name);
    draw_x(c, v, unit, name);
    draw_y(c, v, unit, name);
}

/* ---- colours --------------------------------------------------------------------------------- */

colour mps__axes_colour(const scene *s, int32_t phase, double p)
{
    const double(*map)[3] = mps__scale_map[phase % SCALE_MAPS];
    double f = (p - s->p_lo) / (s->p_hi - s->p_lo) * (SCALE_COLOURS - 1);
    f = f > 0 ? fmin(f, SCALE_COLOURS - 1) : 0;
    const int k = f < SCALE_COLOURS - 2 ? (int)f : SCALE_COLOURS - 2;
    const double w = f - k;
    return (colour){map[k][0] + w * (map[k + 1][0] - map[k][0]),
                    map[k][1] + w * (map[k + 1][1] - map[k][1]),
                    map[k][2] + w * (map[k + 1][2] - map[k][2])};
}

static double pressure_unit(const scene *s, const char **name)
{
    const double most = fmax(fabs(s->p_lo), fabs(s->p_hi));
    *name = most >= 2e6 ? "MPa" : most >= 2e3 ? "kPa" : most >= 0.1 ? "Pa" : "mPa";
    return most >= 2e6 ? 1e6 : most >= 2e3 ? 1e3 : most >= 0.1 ? 1 : 1e-3;
}

/* A bar line by line, with a tip at the end: larger pressures have its colour. */
static void draw_bar(canvas *c, const scene *s, int32_t phase, const pixel_box *box)
{
    const int rows = (int)box->height;
    for (int j = 0; j < rows; j++) {
        const double p = s->p_hi + (s->p_lo - s->p_hi) * (j + 0.5) / rows;
        const pixel_box row = {box->x, floor(box->y) + j, box->width, 1};
        mps__canvas_box(c, &row, mps__axes_colour(s, phase, p));
    }
    mps__canvas_tip(c, box->x + 0.5 * box->width, floor(box->y), box->width, -8 * c->unit,
                    mps__axes_colour(s, phase, s->p_hi));
}

static void draw_numbers(canvas *c, const scene *s, double x, double top, double height)
{
    const text_style style = {.size = small, .ink = mps__grey};
    const char *name = "Pa";
    const double unit = pressure_unit(s, &name), lo = s->p_lo / unit, hi = s->p_hi / unit;
    char text[48];
    ticks t;
    mps__axes_ticks(&t, lo, hi, height / (45 * c->unit));
    for (int k = 0; k < t.count; k++) {
        const double y = top + height * (hi - t.value[k]) / (hi - lo);
        mps__canvas_line(c, x, y, x + tick * c->unit, y, 1, mps__grey);
        print_number(text, t.value[k], t.step);
        mps__canvas_text(c, x + (tick + 4) * c->unit, y + 0.36 * small * c->unit, style, 0, text);
    }
}

/* The phase of a bar, below it. */
static void draw_phase(canvas *c, const scene *s, int32_t phase, double x, double foot)
{
    const text_style style = {.size = 13, .place = TEXT_MIDDLE, .ink = mps__grey};
    char text[32];
    if (s->density[phase] > 0) {
        snprintf(text, sizeof text, "%.4g", s->density[phase]);
        mps__canvas_text(c, x, foot + 18 * c->unit, style, 0, text);
        mps__canvas_text(c, x, foot + 34 * c->unit, style, 0, "kg/m\xc2\xb3");
        return;
    }
    snprintf(text, sizeof text, "phase %d", (int)phase);
    mps__canvas_text(c, x, foot + 18 * c->unit, style, 0, text);
}

void mps__axes_bar(canvas *c, const scene *s, double x, double top, double height)
{
    const text_style head = {.size = small, .ink = mps__ink};
    const int32_t count = s->phases > 1 ? s->phases : 1;
    const double width = 18 * c->unit, apart = AXES_BARS_APART * c->unit;
    const char *name = "Pa";
    char text[64];
    pressure_unit(s, &name);
    snprintf(text, sizeof text, "pressure [%s]", name);
    mps__canvas_text(c, x, top - 22 * c->unit, head, 0, text);
    for (int32_t k = 0; k < count && k < SCALE_MAPS; k++) {
        const pixel_box box = {x + k * apart, top, width, height};
        draw_bar(c, s, k, &box);
        if (count > 1) draw_phase(c, s, k, x + k * apart + 0.5 * width, top + height);
    }
    const int32_t bars = count < SCALE_MAPS ? count : SCALE_MAPS;
    draw_numbers(c, s, x + (bars - 1) * apart + width + 2 * c->unit, top, height);
}

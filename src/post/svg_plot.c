/* SPDX-License-Identifier: BSD-3-Clause */
/* A small plotter: axes with round ticks, curves thinned to the pixels there are, marks, a legend. */
#include "svg_plot.h"
#include <math.h>
#include <string.h>

enum { WIDTH = 860, HEIGHT = 330, LEFT = 78, RIGHT = 150, TOP = 34, BOTTOM = 46, NOTE = 18 };

static const char *const COLOURS[] = {"#1f77b4", "#d62728", "#2ca02c", "#9467bd",
                                      "#ff7f0e", "#17becf", "#8c564b", "#e377c2",
                                      "#7f7f7f", "#bcbd22", "#000000", "#3a5f0b"};

/* One axis: data lo..hi onto pixels from..to. */
typedef struct axis {
    double lo, hi, from, to, tick;
} axis;

static double axis_pixel(const axis *a, double value)
{
    return a->from + (value - a->lo) / (a->hi - a->lo) * (a->to - a->from);
}

static void axis_take(axis *a, double value)
{
    if (!isfinite(value)) return;
    if (value < a->lo) a->lo = value;
    if (value > a->hi) a->hi = value;
}

/* 1, 2 or 5 times a power of ten, for about `count` ticks. */
static double axis_round_tick(double span, int count)
{
    double raw = span / count, power = pow(10, floor(log10(raw))), m = raw / power;
    return (m < 1.5 ? 1 : m < 3.5 ? 2 : m < 7.5 ? 5 : 10) * power;
}

static void axis_finish(axis *a, int ticks, bool snap)
{
    if (!(a->lo <= a->hi)) a->lo = 0, a->hi = 1; /* no finite value at all */
    double least = 1e-9 * fmax(fabs(a->lo), fabs(a->hi));
    if (a->hi - a->lo <= least) a->lo -= 0.5 * least + 1e-12, a->hi += 0.5 * least + 1e-12;
    a->tick = axis_round_tick(a->hi - a->lo, ticks);
    if (!snap) return;
    a->lo = floor(a->lo / a->tick + 1e-9) * a->tick;
    a->hi = ceil(a->hi / a->tick - 1e-9) * a->tick;
}

void mps__svg_text(FILE *out, const char *text)
{
    for (; *text; text++) {
        if (*text == '&')
            fputs("&amp;", out);
        else if (*text == '<')
            fputs("&lt;", out);
        else if (*text == '>')
            fputs("&gt;", out);
        else
            fputc(*text, out);
    }
}

static void svg_label(FILE *out, double x, double y, const char *attributes, const char *text)
{
    fprintf(out, "<text x=\"%.1f\" y=\"%.1f\" %s>", x, y, attributes);
    mps__svg_text(out, text);
    fputs("</text>\n", out);
}

static void svg_ticks(FILE *out, const axis *a, bool horizontal)
{
    for (double k = ceil(a->lo / a->tick - 1e-9); k * a->tick <= a->hi + 1e-9 * a->tick; k++) {
        char text[32];
        double v = k * a->tick, at = axis_pixel(a, v);
        snprintf(text, sizeof text, "%.6g", fabs(v) < 1e-9 * a->tick ? 0.0 : v);
        if (horizontal) {
            fprintf(out, "<path class=\"g\" d=\"M%.1f %dV%d\"/>\n", at, TOP, HEIGHT - BOTTOM);
            svg_label(out, at, HEIGHT - BOTTOM + 16, "text-anchor=\"middle\"", text);
        } else {
            fprintf(out, "<path class=\"g\" d=\"M%d %.1fH%d\"/>\n", LEFT, at, WIDTH - RIGHT);
            svg_label(out, LEFT - 7, at + 4, "text-anchor=\"end\"", text);
        }
    }
}

/* Write a curve; of the points in one pixel column the first, lowest, highest and last are kept, so peaks survive. */
static void svg_curve(FILE *out, const plot_series *s, const axis *x, const axis *y,
                      const char *colour)
{
    fprintf(out, "<path class=\"c\" stroke=\"%s\" d=\"", colour);
    bool pen = false;
    for (int64_t i = 0; i < s->count;) {
        double column = floor(axis_pixel(x, s->x[i * s->stride]));
        int64_t end = i, low = i, high = i;
        for (; end < s->count && floor(axis_pixel(x, s->x[end * s->stride])) == column; end++) {
            if (s->y[end * s->stride] < s->y[low * s->stride]) low = end;
            if (s->y[end * s->stride] > s->y[high * s->stride]) high = end;
        }
        if (end == i) end = i + 1; /* a time that is not a number */
        int64_t pick[4] = {i, low < high ? low : high, low < high ? high : low, end - 1};
        for (int k = 0; k < 4; k++) {
            if (k > 0 && pick[k] == pick[k - 1]) continue;
            double px = axis_pixel(x, s->x[pick[k] * s->stride]),
                   py = axis_pixel(y, s->y[pick[k] * s->stride] + s->shift);
            bool good = isfinite(px) && isfinite(py);
            if (good) fprintf(out, "%c%.1f %.1f", pen ? 'L' : 'M', px, py);
            pen = good;
        }
        i = end;
    }
    fputs("\"/>\n", out);
}

static void svg_marks(FILE *out, const plot_series *s, const axis *x, const axis *y,
                      const char *colour)
{
    for (int64_t i = 0; i < s->count; i++) {
        double px = axis_pixel(x, s->x[i * s->stride]),
               py = axis_pixel(y, s->y[i * s->stride] + s->shift);
        if (px < LEFT - 0.5 || px > WIDTH - RIGHT + 0.5) continue;
        fprintf(out, "<path class=\"m\" stroke=\"%s\" d=\"M%.1f %.1fl8 8m0 -8l-8 8\"/>\n", colour,
                px - 4, py - 4);
    }
}

static void svg_legend(FILE *out, const plot *p)
{
    for (int i = 0; i < p->count; i++) {
        int x = WIDTH - RIGHT + 12, y = TOP + 8 + 18 * i;
        const char *colour = COLOURS[i % PLOT_SERIES];
        if (p->series[i].marks)
            fprintf(out, "<path class=\"m\" stroke=\"%s\" d=\"M%d %dl8 8m0 -8l-8 8\"/>\n", colour,
                    x + 5, y - 4);
        else
            fprintf(out, "<path class=\"c\" stroke=\"%s\" d=\"M%d %dh18\"/>\n", colour, x, y);
        svg_label(out, x + 24, y + 4, "", p->series[i].label);
    }
}

/* Ranges: times of the curves only (marks may lie beyond the end of a short run), values of all within them. */
static void plot_ranges(const plot *p, axis *x, axis *y)
{
    for (int i = 0; i < p->count; i++)
        for (int64_t k = 0; k < p->series[i].count && !p->series[i].marks; k++)
            axis_take(x, p->series[i].x[k * p->series[i].stride]);
    axis_finish(x, 10, false);
    for (int i = 0; i < p->count; i++) {
        const plot_series *s = &p->series[i];
        for (int64_t k = 0; k < s->count; k++) {
            double t = s->x[k * s->stride];
            if (t >= x->lo && t <= x->hi) axis_take(y, s->y[k * s->stride] + s->shift);
        }
    }
    axis_finish(y, 6, true);
}

void mps__plot_add(plot *p, plot_series series)
{
    if (p && p->count < PLOT_SERIES) p->series[p->count++] = series;
}

void mps__plot_svg(FILE *out, const plot *p)
{
    axis x = {INFINITY, -INFINITY, LEFT, WIDTH - RIGHT, 0},
         y = {INFINITY, -INFINITY, HEIGHT - BOTTOM, TOP, 0};
    const int height = HEIGHT + (p->note ? NOTE : 0);
    plot_ranges(p, &x, &y);
    fprintf(out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d "
            "%d\">\n",
            WIDTH, height, WIDTH, height);
    fputs("<style>text{font:12px "
          "sans-serif;fill:#222}.t{font-size:14px;font-weight:bold}.g{"
          "stroke:#ddd;fill:none}"
          ".f{stroke:#555;fill:none}.c{fill:none;stroke-width:1.5}.m{fill:none;stroke-width:2.2}</"
          "style>\n<rect width=\"100%\" "
          "height=\"100%\" fill=\"#fff\"/>\n",
          out);
    svg_ticks(out, &x, true);
    svg_ticks(out, &y, false);
    for (int i = 0; i < p->count; i++) {
        if (!p->series[i].marks) svg_curve(out, &p->series[i], &x, &y, COLOURS[i % PLOT_SERIES]);
    }
    for (int i = 0; i < p->count; i++) {
        if (p->series[i].marks) svg_marks(out, &p->series[i], &x, &y, COLOURS[i % PLOT_SERIES]);
    }
    fprintf(out, "<rect class=\"f\" x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\"/>\n", LEFT, TOP,
            WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM);
    svg_legend(out, p);
    svg_label(out, LEFT, TOP - 12, "class=\"t\"", p->title);
    svg_label(out, (LEFT + WIDTH - RIGHT) / 2.0, HEIGHT - 10, "text-anchor=\"middle\"", p->x_label);
    char turned[96];
    snprintf(turned, sizeof turned, "text-anchor=\"middle\" transform=\"rotate(-90 16 %d)\"",
             (TOP + HEIGHT - BOTTOM) / 2);
    svg_label(out, 16, (TOP + HEIGHT - BOTTOM) / 2.0, turned, p->y_label);
    if (p->note) svg_label(out, LEFT, HEIGHT + 6, "style=\"font-size:11px;fill:#555\"", p->note);
    fputs("</svg>\n", out);
}

bool mps__plot_save(const char *folder, const char *name, const plot *p)
{
    char path[640];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *out = fopen(path, "w");
    if (out) mps__plot_svg(out, p);
    bool failed = !out || ferror(out);
    if (out && fclose(out) != 0) failed = true;
    return !failed;
}

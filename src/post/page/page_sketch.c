/* SPDX-License-Identifier: BSD-3-Clause */
/* Sketch of the tank with its sensors: a printable drawing, whose marks are buttons for the
 * curves. */
#include "page_parts.h"
#include "page_text.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 620, MARGIN = 122, TOP = 40, FOOT = 44, TALLEST = 420, APART = 17, MARKS = 200 };

/* Maps metres to the drawing. */
typedef struct sketch {
    FILE *out;
    int axis; /* horizontal axis of the drawing: x or z */
    double lo[2], hi[2], scale, width, height;
} sketch;

typedef enum side { LEFT, RIGHT, ABOVE } side;

typedef struct mark {
    const page_column *column;
    side side;
    double x, y, label; /* label: y, or x of those above */
} mark;

static double at_x(const sketch *s, double x)
{
    return MARGIN + (x - s->lo[0]) * s->scale;
}

static double at_y(const sketch *s, double y)
{
    return TOP + (s->hi[1] - y) * s->scale;
}

/* Inner size of the tank. @return false: not known */
static bool tank_box(const page_run *r, int axis, double lo[2], double hi[2])
{
    lo[0] = mps__page_number(r, axis ? "tank_lo_z" : "tank_lo_x");
    lo[1] = mps__page_number(r, "tank_lo_y");
    hi[0] = lo[0] + mps__page_number(r, axis ? "tank_size_z" : "tank_size_x");
    hi[1] = lo[1] + mps__page_number(r, "tank_size_y");
    return hi[0] > lo[0] && hi[1] > lo[1];
}

static bool is_marked(const page_column *c)
{
    return c->has_place && c->place >= 0 && c->name[0] &&
           (strcmp(c->type, "wall_pressure") == 0 || strcmp(c->type, "gauge") == 0 ||
            strcmp(c->type, "pressure") == 0);
}

/* The horizontal axis along which the sensors spread: in the view along it they would hide each
 * other. */
static int chosen_axis(const page_run *r)
{
    double lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    double box_lo[2], box_hi[2];
    for (int32_t k = 0; k < r->columns; k++)
        for (int d = 0; d < 3 && is_marked(&r->column[k]); d++) {
            lo[d] = fmin(lo[d], r->column[k].at[d]);
            hi[d] = fmax(hi[d], r->column[k].at[d]);
        }
    const bool z = hi[2] - lo[2] > (hi[0] - lo[0]) * (1 + 1e-9);
    return mps__page_number(r, "dim") == 3 && z && tank_box(r, 2, box_lo, box_hi) ? 2 : 0;
}

static int collect(const sketch *s, const page_run *r, mark *all)
{
    int count = 0;
    for (int32_t k = 0; k < r->columns && count < MARKS; k++) {
        const page_column *c = &r->column[k];
        if (!is_marked(c)) continue;
        mark *m = &all[count++];
        const bool gauge = strcmp(c->type, "gauge") == 0;
        *m = (mark){.column = c, .x = at_x(s, c->at[s->axis]), .y = at_y(s, c->at[1])};
        m->side = gauge ? ABOVE : c->at[s->axis] < (s->lo[0] + s->hi[0]) / 2 ? LEFT : RIGHT;
        m->label = gauge ? m->x : m->y;
    }
    return count;
}

static int compare_marks(const void *a, const void *b)
{
    const mark *x = a, *y = b;
    if (x->side != y->side) return (x->side > y->side) - (x->side < y->side);
    return (x->label > y->label) - (x->label < y->label);
}

/* Move labels of a side apart, then back from its end. */
static void spread(mark *m, int count, double apart, double end)
{
    for (int k = 1; k < count; k++) m[k].label = fmax(m[k].label, m[k - 1].label + apart);
    double most = end;
    for (int k = count - 1; k >= 0; k--, most -= apart) m[k].label = fmin(m[k].label, most);
}

static void spread_all(const sketch *s, mark *all, int count)
{
    qsort(all, (size_t)count, sizeof *all, compare_marks);
    for (int from = 0, to; from < count; from = to) {
        for (to = from; to < count && all[to].side == all[from].side;) to++;
        const bool above = all[from].side == ABOVE;
        spread(all + from, to - from, above ? 62 : APART, above ? s->width - 30 : s->height - FOOT);
    }
}

static void write_mark(const sketch *s, const mark *m)
{
    const char *name = m->column->name;
    const double y = m->side == ABOVE ? TOP - 18 : m->label;
    const double x = m->side == LEFT    ? MARGIN - 30
                     : m->side == RIGHT ? s->width - MARGIN + 30
                                        : m->label;
    fputs("<g class=\"sensor\" role=\"button\" tabindex=\"0\" data-column=\"", s->out);
    mps__html(s->out, name);
    fputs("\" aria-label=\"Show the curve of ", s->out);
    mps__html(s->out, name);
    fputs("\"><title>", s->out);
    mps__html(s->out, m->column->about);
    fputs("</title>", s->out);
    if (m->side == ABOVE)
        fprintf(s->out, "<path d=\"M%.1f %.1fV%.1fL%.1f %.1f\"/>", m->x, m->y, (double)TOP - 6, x,
                y + 4);
    else
        fprintf(s->out,
                "<path d=\"M%.1f %.1fL%.1f %.1f\"/><circle cx=\"%.1f\" cy=\"%.1f\" r=\"5\"/>", m->x,
                m->y, x, y, m->x, m->y);
    const double wide = fmax(56, 6.8 * (double)strlen(name) + 10); /* of a label */
    const double middle = m->side == LEFT ? 2 - wide / 2 : m->side == RIGHT ? wide / 2 - 2 : 0;
    fprintf(s->out,
            "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"16\" rx=\"4\"/><text x=\"%.1f\" "
            "y=\"%.1f\">",
            x + middle - wide / 2, y - (m->side == ABOVE ? 12 : 8), wide, x + middle,
            y + (m->side == ABOVE ? 0 : 4));
    mps__html(s->out, name);
    fputs("</text></g>\n", s->out);
}

/* The outline of the tank: the first one, if its box is that of the tank; a file has none. NULL: it
 * is a box */
static const json_value *tank_outline(const sketch *s, const page_run *r)
{
    const json_value *polygon = mps__json_at(mps__json_get(r->summary, "outline"), 0);
    if (s->axis != 0) return NULL;
    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
    for (size_t i = 0; i < mps__json_count(polygon); i++)
        for (int d = 0; d < 2; d++) {
            const double x = mps__json_number(mps__json_at(mps__json_at(polygon, i), (size_t)d));
            lo[d] = fmin(lo[d], x);
            hi[d] = fmax(hi[d], x);
        }
    for (int d = 0; d < 2; d++) {
        const double slack = 1e-3 * (s->hi[d] - s->lo[d]);
        if (!(fabs(lo[d] - s->lo[d]) < slack && fabs(hi[d] - s->hi[d]) < slack)) return NULL;
    }
    return polygon;
}

static void write_points(const sketch *s, const json_value *polygon)
{
    for (size_t i = 0; i < mps__json_count(polygon); i++) {
        const json_value *point = mps__json_at(polygon, i);
        fprintf(s->out, "%.1f,%.1f ", at_x(s, mps__json_number(mps__json_at(point, 0))),
                at_y(s, mps__json_number(mps__json_at(point, 1))));
    }
}

static void write_level(const sketch *s, const page_run *r)
{
    const json_value *polygon = tank_outline(s, r);
    double y = mps__page_number(r, "level");
    if (!isfinite(y)) y = mps__page_number(r, "still_level");
    if (!(y > s->lo[1] && y < s->hi[1])) return;
    const double wide = (s->hi[0] - s->lo[0]) * s->scale;
    if (polygon) {
        fputs("<clipPath id=\"inside-tank\"><polygon points=\"", s->out);
        write_points(s, polygon);
        fputs("\"/></clipPath>\n", s->out);
    }
    fprintf(s->out,
            "<rect class=\"liquid\" x=\"%d\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\"%s/>\n",
            MARGIN, at_y(s, y), wide, (y - s->lo[1]) * s->scale,
            polygon ? " clip-path=\"url(#inside-tank)\"" : "");
    fprintf(s->out, "<path class=\"level\" d=\"M%.1f %.1fl-6 -9h12z\"/>\n", MARGIN + wide / 2,
            at_y(s, y));
}

/* Polygons of the tank and its solids, or its box. */
static void write_outline(const sketch *s, const page_run *r)
{
    const json_value *outline = s->axis == 0 ? mps__json_get(r->summary, "outline") : NULL;
    if (mps__json_count(outline) == 0)
        fprintf(s->out, "<rect class=\"tank\" x=\"%d\" y=\"%d\" width=\"%.1f\" height=\"%.1f\"/>\n",
                MARGIN, TOP, (s->hi[0] - s->lo[0]) * s->scale, (s->hi[1] - s->lo[1]) * s->scale);
    for (size_t k = 0; k < mps__json_count(outline); k++) {
        fputs("<polygon class=\"tank\" points=\"", s->out);
        write_points(s, mps__json_at(outline, k));
        fputs("\"/>\n", s->out);
    }
}

static void write_sizes(const sketch *s)
{
    char text[TEXT_NUMBER];
    const double foot = s->height - FOOT + 14, left = MARGIN, right = s->width - MARGIN;
    fprintf(s->out, "<g class=\"size\"><path d=\"M%.1f %.1fH%.1fM%.1f %.1fv8M%.1f %.1fv8\"/>", left,
            foot, right, left, foot - 4, right, foot - 4);
    fprintf(s->out, "<text x=\"%.1f\" y=\"%.1f\">%s</text>", (left + right) / 2, foot + 18,
            mps__quantity(text, s->hi[0] - s->lo[0], "m"));
    const double middle = (at_y(s, s->lo[1]) + TOP) / 2;
    fprintf(s->out,
            "<path d=\"M12 %dV%.1fM8 %dh8M8 %.1fh8\"/><text transform=\"translate(26 %.1f) "
            "rotate(-90)\">%s</text></g>\n",
            TOP, at_y(s, s->lo[1]), TOP, at_y(s, s->lo[1]), middle,
            mps__quantity(text, s->hi[1] - s->lo[1], "m"));
}

/* ---- table ---- */

static void write_place(FILE *out, const page_run *r, const page_column *c)
{
    char text[TEXT_NUMBER];
    for (int d = 0; d < (mps__page_number(r, "dim") == 3 ? 3 : 2); d++)
        fprintf(out, "%s%s", d ? ", " : "", mps__rounded(text, c->at[d]));
    fputs(" m", out);
}

/* Largest value of a column after the impulse at the start, and its time. Rounding errors relative
 * to the other value are set to 0. */
static void write_extremes(FILE *out, const page_run *r, const page_column *c)
{
    const mps__csv *t = &r->probes;
    const double *time = t->value[0], *v = t->value[c->place];
    const double start = 0.005 * mps__page_number(r, "t_end");
    char text[TEXT_NUMBER];
    int64_t high = -1, low = -1;
    for (int64_t i = 0; i < t->rows; i++) {
        if (!isfinite(v[i]) || time[i] < start) continue;
        if (high < 0 || v[i] > v[high]) high = i;
        if (low < 0 || v[i] < v[low]) low = i;
    }
    const int64_t row[] = {high, low};
    double most = 0;
    for (int k = 0; k < 2; k++)
        if (row[k] >= 0) most = fmax(most, fabs(v[row[k]]));
    for (int k = 0; k < 2; k++) {
        const double value = row[k] >= 0 ? v[row[k]] : NAN, at = row[k] >= 0 ? time[row[k]] : NAN;
        fputs("<td class=\"number\">", out);
        mps__html(out, mps__quantity(text, fabs(value) < 1e-6 * most ? 0 : value, c->unit));
        fprintf(out, "</td><td class=\"number\">%s</td>", mps__quantity(text, at, "s"));
    }
}

void mps__page_extremes(FILE *out, const page_run *r, const char *caption,
                        bool (*wanted)(const page_column *c))
{
    fprintf(out,
            "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"%s\">"
            "<table><thead><tr><th>name</th><th>largest</th><th>at</th><th>least</th><th>at</th>"
            "<th>where</th></tr></thead><tbody>\n",
            caption);
    for (int32_t k = 0; k < r->columns; k++) {
        const page_column *c = &r->column[k];
        if (c->place < 0 || !wanted(c)) continue;
        fputs("<tr><th scope=\"row\">", out);
        mps__html(out, c->name);
        fputs("</th>", out);
        write_extremes(out, r, c);
        fputs("<td>", out);
        if (c->has_place)
            write_place(out, r, c);
        else
            mps__html(out, c->about);
        fputs("</td></tr>\n", out);
    }
    fputs("</tbody></table></div>\n", out);
}

static void write_drawing(const sketch *s, const page_run *r, const mark *all, int count)
{
    fprintf(
        s->out,
        "<svg class=\"sketch\" viewBox=\"0 0 %.0f %.0f\" role=\"group\" aria-label=\"Tank with its "
        "sensors\">\n",
        s->width, s->height);
    write_level(s, r);
    write_outline(s, r);
    write_sizes(s);
    for (int k = 0; k < count; k++) write_mark(s, &all[k]);
    fputs("</svg>\n", s->out);
}

void mps__page_sketch(FILE *out, const page_run *r)
{
    sketch s = {.out = out};
    mark all[MARKS];
    s.axis = chosen_axis(r);
    if (!tank_box(r, s.axis, s.lo, s.hi)) return;
    const double wide = s.hi[0] - s.lo[0], tall = s.hi[1] - s.lo[1];
    s.scale = fmin((WIDTH - 2 * MARGIN) / wide, (TALLEST - TOP - FOOT) / tall);
    s.width = wide * s.scale + 2 * MARGIN;
    s.height = tall * s.scale + TOP + FOOT;
    const int count = collect(&s, r, all);
    spread_all(&s, all, count);
    fputs(
        "<section id=\"sensors\" aria-labelledby=\"sensors-title\">\n<h2 id=\"sensors-title\">Tank "
        "and sensors</h2>\n<div class=\"two\"><figure>\n",
        out);
    write_drawing(&s, r, all, count);
    fprintf(out,
            "<figcaption>%sPlaces are in the frame of the tank, which moves with it; y is up.%s"
            "</figcaption></figure>\n",
            count ? "Choose a sensor to see its curve. " : "",
            s.axis == 2 ? " Seen along x: z to the right. The box of the tank."
            : mps__page_number(r, "dim") == 3 ? " Seen along -z."
                                              : "");
    if (count > 0) mps__page_extremes(out, r, "Extremes of the sensors", is_marked);
    fputs("</div>\n</section>\n", out);
}

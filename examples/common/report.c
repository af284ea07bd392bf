/* SPDX-License-Identifier: BSD-3-Clause */
/* Plots of a run, and report.html: one page with everything in it that works offline. */
#include "outputs.h"
#include "svg_plot.h"
#include "ranks.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { REPORT_PLOTS = 13, PLOT_TITLE = 200, PLOT_LABEL = 48 };

/* All plots of a run with the file each goes to. */
typedef struct plots {
    int count;
    plot plot[REPORT_PLOTS];
    char file[REPORT_PLOTS][48], title[REPORT_PLOTS][PLOT_TITLE], label[REPORT_PLOTS][PLOT_LABEL];
    char note[240]; /* below the plot of pressures; "": none */
} plots;

static plot *plots_add(plots *all, const char *file, const char *title, const char *y_label)
{
    if (all->count == REPORT_PLOTS) return NULL; /* what does not fit is not drawn */
    plot *p = &all->plot[all->count];
    *p = (plot){.title = title, .x_label = "t [s]", .y_label = y_label};
    snprintf(all->file[all->count++], sizeof all->file[0], "%s", file);
    return p;
}

static plot_series column_of(const table *t, const char *label, int column, double shift)
{
    return (plot_series){.label = label,
                         .x = t->kept,
                         .y = t->kept + column,
                         .count = t->count,
                         .stride = t->columns,
                         .shift = shift};
}

/* Leave out the first half per cent of a run: the impulse of walls that start at speed would flatten all the rest.
 * @return true if there was something */
static bool skip_start(plot_series *s, double t_end)
{
    const int64_t before = s->count;
    while (s->count > 2 && s->x[0] < 0.005 * t_end) {
        s->x += s->stride;
        s->y += s->stride;
        s->count--;
    }
    return s->count < before;
}

/* The known points of a unit. */
static void plots_marks(plot *p, const run *r, const char *unit)
{
    for (int i = 0; i < r->marks; i++) {
        const run_mark *m = &r->mark[i];
        if (strcmp(m->unit, unit) != 0) continue;
        plot_add(p, (plot_series){.label = m->label,
                                  .x = m->t,
                                  .y = m->value,
                                  .count = m->count,
                                  .stride = 1,
                                  .marks = true});
    }
}

/* Put `text` behind what is there, unless it is in it. */
static void list_add(char *list, size_t size, const char *text)
{
    const size_t used = strlen(list);
    if (strstr(list, text)) return;
    snprintf(list + used, size - used, "%s%s", used ? "; " : "", text);
}

/* What the own columns of a unit are, title of their plot. */
static void plots_title(plots *all, plot *p, const run *r, const char *unit)
{
    char *title = all->title[p - all->plot], *label = all->label[p - all->plot], one[96];
    int kinds = 0;
    title[0] = '\0';
    for (int i = 0; i < r->own_columns; i++) {
        const size_t before = strlen(title);
        if (strcmp(r->column[i].unit, unit) != 0) continue;
        run_column_title(&r->column[i], one, sizeof one);
        list_add(title, PLOT_TITLE, one);
        kinds += strlen(title) > before;
    }
    if (kinds != 1 || strlen(one) > PLOT_LABEL - 12) one[0] = '\0'; /* the unit alone */
    if (unit[0])
        snprintf(label, PLOT_LABEL, "%.36s%s[%s]", one, one[0] ? " " : "", unit);
    else
        snprintf(label, PLOT_LABEL, "%.36s", one);
    p->title = title;
    p->y_label = label;
}

/* One plot for all own columns of a unit, with the known points of that unit. */
static void plots_unit(plots *all, const run *r, const char *unit, const char *first)
{
    bool pressure = strcmp(unit, "Pa") == 0, length = strcmp(unit, "m") == 0;
    char file[48];
    snprintf(file, sizeof file, "plot_%s.svg",
             pressure ? "pressure"
             : length ? "elevation"
                      : first);
    plot *p = plots_add(all, file, "", "");
    if (!p) return;
    plots_title(all, p, r, unit);
    for (int i = 0; i < r->own_columns; i++) {
        if (strcmp(r->column[i].unit, unit) != 0) continue;
        plot_series column = column_of(&r->probes, r->column[i].name, 1 + i, 0);
        if (pressure && skip_start(&column, r->options.t_end))
            snprintf(
                all->note, sizeof all->note,
                "Not drawn: t < %.3g s, the first half per cent of the run, where walls that start "
                "at speed make an impulse; see probes.csv",
                0.005 * r->options.t_end);
        plot_add(p, column);
    }
    if (pressure && all->note[0]) p->note = all->note;
    plots_marks(p, r, unit);
}

static void plots_columns(plots *all, const run *r)
{
    for (int i = 0; i < r->own_columns; i++) {
        bool first = true;
        for (int k = 0; k < i; k++)
            if (strcmp(r->column[k].unit, r->column[i].unit) == 0) first = false;
        if (first) plots_unit(all, r, r->column[i].unit, r->column[i].name);
    }
}

static double last_of(const table *t, int column)
{
    return t->count > 0 ? t->kept[(t->count - 1) * t->columns + column] : 0;
}

static void plots_energy(plots *all, const run *r)
{
    const table *t = &r->probes;
    int base = r->own_columns;
    double pe = t->count > 0 ? t->kept[base + COLUMN_PE] : 0;
    plot *p = plots_add(all, "plot_energy.svg", "Energy budget",
                        r->options.dim == 3 ? "E [J]" : "E [J/m]");
    plot_add(p, column_of(t, "kinetic", base + COLUMN_KE, 0));
    plot_add(p, column_of(t, "potential - start", base + COLUMN_PE, -pe));
    plot_add(p, column_of(t, "work of walls", base + COLUMN_WALL_WORK, 0));
    plot_add(p, column_of(t, "lost: viscous", base + COLUMN_VISCOUS, 0));
    if (last_of(t, base + COLUMN_PLUGINS) != 0)
        plot_add(p, column_of(t, "lost: plug-ins", base + COLUMN_PLUGINS, 0));
    plot_add(p, column_of(t, "lost: collision", base + COLUMN_COLLISION, 0));
    plot_add(p, column_of(t, "lost: shift", base + COLUMN_SHIFT, 0));
    plot_add(p, column_of(t, "lost: numerical", base + COLUMN_NUMERICAL, 0));
    if (last_of(t, base + COLUMN_ADDED) != 0)
        plot_add(p, column_of(t, "added", base + COLUMN_ADDED, 0));
}

/* What acts along one axis; weight and floor, which balance each other, would hide the rest. */
static void plots_momentum(plots *all, const run *r, int axis)
{
    static const char *const file[] = {"plot_momentum_x.svg", "plot_momentum_y.svg",
                                       "plot_momentum_z.svg"};
    static const char *const title[] = {"Momentum along x", "Momentum along y", "Momentum along z"};
    const table *t = &r->momentum;
    const int base = 1 + axis * MOMENTUM_COLUMNS;
    const double weight = last_of(t, base + MOMENTUM_GRAVITY);
    plot *p = plots_add(all, file[axis], title[axis], r->options.dim == 3 ? "[N s]" : "[N s/m]");
    plot_add(p, column_of(t, "momentum", base + MOMENTUM_TOTAL, 0));
    if (weight == 0) plot_add(p, column_of(t, "from walls", base + MOMENTUM_WALLS, 0));
    plot_add(p, column_of(t, "from force models", base + MOMENTUM_FORCE, 0));
    plot_add(p, column_of(t, "from collisions", base + MOMENTUM_COLLISION, 0));
    plot_add(p, column_of(t, "from shifts", base + MOMENTUM_SHIFT, 0));
    if (last_of(t, base + MOMENTUM_ADDED) != 0)
        plot_add(p, column_of(t, "added", base + MOMENTUM_ADDED, 0));
    plot_add(p, column_of(t, "numerical", base + MOMENTUM_NUMERICAL, 0));
}

static void plots_make(plots *all, const run *r)
{
    all->count = 0;
    all->note[0] = '\0';
    plots_columns(all, r);
    plots_energy(all, r);
    for (int d = 0; d < (r->options.dim == 3 ? 3 : 2); d++) plots_momentum(all, r, d);
    plot_add(plots_add(all, "plot_dt.svg", "Time step", "dt [s]"),
             column_of(&r->steps, "dt", STEP_DT, 0));
    plot_add(plots_add(all, "plot_ppe.svg", "Pressure solver", "iterations"),
             column_of(&r->steps, "iterations", STEP_ITERATIONS, 0));
    plot_add(plots_add(all, "plot_speed.svg", "Largest speed", "|u| [m/s]"),
             column_of(&r->steps, "largest speed", STEP_SPEED, 0));
}

/* ---- the page --------------------------------------------------------------------------------------------------- */

static void html_row(FILE *out, const char *name, const char *value)
{
    fputs("<tr><td>", out);
    svg_text(out, name);
    fputs("</td><td>", out);
    svg_text(out, value);
    fputs("</td></tr>\n", out);
}

static void html_number(FILE *out, const char *name, double value, const char *unit)
{
    char text[64];
    snprintf(text, sizeof text, "%.6g %s", value, unit);
    html_row(out, name, text);
}

/* "0 to 1.2, 0 to 0.6" [m] */
static void html_box(FILE *out, const char *name, const run_box *b, int dim)
{
    char text[128] = "";
    for (int d = 0; b->count > 0 && d < dim; d++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "%s%c = %.6g to %.6g",
                 d ? ", " : "", "xyz"[d], b -> lo[d], b -> hi[d]);
    if (b->count == 0) return;
    snprintf(text + strlen(text), sizeof text - strlen(text), " m");
    html_row(out, name, text);
}

/* Size of the tank, place and depth of the liquid. */
static void html_boxes(FILE *out, const run *r)
{
    const double *lo = r->walls.lo, *hi = r->walls.hi, depth = run_depth(r);
    char text[96];
    int used = snprintf(text, sizeof text, "%.6g x %.6g", hi[0] - lo[0], hi[1] - lo[1]);
    snprintf(text + used, sizeof text - (size_t)used, r->options.dim == 3 ? " x %.6g m" : " m",
             hi[2] - lo[2]);
    if (r->walls.count > 0) html_row(out, "inner size of the tank", text);
    html_box(out, "tank: faces of the walls", &r->walls, r->options.dim);
    if (isfinite(depth)) html_number(out, "depth of liquid at the start", depth, "m");
    html_box(out, "liquid at the start: centres of particles", &r->liquid, r->options.dim);
}

/* What each column of probes.csv is, and where. */
static void html_columns(FILE *out, const run *r)
{
    char name[48];
    fputs("<h2>Columns of probes.csv</h2>\n<table>\n", out);
    html_row(out, "t [s]", "Time");
    for (int k = 0; k < run_columns_all(r); k++) {
        const run_column c = run_column_at(r, k);
        snprintf(name, sizeof name, c.unit[0] ? "%s [%s]" : "%s", c.name, c.unit);
        html_row(out, name, c.about);
    }
    fputs("</table>\n<p>Places are in the frame of the tank, which moves with it; y is up.", out);
    if (r->options.dim == 2) fputs(" Forces and energies are those of 1 m of width.", out);
    fputs("</p>\n", out);
}

/* The driver's own numbers: value, and what it is. */
static void html_figures(FILE *out, const run *r)
{
    char text[200];
    if (r->figures == 0) return;
    fputs("<h2>Numbers of this case, also in summary.json</h2>\n<table>\n", out);
    for (int i = 0; i < r->figures; i++) {
        const run_figure *f = &r->figure[i];
        if (isfinite(f->measured))
            snprintf(text, sizeof text, "%.6g: %s", f->measured, f->about);
        else
            snprintf(text, sizeof text, "not reached: %s", f->about);
        html_row(out, f->name, text);
    }
    fputs("</table>\n", out);
}

static void html_settings(FILE *out, const run *r)
{
    const cli_options *o = &r->options;
    fputs("<h2>Settings</h2>\n<table>\n", out);
    html_row(out, "model", o->model);
    html_row(out, "solver", o->solver);
    html_number(out, "dimensions", o->dim, "");
    html_number(out, "spacing dp", o->dp, "m");
    html_boxes(out, r);
    if (o->dt > 0)
        html_number(out, "time step, fixed", o->dt, "s");
    else
        html_number(out, "time step: largest dt u / dp", o->cfl, "");
    html_number(out, "time asked for", o->t_end, "s");
    html_number(out, "threads", o->threads, "");
    if (ranks_count() > 1) html_number(out, "ranks", ranks_count(), "");
    html_row(out, "libmps", mps_version(NULL, NULL, NULL));
    fputs("</table>\n", out);
}

static void html_results(FILE *out, const run *r)
{
    const run_totals *s = &r->totals;
    double steps = s->steps > 0 ? (double)s->steps : 1,
           here = s->steps_here > 0 ? (double)s->steps_here : 1;
    fputs("<h2>Run</h2>\n<table>\n", out);
    html_row(out, "status", s->status);
    if (s->error[0]) html_row(out, "message", s->error);
    html_number(out, "time reached", s->t, "s");
    html_number(out, "fluid particles", (double)s->fluid, "");
    html_number(out, "wall particles", (double)s->wall, "");
    html_number(out, "dummy particles", (double)s->dummy, "");
    html_number(out, "particles lost", (double)s->lost, "");
    html_number(out, "error of volume", 100 * s->volume_error, "%");
    html_number(out, "largest speed", s->max_speed, "m/s");
    html_number(out, "steps", (double)s->steps, "");
    html_number(out, "mean time step", s->t / steps, "s");
    html_number(out, "pressure iterations a step", s->ppe_iterations / steps, "");
    if (s->t_before > 0) html_number(out, "wall clock is that since t =", s->t_before, "s");
    html_number(out, "wall clock", s->wall_s, "s");
    html_number(out, "wall clock a step", 1e3 * s->step_s / here, "ms");
    fputs("</table>\n", out);
}

static void base64_write(FILE *out, const unsigned char *data, size_t size)
{
    static const char
        *const digit = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        size_t left = size - i;
        unsigned long v = (unsigned long)data[i] << 16 |
                          (left > 1 ? (unsigned long)data[i + 1] << 8 : 0) |
                          (left > 2 ? data[i + 2] : 0);
        fputc(digit[v >> 18 & 63], out);
        fputc(digit[v >> 12 & 63], out);
        fputc(left > 1 ? digit[v >> 6 & 63] : '=', out);
        fputc(left > 2 ? digit[v & 63] : '=', out);
    }
}

static unsigned char *file_read(const char *path, size_t *size)
{
    FILE *in = fopen(path, "rb");
    if (!in) return NULL;
    long length = fseek(in, 0, SEEK_END) == 0 ? ftell(in) : -1;
    unsigned char *data = length > 0 ? malloc((size_t)length) : NULL;
    rewind(in);
    *size = data ? fread(data, 1, (size_t)length, in) : 0;
    fclose(in);
    return data;
}

/* What is seen in a picture at a time [s]; NAN: it is not known here. */
static void picture_text(char *text, size_t size, const run *r, double t)
{
    const bool several = r->options.both_phases || run_has_gas(r);
    int used = 0;
    if (isfinite(t)) used = snprintf(text, size, "t = %.4g s: ", t);
    snprintf(text + used, size - (size_t)used,
             "%s, coloured by pressure [Pa] as the %s; walls are dark grey balls, the dummies "
             "behind them light grey ones",
             r->options.dim == 3 ? "middle slice of the particles of fluid" : "particles of fluid",
             several ? "bars at the right show, one for each phase" : "bar at the right shows");
}

/* Embed one picture; a run that broke off early has fewer of them. */
static void html_picture(FILE *out, const run *r, const char *name, double t)
{
    char path[560], text[320];
    size_t size = 0;
    snprintf(path, sizeof path, "%s/%s", r->options.out, name);
    unsigned char *data = file_read(path, &size);
    if (data) {
        picture_text(text, sizeof text, r, t);
        fprintf(out, "<figure><img alt=\"%s\" src=\"data:image/png;base64,", text);
        base64_write(out, data, size);
        fprintf(out, "\">\n<figcaption>%s: %s.</figcaption></figure>\n", name, text);
    }
    free(data);
}

static void report_write(FILE *out, const run *r, const plots *all)
{
    fprintf(out,
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>%s</title>\n",
            r->options.program);
    fputs("<style>body{font:15px sans-serif;color:#222;max-width:1120px;margin:2em auto;padding:0 "
          "1em}table{border-collapse:collapse}"
          "td{border-bottom:1px solid #ddd;padding:3px 18px 3px "
          "0}figure{margin:1.5em "
          "0}figcaption{color:#555}img,svg{max-width:100%;height:auto}.two{display:flex;flex-wrap:"
          "wrap;gap:4em}</style></"
          "head><body>\n",
          out);
    fprintf(out, "<h1>%s</h1>\n<p>", r->options.program);
    svg_text(out, r->options.about);
    fputs("</p>\n<div class=\"two\"><div>\n", out);
    html_settings(out, r);
    fputs("</div><div>\n", out);
    html_results(out, r);
    fputs("</div></div>\n", out);
    html_columns(out, r);
    html_figures(out, r);
    fputs("<h2>Curves</h2>\n", out);
    for (int i = 0; i < all->count; i++) plot_svg(out, &all->plot[i]);
    fputs("<h2>Pictures</h2>\n", out);
    for (int i = 1; i <= r->pictures; i++) {
        char name[32];
        snprintf(name, sizeof name, "picture_%d.png", i);
        html_picture(out, r, name, r->picture_at[i - 1]);
    }
    html_picture(out, r, "picture_end.png", r->totals.t);
    fputs("</body></html>\n", out);
}

static bool report_page(const run *r, const plots *all)
{
    char path[560];
    snprintf(path, sizeof path, "%s/report.html", r->options.out);
    FILE *out = fopen(path, "w");
    if (out) report_write(out, r, all);
    bool failed = !out || ferror(out);
    if (out && fclose(out) != 0) failed = true;
    if (failed) fprintf(ranks_messages(), "%s: %s\n", path, strerror(errno));
    return !failed;
}

bool report_save(const run *r)
{
    plots all;
    bool done = true;
    plots_make(&all, r);
    for (int i = 0; i < all.count; i++)
        done = plot_save(r->options.out, all.file[i], &all.plot[i]) && done;
    return (!r->options.report || report_page(r, &all)) && done;
}

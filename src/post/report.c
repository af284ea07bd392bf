/* SPDX-License-Identifier: BSD-3-Clause */
/* Plots of a run, and report.html: one page with everything in it that works offline. */
#include "report.h"
#include "svg_plot.h"
#include "tables.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
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

static plot_series column_of(const report_table *t, const char *label, int column, double shift)
{
    return (plot_series){.label = label,
                         .x = t->rows,
                         .y = t->rows + column,
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
static void plots_references(plot *p, const report *r, const char *unit)
{
    for (int i = 0; i < r->references; i++) {
        const report_reference *m = &r->reference[i];
        if (strcmp(m->unit, unit) != 0) continue;
        mps__plot_add(p, (plot_series){.label = m->label,
                                       .x = m->t,
                                       .y = m->value,
                                       .count = m->count,
                                       .stride = 1,
                                       .marks = !m->line});
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
static void plots_title(plots *all, plot *p, const report *r, const char *unit)
{
    char *title = all->title[p - all->plot], *label = all->label[p - all->plot], one[96];
    int kinds = 0;
    title[0] = '\0';
    for (int i = 0; i < r->added; i++) {
        const size_t before = strlen(title);
        if (strcmp(r->column[i].unit, unit) != 0) continue;
        snprintf(one, sizeof one, "%.*s", (int)strcspn(r->column[i].about, ":"),
                 r->column[i].about);
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
static void plots_unit(plots *all, const report *r, const char *unit, const char *first)
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
    for (int i = 0; i < r->added; i++) {
        if (strcmp(r->column[i].unit, unit) != 0) continue;
        plot_series column = column_of(&r->probes, r->column[i].name, 1 + i, 0);
        if (pressure && skip_start(&column, r->t_end))
            snprintf(
                all->note, sizeof all->note,
                "Not drawn: t < %.3g s, the first half per cent of the run, where walls that start "
                "at speed make an impulse; see probes.csv",
                0.005 * r->t_end);
        mps__plot_add(p, column);
    }
    if (pressure && all->note[0]) p->note = all->note;
    plots_references(p, r, unit);
}

static void plots_columns(plots *all, const report *r)
{
    for (int i = 0; i < r->added; i++) {
        bool first = true;
        for (int k = 0; k < i; k++)
            if (strcmp(r->column[k].unit, r->column[i].unit) == 0) first = false;
        if (first) plots_unit(all, r, r->column[i].unit, r->column[i].name);
    }
}

static double last_of(const report_table *t, int column)
{
    return t->count > 0 ? t->rows[(t->count - 1) * t->columns + column] : 0;
}

static void plots_energy(plots *all, const report *r)
{
    const report_table *t = &r->probes;
    int base = r->added;
    double pe = t->count > 0 ? t->rows[base + COLUMN_PE] : 0;
    plot *p = plots_add(all, "plot_energy.svg", "Energy budget", r->dim == 3 ? "E [J]" : "E [J/m]");
    mps__plot_add(p, column_of(t, "kinetic", base + COLUMN_KE, 0));
    mps__plot_add(p, column_of(t, "potential - start", base + COLUMN_PE, -pe));
    mps__plot_add(p, column_of(t, "work of walls", base + COLUMN_WALL_WORK, 0));
    mps__plot_add(p, column_of(t, "lost: viscous", base + COLUMN_VISCOUS, 0));
    if (last_of(t, base + COLUMN_PLUGINS) != 0)
        mps__plot_add(p, column_of(t, "lost: plug-ins", base + COLUMN_PLUGINS, 0));
    mps__plot_add(p, column_of(t, "lost: collision", base + COLUMN_COLLISION, 0));
    mps__plot_add(p, column_of(t, "lost: shift", base + COLUMN_SHIFT, 0));
    mps__plot_add(p, column_of(t, "lost: numerical", base + COLUMN_NUMERICAL, 0));
    if (last_of(t, base + COLUMN_ADDED) != 0)
        mps__plot_add(p, column_of(t, "added", base + COLUMN_ADDED, 0));
}

/* What acts along one axis; weight and floor, which balance each other, would hide the rest. */
static void plots_momentum(plots *all, const report *r, int axis)
{
    static const char *const file[] = {"plot_momentum_x.svg", "plot_momentum_y.svg",
                                       "plot_momentum_z.svg"};
    static const char *const title[] = {"Momentum along x", "Momentum along y", "Momentum along z"};
    const report_table *t = &r->momentum;
    const int base = 1 + axis * MOMENTUM_COLUMNS;
    const double weight = last_of(t, base + MOMENTUM_GRAVITY);
    plot *p = plots_add(all, file[axis], title[axis], r->dim == 3 ? "[N s]" : "[N s/m]");
    mps__plot_add(p, column_of(t, "momentum", base + MOMENTUM_TOTAL, 0));
    if (weight == 0) mps__plot_add(p, column_of(t, "from walls", base + MOMENTUM_WALLS, 0));
    mps__plot_add(p, column_of(t, "from force models", base + MOMENTUM_FORCE, 0));
    mps__plot_add(p, column_of(t, "from collisions", base + MOMENTUM_COLLISION, 0));
    mps__plot_add(p, column_of(t, "from shifts", base + MOMENTUM_SHIFT, 0));
    if (last_of(t, base + MOMENTUM_ADDED) != 0)
        mps__plot_add(p, column_of(t, "added", base + MOMENTUM_ADDED, 0));
    mps__plot_add(p, column_of(t, "numerical", base + MOMENTUM_NUMERICAL, 0));
}

static void plots_make(plots *all, const report *r)
{
    all->count = 0;
    all->note[0] = '\0';
    plots_columns(all, r);
    plots_energy(all, r);
    for (int d = 0; d < (r->dim == 3 ? 3 : 2); d++) plots_momentum(all, r, d);
    mps__plot_add(plots_add(all, "plot_dt.svg", "Time step", "dt [s]"),
                  column_of(&r->steps, "dt", STEP_DT, 0));
    mps__plot_add(plots_add(all, "plot_ppe.svg", "Pressure solver", "iterations"),
                  column_of(&r->steps, "iterations", STEP_ITERATIONS, 0));
    mps__plot_add(plots_add(all, "plot_speed.svg", "Largest speed", "|u| [m/s]"),
                  column_of(&r->steps, "largest speed", STEP_SPEED, 0));
}

/* ---- the page --------------------------------------------------------------------------------------------------- */

static void html_row(FILE *out, const char *name, const char *value)
{
    fputs("<tr><td>", out);
    mps__svg_text(out, name);
    fputs("</td><td>", out);
    mps__svg_text(out, value);
    fputs("</td></tr>\n", out);
}

/* What each column of probes.csv is, and where. */
static void html_columns(FILE *out, const report *r)
{
    char name[64];
    fputs("<h2>Columns of probes.csv</h2>\n<table>\n", out);
    html_row(out, "t [s]", "Time");
    for (int k = 0; k < r->columns; k++) {
        const report_column *c = &r->column[k];
        snprintf(name, sizeof name, c->unit[0] ? "%s [%s]" : "%s", c->name, c->unit);
        html_row(out, name, c->about);
    }
    fputs("</table>\n<p>Places are in the frame of the tank, which moves with it; y is up.", out);
    if (r->dim == 2) fputs(" Forces and energies are those of 1 m of width.", out);
    fputs("</p>\n", out);
}

/* Numbers of the case: value, and what each is. */
static void html_figures(FILE *out, const report *r)
{
    char text[320];
    if (r->figures == 0) return;
    fputs("<h2>Numbers of this case, also in summary.json</h2>\n<table>\n", out);
    for (int i = 0; i < r->figures; i++) {
        const report_column *f = &r->figure[i];
        if (isfinite(f->value))
            snprintf(text, sizeof text, "%.6g: %s", f->value, f->about);
        else
            snprintf(text, sizeof text, "not reached: %s", f->about);
        html_row(out, f->name, text);
    }
    fputs("</table>\n", out);
}

static void html_rows(FILE *out, const char *head, const report_row *rows, int count)
{
    fprintf(out, "<h2>%s</h2>\n<table>\n", head);
    for (int i = 0; i < count; i++) html_row(out, rows[i].name, rows[i].value);
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
static void picture_text(char *text, size_t size, const report *r, double t)
{
    int used = 0;
    if (isfinite(t)) used = snprintf(text, size, "t = %.4g s: ", t);
    snprintf(text + used, size - (size_t)used,
             "%s, coloured by pressure [Pa] as the %s; walls are dark grey balls, the dummies "
             "behind them light grey ones",
             r->dim == 3 ? "middle slice of the particles of fluid" : "particles of fluid",
             r->several ? "bars at the right show, one for each phase" : "bar at the right shows");
}

/* Embed one picture; a run that broke off early has fewer of them. */
static void html_picture(FILE *out, const report *r, const char *name, double t)
{
    char path[640], text[320];
    size_t size = 0;
    snprintf(path, sizeof path, "%s/%s", r->folder, name);
    unsigned char *data = file_read(path, &size);
    if (data) {
        picture_text(text, sizeof text, r, t);
        fprintf(out, "<figure><img alt=\"%s\" src=\"data:image/png;base64,", text);
        base64_write(out, data, size);
        fprintf(out, "\">\n<figcaption>%s: %s.</figcaption></figure>\n", name, text);
    }
    free(data);
}

static void report_write(FILE *out, const report *r, const plots *all)
{
    fprintf(out,
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>%s</title>\n",
            r->name);
    fputs("<style>body{font:15px sans-serif;color:#222;max-width:1120px;margin:2em auto;padding:0 "
          "1em}table{border-collapse:collapse}"
          "td{border-bottom:1px solid #ddd;padding:3px 18px 3px "
          "0}figure{margin:1.5em "
          "0}figcaption{color:#555}img,svg{max-width:100%;height:auto}.two{display:flex;flex-wrap:"
          "wrap;gap:4em}</style></"
          "head><body>\n",
          out);
    fprintf(out, "<h1>%s</h1>\n<p>", r->name);
    mps__svg_text(out, r->title);
    fputs("</p>\n<div class=\"two\"><div>\n", out);
    html_rows(out, "Settings", r->setting, r->settings);
    fputs("</div><div>\n", out);
    html_rows(out, "Run", r->result, r->results);
    fputs("</div></div>\n", out);
    html_columns(out, r);
    html_figures(out, r);
    fputs("<h2>Curves</h2>\n", out);
    for (int i = 0; i < all->count; i++) mps__plot_svg(out, &all->plot[i]);
    fputs("<h2>Pictures</h2>\n", out);
    for (int i = 0; i < r->pictures; i++) html_picture(out, r, r->picture[i], r->picture_t[i]);
    fputs("</body></html>\n", out);
}

static bool report_page(const report *r, const plots *all, char *error)
{
    char path[640];
    snprintf(path, sizeof path, "%s/report.html", r->folder);
    FILE *out = fopen(path, "w");
    if (out) report_write(out, r, all);
    bool failed = !out || ferror(out);
    if (out && fclose(out) != 0) failed = true;
    if (failed) snprintf(error, REPORT_ERROR, "%.500s: %s", path, strerror(errno));
    return !failed;
}

bool mps__report_save(const report *r, char *error)
{
    plots all;
    bool done = true;
    plots_make(&all, r);
    for (int i = 0; done && i < all.count; i++)
        if (!mps__plot_save(r->folder, all.file[i], &all.plot[i])) {
            snprintf(error, REPORT_ERROR, "%.500s/%s: %s", r->folder, all.file[i], strerror(errno));
            done = false;
        }
    return (!r->page || report_page(r, &all, error)) && done;
}

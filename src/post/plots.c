/* SPDX-License-Identifier: BSD-3-Clause */
/* Plots of a run as files of their own. */
#include "plots.h"
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
    return done;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Line plots as SVG. */
#ifndef MPS_POST_SVG_PLOT_H
#define MPS_POST_SVG_PLOT_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

enum { PLOT_SERIES = 12 };

/* One curve, or marks: element i is at x[i * stride], y[i * stride]. */
typedef struct plot_series {
    const char *label;
    const double *x, *y;
    int64_t count;
    int stride;
    double shift; /* added to y */
    bool marks;
} plot_series;

typedef struct plot {
    const char *title, *x_label, *y_label;
    const char *note; /* NULL, or a line below the plot */
    int count;
    plot_series series[PLOT_SERIES];
} plot;

/* Add a curve or marks; more than PLOT_SERIES are left out. NULL is allowed. */
void mps__plot_add(plot *p, plot_series series);
/* Write one <svg> element. */
void mps__plot_svg(FILE *out, const plot *p);
/* Write it as a file of its own. @return false: errno says why */
bool mps__plot_save(const char *folder, const char *name, const plot *p);

/* Text with the characters replaced that mean something in SVG and HTML. */
void mps__svg_text(FILE *out, const char *text);

#endif

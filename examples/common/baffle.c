/* SPDX-License-Identifier: BSD-3-Clause */
/* A vertical baffle on the lattice: its faces are columns of wall particles, so n columns are n - 1 cells thick. */
#include "baffle.h"
#include <math.h>

void baffle_add(run *r, const baffle *b, double width)
{
    double h[3], columns = r->options.layers;
    run_check(r, mps_lattice_get(r->sim, NULL, h), "baffle");
    if (columns < 1) columns = round(b->thickness / h[0]) + 1;
    double first = round(b->middle / h[0] - 0.5 * (columns - 1)) * h[0];
    const double lo[] = {first, b->bottom, 0}, hi[] = {first + (columns - 1) * h[0], b->top, width};
    run_check(r, mps_baffle_add(r->sim, "baffle", lo, hi, NULL), "baffle");
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* A vertical baffle on the lattice: its faces are columns of wall particles, so n columns are (n - 1) dp thick. */
#include "baffle.h"
#include <math.h>

void baffle_add(run *r, const baffle *b, double width)
{
    double dp = r->options.dp, columns = r->options.layers;
    if (columns < 1) columns = round(b->thickness / dp) + 1;
    double first = round(b->middle / dp - 0.5 * (columns - 1)) * dp;
    const double lo[] = {first, b->bottom, 0}, hi[] = {first + (columns - 1) * dp, b->top, width};
    run_check(r, mps_baffle_add(r->sim, "baffle", lo, hi, NULL), "baffle");
}

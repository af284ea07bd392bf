/* SPDX-License-Identifier: BSD-3-Clause */
/* The colour scale of a run, for the page and for pictures. */
#ifndef MPS_POST_PAGE_SCALE_H
#define MPS_POST_PAGE_SCALE_H

#include <stdbool.h>
#include <stdint.h>

enum { SCALE_MAPS = 3, SCALE_COLOURS = 5 };

/* Red, green, blue (0..1) of each phase (modulo SCALE_MAPS) at equal steps: dark to light, so that
 * the maps are readable in grey too. Phase 1, usually the gas above the liquid, is pale. In the
 * colour-blindness simulation of Machado et al. 2009 no colour of one phase is close to one of
 * another (Delta E 17 or more for protan and deutan readers). */
extern const double mps__scale_map[SCALE_MAPS][SCALE_COLOURS][3];

/* A quantity over a whole run: the colours span lo to hi, values span least to most. */
typedef struct page_scale {
    double lo, hi, least, most;
    int64_t count; /* of the sample */
    double *sample;
} page_scale;

/* Add a value of the run to the sample. @return false: memory is exhausted */
bool mps__scale_take(page_scale *s, double value);
/* lo and hi of the sample, which is freed: hi is the 99 % quantile rounded up to two digits, so
 * that one peak does not flatten the rest.
 * @param noise   least hi: values below it are rounding
 * @param bottom  false: lo is 0; true: the 1 % quantile if it is negative, for closed tanks full of
 * fluid */
void mps__scale_end(page_scale *s, double noise, bool bottom);
/* A value as a byte, not 0: linear 1 .. 224 from lo to hi; above, quadratic up to 255 at most. */
unsigned char mps__scale_code(const page_scale *s, double value);

#endif

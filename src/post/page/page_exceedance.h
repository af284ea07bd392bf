/* SPDX-License-Identifier: BSD-3-Clause */
/* Drawing of the exceedance of peaks. */
#ifndef MPS_POST_PAGE_EXCEEDANCE_H
#define MPS_POST_PAGE_EXCEEDANCE_H

#include <mps/stats.h>
#include <stdio.h>

/* Fraction of the peaks above a pressure, on a logarithmic axis: points, their confidence band,
 * both fits. Nothing if there are fewer than two peaks. */
void mps__page_exceedance(FILE *out, const mps_impacts *impacts, const char *name);

#endif

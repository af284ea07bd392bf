/* SPDX-License-Identifier: BSD-3-Clause */
/* Helpers of the models of the fluid. */
#include "helpers.h"
#include <math.h>

void mps__density_range(const mps_stage *s, double range[2])
{
    double least[MPS_PHASES], greatest[MPS_PHASES];
    mps_stage_densities(s, least, greatest);
    range[0] = INFINITY;
    range[1] = 0;
    for (int p = 0; p < MPS_PHASES; p++) {
        if (least[p] > 0) range[0] = mps_smaller(range[0], least[p]);
        range[1] = mps_larger(range[1], greatest[p]);
    }
}

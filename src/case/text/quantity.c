/* SPDX-License-Identifier: BSD-3-Clause */
/* A value of a case, "0.9 T1", as a number in SI. */
#include "units.h"
#include <math.h>
#include <mps/case.h>
#include <stdio.h>
#include <string.h>

mps_status mps_case_quantity(const char *text, double dp, double T1, double *value, char *unit,
                             size_t size)
{
    double number = NAN;
    mps__numbers n = {
        .text = text, .kinds = UNIT_ANY, .scale = {1, dp, T1, 1}, .most = 1, .out = &number};
    if (!text || !value || !unit || size == 0) return MPS_E_ARG;
    if (!mps__numbers_read(&n) || n.count != 1) return MPS_E_ARG;
    const char *found = n.found == UNIT_ANY ? "" : mps__unit_si(n.found);
    if (strlen(found) >= size) return MPS_E_ARG;
    snprintf(unit, size, "%s", found);
    *value = number;
    return MPS_OK;
}

/* SPDX-License-Identifier: BSD-3-Clause */
#include "page_scale.h"
#include "grow.h"
#include <math.h>
#include <stdlib.h>

enum { EVEN = 224, LARGEST = 255 };

const double mps__scale_map[SCALE_MAPS][SCALE_COLOURS][3] = {
    {{0.07, 0.13, 0.42},
     {0.10, 0.40, 0.68},
     {0.22, 0.69, 0.66},
     {0.68, 0.86, 0.38},
     {0.99, 0.93, 0.25}},
    {{0.96, 0.95, 0.97},
     {0.90, 0.86, 0.96},
     {0.83, 0.77, 0.94},
     {0.77, 0.68, 0.92},
     {0.71, 0.59, 0.90}},
    {{0.50, 0.13, 0.02},
     {0.62, 0.20, 0.03},
     {0.74, 0.28, 0.05},
     {0.86, 0.37, 0.09},
     {0.97, 0.47, 0.18}},
};

bool mps__scale_take(page_scale *s, double value)
{
    if (!isfinite(value)) return true;
    double *more = mps__grown(s->sample, s->count, sizeof *more);
    if (!more) return false;
    s->sample = more;
    s->sample[s->count++] = value;
    return true;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Round up to two digits. */
static double round_up(double value)
{
    const double power = pow(10, floor(log10(value)) - 1);
    return ceil(value / power - 1e-9) * power;
}

void mps__scale_end(page_scale *s, double noise, bool bottom)
{
    double top = noise, low = 0;
    s->least = s->most = 0;
    if (s->count > 0) {
        qsort(s->sample, (size_t)s->count, sizeof *s->sample, compare);
        s->least = s->sample[0];
        s->most = s->sample[s->count - 1];
        top = fmax(top, s->sample[(s->count - 1) * 99 / 100]);
        if (bottom) low = s->sample[(s->count - 1) / 100];
    }
    free(s->sample);
    s->sample = NULL;
    s->count = 0;
    s->hi = top > 0 ? round_up(top) : 1;
    s->lo = low < -0.05 * s->hi ? -round_up(-low) : 0;
    s->most = fmax(s->most, s->hi);
}

unsigned char mps__scale_code(const page_scale *s, double value)
{
    if (!(value > s->lo)) return 1;
    if (value <= s->hi)
        return (unsigned char)(1.5 + (EVEN - 1) * (value - s->lo) / (s->hi - s->lo));
    const double share = s->most > s->hi ? fmin((value - s->hi) / (s->most - s->hi), 1) : 0;
    return (unsigned char)(EVEN + 0.5 + (LARGEST - EVEN) * sqrt(share));
}

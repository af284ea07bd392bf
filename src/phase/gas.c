/* SPDX-License-Identifier: BSD-3-Clause */
/* What the models of a compressible phase have in common. */
#include "builtin.h"

int mps__gas_check(mps_stage *s, double phase, double sound)
{
    double most = 0;
    int64_t count = 0;
    for (int64_t i = 0; i < s->n; i++) {
        if (!mps__is_gas(s, i, phase)) continue;
        double square = 0;
        for (int d = 0; d < s->dim; d++) square += s->u[i * s->dim + d] * s->u[i * s->dim + d];
        most = fmax(most, square);
        count++;
    }
    if (count == 0) return mps_stage_fail(s, "phase %d has no fluid particle; choose the phase that is the gas", (int)phase);
    if (!(sqrt(most) < sound))
        return mps_stage_fail(s, "a particle of phase %d moves at %g m/s, and its speed of sound is %g m/s: it must be greater", (int)phase,
                              sqrt(most), sound);
    return 0;
}

void mps__gas_expect(mps_stage *s, int64_t i, double deviation)
{
    s->volume[i] -= deviation;
    s->number_density[i] -= s->near->n0 * deviation;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Interpolation between two poses: in each degree of freedom the polynomial of degree 5 that has
 * value, rate and acceleration of both. */
#include "builtin_motion.h"
#include "motion.h"

/* Times within this fraction of the interval before its end count as the end: times are sums of
 * rounded steps. */
static const double rounding = 1e-12;

/* One degree of freedom at s = 0..1 of an interval T; x, v T, a T^2 at both ends. */
static void follow(const double from[3], const double to[3], double s, double T, double out[3])
{
    const double way = to[0] - from[0] - from[1] - 0.5 * from[2], rate = to[1] - from[1] - from[2],
                 bend = to[2] - from[2];
    const double c3 = 10 * way - 4 * rate + 0.5 * bend, c4 = -15 * way + 7 * rate - bend,
                 c5 = 6 * way - 3 * rate + 0.5 * bend;
    out[0] = from[0] + s * (from[1] + s * (0.5 * from[2] + s * (c3 + s * (c4 + s * c5))));
    out[1] = (from[1] + s * (from[2] + s * (3 * c3 + s * (4 * c4 + s * 5 * c5)))) / T;
    out[2] = (from[2] + s * (6 * c3 + s * (12 * c4 + s * 20 * c5))) / (T * T);
}

int mps__motion_posed(void *user, double t, mps_motion_state *state)
{
    const mps__posed *p = user;
    const double T = p->end - p->begin, s = (t - p->begin) / T;
    if (s <= 0 || s >= 1 - rounding) { /* exactly the given pose */
        *state = s <= 0 ? p->from : p->to;
        return 0;
    }
    for (int k = 0; k < MPS_DOF_COUNT; k++) {
        const double from[3] = {p->from.value[k], p->from.rate[k] * T, p->from.accel[k] * T * T},
                     to[3] = {p->to.value[k], p->to.rate[k] * T, p->to.accel[k] * T * T};
        double at[3];
        follow(from, to, s, T, at);
        state->value[k] = at[0];
        state->rate[k] = at[1];
        state->accel[k] = at[2];
    }
    return 0;
}

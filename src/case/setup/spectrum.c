/* SPDX-License-Identifier: BSD-3-Clause */
/* A motion with a JONSWAP spectrum (Hasselmann et al. 1973) as a sum of harmonics with random
 * phases:
 *   S(w) ~ w^-5 exp(-1.25 (w_p/w)^4) gamma^r, r = exp(-(w - w_p)^2/(2 s^2 w_p^2)),
 *   s = 0.07 for w <= w_p, 0.09 above,
 * from 0.5 to 3 w_p, scaled so that the variance over this band is (significant/2)^2. The band is
 * divided into intervals of equal width; each has one harmonic, at a random frequency in it, with
 * the variance of the interval. The same seed gives the same harmonics on all machines. */
#include "ship_motion.h"
#include <math.h>

enum { PARTS = 64 }; /* of the integral over an interval of the band */

static const double LOWEST = 0.5, HIGHEST = 3;

/* splitmix64 of Steele, Lea & Flood 2014; @return a number in 0..1 */
static double draw(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return (double)((z ^ z >> 31) >> 11) / 9007199254740992.0;
}

/* Unscaled spectrum; x = w/w_p. */
static double density(double x, double gamma)
{
    const double s = x <= 1 ? 0.07 : 0.09, r = exp(-(x - 1) * (x - 1) / (2 * s * s));
    return pow(x, -5) * exp(-1.25 * pow(x, -4)) * pow(gamma, r);
}

static double part(double from, double to, double gamma)
{
    double sum = 0;
    for (int i = 0; i < PARTS; i++) sum += density(from + (i + 0.5) / PARTS * (to - from), gamma);
    return sum * (to - from) / PARTS;
}

bool mps__spectrum_add(build *b, build_motion *m, const tree_node *node, mps_harmonic like)
{
    const double significant = mps__read_number(b->c, node, "significant", NAN),
                 period = mps__read_number(b->c, node, "peak", NAN),
                 gamma = mps__read_number(b->c, node, "gamma", 3.3);
    const int32_t count = (int32_t)mps__read_number(b->c, node, "components", 100);
    uint64_t state = (uint64_t)mps__read_number(b->c, node, "seed", 1);
    if (mps__case_failed(b->c)) return false;
    if (m->count + count > MOTION_HARMONICS) {
        mps__case_log(b->c, node, false, "more than %d harmonics", MOTION_HARMONICS);
        return false;
    }
    const double pi = acos(-1.0), peak = 2 * pi / period, width = (HIGHEST - LOWEST) / count;
    double whole = 0;
    for (int32_t i = 0; i < count; i++)
        whole += part(LOWEST + i * width, LOWEST + (i + 1) * width, gamma);
    for (int32_t i = 0; i < count; i++) {
        const double from = LOWEST + i * width, energy = part(from, from + width, gamma) / whole;
        mps_harmonic *h = &m->harmonic[m->count++];
        *h = like;
        h->form = 0;
        h->amplitude = 0.5 * significant * sqrt(2 * energy);
        h->omega = (from + draw(&state) * width) * peak;
        h->phase = 2 * pi * draw(&state);
    }
    return true;
}

void mps__harmonics_at(const build_motion *m, int32_t degree, double t, double out[3])
{
    out[0] = out[1] = out[2] = 0;
    for (int32_t i = 0; i < m->count; i++) {
        const mps_harmonic *h = &m->harmonic[i];
        if (h->dof != degree) continue;
        if (h->form == MOTION_PUSH) {
            out[0] += 0.5 * h->amplitude * t * t;
            out[1] += h->amplitude * t;
            out[2] += h->amplitude;
            continue;
        }
        const double a = h->amplitude, w = h->omega, T = h->ramp, x = T > 0 ? t / T : 1;
        const double angle = h->form ? w * t : w * t + h->phase, s = sin(angle), c = cos(angle);
        double q[3] = {a * s, a * w * c, -a * w * w * s}, f[3] = {1, 0, 0};
        if (h->form) {
            q[0] = -a * (1 - c);
            q[1] = -a * w * s;
            q[2] = -a * w * w * c;
        }
        if (T > 0 && x < 1) {
            f[0] = x <= 0 ? 0 : x * x * x * (10 + x * (-15 + 6 * x));
            f[1] = x <= 0 ? 0 : 30 * x * x * (1 - x) * (1 - x) / T;
            f[2] = x <= 0 ? 0 : 60 * x * (1 - x) * (1 - 2 * x) / (T * T);
        }
        out[0] += f[0] * q[0];
        out[1] += f[0] * q[1] + f[1] * q[0];
        out[2] += f[0] * q[2] + 2 * f[1] * q[1] + f[2] * q[0];
    }
}

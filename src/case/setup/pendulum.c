/* SPDX-License-Identifier: BSD-3-Clause */
#include "pendulum.h"
#include <math.h>
#include <string.h>

/* Torsion constant of a rectangle a x b, b <= a, by St Venant: the moment of inertia that liquid in
 * a closed box lacks in comparison with a solid. */
static double torsion(double a, double b)
{
    const double pi = acos(-1.0);
    double sum = 0;
    for (int n = 1; n < 100; n += 2) sum += tanh(n * pi * a / (2 * b)) / pow(n, 5);
    return a * b * b * b * (1.0 / 3 - 64 / pow(pi, 5) * b / a * sum);
}

static void fill_modes(pendulum *p, double L, double h)
{
    const double pi = acos(-1.0);
    double sum = 0, moment = 0, square = 0;
    for (int i = 0; i < PENDULUM_MODES; i++) {
        const int n = 2 * i + 1;
        const double k = n * pi / L, x = 0.5 * k * h;
        p->m[i] = 8 * p->mass * tanh(k * h) / (pow(n * pi, 3) * h / L);
        p->w2[i] = p->gravity * k * tanh(k * h);
        p->z[i] = h * (1 - tanh(x) / x);
        sum += p->m[i];
        moment += p->m[i] * p->z[i];
        square += p->m[i] * (p->z[i] - 0.5 * h) * (p->z[i] - 0.5 * h);
    }
    p->rest = p->mass - sum;
    p->rest_height = (0.5 * p->mass * h - moment) / p->rest;
    const double arm = p->rest_height - 0.5 * h,
                 closed = p->mass / (L * h) *
                          (L * h * (L * L + h * h) / 12 - torsion(fmax(L, h), fmin(L, h)));
    p->rest_inertia = closed - p->rest * arm * arm - square;
}

bool mps__pendulum_make(const build *b, const double *centre, pendulum *p)
{
    const form *t = &b->tank.form;
    const int axis = b->modes.axis, other = 2 - axis;
    if (b->tank.file || t->kind != FORM_BOX || b->fluids != 1 || b->solids > 0 ||
        !mps__build_filled(b) || b->modes.count == 0)
        return false;
    const double L = t->hi[axis] - t->lo[axis], h = b->depth,
                 width = b->dim == 3 ? t->hi[other] - t->lo[other] : 1;
    *p = (pendulum){.mass = b->fluid[0].density * L * h * width,
                    .gravity = b->gravity,
                    .floor = t->lo[1] - centre[1],
                    .middle = 0.5 * (t->lo[axis] + t->hi[axis]) - centre[axis]};
    fill_modes(p, L, h);
    return p->gravity > 0;
}

double mps__pendulum_stiffness(const pendulum *p, bool turn, double w)
{
    const double g = p->gravity, s = w * w, up = p->rest_height + p->floor;
    double load = turn ? s * (p->rest_inertia + p->rest * up * up +
                              p->mass * p->middle * p->middle) +
                             p->rest * g * up
                       : s * p->rest;
    for (int i = 0; i < PENDULUM_MODES; i++) {
        const double z = p->z[i] + p->floor,
                     way = turn ? -(s * z + g) / (p->w2[i] - s) : s / (p->w2[i] - s);
        load += turn ? -p->m[i] * (z * p->w2[i] + g) * way : p->m[i] * p->w2[i] * way;
    }
    return -load;
}

/* K - w^2 M with the liquid, multiplied by the factors of its first two poles. */
static double residual(const pendulum *p, bool turn, double mass, double stiffness, double w)
{
    const double s = w * w;
    return (stiffness - s * mass + mps__pendulum_stiffness(p, turn, w)) * (p->w2[0] - s) *
           (p->w2[1] - s);
}

void mps__pendulum_periods(const pendulum *p, bool turn, double mass, double stiffness,
                           double period[2])
{
    enum { PARTS = 2000, HALVINGS = 60 };
    const double most = sqrt(0.5 * (p->w2[1] + p->w2[2]));
    int found = 0;
    period[0] = period[1] = NAN;
    /* intervals end off the poles */
    for (int i = 0; i < PARTS && found < 2; i++) {
        double low = most * (i + 0.3) / PARTS, high = most * (i + 1.3) / PARTS;
        const bool negative = residual(p, turn, mass, stiffness, low) < 0;
        if ((residual(p, turn, mass, stiffness, high) < 0) == negative) continue;
        for (int k = 0; k < HALVINGS; k++) {
            const double middle = 0.5 * (low + high);
            if ((residual(p, turn, mass, stiffness, middle) < 0) == negative)
                low = middle;
            else
                high = middle;
        }
        period[found++] = 2 * acos(-1.0) / low;
    }
}

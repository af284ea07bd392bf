/* SPDX-License-Identifier: BSD-3-Clause */
/* The motion of a case as the run has it: degrees of freedom of the ship from those of the tank,
 * and their largest values. */
#include "ship_motion.h"
#include <math.h>
#include <string.h>

double mps__motion_table_at(const build_motion *m, int32_t degree, double t)
{
    int64_t low = 0, high = m->rows - 1;
    if (m->rows == 0) return 0;
    if (t >= m->t[high]) return m->column[6 * high + degree];
    if (t <= m->t[0]) return m->column[degree];
    while (high - low > 1) {
        const int64_t middle = (low + high) / 2;
        if (m->t[middle] <= t)
            low = middle;
        else
            high = middle;
    }
    const double f = (t - m->t[low]) / (m->t[high] - m->t[low]);
    return (1 - f) * m->column[6 * low + degree] + f * m->column[6 * high + degree];
}

/* ---- degrees of the ship ---- */

/* The prescribed value, with the table interpolated linearly: close to the motion, except for its
 * spline. */
static double as_given(const build_motion *m, int32_t degree, double t)
{
    double q[3];
    mps__harmonics_at(m, degree, t, q);
    return q[0] + mps__motion_table_at(m, degree, t);
}

void mps__motion_degrees(const build_motion *m, const mps_motion_state *tank, double t,
                         double out[MOTION_DEGREES][3])
{
    const double turn = 2 * acos(-1.0);
    const bool parallel = mps__motion_parallel(m);
    mps_ship_motion ship;
    mps_ship_motion_init(&ship, sizeof ship);
    const bool known = !parallel && mps_ship_from_tank(&m->ship, tank, &ship) == MPS_OK;
    for (int32_t d = 0; d < MOTION_DEGREES; d++) {
        double sign = m->flipped && d % 3 == 1 ? -1 : 1, value = ship.value[d];
        int32_t dof;
        if (parallel) {
            mps__degree_to_lab(m, d, &dof, &sign);
            out[d][0] = sign * tank->value[dof];
            out[d][1] = sign * tank->rate[dof];
            out[d][2] = sign * tank->accel[dof];
            continue;
        }
        const double given = sign * as_given(m, d, t);
        if (!known) value = given; /* gimbal lock: the rates are not known either */
        if (d >= MPS_SHIP_ROLL) value += turn * round((given - value) / turn);
        out[d][0] = sign * value;
        out[d][1] = sign * ship.rate[d];
        out[d][2] = sign * ship.accel[d];
    }
}

/* ---- its largest values ---- */

typedef struct survey {
    build *b;
    build_motion *m;
    const tree_node *map;
    /* times of the largest values, and distance of adjacent samples */
    double at[MOTION_DEGREES][3], beside[MOTION_DEGREES][3];
    bool good;
} survey;

static bool motion_at(survey *s, double t, double out[MOTION_DEGREES][3])
{
    mps_motion_state tank = {.struct_size = sizeof tank};
    if (s->good)
        s->good = mps__build_try(s->b, mps_motion_state_at(s->b->sim, t, &tank), s->map, "motion");
    if (s->good) mps__motion_degrees(s->m, &tank, t, out);
    return s->good;
}

/* @param step  distance of adjacent samples */
static void sample(survey *s, double t, double step)
{
    double q[MOTION_DEGREES][3];
    if (!motion_at(s, t, q)) return;
    for (int32_t d = 0; d < MOTION_DEGREES; d++) {
        double *rate = s->m->rate[d];
        if (!s->m->used[d]) continue;
        rate[0] = fmin(rate[0], q[d][1]);
        rate[1] = fmax(rate[1], q[d][1]);
        for (int k = 0; k < 3; k++) {
            if (fabs(q[d][k]) < s->m->largest[d][k]) continue;
            s->m->largest[d][k] = fabs(q[d][k]);
            s->at[d][k] = t;
            s->beside[d][k] = step;
        }
    }
}

/* The largest value is between the samples adjacent to the largest sample. */
static void refine(survey *s, int32_t degree, int k)
{
    enum { PARTS = 40 };
    const double golden = 0.5 * (sqrt(5.0) - 1);
    double low = fmax(0, s->at[degree][k] - s->beside[degree][k]),
           high = fmin(s->b->until, s->at[degree][k] + s->beside[degree][k]);
    for (int i = 0; i < PARTS; i++) {
        const double t[2] = {high - golden * (high - low), low + golden * (high - low)};
        double q[2][MOTION_DEGREES][3];
        if (!motion_at(s, t[0], q[0]) || !motion_at(s, t[1], q[1])) return;
        const double size[2] = {fabs(q[0][degree][k]), fabs(q[1][degree][k])};
        s->m->largest[degree][k] = fmax(s->m->largest[degree][k], fmax(size[0], size[1]));
        *(size[0] > size[1] ? &high : &low) = t[size[0] > size[1]];
    }
}

static void sample_harmonics(survey *s)
{
    const double until = s->b->until, period = mps__shortest_period(s->m) / 40,
                 own = s->m->dt_max > 0 ? 0.5 * s->m->dt_max : INFINITY,
                 step = fmin(fmin(period, own), until / 1000);
    const int64_t count = step > 0 && until / step < 1e6 ? (int64_t)(until / step) : 1000000;
    for (int64_t i = 0; i <= count && s->good; i++)
        sample(s, until * (double)i / (double)count, until / (double)count);
}

/* Sample rows, and points between them, where the spline is a cubic. */
static void sample_table(survey *s)
{
    build_motion *m = s->m;
    const double until = s->b->until;
    const int parts = m->rows < 20000 ? 8 : m->rows < 200000 ? 4 : 2;
    m->step_least = INFINITY;
    for (int64_t i = 1; i < m->rows && s->good; i++) {
        const double h = m->t[i] - m->t[i - 1];
        m->step_least = fmin(m->step_least, h);
        m->step_most = fmax(m->step_most, h);
        if (m->t[i] < 0 || m->t[i - 1] > until) continue;
        for (int p = 0; p < parts; p++) {
            const double t = m->t[i - 1] + h * p / parts;
            if (t > 0 && t < until) sample(s, t, h / parts);
        }
    }
    sample(s, 0, m->step_most);
    sample(s, until, m->step_most);
}

void mps__motion_measure(build *b, build_motion *m, const tree_node *map)
{
    survey s = {.b = b, .m = m, .map = map, .good = true};
    for (int32_t d = 0; d < MOTION_DEGREES; d++) {
        m->rate[d][0] = m->start == MPS_START_WITH_TANK ? INFINITY : 0;
        m->rate[d][1] = -m->rate[d][0];
    }
    if (m->rows > 0)
        sample_table(&s);
    else
        sample_harmonics(&s);
    for (int32_t d = 0; d < MOTION_DEGREES; d++)
        for (int k = 0; k < 3 && m->used[d]; k++) refine(&s, d, k);
}

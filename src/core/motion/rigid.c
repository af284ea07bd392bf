/* SPDX-License-Identifier: BSD-3-Clause */
/* Equations of a rigid body, projected on the directions of its free degrees of freedom: T^T (M
 * + A) T q'' = T^T loads. */
#include "rigid.h"
#include "angles.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* A degree of freedom whose mass is below this fraction of the liquid's is singular. */
static const double NOTHING = 1e-9;
/* A rate that friction stops is below this fraction of its former value. */
static const double ROUNDING = 4 * DBL_EPSILON;
/* cos of MPS_ROTATE_Z, below which the two other angles are degenerate. */
static const double ALIKE = 1e-6;

/* A body at a pose, axes of the lab. */
typedef struct shape {
    /* velocities of the centre of motion and angular velocity, for the rate of each degree */
    double t[6][6];
    double bias[3]; /* angular acceleration due to the rates alone */
    double omega[3], rotation[9];
    /* from the centre of motion to the centre of mass; inertia about the centre of mass */
    double mass, arm[3], inertia[9];
} shape;

static void multiply(const double m[9], const double v[3], double out[3])
{
    for (int d = 0; d < 3; d++) out[d] = mps__dot(m + 3 * d, v, 3);
}

/* Columns of t. The directions of angles are linear in their rates. */
static void find_directions(const mps_motion_state *at, const double rate[6], shape *s)
{
    mps_motion_state one = *at;
    mps__pose pose;
    memset(s->t, 0, sizeof s->t);
    memset(one.accel, 0, sizeof one.accel);
    for (int k = 0; k < 6; k++) {
        if (k < MPS_ROTATE_X) {
            s->t[k][k] = 1;
            continue;
        }
        memset(one.rate, 0, sizeof one.rate);
        one.rate[k] = 1;
        mps__motion_pose_of(&one, 0, &pose);
        memcpy(s->t[k] + 3, pose.omega, sizeof pose.omega);
    }
    memcpy(one.rate, rate, sizeof one.rate);
    mps__motion_pose_of(&one, 0, &pose);
    memcpy(s->bias, pose.alpha, sizeof s->bias);
    memcpy(s->omega, pose.omega, sizeof s->omega);
    memcpy(s->rotation, pose.rotation, sizeof s->rotation);
}

static void find_shape(const mps_body *b, const double centre[3], const mps_motion_state *at,
                       const double rate[6], shape *s)
{
    double arm[3];
    find_directions(at, rate, s);
    const double *R = s->rotation;
    s->mass = b->mass;
    for (int d = 0; d < 3; d++) arm[d] = b->centre_of_mass[d] - centre[d];
    multiply(R, arm, s->arm);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            s->inertia[3 * i + j] = 0;
            for (int k = 0; k < 9; k++)
                s->inertia[3 * i + j] += R[3 * i + k / 3] * b->inertia[k] * R[3 * j + k % 3];
        }
}

/* Force and moment about the centre of motion for a linear and an angular acceleration at zero
 * velocity. */
static void inertial_load(const shape *s, const double a[6], double out[6])
{
    double at_mass[3], turn[3];
    mps__cross(a + 3, s->arm, at_mass);
    for (int d = 0; d < 3; d++) out[d] = s->mass * (a[d] + at_mass[d]);
    mps__cross(s->arm, out, turn);
    multiply(s->inertia, a + 3, out + 3);
    for (int d = 0; d < 3; d++) out[3 + d] += turn[d];
}

/* Load due to velocities: m w x (w x r) at the centre of mass, and w x I w. */
static void gyroscopic_load(const shape *s, double out[6])
{
    double turn[3], spin[3], moment[3];
    mps__cross(s->omega, s->arm, turn);
    mps__cross(s->omega, turn, out);
    for (int d = 0; d < 3; d++) out[d] *= s->mass;
    mps__cross(s->arm, out, moment);
    multiply(s->inertia, s->omega, spin);
    mps__cross(s->omega, spin, out + 3);
    for (int d = 0; d < 3; d++) out[3 + d] += moment[d];
}

uint32_t mps__rigid_columns(const mps_body *b, int32_t dim)
{
    const uint32_t turns = 1U << MPS_ROTATE_X | 1U << MPS_ROTATE_Y | 1U << MPS_ROTATE_Z,
                   asked = (uint32_t)b->free;
    /* the axis of an angle depends on the other angles */
    return dim == 3 && asked & turns ? asked | turns : asked;
}

void mps__rigid_advance(const mps_body *b, const mps_motion_state *now, const double accel[6],
                        double dt, mps_motion_state *next)
{
    *next = *now;
    for (int k = 0; k < MPS_DOF_COUNT; k++) {
        const bool moves = mps__rigid_is_free(b, k);
        next->accel[k] = moves ? accel[k] : 0;
        next->rate[k] = moves ? now->rate[k] + dt * accel[k] : 0;
        if (b->friction[k] > 0 && fabs(next->rate[k]) <= ROUNDING * fabs(now->rate[k]))
            next->rate[k] = 0;
        next->value[k] += dt * next->rate[k];
    }
}

/* ---- the system of equations ---- */

typedef struct system {
    int32_t count, dof[6];
    double h[6][6], rhs[6], share[6]; /* contribution of the liquid to h[k][k] */
} system;

/* Loads of springs and dampers. */
static void restore(const mps_body *b, const double place[6], const double rate[6], double out[6])
{
    for (int i = 0; i < 6; i++) {
        out[i] = 0;
        for (int j = 0; j < 6; j++)
            out[i] -= b->stiffness[6 * i + j] * (place[j] - b->equilibrium[j]) +
                      b->damping[6 * i + j] * rate[j];
    }
}

/* Springs act with (q_before + 2 q + q_next)/4, dampers with the mean of the rates before and
 * after. */
static void restoring_load(const mps_body *b, const mps_motion_state *now,
                           const mps__rigid_loads *l, const double accel[6], double out[6])
{
    double place[6], rate[6];
    for (int k = 0; k < 6; k++) {
        place[k] = now->value[k] +
                   0.25 * ((l->dt - l->dt_before) * now->rate[k] + l->dt * l->dt * accel[k]);
        rate[k] = now->rate[k] + 0.5 * l->dt * accel[k];
    }
    restore(b, place, rate, out);
}

static void fill_system(const mps_body *b, const shape *s, const mps_motion_state *now,
                        const mps__rigid_loads *l, system *y)
{
    const double still[6] = {0}, bias[6] = {0, 0, 0, s->bias[0], s->bias[1], s->bias[2]};
    double load[6], held[6], gyro[6], restoring[6], pulled[6], liquid[6];
    inertial_load(s, bias, held);
    gyroscopic_load(s, gyro);
    restoring_load(b, now, l, still, restoring);
    for (int i = 0; i < 6; i++)
        load[i] = l->rest[i] - mps__dot6(l->mass + 6 * i, bias) + l->external[i] - held[i] -
                  gyro[i];
    if (b->gravity) {
        double weight[3], moment[3];
        for (int d = 0; d < 3; d++) weight[d] = s->mass * l->g[d];
        mps__cross(s->arm, weight, moment);
        for (int d = 0; d < 3; d++) load[d] += weight[d], load[3 + d] += moment[d];
    }
    for (int32_t c = 0; c < y->count; c++) {
        const double *direction = s->t[y->dof[c]];
        inertial_load(s, direction, pulled);
        for (int i = 0; i < 6; i++) liquid[i] = mps__dot6(l->mass + 6 * i, direction);
        for (int32_t r = 0; r < y->count; r++) {
            const double *to = s->t[y->dof[r]];
            const int at = 6 * y->dof[r] + y->dof[c];
            y->h[r][c] = mps__dot6(to, pulled) + mps__dot6(to, liquid) +
                         0.25 * l->dt * l->dt * b->stiffness[at] + 0.5 * l->dt * b->damping[at];
        }
        y->share[c] = mps__dot6(direction, liquid);
        y->rhs[c] = mps__dot6(direction, load) + restoring[y->dof[c]];
    }
}

/* Gaussian elimination without pivoting: the matrix is positive definite except for the asymmetry
 * of A. @return -1: solved, else the singular row */
static int32_t eliminate(system *y, const mps__rigid_loads *l, mps__rigid_step *out)
{
    const int32_t n = y->count;
    for (int32_t k = 0; k < n; k++) {
        const bool turns = y->dof[k] >= MPS_ROTATE_X;
        out->have = y->h[k][k];
        out->share = y->share[k];
        out->least = NOTHING * l->liquid_mass * (turns ? l->dp * l->dp : 1);
        if (!(y->h[k][k] > out->least)) return k;
        for (int32_t r = k + 1; r < n; r++) {
            const double part = y->h[r][k] / y->h[k][k];
            for (int32_t c = k; c < n; c++) y->h[r][c] -= part * y->h[k][c];
            y->rhs[r] -= part * y->rhs[k];
        }
    }
    for (int32_t k = n - 1; k >= 0; k--) {
        for (int32_t c = k + 1; c < n; c++) y->rhs[k] -= y->h[k][c] * y->rhs[c];
        y->rhs[k] /= y->h[k][k];
    }
    return -1;
}

/* ---- dry friction ---- */

/* A degree with friction slips backwards, sticks, or slips forwards. */
enum { BACK = -1, RESTS = 0, FORTH = 1, WAYS = 3 };

typedef struct rubbing {
    const mps_body *b;
    const mps_motion_state *now;
    const mps__rigid_loads *l;
    system y;              /* without friction */
    int32_t count, row[6]; /* rows of the degrees with friction */
} rubbing;

/* Accelerations and friction loads for a given state of each degree with friction. A degree that
 * sticks gets the row rate + dt accel = 0; its load is the residual of its original row. @return
 * how far the result contradicts the states; 0: it is the solution */
static double try_ways(const rubbing *f, const int32_t way[6], double accel[6], double load[6])
{
    system s = f->y;
    mps__rigid_step ignored;
    double wrong = 0;
    for (int32_t k = 0; k < f->count; k++) {
        const int32_t r = f->row[k], dof = s.dof[r];
        if (way[k] != RESTS) {
            s.rhs[r] -= way[k] * f->b->friction[dof];
            continue;
        }
        const double stop = -f->now->rate[dof] / f->l->dt;
        for (int32_t c = 0; c < s.count; c++) {
            if (c != r) s.rhs[c] -= s.h[c][r] * stop;
            if (c != r) s.h[r][c] = s.h[c][r] = 0;
        }
        s.rhs[r] = s.h[r][r] * stop;
    }
    if (eliminate(&s, f->l, &ignored) >= 0) return INFINITY;
    for (int32_t k = 0; k < f->count; k++) {
        const int32_t r = f->row[k], dof = s.dof[r];
        const double most = f->b->friction[dof], rate = f->now->rate[dof] + f->l->dt * s.rhs[r];
        load[dof] = -way[k] * most;
        if (way[k] == RESTS) {
            load[dof] = -f->y.rhs[r];
            for (int32_t c = 0; c < s.count; c++) load[dof] += f->y.h[r][c] * s.rhs[c];
            wrong = fmax(wrong, fabs(load[dof]) - most);
        } else
            wrong = fmax(wrong, -way[k] * rate * f->y.h[r][r] / f->l->dt);
    }
    for (int32_t k = 0; k < s.count; k++) accel[s.dof[k]] = s.rhs[k];
    return wrong;
}

/* The matrix is positive definite, so exactly one combination of states is consistent, apart from
 * ties at the limits. As few degrees have friction, all combinations are tried, and the one with
 * the smallest contradiction is used. */
static void rub(const rubbing *f, mps__rigid_step *out)
{
    int32_t choices = 1;
    double least = INFINITY;
    for (int32_t k = 0; k < f->count; k++) choices *= WAYS;
    for (int32_t n = 0; n < choices && least > 0; n++) {
        int32_t way[6];
        double accel[6] = {0}, load[6] = {0};
        for (int32_t k = 0, rest = n; k < f->count; k++, rest /= WAYS) {
            const int32_t digit = rest % WAYS; /* sticking first */
            way[k] = digit == 0 ? RESTS : digit == 1 ? FORTH : BACK;
        }
        const double wrong = try_ways(f, way, accel, load);
        if (!(wrong < least)) continue;
        least = wrong;
        memcpy(out->accel, accel, sizeof accel);
        memcpy(out->friction, load, sizeof load);
    }
}

/* Loads of the solution, and their work with the mean velocities of the step. */
static void book(const mps_body *b, const shape *s, const mps_motion_state *now,
                 const mps__rigid_loads *l, mps__rigid_step *out)
{
    double mean[6], way[6] = {0};
    for (int i = 0; i < 6; i++) {
        out->lab[i] = i < 3 ? 0 : s->bias[i - 3];
        mean[i] = now->rate[i] + 0.5 * l->dt * out->accel[i];
    }
    for (int k = 0; k < 6; k++)
        for (int i = 0; i < 6; i++) {
            out->lab[i] += s->t[k][i] * out->accel[k];
            way[i] += l->dt * s->t[k][i] * mean[k];
        }
    restoring_load(b, now, l, out->accel, out->restoring);
    for (int i = 0; i < 6; i++) {
        out->liquid[i] = l->rest[i] - mps__dot6(l->mass + 6 * i, out->lab);
        out->liquid_work += out->liquid[i] * way[i];
        out->external_work += l->external[i] * way[i];
        out->damped += l->dt * mean[i] * mps__dot6(b->damping + 6 * i, mean);
        out->rubbed -= l->dt * mean[i] * out->friction[i];
    }
}

bool mps__rigid_solve(const mps_body *b, const double centre[3], const mps_motion_state *now,
                      const mps__rigid_loads *l, mps__rigid_step *out)
{
    double rate[6];
    system y = {.count = 0};
    shape s;
    *out = (mps__rigid_step){.singular = -1};
    for (int k = 0; k < 6; k++) {
        /* velocities at the time of the pose: those of the state are means over the last step */
        rate[k] = now->rate[k] + (mps__rigid_is_free(b, k) ? 0.5 * l->dt * now->accel[k] : 0);
        if (mps__rigid_is_free(b, k)) y.dof[y.count++] = k;
    }
    if (mps__rigid_is_free(b, MPS_ROTATE_X) && mps__rigid_is_free(b, MPS_ROTATE_Y) &&
        fabs(mps__cos(now->value[MPS_ROTATE_Z])) < ALIKE)
        return false;
    find_shape(b, centre, now, rate, &s);
    fill_system(b, &s, now, l, &y);
    rubbing f = {.b = b, .now = now, .l = l, .y = y};
    for (int32_t k = 0; k < y.count; k++)
        if (b->friction[y.dof[k]] > 0) f.row[f.count++] = k;
    const int32_t bad = eliminate(&y, l, out);
    if (bad >= 0) {
        out->singular = y.dof[bad];
        return false;
    }
    for (int32_t k = 0; k < y.count; k++) out->accel[y.dof[k]] = y.rhs[k];
    if (f.count > 0) rub(&f, out);
    book(b, &s, now, l, out);
    return true;
}

/* ---- energies ---- */

double mps__rigid_kinetic(const mps_body *b, const double centre[3], const mps_motion_state *now)
{
    double v[6] = {0}, momentum[6];
    shape s;
    find_shape(b, centre, now, now->rate, &s);
    for (int k = 0; k < 6; k++)
        for (int i = 0; i < 6; i++) v[i] += s.t[k][i] * now->rate[k];
    inertial_load(&s, v, momentum);
    return 0.5 * mps__dot6(v, momentum);
}

double mps__rigid_spring(const mps_body *b, const double value[6])
{
    double sum = 0;
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
            sum += 0.5 * (value[i] - b->equilibrium[i]) * b->stiffness[6 * i + j] *
                   (value[j] - b->equilibrium[j]);
    return sum;
}

void mps__rigid_place(const mps_body *b, const double centre[3], const mps_motion_state *now,
                      double place[3])
{
    shape s;
    find_shape(b, centre, now, now->rate, &s);
    for (int d = 0; d < 3; d++) place[d] = centre[d] + now->value[d] + s.arm[d];
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Public functions of mps/ship.h. */
#include "motion.h"
#include "angles.h"
#include <math.h>
#include <mps/ship.h>
#include <string.h>

enum { DOFS = 6 };

/* A validated ship. */
typedef struct hull {
    mps__triad rest;  /* e1, e2, e3 in lab axes */
    double unit;      /* of angles, in radians */
    int32_t order[3]; /* of the rotations, as axes 0, 1, 2 */
    double origin[3];
} hull;

/* Directions of the axes and their rotation, in lab axes. */
typedef struct attitude {
    mps__triad axes;
    double omega[3], alpha[3];
} attitude;

/* ---- checks ---- */

static bool make_unit(double v[3])
{
    const double length = sqrt(mps__dot(v, v, 3));
    if (!(isfinite(length) && length > 0)) return false;
    for (int d = 0; d < 3; d++) v[d] /= length;
    return true;
}

static bool find_axes(const mps_ship *ship, mps__triad *rest)
{
    double forward[3], up[3];
    memcpy(forward, ship->forward, sizeof forward);
    memcpy(up, ship->up, sizeof up);
    if (!make_unit(forward) || !make_unit(up)) return false;
    const double along = mps__dot(forward, up, 3);
    if (!(fabs(along) <= 1e-6)) return false;
    for (int d = 0; d < 3; d++) up[d] -= along * forward[d];
    make_unit(up);
    for (int d = 0; d < 3; d++) {
        rest->e[0][d] = forward[d];
        rest->e[2][d] = ship->axes == MPS_SHIP_Z_DOWN ? -up[d] : up[d];
    }
    mps__cross(rest->e[2], rest->e[0], rest->e[1]);
    return true;
}

static bool find_order(const mps_ship *ship, int32_t order[3])
{
    int seen = 0;
    for (int n = 0; n < 3; n++) {
        order[n] = ship->order[n] - MPS_SHIP_ROLL;
        if (order[n] < 0 || order[n] > 2) return false;
        seen |= 1 << order[n];
    }
    return seen == 7;
}

static mps_status open_hull(const mps_ship *given, hull *h)
{
    mps_ship ship = {.struct_size = sizeof ship};
    MPS__TRY(mps__struct_in(NULL, "mps_ship", &ship, sizeof ship, given));
    const bool good = (ship.axes == MPS_SHIP_Z_UP || ship.axes == MPS_SHIP_Z_DOWN) &&
                      (ship.degrees == 0 || ship.degrees == 1) && mps__finite(ship.origin, 3) &&
                      find_axes(&ship, &h->rest) && find_order(&ship, h->order);
    if (!good) return MPS_E_ARG;
    h->unit = ship.degrees ? MPS__PI / 180 : 1;
    memcpy(h->origin, ship.origin, sizeof h->origin);
    return MPS_OK;
}

static mps_status open_motion(const mps_ship_motion *given, mps_ship_motion *own)
{
    *own = (mps_ship_motion){.struct_size = sizeof *own};
    MPS__TRY(mps__struct_in(NULL, "mps_ship_motion", own, sizeof *own, given));
    const bool good = mps__finite(own->value, DOFS) && mps__finite(own->rate, DOFS) &&
                      mps__finite(own->accel, DOFS);
    return good ? MPS_OK : MPS_E_ARG;
}

mps_status mps_ship_init(mps_ship *ship, size_t size)
{
    static const mps_ship usual = {.struct_size = sizeof usual,
                                   .order = {MPS_SHIP_YAW, MPS_SHIP_PITCH, MPS_SHIP_ROLL},
                                   .forward = {1, 0, 0},
                                   .up = {0, 1, 0}};
    return mps__struct_init("mps_ship", ship, size, &usual, sizeof usual);
}

mps_status mps_ship_motion_init(mps_ship_motion *motion, size_t size)
{
    static const mps_ship_motion rest = {.struct_size = sizeof rest};
    return mps__struct_init("mps_ship_motion", motion, size, &rest, sizeof rest);
}

/* ---- motions ---- */

/* Components along the axes and back; `in` and `out` may be the same. */
static void to_axes(const mps__triad *axes, const double v[3], double out[3])
{
    const double in[3] = {v[0], v[1], v[2]};
    for (int k = 0; k < 3; k++) out[k] = mps__dot(axes->e[k], in, 3);
}

static void from_axes(const mps__triad *axes, const double v[3], double out[3])
{
    const double in[3] = {v[0], v[1], v[2]};
    for (int d = 0; d < 3; d++)
        out[d] = in[0] * axes->e[0][d] + in[1] * axes->e[1][d] + in[2] * axes->e[2][d];
}

static attitude find_attitude(const hull *h, const mps_motion_state *tank)
{
    attitude a;
    mps__pose pose;
    mps__motion_pose_of(tank, 0, &pose);
    memcpy(a.omega, pose.omega, sizeof a.omega);
    memcpy(a.alpha, pose.alpha, sizeof a.alpha);
    for (int k = 0; k < 3; k++)
        for (int d = 0; d < 3; d++)
            a.axes.e[k][d] = mps__dot(&pose.rotation[3 * d], h->rest.e[k], 3);
    return a;
}

static mps_status find_tank(const hull *h, const mps_ship_motion *motion, mps_motion_state *tank)
{
    mps__angles angles = {.order = h->order};
    attitude a;
    mps__triad columns = {{{0}}}; /* of R = sum of (R e_k) e_k^T */
    for (int n = 0; n < 3; n++) {
        const int dof = MPS_SHIP_ROLL + h->order[n];
        angles.angle[n] = motion->value[dof] * h->unit;
        angles.rate[n] = motion->rate[dof] * h->unit;
        angles.accel[n] = motion->accel[dof] * h->unit;
    }
    a.axes = h->rest;
    mps__rotation_apply(&angles, &a.axes, a.omega, a.alpha);
    for (int column = 0; column < 3; column++) {
        const double part[3] = {h->rest.e[0][column], h->rest.e[1][column], h->rest.e[2][column]};
        from_axes(&a.axes, part, columns.e[column]);
    }
    from_axes(&h->rest, motion->value, tank->value);
    from_axes(&h->rest, motion->rate, tank->rate);
    from_axes(&h->rest, motion->accel, tank->accel);
    return mps__motion_angles_of(&columns, a.omega, a.alpha, tank) ? MPS_OK : MPS_E_STATE;
}

mps_status mps_ship_to_tank(const mps_ship *ship, const mps_ship_motion *motion,
                            mps_motion_state *tank)
{
    hull h;
    mps_ship_motion own;
    mps_motion_state result = {.struct_size = sizeof result};
    MPS__TRY(open_hull(ship, &h));
    MPS__TRY(open_motion(motion, &own));
    MPS__TRY(mps__struct_check(NULL, "mps_motion_state", tank));
    MPS__TRY(find_tank(&h, &own, &result));
    return mps__struct_out(NULL, "mps_motion_state", tank, &result, sizeof result);
}

mps_status mps_ship_from_tank(const mps_ship *ship, const mps_motion_state *tank,
                              mps_ship_motion *motion)
{
    hull h;
    mps_motion_state own;
    mps_ship_motion result = {.struct_size = sizeof result};
    MPS__TRY(open_hull(ship, &h));
    MPS__TRY(mps__motion_state_in(tank, &own));
    MPS__TRY(mps__struct_check(NULL, "mps_ship_motion", motion));
    const attitude a = find_attitude(&h, &own);
    mps__angles angles = {.order = h.order};
    if (!mps__rotation_angles(&h.rest, &a.axes, a.omega, a.alpha, &angles)) return MPS_E_STATE;
    to_axes(&h.rest, own.value, result.value);
    to_axes(&h.rest, own.rate, result.rate);
    to_axes(&h.rest, own.accel, result.accel);
    for (int n = 0; n < 3; n++) {
        const int dof = MPS_SHIP_ROLL + h.order[n];
        result.value[dof] = angles.angle[n] / h.unit;
        result.rate[dof] = angles.rate[n] / h.unit;
        result.accel[dof] = angles.accel[n] / h.unit;
    }
    return mps__struct_out(NULL, "mps_ship_motion", motion, &result, sizeof result);
}

/* ---- tables ---- */

static bool is_chosen(int32_t dofs, const int32_t *dof, int32_t which)
{
    for (int32_t c = 0; c < dofs; c++)
        if (dof[c] == which) return true;
    return false;
}

static bool good_columns(int32_t dofs, const int32_t *dof)
{
    if (dofs < 1 || dofs > MPS_DOF_COUNT || !dof) return false;
    for (int32_t c = 0; c < dofs; c++)
        if (dof[c] < 0 || dof[c] >= MPS_DOF_COUNT || is_chosen(c, dof, dof[c])) return false;
    return true;
}

/* Convert one row; its angles continue those of the previous row. */
static mps_status convert_row(const hull *h, const double *six, mps_motion_state *tank)
{
    const double turn = 2 * MPS__PI;
    mps_ship_motion motion = {.struct_size = sizeof motion};
    double before[3];
    if (!mps__finite(six, DOFS)) return MPS_E_ARG;
    memcpy(motion.value, six, sizeof motion.value);
    memcpy(before, &tank->value[MPS_ROTATE_X], sizeof before);
    MPS__TRY(find_tank(h, &motion, tank));
    for (int d = 0; d < 3; d++) {
        double *angle = &tank->value[MPS_ROTATE_X + d];
        *angle += turn * round((before[d] - *angle) / turn);
    }
    return MPS_OK;
}

mps_status mps_ship_table(const mps_ship *ship, int64_t rows, const double *columns, int32_t dofs,
                          const int32_t *dof, double *values)
{
    hull h;
    MPS__TRY(open_hull(ship, &h));
    if (rows < 1 || !columns || !values || !good_columns(dofs, dof)) return MPS_E_ARG;
    /* the first pass validates, the second one cannot fail and writes */
    for (int pass = 0; pass < 2; pass++) {
        mps_motion_state tank = {.struct_size = sizeof tank};
        for (int64_t k = 0; k < rows; k++) {
            MPS__TRY(convert_row(&h, columns + DOFS * k, &tank));
            for (int32_t d = 0; d < MPS_DOF_COUNT; d++)
                if (tank.value[d] != 0 && !is_chosen(dofs, dof, d)) return MPS_E_ARG;
            for (int32_t c = 0; pass == 1 && c < dofs; c++)
                values[k * dofs + c] = tank.value[dof[c]];
        }
    }
    return MPS_OK;
}

/* ---- vectors and loads ---- */

/* Axes of the components, and the arm R (at - origin). */
typedef struct view {
    mps__triad axes;
    double arm[3];
} view;

static mps_status open_view(const mps_ship *ship, const mps_motion_state *tank, int32_t axes,
                            const double *at, view *v)
{
    hull h;
    mps_motion_state own;
    MPS__TRY(open_hull(ship, &h));
    MPS__TRY(mps__motion_state_in(tank, &own));
    if (axes != MPS_SHIP_FIXED && axes != MPS_SHIP_BODY) return MPS_E_ARG;
    if (at && !mps__finite(at, 3)) return MPS_E_ARG;
    const attitude a = find_attitude(&h, &own);
    v->axes = axes == MPS_SHIP_BODY ? a.axes : h.rest;
    double arm[3] = {0};
    for (int d = 0; at && d < 3; d++) arm[d] = at[d] - h.origin[d];
    to_axes(&h.rest, arm, v->arm);
    from_axes(&a.axes, v->arm, v->arm);
    return MPS_OK;
}

mps_status mps_ship_vector_from_lab(const mps_ship *ship, const mps_motion_state *tank,
                                    int32_t axes, const double *lab, double *vector)
{
    view v;
    MPS__TRY(open_view(ship, tank, axes, NULL, &v));
    if (!lab || !vector || !mps__finite(lab, 3)) return MPS_E_ARG;
    to_axes(&v.axes, lab, vector);
    return MPS_OK;
}

mps_status mps_ship_vector_to_lab(const mps_ship *ship, const mps_motion_state *tank, int32_t axes,
                                  const double *vector, double *lab)
{
    view v;
    MPS__TRY(open_view(ship, tank, axes, NULL, &v));
    if (!lab || !vector || !mps__finite(vector, 3)) return MPS_E_ARG;
    from_axes(&v.axes, vector, lab);
    return MPS_OK;
}

mps_status mps_ship_load_from_lab(const mps_ship *ship, const mps_motion_state *tank, int32_t axes,
                                  const double *at, const double *lab, double *load)
{
    view v;
    double moment[3];
    MPS__TRY(open_view(ship, tank, axes, at, &v));
    if (!lab || !load || !mps__finite(lab, 6)) return MPS_E_ARG;
    mps__cross(v.arm, lab, moment);
    for (int d = 0; d < 3; d++) moment[d] += lab[3 + d];
    to_axes(&v.axes, lab, load);
    to_axes(&v.axes, moment, load + 3);
    return MPS_OK;
}

mps_status mps_ship_load_to_lab(const mps_ship *ship, const mps_motion_state *tank, int32_t axes,
                                const double *at, const double *load, double *lab)
{
    view v;
    double shifted[3];
    MPS__TRY(open_view(ship, tank, axes, at, &v));
    if (!lab || !load || !mps__finite(load, 6)) return MPS_E_ARG;
    from_axes(&v.axes, load, lab);
    from_axes(&v.axes, load + 3, lab + 3);
    mps__cross(v.arm, lab, shifted);
    for (int d = 0; d < 3; d++) lab[3 + d] -= shifted[d];
    return MPS_OK;
}

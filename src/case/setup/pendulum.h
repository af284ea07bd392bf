/* SPDX-License-Identifier: BSD-3-Clause */
/* Liquid in a box by linear theory, as spring-mass systems: Graham & Rodriguez 1952, Abramson, NASA
 * SP-106, 1966. */
#ifndef MPS_CASE_PENDULUM_H
#define MPS_CASE_PENDULUM_H

#include "build.h"

enum { PENDULUM_MODES = 200 };

/* Odd modes n = 1, 3 ... of waves along one axis of a box with length L and depth h, k = n pi/L:
 *   m_n = 8 m tanh(k h)/(n^3 pi^3 h/L), w_n^2 = g k tanh(k h), height above the floor h (1 - tanh(k
 * h/2)/(k h/2)). */
typedef struct pendulum {
    double mass, gravity;
    /* mass that moves with the tank; its moment of inertia about its own centre */
    double rest, rest_height, rest_inertia;
    double floor, middle; /* of the tank from the centre: up, along the axis [m] */
    double m[PENDULUM_MODES], w2[PENDULUM_MODES], z[PENDULUM_MODES]; /* heights above the floor */
} pendulum;

/* @return false: the liquid is not one fluid in a box, filled to a level */
bool mps__pendulum_make(const build *b, const double *centre, pendulum *p);
/* -w^2 A(w) + C for a translation along the waves (turn false), or a rotation in their plane [N/m,
 * N m/rad]. */
double mps__pendulum_stiffness(const pendulum *p, bool turn, double w);
/* The two lowest natural periods of a body with this liquid [s], longest first; nan: not found. */
void mps__pendulum_periods(const pendulum *p, bool turn, double mass, double stiffness,
                           double period[2]);

#endif

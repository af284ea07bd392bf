/* SPDX-License-Identifier: BSD-3-Clause */
/* Boundary layers at two parallel side walls at distance b, as a function of the mean velocity u
 * across b, relative to the walls. Laminar flow from rest gives (Laplace transform; nu the
 * kinematic viscosity)
 *   a(s) = -s [1/(1 - tanh(z)/z) - 1] u(s),   z = b/2 sqrt(s/nu)
 * or, in time,
 *   a = -nu/b^2 [12 u + sum_n 8 (u - q_n)],   dq_n/dt = 4 w_n^2 nu/b^2 (u - q_n),   tan w_n = w_n.
 * q_n is the velocity of mode n of the layers. The limits are two Stokes layers (early) and plane
 * Poiseuille flow, 12 nu/b^2 u with an added mass of 1/5 (late).
 *
 * The infinite sum is replaced by MPS__LAYERS modes of rates r_k = r_0 3.5^k (nu/b^2), r_0 = 4
 * w_1^2, and weights W_k = (2/pi) ln 3.5 sqrt(r_k): the trapezoidal rule in ln r for two Stokes
 * layers, 2/sqrt(pi t) = (2/pi) int sqrt(r) exp(-r t) d ln r. Its error is 2/sqrt(cosh(2 pi^2/ln
 * 3.5)) = 0.11 %. Modes begin at r_0; the first three weights satisfy these conditions exactly:
 *   sum W_k exp(-r_k t) -> 2/sqrt(pi t) - 8 for t -> 0,   sum W_k/r_k = 1/5,
 *   sum W_k/r_k^2 = 1/700.
 * So drag and added mass are within 0.31 % of the exact ones up to an angular frequency of 1e7
 * nu/b^2, where the layers are 0.045 % of the width.
 *
 * Energy: the walls take a.u from the mean flow. Its part sum_k W_k (u - q_k)^2 + 12 u^2 (nu/b^2)
 * is dissipated. The rest is the kinetic energy of the profile in excess of that of its mean,
 *   sum_k W_k/(2 r_k) q_k^2   for a unit of mass,
 * in steady flow 1/10 u^2. With the exact modes both are exact for any history of u. */
/* A wall with particles, whose layer may be thinner than the spacing dp. Let w be the velocity of
 * the first layer of fluid particles relative to the wall, and u the velocity far away. The exact
 * stress of a half space is rho sqrt(nu s) u. The viscosity models give less: see
 * docs/explanations/walls.md. The missing force on the first layer of particles per area and rho,
 * over w, is on a lattice a function of X = dp sqrt(s/nu) alone:
 *   Z(X) = nu/dp (X + D(X)),   D 1.3 in slow and 0.15 in fast flow at a far radius of 3.1 dp.
 * It follows from the momentum balance of the lattice layers. It is represented by the same modes:
 * X by the trapezoidal rule, with the rates 0.3 3.5^(k-6) nu/dp^2, D by the steady part and six of
 * the weights, least squares for layers of 0.05 to 8 dp. With the lattice layers the stress is
 * within 0.84 % of the exact one for layers of 0.1 to 6.6 dp. */
#ifndef MPS_PHASE_LAYERS_H
#define MPS_PHASE_LAYERS_H

#include <stdbool.h>

enum { MPS__LAYERS = 18 };

/* Coefficients of a step dt in which u changes linearly by du:
 *   mean of a = -(drag u - sum_k pull_k q_k) - added du/dt,   u and q_k at the beginning,
 *   q_k at the end = keep_k q_k + (1 - keep_k) u + rise_k du. */
typedef struct mps__layers {
    double keep[MPS__LAYERS], rise[MPS__LAYERS];
    double pull[MPS__LAYERS];   /* [1/s] */
    double energy[MPS__LAYERS]; /* W_k/(2 r_k) */
    double drag;                /* [1/s] */
    double added;               /* added mass of the layers, as a fraction */
} mps__layers;

/* nu: >= 0 [m2/s]; width: > 0 [m]; dt: > 0 [s]. Any step is stable: without other forces it reduces
 * u at most to 0. */
void mps__layers_of(double nu, double width, double dt, mps__layers *layers);

/* Coefficients of the first layer of particles at a wall in `dim` dimensions; `radius`: the far
 * radius [dp]. False: not known for this radius. */
bool mps__layers_of_wall(int dim, double radius, double nu, double dp, double dt,
                         mps__layers *layers);

/* Update the velocities q of `count` modes from `first` on over a step in which u changes by du. */
static inline void mps__layers_pass(const mps__layers *layers, int first, int count, double u,
                                    double du, double *q)
{
    for (int k = 0; k < count; k++) {
        const double keep = layers->keep[first + k];
        q[k] = keep * q[k] + (1 - keep) * u + layers->rise[first + k] * du;
    }
}

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/** @file flux.h  Flux of a pair of the pressure equation. Matrix, right-hand side, pressure
 *  gradient and wall loads use these functions, so that they are consistent.
 *
 *    flux_ij = k_ij (p_i - p_j + q_ij),   k_ij = 2D/(n0 lambda) s_ij W_ij / rho_ij,
 *    q_ij = rho_ij b_ij.r_ij - jump_ij,   r_ij = x_j - x_i,
 *
 *  s_ij the weight of the pair, rho_ij its density, b_ij its body acceleration, jump_ij the
 *  pressure of i minus that of j by surface tension. W22: Wen, Zhao & Wan (2022). */
#ifndef MPS_FLUX_H
#define MPS_FLUX_H

#include <mps/types.h>

MPS_BEGIN_DECLS

/** Arrays from which fluxes are computed; borrowed from a stage. */
typedef struct mps_flux {
    /** sizeof(mps_flux) */
    uint32_t struct_size;
    /** 1: pressures relative to those of a fluid that moves with the tank, b = g - a_tank. 0: b =
     *  0. */
    int32_t body;
    /** [n] */
    const int32_t *kind;
    /** [n] */
    const int32_t *phase;
    /** [n] "pressure_density", or "density" if no model provides it [kg/m3] */
    const double *density;
    /** [n] "interface_distance" [m], or NULL */
    const double *distance;
    /** [n] "pressure_jump" [Pa], or NULL */
    const double *jump;
    /** [n] "wetted_share" [-], or NULL */
    const double *wetted;
    /** [n*dim] "tank_acceleration" [m/s2] */
    const double *tank_acceleration;
    /** Gravity [m/s2]. */
    double g[3];
    /** Weight of wall-wall pairs, the channel "equation_wall_factor". */
    double wall_factor;
} mps_flux;

/** Mean density along the line between two particles by their distances from the interface [kg/m3];
 *  (rho_i + rho_j)/2, W22 (17), where these are unknown. distance may be NULL. */
static inline double mps_pair_density(const double *density, const double *distance, int64_t i,
                                      int64_t j)
{
    const double a = density[i], b = density[j];
    if (a == b || !distance || !(distance[i] > 0 && distance[j] > 0)) return 0.5 * (a + b);
    return (distance[i] * a + distance[j] * b) / (distance[i] + distance[j]);
}

/** rho_ij [kg/m3]. */
static inline double mps_flux_density(const mps_flux *f, int64_t i, int64_t j)
{
    return mps_pair_density(f->density, f->distance, i, j);
}

/** jump_ij [Pa]: (jump_i - jump_j)/2 between two phases of fluid, else 0. */
static inline double mps_flux_jump(const mps_flux *f, int64_t i, int64_t j)
{
    if (!f->jump || f->phase[i] == f->phase[j]) return 0.0;
    if (f->kind[i] != MPS_FLUID || f->kind[j] != MPS_FLUID) return 0.0;
    return 0.5 * (f->jump[i] - f->jump[j]);
}

/** b_ij.r_ij [m2/s2]. @param r  [dim] r_ij */
static inline double mps_flux_body(const mps_flux *f, int dim, int64_t i, int64_t j,
                                   const double *r)
{
    const double *a = f->tank_acceleration + i * dim, *b = f->tank_acceleration + j * dim;
    double sum = 0;
    if (!f->body) return 0.0;
    for (int d = 0; d < dim; d++) sum += 0.5 * ((f->g[d] - a[d]) + (f->g[d] - b[d])) * r[d];
    return sum;
}

/** s_ij of two wall particles: each is half a cell, weighted by its wetted fraction. */
static inline double mps_flux_wall_fraction(const mps_flux *f, int64_t i, int64_t j)
{
    const double a = f->wetted ? f->wetted[i] : 1.0, b = f->wetted ? f->wetted[j] : 1.0;
    return f->wall_factor * (a < b ? a : b);
}

MPS_END_DECLS

#endif

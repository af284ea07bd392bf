/* SPDX-License-Identifier: BSD-3-Clause */
/* Wall pressure by action and reaction: a wall shows the pressure that the fluid beside it received.
 *
 * The row of a wall asks for the pressure that stops all fluid within its radius in one step, however far from the wall it still is. The
 * gradient gives a particle only the share W/r^2 of the pair, so the particle goes on and the wall asks again: for one row of particles at 1,
 * 1.5 and 1.9 dp the impulse of these pressures is 2, 9 and 140 times the momentum. So p_i is right for the equation and wrong as a load.
 *
 *   P_i = p' + sum_j c_ij e_j,   c_ij = s_j V D/(n0 A_i) w_ij n.B_j r_ij
 *
 * over the fluid j about wall i, r_ij = x_j - x_i, w = W/r^2, n the normal, A_i the area, V = dp^D. p'_j = p_j - rho b.r_ij is the pressure of j carried to the
 * wall, p' its kernel mean. c_ij is the share of j in the face: in the lattice they add up to 1 with s_j = 2 inside the fluid, where the other half of B_j is that
 * of the row behind, and s_j = 1 on the surface. e_j is what pressure rises to the wall beyond p'_j: inside the fluid with the acceleration a_j that
 * all pressures gave it, e_j = rho (a_j + b).r_ij; on the surface, where the wall alone pushes, e_j = p_i - p'_j. Where pressures are linear P_i is p_i.
 * A wall shows no more suction than it has in the equation: one that lets go of the liquid (separation.void) shows none. The flow does not change. */
#include "builtin.h"

/* Sums over the fluid about a wall particle. */
typedef struct contact {
    double weight, p, rise; /* sum W, sum W p'_j, A_i sum c_ij e_j */
} contact;

/* Unit normal of a wall particle. @return its area; 0: a plate's edge, say, which has none to speak of */
MPS__ROW double face(const int dim, const mps_stage *s, int64_t i, double n[3])
{
    double size = 0;
    for (int d = 0; d < dim; d++) size += s->area[i * dim + d] * s->area[i * dim + d];
    size = sqrt(size);
    for (int d = 0; d < dim; d++) n[d] = size > 0 ? s->area[i * dim + d] / size : 0;
    return size > 1e-4 * (dim == 2 ? s->dp : s->dp * s->dp) ? size : 0;
}

MPS__ROW contact sum_contact(const int dim, const mps_stage *s, const double *a, int64_t i, const double n[3])
{
    const mps_stencil *t = s->near;
    const double cell = (dim == 2 ? s->dp * s->dp : s->dp * s->dp * s->dp) * dim / t->n0;
    contact c = {0};
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        if (s->kind[j] != MPS_FLUID || s->region[j] >= MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        const double *b = s->correction + j * dim * dim, rho = mps_stage_pair_density(s, i, j);
        double body = 0, slope = 0, push = 0;
        for (int d = 0; d < dim; d++) {
            body += (s->g[d] - 0.5 * (s->tank_accel[i * dim + d] + s->tank_accel[j * dim + d])) * q.d[d];
            slope += a[j * dim + d] * q.d[d];
            for (int e = 0; e < dim; e++) push += n[d] * b[d * dim + e] * q.d[e];
        }
        const double carried = s->p[j] - rho * body;
        const bool surface = s->region[j] == MPS_REGION_SURFACE;
        c.weight += q.w;
        c.p += q.w * carried;
        c.rise += cell * q.w_r2 * push * (surface ? s->p[i] - carried : 2.0 * rho * (slope + body));
    }
    return c;
}

MPS__ROW double wall_pressure(const int dim, const mps_stage *s, const double *a, int64_t i)
{
    double n[3];
    const double size = face(dim, s, i, n);
    const contact c = sum_contact(dim, s, a, i, n);
    if (c.weight == 0) return s->p[i];
    return fmax(c.p / c.weight + (size > 0 ? c.rise / size : 0), fmin(s->p[i], 0));
}

static int load(void *self, const double *k, mps_stage *s, const double *a)
{
    (void)self, (void)k;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_WALL && s->region[i] != MPS_REGION_DRY) s->wall_pressure[i] = MPS__ROW_CALL(s, wall_pressure, s, a, i);
    return 0;
}

const mps_model_ops mps__load_reaction = {
    .struct_size = sizeof(mps_model_ops), .api = MPS_MODEL_API, .name = "load.reaction", .order = 650, .load = load};

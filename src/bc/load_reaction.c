/* SPDX-License-Identifier: BSD-3-Clause */
/* Wall pressure by action and reaction: a wall shows the pressure that the fluid beside it received.
 *
 * The row of a wall asks for the pressure that stops all fluid within its radius in one step, however far from the wall it still is. The
 * gradient gives a particle only the share W/r^2 of the pair, so the particle goes on and the wall asks again: for one row of particles at 1,
 * 1.5 and 1.9 dp the impulse of these pressures is 2, 9 and 140 times the momentum. So p_i is right for the equation and wrong as a load.
 *
 *   P_i = p' + F_i/A_i,   F_i = sum_j s_j V D/n0 w_ij (p_i - p'_j) n.B_j r_ij
 *
 * over the fluid about wall i, r_ij = x_j - x_i, w = W/r^2, n the normal, A_i the area, V = dp^D; p'_j = p_j - rho b.r_ij is the pressure of j carried to the
 * wall, p' its kernel mean: what the fluid passes on. F_i is what the pairs of this wall give beyond that, as gradient.corrected does. Inside the fluid a
 * pair pushes both of its particles, so that a row gets the other half from the row behind it: s_j = 2, and 1 on the surface, where there is none.
 * P_i lies between p' and p_i, and is p_i in hydrostatic fluid. The flow does not change. */
#include "builtin.h"

/* Sums over the fluid about a wall particle. */
typedef struct contact {
    double weight, p, force; /* sum W, sum W p'_j, F_i */
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

MPS__ROW contact sum_contact(const int dim, const mps_stage *s, int64_t i, const double n[3])
{
    const mps_stencil *t = s->near;
    const double cell = (dim == 2 ? s->dp * s->dp : s->dp * s->dp * s->dp) * dim / t->n0;
    contact c = {0};
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        if (s->kind[j] != MPS_FLUID || s->region[j] >= MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        const double *b = s->correction + j * dim * dim, share = s->region[j] == MPS_REGION_SURFACE ? 1.0 : 2.0;
        double slope = 0, push = 0;
        for (int d = 0; d < dim; d++) slope += (s->g[d] - 0.5 * (s->tank_accel[i * dim + d] + s->tank_accel[j * dim + d])) * q.d[d];
        for (int d = 0; d < dim; d++)
            for (int e = 0; e < dim; e++) push += n[d] * b[d * dim + e] * q.d[e];
        const double carried = s->p[j] - mps_stage_pair_density(s, i, j) * slope;
        c.weight += q.w;
        c.p += q.w * carried;
        c.force += share * cell * q.w_r2 * (s->p[i] - carried) * push;
    }
    return c;
}

MPS__ROW double wall_pressure(const int dim, const mps_stage *s, int64_t i)
{
    double n[3];
    const double size = face(dim, s, i, n);
    const contact c = sum_contact(dim, s, i, n);
    if (c.weight == 0) return s->p[i];
    const double passed = c.p / c.weight, sum = size > 0 ? passed + c.force / size : passed;
    return fmin(fmax(sum, fmin(passed, s->p[i])), fmax(passed, s->p[i]));
}

static int load(void *self, const double *k, mps_stage *s)
{
    (void)self, (void)k;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_WALL && s->region[i] != MPS_REGION_DRY) s->wall_pressure[i] = MPS__ROW_CALL(s, wall_pressure, s, i);
    return 0;
}

const mps_model_ops mps__load_reaction = {
    .struct_size = sizeof(mps_model_ops), .api = MPS_MODEL_API, .name = "load.reaction", .order = 650, .load = load};

/* SPDX-License-Identifier: BSD-3-Clause */
/* How far each particle is from an interface between two densities, so that pairs across it have the density that fluid at rest needs,
 *   rho_ij = (f_i rho_i + f_j rho_j)/(f_i + f_j),  f the distances of both,
 * the mean along the line between them (mps_stage_pair_density()). Of (rho_i + rho_j)/2 no pressure can make all pairs of a particle agree
 * unless the interface halves each of them, and fluid at rest is stirred.
 * The interface about a particle is a plane: its normal is the mean direction of the pairs across it, from heavy to light, and it goes through
 * the mean of their middles. Both are means over the far radius less half a spacing, so that the lattice does not show. What is beyond its
 * own plane is `least` dp from it. Where pairs point everywhere (drops and threads of a few particles: |sum r_ij|/sum |r_ij| below `flat`) all
 * are half a spacing away, which makes the mean of both densities, W22 (17). Solids are on the side of the plane on which they stand. */
#include "builtin.h"

enum { LEAST, FLAT };
static const mps_setting settings[] = {{"least", 0.1, 0.01, 0.5}, {"flat", 0.5, 0.0, 0.99}};
static const double BLEND = 0.2; /* of |sum r_ij|/sum |r_ij| between a mean and a plane */

/* Weighted sums over pairs across an interface: of 1, of their middles less x_i, of the way to the lighter particle, of its length. */
typedef struct crossing {
    double weight, middle[3], toward[3], length, heaviest, lightest;
} crossing;

static inline bool in_fluid(const mps_stage *s, int64_t i)
{
    return s->kind[i] == MPS_FLUID && s->region[i] < MPS_REGION_SPRAY;
}

/* Whether lighter fluid is among the near neighbours of a fluid particle. */
static bool above_lighter(const mps_stage *s, int64_t i)
{
    const mps_stencil *t = s->near;
    bool found = false;
    if (!in_fluid(s, i)) return false;
    for (int64_t p = t->begin[i]; p < t->end[i] && !found; p++) found = in_fluid(s, t->col[p]) && s->density[t->col[p]] < s->density[i];
    return found;
}

/* Whether a pair of particle i has two densities. */
static bool at_interface(const mps_stage *s, int64_t i)
{
    const mps_stencil *t = s->near;
    bool found = false;
    if (s->region[i] >= MPS_REGION_SPRAY) return false;
    for (int64_t p = t->begin[i]; p < t->end[i] && !found; p++)
        found = s->region[t->col[p]] < MPS_REGION_SPRAY && s->density_smooth[t->col[p]] != s->density_smooth[i];
    return found;
}

/* The pairs of particle j, at `at` from i, with lighter fluid. */
MPS__ROW void add_pairs(const int dim, const mps_stage *s, int64_t j, const double *at, double reach, crossing *c)
{
    const mps_stencil *t = s->near;
    for (int64_t p = t->begin[j]; p < t->end[j]; p++) {
        if (!in_fluid(s, t->col[p]) || s->density[t->col[p]] >= s->density[j]) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, j, p);
        double middle[3], r2 = 0;
        for (int d = 0; d < dim; d++) {
            middle[d] = at[d] + 0.5 * q.d[d];
            r2 += middle[d] * middle[d];
        }
        if (r2 >= reach * reach) continue;
        const double near = 1.0 - sqrt(r2) / reach, w = near * near * q.w;
        c->weight += w;
        c->length += w * q.r;
        c->heaviest = fmax(c->heaviest, s->density[j]);
        c->lightest = fmin(c->lightest, s->density[q.j]);
        for (int d = 0; d < dim; d++) {
            c->middle[d] += w * middle[d];
            c->toward[d] += w * q.d[d];
        }
    }
}

/* Distance of i from the interface; `rho` is its density for operators of the pressure, changed where i is solid. */
MPS__ROW double distance(const int dim, const double *k, const mps_stage *s, const double *heavy, int64_t i, double *rho)
{
    static const double here[3] = {0};
    const mps_stencil *t = s->far;
    const double reach = t->re - 0.5 * s->dp, unknown = 0.5 * s->dp;
    crossing c = {.lightest = INFINITY};
    double size = 0, f = 0;
    if (heavy[i] > 0) add_pairs(dim, s, i, here, reach, &c);
    for (int64_t p = t->begin[i]; p < t->end[i]; p++)
        if (heavy[t->col[p]] > 0) add_pairs(dim, s, t->col[p], mps_stencil_pair_dim(dim, t, i, p).d, reach, &c);
    for (int d = 0; d < dim; d++) {
        size += c.toward[d] * c.toward[d];
        f += c.middle[d] * c.toward[d];
    }
    if (!(size > 0)) return unknown;
    size = sqrt(size);
    f /= c.weight * size; /* from i to the plane, toward the lighter side */
    const double trust = fmin(1.0, fmax(0.0, (size / c.length - k[FLAT]) / BLEND));
    if (s->kind[i] != MPS_FLUID && trust > 0.5) *rho = f > 0 ? c.heaviest : c.lightest;
    if (*rho < c.heaviest) f = -f;
    return fmax(k[LEAST] * s->dp, trust * f + (1.0 - trust) * unknown);
}

static int classify(void *self, const double *k, mps_stage *s)
{
    (void)self;
    double *heavy = mps_stage_scratch(s, s->n), *rho = mps_stage_scratch(s, s->n); /* heavy: beside lighter fluid */
    if (!heavy || !rho) return 1;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) heavy[i] = above_lighter(s, i);
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        rho[i] = s->density_smooth[i];
        if (at_interface(s, i)) s->depth[i] = MPS__ROW_CALL(s, distance, k, s, heavy, i, &rho[i]);
    }
    for (int64_t i = 0; i < s->n; i++) s->density_smooth[i] = rho[i];
    return 0;
}

const mps_model_ops mps__density_interface = {.struct_size = sizeof(mps_model_ops),
                                              .api = MPS_MODEL_API,
                                              .name = "density.interface",
                                              .order = 260,
                                              .setting_count = 2,
                                              .settings = settings,
                                              .classify = classify};

/* SPDX-License-Identifier: BSD-3-Clause */
/* Links between dummies and their walls, and areas of walls that were added without. */
#include "world_ranks.h"

/* The shadows of a plate belong to the face before them. */
static bool may_belong(const mps__world *w, int64_t dummy, int64_t wall)
{
    const mps__particles *s = &w->particles;
    if (!mps__is_shadow(s, dummy)) return true;
    const mps__occluder *occluder = &w->lists.occluders.list[s->plate[dummy] - 1];
    return s->plate[wall] == s->plate[dummy] &&
           mps__dot(s->area + wall * s->dim, occluder->normal, s->dim) *
                   mps__occluder_height(occluder, s->ref + dummy * s->dim) <
               0;
}

/* Link each dummy to its nearest wall particle (of two at the same distance: the older). Beyond the
 * far radius no fluid is its neighbour either. */
static void link_dummies(mps__world *w)
{
    mps__particles *s = &w->particles;
    const mps_neighbours *l = &w->lists.neighbours;
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_DUMMY) continue;
        double best = INFINITY;
        s->wall_of[i] = -1;
        for (int64_t k = l->begin[i]; k < l->begin[i] + l->count[i]; k++) {
            const int32_t j = l->col[k];
            if (s->kind[j] != MPS_WALL || !may_belong(w, i, j)) continue;
            double r2 = 0;
            for (int d = 0; d < w->setup.dim; d++) {
                const double r = s->ref[(int64_t)j * w->setup.dim + d] -
                                 s->ref[i * w->setup.dim + d];
                r2 += r * r;
            }
            const double margin = 1e-9 * w->setup.dp * w->setup.dp;
            if (r2 > best + margin || (r2 > best - margin && s->id[j] > s->id[s->wall_of[i]]))
                continue;
            best = r2;
            s->wall_of[i] = j;
        }
    }
}

/* Sum of the vectors from the dummies of wall particle i to it; needs all candidates. */
static void sum_ways(const mps__world *w, int64_t i, double *sum)
{
    const mps__particles *s = &w->particles;
    const mps_neighbours *l = &w->lists.neighbours;
    const int dim = w->setup.dim;
    for (int d = 0; d < dim; d++) sum[d] = 0;
    for (int64_t k = l->begin[i]; k < l->begin[i] + l->count[i]; k++) {
        const int64_t j = l->col[k];
        for (int d = 0; d < dim && s->wall_of[j] == i; d++)
            sum[d] += s->ref[i * dim + d] - s->ref[j * dim + d];
    }
}

/* Estimate missing areas: a wall particle faces away from its dummies. */
static void estimate_areas(mps__world *w)
{
    mps__particles *s = &w->particles;
    const int dim = w->setup.dim;
    for (int64_t i = 0; i < s->n; i++) {
        double *area = s->area + i * dim, sum[3];
        if (s->kind[i] != MPS_WALL || mps__dot(area, area, dim) > 0) continue;
        sum_ways(w, i, sum);
        const double length = sqrt(mps__dot(sum, sum, dim));
        if (length < 1e-6 * w->setup.dp) continue;
        for (int d = 0; d < dim; d++) area[d] = sum[d] / length * mps_pow(w->setup.dp, dim - 1);
    }
}

mps_status mps__world_link_walls(mps__world *w)
{
    link_dummies(w);
    MPS__TRY(mps__world_link_ghosts(w));
    estimate_areas(w);
    return mps__world_exchange_areas(w);
}

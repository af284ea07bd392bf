/* SPDX-License-Identifier: BSD-3-Clause */
/* Separation: walls do not pull where void can reach. Without a gas in it the liquid leaves a wall as soon as the wall would have to pull, if
 * void is beside it: behind an edge, at a crest that falls, on a wall that moves away. A wall with a surface particle, spray or a dry wall
 * among its near neighbours has a least pressure,
 *   p_i >= min(0, min_j rho_j b.(x_i - x_j)),   b = g - a_tank, over the surface particles j about it:
 * the static pressure of a wall above the contact line, so that calm water does not change. Walls that see liquid alone may pull: void reaches
 * them only when those before them have let go.
 * A velocity jump of the tank is an impulse that wants its suction, and a gain below 1 spreads it over several steps: none in the first `hold`. */
#include "builtin.h"

enum { HOLD };
static const mps_setting settings[] = {{"hold", 5.0, 0.0, 1000.0}};

/* Least pressure of wall i; +inf: no void near. */
MPS__ROW double least_pressure(const int dim, const mps_stage *s, int64_t i)
{
    const mps_stencil *t = s->near;
    double least = INFINITY;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        const int32_t region = s->region[j];
        const bool surface = s->kind[j] == MPS_FLUID && region == MPS_REGION_SURFACE;
        if (!surface && !(s->kind[j] == MPS_FLUID && region == MPS_REGION_SPRAY) && !(s->kind[j] == MPS_WALL && region == MPS_REGION_DRY))
            continue;
        double body = 0;
        for (int d = 0; d < dim && surface; d++) body += (s->g[d] - s->tank_accel[i * dim + d]) * (s->x[i * dim + d] - s->x[j * dim + d]);
        least = fmin(least, fmin(0, s->density[j] * body));
    }
    return least;
}

static int source(void *self, const double *k, mps_stage *s, mps_ppe_terms *terms)
{
    (void)self;
    if ((double)s->since_jump < k[HOLD]) return 0;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_WALL || s->region[i] != MPS_REGION_INNER || terms->fixed[i] != MPS_ROW_FREE) continue;
        const double least = MPS__ROW_CALL(s, least_pressure, s, i);
        if (!(least <= 0)) continue;
        terms->fixed[i] = MPS_ROW_LEAST;
        terms->value[i] = least;
    }
    return 0;
}

const mps_model_ops mps__separation_void = {.struct_size = sizeof(mps_model_ops),
                                            .api = MPS_MODEL_API,
                                            .name = "separation.void",
                                            .order = 550,
                                            .setting_count = 1,
                                            .settings = settings,
                                            .source = source};

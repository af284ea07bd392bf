/* SPDX-License-Identifier: BSD-3-Clause */
/* Free surface, W22 (11)(12), Z14 (16)(17): n < low n0, or n < high n0 and |A| > share |A|0, where |A|0 belongs to the
 * surface row of a lattice. In a violent flow inner particles fall below low n0 too, and p = 0 amid high pressure tears the fluid:
 * between lone n0 and low n0 some asymmetry is asked for as well, |A| > low_share |A|0 (lone = low is the paper's). Particles with too little fluid about them are spray.
 * A film of one row on a wall has n0 and more, because the wall is near, but is more one-sided than any surface: |A|/|A|0 > film n/n0. As inner
 * particles such rows answer to their own pressure with the wrong sign, see docs/records/numerics-history.md. With n on the right what is squeezed together,
 * and one-sided for that, does not lose its pressure.
 * The papers test wall particles too (walls = 1): dry walls have p = 0.
 * Beside a wall that goes on above the surface n is too large and |A| too small: there a neighbour of the surface belongs to it as well if
 * n < contact_low n0 and |A| > contact_share |A|0 (contact = 1). Without it such
 * particles flicker in and out of the surface: a 3-D tank does not come to rest, a trough in 2-D breaks up at the wall. */
#include "builtin.h"
#include <stdbool.h>

enum { LOW, HIGH, SHARE, SPRAY, WALLS, COMPLETE, LONE, LOW_SHARE, CONTACT, CONTACT_LOW, CONTACT_SHARE, FILM };
static const mps_setting settings[] = {{"low", 0.8, 0.0, 1.0},          {"high", 0.97, 0.5, 1.0},          {"share", 0.9, 0.0, 2.0},
                                       {"spray", 0.25, 0.0, 1.0},       {"walls", 0.0, 0.0, 1.0},          {"complete", 1.0, 0.0, 1.0},
                                       {"lone", 0.6, 0.0, 1.0},         {"low_share", 0.4, 0.0, 2.0},      {"contact", 1.0, 0.0, 1.0},
                                       {"contact_low", 0.95, 0.0, 1.0}, {"contact_share", 0.55, 0.0, 2.0}, {"film", 1.1, 0.0, 100.0}};

/* |A| of a particle in the top row of a lattice that fills the half space below it. */
static double lattice_asymmetry(const mps_stencil *t)
{
    const int reach = (int)(t->re / t->dp) + 1, depth = t->dim == 3 ? reach : 0;
    double sum = 0;
    for (int k = -depth; k <= depth; k++)
        for (int j = -reach; j < 0; j++)
            for (int i = -reach; i <= reach; i++) {
                const double r = t->dp * sqrt((double)(i * i + j * j + k * k));
                if (r < t->re) sum -= j * t->dp / r * mps_kernel_weight(&t->kernel, r, t->re);
            }
    return t->dim * sum / t->n0;
}

/* Inner fluid particles with a near neighbour of region `from` become `to`. These are few, and pairs are symmetric: one thread looks about
 * each of them sooner than all threads about everybody else. */
static void spread(mps_stage *s, int32_t from, int32_t to)
{
    const mps_stencil *t = s->near;
    for (int64_t i = 0; i < s->n; i++) {
        if (s->region[i] != from || s->kind[i] != MPS_FLUID) continue;
        for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
            const int64_t j = t->col[p];
            if (s->region[j] == MPS_REGION_INNER && s->kind[j] == MPS_FLUID) s->region[j] = to;
        }
    }
}

/* The row below the surface reaches past it, where there is nobody: its pairs with the surface carry that flux too. */
static int source(void *self, const double *k, mps_stage *s, mps_ppe_terms *terms)
{
    (void)self, (void)s;
    terms->complete_surface = k[COMPLETE] > 0;
    return 0;
}

/* By n/n0 and |A|/|A|0. */
static inline bool on_surface(const double *k, double n, double a)
{
    return n < k[LONE] || (n < k[LOW] && a > k[LOW_SHARE]) || (n < k[HIGH] && a > k[SHARE]) || a > k[FILM] * n;
}

/* Is the kernel sum over the fluid, with or without its spray, less than `enough`? */
MPS__ROW bool detached(const int dim, const mps_stage *s, int64_t i, bool with_spray, double enough)
{
    const mps_stencil *t = s->near;
    double sum = 0;
    for (int64_t p = t->begin[i]; p < t->end[i] && sum < enough; p++)
        if (s->kind[t->col[p]] == MPS_FLUID && (with_spray || s->region[t->col[p]] != MPS_REGION_SPRAY))
            sum += mps_stencil_pair_dim(dim, t, i, p).w;
    return sum < enough;
}

/* |A|/|A|0 */
static double asymmetry_of(const mps_stage *s, int64_t i, double a0)
{
    double a = 0;
    for (int d = 0; d < s->dim; d++) a += s->asymmetry[i * s->dim + d] * s->asymmetry[i * s->dim + d];
    return sqrt(a) / a0;
}

/* Does a particle see both a wall and the surface within 1.5 dp? */
MPS__ROW bool at_contact(const int dim, const mps_stage *s, int64_t i)
{
    const mps_stencil *t = s->near;
    bool wall = false, surface = false;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        if (q.r2 > 2.25 * s->dp * s->dp) continue;
        wall = wall || s->kind[q.j] == MPS_WALL;
        surface = surface || (s->kind[q.j] == MPS_FLUID && s->region[q.j] == MPS_REGION_SURFACE);
    }
    return wall && surface;
}

/* Where the surface meets a wall. All see the surface as it was before. */
static int mark_contact(const double *k, mps_stage *s, double a0)
{
    double *found = mps_stage_scratch(s, s->n);
    if (!found) return 1;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_FLUID && s->region[i] == MPS_REGION_INNER && s->number_density[i] < k[CONTACT_LOW] * s->near->n0 &&
            asymmetry_of(s, i, a0) > k[CONTACT_SHARE])
            found[i] = MPS__ROW_CALL(s, at_contact, s, i);
    for (int64_t i = 0; i < s->n; i++)
        if (found[i] > 0) s->region[i] = MPS_REGION_SURFACE;
    return 0;
}

/* n and |A|/|A|0 of a particle as if there were no spray: no pressure acts on it, so that it is void for the others. */
MPS__ROW void without_spray(const int dim, const mps_stage *s, int64_t i, double a0, double *n, double *a)
{
    const mps_stencil *t = s->near;
    double sum = s->number_density[i], left[3], square = 0;
    for (int d = 0; d < dim; d++) left[d] = s->asymmetry[i * dim + d];
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        if (s->region[t->col[p]] != MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        sum -= q.w;
        for (int d = 0; d < dim; d++) left[d] += dim / t->n0 * q.w * q.d[d] / q.r;
    }
    for (int d = 0; d < dim; d++) square += left[d] * left[d];
    *n = sum / t->n0;
    *a = sqrt(square) / a0;
}

/* Is a particle beside spray on the surface, or one of the last of its body? What is left of the fluid amid spray has p = 0: one or two particles
 * that shared a pressure with the walls of a corner alone would take all that these push away. */
static bool beside_spray(const double *k, const mps_stage *s, int64_t i, double a0)
{
    double n, a;
    if (s->kind[i] != MPS_FLUID || s->region[i] != MPS_REGION_INNER) return false;
    if (MPS__ROW_CALL(s, detached, s, i, false, k[SPRAY] * s->near->n0)) return true;
    MPS__ROW_CALL(s, without_spray, s, i, a0, &n, &a);
    return on_surface(k, n, a);
}

/* All see the regions as they were before. */
static int mark_beside_spray(const double *k, mps_stage *s, double a0)
{
    double *found = mps_stage_scratch(s, s->n);
    if (!found) return 1;
    const mps_stencil *t = s->near;
    for (int64_t i = 0; i < s->n; i++)
        for (int64_t p = t->begin[i]; s->region[i] == MPS_REGION_SPRAY && p < t->end[i]; p++) found[t->col[p]] = 1;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++)
        if (found[i] > 0) found[i] = beside_spray(k, s, i, a0);
    for (int64_t i = 0; i < s->n; i++)
        if (found[i] > 0) s->region[i] = MPS_REGION_SURFACE;
    return 0;
}

static int classify(void *self, const double *k, mps_stage *s)
{
    (void)self;
    const mps_stencil *t = s->near;
    const double a0 = lattice_asymmetry(t);
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_FLUID && !(s->kind[i] == MPS_WALL && k[WALLS] > 0)) continue;
        const double a = asymmetry_of(s, i, a0);
        const double n = s->number_density[i] / t->n0;
        if (s->kind[i] == MPS_FLUID && MPS__ROW_CALL(s, detached, s, i, true, k[SPRAY] * t->n0))
            s->region[i] = MPS_REGION_SPRAY;
        else if (on_surface(k, n, a))
            s->region[i] = MPS_REGION_SURFACE;
    }
    if (mark_beside_spray(k, s, a0)) return 1;
    if (k[CONTACT] > 0 && mark_contact(k, s, a0)) return 1;
    spread(s, MPS_REGION_SURFACE, MPS_REGION_NEAR);
    spread(s, MPS_REGION_NEAR, MPS_REGION_SECOND);
    return 0;
}

const mps_model_ops mps__surface_asymmetry = {.struct_size = sizeof(mps_model_ops),
                                              .api = MPS_MODEL_API,
                                              .name = "surface.asymmetry",
                                              .order = 100,
                                              .setting_count = 12,
                                              .settings = settings,
                                              .classify = classify,
                                              .source = source};

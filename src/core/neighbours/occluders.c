/* SPDX-License-Identifier: BSD-3-Clause */
/* Occlusion: which particles thin plates hide from each other. */
#include "occluders.h"
#include <math.h>
#include <mps/numbers.h>

/* Number of occluders for which a particle stores its side. */
enum { MPS__OCCLUDER_BITS = 64 };

void mps__occluders_init(mps__occluders *s, mps__context *context, int32_t dim)
{
    *s = (mps__occluders){.context = context, .dim = dim};
}

void mps__occluders_free(mps__occluders *s)
{
    mps__free(s->context, s->list);
    mps__free(s->context, s->near_plate);
    mps__free(s->context, s->slot);
    mps__occluders_init(s, s->context, s->dim);
}

mps_status mps__occluders_reserve(mps__occluders *s)
{
    return mps__grow(s->context, (void **)&s->list, &s->capacity, s->count, s->count + 1,
                     sizeof *s->list);
}

void mps__occluders_add(mps__occluders *s, const mps__occluder *occluder)
{
    s->list[s->count++] = *occluder;
}

/* Component along v of X relative to the corner; vectors of 2-D have a zero third component. */
static double component(const mps__occluder *s, const double *v, const double *X)
{
    double sum = 0;
    for (int d = 0; d < 3; d++) sum += v[d] == 0 ? 0 : v[d] * (X[d] - s->corner[d]);
    return sum;
}

double mps__occluder_height(const mps__occluder *s, const double *X)
{
    return component(s, s->normal, X);
}

double mps__occluder_distance(const mps__occluder *s, const double *X)
{
    const double height = mps__occluder_height(s, X);
    double square = height * height;
    for (int e = 0; e < 2; e++) {
        const double at = component(s, s->along[e], X),
                     off = at < 0 ? at : mps_larger(0, at - s->length[e]);
        square += off * off;
    }
    return sqrt(square);
}

bool mps__occluder_crossed(const mps__occluder *s, const double *a, const double *b)
{
    const double ha = mps__occluder_height(s, a), hb = mps__occluder_height(s, b);
    if (!(ha * hb < 0)) return false;
    const double share = ha / (ha - hb);
    for (int e = 0; e < 2; e++) {
        const double from = component(s, s->along[e], a),
                     at = from + share * (component(s, s->along[e], b) - from);
        if (at < s->from[e] || at > s->to[e]) return false;
    }
    return true;
}

void mps__occluders_sides(const mps__occluder *list, int32_t count, mps__near_plate *a)
{
    a->above = 0;
    for (int32_t k = 0; k < count && k < MPS__OCCLUDER_BITS; k++)
        a->above |= (uint64_t)(mps__occluder_height(&list[k], a->at) > 0) << k;
}

/* Where plates meet, a line may cross several occluders: the shadow of the first one is visible
 * there. Most pairs are on the same side of all. */
bool mps__occluders_hidden(const mps__occluder *list, int32_t count, const mps__near_plate *a,
                           const mps__near_plate *b)
{
    const int32_t shadow = a->shadow ? a->shadow : b->shadow;
    const uint64_t apart = a->above ^ b->above;
    if (a->shadow && b->shadow) return true;
    if (!apart && count <= MPS__OCCLUDER_BITS) return shadow != 0;
    for (int32_t k = 0; k < count; k++) {
        if (k < MPS__OCCLUDER_BITS && !(apart >> k & 1)) continue;
        if (list[k].active && mps__occluder_crossed(&list[k], a->at, b->at)) return shadow != k + 1;
    }
    return shadow != 0;
}

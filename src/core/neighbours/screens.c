/* SPDX-License-Identifier: BSD-3-Clause */
/* Occlusion: which particles thin plates hide from each other. */
#include "screens.h"
#include <math.h>
#include <mps/numbers.h>

/* Number of occluders for which a particle stores its side. */
enum { MPS__SCREEN_BITS = 64 };

void mps__screens_init(mps__screens *s, mps__context *context, int32_t dim)
{
    *s = (mps__screens){.context = context, .dim = dim};
}

void mps__screens_free(mps__screens *s)
{
    mps__free(s->context, s->list);
    mps__free(s->context, s->seer);
    mps__free(s->context, s->slot);
    mps__screens_init(s, s->context, s->dim);
}

mps_status mps__screens_reserve(mps__screens *s)
{
    return mps__grow(s->context, (void **)&s->list, &s->capacity, s->count, s->count + 1,
                     sizeof *s->list);
}

void mps__screens_add(mps__screens *s, const mps__screen *screen)
{
    s->list[s->count++] = *screen;
}

/* Component along v of X relative to the corner; vectors of 2-D have a zero third component. */
static double component(const mps__screen *s, const double *v, const double *X)
{
    double sum = 0;
    for (int d = 0; d < 3; d++) sum += v[d] == 0 ? 0 : v[d] * (X[d] - s->corner[d]);
    return sum;
}

double mps__screen_height(const mps__screen *s, const double *X)
{
    return component(s, s->normal, X);
}

double mps__screen_distance(const mps__screen *s, const double *X)
{
    const double height = mps__screen_height(s, X);
    double square = height * height;
    for (int e = 0; e < 2; e++) {
        const double at = component(s, s->along[e], X),
                     off = at < 0 ? at : mps_larger(0, at - s->length[e]);
        square += off * off;
    }
    return sqrt(square);
}

bool mps__screen_crossed(const mps__screen *s, const double *a, const double *b)
{
    const double ha = mps__screen_height(s, a), hb = mps__screen_height(s, b);
    if (!(ha * hb < 0)) return false;
    const double share = ha / (ha - hb);
    for (int e = 0; e < 2; e++) {
        const double from = component(s, s->along[e], a),
                     at = from + share * (component(s, s->along[e], b) - from);
        if (at < s->from[e] || at > s->to[e]) return false;
    }
    return true;
}

void mps__screens_sides(const mps__screen *list, int32_t count, mps__seer *a)
{
    a->above = 0;
    for (int32_t k = 0; k < count && k < MPS__SCREEN_BITS; k++)
        a->above |= (uint64_t)(mps__screen_height(&list[k], a->at) > 0) << k;
}

/* Where plates meet, a line may cross several occluders: the shadow of the first one is visible
 * there. Most pairs are on the same side of all. */
bool mps__screens_hidden(const mps__screen *list, int32_t count, const mps__seer *a,
                         const mps__seer *b)
{
    const int32_t shadow = a->shadow ? a->shadow : b->shadow;
    const uint64_t apart = a->above ^ b->above;
    if (a->shadow && b->shadow) return true;
    if (!apart && count <= MPS__SCREEN_BITS) return shadow != 0;
    for (int32_t k = 0; k < count; k++) {
        if (k < MPS__SCREEN_BITS && !(apart >> k & 1)) continue;
        if (list[k].active && mps__screen_crossed(&list[k], a->at, b->at)) return shadow != k + 1;
    }
    return shadow != 0;
}

/* SPDX-License-Identifier: BSD-3-Clause */
#include "picture_scene.h"
#include "grow.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

bool mps__scene_reserve(scene *s, int64_t n)
{
    const size_t count = n > 0 ? (size_t)n : 1;
    s->n = n;
    free(s->x);
    s->x = count < SIZE_MAX / 64 ? malloc(count * (4 * sizeof *s->x + 2)) : NULL;
    s->p = s->x ? s->x + 3 * count : NULL;
    s->kind = s->x ? (uint8_t *)(s->p + count) : NULL;
    s->phase = s->x ? s->kind + count : NULL;
    return s->x != NULL;
}

void mps__scene_free(scene *s)
{
    free(s->x);
    free(s->sensor);
    free(s->edge);
    *s = (scene){0};
}

scene_sensor *mps__scene_sensor(scene *s, const char *name)
{
    scene_sensor *more = mps__grown(s->sensor, s->sensors, sizeof *more);
    if (!more) return NULL;
    s->sensor = more;
    scene_sensor *own = &more[s->sensors++];
    *own = (scene_sensor){0};
    snprintf(own->name, sizeof own->name, "%s", name);
    return own;
}

bool mps__scene_edges(scene *s, int32_t count)
{
    double *buffer = calloc(6 * (size_t)count + 1, sizeof *buffer);
    if (!buffer) return false;
    free(s->edge);
    s->edge = buffer;
    s->edges = count;
    return true;
}

/* Bounds of all walls, or of all fluid if there is no wall; above an open tank also of the fluid,
 * up to a quarter of the height. */
static void find_box(scene *s, int kind)
{
    const bool known = s->run_lo[1] <= s->run_hi[1];
    double top = known ? s->run_hi[1] : -INFINITY;
    for (int d = 0; d < 3; d++) {
        s->lo[d] = known && kind == SCENE_FLUID ? s->run_lo[d] : INFINITY;
        s->hi[d] = known && kind == SCENE_FLUID ? s->run_hi[d] : -INFINITY;
    }
    for (int64_t i = 0; i < s->n; i++) {
        const float *x = s->x + 3 * i;
        if (!isfinite(x[0]) || !isfinite(x[1]) || !isfinite(x[2])) continue;
        top = fmax(top, (double)x[1]);
        for (int d = 0; d < 3 && s->kind[i] == kind; d++) {
            s->lo[d] = fmin(s->lo[d], (double)x[d]);
            s->hi[d] = fmax(s->hi[d], (double)x[d]);
        }
    }
    if (top > s->hi[1]) s->hi[1] = fmin(top, s->hi[1] + 0.25 * (s->hi[1] - s->lo[1]));
}

bool mps__scene_end(scene *s)
{
    int kind = -1;
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] == SCENE_WALL) kind = SCENE_WALL;
        if (s->kind[i] != SCENE_FLUID) continue;
        if (kind < 0) kind = SCENE_FLUID;
        if (s->phase[i] >= SCENE_PHASES) s->phase[i] = SCENE_PHASES - 1;
        if (s->phase[i] >= s->phases) s->phases = s->phase[i] + 1;
    }
    if (kind < 0) return false;
    find_box(s, kind);
    return s->lo[0] <= s->hi[0];
}

/* ---- the scale ------------------------------------------------------------------------------- */

/* Twice the height of the centre of mass above the lowest particle, times rho g: the pressure at
 * the depth of a liquid at rest in a box. */
static double pressure_at_rest(const scene *s, double gravity)
{
    double most = 0;
    for (int32_t k = 0; k < s->phases; k++) {
        double sum = 0, lowest = INFINITY;
        int64_t count = 0;
        for (int64_t i = 0; i < s->n; i++) {
            if (s->kind[i] != SCENE_FLUID || s->phase[i] != k) continue;
            sum += (double)s->x[3 * i + 1];
            lowest = fmin(lowest, (double)s->x[3 * i + 1]);
            count++;
        }
        if (count > 0)
            most = fmax(most, 2 * s->density[k] * gravity * (sum / (double)count - lowest));
    }
    return most;
}

/* Pressures below this are rounding: a thousandth of rho (g dp + u^2), with the largest density and
 * speed. */
static double noise_of(const scene *s, double gravity)
{
    double density = 0;
    for (int32_t k = 0; k < s->phases; k++) density = fmax(density, s->density[k]);
    return 1e-3 * density * (gravity * s->dp + s->speed2);
}

bool mps__scene_scale(scene *s, mps_picture_config *config)
{
    page_scale scale = {0};
    const double noise = noise_of(s, config->gravity);
    bool taken = true, rounding = true;
    s->p_lo = config->pressure_lo;
    s->p_hi = config->pressure_hi;
    if (s->p_hi > s->p_lo) return true;
    for (int64_t i = 0; taken && i < s->n; i++) {
        if (s->kind[i] != SCENE_FLUID) continue;
        taken = mps__scale_take(&scale, (double)s->p[i]);
        rounding = rounding && !(fabs((double)s->p[i]) > noise);
    }
    mps__scale_end(&scale, fmax(noise, 1.25 * pressure_at_rest(s, config->gravity)), s->phases > 1);
    s->p_lo = scale.lo;
    s->p_hi = scale.hi;
    if (taken && !rounding) {
        config->pressure_lo = s->p_lo;
        config->pressure_hi = s->p_hi;
    }
    return taken;
}

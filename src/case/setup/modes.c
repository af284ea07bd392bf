/* SPDX-License-Identifier: BSD-3-Clause */
/* Natural periods of the liquid at rest by linear theory, for the tank as requested, so that a
 * motion in units of T1 is the same at every spacing.
 *
 * | tank | method |
 * |---|---|
 * | rectangular, filled to a depth | w^2 = g k tanh(k h), k = n pi/L |
 * | section: outlines in 2-D; prisms with waves across them | potential flow, section.c |
 * | others: L of the free surface as filled, h = volume below it/area | as rectangular; estimate |
 *
 * All without solids in the tank. */
#include "build.h"
#include "section.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* The liquid as filled, phase 0. */
typedef struct liquid {
    /* numbers of particles, of those within a spacing of the highest, of walls there */
    int64_t count, surface, walls;
    double top, lo[3], hi[3]; /* of these walls, which are on the tank */
} liquid;

/* The top layer may have only a fraction of its points: the layer below determines the area. */
static void take_surface(const build *b, liquid *l, const double *x, int32_t kind)
{
    const double below = (l->top - x[1]) / b->dp;
    l->surface += kind == MPS_FLUID && below > 0.5 && below <= 1.5;
    if (kind != MPS_WALL || fabs(below) > 0.75) return;
    for (int d = 0; d < b->dim; d++) {
        l->lo[d] = l->walls ? fmin(l->lo[d], x[d]) : x[d];
        l->hi[d] = l->walls ? fmax(l->hi[d], x[d]) : x[d];
    }
    l->walls++;
}

static bool take(build *b, liquid *l, bool surface)
{
    mps_lease x = {.struct_size = sizeof x}, kind = x, phase = x;
    mps_sim *sim = b->sim;
    bool good = mps__build_try(b, mps_lease_begin(sim, "position", MPS_READ, &x), b->root, "waves");
    good = good &&
           mps__build_try(b, mps_lease_begin(sim, "kind", MPS_READ, &kind), b->root, "waves");
    good = good &&
           mps__build_try(b, mps_lease_begin(sim, "phase", MPS_READ, &phase), b->root, "waves");
    for (int64_t i = 0; good && i < x.count; i++) {
        const double *at = x.data + i * x.stride;
        const bool fluid = kind.integers[i] == MPS_FLUID;
        if (fluid && phase.integers[i] != 0) continue;
        if (surface) take_surface(b, l, at, kind.integers[i]);
        if (surface || !fluid) continue;
        l->top = l->count ? fmax(l->top, at[1]) : at[1];
        l->count++;
    }
    mps_lease_end(b->sim, &phase);
    mps_lease_end(b->sim, &kind);
    mps_lease_end(b->sim, &x);
    return good && l->count > 0;
}

/* Along x unless the motion is transverse; without a motion along the longer side. */
static int32_t wave_axis(const build *b)
{
    const tree_node *given = mps__tree_find(b->root, "motion"),
                    *motion = given ? given : mps__tree_find(b->root, "body");
    if (b->dim == 2) return 0;
    const int32_t forward = motion ? mps__read_choice(b->c, motion, "forward", 0) : 0;
    const bool along_z = forward % 2 == 1; /* x, z, -x, -z */
    const bool lengthwise = mps__tree_find(motion, "surge") || mps__tree_find(motion, "pitch"),
               athwart = mps__tree_find(motion, "sway") || mps__tree_find(motion, "roll");
    if (lengthwise != athwart) return lengthwise != along_z ? 0 : 2;
    const form *t = &b->tank.form;
    return t->hi[0] - t->lo[0] >= t->hi[2] - t->lo[2] ? 0 : 2;
}

static void as_asked(build *b, build_modes *m)
{
    const int32_t a = m->axis;
    m->length = b->tank.size[a];
    m->depth = b->depth;
    snprintf(m->how, sizeof m->how,
             "rectangular tank: length %.4g m and depth %.4g m as requested, w^2 = g k tanh(k h)",
             m->length, m->depth);
}

enum { SECTION_MODES = 3 };

/* Waves of a section by potential flow. */
static bool by_section(build *b, build_modes *m)
{
    const form *t = &b->tank.form;
    form plane = *t;
    double value[SECTION_MODES];
    const bool across = t->kind == FORM_POLYGON && m->axis == (t->sideways ? 2 : 0);
    const bool circle = t->kind == FORM_BALL && b->dim == 2;
    if (b->tank.file || isnan(b->depth) || !(across || circle)) return false;
    plane.dim = 2;
    plane.sideways = false;
    mps__form_box(&plane);
    const mps_status status = mps__section_modes(&plane, plane.lo[1] + b->depth, SECTION_MODES,
                                                 value);
    if (status == MPS_E_NOMEM) b->status = status;
    if (status != MPS_OK) return false;
    for (m->count = 0; m->count < SECTION_MODES; m->count++)
        m->period[m->count] = 2 * acos(-1.0) / sqrt(b->gravity * value[m->count]);
    m->length = plane.hi[0] - plane.lo[0];
    m->depth = b->depth;
    snprintf(m->how, sizeof m->how, "potential flow in the section, filled %.4g m as requested",
             b->depth);
    return true;
}

/* The surface extends from wall to wall. */
static bool as_filled(build *b, build_modes *m)
{
    liquid l = {0};
    if (!take(b, &l, false) || !take(b, &l, true) || l.surface < 1 || l.walls < 2) return false;
    m->length = l.hi[m->axis] - l.lo[m->axis];
    m->depth = (double)l.count * b->dp / (double)l.surface;
    if (!(m->length > 0)) return false;
    snprintf(m->how, sizeof m->how,
             "estimate: length of the free surface %.4g m and mean depth %.4g m as filled, in "
             "w^2 = g k tanh(k h)",
             m->length, m->depth);
    return true;
}

double mps__modes_period(const build *b, double length)
{
    const double pi = acos(-1.0), k = pi / length;
    return 2 * pi / sqrt(b->gravity * k * tanh(k * b->modes.depth));
}

const char *mps__modes_without(const build *b)
{
    static const char *const text[] = {"", "; without the solids", "; without the fluid above",
                                       "; without the solids and the fluid above"};
    return text[(b->solids > 0) + 2 * (b->fluids > 1)];
}

void mps__build_modes(build *b)
{
    build_modes *m = &b->modes;
    if (mps__case_failed(b->c) || b->gravity == 0) return;
    const form *t = &b->tank.form;
    m->axis = wave_axis(b);
    if (by_section(b, m)) {
        mps__case_scale_set(b->c, (read_scale){b->dp, m->period[0], NAN});
        mps__build_blocks(b);
        return;
    }
    if (t->kind == FORM_BOX && !b->tank.file && !isnan(b->depth))
        as_asked(b, m);
    else if (b->status < 0 || !as_filled(b, m))
        return;
    for (m->count = 0; m->count < BUILD_MODES; m->count++)
        m->period[m->count] = mps__modes_period(b, m->length / (m->count + 1));
    mps__case_scale_set(b->c, (read_scale){b->dp, m->period[0], NAN});
    mps__build_blocks(b);
}

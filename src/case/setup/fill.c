/* SPDX-License-Identifier: BSD-3-Clause */
/* Fills the tank, in the order of the case. */
#include "build.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* One entry of `fill`. */
typedef struct filling {
    build *b;
    const tree_node *map; /* its value; a text for `rest` */
    int32_t phase;
    const char *name;
} filling;

static bool done(const filling *f, mps_status status)
{
    return mps__build_try(f->b, status, f->map, f->name);
}

static void log_error(const filling *f, const char *key, const char *text)
{
    const tree_node *at = mps__tree_find(f->map, key);
    mps__case_log(f->b->c, at ? at : f->map, false, "fill.%s.%s: %s", f->name, key, text);
}

/* ---- all, and up to a level ---- */

static void fill_rest(filling *f)
{
    const form *t = &f->b->tank.form;
    done(f, mps_fill_box_add(f->b->sim, f->phase, t->lo, t->hi, NULL, NULL));
}

/* A standing wave in a rectangular tank, released at its highest elevation: each lattice point is
 * displaced by linear theory, which preserves areas; a linear stretch of the columns would compress
 * the water under the trough. The remaining second-order error at the top of a column is
 * distributed over its height. */
static void displace(const double *x, double k, double top, double amplitude, double *out)
{
    const double a = amplitude / sinh(k * top);
    const double surface_x = x[0] - a * cosh(k * top) * sin(k * x[0]),
                 surface_y = top + amplitude * cos(k * x[0]);
    out[0] = x[0] - a * cosh(k * x[1]) * sin(k * x[0]);
    out[1] = x[1] + a * sinh(k * x[1]) * cos(k * x[0]);
    out[1] *= (top + amplitude * cos(k * surface_x)) / surface_y;
}

static void add_displaced(filling *f, double amplitude, double depth)
{
    build *b = f->b;
    double h[2];
    if (!done(f, mps_lattice_get(b->sim, NULL, h))) return;
    const double k = acos(-1.0) / b->tank.built[0];
    const int columns = (int)lround(b->tank.built[0] / h[0]) - 1, rows = (int)lround(depth / h[1]);
    mps_particle_block block;
    mps_particle_block_init(&block, sizeof block);
    block.count = (int64_t)columns * rows;
    block.phase = f->phase;
    double *x = malloc((size_t)(block.count > 0 ? block.count : 1) * 2 * sizeof *x);
    for (int i = 0; x && i < columns; i++)
        for (int j = 0; j < rows; j++) {
            const double at[2] = {(i + 1) * h[0], (j + 1) * h[1]};
            displace(at, k, rows * h[1], amplitude, x + 2 * ((int64_t)i * rows + j));
        }
    block.position = x;
    done(f, x ? mps_particles_add(b->sim, &block, NULL) : MPS_E_NOMEM);
    free(x);
    b->level = rows * h[1];
}

static void fill_standing(filling *f)
{
    build *b = f->b;
    const form *t = &b->tank.form;
    const double amplitude = mps__read_number(b->c, mps__tree_find(f->map, "start"),
                                              "standing_wave", NAN);
    if (mps__case_failed(b->c)) return;
    if (b->dim == 3 || t->kind != FORM_BOX || b->tank.file || t->lo[0] != 0 || t->lo[1] != 0)
        log_error(f, "start",
                  "a standing wave is for rectangular tanks in 2-D that begin at x = y = 0");
    else if (!(fabs(amplitude) < 0.5 * b->depth))
        log_error(f, "start", "the amplitude must be less than half of the depth");
    else
        add_displaced(f, amplitude, b->depth);
}

/* Below gas, in a model as published in the papers, the liquid ends with the last whole layer: in a
 * layer of both fluids one would have to pass through the other. */
static bool in_whole_rows(const filling *f)
{
    return mps__read_flag(f->b->c, f->map, "whole_rows", false) || f->b->several || f->b->paper;
}

static void fill_depth(filling *f)
{
    build *b = f->b;
    const form *t = &b->tank.form;
    b->depth = mps__read_number(b->c, f->map, "depth", NAN);
    const double height = t->hi[1] - t->lo[1], level = fmin(t->lo[1] + b->depth, t->hi[1]);
    const bool whole = in_whole_rows(f);
    if (mps__case_failed(b->c)) return;
    if (b->depth > height + 1e-6 * b->dp) { /* tolerance in lengths, independent of the origin */
        char text[BUILD_TEXT];
        snprintf(text, sizeof text, "%.9g m is more than the tank is high, %.9g m", b->depth,
                 height);
        log_error(f, "depth", text);
        return;
    }
    if (mps__tree_find(mps__tree_find(f->map, "start"), "standing_wave")) {
        fill_standing(f);
        return;
    }
    const double hi[3] = {t->hi[0], level, t->hi[2]};
    double built[6] = {0};
    if (!done(f, whole ? mps_fill_box_add(b->sim, f->phase, t->lo, hi, NULL, built)
                       : mps_fill_level_add(b->sim, f->phase, t->lo, hi, NULL, built)))
        return;
    b->level = built[b->dim + 1];
}

/* ---- shapes of fluid ---- */

static void fill_box(filling *f)
{
    build *b = f->b;
    double x[2][3], lo[3], hi[3];
    if (mps__build_points(b, mps__tree_find(f->map, "box"), NAN, 2, x) != 2) return;
    if (isnan(x[0][2])) x[0][2] = b->tank.form.lo[2];
    if (isnan(x[1][2])) x[1][2] = b->tank.form.hi[2];
    for (int d = 0; d < 3; d++) {
        lo[d] = fmin(x[0][d], x[1][d]);
        hi[d] = fmax(x[0][d], x[1][d]);
    }
    done(f, in_whole_rows(f) ? mps_fill_box_add(b->sim, f->phase, lo, hi, NULL, NULL)
                             : mps_fill_level_add(b->sim, f->phase, lo, hi, NULL, NULL));
}

/* Including points on the surface: on a lattice the volume of a sphere is then closer to the exact
 * one. */
static int in_shape(void *user, const double *x)
{
    const form *s = user;
    return mps__form_inside(s, x) > -1e-9 * s->radius;
}

static void read_ball(filling *f, form *s)
{
    build *b = f->b;
    const tree_node *node = mps__tree_find(f->map, "sphere");
    s->end[0][2] = mps__build_middle(b);
    mps__read_numbers(b->c, node, "centre", 3, s->end[0]);
    s->radius = mps__read_number(b->c, node, "radius", NAN);
}

static void fill_sphere(filling *f)
{
    build *b = f->b;
    form s = {.kind = FORM_BALL, .dim = b->dim};
    read_ball(f, &s);
    if (!mps__case_failed(b->c)) done(f, mps_fill_add(b->sim, f->phase, in_shape, &s, NULL));
}

static void fill_polygon(filling *f)
{
    build *b = f->b;
    form s = {.kind = FORM_POLYGON, .dim = 2};
    mps__build_polygon(b, mps__tree_find(f->map, "polygon"), &s);
    s.radius = b->dp;
    if (!mps__case_failed(b->c)) done(f, mps_fill_add(b->sim, f->phase, in_shape, &s, NULL));
}

/* Below y = level + amplitude sin(2 pi x/length + phase). */
typedef struct wave {
    double level, amplitude, k, phase;
} wave;

static int below_wave(void *user, const double *x)
{
    const wave *w = user;
    return x[1] < w->level + w->amplitude * sin(w->k * x[0] + w->phase);
}

static void fill_wave(filling *f)
{
    build *b = f->b;
    const tree_node *node = mps__tree_find(f->map, "wave");
    wave w = {.level = mps__read_number(b->c, node, "level", NAN),
              .amplitude = mps__read_number(b->c, node, "amplitude", NAN),
              .phase = mps__read_number(b->c, node, "phase", 0)};
    const double length = mps__read_number(b->c, node, "length", NAN);
    w.k = 2 * acos(-1.0) / length;
    if (!mps__case_failed(b->c)) done(f, mps_fill_add(b->sim, f->phase, below_wave, &w, NULL));
}

/* ---- velocities ---- */

/* The second mode of a droplet in another fluid: r = R (1 + share sin(w t) cos(2 phi)) with w^2 = 6
 * sigma/((rho_i + rho_o) R^3), at t = 0. Its potential flow: rate (x, -y) inside, equal at the
 * surface and decaying outside. */
typedef struct drop {
    double x[2], radius, rate;
} drop;

static void drop_velocity(const drop *o, const double *x, double *u)
{
    const double a = x[0] - o->x[0], b = x[1] - o->x[1], r2 = a * a + b * b,
                 inside = o->radius * o->radius;
    const double outer = o->rate * pow(inside / r2, 2) / r2;
    u[0] = r2 <= inside ? o->rate * a : outer * a * (a * a - 3 * b * b);
    u[1] = r2 <= inside ? -o->rate * b : outer * b * (3 * a * a - b * b);
}

static bool read_drop(filling *f, drop *o)
{
    build *b = f->b;
    form s = {.kind = FORM_BALL, .dim = b->dim};
    double sigma = 0;
    const double share = mps__read_number(b->c, mps__tree_find(f->map, "start"), "oscillation",
                                          NAN);
    if (b->dim == 3 || b->fluids != 2 || !mps__tree_find(f->map, "sphere")) {
        log_error(f, "start", "an oscillation is for 'sphere' in 2-D and two fluids");
        return false;
    }
    read_ball(f, &s);
    if (mps_tension_get(b->sim, 0, 1, &sigma) != MPS_OK &&
        !done(f, mps_model_get(b->sim, "tension", "sigma", &sigma)))
        return false;
    *o = (drop){{s.end[0][0], s.end[0][1]}, s.radius, 0};
    o->rate = share *
              sqrt(6 * sigma / ((b->fluid[0].density + b->fluid[1].density) * pow(s.radius, 3)));
    return true;
}

/* Set the velocity of all particles whose id is at least `first`: those of this fill; an
 * oscillation moves all fluid.
 * @param u  the velocity, or NULL: that of `o` */
static void set_velocity(filling *f, int64_t first, const double *u, const drop *o)
{
    build *b = f->b;
    mps_lease id = {.struct_size = sizeof id}, kind = id, x = id, velocity = id;
    if (!done(f, mps_lease_begin(b->sim, "id", MPS_READ, &id))) return;
    bool good = done(f, mps_lease_begin(b->sim, "kind", MPS_READ, &kind));
    good = good && done(f, mps_lease_begin(b->sim, "position", MPS_READ, &x));
    good = good && done(f, mps_lease_begin(b->sim, "velocity", MPS_WRITE, &velocity));
    for (int64_t i = 0; good && i < velocity.count; i++) {
        double *out = velocity.data + i * velocity.stride;
        if (kind.integers[i] != MPS_FLUID || id.ids[i] < first) continue;
        if (u)
            for (int d = 0; d < b->dim; d++) out[d] = u[d];
        else
            drop_velocity(o, x.data + i * x.stride, out);
    }
    mps_lease_end(b->sim, &velocity);
    mps_lease_end(b->sim, &x);
    mps_lease_end(b->sim, &kind);
    mps_lease_end(b->sim, &id);
}

static void start_moving(filling *f, int64_t first)
{
    build *b = f->b;
    double u[3] = {0};
    if (mps__read_numbers(b->c, mps__tree_find(f->map, "start"), "velocity", 3, u) > 0 &&
        !mps__case_failed(b->c))
        set_velocity(f, first, u, NULL);
}

/* Called after all fluids are filled. */
static void start_drop(build *b, const tree_node *at)
{
    filling f = {b, at, 0, at->key};
    drop o;
    if (mps__tree_find(mps__tree_find(at, "start"), "oscillation") && read_drop(&f, &o))
        set_velocity(&f, 0, NULL, &o);
}

/* Ids are assigned in ascending order. */
static int64_t next_id(build *b)
{
    int64_t next = 0;
    mps_lease id = {.struct_size = sizeof id};
    if (mps_lease_begin(b->sim, "id", MPS_READ, &id) != MPS_OK) return 0;
    for (int64_t i = 0; i < id.count; i++)
        if (id.ids[i] >= next) next = id.ids[i] + 1;
    mps_lease_end(b->sim, &id);
    return next;
}

/* ---- all ---- */

static void fill_one(build *b, const tree_node *at)
{
    static const char *const kind[] = {"depth", "box", "sphere", "polygon", "wave"};
    static void (*const fill[])(filling *) = {fill_depth, fill_box, fill_sphere, fill_polygon,
                                              fill_wave};
    filling f = {b, at, mps__build_phase(b, at, at->key), at->key};
    mps__read_all(at->kind == TREE_TEXT ? at : NULL);
    if (at->kind == TREE_TEXT) { /* the word `rest`, checked by the table of keys */
        fill_rest(&f);
        return;
    }
    if (mps__case_failed(b->c)) return;
    const bool moving = mps__tree_find(mps__tree_find(at, "start"), "velocity") != NULL;
    const int64_t first = moving ? next_id(b) : 0;
    fill[mps__build_kind(at, kind, 5)](&f);
    if (moving && !mps__case_failed(b->c)) start_moving(&f, first);
}

/* Particles beyond the corners of `domain` are removed in the first step. */
static void check_domain(build *b)
{
    double x[2][3], least[3], most[3], place[3] = {0, 0, 0};
    const tree_node *node = mps__tree_find(b->root, "domain");
    mps_lease at = {.struct_size = sizeof at}, kind = at;
    int64_t fluid = 0, beyond = 0;
    if (!node || mps__build_points(b, node, 0, 2, x) != 2) return;
    for (int d = 0; d < 3; d++) {
        least[d] = fmin(x[0][d], x[1][d]);
        most[d] = fmax(x[0][d], x[1][d]);
    }
    bool good = mps__build_try(b, mps_lease_begin(b->sim, "position", MPS_READ, &at), node, "fill");
    good = good &&
           mps__build_try(b, mps_lease_begin(b->sim, "kind", MPS_READ, &kind), node, "fill");
    for (int64_t i = 0; good && i < at.count; i++) {
        const double *X = at.data + i * at.stride;
        bool out = false;
        if (kind.integers[i] != MPS_FLUID) continue;
        fluid++;
        for (int d = 0; d < b->dim; d++) out = out || X[d] < least[d] || X[d] > most[d];
        if (out && beyond++ == 0) memcpy(place, X, (size_t)b->dim * sizeof *X);
    }
    mps_lease_end(b->sim, &kind);
    mps_lease_end(b->sim, &at);
    if (beyond == 0) return;
    mps__case_log(b->c, node, beyond < fluid,
                  "domain: %lld of %lld particles of the fill are outside of it, e.g. at (%g, %g, "
                  "%g) m, and are lost in the first step; enlarge the domain, or leave it out",
                  (long long)beyond, (long long)fluid, place[0], place[1], place[2]);
}

void mps__build_fills(build *b)
{
    const tree_node *fill = mps__tree_find(b->root, "fill");
    const form *t = &b->tank.form;
    if (mps__case_failed(b->c)) return;
    mps__case_scale_set(b->c, (read_scale){b->dp, NAN, t->hi[1] - t->lo[1]});
    /* the reader guarantees that each item is a map of one fluid */
    for (const tree_node *item = fill->first; item && !mps__case_failed(b->c); item = item->next)
        fill_one(b, item->first);
    for (const tree_node *item = fill->first; item && !mps__case_failed(b->c); item = item->next)
        if (item->first->kind == TREE_MAP) start_drop(b, item->first);
    mps__case_scale_set(b->c, (read_scale){b->dp, NAN, NAN});
    if (!mps__case_failed(b->c)) check_domain(b);
}

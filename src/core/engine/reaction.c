/* SPDX-License-Identifier: BSD-3-Clause */
/* Forces of solids on the fluid reported by verbs: friction, baffles, screens. */
#include "reaction.h"
#include "runner.h"
#include "loop.h"
#include "rotation.h"
#include <math.h>
#include <mps/reaction.h>

/* `index` of a particle: 1 + index in mps__reactions; 0: not counted */
typedef struct report {
    const int32_t *kind;
    const uint8_t *ghost; /* NULL: none */
    const double *x, *rho, *acceleration;
    int32_t *index; /* NULL: all particles belong to `wanted` */
    int32_t wanted;
    double volume; /* of a particle */
    double centre[3];
} report;

/* Force and moment of a fluid particle. */
MPS_ROW void add_row(const int dim, const report *k, int64_t i, double *values)
{
    double r[3] = {0};
    if (k->kind[i] != MPS_FLUID || !mps__owns(k->ghost, i)) return;
    if (k->index && k->index[i] != k->wanted + 1) return;
    const double mass = k->rho[i] * k->volume;
    for (int d = 0; d < dim; d++) {
        values[d] = mass * k->acceleration[i * dim + d];
        r[d] = k->x[i * dim + d] - k->centre[d];
    }
    mps__cross(r, values, values + 3);
}
MPS__VALUES(add_rows, add_row, report, 6, 0)

static int32_t line_of(const mps_stage *s, const mps__runner *h)
{
    if (h->line != MPS__LINE_OF_HOOK) return h->line;
    return s->hook == MPS_FORCE ? MPS__LINE_VISCOUS : MPS__LINE_COLLISION;
}

static const char not_finite[] =
    "the acceleration that a solid gives the fluid, by mps_stage_reaction(), is not finite";

/* Add the particles of one index. @return non-zero: not finite */
static int add_index(mps_stage *s, mps__runner *h, report *k, int32_t index)
{
    mps_exact sums[6] = {{{0}, 0, 0}};
    mps_exact(*all)[6] = h->reactions.sum;
    double none[1];
    const int32_t line = line_of(s, h);
    k->wanted = index;
    h->reactions.on_host = true;
    mps__values_run(h->parallel, &add_rows, s->view->dim, s->view->n, k, sums, none);
    for (int d = 0; d < 6; d++) {
        if (!isfinite(mps_exact_value(&sums[d]))) return mps_stage_fail(s, "%s", not_finite);
        mps_exact_join(&all[index][d], &sums[d]);
        mps_exact_join(&all[line][d], &sums[d]);
    }
    return 0;
}

/* ---- on a device ---- */

enum { WIDTH = 6 };

typedef struct joining {
    mps_exact *sum, *line;     /* of the first index; NULL: no line */
    const mps_exact *reported; /* of the first index */
    int32_t places;
} joining;

/* Row i is component i of the sums; rows after the last index belong to the line, which sums over
 * all indices. */
MPS_ROW void join_row(const joining *f, int64_t i)
{
    const int64_t number = i % WIDTH;
    if (i < (int64_t)f->places * WIDTH)
        mps_exact_join(&f->sum[i], &f->reported[i]);
    else
        for (int32_t p = 0; p < f->places; p++)
            mps_exact_join(&f->line[number], &f->reported[p * WIDTH + number]);
}
MPS__LOOP_ANY(join_rows, join_row, joining)

/* Maximum: 1 if a sum is not finite. */
MPS_ROW void poison_row(const joining *f, int64_t i, double *most)
{
    if (!isfinite(mps_exact_value(&f->reported[i]))) *most = 1;
}
MPS__VALUES_ANY(poisons, poison_row, joining, 0, 1)

static void join_device(mps__runner *h, const joining *k)
{
    mps__loop_run(&h->memory.device.parallel, &join_rows, MPS__ANY_DIM,
                  WIDTH * (k->places + (k->line != NULL)), k);
}

/* Clear the sums at the first report of a step. */
static mps__results *begin_device(mps__runner *h)
{
    mps__results *r = mps__memory_results(&h->memory);
    if (!h->reactions.on_device)
        mps__device_clear(&h->memory.device, r->reaction, sizeof r->reaction);
    h->reactions.on_device = true;
    return r;
}

static void take_poison(void *wrong, const double *most)
{
    if (*most > 0) *(bool *)wrong = true;
}

/* Add the sums of all indices, since it is unknown which occur. Deferred. */
static int add_device(mps_stage *s, mps__runner *h, report *k)
{
    mps__device *d = &h->memory.device;
    mps__results *r = begin_device(h);
    const joining f = {r->reaction[MPS__REACTION_WHOLE], r->reaction[line_of(s, h)], r->reported[0],
                       1 + h->particles->parts};
    for (int32_t p = 0; p < f.places; p++) {
        k->wanted = MPS__REACTION_WHOLE + p;
        mps__values_reduce_async(d, &add_rows, s->view->dim, s->view->n, k, r->reported[p]);
    }
    join_device(h, &f);
    mps__values_reduce_async(
        d, &poisons, MPS__ANY_DIM, WIDTH * f.places, &f,
        mps__deferred_maxima(h, 1, (mps__then){take_poison, &h->wrong[h->model - h->models->on]}));
    return 0;
}

void mps__runner_reactions_deferred(mps__runner *h, mps__then then)
{
    const int32_t places = MPS__REACTION_WHOLE + 1 + h->particles->parts;
    const size_t bytes = (size_t)places * sizeof h->reactions.sum[0];
    mps__results *r = mps__memory_results(&h->memory);
    if (!h->reactions.on_device) {
        mps__runner_defer(h, then);
        return;
    }
    if (h->reactions.on_host) { /* a verb on the host also reported */
        mps__device_upload(&h->memory.device, r->reported, h->reactions.sum, bytes);
        join_device(h, &(joining){r->reaction[0], NULL, r->reported[0], places});
    }
    mps__device_copy(&h->memory.device, mps__deferred_sums(h, WIDTH * places, then), r->reaction,
                     bytes);
}

mps_status mps__runner_check_reactions(const mps__runner *h, double t)
{
    const mps__models *m = h->models;
    for (int32_t k = 0; k < m->active; k++)
        if (h->wrong[k])
            return mps__fail(h->context, MPS_E_PLUGIN, "model '%s' at t = %.9g s: %s",
                             m->on[k].ops->name, t, not_finite);
    return MPS_OK;
}

/* Solid nearest to a fluid particle; at equal distance the one with the least id; -1: none. */
MPS_ROW int64_t nearest_solid(const int dim, const mps_view *v, int64_t i)
{
    const mps_stencil *t = &v->far;
    double least = INFINITY;
    int64_t nearest = -1;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        double r2 = 0;
        if (mps_is_fluid(v, j)) continue;
        for (int d = 0; d < dim; d++)
            r2 += (v->x[j * dim + d] - v->x[i * dim + d]) * (v->x[j * dim + d] - v->x[i * dim + d]);
        if (r2 > least || (r2 == least && v->id[j] > v->id[nearest])) continue;
        least = r2;
        nearest = j;
    }
    return nearest;
}

typedef struct place_fields {
    const double *acceleration;
    const int32_t *part;
    int32_t *index;
} place_fields;

MPS_ROW void place_row(const int dim, const mps_view *v, const place_fields *f, int64_t i)
{
    const double *a = f->acceleration + i * dim;
    if (!mps_is_fluid(v, i) || (a[0] == 0 && a[1] == 0 && (dim == 2 || a[2] == 0))) return;
    const int64_t solid = nearest_solid(dim, v, i);
    f->index[i] = MPS__REACTION_WHOLE + 2 + (solid < 0 ? -1 : f->part[solid]);
}
MPS_ROWS(place_rows, place_row, place_fields)

/* Each fluid particle acts on the part of its nearest solid. */
static int add_beside(mps_stage *s, mps__runner *h, report *k)
{
    bool used[MPS__REACTIONS + 1] = {false};
    k->index = mps_stage_scratch_integers(s, s->view->n);
    if (!k->index) return 1;
    mps_stage_rows(
        s, &place_rows,
        &(place_fields){k->acceleration, mps__memory_read(&h->memory, MPS__FIELD_PART), k->index});
    if (h->memory.space == MPS__ON_DEVICE) return add_device(s, h, k);
    for (int64_t i = 0; i < s->view->n; i++) used[k->index[i]] = true;
    int failed = 0;
    for (int32_t index = MPS__REACTION_WHOLE; index < MPS__REACTIONS && !failed; index++)
        if (used[index + 1]) failed = add_index(s, h, k, index);
    return failed;
}

int mps_stage_reaction(mps_stage *s, const char *part, const double *acceleration)
{
    mps__runner *h = s->host;
    const mps_view *v = s->view;
    report k = {.kind = v->kind,
                .ghost = mps__ghosts_seen(h->ghosts, mps__device_of(h->parallel)),
                .x = v->x,
                .rho = mps__memory_read(&h->memory, MPS__FIELD_DENSITY),
                .acceleration = acceleration,
                .volume = v->dim == 2 ? v->dp * v->dp : v->dp * v->dp * v->dp};
    if (s->hook != MPS_FORCE && s->hook != MPS_VELOCITY)
        return mps_stage_fail(s,
                              "mps_stage_reaction() is for verbs of MPS_FORCE and MPS_VELOCITY, "
                              "this one is of hook '%s'",
                              mps__hook_name(s->hook));
    if (!acceleration) return mps_stage_fail(s, "mps_stage_reaction(): the acceleration is NULL");
    const int32_t number = mps__part_number(h->particles, part, false);
    if (part && number < 0)
        return mps_stage_fail(s,
                              "mps_stage_reaction(): no part is named '%.40s': name one of the "
                              "tank, or list it in mps_model_ops.parts",
                              part);
    h->reactions.any = true;
    for (int d = 0; d < 3; d++) k.centre[d] = v->tank.centre[d] + v->tank.shift[d];
    return part ? add_index(s, h, &k, MPS__REACTION_WHOLE + 1 + number) : add_beside(s, h, &k);
}

int mps_stage_kinetic(mps_stage *s, double kinetic)
{
    mps__runner *h = s->host;
    const bool before = s->hook == MPS_FORCE;
    if (!before && s->hook != MPS_VELOCITY)
        return mps_stage_fail(s,
                              "mps_stage_kinetic() is for verbs of MPS_FORCE and MPS_VELOCITY, "
                              "this one is of hook '%s'",
                              mps__hook_name(s->hook));
    if (!(kinetic >= 0 && isfinite(kinetic)))
        return mps_stage_fail(s, "mps_stage_kinetic(): %g J; must be finite and >= 0", kinetic);
    *(before ? &h->reactions.kinetic_before[line_of(s, h)]
             : &h->reactions.kinetic[line_of(s, h)]) += kinetic;
    return 0;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Slots between facing walls without a lattice point between them: liquid cannot enter; the log
 * gives their positions. */
#include "buckets.h"
#include "angles.h"
#include "lattice_plan.h"
#include "solid.h"
#include <math.h>
#include <string.h>

/* Walls nearer than `touching` [dp] are in contact. Two walls face each other if the cosine between
 * their normals is below `facing`, and if they are at most `beside` [dp] apart along the slot. A
 * free lattice point is at least `clear` [dp] from both. */
static const double touching = 0.3, facing = -0.9, beside = 0.75, clear = 0.5 * (1 - 1e-6);

enum { SLOTS = 8 };

/* The narrowest position between two parts. */
typedef struct slot {
    int32_t part[2]; /* the smaller first */
    double width, at[3];
} slot;

typedef struct search {
    mps_sim *sim;
    mps__buckets walls;
    int64_t *particle; /* of each point of `walls` */
    double normal[3];  /* of the wall at which the search starts */
    double width;      /* distance to the nearest facing wall [m] */
    int64_t opposite;  /* that wall's particle, -1: none */
    slot slot[SLOTS];
    int count;
    bool more;
} search;

static void wall_place(const mps__particles *s, int64_t i, double X[3])
{
    X[2] = 0;
    memcpy(X, s->ref + i * s->dim, (size_t)s->dim * sizeof *X);
}

/* Unit normal into the liquid; false if the faces of a wall cancel. */
static bool wall_normal(const search *q, int64_t i, double n[3])
{
    static const double least = 1e-9; /* [dp^(dim-1)] edges of plates have 1e-6 */
    const mps__particles *s = &q->sim->world.particles;
    const double *a = s->area + i * s->dim, size = sqrt(mps__dot(a, a, s->dim));
    if (!(size > least * mps_pow(q->sim->world.setup.dp, s->dim - 1))) return false;
    n[2] = 0;
    for (int d = 0; d < s->dim; d++) n[d] = a[d] / size;
    return true;
}

static void keep_facing(void *user, int64_t point, const double d[3], double r2)
{
    search *q = user;
    const double dp = q->sim->world.setup.dp, across = mps__dot(d, q->normal, 3);
    double n[3];
    if (across < touching * dp || r2 - across * across > beside * beside * dp * dp) return;
    if (!wall_normal(q, q->particle[point], n) || mps__dot(n, q->normal, 3) > facing) return;
    if (across > q->width || (across == q->width && q->particle[point] > q->opposite)) return;
    q->width = across;
    q->opposite = q->particle[point];
}

/* Whether liquid fits at a lattice point between the wall at X and the facing one. */
static bool fits(const search *q, const double X[3], const double P[3])
{
    const double dp = q->sim->world.setup.dp;
    double d[3], above, r2;
    for (int a = 0; a < 3; a++) d[a] = P[a] - X[a];
    above = mps__dot(d, q->normal, 3);
    r2 = mps__dot(d, d, 3);
    return above >= clear * dp && q->width - above >= clear * dp && r2 - above * above <= dp * dp &&
           !mps__plate_covers(q->sim, P) && (q->sim->solids == 0 || !mps__solid_covers(q->sim, P));
}

static bool has_space(const search *q, const double X[3])
{
    enum { WIDE = 4 };
    const mps_sim *sim = q->sim;
    const int dim = sim->world.setup.dim;
    for (int n = 0; n < (dim == 2 ? WIDE * WIDE : WIDE * WIDE * WIDE); n++) {
        const int64_t step[3] = {n % WIDE, n / WIDE % WIDE, n / (WIDE * WIDE)};
        double P[3] = {0, 0, 0};
        for (int d = 0; d < dim; d++) {
            const double h = sim->lattice_h[d], middle = X[d] + 0.5 * q->width * q->normal[d];
            P[d] = sim->lattice_lo[d] +
                   (floor((middle - sim->lattice_lo[d]) / h) - 1 + (double)step[d]) * h;
        }
        if (fits(q, X, P)) return true;
    }
    return false;
}

static void keep_slot(search *q, int64_t i, const double X[3])
{
    const int32_t *part = q->sim->world.particles.part;
    const int32_t a = part[i] < part[q->opposite] ? part[i] : part[q->opposite],
                  b = part[i] < part[q->opposite] ? part[q->opposite] : part[i];
    int k = 0;
    while (k < q->count && (q->slot[k].part[0] != a || q->slot[k].part[1] != b)) k++;
    q->more = q->more || k == SLOTS;
    if (k == SLOTS || (k < q->count && q->slot[k].width <= q->width * (1 + 1e-6))) return;
    q->slot[k] = (slot){.part = {a, b}, .width = q->width};
    for (int d = 0; d < 3; d++) q->slot[k].at[d] = X[d] + 0.5 * q->width * q->normal[d];
    if (k == q->count) q->count++;
}

/* Walls in the last tank or near the solids. */
static mps_status collect(search *q)
{
    const mps_sim *sim = q->sim;
    const mps__particles *s = &sim->world.particles;
    const double dp = sim->world.setup.dp;
    double lo[3] = {0, 0, 0}, hi[3] = {0, 0, 0}, X[3];
    for (int d = 0; d < s->dim; d++) {
        lo[d] = sim->lattice_lo[d] - dp;
        hi[d] = sim->lattice_lo[d] + (double)sim->lattice_cells[d] * sim->lattice_h[d] + dp;
    }
    MPS__TRY(mps__buckets_init(&q->walls, &q->sim->context, s->dim, lo, hi, 2 * dp));
    q->particle = mps__alloc(&q->sim->context, s->n, sizeof *q->particle);
    if (!q->particle) return MPS_E_NOMEM;
    for (int64_t i = 0; i < s->n; i++) {
        bool in = s->kind[i] == MPS_WALL;
        wall_place(s, i, X);
        for (int d = 0; d < s->dim; d++) in = in && X[d] > lo[d] && X[d] < hi[d];
        if (!in) continue;
        q->particle[q->walls.count] = i;
        MPS__TRY(mps__buckets_add(&q->walls, X));
    }
    return MPS_OK;
}

static mps_status find(search *q)
{
    const double most = 2 * (1 - 1e-6) * q->sim->world.setup.dp, reach = mps__hypot(most, most);
    MPS__TRY(collect(q));
    for (int64_t k = 0; k < q->walls.count; k++) {
        const int64_t i = q->particle[k];
        const double *X = q->walls.x + 3 * k;
        if (!wall_normal(q, i, q->normal)) continue;
        q->width = most;
        q->opposite = -1;
        mps__buckets_visit(&q->walls, X, reach, keep_facing, q);
        if (q->opposite >= 0 && !has_space(q, X)) keep_slot(q, i, X);
    }
    return MPS_OK;
}

static void report(const search *q)
{
    const mps__world *w = &q->sim->world;
    for (int k = 0; k < q->count; k++) {
        const slot *s = &q->slot[k];
        mps__log(w->context, MPS_LOG_WARNING,
                 "the slot between \"%s\" and \"%s\" is %g m wide, %.2g dp, at (%g, %g, %g) m: no "
                 "particle fits in, it is closed for liquid; dp of at most %g m opens it",
                 w->particles.part_name[s->part[0]], w->particles.part_name[s->part[1]], s->width,
                 s->width / w->setup.dp, s->at[0], s->at[1], s->at[2], 0.5 * s->width);
    }
    if (q->more)
        mps__log(w->context, MPS_LOG_WARNING,
                 "slots between further parts are closed for liquid too: the first %d pairs of "
                 "parts were named",
                 SLOTS);
}

mps_status mps__slots_log(mps_sim *sim)
{
    search q = {.sim = sim};
    if (sim->slots_logged == sim->world.particles.solids) return MPS_OK;
    const mps_status status = find(&q);
    if (status == MPS_OK) {
        sim->slots_logged = sim->world.particles.solids;
        report(&q);
    }
    mps__buckets_free(&q.walls);
    mps__free(&sim->context, q.particle);
    return status;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* auxgrid: conductances between cells for more than one density. A matrix entry k_ij is a wire from particle i to j; where it
 * crosses from cell to cell along an axis it adds k_ij |x_j - x_i| / size, both along that axis. For a linear pressure that is
 * the energy of the wires, and between two densities it is what lets the pressure through.
 *
 * Each term is rounded to an integer and the integers are added: their sum is exact, so it depends neither on the order of the
 * pairs nor on how many threads share them. */
#include "auxgrid.h"
#include "kernels.h"
#include <math.h>
#include <string.h>

enum {
    MAX_STEPS = 12, /* cells that a wire may cross */
    CHUNKS = 8      /* parts of the rows, each with sums of its own */
};

/* The integer of a conductance of 1, about that of a pair of the lightest fluid. A pair of a fluid 1000 times as dense conducts
 * 0.001, with an error of 2e-9 of that: less than the error of a float. A face adds up some hundred pairs. */
static const double per_unit = 0x1p38;
/* From here on a sum counts as infinite, which mps__grid_factorise() refuses. */
#define MOST (UINT64_C(1) << 58)

typedef struct wiring {
    const mps__grid *g;
    const mps__grid_level *l;
    const mps_ppe_problem *problem;
    const int32_t *
        place; /* NULL, or [columns] where the numbers of rows are not in the order of the particles */
    int32_t chunks;
    uint64_t
        *faces; /* [chunks][cells * dim] conductance of the face above a cell along each axis */
} wiring;

typedef struct wire {
    double x[3], d[3]; /* start and difference in cells */
    double k;
    int left[3]; /* steps still to go along each axis */
    int steps;
    int64_t face[MAX_STEPS]; /* crossed so far */
} wire;

/* Next axis to step along: the plane that the wire meets first, unless there is no cell behind it. -1: none */
static int next_axis(const mps__grid *g, const mps__grid_level *l, const wire *w, int32_t cell)
{
    int best = -1;
    double first = INFINITY;
    for (int a = 0; a < g->dim; a++) {
        int up = w->d[a] > 0;
        if (w->left[a] == 0 || l->next[(int64_t)cell * 2 * g->dim + 2 * a + up] == cell) continue;
        double plane = (double)(mps__grid_coordinate(l->key[cell], a) + up);
        double t = (plane - w->x[a]) / w->d[a];
        if (t < first) {
            first = t;
            best = a;
        }
    }
    return best;
}

/* Cells from one to the next along the wire. False: they are too far apart or not joined. */
static bool follow(const mps__grid *g, const mps__grid_level *l, wire *w, int32_t from, int32_t to)
{
    int all = 0;
    for (int a = 0; a < g->dim; a++) {
        int64_t left = mps__grid_coordinate(l->key[to], a) - mps__grid_coordinate(l->key[from], a);
        if (left > MAX_STEPS || left < -MAX_STEPS) return false;
        w->left[a] = (int)(left < 0 ? -left : left);
        all += w->left[a];
    }
    if (all > MAX_STEPS) return false;
    for (w->steps = 0; w->steps < all; w->steps++) {
        int a = next_axis(g, l, w, from);
        if (a < 0) return false;
        w->left[a]--;
        int up = w->d[a] > 0;
        int32_t to_next = l->next[(int64_t)from * 2 * g->dim + 2 * a + up];
        w->face[w->steps] = (int64_t)(up ? from : to_next) * g->dim + a;
        from = to_next;
    }
    return true;
}

static inline void add(uint64_t *face, double conductance)
{
    const double whole = conductance * per_unit;
    if (*face < MOST) *face += whole < (double)MOST ? (uint64_t)(int64_t)(whole + 0.5) : MOST;
}

static void add_wire(const mps__grid *g, const mps__grid_level *l, wire *w, const int32_t home[2],
                     uint64_t *faces)
{
    if (!follow(g, l, w, home[0], home[1])) return;
    for (int s = 0; s < w->steps; s++)
        add(&faces[w->face[s]], w->k * fabs(w->d[w->face[s] % g->dim]));
}

/* The same for cells with a face in common, as most are. False: they have none. */
static bool add_short_wire(const mps__grid *g, const mps__grid_level *l, const wire *w,
                           const int32_t home[2], uint64_t *faces)
{
    int64_t step = l->key[home[1]] - l->key[home[0]];
    for (int a = 0; a < g->dim; a++) {
        int64_t one = (int64_t)1 << (a * MPS__GRID_BITS);
        if (step != one && step != -one) continue;
        add(&faces[(int64_t)home[step < 0] * g->dim + a], w->k * fabs(w->d[a]));
        return true;
    }
    return false;
}

static void add_row(const wiring *y, int64_t i, uint64_t *faces)
{
    const mps_ppe_problem *problem = y->problem;
    const mps__grid *g = y->g;
    const mps__grid_level *l = y->l;
    wire w;
    for (int a = 0; a < g->dim; a++) w.x[a] = mps__grid_position(g, problem, i, a);
    for (int64_t k = problem->row[i]; k < problem->row[i + 1]; k++) {
        int32_t j = problem->col[k], home[2] = {l->home[i], l->home[j]};
        const bool before = y->place ? y->place[j] <= y->place[i] : j <= i;
        if (before || home[0] == home[1] || !(problem->val[k] < 0)) continue;
        w.k = -(double)problem->val[k] * g->unit;
        for (int a = 0; a < g->dim; a++) w.d[a] = mps__grid_position(g, problem, j, a) - w.x[a];
        if (!add_short_wire(g, l, &w, home, faces)) add_wire(g, l, &w, home, faces);
    }
}

static void add_chunk(void *argument, int32_t chunk)
{
    const wiring *y = argument;
    const int64_t n = y->problem->n, count = y->l->cells * y->g->dim;
    uint64_t *faces = y->faces + chunk * count;
    memset(faces, 0, (size_t)count * sizeof *faces);
    for (int64_t i = n * chunk / y->chunks; i < n * (chunk + 1) / y->chunks; i++)
        add_row(y, i, faces);
}

/* Links from both sides of the faces above cells begin..end-1. */
static void set_links(void *argument, int64_t begin, int64_t end)
{
    const wiring *y = argument;
    const int dim = y->g->dim;
    const int64_t count = y->l->cells * dim;
    for (int64_t f = begin * dim; f < end * dim; f++) {
        const int64_t cell = f / dim, link = 2 * f + 1, other = y->l->next[link];
        uint64_t sum = 0;
        for (int32_t c = 0; c < y->chunks; c++) sum += y->faces[c * count + f];
        if (other == cell) continue;
        y->l->link[link] = sum < MOST ? (float)((double)sum / per_unit) : INFINITY;
        y->l->link[other * 2 * dim + (link - 1) % (2 * dim)] = y->l->link[link];
    }
}

static void add_faces(void *into, const void *from)
{
    uint64_t a, b;
    memcpy(&a, into, sizeof a);
    memcpy(&b, from, sizeof b);
    a = a + b < MOST ? a + b : MOST;
    memcpy(into, &a, sizeof a);
}

/* Sums of all chunks into the first, then over the ranks. A pair of two ranks is a wire of the particle that comes first. */
static int add_ranks(wiring *y)
{
    const int64_t count = y->l->cells * y->g->dim;
    for (int64_t f = 0; f < count; f++) {
        uint64_t sum = 0;
        for (int32_t c = 0; c < y->chunks; c++) sum += y->faces[c * count + f];
        y->faces[f] = sum < MOST ? sum : MOST;
    }
    y->chunks = 1;
    return mps_ppe_reduce(y->problem, (int32_t)count, sizeof *y->faces, y->faces, add_faces)
               ? MPS_PPE_BREAKDOWN
               : 0;
}

int mps__grid_wires(mps__grid *g, const mps_ppe_problem *given)
{
    const mps__grid_level *l = &g->level[0];
    mps_ppe_problem whole = *given;
    if (g->source && g->source->show(g->source->owner, true, &whole)) return MPS_PPE_NOMEM;
    const mps_ppe_problem *problem = &whole;
    const mps_parallel *team = mps__team(problem->parallel, problem->n);
    const int32_t chunks = team && team->threads > 1 ? CHUNKS : 1;
    if (!mps__grid_reserve_parts(g, (size_t)(chunks * l->cells * g->dim) * sizeof(uint64_t)))
        return MPS_PPE_NOMEM;
    wiring y = {.g = g, .l = l, .problem = problem, .chunks = chunks, .faces = g->parts};
    if (mps__grid_many(g)) y.place = g->ranks.place;
    mps_parallel_run(team, chunks, add_chunk, &y);
    const int reason = mps__grid_many(g) ? add_ranks(&y) : 0;
    if (reason) return reason;
    mps_parallel_rows(team, l->cells, set_links, &y);
    return 0;
}

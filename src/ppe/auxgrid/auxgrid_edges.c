/* SPDX-License-Identifier: BSD-3-Clause */
/* auxgrid: conductances between cells for several densities. A matrix entry k_ij is an edge from
 * particle i to j. Where the edge crosses a cell face along an axis, it adds k_ij |x_j - x_i| /
 * size to that face, both along that axis. For a linear pressure this preserves the energy of the
 * edges; between two densities it gives the coupling that the pressure needs.
 *
 * Each term is rounded to an integer and the integers are added: the sum is exact, so that it
 * depends neither on the order of the pairs nor on the number of threads. */
#include "auxgrid.h"
#include "rows.h"
#include <math.h>
#include <string.h>

enum {
    MAX_STEPS = 12, /* faces that an edge may cross */
    CHUNKS = 8      /* chunks of the rows, each with its own sums */
};

/* The integer that represents a conductance of 1, about that of a pair of the lightest fluid. A
 * pair of a fluid 1000 times as dense conducts 0.001, with an error of 2e-9 of that: less than the
 * rounding of a float. A face sums some hundred pairs. */
static const double per_unit = 0x1p38;
/* From this value on a sum counts as infinite, which mps__grid_factorise() refuses. A single term
 * that is too large adds this value. */
#define MOST     (UINT64_C(1) << 58)
#define INFINITE (UINT64_C(1) << 63)
/* far above any pair's conductance; hundreds of them stay below MOST */
static const double largest_term = 0x1p52;

typedef struct edge_fields {
    const int64_t *row, *key;
    const int32_t *col, *home, *next;
    const float *val;
    /* NULL, or [columns] where rows are not numbered in the order of the particles */
    const int32_t *place;
    mps__grid_positions at;
    double unit;
    int64_t n, count; /* number of rows; of faces */
    int32_t chunks;
    bool together; /* rows of different threads add to the same faces */
    /* [chunks][cells * dim] conductance of the face above a cell along each axis */
    uint64_t *faces;
    float *link;
} edge_fields;

typedef struct edge {
    double x[3], d[3]; /* start and difference in cells */
    double k;
    int left[3]; /* remaining steps along each axis */
    int steps;
    int64_t face[MAX_STEPS]; /* crossed so far */
} edge;

/* Next axis to step along: that of the cell face that the edge meets first, unless no cell is
 * behind it. -1: none */
MPS_ROW int next_axis(const int dim, const edge_fields *y, const edge *w, int32_t cell)
{
    int best = -1;
    double first = INFINITY;
    for (int a = 0; a < dim; a++) {
        int up = w->d[a] > 0;
        if (w->left[a] == 0 || y->next[(int64_t)cell * 2 * dim + 2 * a + up] == cell) continue;
        double plane = (double)(mps__grid_coordinate(y->key[cell], a) + up);
        double t = (plane - w->x[a]) / w->d[a];
        if (t < first) {
            first = t;
            best = a;
        }
    }
    return best;
}

/* Follow the edge from cell to cell. False: the cells are too far apart or not connected. */
MPS_ROW bool follow(const int dim, const edge_fields *y, edge *w, int32_t from, int32_t to)
{
    int all = 0;
    for (int a = 0; a < dim; a++) {
        int64_t left = mps__grid_coordinate(y->key[to], a) - mps__grid_coordinate(y->key[from], a);
        if (left > MAX_STEPS || left < -MAX_STEPS) return false;
        w->left[a] = (int)(left < 0 ? -left : left);
        all += w->left[a];
    }
    if (all > MAX_STEPS) return false;
    for (w->steps = 0; w->steps < all; w->steps++) {
        int a = next_axis(dim, y, w, from);
        if (a < 0) return false;
        w->left[a]--;
        int up = w->d[a] > 0;
        int32_t to_next = y->next[(int64_t)from * 2 * dim + 2 * a + up];
        w->face[w->steps] = (int64_t)(up ? from : to_next) * dim + a;
        from = to_next;
    }
    return true;
}

MPS_ROW void add(const edge_fields *y, uint64_t *face, double conductance)
{
    const double whole = conductance * per_unit;
    const bool finite = whole < largest_term;
    const uint64_t term = finite ? (uint64_t)(int64_t)(whole + 0.5) : INFINITE;
    if (y->together && finite)
        __sync_fetch_and_add(face, term);
    else if (y->together)
        __sync_fetch_and_or(face, term);
    else
        *face = finite ? *face + term : *face | term;
}

MPS_ROW void add_edge(const int dim, const edge_fields *y, edge *w, const int32_t home[2],
                      uint64_t *faces)
{
    if (!follow(dim, y, w, home[0], home[1])) return;
    for (int s = 0; s < w->steps; s++)
        add(y, &faces[w->face[s]], w->k * fabs(w->d[w->face[s] % dim]));
}

/* Shortcut for cells with a common face, which most are. False: they have none. */
MPS_ROW bool add_short_edge(const int dim, const edge_fields *y, const edge *w,
                            const int32_t home[2], uint64_t *faces)
{
    int64_t step = y->key[home[1]] - y->key[home[0]];
    for (int a = 0; a < dim; a++) {
        int64_t one = (int64_t)1 << (a * MPS__GRID_BITS);
        if (step != one && step != -one) continue;
        add(y, &faces[(int64_t)home[step < 0] * dim + a], w->k * fabs(w->d[a]));
        return true;
    }
    return false;
}

MPS_ROW void add_row(const int dim, const edge_fields *y, int64_t i, uint64_t *faces)
{
    edge w;
    for (int a = 0; a < dim; a++) w.x[a] = mps__grid_position(dim, &y->at, i, a);
    for (int64_t k = y->row[i]; k < y->row[i + 1]; k++) {
        int32_t j = y->col[k], home[2] = {y->home[i], y->home[j]};
        const bool before = y->place ? y->place[j] <= y->place[i] : j <= i;
        if (before || home[0] == home[1] || !(y->val[k] < 0)) continue;
        w.k = -(double)y->val[k] * y->unit;
        for (int a = 0; a < dim; a++) w.d[a] = mps__grid_position(dim, &y->at, j, a) - w.x[a];
        if (!add_short_edge(dim, y, &w, home, faces)) add_edge(dim, y, &w, home, faces);
    }
}

MPS_ROW void edge_row(const int dim, const edge_fields *y, int64_t i)
{
    add_row(dim, y, i, y->faces);
}
MPS__LOOP(edge_rows, edge_row, edge_fields)

/* A chunk of the rows on the host, with its own sums. */
typedef struct parting {
    const edge_fields *y;
    int dim;
} parting;

static void add_chunk(void *argument, int32_t chunk)
{
    const parting *p = argument;
    const edge_fields y = *p->y;
    uint64_t *faces = y.faces + chunk * y.count;
    const int64_t begin = y.n * chunk / y.chunks, end = y.n * (chunk + 1) / y.chunks;
    memset(faces, 0, (size_t)y.count * sizeof *faces);
    if (p->dim == 2)
        for (int64_t i = begin; i < end; i++) add_row(2, &y, i, faces);
    else
        for (int64_t i = begin; i < end; i++) add_row(3, &y, i, faces);
}

MPS_ROW uint64_t sum_of(const edge_fields *y, int64_t face)
{
    uint64_t sum = 0;
    for (int32_t c = 0; c < y->chunks; c++) {
        const uint64_t part = y->faces[c * y->count + face];
        sum += part < MOST ? part : MOST;
    }
    return sum < MOST ? sum : MOST;
}

/* Links on both sides of the faces above a cell. */
MPS_ROW void set_link_row(const int dim, const edge_fields *y, int64_t cell)
{
    for (int64_t f = cell * dim; f < (cell + 1) * dim; f++) {
        const int64_t link = 2 * f + 1, other = y->next[link];
        if (other == cell) continue;
        const uint64_t sum = sum_of(y, f);
        y->link[link] = sum < MOST ? (float)((double)sum / per_unit) : INFINITY;
        y->link[other * 2 * dim + (link - 1) % (2 * dim)] = y->link[link];
    }
}
MPS__LOOP(set_link_rows, set_link_row, edge_fields)

static void add_faces(void *into, const void *from)
{
    uint64_t a, b;
    memcpy(&a, into, sizeof a);
    memcpy(&b, from, sizeof b);
    a = a + b < MOST ? a + b : MOST;
    memcpy(into, &a, sizeof a);
}

/* Add the sums of all chunks into the first, then over the ranks, on the host. A pair of two ranks
 * is counted at the particle that comes first. */
static int add_ranks(mps__grid *g, const mps_ppe_problem *problem, edge_fields *y)
{
    const size_t bytes = (size_t)y->count * sizeof *y->faces;
    edge_fields here = *y;
    if (g->device) {
        here.faces = mps__grid_ranks_buffer(g, MPS__GRID_FACES, y->count, sizeof *y->faces);
        if (!here.faces) return MPS_PPE_NOMEM;
        memset(here.faces, 0, bytes);
        mps__device_download(g->device, here.faces, y->faces, bytes);
    }
    for (int64_t f = 0; f < y->count; f++) here.faces[f] = sum_of(&here, f);
    y->chunks = 1;
    if (mps_ppe_reduce(problem, (int32_t)y->count, sizeof *y->faces, here.faces, add_faces))
        return MPS_PPE_BREAKDOWN;
    if (g->device) mps__device_upload(g->device, y->faces, here.faces, bytes);
    return 0;
}

/* On a device all rows add to the same sums. */
static void add_rows(const mps__grid *g, const mps_parallel *team, const edge_fields *y)
{
    if (g->device) {
        mps__device_clear(g->device, y->faces, (size_t)y->count * sizeof *y->faces);
        mps__loop_run(team, &edge_rows, g->dim, y->n, y);
    } else {
        mps_parallel_run(team, y->chunks, add_chunk, &(parting){y, g->dim});
    }
}

int mps__grid_edges(mps__grid *g, const mps_ppe_problem *problem)
{
    const mps__grid_level *l = &g->level[0];
    const mps_parallel *team = mps__team(problem->parallel, problem->n);
    edge_fields y = {.row = problem->row,
                     .key = l->key,
                     .col = problem->col,
                     .home = l->home,
                     .next = l->next,
                     .val = problem->val,
                     .place = mps__grid_many(g) ? g->ranks.place : NULL,
                     .at = mps__grid_positions_of(g, problem),
                     .unit = g->unit,
                     .n = problem->n,
                     .count = l->cells * g->dim,
                     .chunks = team && team->threads > 1 ? CHUNKS : 1,
                     .together = g->device != NULL,
                     .link = l->link};
    if (!mps__grid_reserve_parts(g, (size_t)(y.chunks * y.count) * sizeof *y.faces))
        return MPS_PPE_NOMEM;
    y.faces = g->parts;
    add_rows(g, team, &y);
    const int reason = mps__grid_many(g) ? add_ranks(g, problem, &y) : 0;
    if (reason) return reason;
    mps__loop_run(team, &set_link_rows, g->dim, l->cells, &y);
    return 0;
}

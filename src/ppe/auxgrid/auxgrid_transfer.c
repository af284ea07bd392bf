/* SPDX-License-Identifier: BSD-3-Clause */
/* auxgrid: interpolation and restriction between the points and the cells of a grid. A point
 * interpolates from the 2^dim cells on the side of its cell that it is nearer to; restriction uses
 * the same weights.
 *
 * A sum over particles has two steps of fixed order, so that it does not depend on threads: the
 * particles of a cell, in their order, are summed into its contributions to its neighbourhood; then
 * each cell adds the contributions to it. */
#include "auxgrid.h"
#include "rows.h"
#include <math.h>
#include <string.h>

/* Digits of base three: 0 no step along the axis, 1 one step down, 2 one step up. */
const uint8_t mps__grid_corner[8][8] = {{0, 1, 3, 4, 9, 10, 12, 13},  {0, 2, 3, 5, 9, 11, 12, 14},
                                        {0, 1, 6, 7, 9, 10, 15, 16},  {0, 2, 6, 8, 9, 11, 15, 17},
                                        {0, 1, 3, 4, 18, 19, 21, 22}, {0, 2, 3, 5, 18, 20, 21, 23},
                                        {0, 1, 6, 7, 18, 19, 24, 25}, {0, 2, 6, 8, 18, 20, 24, 26}};

const uint8_t mps__grid_opposite[MPS__GRID_ABOUT] = {0,  2,  1,  6,  8,  7,  3,  5,  4,
                                                     18, 20, 19, 24, 26, 25, 21, 23, 22,
                                                     9,  11, 10, 15, 17, 16, 12, 14, 13};

/* ---- particles sorted by cell ---- */

/* On many ranks each sums the particles of its own cells. */
static inline bool is_summed(const mps__grid_ranks *r, int32_t cell)
{
    return !r || r->owner[cell] == r->table.rank;
}

/* Cells are ordered as the particles meet them, so that the list accesses memory roughly in the
 * order of the particles. No sum depends on this order. */
static void list_visits(mps__grid *g, const mps__grid_ranks *r)
{
    const mps__grid_level *l = &g->level[0];
    int32_t *next = g->order, end = 0;
    g->visits = 0;
    memset(next, 0, (size_t)l->cells * sizeof *next);
    for (int64_t k = 0; k < l->points; k++) {
        const int32_t home = l->home[r ? r->table.order[k] : k];
        if (is_summed(r, home) && next[home]++ == 0) g->visit[g->visits++] = home;
    }
    for (int64_t t = 0; t < g->visits; t++) {
        const int32_t count = next[g->visit[t]];
        l->start[t] = next[g->visit[t]] = end;
        end += count;
    }
    l->start[g->visits] = end;
    for (int64_t k = 0; k < l->points; k++) {
        const int32_t i = r ? r->table.order[k] : (int32_t)k;
        if (is_summed(r, l->home[i])) l->list[next[l->home[i]]++] = i;
    }
}

/* On a device the points are sorted already; on many ranks a list of the own cells is made. */
bool mps__grid_list(mps__grid *g)
{
    const int64_t cells = g->level[0].cells;
    if (g->device && mps__grid_many(g)) {
        mps__grid_list_own(g, &g->level[0]);
        return true;
    }
    g->visits = cells;
    if (g->device) return true;
    g->visit = mps__grid_buffer_of(g, &g->visit_buffer, cells, sizeof *g->visit);
    if (g->visit) list_visits(g, mps__grid_many(g) ? &g->ranks : NULL);
    return g->visit;
}

/* ---- interpolation weights of the points ---- */

typedef struct weighing {
    const int32_t *home, *next;
    const float *link;
    const double *kappa; /* of the cells */
    uint8_t *side;
    float *weight;
    mps__grid_positions at;    /* of particles */
    const double *point_shift; /* [shifts] */
    int64_t shifts;
    double *particle;   /* conductivities, replaced by the shifts */
    const int64_t *key; /* of the cells of the finer grid */
    const double *cell; /* their conductivities */
} weighing;

static weighing weighing_of(const mps__grid_level *l)
{
    return (weighing){.home = l->home,
                      .next = l->next,
                      .link = l->link,
                      .kappa = l->kappa,
                      .side = l->side,
                      .weight = l->weight};
}

/* Interpolation weights of the 2^dim cells around a point. far[a] is the weight of the neighbour
 * cell along axis a. Only cells linked to the own cell count, and a cell of lower conductivity than
 * the point has a lower weight. */
MPS_ROW void set_weights(const int dim, const weighing *f, int64_t point, double kappa,
                         const double *far, const int side)
{
    const int corners = 1 << dim;
    float *weight = f->weight + point * corners;
    int32_t at[8]; /* -1: not linked */
    double w[8], sum = 0;
    for (int k = 0; k < corners; k++) {
        at[k] = k == 0 ? f->home[point] : -1;
        w[k] = 1;
        for (int a = 0; a < dim; a++) {
            w[k] *= k >> a & 1 ? far[a] : 1 - far[a];
            int32_t before = k >> a & 1 ? at[k ^ 1 << a] : -1;
            if (at[k] >= 0 || before < 0) continue;
            int64_t link = (int64_t)before * 2 * dim + 2 * a + (side >> a & 1);
            if (f->link[link] > 0) at[k] = f->next[link];
        }
        if (at[k] < 0) w[k] = 0;
        if (at[k] >= 0 && kappa > f->kappa[at[k]]) w[k] *= f->kappa[at[k]] / kappa;
        sum += w[k];
    }
    for (int k = 0; k < corners; k++) weight[k] = (float)(sum > 0 ? w[k] / sum : k == 0);
    f->side[point] = (uint8_t)side;
}

MPS_ROW void weigh_particle(const int dim, const weighing *f, int64_t i)
{
    double far[3];
    int side = 0;
    for (int a = 0; a < dim; a++) {
        const double u = mps__grid_position(dim, &f->at, i, a), part = u - floor(u) - 0.5;
        side |= (part > 0) << a;
        far[a] = fabs(part);
    }
    set_weights(dim, f, i, f->particle[i], far, side);
    if (i < f->shifts) f->particle[i] = f->point_shift[i] > 0 ? f->point_shift[i] : 0;
}
MPS__LOOP(weigh_particles, weigh_particle, weighing)

void mps__grid_weigh_particles(mps__grid *g, const mps_ppe_problem *problem)
{
    const mps__grid_level *l = &g->level[0];
    weighing f = weighing_of(l);
    f.at = mps__grid_positions_of(g, problem);
    f.point_shift = problem->shift;
    f.shifts = problem->n;
    f.particle = g->point_kappa;
    mps__loop_run(mps__team(problem->parallel, l->points), &weigh_particles, g->dim, l->points, &f);
}

MPS_ROW void weigh_cell(const int dim, const weighing *f, int64_t c)
{
    const double far[3] = {0.25, 0.25, 0.25};
    int side = 0;
    for (int a = 0; a < dim; a++) side |= (int)(mps__grid_coordinate(f->key[c], a) & 1) << a;
    if (f->home[c] >= 0) set_weights(dim, f, c, f->cell[c], far, side);
}
MPS__LOOP(weigh_cells, weigh_cell, weighing)

void mps__grid_weigh_cells(const mps__grid *g, const mps__grid_level *fine, mps__grid_level *l)
{
    weighing f = weighing_of(l);
    f.key = fine->key;
    f.cell = fine->kappa;
    mps__loop_run(mps__team(g->parallel, fine->cells), &weigh_cells, g->dim, fine->cells, &f);
}

/* ---- from the particles to the cells ---- */

typedef struct adding {
    mps__grid_points to;
    const int32_t *list, *start, *visit;
    const double *values;
    double scale;
    double *parts; /* [cells + 1][3^dim] */
    double *b;
} adding;

static adding adding_of(const mps__grid *g, const double *values, double scale)
{
    const mps__grid_level *l = &g->level[0];
    return (adding){
        mps__grid_points_of(l), l->list, l->start, g->visit, values, scale, g->parts, l->b};
}

/* Contributions of a particle to the neighbourhood of its cell. */
MPS_ROW void add_value(const int dim, const adding *t, int64_t i)
{
    const int corners = 1 << dim;
    double *part = t->parts + (int64_t)t->to.home[i] * (mps__grid_all(dim));
    const uint8_t *corner = mps__grid_corner[t->to.side[i]];
    const float *weight = t->to.weight + i * corners;
    const double value = t->scale * t->values[i];
    for (int k = 0; k < corners; k++) part[corner[k]] += (double)weight[k] * value;
}

/* Particles in the order of memory: fastest with one thread. */
static void add_all(int dim, int64_t n, const adding *given)
{
    const adding t = *given; /* a copy, so that its pointers stay in registers */
    if (dim == 2)
        for (int64_t i = 0; i < n; i++) add_value(2, &t, i);
    else
        for (int64_t i = 0; i < n; i++) add_value(3, &t, i);
}

/* Particles of one cell: threads do not write to the same cells. The order within a cell is that of
 * one thread. */
MPS_ROW void add_visit(const int dim, const adding *t, int64_t visit)
{
    for (int32_t p = t->start[visit]; p < t->start[visit + 1]; p++) add_value(dim, t, t->list[p]);
}
MPS__LOOP(add_visits, add_visit, adding)

/* Sum of the contributions to a cell; those of the sentinel cell are zero. */
MPS_ROW void sum_cell(const int dim, const adding *t, int64_t c)
{
    const int all = mps__grid_all(dim);
    const int32_t *about = t->to.about + c * all;
    double sum = 0;
    for (int k = 0; k < all; k++) sum += t->parts[(int64_t)about[k] * all + mps__grid_opposite[k]];
    t->b[c] = sum;
}
MPS__LOOP(sum_cells, sum_cell, adding)

/* Clear the contributions of own cells; all others are received from other ranks or stay zero. */
MPS_ROW void clear_visit(const int dim, const adding *t, int64_t visit)
{
    const int all = mps__grid_all(dim);
    memset(t->parts + (int64_t)t->visit[visit] * all, 0, (size_t)all * sizeof *t->parts);
}
MPS__LOOP(clear_visits, clear_visit, adding)

MPS_ROW void sum_visit(const int dim, const adding *t, int64_t visit)
{
    sum_cell(dim, t, t->visit[visit]);
}
MPS__LOOP(sum_visits, sum_visit, adding)

/* A device clears and sums all cells; values of other ranks' cells are replaced later by those of
 * their owners. */
static void clear_parts(const mps__grid *g, const mps_parallel *team, const adding *t)
{
    if (g->device)
        mps__vectors_clear(team, (g->level[0].cells + 1) * mps__grid_all(g->dim), t->parts);
    else
        mps__loop_run(team, &clear_visits, g->dim, g->visits, t);
}

static void sum_parts(const mps__grid *g, const mps_parallel *team, const adding *t)
{
    if (g->device)
        mps__loop_run(team, &sum_cells, g->dim, g->level[0].cells, t);
    else
        mps__loop_run(team, &sum_visits, g->dim, g->visits, t);
}

static int restrict_ranks(mps__grid *g, const double *values, double scale)
{
    mps__grid_level *l = &g->level[0];
    const mps_parallel *team = mps__team(g->parallel, l->points);
    const adding t = adding_of(g, g->ranks.value, scale);
    int reason = mps__grid_ranks_halo(g, values);
    if (reason) return reason;
    clear_parts(g, team, &t);
    mps__loop_run(team, &add_visits, g->dim, g->visits, &t);
    reason = mps__grid_ranks_exchange(g);
    if (reason) return reason;
    sum_parts(g, team, &t);
    /* the cycle on a divided grid uses the right side of own cells only */
    return g->ranks.divided > 0 ? 0 : mps__grid_ranks_collect(g, &g->ranks.owned, 1, &l->b);
}

int mps__grid_restrict(mps__grid *g, const double *values, double scale)
{
    const mps__grid_level *l = &g->level[0];
    const mps_parallel *team = mps__team(g->parallel, l->points);
    const adding t = adding_of(g, values, scale);
    if (mps__grid_many(g)) return restrict_ranks(g, values, scale);
    mps__vectors_clear(team, (l->cells + 1) * (mps__grid_all(g->dim)), t.parts);
    if (team && (team->threads > 1 || mps__device_of(team)))
        mps__loop_run(team, &add_visits, g->dim, g->visits, &t);
    else
        add_all(g->dim, l->points, &t);
    mps__loop_run(team, &sum_cells, g->dim, l->cells, &t);
    return 0;
}

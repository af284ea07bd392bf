/* SPDX-License-Identifier: BSD-3-Clause */
/* auxgrid: cell size and place of the cells, conductances between them for one density, and the coarser grids. */
#include "auxgrid.h"
#include "kernels.h"
#include "loop.h"
#include <float.h>
#include <math.h>
#include <string.h>

enum { FEW_ENTRIES = 4, SAMPLE = 16 };
static const double one_density =
    4; /* arithmetic over harmonic mean of the conductivities, below which there is one */
static const double stiffer = 1.5; /* iterations for 1, 1.15, 1.3, 1.5, 1.8: 14, 13.5, 13, 13, 13 */

/* A grid and what it is made from. */
typedef struct making {
    mps__grid *g;
    mps__grid_level *l;
    const mps_ppe_problem *problem;
    double square; /* mean of r_ij^2 */
} making;

/* What the sample of rows sees. */
typedef struct sampling {
    const int64_t *row;
    const int32_t *col;
    const float *val;
    const double *x;
    double per_dp; /* 1 / particle spacing */
    bool every;    /* all rows are sampled */
} sampling;

/* One place of SAMPLE, on each line along an axis. A function of the place: the numbers of rows depend on the rank. */
MPS_ROW bool is_sampled(const int dim, const sampling *f, int64_t i)
{
    const int64_t step[3] = {1, 5, 7};
    int64_t sum = 0;
    for (int a = 0; a < dim; a++) {
        const double u = f->x[i * dim + a] * f->per_dp;
        if (fabs(u) < 0x1p40) sum += step[a] * (int64_t)floor(u);
    }
    return f->every || sum % SAMPLE == 0;
}

/* Sums: of k_ij r_ij^2, of k_ij. */
MPS_ROW void square_row(const int dim, const sampling *f, int64_t i, double *values)
{
    double squares = 0, sum = 0;
    if (!is_sampled(dim, f, i)) return;
    for (int64_t k = f->row[i]; k < f->row[i + 1]; k++) {
        const double c = f->val[k] < 0 ? -(double)f->val[k] : 0;
        squares += c * mps__square_between(f->x + i * dim, f->x + (int64_t)f->col[k] * dim, dim);
        sum += c;
    }
    values[0] = squares;
    values[1] = sum;
}
MPS__VALUES(square_rows, square_row, sampling, 2, 0)

/* Sum of k_ij r_ij^2 over that of k_ij, from a sample of the rows: all have the same kernel. */
static double mean_square(const mps_ppe_problem *problem)
{
    sampling f = {.row = problem->row,
                  .col = problem->col,
                  .val = problem->val,
                  .x = problem->x,
                  .per_dp = 1 / problem->dp};
    double v[2] = {0}, none[1];
    for (int pass = 0; pass < 2 && !(v[1] > 0); pass++) {
        mps_exact sums[2] = {{{0}, 0, 0}};
        f.every = pass > 0;
        mps__values_run(mps__team(problem->parallel, problem->n), &square_rows, problem->dim,
                        problem->n, &f, sums, none);
        mps_ppe_total(problem, &(mps_exact_values){.sums = 2, .sum = sums});
        for (int k = 0; k < 2; k++) v[k] = mps_exact_value(&sums[k]);
    }
    return v[1] > 0 ? v[0] / v[1] : 0;
}

/* Sums: of kappa, of its inverse, of rows; the maximum: kappa. */
static void measure_rows(void *argument, int64_t begin, int64_t end, mps_exact *sums, double *most)
{
    const making *m = argument;
    const mps_ppe_problem *problem = m->problem;
    double term[3][MPS__BLOCK];
    for (int64_t i = begin, count = 0; i < end; i++) {
        const int64_t entries = problem->row[i + 1] - problem->row[i];
        const double flux = fmax(problem->diagonal[i] - problem->shift[i], 0) * m->square,
                     kappa = entries > 0 ? flux / (double)entries : 0;
        m->g->point_kappa[i] = kappa;
        if (kappa > *most) *most = kappa;
        /* a lone pair at the end of the kernel says little */
        if (entries >= FEW_ENTRIES && kappa > 0) {
            term[0][count] = kappa;
            term[1][count] = 1 / kappa;
            term[2][count++] = 1;
        }
        if (count < MPS__BLOCK && i + 1 < end) continue;
        for (int k = 0; k < 3; k++) mps_exact_add(&sums[k], count, term[k]);
        count = 0;
    }
}

/* Sums of k_ij r_ij^2 of all rows, the inverse density but for a factor that full rows share, and whether it is the same everywhere. */
void mps__grid_measure(mps__grid *g, const mps_ppe_problem *problem)
{
    making m = {.g = g,
                .problem = problem,
                .square = mean_square(g->source ? g->source->problem : problem)};
    mps_exact sums[3] = {{{0}, 0, 0}};
    double v[3], most = 0;
    mps__reduce(problem, measure_rows, &m, &(mps_exact_values){3, 1, sums, &most});
    for (int k = 0; k < 3; k++) v[k] = mps_exact_value(&sums[k]);
    g->one = !(v[0] * v[1] > one_density * v[2] * v[2]);
    g->dim = problem->dim;
    g->unit = most > 0 ? problem->dp * problem->dp / most : 1;
    g->size = problem->dp * (!g->one ? 2 : problem->dim == 2 ? 3 : 2.5);
    g->per_size = 1 / g->size;
}

static void place_rows(void *argument, int64_t begin, int64_t end)
{
    const making *m = argument;
    for (int64_t i = begin; i < end; i++) {
        int64_t key = 0;
        for (int a = 0; a < m->problem->dim; a++)
            key |= (int64_t)mps__grid_position(m->g, m->problem, i, a) << (a * MPS__GRID_BITS);
        m->g->point_key[i] = key;
    }
}

/* values: the largest of -x along each axis. */
static void corner_rows(void *argument, int64_t begin, int64_t end, double *values)
{
    const mps_ppe_problem *problem = argument;
    for (int64_t i = begin; i < end; i++)
        for (int a = 0; a < problem->dim; a++)
            values[a] = fmax(values[a], -problem->x[i * problem->dim + a]);
}

/* The corner is below the least particle and has few places: odd multiples of a quarter of the range of coordinates. So the cells
 * stand still while particles move, and the same cells merge until four are left along each axis; so few are solved directly.
 * For a tank at the origin the corner changes place only if the tank is moved by a quarter of the range. Its first cells begin
 * half a spacing before its walls, which takes fewer iterations than cells that begin at them. */
void mps__grid_lay(mps__grid *g, const mps_ppe_problem *problem)
{
    double most[3] = {-INFINITY, -INFINITY, -INFINITY};
    mps_parallel_max(mps__team(problem->parallel, problem->n), problem->n, problem->dim,
                     corner_rows, (void *)problem, most);
    mps_ppe_total(problem, &(mps_exact_values){.maxima = problem->dim, .maximum = most});
    const double part = 1 << (MPS__GRID_BITS - 1), before = 0.5 * problem->dp * g->per_size;
    for (int a = 0; a < problem->dim; a++)
        g->corner[a] = (floor(-most[a] * g->per_size / part + 0.5) - 0.5) * part - before;
}

void mps__grid_place(mps__grid *g, const mps_ppe_problem *problem, int64_t points)
{
    mps_parallel_rows_least(problem->parallel, points, MPS__TEAM_LEAST / 2, place_rows,
                            &(making){.g = g, .problem = problem});
}

/* ---- first grid ---- */

/* Mean conductivity of a cell's particles; into x the sum k_ij r_ij^2 of their pairs. */
static void sum_particles(void *argument, int64_t begin, int64_t end)
{
    const making *m = argument;
    const mps__grid *g = m->g;
    const int64_t *row = m->problem->row;
    const double *entries = mps__grid_many(g) ? g->ranks.entries : NULL;
    for (int64_t t = begin; t < end; t++) {
        const int64_t c = g->turn[t];
        double kappa = 0, sum = 0;
        for (int32_t p = g->start[t]; p < g->start[t + 1]; p++) {
            const int64_t i = g->list[p];
            kappa += g->point_kappa[i];
            sum += g->point_kappa[i] * (entries ? entries[i] : (double)(row[i + 1] - row[i]));
        }
        m->l->count[c] = g->start[t + 1] - g->start[t];
        m->l->kappa[c] = kappa / m->l->count[c];
        m->l->x[c] = g->unit * sum;
    }
}

/* Links where there is one density, without a walk over the pairs: a cell conducts as much as its particles, sum k_ij r_ij^2 /
 * (2 D size^2), and a face as much as the geometric mean of its two cells. Stiffer links save an iteration: the inverse diagonal has its
 * share of the smooth pressures already. */
static void link_cells(void *argument, int64_t begin, int64_t end)
{
    const making *m = argument;
    const mps__grid *g = m->g;
    const mps__grid_level *l = m->l;
    const int sides = 2 * g->dim;
    const double c = stiffer * g->per_size * g->per_size / sides;
    for (int64_t k = begin * sides; k < end * sides; k++) {
        const int64_t cell = k / sides, other = l->next[k];
        if (other != cell) l->link[k] = (float)(c * sqrt(l->x[cell] * l->x[other]));
    }
}

static void note_shifts(void *argument, int64_t begin, int64_t end)
{
    const making *m = argument;
    const double *shift = m->problem->shift;
    for (int64_t i = begin; i < end; i++) m->g->point_kappa[i] = shift[i] > 0 ? shift[i] : 0;
}

/* What holds the pressure's level, to the cells that the particle takes its value from: a cell filled at its edge only would
 * otherwise hold a value that no particle has. */
static int share_shifts(making *m)
{
    mps__grid_level *l = m->l;
    mps_parallel_rows_least(m->problem->parallel, m->problem->n, MPS__TEAM_LEAST / 2, note_shifts,
                            m);
    const int reason = mps__grid_restrict(m->g, m->g->point_kappa, m->g->unit);
    if (!reason) memcpy(l->shift, l->b, (size_t)l->cells * sizeof *l->shift);
    return reason;
}

/* Sums of cells on all ranks. Each particle has been counted once. */
static int collect_sums(mps__grid *g, mps__grid_level *l)
{
    double counted = 0;
    const int reason = mps__grid_ranks_collect(g, &g->ranks.owned, 3,
                                               (double *[]){l->count, l->kappa, l->x});
    if (reason) return reason;
    for (int64_t c = 0; c < l->cells; c++) counted += l->count[c];
    return counted == (double)g->ranks.table.rows ? 0 : MPS_PPE_BREAKDOWN;
}

int mps__grid_from_matrix(mps__grid *g, const mps_ppe_problem *problem)
{
    int reason = 0;
    mps__grid_level *l = &g->level[0];
    making m = {.g = g, .l = l, .problem = problem};
    const mps_parallel *team = mps__team(problem->parallel, problem->n);
    const size_t parts = (size_t)(l->cells + 1) * (g->dim == 2 ? 9 : MPS__GRID_ABOUT) *
                         sizeof(double);
    if (!mps__grid_list(g) || !mps__grid_reserve_parts(g, parts)) return MPS_PPE_NOMEM;
    mps_parallel_rows(team, g->turns, sum_particles, &m);
    if (mps__grid_many(g)) reason = collect_sums(g, l);
    if (reason) return reason;
    if (g->one)
        mps_parallel_rows(team, l->cells, link_cells, &m);
    else
        reason = mps__grid_wires(g, problem);
    if (reason) return reason;
    mps__grid_share_particles(g, problem);
    if (mps__grid_many(g)) memset(g->parts, 0, parts); /* what no rank fills stays zero */
    return share_shifts(&m);
}

/* ---- coarser grids: two cells become one along each axis ---- */

static bool is_linked(const mps__grid *g, const mps__grid_level *l, int64_t cell)
{
    for (int s = 0; s < 2 * g->dim; s++)
        if (l->link[cell * 2 * g->dim + s] > 0) return true;
    return false;
}

/* Cells without links are solved on their own grid and have no coarser one. */
static void place_cells(mps__grid *g, const mps__grid_level *fine)
{
    for (int64_t c = 0; c < fine->cells; c++) {
        g->point_kappa[c] = fine->kappa[c];
        g->point_key[c] = is_linked(g, fine, c) ? 0 : -1;
        for (int a = 0; a < g->dim && g->point_key[c] >= 0; a++)
            g->point_key[c] |= mps__grid_coordinate(fine->key[c], a) / 2 << (a * MPS__GRID_BITS);
    }
}

/* The wires that cross between coarse cells are as many as those between fine ones, and half as long in cells. */
static void add_cell(const mps__grid *g, const mps__grid_level *fine, mps__grid_level *l, int64_t c)
{
    int32_t home = l->home[c];
    l->shift[home] += fine->shift[c];
    l->kappa[home] += fine->count[c] * fine->kappa[c];
    l->count[home] += fine->count[c];
    for (int a = 0; a < g->dim; a++) {
        int64_t link = c * 2 * g->dim + 2 * a + 1;
        int32_t other = l->home[fine->next[link]];
        if (!(fine->link[link] > 0) || other == home) continue;
        l->link[(int64_t)home * 2 * g->dim + 2 * a + 1] += 0.5f * fine->link[link];
        l->link[(int64_t)other * 2 * g->dim + 2 * a] += 0.5f * fine->link[link];
    }
}

static void from_finer(mps__grid *g, const mps__grid_level *fine, mps__grid_level *l)
{
    for (int64_t c = 0; c < fine->cells; c++)
        if (l->home[c] >= 0) add_cell(g, fine, l, c);
    for (int64_t c = 0; c < l->cells; c++) l->kappa[c] /= l->count[c];
    mps__grid_share_cells(g, fine, l);
}

bool mps__grid_coarsen(mps__grid *g)
{
    while (g->levels < MPS__GRID_LEVELS && g->level[g->levels - 1].cells >= MPS__GRID_DIRECT) {
        mps__grid_level *fine = &g->level[g->levels - 1], *l = fine + 1;
        place_cells(g, fine);
        if (!mps__grid_cells(g, l, fine->cells)) return false;
        from_finer(g, fine, l);
        g->levels++;
    }
    return true;
}

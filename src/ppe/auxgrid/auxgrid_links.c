/* SPDX-License-Identifier: BSD-3-Clause */
/* auxgrid: size and position of the first grid, and conductances between its cells for one
 * density. */
#include "auxgrid.h"
#include "rows.h"
#include "loop.h"
#include <float.h>
#include <math.h>
#include <string.h>

enum { FEW_ENTRIES = 4, SAMPLE = 16 };
/* arithmetic over harmonic mean of the conductivities; below it there is one density */
static const double one_density = 4;
static const double stiffer = 1.5; /* iterations for 1, 1.15, 1.3, 1.5, 1.8: 14, 13.5, 13, 13, 13 */

/* ---- data common to all rows ---- */

/* Arguments of the loop that checks and samples rows. */
typedef struct looking {
    const int64_t *row;
    const int32_t *col;
    const float *val;
    const double *diagonal, *x;
    double per_dp; /* 1 / particle spacing */
    bool every;    /* all rows are sampled */
} looking;

/* Sums: of k_ij r_ij^2, of k_ij of the sample. Maxima: whether a diagonal entry is not finite,
 * whether one is negative, -x along each axis. */
enum { SQUARES, CONDUCTANCES, SUMS, BAD = 0, NEGATIVE, LEAST, MAXIMA = 5 };

/* [dp] Walls are on planes between sampling positions, so that rounding does not decide on the
 * side. */
static const double rounding = 1e-6;

/* One position of SAMPLE, on each line along an axis. It depends on the position, since the numbers
 * of rows depend on the rank. */
MPS_ROW bool is_sampled(const int dim, const looking *f, int64_t i)
{
    const int64_t step[3] = {1, 5, 7};
    int64_t sum = 0;
    for (int a = 0; a < dim; a++) {
        const double u = f->x[i * dim + a] * f->per_dp + rounding;
        if (fabs(u) < 0x1p40) sum += step[a] * (int64_t)floor(u);
    }
    return f->every || sum % SAMPLE == 0;
}

MPS_ROW void square_row(const int dim, const looking *f, int64_t i, double *sums)
{
    double squares = 0, sum = 0;
    for (int64_t k = f->row[i]; k < f->row[i + 1]; k++) {
        const double c = f->val[k] < 0 ? -(double)f->val[k] : 0;
        squares += c * mps__square_between(f->x + i * dim, f->x + (int64_t)f->col[k] * dim, dim);
        sum += c;
    }
    sums[SQUARES] = squares;
    sums[CONDUCTANCES] = sum;
}

MPS_ROW void look_row(const int dim, const looking *f, int64_t i, double *values)
{
    const double d = f->diagonal[i];
    double *most = values + SUMS;
    if (is_sampled(dim, f, i)) square_row(dim, f, i, values);
    if (!isfinite(d)) most[BAD] = 1;
    if (d < 0) most[NEGATIVE] = 1;
    for (int a = 0; a < dim; a++) {
        const double below = -f->x[i * dim + a];
        if (below > most[LEAST + a]) most[LEAST + a] = below;
    }
}
MPS__VALUES(look_rows, look_row, looking, SUMS, MAXIMA)

/* Reduce over all ranks. Returns a reason of failure. */
static int add_up(const mps_ppe_problem *problem, mps_exact *sums, double *found)
{
    double refused[3] = {found[BAD], found[NEGATIVE], mps__columns(problem) >= INT32_MAX};
    mps_ppe_total(problem, &(mps_exact_values){SUMS, 3, sums, refused});
    mps_ppe_total(problem, &(mps_exact_values){.maxima = 3, .maximum = found + LEAST});
    if (refused[2] > 0) return MPS_PPE_BREAKDOWN;
    return refused[BAD] > 0 ? MPS_PPE_NAN : refused[NEGATIVE] > 0 ? MPS_PPE_INDEFINITE : 0;
}

static looking looking_of(const mps_ppe_problem *problem)
{
    return (looking){.row = problem->row,
                     .col = problem->col,
                     .val = problem->val,
                     .diagonal = problem->diagonal,
                     .x = problem->x,
                     .per_dp = 1 / problem->dp};
}

/* The mean of r_ij^2 is from a sample of the rows, which all have the same kernel, or from all rows
 * if the sample is empty. */
int mps__grid_look(const mps_ppe_problem *problem, mps__grid_common *common)
{
    looking f = looking_of(problem);
    *common = (mps__grid_common){.square = 0};
    for (int pass = 0; pass < 2 && !(common->square > 0); pass++) {
        mps_exact sums[SUMS] = {{{0}, 0, 0}};
        double found[MAXIMA] = {0, 0, -INFINITY, -INFINITY, -INFINITY};
        f.every = pass > 0;
        mps__values_run(mps__team(problem->parallel, problem->n), &look_rows, problem->dim,
                        problem->n, &f, sums, found);
        const int reason = add_up(problem, sums, found);
        const double sum = mps_exact_value(&sums[CONDUCTANCES]);
        if (reason) return reason;
        if (sum > 0) common->square = mps_exact_value(&sums[SQUARES]) / sum;
        memcpy(common->least, found + LEAST, sizeof common->least);
    }
    return 0;
}

/* Arguments of loops over rows. */
typedef struct rows {
    const int64_t *row;
    const double *diagonal, *shift;
    double square;           /* mean of r_ij^2 */
    const double *squared;   /* the same on a device, or NULL */
    double *kappa, *entries; /* out; entries NULL: not requested */
} rows;

/* Sums: of kappa, of its inverse, of rows; maximum: kappa. A single pair at the end of the kernel
 * has little weight. */
MPS_ROW void measure_row(const rows *f, int64_t i, double *values)
{
    const int64_t entries = f->row[i + 1] - f->row[i];
    const double left = f->diagonal[i] - f->shift[i], square = f->squared ? *f->squared : f->square,
                 flux = (left > 0 ? left : 0) * square,
                 kappa = entries > 0 ? flux / (double)entries : 0;
    f->kappa[i] = kappa;
    if (f->entries) f->entries[i] = (double)entries;
    if (kappa > values[3]) values[3] = kappa;
    if (entries < FEW_ENTRIES || !(kappa > 0)) return;
    values[0] = kappa;
    values[1] = 1 / kappa;
    values[2] = 1;
}
MPS__VALUES_ANY(measure_rows, measure_row, rows, 3, 1)

static void take_measure(mps__grid *g, const mps_ppe_problem *problem, const mps_exact sums[3],
                         double most)
{
    double v[3] = {0};
    for (int k = 0; k < 3; k++) v[k] = mps_exact_value(&sums[k]);
    g->one = !(v[0] * v[1] > one_density * v[2] * v[2]);
    g->dim = problem->dim;
    g->unit = most > 0 ? problem->dp * problem->dp / most : 1;
    g->size = problem->dp * (!g->one ? 2 : problem->dim == 2 ? 3 : 2.5);
    g->per_size = 1 / g->size;
}

/* Sums of k_ij r_ij^2 of each row (the inverse density up to a factor common to full rows), and
 * whether the density is uniform. */
void mps__grid_measure(mps__grid *g, const mps_ppe_problem *problem, double square)
{
    const rows f = {.row = problem->row,
                    .diagonal = problem->diagonal,
                    .shift = problem->shift,
                    .square = square,
                    .kappa = g->point_kappa,
                    .entries = mps__grid_many(g) ? g->ranks.entries : NULL};
    mps_exact sums[3] = {{{0}, 0, 0}};
    double most = 0;
    mps__values_run(mps__team(problem->parallel, problem->n), &measure_rows, MPS__ANY_DIM,
                    problem->n, &f, sums, &most);
    mps_ppe_total(problem, &(mps_exact_values){3, 1, sums, &most});
    take_measure(g, problem, sums, most);
}

/* The corner is below the lowest particle, at odd multiples of a quarter of the range of
 * coordinates. So the cells do not move while particles move, and the same cells merge until four
 * are left along each axis; so few are solved directly. For a tank at the origin the corner changes
 * only if the tank moves by a quarter of the range. Its first cells begin half a spacing before its
 * walls, which takes fewer iterations than cells that begin at them. */
void mps__grid_lay(mps__grid *g, const mps_ppe_problem *problem, const double *least)
{
    const double part = 1 << (MPS__GRID_BITS - 1), before = 0.5 * problem->dp * g->per_size;
    for (int a = 0; a < problem->dim; a++)
        g->corner[a] = (floor(-least[a] * g->per_size / part + 0.5) - 0.5) * part - before;
}

typedef struct placing {
    mps__grid_positions at;
    int64_t *key;
} placing;

MPS_ROW void place_row(const int dim, const placing *f, int64_t i)
{
    int64_t key = 0;
    for (int a = 0; a < dim; a++)
        key |= (int64_t)mps__grid_position(dim, &f->at, i, a) << (a * MPS__GRID_BITS);
    f->key[i] = key;
}
MPS__LOOP(place_rows, place_row, placing)

void mps__grid_place(mps__grid *g, const mps_ppe_problem *problem, int64_t points)
{
    mps__loop_run_cheap(problem->parallel, &place_rows, g->dim, points,
                        &(placing){mps__grid_positions_of(g, problem), g->point_key});
}

/* ---- on a device ---- */

typedef struct averaging {
    const mps_exact *sums;
    double *square;
} averaging;

MPS_ROW void average_row(const averaging *f, int64_t i)
{
    const double sum = mps_exact_value(&f->sums[CONDUCTANCES]);
    (void)i;
    *f->square = sum > 0 ? mps_exact_value(&f->sums[SQUARES]) / sum : 0;
}
MPS__LOOP_ANY(average_rows, average_row, averaging)

/* Queue the cells at the previous position of the first grid, and all that determines its new
 * position. */
static void queue_questions(mps__grid *g, const mps_ppe_problem *problem)
{
    mps__grid_reported *to = g->reported;
    const looking f = looking_of(problem);
    const rows r = {.row = problem->row,
                    .diagonal = problem->diagonal,
                    .shift = problem->shift,
                    .squared = &to->square,
                    .kappa = g->point_kappa};
    mps__values_reduce_async(g->device, &look_rows, problem->dim, problem->n, &f, &to->look);
    mps__loop_run(problem->parallel, &average_rows, MPS__ANY_DIM, 1,
                  &(averaging){to->look.sums, &to->square});
    mps__values_reduce_async(g->device, &measure_rows, MPS__ANY_DIM, problem->n, &r, &to->measure);
    if (!g->laid) return;
    mps__grid_place(g, problem, problem->n);
    mps__grid_sort(g, &g->level[0]);
}

/* If the sample has no pairs, all rows are sampled. */
static int ask_all(mps__grid *g, const mps_ppe_problem *problem, mps__grid_common *common)
{
    const int reason = mps__grid_look(problem, common);
    if (!reason) mps__grid_measure(g, problem, common->square);
    return reason;
}

/* Take over the downloaded results of the rows. */
static int take_look(mps__grid *g, const mps_ppe_problem *problem,
                     const mps__grid_reported *reported, mps__grid_common *common)
{
    const double *most = reported->look.maxima;
    if (g->device->failed) return MPS_PPE_NOMEM;
    if (most[BAD] > 0 || most[NEGATIVE] > 0)
        return most[BAD] > 0 ? MPS_PPE_NAN : MPS_PPE_INDEFINITE;
    if (!(reported->square > 0)) return ask_all(g, problem, common);
    common->square = reported->square;
    memcpy(common->least, most + LEAST, sizeof common->least);
    take_measure(g, problem, reported->measure.sums, reported->measure.largest);
    return 0;
}

/* Set position and size of the first grid. Returns whether they are unchanged. */
static bool lies_as_before(mps__grid *g, const mps_ppe_problem *problem, const double *least,
                           double size)
{
    const double before[3] = {g->corner[0], g->corner[1], g->corner[2]};
    bool same = g->laid && g->size == size;
    mps__grid_lay(g, problem, least);
    for (int a = 0; a < problem->dim; a++) same = same && g->corner[a] == before[a];
    g->laid = true;
    return same;
}

int mps__grid_ask(mps__grid *g, const mps_ppe_problem *problem)
{
    mps__grid_level *l = &g->level[0];
    const double size = g->size;
    mps__grid_reported reported = {.square = 0};
    mps__grid_common common = {.square = 0};
    if (problem->n >= INT32_MAX) return MPS_PPE_BREAKDOWN;
    l->points = problem->n;
    if (!mps__grid_reserve_points(g, l)) return MPS_PPE_NOMEM;
    queue_questions(g, problem);
    mps__device_download(g->device, &reported, g->reported, sizeof reported);
    const int reason = take_look(g, problem, &reported, &common);
    if (reason) return reason;
    if (lies_as_before(g, problem, common.least, size)) {
        mps__grid_counted(l, reported.cells);
        return 0;
    }
    mps__grid_place(g, problem, problem->n);
    mps__grid_sort(g, l);
    mps__grid_count(g, l);
    return 0;
}

/* ---- first grid ---- */

/* Arguments of loops over the cells of the first grid. */
typedef struct cells {
    const int32_t *visit, *start, *list, *next;
    const int64_t *row;
    const double *entries;     /* [columns] of the rows, on many ranks */
    const double *point_kappa; /* of the particles */
    double *count, *kappa, *flow;
    float *link;
    double unit, stiffness;
} cells;

/* Mean conductivity of a cell's particles, and the sum of k_ij r_ij^2 over their pairs. */
MPS_ROW void sum_row(const cells *f, int64_t t)
{
    const int64_t c = f->visit ? f->visit[t] : t;
    double kappa = 0, sum = 0;
    for (int32_t p = f->start[t]; p < f->start[t + 1]; p++) {
        const int64_t i = f->list[p];
        kappa += f->point_kappa[i];
        sum += f->point_kappa[i] *
               (f->entries ? f->entries[i] : (double)(f->row[i + 1] - f->row[i]));
    }
    f->count[c] = f->start[t + 1] - f->start[t];
    f->kappa[c] = kappa / f->count[c];
    f->flow[c] = f->unit * sum;
}
MPS__LOOP_ANY(sum_rows, sum_row, cells)

/* Links for one density, without a loop over the pairs: the conductance of a cell is that of its
 * particles, sum k_ij r_ij^2 / (2 D size^2), that of a face the geometric mean of its two cells.
 * Stiffer links save an iteration, since the inverse diagonal already reduces part of the smooth
 * residual. */
MPS_ROW void link_row(const int dim, const cells *f, int64_t c)
{
    for (int64_t k = c * 2 * dim; k < (c + 1) * 2 * dim; k++) {
        const int64_t other = f->next[k];
        if (other != c) f->link[k] = (float)(f->stiffness * sqrt(f->flow[c] * f->flow[other]));
    }
}
MPS__LOOP(link_rows, link_row, cells)

/* The sums over particles are stored in x until the first cycle. */
static cells cells_of(const mps__grid *g, const mps_ppe_problem *problem)
{
    const mps__grid_level *l = &g->level[0];
    return (cells){.visit = g->visit,
                   .start = l->start,
                   .list = l->list,
                   .next = l->next,
                   .row = problem->row,
                   .entries = mps__grid_many(g) ? g->ranks.entries : NULL,
                   .point_kappa = g->point_kappa,
                   .count = l->count,
                   .kappa = l->kappa,
                   .flow = l->x,
                   .link = l->link,
                   .unit = g->unit,
                   .stiffness = stiffer * g->per_size * g->per_size / (2 * g->dim)};
}

/* Distribute the diagonal shift, which sets the pressure datum, to the cells that the particle
 * interpolates from: otherwise a cell filled only at its edge would fix a value that no particle
 * has. */
static int share_shifts(mps__grid *g)
{
    const mps__grid_level *l = &g->level[0];
    const int reason = mps__grid_restrict(g, g->point_kappa, g->unit);
    if (!reason) mps__vectors_copy(mps__team(g->parallel, l->cells), l->cells, l->b, l->shift);
    return reason;
}

/* Collect the sums of cells on all ranks. Each particle has been counted once. */
static int collect_sums(mps__grid *g, mps__grid_level *l)
{
    double counted = 0;
    const int reason = mps__grid_ranks_collect(g, &g->ranks.owned, 3,
                                               (double *[]){l->count, l->kappa, l->x});
    const double *counts = g->ranks.buffer[MPS__GRID_IN].at; /* of each cell: count, kappa, x */
    if (reason) return reason;
    for (int64_t c = 0; c < l->cells; c++) counted += counts[3 * c];
    return counted == (double)g->ranks.table.rows ? 0 : MPS_PPE_BREAKDOWN;
}

int mps__grid_from_matrix(mps__grid *g, const mps_ppe_problem *problem)
{
    int reason = 0;
    mps__grid_level *l = &g->level[0];
    const mps_parallel *team = mps__team(problem->parallel, problem->n);
    const size_t parts = (size_t)((l->cells + 1) * mps__grid_all(g->dim)) * sizeof(double);
    if (!mps__grid_list(g) || !mps__grid_reserve_parts(g, parts)) return MPS_PPE_NOMEM;
    const cells f = cells_of(g, problem);
    mps__loop_run(team, &sum_rows, MPS__ANY_DIM, g->visits, &f);
    if (mps__grid_many(g)) reason = collect_sums(g, l);
    if (reason) return reason;
    if (g->one)
        mps__loop_run(team, &link_rows, g->dim, l->cells, &f);
    else
        reason = mps__grid_edges(g, problem);
    if (reason) return reason;
    mps__grid_weigh_particles(g, problem);
    if (mps__grid_many(g)) /* sums without contributions of any rank stay zero */
        mps__vectors_clear(team, (l->cells + 1) * mps__grid_all(g->dim), g->parts);
    return share_shifts(g);
}

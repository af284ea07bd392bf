/* SPDX-License-Identifier: BSD-3-Clause */
/* auxgrid: cell size, conductances between cells and the shares of the points. A matrix entry k_ij is a wire from particle i
 * to j; where it crosses from cell to cell along an axis it adds k_ij |x_j - x_i| / size, both along that axis. For a linear
 * pressure that is the energy of the wires, and between two densities it is what lets the pressure through. */
#include "auxgrid.h"
#include "kernels.h"
#include <float.h>
#include <math.h>
#include <string.h>

enum { FEW_ENTRIES = 4, MAX_STEPS = 12, SAMPLE = 16 };
static const double one_density =
    4; /* arithmetic over harmonic mean of the conductivities, below which there is one */
static const double stiffer = 1.5; /* iterations for 1, 1.15, 1.3, 1.5, 1.8: 14, 13.5, 13, 13, 13 */

static double square_distance(const mps_ppe_problem *problem, int64_t i, int64_t j)
{
    double r2 = 0;
    for (int a = 0; a < problem->dim; a++) {
        double d = problem->x[j * problem->dim + a] - problem->x[i * problem->dim + a];
        r2 += d * d;
    }
    return r2;
}

/* Sum of k_ij r_ij^2 over that of k_ij, from one row of SAMPLE: all rows have the same kernel. */
static double mean_square(const mps_ppe_problem *problem)
{
    double squares = 0, sum = 0;
    for (int64_t i = 0; i < problem->n; i += SAMPLE)
        for (int64_t k = problem->row[i]; k < problem->row[i + 1]; k++) {
            const double c = fmax(-(double)problem->val[k], 0);
            squares += c * square_distance(problem, i, problem->col[k]);
            sum += c;
        }
    return sum > 0 ? squares / sum : 0;
}

/* A grid and what it is made from. */
typedef struct making {
    mps__grid *g;
    mps__grid_level *l;
    const mps_ppe_problem *problem;
    double square; /* mean of r_ij^2 */
} making;

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
    making m = {.g = g, .problem = problem, .square = mean_square(problem)};
    mps_exact sums[3] = {{{0}, 0, 0}};
    double v[3], most = 0;
    mps__reduce(problem, measure_rows, &m,
                &(mps_exact_values){3, 1, sums, &most});
    for (int k = 0; k < 3; k++) v[k] = mps_exact_value(&sums[k]);
    g->one = !(v[0] * v[1] > one_density * v[2] * v[2]);
    g->dim = problem->dim;
    g->unit = most > 0 ? problem->dp * problem->dp / most : 1;
    g->size = problem->dp * (!g->one ? 2 : problem->dim == 2 ? 3 : 2.5);
    g->per_size = 1 / g->size;
}

/* Position in cells, within the range of coordinates. */
static double position(const mps__grid *g, const mps_ppe_problem *problem, int64_t i, int a)
{
    const double most = (1 << MPS__GRID_BITS) - 0.5;
    double u = (problem->x[i * problem->dim + a] - g->lo[a]) * g->per_size;
    u = u > 0 ? u : 0;
    return u < most ? u : most;
}

static void place_rows(void *argument, int64_t begin, int64_t end)
{
    const making *m = argument;
    for (int64_t i = begin; i < end; i++) {
        int64_t key = 0;
        for (int a = 0; a < m->problem->dim; a++)
            key |= (int64_t)position(m->g, m->problem, i, a) << (a * MPS__GRID_BITS);
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

void mps__grid_place(mps__grid *g, const mps_ppe_problem *problem)
{
    double most[3] = {-INFINITY, -INFINITY, -INFINITY};
    mps_parallel_max(mps__team(problem->parallel, problem->n), problem->n, problem->dim,
                     corner_rows, (void *)problem, most);
    for (int a = 0; a < problem->dim; a++) g->lo[a] = -most[a] - 0.5 * g->size;
    mps_parallel_rows_least(problem->parallel, problem->n, MPS__TEAM_LEAST / 2, place_rows,
                            &(making){.g = g, .problem = problem});
}

/* ---- conductances ---- */

typedef struct wire {
    double x[3], d[3]; /* start and difference in cells */
    int left[3];       /* steps still to go along each axis */
    int steps;
    int64_t link[MAX_STEPS]; /* crossed so far */
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
        w->link[w->steps] = (int64_t)from * 2 * g->dim + 2 * a + (w->d[a] > 0);
        from = l->next[w->link[w->steps]];
    }
    return true;
}

/* Add to one of the links from both sides. */
static void join(const mps__grid *g, const mps__grid_level *l, int64_t link, float c, float *links)
{
    int sides = 2 * g->dim, side = (int)(link % sides);
    links[link] += c;
    links[(int64_t)l->next[link] * sides + (side ^ 1)] += c;
}

static void add_wire(const mps__grid *g, const mps__grid_level *l, wire *w, const int32_t home[2],
                     double k, float *links)
{
    if (!follow(g, l, w, home[0], home[1])) return;
    for (int s = 0; s < w->steps; s++)
        join(g, l, w->link[s], (float)(k * fabs(w->d[w->link[s] % (2 * g->dim) / 2])), links);
}

/* The same for cells with a face in common, as most are. False: they have none. */
static bool add_short_wire(const mps__grid *g, const mps__grid_level *l, const wire *w,
                           const int32_t home[2], double k, float *links)
{
    int64_t step = l->key[home[1]] - l->key[home[0]];
    for (int a = 0; a < g->dim; a++) {
        int64_t one = (int64_t)1 << (a * MPS__GRID_BITS);
        if (step != one && step != -one) continue;
        join(g, l, (int64_t)home[0] * 2 * g->dim + 2 * a + (step > 0), (float)(k * fabs(w->d[a])),
             links);
        return true;
    }
    return false;
}

static void add_row(const mps__grid *g, const mps__grid_level *l, const mps_ppe_problem *problem,
                    int64_t i, float *links)
{
    double start[3] = {0};
    for (int a = 0; a < g->dim; a++) start[a] = position(g, problem, i, a);
    for (int64_t k = problem->row[i]; k < problem->row[i + 1]; k++) {
        int32_t j = problem->col[k], home[2] = {l->home[i], l->home[j]};
        if (j <= i || home[0] == home[1] || !(problem->val[k] < 0)) continue;
        double conductance = -(double)problem->val[k] * g->unit;
        wire w;
        for (int a = 0; a < g->dim; a++) {
            w.x[a] = start[a];
            w.d[a] = position(g, problem, j, a) - start[a];
        }
        if (!add_short_wire(g, l, &w, home, conductance, links))
            add_wire(g, l, &w, home, conductance, links);
    }
}

/* ---- shares of the points ---- */

/* Shares of the 2^dim cells around a point. far[a] is the share of the cell beside its own along axis a, below or above as
 * side[a] says; only cells joined to the own one by links count, and a cell that conducts less counts less. */
static inline __attribute__((always_inline)) void set_shares_of(const int dim, const mps__grid *g,
                                                                mps__grid_level *l, int64_t point,
                                                                const double *far, const int *side)
{
    const int corners = 1 << dim;
    int32_t home = l->home[point], *at = l->at + point * corners;
    float *share = l->share + point * corners;
    double kappa = g->point_kappa[point], w[8], sum = 0;
    for (int k = 0; k < corners; k++) {
        at[k] = k == 0 ? home : -1;
        w[k] = 1;
        for (int a = 0; a < dim; a++) {
            w[k] *= k >> a & 1 ? far[a] : 1 - far[a];
            int32_t before = k >> a & 1 ? at[k ^ 1 << a] : -1;
            if (at[k] >= 0 || before < 0) continue;
            int64_t link = (int64_t)before * 2 * dim + 2 * a + side[a];
            if (l->link[link] > 0) at[k] = l->next[link];
        }
        if (at[k] < 0) w[k] = 0;
        if (at[k] >= 0 && kappa > l->kappa[at[k]]) w[k] *= l->kappa[at[k]] / kappa;
        sum += w[k];
    }
    for (int k = 0; k < corners; k++) {
        share[k] = (float)(sum > 0 ? w[k] / sum : k == 0);
        if (at[k] < 0) at[k] = home;
    }
}

static void set_shares(const mps__grid *g, mps__grid_level *l, int64_t point, const double *far,
                       const int *side)
{
    if (g->dim == 2)
        set_shares_of(2, g, l, point, far, side);
    else
        set_shares_of(3, g, l, point, far, side);
}

static void share_particle(const mps__grid *g, mps__grid_level *l, const mps_ppe_problem *problem,
                           int64_t i)
{
    double far[3];
    int side[3];
    for (int a = 0; a < g->dim; a++) {
        double u = position(g, problem, i, a), f = u - floor(u) - 0.5;
        side[a] = f > 0;
        far[a] = fabs(f);
    }
    set_shares(g, l, i, far, side);
}

/* What holds the pressure's level, to the cells that the particle takes its value from: a cell filled at its edge only would
 * otherwise hold a value that no particle has. */
static void share_shift(const mps__grid *g, mps__grid_level *l, int64_t i, double shift)
{
    const int32_t *at = l->at + (i << g->dim);
    const float *share = l->share + (i << g->dim);
    for (int k = 0; k < 1 << g->dim; k++) l->shift[at[k]] += (double)share[k] * shift;
}

/* Links of one chunk of the rows. */
static void add_chunk(void *argument, int32_t chunk)
{
    const making *m = argument;
    const int64_t n = m->problem->n, links = m->l->cells * 2 * m->g->dim;
    float *part = (float *)m->g->parts + chunk * links;
    memset(part, 0, (size_t)links * sizeof *part);
    for (int64_t i = mps__grid_chunk(n, chunk); i < mps__grid_chunk(n, chunk + 1); i++)
        add_row(m->g, m->l, m->problem, i, part);
}

static void sum_links(void *argument, int64_t begin, int64_t end)
{
    const making *m = argument;
    const int64_t links = m->l->cells * 2 * m->g->dim;
    const float *parts = m->g->parts;
    for (int64_t k = begin; k < end; k++)
        for (int c = 0; c < MPS__GRID_CHUNKS; c++) m->l->link[k] += parts[c * links + k];
}

/* Links of the first grid: each chunk of the rows has its own, their sums have a fixed order. */
static void add_rows(making *m)
{
    const mps_parallel *team = mps__team(m->problem->parallel, m->problem->n);
    mps_parallel_run(team, MPS__GRID_CHUNKS, add_chunk, m);
    mps_parallel_rows(team, m->l->cells * 2 * m->g->dim, sum_links, m);
}

/* Links where there is one density, without a walk over the pairs: a cell conducts as much as its particles, sum k_ij r_ij^2 /
 * (2 D size^2), and a face as much as the geometric mean of its two cells. Stiffer links save an iteration: the inverse diagonal has its
 * share of the smooth pressures already. */
static void link_cells(const mps__grid *g, mps__grid_level *l, const mps_ppe_problem *problem)
{
    const int sides = 2 * g->dim;
    const double c = stiffer * g->unit * g->per_size * g->per_size / sides;
    double *conductance = l->x;
    for (int64_t k = 0; k < l->cells; k++) conductance[k] = 0;
    for (int64_t i = 0; i < problem->n; i++)
        conductance[l->home[i]] += c * g->point_kappa[i] *
                                   (double)(problem->row[i + 1] - problem->row[i]);
    for (int64_t k = 0; k < l->cells * sides; k++) {
        const int64_t cell = k / sides, other = l->next[k];
        if (other != cell) l->link[k] = (float)sqrt(conductance[cell] * conductance[other]);
    }
}

/* Shares of the particles, and which cells of each colour a chunk of them reaches. */
static void share_chunk(void *argument, int32_t chunk)
{
    const making *m = argument;
    mps__grid *g = m->g;
    mps__grid_level *l = m->l;
    const mps_ppe_problem *problem = m->problem;
    int32_t range[2][2] = {{INT32_MAX, 0}, {INT32_MAX, 0}};
    for (int64_t i = mps__grid_chunk(problem->n, chunk); i < mps__grid_chunk(problem->n, chunk + 1);
         i++) {
        share_particle(g, l, problem, i);
        for (int64_t k = i << g->dim; k < (i + 1) << g->dim; k++) {
            int32_t *r = range[l->at[k] >= l->red];
            if (l->at[k] < r[0]) r[0] = l->at[k];
            if (l->at[k] >= r[1]) r[1] = l->at[k] + 1;
        }
    }
    memcpy(g->range[chunk], range, sizeof range);
}

bool mps__grid_from_matrix(mps__grid *g, const mps_ppe_problem *problem)
{
    mps__grid_level *l = &g->level[0];
    making m = {.g = g, .l = l, .problem = problem};
    if (!mps__grid_reserve_parts(g)) return false;
    for (int64_t i = 0; i < problem->n; i++) {
        int32_t c = l->home[i];
        l->kappa[c] += g->point_kappa[i];
        l->count[c] += 1;
    }
    for (int64_t c = 0; c < l->cells; c++) l->kappa[c] /= l->count[c];
    if (g->one)
        link_cells(g, l, problem);
    else
        add_rows(&m);
    mps_parallel_run(mps__team(problem->parallel, problem->n), MPS__GRID_CHUNKS, share_chunk, &m);
    for (int64_t i = 0; i < problem->n; i++)
        if (problem->shift[i] > 0) share_shift(g, l, i, problem->shift[i] * g->unit);
    return true;
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
        if (fine->link[link] > 0 && other != home)
            join(g, l, (int64_t)home * 2 * g->dim + 2 * a + 1, 0.5f * fine->link[link], l->link);
    }
}

static void from_finer(mps__grid *g, const mps__grid_level *fine, mps__grid_level *l)
{
    static const double far[3] = {0.25, 0.25, 0.25};
    for (int64_t c = 0; c < fine->cells; c++)
        if (l->home[c] >= 0) add_cell(g, fine, l, c);
    for (int64_t c = 0; c < l->cells; c++) l->kappa[c] /= l->count[c];
    for (int64_t c = 0; c < fine->cells; c++) {
        int side[3];
        for (int a = 0; a < g->dim; a++) side[a] = (int)(mps__grid_coordinate(fine->key[c], a) & 1);
        if (l->home[c] >= 0) set_shares(g, l, c, far, side);
    }
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

/* SPDX-License-Identifier: BSD-3-Clause */
/* What models of surface tension share: the curvature of contours, W22 (21)-(23), by the first and second derivatives at i of
 *   f(x) = sum C_j G / sum G,  G = exp(-9 r^2/rs^2),  kappa = div(grad f/|grad f|).
 * Here C_j = 0 for the phase of i and 1 for all others: between two phases the factor of (20) cancels in kappa. kappa is positive
 * where the interface bends around i's own phase, so that the pressure is higher inside of a drop; W22 (22) has the other sign,
 * with which drops would swell. Where three phases meet each one sees the contour between itself and all others.
 * Solids belong to no phase: fluid alone makes f, which is a contact angle of 90 degrees. f sees through thin plates.
 *
 * rs decides the noise: kappa is a second derivative of steps. Circle of radius 10.5 dp cut from a
 * lattice, mean of kappa weighted by |grad C| and its scatter from particle to particle: rs = 4.1: +0.9 %, 150 %; 6.1: +0.4 %, 57 %;
 * 8.1: +0.2 %, 28 %; 10.1: 0, 16 %; 12.1: -0.1 %, 9 %; the same on a disordered lattice. Sphere of 6.3 dp: 4.1: +0.4 %, 40 %; 6.1: -0.2 %,
 * 12 %; 8.1: -0.5 %, 5 %. Films and drops thinner than about rs/2 are smeared.
 * rs is larger than the radii of the simulation: neighbours are found by a grid of cells of side rs. */
#include "tension.h"

/* Fluid by cells, the cells by a hash: chains of particles. Indices are kept as doubles, which scratch is made of. */
typedef struct cell_grid {
    double *first, *next; /* [buckets], [n]: index + 1; 0: none */
    int64_t buckets;
    double side;
} cell_grid;

/* Sums of G, of G (C_j - C_i), and of their first and second derivatives by x_i. */
typedef struct contour_sums {
    double g, g1[3], g2[9], c, c1[3], c2[9];
} contour_sums;

static void cell_of(const mps_stage *s, const cell_grid *grid, int64_t i, int64_t cell[3])
{
    cell[2] = 0;
    for (int d = 0; d < s->dim; d++) cell[d] = (int64_t)floor(s->x[i * s->dim + d] / grid->side);
}

static int64_t bucket_of(const cell_grid *grid, const int64_t cell[3])
{
    const uint64_t h = (uint64_t)cell[0] * UINT64_C(73856093) ^ (uint64_t)cell[1] * UINT64_C(19349663) ^
                       (uint64_t)cell[2] * UINT64_C(83492791);
    return (int64_t)(h % (uint64_t)grid->buckets);
}

/* False when memory is out. */
static bool build_grid(mps_stage *s, cell_grid *grid)
{
    grid->buckets = s->n;
    grid->first = mps_stage_scratch(s, grid->buckets);
    grid->next = mps_stage_scratch(s, s->n);
    if (!grid->first || !grid->next) return false;
    for (int64_t i = s->n - 1; i >= 0; i--) {
        int64_t cell[3];
        if (s->kind[i] != MPS_FLUID) continue;
        cell_of(s, grid, i, cell);
        const int64_t b = bucket_of(grid, cell);
        grid->next[i] = grid->first[b];
        grid->first[b] = (double)(i + 1);
    }
    return true;
}

MPS__ROW void add_neighbour(const int dim, const mps_stage *s, double decay, int64_t i, int64_t j, contour_sums *m)
{
    double r[3], r2 = 0;
    for (int d = 0; d < dim; d++) {
        r[d] = s->x[j * dim + d] - s->x[i * dim + d];
        r2 += r[d] * r[d];
    }
    if (decay * r2 >= 9.0) return;
    const double g = exp(-decay * r2), c = s->phase[j] != s->phase[i] ? 1.0 : 0.0;
    m->g += g;
    m->c += g * c;
    for (int d = 0; d < dim; d++) {
        const double first = 2.0 * decay * r[d] * g;
        m->g1[d] += first;
        m->c1[d] += first * c;
        for (int e = 0; e < dim; e++) {
            const double second = 2.0 * decay * (first * r[e] - (d == e ? g : 0.0));
            m->g2[d * dim + e] += second;
            m->c2[d * dim + e] += second * c;
        }
    }
}

static void collect(const mps_stage *s, const cell_grid *grid, int64_t i, contour_sums *m)
{
    const double decay = 9.0 / (grid->side * grid->side);
    const int cells = s->dim == 2 ? 9 : 27;
    int64_t home[3];
    *m = (contour_sums){0};
    cell_of(s, grid, i, home);
    for (int k = 0; k < cells; k++) {
        const int64_t cell[3] = {home[0] + k % 3 - 1, home[1] + k / 3 % 3 - 1, s->dim == 3 ? home[2] + k / 9 - 1 : 0};
        for (int64_t j = (int64_t)grid->first[bucket_of(grid, cell)] - 1; j >= 0; j = (int64_t)grid->next[j] - 1) {
            int64_t of[3];
            cell_of(s, grid, j, of); /* other cells may share the bucket */
            if (of[0] == cell[0] && of[1] == cell[1] && of[2] == cell[2]) MPS__ROW_CALL(s, add_neighbour, s, decay, i, j, m);
        }
    }
}

/* kappa from f = c/g: f' = (c' - f g')/g, f'' = (c'' - f g'' - f' g' - g' f')/g; 0 away from interfaces. A contour bends at most
 * once about a particle: |kappa| <= (D-1)/dp. */
static double curvature(const mps_stage *s, const contour_sums *m, double threshold)
{
    const int dim = s->dim;
    const double f = m->c / m->g, most = (dim - 1) / s->dp;
    double f1[3], size2 = 0, sum = 0;
    for (int d = 0; d < dim; d++) {
        f1[d] = (m->c1[d] - f * m->g1[d]) / m->g;
        size2 += f1[d] * f1[d];
    }
    if (!(sqrt(size2) * s->dp > threshold)) return 0;
    for (int d = 0; d < dim; d++)
        for (int e = 0; e < dim; e++) {
            const double f2 = (m->c2[d * dim + e] - f * m->g2[d * dim + e] - f1[d] * m->g1[e] - m->g1[d] * f1[e]) / m->g;
            sum += f2 * ((d == e ? size2 : 0.0) - f1[d] * f1[e]);
        }
    return fmin(fmax(sum / (size2 * sqrt(size2)), -most), most);
}

/* Has a particle of another phase in its row. */
static bool at_interface(const mps_stage *s, const mps_stencil *t, int64_t i)
{
    if (s->kind[i] != MPS_FLUID) return false;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        if (s->kind[j] == MPS_FLUID && s->phase[j] != s->phase[i]) return true;
    }
    return false;
}

static bool one_phase(const mps_stage *s)
{
    int32_t phase = -1;
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_FLUID) continue;
        if (phase >= 0 && s->phase[i] != phase) return false;
        phase = s->phase[i];
    }
    return true;
}

bool mps__curvatures(mps_stage *s, const mps_stencil *pairs, double radius, double threshold, double *kappa)
{
    cell_grid grid = {.side = radius * s->dp};
    if (one_phase(s)) return true;
    if (!build_grid(s, &grid)) return false;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        contour_sums m;
        if (!at_interface(s, pairs, i)) continue;
        collect(s, &grid, i, &m);
        kappa[i] = curvature(s, &m, threshold);
    }
    return true;
}

double mps__pair_sigma(const mps_stage *s, int32_t a, int32_t b, double other)
{
    const double own = s->tension[a * MPS__PHASE_LIMIT + b];
    return own >= 0 ? own : other;
}

double mps__tension_dt(const mps_stage *s, double other)
{
    const double pi = 3.14159265358979323846;
    double rho[MPS__PHASE_LIMIT], limit = INFINITY;
    mps__phase_densities(s, rho);
    for (int a = 0; a < MPS__PHASE_LIMIT; a++)
        for (int b = 0; b < a; b++) {
            const double sigma = mps__pair_sigma(s, a, b, other);
            if (rho[a] == 0 || rho[b] == 0 || sigma == 0) continue;
            limit = fmin(limit, 0.5 * sqrt(0.5 * (rho[a] + rho[b]) * pow(s->dp, 3) / (2.0 * pi * sigma)));
        }
    return limit;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Curvature of interfaces by contours, W22 (21)-(23), W22: Wen, Zhao & Wan 2022: from the first and
 * second derivatives at i of
 *   f(x) = sum C_j G / sum G,  G = exp(-9 r^2/r_s^2),  kappa = div(grad f/|grad f|).
 * C_j = 0 for the phase of i and 1 for all others: between two phases the factor of (20) cancels in
 * kappa. kappa is positive if the interface bends around i's own phase, so that the pressure is
 * higher inside a droplet; with the sign of W22 (22) droplets would swell. Where three phases meet,
 * the contour of each one is that between itself and all others. Solids have no phase: f is made of
 * fluid only, which gives a contact angle of 90 degrees. Thin plates do not truncate f.
 *
 * r_s determines the noise, because kappa is a second derivative of a step function. Circle of
 * radius 10.5 dp cut from a lattice: error of the mean of kappa weighted by |grad C|, and scatter
 * between particles. A disordered lattice gives the same. Films and droplets thinner than about
 * r_s/2 are smeared.
 *   r_s/dp              4.1     6.1     8.1    10.1    12.1
 *   circle, mean     +0.9 %  +0.4 %  +0.2 %    0     -0.1 %
 *   circle, scatter   150 %    57 %    28 %   16 %      9 %
 *   sphere of 6.3 dp, mean      +0.4 %  -0.2 %  -0.5 %
 *   sphere of 6.3 dp, scatter     40 %    12 %     5 % */
#include "tension.h"

/* Sums of G, of G (C_j - C_i), and of their first and second derivatives by x_i. */
typedef struct contour_sums {
    double g, g1[3], g2[9], c, c1[3], c2[9];
} contour_sums;

typedef struct fields {
    mps_grid grid;
    double threshold;
    int32_t which; /* MPS_NEAR or MPS_FAR: the pairs that define an interface */
    double *kappa;
} fields;

MPS_ROW void add_neighbour(const int dim, const mps_view *v, double decay, int64_t i, int64_t j,
                           contour_sums *m)
{
    double r[3], r2 = 0;
    for (int d = 0; d < dim; d++) {
        r[d] = v->x[j * dim + d] - v->x[i * dim + d];
        r2 += r[d] * r[d];
    }
    if (decay * r2 >= 9.0) return;
    const double g = mps_exp(-decay * r2), c = v->phase[j] != v->phase[i] ? 1.0 : 0.0;
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

/* r_s is larger than the radii of the simulation: a grid of cells of side r_s finds neighbours. */
MPS_ROW void collect(const int dim, const mps_view *v, const mps_grid *grid, int64_t i,
                     contour_sums *m)
{
    const double decay = 9.0 / (grid->side * grid->side);
    const int cells = dim == 2 ? 9 : 27;
    int64_t home[3];
    *m = (contour_sums){0};
    mps_grid_cell(grid, v->x + i * dim, home);
    for (int k = 0; k < cells; k++) {
        const int64_t cell[3] = {home[0] + k % 3 - 1, home[1] + k / 3 % 3 - 1,
                                 dim == 3 ? home[2] + k / 9 - 1 : 0};
        for (int64_t j = grid->first[mps_grid_bucket(grid, cell)] - 1; j >= 0;
             j = grid->next[j] - 1) {
            int64_t of[3];
            /* particles of other cells may be in the same bucket */
            mps_grid_cell(grid, v->x + j * dim, of);
            if (of[0] != cell[0] || of[1] != cell[1] || of[2] != cell[2]) continue;
            add_neighbour(dim, v, decay, i, j, m);
        }
    }
}

/* kappa from f = c/g: f' = (c' - f g')/g, f'' = (c'' - f g'' - f' g' - g' f')/g; 0 away from
 * interfaces. The lattice resolves no smaller radius than dp: |kappa| <= (D-1)/dp. */
MPS_ROW double curvature(const int dim, const mps_view *v, const contour_sums *m, double threshold)
{
    const double f = m->c / m->g, most = (dim - 1) / v->dp;
    double f1[3], size2 = 0, sum = 0;
    for (int d = 0; d < dim; d++) {
        f1[d] = (m->c1[d] - f * m->g1[d]) / m->g;
        size2 += f1[d] * f1[d];
    }
    if (!(sqrt(size2) * v->dp > threshold)) return 0;
    for (int d = 0; d < dim; d++)
        for (int e = 0; e < dim; e++) {
            const int k = d * dim + e;
            const double f2 = (m->c2[k] - f * m->g2[k] - f1[d] * m->g1[e] - m->g1[d] * f1[e]) /
                              m->g;
            sum += f2 * ((d == e ? size2 : 0.0) - f1[d] * f1[e]);
        }
    return mps_smaller(mps_larger(sum / (size2 * sqrt(size2)), -most), most);
}

/* True for fluid with fluid of another phase among its pairs. */
MPS_ROW bool at_interface(const mps_view *v, const mps_stencil *t, int64_t i)
{
    if (!mps_is_fluid(v, i)) return false;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (mps_is_fluid(v, j) && v->phase[j] != v->phase[i]) return true;
    }
    return false;
}

MPS_ROW void find_curvature(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    if (!(f->which == MPS_NEAR ? at_interface(v, &v->near, i) : at_interface(v, &v->far, i)))
        return;
    contour_sums m;
    collect(dim, v, &f->grid, i, &m);
    f->kappa[i] = curvature(dim, v, &m, f->threshold);
}
MPS_ROWS(find_curvature_rows, find_curvature, fields)

static bool several_phases(const mps_stage *s)
{
    double rho[MPS_PHASES];
    int phases = 0;
    mps_stage_densities(s, rho, NULL);
    for (int p = 0; p < MPS_PHASES; p++) phases += rho[p] > 0;
    return phases > 1;
}

int mps__curvatures(mps_stage *s, int32_t which, double radius, double threshold, double *kappa)
{
    fields f = {{.struct_size = sizeof f.grid}, threshold, which, kappa};
    if (!several_phases(s)) return 0;
    if (mps_stage_grid(s, radius * s->view->dp, &f.grid)) return 1;
    mps_stage_rows(s, &find_curvature_rows, &f);
    return 0;
}

double mps__pair_sigma(const mps_view *v, int32_t a, int32_t b, double other)
{
    const double own = v->tension[a * MPS_PHASES + b];
    return own >= 0 ? own : other;
}

void mps__tension_limit(mps_stage *s, double other)
{
    const double pi = 3.14159265358979323846;
    double rho[MPS_PHASES];
    mps_stage_densities(s, rho, NULL);
    for (int a = 0; a < MPS_PHASES; a++)
        for (int b = 0; b < a; b++) {
            const double sigma = mps__pair_sigma(s->view, a, b, other);
            if (rho[a] == 0 || rho[b] == 0 || sigma == 0) continue;
            const double mean = 0.5 * (rho[a] + rho[b]);
            const double limit = 0.5 * sqrt(mean * mps_pow(s->view->dp, 3) / (2.0 * pi * sigma));
            if (limit < s->dt_limit) s->dt_limit = limit;
        }
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Faces of gas pockets: volume, flux, and the pressures on the liquid behind them. e: direction of
 * a face, out of the void; A: its area; i: the particle behind it. */
#include "gas_pocket.h"

/* ---- faces sorted by row ---- */

static void count_faces(const mps_voids *v, int64_t n, int32_t *begin)
{
    for (int64_t f = 0; f < v->faces; f++)
        if (v->face_row[f] >= 0) begin[v->face_row[f] + 1]++;
    for (int64_t i = 0; i < n; i++) begin[i + 1] += begin[i];
}

int mps__pocket_sort(mps_stage *s, mps__pocket_faces *f)
{
    const mps_voids *v = &f->voids;
    int32_t *begin = mps_stage_scratch_integers(s, s->view->n + 2);
    int32_t *face = mps_stage_scratch_integers(s, v->faces + 1);
    if (!begin || !face) return 1;
    /* begin[i + 1] is the write position of row i, so that at the end row i + 1 begins there */
    count_faces(v, s->view->n, begin + 1);
    for (int64_t k = 0; k < v->faces; k++)
        if (v->face_row[k] >= 0) face[begin[v->face_row[k] + 1]++] = (int32_t)k;
    f->begin = begin;
    f->face = face;
    return 0;
}

static double area_of(const mps_voids *v)
{
    return v->dim == 2 ? v->side : v->side * v->side;
}

/* Axis of a face; 1 or -1: direction along it. */
static inline double direction(const mps_voids *v, int32_t face, int32_t *axis)
{
    *axis = v->face_side[face] / 2;
    return v->face_side[face] % 2 ? 1.0 : -1.0;
}

/* Centre of a face in the tank frame. */
MPS_ROW void face_centre(const int dim, const mps_voids *v, int32_t face, double *x)
{
    int32_t axis;
    const double sign = direction(v, face, &axis);
    int64_t rest = v->face_cell[face];
    for (int d = 0; d < dim; d++) {
        x[d] = v->origin[d] + ((double)(rest % v->cells[d]) + 0.5) * v->side;
        rest /= v->cells[d];
        if (d == axis) x[d] += 0.5 * sign * v->side;
    }
}

/* Transform a vector from the tank frame to the lab frame. */
MPS_ROW void to_lab(const int dim, const mps_view *v, const double *X, double *x)
{
    for (int d = 0; d < dim; d++) {
        x[d] = 0;
        for (int e = 0; e < dim; e++) x[d] += v->tank.rotation[3 * d + e] * X[e];
    }
}

/* The particle whose surface a face is: the one behind it. At the contact line that is a wall
 * particle, and the surface belongs to the nearest fluid. -1: a face towards a wall. */
MPS_ROW int64_t surface_of(const int dim, const mps_view *v, const mps__pocket_faces *f, int64_t i,
                           int32_t axis)
{
    const mps_stencil *t = &v->near;
    double along[3], lab[3] = {0}, size = 0, normal = 0, least = INFINITY;
    int64_t nearest = -1;
    if (mps_is_fluid(v, i)) return i;
    for (int d = 0; d < 3; d++) along[d] = d == axis;
    to_lab(dim, v, along, lab);
    for (int d = 0; d < dim; d++) {
        size += v->area[i * dim + d] * v->area[i * dim + d];
        normal += v->area[i * dim + d] * lab[d];
    }
    if (normal * normal > 0.5 * size) return -1;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (!mps_is_fluid(v, j) || mps_region_of(f->region, j) == MPS_REGION_SPRAY) continue;
        const double r2 = mps_stencil_pair_dim(dim, t, i, p).r2;
        if (r2 > least || (r2 == least && v->id[j] > v->id[nearest])) continue;
        least = r2;
        nearest = j;
    }
    return nearest;
}

/* ---- sums over faces ---- */

enum { PAIR = MPS_PARALLEL_VALUES / 2 };

/* Terms of volumes: e.(x_i - x_f) A, and the surface area of each particle.
 *
 * Volume. A layer of particles is dp/2 behind the surface of the liquid:
 *
 *   V = cells + sum_f A e.(x_i - x_f) - dp/2 S,   S = sum_i |sum_f of i A e|.
 *
 * The sum of the first two terms does not change when a cell changes between void and liquid at a
 * flat surface; between such changes its rate is the flux sum_f A e.u_i. */
MPS_ROW void add_volume(const int dim, const mps_view *v, const mps__pocket_faces *f, int64_t i,
                        double *sums)
{
    if (f->begin[i] == f->begin[i + 1]) return;
    double normal[PAIR][3] = {{0}};
    for (int32_t k = f->begin[i]; k < f->begin[i + 1]; k++) {
        const int32_t face = f->face[k], label = f->voids.face_label[face] - f->from;
        int32_t axis;
        double at[3], place[3] = {0};
        if (label < 0 || label >= PAIR) continue;
        const double sign = direction(&f->voids, face, &axis);
        const int64_t j = surface_of(dim, v, f, i, axis);
        if (j < 0) continue;
        face_centre(dim, &f->voids, face, at);
        mps_view_tank(v, v->x + j * dim, place, NULL);
        for (int d = 0; d < dim; d++)
            if (d == axis) sums[2 * label] += sign * (place[d] - at[d]);
        normal[label][axis] += sign;
    }
    for (int k = 0; k < PAIR; k++) {
        double size = 0;
        for (int d = 0; d < dim; d++) size += normal[k][d] * normal[k][d];
        if (size > 0) sums[2 * k + 1] += sqrt(size);
    }
}
MPS_SUMS(add_volumes, add_volume, mps__pocket_faces)

/* Number of components summed by one loop over the rows; each costs time in all rows. */
static int32_t batch_of(const mps__pocket_faces *f)
{
    const int32_t left = f->voids.count - f->from;
    return left < PAIR ? left : PAIR;
}

void mps__pocket_volumes(mps_stage *s, mps__pocket_faces *f, double *volume)
{
    const mps_voids *v = &f->voids;
    const double area = area_of(v), cell = area * v->side;
    for (f->from = 0; f->from < v->count; f->from += PAIR) {
        double sums[2 * PAIR];
        const int32_t batch = batch_of(f);
        mps_stage_sum(s, 2 * batch, &add_volumes, f, sums);
        for (int32_t k = 0; k < batch; k++) {
            const double cells = v->size[f->from + k] * cell;
            const double whole = cells + area * (sums[2 * k] - 0.5 * s->view->dp * sums[2 * k + 1]);
            volume[f->from + k] = mps_larger(whole, cells);
        }
    }
}

/* Velocity gradient around particle i: change_d = sum_e rise[d][e] (x_e - x_i_e). 0 beside walls:
 * the moment matrix contains them, and their velocity along the face is not that of the fluid. */
MPS_ROW void velocity_rise(const int dim, const mps_view *v, const mps__pocket_faces *f, int64_t i,
                           double rise[3][3])
{
    const mps_stencil *t = &v->near;
    const double *b = f->correction + i * dim * dim;
    double raw[3][3] = {{0}};
    for (int d = 0; d < 3; d++)
        for (int e = 0; e < 3; e++) rise[d][e] = 0;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (mps_region_of(f->region, j) >= MPS_REGION_SPRAY) continue;
        if (!mps_is_fluid(v, j)) return;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        for (int d = 0; d < dim; d++) {
            const double change = q.w_r2 * (f->velocity[j * dim + d] - f->velocity[i * dim + d]);
            for (int e = 0; e < dim; e++) raw[d][e] += change * q.d[e];
        }
    }
    for (int d = 0; d < dim; d++)
        for (int e = 0; e < dim; e++)
            for (int k = 0; k < dim; k++) rise[d][e] += dim / t->n0 * raw[d][k] * b[k * dim + e];
}

/* Centre of a face in the lab frame. */
MPS_ROW void face_place(const int dim, const mps_view *v, const mps_voids *voids, int32_t face,
                        double *x)
{
    double at[3] = {0};
    face_centre(dim, voids, face, at);
    for (int d = 0; d < dim; d++) at[d] -= v->tank.centre[d];
    to_lab(dim, v, at, x);
    for (int d = 0; d < dim; d++) x[d] += v->tank.centre[d] + v->tank.shift[d];
}

/* Unit vector, in the lab frame, along the sum of the faces between a row and a component; 0:
 * none. */
MPS_ROW void normal_of(const int dim, const mps_view *v, const mps__pocket_faces *f, int64_t i,
                       int32_t component, double *n)
{
    double own[3] = {0}, size = 0;
    for (int32_t k = f->begin[i]; k < f->begin[i + 1]; k++) {
        int32_t axis;
        const double sign = direction(&f->voids, f->face[k], &axis);
        if (f->voids.face_label[f->face[k]] != component) continue;
        for (int d = 0; d < dim; d++)
            if (d == axis) own[d] += sign;
    }
    for (int d = 0; d < 3; d++) size += own[d] * own[d];
    for (int d = 0; d < 3; d++) own[d] = size > 0 ? own[d] / sqrt(size) : 0;
    to_lab(dim, v, own, n);
}

/* e.(u - u_tank) of fluid particle j, extrapolated to a face with `rise`. */
MPS_ROW double face_flux(const int dim, const mps_view *v, const mps__pocket_faces *f, int64_t j,
                         int32_t face, double rise[3][3])
{
    int32_t axis;
    double tank[3] = {0}, along[3], lab[3] = {0}, x[3] = {0}, flux = 0;
    const double sign = direction(&f->voids, face, &axis);
    for (int d = 0; d < 3; d++) along[d] = d == axis ? sign : 0;
    to_lab(dim, v, along, lab);
    mps_view_tank(v, v->x + j * dim, NULL, tank);
    face_place(dim, v, &f->voids, face, x);
    for (int d = 0; d < dim; d++) {
        double u = f->velocity[j * dim + d] - tank[d];
        for (int e = 0; e < dim; e++) u += rise[d][e] * (x[e] - v->x[j * dim + e]);
        flux += u * lab[d];
    }
    return flux;
}

/* Trace-free `rise`, for the faces between a row of fluid and a component. Returns the trace, div
 * u. */
MPS_ROW double row_rise(const int dim, const mps_view *v, const mps__pocket_faces *f, int64_t i,
                        int32_t component, double rise[3][3])
{
    double n[3], lost = 0;
    velocity_rise(dim, v, f, i, rise);
    normal_of(dim, v, f, i, component, n);
    for (int d = 0; d < dim; d++) lost += rise[d][d];
    for (int d = 0; d < dim; d++)
        for (int e = 0; e < dim; e++) rise[d][e] -= lost * n[d] * n[e];
    return lost;
}

/* Whether face k of a row is not its first face with its component. */
static inline bool is_again(const mps__pocket_faces *f, int64_t i, int32_t k)
{
    for (int32_t m = f->begin[i]; m < k; m++)
        if (f->voids.face_label[f->face[m]] == f->voids.face_label[f->face[k]]) return true;
    return false;
}

/* Terms of fluxes: of all faces, and of those of fluid particles themselves, from behind the layer;
 * the latter are added at the first face with a component. Fluid beside a wall has no rise.
 *
 * Flux. The surface layer has a given pressure and no equation for its divergence. The liquid must
 * keep its volume nevertheless: the flux is that from behind the layer, through the particle, plus
 * the expansion of the half of the layer behind it, dp^dim/2 div u. Without this term a round
 * pocket, whose surface is a staircase of the lattice, has 7 % less flux than the liquid, which
 * gains energy from it. u is extrapolated from the particle to the faces, less div u along the
 * normal n of the layer: R - div u n n has no trace, so that the flux does not depend on the cells
 * in front of the layer and does not jump when the surface moves by a cell. */
MPS_ROW void add_flux(const int dim, const mps_view *v, const mps__pocket_faces *f, int64_t i,
                      double *sums)
{
    if (f->begin[i] == f->begin[i + 1]) return;
    for (int32_t k = f->begin[i]; k < f->begin[i + 1]; k++) {
        const int32_t face = f->face[k], label = f->voids.face_label[face] - f->from;
        double rise[3][3] = {{0}}, flux = 0, lost = 0;
        int32_t axis;
        if (label < 0 || label >= PAIR || f->voids.face_label[face] == f->aside) continue;
        direction(&f->voids, face, &axis);
        const int64_t j = surface_of(dim, v, f, i, axis);
        if (j < 0 || (j == i && is_again(f, i, k))) continue;
        if (j == i) lost = row_rise(dim, v, f, i, label + f->from, rise);
        for (int32_t m = k; m < (j == i ? f->begin[i + 1] : k + 1); m++)
            if (f->voids.face_label[f->face[m]] == label + f->from)
                flux += face_flux(dim, v, f, j, f->face[m], rise);
        flux += 0.5 * lost * f->row_volume;
        sums[2 * label] += flux;
        if (j == i) sums[2 * label + 1] += flux;
    }
}
MPS_SUMS(add_fluxes, add_flux, mps__pocket_faces)

void mps__pocket_fluxes(mps_stage *s, mps__pocket_faces *f, double *flux, double *fluid)
{
    const double area = area_of(&f->voids);
    f->row_volume = mps__pocket_power(s->view->dp, f->voids.dim) / area;
    for (f->from = 0; f->from < f->voids.count; f->from += PAIR) {
        double sums[2 * PAIR];
        const int32_t batch = batch_of(f);
        mps_stage_sum(s, 2 * batch, &add_fluxes, f, sums);
        for (int32_t k = 0; k < batch; k++) {
            flux[f->from + k] = area * sums[2 * k];
            fluid[f->from + k] = area * sums[2 * k + 1];
        }
    }
}

void mps__pocket_areas(const mps__pocket_faces *f, double *area)
{
    const mps_voids *v = &f->voids;
    for (int64_t k = 0; k < v->faces; k++)
        if (v->face_behind[k] != MPS_VOID_SOLID) area[v->face_label[k]] += area_of(v);
}

/* ---- pressures of rows ---- */

/* Number of liquid cells behind a face up to another component; -1: a wall is met first. */
static int32_t march(const mps_voids *v, int32_t face, int32_t *other)
{
    int32_t axis, count = 0;
    const double sign = direction(v, face, &axis);
    int64_t stride = 1, place = v->face_cell[face];
    for (int32_t d = 0; d < axis; d++) {
        stride *= v->cells[d];
        place /= v->cells[d];
    }
    place %= v->cells[axis];
    const int64_t most = sign > 0 ? v->cells[axis] - 1 - place : place;
    const int32_t *label = v->label + v->face_cell[face];
    if (sign < 0) stride = -stride;
    while (count < most && label[(count + 1) * stride] == MPS_VOID_NONE) count++;
    if (count == most) return -1;
    *other = label[(count + 1) * stride];
    return *other == MPS_VOID_SOLID ? -1 : count;
}

/* Thickness of a film along a unit vector of the lab frame: from particle i to the farthest
 * particle of the film, plus half a spacing on both sides. */
MPS_ROW double thickness(const int dim, const mps_view *v, const mps__pocket_faces *f, int64_t i,
                         const double *n)
{
    const mps_stencil *t = &v->near;
    const double aside = 0.75 * v->dp;
    double most = 0, least = 0;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i); p++) {
        const int64_t j = mps_stencil_column(t, p);
        if (!mps_is_fluid(v, j) || mps_region_of(f->region, j) == MPS_REGION_SPRAY) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, t, i, p);
        double along = 0;
        for (int d = 0; d < dim; d++) along += q.d[d] * n[d];
        if (q.r2 - along * along > aside * aside) continue;
        most = mps_larger(most, along);
        least = mps_smaller(least, along);
    }
    return most - least + v->dp;
}

/* Number of a component's pocket; 0: no pocket. */
static inline double number_of(const mps__pocket_faces *f, int32_t label)
{
    return f->pocket[label].gas > 0 ? f->pocket[label].number : 0;
}

/* Sums over the faces of a row. */
typedef struct contact {
    double pressure, faces;
    double number;           /* of the last pocket that closed; 0: no pocket in front of the row */
    double out[3], count[3]; /* sum of directions out of the liquid; faces along each axis */
    double slope[3];         /* by axis: sum of (p' - p)/T_d */
    double inverse[3];       /* by axis: sum of 1/T_d */
} contact;

MPS_ROW contact sum_faces(const int dim, const mps_view *v, const mps__pocket_faces *f, int64_t i)
{
    contact c = {0};
    for (int32_t k = f->begin[i]; k < f->begin[i + 1]; k++) {
        const int32_t face = f->face[k];
        const double own = f->pressure[f->voids.face_label[face]];
        int32_t axis, other = -1;
        const double sign = direction(&f->voids, face, &axis);
        const int32_t cells = march(&f->voids, face, &other);
        c.pressure += own;
        c.number = mps_larger(c.number, number_of(f, f->voids.face_label[face]));
        c.faces++;
        const bool is_film = cells >= 0 && other != f->voids.face_label[face];
        const double thick = mps_larger(0.5 * v->dp, cells * f->voids.side + v->dp - 2 * f->cover);
        for (int d = 0; d < dim; d++) {
            if (d != axis) continue;
            c.out[d] -= sign;
            c.count[d]++;
            if (!is_film) continue;
            c.slope[d] += sign * (f->pressure[other] - own) / thick;
            c.inverse[d] += 1 / thick;
        }
    }
    return c;
}

/* Thickness of films within the near radius: their thickness in the raster is too inaccurate. */
static const double THIN = 2.5;

/* Gradient in a film, lab frame. @return n.G dp/2
 *
 * Films. Across a film of thickness T between pressures p and p' the pressure is linear, so the
 * particle half a spacing behind the face of p has
 *
 *   p_i = p - dp/2 n.G,   G = gradient: (p' - p)/T along the normal,
 *
 * n out of the liquid. From a face along axis d the film is T/|n_d| thick, so G_d is the mean of
 * (p' - p)/T_d over the faces along d. A particle with faces on both sides has the mean of all of
 * them, and in a film of one layer no neighbour has the slope: gas_pocket.c. */
MPS_ROW double film(const int dim, const mps_view *v, const mps__pocket_faces *f, int64_t i,
                    const contact *c, double *slope)
{
    double own[3] = {0}, size = 0, inverse = 0, faces = 0, rise = 0, n[3];
    for (int d = 0; d < dim; d++) {
        if (c->count[d] == 0) continue;
        own[d] = c->slope[d] / c->count[d];
        size += own[d] * own[d];
        inverse += c->inverse[d] / c->count[d] * (c->inverse[d] / c->count[d]);
        faces += c->count[d] * c->count[d];
    }
    for (int d = 0; d < dim; d++) slope[d] = 0;
    if (size == 0) return 0;
    to_lab(dim, v, own, slope);
    for (int d = 0; d < dim; d++) n[d] = slope[d] / sqrt(size);
    const double rough = 1 / sqrt(inverse);
    const double scale = rough < THIN * v->dp ? rough / thickness(dim, v, f, i, n) : 1;
    for (int d = 0; d < dim; d++) {
        slope[d] *= scale;
        rise += scale * own[d] * c->out[d] / sqrt(faces);
    }
    return 0.5 * v->dp * rise;
}

MPS_ROW void press_fluid(const int dim, const mps_view *v, const mps__pocket_faces *f, int64_t i)
{
    if (f->begin[i] == f->begin[i + 1]) return;
    const contact c = sum_faces(dim, v, f, i);
    const double rise = film(dim, v, f, i, &c, f->slope + i * dim);
    double *row = f->row + i * MPS__POCKET_ROW;
    row[MPS__ROW_PRESSURE] = c.pressure / c.faces - rise;
    row[MPS__ROW_WEIGHT] = c.faces;
    f->number[i] = c.number;
    row[MPS__ROW_FILM] = c.inverse[0] + c.inverse[1] + c.inverse[2] > 0;
}

/* Void in front of a wall particle: the component nearest to the point half a cell in front of
 * it. */
MPS_ROW void press_wall(const int dim, const mps_view *v, const mps__pocket_faces *f, int64_t i)
{
    const double *area = v->area + i * dim;
    double x[3] = {0}, place[3] = {0}, size = 0;
    for (int d = 0; d < dim; d++) size += area[d] * area[d];
    for (int d = 0; d < dim; d++)
        x[d] = v->x[i * dim + d] + (size > 0 ? 0.5 * f->voids.side * area[d] / sqrt(size) : 0);
    mps_view_tank(v, x, place, NULL);
    const int64_t cell = mps_voids_cell(&f->voids, place);
    int32_t label = cell < 0 ? -1 : f->voids.label[cell];
    if (label < 0) label = mps_voids_near(&f->voids, place, 2 * v->dp);
    if (label < 0) return;
    f->row[i * MPS__POCKET_ROW + MPS__ROW_PRESSURE] = f->pressure[label];
    f->row[i * MPS__POCKET_ROW + MPS__ROW_WEIGHT] = 1;
    f->number[i] = number_of(f, label);
}

MPS_ROW void press_row(const int dim, const mps_view *v, const mps__pocket_faces *f, int64_t i)
{
    f->number[i] = 0;
    if (mps_is_fluid(v, i)) press_fluid(dim, v, f, i);
    if (mps_is_wall(v, i)) press_wall(dim, v, f, i);
}
MPS_ROWS(press_rows, press_row, mps__pocket_faces)

void mps__pocket_press(mps_stage *s, const mps__pocket_faces *f)
{
    mps_stage_rows(s, &press_rows, f);
}

MPS_ROW void clear_row(const int dim, const mps_view *v, const mps__pocket_faces *f, int64_t i)
{
    (void)dim, (void)v;
    f->number[i] = 0;
}
MPS_ROWS(clear_rows, clear_row, mps__pocket_faces)

void mps__pocket_clear(mps_stage *s, const mps__pocket_faces *f)
{
    mps_stage_rows(s, &clear_rows, f);
}

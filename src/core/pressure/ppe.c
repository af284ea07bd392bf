/* SPDX-License-Identifier: BSD-3-Clause */
/* Assembly of the pressure equation, W22 (10)(16)(17): a row for every unknown, Dirichlet
 * neighbours moved to the right side. W22: Wen, Zhao & Wan 2022. */
#include "ppe.h"
#include "loop.h"
#include "scan.h"
#include <math.h>
#include <mps/stage.h>
#include <mps/operators.h>
#include <string.h>

void mps__ppe_init(mps__ppe *e, mps__context *context)
{
    *e = (mps__ppe){.context = context, .scratch = &e->own, .sets = {.context = context}};
}

void mps__ppe_free(mps__ppe *e)
{
    mps__scratch_free(e->context, &e->own);
    mps__sets_free(&e->sets);
    mps__ppe_init(e, e->context);
}

/* Arguments of the row functions of the matrix: terms of the equation by particle, arrays of the
 * equation by unknown. */
typedef struct assembly {
    mps_stencil pairs;
    mps_flux flux;
    const int32_t *kind, *region, *condition;
    const double *density, *source, *shift, *value, *gas, *law;
    const uint8_t *ghost; /* NULL: single rank */
    double c;             /* 2D/(n0 lambda) */
    double surface;       /* weight of pairs with one particle on the surface */
    double gain;
    const int32_t *unknown, *particle;
    /* NULL: the loop has exactly one iteration a row; else the number of unknowns, see OTHERS */
    const int64_t *unknowns;
    int64_t *row;
    int32_t *col;
    float *val;
    /* the last two NULL: all rows are linear */
    double *diagonal, *rhs, *row_shift, *row_gas, *row_law;
    double *moments; /* NULL: not requested */
} assembly;

/* Flux of a linear pressure through the row below a flat surface: the full sum, over the sum
 * without the pairs beyond the surface. */
static double complete_flux(const mps_stencil *t)
{
    const int reach = (int)(t->re / t->dp) + 1, depth = t->dim == 3 ? reach : 0;
    double full = 0, left = 0;
    for (int k = -depth; k <= depth; k++)
        for (int j = 1; j <= reach; j++)
            for (int i = -reach; i <= reach; i++) {
                const double r = t->dp * sqrt((double)(i * i + j * j + k * k));
                const double w = r < t->re ? mps_kernel_weight(&t->kernel, r, t->re) : 0.0;
                full += w * j * j;
                left += w * j;
            }
    return full / left;
}

/* Weight of a pair by the kinds and conditions of its particles; 0: no contribution. Unknowns are
 * not on the surface. */
static inline double pair_factor(const assembly *a, int64_t i, int64_t j)
{
    if (a->unknown[j] < 0 && a->condition[j] != MPS_ROW_FIXED) return 0.0;
    if (a->kind[i] == MPS_WALL && a->kind[j] == MPS_WALL)
        return mps_flux_wall_fraction(&a->flux, i, j);
    return a->region[j] == MPS_REGION_SURFACE ? a->surface : 1.0;
}

static inline bool is_unknown(const assembly *a, int64_t i)
{
    return a->kind[i] != MPS_DUMMY && a->region[i] < MPS_REGION_SURFACE &&
           a->condition[i] != MPS_ROW_FIXED;
}

/* A workspace block in the memory space of the equation. */
static void *take(mps__ppe *e, int32_t block, int64_t count, size_t size)
{
    return e->device ? mps__device_fit(e->device, &e->on_device[block], (size_t)count * size)
                     : mps__scratch_take(e->context, e->scratch, block, count, size);
}

static double *carve(char **buffer, int64_t count)
{
    double *array = (double *)(void *)*buffer;
    *buffer += (size_t)count * sizeof *array;
    return array;
}

static int32_t *carve_numbers(char **buffer, int64_t count)
{
    int32_t *array = (int32_t *)(void *)*buffer;
    *buffer += (size_t)count * sizeof *array;
    return array;
}

/* Allocate the arrays of the rows in one block, 8-byte elements first; row starts include the
 * workspace of the scan. */
mps_status mps__ppe_reserve_rows(mps__ppe *e, int32_t dim)
{
    const bool spared = e->spare && !e->device;
    const int64_t n = e->n, all = e->columns, starts = 1 + mps__scan_size(n),
                  late = spared ? 0 : 2 * n + (1 + dim) * all;
    char *buffer = take(e, MPS__PPE_ROWS, 2 * (3 * n + starts + late) + 2 * all + e->particles,
                        sizeof(int32_t));
    if (!buffer) return MPS_E_NOMEM;
    e->diagonal = carve(&buffer, n);
    e->rhs = carve(&buffer, n);
    e->shift = carve(&buffer, n);
    e->row = (int64_t *)(void *)carve(&buffer, starts);
    e->x = spared ? e->spare_x : carve(&buffer, all * dim);
    char *spare = spared ? (char *)e->spare : (char *)carve(&buffer, 2 * n + all);
    e->weight = carve(&spare, n);
    e->p = carve(&spare, all);
    e->component = carve_numbers(&spare, n);
    e->queue = carve_numbers(&spare, n);
    e->particle = carve_numbers(&buffer, all);
    e->order = carve_numbers(&buffer, all);
    e->unknown = carve_numbers(&buffer, e->particles);
    return MPS_OK;
}

MPS_ROW bool has_law(const assembly *a, int64_t i)
{
    return a->law[i] > 0 && a->gain * a->gas[i] > 0 && is_unknown(a, i);
}
MPS__FIRST(rows_with_law, has_law, assembly)

mps_status mps__ppe_reserve_laws(mps__ppe *e)
{
    e->gas = take(e, MPS__PPE_LAWS, 2 * e->n, sizeof *e->gas);
    if (!e->gas) return MPS_E_NOMEM;
    e->law = e->gas + e->n;
    return MPS_OK;
}

/* Weight of other ranks' unknowns in a number that counts both: unknowns of this rank are counted
 * by 1. */
#define OTHERS (INT64_C(1) << 32)

/* The prefix sum of these is a particle's number. */
typedef struct numbering {
    assembly terms;
    int64_t *number; /* [particles] */
    int64_t rows;
    int32_t *unknown, *particle;
} numbering;

MPS_ROW void mark_row(const numbering *f, int64_t i)
{
    const assembly *a = &f->terms;
    f->number[i] = !is_unknown(a, i) ? 0 : mps__owns(a->ghost, i) ? 1 : OTHERS;
}
MPS__LOOP_ANY(mark_rows, mark_row, numbering)

/* Unknowns in the order of the particles, then those of other ranks. */
MPS_ROW void number_row(const numbering *f, int64_t i)
{
    const assembly *a = &f->terms;
    const int64_t up_to = f->number[i], rows = a->unknowns ? *a->unknowns % OTHERS : f->rows,
                  place = mps__owns(a->ghost, i) ? up_to % OTHERS : rows + up_to / OTHERS;
    const bool solved = is_unknown(a, i);
    f->unknown[i] = solved ? (int32_t)place - 1 : -1;
    if (solved) f->particle[place - 1] = (int32_t)i;
}
MPS__LOOP_ANY(number_rows, number_row, numbering)

/* Off-diagonal entries of row r. */
MPS_ROW void count_row(const assembly *a, int64_t r)
{
    const mps_stencil *pairs = &a->pairs;
    int64_t count = 0;
    if (a->unknowns && r >= *a->unknowns % OTHERS) {
        a->row[r + 1] = 0;
        return;
    }
    const int64_t i = a->particle[r];
    for (int64_t k = pairs->begin[i]; k < pairs->end[i]; k++) {
        const int64_t j = pairs->col[k];
        count += a->unknown[j] >= 0 && (a->kind[i] == MPS_FLUID || pair_factor(a, i, j) != 0);
    }
    a->row[r + 1] = count;
    if (r == 0) a->row[0] = 0;
}
MPS__LOOP_ANY(count_rows, count_row, assembly)

/* Unknowns, row starts and number of entries, on the host. */
static mps_status count_on_rank(mps__ppe *e, const mps_view *s, assembly *a)
{
    const mps_parallel *parallel = e->parallel;
    numbering f = {.terms = *a};
    f.number = take(e, MPS__PPE_VALUES, mps__scan_size(s->n), sizeof *f.number);
    if (!f.number) return MPS_E_NOMEM;
    mps__loop_run(parallel, &mark_rows, MPS__ANY_DIM, s->n, &f);
    mps__scan(parallel, f.number, s->n);
    const int64_t all = s->n > 0 ? f.number[s->n - 1] : 0;
    e->n = f.rows = all % OTHERS;
    e->columns = e->n + all / OTHERS;
    MPS__TRY(mps__ppe_reserve_rows(e, s->dim));
    a->unknown = f.unknown = e->unknown;
    a->particle = f.particle = e->particle;
    a->row = e->row;
    mps__loop_run(parallel, &number_rows, MPS__ANY_DIM, s->n, &f);
    e->row[0] = 0; /* also without rows */
    mps__loop_run(parallel, &count_rows, s->dim, e->n, a);
    mps__scan(parallel, e->row + 1, e->n);
    e->entries = e->n > 0 ? e->row[e->n] : 0;
    return MPS_OK;
}

/* ---- counting on a device: the host waits once for all results ---- */

MPS_ROW bool has_least(const assembly *a, int64_t i)
{
    return a->condition[i] == MPS_ROW_LEAST && is_unknown(a, i);
}
MPS__FIRST(bounded_rows, has_least, assembly)

/* Counts in provisional arrays, before the final sizes are known. */
typedef struct counting {
    int64_t particles, rows, columns;
    const int64_t *number, *row;
    const int32_t *unknown, *particle;
    int64_t *to_row;
    int32_t *to_unknown, *to_particle;
    mps__ppe_counts *found;
} counting;

MPS_ROW void write_row(const counting *f, int64_t i)
{
    (void)i;
    f->found->unknowns = f->number[f->particles - 1];
    f->found->entries = f->row[f->particles];
}
MPS__LOOP_ANY(write_rows, write_row, counting)

/* Copy to the arrays of the rows. */
MPS_ROW void settle_row(const counting *f, int64_t i)
{
    if (i <= f->rows) f->to_row[i] = f->row[i];
    if (i < f->columns) f->to_particle[i] = f->particle[i];
    if (i < f->particles) f->to_unknown[i] = f->unknown[i];
}
MPS__LOOP_ANY(settle_rows, settle_row, counting)

/* Allocate for as many rows as there are particles. */
static mps_status reserve_counting(mps__ppe *e, numbering *f, assembly *a, counting *c)
{
    const int64_t n = e->particles, sums = mps__scan_size(n);
    f->number = take(e, MPS__PPE_VALUES, 2 * sums + 1 + n, sizeof *f->number);
    e->counts_device = c->found = take(e, MPS__PPE_COUNTS, 1, sizeof *c->found);
    if (!f->number || !c->found) return MPS_E_NOMEM;
    a->row = f->number + sums;
    f->unknown = (int32_t *)(void *)(a->row + 1 + sums);
    f->particle = f->unknown + n;
    a->unknown = f->unknown;
    a->particle = f->particle;
    a->unknowns = n > 0 ? f->number + n - 1 : f->number;
    c->particles = n;
    c->number = f->number;
    c->row = a->row;
    c->unknown = f->unknown;
    c->particle = f->particle;
    return MPS_OK;
}

static mps_status count_device(mps__ppe *e, const mps_view *s, assembly *a)
{
    const mps_parallel *parallel = e->parallel;
    numbering f = {.terms = *a};
    counting c = {0};
    mps__ppe_counts found = {.bounded = -INFINITY};
    MPS__TRY(reserve_counting(e, &f, a, &c));
    f.terms.unknowns = a->unknowns;
    mps__loop_run(parallel, &mark_rows, MPS__ANY_DIM, s->n, &f);
    mps__scan(parallel, f.number, s->n);
    mps__loop_run(parallel, &number_rows, MPS__ANY_DIM, s->n, &f);
    mps__loop_run(parallel, &count_rows, s->dim, s->n, a);
    mps__scan(parallel, a->row + 1, s->n);
    mps__values_reduce_async(e->device, &bounded_rows, MPS__ANY_DIM, s->n, a, &c.found->bounded);
    if (s->n > 0) {
        mps__loop_run(parallel, &write_rows, MPS__ANY_DIM, 1, &c);
        mps__device_download(e->device, &found, c.found, offsetof(mps__ppe_counts, lacking));
    }
    MPS__TRY(mps__device_status(e->device));
    e->n = c.rows = found.unknowns % OTHERS;
    e->columns = c.columns = e->n + found.unknowns / OTHERS;
    e->entries = found.entries;
    e->bounded = found.bounded > -INFINITY;
    MPS__TRY(mps__ppe_reserve_rows(e, s->dim));
    a->unknown = c.to_unknown = e->unknown;
    a->particle = c.to_particle = e->particle;
    c.to_row = e->row;
    mps__loop_run(parallel, &settle_rows, MPS__ANY_DIM, s->n > 0 ? s->n + 1 : 0, &c);
    return MPS_OK;
}

/* Sort columns by particle: far rows are two sorted runs, for which insertion sort is cheap. */
static void sort_row(const int32_t *particle, int32_t *col, float *val, int64_t n)
{
    for (int64_t k = 1; k < n; k++) {
        const int32_t c = col[k];
        const float v = val[k];
        int64_t j = k;
        for (; j > 0 && particle[col[j - 1]] > particle[c]; j--) {
            col[j] = col[j - 1];
            val[j] = val[j - 1];
        }
        col[j] = c;
        val[j] = v;
    }
}

MPS_ROW void fill_row(const int dim, const assembly *a, int64_t r)
{
    const mps_stencil *pairs = &a->pairs;
    const mps_flux *flux = &a->flux;
    const int64_t i = a->particle[r];
    int32_t *col = a->col + a->row[r];
    const double gas = a->gain * a->gas[i];
    float *val = a->val + a->row[r];
    double coupling = 0, shift = a->gain * a->shift[i] + gas, rhs = a->gain * a->source[i];
    double moment[3] = {0};
    int64_t count = 0;
    int64_t last = -1;
    bool sorted = true;
    for (int64_t k = pairs->begin[i]; k < pairs->end[i]; k++) {
        const double factor = pair_factor(a, i, pairs->col[k]);
        if (factor == 0) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, pairs, i, k);
        const double rho = mps_flux_density(flux, i, q.j);
        const float entry = (float)(a->c * factor * q.w /
                                    rho); /* symmetric; also in the diagonal */
        const double kij = (double)entry;
        rhs -= kij * (rho * mps_flux_body(flux, dim, i, q.j, q.d) - mps_flux_jump(flux, i, q.j));
        for (int d = 0; d < dim && a->moments; d++) moment[d] += kij * rho * q.d[d];
        const int32_t column = a->unknown[q.j];
        if (column < 0) {
            shift += kij;
            rhs += kij * a->value[q.j];
            continue;
        }
        coupling += kij;
        sorted = sorted & (q.j > last);
        last = q.j;
        col[count] = column;
        val[count++] = -entry;
    }
    if (coupling + shift == 0) { /* isolated: p = 0 */
        shift = a->c / a->density[i];
        rhs = 0;
    }
    a->diagonal[r] = coupling + shift;
    if (!sorted) sort_row(a->particle, col, val, count);
    a->rhs[r] = rhs;
    a->row_shift[r] = shift;
    for (int d = 0; d < dim && a->moments; d++) a->moments[r * dim + d] = moment[d];
    if (a->row_law) {
        a->row_gas[r] = gas;
        a->row_law[r] = gas > 0 ? a->law[i] : 0;
    }
}
MPS__LOOP(fill_rows, fill_row, assembly)

mps_status mps__ppe_reserve_entries(mps__ppe *e)
{
    e->col = take(e, MPS__PPE_COLUMNS, e->entries, sizeof *e->col);
    e->val = take(e, MPS__PPE_VALUES, e->entries, sizeof *e->val);
    return e->col && e->val ? MPS_OK : MPS_E_NOMEM;
}

static assembly assembly_of(const mps__ppe *e, const mps_view *s, const mps__ppe_terms *t)
{
    const mps_stencil *pairs = t->equation.radius == MPS_NEAR ? &s->near : &s->far;
    return (assembly){.pairs = *pairs,
                      .flux = *t->flux,
                      .kind = s->kind,
                      .region = t->region,
                      .condition = t->condition,
                      .density = t->density,
                      .source = t->source,
                      .shift = t->shift,
                      .value = t->value,
                      .gas = t->gas,
                      .law = t->law,
                      .ghost = e->ghosts ? mps__ghosts_seen(e->ghosts, e->device) : NULL,
                      .c = 2.0 * s->dim / (pairs->n0 * pairs->lambda),
                      .surface = t->equation.complete_surface ? complete_flux(pairs) : 1.0,
                      .gain = t->equation.gain};
}

/* Set the arrays that the row functions write, after allocation. */
static void see_rows(assembly *a, const mps__ppe *e)
{
    a->row = e->row;
    a->col = e->col;
    a->val = e->val;
    a->diagonal = e->diagonal;
    a->rhs = e->rhs;
    a->row_shift = e->shift;
    a->row_gas = e->gas;
    a->row_law = e->law;
    a->moments = e->moments && e->device ? e->on_device[MPS__PPE_MOMENTS].data : e->moments;
}

/* Allocate the optional arrays. */
static mps_status reserve_extras(mps__ppe *e, const mps_view *s, const assembly *a, bool linear)
{
    e->gas = e->law = NULL;
    if (!linear && mps__first_run(e->parallel, &rows_with_law, s->n, a) < s->n)
        MPS__TRY(mps__ppe_reserve_laws(e));
    if (!e->moments || !e->device) return MPS_OK;
    return take(e, MPS__PPE_MOMENTS, e->n * s->dim, sizeof *e->moments) ? MPS_OK : MPS_E_NOMEM;
}

mps_status mps__ppe_fill(mps__ppe *e, const mps_view *s, const mps__ppe_terms *t)
{
    e->parallel = s->near.parallel;
    e->device = mps__device_of(e->parallel);
    e->particles = s->n;
    assembly a = assembly_of(e, s, t);
    MPS__TRY(e->device ? count_device(e, s, &a) : count_on_rank(e, s, &a));
    MPS__TRY(reserve_extras(e, s, &a, t->linear));
    MPS__TRY(mps__ppe_reserve_entries(e));
    see_rows(&a, e);
    mps__loop_run(e->parallel, &fill_rows, s->dim, e->n, &a);
    return e->device ? mps__device_status(e->device) : MPS_OK;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Assembly of the pressure equation, W22 (10)(16)(17): a row for every unknown, Dirichlet neighbours moved to the right side. */
#include "ppe.h"
#include "levels.h"
#include "parallel.h"
#include <math.h>
#include <mps/model.h>
#include <mps/operators.h>
#include <string.h>

/* Blocks of scratch. */
enum { VALUES, COLUMNS, ROWS, LAWS, NUMBERS = MPS__PPE_LABELS + 1 };

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

/* What an assembly looks at. */
typedef struct assembly {
    mps__ppe *e;
    const mps_stage *s;
    const mps__ppe_terms *t;
    const mps_stencil *pairs;
    const int32_t *unknown;
    double c;       /* 2D/(n0 lambda) */
    double surface; /* weight of pairs with one particle on the surface */
} assembly;

/* Full flux of a linear pressure through the row below a flat surface, over that of the pairs the surface leaves. */
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

/* Weight of a pair by what its particles are; 0: it does not take part. An unknown is not on the surface. */
static inline double pair_factor(const assembly *a, int64_t i, int64_t j)
{
    const mps_stage *s = a->s;
    if (a->unknown[j] < 0 && a->t->condition[j] != MPS_ROW_FIXED) return 0.0;
    if (s->kind[i] == MPS_WALL && s->kind[j] == MPS_WALL)
        return mps_flux_wall_share(a->t->flux, i, j);
    return a->t->region[j] == MPS_REGION_SURFACE ? a->surface : 1.0;
}

static inline bool is_unknown(const assembly *a, int64_t i)
{
    return a->s->kind[i] != MPS_DUMMY && a->t->region[i] < MPS_REGION_SURFACE &&
           a->t->condition[i] != MPS_ROW_FIXED;
}

static double *carve(char **room, int64_t count)
{
    double *array = (double *)(void *)*room;
    *room += (size_t)count * sizeof *array;
    return array;
}

static int32_t *carve_numbers(char **room, int64_t count)
{
    int32_t *array = (int32_t *)(void *)*room;
    *room += (size_t)count * sizeof *array;
    return array;
}

/* Arrays of the rows, all in one block: those of eight bytes first. */
static mps_status reserve_rows(const assembly *a)
{
    mps__ppe *e = a->e;
    const int64_t n = e->n, all = e->columns, late = e->spare ? 0 : 2 * n + (1 + a->s->dim) * all;
    char *room = mps__scratch_take(e->context, e->scratch, ROWS,
                                   2 * (4 * n + late + 1) + 2 * all + a->s->n, sizeof(int32_t));
    if (!room) return MPS_E_NOMEM;
    e->diagonal = carve(&room, n);
    e->rhs = carve(&room, n);
    e->shift = carve(&room, n);
    e->row = (int64_t *)(void *)carve(&room, n + 1);
    e->x = e->spare ? e->spare_x : carve(&room, all * a->s->dim);
    char *spare = e->spare ? (char *)e->spare : (char *)carve(&room, 2 * n + all);
    e->weight = carve(&spare, n);
    e->p = carve(&spare, all);
    e->component = carve_numbers(&spare, n);
    e->queue = carve_numbers(&spare, n);
    e->particle = carve_numbers(&room, all);
    e->order = carve_numbers(&room, all);
    e->unknown = carve_numbers(&room, a->s->n);
    return MPS_OK;
}

/* Room for laws of gases, where any row has one. */
static mps_status reserve_laws(const assembly *a)
{
    mps__ppe *e = a->e;
    bool any = false;
    e->gas = e->law = NULL;
    for (int64_t i = 0; i < a->s->n && !any; i++)
        any = a->t->law[i] > 0 && a->t->equation.gain * a->t->gas[i] > 0 && is_unknown(a, i);
    if (!any) return MPS_OK;
    e->gas = mps__scratch_take(e->context, e->scratch, LAWS, 2 * e->n, sizeof *e->gas);
    if (!e->gas) return MPS_E_NOMEM;
    e->law = e->gas + e->n;
    return MPS_OK;
}

static bool is_unknown_row(const void *argument, int64_t i)
{
    const assembly *a = argument;
    return is_unknown(a, i) && !(a->e->ghosts && mps__is_ghost(a->e->ghosts, i));
}

static bool is_unknown_column(const void *argument, int64_t i)
{
    return is_unknown(argument, i);
}

/* Unknowns in the order of the particles, behind them those of other ranks. */
static mps_status number_rows(const assembly *a)
{
    mps__ppe *e = a->e;
    int64_t rows = 0, column;
    e->n = mps__parallel_count(a->pairs->parallel, a->s->n, is_unknown_row, a);
    e->columns = e->ghosts ? mps__parallel_count(a->pairs->parallel, a->s->n, is_unknown_column, a)
                           : e->n;
    column = e->n;
    MPS__TRY(reserve_rows(a));
    for (int64_t i = 0; i < a->s->n; i++) {
        const bool solved = is_unknown(a, i), ghost = e->ghosts && mps__is_ghost(e->ghosts, i);
        int64_t *next = ghost ? &column : &rows;
        e->unknown[i] = solved ? (int32_t)*next : -1;
        if (solved) e->particle[(*next)++] = (int32_t)i;
    }
    return reserve_laws(a);
}

/* Entries of row r beside the diagonal. */
static int64_t count_row(const assembly *a, int64_t r)
{
    const mps__ppe *e = a->e;
    const int64_t i = e->particle[r];
    int64_t count = 0;
    for (int64_t k = a->pairs->begin[i]; k < a->pairs->end[i]; k++) {
        const int64_t j = a->pairs->col[k];
        count += e->unknown[j] >= 0 && (a->s->kind[i] == MPS_FLUID || pair_factor(a, i, j) != 0);
    }
    return count;
}

static void count_rows(void *argument, int64_t begin, int64_t end)
{
    const assembly *a = argument;
    for (int64_t r = begin; r < end; r++) a->e->row[r + 1] = count_row(a, r);
}

/* Row starts. Returns the entries of all. */
static int64_t start_rows(assembly *a)
{
    mps__ppe *e = a->e;
    e->row[0] = 0;
    mps_parallel_rows(a->pairs->parallel, e->n, count_rows, a);
    for (int64_t r = 0; r < e->n; r++) e->row[r + 1] += e->row[r];
    return e->row[e->n];
}

/* Columns in the order of their particles: far rows are two sorted runs, for which insertion is short work. */
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

static inline __attribute__((always_inline)) void fill_row(const int dim, const assembly *all,
                                                           int64_t r)
{
    mps__ppe *e = all->e;
    const mps_stage stage = *all->s,
                    *s = &stage; /* copies, so that the pointers in them stay in registers */
    const mps_stencil stencil = *all->pairs, *pairs = &stencil;
    const mps_flux flux = *all->t->flux;
    mps__ppe_terms terms = *all->t;
    terms.flux = &flux;
    const assembly copy = {e, s, &terms, pairs, all->unknown, all->c, all->surface}, *a = &copy;
    const int64_t i = e->particle[r];
    int32_t *col = e->col + e->row[r];
    const double gain = terms.equation.gain, gas = gain * a->t->gas[i];
    float *val = e->val + e->row[r];
    double coupling = 0, shift = gain * a->t->shift[i] + gas, rhs = gain * a->t->source[i];
    int64_t count = 0;
    int64_t last = -1;
    bool sorted = true;
    for (int64_t k = pairs->begin[i]; k < pairs->end[i]; k++) {
        const double factor = pair_factor(a, i, pairs->col[k]);
        if (factor == 0) continue;
        const mps_pair q = mps_stencil_pair_dim(dim, pairs, i, k);
        const double rho = mps_flux_density(&flux, i, q.j);
        const float entry = (float)(a->c * factor * q.w /
                                    rho); /* the same from both sides, and in the diagonal */
        const double kij = (double)entry;
        rhs -= kij * (rho * mps_flux_body(&flux, dim, i, q.j, q.d) - mps_flux_jump(&flux, i, q.j));
        const int32_t column = a->unknown[q.j];
        if (column < 0) {
            shift += kij;
            rhs += kij * terms.value[q.j];
            continue;
        }
        coupling += kij;
        sorted = sorted & (q.j > last);
        last = q.j;
        col[count] = column;
        val[count++] = -entry;
    }
    if (coupling + shift == 0) { /* no pair: p = 0 */
        shift = a->c / terms.density[i];
        rhs = 0;
    }
    e->diagonal[r] = coupling + shift;
    if (!sorted) sort_row(e->particle, col, val, count);
    e->rhs[r] = rhs;
    e->shift[r] = shift;
    if (e->law) {
        e->gas[r] = gas;
        e->law[r] = gas > 0 ? a->t->law[i] : 0;
    }
}

/* What rows are not made of, also of columns of other ranks. It may stand where the terms were. */
static void note_unknown(const assembly *a, int64_t r)
{
    const mps__ppe *e = a->e;
    const mps_stage *s = a->s;
    const int64_t i = e->particle[r];
    e->p[r] = a->t->pressure[i];
    for (int d = 0; d < s->dim; d++) e->x[r * s->dim + d] = s->x[i * s->dim + d];
    if (r < e->n) e->weight[r] = s->dt * s->dt;
}

static void fill_rows(void *argument, int64_t begin, int64_t end)
{
    const assembly *a = argument;
    for (int64_t r = begin; r < end; r++) {
        if (a->s->dim == 2)
            fill_row(2, a, r);
        else
            fill_row(3, a, r);
    }
}

static void note_rows(void *argument, int64_t begin, int64_t end)
{
    for (int64_t r = begin; r < end; r++) note_unknown(argument, r);
}

static mps_status reserve_entries(mps__ppe *e, int64_t entries)
{
    e->col = mps__scratch_take(e->context, e->scratch, COLUMNS, entries, sizeof *e->col);
    e->val = mps__scratch_take(e->context, e->scratch, VALUES, entries, sizeof *e->val);
    return e->col && e->val ? MPS_OK : MPS_E_NOMEM;
}

/* ---- many ranks ---- */

static int share_columns(void *host, double *x)
{
    const mps__ppe *e = host;
    return mps__ghosts_share_indexed(e->ghosts, e->unknown, x) < 0;
}

static int reduce_values(void *host, int32_t count, size_t bytes, void *values,
                         mps_combine_fn combine)
{
    mps__ranks *r = ((const mps__ppe *)host)->ghosts->ranks;
    mps__ranks_reduce(r, count, bytes, values, combine);
    return r->failed;
}

static int gather_blocks(void *host, const void *own, const int64_t *bytes, void *all)
{
    mps__ranks *r = ((const mps__ppe *)host)->ghosts->ranks;
    mps__ranks_gather(r, own, bytes, all);
    return r->failed;
}

static int connect_ranks(void *host, int32_t count, const int32_t *to, const int64_t *sent,
                         mps_route *route)
{
    mps__ranks *r = ((const mps__ppe *)host)->ghosts->ranks;
    mps__ranks_connect(r, count, to, sent, route);
    return r->failed;
}

static void disconnect_ranks(void *host, mps_route *route)
{
    mps__ranks *r = ((const mps__ppe *)host)->ghosts->ranks;
    r->ops.disconnect(r->self, route);
}

static int exchange_elements(void *host, const mps_route *route, size_t bytes, const void *out,
                             void *in)
{
    mps__ranks *r = ((const mps__ppe *)host)->ghosts->ranks;
    mps__ranks_exchange(r, route, bytes, out, in);
    return r->failed;
}

static int find_owners(void *host, int64_t m, const double *x, int32_t *rank)
{
    const mps__ppe *e = host;
    return e->owner(e->world, m, x, rank) < 0;
}

/* Rows and columns of other ranks, merged by their particles. */
static void order_columns(mps__ppe *e)
{
    int64_t row = 0, column = e->n;
    for (int64_t k = 0; k < e->columns; k++) {
        const bool own = column == e->columns ||
                         (row < e->n && e->particle[row] < e->particle[column]);
        e->order[k] = (int32_t)(own ? row++ : column++);
    }
}

static mps_status set_ranks(mps__ppe *e)
{
    if (!e->ghosts || !mps__ranks_many(e->ghosts->ranks)) return MPS_OK;
    mps__ranks *r = e->ghosts->ranks;
    int64_t *rows = mps__scratch_take(e->context, e->scratch, NUMBERS, r->count, sizeof *rows);
    if (!rows) return MPS_E_NOMEM;
    mps__ranks_gather_number(r, e->n, rows);
    order_columns(e);
    e->ranks = (mps_ppe_ranks){.struct_size = sizeof e->ranks,
                               .rank = r->rank,
                               .ranks = r->count,
                               .ghosts = e->columns - e->n,
                               .order = e->order,
                               .owner = find_owners,
                               .share = share_columns,
                               .reduce = reduce_values,
                               .gather = gather_blocks,
                               .connect = connect_ranks,
                               .disconnect = disconnect_ranks,
                               .exchange = exchange_elements,
                               .host = e};
    for (int32_t k = 0; k < r->count; k++) {
        e->ranks.first += k < r->rank ? rows[k] : 0;
        e->ranks.rows += rows[k];
    }
    return mps__ranks_status(r);
}

mps_status mps__ppe_assemble(mps__ppe *e, const mps_stage *s, const mps__ppe_terms *t)
{
    const mps_stencil *pairs = t->equation.radius == MPS_NEAR ? s->near : s->far;
    assembly a = {.e = e,
                  .s = s,
                  .t = t,
                  .pairs = pairs,
                  .c = 2.0 * s->dim / (pairs->n0 * pairs->lambda),
                  .surface = t->equation.complete_surface ? complete_flux(pairs) : 1.0};
    MPS__TRY(number_rows(&a));
    a.unknown = e->unknown;
    MPS__TRY(reserve_entries(e, start_rows(&a)));
    mps_parallel_rows(pairs->parallel, e->n, fill_rows, &a);
    mps_parallel_rows(pairs->parallel, e->columns, note_rows,
                      &a); /* after all rows: it may overwrite terms that they look at */
    MPS__TRY(set_ranks(e));
    int32_t singular;
    MPS__TRY(mps__levels_find(e, s->id, pairs->parallel, &singular));
    e->problem = (mps_ppe_problem){.struct_size = sizeof e->problem,
                                   .dim = s->dim,
                                   .n = e->n,
                                   .row = e->row,
                                   .col = e->col,
                                   .val = e->val,
                                   .diagonal = e->diagonal,
                                   .rhs = e->rhs,
                                   .shift = e->shift,
                                   .weight = e->weight,
                                   .x = e->x,
                                   .dp = s->dp,
                                   .components = singular,
                                   .component = singular ? e->component : NULL,
                                   .gas = e->gas,
                                   .law = e->law,
                                   .parallel = pairs->parallel,
                                   .ranks = e->ranks.ranks > 1 ? &e->ranks : NULL};
    return MPS_OK;
}

typedef struct scatter {
    const mps__ppe *e;
    const mps__ppe_terms *t;
    double *p;
} scatter;

static void scatter_rows(void *argument, int64_t begin, int64_t end)
{
    const scatter *c = argument;
    for (int64_t i = begin; i < end; i++) {
        if (c->e->unknown[i] >= 0)
            c->p[i] = c->e->p[c->e->unknown[i]];
        else
            c->p[i] = c->t->condition[i] == MPS_ROW_FIXED ? c->t->value[i] : 0;
    }
}

void mps__ppe_scatter(const mps__ppe *e, const mps_stage *s, const mps__ppe_terms *t, double *p)
{
    mps_parallel_rows(s->far->parallel, s->n, scatter_rows, &(scatter){e, t, p});
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Assembly of the pressure equation, W22 (10)(16): a row for every particle that owns a pressure, dummies summed into their
 * wall particle's row, Dirichlet neighbours moved to the right side. */
#include "ppe.h"
#include "operators.h"
#include <string.h>

void mps__ppe_init(mps__ppe *e, mps__context *context)
{
    *e = (mps__ppe){.context = context};
}

void mps__ppe_free(mps__ppe *e)
{
    void *all[] = {e->unknown, e->particle, e->row, e->member, e->members, e->col, e->val, e->rhs, e->shift, e->weight, e->x, e->p, e->component};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) mps__free(e->context, all[k]);
    mps__ppe_init(e, e->context);
}

static mps_status reserve(mps__ppe *e, int64_t n, int dim)
{
    if (n <= e->capacity) return MPS_OK;
    const int64_t wanted = n + n / 8;
    struct {
        void **place;
        int64_t count;
        size_t size;
    } a[] = {{(void **)&e->unknown, wanted, sizeof *e->unknown}, {(void **)&e->particle, wanted, sizeof *e->particle},
             {(void **)&e->row, wanted + 1, sizeof *e->row},     {(void **)&e->member, wanted + 1, sizeof *e->member},
             {(void **)&e->members, wanted, sizeof *e->members}, {(void **)&e->rhs, wanted, sizeof *e->rhs},
             {(void **)&e->shift, wanted, sizeof *e->shift},     {(void **)&e->weight, wanted, sizeof *e->weight},
             {(void **)&e->x, wanted * dim, sizeof *e->x},       {(void **)&e->p, wanted, sizeof *e->p},
             {(void **)&e->component, wanted, sizeof *e->component}};
    /* nothing here outlives an assembly: the old blocks go first, a failure leaves an empty object */
    e->capacity = 0;
    for (size_t k = 0; k < sizeof a / sizeof a[0]; k++) {
        mps__free(e->context, *a[k].place);
        *a[k].place = mps__alloc(e->context, a[k].count, a[k].size);
        if (!*a[k].place) return MPS_E_NOMEM;
    }
    e->capacity = wanted;
    return MPS_OK;
}

static inline bool takes_part(const mps_stage *s, const mps_ppe_terms *t, int32_t i, int32_t j)
{
    if (s->owner[j] < 0 || s->owner[i] == s->owner[j]) return false;
    return t->wall_pairs || s->kind[i] == MPS_FLUID || s->kind[j] == MPS_FLUID;
}

/* Density of a pair: the mean between fluids, W22 (17); next to a solid the fluid's. */
static inline double pair_density(const mps_stage *s, int32_t i, int32_t j)
{
    if (s->kind[i] == s->kind[j] || (s->kind[i] != MPS_FLUID && s->kind[j] != MPS_FLUID)) return 0.5 * (s->density[i] + s->density[j]);
    return s->kind[i] == MPS_FLUID ? s->density[i] : s->density[j];
}

static inline double pair_weight(const mps_stage *s, int32_t i, int32_t j)
{
    double r2 = 0;
    for (int d = 0; d < s->dim; d++) {
        const double m = s->x[(int64_t)j * s->dim + d] - s->x[(int64_t)i * s->dim + d];
        r2 += m * m;
    }
    return mps_kernel_weight(&s->far->kernel, sqrt(r2), s->far->re) / pair_density(s, i, j);
}

/* Members of each owner, ascending: e->member[owner] .. e->member[owner+1] in e->members. */
static void group_members(mps__ppe *e, const mps_stage *s)
{
    memset(e->member, 0, (size_t)(s->n + 1) * sizeof *e->member);
    for (int64_t i = 0; i < s->n; i++)
        if (s->owner[i] >= 0) e->member[s->owner[i] + 1]++;
    for (int64_t i = 0; i < s->n; i++) e->member[i + 1] += e->member[i];
    int64_t *next = e->row; /* free until rows are counted */
    memcpy(next, e->member, (size_t)(s->n + 1) * sizeof *next);
    for (int64_t i = 0; i < s->n; i++)
        if (s->owner[i] >= 0) e->members[next[s->owner[i]]++] = (int32_t)i;
}

/* Most entries the row of owner u can have; 0: nothing to solve for. */
static int64_t row_bound(const mps__ppe *e, const mps_stage *s, const mps_ppe_terms *t, int32_t u)
{
    int64_t count = 0;
    bool shifted = false;
    for (int64_t m = e->member[u]; m < e->member[u + 1]; m++) {
        const int32_t i = e->members[m];
        shifted = shifted || t->shift[i] > 0;
        for (int64_t k = s->far->begin[i]; k < s->far->end[i]; k++) count += takes_part(s, t, i, s->far->col[k]);
    }
    return count || shifted ? count + 1 : 0;
}

/* Number the unknowns; e->row takes upper bounds of the row starts. */
static int64_t number_rows(mps__ppe *e, const mps_stage *s, const mps_ppe_terms *t)
{
    int64_t *bound = e->row + 1;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t u = 0; u < s->n; u++) bound[u] = s->owner[u] == u && !t->fixed[u] ? row_bound(e, s, t, (int32_t)u) : 0;
    int64_t n = 0, entries = 0;
    for (int64_t u = 0; u < s->n; u++) {
        e->unknown[u] = -1;
        if (!bound[u]) continue;
        e->unknown[u] = (int32_t)n;
        e->particle[n] = (int32_t)u;
        entries += bound[u];
        e->row[++n] = entries; /* n <= u + 1: never ahead of what is read */
    }
    e->row[0] = 0;
    e->n = n;
    return entries;
}

/* Sort by column (stable: sums do not depend on anything else) and add up equal columns. Returns the entries left. */
static int64_t merge_row(int32_t *col, double *val, int64_t n)
{
    for (int64_t k = 1; k < n; k++) {
        const int32_t c = col[k];
        const double v = val[k];
        int64_t j = k;
        for (; j > 0 && col[j - 1] > c; j--) {
            col[j] = col[j - 1];
            val[j] = val[j - 1];
        }
        col[j] = c;
        val[j] = v;
    }
    int64_t left = 0;
    for (int64_t k = 1; k < n; k++) {
        if (col[k] == col[left]) {
            val[left] += val[k];
        } else {
            col[++left] = col[k];
            val[left] = val[k];
        }
    }
    return left + 1;
}

/* Row r: pairs of all members against unknown, fixed and empty (p = offset) neighbours. */
static int64_t fill_row(mps__ppe *e, const mps_stage *s, const mps_ppe_terms *t, int64_t r)
{
    const double c = 2.0 * s->dim / (s->far->n0 * s->far->lambda);
    const int32_t u = e->particle[r];
    int32_t *col = e->col + e->row[r];
    double *val = e->val + e->row[r], diagonal = 0, shift = 0, rhs = 0;
    int64_t count = 1;
    for (int64_t m = e->member[u]; m < e->member[u + 1]; m++) {
        const int32_t i = e->members[m];
        rhs += t->rhs[i];
        shift += t->shift[i];
        for (int64_t k = s->far->begin[i]; k < s->far->end[i]; k++) {
            const int32_t j = s->far->col[k];
            if (!takes_part(s, t, i, j)) continue;
            const double kij = c * pair_weight(s, i, j);
            const int32_t o = s->owner[j];
            if (e->unknown[o] >= 0) {
                diagonal += kij;
                col[count] = e->unknown[o];
                val[count++] = -kij;
            } else if (t->fixed[o]) {
                shift += kij;
                rhs += kij * t->value[o];
            } else {
                continue;
            }
            rhs -= kij * (s->offset[i] - s->offset[j]);
        }
    }
    if (diagonal + shift == 0) shift = 1.0; /* all neighbours are empty: p = 0 */
    col[0] = (int32_t)r;
    val[0] = diagonal + shift;
    e->rhs[r] = rhs;
    e->shift[r] = shift;
    e->weight[r] = s->dt * s->dt;
    e->p[r] = s->p[u];
    for (int d = 0; d < s->dim; d++) e->x[r * s->dim + d] = s->x[(int64_t)u * s->dim + d];
    return merge_row(col, val, count);
}

/* Close the gaps that merging left; rows move down only. */
static void compact_rows(mps__ppe *e, const int64_t *length)
{
    int64_t to = 0;
    for (int64_t r = 0; r < e->n; r++) {
        const int64_t from = e->row[r];
        memmove(e->col + to, e->col + from, (size_t)length[r] * sizeof *e->col);
        memmove(e->val + to, e->val + from, (size_t)length[r] * sizeof *e->val);
        e->row[r] = to;
        to += length[r];
    }
    e->row[e->n] = to;
}

/* Visit the component of row `seed`, breadth first; its rows stand in `queue`. Returns their number. */
static int64_t flood(mps__ppe *e, int64_t seed, int32_t *queue, bool *level)
{
    int64_t count = 0;
    *level = false;
    queue[count++] = (int32_t)seed;
    e->component[seed] = -1;
    for (int64_t next = 0; next < count; next++) {
        const int32_t r = queue[next];
        *level = *level || e->shift[r] > 0;
        for (int64_t k = e->row[r]; k < e->row[r + 1]; k++)
            if (e->component[e->col[k]] == -2) {
                e->component[e->col[k]] = -1;
                queue[count++] = e->col[k];
            }
    }
    return count;
}

/* Find components whose pressure has no level, and make the right side solvable there: its mean is volume that cannot go
 * anywhere. Returns their number. */
static int32_t find_singular(mps__ppe *e, int32_t *queue)
{
    int32_t singular = 0;
    for (int64_t r = 0; r < e->n; r++) e->component[r] = -2;
    for (int64_t seed = 0; seed < e->n; seed++) {
        if (e->component[seed] != -2) continue;
        bool level;
        const int64_t count = flood(e, seed, queue, &level);
        if (level) continue;
        double mean = 0;
        for (int64_t k = 0; k < count; k++) mean += e->rhs[queue[k]] / (double)count;
        for (int64_t k = 0; k < count; k++) {
            e->rhs[queue[k]] -= mean;
            e->component[queue[k]] = singular;
        }
        singular++;
    }
    return singular;
}

mps_status mps__ppe_assemble(mps__ppe *e, const mps_stage *s, const mps_ppe_terms *t)
{
    e->n = 0;
    MPS__TRY(reserve(e, s->n, s->dim));
    group_members(e, s);
    const int64_t entries = number_rows(e, s, t);
    if (entries > e->entry_capacity) {
        mps__free(e->context, e->col);
        mps__free(e->context, e->val);
        e->entry_capacity = 0;
        e->val = NULL;
        e->col = mps__alloc(e->context, entries + entries / 8, sizeof *e->col);
        e->val = mps__alloc(e->context, entries + entries / 8, sizeof *e->val);
        if (!e->col || !e->val) return MPS_E_NOMEM;
        e->entry_capacity = entries + entries / 8;
    }
    int64_t *length = mps__alloc(e->context, e->n, sizeof *length);
    if (!length) return MPS_E_NOMEM;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t r = 0; r < e->n; r++) length[r] = fill_row(e, s, t, r);
    compact_rows(e, length);
    const int32_t singular = find_singular(e, (int32_t *)(void *)length);
    mps__free(e->context, length);
    e->problem = (mps_ppe_problem){.struct_size = sizeof e->problem,
                                   .dim = s->dim,
                                   .n = e->n,
                                   .row = e->row,
                                   .col = e->col,
                                   .val = e->val,
                                   .rhs = e->rhs,
                                   .shift = e->shift,
                                   .weight = e->weight,
                                   .x = e->x,
                                   .dp = s->dp,
                                   .threads = s->threads,
                                   .components = singular,
                                   .component = singular ? e->component : NULL};
    return MPS_OK;
}

void mps__ppe_scatter(const mps__ppe *e, const mps_stage *s, const mps_ppe_terms *t, double *p)
{
    for (int64_t i = 0; i < s->n; i++) {
        const int32_t u = s->owner[i];
        if (u < 0)
            p[i] = 0;
        else if (e->unknown[u] >= 0)
            p[i] = e->p[e->unknown[u]] + s->offset[i];
        else
            p[i] = t->fixed[u] ? t->value[u] + s->offset[i] : 0;
    }
}

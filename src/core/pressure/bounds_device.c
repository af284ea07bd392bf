/* SPDX-License-Identifier: BSD-3-Clause */
/* Lower bounds of an equation on a device: the algorithm of bounds.c as loops over rows. A row
 * tests itself and its columns, and saves what it modifies. */
#include "bounds.h"
#include "loop.h"
#include <math.h>

/* Active, with a finite bound. */
MPS_ROW bool is_fixed(const mps__bound_rows *f, int64_t r)
{
    return f->active[r] && isfinite(f->least[r]);
}

/* Values for the halo exchange. */
MPS_ROW void write_fixed(const mps__bound_rows *f, int64_t r)
{
    f->fixed[r] = is_fixed(f, r) ? f->least[r] : NAN;
}
MPS__LOOP_ANY(write_fixed_rows, write_fixed, mps__bound_rows)

/* The pressure of an active column; NaN: not active. */
MPS_ROW double fixed_at(const mps__bound_rows *f, int64_t c)
{
    if (c >= f->rows) return f->fixed[c];
    return is_fixed(f, c) ? f->least[c] : NAN;
}

MPS_ROW void begin_row(const mps__bound_rows *f, int64_t r)
{
    const int64_t i = f->particle[r];
    const bool bounded = f->condition[i] == MPS_ROW_LEAST;
    f->least[r] = bounded ? f->value[i] : NAN;
    f->margin[r] = f->nearly * f->density[i] * f->speed * f->speed;
    f->bounded[r] = bounded;
    f->active[r] = bounded && f->active_before[i] != 0;
}
MPS__LOOP_ANY(begin_rows, begin_row, mps__bound_rows)

MPS_ROW void fix_row(const mps__bound_rows *f, int64_t r)
{
    const bool own = is_fixed(f, r);
    double rhs = f->rhs[r], shift = f->shift[r];
    bool changed = own;
    f->kept_rhs[r] = rhs;
    f->kept_shift[r] = shift;
    for (int64_t p = f->row[r]; p < f->row[r + 1]; p++) {
        const int64_t c = f->col[p];
        const double fixed = fixed_at(f, c);
        const double kij = -(double)f->val[p];
        f->kept[p] = f->val[p];
        if (kij == 0 || !(own || isfinite(fixed))) continue;
        changed = true;
        f->val[p] = 0;
        if (own) continue;
        rhs += kij * fixed;
        shift += kij;
    }
    f->changed[r] = changed;
    if (!changed) return;
    f->shift[r] = own ? f->diagonal[r] : shift;
    f->rhs[r] = own ? f->diagonal[r] * f->least[r] : rhs;
}
MPS__LOOP_ANY(fix_rows, fix_row, mps__bound_rows)

/* Restore the assembled row, bit by bit. */
MPS_ROW void free_row(const mps__bound_rows *f, int64_t r)
{
    if (!f->changed[r]) return;
    f->rhs[r] = f->kept_rhs[r];
    f->shift[r] = f->kept_shift[r];
    for (int64_t p = f->row[r]; p < f->row[r + 1]; p++) f->val[p] = f->kept[p];
}
MPS__LOOP_ANY(free_rows, free_row, mps__bound_rows)

/* Residual of the assembled row, whether it is modified or not. */
MPS_ROW double residual(const mps__bound_rows *f, int64_t r)
{
    const bool kept = f->changed[r];
    const float *val = kept ? f->kept : f->val;
    double sum = f->diagonal[r] * f->p[r] - (kept ? f->kept_rhs[r] : f->rhs[r]);
    for (int64_t p = f->row[r]; p < f->row[r + 1]; p++) sum += (double)val[p] * f->p[f->col[p]];
    return sum;
}

/* Next active set. The maximum: whether it has changed. */
MPS_ROW void choose_row(const mps__bound_rows *f, int64_t r, double *changed)
{
    bool active = false;
    if (f->bounded[r])
        active = f->active[r] ? residual(f, r) >= -f->margin[r] * f->diagonal[r]
                              : f->p[r] < f->least[r] - f->margin[r];
    if (active != f->active[r]) changed[0] = 1;
    f->next[r] = active;
}
MPS__VALUES_ANY(choose_rows, choose_row, mps__bound_rows, 0, 1)

MPS_ROW void condition_row(const mps__bound_rows *f, int64_t r)
{
    if (f->active[r]) f->condition[f->particle[r]] = MPS__ROW_ACTIVE;
}
MPS__LOOP_ANY(condition_rows, condition_row, mps__bound_rows)

static void run(const mps__bounds *b, const mps__ppe *e, const mps__loop *loop)
{
    mps__loop_run(e->parallel, loop, MPS__ANY_DIM, e->n, &b->rows);
}

/* Allocate the arrays of the rows in one block, 8-byte elements first. */
static mps_status reserve(mps__bound_rows *f, mps__ppe *e)
{
    const size_t n = (size_t)e->n, entries = (size_t)e->entries,
                 columns = e->problem.ranks ? (size_t)e->columns : 0,
                 bytes = (4 * n + columns) * sizeof(double) + entries * sizeof *f->kept +
                         4 * n * sizeof *f->active;
    f->least = mps__device_fit(e->device, &e->on_device[MPS__PPE_BOUNDS], bytes);
    if (!f->least) return MPS_E_NOMEM;
    f->margin = f->least + n;
    f->kept_rhs = f->margin + n;
    f->kept_shift = f->kept_rhs + n;
    f->fixed = f->kept_shift + n;
    f->kept = (float *)(void *)(f->fixed + columns);
    f->bounded = (uint8_t *)(void *)(f->kept + entries);
    f->active = f->bounded + n;
    f->next = f->active + n;
    f->changed = f->next + n;
    return MPS_OK;
}

mps_status mps__bounds_begin_device(mps__bounds *b, mps__ppe *e, const mps_view *s,
                                    const mps__ppe_terms *t)
{
    b->rows = (mps__bound_rows){.row = e->row,
                                .col = e->col,
                                .val = e->val,
                                .particle = e->particle,
                                .diagonal = e->diagonal,
                                .rhs = e->rhs,
                                .shift = e->shift,
                                .p = e->p,
                                .value = t->value,
                                .density = t->flux->density,
                                .condition = t->condition,
                                .active_before = b->active,
                                .rows = e->n,
                                .nearly = MPS__BOUNDS_NEARLY,
                                .speed = s->velocity_scale};
    MPS__TRY(reserve(&b->rows, e));
    b->device = e->device;
    b->unknowns = e->n;
    run(b, e, &begin_rows);
    return MPS_OK;
}

mps_status mps__bounds_fix_device(const mps__bounds *b, const mps__ppe *e)
{
    if (e->problem.ranks) {
        run(b, e, &write_fixed_rows);
        if (mps_ppe_halo(&e->problem, b->rows.fixed)) return mps__ranks_status(e->ghosts->ranks);
    }
    run(b, e, &fix_rows);
    return MPS_OK;
}

void mps__bounds_restore_device(const mps__bounds *b, const mps__ppe *e)
{
    run(b, e, &free_rows);
}

void mps__bounds_look_device(void *bounds, double *to)
{
    const mps__bounds *b = bounds;
    mps__values_reduce_async(b->device, &choose_rows, MPS__ANY_DIM, b->unknowns, &b->rows, to);
}

bool mps__bounds_choose_device(mps__bounds *b, const mps__ppe *e, double seen)
{
    uint8_t *before = b->rows.active;
    double changed = seen;
    if (isnan(seen)) {
        changed = 0;
        mps__values_run(e->parallel, &choose_rows, MPS__ANY_DIM, e->n, &b->rows, NULL, &changed);
    }
    b->rows.active = b->rows.next;
    b->rows.next = before;
    return changed > 0;
}

void mps__bounds_conditions_device(const mps__bounds *b, const mps__ppe *e)
{
    run(b, e, &condition_rows);
}

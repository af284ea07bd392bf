/* SPDX-License-Identifier: BSD-3-Clause */
/* Arrays of the unknowns besides the matrix: position, weight, first guess; and the pressures of
 * the particles from the solution. */
#include "ppe.h"
#include "levels.h"
#include "loop.h"
#include <string.h>

/* Includes columns of other ranks. */
typedef struct notes {
    const double *place, *pressure; /* by particle */
    const int32_t *particle;
    int64_t rows;
    double dt2;
    double shift[3];
    double *x, *p, *weight;
} notes;

MPS_ROW void note_row(const int dim, const notes *a, int64_t r)
{
    const int64_t i = a->particle[r];
    a->p[r] = a->pressure[i];
    for (int d = 0; d < dim; d++) a->x[r * dim + d] = a->place[i * dim + d] - a->shift[d];
    if (r < a->rows) a->weight[r] = a->dt2;
}
MPS__LOOP(note_rows, note_row, notes)

void mps__ppe_point(mps_ppe_problem *problem, const mps__ppe *e)
{
    problem->row = e->row;
    problem->col = e->col;
    problem->val = e->val;
    problem->diagonal = e->diagonal;
    problem->rhs = e->rhs;
    problem->shift = e->shift;
    problem->weight = e->weight;
    problem->x = e->x;
    problem->gas = e->gas;
    problem->law = e->law;
    problem->parallel = e->device ? &e->device->parallel : e->parallel;
}

mps_status mps__ppe_note(mps__ppe *e, const mps_view *s, const mps__ppe_terms *t)
{
    const double *shift = s->tank.shift;
    const notes a = {s->x, t->pressure,   e->particle,
                     e->n, s->dt * s->dt, {shift[0], shift[1], shift[2]},
                     e->x, e->p,          e->weight};
    memcpy(e->moved, shift, sizeof e->moved);
    mps__loop_run(e->parallel, &note_rows, s->dim, e->columns, &a);
    MPS__TRY(mps__ppe_ranks_set(e));
    e->problem = (mps_ppe_problem){.struct_size = sizeof e->problem,
                                   .dim = s->dim,
                                   .n = e->n,
                                   .dp = s->dp,
                                   .ranks = e->ranks.ranks > 1 ? &e->ranks : NULL};
    mps__ppe_point(&e->problem, e);
    mps__levels_look(e);
    if (e->device) return mps__device_status(e->device);
    return e->lacking ? mps__ppe_close(e, s) : MPS_OK;
}

mps_status mps__ppe_close(mps__ppe *e, const mps_view *s)
{
    MPS__TRY(mps__levels_find(e, s->id, &e->problem.components));
    e->problem.component = e->problem.components > 0 ? e->component : NULL;
    return MPS_OK;
}

typedef struct scatter {
    const int32_t *unknown, *condition;
    const double *solution, *value;
    double *p;
} scatter;

MPS_ROW void scatter_row(const scatter *c, int64_t i)
{
    if (c->unknown[i] >= 0)
        c->p[i] = c->solution[c->unknown[i]];
    else
        c->p[i] = c->condition[i] == MPS_ROW_FIXED ? c->value[i] : 0;
}
MPS__LOOP_ANY(scatter_rows, scatter_row, scatter)

void mps__ppe_scatter(const mps__ppe *e, const mps_view *s, const mps__ppe_terms *t, double *p)
{
    mps__loop_run(e->parallel, &scatter_rows, s->dim, s->n,
                  &(scatter){e->unknown, t->condition, e->p, t->value, p});
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Gas pockets from step to step. A component of the void gets the gas of the pockets of the last
 * step that it overlaps. A pocket that overlaps several components is divided in proportion to the
 * overlap volumes; the part that overlaps the ambient is vented. A component that was ambient
 * before becomes a closed pocket, with gas at ambient pressure. A void that opens inside the liquid
 * has no gas. */
#include "gas_pocket.h"

/* Ambient fraction of a component: from which on it closes; from which on an old pocket takes in
 * ambient gas. Ambient fraction of an old pocket from which on it is open: a moving surface at a
 * neck changes less. */
static const double CLOSES = 0.3, TAKES_IN = 0.2, OPEN = 0.1;

static int32_t *overlap_of(const mps__pocket_now *now, int32_t old, int32_t component)
{
    return now->overlap + (size_t)component * (size_t)(MPS__POCKET_FIRST + old);
}

/* Count the cells of each component by their label in the last step. */
static void count_overlaps(const mps_voids *v, const mps__pocket_old *old, mps__pocket_now *now)
{
    const int32_t pockets = (int32_t)old->head->pockets;
    const int64_t runs = (int64_t)old->head->runs,
                  all = (int64_t)v->cells[0] * v->cells[1] * v->cells[2];
    int64_t cell = 0;
    if (v->count < 2 && pockets == 0) return; /* the ambient alone stays the ambient */
    for (int64_t r = 0; r < runs; r++) {
        const int64_t length = (int64_t)old->run[2 * r],
                      end = length < all - cell ? cell + length : all;
        const int32_t before = (int32_t)old->run[2 * r + 1];
        while (cell < end) {
            const int64_t begin = cell;
            cell = mps__pocket_run(v->label, cell, end);
            if (v->label[begin] >= 0)
                overlap_of(now, pockets, v->label[begin])[before] += (int32_t)(cell - begin);
        }
    }
}

/* The ambient: the component with most of the previous ambient, initially the largest component. */
static int32_t find_open(const mps_voids *v, int32_t pockets, const mps__pocket_now *now)
{
    int32_t open = 0;
    for (int32_t k = 1; k < v->count; k++)
        if (overlap_of(now, pockets, k)[MPS__POCKET_OPEN] >
            overlap_of(now, pockets, open)[MPS__POCKET_OPEN])
            open = k;
    return open;
}

/* Volume of the overlap of a component with an old pocket. */
static double part(const mps_voids *v, const mps__pocket_now *now, int32_t k, int32_t cells)
{
    return now->geometry[k] * cells / mps_larger(1, v->size[k]);
}

/* Distribute the gas of an old pocket. */
static void share_pocket(const mps_voids *v, const mps__pocket *p, int32_t pockets, int32_t number,
                         mps__pocket_now *now, mps__pocket_head *head)
{
    const int32_t label = MPS__POCKET_FIRST + number;
    double sum = 0, cell = v->side * v->side * (v->dim == 3 ? v->side : 1);
    double open = v->count > 0 ? cell * overlap_of(now, pockets, now->open)[label] : 0;
    for (int32_t k = 0; k < v->count; k++)
        if (k != now->open) sum += part(v, now, k, overlap_of(now, pockets, k)[label]);
    if (open <= OPEN * (open + sum) && sum > 0) open = 0;
    sum += open;
    if (!(sum > open)) {
        head->vented += p->gas;
        return;
    }
    double left = p->gas;
    for (int32_t k = 0; k < v->count; k++) {
        mps__pocket *q = &now->pocket[k];
        if (k == now->open) continue;
        const double share = part(v, now, k, overlap_of(now, pockets, k)[label]) / sum;
        if (share == 0) continue;
        if (share > 0.5 && !(q->number > 0 && q->gas > share * p->gas)) {
            q->number = p->number;
            q->since = p->since;
        }
        q->gas += share * p->gas;
        q->volume += share * p->volume;
        q->flux += share * p->flux;
        left -= share * p->gas;
    }
    if (open > 0) head->vented += left;
}

/* Enclose ambient gas in a component. */
static void enclose(const mps_voids *v, const mps__pocket_old *old, mps__pocket_now *now, int32_t k,
                    mps__pocket_head *head)
{
    mps__pocket *q = &now->pocket[k];
    const int32_t pockets = old->head ? (int32_t)old->head->pockets : 0;
    const double size = v->size[k];
    const int32_t open = old->head ? overlap_of(now, pockets, k)[MPS__POCKET_OPEN] : v->size[k];
    double volume = 0;
    if (q->gas > 0) {
        if (open > TAKES_IN * size) volume = part(v, now, k, open);
    } else if (open > CLOSES * size && size >= now->least) {
        volume = now->geometry[k];
    }
    if (volume == 0 && q->gas == 0) return;
    if (q->number == 0) {
        q->number = ++head->serial;
        q->since = now->t;
    }
    q->gas += now->ambient * volume;
    q->volume += volume;
    head->closed += now->ambient * volume;
}

void mps__pocket_follow(const mps_voids *v, const mps__pocket_old *old, mps__pocket_now *now,
                        mps__pocket_head *head)
{
    now->open = 0;
    if (old->head) {
        const int32_t pockets = (int32_t)old->head->pockets;
        count_overlaps(v, old, now);
        now->open = find_open(v, pockets, now);
        for (int32_t k = 0; k < pockets; k++)
            share_pocket(v, &old->pocket[k], pockets, k, now, head);
    }
    for (int32_t k = 0; k < v->count; k++)
        if (k != now->open) enclose(v, old, now, k, head);
}

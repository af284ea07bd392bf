/* SPDX-License-Identifier: BSD-3-Clause */
/* State of the model gas.pocket: pockets between steps. */
#include "gas_pocket.h"
#include <stdio.h>
#include <string.h>

enum {
    HEAD = sizeof(mps__pocket_head) / sizeof(double),
    POCKET = sizeof(mps__pocket) / sizeof(double)
};

/* Largest compression of a pocket: limits erroneous sums, beyond all impacts. */
static const double RATIO = 100;

double mps__pocket_pressure(const double *setting, double gas, double volume)
{
    const double least = gas / RATIO;
    if (!(gas > 0)) return 0;
    return setting[MPS__POCKET_AMBIENT] *
           mps_expm1(setting[MPS__POCKET_EXPONENT] * mps_log(gas / mps_larger(volume, least)));
}

mps__pocket_old mps__pocket_read(const mps_stage *s)
{
    int64_t count = 0;
    const double *state = mps_stage_state_get(s, &count);
    if (count < HEAD) return (mps__pocket_old){0};
    const mps__pocket_head *head = (const mps__pocket_head *)(const void *)state;
    return (mps__pocket_old){.head = head,
                             .pocket = (const mps__pocket *)(const void *)(state + HEAD),
                             .run = state + HEAD + POCKET * (int64_t)head->pockets};
}

mps__pocket_head *mps__pocket_open(mps_stage *s, mps__pocket **pocket)
{
    int64_t size = 0;
    mps_stage_state_get(s, &size);
    double *state = mps_stage_state(s, size);
    if (!state) return NULL;
    if (pocket) *pocket = (mps__pocket *)(void *)(state + HEAD);
    return (mps__pocket_head *)(void *)state;
}

/* Label of a component in the runs. label: [count] of all components */
static double label_of(int32_t component, const int32_t *label)
{
    return component < 0 ? MPS__POCKET_NONE : label[component];
}

/* Runs of equal labels. run: NULL, or out */
static int64_t runs(const mps_voids *v, const int32_t *label, double *run)
{
    const int64_t all = (int64_t)v->cells[0] * v->cells[1] * v->cells[2];
    int64_t count = 0;
    for (int64_t begin = 0, cell = 0; begin < all; begin = cell) {
        const double own = label_of(v->label[begin], label);
        while (cell < all && label_of(v->label[cell], label) == own)
            cell = mps__pocket_run(v->label, cell, all);
        if (run) {
            run[2 * count] = (double)(cell - begin);
            run[2 * count + 1] = own;
        }
        count++;
    }
    return count;
}

int mps__pocket_write(mps_stage *s, const mps_voids *v, const mps__pocket_now *now,
                      mps__pocket_head *head)
{
    int32_t *label = mps_stage_scratch_integers(s, v->count + 1), pockets = 0;
    if (!label) return 1;
    for (int32_t k = 0; k < v->count; k++)
        label[k] = now->pocket[k].gas > 0 ? MPS__POCKET_FIRST + pockets++ : MPS__POCKET_NONE;
    if (v->count > 0) label[now->open] = MPS__POCKET_OPEN;
    const int64_t count = runs(v, label, NULL);
    double *state = mps_stage_state(s, HEAD + POCKET * pockets + 2 * count);
    if (!state) return 1;
    head->layout = MPS__POCKET_LAYOUT;
    head->pockets = pockets;
    head->runs = (double)count;
    if (pockets == 0) head->ambient = 0;
    head->dt = s->view->dt;
    head->open = now->open;
    head->moved = head->waited = 0;
    for (int d = 0; d < 3; d++) head->cells[d] = v->cells[d];
    memcpy(state, head, sizeof *head);
    for (int32_t k = 0; k < v->count; k++) {
        if (label[k] < MPS__POCKET_FIRST) continue;
        now->pocket[k].place = k;
        memcpy(state + HEAD + POCKET * (label[k] - MPS__POCKET_FIRST), &now->pocket[k],
               sizeof(mps__pocket));
    }
    runs(v, label, state + HEAD + POCKET * pockets);
    return 0;
}

/* ---- states of checkpoints ---- */

static bool is_count(double x, double most)
{
    return x >= 0 && x <= most && x == floor(x);
}

/* Whether the runs fill the raster of the head and have labels of its pockets. */
static bool are_runs(const mps__pocket_head *head, const double *run)
{
    double all = 1, sum = 0;
    for (int d = 0; d < 3; d++) {
        if (!is_count(head->cells[d], INT32_MAX)) return false;
        all *= head->cells[d];
    }
    for (int64_t r = 0; r < (int64_t)head->runs; r++) {
        if (!(run[2 * r] > 0) || !is_count(run[2 * r], all) ||
            !is_count(run[2 * r + 1], MPS__POCKET_FIRST + head->pockets - 1))
            return false;
        sum += run[2 * r];
    }
    return sum == all;
}

int mps__pocket_check(const double *numbers, int64_t count, char *why, size_t size)
{
    const mps__pocket_head *head = (const mps__pocket_head *)(const void *)numbers;
    if (count == 0) return 0; /* before the first step */
    if (numbers[0] != MPS__POCKET_LAYOUT) {
        snprintf(why, size, "their layout is %g, of another build; must be %g", numbers[0],
                 MPS__POCKET_LAYOUT);
        return 1;
    }
    if (count < HEAD || !is_count(head->pockets, (double)count) ||
        !is_count(head->runs, (double)count) ||
        HEAD + POCKET * (int64_t)head->pockets + 2 * (int64_t)head->runs != count) {
        snprintf(why, size,
                 "there are %lld, which is not %d, %d for each pocket and 2 for each run",
                 (long long)count, (int)HEAD, (int)POCKET);
        return 1;
    }
    const mps__pocket *pocket = (const mps__pocket *)(const void *)(numbers + HEAD);
    for (int64_t k = 0; k < (int64_t)head->pockets; k++)
        if (!(pocket[k].gas > 0)) {
            snprintf(why, size, "the gas of pocket %lld is %g; must be > 0", (long long)k,
                     pocket[k].gas);
            return 1;
        }
    if (!are_runs(head, numbers + HEAD + POCKET * (int64_t)head->pockets)) {
        snprintf(why, size, "the labels of the raster do not fill it, or are of no pocket");
        return 1;
    }
    return 0;
}

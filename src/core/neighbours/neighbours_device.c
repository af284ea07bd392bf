/* SPDX-License-Identifier: BSD-3-Clause */
/* Search of candidates on a device, where a thread has no buffer: each row is counted, then filled.
 * Candidates and order are those of neighbours.c, for particles in cell order. */
#include "neighbours_rows.h"
#include "loop.h"
#include "scan.h"
#include <math.h>

/* What a row function reads. */
typedef struct seeking {
    mps__rings rings;
    double reach2;
    int64_t n, dummy_rows; /* particles; 0: dummies get no rows */
    mps__search_arrays at;
} seeking;

/* Numbers of candidates of a row, by ring. */
typedef struct counted {
    int64_t near, far, out;
} counted;

MPS_ROW double square_to(const int dim, const seeking *s, int64_t i, int64_t j)
{
    return mps__square_between(s->at.x + i * dim, s->at.x + j * dim, dim);
}

/* Solids without fluid in reach get no pairs. Begin and ends of the row hold lengths until the
 * scan. */
MPS_ROW void count_row(const int dim, const seeking *s, int64_t i)
{
    const mps__search_arrays *a = &s->at;
    const bool solid = a->kind[i] != MPS_FLUID;
    bool fluid = !solid, dummies = false;
    counted c = {0, 0, 0};
    int64_t range[9][2];
    const int ranges = mps__ranges_around(dim, a->key, s->n, a->key[i], range);
    for (int k = 0; k < ranges; k++)
        for (int64_t j = range[k][0]; j < range[k][1]; j++) {
            const double r2 = square_to(dim, s, i, j);
            const int ring = mps__ring_of(&s->rings, r2);
            dummies = dummies || a->kind[j] == MPS_DUMMY;
            if (j == i || !(r2 < s->reach2)) continue;
            fluid = fluid || a->kind[j] == MPS_FLUID;
            c.near += ring == 0;
            c.far += ring == 1;
            c.out += ring == 2;
        }
    a->near_dummies[i] = dummies && !solid;
    a->idle[i] = !fluid || (a->kind[i] == MPS_DUMMY && !s->dummy_rows);
    if (a->idle[i]) c = (counted){0, 0, 0};
    a->middle[i] = c.near;
    a->end[i] = c.near + c.far;
    a->begin[i] = c.near + c.far + c.out;
    a->count[i] = (int32_t)a->begin[i];
}
MPS__LOOP(count_rows, count_row, seeking)

/* Longest row, and prefix sum of the lengths. */
MPS_ROW void measure_row(const seeking *s, int64_t i, double *most)
{
    const double count = s->at.count[i], sum = (double)s->at.begin[i];
    if (count > most[0]) most[0] = count;
    if (sum > most[1]) most[1] = sum;
}
MPS__VALUES_ANY(measure_rows, measure_row, seeking, 0, 2)

/* During the fill, the begin of a row is the end of its candidates so far. */
MPS_ROW void fill_row(const int dim, const seeking *s, int64_t i)
{
    const mps__search_arrays *a = &s->at;
    const int64_t begin = a->begin[i] - a->count[i], nears = a->middle[i], within = a->end[i];
    int32_t *near = a->col + begin, *far = near + nears, *out = near + within;
    int64_t range[9][2];
    const int ranges = a->count[i] > 0 ? mps__ranges_around(dim, a->key, s->n, a->key[i], range)
                                       : 0;
    a->begin[i] = begin;
    a->middle[i] = begin + nears;
    a->end[i] = begin + within;
    for (int k = 0; k < ranges; k++)
        for (int64_t j = range[k][0]; j < range[k][1]; j++) {
            const double r2 = square_to(dim, s, i, j);
            const int ring = mps__ring_of(&s->rings, r2);
            if (j == i || !(r2 < s->reach2)) continue;
            if (ring == 0)
                *near++ = (int32_t)j;
            else if (ring == 1)
                *far++ = (int32_t)j;
            else
                *out++ = (int32_t)j;
        }
}
MPS__LOOP(fill_rows, fill_row, seeking)

static seeking seeking_of(const mps_neighbours *l, const mps__search_arrays *on_device)
{
    return (seeking){.rings = mps__rings_of(l),
                     .reach2 = (l->re_far + l->skin) * (l->re_far + l->skin),
                     .dummy_rows = l->dummy_rows,
                     .n = l->n,
                     .at = *on_device};
}

mps_status mps__neighbours_count_device(mps_neighbours *l, const mps__search_arrays *on_device)
{
    const seeking s = seeking_of(l, on_device);
    double most[2] = {0, 0};
    mps__neighbours_keys(l, on_device->x, on_device->key);
    mps__loop_run(l->parallel, &count_rows, l->dim, l->n, &s);
    mps__scan(l->parallel, on_device->begin, l->n);
    mps__values_run(l->parallel, &measure_rows, MPS__ANY_DIM, l->n, &s, NULL, most);
    l->pairs = (int64_t)most[1];
    l->longest = most[0] > MPS__ROW ? (int64_t)most[0] : 0;
    return mps__neighbours_fit(l, (void **)&l->col, &l->pair_capacity, l->pairs, sizeof *l->col);
}

void mps__neighbours_fill_device(mps_neighbours *l, const mps__search_arrays *on_device)
{
    const seeking s = seeking_of(l, on_device);
    mps__loop_run(l->parallel, &fill_rows, l->dim, l->n, &s);
}

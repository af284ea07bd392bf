/* SPDX-License-Identifier: BSD-3-Clause */
/* What the search of pairs and the rows at later positions share. */
#ifndef MPS_CORE_NEIGHBOURS_ROWS_H
#define MPS_CORE_NEIGHBOURS_ROWS_H

#include "neighbours.h"
#include <mps/stage.h>
#include <string.h>

/* Rows up to this length are worked on in the stack; longer ones are an exception. */
enum { MPS__ROW = 1024 };

/* Squares of the distances between which pairs are near, far and out of reach. */
typedef struct mps__rings {
    double least, near2, far2;
} mps__rings;

mps__rings mps__rings_of(const mps_neighbours *l);

/* Ascending columns. */
void mps__sort_row(int32_t *row, int64_t n);

/* Near pairs of a row, and the others within reach. */
typedef struct mps__parted {
    int64_t near, far;
} mps__parted;

/* Put candidates, whose squared distances are r2, into `row`: near pairs, then the others within reach, then what is out of it, the last two
 * by way of `far` and `out`. `from` may be `row`. Each candidate is written to all three and counted at one: no branches. */
MPS_ROW mps__parted mps__part_row(const mps__rings *g, const int32_t *from, const double *r2,
                                  int64_t count, int32_t *row, int32_t *far, int32_t *out)
{
    const double least = g->least, near2 = g->near2, far2 = g->far2;
    int64_t nears = 0, fars = 0, outs = 0;
    for (int64_t k = 0; k < count; k++) {
        const int32_t j = from[k];
        const bool within = (r2[k] < far2) & (r2[k] >= least), close = within & (r2[k] < near2);
        row[nears] = far[fars] = out[outs] = j;
        nears += close;
        fars += within & !close;
        outs += !within;
    }
    memcpy(row + nears, far, (size_t)fars * sizeof *row);
    memcpy(row + nears + fars, out, (size_t)outs * sizeof *row);
    return (mps__parted){nears, fars};
}

/* Part rows that the search found too long for the stack. */
mps_status mps__neighbours_part_long(mps_neighbours *l);
/* Room for `count` entries, not kept and not zeroed in what was there. Too much is given back: the first search has rows of all solids. */
mps_status mps__neighbours_fit(mps_neighbours *l, void **block, int64_t *capacity, int64_t count,
                               size_t size);

#endif

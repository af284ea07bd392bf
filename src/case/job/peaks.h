/* SPDX-License-Identifier: BSD-3-Clause */
/* The highest peaks of each pressure, as the rows of probes.csv show them, and the times about them
 * at which frames are wanted.
 *
 * A frame of the present state is written while a pressure rises, because it is not known before its
 * peak how high it will be; frames that are about none of the highest peaks any more are removed.
 * All follows from the rows alone, up to the present one: a run that goes on from a checkpoint
 * reads them again and has the same frames, whatever its end was and is. */
#ifndef MPS_CASE_PEAKS_H
#define MPS_CASE_PEAKS_H

#include <stdbool.h>

enum { PEAKS_SIGNALS = 24, PEAKS_KEPT = 10, PEAKS_ALL = 40 };

/* A peak, and the times between which frames are wanted [s]. */
typedef struct peak {
    double p, rise, from, to; /* rise: above the least value before it [Pa] */
} peak;

/* A pressure. */
typedef struct peak_signal {
    int column; /* of a row */
    double low[2],
        turn;       /* least values of the present and the last interval; end of the present one */
    double highest; /* rise of all peaks so far */
    bool open;      /* it rises, or has risen and not fallen to a half */
    double begin, last; /* of the rise; time of the last frame for it */
    peak now;           /* while it is open */
    int count;
    peak kept[PEAKS_KEPT]; /* from the highest */
} peak_signal;

typedef struct peaks {
    int signals, most;             /* most: peaks of each */
    double start, interval, apart; /* no peak before; of a rise; least time between frames [s] */
    bool due;                      /* a frame is wanted now */
    bool changed;                  /* some frames may be wanted no more */
    peak_signal signal[PEAKS_SIGNALS];
} peaks;

/* Then add each pressure. @param most  peaks of each pressure; of many pressures it becomes less */
void mps__peaks_init(peaks *p, int most, double start, double interval, double apart);
void mps__peaks_add(peaks *p, int column);
/* Take a row, of which the first number is the time: p->due and p->changed say what to do. */
void mps__peaks_row(void *peaks, const double *row);
/* Is a frame at t about one of the peaks? */
bool mps__peaks_wants(const peaks *p, double t);

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* Finds the highest peaks of each pressure in the rows of probes.csv, and the times about them at
 * which frames are wanted. A frame is written while a pressure rises, because the height of its
 * peak is not known yet; frames that are no longer near one of the highest peaks are removed. All
 * depends on the rows up to the present one alone: a run continued from a checkpoint reads them
 * again and has the same frames, whatever its end. */
#ifndef MPS_CASE_PEAKS_H
#define MPS_CASE_PEAKS_H

#include <stdbool.h>

enum { PEAKS_SIGNALS = 24, PEAKS_KEPT = 10, PEAKS_ALL = 40 };

/* A peak, and the times between which frames are wanted [s]. */
typedef struct peak {
    double p, rise, from, to; /* rise: above the lowest value before it [Pa] */
} peak;

/* The state of one pressure. */
typedef struct peak_signal {
    int column; /* index in a row */
    /* lowest values of the present and the last interval; end of the present one */
    double low[2], turn;
    double highest;     /* rise of all peaks so far */
    bool open;          /* it rises, or has risen and not yet fallen to half */
    double begin, last; /* of the rise; time of the last frame for it */
    peak now;           /* valid while `open` */
    int count;
    peak kept[PEAKS_KEPT]; /* from the highest */
} peak_signal;

typedef struct peaks {
    int signals, most; /* most: peaks per pressure */
    /* no peak before; duration of a rise; least time between frames [s] */
    double start, interval, apart;
    bool due;     /* a frame is wanted now */
    bool changed; /* some frames may no longer be wanted */
    peak_signal signal[PEAKS_SIGNALS];
} peaks;

/* Initialise; then add each pressure.
 * @param most  peaks of each pressure; reduced for many pressures */
void mps__peaks_init(peaks *p, int most, double start, double interval, double apart);
void mps__peaks_add(peaks *p, int column);
/* Process a row, whose first number is the time: sets p->due and p->changed. */
void mps__peaks_row(void *peaks, const double *row);
/* Whether a frame at t is near one of the peaks. */
bool mps__peaks_wants(const peaks *p, double t);

#endif

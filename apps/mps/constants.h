/* SPDX-License-Identifier: BSD-3-Clause */
/* Constants of the statistics of a run, with what --set changes. */
#ifndef MPS_APPS_CONSTANTS_H
#define MPS_APPS_CONSTANTS_H

#include "cli.h"
#include <mps/stats.h>

/* Those of the run, and those that are used. */
typedef struct constants {
    mps_stats_config run, used;
    char error[640];
} constants;

/* Defaults, with room for the text of an error. */
void constants_begin(constants *k);
/* Those of a folder, then each --set. @return MPS_OK, or a failure with its text in k->error */
mps_status constants_read(constants *k, const choices *c, const char *folder);
/* Lines: which are set, which the run says; nothing of defaults. */
void constants_print(const constants *k, const choices *c, const char *folder);
/* A quantity as a person rounds it, "33.3 kPa", into one of a few buffers, which later calls use again. */
const char *quantity(double value, const char *unit);
/* Print a blank and the same, at the right of `width` characters; "-" for nan. */
void print_quantity(int width, double value, const char *unit);
/* The same of a moment of the run, with the digits that find it in a table. */
void print_time(int width, double t);

#endif

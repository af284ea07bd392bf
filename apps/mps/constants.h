/* SPDX-License-Identifier: BSD-3-Clause */
/* Constants of the statistics of a run, with the changes of --set. */
#ifndef MPS_APPS_CONSTANTS_H
#define MPS_APPS_CONSTANTS_H

#include "cli.h"
#include <mps/stats.h>

/* Constants of the run, and those in use. */
typedef struct constants {
    mps_stats_config run, used;
    char error[640];
} constants;

/* Set defaults, and the buffer of the error text. */
void constants_begin(constants *k);
/* Read those of a folder, then apply each --set.
 * @return MPS_OK, or a failure with its text in k->error */
mps_status constants_read(constants *k, const choices *c, const char *folder);
/* Print constants that are set, and those of the run; no defaults. */
void constants_print(const constants *k, const choices *c, const char *folder);
/* A rounded quantity, "33.3 kPa", in one of a few buffers that later calls reuse. */
const char *quantity(double value, const char *unit);
/* Print a blank and the quantity, right-aligned in `width` characters; "-" for nan. */
void print_quantity(int width, double value, const char *unit);
/* Print a blank and a time of the run, with the digits that locate it in a table. */
void print_time(int width, double t);

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* Sections of a page in HTML. Each writes to `out`, or nothing if the run has no such data. */
#ifndef MPS_POST_PAGE_PARTS_H
#define MPS_POST_PAGE_PARTS_H

#include "page_film.h"

/* Title of the run. */
const char *mps__page_title(const page_run *r);
/* Whether the run is in progress, or was killed: its summary is older than its end. */
bool mps__page_is_unfinished(const page_run *r);
/* Title and the main numbers of the run in a line. */
void mps__page_head(FILE *out, const page_run *r);
/* Checks: what is good, what is not, and what to do. */
void mps__page_summary(FILE *out, const page_run *r);
/* Time in which liquid crosses a spacing, at t [s]; NAN: not known. */
double mps__page_crossing(const page_run *r, double t);
/* Whether the highest peak of a sensor is steep. */
bool mps__page_has_impacts(const page_run *r);
/* Stage of the film, its controls, and space for the curves beside it. */
void mps__page_stage(FILE *out, const page_run *r, bool has_film, const char *note);
/* Tank, level and sensors. */
void mps__page_sketch(FILE *out, const page_run *r);
/* Table of the largest and least values of some columns. */
void mps__page_extremes(FILE *out, const page_run *r, const char *caption,
                        bool (*wanted)(const page_column *c));
/* Events of the sensors, the distribution of their peaks, and the highest ones; plots while the
 * total is below `bytes`. */
mps_status mps__page_impacts(FILE *out, const page_run *r, int64_t bytes);
/* Figures of the columns that have reference values. */
mps_status mps__page_comparison(FILE *out, const page_run *r);
/* Curves of forces and moments with their extremes. */
void mps__page_forces(FILE *out, const page_run *r);
/* The energy budget as text. */
void mps__page_budget(FILE *out, const page_run *r);
/* Pictures of the folder, while they need at most `bytes`. */
mps_status mps__page_pictures(FILE *out, const page_run *r, int64_t bytes);
/* Inputs, numbers of the case, machine, command, the case itself. */
void mps__page_about(FILE *out, const page_run *r);
/* All columns as packed curves, at most `bytes` of base64. */
mps_status mps__page_curves(FILE *out, const page_run *r, int64_t bytes);

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* Quantities of fluid and tank by name: the table of mps_measure_info_get(), and their values. */
#ifndef MPS_CASE_MEASURE_H
#define MPS_CASE_MEASURE_H

#include "cavity.h"
#include <mps/job.h>

enum { QUANTITY_ERROR = 320 };

typedef struct quantity quantity;

/* An entry of the table. */
typedef struct measure_kind {
    mps_measure_info info;
    const char *about; /* of its column, as in mps_job_value_add() */
    int32_t flags;     /* sum of MPS_JOB_... */
    bool by_axis;      /* `about` ends in the letter of the axis */
    /* NULL, or: prepare what `value` needs */
    mps_status (*open)(quantity *q, mps_sim *sim);
    double (*value)(quantity *q, mps_sim *sim);
} measure_kind;

/* A measure in use. */
struct quantity {
    const measure_kind *kind;
    mps_measure measure; /* without its texts; `box` is never all 0 */
    const mps_job_ranks *ranks;
    int32_t dim;
    double dp, start;
    raster grid;
    cavities gas;
    int64_t bins; /* along the tank, two spacings long */
    double *furthest;
};

/* Entry of this name, or NULL. */
const measure_kind *mps__measure_find(const char *name);
/* @param ranks  NULL: one process @param error  [QUANTITY_ERROR] out */
mps_status mps__quantity_create(mps_sim *sim, const mps_measure *measure,
                                const mps_job_ranks *ranks, quantity **out, char *error);
/* A mps_job_value_fn; user: a quantity. */
double mps__quantity_value(void *user, mps_sim *sim);
void mps__quantity_free(quantity *q);

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* Columns of probes.csv in the folder of a run. */
#ifndef MPS_APPS_RECORD_H
#define MPS_APPS_RECORD_H

#include <mps/series.h>
#include <stdbool.h>
#include <stddef.h>

/* The record of a run, or a table alone. */
typedef struct record {
    const char *place; /* folder or file, as given */
    bool is_folder;
    mps_table *table;
} record;

/* Write "folder/name" to out. @return false: the buffer is too small */
bool record_path(const char *folder, const char *name, char *out, size_t size);
/* Read probes.csv of a folder, or a CSV file. The text of a failure is in config->error. */
mps_status record_read(const mps_stats_config *config, const char *place, record *r);
void record_free(record *r);
/* Reference values of the case of a run. MPS_E_NAME without a text: there are no more. */
mps_status record_read_reference(const mps_stats_config *config, const char *folder, int32_t index,
                                 record *r);
/* A column by its name; -1: none. */
int32_t record_find(const record *r, const char *name);
/* The column with the most similar name, "" without columns. */
const char *record_nearest(const record *r, const char *name);
/* Last time of probes.csv in a folder, NAN without rows. */
double record_last(const char *folder);
/* Last time of the table, NAN without rows. */
double record_end(const record *r);

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* Tables of numbers that a case names: messages and units for csv.h. */
#ifndef MPS_CASE_CASE_CSV_H
#define MPS_CASE_CASE_CSV_H

#include "csv.h"
#include "tree.h"

/* Open a file and read its names; then read the wanted columns. A failure has a message at `at`.
 * Free the table with mps__csv_free() in any case. */
bool mps__case_csv_open(mps_case *c, const tree_node *at, const char *path, mps__csv *t);
bool mps__case_csv_read(mps_case *c, const tree_node *at, mps__csv *t);
/* Index of a column. -1: not found, with a message if `needed`, or several columns have this name,
 * with a message. */
int32_t mps__case_csv_find(mps_case *c, const tree_node *at, const mps__csv *t, const char *name,
                           bool needed);
/* Factor to SI of a column whose unit must be of these kinds; NAN after a message.
 * @param unit  that of the case; NULL: only that of the table is used. If both are given, they must
 * agree. */
double mps__case_csv_factor(mps_case *c, const tree_node *at, const mps__csv *t, int32_t column,
                            uint64_t kinds, const char *unit);
/* The unit of a table: as in a case, also "°", "Deg", "sec"; NULL: unknown. */
const struct mps__unit *mps__case_csv_unit(const char *text);

#endif

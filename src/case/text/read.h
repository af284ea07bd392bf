/* SPDX-License-Identifier: BSD-3-Clause */
/* Reads values of a checked case in SI units, by key below a map. A value that is not given is
 * `otherwise`. A value that cannot be read (T1 is not known, or the value is out of its range once
 * dp is known) produces a message and is `otherwise` too. Each call marks what it reads:
 * mps__case_unread() finds what no call has read. */
#ifndef MPS_CASE_READ_H
#define MPS_CASE_READ_H

#include "tree.h"
#include "units.h"

const tree_node *mps__case_root(const mps_case *c);
double mps__read_number(mps_case *c, const tree_node *map, const char *key, double otherwise);
/* Whether the value is given with a unit of this kind; UNIT_NONE: a number without a unit. */
bool mps__read_is(mps_case *c, const tree_node *map, const char *key, uint64_t kind);
/* @param out  [most] @return number of values, 0: not given, or an error with its message */
int32_t mps__read_numbers(mps_case *c, const tree_node *map, const char *key, int32_t most,
                          double *out);
/* mps__read_numbers() of the node itself, for points of lists. */
int32_t mps__read_values(mps_case *c, const tree_node *node, int32_t most, double *out);
const char *mps__read_text(mps_case *c, const tree_node *map, const char *key,
                           const char *otherwise);
/* Text number `index` of a list of texts, or of a single text; NULL: none. */
const char *mps__read_text_at(mps_case *c, const tree_node *map, const char *key, int32_t index);
/* The absolute name of a file; NULL: not given, or memory is exhausted. */
const char *mps__read_path(mps_case *c, const tree_node *map, const char *key);
bool mps__read_flag(mps_case *c, const tree_node *map, const char *key, bool otherwise);
/* Index into the words of the key in the table. */
int32_t mps__read_choice(mps_case *c, const tree_node *map, const char *key, int32_t otherwise);
/* A unit in SI, `mm` is 0.001. */
double mps__read_unit(mps_case *c, const tree_node *map, const char *key, double otherwise);
/* The number of a node below `settings`, in the unit of libmps. */
double mps__read_setting(mps_case *c, const tree_node *node, double otherwise);
/* Mark a node and all nodes below it as read: for values read elsewhere, or without effect on a
 * run. */
void mps__read_all(const tree_node *node);
/* Set the scales of lengths in dp, times in T1 and lengths in %. */
void mps__case_scale_set(mps_case *c, read_scale scale);
/* The first value, in the order of the file, that no call has read; NULL: none. */
const tree_node *mps__case_unread(const mps_case *c);

#endif

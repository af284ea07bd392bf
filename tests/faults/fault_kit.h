/* SPDX-License-Identifier: BSD-3-Clause */
/* Calls of libmps_case that fail in turn: those to the system and those to libmps. The linker hands them to fault_kit.c. */
#ifndef FAULT_KIT_H
#define FAULT_KIT_H

#include <stdbool.h>
#include <stdint.h>

/* Places of calls that were seen so far. */
int32_t fault_places(void);
/* How often a place was reached since the last fault_arm(). A place that a run without a failure does not reach `visit` times cannot fail
 * there at that visit. */
int32_t fault_visits(int32_t place);
/* Forget them, for another scene. */
void fault_forget(void);
/* From now on calls are watched, and that at place `place` fails when it is reached for the `visit`-th time, from 1. Places have their numbers
 * in the order in which they are seen first. */
void fault_arm(int32_t place, int32_t visit);
/* Calls are not watched any more. @return the function that failed and its place as addr2line wants it, valid until the next
 * fault_arm(); NULL: the place was not reached so often */
const char *fault_disarm(void);

#endif

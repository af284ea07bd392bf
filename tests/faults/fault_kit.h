/* SPDX-License-Identifier: BSD-3-Clause */
/* Fault injection: calls from libmps_case to the system and to libmps fail in turn. The linker
 * redirects them to fault_kit.c. */
#ifndef FAULT_KIT_H
#define FAULT_KIT_H

#include <stdbool.h>
#include <stdint.h>

/* Number of call sites so far. */
int32_t fault_places(void);
/* Number of visits of a call site since the last fault_arm(). A call site with fewer than `visit`
 * visits in a run without failures cannot fail at that visit. */
int32_t fault_visits(int32_t place);
/* Forget them, for another scene. */
void fault_forget(void);
/* Start to count calls; the call at call site `place` fails at visit `visit`, from 1. Call sites
 * are numbered in the order of their first visit. */
void fault_arm(int32_t place, int32_t visit);
/* Stop to count calls. @return the failed function and its address for addr2line, valid until the
 * next fault_arm(); NULL: the call site had fewer visits */
const char *fault_disarm(void);

#endif

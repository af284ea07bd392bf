/* SPDX-License-Identifier: BSD-3-Clause */
/* Loads and motions of plug-ins. */
#ifndef MPS_CASE_DRIVE_H
#define MPS_CASE_DRIVE_H

#include "ship_motion.h"

typedef struct build_drive build_drive;

/* The load or motion, MPS_PLUGIN_..., that `plugin` below `map` names, with its settings. NULL:
 * none is given, or there is a message. */
const build_drive *mps__drive_read(build *b, const tree_node *map, int32_t kind);
/* Whether the name of a setting belongs to a load or motion. */
bool mps__drive_has(const build *b, const char *key);
/* Its shortest period [s]; infinite if it has none. */
double mps__drive_period(const build_drive *d);
/* For mps_motion_callback_set(), and for loads of bodies. */
int mps__drive_motion(void *drive, double t, mps_motion_state *state);
int mps__drive_load(const build_drive *d, double t, const mps_motion_state *state, double load[6]);

#endif

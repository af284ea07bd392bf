/* SPDX-License-Identifier: BSD-3-Clause */
/* Frames for ParaView. Writing and closing are public, see mps/output.h. */
#ifndef MPS_CORE_FRAMES_H
#define MPS_CORE_FRAMES_H

#include "world.h"
#include <mps/output.h>

/* kinds 0: fluid and wall. *frames is NULL on failure. */
mps_status mps__frames_open(mps__world *w, const char *folder, const char *name, int32_t kinds,
                            mps_frames **frames);

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* A picture of the particles as PNG: discs coloured by pressure, with a colour bar. */
#ifndef MPS_POST_PICTURE_H
#define MPS_POST_PICTURE_H

#include <mps/mps.h>
#include <stdbool.h>

enum { PICTURE_ERROR = 640 };

/* Draw the present state, in 3-D a slice one and a half spacings thick in the middle of z. @param gravity [m/s2], with the
 * speed it tells pressures from rounding. @param error  [PICTURE_ERROR] out: why not @return false: there is no picture */
bool mps__picture_save(mps_sim *sim, double gravity, const char *path, char *error);

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* A picture of the particles as PNG: discs coloured by pressure, with a colour bar. */
#ifndef MPS_EXAMPLES_PICTURE_H
#define MPS_EXAMPLES_PICTURE_H

#include <mps/mps.h>
#include <stdbool.h>

/* Draw the present state, in 3-D a slice one and a half spacings thick in the middle of z. @param gravity [m/s2], with the
 * speed it tells pressures from rounding. @return false with a message on stderr */
bool picture_save(mps_sim *sim, double gravity, const char *path);

#endif

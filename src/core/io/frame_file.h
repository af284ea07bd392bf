/* SPDX-License-Identifier: BSD-3-Clause */
/* The files of one frame. */
#ifndef MPS_CORE_FRAME_FILE_H
#define MPS_CORE_FRAME_FILE_H

#include "world.h"
#include <mps/output.h>
#include <stdio.h>

/* Write the particles of these kinds: of the store, without ghosts. kinds: a sum of
 * MPS_FRAMES_... */
void mps__frame_write(const mps__world *world, int32_t kinds, FILE *file);
/* Write the list of the pieces STEM_0000.vtp, ... in the same folder, which the ranks wrote. */
void mps__frame_write_pieces(const mps__world *world, const char *stem, int32_t pieces, FILE *file);

const char *mps__frame_byte_order(void);

#endif

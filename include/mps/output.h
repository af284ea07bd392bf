/* SPDX-License-Identifier: BSD-3-Clause */
/** @file output.h  Frames for ParaView: one .vtp file a frame and a .pvd series that is valid after every frame. */
#ifndef MPS_OUTPUT_H
#define MPS_OUTPUT_H

#include <mps/types.h>

MPS_BEGIN_DECLS

/** A series of frames. */
typedef struct mps_frames mps_frames;

/** Which particles go into a frame. */
enum { MPS_FRAMES_FLUID = 1, MPS_FRAMES_WALL = 2, MPS_FRAMES_DUMMY = 4 };

/** Open a series: writes `<folder>/<name>.pvd` and `<folder>/<name>/<name>_000000.vtp` ...; the folder must exist.
 *  Frames of an earlier series of the same folder and name are removed, other files are left alone.
 *  @param kinds   sum of MPS_FRAMES_..., 0 for fluid and wall
 *  @param frames  out; close with mps_frames_close(). The simulation must outlive it. */
MPS_API mps_status mps_frames_open(mps_sim *sim, const char *folder, const char *name, int32_t kinds, mps_frames **frames);

/** Write the present state: position, velocity, pressure, number density, density, kind, phase, id and all user fields.
 *  The .pvd is rewritten atomically. @return MPS_E_IO with the path and the system's reason */
MPS_API mps_status mps_frames_write(mps_frames *frames);

/** Close a series; NULL is allowed. */
MPS_API void mps_frames_close(mps_frames *frames);

MPS_END_DECLS

#endif

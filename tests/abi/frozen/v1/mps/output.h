/* SPDX-License-Identifier: BSD-3-Clause */
/** @file output.h  Frames for ParaView: one .vtp file a frame and a .pvd series that is valid after every frame; and checkpoints. */
#ifndef MPS_OUTPUT_H
#define MPS_OUTPUT_H

#include <mps/types.h>

MPS_BEGIN_DECLS

/** A series of frames. */
typedef struct mps_frames mps_frames;

/** Which particles go into a frame; and whether a series goes on. */
enum { MPS_FRAMES_FLUID = 1, MPS_FRAMES_WALL = 2, MPS_FRAMES_DUMMY = 4, MPS_FRAMES_CONTINUE = 8 };

/** Open a series: writes `<folder>/<name>.pvd` and `<folder>/<name>/<name>_000000.vtp` ...; the folder must exist.
 *  Frames of an earlier series of the same folder and name are removed, other files are left alone. With MPS_FRAMES_CONTINUE those up to
 *  the present time stay, later ones are removed, and the series goes on behind them: a run that was interrupted, after
 *  mps_checkpoint_read(). A state at the time of the last frame then takes its place, so that no time is there twice. Without a .pvd a
 *  series begins; MPS_E_IO, and nothing is removed, if that which is there is not as mps_frames_write() left it.
 *  @param kinds   sum of MPS_FRAMES_..., without any kind fluid and wall
 *  @param frames  out; close with mps_frames_close(). The simulation must outlive it. */
MPS_API mps_status mps_frames_open(mps_sim *sim, const char *folder, const char *name, int32_t kinds, mps_frames **frames);

/** Write the present state: position, velocity, pressure, number density, density, kind, phase, id and all user fields.
 *  The .pvd is rewritten atomically. @return MPS_E_IO with the path and the system's reason */
MPS_API mps_status mps_frames_write(mps_frames *frames);

/** Close a series; NULL is allowed. */
MPS_API void mps_frames_close(mps_frames *frames);

/** Write all that the next steps depend on to a file: particles with their fields and order, time, budgets, what probes keep for averages
 *  and samples. It is written beside its place ("<path>.tmp") and renamed, so that there is always a whole one; a
 *  link is replaced, not followed. In the byte order of the machine, with a checksum for each part; about 150 bytes a particle. May be
 *  called by a monitor. What a plug-in, a motion callback or a solver of the user keeps outside of fields is not in it.
 *  @return MPS_E_IO with the path and the system's reason, also where there is something that is no regular file; MPS_E_BUSY while a lease
 *          for writing is open; MPS_E_NOMEM */
MPS_API mps_status mps_checkpoint_write(mps_sim *sim, const char *path);

/** Go on where mps_checkpoint_write() was called, in a simulation that was set up by the same calls: configuration, phases, models with
 *  their settings, solids, fields, motion, probes. This is compared, and a difference refused; of the motion where the tank is at the time
 *  of the file; not the code of callbacks, lost_policy, speed_limit and threads. With the same time control (set before this call: setting
 *  it lets the growth of steps begin anew), solver and limits, too, the steps that follow are those of the run that did not stop, bit for
 *  bit, with any number of threads. The particles that are there are replaced, ids are those of the file; pointers that were given out
 *  before (tags, stencils, samples of probes) are no longer valid.
 *  @return MPS_E_IO (cannot be read, is cut short, damaged or no checkpoint), MPS_E_VERSION (of a newer library, or another byte order),
 *          MPS_E_ARG (which setting differs, and both values), MPS_E_BUSY (lease), MPS_E_STATE (in a monitor), MPS_E_NOMEM */
MPS_API mps_status mps_checkpoint_read(mps_sim *sim, const char *path);

MPS_END_DECLS

#endif

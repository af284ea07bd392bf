/* SPDX-License-Identifier: BSD-3-Clause */
/** @file output.h  Frames for ParaView (a .vtp file per frame, on many ranks one per rank, and a
 *  .pvd series that is valid after every frame), and checkpoints. */
#ifndef MPS_OUTPUT_H
#define MPS_OUTPUT_H

#include <mps/types.h>

MPS_BEGIN_DECLS

/** A series of frames. */
typedef struct mps_frames mps_frames;

/** Options of a series: a sum of these. */
enum {
    /** Fluid particles. */
    MPS_FRAMES_FLUID = 1,
    /** Wall particles. */
    MPS_FRAMES_WALL = 2,
    /** Dummies. */
    MPS_FRAMES_DUMMY = 4,
    /** Continue a series. */
    MPS_FRAMES_CONTINUE = 8,
    /** On many ranks: each rank writes its own particles. No effect on one rank. */
    MPS_FRAMES_PIECES = 16,
    /** Positions in the frame of the tank, and velocities relative to the tank along its axes: the
     *  walls are at rest. Fields of the user are unchanged. */
    MPS_FRAMES_TANK = 32,
    /** File names contain the number of the step, not of the frame; required by
     *  mps_frames_remove(). */
    MPS_FRAMES_STEPS = 64
};

/** Open a series: writes FOLDER/NAME.pvd and FOLDER/NAME/NAME_000000.vtp ...; the folder must
 *  exist. Frames of an earlier series of the same folder and name are removed; other files remain.
 *
 *  On many ranks there are two modes:
 *  - Without MPS_FRAMES_PIECES rank 0 writes the same files as a run on one rank: call
 *    mps_particles_collect() before mps_frames_write(). Calls of other ranks do nothing.
 *  - With MPS_FRAMES_PIECES all ranks make all calls of frames, in a folder on a shared file
 *    system. Rank R writes NAME_000000_R.vtp (R with four digits), rank 0 also NAME_000000.pvtp,
 *    which lists the pieces. No rank needs memory for particles of other ranks. A file that one
 *    rank cannot write is an error on all ranks, after which the run can continue.
 *
 *  With MPS_FRAMES_CONTINUE frames up to the current time remain, later frames are removed, and the
 *  series continues: for an interrupted run, after mps_checkpoint_read(). A state at the time of
 *  the last frame replaces this frame, so that no time occurs twice. Without a .pvd a new series
 *  begins.
 *  @param kinds   sum of MPS_FRAMES_...; default without a kind of particles: fluid and wall
 *  @param frames  out; close it with mps_frames_close(). The simulation must outlive it.
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | folder or name is empty; kinds |
 *  | MPS_E_IO | a file cannot be written; with MPS_FRAMES_CONTINUE: the files were |
 *  | | changed since mps_frames_write(); no file is removed then |
 *  | MPS_E_NOMEM | no memory |
 *  | MPS_E_RANKS | another rank failed | */
MPS_API mps_status mps_frames_open(mps_sim *sim, const char *folder, const char *name,
                                   int32_t kinds, mps_frames **frames);

/** Write the current state: position, velocity, pressure, wall_pressure, number_density, density,
 *  kind, phase, part, id and all user fields. At walls "wall_pressure" is the pressure of sensors
 *  and "pressure" the unknown of the pressure equation; in impacts they differ by up to some kPa.
 *  In the fluid they are equal after a step. "part" is the number of the solid, -1 for fluid; its
 *  name is line `part` of the array "part_names" of the frame. Each particle is a vertex cell, so
 *  that cell filters (Threshold, Clip) keep single particles. The .pvd is replaced atomically.
 *  @return MPS_E_IO with the path and the reason of the system; MPS_E_NOMEM; MPS_E_STATE (many
 *          ranks: particles not collected without MPS_FRAMES_PIECES, or collected with it);
 *          MPS_E_BUSY (called from a verb or a callback); MPS_E_RANKS (another rank failed) */
MPS_API mps_status mps_frames_write(mps_frames *frames);

/** @param user  argument `user` of mps_frames_remove() @param t  time of a frame [s]
 *  @return 0: the frame is removed */
typedef int (*mps_frames_wanted_fn)(void *user, double t);

/** Remove frames for which `wanted` returns 0, with their files. The .pvd is replaced before, so
 *  that it lists no missing file. With MPS_FRAMES_CONTINUE, frames that were removed after the
 *  checkpoint are not in the series. On many ranks rank 0 removes the files of all ranks; calls of
 *  other ranks do nothing.
 *  @param wanted  called for each frame, in the order of time
 *  @return MPS_E_ARG: an argument is NULL; the series has no MPS_FRAMES_STEPS; MPS_E_IO */
MPS_API mps_status mps_frames_remove(mps_frames *frames, mps_frames_wanted_fn wanted, void *user);

/** Close a series; NULL is allowed. */
MPS_API void mps_frames_close(mps_frames *frames);

/** Write the state on which the next steps depend to a file: particles with their fields and order,
 *  time, budgets, data of probes for averages and samples. The file is written as "<path>.tmp" and
 *  renamed, and file and folder are flushed to the disk: an interrupted write never leaves a
 *  partial file, also after a loss of power. A symbolic link is replaced, not followed. Format:
 *  byte order of the machine, a checksum for each section, about 150 bytes per particle. May be
 *  called by a monitor. Data that a plug-in, a motion callback or a solver of the user keeps
 *  outside of fields is not saved. Collective: all ranks make this call, and rank 0 writes.
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | path is NULL or empty |
 *  | MPS_E_IO | the path with the reason of the system; also if it is not a regular file |
 *  | MPS_E_BUSY | a lease for writing is open; called from a verb or a callback |
 *  | MPS_E_NOMEM | no memory |
 *  | MPS_E_RANKS | another rank failed | */
MPS_API mps_status mps_checkpoint_write(mps_sim *sim, const char *path);

/** Add a line to the set-up that checkpoints save, for data that the library does not know, e.g.
 *  the version of a plug-in or the checksum of a table of a motion callback. Only a simulation with
 *  the same lines in the same order can read a checkpoint; otherwise mps_checkpoint_read() returns
 *  MPS_E_ARG with both lines.
 *  @param text  1..191 characters, one line; copied
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | text is NULL, empty, too long or more than a line; there are 16 lines already |
 *  | MPS_E_BUSY | called from a monitor, a verb or a callback | */
MPS_API mps_status mps_checkpoint_note_add(mps_sim *sim, const char *text);

/** Restore the state of mps_checkpoint_write() in a simulation that was set up by the same calls:
 *  configuration, phases, models with their settings, solids, fields, motion, probes. The set-up is
 *  compared, and a difference is an error; of the motion, the pose at the time of the file is
 *  compared. Not compared: the code of callbacks, lost_policy, speed_limit and threads.
 *
 *  With the same time control (set before this call, because setting it restarts the growth of
 *  steps), solver and limits, the following steps are bitwise those of the uninterrupted run, with
 *  any number of threads. The particles of the simulation are replaced, ids are those of the file;
 *  pointers that the library returned before (stencils, samples of probes) become invalid.
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | a setting differs: which one, and both values |
 *  | MPS_E_IO | the file cannot be read, is cut short, damaged or not a checkpoint |
 *  | MPS_E_VERSION | written by a newer library, or in another byte order |
 *  | MPS_E_STATE | on many ranks: called after the first step or measurement |
 *  | MPS_E_BUSY | a lease is open; called from a monitor, a verb or a callback |
 *  | MPS_E_NOMEM | no memory; on many ranks the run then ends | */
MPS_API mps_status mps_checkpoint_read(mps_sim *sim, const char *path);

MPS_END_DECLS

#endif

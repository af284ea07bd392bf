/* SPDX-License-Identifier: BSD-3-Clause */
/** @file picture.h  Pictures of the particles as PNG, a film of a run, and a state for ParaView.
 *  Part of libmps_case.
 *
 *  A picture has axes with units, the sensors with their names, a colour scale of the pressure and
 *  the time. It is drawn in the frame of the tank: walls and sensors are fixed, and an arrow shows
 *  gravity if the tank is rotated. In 2-D each particle is a disc of the diameter dp. In 3-D there
 *  are two views: a shaded view of all liquid through the front walls, and a slice of 1.5 dp at the
 *  middle of z, with axes.
 *
 *  All pictures of a run have one colour scale; larger pressures have the colour of the upper end.
 *  A job (job.h) determines it before its first step, so that it does not depend on the times of
 *  the pictures. It ends at 1.25 (p_h + p_c) + rho u^2, rounded up to two digits: p_h the
 *  hydrostatic pressure of all phases, rho g h with the filled height h of each; p_c the capillary
 *  pressure of a droplet of the width of the phase, sigma/r in 2-D and 2 sigma/r in 3-D; rho u^2 of
 *  the fastest phase. Without gravity, tension and speed, it ends at rho h 9.81 m/s2.
 *
 *  For a program that calls mps_picture_save(), the first picture with a pressure determines the
 *  scale: from 0 to the larger of two pressures, rounded up to two digits: the 99 % quantile in the
 *  liquid, and 1.25 times the hydrostatic pressure below its current centre of mass. With several
 *  phases it begins at the 1 % quantile if that is negative. The colours differ in lightness, and
 *  those of two phases are distinguishable for colour-blind readers. */
#ifndef MPS_PICTURE_H
#define MPS_PICTURE_H

#include <mps/types.h>
#include <stddef.h>

MPS_BEGIN_DECLS

/** Options of pictures; set by mps_picture_config_init(). Use one config for all pictures of a
 *  run. */
typedef struct mps_picture_config {
    /** Set by mps_picture_config_init(). */
    uint32_t struct_size;
    /** Width [pixels], 400..4000; default 1280. A narrow tank gives a narrower picture. */
    int32_t width;
    /** Title, or NULL. Bytes that are not UTF-8 are shown as "?". */
    const char *title;
    /** Gravity [m/s2], >= 0; default 9.81. */
    double gravity;
    /** Lower end of the colour scale [Pa]. */
    double pressure_lo;
    /** Upper end [Pa]. If it is not above the lower end (default), the first picture with a
     *  pressure sets both. */
    double pressure_hi;
    /** 1 (default): draw sensors; 0: do not. */
    int32_t sensors;
    /** Kept 0. */
    int32_t reserved;
    /** Receives the text of an error, or NULL. */
    char *error;
    /** Size of `error` [bytes]. */
    size_t error_size;
    /** [6*edge_count] both ends of each edge of the tank, in its frame [m], drawn in 3-D; NULL
     *  (default): those in the folder of the run, or of the box of all walls. */
    const double *edges;
    /** Number of `edges`; default 0. */
    int32_t edge_count;
    /** Kept 0. */
    int32_t reserved_2;
} mps_picture_config;

/** Set all members to their defaults.
 *  @param size  sizeof(mps_picture_config)
 *  @return MPS_OK, MPS_E_ARG for NULL, MPS_E_VERSION for an unknown size */
MPS_API mps_status mps_picture_config_init(mps_picture_config *config, size_t size);

/** Draw the current state of a simulation. Particles are leased during the call; on many ranks call
 *  it on rank 0 between mps_particles_collect() and mps_particles_collect_end(). Sensors are the
 *  probes of wall pressures, pressures and gauges that have a name.
 *  @param path  of the PNG; a file of this name is replaced
 *
 *  | error | reason; no file remains |
 *  |---|---|
 *  | MPS_E_ARG | an argument; no particles |
 *  | MPS_E_BUSY | a field is leased for writing; called from a verb or a callback |
 *  | MPS_E_IO | the file cannot be written |
 *  | MPS_E_NOMEM | no memory | */
MPS_API mps_status mps_picture_save(mps_sim *sim, mps_picture_config *config, const char *path);

/** Draw a frame of a run's folder (summary.json, probes.csv, frames.pvd). Title, gravity and colour
 *  scale are those of the folder if the config has none; the scale is that of all frames if the
 *  folder has none.
 *  @param folder  a folder that a run has written
 *  @param frame   0..frames - 1, or -1: the last one
 *  @param path    as for mps_picture_save()
 *  @return MPS_OK, MPS_E_ARG, MPS_E_IO (a file is missing or invalid, or cannot be written),
 *          MPS_E_NOMEM */
MPS_API mps_status mps_picture_frame_save(const char *folder, int64_t frame,
                                          mps_picture_config *config, const char *path);

/** Options of a film; set by mps_film_config_init(). */
typedef struct mps_film_config {
    /** Set by mps_film_config_init(). */
    uint32_t struct_size;
    /** Width of the pictures [pixels], as in mps_picture_config. */
    int32_t width;
    /** Frames per second of the film, 1..120; 0 (default): as in the run, but at least 5 and at
     *  most 60. */
    double rate;
    /** Program that makes the film; default "ffmpeg", searched in PATH. */
    const char *program;
    /** Receives the text of an error, or NULL. */
    char *error;
    /** Size of `error` [bytes]. */
    size_t error_size;
} mps_film_config;

/** Set all members to their defaults.
 *  @param size  sizeof(mps_film_config)
 *  @return MPS_OK, MPS_E_ARG for NULL, MPS_E_VERSION for an unknown size */
MPS_API mps_status mps_film_config_init(mps_film_config *config, size_t size);

/** Make a film of all frames in the folder of a run: MP4 with H.264, which all players and browsers
 *  support. The program ffmpeg runs as a child process; no signal handler is changed. An earlier
 *  film is replaced when the new one is complete.
 *  @param folder  a folder that a run has written
 *  @param config  NULL for the defaults
 *  @param path    of the film; NULL: film.mp4 in the folder
 *  @return MPS_OK, MPS_E_ARG (also: no frame), MPS_E_IO (no ffmpeg, or it failed: its message is in
 *          the text; a file is missing or invalid), MPS_E_NOMEM */
MPS_API mps_status mps_film_save(const char *folder, const mps_film_config *config,
                                 const char *path);

/** Write paraview.py into the folder of a run: ParaView 5.10 or newer opens it by File > Load State
 *  or `paraview --state=paraview.py`. It shows the frames with the colours and the scale of the
 *  pictures, each phase as spheres of the diameter dp, and the walls in grey. It reads the frames
 *  in its own folder, so that the folder may be moved.
 *  @param error       receives the text of an error, or NULL
 *  @param error_size  its size [bytes]
 *  @return as mps_film_save() */
MPS_API mps_status mps_paraview_save(const char *folder, char *error, size_t error_size);

MPS_END_DECLS

#endif

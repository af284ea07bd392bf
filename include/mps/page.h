/* SPDX-License-Identifier: BSD-3-Clause */
/** @file page.h  report.html of a run: one file that needs no network, made from the folder of the
 *  run only. It contains a film of the particles, all curves and the case. Part of libmps_case. */
#ifndef MPS_PAGE_H
#define MPS_PAGE_H

#include <mps/series.h>
#include <mps/status.h>
#include <stddef.h>

MPS_BEGIN_DECLS

/** Options of a page; set by mps_page_config_init(). */
typedef struct mps_page_config {
    /** Set by mps_page_config_init(). */
    uint32_t struct_size;
    /** Largest number of frames in the film; 0: all frames of the folder. */
    int32_t frames;
    /** Limit of the file size [bytes], 500,000 or more. Precision, then particles, then frames of
     *  the film are reduced until the page is below it; the page states what was omitted. */
    int64_t bytes;
    /** Receives the text of an error, or NULL. */
    char *error;
    /** Size of `error` [bytes]. */
    size_t error_size;
    /** Constants of the statistics of impacts, initialised; NULL (default): those of the run. The
     *  page lists those that differ from the run. */
    const mps_stats_config *impacts;
} mps_page_config;

/** Contents of a page; initialised by mps_page_info_init(), set by mps_page_write(). */
typedef struct mps_page_info {
    /** Set by mps_page_info_init(). */
    uint32_t struct_size;
    /** Frames of the film; 0: no film. */
    int32_t frames;
    /** Size of the file [bytes]. */
    int64_t bytes;
    /** Moving particles in the film. */
    int64_t particles;
    /** What was omitted in the film to keep the limit, one sentence; "" for nothing. */
    char left_out[320];
} mps_page_info;

/** Set all members to their defaults: all frames, 12,000,000 bytes, no error texts.
 *  @param size  sizeof(mps_page_config)
 *  @return MPS_OK, MPS_E_ARG for NULL or an unknown size */
MPS_API mps_status mps_page_config_init(mps_page_config *config, size_t size);

/** Set struct_size and zero.
 *  @param size  sizeof(mps_page_info) */
MPS_API mps_status mps_page_info_init(mps_page_info *info, size_t size);

/** Write report.html into a folder, from summary.json, probes.csv, steps.csv, momentum.csv,
 *  frames.pvd with its frames, case.yaml and picture_*.png of that folder. Only summary.json and
 *  probes.csv are required. An interrupted call leaves an existing page unchanged.
 *  @param folder  a folder that a run has written
 *  @param config  NULL for the defaults
 *  @param info    out: contents of the page, or NULL
 *  @return MPS_OK, MPS_E_ARG (folder, config, or a limit that is too low for the curves), MPS_E_IO
 *      (a file is missing or invalid, or the page cannot be written), MPS_E_NOMEM */
MPS_API mps_status mps_page_write(const char *folder, const mps_page_config *config,
                                  mps_page_info *info);

MPS_END_DECLS

#endif

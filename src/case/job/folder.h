/* SPDX-License-Identifier: BSD-3-Clause */
/* The output folder of a run: one run at a time, and an earlier run is replaced on request only. */
#ifndef MPS_CASE_FOLDER_H
#define MPS_CASE_FOLDER_H

#include <mps/status.h>
#include <stdbool.h>
#include <stddef.h>

enum { FOLDER_PATH = 512 };

typedef struct folder {
    char path[FOLDER_PATH];
    char lock[FOLDER_PATH + 16]; /* "": not locked */
    int fd;
    bool made; /* it did not exist before this run */
} folder;

/* Create the folder and lock it against other programs.
 * @param keep   an earlier run in it is allowed
 * @param error  [size] out: why not
 * @return MPS_E_IO: files cannot be created, MPS_E_BUSY: another run is in progress, MPS_E_STATE:
 * the folder has outputs of an earlier run */
mps_status mps__folder_open(folder *f, const char *path, bool keep, char *error, size_t size);
/* Renew the lock, more often than once a minute, so that other machines see that the run is in
 * progress. */
void mps__folder_renew(const folder *f);
/* Remove the lock, and the folder if the run made it and it is empty. */
void mps__folder_close(folder *f);
/* Remove all outputs of jobs.
 * @param keep  name of a file that stays, or NULL
 * @return false: `error` is the reason */
bool mps__folder_clear(const folder *f, const char *keep, char *error, size_t size);
/* Whether all files that a continued run writes or removes are in the folder itself, not behind a
 * link.
 * @return false: `error` names the link */
bool mps__folder_has_no_links(const folder *f, char *error, size_t size);
/* Advice for this errno of a file that cannot be written. */
const char *mps__folder_advice(int error);

#endif

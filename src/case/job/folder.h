/* SPDX-License-Identifier: BSD-3-Clause */
/* The folder of a run's outputs: one run at a time, and no run over another one without being asked to. */
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
} folder;

/* Make the folder and lock it against other programs.
 * @param keep  an earlier run in it is allowed @param error  [size] out: why not
 * @return MPS_E_IO: files cannot be made there, MPS_E_BUSY: another run is in progress, MPS_E_STATE: there are outputs of an earlier run */
mps_status mps__folder_open(folder *f, const char *path, bool keep, char *error, size_t size);
/* Renew the lock, more often than once in a minute, so that other machines see that the run is in progress. */
void mps__folder_renew(const folder *f);
/* Remove the lock. */
void mps__folder_close(folder *f);
/* Remove all that jobs write. @param keep  name of a file that stays, or NULL @return false: `error` says why */
bool mps__folder_clear(const folder *f, const char *keep, char *error, size_t size);
/* Whether what a run that goes on writes or removes is in the folder itself, not behind a link. @return false: `error` says which is not */
bool mps__folder_has_no_links(const folder *f, char *error, size_t size);
/* What to do about this reason that a file cannot be written. */
const char *mps__folder_advice(int error);

#endif

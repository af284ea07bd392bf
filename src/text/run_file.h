/* SPDX-License-Identifier: BSD-3-Clause */
/* Opens files in the folder of a run. The folder may come from other users: a link must not expose
 * a file outside of it. */
#ifndef MPS_TEXT_RUN_FILE_H
#define MPS_TEXT_RUN_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* Read all bytes of a file that was just opened. NULL with errno: ENOMEM, EFBIG if it has more
 * than `most` bytes, EIO if it ends earlier than its size says, or another one of the system.
 * @param size  set to the size of the file, also with EFBIG
 * @return the bytes and a 0 behind them, malloc'd */
char *mps__file_read(FILE *file, size_t most, size_t *size);
/* Open a file for reading. NULL with errno, and with *why where errno does not say it: the path
 * leads out of the folder, by a link or by its name, or it is no regular file.
 * @param folder  NULL: a file anywhere
 * @param path    with the folder before it */
FILE *mps__run_open(const char *folder, const char *path, const char **why);
/* The name of a file with links resolved, malloc'd. NULL with errno, and *why if it is not in the
 * folder. */
char *mps__run_name(const char *folder, const char *path, const char **why);
/* Create or replace a file: a link of this name is removed, its target stays unchanged. NULL with
 * errno. */
FILE *mps__run_create(const char *path, const char *mode);
/* Path of a file in the folder of the program, or in `other`, which is relative to that folder.
 * @return false: it is in neither */
bool mps__program_file(const char *name, const char *other, char *path, size_t size);

#endif

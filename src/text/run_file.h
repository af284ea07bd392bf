/* SPDX-License-Identifier: BSD-3-Clause */
/* Opens files in the folder of a run. The folder may come from other users: a link must not expose
 * a file outside of it. */
#ifndef MPS_TEXT_RUN_FILE_H
#define MPS_TEXT_RUN_FILE_H

#include <stdio.h>

/* Open a file for reading.
 * @return NULL with errno, and with *why where errno does not explain it: the path leaves the
 * folder by a link or by its name, or it is no regular file
 * @param folder  NULL: any file
 * @param path    with the folder before it */
FILE *mps__run_open(const char *folder, const char *path, const char **why);
/* The name of a file with links resolved, malloc'd. NULL with errno, and *why if it is not in the
 * folder. */
char *mps__run_name(const char *folder, const char *path, const char **why);
/* Create or replace a file: a link of this name is removed, its target stays unchanged. NULL with
 * errno. */
FILE *mps__run_create(const char *path, const char *mode);

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* Files of the folder of a run, which may be from others: a link must not show what is outside
 * of the folder. */
#ifndef MPS_TEXT_RUN_FILE_H
#define MPS_TEXT_RUN_FILE_H

#include <stdio.h>

/* Open a file for reading. NULL with errno, and with *why where errno does not say it: the path
 * leads out of the folder, by a link or by its name, or it is no regular file.
 * @param folder  NULL: a file anywhere
 * @param path    with the folder before it */
FILE *mps__run_open(const char *folder, const char *path, const char **why);
/* The name of a file without links, malloc'd. NULL with errno, and *why where it is not in the
 * folder. */
char *mps__run_name(const char *folder, const char *path, const char **why);
/* Create a file, or replace one: a link of this name is removed, what it points to stays as it
 * is. NULL with errno. */
FILE *mps__run_create(const char *path, const char *mode);

#endif

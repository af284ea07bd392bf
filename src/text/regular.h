/* SPDX-License-Identifier: BSD-3-Clause */
/* Opens files that users name. Opening a FIFO without a writer would block forever; reading a
 * terminal or a device would never end: only regular files are opened. */
#ifndef MPS_TEXT_REGULAR_H
#define MPS_TEXT_REGULAR_H

#include <stdio.h>

/* Open a regular file. Links are followed.
 * @param flags  O_RDONLY or O_RDWR, and O_NOFOLLOW or 0
 * @param why    set to what the path is if it is no regular file, else to NULL
 * @return the descriptor; -1 with errno, EINVAL if *why is set */
int mps__regular_open(const char *path, int flags, const char **why);
/* Open a regular file as a stream, for reading, or for both with O_RDWR. The error is as of
 * mps__regular_open(). @return NULL: not opened */
FILE *mps__regular_stream(const char *path, int flags, const char **why);
/* Open summary.json for reading. A file of other content may have any size: one that is larger than
 * each summary is refused with EFBIG. */
FILE *mps__regular_summary(const char *path, const char **why);

#endif

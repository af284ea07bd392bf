/* SPDX-License-Identifier: BSD-3-Clause */
#include "regular.h"
#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <sys/stat.h>
#include <unistd.h>

/* What a path is that is no regular file. */
static const char *kind_name(mode_t mode)
{
    if (S_ISDIR(mode)) return "it is a folder, no regular file";
    if (S_ISFIFO(mode)) return "it is a pipe (FIFO), no regular file";
    if (S_ISSOCK(mode)) return "it is a socket, no regular file";
    if (S_ISCHR(mode) || S_ISBLK(mode)) return "it is a device, no regular file";
    return "it is no regular file";
}

int mps__regular_open(const char *path, int flags, const char **why)
{
    struct stat s;
    *why = NULL;
    const int fd = open(path, flags | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    const int failed = fd < 0 ? errno : 0;
    /* a socket cannot be opened, a folder not for writing */
    const bool known = fd >= 0 ? fstat(fd, &s) == 0
                               : (failed == ENXIO || failed == EISDIR) && stat(path, &s) == 0;
    if (known && fd >= 0 && S_ISREG(s.st_mode)) return fd;
    const int number = known ? EINVAL : failed ? failed : errno;
    if (known) *why = kind_name(s.st_mode);
    if (fd >= 0) close(fd);
    errno = number;
    return -1;
}

FILE *mps__regular_stream(const char *path, int flags, const char **why)
{
    const int fd = mps__regular_open(path, flags, why);
    FILE *file = fd < 0 ? NULL : fdopen(fd, (flags & O_ACCMODE) == O_RDWR ? "r+" : "r");
    const int number = errno;
    if (fd >= 0 && !file) close(fd);
    errno = number;
    return file;
}

FILE *mps__regular_summary(const char *path, const char **why)
{
    static const off_t most = 1 << 28;
    struct stat s;
    FILE *file = mps__regular_stream(path, O_RDONLY, why);
    if (!file || (fstat(fileno(file), &s) == 0 && s.st_size <= most)) return file;
    fclose(file);
    errno = EFBIG;
    return NULL;
}

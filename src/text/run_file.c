/* SPDX-License-Identifier: BSD-3-Clause */
#include "run_file.h"
#include "regular.h"
#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

char *mps__file_read(FILE *file, size_t most, size_t *size)
{
    setvbuf(file, NULL, _IONBF, 0); /* one read: a buffer has no use */
    const long length = fseek(file, 0, SEEK_END) == 0 ? ftell(file) : -1;
    if (length < 0 || fseek(file, 0, SEEK_SET) != 0) return NULL;
    *size = (size_t)length;
    errno = *size > most ? EFBIG : ENOMEM;
    char *data = *size > most ? NULL : malloc(*size + 1);
    if (!data) return NULL;
    errno = EIO;
    if (fread(data, 1, *size, file) != *size) {
        const int number = errno;
        free(data);
        errno = number;
        return NULL;
    }
    data[*size] = '\0';
    return data;
}

/* Both without links. */
static bool is_below(const char *folder, const char *path)
{
    const size_t length = strlen(folder);
    return strncmp(folder, path, length) == 0 &&
           (path[length] == '/' || (length > 0 && folder[length - 1] == '/'));
}

char *mps__run_name(const char *folder, const char *path, const char **why)
{
    char *real = realpath(path, NULL), *inside = real ? realpath(folder, NULL) : NULL;
    if (inside && is_below(inside, real)) {
        free(inside);
        return real;
    }
    const int number = errno;
    *why = NULL;
    if (inside)
        *why = "it leads out of the folder of the run, as a link or by its name; "
               "copy the file into the folder";
    free(inside);
    free(real);
    errno = *why ? EACCES : number;
    return NULL;
}

FILE *mps__run_open(const char *folder, const char *path, const char **why)
{
    *why = NULL;
    if (!folder) return mps__regular_stream(path, O_RDONLY, why);
    char *real = mps__run_name(folder, path, why);
    FILE *file = real ? mps__regular_stream(real, O_RDONLY | O_NOFOLLOW, why) : NULL;
    const int number = errno;
    free(real);
    errno = number;
    return file;
}

FILE *mps__run_create(const char *path, const char *mode)
{
    if (unlink(path) != 0 && errno != ENOENT) return NULL;
    const int fd = open(path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    FILE *file = fd < 0 ? NULL : fdopen(fd, mode);
    const int number = errno;
    if (fd >= 0 && !file) {
        close(fd);
        unlink(path);
    }
    errno = number;
    return file;
}

bool mps__program_file(const char *name, const char *other, char *path, size_t size)
{
    char from[1024];
    ssize_t length = readlink("/proc/self/exe", from, sizeof from);
    while (length > 0 && from[length - 1] != '/') length--;
    for (int k = 0; length > 0 && k < 2; k++) {
        const int whole = snprintf(path, size, "%.*s%s%s", (int)length, from, k ? other : "", name);
        if (whole >= 0 && (size_t)whole < size && access(path, F_OK) == 0) return true;
    }
    return false;
}

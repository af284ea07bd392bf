/* SPDX-License-Identifier: BSD-3-Clause */
/* Folders are locked by fcntl() on a file in them: the system removes the lock however the program
 * ends, and tells which process holds it. */
#include "folder.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { FOLDER_ROOM = 65536 /* bytes that must fit on the disk */ };

static const char LOCK[] = "run.lock";

/* What every job writes, beside frames/. The first ones tell that there is a run. */
static const char *const FILES[] = {
    "checkpoint.mps",     "probes.csv",      "steps.csv", "frames.pvd",  "summary.json",
    "checkpoint.mps.tmp", "momentum.csv",    "trace.csv", "report.html", "report.html.tmp",
    "frames.pvd.tmp",     "picture_end.png", "film.mp4",  "paraview.py", "case.yaml"};
enum { FOLDER_FILES = sizeof FILES / sizeof *FILES, FOLDER_SIGNS = 5 };

const char *mps__folder_advice(int error)
{
    switch (error) {
    case EACCES:
    case EPERM:
        return "choose another folder with --out, or change the permissions of this one";
    case EROFS:
        return "the disk can only be read; choose a folder on another one with --out";
    case ENOSPC:
    case EDQUOT:
        return "the disk is full; make room on it, or choose a folder on another one with --out";
    default:
        return "must be a folder that can be written";
    }
}

/* Why a call failed, which is `number`, and what to do. */
static mps_status folder_refuse(const folder *f, int number, char *error, size_t size)
{
    snprintf(error, size, "--out %s: %s; %s", f->path, strerror(number),
             mps__folder_advice(number));
    return MPS_E_IO;
}

/* mkdir -p */
static bool folder_make(const char *path)
{
    char part[FOLDER_PATH];
    snprintf(part, sizeof part, "%s", path);
    for (char *slash = part + 1; (slash = strchr(slash, '/')) != NULL; slash++) {
        *slash = '\0';
        if (mkdir(part, 0777) != 0 && errno != EEXIST && errno != EROFS && errno != EACCES)
            return false; /* of those above, it may be there */
        *slash = '/';
    }
    struct stat s;
    if (mkdir(part, 0777) != 0 && errno != EEXIST) return false;
    if (stat(part, &s) == 0 && S_ISDIR(s.st_mode)) return true;
    errno = ENOTDIR;
    return false;
}

/* ---- the lock ---- */

/* The file is removed while it is locked, so that it cannot be one that another run has locked. */
void mps__folder_close(folder *f)
{
    if (!f->lock[0]) return;
    unlink(f->lock);
    close(f->fd);
    f->lock[0] = '\0';
}

/* A file that is locked and still in the folder; a run that ended meanwhile has taken its own away. */
static bool folder_is_current(int fd, const char *path)
{
    struct stat mine, there;
    return fstat(fd, &mine) == 0 && stat(path, &there) == 0 && mine.st_ino == there.st_ino &&
           mine.st_dev == there.st_dev;
}

static mps_status folder_refuse_locked(const folder *f, int fd, char *error, size_t size)
{
    struct flock held = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    if (fcntl(fd, F_GETLK, &held) == 0 && held.l_type != F_UNLCK)
        snprintf(error, size,
                 "--out %s: another run is writing there, process %ld; wait until it ends, or "
                 "choose another folder with --out",
                 f->path, (long)held.l_pid);
    else
        snprintf(error, size, "--out %s: another run was writing there; try again", f->path);
    return MPS_E_BUSY;
}

/* Is there room for the first files? A full disk often takes a name and no more. */
static bool folder_has_room(int fd)
{
    static const char zeros[FOLDER_ROOM];
    const ssize_t written = write(fd, zeros, sizeof zeros);
    if (written >= 0 && written < (ssize_t)sizeof zeros) errno = ENOSPC;
    const bool good = written == (ssize_t)sizeof zeros && fsync(fd) == 0;
    const int error = errno;
    if (ftruncate(fd, 0) != 0 && good) return false;
    errno = error;
    return good;
}

static mps_status folder_lock(folder *f, char *error, size_t size)
{
    char path[sizeof f->lock];
    struct flock wanted = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    snprintf(path, sizeof path, "%s/%s", f->path, LOCK);
    for (;;) {
        const int fd = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (fd < 0) return folder_refuse(f, errno, error, size);
        if (fcntl(fd, F_SETLK, &wanted) != 0) {
            const int number = errno;
            const mps_status status = number == EACCES || number == EAGAIN
                                          ? folder_refuse_locked(f, fd, error, size)
                                          : folder_refuse(f, number, error, size);
            close(fd);
            return status;
        }
        if (folder_is_current(fd, path)) {
            f->fd = fd;
            memcpy(f->lock, path, sizeof path);
            return folder_has_room(fd) ? MPS_OK : folder_refuse(f, errno, error, size);
        }
        close(fd);
    }
}

/* ---- an earlier run ---- */

static bool folder_has(const folder *f, const char *name)
{
    char path[FOLDER_PATH + 64];
    struct stat s;
    snprintf(path, sizeof path, "%s/%s", f->path, name);
    return lstat(path, &s) == 0;
}

static mps_status folder_check(const folder *f, char *error, size_t size)
{
    char there[128] = "";
    for (int i = 0; i < FOLDER_SIGNS; i++) {
        if (!folder_has(f, FILES[i])) continue;
        snprintf(there + strlen(there), sizeof there - strlen(there), "%s%s", there[0] ? ", " : "",
                 FILES[i]);
    }
    if (!there[0]) return MPS_OK;
    snprintf(error, size,
             "--out %s: there is an earlier run (%s); %s, --overwrite removes it, or choose "
             "another folder with --out",
             f->path, there,
             folder_has(f, FILES[0]) ? "--resume goes on from its checkpoint"
                                     : "it has no checkpoint to go on from with --resume");
    return MPS_E_STATE;
}

mps_status mps__folder_open(folder *f, const char *path, bool keep, char *error, size_t size)
{
    *f = (folder){.fd = -1};
    if (snprintf(f->path, sizeof f->path, "%s", path) >= (int)sizeof f->path)
        return folder_refuse(f, ENAMETOOLONG, error, size);
    if (!folder_make(f->path)) return folder_refuse(f, errno, error, size);
    mps_status status = folder_lock(f, error, size);
    if (status == MPS_OK && !keep) status = folder_check(f, error, size);
    if (status != MPS_OK) mps__folder_close(f);
    return status;
}

/* ---- removal ---- */

static bool folder_remove(const folder *f, const char *name, char *error, size_t size)
{
    char path[FOLDER_PATH + 300];
    snprintf(path, sizeof path, "%s/%s", f->path, name);
    if (unlink(path) == 0 || errno == ENOENT) return true;
    snprintf(error, size, "--overwrite: cannot remove %s: %s; %s", path, strerror(errno),
             mps__folder_advice(errno));
    return false;
}

/* `name` is `before`, at least so many digits, perhaps '_' and four or more of the number of a rank, `after`. */
static bool folder_is_numbered(const char *name, const char *before, size_t digits,
                               const char *after)
{
    const size_t length = strlen(before);
    if (strncmp(name, before, length) != 0) return false;
    const size_t count = strspn(name + length, "0123456789");
    const char *end = name + length + count;
    const size_t rank = *end == '_' ? strspn(end + 1, "0123456789") : 0;
    return count >= digits && strcmp(rank >= 4 ? end + 1 + rank : end, after) == 0;
}

/* Files of a folder, "" or ending in '/', with a beginning, a number and an end. */
static bool folder_remove_numbered(const folder *f, const char *const pattern[3], size_t digits,
                                   char *error, size_t size)
{
    char path[FOLDER_PATH + 64], name[288];
    bool done = true;
    snprintf(path, sizeof path, "%s/%s", f->path, pattern[0]);
    DIR *there = opendir(path);
    for (const struct dirent *e; done && there && (e = readdir(there)) != NULL;) {
        if (!folder_is_numbered(e->d_name, pattern[1], digits, pattern[2])) continue;
        snprintf(name, sizeof name, "%s%s", pattern[0], e->d_name);
        done = folder_remove(f, name, error, size);
    }
    if (there) closedir(there);
    return done;
}

bool mps__folder_clear(const folder *f, char *error, size_t size)
{
    /* folder, beginning and end of names */
    static const char *const pictures[3] = {"", "picture_", ".png"},
                             *const frames[][3] = {{"frames/", "frames_", ".vtp"},
                                                   {"frames/", "frames_", ".vtp.tmp"},
                                                   {"frames/", "frames_", ".pvtp"},
                                                   {"frames/", "frames_", ".pvtp.tmp"}};
    char path[FOLDER_PATH + 64];
    for (int i = 0; i < FOLDER_FILES; i++)
        if (!folder_remove(f, FILES[i], error, size)) return false;
    if (!folder_remove_numbered(f, pictures, 1, error, size)) return false;
    for (int i = 0; i < 4; i++)
        if (!folder_remove_numbered(f, frames[i], 6, error, size)) return false;
    snprintf(path, sizeof path, "%s/frames", f->path);
    rmdir(path); /* if nothing else is in it */
    return true;
}

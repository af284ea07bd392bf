/* SPDX-License-Identifier: BSD-3-Clause */
/* A folder is locked by fcntl() on a file in it: the system removes the lock however the program
 * ends, and reports the process that holds it. The file contains the machine and the process. */
#include "folder.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum {
    FOLDER_BYTES = 65536, /* that must fit on the disk */
    FOLDER_HOST = 128,
    FOLDER_STALE = 900 /* [s] age at which an unrenewed lock of another machine expires */
};

static const char LOCK[] = "run.lock";

/* Outputs of every job besides frames/. The first ones indicate that there is a run. */
static const char *const FILES[] = {
    "checkpoint.mps",     "probes.csv",   "steps.csv",     "frames.pvd",      "summary.json",
    "checkpoint.mps.tmp", "momentum.csv", "trace.csv",     "report.html",     "report.html.tmp",
    "frames.pvd.tmp",     "peaks.pvd",    "peaks.pvd.tmp", "picture_end.png", "film.mp4",
    "paraview.py",        "case.yaml",    "case.yaml.tmp", "summary.json.tmp"};
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
        return "the disk is full; free space on it, or choose a folder on another one with --out";
    default:
        return "must be a folder that can be written";
    }
}

/* Format why a call failed with errno `number`, and the advice. */
static mps_status folder_refuse(const folder *f, int number, char *error, size_t size)
{
    snprintf(error, size, "--out %s: %s; %s", f->path, strerror(number),
             mps__folder_advice(number));
    return MPS_E_IO;
}

/* mkdir -p
 * @param made  out: the folder did not exist */
static bool folder_make(const char *path, bool *made)
{
    char part[FOLDER_PATH];
    snprintf(part, sizeof part, "%s", path);
    for (char *slash = part + 1; (slash = strchr(slash, '/')) != NULL; slash++) {
        *slash = '\0';
        /* parent folders may exist */
        if (mkdir(part, 0777) != 0 && errno != EEXIST && errno != EROFS && errno != EACCES)
            return false;
        *slash = '/';
    }
    struct stat s;
    *made = mkdir(part, 0777) == 0;
    if (!*made && errno != EEXIST) return false;
    if (stat(part, &s) == 0 && S_ISDIR(s.st_mode)) return true;
    errno = ENOTDIR;
    return false;
}

/* ---- the lock ---- */

/* The file is removed while it is locked, so that no other run can have locked it. */
void mps__folder_close(folder *f)
{
    if (!f->lock[0]) return;
    unlink(f->lock);
    close(f->fd);
    f->lock[0] = '\0';
    if (f->made) rmdir(f->path); /* it is empty if the run was refused */
}

/* Whether a locked file is still in the folder; a run that has just ended removes its own. */
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

/* Whether the disk has space for the first files. A full disk often accepts a name and no data. */
static bool folder_has_space(int fd)
{
    static const char zeros[FOLDER_BYTES];
    const ssize_t written = pwrite(fd, zeros, sizeof zeros, 0);
    if (written >= 0 && written < (ssize_t)sizeof zeros) errno = ENOSPC;
    const bool good = written == (ssize_t)sizeof zeros && fsync(fd) == 0;
    const int error = errno;
    if (ftruncate(fd, 0) != 0 && good) return false;
    errno = error;
    return good;
}

/* The name of this machine. */
static void folder_host(char host[FOLDER_HOST])
{
    if (gethostname(host, FOLDER_HOST) != 0) host[0] = '\0';
    host[FOLDER_HOST - 1] = '\0';
    host[strcspn(host, " \n")] = '\0';
}

/* File systems shared by machines may not propagate locks. So the file names its machine and
 * process, and a run renews it: a file of another machine is valid until it is FOLDER_STALE old. A
 * process of this machine has ended, or fcntl() would have reported its lock. */
static bool folder_is_held_elsewhere(const folder *f, int fd, char *error, size_t size)
{
    char text[FOLDER_HOST + 40] = "", host[FOLDER_HOST], holder[FOLDER_HOST];
    long process = 0;
    struct stat s;
    folder_host(host);
    if (pread(fd, text, sizeof text - 1, 0) <= 0 || fstat(fd, &s) != 0) return false;
    const size_t length = strcspn(text, " ");
    if (length == 0 || length >= FOLDER_HOST || text[length] != ' ') return false;
    snprintf(holder, sizeof holder, "%.*s", (int)length, text);
    process = strtol(text + length, NULL, 10);
    const double age = difftime(time(NULL), s.st_mtime);
    if (strcmp(holder, host) == 0 || age > FOLDER_STALE) return false;
    snprintf(error, size,
             "--out %s: another run is writing there, process %ld on %s, %.0f s ago; wait until it "
             "ends, or %d s if that machine is down, or choose another folder with --out",
             f->path, process, holder, age > 0 ? age : 0, FOLDER_STALE);
    return true;
}

void mps__folder_renew(const folder *f)
{
    if (f->lock[0]) futimens(f->fd, NULL); /* a failure only makes the age wrong */
}

/* Write the owner of the lock. @return false: errno */
static bool folder_sign(int fd)
{
    char text[FOLDER_HOST + 40], host[FOLDER_HOST];
    folder_host(host);
    const int length = snprintf(text, sizeof text, "%s %ld\n", host, (long)getpid());
    return pwrite(fd, text, (size_t)length, 0) == length;
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
        if (folder_is_held_elsewhere(f, fd, error, size)) {
            close(fd);
            return MPS_E_BUSY;
        }
        if (folder_is_current(fd, path)) {
            f->fd = fd;
            memcpy(f->lock, path, sizeof path);
            const bool good = folder_has_space(fd) && folder_sign(fd);
            return good ? MPS_OK : folder_refuse(f, errno, error, size);
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
             "--out %s: there is an earlier run (%s); --resume %s, --overwrite removes it, or "
             "choose another folder with --out",
             f->path, there,
             folder_has(f, FILES[0]) ? "continues from its checkpoint"
                                     : "begins it again, since it has no checkpoint");
    return MPS_E_STATE;
}

mps_status mps__folder_open(folder *f, const char *path, bool keep, char *error, size_t size)
{
    *f = (folder){.fd = -1};
    if (snprintf(f->path, sizeof f->path, "%s", path) >= (int)sizeof f->path)
        return folder_refuse(f, ENAMETOOLONG, error, size);
    if (!folder_make(f->path, &f->made)) return folder_refuse(f, errno, error, size);
    mps_status status = folder_lock(f, error, size);
    if (status == MPS_OK && !keep) status = folder_check(f, error, size);
    if (status != MPS_OK) mps__folder_close(f);
    return status;
}

/* ---- removal ---- */

/* Remove a file of an open folder, "place/name" in messages; of a link, the link itself. */
static bool folder_remove(int fd, const char *place, const char *name, char *error, size_t size)
{
    if (unlinkat(fd, name, 0) == 0 || errno == ENOENT) return true;
    snprintf(error, size, "--overwrite: cannot remove %s/%s: %s; %s", place, name, strerror(errno),
             mps__folder_advice(errno));
    return false;
}

/* Whether `name` is `before`, at least so many digits, optionally '_' and four or more digits of a
 * rank, `after`. */
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

static bool folder_is_link(const folder *f, const char *name, char *error, size_t size)
{
    char path[FOLDER_PATH + 300];
    struct stat s;
    snprintf(path, sizeof path, "%s/%s", f->path, name);
    if (lstat(path, &s) != 0 || !S_ISLNK(s.st_mode)) return false;
    snprintf(error, size,
             "resume: %s is a link: what it leads to is not changed; put the file or folder itself "
             "there",
             path);
    return true;
}

bool mps__folder_has_no_links(const folder *f, char *error, size_t size)
{
    bool link = folder_is_link(f, "frames", error, size) || folder_is_link(f, "peaks", error, size);
    for (int i = 0; i < FOLDER_FILES && !link; i++) link = folder_is_link(f, FILES[i], error, size);
    DIR *all = link ? NULL : opendir(f->path);
    for (const struct dirent *e; !link && all && (e = readdir(all)) != NULL;)
        link = folder_is_numbered(e->d_name, "picture_", 1, ".png") &&
               folder_is_link(f, e->d_name, error, size);
    if (all) closedir(all);
    return !link;
}

/* Numbered files that are removed: prefix and suffix. */
typedef struct numbered {
    const char *before, *after;
} numbered;

static bool folder_remove_numbered(int fd, const char *place, const numbered *n, size_t digits,
                                   char *error, size_t size)
{
    const int own = openat(fd, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR *all = own >= 0 ? fdopendir(own) : NULL;
    bool done = true;
    if (own >= 0 && !all) close(own);
    for (const struct dirent *e; done && all && (e = readdir(all)) != NULL;)
        if (folder_is_numbered(e->d_name, n->before, digits, n->after))
            done = folder_remove(fd, place, e->d_name, error, size);
    if (all) closedir(all);
    return done;
}

/* Remove frames, if the folder `name` is in the run itself: through a link the files of another
 * folder would be removed. */
static bool folder_clear_frames(int fd, const char *place, const char *name, char *error,
                                size_t size)
{
    static const char *const ends[] = {".vtp", ".vtp.tmp", ".pvtp", ".pvtp.tmp"};
    char path[FOLDER_PATH + 16], before[16];
    const int frames = openat(fd, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    bool done = true;
    if (frames < 0 && errno == ENOENT) return true;
    snprintf(path, sizeof path, "%s/%s", place, name);
    if (frames < 0) {
        snprintf(error, size,
                 "--overwrite: %s is a link or no folder: what it leads to is not removed; remove "
                 "it, or choose another folder with --out",
                 path);
        return false;
    }
    snprintf(before, sizeof before, "%s_", name);
    for (size_t i = 0; done && i < sizeof ends / sizeof *ends; i++)
        done = folder_remove_numbered(frames, path, &(numbered){before, ends[i]}, 6, error, size);
    close(frames);
    if (done) unlinkat(fd, name, AT_REMOVEDIR); /* only if it is empty */
    return done;
}

bool mps__folder_clear(const folder *f, const char *keep, char *error, size_t size)
{
    static const numbered pictures = {"picture_", ".png"};
    const int fd = open(f->path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0) {
        snprintf(error, size, "--overwrite: %s: %s; %s", f->path, strerror(errno),
                 mps__folder_advice(errno));
        return false;
    }
    bool done = folder_clear_frames(fd, f->path, "frames", error, size) &&
                folder_clear_frames(fd, f->path, "peaks", error, size);
    for (int i = 0; done && i < FOLDER_FILES; i++)
        if (!keep || strcmp(keep, FILES[i]) != 0)
            done = folder_remove(fd, f->path, FILES[i], error, size);
    if (done) done = folder_remove_numbered(fd, f->path, &pictures, 1, error, size);
    close(fd);
    return done;
}

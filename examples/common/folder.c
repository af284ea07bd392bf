/* SPDX-License-Identifier: BSD-3-Clause */
/* Folders are locked by fcntl() on a file in them: the system removes the lock however the program
 * ends, and tells which process holds it. */
#include "folder.h"
#include "ranks.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { FOLDER_PATH = 512, FOLDER_ROOM = 65536 /* bytes that must fit on the disk */ };

static const char LOCK[] = "run.lock";

/* What every driver writes, beside frames/ and plots of its own columns. The first ones tell that there is a run. */
static const char *const FILES[] = {
    "checkpoint.mps",      "probes.csv",         "steps.csv",          "frames.pvd",
    "summary.json",        "checkpoint.mps.tmp", "momentum.csv",       "trace.csv",
    "report.html",         "frames.pvd.tmp",     "picture_end.png",    "plot_pressure.svg",
    "plot_dt.svg",         "plot_ppe.svg",       "plot_elevation.svg", "plot_momentum_x.svg",
    "plot_momentum_y.svg", "plot_speed.svg",     "plot_energy.svg",    "plot_momentum_z.svg"};
enum { FOLDER_FILES = sizeof FILES / sizeof *FILES, FOLDER_SIGNS = 5 };

static char lock_path[FOLDER_PATH + sizeof LOCK]; /* of the lock that this program holds */

const char *folder_advice(int error)
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

static void folder_refuse(const cli_options *o, int error)
{
    fprintf(ranks_messages(), "%s: --out %s: %s; %s\n", o->program, o->out, strerror(error),
            folder_advice(error));
    ranks_exit(CLI_USAGE);
}

/* mkdir -p */
static bool folder_make(const char *path)
{
    char part[FOLDER_PATH];
    if (snprintf(part, sizeof part, "%s", path) >= (int)sizeof part) {
        errno = ENAMETOOLONG;
        return false;
    }
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
static void folder_unlock(void)
{
    if (lock_path[0]) unlink(lock_path);
}

/* A file that is locked and still in the folder; a run that ended meanwhile has taken its own away. */
static bool folder_is_current(int fd)
{
    struct stat mine, there;
    return fstat(fd, &mine) == 0 && stat(lock_path, &there) == 0 && mine.st_ino == there.st_ino &&
           mine.st_dev == there.st_dev;
}

static void folder_refuse_locked(const cli_options *o, int fd)
{
    struct flock held = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    if (fcntl(fd, F_GETLK, &held) == 0 && held.l_type != F_UNLCK)
        fprintf(ranks_messages(),
                "%s: --out %s: another run is writing there, process %ld; wait until it ends, or "
                "choose another folder with --out\n",
                o->program, o->out, (long)held.l_pid);
    else
        fprintf(ranks_messages(), "%s: --out %s: another run was writing there; try again\n",
                o->program, o->out);
    ranks_exit(CLI_USAGE);
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

static void folder_lock(const cli_options *o)
{
    char path[sizeof lock_path];
    struct flock wanted = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    for (int fd = -1; fd < 0;) {
        snprintf(path, sizeof path, "%s/%s", o->out, LOCK);
        fd = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (fd < 0) folder_refuse(o, errno);
        if (fcntl(fd, F_SETLK, &wanted) != 0) {
            if (errno == EACCES || errno == EAGAIN) folder_refuse_locked(o, fd);
            folder_refuse(o, errno);
        }
        memcpy(lock_path, path, sizeof path);
        if (folder_is_current(fd)) {
            atexit(folder_unlock); /* the file stays open until the program ends */
            if (!folder_has_room(fd)) folder_refuse(o, errno);
        } else {
            lock_path[0] = '\0';
            close(fd);
            fd = -1;
        }
    }
}

/* ---- an earlier run ---- */

static bool folder_has(const cli_options *o, const char *name)
{
    char path[FOLDER_PATH + 64];
    struct stat s;
    snprintf(path, sizeof path, "%s/%s", o->out, name);
    return lstat(path, &s) == 0;
}

static void folder_check(const cli_options *o)
{
    char there[128] = "";
    for (int i = 0; i < FOLDER_SIGNS; i++) {
        if (!folder_has(o, FILES[i])) continue;
        snprintf(there + strlen(there), sizeof there - strlen(there), "%s%s", there[0] ? ", " : "",
                 FILES[i]);
    }
    if (!there[0] || o->resume || o->overwrite) return;
    fprintf(ranks_messages(),
            "%s: --out %s: there is an earlier run (%s); %s, --overwrite removes it, or choose "
            "another folder with --out\n",
            o->program, o->out, there,
            folder_has(o, FILES[0]) ? "--resume goes on from its checkpoint"
                                    : "it has no checkpoint to go on from with --resume");
    ranks_exit(CLI_USAGE);
}

void folder_open(const cli_options *o)
{
    if (o->resume && o->overwrite)
        cli_refuse(o, "--resume and --overwrite exclude each other%s%s", "", "");
    if (!folder_make(o->out)) folder_refuse(o, errno);
    folder_lock(o);
    folder_check(o);
}

/* ---- removal ---- */

static void folder_remove(run *r, const char *name)
{
    char path[FOLDER_PATH + 300];
    snprintf(path, sizeof path, "%s/%s", r->options.out, name);
    if (unlink(path) == 0 || errno == ENOENT) return;
    fprintf(ranks_messages(), "%s: --overwrite: cannot remove %s: %s; %s\n", r->options.program,
            path, strerror(errno), folder_advice(errno));
    ranks_exit(CLI_USAGE);
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

/* Numbered files of the folder or of one in it; `inside` is "" or ends in '/'. */
static void folder_remove_numbered(run *r, const char *inside, const char *before, size_t digits,
                                   const char *after)
{
    char path[FOLDER_PATH + 64], name[288];
    snprintf(path, sizeof path, "%s/%s", r->options.out, inside);
    DIR *folder = opendir(path);
    for (const struct dirent *e; folder && (e = readdir(folder)) != NULL;) {
        if (!folder_is_numbered(e->d_name, before, digits, after)) continue;
        snprintf(name, sizeof name, "%s%s", inside, e->d_name);
        folder_remove(r, name);
    }
    if (folder) closedir(folder);
}

void folder_clear(run *r)
{
    char name[80], path[FOLDER_PATH + 64];
    for (int i = 0; i < FOLDER_FILES; i++) folder_remove(r, FILES[i]);
    for (int i = 0; i < r->columns; i++) {
        snprintf(name, sizeof name, "plot_%s.svg", r->column[i].name);
        folder_remove(r, name);
    }
    folder_remove_numbered(r, "", "picture_", 1, ".png");
    static const char *const ends[] = {".vtp", ".vtp.tmp", ".pvtp", ".pvtp.tmp"};
    for (int i = 0; i < 4; i++) folder_remove_numbered(r, "frames/", "frames_", 6, ends[i]);
    snprintf(path, sizeof path, "%s/frames", r->options.out);
    rmdir(path); /* if nothing else is in it */
}

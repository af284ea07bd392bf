/* SPDX-License-Identifier: BSD-3-Clause */
/* Frames for ParaView: XML PolyData (.vtp) with appended raw data, and the .pvd series that lists
 * their names and times. Every file is written under a temporary name and renamed, so that a reader
 * never sees an incomplete file.
 *
 * On many ranks only rank 0 has the series; the others write pieces, or nothing. */
#define _POSIX_C_SOURCE 200809L
#include "frames.h"
#include "frame_file.h"
#include "regular.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { NAME_SIZE = 48, LINE_SIZE = 256 };

/* A frame of the series. */
typedef struct stamp {
    double t;
    int64_t number; /* in its file names */
    bool pieces;    /* .pvtp */
} stamp;

struct mps_frames {
    mps__world *world; /* not owned */
    int32_t kinds;
    char name[NAME_SIZE];
    char *folder, *path, *temporary; /* the last two are buffers for file names */
    size_t path_size;
    int64_t count, capacity;
    stamp *frame;
    bool continues;        /* the series has frames of an earlier run */
    bool pieces;           /* each rank writes its own particles */
    bool steps;            /* a frame's number is its step number */
    int64_t place, number; /* of the current frame */
};

static mps_status io_failed(const mps_frames *f, const char *what, const char *path)
{
    return mps__fail(f->world->context, MPS_E_IO, "cannot %s \"%.300s\": %s", what, path,
                     strerror(errno));
}

static const char series_head[] = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" "
                                  "version=\"0.1\" byte_order=\"%s\">\n<Collection>\n";
static const char series_time[] = "<DataSet timestep=\"";
static const char series_end[] = "</Collection>\n</VTKFile>\n";

/* Line of a frame in the .pvd file. */
static void series_line(const mps_frames *f, const stamp *frame, char line[LINE_SIZE])
{
    snprintf(line, LINE_SIZE, "%s%.17g\" part=\"0\" file=\"%s/%s_%06lld.%s\"/>\n", series_time,
             frame->t, f->name, f->name, (long long)frame->number, frame->pieces ? "pvtp" : "vtp");
}

static void write_series(const mps_frames *f, FILE *file)
{
    char line[LINE_SIZE];
    fprintf(file, series_head, mps__frame_byte_order());
    for (int64_t k = 0; k < f->count; k++) {
        series_line(f, &f->frame[k], line);
        fputs(line, file);
    }
    fputs(series_end, file);
}

static void write_frame(const mps_frames *f, FILE *file)
{
    mps__frame_write(f->world, f->kinds, file);
}

static void write_pieces(const mps_frames *f, FILE *file)
{
    char stem[NAME_SIZE + 32];
    snprintf(stem, sizeof stem, "%s_%06lld", f->name, (long long)f->number);
    mps__frame_write_pieces(f->world, stem, f->world->ranks.count, file);
}

/* Write f->path via f->temporary. */
static mps_status write_file(const mps_frames *f, void (*write)(const mps_frames *f, FILE *file))
{
    snprintf(f->temporary, f->path_size + 8, "%s.tmp", f->path);
    FILE *file = fopen(f->temporary, "wb");
    if (!file) return io_failed(f, "create", f->temporary);
    write(f, file);
    bool good = !ferror(file);
    if (fclose(file) != 0 || !good) {
        mps_status status = io_failed(f, "write", f->temporary);
        remove(f->temporary);
        return status;
    }
    if (rename(f->temporary, f->path) != 0) {
        mps_status status = io_failed(f, "replace", f->path);
        remove(f->temporary);
        return status;
    }
    return MPS_OK;
}

static mps_status update_series(const mps_frames *f)
{
    snprintf(f->path, f->path_size, "%s/%s.pvd", f->folder, f->name);
    return write_file(f, write_series);
}

static mps_status create_folder(const mps_frames *f)
{
    snprintf(f->path, f->path_size, "%s/%s", f->folder, f->name);
    if (mkdir(f->path, 0777) != 0 && errno != EEXIST)
        return io_failed(f, "create the folder", f->path);
    return MPS_OK;
}

/* Valid text after the number of a frame: ".vtp", ".pvtp" or "_<rank>.vtp", and ".tmp" if a program
 * was killed. */
static bool is_frame_end(const char *end)
{
    static const char *const ends[] = {".vtp", ".vtp.tmp", ".pvtp", ".pvtp.tmp"};
    const size_t rank = *end == '_' ? strspn(end + 1, "0123456789") : 0;
    bool known = false;
    for (int k = 0; k < (rank >= 4 ? 2 : 4); k++)
        known = known || strcmp(end + (rank >= 4 ? rank + 1 : 0), ends[k]) == 0;
    return known;
}

static bool has_number(const mps_frames *f, int64_t number)
{
    for (int64_t k = f->count; k-- > 0;)
        if (f->frame[k].number == number) return true;
    return false;
}

/* Whether this is a file "<name>_<digits>..." that the series does not list. */
static bool is_old_frame(const mps_frames *f, const char *file)
{
    size_t length = strlen(f->name);
    if (strncmp(file, f->name, length) != 0 || file[length] != '_') return false;
    const char *digits = file + length + 1;
    const size_t count = strspn(digits, "0123456789");
    return count >= 6 && is_frame_end(digits + count) && !has_number(f, strtoll(digits, NULL, 10));
}

/* Remove frames of an earlier run in the same folder: a shorter new series would not overwrite
 * them, and the .pvd does not list them. */
static mps_status remove_old(const mps_frames *f)
{
    const struct dirent *entry;
    mps_status status = MPS_OK;
    snprintf(f->temporary, f->path_size + 8, "%s/%s", f->folder, f->name);
    DIR *folder = opendir(f->temporary);
    if (!folder) return io_failed(f, "read the folder", f->temporary);
    while (status == MPS_OK && (entry = readdir(folder)) != NULL) {
        if (!is_old_frame(f, entry->d_name) || strlen(entry->d_name) >= NAME_SIZE + 48) continue;
        snprintf(f->path, f->path_size, "%s/%s/%s", f->folder, f->name, entry->d_name);
        if (remove(f->path) != 0 && errno != ENOENT) status = io_failed(f, "remove", f->path);
    }
    closedir(folder);
    return status;
}

/* ---- continuing a series ---- */

/* Rounding error of a time, as at the end of mps_run(). */
static double time_slack(const mps_frames *f)
{
    return 1e-12 * fmax(1.0, fabs(f->world->state.t));
}

static bool read_text(FILE *file, const char *wanted)
{
    for (; *wanted; wanted++)
        if (fgetc(file) != *wanted) return false;
    return true;
}

/* Whether the line is the line of frame k; reads its time, number and kind. */
static bool read_line(const mps_frames *f, int64_t k, const char *line, stamp *frame)
{
    char wanted[LINE_SIZE];
    const char *number = strrchr(line, '_');
    *frame = (stamp){strtod(line + strlen(series_time), NULL),
                     f->steps && number ? strtoll(number + 1, NULL, 10) : k,
                     strstr(line, ".pvtp\"") != NULL};
    series_line(f, frame, wanted);
    return strcmp(line, wanted) == 0;
}

/* Whether the frame has a file: it may have been removed after the checkpoint. */
static bool has_file(const mps_frames *f, const stamp *frame)
{
    struct stat there;
    snprintf(f->temporary, f->path_size + 8, "%s/%s/%s_%06lld.%s", f->folder, f->name, f->name,
             (long long)frame->number, frame->pieces ? "pvtp" : "vtp");
    return stat(f->temporary, &there) == 0;
}

/* Read the frames up to the present time. */
static mps_status read_times(mps_frames *f, FILE *file, bool *good)
{
    char head[LINE_SIZE], line[LINE_SIZE] = "";
    const size_t before = strlen(series_time);
    const double last = f->world->state.t + time_slack(f);
    bool later = false;
    stamp frame;
    snprintf(head, sizeof head, series_head, mps__frame_byte_order());
    *good = read_text(file, head);
    for (int64_t k = 0;
         *good && fgets(line, sizeof line, file) && strncmp(line, series_time, before) == 0; k++) {
        *good = read_line(f, k, line, &frame);
        later = later || !(frame.t <= last);
        if (later || (f->steps && !has_file(f, &frame))) continue;
        MPS__TRY(mps__grow(f->world->context, (void **)&f->frame, &f->capacity, f->count,
                           f->count + 1, sizeof *f->frame));
        f->frame[f->count++] = frame;
    }
    const char *newline = strchr(series_end, '\n') + 1;
    *good = *good && strncmp(line, series_end, (size_t)(newline - series_end)) == 0 &&
            read_text(file, newline) && fgetc(file) == EOF;
    return MPS_OK;
}

/* Read the existing series; no file is an empty series. */
static mps_status read_series(mps_frames *f)
{
    bool good = false;
    snprintf(f->path, f->path_size, "%s/%s.pvd", f->folder, f->name);
    const char *why;
    FILE *file = mps__regular_stream(f->path, O_RDONLY, &why);
    if (!file && why)
        return mps__fail(f->world->context, MPS_E_IO, "cannot read \"%.300s\": %s", f->path, why);
    if (!file) return errno == ENOENT ? MPS_OK : io_failed(f, "read", f->path);
    mps_status status = read_times(f, file, &good);
    if (status == MPS_OK && ferror(file))
        status = io_failed(f, "read", f->path);
    else if (status == MPS_OK && !good)
        status = mps__fail(f->world->context, MPS_E_IO,
                           "cannot go on with \"%.300s\": it is not as mps_frames_write() leaves "
                           "it; without it a series begins",
                           f->path);
    fclose(file);
    return status;
}

/* ---- opening ---- */

/* Names are used in paths and XML without escapes. */
static bool good_name(const char *name)
{
    size_t length = name ? strnlen(name, NAME_SIZE) : 0;
    if (length == 0 || length == NAME_SIZE || name[0] == '.') return false;
    return strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.") ==
           length;
}

static mps_status open_series(mps_frames *f, const char *folder)
{
    mps__context *c = f->world->context;
    size_t length = strlen(folder);
    f->path_size = length + 2 * NAME_SIZE + 64;
    f->folder = mps__alloc(c, (int64_t)length + 1, 1);
    f->path = mps__alloc(c, (int64_t)f->path_size, 1);
    f->temporary = mps__alloc(c, (int64_t)f->path_size + 8, 1);
    if (!f->folder || !f->path || !f->temporary) return MPS_E_NOMEM;
    memcpy(f->folder, folder, length + 1);
    if (f->world->ranks.rank > 0) return f->pieces ? create_folder(f) : MPS_OK;
    MPS__TRY(create_folder(f));
    if (f->continues) MPS__TRY(read_series(f));
    MPS__TRY(update_series(f));
    return remove_old(f);
}

mps_status mps__frames_open(mps__world *w, const char *folder, const char *name, int32_t kinds,
                            mps_frames **frames)
{
    mps__context *c = w->context;
    const int32_t some = MPS_FRAMES_FLUID | MPS_FRAMES_WALL | MPS_FRAMES_DUMMY,
                  all = some | MPS_FRAMES_CONTINUE | MPS_FRAMES_PIECES | MPS_FRAMES_TANK |
                        MPS_FRAMES_STEPS;
    *frames = NULL;
    MPS__CHECK(c, folder && folder[0], "the folder of the frames is NULL or empty");
    MPS__CHECK(c, good_name(name),
               "frames: name \"%.60s\" must have 1..%d of the characters A-Z a-z 0-9 _ - . and not "
               "begin with a dot",
               name ? name : "", NAME_SIZE - 1);
    MPS__CHECK(c, kinds >= 0 && kinds <= all,
               "frames: kinds is %d, must be a sum of MPS_FRAMES_..., 0..%d", (int)kinds, (int)all);
    const bool pieces = (kinds & MPS_FRAMES_PIECES) != 0 && mps__ranks_many(&w->ranks);
    mps_frames *f = mps__alloc(c, 1, sizeof *f);
    if (!f) return pieces ? mps__ranks_report(&w->ranks, MPS_E_NOMEM) : MPS_E_NOMEM;
    f->world = w;
    f->kinds = (kinds & some ? kinds & some : MPS_FRAMES_FLUID | MPS_FRAMES_WALL) |
               (kinds & MPS_FRAMES_TANK);
    f->continues = (kinds & MPS_FRAMES_CONTINUE) != 0;
    f->steps = (kinds & MPS_FRAMES_STEPS) != 0;
    f->pieces = pieces;
    memcpy(f->name, name, strlen(name) + 1);
    mps_status status = open_series(f, folder);
    if (f->pieces) status = mps__ranks_agree(&w->ranks, status);
    if (status < 0)
        mps_frames_close(f);
    else
        *frames = f;
    return status;
}

/* A run that continues an interrupted run may write its state again: replace the frame of the same
 * time. */
static bool repeats_last(const mps_frames *f)
{
    return f->continues && f->count > 0 &&
           fabs(f->world->state.t - f->frame[f->count - 1].t) <= time_slack(f);
}

/* A frame of pieces cannot be replaced atomically, nor can one replace another frame: remove it
 * from the series and delete its files before it is written again. */
static mps_status drop_repeated(mps_frames *f)
{
    if (!repeats_last(f) || !(f->pieces || f->frame[f->count - 1].pieces)) return MPS_OK;
    f->count--;
    const mps_status status = update_series(f);
    if (status < 0) f->count++;
    return status < 0 ? status : remove_old(f);
}

/* Choose the index of the frame, and allocate its entry in the series. */
static mps_status choose_place(mps_frames *f)
{
    MPS__TRY(drop_repeated(f));
    f->place = f->count - repeats_last(f);
    f->number = f->steps ? f->world->state.step : f->place;
    return mps__grow(f->world->context, (void **)&f->frame, &f->capacity, f->count, f->place + 1,
                     sizeof *f->frame);
}

/* Rank 0 chooses and broadcasts the index. */
static mps_status choose_together(mps_frames *f)
{
    mps__ranks *r = &f->world->ranks;
    const mps_status status = r->rank == 0 ? choose_place(f) : MPS_OK;
    MPS__TRY(mps__ranks_agree(r, status));
    if (r->rank > 0) f->number = 0;
    mps__ranks_add(r, 1, &f->number);
    return mps__ranks_status(r);
}

/* Write a file of the frame; `suffix` follows its number. */
static mps_status write_part(const mps_frames *f, const char *suffix,
                             void (*write)(const mps_frames *f, FILE *file))
{
    snprintf(f->path, f->path_size, "%s/%s/%s_%06lld%s", f->folder, f->name, f->name,
             (long long)f->number, suffix);
    return write_file(f, write);
}

/* Write the series with the new frame. */
static mps_status add_frame(mps_frames *f)
{
    const stamp frame = {f->world->state.t, f->number, f->pieces};
    const bool fresh = f->place == f->count;
    f->frame[f->place] = frame;
    if (!fresh) return MPS_OK;
    f->count++;
    const mps_status status = update_series(f);
    if (status < 0) f->count--;
    return status;
}

static mps_status write_whole(mps_frames *f)
{
    MPS__TRY(choose_place(f));
    MPS__TRY(write_part(f, ".vtp", write_frame));
    return add_frame(f);
}

static mps_status write_own_piece(mps_frames *f)
{
    char suffix[32];
    mps__ranks *r = &f->world->ranks;
    MPS__TRY(mps__ranks_status(r));
    MPS__TRY(choose_together(f));
    snprintf(suffix, sizeof suffix, "_%04d.vtp", (int)r->rank);
    mps_status status = write_part(f, suffix, write_frame);
    MPS__TRY(mps__ranks_agree(r, status));
    if (r->rank == 0) status = write_part(f, ".pvtp", write_pieces);
    if (r->rank == 0 && status == MPS_OK) status = add_frame(f);
    return mps__ranks_agree(r, status);
}

mps_status mps_frames_write(mps_frames *frames)
{
    mps_frames *f = frames;
    if (!f) return MPS_E_ARG;
    const mps__world *w = f->world;
    if (w->context->lock.level > MPS__READ_ONLY)
        return mps__fail(
            w->context, MPS_E_BUSY,
            "mps_frames_write() was called from %s: call it when mps_step() has returned",
            w->context->lock.what);
    if (mps__ranks_many(&w->ranks) && f->pieces == w->collected.begun)
        return mps__fail(w->context, MPS_E_STATE,
                         f->pieces ? "frames in pieces: call mps_particles_collect_end() first"
                                   : "the frames of many ranks: call mps_particles_collect() "
                                     "first, or open them with MPS_FRAMES_PIECES");
    MPS__TRY(mps__world_fetch(w));
    if (f->pieces) return write_own_piece(f);
    return w->ranks.rank == 0 ? write_whole(f) : MPS_OK;
}

mps_status mps_frames_remove(mps_frames *frames, mps_frames_wanted_fn wanted, void *user)
{
    mps_frames *f = frames;
    if (!f || !wanted) return MPS_E_ARG;
    MPS__CHECK(f->world->context, f->steps,
               "mps_frames_remove(): open the series with "
               "MPS_FRAMES_STEPS");
    if (f->world->ranks.rank > 0) return MPS_OK;
    int64_t kept = 0;
    for (int64_t k = 0; k < f->count; k++)
        if (wanted(user, f->frame[k].t)) f->frame[kept++] = f->frame[k];
    if (kept == f->count) return MPS_OK;
    f->count = kept;
    MPS__TRY(update_series(f));
    return remove_old(f);
}

void mps_frames_close(mps_frames *frames)
{
    if (!frames) return;
    mps__context *c = frames->world->context;
    mps__free(c, frames->folder);
    mps__free(c, frames->path);
    mps__free(c, frames->temporary);
    mps__free(c, frames->frame);
    mps__free(c, frames);
}

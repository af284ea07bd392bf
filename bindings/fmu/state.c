/* SPDX-License-Identifier: BSD-3-Clause */
/* States of a tank: snapshots; as bytes, checkpoints preceded by the values of the importer. */
#include "adapter.h"
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct fmu_state {
    mps_snapshot *snapshot;
    fmu_values v;
    unsigned char *bytes; /* NULL: not requested yet */
    size_t size;
    fmu_state *next;
};

/* The header before the checkpoint. */
typedef struct head {
    char magic[8];
    char token[FMU_TOKEN];
    fmu_values v;
    mps_motion_state pose;
} head;
static const char MAGIC[8] = "mpsfmu1";

static void clear_bytes(fmu_state *s)
{
    free(s->bytes);
    s->bytes = NULL;
    s->size = 0;
}

void fmu_state_free(fmu *f, fmu_state *state)
{
    for (fmu_state **at = &f->states; *at; at = &(*at)->next) {
        if (*at != state) continue;
        *at = state->next;
        clear_bytes(state);
        mps_snapshot_destroy(state->snapshot);
        free(state);
        return;
    }
}

/* The state belongs to this instance. */
static fmu_status check(const fmu *f, const fmu_state *state)
{
    for (const fmu_state *s = f->states; s; s = s->next)
        if (s == state) return FMU_OK;
    return fmu_log(f, FMU_ERROR, "state: is not one of this instance, or was freed");
}

fmu_status fmu_state_take(fmu *f, fmu_state **state)
{
    fmu_state *s = *state;
    if (s && check(f, s) != FMU_OK) return FMU_ERROR;
    if (!s) {
        s = calloc(1, sizeof *s);
        if (!s) return fmu_log(f, FMU_ERROR, "state: no memory");
        s->next = f->states;
        f->states = s;
    }
    clear_bytes(s);
    if ((!s->snapshot && mps_snapshot_create(f->model.sim, &s->snapshot) != MPS_OK) ||
        mps_snapshot_take(s->snapshot) != MPS_OK) {
        fmu_refused(f, FMU_ERROR, "state");
        if (!*state) fmu_state_free(f, s);
        return FMU_ERROR;
    }
    s->v = f->v;
    *state = s;
    return FMU_OK;
}

fmu_status fmu_state_restore(fmu *f, fmu_state *state)
{
    if (check(f, state) != FMU_OK) return FMU_ERROR;
    if (mps_snapshot_restore(state->snapshot) != MPS_OK) return fmu_refused(f, FMU_ERROR, "state");
    f->v = state->v;
    return FMU_OK;
}

/* ---- bytes ---- */

static void path_of(const fmu *f, char *path, size_t size)
{
    snprintf(path, size, "%s/state.mps", f->model.folder);
}

/* The file in the folder of the model, which other programs can change: no link, and no FIFO, which
 * would block forever. NULL with errno. */
static FILE *open_file(const char *path, bool written)
{
    const int flags = written ? O_WRONLY | O_CREAT | O_EXCL : O_RDONLY;
    struct stat s;
    if (written && unlink(path) != 0 && errno != ENOENT) return NULL;
    const int fd = open(path, flags | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC, 0600);
    const bool regular = fd >= 0 && fstat(fd, &s) == 0 && S_ISREG(s.st_mode);
    FILE *file = regular ? fdopen(fd, written ? "wb" : "rb") : NULL;
    const int number = fd >= 0 && !regular ? EINVAL : errno;
    if (fd >= 0 && !file) close(fd);
    errno = number;
    return file;
}

/* Read the header and the file after it. @return false: errno */
static bool read_file(fmu_state *s, const char *path, const head *h)
{
    FILE *file = open_file(path, false);
    bool good = file && fseek(file, 0, SEEK_END) == 0;
    const long length = good ? ftell(file) : -1;
    good = length > 0 && fseek(file, 0, SEEK_SET) == 0;
    unsigned char *bytes = good ? malloc(sizeof *h + (size_t)length) : NULL;
    good = bytes && fread(bytes + sizeof *h, 1, (size_t)length, file) == (size_t)length;
    if (file) fclose(file);
    if (!good) {
        free(bytes);
        return false;
    }
    memcpy(bytes, h, sizeof *h);
    s->bytes = bytes;
    s->size = sizeof *h + (size_t)length;
    return true;
}

/* The simulation is in the state. */
static fmu_status write_bytes(fmu *f, fmu_state *s)
{
    char path[512];
    head h;
    memset(&h, 0, sizeof h);
    memcpy(h.magic, MAGIC, sizeof h.magic);
    memcpy(h.token, f->token, sizeof h.token);
    memcpy(&h.v, &s->v, sizeof h.v);
    mps_motion_state_init(&h.pose, sizeof h.pose);
    path_of(f, path, sizeof path);
    if (mps_motion_state_get(f->model.sim, &h.pose) != MPS_OK ||
        mps_checkpoint_write(f->model.sim, path) != MPS_OK)
        return fmu_refused(f, FMU_ERROR, "state as bytes");
    const bool good = read_file(s, path, &h);
    const char *why = strerror(errno);
    unlink(path);
    return good ? FMU_OK : fmu_log(f, FMU_ERROR, "state as bytes: %s: %s", path, why);
}

/* Restore `f->before`, the state at the beginning of a call. */
static fmu_status go_back(fmu *f, fmu_status status)
{
    if (mps_snapshot_restore(f->before) == MPS_OK) return status;
    return fmu_refused(f, FMU_ERROR, "state, going back");
}

/* Create the bytes of a state of this instance, unless they exist. */
static fmu_status need_bytes(fmu *f, fmu_state *state)
{
    const fmu_status status = check(f, state);
    if (status != FMU_OK || state->bytes) return status;
    if (mps_snapshot_take(f->before) != MPS_OK || mps_snapshot_restore(state->snapshot) != MPS_OK)
        return fmu_refused(f, FMU_ERROR, "state as bytes");
    return go_back(f, write_bytes(f, state));
}

fmu_status fmu_state_bytes(fmu *f, fmu_state *state, const unsigned char **bytes, size_t *size)
{
    const fmu_status status = need_bytes(f, state);
    if (status != FMU_OK) return status;
    *bytes = state->bytes;
    *size = state->size;
    return FMU_OK;
}

fmu_status fmu_state_write(fmu *f, fmu_state *state, void *out, size_t size)
{
    const fmu_status status = need_bytes(f, state);
    if (status != FMU_OK) return status;
    if (size < state->size)
        return fmu_log(f, FMU_ERROR, "state as bytes: %zu bytes are too few for %zu", size,
                       state->size);
    memcpy(out, state->bytes, state->size);
    return FMU_OK;
}

/* The bytes are not trusted. @return NULL, or the error */
static const char *check_head(const fmu *f, const head *h)
{
    const double *numbers = &h->v.start;
    const size_t count = offsetof(fmu_values, mode) / sizeof(double);
    if (memcmp(h->magic, MAGIC, sizeof h->magic) != 0) return "are not a state of a tank";
    if (memcmp(h->token, f->token, sizeof h->token) != 0) return "are a state of another case";
    for (size_t k = 0; k < count; k++)
        if (!isfinite(numbers[k])) return "are damaged";
    if (h->v.mode < FMU_INSTANTIATED || h->v.mode > FMU_TERMINATED || (h->v.has_mass & ~1))
        return "are damaged";
    return NULL;
}

static bool write_file(const char *path, const unsigned char *bytes, size_t size)
{
    FILE *file = open_file(path, true);
    bool good = file && fwrite(bytes, 1, size, file) == size;
    if (file && fclose(file) != 0) good = false;
    return good;
}

/* Read the checkpoint, and take it as a state. The tank is at its pose. The motion is then
 * prescribed by poses again, so that the next pose is not an initial one; the state does not
 * contain this. */
static fmu_status arrive(fmu *f, const head *h, const char *path, fmu_state **state)
{
    mps_sim *sim = f->model.sim;
    const fmu_values now = f->v;
    const mps_motion_state hold = f->hold;
    f->hold = h->pose;
    f->hold.struct_size = sizeof f->hold;
    fmu_status status = FMU_ERROR;
    if (fmu_hold(f) != MPS_OK || mps_checkpoint_read(sim, path) != MPS_OK) {
        fmu_refused(f, FMU_ERROR, "state from bytes");
    } else {
        f->v = h->v;
        status = fmu_state_take(f, state);
        f->v = now;
    }
    if (mps_motion_pose_set(sim, 1e9, &f->hold) != MPS_OK)
        status = fmu_refused(f, FMU_ERROR, "state from bytes");
    f->hold = hold;
    return status;
}

fmu_status fmu_state_read(fmu *f, const unsigned char *bytes, size_t size, fmu_state **state)
{
    head h;
    char path[512];
    fmu_state *made = NULL;
    if (!bytes || size <= sizeof h)
        return fmu_log(f, FMU_ERROR, "state from bytes: they are cut short");
    memcpy(&h, bytes, sizeof h);
    const char *wrong = check_head(f, &h);
    if (wrong) return fmu_log(f, FMU_ERROR, "state from bytes: they %s", wrong);
    path_of(f, path, sizeof path);
    if (!write_file(path, bytes + sizeof h, size - sizeof h)) {
        const char *why = strerror(errno);
        unlink(path);
        return fmu_log(f, FMU_ERROR, "state from bytes: %s: %s", path, why);
    }
    fmu_status status = FMU_OK;
    if (mps_snapshot_take(f->before) != MPS_OK)
        status = fmu_refused(f, FMU_ERROR, "state from bytes");
    if (status == FMU_OK) status = go_back(f, arrive(f, &h, path, &made));
    unlink(path);
    if (status == FMU_OK)
        *state = made;
    else if (made)
        fmu_state_free(f, made);
    return status;
}

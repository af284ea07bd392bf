/* SPDX-License-Identifier: BSD-3-Clause */
/* Archives: written part by part, read as a whole. */
#define _POSIX_C_SOURCE 200809L
#include "archive.h"
#include "regular.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { VERSION = 1, BYTE_ORDER_MARK = 0x01020304 };

static const char magic[8] = {'m', 'p', 's', 's', 't', 'a', 't', 'e'}, last_part[] = "end";

typedef struct head {
    char magic[8];
    uint32_t version, order;
} head;

typedef struct part {
    char name[MPS__PART_TITLE];
    uint32_t bytes, checksum; /* the checksum is computed with 0 in its own field */
    int64_t count;
} part;

uint32_t mps__checksum(uint32_t before, const void *data, size_t bytes)
{
    static const uint32_t nibble[16] = {0,          0x1db71064, 0x3b6e20c8, 0x26d930ac,
                                        0x76dc4190, 0x6b6b51f4, 0x4db26158, 0x5005713c,
                                        0xedb88320, 0xf00f9344, 0xd6d6a3e8, 0xcb61b38c,
                                        0x9b64c2b0, 0x86d3d2d4, 0xa00ae278, 0xbdbdf21c};
    const unsigned char *p = data;
    uint32_t c = ~before;
    for (size_t k = 0; k < bytes; k++) {
        c = nibble[(c ^ p[k]) & 15] ^ (c >> 4);
        c = nibble[(c ^ (p[k] >> 4)) & 15] ^ (c >> 4);
    }
    return ~c;
}

static uint32_t part_checksum(part p, const void *elements)
{
    p.checksum = 0;
    return mps__checksum(mps__checksum(0, &p, sizeof p), elements, (size_t)p.count * p.bytes);
}

/* Padded size of the elements in the file, in bytes. */
static int64_t padded(const part *p)
{
    return (p->count * (int64_t)p->bytes + 7) / 8 * 8;
}

/* ---- writing ---- */

static void note_error(mps__archive *a)
{
    if (!a->error) a->error = errno ? errno : EIO;
}

static void put_bytes(mps__archive *a, const void *data, size_t bytes)
{
    if (!a->error && bytes > 0 && fwrite(data, 1, bytes, a->file) != bytes) note_error(a);
}

static void put_head(mps__archive *a)
{
    head h = {.version = VERSION, .order = BYTE_ORDER_MARK};
    memcpy(h.magic, magic, sizeof magic);
    put_bytes(a, &h, sizeof h);
}

void mps__archive_put(mps__archive *a, const char *name, const void *elements, size_t bytes,
                      int64_t count)
{
    static const char zeros[8] = {0};
    part p = {.bytes = (uint32_t)bytes, .count = count};
    const size_t size = (size_t)count * bytes;
    strncpy(p.name, name, sizeof p.name - 1);
    p.checksum = part_checksum(p, elements);
    put_bytes(a, &p, sizeof p);
    put_bytes(a, elements, size);
    put_bytes(a, zeros, (size_t)padded(&p) - size);
}

static mps_status io_failed(mps__context *c, const char *what, const char *path)
{
    return mps__fail(c, MPS_E_IO, "cannot %s \"%.300s\": %s", what, path, strerror(errno));
}

/* Flush the folder, so that the new name is on the disk. Truncates `path` to its folder. If the
 * folder is not readable, or the file system does not support this, the guarantee is only that of
 * rename(). */
static mps_status sync_folder(mps__context *c, char *path)
{
    char *slash = strrchr(path, '/');
    if (slash) slash[slash == path] = 0;
    const char *folder = slash ? path : ".";
    const int fd = open(folder, O_RDONLY | O_CLOEXEC);
    if (fd < 0) return MPS_OK;
    const bool good = fsync(fd) == 0 || errno == EINVAL || errno == EROFS || errno == ENOTSUP;
    const mps_status status = good ? MPS_OK : io_failed(c, "write the folder", folder);
    close(fd);
    return status;
}

/* Refuse to replace a device or another special file. */
static mps_status check_place(mps__context *c, const char *path)
{
    struct stat there;
    if (stat(path, &there) == 0 && !S_ISREG(there.st_mode))
        return mps__fail(c, MPS_E_IO, "cannot replace \"%.300s\": it is there and no regular file",
                         path);
    return MPS_OK;
}

mps_status mps__archive_create(mps__archive *a, const char *path)
{
    MPS__TRY(check_place(a->context, path));
    const size_t size = strlen(path) + sizeof ".tmp";
    a->temporary = mps__alloc(a->context, (int64_t)size, 1);
    if (!a->temporary) return MPS_E_NOMEM;
    snprintf(a->temporary, size, "%s.tmp", path);
    a->file = fopen(a->temporary, "wb");
    if (!a->file) return io_failed(a->context, "create", a->temporary);
    put_head(a);
    return MPS_OK;
}

/* Flush the file before it replaces the previous one: after a crash one or the other exists. */
static bool close_file(mps__archive *a)
{
    if (!a->error && (fflush(a->file) != 0 || fsync(fileno(a->file)) != 0)) note_error(a);
    if (fclose(a->file) != 0) note_error(a);
    a->file = NULL;
    errno = a->error;
    return a->error == 0;
}

mps_status mps__archive_save(mps__archive *a, const char *path)
{
    mps_status status = MPS_OK;
    mps__archive_put(a, last_part, NULL, 1, 0);
    if (!close_file(a))
        status = io_failed(a->context, "write", a->temporary);
    else if (rename(a->temporary, path) != 0)
        status = io_failed(a->context, "replace", path);
    if (status < 0)
        remove(a->temporary);
    else
        status = sync_folder(a->context, a->temporary);
    return status;
}

/* ---- reading ---- */

static mps_status read_all(mps__archive *a, FILE *file, const char *path)
{
    if ((fgetc(file) == EOF && ferror(file)) || fseek(file, 0, SEEK_END) != 0)
        return io_failed(a->context, "read", path);
    const long size = ftell(file);
    if (size < 0 || fseek(file, 0, SEEK_SET) != 0) return io_failed(a->context, "read", path);
    a->data = mps__alloc(a->context, size, 1);
    if (!a->data) return MPS_E_NOMEM;
    errno = 0;
    if (fread(a->data, 1, (size_t)size, file) != (size_t)size)
        return io_failed(a->context, "read", path);
    a->size = size;
    return MPS_OK;
}

static mps_status check_head(const mps__archive *a, const char *path)
{
    head h;
    if (a->size < (int64_t)sizeof h || memcmp(a->data, magic, sizeof magic) != 0)
        return mps__fail(a->context, MPS_E_IO, "\"%.300s\" is no checkpoint", path);
    memcpy(&h, a->data, sizeof h);
    if (h.order != BYTE_ORDER_MARK)
        return mps__fail(a->context, MPS_E_VERSION,
                         "\"%.300s\" is from a machine with another byte order", path);
    if (h.version != VERSION)
        return mps__fail(a->context, MPS_E_VERSION,
                         "\"%.300s\" has format %u; this library knows %d", path,
                         (unsigned)h.version, VERSION);
    return MPS_OK;
}

/* Read the part at an offset; false if it is incomplete or damaged. */
static bool part_at(const mps__archive *a, int64_t at, part *p)
{
    if (a->size - at < (int64_t)sizeof *p) return false;
    memcpy(p, a->data + at, sizeof *p);
    const int64_t remaining = a->size - at - (int64_t)sizeof *p;
    return p->count >= 0 && p->bytes > 0 && p->count <= remaining / p->bytes &&
           padded(p) <= remaining && memchr(p->name, 0, sizeof p->name);
}

/* The padding is checked too: only a file exactly as written is accepted. */
static bool part_whole(const part *p, const unsigned char *elements)
{
    for (int64_t k = p->count * (int64_t)p->bytes; k < padded(p); k++)
        if (elements[k] != 0) return false;
    return part_checksum(*p, elements) == p->checksum;
}

static mps_status check_parts(const mps__archive *a, const char *path)
{
    part p = {{0}, 0, 0, 0};
    int64_t at = (int64_t)sizeof(head);
    for (; strcmp(p.name, last_part) != 0; at += (int64_t)sizeof p + padded(&p)) {
        if (!part_at(a, at, &p))
            return mps__fail(a->context, MPS_E_IO, "checkpoint \"%.300s\" is cut short or damaged",
                             path);
        if (!part_whole(&p, a->data + at + sizeof p))
            return mps__fail(a->context, MPS_E_IO,
                             "checkpoint \"%.300s\" is damaged: the checksum of \"%s\" is wrong",
                             path, p.name);
    }
    if (at != a->size)
        return mps__fail(a->context, MPS_E_IO,
                         "checkpoint \"%.300s\" is damaged: it continues behind its end", path);
    return MPS_OK;
}

mps_status mps__archive_load(mps__archive *a, const char *path)
{
    const char *why;
    FILE *file = mps__regular_stream(path, O_RDONLY, &why);
    if (!file && why)
        return mps__fail(a->context, MPS_E_IO, "cannot read \"%.300s\": %s", path, why);
    if (!file) return io_failed(a->context, "read", path);
    mps_status status = read_all(a, file, path);
    fclose(file);
    if (status == MPS_OK) status = check_head(a, path);
    return status == MPS_OK ? check_parts(a, path) : status;
}

/* Offset of a part's elements, -1: not found. */
static int64_t find_part(const mps__archive *a, const char *name, part *p)
{
    for (int64_t at = (int64_t)sizeof(head); part_at(a, at, p) && strcmp(p->name, last_part) != 0;
         at += (int64_t)sizeof *p + padded(p))
        if (strcmp(p->name, name) == 0) return at + (int64_t)sizeof *p;
    return -1;
}

bool mps__archive_has(const mps__archive *a, const char *name)
{
    part p = {{0}, 0, 0, 0};
    return find_part(a, name, &p) >= 0;
}

const void *mps__archive_get(const mps__archive *a, const char *name, size_t bytes, int64_t *count)
{
    part p = {{0}, 0, 0, 0};
    const int64_t at = find_part(a, name, &p);
    if (at < 0) {
        mps__fail(a->context, MPS_E_VERSION, "the checkpoint has no \"%s\"", name);
        return NULL;
    }
    *count = p.count;
    if (p.bytes == bytes) return a->data + at;
    mps__fail(a->context, MPS_E_VERSION,
              "\"%s\" of the checkpoint has elements of %u bytes; this library has %zu", name,
              (unsigned)p.bytes, bytes);
    return NULL;
}

void mps__archive_free(mps__archive *a)
{
    mps__free(a->context, a->data);
    mps__free(a->context, a->temporary);
    *a = (mps__archive){.context = a->context};
}

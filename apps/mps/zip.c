/* SPDX-License-Identifier: BSD-3-Clause */
/* The zip format: each file after a local header, then a central directory, then the offset of this
 * directory. */
#include "zip.h"
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum {
    LOCAL = 0x04034b50,
    CENTRAL = 0x02014b50,
    END = 0x06054b50,
    VERSION = 20,
    MADE_BY_UNIX = 3 << 8,
    UTF8 = 1 << 11,
    DEFLATED = 8,
    MIDNIGHT_1980 = 0x21, /* date and time of all files: 1 January 1980 */
    RAW = -15             /* window of deflate without a header */
};

static void put(zip *z, unsigned long value, int bytes)
{
    for (int k = 0; k < bytes; k++)
        if (fputc((int)(value >> (8 * k) & 0xff), z->file) == EOF) z->failed = true;
}

static void put_bytes(zip *z, const void *data, size_t size)
{
    if (fwrite(data, 1, size, z->file) != size) z->failed = true;
}

/* Common fields of both headers of a file. */
static void put_common(zip *z, const struct zip_entry *e)
{
    put(z, VERSION, 2);
    put(z, UTF8, 2);
    put(z, DEFLATED, 2);
    put(z, 0, 2);
    put(z, MIDNIGHT_1980, 2);
    put(z, e->crc, 4);
    put(z, e->packed, 4);
    put(z, e->size, 4);
    put(z, strlen(e->name), 2);
    put(z, 0, 2); /* extra fields: none */
}

/* @return NULL: memory is exhausted */
static unsigned char *pack(const void *data, size_t size, unsigned long *packed)
{
    z_stream s = {.next_in = (Bytef *)data, .avail_in = (uInt)size};
    if (deflateInit2(&s, Z_BEST_COMPRESSION, Z_DEFLATED, RAW, 8, Z_DEFAULT_STRATEGY) != Z_OK)
        return NULL;
    const uLong most = deflateBound(&s, (uLong)size);
    unsigned char *out = malloc(most);
    s.next_out = out;
    s.avail_out = (uInt)most;
    const bool good = out && deflate(&s, Z_FINISH) == Z_STREAM_END;
    *packed = s.total_out;
    deflateEnd(&s);
    if (good) return out;
    free(out);
    return NULL;
}

void zip_add(zip *z, const char *name, const void *data, size_t size)
{
    if (z->failed || z->count == ZIP_FILES || strlen(name) >= sizeof z->entry->name) {
        z->failed = true;
        return;
    }
    struct zip_entry *e = &z->entry[z->count];
    snprintf(e->name, sizeof e->name, "%s", name);
    unsigned char *packed = pack(data, size, &e->packed);
    z->failed = !packed;
    if (!packed) return;
    e->crc = crc32(0, data, (uInt)size);
    e->size = (unsigned long)size;
    const long at = ftell(z->file);
    e->at = (unsigned long)at;
    z->failed = at < 0;
    put(z, LOCAL, 4);
    put_common(z, e);
    put_bytes(z, e->name, strlen(e->name));
    put_bytes(z, packed, e->packed);
    free(packed);
    z->count++;
}

void zip_end(zip *z)
{
    const long begin = ftell(z->file);
    for (int k = 0; k < z->count; k++) {
        const struct zip_entry *e = &z->entry[k];
        put(z, CENTRAL, 4);
        put(z, MADE_BY_UNIX | VERSION, 2);
        put_common(z, e);
        put(z, 0, 2);               /* comment: none */
        put(z, 0, 2);               /* disk */
        put(z, 0, 2);               /* internal attributes: no text */
        put(z, 0100644ul << 16, 4); /* mode: a regular file, readable by all */
        put(z, e->at, 4);
        put_bytes(z, e->name, strlen(e->name));
    }
    const long end = ftell(z->file);
    if (begin < 0 || end < 0) z->failed = true;
    put(z, END, 4);
    put(z, 0, 2);
    put(z, 0, 2);
    put(z, (unsigned long)z->count, 2);
    put(z, (unsigned long)z->count, 2);
    put(z, (unsigned long)(end - begin), 4);
    put(z, (unsigned long)begin, 4);
    put(z, 0, 2); /* comment: none */
}

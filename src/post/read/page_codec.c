/* SPDX-License-Identifier: BSD-3-Clause */
#include "page_codec.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

bool mps__codec_create(codec *c, int64_t count, int32_t dim, int32_t values, int32_t bits)
{
    const size_t n = count > 0 ? (size_t)count : 1;
    *c = (codec){.count = count, .dim = dim, .values = values, .bits = bits};
    c->last = calloc(n * (size_t)dim, sizeof *c->last);
    c->before = calloc(n * (size_t)dim, sizeof *c->before);
    c->value = calloc(n, (size_t)values);
    c->plane = malloc(n * (size_t)(2 * dim + values));
    return c->last && c->before && c->value && c->plane;
}

void mps__codec_free(codec *c)
{
    if (c->open) deflateEnd(&c->stream);
    free(c->last);
    free(c->before);
    free(c->value);
    free(c->plane);
    *c = (codec){0};
}

static bool reserve_bytes(codec_bytes *b, size_t more)
{
    if (b->capacity - b->size >= more) return true;
    size_t wanted = b->capacity + b->capacity / 2;
    if (wanted < b->size + more) wanted = b->size + more;
    unsigned char *data = realloc(b->data, wanted);
    if (!data) return false;
    b->data = data;
    b->capacity = wanted;
    return true;
}

/* Deflate until the input is consumed, with Z_FINISH to the end. */
static bool deflate_all(z_stream *s, int flush, codec_bytes *out)
{
    int status = Z_OK;
    do {
        if (!reserve_bytes(out, 1 << 14)) return false;
        const size_t remaining = out->capacity - out->size;
        const uInt most = remaining < 1 << 30 ? (uInt)remaining : 1 << 30;
        s->next_out = out->data + out->size;
        s->avail_out = most;
        status = deflate(s, flush);
        out->size += most - s->avail_out;
    } while (flush == Z_FINISH ? status != Z_STREAM_END : s->avail_in > 0 || s->avail_out == 0);
    return true;
}

/* Input may exceed an uInt. */
static bool deflate_block(z_stream *s, const unsigned char *data, size_t size, codec_bytes *out)
{
    while (size > 0) {
        const size_t part = size < 1 << 30 ? size : 1 << 30;
        s->next_in = (unsigned char *)(uintptr_t)data; /* zlib does not modify it */
        s->avail_in = (uInt)part;
        if (!deflate_all(s, Z_NO_FLUSH, out)) return false;
        data += part;
        size -= part;
    }
    return true;
}

/* Map 0, -1, 1, -2, 2 ... to 0, 1, 2, 3, 4: of a difference modulo 2^bits. */
static unsigned fold(unsigned difference, int32_t bits)
{
    const unsigned half = 1u << (bits - 1), all = 1u << bits;
    difference &= all - 1;
    return difference < half ? 2 * difference : 2 * (all - difference) - 1;
}

static void fill_coordinates(codec *c, int32_t d, const uint16_t *q)
{
    const int64_t n = c->count;
    uint16_t *last = c->last + d * n, *before = c->before + d * n;
    unsigned char *low = c->plane + d * n, *high = c->plane + (c->dim + d) * n;
    for (int64_t i = 0; i < n; i++) {
        const unsigned predicted = c->frames > 1 ? 2u * last[i] - before[i]
                                                 : (c->frames ? last[i] : 0u);
        const unsigned u = fold(q[i] - predicted, c->bits);
        low[i] = (unsigned char)(u & 255);
        high[i] = (unsigned char)(u >> 8);
        before[i] = last[i];
        last[i] = q[i];
    }
}

bool mps__codec_frame(codec *c, const uint16_t *q, const unsigned char *value, codec_bytes *out)
{
    const int64_t n = c->count;
    if (!c->open) {
        c->stream = (z_stream){0};
        if (deflateInit(&c->stream, CODEC_LEVEL) != Z_OK) return false;
        c->open = true;
    }
    for (int32_t d = 0; d < c->dim; d++) fill_coordinates(c, d, q + d * n);
    unsigned char *plane = c->plane + 2 * c->dim * n;
    for (int64_t i = 0; i < c->values * n; i++) {
        plane[i] = (unsigned char)(value[i] - c->value[i]);
        c->value[i] = value[i];
    }
    c->frames++;
    return deflate_block(&c->stream, c->plane, (size_t)n * (size_t)(2 * c->dim + c->values), out);
}

bool mps__codec_end(codec *c, codec_bytes *out)
{
    if (!c->open) return true;
    c->stream.avail_in = 0;
    const bool done = deflate_all(&c->stream, Z_FINISH, out);
    deflateEnd(&c->stream);
    c->open = false;
    return done;
}

bool mps__codec_pack(const void *data, size_t size, codec_bytes *out)
{
    z_stream s = {0};
    if (deflateInit(&s, CODEC_LEVEL) != Z_OK) return false;
    bool done = deflate_block(&s, data, size, out);
    s.avail_in = 0;
    done = done && deflate_all(&s, Z_FINISH, out);
    deflateEnd(&s);
    return done;
}

bool mps__codec_curve(const double *value, int64_t count, int64_t stride, double lo, double hi,
                      codec_bytes *out)
{
    const size_t n = count > 0 ? (size_t)count : 1;
    unsigned char *plane = malloc(2 * n);
    uint16_t last = 0;
    if (!plane) return false;
    for (int64_t i = 0; i < count; i++) {
        const double v = value[i * stride], share = hi > lo ? (v - lo) / (hi - lo) : 0;
        const double code = isfinite(v) ? fmin(fmax(share, 0), 1) * 65534 + 0.5 : 65535;
        const uint16_t now = (uint16_t)code, difference = (uint16_t)(now - last);
        plane[i] = (unsigned char)(difference & 255);
        plane[count + i] = (unsigned char)(difference >> 8);
        last = now;
    }
    const bool done = mps__codec_pack(plane, 2 * (size_t)count, out);
    free(plane);
    return done;
}

void mps__codec_base64(FILE *out, const codec_bytes *bytes)
{
    static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char line[4 * 1024] = "";
    size_t used = 0;
    for (size_t i = 0; i < bytes->size; i += 3) {
        const size_t left = bytes->size - i;
        const unsigned char *d = bytes->data + i;
        const unsigned v = (unsigned)d[0] << 16 | (left > 1 ? (unsigned)d[1] << 8 : 0) |
                           (left > 2 ? d[2] : 0u);
        line[used++] = digit[v >> 18 & 63];
        line[used++] = digit[v >> 12 & 63];
        line[used++] = left > 1 ? digit[v >> 6 & 63] : '=';
        line[used++] = left > 2 ? digit[v & 63] : '=';
        if (used == sizeof line) {
            fwrite(line, 1, used, out);
            used = 0;
        }
    }
    fwrite(line, 1, used, out);
}

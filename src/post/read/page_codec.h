/* SPDX-License-Identifier: BSD-3-Clause */
/* Packs particles and curves: differences from a prediction, byte planes, deflate, base64.
 * decode.js unpacks them. */
#ifndef MPS_POST_PAGE_CODEC_H
#define MPS_POST_PAGE_CODEC_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <zlib.h>

/* A growing array of packed bytes. */
typedef struct codec_bytes {
    unsigned char *data;
    size_t size, capacity;
} codec_bytes;

/* Particles of a film, frame by frame. A coordinate is an integer of `bits` bits, predicted from
 * the last two frames: 2 x - x before. A frame in a block has one plane of [count] bytes each: low
 * bytes of x, y (, z); high bytes of x, y (, z); pressure; speed (; pocket). All are differences:
 * coordinates from the prediction, modulo 2^bits, with small ones of either sign mapped to small
 * numbers; values from the frame before. */
typedef struct codec {
    int64_t count;
    int32_t dim, values, bits;
    int64_t frames;          /* so far */
    uint16_t *last, *before; /* [dim*count], plane by plane */
    unsigned char *value;    /* [values*count] of the last frame */
    unsigned char *plane;    /* [(2*dim + values)*count] */
    z_stream stream;
    bool open; /* a block has begun */
} codec;

/* Compression level of deflate. */
enum { CODEC_LEVEL = 6 };

/* @return false: memory is exhausted; codec_free() is still valid */
bool mps__codec_create(codec *c, int64_t count, int32_t dim, int32_t values, int32_t bits);
void mps__codec_free(codec *c);
/* Append a frame to the open block, or begin one.
 * @param q      [dim*count], plane by plane, below 2^bits
 * @param value  [values*count], pressures, then speeds, then others
 * @return false: memory is exhausted */
bool mps__codec_frame(codec *c, const uint16_t *q, const unsigned char *value, codec_bytes *out);
/* End the block. @return false: memory is exhausted */
bool mps__codec_end(codec *c, codec_bytes *out);

/* Deflate a whole array. @return false: memory is exhausted */
bool mps__codec_pack(const void *data, size_t size, codec_bytes *out);
/* Pack a curve: 16 bits a value, over the range from lo to hi; 65535 is NAN. Differences modulo
 * 65536, all low bytes, then all high bytes. */
bool mps__codec_curve(const double *value, int64_t count, int64_t stride, double lo, double hi,
                      codec_bytes *out);
void mps__codec_base64(FILE *out, const codec_bytes *bytes);

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* Edit a checkpoint in memory and recompute its checksums, so that a reader gets wrong numbers
 * instead of a damaged file. Needs "archive.h". */
#ifndef CHECKPOINT_EDITOR_H
#define CHECKPOINT_EDITOR_H

#include "archive.h"
#include <string.h>

enum { EDITOR_HEAD = 16, EDITOR_PART = MPS__PART_TITLE + 16 };

/* One part of a file. */
typedef struct editor_part {
    unsigned char *at; /* its title; the elements follow after EDITOR_PART bytes */
    unsigned char *elements;
    uint32_t bytes; /* of an element */
    int64_t count;
    size_t used, capacity; /* bytes of the elements, without and with the zeros behind them */
} editor_part;

/* The section at an offset; 0 if none is within `size`. */
static inline int editor_part_at(unsigned char *file, size_t size, size_t at, editor_part *p)
{
    if (at > size || size - at < EDITOR_PART) return 0;
    p->at = file + at;
    p->elements = p->at + EDITOR_PART;
    memcpy(&p->bytes, p->at + MPS__PART_TITLE, sizeof p->bytes);
    memcpy(&p->count, p->at + MPS__PART_TITLE + 8, sizeof p->count);
    const size_t left = size - at - EDITOR_PART;
    if (p->count < 0 || p->bytes == 0 || (uint64_t)p->count > left / p->bytes) return 0;
    p->used = (size_t)p->count * p->bytes;
    p->capacity = (p->used + 7) / 8 * 8;
    return p->capacity <= left && memchr(p->at, 0, MPS__PART_TITLE) != NULL;
}

/* The section with a name; 0 if it does not exist. */
static inline int editor_find(unsigned char *file, size_t size, const char *name, editor_part *p)
{
    for (size_t at = EDITOR_HEAD; editor_part_at(file, size, at, p);
         at += EDITOR_PART + p->capacity)
        if (strcmp((const char *)p->at, name) == 0) return 1;
    return 0;
}

/* Write `bytes` bytes at an offset into the elements of a section; 0 if it does not exist. */
static inline int editor_put(unsigned char *file, size_t size, const char *name, size_t offset,
                             const void *value, size_t bytes)
{
    editor_part p;
    if (!editor_find(file, size, name, &p) || p.used < bytes || offset > p.used - bytes) return 0;
    memcpy(p.elements + offset, value, bytes);
    return 1;
}

/* Right checksums, and zeros behind the elements, for all parts that are whole. */
static inline void editor_repair(unsigned char *file, size_t size)
{
    editor_part p;
    for (size_t at = EDITOR_HEAD; editor_part_at(file, size, at, &p);
         at += EDITOR_PART + p.capacity) {
        uint32_t checksum = 0;
        memset(p.elements + p.used, 0, p.capacity - p.used);
        memcpy(p.at + MPS__PART_TITLE + 4, &checksum, sizeof checksum);
        checksum = mps__checksum(0, p.at, EDITOR_PART + p.used);
        memcpy(p.at + MPS__PART_TITLE + 4, &checksum, sizeof checksum);
    }
}

#endif

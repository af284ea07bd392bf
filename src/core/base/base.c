/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory, errors, log, names. */
#define _POSIX_C_SOURCE 200809L
#include "base.h"
#include "words.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static void *default_alloc(void *user, size_t size)
{
    (void)user;
    return malloc(size);
}

static void default_release(void *user, void *block)
{
    (void)user;
    free(block);
}

mps_allocator mps__allocator_default(void)
{
    return (mps_allocator){default_alloc, default_release, NULL};
}

void *mps__alloc(mps__context *c, int64_t count, size_t size)
{
    if (count < 1) count = 1;
    void *block = NULL;
    if ((uint64_t)count <= SIZE_MAX / size)
        block = c->allocator.alloc(c->allocator.user, (size_t)count * size);
    if (block)
        memset(block, 0, (size_t)count * size);
    else
        mps__fail(c, MPS_E_NOMEM, "no memory for %lld elements of %zu bytes", (long long)count,
                  size);
    return block;
}

void mps__free(mps__context *c, void *block)
{
    if (block) c->allocator.release(c->allocator.user, block);
}

mps_status mps__grow(mps__context *c, void **block, int64_t *capacity, int64_t used, int64_t count,
                     size_t size)
{
    if (count <= *capacity) return MPS_OK;
    /* grow by half, so that appending takes linear time */
    int64_t wanted = count + (used > 0 ? count / 2 : 0);
    void *larger = mps__alloc(c, wanted, size);
    if (!larger) return MPS_E_NOMEM;
    if (used > 0) memcpy(larger, *block, (size_t)used * size);
    mps__free(c, *block);
    *block = larger;
    *capacity = wanted;
    return MPS_OK;
}

void *mps__scratch_take(mps__context *c, mps__scratch *s, int32_t block, int64_t count, size_t size)
{
    if (s->block[block] && (uint64_t)count <= s->bytes[block] / size) return s->block[block];
    mps__free(c, s->block[block]);
    s->bytes[block] = 0;
    s->block[block] = mps__alloc(c, count + count / 32, size);
    if (s->block[block]) s->bytes[block] = (size_t)(count + count / 32) * size;
    return s->block[block];
}

void mps__scratch_free(mps__context *c, mps__scratch *s)
{
    for (int k = 0; k < MPS__SCRATCH; k++) mps__free(c, s->block[k]);
    *s = (mps__scratch){{NULL}, {0}};
}

mps_status mps__fail(mps__context *c, mps_status status, const char *format, ...)
{
    /* the arguments may point to the previous error text */
    char text[MPS__ERROR_SIZE];
    va_list list;
    if (!c) return status;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    memcpy(c->error, text, sizeof text);
    return status;
}

mps__lock mps__lock_set(mps__context *c, int32_t level, const char *what)
{
    const mps__lock before = c->lock;
    if (level >= before.level) c->lock = (mps__lock){level, what};
    return before;
}

void mps__log(mps__context *c, int level, const char *format, ...)
{
    if (!c->log || c->logs) return; /* a log callback must not log: endless recursion */
    char text[MPS__ERROR_SIZE];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    c->logs = true;
    const mps__lock before = mps__lock_set(c, MPS__LOCKED, "a log callback");
    c->log(c->log_user, level, text);
    c->lock = before;
    c->logs = false;
}

const char *mps__near(const char *name, const char *const *names, int count)
{
    const char *best = NULL;
    /* near: at most one error, plus one for every four letters */
    size_t least = 2 + strnlen(name, MPS__ERROR_SIZE) / 4;
    for (int k = 0; k < count; k++) {
        const size_t d = mps__word_distance(name, names[k]);
        if (d < least) {
            least = d;
            best = names[k];
        }
    }
    return best;
}

const char *mps__list(char out[MPS__HINT_SIZE], char quote, const char *const *names, int count)
{
    size_t used = 0;
    out[0] = 0;
    for (int k = 0; k < count; k++) {
        const size_t left = MPS__HINT_SIZE - used;
        const int length = snprintf(out + used, left, "%s%c%s%c", k ? ", " : "", quote, names[k],
                                    quote);
        if (length < 0 || (size_t)length >= left) {
            out[used] = 0; /* no truncated names */
            break;
        }
        used += (size_t)length;
    }
    return out;
}

const char *mps__hint(char out[MPS__HINT_SIZE], char quote, const char *name,
                      const char *const *names, int count)
{
    char list[MPS__HINT_SIZE];
    const char *near = mps__near(name, names, count);
    if (near)
        snprintf(out, MPS__HINT_SIZE, "did you mean %c%s%c?", quote, near, quote);
    else
        snprintf(out, MPS__HINT_SIZE, "there %s %.370s", count > 1 ? "are" : "is",
                 count > 0 ? mps__list(list, quote, names, count) : "none");
    return out;
}

bool mps__name_copy(char *out, size_t capacity, const char *name)
{
    size_t length = name ? strnlen(name, capacity) : 0;
    if (length == 0 || length == capacity) return false;
    memcpy(out, name, length + 1);
    return true;
}

bool mps__finite(const double *values, int64_t count)
{
    /* one NaN or infinity makes 0 * sum NaN; no branch in the loop */
    double sum = 0;
    for (int64_t k = 0; k < count; k++) sum += 0.0 * values[k];
    return sum == 0.0;
}

double mps__clock(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* SPDX-License-Identifier: BSD-3-Clause */
#include "grow.h"
#include <stdlib.h>

enum { FIRST = 16 };

/* The capacity is 16, 32, 64 and so on. */
void *mps__grown(void *array, int64_t count, size_t size)
{
    const uint64_t used = (uint64_t)count, capacity = used ? 2 * used : FIRST;
    if (array && (used < FIRST || (used & (used - 1)) != 0)) return array;
    return capacity <= SIZE_MAX / size ? realloc(array, (size_t)capacity * size) : NULL;
}

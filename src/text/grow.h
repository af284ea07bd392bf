/* SPDX-License-Identifier: BSD-3-Clause */
/* Arrays that elements are appended to, one by one. */
#ifndef MPS_TEXT_GROW_H
#define MPS_TEXT_GROW_H

#include <stddef.h>
#include <stdint.h>

/* Reserve memory for one more element of an array that was reserved by this function alone; its
 * capacity follows from the number of its elements.
 * @param array  NULL where `count` is 0 @param size  bytes of an element
 * @return the array, which may have moved; NULL: out of memory, and `array` is still valid */
void *mps__grown(void *array, int64_t count, size_t size);

#endif

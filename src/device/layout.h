/* SPDX-License-Identifier: BSD-3-Clause */
/* Hosts pass structs to kernels as bytes. These assertions hold in both compilers, so that both use
 * the same layout; no such struct has bit-fields or long doubles. */
#ifndef MPS_DEVICE_LAYOUT_H
#define MPS_DEVICE_LAYOUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define MPS__LAYOUT(type, bytes)                               \
    _Static_assert(sizeof(type) == (bytes), "size of " #type); \
    _Static_assert(_Alignof(type) == (bytes), "alignment of " #type)
MPS__LAYOUT(bool, 1);
MPS__LAYOUT(char, 1);
MPS__LAYOUT(short, 2);
MPS__LAYOUT(int, 4);
MPS__LAYOUT(long, 8);
MPS__LAYOUT(int64_t, 8);
MPS__LAYOUT(size_t, 8);
MPS__LAYOUT(float, 4);
MPS__LAYOUT(double, 8);
MPS__LAYOUT(void *, 8);
enum mps__any_enum { MPS__AN_ENUM };
MPS__LAYOUT(enum mps__any_enum, 4);
#undef MPS__LAYOUT

#endif

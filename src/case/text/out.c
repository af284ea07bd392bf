/* SPDX-License-Identifier: BSD-3-Clause */
/* Formats text into a buffer. */
#include "out.h"
#include <stdarg.h>
#include <stdio.h>

mps__out mps__out_begin(char *buffer, size_t size)
{
    const mps__out o = {buffer, buffer ? size : 0, 0};
    if (o.size > 0) buffer[0] = '\0';
    return o;
}

void mps__out_put(mps__out *o, const char *format, ...)
{
    va_list list;
    const size_t remaining = o->length < o->size ? o->size - o->length : 0;
    va_start(list, format);
    const int more = vsnprintf(remaining ? o->buffer + o->length : NULL, remaining, format, list);
    va_end(list);
    if (more > 0) o->length += (size_t)more;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* The only file that replaces the locale of the calling thread. */
#include "plain.h"
#undef vsnprintf
#undef vfprintf
#undef strtod
#include <errno.h>
#include <locale.h>
#include <stdint.h>
#include <stdlib.h>

/* glibc and musl have this locale built in: it needs no memory. */
static locale_t begin(locale_t *before)
{
    const locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (c)
        *before = uselocale(c);
    else
        errno = ENOMEM;
    return c;
}

static void end(locale_t c, locale_t before)
{
    const int error = errno;
    uselocale(before);
    freelocale(c);
    errno = error;
}

int mps__vsnprintf(char *buffer, size_t size, const char *format, va_list list)
{
    locale_t before;
    const locale_t c = begin(&before);
    if (!c) {
        if (size > 0) buffer[0] = '\0';
        return -1;
    }
    const int length = vsnprintf(buffer, size, format, list);
    end(c, before);
    return length;
}

int mps__snprintf(char *buffer, size_t size, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    const int length = mps__vsnprintf(buffer, size, format, list);
    va_end(list);
    return length;
}

int mps__vfprintf(FILE *file, const char *format, va_list list)
{
    locale_t before;
    const locale_t c = begin(&before);
    if (!c) return -1;
    const int length = vfprintf(file, format, list);
    end(c, before);
    return length;
}

int mps__fprintf(FILE *file, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    const int length = mps__vfprintf(file, format, list);
    va_end(list);
    return length;
}

int mps__printf(const char *format, ...)
{
    va_list list;
    va_start(list, format);
    const int length = mps__vfprintf(stdout, format, list);
    va_end(list);
    return length;
}

int mps__sscanf(const char *text, const char *format, ...)
{
    locale_t before;
    va_list list;
    const locale_t c = begin(&before);
    if (!c) return EOF;
    va_start(list, format);
    const int count = vsscanf(text, format, list);
    va_end(list);
    end(c, before);
    return count;
}

double mps__strtod(const char *text, char **stop)
{
    locale_t before;
    const locale_t c = begin(&before);
    if (!c) {
        if (stop) *stop = (char *)(uintptr_t)text;
        return 0;
    }
    const double value = strtod(text, stop);
    end(c, before);
    return value;
}

int mps__lower(int c)
{
    return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c;
}

int mps__upper(int c)
{
    return c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c;
}

int mps__is_digit(int c)
{
    return c >= '0' && c <= '9';
}

int mps__is_letter(int c)
{
    return mps__lower(c) >= 'a' && mps__lower(c) <= 'z';
}

int mps__is_blank(int c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

int mps__compare_letters(const char *a, const char *b, size_t most)
{
    size_t i = 0;
    while (i < most && a[i] && mps__lower((unsigned char)a[i]) == mps__lower((unsigned char)b[i]))
        i++;
    return i < most ? mps__lower((unsigned char)a[i]) - mps__lower((unsigned char)b[i]) : 0;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers and letters as in the locale "C", independent of setlocale() of the application: "1.5",
 * never "1,5". The build includes this header before each source file of libmps and libmps_case:
 * printf(), strtod() and the functions of letters are then those below. plain.c replaces the locale
 * during a single call and in the calling thread only; the locale of the application and of its
 * callbacks stays unchanged. */
#ifndef MPS_TEXT_PLAIN_H
#define MPS_TEXT_PLAIN_H

#include <ctype.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <strings.h>

/* As the functions of C. If the locale "C" is not available: -1 with errno ENOMEM, and an empty
 * text. */
int mps__vsnprintf(char *buffer, size_t size, const char *format, va_list list)
    __attribute__((format(printf, 3, 0)));
int mps__snprintf(char *buffer, size_t size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
int mps__vfprintf(FILE *file, const char *format, va_list list)
    __attribute__((format(printf, 2, 0)));
int mps__fprintf(FILE *file, const char *format, ...) __attribute__((format(printf, 2, 3)));
int mps__printf(const char *format, ...) __attribute__((format(printf, 1, 2)));
int mps__sscanf(const char *text, const char *format, ...) __attribute__((format(scanf, 2, 3)));
/* As strtod(). If the locale "C" is not available: 0, *end is `text`. */
double mps__strtod(const char *text, char **end);

/* ASCII letters, digits and blanks; other bytes are none of them. */
int mps__lower(int c);
int mps__upper(int c);
int mps__is_digit(int c);
int mps__is_letter(int c);
int mps__is_blank(int c);
/* As strcasecmp(): 'I' and 'i' are equal, in a Turkish locale too. */
int mps__compare_letters(const char *a, const char *b, size_t most);

#undef vsnprintf
#undef snprintf
#undef vfprintf
#undef fprintf
#undef printf
#undef sscanf
#undef tolower
#undef toupper
#undef isdigit
#undef isalpha
#undef isspace
#undef isalnum
#define vsnprintf            mps__vsnprintf
#define snprintf             mps__snprintf
#define vfprintf             mps__vfprintf
#define fprintf              mps__fprintf
#define printf(...)          mps__printf(__VA_ARGS__) /* except in an attribute */
#define sscanf               mps__sscanf
#define strtod               mps__strtod
#define tolower              mps__lower
#define toupper              mps__upper
#define isdigit              mps__is_digit
#define isalpha              mps__is_letter
#define isspace              mps__is_blank
#define isalnum(c)           (mps__is_letter(c) || mps__is_digit(c))
#define strcasecmp(a, b)     mps__compare_letters(a, b, SIZE_MAX)
#define strncasecmp(a, b, n) mps__compare_letters(a, b, n)

#endif

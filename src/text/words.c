/* SPDX-License-Identifier: BSD-3-Clause */
#include "words.h"
#include <string.h>

enum { WORD_MOST = 64 };

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Three rows of the matrix of distances between the first letters of a and of b. */
size_t mps__word_distance(const char *a, const char *b)
{
    const size_t n = strlen(a), m = strlen(b);
    size_t rows[3][WORD_MOST + 1], *before = rows[0], *last = rows[1], *now = rows[2];
    if (n > WORD_MOST || m > WORD_MOST) return n > m ? n : m;
    for (size_t j = 0; j <= m; j++) now[j] = last[j] = j;
    for (size_t i = 1; i <= n; i++) {
        size_t *spare = before;
        before = last;
        last = now;
        now = spare;
        now[0] = i;
        for (size_t j = 1; j <= m; j++) {
            now[j] = smaller(smaller(now[j - 1], last[j]) + 1,
                             last[j - 1] + (a[i - 1] != b[j - 1]));
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                now[j] = smaller(now[j], before[j - 2] + 1);
        }
    }
    return now[m];
}

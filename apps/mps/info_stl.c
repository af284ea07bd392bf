/* SPDX-License-Identifier: BSD-3-Clause */
/* mps info of a surface of triangles: where it is, and whether it is closed. */
#include "grow.h"
#include "info.h"
#include <ctype.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { BINARY_HEAD = 84, RECORD = 50 };

/* Corners of the triangles, three numbers each. */
typedef struct surface {
    int64_t corners;
    float *x;
    bool no_memory;
} surface;

static void add_corner(surface *s, const float x[3])
{
    float *grown = mps__grown(s->x, s->corners, 3 * sizeof *grown);
    s->no_memory = s->no_memory || !grown;
    if (!grown) return;
    s->x = grown;
    for (int d = 0; d < 3; d++) s->x[3 * s->corners + d] = x[d] + 0.0f; /* -0 is 0 */
    s->corners++;
}

static void read_binary(FILE *file, uint32_t count, surface *s)
{
    unsigned char record[RECORD];
    float x[9];
    if (fseek(file, BINARY_HEAD, SEEK_SET) != 0) return;
    for (uint32_t k = 0; k < count && !s->no_memory; k++) {
        if (fread(record, 1, RECORD, file) != RECORD) return;
        memcpy(x, record + 12, sizeof x);
        for (int i = 0; i < 3; i++) add_corner(s, x + 3 * i);
    }
}

/* A word up to the next blank. @return false: end of file */
static bool next_word(FILE *file, char out[64])
{
    int c, length = 0;
    while ((c = fgetc(file)) != EOF && isspace(c)) {
    }
    for (; c != EOF && !isspace(c); c = fgetc(file))
        if (length < 63) out[length++] = (char)c;
    out[length] = '\0';
    return length > 0;
}

static void read_text(FILE *file, surface *s)
{
    char word[64];
    float x[3];
    rewind(file);
    while (!s->no_memory && next_word(file, word)) {
        if (strcasecmp(word, "vertex") != 0) continue;
        for (int d = 0; d < 3 && next_word(file, word); d++) x[d] = strtof(word, NULL);
        add_corner(s, x);
    }
}

/* ---- edges ---- */

/* An edge between two corners, the smaller index first. */
typedef struct edge {
    float x[6];
} edge;

static int by_place(const void *a, const void *b)
{
    const float *p = a, *q = b;
    for (int k = 0; k < 6; k++)
        if (p[k] != q[k]) return p[k] < q[k] ? -1 : 1;
    return 0;
}

/* Number of edges that do not belong to exactly two triangles; -1: memory is exhausted. */
static int64_t count_open(const surface *s)
{
    edge *all = malloc((size_t)(s->corners > 0 ? s->corners : 1) * sizeof *all);
    int64_t count = 0, open = 0;
    if (!all) return -1;
    for (int64_t k = 0; k + 2 < s->corners; k += 3)
        for (int i = 0; i < 3; i++) {
            const float *a = s->x + 3 * (k + i), *b = s->x + 3 * (k + (i + 1) % 3);
            float pair[2][6];
            memcpy(pair[0], a, 3 * sizeof *a);
            memcpy(pair[0] + 3, b, 3 * sizeof *b);
            memcpy(pair[1], b, 3 * sizeof *b);
            memcpy(pair[1] + 3, a, 3 * sizeof *a);
            memcpy(all[count++].x, pair[by_place(pair[0], pair[1]) > 0], sizeof pair[0]);
        }
    qsort(all, (size_t)count, sizeof *all, by_place);
    for (int64_t k = 0, same; k < count; k += same) {
        for (same = 1; k + same < count && by_place(all[k].x, all[k + same].x) == 0; same++) {
        }
        open += same != 2;
    }
    free(all);
    return open;
}

/* By the divergence theorem; its sign is the direction of the normals. */
static double volume_of(const surface *s)
{
    double sum = 0;
    for (int64_t k = 0; k + 2 < s->corners; k += 3) {
        const float *a = s->x + 3 * k, *b = a + 3, *c = b + 3;
        sum += (double)a[0] * ((double)b[1] * c[2] - (double)b[2] * c[1]) +
               (double)a[1] * ((double)b[2] * c[0] - (double)b[0] * c[2]) +
               (double)a[2] * ((double)b[0] * c[1] - (double)b[1] * c[0]);
    }
    return sum / 6;
}

static void print_surface(const surface *s)
{
    double lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int64_t k = 0; k < s->corners; k++)
        for (int d = 0; d < 3; d++) {
            lo[d] = fmin(lo[d], s->x[3 * k + d]);
            hi[d] = fmax(hi[d], s->x[3 * k + d]);
        }
    if (s->corners == 0) return;
    for (int d = 0; d < 3; d++)
        printf("  %c %.7g .. %.7g, size %.7g\n", "xyz"[d], lo[d], hi[d], hi[d] - lo[d]);
    printf("  in the unit of the file\n");
    const int64_t open = count_open(s);
    const double volume = volume_of(s);
    if (open == 0)
        printf("  closed: each edge belongs to two triangles; volume %.7g%s\n", fabs(volume),
               volume < 0 ? ", normals point inwards" : "");
    else if (open > 0)
        printf("  open: %lld edges do not belong to two triangles\n", (long long)open);
}

bool info_surface(const head *h)
{
    surface s = {0};
    uint32_t count = 0;
    bool text = is_text(h), facet = false;
    for (size_t i = 0; i + 5 <= h->count && text && !facet; i++)
        facet = strncasecmp(h->text + i, "facet", 5) == 0;
    if (h->count >= BINARY_HEAD) memcpy(&count, h->text + 80, sizeof count);
    if (text ? !facet : h->count < BINARY_HEAD || h->size < BINARY_HEAD + (long long)RECORD * count)
        return false;
    if (!text && (count == 0 || h->size > BINARY_HEAD + (long long)RECORD * count + TAIL))
        return false;
    if (text)
        read_text(h->file, &s);
    else
        read_binary(h->file, count, &s);
    printf("surface of triangles, %s STL, %lld triangles, %lld bytes\n", text ? "ASCII" : "binary",
           (long long)(s.corners / 3), h->size);
    if (!s.no_memory) print_surface(&s);
    free(s.x);
    return true;
}

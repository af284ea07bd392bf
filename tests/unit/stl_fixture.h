/* SPDX-License-Identifier: BSD-3-Clause */
/* Surfaces of triangles, and STL files of them in a folder of their own. */
#ifndef MPS_TEST_STL_FIXTURE_H
#define MPS_TEST_STL_FIXTURE_H

#include "mesh.h"
#include "sim.h"
#include "tank_fixture.h"
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static char folder[] = "mps_stl_XXXXXX", path[64];

enum { MOST = 4096 };

typedef struct triangles {
    int count;
    float x[MOST][9];
} triangles;

static inline void add_triangle(triangles *t, const double *a, const double *b, const double *c)
{
    assert_true(t->count < MOST);
    for (int d = 0; d < 3; d++) {
        t->x[t->count][d] = (float)a[d];
        t->x[t->count][3 + d] = (float)b[d];
        t->x[t->count][6 + d] = (float)c[d];
    }
    t->count++;
}

/* Box 0..2 x 0..1.2 x 0..1.6, normals outward. */
static inline triangles box_mesh(void)
{
    static const int face[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                   {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    triangles t = {0};
    double p[8][3];
    for (int k = 0; k < 8; k++) {
        p[k][0] = k & 1 ? 2 : 0;
        p[k][1] = k & 2 ? 1.2 : 0;
        p[k][2] = k & 4 ? 1.6 : 0;
    }
    for (int f = 0; f < 6; f++) {
        add_triangle(&t, p[face[f][0]], p[face[f][1]], p[face[f][2]]);
        add_triangle(&t, p[face[f][0]], p[face[f][2]], p[face[f][3]]);
    }
    return t;
}

/* A unit sphere about (1, 1, 1), n by 2 n faces. */
static inline void sphere_point(int n, int i, int j, double x[3])
{
    const double pi = 3.14159265358979323846, a = pi * i / n, b = pi * (j % (2 * n)) / n;
    x[0] = 1 + (i % n ? sin(a) * cos(b) : 0);
    x[1] = 1 + (i % n ? cos(a) : i ? -1 : 1);
    x[2] = 1 + (i % n ? sin(a) * sin(b) : 0);
}

static inline triangles sphere_mesh(int n)
{
    triangles t = {0};
    for (int i = 0; i < n; i++)
        for (int j = 0; j < 2 * n; j++) {
            double p[4][3];
            sphere_point(n, i, j, p[0]);
            sphere_point(n, i + 1, j, p[1]);
            sphere_point(n, i + 1, j + 1, p[2]);
            sphere_point(n, i, j + 1, p[3]);
            if (i + 1 < n) add_triangle(&t, p[0], p[2], p[1]);
            if (i > 0) add_triangle(&t, p[0], p[3], p[2]);
        }
    return t;
}

static inline void write_bytes(const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

/* @return size; the caller frees *bytes */
static inline size_t binary_of(const triangles *t, unsigned char **bytes)
{
    const size_t size = 84 + 50 * (size_t)t->count;
    *bytes = calloc(size, 1);
    assert_non_null(*bytes);
    memcpy(*bytes, "solid, but binary", 17);
    for (int k = 0; k < 4; k++) (*bytes)[80 + k] = (unsigned char)(t->count >> 8 * k);
    for (int i = 0; i < t->count; i++) memcpy(*bytes + 84 + 50 * i + 12, t->x[i], sizeof t->x[i]);
    return size;
}

static inline void write_binary(const triangles *t)
{
    unsigned char *bytes;
    const size_t size = binary_of(t, &bytes);
    write_bytes(bytes, size);
    free(bytes);
}

static inline int make_folder(void **state)
{
    (void)state;
    if (!mkdtemp(folder)) return 1;
    snprintf(path, sizeof path, "%s/tank.stl", folder);
    return 0;
}

static inline int remove_folder(void **state)
{
    (void)state;
    unlink(path);
    return rmdir(folder);
}

#endif

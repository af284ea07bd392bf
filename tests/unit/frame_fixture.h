/* SPDX-License-Identifier: BSD-3-Clause */
/* A small parser of frames, and a simulation that writes them, shared by their tests. */
#ifndef FRAME_FIXTURE_H
#define FRAME_FIXTURE_H

#include "sim.h"
#include "tank_fixture.h"
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static char folder[64];

static inline int make_folder(void **state)
{
    (void)state;
    strcpy(folder, "mps_frames_XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static inline int remove_folder(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

/* A whole file with a zero behind it; the caller frees it. */
static inline char *slurp(const char *name, size_t *size)
{
    char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "rb");
    if (!f) fail_msg("no file %s", path);
    fseek(f, 0, SEEK_END);
    long length = ftell(f);
    rewind(f);
    char *text = malloc((size_t)length + 1);
    assert_int_equal(fread(text, 1, (size_t)length, f), length);
    fclose(f);
    text[length] = 0;
    *size = (size_t)length;
    return text;
}

/* Where the data of the array `name` begins; checks type, components and size. */
static inline const char *find_array(const char *text, size_t size, const char *name,
                                     const char *type, int components, uint64_t bytes)
{
    char tag[160];
    uint64_t written;
    unsigned long long offset;
    snprintf(tag, sizeof tag,
             "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"appended\" "
             "offset=\"",
             type, name, components);
    const char *at = strstr(text, tag), *data = strstr(text, "<AppendedData encoding=\"raw\">\n_");
    if (!at) fail_msg("no %s", tag);
    assert_non_null(data);
    data += strlen("<AppendedData encoding=\"raw\">\n_");
    assert_int_equal(sscanf(at + strlen(tag), "%llu", &offset), 1);
    memcpy(&written, data + offset, sizeof written);
    assert_int_equal(written, bytes);
    assert_true((size_t)(data - text) + offset + sizeof written + bytes <= size);
    return data + offset + sizeof written;
}

static inline void fill_fields(mps_sim *sim)
{
    const char *const names[6] = {"velocity",   "pressure", "density",
                                  "my \"<&>\"", "arm",      "wall_pressure"};
    for (int f = 0; f < 6; f++) {
        mps_lease lease = {.struct_size = sizeof lease};
        ASSERT_OK(sim, mps_lease_begin(sim, names[f], MPS_WRITE, &lease));
        for (int64_t k = 0; k < lease.count * lease.stride; k++)
            lease.data[k] = 0.1 * (f + 1) + (double)k;
        ASSERT_OK(sim, mps_lease_end(sim, &lease));
    }
}

static inline mps_sim *prepared(int32_t dim)
{
    mps_sim *sim = new_sim(dim, 0.1);
    add_tank(sim, 0.6, 0.5, 0.4);
    fill_depth(sim, 0.6, 0.2, 0.4);
    ASSERT_OK(sim, mps_field_add(sim, "my \"<&>\"", 1));
    ASSERT_OK(sim, mps_field_add(sim, "arm", dim));
    fill_fields(sim);
    return sim;
}

static inline void check_frame(const mps_sim *sim, const char *name, int32_t kinds)
{
    const mps__particles *s = &sim->world.particles;
    size_t size;
    char *text = slurp(name, &size);
    uint64_t n = 0;
    for (int64_t i = 0; i < s->n; i++) n += (uint64_t)(kinds >> s->kind[i] & 1);
    const char *x = find_array(text, size, "position", "Float32", 3, n * 12),
               *u = find_array(text, size, "velocity", "Float32", 3, n * 12);
    const char *p = find_array(text, size, "pressure", "Float32", 1, n * 4),
               *load = find_array(text, size, "wall_pressure", "Float32", 1, n * 4),
               *part = find_array(text, size, "part", "Int32", 1, n * 4),
               *id = find_array(text, size, "id", "Int64", 1, n * 8);
    const char *kind = find_array(text, size, "kind", "UInt8", 1, n),
               *arm = find_array(text, size, "arm", "Float64", 3, n * 24);
    const char *cell = find_array(text, size, "connectivity", "Int32", 1, n * 4),
               *end = find_array(text, size, "offsets", "Int32", 1, n * 4);
    char verts[48];
    snprintf(verts, sizeof verts, "NumberOfVerts=\"%llu\"", (unsigned long long)n);
    assert_non_null(strstr(text, verts));
    find_array(text, size, "number_density", "Float32", 1, n * 4);
    find_array(text, size, "density", "Float32", 1, n * 4);
    find_array(text, size, "phase", "UInt8", 1, n);
    find_array(text, size, "my &quot;&lt;&amp;&gt;&quot;", "Float64", 1, n * 8);
    int64_t k = 0, got;
    for (int64_t i = 0; i < s->n; i++) {
        if (!(kinds >> s->kind[i] & 1)) continue;
        for (int d = 0; d < 3; d++) {
            float fx, fu;
            double a;
            memcpy(&fx, x + (3 * k + d) * 4, 4);
            memcpy(&fu, u + (3 * k + d) * 4, 4);
            memcpy(&a, arm + (3 * k + d) * 8, 8);
            assert_true(fx == (d < s->dim ? (float)s->x[i * s->dim + d] : 0.0f));
            assert_true(fu == (d < s->dim ? (float)s->u[i * s->dim + d] : 0.0f));
            ASSERT_NEAR(a, d < s->dim ? 0.5 + (double)(i * s->dim + d) : 0, 0);
        }
        float fp;
        memcpy(&fp, p + 4 * k, 4);
        assert_true(fp == (float)s->p[i]);
        memcpy(&fp, load + 4 * k, 4);
        assert_true(fp == (float)s->load[i] && s->load[i] != s->p[i]);
        memcpy(&got, id + 8 * k, 8);
        assert_int_equal(got, s->id[i]);
        assert_int_equal(kind[k], s->kind[i]);
        int32_t number;
        memcpy(&number, part + 4 * k, 4);
        assert_int_equal(number, s->part[i]);
        memcpy(&number, cell + 4 * k, 4);
        assert_int_equal(number, k);
        memcpy(&number, end + 4 * k, 4);
        assert_int_equal(number, k + 1);
        k++;
    }
    assert_string_equal(text + size - strlen("\n</AppendedData>\n</VTKFile>\n"),
                        "\n</AppendedData>\n</VTKFile>\n");
    free(text);
}

#endif

/* SPDX-License-Identifier: BSD-3-Clause */
/* Small tanks, the folder of a run with some frames, and pictures read back pixel by pixel. */
#ifndef PICTURE_FIXTURE_H
#define PICTURE_FIXTURE_H

#include "../unit/tank_fixture.h"
#include <cairo.h>
#include <mps/picture.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

/* A picture read back. */
typedef struct sheet {
    int width, height;
    uint32_t *pixel; /* 0x00RRGGBB, row by row */
} sheet;

static inline sheet read_sheet(const char *path)
{
    cairo_surface_t *surface = cairo_image_surface_create_from_png(path);
    assert_int_equal(cairo_surface_status(surface), CAIRO_STATUS_SUCCESS);
    sheet s = {cairo_image_surface_get_width(surface), cairo_image_surface_get_height(surface),
               NULL};
    const int stride = cairo_image_surface_get_stride(surface);
    s.pixel = malloc((size_t)s.width * (size_t)s.height * sizeof *s.pixel);
    assert_non_null(s.pixel);
    for (int y = 0; y < s.height; y++) {
        const unsigned char *row = cairo_image_surface_get_data(surface) +
                                   (size_t)y * (size_t)stride;
        memcpy(s.pixel + (size_t)y * (size_t)s.width, row, (size_t)s.width * sizeof *s.pixel);
    }
    for (int k = 0; k < s.width * s.height; k++) s.pixel[k] &= 0xffffff;
    cairo_surface_destroy(surface);
    return s;
}

static inline uint32_t at(const sheet *s, double x, double y)
{
    assert_true(x >= 0 && y >= 0 && x < s->width && y < s->height);
    return s->pixel[(size_t)y * (size_t)s->width + (size_t)x];
}

/* Colours of 0..1 as a pixel has them. */
static inline bool is_colour(uint32_t pixel, double r, double g, double b)
{
    const double wanted[3] = {255 * r, 255 * g, 255 * b};
    for (int k = 0; k < 3; k++)
        if (fabs((double)(pixel >> (16 - 8 * k) & 255) - wanted[k]) > 2.5) return false;
    return true;
}

static const double wall_colour[3] = {0.60, 0.62, 0.65}, least_colour[3] = {0.07, 0.13, 0.42},
                    most_colour[3] = {0.99, 0.93, 0.25}, mark_colour[3] = {0.84, 0.37, 0.00};

/* A pixel and those `around` it have a colour; edges of grey text have any grey. */
static inline bool is_area(const sheet *s, int x, int y, int around, const double c[3])
{
    if (x < around || y < around || x + around >= s->width || y + around >= s->height) return false;
    for (int j = -around; j <= around; j++)
        for (int i = -around; i <= around; i++)
            if (!is_colour(at(s, x + i, y + j), c[0], c[1], c[2])) return false;
    return true;
}

/* The box of all middles of such areas: left, top, right, bottom. @return their number */
static inline int span_of(const sheet *s, const double c[3], int around, int out[4])
{
    int count = 0;
    out[0] = s->width;
    out[1] = s->height;
    out[2] = out[3] = -1;
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++) {
            if (!is_area(s, x, y, around, c)) continue;
            out[0] = x < out[0] ? x : out[0];
            out[1] = y < out[1] ? y : out[1];
            out[2] = x > out[2] ? x : out[2];
            out[3] = y > out[3] ? y : out[3];
            count++;
        }
    return count;
}

/* Convert metres to pixels, by the discs of the walls, with centres at 0 and at `size`. */
typedef struct place {
    double x0, y0, scale;
} place;

static inline place find_place(const sheet *s, double width, double dp)
{
    int box[4];
    assert_true(span_of(s, wall_colour, 1, box) > 100);
    place p = {.scale = (box[2] + 3 - box[0]) / (width + dp)}; /* an area ends one pixel inside */
    p.x0 = box[0] - 1 + 0.5 * dp * p.scale;
    p.y0 = box[3] + 2 - 0.5 * dp * p.scale;
    return p;
}

static inline uint32_t at_metres(const sheet *s, const place *p, double x, double y)
{
    return at(s, p->x0 + x * p->scale, p->y0 - y * p->scale);
}

/* A tank of 0.8 x 0.5 m (3-D: 0.4 m) of spacing 0.05 m with 0.25 m of water. */
static inline mps_sim *wet_tank(int32_t dim)
{
    mps_sim *sim = new_sim(dim, 0.05);
    add_tank(sim, 0.8, 0.5, 0.4);
    fill_depth(sim, 0.8, 0.25, 0.4);
    return sim;
}

static inline void add_sensor(mps_sim *sim, int32_t type, const char *name, double x, double y,
                              double z)
{
    mps_probe probe;
    int32_t id;
    mps_probe_init(&probe, sizeof probe);
    probe.type = type;
    probe.name = name;
    probe.at[0] = x;
    probe.at[1] = y;
    probe.at[2] = z;
    ASSERT_OK(sim, mps_probe_add(sim, &probe, &id));
}

/* Pressures of all fluid: p0 + slope (0.25 m - y). @return index of the particle nearest to (x,
 * y) */
static inline int64_t set_pressures(mps_sim *sim, double p0, double slope, double x, double y)
{
    mps_lease p = {.struct_size = sizeof p}, X = {.struct_size = sizeof X},
              kind = {.struct_size = sizeof kind};
    int64_t best = -1;
    double nearest = INFINITY;
    ASSERT_OK(sim, mps_lease_begin(sim, "pressure", MPS_WRITE, &p));
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &X));
    ASSERT_OK(sim, mps_lease_begin(sim, "kind", MPS_READ, &kind));
    for (int64_t i = 0; i < p.count; i++) {
        const double *at_i = X.data + i * X.stride, far = hypot(at_i[0] - x, at_i[1] - y);
        if (kind.integers[i] != MPS_FLUID) continue;
        p.data[i] = p0 + slope * (0.25 - at_i[1]);
        if (far < nearest) {
            nearest = far;
            best = i;
        }
    }
    ASSERT_OK(sim, mps_lease_end(sim, &p));
    ASSERT_OK(sim, mps_lease_end(sim, &X));
    ASSERT_OK(sim, mps_lease_end(sim, &kind));
    return best;
}

static inline mps_picture_config new_config(char *error, size_t size)
{
    mps_picture_config config;
    assert_int_equal(mps_picture_config_init(&config, sizeof config), MPS_OK);
    config.error = error;
    config.error_size = size;
    return config;
}

static inline bool exists(const char *path)
{
    struct stat about;
    return stat(path, &about) == 0;
}

static inline char *read_whole(const char *path, long *size)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    *size = ftell(file);
    rewind(file);
    char *text = calloc((size_t)*size + 1, 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, (size_t)*size, file), (size_t)*size);
    fclose(file);
    return text;
}

static inline void write_text(const char *folder, const char *name, const char *text)
{
    char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

/* The folder of a run of `frames` frames, in which the tank moves along x. `more`: members of
 * summary.json, with a comma at the end. */
static inline void write_folder(const char *folder, mps_sim *sim, int frames, const char *more)
{
    mps_frames *series;
    char text[2000];
    int32_t dim;
    assert_int_equal(mps_sim_shape(sim, &dim, NULL), MPS_OK);
    mkdir(folder, 0777);
    ASSERT_OK(sim, mps_frames_open(sim, folder, "frames", 0, &series));
    for (int k = 0; k < frames; k++) {
        if (k > 0) assert_true(mps_step(sim, 1e-3, NULL) >= 0);
        assert_int_equal(mps_frames_write(series), MPS_OK);
    }
    mps_frames_close(series);
    snprintf(text, sizeof text,
             "{\"case\": \"tank\", %s \"dim\": %d, \"dp\": 0.05, \"gravity\": 9.81, \"phases\": "
             "[{\"density\": 1000}],"
             "\"columns\": [{\"name\": \"P1\", \"unit\": \"Pa\", \"type\": \"wall_pressure\", "
             "\"at\": [0, 0.4, 0.2],"
             "\"normal\": [1, 0, 0], \"about\": \"\"}]}\n",
             more, (int)dim);
    write_text(folder, "summary.json", text);
    write_text(folder, "probes.csv", "t[s],P1[Pa]\n0,0\n");
}

static inline void remove_folder(const char *folder)
{
    char command[200];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    assert_int_equal(system(command), 0);
}

#endif

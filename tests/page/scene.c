/* SPDX-License-Identifier: BSD-3-Clause */
/* Folders with pages for the tests in a browser, and the expected picture of the film, drawn here
 * from the paths of the particles.
 * usage: scene FOLDER: makes FOLDER/flat, FOLDER/deep, FOLDER/chamfer, FOLDER/plate, FOLDER/aft,
 * FOLDER/bare, FOLDER/flat.rgb */
#include "page_fixture.h"
#include "page_scale.h"

enum { WIDE = 720, TALL = 407, FRAME = 4, FINE = 4 };

static const double WALL[3] = {0.55, 0.55, 0.58};

/* Red, green, blue of a pressure. */
static void colour_of(double share, double out[3])
{
    const double f = fmin(fmax(share, 0), 1) * 4;
    const int k = f < 4 ? (int)f : 3;
    for (int c = 0; c < 3; c++)
        out[c] = mps__scale_map[0][k][c] +
                 (f - k) * (mps__scale_map[0][k + 1][c] - mps__scale_map[0][k][c]);
}

/* A disc over the existing picture; coverage of a pixel at its edge is the number of its
 * FINE x FINE points inside. */
static void draw_disc(double *picture, double x, double y, double radius, const double colour[3])
{
    for (int j = (int)(y - radius) - 1; j <= (int)(y + radius) + 1; j++)
        for (int i = (int)(x - radius) - 1; i <= (int)(x + radius) + 1; i++) {
            int in = 0;
            if (i < 0 || j < 0 || i >= WIDE || j >= TALL) continue;
            for (int k = 0; k < FINE * FINE; k++)
                in += hypot(i + (k % FINE + 0.5) / FINE - x, j + (k / FINE + 0.5) / FINE - y) <
                      radius;
            for (int c = 0; c < 3; c++) {
                double *p = picture + 3 * (j * WIDE + i) + c;
                *p += (colour[c] - *p) * in / (FINE * FINE);
            }
        }
}

/* The scale of the page: largest value of all frames, as no more than one in a hundred is above the
 * 99 % quantile. */
static double scale_of(const scene *s)
{
    page_scale scale = {0};
    for (int32_t k = 0; k < s->frames; k++)
        for (int32_t i = 0; i < s->fluid; i++)
            assert_true(mps__scale_take(&scale, (double)pressure_of(i, k)));
    mps__scale_end(&scale, 0, false);
    return scale.hi;
}

/* Tank with three spacings about it in the middle of the picture. */
static void draw(const scene *s, const char *path)
{
    const double dp = 0.05, scale = fmin(WIDE / (2 + 6 * dp), TALL / (1 + 6 * dp)),
                 hi = scale_of(s);
    double *picture = malloc(3 * WIDE * TALL * sizeof *picture), X[3], colour[3];
    FILE *file = fopen(path, "wb");
    assert_true(picture && file);
    for (int k = 0; k < 3 * WIDE * TALL; k++) picture[k] = 1;
    for (int pass = 0; pass < 2; pass++)
        for (int32_t place = 0; place < WALLS + s->fluid; place++) {
            const int32_t i = particle_at(s, 0, place);
            if ((i < 0) != pass) continue;
            place_in_tank(s, i, FRAME, X);
            colour_of((double)pressure_of(i, FRAME) / hi, colour);
            draw_disc(picture, WIDE / 2.0 + scale * (X[0] - 1), TALL / 2.0 - scale * (X[1] - 0.5),
                      0.5 * dp * scale, i < 0 ? WALL : colour);
        }
    for (int k = 0; k < 3 * WIDE * TALL; k++) fputc((int)(255 * picture[k] + 0.5), file);
    assert_int_equal(fclose(file), 0);
    free(picture);
}

/* @param more  more members of the summary */
static void make(scene *s, const char *folder, const char *name, const char *more)
{
    char path[512];
    scene_create(s);
    write_summary(s, more);
    text_write(s, "case.yaml", "mps: 1\ntitle: a </script> in it\n");
    snprintf(path, sizeof path, "%.400s/%s", folder, name);
    if (page_of(s, 0, NULL) != MPS_OK || rename(s->folder, path) != 0) {
        fprintf(stderr, "%s: %s\n", path, s->error);
        exit(1);
    }
}

int main(int argc, char **argv)
{
    scene flat = {.dim = 2, .fluid = 400, .frames = 30, .rows = 1500, .moves = true, .pockets = 6};
    scene deep = {.dim = 3, .fluid = 700, .frames = 20, .rows = 300};
    scene chamfer = {.dim = 3, .fluid = 700, .frames = 2, .rows = 300, .front = true};
    scene plate = {.dim = 3, .fluid = 700, .frames = 2, .rows = 300, .front = true, .plate = true};
    scene aft = {.dim = 3, .fluid = 700, .frames = 2, .rows = 300}; /* its bow is along -z */
    scene bare = {.dim = 2, .fluid = 400, .rows = 300};             /* no film */
    char path[512];
    if (argc != 2) return 2;
    make(&flat, argv[1], "flat", "");
    make(&deep, argv[1], "deep", ", \"inputs\": [{\"key\": \"motion.axes\", \"value\": \"x\"}]");
    make(&chamfer, argv[1], "chamfer", "");
    make(&plate, argv[1], "plate", "");
    make(&aft, argv[1], "aft", ", \"inputs\": [{\"key\": \"motion.forward\", \"value\": \"-z\"}]");
    make(&bare, argv[1], "bare", "");
    snprintf(path, sizeof path, "%.400s/flat.rgb", argv[1]);
    draw(&flat, path);
    return 0;
}

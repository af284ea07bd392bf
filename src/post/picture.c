/* SPDX-License-Identifier: BSD-3-Clause */
/* Pictures of the flow, drawn in memory and written with libpng. */
#include "picture.h"
#include "font.h"
#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    PICTURE_WIDTH = 1100,
    PICTURE_TALLEST = 1400,
    HEAD = 34,
    BAR = 132,
    FONT_SCALE = 2,
    MAPS = 3,
    PHASE_BAR = 20 /* from one phase's bar to the next */
};

typedef struct colour {
    double r, g, b;
} colour;

typedef struct image {
    int width, height;
    unsigned char *pixel; /* [height*width*3] */
} image;

/* What is drawn, and the map from metres to pixels. */
typedef struct scene {
    int32_t dim;
    int64_t n;
    const double *x, *p, *u, *rho;
    const int32_t *kind, *phase, *plate;
    double dp, lo[3], hi[3], scale, gravity, p_min, p_max, t;
    int32_t phases; /* the highest number among the fluid, plus one */
} scene;

/* Five colours of equal steps a phase: dark to light, so that the maps read in grey too. Phase 1, mostly the gas about the liquid, is the
 * other way round: pale where the liquid beside it is dark. */
static const colour MAP[MAPS][5] = {
    {{0.07, 0.13, 0.42},
     {0.10, 0.40, 0.68},
     {0.22, 0.69, 0.66},
     {0.68, 0.86, 0.38},
     {0.99, 0.93, 0.25}},
    {{0.90, 0.87, 0.82},
     {0.92, 0.80, 0.64},
     {0.90, 0.66, 0.44},
     {0.82, 0.46, 0.27},
     {0.62, 0.25, 0.14}},
    {{0.25, 0.05, 0.40},
     {0.50, 0.15, 0.58},
     {0.74, 0.33, 0.66},
     {0.90, 0.56, 0.76},
     {0.99, 0.82, 0.90}},
};

static colour map_colour(int32_t phase, double f)
{
    const colour *map = MAP[phase % MAPS];
    f = f > 0 ? fmin(f, 1) * 4 : 0;
    int k = f < 4 ? (int)f : 3;
    double w = f - k;
    return (colour){map[k].r + w * (map[k + 1].r - map[k].r),
                    map[k].g + w * (map[k + 1].g - map[k].g),
                    map[k].b + w * (map[k + 1].b - map[k].b)};
}

static unsigned char blend(unsigned char below, double above, double cover)
{
    return (unsigned char)(below * (1 - cover) + 255 * above * cover + 0.5);
}

static void image_dot(image *m, int x, int y, colour c, double cover)
{
    if (x < 0 || y < 0 || x >= m->width || y >= m->height || cover <= 0) return;
    unsigned char *p = m->pixel + 3 * ((size_t)y * (size_t)m->width + (size_t)x);
    if (cover > 1) cover = 1;
    p[0] = blend(p[0], c.r, cover);
    p[1] = blend(p[1], c.g, cover);
    p[2] = blend(p[2], c.b, cover);
}

/* A disc with soft edges; discs smaller than a pixel become a fainter dot. */
static void image_disc(image *m, double x, double y, double radius, colour c)
{
    int reach = (int)ceil(radius + 1), cx = (int)floor(x), cy = (int)floor(y);
    for (int j = cy - reach; j <= cy + reach; j++)
        for (int i = cx - reach; i <= cx + reach; i++)
            image_dot(m, i, j, c, radius + 0.5 - hypot(i + 0.5 - x, j + 0.5 - y));
}

static void image_box(image *m, int x, int y, int width, int height, colour c)
{
    for (int j = y; j < y + height; j++)
        for (int i = x; i < x + width; i++) image_dot(m, i, j, c, 1);
}

static void image_text(image *m, int x, int y, const char *text)
{
    for (; *text; text++, x += FONT_SCALE * (FONT_WIDTH + 1)) {
        const unsigned char *rows = mps__font_rows(*text);
        for (int j = 0; rows && j < FONT_HEIGHT; j++)
            for (int i = 0; i < FONT_WIDTH; i++)
                if (rows[j] >> (FONT_WIDTH - 1 - i) & 1)
                    image_box(m, x + i * FONT_SCALE, y + j * FONT_SCALE, FONT_SCALE, FONT_SCALE,
                              (colour){0.1, 0.1, 0.1});
    }
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Two digits, rounded up: a scale one can read. */
static double round_up(double value)
{
    double power = pow(10, floor(log10(value)) - 1);
    return ceil(value / power) * power;
}

/* Pressures below this are rounding: a thousandth of rho (g dp + u^2), with the largest density and speed. */
static double scene_noise(const scene *s)
{
    double speed2 = 0, density = 0;
    for (int64_t i = 0; i < s->n; i++) {
        double u2 = 0;
        if (s->kind[i] != MPS_FLUID) continue;
        for (int d = 0; d < s->dim; d++) u2 += s->u[i * s->dim + d] * s->u[i * s->dim + d];
        speed2 = fmax(speed2, u2);
        density = fmax(density, s->rho[i]);
    }
    return 1e-3 * density * (s->gravity * s->dp + speed2);
}

/* The scale: 0 to the 99 % quantile of the fluid's pressures, so that one peak does not flatten the rest. In closed tanks full of fluid the
 * pressure may be negative all over: several phases have a lower end as well. Noise alone stays at the dark end. */
static void scene_scale(scene *s)
{
    double top = scene_noise(s), bottom = 0;
    int64_t fluid = 0, n = 0;
    for (int64_t i = 0; i < s->n; i++) fluid += s->kind[i] == MPS_FLUID;
    double *p = fluid > 0 ? malloc((size_t)fluid * sizeof *p) : NULL;
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_FLUID) continue;
        if (s->phase[i] >= s->phases) s->phases = s->phase[i] + 1;
        if (p) p[n++] = s->p[i];
    }
    if (n > 0) {
        qsort(p, (size_t)n, sizeof *p, compare_doubles);
        top = fmax(top, p[(n - 1) * 99 / 100]);
        if (s->phases > 1) bottom = p[(n - 1) / 100];
    }
    free(p);
    s->p_max = top > 0 ? round_up(top) : 0;
    s->p_min = bottom < -0.05 * s->p_max ? -round_up(-bottom) : 0;
    if (s->p_max == s->p_min) s->p_max = s->p_min + 1;
}

/* The window: all walls with a little margin, or all fluid when there is no wall. */
static void scene_window(scene *s)
{
    int32_t kind = MPS_FLUID;
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_WALL) kind = MPS_WALL;
    for (int d = 0; d < s->dim; d++) {
        s->lo[d] = INFINITY;
        s->hi[d] = -INFINITY;
        for (int64_t i = 0; i < s->n; i++) {
            if (s->kind[i] != kind) continue;
            s->lo[d] = fmin(s->lo[d], s->x[i * s->dim + d] - 3 * s->dp);
            s->hi[d] = fmax(s->hi[d], s->x[i * s->dim + d] + 3 * s->dp);
        }
    }
}

static bool image_create(image *m, scene *s)
{
    double width = s->hi[0] - s->lo[0], height = s->hi[1] - s->lo[1];
    s->scale = fmin((PICTURE_WIDTH - BAR) / width, (PICTURE_TALLEST - HEAD) / height);
    m->width = (int)(width * s->scale) + BAR;
    m->height = (int)(height * s->scale) + HEAD;
    m->pixel = malloc((size_t)m->width * (size_t)m->height * 3);
    if (m->pixel) memset(m->pixel, 255, (size_t)m->width * (size_t)m->height * 3);
    return m->pixel != NULL;
}

static void draw_particle(image *m, const scene *s, int64_t i)
{
    colour c = {0.55, 0.55, 0.58};
    if (s->kind[i] == MPS_DUMMY) c = (colour){0.84, 0.84, 0.86};
    if (s->kind[i] == MPS_FLUID)
        c = map_colour(s->phase[i], (s->p[i] - s->p_min) / (s->p_max - s->p_min));
    double x = (s->x[i * s->dim] - s->lo[0]) * s->scale,
           y = (s->hi[1] - s->x[i * s->dim + 1]) * s->scale + HEAD;
    image_disc(m, x, y, 0.5 * s->dp * s->scale, c);
}

typedef struct depth {
    double z;
    int64_t i;
} depth;

static int compare_depths(const void *a, const void *b)
{
    const depth *x = a, *y = b;
    return x->z != y->z ? (x->z > y->z) - (x->z < y->z) : (x->i > y->i) - (x->i < y->i);
}

/* In 3-D what is about the middle across z, one or two layers, so that baffles and levels between the walls are seen. */
static bool is_drawn(const scene *s, int64_t i)
{
    if (s->kind[i] == MPS_DUMMY && s->plate[i]) return false;
    return s->dim == 2 || fabs(s->x[i * 3 + 2] - 0.5 * (s->lo[2] + s->hi[2])) <= 0.75 * s->dp;
}

/* In 3-D from the back to the front. */
static bool draw_slice(image *m, const scene *s)
{
    int64_t count = 0, n = 0;
    for (int64_t i = 0; i < s->n; i++) count += is_drawn(s, i);
    if (count == 0) return true;
    depth *order = malloc((size_t)count * sizeof *order);
    if (!order) return false;
    for (int64_t i = 0; i < s->n; i++)
        if (is_drawn(s, i)) order[n++] = (depth){s->x[i * 3 + 2], i};
    qsort(order, (size_t)n, sizeof *order, compare_depths);
    for (int64_t k = 0; k < n; k++) draw_particle(m, s, order[k].i);
    free(order);
    return true;
}

static bool draw_particles(image *m, const scene *s)
{
    if (s->dim == 3) return draw_slice(m, s);
    for (int64_t i = 0; i < s->n; i++)
        if (is_drawn(s, i)) draw_particle(m, s, i);
    return true;
}

/* Of each phase one, with its number below if there are several. */
static void draw_bars(image *m, const scene *s, int x, int top, int height)
{
    int count = s->phases > 1 ? s->phases < MAPS ? s->phases : MAPS : 1,
        width = count > 1 ? FONT_SCALE * FONT_WIDTH + 2 : 20;
    char text[16];
    for (int b = 0; b < count; b++) {
        for (int j = 0; j < height; j++)
            image_box(m, x + b * PHASE_BAR, top + j, width, 1,
                      map_colour(b, 1 - (double)j / height));
        snprintf(text, sizeof text, "%d", b);
        if (count > 1) image_text(m, x + b * PHASE_BAR + 1, top + height + 6, text);
    }
}

static void draw_scale(image *m, const scene *s)
{
    int x = m->width - BAR + 12, top = HEAD + 12,
        height = m->height - HEAD - (s->phases > 1 ? 40 : 24);
    int right = x + 6 + PHASE_BAR * (s->phases < MAPS ? s->phases : MAPS);
    if (s->phases <= 1) right = x + 26;
    const double most = fmax(s->p_max, -s->p_min);
    char text[96];
    draw_bars(m, s, x, top, height);
    for (int k = 0; k <= 4; k++) {
        const double p = s->p_max + (s->p_min - s->p_max) * k / 4;
        snprintf(text, sizeof text,
                 most >= 10     ? "%.0f"
                 : most >= 0.1  ? "%.2f"
                 : most >= 1e-3 ? "%.4f"
                                : "%.0e",
                 p);
        image_text(m, right, top + height * k / 4 - FONT_HEIGHT, text);
    }
    snprintf(text, sizeof text, "t = %.3f s   pressure [Pa]%.24s%s", s->t,
             s->phases > 2   ? "   bars: phases 0, 1, 2"
             : s->phases > 1 ? "   bars: phases 0, 1"
                             : "",
             s->dim == 3 ? "   middle slice" : "");
    image_text(m, 12, 10, text);
}

/* @return NULL, or why not */
static const char *image_save(const image *m, png_image *png, const char *path)
{
    *png = (png_image){.version = PNG_IMAGE_VERSION,
                       .width = (png_uint_32)m->width,
                       .height = (png_uint_32)m->height,
                       .format = PNG_FORMAT_RGB};
    return png_image_write_to_file(png, path, 0, m->pixel, 0, NULL) ? NULL : png->message;
}

static bool picture_draw(scene *s, const char *path, char *error)
{
    image m = {0};
    png_image png;
    scene_window(s);
    scene_scale(s);
    const char *why = "out of memory";
    if (image_create(&m, s) && draw_particles(&m, s)) {
        draw_scale(&m, s);
        why = image_save(&m, &png, path);
    }
    if (why) snprintf(error, PICTURE_ERROR, "%.500s: no picture: %s", path, why);
    free(m.pixel);
    return !why;
}

bool mps__picture_save(mps_sim *sim, double gravity, const char *path, char *error)
{
    static const char *const name[] = {"position", "kind",     "phase",  "pressure",
                                       "plate",    "velocity", "density"};
    enum { LEASES = sizeof name / sizeof *name };
    mps_lease lease[LEASES];
    scene s = {.gravity = gravity};
    bool done = false;
    int leased = 0;
    for (int k = 0; k < LEASES; k++) lease[k] = (mps_lease){.struct_size = sizeof lease[k]};
    mps_sim_shape(sim, &s.dim, &s.dp);
    mps_sim_time(sim, &s.t, NULL);
    while (leased < LEASES &&
           mps_lease_begin(sim, name[leased], MPS_READ, &lease[leased]) == MPS_OK)
        leased++;
    s.n = lease[0].count;
    s.x = lease[0].data;
    s.kind = lease[1].integers;
    s.phase = lease[2].integers;
    s.p = lease[3].data;
    s.plate = lease[4].integers;
    s.u = lease[5].data;
    s.rho = lease[6].data;
    if (leased == LEASES)
        done = picture_draw(&s, path, error);
    else
        snprintf(error, PICTURE_ERROR, "%.500s: no picture: %s", path, mps_sim_error(sim));
    while (leased > 0) mps_lease_end(sim, &lease[--leased]);
    return done;
}

/* SPDX-License-Identifier: BSD-3-Clause */
#include "picture_canvas.h"
#include "escape.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { TEXT_MOST = 400 };

const colour mps__ink = {0.13, 0.15, 0.18}, mps__grey = {0.45, 0.47, 0.50},
             mps__pale = {0.80, 0.81, 0.83}, mps__white = {1, 1, 1};

/* Same glyphs on all machines: no hinting, grey antialiasing. */
static void choose_font(canvas *c)
{
    cairo_font_options_t *options = cairo_font_options_create();
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_set_font_options(c->cairo, options);
    cairo_font_options_destroy(options);
}

bool mps__canvas_create(canvas *c, int width, int height, double unit)
{
    *c = (canvas){.width = width, .height = height, .unit = unit};
    c->surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
    c->cairo = cairo_create(c->surface);
    if (cairo_status(c->cairo) != CAIRO_STATUS_SUCCESS) {
        mps__canvas_destroy(c);
        return false;
    }
    choose_font(c);
    cairo_set_source_rgb(c->cairo, 1, 1, 1);
    cairo_paint(c->cairo);
    c->stride = cairo_image_surface_get_stride(c->surface) / (int)sizeof *c->pixel;
    c->pixel = (uint32_t *)(void *)cairo_image_surface_get_data(c->surface);
    return true;
}

void mps__canvas_destroy(canvas *c)
{
    if (c->cairo) cairo_destroy(c->cairo);
    if (c->surface) cairo_surface_destroy(c->surface);
    *c = (canvas){0};
}

/* ---- pixels ---- */

void mps__canvas_pixels_begin(canvas *c)
{
    cairo_surface_flush(c->surface);
}

void mps__canvas_pixels_end(canvas *c)
{
    cairo_surface_mark_dirty(c->surface);
}

static uint32_t blend(uint32_t below, double above, double cover)
{
    return (uint32_t)((below & 255) * (1 - cover) + 255 * above * cover + 0.5);
}

void mps__canvas_dot(canvas *c, const pixel_box *clip, int x, int y, colour ink, double cover)
{
    if (!(cover > 0) || x < clip->x || y < clip->y || x >= clip->x + clip->width ||
        y >= clip->y + clip->height || x < 0 || y < 0 || x >= c->width || y >= c->height)
        return;
    uint32_t *p = c->pixel + (size_t)y * (size_t)c->stride + x;
    if (cover > 1) cover = 1;
    *p = blend(*p >> 16, ink.r, cover) << 16 | blend(*p >> 8, ink.g, cover) << 8 |
         blend(*p, ink.b, cover);
}

void mps__canvas_disc(canvas *c, const pixel_box *clip, double x, double y, double radius,
                      colour ink)
{
    if (!(x > -1e6 && x < 1e6 && y > -1e6 && y < 1e6)) return;
    const double faint = radius < 0.5 ? 4 * radius * radius : 1;
    const double r = fmax(radius, 0.5);
    const int reach = (int)ceil(r + 1), cx = (int)floor(x), cy = (int)floor(y);
    for (int j = cy - reach; j <= cy + reach; j++)
        for (int i = cx - reach; i <= cx + reach; i++) {
            const double dx = i + 0.5 - x, dy = j + 0.5 - y;
            const double inside = r + 0.5 - sqrt(dx * dx + dy * dy);
            mps__canvas_dot(c, clip, i, j, ink, faint * fmin(inside, 1));
        }
}

/* ---- lines ---- */

static void use(canvas *c, colour ink)
{
    cairo_set_source_rgb(c->cairo, ink.r, ink.g, ink.b);
}

void mps__canvas_line(canvas *c, double x0, double y0, double x1, double y1, double width,
                      colour ink)
{
    use(c, ink);
    cairo_set_line_width(c->cairo, width * c->unit);
    cairo_move_to(c->cairo, x0, y0);
    cairo_line_to(c->cairo, x1, y1);
    cairo_stroke(c->cairo);
}

void mps__canvas_dashes(canvas *c, double x0, double y0, double x1, double y1, colour ink)
{
    const double dash[2] = {5 * c->unit, 4 * c->unit};
    cairo_set_dash(c->cairo, dash, 2, 0);
    mps__canvas_line(c, x0, y0, x1, y1, 1.3, ink);
    cairo_set_dash(c->cairo, NULL, 0, 0);
}

void mps__canvas_box(canvas *c, const pixel_box *box, colour ink)
{
    use(c, ink);
    cairo_rectangle(c->cairo, box->x, box->y, box->width, box->height);
    cairo_fill(c->cairo);
}

void mps__canvas_ring(canvas *c, double x, double y, double radius, colour ink)
{
    cairo_new_path(c->cairo);
    cairo_arc(c->cairo, x, y, radius * c->unit, 0, 2 * acos(-1.0));
    use(c, mps__white);
    cairo_fill_preserve(c->cairo);
    use(c, ink);
    cairo_set_line_width(c->cairo, 2.2 * c->unit);
    cairo_stroke(c->cairo);
}

void mps__canvas_tip(canvas *c, double x, double y, double width, double height, colour ink)
{
    use(c, ink);
    cairo_move_to(c->cairo, x - 0.5 * width, y);
    cairo_line_to(c->cairo, x + 0.5 * width, y);
    cairo_line_to(c->cairo, x, y + height);
    cairo_close_path(c->cairo);
    cairo_fill(c->cairo);
}

void mps__canvas_arrow(canvas *c, double x0, double y0, double x1, double y1, colour ink)
{
    const double length = hypot(x1 - x0, y1 - y0), head = 9 * c->unit;
    if (!(length > 0)) return;
    const double ex = (x1 - x0) / length, ey = (y1 - y0) / length;
    mps__canvas_line(c, x0, y0, x1 - 0.6 * head * ex, y1 - 0.6 * head * ey, 2, ink);
    cairo_move_to(c->cairo, x1, y1);
    cairo_line_to(c->cairo, x1 - head * ex - 0.4 * head * ey, y1 - head * ey + 0.4 * head * ex);
    cairo_line_to(c->cairo, x1 - head * ex + 0.4 * head * ey, y1 - head * ey - 0.4 * head * ex);
    cairo_close_path(c->cairo);
    cairo_fill(c->cairo);
}

/* ---- text ---- */

/* Bytes of the character at `text`, 0: not UTF-8 as cairo requires. */
static size_t character(const char *text)
{
    const unsigned char c = (unsigned char)*text;
    return c < 0x20 || c == 0x7f ? 0 : mps__character(text);
}

/* Keep whole characters only. */
static void clean(char out[TEXT_MOST], const char *text)
{
    size_t n = 0;
    while (*text && n + 4 < TEXT_MOST) {
        const size_t size = character(text);
        if (size > 0) memcpy(out + n, text, size);
        if (size == 0) out[n] = '?';
        n += size ? size : 1;
        text += size ? size : 1;
    }
    out[n] = '\0';
}

static double measure(canvas *c, text_style style, const char *text)
{
    cairo_text_extents_t extents;
    cairo_select_font_face(c->cairo, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                           style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(c->cairo, style.size * c->unit);
    cairo_text_extents(c->cairo, text, &extents);
    return extents.x_advance;
}

bool mps__canvas_letters(void)
{
    enum { SIDE = 32 };
    const text_style style = {.size = 20, .place = TEXT_LEFT, .ink = {0, 0, 0}};
    canvas c;
    bool dark = false;
    if (!mps__canvas_create(&c, SIDE, SIDE, 1)) return true; /* memory is checked elsewhere */
    mps__canvas_text(&c, 4, 26, style, 0, "P8");
    mps__canvas_pixels_begin(&c);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            dark = dark || (c.pixel[(size_t)y * (size_t)c.stride + (size_t)x] & 255) < 128;
    mps__canvas_pixels_end(&c);
    mps__canvas_destroy(&c);
    return dark;
}

double mps__canvas_text_width(canvas *c, text_style style, const char *text)
{
    char own[TEXT_MOST];
    clean(own, text);
    return measure(c, style, own);
}

/* Shorten a text until it fits. */
static void fit(canvas *c, text_style style, double most, char text[TEXT_MOST])
{
    static const char ellipsis[] = "\xe2\x80\xa6";
    size_t n = strlen(text);
    while (n > 0 && most > 0 && measure(c, style, text) > most) {
        do n--;
        while (n > 0 && ((unsigned char)text[n] & 0xc0) == 0x80);
        n = n < TEXT_MOST - sizeof ellipsis ? n : TEXT_MOST - sizeof ellipsis;
        memcpy(text + n, ellipsis, sizeof ellipsis);
    }
}

void mps__canvas_text(canvas *c, double x, double y, text_style style, double most,
                      const char *text)
{
    char own[TEXT_MOST];
    clean(own, text);
    fit(c, style, most, own);
    const double width = measure(c, style, own);
    const double left = x - (style.place == TEXT_RIGHT    ? width
                             : style.place == TEXT_MIDDLE ? 0.5 * width
                                                          : 0);
    cairo_move_to(c->cairo, left, y);
    if (style.halo) {
        cairo_text_path(c->cairo, own);
        use(c, mps__white);
        cairo_set_line_width(c->cairo, 4 * c->unit);
        cairo_set_line_join(c->cairo, CAIRO_LINE_JOIN_ROUND);
        cairo_stroke(c->cairo);
        cairo_move_to(c->cairo, left, y);
    }
    use(c, style.ink);
    cairo_show_text(c->cairo, own);
    cairo_new_path(c->cairo);
}

/* ---- the file ---- */

static cairo_status_t put(void *file, const unsigned char *data, unsigned size)
{
    return fwrite(data, 1, size, file) == size ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

/* Remove an incomplete file; devices stay. */
static void discard(const char *path)
{
    struct stat about;
    if (stat(path, &about) == 0 && S_ISREG(about.st_mode)) remove(path);
}

mps_status mps__canvas_save(canvas *c, const char *path, page_errors *e)
{
    if (cairo_status(c->cairo) != CAIRO_STATUS_SUCCESS)
        return mps__page_fail(e, MPS_E_NOMEM, "no memory for the picture '%s'", path);
    FILE *file = fopen(path, "wb");
    if (!file) return mps__page_fail(e, MPS_E_IO, "cannot write '%s': %s", path, strerror(errno));
    errno = 0;
    const cairo_status_t drawn = cairo_surface_write_to_png_stream(c->surface, put, file);
    int reason = errno;
    if (fclose(file) != 0 && drawn == CAIRO_STATUS_SUCCESS)
        reason = errno;
    else if (drawn == CAIRO_STATUS_SUCCESS)
        return MPS_OK;
    discard(path);
    if (drawn == CAIRO_STATUS_NO_MEMORY)
        return mps__page_fail(e, MPS_E_NOMEM, "no memory for the picture '%s'", path);
    return mps__page_fail(e, MPS_E_IO, "cannot write '%s': %s", path, strerror(reason));
}

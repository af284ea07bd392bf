/* SPDX-License-Identifier: BSD-3-Clause */
/* A canvas: text and lines by cairo, discs written directly into its pixels, because a film has
 * millions of them. */
#ifndef MPS_POST_PICTURE_CANVAS_H
#define MPS_POST_PICTURE_CANVAS_H

#include "page_read.h"
#include <cairo.h>

/* Red, green, blue in 0..1. */
typedef struct colour {
    double r, g, b;
} colour;

extern const colour mps__ink, mps__grey, mps__pale, mps__white;

/* Alignment of a text relative to its point. */
typedef enum text_place { TEXT_LEFT, TEXT_MIDDLE, TEXT_RIGHT } text_place;

typedef struct text_style {
    double size; /* [pixels] of a picture 1280 wide */
    text_place place;
    bool bold, halo; /* halo: a white edge, for text on particles */
    colour ink;
} text_style;

typedef struct canvas {
    cairo_surface_t *surface;
    cairo_t *cairo;
    int width, height, stride; /* [pixels]; stride: pixels per line */
    uint32_t *pixel;           /* 0x00RRGGBB */
    double unit;               /* pixels per pixel of a picture 1280 wide */
} canvas;

/* A box of pixels. */
typedef struct pixel_box {
    double x, y, width, height;
} pixel_box;

/* A white canvas. @return false: memory is exhausted */
bool mps__canvas_create(canvas *c, int width, int height, double unit);
void mps__canvas_destroy(canvas *c);
/* Draw discs between these two. */
void mps__canvas_pixels_begin(canvas *c);
void mps__canvas_pixels_end(canvas *c);
/* Blend a pixel inside `clip`. @param cover  0..1 */
void mps__canvas_dot(canvas *c, const pixel_box *clip, int x, int y, colour ink, double cover);
/* Draw a disc with soft edges; one smaller than a pixel becomes a fainter dot. */
void mps__canvas_disc(canvas *c, const pixel_box *clip, double x, double y, double radius,
                      colour ink);

void mps__canvas_line(canvas *c, double x0, double y0, double x1, double y1, double width,
                      colour ink);
void mps__canvas_dashes(canvas *c, double x0, double y0, double x1, double y1, colour ink);
void mps__canvas_box(canvas *c, const pixel_box *box, colour ink);
/* A ring with a white middle. */
void mps__canvas_ring(canvas *c, double x, double y, double radius, colour ink);
/* A triangle from the middle of its base to its tip. */
void mps__canvas_tip(canvas *c, double x, double y, double width, double height, colour ink);
/* An arrow with its head at the end. */
void mps__canvas_arrow(canvas *c, double x0, double y0, double x1, double y1, colour ink);
/* UTF-8; y is the base line. Bytes that are not UTF-8 become '?', a text wider than `most` [pixels]
 * ends with an ellipsis; 0: no limit. */
void mps__canvas_text(canvas *c, double x, double y, text_style style, double most,
                      const char *text);
/* Whether letters can be drawn: not without a font, or with a broken font configuration. */
bool mps__canvas_letters(void);
double mps__canvas_text_width(canvas *c, text_style style, const char *text);

/* Write a PNG. @return MPS_E_IO with the system's reason, MPS_E_NOMEM; no partial file is left */
mps_status mps__canvas_save(canvas *c, const char *path, page_errors *e);

#endif

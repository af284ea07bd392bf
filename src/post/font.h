/* SPDX-License-Identifier: BSD-3-Clause */
/* A small bitmap font: digits, small letters and what units need. */
#ifndef MPS_POST_FONT_H
#define MPS_POST_FONT_H

enum { FONT_WIDTH = 5, FONT_HEIGHT = 7 };

/* Rows of a glyph from the top, bit 4 is the left column; NULL for a blank. */
const unsigned char *mps__font_rows(char character);

#endif

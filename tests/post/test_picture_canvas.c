/* SPDX-License-Identifier: BSD-3-Clause */
/* The canvas of pictures: objects outside of it, thinner than a pixel, or invalid texts. */
#include "picture_canvas.h"
#include "picture_fixture.h"

enum { WIDTH = 60, HEIGHT = 40 };

/* Pixels that are not white. */
static int inked(const canvas *c)
{
    int count = 0;
    for (int y = 0; y < c->height; y++)
        for (int x = 0; x < c->width; x++)
            count += (c->pixel[y * c->stride + x] & 0xffffff) != 0xffffff;
    return count;
}

static uint32_t pixel(const canvas *c, int x, int y)
{
    return c->pixel[y * c->stride + x] & 0xffffff;
}

static canvas new_canvas(void)
{
    canvas c;
    assert_true(mps__canvas_create(&c, WIDTH, HEIGHT, 1));
    assert_int_equal(inked(&c), 0);
    return c;
}

static void dots(void **state)
{
    static const int beside[][2] = {{9, 20}, {30, 20}, {20, 4}, {20, 25}};
    static const int outside[][2] = {{-1, 5}, {5, -1}, {WIDTH, 5}, {5, HEIGHT}};
    const pixel_box clip = {10, 5, 20, 20}, all = {-100, -100, 1000, 1000};
    const colour black = {0, 0, 0};
    canvas c = new_canvas();
    (void)state;
    for (int k = 0; k < 4; k++) {
        mps__canvas_dot(&c, &clip, beside[k][0], beside[k][1], black, 1);
        mps__canvas_dot(&c, &all, outside[k][0], outside[k][1], black, 1);
    }
    mps__canvas_dot(&c, &clip, 20, 20, black, 0);
    mps__canvas_dot(&c, &clip, 20, 20, black, NAN);
    assert_int_equal(inked(&c), 0);
    mps__canvas_dot(&c, &clip, 10, 5, black, 2); /* as 1 */
    mps__canvas_dot(&c, &clip, 29, 24, black, 0.5);
    assert_int_equal(pixel(&c, 10, 5), 0);
    assert_int_equal(pixel(&c, 29, 24), 0x808080);
    assert_int_equal(inked(&c), 2);
    mps__canvas_destroy(&c);
}

static void discs(void **state)
{
    static const double nowhere[][2] = {{NAN, 5},  {5, NAN}, {1e7, 5},
                                        {-1e7, 5}, {5, 1e7}, {5, -1e7}};
    const pixel_box all = {0, 0, WIDTH, HEIGHT};
    const colour black = {0, 0, 0};
    canvas c = new_canvas();
    (void)state;
    for (int k = 0; k < 6; k++) mps__canvas_disc(&c, &all, nowhere[k][0], nowhere[k][1], 4, black);
    assert_int_equal(inked(&c), 0);
    mps__canvas_disc(&c, &all, 20.5, 20.5, 0.25,
                     black); /* a quarter of the area of a whole pixel */
    assert_int_equal(pixel(&c, 20, 20), 0xbfbfbf);
    mps__canvas_disc(&c, &all, 40.5, 20.5, 5, black);
    assert_int_equal(pixel(&c, 44, 20), 0);
    assert_int_equal(pixel(&c, 47, 20), 0xffffff);
    mps__canvas_destroy(&c);
}

/* An arrow of no length has no direction. */
static void arrows(void **state)
{
    canvas c = new_canvas();
    (void)state;
    mps__canvas_arrow(&c, 20, 20, 20, 20, mps__ink);
    mps__canvas_pixels_begin(&c);
    assert_int_equal(inked(&c), 0);
    mps__canvas_arrow(&c, 5, 20, 50, 20, mps__ink);
    mps__canvas_pixels_begin(&c);
    assert_true(inked(&c) > 45);
    mps__canvas_destroy(&c);
}

/* What is no character is drawn as '?': bytes of other codes, half a character, forms that are too
 * long, surrogates, control codes. */
static void characters(void **state)
{
    static const char *const wrong[] = {"\xff",
                                        "\x80",
                                        "\xc3(",
                                        "\xc0\xaf",
                                        "\xe0\x80\xaf",
                                        "\xed\xa0\x80",
                                        "\xf4\x90\x80\x80",
                                        "\x7f",
                                        "\x1b",
                                        "\xf0\x80\x80\x80"};
    static const char *const good[] = {"a", "\xc3\xa9", "\xe2\x82\xac", "\xf0\x9d\x84\x9e"};
    static const char *const as[] = {"?", "?", "?(", "??", "???", "???", "????", "?", "?", "????"};
    const text_style style = {.size = 14, .ink = {0, 0, 0}};
    canvas c = new_canvas();
    (void)state;
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++)
        ASSERT_NEAR(mps__canvas_text_width(&c, style, wrong[k]),
                    mps__canvas_text_width(&c, style, as[k]), 1e-9);
    for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
        char twice[12];
        snprintf(twice, sizeof twice, "%s%s", good[k], good[k]);
        const double one = mps__canvas_text_width(&c, style, good[k]);
        assert_true(one > 0);
        ASSERT_NEAR(mps__canvas_text_width(&c, style, twice), 2 * one, 1e-6);
    }
    mps__canvas_destroy(&c);
}

/* A text that is too wide ends with an ellipsis behind a whole character; one of thousands of bytes
 * is cut. */
static void wide_texts(void **state)
{
    const text_style style = {.size = 12, .ink = {0, 0, 0}};
    char many[2000] = "";
    canvas c = new_canvas();
    (void)state;
    for (int k = 0; k < 300; k++) strcat(many, "\xe2\x82\xac");
    mps__canvas_text(&c, 2, 20, style, 30, many);
    mps__canvas_pixels_begin(&c);
    assert_true(inked(&c) > 10);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 34; x < WIDTH; x++) assert_int_equal(pixel(&c, x, y), 0xffffff);
    assert_int_equal(cairo_status(c.cairo), CAIRO_STATUS_SUCCESS);
    assert_true(mps__canvas_text_width(&c, style, many) <
                200 * mps__canvas_text_width(&c, style, "\xe2\x82\xac"));
    mps__canvas_destroy(&c);
}

/* A sheet on which drawing has failed is not written. */
static void failed_sheet(void **state)
{
    char text[200] = "";
    page_errors e = {text, sizeof text};
    canvas c = new_canvas();
    (void)state;
    cairo_restore(c.cairo); /* nothing was saved: an error that stays */
    assert_int_equal(mps__canvas_save(&c, "test_picture_canvas.png", &e), MPS_E_NOMEM);
    assert_string_equal(text, "no memory for the picture 'test_picture_canvas.png'");
    assert_false(exists("test_picture_canvas.png"));
    mps__canvas_destroy(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dots),       cmocka_unit_test(discs),      cmocka_unit_test(arrows),
        cmocka_unit_test(characters), cmocka_unit_test(wide_texts), cmocka_unit_test(failed_sheet)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

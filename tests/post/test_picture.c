/* SPDX-License-Identifier: BSD-3-Clause */
/* Colours of the pictures that the drivers draw: rounding is dark, pressures are bright. */
#include "picture.h"
#include "tank_fixture.h"
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { RIGHT = 132 }; /* pixels of the scale, which has all colours */

/* Number of yellow pixels left of the scale, the colour of the largest pressures. */
static int64_t count_bright(const char *path)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    int64_t count = 0;
    assert_true(png_image_begin_read_from_file(&image, path));
    image.format = PNG_FORMAT_RGB;
    unsigned char *pixel = malloc(PNG_IMAGE_SIZE(image));
    assert_non_null(pixel);
    assert_true(png_image_finish_read(&image, NULL, pixel, 0, NULL));
    for (uint32_t y = 0; y < image.height; y++)
        for (uint32_t x = 0; x + RIGHT < image.width; x++) {
            const unsigned char *p = pixel + 3 * ((size_t)y * image.width + x);
            count += p[0] > 150 && p[1] > 200 && p[2] < 110;
        }
    free(pixel);
    return count;
}

/* Water with a pressure that grows from 0 to `most` along the particles. */
static int64_t bright_of(double most, double gravity)
{
    static const char path[] = "test_picture.png";
    mps_sim *sim = new_sim(2, 0.05);
    mps_lease p = {.struct_size = sizeof p};
    add_tank(sim, 0.5, 0.5, 0);
    fill_depth(sim, 0.5, 0.3, 0);
    ASSERT_OK(sim, mps_lease_begin(sim, "pressure", MPS_WRITE, &p));
    for (int64_t i = 0; i < p.count; i++) p.data[i] = most * (double)i / (double)p.count;
    ASSERT_OK(sim, mps_lease_end(sim, &p));
    char error[PICTURE_ERROR];
    assert_true(mps__picture_save(sim, gravity, path, error));
    mps_sim_destroy(sim);
    const int64_t count = count_bright(path);
    remove(path);
    return count;
}

static void rounding_is_dark(void **state)
{
    (void)state;
    assert_true(bright_of(1000, 9.81) > 1000);
    assert_int_equal(bright_of(1e-9, 9.81), 0);
    assert_true(bright_of(1e-9, 0) > 1000); /* at rest without gravity it may be all there is */
}

/* One line with the reason, whatever the library failed at before. */
static void reasons(void **state)
{
    (void)state;
    char text[PICTURE_ERROR];
    mps_sim *sim = new_sim(2, 0.05);
    mps_lease p = {.struct_size = sizeof p};
    add_tank(sim, 0.5, 0.5, 0);
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_STATE, "no fluid");
    assert_false(mps__picture_save(sim, 9.81, "no/such/folder.png", text));
    assert_non_null(strstr(text, "no/such/folder.png: no picture: "));
    assert_null(strstr(text, "fluid"));
    assert_null(strchr(text, '\n'));
    ASSERT_OK(sim, mps_lease_begin(sim, "pressure", MPS_WRITE, &p));
    assert_false(mps__picture_save(sim, 9.81, "leased.png", text));
    assert_non_null(strstr(text, "leased.png: no picture: "));
    assert_true(strlen(text) > strlen("leased.png: no picture: ") + 5);
    ASSERT_OK(sim, mps_lease_end(sim, &p));
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(rounding_is_dark),
                                       cmocka_unit_test(reasons)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Pictures of a simulation, pixel by pixel. */
#include "picture_fixture.h"

static const char path[] = "test_picture.png";

/* One particle has the largest pressure, all others zero: only this one is yellow, at its position
 * in the axes. */
static void disc_at_its_place(void **state)
{
    (void)state;
    char error[200];
    mps_sim *sim = wet_tank(2);
    mps_picture_config config = new_config(error, sizeof error);
    mps_lease p = {.struct_size = sizeof p}, X = {.struct_size = sizeof X};
    config.pressure_hi = 1000;
    const int64_t hot = set_pressures(sim, 0, 0, 0.3, 0.1);
    ASSERT_OK(sim, mps_lease_begin(sim, "pressure", MPS_WRITE, &p));
    p.data[hot] = 2000; /* above the scale */
    ASSERT_OK(sim, mps_lease_end(sim, &p));
    assert_int_equal(mps_picture_save(sim, &config, path), MPS_OK);
    const sheet s = read_sheet(path);
    const place at_tank = find_place(&s, 0.8, 0.05);
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_READ, &X));
    const double x = X.data[2 * hot], y = X.data[2 * hot + 1];
    const double r = 0.025; /* half a spacing: the disc at true size */
    assert_true(is_colour(at_metres(&s, &at_tank, x, y), 0.99, 0.93, 0.25));
    assert_true(is_colour(at_metres(&s, &at_tank, x + 0.9 * r, y), 0.99, 0.93, 0.25));
    assert_true(is_colour(at_metres(&s, &at_tank, x, y - 0.9 * r), 0.99, 0.93, 0.25));
    assert_false(is_colour(at_metres(&s, &at_tank, x + 1.1 * r, y), 0.99, 0.93, 0.25));
    assert_true(is_colour(at_metres(&s, &at_tank, x - 2 * r, y), 0.07, 0.13, 0.42));
    assert_true(is_colour(at_metres(&s, &at_tank, x + r, y + r), 1, 1, 1)); /* between four discs */
    assert_true(is_colour(at_metres(&s, &at_tank, 0.4, 0.4), 1, 1, 1));     /* above the water */
    assert_true(is_colour(at_metres(&s, &at_tank, 0.8, 0.5), 0.60, 0.62, 0.65));
    assert_true(is_colour(at_metres(&s, &at_tank, 0, 0), 0.60, 0.62, 0.65));
    ASSERT_OK(sim, mps_lease_end(sim, &X));
    free(s.pixel);
    mps_sim_destroy(sim);
    remove(path);
}

/* The colour bar, to the right of the tank, ranges from the least pressure at the bottom to the
 * largest at the top. */
static void bar_ends(void **state)
{
    (void)state;
    char error[200];
    mps_sim *sim = wet_tank(2);
    mps_picture_config config = new_config(error, sizeof error);
    int low[4], high[4], walls[4];
    config.pressure_lo = -500;
    config.pressure_hi = 500;
    set_pressures(sim, 0, 0, 0, 0); /* all in the middle of the map */
    assert_int_equal(mps_picture_save(sim, &config, path), MPS_OK);
    const sheet s = read_sheet(path);
    assert_true(span_of(&s, least_colour, 1, low) > 10);
    assert_true(span_of(&s, most_colour, 1, high) > 10);
    span_of(&s, wall_colour, 1, walls);
    assert_true(low[0] > walls[2] && high[0] > walls[2] && low[0] == high[0]);
    assert_true(high[3] < low[1]);
    assert_in_range(low[3] - high[3], 300, 420);
    assert_true(is_colour(at(&s, low[0] + 5, 0.5 * (high[3] + low[1])), 0.22, 0.69, 0.66));
    const place at_tank = find_place(&s, 0.8, 0.05);
    assert_true(is_colour(at_metres(&s, &at_tank, 0.4, 0.1), 0.22, 0.69, 0.66));
    free(s.pixel);
    mps_sim_destroy(sim);
    remove(path);
}

/* Rings at sensors, also if the tank has moved and rotated: pictures are drawn in its frame. */
static void sensor_marks(void **state)
{
    (void)state;
    char error[200];
    const mps_harmonic roll = {.dof = MPS_ROTATE_Z, .amplitude = 0.2, .phase = 1.5707963267948966};
    for (int turned = 0; turned < 2; turned++) {
        mps_sim *sim = wet_tank(2);
        mps_picture_config config = new_config(error, sizeof error);
        add_sensor(sim, MPS_PROBE_WALL_PRESSURE, "P1", 0, 0.4, 0);
        add_sensor(sim, MPS_PROBE_GAUGE, "eta", 0.6, 0, 0);
        if (turned) ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &roll));
        assert_int_equal(mps_picture_save(sim, &config, path), MPS_OK);
        sheet s = read_sheet(path);
        place at_tank = find_place(&s, 0.8, 0.05);
        const double ring = 5.5 / at_tank.scale;
        assert_true(is_colour(at_metres(&s, &at_tank, 0, 0.4), 1, 1, 1));
        assert_true(is_colour(at_metres(&s, &at_tank, 0, 0.4 + ring), 0.84, 0.37, 0));
        assert_true(is_colour(at_metres(&s, &at_tank, 0, 0.4 - ring), 0.84, 0.37, 0));
        int marks[4], dashes = 0;
        assert_in_range(span_of(&s, mark_colour, 0, marks), 20, 100); /* one ring */
        for (double y = 0.3; y < 0.45; y += 0.002)
            dashes += !is_colour(at_metres(&s, &at_tank, 0.6, y), 1, 1, 1);
        assert_in_range(dashes, 20, 74); /* broken */
        free(s.pixel);
        config.sensors = 0;
        assert_int_equal(mps_picture_save(sim, &config, path), MPS_OK);
        s = read_sheet(path);
        assert_int_equal(span_of(&s, mark_colour, 0, marks), 0);
        free(s.pixel);
        mps_sim_destroy(sim);
    }
    remove(path);
}

/* Non-white pixels next to the time: the arrow of gravity. */
static int count_head(const char *file)
{
    const sheet s = read_sheet(file);
    int count = 0;
    for (int y = 10; y < 50; y++)
        for (int x = s.width / 2; x < s.width; x++) count += !is_colour(at(&s, x, y), 1, 1, 1);
    free(s.pixel);
    return count;
}

static void arrow_of_gravity(void **state)
{
    (void)state;
    const mps_harmonic roll = {.dof = MPS_ROTATE_Z, .amplitude = 0.2, .phase = 1.5707963267948966};
    char error[200];
    mps_sim *sim = wet_tank(2);
    mps_picture_config config = new_config(error, sizeof error);
    assert_int_equal(mps_picture_save(sim, &config, path), MPS_OK);
    const int upright = count_head(path);
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &roll));
    assert_int_equal(mps_picture_save(sim, &config, path), MPS_OK);
    assert_true(upright > 300 && count_head(path) > upright + 300);
    mps_sim_destroy(sim);
    remove(path);
}

/* The first picture with a pressure fixes the scale; one without does not. */
static void one_scale(void **state)
{
    (void)state;
    char error[200];
    mps_sim *sim = wet_tank(2);
    mps_picture_config config = new_config(error, sizeof error);
    set_pressures(sim, 1e-6, 0, 0, 0);
    assert_int_equal(mps_picture_save(sim, &config, path), MPS_OK);
    assert_true(config.pressure_lo == 0 && config.pressure_hi == 0);
    set_pressures(sim, 0, 9810, 0, 0);
    assert_int_equal(mps_picture_save(sim, &config, path), MPS_OK);
    /* twice the height of the centre of mass above the lowest row, 0.2 m; two digits, rounded up */
    ASSERT_NEAR(config.pressure_hi, 2500, 1e-6);
    assert_true(config.pressure_lo == 0);
    set_pressures(sim, 50000, 0, 0, 0);
    assert_int_equal(mps_picture_save(sim, &config, path), MPS_OK);
    ASSERT_NEAR(config.pressure_hi, 2500, 1e-6);
    config = new_config(error, sizeof error);
    assert_int_equal(mps_picture_save(sim, &config, path), MPS_OK);
    ASSERT_NEAR(config.pressure_hi, 50000, 1e-6); /* the quantile is the larger one */
    mps_sim_destroy(sim);
    remove(path);
}

static void same_bytes(void **state)
{
    (void)state;
    char error[200];
    long size[2];
    char *bytes[2];
    for (int32_t dim = 2; dim <= 3; dim++) {
        mps_sim *sim = wet_tank(dim);
        set_pressures(sim, 0, 9810, 0, 0);
        for (int k = 0; k < 2; k++) {
            mps_picture_config config = new_config(error, sizeof error);
            config.title = "A tank, \xc3\xb8 0.8 m";
            assert_int_equal(mps_picture_save(sim, &config, path), MPS_OK);
            bytes[k] = read_whole(path, &size[k]);
        }
        assert_int_equal(size[0], size[1]);
        assert_memory_equal(bytes[0], bytes[1], (size_t)size[0]);
        free(bytes[0]);
        free(bytes[1]);
        mps_sim_destroy(sim);
    }
    remove(path);
}

/* Widths, titles that are too long or no text at all. */
static void sizes_and_titles(void **state)
{
    (void)state;
    static const char *const title[] = {NULL, "", "\xff\xfe broken \xe2\x80", "tab\tand\nline",
                                        "\xed\xa0\x80 surrogate"};
    static const int32_t width[] = {400, 401, 1280, 2000};
    char error[200], endless[2000];
    mps_sim *sim = wet_tank(2);
    for (int k = 0; k < 4; k++) {
        mps_picture_config config = new_config(error, sizeof error);
        config.width = width[k];
        assert_int_equal(mps_picture_save(sim, &config, path), MPS_OK);
        const sheet s = read_sheet(path);
        assert_int_equal(s.width, width[k] + width[k] % 2);
        assert_int_equal(s.height % 2, 0);
        free(s.pixel);
    }
    memset(endless, 'w', sizeof endless - 1);
    endless[sizeof endless - 1] = '\0';
    for (int k = 0; k < 6; k++) {
        mps_picture_config config = new_config(error, sizeof error);
        config.title = k < 5 ? title[k] : endless;
        assert_int_equal(mps_picture_save(sim, &config, path), MPS_OK);
    }
    const sheet s = read_sheet(path); /* the long one ends before the time */
    int gap = 0;
    for (int x = s.width - 200; x < s.width - 24; x++) {
        bool white = true;
        for (int y = 20; y < 46; y++) white = white && is_colour(at(&s, x, y), 1, 1, 1);
        gap += white;
    }
    assert_true(gap > 20);
    free(s.pixel);
    mps_sim_destroy(sim);
    remove(path);
}

/* In 3-D the view of the whole liquid is above the slice: both have the colours of the water, and
 * the disc is at its position in the slice. */
static void two_views(void **state)
{
    (void)state;
    char error[200];
    mps_sim *sim = wet_tank(3);
    mps_picture_config config = new_config(error, sizeof error);
    config.pressure_hi = 1000;
    set_pressures(sim, 2000, 0, 0, 0);
    add_sensor(sim, MPS_PROBE_WALL_PRESSURE, "P1", 0, 0.4, 0.2);
    assert_int_equal(mps_picture_save(sim, &config, path), MPS_OK);
    const sheet s = read_sheet(path);
    int walls[4], rings[4], lit = 0;
    assert_true(span_of(&s, wall_colour, 1, walls) > 100);
    for (int y = 60; y < walls[1] - 60; y++)
        for (int x = 0; x < walls[2]; x++) {
            const uint32_t pixel = at(&s, x, y);
            lit += (pixel >> 16) > 120 && (pixel >> 8 & 255) > 110 && (pixel & 255) < 120;
        }
    assert_true(lit > 5000); /* yellow with light and shade */
    assert_true(span_of(&s, mark_colour, 0, rings) > 40);
    assert_true(rings[1] < walls[1] && rings[3] > walls[1]); /* one in each view */
    const place at_tank = find_place(&s, 0.8, 0.05);
    assert_true(is_colour(at_metres(&s, &at_tank, 0.4, 0.1), 0.99, 0.93, 0.25));
    assert_true(is_colour(at_metres(&s, &at_tank, 0.4, 0.4), 1, 1, 1));
    free(s.pixel);
    mps_sim_destroy(sim);
    remove(path);
}

static void assert_refused(mps_sim *sim, mps_picture_config *config, const char *file,
                           mps_status wanted, const char *word)
{
    assert_int_equal(mps_picture_save(sim, config, file), wanted);
    if (!strstr(config->error, word)) fail_msg("'%s' does not mention '%s'", config->error, word);
}

static void refusals(void **state)
{
    (void)state;
    char error[300] = "";
    remove(path);
    mps_sim *sim = wet_tank(2), *empty = new_sim(2, 0.05);
    mps_lease p = {.struct_size = sizeof p};
    mps_picture_config config = new_config(error, sizeof error), bare = {0};
    assert_int_equal(mps_picture_config_init(NULL, sizeof config), MPS_E_ARG);
    assert_int_equal(mps_picture_config_init(&config, sizeof config - 8), MPS_E_VERSION);
    assert_int_equal(mps_picture_save(sim, NULL, path), MPS_E_ARG);
    assert_int_equal(mps_picture_save(sim, &bare, path), MPS_E_ARG);
    assert_refused(NULL, &config, path, MPS_E_ARG, "NULL");
    assert_refused(sim, &config, NULL, MPS_E_ARG, "file name");
    assert_refused(sim, &config, "no/such/folder.png", MPS_E_IO, "no/such/folder.png");
    assert_refused(sim, &config, "/dev/full", MPS_E_IO, "No space left");
    assert_true(exists("/dev/full"));
    assert_refused(sim, &config, ".", MPS_E_IO, "directory");
    assert_refused(empty, &config, path, MPS_E_ARG, "no particle");
    ASSERT_OK(sim, mps_lease_begin(sim, "pressure", MPS_WRITE, &p));
    assert_refused(sim, &config, path, MPS_E_BUSY, "pressure");
    ASSERT_OK(sim, mps_lease_end(sim, &p));
    config.width = 399;
    assert_refused(sim, &config, path, MPS_E_ARG, "width");
    config.width = 400;
    config.gravity = -1;
    assert_refused(sim, &config, path, MPS_E_ARG, "gravity");
    config.gravity = 0;
    config.pressure_hi = NAN;
    assert_refused(sim, &config, path, MPS_E_ARG, "finite");
    assert_false(exists(path));
    config.pressure_hi = 0;
    assert_int_equal(mps_picture_save(sim, &config, path), MPS_OK);
    mps_sim_destroy(sim);
    mps_sim_destroy(empty);
    remove(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(disc_at_its_place), cmocka_unit_test(bar_ends),
        cmocka_unit_test(sensor_marks),      cmocka_unit_test(arrow_of_gravity),
        cmocka_unit_test(one_scale),         cmocka_unit_test(same_bytes),
        cmocka_unit_test(sizes_and_titles),  cmocka_unit_test(two_views),
        cmocka_unit_test(refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

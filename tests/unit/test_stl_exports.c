/* SPDX-License-Identifier: BSD-3-Clause */
/* STL files in the formats of programs: text in many forms, bytes after the end, gaps, several
 * surfaces. */
#include "stl_fixture.h"

static char warned[4000];

static void note(void *user, int level, const char *text)
{
    (void)user;
    if (level >= MPS_LOG_WARNING)
        snprintf(warned + strlen(warned), sizeof warned - strlen(warned), "%s\n", text);
}

/* Walls of the box as a container, and its warnings. */
static int64_t walls_of_file(void)
{
    mps_config config;
    mps_sim *sim;
    mps_stl stl;
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dim = 3;
    config.dp = 0.4;
    config.log = note;
    warned[0] = 0;
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    assert_int_equal(mps_stl_init(&stl, sizeof stl), MPS_OK);
    stl.container = 1;
    ASSERT_OK(sim, mps_stl_add(sim, path, &stl, NULL));
    const int64_t walls = mps_particles_count(sim, MPS_WALL);
    mps_sim_destroy(sim);
    return walls;
}

static void expect_warning(const char *word)
{
    if (word ? !strstr(warned, word) : warned[0])
        fail_msg("\"%s\" instead of \"%s\"", warned, word ? word : "");
}

static size_t text_of(const triangles *t, const char *end, const char *begin, const char *last,
                      char *text, size_t size)
{
    size_t used = (size_t)snprintf(text, size, "%s%s", begin, end);
    for (int i = 0; i < t->count; i++) {
        const float *x = t->x[i];
        used += (size_t)snprintf(text + used, size - used, "facet normal 0 0 0%souter loop%s", end,
                                 end);
        for (int k = 0; k < 3; k++)
            used += (size_t)snprintf(text + used, size - used, "vertex %g %g %g%s", x[3 * k],
                                     x[3 * k + 1], x[3 * k + 2], end);
        used += (size_t)snprintf(text + used, size - used, "endloop%sendfacet%s", end, end);
    }
    return used + (size_t)snprintf(text + used, size - used, "%s", last);
}

/* The same box for any text before the first word and any line ends. */
static void texts(void **state)
{
    static const struct {
        const char *end, *begin, *last, *warning;
    } form[] = {
        {"\n", "solid", "endsolid\n", NULL},
        {"\n", " solid box", "endsolid box\n", NULL},
        {"\n", "\n\r\nSOLID box", "ENDSOLID\n", NULL},
        {"\n", "\xef\xbb\xbfsolid box", "endsolid\n", NULL},
        {"\r", "solid box of a facet", "endsolid\r", NULL},
        {"\r\n", "Solid r\xe9servoir", "endsolid\r\n\x1a", NULL},
        {"\n", "solid box", "", "no \"endsolid\""},
        {"\n", "solid empty\nendsolid empty\nsolid box", "endsolid\n", NULL},
        {"\n", "solid empty\nsolid box", "endsolid\n", NULL},
    };
    (void)state;
    const triangles t = box_mesh();
    write_binary(&t);
    const int64_t walls = walls_of_file();
    expect_warning(NULL);
    for (size_t k = 0; k < sizeof form / sizeof *form; k++) {
        char text[8000];
        write_bytes(text, text_of(&t, form[k].end, form[k].begin, form[k].last, text, sizeof text));
        assert_int_equal(walls_of_file(), walls);
        expect_warning(form[k].warning);
    }
}

static void utf16_is_named(void **state)
{
    static const unsigned char text[] = {0xff, 0xfe, 's', 0, 'o', 0, 'l', 0, 'i', 0, 'd', 0};
    mps_sim *sim = new_sim(3, 0.4);
    mps_stl stl;
    (void)state;
    write_bytes(text, sizeof text);
    assert_int_equal(mps_stl_init(&stl, sizeof stl), MPS_OK);
    ASSERT_REFUSED(sim, mps_stl_add(sim, path, &stl, NULL), MPS_E_IO, "UTF-16");
    mps_sim_destroy(sim);
}

static void bytes_behind_the_end(void **state)
{
    unsigned char *bytes, longer[1000] = {0};
    (void)state;
    const triangles t = box_mesh();
    const size_t size = binary_of(&t, &bytes);
    memcpy(longer, bytes, size);
    free(bytes);
    write_bytes(longer, size + 92);
    walls_of_file();
    expect_warning("92 bytes behind the last triangle");
}

static void gaps(void **state)
{
    triangles t = box_mesh();
    mps_stl stl;
    (void)state;
    write_binary(&t);
    const int64_t walls = walls_of_file();
    t.x[0][0] += 1e-3f; /* 0.0025 dp */
    t.x[7][5] -= 2e-3f;
    write_binary(&t);
    assert_int_equal(walls_of_file(), walls);
    expect_warning("gaps of up to 0.002 m: 2 points are");
    t.x[0][0] += 0.01f;
    write_binary(&t);
    mps_sim *sim = new_sim(3, 0.4);
    assert_int_equal(mps_stl_init(&stl, sizeof stl), MPS_OK);
    ASSERT_REFUSED(sim, mps_stl_add(sim, path, &stl, NULL), MPS_E_ARG, "gaps of up to 0.004 m");
    mps_sim_destroy(sim);
}

/* The box again, about its centre, larger or smaller, shifted, inside out. */
static void add_box(triangles *t, double scale, double shift, bool turned)
{
    const triangles one = box_mesh();
    static const double centre[3] = {1, 0.6, 0.8};
    for (int i = 0; i < one.count; i++) {
        double x[3][3];
        for (int k = 0; k < 3; k++)
            for (int d = 0; d < 3; d++)
                x[k][d] = centre[d] + scale * (one.x[i][3 * k + d] - centre[d]) +
                          (d == 0 ? shift : 0);
        add_triangle(t, x[0], x[turned ? 2 : 1], x[turned ? 1 : 2]);
    }
}

static void several_surfaces(void **state)
{
    static const struct {
        double scale, shift;
        bool turned;
        const char *warning;
    } second[] = {
        {1, 0, false, "12 triangles are there twice"}, {1.5, 0, true, "inner surface alone"},
        {0.6, 0, false, "of its box not once"},        {1, 0.9, false, "of its box not once"},
        {1, 4, false, "apart from each other"},
    };
    (void)state;
    for (size_t k = 0; k < sizeof second / sizeof *second; k++) {
        triangles t = box_mesh();
        add_box(&t, second[k].scale, second[k].shift, second[k].turned);
        write_binary(&t);
        walls_of_file();
        expect_warning(second[k].warning);
    }
}

static void add_quad(triangles *t, const double *a, const double *b, const double *c,
                     const double *d)
{
    add_triangle(t, a, b, c);
    add_triangle(t, a, c, d);
}

/* A tank with a pleated roof: pleats of a quarter of dp have more surface than walls can show. */
static void fine_parts(void **state)
{
    enum { PLEATS = 40 };
    triangles t = {0};
    (void)state;
    for (int i = 0; i < PLEATS; i++) {
        double x[2][4][3]; /* two sections, corners (bottom, roof) at z = 0, then at z = 2 */
        for (int k = 0; k < 2; k++)
            for (int n = 0; n < 4; n++) {
                x[k][n][0] = 4.0 * (i + k) / PLEATS;
                x[k][n][1] = n % 2 ? ((i + k) % 2 ? 2.6 : 2) : 0;
                x[k][n][2] = n < 2 ? 0 : 2;
            }
        add_quad(&t, x[0][1], x[0][3], x[1][3], x[1][1]);
        add_quad(&t, x[0][0], x[1][0], x[1][2], x[0][2]);
        add_quad(&t, x[0][0], x[0][1], x[1][1], x[1][0]);
        add_quad(&t, x[0][2], x[1][2], x[1][3], x[0][3]);
        if (i == 0) add_quad(&t, x[0][0], x[0][2], x[0][3], x[0][1]);
        if (i == PLEATS - 1) add_quad(&t, x[1][0], x[1][1], x[1][3], x[1][2]);
    }
    write_binary(&t);
    walls_of_file();
    expect_warning("where its surface has");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texts),
        cmocka_unit_test(utf16_is_named),
        cmocka_unit_test(bytes_behind_the_end),
        cmocka_unit_test(gaps),
        cmocka_unit_test(several_surfaces),
        cmocka_unit_test(fine_parts),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

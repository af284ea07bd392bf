/* SPDX-License-Identifier: BSD-3-Clause */
/* Wall particles of random solids: one for every dp^(dim-1) of surface, for any sides in
 * spacings. */
#include "stl_fixture.h"

/* after cmocka.h */
#include "../turns.h"

enum { CORNERS = 8 };

static uint32_t seed;

/* Between two numbers; the same sequence on every machine. */
static double between(double from, double to)
{
    seed = 1664525u * seed + 1013904223u;
    return from + (to - from) * (seed >> 8) / 16777216.0;
}

/* A convex prism: corners counterclockwise, 0 <= z <= width; rotated about the origin. */
typedef struct prism {
    int dim, corners;
    double p[CORNERS][2], width, turn[3];
    bool body;
} prism;

static double side_length(const prism *s, int i)
{
    const double *a = s->p[i], *b = s->p[(i + 1) % s->corners];
    return hypot(b[0] - a[0], b[1] - a[1]);
}

static double surface_of(const prism *s)
{
    double around = 0, twice = 0;
    for (int i = 0; i < s->corners; i++) {
        const double *a = s->p[i], *b = s->p[(i + 1) % s->corners];
        around += side_length(s, i);
        twice += a[0] * b[1] - b[0] * a[1];
    }
    return s->dim == 2 ? around : around * s->width + twice;
}

/* About z, then about x and y; forward or back. */
static void turn_place(const prism *s, bool back, double *x)
{
    static const int plane[3][2] = {{0, 1}, {1, 2}, {2, 0}};
    for (int n = 0; n < (s->dim == 2 ? 1 : 3); n++) {
        const int k = back && s->dim == 3 ? 2 - n : n, *d = plane[k];
        const double angle = back ? -s->turn[k] : s->turn[k], a = x[d[0]], b = x[d[1]];
        x[d[0]] = cos(angle) * a - sin(angle) * b;
        x[d[1]] = sin(angle) * a + cos(angle) * b;
    }
}

static double in_prism(void *user, const double *place)
{
    const prism *s = user;
    double x[3] = {place[0], place[1], s->dim == 3 ? place[2] : 0}, least = INFINITY;
    turn_place(s, true, x);
    for (int i = 0; i < s->corners; i++) {
        const double *a = s->p[i], *b = s->p[(i + 1) % s->corners];
        least = fmin(least, ((b[0] - a[0]) * (x[1] - a[1]) - (b[1] - a[1]) * (x[0] - a[0])) /
                                side_length(s, i));
    }
    if (s->dim == 3) least = fmin(least, fmin(x[2], s->width - x[2]));
    return s->body ? -least : least;
}

/* Kinds: box, chamfered box, and both of them rotated. */
static prism random_prism(int dim, int kind, double most)
{
    prism s = {.dim = dim, .width = between(6, most)};
    const double x = between(6, most), y = between(6, most),
                 c = kind % 2 ? between(0.1, 0.45) * fmin(x, y) : 0;
    const double corner[CORNERS][2] = {{c, 0},     {x - c, 0}, {x, c},     {x, y - c},
                                       {x - c, y}, {c, y},     {0, y - c}, {0, c}};
    const double rectangle[4][2] = {{0, 0}, {x, 0}, {x, y}, {0, y}};
    s.corners = kind % 2 ? 8 : 4;
    memcpy(s.p, kind % 2 ? corner[0] : rectangle[0], (size_t)s.corners * sizeof s.p[0]);
    for (int k = 0; k < 3; k++) s.turn[k] = kind >= 2 ? between(0, 6) : 0;
    return s;
}

static void place_corner(const prism *s, int i, int end, double *x)
{
    x[0] = s->p[i % s->corners][0];
    x[1] = s->p[i % s->corners][1];
    x[2] = s->dim == 3 ? end * s->width : 0;
    turn_place(s, false, x);
}

static mps_solid solid_of(prism *s)
{
    mps_solid solid;
    assert_int_equal(mps_solid_init(&solid, sizeof solid), MPS_OK);
    solid.distance = in_prism;
    solid.user = s;
    for (int d = 0; d < s->dim; d++) {
        solid.lo[d] = INFINITY;
        solid.hi[d] = -INFINITY;
        for (int i = 0; i < s->corners; i++)
            for (int end = 0; end < 2; end++) {
                double x[3];
                place_corner(s, i, end, x);
                solid.lo[d] = fmin(solid.lo[d], x[d] - (s->body ? 1 : 0));
                solid.hi[d] = fmax(solid.hi[d], x[d] + (s->body ? 1 : 0));
            }
    }
    return solid;
}

static void write_prism(const prism *s)
{
    triangles t = {0};
    double x[3][3];
    for (int i = 0; i < s->corners; i++) {
        for (int half = 0; half < 2; half++) {
            place_corner(s, i, 0, x[0]);
            place_corner(s, i + 1, half, x[1]);
            place_corner(s, i + 1 - half, 1, x[2]);
            add_triangle(&t, x[0], x[1], x[2]);
        }
        for (int end = 0; end < 2 && i > 0 && i + 1 < s->corners; end++) {
            place_corner(s, 0, end, x[0]);
            place_corner(s, end ? i : i + 1, end, x[1]);
            place_corner(s, end ? i + 1 : i, end, x[2]);
            add_triangle(&t, x[0], x[1], x[2]);
        }
    }
    write_binary(&t);
}

static void check_count(mps_sim *sim, const prism *s, const char *what)
{
    const double ratio = (double)mps_particles_count(sim, MPS_WALL) / surface_of(s);
    if (fabs(ratio - 1) > 0.06) fail_msg("%s: %.3f times surface/dp^(dim-1)", what, ratio);
    mps_sim_destroy(sim);
}

static void in_the_plane(void **state)
{
    (void)state;
    seed = 1;
    for (int n = 0; n < 80; n++) {
        prism s = random_prism(2, n % 4, 24);
        s.body = n % 8 > 3;
        mps_sim *sim = new_sim(2, 1);
        const mps_solid solid = solid_of(&s);
        ASSERT_OK(sim, mps_solid_add(sim, &solid));
        check_count(sim, &s, "polygon");
    }
}

static void in_space(void **state)
{
    (void)state;
    seed = 3;
    for (int n = 0; n < 8; n++) {
        prism s = random_prism(3, n % 4, 9);
        s.body = n % 8 > 3;
        mps_sim *sim = new_sim(3, 1);
        const mps_solid solid = solid_of(&s);
        ASSERT_OK(sim, mps_solid_add(sim, &solid));
        check_count(sim, &s, "distance");
        mps_stl stl;
        assert_int_equal(mps_stl_init(&stl, sizeof stl), MPS_OK);
        stl.container = !s.body;
        write_prism(&s);
        sim = new_sim(3, 1);
        ASSERT_OK(sim, mps_stl_add(sim, path, &stl, NULL));
        check_count(sim, &s, "STL file");
    }
}

/* Sides that are no multiples of dp, at rest: with the walls twice the pressure was 13 % too
 * high. */
static void at_rest(void **state)
{
    prism s = {.dim = 3, .corners = 4, .p = {{0, 0}, {8.3, 0}, {8.3, 6.2}, {0, 6.2}}, .width = 6.4};
    const double dp = 0.025, lo[3] = {0, 0, 0}, hi[3] = {8.3 * dp, 4 * dp, 6.4 * dp};
    const double weight = 9810 * hi[0] * hi[1] * hi[2];
    (void)state;
    for (int i = 0; i < 4; i++)
        for (int d = 0; d < 2; d++) s.p[i][d] *= dp;
    s.width *= dp;
    mps_sim *sim = new_sim(3, dp);
    mps_probe probe;
    int32_t bottom, force;
    double pressure, values[6], mean[2] = {0, 0};
    const mps_solid solid = solid_of(&s);
    ASSERT_OK(sim, mps_solid_add(sim, &solid));
    ASSERT_OK(sim, mps_fill_level_add(sim, 0, lo, hi, NULL, NULL));
    mps_probe_init(&probe, sizeof probe);
    probe.at[0] = 4 * dp;
    probe.at[2] = 3 * dp;
    ASSERT_OK(sim, mps_probe_add(sim, &probe, &bottom));
    mps_probe_init(&probe, sizeof probe);
    probe.type = MPS_PROBE_FORCE;
    probe.part = "solid";
    ASSERT_OK(sim, mps_probe_add(sim, &probe, &force));
    for (int k = 0; k < 20; k++) {
        assert_true(mps_run(sim, 0.7 + 0.015 * k, NULL, NULL) >= 0);
        ASSERT_OK(sim, mps_probe_read(sim, bottom, &pressure));
        ASSERT_OK(sim, mps_probe_read(sim, force, values));
        mean[0] += pressure / 20;
        mean[1] -= values[1] / 20;
    }
    /* for four rows 0.016 is the level within 0.07 dp; with duplicate walls it is 0.13 and more */
    ASSERT_NEAR(mean[0] / (9810 * hi[1]), 1, 0.02);
    ASSERT_NEAR(mean[1] / weight, 1, 0.02);
    mps_sim_destroy(sim);
}

int main(void)
{
    struct CMUnitTest tests[] = {
        cmocka_unit_test(in_the_plane),
        cmocka_unit_test(in_space),
        cmocka_unit_test(at_rest),
    };
    take_turns(tests, sizeof tests / sizeof tests[0], 3);
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

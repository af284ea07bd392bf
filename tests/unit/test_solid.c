/* SPDX-License-Identifier: BSD-3-Clause */
/* Solids of any shape: areas, spacing, lattice, fills, bodies in tanks, refusals. */
#include "solid_fixture.h"

/* ---- shapes, all about the origin: > 0 within a unit circle, sphere, cylinder; a box ---- */

static int outside_ball(void *user, const double *x)
{
    return ball(user, x) < 0;
}

/* Radius 1 about the x axis, 2 m long, half spheres at the ends. */
static double capsule(void *user, const double *x)
{
    const double out = fmax(fabs(x[0]) - 1, 0);
    (void)user;
    return 1 - sqrt(out * out + x[1] * x[1] + x[2] * x[2]);
}

static const double half[3] = {1, 0.6, 0.8};

static double box(void *user, const double *x)
{
    const int dim = *(const int *)user;
    double out2 = 0, most = -INFINITY;
    for (int d = 0; d < dim; d++) {
        const double q = fabs(x[d]) - half[d];
        out2 += fmax(q, 0) * fmax(q, 0);
        most = fmax(most, q);
    }
    return -(fmin(most, 0) + sqrt(out2));
}

/* The ball, but without a true distance: too steep by a varying factor. */
static double steep_ball(void *user, const double *x)
{
    return ball(user, x) * (2 + x[0]);
}

static int in_slab(void *user, const double *x)
{
    return (void)user, fabs(x[0] - 0.5) < 0.125;
}

static double column(void *user, const double *x)
{
    (void)user;
    return hypot(x[0] - 0.5, x[2] - 0.5) - 0.2;
}

/* Sums over the wall particles: |area|, area, and the volume enclosed by the areas (divergence
 * theorem). */
typedef struct sums {
    double area, net[3], volume, widest, closest;
    int64_t walls;
} sums;

static double nearest_other(const mps__particles *s, int64_t i)
{
    double least = INFINITY;
    for (int64_t j = 0; j < s->n; j++) {
        double r2 = 0;
        if (j == i || s->kind[j] != MPS_WALL) continue;
        for (int d = 0; d < s->dim; d++)
            r2 += pow(s->ref[j * s->dim + d] - s->ref[i * s->dim + d], 2);
        least = fmin(least, r2);
    }
    return sqrt(least);
}

static sums sum_walls(const mps_sim *sim)
{
    const mps__particles *s = &sim->world.particles;
    sums out = {.closest = INFINITY};
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_WALL) continue;
        const double *a = &s->area[i * s->dim], *x = &s->ref[i * s->dim],
                     r = nearest_other(s, i) / sim->world.setup.dp;
        out.walls++;
        out.area += sqrt(mps__dot(a, a, s->dim));
        out.volume -= mps__dot(a, x, s->dim) / s->dim;
        for (int d = 0; d < s->dim; d++) out.net[d] += a[d];
        out.widest = fmax(out.widest, r);
        out.closest = fmin(out.closest, r);
    }
    return out;
}

typedef struct surface_case {
    const char *name;
    int dim;
    mps_distance_fn distance;
    mps_inside_fn inside;
    double size, area, volume, area_error, closest, widest;
    int invert;
} surface_case;

/* Edge particles carry the area vectors of both faces: their lengths fall short of the surface,
 * their sums do not. */
static void surfaces(void **state)
{
    const surface_case list[] = {
        {"circle", 2, ball, NULL, 1, 2 * pi, pi, 0.01, 0.8, 1.3, 0},
        {"circle by inside", 2, NULL, outside_ball, 1, 2 * pi, pi, 0.01, 0.8, 1.3, 0},
        {"steep circle", 2, steep_ball, NULL, 1, 2 * pi, pi, 0.01, 0.8, 1.3, 0},
        {"sphere", 3, ball, NULL, 1, 4 * pi, 4 * pi / 3, 0.01, 0.7, 1.3, 0},
        {"sphere by inside", 3, NULL, outside_ball, 1, 4 * pi, 4 * pi / 3, 0.01, 0.7, 1.3, 0},
        {"a sphere as a body", 3, ball, NULL, 1.5, 4 * pi, -4 * pi / 3, 0.01, 0.7, 1.3, 1},
        {"capsule", 3, capsule, NULL, 2, 8 * pi, 4 * pi / 3 + 2 * pi, 0.01, 0.7, 1.35, 0},
        {"rectangle", 2, box, NULL, 1, 6.4, 2.4, 0.03, 0.9, 1.1, 0},
        {"box", 3, box, NULL, 1, 15.04, 1.92 * 2, 0.05, 0.9, 1.1, 0},
    };
    (void)state;
    for (size_t k = 0; k < sizeof list / sizeof list[0]; k++) {
        const surface_case *c = &list[k];
        mps_sim *sim = new_sim(c->dim, 0.1);
        mps_solid solid = solid_of(c->distance, c->inside, c->dim == 3 ? &three : &two, c->size);
        solid.invert = c->invert;
        ASSERT_OK(sim, mps_solid_add(sim, &solid));
        const sums s = sum_walls(sim);
        if (fabs(s.area / c->area - 1) > c->area_error || fabs(s.volume / c->volume - 1) > 0.01 ||
            s.closest < c->closest || s.widest > c->widest)
            fail_msg("%s: area %g of %g, volume %g of %g, neighbours %g .. %g dp", c->name, s.area,
                     c->area, s.volume, c->volume, s.closest, s.widest);
        for (int d = 0; d < c->dim; d++) ASSERT_NEAR(s.net[d], 0, 1e-12);
        assert_true(fabs((double)s.walls * pow(0.1, c->dim - 1) / c->area - 1) < 0.1);
        assert_true(mps_particles_count(sim, MPS_DUMMY) > s.walls);
        mps_sim_destroy(sim);
    }
}

/* A box on the lattice is the tank of the same size: same walls, same areas, same points for the
 * fluid. */
static void a_box_is_a_tank(void **state)
{
    (void)state;
    mps_sim *a = new_sim(2, 0.1), *b = new_sim(2, 0.1);
    add_tank(b, 2, 1.2, 0);
    mps_solid solid = solid_of(box, NULL, &two, 1);
    solid.lo[1] = -0.6;
    solid.hi[1] = 0.6;
    ASSERT_OK(a, mps_solid_add(a, &solid));
    assert_int_equal(mps_particles_count(a, MPS_WALL), mps_particles_count(b, MPS_WALL));
    const double lo[2] = {-1, -0.6}, hi[2] = {1, 0};
    int64_t added = 0;
    ASSERT_OK(a, mps_fill_box_add(a, 0, lo, hi, &added, NULL));
    assert_int_equal(added, fill_depth(b, 2, 0.6, 0));
    const mps__particles *s = &a->world.particles, *t = &b->world.particles;
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_WALL) continue;
        double best = INFINITY;
        for (int64_t j = 0; j < t->n; j++)
            if (t->kind[j] == MPS_WALL)
                best = fmin(best, hypot(t->ref[2 * j] - 1 - s->ref[2 * i],
                                        t->ref[2 * j + 1] - 0.6 - s->ref[2 * i + 1]) +
                                      hypot(t->area[2 * j] - s->area[2 * i],
                                            t->area[2 * j + 1] - s->area[2 * i + 1]));
        ASSERT_NEAR(best, 0, 0.02);
    }
    mps_sim_destroy(a);
    mps_sim_destroy(b);
}

static int everywhere(void *user, const double *x)
{
    (void)user, (void)x;
    return 1;
}

/* No fluid in the solid or in the half cells of its walls; all other points are filled. */
static void fills_keep_out(void **state)
{
    (void)state;
    const double dp = 0.05;
    mps_sim *sim = new_sim(2, dp);
    mps_solid solid = solid_of(ball, NULL, &two, 1);
    int64_t added = 0;
    ASSERT_OK(sim, mps_solid_add(sim, &solid));
    ASSERT_OK(sim, mps_fill_add(sim, 0, everywhere, NULL, &added));
    const mps__particles *s = &sim->world.particles;
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_FLUID) assert_true(ball(&two, &s->x[2 * i]) > 0.49 * dp);
    ASSERT_NEAR((double)added * dp * dp, pi * (1 - dp / 2) * (1 - dp / 2), 0.02 * pi);
    mps_sim_destroy(sim);
}

/* A second solid makes the lattice larger; outside of both boxes nothing is filled. */
static double second_ball(void *user, const double *x)
{
    const double y[3] = {x[0] - 3, x[1] - 1, 0};
    return ball(user, y);
}

static void two_tanks(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(2, 0.1);
    mps_solid solid = solid_of(ball, NULL, &two, 1);
    int64_t one = 0, both = 0;
    ASSERT_OK(sim, mps_solid_add(sim, &solid));
    ASSERT_OK(sim, mps_fill_add(sim, 0, everywhere, NULL, &one));
    solid.distance = second_ball;
    solid.name = "other";
    solid.lo[0] = 2;
    solid.hi[0] = 4;
    solid.lo[1] = 0;
    solid.hi[1] = 2;
    ASSERT_OK(sim, mps_solid_add(sim, &solid));
    ASSERT_OK(sim, mps_fill_add(sim, 0, everywhere, NULL, &both));
    assert_int_equal(both, one);
    assert_true(mps_part_find(sim, "solid") >= 0 && mps_part_find(sim, "other") >= 0);
    mps_sim_destroy(sim);
}

/* A column through a tank: walls between floor and ceiling only, the walls below it are covered. */
static void column_in_a_tank(void **state)
{
    (void)state;
    mps_sim *sim = new_sim(3, 0.05);
    add_tank(sim, 1, 0.6, 1);
    const int64_t before = mps_particles_count(sim, MPS_WALL);
    mps_solid solid = solid_of(column, NULL, NULL, 1.5);
    ASSERT_OK(sim, mps_solid_add(sim, &solid));
    const mps__particles *s = &sim->world.particles;
    const int32_t part = mps_part_find(sim, "solid");
    double area = 0;
    int64_t walls = 0;
    for (int64_t i = 0; i < s->n; i++) {
        if (s->part[i] != part || s->kind[i] != MPS_WALL) continue;
        const double *a = &s->area[3 * i], *x = &s->ref[3 * i];
        walls++;
        area += sqrt(mps__dot(a, a, 3));
        ASSERT_NEAR(hypot(x[0] - 0.5, x[2] - 0.5), 0.2, 1e-6);
        assert_true(x[1] > 0.03 && x[1] < 0.57);
    }
    ASSERT_NEAR(area, 2 * pi * 0.2 * 0.6, 0.02 * 2 * pi * 0.2 * 0.6);
    /* floor and ceiling under the column */
    const int64_t covered = before + walls - mps_particles_count(sim, MPS_WALL);
    assert_true(covered > 60 && covered < 2 * pi * 16);
    mps_sim_destroy(sim);
}

static void text_of(void *user, int level, const char *text)
{
    if (level == MPS_LOG_WARNING) snprintf(user, 256, "%s", text);
}

static void thin_plates_are_told(void **state)
{
    (void)state;
    for (int thick = 0; thick < 2; thick++) {
        char text[256] = "";
        mps_config config;
        mps_sim *sim = NULL;
        mps_config_init(&config, sizeof config);
        config.dp = thick ? 0.05 : 0.1;
        config.log = text_of;
        config.log_user = text;
        assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
        add_tank(sim, 1, 1, 0);
        mps_solid solid = solid_of(NULL, in_slab, NULL, 2);
        ASSERT_OK(sim, mps_solid_add(sim, &solid));
        assert_int_equal(strstr(text, "thinner than 3 dp") != NULL, !thick);
        mps_sim_destroy(sim);
    }
}

/* ---- refusals ---- */

static double not_a_number(void *user, const double *x)
{
    return x[0] > 0.5 && x[1] < 0 ? NAN : ball(user, x);
}

static double constant(void *user, const double *x)
{
    (void)x;
    return *(const double *)user;
}

static void refused(mps_sim *sim, mps_solid solid, const char *word)
{
    ASSERT_REFUSED(sim, mps_solid_add(sim, &solid), MPS_E_ARG, word);
    assert_int_equal(mps_particles_count(sim, -1), 0);
    assert_int_equal(mps_part_find(sim, "solid"), -1);
    const double lo[2] = {0, 0}, hi[2] = {1, 1};
    ASSERT_STATUS(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL), MPS_E_STATE);
}

static void refusals(void **state)
{
    (void)state;
    double one = 1, minus = -1;
    mps_sim *sim = new_sim(2, 0.1);
    mps_solid good = solid_of(ball, NULL, &two, 1), bad = good;
    refused(sim, solid_of(not_a_number, NULL, &two, 1), "nan at (0.5");
    refused(sim, solid_of(constant, NULL, &one, 1), "nothing is solid");
    refused(sim, solid_of(constant, NULL, &minus, 1), "everything is solid");
    refused(sim, solid_of(NULL, everywhere, NULL, 1), "everything is solid");
    refused(sim, solid_of(ball, NULL, &two, 0.8), "leaves its box at");
    refused(sim, solid_of(NULL, NULL, NULL, 1), "neither a distance nor an inside");
    refused(sim, solid_of(ball, everywhere, &two, 1), "both");
    bad.hi[1] = bad.lo[1];
    refused(sim, bad, "box [1]");
    bad.hi[1] = INFINITY;
    refused(sim, bad, "must be finite");
    bad.hi[1] = 1e9;
    refused(sim, bad, "too many");
    for (int d = 0; d < 2;
         d++) { /* at once, without cells by the thousand million, and of the right axis */
        char word[64];
        mps_solid box = good;
        snprintf(word, sizeof word, "1e+11 m long along axis %d: too many", d);
        box.hi[d] = 1e11;
        refused(sim, box, word);
        box.distance = NULL;
        box.inside = everywhere;
        refused(sim, box, word);
    }
    bad.lo[1] = 1e9 - 1;
    refused(sim, bad, "solid.lo[1] puts solids at 1e+09 m");
    bad = good;
    bad.invert = 2;
    refused(sim, bad, "solid.invert is 2");
    bad = good;
    bad.dummy_layers = 9;
    refused(sim, bad, "1..8");
    bad = good;
    bad.name = "a name that is much too long for a part";
    refused(sim, bad, "solid.name");
    ASSERT_OK(sim, mps_solid_add(sim, &good));
    ASSERT_OK(sim, mps_fill_add(sim, 0, everywhere, NULL, NULL));
    /* into the fluid */
    mps_solid body = solid_of(ball, NULL, &two, 1.2);
    body.invert = 1;
    ASSERT_REFUSED(sim, mps_solid_add(sim, &body), MPS_E_ARG, "in the way");
    ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
    ASSERT_STATUS(sim, mps_solid_add(sim, &body), MPS_E_STATE);
    assert_int_equal(mps_solid_add(NULL, &body), MPS_E_ARG);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(surfaces),         cmocka_unit_test(a_box_is_a_tank),
        cmocka_unit_test(fills_keep_out),   cmocka_unit_test(two_tanks),
        cmocka_unit_test(column_in_a_tank), cmocka_unit_test(thin_plates_are_told),
        cmocka_unit_test(refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Random boxes and plates off the lattice: their wall particles are where the line "as built" of
 * the check says, and a box that is not thin has its size within a tenth of a spacing. */
#include "build_kit.h"

/* after cmocka.h */
#include "../tags.h"

enum { BOXES = 16, PLATES = 12 };

static const double DP = 0.02, THIN = 3;

static uint32_t seed;

/* Between two numbers; the same sequence on every machine. */
static double between(double from, double to)
{
    seed = 1664525u * seed + 1013904223u;
    return from + (to - from) * (seed >> 8) / 16777216.0;
}

/* The corners of a solid. */
typedef struct extent {
    double lo[3], hi[3];
} extent;

/* Of the wall particles of part 'b'. */
static extent measured(mps_sim *sim, int dim)
{
    extent e = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    const int32_t *kind, *part, own = mps_part_find(sim, "b");
    mps_lease x;
    assert_true(own >= 0);
    assert_int_equal(tags_peek(sim, NULL, &kind, NULL, &part), MPS_OK);
    assert_int_equal(tags_lease(sim, "position", &x), MPS_OK);
    for (int64_t i = 0; i < x.count; i++)
        for (int d = 0; d < dim && kind[i] == MPS_WALL && part[i] == own; d++) {
            e.lo[d] = fmin(e.lo[d], x.data[i * x.stride + d]);
            e.hi[d] = fmax(e.hi[d], x.data[i * x.stride + d]);
        }
    assert_int_equal(mps_lease_end(sim, &x), MPS_OK);
    return e;
}

/* From the line of the check, whose numbers have four digits or more. */
static extent stated(const char *text, const char *what, int dim)
{
    char line[1000], head[40];
    extent e = {{0}, {0}};
    int count = 0;
    mps_case *c = NULL;
    char *all, *sketch;
    assert_int_equal(kit_read(text, NULL, &c), MPS_OK);
    assert_int_equal(mps_case_check(c, &all, &sketch), MPS_OK);
    snprintf(head, sizeof head, "b: %s as built (", what);
    const char *at = strstr(all, head);
    if (!at) fail_msg("no '%s':\n%s", head, all);
    snprintf(line, sizeof line, "%.*s", (int)strcspn(at, "\n"), at);
    at = line + strlen(head);
    count = dim == 2
                ? sscanf(at, "%lf, %lf) m to (%lf, %lf)", &e.lo[0], &e.lo[1], &e.hi[0], &e.hi[1])
                : sscanf(at, "%lf, %lf, %lf) m to (%lf, %lf, %lf)", &e.lo[0], &e.lo[1], &e.lo[2],
                         &e.hi[0], &e.hi[1], &e.hi[2]);
    if (count != 2 * dim) fail_msg("%s", line);
    free(all);
    free(sketch);
    mps_case_destroy(c);
    return e;
}

static void same_extent(const char *what, const extent *a, const extent *b, int dim, double most)
{
    for (int d = 0; d < dim; d++)
        if (!(fabs(a->lo[d] - b->lo[d]) <= most * DP && fabs(a->hi[d] - b->hi[d]) <= most * DP))
            fail_msg("%s, axis %d: %g to %g m, not %g to %g m", what, d, a->lo[d], a->hi[d],
                     b->lo[d], b->hi[d]);
}

/* "x y z m" */
static const char *place(char out[100], const double *x, int dim)
{
    snprintf(out, 100, dim == 2 ? "%.9g %.9g m" : "%.9g %.9g %.9g m", x[0], x[1], x[2]);
    return out;
}

/* A tank with one solid. */
static void write_case(char out[700], const char *what, const extent *e, int dim)
{
    char from[100], to[100];
    snprintf(out, 700,
             "mps: 1\ndim: %d\ndp: 20 mm\ntank: {size: 0.5 0.4%s m}\n"
             "fill: [{water: {depth: 0.1 m}}]\nsolids:\n  b: {%s: [%s, %s]}\nrun: {until: 1 s}\n",
             dim, dim == 3 ? " 0.3" : "", what, place(from, e->lo, dim), place(to, e->hi, dim));
}

static void boxes(int dim, double least, double most, double allowed)
{
    for (int n = 0; n < (dim == 2 ? BOXES : BOXES / 4); n++) {
        char text[700];
        extent asked = {{0}, {0}};
        built t;
        for (int d = 0; d < dim; d++) {
            asked.lo[d] = between(0.08, 0.1); /* above a half cell of the floor */
            asked.hi[d] = asked.lo[d] + DP * between(least, most);
        }
        write_case(text, "box", &asked, dim);
        const extent line = stated(text, "box", dim);
        built_make(&t, text, NULL);
        const extent walls = measured(t.b.sim, dim);
        same_extent(text, &walls, &line, dim, 0.02);
        same_extent(text, &walls, &asked, dim, allowed);
        built_free(&t);
    }
}

static void bodies(void **state)
{
    (void)state;
    seed = 1;
    boxes(2, THIN, 9, 0.1 + 1e-6);
    boxes(3, THIN, 7, 0.1 + 1e-6);
}

/* Thin boxes are on the lattice. */
static void thin_boxes(void **state)
{
    (void)state;
    seed = 2;
    boxes(2, 1, THIN, 0.5 + 1e-3);
    boxes(3, 1.2, THIN, 0.5 + 1e-3);
}

/* A plate across an axis is on the nearest plane of the lattice, its ends too. */
static void plates(void **state)
{
    (void)state;
    seed = 3;
    for (int n = 0; n < PLATES; n++) {
        const int dim = 2 + n / (PLATES / 2), axis = n % 2;
        char text[700];
        extent asked = {{0}, {0}};
        built t;
        for (int d = 0; d < dim; d++) {
            asked.lo[d] = between(0.08, 0.12);
            asked.hi[d] = asked.lo[d] + (d == axis ? 0 : DP * between(3, 8));
        }
        write_case(text, "plate", &asked, dim);
        extent line = stated(text, "plate", dim);
        built_make(&t, text, NULL);
        const extent walls = measured(t.b.sim, dim);
        same_extent(text, &walls, &asked, dim, 0.5 + 1e-3);
        same_extent(text, &walls, &line, dim, 0.02);
        built_free(&t);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(bodies), cmocka_unit_test(thin_boxes),
                                       cmocka_unit_test(plates)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Neighbour lists against a double loop, for various sets of particles; the skin; refusals. */
#include "cloud.h"
#include "neighbours.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <cmocka.h>

static const double near_radius = 2.1 * CLOUD_DP, far_radius = 3.1 * CLOUD_DP;

/* ---- an allocator that counts allocated bytes ---------------------------------------------- */

typedef struct meter {
    size_t live, most;
} meter;

static void *meter_alloc(void *user, size_t size)
{
    meter *m = user;
    size_t *block = malloc(size + 16);
    if (!block) return NULL;
    block[0] = size;
    m->live += size;
    if (m->live > m->most) m->most = m->live;
    return block + 2;
}

static void meter_release(void *user, void *block)
{
    meter *m = user;
    size_t *head = (size_t *)block - 2;
    m->live -= head[0];
    free(head);
}

static mps_allocator meter_allocator(meter *m)
{
    return (mps_allocator){meter_alloc, meter_release, m};
}

/* ---- the double loop ------------------------------------------------------------------------- */

/* Row i contains exactly the other particles within `re`, except those at the same position. */
static void check_row(const cloud *c, const mps_stencil *t, int64_t i, double re)
{
    int64_t k = t->begin[i];
    for (int64_t j = 0; j < c->n; j++) {
        const double r2 = cloud_distance2(c, i, j);
        if (j == i || r2 >= re * re || r2 == 0) continue;
        bool found = false;
        for (int64_t m = t->begin[i]; m < t->end[i]; m++) found = found || t->col[m] == j;
        if (!found)
            fail_msg("particle %lld lacks neighbour %lld at %g dp", (long long)i, (long long)j,
                     sqrt(r2) / CLOUD_DP);
        k++;
    }
    assert_int_equal(k, t->end[i]);
}

/* Both radii of a list that was built; columns ascend, in the near part and behind it. */
static void check_list(const cloud *c, const mps_neighbours *list)
{
    mps_kernel kernel = {.struct_size = sizeof kernel};
    mps_stencil t[2] = {{.struct_size = sizeof t[0]}, {.struct_size = sizeof t[0]}};
    assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
    for (int which = 0; which < 2; which++) {
        assert_int_equal(mps_neighbours_stencil_get(list, which, &kernel, &t[which]), MPS_OK);
        assert_int_equal(t[which].n, c->n);
        for (int64_t i = 0; i < c->n; i++)
            check_row(c, &t[which], i, which ? far_radius : near_radius);
    }
    for (int64_t i = 0; i < c->n; i++) {
        for (int64_t k = t[0].begin[i] + 1; k < t[0].end[i]; k++)
            assert_true(t[0].col[k - 1] < t[0].col[k]);
        for (int64_t k = t[0].end[i] + 1; k < t[1].end[i]; k++)
            assert_true(t[1].col[k - 1] < t[1].col[k]);
    }
}

static mps_neighbours *new_list(int32_t dim)
{
    mps_neighbours *list = NULL;
    assert_int_equal(mps_neighbours_create(dim, CLOUD_DP, NULL, &list), MPS_OK);
    return list;
}

/* Build, compare, destroy. */
static void check_cloud(cloud c)
{
    mps_neighbours *list = new_list(c.dim);
    assert_int_equal(mps_neighbours_build(list, c.n, c.x, near_radius, far_radius), MPS_OK);
    check_list(&c, list);
    mps_neighbours_destroy(list);
    cloud_free(&c);
}

/* Everything uniform in a box, except clumps: some cells contain many particles, most none. */
static cloud clustered(int32_t dim, int64_t n, uint64_t seed)
{
    cloud c = cloud_empty(dim, n);
    double centre[3] = {0};
    for (int64_t i = 0; i < n; i++) {
        const bool alone = i % 50 == 0;
        for (int d = 0; d < dim; d++) {
            if (alone) centre[d] = 40 * CLOUD_DP * cloud_random(&seed);
            c.x[i * dim + d] = centre[d] + (alone ? 0 : 1.5 * CLOUD_DP * cloud_random(&seed));
        }
    }
    return c;
}

static void against_double_loop(void **state)
{
    (void)state;
    check_cloud(cloud_lattice(2, 30, 40, 1, 0.4, 1));
    check_cloud(cloud_lattice(3, 10, 9, 11, 0.4, 2));
    check_cloud(cloud_lattice(2, 30, 30, 1, 0, 3));
    check_cloud(cloud_lattice(2, 400, 1, 1, 0.4, 4)); /* a line */
    check_cloud(clustered(2, 1000, 5));
    check_cloud(clustered(3, 1000, 6));
    check_cloud(cloud_empty(2, 1));
}

/* Far from the origin cells are numbered as well as near it. */
static void far_from_origin(void **state)
{
    (void)state;
    for (int k = 0; k < 12; k++) {
        cloud c = cloud_lattice(2 + k % 2, 7, 7, k % 2 ? 7 : 1, 0.4, 7 + (uint64_t)k);
        const double shift = ldexp(1.0, 20 + k) + k;
        for (int64_t i = 0; i < c.n * c.dim; i++) c.x[i] += k % 3 == 0 ? -shift : shift;
        check_cloud(c);
    }
}

/* One particle a million spacings away costs neither memory nor time; one that no cell number
 * reaches is refused. */
static void far_particle(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        meter m = {0, 0};
        const mps_allocator allocator = meter_allocator(&m);
        mps_neighbours *list = NULL;
        cloud c = cloud_lattice(dim, 10, 10, dim == 3 ? 10 : 1, 0.3, 20);
        for (int d = 0; d < dim; d++) c.x[5 * dim + d] = 1e6 * CLOUD_DP;
        assert_int_equal(mps_neighbours_create(dim, CLOUD_DP, &allocator, &list), MPS_OK);
        assert_int_equal(mps_neighbours_build(list, c.n, c.x, near_radius, far_radius), MPS_OK);
        check_list(&c, list);
        assert_true(m.most < 4000 * (size_t)c.n);
        const double beyond[] = {1e10 * CLOUD_DP, -1e10 * CLOUD_DP, 1e300, -1e308};
        for (int k = 0; k < 4; k++) {
            c.x[5 * dim] = beyond[k];
            assert_int_equal(mps_neighbours_build(list, c.n, c.x, near_radius, far_radius),
                             MPS_E_ARG);
            assert_non_null(strstr(list->context->error, "axis 0"));
            mps_kernel kernel = {.struct_size = sizeof kernel};
            mps_stencil t = {.struct_size = sizeof t};
            assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
            assert_int_equal(mps_neighbours_stencil_get(list, MPS_NEAR, &kernel, &t),
                             MPS_E_ARG); /* empty, not half built */
        }
        mps_neighbours_destroy(list);
        assert_int_equal(m.live, 0);
        cloud_free(&c);
    }
}

/* Particles at the same position are no pair (without a direction), but have all other pairs. */
static void coincident(void **state)
{
    (void)state;
    cloud c = cloud_lattice(2, 12, 12, 1, 0.2, 30);
    memcpy(c.x + 2 * 40, c.x + 2 * 77, 2 * sizeof(double));
    memcpy(c.x + 2 * 41, c.x + 2 * 77, 2 * sizeof(double));
    check_cloud(c);
}

/* A block of particles all at the origin (an array that was not filled) is an error, not n^2
 * pairs. */
static void crowd(void **state)
{
    (void)state;
    meter m = {0, 0};
    const mps_allocator allocator = meter_allocator(&m);
    mps_neighbours *list = NULL;
    cloud c = cloud_empty(2, 100000);
    assert_int_equal(mps_neighbours_create(2, CLOUD_DP, &allocator, &list), MPS_OK);
    assert_int_equal(mps_neighbours_build(list, c.n, c.x, near_radius, far_radius), MPS_E_ARG);
    assert_non_null(strstr(list->context->error, "100000"));
    assert_true(m.most < 200 * (size_t)c.n);
    mps_neighbours_destroy(list);
    cloud_free(&c);
}

static void symmetric_pairs(void **state)
{
    (void)state;
    cloud c = clustered(3, 2000, 40);
    mps_neighbours *list = new_list(3);
    assert_int_equal(mps_neighbours_build(list, c.n, c.x, near_radius, far_radius), MPS_OK);
    for (int64_t i = 0; i < c.n; i++)
        for (int64_t k = list->begin[i]; k < list->end[i]; k++) {
            const int32_t j = list->col[k];
            const bool close = k < list->middle[i];
            bool back = false;
            for (int64_t m = close ? list->begin[j] : list->middle[j];
                 m < (close ? list->middle[j] : list->end[j]); m++)
                back = back || list->col[m] == i;
            assert_true(back);
        }
    mps_neighbours_destroy(list);
    cloud_free(&c);
}

/* One list for clouds that grow and shrink, other radii, more threads: always as if new. */
static void rebuild(void **state)
{
    (void)state;
    mps_neighbours *list = new_list(2);
    const int side[] = {5, 20, 3, 21, 20};
    for (int k = 0; k < 5; k++) {
        cloud c = cloud_lattice(2, side[k], side[k], 1, 0.3, 50 + (uint64_t)k);
        const mps_parallel threads = {.struct_size = sizeof threads, .threads = 1 + k % 2};
        assert_int_equal(mps_neighbours_parallel_set(list, &threads), MPS_OK);
        assert_int_equal(mps_neighbours_build(list, c.n, c.x, CLOUD_DP, 1.5 * CLOUD_DP), MPS_OK);
        assert_int_equal(mps_neighbours_build(list, c.n, c.x, near_radius, far_radius), MPS_OK);
        check_list(&c, list);
        cloud_free(&c);
    }
    mps_neighbours_destroy(list);
}

/* The same number of particles, but more pairs than the capacity, or fewer. */
static void pairs_come_and_go(void **state)
{
    (void)state;
    const double scale[] = {1, 0.97, 0.9, 0.6, 0.61, 1.3, 1.2};
    mps_neighbours *list = new_list(3);
    for (size_t k = 0; k < sizeof scale / sizeof *scale; k++) {
        cloud c = cloud_lattice(3, 9, 9, 9, 0.3, 55);
        const mps_parallel threads = {.struct_size = sizeof threads, .threads = 1 + (int32_t)k % 3};
        for (int64_t i = 0; i < 3 * c.n; i++) c.x[i] *= scale[k];
        assert_int_equal(mps_neighbours_parallel_set(list, &threads), MPS_OK);
        assert_int_equal(mps_neighbours_build(list, c.n, c.x, near_radius, far_radius), MPS_OK);
        check_list(&c, list);
        cloud_free(&c);
    }
    mps_neighbours_destroy(list);
}

/* Rows of more than a thousand neighbours together with short ones. */
static void long_rows(void **state)
{
    (void)state;
    cloud c = cloud_lattice(3, 18, 11, 11, 0.3, 56);
    for (int64_t i = 0; i < c.n; i++)
        for (int d = 0; d < 3 && c.x[3 * i] < 12 * CLOUD_DP; d++) c.x[3 * i + d] *= 0.3;
    mps_neighbours *list = new_list(3);
    mps_kernel kernel = {.struct_size = sizeof kernel};
    mps_stencil t[2] = {{.struct_size = sizeof t[0]}, {.struct_size = sizeof t[0]}};
    int64_t longest = 0, shortest = c.n;
    assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
    assert_int_equal(mps_neighbours_build(list, c.n, c.x, near_radius, far_radius), MPS_OK);
    for (int which = 0; which < 2; which++)
        assert_int_equal(mps_neighbours_stencil_get(list, which, &kernel, &t[which]), MPS_OK);
    for (int64_t i = 0; i < c.n; i += 13) {
        const int64_t length = t[1].end[i] - t[1].begin[i];
        check_row(&c, &t[0], i, near_radius);
        check_row(&c, &t[1], i, far_radius);
        longest = length > longest ? length : longest;
        shortest = length < shortest ? length : shortest;
        for (int64_t k = t[1].begin[i] + 1; k < t[1].end[i]; k++)
            assert_true(k == t[0].end[i] || t[1].col[k - 1] < t[1].col[k]);
    }
    assert_true(longest > 1024 && shortest < 200);
    mps_neighbours_destroy(list);
    cloud_free(&c);
}

/* ---- kinds ----------------------------------------------------------------------------------- */

/* Fluid over a wall over dummies, row by row of a lattice. */
static int32_t kind_at(double y)
{
    return y > 6.5 * CLOUD_DP ? MPS_FLUID : y > 5.5 * CLOUD_DP ? MPS_WALL : MPS_DUMMY;
}

/* Without kinds all rows; with them none of solids without fluid in reach, and of dummies only on
 * demand. */
static void rows_of_kinds(void **state)
{
    (void)state;
    mps__context context = {.allocator = mps__allocator_default()};
    mps_neighbours l;
    cloud c = cloud_lattice(2, 20, 14, 1, 0, 64);
    int32_t *kind = calloc((size_t)c.n, sizeof *kind);
    mps_stencil t = {.x = c.x};
    for (int64_t i = 0; i < c.n; i++) kind[i] = kind_at(c.x[2 * i + 1]);
    assert_int_equal(mps__neighbours_init(&l, &context, 2, CLOUD_DP), MPS_OK);
    for (int k = 0; k < 6; k++) {
        const bool kinds = k % 3 > 0, dummy_rows = k % 3 == 2;
        l.kind = kinds ? kind : NULL;
        l.dummy_rows = dummy_rows;
        assert_int_equal(mps__neighbours_search(&l, c.n, c.x, near_radius, far_radius), MPS_OK);
        assert_true(l.partial == kinds);
        t.begin = l.begin, t.end = l.end, t.col = l.col;
        for (int64_t i = 0; i < c.n; i++) {
            const double depth = 7 * CLOUD_DP - c.x[2 * i + 1], reach = far_radius + l.skin;
            const bool empty = kinds && (kind[i] == MPS_DUMMY && (!dummy_rows || depth >= reach));
            assert_int_equal(l.idle[i], empty);
            if (empty)
                assert_int_equal(l.count[i], 0);
            else
                check_row(&c, &t, i, far_radius);
            if (kinds && kind[i] == MPS_FLUID && depth > 2 * CLOUD_DP - far_radius)
                assert_int_equal(l.near_dummies[i], 1);
            if (!kinds || kind[i] != MPS_FLUID) assert_int_equal(l.near_dummies[i], 0);
        }
        assert_int_equal(l.near_dummies[c.n - 1], 0); /* fluid far above the wall */
    }
    mps__neighbours_free(&l);
    free(kind);
    cloud_free(&c);
}

static void bad_arguments(void **state)
{
    (void)state;
    mps_neighbours *list = (mps_neighbours *)state;
    double x[4] = {0, 0, 1, 0};
    const mps_allocator half = {meter_alloc, NULL, NULL};
    assert_int_equal(mps_neighbours_create(4, 1, NULL, &list), MPS_E_ARG);
    assert_null(list);
    assert_int_equal(mps_neighbours_create(2, 0, NULL, &list), MPS_E_ARG);
    assert_int_equal(mps_neighbours_create(2, NAN, NULL, &list), MPS_E_ARG);
    assert_int_equal(mps_neighbours_create(2, INFINITY, NULL, &list), MPS_E_ARG);
    assert_int_equal(mps_neighbours_create(2, 1, &half, &list), MPS_E_ARG);
    assert_int_equal(mps_neighbours_create(2, 1, NULL, NULL), MPS_E_ARG);
    mps_parallel threads = {.struct_size = sizeof threads, .threads = -1};
    assert_int_equal(mps_neighbours_parallel_set(NULL, &threads), MPS_E_ARG);
    list = new_list(2);
    assert_int_equal(mps_neighbours_parallel_set(list, NULL), MPS_E_ARG);
    assert_int_equal(mps_neighbours_parallel_set(list, &threads), MPS_E_ARG);
    threads.threads = 0;
    assert_int_equal(mps_neighbours_parallel_set(list, &threads), MPS_OK);
    threads.struct_size = 0;
    assert_int_equal(mps_neighbours_parallel_set(list, &threads), MPS_E_ARG);
    mps_neighbours_destroy(list);
    assert_int_equal(mps_neighbours_create(2, 1, NULL, &list), MPS_OK);
    assert_int_equal(mps_neighbours_build(NULL, 2, x, 1, 2), MPS_E_ARG);
    assert_int_equal(mps_neighbours_build(list, 2, NULL, 1, 2), MPS_E_ARG);
    assert_int_equal(mps_neighbours_build(list, 0, x, 1, 2), MPS_E_ARG);
    assert_int_equal(mps_neighbours_build(list, INT64_C(1) << 31, x, 1, 2), MPS_E_ARG);
    assert_int_equal(mps_neighbours_build(list, 2, x, 0, 2), MPS_E_ARG);
    assert_int_equal(mps_neighbours_build(list, 2, x, 2, 1), MPS_E_ARG);
    assert_int_equal(mps_neighbours_build(list, 2, x, NAN, 1), MPS_E_ARG);
    assert_int_equal(mps_neighbours_build(list, 2, x, 1, INFINITY), MPS_E_ARG);
    x[3] = NAN;
    assert_int_equal(mps_neighbours_build(list, 2, x, 1, 2), MPS_E_ARG);
    x[3] = -INFINITY;
    assert_int_equal(mps_neighbours_build(list, 2, x, 1, 2), MPS_E_ARG);
    mps_neighbours_destroy(list);
    mps_neighbours_destroy(NULL);
}

/* ---- the skin -------------------------------------------------------------------------------- */

/* Within half a skin the previous candidates give the exact rows of the new positions. */
static void skin_rows(void **state)
{
    (void)state;
    mps__context context = {.allocator = mps__allocator_default()};
    mps_neighbours l;
    uint64_t seed = 60;
    cloud c = cloud_lattice(2, 25, 25, 1, 0.3, 61);
    assert_int_equal(mps__neighbours_init(&l, &context, 2, CLOUD_DP), MPS_OK);
    assert_int_equal(mps__neighbours_search(&l, c.n, c.x, near_radius, far_radius), MPS_OK);
    for (int64_t i = 0; i < c.n * 2; i++)
        c.x[i] += 0.35 * l.skin * cloud_random(&seed); /* at most 0.35 sqrt(2) < 0.5 skins */
    assert_true(mps__neighbours_fresh(&l, c.n, c.x, l.searched, NULL, far_radius));
    mps__neighbours_rows(&l, c.x);
    check_list(&c, &l);
    mps__neighbours_free(&l);
    cloud_free(&c);
}

static void skin_limit(void **state)
{
    (void)state;
    mps__context context = {.allocator = mps__allocator_default()};
    mps_neighbours l;
    cloud c = cloud_lattice(3, 6, 6, 6, 0.3, 62);
    assert_int_equal(mps__neighbours_init(&l, &context, 3, CLOUD_DP), MPS_OK);
    assert_false(
        mps__neighbours_fresh(&l, 0, c.x, l.searched, NULL, far_radius)); /* never searched */
    assert_int_equal(mps__neighbours_search(&l, c.n, c.x, near_radius, far_radius), MPS_OK);
    assert_true(mps__neighbours_fresh(&l, c.n, c.x, l.searched, NULL, far_radius));
    assert_false(mps__neighbours_fresh(&l, c.n - 1, c.x, l.searched, NULL, far_radius));
    assert_false(mps__neighbours_fresh(&l, c.n, c.x, l.searched, NULL, 1.1 * far_radius));
    double *last = c.x + 3 * (c.n - 1), kept = last[2];
    last[2] = kept + 0.49 * l.skin;
    assert_true(mps__neighbours_fresh(&l, c.n, c.x, l.searched, NULL, far_radius));
    last[2] = kept + 0.51 * l.skin;
    assert_false(mps__neighbours_fresh(&l, c.n, c.x, l.searched, NULL, far_radius));
    last[2] = kept;
    assert_int_equal(mps__neighbours_order(&l, c.n, c.x, NULL, far_radius), MPS_OK);
    assert_false(
        mps__neighbours_fresh(&l, c.n, c.x, l.searched, NULL, far_radius)); /* about to be sorted */
    mps__neighbours_free(&l);
    assert_false(mps__neighbours_fresh(&l, 0, c.x, l.searched, NULL, far_radius));
    cloud_free(&c);
}

/* The order of cells is a permutation, and the same for any number of threads. */
static void order_is_permutation(void **state)
{
    (void)state;
    mps__context context = {.allocator = mps__allocator_default()};
    mps_neighbours l;
    cloud c = clustered(2, 3000, 63);
    bool *seen = calloc((size_t)c.n, sizeof *seen);
    assert_int_equal(mps__neighbours_init(&l, &context, 2, CLOUD_DP), MPS_OK);
    assert_int_equal(mps__neighbours_order(&l, c.n, c.x, NULL, far_radius), MPS_OK);
    for (int64_t k = 0; k < c.n; k++) {
        assert_in_range(l.order[k], 0, c.n - 1);
        assert_false(seen[l.order[k]]);
        seen[l.order[k]] = true;
        assert_true(k == 0 || l.key[k - 1] < l.key[k] ||
                    (l.key[k - 1] == l.key[k] && l.order[k - 1] < l.order[k]));
    }
    mps__neighbours_free(&l);
    free(seen);
    cloud_free(&c);
}

/* The library's own lists take positions as they are: what is no number is refused, not cast. */
static void position_not_finite(void **state)
{
    (void)state;
    const double bad[] = {NAN, INFINITY, -INFINITY, 1e308};
    for (int dim = 2; dim <= 3; dim++)
        for (int d = 0; d < dim; d++)
            for (int k = 0; k < 4; k++) {
                mps__context context = {.allocator = mps__allocator_default()};
                mps_neighbours l;
                char axis[24];
                cloud c = cloud_lattice(dim, 6, 6, dim == 3 ? 6 : 1, 0.3, 20);
                snprintf(axis, sizeof axis, "axis %d", d);
                assert_int_equal(mps__neighbours_init(&l, &context, dim, CLOUD_DP), MPS_OK);
                c.x[5 * dim + d] = bad[k];
                assert_int_equal(mps__neighbours_order(&l, c.n, c.x, NULL, far_radius), MPS_E_ARG);
                assert_non_null(strstr(context.error, axis));
                mps__neighbours_free(&l);
                cloud_free(&c);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(against_double_loop),
        cmocka_unit_test(far_from_origin),
        cmocka_unit_test(far_particle),
        cmocka_unit_test(coincident),
        cmocka_unit_test(crowd),
        cmocka_unit_test(symmetric_pairs),
        cmocka_unit_test(rebuild),
        cmocka_unit_test(pairs_come_and_go),
        cmocka_unit_test(long_rows),
        cmocka_unit_test(rows_of_kinds),
        cmocka_unit_test(bad_arguments),
        cmocka_unit_test(skin_rows),
        cmocka_unit_test(skin_limit),
        cmocka_unit_test(order_is_permutation),
        cmocka_unit_test(position_not_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* surface.asymmetry and wall.half against loops over all particles: regions of a torn liquid
 * between walls, and the wetted fraction of walls. */
#include "phase_fixture.h"
#include <stdbool.h>

enum { CAPACITY = 3000 };

enum { NUMBER, REGION, WETTED, USES };
static const mps_use uses[USES] = {[NUMBER] = {"number_density", MPS_USE_READ},
                                   [REGION] = {"region", MPS_USE_NEIGHBOURS},
                                   [WETTED] = {"wetted_share", MPS_USE_READ}};

/* Rules by which particles got their regions, and kinds of walls, in the last scene. */
enum { LONE, TORN, FLAT, FILM, REST, AMID_SPRAY, BESIDE_SPRAY, CONTACT, FULL, PARTLY, BEHIND, ALL };
static int64_t found[ALL];

static const mps_view *v;
static mps_kernel kernel = {.struct_size = sizeof kernel};

static bool pair_of(int64_t i, int64_t j, double *d, double *r, double *w)
{
    double r2 = 0;
    for (int k = 0; k < v->dim; k++) {
        d[k] = v->x[j * v->dim + k] - v->x[i * v->dim + k];
        r2 += d[k] * d[k];
    }
    *r = sqrt(r2);
    if (i == j || *r >= v->near.re) return false;
    *w = mps_kernel_value(&kernel, *r, v->near.re);
    return true;
}

/* Sums of a row of the lattice that fills one half space: of W over all below its row, and |A|. */
static void half_space(double *full, double *a0)
{
    const double dp = v->dp, re = v->near.re;
    *full = *a0 = 0;
    for (int i = -3; i <= 3; i++)
        for (int j = 1; j <= 3; j++)
            for (int k = v->dim == 3 ? -3 : 0; k <= (v->dim == 3 ? 3 : 0); k++) {
                const double r = dp * sqrt((double)(i * i + j * j + k * k));
                if (r >= re) continue;
                *full += mps_kernel_value(&kernel, r, re);
                *a0 += j * dp / r * mps_kernel_value(&kernel, r, re) * v->dim / v->near.n0;
            }
}

/* n/n0, |A| and the sum of W over the fluid, over n0; without particles whose region is `left`. */
typedef struct sums {
    double n, a, fluid;
} sums;

static sums sums_of(int64_t i, const int32_t *region, int32_t left)
{
    const int dim = v->dim;
    const double n0 = v->near.n0;
    double a[3] = {0}, d[3], r, w;
    sums c = {0};
    for (int64_t j = 0; j < v->n; j++) {
        if (region[j] == left || !pair_of(i, j, d, &r, &w)) continue;
        c.n += w / n0;
        if (v->kind[j] == MPS_FLUID) c.fluid += w / n0;
        for (int k = 0; k < dim; k++) a[k] += dim / n0 * w * d[k] / r;
    }
    c.a = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    return c;
}

/* The first matching rule of the header of src/bc/surface_asymmetry.c; REST: none. */
static int rule(double n, double a)
{
    return n < 0.6               ? LONE
           : n < 0.8 && a > 0.4  ? TORN
           : n < 0.97 && a > 0.9 ? FLAT
           : a > 1.1 * n         ? FILM
                                 : REST;
}

/* Whether a particle of this kind and region is within `reach`. */
static bool beside(int64_t i, const int32_t *region, int32_t kind, int32_t wanted, double reach)
{
    double d[3], r, w;
    for (int64_t j = 0; j < v->n; j++)
        if (v->kind[j] == kind && region[j] == wanted && pair_of(i, j, d, &r, &w) && r < reach)
            return true;
    return false;
}

/* Spray, and the surface by the sums of each particle. */
static void own_sums(const sums *c, int32_t *region)
{
    for (int64_t i = 0; i < v->n; i++) {
        region[i] = v->kind[i] == MPS_DUMMY ? MPS_REGION_DRY : MPS_REGION_INNER;
        if (v->kind[i] != MPS_FLUID) continue;
        const int why = rule(c[i].n, c[i].a);
        if (why != REST) region[i] = MPS_REGION_SURFACE;
        if (c[i].fluid < 0.25) region[i] = MPS_REGION_SPRAY;
        if (c[i].fluid >= 0.25) found[why]++;
    }
}

/* Particles next to spray, then particles where the surface meets a wall. */
static void beside_others(const sums *c, double a0, int32_t *region)
{
    static int32_t old[CAPACITY];
    const double re = v->near.re;
    for (int pass = 0; pass < 2; pass++) {
        memcpy(old, region, (size_t)v->n * sizeof *old);
        for (int64_t i = 0; i < v->n; i++) {
            if (v->kind[i] != MPS_FLUID || old[i] != MPS_REGION_INNER) continue;
            bool changed = false;
            if (pass == 0 && beside(i, old, MPS_FLUID, MPS_REGION_SPRAY, re)) {
                const sums left = sums_of(i, old, MPS_REGION_SPRAY);
                changed = left.fluid < 0.25 || rule(left.n, left.a / a0) != REST;
                found[left.fluid < 0.25 ? AMID_SPRAY : BESIDE_SPRAY] += changed;
            }
            if (pass == 1 && c[i].n < 0.95 && c[i].a > 0.55) {
                changed = beside(i, old, MPS_WALL, MPS_REGION_INNER, 1.5 * v->dp) &&
                          beside(i, old, MPS_FLUID, MPS_REGION_SURFACE, 1.5 * v->dp);
                found[CONTACT] += changed;
            }
            if (changed) region[i] = MPS_REGION_SURFACE;
        }
    }
}

/* NEAR and SECOND. */
static void bands(int32_t *region)
{
    const double re = v->near.re;
    for (int32_t to = MPS_REGION_NEAR; to >= MPS_REGION_SECOND; to--)
        for (int64_t i = 0; i < v->n; i++)
            if (v->kind[i] == MPS_FLUID && region[i] == MPS_REGION_INNER &&
                beside(i, region, MPS_FLUID, to + 1, re))
                region[i] = to;
}

/* Filled fraction of the half space of a wall, 0 if all fluid is behind its face. */
static double wet(int64_t i, const int32_t *region, double full)
{
    const int dim = v->dim;
    const double *area = v->area + i * dim;
    double sum = 0, size = 0, highest = -1, d[3], r, w;
    for (int k = 0; k < dim; k++) size += area[k] * area[k];
    for (int64_t j = 0; j < v->n; j++) {
        double height = 0;
        if (v->kind[j] != MPS_FLUID || region[j] == MPS_REGION_SPRAY) continue;
        if (!pair_of(i, j, d, &r, &w)) continue;
        for (int k = 0; k < dim; k++) height += d[k] * area[k] / sqrt(size);
        highest = fmax(highest, height);
        sum += w;
    }
    const bool before = size == 0 || highest > 0.1 * v->dp;
    found[sum >= full ? FULL : PARTLY] += before && sum > 0;
    found[BEHIND] += !before && sum > 0;
    return before ? fmin(1, sum / full) : 0;
}

static int compare(mps_stage *s)
{
    static sums c[CAPACITY];
    static int32_t region[CAPACITY];
    const double *number = s->data[NUMBER], *wetted = s->data[WETTED];
    const int32_t *got = s->data[REGION];
    double full, a0;
    v = s->view;
    assert_true(v->n <= CAPACITY);
    assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
    half_space(&full, &a0);
    memset(region, -1, sizeof region);
    for (int64_t i = 0; i < v->n; i++) {
        c[i] = sums_of(i, region, MPS_REGION_DRY);
        c[i].a /= a0;
        if (v->kind[i] == MPS_FLUID) ASSERT_NEAR(c[i].n, number[i] / v->near.n0, 1e-12);
    }
    own_sums(c, region);
    beside_others(c, a0, region);
    bands(region);
    for (int64_t i = 0; i < v->n; i++) {
        const double share = v->kind[i] == MPS_WALL ? wet(i, region, full) : 0;
        if (v->kind[i] == MPS_WALL && share == 0) region[i] = MPS_REGION_DRY;
        assert_int_equal(got[i], region[i]);
        if (v->kind[i] == MPS_WALL) ASSERT_NEAR(wetted[i], share, 1e-12);
    }
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_PREPARE, .use_count = USES, .uses = uses, .after = "*", .run = compare}};
static const mps_model_ops regions = {.struct_size = sizeof(mps_model_ops),
                                      .api = MPS_MODEL_API,
                                      .name = "after.regions",
                                      .help = "compares regions and wet walls",
                                      .verb_count = 1,
                                      .verbs = verbs};

/* Liquid in a tank with a box on the floor, off its lattice by up to `jitter`; the fraction `torn`
 * of its particles is missing, more at the top. */
static void classify(int dim, double jitter, double torn, uint64_t seed)
{
    const double dp = CLOUD_DP, length = (dim == 2 ? 24 : 10) * dp, top = (dim == 2 ? 14 : 8) * dp,
                 across = 6 * dp, lo[3] = {length - 4 * dp, 0, 0}, hi[3] = {length, 4 * dp, across};
    const int nx = dim == 2 ? 23 : 9, ny = dim == 2 ? 10 : 6, nz = dim == 3 ? 5 : 1;
    cloud c = cloud_lattice(dim, nx, ny, nz, jitter, seed);
    mps_sim *sim = bare_sim(dim, dp, 2.1, 1e-6);
    int64_t kept = 0;
    for (int64_t i = 0; i < c.n; i++) {
        const double height = (double)(i / nx % ny) / ny;
        if (fabs(cloud_random(&seed)) < torn * 2 * height) continue;
        if (i % nx > nx - 5 && i / nx % ny < 4) continue; /* in the box */
        for (int d = 0; d < dim; d++) c.x[kept * dim + d] = c.x[i * dim + d] + dp;
        kept++;
    }
    c.n = kept;
    int32_t *phase = cloud_phases(c.n);
    add_tank(sim, length, top, across);
    ASSERT_OK(sim, mps_baffle_add(sim, "box", lo, hi, NULL));
    add_cloud(sim, &c, phase, NULL);
    ASSERT_OK(sim, mps_model_register(sim, &regions));
    ASSERT_OK(sim, mps_model_use(sim, "after.regions"));
    ASSERT_OK(sim, mps_model_use(sim, "surface.asymmetry"));
    ASSERT_OK(sim, mps_model_use(sim, "wall.half"));
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    mps_sim_destroy(sim);
    cloud_free(&c);
    free(phase);
}

/* Calm and torn liquids; every rule decides somewhere. */
static void by_all_particles(void **state)
{
    (void)state;
    memset(found, 0, sizeof found);
    for (uint64_t k = 0; k < 24; k++)
        classify(k % 4 == 3 ? 3 : 2, 0.05 + 0.1 * (double)(k % 3), 0.15 * (double)(k % 6), 40 + k);
    for (int k = 0; k < ALL; k++) print_message("rule %d: %lld\n", k, (long long)found[k]);
    for (int k = 0; k < ALL; k++) assert_true(found[k] > 0);
}

/* Liquid next to a box, its upper row `lift` dp above the box; number of walls with all liquid
 * behind their face. */
static int64_t beside_a_box(double lift)
{
    const double dp = CLOUD_DP, lo[3] = {8 * dp, 0, 0}, hi[3] = {12 * dp, 4 * dp, 0};
    cloud c = cloud_lattice(2, 7, 4, 1, 0, 1);
    int32_t *phase = cloud_phases(c.n);
    mps_sim *sim = bare_sim(2, dp, 2.1, 1e-6);
    for (int64_t k = 0; k < 2 * c.n; k++) c.x[k] += dp * (k % 2 ? 1 + lift : 1);
    add_tank(sim, 16 * dp, 8 * dp, 0);
    ASSERT_OK(sim, mps_baffle_add(sim, "box", lo, hi, NULL));
    add_cloud(sim, &c, phase, NULL);
    ASSERT_OK(sim, mps_model_register(sim, &regions));
    ASSERT_OK(sim, mps_model_use(sim, "after.regions"));
    ASSERT_OK(sim, mps_model_use(sim, "surface.asymmetry"));
    ASSERT_OK(sim, mps_model_use(sim, "wall.half"));
    memset(found, 0, sizeof found);
    ASSERT_OK(sim, mps_step(sim, 1, NULL));
    mps_sim_destroy(sim);
    cloud_free(&c);
    free(phase);
    return found[BEHIND];
}

/* From 0.1 dp above its plane on liquid is before a face. */
static void before_a_face(void **state)
{
    (void)state;
    assert_int_equal(beside_a_box(0.12), 0);
    assert_true(beside_a_box(0.08) > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(by_all_particles),
                                       cmocka_unit_test(before_a_face)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

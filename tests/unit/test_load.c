/* SPDX-License-Identifier: BSD-3-Clause */
/* load.reaction: the wall pressure, against a loop over all particles. */
#include "cloud.h"
#include "tank_fixture.h"
#include <mps/model.h>
#include <stdbool.h>

enum { PRESSURE, ACCELERATION, REGION, CORRECTION, DENSITY, TANK, CONDITION, VALUE, LOAD, USES };
static const mps_use uses[USES] = {[PRESSURE] = {"pressure", MPS_USE_NEIGHBOURS},
                                   [ACCELERATION] = {"acceleration", MPS_USE_NEIGHBOURS},
                                   [REGION] = {"region", MPS_USE_NEIGHBOURS},
                                   [CORRECTION] = {"correction", MPS_USE_NEIGHBOURS},
                                   [DENSITY] = {"pressure_density", MPS_USE_NEIGHBOURS},
                                   [TANK] = {"tank_acceleration", MPS_USE_NEIGHBOURS},
                                   [CONDITION] = {"pressure_condition", MPS_USE_READ},
                                   [VALUE] = {"pressure_value", MPS_USE_READ},
                                   [LOAD] = {"wall_pressure", MPS_USE_READ}};
enum { BOUND_REGION, BOUND_CONDITION, BOUND_VALUE, BOUND_USES };
static const mps_use bound_uses[BOUND_USES] = {
    [BOUND_REGION] = {"region", MPS_USE_READ},
    [BOUND_CONDITION] = {"pressure_condition", MPS_USE_CHANGE},
    [BOUND_VALUE] = {"pressure_value", MPS_USE_CHANGE}};

/* Walls so far: by what they show (dry: less than the equation continues to them), and those with a
 * particle of the surface or spray about them. */
static struct {
    int64_t pressed, held, dry, pulls, surface, spray;
    int64_t whole, part, none; /* by the covered fraction of their faces */
    bool cover;
    double gas;   /* least pressure of all wetted walls [Pa]; 0: none */
    double worst; /* largest |wall_pressure - expected| over the largest pressure */
} seen;

/* One pair of a wall and the adjacent fluid. */
typedef struct pair {
    double d[3], w, w_r2, r2;
} pair;

static bool pair_of(const mps_view *v, const mps_kernel *kernel, int64_t i, int64_t j, pair *q)
{
    const int dim = v->dim;
    *q = (pair){0};
    for (int d = 0; d < dim; d++) {
        q->d[d] = v->x[j * dim + d] - v->x[i * dim + d];
        q->r2 += q->d[d] * q->d[d];
    }
    if (q->r2 >= v->near.re * v->near.re) return false;
    q->w = mps_kernel_value(kernel, sqrt(q->r2), v->near.re);
    q->w_r2 = q->w / q->r2;
    return true;
}

static double length_of(const double *a, int n)
{
    double sum = 0;
    for (int d = 0; d < n; d++) sum += a[d] * a[d];
    return sqrt(sum);
}

/* e_j and p'_j of the head of src/bc/load_reaction.c; the product s_j e_j. */
static double rise(const mps_stage *s, int64_t i, int64_t j, const double *r, double *carried)
{
    const mps_view *v = s->view;
    const double *p = s->data[PRESSURE], *a = s->data[ACCELERATION], *rho = s->data[DENSITY];
    const double *tank = s->data[TANK];
    const int32_t *region = s->data[REGION];
    const double mean = (rho[i] + rho[j]) / 2;
    double fall = 0, moved = 0;
    for (int d = 0; d < v->dim; d++) {
        const double b = v->g[d] - (tank[i * v->dim + d] + tank[j * v->dim + d]) / 2;
        fall += b * r[d];
        moved += (a[j * v->dim + d] + b) * r[d];
    }
    *carried = p[j] - mean * fall;
    return region[j] == MPS_REGION_SURFACE ? p[i] - *carried : 2 * mean * moved;
}

/* Contribution of particles in front of a wall, along its face and along the normal n. */
static double along_face(const mps_view *v, int64_t i, int64_t j, const double *n, double *s)
{
    double height = 0;
    for (int d = 0; d < v->dim; d++) height += n[d] * (v->x[j * v->dim + d] - v->x[i * v->dim + d]);
    for (int d = 0; d < 3; d++)
        s[d] = d < v->dim ? v->x[j * v->dim + d] - v->x[i * v->dim + d] - height * n[d] : 0;
    return height;
}

/* Covered fraction of a face, see covered_share() in src/bc/load_reaction.c. */
static double covered(const mps_stage *s, int64_t i, const double *n)
{
    const mps_view *v = s->view;
    const int32_t *region = s->data[REGION];
    const double re = v->near.re, dp = v->dp;
    double near[3] = {9, 9, 9}, at[3], across = 0;
    for (int64_t j = 0; j < v->n; j++) {
        const double height = along_face(v, i, j, n, at), r = hypot(length_of(at, 3), height);
        if (j == i || r >= re) continue;
        if (v->kind[j] == MPS_WALL && r < sqrt(1.5) * dp && fabs(height) > 0.3 * dp) return 1;
        if (v->kind[j] != MPS_FLUID || region[j] == MPS_REGION_SPRAY || height <= 0.1 * dp)
            continue;
        if (length_of(at, 3) < length_of(near, 3)) memcpy(near, at, sizeof near);
    }
    const double least = length_of(near, 3);
    if (least == 0 || least > re) return least == 0;
    for (int64_t j = 0; j < v->n; j++) {
        const double height = along_face(v, i, j, n, at), far = length_of(at, 3);
        if (v->kind[j] == MPS_DUMMY || region[j] >= MPS_REGION_SPRAY || height <= 0.1 * dp ||
            hypot(far, height) >= re)
            continue;
        const double cosine = -(at[0] * near[0] + at[1] * near[1] + at[2] * near[2]) / far / least;
        if (cosine > 0) across = fmax(across, cosine * fmin(1, (re - far) / (re - dp)));
    }
    return fmin(1, fmax(0, 1 - least / dp) + across);
}

/* Covered fraction, counted; 1 without the setting. */
static double share_of(const mps_stage *s, int64_t i, double size)
{
    double n[3] = {0};
    if (!seen.cover || size == 0) return 1;
    for (int d = 0; d < s->view->dim; d++) n[d] = s->view->area[i * s->view->dim + d] / size;
    const double share = covered(s, i, n);
    seen.whole += share == 1;
    seen.part += share > 0 && share < 1;
    seen.none += share == 0;
    return share;
}

/* P_i */
static double expected(const mps_stage *s, const mps_kernel *kernel, int64_t i)
{
    const mps_view *v = s->view;
    const int dim = v->dim;
    const int32_t *region = s->data[REGION];
    const double *p = s->data[PRESSURE], *area = v->area + i * dim;
    double size2 = 0, weight = 0, mean = 0, sum = 0, beyond = 0, pull = 0;
    for (int d = 0; d < dim; d++) size2 += area[d] * area[d];
    for (int64_t j = 0; j < v->n; j++) {
        const double *b = (const double *)s->data[CORRECTION] + j * dim * dim;
        double carried, push = 0;
        pair q;
        if (v->kind[j] != MPS_FLUID || !pair_of(v, kernel, i, j, &q)) continue;
        seen.spray += region[j] == MPS_REGION_SPRAY;
        seen.surface += region[j] == MPS_REGION_SURFACE;
        if (region[j] == MPS_REGION_SPRAY) continue;
        for (int d = 0; d < dim; d++)
            for (int e = 0; e < dim; e++) push += area[d] * b[d * dim + e] * q.d[e];
        const double own = rise(s, i, j, q.d, &carried);
        if (p[j] >= 0 && (region[j] == MPS_REGION_NEAR || region[j] == MPS_REGION_SURFACE))
            beyond = fmin(beyond, carried);
        pull = fmin(pull, p[j]);
        sum += pow(v->dp, dim) * dim / v->near.n0 * q.w_r2 * push * own;
        mean += q.w * carried;
        weight += q.w;
    }
    if (weight == 0) return p[i];
    const bool bounded = ((const int32_t *)s->data[CONDITION])[i] >= MPS_ROW_LEAST;
    const double share = share_of(s, i, sqrt(size2)), void_at = ((const double *)s->data[VALUE])[i];
    mean = mean / weight * share + (bounded ? (1 - share) * fmax(0, void_at) : 0);
    if (bounded) pull = fmax(pull, fmin(0, p[i] - void_at));
    const double most = mean + (size2 > 0 ? sum / size2 : 0), least = fmin(p[i], 0),
                 shown = fmax(most, least);
    seen.pressed += most > least;
    seen.held += most < least;
    if (shown >= 0) return shown;
    seen.dry += fmin(shown - beyond, pull) > shown;
    seen.pulls += fmin(shown - beyond, pull) <= shown;
    return fmax(shown, fmin(shown - beyond, pull));
}

static int compare(mps_stage *s)
{
    const double *load = s->data[LOAD], *p = s->data[PRESSURE];
    const int32_t *region = s->data[REGION];
    double most = 0;
    mps_kernel kernel = {.struct_size = sizeof kernel};
    assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
    for (int64_t i = 0; i < s->view->n; i++) most = fmax(most, fabs(p[i]));
    assert_true(most > 0);
    for (int64_t i = 0; i < s->view->n; i++) {
        if (s->view->kind[i] != MPS_WALL || region[i] == MPS_REGION_DRY) continue;
        seen.worst = fmax(seen.worst, fabs(load[i] - expected(s, &kernel, i)) / most);
    }
    return 0;
}

/* Gas next to all walls. */
static int bound_walls(mps_stage *s)
{
    int32_t *condition = s->data[BOUND_CONDITION];
    const int32_t *region = s->data[BOUND_REGION];
    for (int64_t i = 0; i < s->view->n && seen.gas > 0; i++) {
        if (s->view->kind[i] != MPS_WALL || region[i] != MPS_REGION_INNER) continue;
        condition[i] = MPS_ROW_LEAST;
        ((double *)s->data[BOUND_VALUE])[i] = seen.gas;
    }
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_SOURCE,
     .use_count = BOUND_USES,
     .uses = bound_uses,
     .after = "separation",
     .run = bound_walls},
    {.hook = MPS_LOAD, .use_count = USES, .uses = uses, .after = "*", .run = compare}};
static const mps_model_ops spy = {.struct_size = sizeof(mps_model_ops),
                                  .api = MPS_MODEL_API,
                                  .name = "after.spy",
                                  .help = "compares the pressures of walls",
                                  .verb_count = 2,
                                  .verbs = verbs};

/* Liquid off its lattice in a part of a tank that is pulled away from it, and a drop at a wall. */
static mps_sim *splash(int32_t dim)
{
    const double dp = 0.05, lo[3] = {0}, hi[3] = {0.6, 0.3, 0.3}, drop[3] = {0.69, 0.04, 0.15};
    const mps_harmonic surge = {.dof = MPS_MOVE_X, .amplitude = 0.1, .omega = 12, .phase = 0.9};
    uint64_t seed = 3;
    mps_particle_block b;
    mps_lease x = {.struct_size = sizeof x};
    const int32_t *kind;
    mps_sim *sim = new_sim(dim, dp);
    add_tank(sim, 0.9, 0.5, 0.3);
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = 1;
    b.position = drop;
    ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
    ASSERT_OK(sim, tags_peek(sim, NULL, &kind, NULL, NULL));
    ASSERT_OK(sim, mps_lease_begin(sim, "position", MPS_WRITE, &x));
    for (int64_t k = 0; k < x.count * dim; k++)
        if (kind[k / dim] == MPS_FLUID) x.data[k] += 0.1 * dp * cloud_random(&seed);
    ASSERT_OK(sim, mps_lease_end(sim, &x));
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &surge));
    ASSERT_OK(sim, mps_model_register(sim, &spy));
    ASSERT_OK(sim, mps_model_use(sim, "after.spy"));
    return sim;
}

/* Walls with pressure, walls with limited suction, walls next to the surface and next to spray,
 * each with the mean pressure on its whole face. */
static void sum_over_the_fluid(void **state)
{
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) {
        mps_sim *sim = splash(dim);
        memset(&seen, 0, sizeof seen);
        ASSERT_OK(sim, mps_model_set(sim, "load", "cover", 0));
        for (int step = 0; step < 4; step++) ASSERT_OK(sim, mps_step(sim, 1, NULL));
        print_message("%d-D: %lld press, %lld held back, %lld dry, %lld pull; pairs with %lld of "
                      "the surface, %lld spray; off by %.2g\n",
                      dim, (long long)seen.pressed, (long long)seen.held, (long long)seen.dry,
                      (long long)seen.pulls, (long long)seen.surface, (long long)seen.spray,
                      seen.worst);
        assert_true(seen.pressed > 20 && seen.held > 0 && seen.surface > 20 && seen.spray > 0);
        assert_true(seen.dry > 0 && seen.pulls > 0);
        assert_true(seen.worst < 1e-9);
        mps_sim_destroy(sim);
    }
}

/* The default: the mean pressure on the covered fraction of a face, next to void and next to
 * gas. */
static void covered_faces(void **state)
{
    (void)state;
    for (int32_t k = 0; k < 4; k++) {
        const int32_t dim = 2 + k / 2;
        mps_sim *sim = splash(dim);
        memset(&seen, 0, sizeof seen);
        seen.cover = true;
        seen.gas = 500.0 * (k % 2);
        for (int step = 0; step < 4; step++) ASSERT_OK(sim, mps_step(sim, 1, NULL));
        print_message(
            "%d-D, gas %g Pa: %lld faces are covered, %lld in part, %lld not; off by %.2g\n", dim,
            seen.gas, (long long)seen.whole, (long long)seen.part, (long long)seen.none,
            seen.worst);
        assert_true(seen.whole > 20 && seen.part > 0 && seen.none > 0);
        assert_true(seen.worst < 1e-9);
        mps_sim_destroy(sim);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sum_over_the_fluid),
                                       cmocka_unit_test(covered_faces)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* source.volume: rows of fluid and of walls against a loop over all particles. */
#include "phase_fixture.h"
#include <stdbool.h>

enum { CAPACITY = 4000 };
static const double TAU = 7, CLIP = 0.12, STRAIN = 0.9, GAIN = 0.6, FIRM = 0.05, RAPID = 0.4,
                    TORN = 0.06, FORWARD = 0.3, PACE = 0.8, ASIDE = 0.7;

enum {
    VELOCITY,
    DENSITY,
    ROW_DENSITY,
    REGION,
    TANK,
    DEVIATION,
    CORRECTION,
    WETTED,
    SOURCE,
    EQUATION_GAIN,
    EQUATION_RADIUS,
    USES
};
static const mps_use uses[USES] = {[VELOCITY] = {"velocity", MPS_USE_NEIGHBOURS},
                                   [DENSITY] = {"density", MPS_USE_NEIGHBOURS},
                                   [ROW_DENSITY] = {"pressure_density", MPS_USE_NEIGHBOURS},
                                   [REGION] = {"region", MPS_USE_NEIGHBOURS},
                                   [TANK] = {"tank_acceleration", MPS_USE_NEIGHBOURS},
                                   [DEVIATION] = {"volume_deviation", MPS_USE_NEIGHBOURS},
                                   [CORRECTION] = {"correction", MPS_USE_NEIGHBOURS},
                                   [WETTED] = {"wetted_share", MPS_USE_NEIGHBOURS},
                                   [SOURCE] = {"pressure_source", MPS_USE_READ},
                                   [EQUATION_GAIN] = {"equation_gain", MPS_USE_READ},
                                   [EQUATION_RADIUS] = {"equation_radius", MPS_USE_READ}};

/* The stage and its view, v, delta, fraction of solids by row, and how rows were found. */
static const mps_stage *stage;
static const mps_view *view;
static const double *rho, *row_rho;
static const int32_t *region;
static double v[3 * CAPACITY], delta[CAPACITY], *solid;
static struct {
    int64_t fluid, walls, mixed, limited, corners, slipped, torn, spray;
    double worst;
} seen;

typedef struct pair {
    double d[3], du[3], w, w_r2, flux, speed;
} pair;

static bool pair_of(int64_t i, int64_t j, pair *q)
{
    static mps_kernel kernel = {.struct_size = sizeof kernel};
    const double re = view->near.re;
    double r2 = 0, u2 = 0;
    if (!kernel.id) assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
    *q = (pair){0};
    for (int d = 0; d < view->dim; d++) {
        q->d[d] = view->x[j * view->dim + d] - view->x[i * view->dim + d];
        q->du[d] = v[j * view->dim + d] - v[i * view->dim + d];
        q->flux += q->d[d] * q->du[d];
        r2 += q->d[d] * q->d[d];
        u2 += q->du[d] * q->du[d];
    }
    if (i == j || r2 >= re * re) return false;
    q->speed = sqrt(u2);
    q->w = mps_kernel_value(&kernel, sqrt(r2), re);
    q->w_r2 = q->w / r2;
    return true;
}

/* v as if fluid moved with the tank without gravity and pressure. */
static void relative(void)
{
    const double *u = stage->data[VELOCITY], *tank = stage->data[TANK],
                 *given = stage->data[DEVIATION];
    for (int64_t i = 0; i < view->n; i++) {
        const bool fluid = view->kind[i] == MPS_FLUID;
        for (int d = 0; d < view->dim; d++) {
            const int64_t k = i * view->dim + d;
            v[k] = u[k] - (fluid ? view->dt * (view->g[d] - tank[k]) : 0);
        }
        const bool counts = fluid && region[i] < MPS_REGION_SURFACE;
        delta[i] = counts ? fmin(CLIP, fmax(-CLIP, given[i])) : 0;
        if (region[i] > MPS_REGION_INNER && delta[i] < 0) delta[i] = 0;
    }
}

/* Walls keep what is normal to them of their velocity; in corners in 2-D all of it. */
static void slip(void)
{
    static double mean[3 * CAPACITY];
    const int dim = view->dim;
    memset(mean, 0, sizeof mean);
    for (int64_t i = 0; i < view->n; i++) {
        const double *area = view->area + i * dim;
        double weight = 0, size2 = 0, most = 0, normal = 0;
        if (view->kind[i] != MPS_WALL || region[i] == MPS_REGION_DRY) continue;
        for (int64_t j = 0; j < view->n; j++) {
            pair q;
            if (view->kind[j] != MPS_FLUID || !pair_of(i, j, &q)) continue;
            weight += q.w * rho[j];
            for (int d = 0; d < dim; d++) mean[i * dim + d] += q.w * rho[j] * q.du[d];
        }
        for (int d = 0; d < dim; d++) {
            if (weight > 0) mean[i * dim + d] /= weight;
            size2 += area[d] * area[d];
            most = fmax(most, area[d] * area[d]);
            normal += mean[i * dim + d] * area[d];
        }
        const bool corner = dim == 2 && size2 > 1.5 * most && size2 < 0.6 * view->dp * view->dp;
        for (int d = 0; d < dim && size2 > 0; d++) mean[i * dim + d] -= normal * area[d] / size2;
        for (int d = 0; d < dim && (corner || size2 == 0); d++) mean[i * dim + d] = 0;
        seen.corners += corner;
        seen.slipped += !corner;
    }
    for (int64_t k = 0; k < view->n * dim; k++) v[k] += mean[k];
}

/* Divergence less the strain of a fluid row. */
static double strained(int64_t i)
{
    const int dim = view->dim;
    const double c = dim / view->near.n0, strain = STRAIN * (0.5 + FORWARD * (1 / GAIN - 1));
    const double *b = (const double *)stage->data[CORRECTION] + i * dim * dim;
    double g[9] = {0}, m[9] = {0}, a[9] = {0}, own[9], sum = 0;
    bool mixed = false;
    for (int64_t j = 0; j < view->n; j++) {
        pair q;
        if (region[j] >= MPS_REGION_SPRAY || !pair_of(i, j, &q)) continue;
        const bool apart = view->kind[j] == MPS_FLUID && view->phase[j] != view->phase[i];
        const double share = apart ? 2 * rho[j] / (rho[i] + rho[j]) : 1;
        mixed = mixed || apart;
        for (int d = 0; d < dim; d++)
            for (int e = 0; e < dim; e++) {
                g[d * dim + e] += c * share * q.w_r2 * q.du[d] * q.d[e];
                m[d * dim + e] += c * share * q.w_r2 * q.d[d] * q.d[e];
            }
    }
    seen.mixed += mixed;
    mps_matrix_inverse_bounded(dim, m, 0.5, own);
    for (int k = 0; k < dim * dim * dim; k++)
        a[k / dim] += g[k / dim / dim * dim + k % dim] *
                      (mixed ? own : b)[k % dim * dim + k / dim % dim];
    for (int d = 0; d < dim; d++) {
        sum += a[d * dim + d];
        for (int e = 0; e < dim; e++) sum -= strain * view->dt * a[d * dim + e] * a[e * dim + d];
    }
    return sum;
}

/* Relaxation of the kernel mean of delta; drive: speed of the denser fluid. */
static double back(int64_t i, double drive)
{
    const double u_g = view->velocity_scale, rate = u_g / view->dp;
    double weight = 0.5 * mps_kernel_weight(&view->near.kernel, 0, view->near.re);
    double mean = weight * delta[i];
    for (int64_t j = 0; j < view->n; j++) {
        pair q;
        if (view->kind[j] != MPS_FLUID || !pair_of(i, j, &q)) continue;
        mean += q.w * delta[j];
        weight += q.w;
    }
    mean /= weight;
    const double open = fmax(0, 1 - 2 * ASIDE * solid[i]), torn = fmin(1, pow(mean / TORN, 4));
    seen.torn += torn > 0.05;
    return mean *
           (rate * fmin(1, (open + pow(mean / FIRM, 4)) / TAU) + RAPID * drive / view->dp * torn);
}

static bool lighter(int64_t i, int64_t j)
{
    return view->kind[j] == MPS_FLUID && rho[j] < 0.5 * row_rho[i];
}

/* Divergence of the half cell of a wall; light fluid is not faster than adjacent dense fluid. */
static double of_wall(int64_t i)
{
    const double *wetted = stage->data[WETTED];
    double most = 5 * view->velocity_scale, sum = 0;
    pair q;
    for (int64_t j = 0; j < view->n; j++)
        if (view->kind[j] == MPS_FLUID && !lighter(i, j) && region[j] < MPS_REGION_SPRAY &&
            pair_of(i, j, &q))
            most = fmax(most, q.speed);
    for (int64_t j = 0; j < view->n; j++) {
        if (region[j] >= MPS_REGION_SPRAY || !pair_of(i, j, &q)) continue;
        const bool slow_down = lighter(i, j) && q.speed > most;
        const double share = slow_down                   ? most / q.speed
                             : view->kind[j] == MPS_WALL ? 0.5 * fmin(wetted[i], wetted[j])
                                                         : 1;
        sum += view->dim / view->near.n0 * q.w_r2 * q.flux * share;
        seen.limited += slow_down;
    }
    return sum;
}

/* Largest speeds of the fluid inside, relative to the tank that surges: of the denser, of all. */
static void speeds(double light, double most[2])
{
    const double *u = stage->data[VELOCITY];
    most[0] = most[1] = 0;
    for (int64_t i = 0; i < view->n; i++) {
        double u2 = 0;
        if (view->kind[i] != MPS_FLUID || region[i] >= MPS_REGION_SURFACE) continue;
        for (int d = 0; d < view->dim; d++) u2 += pow(u[i * view->dim + d] - view->tank.rate[d], 2);
        if (rho[i] > light) most[0] = fmax(most[0], sqrt(u2));
        most[1] = fmax(most[1], sqrt(u2));
    }
}

static int compare(mps_stage *s)
{
    const double *got = s->data[SOURCE], light = 100, heavy = 1000,
                 calm = 5 * s->view->velocity_scale;
    double most[2], *is_solid = mps_stage_scratch(s, s->view->n);
    solid = mps_stage_scratch(s, s->view->n);
    stage = s;
    view = s->view;
    assert_true(view->n <= CAPACITY && is_solid && solid);
    rho = s->data[DENSITY];
    row_rho = s->data[ROW_DENSITY];
    region = s->data[REGION];
    for (int64_t i = 0; i < view->n; i++) is_solid[i] = view->kind[i] != MPS_FLUID;
    assert_int_equal(mps_op_volume_sum(&view->far, is_solid, solid), MPS_OK);
    relative();
    slip();
    speeds(light, most);
    const double slow = PACE * (1 - fmax(calm, most[0]) / fmax(calm, most[1]));
    for (int64_t i = 0; i < view->n; i++) {
        const bool fluid = view->kind[i] == MPS_FLUID;
        seen.spray += region[i] == MPS_REGION_SPRAY;
        if (region[i] >= MPS_REGION_SURFACE) continue;
        const double pace = 1 - slow * (row_rho[i] - light) / (heavy - light),
                     wanted = fluid ? back(i, fmax(most[0], view->velocity_scale)) - strained(i)
                                    : -of_wall(i);
        seen.worst = fmax(seen.worst, fabs(got[i] * view->dt - pace * wanted) / (1 + fabs(wanted)));
        seen.fluid += fluid;
        seen.walls += !fluid;
    }
    assert_true(*(double *)s->data[EQUATION_GAIN] == GAIN);
    assert_true(*(int32_t *)s->data[EQUATION_RADIUS] == MPS_NEAR);
    assert_true(view->flux.body == 1 && slow > 0.1);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_SOURCE, .use_count = USES, .uses = uses, .after = "*", .run = compare}};
static const mps_model_ops rows = {.struct_size = sizeof(mps_model_ops),
                                   .api = MPS_MODEL_API,
                                   .name = "after.rows",
                                   .help = "compares the sources of rows",
                                   .verb_count = 1,
                                   .verbs = verbs};

static void use_source(mps_sim *sim)
{
    static const struct {
        const char *key;
        double value;
    } set[] = {{"tau", TAU},   {"clip", CLIP},   {"strain", STRAIN}, {"gain", GAIN},
               {"firm", FIRM}, {"rapid", RAPID}, {"torn", TORN},     {"forward", FORWARD},
               {"pace", PACE}, {"aside", ASIDE}, {"start", 0}};
    ASSERT_OK(sim, mps_model_use(sim, "surface.asymmetry"));
    ASSERT_OK(sim, mps_model_use(sim, "wall.half"));
    ASSERT_OK(sim, mps_model_use(sim, "moments.bounded"));
    ASSERT_OK(sim, mps_model_use(sim, "source.volume"));
    for (size_t k = 0; k < sizeof set / sizeof set[0]; k++)
        ASSERT_OK(sim, mps_model_set(sim, "source", set[k].key, set[k].value));
    ASSERT_OK(sim, mps_model_register(sim, &rows));
    ASSERT_OK(sim, mps_model_use(sim, "after.rows"));
}

/* A light fluid that is fast below a heavy one, both squeezed and off their lattice, in a tank that
 * is moved, with a free surface and drops above it. */
static void move_layers(int dim)
{
    const int nx = dim == 2 ? 15 : 7, ny = dim == 2 ? 12 : 8, nz = dim == 3 ? 4 : 1;
    const mps_harmonic surge = {.dof = MPS_MOVE_X, .amplitude = 0.05, .omega = 9, .phase = 0.7};
    cloud c = cloud_lattice(dim, nx, ny, nz, 0.15, 77);
    int32_t *phase = cloud_phases(c.n);
    double *u = cloud_field(c.n * dim, 5);
    mps_sim *sim = bare_sim(dim, CLOUD_DP, 3.1, 2e-4);
    for (int64_t i = 0; i < c.n; i++) {
        phase[i] = i / nx % ny < 5;
        for (int d = 0; d < dim; d++) {
            c.x[i * dim + d] = 0.95 * c.x[i * dim + d] + 1.1 * CLOUD_DP;
            u[i * dim + d] *= phase[i] ? 30 : 2;
        }
        if (i / nx % ny == ny - 1) c.x[i * dim + 1] += i % 3 ? -0.1 * CLOUD_DP : 1.5 * CLOUD_DP;
    }
    set_phase(sim, 0, 1000, 0);
    set_phase(sim, 1, 100, 0);
    add_tank(sim, (nx + 1) * CLOUD_DP, (ny + 3) * CLOUD_DP, (nz + 1) * CLOUD_DP);
    add_cloud(sim, &c, phase, u);
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &surge));
    use_source(sim);
    assert_true(mps_step(sim, 1, NULL) >= 0);
    mps_sim_destroy(sim);
    cloud_free(&c);
    free(phase);
    free(u);
}

static void by_all_particles(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        memset(&seen, 0, sizeof seen);
        move_layers(dim);
        print_message(
            "%d-D: to %.2g; fluid %lld, walls %lld, mixed %lld, limited %lld, corners %lld, "
            "slipped %lld, torn %lld, spray %lld\n",
            dim, seen.worst, (long long)seen.fluid, (long long)seen.walls, (long long)seen.mixed,
            (long long)seen.limited, (long long)seen.corners, (long long)seen.slipped,
            (long long)seen.torn, (long long)seen.spray);
        assert_true(seen.worst < 1e-9);
        assert_true(seen.fluid > 50 && seen.walls > 20 && seen.mixed > 10 && seen.spray > 0);
        assert_true(seen.limited > 0 && seen.slipped > 20 && (dim == 3 || seen.corners > 0));
        assert_true(seen.torn > 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(by_all_particles)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
